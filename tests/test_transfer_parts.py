"""Things carried over maps of parts in both directions: what has no counterpart gets nothing, all else its own."""

import json
import types
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from commandline import run
from kfmaps import datasets
from kfmaps.batch.page import summary_page
from kfmaps.batch.results import Result
from kfmaps.evaluation import PartTruth, _true_overlap
from kfmaps.fmap.precise import PointMap, invert_precise_map, nearest_vertices, point_positions
from kfmaps.geometry.mesh import surface_area, vertex_areas
from kfmaps.io import load_map, save_map, write_mesh
from kfmaps.io.transfer import find_counterparts
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import MatchPart, ShapeFile

NEAR = 0.02
"""In √area of the whole: the meshes of part and whole have nothing to do with each other."""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> types.SimpleNamespace:
    """True maps from a whole to its part, "down", and from the part to the whole, "up"."""
    folder = tmp_path_factory.mktemp("parts")
    pair = datasets.partial(1500, rng=1)
    whole, part = pair.source, pair.target
    place = PointMap(pair.truth_faces, pair.truth_weights)
    common = _true_overlap(whole, part, PartTruth(np.arange(len(part.vertices)), place, True))
    write_mesh(folder / "whole.ply", whole)
    write_mesh(folder / "part.ply", part)
    files = ShapeFile(str(folder / "whole.ply")), ShapeFile(str(folder / "part.ply"))
    overlap = MatchPart(overlap_source=common.astype(float))
    down = Match(pair.truth, precise_map=place, partial=overlap, source_file=files[0], target_file=files[1])
    save_map(folder / "down.npz", down)
    back = invert_precise_map(place, whole, part)
    points = np.where(common, nearest_vertices(back, part), -1)
    up = Match(points, precise_map=back, source_file=files[1], target_file=files[0])
    save_map(folder / "up.npz", up)
    size = np.sqrt(surface_area(whole))
    return types.SimpleNamespace(
        folder=folder, whole=whole, part=part, place=place, common=common, true=point_positions(place, whole), size=size
    )


def lines(path: Path, rows: list[str]) -> Path:
    path.write_text("".join(f"{row}\n" for row in rows), encoding="utf-8")
    return path


def test_a_true_map_of_a_part_is_told_to_be_one(made: types.SimpleNamespace, tmp_path: Path) -> None:
    """With the truth as triangles and weights, or as lines "whole part"; of the part as target and as source."""
    rows = [f"{f + 1} {a} {b} {c}" for f, (a, b, c) in zip(made.place.faces, made.place.weights.tolist(), strict=True)]
    dense = lines(tmp_path / "part.baryc_gt", rows)

    def output(map: str, *words: object) -> dict:
        ran = run("evaluate", made.folder / map, "--truth-part", *words, "--json")
        assert (ran.status, ran.stderr) == (0, "")
        return json.loads(ran.stdout)

    areas = vertex_areas(made.whole)
    down = output("down.npz", dense)
    assert down["mean"] < 1e-6
    assert (down["matched"], down["overlap"], down["points"]) == (1.0, 1.0, len(made.part.vertices))
    assert down["missing"] == pytest.approx(1 - areas[made.common].sum() / areas.sum())
    up = output("up.npz", dense, "--part", "source")
    assert up["mean"] < NEAR
    assert up["matched"] > 0.95
    assert up["overlap"] > 0.95
    assert up["missing"] == down["missing"]
    corners = made.whole.faces[made.place.faces, made.place.weights.argmax(axis=1)]
    some = np.arange(0, len(corners), 7)
    listed = lines(tmp_path / "pairs.txt", [f"{corners[v]} {v}" for v in some])
    few = output("down.npz", listed)
    assert few["points"] == len(some)
    assert 0 < few["mean"] < 2 * NEAR
    shown = run("evaluate", made.folder / "down.npz", "--truth-part", dense).stdout
    for text in ("of the truth's points matched", "100.0 %", "overlap, intersection over union", "missing of the"):
        assert text in shown


def test_a_truth_that_is_none_of_this_part_is_refused(made: types.SimpleNamespace, tmp_path: Path) -> None:
    n = len(made.part.vertices)
    good = ["1 1 0 0"] * n
    for rows, name, more, words in (
        (good[1:], "a.baryc_gt", (), f"{n} lines, one per vertex of the part"),
        (["1 1 1 1", *good[1:]], "b.baryc_gt", (), "three weights of sum 1"),
        (["999999 1 0 0", *good[1:]], "c.baryc_gt", (), "999998"),
        ([f"0 {n}"], "d.txt", (), f"vertices of the part from 0 to {n - 1}"),
        (good, "e.baryc_gt", ("--part", "head"), "source or target"),
        (good, "f.baryc_gt", ("--identity",), "one truth"),
    ):
        file = lines(tmp_path / name, rows)
        assert words in run("evaluate", made.folder / "down.npz", "--truth-part", file, *more).error


