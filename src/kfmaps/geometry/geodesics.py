"""Distances along a surface.

Measured against exact polyhedral distances (Mitchell, Mount and Papadimitriou) on remeshed humans of 5,000 vertices,
one thread; errors in per cent of the distance, "near" within three edge lengths:

===========================  ========  =====  =====  ======
method                       a source  mean   near   worst
===========================  ========  =====  =====  ======
``unfolded`` (depth 4)       0.9 ms    0.26   0.1    3
``dijkstra`` over edges      0.4 ms    5.1    5.5    36
``heat``                     0.9 ms    2.1    7      37
fast marching                3.7 ms    1.7    3.4    24
===========================  ========  =====  =====  ======

So ``unfolded`` is the default: errors of correspondences are mostly a few edges long, where the heat method, which
smooths over an edge length, is at its worst. ``benchmarks/geodesics.py`` measures any mesh.
"""

from __future__ import annotations

import numpy as np
import potpourri3d
from numpy.typing import ArrayLike
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from kfmaps._arrays import check_count, refuse
from kfmaps.geometry.clean import clean_mesh, weld_vertices
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, check_is_mesh

_METHODS = ("unfolded", "dijkstra", "heat")


_FULL_SEARCHES = 100  # points that :func:`pairwise_geodesics` searches all of the surface from

_NEARBY = 0.25  # distance at unit area up to which it searches from the others: a fifth of a body

_SEARCHES = 64  # farthest samples whose regions are large enough that a whole search is faster than a spreading front


def _indices(values: ArrayLike, n: int, name: str) -> np.ndarray:
    array = np.atleast_1d(np.asarray(values))
    if array.ndim != 1 or not (np.issubdtype(array.dtype, np.integer) or array.size == 0):
        got = f"shape {array.shape} of {array.dtype}"
        raise refuse(name, "a list of vertex numbers", got, "give whole numbers")
    if array.size and (array.min() < 0 or array.max() >= n):
        bad = int(array.min() if array.min() < 0 else array.max())
        raise refuse(name, f"vertex numbers from 0 to {n - 1}", str(bad), "count them from 0")
    return array.astype(np.int64)


def _graph(mesh: Mesh, method: str) -> csr_array:
    if method not in _METHODS:
        raise refuse("method", f"one of {', '.join(_METHODS)}", repr(method), "choose one of them")
    return geodesic_graph(mesh) if method == "unfolded" else geodesic_graph(mesh, 0)


def _heat(mesh: Mesh, sources: np.ndarray) -> np.ndarray:
    """Heat-method distances (q, n), infinite on other components."""
    part = clean_mesh(mesh)
    _, component = connected_components(geodesic_graph(part.mesh, 0), directed=False)
    if len(mesh.faces) == 0:
        solver = potpourri3d.PointCloudHeatSolver(part.mesh.vertices)
    else:
        solver = potpourri3d.MeshHeatMethodDistanceSolver(part.mesh.vertices, part.mesh.faces)
    distances = np.full((len(sources), len(mesh.vertices)), np.inf)
    used = ~part.unreferenced
    for row, source in zip(distances, sources, strict=True):
        if used[source]:
            here = part.to_clean[source]
            found = solver.compute_distance(int(here))
            found[component != component[here]] = np.inf
            found[here] = 0
            row[used] = found[part.to_clean[used]]
        row[source] = 0
    return distances


def geodesic_distances(mesh: Mesh, sources: ArrayLike, method: str = "unfolded") -> np.ndarray:
    """Return distances along the surface from each source to every vertex.

    Parameters
    ----------
    mesh : Mesh
        Any triangles: boundaries, several components, branching edges and unused vertices do no harm. On a point cloud
        the first two methods run on the graph of nearest neighbours (4 to 7 % error on humans, more where limbs touch),
        ``"heat"`` on the cloud's own Laplacian.
    sources : (q,) int
        Vertex numbers.
    method : {"unfolded", "dijkstra", "heat"}
        ``"unfolded"``: shortest paths over edges and straight lines across up to four unfolded edges
        (:func:`~kfmaps.geometry.geodesic_graph.geodesic_graph`). ``"dijkstra"``: over edges alone. Both are never
        shorter than the geodesic, symmetric, and obey the triangle inequality. ``"heat"``: Crane, Weischedel and
        Wardetzky, Geodesics in heat (2013), which does neither.

    Returns
    -------
    (q, n) float64
        In the mesh's own unit; infinite between components and for vertices that no face uses.

    Raises
    ------
    InvalidInput
        On a vertex number out of range or an unknown method.
    """
    check_is_mesh(mesh)
    sources = _indices(sources, len(mesh.vertices), "sources")
    graph = _graph(mesh, method)
    if len(sources) == 0:
        return np.zeros((0, len(mesh.vertices)))
    if method == "heat":
        return _heat(mesh, sources)
    first = weld_vertices(mesh)
    distances = dijkstra(graph, indices=first[sources])
    return distances if (first == np.arange(len(first))).all() else distances[:, first]


