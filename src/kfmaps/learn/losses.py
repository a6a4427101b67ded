"""Losses of a functional map while learning: against the truth, or against laws that every good map obeys.

All are means of squares or of distances, without a unit, about 1 for a map that says nothing about the pair.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import torch

from kfmaps._arrays import check_positive, refuse
from kfmaps._records import setting, settings_of, settings_record
from kfmaps.fmap.nearest import nearest
from kfmaps.fmap.solvers import CG
from kfmaps.geometry.basis import Basis
from kfmaps.learn.energy import differentiable_minimum, nystrom_features, pair_energy
from kfmaps.learn.model import Model
from kfmaps.learn.pairs import TrainingPair

LOSSES = {
    "geodesic": "expected geodesic error of the soft point map",
    "supervised": "distance from the functional map of the truth",
    "orthogonality": "how far the map is from preserving areas",
    "cycle": "how far there and back is from the identity",
    "commutativity": "how far the map is from an isometry's",
    "coupling": "how far the map is from the soft point map of the descriptors",
}
"""Names and meanings of the losses; the first two need the truth."""

_MAX_COUPLED = (400, 1000)  # largest number of target and source points of the coupling loss


@settings_record
class TrainingOptions:
    """How to learn. Most parameters are logarithms, so that a rate of 0.1 changes a weight by about a tenth a step."""

    losses: Mapping[str, float] = setting(lambda: {"geodesic": 1.0}, "weights of :data:`kfmaps.learn.LOSSES`")
    epochs: int = setting(5, "largest number of passes through all pairs", low=1)
    batch: int = setting(2, "number of pairs whose gradients are averaged for one step", low=1)
    rate: float = setting(0.1, "Adam's, which falls to zero over the epochs as half a cosine", above=0)
    patience: int = setting(3, "epochs without a better mean over held-out pairs, after which learning stops", low=1)
    temperature: float = setting(0.03, "of soft point maps, see :func:`soft_point_map`", above=0)
    seconds: float = setting(math.inf, "no further epoch begins that would, at the pace so far, end later")
    solver: CG = setting(lambda: CG(rtol=1e-4, max_iter=500), "for maps and derivatives")
    operator_rtol: float = setting(1e-3, "part of the features' weight that commutativity leaves out", low=0, below=1)
    seed: int = setting(0, "for the order of the pairs and the points of the coupling loss", low=0)

    def __post_init__(self) -> None:
        unknown = sorted(set(self.losses) - set(LOSSES))
        if unknown or not self.losses:
            raise refuse("losses", "some of " + ", ".join(LOSSES), ", ".join(unknown) or "none", "choose among them")
        for name, weight in self.losses.items():
            check_positive(weight, f"weight of the loss {name}")
        if not self.seconds > 0:
            raise refuse("seconds", "a number above zero", repr(self.seconds), "leave it out for no limit")
        for name, one in settings_of(TrainingOptions).items():
            if name not in ("losses", "seconds"):
                one.check(getattr(self, name), name, "compare with kfmaps learn --help")


def functional_map(model: Model, pair: TrainingPair, solver: CG, operator_rtol: float = 0.0) -> torch.Tensor:
    """Return the map ``C (k, k)`` that minimises the model's energy of a ``pair``, differentiable in its parameters.

    ``solver`` and ``operator_rtol`` are those of :class:`TrainingOptions`.
    """
    transformed = [model.transform(D) for D in (pair.descriptors_s, pair.descriptors_t, pair.samples)]
    W_s, W_t = nystrom_features(model.kernel_matrix, *transformed)
    formulation = model.config.formulation
    energy = pair_energy(pair.source, pair.target, W_s, W_t, model.weights(), operator_rtol, formulation)
    return differentiable_minimum(energy, solver).C


def pair_loss(
    model: Model, pair: TrainingPair, options: TrainingOptions, rng: np.random.Generator | None = None
) -> torch.Tensor:
    """Return the weighted sum of the losses of a ``pair`` that ``options`` name.

    ``rng`` draws the points of the coupling loss.

    Raises
    ------
    InvalidInput
        When a loss needs the truth of a pair that has none.
    """
    solver, rtol, temperature = options.solver, options.operator_rtol, options.temperature
    C = functional_map(model, pair, solver, rtol)
    source = pair.source.functions
    values: dict[str, Callable[[Any], torch.Tensor]] = {
        "geodesic": lambda truth: geodesic_loss(C, source, truth.functions_t, truth.distances.to(C.dtype), temperature),
        "supervised": lambda truth: supervised_loss(C, truth.functional_map),
        "orthogonality": lambda _: orthogonality_loss(C),
        "cycle": lambda _: cycle_loss(C, functional_map(model, pair.swapped(), solver, rtol)),
        "commutativity": lambda _: commutativity_loss(C, pair.source, pair.target),
        "coupling": lambda _: _coupling(model, pair, C, temperature, rng or np.random.default_rng(0)),
    }
    total = torch.zeros((), dtype=C.dtype)
    for name, weight in options.losses.items():
        if name in ("geodesic", "supervised") and pair.truth is None:
            raise refuse(f"loss {name}", "pairs with a truth", f"{pair.name} without one", "take another loss")
        total = total + weight * values[name](pair.truth)
    return total


def point_error(model: Model, pair: TrainingPair, options: TrainingOptions) -> float:
    """Return the mean geodesic error of the raw point map, in √area, at the known correspondences of a ``pair``.

    Of ``options`` only the solver and the truncation of operators count.
    """
    if pair.truth is None:
        raise refuse("held-out pairs", "pairs with a truth", f"{pair.name} without one", "judge by the loss")
    with torch.no_grad():
        C = functional_map(model, pair, options.solver, options.operator_rtol)
        images = (pair.source.functions @ C.T).numpy()
    points = nearest(pair.truth.functions_t.numpy(), images)
    return float(pair.truth.distances.numpy()[np.arange(len(points)), points].mean())


def supervised_loss(C: torch.Tensor, true: torch.Tensor) -> torch.Tensor:
    """Return ``‖C − C*‖² / ‖C*‖²`` for the ``true`` map ``C*`` (FMNet, Litany et al. 2017; Donati et al. 2020)."""
    return ((C - true) ** 2).sum() / (true**2).sum()


def orthogonality_loss(C: torch.Tensor) -> torch.Tensor:
    """Return ``‖CᵀC − I‖² / k`` of ``C``, zero for maps that preserve areas (Roufosse et al. 2019)."""
    return cycle_loss(C, C.T)


def cycle_loss(C: torch.Tensor, back: torch.Tensor) -> torch.Tensor:
    """Return ``‖back C − I‖² / k`` for ``C`` and a map ``back`` from target to source (Roufosse et al. 2019)."""
    k = C.shape[1]
    return ((back @ C - torch.eye(k, dtype=C.dtype)) ** 2).sum() / k


def commutativity_loss(C: torch.Tensor, source: Basis, target: Basis) -> torch.Tensor:
    """Return ``‖C Λ_s − Λ_t C‖² / ‖Λ_s‖²`` of ``C``, zero for isometries (Roufosse et al. 2019)."""
    commutator = C * source.eigenvalues[None, :] - target.eigenvalues[:, None] * C
    return (commutator**2).sum() / (source.eigenvalues**2).sum()


def soft_point_map(queries: torch.Tensor, points: torch.Tensor, temperature: float) -> torch.Tensor:
    """Return the soft map ``(m, n)`` of each of the ``queries (m, k)`` among the ``points (n, k)``; rows sum to 1.

    ``softmax(−‖x − y‖² / (temperature · s))`` with ``s`` the mean squared distance to the nearest point, so that
    ``temperature`` has no unit; towards 0 it is the map to the nearest.
    """
    squares = (queries**2).sum(dim=1)[:, None] + (points**2).sum(dim=1)[None, :] - 2 * queries @ points.T
    smallest = squares.detach().min(dim=1, keepdim=True).values
    scale = temperature * smallest.clamp(min=0.0).mean() + 1e-12 * squares.detach().abs().mean() + 1e-300
    return torch.softmax((smallest - squares) / scale, dim=1)


def geodesic_loss(
    C: torch.Tensor,
    functions_s: torch.Tensor,
    functions_t: torch.Tensor,
    distances: torch.Tensor,
    temperature: float = 0.03,
) -> torch.Tensor:
    """Return the mean expected geodesic error of the soft point map of ``C``, in units of √area.

    Parameters
    ----------
    C : (k_t, k_s) tensor
    functions_s : (n, k_s) tensor
        At the source points that may be chosen.
    functions_t : (m, k_t) tensor
        At the target points that are judged.
    distances : (m, n) tensor
        From the true partner of each of these, on the source, to each point that may be chosen.
    temperature : float
        See :func:`soft_point_map`.
    """
    soft = soft_point_map(functions_t, functions_s @ C.T, temperature)
    return (soft * distances).sum(dim=1).mean()


def coupling_loss(
    C: torch.Tensor, soft: torch.Tensor, functions_s: torch.Tensor, functions_t: torch.Tensor, ridge: float = 1e-3
) -> torch.Tensor:
    """Return ``‖C − Φ_t⁺ Π Φ_s‖² / k`` for a soft point map ``Π`` of the descriptors (Cao et al. 2023).

    Parameters
    ----------
    C : (k_t, k_s) tensor
    soft : (m, n) tensor
        Π, rows summing to 1.
    functions_s, functions_t : (n, k_s), (m, k_t) tensors
        At the points of ``Π``.
    ridge : float
        ``Φ_t⁺`` is the least-squares inverse, damped by so much of the mean diagonal.
    """
    gram = functions_t.T @ functions_t
    gram = gram + ridge * torch.diagonal(gram).mean() * torch.eye(len(gram), dtype=gram.dtype)
    image = torch.linalg.solve(gram, functions_t.T @ (soft @ functions_s))
    return ((C - image) ** 2).sum() / C.shape[1]


def _coupling(
    model: Model, pair: TrainingPair, C: torch.Tensor, temperature: float, rng: np.random.Generator
) -> torch.Tensor:
    """Return the coupling loss at some points of both shapes."""
    sizes = (len(pair.descriptors_t), len(pair.descriptors_s))
    t, s = (np.sort(rng.choice(n, min(n, most), replace=False)) for n, most in zip(sizes, _MAX_COUPLED, strict=True))
    transformed = model.transform(pair.descriptors_t[t]), model.transform(pair.descriptors_s[s])
    soft = soft_point_map(*transformed, temperature)
    return coupling_loss(C, soft, pair.source.functions[s], pair.target.functions[t])
