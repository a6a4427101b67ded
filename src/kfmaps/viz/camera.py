"""Where to look from: orthographic views, chosen by the shape or given."""

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

_BROADER = 1.15  # how much more of a shape a view that is not along one of the file's axes must show to be preferred
_STEADIER = 1.4  # how much better than on y a shape must stand on z for z to be up
_YAW, _PITCH = 20.0, 10.0  # degrees by which the automatic view is turned aside and lifted, so that depth shows
_SAME_VIEW = 45.0  # degrees that a target may be turned against the source and still be seen from the same side

_LIKENESS = 0.6
"""Correlation between the turned source and the target above which a turn is believed; poses of one shape have 0.75."""
_CLEARLY = 0.75
"""Part of the misfit of shapes as they lie that a turned one may have. Of 182 ordered pairs of scanned people in 14
poses who all face one way, 3 % fit that much better when one is turned half round."""
_UNLIKE = 0.45
"""Typical change of area under a map, as a power of two, above which the shapes are of different kinds. Poses of one
body have up to 0.42, a cat and a dog 0.49, a gorilla and a woman 0.54, a man and a cat 0.64."""
_SAMPLES = 800  # points of each shape that this is measured on


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
    """How much a shape seems to stand on feet: lowest points far apart, and its middle high above them."""
    height = points @ up
    rise = height - height.min()
    low = points[rise <= 0.05 * rise.max()]
    apart = np.linalg.norm(np.ptp(low, axis=0)) / np.linalg.norm(np.ptp(points, axis=0))
    return float(apart * rise.mean() / max(rise.max(), 1e-300))


def _silhouette(points: np.ndarray, towards: np.ndarray) -> int:
    """How much of the picture centred ``points`` cover when seen from ``towards``, in small squares."""
    across = np.linalg.svd(towards[None])[2][1:]
    # Not smaller than the distance between neighbouring points.
    square = np.sqrt((points**2).sum(axis=1).mean()) * max(1 / 15, 5 / np.sqrt(len(points)))
    cells = np.floor(points @ across.T / max(square, 1e-300)).astype(np.int64)
    return len(np.unique(cells, axis=0))


def broad_side(mesh: Mesh) -> View:
    """Return the view straight onto the broad side of a shape.

    The camera looks from the end of the file's axis z, x or y that shows most, or along the direction of
    least variance where that shows much more still, as on a shape that lies askew. Up is the file's y, or
    its z where the camera looks along y or where the shape seems to stand on it.
    """
    points = mesh.vertices - mesh.vertices.mean(axis=0)
    x, y, z = np.eye(3)
    shown = np.array([_silhouette(points, axis) for axis in (z, x, y)])
    # Between nearly equal ones the first, so that two poses of a shape are seen alike.
    towards = (z, x, y)[int(np.argmax(shown >= 0.95 * shown.max()))]
    thinnest = np.linalg.eigh(points.T @ points)[1][:, 0]
    if _silhouette(points, thinnest) > _BROADER * shown.max():
        towards = thinnest * np.sign(thinnest[np.abs(thinnest).argmax()])
    if abs(towards[1]) > 0.8:
        up = z
    elif abs(towards[2]) > 0.8:
        up = y
    else:
        up = z if _stance(points, z) > _STEADIER * _stance(points, y) else y
    return view_from(towards, up)


def automatic_view(mesh: Mesh) -> View:
    """Return the view onto the :func:`broad_side` of a shape, a little from aside and from above."""
    frame = broad_side(mesh).axes()
    yaw, pitch = np.deg2rad([_YAW, _PITCH])
    aside = np.cos(yaw) * frame[2] + np.sin(yaw) * frame[0]
    return view_from(np.cos(pitch) * aside + np.sin(pitch) * frame[1], frame[1])


def following_view(source_view: View, source: Mesh, target: Mesh, target_to_source: np.ndarray | None = None) -> View:
    """Return the view that shows the target from the side of the body from which ``source_view`` shows the source.

    ``target_to_source (n_t,)`` is the map, where one is known. It is the same view, unless the shapes lie in different
    directions (:func:`rotation_between`): then the camera turns with them. A map that takes back for front is thereby
    seen to do so.
    """
    turn = rotation_between(source, target, target_to_source)
    return source_view if turn is None else _turned(source_view, turn)


