"""Landmarks, vertex lists, per-vertex values, and carrying them over a map."""

from __future__ import annotations

import io
import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from conftest import refusal
from kfmaps import Match
from kfmaps._arrays import InvalidInput
from kfmaps.io import (
    Values,
    read_landmarks,
    read_values,
    read_vertex_numbers,
    transfer,
    write_landmarks,
    write_values,
    write_vertex_numbers,
)


def test_landmarks(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("# source target\n\n 3 4 # the nose\r\n0\t17\n")
    np.testing.assert_array_equal(read_landmarks(path), [[3, 4], [0, 17]])
    assert read_landmarks(path).dtype == np.int64
    with pytest.raises(InvalidInput, match=r"line 4: expected vertex numbers from 1 on, got 0 17.*counted from 0"):
        read_landmarks(path, one_based=True)
    path.write_text("3 4")
    np.testing.assert_array_equal(read_landmarks(path, one_based=True), [[2, 3]])


@pytest.mark.parametrize(("suffix", "first"), [(".txt", 0), (".vts", 1)])
def test_landmarks_round_trip(tmp_path: Path, suffix: str, first: int) -> None:
    path, pairs = tmp_path / f"a{suffix}", np.random.default_rng(0).integers(0, 9999, (7, 2))
    write_landmarks(path, pairs)
    np.testing.assert_array_equal(read_landmarks(path), pairs)
    np.testing.assert_array_equal(read_landmarks(path, one_based=False), pairs + first)
    with pytest.raises(InvalidInput, match="--force"):
        write_landmarks(path, pairs)
    with pytest.raises(InvalidInput, match="landmarks"):
        write_landmarks(tmp_path / "b.txt", pairs[:, 0])


@pytest.mark.parametrize(
    ("content", "part"),
    [
        (b"", "an empty file"),
        (b"# nothing\n", "no numbers"),
        (b"1 2\n3\n", "line 2: expected two whole numbers a line, source and target, got 1 numbers"),
        (b"1 2 3\n", "got 3 numbers"),
        (b"1 2\n1,2\n", "line 2: expected numbers, got '1,2'"),
        (b"1 2.5\n", "2.5"),
        (b"1 nan\n", "nan"),
        (b"1 1e300\n", "1e+300"),
        (b"1 -2\n", "line 1: expected vertex numbers from 0 on, got 1 -2"),
        (b"\xff\xfe1\0 \0", "binary"),
    ],
)
def test_bad_landmarks(tmp_path: Path, content: bytes, part: str) -> None:
    assert part in refusal(read_landmarks, tmp_path / "a.txt", content)


@pytest.mark.parametrize(("suffix", "one_based"), [(".vts", True), (".txt", False)])
def test_vertex_numbers(tmp_path: Path, suffix: str, one_based: bool) -> None:
    path = tmp_path / f"a{suffix}"
    write_vertex_numbers(path, np.array([4, 0, 2]))
    assert path.read_text().split() == [str(x + one_based) for x in (4, 0, 2)]
    np.testing.assert_array_equal(read_vertex_numbers(path), [4, 0, 2])
    np.testing.assert_array_equal(read_vertex_numbers(path, one_based=False), np.array([4, 0, 2]) + one_based)
    path.write_text("5\n1\n")
    np.testing.assert_array_equal(read_vertex_numbers(path, one_based=True), [4, 0])


def test_transfer() -> None:
    values = np.arange(12.0).reshape(4, 3)
    np.testing.assert_array_equal(transfer(values, [3, 3, 0]), values[[3, 3, 0]])
    np.testing.assert_array_equal(transfer(["a", "b"], Match(np.array([1, 0, 1]))), ["b", "a", "b"])
    assert transfer(np.array([1, 2], dtype=np.int8), [0]).dtype == np.int8
    for values_s, points, part in ((values, [4], "got 4"), (values, [[0]], "shape"), (3.0, [0], "single value")):
        with pytest.raises(InvalidInput, match=part):
            transfer(values_s, points)


NUMBERS = st.floats(width=64) | st.integers(-(10**6), 10**6).map(float)


@given(
    arrays(np.float64, array_shapes(min_dims=1, max_dims=2, max_side=6), elements=NUMBERS),
    st.sampled_from([".npy", ".csv", ".txt"]),
)
@settings(max_examples=100, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_numbers_come_back_to_the_last_bit(tmp_path: Path, array: np.ndarray, suffix: str) -> None:
    write_values(tmp_path / f"a{suffix}", Values(array), force=True)
    found = read_values(tmp_path / f"a{suffix}").array
    # a text cannot tell one column from a list
    np.testing.assert_array_equal(
        found, array if suffix == ".npy" or array.shape[-1] > 1 or array.ndim == 1 else array[:, 0]
    )


def test_whole_numbers_stay_whole(tmp_path: Path) -> None:
    for suffix in (".csv", ".txt", ".npy"):
        write_values(tmp_path / f"a{suffix}", Values(np.array([3, -1, 2**40])))
        found = read_values(tmp_path / f"a{suffix}").array
        assert found.dtype == np.int64
        np.testing.assert_array_equal(found, [3, -1, 2**40])
    write_values(tmp_path / "b.txt", Values(np.array([True, False])))
    np.testing.assert_array_equal(read_values(tmp_path / "b.txt").array, [1, 0])


def test_labels_and_headers(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("# parts\nleft arm\n leg \n\nhead, größe\n", encoding="utf-8")
    labels = read_values(tmp_path / "a.txt").array
    assert labels.tolist() == ["left arm", "leg", "head, größe"]
    write_values(tmp_path / "b.csv", Values(labels))
    assert read_values(tmp_path / "b.csv").array.tolist() == labels.tolist()
    write_values(tmp_path / "b.txt", Values(labels))
    assert (tmp_path / "b.txt").read_text(encoding="utf-8") == "left arm\nleg\nhead, größe\n"

    (tmp_path / "c.csv").write_text('\ufeff"x, y", z\n1, 2.5\n3,4\n', encoding="utf-8")
    found = read_values(tmp_path / "c.csv")
    assert found.columns == ("x, y", "z")
    np.testing.assert_array_equal(found.array, [[1, 2.5], [3, 4]])
    write_values(tmp_path / "d.csv", found)
    assert (tmp_path / "d.csv").read_text() == '"x, y",z\n1.0,2.5\n3.0,4.0\n'

    (tmp_path / "e.csv").write_text("1,arm\n2,leg\n")
    assert read_values(tmp_path / "e.csv").array.tolist() == [["1", "arm"], ["2", "leg"]]
    (tmp_path / "g.txt").write_text("nan\n1e999\n-.5")
    np.testing.assert_array_equal(read_values(tmp_path / "g.txt").array, [np.nan, np.inf, -0.5])
    (tmp_path / "f.csv").write_text("7\n")
    assert read_values(tmp_path / "f.csv").array.tolist() == [7]


def npy(array: np.ndarray, pickled: bool = False) -> bytes:
    file = io.BytesIO()
    np.save(file, array, allow_pickle=pickled)
    return file.getvalue()


def lying_npy() -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(file, {"descr": "<f8", "fortran_order": False, "shape": (2**40,)})
    return file.getvalue()


@pytest.mark.parametrize(
    ("suffix", "content", "part"),
    [
        (".dat", b"1", "one of .npy .csv .txt"),
        (".txt", b"", "an empty file"),
        (".txt", b"\n# x\n", "a row for each source vertex, got none"),
        (".txt", b"1 2\n3\n", "line 2: expected 2 values as before, got 1"),
        (".txt", b"1\n2\nx\n", "line 3: expected numbers as before, got text"),
        (".txt", b"x\n\n2\n", "line 3: expected text as before, got numbers"),
        (".csv", b"a,b\n1,2\n3,x\n", "line 3: expected numbers as before"),
        (".csv", b"1,2\n3\n", "line 2: expected 2 values"),
        (".csv", b'"a\n', "comma-separated values"),
        (".txt", b"\xff\xfe", "UTF-8"),
        (".npy", npy(np.arange(9))[:-1], "complete .npy"),
        (".npy", b"hello", "complete .npy"),
        (".npy", npy(np.array([1, "a"], dtype=object), True), "complete .npy"),
        (".npy", pickle.dumps([1]), "complete .npy"),
        (".npy", npy(np.array(3.0)), "a row of numbers"),
        (".npy", npy(np.zeros(3, dtype="M8[s]")), "a row of numbers"),
        (".npy", lying_npy(), "expected data for shape"),
    ],
)
def test_bad_values(tmp_path: Path, suffix: str, content: bytes, part: str) -> None:
    assert part in refusal(read_values, tmp_path / f"a{suffix}", content)


@pytest.mark.parametrize(
    ("name", "array", "part"),
    [
        ("a.dat", np.zeros(3), "one of"),
        ("a.txt", np.zeros((3, 2, 2)), "npy instead"),
        ("a.csv", np.zeros(3, dtype=complex), "npy instead"),
        ("none/a.csv", np.zeros(3), "existing folder"),
    ],
)
def test_values_that_cannot_be_written(tmp_path: Path, name: str, array: np.ndarray, part: str) -> None:
    with pytest.raises(InvalidInput, match=part):
        write_values(tmp_path / name, Values(array))
    assert not list(tmp_path.iterdir())
    write_values(tmp_path / "a.npy", Values(array))
    np.testing.assert_array_equal(read_values(tmp_path / "a.npy").array, array)


@pytest.mark.parametrize("suffix", [".csv", ".txt", ".npy"])
@pytest.mark.parametrize(
    "labels",
    [
        [2**60 + 1, -(2**63), 2**63 - 1],
        [2**64 - 1, 0, 2**63],
        [10**30 + 1, 7, -(10**25) - 1],
        [10**500, 1, 2],
    ],
)
def test_whole_numbers_keep_every_digit(tmp_path: Path, suffix: str, labels: list[int]) -> None:
    """A label that is carried by the identity is the label that it was, whatever its length."""
    if suffix == ".npy":
        if abs(max(labels, key=abs)) >= 2**64:
            pytest.skip("no such numbers in an array")
        np.save(tmp_path / "a.npy", np.array(labels, dtype=np.int64 if min(labels) < 0 else np.uint64))
    else:
        (tmp_path / f"a{suffix}").write_text("".join(f"{label}\n" for label in labels))
    found = read_values(tmp_path / f"a{suffix}")
    write_values(tmp_path / f"b{suffix}", Values(transfer(found.array, np.arange(3)), found.columns))
    again = read_values(tmp_path / f"b{suffix}").array
    assert [int(label) for label in again.tolist()] == labels


def test_a_long_label_beside_a_fraction_is_kept(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(f"{2**60 + 1},0.5\n{2**60},0.25\n")
    assert read_values(tmp_path / "a.csv").array.tolist() == [[str(2**60 + 1), "0.5"], [str(2**60), "0.25"]]
    (tmp_path / "a.csv").write_text(f"{2**60},0.5\n100000000000000000000,0.25\n")  # both are exact
    assert read_values(tmp_path / "a.csv").array.tolist() == [[2.0**60, 0.5], [1e20, 0.25]]


@pytest.mark.parametrize("suffix", [".txt", ".csv"])
def test_one_long_label_does_not_take_its_room_for_all(tmp_path: Path, suffix: str) -> None:
    """An array of texts gives each the room of the longest: a file of a megabyte would take gigabytes."""
    path = tmp_path / f"a{suffix}"
    path.write_text("arm\n" * 1000 + "x" * 100_000 + "\n")
    output = r"labels of at most 67,041 letters each, for there are 1,001, got one of 100,000 letters \('xxx"
    with pytest.raises(InvalidInput, match=output):
        read_values(path)
    path.write_text("arm\n" * 1000 + "x" * 1000 + "\n")
    assert read_values(path).array[1000] == "x" * 1000
