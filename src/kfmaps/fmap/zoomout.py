"""ZoomOut: turn a functional map into points and back while the basis grows (Melzi et al. 2019).

:class:`ZoomOut` refines one map, on all points or on samples, :meth:`ZoomOut.bidirectional` both maps of a pair, and
:func:`batched_zoomout` many maps on few samples. The steps are the same: each target point takes the nearest image of a
source point, and the next, larger map is fitted to these points, on samples by damped least squares.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kfmaps._arrays import Array, blocks, namespace, refuse, take, to_numpy
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
"""Most candidates, source points whose images are searched in steps on samples: in all, and per target sample."""
MAX_EXACT_PAIRS = 2_000_000
"""Pairs of points above which steps on samples search approximately."""
_RIDGE = 0.1  # damping of least squares on samples, in units of the sum of their areas


@dataclass(frozen=True, eq=False)
class _Points:
    """A basis at some ``vertices (q,)`` of a shape; ``None`` is all of them."""

    basis: Basis
    vertices: np.ndarray | None = None


@settings_record
class ZoomOut:
    """Point map and functional map in turn while the basis grows (Melzi et al. 2019).

    A functional map larger than ``start`` is truncated to it, a smaller one starts at its own size. Where the target
    has more than ``samples`` points, all steps but the last work on samples of it. The functional map is fitted to them
    by damped least squares, weighted by the areas closest to them. Their images are searched among at most twice as
    many samples of the source, or :data:`MAX_CANDIDATES`. The last step works on all points.

    ``descriptor_weight`` is the mean squared difference of the descriptors of two random points, beside which that of k
    functions is about 2 k. It has an effect only where :meth:`__call__` is given descriptors; 0 is ZoomOut as
    published.

    Examples
    --------
    >>> kfmaps.Config(refinement=kfmaps.ZoomOut(start=30, stop=120)).refinement
    ZoomOut(start=30, stop=120)
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
        guidance: DescriptorGuidance | None = None,
    ) -> Refined:
        sizes = self._sizes(C, source, target)
        first = sizes[0]
        all_s, all_t = _Points(source), _Points(target)
        samples_t = self._samples(target)
        sampled = samples_t.vertices is not None
        samples_s = self._candidates(source) if sampled else all_s
        if tuple(C.shape) != (first, first) or sampled or (guidance is not None and self.descriptor_weight):
            points = None
        # Later steps repair what an approximate search on samples misses.
        search = _approximate_search(samples_s, samples_t) if sampled else {"n_probe": N_PROBE_FAST}
        C = C[:first, :first]
        for i, larger in enumerate(sizes[1:]):
            if points is None:
                points = self._nearest(C, samples_s, samples_t, guidance, **search)
            C, points = fit_functional_map(points, samples_s.basis, samples_t.basis, larger), None
            if progress is not None:
                progress((i + 1) / len(sizes))
        if points is None:
            points = self._nearest(C, all_s, all_t, guidance, n_probe=N_PROBE_FAST if sampled else N_PROBE)
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
        guidance: DescriptorGuidance | None = None,
    ) -> tuple[Refined, Refined]:
        """Refine the maps of both directions, each the adjoint of the other.

        In each step the mean of the new map and the adjoint of the new map back replaces the map, and its adjoint the
        map back. Ren et al. (Continuous and orientation-preserving correspondences via functional maps, 2018) couple
        the two similarly; the mean is ours. Swapping the shapes and the maps swaps the results.

        ``C (k_t, k_s)`` and ``back (k_s, k_t)``; ``progress`` and ``guidance`` as in :meth:`__call__`.

        Raises
        ------
        InvalidInput
            When there are fewer eigenfunctions than ``stop``, or ``back`` does not go the other way.
        """
        sizes = self._sizes(C, source, target)
        if tuple(back.shape) != (C.shape[1], C.shape[0]):
            wanted = f"shape {(C.shape[1], C.shape[0])}"
            raise refuse("map back", wanted, f"shape {tuple(back.shape)}", "give the map from target to source")
        guidance_back = guidance and guidance.swapped()
        samples_s, samples_t = self._samples(source), self._samples(target)
        candidates_s = samples_s if samples_s.vertices is None else self._candidates(source)
        candidates_t = samples_t if samples_t.vertices is None else self._candidates(target)
        first = sizes[0]
        C = 0.5 * (C[:first, :first] + back[:first, :first].T)
        for i, larger in enumerate(sizes[1:]):
            points = self._nearest(C, candidates_s, samples_t, guidance)
            forward = fit_functional_map(points, candidates_s.basis, samples_t.basis, larger)
            points = self._nearest(C.T, candidates_t, samples_s, guidance_back)
            C = 0.5 * (forward + fit_functional_map(points, candidates_t.basis, samples_s.basis, larger).T)
            if progress is not None:
                progress((i + 1) / len(sizes))
        all_s, all_t = _Points(source), _Points(target)
        refined = (
            Refined(C, self._nearest(C, all_s, all_t, guidance), tuple(sizes)),
            Refined(C.T, self._nearest(C.T, all_t, all_s, guidance_back), tuple(sizes)),
        )
        if progress is not None:
            progress(1.0)
        return refined

    def _sizes(self, C: Array, source: Basis, target: Basis) -> list[int]:
        """Return the sizes of the map at the steps, the first at most that of ``C``."""
        available = min(source.functions.shape[1], target.functions.shape[1])
        if self.stop > available:
            remedy = "compute more eigenfunctions or lower stop"
            raise refuse("ZoomOut stop", f"at most the {available} eigenfunctions at hand", str(self.stop), remedy)
        return [*range(min(self.start, *C.shape), self.stop, self.step), self.stop]

    def _samples(self, basis: Basis) -> _Points:
        """Return the points that a step searches images for."""
        if self.samples is None or self.samples >= basis.functions.shape[0]:
            return _Points(basis)
        samples = stratified_samples(basis, self.samples, self.seed)
        return _Points(samples.basis, samples.vertices)

    def _candidates(self, basis: Basis) -> _Points:
        """Return the points whose images a step on samples searches."""
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
        guidance: DescriptorGuidance | None,
        **search: Any,
    ) -> np.ndarray:
        """Return the nearest point of ``source`` for each of ``target``."""
        columns = None
        if guidance is not None and self.descriptor_weight:
            guidance = guidance.at(source.vertices, target.vertices)
            columns = guidance.embedding_columns(self.descriptor_weight, source.basis, target.basis)
        return to_points(C, source.basis, target.basis, columns, **search)


