"""Running a collection on Dask: once each whatever is killed, on the loopback alone, and resumed where it stopped."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest
import threadpoolctl
from distributed.scheduler import NoValidWorkerError, NoWorkerError

from collecting import CONFIG, Deadly, done, plan_of, write_collection
from kfmaps._arrays import InvalidInput
from kfmaps.batch.jobs import WorkerPool, _local_workers, _running_workers
from kfmaps.batch.layout import Pair, find_collection
from kfmaps.batch.plan import Plan, make_plan
from kfmaps.batch.progress import RunStatus
from kfmaps.batch.results import Result, result_path
from kfmaps.batch.run import _check_workers, _match_pairs, _without_unfinished_files, run_batch
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.work import count_attempts, map_path, prepare_shape
from kfmaps.io import load_map


def until(condition: Callable[[], Any], seconds: float = 120.0) -> Any:
    """The first true value of ``condition``, asked again and again."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if value := condition():
            return value
        time.sleep(0.005)
    raise AssertionError("it never came")


def under_way(plan: Plan) -> tuple[int, str] | None:
    """Process and key of a pair that has begun and has no result."""
    for task in plan.todo:
        key = task.pair.key
        marker = plan.folder / "attempts" / f"{key}.1"
        if marker.exists() and not result_path(plan.folder, key).exists() and (text := marker.read_text()):
            return json.loads(text)["process"], key
    return None


def shape_attempts(plan: Plan) -> list[int]:
    entries = {t.key for task in plan.tasks for t in (task.source, task.target)}
    return [count_attempts(plan.folder, entry) for entry in sorted(entries)]


def gone(process: int) -> bool:
    try:
        return psutil.Process(process).status() == psutil.STATUS_ZOMBIE
    except psutil.NoSuchProcess:
        return True


LEFT_BEHIND = pytest.mark.filterwarnings(
    "ignore:unclosed:ResourceWarning", "ignore:.*SSLSocket:pytest.PytestUnraisableExceptionWarning"
)
"""A worker that is killed leaves its connection open, of which the garbage collector warns; see WorkerPool.close."""


@LEFT_BEHIND
def test_a_killed_worker_costs_nothing(tmp_path: Path) -> None:
    plan = plan_of(write_collection(tmp_path / "c", 4), tmp_path / "out")
    killed: list[str] = []

    def kill_one(status: RunStatus, _result: Result | None) -> None:
        if killed or status.pairs_done < 2:
            return
        for _ in range(200):
            if found := under_way(plan):
                os.kill(found[0], signal.SIGKILL)
                killed.append(found[1])
                return
            time.sleep(0.005)
        # All pairs that were handed out have ended, and none begins before this returns: then the next time.

    outcome = run_batch(plan, workers=2, worst=0, callback=kill_one)
    assert len(killed) == 1
    log = (plan.folder / "run.log").read_text(encoding="utf-8")
    (line,) = [line for line in log.splitlines() if "a worker died" in line]
    assert killed[0].replace("-", " → ") in line
    events = [json.loads(line) for line in (plan.folder / "run.jsonl").read_text(encoding="utf-8").splitlines()]
    assert [f"{event['time']} {event['text']}" for event in events] == log.splitlines()
    assert [event["tasks"] for event in events if event["event"] == "worker died"] == [[killed[0].replace("-", " → ")]]
    pairs = [event for event in events if event["event"] == "pair"]
    assert [event["finished"] for event in pairs] == list(range(1, 13))
    assert pairs[-1]["remaining"] == 0
    assert {event["event"] for event in events} == {"begin", "worker died", "pair", "end"}
    assert [r.status for r in outcome.results] == ["done"] * 12
    assert {Pair(r.source, r.target).key: r.attempts for r in outcome.results if r.attempts > 1} == {killed[0]: 2}
    assert len(list((plan.folder / "pairs").iterdir())) == 12
    assert shape_attempts(plan) == [1] * 4
    alone = plan_of(tmp_path / "c", tmp_path / "alone")
    for result in done(alone):
        key = Pair(result.source, result.target).key
        maps = [load_map(map_path(folder, key)).target_to_source for folder in (plan.folder, alone.folder)]
        np.testing.assert_array_equal(maps[0], maps[1])


