"""ZoomOut: turn a functional map into points and back while the basis grows (Melzi et al. 2019).

:class:`ZoomOut` refines one map, on all points or on samples, :meth:`ZoomOut.bidirectional` both maps of a pair, and
:func:`batched_zoomout` many maps on few samples. The steps are the same: each target point takes the nearest image of a
source point, and of these points comes the map of the next size, on samples by damped least squares.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kfmaps._arrays import Array, namespace, refuse, take, to_numpy
from kfmaps._progress import StageProgress
from kfmaps._records import check_record, setting, settings_record
from kfmaps._threads import parallel
from kfmaps.fmap.approximate_nearest import N_PROBE, N_PROBE_FAST
from kfmaps.fmap.convert import to_functional, to_points
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.fmap.refine import Refined
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.sampling import SampledBasis, stratified_samples, stratified_vertices

MAX_CANDIDATES, _CANDIDATES_PER_SAMPLE = 8_000, 2
"""Source points that steps on samples choose from, at most: in all, and for each sample of the target."""
MAX_EXACT_PAIRS = 2_000_000
"""Pairs of points above which steps on samples search approximately."""
_RIDGE = 0.1  # damping of the least squares on samples, in units of their areas' sum
_PAIRS_PER_BATCH = 1_000_000
"""Pairs of points of the maps refined together by :func:`batched_zoomout`: score matrices that stay in the cache."""


@dataclass(frozen=True, eq=False)
class _Points:
    """A basis at some ``vertices (q,)`` of a shape; at all of them where that is ``None``."""

    basis: Basis
    vertices: np.ndarray | None = None


@settings_record
class ZoomOut:
    """Point map and functional map in turn while the basis grows (Melzi et al. 2019).

    A functional map larger than ``start`` is truncated to it, a smaller one starts at its own size. Where there are
    more than ``samples`` points of the target, the steps before the last work on so many: the functional map is fitted
    to them by damped least squares, each weighted by the area that is closest to it, and of a source with more than
    twice as many points, or :data:`MAX_CANDIDATES`, that many are there to be chosen. The map returned is that of the
    last points, which are all.

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
        progress: StageProgress | None = None,
        points: np.ndarray | None = None,
        guide: DescriptorGuidance | None = None,
    ) -> Refined:
        sizes = self._sizes(C, source, target)
        first = sizes[0]
        few_t, few_s = self._samples(target), _Points(source)
        sampled = few_t.vertices is not None
        if sampled:
            few_s = self._candidates(source)
        if tuple(C.shape) != (first, first) or sampled or (guide is not None and self.descriptor_weight):
            points = None
        # What an approximate search misses on samples is found by the steps that follow.
        search = _approximate(few_s, few_t) if sampled else {"probes": N_PROBE_FAST}
        all_s, all_t = _Points(source), _Points(target)
        C = C[:first, :first]
        for i, larger in enumerate(sizes[1:]):
            if points is None:
                points = self._nearest(C, few_s, few_t, guide, **search)
            C, points = fit_functional_map(points, few_s.basis, few_t.basis, larger), None
            if progress is not None:
                progress((i + 1) / len(sizes))
        if points is None:
            points = self._nearest(C, all_s, all_t, guide, probes=N_PROBE_FAST if sampled else N_PROBE)
        if sampled:
            C = fit_functional_map(points, source, target, self.stop)
        if progress is not None:
            progress(1.0)
        return Refined(C, points, tuple(sizes))

    def bidirectional(
        self,
        C: Array,
        back: Array,
        source: Basis,
        target: Basis,
        progress: StageProgress | None = None,
        guide: DescriptorGuidance | None = None,
    ) -> tuple[Refined, Refined]:
        """Refine the maps of both directions, each held close to the adjoint of the other.

        The mean of the map forth and the adjoint of the map back is the next map, its adjoint the next map back (Ren et
        al., Continuous and orientation-preserving correspondences via functional maps, 2018, couple the two likewise;
        the mean is ours). Swapping the shapes and the maps swaps the answers.

        ``C (k_t, k_s)`` and ``back (k_s, k_t)``; ``progress`` and ``guide`` as in :meth:`__call__`.

        Raises
        ------
        InvalidInput
            When there are fewer eigenfunctions than ``stop``, or ``back`` does not go the other way.
        """
        sizes = self._sizes(C, source, target)
        if tuple(back.shape) != (C.shape[1], C.shape[0]):
            wanted = f"shape {(C.shape[1], C.shape[0])}"
            raise refuse("map back", wanted, f"shape {tuple(back.shape)}", "give the map from target to source")
        guide_back = guide and guide.swapped()
        few_s, few_t = self._samples(source), self._samples(target)
        from_s, from_t = (
            few if few.vertices is None else self._candidates(side) for few, side in ((few_s, source), (few_t, target))
        )
        first = sizes[0]
        C = 0.5 * (C[:first, :first] + back[:first, :first].T)
        for i, larger in enumerate(sizes[1:]):
            points = self._nearest(C, from_s, few_t, guide)
            forth = fit_functional_map(points, from_s.basis, few_t.basis, larger)
            points = self._nearest(C.T, from_t, few_s, guide_back)
            C = 0.5 * (forth + fit_functional_map(points, from_t.basis, few_s.basis, larger).T)
            if progress is not None:
                progress((i + 1) / len(sizes))
        all_s, all_t = _Points(source), _Points(target)
        found = (
            Refined(C, self._nearest(C, all_s, all_t, guide), tuple(sizes)),
            Refined(C.T, self._nearest(C.T, all_t, all_s, guide_back), tuple(sizes)),
        )
        if progress is not None:
            progress(1.0)
        return found

    def _sizes(self, C: Array, source: Basis, target: Basis) -> list[int]:
        """Sizes of the map at the steps, the first at most that of ``C``."""
        available = min(source.functions.shape[1], target.functions.shape[1])
        if self.stop > available:
            remedy = "compute more eigenfunctions or lower stop"
            raise refuse("ZoomOut stop", f"at most the {available} eigenfunctions at hand", str(self.stop), remedy)
        return [*range(min(self.start, *C.shape), self.stop, self.step), self.stop]

    def _samples(self, basis: Basis) -> _Points:
        """The points that a step finds images for."""
        if self.samples is None or self.samples >= basis.functions.shape[0]:
            return _Points(basis)
        found = stratified_samples(basis, self.samples, self.seed)
        return _Points(found.basis, found.vertices)

    def _candidates(self, basis: Basis) -> _Points:
        """The points that a step on samples chooses images from."""
        assert self.samples is not None
        count = min(MAX_CANDIDATES, _CANDIDATES_PER_SAMPLE * self.samples)
        if basis.functions.shape[0] <= count:
            return _Points(basis)
        vertices = stratified_vertices(basis, count, self.seed)
        rows = take(basis.functions, vertices), take(basis.mass, vertices)
        return _Points(SampledBasis(basis.eigenvalues, *rows), vertices)

    def _nearest(
        self,
        C: Array,
        source: _Points,
        target: _Points,
        guide: DescriptorGuidance | None,
        **search: Any,
    ) -> np.ndarray:
        """A point of ``source`` for each of ``target``."""
        columns = None
        if guide is not None and self.descriptor_weight:
            some = guide.at(source.vertices, target.vertices)
            columns = some.embedding_columns(self.descriptor_weight, source.basis, target.basis)
        return to_points(C, source.basis, target.basis, columns, **search)


