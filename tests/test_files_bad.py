"""Files that cannot be used: one clear line each, never garbage, another exception or a hang."""

from __future__ import annotations

import struct
import warnings
from pathlib import Path

import pytest

from conftest import blob, fibonacci_sphere, refusal
from kfmaps._arrays import InvalidInput
from kfmaps.io import MeshFile, read_mesh, write_mesh
from kfmaps.io.off import format_off

MESH = fibonacci_sphere(20)
OFF = format_off(MeshFile(MESH))


def refused(path: Path, content: bytes | None = None) -> str:
    output = refusal(read_mesh, path, content)
    assert path.name in output
    assert "got" in output
    return output


def test_missing_empty_and_unknown_files_are_refused(tmp_path: Path) -> None:
    assert "nothing there" in refused(tmp_path / "none.off")
    assert "an empty file" in refused(tmp_path / "a.off", b"")
    (tmp_path / "folder.off").mkdir()
    assert "a folder" in refused(tmp_path / "folder.off")
    assert "got .xy" in refused(tmp_path / "a.xy", b"x")
    assert "no extension" in refused(tmp_path / "a", OFF)


def test_device_and_impossible_name(tmp_path: Path) -> None:
    device = tmp_path / "zero.off"
    device.symlink_to("/dev/zero")
    assert "a device" in refused(device)
    with pytest.raises(InvalidInput, match=r"a\.off"):
        read_mesh(tmp_path / "\0a.off")
    with pytest.raises(InvalidInput, match="expected"):
        read_mesh(tmp_path / ("a" * 5000 + ".off"))


def test_a_file_larger_than_memory(tmp_path: Path) -> None:
    """A sparse one takes no room on the disk, and all of the memory."""
    with open(tmp_path / "a.off", "wb") as file:
        file.truncate(1 << 42)
    assert "of memory, got 4,398 GB for the file alone" in refused(tmp_path / "a.off")


def test_unreadable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def denied(_: Path) -> bytes:
        raise PermissionError(13, "Permission denied")

    (tmp_path / "a.off").write_bytes(OFF)
    monkeypatch.setattr(Path, "read_bytes", denied)
    assert "Permission denied" in refused(tmp_path / "a.off")


def off(body: str, counts: str = "4 2 0") -> bytes:
    return f"OFF\n{counts}\n{body}".encode()


FOUR = "0 0 0\n1 0 0\n1 1 0\n0 1 1\n"

BAD_OFF = {
    "other header": (b"OBJ\n4 2 0\n", "the word OFF"),
    "numbers only": (b"4 2 0\n" + FOUR.encode(), "the word OFF"),
    "header alone": (b"OFF", "numbers of vertices, faces"),
    "one count": (b"OFF\n4\n", "numbers of vertices, faces"),
    "binary": (b"OFF BINARY\n\x01\x02", "text OFF"),
    "four dimensions": (b"4OFF\n1 0 0\n0 0 0 0\n", "text OFF"),
    "a NUL": (b"OFF\n4 2 0\n\0", "binary data"),
    "huge counts": (off(FOUR, "1000000000000 1000000000000 0"), "lines for 1000000000000 vertices"),
    "counts beyond integers": (off(FOUR, "1e300 1 0"), "whole numbers"),
    "negative counts": (off(FOUR, "-4 8 0"), "lines for -4 vertices"),
    "fractional counts": (off(FOUR, "4.5 2 0"), "whole numbers, got 4.5"),
    "too few lines": (off(FOUR + "3 0 1 2\n"), "got 5 lines"),
    "too many lines": (off(FOUR + 3 * "3 0 1 2\n"), "got 7 lines"),
    "a word": (off(FOUR + "3 0 1 two\n3 0 1 2\n"), "line 7: expected numbers, got 'two'"),
    "two coordinates": (off(FOUR.replace("1 1 0", "1 1") + "3 0 1 2\n3 0 1 2\n"), "5: expected 3 numbers a vertex"),
    "a colour without C": (off(FOUR.replace("\n", " 1 0 0\n") + 2 * "3 0 1 2\n"), "3 numbers a vertex"),
    "NaN": (off(FOUR.replace("1 1 0", "1 nan 0") + 2 * "3 0 1 2\n"), "NaN or infinite"),
    "infinity": (off(FOUR.replace("1 1 0", "1 -inf 0") + 2 * "3 0 1 2\n"), "NaN or infinite"),
    "overflow": (off(FOUR.replace("1 1 0", "1 1e999 0") + 2 * "3 0 1 2\n"), "NaN or infinite"),
    "absurdly large": (off(FOUR.replace("1 1 0", "1 1e200 0") + 2 * "3 0 1 2\n"), "coordinates up to"),
    "out of range": (off(FOUR + "3 0 1 2\n3 0 1 4\n"), "from 0 to 3, got 4"),
    "negative": (off(FOUR + "3 0 1 2\n3 0 1 -1\n"), "from 0 to 3, got -1"),
    "half a vertex": (off(FOUR + "3 0 1 2\n3 0 1 0.5\n"), "whole vertex numbers, got 0.5"),
    "too few corners": (off(FOUR + "3 0 1 2\n4 0 1 2\n"), "line 8: expected as many corners"),
    "edges alone": (off(FOUR + "2 1 2\n2 0 1\n"), "line 7: expected faces with three corners or more, got 2"),
    "a point": (off(FOUR + "3 0 1 2\n1 0\n"), "line 8: expected faces with three corners or more, got 1"),
    "a negative size": (off(FOUR + "3 0 1 2\n-3 0 1 2\n"), "three corners or more, got -3"),
    "a huge size": (off(FOUR + "3 0 1 2\n4000000000 0 1 2\n"), "as many corners"),
    "an endless size": (off(FOUR + "3 0 1 2\ninf 0 1 2\n"), "corners of a face"),
    "zero area": (off("0 0 0\n" * 4 + 2 * "3 0 1 2\n"), "zero area"),
    "no vertices": (off("", "0 0 0"), "expected vertices, got none"),
}


