"""Landmarks in the files of other programs, on the surfaces that they belong to."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kfmaps
from commandline import run
from conftest import blob
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import load_map, save_map, write_mesh
from kfmaps.io.landmark_files import (
    _FORMATS,
    LandmarkCurve,
    LandmarkSet,
    find_curves,
    fixed_rows,
    landmark_stem,
    landmark_suffix,
    mesh_space,
    read_landmark_sets,
    wide_rows,
    write_landmark_sets,
)
from kfmaps.io.named_points import place_landmarks, read_landmark_pairs, read_named_points, transfer_points
from kfmaps.io.transfer import find_counterparts
from kfmaps.matching.result import Match

GUARDS = ("kfmaps.io.landmark_files", "kfmaps.io.named_points")

POINTS = np.array([[1.5, -2.25, 3.0], [np.nan] * 3, [0.1, 1e-7, 12345.678]])
NAMES = ("nasion", "tip of the nose", "3")


def touch(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("suffix", _FORMATS)
def test_written_landmarks_are_read_back(tmp_path: Path, suffix: str) -> None:
    given = LandmarkSet(NAMES, POINTS, "one", "RAS", notes=("", "", "doubtful, see there"))
    write_landmark_sets(tmp_path / f"one{suffix}", [given])
    (read,) = read_landmark_sets(tmp_path / f"one{suffix}")
    rows = [0, 2] if suffix == ".fcsv" else [0, 1, 2]  # which has no missing points
    np.testing.assert_allclose(read.points, POINTS[rows], rtol=1e-8)
    if suffix not in (".tps", ".particles"):
        assert read.names == tuple(np.array(["nasion", "tip_of_the_nose" if suffix == ".pts" else NAMES[1], "3"])[rows])
    assert read.space == ("RAS" if suffix in (".mrk.json", ".json", ".fcsv") else "")
    with pytest.raises(InvalidInput, match="exist"):
        write_landmark_sets(tmp_path / f"one{suffix}", [given])
    if _FORMATS[suffix][2]:
        write_landmark_sets(tmp_path / f"two{suffix}", [given, LandmarkSet(NAMES, POINTS + 1, "two")])
        both = read_landmark_sets(tmp_path / f"two{suffix}")
        assert [one.specimen for one in both] == ["one", "two"]
        np.testing.assert_allclose(both[1].points, POINTS + 1, rtol=1e-8)
    else:
        with pytest.raises(InvalidInput, match="one specimen"):
            write_landmark_sets(tmp_path / f"two{suffix}", [given, given])


def test_slicer_json(tmp_path: Path) -> None:
    points = [
        {"label": "a", "position": [1, 2, 3]},
        {"label": "b", "positionStatus": "undefined", "position": [0, 0, 0]},
        {"position": [4, 5, 6], "positionStatus": "defined"},
    ]
    content = {"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "controlPoints": points}]}
    (read,) = read_landmark_sets(touch(tmp_path / "s.mrk.json", json.dumps(content)))
    assert (read.names, read.space) == (("a", "b", "3"), "LPS")
    np.testing.assert_array_equal(read.points, [[1, 2, 3], [np.nan] * 3, [4, 5, 6]])
    content["markups"][0]["coordinateSystem"] = "IJK"
    with pytest.raises(InvalidInput, match="LPS or RAS"):
        read_landmark_sets(touch(tmp_path / "s.mrk.json", json.dumps(content)))


@pytest.mark.parametrize(
    ("space", "output"), [("0", "RAS"), ("1", "LPS"), ("LPS", "LPS"), ("RAS", "RAS"), (None, "RAS")]
)
def test_slicer_fcsv(tmp_path: Path, space: str | None, output: str) -> None:
    head = "# Markups fiducial file version = 4.11\n" + (f"# CoordinateSystem = {space}\n" if space else "")
    columns = "# columns = id,x,y,z,ow,ox,oy,oz,vis,sel,lock,label,desc,associatedNodeID\n"
    rows = 'n_0,1,2.5,-3,0,0,0,1,1,1,0,"A, left",,\nn_1,4,5,6,0,0,0,1,1,1,0,F-2,,n\n'
    (read,) = read_landmark_sets(touch(tmp_path / "f.fcsv", head + columns + rows))
    assert (read.names, read.space) == (("A, left", "F-2"), output)
    np.testing.assert_array_equal(read.points, [[1, 2.5, -3], [4, 5, 6]])


def test_tps_of_several_programs(tmp_path: Path) -> None:
    text = (
        "LM3=2\n1 2 3\nNA NA NA\nID=skull 1\n\nLM=1\r\n10 20\r\nCURVES=1\r\nPOINTS=2\r\n1 2\r\n3 4\r\n"
        "IMAGE=C:\\pictures\\wing.jpg\nID=0\nSCALE=0.5\n"
    )
    first, second = read_landmark_sets(touch(tmp_path / "t.TPS", text))
    assert (first.specimen, first.names) == ("skull 1", ("1", "2"))
    np.testing.assert_array_equal(first.points, [[1, 2, 3], [np.nan] * 3])
    assert (second.specimen, second.names) == ("wing", ("1", "curve1_1", "curve1_2"))
    np.testing.assert_array_equal(second.points, [[5, 10, 0], [0.5, 1, 0], [1.5, 2, 0]])


def test_landmark_editor(tmp_path: Path) -> None:
    text = "Version 1.0\n3\nS000 1 2 3\nS001 9999 9999 9999\nupper left 4 5 6\n"
    (read,) = read_landmark_sets(touch(tmp_path / "e.pts", text))
    assert read.names == ("S000", "S001", "upper left")
    np.testing.assert_array_equal(read.points, [[1, 2, 3], [np.nan] * 3, [4, 5, 6]])


@pytest.mark.parametrize(
    "text",
    [
        "Specimen,x_a,y_a,z_a,x_b,y_b,z_b\none,1,2,3,NA,NA,NA\ntwo,4,5,6,7,8,9\n",
        "ID,a.X,a.Y,a.Z,sex,b.X,b.Y,b.Z\none,1,2,3,f,,,\ntwo,4,5,6,m,7,8,9\n",
        "specimen;name;x;y;z\none;a;1;2;3\none;b;NA;NA;NA\ntwo;a;4;5;6\ntwo;b;7;8;9\n",
        "Landmark\tZ\tY\tX\tspecimen\na\t3\t2\t1\tone\nb\t\t\t\tone\na\t6\t5\t4\ttwo\nb\t9\t8\t7\ttwo\n",
    ],
)
def test_tables_long_and_wide(tmp_path: Path, text: str) -> None:
    both = read_landmark_sets(touch(tmp_path / "t.csv", text))
    assert [(one.specimen, one.names) for one in both] == [("one", ("a", "b")), ("two", ("a", "b"))]
    np.testing.assert_array_equal(both[0].points, [[1, 2, 3], [np.nan] * 3])
    np.testing.assert_array_equal(both[1].points, [[4, 5, 6], [7, 8, 9]])


def test_wide_tables_have_titles_that_r_takes(tmp_path: Path) -> None:
    given = LandmarkSet(("1", "left-most (a)"), POINTS[:2], "s 1")
    titles, row = wide_rows([given])
    assert titles == ["specimen", "x_1", "y_1", "z_1", *(f"{axis}_left.most..a." for axis in "xyz")]
    assert row == ["s 1", "1.5", "-2.25", "3.0", "NA", "NA", "NA"]
    text = "\n".join(",".join(cells) for cells in (titles, row))
    (read,) = read_landmark_sets(touch(tmp_path / "w.csv", text))
    np.testing.assert_array_equal(read.points, POINTS[:2])
    with pytest.raises(InvalidInput, match="same landmarks"):
        wide_rows([given, LandmarkSet(("1", "2"), POINTS[:2], "s 2")])


@pytest.mark.parametrize(
    ("name", "text", "output"),
    [
        ("a.txt", "1 2 3\n", "one of .mrk.json"),
        ("a.tps", "LM3=3\n1 2 3\n", "3 points"),
        ("a.tps", "1 2 3\n", "keyword"),
        ("a.tps", "LM3=1\n1 2 x\n", "'x'"),
        ("a.pts", "version\n2\na 1 2 3\n", "2 points"),
        ("a.pts", "1 2 3\n", "Version 1.0"),
        ("a.particles", "1 2 3 4\n", "two or three"),
        ("a.csv", "a,1,2,3\na,1,2,3\n", "each name once"),
        ("a.csv", "name,vertex\na,1.5\n", "whole numbers"),
        ("a.csv", "name,x,y,z\na,1,2\n", "4 cells"),
        ("a.csv", "a,1,2,3,4\n", "rows"),
        ("a.mrk.json", "{}", "complete"),
        ("a.mrk.json", '{"markups": []}', "landmarks"),
    ],
)
def test_damaged_files_are_refused_in_words(tmp_path: Path, name: str, text: str, output: str) -> None:
    with pytest.raises(InvalidInput, match=output):
        read_landmark_sets(touch(tmp_path / name, text))


def test_names_of_files(tmp_path: Path) -> None:
    assert (landmark_stem("x/a.b.mrk.json"), landmark_suffix("x/a.MRK.json")) == ("a.b", ".mrk.json")
    assert (landmark_stem("a.fcsv"), landmark_suffix("a.txt")) == ("a", "")
    head = "ply\nformat ascii 1.0\ncomment SPACE=RAS\n"
    assert mesh_space(touch(tmp_path / "a.ply", head)) == "RAS"
    assert mesh_space(touch(tmp_path / "b.ply", "ply\n")) == mesh_space(tmp_path / "none.ply") == ""


def shifted() -> Mesh:
    """A shape that lies on one side of all coordinate planes, as scans do."""
    mesh = blob(600)
    return Mesh(mesh.vertices + np.array([4.0, 5.0, 6.0]), mesh.faces)


def on(mesh: Mesh) -> LandmarkSet:
    return LandmarkSet(("a", "b", "c"), mesh.vertices[[10, 200, 500]])


def test_landmarks_go_to_the_closest_point() -> None:
    mesh = shifted()
    given = on(mesh)
    moved = LandmarkSet(given.names, given.points + 0.01)
    placed = place_landmarks(moved, mesh, "l")
    apart = np.linalg.norm(placed.points - moved.points, axis=1)
    assert (apart <= 0.01 * np.sqrt(3) + 1e-12).all()
    assert (apart > 0).all()
    np.testing.assert_allclose(placed.points, given.points, atol=0.05)
    missing = LandmarkSet(given.names, np.vstack([given.points[:1], [[np.nan] * 3], given.points[2:]]))
    placed = place_landmarks(missing, mesh, "l")
    np.testing.assert_array_equal(placed.vertices, [10, -1, 500])
    carried = transfer_points(placed, find_counterparts(Match(np.arange(600)), mesh, mesh))
    np.testing.assert_array_equal(carried.vertices, [10, -1, 500])
    assert np.isnan(carried.points[1]).all()
    with pytest.warns(KfmapsWarning, match=r"far from the surface.*b \("):
        place_landmarks(LandmarkSet(given.names, given.points + np.array([[0], [0.3], [0]])), mesh, "l")


def test_coordinate_systems_are_brought_together() -> None:
    mesh = shifted()
    given = on(mesh)
    turned = given.points * [-1, -1, 1]
    placed = place_landmarks(LandmarkSet(given.names, turned, space="RAS"), mesh, "l", space="LPS")
    np.testing.assert_array_equal(placed.vertices, [10, 200, 500])
    with pytest.warns(KfmapsWarning, match="x and y are negated"):
        placed = place_landmarks(LandmarkSet(given.names, turned, space="RAS"), mesh, "l")
    np.testing.assert_array_equal(placed.vertices, [10, 200, 500])
    with pytest.raises(InvalidInput, match="LPS and RAS are mixed up"):
        place_landmarks(LandmarkSet(given.names, turned, space="LPS"), mesh, "l", space="LPS")


@pytest.mark.parametrize(
    ("change", "output"),
    [
        ([-1, 1, 1], "with x negated: the mesh is a mirror image"),
        ([1, 1, -1], "with z negated: the mesh is a mirror image"),
        ([1, -1, -1], "with y and z negated: the mesh is turned"),
        ([0.001] * 3, "times 1000"),
        ([10] * 3, "times 0.1"),
        ([1, 2, 3], "Check that they belong to this mesh"),
    ],
)
def test_landmarks_far_away_say_what_is_wrong(change: list[float], output: str) -> None:
    mesh = shifted()
    with pytest.raises(InvalidInput, match=output):
        place_landmarks(LandmarkSet(on(mesh).names, on(mesh).points * change), mesh, "l")


def test_the_specimen_is_chosen_by_its_name(tmp_path: Path) -> None:
    mesh = shifted()
    sets = [LandmarkSet(("a",), mesh.vertices[[10]], "one"), LandmarkSet(("a",), mesh.vertices[[20]], "two.ply")]
    write_landmark_sets(tmp_path / "l.tps", sets)
    assert read_named_points(tmp_path / "l.tps", mesh, specimen="two").vertices.tolist() == [20]
    with pytest.raises(InvalidInput, match=r"those of one, two\.ply"):
        read_named_points(tmp_path / "l.tps", mesh, specimen="three")


def test_landmarks_of_two_shapes_are_paired_by_name(tmp_path: Path) -> None:
    mesh = shifted()
    write_mesh(tmp_path / "a.off", mesh)
    write_mesh(tmp_path / "b.ply", mesh)
    write_landmark_sets(tmp_path / "a.mrk.json", [LandmarkSet(("p", "q", "r"), mesh.vertices[[10, 200, 500]])])
    write_landmark_sets(tmp_path / "b.fcsv", [LandmarkSet(("r", "x", "p"), mesh.vertices[[510, 7, 11]])])
    files = (tmp_path / "a.mrk.json", tmp_path / "b.fcsv")
    pairs, names = read_landmark_pairs(files, (mesh, mesh), (None, None))
    assert names == ["p", "r"]
    assert pairs.tolist() == [[10, 11], [500, 510]]
    one = kfmaps.Config.single_fit()
    config = replace(one, basis=replace(one.basis, n_eigenfunctions=20), refinement=None)
    match = kfmaps.match(tmp_path / "a.off", tmp_path / "b.ply", config, landmarks=files)
    np.testing.assert_array_equal(match.landmarks, pairs)
    with pytest.raises(InvalidInput, match="prepared shape"):
        kfmaps.match(kfmaps.prepare(mesh, config), tmp_path / "b.ply", config, landmarks=files)
    words = ["match", tmp_path / "a.off", tmp_path / "b.ply", "-o", tmp_path / "m.npz", "-q", "--preset", "single-fit"]
    given = [word for file in files for word in ("--landmarks", file)]
    done = run(*words, *given, "--set", "basis.n_eigenfunctions=20", "--set", "refinement=none")
    assert (done.status, done.stderr) == (0, "")
    np.testing.assert_array_equal(load_map(tmp_path / "m.npz").landmarks, pairs)
    assert "Give --landmarks twice" in run(*words, "--force", "--landmarks", files[0]).stderr
    write_landmark_sets(tmp_path / "c.csv", [LandmarkSet(("z",), mesh.vertices[[10]])])
    with pytest.raises(InvalidInput, match="names that both shapes have"):
        read_landmark_pairs((files[0], tmp_path / "c.csv"), (mesh, mesh), (None, None))


def test_points_are_carried_from_slicers_file_to_slicers_file(tmp_path: Path) -> None:
    mesh = shifted()
    other = Mesh(2 * mesh.vertices, mesh.faces)
    for name, shape in (("a", mesh), ("b", other)):
        write_mesh(tmp_path / f"{name}.off", shape)
    save_map(tmp_path / "m.npz", Match(np.arange(600)))
    write_landmark_sets(tmp_path / "a.mrk.json", [on(mesh)])
    words = ["transfer", tmp_path / "m.npz", tmp_path / "a.mrk.json", "--points", "-o", tmp_path / "b.mrk.json"]
    done = run(*words, "--source", tmp_path / "a.off", "--target", tmp_path / "b.off")
    assert done.status == 0, done.stderr
    (read,) = read_landmark_sets(tmp_path / "b.mrk.json")
    assert read.names == ("a", "b", "c")
    np.testing.assert_allclose(read.points, 2 * on(mesh).points, atol=1e-9)


CURVED = ("tip", "curvebrow_2", "looporbit_1", "looporbit_2", "looporbit_3", "curvebrow_1", "curvebrow_10")


def test_curves_are_known_by_the_names_of_their_points() -> None:
    assert find_curves(CURVED) == [LandmarkCurve("brow", (5, 1, 6), False), LandmarkCurve("orbit", (2, 3, 4), True)]
    assert fixed_rows(CURVED) == [0]
    assert find_curves(("curve_of_the_nose", "loop", "a_1")) == []


def test_curves_of_slicer_keep_their_type_and_name(tmp_path: Path) -> None:
    points = np.arange(21.0).reshape(7, 3)
    points[2] = np.nan
    path = tmp_path / "s.mrk.json"
    write_landmark_sets(path, [LandmarkSet(CURVED, points, notes=("", "look", *[""] * 5))])
    markups = json.loads(path.read_text())["markups"]
    assert [one["type"] for one in markups] == ["Fiducial", "Curve", "ClosedCurve"]
    assert [len(one["controlPoints"]) for one in markups] == [1, 3, 3]
    output = [(one["description"], one["selected"]) for one in markups[1]["controlPoints"]]
    assert output == [("", True), ("look", False), ("", True)]
    (read,) = read_landmark_sets(path)
    assert read.names == ("tip", "curvebrow_1", "curvebrow_2", "curvebrow_3", *CURVED[2:5])
    np.testing.assert_array_equal(read.points, points[[0, 5, 1, 6, 2, 3, 4]])
    unnamed = [{"type": kind, "controlPoints": [{"label": "C-1", "position": [1, 2, 3]}]} for kind in ("Curve",) * 2]
    (read,) = read_landmark_sets(touch(tmp_path / "t.mrk.json", json.dumps({"markups": unnamed})))
    assert read.names == ("curve1_1", "curve2_1")


def test_curves_of_tps_come_after_the_landmarks(tmp_path: Path) -> None:
    points = np.arange(21.0).reshape(7, 3)
    write_landmark_sets(tmp_path / "s.tps", [LandmarkSet(CURVED, points, "one")] * 2)
    lines = (tmp_path / "s.tps").read_text().splitlines()
    assert [line for line in lines if "=" in line] == ["LM3=1", "CURVES=2", "POINTS=3", "POINTS=3", "ID=one"] * 2
    read = read_landmark_sets(tmp_path / "s.tps")[1]
    assert read.names == ("1", *(f"curve{i}_{k}" for i in (1, 2) for k in (1, 2, 3)))
    np.testing.assert_array_equal(read.points, points[[0, 5, 1, 6, 2, 3, 4]])
