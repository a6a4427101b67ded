"""The progress of a run: estimates of the remaining time, and reports on the terminal and in logs."""

from __future__ import annotations

import heapq
import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeElapsedColumn
from rich.text import Text

from kfmaps._texts import format_seconds, plural
from kfmaps.batch.results import Result, describe_result
from kfmaps.cli.terminal import Terminal

_LOG, _EVENTS = "run.log", "run.jsonl"
_FIXED_VERTICES = 8000.0
"""Number of vertices that take as long as the work that does not depend on the size. From docs/performance.md: 4.1 s
for 5,000 vertices, 8.7 for 20,000, 32 for 80,000."""
_LINE_SECONDS = 30.0  # seconds between lines without a terminal


@dataclass(frozen=True)
class RunStatus:
    """The state of a run."""

    shapes_done: int
    shapes: int
    pairs_done: int
    failed: int
    pairs: int
    workers: int
    remaining: float | None  # seconds; None while no pair has been measured
    measured: int  # number of pairs that the estimate uses

    def __str__(self) -> str:
        failed = f" ({self.failed} failed)" if self.failed else ""
        shapes = f"shapes {self.shapes_done}/{self.shapes}, " if self.shapes_done < self.shapes else ""
        return f"{shapes}pairs {self.pairs_done}/{self.pairs}{failed}, {self.time_left()}"

    def time_left(self) -> str:
        """Return the remaining time in words, with the number of pairs that the estimate uses."""
        if self.pairs_done == self.pairs:
            return "finished"
        if self.remaining is None:
            return "time left: not known yet"
        basis = f"{plural(self.measured, 'pair')} and their sizes, {plural(self.workers, 'worker')}"
        return f"about {format_seconds(self.remaining)} left (from {basis})"


Callback = Callable[[RunStatus, Result | None], None]
"""Called with the state of the run and the newest result, if any."""


Log = Callable[..., None]
"""Called with the name of an event, a text, and values by name."""


@dataclass
class WorkLeft:
    """The remaining pairs, and an estimate of their time.

    A pair takes a fixed time and one proportional to its size, and each worker takes the next waiting pair. A running
    pair takes at least half its estimate longer, since it may be slower than the finished ones.
    """

    sizes: dict[int, float]  # mean number of vertices of each remaining pair, in the order of their start
    before: list[tuple[float, float]] = field(default_factory=list)  # (size, seconds) of earlier runs
    finished: list[tuple[float, float]] = field(default_factory=list)  # the same of this run

    @property
    def measured(self) -> list[tuple[float, float]]:
        """The pairs that the estimate uses."""
        return self.finished or self.before

    def end(self, number: int, seconds: float | None = None) -> None:
        """Record the end of a pair, with its ``seconds`` where they are known."""
        size = self.sizes.pop(number)
        if seconds is not None:
            self.finished.append((size, seconds))

    def remaining(self, elapsed: Mapping[int, float], workers: int) -> float | None:
        """Return the remaining seconds; ``None`` where nothing has been measured.

        ``elapsed``: seconds since the start of each running pair; ``workers``: how many run at once.
        """
        if not self.sizes:
            return 0.0
        if not self.measured:
            return None
        pace = sum(seconds for _, seconds in self.measured) / sum(size + _FIXED_VERTICES for size, _ in self.measured)
        durations = {number: pace * (size + _FIXED_VERTICES) for number, size in self.sizes.items()}
        free_at = [max(durations[number] - seconds, durations[number] / 2) for number, seconds in elapsed.items()]
        free_at += [0.0] * (workers - len(free_at))
        heapq.heapify(free_at)
        for number, seconds in durations.items():
            if number not in elapsed:
                heapq.heapreplace(free_at, free_at[0] + seconds)
        return max(free_at)


def log_to(folder: Path) -> Log:
    """Return a function that appends events with the time to both logs of an output folder.

    ``run.log`` has a line of text for each event, ``run.jsonl`` a JSON object that also has its values.
    """

    def log(event: str, text: str, **values: object) -> None:
        now, text = datetime.now(UTC).isoformat(timespec="seconds"), " ".join(text.split())
        entry = json.dumps({"time": now, "event": event, "text": text, **values})
        for name, line in ((_LOG, f"{now} {text}"), (_EVENTS, entry)):
            with open(folder / name, "a", encoding="utf-8") as file:
                file.write(line + "\n")

    return log


class RunReport:
    """A context that reports a run: by bars on a terminal, by lines elsewhere, not at all where ``quiet``.

    :meth:`status` is a :data:`Callback`, :meth:`stage` a :data:`~kfmaps._progress.CountProgress`.
    """

    def __init__(self, quiet: bool) -> None:
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
        """Show how much of a stage is done."""
        self._show(what, done, of, "", f"{what} {done}/{of}")

    def status(self, status: RunStatus, result: Result | None) -> None:
        """Show the state of the run, and the reason where the newest ``result`` is a failure."""
        if result is not None and result.status == "failed":
            self.say(describe_result(result))
        failed = f"{status.failed} failed, " if status.failed else ""
        line = f"{format_seconds(time.monotonic() - self._begun)}: {status}"
        if self._draws:
            self._show("shapes", status.shapes_done, status.shapes, "", "")
        self._show("pairs", status.pairs_done, status.pairs, failed + status.time_left(), line)

    def _show(self, name: str, done: int, of: int, note: str, line: str) -> None:
        now = time.monotonic()
        if self._draws:
            if name not in self._tasks:
                self._tasks[name] = self._bars.add_task(name, note="")
            self._bars.update(self._tasks[name], total=of, completed=done, note=note)
        elif done == of or now - self._last >= _LINE_SECONDS:
            self._last = now
            self.say(line)
