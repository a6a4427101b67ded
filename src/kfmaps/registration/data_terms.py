"""Quadratic energies that pull a mesh to places while it is bent, and steps down their sum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from kfmaps.geometry.arap import ArapEnergy, arap_rhs

_ALONG = 0.03
"""Weight of squared distances along the surface, against 1 along its normal."""


@dataclass(frozen=True, eq=False)
class DataTerm:
    """``Σ_q weights_q ‖P_q((rows x)_q − places_q)‖²``, ``P`` shortened to 0.03 across ``normals``.

    ``rows`` is sparse ``(q, n_s)``, ``None`` for the vertices themselves; without normals ``P`` is the identity.
    """

    weights: np.ndarray
    places: np.ndarray
    rows: Any = None
    normals: np.ndarray | None = None

    def at(self, x: np.ndarray) -> np.ndarray:
        """Return the matrix of the term times ``x (n_s, 3)``."""
        inside = self._shortened(x if self.rows is None else self.rows @ x)
        return inside if self.rows is None else self.rows.T @ inside

    def right(self) -> np.ndarray:
        """Return the right-hand side, (n_s, 3)."""
        inside = self._shortened(self.places)
        return inside if self.rows is None else self.rows.T @ inside

    def _shortened(self, z: np.ndarray) -> np.ndarray:
        if self.normals is None:
            return self.weights[:, None] * z
        along = np.einsum("qi,qi->q", self.normals, z)
        return self.weights[:, None] * (_ALONG * z + ((1 - _ALONG) * along)[:, None] * self.normals)


def descend(
    energy: ArapEnergy,
    stiffness: float,
    solve: Callable[[np.ndarray], np.ndarray],
    terms: list[DataTerm],
    x: np.ndarray,
    turns: np.ndarray,
    steps: int = 3,
) -> np.ndarray:
    """Return ``x`` after a few steps of conjugate gradients on the quadratic energy for fixed rotations and terms.

    Every step lowers that energy, so that none needs to be exact.

    Parameters
    ----------
    energy : ArapEnergy
    stiffness : float
        Its weight, in units of area.
    solve : callable
        The preconditioner.
    terms : list of DataTerm
    x : (n, 3) float64
    turns : (n, 3, 3) float64
        Matrices that turn the rest shape of each vertex's surroundings.
    steps : int
    """

    def apply(z: np.ndarray) -> np.ndarray:
        return stiffness * (energy.laplacian @ z) + sum(term.at(z) for term in terms)

    residual = stiffness * arap_rhs(energy, turns) + sum(term.right() for term in terms) - apply(x)
    direction = towards = solve(residual)
    size = float(np.sum(residual * towards))
    for step in range(steps):
        if not size > 0:
            break
        image = apply(direction)
        length = size / float(np.sum(direction * image))
        x = x + length * direction
        if step == steps - 1:
            break
        residual = residual - length * image
        towards = solve(residual)
        before, size = size, float(np.sum(residual * towards))
        direction = towards + size / before * direction
    return x
