"""A picture of how learning went."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from kfmaps.learn.training import Epoch
from kfmaps.viz.curves import COLORS
from kfmaps.viz.figures import TEXT


def learning_figure(history: Sequence[Epoch], *, truth: bool = True) -> Figure:
    """The training loss and what the held-out pairs say, epoch by epoch; a ring marks the one that was kept.

    Parameters
    ----------
    history : sequence of Epoch
    truth : bool
        Whether held-out pairs were judged by the error of their point maps, times 100, or by the loss.
    """
    figure = Figure(figsize=(5.5, 4.2), facecolor="white", layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    numbers = [epoch.number for epoch in history]
    factor = 100 if truth else 1
    kept = min(history, key=lambda epoch: epoch.held_out)
    upper.plot(numbers, [epoch.loss for epoch in history], color=COLORS[0], marker=".")
    upper.set_ylabel("training loss", fontsize=10, color=TEXT)
    lower.plot(numbers, [factor * epoch.held_out for epoch in history], color=COLORS[1], marker=".")
    lower.plot([kept.number], [factor * kept.held_out], "o", color=COLORS[1], markersize=10, fillstyle="none")
    lower.set_ylabel("held-out error × 100" if truth else "held-out loss", fontsize=10, color=TEXT)
    lower.set_xlabel("epoch", fontsize=10, color=TEXT)
    lower.xaxis.get_major_locator().set_params(integer=True)
    for ax in (upper, lower):
        ax.spines[["top", "right"]].set_visible(False)
        ax.grid(True, color="#e4e4e4", linewidth=0.6)
        ax.set_axisbelow(True)
        ax.tick_params(colors=TEXT, labelsize=9)
    return figure
