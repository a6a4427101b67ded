"""The web page of one result: what it shows, gathered into one self-contained file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.cli.words import VERDICTS, verdict_text
from kfmaps.fmap.convert import nearest_reached
from kfmaps.fmap.evaluate import area_distortion
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io import MeshFile, check_map, projected_uv
from kfmaps.io.transfer import LOST_GREY, transfer
from kfmaps.matching.result import Match
from kfmaps.viz.camera import broad_side, fit_rotation, rotation_between
from kfmaps.viz.colors import position_colors
from kfmaps.viz.document import data_address, document, encode_floats, encode_integers


def shape_record(mesh: Mesh, name: str) -> dict[str, object]:
    """Return a mesh as the page reads it: name, positions (centred, unit area), faces."""
    placed = unit_area(mesh).vertices
    placed = placed - (placed.min(axis=0) + placed.max(axis=0)) / 2
    return {"name": name, "positions": encode_floats(placed), "faces": encode_integers(mesh.faces)}


def source_record(mesh: Mesh, name: str, colors: np.ndarray | None = None) -> dict[str, object]:
    """Return :func:`shape_record` with colours, by default those of positions, and texture coordinates to transfer."""
    colors = position_colors(mesh) if colors is None else colors
    return {**shape_record(mesh, name), **_painted(colors, projected_uv(mesh.vertices))}


def _painted(colors: np.ndarray, plane: np.ndarray) -> dict[str, object]:
    return {"colours": encode_integers(np.rint(255 * colors).astype(np.uint8)), "plane": encode_floats(plane)}


def _transferred(match: Match, source: Mesh, colors: np.ndarray) -> dict[str, object]:
    """What :func:`source_record` paints, mixed inside triangles at the target's vertices; empty without such points."""
    if match.precise_map is None:
        return {}
    given = (colors, LOST_GREY), (projected_uv(source.vertices), 0.0)
    return _painted(*(transfer(values, match, source.faces, lost) for values, lost in given))


def map_record(source: Mesh, target: Mesh, target_to_source: np.ndarray, label: str) -> dict[str, object]:
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


def verdict_record(summary: Mapping[str, Any]) -> dict[str, object] | None:
    """Return the verdict that ``summary`` names, in words; ``None`` where it names none."""
    kind = summary.get("verdict")
    if not isinstance(kind, str) or kind not in VERDICTS:
        return None
    confidence = summary.get("confidence")
    return {"kind": kind, "text": verdict_text(kind, summary.get("landmarks", 0)), "confidence": confidence}


def views_record(source: Mesh, target: Mesh, target_to_source: np.ndarray | None = None) -> dict[str, object]:
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


def _texture_record(shape: MeshFile) -> dict[str, object]:
    """The texture coordinates of a shape, for each corner of its faces, and its picture as a data address."""
    assert shape.uv is not None
    assert shape.uv_faces is not None
    assert shape.picture is not None
    corners = encode_integers(shape.uv_faces.ravel())
    picture = data_address(shape.picture.kind, shape.picture.data)
    return {"uv": encode_floats(shape.uv), "corners": corners, "picture": picture}


@dataclass(frozen=True, eq=False)
class ResultPage:
    """What the page of a map shows."""

    source: Mesh
    target: Mesh
    target_to_source: np.ndarray | Match  # with points inside triangles colours and the pattern are mixed there
    functional_map: np.ndarray | None = None
    # (m, n_t): distances on the source in √area, and confidence, a row for the map, or one for each alternative too;
    # NaN is unknown.
    errors: np.ndarray | None = None
    confidence: np.ndarray | None = None
    alternatives: Sequence[np.ndarray] = ()
    descriptors: tuple[np.ndarray, np.ndarray] | None = None  # with the same columns on both shapes
    # Anything that JSON can hold: the page knows ``settings``, ``energies``, ``times`` (mappings) and ``residuals`` (a
    # list), and lists all else.
    summary: Mapping[str, object] = field(default_factory=dict)
    names: tuple[str, str] = ("source", "target")
    up: str | None = None
    common: np.ndarray | None = None  # (n_s,): where it is false the source is grey
    textures: tuple[MeshFile, MeshFile] | None = None  # both shapes with a picture, shown instead of a pattern

    def html(self) -> str:
        """Return one HTML file that needs no network, no server and nothing beside it."""
        source, target = self.source, self.target
        sizes = len(source.vertices), len(target.vertices)
        points = [check_map(self.target_to_source, *sizes, lost=True)]
        points += [check_map(m, *sizes, f"alternative {i}") for i, m in enumerate(self.alternatives, 1)]
        labels = ["Best map"] + [f"Alternative {i}" for i in range(1, len(points))]
        colors = position_colors(source)
        if self.common is not None:
            colors = np.where(self.common[:, None], colors, LOST_GREY)
        maps = [map_record(source, target, m, label) for m, label in zip(points, labels, strict=True)]
        if isinstance(self.target_to_source, Match):
            maps[0] |= _transferred(self.target_to_source, source, colors)
        known = {"errors": self.errors, "confidence": self.confidence}
        both = zip(*(part.T for part in self.descriptors), strict=True) if self.descriptors else ()
        data = {
            "kind": "result",
            "up": check_up(self.up) or "auto",
            "views": views_record(source, target, points[0]),
            "verdict": verdict_record(self.summary),
            "source": source_record(source, self.names[0], colors),
            "target": shape_record(target, self.names[1]),
            "rotation": _rotation_by_map(source, target, points[0]).ravel(),
            "maps": maps,
            **{name: [encode_floats(row) for row in rows] for name, rows in known.items() if rows is not None},
            "descriptors": [
                {"number": i, "source": encode_floats(a), "target": encode_floats(b)} for i, (a, b) in enumerate(both)
            ],
            "matrix": None if self.functional_map is None else encode_floats(self.functional_map),
            "textures": [_texture_record(shape) for shape in self.textures or ()],
            "summary": self.summary,
        }
        return document("result.html.j2", title=" → ".join(self.names), data=data)


def _rotation_by_map(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Return the rotation, (3, 3), that turns the target's vertices best onto their matches (Kabsch 1976)."""
    known = np.asarray(target_to_source) >= 0
    if not known.any():
        return np.eye(3)
    return fit_rotation(target.vertices[known], source.vertices[np.asarray(target_to_source)[known]])[0]
