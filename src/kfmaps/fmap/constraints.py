"""Minimising a quadratic energy over maps that keep areas: ``C`` with orthonormal columns (or rows, if it has more).

A map between shapes keeps areas exactly when its functional map keeps inner products, ``CᵀC = I`` (Ovsjanikov et al.
2012; a constraint of the fit in Kovnatsky et al., MADMM, 2016). Such matrices are the Stiefel manifold. The energy is
minimised on it by preconditioned conjugate gradients in the tangent space with the polar factor for a retraction
(Absil, Mahony and Sepulchre, Optimization algorithms on matrix manifolds, 2008, chapter 8). Where a step of these does
not lower the energy enough, ``C ← polar(C − ∇E / L)`` is taken, which lowers it for every ``L`` that bounds the
operator: the energy lies below ``⟨∇E, X − C⟩ + ½ L ‖X − C‖²``, which this step minimises over all orthonormal ``X``. So
the energy never rises.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kfmaps._arrays import Array, check, inner, namespace
from kfmaps.fmap.solvers import CG, Direct, Operator, Solution, Solver, reason_to_stop
from kfmaps.fmap.terms import Term

_MAX_HALVINGS = 12  # shorter steps that are tried before the polar step


def nearest_orthogonal(C: Array) -> Array:
    """Return the polar factor of ``C (k_t, k_s)``: the nearest map with orthonormal columns (rows if ``k_t < k_s``)."""
    u, _, vh = namespace(C).linalg.svd(C, full_matrices=False)
    return u @ vh


def _tangent(C: Array, G: Array) -> Array:
    """The part of ``G`` that is tangent to the orthonormal matrices at ``C``; both (k_t, k_s)."""
    if C.shape[0] < C.shape[1]:
        return _tangent(C.T, G.T).T
    product = C.T @ G
    return G - 0.5 * (C @ (product + product.T))


def minimize_orthogonal(
    energy: Term,
    solver: Solver,
    start: Array,
    preconditioner: Operator | None = None,
    progress: Callable[[int, float], None] | None = None,
) -> Solution:
    """Minimise an energy among orthonormal maps, from a start.

    The problem is not convex: another start may lead to another minimum. The energy never rises from
    ``nearest_orthogonal(start)`` on.

    Parameters
    ----------
    energy : Term
    solver : CG
        ``rtol``: stop when the tangent part of the gradient is below ``rtol ‖B‖``; ``max_iter`` as usual. ``Direct``,
        which has no counterpart here, means a tolerance of 1e-10.
    start : (k_t, k_s)
        Made orthonormal first.
    preconditioner : callable, optional
        Self-adjoint, positive definite, near the inverse of the energy's operator.
    progress : callable, optional
        Called after each step with its number and the relative residual.

    Returns
    -------
    Solution
        ``residuals`` are norms of the tangent part of the gradient; ``steps`` are steps along the manifold, each two
        applications of the operator or more. ``"breakdown"``: rounding lets no step lower the energy any more.
    """
    settings = CG(rtol=1e-10, max_iter=5000) if isinstance(solver, Direct) else solver
    limit = np.inf if settings.max_iter is None else settings.max_iter
    right = energy.rhs()
    check(start, "start", shape=tuple(right.shape), remedy="give a functional map of the size of the basis")
    size = inner(right, right) ** 0.5 or 1.0
    here = _At(energy, right, nearest_orthogonal(start))
    gradient = _tangent(here.C, here.gradient)
    residuals = [inner(gradient, gradient) ** 0.5]
    direction, before, bound = None, None, None
    while (status := reason_to_stop(residuals, settings.rtol * size, limit)) is None:
        z = gradient if preconditioner is None else _tangent(here.C, preconditioner(gradient))
        gz = inner(gradient, z)
        direction = _next_direction(here.C, gradient, z, gz, direction, before)
        there = _line_search(energy, right, here, gradient, direction)
        if there is None:
            bound = bound or 1.1 * _largest_curvature(energy, here.C)
            there, bound = _polar_step(energy, right, here, bound)
            if there is None:
                status = "breakdown"
                break
            before = direction = None
        else:
            before = gradient, gz
        here = there
        gradient = _tangent(here.C, here.gradient)
        residuals.append(inner(gradient, gradient) ** 0.5)
        if progress is not None:
            progress(len(residuals) - 1, residuals[-1] / size)
    return Solution(here.C, status, len(residuals) - 1, np.asarray(residuals))


def _next_direction(
    C: Array, gradient: Array, z: Array, gz: float, direction: Array | None, before: tuple[Array, float] | None
) -> Array:
    """The conjugate direction (Polak and Ribière, kept positive); the preconditioned gradient ``z`` to begin with."""
    if direction is None or before is None or not gz > 0:
        return -z if gz > 0 else -gradient
    old_gradient, old_gz = before
    share = max(0.0, (gz - inner(_tangent(C, old_gradient), z)) / old_gz)
    direction = -z + share * _tangent(C, direction)
    return direction if inner(gradient, direction) < 0 else -z


class _At:
    """The energy (without its constant) and its gradient at ``C``, for one application of the operator."""

    def __init__(self, energy: Term, right: Array, C: Array) -> None:
        applied = energy.apply(C)
        self.C = C
        self.gradient = applied - right
        self.value = 0.5 * inner(C, applied) - inner(right, C)


def _line_search(energy: Term, right: Array, here: _At, gradient: Array, direction: Array) -> _At | None:
    """A point along ``direction`` that is lower, the first guess that of the quadratic model on the manifold."""
    slope = inner(gradient, direction)
    wide = here.C.shape[0] < here.C.shape[1]
    product = here.gradient @ here.C.T if wide else here.C.T @ here.gradient
    product = 0.5 * (product + product.T)
    bent = product @ direction if wide else direction @ product
    straight = inner(direction, energy.apply(direction))
    curvature = straight - inner(direction, bent)
    if not curvature > 1e-3 * straight:
        curvature = straight
    if not (curvature > 0 and np.isfinite(curvature) and slope < 0):
        return None
    step = -slope / curvature
    for _ in range(_MAX_HALVINGS):
        there = _At(energy, right, nearest_orthogonal(here.C + step * direction))
        # Armijo's rule. Near the minimum a step's decrease is lost in the rounding of the value.
        if there.value <= here.value + 1e-4 * step * slope + 1e-14 * abs(here.value):
            return there
        step *= 0.5
    return None


def _polar_step(energy: Term, right: Array, here: _At, bound: float) -> tuple[_At | None, float]:
    """``polar(C − ∇E / L)`` and the ``L`` that lowered the energy; ``None`` where rounding lets none."""
    for _ in range(_MAX_HALVINGS):
        there = _At(energy, right, nearest_orthogonal(here.C - here.gradient / bound))
        if there.value < here.value:
            return there, bound
        bound *= 2.0
    return None, bound


def _largest_curvature(energy: Term, like: Array) -> float:
    """The largest eigenvalue of the energy's operator, from below, by the power method from ``like``."""
    x = like + 0.01 * namespace(like).ones_like(like)
    value = 0.0
    for _ in range(20):
        x = x / inner(x, x) ** 0.5
        applied = energy.apply(x)
        value, x = inner(x, applied), applied
        if not value > 0:
            return 1.0
    return value
