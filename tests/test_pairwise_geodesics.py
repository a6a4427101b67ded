"""Laws of distances between points: exact near by, hardly longer elsewhere, and nowhere lost."""

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

from conftest import blob
from kfmaps.geometry import geodesics
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.geodesics import _FULL_SEARCHES, _NEARBY, farthest_geodesic, pairwise_geodesics
from kfmaps.geometry.mesh import Mesh, unit_area

GUARDS = ("kfmaps.geometry.geodesics",)

MESH = unit_area(blob(1500))


@pytest.fixture(scope="module")
def spread():
    return farthest_geodesic(MESH, 300, 0)


def exact(graph, points):
    return np.asarray(dijkstra(graph, indices=points))[:, points]


def test_near_points_are_exact_and_far_ones_hardly_farther(spread):
    graph = geodesic_graph(MESH, 1)
    true, found = exact(graph, spread), pairwise_geodesics(graph, spread)
    known = true <= _NEARBY
    known[:_FULL_SEARCHES] = known[:, :_FULL_SEARCHES] = True
    np.testing.assert_allclose(found[known], true[known], rtol=1e-12)
    assert (found >= (1 - 1e-6) * true).all()  # paths over others are added in single precision
    over = (found - true)[~known] / true[~known]
    assert 0 < over.mean() < 0.005
    assert over.max() < 0.15
    assert (found - true).mean() < 1e-3 * true.mean()
    np.testing.assert_allclose(found, found.T, rtol=1e-12)


def test_few_points_are_exact(spread):
    graph = geodesic_graph(MESH, 1)
    np.testing.assert_allclose(pairwise_geodesics(graph, spread[:50]), exact(graph, spread[:50]), rtol=1e-12)


def test_components_are_infinitely_far_and_none_is_forgotten(monkeypatch):
    """Even one that none of the first points lies on."""
    n = len(MESH.vertices)
    both = Mesh(np.vstack([MESH.vertices, MESH.vertices + 5.0]), np.vstack([MESH.faces, MESH.faces + n]))
    points = np.concatenate([np.arange(0, n, 50), n + np.arange(0, n, 50)])
    monkeypatch.setattr(geodesics, "_FULL_SEARCHES", 10)
    graph = geodesic_graph(both, 1)
    true, found = exact(graph, points), pairwise_geodesics(graph, points)
    np.testing.assert_array_equal(np.isinf(found), np.isinf(true))
    apart = np.isfinite(true)
    assert (found[apart] >= (1 - 1e-6) * true[apart]).all()
    later = np.ix_(points >= n, points >= n)
    np.testing.assert_allclose(found[later], true[later], rtol=1e-12)
