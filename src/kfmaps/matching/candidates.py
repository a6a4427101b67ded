"""Candidate maps of two shapes, before anything is chosen.

Many initial maps (:mod:`kfmaps.matching.initial_maps`) are refined on a few hundred points; the best are composed with
random symmetries and with those that the shapes nearly have. The best that differ are refined further and judged again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from kfmaps._arrays import Array
from kfmaps._threads import parallel
from kfmaps.config import Config
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.zoomout import batched_zoomout
from kfmaps.matching.extremity_matching import match_of_map
from kfmaps.matching.features import sample_pair_for_fit
from kfmaps.matching.initial_maps import (
    FIT_POINTS,
    MUCH,
    STARTS,
    WEIGHTS,
    KernelWeights,
    Start,
    distinct_weights,
    extremity_inits,
    kernel_inits,
    perturb,
    sign_inits,
    symmetry_inits,
)
from kfmaps.matching.landmark_evidence import landmark_errors
from kfmaps.matching.quality import ShapeSamples, map_quality
from kfmaps.matching.sample_pair import SamplePair, TwoLevelSamples
from kfmaps.matching.score import SCORE, Candidate, select_distinct
from kfmaps.shape import Shape

_QUICK = 2  # weights of the sign choices after which a search may end early: then the others are left out
FINE = 80
"""Functions of refined candidates, which are scored."""
FINE_WEIGHTS: tuple[KernelWeights, ...] = (MUCH, (*MUCH, 30.0))
"""Without extremities and with them: distances from extremities mislead where a hand has grown to a thigh."""
N_PERTURBATIONS = 6
"""Maps that start from a random symmetry of the low functions."""
_FEWER = 6
"""Distinct rough maps that are refined further where a search ends early; else it is ten."""


def candidates(
    source: Shape,
    target: Shape,
    config: Config,
    samples: TwoLevelSamples,
    rng: int,
    *,
    landmarks: np.ndarray | None = None,
    descriptors: tuple[Array, Array] | None = None,
    report: Callable[[float], None] = lambda _done: None,
) -> list[Candidate]:
    """Return refined candidates, in no order.

    ``landmarks (l, 2)`` take part in the fits; elsewhere it is the samples that know of them. ``rng`` is the seed of
    the points that the fits are made from; everything else is drawn with :func:`drawn_seed`.
    """
    assert config.search is not None
    few, seed = samples.few, drawn_seed(rng)
    functions = min(len(source.basis.eigenvalues), len(target.basis.eigenvalues))
    pairs = np.zeros((0, 2), dtype=np.int64) if landmarks is None else landmarks
    signs, weights = min(config.search.n_sign_functions, functions - 1), distinct_weights(WEIGHTS, few)
    found = refine_coarse(sign_inits(signs, few, weights[:_QUICK]), few, functions)
    report(0.3)
    # What the user says of landmarks and points is heard in the fits.
    easy = len(pairs) == 0 and descriptors is None and early_exit(found)
    if not easy:
        found += refine_coarse(sign_inits(signs, few, weights[_QUICK:]), few, functions)
        points = sample_pair_for_fit(source, target, FIT_POINTS, pairs, descriptors, rng)
        starts = kernel_inits(points, config, samples, seed) + extremity_inits(functions, few)
        report(0.5)
        found += refine_coarse(starts, few, functions)
    report(0.7)
    order = by_score(found)
    composed = 3  # of the best rough maps that differ, those that are composed with symmetries of the shapes
    best = distinct_maps(order, few.source, SCORE.distinct_distance, composed)
    again = symmetry_inits(best, few, functions)
    if not easy:
        C, values = order[0].functional_map, source.basis.eigenvalues
        kicks = [perturb(C, values, np.random.default_rng(seed + i)) for i in range(N_PERTURBATIONS)]
        again += [Start(f"kicked {i}", kick, False, WEIGHTS[0], STARTS[0]) for i, kick in enumerate(kicks)]
    found += refine_coarse(again, few, functions)
    report(0.75)
    finalists = _FEWER if easy else 10
    chosen = distinct_maps(by_score(found), few.source, SCORE.rough_distance, finalists)
    refined = refine_fine(chosen, few, samples.whole, functions)
    report(1.0)
    return refined


def drawn_seed(rng: int) -> int:
    """Return the seed of a search's samples and of all that is drawn after them."""
    return int(np.random.default_rng(rng).integers(2**31))


def early_exit(found: list[Candidate]) -> bool:
    """Return whether a diagonal map is so good that fits, extremities and perturbations have nothing to add.

    Of two people one is; only what such a map is mistaken for is looked for then.
    """
    return max((c.quality.score for c in found if c.uses_descriptors), default=-math.inf) >= SCORE.early_exit_score


def refine_coarse(starts: list[Start], pair: SamplePair, functions: int) -> list[Candidate]:
    """Refine the starts on few samples, up to 40 functions in steps of 4."""
    stop = min(40, functions)
    groups: dict[tuple[int, KernelWeights], list[Start]] = {}
    for start in starts:
        size = min(start.functions, stop, *start.functional_map.shape)
        groups.setdefault((size, start.weights), []).append(start)
    found = []
    for (size, _), members in groups.items():
        found += refine_batch(members, pair, (*range(size, stop, 4), stop))
    return found


