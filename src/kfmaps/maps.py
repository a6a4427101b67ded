"""From a functional map to a point map and back, and the nearest neighbours that both rest on."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import Array, blocks, check, is_numpy, namespace, refuse, take, to_numpy
from kfmaps._threads import available_cores, parallel
from kfmaps.spectrum import Basis

TREE_DIMENSION = 32
"""Up to here a k-d tree beats the matrix product on large sets; beyond, space is too empty for it."""


def nearest(queries: Array, points: Array, block: int = 1024, threads: int | None = None) -> np.ndarray:
    """For each row of ``queries (q, d)`` the index of the closest row of ``points (p, d)``: ``(q,)`` int64.

    Exact in the arrays' precision; of equally close points the first. Blocks of matrix products over Python
    threads on NumPy, one block after another elsewhere; a k-d tree on large sets in few dimensions.
    """
    check(points, "points", shape=(None, None), finite=True)
    check(queries, "queries", shape=(None, points.shape[1]), finite=True, remedy="give both the same dimension")
    if points.shape[0] == 0:
        raise refuse("points", "at least one", "none", "give some")
    if is_numpy(queries) and points.shape[1] <= TREE_DIMENSION and len(points) > 20_000:
        return np.asarray(KDTree(points).query(queries, workers=threads or available_cores())[1], dtype=np.int64)
    xp = namespace(queries, points)
    centre = xp.mean(points, axis=0, keepdims=True)
    points, queries = points - centre, queries - centre
    half = 0.5 * xp.sum(points * points, axis=1)[None, :]
    transposed = points.T

    def best(rows: slice) -> np.ndarray:
        return to_numpy(xp.argmin(half - queries[rows, :] @ transposed, axis=1))

    parts = blocks(queries.shape[0], block)
    found = parallel(best, parts, threads) if is_numpy(queries) else [best(rows) for rows in parts]
    return np.concatenate(found).astype(np.int64) if found else np.zeros(0, dtype=np.int64)


def to_points(C: Array, source: Basis, target: Basis, threads: int | None = None) -> np.ndarray:
    """The point map ``target_to_source (n_t,)`` of a functional map ``C (k_t, k_s)``.

    Rows of ``Φ_s Cᵀ`` are the images of the source's delta functions, rows of ``Φ_t`` the target's deltas; each of
    the latter takes the closest of the former (Ovsjanikov et al. 2012). Bases larger than ``C`` are truncated.
    """
    k_t, k_s = C.shape
    source, target = source.truncated(k_s), target.truncated(k_t)
    return nearest(target.functions, source.functions @ C.T, threads=threads)


def to_functional(target_to_source: np.ndarray, source: Basis, target: Basis) -> Array:
    """The functional map ``C (k_t, k_s)`` of a point map: ``Φ_tᵀ A_t Φ_s[target_to_source]``."""
    rows = check_point_map(target_to_source, source.functions.shape[0], target.functions.shape[0])
    return target.project(take(source.functions, rows))


def check_point_map(target_to_source: np.ndarray, n_s: int, n_t: int) -> np.ndarray:
    """``target_to_source`` as int64 when it gives each of ``n_t`` vertices one of ``n_s``."""
    points = np.asarray(target_to_source)
    if points.shape != (n_t,) or not np.issubdtype(points.dtype, np.integer):
        got = f"{points.dtype} of shape {points.shape}"
        raise refuse(
            "target_to_source",
            f"whole numbers of shape ({n_t},)",
            got,
            "give a source vertex per target vertex",
        )
    if n_t and (points.min() < 0 or points.max() >= n_s):
        got = f"{int(points.min())} to {int(points.max())}"
        raise refuse("target_to_source", f"vertices 0 to {n_s - 1}", got, "is it a map to another shape, or 1-based?")
    return points.astype(np.int64)
