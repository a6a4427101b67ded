"""Results of pairs: a small file for each, and the tables and numbers made from them."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._records import JsonObject
from kfmaps._texts import UNIT, percent, probability_text
from kfmaps.batch.layout import Pair
from kfmaps.io.atomic import csv_text, write_text

FOLDER = "pairs"
BAD = 0.05
"""A mean error above this counts as a wrong map."""


@dataclass(frozen=True)
class Result:
    """The result of one pair. Errors are in units of √area of the source; ``None`` where the truth is unknown."""

    source: str
    target: str
    status: str  # "done" or "failed"
    settings: str  # digest of the specification
    inputs: str  # digest of the input files; a pair with changed files is done again
    reason: str = ""  # of a failure
    attempts: int = 1  # number of starts of the work, also in earlier, interrupted runs
    worker: str = ""  # host and process
    finished: str = ""  # when, in UTC
    vertices_s: int | None = None
    vertices_t: int | None = None
    landmarks: int | None = None
    error_mean: float | None = None
    error_median: float | None = None
    error_max: float | None = None
    auc: float | None = None
    mirrored_mean: float | None = None  # against the truth with left and right swapped
    coverage: float | None = None  # share of the source's area that the map reaches
    confidence: float | None = None  # of the search without landmarks
    local_confidence: float | None = None  # mean over the target's vertices, see kfmaps.fmap.confidence
    verdict: str = ""
    orientation: str = ""  # "preserving", or "reversing" for a map to the target's mirror image
    agreement: float | None = None  # probability of the map given all others, where maps were made consistent
    common_s: float | None = None  # share of the source's area that both have, where one is a part of the other
    common_t: float | None = None  # the same for the target
    changed: str = ""  # replacement of a map that others contradict: "alternative 1", "composition through A, B"
    why: str = ""  # reason of the replacement
    error_before: float | None = None  # mean error of the map that was replaced
    solver: str = ""
    solver_steps: int | None = None
    rank: int | None = None
    seconds: dict[str, float] = field(default_factory=dict)  # per stage; "total" includes reading and evaluation
    curve: tuple[float, ...] = ()  # fraction of points with an error at or below each of CURVE_ERRORS
    notes: tuple[str, ...] = ()

    @property
    def pair(self) -> Pair:
        """The pair of the result."""
        return Pair(self.source, self.target)

    def is_of(self, settings: str, inputs: str) -> bool:
        """Return whether the digests of settings and inputs are these."""
        return (self.settings, self.inputs) == (settings, inputs)


def describe_result(result: Result) -> str:
    """Return a result in one line: error and verdict, or the reason of the failure."""
    if result.status == "failed":
        return f"failed: {result.pair}: {result.reason}"
    parts = [] if result.error_mean is None else [f"mean error {percent(result.error_mean)} {UNIT}"]
    parts += [] if result.confidence is None else [f"{result.verdict} ({probability_text(result.confidence)})"]
    return ", ".join([str(result.pair), *parts])


CURVE_ERRORS = tuple(i / 400 for i in range(101))
"""Errors of the stored curves: 0 to 0.25 in steps of 0.0025."""


def result_path(folder: Path, key: str) -> Path:
    """Return the file of the result of the pair with this key."""
    return folder / FOLDER / f"{key}.json"


def write_result(path: Path, result: Result) -> None:
    """Write a result, whole or not at all."""
    write_text(path, json.dumps(asdict(result), indent=1) + "\n", force=True)


def read_result(path: Path) -> Result | None:
    """Return the result in a file; ``None`` when there is no such file, or it is no result."""
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
        names = {f.name for f in fields(Result)}
        values = {k: tuple(v) if isinstance(v, list) else v for k, v in values.items() if k in names}
        return Result(**values)
    except (OSError, ValueError, TypeError, AttributeError, RecursionError):
        return None


def all_results(folder: Path, settings: str) -> list[Result]:
    """Return the results in an output folder that have this digest of the settings, by source and target."""
    # A worker that is killed before it renames a result leaves a file whose name begins with a dot.
    paths = (path for path in sorted((folder / FOLDER).glob("*.json")) if not path.name.startswith("."))
    results = map(read_result, paths)
    return sorted((r for r in results if r is not None and r.settings == settings), key=lambda r: r.pair)


def write_rows(path: Path, rows: Iterable[Iterable[object]]) -> None:
    """Write rows as CSV, whole or not at all; an existing file is replaced."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, csv_text(rows), force=True)


def write_csv(path: Path, results: Iterable[Result]) -> None:
    """Write a row for each pair: the fields of :class:`Result`, then the times as ``seconds_…``; unknown is empty."""
    rows = []
    for result in results:
        values = asdict(result)
        times = {"seconds_" + name.replace(" ", "_"): time for name, time in values.pop("seconds").items()}
        rows.append(values | {"notes": "; ".join(result.notes)} | times)
    fixed = [f.name for f in fields(Result) if f.name not in ("seconds", "curve")]
    columns = fixed + list(dict.fromkeys(name for row in rows for name in row if name.startswith("seconds_")))
    write_rows(path, [columns, *([row.get(name, "") for name in columns] for row in rows)])


def summarize(results: Sequence[Result]) -> JsonObject:
    """Return the numbers of a run; errors are in units of √area, ``None`` without a known truth."""
    done = [r for r in results if r.status == "done"]
    errors = np.array([r.error_mean for r in done if r.error_mean is not None])
    seconds = np.array([r.seconds["total"] for r in done if "total" in r.seconds])
    mirrored = [(r.error_mean or 0.0, r.mirrored_mean) for r in done if r.mirrored_mean is not None]

    def aggregate(values: np.ndarray, of: Callable[[np.ndarray], Any]) -> float | None:
        return float(of(values)) if len(values) else None

    return {
        "done": len(done),
        "failed": len(results) - len(done),
        "evaluated": len(errors),  # pairs whose truth is known
        "error_mean": aggregate(errors, np.mean),  # of each pair's mean error
        "error_median": aggregate(errors, np.median),
        "error_worst": aggregate(errors, np.max),
        "bad": int((errors > BAD).sum()),
        "flipped": sum(swapped < error for error, swapped in mirrored),  # closer to the mirrored truth
        "seconds_mean": aggregate(seconds, np.mean),  # of the pairs' matching, without the shapes' preparation
        "seconds_total": aggregate(seconds, np.sum),
        "verdicts": dict(sorted(Counter(r.verdict for r in done).items())),
        "mirrored": len(mirrored),  # pairs whose mirrored truth is known
        "agreed": sum(r.agreement is not None for r in done),  # compared with the others of the collection
        "changed": sum(bool(r.changed) for r in done),  # those of them whose map was replaced
        "parts": sum(r.common_s is not None for r in done),  # one shape was taken for a part of the other
    }


def worst_first(results: Sequence[Result]) -> list[Result]:
    """Return the finished results, the largest mean error first; without a known truth the least confident first.

    Single fits have no confidence, and their local confidence counts.
    """
    done = [r for r in results if r.status == "done"]

    def rank(r: Result) -> tuple[float, ...]:
        sure = [float("inf") if c is None else c for c in (r.confidence, r.local_confidence)]
        return (-(r.error_mean if r.error_mean is not None else -1.0), *sure)

    return sorted(done, key=rank)
