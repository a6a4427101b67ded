"""What is zero in exact arithmetic may come out as 0, 1e-16 or −1e-17: nothing divides by it or is sorted by it."""

from __future__ import annotations

from dataclasses import astuple, replace

import numpy as np
import pytest

from conftest import blob, random_basis
from kfmaps.config import BasisConfig, Config, Search
from kfmaps.descriptors.spectral import heat_signature, heat_times, normalize, wave_energies, wave_signature
from kfmaps.fmap.confidence import local_confidence
from kfmaps.fmap.multiplication_operators import (
    multiplication_operators,
    truncate_features,
    truncate_operators,
    unpack_operators,
)
from kfmaps.fmap.refine import ICP
from kfmaps.fmap.solvers import CG, solve
from kfmaps.fmap.terms import laplacian_term, operator_term, value
from kfmaps.fmap.zoomout import ZoomOut, fit_functional_map
from kfmaps.geometry.basis import Basis, eigenvalue_tolerance
from kfmaps.geometry.mesh import Mesh
from kfmaps.geometry.sampling import spectral_samples, stratified_samples
from kfmaps.kernels.kernels import Gaussian, Laplacian, resolve_kernel
from kfmaps.matching.assemble import orientation_pair, principal_features
from kfmaps.matching.candidates import score_maps
from kfmaps.matching.features import Features
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.quality import map_quality, sample_for_scoring, subsample
from kfmaps.matching.ranking import distinct_candidates
from kfmaps.matching.sample_pair import build_sample_pair
from kfmaps.matching.search import search_map
from kfmaps.shape import Shape, prepare

GUARDS = ("kfmaps.descriptors.spectral", "kfmaps.fmap", "kfmaps.geometry.basis", "kfmaps.matching")

FIRST = (0.0, 1e-15, -1e-17)
"""How the eigenvalue of the constant may come out."""
K = 30
SMALL = replace(
    Config(),
    basis=BasisConfig(n_eigenfunctions=30),
    descriptors=replace(Config().descriptors, n_eigenfunctions=60, shot_radius=0.15),
    refinement=None,
    search=Search(candidates=1, n_sign_functions=2),
    threads=1,
)
BLOBS = SMALL, 500, 0


def starting(shape: Shape, first: float) -> Shape:
    values = shape.basis.eigenvalues.copy()
    values[0] = first
    return replace(shape, basis=replace(shape.basis, eigenvalues=values))


def poor_maps() -> dict[str, np.ndarray]:
    """Maps that no search should choose, some of which it may meet."""
    rng = np.random.default_rng(0)
    unit = np.eye(K)[0]
    return {
        "zero": np.zeros((K, K)),
        "constants alone": np.outer(unit, unit),
        "everything to constants": np.outer(unit, rng.normal(size=K)),
        "constants to everything": np.outer(rng.normal(size=K), unit),
        "rank one": np.outer(rng.normal(size=K), rng.normal(size=K)),
        "rank five": rng.normal(size=(K, 5)) @ rng.normal(size=(5, K)),
        "noise of constants": np.outer(unit, unit) + 1e-17 * rng.normal(size=(K, K)),
    }


@pytest.mark.parametrize("name", poor_maps())
def test_poor_maps_score_finite_low_and_the_same_whatever_zero_is(shape, name):
    C = poor_maps()[name]
    right = map_quality(np.eye(K), sample_for_scoring(shape, 200), sample_for_scoring(shape, 200))
    found = []
    for first in FIRST:
        judge = sample_for_scoring(starting(shape, first), 200)
        quality = map_quality(C, judge, judge)
        assert np.isfinite(astuple(quality)).all()
        assert quality.score < right.score - 1
        found.append(astuple(quality))
    np.testing.assert_allclose(found[1:], found[:1] * 2, rtol=1e-6, atol=1e-9)


def test_a_map_of_constants_alone_is_as_bad_as_of_unrelated_shapes(shape):
    judge = sample_for_scoring(starting(shape, 0.0), 200)
    quality = map_quality(poor_maps()["constants alone"], judge, judge)
    assert quality.laplacian == 1
    assert quality.orientation == 0


def test_the_order_of_candidates_knows_no_rounding(shape):
    judge = sample_for_scoring(shape, 200)
    maps = {"right": np.eye(K), **poor_maps()}
    for first in FIRST:
        judge = sample_for_scoring(starting(shape, first), 200)
        found = score_maps([Start(*one) for one in maps.items()], build_sample_pair(judge, judge))
        assert distinct_candidates(found, judge)[0].name == "right"
        assert distinct_candidates(found[::-1], judge)[0].name == "right"
    # Symmetric maps tie but for rounding: the one that was found first stays first.
    right = score_maps([Start("right", np.eye(K))], build_sample_pair(judge, judge))[0]
    up = replace(right, quality=replace(right.quality, coverage=right.quality.coverage + 1e-15))
    assert up.score == right.score


def test_a_search_ends_as_ever_whatever_zero_is(shape):
    usual, *others = (search_map(s, s, SMALL) for s in (shape, *(starting(shape, first) for first in FIRST)))
    for found in others:
        np.testing.assert_allclose(abs(found.functional_map), abs(usual.functional_map), atol=1e-6)
        np.testing.assert_allclose(found.scores, usual.scores, atol=1e-6)


def test_a_score_is_finite_where_every_sample_is_a_component_of_its_own():
    rng = np.random.default_rng(0)
    corners = rng.normal(size=(60, 1, 3)) + 0.1 * rng.normal(size=(60, 3, 3))
    soup = Mesh(corners.reshape(-1, 3), np.arange(180).reshape(-1, 3))
    config = replace(SMALL, descriptors=replace(SMALL.descriptors, n_eigenfunctions=30))
    shape = prepare(soup, config)
    assert shape.basis.eigenvalues[-1] < eigenvalue_tolerance(shape.basis)
    judge = subsample(sample_for_scoring(shape, 60), 40)
    assert np.isfinite(astuple(map_quality(np.eye(20), judge, judge))).all()
    for samples in (spectral_samples(shape.basis, 30), stratified_samples(shape.basis, 30)):
        assert len(samples.vertices) > 20
        assert samples.basis.mass.sum() == pytest.approx(shape.basis.mass.sum())


