"""Bend the part onto the whole, as rigidly as possible, and find what the two have in common.

The loop is that of :mod:`kfmaps.registration.nonrigid_icp`, but only the part looks for closest points: what lies
beyond it on the whole must not pull. So it works for any cut, and the scale of the part follows from how long its edges
become. Landmarks pull as they pull whole shapes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from kfmaps.fmap.precise import PointMap
from kfmaps.geometry.arap import arap_energy, build_arap, rotations
from kfmaps.geometry.closest_points import ClosestPoints, closest_points
from kfmaps.geometry.coarsen import CoarseProxy, embedded_deformation
from kfmaps.geometry.connectivity import half_edges
from kfmaps.geometry.mesh import Mesh, boundary_vertices, surface_area, vertex_normals
from kfmaps.matching.partial.samples import PartPair, PartSurface
from kfmaps.registration.deformable import (
    DataTerm,
    DeformableMesh,
    LandmarkPull,
    closest_point_query,
    deformable_mesh,
    descend_levels,
    initial_deformation,
    landmark_pull,
)

_STIFFNESS = (2e-3, 6e-4, 2e-4, 6e-5, 2e-5)
"""Stiffness of the levels, in areas of the whole; a quick registration has the first three."""
_BEYOND = 0.01  # distance from an edge of the whole, in its √area, at which a point counts as lying beyond it
_OVERLAP_WIDTH = 0.02
"""Distance between the surfaces, in √area of the whole, at which a common point is as likely as not."""


@dataclass(frozen=True, eq=False)
class PartRegistration:
    """A part bent onto a whole, in its unit."""

    vertices: np.ndarray  # (n, 3)
    rest: Mesh  # the part at the scale that was found
    scale: float  # √area of the part over that of the whole
    places: ClosestPoints  # the closest point of the whole to each vertex
    inside: np.ndarray  # (n,): false where that is beyond an edge of the whole
    deformation_energy: float  # as-rigid-as-possible energy per area
    gap: float  # root of the mean squared distance from the whole
    flipped_area: float  # part of the area whose normals look elsewhere than the whole's
    edge_ratio: float  # how much longer than at rest edges are, by the median


def scale_mesh(mesh: Mesh, scale: float) -> Mesh:
    """Return ``mesh`` with all lengths times ``scale``."""
    return Mesh(mesh.vertices * scale, mesh.faces)


def register_part(
    pair: PartPair,
    scale: float,
    points: np.ndarray,
    normals: np.ndarray,
    trust: np.ndarray,
    quick: bool = False,
    progress: Callable[[float], None] = lambda _done: None,
) -> PartRegistration:
    """Bend the part onto the whole.

    ``scale``: √area of the part over that of the whole; ``points (q, 3)`` and ``normals (q, 3)``: where the part's
    samples begin, and the normals of the whole there; ``trust (q,)``: how much each counts; ``quick``: three levels of
    three steps, to compare candidates, instead of five of five; ``progress``: told about how much is done, from 0 to 1.
    """
    rest = deformable_mesh(scale_mesh(pair.part.mesh, scale), {})
    x = initial_deformation(rest, pair.part.samples, points, normals, rest.areas.sum() * trust / trust.sum())
    levels, steps = (_STIFFNESS[:3], 3) if quick else (_STIFFNESS, 5)
    pull = landmark_pull(rest, pair.part.landmarks, pair.whole.mesh.vertices[pair.whole.landmarks])
    return _bend(rest, x, scale, pair.whole, pull, levels, steps, progress)


def refine_registration(
    found: PartRegistration, copy: CoarseProxy, part: Mesh, whole: PartSurface, landmarks: np.ndarray
) -> PartRegistration:
    """Return the registration of a ``part`` that begins with that ``found`` for coarse copies of part and whole.

    ``copy``: that of the part; ``landmarks (l, 2)``: vertices of the part and of the whole.
    """
    rest, x = deformable_mesh(scale_mesh(part, found.scale)), found.vertices
    if len(x) < len(part.vertices):
        turns = rotations(build_arap(found.rest), x)
        x = embedded_deformation(replace(copy, mesh=found.rest), rest.mesh, x, turns)
    pull = landmark_pull(rest, landmarks[:, 0], whole.mesh.vertices[landmarks[:, 1]])
    return _bend(rest, x, found.scale, whole, pull, _STIFFNESS[-1:], 2, lambda _done: None)


def _bend(
    rest: DeformableMesh,
    x: np.ndarray,
    scale: float,
    whole: PartSurface,
    pull: LandmarkPull,
    levels: Sequence[float],
    steps: int,
    progress: Callable[[float], None],
) -> PartRegistration:
    """Return the part, ``rest``, bent onto the whole from where its vertices are, ``x (n, 3)``."""

    def terms(x: np.ndarray, stiffness: float) -> list[DataTerm]:
        found, there, agree = whole.surface(x, vertex_normals(Mesh(x, rest.mesh.faces)))
        closest = DataTerm(rest.areas * (agree * _is_inside(found, whole)), found.points, None, there)
        return [closest, *pull.terms(x, stiffness)]

    def turns(x: np.ndarray) -> np.ndarray:
        return rotations(rest.energy, x)

    x = descend_levels(rest, x, levels, steps, 1.0, terms, turns, progress)
    return _measure_registration(x, rest, scale, whole)


def _measure_registration(x: np.ndarray, body: DeformableMesh, scale: float, whole: PartSurface) -> PartRegistration:
    """Return what a part, ``body`` at rest, shows with its vertices at ``x (n, 3)``."""
    rest, areas = body.mesh, body.areas
    found = closest_points(x, whole.mesh.vertices, whole.mesh.faces)
    there = whole.surface.normals[whole.mesh.faces[found.faces]].mean(axis=1)
    cosine = np.einsum("ij,ij->i", vertex_normals(Mesh(x, rest.faces)), there)
    ends = half_edges(rest.faces)
    before, after = (np.linalg.norm(y[ends[:, 0]] - y[ends[:, 1]], axis=1) for y in (rest.vertices, x))
    longer = np.divide(after, before, out=np.ones_like(after), where=before > 0)
    inside = _is_inside(found, whole)
    on = areas * inside
    return PartRegistration(
        x,
        rest,
        scale,
        found,
        inside,
        arap_energy(body.energy, x) / float(surface_area(rest)),
        float(np.sqrt(np.average(found.distances**2, weights=on))) if on.any() else 1.0,
        float(areas[cosine < 0.3].sum() / areas.sum()),
        float(np.median(longer)),
    )


def _is_inside(found: ClosestPoints, whole: PartSurface) -> np.ndarray:
    """Return which places (q,) are no points of the whole's boundary that something beyond it is nearest to."""
    return ~(_at_boundary(found, whole.mesh.faces, whole.on_boundary) & (found.distances > _BEYOND))


