"""The loss of a functional map while learning: the expected geodesic error of its soft point map."""

from __future__ import annotations

import math

import numpy as np
import torch

from kfmaps._arrays import refuse
from kfmaps._records import setting, settings_of, settings_record
from kfmaps.fmap.nearest import nearest
from kfmaps.fmap.solvers import CG
from kfmaps.learn.energy import differentiable_minimum, nystrom_features, pair_energy
from kfmaps.learn.model import Model
from kfmaps.learn.pairs import TrainingPair


@settings_record
class TrainingOptions:
    """How to learn. Most parameters are logarithms, so that a rate of 0.1 changes a weight by about a tenth a step."""

    epochs: int = setting(5, "largest number of passes through all pairs", low=1)
    batch: int = setting(2, "number of pairs whose gradients are averaged for one step", low=1)
    rate: float = setting(0.1, "Adam's, which falls to zero over the epochs as half a cosine", above=0)
    patience: int = setting(3, "epochs without a better mean over held-out pairs, after which learning stops", low=1)
    temperature: float = setting(0.03, "of soft point maps, see :func:`soft_point_map`", above=0)
    seconds: float = setting(math.inf, "no further epoch begins that would, at the pace so far, end later")
    solver: CG = setting(lambda: CG(rtol=1e-4, max_iter=500), "for maps and derivatives")
    operator_rtol: float = setting(1e-3, "part of the features' weight that commutativity leaves out", low=0, below=1)
    seed: int = setting(0, "for the order of the pairs", low=0)

    def __post_init__(self) -> None:
        if not self.seconds > 0:
            raise refuse("seconds", "a number above zero", repr(self.seconds), "leave it out for no limit")
        for name, one in settings_of(TrainingOptions).items():
            if name != "seconds":
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


def pair_loss(model: Model, pair: TrainingPair, options: TrainingOptions) -> torch.Tensor:
    """Return the expected geodesic error, in √area, of the soft point map of a ``pair``.

    ``options`` are those of :func:`~kfmaps.learn.training.learn`.
    """
    C = functional_map(model, pair, options.solver, options.operator_rtol)
    distances = pair.distances.to(C.dtype)
    return geodesic_loss(C, pair.source.functions, pair.functions_t, distances, options.temperature)


def point_error(model: Model, pair: TrainingPair, options: TrainingOptions) -> float:
    """Return the mean geodesic error of the raw point map, in √area, at the known correspondences of a ``pair``.

    Of ``options`` only the solver and the truncation of operators count.
    """
    with torch.no_grad():
        C = functional_map(model, pair, options.solver, options.operator_rtol)
        images = (pair.source.functions @ C.T).numpy()
    points = nearest(pair.functions_t.numpy(), images)
    return float(pair.distances.numpy()[np.arange(len(points)), points].mean())


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
    C: torch.Tensor, functions_s: torch.Tensor, functions_t: torch.Tensor, distances: torch.Tensor, temperature: float
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
