"""Descriptors that guide a refinement: its search for nearest neighbours compares them beside the functions.

Between bodies several maps are equally smooth in the low functions: left for right, front for back, half of each.
ZoomOut converges to the one that it starts closest to. With a few descriptors beside the functions it converges to the
map that keeps them, and as the functions become more they outweigh the descriptors. Smooth Shells (Eisenberger et al.
2020) join functions, coordinates and normals in the same way.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from kfmaps._arrays import Array, blocks, like, refuse
from kfmaps.geometry.basis import Basis

DIMENSIONS = 32
"""Principal components of the descriptors that are kept. Most of the 352 of SHOT are noise."""
_DIRECTION_ROWS = 10_000  # rows of both shapes that determine the principal directions; more change them by little
FLAT = 0.05
"""Variance of SHOT below which it only shows the triangulation. A sphere has 0.0005, bodies 0.2 to 0.3."""


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
        """Return extra columns of an embedding whose mean squared difference at unit area is ``weight``.

        That of k functions is about 2 k, so that descriptors matter most while k is small.
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
    if not (_has_features(source) or _has_features(target)):
        return None
    both = (source, target)
    count = len(source) + len(target)
    mean = (source.sum(axis=0, dtype=np.float64) + target.sum(axis=0, dtype=np.float64)) / count
    # Every few rows of large shapes are enough. The mean is subtracted from the components, so that no row is copied.
    rows = np.vstack([side[:: max(1, count // _DIRECTION_ROWS)] for side in both]) - mean
    directions = np.linalg.eigh(rows.T @ rows)[1][:, ::-1][:, :dimensions]
    components = [side @ directions.astype(side.dtype) - mean @ directions for side in both]
    unit = np.sqrt(2 * sum((side**2).sum() for side in components) / count)
    return DescriptorGuidance(components[0] / unit, components[1] / unit)


def _has_features(descriptors: np.ndarray) -> bool:
    """Return whether :func:`descriptor_variance` is at least :data:`FLAT`, by a quick estimate where it suffices."""
    mean = descriptors.mean(axis=0, dtype=np.float64)
    squares = float(np.einsum("ij,ij->", descriptors, descriptors, dtype=np.float64))
    return squares / len(descriptors) - float(mean @ mean) > 2 * FLAT or descriptor_variance(descriptors) >= FLAT


def descriptor_variance(descriptors: np.ndarray) -> float:
    """Return the mean squared distance of the rows of ``descriptors (n, d)`` from their mean."""
    mean = descriptors.mean(axis=0, dtype=np.float64)
    squares = sum(float(((descriptors[rows] - mean) ** 2).sum()) for rows in blocks(len(descriptors), 30_000))
    return squares / len(descriptors)


def combine_guidance(guidances: list[tuple[float, DescriptorGuidance | None]]) -> DescriptorGuidance | None:
    """Return one guidance of several with weights; ``None`` where there is none.

    Parameters
    ----------
    guidances : list of (float, DescriptorGuidance or None)
        The combined guidance has the unit of the first.
    """
    scaled = [(weight, guidance) for weight, guidance in guidances if guidance is not None and weight > 0]
    if not scaled:
        return None
    scaled = [(np.sqrt(weight / scaled[0][0]), guidance) for weight, guidance in scaled]
    return DescriptorGuidance(
        np.hstack([scale * guidance.source for scale, guidance in scaled]),
        np.hstack([scale * guidance.target for scale, guidance in scaled]),
    )
