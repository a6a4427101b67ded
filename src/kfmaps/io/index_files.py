"""Small text files of vertex numbers: landmarks and correspondence lists."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kfmaps._arrays import check, refuse
from kfmaps.io.atomic import write_text
from kfmaps.io.text import as_table, clean_text, parse_rows, read_bytes, whole_numbers


def _read_numbers(
    path: str | Path, columns: int, expected: str, one_based: bool | None, partial: bool = False
) -> np.ndarray:
    """Return the vertex numbers of a text file, (rows, columns) int64, from 0 on; −1 stays where ``partial``."""
    name, first = str(path), _first_number(path) if one_based is None else int(one_based)
    rows = parse_rows(clean_text(read_bytes(path), name), name)
    if len(rows) == 0:
        raise refuse(name, expected, "no numbers", "check that it is the right file")
    numbers = whole_numbers(as_table(rows, columns, name, expected), name)
    unmatched = (numbers == -1) & partial
    too_small = np.flatnonzero(((numbers < first) & ~unmatched).any(axis=1))
    if len(too_small):
        got = " ".join(map(str, numbers[too_small[0]]))
        remedy = "check the numbers" + ("; are they counted from 0?" if numbers.min() == 0 else "")
        raise refuse(f"{name}, line {rows.lines[too_small[0]]}", f"vertex numbers from {first} on", got, remedy)
    return np.where(unmatched, -1, numbers - first)


def _first_number(path: str | Path) -> int:
    """Return the number of a file's first vertex: 1 in ``.vts``, the format of the remeshed benchmarks, else 0."""
    return int(Path(path).suffix.lower() == ".vts")


def read_landmarks(path: str | Path, *, one_based: bool | None = None) -> np.ndarray:
    """Read landmark pairs: two whole numbers a line, "source target"; ``#`` starts a comment.

    Parameters
    ----------
    path : str or Path
    one_based : bool, optional
        Whether the file counts vertices from 1; by default only a ``.vts`` file does.

    Returns
    -------
    (l, 2) int64
        0-based, in the order of the file.

    Raises
    ------
    InvalidInput
        On a file that is missing, empty, or has a line of anything else.

    Examples
    --------
    >>> _ = Path("pairs.txt").write_text("412 1034  # head\\n2790 88\\n")
    >>> kfmaps.read_landmarks("pairs.txt")
    array([[ 412, 1034],
           [2790,   88]])
    """
    return _read_numbers(path, 2, "two whole numbers a line, source and target", one_based)


def read_landmark_names(path: str | Path) -> list[str]:
    """Return the name of each pair of the landmarks file ``path``: what stands behind ``#`` on the pair's line."""
    data = read_bytes(path).decode("utf-8", "replace")
    lines = (line.partition("#") for line in data.splitlines())
    return [_printable(comment) for pair, _, comment in lines if pair.strip()]


def _printable(text: str) -> str:
    """Return a text on one line, without characters that a terminal does not print."""
    return " ".join("".join(letter if letter.isprintable() else " " for letter in text).split())


def write_landmarks(path: str | Path, pairs: np.ndarray, *, names: Sequence[str] = (), force: bool = False) -> None:
    """Write landmark pairs so that :func:`read_landmarks` reads them back.

    Parameters
    ----------
    path : str or Path
        The vertices of a ``.vts`` file are counted from 1, those of any other from 0.
    pairs : (l, 2) int
        0-based, "source, target".
    names : sequence of str
        One for each pair, or none; they stand behind ``#`` on the pairs' lines.
    force : bool
        Whether an existing file is replaced.
    """
    first = _first_number(path)
    pairs = check(np.asarray(pairs), "landmarks", shape=(None, 2), remedy="give one row source, target each")
    if len(names) not in (0, len(pairs)):
        raise refuse("names", f"{len(pairs)}, one for each pair", str(len(names)), "give one for each, or none")
    lines = [f"# source target, counted from {first}"]
    named = [_printable(name) for name in names] or [""] * len(pairs)
    for (s, t), name in zip((pairs.astype(np.int64) + first).tolist(), named, strict=True):
        lines.append(f"{s} {t}  # {name}" if name else f"{s} {t}")
    write_text(path, "\n".join(lines) + "\n", force)


def read_vertex_numbers(path: str | Path, one_based: bool | None = None, *, partial: bool = False) -> np.ndarray:
    """Read a list of vertex numbers, one a line; ``#`` starts a comment.

    ``path``, ``one_based`` and errors are as of :func:`read_landmarks`; ``partial``: whether −1 may stand
    for no vertex. Returns (m,) int64, 0-based.
    """
    return _read_numbers(path, 1, "one whole number a line", one_based, partial)[:, 0]


def write_vertex_numbers(path: str | Path, numbers: np.ndarray, *, force: bool = False) -> None:
    """Write vertex numbers (m,), 0-based, so that :func:`read_vertex_numbers` reads them back; −1 stays.

    ``path`` and ``force`` are as of :func:`write_landmarks`.
    """
    numbers = check(np.asarray(numbers), "vertex numbers", shape=(None,), remedy="give a list").astype(np.int64)
    lines = map(str, np.where(numbers == -1, -1, numbers + _first_number(path)).tolist())
    write_text(path, "\n".join(lines) + "\n", force)
