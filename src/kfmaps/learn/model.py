"""What can be learned: parameters that turn descriptors into a kernel, and the settings that they stand for."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import torch
from numpy.typing import ArrayLike
from scipy.linalg import block_diag

from kfmaps._arrays import refuse
from kfmaps.config import Config, DescriptorConfig
from kfmaps.kernels.kernels import Gaussian, KernelLike, Laplacian, Sum, kernel_matrix, resolve_kernel
from kfmaps.kernels.transformed import Metric, Network, Scaled, forward
from kfmaps.learn.pairs import TrainingPair
from kfmaps.matching.features import spectral_shares

PARTS = {
    "gamma": "the width γ of the kernel",
    "ard": "a weight for each descriptor",
    "metric": "a low-rank metric M = L Lᵀ on the descriptors",
    "mixture": "shares of kernels of several widths",
    "terms": "the weights of the energy's terms",
    "network": "a small network on the signature and SHOT",
}
"""Names and meanings of what can be learned."""

_RIDGE = 0.1  # added to the variance between corresponding points, in units of the mean variance on a shape
_COMPONENTS = 3  # kernels of a mixture
_HIDDEN, _OUTPUTS = 16, 8  # sizes of the network
_GAMMA_RATIO = 6.0  # ratio of one γ of a mixture to the previous, at the start


_Blocks = list[tuple[str, slice]]
"""Kind and columns of each block of descriptors. Those of one kind share parameters, so that what is learned does not
depend on which point is the first landmark."""


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

    It starts as the configuration that it is made from: only the inner layer of a network is random.

    Parameters
    ----------
    config : Config
        Settings that learning starts from; what is not learned stays.
    pairs : sequence of TrainingPair
        Only their descriptors are used: their number, samples and directions.
    parts : sequence of str
        Keys of :data:`PARTS`.
    rank : int, or mapping of "signature", "landmark", "shot" to int
        Rows of the metric for each kind of descriptors; a number alone is for the signature and SHOT, and half as many
        for each landmark.
    seed : int
        For the network's start.

    Raises
    ------
    InvalidInput
        When the parts do not go together, or with the kernel, or the pairs have different descriptors.
    """

    def __init__(
        self,
        config: Config,
        pairs: Sequence[TrainingPair],
        parts: Sequence[str],
        *,
        rank: int | Mapping[str, int] = 8,
        seed: int = 0,
    ) -> None:
        super().__init__()
        _check_parts(parts, config.kernel)
        counts = {(pair.n_landmarks, pair.descriptors_s.shape[1]) for pair in pairs}
        if len(counts) != 1:
            got = f"{sorted(counts)}"
            raise refuse("pairs", "equally many landmarks and descriptors on all pairs", got, "give as many to each")
        self.config, self.parts, self.kernel = config, tuple(parts), config.kernel
        self.blocks = _blocks(config.descriptors, *counts.pop())
        self.terms = tuple(name for name in ("descriptors", "laplacian") if getattr(config.weights, name) > 0)
        self._add("log_terms", np.log([getattr(config.weights, name) for name in self.terms]), {"terms"})
        for kind, block in dict(self.blocks).items():
            if "ard" in parts:
                self._add(f"log_weight_{kind}", np.zeros(block.stop - block.start), {"ard"})
            if "metric" in parts:
                self._add(f"metric_{kind}", _directions(pairs, self.blocks, kind, _rank_of(rank, kind)), {"metric"})
        if "network" in parts:
            draw = np.random.default_rng(seed)
            inner = np.hstack([draw.normal(size=(_HIDDEN, len(self.network_columns))) * 2.0, np.zeros((_HIDDEN, 1))])
            self._add("layer_0", inner, {"network"})
            self._add("layer_1", 0.01 * draw.normal(size=(_OUTPUTS, _HIDDEN + 1)), {"network"})
        samples, kernel = [pair.samples.numpy() for pair in pairs], self.kernel
        if not isinstance(kernel, Gaussian | Laplacian):
            self.kernel = resolve_kernel(kernel, samples[0], config.bandwidth_scale)
            return
        if "metric" in parts:  # of another scale than the descriptors
            with torch.no_grad():
                samples, kernel = [self.transform(pair.samples).numpy() for pair in pairs], replace(kernel, gamma=None)
        known = [resolve_kernel(kernel, X, config.bandwidth_scale) for X in samples]
        gamma = np.median([k.gamma or 1.0 for k in known if isinstance(k, Gaussian | Laplacian)])
        middle = np.arange(_COMPONENTS if "mixture" in parts else 1)
        middle = middle - len(middle) // 2
        self._add("log_gamma", np.log(gamma) + np.log(_GAMMA_RATIO) * middle, {"gamma", "mixture"})
        # The middle kernel begins alone but for a hundredth, through which the others can grow.
        self._add("log_share", np.where(middle == 0, 0.0, np.log(0.01)), {"mixture"})

    def _add(self, name: str, values: ArrayLike, parts: set[str]) -> None:
        tensor = torch.tensor(np.asarray(values), dtype=torch.float64)
        self.register_parameter(name, torch.nn.Parameter(tensor, requires_grad=bool(parts & set(self.parts))))

    @property
    def network_columns(self) -> tuple[int, ...]:
        """Return the columns, after the metric, of all but landmarks; of all when there is nothing else."""
        found, start = [], 0
        for kind, block in self.blocks:
            size = len(self.get_parameter(f"metric_{kind}")) if "metric" in self.parts else block.stop - block.start
            if kind != "landmark":
                found += range(start, start + size)
            start += size
        return tuple(found or range(start))

    def transform(self, D: torch.Tensor) -> torch.Tensor:
        """Return transformed descriptors ``(n, r)`` of ``D (n, d)``, the arguments of :meth:`kernel_matrix`."""
        pieces = []
        for kind, block in self.blocks:
            piece = D[:, block]
            if "ard" in self.parts:
                piece = piece * torch.exp(self.get_parameter(f"log_weight_{kind}"))[None, :]
            elif "metric" in self.parts:
                piece = piece @ self.get_parameter(f"metric_{kind}").T
            pieces.append(piece)
        X = torch.cat(pieces, dim=1)
        if "network" in self.parts:
            layers = (self.get_parameter("layer_0"), self.get_parameter("layer_1"))
            X = torch.cat([X, forward(layers, X[:, list(self.network_columns)])], dim=1)
        return X

    def kernel_matrix(self, X: torch.Tensor, Y: torch.Tensor) -> torch.Tensor:
        """Return kernel values ``(n, m)`` of rows ``X`` and ``Y`` that :meth:`transform` returned."""
        if not isinstance(self.kernel, Gaussian | Laplacian):
            return kernel_matrix(self.kernel, X, Y)
        gammas, shares = (torch.exp(self.get_parameter(name)) for name in ("log_gamma", "log_share"))
        parts = [shares[i] * _bind(self.kernel, gamma=gammas[i])(X, Y) for i in range(len(gammas))]
        return torch.stack(parts).sum(dim=0) if len(parts) > 1 else parts[0]

    def weights(self) -> dict[str, torch.Tensor | float]:
        """Return the weights of the energy's terms."""
        learned = torch.exp(self.get_parameter("log_terms"))
        own: dict[str, torch.Tensor | float] = {name: learned[i] for i, name in enumerate(self.terms)}
        return {**own, "commutativity": self.config.weights.commutativity}

    def settings(self, parameters: Mapping[str, torch.Tensor] | None = None) -> Config:
        """Return the configuration that ``parameters`` stand for (by default the model's own), in plain numbers."""
        values = {name: p.detach().numpy() for name, p in (parameters or dict(self.named_parameters())).items()}
        kernel: KernelLike = self.kernel
        if isinstance(kernel, Gaussian | Laplacian):
            each = [replace(kernel, gamma=float(np.exp(g))) for g in values["log_gamma"]]
            shared = [Scaled(k, float(np.exp(a))) for k, a in zip(each, values["log_share"], strict=True)]
            kernel = each[0] if len(each) == 1 else shared[0]
            for other in shared[1:]:
                kernel = Sum(kernel, other)
        if "network" in self.parts:
            layers = tuple(values[name].tolist() for name in ("layer_0", "layer_1"))
            kernel = Network(kernel, layers, self.network_columns)
        kinds = [kind for kind, _ in self.blocks]
        landmarks = kinds.count("landmark") if self.config.descriptors.energy_sampling == "even" else None
        if "ard" in self.parts:
            weights = [np.exp(values[f"log_weight_{kind}"]) for kind in kinds]
            kernel = Metric(kernel, np.concatenate(weights).tolist(), landmarks)
        if "metric" in self.parts:
            whole = np.asarray(block_diag(*(values[f"metric_{kind}"] for kind in kinds)))
            kernel = Metric(kernel, tuple(map(tuple, whole.tolist())), landmarks)
        terms = zip(self.terms, np.exp(values["log_terms"]).tolist(), strict=True)
        weights = replace(self.config.weights, **dict(terms)) if "terms" in self.parts else self.config.weights
        return replace(self.config, kernel=kernel, weights=weights)


