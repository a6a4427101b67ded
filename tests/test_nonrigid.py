"""Closest points, bending, and the non-rigid fit."""

from dataclasses import replace
from typing import cast

import numpy as np
import pytest

import kfmaps
from conftest import cloud_of, joined, rotation, shifted, small_fit, two_poses
from kfmaps import datasets
from kfmaps._arrays import InvalidInput
from kfmaps.fmap.precise import point_positions, vertex_point_map
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.arap import arap_energy, arap_energy_per_vertex, arap_rhs, build_arap, nearest_rotations, rotations
from kfmaps.geometry.closest_points import closest_among, closest_points
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.registration.accept import RegistrationReport
from kfmaps.registration.nonrigid_icp import NonRigid

GUARDS = ("kfmaps.fmap.precise", "kfmaps.geometry", "kfmaps.registration")


CONFIG = small_fit(30, 40, 60, 300, refinement=ZoomOut(20, 60, 10))


@pytest.fixture(scope="module")
def pair() -> datasets.ExamplePair:
    return two_poses(1500)


@pytest.fixture(scope="module")
def shapes(pair: datasets.ExamplePair) -> tuple[kfmaps.Shape, kfmaps.Shape]:
    return kfmaps.prepare(pair.source, CONFIG, name="a"), kfmaps.prepare(pair.target, CONFIG, name="b")


def test_the_nearest_rotation_is_that_of_singular_values() -> None:
    """Also of matrices of rank two, of reflections, and of those whose rotation is hardly determined."""
    rng = np.random.default_rng(3)
    left, right = (np.linalg.qr(rng.normal(size=(2000, 3, 3)))[0] for _ in range(2))
    sizes = np.sort(rng.random((2000, 3)) ** 3, axis=1)[:, ::-1] * 1e-4
    sizes[::5, 2] = 0.0
    given = left * sizes[:, None, :] @ right
    u, _, vh = np.linalg.svd(given)
    u[:, :, 2] *= (np.linalg.det(u) * np.linalg.det(vh))[:, None]
    found = nearest_rotations(given)
    assert np.allclose(np.linalg.det(found), 1.0)
    assert np.abs(found @ found.transpose(0, 2, 1) - np.eye(3)).max() < 1e-13
    assert np.abs(found - u @ vh).max() < 1e-10
    assert np.allclose(nearest_rotations(np.zeros((1, 3, 3))), np.eye(3))


def test_places_on_a_surface_are_the_closest_of_all_faces() -> None:
    """Against every face; one face is huge, which no bound by the mean size survives."""
    huge = Mesh(np.diag([3.0, 5.0, 4.0]), np.array([[0, 1, 2]]))
    mesh = joined(datasets.sphere(300, rng=0), huge)
    vertices, faces, points = mesh.vertices, mesh.faces, np.random.default_rng(0).normal(size=(200, 3))
    found = closest_points(points, vertices, faces)
    each = np.repeat(np.arange(len(points)), len(faces))
    brute = closest_among(points, vertices, faces, np.tile(np.arange(len(faces)), len(points)), each)
    np.testing.assert_allclose(found.distances, brute.distances, atol=1e-12)
    np.testing.assert_allclose(found.weights.sum(axis=1), 1)
    places = np.einsum("qi,qij->qj", found.weights, vertices[faces[found.faces]])
    np.testing.assert_allclose(np.linalg.norm(places - points, axis=1), brute.distances, atol=1e-12)
    assert (brute.faces == len(faces) - 1).any()


def test_no_point_of_a_triangle_is_closer() -> None:
    rng = np.random.default_rng(1)
    corners, points = rng.normal(size=(100, 3, 3)), rng.normal(size=(100, 3))
    corners[:10, 2] = corners[:10, 1]  # without area
    faces = np.arange(300).reshape(100, 3)
    found = closest_among(points, corners.reshape(-1, 3), faces, np.arange(100), np.arange(100))
    weights = rng.dirichlet(np.ones(3) / 2, size=2000)
    others = np.einsum("wi,tij->wtj", weights, corners)
    assert (np.linalg.norm(others - points, axis=2).min(axis=0) >= found.distances - 1e-12).all()


