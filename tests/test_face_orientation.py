"""Files with faces turned over, some or all of them, or each face twice, are matched as the surface that they show."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import kfmaps
from conftest import blob, fibonacci_sphere, inside_out, sheet
from kfmaps._arrays import KfmapsWarning
from kfmaps.cli.commands.info import description
from kfmaps.fmap.precise import point_positions
from kfmaps.geometry.clean import clean_mesh, face_outward
from kfmaps.geometry.face_orientation import _boundary_and_agreement, _enclosed_volume, doubled_faces, inward_faces
from kfmaps.geometry.mesh import Mesh, face_normals
from kfmaps.io import MeshFile

GUARDS = ("kfmaps.geometry.face_orientation",)
CONFIG = replace(kfmaps.Config.single_fit(), threads=1)


@pytest.fixture
def sphere() -> Mesh:
    return fibonacci_sphere(600)


def looks_outward(mesh: Mesh) -> np.ndarray:
    """Which faces of a surface around the origin look away from it."""
    return (face_normals(mesh) * mesh.vertices[mesh.faces].mean(axis=1)).sum(axis=1) > 0


def turned_over(mesh: Mesh, which: np.ndarray) -> Mesh:
    return Mesh(mesh.vertices, np.where(which[:, None], mesh.faces[:, ::-1], mesh.faces))


@pytest.mark.parametrize("share", [0.0, 0.1, 0.4, 0.7, 1.0])
def test_all_faces_of_a_closed_surface_are_made_to_look_outward(sphere, rng, share):
    which = rng.random(len(sphere.faces)) < share
    given = turned_over(sphere, which)
    np.testing.assert_array_equal(inward_faces(given), which)
    assert looks_outward(face_outward(clean_mesh(given)).mesh).all()


@pytest.mark.parametrize("below", [0.9, 0.0])
def test_a_surface_with_a_hole_and_half_of_one_are_turned_outward(sphere, below):
    height = sphere.vertices[sphere.faces, 2].max(axis=1)
    part = Mesh(sphere.vertices, sphere.faces[height < below])
    assert not inward_faces(part).any()
    assert inward_faces(inside_out(part)).all()


@pytest.mark.parametrize(("depth", "is_known"), [(0.02, False), (0.05, True)])
def test_a_flat_dish_keeps_its_side(sphere, depth, is_known):
    """A pillow whose upper side is open encloses little: more is needed the more open it is."""
    x, y, z = sphere.vertices[sphere.faces].mean(axis=1).T
    dish = Mesh(sphere.vertices * [1, 1, depth], sphere.faces[(z < 0) | (np.hypot(x, y) > 0.9)])
    assert not inward_faces(dish).any()
    assert inward_faces(inside_out(dish)).all() == is_known


@pytest.mark.parametrize(("height", "is_known"), [(0.5, False), (2.0, True)])
def test_a_tube_is_turned_outward_and_a_ring_keeps_its_side(height, is_known):
    """A ring, whose opening is larger than its area, may be the inside of a hole."""
    angles, levels = np.linspace(0, 2 * np.pi, 40, endpoint=False), np.linspace(0, height, 5)
    flat = sheet(np.arange(41.0), np.arange(5.0))
    column, row = flat.vertices[:, 0].astype(int) % 40, flat.vertices[:, 1].astype(int)
    places = np.stack([np.cos(angles[column]), np.sin(angles[column]), levels[row]], axis=1)
    wrapped = np.ravel_multi_index((row, column), (5, 40))[flat.faces]
    vertices = np.zeros((200, 3))
    vertices[np.ravel_multi_index((row, column), (5, 40))] = places
    turned = [inward_faces(side).all() for side in (Mesh(vertices, wrapped), Mesh(vertices, wrapped[:, ::-1]))]
    assert sorted(turned) == [False, is_known]


def test_the_volume_of_an_open_box_is_that_of_the_box():
    corners = np.array([[x, y, z] for x in (3, 5) for y in (0, 1) for z in (0, 4)], dtype=float)
    hull = ConvexHull(corners).simplices
    box = Mesh(
        corners, np.where(looks_outward(Mesh(corners - corners.mean(axis=0), hull))[:, None], hull, hull[:, ::-1])
    )
    open_box = box.faces[~(box.vertices[box.faces, 2] == 4).all(axis=1)]
    rim, agree = _boundary_and_agreement(open_box, 8)
    assert agree
    assert len(rim) == 4
    assert _enclosed_volume(corners, open_box, rim, np.zeros(4, dtype=int)) == pytest.approx(8)


def test_an_open_sheet_keeps_its_side_and_agrees_with_itself():
    flat = sheet(*2 * [np.arange(12.0)])
    wavy = Mesh(flat.vertices + 0.2 * np.sin(flat.vertices[:, :1]) * [0, 0, 1], flat.faces)
    for side in (wavy, inside_out(wavy)):
        assert not inward_faces(side).any()
        for first in (0, 1):  # whether the first face, where the others are made to agree with, is among the turned
            few = np.arange(len(flat.faces)) % 5 == first
            np.testing.assert_array_equal(inward_faces(turned_over(side, few)), few)


def test_a_closed_sheet_without_an_inside_keeps_its_side(sphere):
    flat = Mesh(sphere.vertices * [1, 1, 1e-4], sphere.faces[:, ::-1])
    assert not inward_faces(flat).any()


def test_second_sides_are_left_out_and_single_folds_stay(sphere):
    both = Mesh(sphere.vertices, np.concatenate([sphere.faces, np.roll(sphere.faces[:, ::-1], 1, axis=1)]))
    np.testing.assert_array_equal(doubled_faces(both.faces), np.arange(len(both.faces)) >= len(sphere.faces))
    # However large the numbers of their vertices.
    np.testing.assert_array_equal(doubled_faces(both.faces + 2**22), doubled_faces(both.faces))
    part = face_outward(clean_mesh(both))
    np.testing.assert_array_equal(part.mesh.faces, sphere.faces)
    np.testing.assert_array_equal(part.faces_to_original, np.arange(len(sphere.faces)))
    assert part.doubled == len(sphere.faces)
    folded = Mesh(sphere.vertices, np.concatenate([sphere.faces, sphere.faces[:3, ::-1]]))
    assert face_outward(clean_mesh(folded)).doubled == 0


@pytest.fixture(scope="module")
def plain():
    return kfmaps.match(blob(500), blob(420, twist=0.4), CONFIG)


@pytest.mark.parametrize(("damage", "share"), [("inside out", 1.0), ("some", 0.2), ("two-sided", 0.0)])
def test_a_match_is_that_of_the_undamaged_shapes(plain, damage, share):
    damaged = []
    for mesh in (plain.source, plain.target):
        given = turned_over(mesh, np.random.default_rng(5).random(len(mesh.faces)) < share)
        second = given.faces[:, ::-1] if damage == "two-sided" else given.faces[:0]
        damaged.append(Mesh(mesh.vertices, np.concatenate([given.faces, second])))
    with pytest.warns(KfmapsWarning, match="second sides" if damage == "two-sided" else "turned outward"):
        found = kfmaps.match(damaged[0], damaged[1], CONFIG)
    np.testing.assert_array_equal(found.target_to_source, plain.target_to_source)
    # Weights belong to corners, and the corners of a face that is turned run the other way.
    np.testing.assert_allclose(
        point_positions(found.precise(), damaged[0]), point_positions(plain.precise(), plain.source), atol=1e-9
    )


def test_info_counts_faces_that_look_inward(sphere):
    for faces, count in ((sphere.faces, 0), (sphere.faces[:, ::-1], len(sphere.faces))):
        facts = description("a.ply", MeshFile(Mesh(sphere.vertices, faces)))
        assert facts["topology"]["inward_faces"] == count
