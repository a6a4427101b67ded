"""The model with its learned parameters, the settings that they stand for, and the loss of a soft point map."""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from numpy.typing import ArrayLike
from scipy.linalg import block_diag

from kfmaps._arrays import refuse
from kfmaps._records import setting, settings_of, settings_record
from kfmaps.config import Config, DescriptorConfig
from kfmaps.fmap.nearest import nearest
from kfmaps.fmap.solvers import CG
from kfmaps.kernels.kernels import Gaussian, KernelLike, Laplacian, resolve_kernel
from kfmaps.kernels.transformed import Metric
from kfmaps.learn.energy import differentiable_minimum, nystrom_features, pair_energy
from kfmaps.learn.pairs import TrainingPair
from kfmaps.matching.features import spectral_shares

PARTS = ("gamma", "metric", "terms")
"""What can be learned: the width γ of the kernel, a low-rank metric on the descriptors, the weights of the terms."""

RANK = {"signature": 2, "landmark": 1, "shot": 2}
"""Rows of the metric for each kind of descriptors."""

_RIDGE = 0.1  # added to the variance between corresponding points, in units of the mean variance on a shape

_Blocks = list[tuple[str, slice]]
"""Kind and columns of each block of descriptors. Blocks of one kind share parameters, so that the order of landmarks
does not matter."""


def _blocks(config: DescriptorConfig, landmarks: int, count: int) -> _Blocks:
    """Return the blocks of ``count`` descriptors: signature, one for each landmark, SHOT."""
    local = min(352, count) if config.shot else 0
    blocks = landmarks if config.landmark_descriptor != "none" and config.energy_sampling == "even" else 0
    each = spectral_shares(config, blocks)[1] if blocks else 0
    sizes = [("signature", count - local - each * blocks), *[("landmark", each)] * blocks, ("shot", local)]
    ends = np.cumsum([0, *[size for _, size in sizes]]).tolist()
    return [(kind, slice(a, b)) for (kind, _), a, b in zip(sizes, ends[:-1], ends[1:], strict=True) if b > a]


