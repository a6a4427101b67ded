"""Propagate the landmarks of one or several specimens to all scans of a folder, with a confidence for each."""

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
"""Flags of landmarks that somebody has moved, or has confirmed."""
USABLE_VERDICTS = ("sure", "likely", "landmarks", "unchecked")
"""Verdicts of maps that propagate landmarks."""


Corrections = Mapping[str, tuple[np.ndarray, str]]
"""By landmark: its position (3,), NaN for a missing one, and one of :data:`REVIEWED`."""


@dataclass(frozen=True, eq=False)
class Template:
    """A specimen with landmarks of the user."""

    specimen: str
    file: Path  # of the landmarks
    scan: Path  # file of the mesh
    mesh: Mesh
    points: NamedPoints
    space: str  # "LPS", "RAS" or "": the mesh's coordinate system, where mesh or landmarks name one


@dataclass(frozen=True, eq=False)
class SpecimenLandmarks:
    """The landmarks of one specimen."""

    specimen: str
    points: NamedPoints  # vertices of −1 and NaN where a landmark is missing
    # (l,) each, in the mesh's unit: the largest distance of a template's proposal from the median, NaN with one
    # template; the least distance to the landmark by an alternative map, NaN without one.
    spread: np.ndarray
    rival_distance: np.ndarray
    flags: tuple[str, ...]  # for each landmark the reason to check it, or one of REVIEWED, or empty
    scan: Path = Path()  # file of the mesh
    n_maps: int = 0  # number of maps from templates that count
    verdict: str = ""  # of the best of these maps, "failed" without one, empty for a template
    probability: float = np.nan  # of that map
    misfit: str = ""  # reason why the specimen does not fit the others; empty where it does
    space: str = ""  # "LPS", "RAS" or ""

    @property
    def landmarks(self) -> LandmarkSet:
        """The landmarks in the form that files hold."""
        return LandmarkSet(self.points.names, self.points.points, self.specimen, self.space, notes=self.open_flags)

    @property
    def open_flags(self) -> tuple[str, ...]:
        """The flags of landmarks that nobody has reviewed; empty for the others."""
        return tuple("" if flag in REVIEWED else flag for flag in self.flags)


def read_templates(files: Sequence[Path], scans: ShapeFolder) -> list[Template]:
    """Read the landmarks of specimens that are among the scans; a file may hold several specimens.

    A file belongs to the scan whose name equals the file's name or its beginning. Several files of one scan are joined,
    such as landmarks and a file for each curve; a curve is then named after its file.
    """
    by_name: dict[str, Template] = {}
    positions: dict[str, dict[str, np.ndarray]] = {}
    for file in files:
        sets = read_landmark_sets(file)
        for one in sets:
            name = _scan_of(one.specimen if len(sets) > 1 else landmark_stem(file), scans, file)
            path = scans.shapes[name]
            mesh, space = read_shape_mesh(path), mesh_space(path)
            if len(mesh.faces) == 0:
                raise refuse(str(path), "a surface with faces", "a point cloud", "Landmarks lie on surfaces")
            landmarks = _name_curve(one, landmark_stem(file), name)
            points = place_landmarks(landmarks, mesh, str(file), space=space)
            own_points = positions.setdefault(name, {})
            if repeated := own_points.keys() & set(points.names):
                got = f"two with {min(repeated)!r}"
                raise refuse(str(file), f"one file for each landmark of {name}", got, "leave one out")
            own_points |= zip(points.names, points.points, strict=True)
            by_name.setdefault(name, Template(name, file, path, mesh, points, space or _space(landmarks, points)))
    names = tuple(dict.fromkeys(label for own_points in positions.values() for label in own_points))
    curves = find_curves(names)
    names = tuple(names[row] for row in [*fixed_rows(names), *(row for curve in curves for row in curve.rows)])
    for one, curve in itertools.product(by_name.values(), find_curves(names)):
        count = sum(names[row] in positions[one.specimen] for row in curve.rows)
        if 0 < count < len(curve.rows):
            expected = f"{len(curve.rows)} points of the curve {curve.name}, as another has"
            raise refuse(str(one.file), expected, f"{count}", "resample them alike")
    templates: list[Template] = []
    for one in by_name.values():
        own_points = np.array([positions[one.specimen].get(name, np.full(3, np.nan)) for name in names])
        points = points_on_surface(names, own_points, one.mesh)
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


