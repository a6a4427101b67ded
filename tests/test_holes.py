"""Small holes are filled before a match; shapes that are cut off stay as they are."""

from __future__ import annotations

import numpy as np
import pytest

from conftest import blob, small_fit
from kfmaps._arrays import KfmapsWarning
from kfmaps.datasets import sphere
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.connectivity import mesh_edges
from kfmaps.geometry.holes import _least_faces, fill_holes
from kfmaps.geometry.mesh import Mesh, face_areas, face_normals, surface_area, unit_area
from kfmaps.geometry.topology import topology
from kfmaps.matching.match import match
from kfmaps.shape import prepare

GUARDS = ("kfmaps.geometry.holes", "kfmaps.shape", "kfmaps.matching.reindexing")

SMALL = small_fit(20, 40, 40, 60, refinement=ZoomOut(start=10, stop=40, step=10))
MARKS = np.array([[5, 5], [100, 110], [200, 190], [300, 290]])


def without_faces(mesh: Mesh, share: float, seed: int = 0) -> Mesh:
    return Mesh(mesh.vertices, mesh.faces[np.random.default_rng(seed).random(len(mesh.faces)) > share])


def without_discs(mesh: Mesh, centres: np.ndarray, radius: float) -> Mesh:
    away = np.linalg.norm(mesh.vertices[:, None] - centres, axis=2).min(axis=1)
    return Mesh(mesh.vertices, mesh.faces[(away[mesh.faces] > radius).all(axis=1)])


def polygon(angles: np.ndarray, radii: np.ndarray | float = 1.0) -> np.ndarray:
    return np.column_stack([radii * np.cos(angles), radii * np.sin(angles), np.zeros(len(angles))])


def area_of(corners: np.ndarray) -> float:
    return 0.5 * float(np.linalg.norm(np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)))


def none_is_edge(corners: np.ndarray) -> np.ndarray:
    return np.zeros((1, len(corners), len(corners)), dtype=bool)


@pytest.mark.parametrize("k", [3, 4, 5, 12])
def test_the_faces_in_a_plane_polygon_cover_it_once(k) -> None:
    """Also in a star, whose shortest diagonals lie outside."""
    rng = np.random.default_rng(k)
    angles = 2 * np.pi * np.arange(k) / k
    for radii in (np.ones(k), np.where(np.arange(k) % 2, 0.45, 1.0), rng.uniform(0.6, 1.0, k)):
        corners = polygon(angles, radii)
        faces, is_possible = _least_faces(corners[None], none_is_edge(corners))
        assert faces.shape == (1, k - 2, 3)
        assert is_possible.all()
        triangles = Mesh(corners, faces[0])
        np.testing.assert_allclose(face_areas(triangles).sum(), area_of(corners), rtol=1e-9)
        np.testing.assert_allclose(face_normals(triangles)[:, 2], 1.0)


def test_the_faces_of_many_loops_are_those_of_each_and_avoid_edges() -> None:
    rng = np.random.default_rng(3)
    loops = np.stack([polygon(2 * np.pi * np.arange(7) / 7, rng.uniform(0.5, 1, 7)) for _ in range(5)])
    free = np.zeros((5, 7, 7), dtype=bool)
    together = _least_faces(loops, free)[0]
    for loop, faces in zip(loops, together, strict=True):
        np.testing.assert_array_equal(_least_faces(loop[None], free[:1])[0][0], faces)
    square = polygon(2 * np.pi * np.arange(4) / 4, np.array([1, 0.9, 1, 0.9]))
    taken = none_is_edge(square)
    assert sorted(np.bincount(_least_faces(square[None], taken)[0].ravel())) == [1, 1, 2, 2]
    diagonal = set(np.flatnonzero(np.bincount(_least_faces(square[None], taken)[0].ravel()) == 2))
    assert diagonal == {1, 3}  # the shorter one
    taken[0, 1, 3] = taken[0, 3, 1] = True
    faces, is_possible = _least_faces(square[None], taken)
    assert is_possible.all()
    assert set(np.flatnonzero(np.bincount(faces.ravel()) == 2)) == {0, 2}
    taken[0, 0, 2] = taken[0, 2, 0] = True
    assert not _least_faces(square[None], taken)[1].any()


@pytest.mark.parametrize("share", [0.05, 0.15])
def test_missing_faces_are_filled_with_faces_like_those_that_were_there(share) -> None:
    whole = unit_area(sphere(1500))
    scale = np.sqrt(surface_area(without_faces(whole, share)))
    surface = fill_holes(unit_area(without_faces(whole, share)))
    assert surface is not None
    counts = topology(surface)
    assert counts.inconsistent_edges == 0
    assert mesh_edges(surface.faces, 1500)[1].min() == 2 or share > 0.1
    np.testing.assert_allclose(scale**2 * surface_area(surface), 1.0, rtol=5e-3)
    centres = surface.vertices[surface.faces].mean(axis=1)
    outward = np.einsum("fi,fi->f", face_normals(surface), centres - surface.vertices.mean(axis=0))
    assert (outward > 0).mean() > 0.999


