"""VTK's polygonal data, legacy (``.vtk``) and XML (``.vtp``): points and polygons; all else is left out."""

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
from kfmaps.io.text import REPAIR, complete_or_refuse

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
    with complete_or_refuse(name, "a complete .vtk file"):
        return _Legacy(data, name, len(data) - len(head[3]), head[2].strip().upper() == b"BINARY").read()


class _Legacy:
    """A place in a legacy file."""

    def __init__(self, data: bytes, name: str, at: int, binary: bool) -> None:
        self.data, self.name, self.at, self.binary = data, name, at, binary

    def line(self) -> list[str]:
        """Return the words of the next line that has any; none at the end of the file."""
        while self.at < len(self.data):
            end = self.data.find(b"\n", self.at)
            end = len(self.data) if end < 0 else end
            words = self.data[self.at : end].decode("latin-1").split()
            self.at = end + 1
            if words:
                return words
        return []

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
        if count:
            self.at = words[-1].end()
        return np.array([word[0] for word in words], dtype="S").astype(np.float64)

    def cells(self, words: list[str]) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners of cells and how many each has; version 5 has their ends instead."""
        count, size = int(words[1]), int(words[2])
        start = self.at
        following = self.line()
        if following and following[0] == "OFFSETS":
            ends = self.numbers(count, following[1]).astype(np.int64)
            corners = self.numbers(size, self.line()[1]).astype(np.int64)
            return corners, np.diff(ends)
        self.at = start
        return split_polygons(self.numbers(size, "int"))

    def field(self, count: int) -> None:
        """Pass over ``count`` arrays that say something of the whole."""
        for _ in range(count):
            _, width, length, kind = self.line()
            if kind == "string":
                for _ in range(int(width) * int(length)):
                    if self.binary:
                        self.at += 1 + (self.data[self.at] & 63)
                    else:
                        self.line()
            else:
                self.numbers(int(width) * int(length), kind)

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
                end = self.data.find(b"\n\n", self.at)
                self.at = len(self.data) if end < 0 else end
            elif key in ("POINT_DATA", "CELL_DATA"):
                break
        if points is None:
            raise refuse(self.name, "points", "none", REPAIR)
        return _mesh(points, corners, sizes, self.name)


def parse_vtp(data: bytes, name: str) -> MeshFile:
    """Read an XML file (https://docs.vtk.org, "XML File Formats"): text, base64 or appended arrays, plain or zlib."""
    with complete_or_refuse(name, "a complete .vtp file"):
        return _read_xml(data, name)


def _read_xml(data: bytes, name: str) -> MeshFile:
    head, mark, rest = data.partition(b"<AppendedData")
    if b"<!" in head.replace(b"<!--", b""):
        raise refuse(name, "XML without declarations of its own", "one", REMEDY)
    appended, raw = b"", False
    if mark:
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
        found = piece.find(path)
        if found is None:
            return np.zeros(0)
        if found.get("format", "ascii") == "ascii":
            return np.array((found.text or "").split(), dtype=np.float64)
        block = appended[int(found.get("offset", 0)) :] if found.get("format") == "appended" else b""
        block = block or (found.text or "").strip().encode("ascii")
        order = ">" if root.get("byte_order") == "BigEndian" else "<"
        size = np.dtype(order + TYPES[root.get("header_type", "UInt32")])
        plain = raw and found.get("format") == "appended"
        content = _unpacked(block, size, plain, root.get("compressor") is not None, name)
        return np.frombuffer(content, order + TYPES[found.get("type", "")])

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


def _unpacked(block: bytes, size: np.dtype, raw: bool, packed: bool, name: str) -> bytes:
    """The bytes of an array: a head of ``size`` numbers and the content, in base64 unless ``raw``."""
    width = size.itemsize

    def take(first: int, count: int) -> bytes:
        """Return ``count`` bytes of what begins at ``first`` and is encoded by itself."""
        if raw:
            return block[first : first + count]
        return base64.b64decode(block[first : first + 4 * -(-count // 3)])[:count]

    def length(count: int) -> int:
        return count if raw else 4 * -(-count // 3)

    if not packed:
        count = int(np.frombuffer(take(0, width), size)[0])
        return take(0, width + count)[width:]
    n_blocks, full, last = np.frombuffer(take(0, 3 * width), size).astype(np.int64).tolist()
    head = np.frombuffer(take(0, (3 + n_blocks) * width), size).astype(np.int64)
    content = take(length((3 + n_blocks) * width), int(head[3:].sum()))
    if full > 1000 * len(block) or n_blocks > len(block):
        raise refuse(name, "blocks of a size that fits the file", f"{full} bytes each", REPAIR)
    parts, at = [], 0
    for i, count in enumerate(head[3:].tolist()):
        most = last if last and i == n_blocks - 1 else full
        parts.append(zlib.decompressobj().decompress(content[at : at + count], most))
        at += count
    return b"".join(parts)


def _mesh(points: np.ndarray, corners: np.ndarray, sizes: np.ndarray, name: str) -> MeshFile:
    vertices = np.array(points, dtype=np.float64).reshape(-1, 3)
    if len(sizes) and (sizes.min() < 3 or sizes.sum() != len(corners)):
        raise refuse(name, "polygons of three corners or more", f"{sizes.min()} corners", REPAIR)
    if len(corners) and (corners.min() < 0 or corners.max() >= len(vertices)):
        bad = int(corners[(corners < 0) | (corners >= len(vertices))][0])
        raise refuse(name, f"vertices from 0 to {len(vertices) - 1}", f"{bad}", REPAIR)
    return MeshFile(Mesh(vertices, corners[fan(sizes)] if len(sizes) else np.zeros((0, 3), dtype=np.int64)))
