"""Search for the scale of a part against the whole, from a thirteenth of its area to all of it.

At each of a number of scales a few samples of the part are placed, by relaxation labelling and by beam searches. The
placements with the best support are then refined: all samples are placed, and the scale follows from the distances
between them, in turn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._threads import parallel
from kfmaps.matching.partial.beam_search import beam_search
from kfmaps.matching.partial.relaxation_labeling import Assignment, RelaxationParams, reassign, relax, scale_change
from kfmaps.matching.partial.samples import PartPair
from kfmaps.matching.partial.two_parts import consistent_trust
from kfmaps.matching.score import PartEvidence, placement_score

TRIALS = (
    RelaxationParams(),
    RelaxationParams((0.06, 0.09, 0.14, 0.2), 100, 30, 1.2),
    RelaxationParams((0.06, 0.09, 0.14, 0.2), 70, 45, 1.2),
)
"""Parameters of relaxation. The first are used at all scales, the others at the best of these."""
SCALES = tuple(0.28 * 1.15**i for i in range(10))
"""√area of the part over that of the whole; SHOT and consistency tolerate a tenth more or less."""
LARGER_SCALES = tuple(SCALES[-1] * 1.15**i for i in range(1, 4))
"""Further scales where both shapes are parts."""
MIN_SCALE, MIN_MARKED_SCALE, MAX_SCALE = 0.25, 0.1, 1.6
"""Bounds of the scale, without and with landmarks: a part that shrinks fits nearly everywhere, unless it has some."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Samples of the part placed at one scale."""

    scale: float  # √area of the part over that of the whole
    params: RelaxationParams  # those that it started from
    placed: Assignment
    similarity: np.ndarray  # (q, m): products of descriptors
    weights: np.ndarray | None = None  # (q,): of the samples in :attr:`PartEvidence.similarity_rank`
    scale_change: float = 0.0  # see :class:`PartEvidence`

    @property
    def evidence(self) -> PartEvidence:
        """The evidence for the placement that is known before registration."""
        match = self.placed.match
        own = self.similarity[np.arange(len(match)), match]
        n_better = (self.similarity > own[:, None]).sum(axis=1)
        rank = float(np.average(np.log((n_better + 1) / self.similarity.shape[1]), weights=self.weights))
        return PartEvidence(self.placed.support, rank, scale_change=self.scale_change)

    @property
    def score(self) -> float:
        """The score of that evidence."""
        return placement_score(self.evidence)


def shot_similarity(pair: PartPair, scale: float, params: RelaxationParams) -> np.ndarray:
    """Return mean products ``(q, m)`` of the SHOT of both shapes, in balls of equal size; landmarks match each other.

    The scan of one camera is compared with each view of the whole, and the most similar one counts. Samples of another
    small part are weighted: near its boundary their descriptors are not those of the whole.
    """
    near = _shot_scale(scale)
    if pair.is_one_view:
        similarity = _similarity_to_views(pair, near, params.radii)
    else:
        total = sum(pair.part.shot(radius / near) @ pair.whole.shot(radius).T for radius in params.radii)
        similarity = np.asarray(total, dtype=np.float32) / len(params.radii)
        if pair.small_scale is not None:
            similarity *= pair.shot_weights(scale, max(params.radii))[:, None]
    landmarks = np.arange(pair.part.n_landmarks)
    similarity[landmarks] = -1.0
    similarity[landmarks, landmarks] = 2.0
    return similarity


def _similarity_to_views(pair: PartPair, scale: float, radii: Sequence[float]) -> np.ndarray:
    """Return the mean products (q, m) of SHOT of the part and of the view of the whole that is most similar."""
    own = np.concatenate([pair.part.shot(radius / scale) for radius in radii], axis=1) / np.float32(len(radii))
    most = np.zeros((len(own), len(pair.whole.samples)), dtype=np.float32)
    for views in zip(*(pair.whole.shot_of_views(radius) for radius in radii), strict=True):
        seen = views[0][0]
        most[:, seen] = np.maximum(most[:, seen], own @ np.concatenate([found for _, found in views], axis=1).T)
    return most


def _shot_scale(scale: float) -> float:
    """Return the nearest of the scales that SHOT is computed at."""
    step = 1.15 ** (1 / 3)  # ratio of the scales that SHOT is computed at, which placements of similar scales share
    return float(SCALES[0] * step ** round(np.log(scale / SCALES[0]) / np.log(step)))


