"""What a collection holds, what its runs are defined by, and how long they will take."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from collecting import CONFIG, plan_of, touch
from kfmaps._arrays import InvalidInput
from kfmaps._texts import format_seconds
from kfmaps.batch.cache import file_digest
from kfmaps.batch.jobs import WorkerPool
from kfmaps.batch.layout import Pair, find_collection, natural_key, read_pairs
from kfmaps.batch.plan import graph_pairs
from kfmaps.batch.progress import WorkLeft
from kfmaps.batch.results import read_result
from kfmaps.batch.run_spec import RunSpec, claim, read_run_spec
from kfmaps.cli.options import line_numbers
from kfmaps.kernels.kernels import Linear


@pytest.mark.parametrize("sub", ["", "off", "shapes"])
def test_remeshed_layouts(tmp_path: Path, sub: str) -> None:
    for name in ("tr_reg_10", "tr_reg_2"):
        touch(tmp_path / sub / f"{name}.off")
        touch(tmp_path / "corres" / f"{name}.vts")
        touch(tmp_path / "corres" / f"{name}.sym.vts")
    touch(tmp_path / "corres" / "sampleID.vts")
    touch(tmp_path / "landmarks" / "tr_reg_2.txt")
    touch(tmp_path / "test_pairs.txt", "tr_reg_2 tr_reg_10\n\n# a remark\ntr_reg_10.off,tr_reg_2\n")
    found = find_collection(tmp_path)
    assert list(found.shapes) == ["tr_reg_2", "tr_reg_10"]
    assert set(found.truth) == set(found.mirrored) == set(found.shapes)
    assert found.mirrored["tr_reg_2"].name == "tr_reg_2.sym.vts"
    assert set(found.landmarks) == {"tr_reg_2"}
    assert read_pairs(found) == [Pair("tr_reg_2", "tr_reg_10"), Pair("tr_reg_10", "tr_reg_2")]


def test_shrec_layout_has_pairs_of_its_own(tmp_path: Path) -> None:
    for name in ("1", "2", "10", "a_b"):
        touch(tmp_path / "off" / f"{name}.off")
    for name in ("10_1", "2_10", "a_b_2", "7_1"):
        touch(tmp_path / "corres" / f"{name}.map")
    found = find_collection(tmp_path)
    assert read_pairs(found) == [Pair("2", "10"), Pair("10", "1"), Pair("a_b", "2")]


def test_a_folder_that_is_no_collection_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="no folder"):
        find_collection(tmp_path / "missing")
    with pytest.raises(InvalidInput, match="off/"):
        find_collection(tmp_path)
    touch(tmp_path / "a.off")
    touch(tmp_path / "off" / "b.off")
    assert list(find_collection(tmp_path).shapes) == ["a"]  # the top folder wins
    touch(tmp_path / "a.ply")
    with pytest.raises(InvalidInput, match=r"a\.off and a\.ply"):
        find_collection(tmp_path)


def test_choices_of_pairs(tmp_path: Path) -> None:
    for name in ("a", "b", "c"):
        touch(tmp_path / f"{name}.off")
    found = find_collection(tmp_path)
    pool, spec = WorkerPool(), RunSpec(CONFIG)  # a pool that is not started
    both = graph_pairs(found, spec, tmp_path / "out", "both", pool)
    assert len(set(both)) == len(both) == 6
    assert graph_pairs(found, spec, tmp_path / "out", "star:b.off", pool) == [Pair("b", "a"), Pair("b", "c")]
    file = touch(tmp_path / "list.txt", "a b\na b\nb a")
    assert read_pairs(found, file) == [Pair("a", "b"), Pair("b", "a")]


def test_bad_choices_of_pairs(tmp_path: Path) -> None:
    touch(tmp_path / "a.off")
    found, spec = find_collection(tmp_path), RunSpec(CONFIG)
    for file, message in ((None, "test_pairs.txt"), (tmp_path / "none.txt", "nothing there")):
        with pytest.raises(InvalidInput, match=message):
            read_pairs(found, file)
    with pytest.raises(InvalidInput, match="two shapes"):
        graph_pairs(found, spec, tmp_path / "out", "both", WorkerPool())
    touch(tmp_path / "b.off")
    found = find_collection(tmp_path)
    with pytest.raises(InvalidInput, match="'x'"):
        graph_pairs(found, spec, tmp_path / "out", "star:x", WorkerPool())
    lists = {"a": "line 1.*got 1", "\na b c": "line 2.*got 3", "a x": "line 1.*'x'", "# no\n": "no pairs"}
    for text, message in lists.items():
        with pytest.raises(InvalidInput, match=message):
            read_pairs(found, touch(tmp_path / "list.txt", text))


def test_keys_tell_pairs_apart(tmp_path: Path) -> None:
    assert Pair("a", "b").key == "a-b"
    assert Pair("a-b", "c").key != Pair("a", "b-c").key
    for name in ("a", "A", "b"):
        touch(tmp_path / f"{name}.off")
    if len(list(tmp_path.iterdir())) == 3:
        with pytest.raises(InvalidInput, match="tell pairs apart"):
            plan_of(tmp_path, tmp_path / "out")


def test_digest_follows_what_matters() -> None:
    base = RunSpec(CONFIG)
    for other in (
        RunSpec(replace(CONFIG, kernel=Linear())),
        RunSpec(CONFIG, seed=1),
        RunSpec(CONFIG, identity=True),
        RunSpec(CONFIG, landmark_lines=(3,)),
        RunSpec(CONFIG, landmark_files=False),
    ):
        assert other.digest != base.digest
    assert RunSpec(replace(CONFIG, threads=3)).digest == base.digest


def test_other_settings_are_refused_by_name(tmp_path: Path) -> None:
    claim(tmp_path, RunSpec(CONFIG))
    claim(tmp_path, RunSpec(replace(CONFIG, threads=2)))
    changed = replace(CONFIG, weights=replace(CONFIG.weights, laplacian=2.0))
    with pytest.raises(InvalidInput, match=r"config\.weights\.laplacian 1\.0, now 2\.0.*another output folder"):
        claim(tmp_path, RunSpec(changed))
    (tmp_path / "settings.json").write_text("{")
    with pytest.raises(InvalidInput, match="Remove it"):
        claim(tmp_path, RunSpec(CONFIG))


def test_landmark_lines_are_checked() -> None:
    with pytest.raises(InvalidInput, match="--landmarks"):
        RunSpec(CONFIG, landmark_lines=(2, 2))
    with pytest.raises(InvalidInput, match="--landmarks"):
        line_numbers("0,2", "--landmarks")


def left(
    finished: list[tuple[float, float]], sizes: list[float], start: dict[int, float], workers: int
) -> float | None:
    return WorkLeft(dict(enumerate(sizes)), finished=finished).remaining(start, workers)


def test_remaining_time_is_exact_for_even_work_and_follows_sizes() -> None:
    """Four times the size and fixed part takes four times as long; earlier runs count until something is measured."""
    assert left([], [], {}, 4) == 0
    assert left([], [1000], {}, 4) is None
    assert left([(1000, 3.0), (1000, 5.0)], [1000] * 8, {}, 4) == pytest.approx(8)
    assert left([(1000, 4.0)], [1000] * 5, {0: 1.0, 1: 1.5}, 2) == pytest.approx(10.5)
    assert left([(1000, 4.0)], [1000], {0: 3.9}, 4) == pytest.approx(2)  # it may be a slow one
    assert left([(2000, 5.0)], [32000], {}, 1) == pytest.approx(20)
    work = WorkLeft({0: 2000, 1: 2000, 2: 2000}, before=[(2000, 7.0)])
    assert work.remaining({}, 1) == pytest.approx(21)
    work.end(0)
    assert work.remaining({}, 1) == pytest.approx(14)
    work.end(1, 3.0)
    assert work.remaining({}, 1) == pytest.approx(3)
    assert left([(2000, 4.0), (2000, 0.0)], [2000], {}, 1) == pytest.approx(2)  # the second came from the cache


def simulated(seconds: np.ndarray, sizes: np.ndarray, workers: int) -> list[tuple[int, float | None, float]]:
    """Of a run of invented durations, after each pair: how many are done, the estimate, and what the rest takes."""
    work, clock, calls = WorkLeft(dict(enumerate(sizes.tolist()))), 0.0, []
    running = [(seconds[i], i, 0.0) for i in range(workers)]
    for ended in range(len(seconds)):
        running.sort()
        clock, number, _ = running.pop(0)
        work.end(number, seconds[number])
        start = {i: clock - begin for _, i, begin in running}
        calls.append((ended + 1, work.remaining(start, workers), clock))
        if ended + workers < len(seconds):
            running.append((clock + seconds[ended + workers], ended + workers, clock))
    return [(done, estimate, clock - now) for done, estimate, now in calls]


@pytest.mark.parametrize("order", ["random", "small first", "large first"])
@pytest.mark.parametrize("workers", [1, 4])
def test_remaining_time_is_within_a_factor_of_one_and_a_half(order: str, workers: int) -> None:
    """On shapes of 4,000 to 200,000 vertices, whose times scatter, after 8 to 90 of 100 pairs."""
    for seed in range(20):
        rng = np.random.default_rng(seed)
        sizes = np.exp(rng.uniform(np.log(4e3), np.log(2e5), 100))
        sizes = sizes if order == "random" else np.sort(sizes)[:: 1 if order == "small first" else -1]
        seconds = 3.5e-4 * (sizes + 7000) * rng.lognormal(0, 0.15, 100)
        for done, estimate, rest in simulated(seconds, sizes, workers):
            if 8 <= done <= 90:
                assert estimate is not None
                assert rest / 1.5 < estimate < rest * 1.5, (seed, done, estimate, rest)


def test_durations_and_names_for_people() -> None:
    assert sorted(["s10", "s9", "s1a", "10", "9"], key=natural_key) == ["9", "10", "s1a", "s9", "s10"]
    assert [format_seconds(s) for s in (7.4, 99, 130, 12000)] == ["7 s", "99 s", "2 min", "3 h 20 min"]


def test_long_names_have_files_all_the_same(tmp_path: Path) -> None:
    """Two names of 140 letters make more than a file's name can hold; so do 70 letters of four bytes."""
    for letter in ("a", "𝔞"):
        long = letter * (140 if letter == "a" else 55)
        pairs = [Pair(long + x, long + y) for x in "xyz" for y in "xyz" if x != y]
        keys = {pair.key for pair in pairs}
        assert len(keys) == len(pairs)
        for key in keys:
            touch(tmp_path / f"{key}.json")
            assert key.startswith(letter * 20)
    assert Pair("a" * 99, "b" * 99).key == f"{'a' * 99}-{'b' * 99}"
    assert Pair("a" * 100, "b" * 100).key != f"{'a' * 100}-{'b' * 100}"


def test_numbers_beside_a_gltf_belong_to_it(tmp_path: Path) -> None:
    touch(tmp_path / "a.gltf", '{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 3, "uri": "a%20b.bin"}]}')
    seen = set()
    for content in ("123", "124", "123"):
        touch(tmp_path / "a b.bin", content)
        seen.add(file_digest(tmp_path / "a.gltf"))
    assert len(seen) == 2
    (tmp_path / "a b.bin").unlink()
    assert file_digest(tmp_path / "a.gltf") not in seen


@pytest.mark.parametrize("deep", ["[" * 100_000, '{"a":' * 100_000])
def test_deep_results_and_settings(tmp_path: Path, deep: str) -> None:
    assert read_result(touch(tmp_path / "r.json", deep)) is None
    touch(tmp_path / "settings.json", deep)
    with pytest.raises(InvalidInput, match="settings of a run"):
        read_run_spec(tmp_path)
