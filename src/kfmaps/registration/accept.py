"""From a refined map to points inside triangles: the non-rigid fit where its own evidence speaks for it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from kfmaps._stage_timer import Clock
from kfmaps.config import Config
from kfmaps.fmap.confidence import surroundings
from kfmaps.fmap.precise import PointMap, vertices_of
from kfmaps.geometry.mesh import vertex_areas
from kfmaps.registration.nonrigid_icp import Registered
from kfmaps.shape import Shape

GAP = 0.02
"""Distance that may be left between the bent source and the target, in √area: right maps of one kind of body leave
0.0006 to 0.003, right ones of a cat and a dog up to 0.0065, wrong ones up to 0.02 and a whole body on a part of one
more."""
DROP = 0.2
"""Change of the confidence of a vertex that counts: such vertices are harmed, or healed, by a fit."""
HARMED = 0.006
"""Share of the target's area that a right fit harms at most, fingertips mostly; above, what it harmed is held back."""
HEALED = 0.5
"""Area healed over area harmed from which a fit is kept all the same: it mends more than it hides."""


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
    harmed, healed : float
        Shares of the target's area in which the confidence falls and rises by more than :data:`DROP`.
    held : bool
        Whether the map was held fast where a first fit had harmed it.
    kept : bool
        Whether the match has taken the fit's points.
    why : "gap", "harm" or None
        What spoke against it.
    """

    gap: float
    bending: float
    before: float
    after: float | None = None
    harmed: float = 0.0
    healed: float = 0.0
    held: bool = False
    kept: bool = False
    why: str | None = "gap"

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
        :func:`kfmaps.fmap.confidence.local_confidence` of the map.
    fit : Bend or None
        What the non-rigid fit tells of the map, kept or not; ``None`` where none was made.
    """

    target_to_source: np.ndarray
    place: PointMap | None
    bent: np.ndarray | None
    trust: np.ndarray
    fit: Bend | None = None


@dataclass(frozen=True, eq=False)
class _Tried:
    """A fit and what it tells."""

    found: Registered
    vertices: np.ndarray
    trust: np.ndarray
    told: Bend


def placed(
    points: np.ndarray,
    source: Shape,
    target: Shape,
    config: Config,
    clock: Clock,
    landmarks: np.ndarray | None = None,
) -> Placed:
    """The map ``points (n_t,)`` made finer than vertices as ``config.finish`` says; ``landmarks (l, 2)`` hold softly.

    A fit that does not bring the source to the target up to :data:`GAP` is left: so are parts. One that harms more of
    the target than :data:`HARMED` (distances to the surroundings are kept clearly worse than before) is made once more
    with the map held fast there; one that lets sizes change, as between shapes of other proportions, only where it
    would not be kept. Of the two the last is kept for which the evidence speaks: that harms little, or heals at least
    half as much as it harms.
    """
    with clock("confidence"):
        confidence = surroundings(source.mesh, target.mesh)
        trust = confidence(points)
    surfaces = bool(len(source.mesh.faces) and len(target.mesh.faces))
    finish = config.finish
    if finish is None or config.refinement is None or not surfaces:
        return Placed(points, None, None, trust)
    areas = vertex_areas(target.mesh)
    areas = areas / areas.sum()

    def tried(held: np.ndarray | None) -> _Tried:
        stage = "non-rigid fit" if held is None else "non-rigid fit, held"
        with clock(stage):
            found = finish(
                source.mesh, target.mesh, points, lambda done: clock.report(stage, done), landmarks=landmarks, held=held
            )
        told = Bend(found.gap, found.bending, float(trust.mean()), held=held is not None)
        if found.gap > GAP:
            return _Tried(found, points, trust, told)
        vertices = vertices_of(PointMap(found.faces, found.weights), source.mesh)
        with clock("confidence after the fit"):
            after = confidence(vertices)
        harmed, healed = (float(areas[change > DROP].sum()) for change in (trust - after, after - trust))
        kept = harmed <= HARMED or healed >= HEALED * harmed
        told = replace(told, after=float(after.mean()), harmed=harmed, healed=healed)
        return _Tried(found, vertices, after, replace(told, kept=kept, why=None if kept else "harm"))

    first = best = tried(None)
    # Where sizes may change distances do, rightly: what a fit that is kept has changed there is no reason to hold it.
    if first.told.after is not None and first.told.harmed > HARMED and not (finish.stretch and first.told.kept):
        held = np.clip(2 * (trust - first.trust) / DROP - 1, 0.0, 1.0)
        second = tried(held)
        best = second if second.told.kept or not first.told.kept else first
    if not best.told.kept:
        return Placed(points, None, None, trust, best.told)
    place = PointMap(best.found.faces, best.found.weights)
    return Placed(best.vertices, place, best.found.vertices, best.trust, best.told)
