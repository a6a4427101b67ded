"""Shape differences of a collection: operators in one common basis, distances, principal components.

Maps ``Y_v`` from a common latent space to each shape's functions turn every shape's inner products of functions into
matrices on the latent space: ``D_v = Y_vᵀ Y_v`` of functions themselves, which knows areas, and ``E_v = Y_vᵀ Λ_v Y_v``
of their gradients, which knows conformal structure (Rustamov et al., Map-based exploration of intrinsic shape
differences and variability, 2013). The latent basis is made canonical, so that numbers mean the same from run to run:
its functions are those of the mean of the gradients' matrices, ordered by their mean eigenvalues (Huang, Achlioptas,
Guibas and Ovsjanikov, Limit shapes, 2019, after Wang, Huang and Guibas 2014).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from kfmaps._arrays import check, check_count, refuse, to_numpy
from kfmaps.collection.pair_graph import signature_distances
from kfmaps.collection.synchronization import Edge, SyncResult
from kfmaps.geometry.basis import Basis


@dataclass(frozen=True, eq=False)
class LimitShape:
    """A common basis of connected shapes.

    Attributes
    ----------
    maps : (n, k, m) float64
        Of each shape: the coefficients of each latent function in the shape's first ``k`` functions.
    values : (m,) float64
        Mean eigenvalue of each latent function over the shapes, ascending, at unit area.
    eigenvalues : (n, k) float64
        Of each shape at unit area.
    members : (n,) int64
        The shapes' numbers in the collection.
    """

    maps: np.ndarray
    values: np.ndarray
    eigenvalues: np.ndarray
    members: np.ndarray

    def operators(self, kind: str = "area") -> np.ndarray:
        """Return the symmetric matrix of each shape on the latent space, the identity on average, (n, m, m).

        Parameters
        ----------
        kind : "area" or "conformal"
            ``Y_vᵀ Y_v``, or ``Λ^{-1/2} Y_vᵀ Λ_v Y_v Λ^{-1/2}`` with the latent basis' own values and without the
            constant.

        Raises
        ------
        InvalidInput
            On another kind.
        """
        if kind == "area":
            return np.swapaxes(self.maps, 1, 2) @ self.maps
        if kind != "conformal":
            raise refuse("kind", "'area' or 'conformal'", repr(kind), "choose one of them")
        maps = self.maps[:, :, 1:]
        inside = np.swapaxes(maps, 1, 2) @ (self.eigenvalues[:, :, None] * maps)
        roots = np.sqrt(np.maximum(self.values[1:], 1e-9))
        return inside / (roots[:, None] * roots[None, :])


def limit_shape(
    latent: np.ndarray,
    maps: Sequence[tuple[int, int, np.ndarray]],
    eigenvalues: np.ndarray,
    size: int | None = None,
    members: np.ndarray | None = None,
) -> LimitShape:
    """Return the canonical latent basis of shapes whose maps agree.

    Orthogonal maps ignore areas. So each shape's map becomes the mean of the images of its neighbours' maps, again and
    again: subspace iteration for the minimum of ``Σ ‖C Y_s − Y_t‖²`` under the condition that the mean of ``Y_vᵀ Y_v``
    is the identity. Finally the mean of ``Y_vᵀ Λ_v Y_v`` is made diagonal.

    Parameters
    ----------
    latent : (n, k, k)
        Orthogonal maps of the shapes, see :class:`~kfmaps.collection.synchronization.SyncResult`.
    maps : sequence of (int, int, array)
        Source, target and functional map of the pairs whose map is right, of at least ``k`` functions.
    eigenvalues : (n, k)
        Of each shape at unit area, at least ``k``.
    size : int, optional
        Latent functions at most; all by default.
    members : (m,) int, optional
        The shapes that take part; all by default.
    """
    k = latent.shape[1]
    members = np.arange(len(latent)) if members is None else members
    values = check(eigenvalues, "eigenvalues", shape=(len(latent), None), finite=True)[members, :k]
    row = {int(v): i for i, v in enumerate(members)}
    neighbours: list[list[tuple[int, np.ndarray]]] = [[] for _ in members]
    for source, target, C in maps:
        if source in row:
            neighbours[row[target]].append((row[source], C[:k, :k]))
            # Backwards by the regularised inverse, since the transpose would invert a stretch.
            neighbours[row[source]].append((row[target], np.linalg.pinv(C[:k, :k], rcond=0.2)))
    Y = _normalize(latent[members])
    for _ in range(30):  # iterations of the latent maps
        means = [np.mean([C @ Y[u] for u, C in near], axis=0) if near else Y[v] for v, near in enumerate(neighbours)]
        Y = _normalize((Y + np.stack(means)) / 2)
    areas = (np.swapaxes(Y, 1, 2) @ Y).mean(axis=0)
    gradients = (np.swapaxes(Y, 1, 2) @ (values[:, :, None] * Y)).mean(axis=0)
    means, functions = eigh(gradients, areas + 1e-9 * np.trace(areas) / k * np.eye(k))
    Y = (Y @ functions)[:, :, :size]
    signs = np.where((Y**3).sum(axis=(0, 1)) < 0, -1.0, 1.0)  # each mostly positive in the shapes' own functions
    return LimitShape(Y * signs, np.maximum(means[:size], 0.0), values, members)


def component_limit_shapes(
    sync: SyncResult, edges: Sequence[Edge], eigenvalues: np.ndarray, size: int
) -> tuple[LimitShape, ...]:
    """Return the :func:`limit_shape` of each connected component of three shapes or more, the largest first.

    Parameters
    ----------
    sync : SyncResult
    edges : sequence of Edge
        Those that were synchronized, perhaps without their last candidates, such as compositions. The most probable
        candidate of each is used, where it is probably right.
    eigenvalues : (n, k)
        Of each shape at unit area.
    size : int
        Latent functions at most.
    """
    right_from = 0.5  # probability from which a candidate takes part in the common basis
    maps = [
        (edge.source, edge.target, edge.candidates[best].map)
        for edge, chances in zip(edges, sync.probabilities, strict=True)
        if (best := int(chances[:-1].argmax())) < len(edge.candidates) and chances[best] >= right_from
    ]
    numbers, counts = np.unique(sync.component, return_counts=True)
    members = [np.flatnonzero(sync.component == number) for number in numbers[np.argsort(-counts, kind="stable")]]
    return tuple(limit_shape(sync.latent, maps, eigenvalues, size, own) for own in members if len(own) > 2)


def _normalize(maps: np.ndarray) -> np.ndarray:
    """Return the maps scaled such that the mean of ``Y_vᵀ Y_v`` is the identity."""
    areas = (np.swapaxes(maps, 1, 2) @ maps).mean(axis=0)
    values, functions = np.linalg.eigh(areas)
    return maps @ (functions / np.sqrt(np.maximum(values, 1e-9 * values[-1]))) @ functions.T


def shape_distances(matrices: np.ndarray) -> np.ndarray:
    """Return the Frobenius distances between the shapes' ``matrices (n, m, m)``, per function: (n, n)."""
    return signature_distances(matrices.reshape(len(matrices), -1)) * np.sqrt(matrices.shape[1])


