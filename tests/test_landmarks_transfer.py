"""``kfmaps landmarks transfer``: from files of landmarks and a folder of scans to tables and statistics."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from collecting import CONFIG, done
from commandline import run
from kfmaps._arrays import InvalidInput
from kfmaps.batch.landmark_tables import _sliders, write_study
from kfmaps.batch.layout import Pair, find_collection
from kfmaps.batch.plan import make_plan
from kfmaps.batch.results import Result
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.transfer_landmarks import (
    MAX_SPREAD,
    SpecimenLandmarks,
    Template,
    drop_unsure,
    propagate_landmarks,
    read_templates,
    template_errors,
    template_landmarks,
    template_pairs,
)
from kfmaps.batch.work import map_path
from kfmaps.cli.commands.landmarks import _describe_study
from kfmaps.collection.semilandmarks import bending_energy_matrix
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io import load_map, read_mesh, save_map, write_mesh
from kfmaps.io.landmark_files import LandmarkSet, read_landmark_sets, write_landmark_sets
from kfmaps.io.named_points import read_given_landmarks
from kfmaps.matching.result import Match
from reviewing import AT, LABELS, QUICK, N, write_scans


@pytest.fixture
def scans(tmp_path: Path) -> Path:
    return write_scans(tmp_path, size=10)


def maps(folder: Path, pairs: list[tuple[str, str]], chance: float = 0.9) -> dict[Pair, Result]:
    """True maps of pairs of scans, saved as a run saves them, and their results."""
    (folder / "maps").mkdir(exist_ok=True)
    found = {}
    for a, b in pairs:
        true = Match(np.arange(N), local_confidence=np.full(N, 0.8))
        save_map(map_path(folder, f"{a}-{b}"), true, force=True)
        found[Pair(a, b)] = Result(a, b, "done", "", "", verdict="sure", confidence=chance)
    return found


def carried(templates: list[Template], name: str, results: dict[Pair, Result], folder: Path) -> SpecimenLandmarks:
    """The templates' landmarks on a scan, over the maps of all templates to it."""
    own = {one.specimen: results[Pair(one.specimen, name)] for one in templates}
    return propagate_landmarks(templates, name, folder / "scans" / f"{name}.ply", own, folder)


def test_one_template_over_true_maps(scans: Path, tmp_path: Path) -> None:
    (template,) = read_templates([tmp_path / "a.mrk.json"], find_collection(scans))
    results = maps(tmp_path, [("a", "b")])
    one = carried([template], "b", results, tmp_path)
    np.testing.assert_allclose(one.points.points, read_mesh(scans / "b.ply").vertices[AT], atol=1e-9)
    np.testing.assert_allclose(one.points.confidence, 0.9 * 0.8)
    assert one.flags == ("",) * 5
    assert np.isnan(one.spread).all()
    assert np.isnan(one.rival_distance).all()
    assert (one.misfit, one.space) == ("", "LPS")
    low = maps(tmp_path, [("a", "b")], chance=0.6)[Pair("a", "b")]
    one = propagate_landmarks([template], "b", scans / "b.ply", {"a": low}, tmp_path)
    assert one.flags == ("low confidence",) * 5
    gone = drop_unsure(one, 0.5).points
    assert (gone.vertices == -1).all()
    assert np.isnan(gone.points).all()
    assert (drop_unsure(one, 0.4).points.vertices >= 0).all()


def test_the_distance_to_the_best_other_map(scans: Path, tmp_path: Path) -> None:
    (template,) = read_templates([tmp_path / "a.mrk.json"], find_collection(scans))
    results = maps(tmp_path, [("a", "b")])
    path = map_path(tmp_path, "a-b")
    turned = np.stack([np.roll(np.arange(N), 7), np.arange(N)[::-1]])
    save_map(path, Match(np.arange(N), alternatives=tuple(turned)), force=True)
    one = carried([template], "b", results, tmp_path)
    mesh = read_mesh(scans / "b.ply").vertices
    elsewhere = [mesh[np.argsort(other)[AT]] for other in turned]
    expected = np.min([np.linalg.norm(points - mesh[AT], axis=1) for points in elsewhere], axis=0)
    np.testing.assert_allclose(one.rival_distance, expected, rtol=1e-6)


