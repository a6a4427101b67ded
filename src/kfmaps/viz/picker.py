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
from kfmaps.cli.words import plural
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
"""(landmarks (l, 2), progress) to a map, with all that is to be saved of it."""

_LONGEST_NAME = 60  # letters of a landmark's name


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


def check_pairs(pairs: object, source: Mesh, target: Mesh) -> np.ndarray:
    """Return landmarks (l, 2) int64, a vertex of ``source`` and one of ``target`` each."""
    if not isinstance(pairs, list) or not all(
        isinstance(pair, list) and len(pair) == 2 and all(type(v) is int for v in pair) for pair in pairs
    ):
        remedy = "give pairs of 0-based vertex numbers, source first"
        raise refuse("landmarks", "a list of pairs of whole numbers", "something else", remedy)
    found = np.array(pairs).reshape(-1, 2)
    for column, mesh, side in zip(found.T, (source, target), ("source", "target"), strict=True):
        check_landmarks(column, len(mesh.vertices), f"landmarks on the {side}")
    return found.astype(np.int64)


@dataclass(eq=False)
class PickerServer:
    """The server of the picker's page: it answers a fixed list of requests, writes two files and reads none.

    ``server`` is not answering yet: call its ``serve_forever``. ``runs`` are the matches started from the page.
    """

    source: Mesh
    target: Mesh
    names: tuple[str, str]  # shown as text
    output: Path  # where the page writes landmarks
    force: bool = False  # whether existing files are replaced without asking
    landmarks: np.ndarray | tuple = ()  # (l, 2): pairs to begin with, and ...
    labels: Sequence[str] = ()  # their names
    matcher: _Matcher | None = None  # computes a map from landmarks; without it the page cannot match
    map_output: Path | None = None  # where the page may write the map of a run; without it none is saved
    up: str | None = None  # the shapes' vertical axis; ``None``: a good side is found
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
        self.server = LocalServer(routes, self.port)

    def _page(self) -> str:
        """The page, which speaks to the server it came from."""
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
        """Stop a running match and give the port back."""
        self.runs.cancel(wait=2.0)
        self.server.close()

    def _work(self, pairs: np.ndarray, progress: Progress) -> dict[str, object]:
        """Match with landmarks, and keep the map; what the page shows of it."""
        source, target = self.source, self.target
        assert self.matcher is not None
        found = self.matcher(pairs, progress)
        points = check_map(found, len(source.vertices), len(target.vertices), partial=True)
        self._maps.append(found)
        label = plural(len(pairs), "landmark")
        confidence = encode_floats(local_confidence(source, target, points))
        verdict = verdict_record(found.verdict, found.confidence, len(pairs))
        return {**map_record(source, target, points, label), "confidence": confidence, "verdict": verdict}

    def _pairs(self, request: JsonObject) -> np.ndarray:
        return check_pairs(request.get("pairs"), self.source, self.target)

    def _write(self, path: Path, request: JsonObject, write: Callable[[bool], None], **told: object) -> Reply:
        # What this picker wrote itself it may replace; what was there before only when told to.
        allowed = self.force or path in self._written or request.get("overwrite") is True
        if path.exists() and not allowed:
            return json_reply({"exists": str(path)}, 409)
        write(allowed)
        self._written.add(path)
        return json_reply({"saved": str(path), **told})

    def _save(self, request: JsonObject) -> Reply:
        pairs, path = self._pairs(request), self.output
        names = request.get("names", ())
        if not all(isinstance(name, str) and len(name) <= _LONGEST_NAME for name in names):
            wanted = f"texts of at most {_LONGEST_NAME} letters"
            raise refuse("names", wanted, "something else", "give one for each pair")

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
