"""Maps set beside the truth, for the commands: which pairs of vertices correspond, and how far off a map is."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.fmap.evaluate import (
    Evaluation,
    Smoothness,
    coverage,
    error_curve,
    geodesic_errors,
    precise_errors,
    smoothness,
    summarize_errors,
    truth_from_pairs,
)
from kfmaps.fmap.precise import PointMap
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import atomic_output, check_map, read_vertex_numbers

THRESHOLDS = np.linspace(0.0, 0.25, 251)
"""Of a curve, in units of √area: as far as the area under the curve is taken."""


@dataclass(frozen=True, eq=False)
class Truth:
    """Corresponding vertices ``source (q,)`` and ``target (q,)``, and those of the source's mirror image if known.

    ``mirrored (q,)`` are the target's vertices under the map that swaps left and right.
    """

    source: np.ndarray
    target: np.ndarray
    mirrored: np.ndarray | None = None


def read_truth(files: tuple[Path, Path] | None, symmetric: Path | None = None) -> Truth | None:
    """The truth that the options ``--truth SOURCE TARGET`` and ``--symmetric`` name; ``None`` when they name none.

    Parameters
    ----------
    files : (Path, Path), optional
        Lists of vertices of source and target, line k of one corresponding to line k of the other.
    symmetric : Path, optional
        The same for the target with left and right swapped.

    Raises
    ------
    InvalidInput
        When half of it is missing, or the lists differ in length.
    """
    if files is None:
        if symmetric is not None:
            raise refuse("--symmetric", "--truth SOURCE TARGET beside it", "none", "give it")
        return None
    source = read_vertex_numbers(files[0])
    others = []
    for file in (files[1], symmetric):
        others.append(None if file is None else read_vertex_numbers(file))
        if others[-1] is not None and len(others[-1]) != len(source):
            got = f"{len(source)} lines in {files[0]} and {len(others[-1])} in {file}"
            raise refuse("truth", "files of equal length", got, "take both from one data set")
    return Truth(source, others[0], others[1])


def known_truth(
    files: tuple[Path, Path] | None, identity: bool, source: Mesh, n_t: int, symmetric: Path | None = None
) -> Truth | None:
    """As :func:`read_truth`, or vertex i is vertex i where ``identity``; checked against both shapes.

    Raises
    ------
    InvalidInput
        When both are given, or they do not belong to the shapes.
    """
    if identity:
        if files is not None or symmetric is not None:
            raise refuse("--identity", "one truth", "files of the truth beside it", "leave one out")
        if len(source.vertices) != n_t:
            got = f"{len(source.vertices)} and {n_t}"
            raise refuse("--identity", "equally many vertices", got, "give --truth SOURCE TARGET instead")
        return Truth(np.arange(n_t), np.arange(n_t))
    truth = read_truth(files, symmetric)
    return None if truth is None else check_truth(truth, source, n_t)


def check_truth(truth: Truth, source: Mesh, n_t: int) -> Truth:
    """``truth`` when its vertices are those of ``source`` and of a target with ``n_t`` vertices."""
    n_s = len(source.vertices)
    for numbers, n, name in (
        (truth.source, n_s, "truth of the source"),
        (truth.target, n_t, "truth of the target"),
        (truth.mirrored, n_t, "mirrored truth of the target"),
    ):
        if numbers is not None and len(numbers) and int(numbers.max()) >= n:
            remedy = "check that it belongs to the mesh, and whether it counts from 0 (.txt) or 1 (.vts)"
            raise refuse(name, f"vertices from 0 to {n - 1}", str(int(numbers.max())), remedy)
    return truth


@dataclass(frozen=True, eq=False)
class Accuracy:
    """How good a map is: its errors, those against the mirrored truth, and what part of the source it reaches.

    ``matched``: part of the truth's points that the map gives a counterpart; the others are in no mean. ``precise``:
    the errors of points inside triangles; ``smooth``: whether the map tears or folds; where known.
    """

    errors: Evaluation
    mirrored: Evaluation | None
    coverage: float
    precise: Evaluation | None = None
    smooth: Smoothness | None = None
    matched: float = 1.0

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers for JSON, errors in units of √area, ``None`` for infinite ones."""
        found = {**numbers_of(self.errors), "points": len(self.errors.errors), "coverage": self.coverage}
        if self.matched < 1:
            found["matched"] = self.matched
        if self.mirrored is not None:
            found["mirrored"] = numbers_of(self.mirrored)
        if self.precise is not None:
            found["precise"] = numbers_of(self.precise)
        if self.smooth is not None:
            found["smoothness"] = asdict(self.smooth)
        return found


