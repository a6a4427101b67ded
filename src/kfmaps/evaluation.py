"""Read the truth of a pair from files, and compare a map with it."""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import InvalidInput, KfmapsWarning, refuse
from kfmaps.fmap import evaluate
from kfmaps.fmap.evaluate import Evaluation, Smoothness
from kfmaps.fmap.precise import PointMap, check_point_map_precise, point_positions, vertex_point_map
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh, boundary_vertices, unit_area, vertex_areas
from kfmaps.io import atomic_output, check_map, read_landmarks, read_vertex_numbers
from kfmaps.io.atomic import csv_text, write_text
from kfmaps.io.text import as_table, clean_text, parse_rows, read_bytes
from kfmaps.io.transfer import precise_points
from kfmaps.matching.partial.match_partial import COMMON
from kfmaps.matching.partial.registration import overlap_probability
from kfmaps.matching.result import Match

THRESHOLDS = np.linspace(0.0, 0.25, 251)
"""Errors at which a curve is evaluated, in √area, up to the limit of the area under the curve."""

_MAX_EDGES = 1.5
"""Distance from a listed vertex, in mean edge lengths of the whole, up to which other vertices count as common."""


class NoCounterpart(InvalidInput):
    """A map gives no point of a truth a counterpart."""

    def __init__(self) -> None:
        expected = "a counterpart for some of the truth's points"
        super().__init__(str(refuse("map", expected, "none", "take another map or truth")))


@dataclass(frozen=True, eq=False)
class Truth:
    """Corresponding vertices of two shapes."""

    source: np.ndarray  # (q,)
    target: np.ndarray  # (q,)
    mirrored: np.ndarray | None = None  # (q,): vertices of the target with left and right swapped


def read_truth(
    files: tuple[str | Path, str | Path] | None,
    n_s: int,
    n_t: int,
    *,
    symmetric: str | Path | None = None,
    identity: bool = False,
) -> Truth | None:
    """Return the truth that the options or files give; ``None`` when they give none.

    ``files``: lists of corresponding vertices of source and target; ``n_s`` and ``n_t``: numbers of vertices;
    ``symmetric``: file of the target's vertices with left and right swapped; ``identity``: whether vertex i corresponds
    to vertex i.
    """
    if identity:
        if files is not None or symmetric is not None:
            raise refuse("--identity", "one truth", "files of the truth as well", "leave one out")
        if n_s != n_t:
            raise refuse("--identity", "equally many vertices", f"{n_s} and {n_t}", "name lists of vertices instead")
        return Truth(np.arange(n_t), np.arange(n_t))
    if files is None:
        if symmetric is not None:
            raise refuse("--symmetric", "--truth SOURCE TARGET with it", "--symmetric alone", "give both")
        return None
    return Truth(*read_vertex_lists(files if symmetric is None else (*files, symmetric), (n_s, n_t, n_t)))


def read_vertex_lists(files: Sequence[str | Path], counts: Sequence[int]) -> list[np.ndarray]:
    """Read lists of vertices, whose lines correspond; ``counts``: number of vertices of each file's shape."""
    lists = [read_vertex_numbers(file) for file in files]
    for file, numbers, count in zip(files, lists, counts, strict=False):
        if len(numbers) != len(lists[0]):
            got = f"{len(lists[0])} lines in {files[0]} and {len(numbers)} in {file}"
            raise refuse("vertex lists", "files of equal length", got, "take both from one data set")
        _check_range(numbers, count, str(file))
    return lists


def check_truth(truth: Truth, n_s: int, n_t: int) -> Truth:
    """Return ``truth`` when its vertices are those of shapes with ``n_s`` and ``n_t`` vertices."""
    _check_range(truth.source, n_s, "truth of the source")
    _check_range(truth.target, n_t, "truth of the target")
    if truth.mirrored is not None:
        _check_range(truth.mirrored, n_t, "mirrored truth of the target")
    return truth


def _check_range(numbers: np.ndarray, count: int, name: str) -> None:
    if len(numbers) and int(numbers.max()) >= count:
        remedy = "check that it belongs to the mesh, and whether it counts from 0 (.txt) or 1 (.vts)"
        raise refuse(name, f"vertices from 0 to {count - 1}", str(int(numbers.max())), remedy)


@dataclass(frozen=True, eq=False)
class Accuracy:
    """Errors and other measures of a map; ``None`` where one is unknown or does not apply."""

    errors: Evaluation  # in units of √area, for a part in those of the whole
    matched: float = 1.0  # share of the truth's points that have an image; the others are in no mean
    coverage: float | None = None  # share of the source's area that is reached
    mirrored: Evaluation | None = None  # errors against the mirrored truth
    precise: Evaluation | None = None  # errors of points inside triangles
    smoothness: Smoothness | None = None
    overlap: float | None = None  # intersection over union of the predicted and the true overlap, by area
    missing: float | None = None  # share of the whole's area that the part lacks

    def as_dict(self) -> dict[str, object]:
        """Return plain numbers for JSON, errors in units of √area."""
        values = {**_numbers(self.errors), "points": len(self.errors.errors)}
        for name in ("matched", "coverage", "mirrored", "precise", "smoothness", "overlap", "missing"):
            value = getattr(self, name)
            if isinstance(value, Evaluation | Smoothness):
                values[name] = _numbers(value) if isinstance(value, Evaluation) else asdict(value)
            elif value is not None and math.isfinite(value):
                values[name] = value
        return values


