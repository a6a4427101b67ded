"""A grid search over settings on training pairs (section 7.2 of the paper)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.cli.words import UNIT
from kfmaps.config import Config
from kfmaps.descriptors.spectral import Normalisation
from kfmaps.experiments.collections import Collection, ShapePair
from kfmaps.experiments.methods import with_count
from kfmaps.experiments.pairs import Row
from kfmaps.experiments.setting import Setting, by_method
from kfmaps.kernels.kernels import Gaussian, Laplacian


@dataclass(frozen=True)
class Grid:
    """Values to try of each setting; an empty axis leaves the setting as it is.

    Attributes
    ----------
    gamma : tuple of float
        Widths of the Gaussian (or Laplacian) kernel, as numbers.
    sharpness : tuple of float
        Widths without unit, see :func:`kfmaps.kernels.kernels.resolved`. They and ``gamma`` are alternatives: both
        given, each is tried.
    normalisation : tuple of str
    alpha : tuple of float
        Weights of the Laplacian term.
    rank : tuple of int
        Nyström samples.
    descriptors : tuple of int
        Numbers of them.
    """

    gamma: tuple[float, ...] = ()
    sharpness: tuple[float, ...] = ()
    normalisation: tuple[Normalisation, ...] = ()
    alpha: tuple[float, ...] = ()
    rank: tuple[int, ...] = ()
    descriptors: tuple[int, ...] = ()

    def candidates(self, base: Config) -> dict[str, Config]:
        """Every combination, by a name that says what it changes."""
        widths: list[tuple[str, Any]] = [("gamma", value) for value in self.gamma]
        widths += [("sharpness", value) for value in self.sharpness]
        if widths and not isinstance(base.kernel, Gaussian | Laplacian):
            remedy = "leave the widths out for this kernel"
            raise refuse("grid", "a Gaussian or Laplacian kernel to vary the width of", repr(base.kernel), remedy)
        axes = [widths or [("gamma", None)]]
        for name in ("normalisation", "alpha", "rank", "descriptors"):
            axes.append([(name, value) for value in getattr(self, name)] or [(name, None)])
        found = {}
        for chosen in product(*axes):
            changes = [(name, value) for name, value in chosen if value is not None]
            label = ", ".join(f"{name} {value}" for name, value in changes) or "as it is"
            found[label] = _changed(base, dict(changes))
        return found


def _changed(config: Config, changes: dict[str, Any]) -> Config:
    kernel = config.kernel
    if "gamma" in changes and isinstance(kernel, Gaussian | Laplacian):
        config = replace(config, kernel=replace(kernel, gamma=changes["gamma"]))
    if "sharpness" in changes and isinstance(kernel, Gaussian | Laplacian):
        config = replace(config, kernel=replace(kernel, gamma=None), sharpness=changes["sharpness"])
    if "normalisation" in changes:
        config = replace(config, descriptors=replace(config.descriptors, normalisation=changes["normalisation"]))
    if "alpha" in changes:
        config = replace(config, weights=replace(config.weights, laplacian=changes["alpha"]))
    if "rank" in changes:
        config = replace(config, nystrom=replace(config.nystrom, samples=changes["rank"]))
    return with_count(config, changes["descriptors"]) if "descriptors" in changes else config


@dataclass(frozen=True)
class Tuned:
    """A grid search: ``best`` of the candidates, and a ``table`` of all, best first."""

    best: Config
    name: str
    error: float
    table: tuple[dict[str, Any], ...]


def grid_search(
    setting: Setting, base: Config, grid: Grid, pairs: Sequence[tuple[Collection, Sequence[ShapePair]]], refined: bool
) -> Tuned:
    """Try every candidate on ``pairs`` and take the one of the lowest mean error.

    Parameters
    ----------
    setting : Setting
    base : Config
        What the grid varies.
    grid : Grid
    pairs : sequence of (Collection, pairs)
        The mean is over data sets of the mean over their pairs.
    refined : bool
        Whether the refined map counts, or the raw one.
    """
    candidates = grid.candidates(base)
    if not refined:
        candidates = {name: replace(config, refinement=None) for name, config in candidates.items()}
    errors: dict[str, list[float]] = {name: [] for name in candidates}
    for collection, some in pairs:
        for name, rows in by_method(setting.rows(collection, some, candidates)).items():
            errors[name].append(float(np.mean([_error(row, refined) for row in rows])))
    order = sorted(candidates, key=lambda name: np.mean(errors[name]))
    table = [
        {
            "settings": name,
            f"mean error ({UNIT})": 100 * float(np.mean(errors[name])),
            **{c.name: 100 * value for (c, _), value in zip(pairs, errors[name], strict=True)},
            "pairs": sum(len(some) for _, some in pairs),
        }
        for name in order
    ]
    best = candidates[order[0]]
    return Tuned(replace(best, refinement=base.refinement), order[0], float(np.mean(errors[order[0]])), tuple(table))


def _error(row: Row, refined: bool) -> float:
    return row.refined if refined else row.mean
