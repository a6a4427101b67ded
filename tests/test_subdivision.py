"""Subdivision, and matches of meshes with few vertices, which are divided for the search."""

from dataclasses import replace

import igl
import numpy as np
import pytest
from scipy.spatial import KDTree

import kfmaps
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.config import Config
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.clean import clean_mesh, divide_mesh, face_outward, flatten_spikes, smooth_noise
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area
from kfmaps.geometry.subdivision import (
    interpolating_subdivision,
    is_polyhedral,
    loop_matrix,
    split_long_edges,
)
from kfmaps.geometry.topology import topology
from kfmaps.matching.match import match
from kfmaps.matching.search import scoring_samples
from kfmaps.shape import MIN_SEARCH_VERTICES, lower_to_size, prepare

GUARDS = ("kfmaps.geometry.subdivision", "kfmaps.geometry.clean", "kfmaps.matching.reindexing")


def hexagons(size: int = 5) -> Mesh:
    """A flat piece of the regular triangulation."""
    i, j = (one.ravel() for one in np.meshgrid(np.arange(size), np.arange(size), indexing="ij"))
    at = np.arange(size * size).reshape(size, size)
    a, b, c, d = (one.ravel() for one in (at[:-1, :-1], at[1:, :-1], at[:-1, 1:], at[1:, 1:]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])
    return Mesh(np.stack([i + 0.5 * j, np.sqrt(0.75) * j, 0.0 * i], axis=1), faces)


def test_weights_are_those_of_loop() -> None:
    mesh = hexagons()
    matrix, faces = loop_matrix(mesh.faces, 25)
    rows = matrix.toarray()
    np.testing.assert_allclose(rows.sum(axis=1), 1.0, atol=1e-15)
    assert faces.shape == (4 * len(mesh.faces), 3)
    inner = rows[12]  # the middle of the grid, of degree 6
    assert inner[12] == pytest.approx(10 / 16)
    np.testing.assert_allclose(np.sort(inner[inner > 0])[:-1], [1 / 16] * 6)
    rim = rows[2]  # on the straight boundary
    np.testing.assert_allclose(rim[[0, 1, 2, 3, 7]], [0, 1 / 8, 3 / 4, 1 / 8, 0])
    counts = np.unique(np.round(np.sort(rows[25:], axis=1)[:, -4:], 6), axis=0)
    np.testing.assert_allclose(counts, [[0, 0, 0.5, 0.5], [0.125, 0.125, 0.375, 0.375]])
    triangle = loop_matrix(np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]), 4)[0].toarray()
    np.testing.assert_allclose(triangle[0], [7 / 16, 3 / 16, 3 / 16, 3 / 16])  # of degree 3


def test_new_vertices_lie_on_a_smooth_surface_through_the_others() -> None:
    sphere = kfmaps.datasets.sphere(300)
    finer = interpolating_subdivision(sphere)
    np.testing.assert_array_equal(finer.vertices[:300], sphere.vertices)
    radii = np.linalg.norm(finer.vertices[300:], axis=1)
    assert np.abs(radii - 1).max() < 0.01
    flat = interpolating_subdivision(hexagons())
    np.testing.assert_allclose(flat.vertices[:, 2], 0.0, atol=1e-15)


@pytest.mark.parametrize("inward", [False, True])
def test_a_divided_mesh_knows_where_its_faces_come_from(inward: bool) -> None:
    body = kfmaps.datasets.sphere(120)
    given = Mesh(body.vertices, body.faces[:, ::-1]) if inward else body
    part = face_outward(clean_mesh(given, specks=True))
    assert (part.turned is not None) == inward
    divided = divide_mesh(part, 1000)
    assert len(divided.mesh.vertices) >= 1000
    assert not divided.whole
    assert divided.corners is not None
    assert len(divided.corners) == len(divided.mesh.faces) == 16 * len(body.faces)
    np.testing.assert_array_equal(divided.to_original[:120], np.arange(120))
    # Corners of pieces that are corners of the face itself are at its vertices; all others lie near its plane.
    corners = part.mesh.vertices[part.mesh.faces[divided.faces_to_original]]
    flat = np.einsum("fij,fjk->fik", divided.corners, corners)
    pieces = divided.mesh.vertices[divided.mesh.faces]
    distances = np.linalg.norm(pieces - flat, axis=2)
    old = divided.mesh.faces < 120
    np.testing.assert_allclose(distances[old], 0.0, atol=1e-12)
    assert distances.max() < 0.1
    np.testing.assert_allclose(divided.corners.sum(axis=2), 1.0)
    # The nearest corner is at least as near along the face as the other two.
    positions, numbers = divided.corners.reshape(-1, 3), divided.to_original[divided.mesh.faces].ravel()
    own = part.mesh.faces[divided.faces_to_original].repeat(3, axis=0)
    weights = np.where(own == numbers[:, None], positions, 0).max(axis=1)
    on_face = (own == numbers[:, None]).any(axis=1)
    np.testing.assert_allclose(weights[on_face], positions.max(axis=1)[on_face])


