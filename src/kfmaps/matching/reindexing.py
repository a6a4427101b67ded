"""Convert vertex numbers between the given meshes and the cleaned ones, which a match works on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, check, refuse, to_numpy
from kfmaps.fmap.precise import PointMap
from kfmaps.geometry.clean import CleanedMesh
from kfmaps.geometry.closest_points import closest_points
from kfmaps.matching.fit import check_landmark_pairs
from kfmaps.shape import Shape

_MAX_DEPTH = 0.05
"""Distance from a shape's outer surface, in √area, up to which other vertices share its local confidence."""


@dataclass(frozen=True, eq=False)
class VertexReindexing:
    """Two prepared shapes as they were given and cleaned, n and m vertices each; made by :func:`reindexing`.

    Methods named after ``clean`` return what was given for the cleaned shapes, those named after ``given`` the reverse.
    """

    given: tuple[Shape, Shape]
    source: Shape  # cleaned: each place once, without unused vertices and specks (:attr:`kfmaps.shape.Shape.cleaned`)
    target: Shape
    clean_s: CleanedMesh  # the numbers of their vertices
    clean_t: CleanedMesh

    @property
    def is_identity(self) -> bool:
        """Whether the numbers are the same."""
        return self.clean_s.whole and self.clean_t.whole

    @property
    def is_divided(self) -> bool:
        """Whether a mesh has more vertices than as given, and its functions are not those of the given one."""
        return self.clean_s.corners is not None or self.clean_t.corners is not None

    def clean_landmarks(self, pairs: Array) -> Array:
        """Return landmarks ``(l, 2)`` of the cleaned shapes; ``None`` stays."""
        if pairs is None or self.is_identity:
            return pairs
        pairs = check_landmark_pairs(pairs, *self.given)
        columns = []
        for i, (cleaned, shape) in enumerate(((self.clean_s, self.source), (self.clean_t, self.target))):
            column = cleaned.to_clean[pairs[:, i]]
            first = np.unique(column, return_index=True)[1]
            again = np.setdiff1d(np.arange(len(pairs)), first)
            if len(again):
                one, two = pairs[column == column[again[0]], i][:2]
                got = f"vertices {one} and {two}, which count as one"
                raise refuse(f"landmarks on {shape.name}", "each place once", got, "remove one of them")
            columns.append(column)
        return np.stack(columns, axis=1)

    def clean_descriptors(self, pair: tuple[Array, Array] | None) -> tuple[Array, Array] | None:
        """Return the rows of descriptors ``(n_s, d)``, ``(n_t, d)`` at the cleaned vertices; ``None`` stays."""
        if pair is None or self.is_identity:
            return pair
        rows = []
        for values, cleaned, shape in zip(pair, (self.clean_s, self.clean_t), self.given, strict=True):
            values = to_numpy(values) if hasattr(values, "shape") else np.asarray(values)
            name = f"descriptors of {shape.name}"
            check(values, name, shape=(len(cleaned.to_clean), None), finite=False, remedy="give one row per vertex")
            rows.append(values[cleaned.to_original])
        return rows[0], rows[1]

    def clean_points(self, target_to_source: np.ndarray) -> np.ndarray:
        """Return a point map (n_t,) as one of the cleaned shapes, (m_t,)."""
        return self.clean_s.to_clean[target_to_source[self.clean_t.to_original]]

    def given_points(self, target_to_source: np.ndarray) -> np.ndarray:
        """Return a point map of the cleaned shapes, (m_t,), as one of the given ones, (n_t,); −1 stays."""
        return np.where(target_to_source < 0, -1, self.clean_s.to_original[target_to_source])[self.clean_t.to_clean]

    def given_points_back(self, source_to_target: np.ndarray) -> np.ndarray:
        """Return a point map in the other direction of the cleaned shapes, (m_s,), as one of the given ones, (n_s,)."""
        return self.clean_t.to_original[source_to_target][self.clean_s.to_clean]

    def given_functional_map(self, points: np.ndarray, C: np.ndarray, back: bool = False) -> np.ndarray:
        """Return a functional map ``C (k_t, k_s)`` of the cleaned shapes as one of the given ones.

        Where a mesh is divided, it is that of the given point map ``points (n_t,)``, −1 where there is none: functions
        of the divided mesh are not those of the given one. ``back``: both lead from the target to the source.
        """
        if not self.is_divided:
            return C
        shapes = self.given[::-1] if back else self.given
        bases = [shape.basis.truncate(k) for shape, k in zip(shapes, C.shape[::-1], strict=True)]
        pulled = to_numpy(bases[0].functions)[np.maximum(points, 0)] * (points >= 0)[:, None]
        return to_numpy(bases[1].project(pulled))

    def given_precise_map(self, places: PointMap) -> PointMap:
        """Return points in triangles of the cleaned source as points in triangles of the given one."""
        given, cleaned = self.given[0], self.source.mesh
        if given.is_repaired:
            points = np.einsum("ni,nij->nj", places.weights, cleaned.vertices[cleaned.faces[places.faces]])
            nearest = closest_points(points, given.mesh.vertices, given.given_mesh.faces)
            return PointMap(nearest.faces[self.clean_t.to_clean], nearest.weights[self.clean_t.to_clean])
        faces, weights, turned = self.clean_s.faces_to_original[places.faces], places.weights, self.clean_s.turned
        if self.clean_s.corners is not None:
            weights = np.einsum("ni,nij->nj", weights, self.clean_s.corners[places.faces])
        if turned is not None:
            weights = np.where(turned[places.faces][:, None], weights[:, ::-1], weights)
        return PointMap(faces[self.clean_t.to_clean], weights[self.clean_t.to_clean])

    def given_registered(self, vertices: np.ndarray) -> np.ndarray:
        """Return registered vertices (m_s, 3) of the cleaned source for the given one, (n_s, 3), on its target."""
        numbers, rows = np.unique(self.clean_t.to_original, return_index=True)
        cleaned, given = self.target.mesh.vertices[rows], self.given[1].mesh.vertices[numbers]
        scale = np.linalg.norm(given - given.mean(axis=0)) / np.linalg.norm(cleaned - cleaned.mean(axis=0))
        return scale * (vertices - cleaned.mean(axis=0))[self.clean_s.to_clean] + given.mean(axis=0)

    def given_overlap(self, source: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return probabilities (m_s,), (m_t,) for the given shapes, (n_s,), (n_t,): 0 at vertices of no face."""
        return _at_given(source, self.clean_s, self.given[0]), _at_given(target, self.clean_t, self.given[1])

    def given_confidence(self, confidence: np.ndarray) -> np.ndarray:
        """Return the local confidence (m_t,) for the given target, (n_t,): 0 at vertices of no face."""
        return _at_given(confidence, self.clean_t, self.given[1])


def _at_given(values: np.ndarray, cleaned: CleanedMesh, given: Shape) -> np.ndarray:
    """Return values at the cleaned vertices, (m,), for the given ones, (n,): 0 at vertices of no face.

    Vertices inside a surface that preparation has made of pieces have the value of the nearest one, if it is near.
    """
    is_lost = cleaned.unreferenced
    if given.is_outer_surface:
        nearest = cleaned.to_original[cleaned.to_clean]
        away = np.linalg.norm(given.mesh.vertices - given.mesh.vertices[nearest], axis=1)
        is_lost = is_lost & (away > _MAX_DEPTH)
    return np.where(is_lost, 0.0, values[cleaned.to_clean])


def reindexing(source: Shape, target: Shape, divided: bool = False) -> VertexReindexing:
    """Return the numbers of the cleaned meshes of two prepared shapes beside those of the meshes as given.

    ``divided``: whether small meshes are divided, as a search needs them (:attr:`kfmaps.shape.Shape.divided`).
    """
    (cleaned_s, clean_s), (cleaned_t, clean_t) = (
        shape.divided if divided else shape.cleaned for shape in (source, target)
    )
    return VertexReindexing((source, target), cleaned_s, cleaned_t, clean_s, clean_t)
