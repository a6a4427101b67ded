"""Learn by steps of Adam over pairs with early stopping on held-out pairs; the best state is kept.

The state can be saved to a file, from which learning continues, and drawn.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from matplotlib.figure import Figure

from kfmaps._arrays import InvalidInput, NotConverged, refuse
from kfmaps._records import JsonObject, short_repr
from kfmaps.io import atomic_output
from kfmaps.learn.model import Model, TrainingOptions, pair_loss, point_error
from kfmaps.learn.pairs import TrainingPair
from kfmaps.settings import FORMAT, read_learned
from kfmaps.viz.curves import COLORS
from kfmaps.viz.figures import TEXT, style_axes

_MATRIX_RATE = 0.3
"""Part of the rate at which entries of a metric change, in units of their root mean square."""


@dataclass(frozen=True)
class Epoch:
    """Geodesic errors after an epoch, in √area; epoch 0 is before learning."""

    number: int
    loss: float  # mean expected error over the training pairs
    held_out: float  # mean error of raw point maps over the held-out pairs; the loss where there are none
    seconds: float  # since the start


@dataclass(frozen=True, eq=False)
class State:
    """The state of learning, with everything that is needed to continue."""

    parameters: dict[str, torch.Tensor]  # of the model
    best: dict[str, torch.Tensor]  # those of the epoch with the least held-out error
    optimizer: dict  # state of Adam
    history: tuple[Epoch, ...]

    __repr__ = short_repr

    @property
    def best_epoch(self) -> Epoch:
        """Return the epoch with the least held-out error."""
        return min(self.history, key=lambda epoch: epoch.held_out)


def learn(
    model: Model,
    pairs: Sequence[TrainingPair],
    held_out: Sequence[TrainingPair],
    options: TrainingOptions | None = None,
    *,
    state: State | None = None,
    on_epoch: Callable[[State], None] | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> State:
    """Fit a model's parameters to pairs; in the end the model has those with the least held-out error.

    Parameters
    ----------
    model : Model
        Changed in place.
    pairs, held_out : sequences of TrainingPair
        To learn from, and to choose the best epoch. Without held-out pairs the training loss chooses it.
    options : TrainingOptions, optional
    state : State, optional
        Of an earlier call with the same arguments, to continue from.
    on_epoch : callable, optional
        Called with the state after each epoch, for instance to save it.
    progress : callable, optional
        ``progress(stage, done)`` with done from 0 to 1.

    Returns
    -------
    State

    Raises
    ------
    NotConverged
        When a loss or gradient is not finite. The model is left with the best parameters so far, and ``on_epoch`` was
        called with them.
    """
    if not pairs:
        raise refuse("pairs to learn from", "at least one", "none", "check the names of shapes and pairs")
    run = _Run(model, pairs, held_out, options or TrainingOptions(), progress or (lambda _stage, _done: None))
    state = run.begin(state)
    if on_epoch is not None and len(state.history) == 1:
        on_epoch(state)
    try:
        while not run.is_finished(state):
            state = run.epoch(state)
            if on_epoch is not None:
                on_epoch(state)
    finally:
        model.load_state_dict(state.best)
    return state


@dataclass
class _Run:
    """The loop of one call of :func:`learn`."""

    model: Model
    pairs: Sequence[TrainingPair]
    held_out: Sequence[TrainingPair]
    options: TrainingOptions
    progress: Callable[[str, float], None]

    def __post_init__(self) -> None:
        self.optimizer = torch.optim.Adam(_groups(self.model))
        self.started = time.perf_counter()

    def begin(self, state: State | None) -> State:
        """Return the state before learning, or set model and optimizer to the given ``state``."""
        if state is None:
            parameters = self.parameters()
            with torch.no_grad():
                loss = self.mean("training pairs", self.pairs, lambda *arguments: float(pair_loss(*arguments)))
            first = Epoch(0, loss, self.judge(loss), time.perf_counter() - self.started)
            return State(parameters, parameters, self.optimizer.state_dict(), (first,))
        self.model.load_state_dict(state.parameters)
        self.optimizer.load_state_dict(state.optimizer)
        self.started -= state.history[-1].seconds
        return state

    def is_finished(self, state: State) -> bool:
        """Return whether epochs, patience or time have run out."""
        options, last = self.options, state.history[-1]
        if last.number >= options.epochs or last.number - state.best_epoch.number >= options.patience:
            return True
        pace = last.seconds / (last.number + 1)
        return last.seconds + pace > options.seconds

    def epoch(self, state: State) -> State:
        """Pass through all pairs once, in an order that depends on the seed and the epoch's number alone."""
        number, total = state.history[-1].number + 1, 0.0
        order = np.random.default_rng([self.options.seed, number]).permutation(len(self.pairs))
        for a in range(0, len(order), self.options.batch):
            self.progress(f"epoch {number}", a / len(order))
            total += self.step([self.pairs[i] for i in order[a : a + self.options.batch]], state, a / len(order))
        self.progress(f"epoch {number}", 1.0)
        loss = total / len(order)
        try:
            held_out = self.judge(loss)
        except (NotConverged, InvalidInput, RuntimeError) as error:
            raise _failure(error, "held out", state) from error
        last = Epoch(number, loss, held_out, time.perf_counter() - self.started)
        now = self.parameters()
        best = now if held_out < state.best_epoch.held_out else state.best
        optimizer = self.optimizer.state_dict()
        return replace(state, parameters=now, best=best, optimizer=optimizer, history=(*state.history, last))

    def step(self, pairs: Sequence[TrainingPair], state: State, done: float) -> float:
        """Change the parameters by the mean gradient of ``pairs``; return the sum of their losses."""
        passed = (state.history[-1].number + done) / self.options.epochs
        share = 0.5 * (1 + math.cos(math.pi * min(1.0, passed)))
        for group in self.optimizer.param_groups:
            group["lr"] = self.options.rate * share * group["share"]
        self.optimizer.zero_grad()
        total = 0.0
        for pair in pairs:
            try:
                loss = pair_loss(self.model, pair, self.options)
                (loss / len(pairs)).backward()
                total += float(loss.detach())
                _check_finite(self.model, total)
            except (NotConverged, InvalidInput, RuntimeError) as error:
                raise _failure(error, pair.name, state) from error
        self.optimizer.step()
        return total

    def judge(self, loss: float) -> float:
        """Return the mean error of the held-out pairs; ``loss`` where there are none."""
        return self.mean("held-out pairs", self.held_out, point_error) if self.held_out else loss

    def mean(self, stage: str, pairs: Sequence[TrainingPair], of: Callable[..., float]) -> float:
        """Return the mean ``of`` a model, pair and options over ``pairs``."""
        values = []
        for i, pair in enumerate(pairs):
            self.progress(stage, i / len(pairs))
            values.append(of(self.model, pair, self.options))
        self.progress(stage, 1.0)
        return float(np.mean(values))

    def parameters(self) -> dict[str, torch.Tensor]:
        """Return a copy of the model's parameters."""
        return {name: tensor.detach().clone() for name, tensor in self.model.state_dict().items()}


