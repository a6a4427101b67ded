"""Candidate maps of two shapes, before anything is chosen.

Many rough maps are refined on a few hundred points: diagonal functional maps with every choice of signs of the low
functions (all symmetries of near-isometric bodies are among them, as in MapTree, Ren et al. 2020), small fits, and
the best of these composed with random symmetries and with those that the shapes nearly have. The best that differ are
refined further and judged again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from scipy.linalg import expm

from kfmaps._threads import parallel
from kfmaps.config import Config
from kfmaps.fmap.convert import nearest
from kfmaps.matching.batched_zoomout import batched_zoomout
from kfmaps.matching.extremity_matching import ExtremityMatch, extremity_cost, match_extremities, match_of_map
from kfmaps.matching.kernel_inits import fit_descriptor_set, plan_fits, sample_shapes
from kfmaps.matching.landmark_evidence import landmark_errors
from kfmaps.matching.quality import ShapeSamples, map_quality
from kfmaps.matching.sample_pair import SamplePair, TwoLevelSamples
from kfmaps.matching.score import SCORE, Candidate, select_distinct
from kfmaps.matching.self_maps import self_maps
from kfmaps.shape import Shape

Weights = tuple[float, ...]
"""Of SHOT, of landmarks and of the tips of limbs."""
WEIGHTS: tuple[Weights, ...] = ((0.0, 0.0), (12.0, 12.0), (4.0, 12.0))
"""In the rough refinement: none, so that symmetric maps are found too, much, and some."""
QUICK = 2
"""The first of them, after which a map may be :func:`early_exit`: then the others are left out."""
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
N_PERTURBATIONS = 6
"""Maps that start from a random symmetry of the low functions."""
TURNED = 3
"""Of the best rough maps that differ, those that are composed with symmetries of the shapes."""
FINALISTS, FEWER = 10, 6
"""Distinct rough maps that are refined further, and where one is :func:`early_exit`."""
MIN_FREQUENCY = 0.03
"""Frequency, the root of an eigenvalue at unit area, below which there is no wave: a sphere's first is 5."""


@dataclass(frozen=True, eq=False)
class Start:
    """A rough map before its refinement: where it came from, and what takes part."""

    name: str
    functional_map: np.ndarray
    functions: int
    weights: Weights
    uses_descriptors: bool
    pairing: ExtremityMatch | None = None


Report = Callable[[float], None]


