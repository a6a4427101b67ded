"""Whether the source looks like the target once it is bent onto it: evidence that tells front from back.

A map that swaps front and back together with left and right bends a body almost as little as the right one. Only, it
then has heels where the target has toes. SHOT of a small radius sees little of that, and of a large one it depends on
the pose; of a body that has been bent into the other's pose, stiffly, so that its feet stay what they are, it does not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import NotConverged
from kfmaps.descriptors.shot import shot
from kfmaps.geometry.mesh import Mesh
from kfmaps.registration.alternating_registration import FIT, places
from kfmaps.registration.deformation_energy import Ready, ways
from kfmaps.registration.nonrigid_icp import Facing
from kfmaps.shape import Shape

RADIUS, SUPPORT = 0.2, 5000
"""Of SHOT, in √area: a foot or a head and what it sits on; and from how many points of the surface."""
STEP = 6
"""Of the copy at rest every so many vertices are looked at."""


@dataclass(frozen=True, eq=False)
class Sight:
    """Where some points of a surface are, (q, 6) positions and normals, and how it looks from there, (q, 352) SHOT."""

    places: np.ndarray
    descriptors: np.ndarray


def sight(mesh: Mesh) -> Sight:
    """Of every few vertices of a ``mesh`` of unit area."""
    at = np.arange(0, len(mesh.vertices), STEP)
    return Sight(places(mesh)[at], _descriptors(mesh, at))


def difference(seen: Sight, other: Mesh) -> float:
    """Mean squared difference of SHOT, from 0 to 2, from that of an ``other`` surface in the same place.

    Each point is compared with the vertex that lies nearest; the points of a copy are spread evenly and count alike.
    """
    near = np.asarray(KDTree(places(other)).query(seen.places)[1])
    return float(((seen.descriptors - _descriptors(other, near)) ** 2).sum(axis=1).mean())


def _descriptors(mesh: Mesh, at: np.ndarray) -> np.ndarray:
    return shot(mesh, RADIUS, samples=SUPPORT, at=at, threads=1)


@dataclass(frozen=True, eq=False)
class Looks:
    """The copies of two shapes, ready to be bent, and how they look at rest; made by :func:`looks`."""

    on: Ready
    seen: tuple[Sight, Sight]


def looks(on: Ready) -> Looks:
    """Of copies of two shapes."""
    return Looks(on, (sight(on.copies[0].mesh), sight(on.copies[1].mesh)))


def mismatch(C: np.ndarray, source: Shape, target: Shape, of: Looks) -> float | None:
    """:func:`difference` of each copy, bent onto the other as ``C (k_t, k_s)`` says; the mean of both directions.

    Of one where the other falls apart, ``None`` where both do.
    """
    there, back = ways(C, source, target, of.on)
    found = [_mismatch(*there, of.seen[1]), _mismatch(*back, of.seen[0])]
    known = [value for value in found if value is not None]
    return sum(known) / len(known) if known else None


def _mismatch(pair: Facing, points: np.ndarray, seen: Sight) -> float | None:
    try:
        x, _ = FIT.bent(pair, points)
    except NotConverged:
        return None
    return difference(seen, Mesh(x, pair.body.mesh.faces))
