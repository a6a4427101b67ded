"""The best of several ways to place a part on a whole, and how sure that is."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import refuse
from kfmaps._threads import parallel
from kfmaps.config import Partial
from kfmaps.parts.bend import FULL, QUICK, Bent, Ground, bent, ground
from kfmaps.parts.labels import Placed
from kfmaps.parts.overlap import Overlap, overlap
from kfmaps.parts.rivals import ELSEWHERE, rivals
from kfmaps.parts.side import Side, side
from kfmaps.parts.units import LARGER, SCALES, TRIALS, Rough, grown, searched, tried
from kfmaps.surface.closest import places_on
from kfmaps.surface.mesh import Mesh

ALIKE = 1.12
"""Ratio of scales from which two are worth a trial each."""
AGAIN = 2
"""Scales at which all trials are made."""
BEAMS = 4
"""Placings of the beam searches in which all samples are placed, ..."""
BENT = 2
"""... and those that are bent."""
RIVALS = 2
"""Placings elsewhere than the best that are bent, and those that are compared with it."""
POLISHED = (2, 5)
"""How often these are placed and bent anew, at least, and at most ..."""
GAIN = 0.2
"""... while their scores rise by so much."""
CLEAR = 2.0
"""Margin from which more does not count."""
CONSISTENCY, BENDING = 4.0, 3.0
"""Weights in the score. Where a half of a body lies on its other half, turned front to back, descriptors and distances
fit as well as where it belongs; that it bends by half as much again counts alike for stiff shapes and for soft ones."""
LITTLE = 0.005
"""Bending that any part shows, by its mesh alone."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """What speaks for one placing without knowing the truth; see :func:`score`.

    Attributes
    ----------
    support : float
        Consistency of the first samples' pairs, 0 to 1, at the scale tried.
    consistency : float
        Of all samples with their neighbours, 0 to 1.
    unlike : float
        Mean logarithm of the part of the whole's samples that resemble a sample more than its place does: 0 and less.
    bending, gap, folded : float
        Of :class:`kfmaps.parts.bend.Bent`.
    spread : float
        Part of the samples that have places of their own.
    """

    support: float
    consistency: float
    unlike: float
    bending: float
    gap: float
    folded: float
    spread: float


@dataclass(frozen=True, eq=False)
class Candidate:
    """A part bent from one placing of its samples.

    Attributes
    ----------
    begun, full : Rough
        As it was proposed, and with all samples placed.
    bend : Bent
    places : (q, 3) float64
        Of the samples, on the whole.
    seen : Evidence
    score : float
    """

    begun: Rough
    full: Rough
    bend: Bent
    places: np.ndarray
    seen: Evidence
    score: float


def score(found: Evidence) -> float:
    """One number, higher is better."""
    fits = CONSISTENCY * found.consistency - found.unlike - 50.0 * found.gap - 4.0 * found.folded
    return fits + BENDING * firmness(found.bending)


def firmness(bending: float) -> float:
    """Minus the logarithm of the ``bending``."""
    return -math.log(max(bending, 0.0) + LITTLE)


@dataclass(frozen=True, eq=False)
class Parted:
    """A part placed on a whole.

    Attributes
    ----------
    bent : Bent
    overlap : Overlap
    evidence : Evidence
        Of the best candidate before it was finished.
    score : float
    others : tuple of float
        Scores of the other candidates.
    margin : float
        By how much the best of those that place the part elsewhere scores less; at most :data:`CLEAR`.
    wrong : (l,) float64
        How far each landmark ended from where it was said to be, in √area of the whole.
    """

    bent: Bent
    overlap: Overlap
    evidence: Evidence
    score: float
    others: tuple[float, ...]
    margin: float
    wrong: np.ndarray

    @property
    def scale(self) -> float:
        """√area of the part over that of the whole."""
        return self.bent.scale


def parted(
    part: Mesh,
    whole: Mesh,
    settings: Partial,
    *,
    ratio: float | None = None,
    landmarks: np.ndarray | None = None,
    loose: bool = False,
    rng: int = 0,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Parted:
    """Place ``part`` on ``whole``, both at unit area.

    ``ratio``: √area of the part over that of the whole as they were given, one of the scales that are tried, and the
    only one where ``settings.units`` says "same". ``landmarks (l, 2)``: vertices of the part and of the whole.
    ``loose``: neither holds all of the other.
    """
    told = progress or (lambda _done: None)
    pairs = np.zeros((0, 2), dtype=np.int64) if landmarks is None else np.asarray(landmarks)
    if settings.units == "same" and ratio is None:
        raise refuse("units", "shapes whose sizes are known", "prepared ones without", "prepare them again")
    sides = side(part, settings.samples, pairs[:, 0], rng), side(whole, settings.whole_samples, pairs[:, 1], rng)
    told(0.15)
    marked = np.stack([np.arange(len(pairs))] * 2, axis=1)
    fixed = settings.units == "same"
    scales = [ratio] if fixed and ratio else [*SCALES, *(LARGER if loose else ())]
    if not fixed and ratio and scales[0] / ALIKE < ratio < scales[-1] * ALIKE:
        scales.append(ratio)
    first = distinct(tried(*sides, scales, marked, TRIALS[0], threads))[: settings.candidates]
    told(0.3)
    rough = [*first]
    for trial in TRIALS[1:]:
        rough += tried(*sides, [one.scale for one in first[:AGAIN]], marked, trial, threads)
    further = sorted(searched(*sides, scales, marked, threads), key=lambda one: -plain_score(one))[:BEAMS]
    told(0.4)
    full = parallel(lambda one: (one, grown(*sides, one, marked, fixed)), [*rough, *further], threads)
    # Few of the samples of a beam search were placed by their descriptors: before it is bent it looks worse than it is.
    plain, beams = (
        sorted(some, key=lambda pair: -plain_score(pair[1])) for some in (full[: len(rough)], full[len(rough) :])
    )
    likely = [*plain[: settings.candidates + 1], *beams[:BENT]]
    told(0.5)
    on = ground(whole, sides[1].border)
    found: list[Candidate] = []
    for i, (one, placed) in enumerate(likely):
        found.append(laid(one, placed, *sides, on))
        told(0.5 + 0.15 * (i + 1) / len(likely))
    found = contested(found, *sides, on, marked, fixed, threads)
    best = found[0]
    told(0.75)
    last = finished(best.bend, sides[0], on, pairs, fixed, lambda done: told(0.75 + 0.25 * done))
    ends = last.vertices[pairs[:, 0]] - whole.vertices[pairs[:, 1]]
    return Parted(
        last,
        overlap(last, on, sides[0].border),
        best.seen,
        best.score,
        tuple(one.score for one in found[1:]),
        margin([(one.score, one.places) for one in found]),
        np.linalg.norm(ends, axis=1),
    )


def margin(found: Sequence[tuple[float, np.ndarray]]) -> float:
    """Of candidates, best first, given by their scores and places ``(q, 3)``; see :attr:`Parted.margin`."""
    best, places = found[0]
    others = [value for value, other in found if differ(other, places)]
    return min(best - max(others), CLEAR) if others else CLEAR


def contested(
    found: Sequence[Candidate],
    part: Side,
    whole: Side,
    on: Ground,
    marked: np.ndarray,
    fixed: bool = False,
    threads: int | None = None,
) -> list[Candidate]:
    """Candidates, best first, once the best has been compared with the best placings elsewhere on equal terms.

    Rivals of the best are looked for (:mod:`kfmaps.parts.rivals`). Then it and the best of those that differ are placed
    and bent anew from where they came to lie, until that makes them no better: a placing that was hit by chance is far
    from what it can be, and would lose against one that was not.
    ``marked (l, 2)``: landmarks, by numbers of samples.
    """
    best = max(found, key=lambda one: one.score)
    elsewhere = rivals(part, whole, best.bend.scale, best.places, marked, fixed, threads)
    likely = sorted(elsewhere, key=lambda one: -plain_score(one))[:RIVALS]
    more = [laid(one, grown(part, whole, one, marked, fixed), part, whole, on) for one in likely]
    chosen: list[Candidate] = []
    rest: list[Candidate] = []
    for one in sorted([*found, *more], key=lambda one: -one.score):
        if all(differ(one.places, other.places) for other in chosen):
            (chosen if len(chosen) <= RIVALS else rest).append(one)
    last = [polished(one, part, whole, on, marked, fixed) for one in chosen]
    return sorted([*last, *rest], key=lambda one: -one.score)


def laid(begun: Rough, full: Rough, part: Side, whole: Side, on: Ground) -> Candidate:
    """The candidate that a placing makes."""
    bend = placed_on(full, part, whole, on)
    seen = evidence(begun, full, bend)
    return Candidate(begun, full, bend, bend.places.points[part.samples], seen, score(seen))


def polished(one: Candidate, part: Side, whole: Side, on: Ground, marked: np.ndarray, fixed: bool = False) -> Candidate:
    """Placed and bent anew from where it came to lie, until that makes it no better."""
    for done in range(POLISHED[1]):
        before, one = one.score, settled_in(one, part, whole, on, marked, fixed)
        if done + 1 >= POLISHED[0] and one.score < before + GAIN:
            break
    return one


def settled_in(
    one: Candidate, part: Side, whole: Side, on: Ground, marked: np.ndarray, fixed: bool = False
) -> Candidate:
    """Placed and bent once more from where it came to lie, at the scale that its edges say."""
    match = KDTree(whole.mesh.vertices[whole.samples]).query(one.places)[1]
    match[marked[:, 0]] = marked[:, 1]
    placed = Placed(match, np.maximum(one.bend.inside[part.samples], 1e-3), one.full.placed.support)
    scale = one.full.scale if fixed else one.bend.scale * one.bend.longer
    full = grown(part, whole, replace(one.full, scale=scale, placed=placed), marked, fixed)
    return laid(one.begun, full, part, whole, on)


def differ(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether the places ``(q, 3)`` of two candidates are elsewhere."""
    return float(np.median(np.linalg.norm(one - other, axis=1))) > ELSEWHERE


