"""Read and write the landmarks of a study: files of specimens, tables, corrections, statistics of shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import refuse
from kfmaps.batch.layout import Pair
from kfmaps.batch.results import Result, write_rows
from kfmaps.batch.transfer_landmarks import USABLE_VERDICTS, Corrections, SpecimenLandmarks, Template
from kfmaps.batch.work import map_path
from kfmaps.collection.differences import components
from kfmaps.collection.procrustes import generalized_procrustes, thin_plate_warp
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.mesh import Mesh, face_areas
from kfmaps.io import load_map, write_mesh
from kfmaps.io.atomic import table_cell
from kfmaps.io.landmark_files import (
    LandmarkSet,
    find_curves,
    fixed_rows,
    landmark_suffix,
    wide_rows,
    write_landmark_sets,
)
from kfmaps.io.meshes import read_shape_mesh
from kfmaps.io.named_points import NamedPoints
from kfmaps.io.text import complete_or_refuse, read_table
from kfmaps.io.transfer import Counterparts, find_counterparts

CORRECTIONS = "corrections.csv"
"""File of the corrections by hand, the only file of a study that :func:`write_study` does not replace."""


def write_study(output: Path, study: Sequence[SpecimenLandmarks], suffix: str) -> list[Path]:
    """Write the landmarks of all specimens that fit, and their statistics; return the files, most useful first.

    ``output``: a folder, whose files are replaced; ``suffix``: of each specimen's own file, which decides its format.
    """
    included = [one for one in study if not one.misfit]
    folder = output / "landmarks"
    folder.mkdir(parents=True, exist_ok=True)
    for file in folder.glob(f"*{suffix}"):
        file.unlink()  # of a specimen that is left out now
    for one in included:
        write_landmark_sets(folder / f"{one.specimen}{suffix}", [one.landmarks], force=True)
    files = [output / name for name in ("landmarks.csv", "landmarks_wide.csv", "landmarks.tps", "specimens.csv")]
    write_rows(files[0], _long_rows(included))
    write_rows(files[1], wide_rows([one.landmarks for one in included]))
    write_landmark_sets(files[2], [one.landmarks for one in included], force=True)
    write_rows(files[3], _specimen_rows(study))
    sliders = _sliders(included[0].points.names)
    if sliders:
        files.append(output / "sliders.csv")
        write_rows(files[4], [["before", "slide", "after"], *sliders])
    return [*files, *_write_shape(output / "shape", included)]


def read_study(output: Path) -> tuple[list[SpecimenLandmarks], str]:
    """Read what :func:`write_study` wrote: all specimens, without landmarks of those left out, and the suffix."""
    try:
        rows, specimens = read_table(output / "landmarks.csv"), read_table(output / "specimens.csv")
        suffix = landmark_suffix(next((output / "landmarks").iterdir()))
        rows_by_specimen = [[row for row in rows if row["specimen"] == one["specimen"]] for one in specimens]
        return list(map(_read_specimen, specimens, rows_by_specimen)), suffix
    except (OSError, KeyError, ValueError, StopIteration) as error:
        remedy = "run kfmaps landmarks transfer first"
        raise refuse(f"study {output}", "a folder of kfmaps landmarks transfer", str(error), remedy) from error


def _read_specimen(one: Mapping[str, str], rows: Sequence[Mapping[str, str]]) -> SpecimenLandmarks:
    def column(name: str) -> np.ndarray:
        return np.array([_number(row[name]) for row in rows])

    weights = np.stack([column(f"weight_{i}") for i in (1, 2, 3)], axis=1)
    positions = np.stack([column(axis) for axis in "xyz"], axis=1)
    vertices, faces = (column(name).astype(np.int64) for name in ("vertex", "face"))
    names = tuple(row["name"] for row in rows)
    points = NamedPoints(names, PointMap(faces, weights), positions, vertices, column("confidence"))
    return SpecimenLandmarks(
        *(one["specimen"], points, column("spread"), column("rival_distance"), tuple(row["flag"] for row in rows)),
        scan=Path(one["scan"]),
        n_maps=int(one["templates"]),
        verdict=one["verdict"],
        probability=_number(one["confidence"]),
        misfit=one["reason"],
        space=one["space"],
    )


def read_corrections(output: Path) -> dict[str, dict[str, tuple[np.ndarray, str]]]:
    """Return the corrections of a study by specimen and landmark; none where there is no such file."""
    path = output / CORRECTIONS
    corrections: dict[str, dict[str, tuple[np.ndarray, str]]] = {}
    if path.exists():
        with complete_or_refuse(str(path), "a table of corrections"):
            for row in read_table(path):
                point = np.array([_number(row[axis]) for axis in "xyz"])
                corrections.setdefault(row["specimen"], {})[row["name"]] = (point, row["flag"])
    return corrections


def write_corrections(output: Path, corrections: Mapping[str, Corrections]) -> None:
    """Write the corrections of a study, which :func:`read_corrections` reads back."""
    rows = [
        [specimen, name, *map(table_cell, point), word]
        for specimen, points in corrections.items()
        for name, (point, word) in points.items()
    ]
    write_rows(output / CORRECTIONS, [["specimen", "name", "x", "y", "z", "flag"], *rows])


def _write_shape(folder: Path, study: Sequence[SpecimenLandmarks]) -> list[Path]:
    """Write Procrustes coordinates, principal components and shapes at their extremes; return the main files."""
    template = next(one for one in study if not one.verdict)
    points = np.stack([one.points.points for one in study])
    is_present = np.isfinite(points).all(axis=2)
    rows, columns = np.flatnonzero(is_present.sum(axis=1) >= 3), np.flatnonzero(is_present.any(axis=0))
    if len(rows) < 3 or len(columns) < 3:
        return []
    study, points = [study[int(i)] for i in rows], points[np.ix_(rows, columns)]
    names = [study[0].points.names[i] for i in columns]
    procrustes = generalized_procrustes(points)
    parts = components(procrustes.aligned)
    titles = [f"PC{i + 1}" for i in range(len(parts.variances))]
    folder.mkdir(parents=True, exist_ok=True)
    aligned = [LandmarkSet(tuple(names), x, one.specimen) for x, one in zip(procrustes.aligned, study, strict=True)]
    write_rows(folder / "procrustes.csv", wide_rows(aligned))
    scores = zip(study, procrustes.centroid_sizes, procrustes.distances, parts.scores, strict=True)
    table = [[one.specimen, size, far, *row] for one, size, far, row in scores]
    write_rows(folder / "pca_scores.csv", [["specimen", "centroid_size", "distance", *titles], *table])
    loads = [
        [name, axis, procrustes.consensus[i, j], *parts.directions[:, i, j]]
        for i, name in enumerate(names)
        for j, axis in enumerate("xyz")
    ]
    write_rows(folder / "pca_loadings.csv", [["name", "axis", "consensus", *titles], *loads])
    variance = [[title, v, s] for title, v, s in zip(titles, parts.variances, parts.parts, strict=True)]
    write_rows(folder / "pca_variance.csv", [["component", "variance", "fraction"], *variance])
    base = template.points.points[columns]
    if np.isfinite(base).all():
        mesh = read_shape_mesh(template.scan)
        for deviations, word in ((-2, "minus"), (2, "plus")):  # standard deviations of the first component
            extreme = procrustes.consensus + deviations * np.sqrt(parts.variances[0]) * parts.directions[0]
            warped = Mesh(thin_plate_warp(mesh.vertices, base, extreme), mesh.faces)
            write_mesh(folder / f"PC1_{word}.ply", warped, force=True)
    return [folder / "pca_scores.csv", folder / "procrustes.csv"]


def local_differences(counterparts: Counterparts, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how the target differs from the source around each landmark, in area and in angles: (l,) and (l,).

    The region of a landmark is the part of the source that is nearer to it than to any other. Its area on the target is
    relative to that on the source, after the overlap is scaled to equal area. The conformal distortion is the median of
    (σ₁/σ₂ + σ₂/σ₁) / 2 over the triangles, weighted by area, with σ the singular values of the map: 1 where angles are
    kept (Hormann and Greiner, MIPS: an efficient global parametrization method, 2000).

    ``points (l, 3)``: landmarks of the source.
    """
    source, target = counterparts.meshes
    faces = target.faces[counterparts.target[target.faces].all(axis=1)]
    images, tree = point_positions(counterparts.place, source)[faces], KDTree(points)
    products, image_products = _edge_products(target.vertices[faces]), _edge_products(images)
    areas, image_areas = (np.sqrt(np.maximum(a * c - b * b, 0.0)) for a, b, c in (products, image_products))
    with np.errstate(divide="ignore", invalid="ignore"):
        mixed = products[0] * image_products[2] - 2 * products[1] * image_products[1] + products[2] * image_products[0]
        stretch = np.nan_to_num(mixed / (2 * areas * image_areas), nan=np.inf)
    nearest = tree.query(images.mean(axis=1))[1]
    source_faces = source.faces[counterparts.source[source.faces].all(axis=1)]
    source_areas = face_areas(Mesh(source.vertices, source_faces))
    before = np.bincount(tree.query(source.vertices[source_faces].mean(axis=1))[1], source_areas, len(points))
    after = np.bincount(nearest, areas, len(points))
    with np.errstate(divide="ignore", invalid="ignore"):
        area = (after / after.sum()) / (before / before.sum())
    area = np.where(np.isfinite(area) & (after > 0), area, np.nan)
    return area, np.array([_weighted_median(stretch[nearest == i], areas[nearest == i]) for i in range(len(points))])


