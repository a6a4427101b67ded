"""How far the source has to bend to take the target's shape as a map says: evidence that is not intrinsic.

A map that swaps front and back together with left and right keeps all distances and orientation. Only, the body that
follows it has to be turned inside out at its feet, hands and face. So the source is bent onto the target as rigidly as
possible (:mod:`kfmaps.registration.nonrigid_icp`), both in coarse copies, and the energy left is compared between maps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from kfmaps._arrays import NotConverged, to_numpy
from kfmaps.fmap.convert import nearest
from kfmaps.geometry.arap import bending as whole_energy
from kfmaps.geometry.arap import local
from kfmaps.geometry.coarsen import coarse
from kfmaps.geometry.mesh import Mesh, mirrored
from kfmaps.geometry.sampling import stratified_vertices
from kfmaps.registration.deformable import body_of, look
from kfmaps.registration.nonrigid_icp import Facing, NonRigid, facing
from kfmaps.shape import Shape

POINTS, MORE = 1200, 3000
"""Vertices of a coarse copy, and of one for a second look where two maps are close."""
FEWEST = 12
"""Faces below which there is nothing to bend."""
FIT, LONGER = NonRigid(levels=2, steps=2, evenness=0.0), NonRigid(levels=3, steps=3)
"""The fits of both."""
LEAST, MOST = 1e-2, 10.0
"""Energies below which maps are alike, as of two meshes of one shape, and above which nothing is left of the shape."""
STILL = 1e-3
"""Local energy that counts as none."""

TINY = 1e-12
"""Area of a vertex that has none."""


@dataclass(frozen=True, eq=False)
class Copy:
    """A coarse copy of a shape; made by :func:`copied`.

    Attributes
    ----------
    mesh : Mesh
    vertices : (q,) int64
        The shape's vertex of each of its vertices.
    """

    mesh: Mesh
    vertices: np.ndarray

    def mirrored(self) -> Copy:
        """Of the mirror image."""
        return replace(self, mesh=mirrored(self.mesh))


def copied(shape: Shape, points: int = POINTS) -> Copy | None:
    """A coarse copy of a shape with so many ``points``; ``None`` where it has no faces, or too few."""
    if len(shape.mesh.faces) < FEWEST:
        return None
    vertices = np.arange(len(shape.mesh.vertices))
    mesh = shape.mesh
    if len(vertices) > points:
        vertices = stratified_vertices(shape.basis, points, 0)
        mesh = coarse(shape.mesh, vertices)
    # Thin parts may lose their faces, and a point that no face uses bends with nothing.
    used = np.unique(mesh.faces)
    if len(mesh.faces) < FEWEST:
        return None
    number = np.full(len(vertices), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return Copy(Mesh(mesh.vertices[used], number[mesh.faces]), vertices[used])


@dataclass(frozen=True)
class Bent:
    """How far both shapes must bend to follow a map; made by :func:`bent`.

    Attributes
    ----------
    bending : float
        As-rigid-as-possible energy per area, the geometric mean of both directions: 0 for a motion; of one where
        the other copy falls apart, :data:`MOST` where both do.
    strain : float
        Mean logarithm of the local energy per area: what is bent a little everywhere, as limbs that are turned front to
        back, shows in it; the few places where two bodies differ most, which have most of the energy, hardly.
    """

    bending: float
    strain: float


@dataclass(frozen=True, eq=False)
class Ready:
    """Two copies at rest and looked at, so that what depends on no map is found once; made by :func:`ready`."""

    copies: tuple[Copy, Copy]
    there: Facing
    back: Facing


def ready(a: Copy, b: Copy) -> Ready:
    """Copies of two shapes ready to be bent onto each other as several maps say."""
    bodies = [body_of(copy.mesh, {}) for copy in (a, b)]
    looks = [look(body.mesh, around=body.around) for body in bodies]
    return Ready((a, b), facing(bodies[0], b.mesh, looks[1]), facing(bodies[1], a.mesh, looks[0]))


def ways(C: np.ndarray, source: Shape, target: Shape, on: Ready) -> tuple[tuple[Facing, np.ndarray], ...]:
    """Each copy and the other, with the point of the first for each of the second that ``C (k_t, k_s)`` says."""
    k_t, k_s = C.shape
    a, b = on.copies
    images = to_numpy(source.basis.functions)[a.vertices, :k_s] @ C.T
    rows = np.ascontiguousarray(to_numpy(target.basis.functions)[b.vertices, :k_t])
    return (on.there, nearest(rows, images, threads=1)), (on.back, nearest(images, rows, threads=1))


def bent(C: np.ndarray, source: Shape, target: Shape, on: Ready, fit: NonRigid = FIT) -> Bent:
    """Each shape bent onto the other as ``C (k_t, k_s)`` says."""
    there, back = (_bent(fit, *way) for way in ways(C, source, target, on))
    if there is None or back is None:
        # That a copy falls apart says nothing of the map.
        return there or back or Bent(MOST, math.log(MOST))
    return Bent(math.sqrt(there.bending * back.bending), (there.strain + back.strain) / 2)


def bending(C: np.ndarray, source: Shape, target: Shape, on: Ready, fit: NonRigid = FIT) -> float:
    """:attr:`Bent.bending` alone."""
    return bent(C, source, target, on, fit).bending


def _bent(fit: NonRigid, pair: Facing, points: np.ndarray) -> Bent | None:
    try:
        x, _ = fit.bent(pair, points)
    except NotConverged:
        return None
    energy, sizes = pair.body.energy, pair.body.areas
    areas = np.maximum(sizes, TINY)
    dense = np.log(np.maximum(local(energy, x) / areas, STILL))
    whole = whole_energy(energy, x) / float(sizes.sum())
    return Bent(min(max(whole, LEAST), MOST), max(float(np.average(dense, weights=areas)), math.log(LEAST)))
