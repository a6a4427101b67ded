"""Map files: all formats, and everything that is no map."""

from __future__ import annotations

import io
import pickle
import tracemalloc
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from kfmaps._arrays import InvalidInput
from kfmaps.io import MapFile, check_map, load_map, save_map


def example(seed: int = 0, n_t: int = 50) -> MapFile:
    rng = np.random.default_rng(seed)
    return MapFile(
        rng.integers(0, 40, n_t),
        rng.normal(size=(6, 5)),
        np.sort(rng.random(5)),
        np.sort(rng.random(6)),
        '{"kernel": "gaußian γ"}',
        {
            "source": "a/b ü.off",
            "runners_up": rng.integers(0, 40, (1, n_t)),
            "confidence": np.array(0.25),
            "local_confidence": np.append(rng.random(n_t - 1), np.nan),
            "landmarks": rng.integers(0, min(40, n_t), (3, 2)),
            "empty": "",
        },
    )


def same(a: MapFile, b: MapFile) -> None:
    for name in ("target_to_source", "functional_map", "eigenvalues_s", "eigenvalues_t"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    assert a.config == b.config
    assert a.target_to_source.dtype == b.target_to_source.dtype == np.int64
    assert {k for k, v in a.extra.items() if not (isinstance(v, str) and not v)} == set(b.extra)
    for name, value in b.extra.items():
        np.testing.assert_array_equal(a.extra[name], value)


@pytest.mark.parametrize("suffix", [".npz", ".mat", ".NPZ"])
def test_everything_comes_back(tmp_path: Path, suffix: str) -> None:
    save_map(tmp_path / f"m{suffix}", example())
    same(example(), load_map(tmp_path / f"m{suffix}"))
    bare = MapFile(np.arange(3))
    save_map(tmp_path / f"m{suffix}", bare, force=True)
    found = load_map(tmp_path / f"m{suffix}")
    np.testing.assert_array_equal(found.target_to_source, [0, 1, 2])
    assert found.functional_map is None
    assert (found.config, dict(found.extra)) == ("", {})


@pytest.mark.parametrize(("suffix", "first"), [(".txt", 0), (".vts", 1)])
def test_lists(tmp_path: Path, suffix: str, first: int) -> None:
    save_map(tmp_path / f"m{suffix}", example())
    lines = (tmp_path / f"m{suffix}").read_text().split("\n")
    assert [int(x) - first for x in lines[:-1]] == example().target_to_source.tolist()
    assert lines[-1] == ""
    np.testing.assert_array_equal(load_map(tmp_path / f"m{suffix}").target_to_source, example().target_to_source)


def test_npz_is_what_the_documentation_says(tmp_path: Path) -> None:
    save_map(tmp_path / "m.npz", example())
    with np.load(tmp_path / "m.npz", allow_pickle=False) as content:
        np.testing.assert_array_equal(content["target_to_source"], example().target_to_source)
        np.testing.assert_array_equal(content["functional_map"], example().functional_map)
        assert str(content["config"]) == example().config


def test_mat_counts_from_one_in_columns_of_doubles(tmp_path: Path) -> None:
    save_map(tmp_path / "m.mat", example())
    content = scipy.io.loadmat(tmp_path / "m.mat")
    np.testing.assert_array_equal(content["target_to_source"], example().target_to_source[:, None] + 1)
    np.testing.assert_array_equal(content["runners_up"], np.asarray(example().extra["runners_up"]) + 1)
    np.testing.assert_array_equal(content["landmarks"], np.asarray(example().extra["landmarks"]) + 1)
    np.testing.assert_array_equal(content["eigenvalues_s"][:, 0], example().eigenvalues_s)
    assert content["target_to_source"].dtype == np.float64
    assert content["config"][0] == example().config


@pytest.mark.parametrize("suffix", [".npz", ".mat", ".txt", ".vts"])
def test_existing_files_and_names(tmp_path: Path, suffix: str) -> None:
    save_map(tmp_path / f"m{suffix}", example())
    with pytest.raises(InvalidInput, match="--force"):
        save_map(tmp_path / f"m{suffix}", example())
    with pytest.raises(InvalidInput, match=r"one of \.npz \.txt \.vts \.mat"):
        save_map(tmp_path / "m.pkl", example())
    with pytest.raises(InvalidInput, match=r"one of \.npz"):
        load_map(tmp_path / "m")


def refused(path: Path, content: bytes) -> str:
    path.write_bytes(content)
    with pytest.raises(InvalidInput) as caught:
        load_map(path)
    assert path.name in str(caught.value)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("suffix", [".npz", ".mat"])
def test_cut_or_damaged(tmp_path: Path, suffix: str) -> None:
    save_map(tmp_path / f"m{suffix}", example())
    content = (tmp_path / f"m{suffix}").read_bytes()
    for cut in {*range(0, 300, 11), *range(300, len(content), 53), len(content) - 1}:
        refused(tmp_path / f"x{suffix}", content[:cut])


@given(st.data())
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_few_other_bytes(tmp_path: Path, data: st.DataObject) -> None:
    suffix = data.draw(st.sampled_from([".npz", ".mat", ".txt", ".vts"]))
    save_map(tmp_path / f"m{suffix}", example(n_t=9), force=True)
    content = bytearray((tmp_path / f"m{suffix}").read_bytes())
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 4))] = data.draw(st.binary(max_size=4))
    (tmp_path / f"x{suffix}").write_bytes(bytes(content))
    try:
        found = load_map(tmp_path / f"x{suffix}")
    except InvalidInput:
        return
    assert found.target_to_source.min() >= 0


