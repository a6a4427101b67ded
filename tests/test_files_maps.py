"""Map files: all formats, and everything that is no map."""

from __future__ import annotations

import io
import json
import pickle
import re
import tracemalloc
import zipfile
from dataclasses import fields, is_dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from conftest import blob, refusal
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.config import Config
from kfmaps.fmap.precise import PointMap
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import check_map, load_map, save_map, write_mesh
from kfmaps.io.mapcontent import ARRAYS, summarize_match
from kfmaps.io.mapfile import map_mesh, with_files
from kfmaps.kernels.kernels import Gaussian
from kfmaps.matching.result import SHAPE_FIELDS, Match
from kfmaps.matching.result_groups import MatchFit, MatchPart, MatchRegistration, MatchScore, ShapeFile
from kfmaps.registration.accept import RegistrationReport


def example(seed: int = 0, n_t: int = 50) -> Match:
    """A match with a value in every field that a file holds."""
    rng = np.random.default_rng(seed)
    weights = rng.random((n_t, 3))
    return Match(
        rng.integers(0, 40, n_t),
        functional_map=rng.normal(size=(6, 5)),
        eigenvalues_source=np.sort(rng.random(5)),
        eigenvalues_target=np.sort(rng.random(6)),
        verdict="likely",
        confidence=0.25,
        local_confidence=np.append(rng.random(n_t - 1), np.nan),
        orientation="reversing",
        precise_map=PointMap(rng.integers(0, 70, n_t), weights / weights.sum(axis=1, keepdims=True)),
        alternatives=(rng.integers(0, 40, n_t),),
        source_to_target=rng.integers(0, n_t, 40),
        functional_map_back=rng.normal(size=(5, 6)),
        landmarks=rng.integers(0, min(40, n_t), (3, 2)),
        config=Config(kernel=Gaussian(0.25)),
        seed=7,
        seconds={"solve": 0.5},
        score=MatchScore((1.5, -2.0), -1.0, 0.5, "signs ++, γ", np.array([1])),
        registration=MatchRegistration(rng.normal(size=(40, 3)), RegistrationReport(0.1, 0.2, 0.3, reason="gap")),
        partial=MatchPart("target", "a hole", 0.5, True, rng.random(40), rng.random(n_t)),
        fit=MatchFit(
            rng.normal(size=(4, 4)),
            rng.integers(0, 40, n_t),
            4,
            "converged",
            2,
            np.array([1.0, 0.5, 0.25]),
            {"laplacian": 1.25},
            "gaußian γ",
            60,
            30,
            np.array([0.5, 1.0]),
        ),
        source_file=ShapeFile("a/b ü.off", "0" * 64, 40, 70),
        target_file=ShapeFile("c.off", "1" * 64, n_t, 90),
    )


def plain(record: Any) -> Any:
    """A record as dictionaries of lists, so that two can be compared."""
    if is_dataclass(record) and not isinstance(record, type):
        return {f.name: plain(getattr(record, f.name, "none")) for f in fields(type(record))}
    if isinstance(record, tuple):
        return [plain(one) for one in record]
    return record.tolist() if isinstance(record, np.ndarray) else record


@pytest.mark.parametrize("suffix", [".npz", ".mat", ".NPZ"])
def test_everything_comes_back(tmp_path: Path, suffix: str) -> None:
    save_map(tmp_path / f"m{suffix}", example())
    found = load_map(tmp_path / f"m{suffix}")
    np.testing.assert_equal(plain(found), plain(example()))
    assert found.target_to_source.dtype == found.landmarks.dtype == np.int64
    assert found.score.rejected_landmarks.dtype == np.int64
    save_map(tmp_path / f"m{suffix}", Match(np.arange(3)), force=True)
    np.testing.assert_equal(plain(load_map(tmp_path / f"m{suffix}")), plain(Match(np.arange(3))))


def test_every_field_of_a_match_is_in_its_file_or_said_to_be_missing(tmp_path: Path) -> None:
    """A field that is added to the record must be written too."""
    example_fields = plain(example())
    assert [name for name, value in example_fields.items() if value == "none"] == list(SHAPE_FIELDS)
    save_map(tmp_path / "m.npz", example())
    found = load_map(tmp_path / "m.npz")
    for name in SHAPE_FIELDS:
        assert not hasattr(found, name)
        with pytest.raises(InvalidInput, match=f"{name}: expected a match that has it.*Match the shapes again"):
            getattr(found, name)
    assert replace(pickle.loads(pickle.dumps(found)), seed=8).seed == 8
    with pytest.raises(AttributeError, match="no attribute 'basis'"):
        found.basis  # type: ignore[attr-defined]  # noqa: B018


def test_the_manual_names_what_a_file_holds() -> None:
    text = (Path(__file__).parents[1] / "docs" / "files.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`(\w+)`", text))
    assert set(ARRAYS) <= named
    assert set(summarize_match(example())) <= named


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
        summary = json.loads(str(content["summary"]))
    assert (summary["verdict"], summary["fit"]["energies"]) == ("likely", {"laplacian": 1.25})
    assert summary["config"]["kernel"] == {"kind": "Gaussian", "gamma": 0.25}
    assert summary["score"]["rejected_landmarks"] == [1]


