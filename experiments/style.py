"""The style of all figures: colours that do not depend on colour vision, and one colour for each method."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from kfmaps._texts import UNIT
from kfmaps.viz.figures import percent_ticks

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
"""Colours for kernel widths, from the widest (small γ) to the sharpest."""

SAMPLINGS = {
    "uniform": GREY,
    "geodesic farthest": SKY,
    "descriptor farthest": BLUE,
    "pivoted Cholesky": VERMILION,
    "randomly pivoted Cholesky": ORANGE,
    "randomly pivoted Cholesky, squared": GREEN,
    "spectral bound": BLACK,
}
"""Colour of each method that chooses samples."""

DASHES = ("solid", "dashed", "dotted", "dashdot", (0, (1, 3)), (0, (5, 1, 1, 1, 1, 1)), (0, (3, 1)))
"""Line styles, a second way to tell curves apart."""

TEXT = "#333333"


def new_figure(columns: int = 1, rows: int = 1, width: float = 4.4, height: float = 3.4) -> tuple[Figure, list[Axes]]:
    """Return an empty figure and its axes, row by row; ``width`` and ``height`` are of one panel, in inches."""
    figure = Figure(figsize=(columns * width, rows * height), facecolor="white", layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    for ax in axes:
        ax.spines[["top", "right"]].set_visible(False)
        ax.grid(True, color="#e4e4e4", linewidth=0.6)
        ax.set_axisbelow(True)
        ax.tick_params(colors=TEXT, labelsize=8)
    return figure, axes


def labels(ax: Axes, x: str, y: str, title: str | None = None) -> None:
    """Set the names of the axes and the title."""
    ax.set_xlabel(x, fontsize=9, color=TEXT)
    ax.set_ylabel(y, fontsize=9, color=TEXT)
    if title:
        ax.set_title(title, fontsize=10, color="black")


def legend_below(figure: Figure, ax: Axes, columns: int = 3) -> None:
    """Draw the legend of ``ax`` under all panels."""
    handles, names = ax.get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=columns, fontsize=8, frameon=False)


def error_curves(
    ax: Axes, thresholds: np.ndarray, rows: Mapping[str, Sequence[Any]], looks: Sequence[tuple[str, Any]], title: str
) -> None:
    """Draw the mean ``curve`` of the rows of each name, with the colour and the dashes of ``looks``."""
    for (name, some), (color, dash) in zip(rows.items(), looks, strict=False):
        percent = 100 * np.mean([row.curve for row in some], axis=0)
        ax.plot(thresholds, percent, color=color, linestyle=dash, linewidth=1.6, label=name)
    ax.set_xlim(0, thresholds[-1])
    ax.set_ylim(0, 100)
    ax.xaxis.set_major_formatter(percent_ticks())
    labels(ax, f"geodesic error allowed ({UNIT})", "vertices within it (%)", title)


def row_label(ax: Axes, text: str) -> None:
    """Write the name of a row of panels to the left of its first."""
    ax.text(-0.06, 0.5, text, rotation=90, va="center", ha="right", fontsize=9, transform=ax.transAxes)
