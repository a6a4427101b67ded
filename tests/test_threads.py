"""One BLAS thread inside, at any depth; what was before, after."""

import sys

import pytest
from threadpoolctl import ThreadpoolController, threadpool_info, threadpool_limits

from kfmaps._threads import _controller, one_blas_thread, parallel


def blas_threads() -> set[int]:
    return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}


def test_the_limit_holds_until_the_outermost_is_left():
    with threadpool_limits(2):
        before = blas_threads()
        with one_blas_thread():
            with one_blas_thread():
                assert blas_threads() == {1}
            assert blas_threads() == {1}
        assert blas_threads() == before


@pytest.fixture
def looked(monkeypatch) -> list[None]:
    """One entry for each time that the loaded libraries are looked through."""
    seen: list[None] = []

    def counted() -> ThreadpoolController:
        seen.append(None)
        return ThreadpoolController()

    monkeypatch.setattr("kfmaps._threads.ThreadpoolController", counted)
    monkeypatch.setattr("kfmaps._threads._has_thread_limits", lambda: False)
    _controller.cache_clear()
    return seen


def test_worker_threads_and_inner_limits_do_not_look_at_the_libraries_again(looked):
    with one_blas_thread(), one_blas_thread():
        parallel(lambda _: parallel(lambda x: x, range(3), threads=1), range(10), threads=2)
    assert len(looked) == 1


def test_the_libraries_are_looked_through_again_only_after_an_import(looked, monkeypatch):
    for _ in range(3):
        with one_blas_thread():
            pass
    assert len(looked) == 1
    monkeypatch.setitem(sys.modules, "another_blas", sys)
    with one_blas_thread():
        assert blas_threads() == {1}
    assert len(looked) == 2


def test_worker_threads_are_held_to_one_too():
    with threadpool_limits(2):
        seen = parallel(lambda _: blas_threads(), range(4), threads=2)
    assert seen == [{1}] * 4


def test_an_error_inside_lifts_it_too():
    with threadpool_limits(2):
        before = blas_threads()
        with pytest.raises(ZeroDivisionError):
            parallel(lambda x: 1 / x, [1, 0], threads=2)
        assert blas_threads() == before


def test_parallel_keeps_the_order_of_its_items():
    assert parallel(lambda x: x * x, range(20), threads=3) == [x * x for x in range(20)]