def numbers_of(errors: Evaluation) -> dict[str, float | None]:
    names = ("mean", "median", "worst", "auc", "exact")
    return {name: value if math.isfinite(value := getattr(errors, name)) else None for name in names}


def assessed(
    source: Mesh,
    target_to_source: np.ndarray,
    truth: Truth,
    *,
    place: PointMap | None = None,
    target: Mesh | None = None,
    mirrored: int | None = None,
) -> Accuracy:
    """Compare a map with the truth; geodesic errors on ``source`` in units of √area.

    With points inside triangles (``place``) their errors are measured too, not snapped; with the ``target``, of which
    both are surfaces, how smooth the map is. Points of the mirrored truth are far from their images, and distances to
    them take most of the time: ``mirrored`` takes at most so many of them, evenly through the list.

    Raises
    ------
    InvalidInput
        When the map or the truth names vertices that the shapes do not have.
    """
    target_to_source = check_map(target_to_source, len(source.vertices), lost=True)
    check_truth(truth, source, len(target_to_source))

    def errors(target: np.ndarray, most: int | None = None) -> Evaluation:
        step = 1 if most is None else -(-len(target) // most)
        predicted = truth_from_pairs(truth.source, target, target_to_source)
        predicted, true = predicted[::step], truth.source[::step]
        if not (predicted >= 0).any():
            raise refuse("map", "a counterpart for some of the truth's points", "none", "take another map or truth")
        return summarize_errors(geodesic_errors(source, predicted[predicted >= 0], true[predicted >= 0]))

    swapped = None if truth.mirrored is None else errors(truth.mirrored, mirrored)
    precise = smooth = None
    # A vertex that no face uses lies in no triangle.
    if place is not None and np.isin(truth.source, source.faces).all():
        rows = truth.target[target_to_source[truth.target] >= 0]
        at = PointMap(place.faces[rows], place.weights[rows])
        precise = summarize_errors(precise_errors(source, at, truth.source[target_to_source[truth.target] >= 0]))
    lost = target_to_source < 0
    whole = place is not None or bool(np.isin(target_to_source[~lost], source.faces).all())
    if target is not None and len(target.faces) and whole:
        common = Mesh(target.vertices, target.faces[~lost[target.faces].any(axis=1)])
        if len(common.faces):
            smooth = smoothness(source, common, np.maximum(target_to_source, 0) if place is None else place)
    matched = float((target_to_source[truth.target] >= 0).mean())
    return Accuracy(errors(truth.target), swapped, coverage(target_to_source, source), precise, smooth, matched)


def write_curve(path: Path, errors: Evaluation, label: str, force: bool = False) -> None:
    """The error curve as a table (.csv) or a picture (.png, .svg, .pdf)."""
    fractions = error_curve(errors.errors, THRESHOLDS)
    with atomic_output(path, force) as temporary:
        if path.suffix.lower() == ".csv":
            text = io.StringIO(newline="")
            rows = [[f"{t:.6g}", repr(float(f))] for t, f in zip(THRESHOLDS, fractions, strict=True)]
            csv.writer(text, lineterminator="\n").writerows([["error", "fraction"], *rows])
            temporary.write_text(text.getvalue(), encoding="ascii")
            return
        from kfmaps.viz import Curve, curves_figure, save_figure

        save_figure(curves_figure([Curve(label, THRESHOLDS, fractions)]), temporary)
