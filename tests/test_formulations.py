"""Laws of what a fit may be beside least squares: constraint, robust and sparse losses, both directions, coupled bases.

On small random problems with every array library; the whole match is in test_formulations_fit.py.
"""

from dataclasses import replace

import numpy as np
import pytest

from conftest import random_basis
from kfmaps._arrays import InvalidInput, inner, to_numpy
from kfmaps.config import FORMULATIONS, Config
from kfmaps.fmap.constraints import _next_direction, _tangent, minimize_orthogonal, nearest_orthogonal
from kfmaps.fmap.coupled import RotatedPenalty, RotatedTerm, couple_bases
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.losses import _LOSSES, Loss, RobustData, sparse_penalty
from kfmaps.fmap.minimize import (
    MinimizeOptions,
    Objective,
    fit_bidirectional,
    minimize,
)
from kfmaps.fmap.multiplication_operators import multiplication_operators, unpack_operators
from kfmaps.fmap.optimal_transport import _costs, _transport, transport_penalty
from kfmaps.fmap.solvers import CG, Direct, solve
from kfmaps.fmap.terms import descriptor_term, laplacian_term, operator_term, value
from kfmaps.fmap.transfer import transfer_functions
from kfmaps.geometry.basis import Basis
from kfmaps.kernels.kernels import Linear

GUARDS = ("kfmaps.fmap", "kfmaps.config")

N, R = 60, 9
SIZES = [(6, 6), (7, 5), (5, 7)]
TIGHT = MinimizeOptions(CG(rtol=1e-8, max_iter=500), max_outer_iter=20)


def bases(k_t, k_s, seed=0):
    rng = np.random.default_rng(seed)
    return random_basis(N, k_s, rng), random_basis(N, k_t, rng)


def features(seed=1):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(N, R)), rng.normal(size=(N, R))


def operators(basis, F):
    return unpack_operators(multiplication_operators(basis, F))


def energy(source, target, F_s, F_t):
    terms = {
        "descriptors": descriptor_term(source, F_s, target, F_t),
        "commutativity": operator_term(operators(source, F_s), operators(target, F_t)),
        "laplacian": laplacian_term(source, target),
    }
    return Energy(terms, {"descriptors": 3.0, "commutativity": 0.5, "laplacian": 1.0})


def case_of(sizes, library="numpy"):
    """Bases, features and energy of sizes (k_t, k_s) in an array library."""
    asarray = pytest.importorskip(library).asarray
    source, target = (Basis(*(asarray(a) for a in (b.eigenvalues, b.functions, b.mass))) for b in bases(*sizes))
    F_s, F_t = (asarray(F) for F in features())
    return source, target, F_s, F_t, energy(source, target, F_s, F_t)


@pytest.fixture(
    params=[(s, "numpy") for s in SIZES] + [(s, "array_api_strict") for s in SIZES[1:]] + [(SIZES[1], "torch")], ids=str
)
def case(request):
    return case_of(*request.param)


@pytest.fixture(params=SIZES, ids=str)
def numbers(request):
    """For laws that take many steps."""
    return case_of(request.param)


def is_orthonormal(C):
    C = to_numpy(C)
    gram = C.T @ C if C.shape[0] >= C.shape[1] else C @ C.T
    return np.allclose(gram, np.eye(len(gram)), atol=1e-10)


def test_orthogonal_minimiser_meets_constraint_and_first_order_condition(case):
    *_, E = case
    start = 0.0 * E.rhs() + 1.0
    found = minimize_orthogonal(E, CG(rtol=1e-9, max_iter=500), E.rhs() + 0.1 * start)
    assert found.status == "converged"
    assert is_orthonormal(found.value)
    # On the manifold the gradient is normal: G = C S with S symmetric (or S C, for more columns than rows).
    C, G = to_numpy(found.value), to_numpy(E.apply(found.value) - E.rhs())
    S = C.T @ G if C.shape[0] >= C.shape[1] else G @ C.T
    scale = float(np.linalg.norm(to_numpy(E.rhs())))
    np.testing.assert_allclose(S, S.T, atol=1e-7 * scale)
    np.testing.assert_allclose(C @ S if C.shape[0] >= C.shape[1] else S @ C, G, atol=1e-7 * scale)
    assert len(found.residuals) == found.steps + 1


