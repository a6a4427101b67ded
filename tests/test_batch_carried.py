"""Landmarks of one specimen on all of a collection, along the maps of a run."""

from __future__ import annotations

import csv
import itertools
import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from collecting import CONFIG, LANDMARKS, done, touch, write_collection
from kfmaps._arrays import InvalidInput
from kfmaps.batch.layout import Pair, find_collection
from kfmaps.batch.plan import make_plan
from kfmaps.batch.propagate_landmarks import propagate_landmarks, write_propagated
from kfmaps.batch.results import read_result, result_path, write_result
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.work import map_path
from kfmaps.cli.main import main
from kfmaps.io import load_map, read_mesh, read_vertex_numbers, save_map
from kfmaps.io.landmark_files import read_landmark_sets

NAMES = ("tip", "base", 'a "quoted", one')
LINES = np.array([20, 90, 150])


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Poses 0 to 3 in a chain, 0 → 1, 2 → 1, 2 → 3, each in a unit of its own; and landmarks on the first."""
    folder = write_collection(tmp_path_factory.mktemp("shapes"), 4)
    out = tmp_path_factory.mktemp("out")
    pairs = [Pair("b0", "b1"), Pair("b2", "b1"), Pair("b2", "b3")]
    done(make_plan(find_collection(folder), pairs, RunSpec(CONFIG, landmark_lines=LANDMARKS), out))
    for pair in pairs:  # as sure as can be of true maps
        path = map_path(out, pair.key)
        found = load_map(path)
        truth = [read_vertex_numbers(folder / "corres" / f"{n}.vts") for n in (pair.source, pair.target)]
        points = np.empty_like(found.target_to_source)
        points[truth[1]] = truth[0]
        save_map(path, found.replaced(target_to_source=points, precise_map=None), force=True)
    return folder, out


def marks(folder: Path, name: str = "b0") -> np.ndarray:
    return read_vertex_numbers(folder / "corres" / f"{name}.vts")[LINES]


def landmark_file(path: Path, vertices: np.ndarray) -> Path:
    with open(path, "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["name", "vertex"], *zip(NAMES, vertices.tolist(), strict=True)])
    return path


def test_landmarks_reach_all_along_true_maps(run: tuple[Path, Path], tmp_path: Path) -> None:
    folder, out = run
    found, missed = propagate_landmarks(out, landmark_file(tmp_path / "m.csv", marks(folder)), "b0")
    assert not missed
    assert [one.specimen for one in found] == ["b0", "b1", "b2", "b3"]
    assert [one.through for one in found] == [(), (), ("b1",), ("b1", "b2")]
    for one in found:
        mesh = read_mesh(folder / f"{one.specimen}.off")
        np.testing.assert_allclose(one.points.points, mesh.vertices[marks(folder, one.specimen)], atol=1e-6)
        np.testing.assert_array_equal(one.points.vertices, marks(folder, one.specimen))
        assert one.points.names == NAMES
    sure = [one.points.confidence for one in found]
    assert (sure[0] == 1).all()
    assert all((a >= b - 1e-12).all() for a, b in itertools.pairwise(sure))  # each step can only lose


def test_the_command_writes_csv_and_tps(
    run: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, out = run
    file = landmark_file(tmp_path / "m.csv", marks(folder, "b2"))
    words = ["transfer", "--collection", str(out), "--landmarks", str(file), "-o"]
    for name in ("all.csv", "all.tps"):
        assert main([*words, str(tmp_path / name), "--on", "b2.off", "--json"]) == 0
        assert json.loads(capsys.readouterr().out) == {"output": [str(tmp_path / name)]}
    with open(tmp_path / "all.csv", encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    assert len(rows) == 12
    assert {r["name"] for r in rows} == set(NAMES)
    for row in rows:
        mesh = read_mesh(folder / f"{row['specimen']}.off")
        here = np.array([float(row[c]) for c in "xyz"])
        weights = np.array([float(row[f"weight_{i}"]) for i in (1, 2, 3)])
        np.testing.assert_allclose(weights @ mesh.vertices[mesh.faces[int(row["face"])]], here, atol=1e-6)
        assert 0 <= float(row["confidence"]) <= 1
    blocks = (tmp_path / "all.tps").read_text(encoding="utf-8").split("LM3=3\n")[1:]
    ids = [b.strip().split("\n")[-1] for b in blocks]
    assert ids[0] == "ID=b2"
    assert set(ids) == {"ID=b0", "ID=b1", "ID=b2", "ID=b3"}
    first = np.array([[float(x) for x in line.split()] for line in blocks[0].split("\n")[:3]])
    np.testing.assert_allclose(first, read_mesh(folder / "b2.off").vertices[marks(folder, "b2")], atol=1e-6)
    words += [str(tmp_path / "all.csv"), "--force"]
    assert main(words) == 2
    assert "--on" in capsys.readouterr().err
    assert main([*words, "--on", "nobody"]) == 2
    assert main(["transfer", "--landmarks", str(file), "-o", str(tmp_path / "x.csv")]) == 2
    assert "no --collection" in capsys.readouterr().err
    assert main(["transfer", "-o", str(tmp_path / "x.csv")]) == 2
    assert "MAP and VALUES" in capsys.readouterr().err


def test_what_fits_none_is_left_out(run: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, out = run
    file = landmark_file(tmp_path / "m.csv", marks(folder))
    path = result_path(out, "b2-b3")
    known = path.read_text(encoding="utf-8")
    try:
        result = read_result(path)
        assert result is not None
        write_result(path, replace(result, confidence=0.12, verdict="unlikely"))
        words = ["transfer", "--collection", str(out), "--landmarks", str(file), "--on", "b0", "-o"]
        assert main([*words, str(tmp_path / "all.tps")]) == 0
        told = capsys.readouterr().err
        assert "b3 fits none of the others (its maps are right with 12 %): left out; --keep b3 keeps it" in told
        assert [one.specimen for one in read_landmark_sets(tmp_path / "all.tps")] == ["b0", "b1", "b2"]
        assert main([*words, str(tmp_path / "kept.tps"), "--keep", "b3"]) == 0
        assert len(read_landmark_sets(tmp_path / "kept.tps")) == 4
    finally:
        path.write_text(known, encoding="utf-8")


@contextmanager
def without_tip(folder: Path, out: Path, *keys: str) -> Iterator[None]:
    """The maps of ``keys`` as those of parts: what is around the first landmark on the target has no counterpart."""
    kept = {key: map_path(out, key).read_bytes() for key in keys}
    try:
        for key in keys:
            found, target = load_map(map_path(out, key)), key.split("-")[1]
            mesh = read_mesh(folder / f"{target}.off")
            near = np.linalg.norm(mesh.vertices - mesh.vertices[marks(folder, target)[0]], axis=1)
            lost = np.where(near <= np.sort(near)[8], -1, found.target_to_source)
            save_map(map_path(out, key), found.replaced(target_to_source=lost), force=True)
        yield
    finally:
        for key, content in kept.items():
            map_path(out, key).write_bytes(content)


def test_what_only_a_part_leads_to_has_the_landmarks_that_it_has(run: tuple[Path, Path], tmp_path: Path) -> None:
    folder, out = run
    file = landmark_file(tmp_path / "m.csv", marks(folder))
    with without_tip(folder, out, "b2-b1"):  # b2 by the part, b3 behind it
        found, missed = propagate_landmarks(out, file, "b0")
        assert not missed
        assert [one.through for one in found] == [(), (), ("b1",), ("b1", "b2")]
        for one in found:
            lost = one.specimen in ("b2", "b3")
            np.testing.assert_array_equal(one.points.vertices[1:], marks(folder, one.specimen)[1:])
            assert (one.points.vertices[0] == -1) == lost
            assert np.isnan(one.points.points[0]).all() == lost
            assert np.isnan(one.points.confidence[0]) == lost
            assert (one.points.confidence[1:] > 0).all()
        write_propagated(tmp_path / "all.csv", found)
        write_propagated(tmp_path / "all.tps", found)
    with open(tmp_path / "all.csv", encoding="utf-8", newline="") as table:
        gone = [row for row in csv.DictReader(table) if row["vertex"] == "-1"]
    assert [(row["specimen"], row["name"]) for row in gone] == [("b2", "tip"), ("b3", "tip")]
    assert all(row[c] == "" for row in gone for c in ("x", "y", "z", "weight_1", "confidence"))
    assert (tmp_path / "all.tps").read_text(encoding="utf-8").count("NA NA NA\n") == 2
    with without_tip(folder, out, "b0-b1", "b2-b3"):  # forth and back over parts
        found, _ = propagate_landmarks(out, file, "b0")
        assert [int((one.points.vertices >= 0).sum()) for one in found] == [3, 2, 2, 2]


def test_maps_of_parts_are_gone_round(run: tuple[Path, Path], tmp_path: Path) -> None:
    folder, out = run
    file = landmark_file(tmp_path / "m.csv", marks(folder))
    plan = make_plan(find_collection(folder), [Pair("b0", "b2")], RunSpec(CONFIG, landmark_lines=LANDMARKS), out)
    done(plan)
    found = load_map(map_path(out, "b0-b2"))
    points = np.empty_like(found.target_to_source)
    points[read_vertex_numbers(folder / "corres" / "b2.vts")] = read_vertex_numbers(folder / "corres" / "b0.vts")
    save_map(map_path(out, "b0-b2"), found.replaced(target_to_source=points, precise_map=None), force=True)
    try:
        with without_tip(folder, out, "b0-b2"):
            carried, _ = propagate_landmarks(out, file, "b0")
            through = {one.specimen: one.through for one in carried}
            assert through == {"b0": (), "b1": (), "b2": ("b1",), "b3": ("b1", "b2")}
            assert all((one.points.vertices >= 0).all() for one in carried)
        with without_tip(folder, out, "b0-b2", "b2-b3"):  # by a part to b3 alone
            carried, _ = propagate_landmarks(out, file, "b0")
            assert {one.specimen: one.through for one in carried} == through
            assert [int((one.points.vertices >= 0).sum()) for one in carried] == [3, 3, 3, 2]
        carried, _ = propagate_landmarks(out, file, "b0")
        assert next(one.through for one in carried if one.specimen == "b3") == ("b2",)
    finally:
        map_path(out, "b0-b2").unlink()
        result_path(out, "b0-b2").unlink()


def test_what_cannot_be_carried(run: tuple[Path, Path], tmp_path: Path) -> None:
    _, out = run
    with pytest.raises(InvalidInput, match="an output folder of kfmaps batch"):
        propagate_landmarks(tmp_path, touch(tmp_path / "m.csv", "a,1\n"))
    with pytest.raises(InvalidInput, match="vertices from 0 to 199"):
        propagate_landmarks(out, touch(tmp_path / "m.csv", "a,999\n"), "b0")
