"""As-rigid-as-possible energy of a deformed mesh (Sorkine and Alexa 2007).

With rest positions ``x̄``, deformed positions ``x``, cotangent weights ``w`` and a rotation ``R_i`` for each vertex,
``E(x, R) = ½ Σ_i Σ_j w_ij |(x_i − x_j) − R_i (x̄_i − x̄_j)|²``. For fixed rotations it is quadratic in ``x`` with the
Laplacian as its matrix. For fixed ``x`` each best rotation is a polar factor. The energy scales with the squared unit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from kfmaps.geometry.eigen.factorization import ShiftedFactorizer, SparseMatrix
from kfmaps.geometry.mesh import Mesh


@dataclass(frozen=True, eq=False)
class ArapEnergy:
    """Operators of a rest shape; made by :func:`build_arap`."""

    laplacian: SparseMatrix  # (n, n): of the weights, positive semi-definite
    moments: SparseMatrix  # (3 n, n): ``moments @ x`` stacks ``Σ_j w_ij (x̄_i − x̄_j)_a (x_i − x_j)`` of each axis ``a``
    rest: np.ndarray  # (n, 3): ``x̄``

    @cached_property
    def factorize(self) -> ShiftedFactorizer:
        """The factorisation of multiples of the Laplacian plus diagonals."""
        return ShiftedFactorizer(self.laplacian)

    @cached_property
    def adjoint_moments(self) -> SparseMatrix:
        """The transposed moments, (n, 3 n)."""
        return self.moments.T


def build_arap(mesh: Mesh) -> ArapEnergy:
    """Return the as-rigid-as-possible energy with ``mesh`` as the rest shape, in any unit."""
    v, f = mesh.vertices, mesh.faces
    n = len(v)
    tails, heads, values = [], [], []
    for i in range(3):
        a, b, c = f[:, i], f[:, (i + 1) % 3], f[:, (i + 2) % 3]
        u, w = v[b] - v[a], v[c] - v[a]
        area = np.linalg.norm(np.cross(u, w), axis=1)
        dot = np.einsum("ij,ij->i", u, w)
        cot = np.divide(dot, area, out=np.full_like(dot, 0.1), where=area > 0)  # faces without area hold together, too
        tails, heads = [*tails, b], [*heads, c]
        values.append(0.5 * np.clip(cot, -1.0, 20.0))  # so that slivers do not outweigh other faces
    half_edges = np.concatenate(tails), np.concatenate(heads)
    half: SparseMatrix = coo_array((np.concatenate(values), half_edges), shape=(n, n))
    weights: SparseMatrix = csr_array(half + half.T)
    # With the negative weights of obtuse triangles the energy would be unbounded below.
    weights.data = np.maximum(weights.data, 0.05)
    weights.setdiag(0)
    weights.eliminate_zeros()
    edges = weights.tocoo()
    i, j, w = edges.row, edges.col, edges.data
    weighted = (w[:, None] * (v[i] - v[j])).T.ravel()
    rows = np.concatenate([a * n + i for a in range(3)] * 2)
    columns = np.concatenate([i, i, i, j, j, j])
    entries = np.concatenate([weighted, -weighted])
    moments = csr_array((entries, (rows, columns)), shape=(3 * n, n))
    return ArapEnergy((diags_array(weights.sum(axis=1)) - weights).tocsr(), moments, v)


def rotations(energy: ArapEnergy, x: np.ndarray) -> np.ndarray:
    """Return the best rotations ``R (n, 3, 3)`` for deformed positions ``x (n, 3)``."""
    return nearest_rotations(edge_covariances(energy, x))


def edge_covariances(energy: ArapEnergy, x: np.ndarray) -> np.ndarray:
    """Return ``Σ_j w_ij (x_i − x_j)(x̄_i − x̄_j)ᵀ`` of each vertex, (n, 3, 3), for positions ``x (n, 3)``."""
    return (energy.moments @ x).reshape(3, len(x), 3).transpose(1, 2, 0)


def spread_matrices(energy: ArapEnergy, areas: np.ndarray, area: float) -> Callable[[np.ndarray], np.ndarray]:
    """Return a function that averages matrices (n, 3, 3), integrated at vertices, over about ``area``.

    It is one implicit step of heat flow, with the ``areas (n,)`` of the vertices.
    """
    n = len(areas)
    diffuse = energy.factorize(area, areas)
    return lambda matrices: np.asarray(diffuse(np.ascontiguousarray(matrices.reshape(n, 9)))).reshape(n, 3, 3)


def nearest_rotations(matrices: np.ndarray) -> np.ndarray:
    """Return the rotation closest to each of ``matrices (n, 3, 3)``, never a reflection: (n, 3, 3).

    The closed form takes a tenth of the time of singular value decompositions, which remain for the few matrices whose
    rotation is nearly undetermined.

    Markley, Attitude determination using vector observations: a fast optimal matrix algorithm (1993).
    """
    # Stored entry by entry, (3, 3, n).
    m = np.moveaxis(matrices, 0, 2).copy()
    size = np.sqrt(np.einsum("ijn,ijn->n", m, m))
    m /= np.where(size > 0, size, 1.0)
    cofactors = np.empty_like(m)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            np.multiply(m[j, b], m[k, c], out=cofactors[i, a])
            cofactors[i, a] -= m[j, c] * m[k, b]
    det = m[0, 0] * cofactors[0, 0] + m[0, 1] * cofactors[0, 1] + m[0, 2] * cofactors[0, 2]
    squares = 1.0 - 4.0 * np.einsum("ijn,ijn->n", cofactors, cofactors)
    # The sum of the singular values, the last with the sign of the determinant, is the largest root of a quartic.
    # Newton steps approach it from above.
    root = np.full(len(det), np.sqrt(3.0))
    for _ in range(12):  # enough for every matrix whose rotation is determined
        slope = 4.0 * (root * (root * root - 1.0) - 2.0 * det)
        value = ((root * root - 2.0) * root - 8.0 * det) * root + squares
        root = root - np.divide(value, slope, out=np.zeros_like(root), where=slope > 0)
    half = 0.5 * (root * root - 1.0)
    denominator = half * root - det
    # Rounding errors grow with its inverse square. A rotation has 1.5, a round matrix of rank two 0.7.
    is_determined = denominator > 0.02
    inverse = np.divide(1.0, denominator, out=np.zeros_like(denominator), where=is_determined)
    rotation = ((half + 1.0) * m + root * cofactors - _times(m, _times(m.transpose(1, 0, 2), m))) * inverse
    # One step of an iteration for the nearest orthogonal matrix, ``R (3 I − RᵀR) / 2``, corrects rounding errors.
    correction = -0.5 * _times(rotation.transpose(1, 0, 2), rotation)
    for i in range(3):
        correction[i, i] += 1.5
    result = np.ascontiguousarray(np.moveaxis(_times(rotation, correction), 2, 0))
    rest = np.flatnonzero(~is_determined)
    if len(rest):
        u, _, vh = np.linalg.svd(matrices[rest])
        u[:, :, 2] *= np.where(np.linalg.det(u) * np.linalg.det(vh) < 0, -1.0, 1.0)[:, None]
        result[rest] = u @ vh
    return result


def _times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the products of matrices (3, 3, n), stored entry by entry."""
    out = np.empty_like(b)
    for i in range(3):
        for j in range(3):
            np.multiply(a[i, 0], b[0, j], out=out[i, j])
            out[i, j] += a[i, 1] * b[1, j]
            out[i, j] += a[i, 2] * b[2, j]
    return out


