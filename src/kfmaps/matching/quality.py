"""Samples of a shape that maps are scored on, and the measures of a map on them, without knowing the truth.

:func:`map_quality` measures a map on samples of both shapes; :mod:`kfmaps.matching.score` weighs the measures.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import Array, like, to_numpy
from kfmaps.descriptors.shot import mirror_shot
from kfmaps.descriptors.spectral import log_heat_signature
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.descriptor_guidance import FLAT, descriptor_variance
from kfmaps.geometry.basis import Basis, eigenvalue_tolerance
from kfmaps.geometry.coarsen import CoarseProxy, coarsen
from kfmaps.geometry.geodesic_graph import bridged_graph
from kfmaps.geometry.geodesics import pairwise_geodesics
from kfmaps.geometry.mesh import Mesh
from kfmaps.geometry.orientation_operators import orientation_operators
from kfmaps.geometry.sampling import SampledBasis, SpectralSamples, spectral_samples, stratified_vertices
from kfmaps.matching.extremities import Extremities, extremities
from kfmaps.matching.score import SCORE, Quality
from kfmaps.registration.evidence import shape_proxy
from kfmaps.shape import Shape

MAX_SURFACE_VERTICES = 6000
"""Vertices above which distances and orientation are computed on a coarse proxy with that many."""
N_ORIENTATION_OPERATORS = 10
"""Functions whose orientation operators are compared."""


@dataclass(frozen=True, eq=False)
class _DescriptorRows:
    """Descriptors ``(q, d)``, their squared lengths ``(q,)`` and their :func:`descriptor_variance`."""

    values: np.ndarray
    squares: np.ndarray
    variance: float

    @classmethod
    def of(cls, descriptors: np.ndarray, precision: type = np.float32) -> _DescriptorRows:
        values = np.asarray(descriptors, dtype=precision)
        return cls(values, np.einsum("ij,ij->i", values, values), descriptor_variance(descriptors))


@dataclass(frozen=True, eq=False)
class ShapeSamples:
    """Samples of one shape, and all that scoring maps needs of it; made by :func:`sample_for_scoring`."""

    samples: SpectralSamples  # farthest points; the first c of them are farthest points too
    distances: np.ndarray  # (c, c): geodesic distances between the first points
    # (w, k, k): orientation operators of the first functions, in the first functions; ``None`` for a point cloud.
    orientation: np.ndarray | None
    descriptors: np.ndarray | None  # (q, d): SHOT at the samples
    heat: np.ndarray  # (q, t): logarithm of the heat kernel signature at the samples, for fixed times
    positions: np.ndarray  # (q, 3)
    extremities: Extremities
    proxy: CoarseProxy | None  # ``None`` for a point cloud
    mirrored: bool = False  # whether the samples are of the mirror image
    # (m, k, k): self-maps (:func:`kfmaps.matching.self_maps.find_self_maps`) on the coarse samples, which are those of
    # the mirror image too; ``None`` where they have not been computed.
    self_maps: np.ndarray | None = None
    # (k, k): the map to its own mirror image (:func:`kfmaps.matching.self_maps.find_reflection`), where there is one.
    reflection_map: np.ndarray | None = None
    has_rotation: bool = False  # whether a self-map rotates the whole shape, as half a turn does a table

    @cached_property
    def functions(self) -> np.ndarray:
        """The basis at the samples, (q, k) float32."""
        return np.asarray(to_numpy(self.samples.basis.functions), dtype=np.float32)

    @cached_property
    def areas(self) -> np.ndarray:
        """Share of the area of each sample, (q,)."""
        return to_numpy(self.samples.basis.mass) / float(self.samples.basis.mass.sum())

    @cached_property
    def extremity_areas(self) -> np.ndarray | None:
        """The same of samples near extremities only, of sum 1; ``None`` without extremities."""
        extremities = self.extremities
        if len(extremities.distances) == 0:
            return None
        is_near = extremities.unit * extremities.distances.min(axis=0) < SCORE.extremity_radius
        near = np.where(is_near, self.areas, 0.0)
        return near / near.sum() if near.any() else None

    @cached_property
    def mean_distance(self) -> float:
        return float(self.distances.mean())

    @cached_property
    def short_distances(self) -> ShortDistances:
        """Distances up to :attr:`Scoring.local_radius`, or between nearest points where that is longer."""
        return ShortDistances.of(self.distances)

    @cached_property
    def reflection(self) -> np.ndarray | None:
        """The sample (q,) that is the mirror image of each sample on the shape itself; ``None`` where it is unknown."""
        C = self.reflection_map
        return None if C is None else nearest(self.functions[:, : len(C)], self.functions[:, : len(C)] @ C.T)

    @cached_property
    def reflected_extremities(self) -> np.ndarray | None:
        """The number (m,) of the extremity nearest to the reflected one of each; ``None`` without a reflection."""
        if self.reflection is None:
            return None
        return self.extremities.distances[:, self.reflection[self.extremities.points]].argmin(axis=0)

    @cached_property
    def orientation_norm(self) -> float:
        """Norm of the orientation operators; 0 where there are none."""
        return 0.0 if self.orientation is None else float(np.linalg.norm(self.orientation))

    @cached_property
    def descriptor_rows(self) -> _DescriptorRows | None:
        return None if self.descriptors is None else _DescriptorRows.of(self.descriptors)

    @cached_property
    def neighbor_difference(self) -> float:
        """The difference of SHOT between a sample and the nearest other one, in the unit of `Quality.descriptors`."""
        near = np.asarray(KDTree(self.positions).query(self.positions, k=2)[1])[:, 1]
        squares = _squares(near, self.descriptor_rows, self.descriptor_rows, FLAT)
        return 0.0 if squares is None else float(squares[0] @ self.areas / squares[1])

    @cached_property
    def heat_rows(self) -> _DescriptorRows:
        return _DescriptorRows.of(self.heat, np.float64)


@dataclass(frozen=True, eq=False)
class ShortDistances:
    """Where the flattened distances are short, ``at (p,)``, and their mean."""

    at: np.ndarray
    mean: float

    @classmethod
    def of(cls, distances: np.ndarray) -> ShortDistances:
        nearest_other = np.partition(distances, 1, axis=1)[:, 1] if len(distances) > 1 else np.ones(1)
        at = np.flatnonzero(distances <= max(SCORE.local_radius, float(nearest_other.max())))
        return cls(at, float(distances.ravel()[at].mean()))

    def relative_change(self, change: np.ndarray) -> float:
        """Return the mean ``change`` of the short distances, divided by their mean."""
        return float(change.ravel()[self.at].mean()) / self.mean if self.mean > 0 else 0.0


def sample_for_scoring(shape: Shape, count: int = 1000, rng: int | np.random.Generator = 0) -> ShapeSamples:
    """Sample ``count`` points of ``shape`` and compute what :func:`map_quality` compares."""
    samples = spectral_samples(shape.basis, count, rng)
    first = samples.vertices[:300]  # the first of them, between which geodesic distances are compared
    mesh, functions, rows = sample_surface(shape, samples.vertices)
    graph = bridged_graph(mesh)
    distances = pairwise_geodesics(graph, rows[: len(first)])
    # Components that do not touch are as far apart as the farthest points of one.
    is_finite = np.isfinite(distances)
    farthest = distances[is_finite].max() or float(np.linalg.norm(np.ptp(shape.mesh.vertices[first], axis=0)))
    distances = np.where(is_finite, distances, farthest)
    orientation = None
    if len(shape.mesh.faces):
        size = 50  # functions that the orientation operators are written in, as many as fits need
        low = Basis(shape.basis.eigenvalues, functions[:, :size], shape.basis.mass)
        orientation = orientation_operators(mesh, low, functions[:, : 4 * N_ORIENTATION_OPERATORS])
    return ShapeSamples(
        samples,
        distances,
        orientation,
        descriptors=None if shape.shot is None else shape.shot[samples.vertices],
        heat=log_heat_signature(samples.basis),
        positions=shape.mesh.vertices[samples.vertices],
        extremities=extremities(distances, areas_of_first(samples.basis, len(first)), mesh, rows, graph),
        proxy=shape_proxy(shape),
    )


def sample_surface(shape: Shape, kept: np.ndarray) -> tuple[Mesh, np.ndarray, np.ndarray]:
    """Return the surface or a proxy of a large one, the basis on it, and the numbers of the ``kept`` vertices."""
    if len(shape.mesh.vertices) <= MAX_SURFACE_VERTICES:
        return shape.mesh, to_numpy(shape.basis.functions), kept
    vertices = stratified_vertices(shape.basis, MAX_SURFACE_VERTICES, 0, np.unique(kept))
    mesh = coarsen(shape.mesh, vertices)
    return mesh, to_numpy(shape.basis.functions)[vertices], np.searchsorted(vertices, kept)


def subsample(shape: ShapeSamples, count: int) -> ShapeSamples:
    """Return the first ``count`` samples, which are farthest points too, with the areas of the others added to them."""
    basis = shape.samples.basis
    if count >= len(shape.samples.vertices):
        return shape
    areas = areas_of_first(basis, count)
    first = SampledBasis(basis.eigenvalues, basis.functions[:count], like(areas, basis.mass))
    return replace(
        shape,
        samples=SpectralSamples(shape.samples.vertices[:count], first),
        distances=shape.distances[: count // 2, : count // 2],
        descriptors=None if shape.descriptors is None else shape.descriptors[:count],
        heat=shape.heat[:count],
        positions=shape.positions[:count],
        extremities=shape.extremities.subsample(count),
    )


def areas_of_first(basis: SampledBasis, count: int) -> np.ndarray:
    """Return the areas (count,) of the first samples, with the area of each other sample added to the nearest one."""
    low = slice(1, 21)  # functions after the constant one that samples are compared by
    functions, values = to_numpy(basis.functions)[:, low], to_numpy(basis.eigenvalues)[low]
    embedding = functions / np.maximum(values, max(1e-6 * values[-1], eigenvalue_tolerance(basis)))
    closest = nearest(embedding, embedding[:count])
    return np.bincount(closest, to_numpy(basis.mass), minlength=count)


def mirror_samples(shape: ShapeSamples) -> ShapeSamples:
    """Return the samples of the mirror image of the shape, with the same vertices."""
    return replace(
        shape,
        descriptors=None if shape.descriptors is None else mirror_shot(shape.descriptors),
        orientation=None if shape.orientation is None else -shape.orientation,
        extremities=shape.extremities.mirrored(),
        proxy=shape.proxy and shape.proxy.mirrored(),
        mirrored=not shape.mirrored,
    )


def map_quality(C: Array, source: ShapeSamples, target: ShapeSamples, points: np.ndarray | None = None) -> Quality:
    """Measure the functional map ``C (k, k)``, refined on the samples of both shapes, without knowing the truth.

    ``points``: the source sample of each target sample ``(q_t,)`` by ``C``, where they are known.
    """
    C = to_numpy(C)
    k_t, k_s = C.shape
    pairs = _nearest_samples(C, source, target, points)
    values_s, values_t = (to_numpy(p.samples.basis.eigenvalues)[:k] for p, k in ((source, k_s), (target, k_t)))
    distortion, local_distortion = _distortion(pairs, source, target)
    commutator = C * values_s[None, :] - values_t[:, None] * C
    directions = (target, source, pairs.back), (source, target, pairs.forth)
    shot = [_squares(at, one.descriptor_rows, other.descriptor_rows, FLAT) for one, other, at in directions]
    heat = [_squares(at, one.heat_rows, other.heat_rows, SCORE.min_heat_variance) for one, other, at in directions]
    covered = [other.areas[np.bincount(at, minlength=len(other.areas)) > 0].sum() for _, other, at in directions]
    areas = [one.areas for one, *_ in directions]
    return Quality(
        orientation=_orientation(C, source, target),
        distortion=distortion,
        local_distortion=local_distortion,
        descriptors=_mean_of_directions(shot, areas),
        heat=_mean_of_directions(heat, areas),
        coverage=float(min(covered)),
        laplacian=_ratio((commutator**2).sum(), ((C * values_s[None, :]) ** 2).sum(), (values_s**2).sum(), 1.0),
        extremity_descriptor_error=_mean_of_directions(shot, [one.extremity_areas for one, *_ in directions]),
        reflection_error=float(np.mean([_reflection_error(*direction) for direction in directions])),
    )


def _reflection_error(one: ShapeSamples, other: ShapeSamples, points: np.ndarray) -> float:
    """Return the share of the area of ``one`` where ``points`` on the other and the shapes' reflections do not commute.

    0 where a shape has no reflection.
    """
    if one.reflection is None or other.reflection is None:
        return 0.0
    return _unequal_area(other.reflection[points], points[one.reflection], other, one.areas)


def _unequal_area(first: np.ndarray, second: np.ndarray, shape: ShapeSamples, areas: np.ndarray) -> float:
    """Return the share of ``areas (q,)`` at which two rows of samples of a shape, (q,) each, lie far apart.

    The difference of their distances from each extremity is a lower bound of the distance along the surface.
    """
    far = np.linalg.norm(shape.positions[first] - shape.positions[second], axis=1)
    extremities = shape.extremities
    if len(extremities.distances):
        along = np.abs(extremities.distances[:, first] - extremities.distances[:, second]).max(axis=0)
        far = np.maximum(far, extremities.unit * along)
    return float(areas[far > SCORE.reflection_distance].sum())


def map_distortion(C: Array, source: ShapeSamples, target: ShapeSamples, points: np.ndarray | None = None) -> float:
    """Return :attr:`Quality.distortion` alone; the parameters are those of :func:`map_quality`."""
    return _distortion(_nearest_samples(to_numpy(C), source, target, points), source, target)[0]


@dataclass(frozen=True, eq=False)
class _NearestSamples:
    """The nearest sample on the other shape of each sample, and the same among the first samples alone."""

    back: np.ndarray
    forth: np.ndarray
    first_back: np.ndarray
    first_forth: np.ndarray


def _nearest_samples(
    C: np.ndarray, source: ShapeSamples, target: ShapeSamples, points: np.ndarray | None
) -> _NearestSamples:
    """Return nearest neighbours in both directions, from one product in single precision."""
    k_t, k_s = C.shape
    images = source.functions[:, :k_s] @ np.asarray(C.T, dtype=np.float32)
    embedding = target.functions[:, :k_t]
    half_s, half_t = (0.5 * np.einsum("ij,ij->i", x, x) for x in (images, embedding))
    score = images @ embedding.T
    c_s, c_t = len(source.distances), len(target.distances)
    first = None if (c_s, c_t) == score.shape else score[:c_s, :c_t].copy()
    back = (score.T - half_s).argmax(axis=1) if points is None else points
    score -= half_t
    forth = score.argmax(axis=1)
    if first is None:
        return _NearestSamples(back, forth, back, forth)
    first_back = (first.T - half_s[:c_s]).argmax(axis=1)
    first -= half_t[:c_t]
    return _NearestSamples(back, forth, first_back, first.argmax(axis=1))


def _ratio(numerator: float, denominator: float, scale: float, otherwise: float) -> float:
    """Return a ratio, or ``otherwise`` where the denominator is a rounding error of numbers of the size of ``scale``.

    A denominator of zero in exact arithmetic comes out as zero on one machine and as 1e-16 on another.
    """
    return float(numerator / denominator) if denominator > 1e-12 * scale else otherwise


def _orientation(C: np.ndarray, source: ShapeSamples, target: ShapeSamples) -> float:
    if source.orientation is None or target.orientation is None:
        return 0.0
    most = 20  # functions in which orientation operators are compared
    low = min(most, source.orientation.shape[1], target.orientation.shape[1], *C.shape)
    last = min(N_ORIENTATION_OPERATORS + 1, C.shape[1], len(source.orientation))
    rows = min(len(target.orientation), C.shape[0])
    square = C[:low, :low]
    transferred = square @ source.orientation[1:last, :low, :low] @ square.T
    own = np.tensordot(C[:rows, 1:last].T, target.orientation[:rows, :low, :low], axes=1)
    norms = np.sqrt((transferred**2).sum() * (own**2).sum())
    # For a map of little more than constants both are rounding errors, and so would their correlation be.
    usual = np.linalg.norm(C) ** 3 * source.orientation_norm * target.orientation_norm
    return _ratio((transferred * own).sum(), norms, float(usual), 0.0)


def _distortion(pairs: _NearestSamples, source: ShapeSamples, target: ShapeSamples) -> tuple[float, float]:
    """Return the mean change of all distances and of the short ones, both divided by their mean."""
    near, far = [], 0.0
    for one, other, at in ((target, source, pairs.first_back), (source, target, pairs.first_forth)):
        change = other.distances[at[:, None], at]
        change -= one.distances
        np.abs(change, out=change)
        far += float(change.mean())
        near.append(one.short_distances.relative_change(change))
    mean = source.mean_distance + target.mean_distance
    return far / mean if mean > 0 else 0.0, float(np.mean(near))


def _squares(
    points: np.ndarray, one: _DescriptorRows | None, other: _DescriptorRows | None, flat: float
) -> tuple[np.ndarray, float] | None:
    """Return squared differences of descriptors of ``one`` from those of the ``points`` of the other.

    Also return the squared difference of random points. ``flat``: variance below which descriptors are noise.
    """
    if one is None or other is None:
        return None
    both = np.einsum("ij,ij->i", one.values, other.values.take(points, axis=0))
    squares = one.squares + other.squares[points] - 2.0 * both
    return squares, max(one.variance + other.variance, 2 * flat)


def _mean_of_directions(squares: list[tuple[np.ndarray, float] | None], areas: Sequence[np.ndarray | None]) -> float:
    """Return the mean of both directions, weighted with ``areas`` of sum 1; a direction without any counts 0."""
    known = [(s, a) for s, a in zip(squares, areas, strict=True) if s is not None and a is not None]
    return 0.5 * sum(float(s[0] @ a / s[1]) for s, a in known)
