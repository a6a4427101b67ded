"""Match a part and a whole: the placed part as points, functional map and overlap of both shapes."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Literal

import numpy as np

from kfmaps._arrays import refuse, take, to_numpy
from kfmaps.fmap.confidence import local_confidence
from kfmaps.fmap.precise import nearest_vertices
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import MIRROR, Mesh
from kfmaps.matching.finish import MatchTask
from kfmaps.matching.partial.place_part import PartTask, PlacedPart, place_part
from kfmaps.matching.partial.registration import scale_mesh
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import MatchPart, MatchRegistration, MatchScore
from kfmaps.matching.score import SCORE, landmark_support, part_landmark_cost, probability, verdict
from kfmaps.matching.self_maps import self_images
from kfmaps.shape import Shape

COMMON = 0.5
"""Probability from which a vertex has a counterpart."""


def match_partial(
    task: MatchTask,
    which: Literal["source", "target", "both"],
    why: str,
    least_scale: float = 0.0,
    clear_area: float = math.inf,
) -> tuple[Match, bool]:
    """Match two shapes of which one is a part; return the match, and whether the common part is most of both.

    ``which``: the part. With "both" each may have what the other lacks; then the one with the smaller area is
    registered, or the target where the units cannot be compared. ``why``: the reason to take it for a part;
    ``least_scale`` and ``clear_area``: see :class:`kfmaps.matching.partial.place_part.PartTask`. With the orientation
    "auto" the map preserves orientation, and is ambiguous where the mirror image of the part fits better.
    """
    search, orientation = task.config.search, task.orientation
    source, target = task.shapes(orientation)
    for shape in (source, target):
        if len(shape.mesh.faces) == 0:
            raise refuse(shape.name, "a surface with triangles", "a point cloud", "match it as a whole: partial 'none'")
    ratio = file_ratio(source, target)
    is_target = which == "target" or (which == "both" and (ratio is None or ratio <= 1))
    part, whole = (target, source) if is_target else (source, target)
    pairs = task.pair.clean_landmarks(task.landmarks)
    landmarks = pairs[:, ::-1] if is_target else pairs
    ratio = ratio if is_target or ratio is None else 1 / ratio
    placing = PartTask(
        part.mesh,
        whole.mesh,
        task.config.partial,
        ratio,
        which == "both",
        task.seed,
        least_scale,
        clear_area,
        None if which == "both" else partial(self_images, whole, rng=task.seed),
        may_be_mirrored=search is not None and search.orientation == "auto",
    )
    place_with = partial(place_part, placing, progress=lambda done: task.clock.report("parts", done))
    found, errors = _place_by_landmarks(place_with, landmarks, whole.mesh, which == "both")
    overlap, scale = found.overlap, found.registration.scale
    scaled = scale_mesh(part.mesh, scale)
    if is_target:
        places, overlaps, meshes = overlap.on_whole, (overlap.whole, overlap.part), (whole.mesh, scaled)
    else:
        places, overlaps, meshes = overlap.on_part, (overlap.part, overlap.whole), (scaled, whole.mesh)
    points = np.where(overlaps[1] > COMMON, nearest_vertices(places, source.mesh), -1)
    mass_p, mass_w = to_numpy(part.basis.mass), to_numpy(whole.basis.mass)
    areas = mass_p * overlap.part
    distances = scale * geodesic_distances(part.mesh, landmarks[:, 0]) if len(landmarks) else np.zeros((0, len(areas)))
    registered = found.registration.vertices * (MIRROR if orientation == "reversing" else 1)
    calibrated = found.scores[0], found.margin, None, landmark_support(errors, distances, areas), found.calibration
    match = task.result(
        points,
        _slanted_functional_map(points, source, target, scale if is_target else 1 / scale),
        local_confidence(*meshes, points, sized=True),
        # Where a vertex has no counterpart this is the nearest point that could be one.
        precise_map=task.pair.given_precise_map(places) if len(task.meshes[0].faces) else None,
        verdict=verdict(*calibrated),
        confidence=probability(*calibrated),
        orientation=orientation,
        score=MatchScore(
            found.scores,
            initialization="a part registered onto the other",
            rejected_landmarks=np.flatnonzero(errors > SCORE.part.max_landmark_error),
        ),
        # The source's vertices on the target at unit area, where the source is the part.
        registration=MatchRegistration(None if is_target else task.pair.given_registered(registered)),
        partial=MatchPart(
            which, describe_part(which, scale, overlaps, why), scale, True, *task.pair.given_overlap(*overlaps)
        ),
    )
    return match, bool(min(mass_p @ overlap.part, mass_w @ overlap.whole) > SCORE.part.whole_overlap)


def file_ratio(source: Shape, target: Shape) -> float | None:
    """Return √area of the target over that of the source in their files; ``None`` where a size is not known."""
    return None if source.extent is None or target.extent is None else target.extent / source.extent


def _place_by_landmarks(
    place_with: Callable[..., PlacedPart], pairs: np.ndarray, whole: Mesh, two: bool
) -> tuple[PlacedPart, np.ndarray]:
    """Return a placement, and its errors, (l,), at the landmarks ``pairs (l, 2)`` when these take no part in it.

    A placement that contradicts some landmarks is compared with one by the others. Where it contradicts most, or where
    the part fits nowhere with them, it is compared with one without landmarks. The
    better score decides, less a cost for each contradicted landmark, which is higher for ``two`` parts: so right
    landmarks are not dropped for a slightly better score. A placement without landmarks that has shrunk to the least
    scale never wins: it fits nearly everywhere.
    """

    def errors(found: PlacedPart) -> np.ndarray:
        return np.linalg.norm(found.unguided[pairs[:, 0]] - whole.vertices[pairs[:, 1]], axis=1)

    found = place_with(landmarks=pairs)
    is_wrong = errors(found) > SCORE.part.max_landmark_error
    fits_nowhere = verdict(found.scores[0], found.margin, numbers=found.calibration) == "unlikely"
    if len(pairs) and (fits_nowhere or is_wrong.any()):
        others = pairs[:0] if fits_nowhere or is_wrong.mean() > 0.5 else pairs[~is_wrong]
        other = place_with(landmarks=others, progress=None)
        has_shrunk = len(others) == 0 and other.registration.scale < SCORE.part.shrunk_scale
        both = (found,) if has_shrunk else (other, found)
        found = max(both, key=lambda found: found.scores[0] - part_landmark_cost(errors(found), two))
    return found, errors(found)


def _slanted_functional_map(points: np.ndarray, source: Shape, target: Shape, ratio: float) -> np.ndarray:
    """Return the functional map ``(k_t, k_s)`` of ``points (n_t,)``, −1 where there is none, up to one frequency.

    ``ratio``: √area of the target over that of the source. The part's eigenvalues below the whole's last are about as
    many as its share of the area (Weyl), which slants the map's diagonal (Rodolà et al. 2017).
    """
    values_s = to_numpy(source.basis.eigenvalues)
    values_t = to_numpy(target.basis.eigenvalues) / ratio**2
    last = min(values_s[-1], values_t[-1])
    k_s, k_t = (max(int((values <= last).sum()), 1) for values in (values_s, values_t))
    is_known = points >= 0
    pulled = to_numpy(take(source.basis.functions[:, :k_s], np.maximum(points, 0))) * is_known[:, None]
    # Functions have unit norm on shapes of unit area, so constants are mapped to constants on the part.
    weighted = to_numpy(target.basis.functions)[:, :k_t] * to_numpy(target.basis.mass)[:, None]
    return weighted.T @ pulled


def describe_part(which: str, scale: float, overlaps: tuple[np.ndarray, np.ndarray], reason: str) -> str:
    """Return one line about the part, with the ``reason`` to take it for one.

    ``scale``: √area of the part over that of the whole; ``overlaps (n_s,)``, ``(n_t,)``: what both have in common.
    """
    if which == "both":
        shares = overlaps[0].mean(), overlaps[1].mean()
        return f"common: {shares[0]:.0%} of the source's vertices, {shares[1]:.0%} of the target's; {reason}"
    share = scale**2
    min_share = 0.9  # of the other's area from which a part is called a shape with holes
    if share >= min_share:
        return f"the {which} has holes ({max(1 - share, 0):.0%} is missing)"
    return f"the {which} is a part, {share:.0%} of the other's area; {reason}"
