"""Register a part onto a whole, as rigidly as possible, and find their overlap.

The iterations are those of :mod:`kfmaps.registration.nonrigid_icp`, but only the part has closest points: the rest of
the whole must not attract it. So any cut will do, and the scale of the part follows from the lengths of its edges.
Landmarks attract as in the registration of whole shapes.
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
from kfmaps.geometry.mesh import Mesh, boundary_vertices, surface_area, vertex_areas, vertex_normals
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
_BEYOND = 0.01  # distance from the boundary of the whole, in its √area, from which a point lies beyond it
_OVERLAP_WIDTH = 0.02
"""Distance between the surfaces, in √area of the whole, at which a common point is as likely as not."""


@dataclass(frozen=True, eq=False)
class PartRegistration:
    """A part registered onto a whole, in the unit of the whole."""

    vertices: np.ndarray  # (n, 3)
    rest: Mesh  # the part before, at its scale
    scale: float  # √area of the part over that of the whole
    places: ClosestPoints  # the closest point of the whole to each vertex
    inside: np.ndarray  # (n,) bool: whether the vertex lies on the whole, and not beyond its boundary
    deformation_energy: float  # as-rigid-as-possible energy per area
    gap: float  # root of the mean squared distance from the whole
    flipped_area: float  # share of the area whose normals contradict those of the whole
    doubled_area: float  # share of the area on the whole that lies where more of the part lies
    edge_ratio: float  # median ratio of the lengths of edges after and before


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
    """Register the part onto the whole.

    ``scale``: √area of the part over that of the whole; ``points (q, 3)`` and ``normals (q, 3)``: first positions of
    the part's samples, and the normals of the whole there; ``trust (q,)``: weights of the samples; ``quick``: three
    levels of three steps, to compare candidates, instead of five of five; ``progress``: is called with the share of the
    work that is done.
    """
    rest = deformable_mesh(scale_mesh(pair.part.mesh, scale), {})
    x = initial_deformation(rest, pair.part.samples, points, normals, rest.areas.sum() * trust / trust.sum())
    levels, steps = (_STIFFNESS[:3], 3) if quick else (_STIFFNESS, 5)
    pull = landmark_pull(rest, pair.part.landmarks, pair.whole.mesh.vertices[pair.whole.landmarks])
    return _register(rest, x, scale, pair.whole, pull, levels, steps, progress)


def refine_registration(
    found: PartRegistration, proxy: CoarseProxy, part: Mesh, whole: PartSurface, landmarks: np.ndarray
) -> PartRegistration:
    """Return the registration of a ``part`` that starts from the one ``found`` for coarse proxies of part and whole.

    ``proxy``: the coarse proxy of the part; ``landmarks (l, 2)``: vertices of the part and of the whole.
    """
    rest, x = deformable_mesh(scale_mesh(part, found.scale)), found.vertices
    if len(x) < len(part.vertices):
        R = rotations(build_arap(found.rest), x)
        x = embedded_deformation(replace(proxy, mesh=found.rest), rest.mesh, x, R)
    pull = landmark_pull(rest, landmarks[:, 0], whole.mesh.vertices[landmarks[:, 1]])
    return _register(rest, x, found.scale, whole, pull, _STIFFNESS[-1:], 2, lambda _done: None)


def _register(
    rest: DeformableMesh,
    x: np.ndarray,
    scale: float,
    whole: PartSurface,
    pull: LandmarkPull,
    levels: Sequence[float],
    steps: int,
    progress: Callable[[float], None],
) -> PartRegistration:
    """Return the registration of the part, ``rest``, that starts from the vertices ``x (n, 3)``."""

    def terms(x: np.ndarray, stiffness: float) -> list[DataTerm]:
        found, normals, agree = whole.surface(x, vertex_normals(Mesh(x, rest.mesh.faces)))
        closest = DataTerm(rest.areas * (agree * _is_inside(found, whole)), found.points, None, normals)
        return [closest, *pull.terms(x, stiffness)]

    def transforms(x: np.ndarray) -> np.ndarray:
        return rotations(rest.energy, x)

    x = descend_levels(rest, x, levels, steps, 1.0, terms, transforms, progress)
    return _measure_registration(x, rest, scale, whole)


def _measure_registration(x: np.ndarray, body: DeformableMesh, scale: float, whole: PartSurface) -> PartRegistration:
    """Return the record of a part, ``body`` before, with its vertices at ``x (n, 3)``."""
    rest, areas = body.mesh, body.areas
    found = closest_points(x, whole.mesh.vertices, whole.mesh.faces)
    normals = whole.surface.normals[whole.mesh.faces[found.faces]].mean(axis=1)
    cosine = np.einsum("ij,ij->i", vertex_normals(Mesh(x, rest.faces)), normals)
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
        _doubled_area(Mesh(x, rest.faces), inside, whole),
        float(np.median(longer)),
    )


def _doubled_area(part: Mesh, inside: np.ndarray, whole: PartSurface) -> float:
    """Return the share of the area of a registered part, (n,) bool ``inside``, that lies where more of it lies.

    It is what the part has more than it covers of the whole. Two legs may lie on one, each by itself as it should.
    """
    found, _, agree = closest_point_query(part)(whole.mesh.vertices, whole.surface.normals)
    on_edge = 1e-3  # distance up to which a vertex of the whole lies on the boundary of the part, and counts
    beyond = _at_boundary(found, part.faces, boundary_vertices(part)) & (found.distances > on_edge)
    covered = ~beyond & (found.distances < _OVERLAP_WIDTH) & (agree > 0)
    own = float(vertex_areas(part) @ inside)
    return max(1.0 - float(whole.areas @ covered) / own, 0.0) if own > 0 else 0.0


def _is_inside(found: ClosestPoints, whole: PartSurface) -> np.ndarray:
    """Return which closest points (q,) are those of points on the whole, and not of points beyond its boundary."""
    return ~(_at_boundary(found, whole.mesh.faces, whole.on_boundary) & (found.distances > _BEYOND))


def _at_boundary(found: ClosestPoints, faces: np.ndarray, on_boundary: np.ndarray) -> np.ndarray:
    """Return which points (q,) of ``faces (m, 3)`` lie on an edge between vertices that are ``on_boundary (n,)``."""
    has_weight = found.weights > 1e-9
    return np.asarray((on_boundary[faces[found.faces]] | ~has_weight).all(axis=1) & ~has_weight.all(axis=1))


@dataclass(frozen=True, eq=False)
class Overlap:
    """Which vertices a part and a whole have in common, and where each lies on the other shape."""

    part: np.ndarray  # (n_p,): probability of each vertex to be on both shapes
    whole: np.ndarray  # (n_w,)
    on_whole: PointMap  # for each vertex of the part
    on_part: PointMap  # for each vertex of the whole; valid only where ``whole`` is above a half


def overlap_probability(
    registered: Mesh, on_boundary: np.ndarray, whole: Mesh, normals: np.ndarray | None = None
) -> tuple[np.ndarray, ClosestPoints]:
    """Return the probability (n_w,) of each vertex of a whole to lie on a registered part, and the closest point on it.

    ``registered``: the part in the unit of the whole; ``on_boundary (n_p,)``: its vertices on the boundary; ``whole``:
    at unit area; ``normals (n_w, 3)``: of the whole's vertices, if they have been computed.
    """
    found, _, agree = closest_point_query(registered)(
        whole.vertices, vertex_normals(whole) if normals is None else normals
    )
    # The closest point of a vertex beyond the boundary lies on it. Half an edge's length is the resolution there.
    corners = registered.vertices[registered.faces[found.faces]]
    half = 0.5 * np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean(axis=1)
    edge = _at_boundary(found, registered.faces, on_boundary)
    width = np.where(edge, np.minimum(half, _OVERLAP_WIDTH), _OVERLAP_WIDTH)
    return _half_at(found.distances, width) * np.where(agree > 0, 1.0, 0.25), found


def find_overlap(registered: PartRegistration, whole: PartSurface) -> Overlap:
    """Return what a registered part and the whole have in common."""
    mesh = Mesh(registered.vertices, registered.rest.faces)
    common, found = overlap_probability(mesh, boundary_vertices(registered.rest), whole.mesh, whole.surface.normals)
    own = np.where(registered.inside, _half_at(registered.places.distances, _OVERLAP_WIDTH), 0.0)
    return Overlap(own, common, *(PointMap(places.faces, places.weights) for places in (registered.places, found)))


def _half_at(distances: np.ndarray, width: np.ndarray | float) -> np.ndarray:
    """Return 1 for no distance, a half at ``width``, less beyond."""
    return np.exp2(-((distances / np.maximum(width, 1e-12)) ** 2))
