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
from functools import partial
from typing import Any

import numpy as np

from kfmaps._arrays import refuse, seed_of, to_numpy
from kfmaps._progress import Progress
from kfmaps._threads import parallel
from kfmaps.config import Config
from kfmaps.fmap.approximate_nearest import N_PROBE_FAST
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.refine import CANDIDATES_PER_CALL, PAIRS, Refinement, ZoomOut
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.sampling import SampledBasis, stratified_vertices
from kfmaps.matching.calibration import excess_deformation, probability, verdict
from kfmaps.matching.candidates import Candidate, candidates, map_distance, rerefine, score_maps, select_distinct
from kfmaps.matching.extremity_matching import ExtremityVertices, extremity_vertices
from kfmaps.matching.fit import Fit, check_landmark_pairs
from kfmaps.matching.landmark_evidence import (
    MISSED,
    LandmarkEvidence,
    landmark_errors,
    landmark_support,
    reject_landmarks,
)
from kfmaps.matching.learned_kernel import drop_learned, learned_candidates, learned_kernel_applies
from kfmaps.matching.proxy_cache import ProxyCache
from kfmaps.matching.quality import ShapeSamples, sample_for_scoring, subsample
from kfmaps.matching.ranking import CLEAR, CLOSE, DISTINCT, merge_alternatives, ranking, rerank_near_duplicates
from kfmaps.matching.registration_refine import refine_by_registration
from kfmaps.matching.sample_pair import POINTS as FEW
from kfmaps.matching.sample_pair import SamplePair, TwoLevelSamples, drop_landmarks, mirrored_pair, two_level_samples
from kfmaps.matching.self_maps import with_self_maps
from kfmaps.registration.nonrigid_icp import NonRigid
from kfmaps.shape import Shape, clean_shape

MIRROR_MARGIN = 5.0
"""Margin from which a map to the mirror image comes first though none was asked for; bones have 10, other maps none."""
EXCESS_DEFORMATION = 0.55
"""Excess of the bending (:func:`kfmaps.matching.calibration.excess_deformation`) from which a mirror image is tried."""
ALIKE = 0.005
"""Maps that are no farther than that from the best are bent too: of two legs that touch, it is as far from one to the
other."""
NON_ISOMETRIC_SCORE = -8.0
"""Score below which two shapes differ so much that their high functions do not correspond, ..."""
FEWER = 100
"""... and the refinement ends with this many."""
STRETCH = 0.01
"""Area over which sizes may change evenly in the non-rigid fit of such shapes."""
REPAIR_SCORE = -7.5
"""Score below which they are bent and matched in turn."""
SETTLED = 3
"""Maps to a mirror image that are worth a refinement of their own."""


@dataclass(frozen=True, eq=False)
class SearchResult:
    """A map before it is finished on all points: what :func:`search_map` returns.

    Attributes
    ----------
    functional_map : (k, k) float64
    origin : str
        What the candidate started from.
    fit : Fit or None
        Of one fit without a search.
    verdict : str
        "sure", "ambiguous" or "poor" of a search; "landmarks" or "unchecked" of one fit.
    confidence : float or None
        Probability that the map is right, see :mod:`kfmaps.matching.calibration`.
    scores : tuple of float
        Of the map and of each runner-up, higher is better.
    runners_up : tuple of arrays (n_t,)
        The distinct other maps, best first.
    landmarks : (l, 2) int64
        Those that the map keeps to, ...
    doubted : (d,) int64
        ... and the numbers, from 0, of those given that it contradicts.
    orientation : "kept" or "reversed"
        Whether it is a map to the target or to its mirror image.
    quality : float or None
        Score of the map of a search, apart from landmarks.
    bending : float or None
        How far the shapes bend to follow it; see :func:`kfmaps.registration.deformation_energy.deformation_energy`.
    limbs : Limbs or None
        Tips of limbs that lead the refinement, where the shapes differ so much that they should.
    bent : (n_s, 3) float64 or None
        The source's vertices roughly on the target, where the shapes differ so much that these lead it as well.
    backwards : bool
        Whether ``bent`` are the target's vertices on the source instead, (n_t, 3).
    again : tuple of callables
        Each returns another map between such shapes that may turn out to be the better one when both are finished: the
        next that have been mended, and this one mended the other way round. Called with a score, it returns ``None``
        where the other does not have more, or falls apart.
    """

    functional_map: np.ndarray
    initialization: str
    fit: Fit | None
    verdict: str
    confidence: float | None = None
    scores: tuple[float, ...] = ()
    runners_up: tuple[np.ndarray, ...] = ()
    landmarks: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    rejected_landmarks: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    orientation: str = "kept"
    quality: float | None = None
    deformation_energy: float | None = None
    extremities: ExtremityVertices | None = None
    registered_vertices: np.ndarray | None = None
    swapped: bool = False
    again: tuple[Callable[[float], SearchResult | None], ...] = ()


