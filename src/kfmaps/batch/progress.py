"""How a run stands: how long the rest will take, what it says on the terminal and in its log."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeElapsedColumn
from rich.text import Text

from kfmaps.batch.results import Result
from kfmaps.cli.terminal import Terminal
from kfmaps.cli.words import format_seconds

_LOG = "run.log"
_LINE_SECONDS = 30.0  # seconds between lines where there is no terminal


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
        return f"about {format_seconds(self.remaining)} left (mean of {pairs} measured, {workers})"


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


def log_to(folder: Path) -> Callable[[str], None]:
    """Return a function that appends a line with the time to the log of an output folder."""

    def log(line: str) -> None:
        with open(folder / _LOG, "a", encoding="utf-8") as file:
            file.write(f"{datetime.now(UTC).isoformat(timespec='seconds')} {' '.join(line.split())}\n")

    return log


def failure_line(result: Result) -> str:
    """Return a failed pair in one line."""
    return f"failed: {result.source} → {result.target}: {result.reason}"


class RunReport:
    """Reports of a run: bars on a terminal, now and then a line elsewhere, nothing where ``quiet``.

    A context: while it lasts, :meth:`status` is a :data:`Callback` and :meth:`stage` a
    :data:`~kfmaps._progress.CountProgress`.
    """

    def __init__(self, quiet: bool = False) -> None:
        self._quiet, self._console = quiet, Terminal(highlight=False)
        self._draws = self._console.is_terminal and not quiet
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        note = TextColumn("{task.fields[note]}", markup=False)
        self._bars = Progress(*columns, note, console=self._console)
        self._tasks: dict[str, TaskID] = {}
        self._begun, self._last = time.monotonic(), -float("inf")

    def __enter__(self) -> RunReport:
        if self._draws:
            self._bars.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._draws:
            self._bars.stop()

    def say(self, line: str) -> None:
        """Print a line."""
        if not self._quiet:
            self._console.print(Text(line), soft_wrap=True)

    def stage(self, what: str, done: int, of: int) -> None:
        """Tell how much of a stage is done."""
        self._tell(what, done, of, "", f"{what} {done}/{of}")

    def status(self, status: RunStatus, result: Result | None) -> None:
        """Tell how the run stands, and the reason where the ``result`` that has just come is a failure."""
        if result is not None and result.status == "failed":
            self.say(failure_line(result))
        failed = f"{status.failed} failed, " if status.failed else ""
        line = f"{format_seconds(time.monotonic() - self._begun)}: {status}"
        if self._draws:
            self._tell("shapes", status.shapes_done, status.shapes, "", "")
        self._tell("pairs", status.pairs_done, status.pairs, failed + status.time_left(), line)

    def _tell(self, name: str, done: int, of: int, note: str, line: str) -> None:
        now = time.monotonic()
        if self._draws:
            if name not in self._tasks:
                self._tasks[name] = self._bars.add_task(name, note="")
            self._bars.update(self._tasks[name], total=of, completed=done, note=note)
        elif done == of or now - self._last >= _LINE_SECONDS:
            self._last = now
            self.say(line)