def true_views(
    source: Mesh, target: Mesh, truth_s: np.ndarray, truth_t: np.ndarray, source_view: View | None = None
) -> tuple[View, View]:
    """Return views of source and target from the same side by the truth, however wrong a map may be.

    ``truth_s (q,)`` and ``truth_t (q,)`` are corresponding vertices. It is the same view, unless the rotation that best
    carries the source onto the target turns by more than 45 degrees. A map with left and right swapped would have the
    camera go round to the back, where it looks right.
    """
    view = source_view or automatic_view(source)
    turn, alike = fit_rotation(source.vertices[truth_s], target.vertices[truth_t])
    return view, _turned(view, turn) if alike >= _LIKENESS and _is_turned(turn) else view


def _turned(view: View, turn: np.ndarray) -> View:
    return View(turn @ view.towards, turn @ view.up)


def fit_rotation(source: np.ndarray, target: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the rotation (3, 3) that best carries ``source`` (q, 3) onto ``target`` (Kabsch 1976), and how well.

    Both are centred. How well is the correlation between them, from -1 to 1.
    """
    source, target = (points - points.mean(axis=0) for points in (source, target))
    turn, scale, _ = similarity(source, target)
    return turn.T, scale * float(np.linalg.norm(source)) / max(float(np.linalg.norm(target)), 1e-300)


def rotation_between(source: Mesh, target: Mesh, target_to_source: np.ndarray | None = None) -> np.ndarray | None:
    """Return the rotation (3, 3) from how the source lies to how the target lies; ``None`` where they lie alike.

    The map proposes one, and the same with the shape turned half round each of its axes, for the map may have taken
    back for front; without a map that can be believed the principal axes propose some. Which is right the shapes
    decide: turned rightly, points of one lie close to points of the other. Some other turn must fit much better than
    none to be believed, since poses differ too. Shapes of different kinds, as a man and a cat, are each seen upright
    and from their own broad side instead.
    """
    a, b = _standard(source.vertices), _standard(target.vertices)
    axes = np.linalg.eigh(a.T @ a)[1]
    halves = [np.eye(3), *(Rotation.from_rotvec(np.pi * axis).as_matrix() for axis in axes.T)]
    first, alike = np.eye(3), 0.0
    if target_to_source is not None:
        known = np.asarray(target_to_source) >= 0
        if known.any():
            first, alike = fit_rotation(a[np.asarray(target_to_source)[known]], b[known])
    if alike >= _LIKENESS and _are_unlike(source, target, np.asarray(target_to_source)):
        turn = broad_side(target).axes().T @ broad_side(source).axes()
        return turn if _is_turned(turn) else None
    if alike < _LIKENESS:
        other = np.linalg.eigh(b.T @ b)[1]
        first = other @ np.diag([1, 1, np.sign(np.linalg.det(other @ axes.T))]) @ axes.T
    turns = [first @ half for half in halves]
    some_a, some_b = (points[:: max(1, len(points) // _SAMPLES)] for points in (a, b))
    misfits = [_misfit(some_a @ turn.T, some_b) for turn in turns]
    best = int(np.argmin(misfits))
    better = misfits[best] < _CLEARLY * _misfit(some_a, some_b)
    return turns[best] if better and _is_turned(turns[best]) else None


def _is_turned(turn: np.ndarray) -> bool:
    """Whether a rotation is too large for both shapes to be seen from the same side."""
    return bool(np.rad2deg(Rotation.from_matrix(turn).magnitude()) > _SAME_VIEW)


def _are_unlike(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> bool:
    """Return whether a map changes areas as one between bodies of different kinds."""
    change = area_distortion(source, target, target_to_source)
    change = change[np.isfinite(change)]
    return len(change) > 0 and float(np.median(np.abs(change - np.median(change)))) > _UNLIKE


def _standard(points: np.ndarray) -> np.ndarray:
    """Centred, at one size."""
    points = points - points.mean(axis=0)
    return points / max(float(np.sqrt((points**2).sum(axis=1).mean())), 1e-300)


def _misfit(a: np.ndarray, b: np.ndarray) -> float:
    """Mean squared distance between the points of either cloud and the nearest of the other."""
    return float((KDTree(b).query(a)[0] ** 2).mean() + (KDTree(a).query(b)[0] ** 2).mean())