def _name_curve(landmarks: LandmarkSet, stem: str, specimen: str) -> LandmarkSet:
    """Name the curve of a file without other landmarks after the rest of the file's name."""
    rest = stem.removeprefix(specimen).strip("._- ")
    if not rest or fixed_rows(landmarks.names) or len(find_curves(landmarks.names)) > 1:
        return landmarks
    return replace(
        landmarks, names=tuple(re.sub(r"(curve|loop).*(_\d+)", rf"\g<1>{rest}\2", one) for one in landmarks.names)
    )


def template_pairs(templates: Sequence[Template], scans: ShapeFolder) -> list[Pair]:
    """Return the pairs to match: from each template to every other scan, also to other templates, which tests them."""
    return [Pair(one.specimen, name) for one in templates for name in scans.shapes if name != one.specimen]


def corrected_pairs(
    templates: Sequence[Template], scans: ShapeFolder, corrections: Mapping[str, Corrections], folder: Path
) -> dict[Pair, tuple[Path, Path]]:
    """Write the landmarks with which corrected specimens are matched again; return both files of each such pair.

    Maps between templates do not change, since they test the templates' landmarks.
    """
    template_points = {one.specimen: one.points for one in templates}
    files: dict[Pair, tuple[Path, Path]] = {}
    for pair in template_pairs(templates, scans):
        corrected = corrections.get(pair.target, {}) if pair.target not in template_points else {}
        source_points = dict(zip(template_points[pair.source].names, template_points[pair.source].points, strict=True))
        ends = {name: (source_points[name], corrected[name][0]) for name in corrected if name in source_points}
        ends = {name: points for name, points in ends.items() if np.isfinite(points).all()}
        if ends:
            folder.mkdir(parents=True, exist_ok=True)
            files[pair] = (folder / f"{pair.key}-source.csv", folder / f"{pair.key}-target.csv")
            for file, points in zip(files[pair], zip(*ends.values(), strict=True), strict=True):
                write_landmark_sets(file, [LandmarkSet(tuple(ends), np.array(points), file.stem)], force=True)
    return files


def propagate_landmarks(
    templates: Sequence[Template], specimen: str, path: Path, results: Mapping[str, Result], folder: Path
) -> SpecimenLandmarks:
    """Return the landmarks of a scan: the geometric medians of the templates' proposals, on the surface.

    Points of curves are slid first. ``results``: of the maps, by template; those without a verdict among
    :data:`USABLE_VERDICTS` count only where there are no others. The confidence of a landmark is the mean of the
    templates' confidences times the fraction of proposals near the median (:data:`MAX_SPREAD`).
    """
    names = templates[0].points.names
    done = [one for one in templates if one.specimen in results and results[one.specimen].status == "done"]
    used = [one for one in done if results[one.specimen].verdict in USABLE_VERDICTS] or done
    if not used:
        reason = next((r.reason for r in results.values() if r.reason), "it was not matched")
        unknown, flags = np.full(len(names), np.nan), ("",) * len(names)
        points = templates[0].points.without(np.ones(len(names), dtype=bool))
        return SpecimenLandmarks(specimen, points, unknown, unknown, flags, path, 0, "failed", misfit=reason)
    mesh = read_shape_mesh(path)
    unit = float(np.sqrt(surface_area(mesh)))
    transferred, rivals = [], []
    for template in used:
        probability = results[template.specimen].confidence
        match, points = _transfer(template, specimen, mesh, folder, 1.0 if probability is None else probability)
        transferred.append(points)
        rivals.append(_rival_distance(match, template, mesh, points))
    proposals = _slide(np.stack([points.points for points in transferred]), templates)
    median = geometric_median(proposals)
    distances = np.linalg.norm(proposals - median, axis=2)
    is_near = np.where(np.isnan(distances), np.nan, distances <= MAX_SPREAD * unit)
    confidence = _mean(np.stack([points.confidence for points in transferred])) * _mean(is_near)
    points = points_on_surface(names, median, mesh, confidence)
    spread = np.fmax.reduce(distances) if len(used) > 1 else np.full(len(names), np.nan)
    flags = tuple(_flag(*row) for row in zip(confidence, spread / unit, points.vertices >= 0, strict=True))
    best = max((results[one.specimen] for one in used), key=lambda r: r.confidence or 0.0)
    space = mesh_space(path) or templates[0].space
    misfit = _misfit(best, points, templates[0])
    probability = np.nan if best.confidence is None else best.confidence
    details = (path, len(used), best.verdict, probability, misfit, space)
    return SpecimenLandmarks(specimen, points, spread, np.fmin.reduce(rivals), flags, *details)


