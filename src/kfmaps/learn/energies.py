"""The energy of a pair as a function of its features, in PyTorch, with the package's own terms."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import torch

from kfmaps.config import Formulation
from kfmaps.fmap.energy import Energy, Term, descriptor_term, laplacian_term, operator_term
from kfmaps.geometry.basis import Basis

KernelMatrix = Callable[[torch.Tensor, torch.Tensor], torch.Tensor]
"""``(n, d), (m, d) ↦ (n, m)``."""

JITTER = 1e-8
"""Added to the diagonal of the samples' kernel matrix, in units of its mean, so that its Cholesky factor exists."""


def features(
    kernel: KernelMatrix, D_s: torch.Tensor, D_t: torch.Tensor, samples: torch.Tensor
) -> tuple[torch.Tensor, torch.Tensor]:
    """Nyström features ``(n_s, q)``, ``(n_t, q)`` from the ``samples (q, d)``.

    ``W = k(D, S) L⁻ᵀ`` with the Cholesky factor of ``k(S, S) = L Lᵀ``: the same ``W Wᵀ`` as from eigenvectors, which
    is all that the energy sees, but with a derivative where eigenvalues coincide.
    """
    R = kernel(samples, samples)
    size = torch.diagonal(R).mean().detach()
    L = torch.linalg.cholesky((R + R.T) / 2 + JITTER * size * torch.eye(len(R), dtype=R.dtype))
    W_s, W_t = (torch.linalg.solve_triangular(L, kernel(samples, D), upper=False).T for D in (D_s, D_t))
    return W_s, W_t


def condensation(bases: tuple[Basis, Basis], W: tuple[torch.Tensor, torch.Tensor], rtol: float) -> torch.Tensor:
    """A rotation ``(q, r)`` onto the features that matter for commutativity, without a derivative.

    As :func:`kfmaps.fmap.multiplication_operators.truncate_features`. The energy is the same in every rotation of all
    features, so only
    the few that are dropped make the gradient inexact.
    """
    with torch.no_grad():
        gram = torch.zeros(W[0].shape[1], W[0].shape[1], dtype=W[0].dtype)
        for basis, F in zip(bases, W, strict=True):
            scaled = torch.sqrt(basis.mass * (basis.functions**2).sum(dim=1))[:, None] * F
            gram = gram + scaled.T @ scaled
        return _strongest(gram, rtol)


def _strongest(gram: torch.Tensor, rtol: float) -> torch.Tensor:
    """Eigenvectors of ``gram`` but for the weakest, which hold ``rtol`` of its trace together."""
    values, vectors = torch.linalg.eigh(gram)
    lost = torch.cumsum(values.clamp(min=0.0), dim=0)
    return vectors[:, lost > rtol * lost[-1]]


def operators(basis: Basis, W: torch.Tensor) -> torch.Tensor:
    """The operators ``Φᵀ A diag(wᵢ) Φ``, ``(r, k, k)``, of features ``W (n, r)``."""
    phi, weighted = basis.functions, basis.mass[:, None] * W
    return torch.stack([phi.T @ (weighted[:, i : i + 1] * phi) for i in range(W.shape[1])])


def pair_energy(
    source: Basis,
    target: Basis,
    W_s: torch.Tensor,
    W_t: torch.Tensor,
    weights: Mapping[str, torch.Tensor | float],
    compression: float = 0.0,
    asked: Formulation = Formulation(),  # noqa: B008
) -> Energy:
    """The energy of features ``(n_s, r)``, ``(n_t, r)``, of terms whose weights may be tensors.

    Parameters
    ----------
    weights : mapping
        Of ``descriptors``, ``commutativity`` and ``laplacian``; a term that is not named, or of weight 0, is left out.
    compression : float
        Part of the features' weight that may be left out of commutativity; 0 keeps the gradient exact.
    asked : Formulation
        Of which the mask of the Laplacian term counts.
    """
    given = {name: weight for name, weight in weights.items() if bool(weight > 0)}
    terms: dict[str, Term] = {}
    if "laplacian" in given:
        terms["laplacian"] = laplacian_term(source, target, mask=asked.mask, power=asked.mask_power)
    if "descriptors" in given:
        terms["descriptors"] = descriptor_term(source, W_s, target, W_t)
    if "commutativity" in given:
        if compression:
            rotation = condensation((source, target), (W_s, W_t), compression / 2)
            W_s, W_t = W_s @ rotation, W_t @ rotation
        slices = [operators(source, W_s), operators(target, W_t)]
        if compression:
            with torch.no_grad():
                flat = [X.reshape(len(X), -1) for X in slices]
                rotation = _strongest(flat[0] @ flat[0].T + flat[1] @ flat[1].T, compression)
            slices = [torch.tensordot(rotation.T, X, dims=1) for X in slices]
        terms["commutativity"] = operator_term(slices[0], slices[1])
    return Energy(terms, {name: given[name] for name in terms})  # pyright: ignore[reportArgumentType]
