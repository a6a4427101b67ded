"""Apply a function to many items on Dask workers, on this machine or of a running scheduler."""

from __future__ import annotations

import gc
import logging
import re
import signal
import socket
import time
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from typing import TYPE_CHECKING, Any, TypeVar

from kfmaps._arrays import check_count, refuse
from kfmaps._memory import check_memory
from kfmaps._progress import CountProgress
from kfmaps._threads import available_cores

if TYPE_CHECKING:
    from distributed import Client, Future

_Item = TypeVar("_Item")
_Value = TypeVar("_Value")

_SILENT = logging.CRITICAL + 1  # level of Dask's log: it reports a client that has left as critical, with a traceback
MAX_DEATHS = 3
"""Workers that may die over one task before it is given up."""
NO_WORKERS = "60s"
"""Time after which a run without any worker ends; a killed worker restarts within a few seconds."""
_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), 1)
"""Environment of a worker. Dask's default also makes malloc return memory at once, and page faults take a third of the
time."""
_WORKER_BYTES = 120e6  # memory of an idle worker
TOO_LITTLE_MEMORY = "memory may be short: run the same command with fewer --workers to go on"


class WorkerPool:
    """Dask workers, started when they are first needed; a context that ends them.

    ``workers``: number of processes on this machine, by default one for each core, or the address of a running Dask
    scheduler whose workers are used; ``progress``: for :meth:`map`; ``log``: called when a worker dies
    (:data:`kfmaps.batch.progress.Log`). ``started``: start times of the running items by their number.
    """

    def __init__(
        self,
        workers: int | str | None = None,
        progress: CountProgress | None = None,
        log: Callable[..., None] | None = None,
    ) -> None:
        self.workers = workers
        self.progress = progress or (lambda _what, _done, _of: None)
        self.log = log or (lambda *_, **__: None)
        self.started: dict[int, float] = {}
        self._stack, self._client = ExitStack(), None
        self._labels: dict[object, str] = {}
        self._deaths = 0

    def __enter__(self) -> WorkerPool:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def client(self) -> Client:
        """The connection to the workers, which are started if necessary."""
        if self._client is None:
            workers = self.workers
            connection = _running_workers(workers) if isinstance(workers, str) else _local_workers(workers)
            self._client = self._stack.enter_context(connection)
            threads: Any = self._client.nthreads()
            self.n_threads = sum(threads.values())
            self._client.subscribe_topic("all", self._note_event)
        return self._client

    def close(self) -> None:
        """End the workers; they start again when they are needed again."""
        if self._client is not None:
            with suppress(Exception):  # otherwise the scheduler would report to a closed client
                self._client.unsubscribe_topic("all")
        self._stack.close()
        self._client = None
        if self._deaths:
            # The garbage collector closes the connection to a dead worker, and warns.
            with warnings.catch_warnings(action="ignore", category=ResourceWarning):
                gc.collect()

    def _note_event(self, event: tuple[float, Any]) -> None:
        message = event[1]
        if message.get("action") == "remove-worker" and not message.get("expected"):
            self._deaths += 1
            tasks = sorted(self._labels[key] for key in message.get("processing-tasks", ()) if key in self._labels)
            worker, task_names = message.get("worker"), ", ".join(tasks) or "nothing to do"
            self.log("worker died", f"a worker died ({worker}) while it had: {task_names}", worker=worker, tasks=tasks)

    def imap(
        self,
        function: Callable[[_Item], _Value],
        items: Sequence[_Item],
        *,
        label: Callable[[_Item], str] = str,
        n_starts: Callable[[_Item], int] | None = None,
    ) -> Generator[tuple[int, _Value | Exception]]:
        """Yield the number of each item with its value or its exception, in the order in which they finish.

        Dask gets only as many tasks as can run at once, so there may be any number of items. It gives the tasks of a
        dead worker to another.

        ``label``: name of an item in the log; ``n_starts``: how often work on an item has begun. Dask blames every task
        of a dead worker, so an item that has not begun :data:`MAX_DEATHS` times is tried again.
        """
        from distributed import CancelledError, KilledWorker, as_completed
        from distributed.scheduler import NoValidWorkerError, NoWorkerError

        client = self.client
        finished = as_completed(loop=client.loop)
        before = [n_starts(item) if n_starts else 0 for item in items]
        waiting = deque(range(len(items)))
        running: dict[Future, int] = {}
        try:
            while waiting or running:
                while waiting and len(running) < self.n_threads:
                    number = waiting.popleft()
                    future = client.submit(function, items[number], pure=False)
                    self._labels[future.key] = label(items[number])
                    running[future], self.started[number] = number, time.monotonic()
                    finished.add(future)
                future = next(finished)
                number = running.pop(future)
                del self._labels[future.key], self.started[number]
                value: _Value | Exception
                try:
                    # as_completed does not fetch values, since it would lose an error and wait for ever.
                    value = future.result()
                except CancelledError:
                    remedy = "run the same command again to go on"
                    raise refuse("scheduler", "an answer", "none any more", remedy) from None
                except (NoWorkerError, NoValidWorkerError):
                    got = f"none for {NO_WORKERS}"
                    raise refuse("workers", "processes that stay alive", got, TOO_LITTLE_MEMORY) from None
                except KilledWorker as error:
                    if n_starts and n_starts(items[number]) - before[number] < MAX_DEATHS:
                        waiting.append(number)
                        continue
                    value = error
                except Exception as error:
                    value = error
                yield number, value
        finally:
            self.started.clear()
            with suppress(Exception):  # a scheduler that is lost has nothing to cancel
                client.cancel(list(running), force=True)

    def map(
        self, what: str, function: Callable[[_Item], Any], items: Sequence[_Item], *, failures: bool = False
    ) -> list[Any]:
        """Return the ``function`` of each item, in their order, and report progress.

        ``what``: name of the work in progress and log; ``failures``: whether exceptions are returned instead of raised.
        """
        values: dict[int, Any] = {}
        if not items:
            return []
        self.progress(what, 0, len(items))
        with closing(self.imap(function, items, label=lambda item: f"{what} {item}")) as results:
            for number, value in results:
                if isinstance(value, Exception) and not failures:
                    if type(value).__name__ != "KilledWorker":
                        raise value
                    got = f"{MAX_DEATHS} that ended over {items[number]}"
                    raise refuse("workers", "processes that stay alive", got, TOO_LITTLE_MEMORY) from value
                values[number] = value
                self.progress(what, len(values), len(items))
        return [values[number] for number in range(len(items))]


