"""How sure the place of a part is: the probability that it is right, from what a candidate shows without the truth.

"Right" means a mean geodesic error below 0.08 √area of the whole, as for whole shapes. The numbers are a logistic fit
to candidates of which the truth was known, right ones and wrong; docs/parts.md says of which shapes, and how well it
does on kinds that it was not fitted to.
"""

from __future__ import annotations

import math

WEIGHTS = (0.91, 2.37, 1.73)
"""Of the score, of its margin and of minus the logarithm of the bending, in the logarithm of the odds."""
CONSTANT = -13.36
LITTLE = 0.005
"""Bending that any part shows, by its mesh alone."""
SURE = 0.8
POOR = 0.5


def part_probability(score: float, margin: float, bending: float) -> float:
    """That a part is placed right; see :class:`kfmaps.parts.choose.Parted` and its evidence."""
    firm = -math.log(max(bending, 0.0) + LITTLE)
    odds = CONSTANT + WEIGHTS[0] * score + WEIGHTS[1] * margin + WEIGHTS[2] * firm
    return 1.0 / (1.0 + math.exp(-min(max(odds, -700.0), 700.0)))


def part_verdict(probability: float) -> str:
    """ "sure", "ambiguous" or "poor"."""
    return "sure" if probability >= SURE else "ambiguous" if probability >= POOR else "poor"
