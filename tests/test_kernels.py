"""Kernels: definitions, laws, and what is refused."""

from typing import Any

import numpy as np
import pytest
from sklearn.metrics.pairwise import laplacian_kernel, rbf_kernel

from kfmaps._arrays import InvalidInput, to_numpy
from kfmaps.kernels.kernels import (
    Gaussian,
    Laplacian,
    Linear,
    Polynomial,
    Product,
    Sum,
    Tanh,
    _squared_distances,
    kernel_diagonal,
    kernel_matrix,
    resolve_kernel,
)
from kfmaps.kernels.transformed import Metric, descriptor_width

GUARDS = ("kfmaps.kernels.kernels", "kfmaps.kernels.transformed")

KERNELS = [
    Linear(),
    Polynomial(3, 0.5),
    Gaussian(0.7),
    Laplacian(0.7),
    Tanh(0.3, 0.1),
    Sum(Linear(), Gaussian(2.0)),
    Product(Polynomial(2, 1.0), Laplacian(0.2)),
    Metric(Sum(Linear(), Laplacian(0.5)), ((1.0, 0.5, 0.0), (0.0, -1.0, 2.0))),
]
POSITIVE = [k for k in KERNELS if not isinstance(k, Tanh)]


def plain(kernel, x, y):
    """The definition, for two vectors."""
    match kernel:
        case Linear():
            return x @ y
        case Polynomial(degree, offset):
            return (x @ y + offset) ** degree
        case Gaussian(gamma) if gamma is not None:
            return np.exp(-gamma * np.sum((x - y) ** 2))
        case Laplacian(gamma) if gamma is not None:
            return np.exp(-gamma * np.sqrt(np.sum((x - y) ** 2)))
        case Tanh(scale, offset):
            return np.tanh(scale * (x @ y) + offset)
        case Sum(a, b):
            return plain(a, x, y) + plain(b, x, y)
        case Product(a, b):
            return plain(a, x, y) * plain(b, x, y)
        case Metric(inner, matrix):
            return plain(inner, *(np.asarray(matrix) @ v for v in (x, y)))
    raise AssertionError(kernel)