@pytest.mark.parametrize("name", poor_maps())
def test_refinement_starts_from_any_map(shape, name):
    C = poor_maps()[name]
    found = ZoomOut(6, 20, 7)(C, shape.basis, shape.basis)
    assert np.isfinite(found.functional_map).all()
    sampled = spectral_samples(shape.basis, 120).basis
    assert np.isfinite(fit_functional_map(np.zeros(120, dtype=int), shape.basis, sampled, 20)).all()


def test_icp_turns_nothing_that_the_points_say_nothing_of(shape):
    collapsed = np.full(500, 7)
    C = ICP(1)(np.eye(10), shape.basis, shape.basis, points=collapsed).functional_map
    basis = shape.basis.truncate(10)
    image = basis.functions[7] / np.linalg.norm(basis.functions[7])
    np.testing.assert_allclose(C, np.outer(np.sign(basis.functions[0, 0]) * np.eye(10)[0], image), atol=1e-9)


def test_a_solver_returns_finite_values():
    """The operator loses its senses after two steps."""
    calls = []

    def broken(x):
        calls.append(0)
        return x * np.arange(1.0, 5.0) * (1e-320 if len(calls) == 3 else 1.0)

    found = solve(broken, np.ones(4), CG(rtol=1e-12, max_iter=9))
    assert found.status == "breakdown"
    assert np.isfinite(found.value).all()


def test_vertices_in_one_place_are_no_surroundings():
    mesh = blob(200)
    twins = Mesh(np.vstack([mesh.vertices, 5 + 0 * mesh.vertices[:3]]), np.vstack([mesh.faces, [[200, 201, 202]]]))
    points = np.arange(203)
    points[200:] = [3, 90, 150]
    assert not local_confidence(twins, twins, points, np.arange(203))[200:].any()


@pytest.mark.parametrize("how", ["norm", "max", "row", "variance"])
def test_a_constant_descriptor_stays_one(how, rng):
    """Without its mean it is rounding, which must not be blown up to the size of the others."""
    D_s, D_t = rng.normal(size=(50, 9)), rng.normal(size=(40, 9))
    D_s[:, :8] = D_t[:, :8] = np.arange(1, 9) / 7
    found = normalize(D_s, D_t, how, rng.random(50), rng.random(40))
    columns = np.concatenate([part[:, :8] for part in found])
    np.testing.assert_allclose(np.ptp(columns, axis=0), 0, atol=1e-12)
    if how == "variance":
        np.testing.assert_allclose(columns, 0, atol=1e-12)


@pytest.mark.parametrize("kernel", [Gaussian(), Laplacian()])
def test_a_width_is_not_chosen_from_rounding(kernel, rng):
    X = 7 + 1e-15 * rng.normal(size=(30, 4)) + np.array([0.1, 0.2, 0.3, 0.4])
    assert resolve_kernel(kernel, X) == resolve_kernel(kernel, np.ones((30, 4)))


@pytest.mark.parametrize("first", FIRST)
def test_spectra_of_constants_alone(first):
    rng = np.random.default_rng(1)
    basis = replace(random_basis(60, 5, rng), eigenvalues=np.full(5, first))
    energies, sigma = wave_energies(6, basis)
    assert not wave_signature(basis, energies, sigma).any()
    assert np.isfinite(heat_signature(basis, heat_times(6, basis))).all()
    np.testing.assert_allclose(laplacian_term(basis, basis).weights, 0, atol=1e-12)


def test_the_laplacian_term_does_not_tell_zeros_apart():
    rng = np.random.default_rng(1)
    a, b = (replace(random_basis(60, 3, rng), eigenvalues=v * np.ones(3)) for v in (0.0, 1e-14))
    np.testing.assert_allclose(laplacian_term(a, b).weights, 0, atol=1e-12)


def test_constant_features_have_no_orientation(shape):
    constant = np.arange(1, 9) / 7 * (1 + 1e-15 * np.random.default_rng(1).normal(size=(500, 8)))
    bases = shape.basis.truncate(K), shape.basis.truncate(K)
    strongest = principal_features(bases, Features(constant, constant, Gaussian(1.0)), 40)
    pair = orientation_pair((shape, shape), (shape, shape), bases, strongest, K, 50.0)
    term = operator_term(*pair, parity=-1)
    assert value(term, np.random.default_rng(0).normal(size=(K, K))) == 0


def test_multiplication_operators_of_features_that_are_zero(shape):
    nothing, basis = np.zeros((500, 3)), shape.basis.truncate(8)
    for features in truncate_features(basis, nothing, basis, nothing, 1e-3):
        assert features.shape == (500, 0)
    packed = truncate_operators(multiplication_operators(basis, nothing), multiplication_operators(basis, nothing), 0.0)
    term = operator_term(*map(unpack_operators, packed))
    assert value(term, np.ones((8, 8))) == 0


def test_the_zero_level_is_free_of_units(shape):
    basis = shape.basis
    large = Basis(basis.eigenvalues / 1e6, basis.functions / 1e3, basis.mass * 1e6)
    assert eigenvalue_tolerance(large) == pytest.approx(eigenvalue_tolerance(basis) / 1e6)
    assert basis.eigenvalues[0] < 1e-3 * eigenvalue_tolerance(basis) < 1e-3 * basis.eigenvalues[1]
