"""The smallest eigenpairs of a sparse symmetric pencil ``L x = λ A x`` with a diagonal mass ``A``."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from kfmaps._arrays import NotConverged, check, check_count, check_positive, refuse
from kfmaps._factor import Sparse, factorise
from kfmaps._lanczos import largest_eigenpairs
from kfmaps._threads import available_cores, one_blas_thread

METHODS = ("auto", "block", "arpack", "dense")

MASS_FLOOR = 1e-10
"""Least mass of a vertex, as a part of the mean: one without mass takes the value that its neighbours give it
(harmonic), and this much mass moves no eigenvalue by more than this part."""

THREADED = 20_000
"""Rows from which threads pay."""


@dataclass(frozen=True, eq=False)
class Eigenpairs:
    """What :func:`smallest_eigenpairs` found.

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
    stiffness: Sparse,
    mass: np.ndarray,
    k: int,
    *,
    tolerance: float = 1e-10,
    rng: int | np.random.Generator = 0,
    threads: int | None = None,
    method: str = "auto",
    ordering: str = "auto",
) -> Eigenpairs:
    """The ``k`` smallest eigenpairs of ``stiffness x = λ mass x``, by Lanczos on ``(stiffness + σ mass)⁻¹``.

    Every pair is checked against the tolerance before it is returned, and the block method looks for
    eigenvalues that it may have missed (repeated ones of identical components, clusters of spheres).
    The same input gives the same answer, whatever the number of threads.

    Parameters
    ----------
    stiffness : (n, n) sparse
        Symmetric, positive semi-definite, for example a weak Laplacian. It may have a null space of any
        dimension (one per component), but no row that is zero together with its mass.
    mass : (n,)
        Diagonal of the mass, none below zero, some above.
    k : int
        From 1 to ``n``.
    tolerance : float
        Bound on the residuals of :class:`Eigenpairs`, on top of what rounding ``stiffness @ x`` costs: that
        matters on meshes with needle triangles, and from about a million vertices.
    rng : int or numpy.random.Generator
        Draws the start vectors.
    threads : int, optional
        Python threads for solves and tall products, from 20,000 rows; ``None`` takes every available core.
        BLAS is held to one.
    method : {"auto", "block", "arpack", "dense"}
        ``"block"``: own block Lanczos with full reorthogonalisation. ``"arpack"``: SciPy's ``eigsh`` on the
        same factorisation. ``"dense"``: the whole spectrum, for a few hundred rows. ``"auto"``: dense
        where the Krylov basis would not fit (``n ≤ max(400, 4k + 200)``), else block.
    ordering : {"auto", "metis", "mmd"}
        Ordering of the factorisation; METIS is faster on large meshes and comes with ``kfmaps[fast]``.

    Raises
    ------
    InvalidInput
        On arrays that do not fit together, NaN, a negative mass, or ``k`` out of range.
    NotConverged
        When a residual stays above the tolerance or the shifted matrix is singular.
    """
    n = stiffness.shape[0]
    matrix = csr_array(stiffness)
    mass = np.asarray(mass, dtype=np.float64)
    if stiffness.shape != (n, n) or mass.shape != (n,):
        got = f"stiffness {tuple(stiffness.shape)}, mass {mass.shape}"
        raise refuse("pencil", "stiffness (n, n) and mass (n,)", got, "check how they were made")
    check(matrix.data, "stiffness")
    check(mass, "mass")
    check_count(k, "k", 1, n)
    check_positive(tolerance, "tolerance")
    if method not in METHODS:
        raise refuse("method", f"one of {', '.join(METHODS)}", repr(method), "choose one of them")
    if mass.min() < 0 or not mass.sum() > 0:
        raise refuse("mass", "none below zero, some above", f"least {mass.min():g}", "check the areas")
    small = n <= max(400, 4 * k + 200)
    if method == "auto" or (method != "dense" and small):
        method = "dense" if small else "block"
    shift = 4 * np.pi / mass.sum()
    floored = np.maximum(mass, MASS_FLOOR * mass.mean())
    with ExitStack() as stack:
        stack.enter_context(one_blas_thread())
        workers = min(threads or available_cores(), 8)
        each = map
        if workers > 1 and n >= THREADED:
            each = stack.enter_context(ThreadPoolExecutor(workers)).map
        solve = factorise(matrix + shift * diags_array(floored), ordering, each)
        vectors = _vectors(solve, np.sqrt(floored), k, method, tolerance, np.random.default_rng(rng), each)
        return _checked(matrix, floored, vectors, shift, tolerance)


