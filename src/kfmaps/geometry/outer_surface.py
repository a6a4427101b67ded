"""The outer surface of a shape: without inner walls and partitions, around pieces that are stuck together or overlap.

Inside is where the winding number is above one half (Jacobson, Kavan and Sorkine-Hornung, Robust inside-outside
segmentation using generalized winding numbers, 2013).
"""

from __future__ import annotations

import igl
import numpy as np
from scipy.spatial import KDTree

from kfmaps.geometry.cloud_surface import surface_of_cloud
from kfmaps.geometry.connectivity import (
    component_labels,
    half_edges_by_edge,
    manifold_patches,
    mesh_edges,
    unique_vertices,
)
from kfmaps.geometry.mesh import (
    Mesh,
    component_areas,
    face_areas,
    face_normals,
    spread_directions,
    vertex_normals,
)

_WHOLE_AREA = 0.95
"""Share of the area above which one piece, pieces that touch, or one closed surface are taken for the whole shape."""
_MIN_INSIDE, _N_OUTER = 0.8, 3
"""Least share of the vertices of a component that are inside another, of which it is an inner wall then, and the number
of components, the widest, in which others may be."""
_MIN_PARTITION, _MAX_SEEN = 0.005, 0.05
"""Least share of the area of a partition, and most of the rays from it that leave the shape."""
_N_FACES, _N_RAYS, _MIN_COSINE, _OFFSET = 50, 48, 0.1, 1e-4
"""Most faces of a patch that rays start from, rays from each, their least cosine with the normal, either way, and the
distance from the face, in √area, where they start."""
_MIN_VERTICES = 100
"""Vertices of a shape that can be matched; what has fewer is a box around those inside."""
_DEPTH = 0.007
"""Height above the surface, in √area, where a vertex is asked whether it is inside: about half an edge."""


def without_inner_walls(mesh: Mesh) -> Mesh | None:
    """Return a mesh without the components inside one of its widest, such as cavities; ``None`` where there are none.

    Of a box around a shape the shape is left. ``mesh``: cleaned.
    """
    label, areas = component_areas(mesh)
    pieces = np.flatnonzero(areas)  # a vertex that no face uses is a component, too
    if len(pieces) == 1:
        return None
    low, high = np.full((len(areas), 3), np.inf), np.full((len(areas), 3), -np.inf)
    np.minimum.at(low, label, mesh.vertices)
    np.maximum.at(high, label, mesh.vertices)
    width, component = np.linalg.norm(high - low, axis=1), label[mesh.faces[:, 0]]
    is_inner, sizes = np.zeros(len(areas), dtype=bool), np.bincount(label)
    for outer in pieces[np.argsort(-width[pieces])[:_N_OUTER]]:
        others, faces = np.flatnonzero(label != outer), mesh.faces[component == outer]
        number = np.asarray(igl.fast_winding_number(mesh.vertices, faces, mesh.vertices[others]))
        is_inside = np.abs(number) > 0.5  # negative in components that face inward among others
        inner = (areas > 0) & (np.bincount(label[others], is_inside, len(areas)) >= _MIN_INSIDE * sizes)
        is_box = sizes[outer] < _MIN_VERTICES <= sizes[inner].sum()
        is_inner[outer if is_box else inner] = True
    if not is_inner[pieces].any() or is_inner[pieces].all():  # open surfaces may seem to be inside each other
        return None
    return Mesh(mesh.vertices, mesh.faces[~is_inner[component]])


def without_partitions(mesh: Mesh) -> Mesh | None:
    """Return a mesh without partitions of its inside, as between the regions of a segmented image, or ``None``.

    ``mesh``: cleaned, of unit area. A partition is a patch between edges of more than two faces that cannot be seen
    from outside: rays from both of its sides hit the surface.
    """
    vertices, faces = mesh.vertices, mesh.faces
    patch = manifold_patches(len(faces), half_edges_by_edge(faces, len(vertices))[1])
    areas = np.bincount(patch, face_areas(mesh))
    wide = np.flatnonzero(areas >= _MIN_PARTITION * areas.sum())
    if len(wide) < 2:
        return None
    of_patches = [np.flatnonzero(patch == number) for number in wide]
    starts = np.concatenate([rows[:: 1 + len(rows) // _N_FACES] for rows in of_patches])
    row, directions = np.repeat(starts, _N_RAYS), np.tile(spread_directions(_N_RAYS), (len(starts), 1))
    # Rays along the surface would hit its next fold.
    is_steep = np.abs(np.einsum("ij,ij->i", directions, face_normals(mesh)[row])) > _MIN_COSINE
    row, directions = row[is_steep], directions[is_steep]
    tree = igl.AABB()
    tree.init(vertices, faces)
    origins = vertices[faces[row]].mean(axis=1) + _OFFSET * directions
    leaves = np.asarray(tree.intersect_ray_first(vertices, faces, origins, directions)[0]) < 0
    n_rays = np.bincount(patch[row], minlength=len(areas))
    is_partition = np.bincount(patch[row], leaves, len(areas)) < _MAX_SEEN * n_rays
    if not is_partition.any() or is_partition[wide].all():
        return None
    return Mesh(vertices, faces[~is_partition[patch]])


def outer_surface(mesh: Mesh) -> Mesh | None:
    """Return the closed mesh around pieces that overlap or touch, with the vertices of ``mesh`` in their order.

    ``mesh``: cleaned, of unit area, with faces outward. Vertices inside other pieces are no corners of the new faces;
    the others may have moved where they are noisy. Return ``None`` for a mesh that is nearly all in one piece, for
    pieces that lie apart, and where no closed surface through the vertices is found.
    """
    if not _is_in_touching_pieces(mesh):
        return None
    above = mesh.vertices + _DEPTH * vertex_normals(mesh)
    is_outer = np.asarray(igl.fast_winding_number(mesh.vertices, mesh.faces, above)) <= 0.5
    is_outer &= unique_vertices(mesh.vertices) == np.arange(len(mesh.vertices))
    used = np.unique(mesh.faces)  # the vertices of what is left out already are not
    outer = used[is_outer[used]]
    surface = surface_of_cloud(mesh.vertices[outer])
    if surface is None:
        return None
    areas = component_areas(surface)[1]
    if areas.max() < _WHOLE_AREA * areas.sum():
        return None
    vertices = mesh.vertices.copy()
    vertices[outer] = surface.vertices
    return Mesh(vertices, outer[surface.faces])


def _is_in_touching_pieces(mesh: Mesh) -> bool:
    """Return whether most of a mesh is in pieces that are no farther from each other than an edge is long."""
    label, areas = component_areas(mesh)
    if areas.max() > _WHOLE_AREA * areas.sum():
        return False
    n, edges = len(mesh.vertices), mesh_edges(mesh.faces, len(mesh.vertices))[0]
    length = np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1).mean()
    neighbours = np.asarray(KDTree(mesh.vertices).query(mesh.vertices, k=10, distance_upper_bound=length)[1])
    vertex, column = np.nonzero(neighbours < n)
    pieces = component_labels(len(areas), label[vertex], label[neighbours[vertex, column]])[1]
    return bool(np.bincount(pieces, areas).max() >= _WHOLE_AREA * areas.sum())
