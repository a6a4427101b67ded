"""Which vertices of either shape have a counterpart in a map file, and where: what maps of parts are read with."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import KDTree

from kfmaps.fmap.precise import PointMap, check_point_map_precise, invert_precise_map, point_positions, vertex_point_map
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.mapcontent import check_map
from kfmaps.matching.partial.match_partial import COMMON
from kfmaps.matching.result import Match


def precise_points(found: np.ndarray | Match, source: Mesh) -> PointMap | None:
    """Return the points inside triangles of a map file, checked; ``None`` where it has none."""
    if not isinstance(found, Match) or found.precise_map is None:
        return None
    return check_point_map_precise(found.precise_map, source, len(found.target_to_source))


def point_map(found: np.ndarray | Match, source: Mesh, target_to_source: np.ndarray) -> PointMap:
    """Return a point inside a triangle of a surface for each target vertex, at vertices where ``found`` has no others.

    ``target_to_source (n_t,)``: its vertices. A vertex of no face counts as the nearest that one has; without a
    counterpart (−1) any is taken.
    """
    place = precise_points(found, source)
    if place is not None:
        return place
    used = np.unique(source.faces)
    moved = np.arange(len(source.vertices))
    bare = np.setdiff1d(moved, used)
    if len(bare):
        moved[bare] = used[KDTree(source.vertices[used]).query(source.vertices[bare])[1]]
    return vertex_point_map(moved[np.where(target_to_source < 0, target_to_source.max(), target_to_source)], source)


@dataclass(frozen=True, eq=False)
class Counterparts:
    """A map of points in both directions as far as there are any."""

    file: Match
    meshes: tuple[Mesh, Mesh]  # source and target
    place: PointMap  # on the source, for each target vertex; means nothing where there is no counterpart
    target: np.ndarray  # (n_t,): which vertices have one

    @cached_property
    def back(self) -> PointMap:
        """On the target, for each source vertex: the nearest that is mapped to where it has no counterpart."""
        return invert_precise_map(self.place, *self.meshes, None if self.target.all() else self.target)

    @cached_property
    def source(self) -> np.ndarray:
        """Which source vertices have one, (n_s,)."""
        source, target = self.meshes
        overlap = self.file.partial.overlap_source
        if overlap is not None and np.shape(overlap) == (len(source.vertices),):
            return np.asarray(overlap) > COMMON
        if self.target.all():
            return np.ones(len(source.vertices), dtype=bool)
        corners = point_positions(self.place, source)[target.faces[self.back.faces]]
        near = np.einsum("ti,tij->tj", self.back.weights, corners)
        half = 0.5 * np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean(axis=1)
        return np.linalg.norm(near - source.vertices, axis=1) <= half


def find_counterparts(found: Match, source: Mesh, target: Mesh, name: str = "map") -> Counterparts:
    """Find which vertices of two surfaces have a counterpart by a map file.

    A source vertex has a counterpart where ``overlap_source`` of the file says so. Of a file that does not tell it has
    one within half an edge of what the target's faces are mapped to; of one without −1 every vertex has.
    """
    points = check_map(found, len(source.vertices), len(target.vertices), name, lost=True)
    return Counterparts(found, (source, target), point_map(found, source, points), points >= 0)
