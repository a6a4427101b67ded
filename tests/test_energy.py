"""The laws that every energy term must keep, on every array library, and the preconditioners made of them."""

import numpy as np
import pytest

from conftest import random_basis
from kfmaps._arrays import InvalidInput, inner, to_numpy
from kfmaps._threads import limit_threads
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.full_kernel import hadamard_term, kernel_descriptor_term
from kfmaps.fmap.multiplication_operators import multiplication_operators, truncate_operators, unpack_operators
from kfmaps.fmap.preconditioners import jacobi, sylvester
from kfmaps.fmap.solvers import CG, dense_matrix, solve
from kfmaps.fmap.terms import adjoint_term, descriptor_term, inverse_term, laplacian_term, operator_term, value
from kfmaps.kernels.kernels import Gaussian, Linear, Polynomial
from kfmaps.kernels.nystrom import nystrom

GUARDS = ("kfmaps.fmap", "kfmaps.kernels.nystrom")

N_S, N_T, K_S, K_T, D = 30, 25, 6, 5, 4


def explicit_slices(basis, W):
    return np.stack([(basis.functions * (basis.mass * w)[:, None]).T @ basis.functions for w in W.T])


@pytest.fixture
def case(rng):
    source, target = random_basis(N_S, K_S, rng), random_basis(N_T, K_T, rng)
    return source, target, rng.normal(size=(N_S, D)), rng.normal(size=(N_T, D)), rng.normal(size=(K_T, K_S))


def antisymmetric(rng, r, k):
    X = rng.normal(size=(r, k, k))
    return X - X.transpose(0, 2, 1)


def make(name, case, asarray, convert):
    """A term and the function of C whose squared norm, halved, is its value (None where there is none)."""
    source, target, W_s, W_t, _ = case
    S, T, A_s, A_t = convert(source), convert(target), asarray(W_s), asarray(W_t)
    rng = np.random.default_rng(3)
    if name == "descriptors":
        P_s, P_t = source.project(W_s), target.project(W_t)
        return descriptor_term(S, A_s, T, A_t), lambda C: C @ P_s - P_t
    if name == "kernel descriptors":
        return kernel_descriptor_term(Gaussian(0.3), S, A_s, T, A_t, block=7), None
    if name == "operators":
        X_s, X_t = explicit_slices(source, W_s), explicit_slices(target, W_t)
        term = operator_term(
            unpack_operators(multiplication_operators(S, A_s)), unpack_operators(multiplication_operators(T, A_t))
        )
        return term, lambda C: C @ X_s - X_t @ C
    if name == "antisymmetric operators":
        X_s, X_t = antisymmetric(rng, 3, K_S), antisymmetric(rng, 3, K_T)
        return operator_term(asarray(X_s), asarray(X_t), parity=-1), lambda C: C @ X_s - X_t @ C
    if name == "hadamard":
        return hadamard_term(Gaussian(0.3), S, A_s, T, A_t, block=7), None
    if name == "laplacian":
        L_s, L_t = np.diag(source.eigenvalues), np.diag(target.eigenvalues)
        return laplacian_term(S, T, scale=1.0), lambda C: C @ L_s - L_t @ C
    if name == "resolvent":
        resolvents = [1 / (b.eigenvalues**0.7 - 1j) for b in (source, target)]
        residual = lambda C: np.abs(C * resolvents[0][None, :] - resolvents[1][:, None] * C)  # noqa: E731
        return laplacian_term(S, T, scale=1.0, mask="resolvent", power=0.7), residual
    if name in ("inverse", "adjoint"):
        D = rng.normal(size=(K_S, K_T))
        if name == "adjoint":
            return adjoint_term(asarray(D)), lambda C: C - D.T
        pair = lambda C: np.concatenate([(C @ D - np.eye(K_T)).ravel(), (D @ C - np.eye(K_S)).ravel()])  # noqa: E731
        return inverse_term(asarray(D)), pair
    parts = {n: make(n, case, asarray, convert) for n in ("descriptors", "operators", "laplacian")}
    weights = {"descriptors": 2.0, "operators": 0.5, "laplacian": 0.0}

    def residual(C):
        return np.concatenate([np.sqrt(weights[n]) * f(C).ravel() for n, (_, f) in parts.items() if f is not None])

    return Energy({n: term for n, (term, _) in parts.items()}, weights), residual


