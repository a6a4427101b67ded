"""Find the sample of the whole for each sample of the part: candidates by SHOT, chosen by distances.

Distances on a part are those of the whole only where no shortest path crosses the cut. A path that meets the boundary
is at least as long as the sum of the distances of its ends from the boundary. So a distance on the part below that sum
is that of the whole; for a longer one the distance on the whole lies between the sum and the distance on the part. Both
bounds are exact for isometric shapes.

First each of a few samples has a few candidates, whose support for each other is iterated until one of them dominates
(relaxation labelling, Hummel and Zucker 1983, with the pairwise consistency of Leordeanu and Hebert 2005). Then each
sample is assigned again among all samples of the whole, by its distances to the nearest trusted samples.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import blocks

_SLACK = (0.02, 0.1)
"""Change of a distance from which a pair is inconsistent: for a distance of 0, in √area, and per distance."""
_LANDMARK_TRUST = 3.0  # trust in a landmark, where that of a sample is at most 1


@dataclass(frozen=True)
class RelaxationParams:
    """Parameters of a relaxation."""

    radii: tuple[float, ...] = (0.09, 0.14)  # of SHOT, in √area of the whole
    first: int = 150  # samples that are placed
    candidates: int = 12  # places of each: few samples with many places succeed where descriptors are misleading
    reach: float = 0.6  # distance up to which pairs count, in √area of the whole


@dataclass(frozen=True, eq=False)
class DistanceBounds:
    """Bounds ``(q, q)`` of the distances that the part's samples have on the whole, in its unit.

    ``upper`` is the distance on the part, ``lower`` that of a path that may leave it. Infinite bounds, as between
    components, do not count.
    """

    upper: np.ndarray
    lower: np.ndarray


@dataclass(frozen=True, eq=False)
class Assignment:
    """A sample of the whole for each of the part's."""

    match: np.ndarray  # (q,): number of the whole's sample
    trust: np.ndarray  # (q,): weight of each, from 0 to 1, and more for landmarks
    support: float  # mean consistency of the pairs within reach, 0 to 1


def distance_bounds(distances: np.ndarray, boundary_distance: np.ndarray, scale: float) -> DistanceBounds:
    """Return the bounds of ``distances (q, q)`` between samples ``boundary_distance (q,)`` away from the boundary."""
    upper = distances * np.float32(scale)
    around = (boundary_distance[:, None] + boundary_distance[None, :]) * np.float32(scale)
    return DistanceBounds(upper, np.minimum(upper, around))


def consistency(
    upper: np.ndarray, lower: np.ndarray, distances: np.ndarray, slack: tuple[float, float] = _SLACK
) -> np.ndarray:
    """Return the consistency of ``distances`` on the whole with the bounds, 0 to 1; the arrays are broadcast.

    A change that is explained by a path around the boundary counts half.
    """
    with np.errstate(invalid="ignore"):
        # In place, since most of the time is spent here.
        off = upper - distances
        if np.any(upper > lower):
            half, less = 0.5 * off, off - 0.5 * (upper - lower)
            np.minimum(off, np.maximum(half, less, out=less), out=off)
        off /= slack[0] + slack[1] * upper
        off *= off
        fits = np.subtract(1, off, out=off)
        fits.clip(0, np.inf, out=fits)  # takes half of the time of np.maximum with a number
    return fits if np.isfinite(upper).all() else np.where(np.isfinite(upper), fits, 0)


