"""BLAS threads and Python threads, kept from multiplying each other.

Several BLAS threads make factorisations, triangular solves and small products slower, and on a busy machine
much slower. So BLAS is held to one thread around such loops and the parallelism sits above it, in Python
threads: NumPy and SciPy release the interpreter's lock inside their products and solves.
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
    """How deep the current thread is inside :func:`one_blas_thread`."""

    value = 0


_depth = _Depth()


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Return a context in which BLAS and OpenMP run on one thread; within another one it costs nothing.

    To look through all loaded libraries takes some milliseconds, more than a small search: so it is done again only
    after something has been imported.
    """
    if _depth.value:
        yield
        return
    with _libraries(len(sys.modules)).limit(limits=1):
        _depth.value += 1
        try:
            yield
        finally:
            _depth.value -= 1


@lru_cache(1)
def _libraries(modules: int) -> ThreadpoolController:
    """Return the control of all BLAS and OpenMP libraries; ``modules``: how many modules are imported."""
    del modules
    return ThreadpoolController()


def parallel(function: Callable[[A], B], items: Iterable[A], threads: int | None = None) -> list[B]:
    """Return ``[function(item) for item in items]``, by Python threads, with BLAS held to one thread.

    ``threads``: how many at once; ``None`` takes every available core. With 1 it is a plain loop.
    """
    items = list(items)
    count = min(threads or available_cores(), max(len(items), 1))
    with one_blas_thread():
        if count == 1:
            return [function(item) for item in items]
        with ThreadPoolExecutor(count, initializer=_held) as pool:
            return list(pool.map(function, items))


def _held() -> None:
    """Tell a new worker thread that BLAS is on one thread already, for the whole process."""
    _depth.value = 1
    if _per_thread():
        _libraries(len(sys.modules)).limit(limits=1)


@cache
def _per_thread() -> bool:
    """Whether a BLAS on OpenMP is loaded, which keeps its limit for each thread apart."""
    return any(
        library["user_api"] == "blas" and library.get("threading_layer") == "openmp" for library in threadpool_info()
    )