def test_energy_never_rises_on_the_manifold(case):
    *_, E = case
    values = []
    C = E.rhs()
    for steps in (1, 2, 3, 5, 8, 13):
        values.append(value(E, minimize_orthogonal(E, CG(rtol=0.0, max_iter=steps), C).value))
    assert value(E, nearest_orthogonal(C)) >= values[0]
    assert (np.diff(values) <= 1e-12 * values[0]).all()
    # and no orthonormal map near the last one is lower
    last = minimize_orthogonal(E, CG(rtol=1e-9, max_iter=500), C).value
    rng = np.random.default_rng(5)
    for _ in range(20):
        near = nearest_orthogonal(last + (last * 0.0 + 1.0) * float(rng.normal()) * 1e-2 + 1e-2 * E.rhs())
        assert value(E, near) >= value(E, last) * (1 - 1e-12)


def test_orthogonal_agrees_with_procrustes(case):
    """With descriptors alone and a square map the answer is known: the polar factor of the right-hand side."""
    source, target, F_s, F_t, E = case
    if E.rhs().shape[0] < E.rhs().shape[1]:
        return  # ‖C P‖ depends on C
    term = descriptor_term(source, F_s, target, F_t)
    found = minimize_orthogonal(term, CG(rtol=1e-12, max_iter=2000), term.rhs() + 0.3)
    np.testing.assert_allclose(to_numpy(found.value), to_numpy(nearest_orthogonal(term.rhs())), atol=1e-6)


class _Linear:
    """An energy ``−⟨B, C⟩`` without a quadratic part, whose least orthonormal map is the polar factor of ``B``."""

    def __init__(self, B):
        self.B = B

    def apply(self, C):
        return 0.0 * C

    def rhs(self):
        return self.B


@pytest.mark.parametrize("size", [(7, 5), (5, 7)], ids=str)
def test_where_the_energy_bends_down_the_minimum_is_found_too(size):
    for seed in range(3):
        B, start = np.random.default_rng(seed).normal(size=(2, *size))
        found = minimize_orthogonal(_Linear(B), CG(rtol=1e-10, max_iter=500), start)  # type: ignore[arg-type]
        assert found.status == "converged"
        np.testing.assert_allclose(found.value, nearest_orthogonal(B), atol=1e-8)


def test_tangent_is_a_projection(case):
    *_, E = case
    C, G = nearest_orthogonal(E.rhs()), E.apply(E.rhs()) + 1.0
    once = _tangent(C, G)
    np.testing.assert_allclose(to_numpy(_tangent(C, once)), to_numpy(once), atol=1e-9)
    assert inner(G - once, once) == pytest.approx(0.0, abs=1e-8 * inner(G, G))
    step = 1e-6
    assert is_orthonormal(C)
    moved = C + step * once / inner(once, once) ** 0.5
    np.testing.assert_allclose(to_numpy(nearest_orthogonal(moved)), to_numpy(moved), atol=5e-12)


@pytest.mark.parametrize("delta", [0.1, 0.7, 3.0])
@pytest.mark.parametrize("name", _LOSSES)
def test_loss_weight_is_its_slope_and_it_is_concave_and_begins_at_zero(name, delta):
    loss, e = Loss(name, delta), np.linspace(1e-2, 4, 4001) * delta**2
    weights = loss.weights(e)
    np.testing.assert_allclose(np.diff(loss.value(e)), np.diff(e) * (weights[1:] + weights[:-1]) / 2, rtol=1e-2)
    assert (np.diff(weights) <= 1e-15).all()
    assert loss.value(np.zeros(1))[0] == pytest.approx(0.0, abs=3e-3 * delta**2)
    small = np.array([1e-4 * delta**2])
    if name in ("huber", "geman"):
        assert loss.value(small)[0] == pytest.approx(small[0], rel=1e-3)