def npz(**content: Any) -> bytes:
    file = io.BytesIO()
    np.savez(file, **content)
    return file.getvalue()


ONE = np.arange(4)


class Trap:
    """Touches a file when unpickled."""

    touched = False

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        return (setattr, (Trap, "touched", True))


def test_pickles_are_never_opened(tmp_path: Path) -> None:
    pickle.loads(pickle.dumps(Trap()))
    assert Trap.touched, "the trap works"
    Trap.touched = False
    refused(tmp_path / "m.npz", npz(target_to_source=ONE, extra=np.array([Trap()], dtype=object)))
    refused(tmp_path / "m.npz", pickle.dumps(Trap()))
    assert not Trap.touched


def lying_npz() -> bytes:
    """A header that promises a terabyte."""
    array = io.BytesIO()
    np.lib.format.write_array_header_1_0(array, {"descr": "<i8", "fortran_order": False, "shape": (2**37,)})
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("target_to_source.npy", array.getvalue() + bytes(64))
    return file.getvalue()


@pytest.mark.parametrize(
    ("content", "part"),
    [
        (npz(other=ONE), "expected an array target_to_source, got other"),
        (npz(target_to_source=ONE - 2), "source vertices from 0 on, got -2"),
        (npz(target_to_source=ONE + 0.5), "got fractions"),
        (npz(target_to_source=np.full(4, 1e300)), "source vertices from 0 on"),
        (npz(target_to_source=np.full(4, np.nan)), "finite"),
        (npz(target_to_source=ONE[:0]), "got none"),
        (npz(target_to_source=ONE.reshape(2, 2)), "shape (any)"),
        (npz(target_to_source=np.array(["a"])), "an array of numbers"),
        (npz(target_to_source=ONE * 1j), "an array of numbers"),
        (npz(target_to_source=ONE, functional_map=ONE), "functional_map: expected shape"),
        (npz(target_to_source=ONE, functional_map=np.full((2, 2), np.inf)), "functional_map: expected finite"),
        (npz(target_to_source=ONE, functional_map=np.eye(2), eigenvalues_s=ONE), "_s: expected 2 numbers"),
        (
            npz(target_to_source=ONE, functional_map=np.eye(2, 4), eigenvalues_t=ONE),
            "_t: expected 2 numbers",
        ),
        (npz(target_to_source=ONE, config=ONE), "config: expected text"),
        (npz(target_to_source=ONE, **{"a b": ONE}), "names of letters"),
        (npz(target_to_source=ONE, labels=np.array(["a", "b"])), "extra labels"),
        (lying_npz(), "target_to_source.npy: expected data for shape"),
        (b"PK\3\4", "complete .npz file"),
    ],
)
def test_what_is_no_map(tmp_path: Path, content: bytes, part: str) -> None:
    assert part in refused(tmp_path / "m.npz", content)


