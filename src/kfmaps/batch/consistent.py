"""Make the maps of a run agree over cycles; write beside them which are replaced, by what and why.

The run's own files do not change, so that a run that is interrupted and repeated ends with the same result.
The scores of each pair, each composition and each replacement are a file of their own, with a digest of its inputs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import InvalidInput, refuse
from kfmaps._threads import limit_threads, one_blas_thread
from kfmaps.batch.cache import file_digest, load_record, save_record
from kfmaps.batch.jobs import WorkerPool
from kfmaps.batch.layout import Pair
from kfmaps.batch.plan import Plan
from kfmaps.batch.results import Result, result_path, write_rows
from kfmaps.batch.run_spec import digest_of
from kfmaps.batch.work import (
    PairTask,
    error_text,
    load_prepared,
    map_path,
    pair_samples,
    pair_shapes,
    record_pair,
    save_pair_map,
)
from kfmaps.collection.consistency import (
    common_bases,
    compose_path,
    refine_replacement,
    score_stored,
    stored_candidates,
)
from kfmaps.collection.differences import LimitShape, components, density, shape_distances
from kfmaps.collection.pair_graph import medoid
from kfmaps.collection.repair import CyclePath, RepairResult, Replacement, repair_maps
from kfmaps.collection.scored_map import ScoredMap, StoredMap, score_pair_maps
from kfmaps.geometry.basis import Basis
from kfmaps.io import atomic_output, load_map

CONSISTENT, EVIDENCE, PATHS = "consistent", "evidence", "paths"
_TABLE = "pairs.csv"
_LAYOUT = 7  # raised when what is kept of a pair changes
_LATENT = "latent"
_N_COMPONENTS = 5
DIFFERENCE_KINDS = ("area", "conformal")


@dataclass(frozen=True, eq=False)
class ShapeStatistics:
    """Statistics of the shapes, from maps that agree."""

    table: tuple[tuple[str, ...], ...] = ()  # titles, then a row for each shape
    # Named arrays of each connected component, the largest first: its shapes, its medoid, the variance that the
    # principal components explain, and where on the medoid the shapes vary.
    parts: tuple[dict[str, np.ndarray], ...] = ()
    note: str = ""  # what could not be computed


@dataclass(frozen=True, eq=False)
class ConsistentResult:
    """A run whose maps were made to agree."""

    results: tuple[Result, ...]  # those given, with their probabilities; new ones of replaced maps
    before: dict[Pair, Result]  # the old ones of replaced maps
    doubted: tuple[str, ...]  # a line for each pair that others contradict and for which nothing better is known
    notes: tuple[str, ...] = ()  # what could not be taken into account
    shapes: ShapeStatistics = field(default_factory=ShapeStatistics)


def map_in_use(folder: Path, key: str) -> Path:
    """Return the file of a pair's map: of the replacement, where there is one."""
    other = map_path(folder / CONSISTENT, key)
    return other if result_path(folder / CONSISTENT, key).exists() and other.exists() else map_path(folder, key)


def make_consistent(plan: Plan, results: Sequence[Result], pool: WorkerPool) -> ConsistentResult:
    """Find which maps of a finished run are wrong, replace them, and write tables of the result.

    ``results``: of the plan's pairs; those that failed are left as they are.
    """
    known = {r.pair: r for r in results if r.status == "done"}
    asked = [_ScoreTask(task) for task in plan.tasks if task.pair in known]
    if not asked:
        raise refuse("--consistent", "pairs that are matched", "none", "see why the pairs failed")
    scored = list(zip(asked, pool.map("evidence of pairs", _score_maps, asked, failures=True), strict=True))
    notes = [f"{job}: {error_text(maps)}" for job, maps in scored if isinstance(maps, Exception)]
    tasks, scores = [], []
    for job, maps in scored:
        if not isinstance(maps, Exception):
            tasks.append(job.task)
            scores.append(maps)
    if not tasks:
        _remove_replacements(plan, set())
        return ConsistentResult(tuple(results), {}, (), tuple(notes))
    shapes = {t.name: t for task in tasks for t in (task.source, task.target)}
    names = list(shapes)
    ends = [(names.index(task.pair.source), names.index(task.pair.target)) for task in tasks]

    def along(edge: int, path: CyclePath) -> _ScoreTask:
        return _ScoreTask(tasks[edge], tuple((tasks[s.edge], s.candidate, s.forward) for s in path.steps))

    def compose(paths: list[tuple[int, CyclePath]]) -> list[ScoredMap]:
        return [one for (one,) in pool.map("compositions", _score_maps, [along(*path) for path in paths])]

    repaired = repair_maps(len(names), ends, scores, compose)
    jobs = []
    for change in repaired.replacements:
        task, path = tasks[change.edge], None if change.path is None else along(change.edge, change.path)
        if change.kind != "none":
            jobs.append(_ReplaceTask(task, change, path, change.label(names), known[task.pair]))
    _remove_replacements(plan, {job.task.key for job in jobs})
    replaced = pool.map("replaced maps", _replace_map, jobs)
    changed = {r.pair: r for r in replaced if r.status == "done"}
    notes += [f"{r.pair} stays as it was: {r.reason}" for r in replaced if r.status == "failed"]
    chance = {t.pair: p for t, p in zip(tasks, repaired.probabilities.tolist(), strict=True)}
    final = tuple(changed.get(r.pair, replace(r, agreement=chance.get(r.pair))) for r in results)
    doubted = [f"{tasks[c.edge]}: {c.reason()}" for c in repaired.replacements if c.kind == "none"]
    folder = plan.folder / CONSISTENT
    _write_pairs(folder / _TABLE, tasks, scores, names, repaired)
    common = common_bases(repaired, ends, scores, (load_prepared(task).basis for task in shapes.values()))
    told = _write_shape_statistics(folder, names, lambda name: load_prepared(shapes[name]).basis, repaired, common)
    notes += [told.note] if told.note else []
    return ConsistentResult(final, {key: known[key] for key in changed}, tuple(doubted), tuple(notes), told)


