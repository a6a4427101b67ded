"""Nearest neighbours, point maps, refinement and evaluation."""

import numpy as np
import pytest

from conftest import blob, random_basis
from kfmaps._arrays import InvalidInput, to_numpy
from kfmaps.fmap.convert import _embed_single, embed, nearest, to_functional, to_points
from kfmaps.fmap.evaluate import error_curve, geodesic_errors, summarize_errors, truth_from_pairs
from kfmaps.fmap.nearest import _TREE_POINTS
from kfmaps.fmap.refine import ICP
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import Basis, laplace_basis
from kfmaps.geometry.mesh import unit_area

GUARDS = ("kfmaps.fmap", "kfmaps.geometry.basis")


def brute(queries, points):
    return ((queries[:, None] - points[None]) ** 2).sum(axis=2).argmin(axis=1)


def test_nearest_is_nearest(asarray, rng):
    queries, points = rng.normal(size=(50, 6)), rng.normal(size=(70, 6))
    np.testing.assert_array_equal(nearest(asarray(queries), asarray(points), block=17), brute(queries, points))


@pytest.mark.parametrize("dimension", [7, 40])
@pytest.mark.parametrize("size", [1e-200, 1e-160, 1e-30, 1e30, 1e150, 1e200])
def test_nearest_at_any_scale(rng, size, dimension):
    points, queries = rng.normal(size=(80, dimension)), rng.normal(size=(50, dimension))
    np.testing.assert_array_equal(nearest(queries * size, points * size), brute(queries, points))


def test_nearest_of_points_far_away_prefers_the_first_of_equals(rng):
    points = rng.normal(size=(40, 3))
    np.testing.assert_array_equal(nearest(points + 1e7, np.vstack([points, points]) + 1e7), np.arange(40))
    far = 1e12 * rng.normal(size=(50, 3))
    found, wanted = (np.linalg.norm(far - points[of(far, points)], axis=1) for of in (nearest, brute))
    np.testing.assert_allclose(found, wanted)
    for dimension, value in ((40, 1.0), (4, 0.0)):
        np.testing.assert_array_equal(nearest(np.full((5, dimension), value), np.full((300, dimension), value)), 0)


@pytest.mark.parametrize("apart", [1e-3, 1e-7, 1e-9, 0.0])
def test_nearest_tells_points_apart_that_single_precision_cannot(rng, apart):
    points = np.repeat(rng.normal(size=(60, 30)), 5, axis=0)
    points += apart * rng.normal(size=points.shape)
    queries = points[rng.permutation(300)[:90]] + 0.3 * apart * rng.normal(size=(90, 30))
    np.testing.assert_array_equal(nearest(queries, points), brute(queries, points))


