"""A rest shape that may be stretched evenly while it is bent: for bodies of other proportions.

As-rigid-as-possible energies punish every change of size, so that between a cat and a dog, or a woman and a gorilla,
the least of them is not where the two correspond: limbs that are longer or thicker slide. Registrations with affine
transformations (Amberg et al., Optimal step nonrigid ICP algorithms for surface registration, 2007) or similarities
(Yoshiyasu et al., As-conformal-as-possible surface registration, 2014) let each vertex change, as long as its
neighbours change alike. Here the rotations stay those of each vertex, and its rest shape is stretched, in its own axes,
by the average of how its surroundings are stretched: a limb may become longer or thicker as a whole at no cost, but not
one side of it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kfmaps.geometry.arap import ArapEnergy, edge_covariances, spread_matrices

_DAMPING = 0.05  # damping towards a change of size alike in all directions: flat surroundings say nothing of the third
_MIN_FACTOR, _MAX_FACTOR = 0.4, 2.5  # the smallest and largest factor


def local_scaling(energy: ArapEnergy, areas: np.ndarray, area: float) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Return a function that puts the stretch of the surroundings into rotations.

    It takes the bent shape ``x (n, 3)`` and the rotations ``(n, 3, 3)`` of its vertices, and returns ``R_i S_i``, with
    ``S_i`` symmetric, from 0.4 to 2.5 in every direction: the linear map that takes the surroundings' rest shape to
    their bent one in the sense of least squares, each vertex turned back by its rotation.

    ``areas (n,)``: of the vertices; ``area``: about that of the surroundings; with 0 the function returns the
    rotations.
    """
    if area == 0:
        return lambda _x, turns: turns
    averaged = spread_matrices(energy, areas, area)
    rest = averaged(edge_covariances(energy, energy.rest))
    size = np.maximum(np.trace(rest, axis1=1, axis2=2), 1e-300)
    inverse = np.linalg.inv(rest + (_DAMPING * size)[:, None, None] * np.eye(3))

    def stretched(x: np.ndarray, turns: np.ndarray) -> np.ndarray:
        moved = averaged(turns.transpose(0, 2, 1) @ edge_covariances(energy, x))
        scale = np.clip(np.trace(moved, axis1=1, axis2=2) / size, _MIN_FACTOR, _MAX_FACTOR)
        found = (moved + (_DAMPING * size * scale)[:, None, None] * np.eye(3)) @ inverse
        return turns @ _clip_eigenvalues(0.5 * (found + found.transpose(0, 2, 1)), _MIN_FACTOR, _MAX_FACTOR)

    return stretched


def _clip_eigenvalues(matrices: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return symmetric matrices (n, 3, 3) with their eigenvalues held between two bounds."""
    middle = np.trace(matrices, axis1=1, axis2=2) / 3
    # The three are within this of their mean: of most matrices none is near a bound.
    reach = np.sqrt(np.maximum(np.einsum("nij,nij->n", matrices, matrices) - 3 * middle**2, 0.0) * (2 / 3))
    beyond = np.flatnonzero((middle - reach < low) | (middle + reach > high))
    values, axes = np.linalg.eigh(matrices[beyond])
    held = matrices.copy()
    held[beyond] = axes * np.clip(values, low, high)[:, None, :] @ axes.transpose(0, 2, 1)
    return held
