"""Polygonal data of VTK, as its writers lay it out."""

from __future__ import annotations

import base64
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from conftest import refusal
from kfmaps._arrays import KfmapsWarning
from kfmaps.io import read_mesh_file
from kfmaps.io.landmark_files import mesh_space
from kfmaps.io.vtk import parse_vtp

GUARDS = ("kfmaps.io.vtk",)

POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5], [2, 0.25, 1]])
CORNERS = np.array([0, 1, 2, 3, 1, 4, 2])
SIZES = np.array([4, 3])
TRIANGLES = [[0, 1, 2], [0, 2, 3], [1, 4, 2]]


def cells() -> np.ndarray:
    return np.concatenate([[4], CORNERS[:4], [3], CORNERS[4:]])


def text(numbers: np.ndarray) -> bytes:
    return " ".join(f"{x:g}" for x in np.ravel(numbers)).encode() + b"\n"


def legacy(binary: bool, new: bool) -> bytes:
    """As VTK 9 writes it (``new``), or VTK 6; with a field that names the coordinate system, and with metadata."""

    def put(numbers: np.ndarray, kind: str) -> bytes:
        return np.ravel(numbers).astype(kind).tobytes() + b"\n" if binary else text(numbers)

    head = f"# vtk DataFile Version {'5.1' if new else '4.2'}\nvtk output\n{'BINARY' if binary else 'ASCII'}\n"
    space = bytes([0xC0 | 3]) + b"LPS\n" if binary else b"LPS\n"
    start = head.encode() + b"DATASET POLYDATA\nFIELD FieldData 2\nSPACE 1 1 string\n" + space
    start += b"Steps 1 2 int\n" + put(np.array([1, 2]), ">i4")
    start += f"POINTS {len(POINTS)} float\n".encode() + put(POINTS, ">f4")
    start += b"METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1 \n\n"
    start += b"LINES 2 2\nOFFSETS vtktypeint64\n" if new else b"LINES 1 3\n"
    if new:
        start += put(np.array([0, 2]), ">i8") + b"CONNECTIVITY vtktypeint64\n" + put(np.array([0, 1]), ">i8")
        ends = np.concatenate([[0], np.cumsum(SIZES)])
        faces = f"POLYGONS {len(ends)} {len(CORNERS)}\nOFFSETS vtktypeint64\n".encode() + put(ends, ">i8")
        faces += b"CONNECTIVITY vtktypeint64\n" + put(CORNERS, ">i8")
    else:
        start += put(np.array([2, 0, 1]), ">i4")
        faces = f"POLYGONS 2 {len(cells())}\n".encode() + put(cells(), ">i4")
    return start + faces + b"\nPOINT_DATA 5\nSCALARS s float\nLOOKUP_TABLE default\n" + put(np.arange(5.0), ">f4")


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("new", [False, True])
def test_legacy_files(tmp_path: Path, binary: bool, new: bool) -> None:
    (tmp_path / "a.vtk").write_bytes(legacy(binary, new))
    with pytest.warns(KfmapsWarning, match="1 boundary loop"):
        mesh = read_mesh_file(tmp_path / "a.vtk").mesh
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    np.testing.assert_array_equal(mesh.faces, TRIANGLES)
    assert mesh_space(tmp_path / "a.vtk") == "LPS"


def encoded(values: bytes, packed: bool, raw: bool) -> bytes:
    """An array of a file with 8-byte heads: zlib in blocks of 16 bytes, or plain; in base64, or ``raw``."""
    code: Callable[[bytes], bytes] = bytes if raw else base64.b64encode
    if not packed:
        return code(np.uint64(len(values)).tobytes() + values)
    blocks = [values[i : i + 16] for i in range(0, len(values), 16)]
    small = [zlib.compress(block) for block in blocks]
    head = np.array([len(blocks), 16, len(values) % 16, *map(len, small)], dtype=np.uint64)
    return code(head.tobytes()) + code(b"".join(small))


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("where", ["ascii", "binary", "appended base64", "appended raw"])
def test_xml_files(packed: bool, where: str) -> None:
    arrays = (
        ("Float32", 'NumberOfComponents="3"', POINTS.astype("<f4")),
        ("Int64", 'Name="connectivity"', CORNERS.astype("<i8")),
        ("Int32", 'Name="offsets"', np.cumsum(SIZES).astype("<i4")),
    )
    appended, parts = b"_", []
    for kind, attributes, values in arrays:
        inside, extra = b"", ""
        if where == "ascii":
            inside = text(values)
        elif where == "binary":
            inside = b"\n  " + encoded(values.tobytes(), packed, False) + b"\n"
        else:
            extra = f' offset="{len(appended) - 1}"'
            appended += encoded(values.tobytes(), packed, where.endswith("raw"))
        tag = f'<DataArray type="{kind}" {attributes} format="{where.split()[0]}"{extra}>'
        parts.append(tag.encode() + inside + b"</DataArray>")
    compressor = ' compressor="vtkZLibDataCompressor"' if packed else ""
    data = f'<?xml version="1.0"?>\n<VTKFile type="PolyData" header_type="UInt64"{compressor}><PolyData>'.encode()
    data += b'<Piece NumberOfPoints="5" NumberOfPolys="2"><Points>' + parts[0] + b"</Points><Polys>"
    data += parts[1] + parts[2] + b"</Polys></Piece></PolyData>"
    if where.startswith("appended"):
        data += f'<AppendedData encoding="{where.split()[1]}">\n  '.encode() + appended + b"\n</AppendedData>"
    mesh = parse_vtp(data + b"</VTKFile>", "a.vtp").mesh
    np.testing.assert_array_equal(mesh.vertices, POINTS)
    np.testing.assert_array_equal(mesh.faces, TRIANGLES)


HEAD = b"# vtk DataFile Version 3.0\nv\nASCII\nDATASET "


@pytest.mark.parametrize(
    ("name", "data", "output"),
    [
        ("a.vtk", b"ply\n", "another beginning"),
        ("a.vtk", HEAD + b"UNSTRUCTURED_GRID\n", "got UNSTRUCTURED_GRID. Save the surface as PLY"),
        ("a.vtk", HEAD + b"POLYDATA\nPOINTS 2 float\n0 0 0 1\n", "6 numbers"),
        ("a.vtk", HEAD + b"POLYDATA\nPOINTS 1 float\n0 0 0\nTRIANGLE_STRIPS 1 2\n", "triangle strips"),
        ("a.vtk", HEAD + b"POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 1 4\n3 0 0 7\n", "numbers from 0 to 0, got 7"),
        ("a.vtk", HEAD + b"POLYDATA\n", "points"),
        ("a.vtk", legacy(True, True)[:400], "complete .vtk"),
        ("a.vtp", b'<VTKFile type="UnstructuredGrid"/>', "got UnstructuredGrid"),
        ("a.vtp", b'<VTKFile type="PolyData" compressor="vtkLZ4DataCompressor"/>', "zlib"),
        ("a.vtp", b'<!DOCTYPE a [<!ENTITY b "c">]><VTKFile type="PolyData"/>', "declarations"),
        ("a.vtp", b'<VTKFile type="PolyData"/>', "a piece with points"),
        ("a.vtp", b"<VTKFile", "complete .vtp"),
    ],
)
def test_bad_vtk_files_are_refused(tmp_path: Path, name: str, data: bytes, output: str) -> None:
    assert output in refusal(read_mesh_file, tmp_path / name, data)
