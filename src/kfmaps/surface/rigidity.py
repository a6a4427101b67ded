"""As-rigid-as-possible energy of a mesh that is bent (Sorkine and Alexa 2007).

With ``x̄`` the rest positions, ``x`` the bent ones, ``w`` cotangent weights and one rotation ``R_i`` a vertex,
``E(x, R) = ½ Σ_i Σ_j w_ij |(x_i − x_j) − R_i (x̄_i − x̄_j)|²``. For fixed rotations it is quadratic in ``x`` with the
Laplacian as its matrix; for fixed ``x`` each best rotation is a polar decomposition. It has no unit: a mesh of any size
that is bent alike has the same energy.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from kfmaps.surface.mesh import Mesh

LEAST = 0.05
"""Weight that every edge has at least: obtuse triangles make negative ones, with which the energy has no bottom."""
SHARPEST = 20.0
"""Cotangent of the sharpest corner that counts, so that no sliver outweighs all else."""


@dataclass(frozen=True, eq=False)
class Rigidity:
    """What the energy needs of the rest shape; made by :func:`rigidity`.

    Attributes
    ----------
    laplacian : (n, n) sparse
        Positive semi-definite, of the weights.
    moments : (3 n, n) sparse
        ``(moments @ x)`` stacks, for each axis ``a`` of the rest shape, ``Σ_j w_ij (x̄_i − x̄_j)_a (x_i − x_j)``.
    rest : (n, 3) float64
    """

    laplacian: Any
    moments: Any
    rest: np.ndarray


def rigidity(mesh: Mesh) -> Rigidity:
    """The energy of bending ``mesh``; the constants do not depend on its unit."""
    v, f = mesh.vertices, mesh.faces
    n = len(v)
    tails, heads, values = [], [], []
    for i in range(3):
        a, b, c = f[:, i], f[:, (i + 1) % 3], f[:, (i + 2) % 3]
        u, w = v[b] - v[a], v[c] - v[a]
        area = np.linalg.norm(np.cross(u, w), axis=1)
        dot = np.einsum("ij,ij->i", u, w)
        cot = np.divide(dot, area, out=np.zeros_like(dot), where=area > 0)
        tails, heads = [*tails, b], [*heads, c]
        values.append(0.5 * np.clip(cot, -1.0, SHARPEST))
    half: Any = coo_array((np.concatenate(values), (np.concatenate(tails), np.concatenate(heads))), shape=(n, n))
    weights: Any = csr_array(half + half.T)
    weights.data = np.maximum(weights.data, LEAST)
    weights.setdiag(0)
    weights.eliminate_zeros()
    edges = weights.tocoo()
    i, j, w = edges.row, edges.col, edges.data
    moved = w[:, None] * (v[i] - v[j])
    rows = np.concatenate([a * n + i for a in range(3)] * 2)
    columns = np.concatenate([i, i, i, j, j, j])
    entries = np.concatenate([moved.T.ravel(), -moved.T.ravel()])
    moments = csr_array((entries, (rows, columns)), shape=(3 * n, n))
    return Rigidity((diags_array(weights.sum(axis=1)) - weights).tocsr(), moments, v)


def rotations(energy: Rigidity, x: np.ndarray) -> np.ndarray:
    """The best rotation of each vertex, ``(n, 3, 3)``: ``R_i x̄`` is the rest shape turned as ``x (n, 3)`` is."""
    n = len(x)
    return nearest_rotations((energy.moments @ x).reshape(3, n, 3).transpose(1, 2, 0))


def nearest_rotations(matrices: np.ndarray) -> np.ndarray:
    """The rotation closest to each of ``matrices (n, 3, 3)``; never a reflection."""
    u, _, vh = np.linalg.svd(matrices)
    u[:, :, 2] *= np.where(np.linalg.det(u) * np.linalg.det(vh) < 0, -1.0, 1.0)[:, None]
    return u @ vh


def pull(energy: Rigidity, turns: np.ndarray) -> np.ndarray:
    """``b (n, 3)`` such that ``laplacian @ x = b`` at the least energy for the rotations ``turns (n, 3, 3)``."""
    n = len(turns)
    return 0.5 * (energy.moments.T @ turns.transpose(2, 0, 1).reshape(3 * n, 3))


def bending(energy: Rigidity, x: np.ndarray, turns: np.ndarray | None = None) -> float:
    """The energy of ``x (n, 3)``, at least 0; with the best rotations unless ``turns`` are given."""
    turns = rotations(energy, x) if turns is None else turns
    sizes = np.sum(x * (energy.laplacian @ x)) + np.sum(energy.rest * (energy.laplacian @ energy.rest))
    return max(float(sizes - 2 * np.sum(x * pull(energy, turns))), 0.0)
