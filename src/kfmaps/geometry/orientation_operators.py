"""Orientation operators: antisymmetric matrices of functions, which change sign under a mirror.

Ren, Poulenard, Wonka and Ovsjanikov, "Continuous and orientation-preserving correspondences via functional maps", ACM
Transactions on Graphics 37(6), 2018.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from kfmaps._arrays import Array, check, like, refuse, to_numpy
from kfmaps._threads import parallel
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.mesh import Mesh


def orientation_operators(mesh: Mesh, basis: Basis, functions: Array) -> Array:
    """Return the matrices of the operators ``Ω_w[g] = n · (∇w × ∇g)`` in a basis, one for each function w.

    Entry (i, j) of operator s is ``∫ φᵢ n · (∇wₛ × ∇φⱼ)``, w and φ linear on each face and the integral exact. Vertex
    positions enter through the basis alone, since gradients and area cancel.

    A functional map C that preserves orientation and maps wₛ to w'ₛ has ``C Ω_w = Ω_w' C``; one that reverses it has
    ``C Ω_w = −Ω_w' C``.

    Parameters
    ----------
    mesh : Mesh
        With faces, oriented consistently. Only the faces are used.
    basis : Basis
        Of the mesh, k functions.
    functions : (n, r)
        One function a column, values at the vertices. They are linear in these: for functions with coefficients c
        (k, r) in the basis, when r > k, combine ``orientation_operators(mesh, basis, basis.functions)`` by c.

    Returns
    -------
    (r, k, k)
        Antisymmetric, of the library, dtype and device of ``basis.functions``. In units of w divided by an area.

    Raises
    ------
    InvalidInput
        If the mesh has no faces, or the arrays do not fit it.

    Notes
    -----
    Ω is antisymmetric on a closed surface, by Stokes' theorem. With a boundary the antisymmetric part is returned, ``½
    ∫ φᵢ n · (∇w × ∇φⱼ) − φⱼ n · (∇w × ∇φᵢ)``.
    """
    # Row-major, so that sparse products need no copy.
    phi, w = np.ascontiguousarray(to_numpy(basis.functions)), to_numpy(functions)
    n = len(mesh.vertices)
    if len(mesh.faces) == 0:
        raise refuse("mesh", "faces, which say where outside is", "a point cloud", "triangulate it first")
    check(phi, "basis functions", shape=(n, None), remedy="hand in the basis of this mesh")
    check(w, "functions", shape=(n, None), remedy="give one row per vertex and one column per function")
    edges, weights = _edges(mesh)
    starts = np.searchsorted(edges[:, 0], np.arange(n + 1))
    result = np.empty((w.shape[1], phi.shape[1], phi.shape[1]))

    def fill(s: int) -> None:
        coupled = csr_array((weights @ w[:, s], edges[:, 1], starts), shape=(n, n))
        half = phi.T @ (coupled @ phi)
        result[s] = half - half.T

    parallel(fill, range(w.shape[1]))
    return like(result, basis.functions)


def _edges(mesh: Mesh) -> tuple[np.ndarray, csr_array]:
    """Return the edges (e, 2), in ascending order, and the matrix (e, n) from w to their weights.

    On a face (p, q, r), ``½ ∫ h dw∧dg − g dw∧dh`` is the sum over its edges, here p → q, of ``(w_p + w_q − 2 w_r) / 12
    · (h_p g_q − h_q g_p)``. The weight of an edge is the sum over its faces, with the opposite sign where q → p.
    """
    p, q, r = (np.concatenate([np.roll(mesh.faces, -i, axis=1)[:, c] for i in range(3)]) for c in range(3))
    sign = np.where(p < q, 1.0, -1.0) / 12
    n = len(mesh.vertices)
    keys, number = np.unique(np.minimum(p, q) * n + np.maximum(p, q), return_inverse=True)
    edges = np.stack([keys // n, keys % n], axis=1)
    rows, columns = np.tile(number, 3), np.concatenate([p, q, r])
    values = np.concatenate([sign, sign, -2 * sign])
    return edges, csr_array((values, (rows, columns)), shape=(len(edges), n))
