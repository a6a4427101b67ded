"""Per-vertex values: functions and labels, in files and carried over a map."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.io.atomic import atomic_output, check_output
from kfmaps.io.mapfile import MapFile, check_map, check_npy
from kfmaps.io.text import REPAIR, read_bytes

FORMATS = (".npy", ".csv", ".txt")
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?|[+-]?inf|[+-]?nan", re.ASCII | re.IGNORECASE)
_WHOLE = re.compile(r"[+-]?\d+", re.ASCII)


@dataclass(frozen=True, eq=False)
class Values:
    """Something known at each vertex.

    Attributes
    ----------
    array : (n,) or (n, d) array
        int64 (or uint64) when all are whole numbers, float64 when they are numbers, else texts (labels). Whole
        numbers whose digits neither would keep are texts.
    columns : tuple of str or None
        The header of a ``.csv`` file that has one.
    """

    array: np.ndarray
    columns: tuple[str, ...] | None = None


def transfer(values_s: Any, target_to_source: Any, faces_s: np.ndarray | None = None, lost: Any = None) -> np.ndarray:
    """Carry values from the vertices of the source to those of the target.

    Parameters
    ----------
    values_s : (n_s, ...) array
        Functions, labels, colours: anything with a row per source vertex.
    target_to_source : (n_t,) int64 or MapFile
        A source vertex for each target vertex.
    faces_s : (f_s, 3) int64, optional
        The source's faces: with those, functions (floating numbers) are mixed between the corners of the points inside
        triangles that the map file has. Labels and whole numbers are those of the nearest vertex.
    lost : optional
        What target vertices without a counterpart get; by default NaN, for whole numbers −1, for texts the empty one.

    Returns
    -------
    (n_t, ...) array
        Of the same dtype: row j is ``values_s[target_to_source[j]]``, or the mean of three rows.

    Raises
    ------
    InvalidInput
        When the map names a vertex that has no value, or says of itself that the source has another
        number of vertices.
    """
    values = np.asarray(values_s)
    if values.ndim == 0:
        raise refuse("values", "a row for each source vertex", "a single value", "give an array")
    n_s = target_to_source.n_s if isinstance(target_to_source, MapFile) else None
    if n_s not in (None, len(values)):
        wanted = f"{n_s} rows, one per source vertex"
        raise refuse("values", wanted, str(len(values)), "check that they are the source's")
    points = check_map(target_to_source, n_s=len(values), lost=True)
    if (points < 0).any():
        return _with_gaps(values, target_to_source, points, faces_s, lost)
    place = target_to_source.place if isinstance(target_to_source, MapFile) else None
    if place is None or faces_s is None or values.dtype.kind != "f":
        return values[points]
    corners = values[faces_s[place.faces]]
    mixed = np.einsum("ti,ti...->t...", place.weights, np.where(np.isfinite(corners), corners, 0.0))
    # A corner without a finite value makes none of the mean; one of weight 0 has no say.
    unknown = (~np.isfinite(corners) & (place.weights > 0).reshape(*place.weights.shape, *[1] * (values.ndim - 1))).any(
        axis=1
    )
    return np.where(unknown, values[points], mixed).astype(values.dtype)


def _with_gaps(
    values: np.ndarray, target_to_source: Any, points: np.ndarray, faces_s: np.ndarray | None, lost: Any
) -> np.ndarray:
    """:func:`transfer` of a map with vertices that have no counterpart."""
    gone = points < 0
    known = np.where(gone, points[~gone][0] if (~gone).any() else 0, points)
    place = target_to_source.place if isinstance(target_to_source, MapFile) else None
    extra = {} if place is None else {"place_faces": place.faces, "place_weights": place.weights}
    return without(np.array(transfer(values, MapFile(known, extra=extra), faces_s)), gone, lost)


def without(values: np.ndarray, gone: np.ndarray, lost: Any = None) -> np.ndarray:
    """``values (n, ...)`` with ``lost`` in the rows ``gone (n,)``; see :func:`transfer` for what that is by default.

    Raises
    ------
    InvalidInput
        When their kind has no such value.
    """
    if lost is None:
        lost = {"f": np.nan, "c": np.nan, "U": "", "i": -1}.get(values.dtype.kind)
    if lost is None or (values.dtype.kind in "ui" and not np.can_cast(np.min_scalar_type(lost), values.dtype)):
        got = f"{values.dtype}, and {gone.sum()} vertices without a counterpart"
        raise refuse("values", "a kind with a value for vertices without counterpart", got, "give the value: lost=")
    values[gone] = lost
    return values


def read_values(path: str | Path) -> Values:
    """Read per-vertex values from ``.npy``, ``.csv`` or ``.txt``.

    In a ``.csv`` file a first row of names is recognised above numbers. A ``.txt`` file has a vertex a line,
    numbers between blanks, or one label; lines that begin with ``#`` are comments. Tables are numbers
    throughout or texts throughout.

    Raises
    ------
    InvalidInput
        On an unknown extension, a file that is missing, empty, cut short or holds pickled objects, and rows
        of different lengths or kinds.
    """
    name = str(path)
    suffix = _format(path)
    data = read_bytes(path)
    if suffix == ".npy":
        return Values(_npy(data, name))
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise refuse(name, "UTF-8 text", "something else", "check the extension") from error
    if suffix == ".txt":
        lines = [(i, line.strip()) for i, line in enumerate(text.splitlines(), 1)]
        table = [(i, line.split()) for i, line in lines if line and not line.startswith("#")]
        if table and not any(_numeric(row) for _, row in table):
            return Values(np.array([line for _, line in lines if line and not line.startswith("#")]))
    else:
        try:
            reader = csv.reader(io.StringIO(text, newline=""), strict=True)
            table = [(reader.line_num, [cell.strip() for cell in row]) for row in reader if row]
        except csv.Error as error:
            raise refuse(name, "comma-separated values", str(error), REPAIR) from error
    columns = None
    if suffix == ".csv" and len(table) > 1 and not _any_number(table[0][1]) and _numeric(table[1][1]):
        columns, table = tuple(table[0][1]), table[1:]
    array = _table(table, name)
    return Values(array[:, 0] if array.shape[1] == 1 else array, columns)


def _numeric(row: list[str]) -> bool:
    return all(_NUMBER.fullmatch(cell) for cell in row)


def _any_number(row: list[str]) -> bool:
    return any(_NUMBER.fullmatch(cell) for cell in row)


def _format(path: str | Path) -> str:
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS:
        got = suffix or "no extension"
        raise refuse(f"values {path}", f"one of {' '.join(FORMATS)}", got, "convert or rename it")
    return suffix


def _table(rows: list[tuple[int, list[str]]], name: str) -> np.ndarray:
    """The cells as a (rows, columns) array of numbers, or of texts when no row is all numbers."""
    if not rows:
        raise refuse(name, "a row for each source vertex", "none", "check that it is the right file")
    width, numbers = len(rows[0][1]), _numeric(rows[0][1])
    for line, row in rows:
        if len(row) != width:
            raise refuse(f"{name}, line {line}", f"{width} values as before", f"{len(row)}", REPAIR)
        if _numeric(row) != numbers:
            wanted, got = ("numbers", "text") if numbers else ("text", "numbers")
            raise refuse(f"{name}, line {line}", f"{wanted} as before", got, REPAIR)
    cells = [row for _, row in rows]
    if not numbers:
        return np.array(cells)
    kind = _kind([cell for row in cells for cell in row])
    with np.errstate(over="ignore"):  # 1e999 is infinity
        return np.array(cells) if kind is None else np.array(cells).astype(kind)


def _kind(cells: list[str]) -> type | None:
    """The type that keeps every digit of whole numbers; ``None`` where none does, and they must stay texts."""
    integral = all(_WHOLE.fullmatch(cell) for cell in cells)
    long = [cell for cell in cells if len(cell) > 15 and _WHOLE.fullmatch(cell)]
    if max(map(len, long), default=0) > 400:
        return None
    if not integral:
        return np.float64 if all(int(cell) == float(cell) for cell in long) else None
    low, high = min(map(int, long), default=0), max(map(int, long), default=0)
    if low >= -(2**63) and high < 2**63:
        return np.int64
    shortest = min(map(int, cells))
    return np.uint64 if shortest >= 0 and high < 2**64 else None


def _npy(data: bytes, name: str) -> np.ndarray:
    try:
        check_npy(io.BytesIO(data), len(data), name)
        array = np.load(io.BytesIO(data), allow_pickle=False)
    except InvalidInput:
        raise
    except Exception as error:  # the reader reports broken files by whatever it runs into
        got = " ".join(f"{type(error).__name__}: {error}".split())[:100]
        raise refuse(name, "a complete .npy file without objects", got, REPAIR) from error
    if array.ndim == 0 or array.dtype.kind not in "biufcU":
        got = f"shape {array.shape} of {array.dtype}"
        raise refuse(name, "a row of numbers or texts for each source vertex", got, REPAIR)
    return array


def write_values(path: str | Path, values: Values, force: bool = False) -> None:
    """Write per-vertex values so that :func:`read_values` reads them back; every digit is kept.

    Raises
    ------
    InvalidInput
        On an unknown extension, more than two dimensions in a text format, and as :func:`atomic_output`.
    """
    suffix = _format(path)
    check_output(path, force)
    array = values.array
    if suffix == ".npy":
        with atomic_output(path, force) as temporary, open(temporary, "wb") as file:
            np.save(file, array, allow_pickle=False)
        return
    if array.ndim > 2 or array.dtype.kind == "c":
        got = "complex numbers" if array.dtype.kind == "c" else f"shape {array.shape}"
        raise refuse(f"output {path}", "a table of real numbers or texts", got, "write .npy instead")
    numbers = array.astype(np.int64) if array.dtype.kind == "b" else array
    rows = (numbers[:, None] if array.ndim == 1 else numbers).tolist()
    cells = [[cell if isinstance(cell, str) else repr(cell) for cell in row] for row in rows]
    with (
        atomic_output(path, force) as temporary,
        open(temporary, "w", encoding="utf-8", newline="") as file,
    ):
        if suffix == ".csv":
            table = [list(values.columns)] if values.columns else []
            csv.writer(file, lineterminator="\n").writerows(table + cells)
        else:
            file.writelines(" ".join(row) + "\n" for row in cells)
