"""What each reader makes of the many ways to write a mesh."""

from __future__ import annotations

import struct
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from conftest import blob
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import MeshFile, read_mesh, read_mesh_file, write_mesh
from kfmaps.io.meshes import _parse_xyz
from kfmaps.io.obj import format_obj, parse_obj
from kfmaps.io.off import format_off, parse_off
from kfmaps.io.ply import format_ply, parse_ply
from kfmaps.io.record import fan

PLACES = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.5]])
FACES = [[0, 1, 2], [0, 2, 3]]


def same(found: MeshFile, places: np.ndarray = PLACES, faces: list[list[int]] = FACES) -> MeshFile:
    np.testing.assert_array_equal(found.mesh.vertices, places)
    np.testing.assert_array_equal(found.mesh.faces, np.reshape(faces, (-1, 3)))
    return found


def close(have: np.ndarray | None, want: object, atol: float = 1e-12) -> None:
    assert have is not None
    np.testing.assert_allclose(have, np.broadcast_to(np.asarray(want), have.shape), atol=atol)


OFF_BODY = "0 0 0\n1 0 0\n1 1 0\n0 1 .5\n3 0 1 2\n3 0 2 3\n"


@pytest.mark.parametrize(
    "text",
    [
        "OFF\n4 2 0\n" + OFF_BODY,
        "OFF 4 2 5\n" + OFF_BODY,
        "OFF4 2 0\n" + OFF_BODY,
        "\ufeff# a comment\n\nOFF # here too\n4 2\n\n" + OFF_BODY.replace("1 0 0\n", "  1e0\t+0 -0.0 # point\n\n"),
        ("OFF\n4 2 0\n" + OFF_BODY).replace("\n", "\r\n"),
        ("OFF\n4 2 0\n" + OFF_BODY).replace("\n", "\r"),
        ("OFF\n4 2 0\n" + OFF_BODY).rstrip(),
        "OFF\n4 2 0\n" + OFF_BODY.replace("3 0 1 2\n", "3 0 1 2 255 0 0\n").replace("2 3\n", "2 3 0.5 0.5 0.5 1\n"),
        "OFF\n4 1 0\n" + OFF_BODY[: OFF_BODY.index("3 0 1 2")] + "4 0 1 2 3",
        "NOFF\n4 2 0\n" + OFF_BODY.replace("0\n", "0 0 0 1\n", 3).replace(".5\n", ".5 0 0 1\n"),
    ],
)
def test_off_variants(text: str) -> None:
    same(parse_off(text.encode(), "a.off"))


@pytest.mark.parametrize(
    ("header", "extra", "colors", "uv"),
    [
        ("COFF", ["255 0 51 255"], [1.0, 0.0, 0.2], None),
        ("COFF", ["255 0 51"], [1.0, 0.0, 0.2], None),
        ("COFF", ["0.5 0.25 1 1"], [0.5, 0.25, 1.0], None),
        ("CNOFF", ["0 0 1 0.5 0.25 1 1"], [0.5, 0.25, 1.0], None),
        ("NCOFF", ["0 0 1 0.5 0.25 1"], [0.5, 0.25, 1.0], None),
        ("STOFF", ["0.25 0.75"], None, [0.25, 0.75]),
        ("STCNOFF", ["0 0 1 255 0 51 255 0.25 0.75"], [1.0, 0.0, 0.2], [0.25, 0.75]),
    ],
)
def test_off_colors_and_texture(header: str, extra: list[str], colors: list | None, uv: list | None) -> None:
    rows = [" ".join(map(str, row)) + " " + extra[0] for row in PLACES.tolist()]
    text = "\n".join([header, "4 2 0", *rows, "3 0 1 2", "3 0 2 3"])
    found = same(parse_off(text.encode(), "a.off"))
    for have, want in ((found.colors, colors), (found.uv, uv)):
        if want is None:
            assert have is None
        else:
            close(have, want)
    if uv is not None:
        close(found.uv_faces, FACES)


OBJ_VERTICES = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 .5\n"


