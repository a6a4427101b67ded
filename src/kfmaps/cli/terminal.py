"""What is printed for people: whatever a name holds, no control character reaches the terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import Any

from rich.console import Console, ConsoleOptions, ConsoleRenderable, RenderHook, RenderResult
from rich.segment import Segment

from kfmaps._arrays import shown


class Terminal(Console):
    """A :class:`rich.console.Console` that shows control characters in texts as such; styles stay what they are."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.push_render_hook(_Shown())


class _Shown(RenderHook):
    def process_renderables(self, renderables: list[ConsoleRenderable]) -> list[ConsoleRenderable]:
        return [_Plain(renderable) for renderable in renderables]


class _Plain:
    """Something to draw, its letters all printable."""

    def __init__(self, inside: ConsoleRenderable) -> None:
        self.inside = inside

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        yield from _printable(console.render(self.inside, options))


def _printable(segments: Iterable[Segment]) -> Iterable[Segment]:
    for text, style, control in segments:
        lines = text if control else "\n".join(map(shown, text.split("\n")))
        yield Segment(lines, style, control)


def say(text: str, error: bool = False) -> None:
    """One line on standard output, or on standard error."""
    print(shown(text), file=sys.stderr if error else sys.stdout)
