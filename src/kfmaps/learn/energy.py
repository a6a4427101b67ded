"""The energy of a pair as a function of its features in PyTorch, and its differentiable minimiser.

The map ``C`` that minimises ``½⟨C, A(C)⟩ − ⟨B, C⟩`` solves ``A(C) = B``. Where ``A`` and ``B`` depend on parameters θ,
``dC = A⁻¹ (dB − dA(C))``. So for a loss with the gradient ``G`` in ``C``, the gradient in θ is that of
``⟨Λ, B − A(C)⟩`` with ``C`` and ``Λ = A⁻¹(G)`` held fixed. ``A`` is self-adjoint: one more solve with the same operator
gives ``Λ``. The iterations are not recorded, so memory does not grow with their number.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import torch

from kfmaps._arrays import NotConverged
from kfmaps.config import Formulation
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.multiplication_operators import unpack_operators
from kfmaps.fmap.preconditioners import sylvester
from kfmaps.fmap.solvers import CG, Operator, solve
from kfmaps.fmap.terms import Term, descriptor_term, laplacian_term, operator_term
from kfmaps.geometry.basis import Basis
from kfmaps.matching.assemble import compressed_operators

_KernelMatrix = Callable[[torch.Tensor, torch.Tensor], torch.Tensor]  # ``(n, d), (m, d) ↦ (n, m)``

_JITTER = 1e-8
"""Added to the diagonal of the samples' kernel matrix, in units of its mean, so that its Cholesky factor exists."""


def nystrom_features(
    kernel: _KernelMatrix, D_s: torch.Tensor, D_t: torch.Tensor, samples: torch.Tensor
) -> tuple[torch.Tensor, torch.Tensor]:
    """Return Nyström features of descriptors, differentiable in the kernel's parameters.

    ``W = k(D, S) L⁻ᵀ`` with the Cholesky factor of ``k(S, S) = L Lᵀ``: the same ``W Wᵀ`` as from eigenvectors, which
    is all that the energy depends on, but with a derivative where eigenvalues coincide. ``kernel`` maps (n, d), (m, d)
    to (n, m); descriptors ``D_s (n_s, d)`` and ``D_t (n_t, d)`` with ``samples (q, d)`` give (n_s, q) and (n_t, q).
    """
    R = kernel(samples, samples)
    size = torch.diagonal(R).mean().detach()
    L = torch.linalg.cholesky((R + R.T) / 2 + _JITTER * size * torch.eye(len(R), dtype=R.dtype))
    W_s, W_t = (torch.linalg.solve_triangular(L, kernel(samples, D), upper=False).T for D in (D_s, D_t))
    return W_s, W_t


def pair_energy(
    source: Basis,
    target: Basis,
    W_s: torch.Tensor,
    W_t: torch.Tensor,
    weights: Mapping[str, torch.Tensor | float],
    operator_rtol: float = 0.0,
    formulation: Formulation = Formulation(),  # noqa: B008
) -> Energy:
    """Return the energy of a pair as a function of its features and weights.

    Parameters
    ----------
    source, target : Basis
        Of the map's size, as tensors.
    W_s, W_t : (n_s, r), (n_t, r) tensors
        Features of source and target.
    weights : mapping of str to number or tensor
        Of "descriptors", "commutativity" and "laplacian"; a term without weight is left out.
    operator_rtol : float
        Part of the features' weight that commutativity may leave out; 0 keeps the gradient exact.
    formulation : Formulation
        Only the mask of its Laplacian term is used.
    """
    weights = {name: weight for name, weight in weights.items() if bool(weight > 0)}
    terms: dict[str, Term] = {}
    if "laplacian" in weights:
        terms["laplacian"] = laplacian_term(source, target, mask=formulation.mask, power=formulation.mask_power)
    if "descriptors" in weights:
        terms["descriptors"] = descriptor_term(source, W_s, target, W_t)
    if "commutativity" in weights:
        # The rotations of truncated features have no derivative. The energy is the same in every rotation of all
        # features, so only the operators that are dropped make the gradient inexact.
        packed = compressed_operators((source, target), (W_s, W_t), operator_rtol)
        terms["commutativity"] = operator_term(unpack_operators(packed[0]), unpack_operators(packed[1]))
    return Energy(terms, {name: weights[name] for name in terms})  # pyright: ignore[reportArgumentType]


class _Implicit(torch.autograd.Function):
    """``residual ↦ C``, for ``residual = B − A(C)`` of value zero, whose derivative is ``A⁻¹``."""

    @staticmethod
    def forward(ctx: Any, residual: torch.Tensor, C: torch.Tensor, inverse: Operator) -> torch.Tensor:
        del residual  # its value is zero; only its derivative counts
        ctx.inverse = inverse
        return C.clone()

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(  # pyright: ignore[reportIncompatibleMethodOverride]
        ctx: Any, *gradients: torch.Tensor
    ) -> tuple[torch.Tensor | None, ...]:
        return ctx.inverse(gradients[0]), None, None


def differentiable_minimum(energy: Energy, solver: CG) -> torch.Tensor:
    """Return the map ``C (k_t, k_s)`` of least energy, with derivatives in the tensors of its terms and weights.

    Parameters
    ----------
    energy : Energy
        Positive definite, of terms made from PyTorch tensors; weights may be tensors too.
    solver : CG
        For the map and for its derivative. The gradient's relative error is of the order of ``rtol``.

    Raises
    ------
    NotConverged
        When the solver breaks down, here or in the backward pass.
    """
    with torch.no_grad():
        precondition = sylvester(energy)
        C = _solve(energy, energy.rhs(), solver, precondition, "map")

    def inverse(gradient: torch.Tensor) -> torch.Tensor:
        with torch.no_grad():
            return _solve(energy, gradient, solver, precondition, "derivative")

    if not torch.is_grad_enabled():
        return C
    implicit: Any = _Implicit.apply
    return implicit(energy.rhs() - energy.apply(C), C, inverse)


def _solve(energy: Energy, right: torch.Tensor, solver: CG, precondition: Operator, name: str) -> torch.Tensor:
    """Return the solution of ``A(C) = right``."""
    solution = solve(energy.apply, right, solver, None, precondition)
    if solution.status == "breakdown" and not np.isclose(solution.residuals[-1], 0.0):
        raise NotConverged(
            f"{name}: expected a positive definite energy of finite numbers, got a breakdown of conjugate gradients "
            f"after {solution.steps} steps (residual {solution.residuals[-1]:.3g}). Lower the learning rate, or "
            "keep the weight of the Laplacian term above zero."
        )
    return solution.value
