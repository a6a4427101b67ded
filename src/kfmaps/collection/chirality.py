"""Tell left from right specimens: signs of the shapes that agree with which maps keep orientation."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import check, refuse
from kfmaps.geometry.connectivity import component_labels

MAX_FLIPS = 100


def chirality(count: int, ends: Sequence[tuple[int, int]], kept: Sequence[bool], weights: ArrayLike) -> np.ndarray:
    """Return 1 or -1 for each shape, such that pairs of equal sign keep orientation and others reverse it: (n,) int64.

    As much of the ``weights`` as can be is to agree: the leading eigenvector of the signed graph gives signs
    (synchronisation over the group of two; Singer 2011), and a shape changes its own as long as that gains.

    Parameters
    ----------
    count : int
        Number of shapes.
    ends, kept, weights : sequences
        Of each pair its shapes, whether its map keeps orientation, and how sure that is, not negative.

    Returns
    -------
    (n,) int64
        Where pairs join shapes, the one with the lowest number has 1.
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
    leading = np.linalg.eigh(signed + 1e-9 * np.eye(count))[1][:, -1] if count else np.zeros(0)
    signs = np.where(leading < -1e-12, -1, 1).astype(np.int64)
    # An eigenvector may live on one of several parts: each shape then asks its neighbours, from the surest on.
    signs = _along(signed, signs, np.abs(leading) > 1e-6)
    for _ in range(MAX_FLIPS):
        gain = -signs * (signed @ signs)
        worst = int(gain.argmax()) if count else 0
        if count == 0 or gain[worst] <= 1e-9 * (1.0 + np.abs(signed).max()):
            break
        signs[worst] *= -1
    return _anchored(signed, signs)


def _along(signed: np.ndarray, signs: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Signs of the shapes that are not ``known (n,)``, from those of their neighbours with the largest weight."""
    signs, known = signs.copy(), known.copy()
    while not known.all():
        reach = np.where(known[None, :] & ~known[:, None], np.abs(signed), 0.0)
        a, b = np.unravel_index(int(reach.argmax()), reach.shape)
        if reach[a, b] == 0:
            a = int(np.flatnonzero(~known)[0])
        else:
            signs[a] = int(np.sign(signed[a, b])) * signs[b]
        known[a] = True
    return signs


def _anchored(signed: np.ndarray, signs: np.ndarray) -> np.ndarray:
    """The lowest shape of each component has 1."""
    a, b = np.nonzero(signed)
    part = component_labels(len(signs), a, b)[1]
    first = np.unique(part, return_index=True)[1]
    return signs * signs[first[part]]
