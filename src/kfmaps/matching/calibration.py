"""How sure a search is: the probability that its map is right.

"Right" means a mean geodesic error below 0.08 √area. A logistic function of the score says how likely that is of the
best map of a search; where a different map is nearly as good, it is the likelier the other one, down to one half
where both are equal; and where the source must bend much more than for other right maps of that score, something that
the score does not see is wrong: a left bone on a right one. Landmarks that the map keeps without being led by them take
away what doubt there is, as far as they reach. The formula is in docs/mathematics.md, its data in research/verdict.md.
"""

from __future__ import annotations

import math

from scipy.special import expit

SLOPE, MIDDLE = 0.92, -10.0
"""Of the logistic function of the score, and the score at which half of all maps are right."""
TIE = 0.4
"""Margin at which the doubt that a different map casts is down to a third."""
BENT, PER_SCORE = -3.6, -0.233
"""Logarithm of the bending energy that right maps have, at a score of 0, and its change with the score."""
MUCH, WIDTH = 0.65, 0.08
"""By how much that logarithm is exceeded where half of all maps are wrong, and how fast their share grows there: in the
middle between the highest of a right map of nearly isometric shapes, 0.38, and the lowest of creatures on their mirror
images, 0.9."""
SURE = 0.9
"""Probability from which a map is called sure; wrong ones have had up to 0.83."""


def probability(score: float, margin: float, bending: float | None = None, backing: float = 0.0) -> float:
    """That a map of this ``score`` is right, when the best different one is ``margin`` behind.

    ``bending``: see :func:`kfmaps.registration.deformation_energy.deformation_energy`; ``None`` where nothing can be
    bent.
    ``backing``: how far
    landmarks speak for it, from 0 to 1 (:func:`kfmaps.matching.landmark_evidence.landmark_support`).
    """
    fits = float(expit(SLOPE * (score - MIDDLE)))
    if bending is not None:
        fits *= float(expit((MUCH - excess_deformation(score, bending)) / WIDTH))
    alone = fits * (1.0 - 0.5 * math.exp(-max(margin, 0.0) / TIE))
    return alone + (1.0 - alone) * backing


def excess_deformation(score: float, bending: float) -> float:
    """By how much the logarithm of the bending energy exceeds that of right maps of such a ``score``."""
    return math.log(bending) - BENT - PER_SCORE * score


def verdict(score: float, margin: float, bending: float | None = None, backing: float = 0.0) -> str:
    """ "sure", "poor" where the map would not be sure without any rival, or "ambiguous"."""
    if probability(score, margin, bending, backing) >= SURE:
        return "sure"
    return "poor" if probability(score, math.inf, bending, backing) < SURE else "ambiguous"