def _groups(model: Model) -> list[dict[str, Any]]:
    """Return each parameter with its share of the rate: 1 for logarithms, for matrices relative to their size."""
    groups = []
    for name, p in model.named_parameters():
        if p.requires_grad:
            size = float((p.detach() ** 2).mean().sqrt())
            share = 1.0 if name.startswith("log_") else _MATRIX_RATE * max(0.15, size)
            groups.append({"params": [p], "share": share})
    return groups


def _check_finite(model: Model, loss: float) -> None:
    bad = [name for name, p in model.named_parameters() if p.grad is not None and not p.grad.isfinite().all()]
    if not np.isfinite(loss) or bad:
        where = f"the gradient of {', '.join(bad)}" if np.isfinite(loss) else "the loss"
        raise NotConverged(f"NaN or infinity in {where}")


def _failure(error: Exception, name: str, state: State) -> NotConverged:
    got = str(error).splitlines()[0]
    return NotConverged(
        f"learning: expected finite numbers, got {got} at the pair {name}, epoch {state.history[-1].number + 1}. "
        f"The state of epoch {state.best_epoch.number}, the best so far, is kept. Learn again with a lower rate."
    )


def save(path: str | Path, state: State, settings: str, request: JsonObject) -> None:
    """Write a ``state`` and plain values to the file ``path``.

    ``settings``: TOML of the best parameters; ``request``: arguments that a later run must repeat to continue.
    """
    content = {
        "format": FORMAT,
        "settings": settings,
        "request": request,
        "parameters": state.parameters,
        "best": state.best,
        "optimizer": state.optimizer,
        "history": [list(astuple(epoch)) for epoch in state.history],
    }
    with atomic_output(Path(path), force=True) as temporary:
        torch.save(content, temporary)


def load(path: str | Path) -> tuple[State, str, JsonObject]:
    """Return the state, settings and request of the file ``path`` that :func:`save` wrote.

    Only tensors and plain values are read (``weights_only``): a file with anything else is refused.

    Raises
    ------
    InvalidInput
        When the file is missing, damaged, or of another kind.
    """
    content = read_learned(path)
    try:
        history = tuple(Epoch(*row) for row in content["history"])
        tensors = [dict(content[name]) for name in ("parameters", "best")]
        if not all(isinstance(t, torch.Tensor) for part in tensors for t in part.values()):
            raise TypeError("tensors as parameters")
        state = State(tensors[0], tensors[1], dict(content["optimizer"]), history)
        return state, str(content["settings"]), dict(content["request"])
    except (KeyError, TypeError, ValueError) as error:
        raise refuse(f"{path}", "a file of kfmaps learn", f"one without {error}", "learn again") from error


def learning_figure(history: Sequence[Epoch]) -> Figure:
    """Draw the training loss and the held-out error by epoch of a ``history``; a ring marks the best epoch."""
    figure = Figure(figsize=(5.5, 4.2), facecolor="white", layout="constrained")
    numbers, best = [epoch.number for epoch in history], min(history, key=lambda epoch: epoch.held_out)
    rows = (("training loss × 100", "loss"), ("held-out error × 100", "held_out"))
    for ax, color, (name, field) in zip(figure.subplots(2, 1, sharex=True), COLORS, rows, strict=False):
        ax.plot(numbers, [100 * getattr(epoch, field) for epoch in history], color=color, marker=".")
        if field == "held_out":
            ax.plot([best.number], [100 * best.held_out], "o", color=color, markersize=10, fillstyle="none")
            ax.set_xlabel("epoch", fontsize=10, color=TEXT)
        ax.xaxis.get_major_locator().set_params(integer=True)
        ax.set_ylabel(name, fontsize=10, color=TEXT)
        style_axes(ax)
    return figure
