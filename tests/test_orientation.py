"""The orientation operators against loops, against analysis, and their laws."""

from __future__ import annotations

import numpy as np
import pytest

from conftest import blob, cloud_of, fibonacci_sphere, inside_out, random_basis, reordered, rotation, sheet
from kfmaps._arrays import InvalidInput
from kfmaps._threads import limit_threads
from kfmaps.geometry.basis import Basis, laplace_basis
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.geometry.orientation_operators import orientation_operators

GUARDS = ("kfmaps.geometry.orientation_operators",)


def square(m: int) -> Mesh:
    """A unit square of m × m vertices, seen from above."""
    return sheet(*2 * [np.linspace(0, 1, m)])


def plain(mesh: Mesh, basis: Basis, w: np.ndarray) -> np.ndarray:
    """``∫ φᵢ n · (∇w × ∇φⱼ)``, face by face with gradients in space."""
    k = basis.functions.shape[1]
    result = np.zeros((k, k))
    for face in mesh.faces:
        a, b, c = mesh.vertices[face]
        normal = np.cross(b - a, c - a)
        area = np.linalg.norm(normal) / 2
        normal = normal / (2 * area)
        hats = np.array([np.cross(normal, e) for e in (c - b, a - c, b - a)]) / (2 * area)  # gradients
        gradient_w = w[face] @ hats
        for i in range(k):
            mean = basis.functions[face, i].mean()
            for j in range(k):
                result[i, j] += area * mean * (normal @ np.cross(gradient_w, basis.functions[face, j] @ hats))
    return result


@pytest.mark.parametrize("mesh", [blob(60), square(6)], ids=["closed", "with a boundary"])
def test_agrees_with_the_antisymmetric_part_of_loops_over_the_faces(mesh, rng):
    n = len(mesh.vertices)
    basis, functions = random_basis(n, 4, rng), rng.normal(size=(n, 3))
    found = orientation_operators(mesh, basis, functions)
    np.testing.assert_array_equal(found, -found.transpose(0, 2, 1))
    for s in range(3):
        whole = plain(mesh, basis, functions[:, s])
        np.testing.assert_allclose(found[s], (whole - whole.T) / 2, atol=1e-12)


def test_constants_and_the_function_itself_are_annihilated(small_mesh, small_basis):
    phi = small_basis.functions
    operators = orientation_operators(small_mesh, small_basis, np.column_stack([np.ones(len(phi)), phi[:, 5]]))
    np.testing.assert_allclose(operators[0], 0, atol=1e-10)
    np.testing.assert_allclose(operators[1][:, 5], 0, atol=1e-10)  # ∇w × ∇w
    np.testing.assert_allclose(operators[1][:, 0], 0, atol=1e-8)  # the gradient of a constant
    assert np.abs(operators[1]).max() > 1


@pytest.mark.parametrize("sign", [1, -1], ids=["rotation", "mirror"])
def test_rotation_changes_nothing_scale_divides_by_area_and_a_mirror_flips_the_sign(small_mesh, sign):
    moved = Mesh(3.0 * small_mesh.vertices * np.array([1.0, sign, 1.0]) @ rotation(1).T + 1.0, small_mesh.faces)
    moved = moved if sign == 1 else inside_out(moved)
    own, other = laplace_basis(small_mesh, 12), laplace_basis(moved, 12)
    # The identity between the vertices carries functions; eigenfunctions may differ in sign.
    C = other.project(own.functions) / 3.0
    functions = small_mesh.vertices
    a, b = orientation_operators(small_mesh, own, functions), orientation_operators(moved, other, functions)
    np.testing.assert_allclose(9.0 * b, sign * C @ a @ C.T, atol=1e-6)
    assert np.abs(a).max() > 1


