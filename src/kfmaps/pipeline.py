"""One fit: descriptors, kernel features, energy, conjugate gradients, point map, refinement."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from kfmaps._arrays import Array, inner, refuse, to_numpy
from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.descriptors import check_landmarks
from kfmaps.energy import (
    Energy,
    Term,
    descriptor_term,
    hadamard_term,
    kernel_descriptor_term,
    laplacian_term,
    slice_term,
)
from kfmaps.features import Descriptors, Features, kernel_features, pair_descriptors, resolved_kernel
from kfmaps.kernels import KernelLike, describe
from kfmaps.maps import to_points
from kfmaps.orientation import orientation_slices
from kfmaps.shape import Progress, Shape
from kfmaps.slices import compressed, packed_slices, unpacked_slices
from kfmaps.solvers import CG, Operator, Solution, solve
from kfmaps.spectrum import Basis

ORIENTATION_FEATURES = 40
"""Features whose orientation operators are formed: the strongest of the joint singular value decomposition."""


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
        Without landmarks, how clearly the map beat every distinct other one; see :mod:`kfmaps.automatic`.
    runners_up : tuple of arrays (n_t,)
        The distinct other maps, best first.
    verdict : "landmarks", "sure" or "ambiguous"
    scores : tuple of float
        Of the map and of each runner-up, higher is better; empty with landmarks.
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


@dataclass(frozen=True, eq=False)
class Problem:
    """The energy of a pair and what it was made from."""

    energy: Energy
    rank: int
    slices: int
    kernel: KernelLike


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


def problem(
    source: Shape,
    target: Shape,
    bases: tuple[Basis, Basis],
    descriptors: Descriptors,
    config: Config,
    rng: np.random.Generator,
) -> Problem:
    """The energy that ``config`` describes, ready to be minimised.

    ``bases`` are of at least the map's size and on the device of ``descriptors``.
    """
    small = (bases[0].truncated(config.basis.functions), bases[1].truncated(config.basis.functions))
    weights = config.weights
    terms: dict[str, Term] = {"laplacian": laplacian_term(*small)}
    if config.exact:
        kernel = resolved_kernel(descriptors, config, rng)
        arguments = (kernel, small[0], descriptors.source, small[1], descriptors.target)
        rank, slices = descriptors.source.shape[0] + descriptors.target.shape[0], 0
        if weights.descriptors:
            terms["descriptors"] = kernel_descriptor_term(*arguments)
        if weights.commutativity:
            terms["commutativity"] = hadamard_term(*arguments)
        if weights.orientation:
            raise refuse("orientation weight", "0 with the exact kernel", str(weights.orientation), "use features")
    else:
        features = kernel_features(source, target, descriptors, config, rng)
        kernel, rank, slices, size = features.kernel, int(features.source.shape[1]), 0, 0.0
        if weights.descriptors:
            terms["descriptors"] = descriptor_term(small[0], features.source, small[1], features.target)
        if weights.commutativity:
            packed = [
                packed_slices(b, F, threads=config.threads)
                for b, F in zip(small, (features.source, features.target), strict=True)
            ]
            packed_s, packed_t = packed
            if config.compression:
                packed_s, packed_t = compressed(packed_s, packed_t, config.compression)
            slices = int(packed_s.shape[0])
            size = inner(packed_s, packed_s) + inner(packed_t, packed_t)
            terms["commutativity"] = slice_term(unpacked_slices(packed_s), unpacked_slices(packed_t))
        if weights.orientation:
            terms["orientation"] = orientation_term(
                source, target, small, features, size or 2.0 * small[0].functions.shape[1]
            )
    return Problem(Energy(terms, {name: getattr(weights, name) for name in terms}), rank, slices, kernel)


def orientation_term(source: Shape, target: Shape, bases: tuple[Basis, Basis], features: Features, size: float) -> Term:
    """Commutativity with ``Ω_w[g] = n · (∇w × ∇g)`` for the strongest features (Ren et al. 2018).

    The operators change sign under a mirror, so the term prefers maps that keep orientation. Their summed squared
    norm is scaled to ``size``, that of the multiplication operators, so that the weights of both terms compare.
    """
    strongest = principal(bases, features, ORIENTATION_FEATURES)
    slices_s, slices_t = (
        orientation_slices(shape.mesh, basis, F)
        for shape, basis, F in zip((source, target), bases, (strongest.source, strongest.target), strict=True)
    )
    total = inner(slices_s, slices_s) + inner(slices_t, slices_t)
    scale = (size / total) ** 0.5 if total else 0.0
    return slice_term(slices_s * scale, slices_t * scale, parity=-1)


def principal(bases: tuple[Basis, Basis], features: Features, count: int) -> Features:
    """The ``count`` strongest directions of the features of both shapes, their common mean left out."""
    F = [to_numpy(features.source), to_numpy(features.target)]
    mass = [to_numpy(b.mass) for b in bases]
    mean = sum(m @ f / m.sum() for m, f in zip(mass, F, strict=True)) / 2
    F = [f - mean for f in F]
    gram = sum((f * m[:, None]).T @ f for m, f in zip(mass, F, strict=True))
    rotation = np.linalg.eigh(gram)[1][:, ::-1][:, :count]
    return Features(F[0] @ rotation, F[1] @ rotation, features.kernel)


def fit(
    source: Shape,
    target: Shape,
    config: Config | None = None,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
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
            used = pair_descriptors(source, target, bases, config.descriptors, pairs, descriptors)
        with stage("energy"):
            task = problem(source, target, bases, used, config, rng)
        with stage("solve"):
            solution = _minimised(task.energy, config, report)
            C = solution.value
        with stage("point map"):
            raw = to_points(C, *bases, threads=config.threads)
        points, refined_map = raw, C
        if config.refinement is not None:
            with stage("refinement"):
                refined = config.refinement(
                    C, *bases, progress=lambda done: report("refinement", done), threads=config.threads
                )
            points, refined_map = refined.target_to_source, refined.functional_map
    k_t, k_s = refined_map.shape
    return Match(
        target_to_source=points,
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


def _minimised(energy: Energy, config: Config, report: Progress) -> Solution:
    precondition = None
    if config.preconditioner == "jacobi":
        precondition = jacobi(energy.diagonal())
    limit = config.solver.max_steps if isinstance(config.solver, CG) else None

    def told(step: int, relative: float) -> None:
        if limit is not None and isinstance(config.solver, CG):
            # Whichever criterion is nearer to being met.
            by_size = np.log(max(relative, 1e-300)) / np.log(max(config.solver.rtol, 1e-16))
            report("solve", float(np.clip(max(step / limit, by_size), 0.0, 1.0)))

    return solve(energy.apply, energy.rhs(), config.solver, preconditioner=precondition, progress=told)


def jacobi(diagonal: Array) -> Operator:
    """Division by the diagonal; entries that the energy does not see are left as they are."""
    floor = 1e-12 * float(diagonal.max())
    safe = diagonal * (diagonal > floor) + (diagonal <= floor)
    return lambda r: r / safe
