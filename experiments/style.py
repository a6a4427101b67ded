"""One look for all figures: colours that do not depend on colour vision, and the same colour for the same thing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from kfmaps.cli.words import UNIT
from kfmaps.viz.colors import percent_ticks

# Okabe and Ito (2008).
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
GREY = "#777777"

METHODS = {
    "OBCS12": PURPLE,
    "OBCS12, α = 1": PURPLE,
    "NO17": ORANGE,
    "ours (γ as printed)": VERMILION,
    "ours (paper)": BLUE,
    "ours (recommended)": GREEN,
}
"""Colour of each method, in every figure; variants of one method share it."""

GAMMAS = (BLACK, BLUE, SKY, GREEN, ORANGE, VERMILION, PURPLE)
"""For kernel widths, from the widest (small γ) to the sharpest."""

SAMPLINGS = {
    "uniform": GREY,
    "geodesic farthest": SKY,
    "descriptor farthest": BLUE,
    "pivoted Cholesky": VERMILION,
    "randomly pivoted Cholesky": ORANGE,
    "randomly pivoted Cholesky, squared": GREEN,
    "spectral bound": BLACK,
}
"""Colour of each way to choose samples."""

DASHES = ("solid", "dashed", "dotted", "dashdot", (0, (1, 3)), (0, (5, 1, 1, 1, 1, 1)), (0, (3, 1)))
"""Line styles, a second way to tell curves apart."""

TEXT = "#333333"


def new_figure(columns: int = 1, rows: int = 1, width: float = 4.4, height: float = 3.4) -> tuple[Figure, list[Axes]]:
    """An empty figure and its axes, row by row; ``width`` and ``height`` are of one panel, in inches."""
    figure = Figure(figsize=(columns * width, rows * height), facecolor="white", layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    for ax in axes:
        plain(ax)
    return figure, axes


def plain(ax: Axes) -> None:
    """No box, a light grid behind the data."""
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, color="#e4e4e4", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.tick_params(colors=TEXT, labelsize=8)


def labels(ax: Axes, x: str, y: str, title: str | None = None) -> None:
    """Axis names, with units, and a title."""
    ax.set_xlabel(x, fontsize=9, color=TEXT)
    ax.set_ylabel(y, fontsize=9, color=TEXT)
    if title:
        ax.set_title(title, fontsize=10, color="black")


def legend_below(figure: Figure, ax: Axes, columns: int = 3) -> None:
    """One legend under all panels, where it covers no data; entries are those of ``ax``."""
    handles, names = ax.get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=columns, fontsize=8, frameon=False)


def error_curves(
    ax: Axes, thresholds: np.ndarray, curves: dict[str, tuple[np.ndarray | Sequence[float], str, Any]]
) -> None:
    """Curves ``name: (fractions, colour, dash)`` of correct points against the error allowed."""
    for name, (fractions, color, dash) in curves.items():
        percent = [100 * f for f in fractions]
        ax.plot(thresholds, percent, color=color, linestyle=dash, linewidth=1.6, label=name)
    ax.set_xlim(0, thresholds[-1])
    ax.set_ylim(0, 100)
    ax.xaxis.set_major_formatter(percent_ticks())
    labels(ax, f"geodesic error allowed ({UNIT})", "vertices within it (%)")
