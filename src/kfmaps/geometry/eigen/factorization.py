"""Factorisation of sparse symmetric positive definite matrices, and solves with many right-hand sides."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib.util import find_spec
from typing import Any

import numpy as np
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import splu

from kfmaps._arrays import MissingDependency, NotConverged, refuse

Solve = Callable[[np.ndarray], np.ndarray]
Map = Callable[..., Iterable[Any]]
SparseMatrix = Any
"""A SciPy sparse array or matrix."""


_COLUMNS = 4
"""Right-hand sides that are solved at once. SuperLU reads the factor once for all of them; with fewer, threads spend
together more than they save. They are split so with one thread too, at no cost: on some processors the last bits hang
on how many there are."""


def fill_order(matrix: SparseMatrix, ordering: str = "auto") -> np.ndarray | None:
    """Return an order of the rows, (n,), in which a factor stays small; ``None`` leaves it to SuperLU.

    ``matrix (n, n)``: symmetric in its pattern. ``ordering``: ``"metis"``: nested dissection, a smaller factor and
    faster solves from some ten thousand rows; needs ``kfmaps[fast]``. ``"mmd"``: SuperLU's minimum degree. ``"auto"``:
    METIS where it is installed.
    """
    if ordering not in ("auto", "metis", "mmd"):
        raise refuse("ordering", "'auto', 'metis' or 'mmd'", repr(ordering), "choose one of them")
    if ordering == "mmd":
        return None
    if find_spec("pymetis") is None:
        if ordering == "auto":
            return None
        raise MissingDependency("ordering 'metis' needs pymetis. Install it with: pip install 'kfmaps[fast]'.")
    import pymetis

    graph: Any = csr_array(matrix, copy=True)
    graph.setdiag(0)
    graph.eliminate_zeros()
    order, _ = pymetis.nested_dissection(pymetis.CSRAdjacency(graph.indptr, graph.indices))
    return np.asarray(order)


def factorize(matrix: SparseMatrix, ordered: bool, each: Map = map) -> Solve:
    """Factorise ``matrix`` once and return the function that solves with it.

    ``matrix (n, n)``: Symmetric, float32 or float64, the precision of the factor. It is not pivoted: right when it is
    positive definite, else to be checked by its solutions. Then an ordering of ``A + Aᵀ`` serves, with half the factor
    that SciPy's default, made for unsymmetric matrices, gives. ``ordered``: whether the rows are already in a
    :func:`fill_order`; else SuperLU finds one; ``each``: ``map``, or that of a thread pool, over which the blocks of
    right-hand sides are spread (SuperLU releases the interpreter's lock). Returns ``(n, b) -> (n, b)`` float64 in
    column-major order.
    """
    return _solver(_factor(matrix, ordered), matrix.dtype, each)


class PatternFactorizer:
    """Factorise symmetric matrices of one pattern: the order of the rows that SuperLU finds for the first serves all.

    To find it takes more than half of the time of a factorisation. Called with a matrix ``(n, n)`` it returns what
    :func:`factorize` returns.
    """

    def __init__(self) -> None:
        self._order: np.ndarray | None = None

    def __call__(self, matrix: SparseMatrix) -> Solve:
        if self._order is None:
            factor = _factor(matrix, ordered=False)
            self._order = np.argsort(factor.perm_c)
            return _solver(factor, matrix.dtype, map)
        order, back = self._order, np.argsort(self._order)
        solve = factorize(csc_array(matrix)[order][:, order], ordered=True)
        return lambda block: solve(block[order])[back]


def _factor(matrix: SparseMatrix, ordered: bool) -> Any:
    try:
        return splu(
            csc_array(matrix),
            permc_spec="NATURAL" if ordered else "MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise NotConverged(f"factorisation: {error}. The mesh has parts without area or stiffness.") from error


def _solver(factor: Any, precision: np.dtype, each: Map) -> Solve:
    def solve(block: np.ndarray) -> np.ndarray:
        right = np.asfortranarray(block, dtype=precision)
        parts = [right[:, start : start + _COLUMNS] for start in range(0, right.shape[1], _COLUMNS)]
        result = np.empty(right.shape, order="F")
        for i, part in enumerate(each(factor.solve, parts)):
            result[:, i * _COLUMNS : (i + 1) * _COLUMNS] = part
        return result

    return solve
