"""Errors of the maps that settings give on pairs."""

from __future__ import annotations

import hashlib
import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from data_sets import DataSet, Pair
from kfmaps._arrays import KfmapsWarning
from kfmaps.config import Config, as_dict
from kfmaps.fmap.evaluate import error_curve
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import surface_area
from kfmaps.matching.finish import PostprocessedMap, refine_map
from kfmaps.matching.fit import fit
from kfmaps.matching.solve import Fit
from kfmaps.shape import Shape, prepare
from store import Job, run_jobs

THRESHOLDS = np.linspace(0, 0.25, 101)
"""Errors at which curves are kept, in units of √area."""

TOGETHER = 16
"""Settings that one job runs on a pair: enough to share the distances, few enough to lose little when stopped."""


@dataclass(frozen=True)
class Row:
    """Errors of one setting on one pair, geodesic, in units of √area of the source.

    ``mean`` and ``curve`` (at :data:`THRESHOLDS`) are of the raw map; ``refined`` is the mean after the refinement, or
    the raw one without.
    """

    mean: float
    refined: float
    curve: tuple[float, ...]
    status: str
    steps: int
    rank: int
    seconds: float


def fingerprint(config: Config) -> str:
    """Return a short text that differs when the settings do; threads do not count."""
    settings = json.dumps(as_dict(replace(config, threads=None)), sort_keys=True)
    return hashlib.sha256(settings.encode()).hexdigest()[:16]


def pair_rows(
    data_set: DataSet, pairs: Sequence[Pair], settings: Mapping[str, Config], store: Path, workers: int | None = None
) -> dict[str, list[Row]]:
    """Return a row for each pair, in the order of ``pairs``, by the name of the settings; see :func:`run_jobs`."""

    def key(pair: Pair, name: str) -> str:
        return f"{data_set} {pair} {fingerprint(settings[name])}"

    names, jobs = list(settings), []
    # Pairs of one source next to each other: a worker keeps the shapes that it has prepared.
    for pair in sorted(pairs):
        for i in range(0, len(names), TOGETHER):
            some = names[i : i + TOGETHER]
            arguments = (data_set, pair, [settings[name] for name in some])
            jobs.append(Job(tuple(key(pair, name) for name in some), measure, arguments))
    values = run_jobs(jobs, store, workers)
    return {name: [Row(**values[key(pair, name)]) for pair in pairs] for name in names}


def measure(data_set: DataSet, pair: Pair, settings: Sequence[Config]) -> list[dict[str, Any]]:
    """Fit a pair with each of ``settings`` and return the fields of their rows."""
    with warnings.catch_warnings():
        # Expected here (an indefinite tanh kernel, scanned meshes).
        warnings.simplefilter("ignore", KfmapsWarning)
        source, target = data_set.truth(pair)
        results = [fit_pair(data_set, pair, config, data_set.landmarks(pair)) for config in settings]
        distances = all_distances(data_set, pair[0])
    rows = []
    for fitted, maps in results:
        raw, refined = (distances[source, points[target]] for points in (raw_map(maps), maps.target_to_source))
        seconds = sum(fitted.seconds.values()) + sum(maps.seconds.values())
        row = {"mean": float(raw.mean()), "refined": float(refined.mean()), "seconds": round(seconds, 3)}
        row |= {"curve": np.round(error_curve(raw, THRESHOLDS), 6).tolist(), "rank": fitted.rank}
        rows.append(row | {"status": fitted.solution.status, "steps": fitted.solution.steps})
    return rows


@lru_cache(maxsize=1)
def all_distances(data_set: DataSet, name: str) -> np.ndarray:
    """Return the geodesic distances between all vertices of a shape, (n, n) float32, in units of √area.

    The next job is likely to have the same source, and then they are there already.
    """
    mesh = data_set.mesh(name)
    n = len(mesh.vertices)
    distances = np.empty((n, n), dtype=np.float32)
    for a in range(0, n, 512):
        rows = np.arange(a, min(a + 512, n))
        distances[rows] = geodesic_distances(mesh, rows) / np.sqrt(surface_area(mesh))
    return distances


def fit_pair(data_set: DataSet, pair: Pair, config: Config, landmarks: np.ndarray) -> tuple[Fit, PostprocessedMap]:
    """Fit a pair on one thread; return the fit and its point maps."""
    source, target = (prepared(data_set, name, config.n_eigenfunctions, config.basis.laplacian) for name in pair)
    config = replace(config, threads=1)
    fitted = fit(source, target, config, landmarks=landmarks, rng=0)
    return fitted, refine_map(fitted.functional_map, source, target, config)


def raw_map(maps: PostprocessedMap) -> np.ndarray:
    """Return the point map before the refinement, (n_t,)."""
    assert maps.raw_target_to_source is not None
    return maps.raw_target_to_source


@lru_cache(maxsize=128)
def prepared(data_set: DataSet, name: str, size: int, laplacian: Any = "robust") -> Shape:
    """Return a prepared shape with ``size`` eigenfunctions; kept in memory, since many pairs share it."""
    base = Config.single_fit()
    config = replace(
        base,
        basis=replace(base.basis, laplacian=laplacian),
        descriptors=replace(base.descriptors, n_eigenfunctions=size),
        refinement=None,
        threads=1,
    )
    return prepare(data_set.mesh(name), config, name=name)
