"""A small study of carried landmarks, and its review page being served."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from collecting import registered
from kfmaps.batch.landmark_tables import write_study
from kfmaps.batch.layout import find_collection
from kfmaps.batch.transfer_landmarks import read_templates, template_landmarks
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import write_mesh
from kfmaps.io.landmark_files import LandmarkSet, write_landmark_sets
from kfmaps.viz.landmark_review import ReviewServer
from serving import answering

N = 300
AT = np.array([10, 100, 150, 220, 290])
LABELS = tuple("abcde")
QUICK = (
    *("--set", "basis.n_eigenfunctions=30", "--set", "search.candidates=1", "--set", "search.n_sign_functions=2"),
    *("--set", "search.match_extremities=false", "--set", "registration=none", "--workers", "1"),
)
"""Options with which a pair of the study is matched in a moment."""


def write_scans(folder: Path, size: float = 1.0, missing: str = "") -> Path:
    """Write four poses whose vertices correspond by number, and beside their folder the landmarks of each."""
    (folder / "scans").mkdir()
    for i, name in enumerate("abcd"):
        mesh = registered(i, N)
        mesh = Mesh(size * mesh.vertices + 4 * (size - 1), mesh.faces)
        write_mesh(folder / "scans" / f"{name}.ply", mesh)
        points = mesh.vertices[AT]
        points[4] = np.nan if name == missing else points[4]
        write_landmark_sets(folder / f"{name}.mrk.json", [LandmarkSet(LABELS, points, space="LPS")])
    return folder / "scans"


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """A study of four poses; that of ``b`` has a flagged landmark and a missing one, ``d`` is left out."""
    scans = write_scans(tmp_path, missing="b")
    templates = read_templates([tmp_path / f"{name}.mrk.json" for name in "abcd"], find_collection(scans))
    made = [template_landmarks(one) for one in templates]
    carried = [replace(one, verdict="sure", probability=0.875, n_maps=1) for one in made[1:]]
    carried[0] = replace(carried[0], flags=("", "low confidence", "", "", "no counterpart"))
    carried[2] = replace(carried[2], misfit="it is a cat")
    write_study(tmp_path / "study", [made[0], *carried], ".mrk.json")
    return tmp_path / "study"


@pytest.fixture
def serving(study: Path) -> Iterator[ReviewServer]:
    """The review page of a study, answering from another thread."""
    made = ReviewServer(study)
    with answering(made):
        yield made


def rows_of(study: Path, specimen: str) -> dict[str, dict[str, str]]:
    with open(study / "landmarks.csv", encoding="utf-8") as file:
        return {row["name"]: row for row in csv.DictReader(file) if row["specimen"] == specimen}
