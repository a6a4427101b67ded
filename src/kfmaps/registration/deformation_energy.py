"""How far the source has to bend to take the target's shape as a map says: evidence that is not intrinsic.

A map that swaps front and back together with left and right keeps all distances and orientation. Only, the body that
follows it has to be turned inside out at its feet, hands and face. So the source is bent onto the target as rigidly as
possible (:mod:`kfmaps.registration.nonrigid_icp`), both in coarse copies, and the energy left is compared between maps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import NotConverged, to_numpy
from kfmaps.fmap.convert import nearest
from kfmaps.geometry.arap import arap_energy as whole_energy
from kfmaps.geometry.arap import arap_energy_per_vertex
from kfmaps.geometry.coarsen import CoarseProxy, coarse_proxy
from kfmaps.geometry.sampling import stratified_vertices
from kfmaps.registration.deformable import closest_point_query, deformable_mesh
from kfmaps.registration.nonrigid_icp import MeshPair, NonRigid, mesh_pair
from kfmaps.shape import Shape

MORE = 3000
"""Vertices of a coarse copy for a second look where two maps are close."""
_MIN_FACES = 12
"""Faces below which there is nothing to bend."""
_FIT, LONGER = NonRigid(n_levels=2, steps=2, rotation_smoothing=0.0), NonRigid(n_levels=3, steps=3)
"""The fits of both."""
_MIN_ENERGY, _MAX_ENERGY = 1e-2, 10.0
"""Energies below which maps are alike, as of two meshes of one shape, and above which nothing is left of the shape."""


def coarse_copy(shape: Shape, points: int = 1200) -> CoarseProxy | None:
    """A coarse copy of a shape with so many ``points``; ``None`` where it has no faces, or too few."""
    if len(shape.mesh.faces) < _MIN_FACES:
        return None
    n = len(shape.mesh.vertices)
    copy = coarse_proxy(shape.mesh, stratified_vertices(shape.basis, points, 0) if n > points else np.arange(n))
    return None if len(copy.mesh.faces) < _MIN_FACES else copy


@dataclass(frozen=True)
class DeformationEnergy:
    """How far both shapes must bend to follow a map; made by :func:`deform`.

    Attributes
    ----------
    bending : float
        As-rigid-as-possible energy per area, the geometric mean of both directions: 0 for a motion; of one where the
        other copy falls apart, 10 where both do.
    strain : float
        Mean logarithm of the local energy per area: what is bent a little everywhere, as limbs that are turned front to
        back, shows in it; the few places where two bodies differ most, which have most of the energy, hardly.
    """

    energy: float
    strain: float


@dataclass(frozen=True, eq=False)
class FacingPair:
    """Two copies at rest and looked at, so that what depends on no map is found once; made by :func:`facing_pair`."""

    copies: tuple[CoarseProxy, CoarseProxy]
    there: MeshPair
    back: MeshPair


def facing_pair(a: CoarseProxy, b: CoarseProxy) -> FacingPair:
    """Copies of two shapes ready to be bent onto each other as several maps say."""
    bodies = [deformable_mesh(copy.mesh, {}) for copy in (a, b)]
    looks = [closest_point_query(body.mesh, around=body.around) for body in bodies]
    return FacingPair((a, b), mesh_pair(bodies[0], b.mesh, looks[1]), mesh_pair(bodies[1], a.mesh, looks[0]))


def map_samples(C: np.ndarray, source: Shape, target: Shape, on: FacingPair) -> tuple[tuple[MeshPair, np.ndarray], ...]:
    """Each copy and the other, with the point of the first for each of the second that ``C (k_t, k_s)`` says."""
    k_t, k_s = C.shape
    a, b = on.copies
    images = to_numpy(source.basis.functions)[a.vertices, :k_s] @ C.T
    rows = np.ascontiguousarray(to_numpy(target.basis.functions)[b.vertices, :k_t])
    return (on.there, nearest(rows, images, threads=1)), (on.back, nearest(images, rows, threads=1))


def deform(C: np.ndarray, source: Shape, target: Shape, on: FacingPair, fit: NonRigid = _FIT) -> DeformationEnergy:
    """Each shape bent onto the other as ``C (k_t, k_s)`` says."""
    there, back = (_bent(fit, *way) for way in map_samples(C, source, target, on))
    if there is None or back is None:
        # That a copy falls apart says nothing of the map.
        return there or back or DeformationEnergy(_MAX_ENERGY, math.log(_MAX_ENERGY))
    return DeformationEnergy(math.sqrt(there.energy * back.energy), (there.strain + back.strain) / 2)


def deformation_energy(C: np.ndarray, source: Shape, target: Shape, on: FacingPair, fit: NonRigid = _FIT) -> float:
    """:attr:`Bent.energy` alone."""
    return deform(C, source, target, on, fit).energy


def _bent(fit: NonRigid, pair: MeshPair, points: np.ndarray) -> DeformationEnergy | None:
    try:
        x, _ = fit.bent(pair, points)
    except NotConverged:
        return None
    energy, sizes = pair.body.energy, pair.body.areas
    areas = np.maximum(sizes, 1e-12)
    # Local energies below 1e-3 count as none.
    dense = np.log(np.maximum(arap_energy_per_vertex(energy, x) / areas, 1e-3))
    whole = whole_energy(energy, x) / float(sizes.sum())
    return DeformationEnergy(
        min(max(whole, _MIN_ENERGY), _MAX_ENERGY), max(float(np.average(dense, weights=areas)), math.log(_MIN_ENERGY))
    )
