"""How sure the place of a part is: the probability that it is right, from what a candidate shows without the truth.

"Right" means a mean geodesic error below 0.08 √area of the whole, as for whole shapes. A logistic function of the score
says how likely that is of the best candidate; where one that puts the part elsewhere is nearly as good, it is the
likelier that one, down to one half where both are equal. That other one has been looked for and was given every chance
(:mod:`kfmaps.matching.partial.compare_alternatives`). The numbers are fitted to candidates of which the truth was
known, right ones and wrong;
research/parts.md says of which shapes, and how well it does on kinds that it was not fitted to.
"""

from __future__ import annotations

import math

from scipy.special import expit

MIDDLE, WIDTH = 16.2, 0.43
"""Score at which half of all placings are right, and how fast their share grows there."""
CLOSE = 1.3
"""Margin at which the doubt that a rival casts is down to a third. Placings of halves cut lengthwise have been ahead of
the right one by 0.9, where that had come near its place and not into it."""
SURE = 0.8
POOR = 0.5


def part_probability(score: float, margin: float) -> float:
    """That a part is placed right; see :class:`kfmaps.matching.partial.place_part.PlacedPart`."""
    rival = math.exp(-max(margin, 0.0) / CLOSE)
    return _fits(score) * (1.0 - rival / 2)


def part_verdict(score: float, margin: float) -> str:
    """ "sure", "poor" where the part fits nowhere, rivals or not, or "ambiguous"."""
    if part_probability(score, margin) >= SURE:
        return "sure"
    return "poor" if _fits(score) < POOR else "ambiguous"


def _fits(score: float) -> float:
    return float(expit((score - MIDDLE) / WIDTH))