def _at_boundary(found: ClosestPoints, faces: np.ndarray, on_boundary: np.ndarray) -> np.ndarray:
    """Which places (q,) on ``faces (m, 3)`` lie on an edge between vertices that are ``on_boundary (n,)``."""
    counts = found.weights > 1e-9
    return np.asarray((on_boundary[faces[found.faces]] | ~counts).all(axis=1) & ~counts.all(axis=1))


@dataclass(frozen=True, eq=False)
class Overlap:
    """What a part and a whole have in common, by vertices, and where each lies on the other shape."""

    part: np.ndarray  # (n_p,): probability to be on both
    whole: np.ndarray  # (n_w,)
    on_whole: PointMap  # for each vertex of the part
    on_part: PointMap  # for each vertex of the whole; means something only where ``whole`` is above a half


def overlap_probability(
    bent: Mesh, on_boundary: np.ndarray, whole: Mesh, normals: np.ndarray | None = None
) -> tuple[np.ndarray, ClosestPoints]:
    """Return how likely each vertex of a whole lies on a bent part, and the closest place on it.

    ``bent``: in the unit of the whole; ``on_boundary (n_p,)``: its vertices on the boundary; ``whole``: at unit area;
    ``normals (n_w, 3)``: of the whole's vertices, where they are known. Returns ``probability (n_w,)``; ``places``.
    """
    found, _, agree = closest_point_query(bent)(whole.vertices, vertex_normals(whole) if normals is None else normals)
    # Beyond the part's edge the closest point lies on it: half the length of its edges is as near as vertices can tell.
    corners = bent.vertices[bent.faces[found.faces]]
    half = 0.5 * np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean(axis=1)
    edge = _at_boundary(found, bent.faces, on_boundary)
    width = np.where(edge, np.minimum(half, _OVERLAP_WIDTH), _OVERLAP_WIDTH)
    return _half_at(found.distances, width) * np.where(agree > 0, 1.0, 0.25), found


def find_overlap(bent: PartRegistration, whole: PartSurface) -> Overlap:
    """Return what a registered part and the whole have in common."""
    mesh = Mesh(bent.vertices, bent.rest.faces)
    common, found = overlap_probability(mesh, boundary_vertices(bent.rest), whole.mesh, whole.surface.normals)
    own = np.where(bent.inside, _half_at(bent.places.distances, _OVERLAP_WIDTH), 0.0)
    return Overlap(own, common, *(PointMap(places.faces, places.weights) for places in (bent.places, found)))


def _half_at(distances: np.ndarray, width: np.ndarray | float) -> np.ndarray:
    """1 at no distance, a half at ``width``."""
    return np.exp2(-((distances / np.maximum(width, 1e-12)) ** 2))
