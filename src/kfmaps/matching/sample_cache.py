"""What is the same for all maps that are judged on one probe: worked out once, and in single precision."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, to_numpy
from kfmaps.fmap.descriptor_guidance import descriptor_variance
from kfmaps.matching.extremities import Extremities
from kfmaps.matching.score import SCORE


@dataclass(frozen=True, eq=False)
class Rows:
    """Descriptors ``(q, d)``, their squared lengths ``(q,)`` and :func:`descriptor_variance`."""

    values: np.ndarray
    squares: np.ndarray
    spread: float

    @classmethod
    def of(cls, descriptors: np.ndarray, precision: type = np.float32) -> Rows:
        values = np.asarray(descriptors, dtype=precision)
        return cls(values, np.einsum("ij,ij->i", values, values), descriptor_variance(descriptors))


@dataclass(frozen=True, eq=False)
class Known:
    """Of one probe: what all maps are judged with; made by :func:`known`.

    Attributes
    ----------
    functions : (q, k) float32
    areas : (q,) float64
        Of sum 1.
    ends : (q,) float64
        Areas of those within ``extremity_radius`` of a tip, of sum 1, else 0; ``None`` without tips.
    mean : float
        Of all distances.
    short : (p,) int64
        Which of the flattened distances are short: those up to ``local_radius``; with few points, to the nearest.
    short_mean : float
    orientation : float
        Norm of the operators; 0 where there are none.
    descriptors, heat : Rows
    """

    functions: np.ndarray
    areas: np.ndarray
    ends: np.ndarray | None
    mean: float
    short: np.ndarray
    short_mean: float
    orientation: float
    descriptors: Rows | None
    heat: Rows


def known(
    functions: Array,
    areas: np.ndarray,
    distances: np.ndarray,
    orientation: np.ndarray | None,
    descriptors: np.ndarray | None,
    heat: np.ndarray,
    tips: Extremities,
) -> Known:
    """Of the arrays of a :class:`kfmaps.matching.quality.ShapeSamples`."""
    nearest_other = np.partition(distances, 1, axis=1)[:, 1] if len(distances) > 1 else np.ones(1)
    short = np.flatnonzero(distances <= max(SCORE.local_radius, float(nearest_other.max())))
    return Known(
        np.asarray(to_numpy(functions), dtype=np.float32),
        areas,
        _ends(areas, tips),
        float(distances.mean()),
        short,
        float(distances.ravel()[short].mean()),
        0.0 if orientation is None else float(np.linalg.norm(orientation)),
        None if descriptors is None else Rows.of(descriptors),
        Rows.of(heat, np.float64),
    )


def _ends(areas: np.ndarray, tips: Extremities) -> np.ndarray | None:
    if len(tips.distances) == 0:
        return None
    near = np.where(tips.unit * tips.distances.min(axis=0) < SCORE.extremity_radius, areas, 0.0)
    return near / near.sum() if near.any() else None
