"""Errors of every formulation on one pair; descriptors, kernel and operators of a pair are computed once.

Fits and refinements use samples; errors are those of some hundred target vertices with a known correspondence, each of
which may be sent to any source vertex.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from data_sets import DataSet
from data_sets import Pair as Names
from kfmaps._arrays import KfmapsWarning, to_numpy
from kfmaps.config import BasisConfig, Config, DescriptorConfig, Formulation, NystromConfig, Weights
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.solvers import CG
from kfmaps.fmap.transfer import transfer_functions
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.sampling import stratified_samples
from kfmaps.kernels.kernels import Gaussian, Linear
from kfmaps.matching.assemble import assemble
from kfmaps.matching.fit import fit_points
from kfmaps.matching.solve import Fit, minimize_problem
from kfmaps.shape import Shape
from pair_errors import prepared

Rows = list[dict[str, Any]]
Settings = Mapping[str, tuple[Formulation, Weights]]

ZOOM = ZoomOut(30, 100, 10)
CONFIG = replace(
    Config.single_fit(),
    basis=BasisConfig(n_eigenfunctions=50),
    descriptors=DescriptorConfig(n_eigenfunctions=ZOOM.stop, shot=False),
    nystrom=NystromConfig(samples=200),
    solver=CG(rtol=1e-4, max_iter=500),
    fit_samples=1500,
    refinement=ZOOM,
    threads=1,
)
"""The recommended settings, smaller and with fewer samples: a fit takes a tenth of a second."""

KERNELS = {"linear": Linear(), "gaussian": Gaussian()}
PLAIN = "least squares"

FORMULATIONS: Settings = {
    PLAIN: (Formulation(), Weights()),
    "orthogonal": (Formulation(constraint="orthogonal"), Weights()),
    "both directions": (Formulation(bidirectional=True), Weights()),
    "robust, per descriptor": (Formulation(loss="huber", loss_group="descriptor"), Weights()),
    "robust, per feature": (Formulation(loss="huber", loss_group="feature"), Weights()),
    "sparse": (Formulation(sparsity=0.001), Weights()),
    "resolvent": (Formulation(mask="resolvent"), Weights()),
    "coupled bases": (Formulation(coupled_bases=True), Weights()),
    "spatial": (Formulation(transport_weight=0.1), Weights()),
    "orientation": (Formulation(), Weights(orientation=0.1)),
}
"""What is compared; every other setting is that of :data:`CONFIG`."""

KNOWN_EACH = 12
"""Errors are measured at each so many lines of a truth of 5,000."""

WRONG_SHARES = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
LOSSES = ("squared", "huber", "geman")
N_LANDMARKS = 20
"""Landmarks of the comparison of losses, of which some are wrong."""

PRODUCTS = (None, 5, 10, 15, 20, 30)
"""Numbers of eigenfunctions whose products take part in the transfer; ``None``: no products."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Two prepared shapes, bases at samples for the refinement, landmarks (6, 2) and known correspondences (q,).

    ``distances (q, n_s)`` are geodesic, from the known source vertices to all others.
    """

    source: Shape
    target: Shape
    samples: tuple[Basis, Basis]
    landmarks: np.ndarray
    known_s: np.ndarray
    known_t: np.ndarray
    distances: np.ndarray

    def error(self, C: np.ndarray) -> float:
        """Return the mean error of the known target vertices."""
        points = to_points(C, self.source.basis, _rows(self.target.basis, self.known_t))
        return float(self.distances[np.arange(len(points)), points].mean())

    def refine(self, C: np.ndarray) -> np.ndarray:
        """Return the functional map after ZoomOut on samples."""
        return to_numpy(ZOOM(C, *self.samples).functional_map)

    def refine_both(self, C: np.ndarray, D: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the functional maps of both directions after bidirectional ZoomOut on samples."""
        there, back = ZOOM.bidirectional(C, D, *self.samples)
        return to_numpy(there.functional_map), to_numpy(back.functional_map)


