"""Shapes made by code alone, with their true correspondences: for demonstrations, tests and experiments.

Everything is random only through ``rng``: the same seed gives the same meshes. Lengths are in units of
about half the creature's height.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import check_count, refuse
from kfmaps._records import short_repr
from kfmaps.datasets.creature import CREATURE, DANCE, SYMMETRIC, WAVE, with_proportions
from kfmaps.datasets.skeleton import Bend, Body
from kfmaps.datasets.surface import closed_mesh
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.connectivity import boundary_edges, component_labels, half_edges_by_edge
from kfmaps.geometry.mesh import Mesh, face_areas

__all__ = ["ExamplePair", "non_isometric", "partial", "sphere", "symmetric_creature", "torus", "two_poses"]


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
        component = component_labels(len(faces), *(half_edges_by_edge(faces, len(keep))[1] // 3))[1]
        faces = faces[component == np.bincount(component, face_areas(Mesh(mesh.vertices, faces))).argmax()]
        touching = np.bincount(boundary_edges(faces, len(keep)).ravel(), minlength=len(keep)) > 2
        if not touching.any():
            break
        faces = faces[~touching[faces].any(axis=1)]
    old, new = np.unique(faces, return_inverse=True)
    return Mesh(mesh.vertices[old], new.reshape(-1, 3)), old


_MAX_VERTICES = 300_000  # number of vertices of the largest mesh

_Seed = int | np.random.Generator


def _counts(vertices: int) -> tuple[int, int]:
    """Return the number of vertices of source and target, a fifth fewer."""
    check_count(vertices, "vertices", low=1500, high=_MAX_VERTICES)
    return vertices, round(0.8 * vertices)


def two_poses(vertices: int = 6000, rng: _Seed = 0) -> ExamplePair:
    """Return a creature in two poses, meshed independently; no side of it is like the other.

    The poses bend it along its limbs, which changes lengths little: of the edges of one mesh, in the
    other pose, four in five keep their length within 10 %. The largest changes are at shoulders and hips.

    The source has ``vertices`` (1500 to 300000) vertices, the target four fifths of them; ``rng`` places them.
    """
    rng = np.random.default_rng(rng)
    return posed_pair("two poses", Body(CREATURE), WAVE, DANCE, _counts(vertices), rng)


def non_isometric(vertices: int = 6000, rng: _Seed = 0) -> ExamplePair:
    """Return the creature of :func:`two_poses`, and a relative with a fat belly, long legs and a short tail.

    Lengths differ by up to a half between the two, the area by a third. ``vertices`` and ``rng`` are as in
    :func:`two_poses`.
    """
    rng = np.random.default_rng(rng)
    straight, posed = with_proportions({}), with_proportions(DANCE)
    counts = _counts(vertices)
    return posed_pair("non-isometric", Body(CREATURE), WAVE, posed, counts, rng, unbent_t=straight)


def partial(vertices: int = 6000, rng: _Seed = 0, kept: float = 0.6) -> ExamplePair:
    """Return the creature of :func:`two_poses`, and a part of it in the other pose, cut off obliquely.

    The cut keeps the fraction ``kept`` (0.2 to 0.95) of the vertices, and of these the largest piece is the target: one
    manifold with a boundary. ``vertices`` and ``rng`` are as in :func:`two_poses`, for the whole.
    """
    if not 0.2 <= kept <= 0.95:
        raise refuse("kept", "a number from 0.2 to 0.95", repr(kept), "choose one in that range")
    whole = two_poses(vertices, rng)
    height = whole.target.vertices @ [0.35, 1.0, 0.2]
    target, old = largest_piece(whole.target, height >= np.quantile(height, 1 - kept))
    return replace(
        whole,
        name="partial",
        target=target,
        truth=whole.truth[old],
        truth_faces=whole.truth_faces[old],
        truth_weights=whole.truth_weights[old],
    )


def symmetric_creature(vertices: int = 6000, rng: _Seed = 0) -> ExamplePair:
    """Return two poses of a creature whose right side is the mirror image of its left.

    Lengths alone cannot tell the direct truth from ``mirrored``; only orientation can. The poses are not
    symmetric. ``vertices`` and ``rng`` are as in :func:`two_poses`.
    """
    rng = np.random.default_rng(rng)
    counts = _counts(vertices)
    return posed_pair("symmetric creature", Body(SYMMETRIC), WAVE, DANCE, counts, rng, mirror=True)


def sphere(vertices: int = 2000, rng: _Seed = 0) -> Mesh:
    """Return the unit sphere with ``vertices`` (100 to 300000) evenly spread vertices, drawn with ``rng``."""
    check_count(vertices, "vertices", low=100, high=_MAX_VERTICES)

    def field(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        radius = np.linalg.norm(points, axis=1)
        return radius - 1, points / np.maximum(radius, 1e-12)[:, None]

    box = 1.1 * np.array([[-1.0, -1, -1], [1, 1, 1]])
    # Tetrahedra between points on one sphere take time that grows as the square of their number.
    return Mesh(*closed_mesh(field, box, vertices, np.random.default_rng(rng), scattered=4000))


def torus(vertices: int = 2000, rng: _Seed = 0, tube: float = 0.4) -> Mesh:
    """Return the torus (genus 1) of radius 1 about the y axis, with ``vertices`` (400 to 300000) vertices.

    Its tube's radius is ``tube``, from 0.2 to 0.8; ``rng`` places the vertices.
    """
    check_count(vertices, "vertices", low=400, high=_MAX_VERTICES)
    if not 0.2 <= tube <= 0.8:
        raise refuse("tube", "a number from 0.2 to 0.8", repr(tube), "choose one in that range")

    def field(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        radius = np.maximum(np.hypot(points[:, 0], points[:, 2]), 1e-12)
        outwards = (points * [1, 0, 1]) / radius[:, None]
        away = points - outwards
        length = np.linalg.norm(away, axis=1)
        return length - tube, away / np.maximum(length, 1e-12)[:, None]

    reach = np.array([1 + tube, tube, 1 + tube]) + 0.1
    return Mesh(*closed_mesh(field, np.array([-reach, reach]), vertices, np.random.default_rng(rng), genus=1))
