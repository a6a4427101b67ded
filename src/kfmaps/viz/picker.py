"""The landmark picker: a local page on which pairs of points are clicked, saved and tried out in matches.

One match runs at a time, watched and cancelled from the page.
"""

from __future__ import annotations

import threading
import time
import traceback
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import InvalidInput, NotConverged, refuse
from kfmaps._progress import Progress
from kfmaps._records import JsonObject
from kfmaps._texts import plural
from kfmaps.config import Config
from kfmaps.descriptors.spectral import check_landmarks
from kfmaps.fmap.confidence import local_confidence
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import check_map, save_map, write_landmarks
from kfmaps.io.mapfile import with_files
from kfmaps.matching.match import match
from kfmaps.matching.result import Match
from kfmaps.shape import Shape, prepare
from kfmaps.viz.document import document, encode_floats
from kfmaps.viz.page import check_up, map_record, shape_record, source_record, verdict_record, views_record
from kfmaps.viz.server import LocalServer, Reply, json_reply, page_reply

_Matcher = Callable[[np.ndarray, Progress], Match]
"""Returns the map to save, from landmarks (l, 2) and a progress callback."""

_MAX_NAME = 60  # letters of a landmark's name


class InteractiveMatcher:
    """A function of landmarks and progress that matches two shapes; each shape is prepared once.

    ``names``: of the shapes in messages; ``paths``: their files, which the saved map names.
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
        result = match(*self._shapes, config=self._config, landmarks=pairs, progress=progress)
        return with_files(result, self._paths, self._meshes)


class _Cancelled(Exception):
    """Raised in the progress callback to end a cancelled match."""


@dataclass(frozen=True)
class MatchStatus:
    """The state of a run."""

    run: int = 0  # its number, from 1; 0 before the first
    state: str = "idle"
    stage: str = ""  # the current one
    fraction: float = 0.0  # of the stage that is done, from 0 to 1
    seconds: float = 0.0  # since the start, or of the whole run
    error: str = ""  # reason of a failure


class Runs:
    """Run ``work(argument, progress)`` in a thread, one run at a time, and keep the last result."""

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
                raise refuse("match", "one run at a time", "a second one", "wait for the first, or cancel it")
            self._cancel.clear()
            self._began = time.monotonic()
            self._status = MatchStatus(run=self._status.run + 1, state="running", stage="starting")
            self._thread = threading.Thread(target=self._run, args=(argument,), daemon=True)
            self._thread.start()
        return self.status()

    def status(self) -> MatchStatus:
        """Return the state of the last run."""
        with self._lock:
            if self._status.state == "running":
                return replace(self._status, seconds=time.monotonic() - self._began)
            return self._status

    def result(self) -> object:
        """Return the result of the last run that was finished; ``None`` before."""
        with self._lock:
            return self._result

    def cancel(self, wait: float = 0.0) -> None:
        """Stop the run at its next progress call; wait for that at most ``wait`` seconds."""
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
        except Exception as problem:  # a defect: the page shows the error, the terminal its traceback
            traceback.print_exc()
            state, error = "failed", f"{type(problem).__name__}: {problem}"
        with self._lock:
            seconds = time.monotonic() - self._began
            self._status = replace(self._status, state=state, error=error, seconds=seconds)
            if state == "done":
                self._result = result


def check_pairs(pairs: object, source: Mesh, target: Mesh) -> np.ndarray:
    """Return landmarks (l, 2) int64, a vertex of ``source`` and one of ``target`` each."""
    if not isinstance(pairs, list) or not all(
        isinstance(pair, list) and len(pair) == 2 and all(type(v) is int for v in pair) for pair in pairs
    ):
        remedy = "give pairs of 0-based vertex numbers, source first"
        raise refuse("landmarks", "a list of pairs of whole numbers", "something else", remedy)
    landmarks = np.array(pairs).reshape(-1, 2)
    for column, mesh, side in zip(landmarks.T, (source, target), ("source", "target"), strict=True):
        check_landmarks(column, len(mesh.vertices), f"landmarks on the {side}")
    return landmarks.astype(np.int64)


@dataclass(eq=False)
class PickerServer(LocalServer):
    """The server of the picker's page: it answers a fixed list of requests, writes two files and reads none.

    ``runs`` are the matches started from the page.
    """

    source: Mesh
    target: Mesh
    names: tuple[str, str]  # shown as text
    output: Path  # where the page writes landmarks
    force: bool = False  # whether existing files are replaced without asking
    landmarks: np.ndarray | tuple = ()  # (l, 2): pairs to begin with
    labels: Sequence[str] = ()  # names of these pairs
    matcher: _Matcher | None = None  # without it the page cannot match
    map_output: Path | None = None  # where the page may write the map of a run; without it none is saved
    up: str | None = None  # the shapes' vertical axis; ``None``: the page chooses a good side
    port: int = 0

    def __post_init__(self) -> None:
        self.runs = Runs(self._work)
        self._written: set[Path] = set()
        self._maps: list[Match] = []
        page = self._page()
        routes = {
            ("GET", ""): lambda _: page_reply(page),
            ("GET", "progress"): self._progress,
            ("GET", "map"): self._last_map,
            ("POST", "match"): self._match,
            ("POST", "cancel"): self._cancel,
            ("POST", "save"): self._save,
            ("POST", "save-map"): self._save_map,
        }
        super().__init__(routes, self.port)

    def _page(self) -> str:
        """Return the page, which sends requests to this server."""
        data = {
            "kind": "picker",
            "up": check_up(self.up) or "auto",
            "views": views_record(self.source, self.target),
            "source": source_record(self.source, self.names[0]),
            "target": shape_record(self.target, self.names[1]),
            "pairs": np.asarray(self.landmarks, dtype=np.int64).reshape(-1, 2),
            "names": list(self.labels),
            "output": self.output.name,
            "canSave": self.map_output is not None,
            "canMatch": self.matcher is not None,
        }
        title = f"Landmarks: {self.names[0]} → {self.names[1]}"
        return document("picker.html.j2", title=title, data=data, connect=True)

    def close(self) -> None:
        """Stop a running match and release the port."""
        self.runs.cancel(wait=2.0)
        super().close()

    def _work(self, pairs: np.ndarray, progress: Progress) -> dict[str, object]:
        """Match with landmarks, keep the map, and return its record for the page."""
        source, target = self.source, self.target
        assert self.matcher is not None
        match = self.matcher(pairs, progress)
        points = check_map(match, len(source.vertices), len(target.vertices), partial=True)
        self._maps.append(match)
        label = plural(len(pairs), "landmark")
        confidence = encode_floats(local_confidence(source, target, points))
        verdict = verdict_record(match, source, target)
        return {**map_record(source, target, points, label), "confidence": confidence, "verdict": verdict}

    def _pairs(self, request: JsonObject) -> np.ndarray:
        return check_pairs(request.get("pairs"), self.source, self.target)

    def _write(self, path: Path, request: JsonObject, write: Callable[[bool], None], **fields: object) -> Reply:
        # The picker may replace its own files, and others only when the user agrees.
        may_replace = self.force or path in self._written or request.get("overwrite") is True
        if path.exists() and not may_replace:
            return json_reply({"exists": str(path)}, 409)
        write(may_replace)
        self._written.add(path)
        return json_reply({"saved": str(path), **fields})

    def _save(self, request: JsonObject) -> Reply:
        pairs, path = self._pairs(request), self.output
        names = request.get("names", [])
        is_list = isinstance(names, list)
        if not is_list or not all(isinstance(name, str) and len(name) <= _MAX_NAME for name in names):
            expected = f"texts of at most {_MAX_NAME} letters"
            raise refuse("names", expected, "something else", "give one for each pair")

        def write(force: bool) -> None:
            write_landmarks(path, pairs, names=names, force=force)

        return self._write(path, request, write, count=len(pairs))

    def _save_map(self, request: JsonObject) -> Reply:
        path, run = self.map_output, request.get("run")
        if path is None or type(run) is not int or not 0 <= run < len(self._maps):
            raise refuse("map", "the number of a run that is done", repr(run), "match first")
        return self._write(path, request, lambda force: save_map(path, self._maps[run], force))

    def _match(self, request: JsonObject) -> Reply:
        if self.matcher is None:
            raise refuse("match", "a picker that can match", "one that cannot", "save and use kfmaps match")
        return json_reply(asdict(self.runs.start(self._pairs(request))))

    def _progress(self, _: object) -> Reply:
        return json_reply(asdict(self.runs.status()))

    def _cancel(self, _: object) -> Reply:
        self.runs.cancel()
        return self._progress(None)

    def _last_map(self, _: object) -> Reply:
        record = self.runs.result()
        return json_reply({"error": "no match is done"}, 404) if record is None else json_reply(record)