@dataclass(frozen=True)
class _ScoreTask:
    """Maps of a pair to be scored: its own and the alternatives or, with ``steps``, the composition along a path.

    A step is a pair, the number of its candidate, and whether it goes forward.
    """

    task: PairTask
    steps: tuple[tuple[PairTask, int, bool], ...] = ()

    def __str__(self) -> str:
        return str(self.task)

    @property
    def file(self) -> Path:
        folder, key = self.task.folder / CONSISTENT, self.task.key
        named = digest_of([[task.key, candidate, forward] for task, candidate, forward in self.steps])
        return folder / PATHS / f"{key}.{named}.npz" if self.steps else folder / EVIDENCE / f"{key}.npz"


@dataclass(frozen=True)
class _ReplaceTask:
    """A map to be replaced, the composition that replaces it (if one does), and the result of the map in use."""

    task: PairTask
    change: Replacement
    path: _ScoreTask | None
    label: str
    before: Result

    def __str__(self) -> str:
        return str(self.task)


@dataclass(frozen=True, eq=False)
class _Evidence:
    """Scored maps of a pair on disk."""

    inputs: str
    functional_maps: np.ndarray  # (m, k, k)
    numbers: np.ndarray  # (m, 3): score, orientation, and whether it is reversed


def _map_digest(task: PairTask) -> str:
    """Digest of a pair's own map and all that it was made from."""
    path = map_path(task.folder, task.key)
    return digest_of([_LAYOUT, task.settings, task.inputs, file_digest(path)], 32)


def _score_maps(job: _ScoreTask) -> list[ScoredMap]:
    """Score maps of a pair, unless their scores are kept.

    Maps of parts are left out: neither cycles nor a common basis are defined where points have no counterpart.
    """
    inputs = digest_of([_map_digest(task) for task, _, _ in job.steps] or _map_digest(job.task), 32)
    kept = load_record(job.file, _Evidence)
    if kept is None or kept.inputs != inputs:
        shapes = pair_shapes(job.task)
        with limit_threads(1), one_blas_thread():
            samples = pair_samples(job.task, shapes)
            if job.steps:
                maps = score_pair_maps([_compose(job)], shapes, samples)
            else:
                file = load_map(map_path(job.task.folder, job.task.key))
                lost, n_t = int((file.target_to_source < 0).sum()), len(file.target_to_source)
                if lost:
                    text = "the map of a part stays as it is and takes no part in this"
                    raise InvalidInput(f"{text}: {lost} of {n_t} vertices have no counterpart")
                maps = score_stored(file, shapes, samples)
        numbers = np.array([[one.score, one.orientation, one.reversed] for one in maps], dtype=np.float64)
        kept = _Evidence(inputs, np.stack([one.map for one in maps]), numbers)
        job.file.parent.mkdir(parents=True, exist_ok=True)
        save_record(job.file, kept)
    rows = zip(kept.functional_maps, kept.numbers.tolist(), strict=True)
    return [ScoredMap(C, score, orientation, bool(back)) for C, (score, orientation, back) in rows]


def _compose(job: _ScoreTask) -> StoredMap:
    """Compose the maps of a path."""
    candidates = [_candidates(task)[number] for task, number, _ in job.steps]
    bases = [None if forward else load_prepared(task.source).basis for task, _, forward in job.steps]
    return compose_path(list(zip(candidates, bases, strict=True)))


