"""``-`` for standard input and output."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import numpy as np
import pytest

from commandline import SMALL, Ran, run, shapes
from kfmaps.cli.streams import content_suffix
from kfmaps.io import read_mesh, write_mesh


def piped(monkeypatch: pytest.MonkeyPatch, data: bytes, *words: object) -> Ran:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))
    return run(*words)


@pytest.mark.parametrize("suffix", [".ply", ".off", ".obj", ".glb"])
def test_meshes_are_told_apart_by_their_content(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str) -> None:
    mesh = read_mesh(shapes(tmp_path).source)
    path = tmp_path / f"mesh{suffix}"
    write_mesh(path, mesh)
    assert content_suffix(path.read_bytes()) == suffix
    output = piped(monkeypatch, path.read_bytes(), "info", "-", "--json")
    assert output.status == 0
    assert '"vertices": 300' in output.stdout


@pytest.mark.parametrize(
    ("data", "suffix"),
    [
        (b"COFF\n1 0 0", ".off"),
        (b"# made by hand\nmtllib a.mtl\nv 0 0 0\n", ".obj"),
        (b"# vtk DataFile Version 3.0\n", ".vtk"),
        (b'<?xml version="1.0"?>', ".vtp"),
        (b"solid cube\n", ".stl"),
        (b"\x93NUMPY\x01", ".npy"),
        (b'{"markups": []}', ".mrk.json"),
        (b"# Markups fiducial file version = 4.11\n", ".fcsv"),
        (b"name,x,y,z\n", ".csv"),
        (b"# source, target\n1 2\n", ".txt"),
        (b"1\n2\n", ".txt"),
    ],
)
def test_formats_are_told_apart(data: bytes, suffix: str) -> None:
    assert content_suffix(data) == suffix


def test_a_map_goes_through_pipes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A mesh in, a map out; the map in, values out. What people read goes to standard error."""
    found = shapes(tmp_path)
    options = ["--landmarks", found.landmarks, "--preset", "single-fit", *SMALL]
    output = piped(monkeypatch, found.source.read_bytes(), "match", "-", found.target, *options, "-o", "-")
    assert output.status == 0
    np.testing.assert_array_equal(np.array(output.stdout.split(), dtype=int), found.truth)
    assert "verdict" in output.stderr
    values = tmp_path / "values.txt"
    values.write_text("".join(f"{i}\n" for i in range(300)))
    output = piped(monkeypatch, output.stdout.encode(), "transfer", "-", values, "-o", "-.txt")
    np.testing.assert_array_equal(np.array(output.stdout.split(), dtype=int), found.truth)


def test_settings_go_through_pipes(monkeypatch: pytest.MonkeyPatch) -> None:
    text = run("config", "--kernel", "linear", "-o", "-").stdout
    assert piped(monkeypatch, text.encode(), "config", "--config", "-").stdout == text


@pytest.mark.parametrize(
    ("words", "data", "output"),
    [
        (["match", "-", "-"], b"OFF", "standard input: expected one file, got 2 times -. Name the other files."),
        (["info", "-"], b"", "standard input: expected a file, got nothing. Send one, or name it."),
        (["batch", "a", "-o", "-"], b"", "output -: expected a folder or a file with a name, got standard output."),
    ],
)
def test_streams_refuse_what_needs_files(
    monkeypatch: pytest.MonkeyPatch, words: list[str], data: bytes, output: str
) -> None:
    assert output in piped(monkeypatch, data, *words).error


def test_a_number_is_no_stream() -> None:
    """``--from -.5 0 1`` is a direction."""
    assert "nothing there" in run("render", "pair", "m.npz", "-o", "a.png", "--from", "-.5", "0", "1").error