def prism(n: int, turn: float = 0.0) -> Mesh:
    """A solid as CAD programs triangulate it: a plate with a round corner of ``n`` edges and two others cut off."""
    angles = np.linspace(0.0, np.pi / 2, n + 1)
    corner = np.stack([2.0 + np.cos(angles), 1.0 + np.sin(angles)], axis=1)
    outline = np.concatenate([[[0.0, 0.4], [0.5, 0.0], [3.0, 0.0]], corner, [[0.0, 2.0]]])
    n = len(outline)
    each, fan = np.arange(n), np.arange(1, n - 1)
    following = (each + 1) % n
    bottom = np.stack([0 * fan, fan + 1, fan], axis=1)
    sides = [np.stack([each, following, n + following], axis=1), np.stack([each, n + following, n + each], axis=1)]
    vertices = np.concatenate([np.pad(outline, ((0, 0), (0, 1)), constant_values=z) for z in (0.0, 0.5)])
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    return Mesh(vertices @ rotation, np.concatenate([bottom, n + bottom[:, ::-1], *sides]))


def test_long_edges_are_cut_until_there_is_none() -> None:
    solid = prism(12)
    divided, face_of, corners = split_long_edges(solid, 0.3)
    edges = divided.vertices[divided.faces] - divided.vertices[np.roll(divided.faces, 1, axis=1)]
    assert 0.25 < np.linalg.norm(edges, axis=2).max() <= 0.3
    np.testing.assert_array_equal(divided.vertices[: len(solid.vertices)], solid.vertices)
    there = np.einsum("fij,fjk->fik", corners, solid.vertices[solid.faces[face_of]])
    np.testing.assert_allclose(divided.vertices[divided.faces], there, atol=1e-12)
    assert surface_area(divided) == pytest.approx(surface_area(solid), rel=1e-12)
    counts = topology(divided)
    assert (counts.boundary_edges, counts.inconsistent_edges, counts.degenerate_faces) == (0, 0, 0)
    assert (counts.components, counts.euler_characteristic) == (1, 2)
    # Of a face with two long edges what is left is cut along the shorter diagonal.
    for x, diagonal in ((0.0, {0, 4}), (1.0, {2, 3})):
        one = Mesh(np.array([[0.0, 0, 0], [x, 2, 0], [1.0, 0, 0]]), np.array([[0, 1, 2]]))
        faces = split_long_edges(one, 1.9)[0].faces
        assert len(faces) == 3
        assert sum(diagonal <= set(face) for face in faces.tolist()) == 2
    # One long edge, whichever it is, and three.
    for turn in range(3):
        one = Mesh(np.array([[0.0, 0, 0], [2, 0, 0], [1, 0.5, 0]]), np.roll([[0, 1, 2]], turn))
        assert [set(face) for face in split_long_edges(one, 1.9)[0].faces.tolist()] == [{0, 3, 2}, {3, 1, 2}]
    assert len(split_long_edges(one, 1.05)[0].faces) == 4


def test_solids_need_few_vertices() -> None:
    solid, config = prism(3), replace(Config(), threads=1)  # 16 vertices
    split = Mesh(solid.vertices[solid.faces].reshape(-1, 3), np.arange(solid.faces.size).reshape(-1, 3))
    few = pytest.warns(KfmapsWarning, match="a mesh has 16 vertices: the map has 10 eigenfunctions")
    with few, pytest.warns(KfmapsWarning, match="68 vertices on seams"):
        found = kfmaps.match(solid, split, config)
    assert found.verdict != "unlikely"
    np.testing.assert_array_equal(found.target_to_source, solid.faces.ravel())
    wedge = Mesh(
        solid.vertices[[0, 2, 4, 8, 10, 12]], np.array([[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5]])
    )
    wedge = Mesh(wedge.vertices, np.concatenate([wedge.faces, [[1, 5, 4], [2, 0, 3], [2, 3, 5]]]))
    with pytest.raises(InvalidInput, match="expected more than 100 vertices"):
        kfmaps.match(wedge, wedge, config)


