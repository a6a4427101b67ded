"""Orthographic views, chosen by the shape or given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from kfmaps._arrays import check, refuse
from kfmaps._records import short_repr
from kfmaps.fmap.evaluate import area_distortion
from kfmaps.geometry.mesh import Mesh
from kfmaps.geometry.similarity import similarity

_OBLIQUE_GAIN = 1.15  # ratio of silhouettes from which a view along no axis of the file is preferred
_Z_UP_GAIN = 1.4  # ratio of stances on z and on y from which z is up
_YAW, _PITCH = 20.0, 10.0  # degrees by which the automatic view is turned aside and lifted, so that depth shows
_SAME_VIEW = 45.0  # degrees that a target may be rotated against the source and still be seen from the same side

_MIN_CORRELATION = 0.4
"""Correlation of rotated source and target from which a map is trusted; right maps of bodies have at least 0.47."""
_MAX_MISFIT_RATIO = 0.75
"""Largest ratio of the misfits of a rotated shape and of the shapes as they lie, where no map is trusted. Of 182 pairs
of scanned people in 14 poses who all face one way, 3 % have a smaller ratio when one is rotated by half a turn."""
_MAX_DISTORTION = 0.45
"""Typical change of area under a map, as a power of two, above which the shapes are of different kinds. Poses of one
body have up to 0.42, a cat and a dog 0.49, a gorilla and a woman 0.54, a man and a cat 0.64."""
_UPSIDE_DOWN = 0.7  # cosine of the angle to "down" from which a map shows that one of two shapes is upside down
_N_SAMPLES = 800  # points of each shape at which misfits are measured


@dataclass(frozen=True, eq=False)
class View:
    """An orthographic camera.

    Attributes
    ----------
    towards : (3,) float64
        Unit vector from the surface to the camera.
    up : (3,) float64
        Unit vector that points up in the picture, perpendicular to ``towards``.
    """

    towards: np.ndarray
    up: np.ndarray

    __repr__ = short_repr

    def axes(self) -> np.ndarray:
        """Return the rows right, up, towards (3, 3): ``points @ axes.T`` is picture coordinates and closeness."""
        return np.stack([np.cross(self.up, self.towards), self.up, self.towards])


def view_from(towards: ArrayLike, up: ArrayLike = (0, 1, 0)) -> View:
    """Return the view from the direction ``towards`` (3,) with ``up`` (3,) upwards. Their lengths do not matter.

    Raises
    ------
    InvalidInput
        When one is zero or not finite, or both lie on one line.
    """
    a = check(np.asarray(towards, dtype=np.float64), "towards", shape=(3,), remedy="give x, y, z")
    b = check(np.asarray(up, dtype=np.float64), "up", shape=(3,), remedy="give x, y, z")
    across = np.cross(b, a)
    if not np.linalg.norm(across) > 1e-6 * np.linalg.norm(a) * np.linalg.norm(b):
        raise refuse("view", "two directions apart from each other", f"{a} and {b}", "turn one of them")
    b = np.cross(a, across)
    return View(a / np.linalg.norm(a), b / np.linalg.norm(b))


def _stance(points: np.ndarray, up: np.ndarray) -> float:
    """Return how well a shape stands: its lowest points lie far apart, and its middle is high above them."""
    height = points @ up
    rise = height - height.min()
    low = points[rise <= 0.05 * rise.max()]
    spread = np.linalg.norm(np.ptp(low, axis=0)) / np.linalg.norm(np.ptp(points, axis=0))
    return float(spread * rise.mean() / max(rise.max(), 1e-300))


def _silhouette(points: np.ndarray, towards: np.ndarray) -> int:
    """Return the area that centred ``points`` cover when seen from ``towards``, in small squares."""
    across = np.linalg.svd(towards[None])[2][1:]
    # Not smaller than the distance between neighbouring points.
    square = np.sqrt((points**2).sum(axis=1).mean()) * max(1 / 15, 5 / np.sqrt(len(points)))
    cells = np.floor(points @ across.T / max(square, 1e-300)).astype(np.int64)
    return len(np.unique(cells, axis=0))


def broad_side(mesh: Mesh) -> View:
    """Return the view straight onto the broad side of a shape.

    The camera looks along the file's axis z, x or y with the largest silhouette, or along the direction of least
    variance where that silhouette is much larger, as for a shape that lies askew. Up is the file's y, or its z where
    the camera looks along y or where the shape stands better on z.
    """
    points = mesh.vertices - mesh.vertices.mean(axis=0)
    x, y, z = np.eye(3)
    sizes = np.array([_silhouette(points, axis) for axis in (z, x, y)])
    # The first of nearly equal ones, so that two poses of a shape are seen alike.
    towards = (z, x, y)[int(np.argmax(sizes >= 0.95 * sizes.max()))]
    thinnest = np.linalg.eigh(points.T @ points)[1][:, 0]
    if _silhouette(points, thinnest) > _OBLIQUE_GAIN * sizes.max():
        towards = thinnest * np.sign(thinnest[np.abs(thinnest).argmax()])
    if abs(towards[1]) > 0.8:
        up = z
    elif abs(towards[2]) > 0.8:
        up = y
    else:
        up = z if _stance(points, z) > _Z_UP_GAIN * _stance(points, y) else y
    return view_from(towards, up)


def automatic_view(mesh: Mesh) -> View:
    """Return the view onto the :func:`broad_side` of a shape, turned a little aside and from above."""
    frame = broad_side(mesh).axes()
    yaw, pitch = np.deg2rad([_YAW, _PITCH])
    direction = np.cos(yaw) * frame[2] + np.sin(yaw) * frame[0]
    return view_from(np.cos(pitch) * direction + np.sin(pitch) * frame[1], frame[1])


def following_view(source_view: View, source: Mesh, target: Mesh, target_to_source: np.ndarray | None = None) -> View:
    """Return the view that shows the target from the side of the body from which ``source_view`` shows the source.

    ``target_to_source (n_t,)`` is the map, where one is known. The view is the same unless the shapes are rotated
    against each other (:func:`rotation_between`); then the camera rotates with them.
    """
    rotation = rotation_between(source, target, target_to_source)
    return source_view if rotation is None else _rotate_view(source_view, rotation)


def true_views(
    source: Mesh, target: Mesh, truth_s: np.ndarray, truth_t: np.ndarray, source_view: View | None = None
) -> tuple[View, View]:
    """Return views of source and target from the same side by the truth, however wrong a map may be.

    ``truth_s (q,)`` and ``truth_t (q,)`` are corresponding vertices. The view is the same unless the rotation that best
    fits them is larger than 45 degrees. A wrong map must not choose the view: one with left and right swapped would
    show the back, where it looks right.
    """
    view = source_view or automatic_view(source)
    rotation, correlation = fit_rotation(source.vertices[truth_s], target.vertices[truth_t])
    return view, _rotate_view(view, rotation) if correlation >= _MIN_CORRELATION and _is_turned(rotation) else view


def _rotate_view(view: View, rotation: np.ndarray) -> View:
    return View(rotation @ view.towards, rotation @ view.up)


def fit_rotation(source: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the rotation (3, 3) that best maps ``source`` (q, 3) to ``target``, both centred, and their correlation.

    The correlation is from -1 to 1 (Kabsch 1976).
    """
    source, target = (points - points.mean(axis=0) for points in (source, target))
    rotation, scale, _ = similarity(source, target)
    return rotation.T, scale * float(np.linalg.norm(source)) / max(float(np.linalg.norm(target)), 1e-300)


