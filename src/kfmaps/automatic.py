"""Matching without landmarks: several candidate maps, judged without knowing the truth.

A wave kernel signature cannot tell left from right, and one fit of a symmetric body easily returns a flipped or
half-flipped map. So several small fits are made, each is refined cheaply on samples, all are judged by
:func:`kfmaps.quality.map_quality`, and the best is finished on all points. The candidates differ in descriptors,
basis size and weight of orientation; *rivals*, refined from starts that ignore the descriptors, show whether some
altogether different map would do as well, in which case the answer is "ambiguous".
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from scipy.linalg import expm

from kfmaps._arrays import like, refuse, to_numpy
from kfmaps._threads import one_blas_thread, parallel
from kfmaps.config import Config
from kfmaps.maps import to_points
from kfmaps.mesh import Mesh
from kfmaps.pipeline import Match, fit
from kfmaps.quality import Probe, Quality, map_quality, probe
from kfmaps.refine import ZoomOut
from kfmaps.shape import Progress, Shape
from kfmaps.shot import mirrored
from kfmaps.solvers import CG

COARSE = ZoomOut(start=20, stop=80, step=5)
"""The refinement of candidates, on the samples of both shapes."""
STARTS = (6, 10, 20)
"""Where it starts. From few functions it repairs maps that are wrong in part, also of shapes that are far from
isometric; from many it keeps what is right. Which is better shows afterwards, so each is tried."""
KICKS = 6
"""Rivals that start from a random symmetry of the low functions."""
AGAIN = 2
"""Distinct candidates that are refined once more, from few functions: what is right by then repairs the rest."""
DISTINCT = 0.08
"""Mean distance, in units of √area, from which two maps count as different ones."""
CLEAR = 0.3
"""Margin of the score from which a map counts as sure."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """One refined map on the samples.

    Attributes
    ----------
    name : str
        Where it came from.
    functional_map : (k, k) float64
    points : (q_t,) int64
        A source sample for each target sample.
    quality : Quality
    fitted : Match or None
        The fit that it was refined from; ``None`` for a rival.
    """

    name: str
    functional_map: np.ndarray
    points: np.ndarray
    quality: Quality
    fitted: Match | None


def choose(
    source: Shape,
    target: Shape,
    config: Config,
    *,
    landmarks: Any = None,
    descriptors: tuple[Any, Any] | None = None,
    rng: int | np.random.Generator | None = 0,
    progress: Progress | None = None,
) -> Match:
    """Match two prepared shapes without landmarks, as ``config.search`` says.

    Returns the match of the best candidate, with ``confidence``, ``verdict`` ("sure" or "ambiguous"), the distinct
    other maps as ``runners_up`` and the ``scores`` of all of them. ``landmarks`` are passed on to the fits.

    Raises
    ------
    InvalidInput
        When ``config.search`` is ``None``, or reversed orientation is asked of a point cloud.
    """
    if config.search is None:
        raise refuse("search", "settings of a search", "None", "use Config.automatic(), or give landmarks")
    seed = int(np.random.default_rng(rng).integers(2**31))
    if config.search.orientation == "reversed":
        target = mirror_image(target)
    report = progress or (lambda _stage, _done: None)
    start = time.perf_counter()
    report("candidates", 0.0)
    probes = parallel(lambda shape: probe(shape, rng=seed, threads=1), (source, target), config.threads)
    found = _candidates(source, target, config, (probes[0], probes[1]), seed, landmarks, descriptors, report)
    ranked = distinct(found, probes[0])
    report("candidates", 1.0)
    searched = time.perf_counter()
    best = ranked[0]
    fitted = best.fitted or next(c.fitted for c in sorted(found, key=_score, reverse=True) if c.fitted is not None)
    bases = (source.basis, target.basis)
    result = replace(fitted, config=config, seconds={"candidates": searched - start, **fitted.seconds})
    C = best.functional_map
    if config.refinement is None:
        points = to_points(C, *bases, threads=config.threads)
        result = replace(result, target_to_source=points, functional_map=C)
    else:
        if config.device != "cpu":
            bases = (source.basis.to(config.device), target.basis.to(config.device))
        with one_blas_thread():
            refined = config.refinement(
                like(C, bases[0].functions),
                *bases,
                progress=lambda done: report("refinement", done),
                threads=config.threads,
            )
        C = to_numpy(refined.functional_map)
        result = replace(result, target_to_source=refined.target_to_source, functional_map=C)
    result.seconds["refinement"] = time.perf_counter() - searched
    others = ranked[1 : 1 + config.search.runners_up]
    margin = max(best.quality.score - ranked[1].quality.score, 0.0) if len(ranked) > 1 else np.inf
    k_t, k_s = result.functional_map.shape
    return replace(
        result,
        eigenvalues_s=source.basis.eigenvalues[:k_s],
        eigenvalues_t=target.basis.eigenvalues[:k_t],
        confidence=float(-np.expm1(-margin / CLEAR)),
        verdict="sure" if margin >= CLEAR else "ambiguous",
        runners_up=tuple(to_points(c.functional_map, source.basis, target.basis, config.threads) for c in others),
        scores=tuple(float(c.quality.score) for c in (best, *others)),
    )


def variants(config: Config, surfaces: bool = True) -> list[tuple[str, Config]]:
    """Names and configurations of the candidate fits: small, quick, and different from each other.

    Descriptors (SHOT alone or with the wave kernel signature), basis size, and weight of orientation; in the order
    of how often each was right on the shapes that they were chosen on. Point clouds (not ``surfaces``) have neither
    SHOT nor orientation.
    """
    assert config.search is not None
    base = replace(
        config,
        search=None,
        refinement=None,
        nystrom=replace(config.nystrom, samples=min(200, config.nystrom.samples)),
        compression=max(config.compression, 1e-3),
        solver=CG(rtol=1e-5, max_steps=300),
        device="cpu",
        threads=1,
    )
    both = replace(config.descriptors, count=30)
    alone = replace(both, signature="none", landmark_map="none")
    families = {"SHOT": alone, "SHOT and waves": both}
    if not (both.shot and surfaces):
        families = {"waves": replace(both, shot=False)}
    sizes = [min(k, config.basis.functions) for k in (20, 35, 50)]
    found = [
        (
            f"{name}, {k} functions, orientation {weight:g}",
            replace(
                base,
                basis=replace(config.basis, functions=k),
                descriptors=chosen,
                weights=replace(config.weights, orientation=weight),
            ),
        )
        for k, weight in zip(
            (sizes[0], sizes[2], sizes[0], sizes[1], sizes[2], sizes[1]),
            (0.1, 0.1, 1.0, 0.1, 1.0, 1.0) if surfaces else (0.0,) * 3,
            strict=False,
        )
        for name, chosen in families.items()
    ]
    return found[: config.search.candidates]


def _candidates(
    source: Shape,
    target: Shape,
    config: Config,
    probes: tuple[Probe, Probe],
    seed: int,
    landmarks: Any,
    descriptors: tuple[Any, Any] | None,
    report: Progress,
) -> list[Candidate]:
    jobs: list[Callable[[], list[Candidate]]] = []
    done: list[int] = []

    def refined(name: str, C: np.ndarray, fitted: Match | None, starts: tuple[int, ...]) -> list[Candidate]:
        found = []
        for start in starts:
            stop = min(COARSE.stop, len(source.basis.eigenvalues), len(target.basis.eigenvalues))
            zoom = replace(COARSE, start=min(start, stop), stop=stop)
            better = zoom(C, probes[0].samples.basis, probes[1].samples.basis, threads=1)
            quality = map_quality(better.functional_map, *probes)
            label = f"{name}, from {start}"
            found.append(Candidate(label, better.functional_map, better.target_to_source, quality, fitted))
        done.append(1)
        report("candidates", len(done) / (len(jobs) + AGAIN + KICKS + 1))
        return found

    def fitting(name: str, other: Shape, settings: Config) -> Callable[[], list[Candidate]]:
        def run() -> list[Candidate]:
            found = fit(source, other, settings, landmarks=landmarks, descriptors=descriptors, rng=seed)
            return refined(name, found.raw_functional_map, found if other is target else None, STARTS)

        return run

    surfaces = bool(len(source.mesh.faces) and len(target.mesh.faces))
    settings = variants(config, surfaces)
    jobs += [fitting(name, target, chosen) for name, chosen in settings]
    if surfaces and target.shot is not None:  # the map that would be right if the target were its mirror image
        flipped = mirror_image(target)
        jobs += [fitting(f"mirrored: {name}", flipped, chosen) for name, chosen in settings[:2]]
    found = [c for several in parallel(lambda run: run(), jobs, config.threads) for c in several]
    best = distinct([c for c in found if c.fitted is not None], probes[0])[:AGAIN]

    def again(candidate: Candidate) -> list[Candidate]:
        return refined(f"{candidate.name}, again", candidate.functional_map, candidate.fitted, STARTS[:2])

    def kick(i: int) -> list[Candidate]:
        C = kicked(best[0].functional_map, source.basis.eigenvalues, np.random.default_rng(seed + i))
        return refined(f"kicked {i}", C, None, STARTS[:1])

    second = [partial(again, c) for c in best] + [partial(kick, i) for i in range(KICKS)]
    return found + [c for several in parallel(lambda run: run(), second, config.threads) for c in several]


def kicked(C: np.ndarray, eigenvalues: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """``C`` after a random rotation of the source's low functions that mixes mostly those of like frequency.

    Of a shape with a continuous symmetry, whose eigenvalues come in pairs, that is about a random symmetry; of any
    other it is a bad start, from which the refinement returns to the same map or strays to a worse one.
    """
    k = min(20, *C.shape)
    values = np.sqrt(eigenvalues[:k])
    alike = np.exp(-(((values[:, None] - values[None, :]) / (0.02 * values[-1])) ** 2))
    generator = rng.normal(size=(k, k)) * alike * np.pi
    rotation = expm((generator - generator.T) / 2)
    # A simple eigenvalue leaves no rotation, only the choice of sign, which a kick may flip too.
    signs = np.where(rng.random(k) < 0.25, -1.0, 1.0)
    signs[0] = 1.0
    return C[:k, :k] @ (rotation * signs[None, :])


def distinct(found: list[Candidate], source: Probe) -> list[Candidate]:
    """The best of ``found``, then the best of those that differ from it, and so on.

    A rival, which no descriptors speak for, comes first only when it is clearly better than every fitted candidate.
    """
    ranked: list[Candidate] = []
    order = sorted(found, key=_score, reverse=True)
    best = next((c for c in order if c.fitted is not None), None)
    if best is not None and _score(best) > _score(order[0]) - CLEAR:
        order.insert(0, best)
    for candidate in order:
        places = source.positions[candidate.points]
        apart = [np.linalg.norm(places - source.positions[c.points], axis=1).mean() for c in ranked]
        if not apart or min(apart) > DISTINCT:
            ranked.append(candidate)
    return ranked


def mirror_image(shape: Shape) -> Shape:
    """The mirror image of a prepared shape, with the same vertices, functions and areas.

    Raises
    ------
    InvalidInput
        For a point cloud, which has no orientation.
    """
    if len(shape.mesh.faces) == 0:
        raise refuse(shape.name, "a surface, which can be mirrored", "a point cloud", "leave orientation at 'kept'")
    mesh = Mesh(shape.mesh.vertices * np.array([-1.0, 1.0, 1.0]), shape.mesh.faces[:, ::-1])
    return replace(shape, mesh=mesh, shot=None if shape.shot is None else mirrored(shape.shot))


def _score(candidate: Candidate) -> float:
    return candidate.quality.score
