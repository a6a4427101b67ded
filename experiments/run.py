"""Run experiments of the paper: a table, pictures and conclusions for each.

    python experiments/run.py all --data DIR -o OUT

``DIR`` holds FAUST, FAUST_r or both. Without ``--data`` the experiments use shapes that the package generates. A run
that was stopped continues from the results in ``OUT``.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

from figure2 import figure2
from figure3 import figure3
from figure4 import figure4
from figure5 import figure5
from figure6 import figure6
from figure7 import figure7
from formulations import formulations
from kfmaps._arrays import InvalidInput
from options import Setting
from outputs import Outcome, output_folder
from section44 import section44

FIGURES: dict[str, Callable[[Setting], Outcome]] = {
    "figure2": figure2,
    "figure3": figure3,
    "figure4": figure4,
    "figure5": figure5,
    "figure6": figure6,
    "figure7": figure7,
    "section44": section44,
    "formulations": formulations,
}


def main(arguments: Sequence[str]) -> None:
    """Run the experiments that ``arguments`` name and print their conclusions."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("names", nargs="*", default=["all"], metavar="NAME", help="all, " + ", ".join(FIGURES))
    parser.add_argument("--data", type=Path, help="folder of FAUST, FAUST_r or both; default: generated shapes")
    parser.add_argument("-o", "--output", type=Path, default=Path("experiments-output"), help="folder for the results")
    parser.add_argument("--pairs", type=int, default=100, help="reported pairs of each data set (100)")
    parser.add_argument("--workers", type=int, help="processes; default: one for each core")
    parser.add_argument("--vertices", type=int, default=2500, help="vertices of a generated shape (2500)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the draw of pairs and samples (0)")
    options = parser.parse_args(arguments)
    names = list(FIGURES) if "all" in options.names else options.names
    if unknown := [name for name in names if name not in FIGURES]:
        parser.error(f"expected all or some of {', '.join(FIGURES)}, got {', '.join(unknown)}")
    try:
        setting = Setting(
            options.data,
            output_folder(options.output),
            options.pairs,
            options.workers,
            options.vertices,
            seed=options.seed,
        )
        print("Data:", ", ".join(str(c.folder or "generated shapes") for c in setting.collections()))
        for name in names:
            outcome = FIGURES[name](setting)
            print(name, *(f"  • {line}" for line in outcome.lines), sep="\n")
            print(*(f"  {path}" for path in (*outcome.tables, *outcome.pictures, outcome.conclusions)), sep="\n")
    except InvalidInput as error:
        parser.error(str(error))


if __name__ == "__main__":
    main(sys.argv[1:])
