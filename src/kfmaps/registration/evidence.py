"""Extrinsic evidence about a map: registrations of coarse proxies of both shapes that begin with it.

A map that swaps front and back together with left and right keeps all distances and orientation. But a body that
follows it is turned inside out at its feet, hands and face, and has heels where the target has toes. So each proxy is
registered onto the other as rigidly as possible (:mod:`kfmaps.registration.nonrigid_icp`), and maps are compared by the
remaining energy and by SHOT after the registration. SHOT of a large radius depends on the pose, which the registration
removes. It is stiff, so that details such as feet are kept.
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
"""Vertices of the finer proxies on which two maps of similar scores are compared."""
_QUICK, PATIENT = NonRigid(n_levels=2, steps=2, rotation_smoothing=0.0), NonRigid(n_levels=3, steps=3)
"""The registrations of all candidates, and of those with similar scores."""
MIN_ENERGY, _MAX_ENERGY = 1e-2, 10.0
"""Energies are clipped to these: below, two meshes of one shape differ; above, nothing is left of the shape."""


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Points of a surface: positions and normals (q, 6), and SHOT (q, 352)."""

    position_normals: np.ndarray
    descriptors: np.ndarray


@dataclass(frozen=True)
class DeformationEnergy:
    """How much both shapes are deformed to follow a map; made by :func:`deform`."""

    energy: float  # as-rigid-as-possible energy per area, geometric mean of both directions: 0 for a rigid motion
    # Mean logarithm of the local energy per area. It shows small deformations everywhere, as of limbs that are turned
    # front to back, rather than the few places with most of the energy, where two bodies differ most.
    strain: float


def shape_proxy(shape: Shape, vertices: int = 1200) -> CoarseProxy | None:
    """Return a coarse proxy of a shape with about so many ``vertices``; ``None`` where it has too few faces."""
    min_faces = 12  # faces that a proxy must have
    if len(shape.mesh.faces) < min_faces:
        return None
    n = len(shape.mesh.vertices)
    proxy = coarse_proxy(shape.mesh, stratified_vertices(shape.basis, vertices, 0) if n > vertices else np.arange(n))
    return None if len(proxy.mesh.faces) < min_faces else proxy


def deform(C: np.ndarray, pair: ProxyPair, fit: NonRigid = _QUICK) -> DeformationEnergy:
    """Return how much the proxies are deformed to follow a functional map ``C (k_t, k_s)``."""
    forth, back = (_deform_one(fit, *direction) for direction in _point_maps(C, pair))
    if forth is None or back is None:
        # A proxy that falls apart says nothing about the map.
        return forth or back or DeformationEnergy(_MAX_ENERGY, math.log(_MAX_ENERGY))
    return DeformationEnergy(math.sqrt(forth.energy * back.energy), (forth.strain + back.strain) / 2)


def registered_shot_error(C: np.ndarray, pair: ProxyPair) -> float | None:
    """Return the mean squared difference of SHOT, 0 to 2, of proxies registered by a functional map ``C (k_t, k_s)``.

    It is the mean of both directions, without one where the proxy falls apart; ``None`` where both do.
    """
    errors = [_registered_shot_error(*direction) for direction in _point_maps(C, pair)]
    finite = [error for error in errors if error is not None]
    return sum(finite) / len(finite) if finite else None


def _point_maps(C: np.ndarray, pair: ProxyPair) -> tuple[tuple[MeshPair, np.ndarray], tuple[MeshPair, np.ndarray]]:
    """Return the pair of meshes and the point map of ``C (k_t, k_s)`` between the proxies, for both directions."""
    k_t, k_s = C.shape
    a, b = pair.proxies
    images = to_numpy(pair.source.basis.functions)[a.vertices, :k_s] @ C.T
    rows = np.ascontiguousarray(to_numpy(pair.target.basis.functions)[b.vertices, :k_t])
    key = (k_t, C.tobytes())
    forth = pair.forth.once(key, lambda: nearest(rows, images))
    back = pair.back.once(key, lambda: nearest(images, rows))
    return (pair.forth, forth), (pair.back, back)


def _registered(fit: NonRigid, pair: MeshPair, points: np.ndarray) -> np.ndarray:
    """Return the registered vertices of the source; candidates with the same map share them."""
    return pair.once((fit, points.tobytes()), lambda: fit.register_vertices(pair, points)[0])


def _deform_one(fit: NonRigid, pair: MeshPair, points: np.ndarray) -> DeformationEnergy | None:
    try:
        x = _registered(fit, pair, points)
    except NotConverged:
        return None
    energy, areas = pair.body.energy, np.maximum(pair.body.areas, 1e-12)
    # Local energies are at least 1e-3.
    local = np.log(np.maximum(arap_energy_per_vertex(energy, x) / areas, 1e-3))
    total = arap_energy(energy, x) / float(pair.body.areas.sum())
    strain = max(float(np.average(local, weights=areas)), math.log(MIN_ENERGY))
    return DeformationEnergy(min(max(total, MIN_ENERGY), _MAX_ENERGY), strain)


def _registered_shot_error(pair: MeshPair, points: np.ndarray) -> float | None:
    try:
        x = _registered(FIT, pair, points)
    except NotConverged:
        return None
    samples = pair.once("SHOT", lambda: _surface_samples(pair.target))
    return _shot_difference(samples, Mesh(x, pair.body.mesh.faces))


def _surface_samples(mesh: Mesh) -> SurfaceSamples:
    """Return every sixth vertex of a ``mesh`` of unit area as samples."""
    at = np.arange(0, len(mesh.vertices), 6)
    return SurfaceSamples(position_normals(mesh)[at], _descriptors(mesh, at))


def _shot_difference(samples: SurfaceSamples, other: Mesh) -> float:
    """Return the mean squared difference of SHOT between ``samples`` and the nearest vertices of ``other``."""
    nearest_vertices = np.asarray(KDTree(position_normals(other)).query(samples.position_normals)[1])
    return float(((samples.descriptors - _descriptors(other, nearest_vertices)) ** 2).sum(axis=1).mean())


def _descriptors(mesh: Mesh, at: np.ndarray) -> np.ndarray:
    return shot(mesh, 0.2, samples=5000, at=at)  # the radius covers a foot or a head and what is next to it
