"""Carry the landmarks of one or several specimens to all scans of a folder, and say how sure each position is."""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.batch.layout import Pair, ShapeFolder
from kfmaps.batch.results import Result
from kfmaps.batch.work import map_path
from kfmaps.collection.procrustes import generalized_procrustes, geometric_median, is_mirror_image
from kfmaps.collection.semilandmarks import slide_semilandmarks
from kfmaps.fmap.precise import PointMap
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io import load_map
from kfmaps.io.landmark_files import (
    LPS,
    RAS,
    LandmarkSet,
    find_curves,
    fixed_rows,
    landmark_stem,
    mesh_space,
    read_landmark_sets,
    write_landmark_sets,
)
from kfmaps.io.meshes import read_shape_mesh
from kfmaps.io.named_points import FLIP, NamedPoints, place_landmarks, points_on_surface, transfer_points
from kfmaps.io.transfer import find_counterparts
from kfmaps.matching.result import Match

MATCHES = "matches"
"""Folder of the maps inside the output."""
MIN_CONFIDENCE = 0.5
"""Confidence below which a landmark is flagged."""
MAX_SPREAD = 0.015
"""Distance of a template's proposal from the median, in √area, above which a landmark is flagged. Chosen on the choice
half of `benchmarks/skulls.py`, where it flags 2 % of the landmarks."""
CORRECTED, CHECKED = REVIEWED = ("corrected", "checked")
"""Flags of landmarks that somebody has moved, or has found right."""
GOOD = ("sure", "likely", "landmarks", "unchecked")
"""Verdicts of maps that carry landmarks."""


Corrections = Mapping[str, tuple[np.ndarray, str]]
"""By landmark: its position (3,), NaN for a missing one, and one of :data:`REVIEWED`."""


@dataclass(frozen=True, eq=False)
class Template:
    """A specimen whose landmarks are given."""

    specimen: str
    file: Path  # of the landmarks
    scan: Path  # of the mesh
    mesh: Mesh
    points: NamedPoints
    space: str  # "LPS", "RAS" or "": the mesh's coordinate system, as far as mesh or landmarks name one


@dataclass(frozen=True, eq=False)
class SpecimenLandmarks:
    """The landmarks of one specimen."""

    specimen: str
    points: NamedPoints  # vertices of −1 and NaN where a landmark is missing
    # (l,): largest distance of a template's proposal from the median, in the mesh's unit; NaN with one template.
    spread: np.ndarray
    # (l,): distance to where the best other map puts the landmark, in the mesh's unit; NaN where no other map is known.
    rival: np.ndarray
    flags: tuple[str, ...]  # for each landmark why it should be looked at, or one of REVIEWED; empty for none
    scan: Path = Path()  # file of the mesh
    n_maps: int = 0  # maps that it rests on
    verdict: str = ""  # of the best of these maps, "failed" without one, empty for a template
    chance: float = np.nan  # probability of that map
    misfit: str = ""  # why the specimen fits none of the others; empty where it does
    space: str = ""  # "LPS", "RAS" or ""

    @property
    def landmarks(self) -> LandmarkSet:
        """The landmarks in the form that files hold."""
        return LandmarkSet(self.points.names, self.points.points, self.specimen, self.space, notes=self.open_flags)

    @property
    def open_flags(self) -> tuple[str, ...]:
        """The flags that nobody has dealt with; empty for the others."""
        return tuple("" if flag in REVIEWED else flag for flag in self.flags)


