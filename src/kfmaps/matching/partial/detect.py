"""Detect by their boundaries whether one of two shapes may be a part of the other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.mesh import Mesh, disc_area, loop_lengths, surface_area
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
    same_loops: bool = False  # whether both have several boundary loops, of the same lengths


def _relative_loops(mesh: Mesh) -> np.ndarray:
    """Return the lengths of the boundary loops in √area of the mesh, the longest first; and zeros.

    The area of flat discs with these perimeters is the least that is missing.
    """
    mesh = clean_mesh(mesh).mesh
    return loop_lengths(mesh) / np.sqrt(surface_area(mesh)) if len(mesh.faces) else np.zeros(0)


def _have_same_loops(one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether two shapes have several boundary loops, of the same lengths: hardly two cuts leave such.

    One loop says little: those of two heads that are cut at different places may be equally long.
    """
    n, numbers = min(len(one), len(other)), SCORE.part
    change = np.abs(one[:n] - other[:n]).sum() + one[n:].sum() + other[n:].sum()
    total = (one.sum() + other.sum()) / 2
    return change <= numbers.max_loop_change * total and one.max(initial=0.0) <= numbers.max_loop_share * total


def detect_part(source: Mesh, target: Mesh) -> PartDetection:
    """Return which of two surfaces may be a part of the other."""
    if len(source.faces) == 0 or len(target.faces) == 0:
        return PartDetection("none", "point clouds are taken for whole")
    loops = _relative_loops(source), _relative_loops(target)
    openings: dict[Literal["source", "target"], float] = {
        "source": disc_area(loops[0]),
        "target": disc_area(loops[1]),
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
        same = _have_same_loops(*loops)
        return PartDetection("both", "both have long open boundaries", openings[part], both_open, part, same_loops=same)
    return PartDetection("none", "both have open boundaries alike", openings[part])