def test_three_templates_outvote_one_that_is_off(scans: Path, tmp_path: Path) -> None:
    collection = find_collection(scans)
    mesh = read_mesh(scans / "c.ply")
    wrong = LandmarkSet(LABELS, np.vstack([mesh.vertices[[200]], mesh.vertices[AT[1:]]]))
    write_landmark_sets(tmp_path / "c.mrk.json", [wrong], force=True)
    templates = read_templates([tmp_path / f"{name}.mrk.json" for name in "abc"], collection)
    results = maps(tmp_path, [(name, "d") for name in "abc"] + [("a", "b"), ("c", "b")])
    one = carried(templates, "d", results, tmp_path)
    surface = read_mesh(scans / "d.ply")
    np.testing.assert_allclose(one.points.points, surface.vertices[AT], atol=1e-3)
    assert one.flags == ("templates disagree", "", "", "", "")
    np.testing.assert_allclose(one.points.confidence, [0.72 * 2 / 3, *[0.72] * 4])
    far = np.linalg.norm(surface.vertices[200] - surface.vertices[AT[0]])
    assert one.spread[0] == pytest.approx(far, rel=1e-3)
    errors = template_errors(templates, results, tmp_path)
    assert errors.shape == (2, 5)
    np.testing.assert_allclose(errors[0], 0, atol=1e-9)
    assert errors[1, 0] > 1
    assert len(template_pairs(templates, collection)) == 9


def test_templates_agree_within_a_share_of_the_size_of_the_scan(scans: Path, tmp_path: Path) -> None:
    mesh = read_mesh(scans / "c.ply")
    face = mesh.faces[(mesh.faces == AT[0]).any(axis=1)][0]
    ends = mesh.vertices[[AT[0], face[face != AT[0]][0]]]
    length = np.linalg.norm(ends[1] - ends[0])
    near = ends[0] + 0.3 * MAX_SPREAD * np.sqrt(surface_area(mesh)) / length * (ends[1] - ends[0])
    moved = LandmarkSet(LABELS, np.vstack([near[None], mesh.vertices[AT[1:]]]))
    write_landmark_sets(tmp_path / "c.mrk.json", [moved], force=True)
    templates = read_templates([tmp_path / f"{name}.mrk.json" for name in "abc"], find_collection(scans))
    results = maps(tmp_path, [(name, "d") for name in "abc"])
    one = carried(templates, "d", results, tmp_path)
    assert one.spread[0] > MAX_SPREAD, "in the unit of the scan, where it means nothing"
    np.testing.assert_allclose(one.points.confidence, 0.72)
    assert one.flags == ("",) * 5


def test_landmarks_that_a_template_lacks_come_from_the_others(scans: Path, tmp_path: Path) -> None:
    points = read_mesh(scans / "b.ply").vertices[AT]
    points[1] = np.nan
    write_landmark_sets(tmp_path / "b.fcsv", [LandmarkSet(LABELS[::-1], points[::-1], space="LPS")])
    templates = read_templates([tmp_path / "a.mrk.json", tmp_path / "b.fcsv"], find_collection(scans))
    assert [one.points.names for one in templates] == [LABELS, LABELS]
    np.testing.assert_array_equal(templates[1].points.vertices, [10, -1, 150, 220, 290])
    results = maps(tmp_path, [("a", "c"), ("b", "c")])
    one = carried(templates, "c", results, tmp_path)
    np.testing.assert_allclose(one.points.points, read_mesh(scans / "c.ply").vertices[AT], atol=1e-9)
    assert one.flags == ("",) * 5


