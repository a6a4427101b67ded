"""What can be learned: parameters that turn descriptors into a kernel, and the settings that they stand for."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import torch

from kfmaps._arrays import refuse
from kfmaps.config import Config, DescriptorConfig, Weights
from kfmaps.kernels.kernels import Gaussian, KernelLike, Laplacian, Sum, kernel_matrix, resolve_kernel
from kfmaps.kernels.transformed import Metric, Network, Scaled, forward
from kfmaps.learn.lessons import Lesson
from kfmaps.learn.names import PARTS

RIDGE = 0.1
"""Added to the variance between corresponding points, in units of the mean one of a shape's."""
SPREAD = 6.0
"""Factor from one γ of a mixture to the next, at the start."""


@dataclass(frozen=True)
class Columns:
    """How descriptors hang together: ``blocks`` of columns, of which those of the same ``kind`` share parameters.

    All landmarks are of one kind, so that what was learned does not depend on which point is the first landmark.
    """

    blocks: tuple[tuple[int, ...], ...]
    kinds: tuple[str, ...]

    @property
    def count(self) -> int:
        return sum(len(block) for block in self.blocks)


def columns(config: DescriptorConfig, landmarks: int, count: int) -> Columns:
    """The blocks of ``count`` descriptors: signature, one for each landmark, SHOT."""
    local = min(352, count) if config.shot else 0
    spectral = count - local
    marks = landmarks if config.landmark_map != "none" and config.layout == "even" else 0
    share = 0.0 if config.signature == "none" else config.signature_share
    each = max(1, int((1 - share) * config.count) // marks) if marks else 0
    first = spectral - each * marks
    sizes = [("signature", first), *[("landmark", each)] * marks, ("shot", local)]
    ends = np.cumsum([0, *[size for _, size in sizes]])
    found = [(kind, tuple(range(a, b))) for (kind, _), a, b in zip(sizes, ends[:-1], ends[1:], strict=True) if b > a]
    return Columns(tuple(block for _, block in found), tuple(kind for kind, _ in found))


class Model(torch.nn.Module):
    """Parameters θ of a kernel and an energy; :meth:`settings` gives them as a configuration.

    It starts as the configuration that it is made from: nothing is random but the inner layer of a network.

    Parameters
    ----------
    config : Config
        What is not learned stays as it says.
    lessons : sequence of Lesson
        Of which only descriptors are looked at: their number, automatic γ and directions.
    parts : sequence of str
        Keys of :data:`kfmaps.learn.names.PARTS`.
    rank : int, or mapping of "signature", "landmark", "shot" to int
        Rows of the metric for each kind; a number alone is for the signature and SHOT, and half as many for each
        landmark.
    components : int
        Kernels of a mixture.
    hidden, outputs : int
        Sizes of the network.
    seed : int
    """

    def __init__(
        self,
        config: Config,
        lessons: Sequence[Lesson],
        parts: Sequence[str],
        *,
        rank: int | Mapping[str, int] = 8,
        components: int = 3,
        hidden: int = 16,
        outputs: int = 8,
        seed: int = 0,
    ) -> None:
        super().__init__()
        unknown = [part for part in parts if part not in PARTS]
        if unknown or not parts:
            raise refuse("what to learn", "some of " + ", ".join(PARTS), ", ".join(unknown) or "none", "name them")
        if "ard" in parts and "metric" in parts:
            raise refuse("what to learn", "weights or a metric", "both", "the metric holds weights already")
        kernel = config.kernel
        if {"gamma", "mixture"} & set(parts) and not isinstance(kernel, Gaussian | Laplacian):
            raise refuse("kernel to learn", "Gaussian or Laplacian for γ or a mixture", repr(kernel), "choose one")
        counts = {(lesson.landmarks, lesson.descriptors_s.shape[1]) for lesson in lessons}
        if len(counts) != 1:
            got = f"{sorted(counts)}"
            raise refuse("pairs", "equally many landmarks and descriptors on all", got, "give as many to each")
        ((landmarks, count),) = counts
        self.config, self.parts = config, tuple(parts)
        self.columns = columns(config.descriptors, landmarks, count)
        self.kernel = kernel
        if isinstance(kernel, Gaussian | Laplacian):
            start = float(np.log(np.median([lesson.gamma for lesson in lessons])))
            steps = components if "mixture" in parts else 1
            middle = np.arange(steps) - steps // 2
            self._add("log_gamma", start + np.log(SPREAD) * middle, {"gamma", "mixture"})
            # The middle kernel begins alone but for a hundredth, through which the others can grow.
            self._add("log_share", np.where(middle == 0, 0.0, np.log(0.01)), {"mixture"})
        else:
            self.kernel = resolve_kernel(kernel, lessons[0].samples.numpy(), config.sharpness)
        weights = config.weights
        free = [name for name in ("descriptors", "laplacian") if getattr(weights, name) > 0]
        self.terms = tuple(free)
        self._add("log_terms", np.log([getattr(weights, name) for name in free]), {"terms"})
        kinds = dict(zip(self.columns.kinds, self.columns.blocks, strict=True))
        if "ard" in parts:
            for kind, block in kinds.items():
                self._add(f"log_weight_{kind}", np.zeros(len(block)), {"ard"})
        if "metric" in parts:
            for kind in kinds:
                wanted = rows_of(rank, kind)
                self._add(f"metric_{kind}", _directions(lessons, self.columns, kind, wanted), {"metric"})
        if "network" in parts:
            seen = len(self.network_columns)
            draw = np.random.default_rng(seed)
            inner = np.hstack([draw.normal(size=(hidden, seen)) * 2.0, np.zeros((hidden, 1))])
            self._add("layer_0", inner, {"network"})
            self._add("layer_1", 0.01 * draw.normal(size=(outputs, hidden + 1)), {"network"})
        if "metric" in parts and isinstance(kernel, Gaussian | Laplacian):
            # The metric has another scale than the descriptors.
            with torch.no_grad():
                lifted = [self.lift(lesson.samples).numpy() for lesson in lessons]
                middle = np.log(np.median([lesson.gamma for lesson in lessons]))
                self._tensor("log_gamma").add_(np.log(_width(kernel, lifted, config.sharpness)) - middle)

    def _add(self, name: str, values: Any, parts: set[str]) -> None:
        tensor = torch.tensor(np.asarray(values), dtype=torch.float64)
        learned = bool(parts & set(self.parts))
        self.register_parameter(name, torch.nn.Parameter(tensor, requires_grad=learned))

    def _tensor(self, name: str) -> torch.Tensor:
        return self.get_parameter(name)

    @property
    def network_columns(self) -> tuple[int, ...]:
        """Columns, after the metric, of everything but landmarks; of everything when there is nothing else."""
        found, start = [], 0
        for kind, block in zip(self.columns.kinds, self.columns.blocks, strict=True):
            size = len(self._tensor(f"metric_{kind}")) if "metric" in self.parts else len(block)
            if kind != "landmark":
                found += range(start, start + size)
            start += size
        return tuple(found or range(start))

    def lift(self, D: torch.Tensor) -> torch.Tensor:
        """Transformed descriptors ``(n, r)`` of ``D (n, d)``; the kernel is one of these."""
        pieces = []
        for kind, block in zip(self.columns.kinds, self.columns.blocks, strict=True):
            part = D[:, block[0] : block[-1] + 1]
            if "ard" in self.parts:
                part = part * torch.exp(self._tensor(f"log_weight_{kind}"))[None, :]
            elif "metric" in self.parts:
                part = part @ self._tensor(f"metric_{kind}").T
            pieces.append(part)
        X = torch.cat(pieces, dim=1)
        if "network" in self.parts:
            layers = (self._tensor("layer_0"), self._tensor("layer_1"))
            X = torch.cat([X, forward(layers, X[:, list(self.network_columns)])], dim=1)
        return X

    def matrix(self, X: torch.Tensor, Y: torch.Tensor) -> torch.Tensor:
        """Kernel values ``(n, m)`` of rows that :meth:`lift` returned."""
        if not isinstance(self.kernel, Gaussian | Laplacian):
            return kernel_matrix(self.kernel, X, Y)
        gammas, shares = torch.exp(self._tensor("log_gamma")), torch.exp(self._tensor("log_share"))
        parts = [shares[i] * opened(self.kernel, gamma=gammas[i])(X, Y) for i in range(len(gammas))]
        return torch.stack(parts).sum(dim=0) if len(parts) > 1 else parts[0]

    def weights(self) -> dict[str, torch.Tensor | float]:
        """Of the energy's terms."""
        learned = torch.exp(self._tensor("log_terms"))
        own: dict[str, torch.Tensor | float] = {name: learned[i] for i, name in enumerate(self.terms)}
        return {**own, "commutativity": self.config.weights.commutativity}

    def settings(self) -> Config:
        """The configuration that the parameters stand for, of plain numbers."""

        def plain(name: str) -> np.ndarray:
            return self._tensor(name).detach().numpy()

        kernel: KernelLike = self.kernel
        if isinstance(kernel, Gaussian | Laplacian):
            each = [replace(kernel, gamma=float(np.exp(g))) for g in plain("log_gamma")]
            shared = [Scaled(k, float(np.exp(a))) for k, a in zip(each, plain("log_share"), strict=True)]
            kernel = each[0] if len(each) == 1 else shared[0]
            for other in shared[1:]:
                kernel = Sum(kernel, other)
        if "network" in self.parts:
            kernel = Network(kernel, tuple(plain(f"layer_{i}").tolist() for i in (0, 1)), self.network_columns)
        marks = self.columns.kinds.count("landmark") if self.config.descriptors.layout == "even" else None
        if "ard" in self.parts:
            named = [np.exp(plain(f"log_weight_{kind}")) for kind in self.columns.kinds]
            kernel = Metric(kernel, np.concatenate(named).tolist(), marks)
        if "metric" in self.parts:
            kernel = Metric(kernel, self._whole_metric(plain).tolist(), marks)
        terms = np.exp(plain("log_terms"))
        changes = {name: float(terms[i]) for i, name in enumerate(self.terms)} if "terms" in self.parts else {}
        weights: Weights = replace(self.config.weights, **changes)
        return replace(self.config, kernel=kernel, weights=weights)

    def _whole_metric(self, plain: Any) -> np.ndarray:
        """The matrix (r, d) of all blocks' metrics."""
        matrices = [plain(f"metric_{kind}") for kind in self.columns.kinds]
        whole = np.zeros((sum(len(m) for m in matrices), self.columns.count))
        row = 0
        for matrix, block in zip(matrices, self.columns.blocks, strict=True):
            whole[row : row + len(matrix), list(block)] = matrix
            row += len(matrix)
        return whole


def rows_of(rank: int | Mapping[str, int], kind: str) -> int:
    """How many rows the metric of a kind of descriptors has."""
    if isinstance(rank, int):
        return max(1, rank // 2) if kind == "landmark" else rank
    if rank.get(kind, 0) < 1:
        raise refuse("rank", f"rows for {kind}", repr(dict(rank)), "name as many kinds as there are")
    return rank[kind]


def _width(kernel: Gaussian | Laplacian, lifted: Sequence[np.ndarray], sharpness: float) -> float:
    """The automatic γ for transformed samples of pairs: the median over them."""
    found = [resolve_kernel(replace(kernel, gamma=None), X, sharpness) for X in lifted]
    return float(np.median([k.gamma or 1.0 for k in found if isinstance(k, Gaussian | Laplacian)]))


def opened(kernel: Any, **values: Any) -> Any:
    """A kernel's record with tensors in place of its numbers, unchecked: the same formula, with derivatives."""
    record = copy.copy(kernel)
    for name, value in values.items():
        object.__setattr__(record, name, value)
    return record


def _directions(lessons: Sequence[Lesson], columns: Columns, kind: str, rank: int) -> np.ndarray:
    """Where the metric of a kind of descriptors starts, (rank, d).

    The directions in which points of a shape differ most, measured by how much corresponding points of two shapes do
    (linear discriminant analysis, Fisher 1936); each row is scaled so that the latter is 1. Where no truth is known the
    strongest directions.
    """
    spread, gap = 0.0, 0.0
    for lesson in lessons:
        sides = (lesson.descriptors_s.numpy(), lesson.descriptors_t.numpy())
        masses = [basis.mass.numpy() / float(basis.mass.sum()) for basis in (lesson.source, lesson.target)]
        for name, block in zip(columns.kinds, columns.blocks, strict=True):
            if name != kind:
                continue
            parts = [D[:, block[0] : block[-1] + 1] for D in sides]
            middle = sum(m @ part for m, part in zip(masses, parts, strict=True)) / 2
            for m, part in zip(masses, parts, strict=True):
                spread = spread + ((part - middle) * m[:, None]).T @ (part - middle) / 2
            if lesson.known is not None:
                moved = parts[0][lesson.known.rows_s.numpy()] - parts[1][lesson.known.rows_t.numpy()]
                gap = gap + moved.T @ moved / len(moved)
    spread = np.asarray(spread) / len(lessons)
    whole = float(np.trace(spread)) / len(spread)
    if np.ndim(gap) == 0:
        return np.linalg.eigh(spread)[1][:, ::-1][:, :rank].T.copy()
    noise = np.asarray(gap) / len(lessons) + RIDGE * whole * np.eye(len(spread))
    root = np.linalg.inv(np.linalg.cholesky(noise))
    return (root.T @ np.linalg.eigh(root @ spread @ root.T)[1][:, ::-1][:, :rank]).T.copy()
