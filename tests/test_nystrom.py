"""Samplers and the Nyström approximation."""

from itertools import pairwise

import numpy as np
import pytest

from kfmaps._arrays import InvalidInput, KfmapsWarning, to_numpy
from kfmaps.kernels.kernels import Gaussian, Linear, Tanh, kernel_matrix
from kfmaps.kernels.landmark_selection import farthest_descriptors, pivoted_cholesky, uniform
from kfmaps.kernels.nystrom import nystrom

GUARDS = ("kfmaps.kernels.kernels", "kfmaps.kernels.landmark_selection", "kfmaps.kernels.nystrom")


def samplers(X, count, rng=0):
    return {
        "uniform": uniform(len(X), count, rng),
        "farthest": farthest_descriptors(X, count, rng),
        "cholesky": pivoted_cholesky(Gaussian(0.5), X, count, rng=rng),
        "random cholesky": pivoted_cholesky(Gaussian(0.5), X, count, randomised=True, rng=rng),
        "squared cholesky": pivoted_cholesky(Gaussian(0.5), X, count, randomised=True, power=2, rng=rng),
    }


def test_all_points_as_samples_give_the_exact_kernel(asarray, rng):
    X, Y = rng.normal(size=(25, 3)), rng.normal(size=(20, 3))
    both = asarray(np.vstack([X, Y]))
    factor = nystrom(Gaussian(2.0), both)
    W_x, W_y = (to_numpy(factor.features(asarray(D))) for D in (X, Y))
    np.testing.assert_allclose(W_y @ W_x.T, kernel_matrix(Gaussian(2.0), Y, X), atol=1e-9)
    np.testing.assert_allclose(W_x @ W_x.T, kernel_matrix(Gaussian(2.0), X, X), atol=1e-9)


def test_exact_on_the_samples_and_below_the_kernel_elsewhere(rng):
    X = rng.normal(size=(60, 3))
    for rows in samplers(X, 20).values():
        W = nystrom(Gaussian(0.5), X[rows]).features(X)
        error = kernel_matrix(Gaussian(0.5), X, X) - W @ W.T
        np.testing.assert_allclose(error[rows], 0, atol=1e-6)
        assert np.linalg.eigvalsh(error)[0] > -1e-6  # the Schur complement is positive semi-definite


def test_linear_kernel_is_recovered_with_as_many_samples_as_dimensions(rng):
    X = rng.normal(size=(40, 4))
    W = nystrom(Linear(), X[:4]).features(X)
    assert W.shape == (40, 4)
    np.testing.assert_allclose(W @ W.T, X @ X.T, atol=1e-9)


def test_rank_deficiency_is_dropped(rng):
    X = np.repeat(rng.normal(size=(5, 3)), 4, axis=0)
    factor = nystrom(Gaussian(1.0), X)
    assert factor.rank == 5
    W = factor.features(X)
    assert np.isfinite(W).all()
    np.testing.assert_allclose(W @ W.T, kernel_matrix(Gaussian(1.0), X, X), atol=1e-10)


def test_indefinite_kernel_warns_and_stays_finite(rng):
    X = rng.normal(size=(30, 3))
    kernel = Tanh(2.0, -1.0)
    with pytest.warns(KfmapsWarning, match="not positive definite"):
        factor = nystrom(kernel, X)
    assert np.isfinite(factor.features(X)).all()


def test_negative_kernel_is_refused(rng):
    with pytest.raises(InvalidInput, match="positive eigenvalue"):
        nystrom(lambda a, b: -kernel_matrix(Gaussian(1.0), a, b), rng.normal(size=(5, 2)))


def test_features_in_blocks_equal_those_in_one(rng):
    X = rng.normal(size=(50, 3))
    factor = nystrom(Gaussian(1.0), X[:10])
    np.testing.assert_allclose(factor.features(X, block=7), factor.features(X), rtol=1e-8, atol=1e-12)


