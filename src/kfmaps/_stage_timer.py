"""Stages of the work: told as they begin and end, and timed."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from kfmaps._progress import Progress


class StageTimer:
    """Tells ``progress`` of each stage and keeps its seconds.

    Attributes
    ----------
    report : callable
        ``progress``, or one that does nothing.
    seconds : dict of str to float
        Of the stages that are done.
    """

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