@pytest.mark.parametrize(
    "text",
    [
        OBJ_VERTICES + "f 1 2 3\nf 1 3 4\n",
        OBJ_VERTICES + "f 1 2 3 4",
        "# c\nmtllib a b.mtl\no thing\n" + OBJ_VERTICES + "usemtl x\ns off\ng\nf -4 -3 -2\nl 1 2\nf -4 -2 -1\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 .5 # later\nf -4 -2 -1\n",
        OBJ_VERTICES + "vn 0 0 1\nf 1//1 2//1 3//1\nf 1 3//1 4\n",
        OBJ_VERTICES.replace("\n", " 1.0\n") + "f 1 2 \\\n 3\n\tf  1 3 4  \n",
        ("\ufeff" + OBJ_VERTICES + "f 1 2 3\nf 1 3 4").replace("\n", "\r\n"),
        "f 1 2 3 4\n" + OBJ_VERTICES,
    ],
)
def test_obj_variants(text: str) -> None:
    found = same(parse_obj(text.encode(), "a.obj"))
    assert found.uv is None
    assert found.colors is None


def test_obj_texture_has_its_own_numbers() -> None:
    text = OBJ_VERTICES + "vt 0 0\nvt 1 0 0\nvt 1 1\n".replace(" 0 0\nvt 1 1", " 0\nvt 1 1") + "f 1/3 2/2/7 3/1\n"
    text += "vt .25 .5\nf 1/-1 3/-2 4/-4\n"
    found = same(parse_obj(text.encode(), "a.obj"))
    np.testing.assert_array_equal(found.uv, [[0, 0], [1, 0], [1, 1], [0.25, 0.5]])
    np.testing.assert_array_equal(found.uv_faces, [[2, 1, 0], [3, 2, 0]])


def test_obj_colors_only_when_all_have_them() -> None:
    text = OBJ_VERTICES.replace("\n", " 1 0.5 0\n") + "f 1 2 3 4\n"
    found = same(parse_obj(text.encode(), "a.obj"))
    close(found.colors, [1, 0.5, 0], 0)
    assert parse_obj(text.replace(" 1 0.5 0\n", "\n", 1).encode(), "a.obj").colors is None


def ply(order: str, body: bytes, *lines: str) -> bytes:
    return "\n".join(["ply", f"format {order} 1.0", *lines, "end_header", ""]).encode() + body


VERTEX = ("element vertex 4", "property float x", "property float y", "property float z")
FACE = ("element face 2", "property list uchar int vertex_indices")


@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
def test_ply_text(line_end: str) -> None:
    lines = ["ply", "format ascii 1.0", "comment made by hand", *VERTEX, "obj_info none", *FACE, "end_header"]
    text = line_end.join([*lines, *OFF_BODY.splitlines()])
    same(parse_ply(text.encode(), "a.ply"))


@pytest.mark.parametrize(("order", "code"), [("binary_little_endian", "<"), ("binary_big_endian", ">")])
@pytest.mark.parametrize("mixed", [False, True])
def test_ply_binary_in_any_order_of_properties(order: str, code: str, mixed: bool) -> None:
    """Faces first, of equal or different sizes, among other properties, lists and elements."""
    polygons = [[0, 1, 2, 3], [0, 2, 3], [2, 1, 0]] if mixed else [[0, 1, 2], [0, 2, 3], [2, 1, 0]]
    body = b""
    for i, p in enumerate(polygons):
        body += struct.pack(f"{code}hB{len(p)}If", i, len(p), *p, 0.5)
    body += struct.pack(f"{code}di", 7.0, 3)
    for i, (x, y, z) in enumerate(PLACES):
        tags = range(i) if mixed else range(2)
        body += struct.pack(f"{code}fH{len(tags)}bddBBB", y, len(tags), *tags, x, z, 255, 0, 51)
    data = ply(
        order, body,
        "element face 3", "property short id", "property list uint8 uint32 vertex_index", "property float32 w",
        "element camera 1", "property double view", "property int k",
        "element vertex 4", "property float y", "property list ushort char tags", "property float64 x",
        "property double z", "property uchar red", "property uchar green", "property uchar blue",
    )  # fmt: skip
    expected = [[0, 1, 2], [0, 2, 3], [0, 2, 3], [2, 1, 0]] if mixed else polygons
    found = same(parse_ply(data, "a.ply"), faces=expected)
    close(found.colors, [1, 0, 0.2])


