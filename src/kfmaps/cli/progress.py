"""Progress of a long computation: bars on a terminal and in a notebook, lines elsewhere."""

from __future__ import annotations

import sys
import threading
import time
from html import escape as html_escape
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from kfmaps._arrays import printable
from kfmaps._texts import format_seconds
from kfmaps.cli.terminal import Terminal

_REPEAT_SECONDS = 5.0
"""Least seconds between two lines of a stage that is repeated, as when many maps are tried."""
_LINE_SECONDS = 15.0  # seconds between two lines of a long stage without a terminal
_DRAW_SECONDS = 0.2  # least seconds between two updates in a notebook


def _time_left(done: float, elapsed: float, before: float | None = None) -> str:
    """Return the time left in words, from the part that is done, else from the duration of such a stage ``before``."""
    left = elapsed * (1 - done) / done if done >= 0.02 else (before or 0.0) - elapsed
    return f", about {format_seconds(left)} left" if left > 0 else ""


def stage_line(name: str, done: float, elapsed: float, before: float | None = None) -> str:
    """Return the state of a stage in one line."""
    part = f"{100 * done:.0f} % done, " if done > 0 else ""
    return f"{name}: {part}{format_seconds(elapsed)} so far{_time_left(done, elapsed, before)}"


class _Bars:
    """A bar for each stage on a terminal."""

    def __init__(self, console: Console) -> None:
        columns = (TextColumn("{task.description:<34}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn())
        self._bars = Progress(*columns, console=console)
        self._tasks: dict[str, TaskID] = {}
        self._bars.start()

    def update(self, name: str, done: float) -> None:
        if name not in self._tasks:
            self._tasks[name] = self._bars.add_task(escape(printable(name)), total=1.0)
        elif done <= 0:
            self._bars.reset(self._tasks[name])
        self._bars.update(self._tasks[name], completed=done)

    def close(self) -> None:
        self._bars.stop()


class Lines:
    """A line at the end of each stage, and lines at intervals during long ones, which a thread prints.

    A stage "... of target" is expected to last as long as "... of source" did.
    """

    def __init__(self, silence: float = _LINE_SECONDS) -> None:
        self._silence = silence
        self._lock = threading.Lock()
        self._started: dict[str, float] = {}
        self._done: dict[str, float] = {}
        self._durations: dict[str, float] = {}
        self._reported: dict[str, float] = {}
        self._last = time.monotonic()
        self._closed = threading.Event()
        self._watcher = threading.Thread(target=self._report_long_stages, daemon=True)
        self._watcher.start()

    def update(self, name: str, done: float) -> None:
        now = time.monotonic()
        with self._lock:
            if done <= 0 or name not in self._started:
                self._started[name] = now
            self._done[name] = done
            if done < 1:
                return
            elapsed = now - self._started[name]
            self._durations[_stage_kind(name)] = elapsed
            if now - self._reported.get(name, -_REPEAT_SECONDS) >= _REPEAT_SECONDS:
                self._reported[name] = now
                self._say(f"{name}: {elapsed:.2f} s")

    def close(self) -> None:
        self._closed.set()
        self._watcher.join()

    def _say(self, line: str) -> None:
        self._last = time.monotonic()
        print(printable(line), file=sys.stderr, flush=True)

    def _report_long_stages(self) -> None:
        while not self._closed.wait(self._silence / 10):
            with self._lock:
                now = time.monotonic()
                under_way = [name for name, done in self._done.items() if done < 1]
                if not under_way or now - self._last < self._silence:
                    continue
                name = under_way[-1]
                self._say(
                    stage_line(
                        name, self._done[name], now - self._started[name], self._durations.get(_stage_kind(name))
                    )
                )


def _stage_kind(name: str) -> str:
    """Return the name of a stage without the shape that it belongs to."""
    return name.rpartition(" of ")[0] or name


class _Notebook:
    """Bars in a notebook's cell: plain HTML, which needs nothing but IPython."""

    def __init__(self) -> None:
        from IPython.display import HTML, display  # pyright: ignore[reportMissingImports]

        self._html = HTML
        self._started: dict[str, float] = {}
        self._stages: dict[str, tuple[float, float]] = {}
        self._drawn = 0.0
        self._place: Any = display(HTML(""), display_id=True)

    def update(self, name: str, done: float) -> None:
        now = time.monotonic()
        if done <= 0 or name not in self._started:
            self._started[name] = now
        self._stages[name] = (done, now - self._started[name])
        if done >= 1 or now - self._drawn >= _DRAW_SECONDS:
            self._draw()

    def close(self) -> None:
        self._draw()

    def _draw(self) -> None:
        self._drawn = time.monotonic()
        if self._place is not None:
            self._place.update(self._html(_bars_html(self._stages)))


def _bars_html(stages: dict[str, tuple[float, float]]) -> str:
    """Return a table of bars: for each stage how much of it is done, from 0 to 1, and its seconds."""
    rows = []
    for name, (done, elapsed) in stages.items():
        bar = f'<progress max="1" value="{done:.3f}"></progress>'
        times = format_seconds(elapsed) + _time_left(done, elapsed)
        rows.append(f"<tr><td>{html_escape(name)}</td><td>{bar}</td><td>{times}</td></tr>")
    return f"<table>{''.join(rows)}</table>"


class Stages:
    """A context and a progress callback ``stages(name, done)``, ``done`` from 0 to 1, that shows bars or lines.

    ``quiet``: whether nothing is shown.
    """

    def __init__(self, quiet: bool = False) -> None:
        self._quiet = quiet
        self._display: _Bars | Lines | _Notebook | None = None

    def __enter__(self) -> Stages:
        console = Terminal(file=sys.stderr)
        if console.is_jupyter and not self._quiet:
            self._display = _Notebook()
        elif not self._quiet:
            self._display = _Bars(console) if console.is_terminal else Lines()
        return self

    def __exit__(self, *_: object) -> None:
        if self._display is not None:
            self._display.close()

    def __call__(self, name: str, done: float) -> None:
        if self._display is not None:
            self._display.update(name, min(max(done, 0.0), 1.0))