def test_a_killed_run_goes_on_where_it_stopped(tmp_path: Path) -> None:
    folder, out = write_collection(tmp_path / "c", 5), tmp_path / "out"
    script = Path(__file__).with_name("collecting.py")
    with subprocess.Popen([sys.executable, str(script), str(folder), str(out)]) as run:
        until(lambda: len(list(out.glob("pairs/b*.json"))) >= 3)
        run.kill()
    workers = {json.loads(p.read_text())["process"] for p in out.glob("attempts/*.1") if p.read_text()}
    assert workers
    until(lambda: all(gone(process) for process in workers))
    kept = {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in out.glob("pairs/b*.json")}
    plan = plan_of(folder, out)
    assert len(plan.todo) == 20 - len(kept) > 0
    outcome = run_batch(plan, workers=2, worst=0)
    assert [r.status for r in outcome.results] == ["done"] * 20
    assert {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in kept} == kept
    assert sum(r.attempts - 1 for r in outcome.results) <= 1  # the one that was under way
    assert plan_of(folder, out).todo == ()


@LEFT_BEHIND
def test_a_pair_that_kills_is_given_up_and_the_rest_go_on(tmp_path: Path) -> None:
    folder = write_collection(tmp_path / "c", 4, sizes=[210])
    config = replace(CONFIG, kernel=Deadly(210))
    pairs = [Pair("b1", "b0"), Pair("b1", "b2"), Pair("b2", "b1"), Pair("b3", "b2"), Pair("b1", "b3")]
    plan = make_plan(find_collection(folder), pairs, RunSpec(config), tmp_path / "out")
    outcome = run_batch(plan, workers=2, worst=0)
    assert {(r.source, r.target) for r in outcome.results if r.status == "failed"} == {("b1", "b0")}
    assert len(outcome.results) == 5
    bad = next(r for r in outcome.results if r.status == "failed")
    assert bad.attempts == 3
    assert "3 workers died" in bad.reason
    log = (plan.folder / "run.log").read_text(encoding="utf-8")
    assert log.count("a worker died") == 3
    assert "failed: b1 → b0: 3 workers died" in log


class Machine(WorkerPool):
    """A pool in this process, whose worker dies whenever it prepares one of the shapes."""

    n_threads = 2

    def __init__(self, deadly: str) -> None:
        super().__init__()
        self.deadly = deadly

    def imap(self, function: Callable, items: Sequence[Any], **_: object) -> Generator[tuple[int, Any]]:
        from distributed import KilledWorker

        for number, item in enumerate(items):
            kills = function is prepare_shape and item.name == self.deadly
            yield number, KilledWorker(item.name, None, 2) if kills else function(item)  # pyright: ignore


def test_a_shape_that_kills_fails_its_pairs_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kfmaps.batch.run._check_workers", lambda *_: None)
    plan = plan_of(write_collection(tmp_path / "c", 3), tmp_path / "out")
    calls: list[tuple[RunStatus, Result | None]] = []
    log: list[str] = []

    def note(_event: str, text: str, **_: object) -> None:
        log.append(text)

    _match_pairs(plan, Machine("b1"), lambda *one: calls.append(one), note)
    results = [result for _, result in calls if result is not None]
    failed = [r for r in results if r.status == "failed"]
    assert {(r.source, r.target) for r in results if r.status == "done"} == {("b0", "b2"), ("b2", "b0")}
    assert len(failed) == 4
    assert all("shape b1 could not be prepared: 3 workers died" in r.reason for r in failed)
    assert calls[-1][0].remaining == 0
    assert str(calls[-1][0]) == "pairs 6/6 (4 failed), finished"
    assert sum("shape b1 could not be prepared" in line for line in log) == 5  # itself and its pairs


@pytest.mark.parametrize("stop", [KeyboardInterrupt, SystemExit(143)])
def test_ctrl_c_ends_cleanly(tmp_path: Path, stop: BaseException) -> None:
    plan = plan_of(write_collection(tmp_path / "c", 3), tmp_path / "out")

    def interrupt(status: RunStatus, _result: Result | None) -> None:
        if status.pairs_done == 2:
            raise stop

    outcome = run_batch(plan, workers=1, callback=interrupt)
    assert outcome.interrupted
    assert 2 <= len(outcome.results) < 6
    assert "not done yet" in (plan.folder / "summary.html").read_text(encoding="utf-8")
    rest = plan_of(tmp_path / "c", tmp_path / "out")
    assert len(rest.todo) == 6 - len(outcome.results)