def dask_setup(worker: object) -> None:
    """Ignore Ctrl-C in a local worker process, where Dask calls this; the user's process handles it."""
    del worker
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _local_workers(count: int | None) -> Iterator[Client]:
    """Start worker processes on this machine with one task and one BLAS thread each, until the block ends.

    They listen on the loopback address only, and use TLS with certificates of this run. Whoever can connect to a Dask
    scheduler can run any code, and other users of the machine reach the loopback address too.
    """
    count = available_cores() if count is None else check_count(count, "workers")
    check_memory(_WORKER_BYTES * count, "workers", f"{count:,} processes", "choose fewer; one for each core is best")
    from dask import config
    from distributed import Client, LocalCluster
    from distributed.security import Security

    settings = {
        "distributed.scheduler.allowed-failures": MAX_DEATHS - 1,
        "distributed.scheduler.no-workers-timeout": NO_WORKERS,
        # A worker may not answer for long during a factorisation.
        "distributed.scheduler.worker-ttl": None,
        # Dask's profiler stores the last thousand seconds of each worker, some 0.15 GB.
        "distributed.worker.profile.enabled": False,
        "distributed.nanny.pre-spawn-environ": _ONE_THREAD,
    }
    with ExitStack() as stack:
        stack.enter_context(_quiet())
        stack.enter_context(config.set(settings))
        try:
            cluster = LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                protocol="tls://",
                security=Security.temporary(),
                dashboard_address=None,  # pyright: ignore[reportArgumentType]
                # There is a small HTTP server even without a dashboard; its default port may be taken by another run.
                scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
                memory_limit=0,  # a limit would kill workers for which the machine has memory
                silence_logs=_SILENT,
                preload=[__name__],
            )
            client = Client(stack.enter_context(cluster), set_as_default=False)
        except (RuntimeError, OSError, TimeoutError) as error:  # a process ended as it started
            got = "some that ended as they started"
            raise refuse("workers", "processes that stay alive", got, TOO_LITTLE_MEMORY) from error
        yield stack.enter_context(client)


@contextmanager
def _running_workers(address: str, timeout: float = 30.0) -> Iterator[Client]:
    """Connect to a Dask scheduler that is running, at ``address`` such as ``tcp://host:8786``."""
    from distributed import Client
    from distributed.security import Security

    name, remedy = f"scheduler {address}", "check the address and that its workers run"
    match = re.fullmatch(r"(?:([a-z]+)://)?\[?([^/\s\[\]]+)\]?:(\d{1,5})/?", address, re.ASCII)
    if match is None or not 0 < int(match.group(3)) < 65536:  # Dask would retry such a port for ever
        raise refuse(name, "an address such as tcp://host:8786", "another", remedy)
    is_tls = match.group(1) == "tls"
    if is_tls and Security().get_connection_args("client").get("ssl_context") is None:
        raise refuse(name, "certificates in Dask's configuration", "none", "see Dask's pages on TLS")
    # A client without a connection logs errors when it is deleted, so a scheduler must answer first.
    if not _answers(match.group(2), int(match.group(3)), timeout, is_tls):
        raise refuse(name, "a running Dask scheduler", "no answer", remedy)
    with _quiet():
        try:
            client = Client(address, timeout=timeout, set_as_default=False)
        except Exception as error:  # another program may have answered
            got = " ".join(f"{type(error).__name__}: {error}".split())[:200]
            raise refuse(name, "a running Dask scheduler", got, remedy) from error
        with client:
            try:
                client.wait_for_workers(1, timeout=timeout)
            except (OSError, TimeoutError) as error:
                raise refuse(name, "at least one worker", "none", remedy) from error
            yield client


def _answers(host: str, port: int, timeout: float, is_tls: bool) -> bool:
    """Return whether a scheduler answers; with another program Dask would wait for ever.

    A scheduler sends first, beginning with the length of its message; with TLS (``is_tls``) the client sends first.
    """
    try:
        with socket.create_connection((host, port), timeout) as connection:
            return is_tls or 0 < int.from_bytes(connection.recv(8), "little") < 1 << 24
    except (OSError, UnicodeError):
        return False


@contextmanager
def _quiet() -> Iterator[None]:
    """Silence Dask's log of lost connections and restarted workers, which the run itself reports."""
    handlers = logging.getLogger("distributed").handlers
    levels = [handler.level for handler in handlers]
    for handler in handlers:
        handler.setLevel(_SILENT)
    try:
        yield
    finally:
        for handler, level in zip(handlers, levels, strict=False):
            handler.setLevel(level)
