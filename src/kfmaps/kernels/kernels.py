"""Kernels of descriptors, ``k(X (n, d), Y (m, d)) -> (n, m)``.

Every kernel is a small frozen record. Any callable with that signature is a kernel too (scikit-learn's pairwise
kernels, a function of your own): :func:`kernel_matrix` calls it and checks what comes back.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, is_dataclass, replace
from typing import Any, Protocol, runtime_checkable

import numpy as np

from kfmaps._arrays import Array, is_numpy, like, namespace, refuse, to_numpy
from kfmaps._records import document_fields, setting, settings_record


@runtime_checkable
class Kernel(Protocol):
    """A kernel that also knows its diagonal without forming the matrix."""

    def __call__(self, X: Array, Y: Array, /) -> Array:
        """``(n, m)`` values for rows of ``X (n, d)`` against rows of ``Y (m, d)``."""
        ...

    def diagonal(self, X: Array, /) -> Array:
        """Return the values ``k(x, x)``, (n,), of rows of ``X (n, d)``."""
        ...


KernelLike = Kernel | Callable[[Array, Array], Array]


def _squared_distances(X: Array, Y: Array) -> Array:
    """Return the squared Euclidean distances (n, m) between rows of ``X (n, d)`` and ``Y (m, d)``, never negative."""
    xp = namespace(X, Y)
    # Distances do not see a common shift, rounding does: centring keeps small distances between far points.
    centre = xp.mean(Y, axis=0, keepdims=True)
    X, Y = X - centre, Y - centre
    squares = xp.sum(X * X, axis=1)[:, None] + xp.sum(Y * Y, axis=1)[None, :] - 2 * (X @ Y.T)
    return xp.clip(squares, min=0.0)


def _distances(X: Array, Y: Array) -> Array:
    """Return the Euclidean distances (n, m) between rows of ``X (n, d)`` and ``Y (m, d)``."""
    xp = namespace(X, Y)
    squares = _squared_distances(X, Y)
    # What rounding leaves between equal rows is none. It is set to 1e-150, not to 0, where the root has no derivative.
    return xp.sqrt(xp.where(squares > 1e-15 * xp.max(squares), squares, 1e-300 * xp.ones_like(squares)))


def _ones(X: Array) -> Array:
    xp = namespace(X)
    return xp.ones(X.shape[0], dtype=X.dtype, device=X.device)


@dataclass(frozen=True)
class Linear:
    """``x·y``. With it the method is that of Nogneng and Ovsjanikov (2017).

    Examples
    --------
    >>> kfmaps.Linear()(np.array([[1.0, 2.0]]), np.array([[3.0, 4.0]]))
    array([[11.]])
    """

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return X @ Y.T

    def diagonal(self, X: Array, /) -> Array:
        return namespace(X).sum(X * X, axis=1)


@settings_record
class Polynomial:
    """``(x·y + offset)^degree``: all products of up to ``degree`` descriptors.

    Examples
    --------
    >>> kfmaps.Polynomial(degree=2, offset=1.0)(np.array([[1.0, 2.0]]), np.array([[3.0, 4.0]]))
    array([[144.]])
    """

    degree: int = setting(2, "degree of the polynomial kernel", low=1)
    offset: float = setting(1.0, "what is added to x·y", low=0)

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return (X @ Y.T + self.offset) ** self.degree

    def diagonal(self, X: Array, /) -> Array:
        return (namespace(X).sum(X * X, axis=1) + self.offset) ** self.degree


@settings_record
class Gaussian:
    """``exp(-γ ‖x − y‖²)``; ``gamma=None`` is chosen from the descriptors by :func:`resolve_kernel`.

    Examples
    --------
    >>> kfmaps.Gaussian(gamma=0.5)(np.array([[0.0]]), np.array([[0.0], [2.0]])).round(3)
    array([[1.   , 0.135]])
    """

    gamma: float | None = setting(None, "γ, per squared unit of the descriptors", above=0, none="automatic")

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return namespace(X, Y).exp(-_known(self) * _squared_distances(X, Y))

    def diagonal(self, X: Array, /) -> Array:
        return _ones(X)


@settings_record
class Laplacian:
    """``exp(-γ ‖x − y‖)``, a sharper peak and longer tail than the Gaussian; ``gamma=None`` is automatic.

    Examples
    --------
    >>> kfmaps.Laplacian(gamma=0.5)(np.array([[0.0]]), np.array([[0.0], [2.0]])).round(3)
    array([[1.   , 0.368]])
    """

    gamma: float | None = setting(None, "γ, per unit of the descriptors", above=0, none="automatic")

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return namespace(X, Y).exp(-_known(self) * _distances(X, Y))

    def diagonal(self, X: Array, /) -> Array:
        return _ones(X)


@settings_record
class Tanh:
    """``tanh(scale·x·y + offset)``, the nonlinearity of neural networks.

    Not positive definite in general: the Nyström features keep its positive part and say so.

    Examples
    --------
    >>> kfmaps.Tanh(scale=0.5)(np.array([[1.0]]), np.array([[2.0]])).round(3)
    array([[0.762]])
    """

    scale: float = setting(1.0, "factor of x·y", above=0)
    offset: float = setting(0.0, "what is added to it")

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return namespace(X, Y).tanh(self.scale * (X @ Y.T) + self.offset)

    def diagonal(self, X: Array, /) -> Array:
        xp = namespace(X)
        return xp.tanh(self.scale * xp.sum(X * X, axis=1) + self.offset)


@document_fields
@dataclass(frozen=True)
class Sum:
    """``a(x, y) + b(x, y)``: the feature vectors side by side.

    Examples
    --------
    >>> kfmaps.Sum(kfmaps.Linear(), kfmaps.Polynomial())(np.array([[1.0]]), np.array([[2.0]]))
    array([[11.]])
    """

    a: KernelLike = field(metadata={"help": "first kernel"})
    b: KernelLike = field(metadata={"help": "second kernel"})

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return kernel_matrix(self.a, X, Y) + kernel_matrix(self.b, X, Y)

    def diagonal(self, X: Array, /) -> Array:
        return kernel_diagonal(self.a, X) + kernel_diagonal(self.b, X)


@document_fields
@dataclass(frozen=True)
class Product:
    """``a(x, y) · b(x, y)``: all products of one feature of each.

    Examples
    --------
    >>> kfmaps.Product(kfmaps.Linear(), kfmaps.Polynomial())(np.array([[1.0]]), np.array([[2.0]]))
    array([[18.]])
    """

    a: KernelLike = field(metadata={"help": "first kernel"})
    b: KernelLike = field(metadata={"help": "second kernel"})

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return kernel_matrix(self.a, X, Y) * kernel_matrix(self.b, X, Y)

    def diagonal(self, X: Array, /) -> Array:
        return kernel_diagonal(self.a, X) * kernel_diagonal(self.b, X)


PLAIN_KERNELS = (Linear, Polynomial, Gaussian, Laplacian, Tanh, Sum, Product)
"""Kernels of plain descriptors; those of transformed ones are in :mod:`kfmaps.kernels.transformed`."""


def kernel_matrix(kernel: KernelLike, X: Array, Y: Array) -> Array:
    """Return the kernel matrix between rows of descriptors, checked.

    Parameters
    ----------
    kernel : Kernel or callable
        A callable without ``diagonal`` is called with NumPy arrays, whatever the library of the descriptors.
    X, Y : (n, d), (m, d)

    Returns
    -------
    (n, m)

    Raises
    ------
    InvalidInput
        If the kernel returns another shape, or NaN or infinite values.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is refused below, in words
        if isinstance(kernel, Kernel) or is_numpy(X):
            values = kernel(X, Y)
        else:
            values = like(np.asarray(kernel(to_numpy(X), to_numpy(Y))), X)
    wanted = (X.shape[0], Y.shape[0])
    name = f"kernel {describe_kernel(kernel)}"
    shape = tuple(getattr(values, "shape", ()))
    if shape != wanted:
        raise refuse(name, f"shape {wanted}", f"shape {shape}", "return one value for each pair of rows")
    xp = namespace(values)
    # One reduction instead of an elementwise mask: NaN and infinity both survive a sum.
    if not bool(xp.isfinite(xp.sum(values))):
        remedy = "make it finite for these descriptors (a large degree or γ overflows)"
        raise refuse(name, "finite values", "NaN or infinite ones", remedy)
    return values