@dataclass(frozen=True, eq=False)
class Components:
    """Principal components of a collection.

    Attributes
    ----------
    scores : (n, c) float64
        Coordinate of each shape along each component; mean 0.
    directions : (c, m, d) float64
        The matrices that they stand for, orthonormal; the largest entry of each is positive.
    variances : (c,) float64
        Variance of the scores, largest first.
    parts : (c,) float64
        Part of the whole variance that each explains.
    mean : (m, d) float64
    """

    scores: np.ndarray
    directions: np.ndarray
    variances: np.ndarray
    parts: np.ndarray
    mean: np.ndarray


def components(matrices: np.ndarray, count: int | None = None) -> Components:
    """Return the principal components of a collection.

    ``mean + Σ scores · directions`` is the best approximation of that many components.

    Parameters
    ----------
    matrices : (n, m, d)
        One of each shape: :meth:`LimitShape.operators`, or aligned landmarks.
    count : int, optional
        Components at most; by default those with a variance above rounding. There are fewer than shapes.
    """
    check(matrices, "matrices", shape=(None, None, None), finite=True)
    n = len(matrices)
    mean = matrices.mean(axis=0)
    left, sizes, right = np.linalg.svd((matrices - mean).reshape(n, -1), full_matrices=False)
    significant = int((sizes > 1e-10 * max(sizes[0], 1e-300)).sum())
    n_kept = min(significant if count is None else check_count(count, "components"), n - 1, len(sizes))
    flip = np.where(right[np.arange(n_kept), np.abs(right[:n_kept]).argmax(axis=1)] < 0, -1.0, 1.0)
    squares, whole = sizes[:n_kept] ** 2, (sizes**2).sum()
    return Components(
        left[:, :n_kept] * sizes[:n_kept] * flip,
        (right[:n_kept] * flip[:, None]).reshape(n_kept, *mean.shape),
        squares / max(n - 1, 1),
        squares / whole if whole > 0 else np.zeros(n_kept),
        mean,
    )


def density(matrices: np.ndarray, shape: LimitShape, number: int, basis: Basis) -> np.ndarray:
    """Return how large each shape is at each vertex of one of them, relative to the mean: (n, vertices).

    ``ψᵀ D_v ψ / ψᵀ D̄ ψ`` with ``ψ`` the latent coordinates of the vertex's delta function. With operators of the
    kind "area" it is the density of area, at the resolution of the latent functions; its standard deviation over
    the shapes tells where they differ.

    ``matrices (n, m, m)``: :meth:`LimitShape.operators`; ``number`` and ``basis``: of the shape with the vertices.
    """
    maps = shape.maps[number]
    functions = to_numpy(basis.functions)[:, : len(maps)]
    first = maps.shape[1] - matrices.shape[1]
    coordinates = (functions @ np.linalg.pinv(maps, rcond=0.05).T)[:, first:]
    mean = np.einsum("xi,ij,xj->x", coordinates, matrices.mean(axis=0), coordinates)
    values = np.stack([((coordinates @ D) * coordinates).sum(axis=1) for D in matrices])
    return values / np.maximum(mean, 1e-9 * mean.max())
