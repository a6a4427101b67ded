"""Initial maps of a search: sign choices, extremity matches, small kernel fits, near-symmetries and perturbations.

Diagonal functional maps with every choice of signs of the low functions contain all symmetries of near-isometric bodies
(MapTree, Ren et al. 2020). Kernel fits of samples start where the functions of two shapes differ by more than signs.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from scipy.linalg import expm

from kfmaps._arrays import inner, refuse
from kfmaps._threads import parallel
from kfmaps.config import Config, DescriptorConfig
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
from kfmaps.matching.extremity_matching import ExtremityMatch, extremity_cost, match_extremities
from kfmaps.matching.features import Descriptors, SampledPair, kernel_features, pair_descriptors
from kfmaps.matching.fit import robust_weights
from kfmaps.matching.sample_pair import SamplePair, TwoLevelSamples
from kfmaps.matching.score import Candidate
from kfmaps.matching.self_maps import self_maps
from kfmaps.matching.solve import Fit, minimize_problem

KernelWeights = tuple[float, ...]
"""Of SHOT, of landmarks and of extremities."""
LITTLE: KernelWeights = (4.0, 12.0)
MUCH: KernelWeights = (12.0, 12.0)
WEIGHTS: tuple[KernelWeights, ...] = ((0.0, 0.0), MUCH, LITTLE)
"""In the rough refinement of sign choices; with none symmetric maps are found too."""
FIT_WEIGHTS: tuple[KernelWeights, ...] = (LITTLE, MUCH)
EXTREMITY_FUNCTIONS = 12
"""Functions of the map that an extremity match starts from."""
STARTS = (6, 10, 20)
"""Functions that the rough refinement of a fit starts from. From few it repairs maps that are wrong in part, also of
shapes that are far from isometric; from many it keeps what is right."""

FIT_POINTS = 2000
"""Samples of each shape that a fit is made from."""


@dataclass(frozen=True, eq=False)
class Start:
    """A map before it is refined and scored: where it came from, and what takes part."""

    name: str
    functional_map: np.ndarray  # (k, k)
    uses_descriptors: bool = True
    weights: KernelWeights = ()
    functions: int = 0  # of the first step of the rough refinement
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


def distinct_weights(weights: Iterable[KernelWeights], pair: SamplePair) -> list[KernelWeights]:
    """Return the ``weights`` that differ where SHOT or landmarks may be unknown."""
    known = (pair.descriptor_cost is not None, pair.landmark_cost is not None, True)
    return list(dict.fromkeys(tuple(w if k else 0.0 for w, k in zip(each, known, strict=False)) for each in weights))


def sign_inits(count: int, pair: SamplePair, weights: Iterable[KernelWeights]) -> list[Start]:
    """Return diagonal maps with all signs of ``count`` functions after the constant one, with all ``weights``."""
    if count == 0:
        return []
    signs = [np.array([1.0, *some]) for some in product((1, -1), repeat=count)]

    def name(some: np.ndarray, weight: float) -> str:
        return "signs " + "".join("+" if s > 0 else "-" for s in some[1:]) + f", weight {weight:g}"

    return [
        Start(name(some, w[0]), np.diag(some), bool(w[0]) or pair.descriptor_cost is None, w, count + 1)
        for w in distinct_weights(weights, pair)
        for some in signs
    ]


def repeated_starts(maps: Iterable[tuple[str, np.ndarray, Fit | None]], pair: SamplePair) -> list[Start]:
    """Return starts of ``maps``, each with its name and fit, from several sizes and with several weights."""
    return [
        Start(f"{name}, from {start}, weight {w[0]:g}", C, True, w, start, fit=fit)
        for name, C, fit in maps
        for start in STARTS
        for w in distinct_weights(FIT_WEIGHTS, pair)
    ]


def extremity_inits(functions: int, pair: SamplePair) -> list[Start]:
    """Return maps that follow from matches of extremities (:mod:`kfmaps.matching.extremity_matching`)."""
    size = min(EXTREMITY_FUNCTIONS, functions)
    found = match_extremities(pair.source, pair.target, pair.descriptor_cost)
    maps = [(match, paired_map(match, pair, size)) for match in found]
    return [
        Start(f"{match}", C, True, w, len(C), match)
        for w in distinct_weights([(4.0, 12.0, 30.0)], pair)
        for match, C in maps
    ]


def paired_map(match: ExtremityMatch, pair: SamplePair, k: int) -> np.ndarray:
    """Return the functional map (k, k) of the points that are alike by a match of extremities."""
    points = extremity_cost(pair.source.extremities, pair.target.extremities, match, pair.descriptor_cost).argmin(
        axis=1
    )
    return np.asarray(pair.solver(k) @ pair.source.samples.basis.functions[points, :k], float)


def symmetry_inits(best: list[Candidate], pair: SamplePair, functions: int) -> list[Start]:
    """Return the ``best`` candidates composed with near-symmetries of both shapes.

    Whatever else a search has missed, the best map is compared with these, so that it is not called sure merely for
    want of a rival.
    """
    own, theirs = (self_maps(side, functions) for side in (pair.source, pair.target))
    composed = []
    for i, candidate in enumerate(best):
        C = candidate.functional_map
        for S, after in [*((S, False) for S in own), *((S, True) for S in theirs)]:
            k = min(len(C), len(S))
            composed.append((f"turned {i}", S[:k, :k] @ C[:k, :k] if after else C[:k, :k] @ S[:k, :k], None))
    return repeated_starts(composed, pair)


def perturb(C: np.ndarray, eigenvalues: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return ``C`` after a random rotation of the source's low functions that mixes mostly those of like frequency.

    Of a shape with a continuous symmetry, whose eigenvalues come in pairs, that is about a random symmetry; of any
    other it is a bad start, from which the refinement returns to the same map or strays to a worse one.
    """
    k = min(20, *C.shape)
    values = np.sqrt(np.maximum(eigenvalues[:k], 0.0))
    # Constants of many components have eigenvalues of rounding size: all are alike. Below 0.03, the root of an
    # eigenvalue at unit area, there is no wave: a sphere's first is 5.
    width = 0.02 * max(float(values[-1]), 0.03)
    alike = np.exp(-(((values[:, None] - values[None, :]) / width) ** 2))
    generator = rng.normal(size=(k, k)) * alike * np.pi
    rotation = expm((generator - generator.T) / 2)
    # A simple eigenvalue leaves no rotation, only the choice of sign, which may flip too.
    signs = np.where(rng.random(k) < 0.25, -1.0, 1.0)
    signs[0] = 1.0
    return C[:k, :k] @ (rotation * signs[None, :])


