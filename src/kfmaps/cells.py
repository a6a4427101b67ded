"""Nearest neighbours among very many points of a surface, approximately, in time that grows as their number does.

In the 100 or 200 dimensions of a basis no tree prunes: the nearest point is seldom much nearer than those around it.
Yet the points are those of a surface, so what is near to the query has near points around it. Points are cut into
cells of some 64 that lie together, queries into groups of at most 128; a group looks at the 128 cells nearest to
its centre, each query in it at the 16 of them that are nearest to itself, and all points in the cells that any query
of the group has named are compared with all its queries, in one matrix product of single precision. So a query
meets about a thousand points, however many there are. What is lost is in docs/performance.md.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import blocks, check_count
from kfmaps._threads import parallel

CELL = 64
"""Points in a cell, about."""
GROUP = 128
"""Queries that choose their cells together, at most."""
NEAR = 128
"""Cells that a group looks at."""
PROBES = 16
"""Cells that a query names."""
LEADING = 9
"""Leading columns, in falling weight, that say which rows lie together: the lowest functions of a basis."""


def nearest_by_cells(
    queries: np.ndarray,
    points: np.ndarray,
    *,
    size: int = CELL,
    probes: int = PROBES,
    threads: int | None = None,
) -> np.ndarray:
    """Approximately nearest rows of ``points (p, d)`` to those of ``queries (q, d)``: ``(q,)`` int64.

    Parameters
    ----------
    queries : (q, d) float64
    points : (p, d) float64
        At least one. Rows whose leading columns are alike should be alike: those of smooth functions on a surface,
        the lowest first. Otherwise more is missed.
    size : int
        Points in a cell, about. With ``p`` all points are compared, in single precision.
    probes : int
        Cells that each query names.
    threads : int, optional
        Python threads; ``None`` takes every core.
    """
    p, (q, d) = len(points), queries.shape
    probes, near = check_count(probes, "probes"), max(NEAR, probes)
    order, edges = _runs(points, check_count(size, "cell size"))
    middle = points.mean(axis=0)
    unit = float((points.max(axis=0) - points.min(axis=0)).max()) or 1.0
    rows = np.concatenate([_single(points[order[part]], middle, unit) for part in blocks(p, 65536)])
    centres = np.add.reduceat(rows, edges[:-1], axis=0) / np.diff(edges)[:, None].astype(np.float32)
    # A column more makes the product the score: the larger, the nearer.
    rows, centres = _scored(rows), _scored(centres)
    near, probes = min(near, len(centres)), min(probes, len(centres))
    # The cells of a group are to cover several times its share of the surface, also where queries are few.
    members, bounds = _runs(queries, int(np.clip(near * size * q / (4 * p), 1, GROUP)))
    within = np.arange(np.diff(edges).max(initial=0))
    answer = np.empty(q, dtype=np.int64)

    def search(groups: slice) -> None:
        here = bounds[groups.start : groups.stop + 1]
        x = np.ones((here[-1] - here[0], d + 1), dtype=np.float32)
        x[:, :-1] = _single(queries[members[here[0] : here[-1]]], middle, unit)
        starts = here[:-1] - here[0]
        scores = (np.add.reduceat(x, starts, axis=0) / np.diff(here)[:, None].astype(np.float32)) @ centres.T
        for i, start in enumerate(starts):
            mine = x[start : start + here[i + 1] - here[i]]
            cells = _largest(scores[i : i + 1], near)[0]
            named = np.zeros(near, dtype=bool)
            named[_largest(mine @ centres[cells].T, probes)] = True
            cells = cells[named]
            # Cells differ by a point in size: the shorter ones repeat their last.
            found = np.minimum(edges[cells][:, None] + within, edges[cells + 1][:, None] - 1).ravel()
            best = np.argmax(mine @ rows[found].T, axis=1)
            answer[members[here[i] : here[i + 1]]] = order[found[best]]

    parallel(search, blocks(len(bounds) - 1, 256), threads)
    return answer


def _runs(rows: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """An order of ``rows`` in which runs of at most ``size`` lie together, and where the runs start (and the end)."""
    n = len(rows)
    if n == 0:
        return np.zeros(0, dtype=np.int64), np.zeros(1, dtype=np.int64)
    halvings = max(0, int(np.ceil(np.log2(n / size))))
    leading = rows[:, :LEADING] / (1 + np.arange(min(LEADING, rows.shape[1])))
    order = KDTree(leading, leafsize=-(-n // 2**halvings)).indices
    return order, np.unique(np.round(np.linspace(0, n, 2**halvings + 1)).astype(np.int64))


def _single(rows: np.ndarray, middle: np.ndarray, unit: float) -> np.ndarray:
    return ((rows - middle) / unit).astype(np.float32)


def _scored(rows: np.ndarray) -> np.ndarray:
    """``rows`` with a last column ``-|row|²/2``."""
    return np.column_stack([rows, -0.5 * np.einsum("ij,ij->i", rows, rows)])


def _largest(scores: np.ndarray, count: int) -> np.ndarray:
    """Columns of the ``count`` largest in each row of ``scores (m, c)``, in no order."""
    if count >= scores.shape[1]:
        return np.broadcast_to(np.arange(scores.shape[1]), scores.shape)
    return np.argpartition(scores, scores.shape[1] - count, axis=1)[:, -count:]
