"""A pair of meshes with their true correspondence, made from one reference surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from kfmaps._records import short_repr
from kfmaps.datasets.skeleton import Bend, Body
from kfmaps.datasets.surface import closed_mesh
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.connectivity import boundary_edges, component_labels, half_edges_by_edge
from kfmaps.geometry.mesh import Mesh, face_areas


@dataclass(frozen=True, eq=False)
class ExamplePair:
    """Two meshes of one shape and the true correspondence."""

    name: str
    source: Mesh  # meshed independently: no vertex of one is meant to be a vertex of the other
    target: Mesh
    truth: np.ndarray  # (n_t,): for each target vertex the source vertex nearest to its exact position on the source
    truth_faces: np.ndarray  # (n_t,): the source face with the exact position
    # (n_t, 3): barycentric coordinates of the exact position in that face: not negative, sum 1.
    truth_weights: np.ndarray
    # (n_t,): on a shape that is its own mirror image, the truth that swaps left and right.
    mirrored: np.ndarray | None = None

    __repr__ = short_repr


def _nearest_vertex(reference: np.ndarray, posed: np.ndarray, points: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """Return for each of ``points`` the vertex whose ``posed`` position is nearest to ``exact``, (n,).

    Candidates are the six nearest vertices of the ``reference``, where limbs that touch in the pose are apart.
    """
    near = np.asarray(KDTree(reference).query(points, k=6)[1])
    best = np.linalg.norm(posed[near] - exact[:, None], axis=2).argmin(axis=1)
    return near[np.arange(len(points)), best].astype(np.int64)


def posed_pair(
    name: str,
    body: Body,
    pose_s: dict[str, Bend],
    pose_t: dict[str, Bend],
    counts: tuple[int, int],
    rng: np.random.Generator,
    *,
    unbent_t: dict[str, Bend] | None = None,
    mirror: bool = False,
) -> ExamplePair:
    """Return one body in two poses, each meshed for itself.

    ``counts``: vertices of the source and of the target; ``unbent_t``: the target's proportions without its turns, when
    they differ from the source's; ``mirror``: whether the body is its own mirror image in the plane x = 0.
    """
    box = body.box()
    points_s, faces_s = closed_mesh(body, box, counts[0], rng)
    warp = None if unbent_t is None else lambda x: body.bend(x, unbent_t)
    points_t, faces_t = closed_mesh(body, box, counts[1], rng, warp=warp)
    source = Mesh(body.bend(points_s, pose_s), faces_s)
    target = Mesh(body.bend(points_t, pose_t), faces_t)

    def truth(points: np.ndarray) -> np.ndarray:
        return _nearest_vertex(points_s, source.vertices, points, body.bend(points, pose_s))

    on_source = closest_points(points_t, points_s, faces_s)
    mirrored = truth(points_t * [-1, 1, 1]) if mirror else None
    return ExamplePair(name, source, target, truth(points_t), on_source.faces, on_source.weights, mirrored)


def largest_piece(mesh: Mesh, keep: np.ndarray) -> tuple[Mesh, np.ndarray]:
    """Return the largest connected part whose vertices are all in ``keep (n,)`` bool, and its vertices' old numbers.

    Where two corners of the rim would touch in one vertex, the faces around it go too, so that the part
    is a manifold with boundary.
    """
    faces = mesh.faces[keep[mesh.faces].all(axis=1)]
    while True:
        order, start, sharing = half_edges_by_edge(faces, len(keep))
        shared = start[sharing == 2]
        component = component_labels(len(faces), order[shared] // 3, order[shared + 1] // 3)[1]
        faces = faces[component == np.bincount(component, face_areas(Mesh(mesh.vertices, faces))).argmax()]
        touching = np.bincount(boundary_edges(faces, len(keep)).ravel(), minlength=len(keep)) > 2
        if not touching.any():
            break
        faces = faces[~touching[faces].any(axis=1)]
    old, new = np.unique(faces, return_inverse=True)
    return Mesh(mesh.vertices[old], new.reshape(-1, 3)), old