def _approximate_search(source: _Points, target: _Points) -> dict[str, Any]:
    """Return the options of a fast search that is approximate between many points."""
    pairs = source.basis.functions.shape[0] * target.basis.functions.shape[0]
    return {"exact": False if pairs > MAX_EXACT_PAIRS else None, "n_probe": N_PROBE_FAST}


def fit_functional_map(points: np.ndarray, source: Basis, target: Basis, k: int, ridge: float = _RIDGE) -> Array:
    """Return the functional map ``(k, k)`` of a point map, on all points of ``target`` or on samples of it.

    On all points the basis is orthonormal and the map is the projection ``Φ_tᵀ A_t Φ_s[points]``. On samples it is not
    quite, and the map is fitted by least squares. Undamped, that follows the noise of few points, while projection has
    the error of the quadrature. ``ridge`` stands between the two, and the size is corrected for it.

    ``points (n_t,)``: rows of ``source`` for those of ``target``.
    """
    if not isinstance(target, SampledBasis):
        return to_functional(points, source.truncate(k), target.truncate(k))
    return _damped_solve(target, k, take(source.functions[:, :k], points), ridge)


def _damped_solve(basis: Basis, k: int, values: Array | None = None, ridge: float = _RIDGE) -> Array:
    """Return ``(1 + ridge) (ΦᵀAΦ + ridge)⁻¹ ΦᵀA values`` on samples, without ``values`` that of the identity."""
    xp = namespace(basis.functions)
    phi = basis.functions[:, :k]
    weighted = (basis.mass[:, None] * phi).T
    identity = xp.eye(k, dtype=phi.dtype, device=phi.device)
    right = weighted if values is None else weighted @ values
    return (1 + ridge) * xp.linalg.solve(weighted @ phi + ridge * identity, right)


