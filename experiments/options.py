"""What every experiment is told: data, output folder, how many pairs, how many processes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from data_sets import Collection, ShapePair, collections
from kfmaps.config import Config
from pair_errors import Row, run_pairs
from store import Job, run_jobs

STORE = "pairs.jsonl"
PIECES = "pieces.jsonl"


@dataclass(frozen=True)
class Setting:
    """How to run an experiment.

    Attributes
    ----------
    data : Path or None
        Folder of FAUST and FAUST_r; ``None`` takes generated shapes.
    folder : Path
        Where tables, pictures and finished rows go.
    pairs : int
        Reported pairs of each data set.
    workers : int or None
        Processes; ``None`` takes every core.
    vertices : int
        Of a generated source; its target has four fifths of them.
    timing_vertices : int
        Of the generated source of figure 7: 2828 · 2262 is about 2529².
    seed : int
        For the draw of pairs and of samples.
    """

    data: Path | None
    folder: Path
    pairs: int = 100
    workers: int | None = None
    vertices: int = 2500
    timing_vertices: int = 2828
    seed: int = 0

    def collections(self) -> list[Collection]:
        """The data sets to run on."""
        return collections(self.data, self.vertices)

    def rows(self, collection: Collection, pairs: Sequence[ShapePair], methods: Mapping[str, Config]) -> list[Row]:
        """A row for each pair and method, see :func:`run_pairs`; kept in the output folder."""
        store = self.folder / STORE
        return run_pairs(collection, pairs, methods, store, workers=self.workers)

    def run(self, jobs: Sequence[Job]) -> dict[str, Any]:
        """Values of jobs that are not pairs, see :func:`run_jobs`; kept in the output folder."""
        return run_jobs(jobs, self.folder / PIECES, workers=self.workers)

    def specimen_key(self) -> str:
        """What the specimen depends on, for keys of the store."""
        collection, pair = self.specimen()
        size = "" if collection.folder is not None else f" {self.vertices}"
        return f"{collection.name}{size} {pair.source} {pair.target}"

    def specimen(self) -> tuple[Collection, ShapePair]:
        """The first data set and its first reported pair, for experiments on one shape or one pair."""
        first = self.collections()[0]
        return first, first.reported(1, self.seed)[0]


def by_method(rows: Sequence[Row]) -> dict[str, list[Row]]:
    """Rows of each method, in the order of the pairs."""
    grouped: dict[str, list[Row]] = {}
    for row in rows:
        grouped.setdefault(row.method, []).append(row)
    return grouped