def test_solids_are_told_from_creatures_and_remeshed_bodies() -> None:
    fine, opened = split_long_edges(prism(12), 0.2)[0], Mesh(prism(12).vertices, prism(12).faces[2:])

    def beside(one: Mesh) -> Mesh:
        return Mesh(np.concatenate([one.vertices, one.vertices + 5]), np.concatenate([one.faces, one.faces + 34]))

    for mesh, expected in (
        (prism(12), True),
        (fine, False),
        (kfmaps.datasets.sphere(120), False),  # faces as long
        (kfmaps.datasets.torus(1200), False),
        (opened, True),
        (beside(prism(12)), True),
        (beside(opened), False),
    ):
        assert is_polyhedral(mesh) == is_polyhedral(Mesh(7 * mesh.vertices, mesh.faces)) == expected


def test_long_faces_of_solids_stay_where_they_are() -> None:
    # Few vertices or many; edges are longer where there would be more than 6,000, up to 0.18.
    for n, longest, counts in ((12, 0.05, (2000, 2500)), (200, 0.15, (5000, 6000)), (500, 0.18, (6000, 12_000))):
        part = clean_mesh(unit_area(prism(n)))
        divided = divide_mesh(part, 1000)
        assert divided.corners is not None
        assert counts[0] <= len(divided.mesh.vertices) <= counts[1]
        assert surface_area(divided.mesh) == pytest.approx(1.0)
        corners = divided.mesh.vertices[divided.mesh.faces]
        assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max() <= longest
    assert len(part.mesh.vertices) > 1000
    sphere = clean_mesh(unit_area(kfmaps.datasets.sphere(120)))
    assert surface_area(divide_mesh(sphere, 1000).mesh) > 1.02  # bulges
    assert divide_mesh(sphere, 100) is sphere
    fine = clean_mesh(kfmaps.datasets.torus(1200))
    assert divide_mesh(fine, 1000) is fine


def test_triangulations_of_a_solid_are_matched() -> None:
    source, target = prism(50), prism(64, turn=2.0)
    found = kfmaps.match(source, target, replace(Config(), threads=1))
    assert found.verdict == "sure"
    true = igl.point_mesh_squared_distance(prism(64).vertices, source.vertices, source.faces)[2]
    places = found.precise()
    points = np.einsum("ni,nij->nj", places.weights, source.vertices[source.faces[places.faces]])
    away = np.linalg.norm(points - true, axis=1) / np.sqrt(surface_area(source))
    assert 100 * away.mean() < 2.0


def test_edges_and_corners_of_solids_are_neither_noise_nor_spikes(recwarn) -> None:
    plate = prism(700)
    n = len(plate.vertices)
    tip = np.array([[0.0, 4, 0], [1, 4, 0], [0, 5, 0], [0, 4, 5]])
    faces = n + np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    solid = Mesh(np.concatenate([plate.vertices, tip]), np.concatenate([plate.faces, faces]))
    assert smooth_noise(solid) is not None
    assert flatten_spikes(solid)[1] == 1
    shape = prepare(solid)
    assert len(recwarn) == 0
    np.testing.assert_allclose(shape.mesh.vertices, unit_area(solid).vertices)


def simplified_pair(n_faces: int) -> tuple[Mesh, Mesh, np.ndarray]:
    pair = kfmaps.datasets.two_poses(1500)

    def simplified(mesh: Mesh) -> Mesh:
        vertices, faces = map(np.asarray, igl.decimate(mesh.vertices, mesh.faces, n_faces)[:2])
        return Mesh(vertices, faces.astype(np.int64))

    source, target = simplified(pair.source), simplified(pair.target)
    nearest = KDTree(pair.target.vertices).query(target.vertices)[1]
    truth = KDTree(source.vertices).query(pair.source.vertices[pair.truth[nearest]])[1]
    return source, target, np.asarray(truth)


@pytest.fixture(scope="module")
def coarse() -> tuple[Mesh, Mesh, np.ndarray]:
    """One body in two poses with 152 vertices each, meshed independently, and the true map."""
    return simplified_pair(300)


