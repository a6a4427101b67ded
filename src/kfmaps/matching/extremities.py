"""Extremities, the ends of limbs: what two bodies have in common, whatever their proportions and poses.

Hands, feet, heads and tails are where the mean geodesic distance to the rest of the surface is locally largest (Hilaga
et al. 2001). They are few and found on any body, and distances to them, together with the sense in which two of these
grow around a point, tell all of its points apart, also its left from its right and its front from its back.
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

    points: np.ndarray  # (m,): which samples are extremities, the farthest first
    mean_distance: np.ndarray  # (m,): mean distance of each from all of the surface, over that of all points
    # (m, q): from each extremity to each sample, over the mean distance of all points from each other.
    distances: np.ndarray
    # (m, m, q): ``n · (∇dᵢ × ∇dⱼ)`` of the distances from extremities i and j at each sample, averaged nearby, from −1
    # to 1: the sine of the angle from one direction to the other. It changes sign in a mirror. 0 for point clouds.
    gradient_cross: np.ndarray
    unit: float  # that mean distance of all points, in √area

    def subsample(self, count: int) -> Extremities:
        """Return the same at the first ``count`` samples."""
        return replace(self, distances=self.distances[:, :count], gradient_cross=self.gradient_cross[:, :, :count])

    def removed(self) -> Extremities:
        """Return the same as of a shape without any."""
        return Extremities(
            self.points[:0], self.mean_distance[:0], self.distances[:0], self.gradient_cross[:0, :0], self.unit
        )

    def mirrored(self) -> Extremities:
        """Return those of the mirror image."""
        return replace(self, gradient_cross=-self.gradient_cross)


def extremities(
    distances: np.ndarray, mass: np.ndarray, mesh: Mesh, rows: np.ndarray, graph: csr_array | None = None
) -> Extremities:
    """Return the extremities of a shape.

    ``distances (c, c)``: geodesic distances between its first samples; ``mass (c,)``: the areas that these stand for;
    ``mesh``: the surface, or a coarse copy; ``rows (q,)``: the vertex of ``mesh`` of each sample, the first c of them
    those of ``distances``; ``graph``: the geodesic graph of ``mesh`` of depth 1, where it is there already.
    """
    far = distances @ (mass / mass.sum())
    mean = float(far @ (mass / mass.sum())) or 1.0
    # At most seven: five of a human, six or seven of animals.
    farthest = [i for i, near in enumerate(distances < _MIN_DISTANCE) if far[i] >= far[near].max(initial=0.0)]
    points = np.array(sorted(farthest, key=lambda i: -far[i])[:7], dtype=np.int64)
    found = at_all_vertices(mesh, rows[points], mean, graph)
    return Extremities(points, far[points] / mean, found.distances[:, rows], found.gradient_cross[:, :, rows], mean)


def at_all_vertices(mesh: Mesh, vertices: np.ndarray, unit: float, graph: csr_array | None = None) -> Extremities:
    """Return what extremities tell of all n vertices.

    ``vertices (m,)``: the extremities; ``unit``: of the distances; ``graph``: as in :func:`extremities`.
    """
    found = dijkstra(geodesic_graph(mesh, 1) if graph is None else graph, indices=vertices)
    joined = np.isfinite(found)
    found = np.where(joined, found, found[joined].max(initial=0.0))
    return Extremities(vertices, found.mean(axis=1) / unit, found / unit, _gradient_cross(mesh, found), unit)


def _gradient_cross(mesh: Mesh, functions: np.ndarray) -> np.ndarray:
    """``n · (∇fᵢ × ∇fⱼ)`` at the vertices, (m, m, n), of ``functions (m, n)``, averaged over a few edges."""
    m, n = functions.shape
    found = np.zeros((m, m, n))
    faces = mesh.faces
    if len(faces) == 0 or m < 2:
        return found
    along = [functions[:, faces[:, c]] - functions[:, faces[:, 0]] for c in (1, 2)]
    pairs = list(combinations(range(m), 2))
    # The integral over a triangle needs no area: (∇f × ∇g) · n A = (df₁ dg₂ − df₂ dg₁) / 2.
    whole = np.stack([(along[0][i] * along[1][j] - along[1][i] * along[0][j]) / 2 for i, j in pairs], axis=1)
    a, b = (mesh.vertices[faces[:, c]] - mesh.vertices[faces[:, 0]] for c in (1, 2))
    area = np.linalg.norm(np.cross(a, b), axis=1) / 2
    corner = csr_array((np.ones(faces.size), (faces.T.ravel(), np.tile(np.arange(len(faces)), 3))), (n, len(faces)))
    both = corner @ np.column_stack([whole, area])
    # Twice the corners of a face around each of its corners, once for those at its other ends: an average.
    around = csr_array(corner @ corner.T)
    around = csr_array(around / around.sum(axis=1).mean())
    for _ in range(6):
        both = around @ both
    values = both[:, :-1] / np.maximum(both[:, -1:], 1e-12 * max(float(both[:, -1].max()), 1e-300))
    for column, (i, j) in enumerate(pairs):
        found[i, j], found[j, i] = values[:, column], -values[:, column]
    return found
