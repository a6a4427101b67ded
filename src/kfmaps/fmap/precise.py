"""Points inside triangles: a map finer than the source's vertices.

The exact nearest point of the source's *surface* in the spectral embedding, where vertices are rows of functions and
triangles are flat between them (Ezuz and Ben-Chen, Deblurring and denoising of maps between shapes, 2017).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, blocks, check, refuse, to_numpy
from kfmaps._records import short_repr
from kfmaps._threads import parallel
from kfmaps.fmap.convert import embed
from kfmaps.fmap.nearest import EXACT_PAIRS, nearest
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.closest_points import barycentric_weights, closest_points, closest_weights, first_minima
from kfmaps.geometry.connectivity import VertexRings, vertex_rings
from kfmaps.geometry.mesh import Mesh


@dataclass(frozen=True, eq=False)
class PointMap:
    """A point on the source's surface for each target vertex.

    Attributes
    ----------
    faces : (n_t,) int64
        The source face that it lies on.
    weights : (n_t, 3) float64
        Its barycentric coordinates there: not negative, sum 1.
    """

    faces: np.ndarray
    weights: np.ndarray

    __repr__ = short_repr


def check_point_map_precise(places: PointMap, source: Mesh, n_t: int | None = None) -> PointMap:
    """Return a point map when it lies on faces of the source.

    ``n_t``: number of target vertices, where it is to be checked.
    """
    faces, weights = np.asarray(places.faces), np.asarray(places.weights, dtype=np.float64)
    remedy = "check that the map belongs to these two meshes, in this order"
    check(faces, "faces of the map", shape=(n_t,), remedy=remedy)
    check(weights, "weights of the map", shape=(len(faces), 3), remedy=remedy)
    if faces.dtype.kind not in "iu" or (len(faces) and (faces.min() < 0 or faces.max() >= len(source.faces))):
        got = f"{faces.dtype} {faces.min()} to {faces.max()}" if len(faces) else str(faces.dtype)
        raise refuse("faces of the map", f"faces from 0 to {len(source.faces) - 1}", got, remedy)
    if len(weights) and (weights.min() < 0 or np.abs(weights.sum(axis=1) - 1).max() > 1e-6):
        got = f"{weights.min():g} and more, sums off by up to {np.abs(weights.sum(axis=1) - 1).max():g}"
        raise refuse("weights of the map", "numbers of at least 0 with sum 1", got, "divide each row by its sum")
    return PointMap(faces.astype(np.int64), weights)


def point_positions(places: PointMap, source: Mesh) -> np.ndarray:
    """Return where the points of a map lie in space, (n_t, 3), in the source's unit."""
    return np.einsum("ti,tij->tj", places.weights, source.vertices[source.faces[places.faces]])


def nearest_vertices(places: PointMap, source: Mesh) -> np.ndarray:
    """Return the corner of its face that is nearest to each point, ``target_to_source (n_t,)``."""
    corners = source.faces[places.faces]
    away = np.linalg.norm(source.vertices[corners] - point_positions(places, source)[:, None], axis=2)
    return corners[np.arange(len(corners)), away.argmin(axis=1)].astype(np.int64)


def vertex_point_map(target_to_source: np.ndarray, source: Mesh) -> PointMap:
    """Return a map ``(n_t,)`` to vertices as one to points: each in a corner of some face that has the vertex."""
    face, corner = np.full(len(source.vertices), -1), np.zeros(len(source.vertices), dtype=np.int64)
    face[source.faces.ravel()] = np.repeat(np.arange(len(source.faces)), 3)
    corner[source.faces.ravel()] = np.tile(np.arange(3), len(source.faces))
    chosen = face[target_to_source]
    if len(chosen) and chosen.min() < 0:
        bare = int(target_to_source[chosen.argmin()])
        raise refuse("target_to_source", "vertices of faces", f"vertex {bare}, which no face uses", "remove it")
    return PointMap(chosen, np.eye(3)[corner[target_to_source]])


def to_precise_map(
    C: Array,
    source: Basis,
    target: Basis,
    faces_s: np.ndarray,
    beside: tuple[Array, Array] | None = None,
) -> PointMap:
    """Return the closest points of the source's surface in the spectral embedding, for all target vertices.

    ``C (k_t, k_s)``; ``faces_s (f, 3)``: of the source, triangles between the rows of ``Φ_s Cᵀ``; ``beside``: as for
    :func:`kfmaps.fmap.convert.to_points`.
    """
    points, queries = (np.asarray(to_numpy(x), dtype=np.float64) for x in embed(C, source, target, beside))
    return nearest_surface_points(queries, points, faces_s)