def test_a_scan_that_fits_no_template_is_left_out(scans: Path, tmp_path: Path) -> None:
    templates = read_templates([tmp_path / "a.mrk.json"], find_collection(scans))
    results = maps(tmp_path, [("a", name) for name in "bcd"])
    results[Pair("a", "b")] = replace(results[Pair("a", "b")], verdict="unlikely", confidence=0.12)
    results[Pair("a", "c")] = Result("a", "c", "failed", "", "", reason="too large")
    study = [template_landmarks(templates[0])]
    study += [carried(templates, name, results, tmp_path) for name in "bcd"]
    flagged = replace(study[3], flags=("low confidence", "", "", "", ""))
    lines = _describe_study([study[0], flagged, flagged], templates, np.array([[0.1, 0.5, np.nan, 0.1, 0.1]]))
    assert lines == [
        "5 landmarks of 1 specimen carried to 2 others, median confidence 0.72",
        "2 of 10 flagged: a in 2 specimens (low confidence)",
        "the templates' landmarks, carried to each other, are off by 0.2 on average in the scans' unit; most b (0.5)",
    ]
    assert [one.misfit for one in study] == ["", "its best map is unlikely (12 %, from a)", "too large", ""]
    write_study(tmp_path / "out", study, ".mrk.json")
    assert [one.specimen for one in read_landmark_sets(tmp_path / "out" / "landmarks.tps")] == ["a", "d"]
    assert sorted(path.name for path in (tmp_path / "out" / "landmarks").iterdir()) == ["a.mrk.json", "d.mrk.json"]
    with open(tmp_path / "out" / "specimens.csv", encoding="utf-8") as file:
        rows = {row["specimen"]: row for row in csv.DictReader(file)}
    assert [rows[name]["status"] for name in "abcd"] == ["template", "left out", "left out", "carried"]


def test_a_map_that_swaps_left_and_right_is_recognized(scans: Path, tmp_path: Path) -> None:
    template = read_templates([tmp_path / "a.mrk.json"], find_collection(scans))[0]
    results = maps(tmp_path, [("a", "b")])
    mesh = read_mesh(scans / "b.ply")
    center = mesh.vertices.mean(axis=0)
    write_mesh(tmp_path / "m.ply", Mesh((mesh.vertices - center) * [1, 1, -1] + center, mesh.faces[:, ::-1]))
    one = propagate_landmarks([template], "b", tmp_path / "m.ply", {"a": results[Pair("a", "b")]}, tmp_path)
    assert "mirror image" in one.misfit
    points = read_mesh(tmp_path / "m.ply").vertices[AT]
    write_landmark_sets(tmp_path / "m.tps", [LandmarkSet(LABELS, points, "m")])
    write_mesh(scans / "m.ply", read_mesh(tmp_path / "m.ply"))
    write_landmark_sets(tmp_path / "m.mrk.json", [LandmarkSet(LABELS, points)])
    with pytest.raises(InvalidInput, match=r"a mirror image of .*a\.mrk\.json's"):
        read_templates([tmp_path / "a.mrk.json", tmp_path / "m.mrk.json"], find_collection(scans))


def test_names_of_templates(scans: Path, tmp_path: Path) -> None:
    collection = find_collection(scans)
    (tmp_path / "b_LM.mrk.json").write_bytes((tmp_path / "b.mrk.json").read_bytes())
    assert read_templates([tmp_path / "b_LM.mrk.json"], collection)[0].specimen == "b"
    with pytest.raises(InvalidInput, match="one file for each landmark of b"):
        read_templates([tmp_path / "b.mrk.json", tmp_path / "b_LM.mrk.json"], collection)
    (tmp_path / "x.mrk.json").write_bytes((tmp_path / "b.mrk.json").read_bytes())
    with pytest.raises(InvalidInput, match="Call the file of landmarks as the scan is called"):
        read_templates([tmp_path / "x.mrk.json"], collection)
    sets = [LandmarkSet(LABELS, read_mesh(scans / f"{n}.ply").vertices[AT], n) for n in "ab"]
    write_landmark_sets(tmp_path / "both.tps", sets)
    assert [one.specimen for one in read_templates([tmp_path / "both.tps"], collection)] == ["a", "b"]