def refine_fine(chosen: list[Candidate], few: SamplePair, pair: SamplePair, functions: int) -> list[Candidate]:
    """Refine the chosen maps, found on ``few`` samples, on all, up to :data:`FINE` functions in steps of 5.

    All are refined with descriptors, and alternatives without as well.
    """
    guided, bare = distinct_weights(FINE_WEIGHTS, pair), WEIGHTS[0]
    stop = min(FINE, functions)
    found = []
    for weights in dict.fromkeys((bare, *guided)):
        members = [c for c in chosen if weights in guided or not c.uses_descriptors]
        if members:
            size = min(20, stop, *members[0].functional_map.shape)  # from fewer functions it loses right maps
            uses = bool(weights[0]) or pair.descriptor_cost is None
            starts = [Start(c.name, c.functional_map, uses, weights, fit=c.fit) for c in members]
            if weights[2:]:
                matches = [match_of_map(c.points, few.source, few.target) for c in members]
                starts = [replace(start, match=match) for start, match in zip(starts, matches, strict=True)]
            found += refine_batch(starts, pair, (*range(size, stop, 5), stop))
    return found


def compose_with_symmetries(one: Candidate, samples: TwoLevelSamples) -> list[Candidate]:
    """Return refined candidates that start from a map composed with the near-symmetries of both shapes."""
    functions = min(side.samples.basis.functions.shape[1] for side in (samples.whole.source, samples.whole.target))
    rough = refine_coarse(symmetry_inits([one], samples.few, functions), samples.few, functions)
    chosen = distinct_maps(by_score(rough), samples.few.source, SCORE.rough_distance, _FEWER)
    return refine_fine(chosen, samples.few, samples.whole, functions) if chosen else []


def rerefine(found: list[Candidate], pair: SamplePair) -> list[Candidate]:
    """Refine finished candidates once more, on samples of which something has changed."""
    size = len(found[0].functional_map)
    out: list[Candidate] = []
    for uses in (True, False):
        weights = distinct_weights((FINE_WEIGHTS[0] if uses else WEIGHTS[0],), pair)[0]
        starts = [
            Start(c.name, c.functional_map, uses, weights, fit=c.fit) for c in found if c.uses_descriptors == uses
        ]
        out += refine_batch(starts, pair, (max(size // 2, 2), size)) if starts else []
    return out


def refine_batch(starts: list[Start], pair: SamplePair, sizes: tuple[int, ...]) -> list[Candidate]:
    """Refine maps of the same weights on a pair of samples, in steps of these ``sizes``, and score them."""
    bases = pair.source.samples.basis, pair.target.samples.basis
    maps = np.stack([start.functional_map[: sizes[0], : sizes[0]] for start in starts])
    cost = pair.matching_cost(*starts[0].weights, matches=[start.match for start in starts])
    refined = zip(starts, *batched_zoomout(maps, *bases, sizes, cost, pair.solver), strict=True)
    return score_maps([replace(start, functional_map=C, points=at) for start, C, at in refined], pair)


def score_maps(found: Sequence[Start | Candidate], pair: SamplePair) -> list[Candidate]:
    """Return maps as candidates, with their quality on a pair of samples; points that are not known are sought."""
    functions, evidence = pair.source.samples.basis.functions, pair.landmark_evidence

    def judge(one: Start | Candidate) -> Candidate:
        C = one.functional_map
        at = sample_points(C, pair) if one.points is None else one.points
        errors = np.zeros(0) if evidence is None else landmark_errors(C, functions, evidence)
        quality = map_quality(C, pair.source, pair.target, at)
        return Candidate(one.name, C, at, quality, one.uses_descriptors, errors, fit=one.fit)

    return parallel(judge, found)


def sample_points(C: np.ndarray, pair: SamplePair) -> np.ndarray:
    """Return the source sample ``(q_t,)`` of each target sample by ``C (k_t, k_s)``."""
    k_t, k_s = C.shape
    images = pair.source.samples.basis.functions[:, :k_s] @ C.T
    return nearest(pair.target.samples.basis.functions[:, :k_t], images)


def by_score(found: list[Candidate]) -> list[Candidate]:
    """Return the candidates, best first."""
    return sorted(found, key=lambda c: c.score, reverse=True)


def distinct_maps(
    order: list[Candidate], source: ShapeSamples, distance: float, most: int | None = None
) -> list[Candidate]:
    """Return the first of ``order``, then the first that is ``distance`` from it on average, and so on."""
    return select_distinct(order, lambda a, b: map_distance(a, b, source) > distance, most)


def map_distance(a: Candidate, b: Candidate, source: ShapeSamples) -> float:
    """Return the mean distance between the images of the target's samples, in √area."""
    return float(np.linalg.norm(source.positions[a.points] - source.positions[b.points], axis=1).mean())
