"""Solvers for ``A(x) = b`` with ``A`` linear, self-adjoint and positive semi-definite.

They know nothing of maps or meshes: ``apply`` is a function from an array to one of the same shape, and the inner
product is the sum of elementwise products, so a matrix ``C`` is a vector like any other and no Kronecker system is ever
formed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from kfmaps._arrays import Array, inner, like, namespace, refuse, to_numpy
from kfmaps._records import check_record, setting, settings_record, short_repr

Status = Literal["converged", "step limit", "breakdown"]
Operator = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Solution:
    """What a solver returns."""

    value: Array  # the last iterate whose residual is finite, of the shape of ``b``
    # ``"converged"``: the residual is at most ``rtol ‖b‖``; ``"step limit"``: the steps ran out first; ``"breakdown"``:
    # a direction without positive curvature or a number that is not finite was met
    status: Status
    steps: int  # applications of the operator in the iteration
    # (steps + 1,): ``‖b − A(x)‖`` before the first step and after each, as the recurrence carries it
    residuals: np.ndarray

    __repr__ = short_repr


@settings_record
class CG:
    """Conjugate gradients on an array of any shape (figure 1 of the paper), optionally preconditioned.

    Stops at ``‖r‖ <= rtol ‖b‖`` or after ``max_iter``. The paper's "10 iterations" is ``CG(max_iter=10)``. Unlike
    SciPy's, it keeps every residual and reports a breakdown instead of returning silently.

    Raises
    ------
    InvalidInput
        When neither criterion could ever stop it.

    Examples
    --------
    >>> kfmaps.Config(solver=kfmaps.CG(max_iter=10)).solver
    CG(max_iter=10)
    """

    rtol: float = setting(1e-6, "relative residual at which CG stops", low=0)
    max_iter: int | None = setting(1000, "steps after which CG stops (max steps)", low=1)

    def __post_init__(self) -> None:
        check_record(self)
        if self.max_iter is None and self.rtol == 0:
            raise refuse("CG", "a way to stop", "rtol 0 and no step limit", "set rtol or max_iter")


@settings_record
class Direct:
    """The dense system, column by column, solved by least squares: for tests and small bases.

    Examples
    --------
    >>> kfmaps.Config(solver=kfmaps.Direct()).solver
    Direct()
    """

    limit: int = setting(4000, "most unknowns that the dense solver takes", low=1)


Solver = CG | Direct


def solve(
    apply: Operator,
    b: Array,
    solver: Solver,
    x0: Array | None = None,
    preconditioner: Operator | None = None,
    progress: Callable[[int, float], None] | None = None,
) -> Solution:
    """Solve ``apply(x) = b``.

    Parameters
    ----------
    apply : callable
        Linear, self-adjoint, positive semi-definite map from arrays of ``b``'s shape to the same.
    b : array
    solver : CG or Direct
    x0 : array, optional
        Where to start; zero otherwise.
    preconditioner : callable, optional
        Approximate inverse of ``apply``, itself self-adjoint and positive definite. Ignored by ``Direct``.
    progress : callable, optional
        Called after each step with the step's number and the relative residual.
    """
    if isinstance(solver, Direct):
        return _direct(apply, b, solver)
    x = namespace(b).zeros_like(b) if x0 is None else x0
    r = b if x0 is None else b - apply(x0)
    size = inner(b, b) ** 0.5
    residuals = [inner(r, r) ** 0.5]
    limit = np.inf if solver.max_iter is None else solver.max_iter
    p, rz = None, 0.0
    while (status := reason_to_stop(residuals, solver.rtol * size, limit)) is None:
        z = r if preconditioner is None else preconditioner(r)
        previous, rz = rz, inner(r, z)
        p = z if p is None else z + (rz / previous) * p
        q = apply(p)
        curvature = inner(p, q)
        if not (curvature > 0 and np.isfinite(curvature) and rz > 0):
            status = "breakdown"
            break
        step = rz / curvature
        following = x + step * p
        r = r - step * q
        residuals.append(inner(r, r) ** 0.5)
        if np.isfinite(residuals[-1]):
            x = following
        if progress is not None:
            progress(len(residuals) - 1, residuals[-1] / size if size else 0.0)
    return Solution(x, status, len(residuals) - 1, np.asarray(residuals))


def reason_to_stop(residuals: list[float], enough: float, limit: float) -> Status | None:
    """Return why an iteration with these ``residuals``, one more than steps, ends; ``None`` where it goes on.

    ``enough``: the residual that is asked for; ``limit``: the most steps.
    """
    if not np.isfinite(residuals[-1]):
        return "breakdown"
    if residuals[-1] <= enough:
        return "converged"
    return "step limit" if len(residuals) > limit else None


def dense_matrix(apply: Operator, shape: tuple[int, ...], example: Array) -> np.ndarray:
    """Return the matrix of ``apply`` on arrays of ``shape``, flattened in row-major order.

    For small sizes. ``example`` is an array of the namespace and device that ``apply`` works in.
    """
    size = int(np.prod(shape))
    columns = np.empty((size, size))
    for j in range(size):
        unit = np.zeros(size)
        unit[j] = 1.0
        columns[:, j] = to_numpy(apply(like(unit.reshape(shape), example))).ravel()
    return columns


def _direct(apply: Operator, b: Array, solver: Direct) -> Solution:
    size = int(np.prod(b.shape))
    if size > solver.limit:
        remedy = "use CG, or raise Direct(limit=...) and have the memory"
        raise refuse("Direct", f"at most {solver.limit} unknowns", str(size), remedy)
    matrix = dense_matrix(apply, tuple(b.shape), b)
    right = to_numpy(b).ravel()
    # Least squares, not Cholesky: a linear kernel with few descriptors leaves the system singular.
    flat = np.linalg.lstsq(matrix, right, rcond=None)[0]
    residuals = np.array([np.linalg.norm(right), np.linalg.norm(right - matrix @ flat)])
    status: Status = "converged" if residuals[1] <= 1e-8 * max(residuals[0], 1e-300) else "breakdown"
    return Solution(like(flat.reshape(b.shape), b), status, size, residuals)
