"""Whether the source looks like the target once it is bent onto it: evidence that tells front from back.

A map that swaps front and back together with left and right bends a body almost as little as the right one. Only, it
then has heels where the target has toes. SHOT of a small radius sees little of that, and of a large one it depends on
the pose; of a body that has been bent into the other's pose, stiffly, so that its feet stay what they are, it does not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import NotConverged
from kfmaps.descriptors.shot import shot
from kfmaps.geometry.mesh import Mesh
from kfmaps.registration.alternating_registration import FIT, position_normals
from kfmaps.registration.deformation_energy import FacingPair, map_samples
from kfmaps.registration.nonrigid_icp import MeshPair
from kfmaps.shape import Shape

_SAMPLE_STEP = 6
"""Of the copy at rest every so many vertices are looked at."""


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Where some points of a surface are, (q, 6) positions and normals, and how it looks from there, (q, 352) SHOT."""

    places: np.ndarray
    descriptors: np.ndarray


def _surface_samples(mesh: Mesh) -> SurfaceSamples:
    """Of every few vertices of a ``mesh`` of unit area."""
    at = np.arange(0, len(mesh.vertices), _SAMPLE_STEP)
    return SurfaceSamples(position_normals(mesh)[at], _descriptors(mesh, at))


def _shot_difference(seen: SurfaceSamples, other: Mesh) -> float:
    """Mean squared difference of SHOT, from 0 to 2, from that of an ``other`` surface in the same place.

    Each point is compared with the vertex that lies nearest; the points of a copy are spread evenly and count alike.
    """
    near = np.asarray(KDTree(position_normals(other)).query(seen.places)[1])
    return float(((seen.descriptors - _descriptors(other, near)) ** 2).sum(axis=1).mean())


def _descriptors(mesh: Mesh, at: np.ndarray) -> np.ndarray:
    return shot(mesh, 0.2, samples=5000, at=at, threads=1)  # a foot or a head and what it sits on


@dataclass(frozen=True, eq=False)
class ShotPair:
    """The copies of two shapes, ready to be bent, and how they look at rest; made by :func:`shot_pair`."""

    on: FacingPair
    seen: tuple[SurfaceSamples, SurfaceSamples]


def shot_pair(on: FacingPair) -> ShotPair:
    """Of copies of two shapes."""
    return ShotPair(on, (_surface_samples(on.copies[0].mesh), _surface_samples(on.copies[1].mesh)))


def registered_shot_error(C: np.ndarray, source: Shape, target: Shape, of: ShotPair) -> float | None:
    """:func:`_shot_difference` of each copy, bent onto the other as ``C (k_t, k_s)`` says; the mean of both directions.

    Of one where the other falls apart, ``None`` where both do.
    """
    there, back = map_samples(C, source, target, of.on)
    found = [_mismatch(*there, of.seen[1]), _mismatch(*back, of.seen[0])]
    known = [value for value in found if value is not None]
    return sum(known) / len(known) if known else None


def _mismatch(pair: MeshPair, points: np.ndarray, seen: SurfaceSamples) -> float | None:
    try:
        x, _ = FIT.bent(pair, points)
    except NotConverged:
        return None
    return _shot_difference(seen, Mesh(x, pair.body.mesh.faces))
