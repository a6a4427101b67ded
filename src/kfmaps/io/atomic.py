"""Write files whole or not at all."""

from __future__ import annotations

import csv
import io
import math
import os
import secrets
import shutil
import stat
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from kfmaps._arrays import refuse

_UNFINISHED = ".unfinished-"  # prefix of files that are still being written

_STREAMS = ("/dev/std", "/dev/fd/", "/proc/")
"""Names of streams that the process has open; a new file under such a name would not receive its output."""


def remove_unfinished(folder: Path, older: float = 0.0) -> None:
    """Remove half-written files of killed processes from ``folder`` that are at least ``older`` seconds old."""
    for path in folder.glob(f"{_UNFINISHED}*"):
        with suppress(OSError):  # somebody else has removed it
            if time.time() - path.stat().st_mtime >= older:
                path.unlink()


def check_output(path: str | Path, force: bool = False, reads: Iterable[str | Path | None] = ()) -> Path:
    """Return the file that writing to ``path`` would make, with links followed; call this before long work.

    ``force``: whether an existing file may be replaced; ``reads``: files that the work reads; they are never replaced.

    Raises
    ------
    InvalidInput
        When its folder is missing or may not be written, it is a folder or device, it is one of ``reads``, or it
        exists and ``force`` is not given.
    """
    resolved, name = Path(path), f"output {path}"
    try:
        resolved = Path(os.path.realpath(path))
        # Of ``path``, since the real path of a pipe, such as that behind /dev/stdout, is no name of a file.
        kind = stat.S_IFMT(os.stat(path).st_mode)
    except FileNotFoundError:
        kind = None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        got = getattr(error, "strerror", None) or str(error)
        raise refuse(name, "a name that can be written", got, "choose another") from error
    if kind is None and not resolved.parent.is_dir():
        raise refuse(name, "an existing folder", f"no folder {resolved.parent}", "make it first")
    if not os.access(resolved.parent, os.W_OK):
        raise refuse(name, "a folder to write in", f"no right to write in {resolved.parent}", "choose another")
    if kind not in (None, stat.S_IFREG) or os.path.abspath(path).startswith(_STREAMS):
        got = "a folder" if kind == stat.S_IFDIR else "a device or pipe"
        raise refuse(name, "the name of a file", got, "name a file to write")
    for other in reads:
        if kind is not None and other is not None and os.path.exists(other) and os.path.samefile(path, other):
            raise refuse(name, "a file other than the inputs", f"the input {other}", "name another file")
    if kind is not None and not force:
        raise refuse(name, "a new file", "an existing one", "give --force to replace it")
    return resolved


@contextmanager
def atomic_output(path: str | Path, force: bool = False) -> Iterator[Path]:
    """Yield a temporary file to write, which is renamed to ``path`` when the block ends without an error.

    When the block raises, the temporary file is removed and ``path`` is as it was. The temporary file has the suffix of
    ``path`` and lies in the same folder, because a rename is atomic only within a file system. A replaced file keeps
    its permissions. ``force`` and errors are as in :func:`check_output`.
    """
    resolved = check_output(path, force)
    temporary = resolved.with_name(f"{_UNFINISHED}{secrets.token_hex(6)}{resolved.suffix}")
    try:
        os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        yield temporary
        check_output(path, force)  # someone else may have made it meanwhile
        if resolved.exists():
            shutil.copymode(resolved, temporary)
        with open(temporary, "r+b") as file:
            os.fsync(file.fileno())  # otherwise a power cut after the rename could leave an empty file
        os.replace(temporary, resolved)
    except OSError as error:
        # The error of a full disk names no file, and other errors name the temporary one.
        if error.filename is None or os.fspath(error.filename) == str(temporary):
            raise OSError(error.errno or 0, error.strerror or str(error), str(path)) from error
        raise
    finally:
        temporary.unlink(missing_ok=True)


def write_bytes(path: str | Path, content: bytes, force: bool = False) -> None:
    """Write a file, whole or not at all (:func:`atomic_output`)."""
    with atomic_output(path, force) as temporary:
        temporary.write_bytes(content)


def write_text(path: str | Path, text: str, force: bool = False) -> None:
    """Write UTF-8 text, whole or not at all; line ends stay as they are."""
    write_bytes(path, text.encode(), force)


def table_cell(value: float, form: str = "") -> str:
    """Return a number as tables have it: all its digits, or in the ``form`` of a format string; NA for NaN."""
    return "NA" if math.isnan(value) else f"{value:{form}}" if form else repr(float(value))


def csv_text(rows: Iterable[Iterable[object]]) -> str:
    """Return rows as comma-separated values."""
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
