"""Tell left from right specimens: signs of the shapes that agree with which maps keep orientation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import check, refuse
from kfmaps.geometry.connectivity import component_labels


def chirality(count: int, ends: Sequence[tuple[int, int]], kept: Sequence[bool], weights: ArrayLike) -> np.ndarray:
    """Return 1 or -1 for each shape, such that pairs of equal sign keep orientation and others reverse it: (n,) int64.

    As much of the ``weights`` as can be is to agree: the leading eigenvector of the signed graph gives signs
    (synchronisation over the group of two; Singer 2011), and a shape changes its own as long as that gains.

    ``count``: number of shapes; ``ends``, ``kept`` and ``weights``: of each pair its shapes, whether its map keeps
    orientation, and how sure that is, not negative. Returns (n,): where pairs join shapes, the one with the lowest
    number has 1.
    """
    if len(ends) != len(kept):
        raise refuse("pairs", "an orientation for each pair", f"{len(kept)} for {len(ends)} pairs", "give as many")
    weight = check(np.asarray(weights, dtype=np.float64), "weights", shape=(len(ends),), finite=True)
    if len(weight) and weight.min() < 0:
        raise refuse("weights", "numbers from 0 on", f"{weight.min():g}", "give probabilities")
    signed = np.zeros((count, count))
    for (a, b), same, w in zip(ends, kept, weight, strict=True):
        signed[a, b] += w if same else -w
        signed[b, a] += w if same else -w
    part = component_labels(count, *np.nonzero(signed))[1]
    signs, first = np.ones(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    for own in (np.flatnonzero(part == number) for number in np.unique(part)):
        leading = np.linalg.eigh(signed[np.ix_(own, own)])[1][:, -1]
        signs[own], first[own] = np.where(leading < -1e-12, -1, 1), own[0]
    for _ in range(100):  # signs that are changed at most
        gain = -signs * (signed @ signs)
        worst = int(gain.argmax()) if count else 0
        if count == 0 or gain[worst] <= 1e-9 * (1.0 + np.abs(signed).max()):
            break
        signs[worst] *= -1
    return signs * signs[first]
