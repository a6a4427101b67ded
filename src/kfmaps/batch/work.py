"""The two units of work, each safe to be begun again at any moment: prepare a shape, match a pair."""

from __future__ import annotations

import json
import os
import platform
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import InvalidInput, KfmapsWarning, MissingDependency, NotConverged, refuse
from kfmaps._threads import one_blas_thread
from kfmaps.batch.cache import file_digest, load_shape, save_shape
from kfmaps.batch.kept import kept_probe
from kfmaps.batch.results import CURVE_ERRORS, Result, read_result, result_path, write_result
from kfmaps.batch.tasks import PairTask, Prepared, ShapeTask
from kfmaps.batch.truth import landmark_pairs, true_vertices
from kfmaps.cli.evaluation import Accuracy, Truth, assessed
from kfmaps.cli.summary import MatchRun, map_file, mean_confidence
from kfmaps.fmap.evaluate import coverage, error_curve
from kfmaps.geometry.mesh import vertex_areas
from kfmaps.io import read_mesh, save_map
from kfmaps.matching.match import Match, match
from kfmaps.shape import Shape, prepare

ATTEMPTS, MAPS = "attempts", "maps"
MIRRORED = 500
"""Points at which a map is compared with the mirrored truth."""
EXPECTED = (InvalidInput, NotConverged, MissingDependency, OSError)
"""What may go wrong with one shape or pair; of anything else the type is told as well."""


def map_path(folder: Path, key: str) -> Path:
    """Where the map of the pair with this key lies."""
    return folder / MAPS / f"{key}.npz"


def begin(folder: Path, key: str) -> int:
    """Note that work on ``key`` begins, in a small file of its own that outlives a kill; which attempt it is."""
    content = json.dumps({"host": platform.node(), "process": os.getpid(), "time": now()})
    (folder / ATTEMPTS).mkdir(parents=True, exist_ok=True)
    attempt = 1
    while True:
        try:
            with open(folder / ATTEMPTS / f"{key}.{attempt}", "x", encoding="utf-8") as file:
                file.write(content)
            return attempt
        except FileExistsError:
            attempt += 1


def attempts(folder: Path, key: str) -> int:
    """How often work on ``key`` has begun."""
    count = 0
    while (folder / ATTEMPTS / f"{key}.{count + 1}").exists():
        count += 1
    return count


def prepare_shape(task: ShapeTask) -> Prepared:
    """Prepare a shape unless the cache has it. A shape that cannot be prepared is told of, not raised."""
    entry = Path(task.entry)
    if load_shape(entry, task.name) is not None:
        return Prepared(task.name)
    start = time.perf_counter()
    begin(Path(task.folder), entry.stem)
    with catching() as caught, one_blas_thread():
        if file_digest(task.path) != task.content:
            raise refuse(task.path, "the file of the run's start", "a changed one", "run the command again")
        mesh = read_mesh(task.path)
        save_shape(entry, prepare(mesh, replace(task.config, threads=1), name=task.name))
    return Prepared(task.name, time.perf_counter() - start, caught.reason, tuple(caught.notes))


def match_pair(task: PairTask, source: Prepared, target: Prepared) -> Result:
    """Match a pair unless its result is there; save the map and then the result. A failure is recorded, not raised."""
    folder = Path(task.folder)
    path = result_path(folder, task.pair.key)
    there = read_result(path)
    if there is not None and (there.settings, there.inputs) == (task.settings, task.inputs):
        return there
    start = time.perf_counter()
    attempt = begin(folder, task.pair.key)
    map_path(folder, task.pair.key).unlink(missing_ok=True)  # of files that have changed since
    values: dict[str, Any] = {"seconds": {}}
    with catching() as caught, one_blas_thread():
        for part in (source, target):
            if part.reason:
                raise InvalidInput(f"shape {part.name} could not be prepared: {part.reason}")
        values = _matched(task)
    values["seconds"]["total"] = time.perf_counter() - start
    result = Result(
        *(task.pair.source, task.pair.target, "failed" if caught.reason else "done", task.settings, task.inputs),
        reason=caught.reason,
        attempts=attempt,
        worker=f"{platform.node()}:{os.getpid()}",
        finished=now(),
        notes=tuple(dict.fromkeys([*source.notes, *target.notes, *caught.notes])),
        **values,
    )
    write_result(path, result)
    return result


