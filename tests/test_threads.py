"""One BLAS thread inside, at any depth; what was before, after."""

import sys

import pytest
from threadpoolctl import ThreadpoolController, threadpool_info, threadpool_limits

from kfmaps._threads import _controller, available_cores, limit_threads, n_threads, one_blas_thread, parallel


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


def test_worker_threads_and_inner_limits_do_not_look_at_the_controller_again(looked):
    with limit_threads(2), one_blas_thread(), one_blas_thread():
        parallel(lambda _: parallel(lambda x: x, range(3)), range(10))
    assert len(looked) == 1


def test_the_controller_are_looked_through_again_only_after_an_import(looked, monkeypatch):
    for _ in range(3):
        with one_blas_thread():
            pass
    assert len(looked) == 1
    monkeypatch.setitem(sys.modules, "another_blas", sys)
    with one_blas_thread():
        assert blas_threads() == {1}
    assert len(looked) == 2


def test_worker_threads_are_held_to_one_too():
    with threadpool_limits(2), limit_threads(2):
        seen = parallel(lambda _: blas_threads(), range(4))
    assert seen == [{1}] * 4


def test_an_error_inside_lifts_it_too():
    with threadpool_limits(2):
        before = blas_threads()
        with pytest.raises(ZeroDivisionError), limit_threads(2):
            parallel(lambda x: 1 / x, [1, 0])
        assert blas_threads() == before


def test_parallel_keeps_the_order_of_its_items():
    with limit_threads(3):
        assert parallel(lambda x: x * x, range(20)) == [x * x for x in range(20)]


def test_contexts_lower_the_limit_and_workers_share_it():
    assert n_threads() == available_cores()
    with limit_threads(6):
        with limit_threads(8), limit_threads(None):
            assert n_threads() == 6
        with limit_threads(2):
            assert n_threads() == 2
        assert parallel(lambda _: n_threads(), range(2)) == [3, 3]
        assert set(parallel(lambda _: n_threads(), range(9))) == {1}
        assert n_threads() == 6
    assert n_threads() == available_cores()
