"""The interface of refinements, and ICP; :mod:`kfmaps.fmap.zoomout` is the other refinement.

Refinements are frozen settings, callable as ``(C, source, target) -> Refined``. ``points``, where given, is the point
map of ``C`` itself (:func:`kfmaps.fmap.convert.to_points`), which then need not be computed again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from kfmaps._arrays import Array, namespace, refuse
from kfmaps._progress import StageProgress
from kfmaps._records import setting, settings_record
from kfmaps.fmap.convert import to_functional, to_points
from kfmaps.geometry.basis import Basis


@dataclass(frozen=True, eq=False)
class Refined:
    """The result of a refinement."""

    functional_map: Array  # (k_t, k_s)
    target_to_source: np.ndarray  # (n_t,)
    history: tuple[int, ...]  # basis size at each step (ZoomOut), or the number of points that changed (ICP)


class Refinement(Protocol):
    """A callable that improves a functional map and its point map.

    Three attributes are used where it has them: ``n_eigenfunctions``, which both shapes need; ``descriptor_weight``,
    above 0 where it wants descriptors as the argument ``guidance``; and ``limited(n)``, which returns the same with at
    most n eigenfunctions, for shapes that differ much or have few vertices.
    """

    def __call__(
        self,
        C: Array,
        source: Basis,
        target: Basis,
        progress: StageProgress | None = None,
        points: np.ndarray | None = None,
    ) -> Refined: ...


@settings_record
class ICP:
    """Convert to points, fit a map to them, take the nearest orthogonal matrix; ``steps`` times.

    It needs a square map and stops early when no point changes (Ovsjanikov et al. 2012). Where the images are too few
    to determine the map, the matrix is a partial isometry.

    Examples
    --------
    >>> kfmaps.Config(refinement=kfmaps.ICP(steps=10)).refinement
    ICP(steps=10)
    """

    steps: int = setting(5, "steps of ICP", low=1)

    def __call__(
        self,
        C: Array,
        source: Basis,
        target: Basis,
        progress: StageProgress | None = None,
        points: np.ndarray | None = None,
    ) -> Refined:
        k_t, k_s = C.shape
        if k_t != k_s:
            raise refuse("ICP", "a square functional map", f"{k_t} by {k_s}", "use equal basis sizes, or ZoomOut")
        xp = namespace(C)
        source, target = source.truncate(k_s), target.truncate(k_t)
        points = to_points(C, source, target) if points is None else points
        changes: list[int] = []
        for step in range(self.steps):
            u, sizes, vh = xp.linalg.svd(to_functional(points, source, target), full_matrices=False)
            # Directions that the points do not determine would be rotated at random, by rounding.
            C = (u * xp.astype(sizes > 1e-12 * sizes[0], C.dtype)[None, :]) @ vh
            previous, points = points, to_points(C, source, target)
            changes.append(int(np.count_nonzero(points != previous)))
            if progress is not None:
                progress((step + 1) / self.steps)
            if changes[-1] == 0:
                break
        return Refined(C, points, tuple(changes))
