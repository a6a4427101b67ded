"""Cats with dogs and gorillas with women, with and without what is done for bodies of different proportions.

    python benchmarks/unlike.py --data DIR [--half choice] [--pairs 3] [--seeds 0,1]

Mean errors of whole matches without landmarks: as rigidly as possible throughout; with rest shapes that are stretched
evenly (:mod:`kfmaps.registration.local_scaling`) while shapes are registered and refined in turn and in the last fit;
with maps that begin with the likeliest matches of extremities beside
(:func:`kfmaps.matching.registration_refine.refine_by_registration`); with torn area counted where others may be less
torn (:func:`kfmaps.matching.finish.better_match`); and with parts that touch told apart in the end
(:mod:`kfmaps.registration.contact_projection`), which is all that there is. DIR is as for benchmarks/automatic.py. The
half ``report``, the default, has the pairs of that script, none of two shapes that settings were chosen on; ``choice``
has pairs of two such shapes. Three pairs of either set take about ten minutes.
"""

from __future__ import annotations

import time
from contextlib import ExitStack
from dataclasses import replace
from unittest.mock import patch

import numpy as np
from automatic import Job, chosen_pairs, loaded, pair_options

import kfmaps
from kfmaps.geometry.closest_points import closest_points
from kfmaps.matching import finish
from kfmaps.matching import match as matching
from kfmaps.matching import registration_refine as mending
from kfmaps.matching.score import SCORE
from kfmaps.registration import alternating_registration as alternate
from kfmaps.registration import nonrigid_icp as nonrigid

RIGID = replace(alternate.FIT, local_scaling=0.0)
ONCE = (matching, "SCORE", replace(SCORE, max_torn_area=2.0))
"""More than all of the target is never torn."""
UNPAIRED = (mending, "N_MATCHES", 0)
CLOSEST = (
    nonrigid,
    "project_with_contact",
    lambda _points, body, x, target, _normals: closest_points(target.vertices, x, body.mesh.faces),
)
KINDS = {
    "as rigid as possible": ((alternate, "FIT", RIGID), (finish, "UNLIKE_LOCAL_SCALING", 0.0), UNPAIRED, ONCE, CLOSEST),
    "stretched evenly": (UNPAIRED, ONCE, CLOSEST),
    "and pairings of tips": (ONCE, CLOSEST),
    "and torn area": (CLOSEST,),
    "and parts that touch": (),
}


def matched(job: Job, seeds: list[int]) -> list[list[tuple[float, float]]]:
    """Mean error × 100 and CPU seconds of each of :data:`KINDS` for each seed."""
    source, target, true_s, true_t = loaded(job)
    config = replace(kfmaps.Config(), threads=1)
    a, b = (kfmaps.prepare(mesh, config, name=name) for mesh, name in ((source, "source"), (target, "target")))
    rows = []
    for changed in KINDS.values():
        with ExitStack() as stack:
            for where, name, value in changed:
                stack.enter_context(patch.object(where, name, value))
            row = []
            for seed in seeds:
                start = time.process_time()
                found = kfmaps.match(a, b, config, rng=seed)
                spent = time.process_time() - start
                errors = kfmaps.geodesic_errors(source, found.target_to_source[true_t], true_s)
                row.append((100 * float(errors.mean()), spent))
        rows.append(row)
    return rows


def main() -> None:
    parser = pair_options(__doc__, "catdog,TOSCA_nonIsometric_r", 3, "report")
    parser.add_argument("--seeds", default="0")
    args = parser.parse_args()
    seeds = [int(seed) for seed in args.seeds.split(",")]
    for kind in args.sets.split(","):
        pairs = chosen_pairs(kind, args.data, args.half, args.pairs)
        every = []
        for a, b in pairs:
            every.append(matched(Job(args.data, kind, a, b), seeds))
            print(
                f"{kind} {a} {b}: " + "; ".join(" ".join(f"{e:.2f}" for e, _ in row) for row in every[-1]), flush=True
            )
        for name, errors in zip(KINDS, np.array(every).transpose(1, 0, 2, 3).reshape(len(KINDS), -1, 2), strict=True):
            mean, worst, spent = errors[:, 0].mean(), errors[:, 0].max(), errors[:, 1].mean()
            print(f"{kind}, {len(pairs)} pairs, {name:22} mean {mean:5.2f} worst {worst:5.2f} {spent:5.1f} CPU s")


if __name__ == "__main__":
    main()
