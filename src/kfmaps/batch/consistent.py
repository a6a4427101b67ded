"""Make the maps of a whole run agree over cycles; which are replaced, by what and why is written beside them.

Nothing of the run itself is touched, so that the same evidence leads to the same end however often it is cut short.
The scores of each pair, each composition and each replacement are a file of their own, with a digest of its inputs.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import InvalidInput, refuse
from kfmaps._threads import one_blas_thread
from kfmaps.batch.cache import file_digest, load_record, save_record
from kfmaps.batch.jobs import WorkerPool
from kfmaps.batch.layout import Pair
from kfmaps.batch.plan import Plan
from kfmaps.batch.results import FOLDER as RESULTS
from kfmaps.batch.results import Result, read_result, write_result, write_rows
from kfmaps.batch.run_spec import digest_of
from kfmaps.batch.shape_statistics import write_shape_statistics
from kfmaps.batch.work import (
    MAPS,
    PairTask,
    capture_errors,
    error_text,
    load_prepared,
    make_result,
    map_path,
    pair_samples,
    save_pair_map,
    true_vertices,
)
from kfmaps.collection.consistency import (
    Consistency,
    StoredMap,
    compose_path,
    refine_replacement,
    score_candidates,
    score_stored,
    stored_candidates,
    synchronize_store,
)
from kfmaps.collection.repair import CyclePath, Replacement
from kfmaps.collection.scored_map import ScoredMap
from kfmaps.io import load_map
from kfmaps.shape import Shape

CONSISTENT, EVIDENCE, PATHS = "consistent", "evidence", "paths"
_TABLE = "pairs.csv"
_LAYOUT = 6  # raised when what is kept of a pair changes


@dataclass(frozen=True, eq=False)
class ConsistentResult:
    """A run whose maps were made to agree."""

    results: tuple[Result, ...]  # those given, with their probabilities; of replaced maps the new
    before: dict[Pair, Result]  # of replaced maps the old
    doubted: tuple[str, ...]  # a line for each pair that others contradict and for which nothing better is known
    notes: tuple[str, ...] = ()  # what could not be taken into account

    @property
    def replaced(self) -> int:
        """How many maps were replaced."""
        return len(self.before)


def _replacement_map(folder: Path, key: str) -> Path:
    """Return where the map lies that replaces a pair's own."""
    return folder / CONSISTENT / MAPS / f"{key}.npz"


def _replacement_result(folder: Path, key: str) -> Path:
    """Return where its result lies."""
    return folder / CONSISTENT / RESULTS / f"{key}.json"


def map_in_use(folder: Path, key: str) -> Path:
    """Return the map of a pair: that which replaces its own, or its own."""
    other = _replacement_map(folder, key)
    return other if _replacement_result(folder, key).exists() and other.exists() else map_path(folder, key)


def make_consistent(plan: Plan, results: Sequence[Result], pool: WorkerPool) -> ConsistentResult:
    """Find which maps of a finished run are wrong, replace them, and write what came of it.

    ``results``: of the plan's pairs; those that failed are left as they are.
    """
    known = {r.pair: r for r in results if r.status == "done"}
    tasks = [task for task in plan.tasks if task.pair in known]
    if not tasks:
        raise refuse("--consistent", "pairs that are matched", "none", "see why the pairs failed")
    scored = list(zip(tasks, pool.map("evidence of pairs", _score_pair, tasks, failures=True), strict=True))
    notes = [f"{task}: {error_text(maps)}" for task, maps in scored if isinstance(maps, Exception)]
    good = {task: maps for task, maps in scored if not isinstance(maps, Exception)}
    if not good:
        _remove_replacements(plan, set())
        return ConsistentResult(tuple(results), {}, (), tuple(notes))
    store = _FolderStore(plan, list(good), list(good.values()), known, pool)
    found = synchronize_store(store)
    changed = {r.pair: r for r in store.replaced if r.status == "done"}
    notes += [f"{r.pair} stays as it was: {r.reason}" for r in store.replaced if r.status == "failed"]
    chance = {t.pair: p for t, p in zip(store.tasks, found.repaired.probabilities.tolist(), strict=True)}
    final = tuple(changed.get(r.pair, replace(r, agreement=chance.get(r.pair))) for r in results)
    doubted = [c for c in found.repaired.replacements if c.kind == "none"]
    _write_pairs(plan.folder / CONSISTENT / _TABLE, store, found)
    notes += write_shape_statistics(plan.folder / CONSISTENT, store.names, store.shape, found)
    before = {key: known[key] for key in changed}
    return ConsistentResult(final, before, tuple(f"{store.tasks[c.edge]}: {c.reason()}" for c in doubted), tuple(notes))


