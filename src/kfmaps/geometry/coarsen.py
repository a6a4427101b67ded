"""Coarse copies of a surface, for what may be a little inexact but must not grow with the mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, mirror_mesh, vertex_areas
from kfmaps.geometry.sampling import stratified


@dataclass(frozen=True, eq=False)
class CoarseProxy:
    """A coarse copy of a mesh; made by :func:`coarse_proxy`."""

    mesh: Mesh  # with q vertices, each in some face
    vertices: np.ndarray  # (q,): their numbers in the fine mesh
    owner: np.ndarray  # (n,): the vertex of the copy that is nearest to each vertex of the fine mesh

    def mirrored(self) -> CoarseProxy:
        """Return the copy of the mirror image."""
        return replace(self, mesh=mirror_mesh(self.mesh))


def spread_vertices(mesh: Mesh, count: int, kept: np.ndarray | None = None) -> np.ndarray:
    """Return vertices spread evenly over the area of a mesh.

    ``count``: about how many; all where the mesh has no more; ``kept (l,)``: vertices that are to be among them.
    Returns (q,): ascending.
    """
    if len(mesh.vertices) <= count:
        return np.arange(len(mesh.vertices))
    areas = vertex_areas(mesh)
    used = np.flatnonzero(areas > 0)
    chosen = used[stratified(mesh.vertices[used], areas[used], count, rng=0)]
    return chosen if kept is None else np.union1d(chosen, kept)


def _voronoi_regions(mesh: Mesh, vertices: np.ndarray) -> np.ndarray:
    """Return which of ``vertices (q,)`` is nearest to each vertex of ``mesh`` along edges, (n,); −1 if none is
    reached."""
    owner = np.asarray(dijkstra(geodesic_graph(mesh, 0), indices=vertices, min_only=True, return_predecessors=True)[2])
    number = np.full(len(mesh.vertices), -1, dtype=np.int64)
    number[vertices] = np.arange(len(vertices))
    return np.where(owner >= 0, number[np.maximum(owner, 0)], -1)


def coarsen(mesh: Mesh, vertices: np.ndarray, owner: np.ndarray | None = None) -> Mesh:
    """Return the triangulation of some vertices that is dual to the regions nearest to each.

    Every vertex of the mesh belongs to the one of ``vertices`` that is nearest along edges. A face whose corners belong
    to three becomes a face of these. With evenly spread vertices that is close to their geodesic Delaunay
    triangulation; thin parts with few of them may lose faces. A point cloud stays one.

    ``vertices (q,)``; ``owner (n,)``: :func:`_voronoi_regions` of them, where they are known. Result: its vertex i is
    ``vertices[i]``, with orientation kept.
    """
    if len(mesh.faces) == 0:
        return Mesh(mesh.vertices[vertices], mesh.faces)
    found = (_voronoi_regions(mesh, vertices) if owner is None else owner)[mesh.faces]
    a, b, c = found.T
    found = found[(found >= 0).all(axis=1) & (a != b) & (b != c) & (c != a)]
    # One face for each three, in the order of most of its originals, which rarely differ.
    turned = np.take_along_axis(found, (found.argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    return Mesh(mesh.vertices[vertices], np.unique(turned, axis=0))


def coarse_proxy(mesh: Mesh, vertices: np.ndarray) -> CoarseProxy:
    """Return a coarse copy of a mesh, without vertices that no face uses.

    ``vertices (q,)``: those of the copy, ascending. With all vertices the copy has all faces.
    """
    owner = np.arange(len(vertices))
    coarse = mesh
    if len(vertices) < len(mesh.vertices):
        owner = _voronoi_regions(mesh, vertices)
        coarse = coarsen(mesh, vertices, owner)
    used = np.unique(coarse.faces)
    if len(used) < len(vertices):  # thin parts may lose their faces
        number = np.full(len(vertices), -1, dtype=np.int64)
        number[used] = np.arange(len(used))
        coarse, vertices = Mesh(coarse.vertices[used], number[coarse.faces]), vertices[used]
        owner = np.where(owner < 0, -1, number[owner])
    lost = np.flatnonzero(owner < 0)
    if len(lost) and len(vertices):
        owner[lost] = KDTree(coarse.vertices).query(mesh.vertices[lost])[1]
    return CoarseProxy(coarse, vertices, owner)


def embedded_deformation(copy: CoarseProxy, mesh: Mesh, bent: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """Return the vertices of a mesh that follows its deformed coarse copy: (n, 3).

    Each moves with the vertices of the copy around it, by the motion of each, blended by weights that fall to zero
    where the surroundings end. A rigid motion of the copy is that of the mesh.

    ``copy``: of ``mesh``; ``bent (q, 3)``: positions of the copy's vertices; ``turns (q, 3, 3)``: their rotations.

    Sumner, Schmid and Pauly, Embedded deformation for shape manipulation (2007).
    """
    q, n = len(copy.vertices), len(mesh.vertices)
    corners = copy.mesh.faces
    i = np.concatenate([corners.ravel(), np.roll(corners, 1, axis=1).ravel(), np.arange(q)])
    j = np.concatenate([np.roll(corners, 1, axis=1).ravel(), corners.ravel(), np.arange(q)])
    near = csr_array((np.ones(len(i)), (i, j)), shape=(q, q))
    of = near[copy.owner].tocoo()
    fine, node = of.row, of.col
    rest = mesh.vertices[fine] - copy.mesh.vertices[node]
    away = np.linalg.norm(rest, axis=1)
    reach = np.zeros(n)
    np.maximum.at(reach, fine, away)
    weights = (1 - away / np.maximum(1.1 * reach[fine], 1e-300)) ** 2
    places = bent[node] + np.einsum("eij,ej->ei", turns[node], rest)
    total = np.bincount(fine, weights, minlength=n)
    return np.stack([np.bincount(fine, weights * places[:, k], minlength=n) / total for k in range(3)], axis=1)
