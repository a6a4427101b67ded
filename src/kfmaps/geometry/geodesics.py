"""Distances along a surface: shortest paths over edges and straight lines across unfolded faces.

Measured against exact polyhedral distances (Mitchell, Mount and Papadimitriou) on remeshed humans of 5,000 vertices,
they are 0.26 % too long on average and 0.1 % within three edge lengths, in 0.9 ms a source. Paths over edges alone are
5 % too long; the heat method and fast marching are 2 % off and worse nearby, where errors of correspondences mostly
are. ``benchmarks/geodesics.py`` measures any mesh.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from kfmaps._arrays import check_count, refuse
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, check_is_mesh
from kfmaps.geometry.weld import weld_vertices

_FULL_SEARCHES = 100  # points from which :func:`pairwise_geodesics` searches the whole surface
_NEARBY = 0.25  # distance at unit area up to which it searches from other points: a fifth of a body


def _indices(values: ArrayLike, n: int, name: str) -> np.ndarray:
    array = np.atleast_1d(np.asarray(values))
    if array.ndim != 1 or not (np.issubdtype(array.dtype, np.integer) or array.size == 0):
        got = f"shape {array.shape} of {array.dtype}"
        raise refuse(name, "a list of vertex numbers", got, "give whole numbers")
    if array.size and (array.min() < 0 or array.max() >= n):
        bad = int(array.min() if array.min() < 0 else array.max())
        raise refuse(name, f"vertex numbers from 0 to {n - 1}", str(bad), "count them from 0")
    return array.astype(np.int64)


def geodesic_distances(mesh: Mesh, sources: ArrayLike) -> np.ndarray:
    """Return distances along the surface from each source to every vertex.

    They are lengths of shortest paths over edges and straight lines across up to four unfolded edges
    (:func:`~kfmaps.geometry.geodesic_graph.geodesic_graph`): never shorter than the geodesic, symmetric, and with the
    triangle inequality.

    Parameters
    ----------
    mesh : Mesh
        Any triangles: boundaries, several components, branching edges and unused vertices do no harm. On a point cloud
        paths run along nearest neighbours (4 to 7 % error on humans, more where limbs touch).
    sources : (q,) int
        Vertex numbers.

    Returns
    -------
    (q, n) float64
        In the mesh's own unit; infinite between components and for vertices that no face uses.

    Raises
    ------
    InvalidInput
        On a vertex number out of range.

    Examples
    --------
    >>> mesh = kfmaps.datasets.sphere(500)
    >>> bool(abs(kfmaps.geodesic_distances(mesh, [0]).max() - np.pi) < 0.1)  # half of a great circle
    True
    """
    check_is_mesh(mesh)
    sources = _indices(sources, len(mesh.vertices), "sources")
    if len(sources) == 0:
        return np.zeros((0, len(mesh.vertices)))
    first = weld_vertices(mesh)
    distances = dijkstra(geodesic_graph(mesh), indices=first[sources])
    return distances if (first == np.arange(len(first))).all() else distances[:, first]


def geodesic_distance_pairs(mesh: Mesh, a: ArrayLike, b: ArrayLike) -> np.ndarray:
    """Return the distance along the surface from vertex ``a[i]`` to vertex ``b[i]``, in the mesh's own unit.

    No n × n matrix is held: five thousand near pairs on five thousand vertices take less than a second.

    Parameters
    ----------
    mesh : Mesh
    a, b : (q,) int
        Vertex numbers.

    Returns
    -------
    (q,) float64
        Infinite for two vertices on different components; 0 for two in one place that are connected.

    Raises
    ------
    InvalidInput
        On lists of different length or a vertex number out of range.
    """
    n = len(mesh.vertices)
    a, b = _indices(a, n, "a"), _indices(b, n, "b")
    if len(a) != len(b):
        raise refuse("a and b", "lists of equal length", f"{len(a)} and {len(b)}", "give one pair per entry")
    first = weld_vertices(mesh)
    straight = np.linalg.norm(mesh.vertices[a] - mesh.vertices[b], axis=1)
    return shortest_paths(geodesic_graph(mesh), first[a], first[b], straight)


def shortest_paths(graph: csr_array, a: np.ndarray, b: np.ndarray, straight: np.ndarray) -> np.ndarray:
    """Return the lengths (q,) of the shortest paths from node ``a[i]`` to node ``b[i]``; infinite between components.

    ``graph (n, n)``: sparse and symmetric; ``straight (q,)``: straight distances between the nodes. Searches begin with
    limits little above these.
    """
    _, component = connected_components(graph, directed=False)
    result = np.where(a == b, 0.0, np.inf)
    remaining = np.flatnonzero((a != b) & (component[a] == component[b]))
    mean_edge = graph.data.mean() if graph.nnz else 0.0
    limits = 1.3 * straight + mean_edge
    for attempt in range(4):
        if len(remaining) == 0:
            break
        # One search from a node serves all of its pairs; nodes with like limits are searched from together.
        _, node = np.unique(a[remaining], return_inverse=True)
        reach = np.zeros(node.max() + 1)
        np.maximum.at(reach, node, limits[remaining])
        remaining = remaining[np.lexsort((node, reach[node]))]
        next_node = np.flatnonzero(np.diff(a[remaining])) + 1
        for rows in np.split(remaining, next_node[63::64]):  # 64 nodes each, which bounds the memory
            sources, row = np.unique(a[rows], return_inverse=True)
            limit = limits[rows].max() if attempt < 3 else np.inf
            result[rows] = dijkstra(graph, indices=sources, limit=limit)[row, b[rows]]
        remaining = remaining[np.isinf(result[remaining])]
        limits = 2.5 * limits
    return result


def pairwise_geodesics(graph: csr_array, points: np.ndarray) -> np.ndarray:
    """Return the distances between some points, in half of the time of full searches from each.

    Those from the first 100 points and those up to 0.25 are exact. Others are the lengths of paths over one of the
    points. With 300 farthest points on bodies these are 0.3 % too long, all distances 0.04 %.

    Parameters
    ----------
    graph : sparse (n, n)
        Symmetric, of a surface of about unit area; see :func:`kfmaps.geometry.geodesic_graph.geodesic_graph`.
    points : (c,) int64
        Vertices, first those that are spread over all of the surface.

    Returns
    -------
    (c, c) float64
        Infinite between components.
    """
    distances = np.asarray(dijkstra(graph, indices=points[:_FULL_SEARCHES]))[:, points]
    if len(points) <= _FULL_SEARCHES:
        return distances
    near = np.asarray(dijkstra(graph, indices=points[_FULL_SEARCHES:], limit=_NEARBY))[:, points]
    near[:, :_FULL_SEARCHES] = distances[:, _FULL_SEARCHES:].T
    distances = np.concatenate([distances, near])
    single = distances.astype(np.float32)
    detours = []  # over one of the points
    for row in single[_FULL_SEARCHES:]:
        via = np.isfinite(row)
        detours.append((row[via, None] + single[via, _FULL_SEARCHES:]).min(axis=0))
    rest = distances[_FULL_SEARCHES:, _FULL_SEARCHES:]
    rest[np.isinf(rest)] = np.stack(detours)[np.isinf(rest)]
    np.minimum(rest, rest.T.copy(), out=rest)
    if np.isinf(rest).any():
        # Points of one component without any of the first.
        label = connected_components(graph, directed=False)[1][points]
        missing = np.flatnonzero((np.isinf(distances) & (label[:, None] == label[None, :])).any(axis=1))
        if len(missing):
            distances[missing] = np.asarray(dijkstra(graph, indices=points[missing]))[:, points]
            distances[:, missing] = distances[missing].T
    return distances


def farthest_geodesic(
    mesh: Mesh, count: int, rng: int | np.random.Generator = 0, first: int | None = None
) -> np.ndarray:
    """Return vertices spread evenly over the surface: each is the farthest from those before it.

    Distances run over edges and the diagonals of neighbouring faces (1.3 % error). Each new sample is searched from
    only as far as the farthest vertex was from those before, so the whole costs little more than a few searches.

    Parameters
    ----------
    mesh : Mesh
        As for :func:`geodesic_distances`.
    count : int
        From 1 to the number of vertices that faces use.
    rng : int or numpy.random.Generator
        Draws the first vertex.
    first : int, optional
        The first vertex, instead.

    Returns
    -------
    (count,) int64
        All different, none unused by faces. Every component is met before any is met twice, as far as ``count`` goes.

    Raises
    ------
    InvalidInput
        On a count or first vertex out of range.

    References
    ----------
    Moenning and Dodgson, Fast marching farthest point sampling (2003).
    """
    n = len(mesh.vertices)
    used = np.ones(n, dtype=bool)
    if len(mesh.faces):
        used = np.bincount(mesh.faces.ravel(), minlength=n) > 0
    check_count(count, "count", 1, int(used.sum()))
    if first is None:
        first = int(np.random.default_rng(rng).choice(np.flatnonzero(used)))
    samples = [int(_indices(np.array([first]), n, "first")[0])]
    graph = geodesic_graph(mesh, 1)
    nearest = np.where(used, np.inf, -np.inf)
    while True:
        nearest = np.minimum(nearest, dijkstra(graph, indices=samples[-1], limit=nearest.max()))
        if len(samples) == count:
            return np.array(samples)
        samples.append(int(np.argmax(nearest)))