def test_mat_counts_from_one_in_columns_of_doubles(tmp_path: Path) -> None:
    save_map(tmp_path / "m.mat", example())
    content = scipy.io.loadmat(tmp_path / "m.mat")
    np.testing.assert_array_equal(content["target_to_source"], example().target_to_source[:, None] + 1)
    np.testing.assert_array_equal(content["alternatives"], np.stack(example().alternatives) + 1)
    np.testing.assert_array_equal(content["landmarks"], example().landmarks + 1)
    np.testing.assert_array_equal(content["eigenvalues_source"][:, 0], example().eigenvalues_source)
    assert content["target_to_source"].dtype == np.float64
    assert json.loads(content["summary"][0])["seed"] == 7


@pytest.mark.parametrize("suffix", [".npz", ".mat", ".txt", ".vts"])
def test_existing_files_and_names(tmp_path: Path, suffix: str) -> None:
    save_map(tmp_path / f"m{suffix}", example())
    with pytest.raises(InvalidInput, match="--force"):
        save_map(tmp_path / f"m{suffix}", example())
    with pytest.raises(InvalidInput, match=r"one of \.npz \.txt \.vts \.mat"):
        save_map(tmp_path / "m.pkl", example())
    with pytest.raises(InvalidInput, match=r"one of \.npz"):
        load_map(tmp_path / "m")


refused = partial(refusal, load_map)


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
        (npz(target_to_source=ONE, functional_map=np.eye(2), eigenvalues_source=ONE), "_source: expected shape (2)"),
        (npz(target_to_source=ONE, functional_map=np.eye(2, 4), eigenvalues_target=ONE), "_target: expected shape (2)"),
        (npz(target_to_source=ONE, config="{}"), "a map of this version of kfmaps, got an older one (with config)"),
        (npz(target_to_source=ONE, runners_up=ONE[None]), "got an older one (with runners_up). Match the shapes again"),
        (lying_npz(), "target_to_source.npy: expected data for shape"),
        (b"PK\3\4", "complete .npz file"),
    ],
)
def test_a_file_that_is_no_map_is_refused(tmp_path: Path, content: bytes, part: str) -> None:
    assert part in refused(tmp_path / "m.npz", content)


def test_other_arrays_beside_a_map_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "m.npz").write_bytes(npz(target_to_source=ONE, labels=np.array(["a", "b"]), **{"a b": ONE}))
    np.testing.assert_equal(plain(load_map(tmp_path / "m.npz")), plain(Match(ONE)))


@pytest.mark.parametrize(
    ("content", "part"), [("1 2\n", "line 1"), ("0\n1.5\n", "1.5"), ("-2\n", "from 0 on"), ("#\n", "no numbers")]
)
def test_text_that_is_no_map(tmp_path: Path, content: str, part: str) -> None:
    assert part in refused(tmp_path / "m.txt", content.encode())


def test_one_based_lists_do_not_hold_zero(tmp_path: Path) -> None:
    assert "counted from 0" in refused(tmp_path / "m.vts", b"1\n0\n")


def test_check_map() -> None:
    np.testing.assert_array_equal(check_map([0, 2.0, 1], 3, 3), [0, 2, 1])
    np.testing.assert_array_equal(check_map(Match(ONE), 4, 4), ONE)
    with pytest.raises(InvalidInput, match="from 0 to 2, got 3"):
        check_map(ONE, 3, 4)
    with pytest.raises(InvalidInput, match=r"map: expected shape \(5\), got shape \(4,\)"):
        check_map(ONE, 4, 5)


DEEP = "[" * 100_000
SIZED = json.dumps({"source_file": {"n_vertices": 5}})
HALF = np.full((4, 3), 0.5)