def _approximate(source: _Points, target: _Points) -> dict[str, Any]:
    """Options of a search between so many points whose answer need not be quite the nearest."""
    pairs = source.basis.functions.shape[0] * target.basis.functions.shape[0]
    return {"exact": False if pairs > MAX_EXACT_PAIRS else None, "probes": N_PROBE_FAST}


def fit_functional_map(points: np.ndarray, source: Basis, target: Basis, k: int, ridge: float = _RIDGE) -> Array:
    """Return the functional map ``(k, k)`` of a point map, on all points of ``target`` or on samples of it.

    On all points the basis is orthonormal and the map is the projection ``Φ_tᵀ A_t Φ_s[points]``. Samples are not
    quite, so the map is theirs by least squares. Undamped that follows the noise of the points when they are few for k;
    plain projection leaves the error of the quadrature: ``ridge`` stands between, and is undone in the size.

    ``points (n_t,)``: rows of ``source`` for those of ``target``.
    """
    if not isinstance(target, SampledBasis):
        return to_functional(points, source.truncate(k), target.truncate(k))
    return _damped_solve(target, k, lambda weighted: weighted @ take(source.functions[:, :k], points), ridge)


def _damped_solve(basis: Basis, k: int, right: Callable[[Array], Array], ridge: float = _RIDGE) -> Array:
    """``(1 + ridge) (ΦᵀAΦ + ridge)⁻¹ right(ΦᵀA)`` on samples."""
    xp = namespace(basis.functions)
    phi = basis.functions[:, :k]
    weighted = (basis.mass[:, None] * phi).T
    identity = xp.eye(k, dtype=phi.dtype, device=phi.device)
    return (1 + ridge) * xp.linalg.solve(weighted @ phi + ridge * identity, right(weighted))


