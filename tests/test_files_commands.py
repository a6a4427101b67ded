"""``kfmaps info``, ``transfer`` and ``export``."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from commandline import run
from conftest import blob, fibonacci_sphere
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io import load_map, read_mesh_file, read_values, save_map, write_mesh
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ShapeFile
from kfmaps.viz import position_colors

POINTS = np.random.default_rng(0).integers(0, 80, 40)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_mesh(tmp_path / "a.off", blob(80))
    write_mesh(tmp_path / "b.off", fibonacci_sphere(40))
    save_map(tmp_path / "m.npz", Match(POINTS, functional_map=np.eye(3)))
    return tmp_path


def test_info_for_machines(folder: Path) -> None:
    facts = json.loads(run("info", folder / "a.off", "--json").stdout)
    assert (facts["vertices"], facts["faces"]) == (80, 156)
    assert facts["area"] == pytest.approx(surface_area(blob(80)))
    assert facts["topology"]["components"] == 1
    assert facts["topology"]["genus"] == 0
    assert facts["topology"]["closed"]
    np.testing.assert_allclose(facts["extent"], np.ptp(blob(80).vertices, axis=0))


def test_info_for_people(folder: Path) -> None:
    """Defects are in the table, not warned about; names are shown as they are."""
    mesh = blob(80)
    torn = Mesh(np.vstack([mesh.vertices, mesh.vertices[:1]]), mesh.faces[1:])
    path = folder / "[bold]x.ply"
    write_mesh(path, torn, colors=np.zeros((81, 3)))
    result = run("info", path)
    assert result.status == 0
    for part in (
        "81",
        "155",
        "3 boundary edges",
        "1 unreferenced vertices",
        "1 duplicated vertices",
        "colors",
        "genus",
    ):
        assert part in result.stdout
    assert "[bold]x.ply" in "".join(result.stdout.split())


def test_info_of_many_files(folder: Path) -> None:
    """A row for each; one that cannot be read is complained of after the others have been shown."""
    both = run("info", folder / "a.off", folder / "b.off")
    assert [count in both.stdout for count in (" 80 ", " 40 ", "156", "76")] == [True] * 4
    lines = run("info", folder / "a.off", folder / "b.off", "--json").stdout.splitlines()
    assert [json.loads(line)["vertices"] for line in lines] == [80, 40]
    result = run("info", folder / "none.off", folder / "a.off")
    assert "none.off" in result.stderr
    assert "156" in result.stdout


def test_info_of_a_cloud_and_of_a_tangle(folder: Path) -> None:
    np.savetxt(folder / "c.xyz", blob(30).vertices)
    assert "point cloud" in run("info", folder / "c.xyz").stdout
    facts = json.loads(run("info", folder / "c.xyz", "--json").stdout)
    assert facts["topology"] is None
    assert facts["area"] is None
    tangle = Mesh(np.random.default_rng(0).normal(size=(5, 3)), np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]]))
    write_mesh(folder / "d.obj", tangle)
    assert "not defined" in run("info", folder / "d.obj").stdout
    assert "nothing there" in run("info", folder / "none.off").error


def test_transfer(folder: Path) -> None:
    values = np.random.default_rng(1).random((80, 2))
    np.savetxt(folder / "v.csv", values, fmt="%.17g", delimiter=",", header="x,y", comments="")
    assert run("transfer", folder / "m.npz", folder / "v.csv", "-o", folder / "w.csv").status == 0
    found = read_values(folder / "w.csv")
    assert found.columns == ("x", "y")
    np.testing.assert_array_equal(found.array, values[POINTS])
    assert "--force" in run("transfer", folder / "m.npz", folder / "v.csv", "-o", folder / "w.csv").error
    assert run("transfer", folder / "m.npz", folder / "v.csv", "-o", folder / "w.csv", "--force").status == 0


def test_transfer_of_too_few_values(folder: Path) -> None:
    np.savetxt(folder / "v.txt", np.zeros(10))
    words = (folder / "v.txt", "-o", folder / "w.npy")
    assert "source vertices from 0 to 9" in run("transfer", folder / "m.npz", *words).error
    save_map(folder / "n.npz", Match(POINTS % 9, source_file=ShapeFile(n_vertices=80)))
    assert "values: expected 80 rows, one per source vertex, got 10" in run("transfer", folder / "n.npz", *words).error
    assert not (folder / "w.npy").exists()


@pytest.mark.parametrize("suffix", [".txt", ".vts", ".mat", ".npz"])
def test_export_as_a_map(folder: Path, suffix: str) -> None:
    assert run("export", folder / "m.npz", "-o", folder / f"o{suffix}").status == 0
    np.testing.assert_array_equal(load_map(folder / f"o{suffix}").target_to_source, POINTS)


@pytest.mark.parametrize("suffix", [".txt", ".csv", ".npy"])
def test_export_the_functional_map(folder: Path, suffix: str) -> None:
    carrier = np.random.default_rng(3).normal(size=(4, 3))
    save_map(folder / "c.npz", Match(POINTS, functional_map=carrier))
    assert run("export", folder / "c.npz", "--functional", "-o", folder / f"o{suffix}").status == 0
    np.testing.assert_array_equal(read_values(folder / f"o{suffix}").array, carrier)
    save_map(folder / "p.txt", Match(POINTS))
    assert "a point map alone" in run("export", folder / "p.txt", "--functional", "-o", folder / f"q{suffix}").error
    assert "one of .txt .csv .npy" in run("export", folder / "c.npz", "--functional", "-o", folder / "q.vts").error


@pytest.mark.parametrize("suffix", [".txt", ".csv", ".npy"])
def test_export_the_confidence(folder: Path, suffix: str) -> None:
    sure = np.append(np.random.default_rng(4).random(len(POINTS) - 1), np.nan)
    save_map(folder / "s.npz", Match(POINTS, local_confidence=sure))
    assert run("export", folder / "s.npz", "--confidence", "-o", folder / f"o{suffix}").status == 0
    np.testing.assert_array_equal(np.ravel(read_values(folder / f"o{suffix}").array), sure)
    assert "got none" in run("export", folder / "m.npz", "--confidence", "-o", folder / f"q{suffix}").error
    words = ("--confidence", "--functional", "-o", folder / f"q{suffix}")
    assert "--functional or --confidence" in run("export", folder / "s.npz", *words).error


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".off"])
def test_export_as_a_shape(folder: Path, suffix: str) -> None:
    names = ("--source", folder / "a.off", "--target", folder / "b.off")
    assert run("export", folder / "m.npz", *names, "-o", folder / f"o{suffix}").status == 0
    found = read_mesh_file(folder / f"o{suffix}")
    np.testing.assert_array_equal(found.mesh.vertices, fibonacci_sphere(40).vertices)
    assert (found.uv is None) == (suffix != ".obj")
    assert (found.colors is None) == (suffix == ".obj")
    if found.colors is not None:  # those of pictures and pages
        expected = position_colors(read_mesh_file(folder / "a.off").mesh)[POINTS]
        np.testing.assert_allclose(found.colors, expected, atol=0.51 / 255)
    assert "--force" in run("export", folder / "m.npz", *names, "-o", folder / f"o{suffix}").error
    if suffix == ".ply":  # a source with colours of its own keeps them
        own = np.random.default_rng(2).random((80, 3))
        write_mesh(folder / "a.ply", read_mesh_file(folder / "a.off").mesh, colors=own)
        names = ("--source", folder / "a.ply", "--target", folder / "b.off")
        assert run("export", folder / "m.npz", *names, "-o", folder / "p.ply").status == 0
        carried = read_mesh_file(folder / "p.ply").colors
        assert carried is not None
        np.testing.assert_allclose(carried, own[POINTS], atol=0.51 / 255)


def test_exports_that_do_not_fit(folder: Path) -> None:
    before = sorted(folder.iterdir())
    source, target = ("--source", folder / "a.off"), ("--target", folder / "b.off")
    swapped = ("--source", folder / "b.off", "--target", folder / "a.off")
    for more, name, part in (
        (source + target, "o.stl", "one of .obj .ply"),
        (source, "o.obj", "Give --target FILE"),
        (swapped, "o.txt", "Check that the map belongs"),
        (swapped, "o.ply", "Check that the map belongs"),
        ((), "none/o.txt", "existing folder"),
    ):
        assert part in run("export", folder / "m.npz", *more, "-o", folder / name).error
    assert sorted(folder.iterdir()) == before
