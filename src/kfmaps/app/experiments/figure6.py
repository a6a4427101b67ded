"""Figure 6: ours against Nogneng and Ovsjanikov (2017) and Ovsjanikov et al. (2012), 100 and 10 descriptors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure

from kfmaps.app.experiments import style
from kfmaps.app.experiments.methods import no17, obcs12, paper, recommended
from kfmaps.app.experiments.outputs import Outcome, write_conclusions, write_pictures, write_table
from kfmaps.app.experiments.pairs import THRESHOLDS, Row
from kfmaps.app.experiments.setting import Setting, by_method
from kfmaps.app.experiments.statistics import Interval, difference, ratio
from kfmaps.config import Config

COUNTS = (100, 10)
OURS, CONVERGED, RECOMMENDED = "ours (paper)", "ours (converged)", "ours (recommended)"
NO17, OBCS12 = "NO17", "OBCS12"

FIFTH = 0.2
"""Ours is to be at most this part of OBCS12: the paper's "significantly better"."""

TENTH = 0.9
"""The recommended settings are to be at most this part of NO17."""


def methods(count: int) -> dict[str, Config]:
    """What the figure compares."""
    ours = paper(count)
    converged = no17(count)
    return {
        OBCS12: obcs12(count),
        NO17: no17(count),
        OURS: ours,
        CONVERGED: replace(ours, solver=converged.solver, preconditioner=converged.preconditioner),
        RECOMMENDED: recommended(count),
    }


def figure6(setting: Setting) -> Outcome:
    """Raw maps over the reported pairs; every difference with a paired bootstrap interval."""
    table, comparisons, lines = [], [], []
    panels: dict[str, dict[str, list[Row]]] = {}
    for collection in setting.collections():
        pairs = collection.reported(setting.pairs, setting.seed)
        for count in COUNTS:
            grouped = by_method(setting.rows(collection, pairs, methods(count)))
            panels[f"{collection.name}, {count} descriptors, {len(pairs)} pairs"] = grouped
            where = {"data": collection.name, "descriptors": count, "pairs": len(pairs)}
            table += [{**where, **summary(name, rows)} for name, rows in grouped.items()]
            found = compared(grouped)
            comparisons += [{**where, **row} for row in found.rows()]
            lines.append(f"{collection.name}, {count} descriptors, {len(pairs)} pairs: {found.text()}")
    folder = setting.folder
    return Outcome(
        "figure6",
        (write_table(folder / "figure6.csv", table), write_table(folder / "figure6-comparisons.csv", comparisons)),
        write_pictures(folder, "figure6", draw(panels)),
        write_conclusions(folder, "figure6", setting.collections(), lines),
        tuple(lines),
    )


def summary(name: str, rows: Sequence[Row]) -> dict[str, object]:
    """A method's line of the table; errors × 100, in units of √area."""
    means = np.array([row.mean for row in rows])
    return {
        "method": name,
        "mean error × 100": 100 * float(means.mean()),
        "median of pairs × 100": 100 * float(np.median(means)),
        "worst pair × 100": 100 * float(means.max()),
        "mean steps": float(np.mean([row.steps for row in rows])),
        "converged pairs": sum(row.status == "converged" for row in rows),
        "mean seconds": float(np.mean([row.seconds for row in rows])),
    }


@dataclass(frozen=True)
class Comparison:
    """Differences in units of 100 · √area, and ratios of mean errors, each with its interval."""

    ours_less_no17: Interval
    ours_to_obcs12: Interval
    recommended_to_no17: Interval

    def claims(self) -> dict[str, tuple[str, Interval, bool]]:
        """What is claimed: how it is measured, the measurement, and whether it holds."""
        return {
            "ours at most NO17": ("ours (paper) − NO17", self.ours_less_no17, self.ours_less_no17.value <= 0),
            "ours at most a fifth of OBCS12": (
                "ours (paper) / OBCS12",
                self.ours_to_obcs12,
                self.ours_to_obcs12.value <= FIFTH,
            ),
            "recommended at least 10 % better than NO17": (
                "ours (recommended) / NO17",
                self.recommended_to_no17,
                self.recommended_to_no17.value <= TENTH,
            ),
        }

    def rows(self) -> list[dict[str, object]]:
        """Lines of the table of comparisons."""
        return [
            {"claim": claim, "measured": what, "value": i.value, "low": i.low, "high": i.high, "holds": holds}
            for claim, (what, i, holds) in self.claims().items()
        ]

    def text(self) -> str:
        """All claims in one sentence."""
        return "; ".join(
            f"{what} is {interval.text()}: {claim} {'holds' if holds else 'does not hold'}"
            for claim, (what, interval, holds) in self.claims().items()
        )


def compared(grouped: Mapping[str, Sequence[Row]]) -> Comparison:
    """The comparisons of one panel."""
    means = {name: np.array([row.mean for row in rows]) for name, rows in grouped.items()}
    return Comparison(
        difference(100 * means[OURS], 100 * means[NO17]),
        ratio(means[OURS], means[OBCS12]),
        ratio(means[RECOMMENDED], means[NO17]),
    )


def draw(panels: Mapping[str, Mapping[str, Sequence[Row]]]) -> Figure:
    """A panel of error curves for each data set and number of descriptors."""
    figure, axes = style.new_figure(columns=2, rows=(len(panels) + 1) // 2, height=3.0)
    for ax, (title, grouped) in zip(axes, panels.items(), strict=False):
        curves = {}
        for dash, (method, rows) in zip(style.DASHES, grouped.items(), strict=False):
            curves[method] = (np.mean([row.curve for row in rows], axis=0), style.METHODS[method], dash)
        style.error_curves(ax, THRESHOLDS, curves)
        ax.set_title(title, fontsize=10)
    style.legend_below(figure, axes[0], columns=5)
    return figure