def test_arap_energy_is_zero_for_motions_and_has_no_unit() -> None:
    mesh, R = datasets.sphere(200, rng=0), rotation(2)
    energy = build_arap(mesh)
    moved = mesh.vertices @ R.T + 1.0
    assert arap_energy(energy, moved) < 1e-10
    np.testing.assert_allclose(rotations(energy, moved), np.broadcast_to(R, (len(moved), 3, 3)), atol=1e-8)
    stretched = mesh.vertices * np.array([1.0, 1.0, 1.5])
    large = build_arap(Mesh(7 * mesh.vertices, mesh.faces))
    assert arap_energy(large, 7 * stretched) == pytest.approx(49 * arap_energy(energy, stretched))


def test_shares_of_vertices_add_up_to_twice_the_energy() -> None:
    mesh = datasets.sphere(100, rng=0)
    energy = build_arap(mesh)
    x = mesh.vertices * (1.0, 1.5, 0.7)
    shares = arap_energy_per_vertex(energy, x)
    assert shares.sum() == pytest.approx(2 * arap_energy(energy, x))
    assert shares.min() > 0
    turned = mesh.vertices.copy()
    turned[mesh.vertices[:, 2] > 0.3] += (0.0, 0.0, 0.1)
    still = np.flatnonzero(mesh.vertices[:, 2] < -0.3)
    assert arap_energy_per_vertex(energy, turned)[still] == pytest.approx(0, abs=1e-12)


def test_arap_energy_is_its_definition_and_arap_rhs_its_gradient() -> None:
    rng = np.random.default_rng(3)
    mesh = datasets.sphere(100, rng=0)
    energy = build_arap(mesh)
    x, R = rng.normal(size=mesh.vertices.shape), nearest_rotations(rng.normal(size=(len(mesh.vertices), 3, 3)))
    edges = energy.laplacian.tocoo()
    i, j = edges.row, edges.col
    gap = (x[i] - x[j]) - np.einsum("eab,eb->ea", R[i], mesh.vertices[i] - mesh.vertices[j])
    assert arap_energy(energy, x, R) == pytest.approx(float((-0.5 * edges.data * (gap**2).sum(axis=1))[i != j].sum()))
    step = 1e-6 * rng.normal(size=x.shape)
    slope = 2 * (energy.laplacian @ x - arap_rhs(energy, R))
    change = (arap_energy(energy, x + step, R) - arap_energy(energy, x - step, R)) / 2
    assert change == pytest.approx(float((slope * step).sum()), rel=1e-6)
    assert arap_energy(energy, x) <= arap_energy(energy, x, R)  # the best rotations are the best


def test_a_moved_mesh_is_found(pair: datasets.ExamplePair) -> None:
    """From a map that is wrong by several edges: the fit knows nothing but closest points and rigidity."""
    rng = np.random.default_rng(4)
    source = unit_area(pair.source)
    target = Mesh(source.vertices @ rotation(4).T, source.faces)
    near = np.linalg.norm(source.vertices[:, None] - source.vertices[None], axis=2).argsort(axis=1)[:, :12]
    start = near[np.arange(len(near)), rng.integers(0, 12, len(near))]
    found = NonRigid()(source, target, start)
    assert np.linalg.norm(found.vertices - target.vertices, axis=1).mean() < 3e-3
    assert found.gap < 1e-3
    assert found.bending < 1e-3
    places = np.einsum("ti,tij->tj", found.weights, source.vertices[source.faces[found.faces]])
    assert np.linalg.norm(places - source.vertices, axis=1).mean() < 3e-3


def test_registration_repairs_sliding_and_a_folded_limb(pair: datasets.ExamplePair) -> None:
    """A smooth wrong map: every target vertex slides, and around one end the map is the mirror image."""
    source, target = unit_area(pair.source), unit_area(pair.target)
    truth = source.vertices[pair.truth]
    slid = truth + 0.03 * np.sin(7 * truth[:, [1, 2, 0]])
    start = np.linalg.norm(slid[:, None] - source.vertices[None], axis=2).argmin(axis=1)
    before = np.linalg.norm(source.vertices[start] - truth, axis=1).mean()
    found = NonRigid()(source, target, start)
    after = np.linalg.norm(
        np.einsum("ti,tij->tj", found.weights, source.vertices[source.faces[found.faces]]) - truth, axis=1
    ).mean()
    assert after < 0.6 * before


