"""The choice among many maps, judged without knowing the truth, with landmarks or without.

A wave kernel signature cannot tell left from right, and one fit of a symmetric body easily returns a flipped or half-
flipped map. So many candidates are refined cheaply on samples (:mod:`kfmaps.search.candidates`), all are judged by
:func:`kfmaps.search.quality.map_quality` and by how well they keep to the landmarks, and the best is finished on all
points. *Rivals*, refined without a look at the descriptors, show whether some altogether different map would do as
well, in which case the answer is "ambiguous".
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np

from kfmaps._arrays import NotConverged, refuse, seed_of
from kfmaps._progress import Done, Progress
from kfmaps._threads import parallel
from kfmaps.config import Config
from kfmaps.descriptors.shot import mirrored
from kfmaps.fit.fit import Fit, checked_landmarks
from kfmaps.fit.shape import Shape, inner
from kfmaps.functional.cells import HASTY
from kfmaps.functional.guide import Guide, guide
from kfmaps.functional.nonrigid import NonRigid
from kfmaps.functional.points import to_points
from kfmaps.functional.refine import CANDIDATES, PAIRS, Refinement, ZoomOut
from kfmaps.search.alternate import alternated, grounds, turned_round
from kfmaps.search.arena import POINTS as FEW
from kfmaps.search.arena import Arena, Ground, arena, turned, without
from kfmaps.search.bends import LONGER, MORE, Ready, bending, bent, copied, ready
from kfmaps.search.candidates import (
    APART,
    FINE,
    TIP_FUNCTIONS,
    Candidate,
    again,
    apart,
    candidates,
    differs,
    judged,
    paired_map,
)
from kfmaps.search.learned import learned, plain, speaks
from kfmaps.search.looks import looks, mismatch
from kfmaps.search.marks import doubted, leading
from kfmaps.search.pairings import Limbs, completed, induced, limbs, limbs_of, pairings, unheard
from kfmaps.search.quality import Probe, probe, thinned
from kfmaps.search.symmetries import with_turns
from kfmaps.search.verdict import excess, probability, verdict
from kfmaps.surface.basis import Basis
from kfmaps.surface.mesh import mirrored as mirrored_mesh
from kfmaps.surface.samples import SampledBasis, stratified_vertices

DISTINCT = 0.08
"""Mean distance, in units of √area, from which two maps count as different ones."""
CLEAR = 0.3
"""Margin of the score from which a rival, or a map to the mirror image, comes first."""
SURELY = 5.0
"""Margin from which a map to the mirror image comes first though none was asked for; bones have 10, other maps none."""
UNDULY = 0.55
"""Excess of the bending (:func:`kfmaps.search.verdict.excess`) from which a mirror image is tried."""
ALIKE = 0.005
"""Maps that are no farther than that from the best are bent too: of two legs that touch, it is as far from one to the
other."""
UNLIKE = -8.0
"""Score below which two shapes differ so much that their high functions do not correspond, ..."""
FEWER = 100
"""... and the refinement ends with this many."""
STRETCH = 0.01
"""Area over which sizes may change evenly in the non-rigid fit of such shapes."""
BENT = 3
"""Distinct maps that the source is bent for, ..."""
FIRST = 2
"""Maps between unlike shapes that are mended, whether or not they differ."""
PAIRED = 3
"""Likeliest pairings of the tips of limbs that mending begins with, where no map that is mended has the same."""
CLOSER = 5
"""Maps that may be closer to each other, rough ones' :data:`~kfmaps.search.candidates.APART`, of unlike shapes."""
BEHIND = 3.0
"""... unless they are so far behind in the score."""
LOOKED, CLOSE = 2.5, 1.0
"""Margins below which it counts how the first two look when they are bent, and below which they are bent again and
those that hardly differ are bent at all."""
MENDED = -7.5
"""Score below which they are bent and matched in turn."""
MENDABLE = 6.0
"""How far behind a map between unlike shapes may be to be mended: mending has gained up to 10."""
HOPELESS = 5.0
"""How far behind a mended map comes to nothing however it looks."""
NEXT = 2
"""Mended ones after the best that may turn out to be less torn than it, ..."""
TWIN = 0.03
"""... and the mean distance up to which two of them count as one: a limb that lies elsewhere makes 0.05."""
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
        Probability that the map is right, see :mod:`kfmaps.search.verdict`.
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
        How far the shapes bend to follow it; see :func:`kfmaps.search.bends.bending`.
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
        contradicts while it keeps to most of the others are left out (:func:`kfmaps.search.marks.doubted`).
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
        raise refuse("search", "settings of a search", "None", "use Config.automatic()")
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
    ranked = ranking(found, on.whole, source, target, config.threads)
    # Asked before a map is sought that bends less: on a left and a right bone it may bend a little less than unduly.
    unduly = bends_unduly(ranked[0])
    if ranked[0].bending is not None:
        behind = np.inf if unduly else CLOSE
        near = [c for c in found if differs(c, ranked[0], on.whole.source) <= DISTINCT]
        near = closer(ranked, near, on.whole, source, target, config.threads, ALIKE, behind)
        ranked = apart(near, on.whole.source, DISTINCT)
    orientation = "reversed" if config.search.orientation == "reversed" else "kept"
    surfaces = all(p.orientation is not None for p in probes)
    asked = config.search.orientation
    if surfaces and (asked == "either" or (asked == "auto" and unduly)):
        other = turned(on.whole)
        images = reversed_best(found, other, config.threads)
        turned_best = ranking(images, other, source, target, config.threads)
        if turned_best and turned_best[0].score > ranked[0].score + (CLEAR if asked == "either" else SURELY):
            orientation, found, ranked, on = "reversed", images, turned_best, replace(on, whole=other)
    wrong = np.zeros(len(pairs), dtype=bool)
    if len(pairs):
        # Landmarks are judged by the best map as it is when they have no say.
        alone = again(ranked[:1], replace(on.whole, landmarks=None), config.threads)
        wrong = doubted(alone[0].missed)
    if wrong.any():
        rest = without(on.whole, wrong)
        found = again(found, rest, config.threads)
        ranked = ranking(found, rest, source, target, config.threads)
        on = Arena(without(on.few, wrong), rest)
    if taught and (orientation == "kept" or asked == "reversed"):
        more = learned(source, target, config, on, seed, given)
        ranked = beside(ranked, more, on.whole, source, target, config.threads)
    if surfaces and ranked[0].quality.score < MENDED:
        image = mirror_image(target) if orientation == "reversed" and asked != "reversed" else target
        ranked = closer(ranked, found, on.whole, source, target, config.threads)
        ranked = mended(ranked, on.whole, source, image, pairs[~wrong], config.threads, report)

    most = config.search.runners_up

    def told(best: Candidate, rest: list[Candidate]) -> Found:
        others = rest[:most]
        margin = max(best.score - rest[0].score, 0.0) if rest else np.inf
        score = best.quality.score
        return Found(
            functional_map=best.functional_map,
            origin=best.name,
            fit=None,
            confidence=probability(score, float(margin), best.bending),
            verdict=verdict(score, float(margin), best.bending),
            scores=tuple(float(c.score) for c in (best, *others)),
            runners_up=passed_over([c.functional_map for c in others], source.basis, target.basis, config.threads),
            landmarks=pairs[~wrong],
            doubted=np.flatnonzero(wrong),
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


def unled(source: Shape, target: Shape, config: Config, on: Arena, seed: int, **more: Any) -> list[Candidate]:
    """What is found without landmarks, judged with them: whoever gives some loses none of these maps."""
    alone = Arena(*(replace(ground, landmarks=None, marks=None) for ground in (on.few, on.whole)))
    found = candidates(source, target, config, alone, seed, **more)
    maps, points = np.stack([c.functional_map for c in found]), np.stack([c.points for c in found])
    return judged([(c.name, c.guided) for c in found], maps, points, on.whole, config.threads)


def passed_over(
    maps: list[np.ndarray], source: Basis, target: Basis, threads: int | None = None
) -> tuple[np.ndarray, ...]:
    """Point maps ``(n_t,)`` of functional maps that are not finished.

    Of a large source they name one of :data:`~kfmaps.functional.refine.CANDIDATES` of its vertices, which lie nearer to
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


def closing(refinement: Refinement | None, found: Found) -> Refinement | None:
    """The refinement that a found map deserves: of shapes that differ much it ends with :data:`FEWER` functions.

    Found on a gorilla and a woman, 5.2 instead of 8.5, and on cats and dogs, 10.5 instead of 10.9 on average, where
    people of other bodies lose nothing.
    """
    if not isinstance(refinement, ZoomOut) or found.quality is None or found.quality >= UNLIKE:
        return refinement
    stop = min(refinement.stop, FEWER)
    return replace(refinement, stop=stop, start=min(refinement.start, stop), step=min(refinement.step, 10))


def loosened(finish: NonRigid | None, found: Found) -> NonRigid | None:
    """The non-rigid fit that a found map deserves: of shapes that differ much it lets sizes change."""
    if finish is None or finish.stretch or found.quality is None or found.quality >= UNLIKE:
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


def ranking(
    found: list[Candidate], on: Ground, source: Shape, target: Shape, threads: int | None = None
) -> list[Candidate]:
    """The distinct ones of ``found``, best first; the first few are judged by how far the source must bend as well."""
    ranked = distinct(found, on.source)
    near = [c for c in ranked[:BENT] if c.score > ranked[0].score - BEHIND]
    tried = with_bending(near, on, source, target, threads)
    if not tried:
        return ranked
    # As bad as the worst, so that none that was not tried comes first.
    worst = max(c.bending for c in tried if c.bending is not None)
    order = in_order([*tried, *(replace(c, bending=worst) for c in ranked[len(near) :])])
    if len(near) > 1 and order[0].score - order[1].score < LOOKED:
        return second_look(order, on, source, target, threads)
    return order


def closer(
    ranked: list[Candidate],
    found: list[Candidate],
    on: Ground,
    source: Shape,
    target: Shape,
    threads: int | None = None,
    distance: float = APART,
    behind: float = np.inf,
) -> list[Candidate]:
    """``ranked``, and between them the best of ``found`` that hardly differ from a better one: by ``distance``.

    A map with one limb wrong is near the right one, and may come before it by chance: which of them is torn shows when
    both are bent. None that is farther ``behind`` before that.
    """
    best = apart(in_order(found), on.source, distance, CLOSER)
    known = [c.functional_map for c in ranked]
    more = [c for c in best if c.score > best[0].score - behind and not any(c.functional_map is C for C in known)]
    return in_order([*ranked, *with_bending(more, on, source, target, threads)])


def with_bending(
    found: list[Candidate], on: Ground, source: Shape, target: Shape, threads: int | None = None
) -> list[Candidate]:
    """``found`` with how far the coarse copies must bend; none where a shape has no copy to bend."""
    copies = on.source.copy, on.target.copy
    if copies[0] is None or copies[1] is None or not found:
        return []
    both = ready(copies[0], copies[1])
    energies = parallel(lambda c: bending(c.functional_map, source, target, both), found, threads)
    return [replace(c, bending=energy) for c, energy in zip(found, energies, strict=True)]


def beside(
    ranked: list[Candidate],
    more: list[Candidate],
    on: Ground,
    source: Shape,
    target: Shape,
    threads: int | None = None,
) -> list[Candidate]:
    """``ranked``, and the best of ``more`` that is none of them: first where it is clearly better, else a rival."""
    others = [c for c in more if all(differs(c, one, on.source) > DISTINCT for one in ranked)]
    if not others or max(c.quality.score for c in others) < ranked[0].quality.score - BEHIND:
        return ranked
    new = ranking(others, on, source, target, threads)[0]
    if new.score > ranked[0].score + CLEAR:
        return [new, *ranked]
    return [ranked[0], *sorted([*ranked[1:], new], key=lambda c: c.score, reverse=True)]


def second_look(
    order: list[Candidate], on: Ground, source: Shape, target: Shape, threads: int | None = None
) -> list[Candidate]:
    """The first two with how they look when bent; where they are close, bent with more points and patience too.

    A map that swaps front and back may come first by a margin that leaves no doubt to the score.
    """
    finer = copied(source, MORE), copied(target, MORE)
    if finer[0] is None or finer[1] is None:
        return order
    both = ready(finer[0], finer[1].mirrored() if on.target.mirrored else finer[1])
    at_rest = looks(both)
    close = order[0].score - order[1].score < CLOSE

    def look(found: Candidate) -> Candidate:
        found = seen(found, source, target, both) if close else found
        return replace(found, mismatch=mismatch(found.functional_map, source, target, at_rest))

    found = parallel(look, order[:2], threads)
    # Nothing is added for looks: the best is compared with maps that nobody has looked at.
    middle = usual(found, np.mean)[0], usual(found, min)[1]
    return in_order([over(c, middle) for c in found]) + order[2:]


def seen(found: Candidate, source: Shape, target: Shape, on: Ready) -> Candidate:
    """With what its map says when the copies are bent with more patience."""
    one = bent(found.functional_map, source, target, on, LONGER)
    return replace(found, bending=one.bending, strain=one.strain, mismatch=None)


def usual(found: list[Candidate], of: Callable[[list[float]], Any]) -> tuple[float, float]:
    """The strain and the mismatch of bent candidates that others are compared with: both depend on the shapes."""
    strains = [c.strain for c in found if c.strain is not None]
    looks = [c.mismatch for c in found if c.mismatch is not None]
    return float(of(strains)) if strains else 0.0, float(of(looks)) if looks else 0.0


def over(found: Candidate, usual: tuple[float, float]) -> Candidate:
    """With strain and mismatch, where they are known, over the usual ones."""
    strain, looks = found.strain, found.mismatch
    return replace(
        found,
        strain=None if strain is None else strain - usual[0],
        mismatch=None if looks is None else looks - usual[1],
    )


def mended(
    ranked: list[Candidate],
    on: Ground,
    source: Shape,
    target: Shape,
    landmarks: np.ndarray,
    threads: int | None = None,
    progress: Progress | None = None,
) -> list[Candidate]:
    """The best between unlike shapes bent and matched in turn (:mod:`kfmaps.search.alternate`), and ranked again.

    The target is bent onto the source, so that each direction has its say: what follows bends the source onto the
    target. Each counts as it is after that or, where that has made it worse, as the best of that, of the source bent
    onto the target, and of what it was before.

    A refinement may send a leg to the tail, and what is mended keeps to the tips that it has paired. So the likeliest
    pairings of tips (:mod:`kfmaps.search.pairings`) that none of these maps has are begun with as well.
    """
    both = grounds(source, target)
    finer = copied(source, MORE), copied(target, MORE)
    if both is None or finer[0] is None or finer[1] is None:
        return ranked
    copies, shot = ready(finer[0], finer[1]), guide(source.shot, target.shot)
    at_rest = looks(copies)

    near, rest = mendable(ranked, on.source)
    likely = pairings(on.source, on.target, on.shot)
    known = [induced(one.points, on.source, on.target) for one in near]
    known = [one and completed(one, likely) for one in known]
    begun = [(c, one and limbs_of(one, on.source, on.target)) for c, one in zip(near, known, strict=True)]
    for one in unheard(likely, [pairing for pairing in known if pairing], PAIRED):
        C = paired_map(one, on, min(TIP_FUNCTIONS, len(near[0].functional_map)))
        begun.append((judged([(f"{one}", True)], C[None], None, on, 1)[0], limbs_of(one, on.source, on.target)))
    done = np.zeros(len(begun))

    def tell(i: int, part: float) -> None:
        done[i] = part
        if progress is not None:
            progress("bent and matched in turn", float(done.mean()))

    def mend(old: Candidate, tips: Limbs | None, tell: Done, backwards: bool = True) -> Candidate | None:
        led = leading(source, target, landmarks, tips and tips.guide(source.mesh, target.mesh), shot)
        C, where = old.functional_map, both
        if backwards:
            C, where, led = C.T, turned_round(both), led and Guide(led.target, led.source)
        try:
            found = alternated(C, where, led, lambda part: tell(0.9 * part))
        except NotConverged:
            tell(1.0)
            return None
        size = min(FINE, len(found.functional_map))
        C = found.functional_map[:size, :size]
        new = judged([(old.name, old.guided)], (C.T if backwards else C)[None], None, on, 1)[0]
        new = replace(seen(new, source, target, copies), bent=found.bent, backwards=backwards)
        tell(1.0)
        return new

    def better(i: int) -> Candidate | None:
        """Where a body touches itself the right map may go astray; the other way it may not, or is best as it was."""
        old, new = begun[i][0], mend(*begun[i], partial(tell, i))
        if new is None:
            return old if i < len(near) else None
        if i >= len(near) or new.quality.score >= old.quality.score:
            return new
        other = mend(*begun[i], lambda _done: None, backwards=False)
        states = [new, seen(old, source, target, copies), *([] if other is None else [other])]
        return max(states, key=lambda c: c.score)

    def looked_at(found: Candidate) -> Candidate:
        return replace(found, mismatch=mismatch(found.functional_map, source, target, at_rest))

    tell(0, 0.0)
    made = parallel(better, range(len(begun)), threads)
    which = [i for i, c in enumerate(made) if c is not None]
    tried = compared([c for c in made if c is not None], looked_at, threads)
    least = usual(tried, min)
    order = in_order([over(c, least) for c in tried])
    won = begun[which[next(i for i, c in enumerate(tried) if c.functional_map is order[0].functional_map)]]

    def forwards() -> Candidate | None:
        made = mend(*won, lambda _done: None, backwards=False)
        return made and over(looked_at(made), least)

    # Others that are as likely, and the one that has won mended the other way round: the source bent onto the target.
    nexts = apart(order, on.source, TWIN, 1 + NEXT)[1:]
    order[0] = replace(order[0], again=(*(partial(_itself, c) for c in nexts), forwards))
    return apart(order + rest, on.source, DISTINCT)


def _itself(found: Candidate) -> Candidate:
    return found


def compared(
    found: list[Candidate], looked_at: Callable[[Candidate], Candidate], threads: int | None = None
) -> list[Candidate]:
    """The mended ones with how they look, those that are far behind anyway with the worst that is seen."""
    found = [replace(c, mismatch=None) for c in found]
    strain = usual(found, min)[0]
    scores = [over(c, (strain, 0.0)).score for c in found]
    near = [score > max(scores) - HOPELESS for score in scores]
    seen = parallel(looked_at, [c for c, yes in zip(found, near, strict=True) if yes], threads)
    worst = max((c.mismatch for c in seen if c.mismatch is not None), default=None)
    rest = iter(seen)
    return [next(rest) if yes else replace(c, mismatch=worst) for c, yes in zip(found, near, strict=True)]


def mendable(ranked: list[Candidate], source: Probe) -> tuple[list[Candidate], list[Candidate]]:
    """Those that are worth mending, and the others; a second look may have put the second behind the third.

    The first few, which may be alike, and the first few that differ.
    """
    wanted = [*ranked[:FIRST], *apart(ranked, source, DISTINCT, BENT)]
    worth = [any(c is w for w in wanted) and c.score > ranked[0].score - MENDABLE for c in ranked]
    return [c for c, yes in zip(ranked, worth, strict=True) if yes], [
        c for c, yes in zip(ranked, worth, strict=True) if not yes
    ]


def distinct(found: list[Candidate], source: Probe) -> list[Candidate]:
    """The best of ``found``, then the best of those that differ from it, and so on."""
    return apart(in_order(found), source, DISTINCT)


def in_order(found: list[Candidate]) -> list[Candidate]:
    """Best first.

    A rival, which no descriptors speak for, comes first only when it is clearly better than every other candidate.
    """
    order = sorted(found, key=lambda c: c.score, reverse=True)
    best = next((c for c in order if c.guided), None)
    if best is not None and best.score > order[0].score - CLEAR:
        order.insert(0, order.pop(next(i for i, c in enumerate(order) if c is best)))
    return order


def mirror_image(shape: Shape) -> Shape:
    """The mirror image of a prepared shape, with the same vertices, functions and areas.

    Raises
    ------
    InvalidInput
        For a point cloud, which has no orientation.
    """
    if len(shape.mesh.faces) == 0:
        raise refuse(shape.name, "a surface, which can be mirrored", "a point cloud", "leave orientation at 'kept'")
    return replace(shape, mesh=mirrored_mesh(shape.mesh), shot=None if shape.shot is None else mirrored(shape.shot))
