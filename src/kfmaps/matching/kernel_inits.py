"""Small kernel fits of samples: maps to start from where the functions of two shapes differ by more than signs.

A family of fits shares its descriptors, features and slices, which are worked out once, for its largest size; a smaller
fit takes their leading blocks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kfmaps._arrays import inner, to_numpy
from kfmaps.config import Config, DescriptorConfig
from kfmaps.fmap.multiplication_operators import (
    multiplication_operators,
    truncate_features,
    truncate_operators,
    unpack_operators,
)
from kfmaps.fmap.solvers import CG
from kfmaps.geometry.basis import Basis
from kfmaps.matching.assemble import CONDENSATION, ORIENTATION_FEATURES, FitProblem, principal_features
from kfmaps.matching.features import Descriptors, kernel_features, pair_descriptors
from kfmaps.matching.robust_weights import robust_weights
from kfmaps.matching.solve import minimize_problem
from kfmaps.shape import Shape, sample_shape

LEARNED = "learned"
"""The family of fits with a learned kernel, see :mod:`kfmaps.matching.learned_kernel`."""
POINTS = 2000
"""Samples of each shape that a fit is made from."""
SIZES = (20, 50, 20, 35, 50, 35)
ORIENTATION = (0.1, 0.1, 1.0, 0.1, 1.0, 1.0)
"""Functions, and weight of orientation, of a family's fits, in the order of how often each was right."""
COMPRESSION = 1e-3
NYSTROM = 200
SOLVER = CG(rtol=1e-4, max_steps=200)


@dataclass(frozen=True)
class FitSpec:
    """Settings of one candidate fit."""

    descriptor_set: str
    functions: int
    orientation: float

    @property
    def name(self) -> str:
        return f"{self.descriptor_set}, {self.functions} functions, orientation {self.orientation:g}"


def plan_fits(config: Config, surfaces: bool = True) -> list[FitSpec]:
    """The fits of a search: small, quick, and different from each other.

    Point clouds (not ``surfaces``) have neither SHOT nor orientation.
    """
    assert config.search is not None
    sizes = [min(k, config.basis.functions) for k in SIZES]
    families = ("SHOT", "SHOT and waves") if config.descriptors.shot and surfaces else ("waves",)
    weights = ORIENTATION if surfaces else (0.0,) * 3
    found = [FitSpec(name, k, weight) for k, weight in zip(sizes, weights, strict=False) for name in families]
    return found[: config.search.candidates]


def descriptor_config(family: str, base: DescriptorConfig) -> DescriptorConfig:
    """The descriptors of a family."""
    if family == LEARNED:
        return replace(base, landmark_map="none")
    both = replace(base, count=30)
    if family == "SHOT":
        return replace(both, signature="none", landmark_map="none")
    return both if family == "SHOT and waves" else replace(both, shot=False)


@dataclass(frozen=True, eq=False)
class SampledPair:
    """Both shapes on the samples that fits are made from, their landmarks and given descriptors there."""

    shapes: tuple[Shape, Shape]
    landmarks: np.ndarray
    given: tuple[Any, Any] | None


def sample_shapes(
    source: Shape, target: Shape, landmarks: np.ndarray, given: tuple[Any, Any] | None, rng: int = 0
) -> SampledPair:
    parts = [sample_shape(shape, POINTS, landmarks[:, i], rng) for i, shape in enumerate((source, target))]
    rows = None
    if given is not None:
        values = [to_numpy(g) if hasattr(g, "shape") else np.asarray(g) for g in given]
        rows = values[0][parts[0].vertices], values[1][parts[1].vertices]
    marks = np.stack([part.landmarks for part in parts], axis=1)
    return SampledPair((parts[0].shape, parts[1].shape), marks, rows)


def fit_descriptor_set(
    family: str,
    fits: list[FitSpec],
    on: SampledPair,
    config: Config,
    cubes: tuple[np.ndarray | None, np.ndarray | None],
    seed: int,
) -> list[np.ndarray]:
    """The functional maps of the ``fits`` of one ``family``.

    ``cubes``: orientation operators ``(w, k, k)`` of the first functions of both shapes, k at least the largest size.
    """
    shapes, bases = on.shapes, (on.shapes[0].basis, on.shapes[1].basis)
    descriptors = descriptor_config(family, config.descriptors)
    marks = on.landmarks if descriptors.landmark_map != "none" else on.landmarks[:0]
    used = is_usable(pair_descriptors(*shapes, bases, descriptors, marks, on.given), bases, config)
    size = min(max(f.functions for f in fits), *(b.functions.shape[1] for b in bases))
    low = (bases[0].truncate(size), bases[1].truncate(size))
    # Both directions at once are for the answer; a candidate is refined one way.
    small = replace(
        config,
        nystrom=replace(config.nystrom, samples=min(NYSTROM, config.nystrom.samples)),
        exact=False,
        solver=SOLVER,
        preconditioner="sylvester",
        formulation=replace(config.formulation, directions="one"),
    )
    features = kernel_features(*shapes, used, small, np.random.default_rng(seed))
    rtol = max(config.compression, COMPRESSION)
    formed = truncate_features(low[0], features.source, low[1], features.target, CONDENSATION * rtol)
    packed = [multiplication_operators(b, F, threads=1) for b, F in zip(low, formed, strict=True)]
    slices = [unpack_operators(p) for p in truncate_operators(packed[0], packed[1], rtol)]
    turned: list[np.ndarray] = []
    known = [cube for cube in cubes if cube is not None]
    if len(known) == 2:
        strongest = principal_features(low, features, ORIENTATION_FEATURES)
        for basis, F, cube in zip(low, (strongest.source, strongest.target), known, strict=True):
            coefficients = basis.project(F)[: len(cube)]
            turned.append(np.tensordot(coefficients.T, cube[: len(coefficients)], axes=1))
    maps = []
    for fit in fits:
        k = min(fit.functions, size)
        bases_k = (low[0].truncate(k), low[1].truncate(k))
        blocks = [X[:, :k, :k] for X in slices]
        orientations = None
        if fit.orientation and turned:
            antisymmetric = [X[:, :k, :k] for X in turned]
            total = sum(inner(X, X) for X in antisymmetric)
            wanted = sum(inner(X, X) for X in blocks)
            scale = (wanted / total) ** 0.5 if total else 0.0
            orientations = (antisymmetric[0] * scale, antisymmetric[1] * scale)
        asked = replace(small, weights=replace(config.weights, orientation=fit.orientation))
        task = FitProblem(asked, bases_k, features.kernel, used, features, (blocks[0], blocks[1]), orientations)
        maps.append(to_numpy(minimize_problem(task, asked).solution.value))
    return maps


def is_usable(used: Descriptors, bases: tuple[Basis, Basis], config: Config) -> Descriptors:
    """``used``, weighed by a robust loss where the formulation has one; without landmarks theirs weighs nothing."""
    asked = config.formulation
    if not asked.weighs_data or (asked.loss_per == "landmark" and not (used.landmark >= 0).any()):
        return used
    return robust_weights(used, bases, config).descriptors
