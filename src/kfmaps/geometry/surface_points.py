"""Distances along a surface between points inside its triangles."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array

from kfmaps._arrays import check, refuse
from kfmaps.geometry.clean import weld_vertices
from kfmaps.geometry.connectivity import proper_faces
from kfmaps.geometry.geodesic_graph import (
    _corners_behind,
    _cross,
    _crossed,
    _neighbours,
    _unfolded,
    _Windows,
    geodesic_graph,
    join_links,
)
from kfmaps.geometry.geodesics import shortest_paths
from kfmaps.geometry.mesh import Mesh, unit_rows

_VERTEX_EDGES = 4  # edges that a straight line from a point to a vertex may cross


def surface_point_distances(
    mesh: Mesh, faces_a: np.ndarray, weights_a: np.ndarray, faces_b: np.ndarray, weights_b: np.ndarray
) -> np.ndarray:
    """Return the distance along the surface from point ``a[i]`` to point ``b[i]``, in the mesh's own unit.

    It is the shorter of the straight line from one to the other over up to 16 unfolded edges, which is exact, and the
    shortest path over vertices (:func:`kfmaps.geometry.geodesic_graph.geodesic_graph`) that both see in straight lines.

    ``mesh``: a surface; ``faces_a (q,)`` and ``faces_b (q,)``: the faces that the points lie in; ``weights_a (q, 3)``
    and ``weights_b (q, 3)``: barycentric coordinates in them. Returns (q,): infinite on different components.
    """
    q, n = len(faces_a), len(mesh.vertices)
    first = weld_vertices(mesh)
    faces = first[mesh.faces]
    sides = [_checked("a", faces_a, weights_a, q, len(faces)), _checked("b", faces_b, weights_b, q, len(faces))]
    if q == 0:
        return np.zeros(0)
    # Faces that name a vertex twice are lines: crossing them leads nowhere.
    whole = np.flatnonzero(proper_faces(faces))
    start, twins = _neighbours(faces[whole])
    number = np.full(len(faces), -1)
    number[whole] = np.arange(len(whole))
    inner = faces[whole]
    places = [np.einsum("qi,qij->qj", w, mesh.vertices[faces[f]]) for f, w in sides]
    straight = np.where(sides[0][0] == sides[1][0], np.linalg.norm(places[0] - places[1], axis=1), np.inf)
    links = []
    # Edges that a straight line from one point to the other may cross: farther ones go over vertices, at 0.3 % more.
    direct_edges = 16
    for side, ((chosen, _), points) in enumerate(zip(sides, places, strict=True)):
        corners = faces[chosen]
        away = np.linalg.norm(mesh.vertices[corners] - points[:, None], axis=2)
        here = n + side * q + np.arange(q)
        links.append((np.repeat(here, 3), corners.ravel(), away.ravel()))
        inside_ = np.flatnonzero(number[chosen] >= 0)
        windows = _views(mesh.vertices, inner, number[chosen[inside_]], points[inside_], inside_)
        for depth in range(_VERTEX_EDGES if side else direct_edges):
            if side == 0:
                _met(straight, mesh.vertices, inner, start, twins, windows, number[sides[1][0]], sides[1][1])
            windows, *seen = _crossed(mesh.vertices, inner, start, twins, windows)
            if depth < _VERTEX_EDGES:
                links.append((n + side * q + seen[0], seen[1], seen[2]))
            if side == 0:
                near = np.minimum(_nearest(windows), np.inf)
                windows = windows[near < 1.5 * _limit(straight, places)[windows.source]]
    edges = coo_array(geodesic_graph(mesh))
    graph = join_links([(edges.row, edges.col, edges.data), *links], n + 2 * q)
    here, apart = n + np.arange(q), np.linalg.norm(places[0] - places[1], axis=1)
    return np.minimum(straight, shortest_paths(graph, here, here + q, apart))


def _checked(name: str, chosen: np.ndarray, weights: np.ndarray, q: int, n_faces: int) -> tuple[np.ndarray, np.ndarray]:
    """The faces (q,) and barycentric coordinates (q, 3) of the points ``name``, when they fit the mesh."""
    chosen = np.asarray(chosen)
    check(np.asarray(weights), f"weights of {name}", shape=(q, 3), remedy="give three per point")
    if chosen.shape != (q,) or (q and (chosen.min() < 0 or chosen.max() >= n_faces)):
        got = f"shape {chosen.shape}" if chosen.shape != (q,) else f"{chosen.min()} to {chosen.max()}"
        raise refuse(f"faces of {name}", f"{q} numbers from 0 to {n_faces - 1}", got, "check the mesh")
    weights = np.clip(np.asarray(weights, dtype=np.float64), 0, None)
    return chosen.astype(np.int64), weights / weights.sum(axis=1, keepdims=True)


def _limit(straight: np.ndarray, places: list[np.ndarray]) -> np.ndarray:
    """How far the direct line can be of use: what is found, or what is likely."""
    apart = np.linalg.norm(places[0] - places[1], axis=1)
    return np.where(np.isfinite(straight), straight, 2 * apart + 1e-12 * apart.max(initial=1.0))


def _nearest(w: _Windows) -> np.ndarray:
    """Distance of the windows' edges from their source, at the origin."""
    edge = w.left_at - w.right_at
    length = np.maximum((edge**2).sum(axis=1), np.finfo(float).tiny)
    along = np.clip(-(w.right_at * edge).sum(axis=1) / length, 0, 1)
    return np.linalg.norm(w.right_at + along[:, None] * edge, axis=1)


