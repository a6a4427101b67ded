"""The landmark picker: a local page on which pairs of points are clicked, saved and tried out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.fmap.confidence import local_confidence
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import MapFile, check_map, save_map, write_landmarks
from kfmaps.viz.document import document
from kfmaps.viz.encode import quantised
from kfmaps.viz.page import check_up, map_record, shape_record, source_record, views_record
from kfmaps.viz.runs import Progress, Runs
from kfmaps.viz.server import LocalServer, Reply, json_reply, page_reply

Matcher = Callable[[np.ndarray, Progress], MapFile]
"""(landmarks (l, 2), progress) to a map, with all that is to be saved of it."""

LONGEST_NAME = 60
"""Letters of a landmark's name."""


def check_pairs(pairs: Any, source: Mesh, target: Mesh) -> np.ndarray:
    """Landmarks (l, 2) int64, a vertex of ``source`` and one of ``target`` each.

    Raises
    ------
    InvalidInput
        When ``pairs`` is anything else.
    """
    remedy = "give pairs of 0-based vertex numbers, source first"
    whole = isinstance(pairs, list) and all(
        isinstance(pair, list) and len(pair) == 2 and all(type(v) is int for v in pair) for pair in pairs
    )
    if not whole:
        raise refuse("landmarks", "a list of pairs of whole numbers", "something else", remedy)
    for pair in pairs:
        for vertex, mesh, name in zip(pair, (source, target), ("source", "target"), strict=True):
            if not 0 <= vertex < len(mesh.vertices):
                wanted = f"{name} vertices from 0 to {len(mesh.vertices) - 1}"
                raise refuse("landmarks", wanted, str(vertex), remedy)
    for side, name in enumerate(("source", "target")):
        seen = [pair[side] for pair in pairs]
        twice = next((vertex for i, vertex in enumerate(seen) if vertex in seen[:i]), None)
        if twice is not None:
            raise refuse("landmarks", f"each vertex of the {name} once", f"{twice} twice", "leave one pair out")
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)


def check_names(names: Any, count: int) -> list[str]:
    """One short text for each of ``count`` pairs; none is an empty one for each.

    Raises
    ------
    InvalidInput
        When ``names`` is anything else.
    """
    if names is None:
        return [""] * count
    fits = isinstance(names, list) and len(names) == count
    if not fits or not all(isinstance(name, str) and len(name) <= LONGEST_NAME for name in names):
        wanted = f"{count} texts of at most {LONGEST_NAME} letters"
        raise refuse("names", wanted, "something else", "give one for each pair")
    return names


@dataclass(frozen=True, eq=False)
class Picker:
    """What the picker works on.

    Attributes
    ----------
    source, target : Mesh
    names : (str, str)
        Shown as text.
    output : Path
        Where the page writes landmarks.
    force : bool
        Whether existing files are replaced without asking.
    landmarks : (l, 2) int64
        Pairs to begin with, and ...
    labels : sequence of str
        ... their names.
    matcher : callable or None
        Computes a map from landmarks; without it the page cannot match.
    map_output : Path or None
        Where the page may write the map of a run; without it none is saved.
    up : {"x", "y", "z"} or None
        The shapes' vertical axis; ``None``: a good side is found.
    """

    source: Mesh
    target: Mesh
    names: tuple[str, str]
    output: Path
    force: bool = False
    landmarks: np.ndarray | tuple = ()
    labels: Sequence[str] = ()
    matcher: Matcher | None = None
    map_output: Path | None = None
    up: str | None = None

    def page(self) -> str:
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


@dataclass(frozen=True, eq=False)
class PickerServer:
    """A picker being served.

    Attributes
    ----------
    server : LocalServer
        Not yet answering: call its ``serve_forever``.
    runs : Runs
        The matches started from the page.
    """

    server: LocalServer
    runs: Runs

    def close(self) -> None:
        """Stop a running match and give the port back."""
        self.runs.cancel(wait=2.0)
        self.server.close()


def picker_server(picker: Picker, port: int = 0) -> PickerServer:
    """The server of ``picker``'s page: seven requests, two files to write, none to read.

    Parameters
    ----------
    picker : Picker
    port : int
        0 takes any free one.

    Raises
    ------
    InvalidInput
        When the port is taken.
    """
    page = picker.page()
    written: set[Path] = set()
    maps: list[MapFile] = []

    def work(pairs: np.ndarray, progress: Progress) -> dict[str, Any]:
        assert picker.matcher is not None
        found = picker.matcher(pairs, progress)
        points = check_map(found, len(picker.source.vertices), len(picker.target.vertices), lost=True)
        maps.append(found)
        label = f"{len(pairs)} landmark" + ("" if len(pairs) == 1 else "s")
        sure = local_confidence(picker.source, picker.target, points)
        return {**map_record(picker.source, picker.target, points, label), "confidence": quantised(sure)}

    runs = Runs(work)

    def pairs_of(request: Any) -> np.ndarray:
        pairs = request.get("pairs") if isinstance(request, dict) else None
        return check_pairs(pairs, picker.source, picker.target)

    def saved(path: Path, request: Any, write: Callable[[bool], None], **told: Any) -> Reply:
        # What this picker wrote itself it may replace; what was there before only when told to.
        allowed = picker.force or path in written or request.get("overwrite") is True
        if path.exists() and not allowed:
            return json_reply({"exists": str(path)}, 409)
        write(allowed)
        written.add(path)
        return json_reply({"saved": str(path), **told})

    def save(request: Any) -> Reply:
        pairs = pairs_of(request)
        names = check_names(request.get("names"), len(pairs))

        def write(force: bool) -> None:
            write_landmarks(picker.output, pairs, names=names, force=force)

        return saved(picker.output, request, write, count=len(pairs))

    def save_run(request: Any) -> Reply:
        path, run = picker.map_output, request.get("run") if isinstance(request, dict) else None
        if path is None or type(run) is not int or not 0 <= run < len(maps):
            raise refuse("map", "the number of a run that is done", repr(run), "match first")
        return saved(path, request, lambda force: save_map(path, maps[run], force))

    def match(request: Any) -> Reply:
        if picker.matcher is None:
            raise refuse("match", "a picker that can match", "one that cannot", "save and use kfmaps match")
        return json_reply(asdict(runs.start(pairs_of(request))))

    def cancel(_: Any) -> Reply:
        runs.cancel()
        return json_reply(asdict(runs.status()))

    def last_map(_: Any) -> Reply:
        record = runs.result()
        return json_reply({"error": "no match is done"}, 404) if record is None else json_reply(record)

    routes = {
        ("GET", ""): lambda _: page_reply(page),
        ("GET", "progress"): lambda _: json_reply(asdict(runs.status())),
        ("GET", "map"): last_map,
        ("POST", "match"): match,
        ("POST", "cancel"): cancel,
        ("POST", "save"): save,
        ("POST", "save-map"): save_run,
    }
    return PickerServer(LocalServer(routes, port), runs)
