"""Search for the scale of the part against the whole, from a thirteenth of its area to all of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._threads import parallel
from kfmaps.matching.partial.beam_search import beam_search
from kfmaps.matching.partial.relaxation_labeling import Assignment, RelaxationParams, reassign, relax, scale_change
from kfmaps.matching.partial.samples import PartPair
from kfmaps.matching.score import PartEvidence, placement_score

TRIALS = (
    RelaxationParams(),
    RelaxationParams((0.06, 0.09, 0.14, 0.2), 100, 30, 1.2),
    RelaxationParams((0.06, 0.09, 0.14, 0.2), 70, 45, 1.2),
)
"""The first tries all scales, the others the best of these."""
SCALES = tuple(0.28 * 1.15**i for i in range(10))
"""√area of the part over that of the whole; SHOT and consistency tolerate a tenth more or less."""
LEAST_SCALE, LEAST_MARKED_SCALE, MOST_SCALE = 0.25, 0.1, 1.6
"""Bounds of the scale that samples may find: a part that shrinks fits nearly everywhere, unless it has landmarks."""
_SHOT_STEP = 1.15 ** (1 / 3)  # ratio of the scales that SHOT is computed at, which placements of like scales share
LARGER_SCALES = tuple(SCALES[-1] * 1.15**i for i in range(1, 4))
"""Further ones where what is registered is no part, but overlaps with one."""

_MIN_CONSISTENCY, _ROUNDS = 0.8, 6
"""Mean consistency with the others, over that of the best tenth, below which a sample of two parts is not trusted, and
rounds to find that."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Samples of the part placed at one scale."""

    scale: float  # √area of the part over that of the whole
    params: RelaxationParams  # those that it began with
    placed: Assignment
    similarity: np.ndarray  # (q, m): products of descriptors
    weights: np.ndarray | None = None  # (q,): of the samples in :attr:`PartEvidence.similarity_rank`

    @property
    def evidence(self) -> PartEvidence:
        """What the placement shows before registration."""
        match = self.placed.match
        own = self.similarity[np.arange(len(match)), match]
        better = (self.similarity > own[:, None]).sum(axis=1)
        rank = float(np.average(np.log((better + 1) / self.similarity.shape[1]), weights=self.weights))
        return PartEvidence(self.placed.support, rank)

    @property
    def score(self) -> float:
        """The score of that evidence."""
        return placement_score(self.evidence)


def shot_similarity(pair: PartPair, scale: float, params: RelaxationParams) -> np.ndarray:
    """Return mean products ``(q, m)`` of the SHOT of both, in balls of equal size; landmarks are settled.

    Those of a small part are weighted: near its boundary distances decide.
    """
    near = _shot_scale(scale)
    total = sum(pair.part.shot(radius / near) @ pair.whole.shot(radius).T for radius in params.radii)
    similarity = np.asarray(total, dtype=np.float32) / len(params.radii)
    if pair.small_scale is not None:
        similarity *= pair.shot_weights(scale, max(params.radii))[:, None]
    landmarks = np.arange(pair.part.n_landmarks)
    similarity[landmarks] = -1.0
    similarity[landmarks, landmarks] = 2.0
    return similarity


def _shot_scale(scale: float) -> float:
    """Return the nearest of the scales that SHOT is computed at."""
    return float(SCALES[0] * _SHOT_STEP ** round(np.log(scale / SCALES[0]) / np.log(_SHOT_STEP)))


def place_by_beams(pair: PartPair, scale: float, similarity: np.ndarray) -> list[Assignment]:
    """Return placements of a few samples at one ``scale`` by a beam search, best first."""
    away = pair.part.boundary_distance * np.float32(scale)
    return beam_search(pair.bounds(scale), away, pair.whole.distances, similarity, pair.part.n_landmarks)


def place_by_relaxation(
    pair: PartPair, scale: float, similarity: np.ndarray, params: RelaxationParams = TRIALS[0]
) -> Assignment:
    """Return the placement of the first samples at one ``scale`` by relaxation."""
    return relax(pair.bounds(scale), pair.whole.distances, similarity, params, pair.part.n_landmarks)


