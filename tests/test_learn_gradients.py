"""The gradient of the map that minimises an energy, against differences, for every kernel and every term."""

import numpy as np
import pytest

from conftest import random_basis
from kfmaps._arrays import NotConverged
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.full_kernel import hadamard_term, kernel_descriptor_term
from kfmaps.fmap.multiplication_operators import multiplication_operators, unpack_operators
from kfmaps.fmap.solvers import CG, Direct, solve
from kfmaps.fmap.terms import Elementwise, descriptor_term, laplacian_term, operator_term
from kfmaps.kernels.kernels import Gaussian, Laplacian, Linear, Polynomial, Product, Sum, Tanh

GUARDS = ("kfmaps.kernels.transformed",)

torch = pytest.importorskip("torch")

from kfmaps.learn.energy import (  # noqa: E402
    differentiable_minimum,
    nystrom_features,
    pair_energy,
)
from kfmaps.learn.model import _bind, geodesic_loss  # noqa: E402

N_S, N_T, K_S, K_T, D = 10, 9, 4, 3, 2
EXACT = CG(rtol=1e-13, max_iter=500)


def _operators(basis, F):
    return unpack_operators(multiplication_operators(basis, F))


def leaf(values):
    return torch.tensor(values, dtype=torch.float64, requires_grad=True)


@pytest.fixture
def case(rng):
    bases = random_basis(N_S, K_S, rng).to("torch"), random_basis(N_T, K_T, rng).to("torch")
    return (*bases, leaf(rng.normal(size=(N_S, D))), leaf(rng.normal(size=(N_T, D))))


def right(function, *inputs, fast=True):
    """PyTorch's check with differences of 1e-6, to 1e-6 of the derivative: along random directions, or every entry."""
    return torch.autograd.gradcheck(function, inputs, eps=1e-6, atol=1e-8, rtol=1e-6, fast_mode=fast)


def ground(source, target):
    """What makes every energy here positive definite."""
    return Elementwise(torch.ones(K_T, K_S, dtype=torch.float64)), laplacian_term(source, target)


def minimum(parts, weights, bases):
    ones, laplacian = ground(*bases)
    terms = {**parts, "ones": ones, "laplacian": laplacian}
    return differentiable_minimum(Energy(terms, {**weights, "ones": 0.1, "laplacian": 0.5}), EXACT)


TERMS = {
    "descriptors": lambda s, t, F, G: descriptor_term(s, F, t, G),
    "operators": lambda s, t, F, G: operator_term(_operators(s, F), _operators(t, G)),
    "antisymmetric operators": lambda s, t, F, G: operator_term(_skew(_operators(s, F)), _skew(_operators(t, G)), -1),
    "kernel descriptors": lambda s, t, F, G: kernel_descriptor_term(Gaussian(0.3), s, F, t, G, block=5),
    "hadamard": lambda s, t, F, G: hadamard_term(Gaussian(0.3), s, F, t, G, block=5),
    "elementwise": lambda s, t, F, G: Elementwise(t.project(G**2)[:, :1] ** 2 + s.project(F**2)[:, :1].T ** 2),
}


def _skew(operators):
    k = operators.shape[1]
    sign = torch.triu(torch.ones(k, k, dtype=operators.dtype), 1)
    return operators * (sign - sign.T)


@pytest.mark.parametrize("name", TERMS)
def test_every_term_and_its_weight(name, case):
    source, target, F, G = case
    fixed = descriptor_term(source, F.detach() + 1, target, G.detach() - 1)  # a right-hand side for those without

    def C(F, G, weight):
        parts = {name: TERMS[name](source, target, F, G), "fixed": fixed}
        return minimum(parts, {name: weight, "fixed": 1.0}, (source, target))

    assert right(C, F, G, leaf(0.7), fast=False)


KERNELS = {
    "linear": (lambda: Linear(), ()),
    "polynomial": (lambda offset: _bind(Polynomial(3, 0.5), offset=offset), (0.5,)),
    "gaussian": (lambda gamma: _bind(Gaussian(1.0), gamma=gamma), (0.4,)),
    "laplacian": (lambda gamma: _bind(Laplacian(1.0), gamma=gamma), (0.6,)),
    "tanh": (lambda scale, offset: _bind(Tanh(0.3, 0.1), scale=scale, offset=offset), (0.3, 0.1)),
    "sum": (lambda gamma: Sum(_bind(Gaussian(1.0), gamma=gamma), Linear()), (0.4,)),
    "product": (
        lambda gamma, offset: Product(_bind(Laplacian(1.0), gamma=gamma), _bind(Polynomial(2, 1.0), offset=offset)),
        (0.4, 0.8),
    ),
}


