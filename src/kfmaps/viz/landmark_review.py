"""The review page: the landmarks of each specimen of a study, to be checked, moved and accepted."""

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


class ReviewServer(LocalServer):
    """The server of a study's review: a page for each specimen, and one request that saves corrections.

    The study is read from its files at each request, so that pages show what was saved.
    """

    def __init__(self, study: Path, port: int = 0, up: str | None = None) -> None:
        self.study, self.up = study, check_up(up)
        self._names = [one.specimen for one in self._specimens()]
        routes = {("GET", str(i)): lambda _, i=i: self._page(i) for i in range(len(self._names))}
        routes |= {("GET", ""): lambda _: self._page(None), ("POST", "save"): self._save}
        super().__init__(routes, port)

    def _specimens(self) -> list[SpecimenLandmarks]:
        return [one for one in read_study(self.study)[0] if not one.misfit]

    def _page(self, number: int | None) -> Reply:
        """Return the page of a specimen, by default of the first with flags."""
        study = {specimen.specimen: specimen for specimen in self._specimens()}
        specimens = [study[name] for name in self._names if name in study]
        if number is None:
            specimen = max(specimens, key=lambda specimen: (any(specimen.open_flags), bool(specimen.verdict)))
        else:
            specimen = study[self._names[number]]
        template = next(specimen for specimen in specimens if not specimen.verdict)
        source, target = (read_shape_mesh(shape.scan) for shape in (template, specimen))
        data = {
            "kind": "review",
            "up": self.up or "auto",
            "views": views_record(source, target),
            "source": shape_record(source, template.specimen),
            "target": shape_record(target, specimen.specimen),
            "template": _places(template),
            "landmarks": _landmarks(specimen),
            "specimens": [
                {"page": self._names.index(shape.specimen), "name": shape.specimen, "flags": _count_flags(shape)}
                for shape in specimens
            ],
        }
        return page_reply(document("review.html.j2", title=f"Landmarks: {specimen.specimen}", data=data, connect=True))

    def _save(self, request: JsonObject) -> Reply:
        """Save the corrections of one specimen in the study's tables."""
        study, suffix = read_study(self.study)
        name = request.get("specimen")
        row = next((i for i, specimen in enumerate(study) if specimen.specimen == name and not specimen.misfit), None)
        if row is None:
            raise refuse("specimen", "one of the study", repr(name), "reload the page")
        mesh = read_shape_mesh(study[row].scan)
        changes = _check_changes(request.get("changes"), study[row], mesh)
        corrections = read_corrections(self.study)
        corrections[study[row].specimen] = {**corrections.get(study[row].specimen, {}), **changes}
        write_corrections(self.study, corrections)
        study[row] = correct_landmarks(study[row], changes)
        write_study(self.study, study, suffix)
        return json_reply(
            {"saved": len(changes), "landmarks": _landmarks(study[row]), "flags": _count_flags(study[row])}
        )


def _check_changes(changes: object, specimen: SpecimenLandmarks, mesh: Mesh) -> dict[str, tuple[np.ndarray, str]]:
    """Return the corrections that the page sent: where each landmark lies on the mesh, and its status."""
    rows = {name: row for row, name in enumerate(specimen.points.names)}
    corrections: dict[str, tuple[np.ndarray, str]] = {}
    for change in changes if isinstance(changes, list) and changes else [None]:
        fields: Mapping[str, object] = change if isinstance(change, Mapping) else {}
        name = fields.get("name")
        if not isinstance(name, str) or name not in rows:
            raise refuse("corrections", "landmarks of the specimen", repr(name), "reload the page")
        if fields.get("checked") is True:
            corrections[name] = (specimen.points.points[rows[name]], CHECKED)
        elif fields.get("face") is None:
            corrections[name] = (np.full(3, np.nan), CORRECTED)
        else:
            corrections[name] = (_check_place(fields["face"], fields.get("weights"), mesh), CORRECTED)
    return corrections


def _check_place(face: object, weights: object, mesh: Mesh) -> np.ndarray:
    """Return the position of a point of the mesh, given as a face and three weights from 0 on with sum 1."""
    if type(face) is not int or not 0 <= face < len(mesh.faces):
        raise refuse("corrections", f"faces from 0 to {len(mesh.faces) - 1}", repr(face), "reload the page")
    numbers = weights if isinstance(weights, list) else []
    if (
        len(numbers) != 3
        or not all(type(w) in (int, float) and w >= 0 for w in numbers)
        or abs(sum(numbers) - 1) > 1e-3
    ):
        raise refuse("corrections", "three weights of sum 1", repr(weights), "reload the page")
    return point_positions(PointMap(np.array([face]), np.array([numbers]) / sum(numbers)), mesh)[0]


def _places(specimen: SpecimenLandmarks) -> list[dict[str, object] | None]:
    """Return the face and weights of each landmark, as the page reads them."""
    place = specimen.points.place
    rows = zip(place.faces, place.weights, specimen.points.vertices, strict=True)
    return [None if v < 0 else {"face": int(face), "weights": weights} for face, weights, v in rows]


def _landmarks(specimen: SpecimenLandmarks) -> list[dict[str, object]]:
    confidences = [None if np.isnan(c) else round(float(c), 4) for c in specimen.points.confidence]
    rows = zip(specimen.points.names, specimen.flags, confidences, _places(specimen), strict=True)
    return [
        {"name": name, "flag": flag, "confidence": confidence, "place": place} for name, flag, confidence, place in rows
    ]


def _count_flags(specimen: SpecimenLandmarks) -> int:
    return sum(map(bool, specimen.open_flags))
