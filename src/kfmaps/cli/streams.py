"""``-`` as an argument: standard input as a file to read, standard output as a file to write."""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from pathlib import Path

from kfmaps._errors import refuse

_STREAM = re.compile(r"-(\.[a-z][a-z.]*)?")
_OUTPUTS = ("-o", "--output", "--curve")
_FORMATS = {"match": ".txt", "transfer": ".csv", "export": ".ply", "view": ".html", "config": ".toml", "render": ".png"}
"""Format that a command writes to ``-``; ``-.npz`` chooses another one. Other commands write folders."""
_SIGNATURES = (
    (rb"ply\s", ".ply"),
    (rb"(ST)?C?N?4?n?OFF\b", ".off"),
    (rb"glTF", ".glb"),
    (rb"# vtk DataFile", ".vtk"),
    (rb"<(\?xml|VTKFile)", ".vtp"),
    (rb"solid\b", ".stl"),
    (rb"PK\x03\x04", ".npz"),
    (rb"\x93NUMPY", ".npy"),
    (rb"MATLAB", ".mat"),
    (rb"# Markups", ".fcsv"),
    (rb"\s*\{", ".mrk.json"),
    (rb"(\s*#[^\n]*\n|(mtllib|o|g|s) [^\n]*\n|\s)*v\s+\S+\s+\S", ".obj"),
    (rb"(#[^\n]*\n)*[^\n#]*,", ".csv"),
)
"""Patterns of the first bytes of each format; anything else is plain text."""


def content_suffix(data: bytes) -> str:
    """Return the extension of a file with this content."""
    return next((suffix for start, suffix in _SIGNATURES if re.match(start, data)), ".txt")


@contextmanager
def standard_streams(words: Sequence[str], command: str) -> Iterator[list[str]]:
    """Replace ``-`` among the arguments of a command by temporary files.

    An input file is filled from standard input. An output file is printed on standard output when the block ends, and
    the command's own lines go to standard error. The name of the ``command`` decides the format. Two inputs or two
    outputs ``-`` are refused, and one where a command writes a folder.
    """
    stream_words = [i for i, word in enumerate(words) if _STREAM.fullmatch(word)]
    outputs = [i for i in stream_words if i and words[i - 1] in _OUTPUTS]
    inputs = [i for i in stream_words if i not in outputs]
    for name, indices in (("standard input", inputs), ("standard output", outputs)):
        if len(indices) > 1:
            raise refuse(name, "one file", f"{len(indices)} times -", "name the other files")
    words = list(words)
    if not stream_words:
        yield words
        return
    with tempfile.TemporaryDirectory(prefix="kfmaps-") as folder:
        for i in inputs:
            data = sys.stdin.buffer.read()
            if not data:
                raise refuse("standard input", "a file", "nothing", "send one, or name it")
            path = Path(folder) / f"standard-input{words[i][1:] or content_suffix(data)}"
            path.write_bytes(data)
            words[i] = str(path)
        if not outputs:
            yield words
            return
        suffix = words[outputs[0]][1:] or _FORMATS.get(command)
        if suffix is None:
            raise refuse("output -", "a folder or a file with a name", "standard output", "name it")
        path = Path(folder) / f"standard-output{suffix}"
        words[outputs[0]] = str(path)
        with redirect_stdout(sys.stderr):
            yield words
        if path.exists():
            _print(path.read_bytes())


def _print(data: bytes) -> None:
    if hasattr(sys.stdout, "buffer"):
        sys.stdout.flush()
        sys.stdout.buffer.write(data)
    else:
        sys.stdout.write(data.decode("utf-8"))
