"""What a run says on the terminal: bars where there is one, now and then a line where there is not."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.text import Text

from kfmaps.app.batch.clock import Standing, in_words
from kfmaps.app.batch.results import Result
from kfmaps.app.batch.run import Tell

EVERY = 30.0
"""Seconds between lines where there is no terminal."""


def left_in_words(standing: Standing) -> str:
    """The remaining time, and what it rests on."""
    left = standing.pairs - standing.pairs_done
    if left == 0:
        return "all matched"
    if standing.remaining is None:
        return "time left: known after the first pair"
    pairs = "1 pair" if standing.measured == 1 else f"{standing.measured} pairs"
    workers = "1 worker" if standing.workers == 1 else f"{standing.workers} workers"
    return f"about {in_words(standing.remaining)} left (mean of {pairs} measured, {workers})"


def line(standing: Standing) -> str:
    """How a run stands, in one line."""
    failed = f" ({standing.failed} failed)" if standing.failed else ""
    shapes = f"shapes {standing.shapes_done}/{standing.shapes}, " if standing.shapes_done < standing.shapes else ""
    return f"{shapes}pairs {standing.pairs_done}/{standing.pairs}{failed}, {left_in_words(standing)}"


@contextmanager
def telling(console: Console, quiet: bool = False) -> Iterator[Tell | None]:
    """Something to hand to :func:`~kfmaps.app.batch.run.run_plan` as ``tell``; ``None`` when ``quiet``."""
    if quiet:
        yield None
    elif console.is_terminal:
        with _bars(console) as tell:
            yield tell
    else:
        yield _lines(console)


@contextmanager
def _bars(console: Console) -> Iterator[Tell]:
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, TextColumn("{task.fields[note]}", markup=False), console=console) as progress:
        shapes = progress.add_task("shapes", total=None, note="")
        pairs = progress.add_task("pairs ", total=None, note="")

        def tell(standing: Standing, result: Result | None) -> None:
            progress.update(shapes, total=standing.shapes, completed=standing.shapes_done)
            failed = f"{standing.failed} failed, " if standing.failed else ""
            note = failed + left_in_words(standing)
            progress.update(pairs, total=standing.pairs, completed=standing.pairs_done, note=note)
            if result is not None and result.status == "failed":
                progress.console.print(Text(failure(result)), soft_wrap=True)

        yield tell


def _lines(console: Console) -> Tell:
    begun = time.monotonic()
    last = begun - EVERY

    def tell(standing: Standing, result: Result | None) -> None:
        nonlocal last
        if result is not None and result.status == "failed":
            console.print(Text(failure(result)), soft_wrap=True)
        if time.monotonic() - last >= EVERY or standing.pairs_done == standing.pairs:
            last = time.monotonic()
            console.print(Text(f"{in_words(last - begun)}: {line(standing)}"), soft_wrap=True)

    return tell


def failure(result: Result) -> str:
    """A failed pair in one line."""
    return f"failed: {result.source} → {result.target}: {result.reason}"
