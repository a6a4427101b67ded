"""What a map is judged by while learning: against the truth, or against what every good map obeys.

All are means of squares or of distances, without a unit, about 1 for a map that knows nothing.
"""

from __future__ import annotations

import torch

from kfmaps.geometry.basis import Basis


def supervised(C: torch.Tensor, wanted: torch.Tensor) -> torch.Tensor:
    """``‖C − C*‖² / ‖C*‖²`` for the true map ``C*`` (as FMNet's aim, Litany et al. 2017; Donati et al. 2020)."""
    return ((C - wanted) ** 2).sum() / (wanted**2).sum()


def orthogonality(C: torch.Tensor) -> torch.Tensor:
    """``‖CᵀC − I‖² / k``: zero for maps that keep areas (Roufosse et al. 2019)."""
    k = C.shape[1]
    return ((C.T @ C - torch.eye(k, dtype=C.dtype)) ** 2).sum() / k


def cycle(C: torch.Tensor, back: torch.Tensor) -> torch.Tensor:
    """``‖C' C − I‖² / k`` for the map ``back`` C' from target to source (Roufosse et al. 2019)."""
    k = C.shape[1]
    return ((back @ C - torch.eye(k, dtype=C.dtype)) ** 2).sum() / k


def commutativity(C: torch.Tensor, source: Basis, target: Basis) -> torch.Tensor:
    """``‖C Λ_s − Λ_t C‖² / ‖Λ‖²``: zero for isometries (Roufosse et al. 2019)."""
    moved = C * source.eigenvalues[None, :] - target.eigenvalues[:, None] * C
    return (moved**2).sum() / (source.eigenvalues**2).sum()


def soft_points(places: torch.Tensor, images: torch.Tensor, temperature: float) -> torch.Tensor:
    """Soft point map ``(m, n)``, rows summing to 1: each of ``places (m, k)`` among the ``images (n, k)``.

    ``softmax(−‖x − y‖² / (temperature · s))`` with ``s`` the mean squared distance to the nearest image, so that
    ``temperature`` has no unit; towards 0 it is the map to the nearest.
    """
    squares = (places**2).sum(dim=1)[:, None] + (images**2).sum(dim=1)[None, :] - 2 * places @ images.T
    nearest = squares.detach().min(dim=1, keepdim=True).values
    scale = temperature * nearest.clamp(min=0.0).mean() + 1e-12 * squares.detach().abs().mean() + 1e-300
    return torch.softmax((nearest - squares) / scale, dim=1)


def geodesic(
    C: torch.Tensor,
    functions_s: torch.Tensor,
    functions_t: torch.Tensor,
    distances: torch.Tensor,
    temperature: float = 0.03,
) -> torch.Tensor:
    """Mean expected geodesic error of the soft point map of ``C``, in units of √area.

    Parameters
    ----------
    C : (k_t, k_s)
    functions_s : (n, k_s)
        At the source points that may be chosen.
    functions_t : (m, k_t)
        At the target points that are judged.
    distances : (m, n)
        From the true partner of each of these, on the source, to each point that may be chosen.
    """
    soft = soft_points(functions_t, functions_s @ C.T, temperature)
    return (soft * distances).sum(dim=1).mean()


def coupling(
    C: torch.Tensor,
    soft: torch.Tensor,
    functions_s: torch.Tensor,
    functions_t: torch.Tensor,
    ridge: float = 1e-3,
) -> torch.Tensor:
    """``‖C − Φ_t⁺ Π Φ_s‖² / k`` for a soft point map ``Π (m, n)`` of the features themselves (Cao et al. 2023).

    Parameters
    ----------
    functions_s, functions_t : (n, k_s), (m, k_t)
        At the points of ``Π``; ``Φ_t⁺`` is the least-squares inverse there, damped by ``ridge`` of the mean diagonal.
    """
    gram = functions_t.T @ functions_t
    gram = gram + ridge * torch.diagonal(gram).mean() * torch.eye(len(gram), dtype=gram.dtype)
    wanted = torch.linalg.solve(gram, functions_t.T @ (soft @ functions_s))
    return ((C - wanted) ** 2).sum() / C.shape[1]