def test_order_of_the_faces_corners_and_vertices_changes_nothing(small_mesh, small_basis, rng):
    order = rng.permutation(len(small_mesh.vertices))
    other = reordered(small_mesh, order)
    other = Mesh(other.vertices, np.roll(other.faces, 1, axis=1)[rng.permutation(len(other.faces))])
    basis = Basis(small_basis.eigenvalues, small_basis.functions[order], small_basis.mass[order])
    functions = rng.normal(size=(len(order), 3))
    one = orientation_operators(small_mesh, small_basis, functions)
    np.testing.assert_allclose(orientation_operators(other, basis, functions[order]), one, atol=1e-9)


def test_on_the_sphere_it_is_rotation_about_an_axis():
    # On the unit sphere n × ∇z turns about the z axis: Ω_z[x] = −y … so the coordinates span so(3), and
    # ∫ x² = 4π/3. A basis of the coordinates themselves, orthonormal, gives the Levi-Civita symbol.
    sphere = fibonacci_sphere(3000)
    scale = np.sqrt(3 / (4 * np.pi))
    basis = Basis(np.full(3, 2.0), sphere.vertices * scale, np.full(3000, 4 * np.pi / 3000))
    symbol = np.zeros((3, 3, 3))
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        # n · (∇x_b × ∇x_c) = x_a: entry (i, j) of operator s is ∫ φᵢ n · (∇x_s × ∇φⱼ).
        symbol[b, a, c], symbol[c, a, b] = 1, -1
    np.testing.assert_allclose(orientation_operators(sphere, basis, sphere.vertices), symbol, atol=0.005)


def test_on_the_square_it_converges_with_the_square_of_the_spacing():
    # Sines vanish on the boundary, so the operator is antisymmetric there too.
    def error(m: int) -> float:
        mesh = square(m)
        x, y = mesh.vertices[:, 0], mesh.vertices[:, 1]
        h, g = np.sin(np.pi * x) * np.sin(np.pi * y), np.sin(2 * np.pi * x) * np.sin(np.pi * y)
        basis = Basis(np.zeros(2), np.stack([h, g], axis=1), np.full(m * m, 1 / m**2))
        # w = y²: n · (∇w × ∇g) = −2y ∂g/∂x, and ∫ h (−2y) 2π cos(2πx) sin(πy) = −4π · (−2/3π) · 1/4.
        return abs(orientation_operators(mesh, basis, (y**2)[:, None])[0, 0, 1] - 2 / 3)

    assert error(61) < 2e-3
    assert error(61) < error(31) / 3.5


def test_it_is_linear_and_threads_and_libraries_agree(convert, rng):
    mesh = unit_area(blob(200))
    basis, functions = laplace_basis(mesh, 8), rng.normal(size=(200, 5))
    with limit_threads(1):
        plainly = orientation_operators(mesh, basis, functions)
    mixed = orientation_operators(mesh, basis, functions[:, :2] @ [[2.0], [-1.0]])[0]
    np.testing.assert_allclose(mixed, 2 * plainly[0] - plainly[1], atol=1e-9)
    with limit_threads(3):
        np.testing.assert_array_equal(plainly, orientation_operators(mesh, basis, functions))
    other = convert(basis)
    operators = orientation_operators(mesh, other, functions)
    assert type(operators) is type(other.functions)
    np.testing.assert_allclose(np.from_dlpack(operators), plainly, atol=1e-12)


def test_refuses_what_does_not_fit(small_mesh, small_basis):
    n = len(small_mesh.vertices)
    with pytest.raises(InvalidInput, match="Triangulate"):
        orientation_operators(cloud_of(small_mesh), small_basis, np.ones((n, 1)))
    with pytest.raises(InvalidInput, match="functions"):
        orientation_operators(small_mesh, small_basis, np.ones((n - 1, 1)))
    with pytest.raises(InvalidInput, match="basis"):
        orientation_operators(blob(50), small_basis, np.ones((50, 1)))
    with pytest.raises(InvalidInput, match="functions"):
        orientation_operators(small_mesh, small_basis, np.full((n, 1), np.nan))