TERMS = ["descriptors", "kernel descriptors", "operators", "antisymmetric operators", "hadamard", "laplacian", "energy"]
TERMS += ["resolvent", "inverse", "adjoint"]


@pytest.mark.parametrize("name", TERMS)
def test_laws(name, case, asarray, convert, rng):
    term, residual = make(name, case, asarray, convert)
    C, E = rng.normal(size=(K_T, K_S)), rng.normal(size=(K_T, K_S))
    a, b = asarray(C), asarray(E)
    # linear and self-adjoint
    np.testing.assert_allclose(
        to_numpy(term.apply(2.0 * a + b)), 2 * to_numpy(term.apply(a)) + to_numpy(term.apply(b)), rtol=1e-9, atol=1e-9
    )
    assert inner(a, term.apply(b)) == pytest.approx(inner(b, term.apply(a)), rel=1e-10)
    # positive semi-definite, with the diagonal that it says
    matrix = dense_matrix(term.apply, (K_T, K_S), a)
    values = np.linalg.eigvalsh((matrix + matrix.T) / 2)
    assert values[0] > -1e-10 * values[-1]
    np.testing.assert_allclose(to_numpy(term.diagonal()).ravel(), np.diag(matrix), rtol=1e-9, atol=1e-9)
    # the value is half the squared residual, never negative
    if residual is not None:
        assert value(term, a) == pytest.approx(0.5 * np.sum(residual(C) ** 2), rel=1e-10)
    assert value(term, a) >= 0
    # A(C) - B is the gradient
    h = 1e-5
    slope = (value(term, a + h * b) - value(term, a - h * b)) / (2 * h)
    assert slope == pytest.approx(inner(term.apply(a) - term.rhs(), b), rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("parity", [1, -1])
def test_multiplication_operators_in_single_precision(parity, rng):
    """Only the products that couple both sides are rounded; conjugate gradients reach 1e-6 of the right-hand side."""
    S = [X + parity * X.transpose(0, 2, 1) for X in (rng.normal(size=(6, k, k)) for k in (K_S, K_T))]
    rounded, exact = (operator_term(*S, parity=parity, single=single) for single in (True, False))
    C = rng.normal(size=(K_T, K_S))
    error, coupling = rounded.apply(C) - exact.apply(C), sum(t @ C @ s for s, t in zip(*S, strict=True))
    assert 1e-9 < np.linalg.norm(error) / np.linalg.norm(coupling) < 5e-7
    for a, b in zip(rounded.sides(), exact.sides(), strict=True):
        np.testing.assert_array_equal(a, b)
    found = solve(rounded.apply, C, CG(rtol=1e-6))
    assert np.linalg.norm(exact.apply(found.value) - C) < 1.1e-6 * np.linalg.norm(C)


@pytest.mark.parametrize("kernel", [Linear(), Polynomial(2, 0.5), Gaussian(0.4)], ids=repr)
def test_hadamard_form_equals_multiplication_operators_of_the_features(kernel, case):
    """Equations (10) to (12): with all points as samples the features give the exact kernel."""
    source, target, P_s, P_t, C = case
    factor = nystrom(kernel, np.vstack([P_s, P_t]), rtol=1e-14)
    W_s, W_t = factor.features(P_s), factor.features(P_t)
    operators = operator_term(explicit_slices(source, W_s), explicit_slices(target, W_t))
    hadamard = hadamard_term(kernel, source, P_s, target, P_t, block=11)
    np.testing.assert_allclose(operators.apply(C), hadamard.apply(C), rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(operators.diagonal(), hadamard.diagonal(), rtol=1e-6, atol=1e-7)
    features = descriptor_term(source, W_s, target, W_t)
    exact = kernel_descriptor_term(kernel, source, P_s, target, P_t, block=11)
    np.testing.assert_allclose(features.apply(C), exact.apply(C), rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(features.rhs(), exact.rhs(), rtol=1e-6, atol=1e-7)
    assert features.constant() == pytest.approx(exact.constant(), rel=1e-6)


def test_multiplication_operators_are_packed_and_unpacked(case, asarray, convert):
    source, _, W, _, _ = case
    packed = multiplication_operators(convert(source), asarray(W), block=4)
    wanted = explicit_slices(source, W)
    np.testing.assert_allclose(to_numpy(unpack_operators(packed)), wanted, rtol=1e-10, atol=1e-12)
    gram = to_numpy(packed @ packed.T)
    np.testing.assert_allclose(gram, np.einsum("iab,jab->ij", wanted, wanted), rtol=1e-10)
    with limit_threads(3):
        threaded = multiplication_operators(source, W, block=4)
    np.testing.assert_allclose(threaded, to_numpy(packed), rtol=1e-10, atol=1e-13)
    single = multiplication_operators(source, W, block=4, single=True)
    off = np.abs(single - threaded).max() / np.abs(threaded).max()
    assert single.dtype == np.float64
    assert 0.0 < off < 4 * 6e-8


def test_truncation_is_exact_for_redundant_features_and_bounded_otherwise(case, rng):
    source, target, W_s, W_t, C = case
    mix = rng.normal(size=(D, 9))
    redundant = [multiplication_operators(b, W @ mix) for b, W in ((source, W_s), (target, W_t))]
    small = truncate_operators(*redundant, rtol=0.0)
    assert small[0].shape[0] == D
    whole, fewer = (operator_term(*(unpack_operators(p) for p in pair)) for pair in (redundant, small))
    np.testing.assert_allclose(fewer.apply(C), whole.apply(C), rtol=1e-9, atol=1e-9)
    lossy = truncate_operators(*redundant, rtol=0.4)
    assert lossy[0].shape[0] < D
    total, kept = (sum(float((p**2).sum()) for p in pair) for pair in (redundant, lossy))
    assert 0.6 * total <= kept < 0.999 * total


def test_automatic_scale_makes_alpha_free_of_units(case):
    source, target, *_ = case
    weights = laplacian_term(source, target).weights
    assert weights.max() <= 1
    scaled = [type(b)(b.eigenvalues * 1e6, b.functions, b.mass) for b in (source, target)]
    np.testing.assert_allclose(laplacian_term(*scaled).weights, weights)


def test_breakdown_adds_up_and_skips_weight_zero(case, asarray, convert):
    energy, _ = make("energy", case, asarray, convert)
    C = asarray(case[-1])
    parts = energy.breakdown(C)
    assert parts["laplacian"] == 0.0
    assert sum(parts.values()) == pytest.approx(value(energy, C))


def test_bad_energies_are_refused(case):
    source, target, W_s, W_t, _ = case
    term = laplacian_term(source, target)
    for weights in ({"a": -1.0}, {"a": np.nan}, {"a": 0.0}, {"b": 1.0}):
        with pytest.raises(InvalidInput, match="expected"):
            Energy({"a": term}, weights)
    with pytest.raises(InvalidInput, match="same number on both shapes"):
        descriptor_term(source, W_s, target, W_t[:, :-1])
    with pytest.raises(InvalidInput, match="parity"):
        operator_term(np.zeros((1, 2, 2)), np.zeros((1, 2, 2)), parity=0)
    with pytest.raises(InvalidInput, match="as many operators"):
        operator_term(np.zeros((2, 2, 2)), np.zeros((1, 2, 2)))


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