def test_samples_are_distinct_and_seeded(rng):
    X = rng.normal(size=(60, 3))
    first, again, other = samplers(X, 20, 1), samplers(X, 20, 1), samplers(X, 20, 2)
    for name, rows in first.items():
        assert len(set(rows.tolist())) == 20, name
        np.testing.assert_array_equal(rows, again[name])
        if name != "cholesky":  # the greedy one has no choice
            assert rows.tolist() != other[name].tolist(), name


def test_farthest_points_are_farthest(rng, asarray):
    X = rng.normal(size=(40, 3))
    rows = farthest_descriptors(asarray(X), 12)
    for i in range(1, 12):
        distance = np.linalg.norm(X[:, None] - X[rows[:i]], axis=2).min(axis=1)
        assert distance[rows[i]] == pytest.approx(distance.max())


def test_farthest_points_owe_nothing_to_single_precision(rng, asarray):
    X = rng.normal(size=(300, 5)) + 1e4 * (np.arange(300) % 2)[:, None]
    rows, nearest = farthest_descriptors(asarray(X), 40), np.full(300, np.inf)
    for before, following in pairwise(rows):
        nearest = np.minimum(nearest, ((X - X[before]) ** 2).sum(axis=1))
        assert following == nearest.argmax()


def test_cholesky_pivots_are_the_largest_residuals(rng):
    X = rng.normal(size=(40, 3))
    K = kernel_matrix(Gaussian(0.5), X, X)
    rows = pivoted_cholesky(Gaussian(0.5), X, 10)
    for i in range(1, 10):
        taken = rows[:i]
        residual = np.diag(K - K[:, taken] @ np.linalg.solve(K[np.ix_(taken, taken)], K[taken]))
        assert residual[rows[i]] == pytest.approx(residual.max(), rel=1e-6)


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_random_pivots_are_drawn_in_proportion_to_powers_of_the_residual(power):
    """The power is 1 where none is given."""
    X = np.array([[0.0], [0.1], [0.4], [2.0]])
    how = {"randomised": True, **({} if power == 1.0 else {"power": power})}
    draws = np.array([pivoted_cholesky(Gaussian(0.5), X, 2, rng=i, **how) for i in range(1000)])
    found = np.bincount(4 * draws[:, 0] + draws[:, 1], minlength=16).reshape(4, 4) / len(draws)
    residual = (1 - kernel_matrix(Gaussian(0.5), X, X) ** 2) ** power
    np.testing.assert_allclose(found, residual / residual.sum(axis=1, keepdims=True) / 4, atol=0.04)


def test_samplers_stop_when_nothing_is_left(asarray):
    X = np.repeat(np.eye(3), 5, axis=0)
    assert len(farthest_descriptors(asarray(X), 10)) == 3
    assert len(pivoted_cholesky(Gaussian(1.0), X, 10)) == 3
    assert len(pivoted_cholesky(Gaussian(1.0), X, 10, randomised=True)) == 3


@pytest.mark.parametrize("count", [0, 41, 2.5])
def test_impossible_counts_are_refused(count):
    with pytest.raises(InvalidInput, match="sample count"):
        uniform(40, count)


@pytest.mark.filterwarnings("ignore::kfmaps._arrays.KfmapsWarning")
@pytest.mark.parametrize("spread", [0.3, 1.0])
@pytest.mark.parametrize("dimension", [3, 8])
@pytest.mark.parametrize("rtol", [1e-12, 1e-3])
def test_an_indefinite_kernel_stays_bounded_off_the_samples(spread, dimension, rtol):
    points = spread * np.random.default_rng(0).normal(size=(500, dimension))
    kernel = Tanh()
    values = kernel(points, points)
    eigenvalues, vectors = np.linalg.eigh(values)
    assert eigenvalues[0] < -0.02 * eigenvalues[-1]
    positive = (vectors * np.maximum(eigenvalues, 0)) @ vectors.T
    for count in (60, 200):
        W = nystrom(kernel, points[farthest_descriptors(points, count)], rtol).features(points)
        assert (W**2).sum(axis=1).max() < np.diag(positive).max()
        assert np.linalg.norm(W @ W.T - positive) < 0.4 * np.linalg.norm(positive)
