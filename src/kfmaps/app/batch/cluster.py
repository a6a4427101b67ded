"""Workers: a local cluster of processes, or one that is running already."""

from __future__ import annotations

import logging
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kfmaps._arrays import MissingDependency, check_count, refuse
from kfmaps._threads import available_cores

if TYPE_CHECKING:
    from distributed import Client

DEATHS = 3
"""Workers that may die over one task before Dask hands it back as one that kills."""
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), 1)
"""What a worker's environment is given. Dask's own list also has malloc return memory at once, which makes every
large temporary array a round of page faults: a third of the time."""
REMEDY = "install it with: pip install 'dask[distributed]' cryptography"


@dataclass(frozen=True)
class Workers:
    """A connection to workers.

    Attributes
    ----------
    client : distributed.Client
    count : int
        How many tasks run at once.
    where : str
        In words.
    """

    client: Client
    count: int
    where: str


def dask_setup(worker: Any) -> None:
    """Called by Dask in each local worker process: leave Ctrl-C to the process that was started by the user."""
    del worker
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def local_workers(count: int | None = None) -> Iterator[Workers]:
    """Worker processes on this machine, one task and one BLAS thread each, gone when the block ends.

    They listen on the loopback address only and speak TLS with certificates made for this run: whoever can talk
    to a Dask scheduler can run any code, and other users of the machine reach the loopback too.

    Parameters
    ----------
    count : int, optional
        By default one for each core.

    Raises
    ------
    MissingDependency
        When Dask is not installed.
    """
    count = available_cores() if count is None else check_count(count, "workers")
    try:
        import cryptography  # noqa: F401  (Dask's TLS)
        from dask import config
        from distributed import Client, LocalCluster
        from distributed.security import Security
    except ImportError as error:
        raise MissingDependency(f"collections need Dask ({error}); {REMEDY}") from error
    with (
        _quiet(),
        config.set(
            {
                "distributed.scheduler.allowed-failures": DEATHS - 1,
                # A factorisation may keep a worker from answering for long; it is not dead.
                "distributed.scheduler.worker-ttl": None,
                "distributed.nanny.pre-spawn-environ": ONE_THREAD,
            }
        ),
        LocalCluster(
            n_workers=count,
            threads_per_worker=1,
            processes=True,
            host="127.0.0.1",
            protocol="tls://",
            security=Security.temporary(),
            dashboard_address=None,  # pyright: ignore[reportArgumentType]
            # Without a dashboard there still is a small HTTP server, whose fixed port a second run would miss.
            scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
            memory_limit=0,  # a limit of our own would kill what the machine could still bear
            silence_logs=logging.CRITICAL,
            preload=[__name__],
        ) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        yield Workers(client, count, f"{count} worker {'process' if count == 1 else 'processes'}")


@contextmanager
def running_workers(address: str, timeout: float = 30.0) -> Iterator[Workers]:
    """The workers of a Dask scheduler that is running, at ``address`` such as ``tcp://host:8786``.

    Raises
    ------
    MissingDependency
        When Dask is not installed.
    InvalidInput
        When nobody answers within ``timeout`` seconds, or there is no worker.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise MissingDependency(f"collections need Dask ({error}); {REMEDY}") from error
    name, remedy = f"scheduler {address}", "check the address and that its workers run"
    with _quiet():
        try:
            client = Client(address, timeout=timeout, set_as_default=False)
        except (OSError, ValueError, TimeoutError) as error:
            raise refuse(name, "a running Dask scheduler", str(error) or "no answer", remedy) from error
        with client:
            try:
                client.wait_for_workers(1, timeout=timeout)
            except TimeoutError as error:
                raise refuse(name, "at least one worker", "none", remedy) from error
            threads: Any = client.nthreads()
            count = sum(threads.values())
            yield Workers(client, count, f"{count} threads of the workers at {address}")


@contextmanager
def _quiet() -> Iterator[None]:
    """Dask's log of lost connections and restarted workers, which the run tells of in its own words, held back."""
    handlers = logging.getLogger("distributed").handlers
    levels = [handler.level for handler in handlers]
    for handler in handlers:
        handler.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for handler, level in zip(handlers, levels, strict=False):
            handler.setLevel(level)
