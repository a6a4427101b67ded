"""Points inside triangles: the exact search, records, numbers inside and outside a match, distances and errors."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import Delaunay, KDTree

import kfmaps
from conftest import blob, fibonacci_sphere
from kfmaps import datasets
from kfmaps._arrays import InvalidInput
from kfmaps.fmap.evaluate import geodesic_errors, precise_errors, reverses_orientation, smoothness
from kfmaps.fmap.precise import (
    PointMap,
    check_point_map_precise,
    nearest_surface_points,
    nearest_vertices,
    point_positions,
    vertex_point_map,
)
from kfmaps.geometry.clean import clean_mesh
from kfmaps.geometry.closest_points import barycentric_matrix, closest_weights
from kfmaps.geometry.geodesics import geodesic_distance_pairs
from kfmaps.geometry.mesh import Mesh, mirror_mesh, surface_area
from kfmaps.geometry.surface_points import surface_point_distances

GUARDS = ("kfmaps.fmap.evaluate", "kfmaps.fmap.precise", "kfmaps.geometry")


def brute(queries: np.ndarray, points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Squared distance of each query from the closest triangle, each asked for itself."""
    a = points[faces[:, 0]]
    u, v = points[faces[:, 1]] - a, points[faces[:, 2]] - a
    found = []
    for q in queries:
        r = q - a
        dots = [(x * y).sum(axis=1) for x, y in ((u, u), (u, v), (v, v), (r, u), (r, v))]
        found.append(((r * r).sum(axis=1) - closest_weights(*dots)[2]).min())
    return np.array(found)


def squared(places: PointMap, queries: np.ndarray, points: np.ndarray, faces: np.ndarray) -> np.ndarray:
    return ((np.einsum("qi,qij->qj", places.weights, points[faces[places.faces]]) - queries) ** 2).sum(axis=1)


@pytest.mark.parametrize("dimension", [3, 40])
@pytest.mark.parametrize("scale", [1.0, 1e-6])
def test_the_search_is_exact(dimension: int, scale: float) -> None:
    """Large random triangles, so that the closest is often none of those around the nearest vertex."""
    rng = np.random.default_rng(dimension)
    points, queries = scale * rng.normal(size=(150, dimension)), scale * rng.normal(size=(300, dimension))
    faces = np.stack([rng.permutation(150)[:3] for _ in range(400)])
    found = nearest_surface_points(queries, points, faces)
    np.testing.assert_allclose(
        squared(found, queries, points, faces), brute(queries, points, faces), atol=1e-9 * scale**2
    )
    plain = ((queries[:, None] - points[None]) ** 2).sum(axis=2).argmin(axis=1)
    around = (faces[found.faces] == plain[:, None]).any(axis=1)
    assert 0.05 < around.mean() < 0.95


def test_around_nearest_vertices_of_a_smooth_surface_it_is_the_same() -> None:
    mesh = datasets.sphere(800, rng=0)
    queries = 1.02 * datasets.sphere(500, rng=1).vertices
    whole = nearest_surface_points(queries, mesh.vertices, mesh.faces)
    near = nearest_surface_points(queries, mesh.vertices, mesh.faces, exact=False)
    distances = [squared(p, queries, mesh.vertices, mesh.faces) for p in (whole, near)]
    np.testing.assert_allclose(distances[0], distances[1], rtol=1e-9, atol=1e-12)


def test_vertices_that_no_face_uses_attract_nothing() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]])
    found = nearest_surface_points(np.array([[5.0, 5, 5]]), points, np.array([[0, 1, 2]]))
    np.testing.assert_allclose(found.weights[0], [0, 0.5, 0.5], atol=1e-12)


def test_maps_of_vertices_and_of_points_agree() -> None:
    mesh = datasets.sphere(200, rng=0)
    rng = np.random.default_rng(0)
    points = rng.integers(0, len(mesh.vertices), 300)
    places = vertex_point_map(points, mesh)
    np.testing.assert_array_equal(nearest_vertices(places, mesh), points)
    np.testing.assert_allclose(point_positions(places, mesh), mesh.vertices[points])
    inner = PointMap(places.faces, rng.dirichlet(np.ones(3), 300))
    np.testing.assert_allclose(
        barycentric_matrix(inner.faces, inner.weights, mesh.faces, len(mesh.vertices)) @ mesh.vertices,
        point_positions(inner, mesh),
        atol=1e-12,
    )
    corner = mesh.vertices[mesh.faces[inner.faces]]
    nearest = np.linalg.norm(corner - point_positions(inner, mesh)[:, None], axis=2).min(axis=1)
    chosen = np.linalg.norm(mesh.vertices[nearest_vertices(inner, mesh)] - point_positions(inner, mesh), axis=1)
    np.testing.assert_allclose(chosen, nearest)