def load_pair(data_set: DataSet, names: Names) -> Pair:
    """Return the pair of these names."""
    source, target = (prepared(data_set, name, ZOOM.stop) for name in names)
    samples = (stratified_samples(source.basis, 1500).basis, stratified_samples(target.basis, 500).basis)
    step = max(1, len(data_set.truth(names)[0]) * KNOWN_EACH // 5000)
    known_s, known_t = (side[::step] for side in data_set.truth(names))
    distances = _distances(data_set, names[0], tuple(known_s.tolist()))
    return Pair(source, target, samples, data_set.farthest_landmarks(names, 6), known_s, known_t, distances)


@lru_cache(maxsize=4)
def _distances(data_set: DataSet, name: str, vertices: tuple[int, ...]) -> np.ndarray:
    return geodesic_distances(prepared(data_set, name, ZOOM.stop).mesh, np.array(vertices)).astype(np.float32)


def _rows(basis: Basis, rows: np.ndarray) -> Basis:
    return Basis(basis.eigenvalues, basis.functions[rows], basis.mass[rows])


def solve_each(pair: Pair, config: Config, landmarks: np.ndarray, formulations: Settings) -> dict[str, Fit]:
    """Return the minimiser of each formulation; what they have in common is computed once."""
    sides = (pair.source, pair.target)
    orientation = max(weights.orientation for _, weights in formulations.values())
    shared: dict[bool, Any] = {}
    results = {}
    for name, (formulation, weights) in formulations.items():
        own_config = replace(config, formulation=formulation, weights=weights)
        own = formulation.weighs_data
        if own or False not in shared:
            # All formulations that do not weigh the data before the kernel share the least-squares energy.
            points = fit_points(*sides, own_config if own else config, landmarks)
            with_orientation = replace(config, weights=Weights(orientation=orientation))
            rng = np.random.default_rng(0)
            shared[own] = assemble(*points.shapes, points.bases, points.descriptors, with_orientation, rng, sides)
        orientations = shared[own].orientations if weights.orientation else None
        results[name] = minimize_problem(replace(shared[own], config=own_config, orientations=orientations))
    return results


def solve_one(pair: Pair, config: Config, name: str) -> Fit:
    """Return the minimiser of one of :data:`FORMULATIONS`."""
    return solve_each(pair, config, pair.landmarks, {name: FORMULATIONS[name]})[name]


def compare_formulations(data_set: DataSet, names: Names, config: Config, formulations: Settings) -> Rows:
    """Return the errors of every formulation with every kernel on one pair, raw and refined."""
    with _quiet():
        pair = load_pair(data_set, names)
        rows: Rows = []
        for kernel, record in KERNELS.items():
            results = solve_each(pair, replace(config, kernel=record), pair.landmarks, formulations)
            for name, result in results.items():
                C = result.functional_map
                refined = pair.refine(C) if result.back is None else pair.refine_both(C, result.back)[0]
                row = {"formulation": name, "kernel": kernel, "descriptors": config.descriptors.n_spectral}
                rows.append(row | {"raw": pair.error(C), "refined": pair.error(refined)})
        return rows


def compare_directions(data_set: DataSet, names: Names, config: Config) -> Rows:
    """Return cycle error, coverage and error of both maps of a pair, each fitted by itself and both at once."""
    with _quiet():
        there, back = load_pair(data_set, names), load_pair(data_set, (names[1], names[0]))
        rows: Rows = []
        for kernel, record in KERNELS.items():
            own = replace(config, kernel=record)
            C, D = (solve_one(pair, own, PLAIN).functional_map for pair in (there, back))
            both = solve_one(there, own, "both directions")
            assert both.back is not None
            E, F = both.functional_map, both.back
            maps = {
                ("each by itself", "raw"): (C, D),
                ("both at once", "raw"): (E, F),
                ("each by itself", "refined"): (there.refine(C), back.refine(D)),
                ("both at once", "refined"): there.refine_both(E, F),
            }
            for (name, stage), (forth, reverse) in maps.items():
                row = {"maps": name, "stage": stage, "kernel": kernel, "descriptors": config.descriptors.n_spectral}
                rows.append(row | cycle(forth, reverse, there))
        return rows


def cycle(C: np.ndarray, D: np.ndarray, pair: Pair) -> dict[str, float]:
    """Return the error of ``C``'s points, their coverage of the source and the cycle error.

    The cycle error is the distance of known source vertices from where ``D`` and then ``C`` send them.
    """
    points = to_points(C, pair.source.basis, pair.target.basis)
    image = to_points(D, pair.target.basis, _rows(pair.source.basis, pair.known_s))
    each, mass = np.arange(len(pair.known_s)), pair.source.basis.mass
    return {
        "error": float(pair.distances[each, points[pair.known_t]].mean()),
        "cycle": float(pair.distances[each, points[image]].mean()),
        "coverage": float(mass[np.unique(points)].sum() / mass.sum()),
    }


def compare_losses(data_set: DataSet, names: Names, config: Config, losses: Sequence[str]) -> Rows:
    """Return errors with some of 20 landmarks wrong, for every loss and kernel; drawn with the pair's names as seed."""
    with _quiet():
        pair = load_pair(data_set, names)
        right = data_set.farthest_landmarks(names, N_LANDMARKS)
        order = np.random.default_rng(sum(map(ord, "".join(names)))).permutation(len(right))
        formulations: Settings = {loss: (Formulation(loss=loss), Weights()) for loss in losses}  # pyright: ignore
        rows: Rows = []
        for share in WRONG_SHARES:
            wrong = order[: round(share * len(right))]
            landmarks = right.copy()
            landmarks[wrong, 1] = right[np.roll(wrong, 1), 1]  # each takes the target of another wrong one
            for kernel, record in KERNELS.items():
                for loss, result in solve_each(pair, replace(config, kernel=record), landmarks, formulations).items():
                    C = result.functional_map
                    row = {"loss": loss, "kernel": kernel, "wrong": share}
                    rows.append(row | {"raw": pair.error(C), "refined": pair.error(pair.refine(C))})
        return rows


def compare_transfer(data_set: DataSet, names: Names, config: Config) -> Rows:
    """Return relative errors of transferred coordinates and of a part's indicator, by C alone and with products."""
    with _quiet():
        pair = load_pair(data_set, names)
        raw = solve_one(pair, config, PLAIN).functional_map
        refined = pair.refine(raw)
        mesh = pair.source.mesh
        part = geodesic_distances(mesh, [pair.landmarks[0, 0]])[0] < 0.3
        functions = {"coordinates": mesh.vertices - mesh.vertices.mean(axis=0), "part": part[:, None].astype(float)}
        rows: Rows = []
        for size, C in (("raw", raw), ("refined", refined), ("refined, first 30", refined[:30, :30])):
            for name, f in functions.items():
                truth = f[pair.known_s]
                for products in PRODUCTS:
                    if products is not None and products > C.shape[1]:
                        continue
                    image = transfer_functions(f, C, pair.source.basis, pair.target.basis, products)[pair.known_t]
                    error = float(np.linalg.norm(image - truth) / np.linalg.norm(truth - truth.mean(axis=0)))
                    rows.append({"map": size, "function": name, "products": products or 0, "error": error})
        return rows


def _quiet() -> warnings.catch_warnings:
    return warnings.catch_warnings(action="ignore", category=KfmapsWarning)
