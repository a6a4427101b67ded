"""Subdivision: faces cut in four, with new vertices on a smooth surface through the others, or cut where they lie.

The faces of CAD files (STL) span flat and curved faces of a solid with as few triangles as possible: most are long and
thin, and have no vertices inside. A mesh of these is divided without being changed.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array, vstack

from kfmaps.geometry.connectivity import edge_keys, half_edges_by_edge
from kfmaps.geometry.mesh import MIN_OPENING, Mesh, component_areas, face_areas, face_normals, opening_area

_PIECES = {
    1: ((0, 3, 2), (3, 1, 2)),
    2: ((3, 1, 4), (0, 3, 2), (3, 4, 2)),
    3: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    4: ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
}
"""The pieces of a face with one, two or three long edges, the first ones, and of one with two and the other diagonal.

3, 4 and 5 are the middles of the edges from corner 0, 1 and 2.
"""


def divide_faces(faces: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return ``faces (f, 3)`` cut in four at the middles of their edges.

    ``n``: number of vertices. Returns the ends of the edges, (e, 2), whose middles are the vertices from ``n`` on; and
    the faces, (4 f, 3): for each face the three at its corners, and after all these the ones in the middle.
    """
    edges, number = np.unique(edge_keys(faces, n), return_inverse=True)
    across = n + number.reshape(-1, 3)  # the middle of the edge from corner i to corner i + 1
    corners = np.stack([faces, across, across[:, [2, 0, 1]]], axis=2).reshape(-1, 3)
    return np.stack([edges // n, edges % n], axis=1), np.concatenate([corners, across])


def loop_matrix(faces: np.ndarray, n: int) -> tuple[csr_array, np.ndarray]:
    """Return the matrix (n + e, n) that takes values at vertices to those of Loop's subdivision, and its faces.

    ``n``: number of vertices; ``faces (f, 3)``. The weights are those of Loop 1987 and Warren 1995; edges of one face,
    or of more than two, are creases.
    """
    edges, divided = divide_faces(faces, n)
    opposite, number = faces[:, [2, 0, 1]].ravel(), (divided[-len(faces) :] - n).ravel()
    is_crease = np.bincount(number, minlength=len(edges)) != 2
    each = np.arange(len(edges))
    ends = coo_array(
        (np.repeat(np.where(is_crease, 1 / 2, 3 / 8), 2), (np.repeat(each, 2), edges.ravel())), (len(each), n)
    )
    wings = coo_array((np.where(is_crease[number], 0, 1 / 8), (number, opposite)), (len(each), n))

    def neighbours(some: np.ndarray) -> tuple[csr_array, np.ndarray]:
        both = np.concatenate([some, some[:, ::-1]])
        graph = coo_array((np.ones(len(both)), both.T), (n, n)).tocsr()
        return graph, np.maximum(graph.sum(axis=1), 1)

    (ring, degree), (crease, crease_degree) = neighbours(edges), neighbours(edges[is_crease])
    on_crease = np.isin(np.arange(n), edges[is_crease])
    weight = np.where(on_crease, 0, np.where(degree == 3, 3 / 16, 3 / (8 * degree)))
    own = diags_array(np.where(on_crease, 3 / 4, 1 - degree * weight))
    old = own + diags_array(weight) @ ring + diags_array(on_crease / (4 * crease_degree)) @ crease
    return csr_array(vstack([old, ends + wings])), divided


def interpolating_subdivision(mesh: Mesh) -> Mesh:
    """Return a mesh with its faces cut in four and its vertices, followed by the new ones, on a smooth surface.

    Loop's scheme is applied to control points that it would return to the vertices, nearly.
    """
    n = len(mesh.vertices)
    matrix, faces = loop_matrix(mesh.faces, n)
    control = mesh.vertices
    for _ in range(2):  # steps of a fixed-point iteration
        control = control + mesh.vertices - (matrix @ control)[:n]
    return Mesh(np.concatenate([mesh.vertices, (matrix @ control)[n:]]), faces)


def is_polyhedral(mesh: Mesh) -> bool:
    """Return whether a surface is a solid with long faces, many of which lie in one plane with a neighbour.

    The longest edges of its faces are above 0.1 √area on average (solids of CAD files have 0.12 to 0.6, artists' meshes
    of some hundred vertices 0.06 to 0.25, scans and remeshed bodies at most 0.06), and faces with a neighbour in their
    plane have more than 45 % of the area (solids have 48 to 100 %, artists' creatures at most 40 %). A solid is closed
    or in one piece: artists put buildings together from open pieces (research/coarse-meshes.md).
    """
    areas, lengths = face_areas(mesh), _edge_lengths(mesh).max(axis=1)
    if areas @ lengths <= 0.1 * areas.sum() ** 1.5:
        return False
    normals, faces = face_normals(mesh), half_edges_by_edge(mesh.faces, len(mesh.vertices))[1] // 3
    is_flat = np.einsum("ei,ei->e", *normals[faces]) > np.cos(np.radians(0.5))
    if areas[np.unique(faces[:, is_flat])].sum() <= 0.45 * areas.sum():
        return False
    is_closed = opening_area(mesh) < MIN_OPENING * areas.sum()
    return is_closed or len(component_areas(mesh)[1]) == 1


def _edge_lengths(mesh: Mesh) -> np.ndarray:
    """Return the length of the edge from each corner of each face to the next, (f, 3)."""
    corners = mesh.vertices[mesh.faces]
    return np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)


def split_long_edges(mesh: Mesh, longest: float) -> tuple[Mesh, np.ndarray, np.ndarray]:
    """Return a mesh with all edges above the length ``longest`` cut at their middles, until there is none.

    Returns the mesh, its vertices followed by the new ones; ``face_of (g,)``: the face that each face is a piece of;
    ``corners (g, 3, 3)``: barycentric coordinates of its corners there.
    """
    vertices, faces, face_of = mesh.vertices, mesh.faces, np.arange(len(mesh.faces))
    corners = np.tile(np.eye(3), (len(faces), 1, 1))
    while True:
        n = len(vertices)
        is_long = _edge_lengths(Mesh(vertices, faces)) > longest
        if not is_long.any():
            return Mesh(vertices, faces), face_of, corners
        keys = edge_keys(faces, n).reshape(-1, 3)
        cut = np.unique(keys[is_long])
        vertices = np.concatenate([vertices, (vertices[cut // n] + vertices[cut % n]) / 2])
        count = is_long.sum(axis=1)
        # The first edge becomes the long one of one, or the first of two.
        first = np.where(count == 1, is_long.argmax(axis=1), (np.argmin(is_long, axis=1) + 1) % 3)
        turn = (first[:, None] + np.arange(3)) % 3
        six = np.concatenate([faces, n + np.searchsorted(cut, keys)], axis=1)  # corners, then middles of edges
        six = np.take_along_axis(six, np.hstack([turn, 3 + turn]), axis=1)
        where = np.take_along_axis(corners, turn[:, :, None], axis=1)
        where = np.concatenate([where, (where + np.roll(where, -1, axis=1)) / 2], axis=1)
        two = np.flatnonzero(count == 2)
        a, c, middle, last = (vertices[six[two, i]] for i in (0, 2, 3, 4))
        count[two[np.linalg.norm(a - last, axis=1) < np.linalg.norm(c - middle, axis=1)]] = 4
        made = [(faces[count == 0], face_of[count == 0], corners[count == 0])]
        for kind, pieces in _PIECES.items():
            rows = np.flatnonzero(count == kind)
            made += [(six[rows][:, piece], face_of[rows], where[rows][:, piece]) for piece in map(list, pieces)]
        faces, face_of, corners = (np.concatenate(some) for some in zip(*made, strict=True))
