"""OFF, the Object File Format of Geomview, with its colours, normals and texture coordinates."""

from __future__ import annotations

import re

import numpy as np

from kfmaps._arrays import index_ranges, refuse
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile, fan, has_too_few_corners, to_bytes, unit_colors
from kfmaps.io.text import REPAIR, Rows, as_table, check_lines, clean_text, parse_rows, quoted, whole_numbers

_HEADER = re.compile(rb"\s*(ST)?(C?N?|NC)(4?n?)OFF(?![A-Za-z])[ \t]*(BINARY)?", re.ASCII)


def parse_off(data: bytes, name: str) -> MeshFile:
    """Read OFF, COFF, NOFF, STOFF and their combinations.

    The counts may stand on the line of the word OFF. Each vertex has its line: x y z, then a normal (N), red green blue
    and perhaps alpha (C), texture coordinates (ST). Each face has its line: the number of its corners, the 0-based
    corners, and perhaps a colour, which is left out. Normals are left out too.
    """
    text = clean_text(data, name)
    header = _HEADER.match(text)
    if header is None:
        raise refuse(name, "the word OFF first", quoted(text.lstrip()[:16]), "check the extension")
    textured, kinds, dimensions, binary = header.groups()
    if dimensions or binary:
        got = "binary" if binary else "another dimension"
        raise refuse(name, "text OFF with x, y and z", got, "export it as plain OFF")
    rows = parse_rows(re.sub(rb"\S", b" ", text[: header.end()]) + text[header.end() :], name)
    if len(rows) == 0 or rows.counts[0] not in (2, 3):
        raise refuse(name, "the numbers of vertices, faces and edges after OFF", "none", REPAIR)
    n, f = (int(c) for c in whole_numbers(rows.values[:2], f"{name}: counts"))
    n_lines = len(rows) - 1
    if n < 0 or f < 0 or n_lines != n + f:
        remedy = "the file is cut short or its counts are wrong: export it again"
        raise refuse(name, f"lines for {n} vertices and {f} faces", f"{n_lines} lines", remedy)

    n_before, n_after = 3 + 3 * (b"N" in kinds), 2 * bool(textured)  # numbers on either side of the colour
    widths = (n_before + 4 + n_after, n_before + 3 + n_after) if b"C" in kinds else (n_before + n_after,)
    expected = f"{' or '.join(map(str, widths))} numbers a vertex"
    columns = as_table(rows.part(1, 1 + n), widths, name, expected)
    colors = unit_colors(columns[:, n_before : columns.shape[1] - n_after]) if b"C" in kinds else None
    faces = _faces(rows.part(1 + n, 1 + n + f), name)
    uv = columns[:, -2:].copy() if textured else None
    return MeshFile(Mesh(columns[:, :3], faces), colors, uv, faces if textured else None)


def _faces(rows: Rows, name: str) -> np.ndarray:
    """The triangles of the face lines, (t, 3)."""
    sizes = whole_numbers(rows.values[rows.starts], f"{name}: corners of a face")
    too_few = has_too_few_corners(sizes, name)
    check_lines(too_few, rows.lines, name, "faces with three corners or more", lambda i: str(sizes[i]))
    is_short, expected = sizes >= rows.counts, "as many corners as the line says"
    check_lines(is_short, rows.lines, name, expected, lambda i: f"{rows.counts[i] - 1} of {sizes[i]}")
    corners = rows.values[index_ranges(rows.starts + 1, sizes)]
    return whole_numbers(corners, f"{name}: faces", "whole vertex numbers")[fan(sizes)]


def format_off(shape: MeshFile) -> bytes:
    """Write a mesh as OFF, or as COFF with its colours as bytes; every digit of the coordinates is kept."""
    vertices, faces = shape.mesh.vertices, shape.mesh.faces
    lines = [f"{x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    if shape.colors is not None:
        tints = (f" {r} {g} {b} 255" for r, g, b in to_bytes(shape.colors).tolist())
        lines = [line + tint for line, tint in zip(lines, tints, strict=True)]
    lines += [f"3 {a} {b} {c}" for a, b, c in faces.tolist()]
    head = f"{'OFF' if shape.colors is None else 'COFF'}\n{len(vertices)} {len(faces)} 0\n"
    return (head + "\n".join(lines) + "\n").encode("ascii")