def test_values_of_a_part_come_back_to_what_both_have(made: types.SimpleNamespace, tmp_path: Path) -> None:
    np.save(tmp_path / "x.npy", made.true)
    run("transfer", made.folder / "down.npz", tmp_path / "x.npy", "--back", "-o", tmp_path / "y.npy")
    found = np.load(tmp_path / "y.npy")
    np.testing.assert_array_equal(np.isnan(found).any(axis=1), ~made.common)
    off = np.linalg.norm(found - made.whole.vertices, axis=1)[made.common] / made.size
    assert off.mean() < NEAR
    labels = np.arange(len(made.part.vertices))
    np.save(tmp_path / "x.npy", labels)
    for more, lost in (((), -1), (("--lost", 7), 7)):
        words = ("transfer", made.folder / "down.npz", tmp_path / "x.npy", "--back", *more, "--force")
        run(*words, "-o", tmp_path / "l.npy")
        np.testing.assert_array_equal(np.load(tmp_path / "l.npy")[~made.common], lost)


def test_values_of_a_whole_come_back_to_its_part(made: types.SimpleNamespace, tmp_path: Path) -> None:
    """Faces of the whole with a corner that has no counterpart lie nowhere on the part, and have no say."""
    given = made.whole.vertices.copy()
    given[~made.common] = 1e6
    np.save(tmp_path / "x.npy", given)
    run("transfer", made.folder / "up.npz", tmp_path / "x.npy", "--back", "-o", tmp_path / "y.npy")
    found = np.load(tmp_path / "y.npy")
    known = ~np.isnan(found).any(axis=1)
    assert known.mean() > 0.9
    assert np.linalg.norm(found - made.true, axis=1)[known].mean() / made.size < NEAR


def points_over(map: Path, chosen: np.ndarray, folder: Path, *more: str) -> np.ndarray:
    """Vertex and place, NaN for nowhere, of named points that the command carries."""
    lines(folder / "a.csv", [f"p{v},{v}" for v in chosen])
    run("transfer", map, folder / "a.csv", "--points", *more, "-o", folder / "b.csv")
    rows = [line.split(",") for line in (folder / "b.csv").read_text(encoding="utf-8").splitlines()[1:]]
    return np.array([[float("nan" if cell == "NA" else cell) for cell in row[1:5]] for row in rows])


@pytest.mark.parametrize("down", [True, False])
def test_points_go_over_both_maps_both_ways(made: types.SimpleNamespace, tmp_path: Path, down: bool) -> None:
    """Those of the whole outside the part are nowhere."""
    map, to_part, to_whole = ("down.npz", (), ("--back",)) if down else ("up.npz", ("--back",), ())
    chosen = np.random.default_rng(0).permutation(len(made.whole.vertices))[:60]
    found = points_over(made.folder / map, chosen, tmp_path, *to_part)
    np.testing.assert_array_equal(found[:, 0] == -1, ~made.common[chosen])
    np.testing.assert_array_equal(np.isnan(found[:, 1:]).all(axis=1), ~made.common[chosen])
    inside = made.common[chosen]
    ends = made.true[found[inside, 0].astype(int)]
    assert np.linalg.norm(ends - made.whole.vertices[chosen[inside]], axis=1).mean() / made.size < 2 * NEAR
    chosen = np.random.default_rng(0).permutation(len(made.part.vertices))[:40]
    found = points_over(made.folder / map, chosen, tmp_path, *to_whole, "--force")
    there = found[:, 0] >= 0
    assert there.mean() > 0.85
    assert np.linalg.norm(found[there, 1:] - made.true[chosen[there]], axis=1).mean() / made.size < NEAR


def test_of_a_list_without_overlap_the_distance_tells(made: types.SimpleNamespace) -> None:
    plain = Match(load_map(made.folder / "up.npz").target_to_source)
    ways = find_counterparts(plain, made.part, made.whole)
    np.testing.assert_array_equal(ways.target, made.common)
    assert ways.source.mean() > 0.5
    some = Match(np.where(made.whole.vertices[:, 1] > np.median(made.whole.vertices[:, 1]), plain.target_to_source, -1))
    fewer = find_counterparts(some, made.part, made.whole)
    assert fewer.source.mean() < ways.source.mean()
    assert not fewer.source.all()


def test_the_summary_shows_how_much_both_have() -> None:
    done = Result("a", "b", "done", "s", "i", verdict="sure", seconds={"total": 1.0})
    part = replace(done, target="c", common_s=0.421, common_t=0.987)
    page = summary_page("x", [done, part], {}, {}, 2)
    for text in ("of source", "42%", "99%", "pairs with a part"):
        assert text in page
    plain = summary_page("x", [done], {}, {}, 1)
    assert "of source" not in plain
    assert "pairs with a part" not in plain
