"""Match two shapes: the one call.

1. Both shapes are prepared: cleaned, with their bases and descriptors (:mod:`kfmaps.shape`).
2. Where one shape has much longer open boundaries than the other it may be a part of it. Then the part is placed on the
   whole (:mod:`~kfmaps.matching.partial.match_partial`). Of two shapes with open boundaries either one may be placed on
   the other, if there is a clear place; where both have the same boundaries, they are matched as wholes first.
3. Otherwise, or where that match is not sure, the shapes are matched as wholes: a search
   (:mod:`~kfmaps.matching.search`) or one fit (:mod:`~kfmaps.matching.fit`) gives a functional map, which is refined on
   all vertices and registered (:mod:`~kfmaps.matching.finish`). Where little seems to be missing and no placement of
   the part is clear at once, this is done before the full search for the part.
4. Where distances around many vertices are not preserved by the result, other candidates of the search are finished
   too, and the best is kept.
5. The most probable match is returned. Where a part was suspected and no match is sure, the match with the other shape
   as the part is tried last and, where both are open, that with both as parts of something larger. Neither is tried
   where boundaries, or a match as wholes that deforms little, show that hardly anything is missing.

Where the settings state which shape is a part, that is tried first, and the rest where it is not sure. With the
orientation "either" steps 2 to 5 are done twice, once with the mirror image of the target.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from typing import Literal, TypeGuard

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import Array, KfmapsWarning, seed_of
from kfmaps._progress import Progress, StageTimer
from kfmaps._threads import limit_threads
from kfmaps.config import Config
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, combine_guidance
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.matching.finish import MatchTask, better_match, final_score, refine_and_register, torn_area_fraction
from kfmaps.matching.fit import check_landmark_pairs, fit
from kfmaps.matching.landmark_evidence import LANDMARK_WEIGHT, LANDMARK_WEIGHT_UNLIKE, build_guidance
from kfmaps.matching.memory import check_match_memory
from kfmaps.matching.partial.detect import PartDetection, detect_part
from kfmaps.matching.partial.match_partial import file_ratio, match_partial
from kfmaps.matching.partial.place_part import GivenUp, same_units
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.reindexing import reindexing
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ONE_FIT, MatchPart
from kfmaps.matching.score import SCORE, lower_probability
from kfmaps.matching.search import retry, search_map
from kfmaps.matching.search_result import SearchResult
from kfmaps.registration.alternating_registration import WEIGHT, position_normal_guidance
from kfmaps.shape import Shape, lower_to_size, prepare_both

_FIT_AS_WHOLES = "taken for whole: as wholes they fit better than as parts"


def match(
    source: Mesh | Shape,
    target: Mesh | Shape,
    config: Config | None = None,
    *,
    landmarks: ArrayLike | None = None,
    descriptors: tuple[Array, Array] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
    shape_samples: tuple[ShapeSamples, ShapeSamples] | None = None,
) -> Match:
    """Find for each vertex of ``target`` the corresponding vertex of ``source``, as :func:`kfmaps.match` does.

    ``landmarks (l, 2)``: pairs "source vertex, target vertex", 0-based. ``shape_samples``: samples of both shapes by
    :func:`kfmaps.matching.search.scoring_samples` with the same ``rng``. They save an eighth of the time where a shape
    is matched many times, and change nothing.
    """
    config = lower_to_size(config or Config(), source, target)
    prepared = prepare_both(source, target, config, progress=progress)
    if any(isinstance(one, Shape) and one not in prepared for one in (source, target)):
        shape_samples = None  # they are of other faces
    with limit_threads(config.threads):
        pair = reindexing(prepared[0], prepared[1], divided=config.search is not None)
    pairs = check_landmark_pairs(landmarks, *pair.given)
    clean_landmarks = pair.clean_landmarks(pairs if len(pairs) else None)
    descriptors = pair.clean_descriptors(descriptors)
    check_match_memory(config, len(prepared[0].mesh.vertices), len(prepared[1].mesh.vertices), len(pairs))
    meshes = (
        source.given_mesh if isinstance(source, Shape) else source,
        target.given_mesh if isinstance(target, Shape) else target,
    )
    task = MatchTask(meshes, pair, config, pairs, seed_of(rng), StageTimer(progress))

    def wholes(task: MatchTask) -> Callable[[MatchPart], Match]:
        return partial(_match_wholes, task, clean_landmarks, descriptors, shape_samples)

    is_either = config.search is not None and config.search.orientation == "either"
    with limit_threads(config.threads):
        found = _match_either_way(task, wholes) if is_either else _match_as_stated(task, wholes(task))
    if found.partial.which != "none" and (descriptors is not None or config.descriptors.extra):
        warnings.warn("your own descriptors are not used: a part is placed by SHOT and distances", KfmapsWarning, 2)
    return found


def _match_either_way(task: MatchTask, wholes: Callable[[MatchTask], Callable[[MatchPart], Match]]) -> Match:
    """Return the better of the map that preserves orientation and the one to the mirror image.

    Landmarks decide if it contradicts fewer. Otherwise the other one is its rival unless that fits much less well. Of
    wholes deformations do not count, since poses may be mirrored.
    """
    search = task.config.search
    assert search is not None
    if not all(len(mesh.faces) for mesh in task.meshes):  # point clouds have no mirror image
        return _match_as_stated(task, wholes(task))
    found = []
    for way in ("preserving", "reversing"):
        one = replace(task, config=replace(task.config, search=replace(search, orientation=way)))
        found.append(replace(_match_as_stated(one, wholes(one)), config=task.config))
    is_comparable = found[0].partial.which == found[1].partial.which
    fits = [_fit_score(one) if is_comparable else (one.confidence or 0.0) for one in found]
    n_rejected = [len(one.score.rejected_landmarks) for one in found]
    chosen = int(fits[1] > fits[0]) if n_rejected[0] == n_rejected[1] else int(n_rejected[1] < n_rejected[0])
    best, other = found[chosen], found[1 - chosen]
    is_settled = n_rejected[0] != n_rejected[1] or fits[chosen] - fits[1 - chosen] > SCORE.either_margin
    if is_settled or best.verdict == "unlikely":
        return best
    alternatives = (other.target_to_source, *best.alternatives)[: search.n_alternatives]
    scores = (best.score.scores[0], other.score.scores[0], *best.score.scores[1:])[: len(alternatives) + 1]
    confidence = None if best.confidence is None else min(best.confidence, 0.5)
    told = {"confidence": confidence, "verdict": "ambiguous", "alternatives": alternatives}
    return replace(best, score=replace(best.score, scores=scores), **told)


def _fit_score(match: Match) -> float:
    """Return the score of a match; without deformation of one as wholes."""
    return match.score.scores[0] if match.score.quality is None else match.score.quality


def _match_as_stated(task: MatchTask, wholes: Callable[[MatchPart], Match]) -> Match:
    """Return the match with the part that the settings state, or that the boundaries suggest."""
    stated = task.config.partial.part
    if stated == "auto":
        return _match_detected(task, _detect_part(task), wholes)
    return _match_stated(task, stated, wholes)


def _detect_part(task: MatchTask) -> PartDetection:
    """Return which shape may be a part, as the boundaries suggest."""
    source, target = task.shapes("preserving")
    return detect_part(source.mesh, target.mesh)


def _match_detected(
    task: MatchTask, detection: PartDetection, wholes: Callable[[MatchPart], Match], tried: str = ""
) -> Match:
    """Return the match of a part and a whole, of two parts, or that of ``wholes``, as the boundaries suggest.

    ``tried``: what has been stated and matched already: two parts are not matched again.
    """
    which, match_wholes = detection.which, cache(lambda: wholes(MatchPart(reason=detection.reason)))
    if which in ("none", "both") and _has_same_cuts(match_wholes(), detection):
        return match_wholes()
    clear = _match_clear_part(task, detection)
    if clear is not None:
        part, covers = clear
        if _share(part) < SCORE.part.min_whole_area:
            return part
        return _check_by_wholes(part, match_wholes(), _covering(detection.reason) if covers else None)
    if which in ("source", "target"):
        return _lower_open(_match_open(task, which, detection, wholes, tried), detection)
    found = match_wholes()
    best = _lower_open(found, detection)
    is_settled = found.verdict == "sure" or _deforms_at_most(found, SCORE.part.max_deformation_of_two)
    if which == "none" or is_settled or task.config.search is None:
        return best
    return _more_probable(best, _match_as(task, "both", detection.reason))


def _lower_open(match: Match, detection: PartDetection) -> Match:
    """Return a match as wholes with a lower probability where a shape is open; any other as it is.

    Nothing is known about what is missing, unless both have the same boundaries.
    """
    if match.partial.which != "none" or detection.which == "none" or detection.same_loops:
        return match
    confidence, verdict = lower_probability(match.confidence, match.verdict, min(detection.opening, 1.0))
    return replace(match, confidence=confidence, verdict=verdict)


def _match_open(
    task: MatchTask,
    which: Literal["source", "target"],
    detection: PartDetection,
    wholes: Callable[[MatchPart], Match],
    tried: str,
) -> Match:
    """Return the most probable match of a shape that has long open boundaries and one that has shorter ones or none."""
    has_search = task.config.search is not None
    if has_search and _may_be_whole(detection):
        part, best = _match_holed(task, which, detection, wholes)
    else:
        part, as_wholes = _match_part(task, which, detection.reason)
        best = part if _fits(part) or _is_fragment(part, task) else _more_probable(part, wholes(as_wholes))
    if best.verdict == "sure" or best.confidence is None or detection.is_one_view or _is_whole(best, detection):
        return best
    if not _is_smaller_in_files(part, task):
        best = _compare_opposite(task, best, "target" if which == "source" else "source")
    if best.verdict == "sure" or not detection.both_open or tried == "both":
        return best
    return _more_probable(best, _match_as(task, "both", "both have open boundaries"))


def _match_clear_part(task: MatchTask, detection: PartDetection) -> tuple[Match, bool] | None:
    """Return the match of one of two open shapes as a part of the other if it soon is "sure".

    Also return whether each covers the other. As wholes two heads, say, that were cut at different places are squeezed
    onto each other, and scores may not tell. The shape that is smaller in files of one unit is the part first, else the
    more open one.
    """
    is_cut = detection.both_open and detection.opening > SCORE.part.max_small_opening
    if task.config.search is None or not is_cut:
        return None
    ratio, first = file_ratio(*task.shapes("preserving")), detection.more_open
    if ratio is not None and same_units("auto", ratio, both_partial=True):
        first = "source" if ratio > 1 else "target"
    for which in ("source", "target") if first == "source" else ("target", "source"):
        try:
            with task.clock("parts"):
                part, covers = match_partial(task, which, detection.reason, math.sqrt(SCORE.part.full_area), 0.0)
        except GivenUp:
            continue
        if part.verdict == "sure":
            return part, covers
    return None


def _covering(reason: str) -> MatchPart:
    """Return what a match as wholes says of shapes that were matched as a part and a whole, and cover each other."""
    return MatchPart(reason=f"taken for whole: {reason}, but each covers all of the other", suspected=True)


def _check_by_wholes(part: Match, whole: Match, covering: MatchPart | None) -> Match:
    """Return the match of one of two open shapes as a part of the other, or that as wholes.

    Only a match as wholes is compared with maps that exchange limbs. So where it has the same map, and is "ambiguous",
    the part is no surer. It is the answer where each shape covers the other: it has what collections need.
    ``covering``: what it says of parts then.
    """
    known, vertices = part.target_to_source >= 0, unit_area(part.source).vertices
    moved = vertices[whole.target_to_source[known]] - vertices[part.target_to_source[known]]
    if np.linalg.norm(moved, axis=1).mean() >= SCORE.distinct_distance or whole.verdict not in ("sure", "ambiguous"):
        return part
    if covering is not None:
        return replace(whole, partial=covering)
    return part if whole.verdict == "sure" else replace(part, confidence=whole.confidence, verdict=whole.verdict)


def _match_stated(
    task: MatchTask,
    stated: Literal["none", "source", "target", "both"],
    wholes: Callable[[MatchPart], Match],
) -> Match:
    """Return the match with the part that the settings state.

    Where it is not "sure" and the boundaries suggest something else, the match that these suggest is the answer if it
    is "sure" or "likely", and more probable: a wrong statement makes no map worse.
    """
    found = wholes(MatchPart()) if stated == "none" else _match_as(task, stated, "as asked for")
    if task.config.search is None:
        return found
    detection = _detect_part(task)
    best = _lower_open(found, detection)
    if best.verdict == "sure":
        return best
    is_cut = not _may_be_whole(detection)
    is_part = detection.which == stated and (is_cut or stated == "both" or _is_small_part(best))
    if is_part or (stated == "none" and not is_cut):
        return best
    if stated == "none":
        other = _match_detected(task, detection, lambda _: found)
    elif detection.which in ("none", stated):
        other = _lower_open(wholes(MatchPart(reason=_FIT_AS_WHOLES, suspected=True)), detection)
    else:
        other = _match_detected(task, detection, wholes, stated)
    return _more_probable(best, other) if other.verdict in ("sure", "likely") else best


def _fits(part: Match | None) -> TypeGuard[Match]:
    """Return whether a part was placed and is not "unlikely"."""
    return part is not None and part.verdict != "unlikely"


def _is_small_part(part: Match | None) -> bool:
    """Return whether a part was placed, is not "unlikely", and is too small for a whole with holes."""
    return _fits(part) and _share(part) < SCORE.part.min_whole_area


def _is_smaller_in_files(part: Match | None, task: MatchTask) -> TypeGuard[Match]:
    """Return whether a part lies at about the scale of the files, in which it is the smaller shape.

    Both files are in one unit then, and the other shape is no part of it: a scan with its floor is larger than a body.
    """
    ratio, scale = file_ratio(*task.shapes("preserving")), part and part.partial.scale
    if part is None or ratio is None or scale is None:
        return False
    ratio = ratio if part.partial.which == "target" else 1 / ratio
    return ratio < 1 and abs(math.log(scale / ratio)) < SCORE.part.in_unit


def _is_fragment(part: Match | None, task: MatchTask) -> TypeGuard[Match]:
    """Return whether a part lies at the scale of the files, and has so little of the whole that it is none itself."""
    return _is_smaller_in_files(part, task) and _share(part) < SCORE.part.max_fragment_area


def _share(part: Match) -> float:
    """Return the area of a placed part over that of the whole."""
    return (part.partial.scale or 1.0) ** 2


def _match_as(task: MatchTask, which: Literal["source", "target", "both"], reason: str) -> Match:
    """Return the match with ``which`` shape as the part."""
    with task.clock("parts"):
        return match_partial(task, which, reason)[0]


def _may_be_whole(detection: PartDetection) -> bool:
    """Return whether so little is missing that both shapes may be whole ones."""
    return detection.opening <= SCORE.part.max_hole_opening


def _is_whole(match: Match, detection: PartDetection) -> bool:
    """Return whether both shapes are whole ones but for holes, by their boundaries and by a match as wholes."""
    if detection.opening <= SCORE.part.max_small_opening:
        return True
    return _may_be_whole(detection) and _deforms_at_most(match, SCORE.part.max_whole_deformation)


def _has_same_cuts(match: Match, detection: PartDetection) -> bool:
    """Return whether neither shape has what the other lacks, by a match as wholes.

    It is "sure" and deforms little, or both shapes have the same boundaries and it is not "unlikely".
    """
    if detection.same_loops:
        return match.verdict != "unlikely"
    return match.verdict == "sure" and _deforms_at_most(match, SCORE.part.max_deformation_of_equal)


def _deforms_at_most(match: Match, limit: float) -> bool:
    """Return whether a match as wholes deforms the shapes by no more energy than ``limit``."""
    energy = match.score.deformation_energy
    return energy is not None and energy <= limit


def _more_probable(first: Match | None, second: Match) -> Match:
    """Return the match that is more probably right; the ``first`` where both are equally probable."""
    return second if first is None or (second.confidence or 0.0) > (first.confidence or 0.0) else first


def _match_holed(
    task: MatchTask,
    which: Literal["source", "target"],
    detection: PartDetection,
    wholes: Callable[[MatchPart], Match],
) -> tuple[Match | None, Match]:
    """Return the match of a part and a whole, if one was placed, and the better of it and that of ``wholes``.

    A body with holes is matched well either way, one of different proportions only as a whole. If little is missing the
    full search for a part comes last, since it takes longer than all else, and not at all where both are whole.
    """
    part, as_wholes, is_clear = None, MatchPart(reason=_FIT_AS_WHOLES, suspected=True), True
    is_small = detection.opening <= SCORE.part.max_small_opening
    least = math.sqrt(SCORE.part.min_whole_area) if is_small else 0.0
    try:
        part, as_wholes = _match_part(task, which, detection.reason, least, clear_area=SCORE.part.min_whole_area)
    except GivenUp:
        is_clear = False
    if part is not None and (part.verdict == "sure" or _is_small_part(part)):
        return part, part
    best = _more_probable(part, wholes(as_wholes))
    if is_clear or best.verdict == "sure" or _is_whole(best, detection):
        return part, best
    part, _ = _match_part(task, which, detection.reason)
    return part, _more_probable(part, best)


def _match_part(
    task: MatchTask,
    which: Literal["source", "target"],
    reason: str,
    least_scale: float = 0.0,
    clear_area: float = math.inf,
) -> tuple[Match | None, MatchPart]:
    """Return the match of a part and a whole, and what a match of whole shapes says about parts.

    The match is ``None`` where each shape covers the other. ``least_scale`` and ``clear_area``: see
    :class:`kfmaps.matching.partial.place_part.PartTask`.
    """
    with task.clock("parts"):
        part, covers = match_partial(task, which, reason, least_scale, clear_area)
    if covers:
        return None, _covering(reason)
    return part, MatchPart(reason=_FIT_AS_WHOLES, suspected=True)


def _compare_opposite(task: MatchTask, best: Match, which: Literal["source", "target"]) -> Match:
    """Return ``best``, or the match with the other shape as the part.

    A scan with its floor has more than its template. In one of the two matches the part has then mostly shrunk to the
    least scale.
    """
    least = math.sqrt(SCORE.part.full_area)
    reason = "the other has more besides, as a scan with its floor"
    try:
        with task.clock("the other as a part"):
            opposite, _ = match_partial(task, which, reason, least)
    except GivenUp:
        return best
    if (opposite.partial.scale or 0.0) < least:
        return best
    scale = best.partial.scale
    has_shrunk = len(task.landmarks) == 0 and _fits(best) and scale is not None and scale < SCORE.part.shrunk_scale
    return opposite if has_shrunk else _more_probable(best, opposite)


def _match_wholes(
    task: MatchTask,
    landmarks: np.ndarray | None,
    descriptors: tuple[Array, Array] | None,
    shape_samples: tuple[ShapeSamples, ShapeSamples] | None,
    as_wholes: MatchPart,
) -> Match:
    """Return the match of two whole shapes, by a search or by one fit; ``as_wholes``: what it says about parts."""
    task = replace(task, partial=as_wholes)
    config, report = task.config, task.clock.report
    if config.search is None:
        return refine_and_register(task, _fit_once(task, landmarks, descriptors), None)
    with task.clock("candidates"):
        found = search_map(
            *task.shapes(task.orientation),
            config,
            landmarks=landmarks,
            descriptors=descriptors,
            rng=task.seed,
            progress=report,
            shape_samples=None
            if task.orientation == "reversing"
            else shape_samples,  # they are not of the mirror image
        )
    return _retry_torn(task, found, _finish_result(task, found))


def _fit_once(task: MatchTask, landmarks: np.ndarray | None, descriptors: tuple[Array, Array] | None) -> SearchResult:
    """Return the map of one fit, without a search."""
    shapes, options = task.shapes("preserving"), {"rng": task.seed, "progress": task.clock.report}
    result = fit(*shapes, task.config, landmarks=landmarks, descriptors=descriptors, **options)
    task.clock.seconds.update(result.seconds)
    verdict = "unchecked" if landmarks is None else "landmarks"
    pairs = check_landmark_pairs(landmarks, *shapes)
    return SearchResult(result.functional_map, ONE_FIT, result, verdict, landmarks=pairs)


def _retry_torn(task: MatchTask, found: SearchResult, best: Match) -> Match:
    """Return ``best`` or, where much of its area is torn, the best of it and the other results that a search offers."""
    for i in range(len(found.retries)):
        if (torn_area_fraction(best) or 0.0) <= SCORE.max_torn_area:
            break
        with task.clock(f"another way, {i + 1}"):
            # A candidate that would have to deform less too to become the better match is not worth its time.
            other = retry(found, i, final_score(best))
            if other is not None:
                retried = replace(task, clock=StageTimer(task.clock.report))
                best = better_match(best, _finish_result(retried, other))
    return best


def _finish_result(task: MatchTask, found: SearchResult) -> Match:
    """Refine and register the map of a search with its guidance."""
    return refine_and_register(task, found, _search_guidance(found, task.shapes(found.orientation)))


def _search_guidance(found: SearchResult, shapes: tuple[Shape, Shape]) -> DescriptorGuidance | None:
    """Return the guidance for refining the map of a search on all vertices: SHOT, landmarks, extremities, positions.

    Positions and normals take part where the search has registered the shapes, that is between unlike ones.
    """
    meshes = [shape.mesh for shape in shapes]
    extremities = found.extremities and found.extremities.guidance(meshes[0], meshes[1])
    weight = LANDMARK_WEIGHT if found.is_near_isometric else LANDMARK_WEIGHT_UNLIKE
    guidance = build_guidance(*shapes, found.landmarks, extremities, found.shot_guidance, lead=weight)
    if found.registered_vertices is None:
        return guidance
    moved = 1 if found.swapped else 0
    meshes[moved] = Mesh(found.registered_vertices, meshes[moved].faces)
    return combine_guidance([(1.0, guidance), (WEIGHT, position_normal_guidance(*meshes))])
