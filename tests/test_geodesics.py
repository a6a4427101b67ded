"""Laws of distances along a surface, and between points: exact near by, hardly longer elsewhere."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import Delaunay, KDTree

from conftest import NO_FACES, blob, cloud_of, fibonacci_sphere, joined, reordered, sheet, shifted
from kfmaps._arrays import InvalidInput
from kfmaps.geometry import geodesics
from kfmaps.geometry.geodesic_graph import MAX_BRIDGED, bridged_graph, geodesic_graph
from kfmaps.geometry.geodesics import (
    _FULL_SEARCHES,
    _NEARBY,
    farthest_geodesic,
    geodesic_distance_pairs,
    geodesic_distances,
    pairwise_geodesics,
)
from kfmaps.geometry.mesh import Mesh, unit_area

GUARDS = ("kfmaps.geometry.geodesic_graph", "kfmaps.geometry.geodesics")


def flat(n: int = 300, seed: int = 0) -> Mesh:
    """A triangulated unit square."""
    points = np.random.default_rng(seed).uniform(size=(n, 2))
    points[:4] = [[0, 0], [1, 0], [0, 1], [1, 1]]
    return Mesh(np.column_stack([points, np.zeros(n)]), Delaunay(points).simplices)


def between(points: np.ndarray) -> np.ndarray:
    return np.linalg.norm(points[:, None] - points, axis=2)


def everywhere(mesh: Mesh) -> np.ndarray:
    return geodesic_distances(mesh, np.arange(len(mesh.vertices)))


def two_pieces() -> Mesh:
    """Two blobs far apart, and a vertex of no face between them."""
    one = blob(120)
    return joined(one, Mesh(np.array([[10.0, 0, 0]]), NO_FACES), shifted(one, 20, 20, 20))


def test_a_plane_is_straight() -> None:
    mesh = flat()
    exact = between(mesh.vertices)
    off = ~np.eye(len(exact), dtype=bool)
    unfolded, edges = everywhere(mesh), dijkstra(geodesic_graph(mesh, 0))
    assert (unfolded - exact).min() > -1e-12  # every path lies on the surface
    assert (edges - unfolded).min() > -1e-12
    assert (unfolded[off] / exact[off]).mean() < 1.006
    assert (edges[off] / exact[off]).mean() > 1.03


def test_deeper_unfolding_gives_exact_distances_farther() -> None:
    mesh = flat(60)
    exact = between(mesh.vertices)
    hits = []
    for depth in (0, 1, 2, 4, 8):
        graph = geodesic_graph(mesh, depth)
        low, high = graph.nonzero()
        np.testing.assert_allclose(graph.toarray()[low, high], exact[low, high], rtol=1e-12)  # lines are straight
        assert abs(graph - graph.T).max() == 0
        hits.append(graph.nnz)
    assert np.all(np.diff(hits) > 0)
    assert geodesic_graph(mesh, 40).nnz == 60 * 59  # in a convex plane everything sees everything


def test_a_fold_is_laid_flat_and_a_line_that_misses_the_edge_is_none() -> None:
    book = np.array([[0, 2, 1], [0, 1, 3]])
    for angle in (0.3, 1.5, 3.0):  # between two right-angled triangles over one edge, from a closed book to flat
        wing = np.array([np.cos(angle), 0, np.sin(angle)])
        mesh = Mesh(np.array([[0, -1, 0], [0, 1, 0], [1, 0.2, 0], wing - [0, 0.3, 0]]), book)
        assert geodesic_distances(mesh, [2])[0, 3] == pytest.approx(np.hypot(2, 0.5))
    mesh = Mesh(np.array([[0, 0, 0], [0, 1, 0], [2, -3, 0], [-2, -3, 0]], dtype=float), book)
    # The straight line from 2 to 3 passes below the edge, outside the surface: the way is by vertex 0.
    assert geodesic_distances(mesh, [2])[0, 3] == pytest.approx(2 * np.hypot(2, 3))


@pytest.mark.parametrize("flip", [False, True])
def test_corners_of_a_cube(flip: bool) -> None:
    corners = np.array(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), dtype=float).reshape(3, -1).T
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = np.array([t for a, b, c, d in quads for t in ([a, b, c], [a, c, d])])
    if flip:
        faces[::3] = faces[::3, ::-1]  # orientation means nothing
    exact = np.array([0, 1, np.sqrt(2), np.sqrt(5)])[np.abs(corners[:, None] - corners).sum(axis=2).astype(int)]
    np.testing.assert_allclose(everywhere(Mesh(corners, faces)), exact, atol=1e-12)


def test_pages_of_a_book() -> None:
    # Three triangles at one edge: each pair of pages is a fold of its own.
    vertices = np.array([[0, -1, 0], [0, 1, 0], [1, 0, 0], [-0.5, 0, 0.8], [0, 0, -2]])
    mesh = Mesh(vertices, np.array([[0, 1, 2], [0, 1, 3], [1, 0, 4]]))
    heights = np.linalg.norm(vertices[2:], axis=1)
    distances = everywhere(mesh)[2:, 2:]
    np.testing.assert_allclose(distances, (heights[:, None] + heights) * (1 - np.eye(3)), atol=1e-12)


def test_metric() -> None:
    distances = everywhere(blob(150))
    np.testing.assert_allclose(distances, distances.T, rtol=1e-12)
    assert (np.diag(distances) == 0).all()
    detour = (distances[:, :, None] + distances[None, :, :]).min(axis=1)
    assert (distances <= detour + 1e-12).all()
    assert (distances >= between(blob(150).vertices) - 1e-12).all()


def test_scale_and_order_of_vertices() -> None:
    mesh, order = blob(200), np.random.default_rng(5).permutation(200)
    other = reordered(Mesh(5 * mesh.vertices, mesh.faces), order)
    one = geodesic_distances(mesh, order[:10])
    np.testing.assert_allclose(geodesic_distances(other, np.arange(10)) / 5, one[:, order], rtol=1e-6)


def test_between_components_there_is_no_way() -> None:
    mesh = two_pieces()
    distances = geodesic_distances(mesh, [0, 120, 121])
    piece = np.repeat([0, 1, 2], [120, 1, 120])
    np.testing.assert_array_equal(np.isfinite(distances), piece == np.array([[0], [1], [2]]))
    assert (distances[:, [0, 120, 121]].diagonal() == 0).all()
    alone = geodesic_distances(blob(120), [0])[0]
    np.testing.assert_allclose(distances[0, :120], alone, rtol=1e-6)


def test_bridges_join_pieces_where_they_touch() -> None:
    """Two spheres that touch, and one that lies apart, to which no way leads."""
    ball = fibonacci_sphere(300)
    mesh = joined(ball, shifted(ball, 2.02, 0, 0), shifted(ball, 0, 3, 0))
    graph, before = bridged_graph(mesh), geodesic_graph(mesh, 1)
    extra = (graph - before).tocoo()
    a, b = extra.coords
    assert set(zip((a // 300).tolist(), (b // 300).tolist(), strict=True)) == {(0, 1), (1, 0)}
    assert len(extra.data) > 10
    np.testing.assert_allclose(extra.data, np.linalg.norm(mesh.vertices[a] - mesh.vertices[b], axis=1))
    i, j = mesh.faces[:, 0], mesh.faces[:, 1]
    assert extra.data.max() < 1.2 * np.linalg.norm(mesh.vertices[i] - mesh.vertices[j], axis=1).mean()
    nearest = KDTree(mesh.vertices[:300]).query(mesh.vertices[300:600])[0]
    np.testing.assert_allclose(np.sort(extra.data[a >= 300]), np.sort(nearest[nearest < extra.data.max() + 1e-9]))
    np.testing.assert_array_equal(np.isfinite(dijkstra(graph, indices=[0])[0]), np.arange(900) < 600)


def test_one_piece_a_cloud_and_very_many_pieces_have_no_bridges() -> None:
    many = joined(*(shifted(blob(20), 4.0 * i, 0, 0) for i in range(MAX_BRIDGED + 1)))
    for mesh in (blob(200), cloud_of(blob(200)), many):
        assert abs(bridged_graph(mesh) - geodesic_graph(mesh, 1)).sum() == 0


def test_faces_without_area() -> None:
    mesh = flat(80)
    a, b, c = mesh.faces[0]
    twin = mesh.vertices[[a]]  # a second vertex in the same place
    faces = np.concatenate([mesh.faces, [[a, a, b], [c, c, c], [a, 80, b]]])
    distances = geodesic_distances(Mesh(np.concatenate([mesh.vertices, twin]), faces), [int(c)])[0]
    assert np.isfinite(distances).all()
    assert distances[80] == pytest.approx(distances[a], abs=0.02)


def test_pairs_are_entries_of_the_matrix() -> None:
    mesh = two_pieces()
    rng = np.random.default_rng(0)
    n = len(mesh.vertices)
    a, b = rng.integers(0, n, 400), rng.integers(0, n, 400)
    near = np.argsort(((mesh.vertices[a][:, None] - mesh.vertices) ** 2).sum(axis=2))
    b[:200] = near[np.arange(200), rng.integers(0, 8, 200)]
    pairs = geodesic_distance_pairs(mesh, a, b)
    np.testing.assert_array_equal(pairs, geodesic_distances(mesh, a)[np.arange(400), b])
    assert np.isinf(pairs).any()
    assert (pairs == 0).any()
    assert geodesic_distance_pairs(mesh, [], []).shape == (0,)


def test_far_pairs_are_found_too() -> None:
    # A hairpin: near in space, far along the surface, so that the first searches fall short.
    length, width = 40, 4
    flat = sheet(np.linspace(0, np.pi, length), np.arange(width))
    turn, y, _ = flat.vertices.T
    mesh = Mesh(np.stack([0.01 * np.cos(turn), 20 * np.sin(turn), y], axis=1), flat.faces)
    a, b = np.arange(width), np.arange(width)[::-1] + (length - 1) * width
    np.testing.assert_array_equal(geodesic_distance_pairs(mesh, a, b), geodesic_distances(mesh, a)[np.arange(width), b])


def test_one_search_from_a_vertex_serves_all_of_its_pairs(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a sheet, whose distances are straight, the first round finds all near and far pairs of 100 vertices."""
    mesh, searched = sheet(np.arange(12.0), np.arange(12.0)), []

    def counted(graph, indices, limit):
        searched.append(len(indices))
        return dijkstra(graph, indices=indices, limit=limit)

    a = np.repeat(np.arange(100), 3)
    b = a + np.tile([1, 13, 40], 100)
    exact = geodesic_distances(mesh, a)[np.arange(300), b]
    monkeypatch.setattr(geodesics, "dijkstra", counted)
    np.testing.assert_array_equal(geodesic_distance_pairs(mesh, a, b), exact)
    assert searched == [64, 36]