def _about() -> dict[str, Any]:
    numpy_threads = max(pool["num_threads"] for pool in threadpoolctl.threadpool_info())
    given = [os.environ.get(name) for name in ("OMP_NUM_THREADS", "MALLOC_TRIM_THRESHOLD_")]
    return {
        "environment": given,
        "blas": numpy_threads,
        "listens": _listening(),
        "interrupt": signal.getsignal(signal.SIGINT),
    }


def _listening() -> list[str]:
    kinds = psutil.Process().net_connections("inet")
    return [c.laddr[0] for c in kinds if c.status == psutil.CONN_LISTEN]


@pytest.mark.usefixtures("interruptible")
def test_workers_use_one_thread_and_the_loopback_alone_and_do_not_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MALLOC_TRIM_THRESHOLD_", raising=False)
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    with _local_workers(1) as workers, _local_workers(1) as others:  # a warning would be an error
        assert set(workers.scheduler_info()["workers"]).isdisjoint(others.scheduler_info()["workers"])
        assert workers.scheduler_info()["address"].startswith("tls://127.0.0.1:")
        output: Any = workers.run(_about)
        (worker,) = output.values()
        assert worker["blas"] == 1
        assert worker["environment"] == ["1", None]
        assert worker["interrupt"] == signal.SIG_IGN
        assert worker["listens"]
        assert set(worker["listens"] + _listening()) == {"127.0.0.1"}


@contextmanager
def dask_processes(folder: Path, workers: int) -> Iterator[str]:
    """A scheduler and workers as a site starts them, without anything that would restart them; the address."""
    about = folder / "scheduler.json"
    common = ["--host", "127.0.0.1", "--scheduler-file", str(about)]
    words = [["scheduler", *common, "--port", "0", "--dashboard-address", "127.0.0.1:0"]]
    words += [["worker", *common, "--nthreads", "1", "--no-nanny", "--no-dashboard"]] * workers
    started: list[subprocess.Popen] = []
    try:
        for command in words:
            started.append(
                subprocess.Popen([sys.executable, "-m", "dask", *command], stderr=subprocess.DEVNULL, cwd=folder)
            )
            until(lambda: about.exists() and about.read_text())
        yield json.loads(about.read_text())["address"]
    finally:
        for process in reversed(started):
            process.kill()
            process.wait()


@LEFT_BEHIND
def test_a_worker_of_a_running_scheduler_is_killed(tmp_path: Path) -> None:
    plan = plan_of(write_collection(tmp_path / "c", 4), tmp_path / "out")
    killed: list[tuple[int, str]] = []

    def kill_one(status: RunStatus, _result: Result | None) -> None:
        if not killed and status.pairs_done >= 2:
            killed.append(until(lambda: under_way(plan)))
            os.kill(killed[0][0], signal.SIGKILL)

    with dask_processes(tmp_path, 2) as address:
        with _running_workers(address) as workers:
            until(lambda: len(workers.scheduler_info()["workers"]) == 2)
        outcome = run_batch(plan, workers=address, worst=0, callback=kill_one)
        (plan.folder / "settings.json").unlink()
        with WorkerPool(workers=address) as pool, pytest.raises(InvalidInput, match="on all of them"):
            _check_workers(plan, pool)
    ((process, key),) = killed
    assert [r.status for r in outcome.results] == ["done"] * 12
    assert {Pair(r.source, r.target).key: r.attempts for r in outcome.results if r.attempts > 1} == {key: 2}
    assert len(list((plan.folder / "pairs").iterdir())) == 12
    assert shape_attempts(plan) == [1] * 4
    last = max(outcome.results, key=lambda r: r.finished)
    assert not last.worker.endswith(f":{process}")


def test_no_scheduler() -> None:
    with pytest.raises(InvalidInput, match=r"tcp://127\.0\.0\.1:9"), _running_workers("tcp://127.0.0.1:9", timeout=0.3):
        pass