def pseudo_inverse(basis: SampledBasis, k: int) -> np.ndarray:
    """Return the matrix ``(k, q)`` float32 from values at samples to coefficients, by damped least squares."""
    return np.asarray(to_numpy(_damped_solve(basis, k)), dtype=np.float32)


def batched_zoomout(
    maps: np.ndarray,
    source: SampledBasis,
    target: SampledBasis,
    sizes: tuple[int, ...],
    cost: np.ndarray | None = None,
    solvers: Callable[[int], np.ndarray] | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Refine ``maps (m, k, k)`` on samples in single precision; return them and a source sample for each target sample.

    ``sizes``: of the maps at the steps, ascending from at most k; maps are truncated to the first and returned at the
    last. ``source`` and ``target``: q_s and q_t samples of unit area. ``cost``: half the squared differences of
    descriptors, (q_t, q_s) or (m, q_t, q_s), up to a constant for each target sample
    (:func:`kfmaps.matching.sample_pair.descriptor_cost`). ``solvers``: cached :func:`pseudo_inverse` of the target for
    k functions.
    """
    phi_s = np.asarray(to_numpy(source.functions)[:, : sizes[-1]], dtype=np.float32)
    phi_t = np.asarray(to_numpy(target.functions)[:, : sizes[-1]], dtype=np.float32)
    solver = solvers or (lambda k: pseudo_inverse(target, k))
    steps = [(k, solver(k)) for k in sizes[1:]]
    pairs_per_batch = 1_000_000  # pairs of points, so that the score matrices of a batch stay in the cache
    count = max(1, pairs_per_batch // (len(phi_s) * len(phi_t)))

    def refine(batch: slice) -> tuple[np.ndarray, np.ndarray]:
        batch_cost = cost[batch] if cost is not None and cost.ndim == 3 else cost
        C = np.asarray(maps[batch, : sizes[0], : sizes[0]], dtype=np.float32)
        for larger, inverse in steps:
            C = inverse @ phi_s[:, :larger][nearest_samples(C, phi_s, phi_t, batch_cost)]
        return np.asarray(C, dtype=np.float64), nearest_samples(C, phi_s, phi_t, batch_cost)

    refined, points = zip(*parallel(refine, blocks(len(maps), count)), strict=True)
    return np.concatenate(refined), np.concatenate(points)


def nearest_samples(C: np.ndarray, phi_s: np.ndarray, phi_t: np.ndarray, cost: np.ndarray | None = None) -> np.ndarray:
    """Return the nearest image of a source sample for each target sample, (m, q_t).

    ``C (m, k, k)`` float32; ``phi_s (q_s, k')`` and ``phi_t (q_t, k')`` float32: functions at the samples, at least k;
    ``cost``: see :func:`batched_zoomout`.
    """
    k = C.shape[1]
    # One more column holds half the squared length, so that the product is ``x·y − ½|y|²``.
    images = np.empty((len(C), len(phi_s), k + 1), dtype=np.float32)
    images[:, :, :k] = phi_s[:, :k] @ C.transpose(0, 2, 1)
    images[:, :, k] = -0.5 * np.einsum("mik,mik->mi", images[:, :, :k], images[:, :, :k])
    rows = np.ones((len(phi_t), k + 1), dtype=np.float32)
    rows[:, :k] = phi_t[:, :k]
    score = rows @ images.transpose(0, 2, 1)
    if cost is not None:
        score -= cost
    return score.argmax(axis=2)
