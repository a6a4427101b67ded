"""Searches for nearest neighbours, exact and by cells: ``python benchmarks/neighbours.py [--data FOLDER]``.

The point maps of generated pairs, or of remeshed scans with every triangle cut in four, with the recommended settings:
the raw one (k = 100) and the last of the refinement (k = 200). "different": part of 4,000 queries with another answer
than the exact one; "excess": how much longer the distance to that answer is, relatively, mean and largest over these
queries. Errors are mean geodesic distances from the truth in per cent of √area, of 1,000 queries at most. CPU seconds
are of one thread; those of the exact search are of the 4,000, times how many more there are.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from shapes import Pair, bumpy_pair, read_pairs

from kfmaps._threads import limit_threads, one_blas_thread
from kfmaps.config import Config
from kfmaps.fmap.approximate_nearest import approximate_nearest
from kfmaps.fmap.nearest import nearest
from kfmaps.geometry.connectivity import half_edges
from kfmaps.geometry.geodesics import geodesic_distance_pairs
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.matching.finish import refine_map
from kfmaps.matching.fit import fit
from kfmaps.shape import prepare


def quartered(mesh: Mesh) -> Mesh:
    """Every triangle cut in four at the middles of its edges; the old vertices come first."""
    n, faces = len(mesh.vertices), mesh.faces
    sides = np.sort(half_edges(faces), axis=1)
    edges, number = np.unique(sides, axis=0, return_inverse=True)
    a, b, c = (number.reshape(3, -1) + n)[:, :, None]
    p, q, r = faces.T[:, :, None]
    corners = [(p, a, c), (q, b, a), (r, c, b), (a, b, c)]
    vertices = np.vstack([mesh.vertices, mesh.vertices[edges].mean(axis=1)])
    return Mesh(vertices, np.concatenate([np.concatenate(three, axis=1) for three in corners]))


def scanned(folder: Path, count: int) -> list[Pair]:
    """Pairs of scans, quartered. The truth is known at the old vertices of the target, elsewhere it is -1."""
    pairs = []
    for pair in read_pairs(folder, count):
        source, target = quartered(pair.source), quartered(pair.target)
        truth = np.full(len(target.vertices), -1)
        truth[: len(pair.target_to_source)] = pair.target_to_source
        pairs.append(Pair(pair.name, source, target, truth, pair.landmarks))
    return pairs


def measure(pair: Pair) -> list[dict[str, float | str]]:
    config = replace(Config.single_fit(), threads=1)
    source, target = prepare(pair.source, config), prepare(pair.target, config)
    found = fit(source, target, config, landmarks=pair.landmarks)
    end = refine_map(found.functional_map, source, target, config, raw=False)
    mesh, rows = unit_area(pair.source), []
    for name, C in (("raw", found.functional_map), ("refined", end.functional_map)):
        k = len(C)
        queries, points = target.basis.functions[:, :k], source.basis.functions[:, :k] @ C.T
        some = np.random.default_rng(0).choice(len(queries), 4000, replace=False)
        known = np.flatnonzero(pair.target_to_source[some] >= 0)[:1000]
        start = time.process_time()
        with limit_threads(1):
            exact = nearest(queries[some], points, exact=True)
        best = np.linalg.norm(queries[some] - points[exact], axis=1)
        answers = [("exact", (time.process_time() - start) * len(queries) / len(some), exact)]
        for probes in (4, 8, 16, 32):
            start = time.process_time()
            with limit_threads(1):
                answer = approximate_nearest(queries, points, n_probe=probes)
            answers.append((f"{probes} cells", time.process_time() - start, answer[some]))
        for search, spent, answer in answers:
            excess = np.linalg.norm(queries[some] - points[answer], axis=1) / np.maximum(best, 1e-300) - 1
            away = geodesic_distance_pairs(mesh, answer[known], pair.target_to_source[some][known])
            rows.append(
                {
                    "pair": pair.name,
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
                f"{pair.name:26} {row['map']:16} {search:16} {spent:8.2f} {100 * row['different']:9.2f} % "
                f"{row['mean_excess']:9.1e} {row['largest_excess']:8.2f} {row['error']:7.3f}",
                flush=True,
            )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[20_000, 80_000])
    parser.add_argument("--data", type=Path, help="a folder laid out as FAUST_r is, instead of generated shapes")
    parser.add_argument("--json", type=Path, help="write the rows there too")
    options = parser.parse_args()
    print(f"{'pair':26} {'map':16} {'search':16} {'CPU s':>8} {'different':>11} {'excess':>9} {'largest':>8}   error")
    rows = []
    with one_blas_thread():
        for pair in scanned(options.data, 2) if options.data else map(bumpy_pair, options.sizes):
            rows += measure(pair)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
