"""What large shapes are spared: searches by cells, samples that stand for all points, fits on samples."""

from dataclasses import replace

import numpy as np
import pytest

import kfmaps.shape as fit_shape
from conftest import NO_LANDMARKS, blob, fibonacci_sphere, random_basis, small_fit
from kfmaps._arrays import InvalidInput, inner
from kfmaps._threads import limit_threads
from kfmaps.config import Weights
from kfmaps.fmap.approximate_nearest import approximate_nearest
from kfmaps.fmap.convert import to_functional, to_points
from kfmaps.fmap.multiplication_operators import multiplication_operators, truncate_features
from kfmaps.fmap.nearest import nearest
from kfmaps.fmap.solvers import CG
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import laplace_basis
from kfmaps.geometry.geodesics import geodesic_distance_pairs
from kfmaps.geometry.mesh import Mesh, unit_area, vertex_normals
from kfmaps.geometry.sampling import SampledBasis, spectral_samples, stratified_samples, stratified_vertices
from kfmaps.kernels.landmark_selection import farthest_descriptors
from kfmaps.matching.finish import adapt_settings, refine_map
from kfmaps.matching.fit import fit, fit_points
from kfmaps.matching.search_result import SearchResult
from kfmaps.shape import _local_descriptors, prepare, sample_shape

GUARDS = ("kfmaps.fmap", "kfmaps.geometry", "kfmaps.kernels.landmark_selection", "kfmaps.matching", "kfmaps.shape")

CONFIG = small_fit(30, 40, 60, 80)


@pytest.fixture(scope="module")
def pair():
    """Two meshings of one shape, with the truth between them."""
    meshes = unit_area(blob(3000)), unit_area(blob(2800, twist=0.3))
    truth = nearest(meshes[1].vertices, meshes[0].vertices)
    return *(prepare(mesh, CONFIG) for mesh in meshes), truth


def necked(n: int, waist: float, half: float) -> Mesh:
    """Two bells joined by a bridge of radius ``waist``, which ``half`` of the vertices lie on."""
    sphere = fibonacci_sphere(n)
    x, y, z = sphere.vertices.T
    rise = np.clip((np.abs(z) - half) / 0.15, 0, 1)
    radius = waist + (1 - waist) * rise**2 * (3 - 2 * rise)
    return Mesh(np.stack([x * radius, 1.2 * y * radius, 1.6 * z], axis=1), sphere.faces)


@pytest.mark.parametrize(("radius", "wanted"), [(0.1, 10_000), (0.15, 550 / (np.pi * 0.15**2))])
def test_shot_of_a_large_shape_counts_so_many_points_in_a_ball(monkeypatch, radius, wanted):
    """A ball of radius r around a point of a sphere has π r² of its area."""
    sphere, asked = unit_area(fibonacci_sphere(1500)), []

    def spy(_mesh, _radius, *, samples, at, **_rest):
        asked.append(samples)
        return np.ones((len(at), 2))

    monkeypatch.setattr(fit_shape, "MAX_SHOT_VERTICES", 1000)
    monkeypatch.setattr(fit_shape, "shot", spy)
    _local_descriptors(sphere, laplace_basis(sphere, 20), radius)
    assert asked == [pytest.approx(wanted, rel=0.03)]


def test_shot_between_samples_is_the_mean_by_inverse_squared_distances(pair, monkeypatch):
    shape = pair[0]
    exact = _local_descriptors(shape.mesh, shape.basis, 0.15)
    monkeypatch.setattr(fit_shape, "MAX_SHOT_VERTICES", 800)
    few = _local_descriptors(shape.mesh, shape.basis, 0.15)
    assert few.dtype == np.float32
    np.testing.assert_allclose(np.linalg.norm(few, axis=1), 1.0, rtol=1e-6)
    away = np.linalg.norm(few - exact, axis=1).mean()
    assert 0 < away < 0.25 * np.linalg.norm(exact - exact[::-1], axis=1).mean()
    monkeypatch.setattr(fit_shape, "_BALL_SUPPORT", 1000)  # as many support points as all vertices have
    found = _local_descriptors(shape.mesh, shape.basis, 0.15)
    chosen = stratified_vertices(shape.basis, 800, 0)
    places = np.hstack([shape.mesh.vertices, fit_shape._NORMAL_WEIGHT * vertex_normals(shape.mesh)])
    for v in np.setdiff1d(np.arange(len(places)), chosen)[::50]:
        squares = ((places[chosen] - places[v]) ** 2).sum(axis=1)
        near = np.argsort(squares)[:3]
        mean = (exact[chosen[near]] / squares[near][:, None]).sum(axis=0)
        np.testing.assert_allclose(found[v], mean / np.linalg.norm(mean), atol=1e-5)


