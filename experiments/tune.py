"""Grid search over settings on training pairs (section 7.2 of the paper).

    python experiments/tune.py --data DIR -o OUT --vary bandwidth_scale=0.1,0.3,1 --vary weights.laplacian=0.1,1,10

Writes ``tune.csv``, the mean error of every combination, and ``tune.toml``, the best settings, which ``kfmaps match
--config`` reads. ``kfmaps config`` prints the names of the settings. A run that was stopped continues from ``OUT``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from data_sets import DataSet, Pair
from experiment import Options, options_parser, read_options, write_table
from kfmaps._arrays import InvalidInput, refuse
from kfmaps._texts import UNIT
from kfmaps.config import Config
from kfmaps.io import read_text
from kfmaps.settings import preset, read_settings, settings_text, with_assignments

DEFAULT = ("bandwidth_scale=0.1,0.3,1.0", "weights.laplacian=0.1,1.0,10.0")


def candidates(base: Config, axes: Sequence[str]) -> dict[str, Config]:
    """Return ``base`` with every combination of the values of ``axes``, texts "NAME=VALUE,VALUE"."""
    values = []
    for axis in axes:
        name, _, listed = axis.partition("=")
        values.append([f"{name}={value}" for value in listed.split(",")])
    return {", ".join(chosen): with_assignments(base, chosen) for chosen in product(*values)}


@dataclass(frozen=True)
class Tuned:
    """The best settings of a grid search, their name and mean error, and a table of all settings, best first."""

    best: Config
    name: str
    error: float
    table: tuple[dict[str, Any], ...]


def grid_search(
    options: Options,
    grid: dict[str, Config],
    pairs: Sequence[tuple[DataSet, Sequence[Pair]]],
    refined: bool = False,
) -> Tuned:
    """Return the settings of ``grid`` with the lowest mean over data sets of the mean error of their ``pairs``.

    ``refined``: judge the refined map instead of the raw one.
    """
    fits = grid if refined else {name: replace(config, refinement=None) for name, config in grid.items()}
    errors: dict[str, list[float]] = {name: [] for name in grid}
    for data_set, some in pairs:
        for name, rows in options.pair_rows(data_set, some, fits).items():
            errors[name].append(float(np.mean([row.refined if refined else row.mean for row in rows])))
    order = sorted(grid, key=lambda name: np.mean(errors[name]))
    table = [
        {
            "settings": name,
            f"mean error ({UNIT})": 100 * float(np.mean(errors[name])),
            **{c.name: 100 * value for (c, _), value in zip(pairs, errors[name], strict=True)},
            "pairs": sum(len(some) for _, some in pairs),
        }
        for name in order
    ]
    return Tuned(grid[order[0]], order[0], float(np.mean(errors[order[0]])), tuple(table))


def training_pairs(data_set: DataSet, options: Options, listed: Path | None) -> list[Pair]:
    """Return the pairs of the file ``listed`` that the data set has, or drawn training pairs."""
    if listed is None:
        return data_set.training(options.pairs, options.seed)
    known = set(data_set.shapes())
    lines = [line.split() for line in read_text(listed).splitlines() if line.strip()]
    return [(words[0], words[1]) for words in lines if len(words) == 2 and known.issuperset(words)]


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the grid search that ``arguments`` describe."""
    parser = options_parser("Grid search over settings on training pairs.", pairs=4)
    parser.add_argument("--base", default="single-fit", help="settings to vary: a settings file or a preset")
    parser.add_argument("--vary", action="append", metavar="NAME=VALUES", help="a setting and values, with commas")
    parser.add_argument("--pairs-from", type=Path, help='training pairs instead: a file of lines "source target"')
    parser.add_argument("--refined", action="store_true", help="judge the refined map instead of the raw one")
    parsed = parser.parse_args(arguments)
    try:
        base = parsed.base
        start = read_settings(base) if Path(base).suffix == ".toml" else preset(base)
        grid = candidates(start, parsed.vary or DEFAULT)
        options = read_options(parsed)
        pairs = [(each, training_pairs(each, options, parsed.pairs_from)) for each in options.data_sets()]
        pairs = [(data_set, some) for data_set, some in pairs if some]
        if not pairs:
            raise refuse(f"--pairs-from {parsed.pairs_from}", "pairs of shapes in the data", "none", "check the names")
        tuned = grid_search(options, grid, pairs, parsed.refined)
    except (InvalidInput, OSError) as error:
        parser.error(str(error))
    table = write_table(options.folder / "tune.csv", tuned.table)
    (options.folder / "tune.toml").write_text(settings_text(tuned.best), encoding="utf-8")
    for row in tuned.table[:10]:
        print(*(f"{v:.3f}" if isinstance(v, float) else v for v in row.values()), sep="  ")
    print(f"best: {tuned.name}; see {table} and {options.folder / 'tune.toml'}")


if __name__ == "__main__":
    main()
