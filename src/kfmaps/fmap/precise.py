"""Points inside triangles: a map finer than the source's vertices.

It is the closest point of the source's *surface* in the spectral embedding, where vertices are rows of functions and
triangles are flat (Ezuz and Ben-Chen, Deblurring and denoising of maps between shapes, 2017).
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

    Examples
    --------
    >>> pair = kfmaps.datasets.two_poses(1500)
    >>> exact = kfmaps.PointMap(pair.truth_faces, pair.truth_weights)
    >>> bool(kfmaps.geodesic_errors(pair.source, exact, pair.truth).mean() < 0.02)
    True
    """

    faces: np.ndarray
    weights: np.ndarray

    __repr__ = short_repr


def check_point_map_precise(places: PointMap, source: Mesh, n_t: int | None = None) -> PointMap:
    """Return a point map when it lies on faces of the source; ``n_t``: number of target vertices, if it is known."""
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
    distances = np.linalg.norm(source.vertices[corners] - point_positions(places, source)[:, None], axis=2)
    return corners[np.arange(len(corners)), distances.argmin(axis=1)].astype(np.int64)


def vertex_point_map(target_to_source: np.ndarray, source: Mesh) -> PointMap:
    """Return a map to vertices, ``target_to_source (n_t,)``, as one to corners of faces."""
    corner = np.full(len(source.vertices), -1)  # of each vertex, numbered 3 face + i
    corner[source.faces.ravel()] = np.arange(source.faces.size)
    corners = corner[target_to_source]
    if len(corners) and corners.min() < 0:
        unused = int(target_to_source[corners.argmin()])
        raise refuse("target_to_source", "vertices of faces", f"vertex {unused}, which no face uses", "remove it")
    return PointMap(corners // 3, np.eye(3)[corners % 3])


def to_precise_map(
    C: Array, source: Basis, target: Basis, faces_s: np.ndarray, extra_columns: tuple[Array, Array] | None = None
) -> PointMap:
    """Return the closest points of the source's surface in the spectral embedding, for all target vertices.

    ``C (k_t, k_s)``; ``faces_s (f, 3)``: of the source, triangles between the rows of ``Φ_s Cᵀ``; ``extra_columns``: as
    for :func:`kfmaps.fmap.convert.to_points`.
    """
    points, queries = (np.asarray(to_numpy(x), dtype=np.float64) for x in embed(C, source, target, extra_columns))
    return nearest_surface_points(queries, points, faces_s)


def nearest_surface_points(
    queries: np.ndarray, points: np.ndarray, faces: np.ndarray, exact: bool | None = None
) -> PointMap:
    """Return the closest point of some triangles to each query, in any dimension.

    For a point ``x = Σ w_i v_i`` of a triangle ``|q − x|² = Σ w_i |q − v_i|² − Σ_{i<j} w_i w_j |v_i − v_j|²``. The last
    sum is at most the squared radius of the smallest ball around the triangle. So a triangle can only be closer than
    the closest vertex when one of its corners is at most that radius farther, in squared distance, and only these few
    candidates are compared. They are selected in float32, with a margin for its errors, and compared in float64. All
    inner products follow from squared distances.

    ``queries (q, d)`` and ``points (p, d)``; ``faces (f, 3)``. ``exact``: by default while queries times points are at
    most ``EXACT_PAIRS``. Otherwise the nearest vertices are searched approximately, and only the triangles around
    their neighbours are compared.
    """
    check(queries, "queries", shape=(None, points.shape[1]))
    check(points, "points", shape=(None, None))
    rings = vertex_rings(faces, len(points))
    edges = (points[faces[:, j]] - points[faces[:, i]] for i, j in ((0, 1), (0, 2), (1, 2)))
    squared_edges = np.stack([(edge**2).sum(axis=1) for edge in edges], axis=1)
    if exact is False or (exact is None and len(queries) * len(points) > EXACT_PAIRS):
        return _closest_around_vertices(queries, points, faces, squared_edges, rings)
    centre = points.mean(axis=0)
    y = (points - centre).astype(np.float32)
    squares_y = np.einsum("ij,ij->i", y, y)
    radii = np.zeros(len(points), dtype=np.float32)  # squared, of the largest ball around a triangle at each vertex
    np.maximum.at(radii, faces.ravel(), np.repeat(_ball_radii(squared_edges), 3).astype(np.float32))
    radii[np.diff(rings.start) == 0] = -np.inf
    # Errors in float32 are at most (d + 4) u times the sizes of the factors (Higham 2002, section 3.1).
    rounding = 4 * (points.shape[1] + 4) * 2.0**-24

    def search(rows: slice) -> tuple[np.ndarray, np.ndarray]:
        x = (queries[rows] - centre).astype(np.float32)
        squares_x = np.einsum("ij,ij->i", x, x)
        squared = x @ y.T
        squared *= -2
        squared += squares_y
        squared += squares_x[:, None]
        used = np.where(radii >= 0, squared, np.inf) if np.isinf(radii).any() else squared
        bound = used.min(axis=1) + rounding * (squares_x + squares_y.max())
        squared -= radii
        query, vertex = np.nonzero(squared < bound[:, None])
        candidates, entry = rings.around(vertex)
        return candidates, rows.start + query[entry]

    parts = parallel(search, blocks(len(queries), 256))
    closest = [_closest_candidates(queries, points, faces, squared_edges, *part) for part in parts]
    return PointMap(*(np.concatenate(arrays) for arrays in zip(*closest, strict=True)))


def _ball_radii(squared_edges: np.ndarray) -> np.ndarray:
    """Return the squared radii of the smallest balls around triangles with ``squared_edges (f, 3)``, (f,)."""
    a, b, c = np.sort(squared_edges, axis=1).T
    # 16 area² by Heron; acute triangles have their circumscribed circle, others half of the longest edge.
    area = 2 * (a * b + b * c + c * a) - (a * a + b * b + c * c)
    acute = (a + b > c) & (area > 0)
    return np.where(acute, np.divide(a * b * c, area, out=np.zeros_like(area), where=acute), c / 4)


def _closest_candidates(
    queries: np.ndarray,
    points: np.ndarray,
    faces: np.ndarray,
    squared_edges: np.ndarray,
    candidates: np.ndarray,
    owner: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Return face and weights of the point closest to each query among its candidates.

    ``candidates (m,)``: faces; ``owner (m,)``: the query of each, ascending.
    """
    # Each face once for a query, also where it is a candidate through several of its corners.
    keys = np.unique(owner * np.int64(len(faces)) + candidates)
    owner, candidates = np.divmod(keys, len(faces))
    corners = faces[candidates]
    pairs, entry = np.unique(owner[:, None] * np.int64(len(points)) + corners, return_inverse=True)
    query, vertex = np.divmod(pairs, len(points))
    squared = np.empty(len(pairs))
    for rows in blocks(len(pairs), 50_000):
        offsets = queries[query[rows]] - points[vertex[rows]]
        squared[rows] = np.einsum("ij,ij->i", offsets, offsets)
    a, b, c = squared[entry.reshape(-1, 3)].T
    ab, ac, bc = squared_edges[candidates].T
    s, t, gain = closest_weights(ab, (ab + ac - bc) / 2, ac, (a + ab - b) / 2, (a + ac - c) / 2)
    hits = first_minima(a - gain, owner)
    return candidates[hits], barycentric_weights(s[hits], t[hits])


def _closest_around_vertices(
    queries: np.ndarray, points: np.ndarray, faces: np.ndarray, squared_edges: np.ndarray, rings: VertexRings
) -> PointMap:
    """Return the closest point of the faces around the vertex nearest to each query and around its neighbours."""
    used = np.flatnonzero(np.diff(rings.start))
    vertex = used[nearest(queries, points[used])]
    closest, weights = np.zeros(len(queries), dtype=np.int64), np.zeros((len(queries), 3))
    for part in blocks(len(queries), 4096):
        rows = np.arange(part.start, part.stop)
        ring, owner = rings.around(vertex[rows])
        candidates, entry = rings.around(faces[ring].ravel())
        owner = rows[np.repeat(owner, 3)[entry]]
        order = np.argsort(owner, kind="stable")
        candidates, owner = candidates[order], owner[order]
        closest[rows], weights[rows] = _closest_candidates(queries, points, faces, squared_edges, candidates, owner)
    return PointMap(closest, weights)


def invert_precise_map(places: PointMap, source: Mesh, target: Mesh, known: np.ndarray | None = None) -> PointMap:
    """Return the map the other way: a point on the target for each source vertex.

    The target's faces, with the images of their corners, lie on or near the source. Each source vertex takes the
    closest point on them. Where the map is one-to-one that is its inverse. Elsewhere it is the nearest image.

    ``places``: for each target vertex; ``known (n_t,)`` bool: only faces with three known corners count.
    """
    places = check_point_map_precise(places, source, len(target.vertices))
    rows = np.arange(len(target.faces)) if known is None else np.flatnonzero(known[target.faces].all(axis=1))
    if len(rows) == 0:
        raise refuse("map", "a face of the target with a counterpart", "none", "carry values of the source instead")
    closest = closest_points(source.vertices, point_positions(places, source), target.faces[rows])
    return PointMap(rows[closest.faces], closest.weights)
