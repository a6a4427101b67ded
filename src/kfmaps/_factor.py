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
Sparse = Any
"""A SciPy sparse array or matrix."""


COLUMNS = 4
"""Right-hand sides that one thread solves at once. SuperLU reads the factor once for all of them; with fewer,
the threads spend together more than they save. How the columns are split changes no bit of the answer."""


def _metis_order(matrix: Sparse) -> np.ndarray:
    """Nested-dissection order of the rows (METIS), (n,)."""
    import pymetis

    graph: Any = csr_array(matrix, copy=True)
    graph.setdiag(0)
    graph.eliminate_zeros()
    adjacency = pymetis.CSRAdjacency(graph.indptr, graph.indices)
    order, _ = pymetis.nested_dissection(adjacency)
    return np.asarray(order)


def factorise(matrix: Sparse, ordering: str = "auto", each: Map = map) -> Solve:
    """Factorise ``matrix`` once and return the function that solves with it.

    Parameters
    ----------
    matrix : (n, n) sparse
        Symmetric positive definite. SuperLU then needs no pivoting, and an ordering of ``A + Aᵀ`` halves the
        factor that its default, made for unsymmetric matrices, would give.
    ordering : {"auto", "metis", "mmd"}
        ``"metis"``: nested dissection, a smaller factor and faster solves from some ten thousand rows, needs
        ``kfmaps[fast]``. ``"mmd"``: minimum degree, part of SciPy. ``"auto"``: METIS where it is installed.
    each : callable
        ``map``, or that of a thread pool: over it the blocks of right-hand sides are spread (SuperLU releases
        the interpreter's lock).

    Returns
    -------
    callable
        ``(n, b) -> (n, b)`` in column-major order.

    Raises
    ------
    MissingDependency
        When METIS is asked for and not installed.
    NotConverged
        When the matrix is singular to working precision.
    """
    if ordering not in ("auto", "metis", "mmd"):
        raise refuse("ordering", "'auto', 'metis' or 'mmd'", repr(ordering), "choose one of them")
    metis = ordering != "mmd" and find_spec("pymetis") is not None
    if ordering == "metis" and not metis:
        raise MissingDependency("ordering 'metis' needs pymetis; install it with: pip install 'kfmaps[fast]'")
    order = _metis_order(matrix) if metis else None
    permuted = csc_array(matrix if order is None else csr_array(matrix)[order][:, order])
    try:
        factor = splu(
            permuted,
            permc_spec="MMD_AT_PLUS_A" if order is None else "NATURAL",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise NotConverged(f"factorisation: {error}; the mesh has parts without area or stiffness") from error

    def solve(block: np.ndarray) -> np.ndarray:
        right = np.asfortranarray(block if order is None else block[order])
        starts = range(0, right.shape[1], COLUMNS)
        parts = [right] if each is map else [right[:, s : s + COLUMNS] for s in starts]
        solved = np.hstack(list(each(factor.solve, parts))) if len(parts) > 1 else factor.solve(right)
        if order is None:
            return np.asfortranarray(solved)
        result = np.empty_like(solved, order="F")
        result[order] = solved
        return result

    return solve
