"""Laws of the sparse eigensolver."""

from __future__ import annotations

import numpy as np
import pytest
import robust_laplacian
from scipy.linalg import eigh
from scipy.sparse import block_diag, csr_array, eye_array, kron
from scipy.sparse.linalg import splu

from conftest import blob, fibonacci_sphere
from kfmaps._arrays import InvalidInput, NotConverged
from kfmaps._threads import one_blas_thread
from kfmaps.geometry.eigen import factorization, lanczos
from kfmaps.geometry.eigen.eigensolver import smallest_eigenpairs
from kfmaps.geometry.mesh import Mesh, unit_area

GUARDS = ("kfmaps.geometry.eigen",)


def operators(mesh: Mesh) -> tuple[csr_array, np.ndarray]:
    stiffness, mass = robust_laplacian.mesh_laplacian(mesh.vertices, mesh.faces)
    return csr_array(stiffness), mass.diagonal()


def path(n: int) -> csr_array:
    """Laplacian of a path of ``n`` points; its eigenvalues are ``4 sin²(π j / 2n)``."""
    neighbours = np.eye(n, k=1) + np.eye(n, k=-1)
    return csr_array(np.diag(neighbours.sum(axis=1)) - neighbours)


def square_grid(side: int) -> tuple[csr_array, np.ndarray, np.ndarray]:
    """Laplacian of a square grid, unit mass, and all its eigenvalues: every one off the diagonal twice."""
    line, one = path(side), eye_array(side)
    values = 4 * np.sin(np.pi * np.arange(side) / (2 * side)) ** 2
    stiffness = csr_array(kron(line, one) + kron(one, line))
    return stiffness, np.ones(side**2), np.sort(np.add.outer(values, values).ravel())


def largest(spectrum: np.ndarray, k: int) -> lanczos._ConvergedPairs:
    """Largest eigenpairs of the diagonal matrix."""
    with one_blas_thread():
        rng = np.random.default_rng(3)
        return lanczos.largest_eigenpairs(lambda x: spectrum[:, None] * x, len(spectrum), k, tolerance=1e-10, rng=rng)


@pytest.fixture(scope="module")
def shape() -> tuple[csr_array, np.ndarray]:
    return operators(unit_area(blob(900)))


@pytest.mark.parametrize("side", [18, 32])  # the whole spectrum, and block Lanczos
@pytest.mark.parametrize("k", [1, 60])
def test_grid_eigenvalues_are_the_closed_form(side: int, k: int) -> None:
    stiffness, mass, exact = square_grid(side)
    pairs = smallest_eigenpairs(stiffness, mass, k)
    np.testing.assert_allclose(pairs.values, exact[:k], rtol=1e-9, atol=1e-12)


