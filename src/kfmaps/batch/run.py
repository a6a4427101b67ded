"""Run a plan: prepare the shapes, match the pairs, and write tables and a summary."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import kfmaps
from kfmaps._arrays import refuse
from kfmaps._progress import CountProgress
from kfmaps.batch.consistent import CONSISTENT, EVIDENCE, PATHS, ConsistentResult, make_consistent
from kfmaps.batch.jobs import TOO_LITTLE_MEMORY, WorkerPool
from kfmaps.batch.page import write_page
from kfmaps.batch.plan import Plan
from kfmaps.batch.progress import Callback, Log, RunStatus, WorkLeft, log_to
from kfmaps.batch.results import FOLDER, Result, all_results, describe_result, result_path, write_csv
from kfmaps.batch.run_spec import FILE
from kfmaps.batch.work import (
    MAPS,
    PairTask,
    Prepared,
    ShapeTask,
    count_attempts,
    error_text,
    match_pair,
    prepare_shape,
    record_failure,
)
from kfmaps.io import remove_unfinished

_A_DAY = 86400.0
_BYTES = 40.0  # about the size of a mesh file per vertex
_LOGGED = ("source", "target", "status", "reason", "verdict", "confidence", "error_mean", "attempts", "worker")
"""Fields of a result that are written to the log."""
TABLE = "results.csv"


@dataclass(frozen=True)
class BatchResult:
    """The result of a run."""

    results: tuple[Result, ...]  # of all planned pairs that have one, by source and target
    interrupted: bool  # whether the user or a signal stopped the run; the same call goes on
    files: tuple[Path, ...]  # tables and summary
    consistent: ConsistentResult | None = None  # where maps were made consistent


def run_batch(
    plan: Plan,
    *,
    workers: int | str | None = None,
    name: str = "collection",
    worst: int = 6,
    callback: Callback | None = None,
    consistent: bool = False,
    progress: CountProgress | None = None,
) -> BatchResult:
    """Do the remaining work of a plan, then write the tables and the summary.

    ``plan``: from :func:`~kfmaps.batch.plan.make_plan`; ``workers`` and ``progress``: see
    :class:`~kfmaps.batch.jobs.WorkerPool`; ``name``: title of the summary; ``worst``: number of the worst pairs with a
    picture in the summary; ``callback``: called with the state of the run and each result; ``consistent``: whether the
    maps are made consistent in the end (:func:`~kfmaps.batch.consistent.make_consistent`).
    """
    interrupted, consistency = False, None
    log = log_to(plan.folder)
    planned = {task.pair for task in plan.tasks}
    with _lock(plan.folder), _without_unfinished_files(plan), WorkerPool(workers, progress, log) as pool:
        of, todo, settings = len(plan.tasks), len(plan.todo), plan.spec.digest
        counts = {"todo": todo, "pairs": of, "settings": settings, "version": kfmaps.__version__}
        log("begin", f"{todo} of {of} pairs to match", **counts)
        try:
            if plan.todo:
                _match_pairs(plan, pool, callback, log)
            if consistent:
                matched = all_results(plan.folder, plan.spec.digest)
                consistency = make_consistent(plan, [r for r in matched if r.pair in planned], pool)
                for r in (r for r in consistency.results if r.changed):
                    text = f"{r.pair} replaced by {r.changed}: {r.why}"
                    log("replaced", text, source=r.source, target=r.target, by=r.changed, why=r.why)
        except (KeyboardInterrupt, SystemExit):  # Ctrl-C, or the signal that comes before a time limit
            interrupted = True
            log("interrupted", "interrupted")
        except Exception as error:
            reason = f"{type(error).__name__}: {error}"
            log("stopped", f"stopped: {reason}", reason=reason)
            raise
        finally:
            pool.close()  # otherwise running work could change results after the tables are written
        updated = {} if consistency is None else {r.pair: r for r in consistency.results}
        all_done = [updated.get(r.pair, r) for r in all_results(plan.folder, plan.spec.digest)]
        pool.progress("summary", 0, 1)
        write_csv(plan.folder / TABLE, all_done)
        files = plan.folder / TABLE, write_page(plan, all_done, name, 0 if interrupted else worst, consistency)
        pool.progress("summary", 1, 1)
    results = tuple(r for r in all_done if r.pair in planned)
    failed = sum(r.status == "failed" for r in results)
    log("end", f"{len(results)} pairs have a result, {failed} of them failed", pairs=len(results), failed=failed)
    return BatchResult(results, interrupted, files, consistency)


def _match_pairs(plan: Plan, pool: WorkerPool, callback: Callback | None, log: Log) -> None:
    """Prepare the remaining shapes and match the remaining pairs of a plan.

    Dask gives the task of a dead worker to another, which starts it again. A task that kills
    :data:`~kfmaps.batch.jobs.MAX_DEATHS` workers is recorded as failed.
    """
    callback = callback or (lambda _status, _result: None)
    _check_workers(plan, pool)
    for task in plan.todo:
        result_path(plan.folder, task.key).unlink(missing_ok=True)
    shapes = list({t.entry: t for task in plan.todo for t in (task.source, task.target)}.values())
    prepared: dict[Path, Prepared] = {}
    done: list[Result] = list(plan.results)
    work_left = _work_left(plan)

    def report(result: Result | None = None) -> None:
        elapsed = {number: time.monotonic() - since for number, since in pool.started.items()}
        status = RunStatus(
            shapes_done=len(prepared),
            shapes=len(shapes),
            pairs_done=len(done),
            failed=sum(r.status == "failed" for r in done),
            pairs=len(plan.tasks),
            workers=pool.n_threads,
            remaining=work_left.remaining(elapsed, pool.n_threads) if len(prepared) == len(shapes) else None,
            measured=len(work_left.measured),
        )
        if result is not None:
            values = {name: getattr(result, name) for name in _LOGGED} | {"seconds": result.seconds.get("total")}
            counts = {"finished": status.pairs_done, "pairs": status.pairs, "remaining": status.remaining}
            log("pair", describe_result(result), **values, **counts)
        callback(status, result)

    report()
    with closing(pool.imap(prepare_shape, shapes, n_starts=_attempts)) as values:
        for number, value in values:
            task = shapes[number]
            preparation = value if isinstance(value, Prepared) else Prepared(task.name, reason=error_text(value))
            prepared[task.entry] = preparation
            if reason := preparation.reason:
                message = f"shape {task.name} could not be prepared: {reason}"
                log("shape failed", message, shape=task.name, reason=reason)
            report()
    jobs = [(task, prepared[task.source.entry], prepared[task.target.entry]) for task in plan.todo]
    results = pool.imap(match_pair, jobs, label=lambda job: str(job[0]), n_starts=lambda job: _attempts(job[0]))
    with closing(results) as values:
        for number, value in values:
            result = record_failure(plan.todo[number], error_text(value)) if isinstance(value, Exception) else value
            work_left.end(number, result.seconds["total"] if result.status == "done" else None)
            done.append(result)
            report(result)


def _attempts(task: ShapeTask | PairTask) -> int:
    return count_attempts(task.folder, task.key)


def _work_left(plan: Plan) -> WorkLeft:
    """Return the remaining pairs with their sizes, and the times of earlier runs."""
    entries = {t.entry: t for task in plan.tasks for t in (task.source, task.target)}
    vertices = {entry: _vertices(task) for entry, task in entries.items()}
    sizes = {task.pair: (vertices[task.source.entry] + vertices[task.target.entry]) / 2 for task in plan.tasks}
    before = [(sizes[r.pair], r.seconds["total"]) for r in plan.results if r.status == "done"]
    return WorkLeft({number: sizes[task.pair] for number, task in enumerate(plan.todo)}, before)


def _vertices(task: ShapeTask) -> float:
    """Return an estimate of the number of vertices of a shape from the size of its file."""
    try:
        return task.path.stat().st_size / _BYTES
    except OSError:
        return 0.0


def _check_workers(plan: Plan, pool: WorkerPool) -> None:
    """Check that every worker has this version and sees the output folder under the same path."""
    name = "workers"
    try:
        replies: Any = pool.client.run(_worker_version, str(plan.folder / FILE))
    except OSError as error:
        raise refuse(name, "processes that answer", "some that ended", TOO_LITTLE_MEMORY) from error
    except Exception as error:  # a worker of another installation may fail in any way
        got = " ".join(f"{type(error).__name__}: {error}".split())[:200]
        raise refuse(name, "kfmaps installed on all of them", got, "install the same version there") from error
    for address, (version, digest) in replies.items():
        if version != kfmaps.__version__:
            got = f"{version} at {address}"
            raise refuse(name, f"kfmaps {kfmaps.__version__}", got, "install the same version there")
        if digest != plan.spec.digest:
            expected = f"the folder {plan.folder} on all of them"
            raise refuse(name, expected, f"none at {address}", "choose a folder that all machines share")


def _worker_version(path: str) -> tuple[str, str]:
    """Return a worker's version of kfmaps, and the digest of the specification at ``path``."""
    try:
        return kfmaps.__version__, json.loads(Path(path).read_text(encoding="utf-8"))["digest"]
    except (OSError, ValueError, KeyError):
        return kfmaps.__version__, ""


