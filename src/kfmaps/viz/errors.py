"""What the truth tells a picture: the error at every vertex, and where to look from."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps.fmap.evaluate import geodesic_errors, truth_from_pairs
from kfmaps.geometry.mesh import Mesh
from kfmaps.viz.camera import View, automatic_view, carried_view


def painted_errors(
    source: Mesh,
    target: Mesh,
    target_to_source: np.ndarray,
    truth_s: np.ndarray,
    truth_t: np.ndarray,
) -> np.ndarray:
    """Geodesic error at each target vertex, (n_t,), in units of √area of the source.

    A vertex whose truth is not known takes the error of the nearest one whose truth is: right for a picture,
    not for a mean.

    Parameters
    ----------
    source, target : Mesh
    target_to_source : (n_t,) int64
        Vertices without a counterpart, −1, take the error of the nearest one too: they are to be painted over.
    truth_s, truth_t : (q,) int64
        Corresponding vertices, at least one. Of several truths for one target vertex the last counts.
    """
    errors = np.full(len(target.vertices), np.nan)
    known = np.asarray(target_to_source)[truth_t] >= 0
    if not known.any():
        return np.zeros(len(target.vertices))
    truth_s, truth_t = truth_s[known], truth_t[known]
    errors[truth_t] = geodesic_errors(source, truth_from_pairs(truth_s, truth_t, target_to_source), truth_s)
    endless = np.isinf(errors)  # on another component
    errors[endless] = max(errors[np.isfinite(errors)].max(initial=0.0), 1.0)
    known, unknown = np.flatnonzero(~np.isnan(errors)), np.flatnonzero(np.isnan(errors))
    errors[unknown] = errors[known[KDTree(target.vertices[known]).query(target.vertices[unknown])[1]]]
    return errors


def true_views(
    source: Mesh, target: Mesh, truth_s: np.ndarray, truth_t: np.ndarray, source_view: View | None = None
) -> tuple[View, View]:
    """Views of source and target from the same side by the truth, however wrong a map may be.

    A map with left and right swapped would have the camera go round to the back, where it looks right.
    """
    source_view = source_view or automatic_view(source)
    return source_view, carried_view(source_view, source.vertices[truth_s], target.vertices[truth_t])
