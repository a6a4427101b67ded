"""Joint descriptors of a pair of shapes, and features of the kernel on them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, check, like, namespace, refuse, take, to_numpy
from kfmaps.config import Config, DescriptorConfig, NystromConfig
from kfmaps.descriptors.spectral import (
    heat_map,
    heat_signature,
    heat_times,
    normalize,
    wave_energies,
    wave_map,
    wave_signature,
)
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.kernels.kernels import KernelLike, Linear, resolve_kernel
from kfmaps.kernels.landmark_selection import farthest_descriptors, pivoted_cholesky, uniform
from kfmaps.kernels.nystrom import nystrom
from kfmaps.kernels.transformed import n_kernel_landmarks
from kfmaps.shape import Shape, sample_shape


@dataclass(frozen=True, eq=False)
class Descriptors:
    """Normalised descriptors ``source (n_s, d)`` and ``target (n_t, d)``, and the ``landmark (d,)`` of each.

    Landmarks are counted from 0; −1 stands for none.
    """

    source: Array
    target: Array
    landmark: np.ndarray


@dataclass(frozen=True, eq=False)
class Features:
    """Features ``source (n_s, r)``, ``target (n_t, r)`` of ``kernel``, in which every γ is a number."""

    source: Array
    target: Array
    kernel: KernelLike


@dataclass(frozen=True, eq=False)
class SampledPair:
    """Samples of both shapes that fits are made from, with landmarks ``(l, 2)`` and the user's descriptors there."""

    shapes: tuple[Shape, Shape]
    landmarks: np.ndarray
    descriptors: tuple[Array, Array] | None


def sample_pair_for_fit(
    source: Shape,
    target: Shape,
    count: int | None,
    landmarks: np.ndarray,
    descriptors: tuple[Array, Array] | None = None,
    rng: int | np.random.Generator = 0,
) -> SampledPair:
    """Return ``count`` samples of both shapes, with the ``landmarks (l, 2)`` and the user's descriptors there."""
    shapes = source, target
    parts = [sample_shape(shape, count, landmarks[:, i], rng) for i, shape in enumerate(shapes)]
    rows = None
    if descriptors is not None:
        given = [_given_descriptors(values, shape) for values, shape in zip(descriptors, shapes, strict=True)]
        rows = given[0][parts[0].vertices], given[1][parts[1].vertices]
    landmarks = np.stack([part.landmarks for part in parts], axis=1)
    return SampledPair((parts[0].shape, parts[1].shape), landmarks, rows)


def user_descriptors(
    source: Shape, target: Shape, config: DescriptorConfig, given: tuple[Array, Array] | None
) -> tuple[Array, Array] | None:
    """Return the ``given`` descriptors of both shapes and those that ``config.extra`` computes."""
    if not config.extra:
        return given
    blocks = [given] if given is not None else []
    blocks += [(one.compute(source), one.compute(target)) for one in config.extra]
    sides = [[_given_descriptors(block[i], shape) for block in blocks] for i, shape in enumerate((source, target))]
    for D_s, D_t in zip(*sides, strict=True):
        check(D_t, f"descriptors of {target.name}", shape=(None, D_s.shape[1]), remedy="compute as many on both shapes")
    return np.concatenate(sides[0], axis=1), np.concatenate(sides[1], axis=1)


def _given_descriptors(values: Array, shape: Shape) -> np.ndarray:
    """Return checked descriptors of the user."""
    values = np.asarray(to_numpy(values) if hasattr(values, "shape") else values, dtype=np.float64)
    n = len(shape.mesh.vertices)
    check(values, f"descriptors of {shape.name}", shape=(n, None), remedy="give one row per vertex")
    return values


def pair_descriptors(
    source: Shape,
    target: Shape,
    bases: tuple[Basis, Basis],
    config: DescriptorConfig,
    landmarks: np.ndarray,
    given: tuple[Array, Array] | None,
) -> Descriptors:
    """Return descriptors of both shapes as ``config`` says.

    ``bases``: on the device of the computation; ``landmarks (l, 2)``: pairs "source, target"; ``given``: descriptors of
    the user, beside the computed ones.
    """
    size = min(config.n_eigenfunctions, *(b.functions.shape[1] for b in bases))
    small = (bases[0].truncate(size), bases[1].truncate(size))
    landmarks = landmarks if config.landmark_descriptor != "none" else landmarks[:0]
    sides = [_spectral_descriptors(basis, small, config, at) for basis, at in zip(small, landmarks.T, strict=True)]
    landmark = _landmark_of_each(config, len(landmarks))
    if given is not None:
        for i, shape in enumerate((source, target)):
            sides[i].append(like(_given_descriptors(given[i], shape), bases[i].functions))
    masses = [b.mass for b in bases]
    blocks = []
    if sides[0] and sides[1]:
        xp = namespace(bases[0].functions)
        D_s, D_t = (xp.concat(side, axis=1) for side in sides)
        blocks.append(normalize(D_s, D_t, config.normalisation, *masses))
    if config.shot:
        local = []
        for shape, basis in zip((source, target), bases, strict=True):
            if shape.shot is None:
                raise refuse(shape.name, "a shape prepared with SHOT", "one without", "prepare it with this config")
            local.append(like(shape.shot, basis.functions))
        D_s, D_t = normalize(local[0], local[1], "variance", *masses)
        weight = math.sqrt(config.shot_weight)
        blocks.append((D_s * weight, D_t * weight))
    if not blocks:
        remedy = "turn on a signature, SHOT or landmarks, or give descriptors"
        raise refuse("descriptors", "at least one", "none", remedy)
    xp = namespace(blocks[0][0])
    D_s, D_t = (xp.concat([b[i] for b in blocks], axis=1) for i in (0, 1))
    others = np.full(D_s.shape[1] - len(landmark), -1)
    return Descriptors(D_s, D_t, np.concatenate([landmark, others]))


