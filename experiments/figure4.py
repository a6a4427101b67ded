"""Figure 4: one pair with 2, 4, 10 and 100 descriptors, the kernel against Ovsjanikov et al. (2012)."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

import style
from experiment import Options, Result, main
from kfmaps._arrays import KfmapsWarning
from kfmaps._texts import UNIT
from kfmaps.config import Config
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.geometry.mesh import Mesh
from kfmaps.kernels.kernels import Gaussian
from kfmaps.viz import ERROR_MAP, View, automatic_view, draw_surface, following_view, position_colors
from kfmaps.viz.figures import percent_ticks
from methods import literal, obcs12_regularised
from pair_errors import fit_pair, raw_map

COUNTS = (2, 4, 10, 100)
GAMMA = 500.0
COLOR_RANGE = (0.005, 0.2)
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


def settings(count: int, signature_only: bool) -> dict[str, Config]:
    """Return both methods with the same ``count`` descriptors, with or without landmark maps."""
    both = (obcs12_regularised(count), replace(literal(count), kernel=Gaussian(GAMMA)))
    changes = {"energy_sampling": "every-nth", "landmark_descriptor": "none" if signature_only else "wave"}
    return {
        method: replace(config, descriptors=replace(config.descriptors, **changes))
        for method, config in zip(METHODS, both, strict=True)
    }


def figure4(options: Options) -> Result:
    """The map as transferred colours and the error on the target.

    On the generated creature, which is nowhere like its own mirror image, the wave kernel signature alone is
    used, as in the paper; people need landmark maps beside it to tell left from right.
    """
    data_set, pair = options.specimen()
    signature_only = data_set.folder is None
    if signature_only:
        pair = ("poses-2-source", "poses-2-target")
    source, target = (data_set.mesh(name) for name in pair)
    true_s, true_t = data_set.truth(pair)
    panels = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        for count in COUNTS:
            for method, config in settings(count, signature_only).items():
                points = raw_map(fit_pair(data_set, pair, config, data_set.landmarks(pair))[1])
                panels.append(Panel(method, count, points, true_t, geodesic_errors(source, points[true_t], true_s)))
    table = [
        {
            "data": data_set.name,
            "descriptors": p.count,
            "method": p.method,
            f"mean error ({UNIT})": 100 * float(p.errors.mean()),
            f"median error ({UNIT})": 100 * float(np.median(p.errors)),
            "within 0.05 (%)": 100 * float((p.errors <= 0.05).mean()),
        }
        for p in panels
    ]
    truth = np.zeros(len(target.vertices), dtype=np.int64)
    truth[true_t] = true_s
    picture = draw(source, target, truth, panels)
    return Result({"figure4": table}, {"figure4": picture}, conclusions(panels, signature_only), [data_set])


def conclusions(panels: list[Panel], signature_only: bool) -> list[str]:
    """Return what the errors say."""
    without, kernel = ({p.count: 100 * float(p.errors.mean()) for p in panels if p.method == m} for m in METHODS)
    kind = "wave kernel signature alone" if signature_only else "wave kernel signature and landmark maps"
    lines = [
        f"{count} descriptors ({kind}): mean error in {UNIT} {kernel[count]:.2f} with the Gaussian kernel "
        f"(γ = {GAMMA:g}) and {without[count]:.2f} without (OBCS12)."
        for count in COUNTS
    ]
    enough = [
        next((f"{count}" for count in COUNTS if errors[count] <= GOOD), f"more than {COUNTS[-1]}")
        for errors in (kernel, without)
    ]
    few = COUNTS[0]
    lines.append(
        f"With {few} descriptors the kernel's map has {kernel[few] / without[few]:.2f} times the error of OBCS12's. An "
        f"error of at most {GOOD:g} takes {enough[0]} descriptors with the kernel and {enough[1]} without: the paper's "
        f"claim that 2 are already good with the kernel {'holds' if kernel[few] <= GOOD else 'does not hold'} here."
    )
    return lines


def draw(source: Mesh, target: Mesh, truth: np.ndarray, panels: list[Panel]) -> Figure:
    """Draw a row for each method; for each number of descriptors the transferred colours and the error."""
    columns = 1 + 2 * len(COUNTS)
    figure = Figure(figsize=(1.45 * columns, 5.2), facecolor="white", layout="constrained")
    axes = figure.subplots(2, columns)
    colors = position_colors(source)
    view = automatic_view(source)
    view_t = following_view(view, source, target, truth)
    scale = LogNorm(*COLOR_RANGE, clip=True)
    _draw_surface(axes[0, 0], source, colors, view, "source")
    axes[1, 0].axis("off")
    for p in panels:
        row, column = METHODS.index(p.method), 1 + 2 * COUNTS.index(p.count)
        errors = np.full(len(target.vertices), COLOR_RANGE[0])
        errors[p.vertices] = np.maximum(p.errors, COLOR_RANGE[0])
        left, right = axes[row, column], axes[row, column + 1]
        _draw_surface(left, target, colors[p.target_to_source], view_t, f"{p.count} descriptors")
        title = f"error {100 * p.errors.mean():.1f} {UNIT}"
        _draw_surface(right, target, ERROR_MAP(scale(errors))[:, :3], view_t, title)
    for row, name in enumerate(METHODS):
        style.row_label(axes[row, 1], name)
    place = {"ax": axes[1, 0], "location": "left", "fraction": 0.35, "extend": "both"}
    bar = figure.colorbar(ScalarMappable(scale, ERROR_MAP), format=percent_ticks(), **place)
    bar.set_label(f"geodesic error ({UNIT})", fontsize=9, color=style.TEXT)
    return figure


def _draw_surface(ax: Axes, mesh: Mesh, colors: np.ndarray, view: View, title: str) -> None:
    drawn = draw_surface(ax, mesh, colors, view)
    if drawn is not None:
        drawn.set_rasterized(True)  # tens of thousands of triangles would make the PDF unwieldy
    ax.set_title(title, fontsize=9)


if __name__ == "__main__":
    main(figure4)
