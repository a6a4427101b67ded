"""Factorisation of sparse symmetric positive definite matrices, and solves with many right-hand sides."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.sparse import csc_array, diags_array
from scipy.sparse.linalg import SuperLU, splu

from kfmaps._arrays import NotConverged, blocks

Solve = Callable[[np.ndarray], np.ndarray]
SparseMatrix = Any
"""A SciPy sparse array or matrix."""


_COLUMNS = 4
"""Right-hand sides that are solved at once. SuperLU reads the factor once for all of them; more are no faster."""


def factorize(matrix: SparseMatrix, ordered: bool = False) -> Solve:
    """Factorise ``matrix`` once and return the function that solves with it.

    ``matrix (n, n)``: symmetric, float32 or float64, the precision of the factor. It is not pivoted: right when it is
    positive definite, else to be checked by its solutions. Then an ordering of ``A + Aᵀ`` serves, with half the factor
    that SciPy's default, made for unsymmetric matrices, gives. ``ordered``: whether the rows are already in an order
    that keeps the factor small; else SuperLU finds one. Returns ``(n, b) -> (n, b)`` float64 in column-major order.
    """
    return _solver(_factor(matrix, ordered), matrix.dtype)


class ShiftedFactorizer:
    """Factorise multiples of one matrix plus diagonals: the order of rows that SuperLU finds for the first serves all.

    To find it takes more than half of the time of a factorisation. ``matrix (n, n)``: symmetric, positive
    semi-definite.
    """

    def __init__(self, matrix: SparseMatrix) -> None:
        self.matrix = matrix
        self._ordered: tuple[np.ndarray, np.ndarray, csc_array, np.ndarray] | None = None

    def __call__(self, scale: float, diagonal: np.ndarray) -> Solve:
        """Return what :func:`factorize` returns for ``scale · matrix + diag(diagonal)``, ``diagonal (n,)``."""
        if self._ordered is None:
            # Nothing but the order is kept of this factor, whose last bits are others: no answer may depend on which of
            # several threads asks first.
            order = np.argsort(_factor(scale * self.matrix + diags_array(diagonal), ordered=False).perm_c)
            self._ordered = order, np.argsort(order), *self._with_diagonal(order)
        order, back, base, places = self._ordered
        data = scale * base.data
        data[places] += diagonal[order]
        solve = factorize(csc_array((data, base.indices, base.indptr), shape=base.shape), ordered=True)
        return lambda block: solve(block[order])[back]

    def _with_diagonal(self, order: np.ndarray) -> tuple[csc_array, np.ndarray]:
        """Return the matrix in an ``order (n,)`` with all of its diagonal, and where that is among the entries."""
        base = csc_array(csc_array(self.matrix + diags_array(np.ones(len(order))))[order][:, order])
        base.sort_indices()
        columns = np.repeat(np.arange(len(order)), np.diff(base.indptr))
        places = np.flatnonzero(base.indices == columns)
        base.data[places] = self.matrix.diagonal()[order]
        return base, places


def _factor(matrix: SparseMatrix, ordered: bool) -> SuperLU:
    try:
        return splu(
            csc_array(matrix),
            permc_spec="NATURAL" if ordered else "MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise NotConverged(f"factorisation: {error}. The mesh has parts without area or stiffness.") from error


def _solver(factor: SuperLU, precision: np.dtype) -> Solve:
    def solve(block: np.ndarray) -> np.ndarray:
        right = np.asfortranarray(block, dtype=precision)
        result = np.empty(right.shape, order="F")
        for part in blocks(right.shape[1], _COLUMNS):
            result[:, part] = factor.solve(right[:, part])
        return result

    return solve
