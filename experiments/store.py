"""Run many jobs in parallel processes and keep each result, so that a run that was stopped continues.

Results are lines of a text file, ``{"key": …, "value": …}`` in JSON. A key says everything that its value depends on.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import track
from threadpoolctl import threadpool_limits

from kfmaps._threads import available_cores


@dataclass(frozen=True)
class Job:
    """A call ``function(*arguments)`` that returns a list with one JSON value for each of ``keys``."""

    keys: tuple[str, ...]
    function: Callable[..., Sequence[Any]]
    arguments: tuple[Any, ...]


def read_store(store: Path) -> dict[str, Any]:
    """Return the values in ``store`` by key, without lines that a crash cut short."""
    values = {}
    for line in store.read_text(encoding="utf-8", errors="replace").splitlines() if store.is_file() else ():
        try:
            entry = json.loads(line)
            values[entry["key"]] = entry["value"]
        except (ValueError, TypeError, KeyError):
            continue
    return values


def run_jobs(jobs: Sequence[Job], store: Path, workers: int | None = None) -> dict[str, Any]:
    """Return the value of every key; jobs whose keys are all in ``store`` are not run.

    ``workers`` is the number of processes, each with one BLAS thread; ``None``: one for each core, 1: no other process.
    """
    values = read_store(store)
    missing = [job for job in jobs if any(key not in values for key in job.keys)]
    results = _run(missing, workers or available_cores())
    for job, found in track(results, "measuring", len(missing), console=Console(stderr=True), transient=True):
        entries = dict(zip(job.keys, found, strict=True))
        lines = (json.dumps({"key": key, "value": value}) for key, value in entries.items())
        with store.open("a", encoding="utf-8") as file:
            # On lines of their own, even after one that was cut short.
            file.write("".join(f"\n{line}" for line in lines))
        values.update(entries)
    return {key: values[key] for job in jobs for key in job.keys}


def _run(jobs: Sequence[Job], workers: int) -> Iterator[tuple[Job, Sequence[Any]]]:
    """Yield jobs and their results as they finish."""
    if workers == 1 or len(jobs) < 2:
        with threadpool_limits(1):
            for job in jobs:
                yield job, job.function(*job.arguments)
        return
    # Spawned, not forked: a fork copies locks that BLAS threads of the parent may hold.
    context = get_context("spawn")
    with ProcessPoolExecutor(min(workers, len(jobs)), context, initializer=threadpool_limits, initargs=(1,)) as pool:
        try:
            waiting = {pool.submit(job.function, *job.arguments): job for job in jobs}
            for future in as_completed(waiting):
                yield waiting[future], future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
