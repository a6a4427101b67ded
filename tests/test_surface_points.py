"""Distances between points inside triangles, errors of such points, and smoothness."""

import numpy as np
import pytest
from scipy.spatial import Delaunay

from kfmaps import datasets
from kfmaps._arrays import InvalidInput
from kfmaps.fmap.evaluate import geodesic_errors, precise_errors, smoothness
from kfmaps.fmap.precise import PointMap, point_positions, vertex_point_map
from kfmaps.geometry.geodesics import geodesic_distance_pairs
from kfmaps.geometry.mesh import Mesh, mirror_mesh, surface_area
from kfmaps.geometry.surface_points import surface_point_distances

GUARDS = ("kfmaps.fmap.evaluate", "kfmaps.fmap.precise", "kfmaps.geometry.surface_points")


def plane(rng: np.random.Generator, n: int = 600) -> Mesh:
    """A square cut into uneven triangles."""
    flat = rng.uniform(size=(n, 2))
    faces = Delaunay(flat).simplices.astype(np.int64)
    a, b = flat[faces[:, 1]] - flat[faces[:, 0]], flat[faces[:, 2]] - flat[faces[:, 0]]
    turned = a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]
    faces[turned] = faces[turned][:, ::-1]
    return Mesh(np.c_[flat, np.zeros(n)], faces)


def anywhere(mesh: Mesh, count: int, rng: np.random.Generator) -> PointMap:
    return PointMap(rng.integers(0, len(mesh.faces), count), rng.dirichlet(np.ones(3), count))


def test_in_a_plane_near_points_are_as_far_as_a_ruler_says() -> None:
    rng = np.random.default_rng(0)
    mesh = plane(rng)
    a, b = anywhere(mesh, 20_000, rng), anywhere(mesh, 20_000, rng)
    ruler = np.linalg.norm(point_positions(a, mesh) - point_positions(b, mesh), axis=1)
    inside = [
        np.minimum(p[:, :2], 1 - p[:, :2]).min(axis=1) > 0.1
        for p in (point_positions(a, mesh), point_positions(b, mesh))
    ]
    near = np.flatnonzero((ruler < 0.12) & inside[0] & inside[1])
    assert len(near) > 200
    found = surface_point_distances(mesh, a.faces[near], a.weights[near], b.faces[near], b.weights[near])
    np.testing.assert_allclose(found, ruler[near], atol=1e-10)


def test_far_points_are_never_nearer_than_a_ruler_and_hardly_farther() -> None:
    rng = np.random.default_rng(1)
    mesh = plane(rng)
    a, b = anywhere(mesh, 150, rng), anywhere(mesh, 150, rng)
    ruler = np.linalg.norm(point_positions(a, mesh) - point_positions(b, mesh), axis=1)
    found = surface_point_distances(mesh, a.faces, a.weights, b.faces, b.weights)
    assert (found >= ruler - 1e-12).all()
    assert np.median(found / ruler) < 1.01
    back = surface_point_distances(mesh, b.faces, b.weights, a.faces, a.weights)
    np.testing.assert_allclose(found, back, rtol=0.01)


def test_vertices_are_points_too() -> None:
    """Of a curved surface; a straight line from a point crosses more edges than the graph of vertices has."""
    rng = np.random.default_rng(2)
    mesh = datasets.sphere(400, rng=0)
    a, b = rng.integers(0, len(mesh.vertices), (2, 100))
    one, two = vertex_point_map(a, mesh), vertex_point_map(b, mesh)
    found = surface_point_distances(mesh, one.faces, one.weights, two.faces, two.weights)
    graph = geodesic_distance_pairs(mesh, a, b)
    assert (found <= graph + 1e-12).all()
    np.testing.assert_allclose(found, graph, rtol=0.02, atol=1e-12)
    np.testing.assert_allclose(precise_errors(mesh, a, b), geodesic_errors(mesh, a, b), rtol=0.02, atol=1e-12)
    np.testing.assert_allclose(precise_errors(mesh, one, two), found / np.sqrt(surface_area(mesh)))
    assert precise_errors(mesh, one, a).max() < 1e-12


def test_components_are_apart_and_broken_points_refused() -> None:
    two = Mesh(np.vstack([np.eye(3), np.eye(3) + 5]), np.array([[0, 1, 2], [3, 4, 5]]))
    thirds = np.full((2, 3), 1 / 3)
    found = surface_point_distances(two, np.array([0, 0]), thirds, np.array([0, 1]), thirds)
    assert found[0] == 0
    assert np.isinf(found[1])
    with pytest.raises(InvalidInput, match="faces of b"):
        surface_point_distances(two, np.array([0]), thirds[:1], np.array([2]), thirds[:1])
    with pytest.raises(InvalidInput, match="equal length"):
        precise_errors(two, np.array([0, 1]), np.array([0]))


def test_smoothness_of_the_identity_and_of_collapsed_and_mirrored_maps() -> None:
    mesh = datasets.sphere(300, rng=0)
    n = len(mesh.vertices)
    whole = smoothness(mesh, mesh, np.arange(n))
    assert (whole.coverage, whole.flipped_area, whole.stretched_area) == (pytest.approx(1.0), 0.0, 0.0)
    point = smoothness(mesh, mesh, np.zeros(n, dtype=np.int64))
    assert point.coverage < 0.1
    assert point.stretched_area == 1.0
    inside_out = Mesh(3 * mesh.vertices, mesh.faces[:, ::-1])
    assert smoothness(mesh, inside_out, np.arange(n)).flipped_area == 0.0
    assert smoothness(inside_out, mesh, np.arange(n)).flipped_area == 0.0
    mirrored = smoothness(mesh, mirror_mesh(inside_out), np.arange(n))
    assert mirrored.flipped_area == pytest.approx(1.0)
    assert mirrored.stretched_area == 0.0  # lengths are compared at equal areas
