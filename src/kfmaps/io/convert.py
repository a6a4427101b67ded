"""Convert what Python functions accept as a shape, a map or landmarks: files, arrays, other libraries' objects.

No library is imported for that: an object is recognised by its attributes.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeGuard

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.fmap.precise import PointMap, check_point_map_precise, nearest_vertices
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import check_map, load_map, read_landmarks, read_mesh
from kfmaps.io.named_points import read_landmark_pairs
from kfmaps.io.record import fan, split_polygons
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ShapeFile
from kfmaps.shape import Shape


class HasVertices(Protocol):
    """A mesh of trimesh (``faces``) or Open3D (``triangles``)."""

    @property
    def vertices(self) -> ArrayLike: ...


class HasPoints(Protocol):
    """A mesh of PyVista (``faces``) or meshio (``cells``)."""

    @property
    def points(self) -> ArrayLike: ...


FileName = str | os.PathLike[str]
ShapeLike = Mesh | Shape | FileName | np.ndarray | Sequence[ArrayLike] | HasVertices | HasPoints
"""What a shape may be: a Mesh, a Shape, a file, an array (n, 3), a pair of arrays, or another library's mesh."""
MapLike = Match | PointMap | FileName | ArrayLike
"""What a map may be: a match, points inside triangles, a file, or a source vertex for each target vertex."""
LandmarksLike = FileName | ArrayLike | tuple[FileName, FileName]
"""What landmarks may be: pairs of vertices, a file of them, or a file for each shape."""
TruthLike = ArrayLike | tuple[ArrayLike, ArrayLike]
"""What a truth may be: the source vertex of each target vertex, or corresponding vertices of both."""

_SHAPES = "a Mesh, a file, (vertices, faces), or a mesh of trimesh, PyVista, meshio or Open3D"


def is_file(value: object) -> TypeGuard[FileName]:
    """Return whether ``value`` names a file."""
    return isinstance(value, str | os.PathLike)


def as_mesh(shape: ShapeLike, name: str = "shape") -> Mesh:
    """Return a shape as a mesh, or as a point cloud where it has no faces. Vertices keep their order and number.

    Parameters
    ----------
    shape : Mesh, Shape, path, pair of arrays (n, 3) and (f, 3), array (n, 3), or object
        An object has ``vertices`` and ``faces`` (trimesh) or ``triangles`` (Open3D), or ``points`` with ``faces``
        (PyVista) or ``cells`` (meshio). Polygons become fans of triangles.
    name : str
        How messages call it.

    Raises
    ------
    InvalidInput
        On anything else, and as :func:`kfmaps.read_mesh`.
    """
    if isinstance(shape, Mesh | Shape):
        return shape.mesh if isinstance(shape, Shape) else shape
    if is_file(shape):
        return read_mesh(Path(shape))
    try:
        vertices, faces = _parts(shape)
        return Mesh(np.array(vertices, dtype=np.float64), faces)
    except InvalidInput as error:
        raise InvalidInput(f"{name}: {error}") from error
    except AttributeError as error:
        raise refuse(name, _SHAPES, type(shape).__name__, "give kfmaps.Mesh(vertices, faces)") from error
    except (TypeError, ValueError) as error:
        raise refuse(name, _SHAPES, f"{type(shape).__name__} ({error})", "check its arrays") from error


def _parts(shape: Any) -> tuple[ArrayLike, np.ndarray]:
    """Return vertices and triangles of arrays or of another library's object."""
    if isinstance(shape, np.ndarray):
        return shape, _triangles(())
    if isinstance(shape, tuple | list):
        vertices, faces = shape
        return vertices, _triangles(faces)
    if hasattr(shape, "vertices"):
        faces = getattr(shape, "faces", None)
        return shape.vertices, _triangles(getattr(shape, "triangles", ()) if faces is None else faces)
    if hasattr(shape, "cells_dict"):
        return shape.points, _meshio(shape.cells)
    return shape.points, _triangles(getattr(shape, "faces", ()))


