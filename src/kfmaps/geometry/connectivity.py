"""Connectivity of points and faces: duplicates, components, boundary edges, and the faces around each vertex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from kfmaps._arrays import index_ranges


def unique_vertices(vertices: np.ndarray) -> np.ndarray:
    """Return for each of ``vertices (n, 3)``, finite, the number of the first one at the same position: (n,)."""
    points = vertices + 0.0  # makes -0.0 and 0.0 the same
    order = np.lexsort(points.T)
    moved = np.ones(len(points), dtype=bool)
    moved[1:] = (points[order[1:]] != points[order[:-1]]).any(axis=1)
    first = np.empty(len(points), dtype=np.int64)
    # lexsort is stable, so the first of each run has the smallest number
    first[order] = order[moved][np.cumsum(moved) - 1]
    return first


def component_labels(count: int, a: np.ndarray, b: np.ndarray) -> tuple[int, np.ndarray]:
    """Return the connected components of a graph.

    ``count``: number of nodes; ``a (m,)`` and ``b (m,)``: ends of the edges. Returns ``number``; ``labels (count,)``:
    component of each node, from 0.
    """
    if count == 0:
        return 0, np.zeros(0, dtype=np.int64)
    graph = coo_array((np.ones(len(a), dtype=bool), (a, b)), shape=(count, count))
    number, labels = connected_components(graph, directed=False)
    return int(number), labels


def proper_faces(faces: np.ndarray) -> np.ndarray:
    """Return which of ``faces (f, 3)`` name three different vertices, (f,) bool."""
    return (faces != np.roll(faces, 1, axis=1)).all(axis=1)


def half_edges(faces: np.ndarray) -> np.ndarray:
    """Return the edges of ``faces (f, 3)`` as they run around each face, (3 f, 2)."""
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def half_edges_by_edge(faces: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the half-edges of ``faces (f, 3)`` that are alone on their edge, and those that are two.

    Half-edge 3 face + i goes from corner i to corner i + 1. ``n``: number of vertices. Returns ``rim (b,)``: numbers of
    the first; ``pairs (2, p)``: of the others; ``sharing (e,)``: how many half-edges each edge has.
    """
    tail, head = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    edge = np.minimum(tail, head) * n + np.maximum(tail, head)
    order = np.argsort(edge, kind="stable")
    start = np.flatnonzero(np.diff(edge[order], prepend=-1))
    sharing = np.diff(start, append=len(order))
    two = start[sharing == 2]
    return order[start[sharing == 1]], np.stack([order[two], order[two + 1]]), sharing


def mesh_edges(faces: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges of ``faces (f, 3)`` on ``n`` vertices, and how many faces have each.

    Returns (e, 2): vertices of each edge, the smaller number first, in ascending order; (e,): numbers of faces.
    """
    tail, head = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    # One number for each edge: rows are sorted ten times as slowly, and np.unique takes twenty times as long.
    keys = np.sort(np.minimum(tail, head) * n + np.maximum(tail, head))
    starts = np.flatnonzero(np.diff(keys, prepend=-1))
    return np.stack(np.divmod(keys[starts], max(n, 1)), axis=1), np.diff(starts, append=len(keys))


def boundary_edges(faces: np.ndarray, n: int) -> np.ndarray:
    """Return the edges that only one of ``faces (f, 3)`` has, (b, 2), as :func:`mesh_edges` returns them."""
    edges, sharing = mesh_edges(faces, n)
    return edges[sharing == 1]


@dataclass(frozen=True, eq=False)
class VertexRings:
    """The faces around each vertex; made by :func:`vertex_rings`."""

    start: np.ndarray  # (n + 1,): the faces of vertex ``i`` are ``faces[start[i]:start[i + 1]]``
    faces: np.ndarray  # (3 f,)

    def around(self, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return all faces around each of ``vertices (m,)``, and which entry of ``vertices`` each is for."""
        count = self.start[vertices + 1] - self.start[vertices]
        return self.faces[index_ranges(self.start[vertices], count)], np.repeat(np.arange(len(vertices)), count)


def vertex_rings(faces: np.ndarray, n: int) -> VertexRings:
    """Return the faces ``(f, 3)`` around each of ``n`` vertices."""
    corners = faces.ravel()
    order = np.argsort(corners, kind="stable")
    start = np.concatenate([[0], np.cumsum(np.bincount(corners, minlength=n))])
    return VertexRings(start, order // 3)
