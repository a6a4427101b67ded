"""Repair of small patches of a map that are torn off, such as an ear that is mapped to the tail."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from kfmaps.geometry.connectivity import component_labels, mesh_edges
from kfmaps.geometry.mesh import Mesh, vertex_areas

_MAX_AREA = 0.05
"""Largest share of the area of a patch that is rejoined. A larger one may be a limb that an alternative has right."""


def rejoin_torn_patches(points: np.ndarray, source: Mesh, target: Mesh) -> np.ndarray:
    """Return the map with small torn patches mapped to the images of the vertices beside them, (n_t,).

    An edge of the target is torn where the images of its ends are far apart. What torn edges cut off from the largest
    part of its connected component is a patch. A registration that begins with a torn patch may stretch the source
    between two places and cannot recover.

    ``points (n_t,)``: a source vertex for each target vertex; both surfaces at unit area.
    """
    n = len(target.vertices)
    a, b = mesh_edges(target.faces, n)[0].T
    lengths = np.linalg.norm(target.vertices[a] - target.vertices[b], axis=1)
    jumps = np.linalg.norm(source.vertices[points[a]] - source.vertices[points[b]], axis=1)
    # Distance in √area between the images of neighbouring vertices, above the length of their edge, from which it is
    # torn.
    min_jump = 0.15
    joined = jumps < min_jump + lengths
    if joined.all():
        return points
    n_components, component = component_labels(n, a, b)
    _, patch = component_labels(n, a[joined], b[joined])
    areas = vertex_areas(target)
    size = np.bincount(patch, areas)[patch]
    largest, order = np.zeros(n_components, dtype=np.int64), np.argsort(size, kind="stable")
    largest[component[order]] = patch[order]
    torn = (patch != largest[component]) & (size < _MAX_AREA * areas.sum())
    near = torn[a] | torn[b]
    graph = csr_array((lengths[near], (a[near], b[near])), shape=(n, n))
    sources = np.flatnonzero(~torn)
    nearest = dijkstra(graph, directed=False, indices=sources, min_only=True, return_predecessors=True)[2]
    return np.where(torn & (nearest >= 0), points[nearest], points)
