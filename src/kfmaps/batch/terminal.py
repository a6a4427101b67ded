"""What a run says on the terminal: bars where there is one, now and then a line where there is not."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.text import Text

from kfmaps.batch.clock import RunStatus
from kfmaps.batch.results import Result
from kfmaps.batch.run import Callback
from kfmaps.batch.spread import Told
from kfmaps.cli.words import in_words

EVERY = 30.0
"""Seconds between lines where there is no terminal."""


def left_in_words(status: RunStatus) -> str:
    """The remaining time, and what it rests on."""
    left = status.pairs - status.pairs_done
    if left == 0:
        return "all matched"
    if status.remaining is None:
        return "time left: known after the first pair"
    pairs = "1 pair" if status.measured == 1 else f"{status.measured} pairs"
    workers = "1 worker" if status.workers == 1 else f"{status.workers} workers"
    return f"about {in_words(status.remaining)} left (mean of {pairs} measured, {workers})"


def line(status: RunStatus) -> str:
    """How a run stands, in one line."""
    failed = f" ({status.failed} failed)" if status.failed else ""
    shapes = f"shapes {status.shapes_done}/{status.shapes}, " if status.shapes_done < status.shapes else ""
    return f"{shapes}pairs {status.pairs_done}/{status.pairs}{failed}, {left_in_words(status)}"


@contextmanager
def terminal_callback(console: Console, quiet: bool = False) -> Iterator[Callback | None]:
    """Something to hand to :func:`~kfmaps.batch.run.run_plan` as ``callback``; ``None`` when ``quiet``."""
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
            failed = f"{status.failed} failed, " if status.failed else ""
            note = failed + left_in_words(status)
            progress.update(pairs, total=status.pairs, completed=status.pairs_done, note=note)
            if result is not None and result.status == "failed":
                progress.console.print(Text(failure(result)), soft_wrap=True)

        yield callback


def _lines(console: Console) -> Callback:
    begun = time.monotonic()
    last = begun - EVERY

    def callback(status: RunStatus, result: Result | None) -> None:
        nonlocal last
        if result is not None and result.status == "failed":
            console.print(Text(failure(result)), soft_wrap=True)
        if time.monotonic() - last >= EVERY or status.pairs_done == status.pairs:
            last = time.monotonic()
            console.print(Text(f"{in_words(last - begun)}: {line(status)}"), soft_wrap=True)

    return callback


@contextmanager
def stage_lines(console: Console, quiet: bool = False) -> Iterator[Told | None]:
    """Something to hand to :func:`~kfmaps.batch.spread.crew` as ``told``: now and then a line."""
    if quiet:
        yield None
        return
    last = 0.0

    def told(what: str, done: int, of: int) -> None:
        nonlocal last
        if time.monotonic() - last >= EVERY or done == of:
            last = time.monotonic()
            console.print(Text(f"{what} {done}/{of}"), soft_wrap=True)

    yield told


def failure(result: Result) -> str:
    """A failed pair in one line."""
    return f"failed: {result.source} → {result.target}: {result.reason}"