@pytest.mark.parametrize("count", [100, 300])
def test_samples_do_not_crowd_on_a_thin_bridge(count):
    basis = laplace_basis(unit_area(necked(1500, 0.004, 0.5)), 40)
    bridge = np.abs(fibonacci_sphere(1500).vertices[:, 2]) < 0.5
    assert basis.mass[bridge].sum() < 0.02
    samples = spectral_samples(basis, count, 0)
    assert bridge[samples.vertices].mean() < 0.05
    assert len(set(samples.vertices.tolist())) == len(samples.vertices) == count
    assert samples.basis.mass.sum() == pytest.approx(basis.mass.sum())
    # Where they do not crowd, as on a wider bridge, they are the farthest points themselves.
    wide = laplace_basis(unit_area(necked(1500, 0.2, 0.2)), 40)
    expected = farthest_descriptors(wide.functions[:, 1:] / wide.eigenvalues[1:], count, 0)
    np.testing.assert_array_equal(spectral_samples(wide, count, 0).vertices, expected)


@pytest.mark.parametrize("device", ["cpu", "torch"])
def test_a_sampled_basis_stays_one(device):
    if device == "torch":
        pytest.importorskip("torch")
    basis = spectral_samples(laplace_basis(blob(200), 5), 30).basis
    for other in (basis.truncate(3), basis.to(device), basis.to(device).truncate(2)):
        assert isinstance(other, SampledBasis)
    with pytest.raises(InvalidInput, match="from 1 to 5"):
        basis.truncate(99)


def test_every_choice_of_points_comes_from_the_seed(pair):
    source, target, truth = pair
    config = replace(CONFIG, fit_samples=500)
    for seed in (0, 5):
        points = fit_points(source, target, config, NO_LANDMARKS, rng=seed)
        expected = sample_shape(source, 500, NO_LANDMARKS[:, 0], seed).shape.mesh.vertices
        np.testing.assert_array_equal(points.shapes[0].mesh.vertices, expected)
    maps = [fit(source, target, config, rng=seed).functional_map for seed in (0, 0, 5, np.random.default_rng(5))]
    np.testing.assert_array_equal(maps[0], maps[1])
    assert not any(np.array_equal(maps[0], other) for other in maps[2:])
    C = to_functional(truth, source.basis, target.basis)[:20, :20]
    zoom = ZoomOut(20, 40, 10, samples=300)
    found = SearchResult(np.asarray(C), "a", None, "unchecked")
    ends = [
        refine_map(C, source, target, adapt_settings(replace(CONFIG, refinement=z), found, r)).functional_map
        for z, r in ((zoom, 0), (zoom, 3), (replace(zoom, seed=3), 0), (zoom, 0))
    ]
    np.testing.assert_array_equal(ends[1], ends[2])
    np.testing.assert_array_equal(ends[0], ends[3])
    assert not np.array_equal(ends[0], ends[1])


def test_approximate_nearest_misses_few_and_none_by_much(pair):
    source, target, truth = pair
    C = to_functional(truth, source.basis, target.basis)
    queries, points = target.basis.functions, source.basis.functions @ C.T
    exact = nearest(queries, points, exact=True)
    found = nearest(queries, points, exact=False)
    assert 0 < len(np.unique(found)) <= len(points)
    assert np.mean(found != exact) < 0.005
    some = nearest(queries[::70], points, exact=False)  # queries far apart
    assert np.mean(some != exact[::70]) < 0.03
    errors = [geodesic_distance_pairs(source.mesh, f, truth).mean() for f in (exact, found)]
    assert errors[1] < 1.02 * errors[0]
    few = approximate_nearest(queries, points, n_probe=1)
    assert np.mean(few != exact) > np.mean(found != exact)  # more probes find more


