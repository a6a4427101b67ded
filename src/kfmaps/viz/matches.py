"""Figures of maps: a pair in the source's colours with the error, a grid of many targets, numbers on a shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy.spatial import KDTree

from kfmaps._arrays import check, check_count, refuse
from kfmaps._records import short_repr
from kfmaps._texts import UNIT
from kfmaps.fmap.evaluate import geodesic_errors, truth_from_pairs
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io import check_map
from kfmaps.io.transfer import LOST_GREY, transfer
from kfmaps.matching.result import Match
from kfmaps.viz.camera import View, automatic_view, following_view
from kfmaps.viz.figures import TEXT, NotebookFigure, add_error_bar, error_colors, error_limit, position_colors
from kfmaps.viz.surfaces import draw_surface

_PANEL = 3.4  # width of a panel in inches
_BAR_PANEL = 4.2  # width of a panel with its colour bar, in inches
_SMALL = 1.8  # factor of the text size in pictures that are shown small


def match_figure(
    source: Mesh,
    target: Mesh,
    target_to_source: np.ndarray | Match,
    *,
    errors: np.ndarray | None = None,
    limit: float | None = None,
    colors: np.ndarray | None = None,
    title: str | None = None,
    view: View | None = None,
    target_view: View | None = None,
    small: bool = False,
) -> Figure:
    """Draw source and target side by side, with the source's colours transferred by the map, and the error.

    Parameters
    ----------
    source, target : Mesh
    target_to_source : (n_t,) or Match
        A source vertex for each target vertex; vertices without a counterpart (−1) are grey. Colours are interpolated
        where a match has points inside triangles.
    errors : (n_t,), optional
        Geodesic errors in units of √area. With them a third panel shows the errors on the target, with a colour bar.
    limit : float, optional
        The error at which the colour bar ends.
    colors : (n_s, 3), optional
        sRGB in [0, 1] on the source; by default :func:`position_colors`.
    title : str, optional
    view : View, optional
        Of the source; by default :func:`automatic_view`.
    target_view : View, optional
        Of the target; by default from the same side as the source.
    small : bool
        Whether the picture is shown small; it then has larger letters and no names below the panels.

    Returns
    -------
    matplotlib.figure.Figure
        :func:`save_figure` writes it.

    Raises
    ------
    InvalidInput
        When the map or the errors do not have one entry per target vertex, or the map leaves the source.
    """
    sizes = len(source.vertices), len(target.vertices)
    points = check_map(target_to_source, *sizes, "target_to_source", partial=True)
    colors = position_colors(source) if colors is None else colors
    view_s = automatic_view(source) if view is None else view
    view_t = following_view(view_s, source, target, points) if target_view is None else target_view
    panels = [
        ("source", source, colors, view_s),
        ("target, coloured by the map", target, transfer(colors, target_to_source, source.faces, LOST_GREY), view_t),
    ]
    width, height = 2 * _PANEL, 4.4 + (0.4 if title else 0)
    enlargement = _SMALL if small else 1.0
    room = 0.08 if small else 0.42
    drawn_errors, end = None, 0.0
    if errors is not None:
        values = np.asarray(errors, dtype=np.float64)
        values = np.where(points < 0, 0.0, values) if values.shape == points.shape else values
        drawn_errors = check(values, "errors", shape=points.shape, remedy="give one per target vertex")
        end = error_limit(drawn_errors[points >= 0]) if limit is None else limit
        painted = np.where(points[:, None] < 0, LOST_GREY, error_colors(np.where(points < 0, 0.0, drawn_errors), end))
        panels.append(("error on the target", target, painted, view_t))
        width += _PANEL + 0.7 * enlargement

    figure = NotebookFigure(figsize=(width, height), facecolor="white")
    bottom, top = room / height, 1 - (0.45 if title else 0.08) / height
    for i, (label, mesh, painted, panel_view) in enumerate(panels):
        left, middle = (_PANEL * i + 0.1) / width, _PANEL * (i + 0.5) / width
        draw_surface(figure.add_axes((left, bottom, (_PANEL - 0.2) / width, top - bottom)), mesh, painted, panel_view)
        if not small:
            figure.text(middle, 0.15 / height, label, ha="center", va="bottom", color=TEXT, fontsize=10)
    if drawn_errors is not None:
        place = (1 - 0.8 * enlargement / width, bottom + 0.15 * (top - bottom), 0.12 / width, 0.7 * (top - bottom))
        beyond = drawn_errors[points >= 0].max(initial=0.0) > end
        add_error_bar(figure, place, end, f"geodesic error ({UNIT})", beyond=bool(beyond), text=10 * enlargement)
    if title:
        figure.text(0.5, 1 - 0.12 / height, title, ha="center", va="top", color="black", fontsize=12, parse_math=False)
    return figure


def vertex_errors(source: Mesh, maps: Sequence[np.ndarray], truth_s: np.ndarray, truth_t: np.ndarray) -> np.ndarray:
    """Return the geodesic error of each map at each target vertex, (m, n_t), in √area.

    NaN where the truth is unknown, or a vertex has no counterpart. ``truth_s (q,)`` and ``truth_t (q,)`` are
    corresponding vertices; the last one counts where a target vertex has several.
    """
    rows = np.full((len(maps), len(maps[0])), np.nan)
    # All at once, so that one search from a true vertex serves every map.
    predicted = np.concatenate([truth_from_pairs(truth_s, truth_t, points) for points in maps])
    errors = geodesic_errors(source, predicted, np.tile(truth_s, len(maps)))
    rows[:, truth_t] = errors.reshape(len(maps), -1)
    return rows


def painted_errors(
    source: Mesh, target: Mesh, target_to_source: np.ndarray, truth_s: np.ndarray, truth_t: np.ndarray
) -> np.ndarray:
    """Return the geodesic error at each target vertex, (n_t,), in √area of the source, without gaps.

    A vertex without a known truth or without a counterpart (−1) takes the error of the nearest vertex that has both.
    That is right for a picture, not for a mean. Infinite errors, on another component, become the largest of all, at
    least 1. The arguments are those of :func:`vertex_errors` for one map ``target_to_source (n_t,)``.
    """
    errors = vertex_errors(source, [np.asarray(target_to_source)], truth_s, truth_t)[0]
    known_rows, unknown_rows = np.flatnonzero(~np.isnan(errors)), np.flatnonzero(np.isnan(errors))
    if len(known_rows) == 0:
        return np.zeros(len(errors))
    is_infinite = np.isinf(errors)
    errors[is_infinite] = max(errors[np.isfinite(errors)].max(initial=0.0), 1.0)
    errors[unknown_rows] = errors[
        known_rows[KDTree(target.vertices[known_rows]).query(target.vertices[unknown_rows])[1]]
    ]
    return errors


def values_figure(mesh: Mesh, values: Mapping[str, np.ndarray]) -> Figure:
    """Draw a surface in the colours of each of ``values`` with a bar: numbers from 0 on at each vertex, by title."""
    view = automatic_view(mesh)
    width, height = _BAR_PANEL * len(values), 4.4
    figure = NotebookFigure(figsize=(width, height), facecolor="white")
    for i, (title, vertex_values) in enumerate(values.items()):
        checked = check(np.asarray(vertex_values, dtype=np.float64), title, shape=(len(mesh.vertices),), finite=True)
        limit = error_limit(checked)
        left = _BAR_PANEL * i / width
        ax = figure.add_axes((left, 0.1, (_BAR_PANEL - 1.1) / width, 0.88))
        draw_surface(ax, mesh, error_colors(checked, limit), view)
        place = (left + (_BAR_PANEL - 1.0) / width, 0.25, 0.12 / width, 0.55)
        add_error_bar(figure, place, limit, f"{title} (%)", beyond=bool(checked.max() > limit))
    return figure


_CELL = 1.9  # width of a panel, in inches
_LABEL, _TITLE = 0.3, 0.45  # heights of a line of labels and of the title, in inches


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
    """Draw the source, with its label in bold, and every target in the source's colours.

    Parameters
    ----------
    source : Mesh
    panels : sequence of Panel
    label : str
        Under the source.
    columns : int, optional
        By default such that the figure is about 1.5 times as wide as high.
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
        extents = len(source.vertices), len(item.mesh.vertices)
        points = check_map(item.target_to_source, *extents, f"map to {item.label}", partial=True)
        panel_view = following_view(view, source, item.mesh, points)
        cells.append(
            (item.label, item.mesh, transfer(colors, item.target_to_source, source.faces, LOST_GREY), panel_view)
        )

    # All shapes are scaled to equal areas, in panels that hold the largest.
    extents = [
        np.ptp(mesh.vertices @ panel_view.axes().T, axis=0)[:2] / _scale(mesh) for _, mesh, _, panel_view in cells
    ]
    half_extent = np.max(extents, axis=0) / 2 * 1.03
    cell_height = 0.88 * _CELL * float(np.clip(half_extent[1] / half_extent[0], 0.4, 2.5)) + _LABEL
    if columns is None:
        rows = max(1, round(len(cells) / max(1.0, np.sqrt(1.5 * len(cells) * cell_height / _CELL))))
        columns = -(-len(cells) // rows)
    columns = min(check_count(columns, "columns"), len(cells))
    rows = -(-len(cells) // columns)
    width, height = columns * _CELL, rows * cell_height + (_TITLE if title else 0)
    figure = NotebookFigure(figsize=(width, height), facecolor="white")
    for i, (text, mesh, painted, panel_view) in enumerate(cells):
        left, bottom = i % columns * _CELL / width, (rows - 1 - i // columns) * cell_height / height
        low, high = bottom + _LABEL / height, (cell_height - _LABEL) / height
        place = (left + 0.06 * _CELL / width, low, 0.88 * _CELL / width, high)
        ax = figure.add_axes(place)
        draw_surface(ax, mesh, painted, panel_view)
        middle, half_size = np.mean([ax.get_xlim(), ax.get_ylim()], axis=1), half_extent * _scale(mesh)
        ax.set_xlim(middle[0] - half_size[0], middle[0] + half_size[0])
        ax.set_ylim(middle[1] - half_size[1], middle[1] + half_size[1])
        centre = left + 0.5 * _CELL / width
        caption = figure.text(centre, bottom + 0.08 / height, text, ha="center", va="bottom", fontsize=8)
        caption.set_parse_math(False)  # a name is a name, not a formula
        caption.set_color(TEXT if i else "black")
        caption.set_fontweight("normal" if i else "bold")
    if title:
        figure.text(0.5, 1 - 0.12 / height, title, ha="center", va="top", fontsize=12, parse_math=False)
    return figure


def _scale(mesh: Mesh) -> float:
    """Return the length by which a shape is scaled: √area, or for a point cloud the longest side of its box."""
    return float(np.sqrt(surface_area(mesh)) if len(mesh.faces) else np.ptp(mesh.vertices, axis=0).max())
