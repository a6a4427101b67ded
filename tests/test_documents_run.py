"""The lines of the pages for users run as they stand, on what ``demo --write`` makes, and so do the examples."""

from __future__ import annotations

import ast
import re
import runpy
import shlex
import shutil
import warnings
import webbrowser
from dataclasses import replace
from glob import glob
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot

import kfmaps
from commandline import run
from kfmaps.config import Config
from kfmaps.matching import match as match_module
from kfmaps.matching.result_groups import MatchScore
from kfmaps.viz.server import LocalServer

GUARDS = ("kfmaps.matching.match",)

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
ELSEWHERE = ("import bpy", "--morph", "pip install", "part.npz", ".xyz", "hero.glb")
"""Words of blocks that need another program, or files that are not there."""
PAGES = sorted(page for page in DOCS.glob("*.md") if re.search(r"^(```python|kfmaps )", page.read_text(), re.MULTILINE))
EXAMPLES = sorted((ROOT / "examples").glob("plot_*.py"))
OWN_TESTS = ("index", "settings", "extend", "learning", "collections", "cluster", "skulls")
PAGES = [page for page in PAGES if page.stem not in OWN_TESTS]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    assert run("demo", "--write", folder, "--vertices", "1500").status == 0
    return folder


@pytest.fixture(scope="module")
def answer(made: Path) -> match_module.Match:
    """A map between the two shapes, quickly made: what is tried is the lines, not the map."""
    config = replace(
        Config.single_fit(),
        basis=kfmaps.BasisConfig(20),
        descriptors=kfmaps.DescriptorConfig(20, n_eigenfunctions=40, shot=False),
        refinement=None,
    )
    pair = [kfmaps.read_mesh(made / name) for name in ("a.ply", "b.ply")]
    found = match_module.match(pair[0], pair[1], config, landmarks=kfmaps.read_landmarks(made / "pairs.txt"))
    rng = np.random.default_rng(0)
    coarse = np.where(rng.random(len(found.target_to_source)) < 0.1, 0, found.target_to_source)
    return replace(found, verdict="ambiguous", confidence=0.4, score=MatchScore((-1.0, -1.1)), alternatives=(coarse,))


@pytest.fixture
def place(made: Path, answer: match_module.Match, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the shapes, in which a match is the one that is made already and no browser opens."""
    for path in made.iterdir():
        shutil.copy(path, tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(match_module, "match", lambda *_, **__: answer)
    monkeypatch.setattr(webbrowser, "open", lambda _: True)
    monkeypatch.setattr(LocalServer, "serve_forever", lambda *_, **__: None)
    return tmp_path


def blocks(text: str) -> list[tuple[str, str]]:
    """The fenced blocks of a page: their language, and what is in them."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def commands(block: str) -> list[list[str]]:
    """The lines of a block that call the command, as words, without comments."""
    lines = [line for line in block.replace("\\\n", " ").splitlines() if line.startswith("kfmaps ")]
    return [shlex.split(line, comments=True)[1:] for line in lines]


def tried(text: str, name: str) -> int:
    """How many commands and blocks of Python of a page have been run, one after the other."""
    names: dict[str, Any] = {"__name__": "__main__"}
    ran = 0
    for language, block in blocks(text):
        if language == "python":
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
                exec(compile(block, name, "exec"), names)
            ran += 1
        elif not any(word in block for word in ELSEWHERE):
            for words in commands(block):
                small = ["--vertices", "1500"] if words[0] == "demo" else []
                expanded = [name for word in words for name in (sorted(glob(word)) if "*" in word else [word])]
                done = run(*expanded, *small)
                assert done.status == 0, (words, done.stderr)
                ran += 1
    return ran


@pytest.mark.usefixtures("place")
@pytest.mark.parametrize("page", PAGES, ids=[page.stem for page in PAGES])
def test_lines_of_a_page_run(page: Path) -> None:
    assert tried(page.read_text(encoding="utf-8"), page.name) >= 1


def test_extensions_run(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for path in made.iterdir():
        shutil.copy(path, tmp_path)
    monkeypatch.chdir(tmp_path)
    assert tried((DOCS / "extend.md").read_text(encoding="utf-8"), "extend.md") >= 3


def test_lines_of_readme_run(place: Path) -> None:
    for path in place.iterdir():
        path.unlink()
    assert tried((ROOT / "README.md").read_text(encoding="utf-8"), "README.md") >= 5


def test_first_map_page(place: Path) -> None:
    """The table of what to do next: each command, in its order."""
    (place / "labels.txt").write_text("1\n" * 1500)
    text = (ROOT / "docs" / "first-map.md").read_text(encoding="utf-8")
    assert run("match", "a.ply", "b.ply").status == 0
    table = [shlex.split(words)[1:] for words in re.findall(r"^\| [^|]+\| `(kfmaps [^`]+)`", text, re.MULTILINE)]
    assert len(table) >= 5
    for words in table:
        done = run(*words)
        assert done.status == 0, (words, done.stderr)


def test_every_page_is_in_a_table_of_contents() -> None:
    contents = "".join((DOCS / f"{name}.md").read_text(encoding="utf-8") for name in ("index", "guide", "background"))
    for page in DOCS.glob("*.md"):
        assert page.stem == "index" or f"\n{page.stem}\n" in contents, page.stem


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_and_ends_in_a_checked_number(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    last = ast.parse(text).body[-1]
    assert isinstance(last, ast.Assert)
    assert any(isinstance(part, ast.Compare) for part in ast.walk(last.test))
    if "kfmaps.learn" in text:
        pytest.importorskip("torch")
    pyplot.switch_backend("agg")
    assert runpy.run_path(str(path))["__doc__"]
    pyplot.close("all")