def _triangles(faces: Any) -> np.ndarray:
    """Return faces as triangles; ``faces`` are (f, c), or a flat list of "count, corner, corner, ..." per face."""
    if faces is None or len(faces) == 0:
        return np.zeros((0, 3), dtype=np.int64)
    array = np.asarray(faces)
    if array.dtype.kind not in "iu":
        raise refuse("faces", "whole numbers", f"dtype {array.dtype}", "give vertex numbers")
    if array.ndim == 2 and array.shape[1] >= 3:
        corners = array.shape[1]
        return array.ravel()[fan(np.full(len(array), corners))].astype(np.int64)
    if array.ndim != 1:
        raise refuse("faces", "three vertex numbers per face", f"shape {array.shape}", "give an array (f, 3)")
    corners, sizes = split_polygons(array)
    if sizes.min() < 3:
        raise refuse("faces", "faces of three corners or more", f"one of {sizes.min()}", "leave it out")
    return corners[fan(sizes)]


def _meshio(cells: Any) -> np.ndarray:
    """Return the triangles of meshio's blocks of cells; points and lines are left out, solids are refused."""
    blocks = cells.items() if isinstance(cells, Mapping) else [(block.type, block.data) for block in cells]
    parts = []
    for kind, data in blocks:
        if kind in ("triangle", "quad", "polygon"):
            parts.append(_triangles(np.asarray(data)))
        elif kind not in ("vertex", "line"):
            raise refuse("cells", "triangles or polygons", f"'{kind}'", "extract the surface first")
    return np.concatenate(parts) if parts else np.zeros((0, 3), dtype=np.int64)


def as_landmarks(landmarks: LandmarksLike | None, shapes: Sequence[object] = (), meshes: Sequence[Mesh] = ()) -> Any:
    """Return landmarks as pairs of vertices where files hold them, else as they are.

    ``landmarks``: a file of pairs, or the landmarks of either shape
    (:func:`~kfmaps.io.landmark_files.read_landmark_sets`), paired by the names that both have; ``shapes``: as the
    caller gave them, since their files may name a coordinate system.
    """
    if is_file(landmarks):
        return read_landmarks(Path(landmarks))
    if isinstance(landmarks, tuple | list) and len(landmarks) == 2 and all(map(is_file, landmarks)):
        if any(isinstance(shape, Shape) for shape in shapes):
            remedy = "Give the meshes themselves, or pairs of vertices"
            raise refuse("landmarks", "meshes in the unit of the landmarks' files", "a prepared shape", remedy)
        files = [Path(shape) if is_file(shape) else None for shape in shapes]
        return read_landmark_pairs([Path(str(file)) for file in landmarks], meshes, files)[0]
    return landmarks


def as_map(map: MapLike, source: Mesh | None = None) -> Match:
    """Return a map of any kind as a :class:`~kfmaps.Match`.

    Parameters
    ----------
    map : Match, path, PointMap, or (n_t,) whole numbers
        A match; a file; points inside the source's triangles; or a source vertex
        for each target vertex.
    source : Mesh, optional
        Needed for a PointMap alone, whose triangles are the source's.

    Raises
    ------
    InvalidInput
        On anything else, a PointMap that does not fit the source, and as :func:`kfmaps.load_map`.
    """
    if isinstance(map, Match):
        return map
    if is_file(map):
        return load_map(Path(map))
    if isinstance(map, PointMap):
        if source is None:
            raise refuse("map", "the source of points inside its triangles", "a PointMap alone", "give source=")
        check_point_map_precise(map, source)
        named = ShapeFile(n_vertices=len(source.vertices))
        return Match(target_to_source=nearest_vertices(map, source), precise_map=map, source_file=named)
    try:
        numbers = np.asarray(map, dtype=np.float64)
    except (TypeError, ValueError) as error:
        expected = "a Match, the file of a map, a PointMap, or a source vertex for each target vertex"
        raise refuse("map", expected, type(map).__name__, "give what kfmaps.match returned") from error
    return Match(target_to_source=check_map(numbers, partial=True))