def kernel_inits(points: SampledPair, config: Config, samples: TwoLevelSamples, seed: int) -> list[Start]:
    """Return small kernel fits, each to be refined from several sizes and with several weights of the descriptors."""
    operators = samples.whole.source.orientation, samples.whole.target.orientation
    fits = plan_fits(config, surfaces=all(one is not None for one in operators))

    def starts(name: str) -> list[Start]:
        members = [fit for fit in fits if fit.descriptor_set == name]
        made = fit_descriptor_set(members, points, config, operators, seed)
        named = [(spec.name, fit.functional_map, fit) for spec, fit in zip(members, made, strict=True)]
        return repeated_starts(named, samples.few)

    names = list(dict.fromkeys(fit.descriptor_set for fit in fits))
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
    asked = replace(config.formulation, mask=usual.formulation.mask, mask_power=usual.formulation.mask_power)
    return replace(
        config, kernel=usual.kernel, bandwidth_scale=usual.bandwidth_scale, weights=usual.weights, formulation=asked
    )


def plan_fits(config: Config, surfaces: bool = True) -> list[FitSpec]:
    """Return the fits of a search: small, quick, and different from each other.

    Point clouds (not ``surfaces``) have neither SHOT nor orientation.
    """
    assert config.search is not None
    # In the order of how often each was right.
    sizes = [min(k, config.basis.n_eigenfunctions) for k in (20, 50, 20, 35, 50, 35)]
    names = ("SHOT", "SHOT and waves") if config.descriptors.shot and surfaces else ("waves",)
    weights = (0.1, 0.1, 1.0, 0.1, 1.0, 1.0) if surfaces else (0.0,) * 3  # their weights of orientation
    found = [FitSpec(name, k, weight) for k, weight in zip(sizes, weights, strict=False) for name in names]
    return found[: config.search.candidates]


