"""Multiplication operators of descriptors in a basis, built fast and compressed exactly.

``Xⁱ = Φᵀ A diag(wᵢ) Φ`` is the operator that multiplies a function by the feature ``wᵢ`` (Nogneng and Ovsjanikov 2017).
Being symmetric it is kept packed, ``(r, k(k+1)/2)``, until an energy term needs it.
"""

from __future__ import annotations

import numpy as np

from kfmaps._arrays import Array, blocks, check, is_numpy, like, namespace, refuse, take, to_numpy
from kfmaps._threads import n_threads, parallel
from kfmaps.geometry.basis import Basis


def truncate_features(
    source: Basis, features_s: Array, target: Basis, features_t: Array, rtol: float
) -> tuple[Array, Array]:
    """Rotate the features of both shapes jointly and drop the weakest.

    The commutativity energy does not change under a rotation of the features of both shapes. The squared norm of a
    feature's operator is at most ``Σ_p a_p h_p w_p²`` with the areas ``a`` and ``h_p = Σⱼ φⱼ(p)²``, since it is a
    projection of multiplication by ``w``. The features are rotated to the eigenbasis of the Gram matrix with these
    weights. The operators of the dropped ones have at most ``rtol`` of the sum of all bounds, which is about 1.03 times
    that of the squared norms.

    ``features_s (n_s, r)`` and ``features_t (n_t, r)`` give (n_s, r') and (n_t, r'); ``rtol``: from 0 to below 1.
    """
    _check_rtol(rtol)
    xp = namespace(features_s, features_t)
    gram = None
    for basis, features in ((source, features_s), (target, features_t)):
        weights = basis.mass * xp.sum(basis.functions * basis.functions, axis=1)
        scaled = xp.sqrt(weights)[:, None] * features
        own = scaled.T @ scaled
        gram = own if gram is None else gram + own
    rotation = _strongest(gram, rtol)
    return features_s @ rotation, features_t @ rotation


def multiplication_operators(basis: Basis, features: Array, block: int = 512, single: bool = False) -> Array:
    """Return the packed upper triangles ``(r, k(k+1)/2)`` of the multiplication operators of features.

    Off-diagonal entries are multiplied by √2, so that inner products of rows are Frobenius inner products of the
    operators. One matrix product per block of vertices; no n × k² array.

    ``features (n, r)``; ``block``: vertices of one product; ``single``: whether products of
    NumPy arrays are in single precision. Blocks are summed in double: operators differ by less than ``block`` · 6e-8 of
    the norm of their summands, by 1e-7 as a rule.
    """
    n, k = basis.functions.shape
    check(features, "features", shape=(n, None), remedy="give one row per vertex")
    xp = namespace(features)
    rows, columns = np.triu_indices(k)
    scale = like(np.where(rows == columns, 1.0, np.sqrt(2.0)), features)
    weighted, functions = features * basis.mass[:, None], basis.functions
    fill = _fill_products if is_numpy(features, basis.functions) else _new_products
    if single and fill is _fill_products:
        weighted, functions = weighted.astype(np.float32), functions.astype(np.float32)

    def sum_blocks(parts: list[slice]) -> Array:
        total, products = None, None
        for part in parts:
            phi = xp.asarray(functions[part, :].T, copy=True)  # rows of points side by side in memory
            products = fill(phi, products)
            term = products @ weighted[part, :]
            total = xp.astype(term, features.dtype) if total is None else total + term
        return total

    parts = blocks(n, block)
    count = min(n_threads(), len(parts)) if is_numpy(features) else 1
    shares = [parts[i::count] for i in range(count)]
    total = None
    for partial in parallel(sum_blocks, shares):
        total = partial if total is None else total + partial
    return (total * scale[:, None]).T


def _new_products(phi: Array, _: Array | None) -> Array:
    """Return all products ``(k(k+1)/2, m)`` of two rows of ``phi (k, m)``."""
    rows, columns = np.triu_indices(phi.shape[0])
    return take(phi, rows) * take(phi, columns)


def _fill_products(phi: np.ndarray, old: np.ndarray | None) -> np.ndarray:
    """Do as :func:`_new_products` in the memory of ``old`` ones of that size, since fresh memory takes as much time."""
    k, m = phi.shape
    products = old if old is not None and old.shape[1] == m else np.empty((k * (k + 1) // 2, m), dtype=phi.dtype)
    start = 0
    for i in range(k):
        np.multiply(phi[i], phi[i:], out=products[start : start + k - i])
        start += k - i
    return products


def unpack_operators(packed: Array) -> Array:
    """Return the operators ``(r, k, k)`` of the rows ``packed (r, k(k+1)/2)``."""
    xp = namespace(packed)
    k = int(np.sqrt(2 * packed.shape[1] + 0.25) - 0.5)
    if k * (k + 1) // 2 != packed.shape[1]:
        raise refuse(
            "packed operators", "k(k+1)/2 columns", str(packed.shape[1]), "make them with multiplication_operators"
        )
    rows, columns = np.triu_indices(k)
    position = np.empty((k, k), dtype=np.int64)
    position[rows, columns] = position[columns, rows] = np.arange(len(rows))
    scale = np.where(np.eye(k, dtype=bool), 1.0, np.sqrt(0.5)).ravel()
    flat = take(packed, position.ravel(), axis=1) * like(scale, packed)[None, :]
    return xp.reshape(flat, (packed.shape[0], k, k))


def truncate_operators(packed_s: Array, packed_t: Array, rtol: float) -> tuple[Array, Array]:
    """Rotate the operators of both shapes jointly and drop the weakest.

    The rotation is that of the joint singular value decomposition. The dropped operators have at most ``rtol`` of the
    summed squared norm of all operators of both shapes, which bounds the change of the energy. With ``rtol=0`` only
    null operators are dropped.

    ``packed_s (r, k_s(k_s+1)/2)`` and ``packed_t (r, k_t(k_t+1)/2)``; ``rtol``: from 0 to below 1.
    """
    _check_rtol(rtol)
    kept = _strongest(packed_s @ packed_s.T + packed_t @ packed_t.T, rtol)
    return kept.T @ packed_s, kept.T @ packed_t


def _check_rtol(rtol: float) -> None:
    if not 0 <= rtol < 1:
        raise refuse("compression rtol", "a number from 0 to below 1", repr(rtol), "choose 1e-6, say")


def _strongest(gram: Array, rtol: float) -> Array:
    """Return the eigenvectors of ``gram``, strongest first, without the weakest that have ``rtol`` of its trace.

    PyTorch takes them for constants, since eigenvectors of equal eigenvalues have no derivative.
    """
    gram = like(to_numpy(gram), gram)
    values, rotation = namespace(gram).linalg.eigh(gram)
    energy = to_numpy(values).clip(min=0.0)
    dropped = np.cumsum(energy)
    keep = np.flatnonzero((dropped > rtol * dropped[-1]) & (energy > 1e-15 * energy[-1]))[::-1]
    return take(rotation, keep, axis=1)
