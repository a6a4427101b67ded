"""Long work in small pieces: parallel over processes, kept as it finishes, resumed where it stopped.

Finished pieces lie in one text file, a JSON object a line: ``{"key": …, "value": …}``. Lines are appended in one
write; one that a crash cut short is passed over. A key says everything that the value depends on.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
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
    """What one process does at a time.

    ``function(*arguments)``, which a worker process must be able to import, returns a JSON value for each of
    ``keys``.
    """

    keys: tuple[str, ...]
    function: Callable[..., Sequence[Any]]
    arguments: tuple[Any, ...]


def read_store(store: Path) -> dict[str, Any]:
    """What ``store`` holds, by key; nothing when there is no such file."""
    if not store.is_file():
        return {}
    found = {}
    for line in store.read_text(encoding="utf-8", errors="replace").splitlines():
        try:
            entry = json.loads(line)
            found[entry["key"]] = entry["value"]
        except (ValueError, TypeError, KeyError):
            continue  # cut short; its work is done again
    return found


def append_store(store: Path, entries: Mapping[str, Any]) -> None:
    """Add ``entries`` to ``store`` in one write, on lines of their own even after a line that was cut short."""
    text = "".join(json.dumps({"key": key, "value": value}) + "\n" for key, value in entries.items())
    handle = os.open(store, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
    try:
        size = os.fstat(handle).st_size
        if size:
            os.lseek(handle, size - 1, os.SEEK_SET)
            if os.read(handle, 1) != b"\n":
                text = "\n" + text
        os.write(handle, text.encode())
        os.fsync(handle)
    finally:
        os.close(handle)


def run_jobs(jobs: Sequence[Job], store: Path, *, workers: int | None = None) -> dict[str, Any]:
    """The value of every key of ``jobs``; a job all of whose keys ``store`` already holds is not run.

    Parameters
    ----------
    jobs : sequence of Job
    store : Path
        In an existing folder.
    workers : int, optional
        Processes, each with BLAS at one thread; ``None`` takes every core. With 1 no process is started.
    """
    known = read_store(store)
    missing = [job for job in jobs if any(key not in known for key in job.keys)]
    done = _finished(missing, workers or available_cores())
    for job, values in track(done, "measuring", len(missing), console=Console(stderr=True), transient=True):
        entries = dict(zip(job.keys, values, strict=True))
        append_store(store, entries)
        known.update(entries)
    return {key: known[key] for job in jobs for key in job.keys}


def _finished(jobs: Sequence[Job], workers: int) -> Iterable[tuple[Job, Sequence[Any]]]:
    """Jobs and their results, as they come."""
    if workers == 1 or len(jobs) < 2:
        with threadpool_limits(1):
            for job in jobs:
                yield job, job.function(*job.arguments)
        return
    # Spawned, not forked: a fork copies locks that BLAS threads of the parent may hold.
    pool = ProcessPoolExecutor(min(workers, len(jobs)), mp_context=get_context("spawn"), initializer=_one_thread)
    with pool:
        try:
            waiting = {pool.submit(job.function, *job.arguments): job for job in jobs}
            for future in as_completed(waiting):
                yield waiting[future], future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _one_thread() -> None:
    threadpool_limits(1)
