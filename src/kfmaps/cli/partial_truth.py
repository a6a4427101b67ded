"""Maps of parts set beside the truth: errors between points inside triangles, and how well the common part is found."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import refuse
from kfmaps.cli.evaluation import Accuracy
from kfmaps.fmap.evaluate import precise_errors, summarize_errors
from kfmaps.fmap.precise import PointMap, check_point_map_precise, point_positions, vertex_point_map
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh, boundary_vertices, unit_area, vertex_areas
from kfmaps.io import read_landmarks
from kfmaps.io.text import as_table, clean_text, parse_rows, read_bytes
from kfmaps.io.transfer import precise_points
from kfmaps.matching.partial.match_partial import COMMON
from kfmaps.matching.partial.registration import overlap_probability
from kfmaps.matching.result import Match

_NEIGHBOURS = 1.5
"""Mean edges of the whole from a listed vertex within which others count as common too, where the truth is a list."""


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

    Of a target that is a part the errors are distances on the source between where its vertices go and belong; of a
    source that is a part, distances on the target between its vertices and where what is mapped to them belongs, and
    ``matched`` is a share of the true common area.
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
    errors = summarize_errors(precise_errors(whole, said, true))
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
    """Which target vertices can be compared, they, and where what is mapped to them belongs."""
    there = np.full((len(source.vertices), 3), np.nan)
    there[truth.vertices] = point_positions(truth.places, target)
    # A corner without weight has no say, nor has what nobody knows of it.
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