class Model(torch.nn.Module):
    """Parameters θ of a kernel and an energy; :meth:`settings` returns them as a configuration.

    Parameters
    ----------
    config : Config
        Settings that learning starts from; what is not learned stays. Its kernel is Gaussian or Laplacian.
    pairs : sequence of TrainingPair
        Only their descriptors and corresponding points are used.
    parts : sequence of str
        Some of :data:`PARTS`.
    rank : mapping of "signature", "landmark", "shot" to int
        Rows of the metric for each kind of descriptors.

    Raises
    ------
    InvalidInput
        On an unknown part, another kernel, and when the pairs have different descriptors.
    """

    def __init__(
        self,
        config: Config,
        pairs: Sequence[TrainingPair],
        parts: Sequence[str] = PARTS,
        *,
        rank: Mapping[str, int] = RANK,
    ) -> None:
        super().__init__()
        unknown = [part for part in parts if part not in PARTS]
        if unknown or not parts:
            raise refuse("what to learn", "some of " + ", ".join(PARTS), ", ".join(unknown) or "none", "choose some")
        if not isinstance(config.kernel, Gaussian | Laplacian):
            raise refuse("kernel to learn", "Gaussian or Laplacian", repr(config.kernel), "choose one")
        counts = {(pair.n_landmarks, pair.descriptors_s.shape[1]) for pair in pairs}
        if len(counts) != 1:
            got = f"{sorted(counts)}"
            raise refuse("pairs", "equally many landmarks and descriptors on all pairs", got, "give as many to each")
        self.config, self.parts, self.kernel = config, tuple(parts), config.kernel
        self.blocks = _blocks(config.descriptors, *counts.pop())
        self.terms = tuple(name for name in ("descriptors", "laplacian") if getattr(config.weights, name) > 0)
        self._add("log_terms", np.log([getattr(config.weights, name) for name in self.terms]), "terms")
        for kind in dict(self.blocks) if "metric" in parts else ():
            if rank.get(kind, 0) < 1:
                raise refuse("rank", f"rows for {kind}", repr(dict(rank)), "name as many kinds as there are")
            self._add(f"metric_{kind}", _directions(pairs, self.blocks, kind, rank[kind]), "metric")
        # A metric changes the scale of descriptors, so the configured width does not fit.
        kernel = replace(self.kernel, gamma=None) if "metric" in parts else self.kernel
        with torch.no_grad():
            samples = [self.transform(pair.samples).numpy() for pair in pairs]
        gammas: list[Any] = [resolve_kernel(kernel, X, config.bandwidth_scale) for X in samples]
        self._add("log_gamma", np.log(np.median([resolved.gamma for resolved in gammas])), "gamma")

    def _add(self, name: str, values: ArrayLike, part: str) -> None:
        tensor = torch.tensor(np.asarray(values), dtype=torch.float64)
        self.register_parameter(name, torch.nn.Parameter(tensor, requires_grad=part in self.parts))

    def transform(self, D: torch.Tensor) -> torch.Tensor:
        """Return transformed descriptors ``(n, r)`` of ``D (n, d)``, the arguments of :meth:`kernel_matrix`."""
        if "metric" not in self.parts:
            return D
        pieces = [D[:, block] @ self.get_parameter(f"metric_{kind}").T for kind, block in self.blocks]
        return torch.cat(pieces, dim=1)

    def kernel_matrix(self, X: torch.Tensor, Y: torch.Tensor) -> torch.Tensor:
        """Return kernel values ``(n, m)`` of rows ``X`` and ``Y`` that :meth:`transform` returned."""
        return _bind(self.kernel, gamma=torch.exp(self.get_parameter("log_gamma")))(X, Y)

    def weights(self) -> dict[str, torch.Tensor | float]:
        """Return the weights of the energy's terms."""
        learned = torch.exp(self.get_parameter("log_terms"))
        own: dict[str, torch.Tensor | float] = {name: learned[i] for i, name in enumerate(self.terms)}
        return {**own, "commutativity": self.config.weights.commutativity}

    def settings(self, parameters: Mapping[str, torch.Tensor] | None = None) -> Config:
        """Return the configuration that ``parameters`` stand for (by default the model's own), in plain numbers."""
        values = {name: p.detach().numpy() for name, p in (parameters or dict(self.named_parameters())).items()}
        kernel: KernelLike = replace(self.kernel, gamma=float(np.exp(values["log_gamma"])))
        if "metric" in self.parts:
            kinds = [kind for kind, _ in self.blocks]
            landmarks = kinds.count("landmark") if self.config.descriptors.energy_sampling == "even" else None
            whole = np.asarray(block_diag(*(values[f"metric_{kind}"] for kind in kinds)))
            kernel = Metric(kernel, tuple(map(tuple, whole.tolist())), landmarks)
        terms = zip(self.terms, np.exp(values["log_terms"]).tolist(), strict=True)
        weights = replace(self.config.weights, **dict(terms)) if "terms" in self.parts else self.config.weights
        return replace(self.config, kernel=kernel, weights=weights)


def _bind(kernel: Any, **values: Any) -> Any:
    """Return a kernel's record with tensors in place of its numbers, unchecked: the same formula, with derivatives."""
    record = copy.copy(kernel)
    for name, value in values.items():
        object.__setattr__(record, name, value)
    return record


def _directions(pairs: Sequence[TrainingPair], blocks: _Blocks, kind: str, rank: int) -> np.ndarray:
    """Return the start of the metric of a kind of descriptors, (rank, d).

    The directions in which points of a shape differ most, measured by how much corresponding points of two shapes do
    (linear discriminant analysis, Fisher 1936); each row is scaled so that the latter is 1.
    """
    variance, noise = np.zeros(()), np.zeros(())
    for pair in pairs:
        masses = [basis.mass.numpy() / float(basis.mass.sum()) for basis in (pair.source, pair.target)]
        for block in (block for other, block in blocks if other == kind):
            parts = [D.numpy()[:, block] for D in (pair.descriptors_s, pair.descriptors_t)]
            mean = sum(m @ part for m, part in zip(masses, parts, strict=True)) / 2
            for m, part in zip(masses, parts, strict=True):
                variance = variance + ((part - mean) * m[:, None]).T @ (part - mean) / 2
            gap = parts[0][pair.points_s.numpy()] - parts[1][pair.points_t.numpy()]
            noise = noise + gap.T @ gap / len(gap)
    variance = variance / len(pairs)
    noise = noise / len(pairs) + _RIDGE * float(np.trace(variance)) / len(variance) * np.eye(len(variance))
    root = np.linalg.inv(np.linalg.cholesky(noise))
    return (root.T @ np.linalg.eigh(root @ variance @ root.T)[1][:, ::-1][:, :rank]).T.copy()