@pytest.mark.parametrize("name", KERNELS)
def test_every_kernel(name, case):
    """Through the descriptors, so that any transformation of them can be learned, and through its own numbers."""
    source, target, F, G = case
    build, numbers = KERNELS[name]

    def C(F, G, *numbers):
        kernel = build(*numbers)
        parts = {
            "descriptors": kernel_descriptor_term(kernel, source, F, target, G),
            "commutativity": hadamard_term(kernel, source, F, target, G),
        }
        return minimum(parts, {"descriptors": 1.0, "commutativity": 0.3}, (source, target))

    assert right(C, F, G, *[leaf(number) for number in numbers])


@pytest.mark.parametrize("name", [name for name in KERNELS if name not in ("tanh", "linear", "polynomial")])
def test_features_of_samples(name, case):
    source, target, F, G = case
    build, numbers = KERNELS[name]

    def C(F, G, S, *numbers):
        W = nystrom_features(build(*numbers), F, G, S)
        weights = {"descriptors": 2.0, "commutativity": 1.0, "laplacian": 0.5}
        return differentiable_minimum(pair_energy(source, target, *W, weights), EXACT)

    assert right(C, F, G, leaf(F.detach()[:4].numpy() + 0.1), *[leaf(number) for number in numbers])


def test_features_reproduce_the_kernel_where_every_point_is_a_sample(case):
    _, _, F, G = case
    kernel = Gaussian(0.4)
    W_s, W_t = nystrom_features(kernel, F, G, torch.cat([F, G]))
    np.testing.assert_allclose((W_t @ W_s.T).detach(), kernel(G, F).detach(), atol=1e-6)


def test_the_map_is_that_of_the_other_solver(case):
    source, target, F, G = case
    energy = pair_energy(source, target, F, G, {"descriptors": 1.0, "commutativity": 1.0, "laplacian": 0.5})
    found = differentiable_minimum(energy, EXACT)
    with torch.no_grad():
        wanted = solve(energy.apply, energy.rhs(), Direct()).value
    np.testing.assert_allclose(found.detach(), wanted, rtol=1e-9)


def test_memory_does_not_grow_with_the_iterations(case):
    source, target, F, G = case

    def held(solver):
        kept = []
        with torch.autograd.graph.saved_tensors_hooks(lambda t: kept.append(t.numel()) or t, lambda t: t):
            energy = pair_energy(source, target, F, G, {"descriptors": 1.0, "commutativity": 1.0, "laplacian": 0.5})
            differentiable_minimum(energy, solver)
        return sum(kept)

    energy = pair_energy(source, target, F, G, {"descriptors": 1.0, "commutativity": 1.0, "laplacian": 0.5})
    with torch.no_grad():
        assert solve(energy.apply, energy.rhs(), EXACT).steps > 3
    assert held(CG(max_iter=1)) == held(EXACT)


def test_truncation_hardly_changes_the_gradient(case):
    source, target, F, G = case
    weights = {"descriptors": 1.0, "commutativity": 1.0, "laplacian": 0.5}
    spread = torch.cat([F, G[:, :1].mean() + 1e-4 * F], dim=1), torch.cat([G, G[:, :1].mean() + 1e-4 * G], dim=1)
    gradients = []
    for rtol in (0.0, 1e-6):
        C = differentiable_minimum(pair_energy(source, target, *spread, weights, rtol), EXACT)
        gradients.append(torch.autograd.grad((C**2).sum(), F, retain_graph=True)[0])
    np.testing.assert_allclose(*gradients, rtol=1e-3, atol=1e-5)


def test_a_breakdown_is_told(case):
    source, target, F, G = case
    energy = pair_energy(source, target, F * float("nan"), G, {"descriptors": 1.0, "laplacian": 0.5})
    with pytest.raises((NotConverged, RuntimeError)):
        differentiable_minimum(energy, EXACT)


def test_geodesic_loss(case, rng):
    """A mean over rows of weights that add up to 1, and the error of the nearest point at temperature 0."""
    source, target, _, _ = case
    distances = torch.from_numpy(rng.random((N_T, N_S)))
    # At a fixed scale: what the temperature is measured in has no derivative, by choice.
    assert float(loss(leaf(rng.normal(size=(K_T, K_S))), source, target, distances)) < float(distances.max())
    identity, everywhere = torch.eye(K_S, dtype=torch.float64), torch.eye(N_S, dtype=torch.float64)
    assert float(geodesic_loss(identity, source.functions, source.functions + 1e-3, 1 - everywhere, 1e-6)) < 1e-9


def loss(C, source, target, distances):
    return geodesic_loss(C, source.functions, target.functions, distances, 3.0).detach()
