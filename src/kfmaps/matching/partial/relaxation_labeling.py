"""Which sample of the whole belongs to which sample of the part: SHOT proposes, distances decide.

A part keeps distances only where no cut comes between. A shortest path that meets the boundary is at least as long as
both its ends are from the boundary together; so a distance shorter than that is the whole's own, and one that is longer
says that the whole's distance lies between that sum and itself. Both are exact for isometric shapes.

First each sample has a few candidates and their support for each other is balanced until one of them stands out
(relaxation labelling, Hummel and Zucker 1983, on the pairwise consistency of Leordeanu and Hebert 2005). Then every
sample chooses anew among all of the whole's, by its distances to the nearest samples whose place is trusted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import blocks

_SLACK = (0.02, 0.1)
"""Change of a distance that speaks against a pair altogether: at no distance, in √area, and per distance."""
_LANDMARK_TRUST = 3.0  # trust in a landmark, where that of a sample is at most 1


@dataclass(frozen=True)
class RelaxationParams:
    """How a relaxation begins."""

    radii: tuple[float, ...] = (0.09, 0.14)  # of SHOT, in √area of the whole
    first: int = 150  # samples that are placed at first
    candidates: int = 12  # places that each may have: few samples with many places find what descriptors alone do not
    reach: float = 0.6  # distance up to which pairs count, in √area of the whole


@dataclass(frozen=True, eq=False)
class DistanceBounds:
    """Bounds ``(q, q)`` of the distances that the part's samples have on the whole, in its unit.

    ``upper`` is the distance on the part, ``lower`` that of a path that may leave it; where they are infinite, as
    between components, they say nothing.
    """

    upper: np.ndarray
    lower: np.ndarray


@dataclass(frozen=True, eq=False)
class Assignment:
    """A sample of the whole for each of the part's."""

    match: np.ndarray  # (q,): number of the whole's sample
    trust: np.ndarray  # (q,): 0 for samples whose place is not to be relied on, up to 1, and more for landmarks
    support: float  # mean consistency of the pairs within reach, 0 to 1


def distance_bounds(distances: np.ndarray, boundary_distance: np.ndarray, scale: float) -> DistanceBounds:
    """Return the bounds of ``distances (q, q)`` between samples ``boundary_distance (q,)`` away from the boundary."""
    upper = distances * np.float32(scale)
    around = (boundary_distance[:, None] + boundary_distance[None, :]) * np.float32(scale)
    return DistanceBounds(upper, np.minimum(upper, around))


def consistency(
    upper: np.ndarray, lower: np.ndarray, distances: np.ndarray, slack: tuple[float, float] = _SLACK
) -> np.ndarray:
    """Return how well ``distances`` on the whole fit the bounds, 0 to 1; the arrays are broadcast.

    A change that a way around the boundary explains counts half.
    """
    with np.errstate(invalid="ignore"):
        # One array after the other, since this is where most of the time goes.
        off = upper - distances
        if np.any(upper > lower):
            half, less = 0.5 * off, off - 0.5 * (upper - lower)
            np.minimum(off, np.maximum(half, less, out=less), out=off)
        off /= slack[0] + slack[1] * upper
        off *= off
        fits = np.subtract(1, off, out=off)
        fits.clip(0, np.inf, out=fits)  # which takes half of the time of np.maximum with a number
    # Infinite distances say nothing.
    return fits if np.isfinite(upper).all() else np.where(np.isfinite(upper), fits, 0)


