"""A few far-flung samples of the part placed one after another, by a beam search over all places on the whole.

Relaxation keeps one opinion, the one that most descriptors hold; on smooth shapes that is a blend of several placings,
each of them consistent in itself. Here many placings stay alive side by side and are compared as wholes: each further
sample is tried at every place for every one of them, and the best that differ are kept. Few samples are enough to tell
a placing from others when they are spread far, and far from the boundary, where distances are the whole's own.
"""

from __future__ import annotations

import numpy as np

from kfmaps.matching.partial.relaxation_labeling import SLACK, Assignment, DistanceBounds, consistency

ANCHORS = 16
"""Samples that are placed."""
LABELS = 400
"""Places that each may have: the first samples of the whole."""
WIDTH = 100
"""Placings that stay alive."""
LOOKED = 20
"""For each of these so many are looked at before those that hardly differ are left out."""
APART = 0.12
"""Distance between two places of some anchor, in √area of the whole, from which placings differ."""
MOST = 12
"""Placings that are handed on."""


def select_anchors(part: DistanceBounds, edge: np.ndarray, count: int, marks: int = 0) -> np.ndarray:
    """``count`` samples, far from each other and from the boundary, ``edge (q,)`` away, in the unit of ``part``.

    The first ``marks`` samples come first. Farthest points, by the smaller of the distance to those chosen and twice
    that to the boundary.
    """
    far = np.where(np.isfinite(part.far), part.far, 0.0)
    inner = 2.0 * np.minimum(edge, far.max(initial=0.0))
    chosen = list(range(min(marks, count))) or [int(inner.argmax())]
    nearest = far[chosen].min(axis=0)
    while len(chosen) < min(count, len(edge)):
        value = np.minimum(nearest, inner)
        value[chosen] = -1.0
        chosen.append(int(value.argmax()))
        nearest = np.minimum(nearest, far[chosen[-1]])
    return np.array(chosen, dtype=np.int64)


def beam_search(
    part: DistanceBounds, edge: np.ndarray, whole: np.ndarray, alike: np.ndarray, marks: int = 0
) -> list[Assignment]:
    """Distinct placings of a few samples, best first; only these have trust, and ``support`` is what they score.

    Parameters
    ----------
    part : Gauge
    edge : (q,) float
        Distances of the part's samples from its boundary, in the unit of the whole.
    whole : (m, m) float
        Distances there.
    alike : (q, m) float
        Products of descriptors; rows of the first ``marks`` samples have one entry above all others.
    """
    anchors = select_anchors(part, edge, ANCHORS, marks)
    m = min(LABELS, alike.shape[1])
    there = whole[:m, :m]
    unlike = alike[anchors, :m]
    unlike = (unlike - unlike.max(axis=1, keepdims=True)).astype(np.float32)
    states = np.arange(m)[:, None]
    pairs, single = np.zeros(m, dtype=np.float32), unlike[0]
    for t in range(1, len(anchors)):
        now = anchors[t]
        fits = np.zeros((len(states), m), dtype=np.float32)
        for s, earlier in enumerate(anchors[:t]):
            fits += consistency(part.far[earlier, now], part.low[earlier, now], there[states[:, s]], SLACK)
        # What a sample adds is of the same weight in both: its mean consistency with the others, and its descriptor.
        total = (pairs[:, None] + fits) * np.float32(2 / t) + single[:, None] + unlike[t]
        best = _most(total, LOOKED * WIDTH)
        row, label = np.divmod(best, m)
        grown = np.concatenate([states[row], label[:, None]], axis=1)
        kept = differing(grown, there, WIDTH)
        row, label = row[kept], label[kept]
        states, pairs, single = grown[kept], pairs[row] + fits[row, label], single[row] + unlike[t, label]
    score = (2 * pairs / max(len(anchors) - 1, 1) + single) / len(anchors)
    order = np.argsort(-score, kind="stable")
    states, score = states[order], score[order]
    return [_placed(anchors, states[i], float(score[i]), len(alike)) for i in differing(states, there, MOST, True)]


def differing(states: np.ndarray, whole: np.ndarray, most: int, mostly: bool = False) -> np.ndarray:
    """Rows of ``states (b, t)``, places in the order of how good they are, that differ from all better ones.

    In at least one place by :data:`MIN_REST_DISTANCE`, or where ``mostly`` in half of them.
    """
    kept: list[int] = []
    left = np.arange(len(states))
    while len(kept) < most and len(left):
        kept.append(int(left[0]))
        off = whole[states[left[0]], states[left[1:]]]
        left = left[1:][(np.median(off, axis=1) if mostly else off.max(axis=1)) > APART]
    return np.array(kept, dtype=np.int64)


def _most(values: np.ndarray, count: int) -> np.ndarray:
    """Where the largest of ``values`` are, largest first, the earliest of equal ones."""
    flat = values.ravel()
    if len(flat) > count:
        least = np.partition(flat, len(flat) - count)[len(flat) - count]
        some = np.flatnonzero(flat >= least)
    else:
        some = np.arange(len(flat))
    return some[np.argsort(-flat[some], kind="stable")][:count]


def _placed(anchors: np.ndarray, places: np.ndarray, score: float, count: int) -> Assignment:
    match, trust = np.zeros(count, dtype=np.int64), np.zeros(count)
    match[anchors], trust[anchors] = places, 1.0
    return Assignment(match, trust, score)
