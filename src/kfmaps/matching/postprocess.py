"""From a functional map to the answer: its point map and the refinement."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from kfmaps._arrays import Array, like, to_numpy
from kfmaps._progress import Progress, StageTimer
from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, descriptor_guidance
from kfmaps.fmap.refine import Refined, Refinement
from kfmaps.shape import Shape


@dataclass(frozen=True, eq=False)
class PostprocessedMap:
    """What :func:`refine_map` returns."""

    target_to_source: np.ndarray  # (n_t,): a source vertex for each target vertex
    functional_map: np.ndarray  # (k_t, k_s): of that map
    # (n_t,): the point map before the refinement, where it was asked for or there is none.
    raw_target_to_source: np.ndarray | None
    seconds: dict[str, float]
    # (n_s,): a target vertex for each source vertex, where a map back was given.
    source_to_target: np.ndarray | None = None
    functional_map_back: np.ndarray | None = None  # (k_s, k_t): its functional map


def refine_map(
    C: Array,
    source: Shape,
    target: Shape,
    config: Config,
    *,
    raw: bool = True,
    led: DescriptorGuidance | None = None,
    back: Array | None = None,
    progress: Progress | None = None,
) -> PostprocessedMap:
    """Return the points of ``C (k_t, k_s)`` on all vertices, refined as ``config.refinement`` says.

    ``raw`` asks for the point map before the refinement too. What guides a refinement that wants guidance is ``led``
    or, without it, SHOT, where both shapes have it. With a map ``back (k_s, k_t)`` both are finished: ZoomOut refines
    them together (:meth:`kfmaps.fmap.zoomout.ZoomOut.bidirectional`), ICP each by itself.
    """
    refine: Any = config.refinement
    clock = StageTimer(progress)
    bases = (source.basis, target.basis)
    if config.device != "cpu":
        bases = (bases[0].to(config.device), bases[1].to(config.device))
    C, points, other = like(C, bases[0].functions), None, None
    back = None if back is None else like(back, C)
    with one_blas_thread():
        if raw or refine is None:
            with clock("point map"):
                points = to_points(C, *bases, threads=config.threads)
        if refine is None:
            assert points is not None
            found = Refined(C, points, ())
            if back is not None:
                other = Refined(back, to_points(back, bases[1], bases[0], threads=config.threads), ())
        else:
            options: dict[str, Any] = {"progress": partial(clock.report, "refinement"), "threads": config.threads}
            weight = getattr(refine, "descriptor_weight", 0)
            guide = {"guide": led or descriptor_guidance(source.shot, target.shot)} if weight else {}
            with clock("refinement"):
                if back is not None and hasattr(refine, "bidirectional"):
                    found, other = refine.bidirectional(C, back, *bases, **options, **guide)
                else:
                    found = refine(C, *bases, points=points, **options, **guide)
                    if back is not None:
                        swapped = {name: one and one.swapped() for name, one in guide.items()}
                        other = refine(back, bases[1], bases[0], threads=config.threads, **swapped)
    ends = (None, None) if other is None else (other.target_to_source, to_numpy(other.functional_map))
    return PostprocessedMap(found.target_to_source, to_numpy(found.functional_map), points, clock.seconds, *ends)


def reseed(refinement: Refinement | None, seed: int) -> Refinement | None:
    """Return the ``refinement`` with ``seed`` added to that of its samples, where it has one."""
    refine: Any = refinement
    return replace(refine, seed=refine.seed + seed) if hasattr(refine, "seed") else refine
