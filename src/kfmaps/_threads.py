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

A = TypeVar("A")
B = TypeVar("B")


def available_cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class _Depth(local):
    """Depth of the current thread inside :func:`one_blas_thread`."""

    value = 0


_depth = _Depth()


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Return a context in which BLAS and OpenMP run on one thread; inside another one it costs nothing.

    Listing all loaded libraries takes some milliseconds, so it is done again only after something has been imported.
    """
    if _depth.value:
        yield
        return
    with _controller(len(sys.modules)).limit(limits=1):
        _depth.value += 1
        try:
            yield
        finally:
            _depth.value -= 1


@lru_cache(1)
def _controller(n_modules: int) -> ThreadpoolController:
    """Return the controller of all BLAS and OpenMP libraries; ``n_modules``: number of imported modules."""
    del n_modules
    return ThreadpoolController()


def parallel(function: Callable[[A], B], items: Iterable[A], threads: int | None = None) -> list[B]:
    """Return ``[function(item) for item in items]``, computed by Python threads with one BLAS thread each.

    ``threads``: how many at once, by default one for each available core; 1 gives a plain loop.
    """
    items = list(items)
    count = min(threads or available_cores(), max(len(items), 1))
    with one_blas_thread():
        if count == 1:
            return [function(item) for item in items]
        with ThreadPoolExecutor(count, initializer=_enter_worker) as pool:
            return list(pool.map(function, items))


def _enter_worker() -> None:
    """Mark a new worker thread as inside :func:`one_blas_thread`, whose limit holds for the whole process."""
    _depth.value = 1
    if _has_thread_limits():
        _controller(len(sys.modules)).limit(limits=1)


@cache
def _has_thread_limits() -> bool:
    """Return whether a BLAS on OpenMP is loaded, whose limit holds for one thread only."""
    return any(
        library["user_api"] == "blas" and library.get("threading_layer") == "openmp" for library in threadpool_info()
    )
