"""Read points and polygons of VTK's polygonal data, legacy (``.vtk``) and XML (``.vtp``)."""

from __future__ import annotations

import base64
import re
import zlib
from itertools import islice
from xml.etree import ElementTree

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile, fan, split_polygons
from kfmaps.io.text import REPAIR

REMEDY = "Save the surface as PLY in 3D Slicer or ParaView"
TYPES = {
    **{"unsigned_char": "u1", "char": "i1", "short": "i2", "unsigned_short": "u2", "int": "i4", "unsigned_int": "u4"},
    **{"long": "i8", "unsigned_long": "u8", "vtkIdType": "i8", "vtktypeint64": "i8", "float": "f4", "double": "f8"},
    **{"Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4"},
    **{"Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8"},
}
"""NumPy's types by the names in either format."""
_WORD = re.compile(rb"\S+")


def parse_vtk(data: bytes, name: str) -> MeshFile:
    """Read a legacy file of version 2 to 5.1 (https://docs.vtk.org, "Simple Legacy Formats"), text or binary."""
    head = data.split(b"\n", 3)
    if len(head) < 4 or not head[0].startswith(b"# vtk DataFile"):
        raise refuse(name, "a VTK file", "another beginning", "check that the extension is right")
    return _Legacy(data, name, len(data) - len(head[3]), head[2].strip().upper() == b"BINARY").read()


