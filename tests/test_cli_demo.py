"""``kfmaps demo``."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.image import imread
from rich.console import Console

from commandline import run
from kfmaps.cli.commands.demo import _SHAPES, _table
from kfmaps.config import BasisConfig, Config, Search
from kfmaps.io import read_landmarks, read_mesh, read_vertex_numbers


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("demo")
    few = replace(Config(), search=Search(1, n_sign_functions=2, match_extremities=False), registration=None)
    plain = replace(Config.no17(), basis=BasisConfig(40))
    with pytest.MonkeyPatch.context() as patch:
        made = {"__new__": lambda _cls: few, "single_fit": Config.single_fit, "no17": lambda: plain}
        patch.setattr("kfmaps.cli.commands.demo.Config", type("Config", (), made))
        ran = run("demo", "--vertices", "1500", "-o", folder / "demo.png", "--json", "--seed", "1")
    assert ran.status == 0, ran.stderr
    (folder / "told.json").write_text(ran.stdout)
    return folder


def test_numbers(folder: Path) -> None:
    output = json.loads((folder / "told.json").read_text())
    assert output["shape"] == "two poses"
    assert (output["source_vertices"], output["target_vertices"]) == (1500, 1200)
    automatic, kernel, plain = output["methods"]
    assert automatic["verdict"] in ("sure", "likely", "ambiguous", "unlikely")
    assert kernel["given"] == plain["given"] != automatic["given"]
    assert kernel["verdict"] == plain["verdict"] == "landmarks"
    # A map drawn at random is off by about 0.9 √area; one step between vertices is 0.03.
    assert kernel["error"] < 0.04
    assert kernel["raw_error"] < 0.06
    assert "NO17" in plain["method"]
    assert 0 < plain["raw_error"] < 1


def test_table_for_people(folder: Path) -> None:
    output = json.loads((folder / "told.json").read_text())
    sizes = {name: output[name] for name in ("source_vertices", "target_vertices")}
    file = io.StringIO()
    Console(width=200, file=file).print(_table(output["shape"], sizes, output["methods"]))
    shown = file.getvalue()
    assert "two poses: 1,500 and 1,200 vertices" in shown
    rows = [line for line in shown.splitlines() if "landmarks " in line]
    for line, row in zip(rows, output["methods"], strict=True):
        assert row["method"] in line
        for error in filter(None, (row["error"], row["raw_error"])):  # a search has no fit alone
            assert f"{100 * error:.2f}" in line


def test_picture(folder: Path) -> None:
    """Three panels with something in each; it is not replaced."""
    before = (folder / "demo.png").read_bytes()
    assert "--force" in run("demo", "-o", folder / "demo.png").error
    assert (folder / "demo.png").read_bytes() == before
    picture = imread(folder / "demo.png")[..., :3]
    height, width = picture.shape[:2]
    assert width > 1.5 * height
    for i in range(3):
        panel = picture[height // 4 : 3 * height // 4, i * width // 4 + width // 16 : i * width // 4 + width // 5]
        assert panel.std() > 0.05 if i < 2 else panel.std() > 0.005


@pytest.mark.parametrize(
    ("words", "output"),
    [
        (["--shape", "cube"], ", ".join(_SHAPES)),
        (["--vertices", "10"], "1500 to 300000"),
        (["-o", "demo.bmp"], ".png"),
        (["--landmarks", "0"], "--landmarks"),
    ],
)
def test_refused(words: list[str], output: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert output in run("demo", *words).error.replace("'", "")
    assert list(tmp_path.iterdir()) == []


def test_shapes_to_try_the_other_commands_on(tmp_path: Path) -> None:
    ran = run("demo", "--write", tmp_path / "new", "--vertices", "1500", "--landmarks", "4")
    assert ran.status == 0, ran.stderr
    assert [Path(line).name for line in ran.stdout.split()] == ["a.ply", "b.ply", "a.vts", "b.vts", "pairs.txt"]
    true = dict(
        zip(read_vertex_numbers(tmp_path / "new/b.vts"), read_vertex_numbers(tmp_path / "new/a.vts"), strict=True)
    )
    assert len(true) == len(read_mesh(tmp_path / "new/b.ply").vertices)
    for source, target in read_landmarks(tmp_path / "new/pairs.txt"):
        assert true[target] == source
    assert "--force" in run("demo", "--write", tmp_path / "new", "--vertices", "1500").error