def relax(
    bounds: DistanceBounds,
    distances: np.ndarray,
    similarity: np.ndarray,
    params: RelaxationParams,
    n_landmarks: int = 0,
) -> Assignment:
    """Place the first few samples by relaxation labelling.

    ``distances (m, m)``: between the whole's samples; ``similarity (q, m)``: products of descriptors, in which each of
    the first ``n_landmarks`` rows has one entry above all others.
    """
    n = min(max(params.first, n_landmarks), len(similarity))
    k = min(params.candidates, similarity.shape[1])
    upper, lower, similarity = bounds.upper[:n, :n], bounds.lower[:n, :n], similarity[:n]
    candidates = np.argsort(-similarity, axis=1, kind="stable")[:, :k]
    relative = np.take_along_axis(similarity, candidates, 1)
    relative = relative - relative.max(axis=1, keepdims=True)
    prior = np.exp(relative / 0.1)
    share = np.exp(relative / 0.05)
    share /= share.sum(axis=1, keepdims=True)
    own, label = np.repeat(np.arange(n), k), candidates.ravel()
    near = (upper <= params.reach) & ~np.eye(n, dtype=bool)
    fits = np.empty((len(own), len(own)), dtype=np.result_type(upper, distances))
    for i in range(n):  # one sample after the other, so that its arrays fit the cache
        rows = slice(i * k, (i + 1) * k)
        between = distances[candidates[i]].take(label, axis=1)
        fits[rows] = consistency(upper[i, own], lower[i, own], between) * near[i, own]
    supports = share
    for _ in range(12):
        supports = (fits @ share.ravel().astype(fits.dtype)).reshape(n, k)
        share = prior * supports**2
        share /= share.sum(axis=1, keepdims=True) + 1e-12
        most = supports.max(axis=1)
        share *= np.minimum(most / max(float(np.median(most)), 1e-12), 1.5)[:, None]
    best = (prior * supports**2).argmax(axis=1)
    each = np.arange(n)
    support = supports[each, best].astype(np.float64)
    median = max(float(np.median(support)), 1e-12)
    trust, match = np.zeros(len(bounds.upper)), np.zeros(len(bounds.upper), dtype=np.int64)
    trust[:n] = np.where(support < 0.5 * median, 0.0, np.minimum(support / median, 1.0))
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
    """Place every sample again among all of the whole's, by its 40 nearest trusted neighbours and its descriptor.

    The parameters are those of :func:`relax`, with the assignment so far.
    """
    q = len(similarity)
    match, fit = np.zeros(q, dtype=np.int64), np.zeros(q)
    match[:n_landmarks] = placed.match[:n_landmarks]
    trusted = np.flatnonzero(placed.trust > 0)
    near = trusted[np.argsort(bounds.upper[:, trusted], axis=1, kind="stable")[:, :41]]
    upper, lower = (np.take_along_axis(side, near, axis=1) for side in (bounds.upper, bounds.lower))
    weight = placed.trust[near] / (0.1 + upper)  # 0 where the distance is infinite
    weight[near == np.arange(q)[:, None]] = 0.0
    weight = (weight / np.maximum(weight.sum(axis=1, keepdims=True), 1e-300)).astype(distances.dtype)
    for rows in blocks(q, 4):  # few samples at once, so that their arrays fit the cache
        to_places = distances[placed.match[near[rows]]]
        fits = consistency(upper[rows, :, None], lower[rows, :, None], to_places, (0.03, 0.08))
        means = (weight[rows, None] @ fits)[:, 0]
        free = slice(max(rows.start, n_landmarks), rows.stop)
        total = means + similarity[rows] - similarity[rows].max(axis=1, keepdims=True)
        match[free] = total.argmax(axis=1)[max(n_landmarks - rows.start, 0) :]
        fit[rows] = means[np.arange(len(means)), match[rows]]
    trust = np.maximum(fit - 0.3, 0.0) / (1 - 0.3)  # less consistent samples are not trusted
    trust[:n_landmarks] = _LANDMARK_TRUST
    return Assignment(match, trust, float(fit.mean()))


def scale_change(bounds: DistanceBounds, distances: np.ndarray, placed: Assignment) -> float:
    """Return the median ratio of distances on the whole to those on the part that no boundary lengthens.

    Where these are few, a quantile for all short distances takes its place.
    """
    trust = np.minimum(placed.trust, 1.0)
    on_whole = distances[np.ix_(placed.match, placed.match)]
    counts = (bounds.upper > 0.04) & (trust[:, None] * trust[None, :] > 0.08) & np.isfinite(on_whole)
    exact = counts & (bounds.lower >= bounds.upper) & (bounds.upper < 0.4)
    if exact.sum() >= 400:
        return float(np.median(on_whole[exact] / bounds.upper[exact]))
    counts &= bounds.upper < 0.25
    return float(np.quantile(on_whole[counts] / bounds.upper[counts], 0.6)) if counts.any() else 1.0
