"""What speaks for one map of a pair without a look at the others: evidence that agreement over cycles starts from."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import to_numpy
from kfmaps.fit.shape import Shape
from kfmaps.functional.points import to_functional
from kfmaps.many.agree import FUNCTIONS, SAY, Choice
from kfmaps.search.quality import Probe, map_quality, mirrored_probe
from kfmaps.search.verdict import probability

JUDGED = 80
"""Functions of the maps that are judged, as many as the search judges by."""
TURNED = -0.2
"""Orientation below which a map turns the surface inside out, which one that is to keep orientation cannot."""


@dataclass(frozen=True, eq=False)
class Judged:
    """One map of a pair as its evidence sees it.

    Attributes
    ----------
    map : (k, k) float64
        Its functional map, source → target, of :data:`kfmaps.many.agree.FUNCTIONS` functions.
    score : float
        :attr:`kfmaps.search.quality.Quality.score`.
    orientation : float
        1 where it is kept, -1 where it is reversed; of what the map claims to be.
    reversed : bool
        Whether it claims to be a map to the target's mirror image.
    """

    map: np.ndarray
    score: float
    orientation: float
    reversed: bool = False


def judged(
    points: np.ndarray,
    source: Shape,
    target: Shape,
    probes: tuple[Probe, Probe],
    reversed: bool = False,
) -> Judged:
    """Judge the map ``points (n_t,)``, a source vertex for each target vertex, by the ``probes`` of both shapes."""
    k = min(JUDGED, len(source.basis.eigenvalues), len(target.basis.eigenvalues))
    C = to_numpy(to_functional(points, source.basis.truncated(k), target.basis.truncated(k)))
    other = mirrored_probe(probes[1]) if reversed else probes[1]
    quality = map_quality(C, probes[0], other)
    return Judged(C[:FUNCTIONS, :FUNCTIONS], quality.score, quality.orientation, reversed)


def choices(maps: list[Judged]) -> tuple[Choice, ...]:
    """The maps of one pair as candidates: between them scores decide, altogether what the best of them is worth.

    The odds of the best are those that a search would give it (:mod:`kfmaps.search.verdict`), at most ``e⁴``; the
    others are behind by what their scores are.
    """
    odds = [_odds(one) for one in maps]
    best = max(odds)
    over = max(best - SAY, 0.0)
    return tuple(Choice(one.map, max(own - over, -SAY), one.reversed) for one, own in zip(maps, odds, strict=True))


def _odds(one: Judged) -> float:
    chance = min(max(probability(one.score, math.inf), 1e-12), 1 - 1e-12)
    own = math.log(chance) - math.log1p(-chance)
    return own - 2 * SAY if one.orientation < TURNED else own
