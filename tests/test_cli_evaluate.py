"""``kfmaps evaluate`` and the truth it sets a map beside."""

from __future__ import annotations

import csv
import json
import types
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from commandline import run, shapes
from conftest import fibonacci_sphere
from kfmaps.evaluation import THRESHOLDS, Truth, assess
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import surface_area, vertex_areas
from kfmaps.io import save_map, write_mesh
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ShapeFile


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> types.SimpleNamespace:
    """Shapes with a map that is right but at vertices 0 to 49, which all go to source vertex 7."""
    found = shapes(tmp_path_factory.mktemp("evaluated"))
    found.points = found.truth.copy()
    found.points[:50] = 7
    found.map = found.folder / "m.npz"
    save_map(found.map, Match(found.points, source_file=ShapeFile("a.off"), target_file=ShapeFile("b.off")))
    mesh = found.meshes[0]
    wrong = geodesic_distances(mesh, np.array([7]))[0][found.truth[:50]] / np.sqrt(surface_area(mesh))
    found.errors = np.concatenate([wrong, np.zeros(250)])
    return found


def numbers(made: types.SimpleNamespace, *words: object) -> dict:
    ran = run("evaluate", made.map, *words, "--json")
    assert ran.stderr == ""
    return json.loads(ran.stdout)


def truth(made: types.SimpleNamespace) -> tuple[object, ...]:
    return ("--truth", made.truth_source, made.truth_target)


def test_numbers(made: types.SimpleNamespace) -> None:
    """Mean, median, worst and area under the curve are those of distances measured one by one."""
    output = numbers(made, "--source", made.source, "--target", made.target, *truth(made))
    errors = made.errors
    assert errors[:50].min() >= 0
    assert output["mean"] == pytest.approx(errors.mean(), rel=1e-9)
    assert output["median"] == 0.0
    assert output["worst"] == pytest.approx(errors.max(), rel=1e-9)
    assert output["exact"] == pytest.approx((errors == 0).mean())
    assert output["auc"] == pytest.approx(np.clip(0.25 - errors, 0, None).mean() / 0.25)
    areas = vertex_areas(made.meshes[0])
    assert output["coverage"] == pytest.approx(areas[np.unique(made.points)].sum() / areas.sum())
    assert output["points"] == 300


def test_source_is_the_one_that_the_map_names(made: types.SimpleNamespace) -> None:
    assert numbers(made, *truth(made)) == numbers(made, "--source", made.source, *truth(made))
    shown = run("evaluate", made.map, *truth(made)).stdout
    assert f"{100 * made.errors.mean():.3f}" in shown
    assert "% of √area" in shown
    assert "mirrored" not in shown


def test_vertices_without_counterpart_are_in_no_mean(made: types.SimpleNamespace, tmp_path: Path) -> None:
    points = made.points.copy()
    points[:50] = -1
    save_map(tmp_path / "m.npz", Match(points))
    words = ("evaluate", tmp_path / "m.npz", "--source", made.source, *truth(made))
    output = json.loads(run(*words, "--json").stdout)
    assert (output["mean"], output["exact"], output["matched"]) == (0.0, 1.0, pytest.approx(250 / 300))
    shown = run(*words).stdout
    assert "of the truth's points matched" in shown
    assert "83.3 %" in shown
    assert "source covered" in shown
    save_map(tmp_path / "none.npz", Match(np.full(300, -1)))
    words = ("evaluate", tmp_path / "none.npz", "--source", made.source, *truth(made))
    assert "a counterpart for some of the truth's points" in run(*words).error


