"""A part bent from one placing of its samples, and what that shows without the truth."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kfmaps.matching.partial.registration import QUICK, PartRegistration, RegistrationTarget, register_part
from kfmaps.matching.partial.samples import PartSamples
from kfmaps.matching.partial.scale_search import Placement

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
        Of :class:`kfmaps.matching.partial.registration.PartRegistration`.
    spread : float
        Part of the samples that have places of their own.
    """

    support: float
    consistency: float
    unlike: float
    deformation_energy: float
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

    begun: Placement
    full: Placement
    bend: PartRegistration
    places: np.ndarray
    seen: Evidence
    score: float


def score(found: Evidence) -> float:
    """One number, higher is better."""
    fits = CONSISTENCY * found.consistency - found.unlike - 50.0 * found.gap - 4.0 * found.folded
    return fits + BENDING * firmness(found.deformation_energy)


def firmness(bending: float) -> float:
    """Minus the logarithm of the ``bending``."""
    return -math.log(max(bending, 0.0) + LITTLE)


def make_candidate(
    begun: Placement, full: Placement, part: PartSamples, whole: PartSamples, on: RegistrationTarget
) -> Candidate:
    """The candidate that a placing makes."""
    bend = placed_on(full, part, whole, on)
    seen = evidence(begun, full, bend)
    return Candidate(begun, full, bend, bend.places.points[part.samples], seen, score(seen))


def placed_on(full: Placement, part: PartSamples, whole: PartSamples, on: RegistrationTarget) -> PartRegistration:
    """The part bent quickly by its placed samples."""
    at = whole.samples[full.placed.match]
    trust = np.maximum(full.placed.trust, 0.01)
    return register_part(part.mesh, full.scale, on, part.samples, on.mesh.vertices[at], on.normals[at], trust, QUICK, 3)


def similarity_rank(full: Placement) -> float:
    """See :attr:`Evidence.unlike`."""
    match, alike = full.placed.match, full.alike
    own = alike[np.arange(len(match)), match]
    better = (alike > own[:, None]).sum(axis=1)
    return float(np.log((better + 1) / alike.shape[1]).mean())


def plain_score(full: Placement) -> float:
    """What of :func:`score` is known before the part is bent."""
    return CONSISTENCY * full.placed.support - similarity_rank(full)


def evidence(rough: Placement, full: Placement, bend: PartRegistration) -> Evidence:
    """Of one candidate, as it was tried, placed and bent."""
    match = full.placed.match
    return Evidence(
        rough.placed.support,
        full.placed.support,
        similarity_rank(full),
        bend.deformation_energy,
        bend.gap,
        bend.flipped_area,
        len(np.unique(match)) / len(match),
    )
