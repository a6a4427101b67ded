"""The closed surface around pieces that overlap, such as limbs that are stuck into a trunk or scans side by side."""

from __future__ import annotations

import igl
import numpy as np
from scipy.spatial import KDTree

from kfmaps.geometry.cloud_surface import surface_of_cloud
from kfmaps.geometry.connectivity import component_labels, half_edges, mesh_edges, unique_vertices
from kfmaps.geometry.mesh import Mesh, face_areas, vertex_normals

_WHOLE_AREA = 0.95
"""Share of the area above which one piece, pieces that touch, or one closed surface are taken for the whole shape."""
_DEPTH = 0.007
"""Height above the surface, in √area, where a vertex is asked whether it is inside: about half an edge."""


def outer_surface(mesh: Mesh) -> Mesh | None:
    """Return the closed mesh around pieces that overlap or touch, with the vertices of ``mesh`` in their order.

    ``mesh``: cleaned, of unit area, with faces outward. Vertices inside other pieces are no corners of the new faces;
    the others may have moved where they are noisy. Inside is where the winding number is above one half (Jacobson,
    Kavan and Sorkine-Hornung, Robust inside-outside segmentation using generalized winding numbers, 2013). Return
    ``None`` for a mesh that is nearly all in one piece, for pieces that lie apart, and where no closed surface through
    the vertices is found.
    """
    if not _is_in_touching_pieces(mesh):
        return None
    above = mesh.vertices + _DEPTH * vertex_normals(mesh)
    is_outer = np.asarray(igl.fast_winding_number(mesh.vertices, mesh.faces, above)) <= 0.5
    is_outer &= unique_vertices(mesh.vertices) == np.arange(len(mesh.vertices))
    outer = np.flatnonzero(is_outer)
    surface = surface_of_cloud(mesh.vertices[outer])
    if surface is None or _largest_share(surface) < _WHOLE_AREA:
        return None
    vertices = mesh.vertices.copy()
    vertices[outer] = surface.vertices
    return Mesh(vertices, outer[surface.faces])


def _is_in_touching_pieces(mesh: Mesh) -> bool:
    """Return whether most of a mesh is in pieces that are no farther from each other than an edge is long."""
    if _largest_share(mesh) > _WHOLE_AREA:
        return False
    n, edges = len(mesh.vertices), mesh_edges(mesh.faces, len(mesh.vertices))[0]
    label = component_labels(n, *edges.T)[1]
    length = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1).mean()
    neighbours = np.asarray(KDTree(mesh.vertices).query(mesh.vertices, k=10, distance_upper_bound=length)[1])
    vertex, column = np.nonzero(neighbours < n)
    other = neighbours[vertex, column]
    pieces = component_labels(n, np.concatenate([label, label[vertex]]), np.concatenate([label, label[other]]))[1]
    area = np.bincount(pieces[label[mesh.faces[:, 0]]], face_areas(mesh))
    return bool(area.max() >= _WHOLE_AREA * area.sum())


def _largest_share(mesh: Mesh) -> float:
    """Return the share of the area that the largest component of a mesh has."""
    label = component_labels(len(mesh.vertices), *half_edges(mesh.faces).T)[1]
    area = np.bincount(label[mesh.faces[:, 0]], face_areas(mesh))
    return float(area.max() / area.sum())
