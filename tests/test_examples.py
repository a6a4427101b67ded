"""The examples of the documentation run, without a warning, and the numbers they end in hold."""

from __future__ import annotations

import ast
import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted((ROOT / "examples").glob("plot_*.py"))


@pytest.fixture(autouse=True)
def _no_windows():
    from matplotlib import pyplot

    pyplot.switch_backend("agg")
    yield
    pyplot.close("all")


def test_there_are_examples():
    assert len(EXAMPLES) >= 6


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example(path):
    if "kfmaps.learn" in path.read_text(encoding="utf-8"):
        pytest.importorskip("torch")
    names = runpy.run_path(str(path))
    assert names["__doc__"]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_ends_in_a_checked_number(path):
    last = ast.parse(path.read_text(encoding="utf-8")).body[-1]
    assert isinstance(last, ast.Assert)
    assert any(isinstance(part, ast.Compare) for part in ast.walk(last.test))
