"""What every experiment shares: its options, its results as files, and its command line.

    python experiments/figure6.py --data DIR -o OUT

``DIR`` holds FAUST, FAUST_r or both. Without ``--data`` the experiments use shapes that the package generates. A run
that was stopped continues from the results in ``OUT``.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from data_sets import DataSet, Pair, find_data_sets
from kfmaps._arrays import InvalidInput
from kfmaps.config import Config
from kfmaps.io import atomic_output
from kfmaps.viz import save_figure
from pair_errors import Row, pair_rows
from store import Job, run_jobs

Rows = Sequence[Mapping[str, Any]]
"""A table: a mapping from column to value for each line."""


@dataclass(frozen=True)
class Options:
    """How to run an experiment.

    Attributes
    ----------
    data : Path or None
        Folder of the data sets; ``None`` takes generated shapes.
    folder : Path
        Folder for tables, pictures and what was measured.
    pairs : int
        Number of pairs of each data set.
    workers : int or None
        Number of processes; ``None`` takes every core.
    vertices : int
        Number of vertices of a generated source; its target has four fifths of them.
    seed : int
        Seed of the draw of pairs and of samples.
    timing_vertices : int
        Number of vertices of the generated source of figure 7: 2828 · 2262 is about 2529².
    """

    data: Path | None
    folder: Path
    pairs: int = 100
    workers: int | None = None
    vertices: int = 2500
    seed: int = 0
    timing_vertices: int = 2828

    def data_sets(self) -> list[DataSet]:
        """Return the data sets to run on."""
        return find_data_sets(self.data, self.vertices)

    def specimen(self) -> tuple[DataSet, Pair]:
        """Return the first data set and its first reported pair, for experiments on one shape or one pair."""
        first = self.data_sets()[0]
        return first, first.reported(1, self.seed)[0]

    def pair_rows(
        self, data_set: DataSet, pairs: Sequence[Pair], settings: Mapping[str, Config]
    ) -> dict[str, list[Row]]:
        """Return a row for each pair, by the name of the settings; kept in the folder."""
        return pair_rows(data_set, pairs, settings, self.folder / "pairs.jsonl", self.workers)

    def run(self, jobs: Sequence[Job]) -> dict[str, Any]:
        """Return the values of jobs by key; kept in the folder."""
        return run_jobs(jobs, self.folder / "pieces.jsonl", self.workers)

    def map(self, function: Callable[..., Any], arguments: Mapping[Any, tuple]) -> dict[Any, Any]:
        """Return ``function(*arguments)`` for each label of ``arguments``; kept in the folder."""
        keys = {
            label: f"{function.__name__} {hashlib.sha256(repr(given).encode()).hexdigest()}"
            for label, given in arguments.items()
        }
        values = self.run([Job((keys[label],), _listed, (function, *given)) for label, given in arguments.items()])
        return {label: values[key] for label, key in keys.items()}


@dataclass(frozen=True, eq=False)
class Result:
    """Tables and pictures by file name, conclusions as sentences, and the data sets that they were measured on."""

    tables: Mapping[str, Rows]
    pictures: Mapping[str, Figure]
    conclusions: Sequence[str]
    data_sets: Sequence[DataSet]

    def write(self, name: str, folder: Path) -> list[Path]:
        """Write tables as CSV, pictures as PNG and PDF and ``name``.md with the conclusions; return the paths."""
        paths = [write_table(folder / f"{table}.csv", rows) for table, rows in self.tables.items()]
        for picture, figure in self.pictures.items():
            for path in (folder / f"{picture}.png", folder / f"{picture}.pdf"):
                with atomic_output(path, force=True) as temporary:
                    save_figure(figure, temporary)
                paths.append(path)
        names = ", ".join(d.name if d.folder else "shapes that the package generates" for d in self.data_sets)
        lines = [f"# {name}", "", f"Measured on {names}.", "", *(f"* {line}" for line in self.conclusions), ""]
        (folder / f"{name}.md").write_text("\n".join(lines), encoding="utf-8")
        return [*paths, folder / f"{name}.md"]


def _listed(function: Callable[..., Any], *arguments: Any) -> list[Any]:
    return [function(*arguments)]


def write_table(path: Path, rows: Rows) -> Path:
    """Write a CSV file with a header and floats to six significant digits; return ``path``."""
    with atomic_output(path, force=True) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        for row in rows:
            writer.writerow({name: f"{v:.6g}" if isinstance(v, float) else v for name, v in row.items()})
    return path


def options_parser(description: str, pairs: int = 100) -> argparse.ArgumentParser:
    """Return a parser of the options that all scripts have; ``pairs`` is the default of ``--pairs``."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--data", type=Path, help="folder of FAUST, FAUST_r or both; default: generated shapes")
    parser.add_argument("-o", "--output", type=Path, default=Path("experiments-output"), help="folder for the results")
    parser.add_argument("--pairs", type=int, default=pairs, help=f"pairs of each data set ({pairs})")
    parser.add_argument("--workers", type=int, help="processes; default: one for each core")
    parser.add_argument("--vertices", type=int, default=2500, help="vertices of a generated shape (2500)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the draw of pairs and samples (0)")
    return parser


def read_options(parsed: argparse.Namespace) -> Options:
    """Return the options of :func:`options_parser` and make the output folder."""
    parsed.output.mkdir(parents=True, exist_ok=True)
    return Options(parsed.data, parsed.output, parsed.pairs, parsed.workers, parsed.vertices, parsed.seed)


def main(*experiments: Callable[[Options], Result], arguments: Sequence[str] | None = None) -> None:
    """Run one experiment, or those of several that the command line names; print their conclusions and files."""
    by_name = {experiment.__name__: experiment for experiment in experiments}
    parser = options_parser(" ".join((experiments[0].__doc__ or "").split()) if len(by_name) == 1 else "")
    if len(by_name) > 1:
        parser.add_argument("names", nargs="*", metavar="NAME", help=f"default: all of {', '.join(by_name)}")
    parsed = parser.parse_args(arguments)
    names = getattr(parsed, "names", None) or list(by_name)
    if unknown := [name for name in names if name not in by_name]:
        parser.error(f"expected some of {', '.join(by_name)}, got {', '.join(unknown)}")
    try:
        options = read_options(parsed)
        for name in names:
            result = by_name[name](options)
            paths = result.write(name, options.folder)
            print(name, *(f"  • {line}" for line in result.conclusions), *(f"  {path}" for path in paths), sep="\n")
    except (InvalidInput, OSError) as error:
        parser.error(str(error))
