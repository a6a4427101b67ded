"""Formats, colours of positions and errors, and the colour bar of all figures."""

from __future__ import annotations

import io
from pathlib import Path
from typing import IO

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FuncFormatter

from kfmaps._arrays import check, check_positive, refuse
from kfmaps.geometry.mesh import Mesh, vertex_areas
from kfmaps.io.text import check_suffix

_FORMATS = ("png", "svg", "pdf")
_DPI = 160
_NOTEBOOK_DPI = 100
TEXT = "#333333"
_MIDDLE_GREY = "#7b8492"
"""Text that can be read on a white and on a dark page: contrast 3.8 and 4.6."""


class NotebookFigure(Figure):
    """A figure that a notebook shows even where pyplot was never imported."""

    def _repr_png_(self) -> bytes:
        buffer = io.BytesIO()
        self.savefig(buffer, format="png", dpi=_NOTEBOOK_DPI)
        return buffer.getvalue()


def picture_format(path: str | Path) -> str:
    """Return the format that the extension of ``path`` names: png, svg or pdf. Any other is refused."""
    return check_suffix(path, [f".{kind}" for kind in _FORMATS], "picture")[1:]


def save_figure(figure: Figure, file: str | Path | IO[bytes], kind: str | None = None, *, dpi: float = _DPI) -> None:
    """Write ``figure`` as ``kind``: png, svg or pdf; by default the extension of ``file`` decides.

    The same figure gives the same bytes, without a date. An existing file is replaced. ``dpi``: dots per inch of a
    PNG, and of the surfaces inside an SVG or PDF.

    Raises
    ------
    InvalidInput
        For another format, or none where ``file`` has no name.
    """
    if kind is None:
        kind = picture_format(file if isinstance(file, str | Path) else getattr(file, "name", ""))
    elif kind not in _FORMATS:
        raise refuse("picture", f"one of {', '.join(_FORMATS)}", repr(kind), "choose one of them")
    metadata = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}[kind]
    # The salt makes the names inside an SVG the same each time.
    with rc_context({"svg.hashsalt": "kfmaps"}):
        figure.savefig(file, format=kind, dpi=dpi, metadata=metadata)


def make_transparent(figure: Figure) -> Figure:
    """Return ``figure`` with a transparent ground, and its text and axes in a grey for light and dark pages."""
    figure.patch.set_alpha(0)
    for ax in figure.axes:
        ax.patch.set_alpha(0)
        ax.tick_params(color=_MIDDLE_GREY, labelcolor=_MIDDLE_GREY)
        for line in ax.spines.values():
            line.set_edgecolor(_MIDDLE_GREY)
        for line in (*ax.get_xgridlines(), *ax.get_ygridlines()):
            line.set_alpha(0.35)
    for text in figure.findobj(Text):
        text.set_color(_MIDDLE_GREY)
    return figure


def style_axes(ax: Axes) -> None:
    """Give axes of curves a light grid, and lines at the left and bottom only."""
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, color="#e4e4e4", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.tick_params(colors=TEXT, labelsize=9)


def add_error_bar(
    figure: Figure,
    place: tuple[float, float, float, float],
    limit: float,
    label: str,
    *,
    beyond: bool,
    text: float = 10.0,
) -> None:
    """Draw the colour bar of errors from 0 to ``limit`` at ``place`` (left, bottom, width, height of the figure).

    ``beyond``: whether some errors are larger, which gives the bar a pointed end; ``text``: size of the figure's text
    in points, of which the label has nine tenths.
    """
    bar = figure.colorbar(
        ScalarMappable(Normalize(0, limit), ERROR_MAP),
        cax=figure.add_axes(place),
        extend="max" if beyond else "neither",
        format=percent_ticks(),
    )
    bar.set_label(label, color=TEXT, fontsize=0.9 * text)
    bar.ax.tick_params(colors=TEXT, labelsize=0.8 * text)


ERROR_MAP = LinearSegmentedColormap.from_list(
    "kfmaps errors", ["#ffffff", "#fde0c5", "#f7a17a", "#e0503f", "#a5142f", "#560723"]
)
"""White at zero and ever darker above, so that it can be read without colour vision and in grey."""

_LIGHTNESS, _LIGHTNESS_SPAN, _CHROMA = 0.79, 0.10, 0.17
"""OKLab values of the position colours: mean lightness, its variation, and that of a and b."""


def _oklab_to_rgb(lab: np.ndarray) -> np.ndarray:
    """Return sRGB in [0, 1] of OKLab colours (n, 3), clipped where a screen cannot show them (Ottosson 2020)."""
    cones = lab @ np.array(
        [
            [1, 1, 1],
            [0.3963377774, -0.1055613458, -0.0894841775],
            [0.2158037573, -0.0638541728, -1.2914855480],
        ]
    )
    linear = cones**3 @ np.array(
        [
            [4.0767416621, -1.2684380046, -0.0041960863],
            [-3.3077115913, 2.6097574011, -0.7034186147],
            [0.2309699292, -0.3413193965, 1.7076147010],
        ]
    )
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def position_colors(mesh: Mesh) -> np.ndarray:
    """Return colours by the position of each vertex, sRGB in [0, 1], (n, 3).

    Colours run from blue to yellow along the file's axis of the largest extent. The other two axes share green to
    magenta and dark to light, so that left and right and front and back differ (OKLab). Units and the shape's position
    do not matter.
    """
    extent = np.ptp(mesh.vertices, axis=0)
    weights = vertex_areas(mesh) if len(mesh.faces) else np.ones(len(mesh.vertices))
    centred = mesh.vertices - np.average(mesh.vertices, axis=0, weights=weights)
    deviation = np.sqrt(np.average(centred**2, axis=0, weights=weights))
    place = centred / np.where(deviation > 0, deviation, 1)
    # Most of a shape is near its middle, and this function gives the middle most of the colours.
    place = place / np.sqrt(1 + place**2)
    longest, middle, shortest = place[:, np.argsort(-extent, kind="stable")].T
    lightness = _LIGHTNESS + _LIGHTNESS_SPAN / 2 * (longest - middle + shortest)
    return _oklab_to_rgb(np.stack([lightness, _CHROMA * (0.8 * middle + 0.6 * shortest), _CHROMA * longest], axis=1))


def error_limit(errors: np.ndarray) -> float:
    """Return the 99th percentile of ``errors``, rounded up to 1, 2, 3, 4, 6 or 8: the end of their colours."""
    top = float(np.percentile(errors, 99))
    if not top > 0:
        return 0.01
    power = 10.0 ** np.floor(np.log10(top))
    return next(float(step * power) for step in (1, 2, 3, 4, 6, 8, 10) if step * power >= top * (1 - 1e-12))


def percent_ticks() -> FuncFormatter:
    """Return the format that shows errors in √area as per cent."""
    return FuncFormatter(lambda error, _: f"{100 * error:g}")


def error_colors(errors: np.ndarray, limit: float | None = None) -> np.ndarray:
    """Return colours of errors: white at 0, through red, to the darkest at ``limit`` and above, sRGB (n, 3).

    ``errors (n,)``: not negative, in units of √area; ``limit``: in the same units, by default :func:`error_limit`.

    Raises
    ------
    InvalidInput
        When an error is not finite or ``limit`` is not above zero.
    """
    errors = check(np.asarray(errors, dtype=np.float64), "errors", shape=(None,), remedy="give one per vertex")
    limit = check_positive(error_limit(errors) if limit is None else limit, "limit")
    return ERROR_MAP(np.clip(errors / limit, 0, 1))[:, :3]