@pytest.mark.parametrize("kernel", KERNELS, ids=repr)
def test_definition_and_diagonal_on_every_library(kernel, asarray, rng):
    X, Y = rng.normal(size=(6, 3)), rng.normal(size=(5, 3))
    wanted = np.array([[plain(kernel, x, y) for y in Y] for x in X])
    np.testing.assert_allclose(to_numpy(kernel_matrix(kernel, asarray(X), asarray(Y))), wanted, rtol=1e-12, atol=1e-13)
    diagonal = [plain(kernel, x, x) for x in X]
    np.testing.assert_allclose(to_numpy(kernel_diagonal(kernel, asarray(X))), diagonal, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("kernel", POSITIVE, ids=repr)
def test_positive_semi_definite(kernel, rng):
    X = rng.normal(size=(30, 3))
    values = np.linalg.eigvalsh(kernel_matrix(kernel, X, X))
    assert values[0] > -1e-12 * values[-1]


def test_squared_distances_survive_a_large_shift(rng):
    X = rng.normal(size=(8, 4))
    np.testing.assert_allclose(_squared_distances(X + 1e6, X + 1e6), _squared_distances(X, X), atol=1e-8)
    assert _squared_distances(X, X).min() >= 0


def test_scikit_learn_kernels_are_kernels(asarray, rng):
    X, Y = rng.normal(size=(6, 3)), rng.normal(size=(5, 3))
    ours = to_numpy(kernel_matrix(lambda a, b: rbf_kernel(a, b, gamma=0.4), asarray(X), asarray(Y)))
    np.testing.assert_allclose(ours, kernel_matrix(Gaussian(0.4), X, Y), rtol=1e-12)
    assert to_numpy(kernel_diagonal(laplacian_kernel, asarray(X))) == pytest.approx(np.ones(6))


@pytest.mark.parametrize("scale", [1e-3, 1e4])
@pytest.mark.parametrize("kernel", [Gaussian(), Laplacian(), Metric(Gaussian(), ((1.0, 0.5, 0.0), (0.0, -1.0, 2.0)))])
def test_automatic_gamma_is_free_of_scale(kernel, scale, rng):
    X = rng.normal(size=(40, 3))
    one, other = (kernel_matrix(resolve_kernel(kernel, Y), Y, Y) for Y in (X, scale * X))
    np.testing.assert_allclose(other, one, rtol=1e-6)


def test_automatic_gamma_is_one_over_the_median_squared_distance(rng):
    X = rng.normal(size=(40, 5))
    squares = _squared_distances(X, X)[np.triu_indices(40, 1)]
    simple: Any = resolve_kernel(Gaussian(), X, 2.0)
    assert simple.gamma == pytest.approx(2.0 / np.median(squares))
    inside: Any = resolve_kernel(Sum(Linear(), Product(Gaussian(), Gaussian(3.0))), X)
    assert inside.b.a.gamma == pytest.approx(1.0 / np.median(squares))
    assert inside.b.b.gamma == 3.0


@pytest.mark.parametrize("X", [np.ones((5, 2)), 1e4 * (1 + 5e-13 * (np.arange(6)[:, None] % 2))])
def test_equal_descriptors_and_rounding_between_them_set_no_width(X):
    kernel: Any = resolve_kernel(Gaussian(), X, 0.7)
    assert kernel.gamma == 0.7


def test_how_many_descriptors_a_kernel_takes():
    metric = Metric(Gaussian(1.0), ((1.0, 2.0),))
    assert descriptor_width(Gaussian()) is None
    assert descriptor_width(metric) == descriptor_width(Sum(Linear(), Product(metric, Linear()))) == 2
    assert descriptor_width(Metric(metric, ((1.0, 2.0, 3.0), (0.0, 0.0, 1.0)))) == 3


@pytest.mark.parametrize(
    "make",
    [
        lambda: Gaussian(0.0),
        lambda: Gaussian(np.nan),
        lambda: Laplacian(-1.0),
        lambda: Polynomial(0),
        lambda: Polynomial(2, -1.0),
        lambda: Tanh(0.0),
        lambda: Metric(Gaussian(1.0), ()),
        lambda: Metric(Gaussian(1.0), ((1.0, 2.0), (1.0,))),
        lambda: Metric(Gaussian(1.0), (1.0, 2.0)),  # pyright: ignore[reportArgumentType]
        lambda: Metric(Gaussian(1.0), ((float("nan"),),)),
        lambda: Metric(Gaussian(1.0), (("x", 1.0),)),  # pyright: ignore[reportArgumentType]
        lambda: Metric(Gaussian(1.0), ((1.0, 2.0),))(np.zeros((3, 3)), np.zeros((3, 3))),
    ],
)
def test_impossible_parameters_are_refused(make):
    with pytest.raises(InvalidInput, match=r"expected .* got .*"):
        make()


def test_bad_kernels_are_refused(rng):
    X = rng.normal(size=(4, 2))
    with pytest.raises(InvalidInput, match=r"expected shape \(4, 4\), got shape \(4, 3\)"):
        kernel_matrix(lambda a, b: np.ones((len(a), len(b) - 1)), X, X)
    with pytest.raises(InvalidInput, match="NaN"):
        kernel_matrix(lambda a, b: np.full((len(a), len(b)), np.nan), X, X)
    with pytest.raises(InvalidInput, match="overflows"):
        kernel_matrix(Polynomial(400), 1e3 * X, X)
    with pytest.raises(InvalidInput, match="resolve_kernel"):
        kernel_matrix(Gaussian(), X, X)


def test_equal_rows_are_at_no_distance(rng):
    X = rng.normal(size=(50, 7)) + 100
    values = np.diag(kernel_matrix(Laplacian(3.0), X, X[:, :]))
    np.testing.assert_array_equal(values, 1.0)
