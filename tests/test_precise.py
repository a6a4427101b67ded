"""Points inside triangles: the exact search, records, and numbers inside and outside a match."""

from dataclasses import replace

import numpy as np
import pytest

import kfmaps
from kfmaps import datasets
from kfmaps._arrays import InvalidInput
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
from kfmaps.geometry.mesh import Mesh

GUARDS = ("kfmaps.fmap.precise", "kfmaps.geometry.clean", "kfmaps.geometry.closest_points")


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
    """The same places, whether the source's triangles hang together or not."""
    pair = datasets.two_poses(1500, rng=1)
    soup = Mesh(pair.source.vertices[pair.source.faces.ravel()], np.arange(3 * len(pair.source.faces)).reshape(-1, 3))
    config = replace(kfmaps.Config.single_fit(), threads=1, registration=None)
    one = kfmaps.match(pair.source, pair.target, config).precise()
    with pytest.warns(kfmaps.KfmapsWarning, match="seams"):
        many = kfmaps.match(soup, pair.target, config).precise()
    check_point_map_precise(many, soup, len(pair.target.vertices))
    near = np.linalg.norm(point_positions(one, pair.source) - point_positions(many, soup), axis=1)
    assert np.median(near) < 1e-3