def read_templates(files: Sequence[Path], scans: ShapeFolder) -> list[Template]:
    """Read the landmarks of specimens that are among the scans; a file of several specimens holds as many templates.

    A file belongs to the scan whose name its own name is or begins with. Several files of one scan are joined, such as
    landmarks and a file for each curve; a curve is then named after its file.
    """
    found: dict[str, Template] = {}
    positions: dict[str, dict[str, np.ndarray]] = {}
    for file in files:
        sets = read_landmark_sets(file)
        for one in sets:
            name = _scan_of(one.specimen if len(sets) > 1 else landmark_stem(file), scans, file)
            path = scans.shapes[name]
            mesh, space = read_shape_mesh(path), mesh_space(path)
            if len(mesh.faces) == 0:
                raise refuse(str(path), "a surface with faces", "a point cloud", "Landmarks lie on surfaces")
            given = _name_curve(one, landmark_stem(file), name)
            points = place_landmarks(given, mesh, str(file), space=space)
            own = positions.setdefault(name, {})
            if again := own.keys() & set(points.names):
                got = f"two with {min(again)!r}"
                raise refuse(str(file), f"one file for each landmark of {name}", got, "leave one out")
            own |= zip(points.names, points.points, strict=True)
            found.setdefault(name, Template(name, file, path, mesh, points, space or _space(given, points)))
    names = tuple(dict.fromkeys(label for own in positions.values() for label in own))
    curves = find_curves(names)
    names = tuple(names[row] for row in [*fixed_rows(names), *(row for curve in curves for row in curve.rows)])
    for one, curve in itertools.product(found.values(), find_curves(names)):
        count = sum(names[row] in positions[one.specimen] for row in curve.rows)
        if 0 < count < len(curve.rows):
            wanted = f"{len(curve.rows)} points of the curve {curve.name}, as another has"
            raise refuse(str(one.file), wanted, f"{count}", "resample them alike")
    templates: list[Template] = []
    for one in found.values():
        own = np.array([positions[one.specimen].get(name, np.full(3, np.nan)) for name in names])
        points = points_on_surface(names, own, one.mesh)
        if templates and is_mirror_image(points.points, templates[0].points.points):
            got = f"a mirror image of {templates[0].file}'s"
            remedy = "Left and right labels are swapped in one of them, or one of the scans is a mirror image"
            raise refuse(str(one.file), "landmarks like those of the others", got, remedy)
        templates.append(replace(one, points=points))
    if len(templates) == 1 or not curves:
        return templates
    slid = _slide(np.stack([one.points.points for one in templates]), templates)
    return [
        replace(one, points=points_on_surface(names, new, one.mesh)) for one, new in zip(templates, slid, strict=True)
    ]


def _name_curve(given: LandmarkSet, stem: str, specimen: str) -> LandmarkSet:
    """Name the only curve of a file after the rest of the file's name, where the file has nothing else."""
    rest = stem.removeprefix(specimen).strip("._- ")
    if not rest or fixed_rows(given.names) or len(find_curves(given.names)) > 1:
        return given
    return replace(given, names=tuple(re.sub(r"(curve|loop).*(_\d+)", rf"\g<1>{rest}\2", one) for one in given.names))


def template_pairs(templates: Sequence[Template], scans: ShapeFolder) -> list[Pair]:
    """Return the pairs to match: from each template to every other scan, other templates too, which tests them."""
    return [Pair(one.specimen, name) for one in templates for name in scans.shapes if name != one.specimen]


def corrected_pairs(
    templates: Sequence[Template], scans: ShapeFolder, corrections: Mapping[str, Corrections], folder: Path
) -> dict[Pair, tuple[Path, Path]]:
    """Write the landmarks with which corrected specimens are matched again; return both files of each such pair.

    Maps between templates stay as they are: they test the templates' landmarks.
    """
    own = {one.specimen: one.points for one in templates}
    found: dict[Pair, tuple[Path, Path]] = {}
    for pair in template_pairs(templates, scans):
        known = corrections.get(pair.target, {}) if pair.target not in own else {}
        given = dict(zip(own[pair.source].names, own[pair.source].points, strict=True))
        names = tuple(name for name in known if name in given and np.isfinite([known[name][0], given[name]]).all())
        if names:
            folder.mkdir(parents=True, exist_ok=True)
            found[pair] = (folder / f"{pair.key}-source.csv", folder / f"{pair.key}-target.csv")
            for file, points in zip(found[pair], (given, {name: known[name][0] for name in names}), strict=True):
                placed = LandmarkSet(names, np.array([points[name] for name in names]), file.stem)
                write_landmark_sets(file, [placed], force=True)
    return found


