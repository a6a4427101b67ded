"""The whole match: invariances, agreement of its forms, and what it refuses."""

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest
from sklearn.metrics.pairwise import rbf_kernel

from conftest import blob, reordered, rotation, small_fit
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.config import (
    BasisConfig,
    Config,
    DescriptorConfig,
    NystromConfig,
    Sampling,
    Weights,
    from_dict,
)
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.solvers import CG, Direct, dense_matrix
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import load_map
from kfmaps.kernels.kernels import Gaussian, Linear, Polynomial, Product, Sum
from kfmaps.matching.assemble import assemble
from kfmaps.matching.features import pair_descriptors
from kfmaps.matching.fit import check_landmark_pairs
from kfmaps.matching.match import match
from kfmaps.shape import prepare

GUARDS = ("kfmaps.config", "kfmaps.fmap.energy", "kfmaps.matching", "kfmaps.shape")

SMALL = small_fit(20, 12, 40, 60, operator_rtol=0.0, solver=CG(rtol=1e-8, max_iter=2000), refinement=ZoomOut(12, 40, 6))
BLOBS = SMALL, 400, 360
RAW = replace(SMALL, refinement=None)
NO_DESCRIPTORS = DescriptorConfig(signature="none", landmark_descriptor="none", shot=False)
MARKS = np.array([3, 100, 250, 390])


@pytest.fixture(scope="module")
def landmark_vertices(truth):
    """Corresponding vertices of the two meshings of one shape."""
    target = np.array([5, 90, 200, 300, 350])
    return np.stack([truth[target], target], axis=1)


@pytest.fixture(scope="module")
def plain(shape, other, landmark_vertices):
    """The match of the two, which some changes leave as it is."""
    return match(shape, other, SMALL, landmarks=landmark_vertices)


def energy_of(shape, other, config, landmark_vertices, bases=None):
    bases = bases or (shape.basis, other.basis)
    used = pair_descriptors(shape, other, bases, config.descriptors, landmark_vertices, None)
    return assemble(shape, other, bases, used, config, np.random.default_rng(0)).energy


def test_two_meshings_match(shape, other, plain):
    moved = shape.mesh.vertices[plain.target_to_source] - other.mesh.vertices
    assert np.linalg.norm(moved, axis=1).mean() < 0.04
    assert plain.functional_map.shape == (40, 40)
    assert plain.fit.status == "converged"
    assert plain.fit.energies.keys() == {"descriptors", "commutativity", "laplacian"}
    assert min(plain.fit.energies.values()) >= 0


def test_permuted_vertices_permute_the_answer(shape, rng):
    order = rng.permutation(400)
    landmark_vertices = np.stack([MARKS, np.argsort(order)[MARKS]], axis=1)
    found = match(shape, reordered(blob(400), order), SMALL, landmarks=landmark_vertices)
    np.testing.assert_array_equal(found.target_to_source, order)
    np.testing.assert_array_equal(found.fit.raw_target_to_source, order)
    assert found.local_confidence == pytest.approx(1)


def test_rigid_motion_and_units_change_nothing(shape, landmark_vertices, plain):
    mesh = blob(360, twist=0.4)
    moved = Mesh(1000 * mesh.vertices @ rotation(1).T + [5e3, -2e3, 1e3], mesh.faces)
    found = match(shape, prepare(moved, SMALL), RAW, landmarks=landmark_vertices)
    assert (found.target_to_source == plain.fit.raw_target_to_source).mean() > 0.99
    maps = [np.abs(one.fit.raw_functional_map) for one in (found, plain)]
    np.testing.assert_allclose(maps[0], maps[1], atol=1e-4)


def test_flipped_signs_of_eigenvectors_change_nothing(shape, other, landmark_vertices, plain, rng):
    signs = np.where(rng.random(40) < 0.5, -1.0, 1.0)
    flipped = replace(other, basis=Basis(other.basis.eigenvalues, other.basis.functions * signs, other.basis.mass))
    found = match(shape, flipped, SMALL, landmarks=landmark_vertices)
    np.testing.assert_array_equal(found.target_to_source, plain.target_to_source)
    np.testing.assert_allclose(found.functional_map, signs[:, None] * plain.functional_map, atol=1e-6)


@pytest.mark.parametrize("sampling", get_args(Sampling))
def test_operator_is_symmetric_positive_under_every_sampling(sampling, shape, other, landmark_vertices):
    small = replace(RAW, basis=BasisConfig(n_eigenfunctions=6), nystrom=NystromConfig(samples=30, sampling=sampling))
    energy = energy_of(shape, other, small, landmark_vertices)
    matrix = dense_matrix(energy.apply, (6, 6), np.zeros((6, 6)))
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-10 * np.abs(matrix).max())
    assert np.linalg.eigvalsh(matrix)[0] > 0
    np.testing.assert_allclose(np.diag(matrix).reshape(6, 6), energy.diagonal(), rtol=1e-8)


