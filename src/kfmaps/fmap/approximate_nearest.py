"""Nearest neighbours among very many points of a surface, approximately, in time that grows as their number does.

In the 100 or 200 dimensions of a basis no tree prunes: the nearest point is seldom much nearer than those around it.
Yet the points are those of a surface, so what is near to the query has near points around it. The points are shared out
among at most 512 patches, each to that of whose middle it is nearest, and patches are cut into cells of some 64. Each
query names the 8 patches nearest to it, then the nearest cells in these, and searches those. All of it is matrix
products in single precision, of groups of queries that lie together with whatever any of them has named: so a query
meets some two thousand middles and points, however many there are. Patches larger than the functions' waves would not
do: beyond those all distances are alike. What is lost is in research/speed.md.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import blocks, check_count, index_ranges
from kfmaps._threads import parallel

_GROUP_SIZE = 128  # queries that are worked on together, at most
N_PROBE = 16
"""Cells that a query names."""
N_PROBE_FAST = 4
"""Cells that a query names whose answer need not be quite the nearest: it misses one in 150, by little."""


def approximate_nearest(
    queries: np.ndarray,
    points: np.ndarray,
    *,
    size: int = 64,
    probes: int = N_PROBE,
) -> np.ndarray:
    """Return for each query a point that is nearly the closest, (q,) int64.

    ``queries (q, d)`` and ``points (p, d)``: at least one point. Rows whose leading columns are alike should be alike:
    those of smooth functions on a surface, the lowest first. Otherwise more is missed. ``size``: points in a cell,
    about. With ``p`` all points are compared, in single precision. ``probes``: cells that each query names.
    """
    p, q = len(points), len(queries)
    probes = check_count(probes, "probes")
    middle = points.mean(axis=0, dtype=np.float64)
    unit = float((points.max(axis=0) - points.min(axis=0)).max()) or 1.0
    order, edges, patches = _cells(points, check_count(size, "cell size"), middle, unit)
    rows = np.concatenate([_single(points[order[part]], middle, unit) for part in blocks(p, 4096)])
    centres = _means(rows, edges)
    wider = _means(rows, edges[patches])
    # Few queries among many points lie far apart: groups of them would name everything.
    members, bounds = _runs(queries, int(np.clip(_GROUP_SIZE * 16 * q / p, 1, _GROUP_SIZE)))
    answer = np.empty(q, dtype=np.int64)

    def search(groups: slice) -> None:
        for i in range(groups.start, groups.stop):
            mine = members[bounds[i] : bounds[i + 1]]
            x = _single(queries[mine], middle, unit)
            # Seen from the middle of the group, differences of nearly equal distances lose no digits.
            here = x.mean(axis=0)
            x -= here
            cells = _inside(patches, _named(x, wider - here, 8))
            cells = cells[_named(x, centres[cells] - here, probes)]
            found = _inside(edges, cells)
            answer[mine] = order[found[np.argmax(_scores(x, rows[found] - here), axis=1)]]

    parallel(search, blocks(len(bounds) - 1, 64))
    return answer


def _cells(points: np.ndarray, size: int, middle: np.ndarray, unit: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """An order of ``points``, where each cell starts in it, and which cell each patch starts with (and the ends)."""
    count = min(512, -(-len(points) // size))
    order, starts = _runs(points, -(-len(points) // count))
    seeds = _single(points[order[(starts[:-1] + starts[1:]) // 2]], middle, unit)

    def closest(part: slice) -> np.ndarray:
        return np.argmax(_scores(_single(points[part], middle, unit), seeds), axis=1)

    patch = np.concatenate(parallel(closest, blocks(len(points), 4096)))
    # Within a patch the order stays: what lies together there is a cell.
    order = order[np.argsort(patch[order], kind="stable")]
    sizes = np.bincount(patch)
    sizes = sizes[sizes > 0]
    pieces = -(-sizes // size)
    piece = index_ranges(np.zeros_like(pieces), pieces)
    edges = np.repeat(np.cumsum(sizes) - sizes, pieces) + np.repeat(sizes, pieces) * piece // np.repeat(pieces, pieces)
    return order, np.append(edges, len(points)), np.append(0, np.cumsum(pieces))


def _runs(rows: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """An order of ``rows`` in which runs of at most ``size`` lie together, and where the runs start (and the end)."""
    n = len(rows)
    if n == 0:
        return np.zeros(0, dtype=np.int64), np.zeros(1, dtype=np.int64)
    halvings = max(0, int(np.ceil(np.log2(n / size))))
    # The lowest functions of a basis say which rows lie together.
    leading = rows[:, :9] / (1 + np.arange(min(9, rows.shape[1])))
    order = KDTree(leading, leafsize=-(-n // 2**halvings)).indices
    return order, np.unique(np.round(np.linspace(0, n, 2**halvings + 1)).astype(np.int64))


def _single(rows: np.ndarray, middle: np.ndarray, unit: float) -> np.ndarray:
    return ((rows - middle) / unit).astype(np.float32)


def _means(rows: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Mean of each run of ``rows`` between ``edges``."""
    return np.add.reduceat(rows, edges[:-1], axis=0) / np.diff(edges)[:, None].astype(rows.dtype)


def _scores(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """``(n, m)``: the larger, the closer is a row of ``y (m, d)`` to one of ``x (n, d)``."""
    scores = x @ y.T
    scores -= 0.5 * np.einsum("ij,ij->i", y, y)
    return scores


def _named(x: np.ndarray, y: np.ndarray, count: int) -> np.ndarray:
    """Which rows of ``y`` are among the ``count`` closest to some row of ``x``, in ascending order."""
    if count >= len(y):
        return np.arange(len(y))
    scores = _scores(x, y)
    named = np.zeros(len(y), dtype=bool)
    named[np.argpartition(scores, len(y) - count, axis=1)[:, -count:]] = True
    return np.flatnonzero(named)


def _inside(edges: np.ndarray, runs: np.ndarray) -> np.ndarray:
    """What lies in the ``runs`` between ``edges``, in their order."""
    return index_ranges(edges[runs], edges[runs + 1] - edges[runs])
