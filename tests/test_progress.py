"""What a long computation says while it goes on, where there is a terminal and where there is none."""

from __future__ import annotations

import sys
import threading
import types
from dataclasses import replace

import numpy as np
import pytest

from collecting import CONFIG
from conftest import blob
from kfmaps.batch.progress import RunReport, RunStatus
from kfmaps.batch.results import Result
from kfmaps.cli.progress import Lines, Stages, _bars_html, _Notebook, stage_line
from kfmaps.shape import prepare


def test_remaining_time_follows_from_the_finished_share() -> None:
    """A quarter done in ten seconds leaves thirty; nothing done leaves what such a stage took before."""
    assert stage_line("solve", 0, 10) == "solve: 10 s so far"
    assert stage_line("solve", 0, 10, before=25) == "solve: 10 s so far, about 15 s left"
    assert stage_line("solve", 0, 30, before=25) == "solve: 30 s so far"
    assert stage_line("candidates", 0.25, 10) == "candidates: 25 % done, 10 s so far, about 30 s left"
    assert stage_line("energy", 0, 400) == "energy: 7 min so far"


def test_a_long_stage_is_told_of_without_a_terminal(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also one that reports nothing itself; its twin on the other shape is expected to last as long."""
    clock = [0.0]
    monkeypatch.setattr("kfmaps.cli.progress.time", types.SimpleNamespace(monotonic=lambda: clock[0]))
    said = ""

    def wait_for(text: str) -> None:
        nonlocal said
        for _ in range(1000):
            said += capsys.readouterr().err
            if text in said:
                return
            threading.Event().wait(0.01)
        raise AssertionError(f"{text!r} is not in {said!r}")

    lines = Lines(silence=0.1)
    lines.update("eigenfunctions of source", 0)
    clock[0] = 40
    wait_for("eigenfunctions of source: 40 s so far\n")
    lines.update("eigenfunctions of source", 1)
    lines.update("eigenfunctions of target", 0)
    clock[0] = 50
    wait_for("eigenfunctions of target: 10 s so far, about 30 s left\n")
    lines.close()
    assert said.splitlines()[1] == "eigenfunctions of source: 40.00 s"
    assert len(said.splitlines()) == 3


def test_a_terminal_has_a_bar_for_each_stage(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Names of shapes are shown as they are, and the bars' own control sequences reach the terminal."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    with Stages() as stages:
        for done in (0.0, 0.5, 1.0, 0.0, 1.0):
            stages("SHOT of a[b]\x07", done)
    output = capsys.readouterr().err
    assert "SHOT of a[b]" in output
    assert "\x1b[" in output
    assert "\x07" not in output
    assert "\\x1b" not in output


def test_a_collection_on_a_terminal_has_bars_and_tells_failures_above_them(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "150")
    failed = Result("a", "b", "failed", "", "", reason="no triangles")
    with RunReport(quiet=False) as report:
        report.stage("likeness of shapes", 2, 2)
        report.status(RunStatus(2, 2, 1, 1, 3, 1, 40.0, 1), failed)
        report.status(RunStatus(2, 2, 3, 1, 3, 1, 0.0, 3), None)
    output = capsys.readouterr().out
    assert "failed: a → b: no triangles" in output
    for text in ("likeness of shapes", "2/2", "pairs", "3/3", "1 failed, finished"):
        assert text in output, text
    assert "3/3 (1 failed)" not in output  # that is for files, which have no bars


def test_short_stages_are_a_line_each_and_nothing_where_all_is_quiet(capsys: pytest.CaptureFixture[str]) -> None:
    for quiet, said in ((True, []), (False, ["descriptors", "solve"])):
        with Stages(quiet) as stages:
            for name in ("descriptors", "solve"):
                stages(name, 0.0)
                stages(name, 1.0)
        assert [line.partition(":")[0] for line in capsys.readouterr().err.splitlines()] == said


def test_a_notebook_gets_bars_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []
    handle = types.SimpleNamespace(update=shown.append)
    display = types.ModuleType("IPython.display")
    display.HTML = str  # pyright: ignore[reportAttributeAccessIssue]
    display.display = lambda *_, **__: handle  # pyright: ignore[reportAttributeAccessIssue]
    monkeypatch.setitem(sys.modules, "IPython", types.ModuleType("IPython"))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    notebook = _Notebook()
    notebook.update("a<b", 0.0)
    notebook.update("a<b", 1.0)
    notebook.close()
    assert 'value="1.000"' in shown[-1]
    assert "a&lt;b" in shown[-1]
    assert "about 30 s left" in _bars_html({"solve": (0.25, 10.0)})


def test_the_long_stages_of_a_shape_tell_how_far_they_are() -> None:
    """Eigenfunctions and SHOT: never back, to the end, and without a trace in what is computed."""
    config = replace(CONFIG, descriptors=replace(CONFIG.descriptors, shot=True))
    output: dict[str, list[float]] = {}
    mesh = blob(600)
    shape = prepare(mesh, config, name="it", progress=lambda stage, done: output.setdefault(stage, []).append(done))
    assert set(output) == {"eigenfunctions of it", "SHOT of it"}
    for stages in output.values():
        assert stages[0] == 0
        assert stages[-1] == 1
        assert stages == sorted(stages)
        assert len(stages) >= 5
    silent = prepare(mesh, config)
    np.testing.assert_array_equal(shape.basis.functions, silent.basis.functions)
    assert shape.shot is not None
    assert silent.shot is not None
    np.testing.assert_array_equal(shape.shot, silent.shot)