@settings_record
class TrainingOptions:
    """How to learn. Most parameters are logarithms, so that a rate of 0.1 changes a weight by about a tenth a step."""

    epochs: int = setting(5, "largest number of passes through all pairs", low=1)
    batch: int = setting(2, "number of pairs whose gradients are averaged for one step", low=1)
    rate: float = setting(0.1, "Adam's, which falls to zero over the epochs as half a cosine", above=0)
    patience: int = setting(3, "epochs without a better mean over held-out pairs, after which learning stops", low=1)
    temperature: float = setting(0.03, "of soft point maps, see :func:`soft_point_map`", above=0)
    seconds: float = setting(math.inf, "no further epoch begins that would, at the pace so far, end later")
    solver: CG = setting(lambda: CG(rtol=1e-4, max_iter=500), "for maps and derivatives")
    operator_rtol: float = setting(1e-3, "part of the features' weight that commutativity leaves out", low=0, below=1)
    seed: int = setting(0, "for the order of the pairs", low=0)

    def __post_init__(self) -> None:
        if not self.seconds > 0:
            raise refuse("seconds", "a number above zero", repr(self.seconds), "leave it out for no limit")
        for name, one in settings_of(TrainingOptions).items():
            if name != "seconds":
                one.check(getattr(self, name), name, "compare with kfmaps learn --help")


def functional_map(model: Model, pair: TrainingPair, solver: CG, operator_rtol: float = 0.0) -> torch.Tensor:
    """Return the map ``C (k, k)`` that minimises the model's energy of a ``pair``, differentiable in its parameters.

    ``solver`` and ``operator_rtol`` are those of :class:`TrainingOptions`.
    """
    transformed = [model.transform(D) for D in (pair.descriptors_s, pair.descriptors_t, pair.samples)]
    W_s, W_t = nystrom_features(model.kernel_matrix, *transformed)
    formulation = model.config.formulation
    energy = pair_energy(pair.source, pair.target, W_s, W_t, model.weights(), operator_rtol, formulation)
    return differentiable_minimum(energy, solver)


def pair_loss(model: Model, pair: TrainingPair, options: TrainingOptions) -> torch.Tensor:
    """Return the expected geodesic error, in √area, of the soft point map of a ``pair``.

    ``options`` are those of :func:`~kfmaps.learn.training.learn`.
    """
    C = functional_map(model, pair, options.solver, options.operator_rtol)
    distances = pair.distances.to(C.dtype)
    return geodesic_loss(C, pair.source.functions, pair.functions_t, distances, options.temperature)


def point_error(model: Model, pair: TrainingPair, options: TrainingOptions) -> float:
    """Return the mean geodesic error of the raw point map, in √area, at the known correspondences of a ``pair``.

    Of ``options`` only the solver and the truncation of operators count.
    """
    with torch.no_grad():
        C = functional_map(model, pair, options.solver, options.operator_rtol)
        images = (pair.source.functions @ C.T).numpy()
    points = nearest(pair.functions_t.numpy(), images)
    return float(pair.distances.numpy()[np.arange(len(points)), points].mean())


def soft_point_map(queries: torch.Tensor, points: torch.Tensor, temperature: float) -> torch.Tensor:
    """Return the soft map ``(m, n)`` of each of the ``queries (m, k)`` among the ``points (n, k)``; rows sum to 1.

    ``softmax(−‖x − y‖² / (temperature · s))`` with ``s`` the mean squared distance to the nearest point, so that
    ``temperature`` has no unit; towards 0 it is the map to the nearest.
    """
    squares = (queries**2).sum(dim=1)[:, None] + (points**2).sum(dim=1)[None, :] - 2 * queries @ points.T
    smallest = squares.detach().min(dim=1, keepdim=True).values
    scale = temperature * smallest.clamp(min=0.0).mean() + 1e-12 * squares.detach().abs().mean() + 1e-300
    return torch.softmax((smallest - squares) / scale, dim=1)


def geodesic_loss(
    C: torch.Tensor, functions_s: torch.Tensor, functions_t: torch.Tensor, distances: torch.Tensor, temperature: float
) -> torch.Tensor:
    """Return the mean expected geodesic error of the soft point map of ``C``, in units of √area.

    Parameters
    ----------
    C : (k_t, k_s) tensor
    functions_s : (n, k_s) tensor
        At all points of the source.
    functions_t : (m, k_t) tensor
        At the evaluated points of the target.
    distances : (m, n) tensor
        From the true point of each of these, on the source, to each point of the source.
    temperature : float
        See :func:`soft_point_map`.
    """
    soft = soft_point_map(functions_t, functions_s @ C.T, temperature)
    return (soft * distances).sum(dim=1).mean()