def distinct(rough: Sequence[Rough]) -> list[Rough]:
    """The best, then the best of those at scales that differ from it by more than steps between them."""
    kept: list[Rough] = []
    for one in rough:
        if all(max(one.scale / other.scale, other.scale / one.scale) > ALIKE for other in kept):
            kept.append(one)
    return kept


def placed_on(full: Rough, part: Side, whole: Side, on: Ground) -> Bent:
    """The part bent quickly by its placed samples."""
    at = whole.samples[full.placed.match]
    trust = np.maximum(full.placed.trust, 0.01)
    return bent(part.mesh, full.scale, on, part.samples, on.mesh.vertices[at], on.normals[at], trust, QUICK, 3)


def finished(
    bend: Bent, part: Side, on: Ground, pairs: np.ndarray, fixed: bool, progress: Callable[[float], None]
) -> Bent:
    """Bent once more, from where it came to lie, at the scale that its edges say."""
    places = places_on(bend.vertices[part.samples], on.mesh.vertices, on.mesh.faces)
    points, normals = places.points, on.normals[on.mesh.faces[places.faces]].mean(axis=1)
    trust = bend.inside[part.samples] * np.exp2(-((places.distances / 0.02) ** 2)) + 1e-3
    points[: len(pairs)], normals[: len(pairs)] = on.mesh.vertices[pairs[:, 1]], on.normals[pairs[:, 1]]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    scale = bend.scale if fixed else bend.scale * bend.longer
    return bent(part.mesh, scale, on, part.samples, points, normals, trust, FULL, 5, progress)


def unlikeness(full: Rough) -> float:
    """See :attr:`Evidence.unlike`."""
    match, alike = full.placed.match, full.alike
    own = alike[np.arange(len(match)), match]
    better = (alike > own[:, None]).sum(axis=1)
    return float(np.log((better + 1) / alike.shape[1]).mean())


def plain_score(full: Rough) -> float:
    """What of :func:`score` is known before the part is bent."""
    return CONSISTENCY * full.placed.support - unlikeness(full)


def evidence(rough: Rough, full: Rough, bend: Bent) -> Evidence:
    """Of one candidate, as it was tried, placed and bent."""
    match = full.placed.match
    return Evidence(
        rough.placed.support,
        full.placed.support,
        unlikeness(full),
        bend.bending,
        bend.gap,
        bend.folded,
        len(np.unique(match)) / len(match),
    )
