"""Where to look from: orthographic views, chosen by the shape or given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from kfmaps._arrays import check, refuse
from kfmaps.surface.mesh import Mesh

BROADER = 1.15
"""How much more of a shape a view that is not along one of the file's axes must show to be preferred."""
STEADIER = 1.4
"""How much better than on y a shape must stand on z for z to be up."""
YAW, PITCH = 20.0, 10.0
"""Degrees by which the automatic view is turned aside and lifted, so that depth shows."""
SAME_VIEW = 45.0
"""Degrees that a target may be turned against the source and still be seen from the same side."""

LIKENESS = 0.6
"""Correlation between the turned source and the target above which a turn is believed; poses of one shape have 0.75."""


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

    def axes(self) -> np.ndarray:
        """Rows right, up, towards (3, 3): ``points @ axes.T`` is picture coordinates and closeness."""
        return np.stack([np.cross(self.up, self.towards), self.up, self.towards])


def view(towards: ArrayLike, up: ArrayLike = (0, 1, 0)) -> View:
    """The view from the direction ``towards`` (3,) with ``up`` (3,) upwards; their lengths do not matter.

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


def automatic_view(mesh: Mesh) -> View:
    """A view onto the broad side of a shape, a little from aside and from above.

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
    if _silhouette(points, thinnest) > BROADER * shown.max():
        towards = thinnest * np.sign(thinnest[np.abs(thinnest).argmax()])
    if abs(towards[1]) > 0.8:
        up = z
    elif abs(towards[2]) > 0.8:
        up = y
    else:
        up = z if _stance(points, z) > STEADIER * _stance(points, y) else y
    frame = view(towards, up).axes()
    yaw, pitch = np.deg2rad([YAW, PITCH])
    aside = np.cos(yaw) * frame[2] + np.sin(yaw) * frame[0]
    return view(np.cos(pitch) * aside + np.sin(pitch) * frame[1], frame[1])


def following_view(source_view: View, source: Mesh, target: Mesh, target_to_source: np.ndarray) -> View:
    """The view that shows the target from the side from which ``source_view`` shows the source.

    It is the same view, unless the rotation that best carries the source onto the target (Kabsch 1976)
    turns by more than 45 degrees: then the camera turns with it. A map so wrong that no rotation carries one
    shape to about where the other is turns nothing.
    """
    carried = source.vertices[target_to_source]
    carried = carried - carried.mean(axis=0)
    there = target.vertices - target.vertices.mean(axis=0)
    u, fit, vt = np.linalg.svd(there.T @ carried)
    proper = np.array([1, 1, np.linalg.det(u @ vt)])
    turn = u @ np.diag(proper) @ vt
    alike = fit @ proper >= LIKENESS * np.linalg.norm(carried) * np.linalg.norm(there)
    if not alike or np.rad2deg(Rotation.from_matrix(turn).magnitude()) <= SAME_VIEW:
        return source_view
    return View(turn @ source_view.towards, turn @ source_view.up)
