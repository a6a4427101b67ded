"""Candidates: placements of a part that were registered, and the best against the best that puts the part elsewhere.

A margin says nothing if no rival was a serious one. A half of a body that was cut lengthwise fits the other half nearly
as well, turned front to back, and whichever of the two the search found first draws the others to it. So relaxation and
the beam search run again, at the scale of the best placement and beside it, for the best that leave it: every sample
pays for a place near the one that it has. Then the first few that differ are refined on equal terms.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import KDTree

from kfmaps._threads import parallel
from kfmaps.matching.partial.registration import PartRegistration, find_overlap, register_part
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import PartPair
from kfmaps.matching.partial.scale_search import (
    TRIALS,
    Placement,
    place_all,
    place_by_beams,
    place_by_relaxation,
    refine_placement,
    shot_similarity,
)
from kfmaps.matching.score import SCORE, PartEvidence, part_landmark_cost, part_score, select_distinct

_SCALE_RATIOS = (1.0, 1.1, 1 / 1.1)
"""Scales that are tried, against that of the placement: a wrong one has a scale of its own."""
_LEAST_TRUST, _LEAST_TRUST_OF_TWO = 0.01, 1e-4
"""Trust that samples without any keep in a registration; of two parts many have no place on the other."""
_MOST_AT_SCALE = 4  # candidates at a known scale
_ROUNDS = (2, 5)  # how often candidates are refined, at least and at most


@dataclass(frozen=True, eq=False)
class PartCandidate:
    """A part registered from one placement of its samples."""

    placement: Placement  # with all samples placed
    registration: PartRegistration
    points: np.ndarray  # (q, 3): of the samples, on the whole
    evidence: PartEvidence
    score: float


def make_candidate(placement: Placement, pair: PartPair) -> PartCandidate:
    """Register the part quickly by its placed samples.

    ``placement``: of all samples.
    """
    at = pair.whole.samples[placement.placed.match]
    points, normals = pair.whole.mesh.vertices[at], pair.whole.surface.normals[at]
    trust = np.maximum(placement.placed.trust, _LEAST_TRUST_OF_TWO if pair.both_partial else _LEAST_TRUST)
    found = register_part(pair, placement.scale, points, normals, trust, quick=True)
    ends = pair.whole.mesh.vertices[pair.whole.landmarks]
    errors = np.linalg.norm(found.vertices[pair.part.landmarks] - ends, axis=1)
    evidence = replace(
        placement.evidence,
        deformation_energy=found.deformation_energy,
        gap=found.gap,
        flipped_area=found.flipped_area,
        landmark_cost=part_landmark_cost(errors, pair.both_partial),
    )
    if pair.small_scale is not None:
        evidence = replace(evidence, scale_change=abs(math.log(placement.scale / pair.small_scale)))
    if pair.both_partial:
        evidence = replace(evidence, pair_consistency=_overlap_consistency(found, pair))
    return PartCandidate(placement, found, found.places.points[pair.part.samples], evidence, part_score(evidence))


def _overlap_consistency(found: PartRegistration, pair: PartPair) -> float:
    """Return how well distances on two parts agree, between samples of the overlap, from 0 to 1."""
    samples, whole = pair.part.samples, pair.whole
    match = np.asarray(KDTree(whole.mesh.vertices[whole.samples]).query(found.vertices[samples])[1])
    fits, near = pair.pair_consistency(found.scale, match)
    on = find_overlap(found, whole).part[samples]
    return float(on @ fits @ on / max(on @ near @ on, 1e-12))


def compare_alternatives(found: Sequence[PartCandidate], pair: PartPair) -> list[PartCandidate]:
    """Return the candidates, best first, after alternatives were sought and the best that differ were refined.

    A placement that was found by chance is far from what it can be, and would lose against one that was not.
    """
    best = max(found, key=lambda one: one.score)
    elsewhere = _alternative_placements(pair, best.registration.scale, best.points)
    likely = sorted(elsewhere, key=lambda one: -one.score)[:3]
    more = [make_candidate(refine_placement(pair, one), pair) for one in likely]
    order = sorted([*found, *more], key=lambda one: -one.score)
    chosen = select_distinct(order, _differ, 3)
    rest = [one for one in order if all(_differ(one, other) for other in chosen)]
    least = chosen[0].score - SCORE.part.hopeless_margin
    last = [_refine_candidate(one, pair) if one.score > least else one for one in chosen]
    return sorted([*last, *rest], key=lambda one: -one.score)


def _alternative_placements(pair: PartPair, scale: float, points: np.ndarray) -> list[Placement]:
    """Return placements of the samples elsewhere than at ``points (q, 3)``, by relaxation and beam searches.

    ``scale``: √area of the part over that of the whole. Samples that are landmarks stay.
    """
    off = np.linalg.norm(points[:, None] - pair.whole.mesh.vertices[pair.whole.samples][None], axis=2)
    apart = SCORE.part.distinct_distance
    # A place near the one that a sample has costs half a point, where its consistency is worth 2 at most.
    cost = 0.5 * (off < apart).astype(np.float32)
    cost[: pair.part.n_landmarks] = 0.0
    each = np.arange(len(points))

    def place(scale: float) -> list[Placement]:
        similarity = shot_similarity(pair, scale, TRIALS[0])
        left = similarity - cost
        begun = [*place_by_beams(pair, scale, left), place_by_relaxation(pair, scale, left)]
        placed = [place_all(pair, Placement(scale, TRIALS[0], one, similarity)) for one in begun]
        return [one for one in placed if float(np.median(off[each, one.placed.match])) > apart]

    scales = [scale * ratio for ratio in (_SCALE_RATIOS[:1] if pair.fixed_scale else _SCALE_RATIOS)]
    return [one for some in parallel(place, scales) for one in some]


def candidates_at_scale(pair: PartPair, scale: float) -> list[PartCandidate]:
    """Return candidates at the ``scale`` of the files: the best few that differ.

    Samples alone do not tell where a small part belongs, or which of two parts lies where on the other. So all
    placements of beam searches and of relaxation are registered, which takes 0.05 s each, before any is dropped.
    """
    found = []
    for params in TRIALS[:2]:
        similarity = shot_similarity(pair, scale, params)
        begun = [*place_by_beams(pair, scale, similarity), place_by_relaxation(pair, scale, similarity, params)]
        placed = [place_all(pair, Placement(scale, params, one, similarity)) for one in begun]
        found += parallel(lambda one: make_candidate(one, pair), placed)
    order = sorted(found, key=lambda one: -one.score)
    return [_place_again(one, pair) for one in select_distinct(order, _differ, _MOST_AT_SCALE)]


def _refine_candidate(one: PartCandidate, pair: PartPair) -> PartCandidate:
    """Place and register the part anew from where it lies, until that makes it no better."""
    for i in range(_ROUNDS[1]):
        before, one = one.score, _place_again(one, pair)
        if i + 1 >= _ROUNDS[0] and one.score < before + SCORE.part.min_gain:
            break
    return one


def _place_again(one: PartCandidate, pair: PartPair) -> PartCandidate:
    """Place and register the part once more, at the scale of its edges."""
    match = np.asarray(KDTree(pair.whole.mesh.vertices[pair.whole.samples]).query(one.points)[1])
    match[: pair.part.n_landmarks] = np.arange(pair.part.n_landmarks)
    trust = np.maximum(one.registration.inside[pair.part.samples], 1e-3)
    placed = Assignment(match, trust, one.placement.placed.support)
    scale = one.placement.scale if pair.fixed_scale else one.registration.scale * one.registration.edge_ratio
    return make_candidate(refine_placement(pair, replace(one.placement, scale=scale, placed=placed)), pair)


def _differ(one: PartCandidate, other: PartCandidate) -> bool:
    """Return whether two candidates put the part elsewhere."""
    return float(np.median(np.linalg.norm(one.points - other.points, axis=1))) > SCORE.part.distinct_distance


def margin(found: Sequence[PartCandidate], n_landmarks: int = 0) -> float:
    """Return by how much the best of ``found``, which is first, precedes the best that differs, up to a maximum.

    The less of the whole a part covers, the more places it fits by chance: below :attr:`PartScoring.full_area` a margin
    counts in proportion to the area, unless landmarks fix the place. Without any other candidate that differs it is the
    maximum before that.
    """
    others = [one.score for one in found if _differ(one, found[0])]
    share = 1.0 if n_landmarks else min(found[0].registration.scale ** 2 / SCORE.part.full_area, 1.0)
    if not others:
        return SCORE.part.calibration.max_margin * share
    return min((found[0].score - max(others)) * share, SCORE.part.calibration.max_margin)
