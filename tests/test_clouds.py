"""Point clouds speak the same units as surfaces, are one piece, and do not mind points given twice."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree
from scipy.spatial import KDTree
from scipy.spatial.distance import cdist

from conftest import NO_FACES, blob, cloud_of
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.config import BasisConfig, Config
from kfmaps.fmap.confidence import local_confidence
from kfmaps.fmap.convert import to_functional
from kfmaps.fmap.evaluate import coverage, geodesic_errors
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area, vertex_areas
from kfmaps.geometry.point_cloud import _NEIGHBOURS, cloud_edges
from kfmaps.matching.quality import map_quality, sample_for_scoring
from kfmaps.shape import prepare

GUARDS = ("kfmaps.geometry.basis", "kfmaps.geometry.geodesics", "kfmaps.geometry.point_cloud")

SMALL = replace(Config.single_fit(), basis=BasisConfig(n_eigenfunctions=30), refinement=ZoomOut(10, 40, 10))
LINE = np.stack([np.linspace(0, 1, 300)] * 3, axis=1)


def doubled(mesh: Mesh) -> Mesh:
    return Mesh(np.concatenate([mesh.vertices, mesh.vertices[::2]]), NO_FACES)


def clusters() -> np.ndarray:
    """Points of three blobs so far apart that the neighbours of each lie all in its own."""
    small = 0.2 * blob(60).vertices
    return np.concatenate([blob(300).vertices, small + np.array([0.0, 4, 0]), small + np.array([0.0, 5, 0.3])])


def test_areas_are_those_of_the_surface() -> None:
    mesh = blob(1500)
    assert surface_area(cloud_of(mesh)) == pytest.approx(surface_area(mesh), rel=0.02)
    assert np.median(vertex_areas(cloud_of(mesh)) / vertex_areas(mesh)) == pytest.approx(1, rel=0.05)
    scaled = unit_area(Mesh(30 * mesh.vertices + 4, NO_FACES))
    assert surface_area(scaled) == pytest.approx(1, rel=1e-3)  # triangulated again
    one, other = np.linalg.norm(scaled.vertices, axis=1), np.linalg.norm(unit_area(mesh).vertices, axis=1)
    np.testing.assert_allclose(one, other, rtol=0.02)


@pytest.mark.filterwarnings("ignore::kfmaps.KfmapsWarning")
def test_a_surface_and_its_own_cloud_are_alike() -> None:
    mesh = blob(900)
    surface, cloud = prepare(mesh, SMALL), prepare(cloud_of(mesh), SMALL)
    truth = np.arange(900)
    for source, target in ((surface, cloud), (cloud, surface)):
        C = to_functional(truth, source.basis.truncate(30), target.basis.truncate(30))
        quality = map_quality(C, sample_for_scoring(source), sample_for_scoring(target))
        assert quality.score > -1.2
        assert quality.local_distortion < 0.15
        assert quality.orientation == 0.0
        assert np.median(local_confidence(source.mesh, target.mesh, truth)) > 0.88


def test_points_given_twice_change_nothing() -> None:
    cloud = cloud_of(blob(400))
    twice = doubled(cloud)
    copy = np.r_[:400, :400:2]
    one, other = laplace_basis(cloud, 15), laplace_basis(twice, 15)
    np.testing.assert_array_equal(other.eigenvalues, one.eigenvalues)
    np.testing.assert_array_equal(other.functions, one.functions[copy])
    np.testing.assert_array_equal(other.mass, np.r_[one.mass, np.zeros(200)])
    np.testing.assert_array_equal(vertex_areas(twice), np.r_[vertex_areas(cloud), np.zeros(200)])
    np.testing.assert_array_equal(geodesic_distances(twice, [3, 401]), geodesic_distances(cloud, [3, 2])[:, copy])
    with pytest.warns(KfmapsWarning, match="200 points in one place count as one"):
        shape = prepare(twice, SMALL)
    np.testing.assert_array_equal(shape.mesh.vertices[:400], unit_area(cloud).vertices)
    np.testing.assert_array_equal(shape.mesh.vertices[400:], shape.mesh.vertices[:400:2])


@pytest.mark.parametrize("points", [LINE, LINE[:3], np.zeros((300, 3))])
def test_points_on_no_surface_are_refused(points: np.ndarray) -> None:
    cloud = Mesh(points, NO_FACES)
    for use in (lambda: laplace_basis(cloud, 2), lambda: unit_area(cloud), lambda: prepare(cloud, SMALL)):
        with pytest.raises(InvalidInput, match=r"points spread over a surface|fewer eigenfunctions"):
            use()


def test_neighbours_are_linked_and_the_pieces_joined_by_the_shortest_tree() -> None:
    points = clusters()
    a, b, length = cloud_edges(points)
    np.testing.assert_allclose(length, np.linalg.norm(points[a] - points[b], axis=1), rtol=1e-12)
    near = _NEIGHBOURS + 1
    bridges = sorted(length[len(points) * near :])
    piece = np.repeat([0, 1, 2], [300, 60, 60])
    gaps = [[cdist(points[piece == i], points[piece == j]).min() for j in range(3)] for i in range(3)]
    np.testing.assert_allclose(bridges, sorted(minimum_spanning_tree(np.triu(gaps)).data), rtol=1e-12)
    expected = KDTree(points).query(points, k=near)[0]
    np.testing.assert_array_equal(length[: len(points) * near].reshape(-1, near), expected)


def test_a_flat_cloud_in_pieces_is_joined_too() -> None:
    rng = np.random.default_rng(0)
    flat = np.concatenate(
        [rng.random((40, 2)), rng.random((40, 2)) + np.array([5, 0]), rng.random((40, 2)) + np.array([0, 9])]
    )
    graph = geodesic_graph(Mesh(np.column_stack([flat, np.zeros(120)]), NO_FACES))
    assert connected_components(graph, directed=False)[0] == 1


def test_errors_and_coverage_are_numbers() -> None:
    cloud = Mesh(clusters(), NO_FACES)
    n = len(cloud.vertices)
    errors = geodesic_errors(cloud, np.arange(n)[::-1], np.arange(n))
    assert np.isfinite(errors).all()
    assert coverage(np.arange(n), cloud) == pytest.approx(1)
    half = np.where(np.arange(n) < 300, np.arange(n), 0)
    assert coverage(half, cloud) == pytest.approx(vertex_areas(cloud)[:300].sum() / surface_area(cloud))
    mesh = blob(500)
    moved = np.roll(np.arange(500), 7)
    one, other = geodesic_errors(mesh, moved, np.arange(500)), geodesic_errors(cloud_of(mesh), moved, np.arange(500))
    np.testing.assert_allclose(other, one, rtol=0.25)
    assert other.mean() == pytest.approx(one.mean(), rel=0.06)
