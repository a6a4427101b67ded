"""Closest points on triangles: in space, and in any dimension from squared distances alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

NEAR = 8
"""Faces that are looked at first; four times as many again and again where these cannot settle it."""


def closest_weights(
    e11: np.ndarray, e12: np.ndarray, e22: np.ndarray, r1: np.ndarray, r2: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The point of each triangle ``a, b, c`` that is closest to a point ``q``, from inner products.

    Parameters
    ----------
    e11, e12, e22 : (m,) float64
        ``u·u``, ``u·v`` and ``v·v`` of the edges ``u = b − a`` and ``v = c − a``.
    r1, r2 : (m,) float64
        ``(q − a)·u`` and ``(q − a)·v``.

    Returns
    -------
    s, t : (m,) float64
        The point is ``a + s u + t v``, with ``s, t ≥ 0`` and ``s + t ≤ 1``.
    gain : (m,) float64
        By how much it is closer than ``a``, in squared distance: at least 0.
    """
    tiny = np.finfo(np.float64).tiny
    det = e11 * e22 - e12 * e12
    safe = np.maximum(det, tiny)
    s, t = (e22 * r1 - e12 * r2) / safe, (e11 * r2 - e12 * r1) / safe
    outside = np.flatnonzero((s < 0) | (t < 0) | (s + t > 1) | (det <= 1e-14 * e11 * e22))
    if len(outside):
        # Then it lies on an edge: the best of the three.
        a11, a12, a22, p, q = (x[outside] for x in (e11, e12, e22, r1, r2))
        on_u = np.clip(p / np.maximum(a11, tiny), 0, 1)
        on_v = np.clip(q / np.maximum(a22, tiny), 0, 1)
        length = a11 - 2 * a12 + a22
        across = np.clip((q - p + a11 - a12) / np.maximum(length, tiny), 0, 1)
        zero = np.zeros_like(on_u)
        choices = np.stack([on_u, zero, 1 - across]), np.stack([zero, on_v, across])
        gains = _gain(choices[0], choices[1], a11, a12, a22, p, q)
        best = gains.argmax(axis=0)
        each = np.arange(len(outside))
        s[outside], t[outside] = choices[0][best, each], choices[1][best, each]
    return s, t, _gain(s, t, e11, e12, e22, r1, r2)


def _gain(s, t, e11, e12, e22, r1, r2):
    return 2 * (s * r1 + t * r2) - (s * s * e11 + 2 * s * t * e12 + t * t * e22)


