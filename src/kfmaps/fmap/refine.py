"""Refinements: frozen settings, callable as ``(C, source, target) -> Refined``.

``points``, where given, is the point map of ``C`` itself (:func:`kfmaps.fmap.convert.to_points`), which then
need not be found again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from kfmaps._arrays import Array, namespace, refuse, take
from kfmaps._progress import Done
from kfmaps._records import check_record, setting, settings_record
from kfmaps.fmap.approximate_nearest import N_PROBE_FAST
from kfmaps.fmap.convert import to_functional, to_points
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.sampling import (
    SampledBasis,
    SpectralSamples,
    spectral_samples,
    stratified_samples,
    stratified_vertices,
)

__all__ = [
    "ICP",
    "Refined",
    "Refinement",
    "SampledBasis",
    "SpectralSamples",
    "ZoomOut",
    "fit_functional_map",
    "spectral_samples",
]

CANDIDATES_PER_CALL, EACH = 8_000, 2
"""Points of the source that ZoomOut's steps on samples choose from, spread evenly, at most: so many in all, and so many
for each sample. The last step has them all."""
PAIRS = 2_000_000
"""Pairs of points above which steps on samples search by cells."""


@dataclass(frozen=True, eq=False)
class Refined:
    """What a refinement returns.

    Attributes
    ----------
    functional_map : (k_t, k_s)
    target_to_source : (n_t,) int64
    history : tuple of int
        Basis size at each step (ZoomOut), or the number of points that changed (ICP).
    """

    functional_map: Array
    target_to_source: np.ndarray
    history: tuple[int, ...]


class Refinement(Protocol):
    """What improves a functional map and its point map: a record of this module or any callable of this signature.

    Three attributes are used where it has them: ``n_eigenfunctions`` that both shapes need, ``descriptor_weight``
    above 0, which asks for descriptors as the argument ``guide``, and ``limited(n)``, the same with at most n
    eigenfunctions, for shapes that differ much.
    """

    def __call__(
        self,
        C: Array,
        source: Basis,
        target: Basis,
        progress: Done | None = None,
        threads: int | None = None,
        points: np.ndarray | None = None,
    ) -> Refined: ...


@settings_record
class ICP:
    """Match, fit, take the nearest orthogonal matrix; ``steps`` times (Ovsjanikov et al. 2012).

    Needs a square map; stops early when no point changes. Of a point map that reaches too few vertices to say
    where every function goes, the matrix is a partial isometry.
    """

    steps: int = setting(5, "steps of ICP", low=1)

    def __call__(
        self,
        C: Array,
        source: Basis,
        target: Basis,
        progress: Done | None = None,
        threads: int | None = None,
        points: np.ndarray | None = None,
    ) -> Refined:
        k_t, k_s = C.shape
        if k_t != k_s:
            raise refuse("ICP", "a square functional map", f"{k_t} by {k_s}", "use equal basis sizes, or ZoomOut")
        xp = namespace(C)
        source, target = source.truncate(k_s), target.truncate(k_t)
        points = to_points(C, source, target, threads) if points is None else points
        changes: list[int] = []
        for step in range(self.steps):
            u, sizes, vh = xp.linalg.svd(to_functional(points, source, target), full_matrices=False)
            # Directions that the points say nothing of would be turned at random, by rounding.
            C = (u * xp.astype(sizes > 1e-12 * sizes[0], C.dtype)[None, :]) @ vh
            moved = to_points(C, source, target, threads)
            changes.append(int(np.count_nonzero(moved != points)))
            points = moved
            if progress is not None:
                progress((step + 1) / self.steps)
            if changes[-1] == 0:
                break
        return Refined(C, points, tuple(changes))


@settings_record
class ZoomOut:
    """Point map and functional map in turn while the basis grows (Melzi et al. 2019).

    A functional map larger than ``start`` is truncated to it, a smaller one starts at its own size. Where there are
    more than ``samples`` points of the target, the steps before the last work on so many: the functional map is fitted
    to them by damped least squares, each weighted by the area that is closest to it, and of a source with more than
    :data:`EACH` times as many points, or :data:`CANDIDATES_PER_CALL`, that many are there to be chosen.

    ``descriptor_weight`` is the mean squared difference of two random points, which in k functions is about 2 k, and
    has an effect only where :meth:`__call__` is given descriptors; 0 is ZoomOut as published.
    """

    start: int = setting(20, "first size of ZoomOut", low=2)
    stop: int = setting(150, "last size of ZoomOut; both bases need as many functions", low=2)
    step: int = setting(5, "growth per step of ZoomOut", low=1)
    samples: int | None = setting(
        None, "points of the target that all steps of ZoomOut but the last work on", low=2, none="all"
    )
    seed: int = setting(0, "seed of the choice of these points; that of the match is added", low=0)
    descriptor_weight: float = setting(0.0, "weight of SHOT in the search for the nearest point", low=0)

    def __post_init__(self) -> None:
        check_record(self)
        if self.stop < self.start:
            raise refuse(
                "ZoomOut.stop", f"at least {self.start}, the start", str(self.stop), "raise stop or lower start"
            )

    @property
    def n_eigenfunctions(self) -> int:
        """How many eigenfunctions both shapes need."""
        return self.stop

    def limited(self, n: int) -> ZoomOut:
        """Return the same with at most ``n`` eigenfunctions at the end, in steps of at most 10."""
        stop = min(self.stop, n)
        return replace(self, stop=stop, start=min(self.start, stop), step=min(self.step, 10))

    def __call__(
        self,
        C: Array,
        source: Basis,
        target: Basis,
        progress: Done | None = None,
        threads: int | None = None,
        points: np.ndarray | None = None,
        guide: DescriptorGuidance | None = None,
    ) -> Refined:
        available = min(source.functions.shape[1], target.functions.shape[1])
        if self.stop > available:
            remedy = "compute more eigenfunctions or lower stop"
            raise refuse("ZoomOut stop", f"at most the {available} eigenfunctions at hand", str(self.stop), remedy)
        first = min(self.start, *C.shape)
        guide = guide if self.descriptor_weight else None
        if tuple(C.shape) != (first, first) or guide is not None:
            points = None
        C = C[:first, :first]
        sizes = [*range(first, self.stop, self.step), self.stop]
        coarse, choice = target, source
        few = guide
        if self.samples is not None and self.samples < target.functions.shape[0]:
            sampled = stratified_samples(target, self.samples, self.seed)
            coarse, few = sampled.basis, guide and guide.at(None, sampled.vertices)
            if source.functions.shape[0] > sample_candidates(self.samples):
                rows = stratified_vertices(source, sample_candidates(self.samples), self.seed)
                choice = SampledBasis(source.eigenvalues, take(source.functions, rows), take(source.mass, rows))
                few = few and few.at(rows, None)
            points = None

        def matched(
            C: Array,
            source: Basis,
            target: Basis,
            guide: DescriptorGuidance | None,
            exact: bool | None = None,
            **search: Any,
        ) -> np.ndarray:
            beside = None if guide is None else guide.embedding_columns(self.descriptor_weight, source, target)
            return to_points(C, source, target, threads, beside, exact, **search)

        # On samples the next step forgives a point in a thousand that is not quite the nearest.
        exact = (
            False if choice.functions.shape[0] * coarse.functions.shape[0] > PAIRS and coarse is not target else None
        )
        for i, larger in enumerate(sizes[1:]):
            found = matched(C, choice, coarse, few, exact, probes=N_PROBE_FAST) if points is None else points
            C, points = fit_functional_map(found, choice, coarse, larger), None
            if progress is not None:
                progress((i + 1) / len(sizes))
        if points is None:
            # What a quick search by cells misses is found by the one that follows.
            quick = coarse is not target and target.functions.shape[0] * source.functions.shape[0] > PAIRS
            points = matched(C, source, target, guide, **({"exact": False, "probes": N_PROBE_FAST} if quick else {}))
        if coarse is not target:
            # Once more with all points, whose functional map owes nothing to the choice of samples.
            C = fit_functional_map(points, source, target, self.stop)
            points = matched(C, source, target, guide, start=points)
        if progress is not None:
            progress(1.0)
        return Refined(C, points, tuple(sizes))


def sample_candidates(samples: int) -> int:
    """Points of the source that steps on so many ``samples`` choose from."""
    return min(CANDIDATES_PER_CALL, EACH * samples)


def fit_functional_map(points: np.ndarray, source: Basis, target: Basis, k: int, ridge: float = 0.1) -> Array:
    """The functional map ``(k, k)`` of a point map, on all points of ``target`` or on samples of it.

    On all points the basis is orthonormal and the map is the projection ``Φ_tᵀ A_t Φ_s[points]``. Samples are not
    quite, so the map is theirs by least squares. Undamped that follows the noise of the points when they are few
    for k; plain projection leaves the error of the quadrature: ``ridge`` stands between, and is undone in the size.
    """
    if not isinstance(target, SampledBasis):
        return to_functional(points, source.truncate(k), target.truncate(k))
    xp = namespace(target.functions)
    phi = target.functions[:, :k]
    weighted = (target.mass[:, None] * phi).T
    identity = xp.eye(k, dtype=phi.dtype, device=phi.device)
    pulled = take(source.functions[:, :k], points)
    return (1 + ridge) * xp.linalg.solve(weighted @ phi + ridge * identity, weighted @ pulled)
