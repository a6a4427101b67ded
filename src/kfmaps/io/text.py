"""Read text files of numbers strictly and fast; functions that all readers share."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np

from kfmaps._arrays import InvalidInput, KfmapsWarning, refuse
from kfmaps._memory import check_memory

REPAIR = "repair the file or export it again"
_BLANK = np.zeros(256, dtype=bool)
_BLANK[list(b" \t\n\v\f\r")] = True
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?|[+-]?(inf|infinity|nan)", re.ASCII | re.IGNORECASE)


@dataclass(frozen=True, eq=False)
class Rows:
    """The numbers of a text, line by line; lines without any are left out."""

    values: np.ndarray  # (v,): all numbers in order
    counts: np.ndarray  # (r,): how many each line has, at least 1
    starts: np.ndarray  # (r,): where in ``values`` each line begins
    lines: np.ndarray  # (r,): the number of each line in the file, from 1

    def __len__(self) -> int:
        return len(self.counts)

    def part(self, first: int, last: int) -> Rows:
        """Return lines ``first`` to ``last - 1``; ``values`` stay those of the whole."""
        return Rows(self.values, self.counts[first:last], self.starts[first:last], self.lines[first:last])


def check_suffix(path: str | Path, formats: Iterable[str], what: str = "", remedy: str = "rename it") -> str:
    """Return the extension of ``path`` in lower case where it is one of ``formats``; ``what``: the file in messages."""
    suffix = Path(path).suffix.lower()
    if suffix not in formats:
        raise refuse(f"{what} {path}".strip(), f"one of {' '.join(formats)}", suffix or "no extension", remedy)
    return suffix


def read_bytes(path: str | Path) -> bytes:
    """Return the content of a regular file that is not empty."""
    path = Path(path)
    try:
        if not path.is_file():
            got = "a folder" if path.is_dir() else "a device or pipe" if path.exists() else "nothing there"
            raise refuse(str(path), "a file", got, "check the name")
        check_memory(path.stat().st_size, str(path), "the file alone", "make it smaller, or use a larger machine")
        data = path.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        if isinstance(error, InvalidInput):
            raise
        reason = getattr(error, "strerror", None) or str(error)
        raise refuse(str(path), "a readable file", reason, "check its name and permissions") from error
    if not data:
        raise refuse(str(path), "a file with content", "an empty file", "export it again")
    return data


def read_text(path: str | Path) -> str:
    """Return the content of the regular file ``path``, which must be UTF-8 text."""
    try:
        return read_bytes(path).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise refuse(str(path), "UTF-8 text", "something else", "check that it is the right file") from error


def read_csv(path: str | Path) -> list[tuple[int, list[str]]]:
    """Return the rows of a file of comma-separated values that are not empty: the line's number, and its cells."""
    reader = csv.reader(io.StringIO(read_text(path), newline=""), strict=True)
    try:
        return [(reader.line_num, [cell.strip() for cell in row]) for row in reader if row]
    except csv.Error as error:
        raise refuse(str(path), "comma-separated values", str(error), REPAIR) from error


def read_table(path: str | Path) -> list[dict[str, str]]:
    """Return the rows of a file of comma-separated values by the titles in its first row."""
    titles, *rows = (cells for _, cells in read_csv(path))
    return [dict(zip(titles, cells, strict=True)) for cells in rows]


@contextmanager
def complete_or_refuse(name: str, expected: str) -> Iterator[None]:
    """Turn any error in the block, which reads the file ``name``, into a refusal that says what was ``expected``."""
    try:
        yield
    except (InvalidInput, MemoryError, KfmapsWarning):
        raise
    except Exception as error:
        got = " ".join(f"{type(error).__name__}: {error}".split())[:100]
        raise refuse(name, expected, got, REPAIR) from error


def relative_file(address: str, name: str) -> Path | None:
    """Return the file of a relative address in the file ``name``; ``None`` where it lies outside the folder."""
    path = PurePosixPath(address)
    outside = not path.parts or path.is_absolute() or ".." in path.parts or ":" in path.parts[0]
    return None if outside or "\\" in address or "\0" in address else Path(name).parent / path


