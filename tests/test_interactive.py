"""Matches run from the landmark page: shapes prepared once, with the settings of the command."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from collecting import CONFIG
from conftest import blob
from kfmaps.cli.main import main
from kfmaps.io import write_mesh
from kfmaps.viz.picker import InteractiveMatcher

MARKS = np.array([[3, 3], [50, 50], [120, 120], [9, 9]])


def test_shapes_are_prepared_once_and_the_settings_are_used() -> None:
    mesh = blob(300)
    config = replace(CONFIG, refinement=None)
    matcher = InteractiveMatcher((mesh, mesh), ("a", "b"), (Path("a.off"), Path("b.off")), config)
    stages: list[str] = []
    for marks in (MARKS, MARKS[:3]):
        found = matcher(marks, lambda stage, done: stages.append(stage) if done == 1 else None)
        np.testing.assert_array_equal(found.target_to_source, np.arange(300))
        np.testing.assert_array_equal(found.landmarks, marks)
        assert (found.n_source, found.source_file.path) == (300, str(Path("a.off").absolute()))
    assert [stages.count(f"eigenfunctions of {name}") for name in "ab"] == [1, 1]
    assert stages.count("descriptors") == 2
    assert "refinement" not in stages


def test_bad_settings_are_told_before_the_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("a.off", "b.off"):
        write_mesh(tmp_path / name, blob(100))
    words = [str(tmp_path / "a.off"), str(tmp_path / "b.off"), "-o", str(tmp_path / "p.txt"), "--no-browser"]
    assert main(["landmarks", *words, "--kernel", "cubic"]) == 2
    told = capsys.readouterr()
    assert "cubic" in told.err
    assert told.out == ""
