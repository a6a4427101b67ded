"""Read and write values of vertices: functions and labels."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._records import short_repr
from kfmaps.io.atomic import atomic_output, csv_text, write_text
from kfmaps.io.mapfile import check_npy
from kfmaps.io.text import (
    REPAIR,
    check_lines,
    check_suffix,
    complete_or_refuse,
    is_number,
    read_bytes,
    read_csv,
    read_text,
)

_FORMATS, _RENAME = (".npy", ".csv", ".txt"), "convert or rename it"
_MAX_LETTERS = 1 << 26
"""Most labels times letters of the longest: each takes as much memory, in all a quarter of a GiB."""
_WHOLE = re.compile(r"[+-]?\d+", re.ASCII)


@dataclass(frozen=True, eq=False)
class Values:
    """A value or a row of values for each vertex.

    Attributes
    ----------
    array : (n,) or (n, d) array
        int64 (or uint64) when all are whole numbers, float64 when they are numbers, else texts (labels). Whole numbers
        too large for these types are texts.
    columns : tuple of str or None
        The header of a ``.csv`` file that has one.
    """

    array: np.ndarray
    columns: tuple[str, ...] | None = None

    __repr__ = short_repr


def read_values(path: str | Path) -> Values:
    """Read per-vertex values from ``path``: ``.npy``, ``.csv`` or ``.txt``; tables of numbers or of texts throughout.

    In a ``.csv`` file a first row of names is recognised above numbers. A ``.txt`` file has a vertex a line, numbers
    between blanks, or one label; lines that begin with ``#`` are comments.

    Raises
    ------
    InvalidInput
        On an unknown extension, a file that is missing, empty, cut short or holds pickled objects, and rows
        of different lengths or kinds.
    """
    suffix = check_suffix(path, _FORMATS, "values", _RENAME)
    if suffix == ".npy":
        return Values(_npy(read_bytes(path), str(path)))
    if suffix == ".csv":
        table = read_csv(path)
        has_titles = len(table) > 1 and not any(map(is_number, table[0][1])) and all(map(is_number, table[1][1]))
        return Values(_table(table[has_titles:], str(path)), tuple(table[0][1]) if has_titles else None)
    lines = [(i, line.strip()) for i, line in enumerate(read_text(path).splitlines(), 1)]
    lines = [(i, line) for i, line in lines if line and not line.startswith("#")]
    rows = [(i, line.split()) for i, line in lines]
    if rows and not any(all(map(is_number, row)) for _, row in rows):
        return Values(_texts([line for _, line in lines], str(path)))
    return Values(_table(rows, str(path)))


def _table(rows: list[tuple[int, list[str]]], name: str) -> np.ndarray:
    """Return the cells as an array (rows, columns), or (rows,), of numbers, or of texts when no row is all numbers."""
    if not rows:
        raise refuse(name, "a row for each source vertex", "none", "check that it is the right file")
    at, cells = np.array([line for line, _ in rows]), [row for _, row in rows]
    width, widths = len(cells[0]), np.array(list(map(len, cells)))
    check_lines(widths != width, at, name, f"{width} values as before", lambda i: str(widths[i]))
    is_numeric = np.array([all(map(is_number, row)) for row in cells])
    expected, got = ("numbers", "text") if is_numeric[0] else ("text", "numbers")
    check_lines(is_numeric != is_numeric[0], at, name, f"{expected} as before", lambda _: got)
    flat = [cell for row in cells for cell in row]
    texts, kind = _texts(flat, name), _kind(flat) if is_numeric[0] else None
    texts = texts if width == 1 else texts.reshape(len(cells), width)
    with np.errstate(over="ignore"):  # 1e999 is infinity
        return texts if kind is None else texts.astype(kind)


def _texts(cells: list[str], name: str) -> np.ndarray:
    """Return ``cells`` as an array of texts; each takes as much memory as the longest."""
    longest = max(cells, key=len)
    if len(longest) * len(cells) > _MAX_LETTERS:
        expected = f"labels of at most {_MAX_LETTERS // len(cells):,} letters each, for there are {len(cells):,}"
        raise refuse(name, expected, f"one of {len(longest):,} letters ({longest[:24]!r}...)", "shorten it")
    return np.array(cells)


def _kind(cells: list[str]) -> type | None:
    """Return the type that keeps every digit of whole numbers; ``None`` where only texts do."""
    whole = [cell for cell in cells if _WHOLE.fullmatch(cell)]
    if max(map(len, whole), default=0) > 400:  # more digits than any float, and than Python reads
        return None
    numbers = [int(cell) for cell in whole]
    if len(whole) < len(cells):
        return np.float64 if all(number == float(number) for number in numbers) else None
    limits = ((kind, np.iinfo(kind)) for kind in (np.int64, np.uint64))
    return next((kind for kind, of in limits if of.min <= min(numbers) and max(numbers) <= of.max), None)


def _npy(data: bytes, name: str) -> np.ndarray:
    with complete_or_refuse(name, "a complete .npy file without objects"):
        check_npy(io.BytesIO(data), len(data), name)
        array = np.load(io.BytesIO(data), allow_pickle=False)
    if array.ndim == 0 or array.dtype.kind not in "biufcU":
        got = f"shape {array.shape} of {array.dtype}"
        raise refuse(name, "a row of numbers or texts for each source vertex", got, REPAIR)
    return array


def write_values(path: str | Path, values: Values, force: bool = False) -> None:
    """Write per-vertex values so that :func:`read_values` reads them back; every digit is kept.

    ``path``: ``.npy``, ``.csv`` or ``.txt``; ``force``: whether an existing file is replaced.

    Raises
    ------
    InvalidInput
        On an unknown extension, more than two dimensions in a text format, and as :func:`atomic_output`.
    """
    suffix, array = check_suffix(path, _FORMATS, "values", _RENAME), values.array
    if suffix == ".npy":
        with atomic_output(path, force) as temporary, open(temporary, "wb") as file:
            np.save(file, array, allow_pickle=False)
        return
    if array.ndim > 2 or array.dtype.kind == "c":
        got = "complex numbers" if array.dtype.kind == "c" else f"shape {array.shape}"
        raise refuse(f"output {path}", "a table of real numbers or texts", got, "write .npy instead")
    numbers = array.astype(np.int64) if array.dtype.kind == "b" else array
    cells = [list(map(str, row)) for row in (numbers[:, None] if array.ndim == 1 else numbers).tolist()]
    if suffix == ".csv":
        text = csv_text([list(values.columns), *cells] if values.columns else cells)
    else:
        text = "".join(" ".join(row) + "\n" for row in cells)
    write_text(path, text, force)
