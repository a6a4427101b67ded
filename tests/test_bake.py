"""Textures baked into the target's own atlas, and pictures in and out of GLB files."""

from __future__ import annotations

import base64
import io
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from characters import changed
from conftest import corner_uv, fibonacci_sphere, known
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.fmap.precise import PointMap, vertex_point_map
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import MeshFile, grid_picture, read_mesh_file, write_textured
from kfmaps.io.bake import (
    _find_texels,
    _pack,
    _sample_picture,
    can_bake,
    decode_picture,
    encode_png,
    transfer_texture,
    transfer_uv,
)
from kfmaps.io.convert import as_map
from kfmaps.io.glb import format_glb
from kfmaps.io.gltf import parse_gltf
from kfmaps.io.record import Picture
from test_files_export import globe

GUARDS = ("kfmaps.geometry.closest_points",)


def own_atlas(mesh: Mesh) -> MeshFile:
    """Each face has a cell of the picture for itself, and fills half of it but for a margin."""
    f = len(mesh.faces)
    side = int(np.ceil(np.sqrt(f)))
    cell = np.stack([np.arange(f) % side, np.arange(f) // side], axis=1)[:, None]
    corners = (cell + np.array([[0.1, 0.1], [0.85, 0.1], [0.1, 0.85]])) / side
    return MeshFile(mesh, None, corners.reshape(-1, 2), np.arange(3 * f).reshape(-1, 3))


def round_picture(size: int = 512) -> np.ndarray:
    """Smooth, and the same at the left border as at the right."""
    across, down = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size])
    up = 1 - down
    angle = 2 * np.pi * across
    return np.stack([0.5 + 0.5 * np.cos(angle), 0.5 + 0.5 * np.sin(angle), up], axis=2)


