"""Distances along a surface."""

from __future__ import annotations

import numpy as np
import potpourri3d
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from kfmaps._arrays import check_count, refuse
from kfmaps._threads import parallel
from kfmaps.mesh import Mesh

METHODS = ("unfolded", "dijkstra", "heat")


def _graph(mesh: Mesh, unfolded: bool) -> csr_array:
    """The symmetric graph whose shortest paths approximate geodesics."""
    v, f = mesh.vertices, mesh.faces
    n = len(v)
    if len(f) == 0:
        near, index = cKDTree(v).query(v, k=min(9, n))
        rows, cols, data = np.repeat(np.arange(n), index.shape[1]), index.ravel(), near.ravel()
    else:
        a, b, c = (f[:, [0, 1, 2]].ravel(), f[:, [1, 2, 0]].ravel(), f[:, [2, 0, 1]].ravel())
        rows, cols = a, b
        data = np.linalg.norm(v[a] - v[b], axis=1)
        if unfolded:
            low, high = np.minimum(a, b), np.maximum(a, b)
            order = np.lexsort((high, low))
            low, high, c = low[order], high[order], c[order]
            step = 1
            more = [(rows, cols, data)]
            while step < len(low):
                same = (low[step:] == low[:-step]) & (high[step:] == high[:-step])
                if not same.any():
                    break
                p = np.flatnonzero(same)
                i, j, k, m = low[p], high[p], c[p], c[p + step]
                axis = v[j] - v[i]
                length = np.linalg.norm(axis, axis=1)
                unit = axis / np.where(length > 0, length, 1)[:, None]
                x1, x2 = ((v[k] - v[i]) * unit).sum(1), ((v[m] - v[i]) * unit).sum(1)
                h1 = np.linalg.norm(v[k] - v[i] - x1[:, None] * unit, axis=1)
                h2 = np.linalg.norm(v[m] - v[i] - x2[:, None] * unit, axis=1)
                tall = h1 + h2
                cross = x1 + (x2 - x1) * h1 / np.where(tall > 0, tall, 1)
                keep = (cross >= 0) & (cross <= length) & (tall > 0) & (k != m)
                more.append((k[keep], m[keep], np.hypot(x1 - x2, tall)[keep]))
                step += 1
            rows, cols, data = (np.concatenate(x) for x in zip(*more, strict=True))
    low, high = np.minimum(rows, cols), np.maximum(rows, cols)
    keep = low < high
    low, high, data = low[keep], high[keep], data[keep]
    order = np.lexsort((data, high, low))
    low, high, data = low[order], high[order], data[order]
    first = np.ones(len(low), dtype=bool)
    first[1:] = (low[1:] != low[:-1]) | (high[1:] != high[:-1])
    low, high, data = low[first], high[first], np.maximum(data[first], np.finfo(float).tiny)
    return csr_array(
        (np.tile(data, 2), (np.concatenate([low, high]), np.concatenate([high, low]))), shape=(n, n)
    )


def geodesic_distances(
    mesh: Mesh, sources: np.ndarray, method: str = "unfolded", threads: int | None = None
) -> np.ndarray:
    """Distances along the surface from each source to every vertex, (q, n), in the mesh's units."""
    sources = np.asarray(sources, dtype=np.int64)
    if method not in METHODS:
        raise refuse("method", f"one of {', '.join(METHODS)}", repr(method), "choose one of them")
    if method == "heat":
        if len(mesh.faces) == 0:
            solver = potpourri3d.PointCloudHeatSolver(mesh.vertices)
        else:
            solver = potpourri3d.MeshHeatMethodDistanceSolver(mesh.vertices, mesh.faces)
        return np.stack([solver.compute_distance(int(s)) for s in sources])
    graph = _graph(mesh, method == "unfolded")
    blocks = np.array_split(sources, max(1, len(sources) // 16))
    return np.concatenate(parallel(lambda s: dijkstra(graph, indices=s), blocks, threads))


def distance_pairs(
    mesh: Mesh, a: np.ndarray, b: np.ndarray, method: str = "unfolded", threads: int | None = None
) -> np.ndarray:
    """Distance from vertex ``a[i]`` to vertex ``b[i]``, (q,), in the mesh's units."""
    a, b = np.asarray(a, dtype=np.int64), np.asarray(b, dtype=np.int64)
    graph = _graph(mesh, method == "unfolded")
    unique, row = np.unique(a, return_inverse=True)
    result = np.zeros(len(a))

    def fill(block: np.ndarray) -> None:
        distances = dijkstra(graph, indices=unique[block])
        here = np.flatnonzero((row >= block[0]) & (row <= block[-1]))
        result[here] = distances[row[here] - block[0], b[here]]

    parallel(fill, np.array_split(np.arange(len(unique)), max(1, len(unique) // 16)), threads)
    return result


def farthest_geodesic(
    mesh: Mesh, count: int, rng: int | np.random.Generator = 0, first: int | None = None
) -> np.ndarray:
    """``count`` vertices spread evenly over the surface, (count,), each the farthest from those before."""
    n = len(mesh.vertices)
    check_count(count, "count", 1, n)
    graph = _graph(mesh, False)
    used = np.ones(n, dtype=bool) if len(mesh.faces) == 0 else np.isin(np.arange(n), mesh.faces)
    if first is None:
        first = int(np.random.default_rng(rng).choice(np.flatnonzero(used)))
    samples = [first]
    nearest = dijkstra(graph, indices=first)
    while len(samples) < count:
        samples.append(int(np.argmax(np.where(used, nearest, -1))))
        reach = nearest.max()
        nearest = np.minimum(nearest, dijkstra(graph, indices=samples[-1], limit=reach))
    return np.array(samples)
