"""Do what a plan leaves to do, on Dask workers, and keep count."""

from __future__ import annotations

import json
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import kfmaps
from kfmaps._arrays import refuse
from kfmaps.batch.clock import RunStatus, remaining_seconds
from kfmaps.batch.cluster import DEATHS, LOST, Workers
from kfmaps.batch.plan import Plan
from kfmaps.batch.results import Result, result_path
from kfmaps.batch.settings import FILE
from kfmaps.batch.tasks import PairTask, Prepared, ShapeTask
from kfmaps.batch.work import attempts, give_up, match_pair, prepare_shape

if TYPE_CHECKING:
    from distributed import Future

Callback = Callable[[RunStatus, Result | None], None]
"""Called with how the run stands, and with the result that has just come, if one has."""

PATIENCE = 60.0
"""Seconds that a run goes on without any worker; one that was killed takes a few to come back."""
AHEAD = 2
"""Pairs that are handed to Dask for each worker."""


def run_plan(plan: Plan, workers: Workers, callback: Callback | None = None) -> list[Result]:
    """Match every pair that the plan leaves to do; the results, in the order in which they came.

    Each shape is a task of its own that its pairs wait for, so it is prepared once. Only a few pairs are handed
    to Dask ahead of time, so a collection may have any number of them. When a worker dies, Dask hands its task
    to another, which keeps what is finished and begins the rest anew.

    Raises
    ------
    InvalidInput
        When the workers do not see the output folder or run another version, and when the scheduler is lost.
    """
    from distributed import as_completed

    check_workers(plan, workers)
    for task in plan.todo:
        result_path(plan.folder, task.pair.key).unlink(missing_ok=True)
    run = _Run(plan, workers, as_completed(loop=workers.client.loop))
    callback = callback or (lambda _status, _result: None)
    callback(run.status(), None)
    try:
        run.hand_over()
        while run.jobs:
            result = run.next()
            run.hand_over()
            callback(run.status(), result)
    except BaseException:
        workers.client.cancel(list(run.jobs), force=True)
        raise
    return run.results


def check_workers(plan: Plan, workers: Workers) -> None:
    """Whether every worker has this version and sees the output folder under the same path."""
    name = "workers"
    try:
        seen: Any = workers.client.run(_seen, str(plan.folder / FILE))
    except OSError as error:
        raise refuse(name, "processes that answer", "some that ended", LOST) from error
    except Exception as error:  # whatever a foreign worker runs into
        got = " ".join(f"{type(error).__name__}: {error}".split())[:200]
        raise refuse(name, "kfmaps installed on them", got, "install the same version there") from error
    for address, (version, digest) in seen.items():
        if version != kfmaps.__version__:
            got = f"{version} at {address}"
            raise refuse(name, f"kfmaps {kfmaps.__version__}", got, "install the same version there")
        if digest != plan.settings.digest:
            wanted = f"the folder {plan.folder} on all of them"
            raise refuse(name, wanted, f"none at {address}", "choose one that all machines share")


def _seen(path: str) -> tuple[str, str]:
    """Run on a worker: its version, and the digest in the settings file at ``path``."""
    try:
        return kfmaps.__version__, json.loads(Path(path).read_text(encoding="utf-8"))["digest"]
    except (OSError, ValueError, KeyError):
        return kfmaps.__version__, ""


