"""Penalties that are not quadratic, robust losses of the data and sparsity, by reweighted least squares.

A *penalty* has a value and a quadratic majorizer: a term that lies above it and touches it at the current map
(:class:`Penalty`). Minimising the energy with the majorizer in the penalty's place lowers the true objective, whatever
else it is made of; :func:`kfmaps.fmap.minimize.minimize` does so until it falls no more. So a penalty can be combined
with every term, kernel, constraint and solver.

With ``e_g`` the squared residual of a group of data (a landmark, a descriptor, a feature) and a scale ``δ``:

============  ===========================  ====================  ===============================
loss          ρ(e), halved and summed      weight ρ'(e)          source
============  ===========================  ====================  ===============================
"squared"     e                            1
"huber"       e, or 2δ√e − δ² above δ²     1, or δ/√e            Huber 1964
"l21"         2δ√(e + (δ/1000)²)           δ/√(e + (δ/1000)²)    Kovnatsky et al. 2015 (L2,1)
"geman"       δ²e / (δ² + e)               (δ² / (δ² + e))²      Geman and McClure 1987
============  ===========================  ====================  ===============================

All are concave in ``e``, so the reweighted term lies above them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal, Protocol, get_args

import numpy as np

from kfmaps._arrays import Array, check_positive, like, namespace, refuse, to_numpy
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.terms import Elementwise, Term, operator_term, source_term

LossName = Literal["squared", "huber", "l21", "geman"]
_LOSSES = get_args(LossName)


class Penalty(Protocol):
    """A function of C with a quadratic majorizer; all arrays have shape (k_t, k_s)."""

    def value(self, C: Array) -> float:
        """Return the penalty at ``C``, at least zero."""
        ...

    def majorizer(self, C: Array) -> Term:
        """Return a term that, up to a constant, is never below ``value(X)`` and equals it where ``X`` is ``C``."""
        ...


@dataclass(frozen=True)
class Loss:
    """A robust loss of group residuals and its scale ``delta``, in the unit of ``√e``; see the module's table.

    Raises
    ------
    InvalidInput
        On an unknown name, or a scale that is not above zero.
    """

    name: LossName = "huber"
    delta: float = 1.0

    def __post_init__(self) -> None:
        if self.name not in _LOSSES:
            raise refuse("loss", "one of " + ", ".join(_LOSSES), repr(self.name), "choose one of them")
        check_positive(self.delta, "loss delta")

    def value(self, e: np.ndarray) -> np.ndarray:
        """Return ρ of the squared residuals ``e (g,)``."""
        d = self.delta
        if self.name == "squared":
            return e
        if self.name == "huber":
            return np.where(e <= d * d, e, 2 * d * np.sqrt(e) - d * d)
        if self.name == "l21":
            return 2 * d * np.sqrt(e + (1e-3 * d) ** 2)
        return d * d * e / (d * d + e)

    def weights(self, e: np.ndarray) -> np.ndarray:
        """Return ρ' of the squared residuals ``e (g,)``."""
        d = self.delta
        if self.name == "squared":
            return np.ones_like(e)
        if self.name == "huber":
            return d / np.sqrt(np.maximum(e, d * d))
        if self.name == "l21":
            return d / np.sqrt(e + (1e-3 * d) ** 2)
        return (d * d / (d * d + e)) ** 2


