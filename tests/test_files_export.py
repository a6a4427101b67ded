"""Textures and colours carried over a map."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread, imsave

from conftest import blob, corner_uv, fibonacci_sphere, known
from kfmaps._arrays import InvalidInput
from kfmaps.fmap.precise import PointMap, vertex_point_map
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import MeshFile, grid_picture, projected_uv, read_mesh_file, write_colored, write_textured
from kfmaps.io.bake import transfer_uv


def globe(n: int = 120) -> MeshFile:
    """A sphere with longitude and latitude as texture coordinates, so with a seam at the back."""
    mesh = fibonacci_sphere(n)
    x, y, z = mesh.vertices.T
    u, v = np.arctan2(y, x) / (2 * np.pi) + 0.5, (z + 1) / 2
    corner = u[mesh.faces]
    across = np.ptp(corner, axis=1) > 0.5
    shifted = across[:, None] & (corner < 0.5)
    uv = np.vstack([np.stack([u, v], axis=1), np.stack([u + 1, v], axis=1)])
    return MeshFile(mesh, None, uv, mesh.faces + n * shifted)


def vertices_of(points: np.ndarray, source: MeshFile) -> PointMap:
    return vertex_point_map(points, source.mesh)


def test_the_identity_gives_back_the_texture() -> None:
    """At the seam too, where a vertex has several coordinates and each face those of its own side."""
    source = globe()
    found = transfer_uv(source, source.mesh, vertices_of(np.arange(len(source.mesh.vertices)), source))
    assert not found.torn.any()
    np.testing.assert_array_equal(found.uv[found.uv_faces], corner_uv(source))


def test_another_triangulation_has_no_stretched_faces_but_torn_ones() -> None:
    source, target = globe(), fibonacci_sphere(300, twist=1.0)
    points = ((target.vertices[:, None] - source.mesh.vertices) ** 2).sum(axis=-1).argmin(axis=1)
    found = transfer_uv(source, target, vertices_of(points, source))
    away = np.abs(target.vertices[target.faces][..., 2]).max(axis=1) < 0.8  # near the poles longitude is wild
    whole = ~found.torn[away]
    assert 0.5 < whole.mean() < 1
    assert np.ptp(found.uv[found.uv_faces][away][whole], axis=1)[:, 0].max() < 0.5


def test_vertices_without_faces_borrow_from_the_nearest(tmp_path: Path) -> None:
    source = globe(60)
    lonely = source.mesh.vertices[7] * 1.01
    extended = replace(source, mesh=Mesh(np.vstack([source.mesh.vertices, lonely]), source.mesh.faces))
    target = fibonacci_sphere(20)
    write_textured(tmp_path / "out.glb", extended, target, np.full(20, 60))
    found = corner_uv(read_mesh_file(tmp_path / "out.glb"))
    np.testing.assert_allclose(found % 1, np.broadcast_to(known(source.uv)[7] % 1, found.shape), atol=1e-6)


def test_textured_files(tmp_path: Path) -> None:
    source = globe()
    target, points = source.mesh, np.arange(120)
    written = write_textured(tmp_path / "out.obj", source, target, points)
    assert sorted(tmp_path.iterdir()) == sorted(written)
    found = read_mesh_file(tmp_path / "out.obj")
    np.testing.assert_array_equal(found.mesh.vertices, target.vertices)
    np.testing.assert_array_equal(found.mesh.faces, target.faces)
    np.testing.assert_array_equal(corner_uv(found), corner_uv(source))
    assert "map_Kd out.png" in (tmp_path / "out.mtl").read_text()
    assert (tmp_path / "out.obj").read_text().startswith("mtllib out.mtl\n")
    assert imread(tmp_path / "out.png").shape[:2] == (1024, 1024)


def test_a_picture_of_ones_own(tmp_path: Path) -> None:
    imsave(tmp_path / "skin.jpg", np.zeros((4, 4, 3)))
    source = globe()
    written = write_textured(tmp_path / "out.obj", source, source.mesh, np.arange(120), picture=tmp_path / "skin.jpg")
    assert (tmp_path / "out.jpg").read_bytes() == (tmp_path / "skin.jpg").read_bytes()
    assert written[2] == tmp_path / "out.jpg"
    assert "map_Kd out.jpg" in (tmp_path / "out.mtl").read_text()


@pytest.mark.parametrize("existing", ["out.obj", "out.mtl", "out.png"])
def test_all_files_or_none(tmp_path: Path, existing: str) -> None:
    (tmp_path / existing).write_text("old")
    source = globe()
    with pytest.raises(InvalidInput, match="--force"):
        write_textured(tmp_path / "out.obj", source, source.mesh, np.arange(120))
    assert [p.read_text() for p in tmp_path.iterdir()] == ["old"]
    write_textured(tmp_path / "out.obj", source, source.mesh, np.arange(120), force=True)
    assert len(list(tmp_path.iterdir())) == 3


@pytest.mark.parametrize(
    ("name", "points", "target", "picture", "part"),
    [
        ("out.ply", np.arange(120), globe().mesh, None, "one of .obj .glb"),
        ("a\nb.obj", np.arange(120), globe().mesh, None, "printable name"),
        ("out.obj", np.arange(119), globe().mesh, None, "shape"),
        ("out.obj", np.arange(120) + 1, globe().mesh, None, "from 0 to 119"),
        ("out.obj", np.arange(120), Mesh(globe().mesh.vertices, np.zeros((0, 3), dtype=int)), None, "point cloud"),
        ("out.obj", np.arange(120), globe().mesh, "none.png", "none.png: expected a file"),
    ],
)
def test_bad_exports(
    tmp_path: Path, name: str, points: np.ndarray, target: Mesh, picture: str | None, part: str
) -> None:
    own = None if picture is None else tmp_path / picture
    with pytest.raises(InvalidInput, match=part):
        write_textured(tmp_path / name, globe(), target, points, picture=own)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".ply", ".off", ".obj"])
def test_colored_files(tmp_path: Path, suffix: str) -> None:
    target = fibonacci_sphere(40)
    colors = np.random.default_rng(1).random((80, 3))
    points = np.random.default_rng(0).integers(0, 80, 40)
    write_colored(tmp_path / f"a{suffix}", colors, target, points)
    found = read_mesh_file(tmp_path / f"a{suffix}").colors
    np.testing.assert_allclose(known(found), colors[points], atol=0.51 / 255)
    with pytest.raises(InvalidInput, match="one colour per source vertex"):
        write_colored(tmp_path / f"b{suffix}", colors[:, :2], target, points)


def test_projection_is_smooth_and_in_range() -> None:
    places = blob(200).vertices
    uv = projected_uv(places)
    assert uv.min() >= -1e-12
    assert uv.max() <= 1 + 1e-12
    np.testing.assert_allclose(np.ptp(uv[:, 1]), 1)
    long_side = np.argsort(np.ptp(places, axis=0))[[1, 2]]
    # lengths are alike in both directions
    np.testing.assert_allclose(np.ptp(uv, axis=0) * np.ptp(places, axis=0).max(), np.ptp(places, axis=0)[long_side])
    flat = np.zeros((3, 3))
    assert np.isfinite(projected_uv(flat)).all()


def test_the_grid_tells_where_one_is() -> None:
    picture = grid_picture(240, 12).astype(int)
    assert picture.shape == (240, 240, 3)
    centres = picture[10::20, 10::20]
    assert (centres[:, 1:].sum(axis=-1) != centres[:, :-1].sum(axis=-1)).all(), "neighbours differ"
    light = centres[::2, ::2] if centres[0, 0].sum() > centres[0, 1].sum() else centres[::2, 1::2]
    assert (np.diff(light[..., 0], axis=1) > 0).all(), "red grows to the right"
    assert (np.diff(light[..., 1], axis=0) < 0).all(), "green grows upwards"
    assert (picture[10, ::20].sum(axis=-1) < picture[10, 10::20].sum(axis=-1)).all(), "lines are darker"