@dataclass(frozen=True, eq=False)
class VertexRings:
    """The faces around each vertex: those of vertex ``i`` are ``faces[start[i]:start[i + 1]]``."""

    start: np.ndarray
    faces: np.ndarray

    def around(self, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """All faces around each of ``vertices (m,)``, and which entry of ``vertices`` each is for."""
        count = self.start[vertices + 1] - self.start[vertices]
        owner = np.repeat(np.arange(len(vertices)), count)
        first = np.cumsum(count) - count
        return self.faces[np.arange(len(owner)) + np.repeat(self.start[vertices] - first, count)], owner


def vertex_rings(faces: np.ndarray, n: int) -> VertexRings:
    """The faces ``(f, 3)`` around each of ``n`` vertices."""
    corners = faces.ravel()
    order = np.argsort(corners, kind="stable")
    start = np.concatenate([[0], np.cumsum(np.bincount(corners, minlength=n))])
    return VertexRings(start, order // 3)


@dataclass(frozen=True, eq=False)
class ClosestPoints:
    """Points on a surface: a face and barycentric weights for each, and how far they are from what was asked.

    Attributes
    ----------
    faces : (q,) int64
    weights : (q, 3) float64
        Not negative, sum 1.
    points : (q, 3) float64
    distances : (q,) float64
    """

    faces: np.ndarray
    weights: np.ndarray
    points: np.ndarray
    distances: np.ndarray


def closest_among(
    points: np.ndarray, vertices: np.ndarray, faces: np.ndarray, candidates: np.ndarray, owner: np.ndarray
) -> ClosestPoints:
    """The closest place to each of ``points (q, 3)`` among ``candidates (m,)``, faces of the point ``owner (m,)``.

    ``owner`` ascends and names every point at least once.
    """
    corners = faces[candidates]
    a = vertices[corners[:, 0]]
    u, v, r = vertices[corners[:, 1]] - a, vertices[corners[:, 2]] - a, points[owner] - a
    dot = [np.einsum("ij,ij->i", x, y) for x, y in ((u, u), (u, v), (v, v), (r, u), (r, v), (r, r))]
    s, t, gain = closest_weights(*dot[:5])
    squared = np.maximum(dot[5] - gain, 0.0)
    first = np.flatnonzero(np.diff(owner, prepend=-1))
    least = np.minimum.reduceat(squared, first)
    hits = np.flatnonzero(squared == np.repeat(least, np.diff(np.append(first, len(owner)))))
    hits = hits[np.flatnonzero(np.diff(owner[hits], prepend=-1))]
    s, t = s[hits], t[hits]
    places = a[hits] + s[:, None] * u[hits] + t[:, None] * v[hits]
    weights = np.stack([1 - s - t, s, t], axis=1)
    np.clip(weights, 0, 1, out=weights)
    return ClosestPoints(candidates[hits], weights / weights.sum(axis=1, keepdims=True), places, np.sqrt(least))


def closest_points(points: np.ndarray, vertices: np.ndarray, faces: np.ndarray) -> ClosestPoints:
    """The closest place on a surface to each of ``points (q, 3)``; exact.

    Faces are sought by their centres: no face comes nearer than its centre less its radius. Faces of like size are
    sought together, so that a few large ones do not spoil the bound of the others.
    """
    corners = vertices[faces]
    centres = corners.mean(axis=1)
    radii = np.linalg.norm(corners - centres[:, None], axis=2).max(axis=1)
    least = max(float(radii.max()) * 1e-3, np.finfo(float).tiny)
    octave = np.floor(np.log2(np.maximum(radii, least))).astype(np.int64)
    best = ClosestPoints(
        np.zeros(len(points), dtype=np.int64),
        np.zeros((len(points), 3)),
        np.zeros((len(points), 3)),
        np.full(len(points), np.inf),
    )
    sizes, counts = np.unique(octave, return_counts=True)
    for size in sizes[np.argsort(-counts)]:
        _improve(best, points, vertices, faces, np.flatnonzero(octave == size), centres, radii)
    return best


def _improve(
    best: ClosestPoints,
    points: np.ndarray,
    vertices: np.ndarray,
    faces: np.ndarray,
    chosen: np.ndarray,
    centres: np.ndarray,
    radii: np.ndarray,
) -> None:
    """Enter into ``best`` what is closer on the ``chosen`` faces, (c,)."""
    tree, radius, near = KDTree(centres[chosen]), float(radii[chosen].max()), min(NEAR, len(chosen))
    left = np.arange(len(points))
    while len(left):
        limit = best.distances[left] + radius
        away, index = tree.query(points[left], k=near, distance_upper_bound=float(limit.max()) * (1 + 1e-9))
        away, index = np.reshape(away, (len(left), near)), np.reshape(index, (len(left), near))
        inside = away <= limit[:, None]
        some = np.flatnonzero(inside.any(axis=1))
        if len(some):
            owner = np.repeat(np.arange(len(some)), inside[some].sum(axis=1))
            found = closest_among(points[left[some]], vertices, faces, chosen[index[inside]], owner)
            nearer = np.flatnonzero(found.distances < best.distances[left[some]])
            for name in ("faces", "weights", "points", "distances"):
                getattr(best, name)[left[some[nearer]]] = getattr(found, name)[nearer]
        if near == len(chosen):
            return
        left = left[away[:, -1] < best.distances[left] + radius]
        near = min(4 * near, len(chosen))
