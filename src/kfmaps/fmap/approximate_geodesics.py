"""Distances along the edges of a surface from a few vertices to all, on a coarse copy where it is large.

Dijkstra's search takes half a microsecond a vertex and source. On a copy of 6,000 vertices it does not grow with the
mesh; all vertices take the distance linearly from the corners of the triangle of the copy that they are closest to. Of
20,000 vertices confidences made of both (:mod:`kfmaps.fmap.confidence`) differ by 0.009 on average.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from kfmaps.geometry.closest_points import barycentric_matrix, closest_among
from kfmaps.geometry.coarsen import CoarseProxy, coarse_proxy, spread_vertices
from kfmaps.geometry.connectivity import VertexRings, vertex_rings
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh

_LARGE, _COPY_VERTICES = 10_000, 6_000
"""Vertices above which a copy is made, and vertices of the copy."""


@dataclass(frozen=True, eq=False)
class GraphDistances:
    """A surface on which distances are sought; made by :func:`approximate_geodesics`.

    Attributes
    ----------
    graph : sparse (m, m)
        Of the edges of the surface or its copy.
    near : CoarseInterpolation or None
        How the surface lies on the copy; ``None`` where there is none.
    """

    graph: csr_array
    near: CoarseInterpolation | None = None

    def __call__(self, vertices: np.ndarray, limit: float) -> np.ndarray:
        """Return distances (q, n) from ``vertices (q,)``; infinite, or at least larger than ``limit``, beyond that."""
        if self.near is None:
            return dijkstra(self.graph, indices=vertices, limit=limit)
        return self.near.distances(self.graph, vertices, limit)


@dataclass(frozen=True, eq=False)
class CoarseInterpolation:
    """A surface, ``vertices (n, 3)``, and its coarse copy; ``weights (n, m)`` take values from the copy's vertices."""

    vertices: np.ndarray
    copy: CoarseProxy
    around: VertexRings
    weights: csr_array

    def distances(self, graph: csr_array, vertices: np.ndarray, limit: float) -> np.ndarray:
        """Return the distances (q, n) of :class:`GraphDistances`.

        Each source is a further vertex of the copy, joined to the triangles that it lies at.
        """
        m, q = len(self.copy.vertices), len(vertices)
        faces, source = self.around.around(self.copy.owner[vertices])
        ends = np.unique(np.repeat(source, 3) * m + self.copy.mesh.faces[faces].ravel())
        source, corner = np.divmod(ends, m)
        lengths = np.linalg.norm(self.vertices[vertices[source]] - self.copy.mesh.vertices[corner], axis=1)
        starts = np.concatenate([graph.indptr, graph.indptr[-1] + np.cumsum(np.bincount(source, minlength=q))])
        data = np.concatenate([graph.data, np.maximum(lengths, np.finfo(float).tiny)])
        joined = csr_array((data, np.concatenate([graph.indices, corner]), starts), shape=(m + q, m + q))
        # A little farther, so that all corners of the last triangles are reached.
        found = np.asarray(dijkstra(joined, indices=m + np.arange(q), limit=limit + 0.03))[:, :m]
        found[np.isinf(found)] = 10 * limit  # infinite ones would make NaN of what they have no weight in
        return np.asarray(self.weights @ np.ascontiguousarray(found.T)).T


def approximate_geodesics(mesh: Mesh) -> GraphDistances:
    """Return what finds distances along the edges of ``mesh``, a surface of any size or a point cloud."""
    n = len(mesh.vertices)
    if n <= _LARGE or len(mesh.faces) == 0:
        return GraphDistances(geodesic_graph(mesh, 0))
    copy = coarse_proxy(mesh, spread_vertices(mesh, _COPY_VERTICES))
    few = copy.mesh
    around = vertex_rings(few.faces, len(few.vertices))
    places = closest_among(mesh.vertices, few.vertices, few.faces, *around.around(copy.owner))
    weights = barycentric_matrix(places.faces, places.weights, few.faces, len(few.vertices))
    return GraphDistances(geodesic_graph(few, 0), CoarseInterpolation(mesh.vertices, copy, around, weights))
