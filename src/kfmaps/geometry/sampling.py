"""Samples of a shape, each with the area closest to it: a quadrature for functions.

They are chosen in the biharmonic embedding, which follows the surface and needs no mesh. The error ``‖ΦᵀA_qΦ − I‖₂`` of
10,000 samples of 80,000 vertices, for 100 functions, is 0.12 for random samples, 0.019 for farthest points of a random
pool (0.6 s) and 0.012 for stratified samples (0.1 s).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import check_count, like, take, to_numpy
from kfmaps.geometry.basis import Basis, eigenvalue_tolerance
from kfmaps.kernels.landmark_selection import farthest_descriptors

_DIMENSIONS = 39  # coordinates of the embedding: 40 functions, the constant among them
_STRATA_DIMENSIONS = 8  # coordinates of the embedding that strata are cut by


@dataclass(frozen=True, eq=False)
class SampledBasis(Basis):
    """A basis at samples of a shape, where its functions are not quite orthonormal.

    ``mass`` is the area closest to each sample.
    """


@dataclass(frozen=True, eq=False)
class SpectralSamples:
    """Samples of a shape: their vertices, (q,) int64, and the basis at them."""

    vertices: np.ndarray
    basis: SampledBasis


def spectral_samples(basis: Basis, count: int, rng: int | np.random.Generator = 0) -> SpectralSamples:
    """Return farthest points of a shape in its biharmonic embedding, with the area closest to each.

    They spread evenly over the surface whatever its triangulation. On large shapes they are chosen from 8,000
    stratified samples, so that their cost hardly grows with the mesh. The embedding stretches thin bridges. Where
    samples would crowd there, they are chosen from twice as many stratified samples, which are uniform in area.

    Parameters
    ----------
    basis : Basis
        Of a shape with n vertices. Those without area are never chosen.
    count : int
        Fewer where there are no more vertices.
    rng : seed or Generator

    Returns
    -------
    SpectralSamples

    References
    ----------
    Lipman, Rustamov and Funkhouser, Biharmonic distance (2010).
    """
    check_count(count, "sample count")
    candidates, embedding = _embedded(basis)
    pool = np.arange(len(candidates))
    # Most vertices that :func:`spectral_samples` chooses from, if they are four times as many as the samples.
    pool_size = 8_000
    if len(pool) > max(pool_size, 4 * count):
        pool = stratified(embedding, to_numpy(basis.mass)[candidates], max(pool_size, 4 * count), rng)
    chosen = pool[farthest_descriptors(embedding[pool], min(count, len(pool)), rng, None)]
    samples = _samples(basis, candidates, embedding, chosen)
    if not _are_crowded(samples, count):
        return samples
    pool = stratified(embedding, to_numpy(basis.mass)[candidates], 2 * count, rng)
    uniform = pool[farthest_descriptors(embedding[pool], min(count, len(pool)), rng, None)]
    # Fewer may be left where vertices coincide in the embedding, as those of one of many components do.
    return samples if len(uniform) < len(chosen) else _samples(basis, candidates, embedding, uniform)


def _are_crowded(samples: SpectralSamples, count: int) -> bool:
    """Return whether the half of the samples with the smallest areas has next to none of the area."""
    areas = np.sort(to_numpy(samples.basis.mass))
    min_share = 0.15  # of the area that this half has; on bodies it has 0.24 and more
    return len(areas) == count and float(areas[: count // 2].sum()) < min_share * float(areas.sum())


def stratified_samples(
    basis: Basis, count: int, rng: int | np.random.Generator = 0, kept: np.ndarray | None = None
) -> SpectralSamples:
    """Return one random vertex from each of ``count`` compact regions of equal area, with the area closest to each.

    It takes time ``n log n`` whatever the count and is meant for thousands of samples. A vertex that is drawn twice
    counts once.

    Parameters
    ----------
    basis : Basis
        Of a shape with n vertices.
    count : int
    rng : seed or Generator
    kept : (l,) int64, optional
        Vertices that are samples in any case.

    Returns
    -------
    SpectralSamples
        In ascending order.
    """
    candidates, embedding, chosen = _strata(basis, count, rng)
    if kept is None:
        return _samples(basis, candidates, embedding, chosen)
    samples = _samples(basis, candidates, embedding, np.union1d(chosen, np.flatnonzero(np.isin(candidates, kept))))
    vertices = np.union1d(samples.vertices, kept)  # kept vertices that no face uses have no area
    areas = np.zeros(len(vertices))
    areas[np.searchsorted(vertices, samples.vertices)] = to_numpy(samples.basis.mass)
    functions = take(basis.functions, vertices)
    return SpectralSamples(vertices, SampledBasis(basis.eigenvalues, functions, like(areas, basis.mass)))


def stratified_vertices(
    basis: Basis, count: int, rng: int | np.random.Generator = 0, kept: np.ndarray | None = None
) -> np.ndarray:
    """Return the vertices of :func:`stratified_samples`, (q,) int64, in a fraction of its time.

    ``count``, ``rng`` and ``kept``: as there.
    """
    candidates, _, chosen = _strata(basis, count, rng, _STRATA_DIMENSIONS)
    return candidates[chosen] if kept is None else np.union1d(candidates[chosen], kept)


def _strata(
    basis: Basis, count: int, rng: int | np.random.Generator, dimensions: int = _DIMENSIONS
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the vertices with an area, their embedding, and which of them are drawn."""
    check_count(count, "sample count")
    candidates, embedding = _embedded(basis, dimensions)
    return candidates, embedding, stratified(embedding, to_numpy(basis.mass)[candidates], count, rng)


