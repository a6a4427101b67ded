"""A coarse copy of a surface, for what may be a little inexact but must not grow with the mesh."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra

from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh


def voronoi_regions(mesh: Mesh, vertices: np.ndarray) -> np.ndarray:
    """For each vertex of ``mesh`` which of ``vertices (q,)`` is nearest along edges, (n,); −1 where none is reached."""
    owner = np.asarray(dijkstra(geodesic_graph(mesh, 0), indices=vertices, min_only=True, return_predecessors=True)[2])
    number = np.full(len(mesh.vertices), -1, dtype=np.int64)
    number[vertices] = np.arange(len(vertices))
    return np.where(owner >= 0, number[np.maximum(owner, 0)], -1)


def coarsen(mesh: Mesh, vertices: np.ndarray, owner: np.ndarray | None = None) -> Mesh:
    """The triangulation of some ``vertices (q,)`` of ``mesh`` that is dual to the regions nearest to each.

    Every vertex of the mesh belongs to the one of ``vertices`` that is nearest along edges; a face whose corners
    belong to three becomes a face of these. With evenly spread vertices that is close to their geodesic Delaunay
    triangulation; thin parts with few of them may lose faces. A point cloud stays one. ``owner`` is
    :func:`voronoi_regions` of
    them, where they are known.

    Returns
    -------
    Mesh
        Its vertex i is ``vertices[i]``, with orientation kept.
    """
    if len(mesh.faces) == 0:
        return Mesh(mesh.vertices[vertices], mesh.faces)
    found = (voronoi_regions(mesh, vertices) if owner is None else owner)[mesh.faces]
    a, b, c = found.T
    found = found[(found >= 0).all(axis=1) & (a != b) & (b != c) & (c != a)]
    # One face for each three, in the order of most of its originals, which rarely differ.
    turned = np.take_along_axis(found, (found.argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    return Mesh(mesh.vertices[vertices], np.unique(turned, axis=0))