@pytest.mark.parametrize("suffix", [".npz", ".mat"])
@pytest.mark.parametrize(
    ("content", "part"),
    [
        ({"alternatives": np.zeros((2, 3)) + 1}, "alternatives: expected shape (any, 4), got shape (2, 3)"),
        ({"alternatives": np.ones((2, 2, 4))}, "alternatives: expected shape (any, 4)"),
        ({"alternatives": np.full((1, 4), 1.5)}, "fractions"),
        ({"alternatives": np.full((1, 4), 9.0), "summary": SIZED}, "source vertices from 0 to 4, got"),
        ({"alternatives": "text"}, "an array of numbers"),
        ({"raw_target_to_source": ONE[1:]}, "raw_target_to_source: expected shape (4), got shape (3,)"),
        ({"landmarks": np.ones((2, 3))}, "landmarks: expected shape (any, 2)"),
        ({"landmarks": np.full((2, 2), 7)}, "landmarks: expected target vertices from 0 to 3, got"),
        ({"landmarks": "1 2"}, "an array of numbers"),
        ({"local_confidence": np.zeros(3)}, "local_confidence: expected shape (4), got shape (3,)"),
        ({"local_confidence": np.full(4, np.inf)}, "infinite"),
        ({"overlap_target": np.full(4, 1.5)}, "overlap_target: expected numbers from 0 to 1"),
        ({"registered_vertices": np.zeros((4, 3)), "summary": SIZED}, "registered_vertices: expected shape (5, 3)"),
        ({"precise_faces": ONE + 1}, "precise_map.weights: expected a value, got none"),
        ({"precise_faces": ONE + 1, "precise_weights": HALF}, "numbers with sum 1 in each row"),
        ({"precise_faces": ONE[1:] + 1, "precise_weights": 2 * HALF / 3}, "precise"),
        ({"raw_functional_map": np.zeros((2, 2, 2))}, "raw_functional_map: expected shape (any, any)"),
        ({"summary": '{"source_file": {"n_vertices": 2}}'}, "expected source vertices from 0 to 1, got"),
        ({"summary": DEEP}, "summary: expected a summary as JSON"),
        ({"summary": "made on a Monday"}, "summary: expected a summary as JSON"),
        ({"summary": "[1]"}, "summary: expected the fields of a record, got [1]"),
        ({"summary": ONE}, "summary: expected a summary as JSON"),
        ({"summary": '{"seed": "7"}'}, ": seed: expected int"),
        ({"summary": '{"confidence": 1%s}' % ("0" * 400)}, ": confidence: expected"),
        ({"summary": '{"precise_map": {"faces": [1]}}'}, "precise_map.faces: expected a value, got none"),
        ({"summary": '{"score": 3}'}, ": score: expected the fields of a record"),
        ({"summary": '{"score": {"scores": [1, "a"]}}'}, ": score.scores: expected"),
        ({"summary": '{"registration": {"report": {"gap": 1}}}'}, "report.deformation_energy: expected a value"),
        ({"summary": '{"registration": {"report": {"reason": "x"}}}'}, "expected"),
    ],
)
def test_arrays_of_another_kind_or_length(tmp_path: Path, content: dict[str, Any], part: str, suffix: str) -> None:
    content = {"target_to_source": ONE + (suffix == ".mat"), **content}
    file = io.BytesIO()
    if suffix == ".npz":
        np.savez(file, **content)
    else:
        scipy.io.savemat(file, content, oned_as="column")
    if suffix == ".mat" and "got" in part and "shape" in part and "(3,)" not in part:
        part = part.partition(", got")[0]
    output = refused(tmp_path / f"m{suffix}", file.getvalue())
    assert part in output
    assert len(output) < 400


def test_a_summary_cannot_give_what_only_an_array_may(tmp_path: Path) -> None:
    text = json.dumps({"functional_map": [1, 2], "source": 3, "other": 1})
    (tmp_path / "m.npz").write_bytes(npz(target_to_source=ONE, summary=text))
    np.testing.assert_equal(plain(load_map(tmp_path / "m.npz")), plain(Match(ONE)))


def test_settings_that_only_the_users_code_has_are_missing(tmp_path: Path) -> None:
    match = Match(ONE, config=Config(kernel=lambda X, Y: X @ Y.T))
    save_map(tmp_path / "m.npz", match)
    with pytest.raises(InvalidInput, match="config: expected a match that has it"):
        load_map(tmp_path / "m.npz").config  # noqa: B018


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
    monkeypatch.setattr("kfmaps.io.mapfile._MAX_UNPACKED", 1 << 23)
    content = packed(*sizes)
    assert len(content) < 1 << 17
    tracemalloc.start()
    output = refused(tmp_path / f"m{suffix}", content)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert "at most 8.39 MB unpacked" in output
    assert most < 32 << 20


def test_a_terabyte_is_refused_at_once(tmp_path: Path) -> None:
    lie = bytearray(zeros_npz(1, 1))
    at = lie.rindex(b"PK\1\2")
    lie[at + 24 : at + 28] = b"\xf0\xff\xff\xff"  # the size that the archive declares
    assert "at most 2.15 GB unpacked, got 4.29 GB" in refused(tmp_path / "m.npz", bytes(lie))


def test_a_shape_that_has_changed_since_is_told(tmp_path: Path) -> None:
    mesh, path = blob(60), tmp_path / "a.ply"
    write_mesh(path, mesh)
    match = with_files(Match(ONE), (path, path), (mesh, mesh))
    np.testing.assert_array_equal(map_mesh(None, match, "source", tmp_path / "m.npz").faces, mesh.faces)
    write_mesh(path, Mesh(2 * mesh.vertices, mesh.faces), force=True)
    with pytest.warns(KfmapsWarning, match=r"a\.ply has changed since the map was made"):
        assert map_mesh(None, match, "target", tmp_path / "m.npz").vertices[0, 0] == 2 * mesh.vertices[0, 0]
