"""Local confidence in a map, without the truth: how well it keeps the distances around each vertex.

Mapping to the source and back says next to nothing once a map is refined: right or wrong, nine vertices in ten come
back to within an edge or two. But a wrong part of a map changes distances. research/local-confidence.md compares the
two, by ``benchmarks/confidence.py``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from kfmaps._arrays import blocks
from kfmaps.fmap.convert import check_point_map
from kfmaps.geometry.clean import CleanedMesh, clean_mesh
from kfmaps.geometry.closest_points import barycentric_matrix, closest_among
from kfmaps.geometry.coarsen import CoarseProxy, coarse_proxy, spread_vertices
from kfmaps.geometry.connectivity import VertexRings, vertex_rings
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, unit_area, vertex_areas
from kfmaps.geometry.sampling import stratified

_RADIUS = 0.2
"""Largest distance, in √area, of the samples that a vertex is compared with. Some twenty are that near."""
_BLOCK = 64  # samples of one block, which bounds the memory
_MAX_EXACT, _PROXY_VERTICES = 10_000, 6_000
"""Vertices above which distances are measured on a coarse proxy, and vertices of the proxy. On 20,000 vertices
confidences differ by 0.009 on average."""


def local_confidence(
    source: Mesh, target: Mesh, target_to_source: np.ndarray, samples: np.ndarray | None = None, *, sized: bool = False
) -> np.ndarray:
    """Return how well a map keeps the distances around each target vertex, (n_t,), from 0 to 1.

    With ``d_s``, ``d_t`` distances along edges of the shapes at unit area, ``T`` the map, and the sum over the samples
    ``j`` with ``d_t(i, j) ≤ R = 0.2``, the confidence of vertex ``i`` is ``max(0, 1 − Σ |min(d_s(T(i), T(j)), 2R) −
    d_t(i, j)| / Σ d_t(i, j))``.

    An isometry has 1, or 0.9 where the triangulations differ, since distances run along edges. Local errors and torn
    parts have less. A whole shape, or most of a limb, that is mapped to its mirror image has not: see the verdict and
    the alternatives.

    Parameters
    ----------
    source, target : Mesh
        In any units; point clouds too, along the graph of their nearest neighbours.
    target_to_source : (n_t,) int
        −1 where a vertex has no counterpart.
    samples : (q,) int, optional
        Target vertices; by default 200, one from each of as many compact regions of equal area.
    sized : bool
        Whether both have the same unit already, √area of the larger, as a part and a whole have.

    Returns
    -------
    (n_t,) float64
        0 where it is unknown: at vertices without a counterpart or a face, on specks
        (:func:`kfmaps.geometry.clean.clean_mesh`), and where no sample is near.

    Raises
    ------
    InvalidInput
        When the map does not fit the two shapes, or one of them has no area.
    """
    return build_local_distortion(source, target, samples, sized=sized)(target_to_source)


@dataclass(frozen=True, eq=False)
class LocalDistortion:
    """:func:`local_confidence` of maps between two shapes, as a function; made by :func:`build_local_distortion`."""

    cleaned_s: CleanedMesh
    cleaned_t: CleanedMesh
    distances_s: Callable[..., np.ndarray]  # on the cleaned source
    samples: np.ndarray  # (q,): vertices of the cleaned target
    # For each block of samples: row in the block, target vertex, and distance of the pairs within the radius.
    pairs_t: tuple[tuple[np.ndarray, np.ndarray, np.ndarray], ...]

    def __call__(self, target_to_source: np.ndarray) -> np.ndarray:
        """Return :func:`local_confidence` of a map (n_t,)."""
        cleaned_s, cleaned_t = self.cleaned_s, self.cleaned_t
        points = np.asarray(target_to_source)
        unmatched = points < 0
        points = check_point_map(np.where(points == -1, 0, points), len(cleaned_s.to_clean), len(cleaned_t.to_clean))
        points, unmatched = cleaned_s.to_clean[points][cleaned_t.to_original], unmatched[cleaned_t.to_original]
        n = len(points)
        change, total = np.zeros(n), np.zeros(n)
        for part, (rows, vertices, d_t) in zip(blocks(len(self.samples), _BLOCK), self.pairs_t, strict=True):
            samples = self.samples[part]
            d_s = self.distances_s(indices=points[samples], limit=2 * _RADIUS)
            if unmatched.any():
                matched = ~(unmatched[samples][rows] | unmatched[vertices])
                rows, vertices, d_t = rows[matched], vertices[matched], d_t[matched]
            differences = np.abs(np.minimum(d_s[rows, points[vertices]], 2 * _RADIUS) - d_t)
            change += np.bincount(vertices, differences, minlength=n)
            total += np.bincount(vertices, d_t, minlength=n)
        # The total is zero where all near samples coincide with the vertex.
        confidence = 1 - np.divide(change, total, out=np.ones(n), where=total > 1e-9)
        return np.where(cleaned_t.unreferenced, 0.0, np.maximum(confidence, 0.0)[cleaned_t.to_clean])


def build_local_distortion(
    source: Mesh, target: Mesh, samples: np.ndarray | None = None, *, sized: bool = False
) -> LocalDistortion:
    """Return :func:`local_confidence` as a function of the map, with the same parameters and errors."""
    cleaned_s, cleaned_t = clean_mesh(source, specks=True), clean_mesh(target, specks=True)
    if samples is not None and not cleaned_t.whole:
        samples = np.unique(cleaned_t.to_clean[samples[~cleaned_t.unreferenced[samples]]])
    source, target = cleaned_s.mesh, cleaned_t.mesh
    if not sized:
        source, target = unit_area(source), unit_area(target)
    if samples is None:
        areas = vertex_areas(target)
        used = np.flatnonzero(areas > 0)
        samples = used[stratified(target.vertices[used], areas[used], 200, rng=0)]
    distances_t, pairs_t = approximate_geodesics(target), []
    for part in blocks(len(samples), _BLOCK):
        d_t = distances_t(indices=samples[part], limit=_RADIUS)
        rows, vertices = np.nonzero(d_t <= _RADIUS)
        pairs_t.append((rows, vertices, d_t[rows, vertices]))
    return LocalDistortion(cleaned_s, cleaned_t, approximate_geodesics(source), samples, tuple(pairs_t))


@dataclass(frozen=True, eq=False)
class _ProxyDistances:
    """Distances on a large surface, ``vertices (n, 3)``, along the edges of a coarse proxy."""

    vertices: np.ndarray
    proxy: CoarseProxy
    rings: VertexRings  # of the proxy
    graph: csr_array  # of the proxy's edges
    weights: csr_array  # (n, m): interpolate values at the proxy's vertices

    def __call__(self, indices: np.ndarray, limit: float) -> np.ndarray:
        """Return distances (q, n). Each source is an extra node, joined to the proxy's triangles around it."""
        m, q, graph = len(self.proxy.vertices), len(indices), self.graph
        faces, source = self.rings.around(self.proxy.owner[indices])
        links = np.unique(np.repeat(source, 3) * m + self.proxy.mesh.faces[faces].ravel())
        source, corner = np.divmod(links, m)
        lengths = np.linalg.norm(self.vertices[indices[source]] - self.proxy.mesh.vertices[corner], axis=1)
        starts = np.concatenate([graph.indptr, graph.indptr[-1] + np.cumsum(np.bincount(source, minlength=q))])
        data = np.concatenate([graph.data, np.maximum(lengths, np.finfo(float).tiny)])
        joined = csr_array((data, np.concatenate([graph.indices, corner]), starts), shape=(m + q, m + q))
        # A little farther, so that all corners of the last triangles are reached.
        distances = np.asarray(dijkstra(joined, indices=m + np.arange(q), limit=limit + 0.03))[:, :m]
        distances[np.isinf(distances)] = 10 * limit  # infinity times a weight of zero would be NaN
        return np.asarray(self.weights @ np.ascontiguousarray(distances.T)).T


def approximate_geodesics(mesh: Mesh) -> Callable[..., np.ndarray]:
    """Return the function ``distances(indices=, limit=)`` of a surface of any size or a point cloud.

    It returns distances along edges (q, n) from the vertices ``indices (q,)``. Those above ``limit`` may be infinite.
    """
    n = len(mesh.vertices)
    if n <= _MAX_EXACT or len(mesh.faces) == 0:
        return partial(dijkstra, geodesic_graph(mesh, 0))
    proxy = coarse_proxy(mesh, spread_vertices(mesh, _PROXY_VERTICES))
    coarse = proxy.mesh
    rings = vertex_rings(coarse.faces, len(coarse.vertices))
    closest = closest_among(mesh.vertices, coarse.vertices, coarse.faces, *rings.around(proxy.owner))
    weights = barycentric_matrix(closest.faces, closest.weights, coarse.faces, len(coarse.vertices))
    return _ProxyDistances(mesh.vertices, proxy, rings, geodesic_graph(coarse, 0), weights)