def search_map(
    source: Shape,
    target: Shape,
    config: Config,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
    probes: tuple[ShapeSamples, ShapeSamples] | None = None,
) -> SearchResult:
    """Find a map between two prepared shapes, as ``config.search`` says.

    Parameters
    ----------
    source, target : Shape
    config : Config
    landmarks : (l, 2) whole numbers, optional
        Pairs "source vertex, target vertex". They steer the candidates and rank them; those that the best map
        contradicts while it keeps to most of the others are left out
        (:func:`kfmaps.matching.landmark_evidence.reject_landmarks`).
    descriptors : pair of arrays (n_s, d), (n_t, d), optional
    rng : seed or Generator
    progress : callable, optional
    probes : pair of Probe, optional
        Of :func:`scoring_samples` with the same ``rng``: spares the work where a shape is matched many times. Not
        used with
        landmarks, whose distances a probe knows too.

    Raises
    ------
    InvalidInput
        When ``config.search`` is ``None``, landmarks cannot be used, or the kernel was learned with landmarks.
    """
    if config.search is None:
        raise refuse("search", "settings of a search", "None", "use Config(), which has them")
    taught = learned_kernel_applies(config, source, target)
    given = seed_of(rng)
    seed = _drawn(given)
    report = progress or (lambda _stage, _done: None)
    pairs = check_landmark_pairs(landmarks, source, target)
    sides = ((source, pairs[:, 0]), (target, pairs[:, 1]))
    if probes is None or len(pairs):
        made = parallel(
            lambda side: sample_for_scoring(side[0], rng=seed, threads=1, landmarks=side[1]), sides, config.threads
        )
        probes = made[0], made[1]
    if not config.search.tips:
        probes = (
            replace(probes[0], extremities=probes[0].extremities.none()),
            replace(probes[1], extremities=probes[1].extremities.none()),
        )
    report("candidates", 0.1)
    on = two_level_samples(source, target, probes, pairs)
    found = candidates(
        source,
        target,
        drop_learned(config),
        on,
        seed,
        landmarks=pairs,
        descriptors=descriptors,
        drawn=given,
        report=lambda done: report("candidates", 0.1 + (0.4 if len(pairs) else 0.8) * done),
    )
    if len(pairs):
        found += without_landmarks(
            source,
            target,
            drop_learned(config),
            on,
            seed,
            descriptors=descriptors,
            drawn=given,
            report=lambda done: report("candidates", 0.5 + 0.4 * done),
        )
    copies = ProxyCache.of(source, target, on.whole)
    ranked = ranking(found, on.whole, copies, config.threads)
    # Asked before a map is sought that bends less: on a left and a right bone it may bend a little less than unduly.
    unduly = bends_unduly(ranked[0])
    if ranked[0].deformation_energy is not None:
        behind = np.inf if unduly else CLOSE
        near = [c for c in found if map_distance(c, ranked[0], on.whole.source) <= DISTINCT]
        near = rerank_near_duplicates(ranked, near, on.whole, copies, config.threads, ALIKE, behind)
        ranked = select_distinct(near, on.whole.source, DISTINCT)
    orientation = "reversed" if config.search.orientation == "reversed" else "kept"
    surfaces = all(p.orientation is not None for p in probes)
    asked = config.search.orientation
    if surfaces and (asked == "either" or (asked == "auto" and unduly)):
        other = mirrored_pair(on.whole)
        images, there = reversed_best(found, other, config.threads), ProxyCache.of(source, target, other)
        turned_best = ranking(images, other, there, config.threads)
        if turned_best and turned_best[0].score > ranked[0].score + (CLEAR if asked == "either" else MIRROR_MARGIN):
            orientation, found, ranked, copies, on = "reversed", images, turned_best, there, replace(on, whole=other)
    wrong, all_marks = np.zeros(len(pairs), dtype=bool), on.whole.marks
    if len(pairs):
        wrong = reject_landmarks(ignore_landmarks(ranked[0], on.whole, config.threads).landmark_errors)
    if wrong.any():
        rest = drop_landmarks(on.whole, wrong)
        found = rerefine(found, rest, config.threads)
        ranked = ranking(found, rest, copies, config.threads)
        on = TwoLevelSamples(drop_landmarks(on.few, wrong), rest)
    if taught and (orientation == "kept" or asked == "reversed"):
        more = learned_candidates(source, target, config, on, seed, given)
        ranked = merge_alternatives(ranked, more, on.whole, copies, config.threads)
    if surfaces and ranked[0].quality.score < REPAIR_SCORE:
        ranked = rerank_near_duplicates(ranked, found, on.whole, copies, config.threads)
        ranked = refine_by_registration(ranked, on.whole, copies, pairs[~wrong], config.threads, report)

    most = config.search.runners_up

    def told(best: Candidate, rest: list[Candidate]) -> SearchResult:
        others = rest[:most]
        margin = float(max(best.score - rest[0].score, 0.0) if rest else np.inf)
        score, backed = best.quality.score, backed_by(best, on.whole, config.threads)
        still = wrong & still_missed(best, on.whole, all_marks)
        return SearchResult(
            functional_map=best.functional_map,
            initialization=best.name,
            fit=None,
            confidence=probability(score, margin, best.deformation_energy, backed),
            verdict=verdict(score, margin, best.deformation_energy, backed),
            scores=tuple(float(c.score) for c in (best, *others)),
            runners_up=alternative_maps([c.functional_map for c in others], source.basis, target.basis, config.threads),
            landmarks=pairs[~still],
            rejected_landmarks=np.flatnonzero(still),
            orientation=orientation,
            quality=score,
            deformation_energy=best.deformation_energy,
            extremities=extremity_vertices(best.points, *probes) if score < NON_ISOMETRIC_SCORE else None,
            registered_vertices=best.registered_vertices,
            swapped=best.swapped,
        )

    def another(way: Callable[[], Candidate | None], least: float) -> SearchResult | None:
        made = way()
        if made is None or made.score <= least:
            return None
        return told(made, [c for c in ranked if map_distance(c, made, on.whole.source) > DISTINCT])

    return replace(told(ranked[0], ranked[1:]), again=tuple(partial(another, way) for way in ranked[0].again))


