"""What each formulation makes of a pair, measured cheaply: descriptors, kernel and slices of a pair are made once.

Fits and refinements work on samples; errors are those of some hundred target vertices whose answers are known, each of
which may be sent to any source vertex.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from formulation_shapes import Known, Shapes
from kfmaps._arrays import KfmapsWarning, to_numpy
from kfmaps.config import BasisConfig, Config, DescriptorConfig, Formulation, NystromConfig, Weights
from kfmaps.fmap.bidirectional_zoomout import zoomed_both
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.refine import ZoomOut
from kfmaps.fmap.solvers import CG
from kfmaps.fmap.transfer import carried
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.sampling import stratified_samples
from kfmaps.kernels.kernels import Gaussian, Linear
from kfmaps.matching.assemble import problem
from kfmaps.matching.fit import fit_points
from kfmaps.matching.solve import Minimised, minimiser
from kfmaps.shape import Shape

FUNCTIONS = 50
POINTS = 1500
ZOOM = ZoomOut(30, 100, 10)
CONFIG = replace(
    Config.single_fit(),
    basis=BasisConfig(functions=FUNCTIONS),
    descriptors=DescriptorConfig(eigenfunctions=ZOOM.stop, shot=False),
    nystrom=NystromConfig(samples=200),
    solver=CG(rtol=1e-4, max_steps=500),
    fit_samples=POINTS,
    refinement=ZOOM,
    threads=1,
)
"""The recommended settings, smaller and with fewer samples: a fit takes a tenth of a second."""

KERNELS = {"linear": Linear(), "gaussian": Gaussian()}
COUNTS = (10, 100)

FORMULATIONS: dict[str, tuple[Formulation, Weights]] = {
    "least squares": (Formulation(), Weights()),
    "orthogonal": (Formulation(constraint="orthogonal"), Weights()),
    "both directions": (Formulation(directions="both"), Weights()),
    "robust, per descriptor": (Formulation(loss="huber", loss_per="descriptor"), Weights()),
    "robust, per feature": (Formulation(loss="huber", loss_per="feature"), Weights()),
    "sparse": (Formulation(sparsity=0.001), Weights()),
    "resolvent": (Formulation(mask="resolvent"), Weights()),
    "coupled bases": (Formulation(bases="coupled"), Weights()),
    "spatial": (Formulation(spatial=0.1), Weights()),
    "orientation": (Formulation(), Weights(orientation=0.1)),
}
"""What is compared; every other setting is that of :data:`CONFIG`."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Two prepared shapes, what is known of them, and samples for the refinement of a pair."""

    source: Shape
    target: Shape
    known: Known
    few_s: Basis
    few_t: Basis


def loaded(shapes: Shapes, a: str, b: str) -> Pair:
    """The pair of those names."""
    source, target = (shapes.prepared(name, ZOOM.stop) for name in (a, b))
    few_s, few_t = (stratified_samples(s.basis, n).basis for s, n in ((source, 1500), (target, 500)))
    return Pair(source, target, shapes.known(a, b), few_s, few_t)


def solutions(
    pair: Pair, config: Config, landmarks: np.ndarray, formulations: Mapping[str, tuple[Formulation, Weights]]
) -> dict[str, Minimised]:
    """The minimiser of each formulation; what they have in common is made once."""
    sides = (pair.source, pair.target)
    most = replace(config, weights=Weights(orientation=max(w.orientation for _, w in formulations.values())))
    shared: dict[bool, Any] = {}
    found = {}
    for name, (formulation, weights) in formulations.items():
        asked = replace(config, formulation=formulation, weights=weights)
        own = formulation.weighs_data
        if own or False not in shared:
            # The energy at least squares is shared by all that do not weigh the data before the kernel.
            points = fit_points(*sides, asked if own else config, landmarks)
            task = problem(*points.shapes, points.bases, points.descriptors, most, np.random.default_rng(0), sides)
            shared[own] = task
        task = shared[own]
        kept = task.orientations if weights.orientation else None
        found[name] = minimiser(replace(task, config=asked, orientations=kept), asked)
    return found


