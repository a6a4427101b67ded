"""A placed part as the answer of a match: points, functions and probabilities on both shapes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Literal

import numpy as np

from kfmaps._arrays import refuse, take, to_numpy
from kfmaps.fmap.confidence import local_confidence
from kfmaps.fmap.precise import nearest_vertices
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.finish import MatchTask
from kfmaps.matching.partial.place_part import PlacedPart, place_part
from kfmaps.matching.partial.registration import scale_mesh
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import MatchPart, MatchRegistration, MatchScore
from kfmaps.matching.score import SCORE, Calibration, landmark_support, part_landmark_cost, probability, verdict
from kfmaps.shape import Shape

COMMON = 0.5
"""Probability from which a vertex has a counterpart."""


def match_partial(
    task: MatchTask,
    which: Literal["source", "target", "both"],
    why: str,
    least_scale: float = 0.0,
    clear_only: bool = False,
) -> tuple[Match, bool]:
    """Match two shapes of which one is a part; return the match, and whether the common part is most of both.

    ``which``: the part. With "both" each may have what the other lacks; the one with the smaller area is bent, or the
    target where their units cannot be compared. ``why``: for what reason it is taken for a part; ``least_scale`` and
    ``clear_only``: see :func:`kfmaps.matching.partial.place_part.place_part`.
    """
    source, target = task.shapes("preserving")
    for shape in (source, target):
        if len(shape.mesh.faces) == 0:
            raise refuse(shape.name, "a surface with triangles", "a point cloud", "match it as a whole: partial 'none'")
    ratio = None if source.extent is None or target.extent is None else target.extent / source.extent
    forward = which == "target" or (which == "both" and (ratio is None or ratio <= 1))
    part, whole = (target, source) if forward else (source, target)
    pairs = task.pair.landmarks(task.landmarks)
    place_with = partial(
        place_part,
        part.mesh,
        whole.mesh,
        task.config,
        ratio=ratio if forward or ratio is None else 1 / ratio,
        both_partial=which == "both",
        rng=task.seed,
        progress=lambda done: task.clock.report("parts", done),
        least_scale=least_scale,
        clear_only=clear_only,
    )
    numbers = SCORE.part.calibration_of_two if which == "both" else SCORE.part.calibration
    marked = pairs[:, ::-1] if forward else pairs
    found, errors = _place_by_landmarks(place_with, marked, whole.mesh, numbers, which == "both")
    place = found.overlap.on_whole if forward else found.overlap.on_part
    overlaps = (found.overlap.whole, found.overlap.part) if forward else (found.overlap.part, found.overlap.whole)
    points = np.where(overlaps[1] > COMMON, nearest_vertices(place, (whole if forward else part).mesh), -1)
    scale = found.registration.scale
    areas = to_numpy(part.basis.mass) * found.overlap.part
    around = scale * geodesic_distances(part.mesh, marked[:, 0]) if len(marked) else np.zeros((0, len(areas)))
    support = landmark_support(errors, around, areas)
    at_scale = scale_mesh(part.mesh, scale)
    here, there = (whole.mesh, at_scale) if forward else (at_scale, whole.mesh)
    trust = local_confidence(here, there, points, sized=True)
    masses = to_numpy(part.basis.mass), to_numpy(whole.basis.mass)
    common = float(masses[0] @ found.overlap.part), float(masses[1] @ found.overlap.whole)
    rejected = np.flatnonzero(errors > SCORE.part.max_landmark_error)
    # The source's vertices on the target at unit area, where the source is the part.
    registered = None if forward else task.pair.bent(found.registration.vertices)
    reason = describe_part(which, scale, overlaps, why)
    match = task.result(
        points,
        _slanted_functional_map(points, source, target, scale if forward else 1 / scale),
        trust,
        # Where a vertex has no counterpart that is the nearest point that could be one.
        precise_map=task.pair.place(place),
        verdict=verdict(found.scores[0], found.margin, support=support, numbers=numbers),
        confidence=probability(found.scores[0], found.margin, support=support, numbers=numbers),
        score=MatchScore(found.scores, None, None, "a part bent onto the other", rejected),
        registration=MatchRegistration(registered),
        partial=MatchPart(which, reason, scale, True, *task.pair.overlap(*overlaps)),
    )
    return match, min(common) > SCORE.part.whole_overlap


def _place_by_landmarks(
    place_with: Callable[..., PlacedPart], pairs: np.ndarray, whole: Mesh, numbers: Calibration, two: bool
) -> tuple[PlacedPart, np.ndarray]:
    """Return a placement, and its errors, (l,), at the landmarks ``pairs (l, 2)`` when these do not count.

    A placement that contradicts some is compared with one by the others, or by none where most are contradicted or
    where the part fits nowhere with them, by the ``numbers`` of its verdict. The one with the better score is kept,
    where each pays for every landmark that it contradicts, as a part on a whole or as one of ``two`` parts: a slightly
    better score is no reason to drop right ones.
    """

    def errors(found: PlacedPart) -> np.ndarray:
        return np.linalg.norm(found.unguided[pairs[:, 0]] - whole.vertices[pairs[:, 1]], axis=1)

    def paid(found: PlacedPart) -> float:
        return found.scores[0] - part_landmark_cost(errors(found), two)

    found = place_with(landmarks=pairs)
    wrong = errors(found) > SCORE.part.max_landmark_error
    nowhere = verdict(found.scores[0], found.margin, numbers=numbers) == "unlikely"
    if len(pairs) and (nowhere or wrong.any()):
        others = pairs[:0] if nowhere or wrong.mean() > 0.5 else pairs[~wrong]
        found = max(place_with(landmarks=others, progress=None), found, key=paid)
    return found, errors(found)


def _slanted_functional_map(points: np.ndarray, source: Shape, target: Shape, ratio: float) -> np.ndarray:
    """The functional map ``(k_t, k_s)`` of ``points (n_t,)``, −1 where there is none, of functions of like frequency.

    ``ratio``: √area of the target over that of the source. The part's eigenvalues below the whole's last are about as
    many as its share of the area (Weyl), which slants the map's diagonal (Rodolà et al. 2017).
    """
    values_s = to_numpy(source.basis.eigenvalues)
    values_t = to_numpy(target.basis.eigenvalues) / ratio**2
    last = min(values_s[-1], values_t[-1])
    k_s, k_t = (max(int((values <= last).sum()), 1) for values in (values_s, values_t))
    known = points >= 0
    pulled = to_numpy(take(source.basis.functions[:, :k_s], np.maximum(points, 0))) * known[:, None]
    # Functions of unit norm on shapes of unit area, each in its own unit: constants go to constants on the part.
    weighted = to_numpy(target.basis.functions)[:, :k_t] * to_numpy(target.basis.mass)[:, None]
    return weighted.T @ pulled


def describe_part(which: str, scale: float, overlaps: tuple[np.ndarray, np.ndarray], reason: str) -> str:
    """Return one line about what was taken for a part, with the ``reason``.

    ``scale``: √area of the part over that of the whole; ``overlaps (n_s,)``, ``(n_t,)``: what both have in common.
    """
    if which == "both":
        shares = overlaps[0].mean(), overlaps[1].mean()
        return f"common: {shares[0]:.0%} of the source's vertices, {shares[1]:.0%} of the target's; {reason}"
    share = scale**2
    holes = 0.9  # share of the other's area from which a part is called a shape with holes
    if share >= holes:
        return f"the {which} has holes ({max(1 - share, 0):.0%} is missing)"
    return f"the {which} is a part, {share:.0%} of the other's area; {reason}"
