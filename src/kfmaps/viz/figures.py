"""What all figures share: formats, the colour bar of errors, and colours carried over a map."""

from __future__ import annotations

import io
from pathlib import Path
from typing import IO

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.text import Text

from kfmaps._arrays import refuse
from kfmaps.io.text import check_suffix
from kfmaps.viz.colors import ERROR_MAP, percent_ticks

_FORMATS = ("png", "svg", "pdf")
_DPI = 160
_NOTEBOOK_DPI = 100
TEXT = "#333333"
_MIDDLE_GREY = "#7b8492"
"""Text that can be read on a white and on a dark page: contrast 3.8 and 4.6."""


class NotebookFigure(Figure):
    """A figure that a notebook shows by itself, also where pyplot was never imported."""

    def _repr_png_(self) -> bytes:
        buffer = io.BytesIO()
        self.savefig(buffer, format="png", dpi=_NOTEBOOK_DPI)
        return buffer.getvalue()


def picture_format(path: str | Path) -> str:
    """Return the format that the extension of ``path`` names: png, svg or pdf. Any other is refused."""
    return check_suffix(path, [f".{kind}" for kind in _FORMATS], "picture")[1:]


def save_figure(figure: Figure, file: str | Path | IO[bytes], kind: str | None = None, *, dpi: float = _DPI) -> None:
    """Write ``figure`` as ``kind`` (png, svg or pdf; by default what the name of ``file`` says).

    The same figure gives the same bytes: no date goes in. An existing file is replaced. ``dpi``: dots per inch of a
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
    """Return ``figure`` without its white ground, its text and axes in a grey that light and dark pages allow."""
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
    """Give axes of curves a light grid and two sides."""
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

    Its end is pointed where some errors lie ``beyond``; ``text`` is the size of the label in points, and a ninth more.
    """
    bar = figure.colorbar(
        ScalarMappable(Normalize(0, limit), ERROR_MAP),
        cax=figure.add_axes(place),
        extend="max" if beyond else "neither",
        format=percent_ticks(),
    )
    bar.set_label(label, color=TEXT, fontsize=0.9 * text)
    bar.ax.tick_params(colors=TEXT, labelsize=0.8 * text)