def _check_parts(parts: Sequence[str], kernel: KernelLike) -> None:
    unknown = [part for part in parts if part not in PARTS]
    if unknown or not parts:
        raise refuse("what to learn", "some of " + ", ".join(PARTS), ", ".join(unknown) or "none", "choose among them")
    if "ard" in parts and "metric" in parts:
        raise refuse("what to learn", "weights or a metric", "both", "the metric holds weights already")
    if {"gamma", "mixture"} & set(parts) and not isinstance(kernel, Gaussian | Laplacian):
        raise refuse("kernel to learn", "Gaussian or Laplacian for γ or a mixture", repr(kernel), "choose one")


def _rank_of(rank: int | Mapping[str, int], kind: str) -> int:
    """Return the number of rows of the metric of a kind of descriptors."""
    if isinstance(rank, int):
        return max(1, rank // 2) if kind == "landmark" else rank
    if rank.get(kind, 0) < 1:
        raise refuse("rank", f"rows for {kind}", repr(dict(rank)), "name as many kinds as there are")
    return rank[kind]


def _bind(kernel: Any, **values: Any) -> Any:
    """Return a kernel's record with tensors in place of its numbers, unchecked: the same formula, with derivatives."""
    record = copy.copy(kernel)
    for name, value in values.items():
        object.__setattr__(record, name, value)
    return record


def _directions(pairs: Sequence[TrainingPair], blocks: _Blocks, kind: str, rank: int) -> np.ndarray:
    """Return the start of the metric of a kind of descriptors, (rank, d).

    The directions in which points of a shape differ most, measured by how much corresponding points of two shapes do
    (linear discriminant analysis, Fisher 1936); each row is scaled so that the latter is 1. Without any truth the
    directions in which points differ most.
    """
    variance, noise = 0.0, 0.0
    for pair in pairs:
        masses = [basis.mass.numpy() / float(basis.mass.sum()) for basis in (pair.source, pair.target)]
        for block in (block for other, block in blocks if other == kind):
            parts = [D.numpy()[:, block] for D in (pair.descriptors_s, pair.descriptors_t)]
            mean = sum(m @ part for m, part in zip(masses, parts, strict=True)) / 2
            for m, part in zip(masses, parts, strict=True):
                variance = variance + ((part - mean) * m[:, None]).T @ (part - mean) / 2
            if pair.truth is not None:
                gap = parts[0][pair.truth.points_s.numpy()] - parts[1][pair.truth.points_t.numpy()]
                noise = noise + gap.T @ gap / len(gap)
    variance = np.asarray(variance) / len(pairs)
    if np.ndim(noise) == 0:
        return np.linalg.eigh(variance)[1][:, ::-1][:, :rank].T.copy()
    noise = np.asarray(noise) / len(pairs) + _RIDGE * float(np.trace(variance)) / len(variance) * np.eye(len(variance))
    root = np.linalg.inv(np.linalg.cholesky(noise))
    return (root.T @ np.linalg.eigh(root @ variance @ root.T)[1][:, ::-1][:, :rank]).T.copy()