def test_meshes_of_few_vertices_are_matched_as_finer_ones(coarse) -> None:
    source, target, truth = coarse
    config = replace(Config(), threads=1)
    found = kfmaps.match(source, target, config)
    assert found.verdict == "sure"
    assert found.target_to_source.shape == truth.shape
    assert 100 * kfmaps.geodesic_errors(source, found.target_to_source, truth).mean() < 4
    # All fields are those of the given meshes.
    bases = found.basis_source, found.basis_target
    np.testing.assert_allclose(found.functional_map, kfmaps.to_functional(found.target_to_source, *bases), atol=1e-12)
    places = found.precise()
    assert places.faces.max() < len(source.faces)
    points = np.einsum("ni,nij->nj", places.weights, source.vertices[source.faces[places.faces]])
    nearest = np.linalg.norm(points - source.vertices[found.target_to_source], axis=1)
    np.testing.assert_allclose(nearest, KDTree(source.vertices).query(points)[0], rtol=0.5)
    registered = found.registration.registered_vertices
    assert registered is not None
    assert registered.shape == source.vertices.shape
    assert found.local_confidence.shape == (len(target.vertices),)
    assert sum(found.energies().values()) < sum(found.energies(-found.functional_map).values())
    shapes = prepare(source, config), prepare(target, config)
    samples = scoring_samples(shapes[0], 0), scoring_samples(shapes[1], 0)
    again = match(*shapes, config, shape_samples=samples)
    np.testing.assert_array_equal(again.target_to_source, found.target_to_source)
    assert again.confidence == found.confidence


def test_only_a_search_divides_meshes_and_only_small_surfaces(coarse) -> None:
    source, _, _ = coarse
    shape = prepare(source)
    divided, record = shape.divided
    assert len(divided.mesh.vertices) >= MIN_SEARCH_VERTICES > len(shape.mesh.vertices)
    assert record.corners is not None
    assert divided.shot is not None
    assert len(divided.basis.functions) == len(divided.shot) == len(divided.mesh.vertices)
    assert surface_area(divided.mesh) == pytest.approx(1.0)
    torus = kfmaps.datasets.torus(500)
    fitted = kfmaps.match(torus, torus, Config.single_fit())
    assert fitted._reindexing is not None
    assert fitted._reindexing.is_identity
    large = prepare(kfmaps.datasets.torus(1200))
    assert large.divided[0] is large


def test_meshes_of_fewer_vertices_than_functions_are_matched_with_fewer_functions() -> None:
    source, target, truth = simplified_pair(170)
    config = replace(Config(), threads=1)
    with pytest.warns(
        KfmapsWarning, match=f"a mesh has {len(target.vertices)} vertices: the map has 58 eigenfunctions"
    ):
        found = kfmaps.match(source, target, config)
    assert 100 * kfmaps.geodesic_errors(source, found.target_to_source, truth).mean() < 8
    assert found.functional_map.shape == (58, 58)
    assert found.config.n_eigenfunctions == 58
    assert np.isfinite(list(found.energies().values())).all()


def test_fewer_functions_are_used_only_where_a_search_divides_a_mesh() -> None:
    config, large = Config(), kfmaps.datasets.torus(1200)
    assert config.n_eigenfunctions == 100
    small = Mesh(*map(np.asarray, igl.decimate(large.vertices, large.faces, 160)[:2]))
    tiny = Mesh(*map(np.asarray, igl.decimate(large.vertices, large.faces, 110)[:2]))
    assert len(small.vertices) == 80
    assert len(tiny.vertices) == 55
    with pytest.warns(KfmapsWarning, match="a mesh has 80 vertices: the map has 53 eigenfunctions"):
        lower = lower_to_size(config, large, small)
    assert (lower.basis.n_eigenfunctions, lower.descriptors.n_eigenfunctions) == (53, 53)
    refinement = lower.refinement
    assert isinstance(refinement, ZoomOut)
    assert (refinement.start, refinement.stop) == (50, 53)
    seam = Mesh(np.concatenate([small.vertices, small.vertices[:40]]), small.faces)  # 120 vertices, of which 80 count
    with pytest.warns(KfmapsWarning, match="a mesh has 80 vertices"):
        assert lower_to_size(config, seam, large).n_eigenfunctions == 53
    few = replace(config, basis=replace(config.basis, n_eigenfunctions=20))
    few = replace(few, descriptors=replace(few.descriptors, n_eigenfunctions=30), refinement=None)
    cloud = Mesh(small.vertices, np.zeros((0, 3), dtype=np.int64))
    cases = (config, large), (config, tiny), (config, cloud), (config, prepare(large)), (few, small)
    for one, mesh in (*cases, (replace(config, search=None), small)):
        assert lower_to_size(one, mesh, large) is one
    broken = Mesh(small.vertices, np.where(small.faces == 7, 900, small.faces))
    refused = pytest.raises(InvalidInput, match="expected vertex numbers from 0 to 79, got 900")
    with pytest.warns(KfmapsWarning, match="eigenfunctions"), refused:
        kfmaps.match(broken, large)
    with pytest.raises(InvalidInput, match="expected more than 100 vertices"):
        kfmaps.match(tiny, tiny)
