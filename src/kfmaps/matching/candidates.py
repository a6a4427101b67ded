"""Candidate maps: initial maps that are refined on samples of both shapes, and scored.

1. Initial maps with all signs of the low functions are refined by ZoomOut on the coarse samples, with few functions.
2. Unless one of them is clearly right, kernel fits and extremity matches are refined likewise.
3. The best are composed with the self-maps of both shapes and refined likewise.
4. The best distinct maps are refined on the fine samples, with more functions, with descriptors and without them.

Every refined map is scored by :func:`kfmaps.matching.quality.map_quality`.
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
    COARSE_WEIGHTS,
    FIT_SAMPLES,
    Start,
    distinct_weights,
    extremity_inits,
    kernel_inits,
    sign_inits,
    symmetry_inits,
)
from kfmaps.matching.landmark_evidence import landmark_errors
from kfmaps.matching.quality import ShapeSamples, map_quality
from kfmaps.matching.sample_pair import STRONG, CostWeights, SamplePair, TwoLevelSamples
from kfmaps.matching.score import SCORE, Candidate, by_score, select_distinct
from kfmaps.shape import Shape

FINE_FUNCTIONS = 80
"""Functions of candidates."""
FINE_WEIGHTS: tuple[CostWeights, ...] = (STRONG, (*STRONG, 30.0))
"""Weights of the fine refinement, without extremities and with them: distances from extremities mislead where a hand
touches a thigh."""
_N_EARLY_WEIGHTS = 2  # weights of sign maps that are refined before a clear map ends the search for initial maps
_N_FINALISTS, _N_CLEAR_FINALISTS = 10, 6
"""Distinct coarse maps that are refined on the fine samples, and with a clear map among them."""


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

    ``landmarks (l, 2)``: used by kernel fits; all else takes them from the samples. ``rng``: seed of the points that
    fits are made from; everything else is drawn with :func:`derived_seed`.
    """
    assert config.search is not None
    coarse, seed = samples.coarse, derived_seed(rng)
    functions = min(len(source.basis.eigenvalues), len(target.basis.eigenvalues))
    pairs = np.zeros((0, 2), dtype=np.int64) if landmarks is None else landmarks
    signs, weights = min(config.search.n_sign_functions, functions - 1), distinct_weights(COARSE_WEIGHTS, coarse)
    maps = refine_coarse(sign_inits(signs, coarse, weights[:_N_EARLY_WEIGHTS]), coarse, functions)
    report(0.3)
    # Landmarks and descriptors of the user take part in the kernel fits, which are then made in any case.
    is_clear = len(pairs) == 0 and descriptors is None and has_clear_map(maps)
    if not is_clear:
        maps += refine_coarse(sign_inits(signs, coarse, weights[_N_EARLY_WEIGHTS:]), coarse, functions)
        fit_samples = sample_pair_for_fit(source, target, FIT_SAMPLES, pairs, descriptors, rng)
        starts = kernel_inits(fit_samples, config, samples, seed) + extremity_inits(functions, coarse)
        report(0.5)
        maps += refine_coarse(starts, coarse, functions)
    report(0.7)
    order = by_score(maps)
    n_composed = 3  # best distinct coarse maps that are composed with self-maps
    best = distinct_maps(order, coarse.source, SCORE.distinct_distance, n_composed)
    composed = by_score(refine_coarse(symmetry_inits(best, coarse, functions), coarse, functions))
    maps += composed
    min_gain = 1.0  # in score, from which what a composition has led to is composed once more: it is another map
    if composed and composed[0].score > order[0].score + min_gain:
        maps += refine_coarse(symmetry_inits(composed[:1], coarse, functions), coarse, functions)
    report(0.75)
    finalists = _N_CLEAR_FINALISTS if is_clear else _N_FINALISTS
    chosen = distinct_maps(by_score(maps), coarse.source, SCORE.rough_distance, finalists)
    refined = refine_fine(chosen, samples)
    report(1.0)
    return refined


def derived_seed(rng: int) -> int:
    """Return the seed of a search's samples and of all that is drawn after them."""
    return int(np.random.default_rng(rng).integers(2**31))


def has_clear_map(maps: list[Candidate]) -> bool:
    """Return whether a sign map with descriptors is so good that other initial maps would add nothing.

    Between two people one usually is. Then only maps that it may be mistaken for are sought.
    """
    return max((c.quality.score for c in maps if c.uses_descriptors), default=-math.inf) >= SCORE.early_exit_score


def refine_coarse(starts: list[Start], pair: SamplePair, functions: int) -> list[Candidate]:
    """Refine the starts on the coarse samples, up to 40 functions in steps of 4."""
    stop = min(40, functions)
    groups: dict[tuple[int, CostWeights], list[Start]] = {}
    for start in starts:
        size = min(start.functions, stop, *start.functional_map.shape)
        groups.setdefault((size, start.weights), []).append(start)
    return [
        candidate
        for (size, _), members in groups.items()
        for candidate in refine_batch(members, pair, (*range(size, stop, 4), stop))
    ]