def carry_templates(
    templates: Sequence[Template], specimen: str, path: Path, results: Mapping[str, Result], folder: Path
) -> SpecimenLandmarks:
    """Return the landmarks of a scan: the geometric median of what the templates propose, on the surface.

    Points of curves are slid before. ``results`` are those of the maps from the templates. Maps that are not good
    (:data:`GOOD`) are left out where there are others. The confidence of a landmark is the mean of the templates'
    confidences, times the fraction of templates whose proposal lies near the median (:data:`MAX_SPREAD`).
    """
    names = templates[0].points.names
    done = [one for one in templates if one.specimen in results and results[one.specimen].status == "done"]
    used = [one for one in done if results[one.specimen].verdict in GOOD] or done
    if not used:
        reasons = [r.reason for r in results.values() if r.reason]
        nothing = np.full(len(names), np.nan)
        points = templates[0].points.without(np.ones(len(names), dtype=bool))
        told = reasons[0] if reasons else "it was not matched"
        return SpecimenLandmarks(specimen, points, nothing, nothing, ("",) * len(names), path, 0, "failed", misfit=told)
    mesh = read_shape_mesh(path)
    unit = float(np.sqrt(surface_area(mesh)))
    carried, rivals = [], []
    for one in used:
        chance = results[one.specimen].confidence
        known, points = _carry(one, specimen, mesh, folder, 1.0 if chance is None else chance)
        carried.append(points)
        rivals.append(_rival_distance(known, one, mesh, points))
    proposals = _slide(np.stack([points.points for points in carried]), templates)
    median = geometric_median(proposals)
    distances = np.linalg.norm(proposals - median, axis=2)
    near = np.where(np.isnan(distances), np.nan, distances <= MAX_SPREAD * unit)
    confidence = _mean(np.stack([points.confidence for points in carried])) * _mean(near)
    points = points_on_surface(names, median, mesh, confidence)
    spread = np.fmax.reduce(distances) if len(used) > 1 else np.full(len(names), np.nan)
    flags = tuple(_flag(*one) for one in zip(confidence, spread / unit, points.vertices >= 0, strict=True))
    best = max((results[one.specimen] for one in used), key=lambda r: r.confidence or 0.0)
    space = mesh_space(path) or templates[0].space
    misfit = _misfit(best, points, templates[0])
    chance = np.nan if best.confidence is None else best.confidence
    told = (path, len(used), best.verdict, chance, misfit, space)
    return SpecimenLandmarks(specimen, points, spread, np.fmin.reduce(rivals), flags, *told)


def _slide(points: np.ndarray, templates: Sequence[Template]) -> np.ndarray:
    """Return landmarks of specimens (s, l, 3), points of curves slid against the template, or the mean of several."""
    curves = [(np.array(curve.rows), curve.closed) for curve in find_curves(templates[0].points.names)]
    if not curves:
        return points
    given = np.stack([one.points.points for one in templates])
    reference = given[0] if len(given) == 1 else generalized_procrustes(given).consensus
    return np.stack([slide_semilandmarks(one, reference, curves) for one in points])


def _misfit(best: Result, points: NamedPoints, template: Template) -> str:
    """Return why a specimen does not fit the others, by its best map and its landmarks; empty where it does."""
    if best.verdict not in GOOD:
        return f"its best map is {best.verdict} ({100 * (best.confidence or 0.0):.0f} %, from {best.source})"
    if is_mirror_image(points.points, template.points.points):
        return "its landmarks are a mirror image of the templates': left and right are swapped, or the scan is mirrored"
    return ""


def _carry(one: Template, specimen: str, mesh: Mesh, folder: Path, chance: float = 1.0) -> tuple[Match, NamedPoints]:
    """Return the map from a template to a scan, and its landmarks there; those without counterpart are missing.

    The confidence of a point is that of the map's neighbourhood times ``chance``, the probability of the map.
    """
    file = map_path(folder, Pair(one.specimen, specimen).key)
    known = load_map(file)
    ways = find_counterparts(known, one.mesh, mesh, str(file))
    trust = getattr(known, "local_confidence", None)  # a list of vertices has none
    local = np.ones(len(mesh.vertices)) if trust is None else np.nan_to_num(trust)
    carried = transfer_points(one.points, ways, local)
    return known, replace(carried, confidence=carried.confidence * chance)


def correct_points(points: NamedPoints, corrections: Corrections, mesh: Mesh) -> NamedPoints:
    """Return points with those in ``corrections`` put to the closest places of the surface, with confidence 1."""
    there = np.array([name in corrections for name in points.names])
    positions = np.array([corrections[name][0] if name in corrections else np.full(3, np.nan) for name in points.names])
    new = points_on_surface(points.names, positions, mesh, np.ones(len(there)))

    def merge(after: np.ndarray, before: np.ndarray) -> np.ndarray:
        return np.where(there if after.ndim == 1 else there[:, None], after, before)

    return NamedPoints(
        points.names,
        PointMap(merge(new.place.faces, points.place.faces), merge(new.place.weights, points.place.weights)),
        merge(new.points, points.points),
        merge(new.vertices, points.vertices),
        merge(new.confidence, points.confidence),
    )


