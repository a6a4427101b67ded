"""Fit a functional map: descriptors, kernel features, energy, its minimizer.

Its point map and refinement follow in :mod:`kfmaps.matching.finish`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from kfmaps._arrays import Array, like, refuse, seed_of
from kfmaps._progress import Progress, StageTimer
from kfmaps._threads import limit_threads, one_blas_thread
from kfmaps.config import Config
from kfmaps.descriptors.spectral import check_landmarks
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.losses import Loss, RobustData
from kfmaps.fmap.minimize import MinimizeOptions, Objective, minimize
from kfmaps.fmap.multiplication_operators import multiplication_operators, unpack_operators
from kfmaps.fmap.solvers import CG
from kfmaps.fmap.terms import laplacian_term
from kfmaps.geometry.basis import Basis
from kfmaps.matching.assemble import assemble
from kfmaps.matching.features import Descriptors, pair_descriptors, sample_pair_for_fit, user_descriptors
from kfmaps.matching.solve import Fit, solve_problem
from kfmaps.shape import Shape


@dataclass(frozen=True, eq=False)
class FitPoints:
    """The points of two shapes that a fit is made from, with their bases and descriptors."""

    shapes: tuple[Shape, Shape]  # all points, or samples of them
    bases: tuple[Basis, Basis]  # on the device of the computation
    descriptors: Descriptors
    weights: np.ndarray | None = None  # (g,): of each landmark or descriptor under a robust loss


def check_landmark_pairs(landmarks: ArrayLike | None, source: Shape, target: Shape) -> np.ndarray:
    """Return ``landmarks`` as ``(l, 2)`` int64 "source, target"; ``None`` is none.

    They are refused unless they are pairs of vertices that exist, none repeated on either shape.
    """
    pairs = np.asarray(() if landmarks is None else landmarks)
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
    landmarks: ArrayLike | None = None,
    descriptors: tuple[Array, Array] | None = None,
    rng: int | np.random.Generator | None = 0,
    start: Array | None = None,
    progress: Progress | None = None,
) -> Fit:
    """Fit a functional map to two prepared shapes as ``config`` says.

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
        Seed of the points that the fit is made from, and of the samples for the kernel.
    start : (k, k) array, optional
        Functional map that conjugate gradients start from; zero by default.
    progress : callable, optional
        ``progress(stage, done)`` with done from 0 to 1.

    Warns
    -----
    KfmapsWarning
        When the solver broke down, so that the map is not the minimiser.
    """
    config = config or Config.single_fit()
    clock = StageTimer(progress)
    seed = seed_of(rng)
    pairs = check_landmark_pairs(landmarks, source, target)
    with limit_threads(config.threads), one_blas_thread():
        with clock("descriptors"):
            points = fit_points(source, target, config, pairs, descriptors, seed)
        with clock("energy"):
            task = assemble(
                *points.shapes, points.bases, points.descriptors, config, np.random.default_rng(seed), (source, target)
            )
        with clock("solve"):
            result = solve_problem(task, clock.report, start)
    return replace(result, seconds=clock.seconds, weights=points.weights)


def fit_points(
    source: Shape,
    target: Shape,
    config: Config,
    landmarks: np.ndarray,
    descriptors: tuple[Array, Array] | None = None,
    rng: int | np.random.Generator = 0,
) -> FitPoints:
    """Return points of both shapes as ``config.fit_samples`` says, with the ``landmarks (l, 2)``, and descriptors."""
    descriptors = user_descriptors(source, target, config.descriptors, descriptors)
    sampled = sample_pair_for_fit(source, target, config.fit_samples, landmarks, descriptors, rng)
    shapes, bases = sampled.shapes, (sampled.shapes[0].basis, sampled.shapes[1].basis)
    if config.device != "cpu":
        bases = (bases[0].to(config.device), bases[1].to(config.device))
    joint = pair_descriptors(*shapes, bases, config.descriptors, sampled.landmarks, sampled.descriptors)
    if not config.formulation.weighs_data:
        return FitPoints(shapes, bases, joint)
    return FitPoints(shapes, bases, *robust_weights(joint, bases, config))


def robust_weights(
    descriptors: Descriptors, bases: tuple[Basis, Basis], config: Config
) -> tuple[Descriptors, np.ndarray]:
    """Return ``descriptors`` times square roots of the weights of a robust loss, and the weights (g,).

    A wrong landmark spoils every value of a kernel of all descriptors. With the linear kernel the energy is a sum over
    descriptors, and a robust loss of each landmark's, or of each descriptor, is minimised by reweighting a small fit
    (:class:`kfmaps.fmap.losses.RobustData`). Descriptors of no landmark keep their size when the loss is per landmark.
    """
    formulation = config.formulation
    if formulation.loss_group == "landmark":
        groups = descriptors.landmark
        if not (groups >= 0).any():
            raise refuse("loss per landmark", "landmarks with maps of their own", "none", "take it per descriptor")
    else:
        groups = np.arange(descriptors.source.shape[1])
    enough = 30  # functions to recognize a wrong landmark, in a tenth of the time
    k = min(enough, config.basis.n_eigenfunctions)
    small = [basis.truncate(k) for basis in bases]
    sides = (descriptors.source, descriptors.target)
    P = [basis.project(D) for basis, D in zip(small, sides, strict=True)]
    X = [unpack_operators(multiplication_operators(b, D)) for b, D in zip(small, sides, strict=True)]
    weights = config.weights
    unit = weights.descriptors or 1.0
    data = RobustData(P[0], P[1], groups, Loss("squared"), X[0], X[1], weights.commutativity / unit)
    laplacian = Energy(
        {"laplacian": laplacian_term(small[0], small[1])}, {"laplacian": max(weights.laplacian / unit, 1e-6)}
    )
    options = MinimizeOptions(CG(rtol=1e-4, max_iter=500), max_outer_iter=formulation.max_outer_iter, rtol=1e-3)
    C = minimize(Objective(laplacian, {"data": (1.0, data)}), replace(options, max_outer_iter=1)).value
    robust = replace(data, loss=Loss(formulation.loss)).scaled(C, formulation.loss_scale)
    C = minimize(Objective(laplacian, {"data": (1.0, robust)}), options, C).value
    columns = robust.weights(C)
    columns = np.where(groups < 0, 1.0, columns / max(1.0, float(columns[groups >= 0].max())))
    root = like(np.sqrt(columns), descriptors.source)[None, :]
    scaled = replace(descriptors, source=descriptors.source * root, target=descriptors.target * root)
    numbers, first = np.unique(groups, return_index=True)
    return scaled, columns[first[numbers >= 0]]