def _replace_map(job: _ReplaceTask) -> Result:
    """Finish, evaluate and save the map that replaces another unless that is done; a failure is recorded."""
    task, change, folder = job.task, job.change, job.task.folder
    steps = [] if job.path is None else [[n, forward, _map_digest(t)] for t, n, forward in job.path.steps]
    other = map_path(folder / CONSISTENT, task.key)

    def replaced() -> dict[str, Any]:
        composition = None if job.path is None else _compose(job.path)
        shapes, config = pair_shapes(task), replace(task.spec.config, threads=1)
        found = refine_replacement(change, _candidates(task), composition, shapes, config, job.label, task.spec.seed)
        return save_pair_map(task, found, shapes, other)

    return record_pair(
        task,
        digest_of([_map_digest(task), change.kind, change.candidate, steps]),
        folder / CONSISTENT,
        other,
        replaced,
        changed=job.label,
        why=change.reason(),
        error_before=job.before.error_mean,
        agreement=change.after.probability,
    )


def _candidates(task: PairTask) -> list[StoredMap]:
    return stored_candidates(load_map(map_path(task.folder, task.key)))


def _remove_replacements(plan: Plan, kept: set[str]) -> None:
    """Remove replacements of maps that are not replaced any more, since others have been matched again."""
    for task in plan.tasks:
        if task.key not in kept:
            result_path(plan.folder / CONSISTENT, task.key).unlink(missing_ok=True)
            map_path(plan.folder / CONSISTENT, task.key).unlink(missing_ok=True)


def _write_pairs(
    path: Path, tasks: list[PairTask], scores: list[list[ScoredMap]], names: list[str], repaired: RepairResult
) -> None:
    """Write a row for each pair: candidates, probability, residual, score, and what replaced its map."""
    rows: list[list[object]] = [
        ["source", "target", "candidates", "probability", "residual", "score", "changed", "why"]
    ]
    changes = {change.edge: (change.label(names), change.reason()) for change in repaired.replacements}
    sync = repaired.sync
    for i, (task, maps) in enumerate(zip(tasks, scores, strict=True)):
        numbers = f"{sync.probabilities[i][0]:.6f}", f"{sync.residuals[i][0]:.6f}", f"{maps[0].score:.4f}"
        rows.append([task.pair.source, task.pair.target, len(maps), *numbers, *changes.get(i, ("", ""))])
    write_rows(path, rows)


def _write_shape_statistics(
    folder: Path,
    names: list[str],
    basis: Callable[[str], Basis],
    repaired: RepairResult,
    limit_shapes: tuple[LimitShape, ...],
) -> ShapeStatistics:
    """Write the tables and the limit shape of each component that pairs join."""
    hands, component = repaired.chirality, repaired.sync.component
    hand = ["" if (hands == 1).all() else ("+" if h > 0 else "-") for h in hands]
    for path in folder.glob(f"{_LATENT}*.npz"):
        path.unlink()
    scores: list[dict[str, str]] = [{} for _ in names]
    apart: list[list[str]] = []
    parts = []
    for number, common in enumerate(limit_shapes, 1):
        own = [names[i] for i in common.members.tolist()]
        matrices = {kind: common.operators(kind) for kind in DIFFERENCE_KINDS}
        distances = {kind: shape_distances(matrices[kind]) for kind in DIFFERENCE_KINDS}
        for i, j in zip(*np.triu_indices(len(own), 1), strict=True):
            apart.append([own[i], own[j], *(f"{distances[kind][i, j]:.6g}" for kind in DIFFERENCE_KINDS)])
        middle = medoid(distances["area"])
        middle_basis = basis(own[middle])
        arrays = {"names": np.array(own), "middle": np.array(own[middle]), "maps": common.maps, "values": common.values}
        for kind in DIFFERENCE_KINDS:
            pca = components(matrices[kind], _N_COMPONENTS)
            for i, row in zip(common.members.tolist(), pca.scores, strict=True):
                scores[i] |= {f"{kind}_{c + 1}": f"{x:.6g}" for c, x in enumerate(row)}
            arrays[f"explained_{kind}"] = pca.parts
            arrays[f"variation_{kind}"] = density(matrices[kind], common, middle, middle_basis).std(axis=0)
        path = folder / (f"{_LATENT}.npz" if number == 1 else f"{_LATENT}-{number}.npz")
        with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
        parts.append(arrays)
    titles = [f"{kind}_{i + 1}" for kind in DIFFERENCE_KINDS for i in range(_N_COMPONENTS)]
    titles = [title for title in titles if any(title in row for row in scores)]
    rows = [(name, hand[i], str(component[i]), *(scores[i].get(t, "") for t in titles)) for i, name in enumerate(names)]
    table = (("shape", "hand", "part", *titles), *rows)
    write_rows(folder / "shapes.csv", table)
    write_rows(folder / "distances.csv", [["shape", "other", *DIFFERENCE_KINDS], *apart])
    note, count = "", len(np.unique(component))
    if not limit_shapes:
        note = "shapes that hang together, three or more, would have a common basis and principal components"
    elif count > 1:
        note = (
            f"no pair joins the {count} parts of the collection; {len(parts)} of them have a common basis of their own"
        )
        alone = len(names) - sum(len(common.members) for common in limit_shapes)
        note += f"; {alone} shapes are in parts of fewer than three" if alone else ""
    return ShapeStatistics(table, tuple(parts), note)
