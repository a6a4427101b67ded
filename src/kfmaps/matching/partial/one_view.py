"""Compare the scan of one camera with what single cameras would see of a whole.

A scan of one camera is a third to a half of the surface, everywhere near its boundary. So nearly all balls of SHOT are
cut, and SHOT there is unlike that of the whole. But it ends where the surface turns away from the camera. SHOT of the
whole's faces that are turned to one side is cut likewise, and what is right is then most similar from some side.
"""

from __future__ import annotations

import numpy as np

from kfmaps.geometry.mesh import Mesh, face_areas, face_normals, spread_directions

_DIRECTIONS = 24
"""Directions that the whole is seen from."""
_LEAST_COSINE = 0.1
"""Cosine between a normal and the direction to the camera from which a face is seen. −0.1 and 0.25 are worse
(research/body-model.md)."""


def is_view_of(part: Mesh, whole: Mesh) -> bool:
    """Return whether one camera could have seen nearly all of a part, but not of the whole."""
    return _is_one_view(part) and not _is_one_view(whole)


def _is_one_view(mesh: Mesh) -> bool:
    """Return whether the faces of a mesh are turned to one side."""
    min_share = 0.85  # of the area; bodies cut by planes have up to 0.7
    normals, areas = face_normals(mesh), face_areas(mesh)
    middle = areas @ normals
    return float(areas[normals @ middle > 0].sum()) >= min_share * float(areas.sum())


def views(mesh: Mesh) -> np.ndarray:
    """Return which faces are turned to each of some directions, (d, m) bool.

    What hides them does not count: bodies of other poses hide other things.
    """
    return spread_directions(_DIRECTIONS) @ face_normals(mesh).T > _LEAST_COSINE
