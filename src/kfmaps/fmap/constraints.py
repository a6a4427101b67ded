"""Minimisation of a quadratic energy over area-preserving maps, ``C`` with orthonormal columns (rows if wide).

A map between shapes preserves areas exactly when its functional map preserves inner products, ``CᵀC = I`` (Ovsjanikov
et al. 2012; a constraint of the fit in Kovnatsky et al., MADMM, 2016). Such matrices form the Stiefel manifold. The
energy is minimised on it by preconditioned conjugate gradients in the tangent space, with the polar factor as the
retraction (Absil, Mahony and Sepulchre, Optimization algorithms on matrix manifolds, 2008, chapter 8). Where such a
step does not lower the energy enough, ``C ← polar(C − ∇E / L)`` is taken instead. It lowers the energy for every ``L``
that bounds the operator, since it minimises the upper bound ``⟨∇E, X − C⟩ + ½ L ‖X − C‖²`` over all orthonormal ``X``.
So the energy never rises.
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
    """Return the part of ``G`` that is tangent to the orthonormal matrices at ``C``; both (k_t, k_s)."""
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
        ``rtol``: stop when the tangent part of the gradient is below ``rtol ‖B‖``. ``Direct`` means ``CG(1e-10,
        5000)``.
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
    point = _Point(energy, right, nearest_orthogonal(start))
    gradient = _tangent(point.C, point.gradient)
    residuals = [inner(gradient, gradient) ** 0.5]
    direction, previous, bound = None, None, None
    while (status := reason_to_stop(residuals, settings.rtol * size, limit)) is None:
        z = gradient if preconditioner is None else _tangent(point.C, preconditioner(gradient))
        gz = inner(gradient, z)
        direction = _next_direction(point.C, gradient, z, gz, direction, previous)
        previous = gradient, gz
        lower = _line_search(energy, right, point, gradient, direction)
        if lower is None:
            bound = bound or 1.1 * _largest_curvature(energy, point.C)
            lower, bound = _polar_step(energy, right, point, bound)
            previous = direction = None
        if lower is None:
            status = "breakdown"
            break
        point = lower
        gradient = _tangent(point.C, point.gradient)
        residuals.append(inner(gradient, gradient) ** 0.5)
        if progress is not None:
            progress(len(residuals) - 1, residuals[-1] / size)
    return Solution(point.C, status, len(residuals) - 1, np.asarray(residuals))


def _next_direction(
    C: Array, gradient: Array, z: Array, gz: float, direction: Array | None, previous: tuple[Array, float] | None
) -> Array:
    """Return the conjugate direction (Polak and Ribière, β ≥ 0); the first is the preconditioned gradient ``z``."""
    if direction is None or previous is None or not gz > 0:
        return -z if gz > 0 else -gradient
    old_gradient, old_gz = previous
    beta = max(0.0, (gz - inner(_tangent(C, old_gradient), z)) / old_gz)
    direction = -z + beta * _tangent(C, direction)
    return direction if inner(gradient, direction) < 0 else -z


class _Point:
    """A map ``C`` with its energy (without the constant) and gradient, by one application of the operator."""

    def __init__(self, energy: Term, right: Array, C: Array) -> None:
        applied = energy.apply(C)
        self.C = C
        self.gradient = applied - right
        self.value = 0.5 * inner(C, applied) - inner(right, C)


def _line_search(energy: Term, right: Array, point: _Point, gradient: Array, direction: Array) -> _Point | None:
    """Return a lower point along ``direction``; the first step is that of the quadratic model on the manifold."""
    slope = inner(gradient, direction)
    is_wide = point.C.shape[0] < point.C.shape[1]
    product = point.gradient @ point.C.T if is_wide else point.C.T @ point.gradient
    product = 0.5 * (product + product.T)
    correction = product @ direction if is_wide else direction @ product  # of the curved manifold
    flat_curvature = inner(direction, energy.apply(direction))
    curvature = flat_curvature - inner(direction, correction)
    if not curvature > 1e-3 * flat_curvature:
        curvature = flat_curvature
    if not (curvature > 0 and np.isfinite(curvature) and slope < 0):
        return None
    step = -slope / curvature
    for _ in range(_MAX_HALVINGS):
        candidate = _Point(energy, right, nearest_orthogonal(point.C + step * direction))
        # Armijo's rule. Near the minimum the decrease is lost in the rounding of the value.
        if candidate.value <= point.value + 1e-4 * step * slope + 1e-14 * abs(point.value):
            return candidate
        step *= 0.5
    return None


def _polar_step(energy: Term, right: Array, point: _Point, bound: float) -> tuple[_Point | None, float]:
    """Return ``polar(C − ∇E / L)`` and the ``L`` that lowered the energy; ``None`` where rounding lets none do so."""
    for _ in range(_MAX_HALVINGS):
        candidate = _Point(energy, right, nearest_orthogonal(point.C - point.gradient / bound))
        if candidate.value < point.value:
            return candidate, bound
        bound *= 2.0
    return None, bound


def _largest_curvature(energy: Term, C: Array) -> float:
    """Return a lower bound of the largest eigenvalue of the energy's operator, by the power method from ``C``."""
    x = C + 0.01 * namespace(C).ones_like(C)
    value = 0.0
    for _ in range(20):
        x = x / inner(x, x) ** 0.5
        applied = energy.apply(x)
        value, x = inner(x, applied), applied
        if not value > 0:
            return 1.0
    return value
