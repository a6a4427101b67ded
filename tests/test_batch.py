"""Prepared shapes and matched pairs of a collection: once each, and equal to single matches."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from collecting import CONFIG, LANDMARKS, done, plan_of, registered, touch, write_collection
from conftest import blob
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.batch import cache, work
from kfmaps.batch.cache import _samples_path, cached_samples, file_digest, load_record, save_record, shape_key
from kfmaps.batch.layout import Pair, find_collection
from kfmaps.batch.plan import make_plan
from kfmaps.batch.results import summarize
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.work import count_attempts, map_path, match_pair, prepare_shape
from kfmaps.config import NystromConfig, Search
from kfmaps.evaluation import Truth, assess, assess_if_reached
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import load_map, read_mesh, read_vertex_numbers, write_mesh, write_vertex_numbers
from kfmaps.kernels.kernels import Linear
from kfmaps.matching.match import match
from kfmaps.matching.search import scoring_samples
from kfmaps.shape import Shape, prepare


def test_prepared_shapes_come_back_as_they_were(tmp_path: Path) -> None:
    config = replace(CONFIG, descriptors=replace(CONFIG.descriptors, shot=True, shot_radius=0.4))
    shape = prepare(blob(200), config, name="b")
    path = tmp_path / "entry.npz"
    assert load_record(path, Shape) is None
    save_record(path, shape)
    back = load_record(path, Shape)
    assert back is not None
    known, kept = _arrays_of(shape), _arrays_of(back)
    assert kept.keys() == known.keys()
    for name, value in known.items():
        np.testing.assert_array_equal(kept[name], value, err_msg=name)
    path.write_bytes(path.read_bytes()[:-100])
    assert load_record(path, Shape) is None


def _arrays_of(record: Any, before: str = "") -> dict[str, Any]:
    """All that is in a record and in those in it."""
    found: dict[str, Any] = {}
    for f in fields(record):
        value = getattr(record, f.name)
        found |= _arrays_of(value, f"{before}{f.name}.") if is_dataclass(value) else {before + f.name: value}
    return found


def test_cached_samples_change_no_bit(tmp_path: Path) -> None:
    config = replace(CONFIG, search=Search(candidates=1, n_sign_functions=2), threads=1)
    a, b = (prepare(registered(i, 300), config, name=str(i)) for i in (0, 1))
    entry = tmp_path / "a.npz"
    first = cached_samples(a, entry, 3)
    assert _samples_path(entry, 3).exists()
    assert not _samples_path(entry, 4).exists()
    read = cached_samples(a, entry, 3)
    assert read is not first
    known, kept = _arrays_of(first), _arrays_of(read)
    assert kept.keys() == known.keys()
    for name, value in known.items():
        np.testing.assert_array_equal(kept[name], value, err_msg=name)
    for landmarks in (None, np.array([[5, 5], [40, 40], [200, 200]])):
        plain, quick = (
            match(a, b, config, landmarks=landmarks, rng=3, shape_samples=samples)
            for samples in (None, (read, scoring_samples(b, 3)))
        )
        np.testing.assert_array_equal(quick.target_to_source, plain.target_to_source)
        assert quick.score.scores == plain.score.scores
    data = _samples_path(entry, 3).read_bytes()
    _samples_path(entry, 3).write_bytes(data[: len(data) // 2])
    assert load_record(_samples_path(entry, 3), type(first)) is None


def test_far_mirrored_points_are_sampled(folder: Path) -> None:
    source = read_mesh(folder / "b0.off")
    rng = np.random.default_rng(0)
    points, true, swapped = (rng.permutation(200) for _ in range(3))
    truth = Truth(np.arange(200), true, swapped)
    every, some = (assess(source, points, truth, mirrored=most) for most in (None, 60))
    assert every.mirrored is not None
    assert some.mirrored is not None
    assert every.errors.mean == some.errors.mean
    assert len(some.mirrored.errors) == 50
    np.testing.assert_allclose(some.mirrored.errors, every.mirrored.errors[::4])


def test_a_truth_that_a_new_map_does_not_reach_gives_no_errors(folder: Path) -> None:
    source, ends = read_mesh(folder / "b0.off"), np.arange(50)
    points = np.where(np.arange(200) < 100, np.arange(200), -1)
    for truth in (Truth(ends, ends + 100), Truth(ends, ends, ends + 100)):
        with pytest.warns(KfmapsWarning, match="no point of the truth"):
            assert assess_if_reached(source, points, truth) is None
    with pytest.warns(KfmapsWarning, match="no point of the truth"):  # of those that are drawn
        assert assess_if_reached(source, points, Truth(ends, ends, ends + 100 - (ends == 1)), mirrored=25) is None
    found = assess_if_reached(source, points, Truth(ends, ends, ends + 60))
    assert found is not None
    assert found.errors.mean == 0.0


def test_entries_depend_on_content_and_on_what_prepares(tmp_path: Path) -> None:
    a, b = touch(tmp_path / "a.off", "one"), touch(tmp_path / "b.off", "two")
    key = shape_key(file_digest(a), ".off", CONFIG)
    larger = replace(CONFIG, refinement=None, descriptors=replace(CONFIG.descriptors, n_eigenfunctions=50))
    local = replace(CONFIG, descriptors=replace(CONFIG.descriptors, shot=True))
    cotangent = replace(CONFIG, basis=replace(CONFIG.basis, laplacian="cotangent"))
    for config in (larger, local, cotangent):
        assert shape_key(file_digest(a), ".off", config) != key
    assert shape_key(file_digest(b), ".off", CONFIG) != key
    assert shape_key(file_digest(a), ".obj", CONFIG) != key
    assert shape_key(file_digest(a), ".off", replace(CONFIG, kernel=Linear(), bandwidth_scale=1.0)) == key


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_collection(tmp_path_factory.mktemp("shapes"))


def test_a_pair_equals_a_single_match(folder: Path, tmp_path: Path) -> None:
    config = replace(CONFIG, nystrom=NystromConfig(samples=30, sampling="uniform"), refinement=None)
    results = done(plan_of(folder, tmp_path, config, seed=3))
    assert [r.status for r in results] == ["done"] * 6
    assert all(sum(r.seconds.values()) <= 2 * r.seconds["total"] for r in results)
    for result in results[:2]:
        source, target = (read_mesh(folder / f"{name}.off") for name in (result.source, result.target))
        truth = [read_vertex_numbers(folder / "corres" / f"{name}.vts") for name in (result.source, result.target)]
        landmarks = np.stack(truth, axis=1)[np.array(LANDMARKS) - 1]
        found = match(source, target, config, landmarks=landmarks, rng=3)
        errors = geodesic_errors(source, found.target_to_source[truth[1]], truth[0])
        assert result.error_mean == pytest.approx(errors.mean(), rel=1e-9)
        assert result.error_max == pytest.approx(errors.max(), rel=1e-9)
        assert result.curve[20] == pytest.approx((errors <= 0.05).mean())
        assert result.landmarks == 4
        saved = load_map(map_path(tmp_path, Pair(result.source, result.target).key))
        np.testing.assert_array_equal(saved.target_to_source, found.target_to_source)
        assert saved.functional_map is not None
        np.testing.assert_array_equal(saved.functional_map, found.functional_map)
        other = match(source, target, config, landmarks=landmarks, rng=4).functional_map
        assert np.abs(saved.functional_map - other).max() > 1e-9  # the seed counts
        np.testing.assert_array_equal(saved.landmarks, landmarks)
    assert summarize(results)["error_mean"] == pytest.approx(np.mean([float(r.error_mean or 0) for r in results]))


def test_nothing_done_is_done_again(folder: Path, tmp_path: Path) -> None:
    plan = plan_of(folder, tmp_path)
    first = done(plan)
    before = {p: p.stat().st_mtime_ns for p in tmp_path.rglob("*") if p.is_file()}
    assert done(plan) == first
    with pytest.raises(InvalidInput, match="another output folder"):
        plan_of(folder, tmp_path, seed=9)
    assert plan_of(folder, tmp_path).todo == ()
    assert {p: p.stat().st_mtime_ns for p in tmp_path.rglob("*") if p.is_file()} == before


def test_changed_files_are_done_again(tmp_path: Path) -> None:
    folder, out = write_collection(tmp_path / "c"), tmp_path / "out"
    done(plan_of(folder, out))
    mesh = read_mesh(folder / "b1.off")
    write_mesh(folder / "b1.off", Mesh(mesh.vertices * 1.5, mesh.faces), force=True)
    plan = plan_of(folder, out)
    assert plan.changed == len(plan.todo) == 4
    assert len(plan.results) == 2
    write_vertex_numbers(folder / "corres" / "b0.vts", np.roll(np.arange(200), 1), force=True)
    assert len(plan_of(folder, out).todo) == 6


def test_a_bad_shape_fails_its_pairs_alone_and_can_be_retried(tmp_path: Path) -> None:
    folder, out = write_collection(tmp_path / "c"), tmp_path / "out"
    good = (folder / "b1.off").read_bytes()
    touch(out / "maps" / "b0-b1.npz", "of an earlier mesh")
    rows = "\n".join(" ".join(map(str, row)) for row in read_mesh(folder / "b1.off").vertices.tolist())
    touch(folder / "b1.off", f"OFF\n200 0 0\n{rows}\n")  # a mesh that lost its faces is no point cloud
    results = done(plan_of(folder, out))
    assert sorted(r.status for r in results) == ["done"] * 2 + ["failed"] * 4
    assert {p.stem for p in (out / "maps").iterdir()} == {"b0-b2", "b2-b0"}
    failed = [r for r in results if r.status == "failed"]
    assert all("b1" in (r.source, r.target) and "shape b1 could not be prepared" in r.reason for r in failed)
    assert all("faces" in r.reason for r in failed)
    assert plan_of(folder, out).todo == ()
    assert len(plan_of(folder, out, retry_failed=True).todo) == 4
    (folder / "b1.off").write_bytes(good)
    assert len(plan_of(folder, out).todo) == 4
    assert {r.status for r in done(plan_of(folder, out))} == {"done"}


def test_a_file_that_cannot_be_read_fails_its_pairs_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = write_collection(tmp_path / "c")
    digest = cache.file_digest

    def denied(path: str | Path) -> str:
        if Path(path).name == "b1.off":
            raise PermissionError(13, "Permission denied", str(path))
        return digest(path)

    for module in ("cache", "plan", "work"):
        monkeypatch.setattr(f"kfmaps.batch.{module}.file_digest", denied)
    results = done(plan_of(folder, tmp_path / "out"))
    failed = [r for r in results if r.status == "failed"]
    assert len(results) - len(failed) == 2
    assert all("b1" in (r.source, r.target) and "Permission denied" in r.reason for r in failed)


def test_a_defect_is_recorded_with_its_type(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = plan_of(folder, tmp_path)
    prepared = [prepare_shape(t) for t in (plan.todo[0].source, plan.todo[0].target)]

    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("oh")

    monkeypatch.setattr("kfmaps.batch.work.match", broken)
    result = match_pair((plan.todo[0], prepared[0], prepared[1]))
    assert (result.status, result.reason) == ("failed", "ZeroDivisionError: oh")
    assert not map_path(tmp_path, plan.todo[0].pair.key).exists()


def test_all_work_is_done_with_one_blas_thread(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever the environment of a worker says, and on the workers of a foreign scheduler too."""
    threads: dict[str, set[int]] = {}

    def watched(name: str) -> None:
        function = getattr(work, name)

        def called(*arguments: Any, **options: Any) -> Any:
            threads[name] = {pool["num_threads"] for pool in threadpool_info()}
            assert arguments[-1].threads == 1
            return function(*arguments, **options)

        monkeypatch.setattr(work, name, called)

    watched("prepare")
    watched("match")
    with threadpool_limits(4):
        assert done(plan_of(folder, tmp_path))[0].status == "done"
    assert threads == {"prepare": {1}, "match": {1}}


