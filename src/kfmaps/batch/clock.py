"""How a run stands, and how long the rest will take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class RunStatus:
    """How a run stands.

    Attributes
    ----------
    shapes_done, shapes : int
        Shapes prepared (or found in the cache), of those that the run needs.
    pairs_done, failed, pairs : int
        Pairs with a result, those of them that failed, and all.
    workers : int
    remaining : float or None
        Seconds; ``None`` while nothing has been measured to tell it from.
    measured : int
        Pairs whose times the estimate rests on.
    """

    shapes_done: int
    shapes: int
    pairs_done: int
    failed: int
    pairs: int
    workers: int
    remaining: float | None
    measured: int


def remaining_seconds(
    shape_seconds: Sequence[float],
    pair_seconds: Sequence[float],
    shapes_left: int,
    pairs_left: int,
    workers: int,
) -> float | None:
    """What is left of each kind at the mean measured time of its kind, shared out between the workers.

    Work that is under way counts as if it had not begun, so the estimate is too long by up to one pair rather
    than too short. Less than the time of one pair it never is while a pair is left.

    Returns
    -------
    float or None
        ``None`` when there is something left of a kind of which nothing has been measured.
    """
    total = longest = 0.0
    for left, seconds in ((shapes_left, shape_seconds), (pairs_left, pair_seconds)):
        if left and not seconds:
            return None
        if left:
            mean = sum(seconds) / len(seconds)
            total += left * mean
            longest += mean if pairs_left else 0.0
    return max(total / workers, longest)
