"""Write the landmarks of a study: a file for each specimen, tables, and the statistics of their shapes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kfmaps.batch.results import write_rows
from kfmaps.batch.transfer_landmarks import SpecimenLandmarks, Template
from kfmaps.collection.differences import components
from kfmaps.collection.procrustes import generalized_procrustes, thin_plate_warp
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import write_mesh
from kfmaps.io.landmark_files import LandmarkSet, landmark_suffix, wide_rows, write_landmark_sets

EXTREME = 2.0
"""Standard deviations of a principal component at which its extremes are drawn."""


def write_study(output: Path, study: Sequence[SpecimenLandmarks], templates: Sequence[Template]) -> list[Path]:
    """Write the landmarks of all specimens that fit, and their statistics; return the files, most useful first.

    ``output``: a folder; its files are replaced; ``templates``: the first gives the format of each specimen's own file,
    and the surface that the extremes are drawn on.
    """
    fitting = [one for one in study if not one.misfit]
    suffix = landmark_suffix(templates[0].file)
    own = output / "landmarks"
    own.mkdir(parents=True, exist_ok=True)
    for old in own.glob(f"*{suffix}"):
        old.unlink()  # of a specimen that is left out now
    for one in fitting:
        write_landmark_sets(own / f"{one.specimen}{suffix}", [one.landmarks], force=True)
    files = [
        output / "landmarks.csv",
        output / "landmarks_wide.csv",
        output / "landmarks.tps",
        output / "specimens.csv",
    ]
    write_rows(files[0], _long_rows(fitting))
    write_rows(files[1], wide_rows([one.landmarks for one in fitting]))
    write_landmark_sets(files[2], [one.landmarks for one in fitting], force=True)
    write_rows(files[3], _specimen_rows(study))
    return [*files, *_write_shape(output / "shape", fitting, templates[0])]


def _write_shape(folder: Path, study: Sequence[SpecimenLandmarks], template: Template) -> list[Path]:
    """Procrustes coordinates, principal components and their extremes, of the landmarks that any specimen has."""
    points = np.stack([one.points.points for one in study])
    seen = np.isfinite(points).all(axis=2)
    rows, columns = np.flatnonzero(seen.sum(axis=1) >= 3), np.flatnonzero(seen.any(axis=0))
    if len(rows) < 3 or len(columns) < 3:
        return []
    study, points = [study[int(i)] for i in rows], points[np.ix_(rows, columns)]
    names = [study[0].points.names[i] for i in columns]
    found = generalized_procrustes(points)
    parts = components(found.aligned)
    titles = [f"PC{i + 1}" for i in range(len(parts.variances))]
    folder.mkdir(parents=True, exist_ok=True)
    aligned = [LandmarkSet(tuple(names), x, one.specimen) for x, one in zip(found.aligned, study, strict=True)]
    write_rows(folder / "procrustes.csv", wide_rows(aligned))
    scores = zip(study, found.centroid_sizes, found.distances, parts.scores, strict=True)
    table = [[one.specimen, size, far, *row] for one, size, far, row in scores]
    write_rows(folder / "pca_scores.csv", [["specimen", "centroid_size", "distance", *titles], *table])
    loads = [
        [name, axis, found.consensus[i, j], *parts.directions[:, i, j]]
        for i, name in enumerate(names)
        for j, axis in enumerate("xyz")
    ]
    write_rows(folder / "pca_loadings.csv", [["name", "axis", "consensus", *titles], *loads])
    variance = [[title, v, s] for title, v, s in zip(titles, parts.variances, parts.parts, strict=True)]
    write_rows(folder / "pca_variance.csv", [["component", "variance", "fraction"], *variance])
    base = template.points.points[columns]
    if np.isfinite(base).all():
        for sign, word in ((-1, "minus"), (1, "plus")):
            extreme = found.consensus + sign * EXTREME * np.sqrt(parts.variances[0]) * parts.directions[0]
            warped = Mesh(thin_plate_warp(template.mesh.vertices, base, extreme), template.mesh.faces)
            write_mesh(folder / f"PC1_{word}.ply", warped, force=True)
    return [folder / "pca_scores.csv", folder / "procrustes.csv"]


def _long_rows(study: Sequence[SpecimenLandmarks]) -> list[list[object]]:
    titles = ["specimen", "name", "x", "y", "z", "vertex", "face", "weight_1", "weight_2", "weight_3"]
    rows: list[list[object]] = [[*titles, "confidence", "spread", "rival_distance", "flag"]]
    for one in study:
        p = one.points
        for i, name in enumerate(p.names):
            lost = p.vertices[i] < 0
            place = ["NA"] * 3 if lost else [repr(x) for x in p.points[i].tolist()]
            weights = ["NA"] * 3 if lost else [f"{w:.9g}" for w in p.place.weights[i].tolist()]
            numbers = [_cell(x) for x in (p.confidence[i], one.spread[i], one.rival[i])]
            at = [-1, -1] if lost else [int(p.vertices[i]), int(p.place.faces[i])]
            rows.append([one.specimen, name, *place, *at, *weights, *numbers, one.flags[i]])
    return rows


def _specimen_rows(study: Sequence[SpecimenLandmarks]) -> list[list[object]]:
    rows: list[list[object]] = [["specimen", "status", "verdict", "confidence", "templates", "flagged", "reason"]]
    for one in study:
        best = max(one.results, key=lambda r: r.confidence or 0.0) if one.results else None
        status = "left out" if one.misfit else "carried" if best else "template"
        verdict = "" if best is None else best.verdict
        sure = "NA" if best is None or best.confidence is None else f"{best.confidence:.4f}"
        flagged = sum(map(bool, one.flags))
        rows.append([one.specimen, status, verdict, sure, len(one.results), flagged, one.misfit])
    return rows


def _cell(value: float) -> str:
    return "NA" if np.isnan(value) else f"{value:.4g}"
