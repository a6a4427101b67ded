"""A part registered from one placement of its samples, and what that shows without the truth."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from kfmaps.matching.partial.registration import QUICK, PartRegistration, RegistrationTarget, register_part
from kfmaps.matching.partial.samples import PartSamples
from kfmaps.matching.partial.scale_search import Placement
from kfmaps.matching.score import PartEvidence, part_score


@dataclass(frozen=True, eq=False)
class PartCandidate:
    """A part registered from one placement of its samples.

    Attributes
    ----------
    placement : Placement
        With all samples placed.
    registration : PartRegistration
    points : (q, 3) float64
        Of the samples, on the whole.
    evidence : PartEvidence
    score : float
    """

    placement: Placement
    registration: PartRegistration
    points: np.ndarray
    evidence: PartEvidence
    score: float


def make_candidate(
    placement: Placement, part: PartSamples, whole: PartSamples, target: RegistrationTarget
) -> PartCandidate:
    """Register the part quickly by its placed samples."""
    at = whole.samples[placement.placed.match]
    trust = np.maximum(placement.placed.trust, 0.01)
    points, normals = target.mesh.vertices[at], target.normals[at]
    found = register_part(part.mesh, placement.scale, target, part.samples, points, normals, trust, QUICK, 3)
    evidence = replace(
        placement_evidence(placement),
        deformation_energy=found.deformation_energy,
        gap=found.gap,
        flipped_area=found.flipped_area,
    )
    return PartCandidate(placement, found, found.places.points[part.samples], evidence, part_score(evidence))


def placement_evidence(placement: Placement) -> PartEvidence:
    """Return what a placement shows before registration."""
    match, alike = placement.placed.match, placement.alike
    better = (alike > alike[np.arange(len(match)), match][:, None]).sum(axis=1)
    rank = float(np.log((better + 1) / alike.shape[1]).mean())
    return PartEvidence(placement.placed.support, rank)