def test_broken_maps_are_refused() -> None:
    mesh = datasets.sphere(100, rng=0)
    good = vertex_point_map(np.arange(len(mesh.vertices)), mesh)
    check_point_map_precise(good, mesh, len(mesh.vertices))
    for faces, weights in (
        (good.faces + len(mesh.faces), good.weights),
        (good.faces.astype(float), good.weights),
        (good.faces, good.weights * 0.5),
        (good.faces, good.weights * 2 - np.eye(3)[0]),
        (good.faces[1:], good.weights),
    ):
        with pytest.raises(InvalidInput):
            check_point_map_precise(PointMap(faces, weights), mesh)
    with pytest.raises(InvalidInput, match="no face uses"):
        vertex_point_map(np.array([100]), Mesh(np.vstack([mesh.vertices, [[9.0, 9, 9]]]), mesh.faces))


def test_faces_inside_are_found_outside() -> None:
    """Of a mesh whose triangles each have their own vertices, with a speck and a face without area."""
    whole = datasets.sphere(300, rng=0)
    soup = whole.vertices[whole.faces.ravel()]
    faces = np.arange(len(soup)).reshape(-1, 3)
    speck = np.array([[9.0, 0, 0], [9.01, 0, 0], [9, 0.01, 0]])
    mesh = Mesh(np.vstack([speck, soup]), np.vstack([[[0, 1, 2], [3, 3, 4]], faces + 3]))
    part = clean_mesh(mesh, specks=True)
    assert len(part.mesh.vertices) < len(mesh.vertices) / 3
    outer = mesh.faces[part.faces_to_original]
    np.testing.assert_array_equal(mesh.vertices[outer], part.mesh.vertices[part.mesh.faces])


def test_a_match_of_cut_meshes_has_places_outside() -> None:
    source, target = blob(600), blob(500, twist=0.4)
    soup = Mesh(source.vertices[source.faces.ravel()], np.arange(3 * len(source.faces)).reshape(-1, 3))
    config = replace(kfmaps.Config.single_fit(), threads=1, registration=None)
    one = kfmaps.match(source, target, config).precise()
    with pytest.warns(kfmaps.KfmapsWarning, match="seams"):
        many = kfmaps.match(soup, target, config).precise()
    check_point_map_precise(many, soup, len(target.vertices))
    near = np.linalg.norm(point_positions(one, source) - point_positions(many, soup), axis=1)
    assert np.median(near) < 1e-3


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


def test_in_a_plane_near_points_are_as_far_as_a_ruler_says_and_far_ones_hardly_farther() -> None:
    rng = np.random.default_rng(0)
    mesh = plane(rng)
    a, b = anywhere(mesh, 20_000, rng), anywhere(mesh, 20_000, rng)
    places = [point_positions(p, mesh) for p in (a, b)]
    ruler = np.linalg.norm(places[0] - places[1], axis=1)
    inside = [np.minimum(p[:, :2], 1 - p[:, :2]).min(axis=1) > 0.1 for p in places]
    near, some = np.flatnonzero((ruler < 0.12) & inside[0] & inside[1]), np.arange(150)
    assert len(near) > 200

    def distances(a: PointMap, b: PointMap, rows: np.ndarray) -> np.ndarray:
        return surface_point_distances(mesh, a.faces[rows], a.weights[rows], b.faces[rows], b.weights[rows])

    np.testing.assert_allclose(distances(a, b, near), ruler[near], atol=1e-10)
    found = distances(a, b, some)
    assert (found >= ruler[some] - 1e-12).all()
    assert np.median(found / ruler[some]) < 1.01
    np.testing.assert_allclose(found, distances(b, a, some), rtol=0.01)


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


def test_a_map_to_the_mirror_image_of_a_much_coarser_source_reverses_orientation() -> None:
    fine, coarse = fibonacci_sphere(2000), fibonacci_sphere(100)
    places = [fine.vertices * side for side in ([1, 1, 1], [-1, 1, 1])]
    kept, mirrored = (np.asarray(KDTree(coarse.vertices).query(place)[1]) for place in places)
    assert smoothness(coarse, fine, mirrored).flipped_area < 0.3, "most triangles collapse"
    assert reverses_orientation(coarse, fine, mirrored)
    assert not reverses_orientation(coarse, fine, kept)
