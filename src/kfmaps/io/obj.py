"""Wavefront OBJ: vertices with colours, texture coordinates, polygons, and the picture of the materials."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile, Picture, fan, has_too_few_corners, picture_in, unit_colors
from kfmaps.io.text import (
    REPAIR,
    Rows,
    as_table,
    check_lines,
    clean_text,
    is_number,
    parse_rows,
    quoted,
    read_bytes,
    relative_file,
    split_words,
    whole_numbers,
)

_SKIPPED = frozenset(
    b"# vn vp p l o g s mg usemtl mtllib usemap maplib bevel c_interp d_interp lod shadow_obj trace_obj ctech "
    b"stech cstype deg bmat step curv curv2 surf parm trim hole scrv sp end con call csh".split()
)
"""Words of the format that say nothing about a polygon mesh."""

MATERIAL = "carried"
"""Name of the material in the files that are written."""


@dataclass
class _Lines:
    """The lines that begin with the same word."""

    contents: list[bytes] = field(default_factory=list)  # what stands behind the word
    numbers: list[int] = field(default_factory=list)  # in the file, from 1


def parse_obj(data: bytes, name: str) -> MeshFile:
    """Read the ``v``, ``vt`` and ``f`` lines.

    A vertex is ``v x y z``, perhaps with a weight of 1, or ``v x y z red green blue``; vertices have colours only when
    all of them do. A corner of a face is ``v``, ``v/vt``, ``v//vn`` or ``v/vt/vn``, counted from 1, or backwards from
    the last one read when negative. Texture coordinates are kept when every corner has them, and then the picture of
    the materials.
    """
    text = clean_text(data, name).replace(b"\\\n", b"  ")  # after a backslash the line goes on
    lines = {word: _Lines() for word in (b"v", b"vt", b"f")}
    vertices, texture, faces = lines.values()
    counts_before: list[tuple[int, int]] = []  # of each face: vertices and texture coordinates read so far
    material_lines: list[tuple[int, str, str]] = []
    for number, line in enumerate(text.split(b"\n"), 1):
        word, *rest = line.split(None, 1) or [b"#"]
        group = lines.get(word)
        if group is not None:
            group.contents.append(rest[0] if rest else b"")
            group.numbers.append(number)
            if group is faces:
                counts_before.append((len(vertices.numbers), len(texture.numbers)))
        elif word in (b"mtllib", b"usemtl"):
            material_lines.append((number, word.decode(), b"".join(rest).strip().decode("utf-8", "replace")))
        elif word not in _SKIPPED:
            raise refuse(f"{name}, line {number}", "a word of the OBJ format", quoted(word), REPAIR)

    positions, colors = _vertices(_numbers(vertices, name, "v x y z"), name)
    uv = as_table(_numbers(texture, name, "vt u v"), (2, 3), name, "vt u v")[:, :2].copy()
    sizes, numbers = _corners(faces, name)
    triangles, face_lines, counts = fan(sizes), np.array(faces.numbers), np.array(counts_before).reshape(-1, 2)

    def absolute(column: int, total: int) -> np.ndarray:
        so_far = np.repeat(counts[:, column], sizes)
        return _absolute(numbers[:, column], so_far, total, np.repeat(face_lines, sizes), name)[triangles]

    mesh = Mesh(positions, absolute(0, len(positions)))
    if len(numbers) == 0 or (numbers[:, 1] == 0).any():
        return MeshFile(mesh, colors)
    return MeshFile(mesh, colors, uv, absolute(1, len(uv)), _picture(material_lines, face_lines, name))


def _numbers(lines: _Lines, name: str, expected: str) -> Rows:
    """Return the numbers of lines; a line without any is refused."""
    at = np.array(lines.numbers, dtype=np.int64)
    rows = parse_rows(b"\n".join(lines.contents), name, at)
    check_lines(~np.isin(at, rows.lines), at, name, expected, lambda _: "no numbers")
    return rows


def _vertices(rows: Rows, name: str) -> tuple[np.ndarray, np.ndarray | None]:
    """Positions (n, 3), and colours (n, 3) when every vertex has them."""
    bad_counts = ~np.isin(rows.counts, (3, 4, 6, 7))
    check_lines(bad_counts, rows.lines, name, "v x y z, or v x y z r g b", lambda i: f"{rows.counts[i]} numbers")
    weight = rows.values[rows.starts[rows.counts == 4] + 3]
    if (weight != 1).any():
        got = f"{weight[weight != 1][0]:g}"
        raise refuse(f"{name}: weight of a vertex", "1, as polygons have", got, "divide x, y and z by it")
    places = rows.values[rows.starts[:, None] + np.arange(3)]
    if rows.counts.min(initial=7) < 6 or len(rows) == 0:
        return places, None
    return places, unit_colors(rows.values[rows.starts[:, None] + np.arange(3, 6)])


def _corners(lines: _Lines, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return how many corners each face has, and (corners, 2) vertex and texture numbers (0: none)."""
    body, numbers = b"\n".join(lines.contents), np.array(lines.numbers, dtype=np.int64)
    at, line = split_words(body)
    sizes = np.bincount(line, minlength=len(numbers))[: len(numbers)]
    too_few = has_too_few_corners(sizes, name)
    check_lines(too_few, numbers, name, "a face with three corners or more", lambda i: str(sizes[i]))
    slash = np.flatnonzero(np.frombuffer(body, dtype=np.uint8) == ord("/"))
    slashes = np.bincount(np.searchsorted(at, slash, side="right") - 1, minlength=len(at))
    rows = parse_rows(body.replace(b"//", b"/0/").replace(b"/", b" "), name, numbers)
    # A word with s slashes gives s + 1 numbers, or fewer when one is missing, never more.
    if slashes.max(initial=0) > 2 or len(rows.values) != len(at) + len(slash):
        raise refuse(f"{name}: faces", "corners like 1, 1/2, 1//3 or 1/2/3", "others", REPAIR)
    values = whole_numbers(rows.values, f"{name}: faces", "whole vertex numbers")
    first = np.cumsum(slashes + 1) - (slashes + 1)
    second = np.where(slashes > 0, values[np.minimum(first + 1, len(values) - 1)], 0)
    return sizes, np.stack([values[first], second], axis=1)


