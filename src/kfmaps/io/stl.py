"""STL, triangles without shared vertices."""

from __future__ import annotations

import re

import numpy as np

from kfmaps._arrays import check, refuse
from kfmaps.geometry.connectivity import unique_vertices
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile
from kfmaps.io.text import REPAIR, as_table, clean_text, parse_rows

_HEAD = 84
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attributes", "<u2")])
_FACET = re.compile(
    rb"facet\s+normal(?:\s+\S+){3}\s+outer\s+loop"
    + 3 * rb"\s+vertex\s+(\S+\s+\S+\s+\S+)"
    + rb"\s+endloop\s+endfacet(?=\s)",
    re.IGNORECASE,
)
_SOLID, _END = (re.compile(rb"\s*" + word + rb"\b", re.IGNORECASE) for word in (b"solid", b"endsolid"))


def parse_stl(data: bytes, name: str) -> MeshFile:
    """Read STL, binary or text.

    STL is the one format without shared vertices: each triangle repeats its three positions. Here, and only here,
    positions that are equal to the last bit become one vertex, or there would be no surface. Vertices are numbered in
    the order of their first occurrence.
    """
    count = int.from_bytes(data[80:84], "little") if len(data) >= _HEAD else -1
    if count >= 0 and len(data) == _HEAD + _TRIANGLE.itemsize * count:
        places = np.frombuffer(data, _TRIANGLE, count, _HEAD)["corners"].reshape(-1, 3).astype(np.float64)
    elif re.match(rb"\s*solid\b", data, re.IGNORECASE) and b"\0" not in data:
        places = _text_places(clean_text(data, name, comment=b"\0"), name)
    else:
        got = f"{len(data)} bytes" if count < 0 else f"{len(data)} bytes for {count} triangles"
        expected = f"{_HEAD} bytes and {_TRIANGLE.itemsize} per triangle, or text that begins with solid"
        raise refuse(name, expected, got, "the file is cut short or is no STL: export it again")
    check(places, f"{name}: vertices", remedy=REPAIR)
    first = unique_vertices(places)
    distinct = np.unique(first)
    return MeshFile(Mesh(places[distinct], np.searchsorted(distinct, first).reshape(-1, 3)))


def _text_places(text: bytes, name: str) -> np.ndarray:
    """Return the three positions of each triangle, (3 t, 3)."""
    # Line by line: one pattern for all solids would try every way to split the file into them.
    rest = [line for line in _FACET.sub(b"", text).split(b"\n") if not line.isspace() and line]
    paired = len(rest) % 2 == 0 and all(map(_SOLID.match, rest[::2])) and all(map(_END.match, rest[1::2]))
    if not (rest and paired):
        got = "something else in between, or an end before endsolid"
        raise refuse(name, "facets of three vertices from solid to endsolid", got, REPAIR)
    corners = b"\n".join(b"\n".join(facet) for facet in _FACET.findall(text))
    return as_table(parse_rows(corners, f"{name}: vertices"), 3, f"{name}: vertices", "x y z")
