"""The web page of one result: what it shows, gathered into one self-contained file."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from kfmaps._arrays import check, check_count, refuse
from kfmaps.cli.words import VERDICTS, verdict_text
from kfmaps.fmap.convert import nearest_reached
from kfmaps.fmap.evaluate import area_distortion
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io import MeshFile, check_map, projected_uv
from kfmaps.io.transfer import LOST_GREY, transfer
from kfmaps.matching.result import Match
from kfmaps.viz.camera import broad_side, fit_rotation, rotation_between
from kfmaps.viz.colors import position_colors
from kfmaps.viz.document import document, encode_floats, encode_integers


def shape_record(mesh: Mesh, name: str) -> dict[str, Any]:
    """Return a mesh as the page reads it: name, positions (centred, unit area), faces."""
    placed = unit_area(mesh).vertices
    placed = placed - (placed.min(axis=0) + placed.max(axis=0)) / 2
    return {"name": name, "positions": encode_floats(placed), "faces": encode_integers(mesh.faces)}


def source_record(mesh: Mesh, name: str, colors: np.ndarray | None = None) -> dict[str, Any]:
    """Return :func:`shape_record` with colours, by default those of positions, and texture coordinates to transfer."""
    colors = position_colors(mesh) if colors is None else colors
    return {**shape_record(mesh, name), **_painted(colors, projected_uv(mesh.vertices))}


def _painted(colors: np.ndarray, plane: np.ndarray) -> dict[str, Any]:
    return {"colours": encode_integers(np.rint(255 * colors).astype(np.uint8)), "plane": encode_floats(plane)}


def _transferred(match: Match, source: Mesh, colors: np.ndarray) -> dict[str, Any]:
    """What :func:`source_record` paints, mixed inside triangles at the target's vertices; empty without such points."""
    if match.precise_map is None:
        return {}
    given = (colors, LOST_GREY), (projected_uv(source.vertices), 0.0)
    return _painted(*(transfer(values, match, source.faces, lost) for values, lost in given))


def map_record(source: Mesh, target: Mesh, target_to_source: np.ndarray, label: str) -> dict[str, Any]:
    """Return a point map as the page reads it: the map, its links back from the source, its distortion of area.

    A vertex without counterpart has the number after the source's last.
    """
    lost = target_to_source < 0
    return {
        "label": label,
        "points": encode_integers(np.where(lost, len(source.vertices), target_to_source)),
        "nearest": encode_integers(nearest_reached(source, target_to_source)),
        "distortion": encode_floats(area_distortion(source, target, target_to_source)),
    }


