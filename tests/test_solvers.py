"""Conjugate gradients against a dense solve, and how they say that they stopped."""

import numpy as np
import pytest

from kfmaps._arrays import InvalidInput, to_numpy
from kfmaps.fmap.solvers import CG, Direct, dense_matrix, solve

GUARDS = ("kfmaps.fmap.solvers",)


def system(rng, shape=(4, 5), rank=None):
    size = int(np.prod(shape))
    half = rng.normal(size=(size, rank or size + 3))
    matrix = half @ half.T
    return matrix, lambda X: (matrix @ X.reshape(-1)).reshape(shape)


def test_cg_equals_a_dense_solve(rng):
    matrix, apply = system(rng)
    b = rng.normal(size=(4, 5))
    wanted = np.linalg.solve(matrix, b.ravel()).reshape(4, 5)
    found = solve(apply, b, CG(rtol=1e-12, max_iter=500))
    assert found.status == "converged"
    np.testing.assert_allclose(found.value, wanted, rtol=1e-6)
    assert len(found.residuals) == found.steps + 1
    assert np.linalg.norm(b - apply(found.value)) <= 1e-10 * np.linalg.norm(b)
    np.testing.assert_allclose(solve(apply, b, Direct()).value, wanted, rtol=1e-6)


def test_preconditioning_keeps_the_answer_and_saves_steps(rng):
    scale = np.logspace(0, 5, 60)
    half = rng.normal(size=(60, 60)) / 60
    matrix = np.diag(scale) + np.sqrt(np.outer(scale, scale)) * (half @ half.T)
    b = rng.normal(size=60)
    plain = solve(lambda x: matrix @ x, b, CG(rtol=1e-10, max_iter=5000))
    better = solve(lambda x: matrix @ x, b, CG(rtol=1e-10, max_iter=5000), preconditioner=lambda r: r / scale)
    np.testing.assert_allclose(better.value, plain.value, rtol=1e-5)
    assert better.steps < plain.steps / 3


def test_the_same_on_every_array_library(asarray, rng):
    diagonal, b = rng.uniform(1, 9, size=(3, 4)), rng.normal(size=(3, 4))
    weights = asarray(diagonal)
    found = solve(lambda C: weights * C, asarray(b), CG(rtol=1e-13, max_iter=50))
    np.testing.assert_allclose(to_numpy(found.value), b / diagonal, rtol=1e-9)


def test_ten_steps_are_ten_steps(rng):
    _, apply = system(rng)
    calls = []

    def counted(X):
        calls.append(1)
        return apply(X)

    found = solve(counted, rng.normal(size=(4, 5)), CG(rtol=0.0, max_iter=10))
    assert (found.status, found.steps, len(calls)) == ("step limit", 10, 10)


def test_finite_termination_without_rounding():
    values = np.repeat([1.0, 4.0, 9.0], 5)
    found = solve(lambda x: values * x, np.ones(15), CG(rtol=1e-13, max_iter=100))
    assert (found.status, found.steps) == ("converged", 3)


def test_a_good_start_and_a_zero_right_side_cost_no_step(rng):
    matrix, apply = system(rng)
    b = rng.normal(size=(4, 5))
    assert solve(apply, b, CG(rtol=1e-6), x0=np.linalg.solve(matrix, b.ravel()).reshape(4, 5)).steps == 0
    found = solve(apply, 0 * b, CG())
    assert (found.status, found.steps) == ("converged", 0)
    assert not found.value.any()


@pytest.mark.parametrize("operator", [lambda x: -x, lambda x: 0 * x, lambda x: np.nan * x])
def test_breakdown_is_said(operator):
    found = solve(operator, np.ones(3), CG())
    assert found.status == "breakdown"
    assert np.isfinite(found.value).all()


def test_direct_gives_the_least_squares_answer_of_a_singular_system(rng):
    matrix, apply = system(rng, rank=7)
    b = apply(rng.normal(size=(4, 5)))
    found = solve(apply, b, Direct())
    np.testing.assert_allclose(apply(found.value), b, rtol=1e-8, atol=1e-8)
    assert np.linalg.norm(found.value) <= np.linalg.norm(np.linalg.pinv(matrix) @ b.ravel()) * (1 + 1e-8)


def test_dense_is_the_matrix(rng):
    matrix, apply = system(rng)
    np.testing.assert_allclose(dense_matrix(apply, (4, 5), np.zeros((4, 5))), matrix)


@pytest.mark.parametrize(
    "make",
    [
        lambda: CG(rtol=-1.0),
        lambda: CG(rtol=0.0, max_iter=None),
        lambda: CG(max_iter=0),
        lambda: Direct(0),
        lambda: solve(lambda x: x, np.ones(50), Direct(limit=10)),
    ],
)
def test_solvers_that_could_not_work_are_refused(make):
    with pytest.raises(InvalidInput, match=r"expected .* got .*"):
        make()
