"""The best placement of a part against the best that puts it elsewhere.

A margin says nothing if no rival was a serious one. A half of a body that was cut lengthwise fits the other half nearly
as well, turned front to back, and whichever of the two the search found first draws the others to it. So relaxation and
the beam search run again, at the scale of the best placement and beside it, for the best that leave it: every sample
pays for a place near the one that it has. Then the first few that differ are refined on equal terms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from kfmaps._threads import parallel
from kfmaps.matching.partial.candidates import PartCandidate, make_candidate, placement_evidence
from kfmaps.matching.partial.registration import RegistrationTarget
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import PartSamples
from kfmaps.matching.partial.scale_search import (
    TRIALS,
    Placement,
    place_all,
    place_by_beams,
    place_by_relaxation,
    refine_placement,
    shot_similarity,
)
from kfmaps.matching.score import SCORE, placement_score, select_distinct

COST = 0.5
"""Cost of a place near the one that a sample has, where its consistency with the others is worth 2 at most."""
SCALE_RATIOS = (1.0, 1.1, 1 / 1.1)
"""Scales that are tried, against that of the placement: a wrong one has a scale of its own."""
N_ALTERNATIVES = 3
"""Placements elsewhere than the best that are registered."""
N_RIVALS = 2
"""Candidates that are compared with the best."""
ROUNDS = (2, 5)
"""How often candidates are refined, at least and at most."""


def compare_alternatives(
    found: Sequence[PartCandidate],
    part: PartSamples,
    whole: PartSamples,
    target: RegistrationTarget,
    fixed: bool = False,
    threads: int | None = None,
) -> list[PartCandidate]:
    """Return the candidates, best first, after alternatives were sought and the best that differ were refined.

    A placement that was found by chance is far from what it can be, and would lose against one that was not.
    ``fixed``: the scale is known.
    """
    best = max(found, key=lambda one: one.score)
    elsewhere = alternative_placements(part, whole, best.registration.scale, best.points, fixed, threads)
    likely = sorted(elsewhere, key=lambda one: -placement_score(placement_evidence(one)))[:N_ALTERNATIVES]
    more = [make_candidate(refine_placement(part, whole, one, fixed), part, whole, target) for one in likely]
    order = sorted([*found, *more], key=lambda one: -one.score)
    chosen = select_distinct(order, differ, 1 + N_RIVALS)
    rest = [one for one in order if all(differ(one, other) for other in chosen)]
    least = chosen[0].score - SCORE.part.hopeless_margin
    last = [refine_candidate(one, part, whole, target, fixed) if one.score > least else one for one in chosen]
    return sorted([*last, *rest], key=lambda one: -one.score)


def alternative_placements(
    part: PartSamples,
    whole: PartSamples,
    scale: float,
    points: np.ndarray,
    fixed: bool = False,
    threads: int | None = None,
) -> list[Placement]:
    """Return placements of the samples elsewhere than at ``points (q, 3)``, by relaxation and beam searches.

    ``scale``: √area of the part over that of the whole. Samples that are landmarks stay.
    """
    off = np.linalg.norm(points[:, None] - whole.mesh.vertices[whole.samples][None], axis=2)
    cost = COST * (off < SCORE.part.distinct_distance).astype(np.float32)
    cost[: part.marks] = 0.0
    each = np.arange(len(points))

    def place(scale: float) -> list[Placement]:
        alike = shot_similarity(part, whole, scale, TRIALS[0].radii, 1)
        left = alike - cost
        begun = place_by_beams(part, whole, scale, left)
        begun.append(place_by_relaxation(part, whole, scale, left, TRIALS[0]))
        placed = [place_all(part, whole, Placement(scale, TRIALS[0], one, alike)) for one in begun]
        apart = SCORE.part.distinct_distance
        return [one for one in placed if float(np.median(off[each, one.placed.match])) > apart]

    scales = [scale * ratio for ratio in (SCALE_RATIOS[:1] if fixed else SCALE_RATIOS)]
    return [one for some in parallel(place, scales, threads) for one in some]


def refine_candidate(
    one: PartCandidate,
    part: PartSamples,
    whole: PartSamples,
    target: RegistrationTarget,
    fixed: bool = False,
) -> PartCandidate:
    """Place and register the part anew from where it lies, until that makes it no better."""
    for i in range(ROUNDS[1]):
        before, one = one.score, _placed_again(one, part, whole, target, fixed)
        if i + 1 >= ROUNDS[0] and one.score < before + SCORE.part.min_gain:
            break
    return one


def _placed_again(
    one: PartCandidate,
    part: PartSamples,
    whole: PartSamples,
    target: RegistrationTarget,
    fixed: bool,
) -> PartCandidate:
    """Place and register the part once more, at the scale of its edges."""
    match = np.asarray(KDTree(whole.mesh.vertices[whole.samples]).query(one.points)[1])
    match[: part.marks] = np.arange(part.marks)
    trust = np.maximum(one.registration.inside[part.samples], 1e-3)
    placed = Assignment(match, trust, one.placement.placed.support)
    scale = one.placement.scale if fixed else one.registration.scale * one.registration.edge_ratio
    begun = replace(one.placement, scale=scale, placed=placed)
    return make_candidate(refine_placement(part, whole, begun, fixed), part, whole, target)


def differ(one: PartCandidate, other: PartCandidate) -> bool:
    """Return whether two candidates put the part elsewhere."""
    return float(np.median(np.linalg.norm(one.points - other.points, axis=1))) > SCORE.part.distinct_distance


def margin(found: Sequence[PartCandidate]) -> float:
    """Return by how much the best of ``found``, which is first, precedes the best that differs, up to a maximum."""
    others = [one.score for one in found if differ(one, found[0])]
    return min(found[0].score - max(others), SCORE.part.max_margin) if others else SCORE.part.max_margin