def write_local_differences(
    path: Path, study: Sequence[SpecimenLandmarks], template: Template, results: Mapping[Pair, Result], folder: Path
) -> None:
    """Write a row for each specimen and landmark: :func:`local_differences` from the template."""
    names = template.points.names
    rows = [row for row in fixed_rows(names) if template.points.vertices[row] >= 0]
    table: list[list[object]] = [["specimen", "name", "area", "conformal_distortion"]]
    for one in study:
        pair = Pair(template.specimen, one.specimen)
        result = results.get(pair)
        if one.misfit or result is None or result.status != "done" or result.verdict not in USABLE_VERDICTS or not rows:
            continue
        file = map_path(folder, pair.key)
        mesh = read_shape_mesh(one.scan)
        counterparts = find_counterparts(load_map(file), template.mesh, mesh, str(file))
        differences = local_differences(counterparts, template.points.points[rows])
        cells = [[table_cell(x, ".4g") for x in values] for values in differences]
        table += [[one.specimen, names[row], *values] for row, *values in zip(rows, *cells, strict=True)]
    write_rows(path, table)


def _sliders(names: Sequence[str]) -> list[list[int]]:
    """Return rows (before, slide, after) of sliding points, from 1, for geomorph's ``gpagen(curves = )``."""
    triples = []
    for curve in find_curves(names):
        rows = [row + 1 for row in curve.rows]
        rows = [rows[-1], *rows, rows[0]] if curve.closed else rows
        triples += [list(three) for three in zip(rows, rows[1:], rows[2:], strict=False)]
    return triples


