"""How much larger, and how much sheared, the surroundings of each landmark are."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from conftest import rotation, sheet
from kfmaps.batch.landmark_tables import local_differences, write_local_differences
from kfmaps.batch.layout import Pair, find_collection
from kfmaps.batch.results import Result
from kfmaps.batch.transfer_landmarks import read_templates, template_landmarks
from kfmaps.batch.work import map_path
from kfmaps.fmap.precise import PointMap, vertex_point_map
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import save_map, write_mesh
from kfmaps.io.landmark_files import LandmarkSet, write_landmark_sets
from kfmaps.io.transfer import Counterparts
from kfmaps.matching.result import Match

GUARDS = ("kfmaps.batch.landmark_tables",)

POINTS = np.array([[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]])
STRETCH = 1.5


def square(n: int) -> Mesh:
    """A square of [-1, 1]², of n × n cells."""
    return sheet(*2 * [np.linspace(-1, 1, n + 1)])


def stretched(mesh: Mesh) -> Mesh:
    """The sheet with its right half stretched along x, then turned and scaled."""
    x, y, z = mesh.vertices.T
    return Mesh(3 * np.column_stack([np.where(x > 0, STRETCH * x, x), y, z]) @ rotation(0) + 5, mesh.faces)


def differences(source: Mesh, target: Mesh, place: PointMap, known: np.ndarray | None = None) -> list[np.ndarray]:
    known = np.ones(len(target.vertices), dtype=bool) if known is None else known
    ways = Counterparts(Match(np.zeros(len(known), dtype=np.int64)), (source, target), place, known)
    return list(local_differences(ways, POINTS))


def test_a_known_change_of_area_is_found() -> None:
    source = square(12)
    area, conformal = differences(source, stretched(source), vertex_point_map(np.arange(len(source.vertices)), source))
    np.testing.assert_allclose(area, [2 / 2.5, 3 / 2.5])
    np.testing.assert_allclose(conformal, [1, (STRETCH + 1 / STRETCH) / 2])


def test_the_target_may_have_other_triangles() -> None:
    source, fine = square(12), square(31)
    found = closest_points(fine.vertices, source.vertices, source.faces)
    area, conformal = differences(source, stretched(fine), PointMap(found.faces, found.weights))
    np.testing.assert_allclose(area, [2 / 2.5, 3 / 2.5], atol=0.04)
    np.testing.assert_allclose(conformal, [1, (STRETCH + 1 / STRETCH) / 2], rtol=1e-6)


def test_a_landmark_without_surroundings_is_unknown() -> None:
    source = square(12)
    left = source.vertices[:, 0] < 1e-9
    place = vertex_point_map(np.arange(len(left)), source)
    area, conformal = differences(source, stretched(source), place, left)
    np.testing.assert_allclose(area, [1, np.nan])
    np.testing.assert_allclose(conformal, [1, np.nan])


@pytest.mark.filterwarnings("ignore::kfmaps._errors.KfmapsWarning")
@pytest.mark.parametrize("verdict", ["sure", "unlikely"])
def test_the_table_has_a_row_for_each_landmark_of_good_maps(tmp_path: Path, verdict: str) -> None:
    source = square(12)
    write_mesh(tmp_path / "a.ply", source)
    write_mesh(tmp_path / "b.ply", stretched(source))
    write_landmark_sets(tmp_path / "a.pts", [LandmarkSet(("l", "r"), POINTS)])
    (template,) = read_templates([tmp_path / "a.pts"], find_collection(tmp_path))
    (tmp_path / "maps").mkdir()
    save_map(map_path(tmp_path, "a-b"), Match(np.arange(len(source.vertices))))
    one = template_landmarks(template)
    study = [one, replace(one, specimen="b", scan=tmp_path / "b.ply", verdict=verdict)]
    results = {Pair("a", "b"): Result("a", "b", "done", "", "", verdict=verdict)}
    write_local_differences(tmp_path / "d.csv", study, template, results, tmp_path)
    with open(tmp_path / "d.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    wanted = [("b", "l", "0.8", "1"), ("b", "r", "1.2", "1.083")] if verdict == "sure" else []
    assert [tuple(row.values()) for row in rows] == wanted
