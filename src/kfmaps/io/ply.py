"""PLY, the Stanford polygon format, as text and binary in either byte order."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kfmaps._arrays import index_ranges, refuse
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile, fan, has_too_few_corners, to_bytes, unit_colors
from kfmaps.io.text import REPAIR, Rows, check_lines, clean_text, parse_rows, quoted, whole_numbers


@dataclass(frozen=True)
class _Property:
    """A column: a number, or a list when ``count`` is given. The two are NumPy types with byte order."""

    name: str
    kind: np.dtype
    count: np.dtype | None = None


class _Element(NamedTuple):
    """A table of ``rows`` rows."""

    name: str
    rows: int
    properties: dict[str, _Property]


class _Column(NamedTuple):
    """The values of one property, those of lists one after another; ``sizes`` (rows,) are their lengths."""

    values: np.ndarray
    sizes: np.ndarray | None = None


_CUT = "the file is cut short or its counts are wrong: export it again"


def _text_columns(element: _Element, rows: Rows, name: str) -> dict[str, _Column]:
    """Return the columns of an element whose lines are ``rows``."""
    at, ends = rows.starts.copy(), rows.starts + rows.counts

    def step(lengths: np.ndarray | int) -> None:
        nonlocal at
        at = at + lengths
        expected = f"every property of a {element.name}"
        check_lines(at > ends, rows.lines, name, expected, lambda i: f"only {rows.counts[i]} numbers")

    columns = {}
    for item in element.properties.values():
        first = at
        step(1)
        if item.count is None:
            columns[item.name] = _Column(_typed(rows.values[first], item, name))
            continue
        sizes = whole_numbers(rows.values[first], f"{name}: length of {item.name}")
        check_lines(sizes < 0, rows.lines, name, f"{item.name} of 0 numbers or more", lambda i: str(sizes[i]))  # noqa: B023
        first = at
        step(sizes)
        columns[item.name] = _Column(_typed(rows.values[index_ranges(first, sizes)], item, name), sizes)
    expected = f"only the properties of a {element.name}"
    check_lines(at < ends, rows.lines, name, expected, lambda i: f"{rows.counts[i]} numbers")
    return columns


def _typed(values: np.ndarray, item: _Property, name: str) -> np.ndarray:
    """Return ``values`` of a text in the type that the header gives; fractions keep every digit of the text."""
    if item.kind.kind == "f":
        return values
    numbers = whole_numbers(values, f"{name}: {item.name}")
    low, high = np.iinfo(item.kind).min, np.iinfo(item.kind).max
    if ((numbers < low) | (numbers > high)).any():
        got = f"{numbers.min()} to {numbers.max()}"
        raise refuse(f"{name}: {item.name}", f"numbers from {low} to {high}, as the header says", got, REPAIR)
    return numbers.astype(item.kind)


def _binary_columns(element: _Element, data: bytes, start: int, name: str) -> tuple[dict[str, _Column], int]:
    """Return the columns of an element that begins at byte ``start``, and where the next one begins."""
    properties = element.properties.values()
    smallest = sum((p.count or p.kind).itemsize for p in properties)
    if element.rows * smallest > len(data) - start:
        got = f"{len(data) - start} bytes"
        raise refuse(name, f"{element.rows} rows of the element {element.name}", got, _CUT)
    if element.rows == 0:
        none = np.zeros(0, dtype=np.int64)
        return {p.name: _Column(none, none if p.count else None) for p in properties}, start
    # Nearly always the lists are equally long in every row; then the element is one structured array.
    _, sizes, _ = _walk(element, data, start, 1, name)
    layout: list[tuple] = []
    for item, (size,) in zip(properties, sizes, strict=True):
        layout += [(f"count {item.name}", item.count)] if item.count else []
        layout.append((item.name, item.kind, (int(size),)))
    block_type = np.dtype(layout)
    end = start + element.rows * block_type.itemsize
    if end <= len(data):
        block = np.frombuffer(data, block_type, element.rows, start)
        counts = {p.name: block[f"count {p.name}"].astype(np.int64) for p in properties if p.count}
        if all((lengths == lengths[0]).all() for lengths in counts.values()):
            return {p.name: _Column(block[p.name].ravel(), counts.get(p.name)) for p in properties}, end

    offsets, sizes, end = _walk(element, data, start, element.rows, name)
    raw, columns = np.frombuffer(data, dtype=np.uint8), {}
    for item, first, lengths in zip(properties, offsets, sizes, strict=True):
        skip = item.count.itemsize if item.count else 0
        values = raw[index_ranges(first + skip, lengths * item.kind.itemsize)].view(item.kind)
        columns[item.name] = _Column(values, lengths if item.count else None)
    return columns, end


def _walk(element: _Element, data: bytes, start: int, rows: int, name: str) -> tuple[np.ndarray, np.ndarray, int]:
    """Return where each property begins in ``rows`` rows, how many values it has, (p, rows) both, and the end."""
    steps = []
    for item in element.properties.values():
        code = item.count or item.kind
        order = "little" if code.newbyteorder("<") == code else "big"
        steps.append((item.count is not None, code.itemsize, item.kind.itemsize, order, code.kind == "i"))
    offsets, sizes = [], []
    at = start
    for _ in range(rows):
        for is_list, head, width, order, signed in steps:
            offsets.append(at)
            size = 1
            if is_list:
                size = int.from_bytes(data[at : at + head], order, signed=signed)
                at += width * size
            sizes.append(size)
            at += head
            if size < 0 or at > len(data):
                got = "a negative length" if size < 0 else "the end of the file"
                raise refuse(name, f"{element.rows} rows of the element {element.name}", got, _CUT)
    shape = (rows, len(steps))
    return np.array(offsets).reshape(shape).T, np.array(sizes).reshape(shape).T, at


_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2",
    "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_COLORS = (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b"))
_UV = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))


def parse_ply(data: bytes, name: str) -> MeshFile:
    """Read PLY with its properties in any order.

    Used are x, y and z of the element vertex, its colours and texture coordinates, and the list vertex_indices (or
    vertex_index) of the element face. All else is left out, but must fit the header.
    """
    order, elements, start = _header(data, name)
    columns: dict[str, dict[str, _Column]] = {}
    if order == "":
        rows = parse_rows(clean_text(data[start:], name), name)
        first = 0
        if len(rows) != sum(e.rows for e in elements):
            shown = [f"{e.rows} lines of {e.name}" for e in elements[:4]]
            expected = " and ".join(shown + [f"{len(elements) - 4} elements more"] * (len(elements) > 4))
            raise refuse(name, expected, f"{len(rows)} lines", _CUT)
        for element in elements:
            columns[element.name] = _text_columns(element, rows.part(first, first + element.rows), name)
            first += element.rows
        return _mesh_file(columns, name)
    for element in elements:
        columns[element.name], start = _binary_columns(element, data, start, name)
    if data[start:].strip():
        remedy = f"{REPAIR}; it may have been copied as text"
        raise refuse(name, "a file that ends where its header says", f"{len(data) - start} bytes more", remedy)
    return _mesh_file(columns, name)


def _header(data: bytes, name: str) -> tuple[str, list[_Element], int]:
    """Return byte order ('' for text), elements, and where the body begins."""
    opening = re.match(rb"ply[ \t]*(\r?\n|\r)", data)
    if opening is None:
        raise refuse(name, "the word ply first", quoted(data[:16]), "check the extension")
    order: str | None = None
    elements: dict[str, _Element] = {}
    properties: dict[str, _Property] = {}  # of the last element
    at, i = opening.end(), 1
    while (end := data.find(opening.group(1)[-1:], at)) >= 0:
        # Some programs end lines with \r\n in one part of the header and with \n in another.
        line, at, i = data[at:end].removesuffix(b"\r"), end + 1, i + 1
        words = line.decode("latin-1").split()
        where = f"{name}, line {i}"
        match words:
            case ["end_header"]:
                empty = [one.name for one in elements.values() if not one.properties]
                if order is None or empty:
                    got = "none" if order is None else f"none for {empty[0]}"
                    raise refuse(f"{name}: header", "a format, and properties of each element", got, REPAIR)
                return order, list(elements.values()), at
            case [] | ["comment" | "obj_info", *_]:
                pass
            case ["format", kind, "1.0"] if kind in _ORDERS and order is None:
                order = _ORDERS[kind]
            case ["element", kind, count] if re.fullmatch("[0-9]{1,15}", count):
                if kind in elements:
                    raise refuse(where, "each element once", f"{kind} again", REPAIR)
                properties = {}
                elements[kind] = _Element(kind, int(count), properties)
            case ["property", *rest] if elements and order is not None:
                item = _property(rest, order, where)
                if item.name in properties:
                    raise refuse(where, "each property once", f"{item.name} again", REPAIR)
                properties[item.name] = item
            case _:
                raise refuse(where, "a line of a PLY header", quoted(line), REPAIR)
    raise refuse(name, "a header that ends in end_header", "none", "the file is cut short: export it again")


def _property(words: list[str], order: str, where: str) -> _Property:
    match words:
        case [kind, title] if kind in _TYPES:
            return _Property(title, np.dtype(order + _TYPES[kind]))
        case ["list", count, kind, title] if kind in _TYPES and _TYPES.get(count, "f")[0] != "f":
            return _Property(title, np.dtype(order + _TYPES[kind]), np.dtype(order + _TYPES[count]))
    raise refuse(where, "a type of PLY and a name", quoted(" ".join(words).encode()), REPAIR)


def _mesh_file(elements: dict[str, dict[str, _Column]], name: str) -> MeshFile:
    """Return the mesh that the elements hold."""
    vertex = {k: c for k, c in elements.get("vertex", {}).items() if c.sizes is None}
    if not {"x", "y", "z"} <= vertex.keys():
        raise refuse(name, "an element vertex with numbers x, y and z", ", ".join(list(vertex)[:8]) or "none", REPAIR)

    def stacked(names: tuple[str, ...]) -> np.ndarray:
        return np.stack([vertex[k].values for k in names], axis=1).astype(np.float64)

    faces = np.zeros((0, 3), dtype=np.int64)
    face = elements.get("face", {})
    column = face.get("vertex_indices", face.get("vertex_index"))
    if column is not None and column.sizes is not None:
        if (too_few := has_too_few_corners(column.sizes, name)).any():
            i = np.flatnonzero(too_few)[0]
            got = f"{column.sizes[i]} in face {i}"
            raise refuse(name, "faces with three corners or more", got, REPAIR)
        corners = whole_numbers(column.values.astype(np.float64), f"{name}: faces", "whole vertex numbers")
        faces = corners[fan(column.sizes)]
    elif face or "tristrips" in elements:
        raise refuse(name, "the list vertex_indices of the element face", "another", "export plain faces")
    color_names = next((c for c in _COLORS if vertex.keys() >= set(c)), None)
    uv_names = next((c for c in _UV if vertex.keys() >= set(c)), None)
    uv = stacked(uv_names) if uv_names and len(faces) else None
    colors = None
    if color_names:  # bytes and 16-bit numbers by their range, text and fractions by their size
        kind = np.result_type(*(vertex[k].values.dtype for k in color_names))
        colors = stacked(color_names)
        colors = colors / np.iinfo(kind).max if kind.kind == "u" else unit_colors(colors)
    return MeshFile(Mesh(stacked(("x", "y", "z")), faces), colors, uv, None if uv is None else faces)


def format_ply(shape: MeshFile) -> bytes:
    """Write a mesh as binary PLY, coordinates in double precision, colours as bytes."""
    mesh, columns = (
        shape.mesh,
        [(axis, "<f8", "double", x) for axis, x in zip("xyz", shape.mesh.vertices.T, strict=True)],
    )
    if shape.colors is not None:
        columns += [(tint, "u1", "uchar", x) for tint, x in zip(_COLORS[0], to_bytes(shape.colors).T, strict=True)]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.vertices)}"]
    header += [f"property {kind} {title}" for title, _, kind, _ in columns]
    header += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header", ""]
    vertices = np.zeros(len(mesh.vertices), dtype=[(title, code) for title, code, _, _ in columns])
    for title, _, _, values in columns:
        vertices[title] = values
    faces = np.zeros(len(mesh.faces), dtype=[("size", "u1"), ("corners", "<i4", (3,))])
    faces["size"] = 3
    faces["corners"] = mesh.faces
    return "\n".join(header).encode("ascii") + vertices.tobytes() + faces.tobytes()
