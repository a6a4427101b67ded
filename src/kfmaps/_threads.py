"""Python threads in place of BLAS threads.

Several BLAS threads make factorisations, triangular solves and small products slower, and much slower on a busy
machine. So BLAS uses one thread around such loops, and Python threads run in parallel: NumPy and SciPy release the
interpreter's lock inside their products and solves.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache, lru_cache
from threading import local
from typing import TypeVar

from threadpoolctl import ThreadpoolController, threadpool_info

from kfmaps._arrays import check_count

A = TypeVar("A")
B = TypeVar("B")


def available_cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _State(local):
    """Limits that hold in the current thread."""

    blas_depth = 0  # nested contexts of :func:`one_blas_thread`
    n_threads: int | None = None  # of :func:`limit_threads`; ``None`` is every available core


_state = _State()


@contextmanager
def limit_threads(count: int | None) -> Iterator[None]:
    """Return a context in which all functions use at most ``count`` Python threads.

    Without one they use every available core. A context within another one can only lower the limit. It holds in the
    thread that enters it. :func:`kfmaps.match` and :func:`kfmaps.prepare` enter it with ``Config.threads``.

    Parameters
    ----------
    count : int or None
        At least 1; ``None`` changes nothing.

    Raises
    ------
    InvalidInput
        When ``count`` is not a whole number above zero.

    Examples
    --------
    >>> with kfmaps.limit_threads(1):
    ...     shape = kfmaps.prepare(kfmaps.datasets.sphere(500))
    """
    before = _state.n_threads
    if count is not None:
        _state.n_threads = min(check_count(count, "threads"), before or count)
    try:
        yield
    finally:
        _state.n_threads = before


def n_threads() -> int:
    """Return how many Python threads may work at once here."""
    return _state.n_threads or available_cores()


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Return a context in which BLAS and OpenMP run on one thread; inside another one it costs nothing.

    Listing all loaded libraries takes some milliseconds, so it is done again only after something has been imported.
    """
    if _state.blas_depth:
        yield
        return
    with _controller(len(sys.modules)).limit(limits=1):
        _state.blas_depth += 1
        try:
            yield
        finally:
            _state.blas_depth -= 1


@lru_cache(1)
def _controller(n_modules: int) -> ThreadpoolController:
    """Return the controller of all BLAS and OpenMP libraries; ``n_modules``: number of imported modules."""
    del n_modules
    return ThreadpoolController()


def parallel(function: Callable[[A], B], items: Iterable[A]) -> list[B]:
    """Return ``[function(item) for item in items]``, computed by Python threads with one BLAS thread each.

    There are at most :func:`n_threads`, and parallel work inside ``function`` shares them out. One gives a plain loop.
    """
    items = list(items)
    available = n_threads()
    count = max(min(available, len(items)), 1)
    with one_blas_thread():
        if count == 1:
            return [function(item) for item in items]
        with ThreadPoolExecutor(count, initializer=_enter_worker, initargs=(available // count,)) as pool:
            return list(pool.map(function, items))


def _enter_worker(n_threads: int) -> None:
    """Set the limits of a new worker thread. That of BLAS holds for the whole process already."""
    _state.blas_depth, _state.n_threads = 1, n_threads
    if _has_thread_limits():
        _controller(len(sys.modules)).limit(limits=1)


@cache
def _has_thread_limits() -> bool:
    """Return whether a BLAS on OpenMP is loaded, whose limit holds for one thread only."""
    return any(
        library["user_api"] == "blas" and library.get("threading_layer") == "openmp" for library in threadpool_info()
    )
