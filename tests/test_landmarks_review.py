"""``kfmaps landmarks review``: what is corrected on the page comes into all tables, and into the maps."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from collecting import CONFIG, registered
from commandline import run
from kfmaps._arrays import InvalidInput
from kfmaps.batch.landmark_tables import read_corrections, read_study, write_study
from kfmaps.batch.layout import Pair, find_collection
from kfmaps.batch.plan import make_plan
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.transfer_landmarks import correct_landmarks, corrected_pairs, read_templates
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import read_mesh, write_mesh
from kfmaps.io.landmark_files import LandmarkSet, read_landmark_sets, write_landmark_sets
from kfmaps.viz.landmark_review import ReviewServer
from reviewing import AT, LABELS, QUICK, N, rows_of
from serving import Client, page_data

pytest_plugins = ["reviewing"]


def tables(study: Path) -> dict[str, bytes]:
    return {str(path.relative_to(study)): path.read_bytes() for path in study.rglob("*") if path.is_file()}


def test_a_study_that_is_read_and_written_again_is_the_same(study: Path) -> None:
    before = tables(study)
    write_study(study, *read_study(study))
    assert tables(study) == before
    assert [one.misfit for one in read_study(study)[0]] == ["", "", "", "it is a cat"]
    with pytest.raises(InvalidInput, match="Run kfmaps landmarks transfer first"):
        read_study(study / "shape")


def test_the_page_begins_with_a_flagged_specimen(serving: ReviewServer) -> None:
    client = Client(serving)
    data = page_data(client.get().body.decode())
    assert (data["source"]["name"], data["target"]["name"]) == ("a", "b")
    assert [one["flag"] for one in data["landmarks"]] == ["", "low confidence", "", "", "no counterpart"]
    assert [one["place"] is None for one in data["landmarks"]] == [False, False, False, False, True]
    assert data["specimens"] == [
        {"page": 0, "name": "a", "flags": 0},
        {"page": 1, "name": "b", "flags": 2},
        {"page": 2, "name": "c", "flags": 0},
    ]
    assert page_data(client.get("2").body.decode())["target"]["name"] == "c"
    assert client.get("3").status == 404


def test_corrections_come_into_all_tables(study: Path, serving: ReviewServer) -> None:
    mesh = read_mesh(study.parent / "scans" / "b.ply")
    face, weights = 17, [0.5, 0.25, 0.25]
    changes = [{"name": "b", "face": face, "weights": weights}, {"name": "a", "checked": True}, {"name": "c"}]
    scores = (study / "shape" / "procrustes.csv").read_bytes()
    answer = Client(serving).post("save", {"specimen": "b", "changes": changes})
    assert (answer.status, answer.json["saved"], answer.json["flags"]) == (200, 3, 1)
    at = weights @ mesh.vertices[mesh.faces[face]]
    rows = rows_of(study, "b")
    assert [rows[name]["flag"] for name in LABELS] == ["checked", "corrected", "corrected", "", "no counterpart"]
    np.testing.assert_allclose([float(rows["b"][axis]) for axis in "xyz"], at, atol=1e-12)
    assert (rows["b"]["confidence"], rows["c"]["x"]) == ("1", "NA")
    for path in ("landmarks/b.mrk.json", "landmarks.tps", "landmarks_wide.csv"):
        sets = read_landmark_sets(study / path)
        own = next(one for one in sets if one.specimen in ("b", ""))
        np.testing.assert_allclose(own.points[1], at, atol=1e-7)
        assert np.isnan(own.points[2]).all()
    assert (study / "shape" / "procrustes.csv").read_bytes() != scores
    markups = json.loads((study / "landmarks" / "b.mrk.json").read_text())["markups"][0]["controlPoints"]
    assert [one["selected"] for one in markups] == [True, True, True, True, False]
    assert read_corrections(study)["b"]["a"][1] == "checked"
    Client(serving).post("save", {"specimen": "b", "changes": [{"name": "e", "face": 0, "weights": [1, 0, 0]}]})
    assert sorted(read_corrections(study)["b"]) == ["a", "b", "c", "e"]


@pytest.mark.parametrize(
    "request_",
    [
        None,
        {"specimen": "d", "changes": [{"name": "a"}]},
        {"specimen": "b", "changes": []},
        {"specimen": "b", "changes": [{"name": "z"}]},
        {"specimen": "b", "changes": [{"name": "a", "face": 596, "weights": [1, 0, 0]}]},
        {"specimen": "b", "changes": [{"name": "a", "face": 0, "weights": [1, 0, 1]}]},
        {"specimen": "b", "changes": [{"name": "a", "face": 0, "weights": [2, -1, 0]}]},
        {"specimen": "b", "changes": [{"name": "a", "face": 0, "weights": [float("nan"), 0, 1]}]},
        {"specimen": "b", "changes": [{"name": "a", "face": True, "weights": [1, 0, 0]}]},
    ],
)
def test_bad_corrections_are_refused(study: Path, serving: ReviewServer, request_: Any) -> None:
    before = tables(study)
    assert Client(serving).post("save", request_).status == 400
    assert tables(study) == before


@pytest.mark.usefixtures("study")
def test_corrected_specimens_are_matched_again_with_what_was_corrected(tmp_path: Path) -> None:
    scans = find_collection(tmp_path / "scans")
    templates = read_templates([tmp_path / f"{name}.mrk.json" for name in "ab"], scans)
    point = read_mesh(scans.shapes["c"]).vertices[7]
    output = (point, "corrected")
    corrections = {
        "c": {"a": output, "e": output, "b": (np.full(3, np.nan), "corrected")},
        "b": {"a": output},
        "gone": {},
    }
    found = corrected_pairs(templates, scans, corrections, tmp_path / "corrected")
    assert list(found) == [Pair("a", "c"), Pair("b", "c")]  # none between templates, which test the landmarks
    sides = [read_landmark_sets(path)[0] for path in found[Pair("b", "c")]]
    assert [one.names for one in sides] == [("a",), ("a",)]  # b lacks the landmark e
    np.testing.assert_allclose(sides[1].points, [point])
    plain = replace(scans, landmarks={})
    pairs = [Pair("a", "c"), Pair("a", "d")]
    before = make_plan(plain, pairs, RunSpec(CONFIG), tmp_path / "out")
    again = make_plan(replace(plain, pair_landmarks=found), pairs, RunSpec(CONFIG), tmp_path / "out")
    assert [a.inputs == b.inputs for a, b in zip(before.tasks, again.tasks, strict=True)] == [False, True]
    assert again.tasks[0].landmarks == tuple(found[Pair("a", "c")])


def test_a_correction_moves_its_landmark_alone(study: Path) -> None:
    one = read_study(study)[0][1]
    mesh = read_mesh(one.scan)
    at = mesh.vertices[mesh.faces[40]].mean(axis=0)
    new = correct_landmarks(one, {"d": (at, "corrected")})
    np.testing.assert_allclose(new.points.points[3], at, atol=1e-9)
    assert new.points.vertices[3] in mesh.faces[40]
    for name in ("points", "vertices", "confidence"):
        a, b = (np.delete(getattr(points, name), 3, axis=0) for points in (new.points, one.points))
        np.testing.assert_array_equal(a, b)


@pytest.mark.usefixtures("workers_here")
def test_the_command_keeps_corrections_and_fits_maps_to_them(tmp_path: Path) -> None:
    scans = tmp_path / "scans"
    scans.mkdir()
    for i, name in enumerate("ab"):
        write_mesh(scans / f"{name}.ply", Mesh(10 * registered(i, N).vertices, registered(i, N).faces))
    points = read_mesh(scans / "a.ply").vertices[AT]
    write_landmark_sets(tmp_path / "a.mrk.json", [LandmarkSet(LABELS, points, space="LPS")])
    words = ["landmarks", "transfer", scans, "--from", tmp_path / "a.mrk.json", "-o", tmp_path / "out", "-q"]
    words += [*QUICK, "--keep", "b"]
    assert run(*words).status == 0
    at = read_mesh(scans / "b.ply").vertices[5]
    made = ReviewServer(tmp_path / "out")
    face = int(np.flatnonzero((read_mesh(scans / "b.ply").faces == 5).any(axis=1))[0])
    weights = (read_mesh(scans / "b.ply").faces[face] == 5).astype(float).tolist()
    made._save({"specimen": "b", "changes": [{"name": "c", "face": face, "weights": weights}]})
    made.close()
    assert run(*words).status == 0
    row = rows_of(tmp_path / "out", "b")["c"]
    assert row["flag"] == "corrected"
    np.testing.assert_allclose([float(row[axis]) for axis in "xyz"], at, atol=1e-9)
    result = json.loads(next((tmp_path / "out" / "matches" / "pairs").glob("*.json")).read_text())
    assert result["landmarks"] == 1
    summary = (tmp_path / "out" / "summary.txt").read_text()
    assert "1 corrected, 0 checked by hand" in summary
