"""From a functional map to a point map and back."""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from kfmaps._arrays import Array, blocks, is_numpy, namespace, refuse, take, to_numpy
from kfmaps.fmap.approximate_nearest import N_PROBE
from kfmaps.fmap.nearest import nearest, searches_cells
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh

__all__ = ["check_point_map", "nearest", "nearest_reached", "to_functional", "to_points"]


def to_points(
    C: Array,
    source: Basis,
    target: Basis,
    beside: tuple[Array, Array] | None = None,
    exact: bool | None = None,
    probes: int = N_PROBE,
) -> np.ndarray:
    """Return the point map ``target_to_source (n_t,)`` of a functional map.

    Rows of ``Φ_s Cᵀ`` are the images of the source's delta functions, rows of ``Φ_t`` the target's deltas; each of the
    latter takes the closest of the former (Ovsjanikov et al. 2012).

    Parameters
    ----------
    C : (k_t, k_s)
    source, target : Basis
        Of at least that many functions.
    beside : pair of (n_s, d) and (n_t, d), optional
        Further columns to compare; see :func:`embed`.
    exact, probes
        As for :func:`kfmaps.fmap.nearest.nearest`: from about 10,000 points on each side the search is approximate
        unless ``exact`` says otherwise, and quicker with fewer ``probes``.
    """
    dimensions = C.shape[0] + (0 if beside is None else beside[0].shape[1])
    many = searches_cells(target.mass.shape[0], source.mass.shape[0], dimensions, exact)
    single = many and is_numpy(C, source.functions)
    images, places = (_embed_single if single else embed)(C, source, target, beside)
    # A vertex that no face uses has no area and the values of a neighbour: it is nobody's image.
    used = np.flatnonzero(to_numpy(source.mass) > 0)
    if len(used) == images.shape[0]:
        return nearest(places, images, exact=exact, probes=probes)
    return used[nearest(places, take(images, used), exact=exact, probes=probes)]


def embed(
    C: Array, source: Basis, target: Basis, extra_columns: tuple[Array, Array] | None = None
) -> tuple[Array, Array]:
    """Return the points of both shapes in the spectral embedding of the target, where nearest ones correspond.

    ``C (k_t, k_s)``; ``source`` and ``target``: truncated to the size of ``C``; ``extra_columns``: further columns to
    compare; see :meth:`kfmaps.fmap.descriptor_guidance.DescriptorGuidance.embedding_columns`. Returns ``source, target
    (n_s, k_t + d)``.
    """
    k_t, k_s = C.shape
    images, places = source.truncate(k_s).functions @ C.T, target.truncate(k_t).functions
    if extra_columns is None:
        return images, places
    xp = namespace(images)
    return xp.concat([images, extra_columns[0]], axis=1), xp.concat([places, extra_columns[1]], axis=1)


def _embed_single(
    C: np.ndarray, source: Basis, target: Basis, extra_columns: tuple[Array, Array] | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return what :func:`embed` does, in the single precision that an approximate search of many points works in."""
    k_t, k_s = C.shape
    columns = extra_columns or (np.zeros((len(source.mass), 0)), np.zeros((len(target.mass), 0)))
    sides = (source.functions[:, :k_s], C.T, columns[0]), (target.functions[:, :k_t], None, columns[1])
    embedded = []
    for functions, turn, beside in sides:
        rows = np.empty((len(functions), k_t + beside.shape[1]), dtype=np.float32)
        for part in blocks(len(rows), 4096):
            rows[part, :k_t] = functions[part] if turn is None else functions[part] @ turn
            rows[part, k_t:] = beside[part]
        embedded.append(rows)
    return embedded[0], embedded[1]


def to_functional(target_to_source: np.ndarray, source: Basis, target: Basis) -> Array:
    """Return the functional map ``C (k_t, k_s)`` of a point map: ``Φ_tᵀ A_t Φ_s[target_to_source]``.

    Parameters
    ----------
    target_to_source : (n_t,) int
    source, target : Basis
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

    Nearest along the edges, so that a point of an arm is not linked to the leg beside it; straight through space for
    point clouds and for parts that no target vertex reaches.

    ``target_to_source (n_t,)``: −1 where a vertex has no counterpart.
    """
    n = len(source.vertices)
    reached = np.unique(target_to_source)
    reached = reached[reached >= 0]
    if len(reached) == 0:
        return np.arange(n)
    nearest = np.full(n, -1, dtype=np.int64)
    if len(source.faces):
        result = dijkstra(geodesic_graph(source, 0), indices=reached, min_only=True, return_predecessors=True)
        found = np.isfinite(result[0])
        nearest[found] = result[2][found]
    nearest[reached] = reached
    lost = nearest < 0
    if lost.any():
        nearest[lost] = reached[KDTree(source.vertices[reached]).query(source.vertices[lost])[1]]
    return nearest
