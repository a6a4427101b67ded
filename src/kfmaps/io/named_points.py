"""Named points on surfaces, such as landmarks, and their transfer by a map in either direction."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from kfmaps._arrays import KfmapsWarning, refuse
from kfmaps.fmap.precise import PointMap, nearest_vertices, point_positions, vertex_point_map
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io.atomic import csv_text, table_cell, write_text
from kfmaps.io.index_files import read_landmark_names, read_landmarks
from kfmaps.io.landmark_files import (
    LandmarkSet,
    landmark_stem,
    landmark_suffix,
    mesh_space,
    read_landmark_sets,
    write_landmark_sets,
)
from kfmaps.io.transfer import Counterparts

MAX_DISTANCE = 0.05
"""Median distance of landmarks from the surface, in √area, beyond which they are refused."""
NOTED_DISTANCE = 0.02
"""Distance of one landmark from the surface, in √area, beyond which a warning names it."""
FLIP = np.array([-1.0, -1.0, 1.0])
"""Signs of x, y and z that change LPS to RAS and back."""
MIRRORS = tuple(
    np.array(signs) for signs in ((-1, 1, 1), (1, -1, 1), (1, 1, -1), (-1, 1, -1), (1, -1, -1), (-1, -1, -1))
)
"""Other changes of sign that happen between scanner and mesh; the first three are reflections."""
FACTORS = (0.001, 0.01, 0.1, 10.0, 25.4, 100.0, 1000.0)
"""Factors between units that are often confused: micrometres to metres, and inches."""


@dataclass(frozen=True, eq=False)
class NamedPoints:
    """Points on a surface."""

    names: tuple[str, ...]
    place: PointMap  # where they lie
    points: np.ndarray  # (q, 3): the same in space, in the mesh's unit
    vertices: np.ndarray  # (q,): the nearest vertices; −1 of a missing point, whose ``place`` means nothing
    confidence: np.ndarray  # (q,): from 0 to 1, NaN where it is unknown

    def without(self, missing: np.ndarray) -> NamedPoints:
        """Return the points with those where ``missing (q,)`` is true made missing: NaN in space."""
        return replace(
            self,
            points=np.where(missing[:, None], np.nan, self.points),
            vertices=np.where(missing, -1, self.vertices),
            confidence=np.where(missing, np.nan, self.confidence),
        )


def points_on_surface(
    names: tuple[str, ...], positions: np.ndarray, mesh: Mesh, confidence: np.ndarray | None = None
) -> NamedPoints:
    """Return the points of a surface that are closest to ``positions (q, 3)``; NaN stands for a missing point."""
    missing = ~np.asarray(np.isfinite(positions).all(axis=1))
    closest = closest_points(np.where(missing[:, None], mesh.vertices[0], positions), mesh.vertices, mesh.faces)
    place = PointMap(closest.faces, closest.weights)
    confidences = np.full(len(names), np.nan) if confidence is None else confidence
    return NamedPoints(names, place, closest.points, nearest_vertices(place, mesh), confidences).without(missing)


def read_named_points(path: str | Path, mesh: Mesh, *, specimen: str = "", space: str = "") -> NamedPoints:
    """Read landmarks of ``mesh`` from a file of :func:`~kfmaps.io.landmark_files.read_landmark_sets`.

    ``specimen``: the one whose landmarks are taken from a file of several; ``space`` ("LPS", "RAS" or ""): the mesh's
    coordinate system, where it is known (:func:`~kfmaps.io.landmark_files.mesh_space`).
    """
    sets, name = read_landmark_sets(path), str(path)
    landmarks = next((one for one in sets if specimen and specimen in (one.specimen, Path(one.specimen).stem)), None)
    if landmarks is None and len(sets) > 1:
        got = ", ".join(one.specimen for one in sets[:5])
        remedy = "call the specimen as the scan's file is called"
        raise refuse(name, f"the landmarks of {specimen or 'one specimen'}", f"those of {got}", remedy)
    return place_landmarks(landmarks or sets[0], mesh, name, space=space)


def place_landmarks(landmarks: LandmarkSet, mesh: Mesh, name: str, *, space: str = "") -> NamedPoints:
    """Project landmarks to the closest points of a mesh's surface; missing ones stay missing.

    Where file and mesh name different coordinate systems, x and y change their sign. Where one of them names none and
    the points lie on the surface only with the other sign, they change too, with a warning.

    ``name``: of the landmarks in messages; ``space`` ("LPS", "RAS" or ""): the mesh's coordinate system.
    """
    if landmarks.vertices is not None:
        n, vertices = len(mesh.vertices), landmarks.vertices
        if vertices.min() < 0 or vertices.max() >= n:
            raise refuse(name, f"vertices from 0 to {n - 1}", f"{vertices.min()} to {vertices.max()}", "count from 0")
        place, unknown = vertex_point_map(vertices, mesh), np.full(len(vertices), np.nan)
        return NamedPoints(landmarks.names, place, mesh.vertices[vertices], vertices, unknown)
    if np.isnan(landmarks.points).any(axis=1).all():
        raise refuse(name, "landmarks with coordinates", "missing ones only", "place them first")
    both_named, unit = bool(space and landmarks.space), float(np.sqrt(surface_area(mesh)))
    points = landmarks.points * FLIP if both_named and space != landmarks.space else landmarks.points
    result, distances = _project(landmarks.names, points, mesh)
    if np.nanmedian(distances) > MAX_DISTANCE * unit:
        remedy = _explain_distance(landmarks.names, points, mesh, both_named)
        if remedy:
            got = f"a median distance of {np.nanmedian(distances):.3g} (√area {unit:.3g})"
            raise refuse(name, "landmarks on the surface", got, remedy)
        text = "x and y are negated, since the landmarks lie on the mesh that way (LPS and RAS)"
        warnings.warn(f"{name}: {text}", KfmapsWarning, stacklevel=3)
        result, distances = _project(landmarks.names, points * FLIP, mesh)
    distant = np.flatnonzero(distances > NOTED_DISTANCE * unit)
    if len(distant):
        names = ", ".join(f"{landmarks.names[i]} ({distances[i]:.3g})" for i in distant[:5])
        more = f" and {len(distant) - 5} more" if len(distant) > 5 else ""
        warnings.warn(f"{name}: far from the surface, in its unit: {names}{more}", KfmapsWarning, stacklevel=3)
    return result


def _project(names: tuple[str, ...], points: np.ndarray, mesh: Mesh) -> tuple[NamedPoints, np.ndarray]:
    """Return the closest points of the surface, and their distances from ``points``."""
    closest = points_on_surface(names, points, mesh)
    return closest, np.linalg.norm(closest.points - points, axis=1)


def _explain_distance(names: tuple[str, ...], points: np.ndarray, mesh: Mesh, both_named: bool) -> str:
    """Return why landmarks are far from the surface, and what to do.

    Empty where negating x and y is enough, and file and mesh have not ``both_named`` their coordinate systems.
    """
    mixed = "They lie on it with x and y negated: LPS and RAS are mixed up in the mesh or in the landmarks"
    remedies: list[tuple[np.ndarray | float, str]] = [(FLIP, mixed if both_named else "")]
    for signs in MIRRORS:
        axes = " and ".join(axis for axis, sign in zip("xyz", signs, strict=True) if sign < 0)
        kind = "a mirror image of" if np.prod(signs) < 0 else "turned against"
        remedies.append((signs, f"They lie on it with {axes} negated: the mesh is {kind} what was digitized"))
    remedies += [(factor, f"They lie on it times {factor:g}. Bring both to one unit") for factor in FACTORS]
    for change, remedy in remedies:
        if np.nanmedian(_project(names, points * change, mesh)[1]) < NOTED_DISTANCE * np.sqrt(surface_area(mesh)):
            return remedy
    return "check that they belong to this mesh, in its unit and coordinate system"


def read_landmark_pairs(
    files: Sequence[str | Path], meshes: Sequence[Mesh], mesh_files: Sequence[Path | None]
) -> tuple[np.ndarray, list[str]]:
    """Read the landmarks of two shapes and pair them by name.

    ``files``: of source and target, as for :func:`read_named_points`; ``mesh_files``: of the meshes, whose names tell
    the specimen and whose heads may name a coordinate system. Returns the vertices nearest to the landmarks, (l, 2),
    and their names.
    """
    sides = [
        read_named_points(
            path, mesh, specimen="" if file is None else file.stem, space="" if file is None else mesh_space(file)
        )
        for path, mesh, file in zip(files, meshes, mesh_files, strict=True)
    ]
    by_name = [{name: v for name, v in zip(one.names, one.vertices.tolist(), strict=True) if v >= 0} for one in sides]
    names = [name for name in by_name[0] if name in by_name[1]]
    if not names:
        got = " and ".join(f"{', '.join(list(one)[:3])}, ..." for one in by_name)
        raise refuse("landmarks", "names that both shapes have", got, "label them alike")
    return np.array([[one[name] for one in by_name] for name in names], dtype=np.int64), names


def read_given_landmarks(
    files: Sequence[Path], meshes: Sequence[Mesh], mesh_files: Sequence[Path | None], one_based: bool | None = None
) -> tuple[np.ndarray, list[str]]:
    """Return pairs (l, 2) and names from one file of pairs of vertices, or from a file of landmarks for each shape."""
    if len(files) == 2:
        return read_landmark_pairs(files, meshes, mesh_files)
    if len(files) != 1 or landmark_suffix(files[0]):
        got = "those of one shape" if len(files) == 1 else f"{len(files)} files"
        remedy = "Give --landmarks twice, first the source's and then the target's, or a file of pairs"
        raise refuse("landmarks", "a file of pairs, or a file for each shape", got, remedy)
    return read_landmarks(files[0], one_based=one_based), read_landmark_names(files[0])


def transfer_points(
    points: NamedPoints, counterparts: Counterparts, confidence: np.ndarray | None = None, *, back: bool = False
) -> NamedPoints:
    """Transfer points from the source to the target, or ``back``; missing ones stay missing.

    A point of the target goes to the mean of the images of its face's corners. A point of the source goes to the
    closest point of the surface that those images form. The confidence is that of the target's vertices around the
    point, ``confidence (n_t,)``. A point becomes missing where most of its face has no counterpart.
    """
    (source, target), images_at, matched = counterparts.meshes, counterparts.place, counterparts.target
    images, missing = point_positions(images_at, source), points.vertices < 0
    if back:
        corners = target.faces[points.place.faces]
        closest = closest_points(
            np.einsum("qi,qij->qj", points.place.weights, images[corners]), source.vertices, source.faces
        )
        place, mesh, on_target = PointMap(closest.faces, closest.weights), source, points.place
        # The mean of corners that the map tears apart lies on no surface; the nearest corner's image is taken there.
        is_distant = closest.distances > 0.02 * np.sqrt(surface_area(source))
        torn = np.flatnonzero(is_distant | ~matched[corners].all(axis=1))
        place.faces[torn], place.weights[torn] = (
            images_at.faces[points.vertices[torn]],
            images_at.weights[points.vertices[torn]],
        )
    else:
        rows = np.flatnonzero(matched[target.faces].all(axis=1))
        closest = closest_points(np.where(missing[:, None], images[0], points.points), images, target.faces[rows])
        place = on_target = PointMap(rows[closest.faces], closest.weights)
        mesh = target
    confidences = np.full(len(points.names), np.nan)
    if confidence is not None:
        confidences = np.einsum("qi,qi->q", on_target.weights, confidence[target.faces[on_target.faces]])
    is_matched, own_mesh = (matched, target) if back else (counterparts.source, source)
    missing = missing | (
        np.einsum("qi,qi->q", points.place.weights, is_matched[own_mesh.faces[points.place.faces]]) < 0.5
    )
    transferred = NamedPoints(
        points.names, place, point_positions(place, mesh), nearest_vertices(place, mesh), confidences
    )
    return transferred.without(missing)


def write_named_points(path: str | Path, points: NamedPoints, force: bool = False, space: str = "") -> None:
    """Write points: CSV with name, nearest vertex, x, y, z and confidence, or another format of landmark files.

    ``force``: whether an existing file is replaced; ``space`` ("LPS", "RAS" or ""): the mesh's coordinate system, for
    formats that name it.
    """
    if Path(path).suffix.lower() != ".csv":
        write_landmark_sets(path, [LandmarkSet(points.names, points.points, landmark_stem(path), space)], force)
        return
    rows: list[list[object]] = [["name", "vertex", "x", "y", "z", "confidence"]]
    for i, name in enumerate(points.names):
        confidence = points.confidence[i]
        cell = "" if np.isnan(confidence) else f"{confidence:.3f}"
        rows.append([name, int(points.vertices[i]), *map(table_cell, points.points[i]), cell])
    write_text(path, csv_text(rows), force)
