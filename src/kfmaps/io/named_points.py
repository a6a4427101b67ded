"""Named points, such as landmarks of a study, read from CSV and carried over a map in either direction."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.fmap.precise import PointMap, nearest_vertices, point_positions, vertex_point_map
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io.atomic import atomic_output, check_output
from kfmaps.io.text import REPAIR, is_number, read_csv


@dataclass(frozen=True, eq=False)
class NamedPoints:
    """Points on a surface.

    Attributes
    ----------
    names : tuple of str
    place : PointMap
        Where they lie.
    points : (q, 3) float64
        The same in space, in the mesh's unit.
    vertices : (q,) int64
        The nearest vertices; −1 of a point without counterpart, whose place in space is NaN.
    confidence : (q,) float64
        From 0 to 1, NaN where nothing is known.
    apart : (q,) float64
        How far the point that it was given as lies from the surface, in the mesh's unit.
    """

    names: tuple[str, ...]
    place: PointMap
    points: np.ndarray
    vertices: np.ndarray
    confidence: np.ndarray
    apart: np.ndarray


def read_named_points(path: str | Path, mesh: Mesh) -> NamedPoints:
    """Read points of ``mesh`` from a CSV file: "name, vertex" (0-based) or "name, x, y, z" (in the mesh's unit) a row.

    The name may be left out; then it is the row's number, from 1. A first row of titles is skipped. Points in space go
    to the closest place on the surface.

    Raises
    ------
    InvalidInput
        On rows of another kind, names that are there twice, vertices that do not exist, and an empty file.
    """
    name = str(path)
    rows = [row for _, row in read_csv(path)]
    if rows and not is_number(rows[0][-1]):
        rows = rows[1:]
    if not rows:
        raise refuse(name, "a point a row", "none", 'write "name, vertex" or "name, x, y, z"')
    width = len(rows[0])
    if width not in (1, 2, 3, 4) or any(len(row) != width for row in rows):
        got = f"rows of {', '.join(map(str, sorted({len(row) for row in rows})))} cells"
        raise refuse(name, 'rows "name, vertex" or "name, x, y, z"', got, REPAIR)
    named = width in (2, 4)
    names = tuple(row[0] for row in rows) if named else tuple(str(i + 1) for i in range(len(rows)))
    if len(set(names)) < len(names):
        again = next(one for i, one in enumerate(names) if one in names[:i])
        raise refuse(name, "each name once", f"{again!r} twice", "rename one")
    cells = [row[1:] if named else row for row in rows]
    bad = next((cell for row in cells for cell in row if not is_number(cell)), None)
    if bad is not None:
        raise refuse(name, "numbers after the name", repr(bad), REPAIR)
    values = np.array(cells, dtype=np.float64)
    if not np.isfinite(values).all():
        raise refuse(name, "finite numbers", "NaN or infinite ones", REPAIR)
    known = np.full(len(names), np.nan)
    if values.shape[1] == 1:
        n = len(mesh.vertices)
        vertices = values[:, 0].astype(np.int64)
        if (vertices != values[:, 0]).any() or vertices.min() < 0 or vertices.max() >= n:
            raise refuse(name, f"vertices from 0 to {n - 1}", f"{values.min():g} to {values.max():g}", "count from 0")
        place = vertex_point_map(vertices, mesh)
        return NamedPoints(names, place, mesh.vertices[vertices], vertices, known, np.zeros(len(names)))
    found = closest_points(values, mesh.vertices, mesh.faces)
    place = PointMap(found.faces, found.weights)
    return NamedPoints(names, place, found.points, nearest_vertices(place, mesh), known, found.distances)


def transfer_points(
    given: NamedPoints,
    source: Mesh,
    target: Mesh,
    place: PointMap,
    confidence: np.ndarray | None = None,
    *,
    back: bool = False,
    known: np.ndarray | None = None,
    common: np.ndarray | None = None,
) -> NamedPoints:
    """Carry points of the source to the target, or (``back``) of the target to the source.

    ``place`` is a point of the source for each target vertex. Back is one look-up: between the corners of the face that
    a point lies in. Forth the source's points are sought among the images of the target's faces, flat between those
    of their corners: the closest place on that surface, in the source's space. The confidence is that of the target's
    vertices around the point.

    Of a map of parts ``known (n_t,)`` and ``common (n_s,)`` say which vertices have a counterpart. A point has none
    where most of its face has none: its vertex is −1, its place and confidence are NaN.
    """
    images = point_positions(place, source)
    if back:
        at = np.einsum("qi,qij->qj", given.place.weights, images[target.faces[given.place.faces]])
        found = closest_points(at, source.vertices, source.faces)
        there, mesh, on_target = PointMap(found.faces, found.weights), source, given.place
        # Where a face is torn apart the mean of its corners lies on no surface: then the nearest corner's image.
        torn = found.distances > 0.02 * np.sqrt(surface_area(source))
        if known is not None:
            torn |= ~known[target.faces[given.place.faces]].all(axis=1)
        torn = np.flatnonzero(torn)
        there.faces[torn], there.weights[torn] = place.faces[given.vertices[torn]], place.weights[given.vertices[torn]]
    else:
        rows = np.arange(len(target.faces)) if known is None else np.flatnonzero(known[target.faces].all(axis=1))
        found = closest_points(given.points, images, target.faces[rows])
        there = on_target = PointMap(rows[found.faces], found.weights)
        mesh = target
    trust = np.full(len(given.names), np.nan)
    if confidence is not None:
        trust = np.einsum("qi,qi->q", on_target.weights, confidence[target.faces[on_target.faces]])
    points, vertices = point_positions(there, mesh), nearest_vertices(there, mesh)
    own, on = (known, target) if back else (common, source)
    if own is not None:
        lost = np.einsum("qi,qi->q", given.place.weights, own[on.faces[given.place.faces]]) < 0.5
        points[lost], vertices[lost], trust[lost] = np.nan, -1, np.nan
    return NamedPoints(given.names, there, points, vertices, trust, found.distances)


def select_points(given: NamedPoints, chosen: np.ndarray) -> NamedPoints:
    """Return those of the points that are ``chosen (q,)``."""
    names = tuple(name for name, one in zip(given.names, chosen, strict=True) if one)
    place = PointMap(given.place.faces[chosen], given.place.weights[chosen])
    return NamedPoints(names, place, *(values[chosen] for values in _columns(given)))


def scatter_points(given: NamedPoints, names: tuple[str, ...], chosen: np.ndarray) -> NamedPoints:
    """Put points in the places of those ``chosen`` among all ``names``: the inverse of :func:`select_points`.

    All others, and those with the vertex −1, have no place.
    """
    there = given.vertices >= 0
    rows = np.flatnonzero(chosen)[there]

    def put(values: np.ndarray) -> np.ndarray:
        result = np.full((len(names), *values.shape[1:]), -1 if values.dtype.kind == "i" else np.nan, values.dtype)
        result[rows] = values[there]
        return result

    place = PointMap(put(given.place.faces), put(given.place.weights))
    return NamedPoints(names, place, *map(put, _columns(given)))


def _columns(given: NamedPoints) -> tuple[np.ndarray, ...]:
    return given.points, given.vertices, given.confidence, given.apart


def write_named_points(path: str | Path, points: NamedPoints, force: bool = False) -> None:
    """Write points as CSV: name, nearest vertex, x, y, z in the mesh's unit, confidence.

    Raises
    ------
    InvalidInput
        On another extension than .csv, and as :func:`atomic_output`.
    """
    if Path(path).suffix.lower() != ".csv":
        raise refuse(f"output {path}", "the extension .csv", Path(path).suffix or "none", "rename it")
    check_output(path, force)
    text = io.StringIO(newline="")
    out = csv.writer(text, lineterminator="\n")
    out.writerow(["name", "vertex", "x", "y", "z", "confidence"])
    for i, name in enumerate(points.names):
        known = points.confidence[i]
        place = [repr(x) for x in points.points[i].tolist()]
        out.writerow([name, int(points.vertices[i]), *place, "" if np.isnan(known) else f"{known:.3f}"])
    with atomic_output(path, force) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8", newline="")
