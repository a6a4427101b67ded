"""Initial latent maps of a synchronization: along a spanning tree of the pairs, and from eigenvectors of all pairs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csr_array, eye_array
from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

from kfmaps.fmap.constraints import nearest_orthogonal
from kfmaps.geometry.eigen.eigensolver import smallest_eigenpairs

MAX_LOG_ODDS = 4.0
"""Largest log-odds that a candidate's own evidence counts for."""

_Ends = Sequence[tuple[int, int]]


def spanning_tree_init(
    count: int, ends: _Ends, maps: Sequence[np.ndarray], odds: Sequence[np.ndarray], functions: int
) -> np.ndarray:
    """Return latent maps along the spanning tree of the pairs whose best candidate has most for it, (n, k, k)."""
    latent = np.tile(np.eye(functions), (count, 1, 1))
    weight = np.full((count, count), np.inf)
    best: dict[tuple[int, int], np.ndarray] = {}
    for (a, b), C, own in zip(ends, maps, odds, strict=True):
        number = int(np.argmax(own))
        cost = 1.0 + MAX_LOG_ODDS - float(own[number])
        if cost < weight[a, b]:
            weight[a, b] = weight[b, a] = cost
            best[a, b], best[b, a] = C[number], C[number].T
    tree = minimum_spanning_tree(np.where(np.isfinite(weight), weight, 0.0))
    seen = np.zeros(count, dtype=bool)
    for root in range(count):
        if seen[root]:
            continue
        order, before = breadth_first_order(tree, root, directed=False)
        for v in order:
            seen[v] = True
            if v != root:
                latent[v] = nearest_orthogonal(best[before[v], v] @ latent[before[v]])
    return latent


def spectral_init(
    count: int, ends: _Ends, maps: Sequence[np.ndarray], odds: Sequence[np.ndarray], functions: int
) -> np.ndarray:
    """Return latent maps from the leading eigenvectors of all pairs' maps together, each rounded, (n, k, k).

    Of ``D^{-1/2} W D^{-1/2}`` with blocks ``Σ_c p_c C`` and the shapes' degrees ``D``.
    """
    blocks: dict[tuple[int, int], np.ndarray] = {}
    degree = np.zeros(count)
    for (a, b), C, own in zip(ends, maps, odds, strict=True):
        p = np.exp(own) / (1.0 + np.exp(own).sum())
        mean = np.tensordot(p, C, axes=1)
        for row, column, one in ((b, a, mean), (a, b, mean.T)):
            blocks[row, column] = blocks.get((row, column), np.zeros_like(one)) + one
        degree[[a, b]] += p.sum()
    root = 1.0 / np.sqrt(np.maximum(degree, 1e-9))
    size = count * functions
    whole = csr_array((size, size))
    if blocks:
        rows, columns = (np.array(side) for side in zip(*blocks, strict=True))
        values = np.stack([root[a] * root[b] * C for (a, b), C in blocks.items()])
        firsts, inner = np.stack([rows, columns])[:, :, None, None] * functions, np.arange(functions)
        at = np.broadcast_arrays(firsts[0] + inner[:, None], firsts[1] + inner)
        whole = csr_array((values.ravel(), (at[0].ravel(), at[1].ravel())), shape=(size, size))
    if size <= 1500:  # unknowns up to which eigenvectors are worked out densely
        vectors = np.linalg.eigh(whole.toarray())[1][:, -functions:]
    else:
        # Where all maps agree the largest eigenvalue has all of them, and that of a long cycle has many close to it.
        matrix = csr_array(eye_array(size) - whole)
        vectors = smallest_eigenpairs(matrix, np.ones(size), functions, tolerance=1e-6).vectors
    parts = vectors.reshape(count, functions, functions)
    return np.stack([nearest_orthogonal(part) for part in parts])
