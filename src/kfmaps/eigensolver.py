"""The smallest eigenpairs of a sparse symmetric pencil with a diagonal mass, by shift and invert."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import diags_array
from scipy.sparse.linalg import LinearOperator, eigsh, splu

from kfmaps._arrays import NotConverged, check, check_count
from kfmaps._threads import one_blas_thread


@dataclass(frozen=True, eq=False)
class Eigenpairs:
    """What :func:`smallest_eigenpairs` found.

    Attributes
    ----------
    values : (k,) float64
        Ascending, none below zero.
    vectors : (n, k) float64
        Mass-orthonormal columns.
    residuals : (k,) float64
        Scaled residual of each pair; see :func:`smallest_eigenpairs`.
    """

    values: np.ndarray
    vectors: np.ndarray
    residuals: np.ndarray


def smallest_eigenpairs(
    stiffness, mass, k, *, tolerance=1e-10, rng=0, threads=None, method="auto"
) -> Eigenpairs:
    """The ``k`` smallest eigenpairs of ``stiffness x = λ mass x``."""
    n = stiffness.shape[0]
    check(mass, "mass", shape=(n,))
    check_count(k, "k", 1, n - 1)
    root = np.sqrt(mass)
    shift = 1e-2 * 4 * np.pi / mass.sum()
    with one_blas_thread():
        factor = splu(
            (stiffness + shift * diags_array(mass)).tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0,
            options={"SymmetricMode": True},
        )
        inverse = LinearOperator((n, n), matvec=lambda x: root * factor.solve(root * x), dtype=np.float64)
        start = np.random.default_rng(rng).normal(size=n)
        nu, y = eigsh(inverse, k=k, which="LM", v0=start, tol=0)
        order = np.argsort(-nu)
        nu, y = nu[order], y[:, order]
        vectors = factor.solve(root[:, None] * y) / nu
    values = np.maximum(1 / nu - shift, 0)
    left, right = stiffness @ vectors, mass[:, None] * vectors * values
    gap = np.linalg.norm(left - right, axis=0)
    residuals = gap / np.maximum(
        np.linalg.norm(right, axis=0), shift * np.linalg.norm(mass[:, None] * vectors, axis=0)
    )
    if residuals.max() > 1e-6:
        raise NotConverged(f"eigenpairs: residual {residuals.max():.1e}, wanted {tolerance:.1e}")
    return Eigenpairs(values, vectors, residuals)
