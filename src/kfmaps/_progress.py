"""How long work tells of its progress, and how long its stages take."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[str, float], None]
"""Called with a stage's name and how much of it is done, from 0 to 1."""

Done = Callable[[float], None]
"""Called with how much of one stage is done, from 0 to 1."""

CountProgress = Callable[[str, int, int], None]
"""Called with what is done, how many are done, and how many there are."""


class StageTimer:
    """Tells ``progress`` of each stage, as ``report`` does, and keeps the ``seconds`` of those that are done."""

    def __init__(self, progress: Progress | None = None) -> None:
        self.report: Progress = progress or (lambda _stage, _done: None)
        self.seconds: dict[str, float] = {}

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        begin = time.perf_counter()
        self.report(stage, 0.0)
        yield
        self.seconds[stage] = time.perf_counter() - begin
        self.report(stage, 1.0)
