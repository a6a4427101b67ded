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
from kfmaps.fmap.approximate_nearest import HASTY
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.refine import CANDIDATES, PAIRS, Refinement, ZoomOut
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.sampling import SampledBasis, stratified_vertices
from kfmaps.matching.calibration import excess, probability, verdict
from kfmaps.matching.candidates import Candidate, again, apart, candidates, differs, judged
from kfmaps.matching.extremity_matching import Limbs, limbs
from kfmaps.matching.fit import Fit, checked_landmarks
from kfmaps.matching.landmark_evidence import MISSED, Marks, backing, doubted, missed
from kfmaps.matching.learned_kernel import learned, plain, speaks
from kfmaps.matching.proxy_cache import Copies
from kfmaps.matching.quality import Probe, probe, thinned
from kfmaps.matching.ranking import CLEAR, CLOSE, DISTINCT, beside, closer, ranking
from kfmaps.matching.registration_refine import mended
from kfmaps.matching.sample_pair import POINTS as FEW
from kfmaps.matching.sample_pair import Arena, Ground, arena, turned, without
from kfmaps.matching.self_maps import with_turns
from kfmaps.registration.nonrigid_icp import NonRigid
from kfmaps.shape import Shape, inner

SURELY = 5.0
"""Margin from which a map to the mirror image comes first though none was asked for; bones have 10, other maps none."""
UNDULY = 0.55
"""Excess of the bending (:func:`kfmaps.matching.calibration.excess`) from which a mirror image is tried."""
ALIKE = 0.005
"""Maps that are no farther than that from the best are bent too: of two legs that touch, it is as far from one to the
other."""
UNLIKE = -8.0
"""Score below which two shapes differ so much that their high functions do not correspond, ..."""
FEWER = 100
"""... and the refinement ends with this many."""
STRETCH = 0.01
"""Area over which sizes may change evenly in the non-rigid fit of such shapes."""
MENDED = -7.5
"""Score below which they are bent and matched in turn."""
SETTLED = 3
"""Maps to a mirror image that are worth a refinement of their own."""


