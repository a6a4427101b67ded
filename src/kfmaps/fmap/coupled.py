"""Bases of two shapes, rotated so that their functions correspond.

Eigenfunctions of two shapes that are not isometric drift apart: their order, signs and subspaces differ. Coupled bases
``Φ_s U_s``, ``Φ_t U_t`` keep the Laplacians nearly diagonal and make corresponding functions have nearly the same
coefficients (Kovnatsky, Bronstein, Bronstein, Glashoff and Kimmel, Coupled quasi-harmonic bases, 2013). In them the
functional map is near the identity, so terms that want a nearly diagonal map are right.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, check, namespace
from kfmaps.fmap.constraints import nearest_orthogonal
from kfmaps.fmap.losses import Penalty
from kfmaps.fmap.terms import Term
from kfmaps.geometry.basis import Basis


@dataclass(frozen=True, eq=False)
class CoupledBases:
    """Rotations ``U_s`` (k_s, k_s) and ``U_t`` (k_t, k_t) and the objective before the first step and after each."""

    U_s: Array
    U_t: Array
    history: np.ndarray

    def to_rotated(self, source: Basis, target: Basis) -> tuple[Basis, Basis]:
        """Return the coupled bases, with the Dirichlet energies of their functions for eigenvalues."""
        return _rotated(source, self.U_s), _rotated(target, self.U_t)


def couple_bases(values_s: Array, values_t: Array, cross: Array, weight: float) -> CoupledBases:
    """Diagonalise two Laplacians jointly and approximately, coupled by corresponding functions.

    Minimises ``½ Σ off(U_xᵀ Λ_x U_x) / ‖Λ_x‖² − weight tr(U_tᵀ cross U_s) / Σσ(cross)`` over rotations, where ``off``
    is the sum of squares off the diagonal and the last term is, up to a constant, the squared difference of the
    coefficients ``U_sᵀ p`` and ``U_tᵀ q`` of corresponding functions. ``off`` is a constant less the convex ``Σ
    (uᵀΛu)²``; with that replaced by its tangent the minimiser in each rotation is a polar factor, so the objective
    falls in every step.

    Parameters
    ----------
    values_s, values_t : (k_s,), (k_t,)
        Eigenvalues.
    cross : (k_t, k_s)
        ``Σ q pᵀ`` over the coefficients of corresponding functions, or a functional map, which makes all functions
        correspond. Where it is square ``U_t`` starts at its polar factor, else at the identity.
    weight : float
        Of the coupling.
    """
    xp = namespace(cross)
    k_t, k_s = cross.shape
    check(values_s, "values_s", shape=(k_s,))
    check(values_t, "values_t", shape=(k_t,))
    size = float(xp.sum(xp.linalg.svd(cross, full_matrices=False)[1])) or 1.0
    U_s = xp.eye(k_s, dtype=cross.dtype, device=cross.device)
    U_t = nearest_orthogonal(cross) if k_t == k_s else xp.eye(k_t, dtype=cross.dtype, device=cross.device)
    cross = cross * (weight / size)
    unit_s, unit_t = (values / (float(xp.sum(values * values)) ** 0.5 or 1.0) for values in (values_s, values_t))
    k = min(k_t, k_s)

    def objective() -> float:
        off = [float(xp.sum(v * v) - xp.sum(_diagonal(v, U) ** 2)) for v, U in ((unit_s, U_s), (unit_t, U_t))]
        return 0.5 * sum(off) - float(xp.sum((cross @ U_s)[:, :k] * U_t[:, :k]))

    history = [objective()]
    for _ in range(100):
        U_s = nearest_orthogonal(_gradient(unit_s, U_s) + _with_columns(cross.T @ U_t, k_s))
        U_t = nearest_orthogonal(_gradient(unit_t, U_t) + _with_columns(cross @ U_s, k_t))
        history.append(objective())
        if history[-2] - history[-1] <= 1e-6 * max(abs(history[-2]), 1e-300):
            break
    return CoupledBases(U_s, U_t, np.asarray(history))


def _gradient(values: Array, U: Array) -> Array:
    """Return the gradient of ``½ Σ (uᵀΛu)²``."""
    return 2.0 * (values[:, None] * U) * _diagonal(values, U)[None, :]


def _with_columns(matrix: Array, k: int) -> Array:
    """Return the first ``k`` columns of a matrix, zeros where it has fewer."""
    xp = namespace(matrix)
    if matrix.shape[1] >= k:
        return matrix[:, :k]
    zeros = xp.zeros((k, k - matrix.shape[1]), dtype=matrix.dtype, device=matrix.device)
    return xp.concat([matrix, zeros], axis=1)


def _diagonal(values: Array, U: Array) -> Array:
    """Return the diagonal of ``Uᵀ Λ U``."""
    return namespace(U).sum(U * (values[:, None] * U), axis=0)


def _rotated(basis: Basis, U: Array) -> Basis:
    k = U.shape[0]
    return Basis(_diagonal(basis.eigenvalues[:k], U), basis.functions[:, :k] @ U, basis.mass)


@dataclass(frozen=True, eq=False)
class RotatedTerm:
    """A term of the map between the bases rotated by ``U_t`` and ``U_s``, ``C ↦ term(U_tᵀ C U_s)``."""

    term: Term
    U_t: Array
    U_s: Array

    def apply(self, C: Array) -> Array:
        return self.U_t @ self.term.apply(self.U_t.T @ C @ self.U_s) @ self.U_s.T

    def rhs(self) -> Array:
        return self.U_t @ self.term.rhs() @ self.U_s.T

    def diagonal(self, U_t: Array | None = None, U_s: Array | None = None) -> Array:
        V_t = self.U_t.T if U_t is None else self.U_t.T @ U_t
        V_s = self.U_s.T if U_s is None else self.U_s.T @ U_s
        return self.term.diagonal(V_t, V_s)

    def constant(self) -> float:
        return self.term.constant()

    def sides(self) -> tuple[Array, Array]:
        S_t, S_s = self.term.sides()
        return self.U_t @ S_t @ self.U_t.T, self.U_s @ S_s @ self.U_s.T


@dataclass(frozen=True, eq=False)
class RotatedPenalty:
    """A penalty of the map between the bases rotated by ``U_t`` and ``U_s``."""

    penalty: Penalty
    U_t: Array
    U_s: Array

    def value(self, C: Array) -> float:
        return self.penalty.value(self.U_t.T @ C @ self.U_s)

    def majorizer(self, C: Array) -> Term:
        return RotatedTerm(self.penalty.majorizer(self.U_t.T @ C @ self.U_s), self.U_t, self.U_s)
