"""The part bent onto the whole, as rigidly as possible: from samples that have a place to one for every vertex.

As :mod:`kfmaps.registration.nonrigid_icp`, but only the part looks for closest points: what lies beyond it on the
whole must
not pull. So it works for any cut, and the scale of the part follows from how long its edges become.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kfmaps.geometry.arap import arap_energy, rotations
from kfmaps.geometry.closest_points import ClosestPoints, closest_points
from kfmaps.geometry.mesh import Mesh, surface_area, vertex_normals
from kfmaps.matching.partial.samples import scaled
from kfmaps.registration.data_terms import DataTerm, descend
from kfmaps.registration.deformable import (
    ClosestPointQuery,
    DeformableMesh,
    closest_point_query,
    deformable_mesh,
    initial_deformation,
)

QUICK = (2e-3, 6e-4, 2e-4)
"""Stiffness of the levels by which candidates are compared, ..."""
FULL = (2e-3, 6e-4, 2e-4, 6e-5, 2e-5)
"""... and of those by which the best is finished, in areas of the whole."""
OUTSIDE = 0.01
"""Distance from an edge of the whole, in its √area, at which a point counts as lying beyond it."""


@dataclass(frozen=True, eq=False)
class RegistrationTarget:
    """A whole, at unit area, in which closest points are sought; made by :func:`registration_target`."""

    mesh: Mesh
    normals: np.ndarray
    look: ClosestPointQuery
    border: np.ndarray


def registration_target(mesh: Mesh, border: np.ndarray) -> RegistrationTarget:
    """``border (n,)``: its vertices that lie on the boundary."""
    normals = vertex_normals(mesh)
    return RegistrationTarget(mesh, normals, closest_point_query(mesh, normals), border)


@dataclass(frozen=True, eq=False)
class PartRegistration:
    """A part bent onto a whole, in its unit.

    Attributes
    ----------
    vertices : (n, 3) float64
    rest : Mesh
        The part at the scale that was found.
    scale : float
        √area of the part over that of the whole.
    places : Places
        The closest point of the whole to each vertex.
    inside : (n,) bool
        False where that is beyond an edge of the whole.
    bending : float
        As-rigid-as-possible energy per area.
    gap : float
        Root of the mean squared distance from the whole.
    folded : float
        Part of the area whose normals look elsewhere than the whole's.
    longer : float
        How much longer than at rest edges are, by the median.
    """

    vertices: np.ndarray
    rest: Mesh
    scale: float
    places: ClosestPoints
    inside: np.ndarray
    deformation_energy: float
    gap: float
    flipped_area: float
    edge_ratio: float


def register_part(
    part: Mesh,
    scale: float,
    whole: RegistrationTarget,
    samples: np.ndarray,
    places: np.ndarray,
    normals: np.ndarray,
    trust: np.ndarray,
    levels: tuple[float, ...] = FULL,
    steps: int = 5,
    progress: Callable[[float], None] | None = None,
) -> PartRegistration:
    """Bend ``part``, at unit area and times ``scale``; its vertices ``samples (q,)`` begin at ``places (q, 3)``.

    ``normals (q, 3)`` are the whole's there, ``trust (q,)`` how much each counts.
    """
    rest = deformable_mesh(scaled(part, scale))
    share = rest.areas.sum() * trust / trust.sum()
    x = initial_deformation(rest, samples, places, normals, share)
    for i, stiffness in enumerate(levels):
        solve = rest.solver(stiffness, 1.0)
        for step in range(steps):
            found, there, agree = whole.look(x, vertex_normals(Mesh(x, rest.mesh.faces)))
            counts = agree * within(found, whole)
            x = descend(
                rest.energy,
                stiffness,
                solve,
                [DataTerm(rest.areas * counts, found.points, None, there)],
                x,
                rotations(rest.energy, x),
            )
            if progress is not None:
                progress((i * steps + step + 1) / (len(levels) * steps))
    return judged(x, rest, scale, whole)


def judged(x: np.ndarray, body: DeformableMesh, scale: float, whole: RegistrationTarget) -> PartRegistration:
    """What a part, ``body`` at rest, shows with its vertices at ``x (n, 3)``."""
    rest, energy, areas = body.mesh, body.energy, body.areas
    found = closest_points(x, whole.mesh.vertices, whole.mesh.faces)
    there = whole.normals[whole.mesh.faces[found.faces]].mean(axis=1)
    cosine = np.einsum("ij,ij->i", vertex_normals(Mesh(x, rest.faces)), there)
    ends = np.concatenate([rest.faces[:, [0, 1]], rest.faces[:, [1, 2]], rest.faces[:, [2, 0]]])
    before, after = (np.linalg.norm(y[ends[:, 0]] - y[ends[:, 1]], axis=1) for y in (rest.vertices, x))
    longer = np.divide(after, before, out=np.ones_like(after), where=before > 0)
    inside = within(found, whole)
    on = areas * inside
    return PartRegistration(
        x,
        rest,
        scale,
        found,
        inside,
        arap_energy(energy, x) / float(surface_area(rest)),
        float(np.sqrt(np.average(found.distances**2, weights=on))) if on.any() else 1.0,
        float(areas[cosine < 0.3].sum() / areas.sum()),
        float(np.median(longer)),
    )


def within(found: ClosestPoints, whole: RegistrationTarget) -> np.ndarray:
    """Which places (q,) are no points of the whole's boundary that something beyond it is nearest to."""
    return ~(on_border(found, whole.mesh.faces, whole.border) & (found.distances > OUTSIDE))


def on_border(found: ClosestPoints, faces: np.ndarray, border: np.ndarray) -> np.ndarray:
    """Which places (q,) on ``faces (m, 3)`` lie on an edge between vertices of the ``border (n,)``."""
    counts = found.weights > 1e-9
    return np.asarray((border[faces[found.faces]] | ~counts).all(axis=1) & ~counts.all(axis=1))
