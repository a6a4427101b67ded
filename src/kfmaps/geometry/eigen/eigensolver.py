"""The smallest eigenpairs of a sparse symmetric pencil ``L x = λ A x`` with a diagonal mass ``A``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_array, diags_array

from kfmaps._arrays import NotConverged, blocks, check, check_count, check_positive, refuse
from kfmaps._threads import one_blas_thread
from kfmaps.geometry.eigen.factorization import SparseMatrix, factorize
from kfmaps.geometry.eigen.lanczos import LOOSE, WIDTH, largest_eigenpairs

_SOLVES_PER_BLOCK = 1.25
"""Blocks that are solved for, with the search for missed pairs, over those of a Krylov basis of ``3k + 60`` vectors."""

EXACT = 1e-10
"""Tolerance that is fallen back to where a loose one cannot be trusted."""

_MAX_LOOSE_RESIDUAL = 1e-2
"""What a solution in single precision may leave of the right-hand side; 3e-6 is usual at 80,000 rows."""

_LOOSE_SHIFT = 10.0  # shift of a loose search, in units of the usual one


@dataclass(frozen=True, eq=False)
class Eigenpairs:
    """The result of :func:`smallest_eigenpairs`.

    Attributes
    ----------
    values : (k,) float64
        Ascending, none below zero.
    vectors : (n, k) float64
        Columns orthonormal in the mass, each with its entry of largest magnitude positive.
    residuals : (k,) float64
        ``‖Lx − λAx‖ / ((λ + σ) ‖Ax‖)`` of each pair, with ``σ = 4π / sum(mass)``, the scale of the smallest
        eigenvalues, so that those that are zero count too.
    """

    values: np.ndarray
    vectors: np.ndarray
    residuals: np.ndarray


def smallest_eigenpairs(
    stiffness: SparseMatrix,
    mass: np.ndarray,
    k: int,
    *,
    tolerance: float = EXACT,
    rng: int | np.random.Generator = 0,
    progress: Callable[[float], None] | None = None,
) -> Eigenpairs:
    """Return the ``k`` smallest eigenpairs of ``stiffness x = λ mass x``, by Lanczos on ``(stiffness + σ mass)⁻¹``.

    Where the Krylov basis would not fit, of a few hundred rows, the whole spectrum is computed instead. Every pair is
    checked against the tolerance before it is returned, and block Lanczos looks for eigenvalues that it may have missed
    (repeated ones of identical components, clusters of spheres). The same input gives the same answer.

    Parameters
    ----------
    stiffness : (n, n) sparse
        Symmetric, positive semi-definite, for example a weak Laplacian. It may have a null space of any dimension (one
        per component), but no row that is zero together with its mass.
    mass : (n,)
        Diagonal of the mass, none below zero, some above.
    k : int
        From 1 to ``n``.
    tolerance : float
        Bound on the residuals of :class:`Eigenpairs`, on top of what rounding ``stiffness @ x`` costs: that matters on
        meshes with needle triangles, and from about a million vertices. From 1e-6 on it bounds what the iteration
        itself is off, ``‖(L + σA)⁻¹Ax − νx‖ / ν`` in the norm of the mass, and works in single precision, in half of
        the time and memory: at 1e-2 eigenvalues differ by 1e-7 and the span of the functions by 3e-3 at most, as an
        angle; where that does not serve the pairs are found to 1e-10.
    rng : int or numpy.random.Generator
        Draws the start vectors.
    progress : callable, optional
        Told about how much is done, from 0 to 1, as the blocks of the basis grow.

    Returns
    -------
    Eigenpairs

    Raises
    ------
    InvalidInput
        On arrays that do not fit together, NaN, a negative mass, a row without stiffness and mass, or ``k`` out of
        range.
    NotConverged
        When a residual stays above the tolerance or the shifted matrix is singular.
    """
    matrix, mass = _check_pencil(stiffness, mass)
    check_count(k, "k", 1, len(mass))
    check_positive(tolerance, "tolerance")
    with one_blas_thread():
        return _solve(matrix, mass, k, tolerance, rng, progress)


def _check_pencil(stiffness: SparseMatrix, mass: np.ndarray) -> tuple[csr_array, np.ndarray]:
    """Return both as the solver takes them, or raise :class:`InvalidInput`."""
    n, mass = stiffness.shape[0], np.asarray(mass, dtype=np.float64)
    matrix = csr_array(stiffness)
    if stiffness.shape != (n, n) or mass.shape != (n,):
        got = f"stiffness {tuple(stiffness.shape)}, mass {mass.shape}"
        raise refuse("pencil", "stiffness (n, n) and mass (n,)", got, "check how they were made")
    check(matrix.data, "stiffness")
    check(mass, "mass")
    if mass.min() < 0 or not mass.sum() > 0:
        raise refuse("mass", "numbers of at least zero, not all zero", f"{mass.min():g}", "check the areas")
    idle = int(((mass == 0) & (matrix.diagonal() == 0)).sum())
    if idle:
        raise refuse("pencil", "a mass or a stiffness in every row", f"{idle} rows with neither", "leave them out")
    return matrix, mass


def _solve(
    matrix: csr_array,
    mass: np.ndarray,
    k: int,
    tolerance: float,
    rng: int | np.random.Generator,
    progress: Callable[[float], None] | None,
) -> Eigenpairs:
    """Return the eigenpairs of a checked pencil; see :func:`smallest_eigenpairs`."""
    # At a vertex without mass a function is harmonic. So little mass changes no eigenvalue.
    floored = np.maximum(mass, 1e-10 * mass.mean())
    dense = len(mass) <= max(400, 4 * k + 200)
    if not dense and tolerance >= LOOSE:
        loose = _solve_loosely(matrix, floored, k, tolerance, np.random.default_rng(rng), progress)
        if loose is not None:
            return loose
        tolerance = EXACT
    pencil = _Pencil(matrix, floored)
    if progress is not None:
        pencil.solve = _report_solves(pencil.solve, (3 * k + 60) * _SOLVES_PER_BLOCK / WIDTH, progress)
    vectors = _vectors(pencil, k, dense, tolerance, np.random.default_rng(rng))
    values, residuals = pencil.residuals(vectors)
    for _ in range(2):  # specks and caps make the Lanczos basis lose digits
        if not len(_unconverged(pencil, vectors, values, residuals, tolerance)):
            break
        vectors = _rayleigh_ritz(pencil, pencil.root[:, None] * vectors)
        values, residuals = pencil.residuals(vectors)
    bad = _unconverged(pencil, vectors, values, residuals, tolerance)
    if len(bad):
        raise NotConverged(
            f"eigenpairs: {len(bad)} of {len(values)} have residuals above {tolerance:.0e}, the largest "
            f"{residuals[bad].max():.1e}. Look for parts without area, or for coordinates of very different size."
        )
    return _ascending(values, vectors, residuals)


def _solve_loosely(
    matrix: SparseMatrix,
    mass: np.ndarray,
    k: int,
    tolerance: float,
    rng: np.random.Generator,
    progress: Callable[[float], None] | None,
) -> Eigenpairs | None:
    """Return the pairs to a loose ``tolerance``, with factor and basis in single precision, or ``None``.

    The shift is larger than usual, since rounding errors of the Krylov basis grow by the ratio of the operator's
    largest eigenvalue to the smallest one of the pairs. Single precision fails for some matrices, as those with needle
    triangles. Then eigenvalues and Rayleigh quotients, in double precision, differ, and the result is ``None``.
    """
    try:
        pencil = _Pencil(matrix, mass, _LOOSE_SHIFT, np.float32)
        block = pencil.root[:, None] * rng.normal(size=(len(mass), 4))
        solution = pencil.solve(block)
        residual = matrix @ solution + (_LOOSE_SHIFT * pencil.unit * mass)[:, None] * solution - block
        if not np.linalg.norm(residual) <= _MAX_LOOSE_RESIDUAL * np.linalg.norm(block):
            return None
        if progress is not None:
            pencil.solve = _report_solves(pencil.solve, (2.4 * k + 60) * _SOLVES_PER_BLOCK / WIDTH, progress)
        largest = largest_eigenpairs(pencil.inverse, len(mass), k, tolerance=tolerance, rng=rng)
    except NotConverged:
        return None
    vectors = largest.vectors[:, :k]
    vectors /= pencil.root[:, None]  # in place, since they take most of the memory of a large mesh
    values, residuals = pencil.residuals(vectors)
    eigenvalues = 1 / largest.values[:k] - _LOOSE_SHIFT * pencil.unit
    if not (np.abs(eigenvalues - values) <= 1e-3 * (values + pencil.unit)).all():
        return None
    if largest.stages > 1:
        vectors = _rayleigh_ritz(pencil, pencil.root[:, None] * vectors)
        values, residuals = pencil.residuals(vectors)
    return _ascending(values, vectors, residuals)


def _report_solves(
    solve: Callable[[np.ndarray], np.ndarray], expected: float, progress: Callable[[float], None]
) -> Callable[[np.ndarray], np.ndarray]:
    """Return ``solve`` with a report of how many of about ``expected`` calls are done."""
    done = 0

    def solve_and_report(block: np.ndarray) -> np.ndarray:
        nonlocal done
        solution = solve(block)
        done += 1
        progress(min(done / expected, 0.99))
        return solution

    return solve_and_report


class _Pencil:
    """The pencil ``(L, A)`` and the factor of ``L + σA``, with ``σ`` the ``shift`` times ``4π / sum(mass)``."""

    def __init__(
        self,
        matrix: SparseMatrix,
        mass: np.ndarray,
        shift: float = 1.0,
        precision: type = np.float64,
    ) -> None:
        self.matrix, self.mass, self.root = matrix, mass, np.sqrt(mass)
        self.unit = 4 * np.pi / mass.sum()
        shifted = matrix + shift * self.unit * diags_array(mass)
        self.solve = factorize(shifted.astype(precision, copy=False))

    def inverse(self, block: np.ndarray) -> np.ndarray:
        """Return ``√A (L + σA)⁻¹ √A`` times the block."""
        return self.root[:, None] * self.solve(self.root[:, None] * block)

    def residuals(self, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return Rayleigh quotients and scaled residuals of the columns, by blocks that fit the cache."""
        parts = [self._residuals(vectors[:, part]) for part in blocks(vectors.shape[1], 16)]
        return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])

    def _residuals(self, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        images, weighted = self.matrix @ vectors, self.mass[:, None] * vectors
        values = (vectors * images).sum(axis=0) / (vectors * weighted).sum(axis=0)
        values = np.maximum(values, 0)
        images -= weighted * values
        return values, np.linalg.norm(images, axis=0) / ((values + self.unit) * np.linalg.norm(weighted, axis=0))


def _vectors(pencil: _Pencil, k: int, dense: bool, tolerance: float, rng: np.random.Generator) -> np.ndarray:
    """Return eigenvectors (n, k), orthonormal in the mass, nearly in order."""
    n = len(pencil.mass)
    if dense:
        inverse = pencil.inverse(np.eye(n))
        _, vectors = eigh((inverse + inverse.T) / 2, subset_by_index=(n - k, n - 1))
        return _rayleigh_ritz(pencil, vectors)
    largest = largest_eigenpairs(pencil.inverse, n, k, tolerance=tolerance / 2, rng=rng)
    if largest.stages == 1:
        return largest.vectors[:, :k] / pencil.root[:, None]
    # Pairs of different stages are decoupled only to the tolerance of the largest.
    return _rayleigh_ritz(pencil, largest.vectors[:, :k])


def _rayleigh_ritz(pencil: _Pencil, vectors: np.ndarray) -> np.ndarray:
    """Return eigenvectors after a step of subspace iteration with Rayleigh-Ritz, from vectors times ``√A``."""
    weighted = pencil.root[:, None] * vectors
    images = np.hstack([pencil.solve(weighted[:, s : s + 8]) for s in range(0, vectors.shape[1], 8)])
    scaled = pencil.root[:, None] * images
    size = np.linalg.norm(scaled, axis=0)
    scaled, images, vectors = scaled / size, images / size, vectors / size
    energy = scaled.T @ vectors  # L + σA maps the images back to the vectors
    _, rotation = eigh((energy + energy.T) / 2, scaled.T @ scaled)
    return images @ rotation


def _unconverged(
    pencil: _Pencil, vectors: np.ndarray, values: np.ndarray, residuals: np.ndarray, tolerance: float
) -> np.ndarray:
    """Return the pairs with ``residuals`` above the tolerance and the rounding errors."""
    bad = np.flatnonzero(~(residuals <= tolerance))
    if len(bad):
        size = np.linalg.norm(abs(pencil.matrix) @ abs(vectors[:, bad]), axis=0)
        rounding = 8 * np.finfo(float).eps * size
        scale = (values[bad] + pencil.unit) * np.linalg.norm(pencil.mass[:, None] * vectors[:, bad], axis=0)
        bad = bad[~(residuals[bad] <= tolerance + rounding / scale)]
    return bad


def _ascending(values: np.ndarray, vectors: np.ndarray, residuals: np.ndarray) -> Eigenpairs:
    """Return the pairs in ascending order with definite signs; ``vectors (n, k)`` is changed in place."""
    order = np.argsort(values, kind="stable")
    moved = np.flatnonzero(order != np.arange(len(order)))
    vectors[:, moved] = vectors[:, order[moved]]
    return Eigenpairs(values[order], turn_peaks_up(vectors), residuals[order])


def turn_peaks_up(vectors: np.ndarray) -> np.ndarray:
    """Return ``vectors (n, k)`` with the entry of largest magnitude of each column positive; they change in place."""
    vectors[:, vectors.max(axis=0) < -vectors.min(axis=0)] *= -1.0
    return vectors
