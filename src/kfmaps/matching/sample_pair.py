"""Samples of both shapes and the costs of matching them: what the candidates of a pair are made and scored with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, descriptor_guidance
from kfmaps.fmap.zoomout import pseudo_inverse
from kfmaps.matching.extremity_matching import ExtremityMatch, extremity_cost
from kfmaps.matching.landmark_evidence import LandmarkEvidence, heat_features, heat_guidance, landmark_distances
from kfmaps.matching.quality import ShapeSamples, mirror_samples, subsample
from kfmaps.matching.score import SCORE
from kfmaps.shape import Shape

CostWeights = tuple[float, ...]
"""Weights of the costs of SHOT, of landmarks and, where given, of extremities."""
STRONG: CostWeights = (12.0, 12.0)
EXTREMITY_FUNCTIONS = 12
"""Functions of the initial map of an extremity match."""
COARSE_SAMPLES = 400
"""Samples of the coarse refinement: the first of those of the fine one."""


@dataclass(frozen=True, eq=False)
class SamplePair:
    """Samples of both shapes and the costs of matching them; made by :func:`build_sample_pair`."""

    source: ShapeSamples
    target: ShapeSamples
    descriptor_cost: np.ndarray | None  # (q_t, q_s): see :func:`descriptor_cost`; ``None`` where SHOT says nothing
    landmark_cost: np.ndarray | None = None  # (q_t, q_s): the same of the functions around landmarks
    landmark_evidence: LandmarkEvidence | None = None
    solvers: dict[int, np.ndarray] = field(default_factory=dict)  # what :meth:`solver` has made, to be found again

    @property
    def are_surfaces(self) -> bool:
        """Whether both shapes are surfaces, which have an orientation, and no point clouds."""
        return self.source.orientation is not None and self.target.orientation is not None

    @property
    def has_rotation(self) -> bool:
        """Whether a self-map rotates one of the shapes as a whole, as half a turn does a table."""
        return self.source.has_rotation or self.target.has_rotation

    @property
    def has_one_reflection(self) -> bool:
        """Whether one shape at least is nearly its own mirror image in one way alone, so that no rotation keeps it."""
        is_found = self.source.reflection_map is not None or self.target.reflection_map is not None
        return is_found and not self.has_rotation

    @property
    def margin_factor(self) -> float:
        """Factor of margins in score: less than 1 where a rotation may keep both shapes, as that of a table.

        They have self-maps, but no single reflection.
        """
        are_symmetric = all(side.self_maps is not None and len(side.self_maps) for side in (self.source, self.target))
        return SCORE.rotation_margin if are_symmetric and not self.has_one_reflection else 1.0

    def solver(self, k: int) -> np.ndarray:
        """Return :func:`kfmaps.fmap.zoomout.pseudo_inverse` of the target, made once for all refinements."""
        if k not in self.solvers:
            self.solvers[k] = pseudo_inverse(self.target.samples.basis, k)
        return self.solvers[k]

    def matching_cost(
        self,
        descriptors: float,
        landmarks: float = 0.0,
        extremities: float = 0.0,
        matches: Sequence[ExtremityMatch | None] = (),
    ) -> np.ndarray | None:
        """Return the weighted sum of the costs, for :func:`kfmaps.fmap.zoomout.batched_zoomout`.

        ``descriptors``, ``landmarks`` and ``extremities``: weights; ``matches``: the extremities that each of m maps
        takes to each other. Returns (q_t, q_s): the latter where extremities count; ``None`` where nothing does.
        """
        total = None
        for weight, part in ((descriptors, self.descriptor_cost), (landmarks, self.landmark_cost)):
            if part is not None and weight:
                total = np.float32(weight) * part + (0 if total is None else total)
        if extremities and any(match is not None for match in matches):
            each = np.zeros((len(matches), len(self.target.positions), len(self.source.positions)), dtype=np.float32)
            if total is not None:
                each[:] = total
            for i, match in enumerate(matches):
                if match is not None:
                    each[i] += extremities * extremity_cost(self.source.extremities, self.target.extremities, match)
            total = each
        return total


@dataclass(frozen=True, eq=False)
class TwoLevelSamples:
    """Samples of two shapes at two levels."""

    coarse: SamplePair  # for many rough maps
    fine: SamplePair  # for the best of them


def two_level_samples(
    source: Shape, target: Shape, shape_samples: tuple[ShapeSamples, ShapeSamples], landmarks: np.ndarray | None = None
) -> TwoLevelSamples:
    """Return the samples of two prepared shapes at two levels.

    ``shape_samples``: the fine samples of both shapes; ``landmarks (l, 2)``: pairs "source vertex, target vertex".
    """
    evidence = None
    if landmarks is not None and len(landmarks):
        sides = zip((source, target), shape_samples, landmarks.T, strict=True)
        heat = [heat_features(p.samples.basis, shape.basis, at) for shape, p, at in sides]
        distances = landmark_distances(source, shape_samples[0], landmarks[:, 0])
        evidence = LandmarkEvidence(target.basis.functions[landmarks[:, 1]], distances, *heat)
    coarse = subsample(shape_samples[0], COARSE_SAMPLES), subsample(shape_samples[1], COARSE_SAMPLES)
    subsampled = evidence and evidence.subsample(*(len(p.samples.vertices) for p in coarse))
    return TwoLevelSamples(build_sample_pair(*coarse, subsampled), build_sample_pair(*shape_samples, evidence))


def build_sample_pair(
    source: ShapeSamples, target: ShapeSamples, evidence: LandmarkEvidence | None = None
) -> SamplePair:
    """Return the samples of two shapes with their costs, and with those of landmarks where there are any."""
    shot = descriptor_guidance(source.descriptors, target.descriptors)
    landmarks = evidence and heat_guidance(evidence.functions_s, evidence.functions_t)
    return SamplePair(
        source, target, shot and descriptor_cost(shot), landmarks and descriptor_cost(landmarks), evidence
    )


def drop_landmarks(samples: TwoLevelSamples, rejected: np.ndarray) -> TwoLevelSamples:
    """Return the samples without the landmarks that are ``rejected (l,)`` bool."""

    def without(pair: SamplePair) -> SamplePair:
        evidence = pair.landmark_evidence if pair.landmark_evidence and not rejected.all() else None
        return build_sample_pair(pair.source, pair.target, evidence and evidence.without(rejected))

    return TwoLevelSamples(without(samples.coarse), without(samples.fine))


def mirrored_pair(pair: SamplePair) -> SamplePair:
    """Return the pair with the target's mirror image."""
    return build_sample_pair(pair.source, mirror_samples(pair.target), pair.landmark_evidence)


def descriptor_cost(guidance: DescriptorGuidance) -> np.ndarray:
    """Return half the squared differences ``(q_t, q_s)`` float32 of guidance, up to a constant of each target point."""
    source, target = guidance.source, guidance.target
    return (0.5 * (source**2).sum(axis=1)[None, :] - target @ source.T).astype(np.float32)


def paired_map(match: ExtremityMatch, pair: SamplePair, k: int) -> np.ndarray:
    """Return the functional map (k, k) of the sample pairs with the least cost by a match of extremities."""
    cost = extremity_cost(pair.source.extremities, pair.target.extremities, match, pair.descriptor_cost)
    return np.asarray(pair.solver(k) @ pair.source.samples.basis.functions[cost.argmin(axis=1), :k], float)
