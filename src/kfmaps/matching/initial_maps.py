"""Initial maps of a search: sign choices, extremity matches, small kernel fits, near-symmetries.

Diagonal functional maps with every choice of signs of the low functions contain all symmetries of near-isometric bodies
(MapTree, Ren et al. 2020). Kernel fits of samples start where the functions of two shapes differ by more than signs.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from kfmaps._arrays import inner, refuse
from kfmaps._threads import parallel
from kfmaps.config import Config
from kfmaps.fmap.multiplication_operators import unpack_operators
from kfmaps.fmap.solvers import CG
from kfmaps.geometry.basis import Basis
from kfmaps.kernels.transformed import descriptor_width, n_kernel_landmarks
from kfmaps.matching.assemble import (
    ORIENTATION_FEATURES,
    FitProblem,
    compressed_operators,
    principal_features,
    scale_operators,
)
from kfmaps.matching.extremity_matching import ExtremityMatch, match_extremities
from kfmaps.matching.features import Descriptors, Features, SampledPair, kernel_features, pair_descriptors
from kfmaps.matching.fit import robust_weights
from kfmaps.matching.sample_pair import (
    EXTREMITY_FUNCTIONS,
    STRONG,
    CostWeights,
    SamplePair,
    TwoLevelSamples,
    paired_map,
)
from kfmaps.matching.score import Candidate
from kfmaps.matching.self_maps import self_maps
from kfmaps.matching.solve import Fit, minimize_problem

WEAK: CostWeights = (4.0, 12.0)
COARSE_WEIGHTS: tuple[CostWeights, ...] = ((0.0, 0.0), STRONG, WEAK)
"""Weights of sign maps in the coarse refinement; with zero weights symmetric maps are found too."""
EXTREMITY_WEIGHTS: CostWeights = (4.0, 12.0, 30.0)
START_SIZES = (6, 10, 20)
"""Functions that the coarse refinement of a fit starts from. With few it repairs maps that are wrong in part, even
between shapes that are far from isometric; with many it keeps what is right."""
FIT_SAMPLES = 2000
"""Samples of each shape that a fit is made from."""


@dataclass(frozen=True, eq=False)
class Start:
    """An initial map, and how it is refined."""

    name: str
    functional_map: np.ndarray  # (k, k)
    uses_descriptors: bool = True  # whether descriptors take part in the refinement
    weights: CostWeights = ()
    functions: int = 0  # of the first step of the coarse refinement
    match: ExtremityMatch | None = None
    fit: Fit | None = None
    points: np.ndarray | None = None  # (q_t,): a source sample for each target sample, where they are known


@dataclass(frozen=True)
class FitSpec:
    """Settings of one small fit."""

    descriptor_set: str
    functions: int
    orientation: float

    @property
    def name(self) -> str:
        return f"{self.descriptor_set}, {self.functions} functions, orientation {self.orientation:g}"


def distinct_weights(weights: Iterable[CostWeights], pair: SamplePair) -> list[CostWeights]:
    """Return the distinct ``weights``, 0 for costs of SHOT and of landmarks that the samples do not have."""
    known = (pair.descriptor_cost is not None, pair.landmark_cost is not None, True)
    return list(dict.fromkeys(tuple(w if k else 0.0 for w, k in zip(each, known, strict=False)) for each in weights))


def sign_inits(count: int, pair: SamplePair, weights: Iterable[CostWeights]) -> list[Start]:
    """Return diagonal maps with all signs of ``count`` functions after the constant one, with all ``weights``."""
    if count == 0:
        return []
    return [
        Start(
            f"signs {''.join('+' if s > 0 else '-' for s in signs)}, weight {w[0]:g}",
            np.diag([1.0, *signs]),
            bool(w[0]) or pair.descriptor_cost is None,
            w,
            count + 1,
        )
        for w in distinct_weights(weights, pair)
        for signs in product((1, -1), repeat=count)
    ]


def repeated_starts(maps: Iterable[tuple[str, np.ndarray, Fit | None]], pair: SamplePair) -> list[Start]:
    """Return starts of ``maps``, each with its name and fit, from several sizes and with several weights."""
    weights = (WEAK, STRONG)  # of kernel fits and of maps composed with self-maps
    return [
        Start(f"{name}, from {size}, weight {w[0]:g}", C, True, w, size, fit=fit)
        for name, C, fit in maps
        for size in START_SIZES
        for w in distinct_weights(weights, pair)
    ]


def extremity_inits(functions: int, pair: SamplePair) -> list[Start]:
    """Return the maps of likely extremity matches (:mod:`kfmaps.matching.extremity_matching`)."""
    size = min(EXTREMITY_FUNCTIONS, functions)
    weights = distinct_weights([EXTREMITY_WEIGHTS], pair)[0]
    matches = match_extremities(pair.source, pair.target, pair.descriptor_cost)
    return [Start(f"{match}", paired_map(match, pair, size), True, weights, size, match) for match in matches]


def symmetry_inits(best: list[Candidate], pair: SamplePair, functions: int) -> list[Start]:
    """Return the ``best`` candidates composed with the self-maps of both shapes.

    So a search compares its best map with the maps that it may be mistaken for, whether or not it has found them.
    """
    self_maps_s, self_maps_t = (self_maps(side, functions) for side in (pair.source, pair.target))
    composed = []
    for i, candidate in enumerate(best):
        C = candidate.functional_map
        factors = [*((C, S) for S in self_maps_s), *((S, C) for S in self_maps_t)]
        composed += [(f"self-map {i}", A[: len(B), : len(B)] @ B[: len(A), : len(A)], None) for A, B in factors]
    return repeated_starts(composed, pair)


def kernel_inits(points: SampledPair, config: Config, samples: TwoLevelSamples, seed: int) -> list[Start]:
    """Return small kernel fits, each to be refined from several sizes and with several weights of the descriptors."""
    operators = samples.fine.source.orientation, samples.fine.target.orientation
    specs = plan_fits(config, samples.fine.are_surfaces)

    def starts(name: str) -> list[Start]:
        members = [spec for spec in specs if spec.descriptor_set == name]
        fits = fit_descriptor_set(members, points, config, operators, seed)
        named = [(spec.name, fit.functional_map, fit) for spec, fit in zip(members, fits, strict=True)]
        return repeated_starts(named, samples.coarse)

    names = dict.fromkeys(spec.descriptor_set for spec in specs)
    return [start for several in parallel(starts, names) for start in several]


def drop_learned(config: Config) -> Config:
    """Return ``config`` without what :mod:`kfmaps.learn` learns from descriptors: in a search it changes no map.

    A kernel that was learned with landmarks is refused.
    """
    if descriptor_width(config.kernel) is None:
        return config
    if n_kernel_landmarks(config.kernel):
        got = f"one learned with {n_kernel_landmarks(config.kernel)} landmarks"
        raise refuse("kernel of a search", "one without landmarks", got, "set search to none, or leave the kernel out")
    usual = Config()
    formulation = replace(config.formulation, mask=usual.formulation.mask, mask_power=usual.formulation.mask_power)
    changed = {name: getattr(usual, name) for name in ("kernel", "bandwidth_scale", "weights")}
    return replace(config, **changed, formulation=formulation)


def plan_fits(config: Config, surfaces: bool = True) -> list[FitSpec]:
    """Return the fits of a search: small, quick, and different from each other.

    Point clouds (not ``surfaces``) have neither SHOT nor orientation.
    """
    assert config.search is not None
    # In the order of how often each was right.
    sizes = [min(k, config.basis.n_eigenfunctions) for k in (20, 50, 20, 35, 50, 35)]
    names = ("SHOT", "SHOT and waves") if config.descriptors.shot and surfaces else ("waves",)
    orientations = (0.1, 0.1, 1.0, 0.1, 1.0, 1.0) if surfaces else (0.0,) * 3
    specs = [FitSpec(name, k, weight) for k, weight in zip(sizes, orientations, strict=False) for name in names]
    return specs[: config.search.candidates]


def fit_descriptor_set(
    specs: list[FitSpec],
    points: SampledPair,
    config: Config,
    operators: tuple[np.ndarray | None, np.ndarray | None],
    seed: int,
) -> list[Fit]:
    """Return the fits that share a descriptor set.

    Descriptors, features and operators are computed once, for the largest size; a smaller fit takes leading blocks.
    ``operators``: orientation operators ``(w, k, k)`` of the first functions of both shapes, k at least that size.
    """
    bases = points.shapes[0].basis, points.shapes[1].basis
    descriptors = _set_descriptors(specs[0].descriptor_set, points, bases, config)
    size = min(max(spec.functions for spec in specs), *(b.functions.shape[1] for b in bases))
    low = (bases[0].truncate(size), bases[1].truncate(size))
    # A fit of both directions is for the final map; candidates are refined in one direction.
    small = replace(
        config,
        nystrom=replace(config.nystrom, samples=min(200, config.nystrom.samples)),
        full_kernel=False,
        solver=CG(rtol=1e-4, max_iter=200),
        preconditioner="sylvester",
        formulation=replace(config.formulation, bidirectional=False),
    )
    features = kernel_features(*points.shapes, descriptors, small, np.random.default_rng(seed))
    packed = compressed_operators(low, (features.source, features.target), max(config.operator_rtol, 1e-3))
    multiplications = [unpack_operators(p) for p in packed]
    orientations = _feature_orientations(low, features, operators)
    fits = []
    for spec in specs:
        k = min(spec.functions, size)
        blocks = multiplications[0][:, :k, :k], multiplications[1][:, :k, :k]
        turns = None
        if spec.orientation and orientations:
            turns = scale_operators([X[:, :k, :k] for X in orientations], sum(inner(X, X) for X in blocks))
        settings = replace(small, weights=replace(config.weights, orientation=spec.orientation))
        leading = low[0].truncate(k), low[1].truncate(k)
        problem = FitProblem(settings, points.shapes, leading, features.kernel, descriptors, features, blocks, turns)
        fits.append(minimize_problem(problem))
    return fits


def _set_descriptors(name: str, points: SampledPair, bases: tuple[Basis, Basis], config: Config) -> Descriptors:
    """Return the descriptors of a set, weighted by a robust loss where the formulation has one that applies to them."""
    kinds = replace(config.descriptors, n_spectral=30)
    if name == "SHOT":
        kinds = replace(kinds, signature="none", landmark_descriptor="none")
    elif name == "waves":
        kinds = replace(kinds, shot=False)
    landmarks = points.landmarks if kinds.landmark_descriptor != "none" else points.landmarks[:0]
    descriptors = pair_descriptors(*points.shapes, bases, kinds, landmarks, points.descriptors)
    formulation = config.formulation
    has_groups = formulation.loss_group != "landmark" or (descriptors.landmark >= 0).any()
    return robust_weights(descriptors, bases, config)[0] if formulation.weighs_data and has_groups else descriptors


def _feature_orientations(
    bases: tuple[Basis, Basis], features: Features, operators: tuple[np.ndarray | None, np.ndarray | None]
) -> list[np.ndarray]:
    """Return orientation operators ``(c, k, k)`` of the strongest features of both shapes; none of point clouds.

    ``operators (w, k, k)``: those of the first functions, of which a feature's operator is a linear combination.
    """
    source, target = operators
    if source is None or target is None:
        return []
    strongest = principal_features(bases, features, ORIENTATION_FEATURES)
    combined = []
    for basis, F, own in zip(bases, (strongest.source, strongest.target), (source, target), strict=True):
        coefficients = basis.project(F)[: len(own)]
        combined.append(np.tensordot(coefficients.T, own[: len(coefficients)], axes=1))
    return combined