def test_linear_kernel_is_no17_and_the_exact_form_agrees(shape, other, landmark_vertices, rng):
    config = replace(RAW, kernel=Linear(), basis=BasisConfig(n_eigenfunctions=8))
    C = rng.normal(size=(8, 8))
    features = energy_of(shape, other, config, landmark_vertices)
    exact = energy_of(shape, other, replace(config, full_kernel=True), landmark_vertices)
    np.testing.assert_allclose(features.apply(C), exact.apply(C), rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(features.rhs(), exact.rhs(), rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(features.diagonal(), exact.diagonal(), rtol=1e-9, atol=1e-9)


def test_conjugate_gradients_equal_the_dense_solve(shape, other, landmark_vertices):
    config = replace(RAW, basis=BasisConfig(n_eigenfunctions=8))
    iterated = match(shape, other, config, landmarks=landmark_vertices)
    direct = match(shape, other, replace(config, solver=Direct()), landmarks=landmark_vertices)
    np.testing.assert_allclose(iterated.fit.raw_functional_map, direct.fit.raw_functional_map, atol=1e-5)
    plain = match(shape, other, replace(config, preconditioner="none"), landmarks=landmark_vertices)
    np.testing.assert_allclose(plain.fit.raw_functional_map, direct.fit.raw_functional_map, atol=1e-4)


def test_truncation_hardly_changes_the_result(shape, other, landmark_vertices, plain):
    fewer = match(shape, other, replace(RAW, operator_rtol=1e-5), landmarks=landmark_vertices)
    assert (fewer.fit.n_operators or 99) < plain.fit.n_operators
    np.testing.assert_allclose(fewer.fit.raw_functional_map, plain.fit.raw_functional_map, atol=0.01)


@pytest.mark.parametrize(
    "kernel",
    [
        Sum(Linear(), Product(Gaussian(), Polynomial(2, 0.5))),
        lambda X, Y: rbf_kernel(X, Y, gamma=0.2),
    ],
    ids=["sum and product", "scikit-learn"],
)
def test_other_kernels_match_too(kernel, shape, other, landmark_vertices):
    found = match(shape, other, replace(SMALL, kernel=kernel), landmarks=landmark_vertices)
    moved = shape.mesh.vertices[found.target_to_source] - other.mesh.vertices
    assert np.linalg.norm(moved, axis=1).mean() < 0.05


def test_descriptors_of_the_users_own(shape, other):
    config = replace(RAW, descriptors=NO_DESCRIPTORS)
    found = match(shape, other, config, descriptors=(shape.mesh.vertices, other.mesh.vertices))
    moved = shape.mesh.vertices[found.target_to_source] - other.mesh.vertices
    assert np.linalg.norm(moved, axis=1).mean() < 0.06
    assert found.verdict == "unchecked"


def test_the_same_seed_gives_the_same_answer(shape, other, landmark_vertices, plain):
    for seed, same in ((0, True), (6, False)):
        found = match(shape, other, RAW, landmarks=landmark_vertices, rng=seed)
        assert np.array_equal(found.fit.raw_functional_map, plain.fit.raw_functional_map) == same


def test_progress_goes_from_start_to_end(shape, other, landmark_vertices):
    calls = []
    match(shape, other, SMALL, landmarks=landmark_vertices, progress=lambda stage, done: calls.append((stage, done)))
    for stage in ("descriptors", "energy", "solve", "point map", "refinement"):
        done = [d for s, d in calls if s == stage]
        assert done[0] == 0.0
        assert done[-1] == 1.0
        assert done == sorted(done)
    assert any(0 < d < 0.5 for stage, d in calls if stage == "solve")


def test_paper_settings_do_ten_plain_steps(shape, other, landmark_vertices):
    paper = replace(
        Config.paper(),
        basis=BasisConfig(n_eigenfunctions=15),
        descriptors=replace(Config.paper().descriptors, n_eigenfunctions=40),
    )
    found = match(shape, other, paper, landmarks=landmark_vertices)
    assert (found.fit.status, found.fit.steps) == ("step limit", 10)
    assert found.fit.kernel.startswith("Gaussian")


def test_obcs12_leaves_commutativity_out():
    assert Config.obcs12().weights.commutativity == 0
    assert Config.no17().weights.commutativity == 1
    assert isinstance(Config.no17().kernel, Linear)


@pytest.mark.parametrize(
    "landmarks",
    [[[0, 0], [0, 1]], [[0, 5], [1, 5]], [[-1, 0]], [[0, 360]], [[400, 0]], [[0.5, 1.0]], [[1, 2, 3]], [1, 2]],
)
def test_bad_landmarks_are_refused(landmarks, shape, other):
    with pytest.raises(InvalidInput, match=r"landmarks.*expected .* got"):
        check_landmark_pairs(np.asarray(landmarks), shape, other)


def test_bad_descriptors_are_refused(shape, other, landmark_vertices):
    good = np.ones((360, 2))
    for given in ((np.ones((399, 2)), good), (np.ones((400, 3)), good), (np.full((400, 2), np.nan), good)):
        with pytest.raises(InvalidInput):
            match(shape, other, RAW, landmarks=landmark_vertices, descriptors=given)
    with pytest.raises(InvalidInput, match="at least one"):
        match(shape, other, replace(RAW, descriptors=NO_DESCRIPTORS))


def test_shapes_prepared_otherwise_are_refused(shape, other, landmark_vertices):
    for config, wanted in (
        (replace(SMALL, basis=BasisConfig(n_eigenfunctions=50)), "50 eigenfunctions"),
        (replace(SMALL, basis=replace(SMALL.basis, laplacian="cotangent")), "cotangent Laplacian"),
        (replace(SMALL, descriptors=replace(SMALL.descriptors, shot=True, shot_radius=0.2)), "SHOT of radius 0.2"),
    ):
        with pytest.raises(InvalidInput, match=wanted):
            match(shape, other, config, landmarks=landmark_vertices)


def test_a_breakdown_is_told(shape, other, landmark_vertices, monkeypatch):
    monkeypatch.setattr(Energy, "apply", lambda _energy, C: -C)
    with pytest.warns(KfmapsWarning, match="broke down"):
        found = match(shape, other, RAW, landmarks=landmark_vertices)
    assert found.fit.status == "breakdown"


def test_meshes_that_cannot_be_matched_are_refused():
    with pytest.raises(InvalidInput, match="more than 40"):
        prepare(blob(40), SMALL)
    broken = blob(100)
    broken.vertices[3] = np.nan
    with pytest.raises(InvalidInput, match="NaN"):
        prepare(broken, SMALL)
    with pytest.raises(InvalidInput, match="zero area"):
        prepare(Mesh(np.zeros((50, 3)), blob(50).faces), SMALL)
    with pytest.raises(InvalidInput, match="from 0 to 99"):
        prepare(Mesh(blob(100).vertices, blob(100).faces + 1), SMALL)


@pytest.mark.parametrize(
    "values",
    [
        {"nonsense": 1},
        {"weights": {"nonsense": 1}},
        {"weights": 3},
        {"kernel": {"kind": "Nonsense"}},
        {"kernel": {"kind": "Gaussian", "width": 1}},
        {"kernel": {"kind": "callable", "name": "f"}},
        {"basis": {"n_eigenfunctions": 1}},
        {"nystrom": {"sampling": "nonsense"}},
        {"descriptors": {"normalisation": "nonsense"}},
        {"weights": {"laplacian": -1.0}},
        {"preconditioner": "nonsense"},
        {"operator_rtol": 1.0},
    ],
)
def test_impossible_settings_are_refused(values):
    with pytest.raises(InvalidInput, match=r"expected .* got"):
        from_dict(values)


def test_weights_reach_the_energy(shape, other, landmark_vertices, rng):
    C = rng.normal(size=(20, 20))
    config = replace(RAW, weights=Weights(descriptors=2.0, commutativity=3.0, laplacian=5.0, orientation=7.0))
    energy = energy_of(shape, other, config, landmark_vertices)
    assert energy.weights == {"descriptors": 2.0, "commutativity": 3.0, "laplacian": 5.0, "orientation": 7.0}
    parts = energy.breakdown(C)
    assert min(parts.values()) > 0


def test_energies_of_a_match_are_those_of_its_fit(plain, tmp_path):
    """At the minimiser the energy that is assembled anew has the values of the fit, and elsewhere greater ones."""
    values = plain.energies(plain.fit.raw_functional_map)
    assert values == pytest.approx(plain.fit.energies)
    assert sum(plain.energies(np.eye(20)).values()) > sum(values.values())
    with pytest.raises(InvalidInput, match="functional map"):
        plain.energies(np.eye(5))
    plain.save(tmp_path / "m.npz")
    with pytest.raises(InvalidInput, match="energies: expected a match of whole shapes"):
        load_map(tmp_path / "m.npz").energies()