def arap_rhs(energy: ArapEnergy, R: np.ndarray) -> np.ndarray:
    """Return ``b (n, 3)`` such that the energy for rotations ``R (n, 3, 3)`` is least where ``laplacian @ x = b``."""
    n = len(R)
    return 0.5 * (energy.adjoint_moments @ R.transpose(2, 0, 1).reshape(3 * n, 3))


def arap_energy(energy: ArapEnergy, x: np.ndarray, R: np.ndarray | None = None) -> float:
    """Return the energy, at least 0, of positions ``x (n, 3)`` with rotations ``R (n, 3, 3)``, by default the best."""
    R = rotations(energy, x) if R is None else R
    squares = np.sum(x * (energy.laplacian @ x)) + np.sum(energy.rest * (energy.laplacian @ energy.rest))
    return max(float(squares - 2 * np.sum(x * arap_rhs(energy, R))), 0.0)


def arap_energy_per_vertex(energy: ArapEnergy, x: np.ndarray) -> np.ndarray:
    """Return the summands ``Σ_j w_ij |…|²`` of each vertex, (n,), in positions ``x (n, 3)`` with the best rotations."""
    edges = energy.laplacian.tocoo()
    off_diagonal = edges.row != edges.col
    i, j, w = edges.row[off_diagonal], edges.col[off_diagonal], -edges.data[off_diagonal]
    rotated = np.einsum("eab,eb->ea", rotations(energy, x)[i], energy.rest[i] - energy.rest[j])
    return np.bincount(i, w * ((x[i] - x[j] - rotated) ** 2).sum(axis=1), minlength=len(x))
