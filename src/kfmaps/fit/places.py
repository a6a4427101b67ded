"""From a refined map to points inside triangles: the non-rigid fit where its own evidence speaks for it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps.config import Config
from kfmaps.fit.shape import Shape
from kfmaps.fit.stages import Clock
from kfmaps.functional.confidence import local_confidence
from kfmaps.functional.precise import PointMap, vertices_of

GAP = 0.01
"""Distance that may be left between the bent source and the target, in √area: right maps leave 0.0006 to 0.003, a
cat on a dog 0.018, a whole body on a part of one 0.02 and more."""
LOSS = 0.02
"""Confidence, averaged over the target, that a fit may lose and still count as no worse: right ones gain."""


@dataclass(frozen=True, eq=False)
class Placed:
    """Points inside triangles; made by :func:`placed`.

    Attributes
    ----------
    target_to_source : (n_t,) int64
        The source vertex that is nearest to each point; those that were given where no fit was made or kept.
    place : PointMap or None
        ``None`` where no fit was made or kept.
    bent : (n_s, 3) float64 or None
        The source's vertices on the target, at unit area, where the non-rigid fit was kept.
    trust : (n_t,) float64
        :func:`kfmaps.functional.confidence.local_confidence` of the map.
    """

    target_to_source: np.ndarray
    place: PointMap | None
    bent: np.ndarray | None
    trust: np.ndarray


def placed(
    points: np.ndarray,
    source: Shape,
    target: Shape,
    config: Config,
    clock: Clock,
) -> Placed:
    """The map ``points (n_t,)`` made finer than vertices as ``config.finish`` says.

    A fit is kept when the bent source reaches the target up to :data:`GAP` and distances to the surroundings are kept
    about as well as before, which they are not on parts and between bodies of altogether different shape.
    """
    with clock("confidence"):
        trust = local_confidence(source.mesh, target.mesh, points)
    surfaces = bool(len(source.mesh.faces) and len(target.mesh.faces))
    if config.finish is None or config.refinement is None or not surfaces:
        return Placed(points, None, None, trust)
    with clock("non-rigid fit"):
        found = config.finish(
            source.mesh, target.mesh, points, progress=lambda done: clock.report("non-rigid fit", done)
        )
    place = PointMap(found.faces, found.weights)
    if found.gap <= GAP:
        vertices = vertices_of(place, source.mesh)
        with clock("confidence after the fit"):
            better = local_confidence(source.mesh, target.mesh, vertices)
        if better.mean() >= trust.mean() - LOSS:
            return Placed(vertices, place, found.vertices, better)
    return Placed(points, None, None, trust)
