"""Score the maps of one pair by themselves: the evidence that synchronization starts from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._arrays import to_numpy
from kfmaps.collection.synchronization import MAX_LOG_ODDS, N_FUNCTIONS, CandidateMap
from kfmaps.fmap.convert import to_functional
from kfmaps.matching.candidates import FINE, FINE_WEIGHTS, refine_batch
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.quality import ShapeSamples, mirror_samples
from kfmaps.matching.reindexing import reindexing
from kfmaps.matching.sample_pair import build_sample_pair
from kfmaps.matching.score import SCORE, probability
from kfmaps.shape import Shape

StoredMap = tuple[np.ndarray, bool]
"""A source vertex for each target vertex, (n_t,), and whether it is a map to the target's mirror image."""


@dataclass(frozen=True, eq=False)
class ScoredMap:
    """One map of a pair with its own evidence."""

    # (k, k): its functional map, source → target, of :data:`kfmaps.collection.synchronization.N_FUNCTIONS` functions.
    map: np.ndarray
    score: float  # :attr:`kfmaps.matching.score.Quality.score`
    orientation: float  # 1 where it is kept, -1 where it is reversed; of what the map claims to be
    reversed: bool = False  # whether it claims to be a map to the target's mirror image


def score_pair_maps(
    maps: Sequence[StoredMap], shapes: tuple[Shape, Shape], samples: tuple[ShapeSamples, ShapeSamples]
) -> list[ScoredMap]:
    """Score maps of one pair, on its cleaned shapes, by the ``samples`` of both; ``shapes``: source and target.

    Each is refined on the samples first, as candidates of a search are: then a map that was finished on all vertices
    and one that was not are comparable, and scores mean what they mean there.
    """
    across = reindexing(*shapes)
    k = min(FINE, len(across.source.basis.eigenvalues), len(across.target.basis.eigenvalues))
    bases = across.source.basis.truncate(k), across.target.basis.truncate(k)
    points = [across.part_s.to_clean[one[across.part_t.to_original]] for one, _ in maps]
    rough = [to_numpy(to_functional(one, *bases)) for one in points]
    found: dict[int, ScoredMap] = {}
    for back in sorted({turned for _, turned in maps}):
        on = build_sample_pair(samples[0], mirror_samples(samples[1]) if back else samples[1])
        rows = [i for i, (_, turned) in enumerate(maps) if turned == back]
        weights = (FINE_WEIGHTS[0][0] if on.descriptor_cost is not None else 0.0, 0.0)
        settled = refine_batch([Start("", rough[i], weights=weights) for i in rows], on, (max(k // 2, 2), k))
        for i, one in zip(rows, settled, strict=True):
            C = one.functional_map[:N_FUNCTIONS, :N_FUNCTIONS]
            found[i] = ScoredMap(C, one.quality.score, one.quality.orientation, back)
    return [found[i] for i in range(len(maps))]


def with_better_score(one: ScoredMap, other: ScoredMap) -> ScoredMap:
    """Return ``one``, with the score of ``other`` where that is the same map and scores better."""
    if not is_same_map(one, other) or other.score <= one.score:
        return one
    return replace(one, score=other.score, orientation=other.orientation)


def is_same_map(one: ScoredMap, other: ScoredMap) -> bool:
    """Return whether two candidates of a pair are one map but for details."""
    return one.reversed == other.reversed and float(((one.map - other.map) ** 2).sum()) / len(one.map) < SCORE.same_map


def candidate_maps(maps: Sequence[ScoredMap]) -> tuple[CandidateMap, ...]:
    """Return the maps of one pair as candidates.

    The odds of the best are those that a search would give it (:mod:`kfmaps.matching.score`), at most ``e⁴``; the
    others are behind by as much as their scores are.
    """
    odds = [_odds(one) for one in maps]
    best = max(odds)
    over = max(best - MAX_LOG_ODDS, 0.0)
    return tuple(
        CandidateMap(one.map, max(own - over, -MAX_LOG_ODDS), one.reversed) for one, own in zip(maps, odds, strict=True)
    )


def _odds(one: ScoredMap) -> float:
    chance = min(max(probability(one.score, math.inf), 1e-12), 1 - 1e-12)
    own = math.log(chance) - math.log1p(-chance)
    return own - 2 * MAX_LOG_ODDS if one.orientation < SCORE.min_orientation else own
