"""Figure 6: ours against Nogneng and Ovsjanikov (2017) and Ovsjanikov et al. (2012), 100 and 10 descriptors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import style
from experiment import Options, Result, main
from intervals import difference, ratio
from kfmaps._texts import UNIT
from kfmaps.config import Config
from kfmaps.kernels.kernels import Linear
from methods import converged, literal, no17, no17_maxima, obcs12, obcs12_regularised, paper, recommended
from pair_errors import THRESHOLDS, Row

COUNTS = (100, 10)
OBCS12, REGULARISED, NO17, PRINTED, OURS, RECOMMENDED = style.METHODS
CONVERGED, SAME_SCALING, WITHOUT = "ours (paper), converged", "NO17, maxima 1", "recommended, linear kernel"

CLAIMS = (
    ("ours at most NO17", OURS, NO17, None),
    ("ours at most a fifth of OBCS12", OURS, OBCS12, 0.2),
    ("and of OBCS12 with α = 1", OURS, REGULARISED, 0.2),
    ("ours with the printed γ at most NO17", PRINTED, NO17, None),
    ("recommended at least 10 % better than NO17", RECOMMENDED, NO17, 0.9),
    ("ours at most NO17 when both are converged", CONVERGED, NO17, None),
    ("and when both are scaled alike too", CONVERGED, SAME_SCALING, None),
    ("recommended at most the same without a kernel", RECOMMENDED, WITHOUT, None),
)
"""Claims: the mean error of the first method is at most that of the second, or at most that part of it."""


def methods(count: int) -> dict[str, Config]:
    """Return the settings that the figure compares."""
    configs = (obcs12, obcs12_regularised, no17, literal, paper, recommended)
    return {name: make(count) for name, make in zip(style.METHODS, configs, strict=True)}


def variants(count: int) -> dict[str, Config]:
    """Return settings that tell the causes apart: solver, scaling and kernel, one changed at a time. Not drawn."""
    return {
        CONVERGED: converged(paper(count)),
        SAME_SCALING: no17_maxima(count),
        WITHOUT: replace(recommended(count), kernel=Linear()),
    }


def figure6(options: Options) -> Result:
    """Raw maps over the reported pairs; every difference with a paired bootstrap interval."""
    table, comparisons, lines, panels = [], [], [], {}
    for data_set in options.data_sets():
        pairs = data_set.reported(options.pairs, options.seed)
        rows: dict[str, list[Row]] = {}
        for some in (methods, variants):
            # Both numbers of descriptors at once, so that what a pair needs is computed once.
            every = {f"{name} {count}": config for count in COUNTS for name, config in some(count).items()}
            rows |= options.pair_rows(data_set, pairs, every)
        for count in COUNTS:
            rows_of = {name: rows[f"{name} {count}"] for name in (*methods(count), *variants(count))}
            title = f"{data_set.name}, {count} descriptors, {len(pairs)} pairs"
            panels[title] = {name: rows_of[name] for name in methods(count)}
            where = {"data": data_set.name, "descriptors": count, "pairs": len(pairs)}
            table += [{**where, **summary(name, some, rows_of[NO17])} for name, some in rows_of.items()]
            compared = compare(rows_of)
            comparisons += [{**where, **comparison} for comparison in compared]
            lines.append(f"{title}: {'; '.join(sentence(comparison) for comparison in compared)}.")
    tables = {"figure6": table, "figure6-comparisons": comparisons}
    return Result(tables, {"figure6": draw(panels)}, lines, options.data_sets())


def summary(name: str, rows: Sequence[Row], no17_rows: Sequence[Row]) -> dict[str, Any]:
    """Return a method's line of the table; errors × 100, in units of √area, with their difference to NO17's."""
    means = 100 * np.array([row.mean for row in rows])
    gap = difference(means, 100 * np.array([row.mean for row in no17_rows]))
    return {
        "method": name,
        f"mean error ({UNIT})": float(means.mean()),
        f"median of pairs ({UNIT})": float(np.median(means)),
        f"worst pair ({UNIT})": float(means.max()),
        "minus NO17": gap.value,
        "low": gap.low,
        "high": gap.high,
        "mean steps": float(np.mean([row.steps for row in rows])),
        "converged pairs": sum(row.status == "converged" for row in rows),
        "mean seconds": float(np.mean([row.seconds for row in rows])),
    }


def compare(rows_of: Mapping[str, Sequence[Row]]) -> list[dict[str, Any]]:
    """Return for each of :data:`CLAIMS` the difference (in % of √area) or ratio of mean errors, and if it holds."""
    means = {name: 100 * np.array([row.mean for row in rows]) for name, rows in rows_of.items()}
    lines = []
    for claim, a, b, part in CLAIMS:
        found = difference(means[a], means[b]) if part is None else ratio(means[a], means[b])
        row = {"claim": claim, "measured": f"{a} {'−' if part is None else '/'} {b}", "value": found.value}
        lines.append({**row, "low": found.low, "high": found.high, "holds": found.value <= (part or 0.0)})
    return lines


def sentence(comparison: Mapping[str, Any]) -> str:
    """Return a line of :func:`compare` in words."""
    value, low, high = (f"{comparison[name]:.2f}" for name in ("value", "low", "high"))
    holds = "holds" if comparison["holds"] else "does not hold"
    return f"{comparison['measured']} = {value} [{low}, {high}], so “{comparison['claim']}” {holds}"


def draw(panels: Mapping[str, Mapping[str, Sequence[Row]]]) -> Figure:
    """Draw a panel of error curves for each data set and number of descriptors."""
    figure, axes = style.new_figure(columns=2, rows=(len(panels) + 1) // 2, height=3.0)
    looks = list(zip(style.METHODS.values(), style.DASHES, strict=False))
    for ax, (title, rows_of) in zip(axes, panels.items(), strict=False):
        style.error_curves(ax, THRESHOLDS, rows_of, looks, title)
    style.legend_below(figure, axes[0], columns=3)
    return figure


if __name__ == "__main__":
    main(figure6)