def _vectors(solve, root, k, method, tolerance, rng, each) -> np.ndarray:
    """Eigenvectors (n, k) of the inverse pencil, orthonormal in the mass ``root**2``, in no strict order."""
    n = len(root)

    def apply(block: np.ndarray) -> np.ndarray:
        return root[:, None] * solve(root[:, None] * block)

    if method == "dense":
        inverse = apply(np.eye(n))
        _, vectors = eigh((inverse + inverse.T) / 2, subset_by_index=(n - k, n - 1))
        return _improved(solve, vectors, root)
    if method == "arpack":
        # SciPy's stubs do not know that the class builds its own subclass.
        make: Any = LinearOperator
        one = make((n, n), matvec=lambda x: apply(x.reshape(n, 1))[:, 0], dtype=np.float64)
        try:
            _, vectors = eigsh(one, k=k, which="LA", v0=rng.normal(size=n), tol=0)
        except ArpackError as error:
            raise NotConverged(f"ARPACK: {error}") from error
        return _improved(solve, vectors, root)
    found = largest_eigenpairs(apply, n, k, tolerance=tolerance / 2, rng=rng, each=each)
    if found.stages == 1:
        return found.vectors[:, :k] / root[:, None]
    # Pairs of different stages are decoupled only to the tolerance of the largest: mend that.
    return _improved(solve, found.vectors[:, :k], root)


def _improved(solve, vectors: np.ndarray, root: np.ndarray) -> np.ndarray:
    """One step of subspace iteration with Rayleigh-Ritz; takes scaled vectors, returns true ones."""
    images = np.hstack([solve(root[:, None] * vectors[:, s : s + 8]) for s in range(0, vectors.shape[1], 8)])
    scaled = root[:, None] * images
    size = np.linalg.norm(scaled, axis=0)
    scaled, images, vectors = scaled / size, images / size, vectors / size
    energy = scaled.T @ vectors  # (L + σA) of the images, as it maps them back to the vectors
    _, rotation = eigh((energy + energy.T) / 2, scaled.T @ scaled)
    return images @ rotation


def _checked(matrix, mass, vectors, shift, tolerance) -> Eigenpairs:
    """Sorted, signed and checked pairs: the values are Rayleigh quotients."""
    images = matrix @ vectors
    values = (vectors * images).sum(axis=0) / (vectors * (mass[:, None] * vectors)).sum(axis=0)
    order = np.argsort(values, kind="stable")
    values, vectors, images = np.maximum(values[order], 0), vectors[:, order], images[:, order]
    weighted = mass[:, None] * vectors
    scale = (values + shift) * np.linalg.norm(weighted, axis=0)
    gaps = np.linalg.norm(images - weighted * values, axis=0)
    bad = np.flatnonzero(~(gaps <= tolerance * scale))
    if len(bad):
        rounding = 8 * np.finfo(float).eps * np.linalg.norm(abs(matrix) @ abs(vectors[:, bad]), axis=0)
        bad = bad[~(gaps[bad] <= tolerance * scale[bad] + rounding)]
    if len(bad):
        worst = (gaps / scale)[bad].max()
        raise NotConverged(
            f"eigenpairs: {len(bad)} of {len(values)} have residuals above {tolerance:.0e}, the largest {worst:.1e}; "
            "look for parts without area, or for coordinates of very different size"
        )
    largest = np.abs(vectors).argmax(axis=0)
    signs = np.where(vectors[largest, np.arange(len(values))] < 0, -1.0, 1.0)
    return Eigenpairs(values, vectors * signs, gaps / scale)
