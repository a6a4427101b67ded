"""Extremities, the ends of limbs, which two bodies have in common whatever their proportions and poses.

Hands, feet, heads and tails are maxima of the mean geodesic distance to the rest of the surface (Hilaga et al. 2001).
Distances from a few of them distinguish the points of a body. The cross products of the gradients of two such distances
change sign in a mirror, so they tell left from right and front from back.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh

_MIN_DISTANCE = 0.3
"""Distance, in √area, within which only the farthest point is an extremity: fingers are part of a hand."""


@dataclass(frozen=True, eq=False)
class Extremities:
    """The extremities of one shape; made by :func:`extremities`."""

    points: np.ndarray  # (m,): the samples that are extremities, the farthest first
    mean_distance: np.ndarray  # (m,): mean distance of each from all of the surface, in ``unit``
    distances: np.ndarray  # (m, q): from each extremity to each sample, in ``unit``
    # (m, m, q): ``n · (∇dᵢ × ∇dⱼ)`` of the distances from extremities i and j at each sample, averaged nearby, from −1
    # to 1: the sine of the angle from one direction to the other. It changes sign in a mirror. 0 for point clouds.
    gradient_cross: np.ndarray
    unit: float  # mean distance of all points from each other, in √area

    def subsample(self, count: int) -> Extremities:
        """Return the same at the first ``count`` samples."""
        return replace(self, distances=self.distances[:, :count], gradient_cross=self.gradient_cross[:, :, :count])

    def removed(self) -> Extremities:
        """Return the same without any extremity."""
        return Extremities(
            self.points[:0], self.mean_distance[:0], self.distances[:0], self.gradient_cross[:0, :0], self.unit
        )

    def mirrored(self) -> Extremities:
        """Return the extremities of the mirror image."""
        return replace(self, gradient_cross=-self.gradient_cross)


def extremities(
    distances: np.ndarray, mass: np.ndarray, mesh: Mesh, rows: np.ndarray, graph: csr_array | None = None
) -> Extremities:
    """Return the extremities of a shape.

    ``distances (c, c)``: geodesic distances between its first samples; ``mass (c,)``: their areas; ``mesh``: the
    surface, or a coarse proxy; ``rows (q,)``: the vertex of ``mesh`` of each sample, the first c of them those of
    ``distances``; ``graph``: the geodesic graph of ``mesh`` of depth 1, if it has been computed.
    """
    mean_distance = distances @ (mass / mass.sum())
    unit = float(mean_distance @ (mass / mass.sum())) or 1.0
    near = distances < _MIN_DISTANCE
    maxima = [i for i, d in enumerate(mean_distance) if d >= mean_distance[near[i]].max(initial=0.0)]
    most = 12  # a human has five extremities, animals have six to eight, a crab eight, spiders and ants nine
    points = np.array(sorted(maxima, key=lambda i: -mean_distance[i])[:most], dtype=np.int64)
    every = at_all_vertices(mesh, rows[points], unit, graph)
    distances, gradient_cross = every.distances[:, rows], every.gradient_cross[:, :, rows]
    return Extremities(points, mean_distance[points] / unit, distances, gradient_cross, unit)


def at_all_vertices(mesh: Mesh, vertices: np.ndarray, unit: float, graph: csr_array | None = None) -> Extremities:
    """Return extremities with their distances and gradients at all vertices.

    ``vertices (m,)``: the extremities; ``unit``: of the distances; ``graph``: as in :func:`extremities`.
    """
    distances = dijkstra(geodesic_graph(mesh, 1) if graph is None else graph, indices=vertices)
    is_finite = np.isfinite(distances)
    distances = np.where(is_finite, distances, distances[is_finite].max(initial=0.0))
    return Extremities(
        vertices, distances.mean(axis=1) / unit, distances / unit, _gradient_cross(mesh, distances), unit
    )


def _gradient_cross(mesh: Mesh, functions: np.ndarray) -> np.ndarray:
    """Return ``n · (∇fᵢ × ∇fⱼ)`` at the vertices, (m, m, n), of ``functions (m, n)``, averaged over a few edges."""
    m, n = functions.shape
    result = np.zeros((m, m, n))
    faces = mesh.faces
    if len(faces) == 0 or m < 2:
        return result
    along = [functions[:, faces[:, c]] - functions[:, faces[:, 0]] for c in (1, 2)]
    pairs = list(combinations(range(m), 2))
    # The integral over a triangle needs no area: (∇f × ∇g) · n A = (df₁ dg₂ − df₂ dg₁) / 2.
    cross = np.stack([(along[0][i] * along[1][j] - along[1][i] * along[0][j]) / 2 for i, j in pairs], axis=1)
    a, b = (mesh.vertices[faces[:, c]] - mesh.vertices[faces[:, 0]] for c in (1, 2))
    area = np.linalg.norm(np.cross(a, b), axis=1) / 2
    corner = csr_array((np.ones(faces.size), (faces.T.ravel(), np.tile(np.arange(len(faces)), 3))), (n, len(faces)))
    both = corner @ np.column_stack([cross, area])
    # Repeated averages over the corners of the faces around each vertex.
    around = csr_array(corner @ corner.T)
    around = csr_array(around / around.sum(axis=1).mean())
    for _ in range(6):
        both = around @ both
    values = both[:, :-1] / np.maximum(both[:, -1:], 1e-12 * max(float(both[:, -1].max()), 1e-300))
    for column, (i, j) in enumerate(pairs):
        result[i, j], result[j, i] = values[:, column], -values[:, column]
    return result
