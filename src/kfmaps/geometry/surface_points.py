"""Distances along a surface between points inside its triangles."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array

from kfmaps._arrays import check, refuse
from kfmaps.geometry.connectivity import proper_faces, renumbering
from kfmaps.geometry.geodesic_graph import (
    _cross,
    _cross_edges,
    _next_faces,
    _opposite_corners,
    _unfold,
    _Windows,
    geodesic_graph,
    join_links,
)
from kfmaps.geometry.geodesics import shortest_paths
from kfmaps.geometry.mesh import Mesh, unit_rows
from kfmaps.geometry.weld import weld_vertices


def surface_point_distances(
    mesh: Mesh, faces_a: np.ndarray, weights_a: np.ndarray, faces_b: np.ndarray, weights_b: np.ndarray
) -> np.ndarray:
    """Return the distance along the surface from point ``a[i]`` to point ``b[i]``, in the mesh's own unit.

    It is the shorter of two paths: the straight line across up to 16 unfolded edges, which is exact, and the shortest
    path in :func:`kfmaps.geometry.geodesic_graph.geodesic_graph` between vertices to which straight lines lead.

    ``mesh``: a surface; ``faces_a (q,)`` and ``faces_b (q,)``: the faces that the points lie in; ``weights_a (q, 3)``
    and ``weights_b (q, 3)``: barycentric coordinates in them. Returns (q,): infinite on different components.
    """
    q, n = len(faces_a), len(mesh.vertices)
    first = weld_vertices(mesh)
    faces = first[mesh.faces]
    faces_a, weights_a = _check_points("a", faces_a, weights_a, q, len(faces))
    faces_b, weights_b = _check_points("b", faces_b, weights_b, q, len(faces))
    if q == 0:
        return np.zeros(0)
    # No straight line crosses a degenerate face.
    rows = np.flatnonzero(proper_faces(faces))
    number, proper = renumbering(rows, len(faces)), faces[rows]
    start, opposite = _opposite_corners(proper)
    points_a = np.einsum("qi,qij->qj", weights_a, mesh.vertices[faces[faces_a]])
    points_b = np.einsum("qi,qij->qj", weights_b, mesh.vertices[faces[faces_b]])
    straight = np.linalg.norm(points_a - points_b, axis=1)
    direct = np.where(faces_a == faces_b, straight, np.inf)  # length of the straight line over the surface
    links = []
    direct_edges = 16  # edges that a line between two points may cross; farther paths run over vertices, 0.3 % longer
    vertex_edges = 4  # edges that a line from a point to a vertex may cross
    for is_a, nodes, faces_of, points in (
        (True, n + np.arange(q), faces_a, points_a),
        (False, n + q + np.arange(q), faces_b, points_b),
    ):
        corners = faces[faces_of]
        distances = np.linalg.norm(mesh.vertices[corners] - points[:, None], axis=2)
        links.append((np.repeat(nodes, 3), corners.ravel(), distances.ravel()))
        index = np.flatnonzero(number[faces_of] >= 0)
        windows = _point_windows(mesh.vertices, proper, number[faces_of[index]], points[index], index)
        for depth in range(direct_edges if is_a else vertex_edges):
            if is_a:
                _shorten_direct(direct, mesh.vertices, proper, start, opposite, windows, number[faces_b], weights_b)
            windows, source, vertex, distance = _cross_edges(mesh.vertices, proper, start, opposite, windows)
            if depth < vertex_edges:
                links.append((nodes[source], vertex, distance))
            if is_a:  # windows that are farther than any useful line are dropped
                likely = 2 * straight + 1e-12 * straight.max(initial=1.0)
                limit = np.where(np.isfinite(direct), direct, likely)
                windows = windows[_window_distances(windows) < 1.5 * limit[windows.source]]
    edges = coo_array(geodesic_graph(mesh))
    graph = join_links([(edges.row, edges.col, edges.data), *links], n + 2 * q)
    nodes_a = n + np.arange(q)
    return np.minimum(direct, shortest_paths(graph, nodes_a, nodes_a + q, straight))


def _check_points(
    name: str, faces: np.ndarray, weights: np.ndarray, q: int, n_faces: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the faces (q,) and barycentric coordinates (q, 3) of the points ``name``, when they fit the mesh."""
    faces = np.asarray(faces)
    check(np.asarray(weights), f"weights of {name}", shape=(q, 3), remedy="give three per point")
    if faces.shape != (q,) or (q and (faces.min() < 0 or faces.max() >= n_faces)):
        got = f"shape {faces.shape}" if faces.shape != (q,) else f"{faces.min()} to {faces.max()}"
        raise refuse(f"faces of {name}", f"{q} numbers from 0 to {n_faces - 1}", got, "check the mesh")
    weights = np.clip(np.asarray(weights, dtype=np.float64), 0, None)
    return faces.astype(np.int64), weights / weights.sum(axis=1, keepdims=True)


