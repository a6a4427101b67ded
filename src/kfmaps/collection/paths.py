"""Maps along paths of pairs: the best path from one shape to another, and the composition of the maps on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from kfmaps._arrays import to_numpy
from kfmaps.fmap.convert import check_point_map, nearest
from kfmaps.geometry.basis import Basis, eigenvalue_tolerance


@dataclass(frozen=True)
class MapPath:
    """A path of maps between two shapes."""

    shapes: tuple[int, ...]  # from source to target
    edges: tuple[int, ...]  # numbers of the maps between them
    probability: float  # that all these maps are right


def best_path(
    count: int,
    ends: Sequence[tuple[int, int]],
    probabilities: Sequence[float],
    source: int,
    target: int,
    without: int | None = None,
) -> MapPath | None:
    """Return the path from ``source`` to ``target`` whose maps are most probably all right; ``None`` without one.

    A path with fewer edges is preferred among equally probable ones.

    ``count``: number of shapes; ``ends``: shapes of each edge, which may be used both ways; ``probabilities``: that the
    map of each edge is right; ``without``: an edge that is left out.
    """
    min_probability = 1e-6  # probability below which a pair is on no path
    used = [i for i, p in enumerate(probabilities) if p > min_probability and i != without]
    edges: dict[tuple[int, int], int] = {}  # the most probable between two shapes
    for number in sorted(used, key=lambda i: probabilities[i]):
        edges[min(ends[number]), max(ends[number])] = number
    # A small cost for each step prefers short paths.
    costs = [1e-6 - math.log(min(probabilities[number], 1.0)) for number in edges.values()]
    rows = np.array(list(edges), dtype=np.int64).reshape(-1, 2)
    graph = csr_array((costs, rows.T), shape=(count, count))
    predecessors = dijkstra(graph, directed=False, indices=source, return_predecessors=True)[1]
    shapes = [target]
    while shapes[-1] != source:
        if predecessors[shapes[-1]] < 0:
            return None
        shapes.append(int(predecessors[shapes[-1]]))
    shapes.reverse()
    numbers = [edges[min(pair), max(pair)] for pair in pairwise(shapes)]
    return MapPath(tuple(shapes), tuple(numbers), math.prod(min(probabilities[number], 1.0) for number in numbers))


def compose_maps(maps: Sequence[np.ndarray]) -> np.ndarray:
    """Return the map of a path, (n_last,) int64: a vertex of its first shape for each vertex of its last.

    ``maps[i] (n_{i+1},)`` names for each vertex of the path's shape i + 1 one of shape i.
    """
    composed = np.asarray(maps[-1])
    for previous in reversed(maps[:-1]):
        previous = np.asarray(previous)
        composed = previous[check_point_map(composed, len(previous), len(composed))]
    return composed.astype(np.int64)


def invert_map(target_to_source: np.ndarray, source: Basis, n_t: int) -> np.ndarray:
    """Return the inverse map, (n_s,): for each source vertex the target vertex whose image is nearest to it.

    Distances are those of the source's first eigenfunctions divided by the roots of their eigenvalues. For a one-to-one
    map this is its inverse.
    """
    points = check_point_map(target_to_source, len(source.functions), n_t)
    k = min(60, len(source.eigenvalues))  # functions by which the nearest images are found where a map is inverted
    values = to_numpy(source.eigenvalues)[1:k]
    places = to_numpy(source.functions)[:, 1:k] / np.sqrt(np.maximum(values, max(eigenvalue_tolerance(source), 1e-9)))
    return nearest(places, places[points])