def test_a_match_has_points_in_triangles(pair: datasets.ExamplePair, shapes: tuple[kfmaps.Shape, kfmaps.Shape]) -> None:
    """Closer to the truth than its vertices; ``target_to_source`` is the nearest corner."""
    landmark_vertices = np.stack([pair.truth[::300], np.arange(len(pair.truth))[::300]], axis=1)
    found = kfmaps.match(*shapes, CONFIG, landmarks=landmark_vertices)
    place, report = found.precise(), cast(RegistrationReport, found.registration.report)
    assert (report.accepted, report.reason) == (True, None)
    assert report.loss is not None
    assert report.after == pytest.approx(found.local_confidence.mean())
    np.testing.assert_allclose(place.weights.sum(axis=1), 1)
    assert (place.weights >= 0).all()
    corners = pair.source.faces[place.faces]
    assert (corners == found.target_to_source[:, None]).any(axis=1).all()
    true = np.einsum("ti,tij->tj", pair.truth_weights, pair.source.vertices[pair.source.faces[pair.truth_faces]])
    plain = kfmaps.match(*shapes, replace(CONFIG, registration=None), landmarks=landmark_vertices)
    errors = [
        np.linalg.norm(point_positions(p, pair.source) - true, axis=1).mean()
        for p in (place, vertex_point_map(plain.target_to_source, pair.source))
    ]
    assert errors[0] < 0.75 * errors[1]
    target = unit_area(pair.target)
    registered = cast(np.ndarray, found.registration.registered_vertices)
    away = closest_points(registered, target.vertices, target.faces).distances
    assert away.mean() < 2e-3
    spectral = np.linalg.norm(point_positions(plain.precise(), pair.source) - true, axis=1).mean()
    assert errors[0] < spectral < errors[1]


def test_a_whole_body_is_not_registered_onto_something_else(shapes: tuple[kfmaps.Shape, kfmaps.Shape]) -> None:
    other = kfmaps.prepare(datasets.sphere(900, rng=0), CONFIG)
    found, plain = (kfmaps.match(shapes[0], other, c) for c in (CONFIG, replace(CONFIG, registration=None)))
    report = cast(RegistrationReport, found.registration.report)
    assert found.registration.registered_vertices is None
    assert not report.accepted
    assert report.reason in ("gap", "harm")
    assert report.before == pytest.approx(found.local_confidence.mean())
    np.testing.assert_array_equal(found.target_to_source, plain.target_to_source)
    assert len(found.precise().faces) == len(other.mesh.vertices)


def test_a_cloud_and_bad_settings_cannot_be_registered(pair: datasets.ExamplePair) -> None:
    with pytest.raises(InvalidInput, match="point cloud"):
        NonRigid()(cloud_of(pair.source), pair.target, pair.truth)
    for make in (lambda: NonRigid(stiffness=0.0), lambda: NonRigid(n_levels=0), lambda: NonRigid(steps=0)):
        with pytest.raises(InvalidInput):
            make()


def test_a_component_that_nothing_is_mapped_to_goes_with_what_is_beside_it(pair: datasets.ExamplePair) -> None:
    """A lost finger of a coarse copy, an eye: it once made the fit fail, and a right map count as the worst."""
    body, eye = unit_area(pair.source), datasets.sphere(100, rng=0)
    n, moved = len(body.vertices), shifted(body, 3.0, 0.0, 0.0)
    found = NonRigid()(joined(body, Mesh(body.vertices[0] + 0.05 * eye.vertices, eye.faces)), moved, np.arange(n))
    assert np.abs(found.vertices[:n] - moved.vertices).max() < 0.01
    assert np.linalg.norm(found.vertices[n:].mean(axis=0) - moved.vertices[0]) < 0.2


def test_an_obtuse_corner_takes_one_half_from_an_edge_at_most():
    """Cotangents are limited to −1: the edge between corners of cotangents −3 and 3 has (−1 + 3) / 2."""
    height = {-3.0: np.sqrt(10.0) - 3.0, 3.0: np.sqrt(10.0) + 3.0}  # over the middle of an edge of length 2
    vertices = np.array([[-1.0, 0, 0], [1.0, 0, 0], [0, height[-3.0], 0], [0, -height[3.0], 0]])
    energy = build_arap(Mesh(vertices, np.array([[0, 1, 2], [1, 0, 3]])))
    assert energy.laplacian[0, 1] == pytest.approx(-1.0)


def test_a_vertex_of_faces_without_area_is_held_by_its_neighbours():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0.3, 1, 0], [0.5, 0, 0]])
    energy = build_arap(Mesh(vertices, np.array([[0, 1, 2], [1, 0, 3]])))
    assert energy.laplacian.diagonal()[3] > 0
    solved = energy.factorize(1.0, np.array([1.0, 1.0, 1.0, 0.0]))(np.ones((4, 1)))
    assert np.isfinite(solved).all()
