"""Selection of the rows of descriptors that the Nyström approximation is built from.

All return (count,) int64 rows without repetition, fewer where there are fewer distinct ones. Farthest points by
geodesic distance are in :mod:`kfmaps.geometry.geodesics`.
"""

from __future__ import annotations

import numpy as np

from kfmaps._arrays import Array, check_count, check_positive, is_numpy, namespace, take, to_numpy
from kfmaps.kernels.kernels import KernelLike, kernel_diagonal, kernel_matrix

_Rng = int | np.random.Generator | None


def uniform(n: int, count: int, rng: _Rng = 0) -> np.ndarray:
    """Return ``count`` of ``n`` rows, (count,) int64, drawn with ``rng``; all subsets are equally likely."""
    check_count(count, "sample count", high=n)
    return np.random.default_rng(rng).choice(n, size=count, replace=False)


def farthest_descriptors(X: Array, count: int, rng: _Rng = 0, pool: int | None = 50_000) -> np.ndarray:
    """Return farthest points in descriptor space (Gonzalez 1985; descriptor FPS of the paper, section 7.1).

    The first is a random row, each next one the row farthest from all taken. There are fewer where every row equals a
    taken one. Of more rows ``X (n, d)`` than ``pool`` (but at least ``4 count``) that many are drawn first, with
    ``rng``, so that the cost does not grow with n.
    """
    n = X.shape[0]
    check_count(count, "sample count", high=n)
    draw = np.random.default_rng(rng)
    if pool is not None and n > max(pool, 4 * count):
        drawn = draw.choice(n, size=max(pool, 4 * count), replace=False)
        return drawn[farthest_descriptors(take(X, drawn), count, draw, None)]
    first = int(draw.integers(n))
    return _farthest_rows(X, count, first) if is_numpy(X) else _farthest_rows_on_device(X, count, first)


def _farthest_rows(X: np.ndarray, count: int, following: int) -> np.ndarray:
    """Return ``count`` farthest rows of ``X (n, d)``, the first of them ``following``."""
    X = X - X.mean(axis=0)
    squares = np.einsum("ij,ij->i", X, X)
    # Most rows turn out in single precision not to be nearer; squared distances are wrong by ``slack`` there at most.
    size = np.sqrt(squares.max()) or 1.0
    single, slack = (X / size).astype(np.float32), 2.02 * (X.shape[1] + 2) * 2.0**-24 * size**2
    taken = np.empty(count, dtype=np.int64)
    nearest, owner = np.full(len(X), np.inf), np.zeros(len(X), dtype=np.int64)
    for i in range(count):
        taken[i] = following
        apart = squares[taken[: i + 1]] + squares[following] - 2 * (X[taken[: i + 1]] @ X[following])
        # A row that is at most half as far from the one taken as that is from the new one is not nearer to the new one.
        rows = np.flatnonzero(4 * nearest > apart[owner])
        about = squares[rows] + squares[following] - 2 * size**2 * (single[rows] @ single[following])
        rows = rows[about < nearest[rows] + slack]
        away = X[rows] @ X[following]
        away *= -2
        away += squares[rows]
        away += squares[following]
        nearer = away < nearest[rows]
        rows = rows[nearer]
        nearest[rows], owner[rows] = away[nearer], i
        nearest[following] = -np.inf
        following = int(np.argmax(nearest))
        if nearest[following] <= 1e-14 * squares.max():
            return taken[: i + 1]
    return taken


def _farthest_rows_on_device(X: Array, count: int, first: int) -> np.ndarray:
    """Do as :func:`_farthest_rows` with few large operations."""
    xp = namespace(X)
    X = X - xp.mean(X, axis=0, keepdims=True)
    squares = xp.sum(X * X, axis=1)[:, None]
    ones = xp.ones_like(squares)
    # The squared distances of all rows from row i are ``rows @ columns[i]``.
    rows, columns = xp.concat([X, squares, ones], axis=1), xp.concat([-2 * X, ones, squares], axis=1)
    following, nearest = xp.asarray([first], device=X.device), xp.full_like(squares[:, 0], xp.inf)
    taken, distances = [], []  # left on the device until the end
    for _ in range(count):
        taken.append(following)
        nearest = xp.minimum(nearest, rows @ xp.take(columns, following, axis=0)[0, :])
        following = xp.reshape(xp.argmax(nearest), (1,))
        distances.append(xp.max(nearest))
    rounding = 4 * (X.shape[1] + 10) * float(xp.finfo(X.dtype).eps * xp.max(squares))
    is_new = to_numpy(xp.stack(distances)) > rounding  # whether a row that differs from those taken follows
    return to_numpy(xp.concat(taken))[: 1 + int(np.argmin([*is_new[:-1], False]))]


def pivoted_cholesky(
    kernel: KernelLike, X: Array, count: int, *, randomised: bool = False, power: float = 1.0, rng: _Rng = 0
) -> np.ndarray:
    """Return the pivots of a partial Cholesky factorisation of the kernel matrix, in memory ``n × count``.

    It stops early when the residual is spent. For a kernel that is not positive definite the negative part of the
    residual is passed over.

    Parameters
    ----------
    kernel : Kernel or callable
    X : (n, d)
    count : int
    randomised : bool
        Draw pivots in proportion to a power of the residual's diagonal (RPCholesky; Chen, Epperly, Tropp and Webber
        2023), instead of taking the largest (Fine and Scheinberg 2001).
    power : float
        1 reduces the expected trace of the residual, 2 its expected squared Frobenius norm (Steinerberger 2024).
    rng : seed or Generator
    """
    check_count(count, "sample count", high=X.shape[0])
    check_positive(power, "power")
    draw = np.random.default_rng(rng)
    residual = to_numpy(kernel_diagonal(kernel, X)).astype(float).clip(min=0.0)
    spent = 1e-14 * residual.max()
    factor = np.zeros((X.shape[0], count))
    taken: list[int] = []
    for i in range(count):
        pivot = _drawn(residual**power, draw) if randomised else int(np.argmax(residual))
        taken.append(pivot)
        column = to_numpy(kernel_matrix(kernel, X, X[pivot : pivot + 1, :]))[:, 0] - factor[:, :i] @ factor[pivot, :i]
        if not column[pivot] > 0:
            taken.pop()
            break
        factor[:, i] = column / np.sqrt(column[pivot])
        residual = (residual - factor[:, i] ** 2).clip(min=0.0)
        residual[taken] = 0.0
        if residual.max() <= spent:
            break
    return np.asarray(taken, dtype=np.int64)


def _drawn(weights: np.ndarray, draw: np.random.Generator) -> int:
    return int(draw.choice(len(weights), p=weights / weights.sum()))
