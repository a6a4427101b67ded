"""The picture of docs/parts.md: a part, its whole in the part's colours, and how likely each place is to be on both.

    python benchmarks/parts_picture.py docs/images/parts.png [--map MAP.npz]

The pair is ``kfmaps.datasets.partial()``, of which nothing is told. MAP is where the match is kept, or read from.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

import kfmaps
from kfmaps import datasets
from kfmaps.fmap.precise import nearest_vertices
from kfmaps.io import load_map, save_map
from kfmaps.io.transfer import LOST_GREY, find_counterparts, transfer
from kfmaps.viz import automatic_view, position_colors, save_figure
from kfmaps.viz.camera import following_view
from kfmaps.viz.surfaces import draw_surface


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", type=Path)
    parser.add_argument("--map", type=Path)
    arguments = parser.parse_args()
    pair = datasets.partial()
    whole, part = pair.source, pair.target
    if arguments.map is not None and arguments.map.exists():
        found = load_map(arguments.map)
    else:
        found = kfmaps.match(whole, part)
        if arguments.map is not None:
            save_map(arguments.map, found)
    ways = find_counterparts(found, whole, part)
    back = np.where(ways.source, nearest_vertices(ways.back, part), -1)
    seen = automatic_view(whole)
    colors = position_colors(part)
    overlap = found.partial.overlap_source
    assert overlap is not None, "the map is none of a part"
    panels = (
        ("the part", part, colors, following_view(seen, whole, part, found.target_to_source)),
        ("the whole in the part's colours", whole, transfer(colors, back, lost=LOST_GREY), seen),
        ("probability to be on both", whole, matplotlib.colormaps["viridis"](overlap)[:, :3], seen),
    )
    figure = Figure(figsize=(9.6, 4.4), facecolor="white")
    for i, (label, mesh, painted, view) in enumerate(panels):
        axes = figure.add_axes((0.01 + 0.31 * i, 0.1, 0.3, 0.88))
        draw_surface(axes, mesh, painted, view)
        figure.text(0.16 + 0.31 * i, 0.03, label, ha="center", fontsize=10)
    bar = figure.add_axes((0.945, 0.2, 0.012, 0.6))
    figure.colorbar(ScalarMappable(cmap="viridis"), cax=bar)
    save_figure(figure, arguments.output)


if __name__ == "__main__":
    main()