def _long_rows(study: Sequence[SpecimenLandmarks]) -> list[list[object]]:
    titles = ["specimen", "name", "x", "y", "z", "vertex", "face", "weight_1", "weight_2", "weight_3"]
    rows: list[list[object]] = [[*titles, "confidence", "spread", "rival_distance", "flag"]]
    for one in study:
        p = one.points
        for i, name in enumerate(p.names):
            is_missing = p.vertices[i] < 0
            place = np.full((2, 3), np.nan) if is_missing else np.stack([p.points[i], p.place.weights[i]])
            indices = [-1, -1] if is_missing else [int(p.vertices[i]), int(p.place.faces[i])]
            numbers = [table_cell(x, ".4g") for x in (p.confidence[i], one.spread[i], one.rival_distance[i])]
            weights = [table_cell(x, ".9g") for x in place[1]]
            rows.append([one.specimen, name, *map(table_cell, place[0]), *indices, *weights, *numbers, one.flags[i]])
    return rows


def _specimen_rows(study: Sequence[SpecimenLandmarks]) -> list[list[object]]:
    titles: list[object] = ["specimen", "status", "verdict", "confidence", "templates", "flagged", "reason"]
    rows = [[*titles, "scan", "space"]]
    for one in study:
        status = "left out" if one.misfit else "carried" if one.verdict else "template"
        flagged = sum(map(bool, one.open_flags))
        cells = [status, one.verdict, table_cell(one.probability, ".4g"), one.n_maps, flagged, one.misfit]
        rows.append([one.specimen, *cells, one.scan.absolute(), one.space])
    return rows


def _number(cell: str) -> float:
    return np.nan if cell == "NA" else float(cell)


def _edge_products(corners: np.ndarray) -> np.ndarray:
    """Return the products a·a, a·b and b·b of two edges of triangles (f, 3, 3), (3, f)."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.stack([(a * a).sum(axis=1), (a * b).sum(axis=1), (b * b).sum(axis=1)])


def _weighted_median(values: np.ndarray, weights: np.ndarray) -> float:
    order = np.argsort(values)
    sums = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(sums, sums[-1] / 2)]) if len(sums) and sums[-1] > 0 else np.nan
