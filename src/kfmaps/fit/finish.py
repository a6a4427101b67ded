"""From a functional map to the answer: its point map and the refinement."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from kfmaps._arrays import like, to_numpy
from kfmaps._progress import Progress
from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.fit.shape import Shape
from kfmaps.fit.stages import Clock
from kfmaps.functional.guide import Guide, guide
from kfmaps.functional.points import to_points
from kfmaps.functional.refine import ZoomOut


@dataclass(frozen=True, eq=False)
class Finished:
    """What :func:`finished` returns.

    Attributes
    ----------
    target_to_source : (n_t,) int64
        A source vertex for each target vertex.
    functional_map : (k_t, k_s) float64
        Of that map.
    raw_target_to_source : (n_t,) int64 or None
        The point map before the refinement, where it was asked for or there is none.
    seconds : dict of str to float
    """

    target_to_source: np.ndarray
    functional_map: np.ndarray
    raw_target_to_source: np.ndarray | None
    seconds: dict[str, float]


def finished(
    C: Any,
    source: Shape,
    target: Shape,
    config: Config,
    *,
    raw: bool = True,
    led: Guide | None = None,
    progress: Progress | None = None,
) -> Finished:
    """The points of ``C (k_t, k_s)`` on all vertices, refined as ``config.refinement`` says.

    ``raw`` asks for the point map before the refinement too. What guides a refinement that wants guidance is ``led``
    or, without it, SHOT, where both shapes have it.
    """
    clock = Clock(progress)
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
            return Finished(points, to_numpy(C), points, clock.seconds)
        refine = config.refinement
        if isinstance(refine, ZoomOut) and refine.guidance:
            refine = partial(refine, guide=led or guide(source.shot, target.shot))
        with clock("refinement"):
            refined = refine(
                C,
                *bases,
                progress=lambda done: clock.report("refinement", done),
                threads=config.threads,
                points=points,
            )
    return Finished(refined.target_to_source, to_numpy(refined.functional_map), points, clock.seconds)
