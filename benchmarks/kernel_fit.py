"""What a Gaussian kernel is worth in one fit with six landmarks, instead of a linear one.

    python benchmarks/kernel_fit.py --data DIR [--sets FAUST_r,SHREC19_r,TOSCA_r] [--half choice] [--pairs 3]
        [--rows FILE]

With 10 and with 100 descriptors, of the raw map and of the refined one. The table is that of benchmarks/ablation.py;
``--rows`` keeps every map in a file of JSON lines. A pair takes 20 CPU seconds.
"""

from __future__ import annotations

import json
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from ablation import report
from automatic import Job, chosen_jobs, chosen_landmarks, loaded, pair_options
from scatter import POINTS, Judged

import kfmaps
from kfmaps.geometry.geodesics import geodesic_distances

LANDMARKS = 6
COUNTS = 10, 100
KERNELS = {"": kfmaps.Linear(), "Gaussian": kfmaps.Gaussian()}


def rows_of(job: Job) -> list[dict[str, Any]]:
    """Both errors of each fit of a pair."""
    *meshes, true_s, true_t = loaded(job)
    plain, rows = replace(kfmaps.Config.single_fit(), threads=1, registration=None), []
    source, target = (kfmaps.prepare(mesh, plain) for mesh in meshes)
    marks = chosen_landmarks(source, (true_s, true_t), LANDMARKS, 0.0)
    some = np.random.default_rng(0).permutation(len(true_t))[:POINTS]
    of = Judged(source, target, true_s[some], true_t[some], geodesic_distances(source.mesh, true_s[some]))
    for count in COUNTS:
        for name, kernel in KERNELS.items():
            config = replace(plain, kernel=kernel, descriptors=replace(plain.descriptors, n_spectral=count))
            start = time.process_time()
            made = kfmaps.match(source, target, config, landmarks=marks)
            spent = time.process_time() - start
            assert made.fit is not None
            for stage, points in (("raw", made.fit.raw_target_to_source), ("refined", made.target_to_source)):
                row = {"set": job.kind, "pair": f"{job.source}-{job.target}, {count}, {stage}", "seed": 0}
                piece = name and f"{name}, {count} descriptors, {stage}"
                error = of.error(np.asarray(points)[of.true_t])
                rows.append({**row, "piece": piece, "error": error, "verdict": made.verdict, "cpu": spent})
    return rows


def main() -> None:
    parser = pair_options(__doc__, "FAUST_r,SHREC19_r,TOSCA_r", 3)
    parser.add_argument("--rows", type=Path, help="JSON lines of all maps, written")
    args = parser.parse_args()
    rows = []
    for job in chosen_jobs(args):
        rows += rows_of(job)
        if args.rows:
            args.rows.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    report(rows, [f"Gaussian, {count} descriptors, {stage}" for count in COUNTS for stage in ("raw", "refined")])


if __name__ == "__main__":
    main()