@pytest.mark.parametrize("seed", range(3))
def test_holes_that_touch_in_vertices_are_filled_one_by_one(seed) -> None:
    filled = fill_holes(unit_area(without_faces(unit_area(blob(2000)), 0.3, seed)))
    assert filled is not None
    assert topology(filled).boundary_edges <= 3


def test_round_holes_are_filled_up_to_a_hundredth_of_the_area() -> None:
    ball = unit_area(sphere(3000))
    centres = 0.282 * np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]])
    small = unit_area(without_discs(ball, centres, 0.035))
    surface = fill_holes(small)
    assert surface is not None
    assert topology(surface).is_closed
    np.testing.assert_array_equal(surface.faces[: len(small.faces)], small.faces)
    assert fill_holes(unit_area(without_discs(ball, centres, 0.07))) is None
    assert fill_holes(unit_area(without_discs(ball, centres[:1], 0.03))) is None  # it counts as closed
    assert fill_holes(ball) is None


def test_limbs_that_are_cut_off_are_no_holes() -> None:
    """Five tubes on a ball, cut open at their ends."""
    ball = unit_area(sphere(6000))
    directions = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    away = np.linalg.norm(ball.vertices[:, None] - 0.282 * directions, axis=2)
    limb = away.argmin(axis=1)
    near = away.min(axis=1)
    vertices = ball.vertices + (0.2 * np.maximum(0, 0.07 - near) / 0.07 * 1.5)[:, None] * directions[limb]
    faces = ball.faces[(near[ball.faces] > 0.04).all(axis=1)]
    used, numbers = np.unique(faces, return_inverse=True)
    mesh = unit_area(Mesh(vertices[used], numbers.reshape(-1, 3)))
    assert topology(mesh).boundary_loops == 5
    assert fill_holes(mesh) is None


def test_a_shape_that_is_mostly_cut_off_stays_as_it_is() -> None:
    ball = unit_area(sphere(3000))
    half = ball.faces[(ball.vertices[ball.faces][:, :, 2] > 0).all(axis=1)]
    used, numbers = np.unique(half, return_inverse=True)
    cap = Mesh(ball.vertices[used], numbers.reshape(-1, 3))
    assert fill_holes(unit_area(without_discs(cap, 0.282 * np.array([[0, 0.6, 0.8]]), 0.03))) is None


def test_a_prepared_shape_keeps_what_was_given() -> None:
    whole = blob(900)
    holed = without_faces(whole, 0.1)
    seamed = Mesh(7 * holed.vertices[holed.faces.ravel()], np.arange(3 * len(holed.faces)).reshape(-1, 3))
    for mesh in (Mesh(7 * holed.vertices, holed.faces), seamed):
        with pytest.warns(KfmapsWarning, match="small holes are filled"):
            shape = prepare(mesh, SMALL)
        assert shape.is_repaired
        assert not shape.is_outer_surface
        np.testing.assert_array_equal(shape.given_mesh.faces, mesh.faces)
        np.testing.assert_array_equal(shape.mesh.faces[: len(mesh.faces)], mesh.faces)
        assert shape.extent is not None
        np.testing.assert_allclose(shape.extent, 7 * np.sqrt(surface_area(whole)), rtol=0.01)
        np.testing.assert_allclose(surface_area(shape.cleaned[0].mesh), 1, rtol=1e-9)
        scale = shape.extent / 7 / np.sqrt(surface_area(whole))
        assert abs(scale - 1) < 0.01
        lengths = [np.linalg.norm(m.vertices[m.faces[0, 0]] - m.vertices[m.faces[0, 1]]) for m in (mesh, shape.mesh)]
        np.testing.assert_allclose(lengths[0] / lengths[1], shape.extent, rtol=1e-9)


@pytest.mark.parametrize("is_source", [True, False])
def test_a_body_with_missing_faces_is_matched_as_the_body(is_source) -> None:
    body, other = blob(900), blob(900, twist=0.4)
    clean = match(*((body, other) if is_source else (other, body)), SMALL, landmarks=MARKS)
    holed = without_faces(body, 0.15)
    turned = Mesh(holed.vertices, holed.faces[:, ::-1])
    for mesh in (holed, turned):
        with pytest.warns(KfmapsWarning, match="small holes are filled"):
            found = match(*((mesh, other) if is_source else (other, mesh)), SMALL, landmarks=MARKS)
        source = body if is_source else other
        assert geodesic_errors(source, found.target_to_source, clean.target_to_source).mean() < 0.02
        given = mesh if is_source else other
        places = found.precise()
        assert places.faces.max() < len(given.faces)
        positions = np.einsum("ni,nij->nj", places.weights, given.vertices[given.faces[places.faces]])
        assert np.median(np.linalg.norm(positions - given.vertices[found.target_to_source], axis=1)) < 0.1