def test_many_pairs_of_few_rows_are_found_where_no_krylov_basis_fits() -> None:
    stiffness, mass, exact = square_grid(22)
    np.testing.assert_allclose(smallest_eigenpairs(stiffness, mass, 200).values, exact[:200], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("n", [300, 900])
def test_pairs_solve_the_pencil(n: int) -> None:
    stiffness, mass = operators(unit_area(blob(n)))
    pairs = smallest_eigenpairs(stiffness, mass, 50)
    weighted = mass[:, None] * pairs.vectors
    np.testing.assert_allclose(pairs.vectors.T @ weighted, np.eye(50), atol=1e-11)
    gap = np.linalg.norm(stiffness @ pairs.vectors - weighted * pairs.values, axis=0)
    scaled = gap / ((pairs.values + 4 * np.pi / mass.sum()) * np.linalg.norm(weighted, axis=0))
    assert scaled.max() < 1e-10
    np.testing.assert_allclose(pairs.residuals, scaled, rtol=1e-3)
    assert np.all(np.diff(pairs.values) >= 0)
    assert pairs.values[0] >= 0
    assert (pairs.vectors[np.abs(pairs.vectors).argmax(axis=0), np.arange(50)] > 0).all()  # signs are fixed


@pytest.mark.parametrize(("k", "tolerance", "off"), [(50, 1e-10, 1e-8), (100, 1e-10, 1e-8), (50, 1e-2, 1e-3)])
def test_twenty_equal_components_give_every_eigenvalue_twenty_times(k: int, tolerance: float, off: float) -> None:
    # A block of eight sees eight copies of each: the others come from the restarts.
    stiffness, mass = operators(unit_area(blob(80)))
    one = eigh(stiffness.toarray(), np.diag(mass), eigvals_only=True)
    copies = csr_array(block_diag([stiffness] * 20))
    pairs = smallest_eigenpairs(copies, np.tile(mass, 20), k, tolerance=tolerance)
    np.testing.assert_allclose(pairs.values, np.repeat(one, 20)[:k], rtol=off, atol=off)


@pytest.mark.parametrize("tolerance", [1e-10, 1e-2])
def test_sphere_has_multiplets(tolerance: float) -> None:
    pairs = smallest_eigenpairs(*operators(unit_area(fibonacci_sphere(3000))), 64, tolerance=tolerance)
    degree = np.repeat(np.arange(8), 2 * np.arange(8) + 1)
    np.testing.assert_allclose(pairs.values, degree * (degree + 1) * 4 * np.pi, rtol=0.02, atol=0.1 * tolerance)


def test_lanczos_finds_more_copies_than_its_block_is_wide() -> None:
    spectrum = np.concatenate([np.full(30, 2.0), np.full(11, 1.5), 1 / np.arange(1.0, 960.0)])
    found = largest(spectrum, 45)
    np.testing.assert_allclose(found.values[:45], spectrum[:45], rtol=1e-10)
    np.testing.assert_allclose(found.vectors.T @ found.vectors, np.eye(len(found.values)), atol=1e-9)


def test_lanczos_repairs_a_loss_of_orthogonality() -> None:
    # One eigenvalue far above the rest: the recurrence alone loses digits from step to step.
    spectrum = np.concatenate([[1e6], 1 / np.arange(1.0, 2000.0)])
    found = largest(spectrum, 20)
    np.testing.assert_allclose(found.values[:20], spectrum[:20], rtol=1e-8)
    np.testing.assert_allclose(found.vectors.T @ found.vectors, np.eye(len(found.values)), atol=1e-12)


def test_the_seed_and_blocks_of_rows_change_nothing_but_rounding(
    shape: tuple[csr_array, np.ndarray], monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = (smallest_eigenpairs(*shape, 30, rng=seed).vectors for seed in (0, 1))
    monkeypatch.setattr(lanczos, "_ROWS", 128)
    in_blocks = smallest_eigenpairs(*shape, 30).vectors
    np.testing.assert_allclose(one, other, atol=1e-6)  # signs included
    np.testing.assert_allclose(one, in_blocks, atol=1e-6)


def test_scale_of_the_mass(shape: tuple[csr_array, np.ndarray]) -> None:
    stiffness, mass = shape
    one = smallest_eigenpairs(stiffness, mass, 20)
    other = smallest_eigenpairs(stiffness, mass * 1e-9, 20)
    np.testing.assert_allclose(other.values * 1e-9, one.values, rtol=1e-9, atol=1e-10)


def test_a_row_without_mass_takes_what_its_neighbours_give(shape: tuple[csr_array, np.ndarray]) -> None:
    stiffness, mass = shape
    mass = mass.copy()
    mass[5] = 0
    row = stiffness[[5]].toarray()[0]
    vectors = smallest_eigenpairs(stiffness, mass, 20).vectors
    harmonic = -(row @ vectors - row[5] * vectors[5]) / row[5]
    np.testing.assert_allclose(vectors[5], harmonic, atol=1e-7)


def test_wrong_matrices_do_not_pass() -> None:
    skewed, mass = operators(unit_area(blob(300)))
    skewed.data[skewed.indptr[10] : skewed.indptr[11]] *= 1.5
    with pytest.raises(NotConverged):
        smallest_eigenpairs(skewed, mass, 10)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"k": 0}, "whole number"),
        ({"k": 901}, "from 1 to 900"),
        ({"mass": np.ones(3)}, r"mass \(3,\)"),
        ({"mass": np.full(900, np.nan)}, "NaN"),
        ({"mass": -np.ones(900)}, "at least zero"),
        ({"tolerance": 0.0}, "tolerance"),
    ],
)
def test_bad_input_is_refused(shape: tuple[csr_array, np.ndarray], change: dict, words: str) -> None:
    stiffness, mass = shape
    arguments = {"stiffness": stiffness, "mass": mass, "k": 5, **change}
    with pytest.raises(InvalidInput, match=words):
        smallest_eigenpairs(**arguments)


def test_empty_rows_are_refused() -> None:
    stiffness, mass = operators(unit_area(blob(100)))
    with pytest.raises(InvalidInput, match="1 rows with neither"):
        smallest_eigenpairs(csr_array(block_diag([stiffness, np.zeros((1, 1))])), np.append(mass, 0), 5)


def test_shifted_matrices_are_factorised_in_one_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """Later factors have as few entries as the first, and their own values; one row has nothing on the diagonal.

    No bit of an answer tells whether it was the first that was asked for: several threads ask in any order.
    """
    grid, _, _ = square_grid(30)
    stiffness = csr_array(block_diag([grid, csr_array((1, 1))]))
    fill: list[int] = []

    def counted(*args: object, **options: object) -> object:
        factor = splu(*args, **options)
        fill.append(factor.L.nnz)
        return factor

    monkeypatch.setattr(factorization, "splu", counted)
    factorize, rng = factorization.ShiftedFactorizer(stiffness), np.random.default_rng(0)
    for scale in (1.0, 3.0):
        diagonal, wanted = rng.uniform(1, 2, 901), rng.normal(size=(901, 5))
        right = scale * (stiffness @ wanted) + diagonal[:, None] * wanted
        found = factorize(scale, diagonal)(right)
        np.testing.assert_allclose(found, wanted, atol=1e-10)
        np.testing.assert_array_equal(factorize(scale, diagonal)(right), found)
    assert len(fill) == 5
    assert set(fill) == {fill[0]}
    assert fill[0] < 15 * 900


def test_the_next_look_is_where_the_residual_will_have_converged() -> None:
    """It falls geometrically; at first nothing is known, and no step is longer than half of the wanted pairs."""
    now = (200, 1e-3)
    for blocks, tolerance in ((1, 3.2e-4), (2, 1e-4), (6, 1e-6)):
        assert lanczos._steps((184, 1e-2), now, 400, tolerance) == blocks
    assert lanczos._steps((184, 1e-2), now, 400, 1e-30) == 400 // (2 * lanczos.WIDTH)
    assert lanczos._steps(None, now, 400, 1e-6) == lanczos._steps(now, (216, 1e-2), 400, 1e-6) == 10