def test_texels_are_where_the_triangle_is() -> None:
    height, width = 96, 64
    corners = np.array([[[0.1, 0.2], [0.8, 0.3], [0.4, 0.9]]])
    face, texel, weights = _find_texels(corners, height, width)
    x, y = (texel % width + 0.5) / width, 1 - (texel // width + 0.5) / height
    np.testing.assert_allclose(np.einsum("qi,qij->qj", weights, corners[face]), np.stack([x, y], axis=1))
    assert weights.min() >= -1e-6
    u, v = corners[0, 1] - corners[0, 0], corners[0, 2] - corners[0, 0]
    assert len(np.unique(texel)) == len(texel)
    assert len(texel) / (height * width) == pytest.approx(abs(u[0] * v[1] - u[1] * v[0]) / 2, rel=0.02)


def test_colours_are_linear_between_texels_and_repeat() -> None:
    pixels = np.random.default_rng(0).random((4, 8, 3))
    centres = np.stack([(np.arange(8) + 0.5) / 8, np.full(8, 1 - 1.5 / 4)], axis=1)
    np.testing.assert_allclose(_sample_picture(pixels, centres), pixels[1])
    between = (centres[:-1] + centres[1:]) / 2
    np.testing.assert_allclose(_sample_picture(pixels, between), (pixels[1, :-1] + pixels[1, 1:]) / 2)
    np.testing.assert_allclose(_sample_picture(pixels, centres + np.array([2, -1])), _sample_picture(pixels, centres))


def at_points(source: MeshFile, mesh: Mesh) -> PointMap:
    """Each vertex at the closest point of the source."""
    found = closest_points(mesh.vertices, source.mesh.vertices, source.mesh.faces)
    return PointMap(found.faces, found.weights)


def pixels_of(shape: MeshFile) -> np.ndarray:
    return decode_picture(known(shape.picture))


def colours_of(shape: MeshFile) -> tuple[np.ndarray, np.ndarray]:
    """The colours in the middle of each face of a textured shape, and where that is."""
    middle = shape.mesh.vertices[shape.mesh.faces].mean(axis=1)
    return _sample_picture(pixels_of(shape), corner_uv(shape).mean(axis=1)), middle


@pytest.mark.parametrize(
    ("mode", "kind"), [("RGBA", "png"), ("P", "png"), ("L", "png"), ("1", "png"), ("CMYK", "jpeg")]
)
def test_pictures_of_every_kind_are_read(mode: str, kind: str) -> None:
    file = io.BytesIO()
    halves = np.repeat(np.array([0, 255], dtype=np.uint8), 16)[None, :, None] * np.ones((32, 1, 3), dtype=np.uint8)
    Image.fromarray(halves).convert(mode).save(file, kind)
    pixels = decode_picture(Picture(file.getvalue(), f"image/{kind}"))
    assert pixels.shape == (32, 32, 3)
    np.testing.assert_allclose(pixels, halves / 255, atol=0.02)


def test_a_grey_picture_of_sixteen_bits_is_read() -> None:
    file, grey = io.BytesIO(), np.linspace(0, 65535, 8).astype(np.uint16)
    Image.fromarray(np.tile(grey, (4, 1))).save(file, "png")
    pixels = decode_picture(Picture(file.getvalue(), "image/png"))
    np.testing.assert_allclose(pixels, np.broadcast_to(grey[None, :, None] / 65535, (4, 8, 3)), atol=1e-4)


def test_the_identity_gives_back_the_picture() -> None:
    """Every texel inside a face, when source and target are one and the same."""
    shape = own_atlas(fibonacci_sphere(60))
    pixels = np.random.default_rng(1).integers(0, 256, (256, 256, 3)) / 255.0
    place = vertex_point_map(np.arange(60), shape.mesh)
    found = transfer_uv(shape, shape.mesh, place)
    assert not found.torn.any()
    np.testing.assert_array_equal(found.uv[found.uv_faces], corner_uv(shape))
    baked = transfer_texture(shape, shape, found, encode_png(pixels), 256)
    _, texel, _ = _find_texels(corner_uv(shape), 256, 256)
    rows = np.rint(255 * pixels_of(baked)).reshape(-1, 3)
    np.testing.assert_array_equal(rows[texel], np.rint(255 * pixels.reshape(-1, 3))[texel])


@pytest.mark.parametrize("own", [True, False])
def test_a_picture_goes_around_a_seam_without_a_scar(own: bool) -> None:
    """The colour is that of the place on the sphere, at the seam of the source's texture too."""
    source, mesh = globe(900), fibonacci_sphere(700)
    target = own_atlas(mesh) if own else MeshFile(mesh)
    assert can_bake(target) == own
    found = transfer_uv(source, mesh, at_points(source, mesh))
    made = transfer_texture(source, target, found, encode_png(round_picture()))
    colours, at = colours_of(made)
    angle = np.arctan2(at[:, 1], at[:, 0]) + np.pi
    true = np.stack([0.5 + 0.5 * np.cos(angle), 0.5 + 0.5 * np.sin(angle), 0.5 + 0.5 * at[:, 2]], axis=1)
    wide = np.hypot(at[:, 0], at[:, 1]) > 0.4  # longitude means little at the poles
    off = np.abs(colours - true).max(axis=1)[wide]
    assert np.quantile(off, 0.99) < 0.06
    assert off.max() < 0.12
    # Beyond the charts too there is no colour that is not next to them.
    assert pixels_of(made).sum(axis=2).min() > 0.2


def test_only_faces_over_a_seam_are_drawn_anew() -> None:
    """All others have the source's coordinates; the picture above the new rows is the source's, texel by texel."""
    source, mesh = globe(900), fibonacci_sphere(700)
    found = transfer_uv(source, mesh, at_points(source, mesh))
    pixels = np.random.default_rng(0).integers(0, 256, (1024, 1024, 3)) / 255.0
    made = transfer_texture(source, MeshFile(mesh), found, encode_png(pixels))
    after = pixels_of(made)
    rows = len(after) - 1024
    assert rows > 0
    np.testing.assert_allclose(after[:1024], pixels, atol=1e-6)
    corners = corner_uv(made) * [1, len(after) / 1024] - [0, rows / 1024]
    kept = corners[:, :, 1].max(axis=1) > 0
    x, y, z = mesh.vertices.T
    longitude = np.ptp(np.arctan2(y, x)[mesh.faces], axis=1)
    assert not kept[(longitude > np.pi) & (np.abs(z[mesh.faces]).max(axis=1) < 0.9)].any()
    assert kept[(longitude < 1) & (np.abs(z[mesh.faces]).max(axis=1) < 0.9)].mean() > 0.97
    gap = corners[kept] - found.uv[found.uv_faces[kept]]
    np.testing.assert_allclose(gap, np.rint(gap), atol=1e-9)
    # No face reaches across the picture, but those around a pole.
    around = np.abs(z[mesh.faces]).max(axis=1) < 0.9
    assert np.ptp(corner_uv(made)[around], axis=1).max() < 0.3


def test_a_texture_that_repeats_is_drawn_in_one_copy() -> None:
    """Rows below the picture end its repetition: coordinates from 0 to 3 move into the first copy."""
    source, mesh = globe(900), fibonacci_sphere(700)
    source = replace(source, uv=known(source.uv) * [3, 1])
    found = transfer_uv(source, mesh, at_points(source, mesh))
    made = transfer_texture(source, MeshFile(mesh), found, encode_png(round_picture()))
    assert corner_uv(made).min() >= 0
    assert corner_uv(made).max() <= 1
    colours, at = colours_of(made)
    angle = 3 * (np.arctan2(at[:, 1], at[:, 0]) + np.pi)
    true = np.stack([0.5 + 0.5 * np.cos(angle), 0.5 + 0.5 * np.sin(angle)], axis=1)
    wide = np.hypot(at[:, 0], at[:, 1]) > 0.6
    assert np.quantile(np.abs(colours[:, :2] - true).max(axis=1)[wide], 0.98) < 0.2


def test_the_size_of_the_picture_is_that_asked_for() -> None:
    source, mesh = globe(300), fibonacci_sphere(200)
    found = transfer_uv(source, mesh, at_points(source, mesh))
    grey = encode_png(np.full((100, 200, 3), 0.5))
    for size, width in ((None, 1024), (300, 300)):
        pixels = pixels_of(transfer_texture(source, MeshFile(mesh), found, grey, size))
        assert pixels.shape[1] == width
        assert pixels.shape[0] > width // 2
        np.testing.assert_allclose(pixels, 0.5, atol=0.01)
        own = transfer_texture(source, own_atlas(mesh), found, grey, size)
        assert pixels_of(own).shape == (width, width, 3)


def test_packed_triangles_keep_their_shape_and_apart() -> None:
    rng = np.random.default_rng(0)
    corners = rng.random((300, 3, 2)) * 40
    edges = np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)
    packed, height = _pack(edges, 400)
    size = np.ptp(packed, axis=1)
    assert (packed >= 3).all()
    assert (packed[:, :, 0] <= 397).all()
    assert (packed[:, :, 1] <= height - 3).all()
    assert np.abs(np.linalg.norm(packed[:, [1, 2, 0]] - packed, axis=2) - edges).max() < 2  # whole texels
    low, high = packed.min(axis=1) - 2.9, packed.max(axis=1) + 2.9
    apart = (low[:, None] >= high[None]) | (low[None] >= high[:, None])
    assert (apart.any(axis=2) | np.eye(len(packed), dtype=bool)).all()
    assert size.min() >= 1
    # Too many for one more picture: all are made smaller.
    small, height = _pack(edges, 160)
    assert height <= 160
    ratio = np.linalg.norm(small[:, [1, 2, 0]] - small, axis=2).sum() / edges.sum()
    assert 0.01 < ratio < 0.5