def _window_distances(w: _Windows) -> np.ndarray:
    """Return the distances of the windows' edges from their sources."""
    edge = w.left_at - w.right_at
    length = np.maximum((edge**2).sum(axis=1), np.finfo(float).tiny)
    along = np.clip(-(w.right_at * edge).sum(axis=1) / length, 0, 1)
    return np.linalg.norm(w.right_at + along[:, None] * edge, axis=1)


def _point_windows(
    vertices: np.ndarray, faces: np.ndarray, faces_of: np.ndarray, points: np.ndarray, sources: np.ndarray
) -> _Windows:
    """Return the windows from ``points (m, 3)`` in the faces ``faces_of (m,)`` through the three edges."""
    corners = faces[faces_of]
    a = vertices[corners[:, 1]] - vertices[corners[:, 0]]
    normal = np.cross(a, vertices[corners[:, 2]] - vertices[corners[:, 0]])
    x = unit_rows(a)
    y = np.cross(unit_rows(normal), x)
    offsets = vertices[corners] - points[:, None]
    at = np.stack([np.einsum("mij,mj->mi", offsets, x), np.einsum("mij,mj->mi", offsets, y)], axis=2)
    columns = []
    for i, r, s in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        columns.append((sources, 3 * faces_of + i, corners[:, r], corners[:, s], at[:, r], at[:, s]))
    source, edge, right, left, right_at, left_at = (np.concatenate(parts) for parts in zip(*columns, strict=True))
    has_angle = _cross(right_at, left_at) > 0
    return _Windows(source, edge, right, left, right_at, left_at, right_at, left_at)[has_angle]


def _shorten_direct(
    direct: np.ndarray,
    vertices: np.ndarray,
    faces: np.ndarray,
    start: np.ndarray,
    opposite: np.ndarray,
    windows: _Windows,
    faces_b: np.ndarray,
    weights_b: np.ndarray,
) -> None:
    """Lower the lengths ``direct (q,)`` of lines whose ends ``faces_b (q,)``, ``weights_b (q, 3)`` are visible now."""
    index, corner = _next_faces(start, opposite, windows)
    hit = np.flatnonzero(corner // 3 == faces_b[windows.source[index]])
    if len(hit) == 0:
        return
    w, corner = windows[index[hit]], corner[hit]
    face = faces[corner // 3]
    apex = face[np.arange(len(face)), corner % 3]
    apex_at = _unfold(vertices, w, apex)
    weights = weights_b[w.source]
    at = np.zeros_like(apex_at)
    for vertex, vertex_at in ((w.right, w.right_at), (w.left, w.left_at), (apex, apex_at)):
        at += (weights * (face == vertex[:, None])).sum(axis=1)[:, None] * vertex_at
    slack = 1e-12 * (at**2).sum(axis=1)
    is_visible = (_cross(w.low, at) >= -slack) & (_cross(at, w.high) >= -slack)
    np.minimum.at(direct, w.source[is_visible], np.linalg.norm(at[is_visible], axis=1))
