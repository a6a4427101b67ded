"""The kernel of descriptors in a learned metric, as a record of plain numbers."""

from __future__ import annotations

import numpy as np

from kfmaps._arrays import Array, check_count, like, refuse
from kfmaps._records import setting, settings_record
from kfmaps.kernels import kernels
from kfmaps.kernels.kernels import Gaussian, KernelLike, describe_kernel, inner_kernels, kernel_diagonal, kernel_matrix

_WANTED = "lists of equally many finite numbers"


@settings_record
class Metric:
    """``kernel(M x, M y)``: distances and products in the metric ``MᵀM``.

    Descriptors of other landmarks are other descriptors: their number is checked by
    :func:`kfmaps.matching.features.resolve_kernel_width`.

    Examples
    --------
    >>> metric = kfmaps.Metric(kfmaps.Linear(), ((1.0, 0.0), (0.0, 2.0)))
    >>> metric(np.array([[1.0, 1.0]]), np.array([[1.0, 1.0]]))
    array([[5.]])
    """

    kernel: KernelLike = setting(Gaussian, "the kernel inside")
    matrix: tuple[tuple[float, ...], ...] = setting((), "rows of M (r, d)")
    landmarks: int | None = setting(None, "landmarks that it was learned with", low=0)

    def __post_init__(self) -> None:
        if self.landmarks is not None:
            check_count(self.landmarks, "Metric landmarks", low=0)
        try:
            matrix = np.asarray(self.matrix, dtype=np.float64)
        except (TypeError, ValueError) as error:
            got = f"{type(self.matrix).__name__}: {error}"
            raise refuse("Metric matrix", _WANTED, got, "see docs/learning.md") from error
        if matrix.ndim != 2 or matrix.size == 0 or not np.isfinite(matrix).all():
            raise refuse("Metric matrix", _WANTED, f"shape {matrix.shape}", "see docs/learning.md")
        object.__setattr__(self, "matrix", tuple(map(tuple, matrix.tolist())))

    def transform(self, X: Array) -> Array:
        """Return the rows ``M x``, (n, r), of descriptors ``X (n, d)``."""
        M = like(self.matrix, X)
        if X.shape[1] != M.shape[1]:
            remedy = "match with as many descriptors and landmarks as it was learned with"
            raise refuse("descriptors", f"{M.shape[1]} columns, as the metric has", str(X.shape[1]), remedy)
        return X @ M.T

    def __call__(self, X: Array, Y: Array, /) -> Array:
        return kernel_matrix(self.kernel, self.transform(X), self.transform(Y))

    def diagonal(self, X: Array, /) -> Array:
        """Return ``k(x, x)`` of each row, (n,)."""
        return kernel_diagonal(self.kernel, self.transform(X))

    def __repr__(self) -> str:
        return f"Metric({describe_kernel(self.kernel)}, {len(self.matrix)} × {len(self.matrix[0])})"


KERNELS: tuple[type, ...] = (*kernels.PLAIN_KERNELS, Metric)
"""Every kernel that a settings file can name."""


def descriptor_width(kernel: KernelLike) -> int | None:
    """Return how many descriptors ``kernel`` takes; ``None`` if it takes any number."""
    if isinstance(kernel, Metric):
        return len(kernel.matrix[0])
    inside = map(descriptor_width, inner_kernels(kernel).values())
    return next((found for found in inside if found is not None), None)


def n_kernel_landmarks(kernel: KernelLike) -> int | None:
    """Return of how many landmarks the descriptors of ``kernel`` are; ``None`` if it does not say."""
    inside = map(n_kernel_landmarks, inner_kernels(kernel).values())
    return next((found for found in (getattr(kernel, "landmarks", None), *inside) if found is not None), None)
