"""Batches whose maps are made to agree: what is replaced, kept, written, and found again after an end."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from collecting import AGREED, LANDMARKS, done, write_collection
from kfmaps._arrays import InvalidInput
from kfmaps.batch.consistent import CONSISTENT, make_consistent, map_in_use
from kfmaps.batch.jobs import WorkerPool
from kfmaps.batch.layout import Pair, find_collection
from kfmaps.batch.page import write_page
from kfmaps.batch.plan import Plan, graph_pairs, make_plan
from kfmaps.batch.results import Result, read_result, result_path
from kfmaps.batch.run import run_batch
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.work import map_path
from kfmaps.io import load_map, save_map

GUARDS = ("kfmaps.collection.repair", "kfmaps.collection.synchronization")

MADE = RunSpec(AGREED, landmark_lines=LANDMARKS)


class Alone(WorkerPool):
    """A crew of this process."""

    def __init__(self, stop_after: int | None = None) -> None:
        super().__init__()
        self.asked: list[str] = []
        self.left = stop_after

    def map(
        self, what: str, function: Callable[[Any], Any], items: Sequence[Any], *, failures: bool = False
    ) -> list[Any]:
        found = []
        for item in items:
            if self.left is not None and self.left == 0:
                raise KeyboardInterrupt
            self.left = None if self.left is None else self.left - 1
            self.asked.append(what)
            try:
                found.append(function(item))
            except InvalidInput as error:
                if not failures:
                    raise
                found.append(error)
        return found


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Plan, list[Result]]:
    """Five poses matched all to all one way, and one map then replaced by a wrong one."""
    folder = write_collection(tmp_path_factory.mktemp("shapes"), 5)
    collection = find_collection(folder)
    output = tmp_path_factory.mktemp("out")
    pairs = graph_pairs(collection, MADE, output, "all", Alone())
    plan = make_plan(collection, pairs, MADE, output)
    results = done(plan)
    assert max(1.0 if r.error_mean is None else r.error_mean for r in results) < 0.05
    path = map_path(plan.folder, "b1-b3")
    found = load_map(path)
    wrong = np.random.default_rng(0).permutation(found.target_to_source)
    save_map(path, replace(found, target_to_source=wrong), force=True)
    return plan, results


def rows(path: Path) -> list[dict[str, str]]:
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_the_wrong_map_is_replaced_and_no_other(run: tuple[Plan, list[Result]]) -> None:
    plan, results = run
    before = {p: p.read_bytes() for p in (plan.folder / "maps").iterdir()}
    found = make_consistent(plan, results, Alone())
    assert len(found.before) == 1
    assert not found.doubted
    assert not found.notes
    (changed,) = [r for r in found.results if r.changed]
    assert (changed.source, changed.target) == ("b1", "b3")
    assert changed.changed.startswith("composition through b")
    assert changed.error_mean is not None
    assert changed.error_mean < 0.05
    assert changed.agreement is not None
    assert all((r.agreement or 0) > 0.5 for r in found.results)
    assert found.before[Pair("b1", "b3")] == results[[r.target for r in results if r.source == "b1"].index("b3") + 4]
    assert {p: p.read_bytes() for p in before} == before  # the run's own maps are as they were
    ours = load_map(map_in_use(plan.folder, "b1-b3"))
    assert map_in_use(plan.folder, "b1-b3") == map_path(plan.folder / CONSISTENT, "b1-b3")
    assert map_in_use(plan.folder, "b0-b1") == map_path(plan.folder, "b0-b1")
    assert len(ours.alternatives) == 1
    table = {(r["source"], r["target"]): r for r in rows(plan.folder / CONSISTENT / "pairs.csv")}
    assert float(table["b1", "b3"]["probability"]) < 0.1
    assert table["b1", "b3"]["changed"] == changed.changed
    assert sum(bool(r["changed"]) for r in table.values()) == 1
    with pytest.raises(InvalidInput, match="pairs that are matched"):
        make_consistent(plan, [], Alone())


@pytest.mark.usefixtures("workers_here")
def test_a_run_logs_what_is_replaced(run: tuple[Plan, list[Result]]) -> None:
    plan = replace(run[0], todo=())
    outcome = run_batch(plan, worst=0, consistent=True)
    assert sum(bool(result.changed) for result in outcome.results) == 1
    assert "b1 → b3 replaced by composition through b" in (plan.folder / "run.log").read_text(encoding="utf-8")


def test_a_finished_step_is_not_repeated(run: tuple[Plan, list[Result]]) -> None:
    plan, results = run
    first = make_consistent(plan, results, Alone())
    stamp = map_path(plan.folder / CONSISTENT, "b1-b3").stat().st_mtime_ns
    again = make_consistent(plan, results, Alone())
    assert again.results == first.results
    assert map_path(plan.folder / CONSISTENT, "b1-b3").stat().st_mtime_ns == stamp
    # However early it is cut off, the end is the same and nothing that was finished is lost.
    for path in (plan.folder / CONSISTENT).rglob("*.*"):
        path.unlink()
    for stop in (3, 10, 11):
        with pytest.raises(KeyboardInterrupt):
            make_consistent(plan, results, Alone(stop))
    kept = len(list((plan.folder / CONSISTENT / "evidence").glob("*.npz")))
    assert kept == len(plan.tasks)
    last = make_consistent(plan, results, Alone())
    plain = [replace(r, seconds={}, finished="", worker="") for r in last.results]
    assert plain == [replace(r, seconds={}, finished="", worker="") for r in first.results]
    # A damaged file is made again.
    damaged = plan.folder / CONSISTENT / "evidence" / "b0-b1.npz"
    damaged.write_bytes(damaged.read_bytes()[:100])
    assert len(make_consistent(plan, results, Alone()).before) == 1


def test_specimens_are_told_of(run: tuple[Plan, list[Result]]) -> None:
    plan, results = run
    found = make_consistent(plan, results, Alone())
    shapes = rows(plan.folder / CONSISTENT / "shapes.csv")
    assert [r["shape"] for r in shapes] == [f"b{i}" for i in range(5)]
    bend = [float(r["area_1"]) for r in shapes]
    assert abs(np.corrcoef(bend, np.arange(5))[0, 1]) > 0.9  # each pose bends the shape a little more
    distances = {(r["shape"], r["other"]): float(r["area"]) for r in rows(plan.folder / CONSISTENT / "distances.csv")}
    assert distances["b0", "b1"] < distances["b0", "b4"]
    write_page(plan, list(found.results), "c", 1, found)
    page = (plan.folder / "summary.html").read_text(encoding="utf-8")
    assert "composition through" in page
    assert "How the shapes differ" in page
    assert 'href="pages/b1-b3.html"' in page
    assert (plan.folder / "pages" / "b1-b3.html").exists()
    assert page.count("data:image/png;base64,") == 4  # before, now, where they differ, and the worst


def test_pairs_that_match_again_are_not_replaced_any_more(run: tuple[Plan, list[Result]]) -> None:
    plan, results = run
    make_consistent(plan, results, Alone())
    path = map_path(plan.folder, "b1-b3")
    wrong = path.read_bytes()
    right = load_map(map_path(plan.folder / CONSISTENT, "b1-b3"))
    save_map(path, replace(right, alternatives=()), force=True)
    try:
        assert len(make_consistent(plan, results, Alone()).before) == 0
        assert not map_path(plan.folder / CONSISTENT, "b1-b3").exists()
        assert read_result(result_path(plan.folder / CONSISTENT, "b1-b3")) is None
    finally:
        path.write_bytes(wrong)


def test_graphs_are_kept(tmp_path: Path) -> None:
    folder = write_collection(tmp_path / "shapes", 5)
    collection = find_collection(folder)
    crew = Alone()
    pairs = graph_pairs(collection, MADE, tmp_path / "out", "near", crew)
    assert len(pairs) >= 5
    assert "shapes" in crew.asked
    again = Alone()
    assert graph_pairs(collection, MADE, tmp_path / "out", "near", again) == pairs
    assert not again.asked
    star = graph_pairs(collection, MADE, tmp_path / "out", "star", Alone())
    assert len({p.source for p in star}) == 1
    assert len(star) == 4
    with pytest.raises(InvalidInput, match="near, star, star:SHAPE"):
        graph_pairs(collection, MADE, tmp_path / "out", "ring", Alone())


def test_a_shape_that_cannot_be_prepared_is_in_the_graph(tmp_path: Path) -> None:
    """One pair of it is there to fail, so that the log, the table, the page and the exit status tell of it."""
    folder = write_collection(tmp_path / "shapes", 5)
    (folder / "b2.off").write_text("OFF\n3 1 0\n0 0 0\n", encoding="utf-8")
    collection = find_collection(folder)
    for kind in ("near", "star"):
        pairs = graph_pairs(collection, MADE, tmp_path / kind, kind, Alone())
        (pair,) = [pair for pair in pairs if "b2" in (pair.source, pair.target)]
        (result,) = done(make_plan(collection, [pair], MADE, tmp_path / kind))
        assert result.status == "failed"
        assert "shape b2 could not be prepared" in result.reason


def test_maps_of_parts_take_no_part(run: tuple[Plan, list[Result]]) -> None:
    """They stay as they are, and it says so; the others agree as without them."""
    plan, results = run
    path = map_path(plan.folder, "b0-b4")
    whole = path.read_bytes()
    found = load_map(path)
    some = np.where(np.arange(len(found.target_to_source)) < 20, -1, found.target_to_source)
    save_map(path, replace(found, target_to_source=some), force=True)
    try:
        agreed = make_consistent(plan, results, Alone())
        (note,) = agreed.notes
        assert note.startswith("b0 → b4: the map of a part stays as it is")
        assert "20 of 200 vertices" in note
        assert len(agreed.before) == 1
        assert {(r.source, r.target) for r in agreed.results if r.agreement is None} == {("b0", "b4")}
        alone = [r for r in results if (r.source, r.target) == ("b0", "b4")]
        only = make_consistent(plan, alone, Alone())
        assert only.results == tuple(alone)
        assert (len(only.before), len(only.notes)) == (0, 1)
    finally:
        path.write_bytes(whole)