class _FolderStore:
    """A :class:`~kfmaps.collection.consistency.MapStore` of the maps of a run, worked on by a pool of workers."""

    def __init__(
        self,
        plan: Plan,
        tasks: list[PairTask],
        scores: list[list[ScoredMap]],
        results: dict[Pair, Result],
        pool: WorkerPool,
    ) -> None:
        self.plan, self.tasks, self.scores, self.results, self.pool = plan, tasks, scores, results, pool
        self.shapes = {t.name: t for task in tasks for t in (task.source, task.target)}
        self.names = list(self.shapes)
        number = {name: i for i, name in enumerate(self.names)}
        self.ends = [(number[task.pair.source], number[task.pair.target]) for task in tasks]
        self.replaced: list[Result] = []

    def shape(self, number: int) -> Shape:
        return load_prepared(self.shapes[self.names[number]])

    def compose(self, asked: list[tuple[int, CyclePath]]) -> list[ScoredMap]:
        return self.pool.map("compositions", _score_composition, [self._path(*one) for one in asked])

    def replace(self, replacements: Sequence[Replacement]) -> None:
        jobs = []
        for change in replacements:
            task = self.tasks[change.edge]
            path = None if change.path is None else self._path(change.edge, change.path)
            before = self.results[task.pair]
            jobs.append(_ReplaceTask(task, change, path, change.label(self.names), before))
        _remove_replacements(self.plan, {job.task.key for job in jobs})
        self.replaced = self.pool.map("replaced maps", _replace_map, jobs)

    def _path(self, edge: int, path: CyclePath) -> _PathTask:
        return _PathTask(self.tasks[edge], tuple((self.tasks[s.edge], s.candidate, s.forward) for s in path.steps))


@dataclass(frozen=True)
class _PathTask:
    """A path around a pair: of each step the pair, the number of its candidate, and whether it goes forward."""

    task: PairTask
    steps: tuple[tuple[PairTask, int, bool], ...]

    def __str__(self) -> str:
        return str(self.task)

    @property
    def file(self) -> Path:
        named = digest_of([[task.key, candidate, forward] for task, candidate, forward in self.steps])
        return Path(self.task.folder) / CONSISTENT / PATHS / f"{self.task.key}.{named}.npz"


@dataclass(frozen=True)
class _ReplaceTask:
    """A map to be replaced: by which composition, if by one, and the result of the map that was in use."""

    task: PairTask
    change: Replacement
    path: _PathTask | None
    label: str
    before: Result

    def __str__(self) -> str:
        return str(self.task)


@dataclass(frozen=True, eq=False)
class _Evidence:
    """Scored maps of a pair on disk; of a composition with its ``points``."""

    inputs: str
    functional_maps: np.ndarray  # (m, k, k)
    numbers: np.ndarray  # (m, 3): score, orientation, and whether it is reversed
    points: np.ndarray | None = None

    @property
    def maps(self) -> list[ScoredMap]:
        rows = zip(self.functional_maps, self.numbers.tolist(), strict=True)
        return [ScoredMap(C, score, orientation, bool(back)) for C, (score, orientation, back) in rows]


def _evidence(path: Path, inputs: str, make: Callable[[], tuple[list[ScoredMap], np.ndarray | None]]) -> _Evidence:
    """What is kept at ``path`` of these ``inputs``, else what ``make`` returns, which is kept."""
    found = load_record(path, _Evidence)
    if found is None or found.inputs != inputs:
        with one_blas_thread():
            maps, points = make()
        numbers = np.array([[one.score, one.orientation, one.reversed] for one in maps], dtype=np.float64)
        found = _Evidence(inputs, np.stack([one.map for one in maps]), numbers, points)
        path.parent.mkdir(parents=True, exist_ok=True)
        save_record(path, found)
    return found


def _map_digest(task: PairTask) -> str:
    """Digest of a pair's own map and all that it was made from."""
    path = map_path(Path(task.folder), task.key)
    return digest_of([_LAYOUT, task.settings, task.inputs, file_digest(path)], 32)


