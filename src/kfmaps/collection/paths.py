"""Maps along paths of pairs: the best way from one shape to another, and the composition of the maps on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heappop, heappush

import numpy as np

from kfmaps._arrays import refuse, to_numpy
from kfmaps.fmap.convert import check_point_map, nearest
from kfmaps.geometry.basis import Basis, zero_level

EMBEDDING = 60
"""Functions by which the nearest images are found where a map is gone through backwards."""
LEAST = 1e-6
"""Probability below which a pair is no way to anywhere."""


@dataclass(frozen=True)
class Way:
    """A path between two shapes.

    Attributes
    ----------
    shapes : tuple of int
        From the source to the target.
    links : tuple of int
        The pairs between them, by number.
    chance : float
        Product of their probabilities.
    """

    shapes: tuple[int, ...]
    links: tuple[int, ...]
    chance: float


Roads = Sequence[Sequence[tuple[int, int]]]
"""Of each shape its neighbours, with the number of the pair between."""


def roads(count: int, ends: Sequence[tuple[int, int]]) -> Roads:
    """The neighbours of each of ``count`` shapes by pairs with these ``ends``, made once for many searches."""
    around: list[list[tuple[int, int]]] = [[] for _ in range(count)]
    for number, (a, b) in enumerate(ends):
        around[a].append((b, number))
        around[b].append((a, number))
    return around


def best_way(
    around: Roads, chances: Sequence[float], source: int, target: int, without: int | None = None
) -> Way | None:
    """The path from ``source`` to ``target`` whose maps are most probably all right; ``None`` where there is none.

    Parameters
    ----------
    around : Roads
        Links are gone through both ways.
    chances : sequence
        Of each link the probability that its map is right. Of equally probable paths the one of the fewest links is
        taken, then of the lowest numbers.
    without : int, optional
        A link that is not to be used.
    """
    return _searched(around, chances, source, target, without).get(target)


def ways_from(around: Roads, chances: Sequence[float], source: int) -> dict[int, Way]:
    """The best ways from one shape to all that can be reached, itself too; as :func:`best_way` finds them.

    A way's first part is the way to where that ends, so that points can be carried along all of them step by step. In
    the order of how probable they are.
    """
    return _searched(around, chances, source)


def _searched(
    around: Roads, chances: Sequence[float], source: int, target: int | None = None, without: int | None = None
) -> dict[int, Way]:
    """Dijkstra's search from ``source``, until ``target`` is found."""
    queue: list[tuple[float, int, tuple[int, ...], tuple[int, ...]]] = [(0.0, 0, (source,), ())]
    found: dict[int, Way] = {}
    while queue:
        cost, length, shapes, links = heappop(queue)
        here = shapes[-1]
        if here in found:
            continue
        found[here] = Way(shapes, links, math.exp(-cost))
        if here == target:
            break
        for other, number in around[here]:
            if other not in found and number != without and chances[number] > LEAST:
                # Rounded, so that what is equal but for rounding is equal; each step costs a little by itself.
                further = round(cost - math.log(min(chances[number], 1.0)) + 1e-6, 9)
                heappush(queue, (further, length + 1, (*shapes, other), (*links, number)))
    return found


def composed(maps: Sequence[np.ndarray]) -> np.ndarray:
    """The map of a path: ``maps[i] (n_{i+1},)`` names for each vertex of the path's shape i + 1 one of shape i.

    Returns
    -------
    (n_last,) int64
        A vertex of the first shape for each vertex of the last.
    """
    if not maps:
        raise refuse("maps", "at least one", "none", "give those between neighbours on the path")
    found = np.asarray(maps[-1])
    for before in reversed(maps[:-1]):
        before = np.asarray(before)
        found = before[check_point_map(found, len(before), len(found))]
    return found.astype(np.int64)


def turned_back(target_to_source: np.ndarray, source: Basis, n_t: int) -> np.ndarray:
    """A map the other way, (n_s,): for each source vertex the target vertex whose image is nearest to it.

    Nearest in the embedding of the source's first functions, divided by the roots of their eigenvalues. Of a
    one-to-one map it is the inverse.
    """
    points = check_point_map(target_to_source, len(source.functions), n_t)
    k = min(EMBEDDING, len(source.eigenvalues))
    values = to_numpy(source.eigenvalues)[1:k]
    places = to_numpy(source.functions)[:, 1:k] / np.sqrt(np.maximum(values, max(zero_level(source), 1e-9)))
    return nearest(places, places[points], threads=1)
