"""The units of work: prepare a shape, match a pair. Each can be interrupted and started again at any time."""

from __future__ import annotations

import json
import os
import platform
import time
import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import InvalidInput, KfmapsWarning, MissingDependency, NotConverged, refuse
from kfmaps._threads import limit_threads, one_blas_thread
from kfmaps.batch.cache import cached_samples, file_digest, load_record, save_record
from kfmaps.batch.jobs import MAX_DEATHS
from kfmaps.batch.layout import Pair
from kfmaps.batch.results import CURVE_ERRORS, Result, read_result, result_path, write_result
from kfmaps.batch.run_spec import RunSpec
from kfmaps.config import Config
from kfmaps.evaluation import Accuracy, Truth, assess_if_reached, check_truth, read_truth, read_vertex_lists
from kfmaps.fmap.evaluate import coverage, error_curve
from kfmaps.geometry.mesh import Mesh, vertex_areas
from kfmaps.io import read_vertex_numbers, save_map
from kfmaps.io.landmark_files import landmark_suffix
from kfmaps.io.mapcontent import mean_confidence
from kfmaps.io.mapfile import with_files
from kfmaps.io.meshes import read_shape_mesh
from kfmaps.io.named_points import read_landmark_pairs
from kfmaps.matching.match import match
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.result import Match
from kfmaps.shape import Shape, prepare

_ATTEMPTS, MAPS = "attempts", "maps"
_MIRRORED_POINTS = 100  # points at which a map is compared with the mirrored truth
_EXPECTED = (InvalidInput, NotConverged, MissingDependency, OSError)  # errors of a single shape or pair
_DIED = f"{MAX_DEATHS} workers died while it was worked on; there may be too little memory"


@dataclass(frozen=True)
class ShapeTask:
    """One shape to prepare."""

    name: str
    path: Path  # of the mesh
    content: str  # digest of that file at the start of the run
    entry: Path  # file of the prepared shape in the cache
    folder: Path  # the output folder
    config: Config

    def __str__(self) -> str:
        return self.name

    @property
    def key(self) -> str:
        return self.entry.stem


@dataclass(frozen=True)
class Prepared:
    """Result of a :class:`ShapeTask`."""

    name: str
    reason: str = ""  # of a failure
    notes: tuple[str, ...] = ()  # warnings about the mesh


@dataclass(frozen=True)
class PairTask:
    """One pair to match."""

    pair: Pair
    folder: Path  # the output folder
    source: ShapeTask
    target: ShapeTask
    spec: RunSpec
    inputs: str  # digest of the input files, as in Result
    truth: tuple[Path, Path] | None = None  # vertex lists of source and target
    mirrored: Path | None = None  # vertex list of the target, left and right swapped
    truth_map: Path | None = None  # truth of this pair alone, see ShapeFolder
    landmarks: tuple[Path, Path] | None = None  # vertex lists of source and target, or landmarks with names

    def __str__(self) -> str:
        return str(self.pair)

    @property
    def key(self) -> str:
        return self.pair.key

    @property
    def settings(self) -> str:
        """Digest of the specification, as in Result."""
        return self.spec.digest


def map_path(folder: Path, key: str) -> Path:
    """Return the file of the map of the pair with this key."""
    return folder / MAPS / f"{key}.npz"


def record_attempt(folder: Path, key: str) -> int:
    """Record the start of work on ``key`` in a small file that survives a kill; return the number of the attempt."""
    content = json.dumps({"host": platform.node(), "process": os.getpid(), "time": utc_now()})
    (folder / _ATTEMPTS).mkdir(parents=True, exist_ok=True)
    while True:
        attempt = count_attempts(folder, key) + 1
        with suppress(FileExistsError), open(folder / _ATTEMPTS / f"{key}.{attempt}", "x", encoding="utf-8") as file:
            file.write(content)
            return attempt


def count_attempts(folder: Path, key: str) -> int:
    """Return the number of starts of work on ``key``."""
    count = 0
    while (folder / _ATTEMPTS / f"{key}.{count + 1}").exists():
        count += 1
    return count


def prepare_shape(task: ShapeTask) -> Prepared:
    """Prepare a shape unless the cache has it. A failure is returned, not raised."""
    if load_record(task.entry, Shape) is not None:
        return Prepared(task.name)
    record_attempt(task.folder, task.key)

    def prepared() -> dict[str, Any]:
        if file_digest(task.path) != task.content:
            raise refuse(
                str(task.path), "the file as it was when the run began", "a changed one", "run the command again"
            )
        save_record(task.entry, prepare(read_shape_mesh(task.path), replace(task.config, threads=1), name=task.name))
        return {}

    return Prepared(task.name, *_attempt(prepared)[1:])


