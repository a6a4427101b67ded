"""Named points on surfaces, such as landmarks of a study, and their transfer over a map in either direction."""

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
"""Distance of one landmark from the surface, in √area, beyond which it is named."""
FLIP = np.array([-1.0, -1.0, 1.0])
"""From LPS to RAS and back."""
MIRRORS = tuple(
    np.array(signs) for signs in ((-1, 1, 1), (1, -1, 1), (1, 1, -1), (-1, 1, -1), (1, -1, -1), (-1, -1, -1))
)
"""Other changes of sign that happen between scanner and mesh; the first are reflections."""
FACTORS = (0.001, 0.01, 0.1, 10.0, 25.4, 100.0, 1000.0)
"""Units that are mixed up: micrometres to metres, and inches."""


@dataclass(frozen=True, eq=False)
class NamedPoints:
    """Points on a surface."""

    names: tuple[str, ...]
    place: PointMap  # where they lie
    points: np.ndarray  # (q, 3): the same in space, in the mesh's unit
    vertices: np.ndarray  # (q,): the nearest vertices; −1 of a missing point, of which the rest means nothing
    confidence: np.ndarray  # (q,): from 0 to 1, NaN where nothing is known

    def without(self, lost: np.ndarray) -> NamedPoints:
        """Return the points of which those that are ``lost (q,)`` are missing: NaN in space."""
        return replace(
            self,
            points=np.where(lost[:, None], np.nan, self.points),
            vertices=np.where(lost, -1, self.vertices),
            confidence=np.where(lost, np.nan, self.confidence),
        )


def points_on_surface(
    names: tuple[str, ...], positions: np.ndarray, mesh: Mesh, confidence: np.ndarray | None = None
) -> NamedPoints:
    """Return the points of a surface that are closest to ``positions (q, 3)``; those of NaN are missing.

    ``confidence (q,)``: NaN where it is not given.
    """
    lost = ~np.asarray(np.isfinite(positions).all(axis=1))
    found = closest_points(np.where(lost[:, None], mesh.vertices[0], positions), mesh.vertices, mesh.faces)
    place = PointMap(found.faces, found.weights)
    known = np.full(len(names), np.nan) if confidence is None else confidence
    return NamedPoints(names, place, found.points, nearest_vertices(place, mesh), known).without(lost)


def read_named_points(path: str | Path, mesh: Mesh, *, specimen: str = "", space: str = "") -> NamedPoints:
    """Read landmarks of ``mesh`` from a file of :func:`~kfmaps.io.landmark_files.read_landmark_sets`.

    ``specimen``: whose landmarks are taken from a file of several specimens; ``space`` ("LPS", "RAS" or ""): the mesh's
    coordinate system, where it is known (:func:`~kfmaps.io.landmark_files.mesh_space`).
    """
    sets, name = read_landmark_sets(path), str(path)
    own = next((one for one in sets if specimen and specimen in (one.specimen, Path(one.specimen).stem)), None)
    if own is None and len(sets) > 1:
        got = ", ".join(one.specimen for one in sets[:5])
        remedy = "call the specimen as the scan's file is called"
        raise refuse(name, f"the landmarks of {specimen or 'one specimen'}", f"those of {got}", remedy)
    return place_landmarks(own or sets[0], mesh, name, space=space)


def place_landmarks(given: LandmarkSet, mesh: Mesh, name: str, *, space: str = "") -> NamedPoints:
    """Put landmarks on the surface of a mesh: each goes to its closest point, missing ones stay without a place.

    Where file and mesh name different coordinate systems, x and y change their sign. Where one of them names none and
    the points lie on the surface only with the other sign, they are turned as well, with a warning.

    ``name``: how messages call the landmarks; ``space`` ("LPS", "RAS" or ""): the mesh's coordinate system.
    """
    if given.vertices is not None:
        n, vertices = len(mesh.vertices), given.vertices
        if vertices.min() < 0 or vertices.max() >= n:
            raise refuse(name, f"vertices from 0 to {n - 1}", f"{vertices.min()} to {vertices.max()}", "count from 0")
        place, nothing = vertex_point_map(vertices, mesh), np.full(len(vertices), np.nan)
        return NamedPoints(given.names, place, mesh.vertices[vertices], vertices, nothing)
    if np.isnan(given.points).any(axis=1).all():
        raise refuse(name, "landmarks with coordinates", "missing ones only", "place them first")
    sure, unit = bool(space and given.space), float(np.sqrt(surface_area(mesh)))
    points = given.points * FLIP if sure and space != given.space else given.points
    placed, apart = _placed(given.names, points, mesh)
    if np.nanmedian(apart) > MAX_DISTANCE * unit:
        remedy = _explain_distance(given.names, points, mesh, sure)
        if remedy:
            got = f"a median distance of {np.nanmedian(apart):.3g} (√area {unit:.3g})"
            raise refuse(name, "landmarks on the surface", got, remedy)
        text = "x and y are negated, since the landmarks lie on the mesh that way (LPS and RAS)"
        warnings.warn(f"{name}: {text}", KfmapsWarning, stacklevel=3)
        placed, apart = _placed(given.names, points * FLIP, mesh)
    far = np.flatnonzero(apart > NOTED_DISTANCE * unit)
    if len(far):
        told = ", ".join(f"{given.names[i]} ({apart[i]:.3g})" for i in far[:5])
        more = f" and {len(far) - 5} more" if len(far) > 5 else ""
        warnings.warn(f"{name}: far from the surface, in its unit: {told}{more}", KfmapsWarning, stacklevel=3)
    return placed


