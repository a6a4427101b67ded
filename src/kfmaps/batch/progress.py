"""How a run stands: what it will need, how long the rest will take, what it says on the terminal and in its log."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.text import Text

from kfmaps.batch.jobs import ProgressCallback
from kfmaps.batch.results import Result
from kfmaps.cli.words import in_words
from kfmaps.config import Config

LOG = "run.log"
LINE_SECONDS = 30.0
"""Seconds between lines where there is no terminal."""
SHOT_SIZE = 352
"""Numbers of SHOT at each vertex."""
SAMPLE_BYTES, MAP_BYTES = 6e6, 230.0
"""Disk: what a search keeps of one shape, whatever its size; a map's file for each target vertex."""
WORKER_BYTES, VERTEX_BYTES = 0.22e9, 42e3
"""Memory of a worker, and for each vertex of a shape: 0.43 GB was measured with 5,000."""
PREPARE_SECONDS, SEARCH_SECONDS, FIT_SECONDS, AGREE_SECONDS = 0.6e-3, 1.8e-3, 0.5e-3, 0.18e-3
"""CPU seconds for each vertex: of a shape, and of a pair by a search, by one fit, and to make the maps agree. Measured
on shapes of 5,000 vertices; machines differ."""
MIN_SEARCH_SECONDS = 2.0


@dataclass(frozen=True)
class RunStatus:
    """How a run stands: shapes prepared, pairs done and failed, and the ``remaining`` seconds.

    ``remaining`` is ``None`` while nothing has been measured; it rests on ``measured`` pairs.
    """

    shapes_done: int
    shapes: int
    pairs_done: int
    failed: int
    pairs: int
    workers: int
    remaining: float | None
    measured: int

    def __str__(self) -> str:
        failed = f" ({self.failed} failed)" if self.failed else ""
        shapes = f"shapes {self.shapes_done}/{self.shapes}, " if self.shapes_done < self.shapes else ""
        return f"{shapes}pairs {self.pairs_done}/{self.pairs}{failed}, {self.time_left()}"

    def time_left(self) -> str:
        """The remaining time, and what it rests on."""
        if self.pairs_done == self.pairs:
            return "finished"
        if self.remaining is None:
            return "time left: known after the first pair"
        pairs = "1 pair" if self.measured == 1 else f"{self.measured} pairs"
        workers = "1 worker" if self.workers == 1 else f"{self.workers} workers"
        return f"about {in_words(self.remaining)} left (mean of {pairs} measured, {workers})"


Callback = Callable[[RunStatus, Result | None], None]
"""Called with how the run stands, and with the result that has just come, if one has."""


def remaining_seconds(
    shape_seconds: Sequence[float], pair_seconds: Sequence[float], shapes_left: int, pairs_left: int, workers: int
) -> float | None:
    """Return what is left of each kind at its mean measured time, shared out between the workers.

    Work that is under way counts as if it had not begun, so the estimate is rather too long. It is never less than the
    time of one pair while a pair is left, and ``None`` when there is something left of which nothing was measured.
    """
    total = longest = 0.0
    for left, seconds in ((shapes_left, shape_seconds), (pairs_left, pair_seconds)):
        if left and not seconds:
            return None
        if left:
            mean = sum(seconds) / len(seconds)
            total += left * mean
            longest += mean if pairs_left else 0.0
    return max(total / workers, longest)


@dataclass(frozen=True)
class Estimate:
    """What a run will need: bytes on ``disk`` and of ``memory`` of all workers together, and ``seconds``."""

    disk: float
    memory: float
    seconds: float

    def __str__(self) -> str:
        return f"{_size(self.disk)} on disk, {_size(self.memory)} of memory and {in_words(self.seconds)}"


def estimate(
    shapes: int, pairs: int, vertices: int, config: Config, workers: int, *, consistent: bool = False
) -> Estimate:
    """Estimate what ``pairs`` of ``shapes`` of about ``vertices`` vertices need; linear in all of them.

    Maps that are made to agree in the end (``consistent``) are scored by what a search would know of the shapes.
    """
    searched = config.search is not None
    shape = 8.0 * vertices * (config.n_eigenfunctions + SHOT_SIZE * config.descriptors.shot)
    disk = shapes * (shape + SAMPLE_BYTES * (searched or consistent)) + pairs * MAP_BYTES * vertices
    each = max(SEARCH_SECONDS * vertices, MIN_SEARCH_SECONDS) if searched else FIT_SECONDS * vertices
    each += AGREE_SECONDS * vertices if consistent else 0.0
    total = pairs * each + shapes * PREPARE_SECONDS * vertices
    memory = workers * (WORKER_BYTES + VERTEX_BYTES * vertices)
    return Estimate(disk, memory, total / max(min(workers, pairs), 1))


def _size(count: float) -> str:
    return f"{count / 1e9:.1f} GB" if count >= 1e8 else f"{count / 1e6:.0f} MB"


def log_to(folder: Path) -> Callable[[str], None]:
    """Return a function that appends a line with the time to the log of an output folder."""

    def log(line: str) -> None:
        with open(folder / LOG, "a", encoding="utf-8") as file:
            file.write(f"{datetime.now(UTC).isoformat(timespec='seconds')} {' '.join(line.split())}\n")

    return log


def failure_line(result: Result) -> str:
    """A failed pair in one line."""
    return f"failed: {result.source} → {result.target}: {result.reason}"


@contextmanager
def terminal_callback(console: Console, quiet: bool = False) -> Iterator[Callback | None]:
    """A callback for a run: bars on a terminal, now and then a line elsewhere, ``None`` when ``quiet``."""
    if quiet:
        yield None
    elif console.is_terminal:
        with _bars(console) as callback:
            yield callback
    else:
        yield _lines(console)


@contextmanager
def _bars(console: Console) -> Iterator[Callback]:
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, TextColumn("{task.fields[note]}", markup=False), console=console) as progress:
        shapes = progress.add_task("shapes", total=None, note="")
        pairs = progress.add_task("pairs ", total=None, note="")

        def callback(status: RunStatus, result: Result | None) -> None:
            progress.update(shapes, total=status.shapes, completed=status.shapes_done)
            note = (f"{status.failed} failed, " if status.failed else "") + status.time_left()
            progress.update(pairs, total=status.pairs, completed=status.pairs_done, note=note)
            if result is not None and result.status == "failed":
                progress.console.print(Text(failure_line(result)), soft_wrap=True)

        yield callback


def _lines(console: Console) -> Callback:
    begun = time.monotonic()
    due = _due()

    def callback(status: RunStatus, result: Result | None) -> None:
        if result is not None and result.status == "failed":
            console.print(Text(failure_line(result)), soft_wrap=True)
        if due(status.pairs_done == status.pairs):
            console.print(Text(f"{in_words(time.monotonic() - begun)}: {status}"), soft_wrap=True)

    return callback


def stage_lines(console: Console, quiet: bool = False) -> ProgressCallback | None:
    """A callback for :class:`~kfmaps.batch.jobs.WorkerPool` that prints a line now and then; ``None`` if ``quiet``."""
    due = _due()

    def progress(what: str, done: int, of: int) -> None:
        if due(done == of):
            console.print(Text(f"{what} {done}/{of}"), soft_wrap=True)

    return None if quiet else progress


def _due() -> Callable[[bool], bool]:
    """Whether it is time for a line: at the end, at first, and every :data:`LINE_SECONDS`."""
    last = -float("inf")

    def due(ended: bool) -> bool:
        nonlocal last
        now = time.monotonic()
        if ended or now - last >= LINE_SECONDS:
            last = now
            return True
        return False

    return due
