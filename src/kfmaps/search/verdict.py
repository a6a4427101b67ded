"""How sure a search is: the probability that its map is right.

"Right" means a mean geodesic error below 0.08 √area. A logistic function of the score says how likely that is of the
best map of a search; where a different map scores nearly as well, it is the likelier the other one, down to one half
where both are equal. The numbers and what they rest on are in docs/automatic.md.
"""

from __future__ import annotations

import math

SLOPE, MIDDLE = 0.92, -10.5
"""Of the logistic function of the score, and the score at which half of all maps are right."""
TIE = 0.4
"""Margin of the score at which the doubt that a different map casts is down to a third."""
SURE = 0.85
"""Probability from which a map is called sure."""


def probability(score: float, margin: float) -> float:
    """That a map of this ``score`` is right, when the best different one is ``margin`` behind."""
    fits = 1.0 / (1.0 + math.exp(-min(max(SLOPE * (score - MIDDLE), -700.0), 700.0)))
    return fits * (1.0 - 0.5 * math.exp(-max(margin, 0.0) / TIE))


def verdict(score: float, margin: float) -> str:
    """ "sure", "poor" where the map would not be sure without any rival, or "ambiguous"."""
    if probability(score, margin) >= SURE:
        return "sure"
    return "poor" if probability(score, math.inf) < SURE else "ambiguous"
