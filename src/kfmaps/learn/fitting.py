"""The map of a pair as a function of a model's parameters, and its loss."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import torch

from kfmaps._arrays import refuse
from kfmaps.fmap.nearest import nearest
from kfmaps.fmap.solvers import CG
from kfmaps.learn import losses
from kfmaps.learn.energies import features, pair_energy
from kfmaps.learn.implicit import minimiser
from kfmaps.learn.lessons import Lesson
from kfmaps.learn.model import Model
from kfmaps.learn.names import LOSSES, SUPERVISED

COUPLED = (400, 1000)
"""Target and source points, at most, of the soft point map that the coupling loss forms."""


def functional_map(model: Model, lesson: Lesson, solver: CG, compression: float = 0.0) -> torch.Tensor:
    """The map ``C (k, k)`` that minimises the model's energy of a pair, differentiable in its parameters."""
    lifted = [model.lift(D) for D in (lesson.descriptors_s, lesson.descriptors_t, lesson.samples)]
    W_s, W_t = features(model.matrix, *lifted)
    asked = model.config.formulation
    energy = pair_energy(lesson.source, lesson.target, W_s, W_t, model.weights(), compression, asked)
    return minimiser(energy, solver).C


def pair_loss(
    model: Model,
    lesson: Lesson,
    weights: Mapping[str, float],
    *,
    solver: CG,
    compression: float = 0.0,
    temperature: float = 0.03,
    rng: np.random.Generator | None = None,
) -> torch.Tensor:
    """The weighted sum of losses of a pair; the keys of ``weights`` are those of :data:`kfmaps.learn.names.LOSSES`.

    Raises
    ------
    InvalidInput
        When a loss has no such name, or needs the truth of a pair that has none.
    """
    unknown = [name for name in weights if name not in LOSSES]
    if unknown or not weights:
        raise refuse("losses", "some of " + ", ".join(LOSSES), ", ".join(unknown) or "none", "name them")
    C = functional_map(model, lesson, solver, compression)
    known, total = lesson.known, torch.zeros((), dtype=C.dtype)
    for name, weight in weights.items():
        if name in SUPERVISED and known is None:
            raise refuse(f"loss {name}", "pairs whose truth is known", lesson.name, "give it, or take another loss")
        if name == "geodesic" and known is not None:
            functions, distances = lesson.source.functions, known.distances.to(C.dtype)
            value = losses.geodesic(C, functions, known.functions_t, distances, temperature)
        elif name == "supervised" and known is not None:
            value = losses.supervised(C, known.wanted)
        elif name == "orthogonality":
            value = losses.orthogonality(C)
        elif name == "cycle":
            value = losses.cycle(C, functional_map(model, lesson.swapped(), solver, compression))
        elif name == "commutativity":
            value = losses.commutativity(C, lesson.source, lesson.target)
        else:
            value = _coupling(model, lesson, C, temperature, rng)
        total = total + weight * value
    return total


def _coupling(
    model: Model, lesson: Lesson, C: torch.Tensor, temperature: float, rng: np.random.Generator | None
) -> torch.Tensor:
    """The coupling loss on some points of both shapes."""
    draw = rng or np.random.default_rng(0)
    sizes = (len(lesson.descriptors_t), len(lesson.descriptors_s))
    t, s = (np.sort(draw.choice(n, min(n, most), replace=False)) for n, most in zip(sizes, COUPLED, strict=True))
    soft = losses.soft_points(model.lift(lesson.descriptors_t[t]), model.lift(lesson.descriptors_s[s]), temperature)
    return losses.coupling(C, soft, lesson.source.functions[s], lesson.target.functions[t])


def point_error(model: Model, lesson: Lesson, *, solver: CG, compression: float = 0.0) -> float:
    """Mean geodesic error of the raw point map, in √area, at the judged points of a pair whose truth is known."""
    if lesson.known is None:
        raise refuse("held-out pairs", "pairs whose truth is known", lesson.name, "judge by the loss")
    with torch.no_grad():
        C = functional_map(model, lesson, solver, compression)
        images = (lesson.source.functions @ C.T).numpy()
    found = nearest(lesson.known.functions_t.numpy(), images)
    return float(lesson.known.distances.numpy()[np.arange(len(found)), found].mean())
