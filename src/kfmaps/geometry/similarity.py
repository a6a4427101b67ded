"""The similarity transform between corresponding points."""

from __future__ import annotations

import numpy as np


def similarity(
    points: np.ndarray, targets: np.ndarray, reflect: bool = False, weights: np.ndarray | None = None
) -> tuple[np.ndarray, float, np.ndarray]:
    """Return the rotation (3, 3), scale and shift (3,) that take ``points (l, 3)`` nearest to ``targets (l, 3)``.

    The points go to ``scale * points @ rotation + shift`` (Umeyama 1991). With ``reflect`` reflections are allowed.
    ``weights (l,)``: of the points, at least 0.
    """
    mean, target_mean = (np.average(x, axis=0, weights=weights) for x in (points, targets))
    a, b = points - mean, targets - target_mean
    weights = np.ones(len(a)) if weights is None else weights
    left, values, right = np.linalg.svd(a.T @ (weights[:, None] * b))
    sign = np.ones(3)
    if not reflect and np.linalg.det(left @ right) < 0:
        sign[2] = -1
    rotation = (left * sign) @ right
    scale = float((values * sign).sum() / max(float((weights[:, None] * a**2).sum()), 1e-300))
    return rotation, scale, target_mean - scale * mean @ rotation