def _embedded(basis: Basis, dimensions: int = _DIMENSIONS) -> tuple[np.ndarray, np.ndarray]:
    """Return the vertices with an area, and their first coordinates in the biharmonic embedding."""
    candidates = np.flatnonzero(to_numpy(basis.mass) > 0)
    values, functions = to_numpy(basis.eigenvalues), to_numpy(basis.functions)
    positive = np.flatnonzero(values > eigenvalue_tolerance(basis))[:_DIMENSIONS]
    if len(positive) == 0:  # more components than functions
        return candidates, functions[candidates]
    positive = positive[values[positive] > 1e-6 * values[positive[-1]]][:dimensions]
    embedding = functions[:, positive] / values[positive]
    return candidates, embedding if len(candidates) == len(embedding) else np.asfortranarray(embedding[candidates])


def stratified(
    embedding: np.ndarray, mass: np.ndarray, count: int, rng: int | np.random.Generator | None
) -> np.ndarray:
    """Return a systematic sample by area, along the leaves of a k-d tree, which follow each other in space.

    Parameters
    ----------
    embedding : (n, d) float64
        Positions; the first 8 coordinates are used.
    mass : (n,) float64
        Areas.
    count : int
    rng : seed or Generator

    Returns
    -------
    (q,) int64
        Rows in ascending order, ``count`` or fewer where one is drawn twice.
    """
    order = KDTree(embedding[:, :_STRATA_DIMENSIONS]).indices
    reached = np.cumsum(mass[order])
    drawn = (np.arange(count) + np.random.default_rng(rng).random(count)) / count
    return np.unique(order[np.searchsorted(reached / reached[-1], drawn).clip(max=len(order) - 1)])


def _samples(basis: Basis, candidates: np.ndarray, embedding: np.ndarray, chosen: np.ndarray) -> SpectralSamples:
    closest = KDTree(embedding[chosen]).query(embedding)[1]
    areas = np.bincount(closest, to_numpy(basis.mass)[candidates], minlength=len(chosen))
    vertices = candidates[chosen]
    return SpectralSamples(
        vertices, SampledBasis(basis.eigenvalues, take(basis.functions, vertices), like(areas, basis.mass))
    )
