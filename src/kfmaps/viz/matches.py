"""The picture of a match: both shapes, the source's colours carried over, and the error."""

from __future__ import annotations

from pathlib import Path
from typing import IO

import numpy as np
from matplotlib import rc_context
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from kfmaps._arrays import check, refuse
from kfmaps.cli.words import UNIT
from kfmaps.geometry.mesh import Mesh
from kfmaps.viz.camera import View, automatic_view, following_view
from kfmaps.viz.colors import ERROR_MAP, error_colors, error_limit, percent_ticks, position_colors
from kfmaps.viz.surfaces import draw_surface

FORMATS = ("png", "svg", "pdf")
DPI = 160
TEXT = "#333333"
LOST = 0.75
"""Grey of target vertices without a counterpart."""
PANEL = 3.4
"""Width of a panel in inches."""
EACH = "give one per target vertex"


def picture_format(path: str | Path) -> str:
    """The format that a file's extension names: png, svg or pdf.

    Raises
    ------
    InvalidInput
        For any other extension.
    """
    kind = Path(path).suffix.lower().removeprefix(".")
    if kind not in FORMATS:
        got = f"'.{kind}'" if kind else "no extension"
        raise refuse(f"picture {path}", "a name ending in .png, .svg or .pdf", got, "rename it")
    return kind


def save_figure(figure: Figure, file: str | Path | IO[bytes], kind: str | None = None, *, dpi: float = DPI) -> None:
    """Write ``figure`` as ``kind`` (png, svg or pdf; by default what the name of ``file`` says).

    The same figure gives the same bytes: no date goes in. An existing file is replaced.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    file : path or binary file
    kind : str, optional
    dpi : float
        Dots per inch of a PNG, and of the surfaces inside an SVG or PDF.

    Raises
    ------
    InvalidInput
        For another format, or none where ``file`` has no name.
    """
    if kind is None:
        kind = picture_format(file if isinstance(file, str | Path) else getattr(file, "name", ""))
    elif kind not in FORMATS:
        raise refuse("picture", f"one of {', '.join(FORMATS)}", repr(kind), "choose one of them")
    metadata = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[kind]
    # The salt makes the names inside an SVG the same each time.
    with rc_context({"svg.hashsalt": "kfmaps"}):
        figure.savefig(file, format=kind, dpi=dpi, metadata=metadata)


def _map_between(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """The map when it has a source vertex, or −1, for each target vertex."""
    carried = np.asarray(target_to_source)
    if not np.issubdtype(carried.dtype, np.integer):
        raise refuse("target_to_source", "whole numbers", f"dtype {carried.dtype}", "give vertex numbers")
    check(carried, "target_to_source", shape=(len(target.vertices),), remedy=EACH)
    outside = carried[(carried < -1) | (carried >= len(source.vertices))]
    if len(outside):
        wanted = f"vertex numbers from 0 to {len(source.vertices) - 1}"
        raise refuse("target_to_source", wanted, str(outside[0]), "check which mesh is the source")
    return carried


def carried_colors(colors: np.ndarray, target_to_source: np.ndarray) -> np.ndarray:
    """The source's ``colors (n_s, 3)`` at the target's vertices (n_t, 3), grey where there is no counterpart."""
    return np.where(target_to_source[:, None] < 0, LOST, np.asarray(colors)[target_to_source])


def match_figure(
    source: Mesh,
    target: Mesh,
    target_to_source: np.ndarray,
    *,
    errors: np.ndarray | None = None,
    limit: float | None = None,
    colors: np.ndarray | None = None,
    title: str | None = None,
    view: View | None = None,
    target_view: View | None = None,
    text: float = 10.0,
) -> Figure:
    """Source and target side by side, the source's colours carried over by the map, and the error.

    Parameters
    ----------
    source, target : Mesh
    target_to_source : (n_t,)
        A source vertex for each target vertex; −1 where it has no counterpart, which is grey.
    errors : (n_t,), optional
        Geodesic errors in units of √area; given, a third panel shows them on the target with a colour bar.
    limit : float, optional
        The error at which the colour bar ends.
    colors : (n_s, 3), optional
        sRGB in [0, 1] on the source; by default :func:`position_colors`.
    title : str, optional
    view : View, optional
        Of the source; by default :func:`automatic_view`.
    target_view : View, optional
        Of the target; by default from the same side as the source, as far as the map tells.
    text : float
        Size of letters in points; larger for pictures that are shown small.

    Returns
    -------
    matplotlib.figure.Figure
        To be written with :func:`save_figure`.

    Raises
    ------
    InvalidInput
        When the map or the errors do not have one entry per target vertex, or the map leaves the source.
    """
    carried = _map_between(source, target, target_to_source)
    colors = position_colors(source) if colors is None else colors
    view_s = automatic_view(source) if view is None else view
    view_t = following_view(view_s, source, target, carried) if target_view is None else target_view
    panels = [
        ("source", source, colors, view_s),
        ("target, coloured by the map", target, carried_colors(colors, carried), view_t),
    ]
    width, height = 2 * PANEL, 4.4 + (0.4 if title else 0)
    wide = max(text / 10, 1.0)
    room = 0.42 * wide
    shown, end = None, 0.0
    if errors is not None:
        given = np.asarray(errors, dtype=np.float64)
        given = np.where(carried < 0, 0.0, given) if given.shape == carried.shape else given
        shown = check(given, "errors", shape=carried.shape, remedy=EACH)
        end = error_limit(shown[carried >= 0]) if limit is None else limit
        painted = np.where(carried[:, None] < 0, LOST, error_colors(np.where(carried < 0, 0.0, shown), end))
        panels.append(("error on the target", target, painted, view_t))
        width += PANEL + 0.7 * wide

    figure = Figure(figsize=(width, height), facecolor="white")
    bottom, top = room / height, 1 - (0.45 if title else 0.08) / height
    for i, (label, mesh, painted, seen) in enumerate(panels):
        left, middle = (PANEL * i + 0.1) / width, PANEL * (i + 0.5) / width
        draw_surface(figure.add_axes((left, bottom, (PANEL - 0.2) / width, top - bottom)), mesh, painted, seen)
        figure.text(middle, 0.15 / height, label, ha="center", va="bottom", color=TEXT, fontsize=text)
    if shown is not None:
        place = (
            1 - 0.8 * wide / width,
            bottom + 0.15 * (top - bottom),
            0.12 / width,
            0.7 * (top - bottom),
        )
        scale = ScalarMappable(Normalize(0, end), ERROR_MAP)
        over = "max" if shown[carried >= 0].max(initial=0.0) > end else "neither"
        bar = figure.colorbar(scale, cax=figure.add_axes(place), extend=over, format=percent_ticks())
        bar.set_label(f"geodesic error ({UNIT})", color=TEXT, fontsize=0.9 * text)
        bar.ax.tick_params(colors=TEXT, labelsize=0.8 * text)
    if title:
        figure.text(0.5, 1 - 0.12 / height, title, ha="center", va="top", color="black", fontsize=12)
    return figure