def match_pair(job: tuple[PairTask, Prepared, Prepared]) -> Result:
    """Match a pair without a result; save the map and then the result. A failure is recorded, not raised."""
    task, source, target = job

    def matched() -> dict[str, Any]:
        for part in (source, target):
            if part.reason:
                raise InvalidInput(f"shape {part.name} could not be prepared: {part.reason}")
        return _match(task)

    path = map_path(task.folder, task.key)
    return record_pair(task, task.inputs, task.folder, path, matched, notes=(*source.notes, *target.notes))


def record_pair(
    task: PairTask, inputs: str, folder: Path, path: Path, make: Callable[[], dict[str, Any]], **values: Any
) -> Result:
    """Return the result of a pair: the one in ``folder`` if it has these ``inputs``, else a new one that is saved.

    ``make``: saves the map at ``path`` and returns fields of the result; ``values``: further fields.
    """
    result_file = result_path(folder, task.key)
    stored = read_result(result_file)
    if stored is not None and stored.is_of(task.settings, inputs) and path.exists():
        return stored
    start = time.perf_counter()
    attempt = record_attempt(folder, task.key)
    for old in (result_file, path):  # of files that have changed since
        old.unlink(missing_ok=True)
    fields, reason, notes = _attempt(make)
    seconds = {**fields.pop("seconds", {}), "total": time.perf_counter() - start}
    notes = (*values.pop("notes", ()), *notes)
    result = _make_result(task, reason, inputs, attempts=attempt, notes=notes, seconds=seconds, **values, **fields)
    result_file.parent.mkdir(parents=True, exist_ok=True)
    write_result(result_file, result)
    return result


def record_failure(task: PairTask, reason: str) -> Result:
    """Record that a pair cannot be matched, for a reason outside its own work."""
    result = _make_result(task, reason, task.inputs, attempts=count_attempts(task.folder, task.key), worker="")
    write_result(result_path(task.folder, task.key), result)
    return result


def _make_result(task: PairTask, reason: str, inputs: str, **values: Any) -> Result:
    """Return the result of a pair, which failed where there is a ``reason``, with process and time."""
    pair, status = task.pair, "failed" if reason else "done"
    values = {"worker": f"{platform.node()}:{os.getpid()}", "finished": utc_now(), **values}
    values["notes"] = tuple(dict.fromkeys(values.get("notes", ())))
    return Result(pair.source, pair.target, status, task.settings, inputs, reason=reason, **values)


def _attempt(work: Callable[[], dict[str, Any]]) -> tuple[dict[str, Any], str, tuple[str, ...]]:
    """Return the value of ``work``, the reason of its failure, and its warnings: one bad pair must not end the run."""
    value, reason = {}, ""
    with warnings.catch_warnings(record=True) as caught, limit_threads(1), one_blas_thread():
        warnings.simplefilter("always", KfmapsWarning)
        try:
            value = work()
        except Exception as error:
            reason = error_text(error)
    return value, reason, tuple(str(w.message) for w in caught if issubclass(w.category, KfmapsWarning))


def error_text(error: Exception) -> str:
    """Return an error in one line, with its type where it is unexpected."""
    if type(error).__name__ == "KilledWorker":
        return _DIED
    text = str(error) if isinstance(error, _EXPECTED) else f"{type(error).__name__}: {error}"
    return " ".join(text.split()) or type(error).__name__


