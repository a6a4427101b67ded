"""Nearest neighbours in the high dimension of functional maps: exact, or by cells where there are very many.

The exact search is one matrix product and costs queries × points × dimensions; :mod:`kfmaps.fmap.approximate_nearest`
is for large sets.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import Array, blocks, check, is_numpy, namespace, refuse, to_numpy
from kfmaps._threads import n_threads, parallel
from kfmaps.fmap.approximate_nearest import N_PROBE, approximate_nearest

_TREE_POINTS = 20_000  # points beyond which a k-d tree is built

_TIE = 1e-12  # relative difference below which two distances from the tree are compared anew

EXACT_PAIRS = 10_000**2
"""Queries times points up to which the search is exact when nothing else is asked for."""


def nearest(
    queries: Array,
    points: Array,
    block: int = 1024,
    exact: bool | None = None,
    probes: int = N_PROBE,
) -> np.ndarray:
    """Return for each query the closest of some points, (q,) int64.

    Exact in the arrays' precision, of equally close points the first, as long as the pairs are at most
    :data:`EXACT_PAIRS` or the arrays are not NumPy's. Blocks of matrix products over Python threads on NumPy, in
    float32 with a check in float64; one block after another elsewhere; a k-d tree, exact too, on large sets in few
    dimensions.

    Parameters
    ----------
    queries, points : (q, d), (p, d)
    block : int
        Rows of one matrix product.
    exact : bool, optional
        ``True`` never searches approximately; ``False`` does so on NumPy arrays of any size in many dimensions.
    probes : int
        Cells that each query names in an approximate search
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
        queries, points = _in_range(queries, points)
        if _in_tree(len(points), points.shape[1]):
            return _by_tree(queries, points)
        if searches_cells(len(queries), len(points), points.shape[1], exact):
            return approximate_nearest(queries, points, probes=probes)
    return _exact(queries, points, block)


def _in_tree(points: int, dimensions: int) -> bool:
    """Whether a k-d tree is built: in more dimensions space is too empty for it to beat the matrix product."""
    return dimensions <= 32 and points > _TREE_POINTS


def searches_cells(queries: int, points: int, dimensions: int, exact: bool | None) -> bool:
    """Return whether :func:`nearest` searches so many rows approximately, which is in single precision.

    ``queries``, ``points`` and ``dimensions``: how many there are; ``exact``: as for :func:`nearest`.
    """
    many = exact is False or (exact is None and queries * points > EXACT_PAIRS)
    return many and not _in_tree(points, dimensions)