def geodesic_distance_pairs(mesh: Mesh, a: ArrayLike, b: ArrayLike, method: str = "unfolded") -> np.ndarray:
    """Return the distance along the surface from vertex ``a[i]`` to vertex ``b[i]``, in the mesh's own unit.

    No n × n matrix is held: sources are taken in blocks, each searched only as far as its pairs need, so that five
    thousand near pairs on five thousand vertices take less than a second.

    Parameters
    ----------
    mesh : Mesh
    a, b : (q,) int
        Vertex numbers.
    method : {"unfolded", "dijkstra", "heat"}
        As for :func:`geodesic_distances`.

    Returns
    -------
    (q,) float64
        Infinite for two vertices on different components; 0 for two in one place that are connected.

    Raises
    ------
    InvalidInput
        On lists of different length, a vertex number out of range or an unknown method.
    """
    n = len(mesh.vertices)
    a, b = _indices(a, n, "a"), _indices(b, n, "b")
    if len(a) != len(b):
        raise refuse("a and b", "lists of equal length", f"{len(a)} and {len(b)}", "give one pair per entry")
    first = weld_vertices(mesh)
    a, b = first[a], first[b]
    graph = _graph(mesh, method)
    _, component = connected_components(graph, directed=False)
    result = np.where(a == b, 0.0, np.inf)
    open_pairs = np.flatnonzero((a != b) & (component[a] == component[b]))
    # The straight line bounds the distance from below; most distances are not far above it.
    straight = np.linalg.norm(mesh.vertices[a] - mesh.vertices[b], axis=1)
    shortest_edge = graph.data.mean() if graph.nnz else 0.0
    reach = 1.3 * straight + shortest_edge
    for attempt in range(4):
        limited = attempt < 3 and method != "heat"
        for pairs in _blocks(open_pairs, a, reach):
            sources, row = np.unique(a[pairs], return_inverse=True)
            if method == "heat":
                distances = _heat(mesh, sources)
            else:
                limit = reach[pairs].max() if limited else np.inf
                distances = dijkstra(graph, indices=sources, limit=limit)
            result[pairs] = distances[row, b[pairs]]
        open_pairs = open_pairs[np.isinf(result[open_pairs])]
        reach = 2.5 * reach
    return result


def _blocks(pairs: np.ndarray, a: np.ndarray, reach: np.ndarray) -> list[np.ndarray]:
    """``pairs`` in groups of 64 sources that need to be searched about equally far."""
    if len(pairs) == 0:
        return []
    sources, row = np.unique(a[pairs], return_inverse=True)
    far = np.zeros(len(sources))
    np.maximum.at(far, row, reach[pairs])
    rank = np.empty(len(sources), dtype=np.int64)
    rank[np.argsort(far, kind="stable")] = np.arange(len(sources))
    group = rank[row] // 64  # which bounds the memory
    order = np.argsort(group, kind="stable")
    return np.split(pairs[order], np.flatnonzero(np.diff(group[order])) + 1)


def pairwise_geodesics(graph: csr_array, points: np.ndarray) -> np.ndarray:
    """Return the distances between some points, in half of the time of a search from each over all of the surface.

    Exact between each of the first 100 and all, and up to a distance of 0.25. Others are the lengths of paths over one
    of the points, which are little longer for farthest points: of 300 on bodies by 0.3 %, of all distances 0.04 %.

    Parameters
    ----------
    graph : sparse (n, n)
        Symmetric, of a surface of about unit area; see :func:`kfmaps.geometry.geodesic_graph.geodesic_graph`.
    points : (c,) int64
        Vertices. Those come first that are spread over all of the surface.

    Returns
    -------
    (c, c) float64
        Infinite between components.
    """
    found = np.asarray(dijkstra(graph, indices=points[:_FULL_SEARCHES]))[:, points]
    if len(points) <= _FULL_SEARCHES:
        return found
    near = np.asarray(dijkstra(graph, indices=points[_FULL_SEARCHES:], limit=_NEARBY))[:, points]
    near[:, :_FULL_SEARCHES] = found[:, _FULL_SEARCHES:].T
    found = np.concatenate([found, near])
    single = found.astype(np.float32)
    known = np.isfinite(single)
    over = np.stack(
        [
            (one[at, None] + single[at, _FULL_SEARCHES:]).min(axis=0)
            for one, at in zip(single[_FULL_SEARCHES:], known[_FULL_SEARCHES:], strict=True)
        ]
    )
    rest = found[_FULL_SEARCHES:, _FULL_SEARCHES:]
    rest[np.isinf(rest)] = over[np.isinf(rest)]
    np.minimum(rest, rest.T.copy(), out=rest)
    if np.isinf(rest).any():
        # What none of the first reaches may be joined all the same.
        label = connected_components(graph, directed=False)[1][points]
        lost = np.flatnonzero((np.isinf(found) & (label[:, None] == label[None, :])).any(axis=1))
        if len(lost):
            found[lost] = np.asarray(dijkstra(graph, indices=points[lost]))[:, points]
            found[:, lost] = found[lost].T
    return found


def farthest_geodesic(
    mesh: Mesh, count: int, rng: int | np.random.Generator = 0, first: int | None = None
) -> np.ndarray:
    """Return vertices spread evenly over the surface: each is the farthest from those before it.

    Distances run over edges and the diagonals of neighbouring faces (1.3 % error). Each new sample costs only the
    vertices that are nearer to it than to all before, so the whole costs little more than a few searches.

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
        if len(samples) <= _SEARCHES:
            nearest = np.minimum(nearest, dijkstra(graph, indices=samples[-1], limit=nearest.max()))
        else:
            _spread(graph, nearest, samples[-1])
        if len(samples) == count:
            return np.array(samples)
        samples.append(int(np.argmax(nearest)))


def _spread(graph: csr_array, nearest: np.ndarray, source: int) -> None:
    """Lower ``nearest`` (n,), in place, wherever ``source`` is nearer."""
    start, neighbours, lengths = graph.indptr, graph.indices, graph.data
    nearest[source] = 0
    front = np.array([source])
    while len(front):
        count = start[front + 1] - start[front]
        entry = np.arange(count.sum()) + np.repeat(start[front] - np.cumsum(count) + count, count)
        vertex, distance = neighbours[entry], np.repeat(nearest[front], count) + lengths[entry]
        nearer = distance < nearest[vertex]
        vertex = vertex[nearer]
        np.minimum.at(nearest, vertex, distance[nearer])
        front = np.unique(vertex)
