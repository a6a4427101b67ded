"""Pairs of shapes to learn from: descriptors and bases as tensors, and the truth."""

from __future__ import annotations

from dataclasses import dataclass, replace
from weakref import WeakKeyDictionary

import numpy as np
import torch
from numpy.typing import ArrayLike

from kfmaps._arrays import check, refuse, to_numpy
from kfmaps._records import short_repr
from kfmaps.config import Config, Formulation
from kfmaps.fmap.nearest import nearest
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import Mesh
from kfmaps.kernels.landmark_selection import farthest_descriptors
from kfmaps.matching.features import pair_descriptors
from kfmaps.matching.fit import check_landmark_pairs
from kfmaps.shape import Shape, sample_shape

_MAX_CORRESPONDENCES = 500  # largest number of true correspondences of a pair at which errors are measured


@dataclass(frozen=True, eq=False)
class TrainingPair:
    """A pair to learn from, at the points that the fit uses; made by :func:`training_pair`.

    The truth is known at ``m`` correspondences.
    """

    name: str
    source: Basis  # of the map's size, as tensors
    target: Basis
    descriptors_s: torch.Tensor  # (n_s, d): normalised as the configuration says
    descriptors_t: torch.Tensor  # (n_t, d)
    samples: torch.Tensor  # (q, d): of the Nyström approximation, half from each shape
    n_landmarks: int
    functions_t: torch.Tensor  # (m, k): basis of the target at the correspondences
    distances: torch.Tensor  # (m, n_s): geodesic, in √area, from the source vertex of each to every point of the source
    points_s: torch.Tensor  # (m,): the point of the source nearest to each of the correspondences
    points_t: torch.Tensor  # (m,): the same of the target

    __repr__ = short_repr


def training_pair(
    source: Shape,
    target: Shape,
    config: Config,
    *,
    truth: tuple[ArrayLike, ArrayLike],
    landmarks: ArrayLike | None = None,
    samples: int = 150,
    rng: int | np.random.Generator = 0,
) -> TrainingPair:
    """Return the training pair of two shapes that were prepared with ``config``.

    Parameters
    ----------
    truth : pair of arrays (q,), (q,)
        Corresponding vertices of source and target.
    landmarks : (l, 2) whole numbers, optional
        Pairs "source, target", as for :func:`kfmaps.match`.
    samples : int
        Number of Nyström samples; fewer than a match takes, since learning makes thousands of fits.
    rng : seed or Generator

    Raises
    ------
    InvalidInput
        When landmarks or truth do not fit the shapes, or the configuration has a term that cannot be learned with.
    """
    if config.weights.orientation or config.full_kernel:
        got = "an orientation term" if config.weights.orientation else "the full kernel"
        raise refuse("settings to learn from", "features and the terms of the paper", got, "leave it out")
    formulation = config.formulation
    if replace(Formulation(), mask=formulation.mask, mask_power=formulation.mask_power) != formulation:
        remedy = "leave out the formulation except for its mask"
        raise refuse("settings to learn from", "an energy that is quadratic in one map", repr(formulation), remedy)
    rng = np.random.default_rng(rng)
    landmarks = check_landmark_pairs(landmarks, source, target)
    parts = [sample_shape(shape, config.fit_samples, landmarks[:, i]) for i, shape in enumerate((source, target))]
    bases = (parts[0].shape.basis, parts[1].shape.basis)
    rows = np.stack([part.landmarks for part in parts], axis=1)
    descriptors = pair_descriptors(parts[0].shape, parts[1].shape, bases, config.descriptors, rows, None)
    both = (descriptors.source, descriptors.target)
    chosen = np.concatenate([D[farthest_descriptors(D, min(samples // 2, len(D)), rng)] for D in both])
    k = config.basis.n_eigenfunctions
    return TrainingPair(
        f"{source.name} {target.name}",
        bases[0].truncate(k).to("torch"),
        bases[1].truncate(k).to("torch"),
        torch.from_numpy(to_numpy(both[0])),
        torch.from_numpy(to_numpy(both[1])),
        torch.from_numpy(chosen),
        len(landmarks),
        *map(torch.from_numpy, _truth(source, target, (parts[0].vertices, parts[1].vertices), k, truth)),
    )


def _truth(
    source: Shape, target: Shape, points: tuple[np.ndarray, np.ndarray], k: int, truth: tuple[ArrayLike, ArrayLike]
) -> tuple[np.ndarray, ...]:
    """Return the last four fields of a pair, whose fit uses the vertices ``points`` of source and target."""
    true_s, true_t = (np.asarray(side) for side in truth)
    for side, shape in ((true_s, source), (true_t, target)):
        name, n = f"truth of {shape.name}", len(shape.mesh.vertices)
        check(side, name, shape=(len(true_s),), finite=False, remedy="give as many vertices on both")
        if len(side) == 0 or side.min() < 0 or side.max() >= n:
            got = f"{side.min()} to {side.max()}" if side.size else "none"
            raise refuse(name, f"vertices from 0 to {n - 1}", got, "take the lists of these shapes")
    # The same lines for every pair of a collection, so that distances from them can be cached.
    lines = np.random.default_rng(0).choice(len(true_s), min(_MAX_CORRESPONDENCES, len(true_s)), replace=False)
    true_s, true_t = (side[np.sort(lines)] for side in (true_s, true_t))
    points_s, points_t = (
        nearest(shape.mesh.vertices[side], shape.mesh.vertices[rows])
        for shape, side, rows in zip((source, target), (true_s, true_t), points, strict=True)
    )
    distances = _distances(source.mesh, true_s)
    distances = distances if len(points[0]) == distances.shape[1] else distances[:, points[0]]
    return target.basis.truncate(k).functions[true_t], distances, points_s, points_t


_DISTANCES: WeakKeyDictionary[Mesh, dict[bytes, np.ndarray]] = WeakKeyDictionary()


def _distances(mesh: Mesh, sources: np.ndarray) -> np.ndarray:
    """Return geodesic distances ``(m, n)`` float32, cached as long as the mesh, the source of many pairs, exists."""
    cache = _DISTANCES.setdefault(mesh, {})
    key = sources.tobytes()
    if key not in cache:
        cache[key] = geodesic_distances(mesh, sources).astype(np.float32)
    return cache[key]