@pytest.mark.parametrize("size", [1.0, 2.0**-660, 2.0**660])
def test_nearest_on_large_sets_prefers_the_first_of_equals_at_any_scale(rng, size):
    lattice = size * rng.integers(0, 12, (_TREE_POINTS + 5000, 5)).astype(float)
    queries = size * (rng.integers(0, 12, (100, 5)) + rng.choice([0.0, 0.5], (100, 5)))
    squares = ((queries[:, None] / size - lattice / size) ** 2).sum(axis=2)
    np.testing.assert_array_equal(nearest(queries, lattice), np.argmin(squares, axis=1))
    several = size * np.repeat(rng.normal(size=(30, 5)), 1000, axis=0)
    np.testing.assert_array_equal(nearest(several[::-77], several), np.arange(30000)[::-77] // 1000 * 1000)


@pytest.mark.parametrize(
    ("queries", "points"), [(np.ones((2, 3)), np.ones((2, 2))), (np.ones((2, 3)), np.ones((0, 3)))]
)
def test_nearest_refuses_what_does_not_fit(queries, points):
    with pytest.raises(InvalidInput):
        nearest(queries, points)


def test_permuted_vertices_permute_the_answer(small_basis, convert, rng):
    n = len(small_basis.mass)
    order = rng.permutation(n)  # target vertex i is source vertex order[i]
    target = Basis(small_basis.eigenvalues, small_basis.functions[order], small_basis.mass[order])
    C = to_functional(order, convert(small_basis), convert(target))
    np.testing.assert_allclose(to_numpy(C), np.eye(40), atol=1e-8)
    np.testing.assert_array_equal(to_points(C, convert(small_basis), convert(target)), order)
    f = rng.normal(size=(40, 2))
    carried = target.reconstruct(to_numpy(C) @ f)
    np.testing.assert_allclose(carried, small_basis.reconstruct(f)[order], atol=1e-7)


def test_an_approximate_search_in_single_precision_sees_the_same_points(rng):
    source, target, C = random_basis(300, 12, rng), random_basis(200, 14, rng), rng.normal(size=(14, 10))
    beside = rng.normal(size=(300, 40)), rng.normal(size=(200, 40))
    for columns in (None, beside):
        exact, single = embed(C, source, target, columns), _embed_single(C, source, target, columns)
        for one, other in zip(exact, single, strict=True):
            assert other.dtype == np.float32
            np.testing.assert_allclose(other, one, rtol=1e-6, atol=1e-6)


def test_a_vertex_without_area_is_nobodys_image(small_basis):
    mass = small_basis.mass.copy()
    mass[7] = 0.0
    source = Basis(small_basis.eigenvalues, small_basis.functions, mass)
    points = to_points(np.eye(40), source, small_basis)
    assert 7 not in points
    np.testing.assert_array_equal(np.delete(points, 7), np.delete(np.arange(len(mass)), 7))


@pytest.mark.parametrize("points", [np.zeros(3, int), np.full(400, 400), np.full(400, -1), np.zeros(400)])
def test_impossible_point_maps_are_refused(points, small_basis):
    with pytest.raises(InvalidInput, match="target_to_source"):
        to_functional(points, small_basis, small_basis)


@pytest.fixture(scope="module")
def two_meshings():
    """The same smooth shape, triangulated twice, with the nearest vertex as truth."""
    source, target = unit_area(blob(500)), unit_area(blob(420, twist=0.4))
    bases = laplace_basis(source, 40), laplace_basis(target, 40)
    return source, *bases, nearest(target.vertices, source.vertices)


@pytest.mark.parametrize(
    "refinement",
    [ZoomOut(12, 30, 6), ZoomOut(8, 30, 6), ZoomOut(12, 12), ZoomOut(12, 30, 6, samples=150), ICP(3)],
    ids=repr,
)
def test_a_point_map_that_is_known_already_changes_nothing(small_basis, rng, refinement):
    C = np.linalg.qr(rng.normal(size=(12, 12)))[0]
    points = to_points(C, small_basis, small_basis)
    alone, output = (refinement(C, small_basis, small_basis, points=p) for p in (None, points))
    np.testing.assert_array_equal(alone.target_to_source, output.target_to_source)
    np.testing.assert_array_equal(alone.functional_map, output.functional_map)


@pytest.mark.parametrize("refinement", [ZoomOut(6, 30, 4), ZoomOut(6, 30, 4, samples=200), ICP(10)], ids=repr)
def test_refinement_repairs_a_noisy_map(refinement, two_meshings, rng):
    mesh, source, target, truth = two_meshings
    noisy = truth.copy()
    wrong = rng.random(len(noisy)) < 0.3
    noisy[wrong] = rng.integers(len(mesh.vertices), size=wrong.sum())
    C = to_functional(noisy, source.truncate(20), target.truncate(20))
    before = geodesic_errors(mesh, noisy, truth).mean()
    refined = refinement(C, source, target)
    after = geodesic_errors(mesh, refined.target_to_source, truth).mean()
    assert after < 0.15 * before
    if isinstance(refinement, ICP):
        gram = refined.functional_map.T @ refined.functional_map
        np.testing.assert_allclose(gram, np.eye(20), atol=1e-10)


def test_zoomout_says_its_sizes_and_ends_with_the_map_of_its_points(two_meshings):
    _, source, target, truth = two_meshings
    C = to_functional(truth, source.truncate(10), target.truncate(10))
    refined = ZoomOut(8, 21, 5)(C, source, target)
    assert refined.history == (8, 13, 18, 21)
    assert refined.functional_map.shape == (21, 21)
    np.testing.assert_array_equal(refined.target_to_source, to_points(refined.functional_map, source, target))


def test_refinements_refuse_what_they_cannot_do(small_basis, rng):
    with pytest.raises(InvalidInput, match="at most the 40"):
        ZoomOut(10, 41)(np.eye(10), small_basis, small_basis)
    with pytest.raises(InvalidInput, match="square"):
        ICP()(np.eye(10, 11), small_basis, small_basis)
    for make in (lambda: ZoomOut(1, 5), lambda: ZoomOut(9, 5), lambda: ZoomOut(step=0), lambda: ICP(0)):
        with pytest.raises(InvalidInput):
            make()
    assert random_basis(5, 3, rng).functions.shape == (5, 3)


def test_errors_are_free_of_units_and_zero_for_the_truth():
    mesh = blob(300)
    truth = np.arange(300)
    moved = np.roll(truth, 1)
    assert not geodesic_errors(mesh, truth, truth).any()
    errors = geodesic_errors(mesh, moved, truth)
    big = type(mesh)(mesh.vertices * 1000, mesh.faces)
    np.testing.assert_allclose(geodesic_errors(big, moved, truth), errors, rtol=1e-9)
    straight = np.linalg.norm(unit_area(mesh).vertices[moved] - unit_area(mesh).vertices[truth], axis=1)
    assert (errors >= straight - 1e-9).all()


def test_evaluation_of_known_errors():
    found = summarize_errors(np.array([0.0, 0.1, 0.2, 0.5]), auc_limit=0.25)
    assert (found.mean, found.median, found.worst, found.exact) == pytest.approx((0.2, 0.15, 0.5, 0.25))
    assert found.auc == pytest.approx((0.25 + 0.15 + 0.05 + 0.0) / 4 / 0.25)
    thresholds = np.linspace(0, 0.25, 100_001)
    curve = error_curve(found.errors, thresholds)
    assert curve[0] == 0.25
    assert np.trapezoid(curve, thresholds) / 0.25 == pytest.approx(found.auc, abs=1e-4)


def test_truth_of_pairs():
    points = np.array([5, 6, 7])
    np.testing.assert_array_equal(truth_from_pairs(np.array([0, 1]), np.array([2, 0]), points), [7, 5])
    with pytest.raises(InvalidInput, match="equal length"):
        truth_from_pairs(np.array([0]), np.array([2, 0]), points)
    with pytest.raises(InvalidInput):
        truth_from_pairs(np.array([0]), np.array([3]), points)
