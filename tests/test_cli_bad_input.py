"""What ``kfmaps match`` refuses: one line, status 2, no traceback, no file, and before any work where that can be."""

from __future__ import annotations

import types
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import kfmaps.shape
from commandline import SMALL, run, shapes
from kfmaps.io import mapfile


@pytest.fixture
def made(tmp_path: Path) -> types.SimpleNamespace:
    return shapes(tmp_path, 100)


@pytest.fixture
def no_work(monkeypatch: pytest.MonkeyPatch) -> None:
    def prepare(*_: object, **__: object) -> None:
        raise AssertionError("the work was begun")

    monkeypatch.setattr(kfmaps.shape, "prepare", prepare)


def complaint(made: types.SimpleNamespace, *words: object) -> str:
    """The line, when nothing was written."""
    before = {path: path.read_bytes() for path in made.folder.iterdir() if path.is_file()}
    told = run("match", made.source, made.target, *SMALL, *words, "-o", made.folder / "m.npz").error
    assert {path: path.read_bytes() for path in made.folder.iterdir() if path.is_file()} == before
    return told


OFF = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"

MESHES: dict[str, tuple[str, str | None, str]] = {
    "missing file": ("none.off", None, "nothing there"),
    "empty file": ("m.off", "", "empty"),
    "truncated file": ("m.off", OFF[:-16], "4 faces"),
    "unknown extension": ("m.blend", OFF, ".off"),
    "not what its extension says": ("m.ply", OFF, "ply"),
    "NaN coordinate": ("m.off", OFF.replace("0 0 1\n3", "0 0 nan\n3"), "finite"),
    "infinite coordinate": ("m.off", OFF.replace("0 0 1\n3", "0 0 inf\n3"), "finite"),
    "face out of range": ("m.off", OFF.replace("3 0 3 2", "3 0 4 2"), "0 to 3"),
    "negative face": ("m.off", OFF.replace("3 0 3 2", "3 0 -1 2"), "0 to 3"),
    "no faces": ("m.off", "OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", "faces"),
    "zero area": ("m.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n", "area"),
    "fewer vertices than eigenfunctions": ("m.off", OFF, "vertices, one for each eigenfunction"),
}


@pytest.mark.parametrize("side", ["source", "target"])
@pytest.mark.parametrize("case", MESHES)
@pytest.mark.usefixtures("no_work")
def test_meshes(case: str, side: str, made: types.SimpleNamespace) -> None:
    name, content, told = MESHES[case]
    path = made.folder / name
    if content is not None:
        path.write_text(content)
    setattr(made, side, path)
    line = complaint(made)
    assert line.startswith(str(path))
    assert told.lower() in line.lower(), line


LANDMARKS = {
    "out of range": ("0 0\n1 100\n", "0 to 99"),
    "negative": ("0 0\n1 -1\n", "-1"),
    "repeated": ("0 0\n1 5\n2 5\n", "5 repeated"),
    "unequal number": ("0 0\n1\n", "two whole numbers"),
    "fractions": ("0 0\n1 1.5\n", "1.5"),
    "words": ("left hand\n", "expected numbers"),
    "none": ("# nothing\n", "no numbers"),
}


@pytest.mark.parametrize("case", LANDMARKS)
@pytest.mark.usefixtures("no_work")
def test_landmarks(case: str, made: types.SimpleNamespace) -> None:
    content, told = LANDMARKS[case]
    path = made.folder / "l.txt"
    path.write_text(content)
    line = complaint(made, "--landmarks", path)
    assert told in line, line


@pytest.mark.usefixtures("no_work")
def test_landmarks_that_count_from_one(made: types.SimpleNamespace) -> None:
    path = made.folder / "l.txt"
    path.write_text("1 1\n100 100\n")
    assert "--one-based" in complaint(made, "--landmarks", path)
    path.write_text("0 1\n2 2\n")
    assert "from 1 on" in complaint(made, "--landmarks", path, "--one-based")


DESCRIPTORS: dict[str, tuple[Callable[[], np.ndarray], Callable[[], np.ndarray], str]] = {
    "wrong length": (lambda: np.ones((100, 2)), lambda: np.ones((99, 2)), "(100, any)"),
    "unequal columns": (lambda: np.ones((100, 2)), lambda: np.ones((100, 3)), "2 and 3"),
    "NaN": (lambda: np.full((100, 2), np.nan), lambda: np.ones((100, 2)), "finite"),
    "text": (lambda: np.full((100, 2), "a"), lambda: np.ones((100, 2)), "numbers"),
    "three dimensions": (lambda: np.ones((100, 2, 2)), lambda: np.ones((100, 2)), "(100, any)"),
}


