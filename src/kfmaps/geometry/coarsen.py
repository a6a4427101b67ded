"""Coarse proxies of surfaces, so that the cost of what need not be exact does not grow with the mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from kfmaps.geometry.connectivity import proper_faces, renumbering
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, mirror_mesh, vertex_areas
from kfmaps.geometry.sampling import stratified


@dataclass(frozen=True, eq=False)
class CoarseProxy:
    """A coarse proxy of a mesh; made by :func:`coarse_proxy`."""

    mesh: Mesh  # q vertices, each of some face
    vertices: np.ndarray  # (q,): their numbers in the fine mesh
    owner: np.ndarray  # (n,): the vertex of the proxy that is nearest to each vertex of the fine mesh

    def mirrored(self) -> CoarseProxy:
        """Return the proxy of the mirror image."""
        return replace(self, mesh=mirror_mesh(self.mesh))


def spread_vertices(mesh: Mesh, count: int, kept: np.ndarray | None = None) -> np.ndarray:
    """Return about ``count`` vertices spread evenly over the area of a mesh, or all, (q,), ascending.

    ``kept (l,)``: vertices that must be among them.
    """
    if len(mesh.vertices) <= count:
        return np.arange(len(mesh.vertices))
    areas = vertex_areas(mesh)
    used = np.flatnonzero(areas > 0)
    chosen = used[stratified(mesh.vertices[used], areas[used], count, rng=0)]
    return chosen if kept is None else np.union1d(chosen, kept)


def _voronoi_regions(mesh: Mesh, vertices: np.ndarray) -> np.ndarray:
    """Return which of ``vertices (q,)`` is nearest to each vertex of ``mesh`` along edges, (n,); −1 for none."""
    owner = np.asarray(dijkstra(geodesic_graph(mesh, 0), indices=vertices, min_only=True, return_predecessors=True)[2])
    return np.where(owner >= 0, renumbering(vertices, len(mesh.vertices))[np.maximum(owner, 0)], -1)


def coarsen(mesh: Mesh, vertices: np.ndarray, owner: np.ndarray | None = None) -> Mesh:
    """Return the triangulation of some vertices that is dual to their Voronoi regions.

    A face whose corners lie in the regions of three vertices becomes a face of these. With evenly spread vertices that
    is close to their geodesic Delaunay triangulation. Thin parts with few vertices may lose faces. Orientation is kept,
    and a point cloud stays one.

    ``vertices (q,)``: of the result, in this order; ``owner (n,)``: their :func:`_voronoi_regions`, if they are known.
    """
    if len(mesh.faces) == 0:
        return Mesh(mesh.vertices[vertices], mesh.faces)
    faces = (_voronoi_regions(mesh, vertices) if owner is None else owner)[mesh.faces]
    faces = faces[(faces >= 0).all(axis=1) & proper_faces(faces)]
    # Each face once, with its smallest corner first.
    faces = np.take_along_axis(faces, (faces.argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    return Mesh(mesh.vertices[vertices], np.unique(faces, axis=0))


def coarse_proxy(mesh: Mesh, vertices: np.ndarray) -> CoarseProxy:
    """Return a coarse proxy of a mesh, without vertices that no face uses.

    ``vertices (q,)``: of the proxy, ascending. With all vertices it has all faces.
    """
    owner = np.arange(len(vertices))
    coarse = mesh
    if len(vertices) < len(mesh.vertices):
        owner = _voronoi_regions(mesh, vertices)
        coarse = coarsen(mesh, vertices, owner)
    used = np.unique(coarse.faces)
    if len(used) < len(vertices):  # thin parts may lose their faces
        number = renumbering(used, len(vertices))
        coarse, vertices = Mesh(coarse.vertices[used], number[coarse.faces]), vertices[used]
        owner = np.where(owner < 0, -1, number[owner])
    without = np.flatnonzero(owner < 0)
    if len(without) and len(vertices):
        owner[without] = KDTree(coarse.vertices).query(mesh.vertices[without])[1]
    return CoarseProxy(coarse, vertices, owner)


def embedded_deformation(proxy: CoarseProxy, mesh: Mesh, x: np.ndarray, R: np.ndarray) -> np.ndarray:
    """Return the vertices (n, 3) of a mesh that follows its deformed coarse proxy.

    Each moves by the weighted mean of the rigid motions of the proxy's vertices around it. So a rigid motion of the
    proxy moves the mesh rigidly.

    ``proxy``: of ``mesh``; ``x (q, 3)``: deformed positions of its vertices; ``R (q, 3, 3)``: their rotations.

    Sumner, Schmid and Pauly, Embedded deformation for shape manipulation (2007).
    """
    q, n = len(proxy.vertices), len(mesh.vertices)
    corners = proxy.mesh.faces
    i = np.concatenate([corners.ravel(), np.roll(corners, 1, axis=1).ravel(), np.arange(q)])
    j = np.concatenate([np.roll(corners, 1, axis=1).ravel(), corners.ravel(), np.arange(q)])
    neighbours = csr_array((np.ones(len(i)), (i, j)), shape=(q, q))
    pairs = neighbours[proxy.owner].tocoo()
    vertex, node = pairs.row, pairs.col
    offsets = mesh.vertices[vertex] - proxy.mesh.vertices[node]
    distances = np.linalg.norm(offsets, axis=1)
    largest = np.zeros(n)
    np.maximum.at(largest, vertex, distances)
    weights = (1 - distances / np.maximum(1.1 * largest[vertex], 1e-300)) ** 2
    moved = x[node] + np.einsum("eij,ej->ei", R[node], offsets)
    total = np.bincount(vertex, weights, minlength=n)
    return np.stack([np.bincount(vertex, weights * moved[:, k], minlength=n) / total for k in range(3)], axis=1)
