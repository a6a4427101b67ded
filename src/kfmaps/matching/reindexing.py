"""Vertex numbers on their way in and out of a match, which works on the inside of its shapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, check, refuse, to_numpy
from kfmaps.fmap.precise import PointMap
from kfmaps.geometry.clean import CleanedMesh
from kfmaps.matching.fit import check_landmark_pairs
from kfmaps.shape import Shape


@dataclass(frozen=True, eq=False)
class VertexReindexing:
    """Two prepared shapes as they are outside and inside; made by :func:`reindexing`."""

    outside: tuple[Shape, Shape]
    source: Shape  # inside: each place once, without unused vertices and specks (:attr:`kfmaps.shape.Shape.cleaned`)
    target: Shape
    part_s: CleanedMesh  # how their vertices are numbered
    part_t: CleanedMesh

    @property
    def open(self) -> bool:
        """Whether numbers are the same on both sides."""
        return self.part_s.whole and self.part_t.whole

    def landmarks(self, given: Array) -> Array:
        """Return landmarks ``(l, 2)`` outside as those inside; ``None`` stays."""
        if given is None or self.open:
            return given
        pairs = check_landmark_pairs(given, *self.outside)
        columns = []
        for i, (part, shape) in enumerate(((self.part_s, self.source), (self.part_t, self.target))):
            within = part.to_clean[pairs[:, i]]
            first = np.unique(within, return_index=True)[1]
            again = np.setdiff1d(np.arange(len(pairs)), first)
            if len(again):
                one, two = pairs[within == within[again[0]], i][:2]
                got = f"vertices {one} and {two}, which count as one"
                raise refuse(f"landmarks on {shape.name}", "each place once", got, "remove one of them")
            columns.append(within)
        return np.stack(columns, axis=1)

    def descriptors(self, given: tuple[Array, Array] | None) -> tuple[Array, Array] | None:
        """Return the rows inside of the user's descriptors ``(n_s, d)``, ``(n_t, d)``; ``None`` stays."""
        if given is None or self.open:
            return given
        rows = []
        for values, part, shape in zip(given, (self.part_s, self.part_t), self.outside, strict=True):
            values = to_numpy(values) if hasattr(values, "shape") else np.asarray(values)
            name = f"descriptors of {shape.name}"
            check(values, name, shape=(len(part.to_clean), None), finite=False, remedy="give one row per vertex")
            rows.append(values[part.to_original])
        return rows[0], rows[1]

    def points(self, target_to_source: np.ndarray) -> np.ndarray:
        """Return a point map inside as one outside, (n_t,); −1 stays."""
        return np.where(target_to_source < 0, -1, self.part_s.to_original[target_to_source])[self.part_t.to_clean]

    def points_within(self, target_to_source: np.ndarray) -> np.ndarray:
        """Return a point map of the shapes as handed in, (n_t,), as one of the cleaned shapes."""
        return self.part_s.to_clean[target_to_source[self.part_t.to_original]]

    def points_back(self, source_to_target: np.ndarray) -> np.ndarray:
        """Return a point map back inside as one outside, (n_s,)."""
        return self.part_t.to_original[source_to_target][self.part_s.to_clean]

    def place(self, places: PointMap) -> PointMap:
        """Return points in triangles inside as such outside."""
        faces, weights, turned = self.part_s.faces_to_original[places.faces], places.weights, self.part_s.turned
        if turned is not None:
            weights = np.where(turned[places.faces][:, None], weights[:, ::-1], weights)
        return PointMap(faces[self.part_t.to_clean], weights[self.part_t.to_clean])

    def bent(self, vertices: np.ndarray) -> np.ndarray:
        """Return registered vertices of the source inside (m_s, 3) as outside (n_s, 3), in the target's unit there."""
        here, there = self.target.mesh.vertices, self.outside[1].mesh.vertices[self.part_t.to_original]
        scale = np.linalg.norm(there - there.mean(axis=0)) / np.linalg.norm(here - here.mean(axis=0))
        return scale * (vertices - here.mean(axis=0))[self.part_s.to_clean] + there.mean(axis=0)

    def overlap(self, source: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return probabilities inside (m_s,), (m_t,) as outside (n_s,), (n_t,): 0 in vertices of no face."""
        sides = ((source, self.part_s), (target, self.part_t))
        first, second = (np.where(part.unreferenced, 0.0, values[part.to_clean]) for values, part in sides)
        return first, second

    def trust(self, confidence: np.ndarray) -> np.ndarray:
        """Return confidence inside (m_t,) as outside (n_t,): 0 in vertices of no face."""
        return np.where(self.part_t.unreferenced, 0.0, confidence[self.part_t.to_clean])


def reindexing(source: Shape, target: Shape) -> VertexReindexing:
    """Return the numbers of the cleaned meshes of two prepared shapes beside those of the meshes as given."""
    (within_s, part_s), (within_t, part_t) = source.cleaned, target.cleaned
    return VertexReindexing((source, target), within_s, within_t, part_s, part_t)
