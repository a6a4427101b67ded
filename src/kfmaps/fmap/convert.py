"""From a functional map to a point map and back."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from kfmaps._arrays import Array, blocks, is_numpy, namespace, refuse, take, to_numpy
from kfmaps.fmap.approximate_nearest import N_PROBE
from kfmaps.fmap.nearest import is_approximate, nearest
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh

__all__ = ["check_point_map", "nearest", "nearest_reached", "to_functional", "to_points"]


def to_points(
    C: Array,
    source: Basis,
    target: Basis,
    extra_columns: tuple[Array, Array] | None = None,
    exact: bool | None = None,
    n_probe: int = N_PROBE,
) -> np.ndarray:
    """Return the point map ``target_to_source (n_t,)`` of a functional map.

    Rows of ``Φ_s Cᵀ`` are the images of the source's delta functions, rows of ``Φ_t`` are the target's. Each target
    vertex takes the source vertex with the closest row (Ovsjanikov et al. 2012).

    Parameters
    ----------
    C : (k_t, k_s)
    source, target : Basis
        Of at least that many functions.
    extra_columns : pair of (n_s, d) and (n_t, d), optional
        Further columns to compare, as :meth:`kfmaps.fmap.descriptor_guidance.DescriptorGuidance.embedding_columns`
        returns them.
    exact, n_probe
        As for :func:`kfmaps.fmap.nearest.nearest`: from about 10,000 points on each side the search is approximate
        unless ``exact`` says otherwise, and quicker with a smaller ``n_probe``.

    Returns
    -------
    (n_t,) int64
        A source vertex for each target vertex.

    Examples
    --------
    >>> basis = kfmaps.laplace_basis(kfmaps.datasets.sphere(500), 50)
    >>> np.array_equal(kfmaps.to_points(np.eye(50), basis, basis), np.arange(500))
    True
    """
    dimensions = C.shape[0] + (0 if extra_columns is None else extra_columns[0].shape[1])
    single = is_approximate(target.mass.shape[0], source.mass.shape[0], dimensions, exact)
    embedding = _embed_single if single and is_numpy(C, source.functions) else embed
    points, queries = embedding(C, source, target, extra_columns)
    # A vertex that no face uses has no area and the functions of a neighbour. It cannot be an image.
    used = np.flatnonzero(to_numpy(source.mass) > 0)
    if len(used) == points.shape[0]:
        return nearest(queries, points, exact=exact, n_probe=n_probe)
    return used[nearest(queries, take(points, used), exact=exact, n_probe=n_probe)]


def embed(
    C: Array, source: Basis, target: Basis, extra_columns: tuple[Array, Array] | None = None
) -> tuple[Array, Array]:
    """Return the points of both shapes in the spectral embedding of the target, (n_s, k_t + d) and (n_t, k_t + d).

    ``C (k_t, k_s)``; ``extra_columns``: as for :func:`to_points`.
    """
    k_t, k_s = C.shape
    rows_s, rows_t = source.truncate(k_s).functions @ C.T, target.truncate(k_t).functions
    if extra_columns is None:
        return rows_s, rows_t
    xp = namespace(rows_s)
    return xp.concat([rows_s, extra_columns[0]], axis=1), xp.concat([rows_t, extra_columns[1]], axis=1)


def _embed_single(
    C: np.ndarray, source: Basis, target: Basis, extra_columns: tuple[Array, Array] | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return what :func:`embed` does in single precision, in which many points are searched approximately."""
    k_t, k_s = C.shape
    d = 0 if extra_columns is None else extra_columns[0].shape[1]
    rows_s = np.empty((len(source.mass), k_t + d), dtype=np.float32)
    for part in blocks(len(rows_s), 4096):
        rows_s[part, :k_t] = source.functions[part, :k_s] @ C.T
    rows_t = np.empty((len(target.mass), k_t + d), dtype=np.float32)
    rows_t[:, :k_t] = target.functions[:, :k_t]
    if extra_columns is not None:
        rows_s[:, k_t:], rows_t[:, k_t:] = extra_columns
    return rows_s, rows_t


def to_functional(target_to_source: np.ndarray, source: Basis, target: Basis) -> Array:
    """Return the functional map ``C (k_t, k_s)`` of a point map: ``Φ_tᵀ A_t Φ_s[target_to_source]``.

    Parameters
    ----------
    target_to_source : (n_t,) int
    source, target : Basis

    Returns
    -------
    (k_t, k_s) array

    Examples
    --------
    >>> basis = kfmaps.laplace_basis(kfmaps.datasets.sphere(500), 10)
    >>> np.allclose(kfmaps.to_functional(np.arange(500), basis, basis), np.eye(10))
    True
    """
    rows = check_point_map(target_to_source, source.functions.shape[0], target.functions.shape[0])
    return target.project(take(source.functions, rows))


def check_point_map(target_to_source: np.ndarray, n_s: int, n_t: int) -> np.ndarray:
    """Return ``target_to_source`` as int64 when it gives each of ``n_t`` vertices one of ``n_s``."""
    points = np.asarray(target_to_source)
    if points.shape != (n_t,) or not np.issubdtype(points.dtype, np.integer):
        got = f"{points.dtype} of shape {points.shape}"
        raise refuse(
            "target_to_source", f"whole numbers of shape ({n_t},)", got, "give a source vertex per target vertex"
        )
    if n_t and (points.min() < 0 or points.max() >= n_s):
        got = f"{int(points.min())} to {int(points.max())}"
        raise refuse("target_to_source", f"vertices 0 to {n_s - 1}", got, "is it a map to another shape, or 1-based?")
    return points.astype(np.int64)


def nearest_reached(source: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Return the nearest vertex that some target vertex is mapped to for each source vertex, (n_s,).

    Nearest is meant along edges, so that a point of an arm is not linked to the leg beside it. In point clouds and
    components that no target vertex reaches it is meant in space.

    ``target_to_source (n_t,)``: −1 where a vertex has no counterpart.
    """
    n = len(source.vertices)
    images = np.unique(target_to_source)
    images = images[images >= 0]
    if len(images) == 0:
        return np.arange(n)
    result = np.full(n, -1, dtype=np.int64)
    if len(source.faces):
        graph = geodesic_graph(source, 0)
        distances, _, origins = dijkstra(graph, indices=images, min_only=True, return_predecessors=True)
        reached = np.isfinite(distances)
        result[reached] = origins[reached]
    result[images] = images
    unreached = result < 0
    if unreached.any():
        result[unreached] = images[KDTree(source.vertices[images]).query(source.vertices[unreached])[1]]
    return result
