"""Minimisation of a quadratic energy with penalties that are not quadratic and, optionally, a constraint on C.

Without penalties and constraint it is one linear solve. A penalty (:mod:`kfmaps.fmap.losses`) is replaced by its
quadratic majorizer at the current map in every step. A constraint (:mod:`kfmaps.fmap.constraints`) replaces the linear
solve by a descent along a manifold. The two maps of a pair are minimised in turn (:func:`fit_bidirectional`). Every
step starts from the last map and lowers the same objective, so that it never rises.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from kfmaps._arrays import Array
from kfmaps.fmap.constraints import minimize_orthogonal
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.losses import Penalty
from kfmaps.fmap.preconditioners import jacobi, sylvester
from kfmaps.fmap.solvers import Solution, Solver, solve
from kfmaps.fmap.terms import Term, adjoint_term, inverse_term, value

Constraint = Literal["none", "orthogonal"]
Preconditioner = Literal["none", "jacobi", "sylvester"]

ProgressCallback = Callable[[int, float], None]


@dataclass(frozen=True, eq=False)
class Objective:
    """``energy(C) + Σ weight · penalty(C)`` over all maps, or over orthonormal ones."""

    energy: Energy
    penalties: Mapping[str, tuple[float, Penalty]] = field(default_factory=dict)  # weights and penalties by name
    constraint: Constraint = "none"

    def value(self, C: Array) -> float:
        """Return the objective at ``C``, whether or not that meets the constraint."""
        return value(self.energy, C) + sum(weight * p.value(C) for weight, p in self.penalties.values())

    def breakdown(self, C: Array) -> dict[str, float]:
        """Return the weighted value of each term and penalty at ``C``; they add up to :meth:`value`."""
        parts = {name: weight * p.value(C) for name, (weight, p) in self.penalties.items()}
        return {**self.energy.breakdown(C), **parts}

    def majorizer(self, C: Array) -> Energy:
        """Return the energy with each penalty's majorizer at ``C``; the energy itself without any."""
        if not self.penalties:
            return self.energy
        return self.energy.joined({name: (weight, p.majorizer(C)) for name, (weight, p) in self.penalties.items()})


@dataclass(frozen=True)
class MinimizeOptions:
    """How an objective is minimised."""

    solver: Solver  # of each quadratic step
    preconditioner: Preconditioner = "sylvester"
    max_outer_iter: int = 20  # most quadratic steps
    rtol: float = 1e-4  # relative decrease of the objective below which no step follows


def minimize(
    objective: Objective, options: MinimizeOptions, start: Array | None = None, progress: ProgressCallback | None = None
) -> Solution:
    """Minimise an objective from a start.

    Parameters
    ----------
    objective : Objective
    options : MinimizeOptions
    start : (k_t, k_s), optional
        By default the minimiser of the energy with the penalties' majorizers at zero; with the constraint, the
        orthonormal map nearest to it.
    progress : callable, optional
        Called after each step of the solver with its number and the relative residual.

    Returns
    -------
    Solution
        ``residuals`` are of the last quadratic step.
    """
    if start is None and (objective.penalties or objective.constraint != "none"):
        start = _solve_quadratic(
            objective.majorizer(0.0 * objective.energy.rhs()), "none", options, None, progress
        ).value
    solution, steps, last = None, 0, np.inf
    for step in range(options.max_outer_iter if objective.penalties else 1):
        solution = _solve_quadratic(objective.majorizer(start), objective.constraint, options, start, progress)
        start, steps = solution.value, steps + solution.steps
        now = objective.value(start) if objective.penalties else 0.0
        if step and last - now <= options.rtol * abs(last):
            break
        last = now
    assert solution is not None
    return replace(solution, steps=steps)


def _solve_quadratic(
    energy: Energy,
    constraint: Constraint,
    options: MinimizeOptions,
    start: Array | None,
    progress: ProgressCallback | None,
) -> Solution:
    """Return the minimiser of an energy, by one linear solve or one descent along the manifold."""
    inverse = None
    if options.preconditioner == "jacobi":
        inverse = jacobi(energy.diagonal())
    elif options.preconditioner == "sylvester":
        inverse = sylvester(energy)
    if constraint == "orthogonal":
        assert start is not None
        return minimize_orthogonal(energy, options.solver, start, inverse, progress)
    return solve(energy.apply, energy.rhs(), options.solver, start, inverse, progress)


@dataclass(frozen=True, eq=False)
class BidirectionalSolution:
    """The maps of both directions; made by :func:`fit_bidirectional`."""

    forth: Solution  # (k_t, k_s)
    back: Solution  # (k_s, k_t)
    history: np.ndarray  # the joint objective before the first round and after each


def fit_bidirectional(
    forth: Objective,
    back: Objective,
    inverse: float,
    adjoint: float,
    options: MinimizeOptions,
    start: Array | None = None,
    progress: ProgressCallback | None = None,
) -> BidirectionalSolution:
    """Minimise both directions together, ``C`` forth and ``D`` back.

    The objective is the sum of both and ``½ inverse (‖C D − I‖² + ‖D C − I‖²) + ½ adjoint ‖D − Cᵀ‖²`` (Eynard et al.,
    Coupled functional maps, 2016; Huang and Ovsjanikov, Adjoint map representation, 2017). It is quadratic in each map;
    they are minimised in turn, from the uncoupled ones, until the sum hardly falls. ``start`` is a map forth;
    ``options`` and ``progress`` are those of :func:`minimize`.
    """
    C, D = minimize(forth, options, start, progress), minimize(back, options, None, progress)
    couplings: list[tuple[str, float, Callable[[Array], Term]]] = [
        ("inverse", inverse, inverse_term),
        ("adjoint", adjoint, adjoint_term),
    ]
    couplings = [coupling for coupling in couplings if coupling[1] > 0]

    def coupled(objective: Objective, other: Array) -> Objective:
        """Return the objective of one map with the coupling to the ``other``."""
        terms = {name: (weight, make_term(other)) for name, weight, make_term in couplings}
        return replace(objective, energy=objective.energy.joined(terms))

    def total() -> float:
        # The coupling has the same value for both maps and is counted once.
        return coupled(forth, D.value).value(C.value) + back.value(D.value)

    history = [total()]
    one_step = replace(options, max_outer_iter=1)
    for _ in range(options.max_outer_iter if couplings else 0):
        solution = minimize(coupled(forth, D.value), one_step, C.value, progress)
        C = replace(solution, steps=C.steps + solution.steps)
        solution = minimize(coupled(back, C.value), one_step, D.value, progress)
        D = replace(solution, steps=D.steps + solution.steps)
        history.append(total())
        if history[-2] - history[-1] <= options.rtol * abs(history[-2]):
            break
    return BidirectionalSolution(C, D, np.asarray(history))