@lru_cache(maxsize=4)
def distances(shapes: Shapes, name: str, vertices: tuple[int, ...]) -> np.ndarray:
    """Geodesic distances ``(q, n)`` from some vertices of a shape of unit area."""
    return geodesic_distances(shapes.prepared(name, ZOOM.stop).mesh, np.array(vertices)).astype(np.float32)


def rows_of(basis: Basis, rows: np.ndarray) -> Basis:
    """The basis at some vertices."""
    return Basis(basis.eigenvalues, basis.functions[rows], basis.mass[rows])


def error(C: np.ndarray, source: Shape, target: Shape, asked: np.ndarray, far: np.ndarray) -> float:
    """Mean error of the vertices ``asked`` of the target, given distances ``far (q, n_s)`` from where they belong."""
    points = to_points(C, source.basis, rows_of(target.basis, asked), threads=1)
    return float(far[np.arange(len(points)), points].mean())


def refined(C: np.ndarray, pair: Pair) -> np.ndarray:
    """ZoomOut on samples."""
    return to_numpy(ZOOM(C, pair.few_s, pair.few_t, threads=1).functional_map)


def compared(shapes: Shapes, a: str, b: str, count: int, names: Sequence[str] = ()) -> list[dict[str, Any]]:
    """Errors of every formulation with every kernel on one pair, raw and refined; see :func:`between` for cycles."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        pair = loaded(shapes, a, b)
        known = pair.known
        far = distances(shapes, a, tuple(known.source.tolist()))
        out: list[dict[str, Any]] = []
        for kernel, record in KERNELS.items():
            config = replace(CONFIG, kernel=record, descriptors=replace(CONFIG.descriptors, count=count))
            chosen = {n: f for n, f in FORMULATIONS.items() if not names or n in names}
            for name, found in solutions(pair, config, known.landmarks, chosen).items():
                C = to_numpy(found.solution.value)
                row: dict[str, Any] = {"formulation": name, "kernel": kernel, "descriptors": count}
                row["raw"] = error(C, pair.source, pair.target, known.target, far)
                if found.back is None:
                    last = refined(C, pair)
                else:
                    last = to_numpy(zoomed_both(ZOOM, C, found.back, pair.few_s, pair.few_t)[0].functional_map)
                row["refined"] = error(last, pair.source, pair.target, known.target, far)
                row["steps"] = found.solution.steps
                out.append(row)
        return out


def between(shapes: Shapes, a: str, b: str, count: int) -> list[dict[str, Any]]:
    """Cycle error, coverage and error of both maps of a pair, each fitted by itself and both at once."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        there, back = loaded(shapes, a, b), loaded(shapes, b, a)
        far = distances(shapes, a, tuple(there.known.source.tolist()))
        out: list[dict[str, Any]] = []
        for kernel, record in KERNELS.items():
            config = replace(CONFIG, kernel=record, descriptors=replace(CONFIG.descriptors, count=count))
            alone = {"each by itself": FORMULATIONS["least squares"]}
            C = to_numpy(solutions(there, config, there.known.landmarks, alone)["each by itself"].solution.value)
            D = to_numpy(solutions(back, config, back.known.landmarks, alone)["each by itself"].solution.value)
            both = solutions(there, config, there.known.landmarks, {"both": FORMULATIONS["both directions"]})["both"]
            assert both.back is not None
            E, F = to_numpy(both.solution.value), to_numpy(both.back)
            zoomed = [to_numpy(r.functional_map) for r in zoomed_both(ZOOM, E, F, there.few_s, there.few_t)]
            maps = {
                ("each by itself", "raw"): (C, D),
                ("both at once", "raw"): (E, F),
                ("each by itself", "refined"): (refined(C, there), refined(D, back)),
                ("both at once", "refined"): tuple(zoomed),
            }
            for (name, stage), (forth, reverse) in maps.items():
                row: dict[str, Any] = {"maps": name, "stage": stage, "kernel": kernel, "descriptors": count}
                row |= cycle(forth, reverse, there, far)
                out.append(row)
        return out