def rotation_between(source: Mesh, target: Mesh, target_to_source: np.ndarray | None = None) -> np.ndarray | None:
    """Return the rotation (3, 3) of the target against the source; ``None`` where both lie alike.

    The map decides, unless the shapes lie closer to each other without its rotation: then it confuses back and front.
    Where there is no map, or one with too little correlation, the principal axes and half turns about them propose
    four rotations, and the one with the smallest distances between the shapes is taken, where they are much smaller
    than without, since poses differ too. Of parts only what has a counterpart is compared. Shapes of different kinds,
    such as a man and a cat, are each seen upright and onto their own broad side, from where the map says. If the map
    shows that one of the files is upside down, the target is turned over.
    """
    a, b, correlation, max_ratio = source.vertices, target.vertices, -1.0, _MAX_MISFIT_RATIO
    rotations: list[np.ndarray] = []
    if target_to_source is not None:
        target_to_source = np.asarray(target_to_source)
        matched = target_to_source >= 0
        if matched.any():
            ends = a[target_to_source[matched]], b[matched]
            rotation, correlation = fit_rotation(*ends)
            rotations = [rotation]
            a, b = (a, b) if matched.all() and _covers(ends[0], a) else ends
    if correlation >= _MIN_CORRELATION:
        max_ratio = 1.0
        if _are_unlike(source, target, np.asarray(target_to_source)):
            frames = broad_side(source).axes(), broad_side(target).axes()
            # One of the files may be upside down.
            up = -1 if (frames[1] @ rotations[0] @ frames[0].T)[1, 1] < -_UPSIDE_DOWN else 1
            upright = [frames[1].T @ np.diag([side, up, side * up]) @ frames[0] for side in (1, -1)]
            rotation = max(upright, key=lambda one: float(np.sum(one * rotations[0])))
            return rotation if _is_turned(rotation) else None
    a, b = _standard(a), _standard(b)
    if correlation < _MIN_CORRELATION:
        axes, target_axes = (np.linalg.eigh(points.T @ points)[1] for points in (a, b))
        proposal = target_axes @ np.diag([1, 1, np.sign(np.linalg.det(target_axes @ axes.T))]) @ axes.T
        half_turns = (Rotation.from_rotvec(np.pi * axis).as_matrix() for axis in axes.T)
        rotations = [proposal, *(proposal @ half for half in half_turns)]
    samples_a, samples_b = (points[:: max(1, len(points) // _N_SAMPLES)] for points in (a, b))
    misfits = [_misfit(samples_a @ rotation.T, samples_b) for rotation in rotations]
    best = int(np.argmin(misfits))
    is_better = misfits[best] < max_ratio * _misfit(samples_a, samples_b)
    return rotations[best] if is_better and _is_turned(rotations[best]) else None


def _covers(reached: np.ndarray, points: np.ndarray) -> bool:
    """Return whether the points of a shape, (n, 3), that a map reaches, (q, 3), are all over it."""
    far, most = 0.2, 0.1  # distance, over the root mean square one from the centre, and share of points that far
    radius = np.sqrt(((points - points.mean(axis=0)) ** 2).sum(axis=1).mean())
    return bool((KDTree(reached).query(points)[0] > far * radius).mean() < most)


def _is_turned(rotation: np.ndarray) -> bool:
    """Return whether a rotation is too large for both shapes to be seen from the same side."""
    return bool(np.rad2deg(Rotation.from_matrix(rotation).magnitude()) > _SAME_VIEW)


def _are_unlike(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> bool:
    """Return whether a map distorts areas as maps between different kinds of bodies do."""
    distortion = area_distortion(source, target, target_to_source)
    distortion = distortion[np.isfinite(distortion)]
    return len(distortion) > 0 and float(np.median(np.abs(distortion - np.median(distortion)))) > _MAX_DISTORTION


def _standard(points: np.ndarray) -> np.ndarray:
    """Return points centred, with a root mean square distance of 1 from the centre."""
    points = points - points.mean(axis=0)
    return points / max(float(np.sqrt((points**2).sum(axis=1).mean())), 1e-300)


def _misfit(a: np.ndarray, b: np.ndarray) -> float:
    """Return the sum of the mean squared distances from each cloud to the nearest points of the other."""
    return float((KDTree(b).query(a)[0] ** 2).mean() + (KDTree(a).query(b)[0] ** 2).mean())
