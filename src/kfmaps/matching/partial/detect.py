"""Detect by their boundaries whether one of two shapes may be a part of the other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.mesh import Mesh, opening_area, surface_area
from kfmaps.matching.partial.one_view import is_view_of
from kfmaps.matching.score import SCORE


@dataclass(frozen=True)
class PartDetection:
    """Which of two shapes may be a part; made by :func:`detect_part`."""

    which: Literal["none", "source", "target", "both"]
    reason: str  # in words
    opening: float = 0.0  # of the more open shape: the least area that is missing, over its own area
    both_open: bool = False  # whether something may be missing of both
    more_open: Literal["source", "target"] | None = None
    is_one_view: bool = False  # whether the part is the scan of one camera


def _boundary_opening(mesh: Mesh) -> float:
    """Return the area of flat discs with the perimeters of the boundaries, over the area of the mesh.

    It is the least area that is missing; 0 for a closed surface and for a point cloud.
    """
    mesh = clean_mesh(mesh).mesh
    if len(mesh.faces) == 0:
        return 0.0
    return opening_area(mesh) / surface_area(mesh)


def detect_part(source: Mesh, target: Mesh) -> PartDetection:
    """Return which of two surfaces may be a part of the other."""
    if len(source.faces) == 0 or len(target.faces) == 0:
        return PartDetection("none", "point clouds are taken for whole")
    openings: dict[Literal["source", "target"], float] = {
        "source": _boundary_opening(source),
        "target": _boundary_opening(target),
    }
    part, whole = sorted(openings, key=lambda name: -openings[name])
    if openings[part] < SCORE.part.min_opening:
        return PartDetection("none", "no boundary is long enough for a cut")
    both_open = openings[whole] >= SCORE.part.min_opening
    if openings[part] >= SCORE.part.opening_ratio * openings[whole]:
        reason = f"the {part} has long open boundaries, and the {whole} has " + ("shorter ones" if both_open else "not")
        meshes = (source, target) if part == "source" else (target, source)
        return PartDetection(part, reason, openings[part], both_open, part, is_view_of(*meshes))
    if both_open:
        return PartDetection("both", "both have long open boundaries", openings[part], both_open, part)
    return PartDetection("none", "both have open boundaries alike", openings[part])