def rough_placements(
    pair: PartPair,
    scale: float,
    params: RelaxationParams = TRIALS[0],
    *,
    by_beams: bool = True,
    by_relaxation: bool = True,
    cost: np.ndarray | None = None,
) -> list[Placement]:
    """Return placements of a few samples at one ``scale``: by a beam search, best first, and the one by relaxation.

    ``cost (q, m)``: of each sample at each place, in units of the similarity.
    """
    similarity = shot_similarity(pair, scale, params)
    gain = similarity if cost is None else similarity - cost
    bounds, distances, n_landmarks = pair.bounds(scale), pair.whole.distances, pair.part.n_landmarks
    placed: list[Assignment] = []
    if by_beams:
        boundary_distance = pair.part.boundary_distance * np.float32(scale)
        placed += beam_search(bounds, boundary_distance, distances, gain, n_landmarks)
    if by_relaxation:
        placed.append(relax(bounds, distances, gain, params, n_landmarks))
    return [Placement(scale, params, one, similarity) for one in placed]


def try_scales(pair: PartPair, scales: Sequence[float], params: RelaxationParams = TRIALS[0]) -> list[Placement]:
    """Place a few samples at each of ``scales`` by relaxation; return the placements, the best supported first."""
    _compute_shot(pair, params)
    found = parallel(lambda scale: rough_placements(pair, scale, params, by_beams=False)[0], scales)
    return sorted(found, key=lambda one: -one.placed.support)


def search_scale(pair: PartPair, scales: Sequence[float]) -> list[Placement]:
    """Return placements of all samples that begin with beam searches at each of ``scales``, at the best three scales.

    A scale is as good as the support of its best beam search.
    """
    _compute_shot(pair, TRIALS[0])
    found = parallel(lambda scale: rough_placements(pair, scale, by_relaxation=False), scales)
    n_best = 3  # scales whose beam searches are continued with all samples
    best = sorted(found, key=lambda some: -some[0].placed.support)[:n_best]
    return parallel(lambda one: place_all(pair, one), [one for some in best for one in some])


def _compute_shot(pair: PartPair, params: RelaxationParams) -> None:
    """Compute the SHOT of the whole, which placements at all scales share."""
    compute = pair.whole.shot_of_views if pair.is_one_view else pair.whole.shot
    for radius in params.radii:
        compute(radius)


def place_all(pair: PartPair, one: Placement) -> Placement:
    """Place all samples again, at the same scale."""
    n_landmarks = pair.part.n_landmarks
    placed = reassign(pair.bounds(one.scale), pair.whole.distances, one.similarity, one.placed, n_landmarks)
    if pair.both_partial:
        trust = consistent_trust(*pair.pair_consistency(one.scale, placed.match), placed.trust, n_landmarks)
        placed = replace(placed, trust=placed.trust * trust)
    weights = None if pair.small_scale is None else pair.shot_weights(one.scale, max(TRIALS[0].radii)) ** 2
    return replace(one, placed=placed, weights=weights, scale_change=pair.scale_change(one.scale))


def refine_placement(pair: PartPair, one: Placement) -> Placement:
    """Fit places and scale to each other, then once more with descriptors that are computed at the scale found."""
    return refit_scale(pair, fit_scale(pair, one))


def fit_scale(pair: PartPair, one: Placement) -> Placement:
    """Place all samples and estimate the scale from the distances between them, three times; a fixed scale stays."""
    least = MIN_MARKED_SCALE if pair.part.n_landmarks else MIN_SCALE
    for _ in range(3):
        scale, one = one.scale, place_all(pair, one)
        if not pair.fixed_scale:
            ratio = scale_change(pair.bounds(scale), pair.whole.distances, one.placed)
            one = replace(one, scale=float(np.clip(scale * ratio, least, MAX_SCALE)))
    return one


def refit_scale(pair: PartPair, one: Placement) -> Placement:
    """Do what :func:`fit_scale` does with descriptors at the scale of the placement."""
    if not pair.fixed_scale:
        one = replace(one, similarity=shot_similarity(pair, one.scale, one.params))
    return fit_scale(pair, one)
