"""Where the points of a target lie on a source that is bent onto it, also where a body touches itself.

A hand that hangs at a thigh and the thigh are near in space, and the fit leaves some thousandths between the surfaces:
the closest point of a hand's vertex may be on the thigh. Of what is nearly as close the normal tells the two apart and,
where that does not, how far the place was at rest from where the map that the fit began with had the point.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps.geometry.closest_points import ClosestPoints, closest_among, closest_points
from kfmaps.geometry.mesh import Mesh, vertex_normals
from kfmaps.registration.deformable import NORMALS, DeformableMesh

_REST_WEIGHT = 0.05
"""Distance in space, at unit area, that counts as much as places at rest that are 1 apart: a limb that the fit has
found back, half a body from where the map had it, stays there unless another is as near."""


def project_with_contact(
    points: np.ndarray, body: DeformableMesh, x: np.ndarray, target: Mesh, normals: np.ndarray
) -> ClosestPoints:
    """Return the place of each vertex of the target on the bent source.

    It is the closest place in space or, where it costs less, one at the vertex that is nearest by everything: squared
    distance in space, in normals (those that differ by 1 count as 0.02), and at rest from the map's points (1 counts as
    0.05). On meshes as uneven as may be none costs more than the closest in space.

    ``points (n_t,)``: the map that the registration began with; ``body``: the source; ``x (n_s, 3)``: its vertices,
    bent; ``normals (n_t, 3)``: of the target's vertices.
    """
    faces, rest = body.mesh.faces, body.mesh.vertices
    there = np.hstack([x, NORMALS * vertex_normals(Mesh(x, faces)), _REST_WEIGHT * rest])
    wanted = np.hstack([target.vertices, NORMALS * normals, _REST_WEIGHT * rest[points]])
    closest = closest_points(target.vertices, x, faces)
    near = np.asarray(KDTree(there).query(wanted)[1])
    likely = closest_among(target.vertices, x, faces, *body.around.around(near))
    cheaper = _cost(likely, there[faces], wanted) < _cost(closest, there[faces], wanted)
    pairs = ((getattr(likely, name), getattr(closest, name)) for name in ("faces", "weights", "points", "distances"))
    return ClosestPoints(
        *(np.where(cheaper if one.ndim == 1 else cheaper[:, None], one, other) for one, other in pairs)
    )


def _cost(places: ClosestPoints, corners: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Squared distance of each place from what is ``wanted (n_t, 9)``; ``corners (f, 3, 9)`` of the faces."""
    here = np.einsum("qi,qid->qd", places.weights, corners[places.faces])
    here[:, 3:6] *= NORMALS / np.maximum(np.linalg.norm(here[:, 3:6], axis=1, keepdims=True), 1e-12)
    return ((here - wanted) ** 2).sum(axis=1)