def _numbers(errors: Evaluation) -> dict[str, object]:
    """Return the numbers of an evaluation by name, ``None`` for infinite ones."""
    names = ("mean", "median", "worst", "auc", "exact")
    return {name: value if math.isfinite(value := getattr(errors, name)) else None for name in names}


def assess(
    source: Mesh,
    target_to_source: np.ndarray,
    truth: Truth,
    *,
    points: PointMap | None = None,
    target: Mesh | None = None,
    mirrored: int | None = None,
) -> Accuracy:
    """Compare a map with the truth, by geodesic errors on ``source`` in units of √area.

    ``target_to_source (n_t,)``: −1 where a vertex has no counterpart; ``points``: points inside triangles, whose errors
    are measured too; ``target``: with it the smoothness of a map between surfaces is measured too; ``mirrored``: number
    of points of the mirrored truth at most, since long distances take most of the time.
    """
    target_to_source = check_map(target_to_source, len(source.vertices), partial=True)
    check_truth(truth, len(source.vertices), len(target_to_source))

    predicted, true = [evaluate.truth_from_pairs(truth.source, truth.target, target_to_source)], [truth.source]
    if truth.mirrored is not None:
        rows = slice(None, None, 1 if mirrored is None else -(-len(truth.mirrored) // mirrored))
        predicted.append(evaluate.truth_from_pairs(truth.source, truth.mirrored, target_to_source)[rows])
        true.append(truth.source[rows])
    # Both at once: the graph of the surface takes longer than the distances.
    distances = evaluate.geodesic_errors(source, np.concatenate(predicted), np.concatenate(true))
    errors = [each[~np.isnan(each)] for each in np.split(distances, [len(truth.source)])[: len(true)]]
    if any(len(each) == 0 for each in errors):
        raise NoCounterpart
    direct, *others = map(evaluate.summarize_errors, errors)
    precise_errors = smoothness = None
    matched = target_to_source[truth.target] >= 0
    # A vertex that no face uses lies in no triangle.
    if points is not None and np.isin(truth.source, source.faces).all():
        rows = truth.target[matched]
        at = PointMap(points.faces[rows], points.weights[rows])
        precise_errors = evaluate.summarize_errors(evaluate.precise_errors(source, at, truth.source[matched]))
    unmatched = target_to_source < 0
    has_points = points is not None or bool(np.isin(target_to_source[~unmatched], source.faces).all())
    if target is not None and len(target.faces) and has_points:
        matched_mesh = Mesh(target.vertices, target.faces[~unmatched[target.faces].any(axis=1)])
        if len(matched_mesh.faces):
            smoothness = evaluate.smoothness(
                source, matched_mesh, np.maximum(target_to_source, 0) if points is None else points
            )
    coverage = evaluate.coverage(target_to_source, source)
    mirrored_errors = others[0] if others else None
    return Accuracy(direct, float(matched.mean()), coverage, mirrored_errors, precise_errors, smoothness)


def assess_if_reached(
    source: Mesh, target_to_source: np.ndarray, truth: Truth, *, mirrored: int | None = None
) -> Accuracy | None:
    """Return :func:`assess`, or ``None`` with a warning where no point of the truth has a counterpart.

    So a map that was just made is still kept.
    """
    try:
        return assess(source, target_to_source, truth, mirrored=mirrored)
    except NoCounterpart:
        text = "no point of the truth has a counterpart in the map, so there are no errors"
        warnings.warn(text, KfmapsWarning, stacklevel=2)
        return None


@dataclass(frozen=True, eq=False)
class PartTruth:
    """True positions of vertices of a part on the whole."""

    vertices: np.ndarray  # (q,): of the part
    places: PointMap  # on the whole, for each of them
    dense: bool  # whether these are all of the part's vertices, in order


def read_part_truth(path: Path, whole: Mesh, part: Mesh) -> PartTruth:
    """Read the truth of a part, in one of the two formats of benchmarks.

    ``.baryc_gt`` has a line for each vertex of the part: a triangle of the whole, counted from 1, and three barycentric
    weights. Any other file has lines "vertex of the whole, vertex of the part", counted from 0, or from 1 in ``.vts``.
    """
    name = str(path)
    if path.suffix.lower() == ".baryc_gt":
        rows = parse_rows(clean_text(read_bytes(path), name), name)
        table = as_table(rows, 4, name, "a triangle and three weights a line").astype(np.float64)
        if len(table) != len(part.vertices):
            expected = f"{len(part.vertices)} lines, one per vertex of the part"
            raise refuse(name, expected, str(len(table)), "check which shape is the part")
        weights = np.maximum(table[:, 1:], 0.0)
        total = weights.sum(axis=1, keepdims=True)
        if (total < 0.5).any() or (total > 1.5).any() or (table[:, 0] != np.rint(table[:, 0])).any():
            raise refuse(name, "a triangle and three weights of sum 1 a line", "others", "check the file")
        places = PointMap(table[:, 0].astype(np.int64) - 1, weights / total)
        return PartTruth(np.arange(len(table)), check_point_map_precise(places, whole), True)
    pairs = read_landmarks(path)
    for column, mesh, side in ((pairs[:, 0], whole, "whole"), (pairs[:, 1], part, "part")):
        if len(column) and column.max() >= len(mesh.vertices):
            expected = f"vertices of the {side} from 0 to {len(mesh.vertices) - 1}"
            raise refuse(name, expected, str(int(column.max())), "name the whole's vertices first, from 0 on")
    return PartTruth(pairs[:, 1], vertex_point_map(pairs[:, 0], whole), False)


def part_accuracy(source: Mesh, target: Mesh, match: Match, truth: PartTruth, part: str) -> Accuracy:
    """Compare a map with the truth of its ``part``, "source" or "target".

    Where the target is the part, errors are distances on the source between the image of each vertex and its true
    position. Where the source is the part, they are distances on the target between each vertex and the true position
    of its image, and ``matched`` is a share of the true overlap's area.
    """
    points = match.target_to_source
    map_points = precise_points(match, source) or vertex_point_map(np.maximum(points, 0), source)
    if part == "target":
        matched = points[truth.vertices] >= 0
        rows = truth.vertices[matched]
        predicted = PointMap(map_points.faces[rows], map_points.weights[rows])
        true = PointMap(truth.places.faces[matched], truth.places.weights[matched])
        whole = source
    else:
        matched, predicted, true = _compare_on_target(source, target, points, map_points, truth)
        whole = target
    if not matched.any():
        raise NoCounterpart
    errors = evaluate.summarize_errors(evaluate.precise_errors(whole, predicted, true))
    true_common = _true_overlap(whole, source if part == "source" else target, truth)
    areas = vertex_areas(whole)
    overlap_source, overlap = match.partial.overlap_source, None
    if part == "source" or overlap_source is not None:
        predicted_common = points >= 0 if part == "source" else np.asarray(overlap_source) > COMMON
        overlap = float(
            areas[predicted_common & true_common].sum() / max(areas[predicted_common | true_common].sum(), 1e-300)
        )
    share_matched = float(matched.mean())
    if part == "source":
        share_matched = float(areas[(points >= 0) & true_common].sum() / max(areas[true_common].sum(), 1e-300))
    missing = 1 - float(areas[true_common].sum() / areas.sum())
    return Accuracy(errors, share_matched, overlap=overlap, missing=missing)


def _compare_on_target(
    source: Mesh, target: Mesh, points: np.ndarray, map_points: PointMap, truth: PartTruth
) -> tuple[np.ndarray, PointMap, PointMap]:
    """Return which points can be compared, the target vertices, and the true positions of their images."""
    true_positions = np.full((len(source.vertices), 3), np.nan)
    true_positions[truth.vertices] = point_positions(truth.places, target)
    # A corner of weight zero may have an unknown position.
    corners = np.where(map_points.weights[:, :, None] > 0, true_positions[source.faces[map_points.faces]], 0.0)
    images = np.einsum("ti,tij->tj", map_points.weights, corners)
    has_truth = np.isfinite(images).all(axis=1)
    comparable = (points >= 0) & has_truth
    rows = np.flatnonzero(comparable)
    closest = closest_points(images[rows], target.vertices, target.faces)
    return comparable[has_truth], vertex_point_map(rows, target), PointMap(closest.faces, closest.weights)


def _true_overlap(whole: Mesh, part: Mesh, truth: PartTruth) -> np.ndarray:
    """Return which vertices of the whole, (n,), lie in the true overlap."""
    if truth.dense:
        unit = unit_area(whole)
        placed_part = Mesh(point_positions(truth.places, unit), part.faces)
        return overlap_probability(placed_part, boundary_vertices(part), unit)[0] > COMMON
    listed_vertices = np.unique(whole.faces[truth.places.faces][truth.places.weights > 0.5])
    corners = whole.vertices[whole.faces]
    edge = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean())
    return KDTree(whole.vertices[listed_vertices]).query(whole.vertices)[0] < _MAX_EDGES * edge


def write_curve(path: Path, errors: Evaluation, label: str, force: bool = False) -> None:
    """Write the error curve as a table (.csv) or a picture (.png, .svg, .pdf)."""
    if path.suffix.lower() == ".csv":
        fractions = evaluate.error_curve(errors.errors, THRESHOLDS)
        rows = [[f"{t:.6g}", repr(float(f))] for t, f in zip(THRESHOLDS, fractions, strict=True)]
        write_text(path, csv_text([["error", "fraction"], *rows]), force)
        return
    from kfmaps.viz import save_figure
    from kfmaps.viz.curves import plot_curve

    with atomic_output(path, force) as temporary:
        save_figure(plot_curve({label: errors.errors}), temporary)