def test_clouds() -> None:
    mesh = fibonacci_sphere(1000)
    cloud = cloud_of(mesh)
    exact = np.arccos(np.clip(mesh.vertices[:2] @ mesh.vertices.T, -1, 1))
    assert np.abs(geodesic_distances(cloud, [0, 1]) - exact).mean() < 0.06 * exact.mean()
    assert len(set(farthest_geodesic(cloud, 30))) == 30
    assert everywhere(Mesh(np.zeros((1, 3)), NO_FACES)).tolist() == [[0.0]]


def test_farthest_samples_are_the_farthest() -> None:
    mesh = blob(400)
    count = 124
    samples = farthest_geodesic(mesh, count, rng=4)
    nearest = np.minimum.accumulate(dijkstra(geodesic_graph(mesh, 1), indices=samples), axis=0)
    reach = nearest[np.arange(count - 1), samples[1:]]
    np.testing.assert_allclose(reach, nearest[:-1].max(axis=1), rtol=1e-12)
    assert len(set(samples.tolist())) == count


def test_farthest_samples_meet_every_component_and_only_used_vertices() -> None:
    mesh = two_pieces()
    for seed in range(3):
        piece = np.searchsorted([120, 121], farthest_geodesic(mesh, 2, rng=seed), side="right")
        assert sorted(piece) == [0, 2]
    assert set(farthest_geodesic(mesh, 240).tolist()) == set(range(241)) - {120}
    assert farthest_geodesic(mesh, 5, first=17)[0] == 17
    np.testing.assert_array_equal(farthest_geodesic(mesh, 9, rng=1), farthest_geodesic(mesh, 9, rng=1))


