"""What a long command is doing, told on standard error: bars on a terminal, a line per stage elsewhere."""

from __future__ import annotations

import sys
import time
from types import TracebackType

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

SECONDS_BETWEEN_LINES = 5.0
"""A stage that is begun again and again, as when many maps are tried, is told at most this often."""


class Stages:
    """``stages(name, done)`` for a computation that reports its stages, ``done`` from 0 to 1.

    Parameters
    ----------
    quiet : bool
        Say nothing.
    """

    def __init__(self, quiet: bool = False) -> None:
        self._console = Console(file=sys.stderr)
        self._quiet = quiet
        self._bars: Progress | None = None
        self._tasks: dict[str, TaskID] = {}
        self._begun: dict[str, float] = {}
        self._told: dict[str, float] = {}

    def __enter__(self) -> Stages:
        if not self._quiet and self._console.is_terminal:
            columns = (TextColumn("{task.description:<34}"), BarColumn(), TimeElapsedColumn())
            self._bars = Progress(*columns, console=self._console)
            self._bars.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bars is not None:
            self._bars.stop()

    def __call__(self, name: str, done: float) -> None:
        if self._quiet:
            return
        if self._bars is not None:
            self._draw(self._bars, name, done)
            return
        now = time.monotonic()
        if done <= 0 or name not in self._begun:
            self._begun[name] = now
        if done >= 1 and now - self._told.get(name, -SECONDS_BETWEEN_LINES) >= SECONDS_BETWEEN_LINES:
            self._told[name] = now
            print(f"{name}: {now - self._begun[name]:.2f} s", file=sys.stderr)

    def _draw(self, bars: Progress, name: str, done: float) -> None:
        if name not in self._tasks:
            self._tasks[name] = bars.add_task(escape(name), total=1.0)
        elif done <= 0:
            bars.reset(self._tasks[name])
        bars.update(self._tasks[name], completed=min(max(done, 0.0), 1.0))
