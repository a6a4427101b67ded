"""Matches of two shapes with other landmarks again and again: one at a time, watched and cancelled from outside."""

from __future__ import annotations

import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import InvalidInput, NotConverged, refuse
from kfmaps._progress import Progress
from kfmaps.config import Config
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.mapfile import with_files
from kfmaps.matching.match import match
from kfmaps.matching.result import Match
from kfmaps.shape import Shape, prepare


class InteractiveMatcher:
    """``matcher(landmarks, progress)``: the map of two shapes with these landmarks; each shape is prepared once.

    ``names`` is how messages call the shapes, ``paths`` are their files, which the saved map names.
    """

    def __init__(
        self, meshes: tuple[Mesh, Mesh], names: tuple[str, str], paths: tuple[Path, Path], config: Config
    ) -> None:
        self._meshes, self._names, self._paths, self._config = meshes, names, paths, config
        self._shapes: list[Shape] = []

    def __call__(self, landmarks: np.ndarray, progress: Progress) -> Match:
        for mesh, name in list(zip(self._meshes, self._names, strict=True))[len(self._shapes) :]:
            self._shapes.append(prepare(mesh, self._config, name=name, progress=progress))
        pairs = landmarks if len(landmarks) else None
        found = match(*self._shapes, config=self._config, landmarks=pairs, progress=progress)
        return with_files(found, self._paths, self._meshes)


class _Cancelled(Exception):
    """Raised through the progress call to leave a match that nobody wants any more."""


@dataclass(frozen=True)
class MatchStatus:
    """How a run stands."""

    run: int = 0  # its number, from 1; 0 before the first
    state: str = "idle"
    stage: str = ""  # what it is doing
    fraction: float = 0.0  # how much of that is done, from 0 to 1
    seconds: float = 0.0  # since it began, or what it took
    error: str = ""  # why it failed


class Runs:
    """Runs ``work(argument, progress)`` in a thread and keeps the last result."""

    def __init__(self, work: Callable[[Any, Progress], object]) -> None:
        self._work = work
        self._lock = threading.Lock()
        self._cancel = threading.Event()
        self._status = MatchStatus()
        self._began = 0.0
        self._thread: threading.Thread | None = None
        self._result: object = None

    def start(self, argument: Any) -> MatchStatus:
        """Begin a run."""
        with self._lock:
            if self._status.state == "running":
                raise refuse("match", "one run at a time", "a run that has not ended", "wait, or cancel it")
            self._cancel.clear()
            self._began = time.monotonic()
            self._status = MatchStatus(run=self._status.run + 1, state="running", stage="starting")
            self._thread = threading.Thread(target=self._run, args=(argument,), daemon=True)
            self._thread.start()
        return self.status()

    def status(self) -> MatchStatus:
        """Return how the last run stands now."""
        with self._lock:
            if self._status.state == "running":
                return replace(self._status, seconds=time.monotonic() - self._began)
            return self._status

    def result(self) -> object:
        """Return what the last run that was done returned; ``None`` before."""
        with self._lock:
            return self._result

    def cancel(self, wait: float = 0.0) -> None:
        """Ask the run to stop at its next progress call; wait for that at most ``wait`` seconds."""
        self._cancel.set()
        thread = self._thread
        if thread is not None and wait:
            thread.join(wait)

    def _progress(self, stage: str, fraction: float) -> None:
        if self._cancel.is_set():
            raise _Cancelled
        with self._lock:
            self._status = replace(self._status, stage=str(stage), fraction=min(max(float(fraction), 0.0), 1.0))

    def _run(self, argument: Any) -> None:
        result, state, error = None, "done", ""
        try:
            result = self._work(argument, self._progress)
        except _Cancelled:
            state = "cancelled"
        except (InvalidInput, NotConverged, ImportError, OSError, MemoryError) as problem:
            state, error = "failed", str(problem) or type(problem).__name__
        except Exception as problem:  # a defect: the page shows it, the terminal where it was
            traceback.print_exc()
            state, error = "failed", f"{type(problem).__name__}: {problem}"
        with self._lock:
            seconds = time.monotonic() - self._began
            self._status = replace(self._status, state=state, error=error, seconds=seconds)
            if state == "done":
                self._result = result