@dataclass(frozen=True, eq=False)
class RobustData:
    """``½ Σ_g s_g ρ(e_g / s_g)``, ``e_g = Σ_{i in g} ‖C p_i − q_i‖² + ν ‖C X_i − Y_i C‖²``: data by groups."""

    coefficients_s: Array  # (k_s, r): ``p_i``, a column for each descriptor or feature
    coefficients_t: Array  # (k_t, r): ``q_i``
    groups: np.ndarray  # (r,): the group of each column; a group below zero keeps the squared loss
    loss: Loss
    operators_s: Array | None = None  # (r, k_s, k_s): ``X_i``, symmetric
    operators_t: Array | None = None  # (r, k_t, k_t): ``Y_i``
    commutativity: float = 0.0  # ``ν``
    sizes: np.ndarray | None = None  # (g,): ``s_g``, for a loss of relative residuals; ``None`` is 1 for all

    def residuals(self, C: Array) -> np.ndarray:
        """Return the squared residuals ``e / s`` at ``C`` of the groups ``0, 1, …``, (g,)."""
        return self._relative(self._grouped(self._columns(C)))

    def scaled(self, C: Array, width: float) -> RobustData:
        """Return the same with ``delta`` at ``width`` times the median residual of the groups at ``C``."""
        e = self.residuals(C)
        delta = width * float(np.sqrt(np.median(e))) if len(e) else 1.0
        return replace(self, loss=Loss(self.loss.name, max(delta, 1e-150)))

    def weights(self, C: Array) -> np.ndarray:
        """Return the weight of each column at ``C``, (r,), from 0 to 1 but for "l21"."""
        weights = np.append(self.loss.weights(self.residuals(C)), 1.0)
        return weights[np.where(self.groups < 0, len(weights) - 1, self.groups)]

    def value(self, C: Array) -> float:
        e = self._columns(C)
        losses = self.loss.value(self._relative(self._grouped(e)))
        losses = losses if self.sizes is None else self.sizes * losses
        return 0.5 * float(losses.sum() + e[self.groups < 0].sum())

    def majorizer(self, C: Array) -> Term:
        w = like(self.weights(C), self.coefficients_s)
        P_s, P_t = self.coefficients_s, self.coefficients_t
        weighted = P_s * w[None, :]
        total = 0.5 * float(namespace(P_t).sum(P_t * P_t * w[None, :]))
        data: Term = source_term(weighted @ P_s.T, P_t @ weighted.T, total)
        if self.operators_s is None or self.operators_t is None or not self.commutativity:
            return data
        root = namespace(w).sqrt(w)[:, None, None]
        terms = {"data": data, "operators": operator_term(root * self.operators_s, root * self.operators_t)}
        return Energy(terms, {"data": 1.0, "operators": self.commutativity})

    def _relative(self, e: np.ndarray) -> np.ndarray:
        return e if self.sizes is None else e / self.sizes

    def _columns(self, C: Array) -> np.ndarray:
        xp = namespace(C)
        residual = C @ self.coefficients_s - self.coefficients_t
        e = xp.sum(residual * residual, axis=0)
        if self.operators_s is not None and self.commutativity:
            difference = C @ self.operators_s - self.operators_t @ C
            e = e + self.commutativity * xp.sum(difference * difference, axis=(1, 2))
        return to_numpy(e)

    def _grouped(self, columns: np.ndarray) -> np.ndarray:
        inside = self.groups >= 0
        return np.bincount(self.groups[inside], columns[inside]) if inside.any() else np.zeros(0)


@dataclass(frozen=True, eq=False)
class _Sparse:
    """``Σ weights √(C² + ε²)``: the L1 norm, smoothed at zero; made by :func:`sparse_penalty`.

    Of the functional map, whose entries are of the order of 1, or below it off the diagonal.
    """

    weights: Array  # (k_t, k_s)
    smoothing: float = 1e-3

    def value(self, C: Array) -> float:
        xp = namespace(C)
        return float(xp.sum(self.weights * xp.sqrt(C * C + self.smoothing**2)))

    def majorizer(self, C: Array) -> Term:
        xp = namespace(C)
        return Elementwise(self.weights / xp.sqrt(C * C + self.smoothing**2))


def sparse_penalty(example: Array, smoothing: float = 1e-3) -> _Sparse:
    """Return the sparsity of maps of the shape of ``example (k_t, k_s)``, with weights that grow from the diagonal.

    They are 0 on the line between the two corners and 1 in the others (Pokrass et al., Sparse modeling of intrinsic
    correspondences, 2013, whose weights grow likewise). ``smoothing`` rounds the L1 norm at zero.
    """
    k_t, k_s = example.shape
    check_positive(smoothing, "smoothing")
    rows, columns = np.arange(k_t) / max(k_t - 1, 1), np.arange(k_s) / max(k_s - 1, 1)
    return _Sparse(like(np.abs(rows[:, None] - columns[None, :]), example), smoothing)
