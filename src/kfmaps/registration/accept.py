"""From a refined map to points inside triangles: the non-rigid fit where its own evidence speaks for it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from kfmaps._progress import StageTimer
from kfmaps.config import Config
from kfmaps.fmap.confidence import build_local_distortion
from kfmaps.fmap.precise import PointMap, nearest_vertices
from kfmaps.geometry.mesh import vertex_areas
from kfmaps.registration.torn_patches import rejoin_torn_patches
from kfmaps.shape import Shape

_MAX_GAP = 0.02
"""Distance that may be left between the bent source and the target, in √area: right maps of one kind of body leave
0.0006 to 0.003, right ones of a cat and a dog up to 0.0065, wrong ones up to 0.02 and a whole body on a part of one
more."""
_MIN_CHANGE = 0.2  # change of the confidence of a vertex that counts: such vertices are harmed, or healed, by a fit
_MAX_WORSENED_AREA = 0.006
"""Share of the target's area that a right fit harms at most, fingertips mostly; above, what it harmed is held back."""


@dataclass(frozen=True)
class RegistrationReport:
    """What a non-rigid fit tells about a map, without the truth; made by :func:`register_map`."""

    # Root of the mean squared distance of the bent source and the target, in both directions, in units of √area.
    gap: float
    deformation_energy: float  # as-rigid-as-possible energy per area: 0 for a motion
    before: float  # confidence, averaged over the target's vertices, of the map that the fit began with
    after: float | None = None  # the same of the map that it ends with; ``None`` where the gap alone refused it
    worsened: float = 0.0  # shares of the target's area in which the confidence falls and rises by more than 0.2
    improved: float = 0.0
    pinned: bool = False  # whether the map was held fast where a first fit had worsened it
    accepted: bool = False  # whether the match has taken the fit's points
    reason: str | None = "gap"  # what spoke against it
    landmarks_held: bool = True  # whether landmarks had a say; not where most are less exact than the map

    @property
    def loss(self) -> float | None:
        """Confidence lost by the fit; negative where it gains, as right ones do."""
        return None if self.after is None else self.before - self.after


@dataclass(frozen=True, eq=False)
class RegisteredMap:
    """A map after the non-rigid fit; made by :func:`register_map`."""

    # (n_t,): the source vertex nearest to each point; those that were given where no fit was made or kept.
    target_to_source: np.ndarray
    precise_map: PointMap | None  # ``None`` where no fit was made or kept
    # (n_s, 3): the source's vertices on the target, at unit area, where the fit was kept.
    registered_vertices: np.ndarray | None
    local_confidence: np.ndarray  # (n_t,): :func:`kfmaps.fmap.confidence.local_confidence` of the map
    fit: RegistrationReport | None = None  # what the fit tells of the map, kept or not; ``None`` where none was made


def register_map(
    points: np.ndarray,
    source: Shape,
    target: Shape,
    config: Config,
    clock: StageTimer,
    landmarks: np.ndarray | None = None,
) -> RegisteredMap:
    """Register the source onto the target as a map says, and keep what the fit's own evidence speaks for.

    A fit that leaves a gap of more than 2 % of √area is refused: so are parts. One that worsens more than 0.6 % of the
    target's area (distances to the surroundings are kept clearly worse than before) is made once more with the map held
    fast there; one that lets sizes change, as between shapes of other proportions, only where it would not be kept. Of
    the two the last is kept for which the evidence speaks: that worsens little, or improves at least half as much as it
    worsens. Where small patches of the map are torn off even so, the fit begins anew with these sent to where their
    surroundings go, and is kept if it is trusted more.

    ``points (n_t,)``: the map; ``config``: its ``registration``, which is left out where that or the refinement is
    ``None``; ``landmarks (l, 2)``: pairs "source vertex, target vertex", which hold softly, or not at all where
    five or more are less exact than the map.
    """
    with clock("confidence"):
        confidence = build_local_distortion(source.mesh, target.mesh)
        trust = confidence(points)
    surfaces = bool(len(source.mesh.faces) and len(target.mesh.faces))
    finish = config.registration
    if finish is None or config.refinement is None or not surfaces:
        return RegisteredMap(points, None, None, trust)
    hold = bool(getattr(finish, "local_scaling", 0)) or not _less_exact(landmarks, points, source.mesh.vertices)
    landmarks = landmarks if hold else None
    areas = vertex_areas(target.mesh)
    areas = areas / areas.sum()

    def tried(held: np.ndarray | None, points: np.ndarray = points) -> tuple[RegisteredMap, RegistrationReport]:
        stage = "non-rigid fit" if held is None else "non-rigid fit, held"
        with clock(stage):
            report = partial(clock.report, stage)
            found = finish(source.mesh, target.mesh, points, report, landmarks=landmarks, held=held)
        before, pinned = float(trust.mean()), held is not None
        told = RegistrationReport(found.gap, found.bending, before, pinned=pinned, landmarks_held=hold)
        if found.gap > _MAX_GAP:
            return RegisteredMap(points, None, None, trust, told), told
        place = PointMap(found.faces, found.weights)
        vertices = nearest_vertices(place, source.mesh)
        with clock("confidence after the fit"):
            after = confidence(vertices)
        harmed, healed = (float(areas[change > _MIN_CHANGE].sum()) for change in (trust - after, after - trust))
        kept = harmed <= _MAX_WORSENED_AREA or healed >= 0.5 * harmed
        told = replace(told, after=float(after.mean()), worsened=harmed, improved=healed)
        told = replace(told, accepted=kept, reason=None if kept else "harm")
        return RegisteredMap(vertices, place, found.vertices, after, told), told

    first, told = best, kept = tried(None)
    # Where sizes may change distances do, rightly: what a fit that is kept has changed there is no reason to hold it.
    if told.worsened > _MAX_WORSENED_AREA and not (getattr(finish, "local_scaling", 0) and told.accepted):
        held = np.clip(2 * (trust - first.local_confidence) / _MIN_CHANGE - 1, 0.0, 1.0)
        second, again = tried(held)
        if again.accepted or not told.accepted:
            best, kept = second, again
    best = best if kept.accepted else RegisteredMap(points, None, None, trust, kept)
    rejoined = rejoin_torn_patches(best.target_to_source, source.mesh, target.mesh)
    if np.array_equal(rejoined, best.target_to_source):
        return best
    mended, again = tried(None, rejoined)
    return mended if again.accepted and mended.local_confidence @ areas > best.local_confidence @ areas else best


def _less_exact(landmarks: np.ndarray | None, points: np.ndarray, vertices: np.ndarray) -> bool:
    """Whether landmarks (l, 2) are less exact than the map ``points (n_t,)`` of shapes that are nearly isometric.

    At least five can tell: the median of their distances from the map, in √area, is 0.01 to 0.03 where they are right.
    """
    if landmarks is None or len(landmarks) < 5:
        return False
    errors = np.linalg.norm(vertices[points[landmarks[:, 1]]] - vertices[landmarks[:, 0]], axis=1)
    return bool(np.median(errors) > 0.04)
