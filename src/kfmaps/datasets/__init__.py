"""Shapes made by code alone, with their true correspondences: for demonstrations, tests and experiments.

Everything is random only through ``rng``: the same seed gives the same meshes. Lengths are in units of
about half the creature's height.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kfmaps._arrays import check_count, refuse
from kfmaps.datasets.creature import CREATURE, DANCE, SYMMETRIC, WAVE, with_proportions
from kfmaps.datasets.pairs import ExamplePair, largest_piece, posed_pair
from kfmaps.datasets.skeleton import Body
from kfmaps.datasets.surface import closed_mesh
from kfmaps.geometry.mesh import Mesh

__all__ = ["ExamplePair", "non_isometric", "partial", "sphere", "symmetric_creature", "torus", "two_poses"]

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
    unbent, bent = with_proportions({}), with_proportions(DANCE)
    counts = _counts(vertices)
    return posed_pair("non-isometric", Body(CREATURE), WAVE, bent, counts, rng, unbent_t=unbent)


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