class _Legacy:
    """The content of a legacy file, and the position ``at`` up to which it has been read."""

    def __init__(self, data: bytes, name: str, at: int, binary: bool) -> None:
        self.data, self.name, self.at, self.binary = data, name, at, binary

    def line(self) -> list[str]:
        """Return the words of the next line that has any; none at the end of the file."""
        while self.at < len(self.data):
            words = self._up_to(b"\n").decode("latin-1").split()
            if words:
                return words
        return []

    def _up_to(self, mark: bytes) -> bytes:
        """Return the bytes before the next ``mark`` or the end, and go on behind the mark."""
        end = self.data.find(mark, self.at)
        start, end = self.at, len(self.data) if end < 0 else end
        self.at = end + len(mark)
        return self.data[start:end]

    def numbers(self, count: int, kind: str) -> np.ndarray:
        """Return the next ``count`` numbers."""
        if self.binary:
            dtype = np.dtype(">" + TYPES[kind])
            values = np.frombuffer(self.data, dtype, count, self.at)
            self.at += count * dtype.itemsize
            return values
        words = list(islice(_WORD.finditer(self.data, self.at), count))
        if len(words) < count:
            raise refuse(self.name, f"{count} numbers", f"{len(words)}", REPAIR)
        self.at = words[-1].end() if words else self.at
        return np.array([word[0] for word in words], dtype="S").astype(np.float64)

    def cells(self, words: list[str]) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners of cells and how many each has; version 5 stores offsets instead of counts."""
        count, size, start = int(words[1]), int(words[2]), self.at
        following = self.line()
        if following[:1] == ["OFFSETS"]:
            ends = self.numbers(count, following[1]).astype(np.int64)
            return self.numbers(size, self.line()[1]).astype(np.int64), np.diff(ends)
        self.at = start
        return split_polygons(self.numbers(size, "int"))

    def field(self, count: int) -> None:
        """Skip ``count`` arrays of data of the whole file."""
        for _ in range(count):
            _, width, length, kind = self.line()
            size = int(width) * int(length)
            if kind != "string":
                self.numbers(size, kind)
            for _ in range(size if kind == "string" else 0):
                if self.binary:
                    self.at += 1 + (self.data[self.at] & 63)
                else:
                    self.line()

    def read(self) -> MeshFile:
        points, corners, sizes = None, np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
        while words := self.line():
            key = words[0].upper()
            if key == "DATASET" and words[1].upper() != "POLYDATA":
                raise refuse(self.name, "polygonal data (POLYDATA)", words[1], REMEDY)
            if key == "FIELD":
                self.field(int(words[2]))
            elif key == "POINTS":
                points = self.numbers(3 * int(words[1]), words[2].lower())
            elif key == "POLYGONS":
                corners, sizes = self.cells(words)
            elif key in ("VERTICES", "LINES"):
                self.cells(words)
            elif key == "TRIANGLE_STRIPS":
                raise refuse(self.name, "polygons", "triangle strips", REMEDY)
            elif key == "METADATA":
                self._up_to(b"\n\n")
            elif key in ("POINT_DATA", "CELL_DATA"):
                break
        if points is None:
            raise refuse(self.name, "points", "none", REPAIR)
        return _mesh(points, corners, sizes, self.name)


def parse_vtp(data: bytes, name: str) -> MeshFile:
    """Read an XML file (https://docs.vtk.org, "XML File Formats"): text, base64 or appended arrays, plain or zlib."""
    head, separator, rest = data.partition(b"<AppendedData")
    if b"<!" in head.replace(b"<!--", b""):
        raise refuse(name, "XML without declarations of its own", "one", REMEDY)
    appended, raw = b"", False
    if separator:
        opening, _, body = rest.partition(b">")
        raw = b"raw" in opening
        appended = body[body.index(b"_") + 1 :]
        head += b"</VTKFile>"
    root = ElementTree.fromstring(head)
    if root.get("type") != "PolyData":
        raise refuse(name, "polygonal data (PolyData)", str(root.get("type")), REMEDY)
    if root.get("compressor") not in (None, "vtkZLibDataCompressor"):
        raise refuse(name, "arrays that are plain or compressed by zlib", str(root.get("compressor")), REMEDY)

    def array(piece: ElementTree.Element, path: str) -> np.ndarray:
        element = piece.find(path)
        if element is None:
            return np.zeros(0)
        if element.get("format", "ascii") == "ascii":
            return np.array((element.text or "").split(), dtype=np.float64)
        block = appended[int(element.get("offset", 0)) :] if element.get("format") == "appended" else b""
        block = block or (element.text or "").strip().encode("ascii")
        order = ">" if root.get("byte_order") == "BigEndian" else "<"
        size = np.dtype(order + TYPES[root.get("header_type", "UInt32")])
        is_raw = raw and element.get("format") == "appended"
        content = _unpack(block, size, is_raw, root.get("compressor") is not None, name)
        return np.frombuffer(content, order + TYPES[element.get("type", "")])

    points, corners, sizes, count = [], [], [], 0
    for piece in root.iterfind("PolyData/Piece"):
        if int(piece.get("NumberOfStrips", 0)):
            raise refuse(name, "polygons", "triangle strips", REMEDY)
        points.append(array(piece, "Points/DataArray"))
        corners.append(array(piece, "Polys/DataArray[@Name='connectivity']").astype(np.int64) + count)
        ends = array(piece, "Polys/DataArray[@Name='offsets']").astype(np.int64)
        sizes.append(np.diff(ends, prepend=0))
        count += len(points[-1]) // 3
    if not points:
        raise refuse(name, "a piece with points", "none", REPAIR)
    return _mesh(np.concatenate(points), np.concatenate(corners), np.concatenate(sizes), name)


def _unpack(block: bytes, size: np.dtype, is_raw: bool, is_compressed: bool, name: str) -> bytes:
    """Return the bytes of an array: a head of ``size`` numbers and the content, in base64 unless ``is_raw``."""
    width = size.itemsize

    def take(first: int, count: int) -> tuple[bytes, int]:
        """Return ``count`` bytes of the separately encoded part that begins at ``first``, and where it ends."""
        end = first + (count if is_raw else 4 * -(-count // 3))
        return (block[first:end] if is_raw else base64.b64decode(block[first:end])[:count]), end

    def numbers(count: int) -> tuple[list[int], int]:
        content, end = take(0, count * width)
        return np.frombuffer(content, size).astype(np.int64).tolist(), end

    if not is_compressed:
        return take(0, width + numbers(1)[0][0])[0][width:]
    n_blocks, full, last = numbers(3)[0]
    head, end = numbers(3 + n_blocks)
    content, _ = take(end, sum(head[3:]))
    if full > 1000 * len(block) or n_blocks > len(block):
        raise refuse(name, "blocks of a size that fits the file", f"{full} bytes each", REPAIR)
    parts, at = [], 0
    for i, count in enumerate(head[3:]):
        most = last if last and i == n_blocks - 1 else full
        parts.append(zlib.decompressobj().decompress(content[at : at + count], most))
        at += count
    return b"".join(parts)


def _mesh(points: np.ndarray, corners: np.ndarray, sizes: np.ndarray, name: str) -> MeshFile:
    if len(sizes) and (sizes.min() < 3 or sizes.sum() != len(corners)):
        raise refuse(name, "polygons of three corners or more", f"{sizes.min()} corners", REPAIR)
    return MeshFile(Mesh(np.array(points, dtype=np.float64).reshape(-1, 3), corners[fan(sizes)]))