def correct_landmarks(one: SpecimenLandmarks, corrections: Corrections) -> SpecimenLandmarks:
    """Return the landmarks of a specimen with what somebody has corrected, which is marked in place of its flag."""
    if not corrections:
        return one
    points = correct_points(one.points, corrections, read_shape_mesh(one.scan))
    words = zip(points.names, one.flags, strict=True)
    return replace(one, points=points, flags=tuple(corrections.get(name, (None, flag))[1] for name, flag in words))


def drop_unsure(one: SpecimenLandmarks, min_confidence: float) -> SpecimenLandmarks:
    """Return the landmarks without those below a confidence, which become missing."""
    points = one.points.without(~(one.points.confidence >= min_confidence))
    return replace(one, points=replace(points, confidence=one.points.confidence))


def given_landmarks(template: Template) -> SpecimenLandmarks:
    """Return a template's own landmarks as those of a specimen: sure, and not flagged."""
    none = np.full(len(template.points.names), np.nan)
    points = replace(template.points, confidence=np.where(template.points.vertices >= 0, 1.0, np.nan))
    flags = ("",) * len(none)
    return SpecimenLandmarks(template.specimen, points, none, none, flags, template.scan, space=template.space)


def template_errors(templates: Sequence[Template], results: Mapping[Pair, Result], folder: Path) -> np.ndarray:
    """Return how far each template's landmarks, carried to each other template, lie from those given there.

    (pairs, l); NaN for none, and for points of curves, which may lie anywhere along them.
    """
    rows, names = [], templates[0].points.names
    fixed = fixed_rows(names)
    for a, b in itertools.permutations(templates, 2):
        result = results.get(Pair(a.specimen, b.specimen))
        if result is not None and result.status == "done":
            carried = _carry(a, b.specimen, b.mesh, folder)[1]
            rows.append(np.full(len(names), np.nan))
            rows[-1][fixed] = np.linalg.norm(carried.points - b.points.points, axis=1)[fixed]
    return np.array(rows).reshape(-1, len(names))


def _mean(values: np.ndarray) -> np.ndarray:
    """The mean over the first axis of what is not NaN; NaN where there is nothing."""
    count = np.isfinite(values).sum(axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)


def _flag(confidence: float, spread: float, there: bool) -> str:
    if not there:
        return "no counterpart"
    if spread > MAX_SPREAD:
        return "templates disagree"
    return "low confidence" if not confidence >= MIN_CONFIDENCE else ""


def _rival_distance(known: Match, template: Template, mesh: Mesh, carried: NamedPoints) -> np.ndarray:
    """Return the least distance at which an alternative map puts each landmark; NaN without alternatives."""
    distances = np.full(len(carried.names), np.nan)
    for other in known.alternatives:
        if (other >= 0).all():
            points = transfer_points(template.points, find_counterparts(Match(other), template.mesh, mesh)).points
            distances = np.fmin(distances, np.linalg.norm(points - carried.points, axis=1))
    return distances


def _scan_of(name: str, scans: ShapeFolder, file: Path) -> str:
    """The scan that landmarks belong to: that of the same name, else the longest that their name begins with."""
    for known in (name, Path(name).stem):
        if known in scans.shapes:
            return known
    begins = [one for one in scans.shapes if name.startswith(one) and not name[len(one)].isalnum()]
    if begins:
        return max(begins, key=len)
    shown = ", ".join(list(scans.shapes)[:5])
    remedy = "Call the file of landmarks as the scan is called"
    raise refuse(str(file), f"the name of a scan in {scans.folder} ({shown}, ...)", repr(name), remedy)


def _space(given: LandmarkSet, placed: NamedPoints) -> str:
    """The coordinate system of a mesh that names none: that of its landmarks, unless those were turned."""
    if not given.space or given.vertices is not None:
        return given.space
    here, turned = (np.nansum(np.abs(placed.points - given.points * sign)) for sign in (1.0, FLIP))
    return given.space if here <= turned else {LPS: RAS, RAS: LPS}[given.space]