def robust(case, name, width=0.5):
    source, target, F_s, F_t, E = case
    groups = np.array([0, 0, 1, 1, 2, 2, 3, -1, -1])
    data = RobustData(
        source.project(F_s),
        target.project(F_t),
        groups,
        Loss(name),
        operators(source, F_s),
        operators(target, F_t),
        0.2,
    )
    return data.scaled(E.rhs(), width)


def relative(case):
    sizes = np.array([1.0, 4.0, 0.1, 30.0])
    return replace(robust(case, "huber"), sizes=sizes).scaled(case[-1].rhs(), 0.5)


def penalties(case):
    *_, E = case
    return {
        "relative": relative(case),
        **{name: robust(case, name) for name in _LOSSES},
        "sparse": sparse_penalty(E.rhs(), 1e-2),
        "spatial": transport_penalty(E.rhs() / inner(E.rhs(), E.rhs()) ** 0.5, case[0], case[1]),
    }


@pytest.mark.parametrize("name", [*_LOSSES, "sparse", "relative", "spatial"])
def test_majorizer_touches_from_above(case, name):
    penalty = penalties(case)[name]
    *_, E = case
    rng = np.random.default_rng(3)
    C = E.rhs() / inner(E.rhs(), E.rhs()) ** 0.5
    term = penalty.majorizer(C)
    offset = penalty.value(C) - value(term, C)
    for size in (1e-2, 0.3, 3.0):
        X = (
            C
            + (0 * C + 1) * size * float(rng.normal())
            + size * term.rhs() / (1 + inner(term.rhs(), term.rhs()) ** 0.5)
        )
        assert value(term, X) + offset >= penalty.value(X) * (1 - 1e-10) - 1e-12
    # the same slope where they touch
    D, h = 0 * C + 1.0, 1e-6
    slope = (penalty.value(C + h * D) - penalty.value(C - h * D)) / (2 * h)
    assert slope == pytest.approx(inner(term.apply(C) - term.rhs(), D), rel=1e-4, abs=1e-6)


