"""The choice among many maps, judged without knowing the truth, with landmarks or without.

A wave kernel signature cannot tell left from right, and one fit of a symmetric body easily returns a flipped or half-
flipped map. So many candidates are refined cheaply on samples (:mod:`kfmaps.matching.candidates`), all are judged by
:func:`kfmaps.matching.quality.map_quality` and by how well they keep to the landmarks, and the best is finished on all
points. *Rivals*, refined without a look at the descriptors, show whether some altogether different map would do as
well, in which case the answer is "ambiguous".
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import Array, refuse, seed_of, to_numpy
from kfmaps._progress import Progress
from kfmaps._threads import limit_threads, parallel
from kfmaps.config import Config
from kfmaps.fmap.approximate_nearest import N_PROBE_FAST
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.fmap.refine import Refinement
from kfmaps.fmap.zoomout import MAX_CANDIDATES, MAX_EXACT_PAIRS
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.sampling import SampledBasis, stratified_vertices
from kfmaps.matching.candidates import (
    FINE,
    by_score,
    candidates,
    compose_with_symmetries,
    distinct_maps,
    drawn_seed,
    map_distance,
    rerefine,
    score_maps,
)
from kfmaps.matching.extremity_matching import ExtremityVertices, extremity_vertices
from kfmaps.matching.features import user_descriptors
from kfmaps.matching.fit import check_landmark_pairs
from kfmaps.matching.initial_maps import Start, drop_learned
from kfmaps.matching.landmark_evidence import LandmarkEvidence, build_guidance, landmark_errors
from kfmaps.matching.limb_exchange import compare_exchanged
from kfmaps.matching.quality import ShapeSamples, sample_for_scoring, subsample
from kfmaps.matching.ranking import ProxyCache, ranking, rerank_near_duplicates, with_bending
from kfmaps.matching.registration_refine import SwappedRepair, refine_by_registration, register_map_on_proxies
from kfmaps.matching.sample_pair import COARSE_SAMPLES as FEW
from kfmaps.matching.sample_pair import SamplePair, TwoLevelSamples, drop_landmarks, mirrored_pair, two_level_samples
from kfmaps.matching.score import (
    SCORE,
    Candidate,
    excess_deformation,
    landmark_support,
    max_landmark_error,
    probability,
    rejected_landmarks,
    verdict,
)
from kfmaps.matching.self_maps import with_self_maps
from kfmaps.matching.solve import Fit
from kfmaps.shape import Shape

_FEWER = 100
"""Functions at the end of the refinement of shapes that differ much: their high functions do not correspond."""
STRETCH = 0.01
"""Area over which sizes may change evenly in the non-rigid fit of such shapes."""


@dataclass(frozen=True, eq=False)
class SearchResult:
    """A map before it is finished on all points: what :func:`search_map` returns."""

    functional_map: np.ndarray  # (k, k)
    initialization: str  # what the candidate started from
    fit: Fit | None  # the kernel fit that the map began with, if any
    verdict: str  # "sure", "likely", "ambiguous" or "unlikely" of a search; "landmarks" or "unchecked" of one fit
    confidence: float | None = None  # probability that the map is right, see :func:`kfmaps.matching.score.probability`
    scores: tuple[float, ...] = ()  # of the map and of each alternative, higher is better
    alternatives: tuple[np.ndarray, ...] = ()  # the distinct other maps, best first
    # By how much the map precedes the first alternatives, those that were made on purpose: with two limbs exchanged, or
    # a better one to the mirror image, which it does not precede.
    doubts: tuple[float, ...] = ()
    # (l, 2): those that the map keeps to.
    landmarks: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    # (d,): the numbers, from 0, of those given that it contradicts.
    rejected_landmarks: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    # "preserving" or "reversing": whether it is a map to the target or to its mirror image.
    orientation: str = "preserving"
    quality: float | None = None  # score of the map of a search, apart from landmarks
    deformation_energy: float | None = None  # see :class:`kfmaps.registration.evidence.DeformationEnergy`
    # Extremities that guide the refinement, where the shapes differ so much that they should.
    extremities: ExtremityVertices | None = None
    # (n_s, 3): the source's vertices roughly on the target, where the shapes differ so much that these guide it as
    # well.
    registered_vertices: np.ndarray | None = None
    swapped: bool = False  # whether ``registered_vertices`` are the target's vertices on the source instead, (n_t, 3)
    # What may turn out better on all vertices; :func:`retry` makes a result of it.
    retries: tuple[Candidate | SwappedRepair, ...] = ()
    _search: _Search | None = None

    @property
    def shot_guidance(self) -> DescriptorGuidance | None:
        """Guidance by SHOT on all vertices, where a search knows it."""
        return self._search and self._search.copies.shot_guidance


@dataclass(frozen=True, eq=False)
class _Search:
    """The state of a search."""

    source: Shape
    target: Shape
    config: Config
    pairs: np.ndarray  # (l, 2): landmarks as they were given
    evidence: LandmarkEvidence | None  # of all of them
    wrong: np.ndarray  # (l,): those that the best candidate contradicts
    samples: TwoLevelSamples
    copies: ProxyCache
    found: list[Candidate]  # all
    ranked: list[Candidate]  # the distinct ones, best first
    orientation: str  # "preserving" or "reversing"
    # Alternatives that were made on purpose, to the mirror image or with two limbs exchanged, or that contradict the
    # landmarks, and by how much the best map precedes each.
    doubts: tuple[tuple[Candidate, float], ...] = ()
    alone: list[Candidate] = field(default_factory=list)  # those of ``found`` that landmarks had no say in


def search_map(
    source: Shape,
    target: Shape,
    config: Config,
    *,
    landmarks: ArrayLike | None = None,
    descriptors: tuple[Array, Array] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
    probes: tuple[ShapeSamples, ShapeSamples] | None = None,
) -> SearchResult:
    """Find a map between two prepared shapes, as ``config.search`` says.

    ``landmarks (l, 2)``: pairs "source vertex, target vertex". They steer the candidates and rank them; those that the
    best map contradicts while it keeps to most of the others are left out
    (:func:`kfmaps.matching.score.rejected_landmarks`). ``probes``: of :func:`scoring_samples` with the same ``rng``:
    spares the work where a shape is matched many times. Not used with landmarks, whose distances they have too.
    """
    if config.search is None:
        raise refuse("search", "settings of a search", "None", "use Config(), which has them")
    config = drop_learned(config)
    given = seed_of(rng)
    report = progress or (lambda _stage, _done: None)
    pairs = check_landmark_pairs(landmarks, source, target)
    with limit_threads(config.threads):
        everything = two_level_samples(
            source, target, _search_samples(source, target, config, pairs, given, probes), pairs
        )
        report("candidates", 0.1)
        own = user_descriptors(source, target, config.descriptors, descriptors)
        alone: list[Candidate] = []
        if len(pairs):
            half = _candidates_between(report, 0.1, 0.5)
            alone = without_landmarks(source, target, config, everything, given, descriptors=own, report=half)

        none, copies = np.zeros(len(pairs), dtype=bool), ProxyCache.of(source, target, everything.whole)
        evidence = everything.whole.landmark_evidence
        base = _Search(source, target, config, pairs, evidence, none, everything, copies, [], [], "preserving")

        def search_with(wrong: np.ndarray) -> _Search:
            kept = drop_landmarks(everything, wrong) if wrong.any() else everything
            rest = _candidates_between(report, 0.5 if len(pairs) else 0.1, 0.9)
            found: list[Candidate] = []
            if not len(pairs) or not wrong.all():
                left = pairs[~wrong]
                found = candidates(source, target, config, kept, given, landmarks=left, descriptors=own, report=rest)
            free = score_maps(alone, kept.whole) if alone else []
            return _rank(replace(base, wrong=wrong, samples=kept, found=[*found, *free], alone=free))

        state = search_with(none)
        if len(pairs):
            wrong, doubts = _contradicted_landmarks(state)
            state = search_with(wrong) if wrong.any() else state
            state = replace(state, doubts=(*state.doubts, *doubts))
        state, retries = _improve_best(state, report)
        return replace(_to_result(state, state.ranked[0], state.ranked[1:]), retries=retries, _search=state)


def _candidates_between(report: Progress, begin: float, end: float) -> Callable[[float], None]:
    """Return what tells progress from 0 to 1 as that of the candidates from ``begin`` to ``end``."""
    return lambda done: report("candidates", begin + (end - begin) * done)


def _improve_best(state: _Search, report: Progress) -> tuple[_Search, tuple[Candidate | SwappedRepair, ...]]:
    """Exchange alike limbs of the best map, and register the best maps of unlike surfaces; return the retries too."""
    samples, copies = state.samples.whole, state.copies
    if not _are_surfaces(samples):
        return state, ()
    state = _compare_exchanged(state)
    if state.ranked[0].quality.score >= SCORE.repair_score:
        return state, ()
    ranked = rerank_near_duplicates(state.ranked, state.found, samples, copies)
    kept = state.pairs[~state.wrong]
    ranked, retries = refine_by_registration(ranked, samples, copies, kept, report)
    return replace(state, ranked=ranked), retries


def retry(result: SearchResult, number: int, least: float) -> SearchResult | None:
    """Return the result of one of ``result.retries``; ``None`` where it fails or its score is not above ``least``."""
    one, state = result.retries[number], result._search
    made = one.make() if isinstance(one, SwappedRepair) else one
    if state is None or made is None or made.score <= least:
        return None
    source = state.samples.whole.source
    return _to_result(state, made, [c for c in state.ranked if map_distance(c, made, source) > SCORE.distinct_distance])


def _search_samples(
    source: Shape,
    target: Shape,
    config: Config,
    pairs: np.ndarray,
    given: int,
    probes: tuple[ShapeSamples, ShapeSamples] | None,
) -> tuple[ShapeSamples, ShapeSamples]:
    """Return the samples of both shapes: ``probes`` where they serve; without extremities where nobody wants them."""
    if probes is None or len(pairs):
        sides = ((source, pairs[:, 0]), (target, pairs[:, 1]))
        seed = drawn_seed(given)
        a, b = parallel(lambda s: sample_for_scoring(s[0], rng=seed, landmarks=s[1]), sides)
        probes = a, b
    assert config.search is not None
    if config.search.match_extremities:
        return probes
    a, b = (replace(one, extremities=one.extremities.removed()) for one in probes)
    return a, b


def _are_surfaces(samples: SamplePair) -> bool:
    return samples.source.orientation is not None and samples.target.orientation is not None


def _rank(state: _Search) -> _Search:
    """Rank the candidates; those near the best are registered too, where that may change which comes first."""
    whole, copies, found = state.samples.whole, state.copies, state.found
    ranked = ranking(found, whole, copies)
    # Asked before a map is sought that deforms less: on a left and a right bone it may be a little below the limit.
    unduly = deforms_unduly(ranked[0])
    if ranked[0].deformation_energy is not None:
        behind = np.inf if unduly else SCORE.close_margin
        near = [c for c in found if map_distance(c, ranked[0], whole.source) <= SCORE.distinct_distance]
        near = rerank_near_duplicates(ranked, near, whole, copies, SCORE.duplicate_distance, behind)
        ranked = distinct_maps(near, whole.source, SCORE.distinct_distance)
    assert state.config.search is not None
    orientation = "reversing" if state.config.search.orientation == "reversing" else "preserving"
    state = replace(state, ranked=ranked, orientation=orientation)
    return _choose_orientation(_repair_best(state) if unduly else state, unduly)


def _repair_best(state: _Search) -> _Search:
    """Register the best candidate on proxies and refine it, and keep that where it is better.

    A right map with one extremity turned deforms as much as a map that ought to go to the mirror image.
    """
    best, copies, samples = state.ranked[0], state.copies, state.samples.whole
    if copies.coarse is None:
        return state
    guidance = build_guidance(state.source, copies.image, state.pairs, shot=copies.shot_guidance)
    *_, one = register_map_on_proxies(best.functional_map, copies.coarse, guidance, state.pairs)
    if one is None:
        return state
    start = Start(best.name, one.functional_map[:FINE, :FINE], best.uses_descriptors, fit=best.fit)
    made = with_bending(score_maps([start], samples), copies)[0]
    return replace(state, ranked=[made, *state.ranked[1:]]) if made.score > best.score else state


def _choose_orientation(state: _Search, unduly: bool) -> _Search:
    """Compare with maps to the mirror image where that is asked for, or where one may fit better.

    Unasked, maps to the mirror image are registered only where the best map deforms ``unduly`` or where one of them has
    a better score before registration. One that is clearly better replaces the best map, and so does one that is better
    and moves the shape as a whole. Any other that is better is kept beside the best map, and makes it ambiguous.
    With landmarks, one is better only if it is without them too.
    """
    config, samples = state.config, state.samples
    assert config.search is not None
    asked = config.search.orientation
    if not _are_surfaces(samples.whole) or asked not in ("either", "auto"):
        return state
    other = mirrored_pair(samples.whole)
    images, copies = reversed_best(state.found, other), ProxyCache.of(state.source, state.target, other)
    before = state.ranked[0].unregistered.score
    if not images or (asked == "auto" and not unduly and images[0].score < before + SCORE.mirror_gain):
        return state
    # A closer look raises no score by as much as would be needed.
    ranked = ranking(images, other, copies, state.ranked[0].score - SCORE.close_margin)
    image, energy = ranked[0], ranked[0].deformation_energy

    def gain(plain: _Search) -> float:
        ahead = image.score - plain.ranked[0].score
        if asked != "auto" or not len(plain.pairs):
            return ahead
        # Landmarks with left for right agree with the mirror image of any body that is its own mirror image.
        return min(ahead, _without_evidence(image).score - _without_evidence(_best_by_surface(plain)[0]).score)

    better = gain(state)
    if asked == "auto" and better > SCORE.mirror_gain:
        # A body that is nearly its own mirror image has a map that keeps orientation and is as good.
        kept = compose_with_symmetries(image, samples)
        if kept:
            found = [*state.found, *kept]
            alone = [*state.alone, *kept] if state.alone else []
            first = ranking(found, samples.whole, state.copies)
            state = replace(state, found=found, alone=alone, ranked=first)
            better = gain(state)
    congruent = energy is not None and energy < SCORE.congruent_energy
    margin = SCORE.mirror_gain if congruent else SCORE.mirror_margin
    if better > (SCORE.clear_margin if asked == "either" else margin):
        samples = replace(samples, whole=other)
        return replace(state, samples=samples, copies=copies, found=images, ranked=ranked, orientation="reversing")
    return replace(state, doubts=((image, -better),)) if asked == "auto" and better > SCORE.mirror_gain else state


def _compare_exchanged(state: _Search) -> _Search:
    """Compare the best map with itself with two alike limbs exchanged; the better leads, the other casts a doubt."""
    best, samples = state.ranked[0], state.samples.whole
    order = compare_exchanged(best, samples, state.copies)
    if len(order) == 1:
        return state
    kept = order[0].functional_map is best.functional_map
    ranked = state.ranked if kept else [order[0], *state.ranked[1:]]
    return replace(state, ranked=ranked, doubts=(*state.doubts, (order[1], order[0].score - order[1].score)))


def _contradicted_landmarks(state: _Search) -> tuple[np.ndarray, tuple[tuple[Candidate, float], ...]]:
    """Return which landmarks (l,) bool to leave out, and the map that casts a doubt on those that are kept, if any.

    The best map contradicts some while it keeps to most of the others. A map that is found without landmarks and would
    be called "sure" contradicts any number, unless a map that keeps to them fits the surfaces nearly as well; then
    neither is sure.
    """
    best, whole = state.ranked[0], state.samples.whole
    missed = ignore_landmarks(best, whole).landmark_errors
    limit = max_landmark_error(best.quality.score)
    wrong = rejected_landmarks(missed, limit)
    least = _without_evidence(best.unregistered).score - SCORE.repairable_margin
    near = [c for c in state.found if _without_evidence(c.unregistered).score > least]
    rivalled = any(map_distance(c, best, whole.source) > SCORE.distinct_distance for c in near)
    if not rivalled and not (missed > limit).any():
        return wrong, ()
    order = _best_by_surface(state)
    first, margin = order[0], order[0].score - order[1].score if len(order) > 1 else np.inf
    if verdict(first.quality.score, margin, first.deformation_energy) != "sure":
        return wrong, ()
    missed_by_first = ignore_landmarks(first, whole).landmark_errors
    far = missed_by_first > max_landmark_error(first.quality.score)
    if 2 * far.sum() > len(far):
        far = np.ones(len(far), dtype=bool)  # of sides that were exchanged those near the middle would mislead too
    ahead = _without_evidence(first).score - _without_evidence(best).score
    if ahead > SCORE.close_margin or not (far & (missed <= limit)).any():
        return far, ()
    return wrong, ((first, -ahead),)


def _best_by_surface(state: _Search) -> list[Candidate]:
    """Return the distinct candidates that were found without landmarks, best first, ranked without them."""
    found = state.found if state.orientation == "reversing" else state.alone
    found = [replace(c, landmark_errors=np.zeros(0)) for c in found or state.found]
    return ranking(found, state.samples.whole, state.copies)


def _without_evidence(found: Candidate) -> Candidate:
    """Return a candidate without landmarks, and without what is only known beside other candidates."""
    return replace(found, landmark_errors=np.zeros(0), strain=None, shot_error=None)


def _to_result(state: _Search, best: Candidate, rest: list[Candidate]) -> SearchResult:
    """Return ``best`` as the result of a search; ``rest`` are its alternatives, best first."""
    config, samples = state.config, state.samples.whole
    assert config.search is not None
    near = [(c, margin) for c, margin in state.doubts if margin < SCORE.shot_margin]
    margins = [*(margin for _, margin in near), *(_margin(best, rival) for rival in rest[:1])]
    if not _are_surfaces(samples) and (~state.wrong).sum() < 3:
        margins.append(0.0)  # nothing tells the map from its mirror image
    others = [*(c for c, _ in near), *rest][: config.search.n_alternatives]
    scores = [*(best.score - margin for _, margin in near), *(c.score for c in rest)][: len(others)]
    margin = max(min(margins, default=np.inf), 0.0)
    score = best.quality.score
    evidence = score, margin, best.deformation_energy, backed_by(best, samples)
    rejected = state.wrong & (state.wrong.all() | still_missed(best, samples, state.evidence))
    bases, maps = (state.source.basis, state.target.basis), [c.functional_map for c in others]
    extremities = None
    if score < SCORE.non_isometric_score:
        extremities = extremity_vertices(best.points, samples.source, samples.target)
    return SearchResult(
        functional_map=best.functional_map,
        initialization=best.name,
        fit=best.fit,
        confidence=probability(*evidence),
        verdict=verdict(*evidence),
        scores=tuple(float(score) for score in (best.score, *scores)),
        alternatives=alternative_maps(maps, *bases),
        doubts=tuple(margin for _, margin in near)[: len(others)],
        landmarks=state.pairs[~rejected],
        rejected_landmarks=np.flatnonzero(rejected),
        orientation=state.orientation,
        quality=score,
        deformation_energy=best.deformation_energy,
        extremities=extremities,
        registered_vertices=best.registered_vertices,
        swapped=best.swapped,
    )


def _margin(best: Candidate, rival: Candidate) -> float:
    """Return by how much ``best`` precedes a ``rival``, as the calibration knows it.

    A rival that keeps distances and descriptors as well and bends the shape no more than right maps do is the map after
    a symmetry of the shape: which of the two bends it less only the poses decide, so that does not count.
    """
    ahead = best.quality.score - rival.quality.score
    if ahead < SCORE.clear_margin and _excess(rival) < 0.0:
        return ahead
    return best.score - rival.score


def ignore_landmarks(found: Candidate, samples: SamplePair) -> Candidate:
    """Return the map as it is when landmarks have no say: how it misses them then tells of both."""
    return rerefine([found], replace(samples, landmark_cost=None))[0]


def still_missed(best: Candidate, samples: SamplePair, evidence: LandmarkEvidence | None) -> np.ndarray:
    """Return which of all landmarks given the map misses, (l,).

    One that a rough map of unlike shapes has missed, on a tail say, may be right by what that has been mended to, in
    which it had no say.
    """
    if evidence is None:
        return np.zeros(0, dtype=bool)
    errors = landmark_errors(best.functional_map, samples.source.samples.basis.functions, evidence)
    return errors > max_landmark_error(best.quality.score)


def backed_by(best: Candidate, samples: SamplePair) -> float:
    """Return :func:`kfmaps.matching.score.landmark_support` of a map by the landmarks, 0 without any."""
    if samples.landmark_evidence is None:
        return 0.0
    errors = ignore_landmarks(best, samples).landmark_errors
    return landmark_support(errors, samples.landmark_evidence.distances, to_numpy(samples.source.samples.basis.mass))


def without_landmarks(
    source: Shape, target: Shape, config: Config, samples: TwoLevelSamples, rng: int, **more: Any
) -> list[Candidate]:
    """Return what is found without landmarks, judged with them: whoever gives some loses none of these maps."""
    bare = TwoLevelSamples(
        *(replace(pair, landmark_cost=None, landmark_evidence=None) for pair in (samples.few, samples.whole))
    )
    found = candidates(source, target, config, bare, rng, **more)
    return score_maps(found, samples.whole)


def alternative_maps(maps: list[np.ndarray], source: Basis, target: Basis) -> tuple[np.ndarray, ...]:
    """Return point maps ``(n_t,)`` of functional maps that are not finished.

    Of a large source they name one of :data:`~kfmaps.fmap.zoomout.MAX_CANDIDATES` of its vertices, which lie nearer
    to each other than so few functions can tell: a quarter of the time.
    """
    exact = False if len(source.mass) * len(target.mass) > MAX_EXACT_PAIRS else None
    vertices, few = np.arange(len(source.mass)), source
    if len(vertices) > MAX_CANDIDATES:
        vertices = stratified_vertices(source, MAX_CANDIDATES, 0)
        few = SampledBasis(source.eigenvalues, source.functions[vertices], source.mass[vertices])
    return tuple(vertices[to_points(C, few, target, exact=exact, probes=N_PROBE_FAST)] for C in maps)


def scoring_samples(shape: Shape, rng: int | np.random.Generator | None = 0) -> ShapeSamples:
    """Return what a search with ``rng`` needs to know of one shape, whatever it is matched with."""
    made = sample_for_scoring(shape.cleaned[0], rng=drawn_seed(seed_of(rng)))
    return with_self_maps(made, subsample(made, FEW))


def near_isometric(found: SearchResult) -> bool:
    """Return whether the shapes are so much alike that their high functions correspond; without a search they are."""
    return found.quality is None or found.quality >= SCORE.non_isometric_score


def adapt_refinement(refinement: Refinement | None, found: SearchResult) -> Refinement | None:
    """Return the refinement for a found map: of shapes that differ much it ends with :data:`_FEWER` functions.

    Found on a gorilla and a woman, 5.2 instead of 8.5, and on cats and dogs, 10.5 instead of 10.9 on average, where
    people of other bodies lose nothing.
    """
    limited = getattr(refinement, "limited", None)
    return refinement if limited is None or near_isometric(found) else limited(_FEWER)


def adapt_registration(finish: Any, found: SearchResult) -> Any:
    """Return the registration for a found map: of shapes that differ much it lets sizes change."""
    if getattr(finish, "local_scaling", 1) or near_isometric(found):
        return finish
    return replace(finish, local_scaling=STRETCH)


def reversed_best(found: list[Candidate], mirrored: SamplePair) -> list[Candidate]:
    """Return the candidates as maps to the mirror image, best first; the best are refined with its descriptors.

    Rivals are among ``found``, refined without a look at descriptors: those of an isometry that reverses orientation.
    """
    images = by_score(score_maps([replace(c, uses_descriptors=True) for c in found], mirrored))
    settled = 3  # maps to a mirror image that are worth a refinement of their own
    return by_score(rerefine(images[:settled], mirrored) + images[settled:])


def deforms_unduly(found: Candidate) -> bool:
    """Return whether a map bends the shapes much more than right maps do: its score does not see what is wrong."""
    return _excess(found) > SCORE.excess_deformation


def _excess(found: Candidate) -> float:
    """Return the excess of the deformation energy of a map over that of right maps, 0 where it is not known."""
    energy = found.deformation_energy
    return 0.0 if energy is None else excess_deformation(found.quality.score, energy)
