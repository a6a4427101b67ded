"""Refinements: frozen settings, callable as ``(C, source, target) -> Refined``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, check_count, namespace, refuse, take, to_numpy
from kfmaps.maps import to_functional, to_points
from kfmaps.sampling import farthest
from kfmaps.spectrum import Basis

Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Refined:
    """What a refinement returns.

    Attributes
    ----------
    functional_map : (k_t, k_s)
    target_to_source : (n_t,) int64
    history : tuple of int
        Basis size at each step (ZoomOut), or the number of points that changed (ICP).
    """

    functional_map: Array
    target_to_source: np.ndarray
    history: tuple[int, ...]


@dataclass(frozen=True)
class ICP:
    """Match, fit, take the nearest orthogonal matrix; ``steps`` times (Ovsjanikov et al. 2012).

    Needs a square map; stops early when no point changes.
    """

    steps: int = 5

    def __post_init__(self) -> None:
        check_count(self.steps, "ICP steps")

    def __call__(
        self,
        C: Array,
        source: Basis,
        target: Basis,
        progress: Progress | None = None,
        threads: int | None = None,
    ) -> Refined:
        k_t, k_s = C.shape
        if k_t != k_s:
            raise refuse("ICP", "a square functional map", f"{k_t} by {k_s}", "use equal basis sizes, or ZoomOut")
        xp = namespace(C)
        source, target = source.truncated(k_s), target.truncated(k_t)
        points = to_points(C, source, target, threads)
        changes: list[int] = []
        for step in range(self.steps):
            u, _, vh = xp.linalg.svd(to_functional(points, source, target), full_matrices=False)
            C = u @ vh
            moved = to_points(C, source, target, threads)
            changes.append(int(np.count_nonzero(moved != points)))
            points = moved
            if progress is not None:
                progress((step + 1) / self.steps)
            if changes[-1] == 0:
                break
        return Refined(C, points, tuple(changes))


@dataclass(frozen=True)
class ZoomOut:
    """Point map and functional map in turn while the basis grows (Melzi et al. 2019).

    Parameters
    ----------
    start : int
        First size; a larger map is truncated to it, a smaller one starts at its own size.
    stop : int
        Last size; both bases need as many functions.
    step : int
        Growth per step.
    samples : int or None
        Points of each shape that the steps before the last work on, with the functional map by least squares
        on them; ``None`` takes all. The last step always uses all points.
    seed : int
        For the choice of samples.
    """

    start: int = 20
    stop: int = 150
    step: int = 5
    samples: int | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        check_count(self.start, "ZoomOut start", low=2)
        check_count(self.stop, "ZoomOut stop", low=self.start)
        check_count(self.step, "ZoomOut step")
        if self.samples is not None:
            check_count(self.samples, "ZoomOut samples", low=2)

    def __call__(
        self,
        C: Array,
        source: Basis,
        target: Basis,
        progress: Progress | None = None,
        threads: int | None = None,
    ) -> Refined:
        available = min(source.functions.shape[1], target.functions.shape[1])
        if self.stop > available:
            remedy = "compute more eigenfunctions or lower stop"
            raise refuse("ZoomOut stop", f"at most the {available} eigenfunctions at hand", str(self.stop), remedy)
        first = min(self.start, *C.shape)
        C = C[:first, :first]
        sizes = [*range(first, self.stop, self.step), self.stop]
        coarse = self._coarse(source, target)
        for i, k in enumerate(sizes[:-1]):
            points = to_points(C, coarse[0], coarse[1], threads)
            C = self._fit(points, *coarse, min(k + self.step, self.stop))
            if progress is not None:
                progress((i + 1) / len(sizes))
        source, target = source.truncated(self.stop), target.truncated(self.stop)
        points = to_points(C, source, target, threads)
        C = to_functional(points, source, target)
        points = to_points(C, source, target, threads)
        if progress is not None:
            progress(1.0)
        return Refined(C, points, tuple(sizes))

    def _coarse(self, source: Basis, target: Basis) -> tuple[Basis, Basis]:
        if self.samples is None:
            return source, target
        rng = np.random.default_rng(self.seed)
        return spectral_samples(source, self.samples, rng)[1], spectral_samples(target, self.samples, rng)[1]

    def _fit(self, points: np.ndarray, source: Basis, target: Basis, k: int) -> Array:
        source, target = source.truncated(k), target.truncated(k)
        if self.samples is None:
            return to_functional(points, source, target)
        return least_squares(target.functions, take(source.functions, points))


def spectral_samples(basis: Basis, count: int, rng: int | np.random.Generator = 0) -> tuple[np.ndarray, Basis]:
    """Farthest points of a shape in its biharmonic embedding (Lipman et al. 2010), and the basis on them.

    Needs no mesh, and spreads evenly over the surface whatever its triangulation. At most the vertices there
    are; vertices that no face uses are passed over.
    """
    mass = to_numpy(basis.mass)
    candidates = np.flatnonzero(mass > 0)
    k = min(basis.functions.shape[1], 40)
    values = to_numpy(basis.eigenvalues)[:k]
    positive = values > 1e-6 * values[-1]
    embedding = to_numpy(basis.functions)[candidates][:, :k][:, positive] / values[positive]
    chosen = candidates[farthest(embedding, min(count, len(candidates)), rng)]
    xp = namespace(basis.functions)
    weights = xp.ones_like(basis.mass[: len(chosen)]) / len(chosen)
    return chosen, Basis(basis.eigenvalues, take(basis.functions, chosen), weights)


def least_squares(A: Array, B: Array, ridge: float = 1e-10) -> Array:
    """``X`` that minimises ``‖A X − B‖``, by normal equations with a relative ``ridge`` for safety."""
    xp = namespace(A)
    normal = A.T @ A
    size = float(xp.linalg.trace(normal)) / normal.shape[0]
    return xp.linalg.solve(normal + ridge * size * xp.eye(normal.shape[0], dtype=A.dtype, device=A.device), A.T @ B)


Refinement = ICP | ZoomOut
