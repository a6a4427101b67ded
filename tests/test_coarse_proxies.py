"""A mesh that follows a coarse copy of itself, and the non-rigid fit of large meshes that begins with one."""

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

from conftest import NO_FACES, joined, rotation, two_poses
from kfmaps import datasets
from kfmaps.geometry.arap import build_arap, rotations
from kfmaps.geometry.coarsen import CoarseProxy, coarse_proxy, embedded_deformation, spread_vertices
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.registration import deformable, nonrigid_icp
from kfmaps.registration.nonrigid_icp import NonRigid

GUARDS = ("kfmaps.geometry.arap", "kfmaps.geometry.coarsen", "kfmaps.registration.nonrigid_icp")


@pytest.fixture(scope="module")
def pair() -> datasets.ExamplePair:
    return two_poses(3000)


@pytest.fixture(scope="module")
def mesh(pair: datasets.ExamplePair) -> Mesh:
    return unit_area(pair.source)


@pytest.fixture(scope="module")
def proxy(mesh: Mesh) -> CoarseProxy:
    return coarse_proxy(mesh, spread_vertices(mesh, 600, np.array([7, 2000])))


def test_every_vertex_belongs_to_the_nearest_vertex_of_the_proxy(mesh: Mesh, proxy: CoarseProxy) -> None:
    assert 550 < len(proxy.vertices) < 620
    assert np.isin([7, 2000], proxy.vertices).all()
    np.testing.assert_array_equal(proxy.owner[proxy.vertices], np.arange(len(proxy.vertices)))
    np.testing.assert_array_equal(proxy.mesh.vertices, mesh.vertices[proxy.vertices])
    assert (np.bincount(proxy.mesh.faces.ravel(), minlength=len(proxy.vertices)) > 0).all()
    away = dijkstra(geodesic_graph(mesh, 0), indices=proxy.vertices)
    np.testing.assert_allclose(away[proxy.owner, np.arange(len(mesh.vertices))], away.min(axis=0))


def test_a_small_mesh_is_its_own_proxy(mesh: Mesh) -> None:
    proxy = coarse_proxy(mesh, spread_vertices(mesh, 3000))
    assert proxy.mesh is mesh
    np.testing.assert_array_equal(proxy.owner, np.arange(3000))


def test_vertices_that_nothing_reaches_belong_to_the_nearest_in_space(mesh: Mesh) -> None:
    loose = mesh.vertices[[5, 100]] + 1e-4
    with_loose = joined(mesh, Mesh(loose, NO_FACES))
    proxy = coarse_proxy(with_loose, spread_vertices(with_loose, 600))
    for vertex in (-2, -1):
        away = np.linalg.norm(proxy.mesh.vertices - loose[vertex], axis=1)
        assert proxy.owner[vertex] == away.argmin()


def test_a_motion_of_the_proxy_is_that_of_the_mesh(mesh: Mesh, proxy: CoarseProxy) -> None:
    turn = rotation(0)
    turns = np.broadcast_to(turn, (len(proxy.vertices), 3, 3))
    moved = embedded_deformation(proxy, mesh, proxy.mesh.vertices @ turn.T + 1.0, turns)
    np.testing.assert_allclose(moved, mesh.vertices @ turn.T + 1.0, atol=1e-12)


def test_a_mesh_deforms_as_its_proxy_does(mesh: Mesh, proxy: CoarseProxy) -> None:
    def registered(x: np.ndarray) -> np.ndarray:
        angle = 1.5 * x[:, 1]
        turned = np.cos(angle) * x[:, 0] - np.sin(angle) * x[:, 2], np.sin(angle) * x[:, 0] + np.cos(angle) * x[:, 2]
        return np.stack([turned[0], x[:, 1], turned[1]], axis=1)

    there = registered(proxy.mesh.vertices)
    found = embedded_deformation(proxy, mesh, there, rotations(build_arap(proxy.mesh), there))
    off = np.linalg.norm(found - registered(mesh.vertices), axis=1)
    snapped = np.linalg.norm(there[proxy.owner] - registered(mesh.vertices), axis=1)
    assert off.mean() < 0.1 * snapped.mean()
    assert off.max() < 0.5 * snapped.max()


def test_a_large_mesh_is_registered_as_well_with_its_proxy_first(
    pair: datasets.ExamplePair, monkeypatch: pytest.MonkeyPatch
) -> None:
    source, target = unit_area(pair.source), unit_area(pair.target)
    truth = source.vertices[pair.truth]
    slid = truth + 0.03 * np.sin(7 * truth[:, [1, 2, 0]])
    start = np.linalg.norm(slid[:, None] - source.vertices[None], axis=2).argmin(axis=1)

    def off(landmark_vertices: np.ndarray | None = None) -> tuple[np.ndarray, float]:
        done: list[float] = []
        found = NonRigid()(source, target, start, progress=done.append, landmarks=landmark_vertices)
        assert (np.diff(done) >= 0).all()
        assert done[-1] == pytest.approx(1)
        places = np.einsum("ti,tij->tj", found.weights, source.vertices[source.faces[found.faces]])
        return np.linalg.norm(places - truth, axis=1), found.gap

    whole, gap = off()
    monkeypatch.setattr(nonrigid_icp, "_PROXY_FROM", 2000)
    monkeypatch.setattr(nonrigid_icp, "_PROXY_VERTICES", 1500)
    quick, quick_gap = off()
    assert quick.mean() < 1.1 * whole.mean() < 0.6 * np.linalg.norm(source.vertices[start] - truth, axis=1).mean()
    assert quick_gap < 1.1 * gap
    worst = int(quick.argmax())
    marked, _ = off(np.array([[pair.truth[worst], worst]]))
    assert marked[worst] < 0.85 * quick[worst], (marked[worst], quick[worst], whole[worst])
    sizes: list[int] = []
    solver = deformable.DeformableMesh.solver
    monkeypatch.setattr(
        deformable.DeformableMesh, "solver", lambda self, *rest: sizes.append(len(self.areas)) or solver(self, *rest)
    )
    monkeypatch.setattr(nonrigid_icp, "_FINE_PROXY_FROM", 2000)
    monkeypatch.setattr(nonrigid_icp, "_FINE_PROXY_VERTICES", 1900)
    finest, finest_gap = off()
    assert finest.mean() < 1.1 * whole.mean()
    assert finest_gap < 3 * gap  # of coarse surfaces
    # Nothing is factorised that has all vertices.
    assert 1500 < max(sizes) <= 1900 < len(source.vertices)