@pytest.mark.parametrize(("size", "threads"), [(5, 1), (64, 3)])
def test_lists_hold_every_point_once(pair, size, threads):
    source, _, _ = pair
    functions = source.basis.functions[:, :40]
    with limit_threads(threads):
        found = approximate_nearest(functions, functions, size=size)
    np.testing.assert_array_equal(found, np.arange(len(functions)))


def test_approximate_nearest_takes_empty_and_tiny_sets(rng):
    points = rng.normal(size=(1, 40))
    assert approximate_nearest(points, points).tolist() == [0]
    assert approximate_nearest(np.zeros((0, 40)), points).shape == (0,)
    assert set(approximate_nearest(np.ones((500, 40)), np.ones((3, 40)))) <= {0, 1, 2}
    with pytest.raises(InvalidInput, match="n_probe"):
        approximate_nearest(points, points, n_probe=0)


@pytest.mark.parametrize("choose", [spectral_samples, stratified_samples])
def test_samples_are_a_quadrature(choose, pair):
    basis = pair[0].basis.truncate(15)
    samples = choose(basis, 400, 0)
    b = samples.basis
    np.testing.assert_array_equal(b.functions, basis.functions[samples.vertices])
    assert b.mass.sum() == pytest.approx(1.0)
    assert np.linalg.norm(b.functions.T @ (b.mass[:, None] * b.functions) - np.eye(15), 2) < 0.1
    np.testing.assert_array_equal(choose(basis, 400, 0).vertices, samples.vertices)
    for kept in (None, np.array([7, 2999])):
        strata = stratified_samples(basis, 200, 3, kept).vertices
        np.testing.assert_array_equal(stratified_vertices(basis, 200, 3, kept), strata)


def test_stratified_samples_follow_area_not_vertices(pair):
    mesh = blob(3000)
    z = mesh.vertices[:, 2]
    crowded = Mesh(mesh.vertices * np.where(z > 0, 1.0, 0.35)[:, None], mesh.faces)
    basis = laplace_basis(unit_area(crowded), 20)
    samples = stratified_samples(basis, 300)
    share = basis.mass[z > 0].sum()
    assert np.mean(z[samples.vertices] > 0) == pytest.approx(share, abs=0.03)
    assert abs(np.mean(z > 0) - share) > 0.2
    assert len(stratified_samples(pair[0].basis, 5, 0, np.array([7, 2999])).vertices) <= 7
    assert {7, 2999} <= set(stratified_samples(pair[0].basis, 5, 0, np.array([7, 2999])).vertices.tolist())


def test_kept_vertices_without_area_have_none():
    mesh = blob(300)
    loose = Mesh(np.vstack([mesh.vertices, [[9.0, 9.0, 9.0]]]), mesh.faces)
    samples = stratified_samples(laplace_basis(loose, 10), 50, 0, np.array([300]))
    assert samples.vertices[-1] == 300
    assert samples.basis.mass[-1] == 0
    assert 300 not in stratified_samples(laplace_basis(loose, 10), 50).vertices


def test_farthest_points_of_a_pool_are_rows_of_all(rng):
    X = rng.normal(size=(500, 3))
    rows = farthest_descriptors(X, 10, 0, pool=50)
    assert len(set(rows.tolist())) == 10
    assert not set(rows.tolist()) <= set(range(50))
    np.testing.assert_array_equal(farthest_descriptors(X, 10, 0, pool=500), farthest_descriptors(X, 10, 0, None))


def test_reduced_shapes_keep_landmarks_and_small_shapes(pair):
    source = pair[0]
    landmark_vertices = np.array([2500, 3, 77])
    part = sample_shape(source, 500, landmark_vertices)
    np.testing.assert_array_equal(part.vertices[part.landmarks], landmark_vertices)
    np.testing.assert_array_equal(part.shape.mesh.vertices, source.mesh.vertices[part.vertices])
    assert sample_shape(source, 3000, landmark_vertices).shape is source
    assert sample_shape(source, None, landmark_vertices).shape is source