def test_ply_text_with_lists_among_numbers() -> None:
    lines = ["ply", "format ascii 1.0", "element vertex 4"]
    lines += ["property list uchar int tags", *VERTEX[1:], "property float s", "property float t"]
    lines += ["element face 1", "property list uchar int vertex_indices", "property uchar flag", "end_header"]
    lines += ["0 0 0 0 .1 .2", "2 8 9 1 0 0 .1 .2", "1 7 1 1 0 .1 .2", "0 0 1 .5 .1 .2", "4 0 1 2 3 1"]
    found = same(parse_ply("\n".join(lines).encode(), "a.ply"))
    close(found.uv, [0.1, 0.2])


@pytest.mark.parametrize(
    ("kind", "values"), [("ushort", "65535 0 13107"), ("float", "1 0 .2"), ("int", "255 0 51"), ("uchar", "255 0 51")]
)
def test_ply_colors_of_any_type(kind: str, values: str) -> None:
    names = [f"property {kind} {c}" for c in ("red", "green", "blue")]
    lines = ["ply", "format ascii 1.0", *VERTEX, *names, *FACE, "end_header"]
    text = "\n".join(lines) + "\n" + "".join(f"{x} {y} {z} {values}\n" for x, y, z in PLACES) + "3 0 1 2\n3 0 2 3\n"
    close(same(parse_ply(text.encode(), "a.ply")).colors, [1, 0, 0.2])


@pytest.mark.parametrize(
    "lines", [VERTEX, (*VERTEX, "element face 0", *FACE[1:]), ("element face 0", *FACE[1:], *VERTEX)]
)
@pytest.mark.parametrize("text", [True, False])
def test_ply_of_points(lines: tuple[str, ...], text: bool) -> None:
    body = "\n".join(OFF_BODY.splitlines()[:4]).encode() if text else PLACES.astype("<f4").tobytes()
    same(parse_ply(ply("ascii" if text else "binary_little_endian", body, *lines), "a.ply"), faces=[])


@pytest.mark.parametrize("columns", ["", " 0 0 1", " 255 0 0", " 0 0 1 255 0 0"])
def test_point_clouds(columns: str) -> None:
    text = "# points\n" + "".join(f"{x} {y} {z}{columns}\n" for x, y, z in PLACES)
    same(_parse_xyz(text.encode(), "a.xyz"), faces=[])


@pytest.mark.parametrize("values", [np.ones(2), np.ones(4)])
def test_a_numpy_that_stops_early_is_not_trusted(monkeypatch: pytest.MonkeyPatch, values: np.ndarray) -> None:
    """Some versions give what they could read instead of an error."""
    monkeypatch.setattr(np, "fromstring", lambda *_, **__: values)
    with pytest.raises(InvalidInput, match="line 1: expected numbers, got 'x'"):
        _parse_xyz(b"1 2 x", "a.xyz")
    with pytest.raises(InvalidInput, match=r"a\.xyz: expected numbers"):
        _parse_xyz(b"1 2 3", "a.xyz")


def test_polygons_become_fans_in_order() -> None:
    np.testing.assert_array_equal(
        fan(np.array([3, 5, 4])), [[0, 1, 2], [3, 4, 5], [3, 5, 6], [3, 6, 7], [8, 9, 10], [8, 10, 11]]
    )


