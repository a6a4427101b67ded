"""Figure 4: one pair with 2, 4, 10 and 100 descriptors, the kernel against Ovsjanikov et al. (2012)."""

from __future__ import annotations

import sys
import warnings
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

import style
from data_sets import Collection, ShapePair
from kfmaps._arrays import KfmapsWarning
from kfmaps.cli.words import UNIT
from kfmaps.config import Config
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.geometry.mesh import Mesh
from kfmaps.kernels.kernels import Gaussian
from kfmaps.viz import ERROR_MAP, View, automatic_view, draw_surface, following_view, position_colors
from kfmaps.viz.colors import percent_ticks
from methods import literal, obcs12_regularised
from options import Setting
from outputs import Outcome, write_conclusions, write_pictures, write_table
from pair_errors import fitted

COUNTS = (2, 4, 10, 100)
GAMMA = 500.0
SHOWN = (0.005, 0.2)
"""Errors between which the colours run from white to red, on a logarithmic scale, in units of √area."""

GOOD = 5.0
"""Mean error × 100 up to which a raw map counts as good: most of it is then right, and refinement can do the rest."""

METHODS = ("OBCS12, α = 1", "ours (γ as printed)")


@dataclass(frozen=True, eq=False)
class Panel:
    """One method at one number of descriptors: its map, and its error at each target vertex that has a truth."""

    method: str
    count: int
    target_to_source: np.ndarray
    vertices: np.ndarray
    errors: np.ndarray


def settings(count: int, alone: bool) -> dict[str, Config]:
    """Both methods, with the same ``count`` descriptors; ``alone``: of the wave kernel signature alone."""
    both = dict(zip(METHODS, (obcs12_regularised(count), replace(literal(count), kernel=Gaussian(GAMMA))), strict=True))
    return {
        name: replace(
            config,
            descriptors=replace(config.descriptors, layout="every-nth", landmark_map="none" if alone else "wave"),
        )
        for name, config in both.items()
    }


def figure4(setting: Setting) -> Outcome:
    """The map as transferred colours and the error on the target.

    On the generated creature, which is like its own mirror image nowhere, the wave kernel signature alone is
    used, as in the paper; people need landmark maps beside it to tell left from right.
    """
    collection, pair = setting.specimen()
    alone = collection.folder is None
    if alone:
        pair = ShapePair("poses-2-source", "poses-2-target")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        panels = [
            panel(collection, pair, name, count, config)
            for count in COUNTS
            for name, config in settings(count, alone).items()
        ]
        source, target = collection.mesh(pair.source), collection.mesh(pair.target)
        truth = collection.truth(pair)
    table = [
        {
            "data": collection.name,
            "descriptors": p.count,
            "method": p.method,
            f"mean error ({UNIT})": 100 * float(p.errors.mean()),
            f"median error ({UNIT})": 100 * float(np.median(p.errors)),
            "within 0.05 (%)": 100 * float((p.errors <= 0.05).mean()),
        }
        for p in panels
    ]
    lines = conclusions(panels, alone)
    folder = setting.folder
    correspondence = np.zeros(len(target.vertices), dtype=np.int64)
    correspondence[truth.target] = truth.source
    figure = draw(source, target, correspondence, panels)
    return Outcome(
        "figure4",
        (write_table(folder / "figure4.csv", table),),
        write_pictures(folder, "figure4", figure),
        write_conclusions(folder, "figure4", [collection], lines),
        tuple(lines),
    )


def panel(collection: Collection, pair: ShapePair, method: str, count: int, config: Config) -> Panel:
    """The raw map and its errors."""
    truth = collection.truth(pair)
    points = fitted(collection, pair, config, truth.landmarks).raw
    errors = geodesic_errors(collection.mesh(pair.source), points[truth.target], truth.source)
    return Panel(method, count, points, truth.target, errors)


def conclusions(panels: list[Panel], alone: bool) -> list[str]:
    """What the errors say."""
    error = {(p.method, p.count): 100 * float(p.errors.mean()) for p in panels}
    kind = "wave kernel signature alone" if alone else "wave kernel signature and landmark maps"
    lines = [
        f"{count} descriptors ({kind}): mean error in {UNIT} {error[METHODS[1], count]:.2f} with the Gaussian kernel "
        f"(γ = {GAMMA:g}) and {error[METHODS[0], count]:.2f} without (OBCS12)."
        for count in COUNTS
    ]
    few, bare = (error[method, COUNTS[0]] for method in (METHODS[1], METHODS[0]))
    enough = {method: next((str(n) for n in COUNTS if error[method, n] <= GOOD), None) for method in METHODS}
    without, kernel = (enough[method] or f"more than {COUNTS[-1]}" for method in METHODS)
    lines.append(
        f"With {COUNTS[0]} descriptors the kernel's map has {few / bare:.2f} times the error of OBCS12's. An error of "
        f"at most {GOOD:g} takes {kernel} descriptors with the kernel and {without} without: the paper's claim that 2 "
        f"are already good with the kernel {'holds here' if few <= GOOD else 'does not hold here'}."
    )
    return lines


def draw(source: Mesh, target: Mesh, correspondence: np.ndarray, panels: list[Panel]) -> Figure:
    """A row for each method; for each number of descriptors the transferred colours and the error."""
    columns = 1 + 2 * len(COUNTS)
    figure = Figure(figsize=(1.45 * columns, 5.2), facecolor="white", layout="constrained")
    axes = figure.subplots(2, columns)
    colors = position_colors(source)
    seen = automatic_view(source)
    seen_t = following_view(seen, source, target, correspondence)
    scale = LogNorm(*SHOWN, clip=True)
    _surface(axes[0, 0], source, colors, seen)
    axes[0, 0].set_title("source", fontsize=9)
    axes[1, 0].axis("off")
    for p in panels:
        row, column = METHODS.index(p.method), 1 + 2 * COUNTS.index(p.count)
        _surface(axes[row, column], target, colors[p.target_to_source], seen_t)
        errors = np.zeros(len(target.vertices))
        errors[p.vertices] = p.errors
        _surface(axes[row, column + 1], target, ERROR_MAP(scale(np.maximum(errors, SHOWN[0])))[:, :3], seen_t)
        axes[row, column].set_title(f"{p.count} descriptors", fontsize=9)
        axes[row, column + 1].set_title(f"error {100 * p.errors.mean():.1f} {UNIT}", fontsize=9)
    for row, name in enumerate(METHODS):
        axes[row, 1].text(
            -0.08, 0.5, name, rotation=90, va="center", ha="right", fontsize=10, transform=axes[row, 1].transAxes
        )
    bar = figure.colorbar(
        ScalarMappable(scale, ERROR_MAP),
        ax=axes[1, 0],
        location="left",
        fraction=0.35,
        extend="both",
        format=percent_ticks(),
    )
    bar.set_label(f"geodesic error ({UNIT})", fontsize=9, color=style.TEXT)
    return figure


def _surface(ax: Axes, mesh: Mesh, colors: np.ndarray, seen: View) -> None:
    drawn = draw_surface(ax, mesh, colors, seen)
    if drawn is not None:
        drawn.set_rasterized(True)  # tens of thousands of triangles would make the PDF unwieldy


if __name__ == "__main__":
    from run import main

    main(["figure4", *sys.argv[1:]])