def ignore_landmarks(found: Candidate, on: SamplePair, threads: int | None = None) -> Candidate:
    """The map as it is when landmarks have no say: how it misses them then tells of both."""
    return rerefine([found], replace(on, landmarks=None), threads)[0]


def still_missed(best: Candidate, on: SamplePair, marks: LandmarkEvidence | None) -> np.ndarray:
    """Which of all landmarks given the map misses, (l,).

    One that a rough map of unlike shapes has missed, on a tail say, may be right by what that has been mended to, in
    which it had no say.
    """
    if marks is None:
        return np.zeros(0, dtype=bool)
    return landmark_errors(best.functional_map, on.source.samples.basis.functions, marks) > MISSED


def backed_by(best: Candidate, on: SamplePair, threads: int | None = None) -> float:
    """:func:`kfmaps.matching.landmark_evidence.landmark_support` of the map by the landmarks, 0 without any."""
    if on.marks is None:
        return 0.0
    return landmark_support(
        ignore_landmarks(best, on, threads).landmark_errors, on.marks, to_numpy(on.source.samples.basis.mass)
    )


def without_landmarks(
    source: Shape, target: Shape, config: Config, on: TwoLevelSamples, seed: int, **more: Any
) -> list[Candidate]:
    """What is found without landmarks, judged with them: whoever gives some loses none of these maps."""
    bare = TwoLevelSamples(*(replace(ground, landmarks=None, marks=None) for ground in (on.few, on.whole)))
    found = candidates(source, target, config, bare, seed, **more)
    maps, points = np.stack([c.functional_map for c in found]), np.stack([c.points for c in found])
    return score_maps([(c.name, c.uses_descriptors) for c in found], maps, points, on.whole, config.threads)


