"""Read the truth of a pair from files, and compare a map with it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import refuse
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

_NEIGHBOURS = 1.5
"""Distance from a listed vertex, in mean edges of the whole, up to which others count as common too."""


@dataclass(frozen=True, eq=False)
class Truth:
    """Corresponding vertices ``source (q,)`` and ``target (q,)``, and those of the source's mirror image if known.

    ``mirrored (q,)`` are the target's vertices under the map that swaps left and right.
    """

    source: np.ndarray
    target: np.ndarray
    mirrored: np.ndarray | None = None


def known_truth(
    files: tuple[str | Path, str | Path] | None,
    n_s: int,
    n_t: int,
    *,
    symmetric: str | Path | None = None,
    identity: bool = False,
) -> Truth | None:
    """Return the truth that the options or files give; ``None`` when they give none.

    ``files``: lists of vertices of source and target, line k of one corresponding to line k of the other; ``n_s`` and
    ``n_t``: vertices of the shapes; ``symmetric``: the same for the target with left and right swapped; ``identity``:
    vertex i corresponds to vertex i.
    """
    if identity:
        if files is not None or symmetric is not None:
            raise refuse("--identity", "one truth", "files of the truth beside it", "leave one out")
        if n_s != n_t:
            raise refuse("--identity", "equally many vertices", f"{n_s} and {n_t}", "name lists of vertices instead")
        return Truth(np.arange(n_t), np.arange(n_t))
    if files is None:
        if symmetric is not None:
            raise refuse("--symmetric", "--truth SOURCE TARGET beside it", "--symmetric alone", "give both")
        return None
    return Truth(*read_vertex_lists(files if symmetric is None else (*files, symmetric), (n_s, n_t, n_t)))


def read_vertex_lists(files: Sequence[str | Path], counts: Sequence[int]) -> list[np.ndarray]:
    """Read lists of vertices, line k of one corresponding to line k of the others.

    ``counts``: vertices of the shape of each file.
    """
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
    """How good a map is. What is not known, or does not apply, is ``None``."""

    errors: Evaluation  # in units of √area, of a part of those of the whole
    matched: float = 1.0  # part of the truth's points that the map gives a counterpart; the others are in no mean
    coverage: float | None = None  # part of the source's area that something is mapped to
    mirrored: Evaluation | None = None  # errors against the mirrored truth
    precise: Evaluation | None = None  # errors of points inside triangles
    smoothness: Smoothness | None = None
    overlap: float | None = None  # intersection over union, by area of the whole, of the found and the true common part
    missing: float | None = None  # part of the whole's area that the part lacks

    def as_dict(self) -> dict[str, object]:
        """Return plain numbers for JSON, errors in units of √area."""
        found = {**_numbers(self.errors), "points": len(self.errors.errors)}
        for name in ("matched", "coverage", "mirrored", "precise", "smoothness", "overlap", "missing"):
            value = getattr(self, name)
            if isinstance(value, Evaluation | Smoothness):
                found[name] = _numbers(value) if isinstance(value, Evaluation) else asdict(value)
            elif value is not None and math.isfinite(value):
                found[name] = value
        return found


def _numbers(errors: Evaluation) -> dict[str, object]:
    """The numbers of an evaluation by name, ``None`` for infinite ones."""
    names = ("mean", "median", "worst", "auc", "exact")
    return {name: value if math.isfinite(value := getattr(errors, name)) else None for name in names}


def assess(
    source: Mesh,
    target_to_source: np.ndarray,
    truth: Truth,
    *,
    place: PointMap | None = None,
    target: Mesh | None = None,
    mirrored: int | None = None,
) -> Accuracy:
    """Compare a map with the truth; geodesic errors on ``source`` in units of √area.

    ``target_to_source (n_t,)``: −1 where a vertex has no counterpart; ``place``: points inside triangles, whose errors
    are measured too; ``target``: where it is given, and both are surfaces, the map's smoothness is measured too.
    ``mirrored``: points of the mirrored truth at most, evenly through the list. Their images are far away, and such
    distances take most of the time.
    """
    target_to_source = check_map(target_to_source, len(source.vertices), partial=True)
    check_truth(truth, len(source.vertices), len(target_to_source))

    def errors(target: np.ndarray, most: int | None = None) -> Evaluation:
        step = 1 if most is None else -(-len(target) // most)
        predicted = evaluate.truth_from_pairs(truth.source, target, target_to_source)
        predicted, true = predicted[::step], truth.source[::step]
        known = predicted >= 0
        if not known.any():
            raise refuse("map", "a counterpart for some of the truth's points", "none", "take another map or truth")
        return evaluate.summarize_errors(evaluate.geodesic_errors(source, predicted[known], true[known]))

    swapped = None if truth.mirrored is None else errors(truth.mirrored, mirrored)
    precise = smooth = None
    matched = target_to_source[truth.target] >= 0
    # A vertex that no face uses lies in no triangle.
    if place is not None and np.isin(truth.source, source.faces).all():
        rows = truth.target[matched]
        at = PointMap(place.faces[rows], place.weights[rows])
        precise = evaluate.summarize_errors(evaluate.precise_errors(source, at, truth.source[matched]))
    lost = target_to_source < 0
    whole = place is not None or bool(np.isin(target_to_source[~lost], source.faces).all())
    if target is not None and len(target.faces) and whole:
        common = Mesh(target.vertices, target.faces[~lost[target.faces].any(axis=1)])
        if len(common.faces):
            smooth = evaluate.smoothness(source, common, np.maximum(target_to_source, 0) if place is None else place)
    reached = evaluate.coverage(target_to_source, source)
    return Accuracy(errors(truth.target), float(matched.mean()), reached, swapped, precise, smooth)


@dataclass(frozen=True, eq=False)
class PartTruth:
    """Where vertices of a part belong on the whole."""

    vertices: np.ndarray  # (q,): of the part
    places: PointMap  # on the whole, of each of them
    dense: bool  # whether they are all of the part's vertices, in order


def read_part_truth(path: Path, whole: Mesh, part: Mesh) -> PartTruth:
    """Read the truth of a part, in one of the two forms that benchmarks have.

    ``path``: ``.baryc_gt``: a line for each vertex of the part, the triangle of the whole, counted from 1, and three
    barycentric weights. Any other file: lines "vertex of the whole, vertex of the part", counted from 0 (``.vts`` from
    1).
    """
    name = str(path)
    if path.suffix.lower() == ".baryc_gt":
        rows = parse_rows(clean_text(read_bytes(path), name), name)
        found = as_table(rows, 4, name, "a triangle and three weights a line").astype(np.float64)
        if len(found) != len(part.vertices):
            wanted = f"{len(part.vertices)} lines, one per vertex of the part"
            raise refuse(name, wanted, str(len(found)), "check which shape is the part")
        weights = np.maximum(found[:, 1:], 0.0)
        total = weights.sum(axis=1, keepdims=True)
        if (total < 0.5).any() or (total > 1.5).any() or (found[:, 0] != np.rint(found[:, 0])).any():
            raise refuse(name, "a triangle and three weights of sum 1 a line", "others", "check the file")
        places = PointMap(found[:, 0].astype(np.int64) - 1, weights / total)
        return PartTruth(np.arange(len(found)), check_point_map_precise(places, whole), True)
    pairs = read_landmarks(path)
    for column, mesh, side in ((pairs[:, 0], whole, "whole"), (pairs[:, 1], part, "part")):
        if len(column) and column.max() >= len(mesh.vertices):
            wanted = f"vertices of the {side} from 0 to {len(mesh.vertices) - 1}"
            raise refuse(name, wanted, str(int(column.max())), "the whole's stand first, counted from 0")
    return PartTruth(pairs[:, 1], vertex_point_map(pairs[:, 0], whole), False)


def part_accuracy(source: Mesh, target: Mesh, found: Match, truth: PartTruth, part: str) -> Accuracy:
    """Compare a map with the truth of its ``part``, "source" or "target".

    Where the target is the part, errors are distances on the source between the image of each vertex and its true
    place. Where the source is the part, they are distances on the target between each vertex and the true place of its
    image, and ``matched`` is a share of the true common area.
    """
    points = found.target_to_source
    place = precise_points(found, source) or vertex_point_map(np.maximum(points, 0), source)
    if part == "target":
        known = points[truth.vertices] >= 0
        rows = truth.vertices[known]
        said = PointMap(place.faces[rows], place.weights[rows])
        true = PointMap(truth.places.faces[known], truth.places.weights[known])
        whole = source
    else:
        known, said, true = _carried_on(source, target, points, place, truth)
        whole = target
    if not known.any():
        raise refuse("map", "a counterpart for some of the truth's points", "none", "take another map or truth")
    errors = evaluate.summarize_errors(evaluate.precise_errors(whole, said, true))
    true_common = _true_overlap(whole, source if part == "source" else target, truth)
    areas = vertex_areas(whole)
    overlap, share = found.partial.overlap_source, None
    if part == "source" or overlap is not None:
        ours = points >= 0 if part == "source" else np.asarray(overlap) > COMMON
        share = float(areas[ours & true_common].sum() / max(areas[ours | true_common].sum(), 1e-300))
    matched = float(known.mean())
    if part == "source":
        matched = float(areas[(points >= 0) & true_common].sum() / max(areas[true_common].sum(), 1e-300))
    missing = 1 - float(areas[true_common].sum() / areas.sum())
    return Accuracy(errors, matched, overlap=share, missing=missing)


def _carried_on(
    source: Mesh, target: Mesh, points: np.ndarray, place: PointMap, truth: PartTruth
) -> tuple[np.ndarray, PointMap, PointMap]:
    """Return which points can be compared, the target vertices, and the true places of what is mapped to them."""
    there = np.full((len(source.vertices), 3), np.nan)
    there[truth.vertices] = point_positions(truth.places, target)
    # A corner of weight zero does not count, even where its place is not known.
    corners = np.where(place.weights[:, :, None] > 0, there[source.faces[place.faces]], 0.0)
    ends = np.einsum("ti,tij->tj", place.weights, corners)
    told = np.isfinite(ends).all(axis=1)
    known = (points >= 0) & told
    rows = np.flatnonzero(known)
    on = closest_points(ends[rows], target.vertices, target.faces)
    return known[told], vertex_point_map(rows, target), PointMap(on.faces, on.weights)


def _true_overlap(whole: Mesh, part: Mesh, truth: PartTruth) -> np.ndarray:
    """Return which vertices of the whole (n,) are common by the truth."""
    if truth.dense:
        unit = unit_area(whole)
        bent = Mesh(point_positions(truth.places, unit), part.faces)
        return overlap_probability(bent, boundary_vertices(part), unit)[0] > COMMON
    listed = np.unique(whole.faces[truth.places.faces][truth.places.weights > 0.5])
    ends = whole.vertices[whole.faces]
    edge = float(np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).mean())
    return KDTree(whole.vertices[listed]).query(whole.vertices)[0] < _NEIGHBOURS * edge


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
