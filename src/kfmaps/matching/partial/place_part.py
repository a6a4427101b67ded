"""Place a part on a whole: the best of several placements, and its margin over the others.

1. Both shapes are sampled, large ones as coarse proxies (:mod:`~kfmaps.matching.partial.samples`).
2. Samples are placed at many scales, and the likeliest placements are refined
   (:mod:`~kfmaps.matching.partial.scale_search`).
3. The part is registered quickly from each placement, and alternatives that place it elsewhere are compared
   (:mod:`~kfmaps.matching.partial.candidates`). The best grows anew from each of its regions.
4. The best candidate is registered fully, on all vertices in the end (:mod:`~kfmaps.matching.partial.registration`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._threads import parallel
from kfmaps.config import Partial
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.coarsen import CoarseProxy, coarse_proxy, spread_vertices
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.partial.candidates import (
    PartCandidate,
    candidates_at_scale,
    compare_alternatives,
    make_candidate,
    margin,
    regrow_best,
)
from kfmaps.matching.partial.one_view import is_view_of
from kfmaps.matching.partial.registration import (
    Overlap,
    PartRegistration,
    find_overlap,
    refine_registration,
    register_part,
)
from kfmaps.matching.partial.samples import PartPair, PartSurface, part_samples
from kfmaps.matching.partial.scale_search import (
    LARGER_SCALES,
    SCALES,
    TRIALS,
    Placement,
    fit_scale,
    refine_placement,
    refit_scale,
    search_scale,
    try_scales,
)
from kfmaps.matching.score import SCORE, Calibration, by_score, scale_cost, select_distinct, verdict

_PROXY_FROM, _PROXY_VERTICES = 15_000, 5_000  # vertices above which a coarse proxy is placed, and of the proxy
_MIN_SCALE_RATIO = 1.12  # ratio of two scales from which both are tried


class GivenUp(Exception):
    """A search for a part found nothing that its task asks for: a clear placement, or one that is large enough."""


@dataclass(frozen=True, eq=False)
class PlacedPart:
    """A part placed on a whole."""

    registration: PartRegistration
    overlap: Overlap
    # Of all candidates, the best first, as if nothing were known that it contradicts: landmarks, and the files' unit.
    scores: tuple[float, ...]
    margin: float  # over the best candidate that places the part elsewhere
    unguided: np.ndarray  # (n_p, 3): the part's vertices after a registration without landmarks
    calibration: Calibration  # the numbers of the verdict


@dataclass(frozen=True, eq=False)
class PartTask:
    """A part to be placed on a whole."""

    part: Mesh  # at unit area, as the whole
    whole: Mesh
    settings: Partial
    # √area of the part over that of the whole in their files; it is one of the scales that are tried, and the only one
    # where units are the same (:func:`same_units`).
    ratio: float | None = None
    both_partial: bool = False  # whether the whole may lack something too
    rng: int = 0
    least_scale: float = 0.0  # raise :exc:`GivenUp` where all likely placements are smaller
    # Raise it also where the search would not end early and the part seems to have this share of the whole's area or
    # more; try no scale below ``least_scale`` then.
    clear_area: float = math.inf
    # Returns the images of vertices of a whole by its near-symmetries (:func:`kfmaps.matching.self_maps.self_images`).
    self_images: Callable[..., np.ndarray] | None = None
    may_be_mirrored: bool = False  # whether a mirror image of the part that fits better is a rival

    @cached_property
    def is_one_view(self) -> bool:
        """Whether the part is the scan of one camera (:mod:`kfmaps.matching.partial.one_view`)."""
        return not self.both_partial and is_view_of(self.part, self.whole)


def place_part(
    task: PartTask, landmarks: np.ndarray | None = None, progress: Callable[[float], None] | None = None
) -> PlacedPart:
    """Place a part on a whole.

    ``landmarks (l, 2)``: vertices of the part and of the whole; ``progress``: is called with the share of the work that
    is done.
    """
    report = progress or (lambda _done: None)
    pairs = np.zeros((0, 2), dtype=np.int64) if landmarks is None else np.asarray(landmarks)
    part, whole, settings, ratio, both_partial = task.part, task.whole, task.settings, task.ratio, task.both_partial
    fixed = same_units(settings.scale, ratio, both_partial)
    if fixed and ratio is None:
        raise refuse("units", "shapes whose sizes are known", "prepared ones without", "prepare them again")
    proxies = [_placed_proxy(mesh, vertices) for mesh, vertices in ((part, pairs[:, 0]), (whole, pairs[:, 1]))]
    counts = settings.samples, settings.whole_samples
    samples = [
        part_samples(proxy.mesh, count, proxy.owner[vertices], task.rng)
        for proxy, count, vertices in zip(proxies, counts, pairs.T, strict=True)
    ]
    one_unit = (0.25, 1.1)  # scales of a part by the files, between which these are likely to be in one unit
    in_files = None if both_partial or ratio is None or not one_unit[0] < ratio < one_unit[1] else ratio
    on_whole = proxies[1].vertices[samples[1].samples]
    find_images = None if task.self_images is None else partial(task.self_images, on_whole, turned=task.is_one_view)
    pair = PartPair(samples[0], samples[1], fixed, both_partial, in_files, task.is_one_view, find_images)
    report(0.15)
    found = _search_placements(pair, task, report)
    report(0.75)
    last, on = _register_fully(found[0].registration, pair, lambda done: report(0.75 + 0.25 * done)), pair.whole
    unguided = (_register_fully(last, pair, report, guided=False) if len(pairs) else last).vertices[proxies[0].owner]
    if any(len(proxy.vertices) < len(mesh.vertices) for proxy, mesh in zip(proxies, (part, whole), strict=True)):
        on = PartSurface(whole)
        last = refine_registration(last, proxies[0], part, on, pairs)
    paid = found[0].evidence.landmark_cost + _unit_cost(found[0], pair)
    lead, scores = margin(found, len(pairs)), [one.score + paid for one in found]
    image = _find_better_mirrored(found[0], pair) if task.may_be_mirrored else None
    if image is not None:
        lead, scores = 0.0, [scores[0], image.score + paid, *scores[1:]]
    return PlacedPart(last, find_overlap(last, on), tuple(scores), lead, unguided, _calibration(found[0], pair))


def same_units(scale: str, ratio: float | None, both_partial: bool) -> bool:
    """Return whether both shapes are taken to be in one unit.

    Nothing bounds the scale of two parts, and the score prefers a wrong one: the pairs of
    `benchmarks/part_to_part.py` have errors of 5 at the scale of their files, and of 20 at any (research/parts.md).
    """
    most = 2.0  # ratio of the sizes of two parts in one unit; an inch is 2.54 cm
    alike = both_partial and ratio is not None and 1 / most <= ratio <= most
    return scale == "fixed" or (scale == "auto" and alike)


def _search_placements(pair: PartPair, task: PartTask, report: Callable[[float], None]) -> list[PartCandidate]:
    """Return registered placements, the best first.

    The search ends early where the best supported placement at the scale of the files, or at any, is clear.
    """
    ratio = task.ratio
    scales = [ratio] if pair.fixed_scale and ratio else [*SCALES, *(LARGER_SCALES if pair.both_partial else ())]
    if not pair.fixed_scale and ratio and scales[0] / _MIN_SCALE_RATIO < ratio < scales[-1] * _MIN_SCALE_RATIO:
        scales.append(ratio)
    if math.isfinite(task.clear_area) and not pair.fixed_scale:
        scales = [scale for scale in scales if scale >= task.least_scale]
    supported: list[Placement] = []
    for some in ([ratio], scales) if ratio in scales[1:] else (scales,):
        tried = [one.scale for one in supported]
        supported = try_scales(pair, some)
        found = [] if supported[0].scale in tried else _clear_placements(pair, supported[0])
        if found:
            return _regrow_unsure(found, pair)
    if supported[0].scale ** 2 >= task.clear_area:
        raise GivenUp
    min_support = 0.9  # of a placement that may become the best, over that of the best supported one
    least = min_support * supported[0].placed.support
    if all(one.scale < task.least_scale for one in supported if one.placed.support >= least):
        raise GivenUp
    likely = _likely_placements(pair, supported, scales, task.settings.candidates)
    if all(one.scale < task.least_scale for one in likely):
        raise GivenUp
    report(0.5)
    found = [make_candidate(one, pair) for one in likely]
    known = scales[0] if pair.fixed_scale and pair.both_partial else pair.small_scale
    found += [] if known is None else candidates_at_scale(pair, known)
    report(0.65)
    return _regrow_unsure(compare_alternatives(found, pair), pair)


def _regrow_unsure(order: list[PartCandidate], pair: PartPair) -> list[PartCandidate]:
    """Return ``order`` where its first candidate would be called "sure", else also what grows from it."""
    best, lead = order[0], margin(order, pair.part.n_landmarks)
    word = verdict(_told_score(best, pair), lead, numbers=_calibration(best, pair))
    return order if word == "sure" else regrow_best(order, pair)


def _told_score(one: PartCandidate, pair: PartPair) -> float:
    """Return the score of a candidate as if the files said nothing of its scale: it may be in another unit."""
    return one.score + _unit_cost(one, pair)


def _unit_cost(one: PartCandidate, pair: PartPair) -> float:
    """Return what a candidate pays for not lying at the scale of the files; the scan of one camera may not shrink."""
    return 0.0 if pair.is_one_view else scale_cost(one.evidence)


def _is_in_unit(one: PartCandidate, pair: PartPair) -> bool:
    """Return whether a candidate lies at the scale of the files, which are in one unit then."""
    is_known = pair.file_scale is not None and not pair.is_one_view
    return is_known and one.evidence.scale_change <= SCORE.part.in_unit


def _calibration(best: PartCandidate, pair: PartPair) -> Calibration:
    """Return the numbers of the verdict of the ``best`` placement."""
    numbers = SCORE.part
    if pair.both_partial:
        return numbers.calibration_of_two
    if pair.is_one_view:
        return numbers.calibration_of_view
    return numbers.calibration_in_unit if _is_in_unit(best, pair) else numbers.calibration


def _find_better_mirrored(best: PartCandidate, pair: PartPair) -> PartCandidate | None:
    """Return the mirror image of the part, placed at the scale of the ``best`` candidate, if it fits better.

    It must do so before registration, too: where only less deformation tells, the pose may be mirrored.
    """
    mirrored = replace(pair, part=pair.part.mirrored)
    placement = refine_placement(mirrored, try_scales(mirrored, [best.registration.scale])[0])
    if placement.score <= best.placement.score:
        return None
    image = make_candidate(placement, mirrored)
    return image if image.score > best.score + SCORE.mirror_gain else None


def _clear_placements(pair: PartPair, placement: Placement) -> list[PartCandidate]:
    """Return a placement registered, with its alternatives; none unless it is clear.

    A score says little of a single limb that lies elsewhere. Two relaxations rarely agree on it, so another one has to
    confirm the placement. A small part fits in many places, and placements of two parts score less: neither is clear.
    """
    if pair.both_partial:
        return []
    placement = refine_placement(pair, placement)
    found, numbers = make_candidate(placement, pair), SCORE.part
    least = numbers.early_exit_in_unit if _is_in_unit(found, pair) else numbers.early_exit_score
    if _told_score(found, pair) < least or found.registration.scale**2 < numbers.full_area:
        return []
    other = fit_scale(pair, try_scales(pair, [placement.scale], TRIALS[1])[0])
    apart = pair.whole.distances[placement.placed.match, other.placed.match]
    agrees = float((apart < numbers.distinct_distance).mean()) >= numbers.early_exit_agreement
    return compare_alternatives([found], pair) if agrees else []


def candidate_placements(
    pair: PartPair, supported: list[Placement], scales: list[float], count: int
) -> tuple[list[Placement], list[Placement]]:
    """Return rough placements by relaxation, at the ``count`` likeliest scales and more, and by beam searches.

    ``supported``: the placements by relaxation at all ``scales``, the best supported first.
    """
    first = select_distinct(supported, _scales_differ, count)
    rough = [*first]
    for params in TRIALS[1:]:
        rough += try_scales(pair, [one.scale for one in first[:2]], params)
    n_beams = 4  # placements by beam searches that are refined
    return rough, by_score(search_scale(pair, scales))[:n_beams]


def _scales_differ(one: Placement, other: Placement) -> bool:
    """Return whether the scales of two placements differ by more than the steps between those that are tried."""
    return max(one.scale / other.scale, other.scale / one.scale) > _MIN_SCALE_RATIO


def _likely_placements(pair: PartPair, supported: list[Placement], scales: list[float], count: int) -> list[Placement]:
    """Return the refined placements that are worth a registration, by relaxation and by beam searches."""
    rough, beams = candidate_placements(pair, supported, scales, count)
    fitted = parallel(lambda one: fit_scale(pair, one), [*rough, *beams])
    likely: list[Placement] = []
    # Few samples of a beam search are placed by their descriptors, so its scores are too low before registration.
    for some, most in ((fitted[: len(rough)], count + 1), (fitted[len(rough) :], 2)):
        likely += by_score(parallel(lambda one: refit_scale(pair, one), by_score(some)[:most]))
    return select_distinct(likely, _places_differ, count + 3)


def _places_differ(one: Placement, other: Placement) -> bool:
    """Return whether two placements differ at so many samples that they would be registered differently."""
    min_share = 2 / 3  # of samples at the same place from which two placements would be registered alike
    return float((one.placed.match == other.placed.match).mean()) < min_share


def _placed_proxy(mesh: Mesh, landmarks: np.ndarray) -> CoarseProxy:
    """Return the proxy of a mesh that is placed, coarse where the mesh is large, with all landmarks."""
    count = _PROXY_VERTICES if len(mesh.vertices) > _PROXY_FROM else len(mesh.vertices)
    return coarse_proxy(mesh, spread_vertices(mesh, count, landmarks))


def _register_fully(
    found: PartRegistration, pair: PartPair, progress: Callable[[float], None], guided: bool = True
) -> PartRegistration:
    """Register the part in full from where it lies, at the scale of its edges; ``guided``: with landmarks."""
    mesh, vertex_normals, samples = pair.whole.mesh, pair.whole.surface.normals, pair.part.samples
    places = closest_points(found.vertices[samples], mesh.vertices, mesh.faces)
    points, normals = places.points, vertex_normals[mesh.faces[places.faces]].mean(axis=1)
    half_trust = 0.02  # distance from the whole, in its √area, at which a registered sample is trusted by half
    trust = found.inside[samples] * np.exp2(-((places.distances / half_trust) ** 2)) + 1e-3
    ends = pair.whole.landmarks if guided else pair.whole.landmarks[:0]
    points[: len(ends)], normals[: len(ends)] = mesh.vertices[ends], vertex_normals[ends]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    scale = found.scale if pair.fixed_scale else found.scale * found.edge_ratio
    on = pair if guided else pair.unmarked
    return register_part(on, scale, points, normals, trust, progress=progress)
