"""Error curves: the fraction of points that lie within an error of the truth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter
from numpy.typing import ArrayLike

from kfmaps._arrays import check, refuse
from kfmaps._records import short_repr
from kfmaps._texts import UNIT
from kfmaps.fmap.evaluate import error_curve
from kfmaps.viz.figures import TEXT, NotebookFigure, percent_ticks, style_axes

# Okabe and Ito (2008): distinguishable without colour vision, and with the dashes also in grey.
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#000000", "#56B4E9")
_DASHES = ("solid", "dashed", "dashdot", "dotted")
_N_THRESHOLDS = 251  # points of a curve in :func:`plot_curve`


@dataclass(frozen=True, eq=False)
class Curve:
    """One line of an error figure.

    Attributes
    ----------
    label : str
        Any text.
    thresholds : (t,) float64
        Errors in units of √area, ascending.
    fractions : (t,) float64
        Of points with an error at or below each threshold, from 0 to 1.
    low, high : (t,) float64 or None
        A band around the curve, such as the spread over pairs.
    """

    label: str
    thresholds: np.ndarray
    fractions: np.ndarray
    low: np.ndarray | None = None
    high: np.ndarray | None = None

    __repr__ = short_repr


def mean_curve(label: str, thresholds: np.ndarray, curves: np.ndarray) -> Curve:
    """Return the mean of the ``curves`` (m, t) of single pairs, with a band that holds the middle 80 % of them.

    ``label``: name of the mean; ``thresholds (t,)``: errors of the curves, in √area.
    """
    curves = check(np.asarray(curves, dtype=np.float64), "curves", shape=(None, len(thresholds)))
    if len(curves) == 0:
        raise refuse("curves", "at least one pair", "none", "evaluate a pair whose truth is known")
    low, high = np.percentile(curves, [10, 90], axis=0)
    band = (low, high) if len(curves) > 1 else (None, None)
    return Curve(label, np.asarray(thresholds, dtype=np.float64), curves.mean(axis=0), *band)


def plot_curve(errors: Mapping[str, ArrayLike], *, limit: float = 0.25, title: str | None = None) -> Figure:
    """Plot the fraction of points that lie within an error of the truth, one curve for each map.

    Parameters
    ----------
    errors : mapping of str to (q,) arrays
        Errors by the name of the curve, as :func:`kfmaps.geodesic_errors` returns them. A point without a counterpart
        (NaN) counts as an infinite error.
    limit : float
        Error at which the axis ends, as a fraction of √area.
    title : str, optional

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InvalidInput
        When there is no curve, or one has no errors.

    Examples
    --------
    >>> figure = kfmaps.plot_curve({"ours": [0.0, 0.01, 0.02], "theirs": [0.0, 0.05, 0.2]})
    """
    thresholds = np.linspace(0.0, limit, _N_THRESHOLDS)
    curves = []
    for name, values in errors.items():
        array = np.asarray(values, dtype=np.float64)
        if array.ndim != 1 or len(array) == 0:
            raise refuse(f"errors of {name}", "a list of numbers", f"shape {array.shape}", "give one error a point")
        curves.append(Curve(name, thresholds, error_curve(np.where(np.isnan(array), np.inf, array), thresholds)))
    return curves_figure(curves, title=title)


def curves_figure(curves: Sequence[Curve], *, title: str | None = None, size: tuple[float, float] = (5, 3.9)) -> Figure:
    """Draw error curves in one set of axes, each with its band.

    Parameters
    ----------
    curves : sequence of Curve
    title : str, optional
    size : (float, float)
        Width and height in inches.

    Raises
    ------
    InvalidInput
        When there is no curve.
    """
    if not curves:
        raise refuse("curves", "at least one", "none", "give a run whose truth is known")
    figure = NotebookFigure(figsize=size, facecolor="white", layout="constrained")
    ax = figure.subplots()
    for i, curve in enumerate(curves):
        color, dash = COLORS[i % len(COLORS)], _DASHES[i % len(_DASHES)]
        if curve.low is not None and curve.high is not None:
            ax.fill_between(curve.thresholds, curve.low, curve.high, color=color, alpha=0.15, linewidth=0)
        ax.plot(curve.thresholds, curve.fractions, color=color, linestyle=dash, linewidth=1.8, label=curve.label)
    _axes(ax, max(float(curve.thresholds[-1]) for curve in curves))
    # Below the axes, where it covers neither curve nor band.
    legend = figure.legend(loc="outside lower center", frameon=False, fontsize=9, labelcolor=TEXT)
    for text in legend.get_texts():
        text.set_parse_math(False)  # a name is a name, not a formula
    if title:
        ax.set_title(title, fontsize=11, parse_math=False)
    return figure


def _axes(ax: Axes, end: float) -> None:
    ax.set_xlim(0, end)
    ax.set_ylim(0, 1.005)
    ax.yaxis.set_major_formatter(PercentFormatter(1.0))
    ax.xaxis.set_major_formatter(percent_ticks())
    ax.set_xlabel(f"geodesic error ({UNIT})", fontsize=10, color=TEXT)
    ax.set_ylabel("points within that error", fontsize=10, color=TEXT)
    style_axes(ax)