def test_squared_loss_is_the_least_squares_term(case):
    source, target, F_s, F_t, _ = case
    data = robust(case, "squared")
    plain = descriptor_term(source, F_s, target, F_t)
    term = data.majorizer(plain.rhs())
    C = plain.rhs()
    commuting = operator_term(operators(source, F_s), operators(target, F_t))
    wanted = plain.apply(C) + 0.2 * commuting.apply(C)
    np.testing.assert_allclose(to_numpy(term.apply(C)), to_numpy(wanted), rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(to_numpy(term.rhs()), to_numpy(plain.rhs()), rtol=1e-12, atol=1e-12)
    assert data.value(C) == pytest.approx(value(plain, C) + 0.2 * value(commuting, C), rel=1e-10)


@pytest.mark.parametrize("constraint", ["none", "orthogonal"])
def test_objective_falls_whatever_is_combined(case, constraint):
    *_, E = case
    extra = penalties(case)
    parts = {"data": (2.0, extra["huber"]), "sparsity": (0.3, extra["sparse"]), "area": (1.0, extra["spatial"])}
    objective = Objective(E, parts, constraint)
    C = nearest_orthogonal(E.rhs()) if constraint == "orthogonal" else 0 * E.rhs()
    values = [objective.value(C)]
    for _ in range(3):
        C = minimize(objective, MinimizeOptions(CG(rtol=1e-10), max_outer_iter=1), C).value
        values.append(objective.value(C))
        assert constraint == "none" or is_orthonormal(C)
    assert (np.diff(values) <= 1e-9 * values[0]).all()
    assert values[-1] < values[0]
    assert sum(objective.breakdown(C).values()) == pytest.approx(objective.value(C), rel=1e-10)


def test_no_step_follows_one_that_gains_little(numbers):
    *_, E = numbers
    objective = Objective(E, {"sparsity": (0.3, sparse_penalty(E.rhs(), 0.1))})
    options = MinimizeOptions(CG(rtol=1e-10), max_outer_iter=50, rtol=0.0)
    two, all_of_them = (minimize(objective, replace(options, max_outer_iter=most)) for most in (2, 50))
    greedy, usual = (minimize(objective, replace(options, rtol=rtol)) for rtol in (1.0, 1e-4))
    assert greedy.steps == two.steps <= usual.steps < all_of_them.steps
    assert objective.value(usual.value) == pytest.approx(objective.value(all_of_them.value), rel=1e-2)


def test_stationary_without_constraint(numbers):
    *_, E = numbers
    objective = Objective(E, {"sparsity": (0.3, sparse_penalty(E.rhs(), 0.1)), "data": (1.0, robust(numbers, "huber"))})
    C = minimize(objective, MinimizeOptions(CG(rtol=1e-10), max_outer_iter=20), 0 * E.rhs()).value
    for _ in range(100):
        C = minimize(Objective(objective.majorizer(C)), MinimizeOptions(CG(rtol=1e-10)), C).value
    h = 1e-5
    for D in (E.rhs() / inner(E.rhs(), E.rhs()) ** 0.5, 0 * C + 1.0):
        slope = (objective.value(C + h * D) - objective.value(C - h * D)) / (2 * h)
        assert slope == pytest.approx(0.0, abs=1e-5 * objective.value(C))


def test_nothing_extra_is_the_linear_solve_to_the_last_digit(case):
    *_, E = case
    options = MinimizeOptions(CG(rtol=1e-8), "none")
    np.testing.assert_array_equal(
        to_numpy(minimize(Objective(E), options).value), to_numpy(solve(E.apply, E.rhs(), options.solver).value)
    )
    pair = fit_bidirectional(Objective(E), Objective(E), 0.0, 0.0, options)
    np.testing.assert_array_equal(to_numpy(pair.forth.value), to_numpy(minimize(Objective(E), options).value))


def reverse(case):
    source, target, F_s, F_t, _ = case
    return energy(target, source, F_t, F_s)


def test_swapping_source_and_target_swaps_the_two_maps(numbers):
    forth, back = Objective(numbers[-1]), Objective(reverse(numbers))
    options = MinimizeOptions(CG(rtol=1e-10), max_outer_iter=200, rtol=1e-9)
    one, other = (fit_bidirectional(*order, 0.2, 0.2, options) for order in ((forth, back), (back, forth)))
    assert (np.diff(one.history) <= 1e-9 * one.history[0]).all()
    assert one.history[-1] == pytest.approx(other.history[-1], rel=1e-6)
    np.testing.assert_allclose(one.forth.value, other.back.value, atol=1e-2)
    np.testing.assert_allclose(one.back.value, other.forth.value, atol=1e-2)


def test_coupling_brings_the_maps_to_each_others_inverse(case):
    forth, back = Objective(case[-1]), Objective(reverse(case))

    def apart(pair):
        C, D = to_numpy(pair.forth.value), to_numpy(pair.back.value)
        return np.linalg.norm(C @ D - np.eye(len(C))) + np.linalg.norm(D @ C - np.eye(len(D)))

    free, tied, adjoint = (
        fit_bidirectional(forth, back, *weights, TIGHT) for weights in ((0.0, 0.0), (1e3, 0.0), (0.0, 1e3))
    )
    assert apart(tied) < 0.5 * apart(free)
    assert np.linalg.norm(to_numpy(adjoint.forth.value) - to_numpy(adjoint.back.value).T) < 0.05


def test_coupled_bases(case):
    source, target, F_s, F_t, _ = case
    cross = target.project(F_t) @ source.project(F_s).T
    found = couple_bases(source.eigenvalues, target.eigenvalues, cross, weight=1.0)
    assert (np.diff(found.history) <= 1e-12).all()
    assert is_orthonormal(found.U_s)
    assert is_orthonormal(found.U_t)
    S, T = found.to_rotated(source, target)
    np.testing.assert_allclose(to_numpy(S.project(S.functions)), np.eye(S.functions.shape[1]), atol=1e-9)
    C = 0 * cross + 1.0
    f = source.functions @ (0 * source.eigenvalues[:, None] + 1.0)
    np.testing.assert_allclose(
        to_numpy(T.functions @ (C @ S.project(f))),
        to_numpy(target.functions @ (found.U_t @ C @ found.U_s.T @ source.project(f))),
        atol=1e-9,
    )


def test_coupled_bases_undo_a_known_rotation():
    """One surface, its eigenfunctions' signs and pairs mixed: coupled, the map is the identity."""
    rng = np.random.default_rng(0)
    values = np.array([0.0, 1.0, 2.0, 2.0, 3.5, 5.0])
    C = np.diag([1.0, -1.0, 1, 1, -1, 1])
    angle = 0.7
    C[2:4, 2:4] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    found = couple_bases(values, values, C + 0.01 * rng.normal(size=(6, 6)), weight=1.0)
    np.testing.assert_allclose(found.U_t.T @ C @ found.U_s, np.eye(6), atol=0.05)
    for U in (found.U_s, found.U_t):
        rotated = U.T @ np.diag(values) @ U
        assert np.linalg.norm(rotated - np.diag(np.diag(rotated))) < 0.05


def test_terms_and_penalties_between_rotated_bases(numbers):
    rng = np.random.default_rng(0)
    C, X = rng.normal(size=(2, *numbers[-1].rhs().shape))
    U_t, U_s = (nearest_orthogonal(rng.normal(size=(k, k))) for k in C.shape)
    plain = numbers[-1].terms["laplacian"]
    term = RotatedTerm(plain, U_t, U_s)
    assert value(term, U_t @ C @ U_s.T) == pytest.approx(value(plain, C))
    one = np.eye(C.size).reshape(-1, *C.shape)
    np.testing.assert_allclose(term.diagonal().ravel(), [inner(e, term.apply(e)) for e in one], atol=1e-12)
    V_t, V_s = (nearest_orthogonal(rng.normal(size=(k, k))) for k in C.shape)
    expected = [inner(V_t @ e @ V_s.T, term.apply(V_t @ e @ V_s.T)) for e in one]
    np.testing.assert_allclose(term.diagonal(V_t, V_s).ravel(), expected, atol=1e-12)
    penalty = sparse_penalty(C, 1e-2)
    rotated = RotatedPenalty(penalty, U_t, U_s)
    assert rotated.value(U_t @ C @ U_s.T) == pytest.approx(penalty.value(C))
    assert value(rotated.majorizer(U_t @ C @ U_s.T), U_t @ X @ U_s.T) == pytest.approx(value(penalty.majorizer(C), X))


def test_resolvent_mask():
    source, target = bases(5, 7)
    same = laplacian_term(source, source, mask="resolvent").weights
    np.testing.assert_allclose(same, same.T, atol=1e-15)
    np.testing.assert_allclose(np.diag(same), 0.0, atol=1e-15)
    assert same.max() <= 1
    with pytest.raises(InvalidInput, match="mask"):
        laplacian_term(source, target, mask="cubic")  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidInput, match="power"):
        laplacian_term(source, target, mask="resolvent", power=0.0)