def alternative_maps(
    maps: list[np.ndarray], source: Basis, target: Basis, threads: int | None = None
) -> tuple[np.ndarray, ...]:
    """Point maps ``(n_t,)`` of functional maps that are not finished.

    Of a large source they name one of :data:`~kfmaps.fmap.refine.CANDIDATES_PER_CALL` of its vertices, which lie
    nearer to
    each other than so few functions can tell: a quarter of the time.
    """
    exact = False if len(source.mass) * len(target.mass) > PAIRS else None
    vertices, few = np.arange(len(source.mass)), source
    if len(vertices) > CANDIDATES_PER_CALL:
        vertices = stratified_vertices(source, CANDIDATES_PER_CALL, 0)
        few = SampledBasis(source.eigenvalues, source.functions[vertices], source.mass[vertices])
    return tuple(vertices[to_points(C, few, target, threads, exact=exact, probes=N_PROBE_FAST)] for C in maps)


def scoring_samples(shape: Shape, rng: int | np.random.Generator | None = 0) -> ShapeSamples:
    """What a search with ``rng`` needs to know of one shape, whatever it is matched with."""
    made = sample_for_scoring(clean_shape(shape)[0], rng=_drawn(seed_of(rng)), threads=1)
    return with_self_maps(made, subsample(made, FEW))


def _drawn(seed: int) -> int:
    """The seed of the samples and of all that is drawn after them."""
    return int(np.random.default_rng(seed).integers(2**31))


def near_isometric(found: SearchResult) -> bool:
    """Whether the shapes are so much alike that their high functions correspond; taken for granted without a search."""
    return found.quality is None or found.quality >= NON_ISOMETRIC_SCORE


def adapt_refinement(refinement: Refinement | None, found: SearchResult) -> Refinement | None:
    """The refinement that a found map deserves: of shapes that differ much it ends with :data:`FEWER` functions.

    Found on a gorilla and a woman, 5.2 instead of 8.5, and on cats and dogs, 10.5 instead of 10.9 on average, where
    people of other bodies lose nothing.
    """
    if not isinstance(refinement, ZoomOut) or near_isometric(found):
        return refinement
    stop = min(refinement.stop, FEWER)
    return replace(refinement, stop=stop, start=min(refinement.start, stop), step=min(refinement.step, 10))


def adapt_registration(finish: NonRigid | None, found: SearchResult) -> NonRigid | None:
    """The non-rigid fit that a found map deserves: of shapes that differ much it lets sizes change."""
    if finish is None or finish.local_scaling or near_isometric(found):
        return finish
    return replace(finish, local_scaling=STRETCH)


def reversed_best(found: list[Candidate], turned: SamplePair, threads: int | None = None) -> list[Candidate]:
    """The candidates as maps to the mirror image, best first; the best are settled once more with its descriptors.

    Rivals are among ``found``, refined without a look at descriptors: those of an isometry that reverses orientation.
    """
    names = [(c.name, True) for c in found]
    maps, points = np.stack([c.functional_map for c in found]), np.stack([c.points for c in found])
    images = sorted(score_maps(names, maps, points, turned, threads), key=lambda c: c.score, reverse=True)
    images = rerefine(images[:SETTLED], turned, threads) + images[SETTLED:]
    return sorted(images, key=lambda c: c.score, reverse=True)


def bends_unduly(found: Candidate) -> bool:
    """Whether it bends the shapes much more than right maps do: something is wrong that its score does not see."""
    return (
        found.deformation_energy is not None
        and excess_deformation(found.quality.score, found.deformation_energy) > EXCESS_DEFORMATION
    )