def refine_fine(chosen: list[Candidate], samples: TwoLevelSamples, again: bool = False) -> list[Candidate]:
    """Refine coarse maps on the fine samples, up to :data:`FINE_FUNCTIONS` functions in steps of 5.

    All are refined with descriptors, and those that were refined without them once more without. ``again``: they have
    been refined on the fine samples before, and begin with half as many functions.
    """
    fine = samples.fine
    known, first = (fine, FINE_FUNCTIONS // 2) if again else (samples.coarse, 20)  # from fewer right maps are lost
    guided, bare = distinct_weights(FINE_WEIGHTS, fine), COARSE_WEIGHTS[0]
    stop = min(FINE_FUNCTIONS, *(side.samples.basis.functions.shape[1] for side in (fine.source, fine.target)))
    refined: list[Candidate] = []
    for weights in dict.fromkeys((bare, *guided)):
        members = [c for c in chosen if weights in guided or not c.uses_descriptors]
        if members:
            size = min(first, stop, *members[0].functional_map.shape)
            uses = bool(weights[0]) or fine.descriptor_cost is None
            matches = [match_of_map(c.points, known.source, known.target) if weights[2:] else None for c in members]
            starts = [
                Start(c.name, c.functional_map, uses, weights, match=match, fit=c.fit)
                for c, match in zip(members, matches, strict=True)
            ]
            refined += refine_batch(starts, fine, (*range(size, stop, 5), stop))
    return refined


def compose_with_symmetries(one: Candidate, samples: TwoLevelSamples) -> list[Candidate]:
    """Return refined candidates that start from a map composed with the self-maps of both shapes."""
    coarse = samples.coarse
    functions = min(side.samples.basis.functions.shape[1] for side in (samples.fine.source, samples.fine.target))
    maps = refine_coarse(symmetry_inits([one], coarse, functions), coarse, functions)
    chosen = distinct_maps(by_score(maps), coarse.source, SCORE.rough_distance, _N_CLEAR_FINALISTS)
    return refine_fine(chosen, samples) if chosen else []


def rerefine(found: list[Candidate], pair: SamplePair) -> list[Candidate]:
    """Refine candidates once more, on samples whose costs have changed."""
    size = len(found[0].functional_map)
    refined: list[Candidate] = []
    for uses in (True, False):
        weights = distinct_weights((FINE_WEIGHTS[0] if uses else COARSE_WEIGHTS[0],), pair)[0]
        members = [c for c in found if c.uses_descriptors == uses]
        starts = [Start(c.name, c.functional_map, uses, weights, fit=c.fit) for c in members]
        refined += refine_batch(starts, pair, (max(size // 2, 2), size)) if starts else []
    return refined


def refine_batch(starts: list[Start], pair: SamplePair, sizes: tuple[int, ...]) -> list[Candidate]:
    """Refine maps of the same weights by ZoomOut with these ``sizes`` on a pair of samples, and score them."""
    bases = pair.source.samples.basis, pair.target.samples.basis
    maps = np.stack([start.functional_map[: sizes[0], : sizes[0]] for start in starts])
    cost = pair.matching_cost(*starts[0].weights, matches=[start.match for start in starts])
    refined = zip(starts, *batched_zoomout(maps, *bases, sizes, cost, pair.solver), strict=True)
    return score_maps([replace(start, functional_map=C, points=at) for start, C, at in refined], pair)


def score_maps(maps: Sequence[Start | Candidate], pair: SamplePair) -> list[Candidate]:
    """Return maps as candidates with their quality on a pair of samples; points that are not known are computed."""
    functions, evidence = pair.source.samples.basis.functions, pair.landmark_evidence

    def score(one: Start | Candidate) -> Candidate:
        C = one.functional_map
        at = sample_points(C, pair) if one.points is None else one.points
        errors = np.zeros(0) if evidence is None else landmark_errors(C, functions, evidence)
        quality = map_quality(C, pair.source, pair.target, at)
        return Candidate(one.name, C, at, quality, one.uses_descriptors, errors, fit=one.fit)

    return parallel(score, maps)


def sample_points(C: np.ndarray, pair: SamplePair) -> np.ndarray:
    """Return the source sample ``(q_t,)`` of each target sample by ``C (k_t, k_s)``."""
    k_t, k_s = C.shape
    images = pair.source.samples.basis.functions[:, :k_s] @ C.T
    return nearest(pair.target.samples.basis.functions[:, :k_t], images)


def distinct_maps(
    order: list[Candidate], source: ShapeSamples, distance: float, most: int | None = None
) -> list[Candidate]:
    """Return the first of ``order``, then the first whose distance from it is larger than ``distance``, and so on."""
    return select_distinct(order, lambda a, b: map_distance(a, b, source) > distance, most)


def map_distance(a: Candidate, b: Candidate, source: ShapeSamples) -> float:
    """Return the mean distance between the images of the target's samples, in √area."""
    return float(np.linalg.norm(source.positions[a.points] - source.positions[b.points], axis=1).mean())
