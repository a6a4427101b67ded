"""Choose which pairs of a collection to match: a connected graph with cycles, a few pairs for each shape.

A pair on no cycle cannot be checked by others. So the graph begins with a spanning tree of the most similar shapes,
which are the easiest to match. It gets further pairs until each shape has a few, and no pair is a bridge.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial.distance import pdist, squareform

from kfmaps._arrays import check, check_count, refuse, to_numpy
from kfmaps.descriptors.spectral import log_heat_signature
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.connectivity import component_labels

Pairs = tuple[tuple[int, int], ...]


def signature(basis: Basis) -> np.ndarray:
    """Return numbers that are close for similar shapes: logarithms of eigenvalues, and quantiles of the heat kernel.

    They do not depend on units (at unit area) or the triangulation, and hardly on the pose. Mirror images have equal
    ones. Differences are of the order of 0.1 to 1.

    Parameters
    ----------
    basis : Basis
        At unit area.

    Returns
    -------
    (d,) float64
    """
    count = 30  # eigenvalues that shapes are compared by
    values = to_numpy(basis.eigenvalues)[1 : count + 1]
    # By Weyl's law the i-th is about 4 π i at unit area.
    growth = np.log(np.maximum(values, 1e-3) / (4 * np.pi * np.arange(1, len(values) + 1)))
    growth = np.concatenate([growth, np.full(count - len(growth), growth[-1] if len(growth) else 0.0)])
    heat = np.quantile(log_heat_signature(basis), np.linspace(0.05, 0.95, 7), axis=0)
    return np.concatenate([growth, heat.ravel()])


def signature_distances(signatures: np.ndarray) -> np.ndarray:
    """Return the root mean square differences between rows of ``signatures (n, d)``: (n, n), symmetric."""
    check(signatures, "signatures", shape=(None, None), finite=True)
    return squareform(pdist(signatures)) / np.sqrt(signatures.shape[1])


def medoid(distances: np.ndarray) -> int:
    """Return the number of the shape with the least sum of ``distances (n, n)`` to the others."""
    return int(distances.sum(axis=1).argmin())


def nearest_neighbor_graph(distances: np.ndarray, each: int = 4) -> Pairs:
    """Return the minimal spanning tree, and nearest neighbours until each shape has ``each`` pairs and lies on cycles.

    Parameters
    ----------
    distances : (n, n)
        See :func:`signature_distances`; symmetric.
    each : int
        Least number of pairs of each shape, from 2 on; there are about ``0.7 · each · n`` pairs, at most ``each · n``.
        A small collection may have fewer.

    Returns
    -------
    tuple of (int, int)
        Each pair once, the smaller number first, in order. The graph stays connected without any one of them, unless
        there are only two shapes.
    """
    count = len(distances)
    # SciPy takes a zero for no edge, but equal shapes have the distance zero.
    lengths = distances + 1e-9 * (1.0 + distances.max())
    tree = coo_array(minimum_spanning_tree(np.triu(lengths, 1)))
    first = {(int(min(a, b)), int(max(a, b))) for a, b in zip(tree.row, tree.col, strict=True)}
    chosen = set(first)
    degree = np.bincount(np.array(sorted(first)).ravel(), minlength=count)
    order = np.argsort(lengths + np.diag(np.full(count, np.inf)), axis=1, kind="stable")[:, : count - 1]
    for shape, others in enumerate(order):
        pairs = [(int(min(shape, other)), int(max(shape, other))) for other in others]
        fresh = [pair for pair in pairs if pair not in first]
        chosen |= set(fresh[: max(each - int(degree[shape]), 0)])
    while (bridge := _bridge(count, chosen)) is not None:
        pair, side = bridge
        between = np.where(side[:, None] & ~side[None, :], lengths, np.inf)
        between[pair], between[pair[::-1]] = np.inf, np.inf
        if not np.isfinite(between).any():
            break
        a, b = np.unravel_index(int(between.argmin()), between.shape)
        chosen.add((int(min(a, b)), int(max(a, b))))
    return tuple(sorted(chosen))


def signature_graph(kind: str, signatures: np.ndarray) -> Pairs:
    """Return the pairs of a graph of shapes with these ``signatures (n, d)``.

    Parameters
    ----------
    kind : "near", "star" or "all"
        :func:`nearest_neighbor_graph`; the :func:`medoid` with all others, without cycles; or all pairs, one way.

    Raises
    ------
    InvalidInput
        On another kind, and when there are fewer than two shapes.
    """
    count = check_count(len(signatures), "shapes", low=2)
    if kind == "all":
        return tuple(combinations(range(count), 2))
    if kind not in ("near", "star"):
        raise refuse("graph", "near, star or all", repr(kind), "choose one of them")
    distances = signature_distances(signatures)
    centre = medoid(distances)
    star = tuple((centre, other) for other in range(count) if other != centre)
    return star if kind == "star" else nearest_neighbor_graph(distances)


def _bridge(count: int, pairs: set[tuple[int, int]]) -> tuple[tuple[int, int], np.ndarray] | None:
    """Return a bridge and which shapes lie on one side of it, (n,) bool; ``None`` where there is no bridge."""
    pair = min(bridges(count, pairs), default=None) if count > 2 else None
    if pair is None:
        return None
    part = component_labels(count, *np.array(sorted(pairs - {pair}), dtype=np.int64).T)[1]
    return pair, part == part[pair[1]]


def bridges(count: int, pairs: Iterable[tuple[int, int]]) -> set[tuple[int, int]]:
    """Return those of the ``pairs`` of ``count`` shapes that lie on no cycle.

    A pair that is given twice is on a cycle of two.
    """
    ends = np.array(list(pairs), dtype=np.int64).reshape(-1, 2)
    parts = component_labels(count, *ends.T)[0]
    forest = minimum_spanning_tree(coo_array((np.ones(len(ends)), ends.T), shape=(count, count))).tocoo()
    candidates = set(zip(forest.row.tolist(), forest.col.tolist(), strict=True))
    every = [(int(a), int(b)) for a, b in ends]
    return {
        pair
        for i, pair in enumerate(every)
        if pair in candidates and component_labels(count, *np.delete(ends, i, axis=0).T)[0] > parts
    }