def utc_now() -> str:
    """Return the time in UTC."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def load_prepared(task: ShapeTask) -> Shape:
    """Return the prepared shape of a task, from the cache."""
    shape = load_record(task.entry, Shape)
    if shape is None:
        raise refuse(f"prepared shape {task.name}", "an entry in the cache", "none", "run the command again")
    return replace(shape, name=task.name)


def pair_shapes(task: PairTask) -> tuple[Shape, Shape]:
    """Return the prepared source and target of a pair."""
    return load_prepared(task.source), load_prepared(task.target)


def pair_samples(task: PairTask, shapes: tuple[Shape, Shape]) -> tuple[ShapeSamples, ShapeSamples]:
    """Return the samples of both shapes for a search, from the cache."""
    entries, seed = (task.source.entry, task.target.entry), task.spec.seed
    return cached_samples(shapes[0], entries[0], seed), cached_samples(shapes[1], entries[1], seed)


def _match(task: PairTask) -> dict[str, Any]:
    """Match a pair and save the map; return the fields of the result."""
    shapes, config = pair_shapes(task), replace(task.spec.config, threads=1)
    landmarks = _landmark_pairs(task, *(len(shape.mesh.vertices) for shape in shapes))
    shape_samples = pair_samples(task, shapes) if config.search is not None else None
    result = match(*shapes, config, landmarks=landmarks, rng=task.spec.seed, shape_samples=shape_samples)
    return save_pair_map(task, result, shapes, map_path(task.folder, task.key))


def save_pair_map(task: PairTask, match: Match, shapes: tuple[Shape, Shape], path: Path) -> dict[str, Any]:
    """Save the map of a pair to ``path``; return the fields of its result."""
    source, target = (shape.mesh for shape in shapes)
    start = time.perf_counter()
    truth, points = true_vertices(task, len(source.vertices), len(target.vertices)), match.target_to_source
    accuracy = None if truth is None else assess_if_reached(source, points, truth, mirrored=_MIRRORED_POINTS)
    covered = coverage(points, source)
    seconds = {**match.seconds, "evaluation": time.perf_counter() - start}
    path.parent.mkdir(parents=True, exist_ok=True)
    save_map(path, with_files(match, (task.source.path, task.target.path), (source, target)), force=True)
    return _errors(accuracy) | {
        "vertices_s": len(source.vertices),
        "vertices_t": len(target.vertices),
        "landmarks": len(match.landmarks),
        "coverage": covered,
        **_common(match, (source, target)),
        "confidence": None if match.confidence is None else float(match.confidence),
        "local_confidence": mean_confidence(match),
        "verdict": match.verdict,
        "orientation": match.orientation,
        "solver": match.fit.status,
        "solver_steps": match.fit.steps,
        "rank": match.fit.rank,
        "seconds": seconds,
    }


def _common(match: Match, meshes: tuple[Mesh, Mesh]) -> dict[str, float]:
    """Return the share of each shape's area that both have; empty for whole shapes."""
    overlaps = {"common_s": match.partial.overlap_source, "common_t": match.partial.overlap_target}
    return {
        name: float(np.average(overlap, weights=vertex_areas(mesh)))
        for (name, overlap), mesh in zip(overlaps.items(), meshes, strict=True)
        if overlap is not None
    }


def _errors(accuracy: Accuracy | None) -> dict[str, Any]:
    """Return the error fields of a result; none where the truth is not known."""
    if accuracy is None:
        return {}
    direct = accuracy.errors
    return {
        "error_mean": direct.mean,
        "error_median": direct.median,
        "error_max": direct.worst,
        "auc": direct.auc,
        "mirrored_mean": None if accuracy.mirrored is None else accuracy.mirrored.mean,
        "curve": tuple(error_curve(direct.errors, np.array(CURVE_ERRORS)).tolist()),
    }


def true_vertices(task: PairTask, n_s: int, n_t: int) -> Truth | None:
    """Return the truth of a pair, where it is known; ``n_s`` and ``n_t``: numbers of vertices."""
    if task.truth_map is None:
        return read_truth(task.truth, n_s, n_t, symmetric=task.mirrored, identity=task.spec.identity)
    numbers = read_vertex_numbers(task.truth_map, one_based=True)
    if len(numbers) != n_s:
        raise refuse(str(task.truth_map), f"{n_s} lines, one per source vertex", f"{len(numbers)}", "check the file")
    return check_truth(Truth(np.arange(n_s), numbers), n_s, n_t)


def _landmark_pairs(task: PairTask, n_s: int, n_t: int) -> np.ndarray | None:
    """Return the pair's landmarks (l, 2), 0-based, or ``None``."""
    truth = true_vertices(task, n_s, n_t)  # files that cannot be used are refused before the match
    if lines := task.spec.landmark_lines:
        if truth is None:
            raise refuse("--landmarks", "true correspondences", "none for this pair", "leave it out")
        if max(lines) > len(truth.source):
            got = f"line {max(lines)} of {len(truth.source)}"
            raise refuse("--landmarks", "lines of the truth", got, "choose others")
        rows = np.array(lines) - 1
        return np.stack([truth.source[rows], truth.target[rows]], axis=1)
    if task.landmarks is None:
        return None
    if any(map(landmark_suffix, task.landmarks)):
        files = task.source.path, task.target.path
        meshes = [read_shape_mesh(file) for file in files]  # prepared shapes have another unit
        return read_landmark_pairs(task.landmarks, meshes, files)[0]
    return np.stack(read_vertex_lists(task.landmarks, (n_s, n_t)), axis=1)
