"""Block Lanczos iteration: the largest eigenpairs of a symmetric positive definite operator.

The operator meets a block of vectors at a time, so that one pass over a factor, and one over the Krylov basis,
serve all of them. Every new block is orthogonalised against the whole basis (no ghost eigenvalues).

A block of ``b`` vectors sees at most ``b`` copies of a repeated eigenvalue, and tight clusters (spheres) late.
So after the wanted pairs have converged they are locked and the iteration starts again at random in their
orthogonal complement: whatever it finds there above the smallest wanted value had been missed and joins them.
Only when a restart finds nothing is the answer believed. Such a check takes a few blocks.

Golub and Underwood, The block Lanczos method for computing eigenvalues (1977); Stathopoulos and Wu, A block
orthogonalization procedure with constant synchronization requirements (2002).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from kfmaps._arrays import NotConverged

WIDTH = 8
"""Vectors in a block. Wider ones need more vectors in all, narrower ones more passes over basis and factor."""

ROWS = 4096
"""Rows of the tall products that are worked on together: they fit the cache and can go to threads."""

EQUAL = 1e-9
"""Relative difference below which two eigenvalues count as copies of one."""

Map = Callable[..., Iterable[Any]]


@dataclass(frozen=True, eq=False)
class Ritz:
    """Converged pairs: values (c,) descending, vectors (n, c) orthonormal, and how many restarts it took."""

    values: np.ndarray
    vectors: np.ndarray
    stages: int


def _slices(n: int) -> Iterator[slice]:
    return (slice(start, start + ROWS) for start in range(0, n, ROWS))


def _times(tall: np.ndarray, small: np.ndarray, each: Map) -> np.ndarray:
    """``tall @ small``, column-major."""
    result = np.empty((len(tall), small.shape[1]), order="F")

    def fill(rows: slice) -> None:
        result[rows] = tall[rows] @ small

    list(each(fill, _slices(len(tall))))
    return result


def _subtract(block: np.ndarray, basis: np.ndarray, along: np.ndarray, each: Map) -> None:
    """``block -= basis @ along``, in place."""

    def rows_of(rows: slice) -> None:
        block[rows] -= basis[rows] @ along

    list(each(rows_of, _slices(len(block))))


def _remove(block: np.ndarray, basis: np.ndarray, each: Map) -> None:
    """Take from ``block``, in place, its components along the columns of ``basis``."""
    if basis.shape[1]:
        # The parts are added in a fixed order: the number of threads must not change a bit.
        along = sum(each(lambda rows: basis[rows].T @ block[rows], _slices(len(block))))
        _subtract(block, basis, np.asarray(along), each)


def _normalise(block: np.ndarray, each: Map) -> tuple[np.ndarray, np.ndarray, float]:
    """``(Q, R, spread)`` with ``block = Q R``; the smaller the spread, the less orthonormal ``Q`` may be.

    Directions below rounding are scaled up like the others: they turn into noise, which the next call
    orthonormalises, so that the block keeps its width when the Krylov space is exhausted.
    """
    gram = block.T @ block
    size = np.sqrt(np.diag(gram))
    size = np.where(size > 0, size, 1.0)
    values, rotation = np.linalg.eigh(gram / np.outer(size, size))
    spread = float(values[0])
    root = np.sqrt(np.maximum(values, 1e-15 * values[-1]))
    return _times(block, rotation / size[:, None] / root, each), root[:, None] * rotation.T * size, spread


def _orthonormal(block: np.ndarray, bases: list[np.ndarray], each: Map) -> tuple[np.ndarray, np.ndarray]:
    """``(Q, R)`` with ``block = Q R`` up to components along ``bases``, to which ``Q`` is orthogonal."""
    block, total, _ = _normalise(block, each)
    for _ in range(5):
        for basis in bases:
            _remove(block, basis, each)
        block, factor, spread = _normalise(block, each)
        total = factor @ total
        if spread > 0.5:
            break
    return block, total


def _stage(
    apply: Callable[[np.ndarray], np.ndarray],
    locked: Ritz,
    k: int,
    limit: int,
    tolerance: float,
    rng: np.random.Generator,
    each: Map,
) -> tuple[np.ndarray, np.ndarray]:
    """One run from a random block in the complement of ``locked``; its converged pairs, largest first."""
    n, b = len(locked.vectors), WIDTH
    basis = np.empty((n, limit + b), order="F")  # pages are taken when written
    projected = np.zeros((limit + b, limit + b))
    block, _ = _orthonormal(apply(rng.normal(size=(n, b))), [locked.vectors], each)
    basis[:, :b] = block
    probing = len(locked.values) >= k
    size, check = b, 2 * b if probing else 2 * k + 4 * b
    before: tuple[int, float] | None = None
    coupling = np.zeros((b, b))
    while True:
        new = apply(block)
        diagonal = block.T @ new
        diagonal = (diagonal + diagonal.T) / 2
        recent = slice(max(size - 2 * b, 0), size)
        _subtract(new, basis[:, recent], np.vstack([coupling.T, diagonal])[-size:], each)
        here = slice(size - b, size)
        projected[here, here] = diagonal
        following, coupling = _orthonormal(new, [locked.vectors, basis[:, :size]], each)
        basis[:, size : size + b] = following
        projected[size : size + b, here] = coupling
        projected[here, size : size + b] = coupling.T
        if size >= min(check, limit):
            values, rotation = np.linalg.eigh(projected[:size, :size])
            values, rotation = values[::-1], rotation[:, ::-1]
            left_over = coupling @ rotation[here]
            residual = np.linalg.norm(left_over, axis=0)
            merged = np.sort(np.concatenate([locked.values, values]))[::-1]
            least = merged[k - 1] if len(merged) >= k else -np.inf
            # A probe must also settle the values that may yet grow into the wanted ones.
            wanted = values + probing * residual > least * (1 + probing * EQUAL)
            wanted |= (values >= least) & (not probing)
            good = residual <= tolerance * values
            if (good | ~wanted).all() or size >= limit:
                count = len(good) if good.all() else int(np.argmin(good))
                # Ritz vectors after one more step of the inverse, for nothing: its image is in the basis.
                small = np.vstack([rotation[:, :count], left_over[:, :count] / values[:count]])
                return values[:count], _times(basis[:, : size + b], small, each)
            worst = float((residual / values)[wanted].max()) if not probing else 1.0
            check = size + b * (1 if probing else _steps(before, (size, worst), k, tolerance))
            before = (size, worst)
        block = following
        size += b


def _steps(before: tuple[int, float] | None, now: tuple[int, float], k: int, tolerance: float) -> int:
    """Blocks until convergence is worth looking at again, from the decay of the worst residual so far."""
    if before is None or not 0 < now[1] < before[1]:
        return max(1, round(0.2 * k / WIDTH))
    decay = np.log(before[1] / now[1]) / (now[0] - before[0])
    missing = np.log(now[1] / tolerance) / decay / WIDTH
    return int(np.clip(np.ceil(missing), 1, max(1, 0.5 * k / WIDTH)))


def largest_eigenpairs(
    apply: Callable[[np.ndarray], np.ndarray],
    n: int,
    k: int,
    *,
    tolerance: float,
    rng: np.random.Generator,
    each: Map = map,
) -> Ritz:
    """At least the ``k`` largest eigenpairs of the operator ``apply``, (n, b) -> (n, b).

    Needs ``n > 4k + 160``, room for the Krylov basis, which holds about ``3k + 60`` vectors at the end.

    Parameters
    ----------
    tolerance : float
        Bound on ``‖apply(x) − νx‖ / ν`` before the last, refining step.

    Raises
    ------
    NotConverged
        When the Krylov basis reaches its limit without a new converged pair.
    """
    limit = 4 * k + 20 * WIDTH
    locked = Ritz(np.zeros(0), np.zeros((n, 0)), 0)
    while True:
        values, vectors = _stage(apply, locked, k, limit // WIDTH * WIDTH, tolerance, rng, each)
        least = locked.values[k - 1] if len(locked.values) >= k else -np.inf
        if not (values > least * (1 + EQUAL)).any():
            if len(locked.values) < k:
                raise NotConverged(f"block Lanczos: {len(locked.values)} of {k} eigenpairs after {limit} vectors")
            return locked
        together = np.concatenate([locked.values, values])
        order = np.argsort(-together, kind="stable")
        if locked.stages:
            vectors = np.asfortranarray(np.hstack([locked.vectors, vectors])[:, order])
        locked = Ritz(together[order], vectors, locked.stages + 1)
