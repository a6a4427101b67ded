"""95 % intervals for differences and ratios of two methods' mean errors on the same pairs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import bootstrap

from kfmaps._arrays import check


@dataclass(frozen=True)
class Interval:
    """A value and the ends of its 95 % interval."""

    value: float
    low: float
    high: float

    def text(self) -> str:
        """Return "value [low, high]" with two decimals."""
        return f"{self.value:.2f} [{self.low:.2f}, {self.high:.2f}]"


def difference(a: np.ndarray, b: np.ndarray) -> Interval:
    """Return ``mean(a) - mean(b)`` with the percentile interval of a paired bootstrap (Efron 1979).

    ``a, b (p,)`` are values of two methods on the same pairs in the same order; pairs are drawn with replacement.
    """
    return _interval(a, b, lambda x, y, axis: x.mean(axis) - y.mean(axis))


def ratio(a: np.ndarray, b: np.ndarray) -> Interval:
    """Return ``mean(a) / mean(b)`` with its interval; see :func:`difference`."""
    return _interval(a, b, lambda x, y, axis: x.mean(axis) / y.mean(axis))


def _interval(a: np.ndarray, b: np.ndarray, statistic) -> Interval:
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    check(b, "b", shape=a.shape, remedy="give values of the same pairs in the same order")
    value = float(statistic(a, b, 0))
    if len(a) < 2:
        return Interval(value, value, value)
    options = {"paired": True, "vectorized": True, "n_resamples": 10_000, "method": "percentile", "rng": 0}
    low, high = bootstrap((a, b), statistic, **options).confidence_interval
    return Interval(value, float(low), float(high))