def test_one_run_at_a_time(tmp_path: Path) -> None:
    fcntl = pytest.importorskip("fcntl")
    plan = plan_of(write_collection(tmp_path / "c", 2), tmp_path / "out")
    with open(tmp_path / "out" / ".lock", "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        with pytest.raises(InvalidInput, match="in use by another run"):
            run_batch(plan)


def test_unfinished_files_of_killed_workers_are_removed(tmp_path: Path) -> None:
    plan = plan_of(write_collection(tmp_path / "c", 2), tmp_path / "out")
    (plan.folder / "maps").mkdir()
    left = [plan.folder / place / ".unfinished-0123456789ab.json" for place in (".", "pairs", "maps", "cache")]
    for path in left:
        path.write_text("half")
    with _without_unfinished_files(plan):
        assert not any(path.exists() for path in left)
        left[1].write_text("half")
    assert not left[1].exists()


def test_unfinished_files_of_other_runs_in_a_shared_cache_stay(tmp_path: Path) -> None:
    """``cache`` may be a link to a folder that several runs share."""
    shelf = tmp_path / "shelf"
    shelf.mkdir()
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "cache").symlink_to(shelf)
    plan = plan_of(write_collection(tmp_path / "c", 2), tmp_path / "out")
    assert plan.tasks[0].source.entry.parent == shelf.resolve()
    old, new = (shelf / f".unfinished-{name}.npz" for name in ("old", "new"))
    for path in (old, new):
        path.write_text("half")
    os.utime(old, (0, 0))
    with _without_unfinished_files(plan):
        assert (old.exists(), new.exists()) == (False, True)


@pytest.mark.parametrize("error", [RuntimeError("Nanny failed to start."), OSError("gone"), TimeoutError()])
def test_workers_that_end_as_they_start(error: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr("distributed.LocalCluster", fail)
    with pytest.raises(InvalidInput, match=r"ended as they started\. Memory may be short"), _local_workers(2):
        pass
    with pytest.raises(InvalidInput, match=r"workers: expected at most .* got 120,000,000 GB"), _local_workers(10**9):
        pass


def test_workers_that_are_lost_on_the_way(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Dask would wait for others for ever."""
    plan = plan_of(write_collection(tmp_path / "c", 2), tmp_path / "out")

    class Nobody:
        def run(self, *_: object) -> None:
            raise OSError("closed")

    pool = WorkerPool()
    pool._client = Nobody()  # type: ignore[assignment]
    with pytest.raises(InvalidInput, match="workers: expected processes that answer, got some that ended"):
        _check_workers(plan, pool)
    monkeypatch.setattr("kfmaps.batch.jobs.NO_WORKERS", "1s")
    with WorkerPool(1) as pool:
        cluster: Any = pool.client.cluster
        cluster.scale(0)
        with pytest.raises(InvalidInput, match="workers: expected processes that stay alive, got none for 1s"):
            pool.map("numbers", abs, [-1, -2])


@pytest.mark.parametrize("error", [NoWorkerError("abs", 1), NoValidWorkerError("abs", set(), set(), {}, 1)])
def test_the_last_worker_may_die_before_it_hands_over_what_it_has_made(
    monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    async def lost(*_: object, **__: object) -> None:
        raise error

    with WorkerPool(1) as pool:
        assert pool.map("numbers", abs, [-1, -2]) == [1, 2]
        monkeypatch.setattr("distributed.client.Future._result", lost)
        with pytest.raises(InvalidInput, match="workers: expected processes that stay alive, got none for"):
            pool.map("numbers", abs, [-1, -2])


SILENT, TALKING = "silent", "talking"


@pytest.mark.parametrize(
    "address", ["nonsense", "", "tcp://a:0", "tcp://a:99999", "ws://x", "tls://127.0.0.1:9", SILENT, TALKING]
)
def test_no_scheduler_but_something_else(address: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def talk() -> None:
            with server.accept()[0] as connection:
                connection.sendall(b"HTTP/1.1 200 OK\r\n\r\n")

        if address in (SILENT, TALKING):
            if address == TALKING:
                threading.Thread(target=talk, daemon=True).start()
            address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        with pytest.raises(InvalidInput, match="scheduler"), _running_workers(address, timeout=0.3):
            pass
