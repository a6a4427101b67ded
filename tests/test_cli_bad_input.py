"""What commands refuse: one line, status 2, no traceback, no file, and before any work where that can be."""

from __future__ import annotations

import os
import types
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kfmaps.shape
from commandline import SMALL, run, shapes
from kfmaps._arrays import InvalidInput
from kfmaps._memory import _installed_memory, check_memory, format_bytes
from kfmaps.config import Config, DescriptorConfig, NystromConfig
from kfmaps.io import write_vertex_numbers
from kfmaps.matching.memory import check_match_memory

GUARDS = ("kfmaps.matching.memory",)


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
    message = run("match", made.source, made.target, *SMALL, *words, "-o", made.folder / "m.npz").error
    assert {path: path.read_bytes() for path in made.folder.iterdir() if path.is_file()} == before
    return message


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
    content, message = MESHES[case]
    path = made.folder / "m.off"
    if content is not None:
        path.write_text(content)
    setattr(made, side, path)
    line = complaint(made)
    assert line.startswith(str(path))
    assert message.lower() in line.lower(), line


@pytest.mark.parametrize(
    ("content", "words", "message"),
    [
        ("0 0\n1 100\n", (), "0 to 99"),
        ("0 0\n1 5\n2 5\n", (), "5 repeated"),
        ("left hand\n", (), "expected numbers"),
        ("1 1\n100 100\n", (), "--one-based"),
        ("0 1\n2 2\n", ("--one-based",), "from 1 on"),
    ],
)
@pytest.mark.usefixtures("no_work")
def test_landmarks(content: str, words: tuple[str, ...], message: str, made: types.SimpleNamespace) -> None:
    path = made.folder / "l.txt"
    path.write_text(content)
    assert message in complaint(made, "--landmarks", path, *words)


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
    first, second, message = DESCRIPTORS[case]
    np.save(made.folder / "s.npy", first())
    np.save(made.folder / "t.npy", second())
    words = ("--descriptors", made.folder / "s.npy", made.folder / "t.npy")
    assert message in complaint(made, *words)


def test_a_missing_file_is_told_before_an_existing_map(made: types.SimpleNamespace) -> None:
    (made.folder / "m.npz").write_text("precious")
    message = run("match", made.source, made.folder / "nope.ply", "-o", made.folder / "m.npz").error
    assert "nope.ply: expected a file, got nothing there" in message
    assert "m.npz" not in message


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
    ("name", "message"),
    [("m.xlsx", ".npz"), ("m", "no extension"), ("none/m.npz", "an existing folder"), ("folder.npz", "a folder")],
)
@pytest.mark.usefixtures("no_work")
def test_output(name: str, message: str, made: types.SimpleNamespace) -> None:
    (made.folder / "folder.npz").mkdir()
    line = run("match", made.source, made.target, "-o", made.folder / name).error
    assert message in line
    assert not (made.folder / "m.npz").exists()


@pytest.mark.usefixtures("no_work")
def test_existing_output_needs_force(made: types.SimpleNamespace) -> None:
    (made.folder / "m.npz").write_text("precious")
    assert "--force" in complaint(made)
    assert (made.folder / "m.npz").read_text() == "precious"


# What a command reads it does not replace, and numbers out of proportion cost a line ----------------------


@pytest.mark.parametrize("link", [None, os.link, os.symlink])
@pytest.mark.parametrize(
    ("words", "read"),
    [
        (("match", "a.off", "b.off", "--landmarks", "pairs.txt", *SMALL, "-o"), "pairs.txt"),
        (("match", "a.off", "b.off", "--truth", "a.vts", "b.vts", *SMALL, "-o"), "b.vts"),
        (("match", "a.off", "b.off", "--descriptors", "m.txt", "m.txt", *SMALL, "-o"), "m.txt"),
        (("transfer", "m.txt", "pairs.txt", "-o"), "m.txt"),
        (("transfer", "m.txt", "pairs.txt", "-o"), "pairs.txt"),
        (("export", "m.txt", "--source", "a.off", "--target", "b.off", "-o"), "m.txt"),
        (("export", "m.txt", "--source", "a.off", "--target", "b.off", "-o"), "b.off"),
        (("view", "m.txt", "--source", "a.off", "--target", "b.off", "-o"), "a.off"),
        (("evaluate", "m.txt", "--source", "a.off", "--truth", "a.vts", "c.csv", "--curve"), "c.csv"),
        (("render", "pair", "m.txt", "--source", "a.off", "--target", "p.png", "-o"), "p.png"),
        (("landmarks", "a.off", "b.off", "--no-browser", "-o"), "b.off"),
    ],
)
def test_an_output_that_would_replace_an_input_is_refused(
    made: types.SimpleNamespace, words: tuple[str, ...], read: str, link: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(made.folder)
    write_vertex_numbers("m.txt", np.arange(100))
    Path("p.png").write_bytes(b"x")
    Path("c.csv").write_bytes(Path("b.vts").read_bytes())
    output = read
    if callable(link):
        output = f"link{Path(read).suffix}"
        link(made.folder / read, output)
    before = Path(read).read_bytes()
    message = run(*words, output, "--force").error
    assert "expected a file other than the inputs" in message
    assert Path(read).read_bytes() == before


def test_numbers_out_of_proportion(made: types.SimpleNamespace) -> None:
    """Refused with what they would take, before any work."""
    words = ("--set", "descriptors.n_spectral=1000000000", "-o", made.folder / "m.npz")
    message = run("match", made.source, made.target, *SMALL, *words).error
    assert "1,600 GB for 1,000,000,000 descriptors of 200 points" in message
    assert not (made.folder / "m.npz").exists()


def test_demand(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kfmaps._memory._installed_memory", lambda: 16 << 30)
    for config in (Config.single_fit(), Config(), Config.paper(), Config.no17()):
        check_match_memory(config, 80_000, 80_000, 50)
    with pytest.raises(InvalidInput, match=r"got 80 GB for 500,000 descriptors of 20,000 points"):
        check_match_memory(
            replace(Config.single_fit(), descriptors=DescriptorConfig(n_spectral=500_000, shot=False)), 80_000, 80_000
        )
    check_match_memory(
        replace(Config.single_fit(), nystrom=NystromConfig(samples=10**9)), 1000, 1000
    )  # there are only 2,000 points
    with pytest.raises(InvalidInput, match=r"got 230 GB for 160,000 Nyström samples of 20,000 points"):
        check_match_memory(replace(Config.single_fit(), nystrom=NystromConfig(samples=10**9)), 80_000, 80_000)


def test_demand_of_a_match_from_python() -> None:
    sphere = kfmaps.datasets.sphere(100)
    few = DescriptorConfig(10**10, n_eigenfunctions=10, shot=False)
    config = replace(Config.single_fit(), basis=kfmaps.BasisConfig(5), descriptors=few, refinement=None)
    with pytest.raises(InvalidInput, match="for 10,000,000,000 descriptors"):
        kfmaps.match(sphere, sphere, config)


def test_memory() -> None:
    assert 1 << 28 < _installed_memory() < 1 << 50
    check_memory(1e6, "a", "b", "c")
    with pytest.raises(InvalidInput, match=r"a: expected at most .*B of memory, got 1,000,000,000 GB for b. C\."):
        check_memory(1e18, "a", "b", "c")
    assert [format_bytes(x) for x in (5, 1.5e3, 12e6, 999e6, 3.5e9, 2e13)] == [
        *("5 bytes", "1.5 kB", "12 MB", "999 MB", "3.5 GB", "20,000 GB")
    ]