@given(
    arrays(
        np.float64, st.tuples(st.integers(3, 12), st.just(3)), elements=st.floats(allow_nan=False, allow_infinity=False)
    ),
    st.integers(0, 2**32 - 1),
)
@settings(max_examples=60, deadline=None)
def test_round_trip_keeps_every_bit(places: np.ndarray, seed: int) -> None:
    """Any coordinates, in any vertex order, through writer and reader of each format."""
    rng = np.random.default_rng(seed)
    mesh = Mesh(places, rng.integers(0, len(places), (rng.integers(1, 20), 3)))
    colors = rng.integers(0, 256, places.shape) / 255
    for write, read in ((format_off, parse_off), (format_obj, parse_obj), (format_ply, parse_ply)):
        same(read(write(MeshFile(mesh)), "a"), mesh.vertices, mesh.faces.tolist())
        found = same(read(write(MeshFile(mesh, colors)), "a"), mesh.vertices, mesh.faces.tolist())
        close(found.colors, colors)


@pytest.mark.parametrize("suffix", [".off", ".obj", ".ply", ".PLY"])
def test_files_round_trip(tmp_path: Path, suffix: str) -> None:
    mesh, colors = blob(80), np.random.default_rng(1).random((80, 3))
    write_mesh(tmp_path / f"a{suffix}", mesh)
    same(MeshFile(read_mesh(tmp_path / f"a{suffix}")), mesh.vertices, mesh.faces.tolist())
    write_mesh(tmp_path / f"a{suffix}", mesh, colors=colors, force=True)
    found = read_mesh_file(tmp_path / f"a{suffix}").colors
    close(found, colors, 0.51 / 255)


def test_colors_given_as_bytes_or_with_alpha(tmp_path: Path) -> None:
    mesh = blob(30)
    colors = np.random.default_rng(2).integers(0, 256, (30, 4))
    write_mesh(tmp_path / "a.ply", mesh, colors=colors)
    close(read_mesh_file(tmp_path / "a.ply").colors, colors[:, :3] / 255)


@pytest.mark.parametrize(
    "colors", [np.zeros((29, 3)), np.full((30, 3), 1.5), np.full((30, 3), np.nan), np.full((30, 3), -1)]
)
def test_colors_that_do_not_fit(tmp_path: Path, colors: np.ndarray) -> None:
    with pytest.raises(InvalidInput, match="colors"):
        write_mesh(tmp_path / "a.ply", blob(30), colors=colors)
    assert not list(tmp_path.iterdir())


def test_oddities_warn_and_are_kept(tmp_path: Path) -> None:
    mesh = blob(60)
    torn = Mesh(np.vstack([mesh.vertices, mesh.vertices[:1]]), np.vstack([mesh.faces[:-1], [[4, 4, 5]]]))
    write_mesh(tmp_path / "a.off", torn)
    with pytest.warns(KfmapsWarning) as output:
        same(MeshFile(read_mesh(tmp_path / "a.off")), torn.vertices, torn.faces.tolist())
    text = "\n".join(str(w.message) for w in output)
    for part in (
        "1 boundary loop,",
        "1 duplicated vertex",
        "1 face without area is kept",
        "1 vertex that no face uses is kept",
    ):
        assert part in text


@pytest.mark.parametrize(
    ("places", "faces", "output"),
    [
        (np.random.default_rng(0).normal(size=(5, 3)), [[0, 1, 2], [1, 0, 3], [0, 1, 4]], "1 non-manifold edge,"),
        (np.random.default_rng(0).normal(size=(6, 3)), [[0, 1, 2], [3, 4, 5]], "2 components"),
        (np.random.default_rng(0).normal(size=(5, 3)), [[0, 1, 2], [2, 3, 4]], "1 non-manifold vertex"),
        (np.random.default_rng(0).normal(size=(4, 3)), [[0, 1, 2], [0, 1, 3]], "1 inconsistently oriented edge"),
    ],
)
def test_each_oddity_is_named(tmp_path: Path, places: np.ndarray, faces: list, output: str) -> None:
    write_mesh(tmp_path / "a.ply", Mesh(places, np.array(faces)))
    with pytest.warns(KfmapsWarning, match=output):
        assert len(read_mesh(tmp_path / "a.ply").faces) == len(faces)


