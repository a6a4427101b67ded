"""The review page: each specimen of a study with its landmarks on it, to be looked at, moved and accepted."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.batch.landmark_tables import read_corrections, read_study, write_corrections, write_study
from kfmaps.batch.transfer_landmarks import CHECKED, CORRECTED, SpecimenLandmarks, correct_landmarks
from kfmaps.batch.work import read_shape_mesh
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.mesh import Mesh
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
        meshes = [read_shape_mesh(str(each.scan)) for each in (template, one)]
        data = {
            "kind": "review",
            "up": self.up or "auto",
            "views": views_record(*meshes),
            "source": shape_record(meshes[0], template.specimen),
            "target": shape_record(meshes[1], one.specimen),
            "template": _places(template),
            "landmarks": _landmarks(one),
            "specimens": [
                {"page": self._names.index(each.specimen), "name": each.specimen, "flags": _count_flags(each)}
                for each in shown
            ],
        }
        return page_reply(document("review.html.j2", title=f"Landmarks: {one.specimen}", data=data, connect=True))

    def _save(self, request: Any) -> Reply:
        """Take corrections of one specimen into the study's tables."""
        study, suffix = read_study(self.study)
        name = request.get("specimen") if isinstance(request, dict) else None
        at = next((i for i, one in enumerate(study) if one.specimen == name and not one.misfit), None)
        if at is None:
            raise refuse("specimen", "one of the study", repr(name), "reload the page")
        mesh = read_shape_mesh(str(study[at].scan))
        changes = _check_changes(request.get("changes"), study[at], mesh)
        corrections = read_corrections(self.study)
        corrections[study[at].specimen] = {**corrections.get(study[at].specimen, {}), **changes}
        write_corrections(self.study, corrections)
        study[at] = correct_landmarks(study[at], changes)
        write_study(self.study, study, suffix)
        return json_reply({"saved": len(changes), "landmarks": _landmarks(study[at]), "flags": _count_flags(study[at])})


def _check_changes(changes: Any, one: SpecimenLandmarks, mesh: Mesh) -> dict[str, tuple[np.ndarray, str]]:
    """Return the corrections that the page sent: where each landmark lies on the mesh, and a word."""
    remedy = "give a name, and a face with three weights or none of them, or checked"
    rows = dict(zip(one.points.names, range(len(one.points.names)), strict=True))
    found: dict[str, tuple[np.ndarray, str]] = {}
    for change in changes if isinstance(changes, list) and changes else [None]:
        name = change.get("name") if isinstance(change, Mapping) else None
        if not isinstance(name, str) or name not in rows:
            raise refuse("corrections", "landmarks of the specimen", repr(name), remedy)
        face, weights = change.get("face"), change.get("weights")
        if change.get("checked") is True:
            found[name] = (one.points.points[rows[name]], CHECKED)
            continue
        point = np.full(3, np.nan)
        if face is not None:
            if type(face) is not int or not 0 <= face < len(mesh.faces):
                raise refuse("corrections", f"faces from 0 to {len(mesh.faces) - 1}", repr(face), remedy)
            known = isinstance(weights, list) and len(weights) == 3 and all(type(w) in (int, float) for w in weights)
            if not known or min(weights) < -1e-6 or not 0.999 < sum(weights) < 1.001:
                raise refuse("corrections", "three weights of sum 1", repr(weights), remedy)
            place = PointMap(np.array([face]), np.array([weights]) / sum(weights))
            point = point_positions(place, mesh)[0]
        found[name] = (point, CORRECTED)
    return found


def _places(one: SpecimenLandmarks) -> list[dict[str, Any] | None]:
    """Where each landmark lies, as the page reads it."""
    place = one.points.place
    rows = zip(place.faces, place.weights, one.points.vertices, strict=True)
    return [None if v < 0 else {"face": int(face), "weights": weights} for face, weights, v in rows]


def _landmarks(one: SpecimenLandmarks) -> list[dict[str, Any]]:
    known = [None if np.isnan(c) else round(float(c), 4) for c in one.points.confidence]
    rows = zip(one.points.names, one.flags, known, _places(one), strict=True)
    return [{"name": name, "flag": flag, "confidence": sure, "place": place} for name, flag, sure, place in rows]


def _count_flags(one: SpecimenLandmarks) -> int:
    return sum(map(bool, one.open_flags))
