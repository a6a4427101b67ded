"""Pictures of maps: a pair in the source's colours with the error, many targets in a grid, numbers on a shape."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy.spatial import KDTree

from kfmaps._arrays import check, check_count, refuse
from kfmaps._records import short_repr
from kfmaps.cli.words import UNIT
from kfmaps.fmap.evaluate import geodesic_errors, truth_from_pairs
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io import check_map
from kfmaps.io.transfer import LOST_GREY, transfer
from kfmaps.matching.result import Match
from kfmaps.viz.camera import View, automatic_view, following_view
from kfmaps.viz.figures import TEXT, NotebookFigure, add_error_bar, error_colors, error_limit, position_colors
from kfmaps.viz.surfaces import draw_surface

_PANEL = 3.4  # width of a panel in inches
_BAR_PANEL = 4.2  # width in inches of a panel with its colour bar
_SMALL = 1.8  # how much larger letters are in pictures that are shown small


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
    """Draw source and target side by side, the source's colours carried over by the map, and the error.

    Parameters
    ----------
    source, target : Mesh
    target_to_source : (n_t,) or Match
        A source vertex for each target vertex; −1 where it has no counterpart, which is grey. Colours are mixed
        inside triangles where a match has points there.
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
    small : bool
        Whether the picture is shown small: with larger letters, and no name below each panel.

    Returns
    -------
    matplotlib.figure.Figure
        To be written with :func:`save_figure`.

    Raises
    ------
    InvalidInput
        When the map or the errors do not have one entry per target vertex, or the map leaves the source.
    """
    sizes = len(source.vertices), len(target.vertices)
    carried = check_map(target_to_source, *sizes, "target_to_source", partial=True)
    colors = position_colors(source) if colors is None else colors
    view_s = automatic_view(source) if view is None else view
    view_t = following_view(view_s, source, target, carried) if target_view is None else target_view
    panels = [
        ("source", source, colors, view_s),
        ("target, coloured by the map", target, transfer(colors, target_to_source, source.faces, LOST_GREY), view_t),
    ]
    width, height = 2 * _PANEL, 4.4 + (0.4 if title else 0)
    wide = _SMALL if small else 1.0
    room = 0.08 if small else 0.42
    shown, end = None, 0.0
    if errors is not None:
        given = np.asarray(errors, dtype=np.float64)
        given = np.where(carried < 0, 0.0, given) if given.shape == carried.shape else given
        shown = check(given, "errors", shape=carried.shape, remedy="give one per target vertex")
        end = error_limit(shown[carried >= 0]) if limit is None else limit
        painted = np.where(carried[:, None] < 0, LOST_GREY, error_colors(np.where(carried < 0, 0.0, shown), end))
        panels.append(("error on the target", target, painted, view_t))
        width += _PANEL + 0.7 * wide

    figure = NotebookFigure(figsize=(width, height), facecolor="white")
    bottom, top = room / height, 1 - (0.45 if title else 0.08) / height
    for i, (label, mesh, painted, seen) in enumerate(panels):
        left, middle = (_PANEL * i + 0.1) / width, _PANEL * (i + 0.5) / width
        draw_surface(figure.add_axes((left, bottom, (_PANEL - 0.2) / width, top - bottom)), mesh, painted, seen)
        if not small:
            figure.text(middle, 0.15 / height, label, ha="center", va="bottom", color=TEXT, fontsize=10)
    if shown is not None:
        place = (1 - 0.8 * wide / width, bottom + 0.15 * (top - bottom), 0.12 / width, 0.7 * (top - bottom))
        beyond = shown[carried >= 0].max(initial=0.0) > end
        add_error_bar(figure, place, end, f"geodesic error ({UNIT})", beyond=bool(beyond), text=10 * wide)
    if title:
        figure.text(0.5, 1 - 0.12 / height, title, ha="center", va="top", color="black", fontsize=12, parse_math=False)
    return figure


def vertex_errors(source: Mesh, maps: Sequence[np.ndarray], truth_s: np.ndarray, truth_t: np.ndarray) -> np.ndarray:
    """Return the geodesic error of each map at each target vertex, (m, n_t), in √area.

    NaN where the truth is not known, or a vertex has no counterpart. ``truth_s (q,)`` and ``truth_t (q,)`` are
    corresponding vertices. Of several truths for one target vertex the last counts.
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

    A vertex whose truth is not known, or that has no counterpart (−1), takes the error of the nearest one that has
    both: right for a picture, not for a mean. On another component the error is the largest of all, and at least 1.
    The arguments are those of :func:`vertex_errors` for the one map ``target_to_source (n_t,)``.
    """
    errors = vertex_errors(source, [np.asarray(target_to_source)], truth_s, truth_t)[0]
    known, unknown = np.flatnonzero(~np.isnan(errors)), np.flatnonzero(np.isnan(errors))
    if len(known) == 0:
        return np.zeros(len(errors))
    endless = np.isinf(errors)
    errors[endless] = max(errors[np.isfinite(errors)].max(initial=0.0), 1.0)
    errors[unknown] = errors[known[KDTree(target.vertices[known]).query(target.vertices[unknown])[1]]]
    return errors


def values_figure(mesh: Mesh, values: Mapping[str, np.ndarray]) -> Figure:
    """Draw a surface in the colours of ``values``, once for each title, with a bar in per cent.

    ``values``: numbers of each vertex, not negative, by title.
    """
    seen = automatic_view(mesh)
    width, height = _BAR_PANEL * len(values), 4.4
    figure = NotebookFigure(figsize=(width, height), facecolor="white")
    for i, (title, given) in enumerate(values.items()):
        each = check(np.asarray(given, dtype=np.float64), title, shape=(len(mesh.vertices),), finite=True)
        limit = error_limit(each)
        left = _BAR_PANEL * i / width
        ax = figure.add_axes((left, 0.1, (_BAR_PANEL - 1.1) / width, 0.88))
        draw_surface(ax, mesh, error_colors(each, limit), seen)
        place = (left + (_BAR_PANEL - 1.0) / width, 0.25, 0.12 / width, 0.55)
        add_error_bar(figure, place, limit, f"{title} (%)", beyond=bool(each.max() > limit))
    return figure


_CELL = 1.9  # width of a panel, in inches
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
        points = check_map(item.target_to_source, *sizes, f"map to {item.label}", partial=True)
        seen = following_view(view, source, item.mesh, points)
        cells.append((item.label, item.mesh, transfer(colors, item.target_to_source, source.faces, LOST_GREY), seen))

    # All shapes at one scale, that of equal areas, in panels that hold the largest.
    sizes = [np.ptp(mesh.vertices @ seen.axes().T, axis=0)[:2] / _scale(mesh) for _, mesh, _, seen in cells]
    half = np.max(sizes, axis=0) / 2 * 1.03
    tall = 0.88 * _CELL * float(np.clip(half[1] / half[0], 0.4, 2.5)) + _LABEL
    if columns is None:
        rows = max(1, round(len(cells) / max(1.0, np.sqrt(1.5 * len(cells) * tall / _CELL))))
        columns = -(-len(cells) // rows)
    columns = min(check_count(columns, "columns"), len(cells))
    rows = -(-len(cells) // columns)
    width, height = columns * _CELL, rows * tall + (_TITLE if title else 0)
    figure = NotebookFigure(figsize=(width, height), facecolor="white")
    for i, (text, mesh, painted, seen) in enumerate(cells):
        left, bottom = i % columns * _CELL / width, (rows - 1 - i // columns) * tall / height
        low, high = bottom + _LABEL / height, (tall - _LABEL) / height
        place = (left + 0.06 * _CELL / width, low, 0.88 * _CELL / width, high)
        ax = figure.add_axes(place)
        draw_surface(ax, mesh, painted, seen)
        middle, reach = np.mean([ax.get_xlim(), ax.get_ylim()], axis=1), half * _scale(mesh)
        ax.set_xlim(middle[0] - reach[0], middle[0] + reach[0])
        ax.set_ylim(middle[1] - reach[1], middle[1] + reach[1])
        centre = left + 0.5 * _CELL / width
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
