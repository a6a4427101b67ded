"""Match two shapes: the one call."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import Array, seed_of
from kfmaps._progress import Progress, StageTimer
from kfmaps._threads import limit_threads
from kfmaps.config import Config
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, combine_guidance
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.finish import MatchTask, better_match, final_score, refine_and_register, torn_area_fraction
from kfmaps.matching.fit import check_landmark_pairs, fit
from kfmaps.matching.landmark_evidence import LANDMARK_WEIGHT, LANDMARK_WEIGHT_UNLIKE, build_guidance
from kfmaps.matching.memory import check_match_memory
from kfmaps.matching.partial.detect import PartDetection, detect_part
from kfmaps.matching.partial.match_partial import match_partial
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.reindexing import reindexing
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ONE_FIT, MatchPart
from kfmaps.matching.score import SCORE
from kfmaps.matching.search import SearchResult, near_isometric, retry, search_map
from kfmaps.registration.alternating_registration import WEIGHT, position_normal_guidance
from kfmaps.shape import Shape, prepare_both

_HAS_MORE = "the other has more besides, as a scan with its floor"
_FIT_AS_WHOLES = "taken for whole: as wholes they fit better than as a part and a whole"


def match(
    source: Mesh | Shape,
    target: Mesh | Shape,
    config: Config | None = None,
    *,
    landmarks: ArrayLike | None = None,
    descriptors: tuple[Array, Array] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
    probes: tuple[ShapeSamples, ShapeSamples] | None = None,
) -> Match:
    """Find for each vertex of ``target`` the corresponding vertex of ``source``, as :func:`kfmaps.match` does.

    ``landmarks (l, 2)``: pairs "source vertex, target vertex", 0-based; ``probes``: what the search with this ``rng``
    needs to know of each shape, from :func:`kfmaps.matching.search.scoring_samples`. They save an eighth of the time
    where a shape is matched many times, and change nothing.
    """
    config = config or Config()
    prepared = prepare_both(source, target, config, progress=progress)
    pair = reindexing(prepared[0], prepared[1])
    pairs = check_landmark_pairs(landmarks, *pair.outside)
    marks, descriptors = pair.landmarks(pairs if len(pairs) else None), pair.descriptors(descriptors)
    check_match_memory(config, len(prepared[0].mesh.vertices), len(prepared[1].mesh.vertices), len(pairs))
    meshes = (
        source.given_mesh if isinstance(source, Shape) else source,
        target.given_mesh if isinstance(target, Shape) else target,
    )
    task = MatchTask(meshes, pair, config, pairs, seed_of(rng), StageTimer(progress))
    with limit_threads(config.threads):
        seen = _part_suspected(task)
        best, about = _match_part(task, seen)
        may_be_whole = config.search is not None and seen.opening <= SCORE.part.max_hole_opening
        if best is None or (best.verdict != "sure" and may_be_whole):
            # A body with holes is found either way, one of other proportions as a whole alone.
            best = _likelier(best, _match_wholes(replace(task, partial=about), marks, descriptors, probes))
        if config.partial.part != "auto" or seen.which == "none" or best.verdict == "sure" or best.confidence is None:
            return best
        return _compare_opposite(task, best, "target" if seen.which == "source" else "source")


def _likelier(first: Match | None, second: Match) -> Match:
    """Return the match that is more probably right, the ``first`` of two alike."""
    return second if first is None or (second.confidence or 0.0) > (first.confidence or 0.0) else first


def _compare_opposite(task: MatchTask, best: Match, which: Literal["source", "target"]) -> Match:
    """Return ``best``, or the match with the other shape as the part: a scan with its floor has more than its template.

    One of the two has mostly shrunk as far as it may.
    """
    least = math.sqrt(SCORE.part.full_area)
    with task.clock("the other as a part"):
        opposite, _ = match_partial(task, which, _HAS_MORE, least)
    if (opposite.partial.scale or 0.0) < least:
        return best
    scale = best.partial.scale
    has_shrunk = len(task.landmarks) == 0 and scale is not None and scale < SCORE.part.shrunk_scale
    return opposite if has_shrunk else _likelier(best, opposite)


def _match_wholes(
    task: MatchTask,
    marks: np.ndarray | None,
    descriptors: tuple[Array, Array] | None,
    probes: tuple[ShapeSamples, ShapeSamples] | None,
) -> Match:
    """The match of two whole shapes."""
    config, progress = task.config, task.clock.report
    if config.search is None:
        return refine_and_register(task, _fit_once(task, marks, descriptors), None)
    asked = config.search.orientation == "reversing"
    shapes = task.shapes("reversing" if asked else "preserving")
    with task.clock("candidates"):
        found = search_map(
            *shapes,
            config,
            landmarks=marks,
            descriptors=descriptors,
            rng=task.seed,
            progress=progress,
            probes=None if asked else probes,  # they are of the shapes as they were given
        )
    best = refine_and_register(task, found, _search_guidance(found, task.shapes(found.orientation)))
    return _try_others(task, found, best)


def _part_suspected(task: MatchTask) -> PartDetection:
    """Return which shape is a part: the one that was asked for, whatever the boundaries tell, or what they tell."""
    asked, shapes = task.config.partial.part, task.shapes("preserving")
    if asked != "auto":
        return PartDetection(asked, "" if asked == "none" else "as asked for", np.inf)
    return detect_part(shapes[0].mesh, shapes[1].mesh)


def _match_part(task: MatchTask, seen: PartDetection) -> tuple[Match | None, MatchPart]:
    """Return the match of a part and a whole, ``None`` where both are whole, and what a match of wholes says of it."""
    if seen.which == "none":
        return None, MatchPart(reason=seen.reason)
    with task.clock("parts"):
        part, covers = match_partial(task, seen.which, seen.reason)
    if task.config.partial.part != "auto" or (not covers and part.verdict != "unlikely"):
        return part, MatchPart(reason=_FIT_AS_WHOLES, suspected=True)
    but = "each covers all of the other" if covers else "it fits nowhere"
    return None, MatchPart(reason=f"taken for whole: {seen.reason}, but {but}", suspected=True)


def _fit_once(task: MatchTask, landmarks: np.ndarray | None, descriptors: tuple[Array, Array] | None) -> SearchResult:
    """The map of one fit, without a search."""
    shapes = task.shapes("preserving")
    one = fit(
        *shapes, task.config, landmarks=landmarks, descriptors=descriptors, rng=task.seed, progress=task.clock.report
    )
    task.clock.seconds.update(one.seconds)
    verdict = "unchecked" if landmarks is None else "landmarks"
    pairs = check_landmark_pairs(landmarks, *shapes)
    return SearchResult(one.functional_map, ONE_FIT, one, verdict, landmarks=pairs)


def _try_others(task: MatchTask, found: SearchResult, best: Match) -> Match:
    """The best of a finished map and, where it is torn, the others that the search offers."""
    for i in range(len(found.retries)):
        if (torn_area_fraction(best) or 0.0) <= SCORE.max_torn_area:
            break
        with task.clock(f"another way, {i + 1}"):
            # With a lower score it would not be better even if nothing of it were torn.
            other = retry(found, i, final_score(best))
            if other is not None:
                apart = replace(task, clock=StageTimer(task.clock.report))
                guidance = _search_guidance(other, task.shapes(other.orientation))
                best = better_match(best, refine_and_register(apart, other, guidance))
    return best


def _search_guidance(found: SearchResult, shapes: tuple[Shape, Shape]) -> DescriptorGuidance | None:
    """What guides the refinement of a map that a search has found."""
    meshes = [shape.mesh for shape in shapes]
    extremities = found.extremities and found.extremities.guide(meshes[0], meshes[1])
    lead = LANDMARK_WEIGHT if near_isometric(found) else LANDMARK_WEIGHT_UNLIKE
    guidance = build_guidance(*shapes, found.landmarks, extremities, found.shot_guidance, lead=lead)
    if found.registered_vertices is None:
        return guidance
    moved = 1 if found.swapped else 0
    meshes[moved] = Mesh(found.registered_vertices, meshes[moved].faces)
    return combine_guidance([(1.0, guidance), (WEIGHT, position_normal_guidance(*meshes))])
