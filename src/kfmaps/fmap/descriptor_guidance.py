"""Descriptors that guide a refinement: they take part in its search for nearest neighbours.

Between bodies the low functions leave several maps equally smooth: left for right, front for back, half of each.
ZoomOut settles in whichever it starts closest to. With a few descriptors of each point beside its functions it slides
into the map that they speak for, and as the functions become more these decide alone. Smooth Shells (Eisenberger et al.
2020) joins functions, coordinates and normals likewise.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from kfmaps._arrays import Array, blocks, like, refuse
from kfmaps.geometry.basis import Basis

DIMENSIONS = 32
"""Principal directions of the descriptors that are kept: SHOT has 352, most of them noise."""
_DIRECTION_ROWS = 10_000  # rows of both shapes that determine the principal directions; more change them by little
FLAT = 0.05
"""Spread of SHOT below which its differences are the triangulation's: a sphere has 0.0005, bodies 0.2 to 0.3."""


@dataclass(frozen=True, eq=False)
class DescriptorGuidance:
    """Descriptors of the points of two shapes, ``source (n_s, d)`` and ``target (n_t, d)``; made by
    :func:`descriptor_guidance`.

    Two random points differ by 1 on average (mean of the squared length).
    """

    source: np.ndarray
    target: np.ndarray

    def at(self, source: np.ndarray | None, target: np.ndarray | None) -> DescriptorGuidance:
        """Return the guidance of the vertices ``source (q_s,)`` and ``target (q_t,)``; ``None`` keeps all."""
        return replace(
            self,
            source=self.source if source is None else self.source[source],
            target=self.target if target is None else self.target[target],
        )

    def swapped(self) -> DescriptorGuidance:
        """Return the guidance of maps the other way."""
        return DescriptorGuidance(self.target, self.source)

    def embedding_columns(self, weight: float, source: Basis, target: Basis) -> tuple[Array, Array]:
        """Return columns to put beside the functions, whose squared differences are ``weight`` on average at unit area.

        Of random points those of k functions are about 2 k, so that descriptors matter much while k is small.
        """
        scale = np.sqrt(weight / float(target.mass.sum()))
        return like(scale * self.source, source.functions), like(scale * self.target, target.functions)


def descriptor_guidance(
    source: np.ndarray | None, target: np.ndarray | None, dimensions: int = DIMENSIONS
) -> DescriptorGuidance | None:
    """Return the first principal components of descriptors, common to both shapes.

    Parameters
    ----------
    source, target : (n_s, d), (n_t, d) or None
        SHOT, mostly.
    dimensions : int
        Components; of SHOT's 352 most are noise.

    Returns
    -------
    DescriptorGuidance or None
        ``None`` where one shape has no descriptors, or both have nothing but noise in them.

    Raises
    ------
    InvalidInput
        If the numbers of descriptors differ.
    """
    if source is None or target is None:
        return None
    if source.shape[1] != target.shape[1]:
        got = f"{source.shape[1]} and {target.shape[1]}"
        raise refuse("descriptors", "equally many on both shapes", got, "compute both with the same settings")
    if not (_varied(source) or _varied(target)):
        return None
    sides = (source, target)
    count = len(source) + len(target)
    mean = (source.sum(axis=0, dtype=np.float64) + target.sum(axis=0, dtype=np.float64)) / count
    # Of large shapes some rows tell the directions; and the mean is taken off what is left, so that none is copied.
    some = np.vstack([side[:: max(1, count // _DIRECTION_ROWS)] for side in sides]) - mean
    directions = np.linalg.eigh(some.T @ some)[1][:, ::-1][:, :dimensions]
    reduced = [side @ directions.astype(side.dtype) - mean @ directions for side in sides]
    unit = np.sqrt(2 * sum((part**2).sum() for part in reduced) / count)
    return DescriptorGuidance(reduced[0] / unit, reduced[1] / unit)


def _varied(descriptors: np.ndarray) -> bool:
    """Whether :func:`descriptor_variance` is at least :data:`FLAT`, mostly told in one pass."""
    mean = descriptors.mean(axis=0, dtype=np.float64)
    about = float(np.einsum("ij,ij->", descriptors, descriptors, dtype=np.float64)) / len(descriptors) - float(
        mean @ mean
    )
    return about > 2 * FLAT or descriptor_variance(descriptors) >= FLAT


def descriptor_variance(descriptors: np.ndarray) -> float:
    """Return the mean squared distance of the rows of ``descriptors (n, d)`` from their mean."""
    mean = descriptors.mean(axis=0, dtype=np.float64)
    squares = sum(float(((descriptors[rows] - mean) ** 2).sum()) for rows in blocks(len(descriptors), 30_000))
    return squares / len(descriptors)


def combine_guidance(guides: list[tuple[float, DescriptorGuidance | None]]) -> DescriptorGuidance | None:
    """Return one guidance of several with weights, relative to the first that there is; ``None`` where there is none.

    Parameters
    ----------
    guides : list of (float, DescriptorGuidance or None)
        The combined guidance has the unit of the first.
    """
    present = [(w, g) for w, g in guides if g is not None and w > 0]
    if not present:
        return None
    scale = [np.sqrt(w / present[0][0]) for w, _ in present]
    sides = [
        [s * side for s, side in zip(scale, pair, strict=True)]
        for pair in zip(*((g.source, g.target) for _, g in present), strict=True)
    ]
    return DescriptorGuidance(np.hstack(sides[0]), np.hstack(sides[1]))