def test_mirrored_truth(made: types.SimpleNamespace, tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    swapped = rng.permutation(300)
    (tmp_path / "sym.vts").write_text("".join(f"{v + 1}\n" for v in swapped))
    output = numbers(made, *truth(made), "--symmetric", tmp_path / "sym.vts")
    other = assess(made.meshes[0], made.points, Truth(made.truth, swapped))
    assert output["mirrored"]["mean"] == pytest.approx(other.errors.mean)
    assert output["mirrored"]["mean"] > output["mean"]
    words = ("--truth", made.truth_source, tmp_path / "sym.vts")
    assert "swapped" in run("evaluate", made.map, *words, "--symmetric", made.truth_target).stdout
    assert "swapped" not in run("evaluate", made.map, *truth(made), "--symmetric", tmp_path / "sym.vts").stdout


def test_identity(made: types.SimpleNamespace, tmp_path: Path) -> None:
    save_map(tmp_path / "i.txt", Match(np.arange(300)))
    output = json.loads(run("evaluate", tmp_path / "i.txt", "--source", made.source, "--identity", "--json").stdout)
    assert (output["mean"], output["exact"], output["auc"], output["coverage"]) == (0.0, 1.0, 1.0, pytest.approx(1.0))


def test_curve(made: types.SimpleNamespace, tmp_path: Path) -> None:
    assert run("evaluate", made.map, *truth(made), "--curve", tmp_path / "c.csv").status == 0
    with (tmp_path / "c.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["error", "fraction"]
    table = np.array(rows[1:], dtype=float)
    np.testing.assert_allclose(table[:, 0], THRESHOLDS, atol=1e-9)
    np.testing.assert_allclose(table[:, 1], [(made.errors <= t + 1e-12).mean() for t in table[:, 0]])
    assert run("evaluate", made.map, *truth(made), "--curve", tmp_path / "c.png").status == 0
    assert imread(tmp_path / "c.png").std() > 0.01


def test_infinite_errors_are_null(tmp_path: Path) -> None:
    """Points sent to another component are at no finite distance; JSON has no word for infinity."""
    sphere = fibonacci_sphere(60)
    two = type(sphere)(np.vstack([sphere.vertices, sphere.vertices + 5]), np.vstack([sphere.faces, sphere.faces + 60]))
    write_mesh(tmp_path / "two.off", two)
    save_map(tmp_path / "m.txt", Match(np.r_[60:120, 60:120]))
    ran = run("evaluate", tmp_path / "m.txt", "--source", tmp_path / "two.off", "--identity", "--json")
    output = json.loads(ran.stdout)
    assert output["mean"] is None
    assert output["exact"] == 0.5


def test_refused(made: types.SimpleNamespace, tmp_path: Path) -> None:
    short = tmp_path / "short.vts"
    short.write_text("1\n2\n")
    large = tmp_path / "large.vts"
    large.write_text("".join(f"{v}\n" for v in range(2, 302)))
    sphere = tmp_path / "s.off"
    write_mesh(sphere, fibonacci_sphere(40))
    save_map(tmp_path / "plain.txt", Match(made.points))
    cases: list[tuple[tuple[object, ...], str]] = [
        ((), "--identity"),
        (("--truth-source", made.truth_source), "No such option"),
        ((*truth(made), "--identity"), "one truth"),
        (("--symmetric", made.truth_source), "--symmetric"),
        (("--truth", made.truth_source, short), "equal length"),
        (("--truth", large, made.truth_target), "0 to 299"),
        (("--truth", made.truth_source, large), "0 to 299"),
        ((*truth(made), "--source", sphere), "0 to 39"),
        ((*truth(made), "--target", sphere), "shape (40)"),
        (("--identity", "--source", sphere), "equally many"),
        ((*truth(made), "--curve", tmp_path / "c.doc"), ".csv"),
        ((*truth(made), "--curve", tmp_path / "none" / "c.csv"), "existing folder"),
    ]
    before = sorted(tmp_path.iterdir())
    for words, output in cases:
        assert output in run("evaluate", made.map, "--curve", tmp_path / "c.csv", *words).error, words
    assert "--source" in run("evaluate", tmp_path / "plain.txt", *truth(made)).error
    assert sorted(tmp_path.iterdir()) == before
