"""Matching without landmarks: several candidate maps, judged without knowing the truth.

A wave kernel signature cannot tell left from right, and one fit of a symmetric body easily returns a flipped or half-
flipped map. So many candidates are refined cheaply on samples (:mod:`kfmaps.search.candidates`), all are judged by
:func:`kfmaps.search.quality.map_quality`, and the best is finished on all points. *Rivals*, refined without a look at
the descriptors, show whether some altogether different map would do as well, in which case the answer is "ambiguous".
"""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from kfmaps._arrays import like, refuse, to_numpy
from kfmaps._threads import one_blas_thread, parallel
from kfmaps.config import Config
from kfmaps.descriptors.shot import mirrored
from kfmaps.fit.fit import Match
from kfmaps.fit.shape import Progress, Shape
from kfmaps.functional.guide import guide
from kfmaps.functional.points import to_points
from kfmaps.functional.refine import ZoomOut
from kfmaps.search.candidates import Candidate, apart, candidates
from kfmaps.search.quality import Probe, probe
from kfmaps.surface.mesh import Mesh

DISTINCT = 0.08
"""Mean distance, in units of √area, from which two maps count as different ones."""
CLEAR = 0.3
"""Margin of the score from which a map counts as sure."""
POOR = -10.0
"""Score below which no map is called sure, however much worse the others are. Where the search was made, right maps
had -7 and better, the best maps of a part of a body, or of a person to a cat, -13 and worse."""


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

    Returns the match of the best candidate, with ``confidence``, ``verdict`` ("sure", "ambiguous" or "poor"), the
    distinct other maps as ``runners_up`` and the ``scores`` of all of them. ``landmarks`` are passed on to the fits.

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
    found, fits = candidates(
        source,
        target,
        config,
        (probes[0], probes[1]),
        seed,
        landmarks=landmarks,
        descriptors=descriptors,
        report=lambda done: report("candidates", done),
    )
    ranked = distinct(found, probes[0])
    report("candidates", 1.0)
    searched = time.perf_counter()
    best = ranked[0]
    fitted = best.fitted or fits[0]
    bases = (source.basis, target.basis)
    result = replace(fitted, config=config, seconds={"candidates": searched - start})
    C = best.functional_map
    if config.refinement is None:
        points = to_points(C, *bases, threads=config.threads)
        result = replace(result, target_to_source=points, functional_map=C)
    else:
        if config.device != "cpu":
            bases = (source.basis.to(config.device), target.basis.to(config.device))
        refine = config.refinement
        if isinstance(refine, ZoomOut) and refine.guidance:
            refine = partial(refine, guide=guide(source.shot, target.shot))
        with one_blas_thread():
            refined = refine(
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
        confidence=float(-np.expm1(-margin / CLEAR) * np.exp(min(best.score - POOR, 0.0))),
        verdict="ambiguous" if margin < CLEAR else "poor" if best.score < POOR else "sure",
        runners_up=tuple(to_points(c.functional_map, source.basis, target.basis, config.threads) for c in others),
        scores=tuple(float(c.quality.score) for c in (best, *others)),
    )


def distinct(found: list[Candidate], source: Probe) -> list[Candidate]:
    """The best of ``found``, then the best of those that differ from it, and so on.

    A rival, which no descriptors speak for, comes first only when it is clearly better than every other candidate.
    """
    order = sorted(found, key=lambda c: c.score, reverse=True)
    best = next((c for c in order if c.guided), None)
    if best is not None and best.score > order[0].score - CLEAR:
        order.insert(0, best)
    return apart(order, source, DISTINCT)


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
