"""Local scaling of the rest shape during a registration, for bodies of different proportions.

As-rigid-as-possible energies penalise every change of size. So between a cat and a dog, or a woman and a gorilla, the
energy is not least at the true correspondence: longer or thicker limbs slide. Registrations with affine transformations
(Amberg et al., Optimal step nonrigid ICP algorithms for surface registration, 2007) or similarities (Yoshiyasu et al.,
As-conformal-as-possible surface registration, 2014) let each vertex change size, as its neighbours do.
Here each vertex keeps its rotation, and its rest shape is stretched by the average stretch of its surroundings. A limb
may become longer or thicker as a whole at no cost, but not on one side.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kfmaps.geometry.arap import ArapEnergy, edge_covariances, spread_matrices

_DAMPING = 0.05  # damping towards isotropic scaling, since flat surroundings do not determine the third direction
_MIN_FACTOR, _MAX_FACTOR = 0.4, 2.5  # the smallest and largest factor


def local_scaling(energy: ArapEnergy, areas: np.ndarray, area: float) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Return a function from deformed positions ``x (n, 3)`` and rotations ``R (n, 3, 3)`` to transforms ``R_i S_i``.

    The stretch ``S_i`` is symmetric, with eigenvalues from 0.4 to 2.5. In the sense of least squares it takes the rest
    shape of the surroundings to their deformed shape, each vertex rotated back.

    ``areas (n,)``: of the vertices; ``area``: about that of the surroundings; with 0 the function returns ``R``.
    """
    if area == 0:
        return lambda _x, R: R
    average = spread_matrices(energy, areas, area)
    rest = average(edge_covariances(energy, energy.rest))
    size = np.maximum(np.trace(rest, axis1=1, axis2=2), 1e-300)
    inverse = np.linalg.inv(rest + (_DAMPING * size)[:, None, None] * np.eye(3))

    def transforms(x: np.ndarray, R: np.ndarray) -> np.ndarray:
        covariances = average(R.transpose(0, 2, 1) @ edge_covariances(energy, x))
        scale = np.clip(np.trace(covariances, axis1=1, axis2=2) / size, _MIN_FACTOR, _MAX_FACTOR)
        stretch = (covariances + (_DAMPING * size * scale)[:, None, None] * np.eye(3)) @ inverse
        return R @ _clip_eigenvalues(0.5 * (stretch + stretch.transpose(0, 2, 1)), _MIN_FACTOR, _MAX_FACTOR)

    return transforms


def _clip_eigenvalues(matrices: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return symmetric matrices (n, 3, 3) with their eigenvalues clipped to two bounds."""
    mean = np.trace(matrices, axis1=1, axis2=2) / 3
    # No eigenvalue is farther than this from their mean, so that most matrices need no eigendecomposition.
    radius = np.sqrt(np.maximum(np.einsum("nij,nij->n", matrices, matrices) - 3 * mean**2, 0.0) * (2 / 3))
    rows = np.flatnonzero((mean - radius < low) | (mean + radius > high))
    values, axes = np.linalg.eigh(matrices[rows])
    result = matrices.copy()
    result[rows] = axes * np.clip(values, low, high)[:, None, :] @ axes.transpose(0, 2, 1)
    return result
