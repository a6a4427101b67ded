"""Intervals for means over pairs, by the bootstrap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import check, check_count, refuse


@dataclass(frozen=True)
class Interval:
    """A value and the ends of its 95 % interval."""

    value: float
    low: float
    high: float

    def text(self, digits: int = 2) -> str:
        """``value [low, high]``."""
        return f"{self.value:.{digits}f} [{self.low:.{digits}f}, {self.high:.{digits}f}]"


def resamples(count: int, draws: int = 10_000, rng: int | np.random.Generator | None = 0) -> np.ndarray:
    """``(draws, count)`` row numbers drawn with replacement."""
    check_count(count, "pairs")
    check_count(draws, "draws")
    return np.random.default_rng(rng).integers(count, size=(draws, count))


def paired_bootstrap(
    a: np.ndarray,
    b: np.ndarray,
    statistic: Callable[[np.ndarray, np.ndarray], np.ndarray],
    draws: int = 10_000,
    rng: int | np.random.Generator | None = 0,
) -> Interval:
    """Percentile interval of a statistic of two means over the same pairs (Efron 1979).

    Pairs are drawn with replacement, ``a`` and ``b`` together, so that what is easy or hard for both cancels.

    Parameters
    ----------
    a, b : (p,)
        Values of two methods on the same pairs, in the same order.
    statistic : callable
        Of arrays of means of ``a`` and of ``b``, for instance their difference.
    draws : int
    rng : seed or Generator
    """
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    check(a, "a", shape=(None,))
    check(b, "b", shape=a.shape, remedy="give values of the same pairs in the same order")
    if a.size == 0:
        raise refuse("a", "at least one pair", "none", "run some")
    rows = resamples(len(a), draws, rng)
    samples = statistic(a[rows].mean(axis=1), b[rows].mean(axis=1))
    low, high = np.percentile(samples, [2.5, 97.5])
    return Interval(float(statistic(a.mean(), b.mean())), float(low), float(high))


def difference(a: np.ndarray, b: np.ndarray, **options: int) -> Interval:
    """``mean(a) - mean(b)`` with its interval; see :func:`paired_bootstrap`."""
    return paired_bootstrap(a, b, lambda x, y: x - y, **options)


def ratio(a: np.ndarray, b: np.ndarray, **options: int) -> Interval:
    """``mean(a) / mean(b)`` with its interval; see :func:`paired_bootstrap`."""
    return paired_bootstrap(a, b, lambda x, y: x / y, **options)
