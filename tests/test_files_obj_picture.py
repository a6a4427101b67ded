"""The picture of an OBJ file: which one its faces have, and that it comes back as it went."""

from pathlib import Path

import numpy as np
import pytest

from conftest import corner_uv, known
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import read_mesh_file
from kfmaps.io.bake import encode_png
from kfmaps.io.export import write_morph, write_textured
from kfmaps.io.obj import _read_materials
from kfmaps.io.record import MeshFile, Picture

pytestmark = pytest.mark.filterwarnings("ignore:.*boundary loop")

SHAPE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
FIRST, SECOND = "f 1/1 2/2 3/3\n", "f 2/2 4/4 3/3\n"
RED, BLUE = (encode_png(np.broadcast_to(np.array(color), (2, 3, 3))) for color in ([1.0, 0, 0], [0, 0, 1.0]))
JPEG = b"\xff\xd8\xff and so on"


def written(folder: Path, text: str, **files: str) -> Picture | None:
    (folder / "skins").mkdir(parents=True)
    (folder / "red.png").write_bytes(RED.data)
    (folder / "skins" / "blue sky.PNG").write_bytes(BLUE.data)
    (folder / "photo.png").write_bytes(JPEG)
    (folder / "none.png").write_text("not a picture")
    (folder / "a.mtl").write_text(files.get("a", "newmtl r\nmap_Kd red.png\nnewmtl b\nmap_Kd skins\\blue sky.PNG\n"))
    (folder / "b c.mtl").write_text(files.get("bc", "newmtl r\nmap_Kd photo.png\n"))
    (folder / "shape.obj").write_text(text)
    found = read_mesh_file(folder / "shape.obj")
    assert found.uv is not None
    return found.picture


@pytest.mark.parametrize(
    ("text", "data"),
    [
        ("mtllib a.mtl\n" + SHAPE + "usemtl r\n" + FIRST + SECOND, RED.data),
        ("mtllib a.mtl\r\n" + SHAPE + "usemtl b # the sky\r\n" + FIRST + SECOND, BLUE.data),
        ("mtllib b c.mtl\n" + SHAPE + "usemtl r\n" + FIRST + SECOND, JPEG),
        ("mtllib none.mtl a.mtl\n" + SHAPE + "usemtl b\nusemtl r\n" + FIRST + "usemtl r\n" + SECOND, RED.data),
        ("mtllib a.mtl\n" + SHAPE + FIRST + "usemtl r\n" + SECOND, None),  # a face without
        ("mtllib a.mtl\n" + SHAPE + "usemtl r\n" + FIRST + "usemtl b\n" + SECOND, None),  # two pictures
        ("mtllib a.mtl\n" + SHAPE + "usemtl other\n" + FIRST + SECOND, None),
        ("mtllib a.mtl\n" + SHAPE + FIRST + SECOND, None),
        (SHAPE + "usemtl r\n" + FIRST + SECOND, None),
        ("mtllib ../a.mtl\n" + SHAPE + "usemtl r\n" + FIRST + SECOND, None),
        ("mtllib\n" + SHAPE + "usemtl\n" + FIRST + SECOND, None),
    ],
)
def test_the_picture_of_all_faces(tmp_path: Path, text: str, data: bytes | None) -> None:
    (tmp_path / "a.mtl").write_text("newmtl r\nmap_Kd sub/red.png\n")  # outside of the file's folder
    found = written(tmp_path / "sub", text)
    assert (found and found.data) == data
    if found:
        assert found.kind == ("image/jpeg" if data == JPEG else "image/png")


@pytest.mark.parametrize(
    "said", ["missing.png", "none.png", "../red.png", "/etc/red.png", "C:\\red.png", "-s 2 2 red.png", ""]
)
def test_pictures_that_are_not_there_or_not_as_they_are_count_as_none(tmp_path: Path, said: str) -> None:
    text = "mtllib a.mtl\n" + SHAPE + "usemtl r\n" + FIRST + SECOND
    assert written(tmp_path / "sub", text, a=f"newmtl r\nmap_Kd {said}\n") is None


@pytest.mark.parametrize(
    ("line", "file"),
    [
        ("map_Kd a b.png", "a b.png"),
        ("\tmap_kd  -clamp on -mm 0 1 -bm 1 a b.png ", "a b.png"),
        ("map_Kd -s 1 1 1 -o 0 0.0 0 a.png", "a.png"),
        ("map_Kd -s 1 a.png", "a.png"),
        ("map_Kd -o 0 0.5 a.png", None),
        ("map_Kd -t 0.1 a.png", None),
        ("map_Ks a.png", None),
        ("map_Kd", None),
    ],
)
def test_options_before_the_name(line: str, file: str | None) -> None:
    assert _read_materials(f"# m\nmap_Kd stray.png\nnewmtl my skin\nKd 1 1 1\n{line}\n") == {"my skin": file}


@pytest.fixture
def square(tmp_path: Path) -> MeshFile:
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "skin.png").write_bytes(RED.data)
    (tmp_path / "in" / "m.mtl").write_text("newmtl r\nmap_Kd skin.png\n")
    (tmp_path / "in" / "a.obj").write_text("mtllib m.mtl\n" + SHAPE + "usemtl r\n" + FIRST + SECOND)
    return read_mesh_file(tmp_path / "in" / "a.obj")


def test_a_texture_goes_from_obj_to_obj_unchanged(tmp_path: Path, square: MeshFile) -> None:
    """The identity map writes the source again: coordinates to the last bit, the picture byte for byte."""
    write_textured(tmp_path / "b.obj", square, square.mesh, np.arange(4))
    back = read_mesh_file(tmp_path / "b.obj")
    np.testing.assert_array_equal(corner_uv(back), corner_uv(square))
    assert back.picture == square.picture
    assert known(back.picture).data == RED.data


def test_a_bent_mesh_keeps_its_texture(tmp_path: Path, square: MeshFile) -> None:
    target = Mesh(2 * square.mesh.vertices, square.mesh.faces)
    write_morph(tmp_path / "m.obj", square, target, square.mesh.vertices - square.mesh.vertices.mean(axis=0))
    back = read_mesh_file(tmp_path / "m.obj")
    assert back.picture == square.picture
    np.testing.assert_array_equal(corner_uv(back), corner_uv(square))
    np.testing.assert_allclose(np.ptp(back.mesh.vertices, axis=0), np.ptp(target.vertices, axis=0))
