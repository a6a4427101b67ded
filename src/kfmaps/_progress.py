"""Progress callbacks of long work, and a timer of its stages."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[str, float], None]
"""Called with the name of a stage and how much of it is done, from 0 to 1."""

StageProgress = Callable[[float], None]
"""Called with how much of one stage is done, from 0 to 1."""

CountProgress = Callable[[str, int, int], None]
"""Called with the name of the work, how many items are done, and how many there are."""


class StageTimer:
    """Measures stages: calls ``progress`` at the start and end of each, and keeps its ``seconds``."""

    def __init__(self, progress: Progress | None = None) -> None:
        self.report: Progress = progress or (lambda _stage, _done: None)
        self.seconds: dict[str, float] = {}

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        begin = time.perf_counter()
        self.report(stage, 0.0)
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + time.perf_counter() - begin
        self.report(stage, 1.0)
