"""The best map with limbs exchanged: alternatives that are made on purpose.

A map that exchanges two legs and is right elsewhere is near the right map on average, and the legs themselves fit as
well. What tells the two maps apart is the seam: the surface between exchanged legs is twisted and stretched. Legs may
also be exchanged alike on both sides of a body, so that the map still commutes with its reflection.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from kfmaps.matching.candidates import FINE_WEIGHTS, by_score, map_distance, refine_batch
from kfmaps.matching.extremity_matching import ExtremityMatch, extremity_cost, extremity_difference, match_of_map
from kfmaps.matching.initial_maps import Start, distinct_weights
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.ranking import ProxyCache, rerank_close, with_deformation_energy
from kfmaps.matching.sample_pair import SamplePair
from kfmaps.matching.score import SCORE, Candidate

_MAX_DIFFERENCE = 0.5
"""Difference of two extremities (:func:`extremity_difference`) up to which their limbs are exchanged. The legs of one
side of an animal have 0.01 to 0.1, a leg and the head 0.25 and more, branches of a tree up to 0.43."""


def exchange_limbs(best: Candidate, pair: SamplePair) -> list[Candidate]:
    """Return the map with limbs of the source exchanged, one candidate for each of :func:`exchanged_matches`.

    Samples go to those that are most similar by the exchanged extremities, and the map is refined from few functions on
    with these as evidence.
    """
    match = match_of_map(best.points, pair.source, pair.target)
    if match is None:
        return []
    size, functions = len(best.functional_map), pair.source.samples.basis.functions
    weights = distinct_weights(FINE_WEIGHTS[1:], pair)[0]
    starts = []
    for other in exchanged_matches(match, pair.source, pair.target):
        cost = extremity_cost(pair.source.extremities, pair.target.extremities, other, pair.descriptor_cost)
        C = np.asarray(pair.solver(size) @ functions[cost.argmin(axis=1), :size], dtype=np.float64)
        starts.append(Start(f"{best.name}, limbs exchanged", C, best.uses_descriptors, weights, match=other))
    quarters = tuple(max(size * i // 4, 2) for i in (1, 2, 3, 4))
    return refine_batch(starts, pair, quarters) if starts else []


def exchanged_matches(match: ExtremityMatch, source: ShapeSamples, target: ShapeSamples) -> list[ExtremityMatch]:
    """Return ``match`` with extremities of the source exchanged.

    They are two similar ones, or two of one side of a body and likewise their mirror images.
    """
    difference = extremity_difference(source, source)[np.ix_(match.source, match.source)]
    pairs = sorted((difference[i, j], i, j) for i, j in combinations(range(len(match.source)), 2))
    most = 10  # pairs of limbs that are exchanged alone, the most similar
    alone = [((i, j),) for d, i, j in pairs[:most] if d <= _MAX_DIFFERENCE]
    return [_exchanged(match, both) for both in (*alone, *_mirrored_pairs(match, source, target))]


def _mirrored_pairs(
    match: ExtremityMatch, source: ShapeSamples, target: ShapeSamples
) -> list[tuple[tuple[int, int], tuple[int, int]]]:
    """Return pairs of matched extremities of one side of a body, each with the pair of their mirror images.

    The reflection of either shape tells them.
    """
    shape, chosen = (target, match.target) if source.reflected_extremities is None else (source, match.source)
    if shape.reflected_extremities is None:
        return []
    place = {extremity: i for i, extremity in enumerate(chosen.tolist())}
    partner = [place.get(one, i) for i, one in enumerate(shape.reflected_extremities[chosen].tolist())]
    between = shape.extremities.distances[:, shape.extremities.points][np.ix_(chosen, chosen)]
    return [
        ((i, j), (partner[i], partner[j]))
        for i, j in combinations(range(len(partner)), 2)
        if i < min(partner[i], partner[j]) and between[i, j] < between[i, partner[j]]
    ]


def _exchanged(match: ExtremityMatch, pairs: tuple[tuple[int, int], ...]) -> ExtremityMatch:
    """Return ``match`` with the extremities of the source of each of these pairs exchanged."""
    images = match.source.copy()
    for i, j in pairs:
        images[[i, j]] = images[[j, i]]
    return ExtremityMatch(images, match.target)


def compare_exchanged(best: Candidate, pair: SamplePair, proxies: ProxyCache) -> list[Candidate]:
    """Return the map and the best one with limbs exchanged, the better first, scored by the same evidence.

    Return one alone where no other has nearly as good a score, or hardly differs: two ears exchanged make no rival.
    """
    start = best.unregistered

    def may_win(other: Candidate) -> bool:
        least = start.score if _are_alike(other, start, pair) else start.score - SCORE.max_exchange_behind
        return other.score > least

    found, last = by_score(exchange_limbs(start, pair)), start
    while found and found[0].score > last.score:  # three legs, each taken for the next, need two exchanges
        last = found[0]
        found = by_score([*found, *exchange_limbs(last, pair)])
    exchanged = [c for c in found if may_win(c)]
    registered = by_score(with_deformation_energy([start, *exchanged], proxies)) if exchanged else []
    if not registered:
        return [best]
    order = [registered[0], *(c for c in registered[1:] if not _are_alike(c, registered[0], pair))][:2]
    is_close = len(order) == 2 and order[0].score - order[1].score < SCORE.shot_margin
    return rerank_close(order, proxies) if is_close else order


def _are_alike(one: Candidate, other: Candidate, pair: SamplePair) -> bool:
    """Return whether two maps differ by less than two with limbs exchanged do."""
    return map_distance(one, other, pair.source) < SCORE.min_exchange_distance
