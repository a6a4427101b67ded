"""Approximate nearest neighbours among very many points of a surface, by an inverted file of two levels.

In the 100 or 200 dimensions of a basis no tree prunes: the nearest point is seldom much nearer than those around it.
But the points lie on a surface, so the neighbours of a near point are near, too. The points are assigned to at most 512
patches by the nearest centre, and patches are cut into cells of some 64 points. Each query probes the 8 nearest
patches, then the nearest cells in these, then their points. All of this is matrix products in single precision between
groups of nearby queries and everything that one of them probes. So a query is compared with some two thousand centres
and points, however many there are. Patches must be smaller than the functions' waves, since all larger distances are
alike. The errors are in research/speed.md.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import blocks, check_count, index_ranges
from kfmaps._threads import parallel

N_PROBE = 16
"""Cells that a query probes."""
N_PROBE_FAST = 4
"""Cells that a query probes where nearly the nearest will do: one in 150 is missed, by little."""


def approximate_nearest(
    queries: np.ndarray,
    points: np.ndarray,
    *,
    size: int = 64,
    n_probe: int = N_PROBE,
) -> np.ndarray:
    """Return for each query a point that is nearly the closest, (q,) int64.

    ``queries (q, d)`` and ``points (p, d)``: at least one point. More is missed where rows with similar leading columns
    are not similar, as those of smooth functions on a surface are, the lowest first. ``size``: about how many points a
    cell has; with ``p`` all points are compared, in single precision. ``n_probe``: cells that each query probes.
    """
    p, q = len(points), len(queries)
    n_probe = check_count(n_probe, "n_probe")
    centre = points.mean(axis=0, dtype=np.float64)
    unit = float((points.max(axis=0) - points.min(axis=0)).max()) or 1.0
    order, cell_starts, patch_starts = _cells(points, check_count(size, "cell size"), centre, unit)
    rows = np.concatenate([_single(points[order[part]], centre, unit) for part in blocks(p, 4096)])
    cell_centres = _means(rows, cell_starts)
    patch_centres = _means(rows, cell_starts[patch_starts])
    # Few queries among many points lie far apart: a large group of them would probe everything.
    group_size = 128  # most queries of one group
    query_order, group_starts = _runs(queries, int(np.clip(group_size * 16 * q / p, 1, group_size)))
    nearest = np.empty(q, dtype=np.int64)

    def search(groups: slice) -> None:
        patch_probes = 8  # patches that a query probes
        for i in range(groups.start, groups.stop):
            group = query_order[group_starts[i] : group_starts[i + 1]]
            x = _single(queries[group], centre, unit)
            # Relative to the mean of the group, differences of nearly equal distances lose no digits.
            mean = x.mean(axis=0)
            x -= mean
            cells = _members(patch_starts, _probed(x, patch_centres - mean, patch_probes))
            cells = cells[_probed(x, cell_centres[cells] - mean, n_probe)]
            candidates = _members(cell_starts, cells)
            nearest[group] = order[candidates[np.argmax(_scores(x, rows[candidates] - mean), axis=1)]]

    parallel(search, blocks(len(group_starts) - 1, 64))
    return nearest


def _cells(points: np.ndarray, size: int, centre: np.ndarray, unit: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return an order of ``points``, where each cell starts in it, and the first cell of each patch, with the ends."""
    count = min(512, -(-len(points) // size))
    order, starts = _runs(points, -(-len(points) // count))
    seeds = _single(points[order[(starts[:-1] + starts[1:]) // 2]], centre, unit)

    def closest(part: slice) -> np.ndarray:
        return np.argmax(_scores(_single(points[part], centre, unit), seeds), axis=1)

    patch = np.concatenate(parallel(closest, blocks(len(points), 4096)))
    # The order within a patch is kept, so that a run of it is a cell.
    order = order[np.argsort(patch[order], kind="stable")]
    sizes = np.bincount(patch)
    sizes = sizes[sizes > 0]
    n_cells = -(-sizes // size)
    cell = index_ranges(np.zeros_like(n_cells), n_cells)
    offsets = np.repeat(sizes, n_cells) * cell // np.repeat(n_cells, n_cells)
    cell_starts = np.repeat(np.cumsum(sizes) - sizes, n_cells) + offsets
    return order, np.append(cell_starts, len(points)), np.append(0, np.cumsum(n_cells))


def _runs(rows: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Return an order of ``rows`` with runs of at most ``size`` nearby ones, and where the runs start, with the end."""
    n = len(rows)
    if n == 0:
        return np.zeros(0, dtype=np.int64), np.zeros(1, dtype=np.int64)
    halvings = max(0, int(np.ceil(np.log2(n / size))))
    # Rows are near where the lowest functions of the basis are.
    leading = rows[:, :9] / (1 + np.arange(min(9, rows.shape[1])))
    order = KDTree(leading, leafsize=-(-n // 2**halvings)).indices
    return order, np.unique(np.round(np.linspace(0, n, 2**halvings + 1)).astype(np.int64))


def _single(rows: np.ndarray, centre: np.ndarray, unit: float) -> np.ndarray:
    return ((rows - centre) / unit).astype(np.float32)


def _means(rows: np.ndarray, starts: np.ndarray) -> np.ndarray:
    """Return the mean of each run of ``rows``; runs start at ``starts``, which has the end too."""
    return np.add.reduceat(rows, starts[:-1], axis=0) / np.diff(starts)[:, None].astype(rows.dtype)


def _scores(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return ``x·y − ½|y|²``, (n, m), larger where a row of ``y (m, d)`` is closer to one of ``x (n, d)``."""
    scores = x @ y.T
    scores -= 0.5 * np.einsum("ij,ij->i", y, y)
    return scores


def _probed(x: np.ndarray, y: np.ndarray, count: int) -> np.ndarray:
    """Return the rows of ``y`` that are among the ``count`` closest to some row of ``x``, in ascending order."""
    if count >= len(y):
        return np.arange(len(y))
    scores = _scores(x, y)
    is_probed = np.zeros(len(y), dtype=bool)
    is_probed[np.argpartition(scores, len(y) - count, axis=1)[:, -count:]] = True
    return np.flatnonzero(is_probed)


def _members(starts: np.ndarray, runs: np.ndarray) -> np.ndarray:
    """Return the members of the ``runs``, in their order; run i has ``starts[i]`` to ``starts[i + 1] - 1``."""
    return index_ranges(starts[runs], starts[runs + 1] - starts[runs])
