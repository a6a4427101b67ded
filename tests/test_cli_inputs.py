"""What a command reads it does not replace, and numbers out of proportion cost a line."""

from __future__ import annotations

import os
import types
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kfmaps
from commandline import SMALL, run, shapes
from kfmaps._arrays import InvalidInput
from kfmaps._memory import _installed_memory, check_memory, format_bytes
from kfmaps.config import Config, DescriptorConfig, NystromConfig
from kfmaps.io import write_vertex_numbers
from kfmaps.matching.memory import check_match_memory

GUARDS = ("kfmaps.matching.memory",)


@pytest.fixture
def made(tmp_path: Path) -> types.SimpleNamespace:
    found = shapes(tmp_path, 100)
    write_vertex_numbers(tmp_path / "m.txt", np.arange(100))
    (tmp_path / "p.png").write_bytes(b"x")
    return found


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
def test_what_is_read_is_not_replaced(
    made: types.SimpleNamespace,
    words: tuple[str, ...],
    read: str,
    link: object,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(made.folder)
    Path("c.csv").write_bytes(Path("b.vts").read_bytes())
    output = read
    if callable(link):
        output = f"link{Path(read).suffix}"
        link(made.folder / read, output)
    before = Path(read).read_bytes()
    told = run(*words, output, "--force").error
    assert "expected a file other than the inputs" in told
    assert Path(read).read_bytes() == before


def test_numbers_out_of_proportion(made: types.SimpleNamespace) -> None:
    """Refused with what they would take, before any work."""
    words = ("--set", "descriptors.n_spectral=1000000000", "-o", made.folder / "m.npz")
    told = run("match", made.source, made.target, *SMALL, *words).error
    assert "1,600 GB for 1,000,000,000 descriptors of 200 points" in told
    assert not (made.folder / "m.npz").exists()


def test_demand(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kfmaps._memory._installed_memory", lambda: 16 << 30)
    for config in (Config.single_fit(), Config(), Config.paper(), Config.no17()):
        check_match_memory(config, 80_000, 80_000, 50)
    with pytest.raises(InvalidInput, match=r"got 80 GB for 500,000 descriptors of 20,000 points"):
        check_match_memory(
            replace(Config.single_fit(), descriptors=DescriptorConfig(n_spectral=500_000, shot=False)),
            80_000,
            80_000,
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
