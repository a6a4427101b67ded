"""The picture of docs/kernels.md: by how much a kernel changes the error of a map, in each place where it was tried.

    python benchmarks/kernel_picture.py docs/images/kernels.png "PLACE=FILE:PIECE" ...

FILE is what ``--rows`` of benchmarks/ablation.py or benchmarks/kernel_fit.py has written, PIECE the name of one of its
pieces; with "-PIECE" the change is that of putting it in, not of taking it out. PLACE is the label. A point is the
change of the mean error of all pairs, a line its interval of 95 % (by drawing pairs), a ring the change of one set.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from ablation import changes_of
from matplotlib.figure import Figure
from scatter import interval

from kfmaps.viz import save_figure


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("output", type=Path)
    parser.add_argument("places", nargs="+", metavar="PLACE=FILE:PIECE")
    args = parser.parse_args()
    figure = Figure(figsize=(8.0, 0.9 + 0.4 * len(args.places)), facecolor="white", layout="constrained")
    axes = figure.add_subplot()
    axes.axvline(0, color="0.6", linewidth=1)
    labels = []
    for i, place in enumerate(args.places):
        label, _, asked = place.partition("=")
        file, _, piece = asked.rpartition(":")
        rows = [json.loads(line) for line in Path(file).read_text(encoding="utf-8").splitlines()]
        _, kinds, before, change = changes_of(rows, piece.removeprefix("-"))
        if piece.startswith("-"):
            before, change = before + change, -change
        each = [100 * change[kinds == kind].mean() / before[kinds == kind].mean() for kind in np.unique(kinds)]
        axes.plot(each, np.full(len(each), i), "o", markerfacecolor="none", markeredgecolor="0.6", markersize=5)
        axes.plot(interval(100 * change / before.mean()), (i, i), color="#1f4e79", linewidth=2)
        axes.plot(100 * change.mean() / before.mean(), i, "o", color="#1f4e79", markersize=7)
        labels.append(f"{label} ({len(kinds)} pairs)")
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xlabel("change of the mean error by the kernel, %")
    axes.spines[["top", "right"]].set_visible(False)
    save_figure(figure, args.output)


if __name__ == "__main__":
    main()
