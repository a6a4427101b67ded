"""Eigenfunctions in the span of hat functions on a coarse proxy."""

import numpy as np
import pytest

import kfmaps.shape as shape_module
from conftest import joined, two_poses
from kfmaps.geometry import coarse_basis as module
from kfmaps.geometry.basis import Basis, laplace_basis
from kfmaps.geometry.coarse_basis import coarse_basis
from kfmaps.geometry.coarsen import coarse_proxy, spread_vertices
from kfmaps.geometry.mesh import Mesh, unit_area

GUARDS = ("kfmaps.geometry.coarse_basis",)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MIN_PROXY_VERTICES", 900)
    monkeypatch.setattr(module, "VERTICES_PER_FUNCTION", 30)


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return unit_area(two_poses(3000).source)


def sines(one: Basis, other: Basis) -> np.ndarray:
    """Sines of the angles between the functions of one basis and the span of another."""
    within = one.functions.T @ (one.mass[:, None] * other.functions)
    return np.sqrt(np.maximum(1 - np.linalg.svd(within, compute_uv=False) ** 2, 0))


@pytest.mark.usefixtures("few")
def test_functions_are_orthonormal_and_values_are_upper_bounds(mesh: Mesh) -> None:
    found, exact = coarse_basis(mesh, 30, "robust", 1e-2), laplace_basis(mesh, 30)
    np.testing.assert_allclose(found.project(found.functions), np.eye(30), atol=1e-12)
    np.testing.assert_array_equal(found.mass, exact.mass)
    assert (found.eigenvalues >= exact.eigenvalues - 1e-6).all()
    np.testing.assert_allclose(found.eigenvalues[1:], exact.eigenvalues[1:], rtol=0.06)
    assert sines(found.truncate(20), exact).max() < 0.05
    np.testing.assert_allclose(found.functions[:, 0], 1.0, rtol=1e-3)
    assert (found.functions.max(axis=0) >= -found.functions.min(axis=0)).all()
    assert found.functions.flags.f_contiguous


@pytest.mark.usefixtures("few")
def test_the_quadratic_form_is_that_of_the_mesh(mesh: Mesh) -> None:
    found = coarse_basis(mesh, 30, "cotangent", 1e-10)
    stiffness, _ = module.laplace_operators(mesh, "cotangent", 30)
    energies = found.functions.T @ (stiffness @ found.functions)
    np.testing.assert_allclose(energies, np.diag(found.eigenvalues), atol=1e-9 * found.eigenvalues[-1])


def test_with_all_vertices_it_is_the_basis_itself(mesh: Mesh) -> None:
    found, exact = coarse_basis(mesh, 20, "robust", 1e-10), laplace_basis(mesh, 20)
    np.testing.assert_allclose(found.eigenvalues, exact.eigenvalues, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(found.functions, exact.functions, atol=1e-6)


def test_more_functions_have_a_larger_proxy() -> None:
    assert module.n_proxy_vertices(50) == module.n_proxy_vertices(100) == 30_000
    assert module.n_proxy_vertices(200) == 60_000


@pytest.mark.usefixtures("few")
def test_a_bridge_without_faces_on_the_proxy_still_connects(mesh: Mesh) -> None:
    n, tip = len(mesh.vertices), mesh.vertices[:, 0].argmax()
    face = mesh.faces[(mesh.faces == tip).any(axis=1)][0]
    edge = np.array([tip, face[face != tip][0]])
    length = np.linalg.norm(np.diff(mesh.vertices[edge], axis=0))
    other = [2 * mesh.vertices[tip, 0] + length, 0, 0] + mesh.vertices * [-1, 1, 1]  # its mirror image, tip to tip
    apart = joined(mesh, Mesh(other, mesh.faces))
    bridge = np.array([[edge[1], edge[0], edge[0] + n], [edge[1], edge[0] + n, edge[1] + n]])
    bridged = unit_area(Mesh(apart.vertices, np.concatenate([apart.faces, bridge])))
    proxy = coarse_proxy(bridged, spread_vertices(bridged, 900)).mesh
    assert (laplace_basis(proxy, 10).eigenvalues < 1e-6).sum() == 2  # the proxy falls into pieces
    found, exact = coarse_basis(bridged, 10, "robust", 1e-2), laplace_basis(bridged, 10)
    assert 1e-3 < exact.eigenvalues[1] <= found.eigenvalues[1] < 1.2 * exact.eigenvalues[1]
    assert sines(found.truncate(6), exact).max() < 0.1


@pytest.mark.usefixtures("few")
def test_of_a_mesh_whose_proxy_has_hardly_a_face_the_functions_are_exact() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]) + 3 * np.arange(1000)[:, None, None]
    loose = unit_area(Mesh(corners.reshape(-1, 3), np.arange(3000).reshape(-1, 3)))
    found, exact = coarse_basis(loose, 5, "cotangent", 1e-2), laplace_basis(loose, 5, "cotangent", tolerance=1e-2)
    np.testing.assert_array_equal(found.functions, exact.functions)


@pytest.mark.usefixtures("few")
def test_functions_do_not_leap_from_one_wall_to_another(mesh: Mesh) -> None:
    """Two surfaces nearer to each other than the vertices of the proxy have functions of their own."""
    pair = unit_area(joined(mesh, Mesh(mesh.vertices * 0.995 + 1e-3, mesh.faces)))
    found = coarse_basis(pair, 20, "robust", 1e-2)
    n = len(mesh.vertices)
    assert (found.eigenvalues[:2] < 1e-6).all()
    assert found.eigenvalues[2] > 0.1
    steps = np.ptp(found.functions[:n, :2], axis=0), np.ptp(found.functions[n:, :2], axis=0)
    np.testing.assert_allclose(steps, 0, atol=1e-4)


@pytest.mark.usefixtures("few")
def test_large_meshes_are_prepared_so(mesh: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    def spy(one: Mesh, k: int, *rest: object) -> Basis:
        asked.append(k)
        return coarse_basis(one, k, *rest)  # pyright: ignore[reportArgumentType]

    monkeypatch.setattr(shape_module, "coarse_basis", spy)
    for limit, count in ((1499, 1), (1501, 0)):
        asked.clear()
        monkeypatch.setattr(module, "MIN_PROXY_VERTICES", limit)
        monkeypatch.setattr(module, "VERTICES_PER_FUNCTION", 1)
        shape = shape_module.prepare(mesh)
        assert len(asked) == count
        assert shape.basis.functions.shape == (len(mesh.vertices), 100)
