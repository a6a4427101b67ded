"""The review page: each specimen of a study with its landmarks on it, to be looked at, moved and accepted."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._records import JsonObject
from kfmaps.batch.landmark_tables import read_corrections, read_study, write_corrections, write_study
from kfmaps.batch.transfer_landmarks import CHECKED, CORRECTED, SpecimenLandmarks, correct_landmarks
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.meshes import read_shape_mesh
from kfmaps.viz.document import document
from kfmaps.viz.page import check_up, shape_record, views_record
from kfmaps.viz.server import LocalServer, Reply, json_reply, page_reply


class ReviewServer:
    """The server of a study's review: a page for each specimen, and one request that saves corrections.

    The study is read from its files at each request, so that what was saved is what is seen. ``server`` is not
    answering yet: call its ``serve_forever``.
    """

    def __init__(self, study: Path, port: int = 0, up: str | None = None) -> None:
        self.study, self.up = study, check_up(up)
        self._names = [one.specimen for one in self._specimens()]
        routes = {("GET", str(i)): lambda _, i=i: self._page(i) for i in range(len(self._names))}
        routes |= {("GET", ""): lambda _: self._page(None), ("POST", "save"): self._save}
        self.server = LocalServer(routes, port)

    def close(self) -> None:
        """Give the port back."""
        self.server.close()

    def _specimens(self) -> list[SpecimenLandmarks]:
        return [one for one in read_study(self.study)[0] if not one.misfit]

    def _page(self, number: int | None) -> Reply:
        """The page of a specimen; without its number of the first that has flags."""
        study = {one.specimen: one for one in self._specimens()}
        shown = [study[name] for name in self._names if name in study]
        if number is None:
            one = max(shown, key=lambda one: (any(one.open_flags), bool(one.verdict)))
        else:
            one = study[self._names[number]]
        template = next(one for one in shown if not one.verdict)
        source, target = (read_shape_mesh(each.scan) for each in (template, one))
        data = {
            "kind": "review",
            "up": self.up or "auto",
            "views": views_record(source, target),
            "source": shape_record(source, template.specimen),
            "target": shape_record(target, one.specimen),
            "template": _places(template),
            "landmarks": _landmarks(one),
            "specimens": [
                {"page": self._names.index(each.specimen), "name": each.specimen, "flags": _count_flags(each)}
                for each in shown
            ],
        }
        return page_reply(document("review.html.j2", title=f"Landmarks: {one.specimen}", data=data, connect=True))

    def _save(self, request: JsonObject) -> Reply:
        """Take corrections of one specimen into the study's tables."""
        study, suffix = read_study(self.study)
        name = request.get("specimen")
        at = next((i for i, one in enumerate(study) if one.specimen == name and not one.misfit), None)
        if at is None:
            raise refuse("specimen", "one of the study", repr(name), "reload the page")
        mesh = read_shape_mesh(study[at].scan)
        changes = _check_changes(request.get("changes"), study[at], mesh)
        corrections = read_corrections(self.study)
        corrections[study[at].specimen] = {**corrections.get(study[at].specimen, {}), **changes}
        write_corrections(self.study, corrections)
        study[at] = correct_landmarks(study[at], changes)
        write_study(self.study, study, suffix)
        return json_reply({"saved": len(changes), "landmarks": _landmarks(study[at]), "flags": _count_flags(study[at])})


def _check_changes(changes: object, one: SpecimenLandmarks, mesh: Mesh) -> dict[str, tuple[np.ndarray, str]]:
    """Return the corrections that the page sent: where each landmark lies on the mesh, and its status."""
    rows = {name: row for row, name in enumerate(one.points.names)}
    found: dict[str, tuple[np.ndarray, str]] = {}
    for change in changes if isinstance(changes, list) and changes else [None]:
        told: Mapping[str, object] = change if isinstance(change, Mapping) else {}
        name = told.get("name")
        if not isinstance(name, str) or name not in rows:
            raise refuse("corrections", "landmarks of the specimen", repr(name), "reload the page")
        if told.get("checked") is True:
            found[name] = (one.points.points[rows[name]], CHECKED)
        elif told.get("face") is None:
            found[name] = (np.full(3, np.nan), CORRECTED)
        else:
            found[name] = (_check_place(told["face"], told.get("weights"), mesh), CORRECTED)
    return found


def _check_place(face: object, weights: object, mesh: Mesh) -> np.ndarray:
    """Return the position of a point of the mesh, given as a face and three weights, neither negative, of sum 1."""
    if type(face) is not int or not 0 <= face < len(mesh.faces):
        raise refuse("corrections", f"faces from 0 to {len(mesh.faces) - 1}", repr(face), "reload the page")
    given = weights if isinstance(weights, list) else []
    if len(given) != 3 or not all(type(w) in (int, float) and w >= 0 for w in given) or abs(sum(given) - 1) > 1e-3:
        raise refuse("corrections", "three weights of sum 1", repr(weights), "reload the page")
    return point_positions(PointMap(np.array([face]), np.array([given]) / sum(given)), mesh)[0]


def _places(one: SpecimenLandmarks) -> list[dict[str, object] | None]:
    """Where each landmark lies, as the page reads it."""
    place = one.points.place
    rows = zip(place.faces, place.weights, one.points.vertices, strict=True)
    return [None if v < 0 else {"face": int(face), "weights": weights} for face, weights, v in rows]


def _landmarks(one: SpecimenLandmarks) -> list[dict[str, object]]:
    known = [None if np.isnan(c) else round(float(c), 4) for c in one.points.confidence]
    rows = zip(one.points.names, one.flags, known, _places(one), strict=True)
    return [{"name": name, "flag": flag, "confidence": sure, "place": place} for name, flag, sure, place in rows]


def _count_flags(one: SpecimenLandmarks) -> int:
    return sum(map(bool, one.open_flags))
