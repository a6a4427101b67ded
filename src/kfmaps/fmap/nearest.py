"""Nearest neighbours in the high dimension of functional maps, exact or approximate.

The exact search is one matrix product and costs queries × points × dimensions. Large sets are searched by
:mod:`kfmaps.fmap.approximate_nearest`.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import Array, blocks, check, is_numpy, namespace, refuse, to_numpy
from kfmaps._threads import n_threads, parallel
from kfmaps.fmap.approximate_nearest import N_PROBE, approximate_nearest

_TREE_POINTS = 20_000  # points beyond which a k-d tree is built

_TIE = 1e-12  # relative difference below which two distances from the tree are compared again

EXACT_PAIRS = 10_000**2
"""Queries times points up to which the search is exact by default."""


def nearest(
    queries: Array,
    points: Array,
    block: int = 1024,
    exact: bool | None = None,
    n_probe: int = N_PROBE,
) -> np.ndarray:
    """Return for each query the closest of some points, (q,) int64.

    Up to :data:`EXACT_PAIRS` pairs, and on arrays other than NumPy's, the search is exact in the arrays' precision and
    returns the first of equally close points. NumPy arrays are compared by blocks of matrix products over Python
    threads, in float32 with a check in float64, or by a k-d tree, also exact, where many points have few dimensions.

    Parameters
    ----------
    queries, points : (q, d), (p, d)
    block : int
        Rows of one matrix product.
    exact : bool, optional
        ``True``: never search approximately. ``False``: do so on NumPy arrays of any size in many dimensions.
    n_probe : int
        Cells that each query probes in an approximate search
        (:func:`kfmaps.fmap.approximate_nearest.approximate_nearest`).

    Raises
    ------
    InvalidInput
        When there are no points, the dimensions differ, or a number is not finite.
    """
    check(points, "points", shape=(None, None), finite=True)
    check(queries, "queries", shape=(None, points.shape[1]), finite=True, remedy="give both the same dimension")
    if points.shape[0] == 0:
        raise refuse("points", "at least one", "none", "give at least one")
    if is_numpy(queries):
        queries, points = _rescale(queries, points)
        if _uses_tree(len(points), points.shape[1]):
            return _by_tree(queries, points)
        if is_approximate(len(queries), len(points), points.shape[1], exact):
            return approximate_nearest(queries, points, n_probe=n_probe)
    return _exact(queries, points, block)


def _uses_tree(points: int, dimensions: int) -> bool:
    """Return whether a k-d tree is built; in more dimensions it does not beat the matrix product."""
    return dimensions <= 32 and points > _TREE_POINTS


def is_approximate(n_queries: int, n_points: int, dimensions: int, exact: bool | None) -> bool:
    """Return whether :func:`nearest` searches NumPy arrays of these sizes approximately, in single precision.

    ``n_queries`` and ``n_points``: how many rows both have; ``dimensions``: their columns; ``exact``: as for
    :func:`nearest`.
    """
    has_many_pairs = exact is False or (exact is None and n_queries * n_points > EXACT_PAIRS)
    return has_many_pairs and not _uses_tree(n_points, dimensions)


def _rescale(queries: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return both times one power of two, where squares of their numbers would over- or underflow."""
    size = max(max(-float(x.min(initial=0.0)), float(x.max(initial=0.0))) for x in (points, queries))
    if size == 0 or 2.0**-300 < size < 2.0**300:
        return queries, points
    shift = -int(np.frexp(size)[1])
    return np.ldexp(queries, shift), np.ldexp(points, shift)


