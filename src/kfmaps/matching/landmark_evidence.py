"""Landmarks as evidence: heat features around them guide refinements, and their errors count in scores.

A landmark may be wrong, so the cost of each is bounded. :mod:`kfmaps.matching.landmark_conflicts` rejects those that
the best map contradicts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra

from kfmaps._arrays import to_numpy
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.descriptor_guidance import DIMENSIONS, DescriptorGuidance, combine_guidance, descriptor_guidance
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesic_graph import bridged_graph
from kfmaps.matching.quality import ShapeSamples, sample_surface
from kfmaps.shape import Shape

_HEAT_TIMES = (0.004, 0.02, 0.1)
"""Diffusion times at unit area of the functions around a landmark: a hand, a limb, half of a body."""
LANDMARK_WEIGHT, LANDMARK_WEIGHT_UNLIKE = 1.0, 0.3
"""Weights of landmarks beside that of SHOT in the refinement on all vertices. The second is for unlike shapes, where
heat spreads differently from a landmark."""


@dataclass(frozen=True, eq=False)
class LandmarkEvidence:
    """Landmarks and the samples of both shapes."""

    target: np.ndarray  # (l, k): rows of the target's basis at its landmarks
    distances: np.ndarray  # (l, q_s): geodesic distances from the source's landmarks to its samples, in √area
    functions_s: np.ndarray  # (l, q_s, t): :func:`heat_features` of each landmark at the samples
    functions_t: np.ndarray

    def subsample(self, q_s: int, q_t: int) -> LandmarkEvidence:
        """Return the same at the first samples."""
        return LandmarkEvidence(
            self.target, self.distances[:, :q_s], self.functions_s[:, :q_s], self.functions_t[:, :q_t]
        )

    def without(self, rejected: np.ndarray) -> LandmarkEvidence:
        """Return the evidence without the landmarks that are ``rejected (l,)`` bool."""
        return LandmarkEvidence(*(getattr(self, name)[~rejected] for name in self.__dataclass_fields__))


def heat_features(points: Basis, basis: Basis, landmarks: np.ndarray) -> np.ndarray:
    """Return the normalized heat kernel between landmarks and points, (l, q, t), from about 0 to 1.

    ``h_t(p, x) / √(h_t(p, p) h_t(x, x))`` for the heat kernel h at three times: 1 at the landmark, and nearly
    independent of the pose and of the thickness of the body there.

    ``points``: the basis at the points; ``landmarks (l,)``: vertices of ``basis``.
    """
    values, phi = to_numpy(basis.eigenvalues), to_numpy(points.functions)
    at_landmarks = to_numpy(basis.functions)[landmarks]
    features = []
    for time in _HEAT_TIMES:
        decay = np.exp(-values * time)
        auto_l, auto_p = (at_landmarks**2) @ decay, (phi**2) @ decay
        features.append(((at_landmarks * decay) @ phi.T) / np.sqrt(np.maximum(np.outer(auto_l, auto_p), 1e-300)))
    return np.stack(features, axis=2)


def heat_guidance(functions_s: np.ndarray, functions_t: np.ndarray) -> DescriptorGuidance:
    """Return guidance by heat features ``(l, q, t)`` of both shapes; two random points differ by 1 on average."""
    flat = [np.moveaxis(f, 0, 1).reshape(f.shape[1], -1) for f in (functions_s, functions_t)]
    both = np.vstack(flat)
    centred = both - both.mean(axis=0)
    if centred.shape[1] > DIMENSIONS:
        centred = centred @ np.linalg.eigh(centred.T @ centred)[1][:, ::-1][:, :DIMENSIONS]
    centred = centred / np.sqrt(max(2 * (centred**2).sum(axis=1).mean(), 1e-12))
    return DescriptorGuidance(centred[: len(flat[0])], centred[len(flat[0]) :])


def landmark_distances(shape: Shape, samples: ShapeSamples, landmarks: np.ndarray) -> np.ndarray:
    """Return the geodesic distances (l, q) from ``landmarks (l,)``, vertices of ``shape``, to its samples, in √area.

    Separate components are as far apart as the farthest samples or landmarks.
    """
    vertices = samples.samples.vertices
    mesh, _, rows = sample_surface(shape, np.concatenate([vertices, landmarks]))
    distances = dijkstra(bridged_graph(mesh), indices=rows[len(vertices) :])[:, rows[: len(vertices)]]
    is_finite = np.isfinite(distances)
    farthest = distances[is_finite].max(initial=float(samples.distances.max()))
    return np.where(is_finite, distances, farthest)


def landmark_errors(C: np.ndarray, functions_s: np.ndarray, evidence: LandmarkEvidence) -> np.ndarray:
    """Return the distance of the image of each target landmark from the source's landmark, (l,), in √area.

    The other direction is less exact: a map damps the functions at the ends of limbs, so nothing is mapped to these.

    ``C (k_t, k_s)``; ``functions_s (q_s, k)``: the source's basis at its samples.
    """
    k_t, k_s = C.shape
    images = nearest(evidence.target[:, :k_t], functions_s[:, :k_s] @ C.T)
    return evidence.distances[np.arange(len(images)), images]


def build_guidance(
    source: Shape,
    target: Shape,
    landmarks: np.ndarray,
    limbs: DescriptorGuidance | None = None,
    shot: DescriptorGuidance | None = None,
    lead: float = LANDMARK_WEIGHT,
) -> DescriptorGuidance | None:
    """Return guidance by SHOT, extremities and landmarks on all vertices; ``None`` where there is none of these.

    ``landmarks (l, 2)``; ``limbs``: guidance by extremities; ``shot``: guidance by SHOT, if it has been computed;
    ``lead``: weight of the landmarks beside SHOT.
    """
    limb_weight = 0.8  # of extremities beside that of SHOT
    local = combine_guidance([(1.0, shot or descriptor_guidance(source.shot, target.shot)), (limb_weight, limbs)])
    if len(landmarks) == 0:
        return local
    heat = [heat_features(s.basis, s.basis, at) for s, at in zip((source, target), landmarks.T, strict=True)]
    return combine_guidance([(1.0, local), (lead, heat_guidance(*heat))])
