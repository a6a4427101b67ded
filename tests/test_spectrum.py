"""Laws of the Laplace basis."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from conftest import blob, cloud_of, fibonacci_sphere, joined, reordered, rotation, sheet
from kfmaps._arrays import InvalidInput, MissingDependency, to_numpy
from kfmaps.geometry.basis import Basis, cotangent_laplacian, laplace_basis
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area, vertex_areas

GUARDS = ("kfmaps.geometry.basis", "kfmaps.geometry.eigen.eigensolver", "kfmaps.geometry.mesh")

LAPLACIANS = ("robust", "cotangent")


def grid(columns: int, rows: int, width: float = 1.0, height: float = 1.0) -> Mesh:
    """A flat rectangle with its corner at the origin, its inner vertices moved a little off the lattice."""
    flat = sheet(np.linspace(0, width, columns), np.linspace(0, height, rows))
    inner = ((flat.vertices > 0) & (flat.vertices < [width, height, 1]))[:, :2].all(axis=1)
    shift = np.random.default_rng(1).uniform(-0.2, 0.2, (inner.sum(), 2)) * [width / (columns - 1), height / (rows - 1)]
    flat.vertices[inner, :2] += shift
    return flat


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return unit_area(blob(500))


@pytest.fixture(scope="module")
def basis(mesh: Mesh) -> Basis:
    return laplace_basis(mesh, 25)


def test_functions_are_orthonormal_in_every_array_library(basis: Basis, asarray: Callable[[Any], Any]) -> None:
    mine = Basis(asarray(basis.eigenvalues), asarray(basis.functions), asarray(basis.mass))
    np.testing.assert_allclose(to_numpy(mine.project(mine.functions)), np.eye(25), atol=1e-11)
    coefficients = asarray(np.random.default_rng(0).normal(size=(25, 3)))
    np.testing.assert_allclose(
        to_numpy(mine.project(mine.reconstruct(coefficients))), to_numpy(coefficients), atol=1e-11
    )
    short = mine.truncate(7)
    assert short.eigenvalues.shape == (7,)
    np.testing.assert_array_equal(to_numpy(short.functions), basis.functions[:, :7])


def test_constant_comes_first_and_mass_is_the_area(mesh: Mesh, basis: Basis) -> None:
    assert abs(basis.eigenvalues[0]) < 1e-9 < basis.eigenvalues[1]
    np.testing.assert_allclose(abs(basis.functions[:, 0]), 1, atol=1e-8)
    assert abs(basis.functions[:, 0].sum()) == pytest.approx(len(mesh.vertices))
    assert basis.mass.sum() == pytest.approx(surface_area(mesh), rel=1e-4)
    np.testing.assert_allclose(laplace_basis(mesh, 3, "cotangent").mass, vertex_areas(mesh), rtol=1e-12)


@pytest.mark.parametrize("laplacian", LAPLACIANS)
def test_sphere_converges_at_second_order(laplacian: str) -> None:
    exact = 4 * np.pi * np.repeat([2.0, 6.0, 12.0], [3, 5, 7])
    errors = [
        np.abs(laplace_basis(unit_area(fibonacci_sphere(n)), 16, laplacian).eigenvalues[1:] - exact).max() / exact.max()
        for n in (500, 2000)
    ]
    assert errors[1] < 0.01
    assert 3 < errors[0] / errors[1] < 6  # half the edge length: a quarter of the error


@pytest.mark.parametrize("laplacian", LAPLACIANS)
def test_rectangle_has_neumann_eigenvalues(laplacian: str) -> None:
    got = laplace_basis(grid(41, 31, 1.0, 0.75), 15, laplacian).eigenvalues
    i, j = np.mgrid[:15, :15]
    exact = np.sort((np.pi**2 * (i**2 + (j / 0.75) ** 2)).ravel())[:15]
    np.testing.assert_allclose(got, exact, rtol=0.02, atol=1e-9)


@pytest.mark.parametrize("laplacian", LAPLACIANS)
def test_rigid_motion_scale_and_order_of_vertices(mesh: Mesh, laplacian: str) -> None:
    one = laplace_basis(mesh, 15, laplacian)
    order = np.random.default_rng(2).permutation(len(mesh.vertices))
    moved = Mesh(3.0 * mesh.vertices @ rotation(4).T + [1.0, -2.0, 5.0], mesh.faces)
    other = laplace_basis(reordered(moved, order), 15, laplacian)
    np.testing.assert_allclose(other.eigenvalues * 9, one.eigenvalues, rtol=1e-7, atol=1e-8)
    np.testing.assert_allclose(other.functions * 3, one.functions[order], atol=1e-5)  # signs included
    np.testing.assert_allclose(other.mass / 9, one.mass[order], rtol=1e-7)


@pytest.mark.parametrize("laplacian", LAPLACIANS)
def test_unused_vertices_change_nothing(mesh: Mesh, laplacian: str) -> None:
    extra = mesh.vertices[[7, 90]] * 1.01  # just outside: the nearest are 7 and 90
    wider = Mesh(np.concatenate([extra[:1], mesh.vertices, extra[1:]]), mesh.faces + 1)
    one, other = laplace_basis(mesh, 10, laplacian), laplace_basis(wider, 10, laplacian)
    np.testing.assert_array_equal(other.eigenvalues, one.eigenvalues)
    np.testing.assert_array_equal(other.functions, one.functions[np.r_[7, : len(mesh.vertices), 90]])
    np.testing.assert_array_equal(other.mass, np.r_[0, one.mass, 0])


@pytest.mark.parametrize("laplacian", LAPLACIANS)
def test_faces_without_area_do_little_harm(mesh: Mesh, laplacian: str) -> None:
    a, b, c = mesh.faces[10]
    middle = (mesh.vertices[a] + mesh.vertices[b]) / 2
    n = len(mesh.vertices)
    faces = np.concatenate([mesh.faces, [[a, b, n], [a, a, b], [c, c, c]]])  # a needle, two that are no triangles
    other = laplace_basis(Mesh(np.concatenate([mesh.vertices, middle[None]]), faces), 10, laplacian)
    one = laplace_basis(mesh, 10, laplacian)
    np.testing.assert_allclose(other.eigenvalues, one.eigenvalues, rtol=0.02, atol=1e-8)
    np.testing.assert_allclose(np.abs(other.functions[-1]), np.abs(other.functions[[a, b]]).mean(axis=0), atol=0.3)


@pytest.mark.parametrize("laplacian", LAPLACIANS)
@pytest.mark.parametrize(("speck", "size"), [(blob(300), 1e-4), (blob(12), 1e-5)])
def test_a_floating_speck_only_adds_a_zero(laplacian: str, speck: Mesh, size: float) -> None:
    mesh = blob(1500)
    both = joined(mesh, Mesh(size * speck.vertices + np.array([3.0, 0, 0]), speck.faces))
    one, other = laplace_basis(mesh, 99, laplacian), laplace_basis(both, 100, laplacian)
    assert abs(other.eigenvalues[1]) < 1e-3  # the speck's constant, of the order of what its mass was raised by
    np.testing.assert_allclose(other.eigenvalues[2:], one.eigenvalues[1:], rtol=1e-6)


def test_thin_faces_count_as_ones_with_longer_edges() -> None:
    for corners in (
        [[0, 0, 0], [1, 0, 0], [0.3, 1e-9, 0]],
        [[0, 0, 0], [1, 0, 0], [1, 1e-8, 0]],
        [[0, 0, 0], [2, 0, 0], [2, 0, 0]],
    ):
        thin = np.array(corners, dtype=float)
        a, b, c = (np.linalg.norm(thin[i] - thin[j]) for i, j in ((1, 2), (2, 0), (0, 1)))
        a, b, c = np.array([a, b, c]) + 1e-6 * max(a, b, c)
        x = (b**2 + c**2 - a**2) / (2 * c)
        longer = np.array([[0, 0, 0], [c, 0, 0], [x, np.sqrt(b**2 - x**2), 0]])
        one, other = (cotangent_laplacian(Mesh(v, np.array([[0, 1, 2]]))).toarray() for v in (thin, longer))
        np.testing.assert_allclose(one, other, rtol=1e-3)


@pytest.mark.parametrize("height", [1e-4, 3e-6, 1e-7, 0.0])
def test_a_cap_does_little_harm(height: float) -> None:
    mesh = unit_area(blob(1500))
    i, j, k = mesh.faces[0]
    vertices = mesh.vertices.copy()
    middle = (vertices[i] + vertices[j]) / 2
    vertices[k] = middle + height * (vertices[k] - middle)
    capped = Mesh(vertices, mesh.faces)
    one, other = laplace_basis(mesh, 40, "cotangent"), laplace_basis(capped, 40, "cotangent")
    np.testing.assert_allclose(other.eigenvalues, one.eigenvalues, rtol=0.01, atol=1e-9)


def test_no_triangle_has_a_negative_energy() -> None:
    rng = np.random.default_rng(0)
    for size in 10.0 ** -np.arange(20):
        a, b, along = rng.normal(size=3), rng.normal(size=3), rng.uniform(0, 1)
        third = a + along * (b - a) + size * rng.normal(size=3)
        stiffness = cotangent_laplacian(Mesh(np.stack([a, b, third]), np.array([[0, 1, 2]]))).toarray()
        values = np.linalg.eigvalsh(stiffness)
        assert values[0] >= -1e-12 * values[-1]
        np.testing.assert_allclose(stiffness.sum(axis=1), 0, atol=1e-12 * values[-1])


@pytest.mark.parametrize("laplacian", LAPLACIANS)
def test_branching_edges(laplacian: str) -> None:
    page = grid(9, 9)
    n = len(page.vertices)
    spine = page.vertices[:, 0] < 1e-12
    number, sheets, faces = np.flatnonzero(spine), [page.vertices[spine]], []
    for angle in (0.3, 2.4, 4.5):
        keep = np.flatnonzero(~spine)
        index = np.empty(n, dtype=int)
        index[number] = np.arange(len(number))
        index[keep] = sum(map(len, sheets)) + np.arange(len(keep))
        x, y = page.vertices[keep, 0], page.vertices[keep, 1]
        sheets.append(np.stack([x * np.cos(angle), y, x * np.sin(angle)], axis=1))
        faces.append(index[page.faces])
    book = laplace_basis(Mesh(np.concatenate(sheets), np.concatenate(faces)), 8, laplacian)
    assert book.mass.sum() == pytest.approx(3, rel=1e-4)
    # What vanishes on the spine, and differs from page to page, is a quarter wave: twice π²/4.
    np.testing.assert_allclose(book.eigenvalues[:3], [0, np.pi**2 / 4, np.pi**2 / 4], rtol=0.03, atol=1e-9)


def test_cloud_agrees_with_its_mesh() -> None:
    mesh = unit_area(blob(1500))
    surface, cloud = laplace_basis(mesh, 20), laplace_basis(cloud_of(Mesh(7 * mesh.vertices, mesh.faces)), 20)
    assert cloud.mass.sum() == pytest.approx(49, rel=0.02)  # in the cloud's own unit, like a mesh's
    np.testing.assert_allclose(49 * cloud.eigenvalues, surface.eigenvalues, rtol=0.02, atol=1e-9)
    overlap = 7 * surface.functions.T @ (surface.mass[:, None] * cloud.functions)
    np.testing.assert_allclose(np.abs(np.diag(overlap))[:16], 1, atol=0.03)  # the next two are close


def test_small_clouds() -> None:
    points = np.random.default_rng(0).normal(size=(12, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    basis = laplace_basis(Mesh(points, np.zeros((0, 3))), 4)
    np.testing.assert_allclose(basis.project(basis.functions), np.eye(4), atol=1e-9)


def test_cotangent_laplacian_is_exact_on_linear_functions() -> None:
    flat = grid(8, 6, 2.0, 1.0)
    stiffness = cotangent_laplacian(flat).toarray()
    np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-14)
    np.testing.assert_allclose(stiffness.sum(axis=1), 0, atol=1e-13)
    assert np.linalg.eigvalsh(stiffness).min() > -1e-12
    f = flat.vertices @ [3.0, -1.0, 0.0]
    assert f @ stiffness @ f == pytest.approx(10 * 2.0)  # |gradient|² times the area
    inner = ((flat.vertices > 0) & (flat.vertices < [2, 1, 1]))[:, :2].all(axis=1)
    np.testing.assert_allclose((stiffness @ f)[inner], 0, atol=1e-12)


def test_bad_input_is_refused(mesh: Mesh, basis: Basis) -> None:
    n = len(mesh.vertices)
    with pytest.raises(InvalidInput, match=f"{n} vertices in use"):
        laplace_basis(mesh, n)
    with pytest.raises(InvalidInput, match="whole number"):
        laplace_basis(mesh, 0)
    with pytest.raises(InvalidInput, match="magic"):
        laplace_basis(mesh, 5, "magic")
    with pytest.raises(InvalidInput, match="from 1 to 25"):
        basis.truncate(26)


def test_to_device(basis: Basis, monkeypatch: pytest.MonkeyPatch) -> None:
    assert isinstance(basis.to("cpu").functions, np.ndarray)
    torch = pytest.importorskip("torch")
    device = "cuda" if torch.cuda.is_available() else "cpu:0"
    there = basis.to(device)
    assert there.functions.dtype == torch.float64
    assert there.functions.device.type == device.split(":")[0]
    for back in ("cpu", "numpy"):
        np.testing.assert_array_equal(there.to(back).functions, basis.functions)
    with pytest.raises(InvalidInput, match="expected a device that PyTorch can use"):
        basis.to("magic")
    monkeypatch.setitem(sys.modules, "torch", None)
    with pytest.raises(MissingDependency, match=r"kfmaps\[gpu\]"):
        basis.to("cuda")
