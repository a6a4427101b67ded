"""SHOT against a plain loop over its definition, and the laws it obeys."""

from __future__ import annotations

import numpy as np
import pytest

import kfmaps.descriptors.shot as module
from conftest import blob, cloud_of, inside_out, joined, reordered, rotation, sheet, shifted
from kfmaps._arrays import InvalidInput
from kfmaps._threads import limit_threads
from kfmaps.descriptors.shot import mirror_shot, shot
from kfmaps.geometry.mesh import Mesh, face_areas, unit_area, vertex_normals
from plain_shot import plain_shot

GUARDS = ("kfmaps.descriptors.shot",)


@pytest.mark.parametrize(("radius", "samples"), [(0.4, 50), (0.5, 160)])
def test_agrees_with_the_plain_loop(radius, samples):
    mesh = blob(44)
    at = np.arange(0, 44, 5)
    found, wanted = shot(mesh, radius, samples=samples)[at], plain_shot(mesh, radius, samples, at)
    assert found.shape == (9, 352)
    # Squares, as roots magnify the rounding of a share that is nearly zero.
    np.testing.assert_allclose(found**2, wanted**2, atol=1e-6)  # single precision
    np.testing.assert_allclose(found, wanted, atol=1e-4)


def test_on_a_plane_the_shares_are_known():
    flat = sheet(*2 * [np.linspace(0, 1, 41)])
    share = shot(flat, 0.3, samples=8000)[20 * 41 + 20].reshape(8, 2, 2, 11) ** 2
    np.testing.assert_allclose(share.sum(axis=(0, 1, 2)), np.eye(11)[10], atol=1e-12)  # cosine 1
    np.testing.assert_allclose(share.sum(axis=(0, 2, 3)), [0.5, 0.5], atol=1e-7)  # between both elevations
    np.testing.assert_allclose(share.sum(axis=(1, 2, 3)), 1 / 8, rtol=0.02)
    r = (np.arange(10_000) + 0.5) / 10_000
    faded = r * np.minimum(1, 10 * (1 - r))
    inner = np.sum(faded * np.maximum(1 - np.abs(r - 0.25) / 0.5, 0))
    outer = np.sum(faded * np.maximum(1 - np.abs(r - 0.75) / 0.5, 0))
    np.testing.assert_allclose(share.sum(axis=(0, 1, 3)), [inner / (inner + outer), outer / (inner + outer)], rtol=0.01)


@pytest.mark.parametrize("samples", [1000, 300])  # 300: faces are merged
def test_pose_unit_and_order_change_nothing_and_a_mirror_reverses_the_azimuths(samples, rng):
    mesh, order = blob(400), rng.permutation(400)
    moved = reordered(Mesh(37.0 * mesh.vertices @ rotation(1).T + np.array([5.0, -3.0, 90.0]), mesh.faces), order)
    moved = Mesh(moved.vertices, moved.faces[rng.permutation(len(moved.faces))])
    mirror = inside_out(Mesh(mesh.vertices * np.array([-1.0, 1.0, 1.0]), mesh.faces))
    own, other, turned = (shot(m, 0.2, samples=samples) for m in (mesh, moved, mirror))
    np.testing.assert_allclose(np.linalg.norm(own, axis=1), 1)
    assert own.min() == 0
    np.testing.assert_allclose(other, own[order], atol=1e-5)
    np.testing.assert_allclose(turned, mirror_shot(own), atol=1e-5)
    assert np.median(np.linalg.norm(own - turned, axis=1)) > 0.1
    np.testing.assert_array_equal(mirror_shot(mirror_shot(own)), own)


def test_blocks_and_threads_change_nothing(monkeypatch):
    mesh = blob(300)
    with limit_threads(1):
        whole = shot(mesh, 0.2)
    monkeypatch.setattr(module, "_PAIRS", 700)
    with limit_threads(3):
        np.testing.assert_allclose(whole, shot(mesh, 0.2), atol=1e-7)


def test_a_point_on_its_way_is_handed_over_smoothly():
    steps = 2000
    s = np.linspace(0, 1, steps)
    paths = [  # (azimuth, elevation, distance, cosine): each crosses all borders of one kind
        (2 * np.pi * s, 0 * s + 1.2, 0 * s + 0.6, 0 * s + 0.33),
        (0 * s + 0.5, np.pi * (0.0005 + 0.999 * s), 0 * s + 0.6, 0 * s + 0.33),
        (0 * s + 0.5, 0 * s + 1.2, 0.01 + 0.99 * s, 0 * s + 0.33),
        (0 * s + 0.5, 0 * s + 1.2, 0 * s + 0.6, 2 * s - 1),
    ]
    for azimuth, elevation, distance, cosine in paths:
        flat = np.sin(elevation)
        direction = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.cos(elevation)], axis=1)
        normal = np.stack([np.sqrt(1 - cosine**2), 0 * s, cosine], axis=1)
        offset = (direction * distance[:, None]).T
        pairs = module._Pairs(np.arange(steps), offset, distance, normal.T, np.ones(steps), steps)
        rows = module._histograms(pairs, np.tile(np.eye(3), (steps, 1, 1)), np.ones(steps))
        moved = np.abs(np.diff(rows, axis=0)).sum(axis=1)
        assert 0 < moved.max() < 25 / steps  # a point that changed its bin at once would move 1


