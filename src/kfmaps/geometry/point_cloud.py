"""Point clouds: Laplacian, areas, and edges between neighbours."""

from __future__ import annotations

import numpy as np
import robust_laplacian
from scipy.sparse import coo_array
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import Delaunay, KDTree

from kfmaps._arrays import refuse
from kfmaps.geometry.connectivity import component_labels, unique_vertices
from kfmaps.geometry.eigen.factorization import SparseMatrix

_NEIGHBOURS = 12  # neighbours that a point is linked to


def cloud_laplacian(points: np.ndarray) -> tuple[SparseMatrix, np.ndarray]:
    """Return the weak Laplacian (n, n) and the areas (n,) of ``points (n, 3)``, all at different positions.

    Every point's neighbours are triangulated in its tangent plane, and the tufted Laplacian is built on all these
    triangles (Sharp and Crane 2020, section 5.7). On remeshed humans and animals the sum of the areas is right to
    within 0.3 to 4 %.
    """
    wanted = "points spread over a surface"
    if len(points) < 4:
        raise refuse("point cloud", wanted, f"{len(points)} in different places", "check the file")
    try:
        stiffness, mass = robust_laplacian.point_cloud_laplacian(points, n_neighbors=min(30, len(points) - 1))
    except RuntimeError as error:  # no triangle at all
        raise refuse("point cloud", wanted, "points on a line", "check the file") from error
    areas = mass.diagonal()
    if not (areas.sum() > 0 and np.isfinite(areas).all()):
        raise refuse("point cloud", wanted, "points without area around them", "check the file")
    return stiffness, areas


def cloud_areas(points: np.ndarray) -> np.ndarray:
    """Return the area that each of ``points (n, 3)`` stands for, (n,), by :func:`cloud_laplacian`.

    The first of coincident points has the area of all.
    """
    first = np.unique(unique_vertices(points))
    areas = np.zeros(len(points))
    areas[first] = cloud_laplacian(points[first])[1]
    return areas


def cloud_edges(points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return pairs of neighbouring ``points (n, 3)`` and their distances: ``(a (m,), b (m,), length (m,))``.

    Each point is linked to its 12 nearest. Components, such as a cat's ears, whose points are closer to each other than
    to the head, are joined to one by the shortest links.
    """
    n = len(points)
    lengths, index = KDTree(points).query(points, k=min(_NEIGHBOURS + 1, n))  # each point is one of its own
    lengths, index = np.reshape(lengths, (n, -1)), np.reshape(index, (n, -1))
    a, b, lengths = np.repeat(np.arange(n), index.shape[1]), index.ravel(), lengths.ravel()
    count, component = component_labels(n, a, b)
    if count == 1:
        return a, b, lengths
    c, d, bridges = _bridges(points, count, component)
    return np.concatenate([a, c]), np.concatenate([b, d]), np.concatenate([lengths, bridges])


def _bridges(points: np.ndarray, count: int, component: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the links of the shortest tree that joins the ``count`` components, as :func:`cloud_edges` does.

    They are edges of the Delaunay complex of the points.
    """
    # Joggled (QJ), so that points in a plane or on a line have one too; every component has at least 13 points.
    simplices = Delaunay(points, qhull_options="QJ").simplices
    i, j = np.triu_indices(4, 1)
    a, b = simplices[:, i].ravel(), simplices[:, j].ravel()
    between = component[a] != component[b]
    a, b = a[between], b[between]
    lengths = np.linalg.norm(points[a] - points[b], axis=1)
    key = np.minimum(component[a], component[b]) * count + np.maximum(component[a], component[b])
    order = np.lexsort((np.maximum(a, b), np.minimum(a, b), lengths, key))
    shortest = order[np.unique(key[order], return_index=True)[1]]
    a, b, lengths = a[shortest], b[shortest], lengths[shortest]
    # Ranks from 1 instead of lengths, since zero would be no link and equal lengths must differ.
    rank = np.empty(len(lengths))
    rank[np.argsort(lengths, kind="stable")] = np.arange(1, len(lengths) + 1)
    tree = minimum_spanning_tree(coo_array((rank, (component[a], component[b])), shape=(count, count)).tocsr())
    in_tree = np.isin(rank, tree.data)
    return a[in_tree], b[in_tree], lengths[in_tree]