def _score_pair(task: PairTask) -> list[ScoredMap]:
    """Score the map of a pair and its alternatives, unless that is kept.

    Maps of parts take no part: neither cycles nor a common basis are defined where points have no counterpart.
    """

    def make() -> tuple[list[ScoredMap], None]:
        file = load_map(map_path(Path(task.folder), task.key))
        lost, n_t = int((file.target_to_source < 0).sum()), len(file.target_to_source)
        if lost:
            text = "the map of a part stays as it is and takes no part in this"
            raise InvalidInput(f"{text}: {lost} of {n_t} vertices have no counterpart")
        shapes = _shapes(task)
        return score_stored(file, shapes, pair_samples(task, shapes)), None

    path = Path(task.folder) / CONSISTENT / EVIDENCE / f"{task.key}.npz"
    return _evidence(path, _map_digest(task), make).maps


def _compose(job: _PathTask) -> _Evidence:
    """Compose the maps of a path and score the composition, unless that is kept."""

    def make() -> tuple[list[ScoredMap], np.ndarray]:
        steps = [
            (_candidates(task)[number], None if forward else load_prepared(task.source).basis)
            for task, number, forward in job.steps
        ]
        made, shapes = compose_path(steps), _shapes(job.task)
        return score_candidates([made], shapes, pair_samples(job.task, shapes)), made[0]

    return _evidence(job.file, digest_of([_map_digest(task) for task, _, _ in job.steps], 32), make)


def _score_composition(job: _PathTask) -> ScoredMap:
    return _compose(job).maps[0]


def _replace_map(job: _ReplaceTask) -> Result:
    """Finish, evaluate and save the map that replaces another unless that is done; a failure is recorded."""
    task, change, folder = job.task, job.change, Path(job.task.folder)
    path, other = _replacement_result(folder, task.key), _replacement_map(folder, task.key)
    begun = time.perf_counter()
    values: dict[str, Any] = {"seconds": {}}
    inputs = ""
    with capture_errors() as caught, one_blas_thread():
        steps = [] if job.path is None else [[n, forward, _map_digest(t)] for t, n, forward in job.path.steps]
        inputs = digest_of([_map_digest(task), change.kind, change.candidate, steps])
        there = read_result(path)
        if there is not None and there.is_of(task.settings, inputs) and other.exists():
            return there
        path.unlink(missing_ok=True)
        other.unlink(missing_ok=True)
        made = None if job.path is None else _compose(job.path)
        composition = None if made is None or made.points is None else (made.points, made.maps[0].reversed)
        shapes = _shapes(task)
        config, candidates = replace(task.spec.config, threads=1), _candidates(task)
        found = refine_replacement(change, candidates, composition, shapes, config, job.label, task.spec.seed)
        truth = true_vertices(task, *(len(shape.mesh.vertices) for shape in shapes))
        values = save_pair_map(task, found, shapes, truth, other)
    values["seconds"]["total"] = time.perf_counter() - begun
    result = make_result(
        task,
        inputs,
        caught,
        changed=job.label,
        why=change.reason(),
        error_before=job.before.error_mean,
        agreement=change.after.probability,
        **values,
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    write_result(path, result)
    return result


def _shapes(task: PairTask) -> tuple[Shape, Shape]:
    return load_prepared(task.source), load_prepared(task.target)


def _candidates(task: PairTask) -> list[StoredMap]:
    return stored_candidates(load_map(map_path(Path(task.folder), task.key)))


def _remove_replacements(plan: Plan, kept: set[str]) -> None:
    """Remove replacements of maps that are not replaced any more, since others have been matched again."""
    for task in plan.tasks:
        if task.key not in kept:
            _replacement_result(plan.folder, task.key).unlink(missing_ok=True)
            _replacement_map(plan.folder, task.key).unlink(missing_ok=True)


def _write_pairs(path: Path, store: _FolderStore, found: Consistency) -> None:
    """What the collection says of every pair."""
    rows: list[list[object]] = [
        ["source", "target", "candidates", "probability", "residual", "score", "changed", "why"]
    ]
    changes = {change.edge: change for change in found.repaired.replacements}
    sync = found.repaired.sync
    for i, (task, maps) in enumerate(zip(store.tasks, store.scores, strict=True)):
        numbers = f"{sync.probabilities[i][0]:.6f}", f"{sync.residuals[i][0]:.6f}", f"{maps[0].score:.4f}"
        why = (changes[i].label(store.names), changes[i].reason()) if i in changes else ("", "")
        rows.append([task.pair.source, task.pair.target, len(maps), *numbers, *why])
    write_rows(path, rows)