def _slide(points: np.ndarray, templates: Sequence[Template]) -> np.ndarray:
    """Return landmarks of specimens (s, l, 3) with points of curves slid against the template or templates' mean."""
    curves = [(np.array(curve.rows), curve.closed) for curve in find_curves(templates[0].points.names)]
    if not curves:
        return points
    template_points = np.stack([one.points.points for one in templates])
    reference = template_points[0] if len(template_points) == 1 else generalized_procrustes(template_points).consensus
    return np.stack([slide_semilandmarks(one, reference, curves) for one in points])


def _misfit(best: Result, points: NamedPoints, template: Template) -> str:
    """Return why a specimen does not fit the others, by its best map and its landmarks; empty where it does."""
    if best.verdict not in USABLE_VERDICTS:
        return f"its best map is {best.verdict} ({100 * (best.confidence or 0.0):.0f} %, from {best.source})"
    if is_mirror_image(points.points, template.points.points):
        return "its landmarks are a mirror image of the templates': left and right are swapped, or the scan is mirrored"
    return ""


def _transfer(template: Template, specimen: str, mesh: Mesh, folder: Path, p: float = 1.0) -> tuple[Match, NamedPoints]:
    """Return the map from a template to a scan, and the landmarks on it; those without a counterpart are missing.

    The confidence of a point is that of the map's neighbourhood times ``p``, the probability of the map.
    """
    file = map_path(folder, Pair(template.specimen, specimen).key)
    match = load_map(file)
    counterparts = find_counterparts(match, template.mesh, mesh, str(file))
    local_confidence = getattr(match, "local_confidence", None)  # a list of vertices has none
    local = np.ones(len(mesh.vertices)) if local_confidence is None else np.nan_to_num(local_confidence)
    transferred = transfer_points(template.points, counterparts, local)
    return match, replace(transferred, confidence=transferred.confidence * p)


def correct_points(points: NamedPoints, corrections: Corrections, mesh: Mesh) -> NamedPoints:
    """Return points with those in ``corrections`` moved to the closest points of the surface, with confidence 1."""
    is_corrected = np.array([name in corrections for name in points.names])
    positions = np.array([corrections[name][0] if name in corrections else np.full(3, np.nan) for name in points.names])
    corrected = points_on_surface(points.names, positions, mesh, np.ones(len(is_corrected)))

    def merge(after: np.ndarray, before: np.ndarray) -> np.ndarray:
        return np.where(is_corrected if after.ndim == 1 else is_corrected[:, None], after, before)

    return NamedPoints(
        points.names,
        PointMap(
            merge(corrected.place.faces, points.place.faces), merge(corrected.place.weights, points.place.weights)
        ),
        merge(corrected.points, points.points),
        merge(corrected.vertices, points.vertices),
        merge(corrected.confidence, points.confidence),
    )


def correct_landmarks(one: SpecimenLandmarks, corrections: Corrections) -> SpecimenLandmarks:
    """Return the landmarks of a specimen with corrections, which are named in place of the flags."""
    if not corrections:
        return one
    points = correct_points(one.points, corrections, read_shape_mesh(one.scan))
    words = zip(points.names, one.flags, strict=True)
    return replace(one, points=points, flags=tuple(corrections.get(name, (None, flag))[1] for name, flag in words))


