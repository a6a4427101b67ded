"""The body of a PLY file: one element after another, as text or binary, each a table of properties."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.io.record import gathered
from kfmaps.io.text import REPAIR, Rows, check_lines, whole_numbers


@dataclass(frozen=True)
class Property:
    """A column: a number, or a list when ``count`` is given. The two are NumPy types with byte order."""

    name: str
    kind: np.dtype
    count: np.dtype | None = None


@dataclass(frozen=True)
class Element:
    """A table of ``rows`` rows."""

    name: str
    rows: int
    properties: tuple[Property, ...]


@dataclass(frozen=True, eq=False)
class Column:
    """The values of one property, those of lists one after another; ``sizes`` (rows,) are their lengths."""

    values: np.ndarray
    sizes: np.ndarray | None = None


CUT = "the file is cut short or its counts are wrong: export it again"


def text_columns(element: Element, rows: Rows, name: str) -> dict[str, Column]:
    """Return the columns of an element whose lines are ``rows``."""
    at, ends = rows.starts.copy(), rows.starts + rows.counts

    def step(lengths: np.ndarray | int) -> None:
        nonlocal at
        at = at + lengths
        wanted = f"every property of a {element.name}"
        check_lines(at > ends, rows.lines, name, wanted, lambda i: f"only {rows.counts[i]} numbers")

    columns = {}
    for item in element.properties:
        first = at
        step(1)
        if item.count is None:
            columns[item.name] = Column(_typed(rows.values[first], item, name))
            continue
        sizes = whole_numbers(rows.values[first], f"{name}: length of {item.name}")
        check_lines(sizes < 0, rows.lines, name, f"{item.name} of 0 numbers or more", lambda i: str(sizes[i]))  # noqa: B023
        first = at
        step(sizes)
        columns[item.name] = Column(_typed(rows.values[gathered(first, sizes)], item, name), sizes)
    wanted = f"only the properties of a {element.name}"
    check_lines(at < ends, rows.lines, name, wanted, lambda i: f"{rows.counts[i]} numbers")
    return columns


def _typed(values: np.ndarray, item: Property, name: str) -> np.ndarray:
    """``values`` from a text in the type that the header gives; fractions keep every digit of the text."""
    if item.kind.kind == "f":
        return values
    numbers = whole_numbers(values, f"{name}: {item.name}")
    low, high = np.iinfo(item.kind).min, np.iinfo(item.kind).max
    if ((numbers < low) | (numbers > high)).any():
        got = f"{numbers.min()} to {numbers.max()}"
        raise refuse(f"{name}: {item.name}", f"numbers from {low} to {high}, as the header says", got, REPAIR)
    return numbers.astype(item.kind)


def binary_columns(element: Element, data: bytes, start: int, name: str) -> tuple[dict[str, Column], int]:
    """Return the columns of an element that begins at byte ``start``, and where the next one begins."""
    smallest = sum((p.count or p.kind).itemsize for p in element.properties)
    if element.rows * smallest > len(data) - start:
        got = f"{len(data) - start} bytes"
        raise refuse(name, f"{element.rows} rows of the element {element.name}", got, CUT)
    if element.rows == 0:
        none = np.zeros(0, dtype=np.int64)
        return {p.name: Column(none, none if p.count else None) for p in element.properties}, start
    # Nearly always the lists are equally long in every row; then the element is one structured array.
    _, sizes, _ = _walk(element, data, start, 1, name)
    layout = []
    for i, (item, (size,)) in enumerate(zip(element.properties, sizes, strict=True)):
        if item.count is None:
            layout.append((f"{i}", item.kind))
        else:
            layout += [(f"count {i}", item.count), (f"{i}", item.kind, (int(size),))]
    block_type = np.dtype(layout)
    end = start + element.rows * block_type.itemsize
    if end <= len(data):
        block = np.frombuffer(data, block_type, element.rows, start)
        if all((block[c] == block[c][0]).all() for c in block_type.names or () if c.startswith("count")):
            columns = {}
            for i, item in enumerate(element.properties):
                lengths = block[f"count {i}"].astype(np.int64) if item.count else None
                columns[item.name] = Column(block[f"{i}"].ravel(), lengths)
            return columns, end

    offsets, sizes, end = _walk(element, data, start, element.rows, name)
    raw = np.frombuffer(data, dtype=np.uint8)
    columns = {}
    for item, first, lengths in zip(element.properties, offsets, sizes, strict=True):
        skip = item.count.itemsize if item.count else 0
        taken = raw[gathered(first + skip, lengths * item.kind.itemsize)].view(item.kind)
        columns[item.name] = Column(taken, lengths if item.count else None)
    return columns, end


def _walk(element: Element, data: bytes, start: int, rows: int, name: str) -> tuple[np.ndarray, np.ndarray, int]:
    """Step through ``rows`` rows: where each property begins and how many values it has, (p, rows) both."""
    steps = []
    for item in element.properties:
        code = np.dtype(item.count or item.kind)
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
                raise refuse(name, f"{element.rows} rows of the element {element.name}", got, CUT)
    shape = (rows, len(steps))
    return np.array(offsets).reshape(shape).T, np.array(sizes).reshape(shape).T, at