def test_faces_outside_a_part_have_one_colour(tmp_path: Path) -> None:
    source = globe()
    n = len(source.mesh.vertices)
    target = own_atlas(source.mesh)
    points = np.arange(n)
    away = source.mesh.vertices[:, 2] > 0.5
    points[away] = -1
    places = as_map(vertex_point_map(np.arange(n), source.mesh), source.mesh)
    write_textured(tmp_path / "b.glb", source, target, replace(places, target_to_source=points))
    picture = pixels_of(read_mesh_file(tmp_path / "b.glb"))
    face, texel, _ = _find_texels(corner_uv(target), *picture.shape[:2])
    outside = away[source.mesh.faces].max(axis=1)[face]
    colours = picture.reshape(-1, 3)[texel]
    assert np.ptp(colours[outside], axis=0).max() == 0
    assert np.ptp(colours[~outside], axis=0).max() > 0.5


def test_padding_is_the_nearest_colour() -> None:
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    target = MeshFile(mesh, None, np.array([[0.4, 0.4], [0.6, 0.4], [0.4, 0.6]]), np.array([[0, 1, 2]]))
    blue = np.zeros((8, 8, 3))
    blue[:, :, 2] = 1.0
    found = transfer_uv(target, mesh, vertex_point_map(np.arange(3), mesh))
    assert (pixels_of(transfer_texture(target, target, found, encode_png(blue), 64)) == [0, 0, 1]).all()


