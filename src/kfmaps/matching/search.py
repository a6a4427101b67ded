"""Search for the map between two whole shapes among many candidates, scored without knowing the truth.

The wave kernel signature cannot tell left from right, so one fit of a symmetric body easily returns a map that is
mirrored, or mirrored on half of the body. A search therefore compares many maps:

1. Both shapes are sampled at two levels, a few hundred points and a thousand (:mod:`~kfmaps.matching.sample_pair`).
2. Initial maps are refined by ZoomOut on the coarse samples, and the best distinct ones on the fine samples
   (:mod:`~kfmaps.matching.candidates`). With landmarks the search is made without them first; where its map is "sure"
   and keeps to them, it is the result.
3. The candidates are ranked by their scores (:mod:`~kfmaps.matching.score`). The first few are registered, and the
   energy of their deformation becomes part of the score (:mod:`~kfmaps.matching.ranking`).
4. Maps to the mirror image of the target are compared with the best map where these may be better
   (:mod:`~kfmaps.matching.orientation`).
5. Landmarks that the best map contradicts are rejected, and steps 2 to 4 are repeated without them
   (:mod:`~kfmaps.matching.landmark_conflicts`).
6. The best map is compared with those that are as good except for their deformation, once these are repaired, and with
   itself with limbs exchanged (:mod:`~kfmaps.matching.limb_exchange`).
7. Between unlike shapes the best candidates, or the best alone where it is "sure", are registered and refined in turn,
   and ranked again (:mod:`~kfmaps.matching.registration_refine`).
8. The best candidate becomes the result, with alternatives, margins and a verdict
   (:mod:`~kfmaps.matching.search_result`). With landmarks it is compared with the result without them.

Some candidates are refined without descriptors. They show whether an entirely different map would be as good, in which
case the verdict is "ambiguous".
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import Array, refuse, seed_of
from kfmaps._progress import Progress
from kfmaps._threads import limit_threads, parallel
from kfmaps.config import Config
from kfmaps.matching.candidates import (
    FINE_FUNCTIONS,
    candidates,
    derived_seed,
    distinct_maps,
    map_distance,
    refine_fine,
    score_maps,
)
from kfmaps.matching.features import user_descriptors
from kfmaps.matching.fit import check_landmark_pairs
from kfmaps.matching.initial_maps import Start, drop_learned
from kfmaps.matching.landmark_conflicts import (
    contradicted_by,
    contradicted_landmarks,
    doubt_of_led,
    final_landmark_errors,
    is_most,
    without_landmark_errors,
)
from kfmaps.matching.landmark_evidence import build_guidance
from kfmaps.matching.limb_exchange import compare_exchanged
from kfmaps.matching.orientation import choose_orientation
from kfmaps.matching.quality import ShapeSamples, sample_for_scoring
from kfmaps.matching.ranking import (
    N_REGISTERED,
    ProxyCache,
    by_preference,
    ranking,
    rerank_close,
    rerank_near_duplicates,
    with_deformation_energy,
)
from kfmaps.matching.registration_refine import SwappedRepair, refine_by_registration, register_map_on_proxies
from kfmaps.matching.sample_pair import drop_landmarks, two_level_samples
from kfmaps.matching.score import (
    SCORE,
    Candidate,
    by_score,
    deforms_too_much,
    is_close_but_deformed,
    max_landmark_error,
    verdict,
)
from kfmaps.matching.search_result import SearchResult, build_result, calibrated_evidence
from kfmaps.matching.search_state import SearchState
from kfmaps.matching.self_maps import with_self_maps
from kfmaps.shape import Shape


def search_map(
    source: Shape,
    target: Shape,
    config: Config,
    *,
    landmarks: ArrayLike | None = None,
    descriptors: tuple[Array, Array] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
    shape_samples: tuple[ShapeSamples, ShapeSamples] | None = None,
) -> SearchResult:
    """Search for the map between two prepared shapes, as ``config.search`` says.

    The orientation "either", of which :mod:`kfmaps.matching.match` makes two searches, counts as "preserving".
    ``landmarks (l, 2)``: pairs "source vertex, target vertex". They guide the candidates and count in their scores.
    ``shape_samples``: samples of both shapes by :func:`scoring_samples` with the same ``rng``, which saves time where a
    shape is matched many times.
    """
    if config.search is None:
        raise refuse("search", "settings of a search", "None", "use Config(), which has them")
    is_reversing = config.search.orientation == "reversing"
    config, seed = drop_learned(config), seed_of(rng)
    report = progress or (lambda _stage, _done: None)
    pairs = check_landmark_pairs(landmarks, source, target)
    with limit_threads(config.threads):
        shape_samples = _search_samples(source, target, config, seed, shape_samples)
        samples = two_level_samples(source, target, shape_samples)
        report("candidates", 0.1)
        descriptors = user_descriptors(source, target, config.descriptors, descriptors)
        state = SearchState(
            source,
            target,
            config,
            landmarks=pairs[:0],
            evidence=None,
            rejected=np.zeros(0, dtype=bool),
            samples=samples,
            proxies=ProxyCache.of(source, target, samples.fine),
            candidates=[],
            ranked=[],
            orientation="reversing" if is_reversing else "preserving",
        )
        part = _candidates_between(report, 0.1, 0.5 if len(pairs) else 0.9)
        free = candidates(source, target, config, samples, seed, descriptors=descriptors, report=part)
        ranked = _rank(replace(state, candidates=free))
        if len(pairs) == 0:
            return _result(*_improve_best(ranked, report))
        may_be_sure = ranked.ranked[0].quality.calibrated_score >= SCORE.min_unrepaired_score
        found = _result(*_improve_best(ranked, report)) if may_be_sure else None
        samples = two_level_samples(source, target, shape_samples, pairs)
        state = replace(
            state,
            landmarks=pairs,
            evidence=samples.fine.landmark_evidence,
            rejected=np.zeros(len(pairs), dtype=bool),
            samples=samples,
            without_landmarks=free,
            # So far only a map to the mirror image casts a doubt.
            may_reverse=ranked.orientation == "reversing" or len(ranked.doubts) > 0,
        )
        return _search_with_landmarks(state, found, seed, descriptors, report)


def retry(result: SearchResult, number: int, least: float) -> SearchResult | None:
    """Return the result of one of ``result.retries``; ``None`` where it fails or its score is not above ``least``."""
    one, state = result.retries[number], result._search
    made = one.make() if isinstance(one, SwappedRepair) else one
    if state is None or made is None or made.score <= least:
        return None
    source = state.samples.fine.source
    others = [c for c in state.ranked if map_distance(c, made, source) > SCORE.distinct_distance]
    return build_result(state, made, others)


def scoring_samples(shape: Shape, rng: int | np.random.Generator | None = 0) -> ShapeSamples:
    """Return the samples of one shape that a search with ``rng`` uses, whatever the shape is matched with."""
    return with_self_maps(sample_for_scoring(shape.divided[0], rng=derived_seed(seed_of(rng))))


def _search_samples(
    source: Shape,
    target: Shape,
    config: Config,
    seed: int,
    shape_samples: tuple[ShapeSamples, ShapeSamples] | None,
) -> tuple[ShapeSamples, ShapeSamples]:
    """Return the samples of both shapes, without extremities where the search does not match these."""
    if shape_samples is None:
        drawn = derived_seed(seed)
        a, b = parallel(lambda shape: with_self_maps(sample_for_scoring(shape, rng=drawn)), (source, target))
        shape_samples = a, b
    assert config.search is not None
    if config.search.match_extremities:
        return shape_samples
    a, b = (replace(one, extremities=one.extremities.removed()) for one in shape_samples)
    return a, b


def _candidates_between(report: Progress, begin: float, end: float) -> Callable[[float], None]:
    """Return a callback that reports progress from 0 to 1 as that of the candidates from ``begin`` to ``end``."""
    return lambda done: report("candidates", begin + (end - begin) * done)


def _search_with_landmarks(
    state: SearchState,
    found: SearchResult | None,
    seed: int,
    descriptors: tuple[Array, Array] | None,
    report: Progress,
) -> SearchResult:
    """Return the result of a search with landmarks, without those that its best map contradicts.

    ``state``: before the search, with the landmarks; ``found``: the result without them, if it may be sure.
    """

    def rank(state: SearchState) -> SearchState:
        """Rank candidates that are made with the landmarks together with those that were found without."""
        samples, kept = state.samples, state.landmarks[~state.rejected]
        free, guided = score_maps(state.without_landmarks, samples.fine), []
        if len(kept):
            pair, part = (state.source, state.target), _candidates_between(report, 0.5, 0.9)
            guided = candidates(
                *pair, state.config, samples, seed, landmarks=kept, descriptors=descriptors, report=part
            )
        return _rank(replace(state, candidates=[*guided, *free], without_landmarks=free))

    given = state
    settled, is_close = _settled_result(found, state)
    if settled is not None and is_close:
        return settled
    ranked = rank(state)
    rejected, doubts = contradicted_landmarks(ranked)
    if found is not None and found.verdict == "sure" and rejected.any() and not rejected.all():
        # Wrong landmarks make no sure map less certain.
        doubts = tuple(one for one in doubts if one[0] is not ranked.ranked[0])
    if rejected.any():
        state = replace(state, rejected=rejected, samples=drop_landmarks(state.samples, rejected))
        settled, is_close = _settled_result(found, replace(state, doubts=doubts))
        if settled is not None and is_close:
            return settled
        ranked = rank(state)
    if settled is None:
        ranked = replace(ranked, doubts=(*ranked.doubts, *doubts))
        return _compare_with_free(found, *_improve_best(ranked, report), given)
    # The map that seemed to contradict landmarks keeps to them once it is repaired, and casts no doubt.
    result = _result(*_improve_best(ranked, report))
    return result if result.verdict == "sure" else settled


def _compare_with_free(
    found: SearchResult | None, state: SearchState, retries: tuple[Candidate | SwappedRepair, ...], given: SearchState
) -> SearchResult:
    """Return the result of ``state``, to which landmarks have led, compared with ``found``, the one without them.

    If ``found`` contradicts most landmarks, as if left and right were exchanged, and is "sure" or "likely" and clearly
    better, it rejects all landmarks and is the result. (Between unlike shapes only repaired maps show which is better.)
    Otherwise, and if it contradicts half of them, it casts a doubt unless it is clearly worse. If a rotation may
    preserve the shapes, landmarks decide instead. If both are nearly the same map, that is at least as probable as
    without landmarks. ``given``: before the search, with all landmarks.
    """
    free = found and found._search
    if found is None or free is None:
        return _result(state, retries)
    best, led = free.ranked[0], state.ranked[0]
    contradicted = contradicted_by(best, given)
    gain = without_landmark_errors(best).score - without_landmark_errors(led).score
    if is_most(contradicted) and gain > SCORE.close_margin and found.verdict in ("sure", "likely"):
        rejected = np.ones(len(given.landmarks), dtype=bool)
        samples, doubts = drop_landmarks(given.samples, rejected), doubt_of_led(led, best, gain, given.samples.fine)
        given = replace(given, rejected=rejected, samples=samples, doubts=doubts)
        return _settled_result(found, given)[0] or _result(state, retries)
    is_same = found.orientation == state.orientation
    is_same = is_same and map_distance(best, led, state.samples.fine.source) <= SCORE.twin_distance
    if is_same or is_most(~contradicted):
        result = _result(state, retries)
        if is_same and (found.confidence or 0.0) > (result.confidence or 0.0):
            return replace(result, confidence=found.confidence, verdict=found.verdict)
        return result
    if gain > -SCORE.close_margin and state.samples.fine.has_one_reflection:
        state = replace(state, doubts=(*state.doubts, (best, -gain)), trust_landmarks=False)
    return _result(state, retries)


def _settled_result(found: SearchResult | None, state: SearchState) -> tuple[SearchResult | None, bool]:
    """Return the result ``found`` without landmarks with those of ``state``, if it is "sure" and keeps to them all.

    Then they only refine it: right landmarks never make it less certain. Also return whether it keeps to them so
    closely that maps which begin with them would be no better, as between shapes so unlike that maps are repaired. If
    all landmarks are rejected it is the result whatever its verdict.
    """
    best = found and found._search
    if found is None or best is None or found.quality is None or found.orientation != state.orientation:
        return None, False
    if found.verdict != "sure" and not state.rejected.all():
        return None, False
    errors = final_landmark_errors(best.ranked[0], state)[~state.rejected]
    if (errors > max_landmark_error(found.quality)).any():
        return None, False
    doubts = (*best.doubts, *state.doubts)
    marked = replace(best, landmarks=state.landmarks, evidence=state.evidence, rejected=state.rejected, doubts=doubts)
    is_close = found.quality < SCORE.repair_score or errors.sum() <= len(errors) * SCORE.max_mean_landmark_error
    is_close = is_close and errors.max(initial=0.0) <= SCORE.max_isometric_landmark_error
    return _result(replace(marked, samples=state.samples), found.retries), is_close


def _rank(state: SearchState) -> SearchState:
    """Rank the candidates, then compare the best with its near duplicates and with maps to the mirror image."""
    samples, proxies = state.samples.fine, state.proxies
    ranked = ranking(state.candidates, samples, proxies)
    # Decided before a near duplicate that deforms less is sought: on a left and a right bone that may lie below the
    # limit.
    too_much = deforms_too_much(ranked[0])
    if ranked[0].deformation_energy is not None:
        behind = np.inf if too_much else SCORE.close_margin
        near = [c for c in state.candidates if map_distance(c, ranked[0], samples.source) <= SCORE.distinct_distance]
        ranked = rerank_near_duplicates(ranked, near, samples, proxies, SCORE.duplicate_distance, behind)
        ranked = distinct_maps(ranked, samples.source, SCORE.distinct_distance)
    state = replace(state, ranked=ranked)
    if too_much:
        # A right map with one extremity turned deforms as much as one that ought to go to the mirror image. Repaired
        # maps become candidates, which may be ranked once more together with others.
        state = _repair_rivals(replace(state, ranked=[_repaired(ranked[0], state), *ranked[1:]]))
        before = {id(c.functional_map) for c in ranked}
        repaired = [c.unregistered for c in state.ranked if id(c.functional_map) not in before]
        state = replace(state, candidates=[*state.candidates, *repaired])
    return choose_orientation(state, too_much)


def _repaired(candidate: Candidate, state: SearchState) -> Candidate:
    """Return a candidate registered on proxies and refined, or as it is where that is not better."""
    proxies, landmarks = state.proxies, state.landmarks[~state.rejected]
    if proxies.coarse is None:
        return candidate
    guidance = build_guidance(state.source, proxies.image, landmarks, shot=proxies.shot_guidance)
    *_, last = register_map_on_proxies(candidate.functional_map, proxies.coarse, guidance, landmarks)
    if last is None:
        return candidate
    C = last.functional_map[:FINE_FUNCTIONS, :FINE_FUNCTIONS]
    start = Start(candidate.name, C, candidate.uses_descriptors, fit=candidate.fit)
    repaired = with_deformation_energy(score_maps([start], state.samples.fine), proxies)[0]
    return repaired if repaired.score > candidate.score else candidate


def _repaired_often(candidate: Candidate, state: SearchState) -> Candidate:
    """Return a candidate repaired until it gains nothing, at most three times: one turned limb has needed two."""
    for _ in range(3):
        before, candidate = candidate, _repaired(candidate, state)
        if candidate is before:
            break
    return candidate


def _repair_rivals(state: SearchState) -> SearchState:
    """Repair the candidates that are as good as the best, or better, but for their registration; rank them again.

    A map that is as good except for one turned limb is a rival to the best only when that is repaired.
    """
    (best, *rest), proxies = state.ranked, state.proxies
    near = N_REGISTERED - 1
    repaired = [_repaired_rival(c, best, state) for c in rest[:near]]
    if all(a is b for a, b in zip(repaired, rest, strict=False)):
        return state
    if best.score - max(c.score for c in repaired) < SCORE.shot_margin:  # close ones are refined alike
        best = _refined_again(best, state)
    order = by_preference([best, *repaired, *rest[near:]])
    if order[0].score - order[1].score < SCORE.shot_margin:
        order = rerank_close(order, proxies)
    return replace(state, ranked=distinct_maps(order, state.samples.fine.source, SCORE.distinct_distance))


def _repaired_rival(candidate: Candidate, best: Candidate, state: SearchState) -> Candidate:
    """Return a rival, repaired where only its registration puts it behind the best."""
    if candidate.quality.calibrated_score > best.quality.calibrated_score:
        # The map alone is the better one; its registration may have begun badly.
        return _refined_again(candidate, state)
    if is_close_but_deformed(candidate, best, state.samples.fine.margin_factor):
        return _repaired_often(candidate, state)
    return candidate


def _refined_again(candidate: Candidate, state: SearchState) -> Candidate:
    """Return the better of a candidate and the same refined once more on the fine samples, registered and repaired."""
    again = refine_fine([candidate], state.samples, again=True)
    registered = by_score(with_deformation_energy(again, state.proxies))[:1]
    return by_score([candidate, *(_repaired_often(c, state) for c in registered)])[0]


def _result(state: SearchState, retries: tuple[Candidate | SwappedRepair, ...]) -> SearchResult:
    """Return the best candidate as the result of a search."""
    return replace(build_result(state, state.ranked[0], state.ranked[1:]), retries=retries)


def _improve_best(state: SearchState, report: Progress) -> tuple[SearchState, tuple[Candidate | SwappedRepair, ...]]:
    """Exchange similar limbs of the best map, and register the best maps of unlike surfaces; return the retries too."""
    samples, proxies = state.samples.fine, state.proxies
    if not samples.are_surfaces:
        return state, ()
    state = _repair_rivals(state)
    exchanged = _compare_exchanged(state)
    # Where the exchanged map is the better one it is compared with the rivals anew.
    state = exchanged if exchanged.ranked[0] is state.ranked[0] else _repair_rivals(exchanged)
    best, quality = state.ranked[0], state.ranked[0].quality.calibrated_score
    is_good = quality >= SCORE.repair_score
    if is_good and not deforms_too_much(best):
        return state, ()
    # One wrong map has been "sure" before repairs, and repairs of others have hardly changed one that is.
    is_sure = verdict(*calibrated_evidence(state, best, state.ranked[1:])) == "sure"
    ranked = state.ranked if is_sure else rerank_near_duplicates(state.ranked, state.candidates, samples, proxies)
    kept = state.landmarks[~state.rejected]
    ranked, retries = refine_by_registration(ranked, samples, proxies, kept, report, only_best=is_sure)
    if is_good and ranked[0].quality.calibrated_score < quality - SCORE.close_margin:
        return state, ()  # of a body and its mirror image what deforms less keeps distances less well
    return replace(state, ranked=ranked), retries


def _compare_exchanged(state: SearchState) -> SearchState:
    """Compare the best map with itself with limbs exchanged; the worse of the two becomes a doubt."""
    best = state.ranked[0]
    order = compare_exchanged(best, state.samples.fine, state.proxies)
    is_same = order[0].functional_map is best.functional_map
    ranked = state.ranked if is_same else [order[0], *state.ranked[1:]]
    doubts = [(worse, order[0].score - worse.score) for worse in order[1:]]
    return replace(state, ranked=ranked, doubts=(*state.doubts, *doubts))
