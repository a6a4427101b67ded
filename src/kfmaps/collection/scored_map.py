"""What speaks for one map of a pair without a look at the others: evidence that agreement over cycles starts from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._arrays import to_numpy
from kfmaps.collection.synchronization import FUNCTIONS, SAY, Choice
from kfmaps.fmap.convert import to_functional
from kfmaps.matching.calibration import probability
from kfmaps.matching.candidates import AGAIN, refine
from kfmaps.matching.quality import Probe, map_quality, mirrored_probe
from kfmaps.matching.sample_pair import ground
from kfmaps.shape import Shape

JUDGED = 80
"""Functions of the maps that are judged, as many as the search judges by."""
SAME = 0.1
"""Misfit between two maps, ``‖C − C'‖² / k``, below which they are one."""
TURNED = -0.2
"""Orientation below which a map turns the surface inside out, which one that is to keep orientation cannot."""


@dataclass(frozen=True, eq=False)
class Judged:
    """One map of a pair as its evidence sees it.

    Attributes
    ----------
    map : (k, k) float64
        Its functional map, source → target, of :data:`kfmaps.collection.synchronization.FUNCTIONS` functions.
    score : float
        :attr:`kfmaps.matching.quality.Quality.score`.
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
    maps: Sequence[np.ndarray],
    source: Shape,
    target: Shape,
    probes: tuple[Probe, Probe],
    reversed: Sequence[bool] | None = None,
) -> list[Judged]:
    """Judge ``maps (n_t,)`` of one pair, a source vertex for each target vertex, by the ``probes`` of both shapes.

    Each is settled on the samples first, as candidates of a search are. A map that was finished on all vertices and one
    that was not are then comparable, and scores mean what they mean there.
    """
    turned = [False] * len(maps) if reversed is None else list(reversed)
    k = min(JUDGED, len(source.basis.eigenvalues), len(target.basis.eigenvalues))
    bases = source.basis.truncated(k), target.basis.truncated(k)
    rough = np.stack([to_numpy(to_functional(points, *bases)) for points in maps])
    found: list[Judged | None] = [None] * len(maps)
    for back in sorted(set(turned)):
        on = ground(probes[0], mirrored_probe(probes[1]) if back else probes[1])
        rows = [i for i, one in enumerate(turned) if one == back]
        weights = (AGAIN[0] if on.shot is not None else 0.0, 0.0)
        settled, points = refine(rough[rows], on, (max(k // 2, 2), k), weights, (), 1)
        for i, C, at in zip(rows, settled, points, strict=True):
            quality = map_quality(C, on.source, on.target, at)
            found[i] = Judged(C[:FUNCTIONS, :FUNCTIONS], quality.score, quality.orientation, back)
    return [one for one in found if one is not None]


def better(one: Judged, other: Judged) -> Judged:
    """``one``, with the score of ``other`` where that is the same map and scores better."""
    if not same(one, other) or other.score <= one.score:
        return one
    return replace(one, score=other.score, orientation=other.orientation)


def same(one: Judged, other: Judged) -> bool:
    """Whether two candidates of a pair are one map but for details."""
    return one.reversed == other.reversed and float(((one.map - other.map) ** 2).sum()) / len(one.map) < SAME


def choices(maps: list[Judged]) -> tuple[Choice, ...]:
    """The maps of one pair as candidates: between them scores decide, altogether what the best of them is worth.

    The odds of the best are those that a search would give it (:mod:`kfmaps.matching.calibration`), at most ``e⁴``; the
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