def test_tables_and_statistics(scans: Path, tmp_path: Path) -> None:
    collection = find_collection(scans)
    templates = read_templates([tmp_path / f"{name}.mrk.json" for name in "abcd"], collection)
    study: list[SpecimenLandmarks] = [template_landmarks(one) for one in templates]
    study[3] = replace(study[3], flags=("", "look here", "", "", ""))
    write_study(tmp_path / "out", study, ".mrk.json")
    out = tmp_path / "out"
    for name in ("landmarks.csv", "landmarks_wide.csv"):
        sets = read_landmark_sets(out / name)
        assert [one.specimen for one in sets] == list("abcd")
        for one in sets:
            np.testing.assert_allclose(one.points, read_mesh(scans / f"{one.specimen}.ply").vertices[AT])
    with open(out / "shape" / "pca_scores.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    points = read_mesh(scans / "b.ply").vertices[AT]
    size = np.linalg.norm(points - points.mean(axis=0))
    assert float(rows[1]["centroid_size"]) == pytest.approx(size)
    first = [float(row["PC1"]) for row in rows]
    assert abs(np.corrcoef(first, np.arange(4))[0, 1]) > 0.99  # they are bent more and more
    extremes = [read_mesh(out / "shape" / f"PC1_{word}.ply") for word in ("minus", "plus")]
    assert len(extremes[0].vertices) == N
    assert surface_area(extremes[0]) != pytest.approx(surface_area(extremes[1]), rel=1e-3)
    assert '"look here"' in (out / "landmarks" / "d.mrk.json").read_text()


@pytest.mark.usefixtures("workers_here")
def test_the_command_goes_on_where_it_was(scans: Path, tmp_path: Path) -> None:
    words = ["landmarks", "transfer", scans, "--from", tmp_path / "b.mrk.json", tmp_path / "a.mrk.json"]
    more = ["-o", tmp_path / "out", *QUICK]
    done = run(*words, *more)
    assert done.status == 0, done.stderr
    assert "5 landmarks of 2 specimens carried to" in done.stdout
    assert "the templates' landmarks, carried to each other, are off by" in done.stdout
    times = {path: path.stat().st_mtime_ns for path in (tmp_path / "out" / "matches" / "maps").iterdir()}
    assert len(times) == 6
    again = run(*words, *more, "-q")
    assert (again.status, again.stdout) == (0, "")
    assert {path: path.stat().st_mtime_ns for path in times} == times
    lines = (tmp_path / "out" / "summary.txt").read_text().splitlines()
    assert lines[-1].endswith("local_differences.csv")
    rows = (tmp_path / "out" / "specimens.csv").read_text().splitlines()
    assert [row.split(",")[0] for row in rows[1:]] == list("bacd")
    assert "the name of a scan" in run(*words, *more, "--keep", "z").stderr
    (scans / "d.ply").write_text("ply\n")
    output = run(*words, *more)
    assert output.status == 1
    assert "d does not fit the others: shape d could not be prepared" in output.stdout


def test_a_picked_pair_of_meshes_needs_no_subcommand(scans: Path) -> None:
    assert "expected a file" in run("landmarks", scans / "a.ply", scans / "none.ply", "--no-browser").stderr
    assert "transfer" in run("landmarks", "--help").stdout


def test_a_run_takes_landmarks_of_other_programs(scans: Path, tmp_path: Path) -> None:
    (scans / "landmarks").mkdir()
    for name in "ab":
        (scans / "landmarks" / f"{name}.mrk.json").write_bytes((tmp_path / f"{name}.mrk.json").read_bytes())
    collection = find_collection(scans)
    assert sorted(collection.landmarks) == ["a", "b"]
    plan = make_plan(collection, [Pair("a", "b")], RunSpec(CONFIG), tmp_path / "out")
    (result,) = done(plan)
    assert (result.status, result.reason) == ("done", "")
    found = load_map(map_path(tmp_path / "out", "a-b"))
    np.testing.assert_array_equal(found.landmarks, np.stack([AT, AT], axis=1))


def test_landmarks_of_one_shape_alone_are_no_pairs(scans: Path, tmp_path: Path) -> None:
    words = ["landmarks", scans / "a.ply", scans / "b.ply", "--no-browser", "--landmarks", tmp_path / "a.mrk.json"]
    assert "Give --landmarks twice" in run(*words).stderr
    files = [tmp_path / "a.mrk.json", tmp_path / "b.mrk.json"]
    meshes = [read_mesh(scans / "a.ply"), read_mesh(scans / "b.ply")]
    pairs, names = read_given_landmarks(files, meshes, (None, None))
    assert names == list(LABELS)
    np.testing.assert_array_equal(pairs, np.stack([AT, AT], axis=1))


RING = np.array([12, 40, 75, 160, 200, 260])


def curve_files(folder: Path, scans: Path, name: str) -> list[Path]:
    """Landmarks and a curve of a scan, in two files as Slicer saves them."""
    vertices = read_mesh(scans / f"{name}.ply").vertices
    labels = tuple(f"curve1_{k + 1}" for k in range(6))
    write_landmark_sets(
        folder / f"{name}_crest.mrk.json", [LandmarkSet(labels, vertices[RING], space="LPS")], force=True
    )
    return [folder / f"{name}.mrk.json", folder / f"{name}_crest.mrk.json"]


def test_points_of_a_curve_slide_and_landmarks_do_not(scans: Path, tmp_path: Path) -> None:
    (template,) = read_templates(curve_files(tmp_path, scans, "a"), find_collection(scans))
    assert template.points.names == (*LABELS, *(f"curvecrest_{k}" for k in range(1, 7)))
    results = maps(tmp_path, [("a", "d")])
    one = carried([template], "d", results, tmp_path)
    mesh = read_mesh(scans / "d.ply")
    image = mesh.vertices[[*AT, *RING]]
    fixed = [0, 1, 2, 3, 4, 5, 10]
    np.testing.assert_allclose(one.points.points[fixed], image[fixed], atol=1e-9)
    assert (np.linalg.norm(one.points.points - image, axis=1)[6:10] > 0.01).all()
    bent_least = bending_energy_matrix(template.points.points)
    before, after = (np.einsum("ia,ij,ja->", x, bent_least, x) for x in (image, one.points.points))
    assert after < before
    close = closest_points(one.points.points, mesh.vertices, mesh.faces)
    np.testing.assert_allclose(close.distances, 0, atol=1e-6)
    own = template_landmarks(template)
    write_study(tmp_path / "out", [own, one, replace(one, specimen="e")], ".mrk.json")
    markups = json.loads((tmp_path / "out" / "landmarks" / "d.mrk.json").read_text())["markups"]
    assert [(m["type"], len(m["controlPoints"])) for m in markups] == [("Fiducial", 5), ("Curve", 6)]
    assert (tmp_path / "out" / "sliders.csv").read_text().split() == [
        "before,slide,after",
        "6,7,8",
        "7,8,9",
        "8,9,10",
        "9,10,11",
    ]


def test_curves_of_several_templates_slide_to_their_mean(scans: Path, tmp_path: Path) -> None:
    files = [*curve_files(tmp_path, scans, "a"), *curve_files(tmp_path, scans, "b")]
    templates = read_templates(files, find_collection(scans))
    moved = np.linalg.norm(templates[1].points.points - read_mesh(scans / "b.ply").vertices[[*AT, *RING]], axis=1)
    np.testing.assert_allclose(moved[[*range(6), 10]], 0, atol=1e-9)
    assert (moved[6:10] > 1e-3).all()
    results = maps(tmp_path, [("a", "b"), ("b", "a")])
    errors = template_errors(templates, results, tmp_path)
    assert np.isnan(errors[:, 5:]).all()
    assert np.isfinite(errors[:, :5]).all()
    labels = tuple(f"curve1_{k + 1}" for k in range(5))
    points = read_mesh(scans / "b.ply").vertices[RING[:5]]
    write_landmark_sets(files[3], [LandmarkSet(labels, points, space="LPS")], force=True)
    with pytest.raises(InvalidInput, match=r"expected 6 points of the curve crest, as another has, got 5\. Resample"):
        read_templates(files, find_collection(scans))


def test_sliders_of_a_closed_curve_go_round() -> None:
    assert _sliders(("a", "loopx_1", "loopx_2", "loopx_3")) == [[4, 2, 3], [2, 3, 4], [3, 4, 2]]