def _by_tree(queries: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Search exactly by a k-d tree; ties are compared once more, so that the first of equally close points is taken."""
    tree, workers = KDTree(points), n_threads()
    distance, index = map(np.asarray, tree.query(queries, k=2, workers=workers))
    result = index[:, 0].astype(np.int64)
    ties = np.flatnonzero(distance[:, 1] <= distance[:, 0] * (1 + _TIE))
    if len(ties) == 0:
        return result
    # Only the first of coincident points, so that not all of them come back for every query.
    first = np.sort(np.unique(points, axis=0, return_index=True)[1])
    tree = KDTree(points[first])
    for part in blocks(len(ties), 256):
        rows = ties[part]
        balls = tree.query_ball_point(queries[rows], distance[rows, 0] * (1 + _TIE), workers=workers)
        for i, ball in zip(rows, balls, strict=True):
            result[i] = _first_closest(queries[i], points, first[np.sort(np.asarray(ball, dtype=np.int64))])
    return result


def _first_closest(query: np.ndarray, points: np.ndarray, candidates: np.ndarray) -> int:
    """Return the first of the closest among the ``candidates``, ascending rows of ``points``."""
    offsets = points[candidates] - query
    return candidates[np.argmin(np.einsum("ij,ij->i", offsets, offsets))]


def _exact(queries: Array, points: Array, block: int) -> np.ndarray:
    if is_numpy(queries, points) and queries.dtype == points.dtype == np.float64:
        return _screened(queries, points, block)
    xp = namespace(queries, points)
    centre = xp.mean(points, axis=0, keepdims=True)
    points = points - centre
    half = 0.5 * xp.sum(points * points, axis=1)[None, :]
    transposed = points.T
    parts = [
        to_numpy(xp.argmin(half - (queries[rows, :] - centre) @ transposed, axis=1))
        for rows in blocks(queries.shape[0], max(16, min(block, 8_000_000 // points.shape[0])))
    ]
    return np.concatenate([np.zeros(0, dtype=np.int64), *parts])


def _screened(queries: np.ndarray, points: np.ndarray, block: int) -> np.ndarray:
    """Search exactly in float64, with most of the work in float32 at twice the speed.

    A product in float32 gives the scores of all points. The best point is the closest where the second best is behind
    it by more than the errors of both (at most ``γ = (d + 4) u`` times the sizes of the factors, Higham 2002, section
    3.1). Elsewhere, for a few per cent of the queries, all points within these errors are compared in float64.
    """
    centre = points.mean(axis=0)
    points = points - centre
    squares = np.einsum("ij,ij->i", points, points)
    size = max(float(np.sqrt(squares.max())), float(np.abs(queries - centre).max(initial=0.0))) or 1.0
    # One more column holds half the squared length, so that the product is ``x·y − ½|y|²``.
    single = _single(points, size, -0.5 * squares / size**2).T
    error = 1.01 * (points.shape[1] + 4) * 2.0**-24

    def best(rows: slice) -> np.ndarray:
        x = queries[rows] - centre
        score = _single(x, size, 1.0) @ single
        each = np.arange(len(x))
        closest = np.argmax(score, axis=1)
        top = score[each, closest].astype(np.float64)
        score[each, closest] = -np.inf
        lengths = np.sqrt(np.einsum("ij,ij->i", x, x)) / size
        # Closer points cannot be longer than this, which bounds their errors.
        max_length = lengths + np.sqrt(np.maximum(lengths**2 - 2 * top, 0.0) + 2 * error * (lengths + 0.5))
        lowest = top - 2 * error * (lengths + 0.5 * max_length) * max_length
        doubtful = np.flatnonzero(~(score.max(axis=1) < lowest))
        score[doubtful, closest[doubtful]] = top[doubtful]
        for i in doubtful:
            closest[i] = _first_closest(x[i], points, np.flatnonzero(score[i] >= lowest[i]))
        return closest

    # The scores of one block should stay in the cache, but products of few rows are slow.
    rows = max(600_000 // len(points), min(64, 16_000_000 // len(points)), 16)
    parts = parallel(best, blocks(len(queries), min(block, rows)))
    return np.concatenate([np.zeros(0, dtype=np.int64), *parts])


def _single(rows: np.ndarray, size: float, last: np.ndarray | float) -> np.ndarray:
    """Return ``rows (n, d)`` over ``size`` and the column ``last`` as float32, (n, d + 1)."""
    result = np.empty((rows.shape[0], rows.shape[1] + 1), dtype=np.float32)
    np.divide(rows, size, out=result[:, :-1], casting="same_kind")
    result[:, -1] = last
    return result
