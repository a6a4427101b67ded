"""Methods on pairs: one row of errors for each."""

from __future__ import annotations

import hashlib
import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from data_sets import Collection, ShapePair
from kfmaps._arrays import KfmapsWarning
from kfmaps.config import Config, as_dict
from kfmaps.fmap.evaluate import error_curve
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import surface_area
from kfmaps.matching.fit import Fit, fit
from kfmaps.matching.postprocess import finished
from kfmaps.shape import Shape, prepare
from store import Job, run_jobs

THRESHOLDS = np.linspace(0, 0.25, 101)
"""Errors at which curves are kept, in units of √area."""

TOGETHER = 16
"""Settings that one job runs on a pair: enough to share the distances, few enough to lose little when stopped."""

VERSION = 1
"""Raised when the meaning of a row changes, so that old ones are not taken for new."""


@dataclass(frozen=True)
class Row:
    """One method on one pair. Errors are geodesic, in units of √area of the source.

    ``mean``, ``median`` and ``curve`` (at :data:`THRESHOLDS`) are of the raw map; ``refined`` is the mean after the
    refinement, or the raw one without.
    """

    collection: str
    source: str
    target: str
    method: str
    mean: float
    median: float
    refined: float
    curve: tuple[float, ...]
    status: str
    steps: int
    rank: int
    slices: int
    kernel: str
    seconds: float


def fingerprint(config: Config) -> str:
    """A short text that differs when the settings do; threads do not count."""
    settings = {"version": VERSION, **as_dict(replace(config, threads=None))}
    return hashlib.sha256(json.dumps(settings, sort_keys=True).encode()).hexdigest()[:16]


def run_pairs(
    collection: Collection,
    pairs: Sequence[ShapePair],
    methods: Mapping[str, Config],
    store: Path,
    *,
    workers: int | None = None,
) -> list[Row]:
    """A row for each of ``pairs`` and ``methods``, methods of one pair together; see :func:`run_jobs`."""
    names = list(methods)
    jobs = []
    # Pairs of one source next to each other: a worker keeps the shapes that it has prepared.
    for pair in sorted(pairs, key=lambda pair: (pair.source, pair.target)):
        for i in range(0, len(names), TOGETHER):
            some = names[i : i + TOGETHER]
            keys = tuple(_key(collection, pair, methods[name]) for name in some)
            jobs.append(Job(keys, measure, (collection, pair, tuple(methods[name] for name in some))))
    values = run_jobs(jobs, store, workers=workers)
    return [
        _row(collection, pair, name, values[_key(collection, pair, methods[name])]) for pair in pairs for name in names
    ]


def _key(collection: Collection, pair: ShapePair, config: Config) -> str:
    size = f"{collection.vertices}" if collection.folder is None else ""
    return f"{collection.name}{size} {pair.source} {pair.target} {fingerprint(config)}"


def _row(collection: Collection, pair: ShapePair, name: str, value: dict[str, Any]) -> Row:
    rest = {**value, "curve": tuple(value["curve"])}
    return Row(collection.name, pair.source, pair.target, name, **rest)


def measure(collection: Collection, pair: ShapePair, configs: Sequence[Config]) -> list[dict[str, Any]]:
    """Fit a pair with each of ``configs`` and measure all maps at once: the fields of :class:`Row` but the names."""
    with warnings.catch_warnings():
        # Expected here (an indefinite tanh kernel, scanned meshes) and of no use a thousand times.
        warnings.simplefilter("ignore", KfmapsWarning)
        truth = collection.truth(pair)
        matches = [fitted(collection, pair, config, truth.landmarks) for config in configs]
        distances = all_distances(collection, pair.source)
    return [
        _measured(
            m,
            distances[truth.source, m.raw[truth.target]],
            distances[truth.source, m.refined[truth.target]],
        )
        for m in matches
    ]


@lru_cache(maxsize=1)
def all_distances(collection: Collection, name: str) -> np.ndarray:
    """``(n, n)`` float32 geodesic distances between all vertices of a shape, in units of √area.

    The next job is likely to have the same source, and then it costs nothing: :func:`kfmaps.geodesic_errors` would
    work out most of this matrix each time.
    """
    mesh = collection.mesh(name)
    n = len(mesh.vertices)
    found = np.empty((n, n), dtype=np.float32)
    for a in range(0, n, 512):
        rows = np.arange(a, min(a + 512, n))
        found[rows] = geodesic_distances(mesh, rows) / np.sqrt(surface_area(mesh))
    return found


@dataclass(frozen=True, eq=False)
class Fitted:
    """One fit of a pair and its point maps (n_t,), raw and refined."""

    fit: Fit
    raw: np.ndarray
    refined: np.ndarray
    seconds: float


def fitted(collection: Collection, pair: ShapePair, config: Config, landmarks: np.ndarray) -> Fitted:
    """The fit of a pair of a collection, on one thread."""
    size, laplacian = config.eigenfunctions, config.basis.laplacian
    source, target = (prepared(collection, name, size, laplacian) for name in (pair.source, pair.target))
    config = replace(config, threads=1)
    found = fit(source, target, config, landmarks=landmarks, rng=0)
    end = finished(found.functional_map, source, target, config)
    assert end.raw_target_to_source is not None  # asked for
    seconds = sum(found.seconds.values()) + sum(end.seconds.values())
    return Fitted(found, end.raw_target_to_source, end.target_to_source, seconds)


@lru_cache(maxsize=64)
def prepared(collection: Collection, name: str, size: int, laplacian: Any = "robust") -> Shape:
    """The shape of that name with ``size`` eigenfunctions; kept in memory, since many pairs share it."""
    base = Config.single_fit()
    config = replace(
        base,
        basis=replace(base.basis, laplacian=laplacian),
        descriptors=replace(base.descriptors, eigenfunctions=size),
        refinement=None,
        threads=1,
    )
    return prepare(collection.mesh(name), config, name=name)


def _measured(m: Fitted, raw: np.ndarray, refined: np.ndarray) -> dict[str, Any]:
    row = Row(
        "",
        "",
        "",
        "",
        mean=float(raw.mean()),
        median=float(np.median(raw)),
        refined=float(refined.mean()),
        curve=tuple(np.round(error_curve(raw, THRESHOLDS), 6).tolist()),
        status=m.fit.solution.status,
        steps=m.fit.solution.steps,
        rank=m.fit.rank,
        slices=m.fit.slices,
        kernel=m.fit.kernel,
        seconds=round(m.seconds, 3),
    )
    return {name: v for name, v in asdict(row).items() if name not in ("collection", "source", "target", "method")}
