"""Landmarks as evidence: they steer candidates, rank them, and are themselves judged by the best.

A landmark may be wrong, so none is obeyed blindly: what each can cost a map is bounded, and those that the best map
contradicts while it keeps to most of the others are named and left out of the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import to_numpy
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.descriptor_guidance import DIMENSIONS, DescriptorGuidance, combine_guidance, descriptor_guidance
from kfmaps.geometry.basis import Basis
from kfmaps.shape import Shape

_HEAT_TIMES = (0.004, 0.02, 0.1)
"""Diffusion times at unit area of the functions around a landmark: a hand, a limb, half of a body."""
LANDMARK_WEIGHT, LANDMARK_WEIGHT_UNLIKE = 1.0, 0.3
"""Weight of landmarks beside that of SHOT in the refinement on all vertices, and between shapes that differ much, where
heat spreads otherwise from a landmark."""


@dataclass(frozen=True, eq=False)
class LandmarkEvidence:
    """What landmarks say at the samples of both shapes."""

    target: np.ndarray  # (l, k): rows of the target's basis at its landmarks
    # (l, q_s): from each of the source's landmarks to its samples along the surface, in units of √area.
    distances: np.ndarray
    functions_s: np.ndarray  # (l, q_s, t): functions around each landmark at the samples, see :func:`heat_features`
    functions_t: np.ndarray

    def subsample(self, q_s: int, q_t: int) -> LandmarkEvidence:
        """Return the same at the first samples."""
        return LandmarkEvidence(
            self.target, self.distances[:, :q_s], self.functions_s[:, :q_s], self.functions_t[:, :q_t]
        )

    def without(self, doubted: np.ndarray) -> LandmarkEvidence:
        """Return the evidence without the landmarks that are ``doubted (l,)`` bool."""
        kept = ~doubted
        return LandmarkEvidence(*(getattr(self, name)[kept] for name in self.__dataclass_fields__))


def heat_features(points: Basis, basis: Basis, landmarks: np.ndarray) -> np.ndarray:
    """Return the correlation of heat from landmarks with heat from points, (l, q, t), from about 0 to 1.

    ``h_t(p, x) / √(h_t(p, p) h_t(x, x))`` for the heat kernel h at three times: 1 at the landmark, nearly free of pose
    and of how thick the body is there.

    ``points``: at some of the points of ``basis``; ``landmarks (l,)``: vertices of ``basis``.
    """
    values, phi = to_numpy(basis.eigenvalues), to_numpy(points.functions)
    here = to_numpy(basis.functions)[landmarks]
    found = []
    for time in _HEAT_TIMES:
        decay = np.exp(-values * time)
        own, theirs = (here**2) @ decay, (phi**2) @ decay
        found.append(((here * decay) @ phi.T) / np.sqrt(np.maximum(np.outer(own, theirs), 1e-300)))
    return np.stack(found, axis=2)


def heat_guidance(functions_s: np.ndarray, functions_t: np.ndarray) -> DescriptorGuidance:
    """Return guidance by functions ``(l, q, t)`` around landmarks; two random points differ by 1 on average."""
    flat = [np.moveaxis(f, 0, 1).reshape(f.shape[1], -1) for f in (functions_s, functions_t)]
    both = np.vstack(flat)
    centred = both - both.mean(axis=0)
    if centred.shape[1] > DIMENSIONS:
        centred = centred @ np.linalg.eigh(centred.T @ centred)[1][:, ::-1][:, :DIMENSIONS]
    centred = centred / np.sqrt(max(2 * (centred**2).sum(axis=1).mean(), 1e-12))
    return DescriptorGuidance(centred[: len(flat[0])], centred[len(flat[0]) :])


def landmark_errors(C: np.ndarray, functions_s: np.ndarray, found: LandmarkEvidence) -> np.ndarray:
    """Return how far the image of each target landmark is from the source's, (l,), in units of √area.

    The other direction says less: the ends of limbs, whose functions a map damps, have no image of their own there.

    ``C (k_t, k_s)``; ``functions_s (q_s, k)``: the source's basis at its samples.
    """
    k_t, k_s = C.shape
    back = nearest(found.target[:, :k_t], functions_s[:, :k_s] @ C.T)
    return found.distances[np.arange(len(back)), back]


def build_guidance(
    source: Shape,
    target: Shape,
    landmarks: np.ndarray,
    limbs: DescriptorGuidance | None = None,
    shot: DescriptorGuidance | None = None,
    lead: float = LANDMARK_WEIGHT,
) -> DescriptorGuidance | None:
    """Return guidance by SHOT, landmarks and limbs on all vertices, for the refinement; ``None`` where there is none.

    ``landmarks (l, 2)``; ``limbs``: by extremities; ``shot``: by SHOT, where it is known; ``lead``: weight of the
    landmarks beside SHOT.
    """
    local = combine_guidance([(1.0, shot or descriptor_guidance(source.shot, target.shot)), (0.8, limbs)])
    if len(landmarks) == 0:
        return local
    functions = [heat_features(s.basis, s.basis, at) for s, at in zip((source, target), landmarks.T, strict=True)]
    return combine_guidance([(1.0, local), (lead, heat_guidance(*functions))])
