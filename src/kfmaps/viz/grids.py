"""Many shapes in a grid: one source, and its colours on every target."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from kfmaps._arrays import check_count, refuse
from kfmaps._records import short_repr
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io import check_map
from kfmaps.io.transfer import LOST_GREY, transfer
from kfmaps.matching.result import Match
from kfmaps.viz.camera import View, automatic_view, following_view
from kfmaps.viz.colors import position_colors
from kfmaps.viz.figures import TEXT, NotebookFigure
from kfmaps.viz.surfaces import draw_surface

_PANEL = 1.9  # width of a panel, in inches
_LABEL, _TITLE = 0.3, 0.45  # height of a line of labels and of the title, in inches


@dataclass(frozen=True, eq=False)
class Panel:
    """One target of a grid.

    Attributes
    ----------
    label : str
        Any text.
    mesh : Mesh
    target_to_source : (n_t,) int64 or Match
        A source vertex for each of its vertices.
    """

    label: str
    mesh: Mesh
    target_to_source: np.ndarray | Match

    __repr__ = short_repr


def grid_figure(
    source: Mesh,
    panels: Sequence[Panel],
    *,
    label: str = "source",
    columns: int | None = None,
    colors: np.ndarray | None = None,
    view: View | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the source first, its label in bold, then every target in the source's colours.

    Parameters
    ----------
    source : Mesh
    panels : sequence of Panel
    label : str
        Under the source.
    columns : int, optional
        By default so that the figure is about half as wide again as it is high.
    colors : (n_s, 3), optional
        sRGB in [0, 1] on the source; by default :func:`~kfmaps.viz.position_colors`.
    view : View, optional
        Of the source; by default :func:`~kfmaps.viz.automatic_view`. Targets are seen from the same side.
    title : str, optional

    Raises
    ------
    InvalidInput
        When there is no target, or a map leaves the source or has not one entry per vertex of its target.
    """
    if not panels:
        raise refuse("grid", "at least one target", "none", "choose a source that was matched")
    colors = position_colors(source) if colors is None else np.asarray(colors)
    view = view or automatic_view(source)
    cells = [(label, source, colors, view)]
    for item in panels:
        sizes = len(source.vertices), len(item.mesh.vertices)
        points = check_map(item.target_to_source, *sizes, f"map to {item.label}", lost=True)
        seen = following_view(view, source, item.mesh, points)
        cells.append((item.label, item.mesh, transfer(colors, item.target_to_source, source.faces, LOST_GREY), seen))

    # All shapes at one scale, that of equal areas, in panels that hold the largest.
    sizes = [np.ptp(mesh.vertices @ seen.axes().T, axis=0)[:2] / _scale(mesh) for _, mesh, _, seen in cells]
    half = np.max(sizes, axis=0) / 2 * 1.03
    tall = 0.88 * _PANEL * float(np.clip(half[1] / half[0], 0.4, 2.5)) + _LABEL
    if columns is None:
        rows = max(1, round(len(cells) / max(1.0, np.sqrt(1.5 * len(cells) * tall / _PANEL))))
        columns = -(-len(cells) // rows)
    columns = min(check_count(columns, "columns"), len(cells))
    rows = -(-len(cells) // columns)
    width, height = columns * _PANEL, rows * tall + (_TITLE if title else 0)
    figure = NotebookFigure(figsize=(width, height), facecolor="white")
    for i, (text, mesh, painted, seen) in enumerate(cells):
        left, bottom = i % columns * _PANEL / width, (rows - 1 - i // columns) * tall / height
        low, high = bottom + _LABEL / height, (tall - _LABEL) / height
        place = (left + 0.06 * _PANEL / width, low, 0.88 * _PANEL / width, high)
        ax = figure.add_axes(place)
        draw_surface(ax, mesh, painted, seen)
        middle, reach = np.mean([ax.get_xlim(), ax.get_ylim()], axis=1), half * _scale(mesh)
        ax.set_xlim(middle[0] - reach[0], middle[0] + reach[0])
        ax.set_ylim(middle[1] - reach[1], middle[1] + reach[1])
        centre = left + 0.5 * _PANEL / width
        written = figure.text(centre, bottom + 0.08 / height, text, ha="center", va="bottom", fontsize=8)
        written.set_parse_math(False)  # a name is a name, not a formula
        written.set_color(TEXT if i else "black")
        written.set_fontweight("normal" if i else "bold")
    if title:
        figure.text(0.5, 1 - 0.12 / height, title, ha="center", va="top", fontsize=12, parse_math=False)
    return figure


def _scale(mesh: Mesh) -> float:
    """The length that is alike on all shapes: √area, or of a point cloud the longest side of its box."""
    return float(np.sqrt(surface_area(mesh)) if len(mesh.faces) else np.ptp(mesh.vertices, axis=0).max())
