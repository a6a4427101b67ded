"""What a map shows once coarse copies of both shapes are registered as it says: evidence that is not intrinsic.

A map that swaps front and back together with left and right keeps all distances and orientation. But the body that
follows it has to be turned inside out at its feet, hands and face, and has heels where the target has toes. So each
copy is bent onto the other as rigidly as possible (:mod:`kfmaps.registration.nonrigid_icp`). The energy that is left
and SHOT of the bent copy are compared between maps. SHOT of a large radius depends on the pose, so the body is bent
into the other's pose first; it is bent stiffly, so that its feet stay what they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import NotConverged, to_numpy
from kfmaps.descriptors.shot import shot
from kfmaps.fmap.nearest import nearest
from kfmaps.geometry.arap import arap_energy, arap_energy_per_vertex
from kfmaps.geometry.coarsen import CoarseProxy, coarse_proxy
from kfmaps.geometry.mesh import Mesh
from kfmaps.geometry.sampling import stratified_vertices
from kfmaps.registration.alternating_registration import FIT, ProxyPair, position_normals
from kfmaps.registration.nonrigid_icp import MeshPair, NonRigid
from kfmaps.shape import Shape

FINE_VERTICES = 3000
"""Vertices of a coarse copy for a second look where two maps are close."""
_QUICK, PATIENT = NonRigid(n_levels=2, steps=2, rotation_smoothing=0.0), NonRigid(n_levels=3, steps=3)
"""The fits of all candidates, and of those that are close."""
_MIN_ENERGY, _MAX_ENERGY = 1e-2, 10.0
"""Energies below which maps are alike, as of two meshes of one shape, and above which nothing is left of the shape."""
_MIN_FACES = 12  # faces below which there is nothing to bend


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Points of a surface: positions and normals (q, 6), and SHOT (q, 352)."""

    position_normals: np.ndarray
    descriptors: np.ndarray


@dataclass(frozen=True)
class DeformationEnergy:
    """How far both shapes must bend to follow a map; made by :func:`deform`."""

    # As-rigid-as-possible energy per area, the geometric mean of both directions: 0 for a motion; of one where the
    # other copy falls apart, 10 where both do.
    energy: float
    # Mean logarithm of the local energy per area: what is bent a little everywhere, as limbs that are turned front to
    # back, shows in it; the few places where two bodies differ most, which have most of the energy, hardly.
    strain: float


def coarse_copy(shape: Shape, vertices: int = 1200) -> CoarseProxy | None:
    """Return a coarse copy of a shape; ``None`` where it has no faces, or too few.

    ``vertices``: of the copy.
    """
    if len(shape.mesh.faces) < _MIN_FACES:
        return None
    n = len(shape.mesh.vertices)
    copy = coarse_proxy(shape.mesh, stratified_vertices(shape.basis, vertices, 0) if n > vertices else np.arange(n))
    return None if len(copy.mesh.faces) < _MIN_FACES else copy


def deform(C: np.ndarray, pair: ProxyPair, fit: NonRigid = _QUICK) -> DeformationEnergy:
    """Return how far each copy must bend to follow a functional map ``C (k_t, k_s)``."""
    forth, back = (_deform_one(fit, *way) for way in _point_maps(C, pair))
    if forth is None or back is None:
        # That a copy falls apart says nothing of the map.
        return forth or back or DeformationEnergy(_MAX_ENERGY, math.log(_MAX_ENERGY))
    return DeformationEnergy(math.sqrt(forth.energy * back.energy), (forth.strain + back.strain) / 2)


def registered_shot_error(C: np.ndarray, pair: ProxyPair) -> float | None:
    """Return the mean squared difference of SHOT, 0 to 2, of each copy bent onto the other as ``C (k_t, k_s)`` says.

    It is the mean of both directions, or that of one where the other copy falls apart; ``None`` where both do.
    """
    errors = [_bent_shot_error(*way) for way in _point_maps(C, pair)]
    known = [error for error in errors if error is not None]
    return sum(known) / len(known) if known else None


def _point_maps(C: np.ndarray, pair: ProxyPair) -> tuple[tuple[MeshPair, np.ndarray], tuple[MeshPair, np.ndarray]]:
    """Each copy and the other, with the vertex of the first for each of the second that ``C (k_t, k_s)`` says."""
    k_t, k_s = C.shape
    a, b = pair.copies
    images = to_numpy(pair.source.basis.functions)[a.vertices, :k_s] @ C.T
    rows = np.ascontiguousarray(to_numpy(pair.target.basis.functions)[b.vertices, :k_t])
    forth, back = (
        way.once((k_t, C.tobytes()), lambda places=places: nearest(*places))
        for way, places in ((pair.forth, (rows, images)), (pair.back, (images, rows)))
    )
    return (pair.forth, forth), (pair.back, back)


def _bent(fit: NonRigid, pair: MeshPair, points: np.ndarray) -> np.ndarray:
    """The first surface's vertices bent onto the second; candidates with the same map share the result."""
    return pair.once((fit, points.tobytes()), lambda: fit.bent(pair, points)[0])


def _deform_one(fit: NonRigid, pair: MeshPair, points: np.ndarray) -> DeformationEnergy | None:
    try:
        x = _bent(fit, pair, points)
    except NotConverged:
        return None
    energy, areas = pair.body.energy, np.maximum(pair.body.areas, 1e-12)
    # Local energies below 1e-3 count as none.
    local = np.log(np.maximum(arap_energy_per_vertex(energy, x) / areas, 1e-3))
    total = arap_energy(energy, x) / float(pair.body.areas.sum())
    strain = max(float(np.average(local, weights=areas)), math.log(_MIN_ENERGY))
    return DeformationEnergy(min(max(total, _MIN_ENERGY), _MAX_ENERGY), strain)


def _bent_shot_error(pair: MeshPair, points: np.ndarray) -> float | None:
    try:
        x = _bent(FIT, pair, points)
    except NotConverged:
        return None
    samples = pair.once("SHOT", lambda: _surface_samples(pair.target))
    return _shot_difference(samples, Mesh(x, pair.body.mesh.faces))


def _surface_samples(mesh: Mesh) -> SurfaceSamples:
    """Every few vertices of a ``mesh`` of unit area."""
    at = np.arange(0, len(mesh.vertices), 6)  # of a copy every so many vertices have SHOT
    return SurfaceSamples(position_normals(mesh)[at], _descriptors(mesh, at))


def _shot_difference(samples: SurfaceSamples, other: Mesh) -> float:
    """Mean squared difference of SHOT of ``samples`` and of the vertices of an ``other`` surface nearest to them."""
    near = np.asarray(KDTree(position_normals(other)).query(samples.position_normals)[1])
    return float(((samples.descriptors - _descriptors(other, near)) ** 2).sum(axis=1).mean())


def _descriptors(mesh: Mesh, at: np.ndarray) -> np.ndarray:
    return shot(mesh, 0.2, samples=5000, at=at)  # a foot or a head and what it sits on