def give_up(task: PairTask, reason: str) -> Result:
    """Record that a pair cannot be matched, for a reason outside the work itself."""
    folder = Path(task.folder)
    result = Result(
        *(task.pair.source, task.pair.target, "failed", task.settings, task.inputs),
        reason=reason,
        attempts=attempts(folder, task.pair.key),
        finished=now(),
    )
    write_result(result_path(folder, task.pair.key), result)
    return result


@dataclass
class _Caught:
    """What went wrong inside a block, and what was warned of."""

    reason: str = ""
    notes: list[str] = field(default_factory=list)


@contextmanager
def catching() -> Iterator[_Caught]:
    """Turn exceptions and our own warnings into text; one bad pair must not end the run."""
    caught = _Caught()
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", KfmapsWarning)
        try:
            yield caught
        except EXPECTED as error:
            caught.reason = str(error) or type(error).__name__
        except Exception as error:
            caught.reason = f"{type(error).__name__}: {error}"
    caught.notes = [str(w.message) for w in told if issubclass(w.category, KfmapsWarning)]


def now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def loaded(task: ShapeTask) -> Shape:
    """The prepared shape, which must be in the cache."""
    shape = load_shape(Path(task.entry), task.name)
    if shape is None:
        raise refuse(f"prepared shape {task.name}", "an entry in the cache", "none", "run the command again")
    return shape


def _matched(task: PairTask) -> dict[str, Any]:
    """Match, save the map, and give the fields of the result."""
    source, target = loaded(task.source), loaded(task.target)
    sizes = len(source.mesh.vertices), len(target.mesh.vertices)
    truth = true_vertices(task, *sizes)
    landmarks = landmark_pairs(task, truth, *sizes)
    probes = None
    if task.config.search is not None and landmarks is None:
        entries = Path(task.source.entry), Path(task.target.entry)
        probes = kept_probe(source, entries[0], task.seed), kept_probe(target, entries[1], task.seed)
    found = match(source, target, replace(task.config, threads=1), landmarks=landmarks, rng=task.seed, probes=probes)
    path = map_path(Path(task.folder), task.pair.key)
    return recorded(task, found, (source, target), truth, landmarks, path)


def recorded(
    task: PairTask,
    found: Match,
    shapes: tuple[Shape, Shape],
    truth: Truth | None,
    landmarks: np.ndarray | None,
    path: Path,
) -> dict[str, Any]:
    """Save the map of a pair to ``path``, and give the fields of its result."""
    source, target = shapes
    sizes = len(source.mesh.vertices), len(target.mesh.vertices)
    start = time.perf_counter()
    points = found.target_to_source
    accuracy = None if truth is None else assessed(source.mesh, points, truth, mirrored=MIRRORED)
    reached = coverage(points, source.mesh)
    seconds = {**found.seconds, "evaluation": time.perf_counter() - start}
    marks = np.zeros((0, 2), dtype=np.int64) if landmarks is None else landmarks
    paths = Path(task.source.path), Path(task.target.path)
    outcome = MatchRun(found, (source.mesh, target.mesh), paths, marks, task.seed, dict(found.seconds), accuracy)
    path.parent.mkdir(parents=True, exist_ok=True)
    save_map(path, map_file(outcome), force=True)
    return _errors(accuracy) | {
        "vertices_s": sizes[0],
        "vertices_t": sizes[1],
        "landmarks": len(marks),
        "coverage": reached,
        **_common(found, shapes),
        "confidence": None if found.confidence is None else float(found.confidence),
        "local_confidence": mean_confidence(found),
        "verdict": found.verdict,
        "orientation": found.orientation,
        "solver": None if found.fit is None else str(found.fit.solution.status),
        "solver_steps": None if found.fit is None else int(found.fit.solution.steps),
        "rank": None if found.fit is None else int(found.fit.rank),
        "seconds": seconds,
    }


def _common(found: Match, shapes: tuple[Shape, Shape]) -> dict[str, float]:
    """How much of either shape's area both have; nothing of whole shapes."""
    overlaps = {"common_s": found.overlap_source, "common_t": found.overlap_target}
    told = zip(overlaps.items(), shapes, strict=True)
    return {
        name: float(np.average(overlap, weights=vertex_areas(shape.mesh)))
        for (name, overlap), shape in told
        if overlap is not None
    }


def _errors(accuracy: Accuracy | None) -> dict[str, Any]:
    """The fields of a result that tell of errors; none where the truth is not known."""
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