@pytest.mark.parametrize("case", DESCRIPTORS)
@pytest.mark.usefixtures("no_work")
def test_descriptors(case: str, made: types.SimpleNamespace) -> None:
    first, second, told = DESCRIPTORS[case]
    np.save(made.folder / "s.npy", first())
    np.save(made.folder / "t.npy", second())
    words = ("--descriptors", made.folder / "s.npy", made.folder / "t.npy")
    assert told in complaint(made, *words)


def test_a_missing_file_is_told_before_an_existing_map(made: types.SimpleNamespace) -> None:
    (made.folder / "m.npz").write_text("precious")
    told = run("match", made.source, made.folder / "nope.ply", "-o", made.folder / "m.npz").error
    assert "nope.ply: expected a file, got nothing there" in told
    assert "m.npz" not in told


def test_kernel_that_overflows(made: types.SimpleNamespace) -> None:
    line = complaint(
        made,
        "--landmarks",
        made.landmarks,
        "--preset",
        "single-fit",
        "-q",
        "--kernel",
        "polynomial",
        "--set",
        "kernel.degree=4000",
    )
    assert "Polynomial" in line
    assert "finite values" in line


@pytest.mark.usefixtures("no_work")
def test_truth(made: types.SimpleNamespace) -> None:
    assert "--truth" in complaint(made, "--truth-source", made.truth_source)
    short = made.folder / "short.vts"
    short.write_text("1\n2\n")
    assert "equal length" in complaint(made, "--truth", made.truth_source, short)
    far = made.folder / "far.txt"
    far.write_text("".join(f"{i + 1}\n" for i in range(100)))
    assert "0 to 99" in complaint(made, "--truth", made.truth_source, far)


@pytest.mark.parametrize("device", ["cuda:99", "abacus"])
@pytest.mark.usefixtures("no_work")
def test_device(device: str, made: types.SimpleNamespace) -> None:
    assert complaint(made, "--device", device).startswith(f"--device {device}")


@pytest.mark.usefixtures("no_work")
def test_settings(made: types.SimpleNamespace) -> None:
    assert complaint(made, "--set", "weights.laplacian=-1").startswith("--set weights.laplacian: ")
    assert complaint(made, "--config", made.folder / "none.toml").startswith("--config ")


@pytest.mark.parametrize(
    ("name", "told"),
    [("m.xlsx", ".npz"), ("m", "no extension"), ("none/m.npz", "an existing folder"), ("folder.npz", "a folder")],
)
@pytest.mark.usefixtures("no_work")
def test_output(name: str, told: str, made: types.SimpleNamespace) -> None:
    (made.folder / "folder.npz").mkdir()
    line = run("match", made.source, made.target, "-o", made.folder / name).error
    assert told in line
    assert not (made.folder / "m.npz").exists()


@pytest.mark.usefixtures("no_work")
def test_existing_output_needs_force(made: types.SimpleNamespace) -> None:
    (made.folder / "m.npz").write_text("precious")
    assert "--force" in complaint(made)
    assert (made.folder / "m.npz").read_text() == "precious"


def test_force_replaces(made: types.SimpleNamespace) -> None:
    path = made.folder / "m.npz"
    path.write_text("worthless")
    words = (
        "match",
        made.source,
        made.target,
        "--landmarks",
        made.landmarks,
        "--preset",
        "single-fit",
        *SMALL,
        "-q",
        "-o",
        path,
    )
    assert run(*words, "--force").status == 0
    np.testing.assert_array_equal(mapfile.load_map(path).target_to_source, made.truth)


@pytest.mark.parametrize("raised", [KeyboardInterrupt(), OSError(28, "No space left on device")])
def test_no_half_file(raised: BaseException, made: types.SimpleNamespace, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupted while the map is being written: what was there stays, and nothing new appears."""

    def half(file: object, **_: object) -> None:
        file.write(b"PK half of it")  # pyright: ignore[reportAttributeAccessIssue]
        raise raised

    monkeypatch.setattr(np, "savez_compressed", half)
    (made.folder / "m.npz").write_text("precious")
    before = sorted(made.folder.iterdir())
    words = (
        "--landmarks",
        made.landmarks,
        "--preset",
        "single-fit",
        *SMALL,
        "-q",
        "--force",
        "-o",
        made.folder / "m.npz",
    )
    ran = run("match", made.source, made.target, *words)
    assert ran.status == (130 if isinstance(raised, KeyboardInterrupt) else 2)
    assert sorted(made.folder.iterdir()) == before
    assert (made.folder / "m.npz").read_text() == "precious"
