"""One small file per pair, which is the truth about it; tables are made from these files alone."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

from kfmaps._arrays import MissingDependency
from kfmaps.io import atomic_output

FOLDER = "pairs"


@dataclass(frozen=True)
class Result:
    """What came of one pair. Errors are in units of √area of the source; ``None`` where the truth is unknown.

    Attributes
    ----------
    source, target : str
    status : "done" or "failed"
    reason : str
        Why it failed.
    settings : str
        Digest of the settings.
    inputs : str
        Digest of the files it was made from; a pair whose files have changed is done again.
    attempts : int
        How often the work was begun, by this run or an earlier one that was cut short.
    worker : str
        Host and process that did it.
    finished : str
        When, in UTC.
    vertices_s, vertices_t, landmarks : int
    error_mean, error_median, error_max, auc : float or None
    mirrored_mean : float or None
        Mean error against the truth with left and right swapped, at 500 points: small where the map is mirrored.
    coverage : float or None
        Part of the source's area that the map reaches.
    confidence : float or None
        Of the search without landmarks.
    local_confidence : float or None
        Mean over the target's vertices, see :mod:`kfmaps.fmap.confidence`.
    verdict : str
    orientation : "kept", "reversed" or ""
        Whether it is a map to the target or to its mirror image.
    agreement : float or None
        Probability that the map is right beside all others of the collection, where they were made to agree.
    common_s, common_t : float or None
        Part of the area of source and target that both have, where one was taken for a part of the other.
    changed : str
        What a map was exchanged for that others contradict: "runner-up 1", "composition through A, B"; empty mostly.
    why : str
        For what reason.
    error_before : float or None
        Mean error of the map that was exchanged.
    solver, solver_steps, rank
    seconds : dict of str to float
        Per stage; ``total`` is all of it, with reading and evaluation.
    curve : tuple of float
        Fraction of points with an error at or below each of :data:`CURVE_ERRORS`.
    """

    source: str
    target: str
    status: str
    settings: str
    inputs: str
    reason: str = ""
    attempts: int = 1
    worker: str = ""
    finished: str = ""
    vertices_s: int | None = None
    vertices_t: int | None = None
    landmarks: int | None = None
    error_mean: float | None = None
    error_median: float | None = None
    error_max: float | None = None
    auc: float | None = None
    mirrored_mean: float | None = None
    coverage: float | None = None
    confidence: float | None = None
    local_confidence: float | None = None
    verdict: str = ""
    orientation: str = ""
    agreement: float | None = None
    common_s: float | None = None
    common_t: float | None = None
    changed: str = ""
    why: str = ""
    error_before: float | None = None
    solver: str = ""
    solver_steps: int | None = None
    rank: int | None = None
    seconds: dict[str, float] = field(default_factory=dict)
    curve: tuple[float, ...] = ()
    notes: tuple[str, ...] = ()


CURVE_ERRORS = tuple(i / 400 for i in range(101))
"""Errors at which curves are kept: 0 to 0.25 in steps of 0.0025."""


def result_path(folder: Path, key: str) -> Path:
    """Where the result of the pair with this key lies."""
    return folder / FOLDER / f"{key}.json"


def write_result(path: Path, result: Result) -> None:
    """Write it whole or not at all."""
    with atomic_output(path, force=True) as temporary:
        temporary.write_text(json.dumps(asdict(result), indent=1) + "\n", encoding="utf-8")


def read_result(path: Path) -> Result | None:
    """Read it; ``None`` when there is none, or the file is not one."""
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
        known = {f.name for f in fields(Result)}
        values = {k: tuple(v) if isinstance(v, list) else v for k, v in values.items() if k in known}
        return Result(**values)
    except (OSError, ValueError, TypeError, AttributeError, RecursionError):
        return None


def all_results(folder: Path, settings: str) -> list[Result]:
    """Every result in an output folder that was made with these settings, by source and target."""
    # A worker that is killed just before it renames a result leaves it under a name that begins with a dot.
    paths = (path for path in sorted((folder / FOLDER).glob("*.json")) if not path.name.startswith("."))
    found = map(read_result, paths)
    return sorted((r for r in found if r is not None and r.settings == settings), key=lambda r: (r.source, r.target))


def row(result: Result) -> dict[str, Any]:
    """The flat row of a table: times as ``seconds_…``, no curve."""
    values = asdict(result)
    seconds = values.pop("seconds")
    del values["curve"]
    values["notes"] = "; ".join(values["notes"])
    return values | {"seconds_" + name.replace(" ", "_"): time for name, time in seconds.items()}


def table(results: Iterable[Result]) -> tuple[list[str], list[dict[str, Any]]]:
    """Columns, those of :class:`Result` first and then all times, and a row for each result."""
    rows = [row(result) for result in results]
    fixed = [f.name for f in fields(Result) if f.name not in ("seconds", "curve")]
    times = dict.fromkeys(name for r in rows for name in r if name.startswith("seconds_"))
    return fixed + list(times), rows


def write_csv(path: Path, results: Iterable[Result]) -> None:
    """One row a pair; empty where something is not known. Replaces an existing file."""
    columns, rows = table(results)
    with (
        atomic_output(path, force=True) as temporary,
        open(temporary, "w", encoding="utf-8", newline="") as file,
    ):
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def write_parquet(path: Path, results: Iterable[Result]) -> None:
    """As :func:`write_csv`, with types.

    Raises
    ------
    MissingDependency
        When pyarrow is not installed.
    """
    try:
        import pyarrow as pa
        from pyarrow import parquet
    except ImportError as error:
        raise MissingDependency("Parquet needs pyarrow; install it with: pip install 'kfmaps[parquet]'") from error
    columns, rows = table(results)
    kinds = {"attempts": pa.int64(), "vertices_s": pa.int64(), "vertices_t": pa.int64(), "landmarks": pa.int64()}
    kinds |= {"solver_steps": pa.int64(), "rank": pa.int64()}
    texts = ("source", "target", "status", "settings", "inputs", "reason", "worker", "finished", "verdict", "solver")
    kinds |= dict.fromkeys((*texts, "orientation", "changed", "why", "notes"), pa.string())
    schema = pa.schema([(name, kinds.get(name, pa.float64())) for name in columns])
    with atomic_output(path, force=True) as temporary:
        parquet.write_table(pa.Table.from_pylist(rows, schema=schema), temporary)