def _in_range(queries: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both times one power of two, where squares of their numbers would overflow or vanish."""
    ends = [(float(x.min(initial=0.0)), float(x.max(initial=0.0))) for x in (points, queries)]
    size = max(max(-low, high) for low, high in ends)
    if size == 0 or 2.0**-300 < size < 2.0**300:
        return queries, points
    shift = -int(np.frexp(size)[1])
    return np.ldexp(queries, shift), np.ldexp(points, shift)


def _by_tree(queries: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The exact search by a k-d tree; what it finds as close as the closest is compared anew, for the first of it."""
    tree, workers = KDTree(points), n_threads()
    distance, found = map(np.asarray, tree.query(queries, k=2, workers=workers))
    answer = found[:, 0].astype(np.int64)
    ties = np.flatnonzero(distance[:, 1] <= distance[:, 0] * (1 + _TIE))
    if len(ties) == 0:
        return answer
    # Each place once, so that points given over and over do not all come back for every query.
    first = np.sort(np.unique(points, axis=0, return_index=True)[1])
    tree = KDTree(points[first])
    for part in blocks(len(ties), 256):
        rows = ties[part]
        within = tree.query_ball_point(queries[rows], distance[rows, 0] * (1 + _TIE), workers=workers)
        for i, several in zip(rows, within, strict=True):
            columns = first[np.sort(np.asarray(several, dtype=np.int64))]
            gap = points[columns] - queries[i]
            answer[i] = columns[np.argmin(np.einsum("ij,ij->i", gap, gap))]
    return answer


def _exact(queries: Array, points: Array, block: int) -> np.ndarray:
    if is_numpy(queries, points) and queries.dtype == points.dtype == np.float64:
        return _screened(queries, points, block)
    xp = namespace(queries, points)
    centre = xp.mean(points, axis=0, keepdims=True)
    points = points - centre
    half = 0.5 * xp.sum(points * points, axis=1)[None, :]
    transposed = points.T
    found = [
        to_numpy(xp.argmin(half - (queries[rows, :] - centre) @ transposed, axis=1))
        for rows in blocks(queries.shape[0], max(16, min(block, 8_000_000 // points.shape[0])))
    ]
    return np.concatenate(found).astype(np.int64) if found else np.zeros(0, dtype=np.int64)


def _screened(queries: np.ndarray, points: np.ndarray, block: int) -> np.ndarray:
    """The exact search in float64, most of it done in float32 at twice the speed.

    A product in float32 finds the best point and how far the second best is behind. Where that is more than the errors
    of both can be (``γ = (d + 4) u`` times the sizes of the factors, Higham 2002, section 3.1), the best is the best in
    exact arithmetic too; elsewhere, for a few per cent of the queries, all points within reach of the errors are
    compared in float64.
    """
    centre = points.mean(axis=0)
    points = points - centre
    squares = np.einsum("ij,ij->i", points, points)
    size = max(float(np.sqrt(squares.max())), float(np.abs(queries - centre).max(initial=0.0))) or 1.0
    # A column more holds half the squared length, so that the product is the whole score.
    single = _single(points, size, -0.5 * squares / size**2).T
    error = 1.01 * (points.shape[1] + 4) * 2.0**-24

    def best(rows: slice) -> np.ndarray:
        x = queries[rows] - centre
        score = _single(x, size, 1.0) @ single
        each = np.arange(len(x))
        found = np.argmax(score, axis=1)
        top = score[each, found].astype(np.float64)
        score[each, found] = -np.inf
        lengths = np.sqrt(np.einsum("ij,ij->i", x, x)) / size
        # No point that is closer than the one found is longer than this, which bounds its error.
        reach = lengths + np.sqrt(np.maximum(lengths**2 - 2 * top, 0.0) + 2 * error * (lengths + 0.5))
        lowest = top - 2 * error * (lengths + 0.5 * reach) * reach
        doubt = np.flatnonzero(~(score.max(axis=1) < lowest))
        if len(doubt):
            score[doubt, found[doubt]] = top[doubt]
            found[doubt] = _settled(x[doubt], points, score[doubt] >= lowest[doubt, None])
        return found

    # The scores of one block are to stay in the cache; but products of few rows are slow.
    rows = max(600_000 // len(points), min(64, 16_000_000 // len(points)), 16)
    parts = blocks(len(queries), min(block, rows))
    found = parallel(best, parts)
    return np.concatenate(found).astype(np.int64) if found else np.zeros(0, dtype=np.int64)


def _single(rows: np.ndarray, size: float, last: np.ndarray | float) -> np.ndarray:
    """``rows (n, d)`` over ``size`` and the column ``last`` as float32, ``(n, d + 1)``."""
    result = np.empty((rows.shape[0], rows.shape[1] + 1), dtype=np.float32)
    np.divide(rows, size, out=result[:, :-1], casting="same_kind")
    result[:, -1] = last
    return result


def _settled(x: np.ndarray, points: np.ndarray, possible: np.ndarray) -> np.ndarray:
    """For each of ``x (m, d)`` the closest of the ``points (p, d)`` that are ``possible (m, p)``; first of equals."""
    answer = np.empty(len(x), dtype=np.int64)
    for i, row in enumerate(x):
        columns = np.flatnonzero(possible[i])
        gap = points[columns] - row
        answer[i] = columns[np.argmin(np.einsum("ij,ij->i", gap, gap))]
    return answer
