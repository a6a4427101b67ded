"""How sure the place of a part is: the probability that it is right, from what a candidate shows without the truth.

"Right" means a mean geodesic error below 0.08 √area of the whole, as for whole shapes. The numbers are a logistic fit;
docs/parts.md says to what.
"""

from __future__ import annotations

import math

from kfmaps.parts.choose import Parted

SLOPE, MIDDLE = 3.0, 5.8
"""Of the logistic function of the score, and the score at which half of all are right."""
SURE = 0.85
POOR = 0.5


def part_probability(found: Parted) -> float:
    """That a part is placed right."""
    return 1.0 / (1.0 + math.exp(-min(max(SLOPE * (found.score - MIDDLE), -700.0), 700.0)))


def part_verdict(probability: float) -> str:
    """ "sure", "ambiguous" or "poor"."""
    return "sure" if probability >= SURE else "ambiguous" if probability >= POOR else "poor"
