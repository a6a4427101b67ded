"""How good a map is, judged without the truth.

Several measures, none of which is enough alone: a mirrored map of a symmetric body distorts nothing, a map that
swaps front and back *and* left and right even keeps orientation, and a map that collapses everything to one point
is smooth. :func:`map_quality` works them out on a few hundred points of each shape; :attr:`Quality.score` weighs them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse.csgraph import dijkstra

from kfmaps._arrays import Array, like, to_numpy
from kfmaps.descriptors.shot import mirror_shot
from kfmaps.descriptors.spectral import heat_signature
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.descriptor_guidance import FLAT
from kfmaps.fmap.refine import SampledBasis, SpectralSamples, spectral_samples
from kfmaps.geometry.basis import Basis, eigenvalue_tolerance
from kfmaps.geometry.coarsen import CoarseProxy, coarsen
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.geodesics import pairwise_geodesics
from kfmaps.geometry.mesh import Mesh
from kfmaps.geometry.orientation_operators import orientation_operators
from kfmaps.geometry.sampling import stratified_vertices
from kfmaps.matching.extremities import Extremities, extremities
from kfmaps.matching.sample_cache import Known, Rows, known
from kfmaps.matching.score import SCORE, Quality
from kfmaps.registration.deformation_energy import coarse_copy
from kfmaps.shape import Shape

POINTS = 1000
"""Sample points on each shape."""
COARSE = 300
"""The first of them, between which geodesic distances are compared."""
SURFACE = 6000
"""Vertices from which distances and orientation are worked out on a coarse copy with that many."""
LOW = 20
"""Functions in which orientation is compared."""
OPERATORS = 50
"""Functions of the orientation operators that a probe keeps, also for fits."""
TIMES = np.geomspace(0.005, 0.3, 8)
"""Diffusion times at unit area: from a fiftieth of the surface reached to most of it."""
WAVES = 10
"""Functions whose orientation operators are compared."""


@dataclass(frozen=True, eq=False)
class ShapeSamples:
    """What judging maps needs of one shape; made by :func:`sample_for_scoring`.

    Attributes
    ----------
    samples : Samples
        Farthest points; the first ``c`` of them are farthest points too.
    distances : (c, c) float64
        Geodesic distances between the first points.
    orientation : (w, k, k) float64 or None
        Orientation operators of the first functions, in the first functions; ``None`` for a point cloud.
    descriptors : (q, d) float64 or None
        SHOT at the samples.
    heat : (q, t) float64
        Logarithm of the heat kernel signature at the samples, for fixed times.
    positions : (q, 3) float64
    marks : (l, q) float64
        Geodesic distances from landmarks to the samples.
    tips : Tips
        The tips of its limbs.
    copy : Copy or None
        A coarse copy that can be bent; ``None`` for a point cloud.
    mirrored : bool
        Whether it is of the mirror image.
    turns : (m, k, k) float64 or None
        Its near-symmetries (:func:`kfmaps.matching.self_maps.symmetries`) on its first samples, which are those of the
        mirror image too; ``None`` where they have not been looked for.
    """

    samples: SpectralSamples
    distances: np.ndarray
    orientation: np.ndarray | None
    descriptors: np.ndarray | None
    heat: np.ndarray
    positions: np.ndarray
    landmark_distances: np.ndarray
    extremities: Extremities
    copy: CoarseProxy | None
    mirrored: bool = False
    turns: np.ndarray | None = None

    @cached_property
    def known(self) -> Known:
        """What judging each of many maps would find again."""
        basis = self.samples.basis
        areas = to_numpy(basis.mass) / float(basis.mass.sum())
        return known(
            basis.functions, areas, self.distances, self.orientation, self.descriptors, self.heat, self.extremities
        )


def sample_for_scoring(
    shape: Shape,
    count: int = POINTS,
    rng: int | np.random.Generator = 0,
    threads: int | None = None,
    landmarks: np.ndarray | None = None,
) -> ShapeSamples:
    """Sample ``count`` points of ``shape`` and work out what :func:`map_quality` compares.

    ``landmarks (l,)``: vertices whose distances to the samples are wanted too.
    """
    samples = spectral_samples(shape.basis, count, rng)
    marked = np.zeros(0, dtype=np.int64) if landmarks is None else landmarks
    first = samples.vertices[:COARSE]
    mesh, functions, rows = sample_surface(shape, np.concatenate([samples.vertices, marked]))
    graph = geodesic_graph(mesh, 1)
    close = pairwise_geodesics(graph, rows[: len(first)])
    # Separate components are as far apart as the farthest points of one.
    joined = np.isfinite(close)
    farthest = close[joined].max() or float(np.linalg.norm(np.ptp(shape.mesh.vertices[first], axis=0)))
    close = np.where(joined, close, farthest)
    marks = np.zeros((0, len(samples.vertices)))
    if len(marked):
        marks = dijkstra(graph, indices=rows[len(samples.vertices) :])[:, rows[: len(samples.vertices)]]
        joined = np.isfinite(marks)
        marks = np.where(joined, marks, max(farthest, marks[joined].max(initial=0.0)))
    orientation = None
    if len(shape.mesh.faces):
        low = Basis(shape.basis.eigenvalues, functions[:, :OPERATORS], shape.basis.mass)
        orientation = orientation_operators(mesh, low, functions[:, : 4 * WAVES], threads)
    local = None if shape.shot is None else shape.shot[samples.vertices]
    heat = np.log(np.maximum(to_numpy(heat_signature(samples.basis, TIMES)), 1e-12))
    return ShapeSamples(
        samples,
        close,
        orientation,
        local,
        heat,
        shape.mesh.vertices[samples.vertices],
        marks,
        extremities(close, areas_of_first(samples.basis, len(first)), mesh, rows[: len(samples.vertices)], graph),
        coarse_copy(shape),
    )


def sample_surface(shape: Shape, wanted: np.ndarray) -> tuple[Mesh, np.ndarray, np.ndarray]:
    """The surface itself or, of a large one, a coarse copy; the basis on it; and where the ``wanted`` vertices are."""
    if len(shape.mesh.vertices) <= SURFACE:
        return shape.mesh, to_numpy(shape.basis.functions), wanted
    vertices = stratified_vertices(shape.basis, SURFACE, 0, np.unique(wanted))
    mesh = coarsen(shape.mesh, vertices)
    return mesh, to_numpy(shape.basis.functions)[vertices], np.searchsorted(vertices, wanted)


def subsample(probe: ShapeSamples, count: int) -> ShapeSamples:
    """The first ``count`` samples of ``probe``, which are farthest points too, with the areas of the others."""
    basis = probe.samples.basis
    if count >= len(probe.samples.vertices):
        return probe
    areas = areas_of_first(basis, count)
    few = SampledBasis(basis.eigenvalues, basis.functions[:count], like(areas, basis.mass))
    return replace(
        probe,
        samples=SpectralSamples(probe.samples.vertices[:count], few),
        distances=probe.distances[: count // 2, : count // 2],
        descriptors=None if probe.descriptors is None else probe.descriptors[:count],
        heat=probe.heat[:count],
        positions=probe.positions[:count],
        landmark_distances=probe.landmark_distances[:, :count],
        extremities=probe.extremities.thinned(count),
    )


def areas_of_first(basis: SampledBasis, count: int) -> np.ndarray:
    """The areas (count,) that the first samples stand for when the others are given to the nearest of them."""
    functions, values = to_numpy(basis.functions)[:, 1 : LOW + 1], to_numpy(basis.eigenvalues)[1 : LOW + 1]
    embedding = functions / np.maximum(values, max(1e-6 * values[-1], eigenvalue_tolerance(basis)))
    closest = nearest(embedding, embedding[:count], threads=1)
    return np.bincount(closest, to_numpy(basis.mass), minlength=count)


def mirror_samples(probe: ShapeSamples) -> ShapeSamples:
    """The probe of the mirror image of the shape, with the same vertices."""
    return replace(
        probe,
        descriptors=None if probe.descriptors is None else mirror_shot(probe.descriptors),
        orientation=None if probe.orientation is None else -probe.orientation,
        extremities=probe.extremities.mirrored(),
        copy=None if probe.copy is None else probe.copy.mirrored(),
        mirrored=not probe.mirrored,
    )


def map_quality(C: Array, source: ShapeSamples, target: ShapeSamples, points: np.ndarray | None = None) -> Quality:
    """Judge the functional map ``C (k, k)``, refined on the samples of both probes, without knowing the truth.

    ``points``: the source sample of each target sample ``(q_t,)`` by ``C``, where they are known.
    """
    C = to_numpy(C)
    k_t, k_s = C.shape
    known_s, known_t = source.known, target.known
    found = _images(C, source, target, points)
    values_s, values_t = (to_numpy(p.samples.basis.eigenvalues)[:k] for p, k in ((source, k_s), (target, k_t)))
    distortion, stretch = _distortion(found, source, target)
    commutator = C * values_s[None, :] - values_t[:, None] * C
    back, forth, area_s, area_t = found.back, found.forth, known_s.areas, known_t.areas
    squares_t = _squares(back, known_t.descriptors, known_s.descriptors, FLAT)
    squares_s = _squares(forth, known_s.descriptors, known_t.descriptors, FLAT)
    covered = [area[np.bincount(at, minlength=len(area)) > 0].sum() for area, at in ((area_s, back), (area_t, forth))]
    return Quality(
        orientation=_orientation(C, source, target),
        distortion=distortion,
        local_distortion=stretch,
        descriptors=0.5 * (_mean(squares_t, area_t) + _mean(squares_s, area_s)),
        heat=0.5
        * (
            _mean(_squares(back, known_t.heat, known_s.heat, SCORE.min_heat_variance), area_t)
            + _mean(_squares(forth, known_s.heat, known_t.heat, SCORE.min_heat_variance), area_s)
        ),
        coverage=float(min(covered)),
        laplacian=_ratio((commutator**2).sum(), ((C * values_s[None, :]) ** 2).sum(), (values_s**2).sum(), 1.0),
        extremity_descriptor_error=0.5 * (_mean(squares_t, known_t.ends) + _mean(squares_s, known_s.ends)),
    )


def map_distortion(C: Array, source: ShapeSamples, target: ShapeSamples, points: np.ndarray | None = None) -> float:
    """:attr:`Quality.distortion` alone; the parameters are those of :func:`map_quality`."""
    return _distortion(_images(to_numpy(C), source, target, points), source, target)[0]


@dataclass(frozen=True, eq=False)
class _Images:
    """The nearest sample on the other shape, of all samples and, among the first, of the first."""

    back: np.ndarray
    forth: np.ndarray
    first_back: np.ndarray
    first_forth: np.ndarray


def _images(C: np.ndarray, source: ShapeSamples, target: ShapeSamples, points: np.ndarray | None) -> _Images:
    """Nearest neighbours in both directions, from one product in single precision."""
    k_t, k_s = C.shape
    carried = source.known.functions[:, :k_s] @ np.asarray(C.T, dtype=np.float32)
    there = target.known.functions[:, :k_t]
    half_s, half_t = (0.5 * np.einsum("ij,ij->i", x, x) for x in (carried, there))
    score = carried @ there.T
    c_s, c_t = len(source.distances), len(target.distances)
    all_of_them = (c_s, c_t) == score.shape
    first = None if all_of_them else score[:c_s, :c_t].copy()
    back = (score.T - half_s).argmax(axis=1) if points is None else points
    score -= half_t
    forth = score.argmax(axis=1)
    if first is None:
        return _Images(back, forth, back, forth)
    first_back = (first.T - half_s[:c_s]).argmax(axis=1)
    first -= half_t[:c_t]
    return _Images(back, forth, first_back, first.argmax(axis=1))


def _ratio(part: float, whole: float, scale: float, otherwise: float) -> float:
    """``part / whole``, but ``otherwise`` where ``whole`` is rounding beside its usual size, ``scale``.

    What is zero in exact arithmetic comes out as zero on one machine and as 1e-16 on another.
    """
    return float(part / whole) if whole > 1e-12 * scale else otherwise


def _orientation(C: np.ndarray, source: ShapeSamples, target: ShapeSamples) -> float:
    if source.orientation is None or target.orientation is None:
        return 0.0
    low = min(LOW, source.orientation.shape[1], target.orientation.shape[1], *C.shape)
    waves = min(WAVES + 1, C.shape[1], len(source.orientation))
    rows = min(len(target.orientation), C.shape[0])
    square = C[:low, :low]
    ours = square @ source.orientation[1:waves, :low, :low] @ square.T
    theirs = np.tensordot(C[:rows, 1:waves].T, target.orientation[:rows, :low, :low], axes=1)
    size = np.sqrt((ours**2).sum() * (theirs**2).sum())
    # Of a map that carries next to nothing but constants both are rounding, and so would their correlation be.
    usual = np.linalg.norm(C) ** 3 * source.known.orientation * target.known.orientation
    return _ratio((ours * theirs).sum(), size, float(usual), 0.0)


def _distortion(found: _Images, source: ShapeSamples, target: ShapeSamples) -> tuple[float, float]:
    """Mean change of all distances and of the short ones, both divided by their mean."""
    near, far = [], 0.0
    for here, there, at in ((target, source, found.first_back), (source, target, found.first_forth)):
        change = there.distances[at[:, None], at]
        change -= here.distances
        np.abs(change, out=change)
        far += float(change.mean())
        near.append(_near(change, here.known))
    mean = source.known.mean + target.known.mean
    return far / mean if mean > 0 else 0.0, float(np.mean(near))


def _near(change: np.ndarray, of: Known) -> float:
    """Mean of ``change`` where distances are short, over the mean of these."""
    return float(change.ravel()[of.short].mean()) / of.short_mean if of.short_mean > 0 else 0.0


def _squares(points: np.ndarray, there: Rows | None, here: Rows | None, flat: float) -> tuple[np.ndarray, float] | None:
    """Squared differences of the descriptors ``there`` from those ``here`` of the points that they are mapped to.

    Beside them that of random points.
    """
    if there is None or here is None:
        return None
    both = np.einsum("ij,ij->i", there.values, here.values.take(points, axis=0))
    return there.squares + here.squares[points] - 2.0 * both, max(there.spread + here.spread, 2 * flat)


def _mean(squares: tuple[np.ndarray, float] | None, areas: np.ndarray | None) -> float:
    """Of squared differences over that of random points, weighted with ``areas`` of sum 1; 0 where one is unknown."""
    return 0.0 if squares is None or areas is None else float(squares[0] @ areas / squares[1])
