"""Block Lanczos iteration: the largest eigenpairs of a symmetric positive definite operator, such as an inverse.

The operator meets a block of vectors at a time, so that one pass over a factor, and one over the Krylov basis, serve
all of them. Every second block is orthogonalised against the whole basis (no ghost eigenvalues).

A block of ``b`` vectors sees at most ``b`` copies of a repeated eigenvalue, and tight clusters (spheres) late. So after
the wanted pairs have converged they are locked and the iteration starts again at random in their orthogonal complement:
whatever it finds there above the smallest wanted eigenvalue had been missed and joins them. Only when a restart finds
nothing is the answer believed. Such a check takes a few blocks.

Inverses with a shift below all eigenvalues are meant. A shift among the wanted ones saves a quarter of the vectors, but
the factor of an indefinite matrix, unpivoted, left residuals of 1e-8 at a hundred thousand rows.

Golub and Underwood, The block Lanczos method for computing eigenvalues (1977); Grimes, Lewis and Simon, A shifted block
Lanczos algorithm for solving sparse symmetric generalized eigenproblems (1994); Stathopoulos and Wu, A block
orthogonalization procedure with constant synchronization requirements (2002).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import NotConverged, blocks

WIDTH = 8
"""Vectors in a block. Wider ones need more vectors in all, narrower ones more passes over basis and factor."""


_ROWS = 16384  # rows of the tall products that are worked on together: they fit the cache

_EQUAL_RTOL = 1e-9  # relative difference below which two eigenvalues count as copies of one


LOOSE = 1e-6
"""Tolerance from which the basis is kept in single precision: a third of the time, and half of the memory."""


@dataclass(frozen=True, eq=False)
class _ConvergedPairs:
    """Converged pairs: eigenvalues (c,) descending, vectors (n, c) orthonormal, and how many restarts it took."""

    values: np.ndarray
    vectors: np.ndarray
    stages: int


def _times(tall: np.ndarray, small: np.ndarray) -> np.ndarray:
    """``tall @ small``, column-major, in the precision of ``tall``."""
    result = np.empty((len(tall), small.shape[1]), order="F")
    small = np.asarray(small, dtype=tall.dtype)
    for rows in blocks(len(tall), _ROWS):
        result[rows] = (small.T @ tall[rows].T).T
    return result


def _subtract(block: np.ndarray, basis: np.ndarray, along: np.ndarray) -> None:
    """``block -= basis @ along``, in place; the product in the precision of ``basis``."""
    along = np.asarray(along, dtype=basis.dtype)
    for rows in blocks(len(block), _ROWS):
        block[rows] -= (along.T @ basis[rows].T).T  # written as column-major as the block is


def _remove(block: np.ndarray, basis: np.ndarray) -> float:
    """Take from ``block``, in place, its components along the columns of ``basis``; the largest of them."""
    if basis.shape[1] == 0:
        return 0.0
    parts = [basis[rows].T @ np.asarray(block[rows], dtype=basis.dtype) for rows in blocks(len(block), _ROWS)]
    along = np.asarray(np.sum(parts, axis=0, dtype=np.float64))
    _subtract(block, basis, along)
    return float(np.abs(along).max())


def _normalise(block: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """``(Q, R, spread)`` with ``block = Q R``; the smaller the spread, the less orthonormal ``Q`` may be.

    Directions below rounding are scaled up like the others: they turn into noise, which the next call orthonormalises,
    so that the block keeps its width when the Krylov space is exhausted.
    """
    gram = block.T @ block
    size = np.sqrt(np.diag(gram))
    size = np.where(size > 0, size, 1.0)
    values, rotation = np.linalg.eigh(gram / np.outer(size, size))
    spread = float(values[0])
    root = np.sqrt(np.maximum(values, 1e-15 * values[-1]))
    return _times(block, rotation / size[:, None] / root), root[:, None] * rotation.T * size, spread


def _orthonormal(block: np.ndarray, bases: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, float]:
    """``(Q, R, found)``: ``block = Q R`` up to components along ``bases``, to which ``Q`` is orthogonal.

    ``found`` is the largest such component of the block once it had been normalised.
    """
    block, total, _ = _normalise(block)
    found = 0.0
    for turn in range(5):
        largest = max([_remove(block, basis) for basis in bases], default=0.0)
        found = found if turn else largest
        block, factor, spread = _normalise(block)
        total = factor @ total
        if spread > 0.5:
            break
    return block, total, found


def _stage(
    apply: Callable[[np.ndarray], np.ndarray],
    locked: _ConvergedPairs,
    k: int,
    tolerance: float,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray]:
    """One run from a random block in the complement of ``locked``; its converged values and vectors."""
    n, b = len(locked.vectors), WIDTH
    limit = _capacity(k)
    loose = tolerance >= LOOSE
    basis = np.empty((n, limit + b), order="F", dtype=np.float32 if loose else np.float64)  # pages taken when written
    recent = np.zeros((n, 2 * b), order="F")  # the last two blocks, whatever the precision of the basis
    projected = np.zeros((limit + b, limit + b))
    block, _, _ = _orthonormal(apply(rng.normal(size=(n, b))), [locked.vectors])
    basis[:, :b] = recent[:, b:] = block
    probing = len(locked.values) >= k
    sparing = locked.stages == 0
    # Some 3k + 60 vectors are needed on surfaces; an eigendecomposition to look earlier is not free.
    size, check = b, 2 * b if probing else (2 * k // b * b if loose else 3 * k // b * b + 6 * b)
    before: tuple[int, float] | None = None
    coupling = np.zeros((b, b))
    while True:
        new = apply(block)
        diagonal = block.T @ new
        diagonal = (diagonal + diagonal.T) / 2
        _subtract(new, recent[:, -size:], np.vstack([coupling.T, diagonal])[-size:])
        here = slice(size - b, size)
        projected[here, here] = diagonal
        # Two steps lose some four digits of orthogonality at most, so every second block may do with the
        # three-term recurrence, unless that turns out to lose more.
        brief = sparing and size // b % 2 == 0
        against = [] if brief else [locked.vectors, basis[:, :size]]
        following, coupling, found = _orthonormal(new, against)
        # Orthogonality lost in two steps grows in each by about the largest eigenvalue over the smallest wanted one.
        sparing &= found < (1e-3 if loose else 1e-10)
        recent[:, :b], recent[:, b:] = block, following
        basis[:, size : size + b] = following
        projected[size : size + b, here] = coupling
        projected[here, size : size + b] = coupling.T
        if size >= min(check, limit):
            values, rotation = np.linalg.eigh(projected[:size, :size])
            left_over = coupling @ rotation[here]
            residual = np.linalg.norm(left_over, axis=0)
            count = k if probing else k + 4  # the check for missed ones ends sooner for these
            wanted = _wanted(locked.values, values, residual, k, count)
            good = residual <= tolerance * values
            if ((good | ~wanted).all() and len(locked.values) + size >= count) or size >= limit:
                take = np.flatnonzero(good)
                # Ritz vectors after one more step of the operator, for nothing: its image is in the basis.
                small = np.vstack([rotation[:, take], left_over[:, take] / values[take]])
                return values[take], _times(basis[:, : size + b], small)
            worst = float((residual / values)[wanted].max())
            check = size + b * (1 if probing else _steps(before, (size, worst), k, tolerance))
            before = (size, worst)
        block = following
        size += b


def _wanted(locked: np.ndarray, values: np.ndarray, residual: np.ndarray, k: int, count: int) -> np.ndarray:
    """Which of the ``values`` must have converged for the ``count`` largest to be known."""
    merged = -np.sort(-np.concatenate([locked, values]))
    wanted = values >= merged[min(count, len(merged)) - 1]
    if len(locked) >= k:
        # Only what improves on the locked pairs; and what may yet grow to do so has to settle too.
        wanted &= values > locked[k - 1] * (1 + _EQUAL_RTOL)
        wanted |= values + residual > merged[k - 1] * (1 + _EQUAL_RTOL)
    return wanted


def _steps(before: tuple[int, float] | None, now: tuple[int, float], k: int, tolerance: float) -> int:
    """Blocks until convergence is worth looking at again, from the decay of the worst residual so far."""
    if before is None or not 0 < now[1] < before[1]:
        return max(1, round(0.2 * k / WIDTH))
    decay = np.log(before[1] / now[1]) / (now[0] - before[0])
    missing = np.log(now[1] / tolerance) / decay / WIDTH
    return int(np.clip(np.ceil(missing), 1, max(1, 0.5 * k / WIDTH)))


def _capacity(k: int) -> int:
    """Most vectors that the Krylov basis may hold; about ``3k + 60`` are needed."""
    return (4 * k + 20 * WIDTH) // WIDTH * WIDTH


def largest_eigenpairs(
    apply: Callable[[np.ndarray], np.ndarray],
    n: int,
    k: int,
    *,
    tolerance: float,
    rng: np.random.Generator,
) -> _ConvergedPairs:
    """Return at least the ``k`` largest eigenpairs of an operator.

    ``apply``: (n, b) -> (n, b); ``n`` and ``k``: ``n`` above ``_capacity(k)``; ``tolerance``: bound on ``‖apply(x) −
    νx‖ / ν`` before the last, refining step; ``rng``: draws the start vectors.
    """
    locked = _ConvergedPairs(np.zeros(0), np.zeros((n, 0)), 0)
    while True:
        values, vectors = _stage(apply, locked, k, tolerance, rng)
        if len(locked.values) >= k:
            if not (values > locked.values[k - 1] * (1 + _EQUAL_RTOL)).any():
                return locked
        elif len(values) == 0:
            raise NotConverged(f"block Lanczos: {len(locked.values)} of {k} eigenpairs converged")
        together = np.concatenate([locked.values, values])
        order = np.argsort(-together, kind="stable")
        if locked.stages:
            vectors = np.hstack([locked.vectors, vectors])
        locked = _ConvergedPairs(together[order], np.asfortranarray(vectors[:, order]), locked.stages + 1)