def cycle(C: np.ndarray, D: np.ndarray, pair: Pair, far: np.ndarray) -> dict[str, float]:
    """Error of ``C``'s points, how far a source vertex ends from itself, and how much of the source is reached.

    From the known source vertices to the target by ``D`` and back by ``C``.
    """
    known = pair.known
    everywhere = to_points(C, pair.source.basis, pair.target.basis, threads=1)
    over = to_points(D, pair.target.basis, rows_of(pair.source.basis, known.source), threads=1)
    at = np.arange(len(known.source))
    return {
        "error": float(far[at, everywhere[known.target]].mean()),
        "cycle": float(far[at, everywhere[over]].mean()),
        "coverage": float(pair.source.basis.mass[np.unique(everywhere)].sum() / pair.source.basis.mass.sum()),
    }


SHARES = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
LOSSES = ("squared", "huber", "geman")
MARKS = 20


def outliers(shapes: Shapes, a: str, b: str, count: int) -> list[dict[str, Any]]:
    """Errors with some of 20 landmarks wrong, for every loss and kernel; which ones is drawn from the pair's name."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        pair = loaded(shapes, a, b)
        known = pair.known
        far = distances(shapes, a, tuple(known.source.tolist()))
        right = shapes.landmarks(a, b, MARKS)
        order = np.random.default_rng(sum(map(ord, a + b))).permutation(len(right))
        out: list[dict[str, Any]] = []
        for share in SHARES:
            wrong = order[: round(share * len(right))]
            marks = right.copy()
            marks[wrong, 1] = right[np.roll(wrong, 1), 1]  # each takes another wrong one's place
            asked = {loss: (Formulation(loss=loss), Weights()) for loss in LOSSES}
            for kernel, record in KERNELS.items():
                config = replace(CONFIG, kernel=record, descriptors=replace(CONFIG.descriptors, count=count))
                for loss, found in solutions(pair, config, marks, asked).items():
                    C = to_numpy(found.solution.value)
                    value = error(C, pair.source, pair.target, known.target, far)
                    last = error(refined(C, pair), pair.source, pair.target, known.target, far)
                    out.append({"loss": loss, "kernel": kernel, "wrong": share, "raw": value, "refined": last})
        return out


PRODUCTS = (None, 5, 10, 15, 20, 30)


def functions(shapes: Shapes, a: str, b: str, count: int = 100) -> list[dict[str, Any]]:
    """Relative errors of carried coordinates and of the indicator of a part, by C alone and with products."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)
        pair = loaded(shapes, a, b)
        known = pair.known
        config = replace(CONFIG, descriptors=replace(CONFIG.descriptors, count=count))
        alone = {"plain": FORMULATIONS["least squares"]}
        raw = to_numpy(solutions(pair, config, known.landmarks, alone)["plain"].solution.value)
        zoomed = refined(raw, pair)
        positions = pair.source.mesh.vertices - pair.source.mesh.vertices.mean(axis=0)
        centre = known.landmarks[0, 0]
        part = (geodesic_distances(pair.source.mesh, [centre])[0] < 0.3).astype(float)
        out: list[dict[str, Any]] = []
        for size, C in (("raw", raw), ("refined", zoomed), ("refined, first 30", zoomed[:30, :30])):
            for what, f in (("coordinates", positions), ("part", part[:, None])):
                truth = f[known.source]
                for products in PRODUCTS:
                    if products is not None and products > C.shape[1]:
                        continue
                    image = carried(f, C, pair.source.basis, pair.target.basis, products)[known.target]
                    value = float(np.linalg.norm(image - truth) / np.linalg.norm(truth - truth.mean(axis=0)))
                    out.append({"map": size, "function": what, "products": products or 0, "error": value})
        return out
