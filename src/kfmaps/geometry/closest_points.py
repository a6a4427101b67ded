"""Closest points on triangles: in space, and in any dimension from inner products alone."""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np
from scipy.sparse import csr_array

from kfmaps._arrays import check, refuse


@dataclass(frozen=True, eq=False)
class ClosestPoints:
    """Points on a surface and their distances from the queries."""

    faces: np.ndarray  # (q,)
    weights: np.ndarray  # (q, 3): barycentric coordinates in the face: not negative, with sum 1
    points: np.ndarray  # (q, 3)
    distances: np.ndarray  # (q,)


def closest_points(points: np.ndarray, vertices: np.ndarray, faces: np.ndarray) -> ClosestPoints:
    """Return the closest point on a surface to each of some points, by libigl's search tree.

    ``points (q, 3)``; ``vertices (n, 3)``; ``faces (f, 3)``, possibly without area. Any of several faces at the same
    distance may be returned.
    """
    if len(faces) == 0:
        raise refuse("mesh", "a surface with faces", "a point cloud", "triangulate it first")
    check(points, "points")
    check(vertices, "vertices")
    nearest = np.asarray(igl.point_mesh_squared_distance(points, vertices, faces)[1], dtype=np.int64)
    return closest_among(points, vertices, faces, nearest.reshape(-1), np.arange(len(points)))


def closest_among(
    points: np.ndarray, vertices: np.ndarray, faces: np.ndarray, candidates: np.ndarray, owner: np.ndarray
) -> ClosestPoints:
    """Return the closest point to each of some points on given faces.

    ``points (q, 3)``; ``vertices (n, 3)``; ``faces (f, 3)``; ``candidates (m,)``: rows of ``faces``; ``owner (m,)``:
    the point of each candidate, ascending, every point at least once. The first of several candidates at the same
    distance is returned.
    """
    # Stored coordinate by coordinate, (3, m).
    x, (i, j, k) = np.ascontiguousarray(vertices.T), faces[candidates].T
    a, u, v = (x.take(corner, axis=1) for corner in (i, j, k))
    r = np.ascontiguousarray(points.T).take(owner, axis=1)
    for edge in (u, v, r):
        edge -= a
    pairs = (u, u), (u, v), (v, v), (r, u), (r, v), (r, r)
    *dots, squares = (np.einsum("im,im->m", *pair) for pair in pairs)
    s, t, gain = closest_weights(*dots)
    squared = np.maximum(squares - gain, 0.0)
    hits = first_minima(squared, owner)
    s, t = s[hits], t[hits]
    closest = np.ascontiguousarray((a[:, hits] + s * u[:, hits] + t * v[:, hits]).T)
    return ClosestPoints(candidates[hits], barycentric_weights(s, t), closest, np.sqrt(squared[hits]))


def closest_weights(
    e11: np.ndarray, e12: np.ndarray, e22: np.ndarray, r1: np.ndarray, r2: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the point of each triangle ``a, b, c`` that is closest to a point ``q``, from inner products.

    ``e11 (m,)``, ``e12 (m,)`` and ``e22 (m,)``: ``u·u``, ``u·v`` and ``v·v`` of the edges ``u = b − a`` and ``v = c −
    a``; ``r1 (m,)`` and ``r2 (m,)``: ``(q − a)·u`` and ``(q − a)·v``. Returns ``s, t (m,)``: the point is ``a + s u + t
    v``, with ``s, t ≥ 0`` and ``s + t ≤ 1``; ``gain (m,)``: by how much it is closer than ``a``, in squared distance:
    at least 0.
    """
    tiny = np.finfo(np.float64).tiny
    det = e11 * e22 - e12 * e12
    inverse = 1.0 / np.maximum(det, tiny)
    s, t = (e22 * r1 - e12 * r2) * inverse, (e11 * r2 - e12 * r1) * inverse
    outside = np.flatnonzero((np.minimum(s, t) < 0) | (s + t > 1) | (det <= 1e-14 * e11 * e22))
    if len(outside):
        # The closest point lies on an edge.
        a11, a12, a22, p, q = (x[outside] for x in (e11, e12, e22, r1, r2))
        on_u = np.clip(p / np.maximum(a11, tiny), 0, 1)
        on_v = np.clip(q / np.maximum(a22, tiny), 0, 1)
        length = a11 - 2 * a12 + a22
        across = np.clip((q - p + a11 - a12) / np.maximum(length, tiny), 0, 1)
        by_u, by_v = on_u * (2 * p - on_u * a11), on_v * (2 * q - on_v * a22)
        beyond = _gain(1 - across, across, a11, a12, a22, p, q) > np.maximum(by_u, by_v)
        first = by_u >= by_v
        s[outside] = np.where(beyond, 1 - across, np.where(first, on_u, 0.0))
        t[outside] = np.where(beyond, across, np.where(first, 0.0, on_v))
    return s, t, _gain(s, t, e11, e12, e22, r1, r2)


def _gain(s, t, e11, e12, e22, r1, r2):
    return 2 * (s * r1 + t * r2) - (s * s * e11 + 2 * s * t * e12 + t * t * e22)


def barycentric_weights(s: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Return the weights (m, 3) of the corners of ``a + s u + t v``, not negative and with sum 1."""
    weights = np.clip(np.stack([1 - s - t, s, t], axis=1), 0, 1)
    return weights / weights.sum(axis=1, keepdims=True)


def barycentric_matrix(face_of: np.ndarray, weights: np.ndarray, faces: np.ndarray, n: int) -> csr_array:
    """Return the sparse matrix ``(q, n)`` that interpolates values at vertices to points inside triangles.

    ``face_of (q,)``: the face that each point lies in; ``weights (q, 3)``: its barycentric coordinates; ``faces (f,
    3)``; ``n``: number of vertices.
    """
    q = len(face_of)
    return csr_array((weights.ravel(), faces[face_of].ravel(), 3 * np.arange(q + 1)), shape=(q, n))


def first_minima(values: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """Return the first entry with the least value of each owner, (q,) int64.

    ``values (m,)``; ``owner (m,)``: ascending, every owner at least once.
    """
    first = np.flatnonzero(np.diff(owner, prepend=-1))
    least = np.minimum.reduceat(values, first)
    hits = np.flatnonzero(values == np.repeat(least, np.diff(np.append(first, len(owner)))))
    return hits[np.flatnonzero(np.diff(owner[hits], prepend=-1))]
