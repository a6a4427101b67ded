"""Candidates: registered placements of a part, and alternatives that place the part elsewhere.

A margin means nothing if no alternative was seriously tried. A half of a body that was cut lengthwise fits the other
half nearly as well, turned front to back, and whichever of the two a search has found first attracts other placements.
So relaxation and beam searches run again at scales near that of the best placement, with a cost for places near those
of its samples. Then the first few distinct candidates are refined by the same steps. The best at last grows anew from
each of its regions, since a limb may lie on another (research/body-model.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import KDTree

from kfmaps._threads import parallel
from kfmaps.matching.partial.registration import PartRegistration, register_part
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import PartPair
from kfmaps.matching.partial.scale_search import (
    TRIALS,
    Placement,
    place_all,
    refine_placement,
    rough_placements,
    shot_similarity,
)
from kfmaps.matching.partial.two_parts import overlap_evidence
from kfmaps.matching.score import SCORE, PartEvidence, by_score, part_landmark_cost, part_score, select_distinct

_SCALE_RATIOS = (1.0, 1.1, 1 / 1.1)
"""Scales of alternatives, over that of the best placement: a wrong placement has a scale of its own."""
_ROUNDS = (2, 5)  # how often a candidate is refined, at least and at most


@dataclass(frozen=True, eq=False)
class PartCandidate:
    """A part registered from one placement of its samples."""

    placement: Placement  # with all samples placed
    registration: PartRegistration
    points: np.ndarray  # (q, 3): of the samples, on the whole
    evidence: PartEvidence
    score: float


def make_candidate(placement: Placement, pair: PartPair) -> PartCandidate:
    """Register the part quickly by a placement of all samples."""
    return _measure_candidate(placement, _register_quickly(placement, pair), pair)


def _register_quickly(placement: Placement, pair: PartPair) -> PartRegistration:
    """Return the quick registration of the part by a placement of all samples."""
    at = pair.whole.samples[placement.placed.match]
    points, normals = pair.whole.mesh.vertices[at], pair.whole.surface.normals[at]
    least_trust = 1e-4 if pair.both_partial else 0.01  # many samples of two parts have no place on the other
    trust = np.maximum(placement.placed.trust, least_trust)
    return register_part(pair, placement.scale, points, normals, trust, quick=True)


def _measure_candidate(placement: Placement, found: PartRegistration, pair: PartPair) -> PartCandidate:
    """Return the candidate of a registration, scored with the evidence of a placement."""
    ends = pair.whole.mesh.vertices[pair.whole.landmarks]
    errors = np.linalg.norm(found.vertices[pair.part.landmarks] - ends, axis=1)
    evidence = replace(
        placement.evidence,
        deformation_energy=found.deformation_energy,
        gap=found.gap,
        flipped_area=found.flipped_area,
        doubled_area=found.doubled_area,
        landmark_cost=part_landmark_cost(errors, pair.both_partial),
    )
    evidence = replace(evidence, scale_change=pair.scale_change(placement.scale))
    if pair.both_partial:
        agreement, rank = overlap_evidence(found, pair)
        evidence = replace(evidence, pair_consistency=agreement, overlap_rank=rank, doubled_area=0.0)
    return PartCandidate(placement, found, found.places.points[pair.part.samples], evidence, part_score(evidence))


def compare_alternatives(found: Sequence[PartCandidate], pair: PartPair) -> list[PartCandidate]:
    """Add alternatives to the best of the candidates, refine the best distinct ones, and return all, best first.

    A placement that was found by chance is far from its best form, and would lose against one that was refined.
    """
    n_alternatives, n_refined = 3, 3  # placements that are registered, and distinct candidates that are refined
    best = by_score(found)[0]
    likely = by_score(_alternative_placements(pair, best.registration.scale, best.points))[:n_alternatives]
    likely += _place_symmetrically(best, pair)
    order = by_score([*found, *(make_candidate(refine_placement(pair, one), pair) for one in likely)])
    chosen = select_distinct(order, _differ, n_refined)
    rest = [one for one in order if all(_differ(one, other) for other in chosen)]
    least = chosen[0].score - SCORE.part.hopeless_margin
    refined = [_refine_candidate(one, pair) if one.score > least else one for one in chosen]
    return by_score([*refined, *rest])


def _alternative_placements(pair: PartPair, scale: float, points: np.ndarray) -> list[Placement]:
    """Return placements of all samples elsewhere than at ``points (q, 3)``, by relaxation and beam searches.

    ``scale``: √area of the part over that of the whole. Samples that are landmarks stay.
    """
    distances = np.linalg.norm(points[:, None] - pair.whole.mesh.vertices[pair.whole.samples][None], axis=2)
    limit, each = SCORE.part.distinct_distance, np.arange(len(points))
    near_cost = 0.5  # of a place near the one that a sample has, where the consistency of the sample is worth 2 at most
    cost = near_cost * (distances < limit).astype(np.float32)
    cost[: pair.part.n_landmarks] = 0.0

    def place(scale: float) -> list[Placement]:
        placements = [place_all(pair, one) for one in rough_placements(pair, scale, cost=cost)]
        return [one for one in placements if float(np.median(distances[each, one.placed.match])) > limit]

    scales = [scale * ratio for ratio in (_SCALE_RATIOS[:1] if pair.fixed_scale else _SCALE_RATIOS)]
    return [one for some in parallel(place, scales) for one in some]


def _place_symmetrically(one: PartCandidate, pair: PartPair) -> list[Placement]:
    """Return the placement after each near-symmetry of the whole.

    Samples that are landmarks stay.
    """
    n_landmarks, found = pair.part.n_landmarks, []
    for images in pair.self_images:
        placed = one.placement.placed
        match = images[placed.match]
        match[:n_landmarks] = placed.match[:n_landmarks]
        found.append(replace(one.placement, placed=replace(placed, match=match)))
    return found


def candidates_at_scale(pair: PartPair, scale: float) -> list[PartCandidate]:
    """Return the best distinct candidates at the ``scale`` of the files.

    Samples alone do not tell where a small part belongs, or which parts of two shapes correspond. So all placements by
    beam searches and by relaxation are registered, which takes 0.05 s each, before any is dropped.
    """
    rough = [one for params in TRIALS[:2] for one in rough_placements(pair, scale, params)]
    found = parallel(lambda one: make_candidate(one, pair), [place_all(pair, one) for one in rough])
    most = 4  # candidates at the scale of the files
    return [_place_again(one, pair) for one in select_distinct(by_score(found), _differ, most)]


def regrow_best(order: list[PartCandidate], pair: PartPair) -> list[PartCandidate]:
    """Add the best candidate that keeps one region of the first of ``order`` and places all else anew.

    A placement is often right but for a limb that lies on another. Grown outwards from a region that is right, the limb
    is placed by its distances from there. Of the scan of one camera the second distinct candidate grows too, and a best
    one that has grown is compared with its images by near-symmetries.
    """
    n_regions = 8  # around the first samples, which are far from each other
    seeds, found = range(min(n_regions, len(pair.part.samples))), list(order)
    for one in select_distinct(order, _differ, 2 if pair.is_one_view else 1):
        grown = by_score(parallel(lambda seed, one=one: make_candidate(_grow(one, seed, pair), pair), seeds))[0]
        if grown.score < order[0].score - SCORE.part.hopeless_margin:
            continue
        grown = _refine_candidate(grown, pair)
        if _differ(grown, one) or grown.score >= one.score + SCORE.part.min_gain:
            found.append(grown)
    best = by_score(found)[0]
    if pair.is_one_view and best is not order[0]:
        turned = _place_symmetrically(best, pair)
        found += [_refine_candidate(make_candidate(refine_placement(pair, one), pair), pair) for one in turned]
    return by_score(found)


def _grow(one: PartCandidate, seed: int, pair: PartPair) -> Placement:
    """Return a placement of all samples that keeps what lies around the sample ``seed``, and grows from there."""
    placement, away = (
        _placement_where_it_lies(one.placement, one.registration, pair),
        one.registration.scale * pair.part.distances[seed],
    )
    for radius in (0.2, 0.3, 0.5, 0.8):  # in √area of the whole, within which samples are trusted
        trust = np.where(away < radius, np.maximum(placement.placed.trust, 1e-6), 0.0)
        placement = place_all(pair, replace(placement, placed=replace(placement.placed, trust=trust)))
    return place_all(pair, placement)


def _refine_candidate(one: PartCandidate, pair: PartPair) -> PartCandidate:
    """Place and register the part again from where it lies, until that makes it no better."""
    for i in range(_ROUNDS[1]):
        before, one = one.score, _place_again(one, pair)
        if i + 1 >= _ROUNDS[0] and one.score < before + SCORE.part.min_gain:
            break
    for _ in range(_ROUNDS[1]):
        nearby = _place_nearby(one, pair)
        if nearby.score < one.score + SCORE.part.min_gain:
            break
        one = nearby
    return one


def _place_nearby(one: PartCandidate, pair: PartPair) -> PartCandidate:
    """Place each sample where the whole looks most like it, near where it lies, and register the part once more.

    Distances have no say: between unlike bodies they differ, and placing by them moves the samples away.
    """
    placement = _placement_where_it_lies(one.placement, one.registration, pair)
    similarity = shot_similarity(pair, placement.scale, placement.params)
    there = pair.whole.mesh.vertices[pair.whole.samples]
    away = np.linalg.norm(one.points[:, None] - there[None], axis=2) / SCORE.part.distinct_distance
    match = (similarity - away**2).argmax(axis=1)
    match[: pair.part.n_landmarks] = placement.placed.match[: pair.part.n_landmarks]
    placement = replace(placement, similarity=similarity, placed=replace(placement.placed, match=match))
    found = _register_quickly(placement, pair)
    # Places that were chosen because they look alike say nothing for the placement, those to which they lead do.
    lies = replace(_placement_where_it_lies(placement, found, pair), scale=placement.scale)
    return _measure_candidate(lies, found, pair)


def _place_again(one: PartCandidate, pair: PartPair) -> PartCandidate:
    """Place and register the part once more, at the scale of its edges."""
    return make_candidate(refine_placement(pair, _placement_where_it_lies(one.placement, one.registration, pair)), pair)


def _placement_where_it_lies(placement: Placement, found: PartRegistration, pair: PartPair) -> Placement:
    """Return the placement of all samples where a registration has moved them, at the scale of the part's edges."""
    points = found.places.points[pair.part.samples]
    match = np.asarray(KDTree(pair.whole.mesh.vertices[pair.whole.samples]).query(points)[1])
    match[: pair.part.n_landmarks] = np.arange(pair.part.n_landmarks)
    placed = Assignment(match, np.maximum(found.inside[pair.part.samples], 1e-3), placement.placed.support)
    scale = placement.scale if pair.fixed_scale else found.scale * found.edge_ratio
    return replace(placement, scale=scale, placed=placed)


def _differ(one: PartCandidate, other: PartCandidate) -> bool:
    """Return whether two candidates put the part elsewhere."""
    return float(np.median(np.linalg.norm(one.points - other.points, axis=1))) > SCORE.part.distinct_distance


def margin(found: Sequence[PartCandidate], n_landmarks: int = 0) -> float:
    """Return the margin of the first candidate, which is the best, over the best that differs, up to a maximum.

    The less of the whole a part covers, the more places it fits by chance. So below :attr:`PartScoring.full_area` a
    margin counts in proportion to the area, unless landmarks fix the place.
    """
    most, best = SCORE.part.calibration.max_margin, found[0]
    share = 1.0 if n_landmarks else min(best.registration.scale**2 / SCORE.part.full_area, 1.0)
    others = [one.score for one in found if _differ(one, best)]
    return min((best.score - max(others)) * share, most) if others else most * share
