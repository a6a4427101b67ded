"""Numbers on one surface, side by side with a colour bar each."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from kfmaps._arrays import check
from kfmaps.geometry.mesh import Mesh
from kfmaps.viz.camera import View, automatic_view
from kfmaps.viz.colors import ERROR_MAP, error_colors, error_limit, percent_ticks
from kfmaps.viz.matches import TEXT
from kfmaps.viz.surfaces import draw_surface

PANEL = 4.2
"""Width in inches, with its colour bar."""


def varied_figure(mesh: Mesh, values: Mapping[str, np.ndarray], view: View | None = None) -> Figure:
    """``values`` of each vertex ``(n,)``, not negative, by title: the surface in their colours, with a bar in per cent.

    Raises
    ------
    InvalidInput
        When there is not one number for each vertex.
    """
    seen = automatic_view(mesh) if view is None else view
    width, height = PANEL * len(values), 4.4
    figure = Figure(figsize=(width, height), facecolor="white")
    for i, (title, given) in enumerate(values.items()):
        each = check(np.asarray(given, dtype=np.float64), title, shape=(len(mesh.vertices),), finite=True)
        limit = error_limit(each)
        left = PANEL * i / width
        ax = figure.add_axes((left, 0.1, (PANEL - 1.1) / width, 0.88))
        draw_surface(ax, mesh, error_colors(each, limit), seen)
        place = (left + (PANEL - 1.0) / width, 0.25, 0.12 / width, 0.55)
        bar = figure.colorbar(
            ScalarMappable(Normalize(0, limit), ERROR_MAP),
            cax=figure.add_axes(place),
            extend="max" if each.max() > limit else "neither",
            format=percent_ticks(),
        )
        bar.set_label(f"{title} (%)", color=TEXT, fontsize=9)
        bar.ax.tick_params(colors=TEXT, labelsize=8)
    return figure
