"""The error at every vertex, as pictures and pages show it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import KDTree

from kfmaps.fmap.evaluate import geodesic_errors, truth_from_pairs
from kfmaps.geometry.mesh import Mesh


def vertex_errors(source: Mesh, maps: Sequence[np.ndarray], truth_s: np.ndarray, truth_t: np.ndarray) -> np.ndarray:
    """Return the geodesic error of each map at each target vertex, (m, n_t), in √area.

    NaN where the truth is not known, or a vertex has no counterpart. ``truth_s (q,)`` and ``truth_t (q,)`` are
    corresponding vertices. Of several truths for one target vertex the last counts.
    """
    rows = np.full((len(maps), len(maps[0])), np.nan)
    # All at once, so that one search from a true vertex serves every map.
    predicted = np.concatenate([truth_from_pairs(truth_s, truth_t, points) for points in maps])
    known = predicted >= 0
    errors = np.full(len(predicted), np.nan)
    errors[known] = geodesic_errors(source, predicted[known], np.tile(truth_s, len(maps))[known])
    rows[:, truth_t] = errors.reshape(len(maps), -1)
    return rows


def painted_errors(
    source: Mesh, target: Mesh, target_to_source: np.ndarray, truth_s: np.ndarray, truth_t: np.ndarray
) -> np.ndarray:
    """Return the geodesic error at each target vertex, (n_t,), in √area of the source, without gaps.

    A vertex whose truth is not known, or that has no counterpart (−1), takes the error of the nearest one that has
    both: right for a picture, not for a mean. On another component the error is the largest of all, and at least 1.
    The arguments are those of :func:`vertex_errors` for the one map ``target_to_source (n_t,)``.
    """
    errors = vertex_errors(source, [np.asarray(target_to_source)], truth_s, truth_t)[0]
    known, unknown = np.flatnonzero(~np.isnan(errors)), np.flatnonzero(np.isnan(errors))
    if len(known) == 0:
        return np.zeros(len(errors))
    endless = np.isinf(errors)
    errors[endless] = max(errors[np.isfinite(errors)].max(initial=0.0), 1.0)
    errors[unknown] = errors[known[KDTree(target.vertices[known]).query(target.vertices[unknown])[1]]]
    return errors