@pytest.mark.parametrize("n_s", ["4", np.zeros(2), np.nan, 0, True])
def test_a_source_size_that_is_none(n_s: object) -> None:
    assert MapFile(ONE, extra={"n_s": np.array([40.0])}).n_s == 40
    assert MapFile(ONE).n_s is None
    with pytest.raises(InvalidInput, match="one whole number above 0"):
        MapFile(ONE, extra={"n_s": n_s})  # pyright: ignore[reportArgumentType]


def test_names_that_cannot_be_kept() -> None:
    for name in ("config", "file", "1a", "a" * 32, "_a", ""):
        with pytest.raises(InvalidInput, match="names of letters"):
            MapFile(ONE, extra={name: ONE})


@pytest.mark.parametrize(
    ("content", "part"), [("1 2\n", "line 1"), ("0\n1.5\n", "1.5"), ("-2\n", "from 0 on"), ("#\n", "no numbers")]
)
def test_text_that_is_no_map(tmp_path: Path, content: str, part: str) -> None:
    assert part in refused(tmp_path / "m.txt", content.encode())


def test_one_based_lists_do_not_hold_zero(tmp_path: Path) -> None:
    assert "counted from 0" in refused(tmp_path / "m.vts", b"1\n0\n")


def test_check_map() -> None:
    np.testing.assert_array_equal(check_map([0, 2.0, 1], 3, 3), [0, 2, 1])
    np.testing.assert_array_equal(check_map(MapFile(ONE), 4, 4), ONE)
    with pytest.raises(InvalidInput, match="from 0 to 2, got 3"):
        check_map(ONE, 3, 4)
    with pytest.raises(InvalidInput, match=r"map: expected shape \(5\), got shape \(4,\)"):
        check_map(ONE, 4, 5)


DEEP = "[" * 100_000
LEVELS = '{"a":' * 60 + "1" + "}" * 60