def _views(
    vertices: np.ndarray, faces: np.ndarray, chosen: np.ndarray, points: np.ndarray, label: np.ndarray
) -> _Windows:
    """What ``points (m, 3)`` in the faces ``chosen (m,)`` see through the three edges; sources are ``label (m,)``."""
    corners = faces[chosen]
    a = vertices[corners[:, 1]] - vertices[corners[:, 0]]
    normal = np.cross(a, vertices[corners[:, 2]] - vertices[corners[:, 0]])
    one = unit_rows(a)
    two = np.cross(unit_rows(normal), one)
    gap = vertices[corners] - points[:, None]
    flat = np.stack([np.einsum("mij,mj->mi", gap, one), np.einsum("mij,mj->mi", gap, two)], axis=2)
    rows = [[], [], [], [], [], []]
    for i in range(3):
        r, s = (i + 1) % 3, (i + 2) % 3
        for row, part in zip(
            rows, (label, 3 * chosen + i, corners[:, r], corners[:, s], flat[:, r], flat[:, s]), strict=True
        ):
            row.append(part)
    source, edge, right, left, right_at, left_at = (np.concatenate(row) for row in rows)
    seen = _cross(right_at, left_at) > 0
    return _Windows(source, edge, right, left, right_at, left_at, right_at, left_at)[seen]


def _met(
    best: np.ndarray,
    vertices: np.ndarray,
    faces: np.ndarray,
    start: np.ndarray,
    twins: np.ndarray,
    windows: _Windows,
    there: np.ndarray,
    weights: np.ndarray,
) -> None:
    """Lower ``best (q,)`` where the face behind a window is ``there (q,)`` and its point, ``weights``, is in sight."""
    index, corner = _corners_behind(start, twins, windows)
    hit = np.flatnonzero(corner // 3 == there[windows.source[index]])
    if len(hit) == 0:
        return
    w, corner = windows[index[hit]], corner[hit]
    face = faces[corner // 3]
    apex = face[np.arange(len(face)), corner % 3]
    at = _unfolded(vertices, w, apex)
    share = weights[w.source]
    place = np.zeros_like(at)
    for which, where in ((w.right, w.right_at), (w.left, w.left_at), (apex, at)):
        place += (share * (face == which[:, None])).sum(axis=1)[:, None] * where
    slack = 1e-12 * (place**2).sum(axis=1)
    seen = (_cross(w.low, place) >= -slack) & (_cross(place, w.high) >= -slack)
    np.minimum.at(best, w.source[seen], np.linalg.norm(place[seen], axis=1))
