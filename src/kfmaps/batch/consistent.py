"""Make the maps of a run consistent over cycles, and write which maps are replaced, by what and why.

The run's own files do not change, so that an interrupted and repeated run has the same result. The scores of each pair,
each composition and each replacement have their own file, with a digest of its inputs.
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
_LAYOUT = 7  # raised when the content of these files changes
_LATENT = "latent"
_N_COMPONENTS = 5
DIFFERENCE_KINDS = ("area", "conformal")


@dataclass(frozen=True, eq=False)
class ShapeStatistics:
    """Statistics of the shapes, from consistent maps."""

    table: tuple[tuple[str, ...], ...] = ()  # titles, then a row for each shape
    # Arrays by name of each connected component, the largest first: shapes, medoid, variance explained by principal
    # components, variation of the shapes at each vertex of the medoid.
    parts: tuple[dict[str, np.ndarray], ...] = ()
    note: str = ""  # statistics that could not be computed


@dataclass(frozen=True, eq=False)
class ConsistentResult:
    """A run whose maps were made consistent."""

    results: tuple[Result, ...]  # of all pairs with their probabilities; new ones for replaced maps
    before: dict[Pair, Result]  # old results of replaced maps
    doubted: tuple[str, ...]  # a line for each pair that others contradict, without a better map
    notes: tuple[str, ...] = ()  # pairs and statistics that are left out, and why
    shapes: ShapeStatistics = field(default_factory=ShapeStatistics)


def map_in_use(folder: Path, key: str) -> Path:
    """Return the file of a pair's map, or of its replacement where there is one."""
    other = map_path(folder / CONSISTENT, key)
    return other if result_path(folder / CONSISTENT, key).exists() and other.exists() else map_path(folder, key)


def make_consistent(plan: Plan, results: Sequence[Result], pool: WorkerPool) -> ConsistentResult:
    """Find which maps of a finished run are wrong, replace them, and write tables of the result.

    ``results``: of the plan's pairs; failed ones do not change.
    """
    done = {r.pair: r for r in results if r.status == "done"}
    score_tasks = [_ScoreTask(task) for task in plan.tasks if task.pair in done]
    if not score_tasks:
        raise refuse("--consistent", "pairs that are matched", "none", "see why the pairs failed")
    tasks, scores, notes = [], [], []
    outcomes = pool.map("evidence of pairs", _score_maps, score_tasks, failures=True)
    for job, maps in zip(score_tasks, outcomes, strict=True):
        if isinstance(maps, Exception):
            notes.append(f"{job}: {error_text(maps)}")
        else:
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
    replace_tasks = []
    for change in repaired.replacements:
        task, path = tasks[change.edge], None if change.path is None else along(change.edge, change.path)
        if change.kind != "none":
            replace_tasks.append(_ReplaceTask(task, change, path, change.label(names), done[task.pair]))
    _remove_replacements(plan, {job.task.key for job in replace_tasks})
    replace_results = pool.map("replaced maps", _replace_map, replace_tasks)
    replaced = {r.pair: r for r in replace_results if r.status == "done"}
    notes += [f"{r.pair} stays as it was: {r.reason}" for r in replace_results if r.status == "failed"]
    probabilities = {t.pair: p for t, p in zip(tasks, repaired.probabilities.tolist(), strict=True)}
    final = tuple(replaced.get(r.pair, replace(r, agreement=probabilities.get(r.pair))) for r in results)
    doubted = [f"{tasks[c.edge]}: {c.reason()}" for c in repaired.replacements if c.kind == "none"]
    folder = plan.folder / CONSISTENT
    _write_pairs(folder / _TABLE, tasks, scores, names, repaired)
    limit_shapes = common_bases(repaired, ends, scores, (load_prepared(task).basis for task in shapes.values()))
    statistics = _write_shape_statistics(
        folder, names, lambda name: load_prepared(shapes[name]).basis, repaired, limit_shapes
    )
    notes += [statistics.note] if statistics.note else []
    return ConsistentResult(final, {key: done[key] for key in replaced}, tuple(doubted), tuple(notes), statistics)


@dataclass(frozen=True)
class _ScoreTask:
    """Maps of a pair to be scored: its own and the alternatives or, with ``steps``, the composition along a path.

    A step is a pair, the number of its candidate, and whether it goes from source to target.
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
    """A map to be replaced."""

    task: PairTask
    change: Replacement
    path: _ScoreTask | None  # of the composition that replaces it, if one does
    label: str  # of the new map
    before: Result  # of the old map

    def __str__(self) -> str:
        return str(self.task)


@dataclass(frozen=True, eq=False)
class _Evidence:
    """Scored maps of a pair on disk."""

    inputs: str  # digest
    functional_maps: np.ndarray  # (m, k, k)
    numbers: np.ndarray  # (m, 3): score, orientation, and whether it is reversed


def _map_digest(task: PairTask) -> str:
    """Return the digest of a pair's own map and all its inputs."""
    path = map_path(task.folder, task.key)
    return digest_of([_LAYOUT, task.settings, task.inputs, file_digest(path)], 32)


