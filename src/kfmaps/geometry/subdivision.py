"""Subdivision: faces cut in four, with new vertices on a smooth surface through the others."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array, vstack

from kfmaps.geometry.mesh import Mesh


def divide_faces(faces: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return ``faces (f, 3)`` cut in four at the middles of their edges.

    ``n``: number of vertices. Returns the ends of the edges, (e, 2), whose middles are the vertices from ``n`` on; and
    the faces, (4 f, 3): for each face the three at its corners, and after all these the ones in the middle.
    """
    a, b = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    edges, number = np.unique(np.minimum(a, b) * n + np.maximum(a, b), return_inverse=True)
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