@pytest.mark.parametrize("line_ends", [("\n", "\r\n"), ("\r\n", "\n"), ("\r\n", "\r\n"), ("\r", "\r")])
def test_ply_headers_of_any_line_ends_before_a_binary_body(tmp_path: Path, line_ends: tuple[str, str]) -> None:
    """Some programs write the header as text of their system and the body, or a comment, as it stands."""
    first, then = line_ends
    head = format_ply(MeshFile(SHAPE)).partition(b"end_header\n")[0].replace(b"\n", first.encode())
    body = format_ply(MeshFile(SHAPE)).partition(b"end_header\n")[2]
    comment = b"comment made by a program" + then.encode()
    at = head.index(b"element vertex")
    (tmp_path / "a.ply").write_bytes(head[:at] + comment + head[at:] + b"end_header" + then.encode() + body)
    np.testing.assert_array_equal(read_mesh(tmp_path / "a.ply").vertices, SHAPE.vertices)
    np.testing.assert_array_equal(read_mesh(tmp_path / "a.ply").faces, SHAPE.faces)


NUMBERS = "+1.E+00 -2.e-01 +.5\n1. +0.E+00 0\n0 1E0 -0.\n"
SHAPE = blob(30)
FORTRAN = {
    ".off": "OFF\n3 1 0\n" + NUMBERS + "3 0 1 2\n",
    ".xyz": NUMBERS,
    ".obj": "".join(f"v {line}\n" for line in NUMBERS.splitlines()) + "f 1 2 3\n",
    ".ply": "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty double z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + NUMBERS + "+3.E+00 0. +1 2.E+00\n",
    ".stl": "solid\nfacet normal 0 0 1\nouter loop\n"
    + "".join(f"vertex {line}\n" for line in NUMBERS.splitlines())
    + "endloop\nendfacet\nendsolid\n",
}


@pytest.mark.parametrize("suffix", FORTRAN)
def test_numbers_as_fortran_writes_them(tmp_path: Path, suffix: str) -> None:
    (tmp_path / f"a{suffix}").write_text(FORTRAN[suffix])
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
        mesh = read_mesh(tmp_path / f"a{suffix}")
    np.testing.assert_array_equal(mesh.vertices, [[1, -0.2, 0.5], [1, 0, 0], [0, 1, 0]])
    assert mesh.faces.tolist() == ([] if suffix == ".xyz" else [[0, 1, 2]])


def test_a_vertex_without_a_position_is_put_between_its_neighbours(tmp_path: Path) -> None:
    mesh = blob(1200, 3)
    places = mesh.vertices.copy()
    places[7] = np.nan
    write = tmp_path / "scan.ply"
    write.write_bytes(format_ply(MeshFile(Mesh(places, mesh.faces))))
    with pytest.warns(KfmapsWarning, match=r"vertices without a position \(NaN\): 1; put between neighbours"):
        read = read_mesh(write)
    around = np.setdiff1d(mesh.faces[(mesh.faces == 7).any(axis=1)], [7])
    np.testing.assert_allclose(read.vertices[7], mesh.vertices[around].mean(axis=0))
    rest = np.arange(len(places)) != 7
    np.testing.assert_array_equal(read.vertices[rest], mesh.vertices[rest])
    places[8:10] = np.nan  # more than one in a thousand
    write.write_bytes(format_ply(MeshFile(Mesh(places, mesh.faces))))
    with pytest.raises(InvalidInput, match="9 NaN or infinite"):
        read_mesh(write)


def test_vertices_that_are_welded_are_not_counted_as_duplicated(tmp_path: Path) -> None:
    """Rounded seams are welded too, so there are more of these than vertices in the same place."""
    mesh = blob(60)
    corners = mesh.vertices[mesh.faces.ravel()] + 1e-6 * np.random.default_rng(0).normal(size=(3 * len(mesh.faces), 3))
    write_mesh(tmp_path / "soup.off", Mesh(corners, np.arange(len(corners)).reshape(-1, 3)))
    with warnings.catch_warnings(action="error"):
        read_mesh(tmp_path / "soup.off")