def kernel_diagonal(kernel: KernelLike, X: Array) -> Array:
    """Return ``k(x, x)`` for the rows of ``X (n, d)``, (n,), row by row if the kernel has no ``diagonal``."""
    if isinstance(kernel, Kernel):
        return kernel.diagonal(X)
    xp = namespace(X)
    return xp.concat(
        [xp.reshape(kernel_matrix(kernel, X[i : i + 1, :], X[i : i + 1, :]), (1,)) for i in range(X.shape[0])]
    )


def describe_kernel(kernel: KernelLike) -> str:
    """Return the kernel's name for messages and tables."""
    if isinstance(kernel, Kernel):
        return repr(kernel)
    return getattr(kernel, "__name__", type(kernel).__name__)


def resolve_kernel(kernel: KernelLike, samples: Array, bandwidth_scale: float = 1.0) -> KernelLike:
    """Return the kernel with every automatic γ made a number.

    It is ``γ = bandwidth_scale / median ‖x − y‖²`` for the Gaussian and ``γ = √bandwidth_scale / median ‖x − y‖`` for
    the Laplacian kernel, over all pairs of different samples.

    Parameters
    ----------
    kernel : Kernel or callable
    samples : (q, d)
        Descriptors.
    bandwidth_scale : float
        A number without unit, so that scaling all descriptors does not change the kernel's values.
    """
    if not isinstance(kernel, Gaussian | Laplacian):
        outer: Any = kernel
        transformed = outer.transform(samples) if hasattr(outer, "transform") else samples
        inside = {
            name: resolve_kernel(inner, transformed, bandwidth_scale) for name, inner in inner_kernels(kernel).items()
        }
        return replace(outer, **inside) if inside else kernel
    if kernel.gamma is not None:
        return kernel
    squares = to_numpy(_squared_distances(samples, samples))
    # Between equal rows there is rounding, of the size of the rows.
    largest = float((to_numpy(samples) ** 2).sum(axis=1).max())
    positive = squares[squares > max(1e-12 * squares.max(), 1e-24 * largest)]
    typical = float(np.median(positive)) if positive.size else 1.0
    gamma = bandwidth_scale / typical
    return replace(kernel, gamma=gamma if isinstance(kernel, Gaussian) else float(np.sqrt(gamma)))


def inner_kernels(kernel: KernelLike) -> dict[str, KernelLike]:
    """Return the kernels that a record of this package is made of, by the names of their fields."""
    own = is_dataclass(kernel) and not isinstance(kernel, type)
    return {name: getattr(kernel, name) for name in ("kernel", "a", "b") if own and hasattr(kernel, name)}


def _known(kernel: Gaussian | Laplacian) -> float:
    if kernel.gamma is None:
        name = f"{type(kernel).__name__} gamma"
        raise refuse(name, "a number", "None (automatic)", "call resolve_kernel(kernel, samples) first")
    return kernel.gamma
