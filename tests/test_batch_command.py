"""``kfmaps batch`` as a user meets it: what it prints, writes, refuses, and how it ends."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from collecting import LANDMARKS, touch, write_collection
from kfmaps.cli.main import main
from kfmaps.settings import read_settings

GUARDS = ("kfmaps.matching.memory",)

pytestmark = pytest.mark.usefixtures("workers_here")

SIZES = (
    *("--set", "basis.n_eigenfunctions=20", "--set", "descriptors.n_spectral=20"),
    *("--set", "descriptors.n_eigenfunctions=40", "--set", "nystrom.samples=60"),
)
ZOOM = (
    *("--preset", "single-fit", "--set", "refinement.start=10", "--set", "refinement.stop=40"),
    *("--set", "refinement.step=5"),
)
MARKS = ("--landmarks", ",".join(map(str, LANDMARKS)))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_collection(tmp_path_factory.mktemp("shapes"), 3)


def test_a_run_and_another_that_finds_it_done(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pairs = touch(tmp_path / "pairs.txt", "b0 b1\nb2 b1\n")
    out = tmp_path / "deep" / "out"
    words = ["batch", str(folder), "-o", str(out), "--workers", "1", *SIZES, *ZOOM, *MARKS]
    assert main([*words, "--pairs", str(pairs)]) == 0
    output = capsys.readouterr().out
    assert "2 pairs of 3 shapes" in output
    assert "pairs 2/2, finished" in output
    assert "summary 1/1" in output
    with open(out / "results.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    mean = sum(float(row["error_mean"]) for row in rows) / 2
    assert f"mean error {100 * mean:.2f} % of √area over 2 pairs" in output
    assert f"<dt>mean error (% of √area)</dt><dd>{100 * mean:.2f}</dd>" in (out / "summary.html").read_text(
        encoding="utf-8"
    )
    assert main(["config", *SIZES, *ZOOM, "-o", str(tmp_path / "config.toml")]) == 0
    assert read_settings(out / "settings.toml") == read_settings(tmp_path / "config.toml")
    assert main([*words, "--graph", "both"]) == 0
    output = capsys.readouterr().out
    assert "6 pairs of 3 shapes, 2 done already" in output
    assert (out / "summary.html").read_text(encoding="utf-8").count("data:image/png") == 6
    pairs.write_text("b0 b1\n")
    assert main([*words, "--pairs", str(pairs), "-q"]) == 0
    assert capsys.readouterr().out == ""
    assert main([*words, "--pairs", str(pairs), "--json", "--require", "sure"]) == 3  # single fits are not judged
    output = json.loads(capsys.readouterr().out)
    assert (output["done"], output["failed"], output["left"], output["verdicts"]) == (1, 0, 0, {"landmarks": 1})
    assert str(out / "results.csv") in output["output"]


def star(folder: Path, tmp_path: Path) -> list[str]:
    """The words of a run of b0 with all others."""
    graph = ("--graph", "star:b0", "--workers", "1")
    return ["batch", str(folder), "-o", str(tmp_path / "out"), *graph, *SIZES, *ZOOM, *MARKS]


def test_failures_have_a_status_of_their_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = write_collection(tmp_path / "c", 3)
    touch(folder / "b2.off", "OFF\n")
    words = star(folder, tmp_path)
    assert main(words) == 1
    output = capsys.readouterr().out
    assert "failed: b0 → b2: shape b2 could not be prepared" in output
    assert "pairs 2/2 (1 failed), finished" in output
    assert "1 pair failed" in output
    assert main(words) == 1  # and nothing is tried again unasked
    assert "2 pairs of 3 shapes, 2 done already" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--pairs", "list.txt", "--graph", "both"], "one of --graph and --pairs"),
        ([], "test_pairs.txt"),
        (["--graph", "ring"], "near, star, star:SHAPE, all or both"),
        (["--graph", "star:b9"], "b9"),
        (["--graph", "both", "--landmarks", "1,x"], "'1,x'"),
        (["--graph", "both", "--landmarks", "0"], "whole numbers from 1"),
        (["--graph", "both", "--landmarks", ","], "whole numbers from 1 on, with commas between"),
        (["--graph", "near", "--workers", "0"], "workers"),
        (["--graph", "both", "--kernel", "cubic"], "cubic"),
        (["--graph", "both", "--identity"], "--identity"),
    ],
)
def test_refusals(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str
) -> None:
    assert main(["batch", str(folder), "-o", str(tmp_path / "out"), *words]) == 2
    output = capsys.readouterr()
    assert message in output.err
    assert len(output.err.splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_a_graph_of_pairs_that_agree(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    words = ["batch", str(folder), "-o", str(out), "--workers", "1", "--graph", "near", "--consistent"]
    words += [*SIZES, *ZOOM, *MARKS]
    assert main(words) == 0
    output = capsys.readouterr().out
    assert "3 pairs of 3 shapes" in output
    assert "evidence of pairs 3/3" in output
    assert "all maps agree: none replaced" in output
    with open(out / "results.csv", encoding="utf-8", newline="") as file:
        assert all(float(row["agreement"]) > 0.5 for row in csv.DictReader(file))
    assert {p.name for p in (out / "consistent").iterdir()} >= {
        "pairs.csv",
        "shapes.csv",
        "distances.csv",
        "latent.npz",
    }