def test_a_shape_that_changes_under_way_is_refused(tmp_path: Path) -> None:
    folder = write_collection(tmp_path / "c")
    plan = plan_of(folder, tmp_path / "out")
    task = plan.todo[0].source
    write_mesh(task.path, blob(210), force=True)
    assert "changed" in prepare_shape(task).reason
    assert load_record(task.entry, Shape) is None


def test_attempts_are_counted_across_kills(folder: Path, tmp_path: Path) -> None:
    """A worker that died left its note and no result; the next one takes the pair up as the second attempt."""
    plan = plan_of(folder, tmp_path)
    task = plan.todo[0]
    touch(tmp_path / "attempts" / f"{task.pair.key}.1", "{}")
    result = match_pair((task, prepare_shape(task.source), prepare_shape(task.target)))
    assert (result.status, result.attempts) == ("done", 2)
    assert count_attempts(tmp_path, task.pair.key) == 2
    assert count_attempts(tmp_path, task.source.key) == 1


def test_mirrored_truth(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kfmaps.batch.work._MIRRORED_POINTS", 10_000)  # all points, so that the means can be equal
    means = []
    for swap in (False, True):
        folder = write_collection(tmp_path / f"c{swap}", 2)
        truth = read_vertex_numbers(folder / "corres" / "b1.vts")
        other = np.roll(truth, 7)
        write_vertex_numbers(folder / "corres" / "b1.sym.vts", truth if swap else other)
        write_vertex_numbers(folder / "corres" / "b1.vts", other if swap else truth, force=True)
        landmark_vertices = [read_vertex_numbers(folder / "corres" / "b0.vts"), truth]
        for name, numbers in zip(("b0", "b1"), landmark_vertices, strict=True):
            path = touch(folder / "landmarks" / f"{name}.vts")
            write_vertex_numbers(path, numbers[:5], force=True)
        result = done(plan_of(folder, tmp_path / f"o{swap}", lines=()))[0]
        assert result.landmarks == 5
        means.append((result.error_mean, result.mirrored_mean))
    assert means[0] == pytest.approx(means[1][::-1])
    assert means[0][0] < means[0][1]


def test_identity_and_pair_truth_agree_with_lists(tmp_path: Path) -> None:
    means = []
    for way in ("lists", "map", "identity"):
        folder = tmp_path / way
        folder.mkdir()
        for i in range(2):
            write_mesh(folder / f"b{i}.off", Mesh(blob(200).vertices * [1, 1 + 0.2 * i, 1], blob(200).faces))
        numbers = "\n".join(str(i + 1) for i in range(200))
        if way == "lists":
            touch(folder / "corres" / "b0.vts", numbers)
            touch(folder / "corres" / "b1.vts", numbers)
        if way == "map":
            touch(folder / "corres" / "b0_b1.map", numbers)
        found = find_collection(folder)
        settings = RunSpec(CONFIG, landmark_lines=LANDMARKS, identity=way == "identity")
        means.append(done(make_plan(found, [Pair("b0", "b1")], settings, tmp_path / f"o{way}"))[0].error_mean)
    assert means[0] == means[1] == means[2]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda f: touch(f / "corres" / "b1.vts", "1\n2\n"), "files of equal length"),
        (lambda f: touch(f / "corres" / "b1.vts", "900\n" * 200), "from 0 to 199"),
        (lambda f: (f / "corres" / "b1.vts").unlink(), "none for this pair"),
        (lambda f: [touch(f / "corres" / f"b{i}.vts", "1\n2\n") for i in range(2)], "line 170 of 2"),
    ],
)
def test_bad_truth_is_a_recorded_failure(tmp_path: Path, change, message: str) -> None:
    folder = write_collection(tmp_path / "c", 2)
    change(folder)
    result = done(plan_of(folder, tmp_path / "out"))[0]
    assert result.status == "failed"
    assert message in result.reason
