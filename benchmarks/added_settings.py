"""What settings change that a user may add: the part, right or wrong, the orientation, the kernel, the seed.

    python benchmarks/added_settings.py --data DIR [--half choice|report] [--pairs 1] [--sets FAUST_r,PFAUST_H,...]
    python benchmarks/added_settings.py --data DIR --only FAUST_r,tr_reg_063,tr_reg_071 --ways "none;part source"

DIR as for benchmarks/automatic.py; of SHREC16, PFAUST_M and PFAUST_H the target is a part. Errors are mean geodesic
distances × 100 over the target's vertices that have a counterpart by truth and map.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
from automatic import Job, chosen_jobs, loaded, pair_options

import kfmaps
from kfmaps.config import Config
from kfmaps.kernels.kernels import Laplacian, Linear, Polynomial, Tanh


def _with_part(part: str) -> Config:
    config = Config()
    return replace(config, partial=replace(config.partial, part=part))


def _with_orientation(orientation: str) -> Config:
    config = Config()
    assert config.search is not None
    return replace(config, search=replace(config.search, orientation=orientation))


WAYS = {
    "none": (Config(), 0),
    **{f"part {part}": (_with_part(part), 0) for part in ("none", "source", "target", "both")},
    **{name: (_with_orientation(name), 0) for name in ("preserving", "either")},
    **{type(one).__name__: (Config(kernel=one), 0) for one in (Linear(), Polynomial(), Tanh(), Laplacian())},
    "seed 1": (Config(), 1),
}
"""Settings and seed."""


def row_of(job: Job, way: str) -> str:
    """Return a line of the table."""
    source, target, true_s, true_t = loaded(job)
    config, seed = WAYS[way]
    begun = time.process_time()
    found = kfmaps.match(source, target, replace(config, threads=1), rng=seed)
    seconds = time.process_time() - begun
    errors = 100 * kfmaps.geodesic_errors(source, found.target_to_source[true_t], true_s)
    is_matched = np.isfinite(errors)
    name = f"{job.kind} {job.source} {job.target}"
    return (
        f"{name:44}{way:14}{errors[is_matched].mean():8.2f}{100 * is_matched.mean():9.0f}  "
        f"{found.verdict:10}{found.confidence or 0.0:6.2f}{seconds:8.1f}"
    )


def main() -> None:
    parser = pair_options(__doc__, "FAUST_r,SHREC19_r,TOSCA_r,catdog,SMAL_r", 1)
    parser.add_argument("--only", nargs="+", metavar="SET,SOURCE,TARGET", help="these pairs alone")
    parser.add_argument("--ways", default=";".join(WAYS))
    arguments = parser.parse_args()
    only = [Job(arguments.data, *pair.split(",")) for pair in arguments.only or ()]
    print(f"{'pair':44}{'added':14}{'error':>8}{'matched':>9}  {'verdict':10}{'':6}{'CPU s':>8}")
    for job in only or chosen_jobs(arguments, seed=1):
        for way in arguments.ways.split(";"):
            print(row_of(job, way), flush=True)


if __name__ == "__main__":
    main()
