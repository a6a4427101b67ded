"""Formulas that an answer barely shows when they are wrong: a law for each, from arrays to the functional map."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from conftest import blob, random_basis
from kfmaps.descriptors.spectral import (
    _spectral_range,
    heat_map,
    heat_signature,
    heat_times,
    normalize,
    wave_energies,
    wave_map,
    wave_signature,
)
from kfmaps.fmap import nearest as nearest_module
from kfmaps.fmap.approximate_nearest import approximate_nearest
from kfmaps.fmap.confidence import local_confidence
from kfmaps.fmap.convert import to_functional, to_points
from kfmaps.fmap.descriptor_guidance import descriptor_guidance
from kfmaps.fmap.multiplication_operators import truncate_features, truncate_operators
from kfmaps.fmap.nearest import nearest
from kfmaps.fmap.solvers import CG, solve
from kfmaps.fmap.terms import laplacian_term
from kfmaps.fmap.zoomout import ZoomOut, fit_functional_map
from kfmaps.geometry import geodesics
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesics import geodesic_distance_pairs, geodesic_distances
from kfmaps.geometry.mesh import Mesh, face_areas, face_normals, surface_area, unit_area, vertex_areas
from kfmaps.geometry.sampling import SampledBasis, _embedded, spectral_samples
from kfmaps.kernels.kernels import Gaussian, Laplacian, _squared_distances, resolve_kernel
from kfmaps.kernels.landmark_selection import farthest_descriptors
from kfmaps.kernels.nystrom import nystrom

GUARDS = ("kfmaps.descriptors.spectral", "kfmaps.fmap", "kfmaps.geometry", "kfmaps.kernels")


def with_values(values: list[float]) -> Basis:
    """A basis that has these eigenvalues."""
    return replace(random_basis(60, len(values), np.random.default_rng(0)), eigenvalues=np.array(values))


def split(basis: Basis, rows: np.ndarray, parts: int) -> tuple[Basis, np.ndarray]:
    """Each of the points ``rows`` cut into ``parts`` that share its area; and which point each of all now was."""
    share = np.ones(len(basis.mass), dtype=int)
    share[rows] = parts
    was = np.repeat(np.arange(len(share)), share)
    return Basis(basis.eigenvalues, basis.functions[was], (basis.mass / share)[was]), was


# The kernel.


@pytest.mark.parametrize("bandwidth_scale", [0.3, 1.0, 5.0])
def test_a_typical_pair_has_the_same_value_in_both_kernels_of_distance(bandwidth_scale, rng):
    """Of the median distance the Gaussian makes exp(−s), the Laplacian exp(−√s)."""
    X = rng.normal(size=(31, 5)) * 7
    squares = np.median(_squared_distances(X, X)[np.triu_indices(31, 1)])
    pair = np.array([[0.0] * 5, [np.sqrt(squares)] + [0.0] * 4])
    for kind, exponent in ((Gaussian(), bandwidth_scale), (Laplacian(), np.sqrt(bandwidth_scale))):
        kernel: Any = resolve_kernel(kind, X, bandwidth_scale)
        assert kernel(pair[:1], pair[1:])[0, 0] == pytest.approx(np.exp(-exponent))


@pytest.mark.parametrize("rtol", [1e-2, 1e-5, 1e-9])
def test_eigenvalues_below_the_tolerance_are_dropped(rtol, rng):
    X = rng.normal(size=(40, 2))
    values = np.linalg.eigvalsh(Gaussian(0.5)(X, X))[::-1]
    factor = nystrom(Gaussian(0.5), X, rtol)
    assert factor.rank == np.count_nonzero(values > rtol * values[0])
    assert 1 < factor.rank < 40
    W = factor.features(X)
    error = np.linalg.norm(Gaussian(0.5)(X, X) - W @ W.T, 2)
    assert error == pytest.approx(values[factor.rank], rel=1e-4, abs=1e-13)


def test_farthest_points_of_a_small_pool_are_those_of_all_rows_where_there_are_no_more(rng):
    """At least four times as many as wanted are chosen from, however small the pool is to be."""
    X = rng.normal(size=(150, 3))
    np.testing.assert_array_equal(farthest_descriptors(X, 40, 0, pool=10), farthest_descriptors(X, 40, 0, pool=None))


# Surfaces.


def test_areas_are_areas():
    triangle = Mesh(np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 0]]), np.array([[0, 1, 2]]))
    assert face_areas(triangle) == pytest.approx(6)
    tilted = np.array([[0.3, -1.0, 2.0], [1.1, 0.4, -0.7], [-0.6, 2.2, 0.9]])
    normal = np.cross(tilted[1] - tilted[0], tilted[2] - tilted[0])
    np.testing.assert_allclose(face_normals(Mesh(tilted, triangle.faces))[0], normal / np.linalg.norm(normal))
    assert vertex_areas(triangle) == pytest.approx(2)
    for mesh in (triangle, blob(100)):
        assert surface_area(mesh) == pytest.approx(vertex_areas(mesh).sum())
        assert surface_area(unit_area(mesh)) == pytest.approx(1)


def test_areas_of_samples_are_those_of_the_vertices_nearest_to_them(small_basis, rng):
    """However the area is spread: what is cut into parts counts as it did in one."""
    uneven = replace(small_basis, mass=small_basis.mass * rng.uniform(0.1, 5, len(small_basis.mass)))
    samples = spectral_samples(uneven, 30, 0)
    candidates, embedding = _embedded(uneven)
    np.testing.assert_array_equal(candidates, np.arange(len(uneven.mass)))
    gaps = _squared_distances(embedding, embedding[samples.vertices])
    areas = [uneven.mass[gaps.argmin(axis=1) == i].sum() for i in range(30)]
    np.testing.assert_allclose(samples.basis.mass, areas)


@pytest.mark.parametrize("unit", [1e-3, 40.0])
def test_crowded_samples_are_drawn_again_in_any_unit(unit, small_basis, rng):
    uneven = replace(small_basis, mass=np.exp(9 * rng.random(len(small_basis.mass))) / 1e4)
    large = Basis(uneven.eigenvalues / unit**2, uneven.functions / unit, uneven.mass * unit**2)
    np.testing.assert_array_equal(spectral_samples(large, 30, 0).vertices, spectral_samples(uneven, 30, 0).vertices)


@pytest.mark.parametrize("unit", [1e-3, 40.0])
def test_the_samples_embedding_is_a_distance(unit, rng):
    """Biharmonic distances have the unit of the shape, so that they say something on thin parts as on thick ones."""
    basis = random_basis(80, 12, rng)
    large = Basis(basis.eigenvalues / unit**2, basis.functions / unit, basis.mass * unit**2)
    np.testing.assert_allclose(_embedded(large)[1], unit * _embedded(basis)[1], rtol=1e-9)


def test_the_samples_embedding_is_that_of_greens_function(small_mesh, small_basis):
    embedding = _embedded(small_basis)[1]
    found = np.linalg.norm(embedding * np.sqrt(small_basis.mass)[:, None], axis=0)
    np.testing.assert_allclose(found * small_basis.eigenvalues[1:], 1, rtol=1e-9)
    assert embedding.shape == (len(small_mesh.vertices), 39)


def test_pairs_are_searched_no_farther_than_they_need(monkeypatch):
    """The straight line is a good guess of most distances: one search, of little, is enough for near pairs."""
    mesh = unit_area(blob(1500))
    everything = geodesic_distances(mesh, np.arange(0, 1500, 10))
    target = np.argsort(everything, axis=1)[:, 120]  # some six edges away
    seen, limits = [], []

    def searched(graph, indices, limit=np.inf):
        found = original(graph, indices=indices, limit=limit)
        seen.append(int(np.isfinite(found).sum()))
        limits.append(limit)
        return found

    original = geodesics.dijkstra
    monkeypatch.setattr(geodesics, "dijkstra", searched)
    found = geodesic_distance_pairs(mesh, np.arange(0, 1500, 10), target)
    np.testing.assert_allclose(found, np.take_along_axis(everything, target[:, None], 1)[:, 0], rtol=1e-12)
    assert len(limits) <= 4  # three blocks, and one more for a stray
    assert sum(seen) < 0.4 * 150 * 1500
    assert max(limits) < 3 * found.max()


# Descriptors.


@pytest.mark.parametrize(
    ("values", "low", "high"),
    [
        ([0, 1e-9, 5, 900], np.pi, 900),  # a speck's or a bridge's
        ([0, 7, 30, 900], 7, 900),
        ([0, 500, 600, 900], 4 * np.pi, 900),
        ([0, 7, 8, 20], 5, 20),
    ],
)
def test_the_range_of_the_spectrum_starts_near_weyls_second_eigenvalue(values, low, high):
    assert _spectral_range(with_values(values)) == pytest.approx((low, high))
    a, b = with_values([0, 5, 900]), with_values([0, 9, 700])
    assert _spectral_range(a, b) == _spectral_range(b, a) == pytest.approx((9, 700))  # common to both


def test_heat_has_gone_from_the_last_function_first_and_from_the_lowest_last():
    """At the first time a ten thousandth is left of the last function, at the last time of the lowest."""
    basis = with_values([0, 7, 30, 900])
    times = heat_times(6, basis)
    assert np.exp(-900 * times[0]) == pytest.approx(1e-4)
    assert np.exp(-7 * times[-1]) == pytest.approx(1e-4)
    np.testing.assert_allclose(times[1:] / times[:-1], times[1] / times[0])
    assert heat_times(1, basis)[0] == pytest.approx(np.sqrt(times[0] * times[-1]))


@pytest.mark.parametrize(("count", "part"), [(350, 7 / 350), (105, 1 / 15), (20, 1 / 15)])
def test_waves_lie_within_the_range_and_are_as_wide_as_they_say(count, part):
    low, high = np.log([7, 900])
    energies, sigma = wave_energies(count, with_values([0, 7, 30, 900]))
    assert sigma == pytest.approx(part * (high - low))
    assert (energies[0], energies[-1]) == pytest.approx((low + 2 * sigma, high - 2 * sigma))
    np.testing.assert_allclose(np.diff(energies), (energies[-1] - energies[0]) / (count - 1))


def test_a_wave_of_one_function_is_a_bell_of_width_sigma():
    basis = with_values([0, 1, 50])
    energies = np.log(50) + 0.4 * np.array([0.0, 1, -1, 2])
    found = wave_signature(basis, energies, 0.4) / basis.functions[:, 2:] ** 2
    # Of the function of eigenvalue 1 next to nothing is left so far away.
    np.testing.assert_allclose(found.min(axis=0), np.exp([0, -0.5, -0.5, -2]), rtol=1e-3)


def test_heat_is_all_there_and_decays_as_each_function_does(rng):
    basis, times = random_basis(60, 9, rng), np.array([0.02, 0.3, 1.0])
    trace = np.exp(-times[None, :] * basis.eigenvalues[:, None]).sum(axis=0)
    np.testing.assert_allclose(basis.mass @ heat_signature(basis, times), trace)


def test_a_landmark_map_is_symmetric_and_equals_the_signature_at_the_landmark(rng):
    basis, energies = random_basis(60, 9, rng), np.array([0.1, 0.7, 1.2])
    landmarks = np.array([4, 50, 7])
    for map_of, signature in (
        (heat_map(basis, landmarks, energies), heat_signature(basis, energies)),
        (wave_map(basis, landmarks, energies, 0.5), wave_signature(basis, energies, 0.5)),
    ):
        values = map_of.reshape(60, 3, 3)  # vertex, landmark, time or energy
        for j, mark in enumerate(landmarks):
            np.testing.assert_allclose(values[mark, j], signature[mark])
        np.testing.assert_allclose(values[landmarks], values[landmarks].transpose(1, 0, 2))


def test_descriptors_of_random_vertices_differ_by_two(rng):
    """In squared length, by area, over both shapes; however many there are and whatever their units."""
    for d in (1, 7, 30):
        D_s, D_t = (rng.normal(size=(n, d)) ** 3 * rng.uniform(0.1, 9, d) + 5 for n in (60, 50))
        m_s, m_t = rng.random(60), 10 * rng.random(50)
        found = np.concatenate(normalize(D_s, D_t, "variance", m_s, m_t))
        weight = np.concatenate([m_s / m_s.sum(), m_t / m_t.sum()]) / 2
        assert weight @ _squared_distances(found, found) @ weight == pytest.approx(2)


# Terms.


def test_the_laplacian_term_is_the_same_from_either_side():
    a, b = with_values([0, 5, 60]), with_values([0, 5, 30])
    one, other = laplacian_term(a, b).weights, laplacian_term(b, a).weights
    np.testing.assert_allclose(one, other.T)
    assert one.max() == pytest.approx(1)


def test_a_point_in_parts_condenses_as_a_whole(rng):
    source, target = random_basis(40, 6, rng), random_basis(30, 6, rng)
    F_s, F_t = rng.normal(size=(40, 9)), rng.normal(size=(30, 9))
    F_s[:5] *= 2
    fine, was = split(source, np.arange(5), 50)
    one, other = (truncate_features(b, F, target, F_t, 0.2) for b, F in ((source, F_s), (fine, F_s[was])))
    assert 1 < one[0].shape[1] < 9
    np.testing.assert_allclose(other[0] @ other[1].T, (one[0] @ one[1].T)[was], atol=1e-9)


@pytest.mark.parametrize("strong", [0, 1])
def test_truncation_drops_as_much_as_its_tolerance_allows_and_no_more(strong, rng):
    """Of the slices of both shapes together, wherever the strong ones are."""
    packed = [rng.normal(size=(12, 15)) * 0.6 ** np.arange(12)[:, None] for _ in range(2)]
    packed[strong][::-1] *= 5 * 0.8 ** np.arange(12)[:, None]
    spectrum = np.sort(np.linalg.eigvalsh(packed[0] @ packed[0].T + packed[1] @ packed[1].T))
    lost = np.cumsum(spectrum) / spectrum.sum()
    for rtol in (1e-3, 0.01, 0.1, 0.4):
        kept = truncate_operators(packed[0], packed[1], rtol)
        part = 1 - sum(float((p**2).sum()) for p in kept) / spectrum.sum()
        assert part <= rtol
        assert len(kept[0]) == 12 - np.count_nonzero(lost <= rtol)
        assert part == pytest.approx(lost[11 - len(kept[0])] if len(kept[0]) < 12 else 0, abs=1e-12)


@pytest.mark.parametrize("unit", [1e-9, 1e6])
def test_conjugate_gradients_know_no_units(unit, rng):
    values, b = rng.uniform(1, 50, 30), rng.normal(size=30)
    one, other = (solve(lambda x: values * x, scale * b, CG(rtol=1e-6)) for scale in (1.0, unit))
    assert one.status == other.status == "converged"
    assert one.steps == other.steps
    assert one.residuals[-1] <= 1e-6 * np.linalg.norm(b) < one.residuals[-2]
    np.testing.assert_allclose(other.value, unit * one.value, rtol=1e-9)


# From maps to points and back.


def test_each_target_vertex_takes_the_nearest_image(rng):
    """The image of source vertex p is C φ(p): C carries functions, and with them their peaks."""
    source, target = random_basis(40, 7, rng), random_basis(30, 6, rng)
    C = rng.normal(size=(6, 7))
    images = [C @ phi for phi in source.functions]
    wanted = [int(np.argmin([np.linalg.norm(place - image) for image in images])) for place in target.functions]
    np.testing.assert_array_equal(to_points(C, source, target), wanted)


class Adverse(np.ndarray):
    """A product of single precision that errs as much as it may: for points that come later, against all before."""

    def __matmul__(self, other: Any) -> Any:
        x, y = (np.asarray(part, dtype=np.float64) for part in (self, other))
        bound = (len(y) - 1 + 4) * 2.0**-24 * (np.abs(x) @ np.abs(y))
        return np.asarray(x @ y + np.linspace(-1, 1, y.shape[1]) * bound)


@pytest.mark.parametrize("d", [1, 3, 40])
@pytest.mark.parametrize("far", [0.0, 3.0])
def test_the_search_is_right_however_single_precision_errs(d, far, monkeypatch):
    """Pairs of points on both sides of a query, one a little nearer than the other: any product may prefer either."""
    rng = np.random.default_rng(0)
    exact = nearest_module._single
    queries = rng.normal(size=(400, d))
    aside = rng.normal(size=(400, d))
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    aside *= 0.02 * rng.uniform(0.5, 1, (400, 1)) * (d + 4) ** 0.5
    nearer = 1 - 10.0 ** rng.uniform(-8, -2, (400, 1))
    points = np.concatenate([queries + nearer * aside, queries - aside]) + far
    queries = queries + far
    wanted = ((queries[:, None] - points[None]) ** 2).sum(axis=2).argmin(axis=1)
    monkeypatch.setattr(nearest_module, "_single", lambda *given: exact(*given).view(Adverse))
    np.testing.assert_array_equal(nearest(queries, points), wanted)


def test_zoomout_starts_from_the_low_part_of_the_map(small_basis, rng):
    C = rng.normal(size=(9, 9))
    found = ZoomOut(6, 6)(C, small_basis, small_basis)
    np.testing.assert_array_equal(found.functional_map, C[:6, :6])
    np.testing.assert_array_equal(found.target_to_source, to_points(C[:6, :6], small_basis, small_basis))


@pytest.mark.parametrize("area", [1.0, 9.0])
def test_guidance_has_its_weight_on_a_shape_of_any_size(area, rng):
    """Squared differences of functions are in 1/area; those of the descriptors beside them are too."""
    source, target = (replace(b, mass=area * b.mass / b.mass.sum()) for b in [random_basis(60, 4, rng)] * 2)
    guided: Any = descriptor_guidance(*(rng.normal(size=(60, 5)) for _ in range(2)))
    both = np.concatenate(guided.embedding_columns(12.0, source, target))
    assert _squared_distances(both, both).mean() * area == pytest.approx(12)


def test_approximate_nearest_compares_points_of_any_length(rng):
    """Half the square of a point belongs to its distance: without it the longest would always win."""
    points = rng.normal(size=(400, 12)) * 10.0 ** rng.uniform(-2, 1, (400, 1))
    queries = points[rng.permutation(400)[:100]] * (1 + 1e-3 * rng.normal(size=(100, 12)))
    wanted = ((queries[:, None] - points[None]) ** 2).sum(axis=2).argmin(axis=1)
    for size in (400, 50):
        np.testing.assert_array_equal(approximate_nearest(queries, points, size=size, n_probe=400), wanted)


def test_the_damping_of_samples_lies_between_least_squares_and_projection(small_basis, rng):
    samples = spectral_samples(small_basis, 90, 0).basis
    points = rng.integers(0, len(small_basis.mass), 90)
    phi, pulled = samples.functions[:, :30], small_basis.functions[points, :30]
    root = np.sqrt(samples.mass)[:, None]
    least = np.linalg.lstsq(root * phi, root * pulled, rcond=None)[0]
    projected = (samples.mass[:, None] * phi).T @ pulled
    np.testing.assert_allclose(fit_functional_map(points, small_basis, samples, 30, ridge=0.0), least, atol=1e-8)
    np.testing.assert_allclose(fit_functional_map(points, small_basis, samples, 30, ridge=1e9), projected, atol=1e-6)
    sizes = [np.linalg.norm(fit_functional_map(points, small_basis, samples, 30, ridge=r) - least) for r in (0.05, 0.2)]
    usual = np.linalg.norm(fit_functional_map(points, small_basis, samples, 30) - least)
    assert sizes[0] < usual < sizes[1] < np.linalg.norm(projected - least)
    # Where the samples' functions are orthonormal it changes nothing.
    everywhere, points = SampledBasis(*vars(small_basis).values()), rng.integers(0, 400, 400)
    one, other = (fit_functional_map(points, small_basis, b, 20) for b in (everywhere, small_basis))
    np.testing.assert_allclose(one, other, atol=1e-9)


def test_the_map_of_zoomout_on_samples_is_that_of_all_points(small_basis):
    found = ZoomOut(6, 30, 6, samples=220)(np.eye(6), small_basis, small_basis)
    np.testing.assert_array_equal(found.target_to_source, np.arange(len(small_basis.mass)))
    np.testing.assert_allclose(found.functional_map, np.eye(30), atol=1e-8)
    # From a start whose sampled map is wrong in places too.
    other = ZoomOut(6, 12, 3, samples=40)(np.diag([1.0, 1, 1, 1, 1, -1]), small_basis, small_basis)
    ends = small_basis.truncate(12)
    np.testing.assert_array_equal(other.functional_map, to_functional(other.target_to_source, ends, ends))


def test_confidence_is_known_everywhere_however_uneven_the_triangles_are():
    """Samples are spread by area: where the vertices are few there are as many samples as where they crowd."""
    rng = np.random.default_rng(0)
    rows = rng.normal(size=(2200, 3)) * np.array([0.1, 0.1, 0.0]) + [0, 0, 1]  # a small cap
    rows[2000:] = rng.normal(size=(200, 3))
    points = rows / np.linalg.norm(rows, axis=1, keepdims=True)
    uneven = Mesh(points, ConvexHull(points).simplices)
    found = local_confidence(uneven, uneven, np.arange(2200))
    assert found == pytest.approx(1, abs=1e-9)
