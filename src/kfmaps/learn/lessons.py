"""What a pair of shapes offers to learning: its descriptors and bases as tensors, and its truth where that is known."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import torch

from kfmaps._arrays import check, refuse, to_numpy
from kfmaps.config import Config, Formulation
from kfmaps.fmap.nearest import nearest
from kfmaps.geometry.basis import Basis
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import Mesh
from kfmaps.kernels.kernels import Gaussian, Laplacian, resolve_kernel
from kfmaps.kernels.landmark_selection import farthest_descriptors
from kfmaps.matching.features import pair_descriptors
from kfmaps.matching.fit import check_landmark_pairs
from kfmaps.shape import Shape, sample_shape

JUDGED = 500
"""True correspondences of a pair, at most, at which errors are measured."""


@dataclass(frozen=True, eq=False)
class Known:
    """The truth of a pair, at ``m`` of its correspondences.

    Attributes
    ----------
    wanted : (k, k) tensor
        The functional map of the true point map, by least squares.
    functions_t : (m, k) tensor
        Basis of the target at the judged points.
    distances : (m, n_s) float32 tensor
        Geodesic, in √area, from the true partner of each to every point of the source.
    rows_s, rows_t : (m,) int64 tensors
        The points of source and target at, or nearest to, these correspondences.
    """

    wanted: torch.Tensor
    functions_t: torch.Tensor
    distances: torch.Tensor
    rows_s: torch.Tensor
    rows_t: torch.Tensor


@dataclass(frozen=True, eq=False)
class Lesson:
    """A pair to learn from; made by :func:`lesson`. Points are those that the fit is made from.

    Attributes
    ----------
    name : str
    source, target : Basis
        Of the map's size, as tensors.
    descriptors_s, descriptors_t : (n_s, d), (n_t, d) tensors
        Normalised as the configuration says.
    samples : (q, d) tensor
        Of the Nyström approximation, half from each shape.
    gamma : float
        The automatic γ that this pair would get; 1 for a kernel without.
    landmarks : int
    known : Known or None
    """

    name: str
    source: Basis
    target: Basis
    descriptors_s: torch.Tensor
    descriptors_t: torch.Tensor
    samples: torch.Tensor
    gamma: float
    landmarks: int
    known: Known | None

    def swapped(self) -> Lesson:
        """The pair the other way round, without its truth."""
        return replace(
            self,
            source=self.target,
            target=self.source,
            descriptors_s=self.descriptors_t,
            descriptors_t=self.descriptors_s,
            known=None,
        )


def lesson(
    source: Shape,
    target: Shape,
    config: Config,
    *,
    landmarks: Any = None,
    truth: tuple[Any, Any] | None = None,
    samples: int = 150,
    rng: int | np.random.Generator = 0,
) -> Lesson:
    """What learning needs of two shapes that were prepared with ``config``.

    Parameters
    ----------
    landmarks : (l, 2) whole numbers, optional
        Pairs "source, target", as for :func:`kfmaps.match`.
    truth : pair of arrays (q,), (q,), optional
        Corresponding vertices of source and target.
    samples : int
        Nyström samples while learning; fewer than a match takes, since thousands of fits are made.

    Raises
    ------
    InvalidInput
        When landmarks or truth do not fit the shapes, or the configuration asks for what cannot be learned with.
    """
    if config.weights.orientation or config.exact:
        got = "an orientation term" if config.weights.orientation else "the exact kernel"
        raise refuse("settings to learn from", "features and the terms of the paper", got, "leave it out")
    asked = config.formulation
    if replace(Formulation(), mask=asked.mask, mask_power=asked.mask_power) != asked:
        remedy = "leave the formulation out but for its mask"
        raise refuse("settings to learn from", "an energy that is quadratic in one map", repr(asked), remedy)
    draw = np.random.default_rng(rng)
    pairs = check_landmark_pairs(landmarks, source, target)
    parts = [sample_shape(shape, config.fit_samples, pairs[:, i]) for i, shape in enumerate((source, target))]
    bases = (parts[0].shape.basis, parts[1].shape.basis)
    marks = np.stack([part.landmarks for part in parts], axis=1)
    both = pair_descriptors(parts[0].shape, parts[1].shape, bases, config.descriptors, marks, None)
    rows = [D[farthest_descriptors(D, min(samples // 2, len(D)), draw)] for D in (both.source, both.target)]
    k = config.basis.functions
    found = resolve_kernel(config.kernel, np.concatenate(rows), config.sharpness)
    known = None if truth is None else _known(source, target, (parts[0].vertices, parts[1].vertices), k, truth)
    return Lesson(
        f"{source.name} {target.name}",
        bases[0].truncate(k).to("torch"),
        bases[1].truncate(k).to("torch"),
        torch.from_numpy(to_numpy(both.source)),
        torch.from_numpy(to_numpy(both.target)),
        torch.from_numpy(np.concatenate(rows)),
        float(found.gamma or 1.0) if isinstance(found, Gaussian | Laplacian) else 1.0,
        len(pairs),
        known,
    )


def _known(
    source: Shape,
    target: Shape,
    points: tuple[np.ndarray, np.ndarray],
    k: int,
    truth: tuple[Any, Any],
) -> Known:
    """The truth at no more than :data:`JUDGED` correspondences, of a fit made from ``points`` of source and target."""
    true_s, true_t = (np.asarray(side) for side in truth)
    for side, shape in ((true_s, source), (true_t, target)):
        name, n = f"truth of {shape.name}", len(shape.mesh.vertices)
        check(side, name, shape=true_s.shape, finite=False, remedy="give as many vertices on both")
        if side.ndim != 1 or len(side) < k or side.min() < 0 or side.max() >= n:
            got = f"shape {side.shape}" + (f", {side.min()} to {side.max()}" if side.size else "")
            raise refuse(name, f"at least {k} vertices, 0 to {n - 1}", got, "take the lists of these shapes")
    functions_s, functions_t = (shape.basis.truncate(k).functions for shape in (source, target))
    wanted = np.linalg.lstsq(functions_t[true_t], functions_s[true_s], rcond=None)[0]
    # The same lines for every pair of a collection: distances from them can be kept with the shape.
    lines = np.random.default_rng(0)
    chosen = np.sort(lines.choice(len(true_s), min(JUDGED, len(true_s)), replace=False))
    distances = _distances(source.mesh, true_s[chosen])
    if len(points[0]) < distances.shape[1]:
        distances = distances[:, points[0]]
    rows = [
        nearest(shape.mesh.vertices[side[chosen]], shape.mesh.vertices[kept])
        for shape, side, kept in zip((source, target), (true_s, true_t), points, strict=True)
    ]
    return Known(
        torch.from_numpy(wanted),
        torch.from_numpy(functions_t[true_t[chosen]]),
        torch.from_numpy(distances),
        torch.from_numpy(rows[0]),
        torch.from_numpy(rows[1]),
    )


_KEPT: WeakKeyDictionary[Mesh, dict[bytes, np.ndarray]] = WeakKeyDictionary()


def _distances(mesh: Mesh, sources: np.ndarray) -> np.ndarray:
    """Geodesic distances ``(m, n)`` float32, kept as long as the mesh is: a shape is the source of many pairs."""
    kept = _KEPT.setdefault(mesh, {})
    name = sources.tobytes()
    if name not in kept:
        kept[name] = geodesic_distances(mesh, sources).astype(np.float32)
    return kept[name]
