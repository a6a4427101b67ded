"""Accuracy and speed of geodesic distances: ``python benchmarks/geodesics.py [MESH] [--json PATH]``.

It needs the extra ``bench``.

Without a mesh file a bumpy sphere of 5,000 vertices. The reference is the graph of all straight lines across up to
24 unfolded edges, which exact polyhedral distances undercut by 0.002 % on average; errors are in per cent of the
distance, those called near within three mean edge lengths.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import potpourri3d
from scipy.sparse.csgraph import dijkstra
from shapes import bumpy_sphere

from kfmaps._threads import one_blas_thread
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import read_mesh

REFERENCE = 24


def methods(mesh: Mesh) -> dict[str, tuple[Callable[[], Any], Callable[[Any, np.ndarray], np.ndarray]]]:
    """For each name, what prepares the mesh, and the distances (q, n) from vertices (q,) by what that gave."""
    search = lambda graph, sources: dijkstra(graph, indices=sources)  # noqa: E731
    found: dict[str, Any] = {
        f"unfolded {depth}" if depth else "edges": (lambda d=depth: geodesic_graph(mesh, d), search)
        for depth in (0, 1, 2, 4, 6, 8)
    }
    found["heat"] = (
        lambda: potpourri3d.MeshHeatMethodDistanceSolver(mesh.vertices, mesh.faces),
        lambda solver, sources: np.stack([solver.compute_distance(int(s)) for s in sources]),
    )
    found["fast marching"] = (
        lambda: potpourri3d.MeshFastMarchingDistanceSolver(mesh.vertices, mesh.faces),
        lambda solver, sources: np.stack([solver.compute_distance([[(int(s), [])]]) for s in sources]),
    )
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", nargs="?", type=Path, help="a mesh of one component")
    parser.add_argument("--sources", type=int, default=30, help="source vertices, drawn at random (default: 30)")
    parser.add_argument("--json", type=Path, help="write the rows there too")
    options = parser.parse_args()
    mesh = read_mesh(options.mesh) if options.mesh else bumpy_sphere(5000)
    v, f = mesh.vertices, mesh.faces
    edge = np.linalg.norm(v[f] - v[np.roll(f, 1, axis=1)], axis=2).mean()
    sources = np.random.default_rng(0).choice(len(v), options.sources, replace=False)
    exact = dijkstra(geodesic_graph(mesh, REFERENCE), indices=sources)
    apart, near = exact > 0, (exact > 0) & (exact <= 3 * edge)
    print("{:15} {:>9} {:>10} {:>7} {:>7} {:>7}".format("", "prepare s", "a source ms", "mean", "near", "worst"))
    rows = []
    with one_blas_thread():
        for name, (prepare, distances) in methods(mesh).items():
            start = time.process_time()
            prepared = prepare()
            ready = time.process_time()
            got = distances(prepared, sources)
            done = time.process_time()
            error = 100 * np.abs(got - exact) / np.where(apart, exact, 1)
            row = {
                "method": name,
                "prepare_s": ready - start,
                "source_ms": 1e3 * (done - ready) / len(sources),
                "mean": error[apart].mean(),
                "near": error[near].mean(),
                "worst": error[apart].max(),
            }
            rows.append(row)
            print("{:15} {:9.3f} {:10.2f} {:7.2f} {:7.2f} {:7.1f}".format(*row.values()), flush=True)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