def pseudo_inverse(basis: SampledBasis, k: int) -> np.ndarray:
    """Return the matrix ``(k, q)`` float32 from values at samples to coefficients, by damped least squares."""
    return np.asarray(to_numpy(_damped_solve(basis, k, lambda weighted: weighted)), dtype=np.float32)


def batched_zoomout(
    maps: np.ndarray,
    source: SampledBasis,
    target: SampledBasis,
    sizes: tuple[int, ...],
    cost: np.ndarray | None = None,
    solvers: Callable[[int], np.ndarray] | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Refine ``maps (m, k, k)`` on samples in single precision; return them and a source sample for each target sample.

    The maps returned have the last of the ``sizes``, which grow from at most k; of the given ones the leading blocks of
    the first size count. ``source`` and ``target``: q_s and q_t samples of unit area. ``cost``: half the squared
    differences of descriptors, (q_t, q_s) or (m, q_t, q_s), up to a constant for each target sample
    (:func:`kfmaps.matching.sample_pair.descriptor_cost`). ``solvers``: :func:`pseudo_inverse` of the target for k
    functions, where many refinements share them.
    """
    phi_s = np.asarray(to_numpy(source.functions)[:, : sizes[-1]], dtype=np.float32)
    phi_t = np.asarray(to_numpy(target.functions)[:, : sizes[-1]], dtype=np.float32)
    solver = solvers or (lambda k: pseudo_inverse(target, k))
    steps = [(k, solver(k)) for k in sizes[1:]]
    count = max(1, _PAIRS_PER_BATCH // (len(phi_s) * len(phi_t)))

    def refine(first: int) -> tuple[np.ndarray, np.ndarray]:
        some = slice(first, first + count)
        own_cost = cost[some] if cost is not None and cost.ndim == 3 else cost
        C = np.asarray(maps[some, : sizes[0], : sizes[0]], dtype=np.float32)
        for larger, inverse in steps:
            C = inverse @ phi_s[:, :larger][nearest_samples(C, phi_s, phi_t, own_cost)]
        return np.asarray(C, dtype=np.float64), nearest_samples(C, phi_s, phi_t, own_cost)

    found = parallel(refine, range(0, len(maps), count))
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


def nearest_samples(C: np.ndarray, phi_s: np.ndarray, phi_t: np.ndarray, cost: np.ndarray | None = None) -> np.ndarray:
    """Return the nearest image of a source sample for each target sample, (m, q_t).

    ``C (m, k, k)`` float32; ``phi_s (q_s, k')`` and ``phi_t (q_t, k')`` float32: functions at the samples, at least k;
    ``cost``: see :func:`batched_zoomout`.
    """
    k = C.shape[1]
    # One column more holds half the squared length, so that the product is the whole score.
    images = np.empty((len(C), len(phi_s), k + 1), dtype=np.float32)
    images[:, :, :k] = phi_s[:, :k] @ C.transpose(0, 2, 1)
    images[:, :, k] = -0.5 * np.einsum("mik,mik->mi", images[:, :, :k], images[:, :, :k])
    rows = np.ones((len(phi_t), k + 1), dtype=np.float32)
    rows[:, :k] = phi_t[:, :k]
    score = rows @ images.transpose(0, 2, 1)
    if cost is not None:
        score -= cost
    return score.argmax(axis=2)
