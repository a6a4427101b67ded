"""Whether the confidence of whole shapes holds for kinds of shapes that it was not fitted to.

    python benchmarks/calibration.py ROWS.json [MORE.json ...]

ROWS.json is what ``benchmarks/automatic.py --json`` writes. The score, the margin and the excess of the bending of each
map, as in :func:`kfmaps.matching.score.probability`, are fitted to whether it is right by logistic regression, once for
each kind on all others, and applied to that kind. Few maps are near the border, so that the coefficients are uncertain:
beside the most likely ones stands what 95 % of all likely ones agree to (Laplace's approximation; MacKay 1992, "The
Evidence Framework Applied to Classification Networks"). The confidence that the library gives stands beside both.
"""

from __future__ import annotations

import argparse
import json
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from automatic import RIGHT
from scipy.optimize import minimize

from kfmaps.matching.score import SCORE, excess_deformation, probability

RIDGE = 0.3
"""Weight of the squares of the coefficients, of features with unit variance."""
FLAT = 5e-3
"""The same of the constant, which hardly counts."""
FIVE_PERCENT = 1.645
"""Standard deviations below which 5 % of a normal distribution lie."""
NEARLY_ISOMETRIC = ("FAUST_r", "SHREC19_r", "TOSCA_r", "own")
BINS = (0.0, 0.2, 0.5, 0.8, 0.9, 0.95, 1.0)


def margin(row: dict) -> float:
    scores = row["scores"]
    return scores[0] - scores[1] if len(scores) > 1 else math.inf


def features(row: dict) -> list[float]:
    """Score, the part of the doubt that the margin takes away, and the excess of the bending."""
    bent = row["bending"]
    return [
        row["quality"],
        -math.exp(-max(margin(row), 0.0) / SCORE.calibration.tie),
        0.0 if bent is None else excess_deformation(row["quality"], bent),
    ]


def fitted(x: np.ndarray, right: np.ndarray, new: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Probabilities of ``new (q, f)`` after a logistic regression on ``x (n, f)`` and ``right (n,)`` bool.

    By the most likely coefficients, and such that the coefficients give a lower one with a probability of 5 % only.
    """
    middle, scale = x.mean(axis=0), x.std(axis=0) + 1e-9
    z, there = (np.column_stack([np.ones(len(a)), (a - middle) / scale]) for a in (x, new))
    sign, ridge = np.where(right, 1.0, -1.0), np.array([FLAT, *[RIDGE] * x.shape[1]])

    def loss(a: np.ndarray) -> float:
        return float(np.logaddexp(0.0, -sign * (z @ a)).sum() + ridge @ a**2)

    a = minimize(loss, np.zeros(z.shape[1])).x
    p = 1.0 / (1.0 + np.exp(-z @ a))
    spread = np.linalg.inv((z * (p * (1.0 - p))[:, None]).T @ z + 2.0 * np.diag(ridge))
    log_odds, width = there @ a, np.sqrt(np.einsum("qi,ij,qj->q", there, spread, there))
    most_likely, low = (1.0 / (1.0 + np.exp(-odds)) for odds in (log_odds, log_odds - FIVE_PERCENT * width))
    return most_likely, low


def told(rows: list[dict], middle: float) -> np.ndarray:
    """The probabilities that the library would give with another middle of its logistic function."""
    numbers = replace(SCORE.calibration, middle=middle)
    return np.array([probability(row["quality"], margin(row), row["bending"], numbers=numbers) for row in rows])


def fitted_middle(rows: list[dict], right: np.ndarray) -> tuple[float, float]:
    """The most likely middle, the other numbers as they are, and the highest that 90 % of likely ones agree to."""
    middles = np.arange(-16.0, -8.0, 0.05)
    chances = np.clip([told(rows, middle) for middle in middles], 1e-9, 1 - 1e-9)
    loss = -np.where(right, np.log(chances), np.log(1 - chances)).sum(axis=1)
    return float(middles[loss.argmin()]), float(middles[loss < loss.min() + FIVE_PERCENT**2 / 2].max())


def table(kinds: np.ndarray, right: np.ndarray, p: np.ndarray) -> None:
    print("kind                      maps  right   sure  sure and wrong")
    for kind in (*dict.fromkeys(kinds), "all"):
        here = (kinds == kind) | (kind == "all")
        sure = here & (p >= SCORE.calibration.sure)
        print(f"{kind:24} {here.sum():5} {(here & right).sum():6} {sure.sum():6} {(sure & ~right).sum():6}")
    near = np.isin(kinds, NEARLY_ISOMETRIC) & right
    share = 100 * (p[near] >= SCORE.calibration.sure).mean()
    print(f"of the right maps between nearly isometric shapes {share:.0f} % are sure")
    for low, high in pairwise(BINS):
        here = (p >= low) & ((p < high) | (high == 1.0))
        if here.any():
            mean, share = p[here].mean(), right[here].mean()
            print(f"{low:4.2f} to {high:4.2f}: {here.sum():4} maps, mean {mean:.2f}, right {share:.2f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rows", type=Path, nargs="+")
    rows = [row for path in parser.parse_args().rows for row in json.loads(path.read_text(encoding="utf-8"))]
    rows = [row for row in rows if row.get("quality") is not None and not row["landmarks"]]
    kinds = np.array([row["set"] for row in rows])
    right = np.array([row["error"] < RIGHT for row in rows])
    x = np.array([features(row) for row in rows])
    now = np.array([probability(row["quality"], margin(row), row["bending"]) for row in rows])
    left_out, low = np.zeros(len(rows)), np.zeros(len(rows))
    for kind in dict.fromkeys(kinds):
        here = kinds == kind
        left_out[here], low[here] = fitted(x[~here], right[~here], x[here])
    middles, by_middle = {}, np.zeros(len(rows))
    for kind in dict.fromkeys(kinds):
        others = [row for row, one in zip(rows, kinds, strict=True) if one != kind]
        middles[kind] = fitted_middle(others, right[kinds != kind])[1]
        by_middle[kinds == kind] = told(rows, middles[kind])[kinds == kind]
    print("middle by the other kinds:", ", ".join(f"{kind} {value:.1f}" for kind, value in middles.items()))
    for name, p in (
        ("as it is", now),
        ("the middle alone fitted to the other kinds, the highest that 90 % of likely ones agree to", by_middle),
        ("fitted to the other kinds, by the most likely coefficients", left_out),
        ("fitted to the other kinds, by what 95 % of all likely coefficients agree to", low),
    ):
        print(f"\n{name}")
        table(kinds, right, p)


if __name__ == "__main__":
    main()
