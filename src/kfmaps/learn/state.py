"""Where learning stands: its history and parameters, as a file from which it continues, and as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass
from pathlib import Path

import torch
from matplotlib.figure import Figure

from kfmaps._arrays import refuse
from kfmaps._records import JsonObject, short_repr
from kfmaps.io import atomic_output
from kfmaps.settings.merge import FORMAT, read_learned
from kfmaps.viz.curves import COLORS
from kfmaps.viz.figures import TEXT, style_axes


@dataclass(frozen=True)
class Epoch:
    """Geodesic errors after an epoch, in √area; epoch 0 is before learning."""

    number: int
    loss: float  # mean expected error over the training pairs
    held_out: float  # mean error of raw point maps over the held-out pairs; the loss where there are none
    seconds: float  # since the start


@dataclass(frozen=True, eq=False)
class State:
    """Where learning stands: all that is needed to continue as if it had never stopped."""

    parameters: dict[str, torch.Tensor]  # of the model, now
    best: dict[str, torch.Tensor]  # at the epoch that was best on the held-out pairs
    optimizer: dict  # state of Adam
    history: tuple[Epoch, ...]

    __repr__ = short_repr

    @property
    def best_epoch(self) -> Epoch:
        """Return the epoch that was best on the held-out pairs."""
        return min(self.history, key=lambda epoch: epoch.held_out)


def save(path: str | Path, state: State, settings: str, request: JsonObject) -> None:
    """Write the file ``path``: a ``state``, and plain values beside it.

    ``settings`` are the TOML of the best parameters, ``request`` is what a later run must ask for again to continue.
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
        raise refuse(f"{path}", "a file of kfmaps learn", f"one without {error}", "learn anew") from error


def learning_figure(history: Sequence[Epoch]) -> Figure:
    """Draw the training loss and the held-out error by epoch of a ``history``; a ring marks the epoch that was kept."""
    figure = Figure(figsize=(5.5, 4.2), facecolor="white", layout="constrained")
    numbers, kept = [epoch.number for epoch in history], min(history, key=lambda epoch: epoch.held_out)
    rows = (("training loss × 100", "loss"), ("held-out error × 100", "held_out"))
    for ax, color, (name, field) in zip(figure.subplots(2, 1, sharex=True), COLORS, rows, strict=False):
        ax.plot(numbers, [100 * getattr(epoch, field) for epoch in history], color=color, marker=".")
        if field == "held_out":
            ax.plot([kept.number], [100 * kept.held_out], "o", color=color, markersize=10, fillstyle="none")
            ax.set_xlabel("epoch", fontsize=10, color=TEXT)
        ax.xaxis.get_major_locator().set_params(integer=True)
        ax.set_ylabel(name, fontsize=10, color=TEXT)
        style_axes(ax)
    return figure
