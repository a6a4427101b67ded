"""The kernel in every formulation: errors with and without it, wrong landmarks, both directions, carried functions.

On people 4 to 7 of FAUST_r and the animals of TOSCA_r; settings were chosen on people 0 to 3. Without data, on shapes
that the package generates.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import style
from data_sets import Collection
from formulation_pairs import (
    CONFIG,
    COUNTS,
    FORMULATIONS,
    KERNELS,
    LOSSES,
    between,
    compared,
    functions,
    outliers,
)
from formulation_shapes import Shapes
from intervals import Interval, difference
from kfmaps._arrays import refuse
from options import PIECES, Setting
from outputs import Outcome, write_conclusions, write_pictures, write_table
from store import Job, read_store

MOST = {"FAUST_r": 40, "TOSCA_r": 20, "generated": 8}
"""Pairs of each data set, where no fewer are asked for."""
PLAIN = "least squares"

KINDS: Mapping[str, Callable[..., list[dict[str, Any]]]] = {
    "compared": compared,
    "between": between,
    "outliers": outliers,
    "functions": functions,
}

WAYS = ("error", "cycle", "coverage")

Rows = list[dict[str, Any]]


USED: Mapping[str, tuple[str, ...]] = {
    "between": ("least squares", "both directions"),
    "outliers": (),
    "functions": ("least squares",),
}
"""Formulations that a measurement fits; "compared" has a piece for each."""


def piece(kind: str, shapes: Shapes, a: str, b: str, count: int) -> list[Rows]:
    """One kind of measurement on one pair, for a worker process."""
    return [KINDS[kind](shapes, a, b, count)]


def pieces(shapes: Shapes, a: str, b: str, count: int, names: Sequence[str]) -> list[Rows]:
    """The comparison on one pair for some formulations, a list of rows for each."""
    rows = compared(shapes, a, b, count, names)
    return [[row for row in rows if row["formulation"] == name] for name in names]


def data_sets(setting: Setting) -> list[Shapes]:
    """What is found in the data folder, or the generated shapes.

    Raises
    ------
    InvalidInput
        When the folder has neither of the data sets.
    """
    if setting.data is None:
        return [Shapes("generated", vertices=setting.vertices)]
    found = [Shapes(name, setting.data / name) for name in ("FAUST_r", "TOSCA_r") if (setting.data / name).is_dir()]
    if not found:
        remedy = "name the folder that holds them, or leave --data out to use generated shapes"
        raise refuse(f"data {setting.data}", "a folder FAUST_r or TOSCA_r", "neither", remedy)
    return found


def measured(setting: Setting, kind: str, share: float = 1.0, counts: Sequence[int] = COUNTS) -> dict[str, Rows]:
    """Rows of one kind of measurement by data set, each with its ``pair``; on a ``share`` of the pairs.

    A further row of :data:`FORMULATIONS` is all that is measured again; a new setting changes every key.
    """
    known = read_store(setting.folder / PIECES)
    jobs, places = [], []
    for shapes in data_sets(setting):
        count = max(1, round(share * MOST[shapes.collection] * min(1.0, setting.pairs / MOST["FAUST_r"])))
        size = "" if shapes.folder is not None else f" {shapes.vertices}"
        # Pairs of one source next to each other: a worker keeps the shapes that it has prepared.
        for a, b in sorted(shapes.pairs(count, setting.seed)):
            for n in counts:
                told = f"{kind} {shapes.collection}{size} {a} {b} {n}"
                if kind == "compared":
                    keys = {name: f"formulations {version((name,))} {told} {name}" for name in FORMULATIONS}
                    for done in (True, False):
                        names = tuple(name for name, key in keys.items() if (key in known) == done)
                        if names:
                            jobs.append(Job(tuple(keys[n] for n in names), pieces, (shapes, a, b, n, names)))
                else:
                    keys = {kind: f"formulations {version(USED[kind])} {told}"}
                    jobs.append(Job(tuple(keys.values()), piece, (kind, shapes, a, b, n)))
                places += [(shapes.collection, f"{a} {b}", key) for key in keys.values()]
    values = setting.run(jobs)
    rows: dict[str, Rows] = {}
    for collection, pair, key in places:
        rows.setdefault(collection, []).extend({"pair": pair, **row} for row in values[key])
    return rows


def version(names: Sequence[str]) -> str:
    """What rows of these formulations depend on beside their pair."""
    asked = repr((CONFIG, {name: FORMULATIONS[name] for name in names}, LOSSES))
    return hashlib.sha256(asked.encode()).hexdigest()[:12]


def column(rows: Rows, value: str, **where: Any) -> np.ndarray:
    """``value`` × 100 of the rows that agree with ``where``, in the order of the pairs."""
    chosen = [row for row in rows if all(row[name] == wanted for name, wanted in where.items())]
    return 100 * np.array([row[value] for row in sorted(chosen, key=lambda row: row["pair"])])


def formulations(setting: Setting) -> Outcome:
    """Every formulation with a linear and with the default kernel, and what each is good for."""
    main = measured(setting, "compared")
    ways = measured(setting, "between", 0.5)
    wrong = measured(setting, "outliers", 0.5, (100,))
    carried = measured(setting, "functions", 0.25, (100,))
    tables = {
        "formulations": compared_table(main),
        "formulations-directions": grouped(
            ways, ("maps", "stage", "kernel", "descriptors"), ("error", "cycle", "coverage")
        ),
        "formulations-landmarks": grouped(wrong, ("loss", "kernel", "wrong"), ("raw", "refined")),
        "formulations-functions": grouped(carried, ("map", "function", "products"), ("error",)),
    }
    lines = [*kernel_lines(main), *formulation_lines(main), *direction_lines(ways), *landmark_lines(wrong)]
    lines += function_lines(carried)
    folder = setting.folder
    used = [Collection("generated")] if setting.data is None else []
    return Outcome(
        "formulations",
        tuple(write_table(folder / f"{name}.csv", rows) for name, rows in tables.items()),
        write_pictures(folder, "formulations", draw(main, wrong)),
        write_conclusions(folder, "formulations", used or [Collection("FAUST_r", setting.data)], lines),
        tuple(lines),
    )


def compared_table(found: dict[str, Rows]) -> Rows:
    """Mean errors × 100, the difference to least squares, and that of the kernel to none, with 95 % intervals."""
    table = []
    for collection, rows in found.items():
        for count in COUNTS:
            for name in FORMULATIONS:
                for kernel in KERNELS:
                    row: dict[str, Any] = {"data": collection, "descriptors": count, "formulation": name}
                    row |= {"kernel": kernel, "pairs": len(column(rows, "raw", **_at(name, kernel, count)))}
                    for stage in ("raw", "refined"):
                        own = column(rows, stage, **_at(name, kernel, count))
                        row[stage] = float(own.mean())
                        row[f"{stage}, less least squares"] = difference(
                            own, column(rows, stage, **_at(PLAIN, kernel, count))
                        ).text()
                    linear = column(rows, "raw", **_at(name, "linear", count))
                    row["raw, less linear"] = difference(column(rows, "raw", **_at(name, kernel, count)), linear).text()
                    table.append(row)
    return table


def _at(name: str, kernel: str, count: int) -> dict[str, Any]:
    return {"formulation": name, "kernel": kernel, "descriptors": count}


def grouped(found: dict[str, Rows], names: Sequence[str], values: Sequence[str]) -> Rows:
    """Means × 100 over pairs for each combination of ``names``."""
    table = []
    for collection, rows in found.items():
        for key in dict.fromkeys(tuple(row[name] for name in names) for row in rows):
            where = dict(zip(names, key, strict=True))
            means = {value: float(column(rows, value, **where).mean()) for value in values}
            table.append({"data": collection, **where, **means})
    return table


def kernel_lines(found: dict[str, Rows]) -> list[str]:
    """Whether the kernel is at least as good as none in each formulation."""
    lines = []
    for collection, rows in found.items():
        for count in COUNTS:
            gains = {}
            for name in FORMULATIONS:
                with_it, without = (
                    column(rows, "raw", **_at(name, kernel, count)) for kernel in ("gaussian", "linear")
                )
                gains[name] = difference(with_it, without)
            better = [name for name, gain in gains.items() if gain.value <= 0]
            worse = [f"{name} {gain.text()}" for name, gain in gains.items() if gain.value > 0]
            text = f"{collection}, {count} descriptors: the kernel's raw error is at most that of none in "
            text += f"{len(better)} of {len(gains)} formulations"
            lines.append(text + (f"; not in {', '.join(worse)}." if worse else "."))
            shown = ", ".join(f"{name} {gain.text()}" for name, gain in gains.items() if gain.value <= 0)
            lines.append(f"Its error × 100 less that without, with 95 % intervals: {shown}.")
    return lines


def formulation_lines(found: dict[str, Rows]) -> list[str]:
    """What each formulation changes against least squares, with the default kernel."""
    lines = []
    for collection, rows in found.items():
        for count in COUNTS:
            parts = []
            for name in FORMULATIONS:
                if name == PLAIN:
                    continue
                told = [_gain(rows, stage, name, count).text() for stage in ("raw", "refined")]
                parts.append(f"{name} {told[0]}, refined {told[1]}")
            plain = [column(rows, stage, **_at(PLAIN, "gaussian", count)).mean() for stage in ("raw", "refined")]
            lines.append(
                f"{collection}, {count} descriptors, default kernel: least squares {plain[0]:.2f}, refined "
                f"{plain[1]:.2f}; less that: {'; '.join(parts)}."
            )
    return lines


def _gain(rows: Rows, stage: str, name: str, count: int) -> Interval:
    own, plain = (column(rows, stage, **_at(n, "gaussian", count)) for n in (name, PLAIN))
    return difference(own, plain)


def direction_lines(found: dict[str, Rows]) -> list[str]:
    """What fitting both directions at once changes."""
    lines = []
    for collection, rows in found.items():
        for key in dict.fromkeys((row["kernel"], row["descriptors"], row["stage"]) for row in rows):
            where = dict(zip(("kernel", "descriptors", "stage"), key, strict=True))
            alone, both = (
                {value: column(rows, value, maps=maps, **where) for value in WAYS}
                for maps in ("each by itself", "both at once")
            )
            before, after = alone["cycle"].mean(), both["cycle"].mean()
            change = difference(both["error"], alone["error"]).text()
            lines.append(
                f"{collection}, {key[0]}, {key[1]} descriptors, {key[2]}: both directions at once lower the cycle "
                f"error by {100 * (1 - after / before):.0f} % ({before:.2f} to {after:.2f}); error "
                f"{alone['error'].mean():.2f}, changed by {change}; "
                f"coverage {alone['coverage'].mean():.0f} to {both['coverage'].mean():.0f} %."
            )
    return lines


def landmark_lines(found: dict[str, Rows]) -> list[str]:
    """Errors with three tenths of the landmarks wrong against those with none."""
    lines = []
    for collection, rows in found.items():
        for kernel in KERNELS:
            for loss in LOSSES:
                raw, refined = (
                    [column(rows, stage, loss=loss, kernel=kernel, wrong=share).mean() for share in (0.0, 0.3)]
                    for stage in ("raw", "refined")
                )
                lines.append(
                    f"{collection}, {kernel}, {loss} loss: with 30 % wrong landmarks of 20 the error is "
                    f"{raw[1] / raw[0]:.2f} times that with none ({raw[0]:.2f} to {raw[1]:.2f}), refined "
                    f"{refined[1] / refined[0]:.2f} times."
                )
    return lines


def function_lines(found: dict[str, Rows]) -> list[str]:
    """Error of carried functions with products against C alone."""
    lines = []
    for collection, rows in found.items():
        for key in dict.fromkeys((row["map"], row["function"]) for row in rows):
            where = {"map": key[0], "function": key[1]}
            sizes = sorted({row["products"] for row in rows if row["map"] == key[0]})
            told = [f"{n}: {column(rows, 'error', products=n, **where).mean():.1f}" for n in sizes]
            text = f"{collection}, {key[1]} carried by the {key[0]} map, relative error in per cent by products: "
            lines.append(text + ", ".join(told) + ".")
    return lines


WORDS = {
    "linear": "no kernel",
    "gaussian": "default kernel",
    "squared": "squares",
    "huber": "Huber",
    "geman": "Geman and McClure",
}
"""What pictures call kernels and losses."""


def draw(main: dict[str, Rows], wrong: dict[str, Rows]) -> Figure:
    """Errors of each formulation without and with the kernel, and against the share of wrong landmarks."""
    collection = next(iter(main))
    figure, axes = style.new_figure(columns=2, width=5.2, height=3.8)
    rows, names = main[collection], list(FORMULATIONS)
    places = np.arange(len(names))
    colors = {("linear", 10): style.ORANGE, ("gaussian", 10): style.BLUE}
    for i, ((kernel, count), color) in enumerate(colors.items()):
        values = [column(rows, "raw", **_at(name, kernel, count)).mean() for name in names]
        axes[0].barh(places + 0.38 * (i - 0.5), values, 0.36, color=color, label=WORDS[kernel])
    axes[0].set_yticks(places, names)
    axes[0].invert_yaxis()
    axes[0].set_xlim(0, 1.35 * axes[0].get_xlim()[1])  # room for the names
    axes[0].legend(fontsize=7, frameon=False, loc="upper right")
    style.labels(axes[0], "mean error × 100, 10 descriptors", "", collection)
    for loss, color in zip(LOSSES, (style.BLACK, style.SKY, style.GREEN, style.VERMILION), strict=False):
        for kernel, dashes in zip(KERNELS, ("dashed", "solid"), strict=True):
            part = wrong[collection]
            shares = sorted({row["wrong"] for row in part})
            values = [column(part, "raw", loss=loss, kernel=kernel, wrong=share).mean() for share in shares]
            axes[1].plot(
                100 * np.array(shares), values, color=color, linestyle=dashes, label=f"{WORDS[loss]}, {WORDS[kernel]}"
            )
    axes[1].legend(fontsize=7, frameon=False)
    style.labels(axes[1], "wrong landmarks of 20 (%)", "mean error × 100", "robust losses")
    return figure


if __name__ == "__main__":
    from run import main

    main(["formulations", *sys.argv[1:]])
