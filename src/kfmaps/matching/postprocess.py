"""From a functional map to the answer: its point map and the refinement."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from kfmaps._arrays import like, to_numpy
from kfmaps._progress import Progress, StageTimer
from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance, descriptor_guidance
from kfmaps.geometry.basis import Basis
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
    C: Any,
    source: Shape,
    target: Shape,
    config: Config,
    *,
    raw: bool = True,
    led: DescriptorGuidance | None = None,
    back: Any = None,
    rng: int = 0,
    progress: Progress | None = None,
) -> PostprocessedMap:
    """The points of ``C (k_t, k_s)`` on all vertices, refined as ``config.refinement`` says.

    ``raw`` asks for the point map before the refinement too. What guides a refinement that wants guidance is ``led``
    or, without it, SHOT, where both shapes have it. ``rng`` is added to the seed of ZoomOut's samples. With a
    map ``back (k_s, k_t)`` both are finished: ZoomOut refines them together
    (:meth:`kfmaps.fmap.zoomout.ZoomOut.bidirectional`), ICP
    each by itself.
    """
    refine: Any = config.refinement
    if hasattr(refine, "seed"):
        refine = replace(refine, seed=refine.seed + rng)
        config = replace(config, refinement=refine)
    clock = StageTimer(progress)
    bases = (source.basis, target.basis)
    if config.device != "cpu":
        bases = (bases[0].to(config.device), bases[1].to(config.device))
    C, points = like(C, bases[0].functions), None
    with one_blas_thread():
        if raw or config.refinement is None:
            with clock("point map"):
                points = to_points(C, *bases, threads=config.threads)
        if config.refinement is None:
            assert points is not None
            found = PostprocessedMap(points, to_numpy(C), points, clock.seconds)
            if back is None:
                return found
            back = like(back, bases[0].functions)
            return replace(
                found,
                source_to_target=to_points(back, bases[1], bases[0], threads=config.threads),
                functional_map_back=to_numpy(back),
            )
        if back is not None:
            return _finished_both(C, like(back, C), (source, target), bases, config, points, clock, led)
        if getattr(refine, "descriptor_weight", 0):
            refine = partial(refine, guide=led or descriptor_guidance(source.shot, target.shot))
        with clock("refinement"):
            refined = refine(
                C, *bases, progress=lambda done: clock.report("refinement", done), threads=config.threads, points=points
            )
    return PostprocessedMap(refined.target_to_source, to_numpy(refined.functional_map), points, clock.seconds)


def _finished_both(
    C: Any,
    back: Any,
    shapes: tuple[Shape, Shape],
    bases: tuple[Basis, Basis],
    config: Config,
    points: np.ndarray | None,
    clock: StageTimer,
    led: DescriptorGuidance | None,
) -> PostprocessedMap:
    """Both maps refined; see :func:`refine_map`."""
    refine: Any = config.refinement

    def told(done: float) -> None:
        clock.report("refinement", done)

    with clock("refinement"):
        if hasattr(refine, "bidirectional"):
            guiding = led or descriptor_guidance(shapes[0].shot, shapes[1].shot) if refine.descriptor_weight else None
            forth, other = refine.bidirectional(C, back, *bases, told, config.threads, guiding)
        else:
            forth = refine(C, *bases, progress=told, threads=config.threads, points=points)
            other = refine(back, bases[1], bases[0], threads=config.threads)
    return PostprocessedMap(
        forth.target_to_source,
        to_numpy(forth.functional_map),
        points,
        clock.seconds,
        other.target_to_source,
        to_numpy(other.functional_map),
    )
