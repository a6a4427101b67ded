"""Minimize the energy of a fit, as the formulation says."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field

import numpy as np

from kfmaps._arrays import Array, KfmapsWarning, check, like, to_numpy
from kfmaps._progress import Progress
from kfmaps.config import Config
from kfmaps.fmap.coupled import CoupledBases, RotatedPenalty, RotatedTerm, couple_bases
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.losses import Loss, Penalty, RobustData, sparse_penalty
from kfmaps.fmap.minimize import (
    MinimizeOptions,
    Objective,
    ProgressCallback,
    fit_bidirectional,
    minimize,
)
from kfmaps.fmap.optimal_transport import transport_penalty
from kfmaps.fmap.solvers import CG, Solution
from kfmaps.fmap.terms import laplacian_term
from kfmaps.kernels.kernels import describe_kernel
from kfmaps.matching.assemble import FitProblem


@dataclass(frozen=True, eq=False)
class Fit:
    """A functional map and how it was fitted; returned by :func:`kfmaps.matching.fit.fit`.

    Attributes
    ----------
    functional_map : (k, k) float64
        The minimiser; carries coefficients of functions from source to target.
    solution : Solution
        Status, steps and residuals of the solver.
    energies : dict of str to float
        Weighted value of each term at the minimiser.
    rank : int
        Features of the kernel that were kept.
    n_operators : int
        Multiplication operators left after compression.
    kernel : str
        With every γ a number.
    config : Config
        Of this fit; a search makes fits of other sizes than that of the match.
    seconds : dict of str to float
        Per stage.
    back : (k, k) float64 or None
        The map from target to source, where both directions were fitted.
    weights : (g,) float64 or None
        Weight of each landmark or descriptor, 0 to 1, under a robust loss of them.
    """

    functional_map: np.ndarray
    solution: Solution
    energies: dict[str, float]
    rank: int
    n_operators: int
    kernel: str
    config: Config
    seconds: dict[str, float] = field(default_factory=dict)
    back: np.ndarray | None = None
    weights: np.ndarray | None = None


def solve_problem(task: FitProblem, report: Progress, start: Array | None = None) -> Fit:
    """Return :func:`minimize_problem` from a checked ``start``, and report its progress as the stage "solve"."""
    if start is not None:
        right = task.energy.rhs()
        start = np.asarray(to_numpy(start) if hasattr(start, "shape") else start, dtype=np.float64)
        check(start, "start", shape=tuple(right.shape), remedy="give a functional map of the size of the basis")
        start = like(start, right)
    solver = task.config.solver

    def callback(step: int, relative: float) -> None:
        if isinstance(solver, CG) and solver.max_iter:
            # By the criterion that is nearer to being met.
            by_size = np.log(max(relative, 1e-300)) / np.log(max(solver.rtol, 1e-16))
            report("solve", float(np.clip(max(step / solver.max_iter, by_size), 0.0, 1.0)))

    result = minimize_problem(task, start, callback)
    if result.solution.status == "breakdown" and task.config.formulation.constraint == "none":
        text = (
            f"the solver broke down after {result.solution.steps} steps: the energy is not positive definite or a "
            "number is not finite, and the map is not its minimiser. Raise weights.laplacian, or look at kernel and "
            "descriptors"
        )
        warnings.warn(text, KfmapsWarning, stacklevel=3)
    return result


def minimize_problem(task: FitProblem, start: Array | None = None, callback: ProgressCallback | None = None) -> Fit:
    """Return the map that minimizes the energy of ``task`` as its formulation says, iterated from ``start``."""
    config, formulation = task.config, task.config.formulation
    options = MinimizeOptions(config.solver, config.preconditioner, formulation.max_outer_iter)
    if formulation.weighs_features or formulation.coupled_bases or formulation.transport_weight:
        start = minimize(Objective(task.energy), options, start, callback).value
    rotation = None
    if formulation.coupled_bases and start is not None:  # coupled by the least-squares map
        values_s, values_t = (basis.eigenvalues for basis in task.bases)
        rotation = couple_bases(values_s, values_t, start, formulation.coupling_weight)
    forth = objective(task, start, rotation)
    back = None
    if formulation.bidirectional:
        swapped = None if rotation is None else CoupledBases(rotation.U_t, rotation.U_s, rotation.history)
        reverse = objective(task, None if start is None else start.T, swapped, reverse=True)
        unit = mean_diagonal(task.energy)
        weights = formulation.inverse_weight * unit, formulation.adjoint_weight * unit
        pair = fit_bidirectional(forth, reverse, *weights, options, start, callback)
        solution, back = pair.forth, to_numpy(pair.back.value)
    else:
        solution = minimize(forth, options, start, callback)
    return Fit(
        functional_map=to_numpy(solution.value),
        solution=solution,
        energies=forth.breakdown(solution.value),
        rank=task.rank,
        n_operators=task.n_operators,
        kernel=describe_kernel(task.kernel),
        config=config,
        back=back,
    )


def objective(
    task: FitProblem, least_squares: Array | None, rotation: CoupledBases | None, reverse: bool = False
) -> Objective:
    """Return the objective of one direction, from the ``least_squares`` map where the formulation needs it."""
    config, formulation = task.config, task.config.formulation
    energy = task.reverse if reverse else task.energy
    bases = task.bases[::-1] if reverse else task.bases
    penalties: dict[str, tuple[float, Penalty]] = {}
    if formulation.weighs_features:
        assert task.features is not None
        assert least_squares is not None
        F = (task.features.source, task.features.target)
        P = [basis.project(f) for basis, f in zip(bases, F[::-1] if reverse else F, strict=True)]
        # Features of a kernel differ in size by orders of magnitude: the loss is of their relative residuals.
        sizes = to_numpy(P[0] * P[0]).sum(axis=0) + to_numpy(P[1] * P[1]).sum(axis=0)
        data = RobustData(P[0], P[1], np.arange(len(sizes)), Loss(formulation.loss), sizes=np.maximum(sizes, 1e-300))
        data = data.scaled(least_squares, formulation.loss_scale)
        energy = energy.without("descriptors")
        penalties["descriptors"] = (config.weights.descriptors, data)
    if formulation.sparsity:
        penalties["sparsity"] = (formulation.sparsity * mean_diagonal(energy), sparse_penalty(energy.rhs()))
    if formulation.transport_weight:
        assert least_squares is not None
        penalty = transport_penalty(least_squares, bases[0], bases[1], formulation.transport_blur)
        penalties["spatial"] = (formulation.transport_weight * mean_diagonal(energy), penalty)
    if rotation is not None:
        U = (rotation.U_t, rotation.U_s)
        term = laplacian_term(*rotation.to_rotated(*bases), mask=formulation.mask, power=formulation.mask_power)
        energy = Energy({**energy.terms, "laplacian": RotatedTerm(term, *U)}, energy.weights)
        if "sparsity" in penalties:
            weight, penalty = penalties["sparsity"]
            penalties["sparsity"] = (weight, RotatedPenalty(penalty, *U))
    return Objective(energy, penalties, formulation.constraint)


def mean_diagonal(energy: Energy) -> float:
    """Return the mean diagonal of the energy's operator, the unit of the weights of further terms."""
    return float(np.mean(to_numpy(energy.diagonal())))
