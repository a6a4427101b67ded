"""The best of the placings that put a part elsewhere than where it was found: what its margin is tested by.

How far a placing is ahead of others says nothing if none of these was a serious one. A half of a body that was cut
lengthwise fits the other half nearly as well, turned front to back, and whichever of the two the search came upon first
draws the others to it. So once a placing is found, relaxation and the beam search are asked again, at its scale and a
little beside it, for the best that leave it: every sample pays for a place near the one that it has.
"""

from __future__ import annotations

import numpy as np

from kfmaps._threads import parallel
from kfmaps.matching.partial.beam_search import beam_search
from kfmaps.matching.partial.relaxation_labeling import distance_bounds, reassign, relax
from kfmaps.matching.partial.samples import PartSamples
from kfmaps.matching.partial.scale_search import TRIALS, Placement, shot_similarity

ELSEWHERE = 0.1
"""Median distance between places, in √area of the whole, from which two placings differ."""
PAID = 0.5
"""What a sample pays for a place nearer than that, where its consistency with the others is worth 2 at most."""
BESIDE = (1.0, 1.1, 1 / 1.1)
"""Scales that are tried, against that of the placing: a wrong one has a scale of its own."""


def alternative_placements(
    part: PartSamples,
    whole: PartSamples,
    scale: float,
    places: np.ndarray,
    pairs: np.ndarray,
    fixed: bool = False,
    threads: int | None = None,
) -> list[Placement]:
    """Samples placed elsewhere than at ``places (q, 3)`` on the whole, all that relaxation and beam searches find.

    ``scale``: √area of the part over that of the whole, the placing's own. ``pairs (l, 2)``: samples that are
    landmarks; these stay. ``fixed``: the scale is known.
    """
    off = apart(places, whole)
    paid = PAID * (off < ELSEWHERE).astype(np.float32)
    paid[: part.marks] = 0.0
    each = np.arange(len(places))

    def at(scale: float) -> list[Placement]:
        alike = shot_similarity(part, whole, scale, TRIALS[0].radii, pairs, 1)
        measure = distance_bounds(part.distances, part.boundary_distance, scale)
        left = alike - paid
        begun = beam_search(measure, part.boundary_distance * np.float32(scale), whole.distances, left, part.marks)
        begun.append(relax(measure, whole.distances, left, TRIALS[0], part.marks))
        placed = [reassign(measure, whole.distances, alike, one, part.marks) for one in begun]
        elsewhere = [one for one in placed if float(np.median(off[each, one.match])) > ELSEWHERE]
        return [Placement(scale, TRIALS[0], one, alike) for one in elsewhere]

    return [
        one
        for some in parallel(at, [scale * beside for beside in (BESIDE[:1] if fixed else BESIDE)], threads)
        for one in some
    ]


def apart(places: np.ndarray, whole: PartSamples) -> np.ndarray:
    """Distances (q, m), straight, of ``places (q, 3)`` from all samples of the whole."""
    there = whole.mesh.vertices[whole.samples]
    return np.linalg.norm(places[:, None] - there[None], axis=2)