class _Run:
    """The tasks that are with Dask, those that wait, and what has come back."""

    def __init__(self, plan: Plan, workers: Workers, coming) -> None:
        self.plan, self.workers, self.coming = plan, workers, coming
        self.waiting = deque(plan.todo)
        self.jobs: dict[Future, PairTask | ShapeTask] = {}
        self.shapes: dict[str, Future] = {}
        self.needed = {t.entry for task in plan.todo for t in (task.source, task.target)}
        self.ended: set[str] = set()
        self.begun: dict[str, int] = {}
        self.results: list[Result] = []
        self.shape_seconds: list[float] = []
        self.pair_seconds: list[float] = []

    def hand_over(self) -> None:
        """Give Dask the next pairs, with the shapes they need."""
        ahead = sum(isinstance(task, PairTask) for task in self.jobs.values())
        while self.waiting and ahead < AHEAD * self.workers.count + 1:
            task = self.waiting.popleft()
            self.begun.setdefault(task.pair.key, attempts(self.plan.folder, task.pair.key))
            self._submit(task, match_pair, task, self._shape(task.source), self._shape(task.target))
            ahead += 1

    def _shape(self, task: ShapeTask) -> Future:
        if task.entry not in self.shapes:
            key = Path(task.entry).stem
            self.begun.setdefault(key, attempts(self.plan.folder, key))
            self.shapes[task.entry] = self._submit(task, prepare_shape, task)
        return self.shapes[task.entry]

    def _submit(self, task: PairTask | ShapeTask, function: Callable, *arguments) -> Future:
        future = self.workers.client.submit(function, *arguments, pure=False)
        self.jobs[future] = task
        self.coming.add(future)
        return future

    def next(self) -> Result | None:
        """Wait for the next thing that ends; its result when it is a pair's."""
        from distributed import CancelledError

        self._wait()
        future = next(self.coming)
        task = self.jobs.pop(future)
        if future.status in ("lost", "pending"):
            # The worker that had it died just now, and Dask does it again, which finds what is finished.
            self.jobs[future] = task
            self.coming.add(future)
            return None
        try:
            value = future.result()
        except CancelledError as error:
            raise refuse("scheduler", "an answer", "none any more", "run the same command again to go on") from error
        except Exception as error:  # of the task or of whatever killed its worker
            value = error
        if isinstance(task, ShapeTask):
            if isinstance(value, Prepared):
                self.ended.add(task.entry)
                self.shape_seconds += [value.seconds] if value.seconds and not value.reason else []
            return None
        result = self._failed(value, task) if isinstance(value, Exception) else value
        if result is not None:
            self.results.append(result)
            self.pair_seconds += [result.seconds["total"]] if result.status == "done" else []
        return result

    def _wait(self) -> None:
        """Until something has ended.

        Raises
        ------
        InvalidInput
            When there has been no worker for :data:`PATIENCE` seconds: Dask gives up those that are killed as they
            start, and would wait for others for ever.
        """
        looked = alive = time.monotonic()
        while not self.coming.has_ready():
            time.sleep(0.02)
            if (now := time.monotonic()) - looked > min(2.0, PATIENCE):
                looked = now
                try:
                    alive = now if self.workers.client.nthreads() else alive
                except (OSError, RuntimeError, TimeoutError):
                    continue  # a scheduler that does not answer
                if now - alive > PATIENCE:
                    wanted = "processes that stay alive"
                    raise refuse("workers", wanted, f"none for {PATIENCE:.0f} seconds", LOST)

    def _failed(self, error: Exception, task: PairTask) -> Result | None:
        """A pair whose task raised, which is not the pair's doing unless it has killed several workers."""
        from distributed import KilledWorker

        if not isinstance(error, KilledWorker):
            return give_up(task, f"{type(error).__name__}: {error}")
        bad = next((t for t in (task.source, task.target) if self._shape(t).status == "error"), None)
        key, what = (task.pair.key, "it") if bad is None else (Path(bad.entry).stem, f"shape {bad.name}")
        deaths = attempts(self.plan.folder, key) - self.begun[key]
        if deaths >= DEATHS:
            if bad is not None:
                self.ended.add(bad.entry)
            reason = f"{deaths} workers died while {what} was worked on; there may be too little memory"
            return give_up(task, reason)
        # Dask blames everything that was with the workers that died; this had not begun on so many of them.
        if bad is not None:
            del self.shapes[bad.entry]
        self.waiting.append(task)
        return None

    def status(self) -> RunStatus:
        """How the run stands now."""
        earlier = [r.seconds["total"] for r in self.plan.results if r.status == "done"]
        measured = self.pair_seconds or earlier
        ended = [*self.plan.results, *self.results]
        shapes_left = len(self.needed) - len(self.ended)
        pairs_left = len(self.plan.todo) - len(self.results)
        return RunStatus(
            len(self.ended),
            len(self.needed),
            len(ended),
            sum(r.status == "failed" for r in ended),
            len(self.plan.tasks),
            self.workers.count,
            remaining_seconds(self.shape_seconds, measured, shapes_left, pairs_left, self.workers.count),
            len(measured),
        )
