"""What a fit minimises: a quadratic energy, penalties that are not quadratic, and maybe a constraint on C.

Without penalties and constraint it is one linear system, solved once. A penalty
(:mod:`kfmaps.fmap.losses`) is replaced by its quadratic majorizer, again and again; a constraint
(:mod:`kfmaps.fmap.constraints`) takes the place of the linear solve. Both maps of a pair at once are minimised in turn
(:func:`fit_bidirectional`). Every step starts where the last one ended and lowers the same objective, so it never
rises, whatever is combined.
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
    objective: Objective, how: MinimizeOptions, start: Array | None = None, progress: ProgressCallback | None = None
) -> Solution:
    """Minimise an objective from a start.

    Parameters
    ----------
    objective : Objective
    how : MinimizeOptions
    start : (k_t, k_s), optional
        By default the minimiser of the energy with the penalties' majorizers at zero, that is, about where the energy
        alone is least; constrained, its nearest orthonormal map.
    progress : callable, optional
        Called after each step of the solver with its number and the relative residual.

    Returns
    -------
    Solution
        ``residuals`` are of the last quadratic step.
    """
    if start is None and (objective.penalties or objective.constraint != "none"):
        start = _solve_quadratic(objective.majorizer(0.0 * objective.energy.rhs()), "none", how, None, progress).value
    solution, steps, last = None, 0, np.inf
    for step in range(how.max_outer_iter if objective.penalties else 1):
        solution = _solve_quadratic(objective.majorizer(start), objective.constraint, how, start, progress)
        start, steps = solution.value, steps + solution.steps
        now = objective.value(start) if objective.penalties else 0.0
        if step and last - now <= how.rtol * abs(last):
            break
        last = now
    assert solution is not None
    return replace(solution, steps=steps)


def _solve_quadratic(
    energy: Energy, constraint: Constraint, how: MinimizeOptions, start: Array | None, progress: ProgressCallback | None
) -> Solution:
    """The minimiser of an energy: one linear solve, or one descent along the manifold."""
    inverse = None
    if how.preconditioner == "jacobi":
        inverse = jacobi(energy.diagonal())
    elif how.preconditioner == "sylvester":
        inverse = sylvester(energy)
    if constraint == "orthogonal":
        assert start is not None
        return minimize_orthogonal(energy, how.solver, start, inverse, progress)
    return solve(energy.apply, energy.rhs(), how.solver, start, inverse, progress)


@dataclass(frozen=True, eq=False)
class BidirectionalSolution:
    """``forth`` (k_t, k_s), ``back`` (k_s, k_t) and the objective of both together before the first round and after
    each."""

    forth: Solution
    back: Solution
    history: np.ndarray


def fit_bidirectional(
    forth: Objective,
    back: Objective,
    inverse: float,
    adjoint: float,
    how: MinimizeOptions,
    start: Array | None = None,
    progress: ProgressCallback | None = None,
) -> BidirectionalSolution:
    """Minimise both directions at once, ``C`` forth and ``D`` back.

    The objective is the sum of both and ``½ inverse (‖C D − I‖² + ‖D C − I‖²) + ½ adjoint ‖D − Cᵀ‖²`` (Eynard et al.,
    Coupled functional maps, 2016; Huang and Ovsjanikov, Adjoint map representation, 2017). It is quadratic in each map;
    they are minimised in turn, from the uncoupled ones, until the sum hardly falls. ``start`` is a map forth; ``how``
    and ``progress`` are those of :func:`minimize`.
    """
    one = minimize(forth, how, start, progress)
    other = minimize(back, how, None, progress)
    tied = {name: w for name, w in (("inverse", inverse), ("adjoint", adjoint)) if w > 0}

    def with_other(objective: Objective, there: Array) -> Objective:
        make: dict[str, Callable[[Array], Term]] = {"inverse": inverse_term, "adjoint": adjoint_term}
        terms = {name: (weight, make[name](there)) for name, weight in tied.items()}
        return replace(objective, energy=objective.energy.joined(terms))

    def total() -> float:
        # The coupling is the same seen from either side, so it is counted with the map forth.
        return with_other(forth, other.value).value(one.value) + back.value(other.value)

    history = [total()]
    single = replace(how, max_outer_iter=1)
    for _ in range(how.max_outer_iter if tied else 0):
        found = minimize(with_other(forth, other.value), single, one.value, progress)
        one = replace(found, steps=one.steps + found.steps)
        found = minimize(with_other(back, one.value), single, other.value, progress)
        other = replace(found, steps=other.steps + found.steps)
        history.append(total())
        if history[-2] - history[-1] <= how.rtol * abs(history[-2]):
            break
    return BidirectionalSolution(one, other, np.asarray(history))
