"""The same work on many things, on Dask workers where there are any."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeVar

from kfmaps._arrays import refuse
from kfmaps.batch.cluster import LOST, Workers, local_workers, running_workers

Item = TypeVar("Item")
Value = TypeVar("Value")
Told = Callable[[str, int, int], None]
"""Called with what is being done, how much of it is done, and how much there is."""


@dataclass
class Crew:
    """Workers that are started when they are first needed, and stay until the block of :func:`crew` ends."""

    count: int | None
    scheduler: str | None
    told: Told
    stack: ExitStack = field(default_factory=ExitStack)
    workers: Workers | None = None

    def connected(self) -> Workers:
        """The workers, started now if they were not."""
        if self.workers is None:
            where = running_workers(self.scheduler) if self.scheduler else local_workers(self.count)
            self.workers = self.stack.enter_context(where)
        return self.workers

    def dismiss(self) -> None:
        """End the workers; they are started again when they are needed again."""
        self.stack.close()
        self.workers = None

    def each(self, what: str, function: Callable[[Item], Value], items: Sequence[Item]) -> list[Value]:
        """``function`` of each of the ``items``, in their order. It is handed to the workers, so it must not raise.

        Raises
        ------
        InvalidInput
            When workers are lost over and over.
        """
        if not items:
            return []
        from distributed import as_completed

        client: Any = self.connected().client
        self.told(what, 0, len(items))
        futures = client.map(function, list(items), pure=False)
        try:
            for done, _ in enumerate(as_completed(futures, loop=client.loop), 1):
                self.told(what, done, len(items))
            return client.gather(futures)
        except (KeyboardInterrupt, SystemExit):
            raise
        except Exception as error:  # KilledWorker and whatever else a lost worker leaves behind
            got = " ".join(f"{type(error).__name__}: {error}".split())[:200]
            raise refuse("workers", "processes that stay alive", got, LOST) from error
        finally:
            client.cancel(futures, force=True)


@contextmanager
def crew(count: int | None = None, scheduler: str | None = None, told: Told | None = None) -> Iterator[Crew]:
    """Workers for :meth:`Crew.each`, as many as ``count`` on this machine or those of a ``scheduler``."""
    found = Crew(count, scheduler, told or (lambda _what, _done, _of: None))
    with found.stack:
        yield found