def drop_unsure(one: SpecimenLandmarks, min_confidence: float) -> SpecimenLandmarks:
    """Return the landmarks with those below a confidence made missing."""
    points = one.points.without(~(one.points.confidence >= min_confidence))
    return replace(one, points=replace(points, confidence=one.points.confidence))


def template_landmarks(template: Template) -> SpecimenLandmarks:
    """Return a template's own landmarks as those of a specimen, with confidence 1 and without flags."""
    none = np.full(len(template.points.names), np.nan)
    points = replace(template.points, confidence=np.where(template.points.vertices >= 0, 1.0, np.nan))
    flags = ("",) * len(none)
    return SpecimenLandmarks(template.specimen, points, none, none, flags, template.scan, space=template.space)


def template_errors(templates: Sequence[Template], results: Mapping[Pair, Result], folder: Path) -> np.ndarray:
    """Return the distances of each template's landmarks, transferred to each other template, from that one's own.

    The shape is (pairs, l); NaN for missing landmarks and for points of curves, which may lie anywhere along them.
    """
    rows, names = [], templates[0].points.names
    fixed = fixed_rows(names)
    for a, b in itertools.permutations(templates, 2):
        result = results.get(Pair(a.specimen, b.specimen))
        if result is not None and result.status == "done":
            transferred = _transfer(a, b.specimen, b.mesh, folder)[1]
            rows.append(np.full(len(names), np.nan))
            rows[-1][fixed] = np.linalg.norm(transferred.points - b.points.points, axis=1)[fixed]
    return np.array(rows).reshape(-1, len(names))


def _mean(values: np.ndarray) -> np.ndarray:
    """Return the mean over the first axis without NaN; NaN where there is nothing else."""
    count = np.isfinite(values).sum(axis=0)
    return np.where(count > 0, np.nansum(values, axis=0) / np.maximum(count, 1), np.nan)


def _flag(confidence: float, spread: float, has_counterpart: bool) -> str:
    if not has_counterpart:
        return "no counterpart"
    if spread > MAX_SPREAD:
        return "templates disagree"
    return "low confidence" if not confidence >= MIN_CONFIDENCE else ""


def _rival_distance(match: Match, template: Template, mesh: Mesh, transferred: NamedPoints) -> np.ndarray:
    """Return the least distance at which an alternative map puts each landmark; NaN without alternatives."""
    distances = np.full(len(transferred.names), np.nan)
    for other in match.alternatives:
        if (other >= 0).all():
            points = transfer_points(template.points, find_counterparts(Match(other), template.mesh, mesh)).points
            distances = np.fmin(distances, np.linalg.norm(points - transferred.points, axis=1))
    return distances


def _scan_of(name: str, scans: ShapeFolder, file: Path) -> str:
    """Return the scan of landmarks called ``name``: that of the same name, else the longest that begins the name."""
    for candidate in (name, Path(name).stem):
        if candidate in scans.shapes:
            return candidate
    prefixes = [one for one in scans.shapes if name.startswith(one) and not name[len(one)].isalnum()]
    if prefixes:
        return max(prefixes, key=len)
    examples = ", ".join(list(scans.shapes)[:5])
    remedy = "Call the file of landmarks as the scan is called"
    raise refuse(str(file), f"the name of a scan in {scans.folder} ({examples}, ...)", repr(name), remedy)


def _space(landmarks: LandmarkSet, points: NamedPoints) -> str:
    """Return the coordinate system of a mesh that names none: that of its landmarks, or the other if these flipped."""
    if not landmarks.space or landmarks.vertices is not None:
        return landmarks.space
    distance, flipped = (np.nansum(np.abs(points.points - landmarks.points * sign)) for sign in (1.0, FLIP))
    return landmarks.space if distance <= flipped else {LPS: RAS, RAS: LPS}[landmarks.space]
