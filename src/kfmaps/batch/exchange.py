"""A pair whose map others contradict gets another: finished, evaluated and written beside the first."""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps._arrays import refuse
from kfmaps._threads import one_blas_thread
from kfmaps.batch.evidence import FOLDER, WayTask, candidates, composition, map_digest
from kfmaps.batch.results import FOLDER as RESULTS
from kfmaps.batch.results import Result, read_result, write_result
from kfmaps.batch.settings import digest_of
from kfmaps.batch.tasks import PairTask
from kfmaps.batch.truth import true_vertices
from kfmaps.batch.work import MAPS, catching, loaded, map_path, now, recorded
from kfmaps.collection.repair import Replacement
from kfmaps.io import load_map
from kfmaps.matching.calibration import SURE
from kfmaps.matching.match import match_from_map


@dataclass(frozen=True)
class Exchange:
    """What a pair's map is exchanged for.

    Attributes
    ----------
    task : PairTask
    change : Change
    way : WayTask or None
        Of a composition.
    through : tuple of str
        The shapes between.
    before : Result
        Of the map that was in use.
    """

    task: PairTask
    change: Replacement
    way: WayTask | None
    through: tuple[str, ...]
    before: Result


def exchanged_map(folder: Path, key: str) -> Path:
    """Where the map lies that a pair's own was exchanged for."""
    return folder / FOLDER / MAPS / f"{key}.npz"


def exchanged_result(folder: Path, key: str) -> Path:
    """Where its result lies."""
    return folder / FOLDER / RESULTS / f"{key}.json"


def map_in_use(folder: Path, key: str) -> Path:
    """The map of a pair: that which its own was exchanged for, or its own."""
    other = exchanged_map(folder, key)
    return other if exchanged_result(folder, key).exists() and other.exists() else map_path(folder, key)


def kind_of(change: Replacement, through: Sequence[str]) -> str:
    """What a pair was exchanged for, in words for a table."""
    if change.kind == "runner-up":
        return f"runner-up {change.candidate}"
    if change.kind == "composition":
        return f"composition through {', '.join(through)}"
    return ""


def reason_of(change: Replacement) -> str:
    """Why, in words."""
    scores = f"score {change.score_before:.1f}, now {change.score_after:.1f}"
    if change.improved:
        misfits = f"by {change.residual_before:.2f}, and this by {change.residual_after:.2f}"
        return f"it strays from what other pairs say, {misfits}; {scores}"
    told = [f"other pairs leave it a probability of {change.before:.1%}, and this {change.after:.0%}"]
    if change.kind == "none":
        told = [f"other pairs leave it a probability of {change.before:.1%}, and no other map is probable"]
    told += ["it is of another orientation than it claims"] if change.contradicts else []
    told += [scores] if change.kind != "none" else []
    return "; ".join(told)


def exchange(job: Exchange) -> Result:
    """Finish, evaluate and save the map of an exchange unless that is done; a failure is recorded, not raised."""
    task, change = job.task, job.change
    folder = Path(task.folder)
    path = exchanged_result(folder, task.pair.key)
    begun = time.perf_counter()
    values: dict[str, Any] = {"seconds": {}}
    inputs = ""
    with catching() as caught, one_blas_thread():
        steps = [] if job.way is None else [[s.choice, s.forth, map_digest(s.task)] for s in job.way.steps]
        inputs = digest_of([map_digest(task), change.kind, change.candidate, steps])
        there = read_result(path)
        other = exchanged_map(folder, task.pair.key)
        if there is not None and (there.settings, there.inputs) == (task.settings, inputs) and other.exists():
            return there
        path.unlink(missing_ok=True)
        other.unlink(missing_ok=True)
        values = _exchanged(job)
    values["seconds"]["total"] = time.perf_counter() - begun
    result = Result(
        *(task.pair.source, task.pair.target, "failed" if caught.reason else "done", task.settings, inputs),
        reason=caught.reason,
        worker=f"{platform.node()}:{os.getpid()}",
        finished=now(),
        changed=kind_of(change, job.through),
        why=reason_of(change),
        error_before=job.before.error_mean,
        agreement=change.after,
        notes=tuple(caught.notes),
        **values,
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    write_result(path, result)
    return result


def _exchanged(job: Exchange) -> dict[str, Any]:
    task, change = job.task, job.change
    folder = Path(task.folder)
    source, target = loaded(task.source), loaded(task.target)
    given = candidates(load_map(map_path(folder, task.pair.key)))
    if job.way is None:
        points, turned = given[change.candidate]
    else:
        made, judged, reason = composition(job.way)
        if made is None or judged is None:
            raise refuse(f"composition of {task.pair.key}", "maps that can be read", reason, "run the command again")
        points, turned = made, job.way.reversed
    others = [given[0][0], *(row for i, (row, _) in enumerate(given[1:], 1) if i != change.candidate)]
    found = match_from_map(
        source,
        target,
        points,
        replace(task.config, threads=1),
        origin=kind_of(change, job.through),
        orientation="reversed" if turned else "kept",
        verdict="sure" if change.after >= SURE else "ambiguous",
        confidence=change.after,
        quality=change.score_after,
        runners_up=tuple(np.asarray(row) for row in others),
        rng=task.seed,
    )
    truth = true_vertices(task, len(source.mesh.vertices), len(target.mesh.vertices))
    return recorded(task, found, (source, target), truth, None, exchanged_map(folder, task.pair.key))
