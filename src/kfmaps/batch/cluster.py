"""Workers: a local cluster of processes, or one that is running already."""

from __future__ import annotations

import logging
import re
import signal
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from kfmaps._arrays import MissingDependency, check_count, refuse
from kfmaps._memory import check_memory
from kfmaps._threads import available_cores

if TYPE_CHECKING:
    from distributed import Client

DEATHS = 3
"""Workers that may die over one task before Dask hands it back as one that kills."""
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), 1)
"""What a worker's environment is given. Dask's own list also has malloc return memory at once, which makes every
large temporary array a round of page faults: a third of the time."""
LOST = "there may be too little memory for so many (--workers); the same command goes on where it was"
REMEDY = "install it with: pip install 'dask[distributed]' cryptography"


WORKER_BYTES = 120e6
"""What a worker takes before it does anything."""


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
    check_memory(WORKER_BYTES * count, "workers", f"{count:,} processes", "choose fewer; one for each core is best")
    try:
        import cryptography  # noqa: F401  (Dask's TLS)
        from dask import config
        from distributed import Client, LocalCluster
        from distributed.security import Security
    except ImportError as error:
        raise MissingDependency(f"collections need Dask ({error}); {REMEDY}") from error
    with ExitStack() as stack:
        stack.enter_context(_quiet())
        stack.enter_context(
            config.set(
                {
                    "distributed.scheduler.allowed-failures": DEATHS - 1,
                    # A factorisation may keep a worker from answering for long; it is not dead.
                    "distributed.scheduler.worker-ttl": None,
                    # Dask's profiler keeps a thousand seconds of what a worker has been at: some 0.15 GB each.
                    "distributed.worker.profile.enabled": False,
                    "distributed.nanny.pre-spawn-environ": ONE_THREAD,
                }
            )
        )
        try:
            cluster = LocalCluster(
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
            )
            client = Client(stack.enter_context(cluster), set_as_default=False)
        except (RuntimeError, OSError, TimeoutError) as error:  # Dask's words for a process that ends as it starts
            raise refuse("workers", "processes that stay alive", "some that ended as they started", LOST) from error
        stack.enter_context(client)
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
        from distributed.security import Security
    except ImportError as error:
        raise MissingDependency(f"collections need Dask ({error}); {REMEDY}") from error
    name, remedy = f"scheduler {address}", "check the address and that its workers run"
    parts = re.fullmatch(r"(?:([a-z]+)://)?\[?([^/\s\[\]]+)\]?:(\d{1,5})/?", address, re.ASCII)
    if parts is None or not 0 < int(parts.group(3)) < 65536:  # Dask would try such a port for ever
        raise refuse(name, "an address such as tcp://host:8786", "another", remedy)
    secret = parts.group(1) == "tls"
    if secret and Security().get_connection_args("client").get("ssl_context") is None:
        raise refuse(name, "certificates in Dask's configuration", "none", "see Dask's pages on TLS")
    # A client that cannot be made is not silent when it goes away; so it is made only where somebody answers.
    if not _answers(parts.group(2), int(parts.group(3)), timeout, secret):
        raise refuse(name, "a running Dask scheduler", "no answer", remedy)
    with _quiet():
        try:
            client = Client(address, timeout=timeout, set_as_default=False)
        except Exception as error:  # what answers may be anything, and Dask runs into whatever it says
            got = " ".join(f"{type(error).__name__}: {error}".split())[:200]
            raise refuse(name, "a running Dask scheduler", got, remedy) from error
        with client:
            try:
                client.wait_for_workers(1, timeout=timeout)
                threads: Any = client.nthreads()
            except (OSError, TimeoutError) as error:
                raise refuse(name, "at least one worker", "none", remedy) from error
            count = sum(threads.values())
            yield Workers(client, count, f"{count} threads of the workers at {address}")


def _answers(host: str, port: int, timeout: float, secret: bool) -> bool:
    """Whether somebody is there who begins as a scheduler does; for another Dask would wait for ever.

    It speaks first, and begins with the length of what it says; where all is ``secret`` the client begins.
    """
    try:
        with socket.create_connection((host, port), timeout) as connection:
            return secret or 0 < int.from_bytes(connection.recv(8), "little") < 1 << 24
    except (OSError, UnicodeError):
        return False


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