@pytest.mark.parametrize("suffix", [".npz", ".mat"])
@pytest.mark.parametrize(
    ("content", "part"),
    [
        ({"runners_up": np.zeros((2, 3))}, "extra runners_up: expected shape (any, 4), got shape (2, 3)"),
        ({"runners_up": np.zeros((2, 2, 4))}, "extra runners_up: expected shape (any, 4)"),
        ({"runners_up": np.full((1, 4), 0.5)}, "fractions"),
        ({"runners_up": np.full((1, 4), 9.0), "n_s": 5}, "vertex numbers from 0 to 4, got"),
        ({"runners_up": "text"}, "an array of numbers"),
        ({"raw_target_to_source": ONE[:3]}, "extra raw_target_to_source: expected shape (4), got shape (3,)"),
        ({"landmarks": np.zeros((2, 3))}, "extra landmarks: expected shape (any, 2)"),
        ({"landmarks": np.full((2, 2), 7)}, "extra landmarks: expected vertex numbers from 0 to 3, got"),
        ({"landmarks": "1 2"}, "an array of numbers"),
        ({"confidence": np.zeros(3)}, "extra confidence: expected one number"),
        ({"confidence": np.nan}, "extra confidence: expected one number"),
        ({"confidence": "high"}, "an array of numbers"),
        ({"local_confidence": np.zeros(3)}, "extra local_confidence: expected shape (4), got shape (3,)"),
        ({"local_confidence": np.full(4, np.inf)}, "infinite"),
        ({"raw_functional_map": np.zeros((2, 2, 2))}, "extra raw_functional_map: expected shape (any, any)"),
        ({"n_s": 2}, "target_to_source: expected source vertices from 0 to 1, got 3"),
        ({"source": ONE}, "extra source: expected a path of at most 4096 letters, got an array"),
        ({"source": "a" * 5000}, "extra source: expected a path of at most 4096 letters, got 5000"),
        ({"summary": DEEP}, "extra summary: expected JSON of at most 50 levels"),
        ({"summary": ONE}, "extra summary: expected text"),
        ({"config": DEEP}, "config: expected JSON of at most 50 levels"),
        ({"config": LEVELS}, "config: expected JSON of at most 50 levels"),
    ],
)
def test_arrays_of_another_kind_or_length(tmp_path: Path, content: dict[str, Any], part: str, suffix: str) -> None:
    """The same check for every format, before anything is done with the map."""
    content = {"target_to_source": ONE + (suffix == ".mat"), **content}
    file = io.BytesIO()
    if suffix == ".npz":
        np.savez(file, **content)
    else:
        scipy.io.savemat(file, content, oned_as="column")
    if suffix == ".mat" and ("got" in part or "letters" in part) and "shape" in part and "(3,)" not in part:
        part = part.partition(", got")[0]
    told = refused(tmp_path / f"m{suffix}", file.getvalue())
    assert part in told
    assert len(told) < 400


def test_what_a_map_says_in_its_own_words_is_kept() -> None:
    found = MapFile(
        ONE, config="by hand", extra={"summary": "made on a Monday", "weights": np.ones(3), "n_s": np.array(9)}
    )
    assert (found.config, found.extra["summary"], found.n_s) == ("by hand", "made on a Monday", 9)
    assert MapFile(ONE, extra={"runners_up": ONE * 1.0}).extra["runners_up"].shape == (1, 4)  # pyright: ignore


def zeros_npz(names: int, megabytes: int) -> bytes:
    """Arrays of zeros, packed to a thousandth of their size, all of them the same bytes of the file."""
    array = io.BytesIO()
    np.lib.format.write_array_header_1_0(array, {"descr": "<f8", "fortran_order": False, "shape": (megabytes << 17,)})
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for i in range(names):
            archive.writestr(f"a{i}.npy", array.getvalue() + bytes(megabytes << 20))
    return file.getvalue()


def zeros_mat(names: int, megabytes: int) -> bytes:
    content = io.BytesIO()
    scipy.io.savemat(content, {"a": np.zeros(megabytes << 20, dtype=np.int8)}, do_compression=True)
    head, element = content.getvalue()[:128], content.getvalue()[128:]
    return head + names * element


@pytest.mark.parametrize("sizes", [(64, 1), (1, 64)])
@pytest.mark.parametrize(("suffix", "packed"), [(".npz", zeros_npz), (".mat", zeros_mat)])
def test_sizes_are_looked_at_before_memory_is_taken(
    tmp_path: Path, suffix: str, packed: Any, sizes: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Kilobytes of file that unpack to much more than a map has: refused with a small part of it unpacked."""
    monkeypatch.setattr("kfmaps.io.mapfile.LARGEST", 1 << 20)
    content = packed(*sizes)
    assert len(content) < 1 << 17
    tracemalloc.start()
    told = refused(tmp_path / f"m{suffix}", content)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert "at most 8.39 MB unpacked" in told
    assert most < 32 << 20


def test_a_terabyte_is_refused_at_once(tmp_path: Path) -> None:
    lie = bytearray(zeros_npz(1, 1))
    at = lie.rindex(b"PK\1\2")
    lie[at + 24 : at + 28] = b"\xf0\xff\xff\xff"  # the size that the archive declares
    assert "at most 2.15 GB unpacked, got 4.29 GB" in refused(tmp_path / "m.npz", bytes(lie))