@pytest.mark.parametrize(("content", "part"), BAD_OFF.values(), ids=BAD_OFF.keys())
def test_off(tmp_path: Path, content: bytes, part: str) -> None:
    assert part in refused(tmp_path / "a.off", content)


V = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\n"

BAD_OBJ = {
    "zero": ("f 0 1 2", "line 5: expected numbers from 1 to 4"),
    "out of range": ("f 1 2 5", "1 to 4, or negative ones counted back from the last, got 5"),
    "back beyond the first": ("f 1 2 -5", "got -5"),
    "edges alone": ("f 1 2\nf 2 3", "line 5: expected a face with three corners or more, got 2"),
    "a point": ("f 1 2 3\nf 1", "line 6: expected a face with three corners or more, got 1"),
    "an empty face": ("f 1 2 3\nf", "three corners or more, got 0"),
    "half a number": ("f 1 2 2.5", "whole vertex numbers, got 2.5"),
    "a word": ("f 1 2 x", "line 5: expected numbers, got 'x'"),
    "slashes at the end": ("f 1/ 2/ 3/", "corners like"),
    "slashes at the front": ("f /1 /2 /3", "corners like"),
    "three slashes": ("f 1/1/1/1 2/1/1/1 3/1/1/1", "corners like"),
    "texture out of range": ("vt 0 0\nf 1/1 2/1 3/2", "from 1 to 1"),
    "texture missing": ("f 1/1 2/1 3/1", "from 1 to 0"),
    "texture of one number": ("vt 0\nf 1/1 2/1 3/1", "vt u v"),
    "texture NaN": ("vt 0 nan\nf 1/1 2/1 3/1", "texture: expected finite"),
    "two coordinates": ("v 1 2\nf 1 2 3", "line 5: expected v x y z"),
    "five numbers": ("v 1 2 3 4 5\nf 1 2 3", "line 5: expected v x y z"),
    "no coordinates": ("v\nf 1 2 3", "line 5: expected v x y z, got no numbers"),
    "a weight": ("v 1 2 3 0.5\nf 1 2 3", "weight"),
    "NaN": ("v 1 nan 3\nf 1 2 5", "NaN or infinite"),
    "colour NaN": (V.replace("\n", " nan 0 0\n") + "f 5 6 7", "finite"),
    "another word": ("hello\nf 1 2 3", "line 5: expected a word of the OBJ format, got 'hello'"),
    "a long word": ("x" * 5000 + "\nf 1 2 3", "'xxxxxxxxxxxxxxxxxxxxxxxx'..."),
}


@pytest.mark.parametrize(("content", "part"), BAD_OBJ.values(), ids=BAD_OBJ.keys())
def test_obj(tmp_path: Path, content: str, part: str) -> None:
    first = "" if content.startswith("v 0 0 0 nan") else V
    if not first:
        content = content.replace("f 5 6 7", "f 1 2 3")
    assert part in refused(tmp_path / "a.obj", (first + content).encode())


