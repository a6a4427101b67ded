"""What settings change that a user may add: the part, right or wrong, the orientation, the kernel, the seed.

    python benchmarks/added_settings.py --data DIR [--half choice|report] [--pairs 1] [--sets FAUST_r,PFAUST_H,...]
    python benchmarks/added_settings.py --data DIR --only FAUST_r,tr_reg_063,tr_reg_071 --ways "none;kernel.kind=Tanh"

DIR as for benchmarks/automatic.py; of SHREC16, PFAUST_M and PFAUST_H the target is a part. A way is "none", "seed=1",
or settings as ``--set`` takes them, with commas between. Errors are mean geodesic distances × 100 over the target's
vertices that have a counterpart by truth and map.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from automatic import Job, chosen_jobs, loaded, pair_options

import kfmaps
from kfmaps.settings import with_assignments

WAYS = (
    "none",
    *(f"partial.part={part}" for part in ("none", "source", "target", "both")),
    *(f"search.orientation={name}" for name in ("preserving", "either")),
    *(f"kernel.kind={name}" for name in ("Linear", "Polynomial", "Tanh", "Laplacian")),
    *(f"basis.n_eigenfunctions={number}" for number in (60, 200)),
    "descriptors.shot=false",
    "search.match_extremities=false",
    "search.n_sign_functions=0",
    "registration=none",
    "basis.laplacian=cotangent",
    "seed=1",
)


def row_of(job: Job, way: str) -> str:
    """Return a line of the table."""
    source, target, true_s, true_t = loaded(job)
    added = [] if way == "none" else way.split(",")
    seeds = [int(one.removeprefix("seed=")) for one in added if one.startswith("seed=")]
    config = with_assignments(kfmaps.Config(), [one for one in added if not one.startswith("seed=")])
    begun = time.process_time()
    found = kfmaps.match(source, target, replace(config, threads=1), rng=seeds[0] if seeds else 0)
    seconds = time.process_time() - begun
    errors = 100 * kfmaps.geodesic_errors(source, found.target_to_source[true_t], true_s)
    is_matched = np.isfinite(errors)
    error = errors[is_matched].mean() if is_matched.any() else np.nan
    return (
        f"{job.kind} {job.source} {job.target}".ljust(46) + f"{way:32}{error:8.2f}{100 * is_matched.mean():9.0f}  "
        f"{found.verdict:10}{found.confidence or 0.0:6.2f}{seconds:8.1f}"
    )


def main() -> None:
    parser = pair_options(__doc__, "FAUST_r,SHREC19_r,TOSCA_r,catdog,SMAL_r", 1, only=True)
    parser.add_argument("--ways", default=";".join(WAYS))
    arguments = parser.parse_args()
    print(f"{'pair':46}{'added':32}{'error':>8}{'matched':>9}  {'verdict':10}{'':6}{'CPU s':>8}")
    for job in chosen_jobs(arguments, seed=1):
        for way in arguments.ways.split(";"):
            print(row_of(job, way), flush=True)


if __name__ == "__main__":
    main()
