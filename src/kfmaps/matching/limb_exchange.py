"""The best map with two alike limbs exchanged, and nothing else: alternatives that are made on purpose.

A map that exchanges two legs and is right elsewhere is near the right one on average, and the legs themselves fit as
well. What tells the two maps apart is the seam: the skin between exchanged legs is turned and stretched.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from kfmaps.matching.candidates import FINE_WEIGHTS, refine_batch
from kfmaps.matching.extremity_matching import ExtremityMatch, extremity_cost, extremity_difference, match_of_map
from kfmaps.matching.initial_maps import Start, distinct_weights
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.ranking import ProxyCache, rerank_close, with_bending
from kfmaps.matching.sample_pair import SamplePair
from kfmaps.matching.score import SCORE, Candidate

_MAX_DIFFERENCE = 0.3
"""Difference of two extremities (:func:`extremity_difference`) up to which their limbs are exchanged. The legs of one
side of an animal have 0.01 to 0.1, a leg and the head 0.25 and more."""


def exchange_limbs(best: Candidate, pair: SamplePair) -> list[Candidate]:
    """Return the map with two alike limbs of the source exchanged, one candidate for each pair of them.

    The samples that are nearest to the two extremities on the target go where the exchanged extremities say; the others
    stay. Then the map is refined with the exchanged extremities as evidence.
    """
    match = match_of_map(best.points, pair.source, pair.target)
    exchanged = [] if match is None else exchanged_matches(match, pair.source)
    if match is None or not exchanged:
        return []
    size, functions = len(best.functional_map), pair.source.samples.basis.functions
    nearest_extremity = pair.target.extremities.distances[match.target].argmin(axis=0)
    weights = distinct_weights(FINE_WEIGHTS[1:], pair)[0]
    starts = []
    for one in exchanged:
        cost = extremity_cost(pair.source.extremities, pair.target.extremities, one, pair.descriptor_cost)
        on_limb = (one.source != match.source)[nearest_extremity]
        points = np.where(on_limb, cost.argmin(axis=1), best.points)
        C = np.asarray(pair.solver(size) @ functions[points, :size], dtype=np.float64)
        starts.append(Start(f"{best.name}, two limbs exchanged", C, best.uses_descriptors, weights, match=one))
    half = max(size // 2, 2)
    return refine_batch(starts, pair, (half, (half + size) // 2, size))


def exchanged_matches(match: ExtremityMatch, source: ShapeSamples) -> list[ExtremityMatch]:
    """Return ``match`` with two alike extremities of the source exchanged, the most alike first."""
    unlike = extremity_difference(source, source)[np.ix_(match.source, match.source)]
    pairs = [(unlike[i, j], i, j) for i, j in combinations(range(len(match.source)), 2)]
    found = []
    for difference, i, j in sorted(pairs)[:4]:  # pairs of limbs that are exchanged, the most alike
        if difference <= _MAX_DIFFERENCE:
            images = match.source.copy()
            images[[i, j]] = images[[j, i]]
            found.append(ExtremityMatch(images, match.target))
    return found


def compare_exchanged(best: Candidate, pair: SamplePair, copies: ProxyCache) -> list[Candidate]:
    """Return the map and itself with the two limbs exchanged that come nearest to it, the better first.

    Both are judged by the same evidence. Only the map itself where no exchange scores nearly as well.
    """
    plain = best.unregistered
    rivals = [c for c in exchange_limbs(plain, pair) if c.score > plain.score - SCORE.max_behind]
    judged = with_bending([plain, *rivals], copies) if rivals else []
    if not judged:
        return [best]
    rival = max(judged[1:], key=lambda c: c.score)
    order = sorted([judged[0], rival], key=lambda c: -c.score)
    margin = order[0].score - order[1].score
    return rerank_close(order, copies) if margin < SCORE.shot_margin else order
