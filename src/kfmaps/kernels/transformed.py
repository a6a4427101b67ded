"""Kernels of descriptors that were transformed first: what learning finds, as records of plain numbers.

Each holds another kernel and hands it transformed rows. They nest: ``Metric(Network(Gaussian(1.0), …), …)`` weights the
descriptors, puts the network's outputs beside them and takes the Gaussian kernel of the whole.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from kfmaps._arrays import Array, check_count, like, namespace, refuse, take
from kfmaps._records import setting, settings_record
from kfmaps.kernels import kernels
from kfmaps.kernels.kernels import Gaussian, KernelLike, describe_kernel, inner_kernels, kernel_diagonal, kernel_matrix


@settings_record
class _Transformed:
    """A kernel of transformed descriptors."""

    kernel: KernelLike = setting(Gaussian, "the kernel inside")

    def transform(self, X: Array) -> Array:
        raise NotImplementedError

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return kernel_matrix(self.kernel, self.transform(X), self.transform(Y))

    def diagonal(self, X: Array, /) -> Array:
        return kernel_diagonal(self.kernel, self.transform(X))


@settings_record
class Metric(_Transformed):
    """``kernel(M x, M y)``: distances and products in the metric ``MᵀM``.

    The matrix has a weight for each of the d descriptors ("automatic relevance determination", MacKay 1994), or the
    rows of ``M (r, d)``. Descriptors of other landmarks are other descriptors: their number is checked by
    :func:`kfmaps.matching.features.resolve_kernel_width`.
    """

    matrix: tuple[float, ...] | tuple[tuple[float, ...], ...] = setting((), "weights, or rows of M")
    landmarks: int | None = setting(None, "landmarks that it was learned with", low=0)

    def __post_init__(self) -> None:
        if self.landmarks is not None:
            check_count(self.landmarks, "Metric landmarks", low=0)
        values = _matrix(self.matrix, "Metric matrix")
        plain = values.tolist()
        object.__setattr__(self, "matrix", tuple(tuple(row) if values.ndim == 2 else row for row in plain))

    def transform(self, X: Array) -> Array:
        """Return the rows ``M x``, (n, r), of descriptors ``X (n, d)``."""
        M = like(self.matrix, X)
        if X.shape[1] != M.shape[-1]:
            remedy = "match with as many descriptors and landmarks as it was learned with"
            raise refuse("descriptors", f"{M.shape[-1]} columns, as the metric has", str(X.shape[1]), remedy)
        return X * M[None, :] if M.ndim == 1 else X @ M.T

    def __repr__(self) -> str:
        size = " × ".join(str(n) for n in np.shape(self.matrix))
        return f"Metric({describe_kernel(self.kernel)}, {size})"


@settings_record
class Network(_Transformed):
    """``kernel`` of the rows ``(x, f(x))``: descriptors, and beside them what a small network makes of them.

    The last column of each matrix (out, in + 1) is the bias; between layers stands tanh, after the last nothing.
    """

    layers: tuple[tuple[tuple[float, ...], ...], ...] = setting((), "matrices of the layers, biases last")
    columns: tuple[int, ...] = setting((), "descriptors that the network sees; none: all")

    def __post_init__(self) -> None:
        plain = tuple(tuple(tuple(row) for row in _matrix(m, "Network layer", 2).tolist()) for m in self.layers)
        if not plain:
            raise refuse("Network layers", "at least one matrix", "none", "give one")
        for inner, outer in pairwise(plain):
            if len(outer[0]) != len(inner) + 1:
                got = f"{len(outer[0])} columns after {len(inner)} rows"
                raise refuse("Network layers", "a column for each row before it and for the bias", got, "add one")
        object.__setattr__(self, "layers", plain)
        object.__setattr__(self, "columns", tuple(int(c) for c in self.columns))

    def transform(self, X: Array) -> Array:
        """Return the rows ``(x, f(x))``, (n, d + out), of descriptors ``X (n, d)``."""
        seen = take(X, np.asarray(self.columns), axis=1) if self.columns else X
        if len(self.layers[0][0]) != seen.shape[1] + 1:
            got = f"{seen.shape[1]}"
            raise refuse(
                "descriptors", f"{len(self.layers[0][0]) - 1} columns for the network", got, "compute them alike"
            )
        return namespace(X).concat([X, forward(tuple(like(m, X) for m in self.layers), seen)], axis=1)

    def __repr__(self) -> str:
        sizes = " → ".join(str(n) for n in [len(self.layers[0][0]) - 1, *(len(m) for m in self.layers)])
        return f"Network({describe_kernel(self.kernel)}, {sizes})"


@settings_record
class Scaled:
    """``factor · kernel(x, y)``: a share of a :class:`~kfmaps.kernels.kernels.Sum`."""

    kernel: KernelLike = setting(Gaussian, "the kernel inside")
    factor: float = setting(1.0, "factor of the kernel inside", above=0)

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return self.factor * kernel_matrix(self.kernel, X, Y)

    def diagonal(self, X: Array, /) -> Array:
        return self.factor * kernel_diagonal(self.kernel, X)


KERNELS: tuple[type, ...] = (*kernels.PLAIN_KERNELS, Metric, Network, Scaled)
"""Every kernel that a settings file can name."""


def descriptor_width(kernel: KernelLike) -> int | None:
    """Return how many descriptors ``kernel`` takes; ``None`` if it takes any number."""
    if isinstance(kernel, Metric):
        return int(np.shape(kernel.matrix)[-1])
    if isinstance(kernel, Network) and not kernel.columns:
        return len(kernel.layers[0][0]) - 1
    inside = map(descriptor_width, inner_kernels(kernel).values())
    return next((found for found in inside if found is not None), None)


def n_kernel_landmarks(kernel: KernelLike) -> int | None:
    """Return of how many landmarks the descriptors of ``kernel`` are; ``None`` if it does not say."""
    inside = map(n_kernel_landmarks, inner_kernels(kernel).values())
    return next((found for found in (getattr(kernel, "landmarks", None), *inside) if found is not None), None)


def forward(layers: tuple[Array, ...], X: Array) -> Array:
    """Return the outputs (n, out) of a network.

    ``layers``: as in :class:`Network`, the biases last; ``X (n, in)``.
    """
    xp = namespace(X)
    for i, matrix in enumerate(layers):
        X = (xp.tanh(X) if i else X) @ matrix[:, :-1].T + matrix[:, -1][None, :]
    return X


def _matrix(values: Array, name: str, ndim: int | None = None) -> np.ndarray:
    """``values`` as a finite array of one or two dimensions."""
    wanted = "a list of numbers, or lists of equally many" if ndim is None else "lists of equally many numbers"
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise refuse(name, wanted, f"{type(values).__name__}: {error}", "see docs/learning.md") from error
    if array.ndim not in ((1, 2) if ndim is None else (ndim,)) or array.size == 0 or not np.isfinite(array).all():
        raise refuse(name, f"finite numbers, {wanted}", f"shape {array.shape}", "see docs/learning.md")
    return array
