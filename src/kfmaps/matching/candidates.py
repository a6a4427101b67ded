"""Candidate maps of two shapes, before anything is chosen.

Many rough maps are refined on a few hundred points: diagonal functional maps with every choice of signs of the low
functions (all symmetries of near-isometric bodies are among them, as in MapTree, Ren et al. 2020), small fits, and
the best of these composed with random symmetries and with those that the shapes nearly have. The best that differ are
refined further and judged again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
from scipy.linalg import expm

from kfmaps._threads import parallel
from kfmaps.config import Config
from kfmaps.fmap.convert import nearest
from kfmaps.matching.batched_zoomout import zoomed
from kfmaps.matching.extremity_matching import Pairing, against, induced, pairings
from kfmaps.matching.kernel_inits import fitted_family, planned, sampled
from kfmaps.matching.landmark_evidence import FAR, missed
from kfmaps.matching.quality import Probe, Quality, map_quality
from kfmaps.matching.sample_pair import Arena, Ground
from kfmaps.matching.self_maps import turns_of
from kfmaps.shape import Shape

Weights = tuple[float, ...]
"""Of SHOT, of landmarks and of the tips of limbs."""
WEIGHTS: tuple[Weights, ...] = ((0.0, 0.0), (12.0, 12.0), (4.0, 12.0))
"""In the rough refinement: none, so that symmetric maps are found too, much, and some."""
QUICK = 2
"""The first of them, after which a map may be :func:`clear`: then the others are left out."""
FROM_FITS: tuple[Weights, ...] = ((4.0, 12.0), (12.0, 12.0))
ROUGH, ROUGH_STEP = 40, 4
"""Functions at the end of the rough refinement, and how many more at each step."""
FINE, FINE_FROM, FINE_STEP = 80, 20, 5
"""The same of the refinement of the best, on all points of the probe; from fewer functions it loses right maps."""
FINE_WEIGHTS: tuple[Weights, ...] = ((12.0, 12.0), (12.0, 12.0, 30.0))
"""Without tips of limbs and with them: distances from tips mislead where a hand has grown to a thigh."""
AGAIN: Weights = (12.0, 12.0)
FROM_TIPS: tuple[Weights, ...] = ((4.0, 12.0, 30.0),)
TIP_FUNCTIONS = 12
"""Functions of the map that a pairing of tips starts from."""
STARTS = (6, 10, 20)
"""Where the rough refinement of a fit starts. From few functions it repairs maps that are wrong in part, also of
shapes that are far from isometric; from many it keeps what is right."""
KICKS = 6
"""Maps that start from a random symmetry of the low functions."""
TURNED, TURNED_APART = 3, 0.08
"""Of the best rough maps, those that are composed with symmetries of the shapes, and how far apart they are."""
FINALISTS, FEWER = 10, 6
"""Distinct rough maps that are refined further, and where one is :func:`clear`."""
EASY = -7.0
"""Score of a rough map, apart from landmarks and the ends of limbs, from which it is: people have -4 to -10, animals
of different kinds -8.5 and less."""
ZERO = 0.03
"""Frequency, the root of an eigenvalue at unit area, below which there is no wave: a sphere's first is 5."""
APART = 0.04
"""Mean distance, in units of √area, from which rough maps count as different: nearer than in the end."""
ENDS = 8.0
"""Weight of the descriptors at hands, feet, faces and tails, which no pose changes, beside those of the whole."""
BEND, USUAL = 5.0, 0.15
"""Weight of the logarithm of the bending energy over a usual one, ..."""
STRAIN = 6.0
"""Weight of the strain, where it is known; see :class:`kfmaps.registration.deformation_energy.Bent`."""
LOOKS = 60.0
"""Weight of :func:`kfmaps.registration.registered_shot.mismatch`, where it is known; right and wrong maps differ by
0.02 and more."""
LANDMARK = 2.0
"""What a landmark whose image is simply wrong costs."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """One refined map on the samples.

    Attributes
    ----------
    name : str
        Where it came from.
    functional_map : (k, k) float64
    points : (q_t,) int64
        A source sample for each target sample.
    quality : Quality
    guided : bool
        Whether descriptors had a say; a map that none speak for is only a rival.
    missed : (l,) float64
        How far the image of each landmark is from where it belongs, in units of √area.
    bending : float or None
        See :func:`kfmaps.registration.deformation_energy.bending`; ``None`` where it is not known.
    strain : float or None
        See :class:`kfmaps.registration.deformation_energy.Bent`, over a usual one; known of the first two of a close
        call and of what was
        mended.
    mismatch : float or None
        See :func:`kfmaps.registration.registered_shot.mismatch`, over the least; known of the first two where they
        are close
        and of what was mended.
    bent : (n_s, 3) float64 or None
        The source's vertices on the target, roughly, where both were bent and matched in turn.
    backwards : bool
        Whether it is the target that was bent, and ``bent (n_t, 3)`` are its vertices on the source.
    again : tuple of callables
        Each returns the same mended in another way, or ``None`` where that fails; which is best shows in the end.
    """

    name: str
    functional_map: np.ndarray
    points: np.ndarray
    quality: Quality
    guided: bool = True
    missed: np.ndarray = field(default_factory=lambda: np.zeros(0))
    bending: float | None = None
    strain: float | None = None
    mismatch: float | None = None
    bent: np.ndarray | None = None
    backwards: bool = False
    again: tuple[Callable[[], Candidate | None], ...] = ()

    @property
    def score(self) -> float:
        """Of the map itself and of the landmarks, each of which costs no more than :data:`LANDMARK`.

        In steps so small that only what is equal but for rounding becomes equal.
        """
        return round(self.evidence - LANDMARK * float(np.minimum(self.missed / FAR, 1.0).sum()), 9)

    @property
    def evidence(self) -> float:
        """What the shapes say: quality, the ends of limbs and, where they are known, bending and looks."""
        bent = 0.0 if self.bending is None else -BEND * math.log(self.bending / USUAL)
        strained = 0.0 if self.strain is None else -STRAIN * self.strain
        looks = 0.0 if self.mismatch is None else -LOOKS * self.mismatch
        return self.quality.score - ENDS * self.quality.ends + bent + strained + looks


@dataclass(frozen=True, eq=False)
class Start:
    """A rough map before its refinement: where it came from, and what takes part."""

    name: str
    functional_map: np.ndarray
    functions: int
    weights: Weights
    guided: bool
    pairing: Pairing | None = None


Report = Callable[[float], None]


def candidates(
    source: Shape,
    target: Shape,
    config: Config,
    on: Arena,
    seed: int,
    *,
    landmarks: np.ndarray | None = None,
    descriptors: tuple[Any, Any] | None = None,
    drawn: int = 0,
    report: Report | None = None,
) -> list[Candidate]:
    """Refined candidates, in no order.

    ``landmarks (l, 2)`` take part in the fits; elsewhere it is the arena that knows of them. ``drawn`` is the seed of
    the points that the fits are made from, ``seed`` that of everything else.
    """
    assert config.search is not None
    told = report or (lambda _done: None)
    functions = min(len(source.basis.eigenvalues), len(target.basis.eigenvalues))
    marks = np.zeros((0, 2), dtype=np.int64) if landmarks is None else landmarks
    signs, weights = min(config.search.signs, functions - 1), _told_apart(WEIGHTS, on.few)
    found = rough(from_signs(signs, on.few, weights[:QUICK]), on.few, functions, config.threads)
    told(0.3)
    # What the user says of landmarks and points is heard in the fits.
    easy = len(marks) == 0 and descriptors is None and clear(found)
    if not easy:
        found += rough(from_signs(signs, on.few, weights[QUICK:]), on.few, functions, config.threads)
        starts = from_fits(source, target, config, on, marks, descriptors, seed, drawn) + from_tips(functions, on.few)
        told(0.5)
        found += rough(starts, on.few, functions, config.threads)
    told(0.7)
    again = from_symmetries(found, on.few, functions, config.threads)
    if not easy:
        best = max(found, key=lambda c: c.score)
        values = source.basis.eigenvalues
        kicks = [kicked(best.functional_map, values, np.random.default_rng(seed + i)) for i in range(KICKS)]
        again += [Start(f"kicked {i}", C, STARTS[0], WEIGHTS[0], False) for i, C in enumerate(kicks)]
    found += rough(again, on.few, functions, config.threads)
    told(0.75)
    order = sorted(found, key=lambda c: c.score, reverse=True)
    chosen = apart(order, on.few.source, APART, FEWER if easy else FINALISTS)
    refined = fine(chosen, on.few, on.whole, functions, config.threads)
    told(1.0)
    return refined


def clear(found: list[Candidate]) -> bool:
    """Whether diagonal maps alone have led to one so good that fits, tips and kicks have nothing to add.

    Of two people they have; only what such a map is mistaken for is looked for then.
    """
    return max((c.quality.score for c in found if c.guided), default=-math.inf) >= EASY


def from_signs(count: int, on: Ground, weights: Iterable[Weights] = WEIGHTS) -> list[Start]:
    """Diagonal maps with all choices of signs of ``count`` functions after the constant one, with all ``weights``."""
    if count == 0:
        return []
    tries = [np.array([1.0, *signs]) for signs in product((1, -1), repeat=count)]
    return [
        Start(_signs(signs, w), np.diag(signs), count + 1, w, bool(w[0]) or on.shot is None)
        for w in _told_apart(weights, on)
        for signs in tries
    ]


def _signs(signs: np.ndarray, weights: Weights) -> str:
    return "signs " + "".join("+" if s > 0 else "-" for s in signs[1:]) + f", weight {weights[0]:g}"


def from_fits(
    source: Shape,
    target: Shape,
    config: Config,
    on: Arena,
    landmarks: np.ndarray,
    descriptors: tuple[Any, Any] | None,
    seed: int,
    drawn: int,
) -> list[Start]:
    """Small kernel fits, each to be refined from several sizes and with several weights of the descriptors."""
    surfaces = bool(len(source.mesh.faces) and len(target.mesh.faces))
    fits = planned(config, surfaces)
    families = list(dict.fromkeys(fit.family for fit in fits))
    points = sampled(source, target, landmarks, descriptors, drawn)
    cubes = on.whole.source.orientation, on.whole.target.orientation
    weights = _told_apart(FROM_FITS, on.few)

    def starts(family: str) -> list[Start]:
        members = [fit for fit in fits if fit.family == family]
        maps = fitted_family(family, members, points, config, cubes, seed)
        return [
            Start(f"{fit.name}, from {start}, weight {w[0]:g}", C, start, w, True)
            for fit, C in zip(members, maps, strict=True)
            for start in STARTS
            for w in weights
        ]

    return [start for several in parallel(starts, families, config.threads) for start in several]


def from_tips(functions: int, on: Ground) -> list[Start]:
    """Maps that follow from pairings of the tips of limbs; see :mod:`kfmaps.matching.extremity_matching`."""
    tried = pairings(on.source, on.target, on.shot)
    maps = [(pairing, paired_map(pairing, on, min(TIP_FUNCTIONS, functions))) for pairing in tried]
    return [
        Start(
            f"tips {'-'.join(map(str, pairing.source))} to {'-'.join(map(str, pairing.target))}",
            C,
            len(C),
            w,
            True,
            pairing,
        )
        for w in _told_apart(FROM_TIPS, on)
        for pairing, C in maps
    ]


def from_symmetries(found: list[Candidate], on: Ground, functions: int, threads: int | None = None) -> list[Start]:
    """The best of ``found`` composed with near-symmetries of both shapes: what they are easily mistaken for.

    Whatever else a search has missed, the best map is compared with these, so that it is not sure for want of a rival.
    """
    order = sorted(found, key=lambda c: c.score, reverse=True)
    best = apart(order, on.source, TURNED_APART, TURNED)
    own, theirs = (turns_of(side, functions, threads) for side in (on.source, on.target))
    turned = []
    for i, candidate in enumerate(best):
        C = candidate.functional_map
        for S, after in [*((S, False) for S in own), *((S, True) for S in theirs)]:
            k = min(len(C), len(S))
            turned.append((i, S[:k, :k] @ C[:k, :k] if after else C[:k, :k] @ S[:k, :k]))
    return [
        Start(f"turned {i}, from {start}, weight {w[0]:g}", C, start, w, True)
        for i, C in turned
        for start in STARTS
        for w in _told_apart(FROM_FITS, on)
    ]


def paired_map(pairing: Pairing, on: Ground, k: int) -> np.ndarray:
    """The functional map (k, k) of the points that the tips of a pairing say are alike."""
    points = against(on.source.tips, on.target.tips, pairing, on.shot).argmin(axis=1)
    return np.asarray(on.solver(k) @ on.source.samples.basis.functions[points, :k], float)


def _told_apart(weights: Iterable[Weights], on: Ground) -> list[Weights]:
    """The ``weights`` that differ on a ground which may know nothing of SHOT or of landmarks."""
    known = (on.shot is not None, on.landmarks is not None, True)
    return list(dict.fromkeys(tuple(w if k else 0.0 for w, k in zip(each, known, strict=False)) for each in weights))


def rough(starts: list[Start], on: Ground, functions: int, threads: int | None = None) -> list[Candidate]:
    """The starts refined on few points."""
    stop = min(ROUGH, functions)
    groups: dict[tuple[int, Weights], list[Start]] = {}
    for start in starts:
        size = min(start.functions, stop, *start.functional_map.shape)
        groups.setdefault((size, start.weights), []).append(start)
    found = []
    for (size, weights), members in groups.items():
        maps = np.stack([start.functional_map[:size, :size] for start in members])
        pairs = [start.pairing for start in members]
        refined = refine(maps, on, (*range(size, stop, ROUGH_STEP), stop), weights, pairs, threads)
        found += judged([(s.name, s.guided) for s in members], *refined, on, threads)
    return found


def fine(
    chosen: list[Candidate], few: Ground, on: Ground, functions: int, threads: int | None = None
) -> list[Candidate]:
    """The chosen maps, found on ``few`` points, refined on all: with the descriptors, and rivals without as well."""
    stop = min(FINE, functions)
    size = min(FINE_FROM, stop, *chosen[0].functional_map.shape)
    sizes = (*range(size, stop, FINE_STEP), stop)
    led, bare = _told_apart(FINE_WEIGHTS, on), WEIGHTS[0]
    found = []
    for weights in dict.fromkeys((bare, *led)):
        members = [c for c in chosen if weights in led or not c.guided]
        if members:
            maps = np.stack([c.functional_map[:size, :size] for c in members])
            says = bool(weights[0]) or on.shot is None
            pairs = [induced(c.points, few.source, few.target) for c in members] if weights[2:] else []
            refined = refine(maps, on, sizes, weights, pairs, threads)
            found += judged([(c.name, says) for c in members], *refined, on, threads)
    return found


def again(found: list[Candidate], on: Ground, threads: int | None = None) -> list[Candidate]:
    """The finished candidates settled once more on a ground of which something has changed."""
    maps = np.stack([c.functional_map for c in found])
    size = maps.shape[1]
    out: list[Candidate] = []
    for says in (True, False):
        members = [i for i, c in enumerate(found) if c.guided == says]
        if members:
            weights = _told_apart((AGAIN if says else WEIGHTS[0],), on)[0]
            refined = refine(maps[members], on, (max(size // 2, 2), size), weights, (), threads)
            out += judged([(found[i].name, says) for i in members], *refined, on, threads)
    return out


def refine(
    maps: np.ndarray,
    on: Ground,
    sizes: tuple[int, ...],
    weights: Weights,
    paired: Sequence[Pairing | None],
    threads: int | None,
) -> tuple[np.ndarray, np.ndarray]:
    """:func:`kfmaps.matching.batched_zoomout.zoomed` on a ground; ``paired``: the tips that each map takes to each
    other."""
    bases = on.source.samples.basis, on.target.samples.basis
    return zoomed(maps, *bases, sizes, on.against(*weights, paired=paired), threads, on.solver)


def judged(
    names: list[tuple[str, bool]],
    maps: np.ndarray,
    points: np.ndarray | None,
    on: Ground,
    threads: int | None = None,
) -> list[Candidate]:
    """Candidates of ``maps (m, k, k)`` with their quality.

    ``names``: of each and whether descriptors had a say; ``points (m, q_t)``: a source sample for each target sample,
    sought where they are ``None``.
    """
    functions = on.source.samples.basis.functions

    def judge(i: int) -> Candidate:
        C = maps[i]
        at = points[i] if points is not None else mapped(C, on)
        off = np.zeros(0) if on.marks is None else missed(C, functions, on.marks)
        return Candidate(names[i][0], C, at, map_quality(C, on.source, on.target, at), names[i][1], off)

    return parallel(judge, range(len(maps)), threads)


def mapped(C: np.ndarray, on: Ground) -> np.ndarray:
    """The source sample ``(q_t,)`` of each target sample by ``C (k_t, k_s)``."""
    k_t, k_s = C.shape
    images = on.source.samples.basis.functions[:, :k_s] @ C.T
    return nearest(on.target.samples.basis.functions[:, :k_t], images, threads=1)


def apart(order: list[Candidate], source: Probe, distance: float, most: int | None = None) -> list[Candidate]:
    """The first of ``order``, then the first of those that are ``distance`` from it on average, and so on: ``most``."""
    kept: list[Candidate] = []
    for candidate in order:
        if len(kept) == most:
            break
        if all(differs(candidate, other, source) > distance for other in kept):
            kept.append(candidate)
    return kept


def differs(a: Candidate, b: Candidate, source: Probe) -> float:
    """Mean distance between the images of the target's samples, in units of √area."""
    return float(np.linalg.norm(source.positions[a.points] - source.positions[b.points], axis=1).mean())


def kicked(C: np.ndarray, eigenvalues: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """``C`` after a random rotation of the source's low functions that mixes mostly those of like frequency.

    Of a shape with a continuous symmetry, whose eigenvalues come in pairs, that is about a random symmetry; of any
    other it is a bad start, from which the refinement returns to the same map or strays to a worse one.
    """
    k = min(20, *C.shape)
    values = np.sqrt(np.maximum(eigenvalues[:k], 0.0))
    # Constants of many components have eigenvalues of rounding size: all are alike.
    width = 0.02 * max(float(values[-1]), ZERO)
    alike = np.exp(-(((values[:, None] - values[None, :]) / width) ** 2))
    generator = rng.normal(size=(k, k)) * alike * np.pi
    rotation = expm((generator - generator.T) / 2)
    # A simple eigenvalue leaves no rotation, only the choice of sign, which a kick may flip too.
    signs = np.where(rng.random(k) < 0.25, -1.0, 1.0)
    signs[0] = 1.0
    return C[:k, :k] @ (rotation * signs[None, :])
