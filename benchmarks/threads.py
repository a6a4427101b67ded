"""Seconds on 1, 2 and 4 Python threads: ``python benchmarks/threads.py [--large N] [--threads 1 2 4] [--json PATH]``.

Four tasks: a whole match of a generated pair with six landmarks, the same without landmarks, the eigenproblem (k = 200)
and the point map (k = 200) of a large shape. BLAS is on one thread. The shortest of ``--repeats`` counts, and the
tasks take turns. Where other work runs on the machine, only the CPU seconds say much: they show what threads waste.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import robust_laplacian
from shapes import bumpy_pair, bumpy_sphere

from kfmaps._threads import limit_threads, one_blas_thread
from kfmaps.config import Config
from kfmaps.fmap.approximate_nearest import approximate_nearest
from kfmaps.geometry.eigen.eigensolver import smallest_eigenpairs
from kfmaps.matching.match import match

K = 200


def tasks(large: int) -> dict[str, Callable[[], Any]]:
    """Return what is measured, by its name."""
    pair, sphere = bumpy_pair(5000), bumpy_sphere(large)
    stiffness, area = robust_laplacian.mesh_laplacian(sphere.vertices, sphere.faces)
    functions = smallest_eigenpairs(stiffness, area.diagonal(), K).vectors
    moved = functions + 0.3 * np.random.default_rng(0).normal(size=(1, K))
    with_landmarks, without = Config.single_fit(), Config()

    return {
        "match, 5000, landmarks": lambda: match(pair.source, pair.target, with_landmarks, landmarks=pair.landmarks),
        "match, 5000, none": lambda: match(pair.source, pair.target, without),
        f"eigenproblem, {large}": lambda: smallest_eigenpairs(stiffness, area.diagonal(), K),
        f"point map, {large}": lambda: approximate_nearest(functions, moved),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", type=int, default=100_000)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2, 4])
    parser.add_argument("--repeats", type=int, default=2)
    parser.add_argument("--json", type=Path, help="write the rows there too")
    options = parser.parse_args()
    rows = []
    print(f"{'task':26} {'threads':>7} {'seconds':>8} {'ratio':>6} {'CPU s':>8}")
    for name, task in tasks(options.large).items():
        best: dict[int, tuple[float, float]] = {}
        for _ in range(options.repeats):
            for threads in options.threads:
                wall, work = time.perf_counter(), time.process_time()
                with limit_threads(threads), one_blas_thread():
                    task()
                spent = time.perf_counter() - wall, time.process_time() - work
                best[threads] = min(best.get(threads, spent), spent)
        first = best[options.threads[0]][0]
        for threads, (wall, work) in best.items():
            rows.append({"task": name, "threads": threads, "seconds": wall, "work": work})
            print(f"{name:26} {threads:7d} {wall:8.2f} {first / wall:6.2f} {work:8.2f}", flush=True)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
