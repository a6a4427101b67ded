"""Read MATLAB's .mat files of version 5 strictly; ``save`` writes them without the option ``-v7.3``.

A damaged file can end the whole process in SciPy's reader, so that is not used.
"""

from __future__ import annotations

import struct
import zlib

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._memory import format_bytes
from kfmaps.io.text import REPAIR

_MATRIX, _COMPRESSED = 14, 15
_NUMBERS = {1: "<i1", 2: "<u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4", 9: "<f8", 12: "<i8", 13: "<u8"}
_ENCODINGS = {2: "latin-1", 4: "utf-16-le", 16: "utf-8", 17: "utf-16-le", 18: "utf-32-le"}
_CHAR, _NUMERIC, _COMPLEX = 4, range(6, 16), 0x0800


def read_mat(data: bytes, name: str, limit: int = 1 << 31) -> dict[str, np.ndarray | str]:
    """Return the real arrays and texts of a .mat file by name; cells, structures and other kinds are left out.

    ``name``: how messages call it; ``limit``: bytes that the file may unpack to, every number counted as eight.
    """
    if data[:10] == b"MATLAB 7.3" or data[1:4] == b"HDF":
        raise refuse(name, "a .mat file of version 5 to 7", "version 7.3", "save it with the option -v7")
    if data[126:128] != b"IM":
        raise refuse(name, "a .mat file", "something else", "check the extension")
    content: dict[str, np.ndarray | str] = {}
    at, unpacked = 128, 0.0
    while at < len(data):
        kind, body, at = _element(data, at, name, top=True)
        if kind == _COMPRESSED:
            body = _unpack(body, name, unpacked, limit)
            unpacked += len(body)
            kind, body, _ = _element(body, 0, name)
        if kind != _MATRIX:
            raise _damaged(name)
        variable = _variable(body, name)
        if variable is not None:
            content[variable[0]] = variable[1]
            unpacked += 8 * np.size(variable[1]) if isinstance(variable[1], np.ndarray) else 4 * len(variable[1])
            check_unpacked(unpacked, limit, name)
    return content


def _unpack(body: bytes, name: str, unpacked: float, limit: int) -> bytes:
    """Unpack a compressed element, at most as many bytes as it declares, and with ``unpacked`` at most ``limit``."""
    stream = zlib.decompressobj()
    try:
        head = stream.decompress(body, 8)
        if len(head) < 8:
            raise _damaged(name)
        kind, size = struct.unpack("<2I", head)
        size = 0 if kind >> 16 else size  # a small element is all in its head
        check_unpacked(unpacked + size, limit, name)
        rest = stream.decompress(stream.unconsumed_tail, size) if size else b""
        stream.decompress(stream.unconsumed_tail, 8)
    except zlib.error as error:
        raise _damaged(name) from error
    if not stream.eof:
        raise _damaged(name)
    return head + rest


def check_unpacked(size: float, limit: int, name: str) -> None:
    """Refuse a map file that unpacks to more than ``limit`` bytes."""
    if size > limit:
        expected = f"a map of at most {format_bytes(limit)} unpacked"
        raise refuse(name, expected, format_bytes(size), "a map takes a few numbers for each vertex: check the file")


def _damaged(name: str) -> Exception:
    return refuse(name, "a complete .mat file", "one that is cut short or damaged", REPAIR)


def _element(data: bytes, at: int, name: str, top: bool = False) -> tuple[int, bytes, int]:
    """Type and bytes of the element at ``at``, and where the next one begins."""
    if at + 8 > len(data):
        raise _damaged(name)
    kind, size = struct.unpack_from("<2I", data, at)
    small = kind >> 16  # the bytes of a small element, which stand with its type in eight
    if small:
        kind, size, start, following = kind & 0xFFFF, small, at + 4, at + 8
    else:
        start = at + 8
        following = start + (size if top else -(-size // 8) * 8)  # elements of a matrix begin at multiples of 8
    if start + size > len(data) or small > 4:
        raise _damaged(name)
    return kind, data[start : start + size], following


def _variable(body: bytes, name: str) -> tuple[str, np.ndarray | str] | None:
    """Name and value of a matrix element; None for kinds that are left out."""
    _, flags, at = _element(body, 0, name)
    if len(flags) != 8:
        raise _damaged(name)
    kind, flag_bits = flags[0], int.from_bytes(flags[:4], "little")
    if (kind != _CHAR and kind not in _NUMERIC) or flag_bits & _COMPLEX:
        return None
    code, raw_shape, at = _element(body, at, name)
    _, title, at = _element(body, at, name)
    if code != 5 or len(raw_shape) % 4 or len(raw_shape) < 8 or not title.isascii():
        raise _damaged(name)
    code, raw, _ = _element(body, at, name)
    if kind == _CHAR:
        try:
            return title.decode("ascii"), raw.decode(_ENCODINGS.get(code, ""))
        except (LookupError, UnicodeDecodeError) as error:
            raise _damaged(name) from error
    shape, item = np.frombuffer(raw_shape, "<i4").tolist(), np.dtype(_NUMBERS[code]) if code in _NUMBERS else None
    if item is None or min(shape) < 0 or np.prod(shape, dtype=float) * item.itemsize != len(raw):
        raise _damaged(name)
    return title.decode("ascii"), np.frombuffer(raw, item).reshape(shape, order="F").astype(item.newbyteorder("="))