def test_obj_without_faces_is_a_cloud_only_where_welcome(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(V)
    assert len(read_mesh(tmp_path / "a.obj").vertices) == 4
    with pytest.raises(InvalidInput, match="no faces"):
        read_mesh(tmp_path / "a.obj", cloud=False)


def ply(header: str, body: bytes = b"") -> bytes:
    return b"ply\n" + header.encode() + b"\nend_header\n" + body


LITTLE = "format binary_little_endian 1.0\n"
XYZ = "element vertex 3\nproperty float x\nproperty float y\nproperty float z"
LIST = "\nelement face 1\nproperty list uchar int vertex_indices"
POINTS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
FACE = struct.pack("<B3i", 3, 0, 1, 2)
TEXT = "format ascii 1.0\n"
NUMBERS = b"0 0 0\n1 0 0\n0 1 0\n"

EDGES = {
    "a.off": off(FOUR + "2 0 3\n3 0 1 2\n2 1 3\n3 0 2 3\n", "4 4 0"),
    "a.obj": (V + "f 1 4\nf 1 2 3\nf 2 4\nf 1 3 4\n").encode(),
    "a.ply": ply(
        (TEXT + XYZ + LIST).replace("vertex 3", "vertex 4").replace("face 1", "face 4"),
        NUMBERS + b"0 1 1\n2 0 3\n3 0 1 2\n2 1 3\n3 0 2 3\n",
    ),
}


@pytest.mark.parametrize("name", EDGES)
def test_edges_among_the_faces_are_left_out_with_a_warning(tmp_path: Path, name: str) -> None:
    """Of 820 models of furniture 22 have faces of two corners."""
    (tmp_path / name).write_bytes(EDGES[name])
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        mesh = read_mesh(tmp_path / name)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert any(str(one.message).endswith(f"{name}: 2 faces of two corners are left out") for one in told)


BAD_PLY = {
    "other header": (b"plyx\n", "the word ply"),
    "cut header": (b"ply\nformat ascii 1.0\nelement vertex 3\n", "end_header"),
    "no format": (b"ply\nelement vertex 3\nend_header\n", "a format"),
    "other format": (ply("format binary_middle_endian 1.0\n" + XYZ), "a line of a PLY header"),
    "other version": (ply("format ascii 2.0\n" + XYZ), "a line of a PLY header"),
    "two formats": (ply(TEXT + TEXT + XYZ), "a line of a PLY header"),
    "an unknown line": (ply(TEXT + "hello\n" + XYZ), "line 3: expected a line of a PLY header, got 'hello'"),
    "a property before an element": (ply(TEXT + "property float x\n"), "a line of a PLY header"),
    "a negative count": (ply(TEXT + XYZ.replace("3", "-3")), "a line of a PLY header"),
    "an unknown type": (ply(TEXT + XYZ.replace("float x", "real x")), "a type of PLY"),
    "a list of floating length": (ply(TEXT + XYZ + LIST.replace("uchar", "float")), "a type of PLY"),
    "an element twice": (ply(TEXT + XYZ + "\n" + XYZ), "each element once"),
    "a property twice": (ply(TEXT + XYZ + "\nproperty float x"), "each property once"),
    "an element without properties": (ply(TEXT + XYZ + "\nelement face 2"), "properties of each element"),
    "no z": (ply(TEXT + XYZ.replace(" z", " w"), NUMBERS), "numbers x, y and z"),
    "no vertex": (ply(TEXT + LIST[1:], b"3 0 1 2\n"), "numbers x, y and z"),
    "huge counts": (ply(LITTLE + XYZ.replace("3", "999999999999"), POINTS), "rows of the element vertex"),
    "huge counts in text": (ply(TEXT + XYZ.replace("3", "999999999999"), NUMBERS), "lines of vertex"),
    "cut points": (ply(LITTLE + XYZ + LIST, POINTS[:-1]), "rows of the element vertex, got 35 bytes"),
    "cut face": (ply(LITTLE + XYZ + LIST, POINTS + FACE[:-1]), "got the end of the file"),
    "huge list": (ply(LITTLE + XYZ + LIST.replace("uchar", "uint"), POINTS + b"\xff\xff\xff\xff" + FACE), "the end"),
    "negative list": (ply(LITTLE + XYZ + LIST.replace("uchar", "char"), POINTS + b"\xff" + FACE), "a negative length"),
    "bytes left over": (ply(LITTLE + XYZ + LIST, POINTS + FACE + b"x"), "got 1 bytes more"),
    "lines left over": (ply(TEXT + XYZ + LIST, NUMBERS + b"3 0 1 2\n1 2 3\n"), "got 5 lines"),
    "missing lines": (ply(TEXT + XYZ + LIST, NUMBERS), "got 3 lines"),
    "a short line": (ply(TEXT + XYZ + LIST, b"0 0 0\n1 0 0\n0 1\n3 0 1 2\n"), "only 2 numbers"),
    "a long line": (ply(TEXT + XYZ + LIST, b"0 0 0\n1 0 0 4\n0 1 0\n3 0 1 2\n"), "got 4 numbers"),
    "a short list": (ply(TEXT + XYZ + LIST, NUMBERS + b"4 0 1 2\n"), "only 4 numbers"),
    "a negative length in text": (ply(TEXT + XYZ + LIST, NUMBERS + b"-1 0 1 2\n"), "of 0 numbers or more, got -1"),
    "a word": (ply(TEXT + XYZ + LIST, NUMBERS + b"3 0 1 x\n"), "numbers, got 'x'"),
    "beyond its type": (ply(TEXT + XYZ + LIST.replace("int v", "uchar v"), NUMBERS + b"3 0 1 256\n"), "to 255"),
    "an edge": (ply(TEXT + XYZ + LIST, NUMBERS + b"2 0 1\n"), "three corners or more, got 2 in face 0"),
    "an index out of range": (ply(LITTLE + XYZ + LIST, POINTS + struct.pack("<B3i", 3, 0, 1, 3)), "from 0 to 2, got 3"),
    "a negative index": (ply(LITTLE + XYZ + LIST, POINTS + struct.pack("<B3i", 3, 0, 1, -1)), "from 0 to 2, got -1"),
    "strips": (ply(TEXT + XYZ + LIST.replace("face", "tristrips"), NUMBERS + b"3 0 1 2\n"), "plain faces"),
    "faces of another name": (ply(TEXT + XYZ + LIST.replace("vertex_i", "i"), NUMBERS + b"3 0 1 2\n"), "plain faces"),
    "faces that are no list": (ply(TEXT + XYZ + LIST.replace("list uchar ", ""), NUMBERS + b"0\n"), "plain faces"),
    "fractional corners": (
        ply(LITTLE + XYZ + LIST.replace("int v", "float v"), POINTS + struct.pack("<B3f", 3, 0, 1, 1.5)),
        "whole vertex numbers",
    ),
    "NaN": (ply(LITTLE + XYZ + LIST, struct.pack("<9f", *[float("nan")] * 9) + FACE), "NaN or infinite"),
    "a signalling NaN": (ply(LITTLE + XYZ + LIST, b"\x01\x00\xa0\x7f" + POINTS[4:] + FACE), "NaN or infinite"),
    "text in place of binary": (ply(LITTLE + XYZ, NUMBERS), "rows of the element vertex"),
}  # fmt: skip


@pytest.mark.parametrize(("content", "part"), BAD_PLY.values(), ids=BAD_PLY.keys())
def test_ply(tmp_path: Path, content: bytes, part: str) -> None:
    assert part in refused(tmp_path / "a.ply", content)


@pytest.mark.parametrize(
    ("content", "part"),
    [
        ("1 2 3\n1 2\n", "line 2: expected x y z, the same number of columns in every line, got 2 numbers"),
        ("1 2\n1 2\n", "line 1"),
        ("3\nwater\nO 0 0 0\n", "got 'water'"),
        ("1,2,3\n", "got '1,2,3'"),
        ("1 2 3\n1 2 inf\n", "NaN or infinite"),
        ("# only a comment\n", "expected vertices, got none"),
    ],
)
def test_xyz(tmp_path: Path, content: str, part: str) -> None:
    assert part in refused(tmp_path / "a.xyz", content.encode())


@pytest.mark.parametrize("suffix", [".stl", ".npz", ""])
def test_writing_other_formats(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(InvalidInput, match=r"one of \.off \.obj \.ply"):
        write_mesh(tmp_path / f"a{suffix}", blob(30))
    assert not list(tmp_path.iterdir())
