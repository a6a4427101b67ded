"""Searches for nearest neighbours, exact and by cells: ``python benchmarks/neighbours.py [--sizes N ...]``.

The point maps of generated pairs with the recommended settings: the raw one (k = 100) and the last of the refinement
(k = 200). "different": part of 4,000 queries with another answer than the exact one; "excess": how much longer the
distance to that answer is, relatively, mean and largest over these queries. Errors are mean geodesic distances from the
truth in per cent of √area, of 1,000 queries. CPU seconds on one thread.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import numpy as np
from shapes import bumpy_pair

from kfmaps._threads import one_blas_thread
from kfmaps.cells import nearest_by_cells
from kfmaps.config import Config
from kfmaps.geodesics import distance_pairs
from kfmaps.mesh import unit_area
from kfmaps.neighbours import nearest
from kfmaps.pipeline import fit
from kfmaps.shape import prepare

SETTINGS = ((64, 4), (64, 8), (64, 16), (64, 32))
"""Points in a cell and cells named by a query."""


def measure(n: int) -> list[dict[str, float | str]]:
    pair, config = bumpy_pair(n), Config(threads=1)
    source, target = prepare(pair.source, config), prepare(pair.target, config)
    found = fit(source, target, config, landmarks=pair.landmarks)
    mesh, rows = unit_area(pair.source), []
    for name, C in (("raw", found.raw_functional_map), ("refined", found.functional_map)):
        k = len(C)
        queries, points = target.basis.functions[:, :k], source.basis.functions[:, :k] @ C.T
        some = np.random.default_rng(0).choice(len(queries), 4000, replace=False)
        start = time.process_time()
        exact = nearest(queries[some], points, threads=1, exact=True)
        best = np.linalg.norm(queries[some] - points[exact], axis=1)
        answers = [("exact", (time.process_time() - start) * len(queries) / len(some), exact)]
        for size, probes in SETTINGS:
            start = time.process_time()
            answer = nearest_by_cells(queries, points, size=size, probes=probes, threads=1)
            answers.append((f"{probes} cells of {size}", time.process_time() - start, answer[some]))
        for search, spent, answer in answers:
            excess = np.linalg.norm(queries[some] - points[answer], axis=1) / np.maximum(best, 1e-300) - 1
            away = distance_pairs(mesh, answer[:1000], pair.target_to_source[some][:1000])
            rows.append(
                {
                    "n": n,
                    "map": f"{name}, k = {k}",
                    "search": search,
                    "work": spent,
                    "different": float(np.mean(answer != exact)),
                    "mean_excess": float(excess.mean()),
                    "largest_excess": float(excess.max()),
                    "error": 100 * float(away.mean()),
                }
            )
            row = rows[-1]
            print(
                f"{n:8d} {row['map']:16} {search:16} {spent:8.2f} {100 * row['different']:9.2f} % "
                f"{row['mean_excess']:9.1e} {row['largest_excess']:8.2f} {row['error']:7.3f}",
                flush=True,
            )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[20_000, 80_000])
    parser.add_argument("--json", type=Path, help="write the rows there too")
    options = parser.parse_args()
    print(
        f"{'vertices':>8} {'map':16} {'search':16} {'CPU s':>8} {'different':>11} {'excess':>9} {'largest':>8}   error"
    )
    rows = []
    with one_blas_thread():
        for n in options.sizes:
            rows += measure(n)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
