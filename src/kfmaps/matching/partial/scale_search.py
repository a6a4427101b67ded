"""How large the part is against the whole, which nobody says: tried from a thirteenth of its area to all of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._threads import parallel
from kfmaps.matching.partial.beam_search import beam_search
from kfmaps.matching.partial.relaxation_labeling import (
    Assignment,
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
"""√area of the part over that of the whole; SHOT and consistency take a tenth more or less."""
LARGER = tuple(SCALES[-1] * 1.15**i for i in range(1, 4))
"""Further ones where what is bent is no part, but overlaps with one."""
FOLLOWED = 3
"""Scales whose beam searches are followed up."""
LIMITS = (0.1, 1.6)
ROUNDS = 3
"""In which samples are placed anew, before and after descriptors are worked out at the scale that was found."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Samples of the part placed at one scale.

    Attributes
    ----------
    scale : float
        √area of the part over that of the whole.
    trial : Trial
    placed : Placed
    alike : (q, m) float32
        Products of descriptors.
    """

    scale: float
    trial: RelaxationParams
    placed: Assignment
    alike: np.ndarray


def shot_similarity(
    part: PartSamples,
    whole: PartSamples,
    scale: float,
    radii: tuple[float, ...],
    pairs: np.ndarray,
    threads: int | None = None,
) -> np.ndarray:
    """Mean products ``(q, m)`` of the SHOT of both, in balls of equal size; landmarks ``pairs`` are settled."""
    total = sum(part.shot(r / scale, threads) @ whole.shot(r, threads).T for r in radii)
    alike = np.asarray(total, dtype=np.float32) / len(radii)
    if len(pairs):
        alike[pairs[:, 0]] = -1.0
        alike[pairs[:, 0], pairs[:, 1]] = 2.0
    return alike


def try_scales(
    part: PartSamples,
    whole: PartSamples,
    scales: Sequence[float],
    pairs: np.ndarray,
    trial: RelaxationParams = TRIALS[0],
    threads: int | None = None,
) -> list[Placement]:
    """The first samples placed at each of ``scales`` as ``trial`` says, the best supported first."""
    for radius in trial.radii:
        whole.shot(radius, threads)

    def at(scale: float) -> Placement:
        alike = shot_similarity(part, whole, scale, trial.radii, pairs, 1)
        placed = relax(
            distance_bounds(part.distances, part.boundary_distance, scale), whole.distances, alike, trial, part.marks
        )
        return Placement(scale, trial, placed, alike)

    return sorted(parallel(at, list(scales), threads), key=lambda rough: -rough.placed.support)


def search_scale(
    part: PartSamples,
    whole: PartSamples,
    scales: Sequence[float],
    pairs: np.ndarray,
    threads: int | None = None,
) -> list[Placement]:
    """All samples placed by the beam searches at each of ``scales``, the best that each finds, best first."""
    trial = TRIALS[0]
    for radius in trial.radii:
        whole.shot(radius, threads)

    def at(scale: float) -> list[Placement]:
        alike = shot_similarity(part, whole, scale, trial.radii, pairs, 1)
        measure = distance_bounds(part.distances, part.boundary_distance, scale)
        begun = beam_search(measure, part.boundary_distance * np.float32(scale), whole.distances, alike, part.marks)
        return [Placement(scale, trial, placed, alike) for placed in begun]

    def all_placed(rough: Placement) -> Placement:
        measure = distance_bounds(part.distances, part.boundary_distance, rough.scale)
        placed = reassign(measure, whole.distances, rough.alike, rough.placed, part.marks)
        return replace(rough, placed=placed)

    found = sorted(parallel(at, list(scales), threads), key=lambda some: -some[0].placed.support)
    likely = [rough for some in found[:FOLLOWED] for rough in some]
    return parallel(all_placed, likely, threads)


def refine_placement(
    part: PartSamples, whole: PartSamples, rough: Placement, pairs: np.ndarray, fixed: bool = False
) -> Placement:
    """All samples placed, and the scale found with them unless it is ``fixed``."""
    scale, placed, alike = rough.scale, rough.placed, rough.alike
    for repeated in range(2):
        for _ in range(ROUNDS):
            measure = distance_bounds(part.distances, part.boundary_distance, scale)
            placed = reassign(measure, whole.distances, alike, placed, part.marks)
            if not fixed:
                scale = float(np.clip(scale * stretch(measure, whole.distances, placed), *LIMITS))
        if not repeated and not fixed:
            alike = shot_similarity(part, whole, scale, rough.trial.radii, pairs, 1)
    return Placement(scale, rough.trial, placed, alike)
