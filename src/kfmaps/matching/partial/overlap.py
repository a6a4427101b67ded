"""What two shapes have in common, once one is bent onto the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps.fmap.precise import PointMap
from kfmaps.geometry.closest_points import ClosestPoints
from kfmaps.geometry.mesh import Mesh, vertex_normals
from kfmaps.matching.partial.registration import PartRegistration, RegistrationTarget, on_border
from kfmaps.registration.deformable import closest_point_query

WIDTH = 0.02
"""Distance between the surfaces, in √area of the whole, at which a common point is as likely as not."""


@dataclass(frozen=True, eq=False)
class Overlap:
    """What is common, by vertices, and where each lies on the other shape.

    Attributes
    ----------
    part : (n_p,) float64
        Probability to be on both.
    whole : (n_w,) float64
    on_whole : PointMap
        For each vertex of the part.
    on_part : PointMap
        For each vertex of the whole; means something only where ``whole`` is above a half.
    """

    part: np.ndarray
    whole: np.ndarray
    on_whole: PointMap
    on_part: PointMap


def covered(
    bent: Mesh, border: np.ndarray, whole: Mesh, normals: np.ndarray | None = None
) -> tuple[np.ndarray, ClosestPoints]:
    """Probability (n_w,) of each vertex of ``whole`` to lie on a ``bent`` mesh, and the closest place on it.

    Both in the unit of the whole, which has unit area. ``border``: the bent mesh's vertices on its boundary;
    ``normals``: the whole's.
    """
    found, _, agree = closest_point_query(bent)(whole.vertices, vertex_normals(whole) if normals is None else normals)
    edge = on_border(found, bent.faces, border)
    # Beyond the part's edge the closest point lies on it: half the length of its edges is as near as vertices can tell.
    corners = bent.vertices[bent.faces[found.faces]]
    half = 0.5 * np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean(axis=1)
    width = np.where(edge, np.minimum(half, WIDTH), WIDTH)
    return _near(found.distances, width) * np.where(agree > 0, 1.0, 0.25), found


def overlap(bent: PartRegistration, whole: RegistrationTarget, border: np.ndarray) -> Overlap:
    """Of a part ``bent`` onto ``whole``; ``border (n_p,)`` are the part's vertices on its boundary."""
    common, found = covered(Mesh(bent.vertices, bent.rest.faces), border, whole.mesh, whole.normals)
    own = np.where(bent.inside, _near(bent.places.distances, WIDTH), 0.0)
    return Overlap(
        own,
        common,
        PointMap(bent.places.faces, bent.places.weights),
        PointMap(found.faces, found.weights),
    )


def _near(distances: np.ndarray, width: np.ndarray | float) -> np.ndarray:
    """1 at no distance, a half at ``width``."""
    return np.exp2(-((distances / np.maximum(width, 1e-12)) ** 2))
