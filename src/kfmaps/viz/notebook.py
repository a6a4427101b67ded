"""A map in a notebook's cell: its picture, or an isolated frame that holds its whole page."""

from __future__ import annotations

import io
from html import escape

from matplotlib.figure import Figure
from rich.console import Console

from kfmaps.viz.document import data_address
from kfmaps.viz.figures import make_transparent

_DPI = 72  # resolution of a picture
_CELL = """<style>
.kfmaps-cell {{ width: 100%; height: 600px; border: 0; color-scheme: light dark; }}
{light} {{ color-scheme: light; }}
{dark} {{ color-scheme: dark; }}
</style>
<iframe class="kfmaps-cell" title="{title}" sandbox="allow-scripts allow-downloads" srcdoc="{page}"></iframe>"""
_LIGHT = ('[data-jp-theme-light="true"]', ".vscode-light", '[theme="light"]')
_DARK = ('[data-jp-theme-light="false"]', ".vscode-dark", '[theme="dark"]')
"""How JupyterLab, Visual Studio Code and Colab mark a notebook that is light or dark; elsewhere the system decides."""


def figure_html(figure: Figure, words: str) -> str:
    """Return a figure as an image that a light and a dark notebook can show; ``words`` say what it is."""
    buffer = io.BytesIO()
    make_transparent(figure).savefig(buffer, format="png", dpi=_DPI)
    return f'<img alt="{escape(words)}" src="{data_address("image/png", buffer.getvalue())}">'


def in_notebook() -> bool:
    """Return whether this runs in a notebook that shows HTML."""
    return Console().is_jupyter


def cell_html(page: str, title: str) -> str:
    """Return a page of :mod:`kfmaps.viz.page` as the HTML of a cell: a frame, with the layout for little room."""
    light, dark = (", ".join(f"{mark} .kfmaps-cell" for mark in marks) for marks in (_LIGHT, _DARK))
    page = page.replace("<body>", '<body class="cell">', 1)
    return _CELL.format(light=light, dark=dark, title=escape(title), page=escape(page))


def show_in_cell(page: str, title: str) -> None:
    """Show a page in the cell that is being run."""
    from IPython.display import HTML, display  # pyright: ignore[reportMissingImports]

    display(HTML(cell_html(page, title)))