@pytest.mark.parametrize("orientation", [0.0, 0.5])
def test_a_fit_on_samples_is_as_good(pair, orientation):
    source, target, truth = pair
    landmarks = np.stack([truth[[10, 700, 1500, 2100]], [10, 700, 1500, 2100]], axis=1)
    config = replace(CONFIG, weights=Weights(orientation=orientation))
    own = [np.sin(5 * s.mesh.vertices) for s in (source, target)]
    full, part = (
        fit(source, target, replace(config, fit_samples=count), landmarks=landmarks, descriptors=(own[0], own[1]))
        for count in (None, 1000)
    )
    maps = [to_points(m.functional_map, source.basis, target.basis) for m in (full, part)]
    errors = [geodesic_distance_pairs(source.mesh, points, truth).mean() for points in maps]
    assert errors[1] < 1.15 * errors[0] + 1e-3
    assert np.linalg.norm(full.functional_map - part.functional_map) > 0
    with pytest.raises(InvalidInput, match="descriptors of"):
        fit(source, target, replace(config, fit_samples=1000), descriptors=(own[0][:9], own[1]))


def test_zoomout_chooses_from_some_of_a_large_source(pair, monkeypatch):
    source, target, truth = pair
    start = to_functional(truth, source.basis.truncate(10), target.basis.truncate(10))
    zoom = ZoomOut(10, 50, 10, samples=300)
    monkeypatch.setattr("kfmaps.fmap.zoomout._CANDIDATES_PER_SAMPLE", 100)
    every = zoom(start, source.basis, target.basis)
    monkeypatch.setattr("kfmaps.fmap.zoomout.MAX_CANDIDATES", 1000)
    some = zoom(start, source.basis, target.basis)
    errors = [geodesic_distance_pairs(source.mesh, m.target_to_source, truth).mean() for m in (every, some)]
    assert (every.target_to_source != some.target_to_source).any()
    spacing = 1 / np.sqrt(1000)  # of the vertices to choose from, in √area
    assert errors[1] < errors[0] + 0.25 * spacing
    ends = [basis.truncate(50) for basis in (source.basis, target.basis)]
    np.testing.assert_array_equal(some.functional_map, to_functional(some.target_to_source, *ends))  # of all points


def test_truncated_features_lose_no_more_than_they_say(rng):
    source, target = random_basis(60, 8, rng), random_basis(50, 8, rng)
    mix = rng.normal(size=(20, 20)) * 10.0 ** -np.linspace(0, 6, 20)[:, None]
    W_s, W_t = rng.normal(size=(60, 20)) @ mix, rng.normal(size=(50, 20)) @ mix

    def energy(F_s, F_t):
        return sum(inner(p, p) for p in (multiplication_operators(source, F_s), multiplication_operators(target, F_t)))

    def bound(F_s, F_t):
        return sum(
            (b.mass * (b.functions**2).sum(axis=1)) @ (F**2).sum(axis=1) for b, F in ((source, F_s), (target, F_t))
        )

    whole = energy(W_s, W_t)
    assert whole <= bound(W_s, W_t)
    counts = []
    for rtol in (1e-8, 1e-4, 1e-2):
        kept = truncate_features(source, W_s, target, W_t, rtol)
        counts.append(kept[0].shape[1])
        assert whole - energy(*kept) + 1e-12 * whole >= 0
        assert whole - energy(*kept) <= rtol * bound(W_s, W_t) + 1e-12 * whole
    assert 20 >= counts[0] > counts[1] > counts[2] >= 1
    kept = truncate_features(source, W_s, target, W_t, 0.0)
    assert energy(*kept) == pytest.approx(whole, rel=1e-12)
    with pytest.raises(InvalidInput, match="rtol"):
        truncate_features(source, W_s, target, W_t, 1.0)


def test_a_warm_start_spares_steps_and_changes_nothing(pair):
    source, target, truth = pair
    landmarks = np.stack([truth[[10, 700]], [10, 700]], axis=1)
    config = replace(CONFIG, solver=CG(1e-9, 2000), fit_samples=800)
    near = fit(source, target, replace(config, bandwidth_scale=0.33), landmarks=landmarks)
    cold, warm = (
        fit(source, target, config, landmarks=landmarks, start=start) for start in (None, near.functional_map)
    )
    assert warm.solution.steps < cold.solution.steps
    np.testing.assert_allclose(warm.functional_map, cold.functional_map, atol=5e-5)
    with pytest.raises(InvalidInput, match="start"):
        fit(source, target, config, landmarks=landmarks, start=np.eye(7))