def _placed(names: tuple[str, ...], points: np.ndarray, mesh: Mesh) -> tuple[NamedPoints, np.ndarray]:
    """The closest points of the surface, and how far they are from ``points``."""
    placed = points_on_surface(names, points, mesh)
    return placed, np.linalg.norm(placed.points - points, axis=1)


def _explain_distance(names: tuple[str, ...], points: np.ndarray, mesh: Mesh, sure: bool) -> str:
    """Return why landmarks are far from the surface, and what to do.

    Empty where only x and y are to be negated: where it is not ``sure``, since file and mesh do not both name their
    coordinate systems.
    """
    mixed = "They lie on it with x and y negated: LPS and RAS are mixed up in the mesh or in the landmarks"
    remedies: list[tuple[np.ndarray | float, str]] = [(FLIP, mixed if sure else "")]
    for signs in MIRRORS:
        axes = " and ".join(axis for axis, sign in zip("xyz", signs, strict=True) if sign < 0)
        kind = "a mirror image of" if np.prod(signs) < 0 else "turned against"
        remedies.append((signs, f"They lie on it with {axes} negated: the mesh is {kind} what was digitized"))
    remedies += [(factor, f"They lie on it times {factor:g}. Bring both to one unit") for factor in FACTORS]
    for change, remedy in remedies:
        if np.nanmedian(_placed(names, points * change, mesh)[1]) < NOTED_DISTANCE * np.sqrt(surface_area(mesh)):
            return remedy
    return "check that they belong to this mesh, in its unit and coordinate system"


def read_landmark_pairs(
    files: Sequence[str | Path], meshes: Sequence[Mesh], mesh_files: Sequence[Path | None]
) -> tuple[np.ndarray, list[str]]:
    """Read the landmarks of two shapes and pair them by name.

    ``files (source, target)``: as of :func:`read_named_points`; ``meshes (source, target)``; ``mesh_files (source,
    target)``: where the meshes came from: their names and coordinate systems count. Returns (l, 2): the vertices
    nearest to the landmarks; their names.
    """
    both = [
        read_named_points(
            path, mesh, specimen="" if file is None else file.stem, space="" if file is None else mesh_space(file)
        )
        for path, mesh, file in zip(files, meshes, mesh_files, strict=True)
    ]
    placed = [{name: v for name, v in zip(one.names, one.vertices.tolist(), strict=True) if v >= 0} for one in both]
    names = [name for name in placed[0] if name in placed[1]]
    if not names:
        got = " and ".join(f"{', '.join(list(one)[:3])}, ..." for one in placed)
        raise refuse("landmarks", "names that both shapes have", got, "label them alike")
    return np.array([[one[name] for one in placed] for name in names], dtype=np.int64), names


def read_given_landmarks(
    files: Sequence[Path], meshes: Sequence[Mesh], mesh_files: Sequence[Path | None], one_based: bool | None = None
) -> tuple[np.ndarray, list[str]]:
    """Read one file of pairs of vertices, or two files with the landmarks of either shape; pairs (l, 2) and names."""
    if len(files) == 2:
        return read_landmark_pairs(files, meshes, mesh_files)
    if len(files) != 1 or landmark_suffix(files[0]):
        got = "those of one shape" if len(files) == 1 else f"{len(files)} files"
        remedy = "Give --landmarks twice, first the source's and then the target's, or a file of pairs"
        raise refuse("landmarks", "a file of pairs, or a file for each shape", got, remedy)
    return read_landmarks(files[0], one_based=one_based), read_landmark_names(files[0])


def transfer_points(
    given: NamedPoints, ways: Counterparts, confidence: np.ndarray | None = None, *, back: bool = False
) -> NamedPoints:
    """Carry points of the source to the target, or (``back``) of the target to the source; missing ones stay missing.

    Back is one look-up: between the corners of the face that a point lies in. Forth the source's points are sought
    among the images of the target's faces, flat between those of their corners: the closest place on that surface, in
    the source's space. The confidence is that of the target's vertices around the point, ``confidence (n_t,)``.

    A point has no counterpart where most of its face has none, and becomes a missing one.
    """
    (source, target), place, known = ways.meshes, ways.place, ways.target
    images, lost = point_positions(place, source), given.vertices < 0
    if back:
        corners = target.faces[given.place.faces]
        found = closest_points(
            np.einsum("qi,qij->qj", given.place.weights, images[corners]), source.vertices, source.faces
        )
        there, mesh, on_target = PointMap(found.faces, found.weights), source, given.place
        # Where a face is torn apart the mean of its corners lies on no surface: then the nearest corner's image.
        far = found.distances > 0.02 * np.sqrt(surface_area(source))
        torn = np.flatnonzero(far | ~known[corners].all(axis=1))
        there.faces[torn], there.weights[torn] = place.faces[given.vertices[torn]], place.weights[given.vertices[torn]]
    else:
        rows = np.flatnonzero(known[target.faces].all(axis=1))
        found = closest_points(np.where(lost[:, None], images[0], given.points), images, target.faces[rows])
        there = on_target = PointMap(rows[found.faces], found.weights)
        mesh = target
    trust = np.full(len(given.names), np.nan)
    if confidence is not None:
        trust = np.einsum("qi,qi->q", on_target.weights, confidence[target.faces[on_target.faces]])
    own, on = (known, target) if back else (ways.source, source)
    lost = lost | (np.einsum("qi,qi->q", given.place.weights, own[on.faces[given.place.faces]]) < 0.5)
    carried = NamedPoints(given.names, there, point_positions(there, mesh), nearest_vertices(there, mesh), trust)
    return carried.without(lost)


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
        known = points.confidence[i]
        sure = "" if np.isnan(known) else f"{known:.3f}"
        rows.append([name, int(points.vertices[i]), *map(table_cell, points.points[i]), sure])
    write_text(path, csv_text(rows), force)
