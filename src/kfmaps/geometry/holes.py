"""Small holes, as scans have, are filled with faces between the vertices of their borders."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kfmaps._arrays import blocks
from kfmaps.geometry.connectivity import half_edges_by_edge, mesh_edges
from kfmaps.geometry.mesh import MIN_OPENING, Mesh, face_areas, opening_area, unit_rows, vertex_normals

EdgeTest = Callable[[np.ndarray, np.ndarray], np.ndarray]

_MIN_SHARE = 0.4
"""Least share of the opening that small holes make up. A shape that is mostly cut off stays as it is."""
_MAX_AREA, _MAX_PERIMETER, _MAX_CORNERS = 0.01, 0.8, 300
"""Most area of the faces in a hole, its longest border in √area, and most vertices on it."""
_MIN_ALIGNMENT, _TINY = 0.25, 0.001
"""Least mean cosine between the normals of a hole and of its border, and the area up to which it does not count.

A limb that is cut off ends in a border whose normals point sideways.
"""
_BLOCK = 1_000_000
"""Pairs of vertices on the borders of the holes that are filled at once."""
_EDGE_COST = 0.02
"""Cost of a squared edge length in the faces of a hole, where a unit of area costs 1."""


def fill_holes(mesh: Mesh) -> Mesh | None:
    """Return the mesh with faces in its small holes after the others, or ``None`` where they are few.

    ``mesh``: cleaned, of unit area, oriented consistently. The faces of a hole have the least area, which dynamic
    programming finds (Barequet and Sharir, Filling gaps in the boundary of a polyhedron, 1995).
    """
    opening = opening_area(mesh)
    if opening < MIN_OPENING:
        return None
    boundary = half_edges_by_edge(mesh.faces, len(mesh.vertices))[0]
    # Around a hole the border runs against the faces beside it.
    edges = np.stack([mesh.faces[:, [1, 2, 0]].ravel()[boundary], mesh.faces.ravel()[boundary]], axis=1)
    normals, is_edge = vertex_normals(mesh), _edge_test(mesh)
    added = [
        _fill_loops(mesh.vertices, normals, loops[rows], is_edge)
        for loops in _loops_by_size(mesh.vertices, normals, edges)
        for rows in blocks(len(loops), 1 + _BLOCK // loops.shape[1] ** 2)
    ]
    filled = Mesh(mesh.vertices, np.concatenate([mesh.faces, *added]))
    return filled if opening - opening_area(filled) >= _MIN_SHARE * opening else None


def _loops_by_size(vertices: np.ndarray, normals: np.ndarray, edges: np.ndarray) -> list[np.ndarray]:
    """Return the loops of directed ``edges (b, 2)`` that pass no vertex twice, as arrays (l, k) of k vertices each.

    Borders that are too long are left out. A trail along the edges keeps to one hole, which is to the left of each
    edge, and leaves a loop behind whenever it comes back to a vertex, so holes that touch in a vertex come apart.
    """
    following: dict[int, list[int]] = {}
    for tail, head in edges.tolist():
        following.setdefault(tail, []).append(head)
    by_size: dict[int, list[list[int]]] = {}
    for first in list(following):
        trail, place = [first], {first: 0}
        while following.get(trail[-1]):
            vertex = _leave(vertices, normals, trail, following[trail[-1]])
            if vertex not in place:
                place[vertex] = len(trail)
                trail.append(vertex)
                continue
            loop = trail[place[vertex] :]
            if 3 <= len(loop) <= _MAX_CORNERS:
                by_size.setdefault(len(loop), []).append(loop)
            for passed in loop[1:]:
                del place[passed]
            del trail[place[vertex] + 1 :]
    result = []
    for loops in map(np.array, by_size.values()):
        corners = vertices[loops]
        perimeter = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).sum(axis=1)
        result.append(loops[perimeter <= _MAX_PERIMETER])
    return [loops for loops in result if len(loops)]


def _leave(vertices: np.ndarray, normals: np.ndarray, trail: list[int], ends: list[int]) -> int:
    """Remove and return that of the ``ends`` of edges from a trail's end whose edge has the same hole to the left.

    It is the first one clockwise from where the trail came.
    """
    if len(ends) == 1 or len(trail) == 1:
        return ends.pop()
    at, back = vertices[trail[-1]], vertices[trail[-2]] - vertices[trail[-1]]
    across, leaving = np.cross(back, normals[trail[-1]]), vertices[ends] - at
    angle = np.arctan2(leaving @ across, leaving @ (back - (back @ normals[trail[-1]]) * normals[trail[-1]]))
    return ends.pop(int((angle % (2 * np.pi)).argmin()))


def _edge_test(mesh: Mesh) -> EdgeTest:
    """Return a function that says of pairs of vertices whether an edge of the mesh joins them."""
    n = len(mesh.vertices)
    keys = mesh_edges(mesh.faces, n)[0] @ np.array([n, 1])

    def is_edge(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        wanted = np.minimum(a, b) * n + np.maximum(a, b)
        return keys[np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)] == wanted

    return is_edge


def _fill_loops(vertices: np.ndarray, normals: np.ndarray, loops: np.ndarray, is_edge: EdgeTest) -> np.ndarray:
    """Return the faces in those of ``loops (l, k)`` that are small holes, (f, 3); ``normals (n, 3)``: of vertices."""
    corners = vertices[loops]
    faces, is_possible = _least_faces(corners, is_edge(loops[:, :, None], loops[:, None]))
    faces = loops[np.arange(len(loops))[:, None, None], faces]
    vectors = np.cross(corners, np.roll(corners, -1, axis=1)).sum(axis=1)
    alignment = np.einsum("lki,li->lk", normals[loops], unit_rows(vectors)).mean(axis=1)
    areas = face_areas(Mesh(vertices, faces.reshape(-1, 3))).reshape(len(loops), -1).sum(axis=1)
    is_hole = is_possible & (areas <= np.where(alignment >= _MIN_ALIGNMENT, _MAX_AREA, _TINY))
    return faces[is_hole].reshape(-1, 3)


def _least_faces(corners: np.ndarray, is_edge: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the faces of least cost in loops with ``corners (l, k, 3)``, (l, k − 2, 3), and whether there are, (l,).

    ``is_edge (l, k, k)``: pairs of corners that an edge joins already, which no face may join again.
    """
    count, k = corners.shape[:2]
    squared = ((corners[:, :, None] - corners[:, None]) ** 2).sum(axis=3)
    cost, apex = np.zeros((count, k, k)), np.zeros((count, k, k), dtype=np.int64)
    for span in range(2, k):
        first, last = np.arange(k - span), np.arange(span, k)
        between = first[:, None] + np.arange(1, span)
        a, b = squared[:, first[:, None], between], squared[:, between, last[:, None]]
        base = squared[:, first, last][:, :, None]
        total = 0.25 * np.sqrt(np.maximum(4 * a * b - (a + b - base) ** 2, 0.0))  # Heron
        total += cost[:, first[:, None], between] + cost[:, between, last[:, None]] + _EDGE_COST * (a + b)
        best = total.argmin(axis=2)
        apex[:, first, last] = first + 1 + best
        cost[:, first, last] = np.take_along_axis(total, best[:, :, None], axis=2)[:, :, 0]
        if span < k - 1:
            cost[:, first, last] += np.where(is_edge[:, first, last], np.inf, 0.0)
    is_base, faces = np.zeros((count, k, k), dtype=bool), []
    is_base[:, 0, k - 1] = True
    for span in range(k - 1, 1, -1):
        loop, a = np.nonzero(np.diagonal(is_base, span, 1, 2))
        b = a + span
        c = apex[loop, a, b]
        is_base[loop, a, c] = is_base[loop, c, b] = True
        faces.append(np.stack([loop, a, c, b], axis=1))
    ordered = np.concatenate(faces)
    ordered = ordered[np.argsort(ordered[:, 0], kind="stable")]
    return ordered[:, 1:].reshape(count, k - 2, 3), np.isfinite(cost[:, 0, k - 1])