def nearest_surface_points(
    queries: np.ndarray, points: np.ndarray, faces: np.ndarray, exact: bool | None = None
) -> PointMap:
    """Return the closest point of some triangles to each query, in any dimension.

    For a point ``x = Σ w_i v_i`` of a triangle ``|q − x|² = Σ w_i |q − v_i|² − Σ_{i<j} w_i w_j |v_i − v_j|²``. The last
    sum is at most the squared radius of the smallest ball around the triangle. So a triangle can only beat the closest
    vertex when one of its corners is no farther, in squared distance, than that vertex and this radius together, and
    only these few are looked at. All inner products follow from squared distances; those of the triangles that float32
    leaves in doubt are found again in float64.

    ``queries (q, d)`` and ``points (p, d)``; ``faces (f, 3)``. ``exact``: by default while queries times points are at
    most ``EXACT_PAIRS``. Otherwise the nearest vertices are sought approximately, and only triangles of their
    neighbours are looked at.
    """
    check(queries, "queries", shape=(None, points.shape[1]))
    check(points, "points", shape=(None, None))
    around = vertex_rings(faces, len(points))
    edges = (points[faces[:, j]] - points[faces[:, i]] for i, j in ((0, 1), (0, 2), (1, 2)))
    lengths = np.stack([(edge**2).sum(axis=1) for edge in edges], axis=1)
    if exact is False or (exact is None and len(queries) * len(points) > EXACT_PAIRS):
        return _among_neighbours(queries, points, faces, lengths, around)
    middle = points.mean(axis=0)
    y = (points - middle).astype(np.float32)
    squares = np.einsum("ij,ij->i", y, y)
    reach = np.zeros(len(points), dtype=np.float32)
    np.maximum.at(reach, faces.ravel(), np.repeat(_ball(lengths), 3).astype(np.float32))
    reach[np.diff(around.start) == 0] = -np.inf
    # What float32 may be off by: (d + 4) u times the sizes of the factors (Higham 2002, section 3.1).
    noise = 4 * (points.shape[1] + 4) * 2.0**-24

    def search(rows: slice) -> tuple[np.ndarray, np.ndarray]:
        x = (queries[rows] - middle).astype(np.float32)
        own = np.einsum("ij,ij->i", x, x)
        away = x @ y.T
        away *= -2
        away += squares
        away += own[:, None]
        used = np.where(reach >= 0, away, np.inf) if np.isinf(reach).any() else away
        slack = noise * (own + squares.max())
        bound = used.min(axis=1) + slack
        away -= reach
        query, vertex = np.nonzero(away < bound[:, None])
        candidates, entry = around.around(vertex)
        return candidates, rows.start + query[entry]

    parts = parallel(search, blocks(len(queries), 256))
    best = [_settled(queries, points, faces, lengths, *part) for part in parts]
    return PointMap(np.concatenate([b[0] for b in best]), np.concatenate([b[1] for b in best]))


def _ball(lengths: np.ndarray) -> np.ndarray:
    """Squared radius of the smallest ball around triangles with squared edge ``lengths (f, 3)``."""
    a, b, c = np.sort(lengths, axis=1).T
    # 16 area² by Heron; acute triangles have their circumscribed circle, others half of the longest edge.
    area = 2 * (a * b + b * c + c * a) - (a * a + b * b + c * c)
    acute = (a + b > c) & (area > 0)
    return np.where(acute, np.divide(a * b * c, area, out=np.zeros_like(area), where=acute), c / 4)


def _settled(
    queries: np.ndarray,
    points: np.ndarray,
    faces: np.ndarray,
    lengths: np.ndarray,
    candidates: np.ndarray,
    owner: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """The closest place of each query among its ``candidates (m,)``; ``owner (m,)`` ascends. Faces and weights."""
    # Each face once for a query, though several of its corners named it.
    keys = np.unique(owner * np.int64(len(faces)) + candidates)
    owner, candidates = keys // len(faces), keys % len(faces)
    corners = faces[candidates]
    pairs, entry = np.unique(owner[:, None] * np.int64(len(points)) + corners, return_inverse=True)
    q, v = pairs // len(points), pairs % len(points)
    away = np.empty(len(pairs))
    for part in range(0, len(pairs), 50_000):
        rows = slice(part, part + 50_000)
        gap = queries[q[rows]] - points[v[rows]]
        away[rows] = np.einsum("ij,ij->i", gap, gap)
    a, b, c = away[entry.reshape(-1, 3)].T
    ab, ac, bc = lengths[candidates].T
    s, t, gain = closest_weights(ab, (ab + ac - bc) / 2, ac, (a + ab - b) / 2, (a + ac - c) / 2)
    hits = first_minima(a - gain, owner)
    return candidates[hits], barycentric_weights(s[hits], t[hits])


def _among_neighbours(
    queries: np.ndarray,
    points: np.ndarray,
    faces: np.ndarray,
    lengths: np.ndarray,
    around: VertexRings,
) -> PointMap:
    """Around the nearest vertex: the faces of that vertex, then of the corners of the best, until nothing is better."""
    used = np.flatnonzero(np.diff(around.start))
    vertex = used[nearest(queries, points[used])]
    best, weights = np.zeros(len(queries), dtype=np.int64), np.zeros((len(queries), 3))
    for part in range(0, len(queries), 4096):
        rows = np.arange(part, min(part + 4096, len(queries)))
        ring, owner = around.around(vertex[rows])
        further, entry = around.around(faces[ring].ravel())
        owner = np.repeat(owner, 3)[entry]
        order = np.argsort(owner, kind="stable")
        best[rows], weights[rows] = _settled(queries, points, faces, lengths, further[order], rows[owner[order]])
    return PointMap(best, weights)


def invert_precise_map(places: PointMap, source: Mesh, target: Mesh, known: np.ndarray | None = None) -> PointMap:
    """Return the map the other way: a point on the target for each source vertex.

    The target's faces lie, flat between the images of their corners, on or near the source; each source vertex takes
    the closest place on them. Where the map is one-to-one that is its inverse; parts that nothing is mapped to get the
    nearest that something is.

    ``places``: for each target vertex; ``known (n_t,)``: only faces whose corners all are known count.
    """
    places = check_point_map_precise(places, source, len(target.vertices))
    rows = np.arange(len(target.faces)) if known is None else np.flatnonzero(known[target.faces].all(axis=1))
    if len(rows) == 0:
        raise refuse("map", "a face of the target with a counterpart", "none", "carry values of the source instead")
    found = closest_points(source.vertices, point_positions(places, source), target.faces[rows])
    return PointMap(rows[found.faces], found.weights)