def test_noise_changes_little():
    mesh = blob(400)
    noise = np.random.default_rng(0).standard_normal(mesh.vertices.shape)
    own = shot(mesh, 0.2, samples=1000)
    change = [
        np.linalg.norm(own - shot(Mesh(mesh.vertices + e * noise, mesh.faces), 0.2, samples=1000), axis=1)
        for e in (1e-6, 1e-4)
    ]
    assert np.quantile(change[0], 0.9) < 0.01
    assert np.quantile(change[1], 0.8) < 0.1


def test_it_hardly_notices_the_triangulation():
    mesh = unit_area(blob(700))
    # Divide every face on one side into three, by its centre: the same surface, triangulated unevenly.
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    chosen = centres[:, 0] > 0.05
    new = 700 + np.arange(chosen.sum())
    a, b, c = mesh.faces[chosen].T
    parts = [np.stack(f, axis=1) for f in ((a, b, new), (b, c, new), (c, a, new))]
    finer = Mesh(np.concatenate([mesh.vertices, centres[chosen]]), np.concatenate([mesh.faces[~chosen], *parts]))
    border = np.abs(mesh.vertices[:, 0] - 0.05) < 0.15
    change = np.linalg.norm(shot(mesh, 0.15) - shot(finer, 0.15)[:700], axis=1)
    assert np.median(change[border]) < 0.1


def test_merging_keeps_area_centroid_and_sides():
    # A plate 0.004 thick: both sides fall into the same cells.
    side = sheet(*2 * [np.linspace(-0.5, 0.5, 30)])
    plate = unit_area(joined(shifted(side, 0, 0, 0.002), inside_out(shifted(side, 0, 0, -0.002))))
    support = module._surface_support(plate, vertex_normals(plate), 600)
    assert 300 < len(support.points) < 1200
    assert support.weights.sum() == pytest.approx(1)
    np.testing.assert_allclose(support.weights @ support.points, 0, atol=1e-12)
    np.testing.assert_allclose(np.abs(support.normals[:, 2]), 1)
    assert support.weights[support.normals[:, 2] > 0].sum() == pytest.approx(0.5)


def test_subdivision_keeps_area_and_reaches_the_count():
    mesh = unit_area(blob(60))
    support = module._surface_support(mesh, vertex_normals(mesh), 3000)
    assert 2000 < len(support.points) < 4500
    areas = face_areas(mesh)
    assert support.weights.sum() == pytest.approx(areas.sum())
    centroid = areas @ mesh.vertices[mesh.faces].mean(axis=1)
    np.testing.assert_allclose(support.weights @ support.points, centroid, atol=1e-12)


def test_loose_vertices_have_the_descriptor_of_the_nearest():
    mesh = blob(200)
    vertices = np.concatenate([mesh.vertices, [[50.0, 0.0, 0.0]], mesh.vertices[:1] * 1.01])
    descriptors = shot(Mesh(vertices, mesh.faces), 0.2)
    away = np.linalg.norm(mesh.vertices - vertices[200], axis=1).argmin()
    np.testing.assert_array_equal(descriptors, shot(mesh, 0.2)[np.r_[:200, away, 0]])


@pytest.mark.parametrize("radius", [1e-6, 0.1, 5.0])
def test_a_single_triangle(radius):
    triangle = Mesh(np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    length = np.linalg.norm(shot(triangle, radius, samples=100), axis=1)
    assert np.all(np.isclose(length, 1) | (length == 0))
    assert np.all(length == 0) if radius == 1e-6 else np.any(length > 0)


def test_a_frame_of_points_straight_above_is_a_rotation():
    up = np.array([[0.0, 0.0, 1.0]] * 2)
    pairs = module._Pairs(np.zeros(2, dtype=int), (up * [[0.3], [0.5]]).T, np.array([0.3, 0.5]), up.T, np.ones(2), 1)
    frame = module._frames(pairs)[0]
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1)


def test_surface_without_a_mean_normal_is_zero():
    triangle = np.array([[0.0, 0, 0], [2, 0, 0], [0, 1, 0]])
    both_sides = Mesh(np.concatenate([triangle, triangle]), np.array([[0, 1, 2], [5, 4, 3]]))
    assert not shot(both_sides, 5.0).any()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"samples": 0}, "samples"),
        ({"radius": -1.0}, "radius"),
        ({"radius": float("nan")}, "radius"),
    ],
)
def test_refuses_bad_settings(change, said):
    with pytest.raises(InvalidInput, match=said):
        shot(blob(50), **change)


def test_refuses_what_has_no_surface():
    vertices = blob(50).vertices
    with pytest.raises(InvalidInput, match="Triangulate"):
        shot(cloud_of(blob(50)))
    with pytest.raises(InvalidInput, match="vertices"):
        shot(Mesh(np.where(vertices > 1, np.nan, vertices), blob(50).faces))
    with pytest.raises(InvalidInput, match="32"):
        mirror_shot(np.ones((3, 33)))


def test_some_vertices_have_the_descriptor_that_they_have_among_all():
    """Also of a mesh with a vertex of no face, which counts as the nearest one."""
    mesh = blob(300)
    more = Mesh(np.vstack([9 * mesh.vertices[:1], mesh.vertices]), mesh.faces + 1)
    rows = np.array([5, 100, 0])
    np.testing.assert_array_equal(shot(more, 0.2, at=rows), shot(more, 0.2)[rows])
    np.testing.assert_array_equal(shot(more, 0.2)[1:], shot(mesh, 0.2))
