"""The minimiser of an energy as a function that PyTorch can differentiate.

The map ``C`` that minimises ``½⟨C, A(C)⟩ − ⟨B, C⟩`` solves ``A(C) = B``. Where ``A`` and ``B`` depend on parameters θ,
``dC = A⁻¹ (dB − dA(C))``; so for a loss with the gradient ``G`` in ``C``, the gradient in θ is that of
``⟨Λ, B − A(C)⟩`` with ``C`` and ``Λ = A⁻¹(G)`` held fixed. ``A`` is self-adjoint: one more solve with the same operator
gives ``Λ``, and one application of the operator carries it to θ. The iterations are not recorded, so memory does not
grow with their number, and the gradient is that of the minimiser rather than of how far a solver came.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import torch

from kfmaps._arrays import NotConverged
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.preconditioners import sylvester
from kfmaps.fmap.solvers import CG, Operator, Solution, solve

TIGHT = CG(rtol=1e-10, max_steps=2000)


@dataclass(frozen=True, eq=False)
class Minimum:
    """What :func:`minimize_problem` returns: the map ``C (k_t, k_s)``, a part of PyTorch's graph, and how it was
    found."""

    C: torch.Tensor
    solution: Solution


class _Implicit(torch.autograd.Function):
    """``residual ↦ C``, for ``residual = B − A(C)`` of value zero, whose derivative is ``A⁻¹``."""

    @staticmethod
    def forward(ctx: Any, residual: torch.Tensor, C: torch.Tensor, inverse: Operator) -> torch.Tensor:
        del residual  # zero; it is here for its derivative
        ctx.inverse = inverse
        return C.clone()

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(  # pyright: ignore[reportIncompatibleMethodOverride]
        ctx: Any, *gradients: torch.Tensor
    ) -> tuple[torch.Tensor | None, ...]:
        return ctx.inverse(gradients[0]), None, None


def minimiser(energy: Energy, solver: CG = TIGHT, start: torch.Tensor | None = None) -> Minimum:
    """The map that minimises ``energy``, with derivatives in whatever tensors its terms and weights were made from.

    Parameters
    ----------
    energy : Energy
        Positive definite, of terms made from PyTorch tensors; weights may be tensors too.
    solver : CG
        For the map and for its derivative. The gradient's relative error is of the order of ``rtol``.
    start : (k_t, k_s) tensor, optional
        Where the iteration starts, such as the map of parameters nearby; it does not change the minimiser.

    Raises
    ------
    NotConverged
        When the solver breaks down, there or in the backward pass. Running out of steps is told by ``solution.status``.
    """
    with torch.no_grad():
        precondition = sylvester(energy)
        found = _checked(solve(energy.apply, energy.rhs(), solver, start, precondition), "map")

    def inverse(gradient: torch.Tensor) -> torch.Tensor:
        with torch.no_grad():
            return _checked(solve(energy.apply, gradient, solver, None, precondition), "derivative").value

    C = found.value.detach()
    if not torch.is_grad_enabled():
        return Minimum(C, found)
    residual = energy.rhs() - energy.apply(C)
    applied: Any = _Implicit.apply(residual, C, inverse)
    return Minimum(applied, found)


def _checked(solution: Solution, what: str) -> Solution:
    if solution.status == "breakdown" and not np.isclose(solution.residuals[-1], 0.0):
        raise NotConverged(
            f"{what}: wanted a positive definite energy of finite numbers, got a breakdown of conjugate gradients "
            f"after {solution.steps} steps (residual {solution.residuals[-1]:.3g}); lower the learning rate, or "
            "keep the weight of the Laplacian term above zero"
        )
    return solution
