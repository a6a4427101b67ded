"""The floor that a scanned shape stands on: an open, flat sheet with everything else on one side of it."""

from __future__ import annotations

import numpy as np

from kfmaps.geometry.connectivity import boundary_edges, component_labels
from kfmaps.geometry.mesh import Mesh, boundary_loops, face_areas, face_normals

_MAX_DEVIATION, _MIN_TOLERANCE = 0.007, 0.01
"""Most root mean squared distance of the edge of the floor from its plane, and the least distance, otherwise three such
deviations, up to which vertices belong to the floor; in √area."""
_MIN_COSINE = 0.7
"""Least mean cosine between the normals of the floor's faces and of its plane."""
_MIN_AREA, _MAX_AREA = 0.1, 0.8
"""Least and most share of the area that a floor has."""
_MIN_ABOVE = 0.98
"""Least share of the other area that lies on one side of the plane."""


def without_floor(mesh: Mesh) -> Mesh | None:
    """Return a mesh without the floor that its longest boundary is the edge of, or ``None`` where there is none.

    ``mesh``: cleaned, of unit area. A plane is fitted to that boundary; the floor is what lies in it and is connected
    to the boundary. Where a limb is cut off, few faces lie in such a plane, and they are perpendicular to it.
    """
    vertices, faces = mesh.vertices, mesh.faces
    edges = boundary_edges(faces, len(vertices))
    if len(edges) == 0:
        return None
    loop = boundary_loops(vertices, edges)[0]
    lengths = np.bincount(loop, np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1))
    edge = np.unique(edges[loop == lengths.argmax()])
    positions = vertices - vertices[edge].mean(axis=0)
    normal = np.linalg.eigh(positions[edge].T @ positions[edge])[1][:, 0]
    height = positions @ normal
    deviation = float(np.sqrt((height[edge] ** 2).mean()))
    if deviation > _MAX_DEVIATION:
        return None
    is_flat = (np.abs(height) <= max(_MIN_TOLERANCE, 3 * deviation))[faces].all(axis=1)
    flat = faces[is_flat]
    label = component_labels(len(vertices), flat[:, :2].ravel(), flat[:, 1:].ravel())[1]
    is_floor = is_flat & np.isin(label[faces[:, 0]], label[edge])
    areas = face_areas(mesh)
    share = areas[is_floor].sum()
    # A border encloses no more area than a circle of its length: a small hole in a flat side is no edge of that side.
    if not _MIN_AREA <= share <= min(_MAX_AREA, lengths.max() ** 2 / (4 * np.pi)):
        return None
    cosine = areas[is_floor] @ np.abs(face_normals(mesh)[is_floor] @ normal) / share
    above = areas[~is_floor] @ (height[faces[~is_floor]].mean(axis=1) > 0) / (1 - share)
    if cosine < _MIN_COSINE or max(above, 1 - above) < _MIN_ABOVE:
        return None
    return Mesh(vertices, faces[~is_floor])
