"""Where the candidates of one pair are made and judged: samples of both shapes, and what speaks for pairs of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, descriptor_guidance
from kfmaps.fmap.zoomout import pseudo_inverse
from kfmaps.matching.extremity_matching import ExtremityMatch, extremity_cost
from kfmaps.matching.landmark_evidence import LandmarkEvidence, heat_features, heat_guidance
from kfmaps.matching.quality import ShapeSamples, mirror_samples, subsample
from kfmaps.shape import Shape

POINTS = 400
"""Points of the rough refinement; the first of the probe."""


@dataclass(frozen=True, eq=False)
class SamplePair:
    """Samples of both shapes and what speaks against pairs of them.

    Attributes
    ----------
    source, target : Probe
    shot : (q_t, q_s) float32 or None
        See :func:`descriptor_cost`; ``None`` where SHOT says nothing.
    landmarks : (q_t, q_s) float32 or None
        The same of the functions around landmarks.
    marks : Marks or None
    solvers : dict
        What :meth:`solver` has made, to be found again.
    """

    source: ShapeSamples
    target: ShapeSamples
    shot: np.ndarray | None
    landmarks: np.ndarray | None = None
    marks: LandmarkEvidence | None = None
    solvers: dict[int, np.ndarray] = field(default_factory=dict)

    def solver(self, k: int) -> np.ndarray:
        """:func:`kfmaps.fmap.zoomout.pseudo_inverse` of the target, made once for all refinements."""
        if k not in self.solvers:
            self.solvers[k] = pseudo_inverse(self.target.samples.basis, k)
        return self.solvers[k]

    def against(
        self, shot: float, landmarks: float = 0.0, tips: float = 0.0, paired: Sequence[ExtremityMatch | None] = ()
    ) -> np.ndarray | None:
        """What speaks against pairs, with weights, for :func:`kfmaps.fmap.zoomout.batched_zoomout`.

        (q_t, q_s), or (m, q_t, q_s) when the tips of m maps are ``paired`` and count.
        """
        total = None
        for weight, part in ((shot, self.shot), (landmarks, self.landmarks)):
            if part is not None and weight:
                total = np.float32(weight) * part + (0 if total is None else total)
        if tips and any(pairing is not None for pairing in paired):
            each = np.zeros((len(paired), len(self.target.positions), len(self.source.positions)), dtype=np.float32)
            if total is not None:
                each[:] = total
            for i, pairing in enumerate(paired):
                if pairing is not None:
                    each[i] += tips * extremity_cost(self.source.extremities, self.target.extremities, pairing)
            total = each
        return total


@dataclass(frozen=True, eq=False)
class TwoLevelSamples:
    """Few samples for many rough maps, and all of a probe for the best."""

    few: SamplePair
    whole: SamplePair


def two_level_samples(
    source: Shape, target: Shape, probes: tuple[ShapeSamples, ShapeSamples], landmarks: np.ndarray | None = None
) -> TwoLevelSamples:
    """For two prepared shapes with their ``probes``, which know of the ``landmarks (l, 2)``, if any."""
    found = None
    if landmarks is not None and len(landmarks):
        sides = list(zip((source, target), probes, landmarks.T, strict=True))
        functions = [heat_features(p.samples.basis, shape.basis, at) for shape, p, at in sides]
        found = LandmarkEvidence(
            target.basis.functions[landmarks[:, 1]], probes[0].landmark_distances, functions[0], functions[1]
        )
    few = subsample(probes[0], POINTS), subsample(probes[1], POINTS)
    less = found and found.thinned(*(len(p.samples.vertices) for p in few))
    return TwoLevelSamples(sample_pair(*few, less), sample_pair(*probes, found))


def sample_pair(source: ShapeSamples, target: ShapeSamples, marks: LandmarkEvidence | None = None) -> SamplePair:
    found = descriptor_guidance(source.descriptors, target.descriptors)
    around = None if marks is None else descriptor_cost(heat_guidance(marks.functions_s, marks.functions_t))
    return SamplePair(source, target, None if found is None else descriptor_cost(found), around, marks)


def drop_landmarks(on: SamplePair, wrong: np.ndarray) -> SamplePair:
    """The ground without the ``wrong (l,)`` landmarks."""
    return sample_pair(on.source, on.target, on.marks and on.marks.without(wrong))


def mirrored_pair(on: SamplePair) -> SamplePair:
    """The ground with the target's mirror image."""
    return sample_pair(on.source, mirror_samples(on.target), on.marks)


def descriptor_cost(found: DescriptorGuidance) -> np.ndarray:
    """Half the squared differences ``(q_t, q_s)`` float32 of a guide, up to a constant for each target point."""
    return (0.5 * (found.source**2).sum(axis=1)[None, :] - found.target @ found.source.T).astype(np.float32)