def _score_maps(job: _ScoreTask) -> list[ScoredMap]:
    """Score maps of a pair, or read their scores from the file.

    Maps of parts are left out, since neither cycles nor a common basis exist where points have no counterpart.
    """
    inputs = digest_of([_map_digest(task) for task, _, _ in job.steps] or _map_digest(job.task), 32)
    evidence = load_record(job.file, _Evidence)
    if evidence is None or evidence.inputs != inputs:
        shapes = pair_shapes(job.task)
        with limit_threads(1), one_blas_thread():
            samples = pair_samples(job.task, shapes)
            if job.steps:
                maps = score_pair_maps([_compose(job)], shapes, samples)
            else:
                file = load_map(map_path(job.task.folder, job.task.key))
                n_unmatched, n_t = int((file.target_to_source < 0).sum()), len(file.target_to_source)
                if n_unmatched:
                    text = "the map of a part stays as it is and takes no part in this"
                    raise InvalidInput(f"{text}: {n_unmatched} of {n_t} vertices have no counterpart")
                maps = score_stored(file, shapes, samples)
        numbers = np.array([[one.score, one.orientation, one.reversed] for one in maps], dtype=np.float64)
        evidence = _Evidence(inputs, np.stack([one.map for one in maps]), numbers)
        job.file.parent.mkdir(parents=True, exist_ok=True)
        save_record(job.file, evidence)
    rows = zip(evidence.functional_maps, evidence.numbers.tolist(), strict=True)
    return [ScoredMap(C, score, orientation, bool(back)) for C, (score, orientation, back) in rows]


def _compose(job: _ScoreTask) -> StoredMap:
    """Compose the maps of a path."""
    candidates = [_candidates(task)[number] for task, number, _ in job.steps]
    bases = [None if forward else load_prepared(task.source).basis for task, _, forward in job.steps]
    return compose_path(list(zip(candidates, bases, strict=True)))


def _replace_map(job: _ReplaceTask) -> Result:
    """Refine, evaluate and save the map that replaces another, unless that is done; failures are recorded."""
    task, change, folder = job.task, job.change, job.task.folder
    steps = [] if job.path is None else [[n, forward, _map_digest(t)] for t, n, forward in job.path.steps]
    path = map_path(folder / CONSISTENT, task.key)

    def refine() -> dict[str, Any]:
        composition = None if job.path is None else _compose(job.path)
        shapes, config = pair_shapes(task), replace(task.spec.config, threads=1)
        match = refine_replacement(change, _candidates(task), composition, shapes, config, job.label, task.spec.seed)
        return save_pair_map(task, match, shapes, path)

    return record_pair(
        task,
        digest_of([_map_digest(task), change.kind, change.candidate, steps]),
        folder / CONSISTENT,
        path,
        refine,
        changed=job.label,
        why=change.reason(),
        error_before=job.before.error_mean,
        agreement=change.after.probability,
    )


def _candidates(task: PairTask) -> list[StoredMap]:
    return stored_candidates(load_map(map_path(task.folder, task.key)))


def _remove_replacements(plan: Plan, replaced: set[str]) -> None:
    """Remove the replacements of earlier runs except those of the pairs ``replaced``."""
    for task in plan.tasks:
        if task.key not in replaced:
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
    """Write tables of the shapes, and the limit shape of each connected component."""
    chirality, component = repaired.chirality, repaired.sync.component
    signs = ["" if (chirality == 1).all() else ("+" if h > 0 else "-") for h in chirality]
    for path in folder.glob(f"{_LATENT}*.npz"):
        path.unlink()
    scores: list[dict[str, str]] = [{} for _ in names]
    distance_rows: list[list[str]] = []
    parts = []
    for number, limit_shape in enumerate(limit_shapes, 1):
        members = [names[i] for i in limit_shape.members.tolist()]
        matrices = {kind: limit_shape.operators(kind) for kind in DIFFERENCE_KINDS}
        distances = {kind: shape_distances(matrices[kind]) for kind in DIFFERENCE_KINDS}
        for i, j in zip(*np.triu_indices(len(members), 1), strict=True):
            distance_rows.append(
                [members[i], members[j], *(f"{distances[kind][i, j]:.6g}" for kind in DIFFERENCE_KINDS)]
            )
        centre = medoid(distances["area"])
        centre_basis = basis(members[centre])
        arrays = {
            "names": np.array(members),
            "middle": np.array(members[centre]),
            "maps": limit_shape.maps,
            "values": limit_shape.values,
        }
        for kind in DIFFERENCE_KINDS:
            pca = components(matrices[kind], _N_COMPONENTS)
            for i, row in zip(limit_shape.members.tolist(), pca.scores, strict=True):
                scores[i] |= {f"{kind}_{c + 1}": f"{x:.6g}" for c, x in enumerate(row)}
            arrays[f"explained_{kind}"] = pca.parts
            arrays[f"variation_{kind}"] = density(matrices[kind], limit_shape, centre, centre_basis).std(axis=0)
        path = folder / (f"{_LATENT}.npz" if number == 1 else f"{_LATENT}-{number}.npz")
        with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
        parts.append(arrays)
    titles = [f"{kind}_{i + 1}" for kind in DIFFERENCE_KINDS for i in range(_N_COMPONENTS)]
    titles = [title for title in titles if any(title in row for row in scores)]
    rows = [
        (name, signs[i], str(component[i]), *(scores[i].get(t, "") for t in titles)) for i, name in enumerate(names)
    ]
    table = (("shape", "hand", "part", *titles), *rows)
    write_rows(folder / "shapes.csv", table)
    write_rows(folder / "distances.csv", [["shape", "other", *DIFFERENCE_KINDS], *distance_rows])
    note, count = "", len(np.unique(component))
    if not limit_shapes:
        note = "a common basis and principal components need three or more shapes that pairs connect"
    elif count > 1:
        note = f"no pair connects the {count} components; {len(parts)} of them have a common basis of their own"
        n_single = len(names) - sum(len(limit_shape.members) for limit_shape in limit_shapes)
        note += f"; {n_single} shapes are in components of fewer than three" if n_single else ""
    return ShapeStatistics(table, tuple(parts), note)