def test_functions_beyond_the_basis(small_basis, asarray):
    """On equal shapes with the identity map a product of two basis functions is carried as it is; alone C cannot."""
    basis = small_basis.truncate(12)
    f = small_basis.functions[:, 7] * small_basis.functions[:, 9] + small_basis.functions[:, 3]
    C = asarray(np.eye(12))
    shape = type(basis)(*(asarray(a) for a in (basis.eigenvalues, basis.functions, basis.mass)))
    alone = to_numpy(transfer_functions(asarray(f), C, shape, shape, None))
    better = to_numpy(transfer_functions(asarray(f), C, shape, shape, 12, 1e-9))
    assert np.linalg.norm(better - f) < 1e-3 * np.linalg.norm(f)
    assert np.linalg.norm(alone - f) > 0.1 * np.linalg.norm(f)
    # what lies in the basis is carried by C alone, whatever the products
    inside = asarray(basis.functions[:, :4])
    np.testing.assert_allclose(
        to_numpy(transfer_functions(inside, C, shape, shape, 8)), basis.functions[:, :4], atol=1e-8
    )


def test_bad_input_is_refused(small_basis):
    with pytest.raises(InvalidInput, match="loss"):
        Loss("cubic")  # pyright: ignore[reportArgumentType]
    with pytest.raises(InvalidInput, match="delta"):
        Loss("huber", 0.0)
    with pytest.raises(InvalidInput, match="products"):
        transfer_functions(small_basis.functions, np.eye(5), small_basis, small_basis, 6)
    with pytest.raises(InvalidInput, match="values"):
        transfer_functions(np.ones((3, 1)), np.eye(5), small_basis, small_basis)
    E = energy(*bases(5, 5), *features())
    with pytest.raises(InvalidInput, match="start"):
        minimize_orthogonal(E, Direct(), np.eye(4))


