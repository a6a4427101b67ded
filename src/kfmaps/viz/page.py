"""Records for JSON that several pages read: shapes, maps, verdicts and views."""

from __future__ import annotations

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._texts import VERDICTS, verdict_text
from kfmaps.fmap.convert import nearest_reached
from kfmaps.fmap.evaluate import area_distortion
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io import projected_uv
from kfmaps.matching.orientation import orientation_text
from kfmaps.matching.result import Match
from kfmaps.viz.camera import broad_side, rotation_between
from kfmaps.viz.document import encode_floats, encode_integers
from kfmaps.viz.figures import position_colors


def shape_record(mesh: Mesh, name: str) -> dict[str, object]:
    """Return a mesh as pages read it: name, positions (centred, unit area), faces."""
    positions = unit_area(mesh).vertices
    positions = positions - (positions.min(axis=0) + positions.max(axis=0)) / 2
    return {"name": name, "positions": encode_floats(positions), "faces": encode_integers(mesh.faces)}


def source_record(mesh: Mesh, name: str, colors: np.ndarray | None = None) -> dict[str, object]:
    """Return :func:`shape_record` with colours, by default those of positions, and texture coordinates to transfer."""
    colors = position_colors(mesh) if colors is None else colors
    return {**shape_record(mesh, name), **painted_record(colors, projected_uv(mesh.vertices))}


def painted_record(colors: np.ndarray, plane: np.ndarray) -> dict[str, object]:
    """Return colours and texture coordinates of vertices."""
    return {"colours": encode_integers(np.rint(255 * colors).astype(np.uint8)), "plane": encode_floats(plane)}


def map_record(source: Mesh, target: Mesh, target_to_source: np.ndarray, label: str) -> dict[str, object]:
    """Return a point map as pages read it: the map, the nearest image of each source vertex, and the area distortion.

    A vertex without a counterpart has the number after the source's last.
    """
    unmatched = target_to_source < 0
    return {
        "label": label,
        "points": encode_integers(np.where(unmatched, len(source.vertices), target_to_source)),
        "nearest": encode_integers(nearest_reached(source, target_to_source)),
        "distortion": encode_floats(area_distortion(source, target, target_to_source)),
    }


def verdict_record(match: Match, source: Mesh, target: Mesh) -> dict[str, object] | None:
    """Return the verdict of a match with its text and what it says of orientation; ``None`` for an unknown verdict."""
    if match.verdict not in VERDICTS:
        return None
    orientation = orientation_text(match, source, target)
    more = f" Orientation {orientation}." if orientation else ""
    text = verdict_text(match.verdict, len(match.landmarks)) + more
    return {"kind": match.verdict, "text": text, "confidence": match.confidence}


def views_record(source: Mesh, target: Mesh, target_to_source: np.ndarray | None = None) -> dict[str, object]:
    """Return the source's camera axes, and the rotation of the target against the source.

    So both are seen from the same side of the body (:func:`~kfmaps.viz.camera.rotation_between`).
    """
    rotation = rotation_between(source, target, target_to_source)
    return {"frame": broad_side(source).axes().ravel(), "turn": (np.eye(3) if rotation is None else rotation).ravel()}


def check_up(up: str | None) -> str | None:
    """Return ``up`` when it is an axis or ``None``, which leaves the choice to the page."""
    if up not in (None, "x", "y", "z"):
        raise refuse("up", "x, y or z", repr(up), "name the axis that points upwards")
    return up
