"""The kernel in every formulation: errors with and without it, wrong landmarks, both directions, transferred functions.

On people 4 to 7 of FAUST_r and the animals of TOSCA_r; settings were chosen on people 0 to 3. Without data, on shapes
that the package generates.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import formulation_pairs
import style
from data_sets import DataSet, find_data_sets
from experiment import Options, Result, main
from formulation_pairs import KERNELS, LOSSES, PLAIN, Rows
from intervals import difference

COUNTS = (10, 100)
"""Numbers of descriptors."""

N_PAIRS = {"FAUST_r": 40, "TOSCA_r": 20, "generated": 8}
"""Number of pairs of each data set, unless ``--pairs`` is smaller than the first."""

PEOPLE = (4, 5, 6, 7)


def formulations(options: Options) -> Result:
    """Every formulation with a linear and with the default kernel, and what each is good for."""
    formulations = formulation_pairs.FORMULATIONS
    main_rows = measure(options, formulation_pairs.compare_formulations, 1.0, COUNTS, formulations)
    directions = measure(options, formulation_pairs.compare_directions, 0.5, COUNTS)
    losses = measure(options, formulation_pairs.compare_losses, 0.5, (100,), LOSSES)
    transfers = measure(options, formulation_pairs.compare_transfer, 0.25, (100,))
    names = ("maps", "stage", "kernel", "descriptors")
    tables = {
        "formulations": compared_table(main_rows, list(formulations)),
        "formulations-directions": means_table(directions, names, ("error", "cycle", "coverage")),
        "formulations-landmarks": means_table(losses, ("loss", "kernel", "wrong"), ("raw", "refined")),
        "formulations-functions": means_table(transfers, ("map", "function", "products"), ("error",)),
    }
    lines = [*kernel_lines(main_rows, list(formulations)), *formulation_lines(main_rows, list(formulations))]
    lines += [*direction_lines(directions), *loss_lines(losses), *transfer_lines(transfers)]
    return Result(tables, {"formulations": draw(main_rows, losses)}, lines, data_sets(options))


def data_sets(options: Options) -> list[DataSet]:
    """Return the data sets in the data folder, or the generated one."""
    return find_data_sets(options.data, options.vertices, ("FAUST_r", "TOSCA_r"))


def measure(
    options: Options, function: Callable[..., Rows], share: float, counts: Sequence[int], *arguments: Any
) -> dict[str, Rows]:
    """Return the rows of ``function`` on a ``share`` of the pairs by data set, each with its ``pair``."""
    jobs = {}
    for data_set in data_sets(options):
        count = max(1, round(share * N_PAIRS[data_set.name] * min(1.0, options.pairs / N_PAIRS["FAUST_r"])))
        # Pairs of one source next to each other: a worker keeps the shapes that it has prepared.
        for pair in sorted(data_set.reported(count, options.seed, PEOPLE)):
            for n in counts:
                config = formulation_pairs.CONFIG
                config = replace(config, descriptors=replace(config.descriptors, n_spectral=n))
                jobs[data_set.name, " ".join(pair), n] = (data_set, pair, config, *arguments)
    rows: dict[str, Rows] = {}
    for (name, pair, _), values in options.map(function, jobs).items():
        rows.setdefault(name, []).extend({"pair": pair, **row} for row in values)
    return rows


def column(rows: Rows, value: str, **where: Any) -> np.ndarray:
    """Return ``value`` × 100 of the rows that agree with ``where``, in the order of the pairs."""
    chosen = [row for row in rows if all(row[name] == wanted for name, wanted in where.items())]
    return 100 * np.array([row[value] for row in sorted(chosen, key=lambda row: row["pair"])])


def errors(rows: Rows, stage: str, formulation: str, kernel: str, count: int) -> np.ndarray:
    """Return the errors × 100 of one formulation with one kernel at one number of descriptors."""
    return column(rows, stage, formulation=formulation, kernel=kernel, descriptors=count)


def compared_table(data: dict[str, Rows], names: Sequence[str]) -> Rows:
    """Return mean errors × 100, their difference to least squares and that of the kernel to none, with intervals."""
    table = []
    for (data_set, rows), count, name, kernel in product(data.items(), COUNTS, names, KERNELS):
        raw, refined = (errors(rows, stage, name, kernel, count) for stage in ("raw", "refined"))
        row: dict[str, Any] = {"data": data_set, "descriptors": count, "formulation": name, "kernel": kernel}
        row["pairs"] = len(raw)
        for stage, own in (("raw", raw), ("refined", refined)):
            row[stage] = float(own.mean())
            row[f"{stage}, less least squares"] = difference(own, errors(rows, stage, PLAIN, kernel, count)).text()
        row["raw, less linear"] = difference(raw, errors(rows, "raw", name, "linear", count)).text()
        table.append(row)
    return table


def means_table(data: dict[str, Rows], names: Sequence[str], values: Sequence[str]) -> Rows:
    """Return means × 100 over pairs for each combination of ``names``."""
    table = []
    for data_set, rows in data.items():
        for key in dict.fromkeys(tuple(row[name] for name in names) for row in rows):
            where = dict(zip(names, key, strict=True))
            means = {value: float(column(rows, value, **where).mean()) for value in values}
            table.append({"data": data_set, **where, **means})
    return table


def kernel_lines(data: dict[str, Rows], names: Sequence[str]) -> list[str]:
    """Return in which formulations the kernel is at least as good as none."""
    lines = []
    for (data_set, rows), count in product(data.items(), COUNTS):
        gains = {
            name: difference(*(errors(rows, "raw", name, kernel, count) for kernel in ("gaussian", "linear")))
            for name in names
        }
        better = [f"{name} {gain.text()}" for name, gain in gains.items() if gain.value <= 0]
        worse = [f"{name} {gain.text()}" for name, gain in gains.items() if gain.value > 0]
        text = f"{data_set}, {count} descriptors: the kernel's raw error is at most that of none in "
        text += f"{len(better)} of {len(gains)} formulations"
        lines.append(text + (f"; not in {', '.join(worse)}." if worse else "."))
        lines.append(f"Its error × 100 less that without, with 95 % intervals: {', '.join(better)}.")
    return lines


def formulation_lines(data: dict[str, Rows], names: Sequence[str]) -> list[str]:
    """Return what each formulation changes against least squares, with the default kernel."""
    lines = []
    for (data_set, rows), count in product(data.items(), COUNTS):
        plain = {stage: errors(rows, stage, PLAIN, "gaussian", count) for stage in ("raw", "refined")}
        gains = []
        for name in names:
            raw, refined = (difference(errors(rows, s, name, "gaussian", count), plain[s]).text() for s in plain)
            gains += [f"{name} {raw}, refined {refined}"] if name != PLAIN else []
        text = f"{data_set}, {count} descriptors, default kernel: least squares {plain['raw'].mean():.2f}, refined "
        lines.append(text + f"{plain['refined'].mean():.2f}; less that: {'; '.join(gains)}.")
    return lines


def direction_lines(data: dict[str, Rows]) -> list[str]:
    """Return what fitting both directions at once changes."""
    lines = []
    for data_set, rows in data.items():
        for key in dict.fromkeys((row["kernel"], row["descriptors"], row["stage"]) for row in rows):
            where = dict(zip(("kernel", "descriptors", "stage"), key, strict=True))
            alone, both = (
                {value: column(rows, value, maps=maps, **where) for value in ("error", "cycle", "coverage")}
                for maps in ("each by itself", "both at once")
            )
            before, after = alone["cycle"].mean(), both["cycle"].mean()
            lines.append(
                f"{data_set}, {key[0]}, {key[1]} descriptors, {key[2]}: both directions at once lower the cycle error "
                f"by {100 * (1 - after / before):.0f} % ({before:.2f} to {after:.2f}); error "
                f"{alone['error'].mean():.2f}, changed by {difference(both['error'], alone['error']).text()}; "
                f"coverage {alone['coverage'].mean():.0f} to {both['coverage'].mean():.0f} %."
            )
    return lines


def loss_lines(data: dict[str, Rows]) -> list[str]:
    """Return errors with three tenths of the landmarks wrong against those with none."""
    lines = []
    for (data_set, rows), kernel, loss in product(data.items(), KERNELS, LOSSES):
        right, wrong = (
            {stage: column(rows, stage, loss=loss, kernel=kernel, wrong=share).mean() for stage in ("raw", "refined")}
            for share in (0.0, 0.3)
        )
        lines.append(
            f"{data_set}, {kernel}, {loss} loss: with 30 % wrong landmarks of 20 the error is "
            f"{wrong['raw'] / right['raw']:.2f} times that with none ({right['raw']:.2f} to {wrong['raw']:.2f}), "
            f"refined {wrong['refined'] / right['refined']:.2f} times."
        )
    return lines


def transfer_lines(data: dict[str, Rows]) -> list[str]:
    """Return errors of transferred functions with products against C alone."""
    lines = []
    for data_set, rows in data.items():
        for size, function in dict.fromkeys((row["map"], row["function"]) for row in rows):
            numbers = sorted({row["products"] for row in rows if row["map"] == size})
            means = [column(rows, "error", products=n, map=size, function=function).mean() for n in numbers]
            listed = ", ".join(f"{n}: {mean:.1f}" for n, mean in zip(numbers, means, strict=True))
            text = f"{data_set}, {function} transferred by the {size} map, relative error in per cent by products: "
            lines.append(f"{text}{listed}.")
    return lines


NAMES = {
    "linear": "no kernel",
    "gaussian": "default kernel",
    "squared": "squares",
    "huber": "Huber",
    "geman": "Geman and McClure",
}
"""Names of kernels and losses in pictures."""


def draw(data: dict[str, Rows], losses: dict[str, Rows]) -> Figure:
    """Draw errors of each formulation without and with the kernel, and against the share of wrong landmarks."""
    data_set, rows = next(iter(data.items()))
    figure, (left, right) = style.new_figure(columns=2, width=5.2, height=3.8)
    names = list(dict.fromkeys(row["formulation"] for row in rows))
    positions = np.arange(len(names))
    for shift, (kernel, color) in zip((-0.19, 0.19), (("linear", style.ORANGE), ("gaussian", style.BLUE)), strict=True):
        values = [errors(rows, "raw", name, kernel, 10).mean() for name in names]
        left.barh(positions + shift, values, 0.36, color=color, label=NAMES[kernel])
    left.set_yticks(positions, names)
    left.invert_yaxis()
    left.set_xlim(0, 1.35 * left.get_xlim()[1])  # room for the names
    left.legend(fontsize=7, frameon=False, loc="upper right")
    style.labels(left, "mean error × 100, 10 descriptors", "", data_set)
    rows = losses[data_set]
    shares = sorted({row["wrong"] for row in rows})
    for loss, color in zip(LOSSES, (style.BLACK, style.SKY, style.GREEN), strict=False):
        for kernel, dashes in zip(KERNELS, ("dashed", "solid"), strict=True):
            values = [column(rows, "raw", loss=loss, kernel=kernel, wrong=share).mean() for share in shares]
            label = f"{NAMES[loss]}, {NAMES[kernel]}"
            right.plot(100 * np.array(shares), values, color=color, linestyle=dashes, label=label)
    right.legend(fontsize=7, frameon=False)
    style.labels(right, "wrong landmarks of 20 (%)", "mean error × 100", "robust losses")
    return figure


if __name__ == "__main__":
    main(formulations)