def place_all(pair: PartPair, one: Placement) -> Placement:
    """Place all samples anew, at the same scale."""
    n_landmarks = pair.part.n_landmarks
    placed = reassign(pair.bounds(one.scale), pair.whole.distances, one.similarity, one.placed, n_landmarks)
    if pair.both_partial:
        placed = replace(placed, trust=placed.trust * _consistent_trust(pair, one.scale, placed))
    weights = None if pair.small_scale is None else pair.shot_weights(one.scale, max(TRIALS[0].radii)) ** 2
    return replace(one, placed=placed, weights=weights)


def _consistent_trust(pair: PartPair, scale: float, placed: Assignment) -> np.ndarray:
    """Return how far each sample of a part agrees with those that agree with each other, (q,), from 0 to 1.

    What has no place on the other part does not. A power iteration as of Leordeanu and Hebert (2005), with means for
    sums, so that samples with few neighbours count as much.
    """
    fits, near = pair.pair_consistency(scale, placed.match)
    trust = np.minimum(placed.trust, 1.0)
    for _ in range(_ROUNDS):
        mean = fits @ trust / np.maximum(near @ trust, 1e-12)
        best = max(float(np.quantile(mean, 0.9)), 1e-12)
        trust = np.clip((mean / best - _MIN_CONSISTENCY) / (1 - _MIN_CONSISTENCY), 0.0, 1.0)
    trust[: pair.part.n_landmarks] = 1.0
    return trust


def try_scales(pair: PartPair, scales: Sequence[float], params: RelaxationParams = TRIALS[0]) -> list[Placement]:
    """Place the first samples at each of ``scales`` by relaxation, the best supported first."""
    place = place_by_relaxation
    found = _at_scales(pair, scales, params, lambda scale, alike: [place(pair, scale, alike, params)])
    return [one for (one,) in found]


def search_scale(pair: PartPair, scales: Sequence[float]) -> list[Placement]:
    """Place all samples by beam searches at each of ``scales``; those of the three best scales, best first."""
    found = _at_scales(pair, scales, TRIALS[0], lambda scale, alike: place_by_beams(pair, scale, alike))
    return parallel(lambda one: place_all(pair, one), [one for some in found[:3] for one in some])


def _at_scales(
    pair: PartPair,
    scales: Sequence[float],
    params: RelaxationParams,
    place: Callable[[float, np.ndarray], list[Assignment]],
) -> list[list[Placement]]:
    """The placements at each of ``scales``, the best supported first."""
    for radius in params.radii:
        pair.whole.shot(radius)

    def at(scale: float) -> list[Placement]:
        similarity = shot_similarity(pair, scale, params)
        return [Placement(scale, params, one, similarity) for one in place(scale, similarity)]

    return sorted(parallel(at, list(scales)), key=lambda some: -some[0].placed.support)


def refine_placement(pair: PartPair, one: Placement) -> Placement:
    """Place all samples, and find the scale with them unless it is known: :func:`settle` before and after descriptors
    are computed at the scale that was found."""
    return settle_again(pair, settle(pair, one))


def settle(pair: PartPair, one: Placement) -> Placement:
    """Place all samples three times, and find the scale with them unless it is known."""
    least = LEAST_MARKED_SCALE if pair.part.n_landmarks else LEAST_SCALE
    for _ in range(3):
        scale, one = one.scale, place_all(pair, one)
        if not pair.fixed_scale:
            longer = scale_change(pair.bounds(scale), pair.whole.distances, one.placed)
            one = replace(one, scale=float(np.clip(scale * longer, least, MOST_SCALE)))
    return one


def settle_again(pair: PartPair, one: Placement) -> Placement:
    """Return what :func:`settle` does by descriptors at the scale of the placement."""
    if not pair.fixed_scale:
        one = replace(one, similarity=shot_similarity(pair, one.scale, one.params))
    return settle(pair, one)