def test_an_atlas_whose_faces_share_space_gets_the_sources_coordinates(tmp_path: Path) -> None:
    source = globe()
    mesh = source.mesh
    stacked = MeshFile(mesh, None, np.array([[0.0, 0], [1, 0], [0, 1]]), np.tile([0, 1, 2], (len(mesh.faces), 1)))
    assert not can_bake(stacked)
    assert not can_bake(MeshFile(mesh))
    cells = own_atlas(mesh)
    half = known(cells.uv_faces)[: len(mesh.faces) // 2]
    assert not can_bake(replace(cells, uv_faces=np.concatenate([half, half])))
    assert not can_bake(MeshFile(mesh, None, np.zeros((1, 2)), np.zeros_like(mesh.faces)))
    with pytest.warns(KfmapsWarning, match="share"):
        write_textured(tmp_path / "b.glb", source, stacked, np.arange(len(mesh.vertices)))
    back = pixels_of(read_mesh_file(tmp_path / "b.glb"))
    np.testing.assert_array_equal(np.rint(255 * back), grid_picture())


def test_a_target_keeps_its_own_coordinates(tmp_path: Path) -> None:
    source, mesh = globe(), fibonacci_sphere(90)
    target = own_atlas(mesh)
    red = encode_png(np.broadcast_to(np.array([1.0, 0, 0]), (4, 4, 3)))
    source = replace(source, picture=red)
    points = np.linalg.norm(mesh.vertices[:, None] - source.mesh.vertices[None], axis=2).argmin(axis=1)
    for name in ("b.glb", "b.obj"):
        write_textured(tmp_path / name, source, target, points)
        back = read_mesh_file(tmp_path / name)
        np.testing.assert_allclose(corner_uv(back), corner_uv(target), atol=1e-6)
    picture = decode_picture(Picture((tmp_path / "b.png").read_bytes(), "image/png"))
    assert picture.shape == (1024, 1024, 3)
    np.testing.assert_allclose(picture, np.broadcast_to([1.0, 0, 0], picture.shape))


@pytest.fixture(scope="module")
def glb() -> bytes:
    shape = globe(30)
    picture = encode_png(grid_picture(32, 4))
    return format_glb(MeshFile(shape.mesh, None, shape.uv, shape.uv_faces, picture))


def test_a_texture_comes_in_as_it_went_out(glb: bytes, tmp_path: Path) -> None:
    found = known(parse_gltf(glb, "a.glb").picture)
    assert found == Picture(encode_png(grid_picture(32, 4)).data, "image/png")

    def elsewhere(tree: dict) -> None:
        tree["images"][0] = {"uri": "skin%20of%20a.png"}

    def inside(tree: dict) -> None:
        tree["images"][0] = {"uri": "data:image/png;base64," + base64.b64encode(found.data).decode()}

    name = str(tmp_path / "a.glb")
    assert parse_gltf(changed(glb, elsewhere), name).picture is None
    (tmp_path / "skin of a.png").write_bytes(found.data)
    assert parse_gltf(changed(glb, elsewhere), name).picture == found
    assert parse_gltf(changed(glb, inside), name).picture == found


@pytest.mark.parametrize(
    "edit",
    [
        lambda tree: tree["images"].__setitem__(0, {"uri": "data:image/png;base64," + base64.b64encode(b"x").decode()}),
        lambda tree: tree["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].update(texCoord=1),
        lambda tree: tree["meshes"][0]["primitives"][0].pop("material"),
        lambda tree: tree["textures"][0].pop("source"),
    ],
)
def test_only_the_single_base_colour_texture_is_read(glb: bytes, edit: Any) -> None:
    found = parse_gltf(changed(glb, edit), "a.glb")
    assert found.uv is not None
    assert found.picture is None


def test_two_textures_are_none(glb: bytes) -> None:
    def edit(tree: dict) -> None:
        part = tree["meshes"][0]["primitives"][0]
        tree["meshes"][0]["primitives"].append({**part, "material": 1})
        plain = tree["materials"][0]["pbrMetallicRoughness"]
        tree["materials"].append({"pbrMetallicRoughness": {**plain, "baseColorTexture": {"index": 1}}})
        tree["textures"].append({"source": 1})
        tree["images"].append(dict(tree["images"][0]))

    assert parse_gltf(changed(glb, edit), "a.glb").picture is None


@pytest.mark.parametrize("uri", ["../skin.png", "/etc/skin.png", "https://x.org/skin.png"])
def test_a_picture_elsewhere_is_refused(glb: bytes, uri: str) -> None:
    with pytest.raises(InvalidInput, match="beside it"):
        parse_gltf(changed(glb, lambda tree: tree["images"].__setitem__(0, {"uri": uri})), "a.glb")


def test_a_picture_cut_short_is_refused(glb: bytes) -> None:
    def edit(tree: dict) -> None:
        tree["bufferViews"][tree["images"][0]["bufferView"]]["byteLength"] += 10**6

    with pytest.raises(InvalidInput, match=r"too few bytes for 10\d{5} of numbers or a picture"):
        parse_gltf(changed(glb, edit), "a.glb")


def test_a_picture_that_is_none_is_refused() -> None:
    with pytest.raises(InvalidInput, match="PNG or JPEG"):
        decode_picture(Picture(b"\x89PNG\r\n\x1a\nno more", "image/png"))
