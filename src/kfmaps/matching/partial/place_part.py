"""The best of several ways to place a part on a whole, and how sure that is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._threads import parallel
from kfmaps.config import Partial
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.partial.candidates import Candidate, Evidence, make_candidate, plain_score
from kfmaps.matching.partial.compare_alternatives import compare_alternatives, margin
from kfmaps.matching.partial.overlap import Overlap, overlap
from kfmaps.matching.partial.registration import (
    FULL,
    PartRegistration,
    RegistrationTarget,
    register_part,
    registration_target,
)
from kfmaps.matching.partial.samples import PartSamples, part_samples
from kfmaps.matching.partial.scale_search import (
    LARGER,
    SCALES,
    TRIALS,
    Placement,
    refine_placement,
    search_scale,
    try_scales,
)

ALIKE = 1.12
"""Ratio of scales from which two are worth a trial each."""
AGAIN = 2
"""Scales at which all trials are made."""
BEAMS = 4
"""Placings of the beam searches in which all samples are placed, ..."""
BENT = 2
"""... and those that are bent."""


@dataclass(frozen=True, eq=False)
class PlacedPart:
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

    bent: PartRegistration
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


def place_part(
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
) -> PlacedPart:
    """Place ``part`` on ``whole``, both at unit area.

    ``ratio``: √area of the part over that of the whole as they were given, one of the scales that are tried, and the
    only one where ``settings.units`` says "same". ``landmarks (l, 2)``: vertices of the part and of the whole.
    ``loose``: neither holds all of the other.
    """
    told = progress or (lambda _done: None)
    pairs = np.zeros((0, 2), dtype=np.int64) if landmarks is None else np.asarray(landmarks)
    if settings.units == "same" and ratio is None:
        raise refuse("units", "shapes whose sizes are known", "prepared ones without", "prepare them again")
    sides = (
        part_samples(part, settings.samples, pairs[:, 0], rng),
        part_samples(whole, settings.whole_samples, pairs[:, 1], rng),
    )
    told(0.15)
    marked = np.stack([np.arange(len(pairs))] * 2, axis=1)
    fixed = settings.units == "same"
    scales = [ratio] if fixed and ratio else [*SCALES, *(LARGER if loose else ())]
    if not fixed and ratio and scales[0] / ALIKE < ratio < scales[-1] * ALIKE:
        scales.append(ratio)
    first = distinct(try_scales(*sides, scales, marked, TRIALS[0], threads))[: settings.candidates]
    told(0.3)
    rough = [*first]
    for trial in TRIALS[1:]:
        rough += try_scales(*sides, [one.scale for one in first[:AGAIN]], marked, trial, threads)
    further = sorted(search_scale(*sides, scales, marked, threads), key=lambda one: -plain_score(one))[:BEAMS]
    told(0.4)
    full = parallel(lambda one: (one, refine_placement(*sides, one, marked, fixed)), [*rough, *further], threads)
    # Few of the samples of a beam search were placed by their descriptors: before it is bent it looks worse than it is.
    plain, beams = (
        sorted(some, key=lambda pair: -plain_score(pair[1])) for some in (full[: len(rough)], full[len(rough) :])
    )
    likely = [*plain[: settings.candidates + 1], *beams[:BENT]]
    told(0.5)
    on = registration_target(whole, sides[1].on_boundary)
    found: list[Candidate] = []
    for i, (one, placed) in enumerate(likely):
        found.append(make_candidate(one, placed, *sides, on))
        told(0.5 + 0.15 * (i + 1) / len(likely))
    found = compare_alternatives(found, *sides, on, marked, fixed, threads)
    best = found[0]
    told(0.75)
    last = finished(best.bend, sides[0], on, pairs, fixed, lambda done: told(0.75 + 0.25 * done))
    ends = last.vertices[pairs[:, 0]] - whole.vertices[pairs[:, 1]]
    return PlacedPart(
        last,
        overlap(last, on, sides[0].on_boundary),
        best.seen,
        best.score,
        tuple(one.score for one in found[1:]),
        margin([(one.score, one.places) for one in found]),
        np.linalg.norm(ends, axis=1),
    )


def distinct(rough: Sequence[Placement]) -> list[Placement]:
    """The best, then the best of those at scales that differ from it by more than steps between them."""
    kept: list[Placement] = []
    for one in rough:
        if all(max(one.scale / other.scale, other.scale / one.scale) > ALIKE for other in kept):
            kept.append(one)
    return kept


def finished(
    bend: PartRegistration,
    part: PartSamples,
    on: RegistrationTarget,
    pairs: np.ndarray,
    fixed: bool,
    progress: Callable[[float], None],
) -> PartRegistration:
    """Bent once more, from where it came to lie, at the scale that its edges say."""
    places = closest_points(bend.vertices[part.samples], on.mesh.vertices, on.mesh.faces)
    points, normals = places.points, on.normals[on.mesh.faces[places.faces]].mean(axis=1)
    trust = bend.inside[part.samples] * np.exp2(-((places.distances / 0.02) ** 2)) + 1e-3
    points[: len(pairs)], normals[: len(pairs)] = on.mesh.vertices[pairs[:, 1]], on.normals[pairs[:, 1]]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    scale = bend.scale if fixed else bend.scale * bend.edge_ratio
    return register_part(part.mesh, scale, on, part.samples, points, normals, trust, FULL, 5, progress)
