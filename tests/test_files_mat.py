"""Reading .mat files of every kind, and damaged ones."""

from __future__ import annotations

import io
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from conftest import refusal
from kfmaps.io import load_map
from kfmaps.io.matfile import read_mat

MATLAB = {
    "double": np.array([[1.5, 2], [3, 4]]),
    "single": np.array([[1.5, 2, 3]], dtype=np.float32),
    "logical": np.array([[True, False]]),
    "text": "héllo γ",
    "empty": np.zeros((0, 3)),
    **{f"x{np.dtype(t).name}": np.array([[1, 2], [3, 4]], dtype=t) for t in "bBhHiIlL"},
}


@pytest.mark.parametrize("compressed", [True, False])
def test_mat_files_of_every_kind(compressed: bool) -> None:
    file = io.BytesIO()
    left_out = {"cells": np.array([[1, "a"]], dtype=object), "complex": np.array([1j])}
    scipy.io.savemat(file, MATLAB | left_out, do_compression=compressed)
    found = read_mat(file.getvalue(), "a.mat")
    assert set(found) == set(MATLAB)
    for name, value in MATLAB.items():
        np.testing.assert_array_equal(found[name], value)
    expected = scipy.io.loadmat(io.BytesIO(file.getvalue()))
    for name, value in found.items():
        assert isinstance(value, str) or value.shape == expected[name].shape


def element(kind: int, body: bytes) -> bytes:
    return struct.pack("<II", kind, len(body)) + body + bytes(-len(body) % 8)


def matrix(
    shape: tuple[int, ...] = (1, 2),
    kind: int = 9,
    body: bytes | None = None,
    flags: tuple[int, ...] = (6, 0),
    shape_kind: int = 5,
) -> bytes:
    """A variable target_to_source; the defaults make a good one that holds 3 and 1."""
    parts = element(6, struct.pack(f"<{len(flags)}I", *flags))
    parts += element(shape_kind, struct.pack(f"<{len(shape)}i", *shape))
    parts += element(1, b"target_to_source")
    return element(14, parts + element(kind, struct.pack("<2d", 3, 1) if body is None else body))


HEAD = bytes(124) + b"\0\1"


def test_mat_text_as_matlab_writes_it() -> None:
    data = HEAD + b"IM" + matrix(flags=(4, 0), kind=17, body="γü".encode("utf-16-le"))
    assert read_mat(data, "a.mat") == {"target_to_source": "γü"}


@pytest.mark.parametrize(
    ("content", "part"),
    [
        (b"MATLAB 7.3 MAT-file" + bytes(200), "-v7"),
        (b"\x89HDF\r\n", "-v7"),
        (b"hello", "Check the extension"),
        (HEAD + b"IM", "target_to_source"),
        (HEAD + b"IM" + bytes(4), "cut short or damaged"),
        (HEAD + b"IM" + element(9, bytes(8)), "cut short or damaged"),
        (HEAD + b"IM" + element(15, b"hello"), "cut short or damaged"),
        (HEAD + b"IM" + element(15, zlib.compress(matrix())[:-6]), "cut short or damaged"),
        (HEAD + b"IM" + element(14, b""), "cut short or damaged"),
        (HEAD + b"IM" + matrix(shape=(1, 3)), "cut short or damaged"),
        (HEAD + b"IM" + matrix(shape=(-1, -2)), "cut short or damaged"),
        (HEAD + b"IM" + matrix(shape=(2**30, 2**30)), "cut short or damaged"),
        (HEAD + b"IM" + matrix(shape=(2,)), "cut short or damaged"),
        (HEAD + b"IM" + matrix(kind=99), "cut short or damaged"),
        (HEAD + b"IM" + matrix(flags=(6,)), "cut short or damaged"),
        (HEAD + b"IM" + matrix(shape_kind=6), "cut short or damaged"),
        (HEAD + b"IM" + matrix(flags=(4, 0)), "cut short or damaged"),
        (HEAD + b"IM" + matrix(flags=(4, 0), kind=16, body=b"\xff"), "cut short or damaged"),
        (HEAD + b"IM" + matrix(flags=(4, 0), kind=16, body=b"12"), "an array of numbers"),
        (HEAD + b"IM" + matrix(body=struct.pack("<2d", 0, 1)), "numbers from 1 on, -1 for none, got 0"),
        (HEAD + b"IM" + matrix(shape=(1, 16), kind=2, body=bytes(16)), "numbers from 1 on, -1 for none, got 0"),
    ],
)
def test_bad_mat(tmp_path: Path, content: bytes, part: str) -> None:
    assert part in refusal(load_map, tmp_path / "m.mat", content)
