"""Every reader takes steps linear in the size of its file, whatever is repeated in it."""

from __future__ import annotations

import json
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

import kfmaps.io
from kfmaps._arrays import InvalidInput
from kfmaps.io import load_map, read_landmarks, read_mesh, read_values, read_vertex_numbers

pytestmark = pytest.mark.timeout(120)

READERS = str(Path(kfmaps.io.__file__).parent)
BYTES = 1_500
"""Of the smaller of two files whose steps are counted."""
LARGE = 60_000
"""Bytes at which an expression that backtracks does not end within the time of a test."""

HEADS = {
    ".off": (b"", b"OFF ", b"OFF\n3 1 0\n"),
    ".obj": (b"", b"v ", b"f "),
    ".ply": (b"", b"ply\n", b"ply\nformat ascii 1.0\n", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"),
    ".stl": (b"", b"solid ", b"solid\n", b"solid\nfacet normal "),
    ".xyz": (b"",),
    ".gltf": (b"", b'{"asset": '),
    ".glb": (b"glTF\2\0\0\0",),
}
PIECES = (
    *(b" ", b"\n", b"\r\n", b"\r", b"\t\n", b"#", b"#\n", b"# \n", b"1", b"1 ", b"1\n", b"-", b".", b"1.", b"e", b"x"),
    *(b"\\\n", b"/", b"//", b"1//1 ", b"v 1 2 3\n", b"f 1 2 3\n", b"f -1 -1 -1\n", b"vt 1 1\n", b"v\n", b"usemtl a\n"),
    *(b"solid\n", b"endsolid\n", b"endsolid solid solid\n", b"solid\nendsolid\n", b"facet normal ", b"facet "),
    *(b"facet normal 0 0 1\nouter loop\nvertex 1 1 1\nvertex 1 1 1\nvertex 1 1 1\nendloop\nendfacet\n", b"vertex "),
    *(b"comment\n", b"end_header", b"end_header ", b"property float x\n", b"element vertex 1\n", b"ply\n", b"STOFF "),
    *(b"[", b'{"a":', b'"', b"\\", b"3 0 1 2\n", b"OFF\n", b"nan ", b"0x", b"\xff", b"\xef\xbb\xbf", b"999999999999 "),
)  # fmt: skip


def steps(read: Callable[[Path], object], path: Path, content: bytes) -> int:
    """How many lines of the readers run, whatever comes of it."""
    path.write_bytes(content)
    count = 0

    def within(frame: FrameType, event: str, _: object) -> Any:
        nonlocal count
        count += event == "line"
        return within if frame.f_code.co_filename.startswith(READERS) else None

    before = sys.gettrace()
    sys.settrace(within)
    try:
        with warnings.catch_warnings(), suppress(InvalidInput):
            warnings.simplefilter("ignore")
            read(path)
    finally:
        sys.settrace(before)
    return count


def check_linear(read: Callable[[Path], object], path: Path, content: Callable[[int], bytes], name: object) -> None:
    """Twice the size takes at most about twice the steps; a large file is read too, which must end."""
    small, large = (steps(read, path, content(size)) for size in (BYTES, 2 * BYTES))
    assert large < 2.5 * small + 100, f"{path.suffix}: {small} steps, {large} for twice as much of {name!r}"
    path.write_bytes(content(LARGE))
    with warnings.catch_warnings(), suppress(InvalidInput):
        warnings.simplefilter("ignore")
        read(path)


def repeated(head: bytes, piece: bytes) -> Callable[[int], bytes]:
    """``piece`` again and again, and where it is one letter another one last, which spoils what matched until then."""
    return lambda size: head + piece * (size // len(piece)) + (b"x" if len(piece) == 1 else b"")


@pytest.mark.parametrize("suffix", HEADS)
def test_meshes_of_one_thing_again_and_again(tmp_path: Path, suffix: str) -> None:
    for head in HEADS[suffix]:
        for piece in PIECES:
            check_linear(read_mesh, tmp_path / f"a{suffix}", repeated(head, piece), (head, piece))


TEXTS = {
    ".csv": read_values,
    ".txt": read_values,
    ".npy": read_values,
    ".vts": read_vertex_numbers,
    ".landmarks": read_landmarks,
    ".npz": load_map,
    ".mat": load_map,
}


@pytest.mark.parametrize("suffix", TEXTS)
def test_other_files_of_one_thing_again_and_again(tmp_path: Path, suffix: str) -> None:
    heads = {".npy": b"\x93NUMPY\x01\x00", ".npz": b"PK\x03\x04", ".mat": b"MATLAB 5.0".ljust(126) + b"IM"}
    for piece in (*PIECES, b",", b'","', b"1,", b"1,1\n", b"(", b"PK\x01\x02", b"\x0e\0\0\0\x08\0\0\0", b"\0"):
        head = heads.get(suffix, b"")
        check_linear(TEXTS[suffix], tmp_path / f"a{suffix}", repeated(head, piece), (head, piece))


def ply(kind: str, rows: int, lines: Callable[[int], str], body: bytes) -> Callable[[int], bytes]:
    """A PLY file of ``lines(0)``, ``lines(1)``, ... with ``body`` for each."""

    def content(size: int) -> bytes:
        count = size // len(lines(9999))
        first = f"ply\nformat {kind} 1.0\nelement vertex {rows}\nproperty char x\nproperty char y\nproperty char z\n"
        head = first + "".join(map(lines, range(count))) + "end_header\n"
        row = b"1 1 1\n" if kind == "ascii" else b"\1\1\1"
        return head.encode() + row * rows + body * count

    return content


PLY = {
    "elements": ply("ascii", 3, lambda i: f"element e{i} 0\nproperty int a\n", b""),
    "elements of a row": ply("ascii", 3, lambda i: f"element e{i} 1\nproperty int a\n", b"1\n"),
    "binary elements": ply("binary_little_endian", 3, lambda i: f"element e{i} 1\nproperty int a\n", b"1234"),
    "properties": ply("ascii", 0, lambda i: f"property int a{i}\n", b""),
    "binary properties": ply("binary_little_endian", 1, lambda i: f"property int a{i}\n", b"1234"),
    "lists": ply("binary_little_endian", 1, lambda i: f"property list uchar int a{i}\n", b"\0"),
}


@pytest.mark.parametrize("name", PLY)
def test_ply_headers(tmp_path: Path, name: str) -> None:
    check_linear(read_mesh, tmp_path / "a.ply", PLY[name], name)


def lists_of_growing_length(size: int) -> bytes:
    """A binary PLY file whose rows have different lengths, so that they must be walked through."""
    rows = [bytes([3 + i % 5]) + bytes(3 + i % 5) for i in range(size // 6)]
    head = f"ply\nformat binary_little_endian 1.0\nelement face {len(rows)}\nproperty list uchar uchar vertex_indices\n"
    return head.encode() + b"end_header\n" + b"".join(rows)


def one_polygon(size: int) -> bytes:
    corners = " ".join(str(1 + i % 3) for i in range(size // 2))
    return f"v 0 0 0\nv 1 0 0\nv 0 1 0\nf {corners}\n".encode()


def test_polygons(tmp_path: Path) -> None:
    check_linear(read_mesh, tmp_path / "a.ply", lists_of_growing_length, "lists of different lengths")
    check_linear(read_mesh, tmp_path / "a.obj", one_polygon, "one large polygon")


def scene(kind: str) -> Callable[[int], bytes]:
    """A glTF file of many nodes: in a chain, beside each other, or none and many parts of one mesh."""

    def content(size: int) -> bytes:
        count = size // 60
        nodes = [{"mesh": i, "translation": [1, 0, 0]} for i in range(count)]
        if kind == "chain":
            for i, _ in pairwise(range(count)):
                nodes[i]["children"] = [i + 1]
        primitive = {"attributes": {"POSITION": 0}}
        tree = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": 36, "uri": "data:;base64," + 48 * "A"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
            "meshes": [{"primitives": [primitive]}] * count
            if kind != "parts"
            else [{"primitives": count * [primitive]}],
            "nodes": nodes if kind != "parts" else [{"mesh": 0}],
        }
        return json.dumps(tree).encode()

    return content


@pytest.mark.parametrize("kind", ["chain", "wide", "parts"])
def test_scenes(tmp_path: Path, kind: str) -> None:
    check_linear(read_mesh, tmp_path / "a.gltf", scene(kind), kind)
