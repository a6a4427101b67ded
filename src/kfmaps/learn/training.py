"""Learning: steps of Adam over pairs, early stopping on pairs held out, the best state always kept."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import torch

from kfmaps._arrays import InvalidInput, NotConverged, check_count, check_positive, refuse
from kfmaps.fmap.solvers import CG
from kfmaps.learn.fitting import pair_loss, point_error
from kfmaps.learn.lessons import Lesson
from kfmaps.learn.model import Model
from kfmaps.learn.names import LOSSES

Progress = Callable[[str, float], None]

MATRICES = 0.3
"""Part of the rate at which entries of a metric or network are changed, in units of their root mean square."""


@dataclass(frozen=True)
class Training:
    """How to learn.

    Attributes
    ----------
    losses : mapping of name to weight
        Of :data:`kfmaps.learn.names.LOSSES`.
    epochs : int
        Times through all pairs, at most.
    batch : int
        Pairs whose gradients are averaged for one step.
    rate : float
        Adam's; most parameters are logarithms, so 0.1 changes a weight by about a tenth a step.
    falling : bool
        Whether the rate falls to zero over the epochs, as half a cosine: learning then ends where it settles.
    patience : int
        Epochs without a better mean over the pairs held out, after which it stops.
    decay : float
        Weight of the mean squared distance of the parameters from where they began: few pairs cannot carry them far.
    temperature : float
        Of soft point maps, see :func:`kfmaps.learn.losses.soft_points`.
    seconds : float or None
        No further epoch begins that would, at the pace so far, end after as many.
    solver : CG
        For maps and derivatives.
    compression : float
        Part of the features' weight that commutativity may leave out; 0 makes the gradient exact and slow.
    seed : int
    """

    losses: Mapping[str, float] = field(default_factory=lambda: {"geodesic": 1.0})
    epochs: int = 30
    batch: int = 2
    rate: float = 0.1
    falling: bool = True
    patience: int = 6
    decay: float = 0.0
    temperature: float = 0.03
    seconds: float | None = None
    solver: CG = field(default_factory=lambda: CG(rtol=1e-4, max_steps=500))
    compression: float = 1e-3
    seed: int = 0

    def __post_init__(self) -> None:
        if not self.losses or set(self.losses) - set(LOSSES):
            got = ", ".join(sorted(set(self.losses) - set(LOSSES))) or "none"
            raise refuse("losses", "some of " + ", ".join(LOSSES), got, "name them")
        for name, weight in self.losses.items():
            check_positive(weight, f"weight of the loss {name}")
        for name in ("epochs", "batch", "patience"):
            check_count(getattr(self, name), name)
        check_positive(self.rate, "rate", "0.1 is usual")
        check_positive(self.temperature, "temperature", "0.03 is usual")
        if not 0 <= self.decay < float("inf"):
            raise refuse("decay", "a finite number of at least zero", repr(self.decay), "0 is usual")


@dataclass(frozen=True)
class Epoch:
    """What is noted after each epoch; the first, number 0, is from before learning.

    ``loss`` is the mean over training pairs, ``held_out`` over those held out: the mean geodesic error of their raw
    point maps in √area where their truth is known, else the loss.
    """

    number: int
    loss: float
    held_out: float
    seconds: float


@dataclass(frozen=True, eq=False)
class State:
    """Where learning stands: enough to go on as if it had never stopped.

    Attributes
    ----------
    parameters, best : dict of str to tensor
        Of the model, now and at the epoch that was best on the pairs held out.
    start : dict of str to tensor
        Of the model before learning.
    optimiser : dict
        Adam's own.
    history : tuple of Epoch
    """

    parameters: dict[str, torch.Tensor]
    best: dict[str, torch.Tensor]
    start: dict[str, torch.Tensor]
    optimiser: dict
    history: tuple[Epoch, ...]

    @property
    def chosen(self) -> Epoch:
        """The best epoch."""
        return min(self.history, key=lambda epoch: epoch.held_out)


def learn(
    model: Model,
    lessons: Sequence[Lesson],
    held_out: Sequence[Lesson],
    training: Training | None = None,
    *,
    state: State | None = None,
    keep: Callable[[State], None] | None = None,
    progress: Progress | None = None,
) -> State:
    """Fit a model's parameters to pairs, and leave it with those that were best on the pairs held out.

    Parameters
    ----------
    model : Model
        Changed in place.
    lessons, held_out : sequences of Lesson
        To learn from, and to judge by. Without any held out, the training pairs' own loss is the judge.
    state : State, optional
        Of an earlier call with the same arguments, to go on from.
    keep : callable, optional
        Told the state after each epoch, to write it down.
    progress : callable, optional
        ``progress(stage, done)`` with done from 0 to 1.

    Raises
    ------
    NotConverged
        When a loss or gradient is not finite. The model is left with the best parameters so far, and ``keep`` was
        told of them.
    """
    training = training or Training()
    report = progress or (lambda _stage, _done: None)
    if not lessons:
        raise refuse("pairs to learn from", "at least one", "none", "check the names of shapes and pairs")
    optimiser = torch.optim.Adam(_groups(model, training.rate))
    begun = time.perf_counter()
    if state is None:
        now = _copied(model)
        first = _judged(model, lessons, held_out, training, report, loss=None)
        state = State(now, now, now, optimiser.state_dict(), (Epoch(0, *first, time.perf_counter() - begun),))
        if keep is not None:
            keep(state)
    else:
        model.load_state_dict(state.parameters)
        optimiser.load_state_dict(state.optimiser)
        begun -= state.history[-1].seconds
    try:
        while not _finished(state, training):
            state = _epoch(model, optimiser, lessons, held_out, training, state, begun, report)
            if keep is not None:
                keep(state)
    finally:
        model.load_state_dict(state.best)
    return state


def _groups(model: Model, rate: float) -> list[dict[str, Any]]:
    """Logarithms at the full rate, entries of matrices at a part of it in units of how large they began."""
    groups = []
    for name, p in model.named_parameters():
        if p.requires_grad:
            share = 1.0 if name.startswith("log_") else MATRICES * max(0.15, float((p.detach() ** 2).mean().sqrt()))
            groups.append({"params": [p], "share": share, "lr": rate * share})
    return groups


def _paced(optimiser: torch.optim.Optimizer, training: Training, epochs: float) -> None:
    """Set the rate for a step after so many ``epochs``, which need not be whole."""
    share = 0.5 * (1 + math.cos(math.pi * min(1.0, epochs / training.epochs))) if training.falling else 1.0
    for group in optimiser.param_groups:
        group["lr"] = training.rate * share * group["share"]


def _finished(state: State, training: Training) -> bool:
    done = state.history[-1]
    if done.number >= training.epochs or done.number - state.chosen.number >= training.patience:
        return True
    pace = done.seconds / (done.number + 1)
    return training.seconds is not None and done.seconds + pace > training.seconds


def _epoch(
    model: Model,
    optimiser: torch.optim.Optimizer,
    lessons: Sequence[Lesson],
    held_out: Sequence[Lesson],
    training: Training,
    state: State,
    begun: float,
    report: Progress,
) -> State:
    """One time through all pairs; the order depends on the seed and the epoch's number alone."""
    number = state.history[-1].number + 1
    draw = np.random.default_rng([training.seed, number])
    order = draw.permutation(len(lessons))
    stage, total = f"epoch {number}", 0.0
    report(stage, 0.0)
    for a in range(0, len(order), training.batch):
        some = order[a : a + training.batch]
        _paced(optimiser, training, number - 1 + a / len(order))
        optimiser.zero_grad()
        for i in some:
            try:
                loss = _loss(model, lessons[i], training, draw) / len(some)
                loss.backward()
            except (NotConverged, InvalidInput, RuntimeError) as error:
                raise _stopped(str(error).splitlines()[0], lessons[i].name, state) from error
            total += float(loss.detach()) * len(some)
            _check_finite(model, lessons[i].name, float(loss.detach()), state)
        if training.decay:
            (training.decay * _moved(model, state.start)).backward()
        optimiser.step()
        report(stage, min(1.0, (a + len(some)) / len(order)))
    try:
        judged = _judged(model, lessons, held_out, training, report, loss=total / len(order))
    except (NotConverged, InvalidInput, RuntimeError) as error:
        raise _stopped(str(error).splitlines()[0], "held out", state) from error
    epoch = Epoch(number, *judged, time.perf_counter() - begun)
    now = _copied(model)
    best = now if epoch.held_out < state.chosen.held_out else state.best
    return State(now, best, state.start, optimiser.state_dict(), (*state.history, epoch))


