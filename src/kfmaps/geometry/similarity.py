"""The similarity transform that brings corresponding points nearest to each other."""

from __future__ import annotations

import numpy as np


def similarity(
    points: np.ndarray, onto: np.ndarray, reflect: bool = False, weights: np.ndarray | None = None
) -> tuple[np.ndarray, float, np.ndarray]:
    """Return the rotation (3, 3), scale and shift (3,) that bring ``points (l, 3)`` nearest to ``onto`` (Umeyama 1991).

    The points become ``scale * points @ rotation + shift``. With ``reflect`` reflections are allowed as well.
    ``weights (l,)``, not negative, say how much each point counts.
    """
    middle, there = (np.average(x, axis=0, weights=weights) for x in (points, onto))
    a, b = points - middle, onto - there
    share = np.ones(len(a)) if weights is None else weights
    left, values, right = np.linalg.svd(a.T @ (share[:, None] * b))
    sign = np.ones(3)
    if not reflect and np.linalg.det(left @ right) < 0:
        sign[2] = -1
    turn = (left * sign) @ right
    scale = float((values * sign).sum() / max(float((share[:, None] * a**2).sum()), 1e-300))
    return turn, scale, there - scale * middle @ turn
