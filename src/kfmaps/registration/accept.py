"""Registration of a refined map, and the decision whether to accept it, without the truth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from kfmaps._progress import StageTimer
from kfmaps.config import Config
from kfmaps.fmap.confidence import LocalDistortion, build_local_distortion
from kfmaps.fmap.precise import PointMap, nearest_vertices
from kfmaps.geometry.mesh import Mesh, vertex_areas
from kfmaps.registration.nonrigid_icp import Registration
from kfmaps.registration.torn_patches import rejoin_torn_patches
from kfmaps.shape import Shape

_MAX_GAP = 0.02
"""Largest distance between the registered source and the target, in √area. Right maps of one kind of body leave 0.0006
to 0.003, those of a cat and a dog up to 0.0065, wrong ones up to 0.02, a whole body on a part more."""
_MIN_CHANGE = 0.2  # change of local confidence from which a vertex counts as worsened or improved
_MAX_WORSENED_AREA = 0.006
"""Share of the target's area that a right registration worsens at most, mostly fingertips. Above it the map is pinned
there."""


@dataclass(frozen=True)
class RegistrationReport:
    """Measures of a registration, without the truth; made by :func:`register_map`."""

    gap: float  # root mean square distance of the registered source and the target, in both directions, in √area
    deformation_energy: float  # as-rigid-as-possible energy per area: 0 for a rigid motion
    before: float  # mean local confidence of the initial map
    after: float | None = None  # mean local confidence of the registered map; ``None`` where the gap is too large
    worsened: float = 0.0  # shares of the target's area where local confidence falls or rises by more than 0.2
    improved: float = 0.0
    pinned: bool = False  # whether the initial map was pinned where a first registration had worsened it
    accepted: bool = False  # whether the match uses the registered map
    reason: str | None = "gap"  # why it does not
    landmarks_held: bool = True  # whether landmarks took part; not where most are less exact than the map

    @property
    def loss(self) -> float | None:
        """The loss of mean local confidence; negative for a gain, as right registrations have."""
        return None if self.after is None else self.before - self.after


@dataclass(frozen=True, eq=False)
class RegisteredMap:
    """A map after its registration, or the initial one where it is not accepted; made by :func:`register_map`."""

    target_to_source: np.ndarray  # (n_t,): vertices nearest to the points of the precise map
    precise_map: PointMap | None  # ``None`` without an accepted registration
    registered_vertices: np.ndarray | None  # (n_s, 3): of the source, on the target, at unit area
    local_confidence: np.ndarray  # (n_t,): :func:`kfmaps.fmap.confidence.local_confidence` of the map
    fit: RegistrationReport | None = None  # of the registration, accepted or not; ``None`` where none was made


def register_map(
    points: np.ndarray,
    source: Shape,
    target: Shape,
    config: Config,
    clock: StageTimer,
    landmarks: np.ndarray | None = None,
) -> RegisteredMap:
    """Register the source onto the target, beginning with a map, and return the registered map if it is accepted.

    A registration with a gap above 2 % of √area is not accepted. If one worsens the local confidence of more than 0.6 %
    of the target's area, a second one pins the map there. (With local scaling, which rightly changes distances, only if
    the first is not accepted.) A registration is accepted if it worsens less than that, or improves at least half as
    much area as it worsens; the second is preferred. If small patches of the map are still torn off, a last
    registration begins with these rejoined, and is taken if its local confidence is higher.

    ``points (n_t,)``: the map; ``config``: its ``registration``, which is skipped where that or the refinement is
    ``None``; ``landmarks (l, 2)``: pairs "source vertex, target vertex", which pull softly, or not at all where five or
    more are less exact than the map.
    """
    with clock("confidence"):
        distortion = build_local_distortion(source.mesh, target.mesh)
        confidence = distortion(points)
    have_faces = bool(len(source.mesh.faces) and len(target.mesh.faces))
    registration = config.registration
    if registration is None or config.refinement is None or not have_faces:
        return RegisteredMap(points, None, None, confidence)
    scales = bool(getattr(registration, "local_scaling", 0))
    held = scales or not _are_less_exact(landmarks, points, source.mesh.vertices)
    landmarks = landmarks if held else None
    task = _RegistrationTask(source.mesh, target.mesh, registration, clock, landmarks, held, distortion, confidence)
    best, report = first, first_report = task.register(points)
    if first_report.worsened > _MAX_WORSENED_AREA and not (scales and first_report.accepted):
        pinned = np.clip(2 * (confidence - first.local_confidence) / _MIN_CHANGE - 1, 0.0, 1.0)
        second, second_report = task.register(points, pinned)
        if second_report.accepted or not first_report.accepted:
            best, report = second, second_report
    best = best if report.accepted else RegisteredMap(points, None, None, confidence, report)
    rejoined = rejoin_torn_patches(best.target_to_source, source.mesh, target.mesh)
    if np.array_equal(rejoined, best.target_to_source):
        return best
    last, report = task.register(rejoined)
    is_better = last.local_confidence @ task.areas > best.local_confidence @ task.areas
    return last if report.accepted and is_better else best


@dataclass(frozen=True, eq=False)
class _RegistrationTask:
    """A registration that may be made from several maps, and what it is judged by."""

    source: Mesh
    target: Mesh
    registration: Callable[..., Registration]
    clock: StageTimer
    landmarks: np.ndarray | None  # (l, 2): those that pull
    landmarks_held: bool
    distortion: LocalDistortion
    confidence: np.ndarray  # (n_t,): local confidence of the initial map

    @cached_property
    def areas(self) -> np.ndarray:
        """Shares of the target's area, (n_t,)."""
        areas = vertex_areas(self.target)
        return areas / areas.sum()

    def register(
        self, points: np.ndarray, pinned: np.ndarray | None = None
    ) -> tuple[RegisteredMap, RegistrationReport]:
        """Return the registration that begins with a map ``points (n_t,)``, and whether it is accepted.

        ``pinned (n_t,)``: how strongly each target vertex is pinned to its image.
        """
        stage, confidence = "non-rigid fit" if pinned is None else "non-rigid fit, pinned", self.confidence
        with self.clock(stage):
            progress = partial(self.clock.report, stage)
            options = {"landmarks": self.landmarks, "pinned": pinned}
            result = self.registration(self.source, self.target, points, progress, **options)
        report = RegistrationReport(
            result.gap,
            result.bending,
            before=float(confidence.mean()),
            pinned=pinned is not None,
            landmarks_held=self.landmarks_held,
        )
        if result.gap > _MAX_GAP:
            return RegisteredMap(points, None, None, confidence, report), report
        precise_map = PointMap(result.faces, result.weights)
        vertices = nearest_vertices(precise_map, self.source)
        with self.clock("confidence after the fit"):
            after = self.distortion(vertices)
        worsened = float(self.areas[confidence - after > _MIN_CHANGE].sum())
        improved = float(self.areas[after - confidence > _MIN_CHANGE].sum())
        accepted = worsened <= _MAX_WORSENED_AREA or improved >= 0.5 * worsened
        report = replace(report, after=float(after.mean()), worsened=worsened, improved=improved)
        report = replace(report, accepted=accepted, reason=None if accepted else "harm")
        return RegisteredMap(vertices, precise_map, result.vertices, after, report), report


def _are_less_exact(landmarks: np.ndarray | None, points: np.ndarray, vertices: np.ndarray) -> bool:
    """Return whether five or more landmarks (l, 2) are less exact than a map ``points (n_t,)`` of similar shapes.

    The median distance of right landmarks from the map is 0.01 to 0.03 √area.
    """
    if landmarks is None or len(landmarks) < 5:
        return False
    errors = np.linalg.norm(vertices[points[landmarks[:, 1]]] - vertices[landmarks[:, 0]], axis=1)
    return bool(np.median(errors) > 0.04)