@contextmanager
def _without_unfinished_files(plan: Plan) -> Iterator[None]:
    """Remove the half-written files of killed workers before and after the block.

    In a cache that is a link to another folder, where other runs may be writing, only those older than a day are
    removed.
    """
    consistent = plan.folder / CONSISTENT
    parts = (top / part for top in (plan.folder, consistent) for part in (FOLDER, MAPS))
    folders = [plan.folder, consistent, *parts, consistent / EVIDENCE, consistent / PATHS]

    def tidy() -> None:
        for folder in folders:
            remove_unfinished(folder)
        cache = (plan.folder / "cache").resolve()
        remove_unfinished(cache, 0.0 if plan.folder in cache.parents else _A_DAY)

    tidy()
    try:
        yield
    finally:
        tidy()


@contextmanager
def _lock(folder: Path) -> Iterator[None]:
    """Lock the output folder for this run; the system releases the lock however the run ends."""
    try:
        import fcntl
    except ImportError:  # Windows: two runs at once do some pairs twice, and record each once
        yield
        return
    handle = os.open(folder / ".lock", os.O_RDWR | os.O_CREAT, 0o644)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise refuse(f"output {folder}", "a folder of its own", "one in use by another run", "wait for it") from error
    except OSError:
        pass  # a file system without locks
    try:
        yield
    finally:
        os.close(handle)
