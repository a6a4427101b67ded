"""One fit: descriptors, kernel features, energy, conjugate gradients, point map, refinement."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from kfmaps._arrays import check, like, refuse, to_numpy
from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.descriptors.spectral import check_landmarks
from kfmaps.fit.features import pair_descriptors
from kfmaps.fit.problem import problem
from kfmaps.fit.shape import Progress, Reduced, Shape, reduced
from kfmaps.functional.energy import Energy
from kfmaps.functional.points import to_points
from kfmaps.functional.preconditioners import jacobi, sylvester
from kfmaps.functional.solvers import CG, Solution, solve
from kfmaps.kernel.kernels import describe


@dataclass(frozen=True, eq=False)
class Match:
    """The answer of a match.

    Attributes
    ----------
    target_to_source : (n_t,) int64
        A source vertex for each target vertex, refined when the configuration says so.
    functional_map : (k_t, k_s) float64
        Carries coefficients of functions from source to target; of the refined map.
    raw_target_to_source : (n_t,) int64
        The point map of the fit, before refinement.
    raw_functional_map : (k, k) float64
        The minimiser itself.
    eigenvalues_s, eigenvalues_t : (k_s,), (k_t,) float64
        Of the shapes at unit area, as many as ``functional_map`` has columns and rows.
    solution : Solution
        Status, steps and residuals of the solver; ``value`` is ``raw_functional_map``.
    energies : dict of str to float
        Weighted value of each term at the minimiser.
    rank : int
        Features of the kernel that were kept.
    slices : int
        Slices left after compression.
    kernel : str
        With every γ a number.
    config : Config
    seconds : dict of str to float
        Per stage.
    confidence : float or None
        Without landmarks, how clearly the map beat every distinct other one; see :mod:`kfmaps.search.choose`.
    runners_up : tuple of arrays (n_t,)
        The distinct other maps, best first.
    verdict : "landmarks", "sure", "ambiguous", "poor" or "unchecked"
    scores : tuple of float
        Of the map and of each runner-up, higher is better; empty with landmarks.
    local_confidence : (n_t,) float64 or None
        How well the map keeps distances around each target vertex, 0 to 1; see
        :mod:`kfmaps.functional.confidence`. ``None`` from a fit alone.
    """

    target_to_source: np.ndarray
    functional_map: np.ndarray
    raw_target_to_source: np.ndarray
    raw_functional_map: np.ndarray
    eigenvalues_s: np.ndarray
    eigenvalues_t: np.ndarray
    solution: Solution
    energies: dict[str, float]
    rank: int
    slices: int
    kernel: str
    config: Config
    seconds: dict[str, float]
    confidence: float | None = None
    runners_up: tuple[np.ndarray, ...] = ()
    verdict: str = "landmarks"
    scores: tuple[float, ...] = ()
    local_confidence: np.ndarray | None = None


def checked_landmarks(landmarks: Any, source: Shape, target: Shape) -> np.ndarray:
    """``landmarks`` as ``(l, 2)`` int64 "source, target"; ``None`` is none.

    Raises
    ------
    InvalidInput
        Unless they are pairs of vertices that exist, none repeated on either shape.
    """
    if landmarks is None:
        return np.zeros((0, 2), dtype=np.int64)
    pairs = np.asarray(landmarks)
    if pairs.size == 0:
        return np.zeros((0, 2), dtype=np.int64)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        remedy = "give one pair a row: source vertex, target vertex"
        raise refuse("landmarks", "shape (number, 2)", f"shape {pairs.shape}", remedy)
    columns = [
        check_landmarks(pairs[:, i], len(shape.mesh.vertices), f"landmarks on {shape.name}")
        for i, shape in enumerate((source, target))
    ]
    return np.stack(columns, axis=1)


def fit(
    source: Shape,
    target: Shape,
    config: Config | None = None,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
    start: Any = None,
    progress: Progress | None = None,
) -> Match:
    """Match two prepared shapes as ``config`` says, with no search for the best of several maps.

    Parameters
    ----------
    source, target : Shape
        From :func:`kfmaps.prepare`, with the same basis settings.
    config : Config, optional
    landmarks : (l, 2) whole numbers, optional
        Pairs "source vertex, target vertex", 0-based.
    descriptors : pair of arrays (n_s, d), (n_t, d), optional
        Of the user's own, used beside those that the configuration names.
    rng : seed or Generator
        For the choice of samples.
    start : (k, k) array, optional
        Functional map that conjugate gradients start from, zero otherwise: the ``raw_functional_map`` of settings
        near to these spares steps in a search over settings.
    progress : callable, optional
        ``progress(stage, done)`` with done from 0 to 1.
    """
    config = config or Config()
    report = progress or (lambda _stage, _done: None)
    rng = np.random.default_rng(rng)
    pairs = checked_landmarks(landmarks, source, target)
    seconds: dict[str, float] = {}

    @contextmanager
    def stage(name: str) -> Iterator[None]:
        start = time.perf_counter()
        report(name, 0.0)
        yield
        seconds[name] = time.perf_counter() - start
        report(name, 1.0)

    bases = (source.basis, target.basis)
    if config.device != "cpu":
        bases = (bases[0].to(config.device), bases[1].to(config.device))
    with one_blas_thread():
        with stage("descriptors"):
            parts = [reduced(s, config.fit_samples, pairs[:, i]) for i, s in enumerate((source, target))]
            points = [
                b if part.shape is s else part.shape.basis.to(config.device)
                for b, part, s in zip(bases, parts, (source, target), strict=True)
            ]
            small, on = (parts[0].shape, parts[1].shape), (points[0], points[1])
            marks = np.stack([part.landmarks for part in parts], axis=1)
            if descriptors is not None:
                descriptors = _on_samples(descriptors, parts, (source, target))
            used = pair_descriptors(*small, on, config.descriptors, marks, descriptors)
        with stage("energy"):
            task = problem(*small, on, used, config, rng, (source, target))
        with stage("solve"):
            solution = _minimised(task.energy, config, report, start)
            C = solution.value
        with stage("point map"):
            raw = to_points(C, *bases, threads=config.threads)
        answer, refined_map = raw, C
        if config.refinement is not None:
            with stage("refinement"):
                refined = config.refinement(
                    C, *bases, progress=lambda done: report("refinement", done), threads=config.threads, points=raw
                )
            answer, refined_map = refined.target_to_source, refined.functional_map
    k_t, k_s = refined_map.shape
    return Match(
        target_to_source=answer,
        functional_map=to_numpy(refined_map),
        raw_target_to_source=raw,
        raw_functional_map=to_numpy(C),
        eigenvalues_s=to_numpy(source.basis.eigenvalues)[:k_s],
        eigenvalues_t=to_numpy(target.basis.eigenvalues)[:k_t],
        solution=solution,
        energies=task.energy.breakdown(C),
        rank=task.rank,
        slices=task.slices,
        kernel=describe(task.kernel),
        config=config,
        seconds=seconds,
        verdict="landmarks" if len(pairs) else "unchecked",
    )


def _on_samples(given: tuple[Any, Any], parts: list[Reduced], shapes: tuple[Shape, Shape]) -> tuple[Any, Any]:
    """The rows of descriptors of the user's own that belong to the samples."""
    rows = []
    for values, part, shape in zip(given, parts, shapes, strict=True):
        values = to_numpy(values) if hasattr(values, "shape") else np.asarray(values)
        n = len(shape.mesh.vertices)
        check(values, f"descriptors of {shape.name}", shape=(n, None), remedy="give one row per vertex")
        rows.append(values[part.vertices])
    return rows[0], rows[1]


def _minimised(energy: Energy, config: Config, report: Progress, start: Any = None) -> Solution:
    right = energy.rhs()
    if start is not None:
        start = np.asarray(to_numpy(start) if hasattr(start, "shape") else start, dtype=np.float64)
        check(start, "start", shape=tuple(right.shape), remedy="give a functional map of the size of the basis")
        start = like(start, right)
    precondition = None
    if config.preconditioner == "jacobi":
        precondition = jacobi(energy.diagonal())
    elif config.preconditioner == "sylvester":
        precondition = sylvester(energy)
    limit = config.solver.max_steps if isinstance(config.solver, CG) else None

    def told(step: int, relative: float) -> None:
        if limit is not None and isinstance(config.solver, CG):
            # Whichever criterion is nearer to being met.
            by_size = np.log(max(relative, 1e-300)) / np.log(max(config.solver.rtol, 1e-16))
            report("solve", float(np.clip(max(step / limit, by_size), 0.0, 1.0)))

    return solve(energy.apply, right, config.solver, start, precondition, told)