def fit_descriptor_set(
    fits: list[FitSpec],
    points: SampledPair,
    config: Config,
    operators: tuple[np.ndarray | None, np.ndarray | None],
    seed: int,
) -> list[Fit]:
    """Return the ``fits`` that share a descriptor set.

    Descriptors, features and operators are computed once, for the largest size; a smaller fit takes leading blocks.
    ``operators``: orientation operators ``(w, k, k)`` of the first functions of both shapes, k at least that size.
    """
    bases = points.shapes[0].basis, points.shapes[1].basis
    asked = _descriptor_config(fits[0].descriptor_set, config.descriptors)
    marks = points.landmarks if asked.landmark_descriptor != "none" else points.landmarks[:0]
    used = _weighed(pair_descriptors(*points.shapes, bases, asked, marks, points.descriptors), bases, config)
    size = min(max(f.functions for f in fits), *(b.functions.shape[1] for b in bases))
    low = (bases[0].truncate(size), bases[1].truncate(size))
    # Both directions at once are for the answer; a candidate is refined one way.
    small = replace(
        config,
        nystrom=replace(config.nystrom, samples=min(200, config.nystrom.samples)),
        full_kernel=False,
        solver=CG(rtol=1e-4, max_iter=200),
        preconditioner="sylvester",
        formulation=replace(config.formulation, bidirectional=False),
    )
    features = kernel_features(*points.shapes, used, small, np.random.default_rng(seed))
    packed = compressed_operators(low, (features.source, features.target), max(config.operator_rtol, 1e-3))
    operators_of_features = [unpack_operators(p) for p in packed]
    turning: list[np.ndarray] = []
    known = [cube for cube in operators if cube is not None]
    if len(known) == 2:
        strongest = principal_features(low, features, ORIENTATION_FEATURES)
        for basis, F, cube in zip(low, (strongest.source, strongest.target), known, strict=True):
            coefficients = basis.project(F)[: len(cube)]
            turning.append(np.tensordot(coefficients.T, cube[: len(coefficients)], axes=1))
    made = []
    for fit in fits:
        k = min(fit.functions, size)
        blocks = (operators_of_features[0][:, :k, :k], operators_of_features[1][:, :k, :k])
        orientations = None
        if fit.orientation and turning:
            orientations = scale_operators([X[:, :k, :k] for X in turning], sum(inner(X, X) for X in blocks))
        settings = replace(small, weights=replace(config.weights, orientation=fit.orientation))
        bases_k = (low[0].truncate(k), low[1].truncate(k))
        problem = FitProblem(settings, points.shapes, bases_k, features.kernel, used, features, blocks, orientations)
        made.append(minimize_problem(problem))
    return made


def _descriptor_config(name: str, base: DescriptorConfig) -> DescriptorConfig:
    """Return the descriptors of a set."""
    both = replace(base, n_spectral=30)
    if name == "SHOT":
        return replace(both, signature="none", landmark_descriptor="none")
    return both if name == "SHOT and waves" else replace(both, shot=False)


def _weighed(used: Descriptors, bases: tuple[Basis, Basis], config: Config) -> Descriptors:
    """Return ``used``, weighed by a robust loss where the formulation has one and there is what it is taken over."""
    asked = config.formulation
    if not asked.weighs_data or (asked.loss_group == "landmark" and not (used.landmark >= 0).any()):
        return used
    return robust_weights(used, bases, config)[0]
