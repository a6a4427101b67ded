"""Small patches of a map that are torn off from all that is around them, such as an ear that has gone to the tail."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from kfmaps.geometry.connectivity import component_labels, mesh_edges
from kfmaps.geometry.mesh import Mesh, vertex_areas

_MIN_JUMP = 0.15
"""Distance in √area from which the images of neighbouring vertices are torn apart, beside the length of their edge."""
_MAX_AREA = 0.05
"""Share of the area up to which a patch is taken back; what is larger may be a limb, which an alternative may have
right."""


def rejoin_torn_patches(points: np.ndarray, source: Mesh, target: Mesh) -> np.ndarray:
    """Return the map with small patches that are torn off sent to where the vertices beside them go, (n_t,).

    An edge of the target is torn where the images of its ends are far apart. What torn edges cut off from the largest
    part of its connected component is a patch. A registration that begins with one may stretch the source from the one
    place to the other, and cannot come back.

    ``points (n_t,)``: a source vertex for each target vertex; both surfaces at unit area.
    """
    n = len(target.vertices)
    a, b = mesh_edges(target.faces, n)[0].T
    lengths = np.linalg.norm(target.vertices[a] - target.vertices[b], axis=1)
    jumps = np.linalg.norm(source.vertices[points[a]] - source.vertices[points[b]], axis=1)
    joined = jumps < _MIN_JUMP + lengths
    if joined.all():
        return points
    bodies, body = component_labels(n, a, b)
    _, patch = component_labels(n, a[joined], b[joined])
    areas = vertex_areas(target)
    size = np.bincount(patch, areas)[patch]
    largest, order = np.zeros(bodies, dtype=np.int64), np.argsort(size, kind="stable")
    largest[body[order]] = patch[order]
    torn = (patch != largest[body]) & (size < _MAX_AREA * areas.sum())
    near = torn[a] | torn[b]
    graph = csr_array((lengths[near], (a[near], b[near])), shape=(n, n))
    kept = np.flatnonzero(~torn)
    beside = dijkstra(graph, directed=False, indices=kept, min_only=True, return_predecessors=True)[2]
    return np.where(torn & (beside >= 0), points[beside], points)
