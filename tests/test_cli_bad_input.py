"""What ``kfmaps match`` refuses: one line, status 2, no traceback, no file, and before any work where that can be."""

from __future__ import annotations

import types
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import kfmaps.shape
from commandline import SMALL, run, shapes


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

MESHES: dict[str, tuple[str | None, str]] = {
    "missing file": (None, "nothing there"),
    "truncated file": (OFF[:-16], "4 faces"),
    "no faces": ("OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n", "faces"),
    "zero area": ("OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n", "area"),
    "fewer vertices than eigenfunctions": (OFF, "vertices, one for each eigenfunction"),
}


@pytest.mark.parametrize("side", ["source", "target"])
@pytest.mark.parametrize("case", MESHES)
@pytest.mark.usefixtures("no_work")
def test_meshes(case: str, side: str, made: types.SimpleNamespace) -> None:
    content, told = MESHES[case]
    path = made.folder / "m.off"
    if content is not None:
        path.write_text(content)
    setattr(made, side, path)
    line = complaint(made)
    assert line.startswith(str(path))
    assert told.lower() in line.lower(), line


@pytest.mark.parametrize(
    ("content", "words", "told"),
    [
        ("0 0\n1 100\n", (), "0 to 99"),
        ("0 0\n1 5\n2 5\n", (), "5 repeated"),
        ("left hand\n", (), "expected numbers"),
        ("1 1\n100 100\n", (), "--one-based"),
        ("0 1\n2 2\n", ("--one-based",), "from 1 on"),
    ],
)
@pytest.mark.usefixtures("no_work")
def test_landmarks(content: str, words: tuple[str, ...], told: str, made: types.SimpleNamespace) -> None:
    path = made.folder / "l.txt"
    path.write_text(content)
    assert told in complaint(made, "--landmarks", path, *words)


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
    words = ("--landmarks", made.landmarks, "--preset", "single-fit", "-q", "--kernel", "polynomial")
    line = complaint(made, *words, "--set", "kernel.degree=4000")
    assert "Polynomial" in line
    assert "finite values" in line


@pytest.mark.usefixtures("no_work")
def test_truth(made: types.SimpleNamespace) -> None:
    assert "--truth" in complaint(made, "--truth-source", made.truth_source)
    short = made.folder / "short.vts"
    short.write_text("1\n2\n")
    assert "equal length" in complaint(made, "--truth", made.truth_source, short)


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
