"""What matching parts needs of one shape: evenly spread samples, and the distances between them and to its edge."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse.csgraph import dijkstra

from kfmaps.descriptors.shot import shot
from kfmaps.geometry.coarsen import coarsen
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh, boundary_vertices
from kfmaps.geometry.sampling import stratified

LARGE = 20_000
"""Vertices from which distances are worked out on a coarse copy with ..."""
COARSE = 8_000
"""... that many."""
DENSITY = 10_000
"""Support points of SHOT on a surface of unit area: half of what a descriptor at every vertex deserves."""


@dataclass(frozen=True, eq=False)
class PartSamples:
    """Samples of one shape; made by :func:`part_samples`. Lengths are in units of √area of the shape itself.

    Attributes
    ----------
    mesh : Mesh
        At unit area.
    samples : (q,) int64
        Vertices: landmarks, then farthest points, so that the first few are spread evenly too.
    distances : (q, q) float32
        Along the surface; infinite between components.
    edge : (q,) float32
        Distance to the boundary; infinite where there is none.
    border : (n,) bool
        The vertices of the boundary.
    marks : int
        How many landmarks there are.
    """

    mesh: Mesh
    samples: np.ndarray
    distances: np.ndarray
    boundary_distance: np.ndarray
    on_boundary: np.ndarray
    marks: int = 0
    known: dict[float, np.ndarray] = field(default_factory=dict)

    def shot(self, radius: float, threads: int | None = None) -> np.ndarray:
        """SHOT at the samples, (q, 352) float32, of a ``radius`` in √area of the shape; kept once it is worked out."""
        if radius not in self.known:
            found = shot(self.mesh, radius, at=self.samples, samples=DENSITY, threads=threads)
            self.known[radius] = found.astype(np.float32)
        return self.known[radius]


def part_samples(mesh: Mesh, count: int, landmarks: np.ndarray | None = None, rng: int = 0) -> PartSamples:
    """``count`` samples of ``mesh``, which is at unit area, and the vertices ``landmarks (l,)``."""
    marks = np.zeros(0, dtype=np.int64) if landmarks is None else np.asarray(landmarks, dtype=np.int64)
    border = boundary_vertices(mesh)
    small, rows = mesh, np.arange(len(mesh.vertices))
    if len(rows) > LARGE:
        areas = np.full(len(rows), 1.0)
        rows = np.union1d(stratified(mesh.vertices, areas, COARSE, rng), marks)
        small = coarsen(mesh, rows)
    used = np.unique(small.faces)
    chosen = farthest_geodesic(small, min(count, len(used)), rng)
    first = np.searchsorted(rows, marks)
    chosen = np.concatenate([first, chosen[~np.isin(chosen, first)]])
    graph = geodesic_graph(small, 1)
    distances = dijkstra(graph, indices=chosen)
    on = np.flatnonzero(boundary_vertices(small))
    edge = distances[:, on].min(axis=1) if len(on) else np.full(len(chosen), np.inf)
    return PartSamples(
        mesh,
        rows[chosen],
        distances[:, chosen].astype(np.float32),
        edge.astype(np.float32),
        border,
        len(marks),
    )


def scaled(mesh: Mesh, scale: float) -> Mesh:
    """``mesh`` with all lengths times ``scale``."""
    return Mesh(mesh.vertices * scale, mesh.faces)