def test_bad_input_is_refused() -> None:
    mesh = flat(20)
    for call in (
        lambda: geodesic_distances(mesh, [20]),
        lambda: geodesic_distances(mesh, [-1]),
        lambda: geodesic_distances(mesh, [0.5]),
        lambda: geodesic_distances(mesh, [[0, 1]]),
        lambda: geodesic_distance_pairs(mesh, [0, 1], [2]),
        lambda: geodesic_distance_pairs(mesh, [0], [20]),
        lambda: farthest_geodesic(mesh, 21),
        lambda: farthest_geodesic(mesh, 0),
        lambda: farthest_geodesic(mesh, 2, first=20),
        lambda: geodesic_graph(mesh, -1),
    ):
        with pytest.raises(InvalidInput):
            call()


MESH = unit_area(blob(1500))


@pytest.fixture(scope="module")
def spread():
    return farthest_geodesic(MESH, 300, 0)


def exact(graph, points):
    return np.asarray(dijkstra(graph, indices=points))[:, points]


def test_near_points_are_exact_and_far_ones_hardly_farther(spread):
    graph = geodesic_graph(MESH, 1)
    true, found = exact(graph, spread), pairwise_geodesics(graph, spread)
    known = true <= _NEARBY
    known[:_FULL_SEARCHES] = known[:, :_FULL_SEARCHES] = True
    np.testing.assert_allclose(found[known], true[known], rtol=1e-12)
    assert (found >= (1 - 1e-6) * true).all()  # paths over others are added in single precision
    over = (found - true)[~known] / true[~known]
    assert 0 < over.mean() < 0.005
    assert over.max() < 0.15
    assert (found - true).mean() < 1e-3 * true.mean()
    np.testing.assert_allclose(found, found.T, rtol=1e-12)


def test_few_points_are_exact(spread):
    graph = geodesic_graph(MESH, 1)
    np.testing.assert_allclose(pairwise_geodesics(graph, spread[:50]), exact(graph, spread[:50]), rtol=1e-12)


def test_components_are_infinitely_far_and_none_is_forgotten(monkeypatch):
    n = len(MESH.vertices)
    both = joined(MESH, shifted(MESH, 5, 5, 5))
    points = np.concatenate([np.arange(0, n, 50), n + np.arange(0, n, 50)])
    monkeypatch.setattr(geodesics, "_FULL_SEARCHES", 10)
    graph = geodesic_graph(both, 1)
    true, found = exact(graph, points), pairwise_geodesics(graph, points)
    np.testing.assert_array_equal(np.isinf(found), np.isinf(true))
    apart = np.isfinite(true)
    assert (found[apart] >= (1 - 1e-6) * true[apart]).all()
    later = np.ix_(points >= n, points >= n)
    np.testing.assert_allclose(found[later], true[later], rtol=1e-12)
