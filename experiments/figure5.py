"""Figure 5: error curves over pairs for Gaussian kernels of several widths and for tanh kernels."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

import style
from kfmaps.cli.words import UNIT
from kfmaps.config import Config
from kfmaps.kernels.kernels import Gaussian, Tanh
from methods import literal
from options import Setting, by_method
from outputs import Outcome, write_conclusions, write_pictures, write_table
from pair_errors import THRESHOLDS, Row

GAMMAS = (1.0, 10.0, 50.0, 100.0, 500.0, 2000.0, 10000.0)
SCALES = (1.0, 10.0, 100.0)
SAMPLES = 200


def kernels() -> dict[str, Config]:
    """The paper's settings at rank 200 with each kernel."""
    base = literal(100)
    base = replace(base, nystrom=replace(base.nystrom, samples=SAMPLES))
    found = {f"Gaussian, γ = {gamma:g}": replace(base, kernel=Gaussian(gamma)) for gamma in GAMMAS}
    return found | {f"tanh({scale:g} x·y)": replace(base, kernel=Tanh(scale)) for scale in SCALES}


def figure5(setting: Setting) -> Outcome:
    """Raw maps of 100 × 100 functions, rank 200, 100 descriptors."""
    table, lines, panels = [], [], {}
    for collection in setting.collections():
        pairs = collection.reported(setting.pairs, setting.seed)
        grouped = by_method(setting.rows(collection, pairs, kernels()))
        means = {name: 100 * float(np.mean([row.mean for row in rows])) for name, rows in grouped.items()}
        panels[collection.name] = grouped
        table += [
            {
                "data": collection.name,
                "kernel": name,
                "pairs": len(rows),
                f"mean error ({UNIT})": means[name],
                f"median of pairs ({UNIT})": 100 * float(np.median([row.mean for row in rows])),
                "mean rank": float(np.mean([row.rank for row in rows])),
            }
            for name, rows in grouped.items()
        ]
        lines.append(f"{collection.name}, {len(pairs)} pairs: {conclusion(means)}")
    folder = setting.folder
    return Outcome(
        "figure5",
        (write_table(folder / "figure5.csv", table),),
        write_pictures(folder, "figure5", draw(panels)),
        write_conclusions(folder, "figure5", setting.collections(), lines),
        tuple(lines),
    )


def conclusion(means: Mapping[str, float]) -> str:
    """What the mean errors (× 100, by kernel) say about the best width, and about tanh."""
    gaussian = {gamma: means[f"Gaussian, γ = {gamma:g}"] for gamma in GAMMAS}
    best = min(gaussian, key=lambda gamma: gaussian[gamma])
    tanh = min((name for name in means if name.startswith("tanh")), key=lambda name: means[name])
    largest = (
        "the largest, as in the paper" if best == max(GAMMAS) else "not the largest, so sharper is not always better"
    )
    return (
        f"the best of γ = {', '.join(f'{g:g}' for g in GAMMAS)} is {best:g} (mean error {gaussian[best]:.2f} {UNIT}, "
        f"against {gaussian[min(GAMMAS)]:.2f} at the smallest and "
        f"{gaussian[max(GAMMAS)]:.2f} at the largest): {largest}. "
        f"The best tanh kernel, {tanh}, has {means[tanh]:.2f}."
    )


def draw(panels: Mapping[str, Mapping[str, Sequence[Row]]]) -> Figure:
    """A panel of error curves for each data set."""
    figure, axes = style.new_figure(columns=len(panels))
    for ax, (name, grouped) in zip(axes, panels.items(), strict=True):
        curves = {}
        widths = iter(style.GAMMAS)
        dashes = iter(style.DASHES[1:])
        for method, rows in grouped.items():
            mean = np.mean([row.curve for row in rows], axis=0)
            gaussian = method.startswith("Gaussian")
            look = (next(widths), "solid") if gaussian else (style.GREY, next(dashes))
            curves[method] = (mean, *look)
        style.error_curves(ax, THRESHOLDS, curves)
        ax.set_title(f"{name}, {len(next(iter(grouped.values())))} pairs", fontsize=10)
    style.legend_below(figure, axes[0], columns=4)
    return figure


if __name__ == "__main__":
    from run import main

    main(["figure5", *sys.argv[1:]])
