"""The documentation of the public names: what ``help`` shows teaches, and its examples run."""

from __future__ import annotations

import doctest
import inspect
import warnings
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import kfmaps
from kfmaps import datasets

NAMES = [
    name
    for name in kfmaps.__all__
    if not isinstance(value := getattr(kfmaps, name), ModuleType)
    and not (inspect.isclass(value) and issubclass(value, Exception))
]


@pytest.mark.parametrize("name", NAMES)
def test_its_examples_run(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(datasets, "two_poses", cache(datasets.two_poses))
    value = getattr(kfmaps, name)
    text = inspect.getdoc(value) or ""
    test = doctest.DocTestParser().get_doctest(text, {"kfmaps": kfmaps, "np": np, "Path": Path}, name, None, 0)
    assert test.examples, f"{name} has no example"
    report: list[str] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
        doctest.DocTestRunner().run(test, out=report.append)
    assert report == []


@pytest.mark.parametrize("name", NAMES)
def test_its_sections_are_there(name: str) -> None:
    """A function has those for its arguments and its value, a record that for its fields, examples last."""
    value, text = getattr(kfmaps, name), inspect.getdoc(getattr(kfmaps, name)) or ""
    signature = inspect.signature(value)
    if inspect.isclass(value):
        assert ("\nAttributes\n" in text) == bool(signature.parameters)
    else:
        assert not signature.parameters or "\nParameters\n" in text
        assert str(signature.return_annotation) in ("None", "Iterator[None]") or "\nReturns\n" in text
    assert text.index("\nExamples\n") > max(text.rfind(f"\n{title}\n") for title in ("Attributes", "Raises", "Returns"))
