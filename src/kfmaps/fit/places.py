"""From a refined map to points inside triangles: the non-rigid fit where its own evidence speaks for it."""

from __future__ import annotations

from dataclasses import dataclass, replace

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


@dataclass(frozen=True)
class Bend:
    """What a non-rigid fit tells about a map, without the truth; made by :func:`placed`.

    Attributes
    ----------
    gap : float
        Root of the mean squared distance of the bent source and the target, in both directions, in units of √area.
    bending : float
        As-rigid-as-possible energy per area: 0 for a motion.
    before : float
        Confidence, averaged over the target's vertices, of the map that the fit began with, ...
    after : float or None
        ... and of the map that it ends with; ``None`` where the gap alone refused it.
    kept : bool
        Whether the match has taken the fit's points.
    why : "gap", "loss" or None
        What spoke against it.
    """

    gap: float
    bending: float
    before: float
    after: float | None
    kept: bool
    why: str | None

    @property
    def loss(self) -> float | None:
        """Confidence lost by the fit; negative where it gains, as right ones do."""
        return None if self.after is None else self.before - self.after


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
    fit : Bend or None
        What the non-rigid fit tells of the map, kept or not; ``None`` where none was made.
    """

    target_to_source: np.ndarray
    place: PointMap | None
    bent: np.ndarray | None
    trust: np.ndarray
    fit: Bend | None = None


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
    told = Bend(found.gap, found.bending, float(trust.mean()), None, False, "gap")
    if found.gap > GAP:
        return Placed(points, None, None, trust, told)
    place = PointMap(found.faces, found.weights)
    vertices = vertices_of(place, source.mesh)
    with clock("confidence after the fit"):
        better = local_confidence(source.mesh, target.mesh, vertices)
    kept = bool(better.mean() >= trust.mean() - LOSS)
    told = replace(told, after=float(better.mean()), kept=kept, why=None if kept else "loss")
    return Placed(vertices, place, found.vertices, better, told) if kept else Placed(points, None, None, trust, told)