def _spectral_descriptors(
    basis: Basis, bases: tuple[Basis, ...], config: DescriptorConfig, landmarks: np.ndarray
) -> list[Array]:
    """Return the signature and the landmark maps of one shape; energies are common to both ``bases``."""
    n_signature, per_landmark = spectral_shares(config, len(landmarks))
    parts = []
    if n_signature:
        parts.append(_signature(config.signature, basis, bases, None, n_signature))
    if per_landmark and len(landmarks):
        parts.append(_signature(config.landmark_descriptor, basis, bases, landmarks, per_landmark))
    if config.energy_sampling == "even" or not parts:
        return parts
    joined = namespace(*parts).concat(parts, axis=1)
    return [take(joined, _every_nth(joined.shape[1], config.n_spectral), axis=1)]


def spectral_shares(config: DescriptorConfig, n_landmarks: int) -> tuple[int, int]:
    """Return the numbers of spectral descriptors of the signature and of each landmark.

    With the energy sampling "every-nth" they are the numbers before every n-th is taken.
    """
    n_energies = 200  # of the signature and of each landmark with "every-nth"
    if config.energy_sampling == "every-nth":
        return 0 if config.signature == "none" else n_energies, n_energies
    if config.signature == "none":
        return 0, max(1, config.n_spectral // max(n_landmarks, 1))
    if n_landmarks == 0:
        return config.n_spectral, 0
    per_landmark = max(1, int((1 - config.signature_share) * config.n_spectral) // n_landmarks)
    return max(config.n_spectral - per_landmark * n_landmarks, 0), per_landmark


def _landmark_of_each(config: DescriptorConfig, n_landmarks: int) -> np.ndarray:
    """Return the landmark of each spectral descriptor, counted from 0, (d,); −1 for the signature."""
    n_signature, per_landmark = spectral_shares(config, n_landmarks)
    landmark = np.concatenate([np.full(n_signature, -1), np.repeat(np.arange(n_landmarks), per_landmark)])
    return landmark if config.energy_sampling == "even" else landmark[_every_nth(len(landmark), config.n_spectral)]


def _every_nth(total: int, count: int) -> np.ndarray:
    """Return every n-th number below ``total``, at most ``count``."""
    return np.arange(0, total, max(1, total // count))[:count]


def _signature(kind: str, basis: Basis, bases: tuple[Basis, ...], landmarks: np.ndarray | None, count: int) -> Array:
    """Return the heat or wave signature, or its maps of landmarks."""
    if kind == "heat":
        times = heat_times(count, *bases)
        return heat_signature(basis, times) if landmarks is None else heat_map(basis, landmarks, times)
    energies, sigma = wave_energies(count, *bases)
    if landmarks is None:
        return wave_signature(basis, energies, sigma)
    return wave_map(basis, landmarks, energies, sigma)


def resolve_kernel_width(descriptors: Descriptors, config: Config, rng: np.random.Generator) -> KernelLike:
    """Return the kernel of ``config`` with automatic γ chosen from farthest points of both shapes' descriptors."""
    expected, given = n_kernel_landmarks(config.kernel), int(np.max(descriptors.landmark, initial=-1)) + 1
    if expected is not None and expected != given:
        remedy = "give as many, or learn a kernel with as many (kfmaps learn --truth-landmarks)"
        raise refuse("landmarks", f"{expected} of them, as the kernel was learned with", str(given), remedy)
    sides = descriptors.source, descriptors.target
    rows = [take(D, farthest_descriptors(D, min(100, D.shape[0]), rng)) for D in sides]
    return resolve_kernel(config.kernel, namespace(rows[0]).concat(rows), config.bandwidth_scale)


def kernel_features(
    source: Shape, target: Shape, descriptors: Descriptors, config: Config, rng: np.random.Generator
) -> Features:
    """Return the Nyström features of the joint kernel, or the descriptors themselves when it is linear."""
    if isinstance(config.kernel, Linear):
        return Features(descriptors.source, descriptors.target, config.kernel)
    kernel = resolve_kernel_width(descriptors, config, rng)
    samples = _joint_samples(source, target, descriptors, kernel, config.nystrom, rng)
    factor = nystrom(kernel, samples, config.nystrom.rtol)
    return Features(factor.features(descriptors.source), factor.features(descriptors.target), kernel)


def _joint_samples(
    source: Shape,
    target: Shape,
    descriptors: Descriptors,
    kernel: KernelLike,
    config: NystromConfig,
    rng: np.random.Generator,
) -> Array:
    """Return descriptors ``(q, d)`` at samples of both shapes, half from each except for Cholesky's pivots."""
    D_s, D_t = descriptors.source, descriptors.target
    xp = namespace(D_s, D_t)
    if config.sampling.endswith("cholesky"):
        both = xp.concat([D_s, D_t])
        count = min(config.samples, both.shape[0])
        power = 2.0 if config.sampling == "squared-cholesky" else 1.0
        rows = pivoted_cholesky(kernel, both, count, randomised=config.sampling != "cholesky", power=power, rng=rng)
        return take(both, rows)
    taken = []
    for shape, D in ((source, D_s), (target, D_t)):
        count = min(config.samples // 2, D.shape[0])
        if config.sampling == "descriptor":
            rows = farthest_descriptors(D, count, rng)
        elif config.sampling == "geodesic":
            rows = farthest_geodesic(shape.mesh, count, rng)
        else:
            rows = uniform(D.shape[0], count, rng)
        taken.append(take(D, rows))
    return xp.concat(taken)
