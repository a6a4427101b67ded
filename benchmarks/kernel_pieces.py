"""Places where a kernel could take part in a match with a search, for benchmarks/ablation.py (research/kernel.md).

None of them is in the package: each is a list of patches that put it there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import kfmaps
from kfmaps.descriptors.shot import mirror_shot
from kfmaps.descriptors.spectral import heat_signature, wave_signature
from kfmaps.fmap import descriptor_guidance as guidance
from kfmaps.fmap import zoomout
from kfmaps.fmap.energy import Energy
from kfmaps.fmap.solvers import CG, solve
from kfmaps.fmap.terms import adjoint_term
from kfmaps.kernels.kernels import Gaussian, resolve_kernel
from kfmaps.kernels.nystrom import nystrom
from kfmaps.matching import (
    finish,
    initial_maps,
    landmark_evidence,
    ranking,
    sample_pair,
)
from kfmaps.matching.features import sample_pair_for_fit

Patch = tuple[Any, str, Any]
"""A module, one of its names, and what stands there instead."""
Sides = list[np.ndarray]
SAMPLES = 500
"""Samples of each shape that the Nyström features of a guidance are made from."""
SPECTRAL = 0.3
"""Squared differences of heat and of wave kernel signatures, each, where those of SHOT are 1."""
SPECTRAL_DIMENSIONS = 16
"""Principal components of the kernel of heat and of waves where each set has a kernel of its own."""
FIRST, LAST = 25, 100
"""Functions at which the energy has its full weight, and above which it has none."""
SOLVER = CG(rtol=1e-4, max_iter=15)
"""Of a step with the energy."""
KEY = 6  # entries of SHOT that tell a vertex from the others

_signatures: dict[bytes, np.ndarray] = {}


def remember(*shapes: kfmaps.Shape) -> None:
    """Keep heat and wave kernel signatures of shapes: a guidance is made of the rows of SHOT, which find them."""
    _signatures.clear()
    for shape in shapes:
        basis, values = shape.basis, np.asarray(shape.basis.eigenvalues)
        heat = np.log(np.maximum(heat_signature(basis, np.geomspace(0.005, 0.3, 8)), 1e-12))
        energies = np.linspace(np.log(20), np.log(values[99]), 20)
        waves = wave_signature(basis, energies, 5 * (energies[1] - energies[0]))
        assert shape.shot is not None
        for rows in (shape.shot, mirror_shot(shape.shot)):
            _signatures.update(zip(_keys(rows), np.hstack([heat, waves]), strict=True))


def _keys(shot: np.ndarray) -> list[bytes]:
    return [row.tobytes() for row in np.ascontiguousarray(shot[:, :KEY])]


def _of_unit_variance(sides: Sides) -> Sides:
    """Descriptors of both shapes, divided so that two random rows differ by 1 (mean of the squared length)."""
    mean = np.vstack(sides).mean(axis=0)
    unit = np.sqrt(2 * sum(((side - mean) ** 2).sum() for side in sides) / sum(map(len, sides)))
    return [side / unit for side in sides]


def _components(sides: Sides, sharpness: float, dimensions: int) -> guidance.DescriptorGuidance | None:
    """Principal components of Nyström features of a Gaussian of descriptors of both shapes."""
    rng = np.random.default_rng(0)
    some = [side[rng.choice(len(side), min(SAMPLES, len(side)), replace=False)] for side in sides]
    samples = np.vstack(some)
    kernel = nystrom(resolve_kernel(Gaussian(), samples, sharpness), samples, 1e-6)
    return guidance.descriptor_guidance(kernel.features(sides[0]), kernel.features(sides[1]), dimensions)


def kernel_guidance(sharpness: float, dimensions: int, kind: str = "SHOT") -> Callable[..., Any]:
    """A stand-in for ``descriptor_guidance``: principal components of Nyström features of a Gaussian.

    ``kind``: "SHOT" alone; "product", one kernel of SHOT, heat and waves together; "sum", one of each.
    """

    def made(source: Any, target: Any) -> guidance.DescriptorGuidance | None:
        if guidance.descriptor_guidance(source, target) is None:
            return None
        sides = [np.asarray(side, dtype=np.float64) for side in (source, target)]
        if kind != "SHOT":
            signatures = [np.array([_signatures[key] for key in _keys(side)]) for side in (source, target)]
            heat, waves = (_of_unit_variance([s[:, part] for s in signatures]) for part in (slice(8), slice(8, None)))
            sets, root = (_of_unit_variance(sides), heat, waves), np.sqrt(SPECTRAL)
            if kind == "sum":
                counts = dimensions, SPECTRAL_DIMENSIONS, SPECTRAL_DIMENSIONS
                each = [_components(one, sharpness, count) for one, count in zip(sets, counts, strict=True)]
                joined = guidance.combine_guidance(list(zip((1.0, SPECTRAL, SPECTRAL), each, strict=True)))
                assert joined is not None
                unit = np.sqrt(1 + 2 * SPECTRAL)
                return guidance.DescriptorGuidance(joined.source / unit, joined.target / unit)
            sides = [np.hstack([a, root * b, root * c]) for a, b, c in zip(*sets, strict=True)]
        return _components(sides, sharpness, dimensions)

    return made


def guided(made: Callable[..., Any]) -> list[Patch]:
    """The patches that put a guidance into the search and into the refinement after it."""
    users = (sample_pair, landmark_evidence, ranking, finish)
    return [(module, "descriptor_guidance", made) for module in users]


def energy_in_zoomout(weight: float) -> list[Patch]:
    """Patches of the last ZoomOut: each map minimises its squared distance to the projected point map plus the energy.

    The kernel's descriptor and commutativity terms, each divided by its mean diagonal, count ``weight`` at
    :data:`FIRST` functions and less as these become more.
    """
    energies: dict[int, Any] = {}
    refine, project = finish.refine_map, zoomout.fit_functional_map

    def refine_map(C: np.ndarray, source: Any, target: Any, config: Any, **more: Any) -> Any:
        start, stop, step = (getattr(config.refinement, name) for name in ("start", "stop", "step"))
        energies.update(_energies(source, target, [k for k in range(min(start, len(C)), stop, step) if k <= LAST]))
        try:
            return refine(C, source, target, config, **more)
        finally:
            energies.clear()

    def fit(points: np.ndarray, source: Any, target: Any, k: int, ridge: float = 0.1) -> np.ndarray:
        C = np.asarray(project(points, source, target, k, ridge), dtype=np.float64)
        if k not in energies:
            return C
        terms = {name: energies[k].terms[name] for name in ("descriptors", "commutativity")}
        weights = {name: weight * FIRST / k / len(terms) / float(np.mean(t.diagonal())) for name, t in terms.items()}
        both = Energy({"map": adjoint_term(C.T), **terms}, {"map": 1.0, **weights})
        return np.asarray(solve(both.apply, both.rhs(), SOLVER, C).value)

    return [(finish, "refine_map", refine_map), (zoomout, "fit_functional_map", fit)]


def _energies(source: Any, target: Any, sizes: list[int]) -> dict[int, Any]:
    """The energy of a Gaussian of SHOT and waves, for each number of functions."""
    config = replace(kfmaps.Config(), threads=1)
    points = sample_pair_for_fit(source, target, 2000, np.zeros((0, 2), dtype=np.int64), None, 0)
    problems: list[Any] = []
    replaced = initial_maps.minimize_problem
    initial_maps.minimize_problem = problems.append  # type: ignore[assignment]
    try:
        wanted = [initial_maps.FitSpec("SHOT and waves", k, 0.0) for k in sizes]
        initial_maps.fit_descriptor_set(wanted, points, config, (None, None), 0)
    finally:
        initial_maps.minimize_problem = replaced
    return {k: problem.energy for k, problem in zip(sizes, problems, strict=True)}