def verdict_record(summary: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return the verdict that ``summary`` names, in words; ``None`` where it names none."""
    kind = summary.get("verdict")
    if not isinstance(kind, str) or kind not in VERDICTS:
        return None
    confidence = summary.get("confidence")
    return {"kind": kind, "text": verdict_text(kind, summary.get("landmarks", 0)), "confidence": confidence}


def views_record(source: Mesh, target: Mesh, target_to_source: np.ndarray | None = None) -> dict[str, Any]:
    """Return the source's camera axes, and the rotation from how the source lies to how the target lies.

    The rotation is the shapes' own (:func:`~kfmaps.viz.camera.rotation_between`), so that both are seen from
    the same side of the body whatever the map says.
    """
    turn = rotation_between(source, target, target_to_source)
    return {"frame": broad_side(source).axes().ravel(), "turn": (np.eye(3) if turn is None else turn).ravel()}


def check_up(up: str | None) -> str | None:
    """Return ``up`` when it is an axis, or ``None``: found from the shape."""
    if up not in (None, "x", "y", "z"):
        raise refuse("up", "x, y or z", repr(up), "name the axis that points upwards")
    return up


def _fields(maps: int, n_t: int, **given: Any) -> dict[str, Any]:
    """Numbers at target vertices, of the best map alone or of every map."""
    fields = {}
    for name, values in given.items():
        if values is None:
            continue
        rows = np.atleast_2d(np.asarray(values, dtype=np.float64))
        check(rows, name, shape=(None, n_t), finite=False, remedy="give one number per target vertex")
        if len(rows) not in (1, maps):
            raise refuse(name, f"one row, or one for each of {maps} maps", f"{len(rows)}", "leave some out")
        fields[name] = [encode_floats(row) for row in rows]
    return fields


def _texture_record(shape: MeshFile) -> dict[str, Any]:
    """The texture coordinates of a shape, for each corner of its faces, and its picture as a data address."""
    assert shape.uv is not None
    assert shape.uv_faces is not None
    assert shape.picture is not None
    data = base64.b64encode(shape.picture.data).decode("ascii")
    corners = encode_integers(shape.uv_faces.ravel())
    return {"uv": encode_floats(shape.uv), "corners": corners, "picture": f"data:{shape.picture.kind};base64,{data}"}


def _descriptors(
    descriptors: tuple[np.ndarray, np.ndarray] | None, source: Mesh, target: Mesh, most: int
) -> list[dict[str, Any]]:
    """Up to ``most`` columns, spread over all of them, each on one scale for both shapes."""
    if descriptors is None:
        return []
    pair = [np.asarray(d, dtype=np.float64) for d in descriptors]
    for array, mesh, name in zip(pair, (source, target), ("source", "target"), strict=True):
        shape = (len(mesh.vertices), None)
        check(array, f"descriptors of the {name}", shape=shape, remedy="give one row per vertex")
    if pair[0].shape[1] != pair[1].shape[1]:
        wanted = "as many columns on both shapes"
        raise refuse("descriptors", wanted, f"{pair[0].shape[1]} and {pair[1].shape[1]}", "compute both alike")
    count = pair[0].shape[1]
    chosen = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int)) if count else []
    return [
        {"number": int(j), "source": encode_floats(pair[0][:, j]), "target": encode_floats(pair[1][:, j])}
        for j in chosen
    ]


def result_page(
    source: Mesh,
    target: Mesh,
    target_to_source: np.ndarray | Match,
    *,
    functional_map: np.ndarray | None = None,
    errors: np.ndarray | None = None,
    confidence: np.ndarray | None = None,
    alternatives: Sequence[np.ndarray] | np.ndarray = (),
    descriptors: tuple[np.ndarray, np.ndarray] | None = None,
    most_descriptors: int = 12,
    summary: Mapping[str, Any] | None = None,
    names: tuple[str, str] = ("source", "target"),
    up: str | None = None,
    common: np.ndarray | None = None,
    textures: tuple[MeshFile, MeshFile] | None = None,
) -> str:
    """Return one HTML file that shows a map: it needs no network, no server and nothing beside it.

    Parameters
    ----------
    source, target : Mesh
        Surfaces, or point clouds.
    target_to_source : (n_t,) int or Match
        A source vertex for each target vertex; −1 where there is none, which is grey. Colours and the pattern are mixed
        inside triangles where a match has points there.
    functional_map : (k_t, k_s), optional
        Shown as a picture.
    errors : (n_t,) or (1 + c, n_t), optional
        Distance on the source from each image to the truth, in units of √area; one row for the map, or one
        more for each alternative. NaN where the truth is not known.
    confidence : (n_t,) or (1 + c, n_t), optional
        From 0 to 1, higher is surer, as :func:`kfmaps.fmap.confidence.local_confidence` has it; rows as
        for ``errors``.
    alternatives : (c, n_t) int
        Other maps, to be switched to.
    descriptors : ((n_s, d), (n_t, d)), optional
        Up to ``most_descriptors`` of the d columns are put in the page.
    summary : mapping, optional
        Anything JSON can hold. The page knows ``settings``, ``energies`` and ``times`` (mappings, seconds),
        ``residuals`` (a list, drawn as a curve) and lists all else as it is.
    names : (str, str)
        Any text, shown as text.
    up : {"x", "y", "z"}, optional
        The shapes' vertical axis; by default a good side is found. It can be changed in the page.
    common : (n_s,) bool, optional
        Of a part and a whole, which source vertices are on both; the others are grey.
    textures : (MeshFile, MeshFile), optional
        Both shapes with coordinates and a picture, which are shown instead of a pattern.

    Returns
    -------
    str
        The page, to be written as UTF-8.

    Raises
    ------
    InvalidInput
        On arrays that do not fit the two shapes.
    """
    check_up(up)
    check_count(most_descriptors, "most_descriptors", low=0)
    sizes = len(source.vertices), len(target.vertices)
    points = [check_map(target_to_source, *sizes, lost=True)]
    points += [check_map(m, *sizes, f"alternative {i}") for i, m in enumerate(alternatives, 1)]
    labels = ["Best map"] + [f"Alternative {i}" for i in range(1, len(points))]
    matrix = None
    if functional_map is not None:
        matrix = check(np.asarray(functional_map, dtype=np.float64), "functional_map", shape=(None, None))
    colors = position_colors(source)
    if common is not None:
        colors = np.where(common[:, None], colors, LOST_GREY)
    maps = [map_record(source, target, m, label) for m, label in zip(points, labels, strict=True)]
    if isinstance(target_to_source, Match):
        maps[0] |= _transferred(target_to_source, source, colors)
    data = {
        "kind": "result",
        "up": up or "auto",
        "views": views_record(source, target, points[0]),
        "verdict": verdict_record(summary or {}),
        "source": source_record(source, names[0], colors),
        "target": shape_record(target, names[1]),
        "rotation": _rotation_by_map(source, target, points[0]).ravel(),
        "maps": maps,
        **_fields(len(points), len(target.vertices), errors=errors, confidence=confidence),
        "descriptors": _descriptors(descriptors, source, target, most_descriptors),
        "matrix": None if matrix is None else encode_floats(matrix),
        "textures": [_texture_record(shape) for shape in textures or ()],
        "summary": summary or {},
    }
    return document("result.html.j2", title=f"{names[0]} → {names[1]}", data=data)


def _rotation_by_map(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Return the rotation, (3, 3), that turns the target's vertices best onto their matches (Kabsch 1976)."""
    known = np.asarray(target_to_source) >= 0
    if not known.any():
        return np.eye(3)
    there = source.vertices[np.asarray(target_to_source)[known]]
    here = target.vertices[known] - target.vertices[known].mean(axis=0)
    return fit_rotation(here, there - there.mean(axis=0))[0]
