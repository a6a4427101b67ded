"""What the pages show of a map beside the map itself: change of area, links back, an alignment."""

from __future__ import annotations

import numpy as np

from kfmaps.geometry.mesh import Mesh, face_areas
from kfmaps.viz.camera import fit_rotation


def area_distortion(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Return the base-2 logarithm of how the map changes area around each target vertex, (n_t,), within [-4, 4].

    The area on the source of the images of the faces around a vertex over the area of those faces on the
    target, both shapes scaled to unit area. 0 keeps area, 1 doubles it, -1 halves it; faces collapsed to
    nothing are held at -4. NaN where no face with area meets the vertex, around vertices without a counterpart (−1),
    and everywhere on point clouds.
    """
    n = len(target.vertices)
    if len(target.faces) == 0 or len(source.faces) == 0:
        return np.full(n, np.nan)
    lost = np.asarray(target_to_source) < 0
    image = face_areas(Mesh(source.vertices[target_to_source], target.faces)) / face_areas(source).sum()
    own = face_areas(target) / face_areas(target).sum()
    corners = target.faces.ravel()
    here = np.bincount(corners, np.repeat(own, 3), minlength=n)
    there = np.bincount(corners, np.repeat(image, 3), minlength=n)
    ratio = np.divide(there, here, out=np.full(n, np.nan), where=here > 0)
    ratio[np.unique(target.faces[lost[target.faces].any(axis=1)])] = np.nan
    return np.log2(np.clip(ratio, 2.0**-4, 2.0**4))


def rotation_by_map(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Return the rotation, (3, 3), that turns the target's vertices best onto their matches (Kabsch 1976)."""
    known = np.asarray(target_to_source) >= 0
    if not known.any():
        return np.eye(3)
    there = source.vertices[np.asarray(target_to_source)[known]]
    here = target.vertices[known] - target.vertices[known].mean(axis=0)
    return fit_rotation(here, there - there.mean(axis=0))[0]