@dataclass(frozen=True, eq=False)
class Found:
    """A map before it is finished on all points: what :func:`choose` returns.

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
        How far the shapes bend to follow it; see :func:`kfmaps.registration.deformation_energy.bending`.
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
    origin: str
    fit: Fit | None
    verdict: str
    confidence: float | None = None
    scores: tuple[float, ...] = ()
    runners_up: tuple[np.ndarray, ...] = ()
    landmarks: np.ndarray = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    doubted: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    orientation: str = "kept"
    quality: float | None = None
    bending: float | None = None
    limbs: Limbs | None = None
    bent: np.ndarray | None = None
    backwards: bool = False
    again: tuple[Callable[[float], Found | None], ...] = ()


def choose(
    source: Shape,
    target: Shape,
    config: Config,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
    probes: tuple[Probe, Probe] | None = None,
) -> Found:
    """Find a map between two prepared shapes, as ``config.search`` says.

    Parameters
    ----------
    source, target : Shape
    config : Config
    landmarks : (l, 2) whole numbers, optional
        Pairs "source vertex, target vertex". They steer the candidates and rank them; those that the best map
        contradicts while it keeps to most of the others are left out
        (:func:`kfmaps.matching.landmark_evidence.doubted`).
    descriptors : pair of arrays (n_s, d), (n_t, d), optional
    rng : seed or Generator
    progress : callable, optional
    probes : pair of Probe, optional
        Of :func:`probed` with the same ``rng``: spares the work where a shape is matched many times. Not used with
        landmarks, whose distances a probe knows too.

    Raises
    ------
    InvalidInput
        When ``config.search`` is ``None``, landmarks cannot be used, or the kernel was learned with landmarks.
    """
    if config.search is None:
        raise refuse("search", "settings of a search", "None", "use Config(), which has them")
    taught = speaks(config, source, target)
    given = seed_of(rng)
    seed = _drawn(given)
    report = progress or (lambda _stage, _done: None)
    pairs = checked_landmarks(landmarks, source, target)
    sides = ((source, pairs[:, 0]), (target, pairs[:, 1]))
    if probes is None or len(pairs):
        made = parallel(lambda side: probe(side[0], rng=seed, threads=1, landmarks=side[1]), sides, config.threads)
        probes = made[0], made[1]
    if not config.search.tips:
        probes = replace(probes[0], tips=probes[0].tips.none()), replace(probes[1], tips=probes[1].tips.none())
    report("candidates", 0.1)
    on = arena(source, target, probes, pairs)
    found = candidates(
        source,
        target,
        plain(config),
        on,
        seed,
        landmarks=pairs,
        descriptors=descriptors,
        drawn=given,
        report=lambda done: report("candidates", 0.1 + (0.4 if len(pairs) else 0.8) * done),
    )
    if len(pairs):
        found += unled(
            source,
            target,
            plain(config),
            on,
            seed,
            descriptors=descriptors,
            drawn=given,
            report=lambda done: report("candidates", 0.5 + 0.4 * done),
        )
    copies = Copies.of(source, target, on.whole)
    ranked = ranking(found, on.whole, copies, config.threads)
    # Asked before a map is sought that bends less: on a left and a right bone it may bend a little less than unduly.
    unduly = bends_unduly(ranked[0])
    if ranked[0].bending is not None:
        behind = np.inf if unduly else CLOSE
        near = [c for c in found if differs(c, ranked[0], on.whole.source) <= DISTINCT]
        near = closer(ranked, near, on.whole, copies, config.threads, ALIKE, behind)
        ranked = apart(near, on.whole.source, DISTINCT)
    orientation = "reversed" if config.search.orientation == "reversed" else "kept"
    surfaces = all(p.orientation is not None for p in probes)
    asked = config.search.orientation
    if surfaces and (asked == "either" or (asked == "auto" and unduly)):
        other = turned(on.whole)
        images, there = reversed_best(found, other, config.threads), Copies.of(source, target, other)
        turned_best = ranking(images, other, there, config.threads)
        if turned_best and turned_best[0].score > ranked[0].score + (CLEAR if asked == "either" else SURELY):
            orientation, found, ranked, copies, on = "reversed", images, turned_best, there, replace(on, whole=other)
    wrong, all_marks = np.zeros(len(pairs), dtype=bool), on.whole.marks
    if len(pairs):
        wrong = doubted(alone(ranked[0], on.whole, config.threads).missed)
    if wrong.any():
        rest = without(on.whole, wrong)
        found = again(found, rest, config.threads)
        ranked = ranking(found, rest, copies, config.threads)
        on = Arena(without(on.few, wrong), rest)
    if taught and (orientation == "kept" or asked == "reversed"):
        more = learned(source, target, config, on, seed, given)
        ranked = beside(ranked, more, on.whole, copies, config.threads)
    if surfaces and ranked[0].quality.score < MENDED:
        ranked = closer(ranked, found, on.whole, copies, config.threads)
        ranked = mended(ranked, on.whole, copies, pairs[~wrong], config.threads, report)

    most = config.search.runners_up

    def told(best: Candidate, rest: list[Candidate]) -> Found:
        others = rest[:most]
        margin = float(max(best.score - rest[0].score, 0.0) if rest else np.inf)
        score, backed = best.quality.score, backed_by(best, on.whole, config.threads)
        still = wrong & still_missed(best, on.whole, all_marks)
        return Found(
            functional_map=best.functional_map,
            origin=best.name,
            fit=None,
            confidence=probability(score, margin, best.bending, backed),
            verdict=verdict(score, margin, best.bending, backed),
            scores=tuple(float(c.score) for c in (best, *others)),
            runners_up=passed_over([c.functional_map for c in others], source.basis, target.basis, config.threads),
            landmarks=pairs[~still],
            doubted=np.flatnonzero(still),
            orientation=orientation,
            quality=score,
            bending=best.bending,
            limbs=limbs(best.points, *probes) if score < UNLIKE else None,
            bent=best.bent,
            backwards=best.backwards,
        )

    def another(way: Callable[[], Candidate | None], least: float) -> Found | None:
        made = way()
        if made is None or made.score <= least:
            return None
        return told(made, [c for c in ranked if differs(c, made, on.whole.source) > DISTINCT])

    return replace(told(ranked[0], ranked[1:]), again=tuple(partial(another, way) for way in ranked[0].again))


def alone(found: Candidate, on: Ground, threads: int | None = None) -> Candidate:
    """The map as it is when landmarks have no say: how it misses them then tells of both."""
    return again([found], replace(on, landmarks=None), threads)[0]


def still_missed(best: Candidate, on: Ground, marks: Marks | None) -> np.ndarray:
    """Which of all landmarks given the map misses, (l,).

    One that a rough map of unlike shapes has missed, on a tail say, may be right by what that has been mended to, in
    which it had no say.
    """
    if marks is None:
        return np.zeros(0, dtype=bool)
    return missed(best.functional_map, on.source.samples.basis.functions, marks) > MISSED


def backed_by(best: Candidate, on: Ground, threads: int | None = None) -> float:
    """:func:`kfmaps.matching.landmark_evidence.backing` of the map by the landmarks, 0 without any."""
    if on.marks is None:
        return 0.0
    return backing(alone(best, on, threads).missed, on.marks, to_numpy(on.source.samples.basis.mass))


def unled(source: Shape, target: Shape, config: Config, on: Arena, seed: int, **more: Any) -> list[Candidate]:
    """What is found without landmarks, judged with them: whoever gives some loses none of these maps."""
    bare = Arena(*(replace(ground, landmarks=None, marks=None) for ground in (on.few, on.whole)))
    found = candidates(source, target, config, bare, seed, **more)
    maps, points = np.stack([c.functional_map for c in found]), np.stack([c.points for c in found])
    return judged([(c.name, c.guided) for c in found], maps, points, on.whole, config.threads)


def passed_over(
    maps: list[np.ndarray], source: Basis, target: Basis, threads: int | None = None
) -> tuple[np.ndarray, ...]:
    """Point maps ``(n_t,)`` of functional maps that are not finished.

    Of a large source they name one of :data:`~kfmaps.fmap.refine.CANDIDATES` of its vertices, which lie nearer to
    each other than so few functions can tell: a quarter of the time.
    """
    exact = False if len(source.mass) * len(target.mass) > PAIRS else None
    vertices, few = np.arange(len(source.mass)), source
    if len(vertices) > CANDIDATES:
        vertices = stratified_vertices(source, CANDIDATES, 0)
        few = SampledBasis(source.eigenvalues, source.functions[vertices], source.mass[vertices])
    return tuple(vertices[to_points(C, few, target, threads, exact=exact, probes=HASTY)] for C in maps)


def probed(shape: Shape, rng: int | np.random.Generator | None = 0) -> Probe:
    """What a search with ``rng`` needs to know of one shape, whatever it is matched with."""
    made = probe(inner(shape)[0], rng=_drawn(seed_of(rng)), threads=1)
    return with_turns(made, thinned(made, FEW))


def _drawn(seed: int) -> int:
    """The seed of the samples and of all that is drawn after them."""
    return int(np.random.default_rng(seed).integers(2**31))


def alike(found: Found) -> bool:
    """Whether the shapes are so much alike that their high functions correspond; taken for granted without a search."""
    return found.quality is None or found.quality >= UNLIKE


def closing(refinement: Refinement | None, found: Found) -> Refinement | None:
    """The refinement that a found map deserves: of shapes that differ much it ends with :data:`FEWER` functions.

    Found on a gorilla and a woman, 5.2 instead of 8.5, and on cats and dogs, 10.5 instead of 10.9 on average, where
    people of other bodies lose nothing.
    """
    if not isinstance(refinement, ZoomOut) or alike(found):
        return refinement
    stop = min(refinement.stop, FEWER)
    return replace(refinement, stop=stop, start=min(refinement.start, stop), step=min(refinement.step, 10))


def loosened(finish: NonRigid | None, found: Found) -> NonRigid | None:
    """The non-rigid fit that a found map deserves: of shapes that differ much it lets sizes change."""
    if finish is None or finish.stretch or alike(found):
        return finish
    return replace(finish, stretch=STRETCH)


def reversed_best(found: list[Candidate], turned: Ground, threads: int | None = None) -> list[Candidate]:
    """The candidates as maps to the mirror image, best first; the best are settled once more with its descriptors.

    Rivals are among ``found``, refined without a look at descriptors: those of an isometry that reverses orientation.
    """
    names = [(c.name, True) for c in found]
    maps, points = np.stack([c.functional_map for c in found]), np.stack([c.points for c in found])
    images = sorted(judged(names, maps, points, turned, threads), key=lambda c: c.score, reverse=True)
    images = again(images[:SETTLED], turned, threads) + images[SETTLED:]
    return sorted(images, key=lambda c: c.score, reverse=True)


def bends_unduly(found: Candidate) -> bool:
    """Whether it bends the shapes much more than right maps do: something is wrong that its score does not see."""
    return found.bending is not None and excess(found.quality.score, found.bending) > UNDULY
