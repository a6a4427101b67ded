"""Projection of the target's vertices to the registered source, also where a body touches itself.

A hand that hangs at a thigh is near it, and a registration leaves some thousandths between the surfaces, so the point
closest to a vertex of the hand may be on the thigh. Normals tell nearly closest points apart and, where they do not,
the distance at rest from the image in the initial map.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps.geometry.closest_points import ClosestPoints, closest_among, closest_points
from kfmaps.geometry.mesh import Mesh, vertex_normals
from kfmaps.registration.deformable import NORMALS, DeformableMesh

_REST_WEIGHT = 0.05
"""Distance in space that counts as much as a distance of 1 at rest, at unit area. So a limb that the registration has
moved by half a body to its right place stays there, unless another one is as near."""


def project_with_contact(
    points: np.ndarray, body: DeformableMesh, x: np.ndarray, target: Mesh, normals: np.ndarray
) -> ClosestPoints:
    """Return the point of the registered source for each vertex of the target.

    The features of a point are its position, its normal (times 0.02) and its position at rest (times 0.05). Compared
    are the closest point in space and the closest point of the faces around the vertex with the nearest features. The
    one with the nearer features is returned.

    ``points (n_t,)``: the initial map; ``body``: the source; ``x (n_s, 3)``: its registered vertices; ``normals (n_t,
    3)``: of the target's vertices.
    """
    faces, rest = body.mesh.faces, body.mesh.vertices
    features_s = np.hstack([x, NORMALS * vertex_normals(Mesh(x, faces)), _REST_WEIGHT * rest])
    features_t = np.hstack([target.vertices, NORMALS * normals, _REST_WEIGHT * rest[points]])
    closest = closest_points(target.vertices, x, faces)
    nearest = np.asarray(KDTree(features_s).query(features_t)[1])
    other = closest_among(target.vertices, x, faces, *body.around.around(nearest))
    use_other = _costs(other, features_s[faces], features_t) < _costs(closest, features_s[faces], features_t)
    rows = use_other[:, None]
    return ClosestPoints(
        np.where(use_other, other.faces, closest.faces),
        np.where(rows, other.weights, closest.weights),
        np.where(rows, other.points, closest.points),
        np.where(use_other, other.distances, closest.distances),
    )


def _costs(points: ClosestPoints, corner_features: np.ndarray, features_t: np.ndarray) -> np.ndarray:
    """Return the squared distances of points from ``features_t (n_t, 9)``; ``corner_features (f, 3, 9)`` of faces."""
    features = np.einsum("qi,qid->qd", points.weights, corner_features[points.faces])
    features[:, 3:6] *= NORMALS / np.maximum(np.linalg.norm(features[:, 3:6], axis=1, keepdims=True), 1e-12)
    return ((features - features_t) ** 2).sum(axis=1)
