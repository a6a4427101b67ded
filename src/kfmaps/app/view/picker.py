"""The landmark picker: a local page on which pairs of points are clicked, saved and tried out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.app.files import check_map, write_landmarks
from kfmaps.app.view.document import document
from kfmaps.app.view.pack import quantised
from kfmaps.app.view.page import map_record, shape_record, source_record
from kfmaps.app.view.runs import Progress, Runs
from kfmaps.app.view.server import LocalServer, Reply, json_reply, page_reply
from kfmaps.functional.confidence import local_confidence
from kfmaps.surface.mesh import Mesh

Matcher = Callable[[np.ndarray, Progress], np.ndarray]
"""(landmarks (l, 2), progress) to a point map (n_t,)."""


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
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)


@dataclass(frozen=True, eq=False)
class Picker:
    """What the picker works on.

    Attributes
    ----------
    source, target : Mesh
    names : (str, str)
        Shown as text.
    output : Path
        The one file that it may write.
    force : bool
        Whether an existing ``output`` is replaced without asking.
    landmarks : (l, 2) int64
        Pairs to begin with.
    matcher : callable or None
        Computes a map from landmarks; without it the page cannot match.
    up : {"x", "y", "z"}
        The shapes' vertical axis.
    """

    source: Mesh
    target: Mesh
    names: tuple[str, str]
    output: Path
    force: bool = False
    landmarks: np.ndarray | tuple = ()
    matcher: Matcher | None = None
    up: str = "y"

    def page(self) -> str:
        """The page, which speaks to the server it came from."""
        data = {
            "kind": "picker",
            "up": self.up,
            "source": source_record(self.source, self.names[0]),
            "target": shape_record(self.target, self.names[1]),
            "pairs": np.asarray(self.landmarks, dtype=np.int64).reshape(-1, 2),
            "output": self.output.name,
            "canMatch": self.matcher is not None,
        }
        title = f"Landmarks: {self.names[0]} → {self.names[1]}"
        return document("picker.html", title=title, data=data, connect=True)


@dataclass(frozen=True, eq=False)
class PickerServer:
    """A picker being served.

    Attributes
    ----------
    server : LocalServer
        Not yet serving: call its ``serve_forever``.
    runs : Runs
        The matches started from the page.
    """

    server: LocalServer
    runs: Runs

    def close(self) -> None:
        """Stop a running match and give the port back."""
        self.runs.cancel(wait=2.0)
        self.server.server_close()


def picker_server(picker: Picker, port: int = 0) -> PickerServer:
    """The server of ``picker``'s page: five requests, one file to write, none to read.

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

    def work(pairs: np.ndarray, progress: Progress) -> dict[str, Any]:
        assert picker.matcher is not None
        points = picker.matcher(pairs, progress)
        points = check_map(points, len(picker.source.vertices), len(picker.target.vertices))
        label = f"{len(pairs)} landmark" + ("" if len(pairs) == 1 else "s")
        sure = local_confidence(picker.source, picker.target, points)
        return {**map_record(picker.source, picker.target, points, label), "confidence": quantised(sure)}

    runs = Runs(work)

    def pairs_of(request: Any) -> np.ndarray:
        pairs = request.get("pairs") if isinstance(request, dict) else None
        return check_pairs(pairs, picker.source, picker.target)

    def save(request: Any) -> Reply:
        pairs = pairs_of(request)
        # What this picker wrote itself it may replace; what was there before only when told to.
        allowed = picker.force or picker.output in written or request.get("overwrite") is True
        if picker.output.exists() and not allowed:
            return json_reply({"exists": str(picker.output)}, 409)
        write_landmarks(picker.output, pairs, force=allowed)
        written.add(picker.output)
        return json_reply({"saved": str(picker.output), "count": len(pairs)})

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
    }
    return PickerServer(LocalServer(routes, port), runs)