def _loss(model: Model, lesson: Lesson, training: Training, draw: np.random.Generator) -> torch.Tensor:
    return pair_loss(
        model,
        lesson,
        training.losses,
        solver=training.solver,
        compression=training.compression,
        temperature=training.temperature,
        rng=draw,
    )


def _judged(
    model: Model,
    lessons: Sequence[Lesson],
    held_out: Sequence[Lesson],
    training: Training,
    report: Progress,
    loss: float | None,
) -> tuple[float, float]:
    """The training loss, worked out unless it is known, and the mean over the pairs held out."""
    draw = np.random.default_rng([training.seed, 0])

    def mean(some: Sequence[Lesson], stage: str, errors: bool) -> float:
        values = []
        for i, lesson in enumerate(some):
            report(stage, i / len(some))
            if errors and lesson.known is not None:
                options = {"solver": training.solver, "compression": training.compression}
                values.append(point_error(model, lesson, **options))
            else:
                with torch.no_grad():
                    values.append(float(_loss(model, lesson, training, draw)))
        report(stage, 1.0)
        return float(np.mean(values))

    known = mean(lessons, "training pairs", False) if loss is None else loss
    return known, mean(held_out, "held-out pairs", True) if held_out else known


def _check_finite(model: Model, name: str, loss: float, state: State) -> None:
    learned = [(key, p.grad) for key, p in model.named_parameters() if p.grad is not None]
    bad = [key for key, gradient in learned if not bool(torch.isfinite(gradient).all())]
    if np.isfinite(loss) and not bad:
        return
    what = f"the gradient of {', '.join(bad)}" if np.isfinite(loss) else "the loss"
    raise _stopped(f"NaN or infinity in {what}", name, state)


def _stopped(got: str, name: str, state: State) -> NotConverged:
    return NotConverged(
        f"learning: wanted finite numbers, got “{got}” at the pair {name}, epoch {state.history[-1].number + 1}; "
        f"the state of epoch {state.chosen.number}, the best so far, is kept: learn again with a lower rate"
    )


def _moved(model: Model, start: dict[str, torch.Tensor]) -> torch.Tensor:
    parts = [((p - start[name]) ** 2).mean() for name, p in model.named_parameters() if p.requires_grad]
    return torch.stack(parts).mean()


def _copied(model: Model) -> dict[str, torch.Tensor]:
    return {name: tensor.detach().clone() for name, tensor in model.state_dict().items()}
