"""How specimens differ from the template around each landmark: in area, and in angles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from kfmaps.batch.layout import Pair
from kfmaps.batch.results import Result, write_rows
from kfmaps.batch.transfer_landmarks import GOOD, SpecimenLandmarks, Template
from kfmaps.batch.work import map_path
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.mesh import Mesh, face_areas
from kfmaps.io import load_map
from kfmaps.io.atomic import table_cell
from kfmaps.io.landmark_files import fixed_rows
from kfmaps.io.meshes import read_shape_mesh
from kfmaps.io.transfer import find_counterparts


def local_differences(
    place: PointMap, source: Mesh, target: Mesh, points: np.ndarray, known: np.ndarray, common: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return how the target differs from the source around each landmark, in area and in angles: (l,) and (l,).

    The surroundings of a landmark are the part of the source that is nearer to it than to any other. The area is that
    on the target, relative to the source, once what both have is scaled to equal area. The conformal distortion is the
    median over the area there of (σ₁/σ₂ + σ₂/σ₁) / 2 of the map of each triangle, σ its stretches: 1 where angles are
    kept (Hormann and Greiner, MIPS: an efficient global parametrization method, 2000).

    ``place``: the point of the source for each target vertex; ``points (l, 3)``: landmarks of the source; ``known
    (n_t,)`` and ``common (n_s,)``: which vertices of target and source have a counterpart.
    """
    faces = target.faces[known[target.faces].all(axis=1)]
    images, tree = point_positions(place, source)[faces], KDTree(points)
    own, other = _edge_products(target.vertices[faces]), _edge_products(images)
    size, other_size = (np.sqrt(np.maximum(a * c - b * b, 0.0)) for a, b, c in (own, other))
    with np.errstate(divide="ignore", invalid="ignore"):
        mixed = own[0] * other[2] - 2 * own[1] * other[1] + own[2] * other[0]
        stretch = np.nan_to_num(mixed / (2 * size * other_size), nan=np.inf)
    at = tree.query(images.mean(axis=1))[1]
    sources = source.faces[common[source.faces].all(axis=1)]
    whole = face_areas(Mesh(source.vertices, sources))
    before = np.bincount(tree.query(source.vertices[sources].mean(axis=1))[1], whole, len(points))
    after = np.bincount(at, size, len(points))
    with np.errstate(divide="ignore", invalid="ignore"):
        area = (after / after.sum()) / (before / before.sum())
    area = np.where(np.isfinite(area) & (after > 0), area, np.nan)
    return area, np.array([_weighted_median(stretch[at == i], size[at == i]) for i in range(len(points))])


def write_local_differences(
    path: Path,
    study: Sequence[SpecimenLandmarks],
    template: Template,
    results: Mapping[Pair, Result],
    folder: Path,
) -> None:
    """Write a row for each specimen and landmark: :func:`local_differences` from the template."""
    names = template.points.names
    rows = [row for row in fixed_rows(names) if template.points.vertices[row] >= 0]
    table: list[list[object]] = [["specimen", "name", "area", "conformal_distortion"]]
    for one in study:
        pair = Pair(template.specimen, one.specimen)
        result = results.get(pair)
        if one.misfit or result is None or result.status != "done" or result.verdict not in GOOD or not rows:
            continue
        file = map_path(folder, pair.key)
        mesh = read_shape_mesh(one.scan)
        ways = find_counterparts(load_map(file), template.mesh, mesh, str(file))
        found = local_differences(
            ways.place, template.mesh, mesh, template.points.points[rows], ways.target, ways.source
        )
        cells = [[table_cell(x, ".4g") for x in values] for values in found]
        table += [[one.specimen, names[row], *values] for row, *values in zip(rows, *cells, strict=True)]
    write_rows(path, table)


def _edge_products(corners: np.ndarray) -> np.ndarray:
    """Products of two edges of triangles (f, 3, 3), (3, f): a·a, a·b, b·b."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.stack([(a * a).sum(axis=1), (a * b).sum(axis=1), (b * b).sum(axis=1)])


def _weighted_median(values: np.ndarray, weights: np.ndarray) -> float:
    order = np.argsort(values)
    sums = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(sums, sums[-1] / 2)]) if len(sums) and sums[-1] > 0 else np.nan
