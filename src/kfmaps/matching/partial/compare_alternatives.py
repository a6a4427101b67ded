"""The best candidate against the best that puts the part elsewhere, on equal terms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from kfmaps.matching.partial.alternatives import ELSEWHERE, alternative_placements
from kfmaps.matching.partial.candidates import Candidate, make_candidate, plain_score
from kfmaps.matching.partial.registration import RegistrationTarget
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import PartSamples
from kfmaps.matching.partial.scale_search import refine_placement

LOOKED = 3
"""Placings elsewhere than the best that are looked for and bent, ..."""
RIVALS = 2
"""... and those of all candidates that are compared with it."""
POLISHED = (2, 5)
"""How often these are placed and bent anew, at least, and at most ..."""
GAIN = 0.2
"""... while their scores rise by so much."""
HOPELESS = 5.0
"""Score by which a placing is too far behind to come near by that: the most that has been gained is 2.3."""
CLEAR = 3.0
"""Margin from which more does not count."""


def compare_alternatives(
    found: Sequence[Candidate],
    part: PartSamples,
    whole: PartSamples,
    on: RegistrationTarget,
    marked: np.ndarray,
    fixed: bool = False,
    threads: int | None = None,
) -> list[Candidate]:
    """Candidates, best first, once the best has been compared with the best placings elsewhere on equal terms.

    Rivals of the best are looked for (:mod:`kfmaps.matching.partial.alternatives`). Then it and the best of those
    that differ are placed
    and bent anew from where they came to lie, until that makes them no better: a placing that was hit by chance is far
    from what it can be, and would lose against one that was not.
    ``marked (l, 2)``: landmarks, by numbers of samples.
    """
    best = max(found, key=lambda one: one.score)
    elsewhere = alternative_placements(part, whole, best.bend.scale, best.places, marked, fixed, threads)
    likely = sorted(elsewhere, key=lambda one: -plain_score(one))[:LOOKED]
    more = [make_candidate(one, refine_placement(part, whole, one, marked, fixed), part, whole, on) for one in likely]
    chosen: list[Candidate] = []
    rest: list[Candidate] = []
    for one in sorted([*found, *more], key=lambda one: -one.score):
        if all(differ(one.places, other.places) for other in chosen):
            (chosen if len(chosen) <= RIVALS else rest).append(one)
    least = chosen[0].score - HOPELESS
    last = [refine_candidate(one, part, whole, on, marked, fixed) if one.score > least else one for one in chosen]
    return sorted([*last, *rest], key=lambda one: -one.score)


def refine_candidate(
    one: Candidate,
    part: PartSamples,
    whole: PartSamples,
    on: RegistrationTarget,
    marked: np.ndarray,
    fixed: bool = False,
) -> Candidate:
    """Placed and bent anew from where it came to lie, until that makes it no better."""
    for done in range(POLISHED[1]):
        before, one = one.score, settled_in(one, part, whole, on, marked, fixed)
        if done + 1 >= POLISHED[0] and one.score < before + GAIN:
            break
    return one


def settled_in(
    one: Candidate,
    part: PartSamples,
    whole: PartSamples,
    on: RegistrationTarget,
    marked: np.ndarray,
    fixed: bool = False,
) -> Candidate:
    """Placed and bent once more from where it came to lie, at the scale that its edges say."""
    match = np.asarray(KDTree(whole.mesh.vertices[whole.samples]).query(one.places)[1])
    match[marked[:, 0]] = marked[:, 1]
    placed = Assignment(match, np.maximum(one.bend.inside[part.samples], 1e-3), one.full.placed.support)
    scale = one.full.scale if fixed else one.bend.scale * one.bend.edge_ratio
    full = refine_placement(part, whole, replace(one.full, scale=scale, placed=placed), marked, fixed)
    return make_candidate(one.begun, full, part, whole, on)


def differ(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether the places ``(q, 3)`` of two candidates are elsewhere."""
    return float(np.median(np.linalg.norm(one - other, axis=1))) > ELSEWHERE


def margin(found: Sequence[tuple[float, np.ndarray]]) -> float:
    """Of candidates, best first, given by their scores and places ``(q, 3)``; see :attr:`Parted.margin`."""
    best, places = found[0]
    others = [value for value, other in found if differ(other, places)]
    return min(best - max(others), CLEAR) if others else CLEAR
