"""Consistent ZoomOut: maps of a collection refined together, so that they go on agreeing over cycles.

Points are sought in the common latent space instead of pair by pair, with more and more functions (Huang, Ren, Wonka
and Ovsjanikov, Consistent ZoomOut: efficient spectral map synchronization, 2020).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import check_count, refuse, to_numpy
from kfmaps.collection.synchronization import Choice, Link, agree, orthogonal
from kfmaps.fmap.convert import nearest, to_functional
from kfmaps.geometry.basis import Basis


@dataclass(frozen=True)
class ConsistentZoomOut:
    """From ``start`` functions to ``stop`` in steps of ``step``; all in the latent space."""

    start: int = 20
    stop: int = 60
    step: int = 5

    def __post_init__(self) -> None:
        check_count(self.start, "start", 2)
        check_count(self.step, "step", 1)
        if self.stop < self.start:
            raise refuse("stop", f"{self.start} functions or more", str(self.stop), "choose a larger one")

    def __call__(
        self, bases: Sequence[Basis], ends: Sequence[tuple[int, int]], points: Sequence[np.ndarray]
    ) -> tuple[list[np.ndarray], np.ndarray]:
        """Refine ``points``, of each of the pairs ``ends`` a source vertex for each target vertex (or sample).

        Returns
        -------
        list of (n_t,) int64
            In the same order.
        (n, k, k) float64
            The latent maps at the end.
        """
        points, latent = [np.asarray(p) for p in points], np.zeros((0, 0, 0))
        sizes = [*range(self.start, self.stop, self.step), self.stop]
        for size in sizes:
            few = [basis.truncated(size) for basis in bases]
            maps = [to_numpy(to_functional(p, few[s], few[t])) for p, (s, t) in zip(points, ends, strict=True)]
            links = [Link(s, t, (Choice(C),)) for C, (s, t) in zip(maps, ends, strict=True)]
            latent = agree(len(bases), links, size).latent
            images = [to_numpy(basis.functions) @ Y for basis, Y in zip(few, latent, strict=True)]
            points = [nearest(images[t], images[s], threads=1) for s, t in ends]
        return points, latent


def through_latent(latent: np.ndarray, source: int, target: int) -> np.ndarray:
    """The map ``Y_t Y_sᵀ (k, k)`` of any pair of a collection, matched or not; it agrees with all others."""
    return orthogonal(latent[target] @ latent[source].T)
