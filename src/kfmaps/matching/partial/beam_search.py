"""Place a few samples of the part, far from each other, one after another by a beam search over all places.

Relaxation returns one placement. On smooth shapes that is often a blend of several ones, each consistent in itself. A
beam search keeps many placements and compares them as a whole: each further sample is tried at every place in each of
them, and the best distinct ones are kept. Few samples suffice when they are far from each other and from the boundary,
where distances on the part are those of the whole.
"""

from __future__ import annotations

import numpy as np

from kfmaps.matching.partial.relaxation_labeling import Assignment, DistanceBounds, consistency

_ANCHORS = 16  # samples that are placed
_MIN_DISTANCE = 0.12  # distance between two places of some anchor, in √area of the whole, from which placements differ


def _select_anchors(bounds: DistanceBounds, boundary_distance: np.ndarray, count: int, first: int = 0) -> np.ndarray:
    """Return samples far from each other and from the boundary, (count,) int64.

    They are farthest points by the smaller of the distance to those chosen and twice the distance to the boundary.

    ``boundary_distance (q,)``: in the unit of ``bounds``; ``first``: number of landmarks, which are chosen first.
    """
    upper = np.where(np.isfinite(bounds.upper), bounds.upper, 0.0)
    inner = 2.0 * np.minimum(boundary_distance, upper.max(initial=0.0))
    chosen = list(range(min(first, count))) or [int(inner.argmax())]
    nearest = upper[chosen].min(axis=0)
    while len(chosen) < min(count, len(boundary_distance)):
        value = np.minimum(nearest, inner)
        value[chosen] = -1.0
        chosen.append(int(value.argmax()))
        nearest = np.minimum(nearest, upper[chosen[-1]])
    return np.array(chosen, dtype=np.int64)


def beam_search(
    bounds: DistanceBounds,
    boundary_distance: np.ndarray,
    distances: np.ndarray,
    similarity: np.ndarray,
    n_landmarks: int = 0,
) -> list[Assignment]:
    """Return distinct placements of a few samples, best first; only these samples have trust.

    ``boundary_distance (q,)``: of the part's samples, in the unit of the whole; ``distances (m, m)``: between the
    whole's samples; ``similarity (q, m)``: products of descriptors, in which each of the first ``n_landmarks`` rows has
    one entry above all others.
    """
    anchors = _select_anchors(bounds, boundary_distance, _ANCHORS, n_landmarks)
    n_places = 400  # first samples of the whole, which are the places
    m = min(n_places, similarity.shape[1])
    distances = distances[:m, :m]
    score = similarity[anchors, :m]
    score = (score - score.max(axis=1, keepdims=True)).astype(np.float32)
    states = np.arange(m)[:, None]
    pairs, single = np.zeros(m, dtype=np.float32), score[0]
    width = 100  # placements that are kept in each step
    for t in range(1, len(anchors)):
        fits = np.zeros((len(states), m), dtype=np.float32)
        for s, earlier in enumerate(anchors[:t]):
            pair = earlier, anchors[t]
            fits += consistency(bounds.upper[pair], bounds.lower[pair], distances[states[:, s]])
        # Mean consistency of the samples with each other, and their descriptors, with equal weights.
        total = (pairs[:, None] + fits) * np.float32(2 / t) + single[:, None] + score[t]
        row, label = np.divmod(_largest(total, 20 * width), m)
        grown = np.concatenate([states[row], label[:, None]], axis=1)
        kept = _select_different(grown, distances, width)
        row, label = row[kept], label[kept]
        states, pairs, single = grown[kept], pairs[row] + fits[row, label], single[row] + score[t, label]
    final = (2 * pairs / max(len(anchors) - 1, 1) + single) / len(anchors)
    order = np.argsort(-final, kind="stable")
    states, final = states[order], final[order]
    found = []
    most = 12  # placements that are returned
    for i in _select_different(states, distances, most, half=True):
        match, trust = np.zeros(len(similarity), dtype=np.int64), np.zeros(len(similarity))
        match[anchors], trust[anchors] = states[i], 1.0
        found.append(Assignment(match, trust, float(final[i])))
    return found


def _select_different(states: np.ndarray, distances: np.ndarray, most: int, half: bool = False) -> np.ndarray:
    """Return the rows of ``states (b, t)``, best first, that differ from all better ones by ``_MIN_DISTANCE``.

    They differ in at least one of their places or, with ``half``, in half of them.
    """
    kept: list[int] = []
    left, near, columns = np.ones(len(states), dtype=bool), distances <= _MIN_DISTANCE, np.ascontiguousarray(states.T)
    for i in range(len(states)):
        if len(kept) == most:
            break
        if not left[i]:
            continue
        kept.append(i)
        rows = left.nonzero()[0]
        if half:
            rows = rows[np.median(distances[states[i], states[rows]], axis=1) <= _MIN_DISTANCE]
        else:
            for column in columns[::-1]:  # most differ in the last place already
                rows = rows[near[column[i]].take(column.take(rows))]
                if len(rows) == 0:
                    break
        left[rows] = False
    return np.array(kept, dtype=np.int64)


def _largest(values: np.ndarray, count: int) -> np.ndarray:
    """Return the flat indices of the largest ``values``, largest first, the earliest of equal ones first."""
    flat = values.ravel()
    some = np.arange(len(flat))
    if len(flat) > count:
        some = np.flatnonzero(flat >= np.partition(flat, len(flat) - count)[len(flat) - count])
    return some[np.argsort(-flat[some], kind="stable")][:count]
