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
from kfmaps.fmap.multiplication_operators import compressed, condensed, packed_slices, unpacked_slices
from kfmaps.fmap.solvers import CG
from kfmaps.geometry.basis import Basis
from kfmaps.matching.assemble import CONDENSATION, ORIENTATION_FEATURES, Problem, principal
from kfmaps.matching.features import Descriptors, kernel_features, pair_descriptors
from kfmaps.matching.robust_weights import believed
from kfmaps.matching.solve import minimiser
from kfmaps.shape import Shape, reduced

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
class Fit:
    """Settings of one candidate fit."""

    family: str
    functions: int
    orientation: float

    @property
    def name(self) -> str:
        return f"{self.family}, {self.functions} functions, orientation {self.orientation:g}"


def planned(config: Config, surfaces: bool = True) -> list[Fit]:
    """The fits of a search: small, quick, and different from each other.

    Point clouds (not ``surfaces``) have neither SHOT nor orientation.
    """
    assert config.search is not None
    sizes = [min(k, config.basis.functions) for k in SIZES]
    families = ("SHOT", "SHOT and waves") if config.descriptors.shot and surfaces else ("waves",)
    weights = ORIENTATION if surfaces else (0.0,) * 3
    found = [Fit(name, k, weight) for k, weight in zip(sizes, weights, strict=False) for name in families]
    return found[: config.search.candidates]


def described(family: str, base: DescriptorConfig) -> DescriptorConfig:
    """The descriptors of a family."""
    if family == LEARNED:
        return replace(base, landmark_map="none")
    both = replace(base, count=30)
    if family == "SHOT":
        return replace(both, signature="none", landmark_map="none")
    return both if family == "SHOT and waves" else replace(both, shot=False)


@dataclass(frozen=True, eq=False)
class Sampled:
    """Both shapes on the samples that fits are made from, their landmarks and given descriptors there."""

    shapes: tuple[Shape, Shape]
    landmarks: np.ndarray
    given: tuple[Any, Any] | None


def sampled(
    source: Shape, target: Shape, landmarks: np.ndarray, given: tuple[Any, Any] | None, rng: int = 0
) -> Sampled:
    parts = [reduced(shape, POINTS, landmarks[:, i], rng) for i, shape in enumerate((source, target))]
    rows = None
    if given is not None:
        values = [to_numpy(g) if hasattr(g, "shape") else np.asarray(g) for g in given]
        rows = values[0][parts[0].vertices], values[1][parts[1].vertices]
    marks = np.stack([part.landmarks for part in parts], axis=1)
    return Sampled((parts[0].shape, parts[1].shape), marks, rows)


def fitted_family(
    family: str,
    fits: list[Fit],
    on: Sampled,
    config: Config,
    cubes: tuple[np.ndarray | None, np.ndarray | None],
    seed: int,
) -> list[np.ndarray]:
    """The functional maps of the ``fits`` of one ``family``.

    ``cubes``: orientation operators ``(w, k, k)`` of the first functions of both shapes, k at least the largest size.
    """
    shapes, bases = on.shapes, (on.shapes[0].basis, on.shapes[1].basis)
    descriptors = described(family, config.descriptors)
    marks = on.landmarks if descriptors.landmark_map != "none" else on.landmarks[:0]
    used = believable(pair_descriptors(*shapes, bases, descriptors, marks, on.given), bases, config)
    size = min(max(f.functions for f in fits), *(b.functions.shape[1] for b in bases))
    low = (bases[0].truncated(size), bases[1].truncated(size))
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
    formed = condensed(low[0], features.source, low[1], features.target, CONDENSATION * rtol)
    packed = [packed_slices(b, F, threads=1) for b, F in zip(low, formed, strict=True)]
    slices = [unpacked_slices(p) for p in compressed(packed[0], packed[1], rtol)]
    turned: list[np.ndarray] = []
    known = [cube for cube in cubes if cube is not None]
    if len(known) == 2:
        strongest = principal(low, features, ORIENTATION_FEATURES)
        for basis, F, cube in zip(low, (strongest.source, strongest.target), known, strict=True):
            coefficients = basis.project(F)[: len(cube)]
            turned.append(np.tensordot(coefficients.T, cube[: len(coefficients)], axes=1))
    maps = []
    for fit in fits:
        k = min(fit.functions, size)
        bases_k = (low[0].truncated(k), low[1].truncated(k))
        blocks = [X[:, :k, :k] for X in slices]
        orientations = None
        if fit.orientation and turned:
            antisymmetric = [X[:, :k, :k] for X in turned]
            total = sum(inner(X, X) for X in antisymmetric)
            wanted = sum(inner(X, X) for X in blocks)
            scale = (wanted / total) ** 0.5 if total else 0.0
            orientations = (antisymmetric[0] * scale, antisymmetric[1] * scale)
        asked = replace(small, weights=replace(config.weights, orientation=fit.orientation))
        task = Problem(asked, bases_k, features.kernel, used, features, (blocks[0], blocks[1]), orientations)
        maps.append(to_numpy(minimiser(task, asked).solution.value))
    return maps


def believable(used: Descriptors, bases: tuple[Basis, Basis], config: Config) -> Descriptors:
    """``used``, weighed by a robust loss where the formulation has one; without landmarks theirs weighs nothing."""
    asked = config.formulation
    if not asked.weighs_data or (asked.loss_per == "landmark" and not (used.landmark >= 0).any()):
        return used
    return believed(used, bases, config).descriptors
