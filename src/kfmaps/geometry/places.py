"""Which points lie in one place."""

from __future__ import annotations

import numpy as np


def unique_vertices(vertices: np.ndarray) -> np.ndarray:
    """For each vertex the number of the first one in exactly the same place, (n,) int64.

    Parameters
    ----------
    vertices : (n, 3) float64
        Finite positions.
    """
    places = vertices + 0.0  # makes -0.0 and 0.0 the same
    order = np.lexsort(places.T)
    moved = np.ones(len(places), dtype=bool)
    moved[1:] = (places[order[1:]] != places[order[:-1]]).any(axis=1)
    first = np.empty(len(places), dtype=np.int64)
    # lexsort is stable, so the first of each run has the smallest number
    first[order] = order[moved][np.cumsum(moved) - 1]
    return first
