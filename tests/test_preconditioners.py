"""Both sides of an energy's operator, its diagonal in other bases, and the preconditioners made of them."""

import numpy as np
import pytest

from conftest import random_basis
from kfmaps._arrays import to_numpy
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.full_kernel import hadamard_term
from kfmaps.fmap.preconditioners import jacobi, sylvester
from kfmaps.fmap.solvers import CG, dense_matrix, solve
from kfmaps.fmap.terms import descriptor_term, laplacian_term, operator_term
from kfmaps.kernels.kernels import Gaussian

GUARDS = ("kfmaps.fmap.energy", "kfmaps.fmap.preconditioners", "kfmaps.fmap.terms")

K_T, K_S, R = 5, 6, 4


def orthogonal(rng, k):
    return np.linalg.qr(rng.normal(size=(k, k)))[0]


@pytest.fixture
def terms(rng, asarray, convert):
    bases = random_basis(30, K_S, rng), random_basis(25, K_T, rng)
    source, target = (convert(b) for b in bases)
    W_s, W_t = asarray(rng.normal(size=(30, R))), asarray(rng.normal(size=(25, R)))

    def operators(k, parity):
        X = rng.normal(size=(R, k, k))
        return asarray(X + parity * X.transpose(0, 2, 1))

    return {
        "descriptors": descriptor_term(source, W_s, target, W_t),
        "operators": operator_term(operators(K_S, 1), operators(K_T, 1)),
        "orientation": operator_term(operators(K_S, -1), operators(K_T, -1), parity=-1),
        "hadamard": hadamard_term(Gaussian(0.3), source, W_s, target, W_t, block=7),
        "laplacian": laplacian_term(source, target),
    }


def test_diagonal_in_other_bases_is_that_of_the_rotated_operator(terms, rng, asarray):
    terms["energy"] = Energy(dict(terms), dict.fromkeys(terms, 0.7))
    U_t, U_s = asarray(orthogonal(rng, K_T)), asarray(orthogonal(rng, K_S))
    for name, term in terms.items():
        matrix = dense_matrix(lambda C, t=term: U_t.T @ t.apply(U_t @ C @ U_s.T) @ U_s, (K_T, K_S), U_t)
        found = to_numpy(term.diagonal(U_t, U_s)).ravel()
        np.testing.assert_allclose(found, np.diag(matrix), rtol=1e-9, atol=1e-9, err_msg=name)


def test_sides_are_what_is_left_without_the_coupling(rng):
    """With operators on one side alone the operator is its one-sided part."""
    C = rng.normal(size=(K_T, K_S))

    def symmetric(k):
        X = rng.normal(size=(R, k, k))
        return X + X.transpose(0, 2, 1)

    nothing_t, nothing_s = np.zeros((R, K_T, K_T)), np.zeros((R, K_S, K_S))
    for term in (operator_term(symmetric(K_S), nothing_t), operator_term(nothing_s, symmetric(K_T))):
        S_t, S_s = term.sides()
        np.testing.assert_allclose(S_t @ C + C @ S_s, term.apply(C), rtol=1e-10)


def test_sylvester_solves_what_is_diagonal_in_its_bases_at_once(rng):
    """Without coupling the preconditioner is the exact inverse, and conjugate gradients need one step."""
    source, target = random_basis(30, K_S, rng), random_basis(25, K_T, rng)
    W = rng.normal(size=(30, 9)), rng.normal(size=(25, 9))
    term = descriptor_term(source, W[0], target, W[1])
    energy = Energy({"descriptors": term}, {"descriptors": 3.0})
    found = solve(energy.apply, energy.rhs(), CG(1e-10, 50), preconditioner=sylvester(energy))
    assert found.steps == 1
    np.testing.assert_allclose(energy.apply(found.value), energy.rhs(), rtol=1e-8, atol=1e-10)


def test_preconditioners_are_positive_definite_and_self_adjoint(terms):
    energy = Energy(terms, dict.fromkeys(terms, 1.0))
    example = energy.rhs()
    for operator in (jacobi(energy.diagonal()), sylvester(energy)):
        matrix = dense_matrix(operator, (K_T, K_S), example)
        np.testing.assert_allclose(matrix, matrix.T, atol=1e-12)
        assert np.linalg.eigvalsh(matrix)[0] > 0


def test_entries_that_the_energy_does_not_see_are_left_alone():
    inverse = jacobi(np.array([[4.0, 0.0]]))
    np.testing.assert_array_equal(inverse(np.array([[8.0, 3.0]])), [[2.0, 3.0]])
