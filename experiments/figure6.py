"""Figure 6: ours against Nogneng and Ovsjanikov (2017) and Ovsjanikov et al. (2012), 100 and 10 descriptors."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

import style
from intervals import Interval, difference, ratio
from kfmaps.cli.words import UNIT
from kfmaps.config import Config
from methods import (
    converged,
    linear,
    literal,
    no17,
    no17_maxima,
    obcs12,
    obcs12_regularised,
    paper,
    recommended,
)
from options import Setting, by_method
from outputs import Outcome, write_conclusions, write_pictures, write_table
from pair_errors import THRESHOLDS, Row

COUNTS = (100, 10)
OBCS12, REGULARISED, NO17, PRINTED, OURS, RECOMMENDED = style.METHODS

FIFTH = 0.2
"""Ours is to be at most this part of OBCS12: the paper's "significantly better"."""

TENTH = 0.9
"""The recommended settings are to be at most this part of NO17."""


def methods(count: int) -> dict[str, Config]:
    """What the figure compares."""
    return {
        OBCS12: obcs12(count),
        REGULARISED: obcs12_regularised(count),
        NO17: no17(count),
        PRINTED: literal(count),
        OURS: paper(count),
        RECOMMENDED: recommended(count),
    }


CONVERGED, SAME_SCALING, WITHOUT = "ours (paper), converged", "NO17, maxima 1", "recommended, linear kernel"


def variants(count: int) -> dict[str, Config]:
    """What tells the causes apart: the solve, the scaling and the kernel, one changed at a time. Not drawn."""
    return {
        CONVERGED: converged(paper(count)),
        SAME_SCALING: no17_maxima(count),
        WITHOUT: linear(recommended(count)),
    }


def figure6(setting: Setting) -> Outcome:
    """Raw maps over the reported pairs; every difference with a paired bootstrap interval."""
    table, comparisons, lines = [], [], []
    panels: dict[str, dict[str, list[Row]]] = {}
    for collection in setting.collections():
        pairs = collection.reported(setting.pairs, setting.seed)
        together: dict[str, list[Row]] = {}
        for made in (methods, variants):
            # Both numbers of descriptors at once, so that what a pair needs is worked out once.
            every = {f"{name} {count}": config for count in COUNTS for name, config in made(count).items()}
            together |= by_method(setting.rows(collection, pairs, every))
        for count in COUNTS:
            grouped = {name: together[f"{name} {count}"] for name in (*methods(count), *variants(count))}
            shown = {name: grouped[name] for name in methods(count)}
            panels[f"{collection.name}, {count} descriptors, {len(pairs)} pairs"] = shown
            where = {"data": collection.name, "descriptors": count, "pairs": len(pairs)}
            table += [{**where, **summary(name, rows, grouped[NO17])} for name, rows in grouped.items()]
            found = compared(grouped)
            comparisons += [{**where, **comparison.row()} for comparison in found]
            told = "; ".join(comparison.text() for comparison in found)
            lines.append(f"{collection.name}, {count} descriptors, {len(pairs)} pairs: {told}.")
    folder = setting.folder
    return Outcome(
        "figure6",
        (write_table(folder / "figure6.csv", table), write_table(folder / "figure6-comparisons.csv", comparisons)),
        write_pictures(folder, "figure6", draw(panels)),
        write_conclusions(folder, "figure6", setting.collections(), lines),
        tuple(lines),
    )


def summary(name: str, rows: Sequence[Row], other: Sequence[Row]) -> dict[str, object]:
    """A method's line of the table; errors × 100, in units of √area, with the interval of their difference to NO17's.

    ``other``: NO17 on the same pairs.
    """
    means = np.array([row.mean for row in rows])
    apart = difference(100 * means, 100 * np.array([row.mean for row in other]))
    return {
        "method": name,
        f"mean error ({UNIT})": 100 * float(means.mean()),
        f"median of pairs ({UNIT})": 100 * float(np.median(means)),
        f"worst pair ({UNIT})": 100 * float(means.max()),
        "minus NO17": apart.value,
        "low": apart.low,
        "high": apart.high,
        "mean steps": float(np.mean([row.steps for row in rows])),
        "converged pairs": sum(row.status == "converged" for row in rows),
        "mean seconds": float(np.mean([row.seconds for row in rows])),
    }


@dataclass(frozen=True)
class Comparison:
    """One method against another on the same pairs.

    ``claim`` says what should hold of ``interval``, of a difference of mean errors in % of √area or of their ratio;
    ``holds`` whether the measured value does so.
    """

    claim: str
    measured: str
    interval: Interval
    holds: bool

    def row(self) -> dict[str, object]:
        """A line of the table of comparisons."""
        i = self.interval
        return {
            "claim": self.claim,
            "measured": self.measured,
            "value": i.value,
            "low": i.low,
            "high": i.high,
            "holds": self.holds,
        }

    def text(self) -> str:
        """The comparison in words."""
        return (
            f"{self.measured} = {self.interval.text()}, so “{self.claim}” {'holds' if self.holds else 'does not hold'}"
        )


def compared(grouped: Mapping[str, Sequence[Row]]) -> list[Comparison]:
    """The comparisons of one panel."""
    means = {name: 100 * np.array([row.mean for row in rows]) for name, rows in grouped.items()}

    def less(a: str, b: str, claim: str) -> Comparison:
        interval = difference(means[a], means[b])
        return Comparison(claim, f"{a} − {b}", interval, interval.value <= 0)

    def part(a: str, b: str, bound: float, claim: str) -> Comparison:
        interval = ratio(means[a], means[b])
        return Comparison(claim, f"{a} / {b}", interval, interval.value <= bound)

    return [
        less(OURS, NO17, "ours at most NO17"),
        part(OURS, OBCS12, FIFTH, "ours at most a fifth of OBCS12"),
        part(OURS, REGULARISED, FIFTH, "and of OBCS12 with α = 1"),
        less(PRINTED, NO17, "ours with the printed γ at most NO17"),
        part(RECOMMENDED, NO17, TENTH, "recommended at least 10 % better than NO17"),
        less(CONVERGED, NO17, "ours at most NO17 when both are converged"),
        less(CONVERGED, SAME_SCALING, "and when both are scaled alike too"),
        less(RECOMMENDED, WITHOUT, "recommended at most the same without a kernel"),
    ]


def draw(panels: Mapping[str, Mapping[str, Sequence[Row]]]) -> Figure:
    """A panel of error curves for each data set and number of descriptors."""
    figure, axes = style.new_figure(columns=2, rows=(len(panels) + 1) // 2, height=3.0)
    for ax, (title, grouped) in zip(axes, panels.items(), strict=False):
        curves = {}
        for dash, (method, rows) in zip(style.DASHES, grouped.items(), strict=False):
            curves[method] = (np.mean([row.curve for row in rows], axis=0), style.METHODS[method], dash)
        style.error_curves(ax, THRESHOLDS, curves)
        ax.set_title(title, fontsize=10)
    style.legend_below(figure, axes[0], columns=3)
    return figure


if __name__ == "__main__":
    from run import main

    main(["figure6", *sys.argv[1:]])