def candidates(
    source: Shape,
    target: Shape,
    config: Config,
    on: TwoLevelSamples,
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
    found = refine_coarse(sign_inits(signs, on.few, weights[:QUICK]), on.few, functions, config.threads)
    told(0.3)
    # What the user says of landmarks and points is heard in the fits.
    easy = len(marks) == 0 and descriptors is None and early_exit(found)
    if not easy:
        found += refine_coarse(sign_inits(signs, on.few, weights[QUICK:]), on.few, functions, config.threads)
        starts = kernel_inits(source, target, config, on, marks, descriptors, seed, drawn) + extremity_inits(
            functions, on.few
        )
        told(0.5)
        found += refine_coarse(starts, on.few, functions, config.threads)
    told(0.7)
    again = symmetry_inits(found, on.few, functions, config.threads)
    if not easy:
        best = max(found, key=lambda c: c.score)
        values = source.basis.eigenvalues
        kicks = [perturb(best.functional_map, values, np.random.default_rng(seed + i)) for i in range(N_PERTURBATIONS)]
        again += [Start(f"kicked {i}", C, STARTS[0], WEIGHTS[0], False) for i, C in enumerate(kicks)]
    found += refine_coarse(again, on.few, functions, config.threads)
    told(0.75)
    order = sorted(found, key=lambda c: c.score, reverse=True)
    chosen = distinct_maps(order, on.few.source, SCORE.rough_distance, FEWER if easy else FINALISTS)
    refined = refine_fine(chosen, on.few, on.whole, functions, config.threads)
    told(1.0)
    return refined


def early_exit(found: list[Candidate]) -> bool:
    """Whether diagonal maps alone have led to one so good that fits, tips and kicks have nothing to add.

    Of two people they have; only what such a map is mistaken for is looked for then.
    """
    return max((c.quality.score for c in found if c.uses_descriptors), default=-math.inf) >= SCORE.early_exit_score


def sign_inits(count: int, on: SamplePair, weights: Iterable[Weights] = WEIGHTS) -> list[Start]:
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


def kernel_inits(
    source: Shape,
    target: Shape,
    config: Config,
    on: TwoLevelSamples,
    landmarks: np.ndarray,
    descriptors: tuple[Any, Any] | None,
    seed: int,
    drawn: int,
) -> list[Start]:
    """Small kernel fits, each to be refined from several sizes and with several weights of the descriptors."""
    surfaces = bool(len(source.mesh.faces) and len(target.mesh.faces))
    fits = plan_fits(config, surfaces)
    families = list(dict.fromkeys(fit.descriptor_set for fit in fits))
    points = sample_shapes(source, target, landmarks, descriptors, drawn)
    cubes = on.whole.source.orientation, on.whole.target.orientation
    weights = _told_apart(FROM_FITS, on.few)

    def starts(family: str) -> list[Start]:
        members = [fit for fit in fits if fit.descriptor_set == family]
        maps = fit_descriptor_set(family, members, points, config, cubes, seed)
        return [
            Start(f"{fit.name}, from {start}, weight {w[0]:g}", C, start, w, True)
            for fit, C in zip(members, maps, strict=True)
            for start in STARTS
            for w in weights
        ]

    return [start for several in parallel(starts, families, config.threads) for start in several]


def extremity_inits(functions: int, on: SamplePair) -> list[Start]:
    """Maps that follow from pairings of the tips of limbs; see :mod:`kfmaps.matching.extremity_matching`."""
    tried = match_extremities(on.source, on.target, on.shot)
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


def symmetry_inits(found: list[Candidate], on: SamplePair, functions: int, threads: int | None = None) -> list[Start]:
    """The best of ``found`` composed with near-symmetries of both shapes: what they are easily mistaken for.

    Whatever else a search has missed, the best map is compared with these, so that it is not sure for want of a rival.
    """
    order = sorted(found, key=lambda c: c.score, reverse=True)
    best = distinct_maps(order, on.source, SCORE.distinct_distance, TURNED)
    own, theirs = (self_maps(side, functions, threads) for side in (on.source, on.target))
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


def paired_map(pairing: ExtremityMatch, on: SamplePair, k: int) -> np.ndarray:
    """The functional map (k, k) of the points that the tips of a pairing say are alike."""
    points = extremity_cost(on.source.extremities, on.target.extremities, pairing, on.shot).argmin(axis=1)
    return np.asarray(on.solver(k) @ on.source.samples.basis.functions[points, :k], float)


def _told_apart(weights: Iterable[Weights], on: SamplePair) -> list[Weights]:
    """The ``weights`` that differ on a ground which may know nothing of SHOT or of landmarks."""
    known = (on.shot is not None, on.landmarks is not None, True)
    return list(dict.fromkeys(tuple(w if k else 0.0 for w, k in zip(each, known, strict=False)) for each in weights))


def refine_coarse(starts: list[Start], on: SamplePair, functions: int, threads: int | None = None) -> list[Candidate]:
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
        refined = refine_batch(maps, on, (*range(size, stop, ROUGH_STEP), stop), weights, pairs, threads)
        found += score_maps([(s.name, s.uses_descriptors) for s in members], *refined, on, threads)
    return found


def refine_fine(
    chosen: list[Candidate], few: SamplePair, on: SamplePair, functions: int, threads: int | None = None
) -> list[Candidate]:
    """The chosen maps, found on ``few`` points, refined on all: with the descriptors, and rivals without as well."""
    stop = min(FINE, functions)
    size = min(FINE_FROM, stop, *chosen[0].functional_map.shape)
    sizes = (*range(size, stop, FINE_STEP), stop)
    led, bare = _told_apart(FINE_WEIGHTS, on), WEIGHTS[0]
    found = []
    for weights in dict.fromkeys((bare, *led)):
        members = [c for c in chosen if weights in led or not c.uses_descriptors]
        if members:
            maps = np.stack([c.functional_map[:size, :size] for c in members])
            says = bool(weights[0]) or on.shot is None
            pairs = [match_of_map(c.points, few.source, few.target) for c in members] if weights[2:] else []
            refined = refine_batch(maps, on, sizes, weights, pairs, threads)
            found += score_maps([(c.name, says) for c in members], *refined, on, threads)
    return found


def rerefine(found: list[Candidate], on: SamplePair, threads: int | None = None) -> list[Candidate]:
    """The finished candidates settled once more on a ground of which something has changed."""
    maps = np.stack([c.functional_map for c in found])
    size = maps.shape[1]
    out: list[Candidate] = []
    for says in (True, False):
        members = [i for i, c in enumerate(found) if c.uses_descriptors == says]
        if members:
            weights = _told_apart((AGAIN if says else WEIGHTS[0],), on)[0]
            refined = refine_batch(maps[members], on, (max(size // 2, 2), size), weights, (), threads)
            out += score_maps([(found[i].name, says) for i in members], *refined, on, threads)
    return out


def refine_batch(
    maps: np.ndarray,
    on: SamplePair,
    sizes: tuple[int, ...],
    weights: Weights,
    paired: Sequence[ExtremityMatch | None],
    threads: int | None,
) -> tuple[np.ndarray, np.ndarray]:
    """:func:`kfmaps.matching.batched_zoomout.batched_zoomout` on a ground; ``paired``: the tips that each map takes
    to each
    other."""
    bases = on.source.samples.basis, on.target.samples.basis
    return batched_zoomout(maps, *bases, sizes, on.against(*weights, paired=paired), threads, on.solver)


def score_maps(
    names: list[tuple[str, bool]],
    maps: np.ndarray,
    points: np.ndarray | None,
    on: SamplePair,
    threads: int | None = None,
) -> list[Candidate]:
    """Candidates of ``maps (m, k, k)`` with their quality.

    ``names``: of each and whether descriptors had a say; ``points (m, q_t)``: a source sample for each target sample,
    sought where they are ``None``.
    """
    functions = on.source.samples.basis.functions

    def judge(i: int) -> Candidate:
        C = maps[i]
        at = points[i] if points is not None else sample_points(C, on)
        off = np.zeros(0) if on.marks is None else landmark_errors(C, functions, on.marks)
        return Candidate(names[i][0], C, at, map_quality(C, on.source, on.target, at), names[i][1], off)

    return parallel(judge, range(len(maps)), threads)


def sample_points(C: np.ndarray, on: SamplePair) -> np.ndarray:
    """The source sample ``(q_t,)`` of each target sample by ``C (k_t, k_s)``."""
    k_t, k_s = C.shape
    images = on.source.samples.basis.functions[:, :k_s] @ C.T
    return nearest(on.target.samples.basis.functions[:, :k_t], images, threads=1)


def distinct_maps(
    order: list[Candidate], source: ShapeSamples, distance: float, most: int | None = None
) -> list[Candidate]:
    """Return the first of ``order``, then the first that is ``distance`` from it on average, and so on."""
    return select_distinct(order, lambda a, b: map_distance(a, b, source) > distance, most)


def map_distance(a: Candidate, b: Candidate, source: ShapeSamples) -> float:
    """Mean distance between the images of the target's samples, in units of √area."""
    return float(np.linalg.norm(source.positions[a.points] - source.positions[b.points], axis=1).mean())


def perturb(C: np.ndarray, eigenvalues: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """``C`` after a random rotation of the source's low functions that mixes mostly those of like frequency.

    Of a shape with a continuous symmetry, whose eigenvalues come in pairs, that is about a random symmetry; of any
    other it is a bad start, from which the refinement returns to the same map or strays to a worse one.
    """
    k = min(20, *C.shape)
    values = np.sqrt(np.maximum(eigenvalues[:k], 0.0))
    # Constants of many components have eigenvalues of rounding size: all are alike.
    width = 0.02 * max(float(values[-1]), MIN_FREQUENCY)
    alike = np.exp(-(((values[:, None] - values[None, :]) / width) ** 2))
    generator = rng.normal(size=(k, k)) * alike * np.pi
    rotation = expm((generator - generator.T) / 2)
    # A simple eigenvalue leaves no rotation, only the choice of sign, which a kick may flip too.
    signs = np.where(rng.random(k) < 0.25, -1.0, 1.0)
    signs[0] = 1.0
    return C[:k, :k] @ (rotation * signs[None, :])
