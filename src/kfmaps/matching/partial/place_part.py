"""The best of several ways to place a part on a whole, and how sure that is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._threads import parallel
from kfmaps.config import Partial
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.partial.alternatives import compare_alternatives, margin
from kfmaps.matching.partial.candidates import PartCandidate, make_candidate, placement_evidence
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
from kfmaps.matching.score import placement_score, select_distinct

SCALE_RATIO = 1.12
"""Ratio of scales from which two are worth a trial each."""
AGAIN = 2
"""Scales at which all trials are made."""
BEAMS = 4
"""Placements of the beam searches in which all samples are placed."""
REGISTERED = 2
"""Placements of the beam searches that are registered."""


@dataclass(frozen=True, eq=False)
class PlacedPart:
    """A part placed on a whole.

    Attributes
    ----------
    registration : PartRegistration
    overlap : Overlap
    scores : tuple of float
        Of all candidates, the best first.
    margin : float
        By how much the best of those that place the part elsewhere scores less.
    landmark_errors : (l,) float64
        Distance of each landmark from where it should be, in √area of the whole.
    """

    registration: PartRegistration
    overlap: Overlap
    scores: tuple[float, ...]
    margin: float
    landmark_errors: np.ndarray


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
    only one where ``settings.scale`` is "fixed". ``landmarks (l, 2)``: vertices of the part and of the whole.
    ``loose``: neither holds all of the other.
    """
    report = progress or (lambda _done: None)
    pairs = np.zeros((0, 2), dtype=np.int64) if landmarks is None else np.asarray(landmarks)
    fixed = settings.scale == "fixed"
    if fixed and ratio is None:
        raise refuse("units", "shapes whose sizes are known", "prepared ones without", "prepare them again")
    sides = (
        part_samples(part, settings.samples, pairs[:, 0], rng),
        part_samples(whole, settings.whole_samples, pairs[:, 1], rng),
    )
    report(0.15)
    scales = [ratio] if fixed and ratio else [*SCALES, *(LARGER if loose else ())]
    if not fixed and ratio and scales[0] / SCALE_RATIO < ratio < scales[-1] * SCALE_RATIO:
        scales.append(ratio)
    likely = _likely_placements(*sides, scales, settings.candidates, fixed, threads)
    report(0.5)
    target = registration_target(whole, sides[1].on_boundary)
    found: list[PartCandidate] = []
    for i, one in enumerate(likely):
        found.append(make_candidate(one, *sides, target))
        report(0.5 + 0.15 * (i + 1) / len(likely))
    found = compare_alternatives(found, *sides, target, fixed, threads)
    report(0.75)
    last = _finish(found[0].registration, sides[0], target, pairs, fixed, lambda done: report(0.75 + 0.25 * done))
    ends = last.vertices[pairs[:, 0]] - whole.vertices[pairs[:, 1]]
    common = overlap(last, target, sides[0].on_boundary)
    return PlacedPart(last, common, tuple(c.score for c in found), margin(found), np.linalg.norm(ends, axis=1))


def scales_differ(one: Placement, other: Placement) -> bool:
    """Return whether the scales of two placements differ by more than the steps between those that are tried."""
    return max(one.scale / other.scale, other.scale / one.scale) > SCALE_RATIO


def _likely_placements(
    part: PartSamples, whole: PartSamples, scales: list[float], count: int, fixed: bool, threads: int | None
) -> list[Placement]:
    """Return the placements of all samples that are worth a registration, by relaxation and by beam searches."""

    def plain(one: Placement) -> float:
        return -placement_score(placement_evidence(one))

    tried = try_scales(part, whole, scales, TRIALS[0], threads)
    first = select_distinct(tried, scales_differ, count)
    rough = [*first]
    for trial in TRIALS[1:]:
        rough += try_scales(part, whole, [one.scale for one in first[:AGAIN]], trial, threads)
    beams = sorted(search_scale(part, whole, scales, threads), key=plain)[:BEAMS]
    full = parallel(lambda one: refine_placement(part, whole, one, fixed), [*rough, *beams], threads)
    # Few samples of a beam search were placed by their descriptors: its score is too low before registration.
    by_relaxation, by_beams = full[: len(rough)], full[len(rough) :]
    return [*sorted(by_relaxation, key=plain)[: count + 1], *sorted(by_beams, key=plain)[:REGISTERED]]


def _finish(
    bend: PartRegistration,
    part: PartSamples,
    target: RegistrationTarget,
    pairs: np.ndarray,
    fixed: bool,
    progress: Callable[[float], None],
) -> PartRegistration:
    """Register the part once more, from where it lies, at the scale of its edges."""
    places = closest_points(bend.vertices[part.samples], target.mesh.vertices, target.mesh.faces)
    points, normals = places.points, target.normals[target.mesh.faces[places.faces]].mean(axis=1)
    trust = bend.inside[part.samples] * np.exp2(-((places.distances / 0.02) ** 2)) + 1e-3
    points[: len(pairs)], normals[: len(pairs)] = target.mesh.vertices[pairs[:, 1]], target.normals[pairs[:, 1]]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    scale = bend.scale if fixed else bend.scale * bend.edge_ratio
    return register_part(part.mesh, scale, target, part.samples, points, normals, trust, FULL, 5, progress)
