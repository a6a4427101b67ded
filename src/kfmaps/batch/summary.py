"""What a collection's results come to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kfmaps.batch.results import CURVE_ERRORS, Result
from kfmaps.viz import Curve, mean_curve

BAD = 0.05
"""A mean error above this counts as a wrong map."""


LIMITS = (0.02, 0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5)


@dataclass(frozen=True)
class Summary:
    """Numbers over all pairs; errors in units of √area, ``None`` where no truth is known.

    Attributes
    ----------
    done, failed : int
    evaluated : int
        Pairs whose truth is known.
    error_mean : float or None
        Mean over the pairs of each pair's mean error.
    error_median, error_worst : float or None
        Median and largest of the pairs' mean errors.
    bad : int
        Pairs with a mean error above :data:`BAD`.
    flipped : int
        Pairs that are nearer to the mirrored truth than to the truth.
    seconds_mean, seconds_total : float or None
        Of the pairs' matching, without the shapes' preparation.
    verdicts : dict of str to int
    mirrored : int
        Pairs whose mirrored truth is known.
    parts : int
        Pairs of which one shape was taken for a part of the other.
    agreed, changed : int
        Pairs that were set beside the others of the collection, and those of them whose map was exchanged.
    """

    done: int
    failed: int
    evaluated: int
    error_mean: float | None
    error_median: float | None
    error_worst: float | None
    bad: int
    flipped: int
    seconds_mean: float | None
    seconds_total: float | None
    verdicts: dict[str, int]
    mirrored: int = 0
    agreed: int = 0
    changed: int = 0
    parts: int = 0


def summarised(results: Sequence[Result]) -> Summary:
    """The numbers of some results."""
    done = [r for r in results if r.status == "done"]
    errors = np.array([r.error_mean for r in done if r.error_mean is not None])
    seconds = [r.seconds["total"] for r in done if "total" in r.seconds]
    verdicts = dict.fromkeys(sorted(r.verdict for r in done), 0)
    for r in done:
        verdicts[r.verdict] += 1
    flipped = [
        r for r in done if r.mirrored_mean is not None and r.error_mean is not None and r.mirrored_mean < r.error_mean
    ]
    return Summary(
        done=len(done),
        failed=len(results) - len(done),
        evaluated=len(errors),
        error_mean=float(errors.mean()) if len(errors) else None,
        error_median=float(np.median(errors)) if len(errors) else None,
        error_worst=float(errors.max()) if len(errors) else None,
        bad=int((errors > BAD).sum()),
        flipped=len(flipped),
        seconds_mean=float(np.mean(seconds)) if seconds else None,
        seconds_total=float(np.sum(seconds)) if seconds else None,
        verdicts=verdicts,
        mirrored=sum(r.mirrored_mean is not None for r in done),
        agreed=sum(r.agreement is not None for r in done),
        changed=sum(bool(r.changed) for r in done),
        parts=sum(r.common_s is not None for r in done),
    )


def fitting_limit(results: Sequence[Result]) -> float:
    """Where an error's colours end, in √area: a round number a little above the errors that are not plainly wrong.

    The same for all pictures of a collection, so that they can be compared.
    """
    errors = [r.error_mean for r in results if r.error_mean is not None]
    usual = [e for e in errors if e <= BAD] or errors
    wanted = 3 * max(usual, default=LIMITS[-1])
    return next((limit for limit in LIMITS if limit >= wanted), LIMITS[-1])


def worst_first(results: Sequence[Result]) -> list[Result]:
    """Those that are done, the largest mean error first; where no truth is known, the least sure first.

    With landmarks there was no search to be sure of, and the mean confidence of the vertices decides.
    """
    done = [r for r in results if r.status == "done"]

    def rank(r: Result) -> tuple[float, ...]:
        sure = [float("inf") if c is None else c for c in (r.confidence, r.local_confidence)]
        return (-(r.error_mean if r.error_mean is not None else -1.0), *sure)

    return sorted(done, key=rank)


def error_curve_of(results: Sequence[Result], label: str) -> Curve | None:
    """The mean error curve of the pairs whose truth is known, with the band of the middle 80 % of them."""
    curves = [r.curve for r in results if r.status == "done" and r.curve]
    return mean_curve(label, np.array(CURVE_ERRORS), np.array(curves)) if curves else None