@pytest.mark.parametrize("blur", [1.0, 0.1, 0.003])
def test_transport_is_what_it_minimises(asarray, blur):
    """The value is that of the plan, no other plan has a lower one, and both sides swapped transpose it."""
    rng = np.random.default_rng(0)
    x, y = rng.normal(size=(40, 3)), rng.normal(size=(30, 3))
    c = ((x[:, None] - y[None, :]) ** 2).sum(axis=-1)
    a, b = (m / m.sum() for m in (rng.random(40), rng.random(30)))

    def divergence(p, q):
        return (p * np.log(np.maximum(p, 1e-300) / q) - p + q).sum()

    def whole(p):
        sides = divergence(p.sum(axis=1), a) + divergence(p.sum(axis=0), b)
        return (p * c).sum() + blur * divergence(p, a[:, None] * b) + 10 * blur * sides

    found, output = _transport(asarray(c), asarray(a), asarray(b), blur)
    plan = to_numpy(found)
    assert output == pytest.approx(whole(plan), rel=1e-6)
    for _ in range(5):
        assert whole(plan * np.exp(0.05 * rng.normal(size=plan.shape))) > output
    turned, same = _transport(asarray(c.T), asarray(b), asarray(a), blur)
    np.testing.assert_allclose(to_numpy(turned).T, plan, atol=1e-5 * plan.max())
    assert same == pytest.approx(output, rel=1e-6)


def test_the_majorizer_of_transport_is_the_cost_of_its_plan(numbers):
    source, target, *_, E = numbers
    C = E.rhs() / inner(E.rhs(), E.rhs()) ** 0.5
    penalty = transport_penalty(C, source, target)
    plan, term = penalty.plan(C), penalty.majorizer(C)
    for other in (C, 0.0 * C, 2.0 * C + 0.1):
        costs = _costs(other, penalty.functions_s, penalty.functions_t)
        assert value(term, other) == pytest.approx((plan * costs).sum(), rel=1e-9)


def test_directions_on_orthonormal_maps_are_conjugate() -> None:
    """By the formula of Polak and Ribière, with what the earlier ones leave in the tangent space."""
    rng = np.random.default_rng(0)
    C = nearest_orthogonal(rng.normal(size=(6, 4)))
    gradient, old_gradient, direction = (_tangent(C, rng.normal(size=(6, 4))) for _ in range(3))
    gz, old_gz = float((gradient**2).sum()), 50.0
    beta = (gz - float((old_gradient * gradient).sum())) / old_gz
    assert beta > 0
    wanted = beta * direction - gradient
    assert (wanted * gradient).sum() < 0
    found = _next_direction(C, gradient, gradient, gz, direction, (old_gradient, old_gz))
    np.testing.assert_allclose(found, wanted, atol=1e-12)
    # Uphill, or without an earlier one, it is the steepest descent.
    np.testing.assert_array_equal(_next_direction(C, gradient, gradient, gz, None, None), -gradient)
    uphill = _next_direction(C, gradient, gradient, gz, 1e3 * gradient, (-gradient, old_gz))
    np.testing.assert_array_equal(uphill, -gradient)


def test_published_formulations_differ_in_nothing_else() -> None:
    for name in FORMULATIONS:
        config = Config.published(name)
        assert config.formulation == FORMULATIONS[name]
        assert config.kernel == Linear()
        with_operators = name == "ren19"
        assert (config.weights.commutativity > 0) == with_operators
        assert with_operators or (config.weights.descriptors, config.weights.laplacian) == (1.0, 1.0)
