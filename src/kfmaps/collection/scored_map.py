"""Score the maps of one pair by themselves, as evidence for the synchronization."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._arrays import to_numpy
from kfmaps.collection.synchronization import MAX_LOG_ODDS, N_FUNCTIONS, CandidateMap
from kfmaps.fmap.convert import to_functional, to_points
from kfmaps.matching.candidates import FINE_FUNCTIONS, FINE_WEIGHTS, refine_batch
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
    """One map of a pair with its score."""

    map: np.ndarray  # (k, k): functional map, source → target, with ``k`` = N_FUNCTIONS or fewer
    score: float  # :attr:`kfmaps.matching.score.Quality.calibrated_score`
    orientation: float  # 1 where it is as the map claims, -1 where it is reversed
    reversed: bool = False  # whether the map claims to lead to the target's mirror image


def score_pair_maps(
    maps: Sequence[StoredMap], shapes: tuple[Shape, Shape], samples: tuple[ShapeSamples, ShapeSamples]
) -> list[ScoredMap]:
    """Score maps of one pair on its cleaned ``shapes``, source and target, by the ``samples`` of both.

    Each map is refined on the samples first, as candidates of a search are. So scores are those of a search, whether or
    not a map was refined on all vertices.
    """
    reindexed = reindexing(*shapes, divided=True)
    k = min(FINE_FUNCTIONS, len(reindexed.source.basis.eigenvalues), len(reindexed.target.basis.eigenvalues))
    bases = reindexed.source.basis.truncate(k), reindexed.target.basis.truncate(k)
    points = [reindexed.clean_points(one) for one, _ in maps]
    functional_maps = [to_numpy(to_functional(one, *bases)) for one in points]
    scored: dict[int, ScoredMap] = {}
    for mirrored in sorted({is_reversed for _, is_reversed in maps}):
        pair = build_sample_pair(samples[0], mirror_samples(samples[1]) if mirrored else samples[1])
        rows = [i for i, (_, is_reversed) in enumerate(maps) if is_reversed == mirrored]
        weights = (FINE_WEIGHTS[0][0] if pair.descriptor_cost is not None else 0.0, 0.0)
        refined = refine_batch(
            [Start("", functional_maps[i], weights=weights) for i in rows], pair, (max(k // 2, 2), k)
        )
        for i, one in zip(rows, refined, strict=True):
            C = one.functional_map
            if reindexed.is_divided:
                C = reindexed.given_functional_map(reindexed.given_points(to_points(C, *bases)), C)
            C = C[:N_FUNCTIONS, :N_FUNCTIONS]
            scored[i] = ScoredMap(C, one.quality.calibrated_score, one.quality.orientation, mirrored)
    return [scored[i] for i in range(len(maps))]


def with_better_score(one: ScoredMap, other: ScoredMap) -> ScoredMap:
    """Return ``one``, with the score of ``other`` where that is the same map and scores better."""
    if not is_same_map(one, other) or other.score <= one.score:
        return one
    return replace(one, score=other.score, orientation=other.orientation)


def is_same_map(one: ScoredMap, other: ScoredMap) -> bool:
    """Return whether two candidates of a pair are the same map up to details."""
    return one.reversed == other.reversed and float(((one.map - other.map) ** 2).sum()) / len(one.map) < SCORE.same_map


def candidate_maps(maps: Sequence[ScoredMap]) -> tuple[CandidateMap, ...]:
    """Return the maps of one pair as candidates.

    The best has the odds that a search would give it (:mod:`kfmaps.matching.score`), at most ``e⁴``; the others are
    behind by as much as in a search.
    """
    all_log_odds = [_odds(one) for one in maps]
    best = max(all_log_odds)
    excess = max(best - MAX_LOG_ODDS, 0.0)
    return tuple(
        CandidateMap(one.map, max(log_odds - excess, -MAX_LOG_ODDS), one.reversed)
        for one, log_odds in zip(maps, all_log_odds, strict=True)
    )


def _odds(one: ScoredMap) -> float:
    p = min(max(probability(one.score, math.inf), 1e-12), 1 - 1e-12)
    log_odds = math.log(p) - math.log1p(-p)
    return log_odds - 2 * MAX_LOG_ODDS if one.orientation < SCORE.min_orientation else log_odds
