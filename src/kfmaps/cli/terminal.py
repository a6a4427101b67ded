"""Print on a terminal; control characters in names never reach it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rich.console import Console, ConsoleOptions, ConsoleRenderable, RenderHook, RenderResult
from rich.segment import Segment

from kfmaps._arrays import printable


class Terminal(Console):
    """A :class:`rich.console.Console` that prints the codes of control characters in texts; styles stay."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.push_render_hook(_PrintableHook())


class _PrintableHook(RenderHook):
    def process_renderables(self, renderables: list[ConsoleRenderable]) -> list[ConsoleRenderable]:
        return [_Printable(renderable) for renderable in renderables]


class _Printable:
    """A renderable with codes in place of characters that cannot be printed."""

    def __init__(self, inside: ConsoleRenderable) -> None:
        self.inside = inside

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        for text, style, control in console.render(self.inside, options):
            yield Segment(text if control else "\n".join(map(printable, text.split("\n"))), style, control)


def print_line(text: str) -> None:
    """Print one line on standard output."""
    print(printable(text))


def print_json(values: object) -> None:
    """Print one line of JSON on standard output; paths as text."""
    print(json.dumps(values, default=str))


def report_files(*paths: Path | None, as_json: bool) -> None:
    """Print the written files as JSON where ``as_json``, else nothing."""
    if as_json:
        print_json({"output": [path for path in paths if path is not None]})
