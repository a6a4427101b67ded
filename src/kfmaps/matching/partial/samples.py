"""Samples of a part and of the whole, with distances from each other and from the boundary, and with SHOT."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.sparse.csgraph import dijkstra

from kfmaps.descriptors.shot import mirror_shot, shot
from kfmaps.geometry.connectivity import renumbering
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.geodesics import farthest_geodesic, pairwise_geodesics
from kfmaps.geometry.mesh import Mesh, boundary_vertices, mirror_mesh, surface_area, vertex_areas
from kfmaps.matching.partial.one_view import views
from kfmaps.matching.partial.relaxation_labeling import DistanceBounds, RelaxationParams, consistency, distance_bounds
from kfmaps.matching.score import SCORE
from kfmaps.registration.deformable import ClosestPointQuery, closest_point_query

_SUPPORT = 10_000
"""Support points of SHOT on a shape, half of those for a descriptor at every vertex. With fewer in large balls a person
with holes was placed wrongly."""


@dataclass(frozen=True, eq=False)
class PartSurface:
    """A mesh at unit area, with its boundary and a search for closest points."""

    mesh: Mesh

    @cached_property
    def on_boundary(self) -> np.ndarray:
        """Which vertices are on the boundary, (n,) bool."""
        return boundary_vertices(self.mesh)

    @cached_property
    def areas(self) -> np.ndarray:
        """The area of each vertex, (n,)."""
        return vertex_areas(self.mesh)

    @cached_property
    def surface(self) -> ClosestPointQuery:
        """The search for closest points of the mesh."""
        return closest_point_query(self.mesh)


@dataclass(frozen=True, eq=False)
class PartSamples(PartSurface):
    """Samples of one shape, in units of its own √area; made by :func:`part_samples`."""

    samples: np.ndarray  # (q,): vertices: landmarks, then farthest points, so that the first few are spread evenly too
    distances: np.ndarray  # (q, q): along the surface; infinite between components
    boundary_distance: np.ndarray  # (q,): infinite where there is no boundary
    n_landmarks: int = 0
    # SHOT by its radius, as computed by :meth:`shot` and :meth:`shot_of_views` so far.
    descriptors: dict[float, np.ndarray] = field(default_factory=dict)
    view_descriptors: dict[float, list[tuple[np.ndarray, np.ndarray]]] = field(default_factory=dict)

    @property
    def landmarks(self) -> np.ndarray:
        """The vertices that are landmarks, (l,)."""
        return self.samples[: self.n_landmarks]

    @property
    def mirrored(self) -> PartSamples:
        """The samples of the mirror image."""
        found = {radius: mirror_shot(one) for radius, one in self.descriptors.items()}
        return replace(self, mesh=mirror_mesh(self.mesh), descriptors=found, view_descriptors={})

    def shot(self, radius: float) -> np.ndarray:
        """Return SHOT at the samples, (q, 352) float32, of a ``radius`` in √area of the shape."""
        if radius not in self.descriptors:
            found = shot(self.mesh, radius, at=self.samples, samples=_SUPPORT)
            self.descriptors[radius] = found.astype(np.float32)
        return self.descriptors[radius]

    def shot_of_views(self, radius: float) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return for each view of the shape which samples are seen, (v,), and their SHOT of what is seen, (v, 352)."""
        if radius not in self.view_descriptors:
            self.view_descriptors[radius] = [self.shot_of_faces(faces, radius) for faces in views(self.mesh)]
        return self.view_descriptors[radius]

    def shot_of_faces(self, faces: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
        """Return which samples some faces, (m,) bool, have, (v,), and their SHOT of these faces alone, (v, 352)."""
        kept = np.unique(self.mesh.faces[faces])
        number = renumbering(kept, len(self.mesh.vertices))
        piece = Mesh(self.mesh.vertices[kept], number[self.mesh.faces[faces]])
        has, area = np.flatnonzero(number[self.samples] >= 0), surface_area(piece)
        at, support = number[self.samples[has]], max(round(_SUPPORT * area), 1)
        return has, shot(piece, radius / math.sqrt(area), at=at, samples=support).astype(np.float32)


@dataclass(frozen=True, eq=False)
class PartPair:
    """Samples of a part and of the whole, and what is known about their sizes."""

    part: PartSamples
    whole: PartSamples
    fixed_scale: bool = False  # whether the scale of the part is known
    both_partial: bool = False  # whether the whole may lack something too
    file_scale: float | None = None  # √area of the part over that of the whole, if their files may be in one unit
    is_one_view: bool = False  # whether the part is the scan of one camera
    find_self_images: Callable[[], np.ndarray] | None = None  # returns :attr:`self_images`

    @cached_property
    def self_images(self) -> np.ndarray:
        """The images of the whole's samples by its near-symmetries, (m, q): numbers of samples."""
        none = np.zeros((0, len(self.whole.samples)), dtype=np.int64)
        return none if self.find_self_images is None else self.find_self_images()

    @property
    def small_scale(self) -> float | None:
        """The scale of a small part, below a quarter of the area, by the files."""
        return self.file_scale if self.file_scale is not None and self.file_scale < 0.5 else None

    def scale_change(self, scale: float) -> float:
        """Return the absolute logarithm of a ``scale`` over the one that is usual; 0 where none is."""
        full_view = SCORE.part.full_view_scale
        if self.is_one_view:
            usual = self.small_scale or full_view
            return 0.0 if scale > full_view else abs(math.log(scale / usual))
        return 0.0 if self.file_scale is None else abs(math.log(scale / self.file_scale))

    @property
    def unmarked(self) -> PartPair:
        """The same without landmarks."""
        return replace(self, part=replace(self.part, n_landmarks=0), whole=replace(self.whole, n_landmarks=0))

    def bounds(self, scale: float) -> DistanceBounds:
        """Return the bounds of the part's distances on the whole at a ``scale``."""
        return distance_bounds(self.part.distances, self.part.boundary_distance, scale)

    def shot_weights(self, scale: float, radius: float) -> np.ndarray:
        """Return the weight of SHOT at each sample of the part, (q,), at most 1.

        In balls that reach beyond the boundary SHOT of the part is not that of the whole, so samples near the boundary
        have small weights (research/parts.md).

        ``scale``: √area of the part over that of the whole; ``radius``: of SHOT, in √area of the whole.
        """
        fits = np.minimum(self.part.boundary_distance * np.float32(scale / radius), 1.0)
        min_weight = 0.05  # of samples that lie on the boundary
        return np.maximum(fits / max(float(fits.max()), 1e-12), min_weight)

    def pair_consistency(self, scale: float, match: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the consistency of the distances of two parts, (q, q) from 0 to 1, and which pairs count, (q, q) bool.

        Either distance may be too long where the shortest path leads around a boundary. Only near samples count.

        ``scale``: √area of the part over that of the whole; ``match (q,)``: the whole's sample of each of the part's.
        """
        bounds, away = self.bounds(scale), self.whole.boundary_distance[match]
        there = self.whole.distances[np.ix_(match, match)]
        shortest = np.minimum(there, away[:, None] + away)
        change = np.maximum(np.maximum(bounds.lower - there, shortest - bounds.upper), 0.0)
        near = (bounds.upper < RelaxationParams.reach) & np.isfinite(there)
        np.fill_diagonal(near, False)
        return np.where(near, consistency(bounds.upper, bounds.upper, bounds.upper + change), 0.0), near


def part_samples(mesh: Mesh, count: int, landmarks: np.ndarray | None = None, rng: int = 0) -> PartSamples:
    """Return samples of one shape.

    ``mesh``: at unit area; ``count``: farthest points; ``landmarks (l,)``: vertices that come first.
    """
    first = np.zeros(0, dtype=np.int64) if landmarks is None else np.asarray(landmarks, dtype=np.int64)
    farthest = farthest_geodesic(mesh, min(count, len(np.unique(mesh.faces))), rng)
    chosen = np.concatenate([first, farthest[~np.isin(farthest, first)]])
    graph, away = geodesic_graph(mesh, 1), np.full(len(mesh.vertices), np.inf)
    on = np.flatnonzero(boundary_vertices(mesh))
    if len(on):
        away = dijkstra(graph, indices=on, min_only=True)
    between = pairwise_geodesics(graph, chosen).astype(np.float32)
    return PartSamples(mesh, chosen, between, away[chosen].astype(np.float32), len(first))
