"""Search for the scale of the part against the whole, from a thirteenth of its area to all of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._threads import parallel
from kfmaps.matching.partial.beam_search import beam_search
from kfmaps.matching.partial.relaxation_labeling import (
    Assignment,
    DistanceBounds,
    RelaxationParams,
    distance_bounds,
    reassign,
    relax,
    stretch,
)
from kfmaps.matching.partial.samples import PartSamples

TRIALS = (
    RelaxationParams(),
    RelaxationParams((0.06, 0.09, 0.14, 0.2), 100, 30, 1.2),
    RelaxationParams((0.06, 0.09, 0.14, 0.2), 70, 45, 1.2),
)
"""The first tries all scales, the others the best of these."""
SCALES = tuple(0.28 * 1.15**i for i in range(10))
"""√area of the part over that of the whole; SHOT and consistency tolerate a tenth more or less."""
LARGER = tuple(SCALES[-1] * 1.15**i for i in range(1, 4))
"""Further ones where what is registered is no part, but overlaps with one."""
FOLLOWED = 3
"""Scales whose beam searches are followed up."""
LIMITS = (0.1, 1.6)
"""Least and greatest scale."""
ROUNDS = 3
"""Reassignments before and after descriptors are computed at the scale that was found."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Samples of the part placed at one scale.

    Attributes
    ----------
    scale : float
        √area of the part over that of the whole.
    trial : RelaxationParams
    placed : Assignment
    alike : (q, m) float32
        Products of descriptors.
    """

    scale: float
    trial: RelaxationParams
    placed: Assignment
    alike: np.ndarray


def shot_similarity(
    part: PartSamples, whole: PartSamples, scale: float, radii: tuple[float, ...], threads: int | None = None
) -> np.ndarray:
    """Return mean products ``(q, m)`` of the SHOT of both, in balls of equal size; landmarks are settled."""
    total = sum(part.shot(r / scale, threads) @ whole.shot(r, threads).T for r in radii)
    alike = np.asarray(total, dtype=np.float32) / len(radii)
    landmarks = np.arange(part.marks)
    alike[landmarks] = -1.0
    alike[landmarks, landmarks] = 2.0
    return alike


def scaled_bounds(part: PartSamples, scale: float) -> DistanceBounds:
    """Return the bounds of the part's distances at a ``scale``."""
    return distance_bounds(part.distances, part.boundary_distance, scale)


def place_by_beams(part: PartSamples, whole: PartSamples, scale: float, alike: np.ndarray) -> list[Assignment]:
    """Return the placements of a few samples by a beam search at one ``scale``."""
    away = part.boundary_distance * np.float32(scale)
    return beam_search(scaled_bounds(part, scale), away, whole.distances, alike, part.marks)


def place_by_relaxation(
    part: PartSamples, whole: PartSamples, scale: float, alike: np.ndarray, trial: RelaxationParams
) -> Assignment:
    """Return the placement of the first samples by relaxation at one ``scale``."""
    return relax(scaled_bounds(part, scale), whole.distances, alike, trial, part.marks)


def place_all(part: PartSamples, whole: PartSamples, one: Placement) -> Placement:
    """Place all samples anew, at the same scale."""
    bounds = scaled_bounds(part, one.scale)
    return replace(one, placed=reassign(bounds, whole.distances, one.alike, one.placed, part.marks))


def try_scales(
    part: PartSamples,
    whole: PartSamples,
    scales: Sequence[float],
    trial: RelaxationParams = TRIALS[0],
    threads: int | None = None,
) -> list[Placement]:
    """Place the first samples at each of ``scales`` as ``trial`` says, the best supported first."""
    for radius in trial.radii:
        whole.shot(radius, threads)

    def place(scale: float) -> Placement:
        alike = shot_similarity(part, whole, scale, trial.radii, 1)
        return Placement(scale, trial, place_by_relaxation(part, whole, scale, alike, trial), alike)

    return sorted(parallel(place, list(scales), threads), key=lambda one: -one.placed.support)


def search_scale(
    part: PartSamples, whole: PartSamples, scales: Sequence[float], threads: int | None = None
) -> list[Placement]:
    """Place all samples by beam searches at each of ``scales``; those of the best scales, best first."""
    trial = TRIALS[0]
    for radius in trial.radii:
        whole.shot(radius, threads)

    def place(scale: float) -> list[Placement]:
        alike = shot_similarity(part, whole, scale, trial.radii, 1)
        return [Placement(scale, trial, one, alike) for one in place_by_beams(part, whole, scale, alike)]

    found = sorted(parallel(place, list(scales), threads), key=lambda some: -some[0].placed.support)
    likely = [one for some in found[:FOLLOWED] for one in some]
    return parallel(lambda one: place_all(part, whole, one), likely, threads)


def refine_placement(part: PartSamples, whole: PartSamples, one: Placement, fixed: bool = False) -> Placement:
    """Place all samples, and find the scale with them unless it is ``fixed``."""
    for repeated in range(2):
        for _ in range(ROUNDS):
            scale, one = one.scale, place_all(part, whole, one)
            if not fixed:
                longer = stretch(scaled_bounds(part, scale), whole.distances, one.placed)
                one = replace(one, scale=float(np.clip(scale * longer, *LIMITS)))
        if not repeated and not fixed:
            one = replace(one, alike=shot_similarity(part, whole, one.scale, one.trial.radii, 1))
    return one
