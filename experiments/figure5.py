"""Figure 5: error curves over pairs for Gaussian kernels of several widths and for tanh kernels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

import style
from experiment import Options, Result, main
from kfmaps._texts import UNIT
from kfmaps.config import Config
from kfmaps.kernels.kernels import Gaussian, Tanh
from methods import literal
from pair_errors import THRESHOLDS, Row

GAMMAS = (1.0, 10.0, 50.0, 100.0, 500.0, 2000.0, 10000.0)
SCALES = (1.0, 10.0, 100.0)
SAMPLES = 200


def kernels() -> dict[str, Config]:
    """Return the paper's settings at rank 200 with each kernel."""
    base = literal(100)
    base = replace(base, nystrom=replace(base.nystrom, samples=SAMPLES))
    gaussian = {f"Gaussian, γ = {gamma:g}": replace(base, kernel=Gaussian(gamma)) for gamma in GAMMAS}
    return gaussian | {f"tanh({scale:g} x·y)": replace(base, kernel=Tanh(scale)) for scale in SCALES}


def figure5(options: Options) -> Result:
    """Raw maps of 100 × 100 functions, rank 200, 100 descriptors."""
    table, lines, panels = [], [], {}
    for data_set in options.data_sets():
        pairs = data_set.reported(options.pairs, options.seed)
        rows_of = options.pair_rows(data_set, pairs, kernels())
        means = {name: 100 * float(np.mean([row.mean for row in rows])) for name, rows in rows_of.items()}
        panels[f"{data_set.name}, {len(pairs)} pairs"] = rows_of
        table += [
            {
                "data": data_set.name,
                "kernel": name,
                "pairs": len(rows),
                f"mean error ({UNIT})": means[name],
                f"median of pairs ({UNIT})": 100 * float(np.median([row.mean for row in rows])),
                "mean rank": float(np.mean([row.rank for row in rows])),
            }
            for name, rows in rows_of.items()
        ]
        lines.append(f"{data_set.name}, {len(pairs)} pairs: {conclusion(means)}")
    return Result({"figure5": table}, {"figure5": draw(panels)}, lines, options.data_sets())


def conclusion(means: Mapping[str, float]) -> str:
    """Return what the mean errors (× 100, by kernel) say about the best width, and about tanh."""
    gaussian = {gamma: means[f"Gaussian, γ = {gamma:g}"] for gamma in GAMMAS}
    best = min(gaussian, key=lambda gamma: gaussian[gamma])
    tanh = min((name for name in means if name.startswith("tanh")), key=lambda name: means[name])
    largest = "as in the paper" if best == max(GAMMAS) else "so sharper is not always better"
    return (
        f"the best of γ = {', '.join(f'{g:g}' for g in GAMMAS)} is {best:g} (mean error {gaussian[best]:.2f} {UNIT}, "
        f"against {gaussian[min(GAMMAS)]:.2f} at the smallest and {gaussian[max(GAMMAS)]:.2f} at the largest), "
        f"{largest}. The best tanh kernel, {tanh}, has {means[tanh]:.2f}."
    )


def draw(panels: Mapping[str, Mapping[str, Sequence[Row]]]) -> Figure:
    """Draw a panel of error curves for each data set."""
    figure, axes = style.new_figure(columns=len(panels))
    for ax, (title, rows_of) in zip(axes, panels.items(), strict=True):
        looks = [*((color, "solid") for color in style.GAMMAS), *((style.GREY, dash) for dash in style.DASHES[1:])]
        style.error_curves(ax, THRESHOLDS, rows_of, looks, title)
    style.legend_below(figure, axes[0], columns=4)
    return figure


if __name__ == "__main__":
    main(figure5)
