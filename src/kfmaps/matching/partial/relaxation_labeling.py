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

STEPS = 12
"""Of the relaxation."""
SLACK = (0.02, 0.1)
"""Change of a distance that speaks against a pair altogether: at no distance, and per distance."""
NARROW = (0.03, 0.08)
"""The same when every sample chooses anew."""
DETOUR = 0.5
"""What a change that a detour around the boundary explains counts, against 1."""
NEAR = 40
"""Trusted samples that a sample is placed by."""
TRUST = 0.3
"""Consistency from which a sample is trusted."""
MARK = 3.0
"""Trust in a landmark, where that of a sample is at most 1."""


@dataclass(frozen=True)
class RelaxationParams:
    """One way to begin: what is compared, and how much is left open.

    Attributes
    ----------
    radii : tuple of float
        Of SHOT, in √area of the whole.
    first : int
        Samples that are placed at first, and ...
    candidates : int
        ... how many places each may have: few samples with many places find what descriptors alone do not.
    reach : float
        Distance up to which pairs count, in √area of the whole.
    """

    radii: tuple[float, ...] = (0.09, 0.14)
    first: int = 150
    candidates: int = 12
    reach: float = 0.6


@dataclass(frozen=True, eq=False)
class DistanceBounds:
    """Distances between the part's samples in the unit of the whole: as they are, and at least in the whole.

    ``far (q, q)`` and ``low (q, q)``, the latter at most the former; infinite distances say nothing.
    """

    far: np.ndarray
    low: np.ndarray


def distance_bounds(distances: np.ndarray, edge: np.ndarray, scale: float) -> DistanceBounds:
    """Of ``distances (q, q)`` and distances to the boundary ``edge (q,)``, times ``scale``."""
    far = distances * np.float32(scale)
    around = (edge[:, None] + edge[None, :]) * np.float32(scale)
    return DistanceBounds(far, np.minimum(far, around))


def consistency(
    far: np.ndarray, low: np.ndarray, there: np.ndarray, slack: tuple[float, float], detour: float = DETOUR
) -> np.ndarray:
    """How well distances ``there`` on the whole fit those of the part, 0 to 1; the arrays are broadcast."""
    with np.errstate(invalid="ignore"):
        off = far - there
        # Only what is shorter than on the part can be explained; one array after the other, since this is most of it.
        explained = np.clip(off, 0, far - low)
        explained *= 1 - detour
        off -= explained
        off /= slack[0] + slack[1] * far
        off *= off
        fits = np.subtract(1, off, out=off)
    # Infinite distances say nothing; what they give is no number, or less than none.
    return np.fmax(fits, 0, out=fits)


@dataclass(frozen=True, eq=False)
class Assignment:
    """A sample of the whole for each of the part's.

    Attributes
    ----------
    match : (q,) int64
        Number of the whole's sample.
    trust : (q,) float64
        0 for those that have no say.
    support : float
        Mean consistency of the pairs within reach, 0 to 1.
    """

    match: np.ndarray
    trust: np.ndarray
    support: float


def relax(
    part: DistanceBounds, whole: np.ndarray, alike: np.ndarray, trial: RelaxationParams, marks: int = 0
) -> Assignment:
    """The first few samples placed, by ``alike (q, m)``, the products of their descriptors with the whole's.

    ``whole (m, m)`` are distances there. Rows of the first ``marks`` samples have one entry above all others.
    """
    n = min(max(trial.first, marks), len(alike))
    k = min(trial.candidates, alike.shape[1])
    far, low, alike = part.far[:n, :n], part.low[:n, :n], alike[:n]
    candidates = np.argsort(-alike, axis=1, kind="stable")[:, :k]
    speaks = np.take_along_axis(alike, candidates, 1)
    speaks = speaks - speaks.max(axis=1, keepdims=True)
    prior = np.exp(speaks / 0.1)
    share = np.exp(speaks / 0.05)
    share /= share.sum(axis=1, keepdims=True)
    own, label = np.repeat(np.arange(n), k), candidates.ravel()
    near = (far <= trial.reach) & ~np.eye(n, dtype=bool)
    pairs = np.ix_(own, own)
    fits = consistency(far[pairs], low[pairs], whole[np.ix_(label, label)], SLACK) * near[pairs]
    backed = share
    for _ in range(STEPS):
        backed = (fits @ share.ravel().astype(fits.dtype)).reshape(n, k)
        share = prior * backed**2
        share /= share.sum(axis=1, keepdims=True) + 1e-12
        most = backed.max(axis=1)
        share *= np.minimum(most / max(float(np.median(most)), 1e-12), 1.5)[:, None]
    best = (prior * backed**2).argmax(axis=1)
    each = np.arange(n)
    support = backed[each, best].astype(np.float64)
    middle = max(float(np.median(support)), 1e-12)
    trust = np.where(support < 0.5 * middle, 0.0, np.minimum(support / middle, 1.0))
    trust[:marks] = MARK
    found = np.zeros(len(part.far), dtype=np.int64)
    found[:n] = candidates[each, best]
    trust = np.concatenate([trust, np.zeros(len(found) - n)])
    return Assignment(found, trust, float((support / np.maximum(near.sum(axis=1), 1)).mean()))


def reassign(
    part: DistanceBounds, whole: np.ndarray, alike: np.ndarray, placed: Assignment, marks: int = 0
) -> Assignment:
    """Every sample placed anew among all of the whole's, by its nearest trusted neighbours and its descriptor."""
    q = len(alike)
    match, fit = np.zeros(q, dtype=np.int64), np.zeros(q)
    trusted = np.flatnonzero(placed.trust > 0)
    for i in range(q):
        order = np.argsort(part.far[i, trusted], kind="stable")[: NEAR + 1]
        near = trusted[order]
        near = near[(near != i) & np.isfinite(part.far[i, near])]
        if len(near) == 0:
            match[i] = alike[i].argmax()
            continue
        far, low = part.far[i, near], part.low[i, near]
        fits = consistency(far, low, whole[:, placed.match[near]], NARROW)
        weight = placed.trust[near] / (0.1 + far)
        share = fits @ (weight / weight.sum()).astype(fits.dtype)
        match[i] = (share + alike[i] - alike[i].max()).argmax() if i >= marks else placed.match[i]
        fit[i] = share[match[i]]
    trust = np.maximum(fit - TRUST, 0.0) / (1 - TRUST)
    trust[:marks] = MARK
    return Assignment(match, trust, float(fit.mean()))


def stretch(part: DistanceBounds, whole: np.ndarray, placed: Assignment) -> float:
    """How much longer distances are on the whole, as far as the boundary has no say in them."""
    trust = np.minimum(placed.trust, 1.0)
    there = whole[np.ix_(placed.match, placed.match)]
    known = (part.far > 0.04) & (trust[:, None] * trust[None, :] > 0.08) & np.isfinite(there)
    sure = known & (part.low >= part.far) & (part.far < 0.4)
    if sure.sum() >= 400:
        return float(np.median(there[sure] / part.far[sure]))
    known &= part.far < 0.25
    return float(np.quantile(there[known] / part.far[known], 0.6)) if known.any() else 1.0