def is_number(word: str) -> bool:
    """Return whether ``word`` is a number as files write it."""
    return _NUMBER.fullmatch(word) is not None


def clean_text(data: bytes, name: str, comment: bytes = b"#") -> bytes:
    """Return the text ``data`` with line ends made ``\\n`` and comments blanked; line numbers stay."""
    data = data.removeprefix(b"\xef\xbb\xbf")
    if b"\0" in data:
        raise refuse(name, "a text file", "binary data", "check that the file's extension is right")
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return re.sub(re.escape(comment) + rb"[^\n]*", b"", data) if comment in data else data


def _bad_number(text: bytes, name: str, numbers: np.ndarray | None) -> Exception:
    """Return the error about the first word of ``text`` that is no number."""
    for i, line in enumerate(text.split(b"\n")):
        for word in line.split():
            if not is_number(word.decode("latin-1")):
                at = i + 1 if numbers is None else numbers[i]
                return refuse(f"{name}, line {at}", "numbers", quoted(word), REPAIR)
    return refuse(name, "numbers", "something else", REPAIR)


def quoted(word: bytes) -> str:
    """Return ``word`` fit for a message: short, printable, in quotes."""
    return repr(word[:24].decode("ascii", "backslashreplace")) + ("..." if len(word) > 24 else "")


def split_words(text: bytes | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return where each word of ``text`` begins, and the line it stands on, from 0."""
    letters = np.frombuffer(text, dtype=np.uint8) if isinstance(text, bytes) else text
    blank = _BLANK[letters]
    begins = ~blank
    begins[1:] &= blank[:-1]
    at = np.flatnonzero(begins)
    return at, np.searchsorted(np.flatnonzero(letters == 10), at)


def parse_rows(text: bytes, name: str, line_numbers: np.ndarray | None = None) -> Rows:
    """Read a text from :func:`clean_text` that holds nothing but numbers between blanks.

    ``name``: of the text in messages; ``line_numbers (lines,)``: of each line in the file, by default 1, 2, ....
    """
    at, line_of_word = split_words(text)
    per_line = np.bincount(line_of_word)
    line = np.flatnonzero(per_line)
    counts = per_line[line]
    values = np.zeros(0)
    if len(at):
        try:
            values = np.fromstring(text, sep=" ")
        except (ValueError, DeprecationWarning):  # how NumPy complains depends on its version
            raise _bad_number(text, name, line_numbers) from None
        if len(values) != len(at):
            raise _bad_number(text, name, line_numbers)
    numbers = line + 1 if line_numbers is None else line_numbers[line]
    return Rows(values, counts, np.cumsum(counts) - counts, numbers)


def check_lines(bad: np.ndarray, lines: np.ndarray, name: str, expected: str, got: Callable[[int], str]) -> None:
    """Refuse the first of the ``lines (r,)`` where ``bad (r,)`` is true; ``got``: what line ``i`` has, in words."""
    if bad.any():
        i = int(np.argmax(bad))
        raise refuse(f"{name}, line {lines[i]}", expected, got(i), REPAIR)


def whole_numbers(values: np.ndarray, name: str, expected: str = "whole numbers") -> np.ndarray:
    """Return ``values`` as int64."""
    bad = ~((np.abs(values) < 2**53) & (values == np.rint(values)))
    if bad.any():
        raise refuse(name, expected, f"{values[bad][0]:.6g}", REPAIR)
    return values.astype(np.int64)


def as_table(rows: Rows, columns: int | tuple[int, ...], name: str, expected: str) -> np.ndarray:
    """Return the numbers of ``rows`` as (rows, columns); all rows must have the same length, one of ``columns``."""
    if len(rows) == 0:
        return np.zeros((0, columns if isinstance(columns, int) else columns[0]))
    allowed = (columns,) if isinstance(columns, int) else columns
    width = int(rows.counts[0]) if rows.counts[0] in allowed else allowed[0]
    check_lines(rows.counts != width, rows.lines, name, expected, lambda i: f"{rows.counts[i]} numbers")
    first = int(rows.starts[0])
    return rows.values[first : first + width * len(rows)].reshape(len(rows), width)