def relax(
    bounds: DistanceBounds,
    distances: np.ndarray,
    similarity: np.ndarray,
    params: RelaxationParams,
    n_landmarks: int = 0,
) -> Assignment:
    """Place the first few samples by relaxation labelling.

    ``distances (m, m)``: between the whole's samples; ``similarity (q, m)``: products of descriptors; rows of the first
    ``n_landmarks`` samples have one entry above all others.
    """
    n = min(max(params.first, n_landmarks), len(similarity))
    k = min(params.candidates, similarity.shape[1])
    upper, lower, similarity = bounds.upper[:n, :n], bounds.lower[:n, :n], similarity[:n]
    candidates = np.argsort(-similarity, axis=1, kind="stable")[:, :k]
    speaks = np.take_along_axis(similarity, candidates, 1)
    speaks = speaks - speaks.max(axis=1, keepdims=True)
    prior = np.exp(speaks / 0.1)
    share = np.exp(speaks / 0.05)
    share /= share.sum(axis=1, keepdims=True)
    own, label = np.repeat(np.arange(n), k), candidates.ravel()
    near = (upper <= params.reach) & ~np.eye(n, dtype=bool)
    fits = np.empty((len(own), len(own)), dtype=np.result_type(upper, distances))
    for i in range(n):  # one sample after the other, so that its arrays fit the cache
        rows = slice(i * k, (i + 1) * k)
        between = distances[candidates[i]].take(label, axis=1)
        fits[rows] = consistency(upper[i, own], lower[i, own], between) * near[i, own]
    backed = share
    for _ in range(12):
        backed = (fits @ share.ravel().astype(fits.dtype)).reshape(n, k)
        share = prior * backed**2
        share /= share.sum(axis=1, keepdims=True) + 1e-12
        most = backed.max(axis=1)
        share *= np.minimum(most / max(float(np.median(most)), 1e-12), 1.5)[:, None]
    best = (prior * backed**2).argmax(axis=1)
    each = np.arange(n)
    support = backed[each, best].astype(np.float64)
    middle = max(float(np.median(support)), 1e-12)
    trust, match = np.zeros(len(bounds.upper)), np.zeros(len(bounds.upper), dtype=np.int64)
    trust[:n] = np.where(support < 0.5 * middle, 0.0, np.minimum(support / middle, 1.0))
    trust[:n_landmarks] = _LANDMARK_TRUST
    match[:n] = candidates[each, best]
    return Assignment(match, trust, float((support / np.maximum(near.sum(axis=1), 1)).mean()))


def reassign(
    bounds: DistanceBounds,
    distances: np.ndarray,
    similarity: np.ndarray,
    placed: Assignment,
    n_landmarks: int = 0,
) -> Assignment:
    """Place every sample anew among all of the whole's, by its 40 nearest trusted neighbours and its descriptor.

    The parameters are those of :func:`relax`, with the assignment so far.
    """
    q = len(similarity)
    match, fit = np.zeros(q, dtype=np.int64), np.zeros(q)
    match[:n_landmarks] = placed.match[:n_landmarks]
    trusted = np.flatnonzero(placed.trust > 0)
    near = trusted[np.argsort(bounds.upper[:, trusted], axis=1, kind="stable")[:, :41]]
    upper, lower = (np.take_along_axis(side, near, axis=1) for side in (bounds.upper, bounds.lower))
    weight = placed.trust[near] / (0.1 + upper)  # none where the distance is infinite
    weight[near == np.arange(q)[:, None]] = 0.0
    weight = (weight / np.maximum(weight.sum(axis=1, keepdims=True), 1e-300)).astype(distances.dtype)
    for some in blocks(q, 4):  # few samples at once, so that their arrays fit the cache
        there = distances[placed.match[near[some]]]
        fits = consistency(upper[some, :, None], lower[some, :, None], there, (0.03, 0.08))
        share = (weight[some, None] @ fits)[:, 0]
        free = slice(max(some.start, n_landmarks), some.stop)
        better = share + similarity[some] - similarity[some].max(axis=1, keepdims=True)
        match[free] = better.argmax(axis=1)[max(n_landmarks - some.start, 0) :]
        fit[some] = share[np.arange(len(share)), match[some]]
    trust = np.maximum(fit - 0.3, 0.0) / (1 - 0.3)  # samples less consistent than that are not trusted
    trust[:n_landmarks] = _LANDMARK_TRUST
    return Assignment(match, trust, float(fit.mean()))


def scale_change(bounds: DistanceBounds, distances: np.ndarray, placed: Assignment) -> float:
    """Return how much longer distances are on the whole, as far as the boundary has no say in them."""
    trust = np.minimum(placed.trust, 1.0)
    there = distances[np.ix_(placed.match, placed.match)]
    known = (bounds.upper > 0.04) & (trust[:, None] * trust[None, :] > 0.08) & np.isfinite(there)
    sure = known & (bounds.lower >= bounds.upper) & (bounds.upper < 0.4)
    if sure.sum() >= 400:
        return float(np.median(there[sure] / bounds.upper[sure]))
    known &= bounds.upper < 0.25
    return float(np.quantile(there[known] / bounds.upper[known], 0.6)) if known.any() else 1.0