def _absolute(numbers: np.ndarray, before: np.ndarray, total: int, face_lines: np.ndarray, name: str) -> np.ndarray:
    """Return 0-based numbers; those in the file count from 1, or backwards from the ``before`` that were read."""
    result = np.where(numbers > 0, numbers - 1, before + numbers)
    bad = (numbers == 0) | (result < 0) | (result >= total)
    expected = f"numbers from 1 to {total}, or negative ones counted back from the last"
    check_lines(bad, face_lines, name, expected, lambda i: str(numbers[i]))
    return result


def _picture(material_lines: list[tuple[int, str, str]], faces: np.ndarray, name: str) -> Picture | None:
    """Return the one colour texture (``map_Kd``) of all faces, from an MTL file beside the OBJ file; else ``None``.

    The shape can be read without its texture. So there is also none where a file is missing, lies outside the folder of
    the OBJ file, or is no PNG or JPEG, and where the material moves or scales the picture. Specification:
    Alias/Wavefront, "MTL material format", 1995.

    ``material_lines``: number, word and rest of the lines ``mtllib`` and ``usemtl``; ``faces (p,)``: line of each face.
    """
    used = [(line, rest) for line, word, rest in material_lines if word == "usemtl"]
    if not used or len(faces) == 0:
        return None
    material_of_face = np.searchsorted([line for line, _ in used], faces) - 1
    if material_of_face.min() < 0:
        return None  # faces before any material
    pictures: dict[str, str | None] = {}
    for _, word, rest in material_lines:
        if word == "mtllib":
            for path in _libraries(rest, name):
                pictures |= _read_materials(read_bytes(path).decode("utf-8", "replace"))
    names = {pictures.get(used[i][1]) for i in np.unique(material_of_face)}
    picture = names.pop() if len(names) == 1 else None
    path = None if picture is None else _file(picture, name)
    return None if path is None else picture_in(read_bytes(path))


def _read_materials(text: str) -> dict[str, str | None]:
    """Return the picture that each material of an MTL file names; ``None`` for one without or with a changed one."""
    pictures: dict[str, str | None] = {}
    current = None
    for line in text.splitlines():
        word, _, rest = line.strip().replace("\t", " ").partition(" ")
        rest = rest.strip()
        if word == "newmtl":
            current = rest
            pictures.setdefault(current, None)
        elif word.lower() == "map_kd" and current is not None:
            pictures[current] = _plain(rest)
    return pictures


_OPTION = re.compile(r"(-[ost])((?:\s+[-+.\deE]+){1,3})\s+|-mm\s+\S+\s+\S+\s+|-\w+\s+\S+\s+")
"""An option of a map with its values: three move, scale or disturb the picture, with up to three numbers."""


def _plain(rest: str) -> str | None:
    """Return the file of a texture map, after its options; ``None`` where these move or scale the picture."""
    while option := _OPTION.match(rest):
        neutral = 1.0 if option[1] == "-s" else 0.0
        if option[1] and any(float(value) != neutral for value in option[2].split() if is_number(value)):
            return None
        rest = rest[option.end() :]
    return rest or None


def _libraries(rest: str, name: str) -> list[Path]:
    """Return the files of a line ``mtllib``: one file whose name may have spaces, or several files."""
    single = _file(rest, name)
    return [single] if single else [path for word in rest.split() if (path := _file(word, name))]


def _file(address: str, name: str) -> Path | None:
    """Return the file of a relative name in the folder of ``name`` or below it; ``None`` where there is none."""
    path = relative_file(address.replace("\\", "/"), name)
    return path if path is not None and path.is_file() and path.stat().st_size else None


def format_obj(shape: MeshFile, material: str = "") -> bytes:
    """Write a mesh with its colours and texture coordinates as OBJ; every digit is kept.

    Colours stand after the coordinates, as many programs read them. ``material``: the name of an MTL file, whose one
    material, :data:`MATERIAL`, all faces use.
    """
    mesh, uv, uv_faces = shape.mesh, shape.uv, shape.uv_faces
    lines = [f"mtllib {material}"] if material else []
    values = mesh.vertices if shape.colors is None else np.hstack([mesh.vertices, shape.colors])
    lines += ["v " + " ".join(map(repr, row)) for row in values.tolist()]
    if uv is not None:
        lines += [f"vt {u!r} {v!r}" for u, v in uv.tolist()]
    if material:
        lines.append(f"usemtl {MATERIAL}")
    faces = (mesh.faces + 1).tolist()
    if uv is None or uv_faces is None:
        lines += [f"f {a} {b} {c}" for a, b, c in faces]
    else:
        pairs = zip(faces, (uv_faces + 1).tolist(), strict=True)
        lines += [f"f {a}/{i} {b}/{j} {c}/{k}" for (a, b, c), (i, j, k) in pairs]
    return ("\n".join(lines) + "\n").encode()
