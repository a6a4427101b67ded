"""How thick two bodies are at each point: what slides a map back between shapes of other proportions.

A map may slide along a trunk or the root of a limb and functions, SHOT and the energy of bending do not mind: between
cats and dogs, gorillas and women SHOT is as like, or more so, at maps that have slid by 3 to 5 % of √area as at true
ones, and fits that begin with the truth slide as far. What differs, of cats and dogs at least, is how much heat stays
where it was put, the heat kernel signature of Sun, Ovsjanikov and Guibas (2009): at times in which it fills a limb, but
not the trunk, much in a thin part, and little in a thick one. There is no bend in it, and little of what the surface is
like near the point.

It makes wrong maps better as well as right ones, so it has no say in which is right: the one that has been chosen is
bent and matched in turn (:mod:`kfmaps.search.alternate`) once more.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kfmaps._arrays import NotConverged, to_numpy
from kfmaps.descriptors.spectral import heat_signature
from kfmaps.fit.shape import Shape
from kfmaps.functional.guide import Guide
from kfmaps.search.alternate import alternated, grounds, turned_round
from kfmaps.search.bends import MORE, copied
from kfmaps.search.candidates import FINE
from kfmaps.search.choose import Found
from kfmaps.search.marks import joined

TIMES = (0.005, 0.01, 0.02)
"""Diffusion times at unit area: the girth of a leg, of a neck, and where they widen into the trunk."""
WEIGHT = 2.0
"""Beside SHOT: half of it does less, and with twice as much gorillas and women lose."""


FLAT = 1.0
"""Root of the mean squared difference of two points below which it is not made more of: bodies have 1.3 to 1.5, a
sphere, evenly thick but for its triangulation, 0.01."""


def girth(source: Shape, target: Shape) -> Guide:
    """Logarithms of the heat that stays at each point at :data:`TIMES`, common to both shapes, at unit area.

    Two random points differ by 1 on average, by less where both shapes are about evenly thick.
    """
    sides = [np.log(_staying(shape)) for shape in (source, target)]
    both = np.vstack(sides)
    mean = both.mean(axis=0)
    size = max(np.sqrt(2 * float(((both - mean) ** 2).sum(axis=1).mean())), FLAT)
    return Guide(*((side - mean) / size for side in sides))


def _staying(shape: Shape) -> np.ndarray:
    return np.maximum(to_numpy(heat_signature(shape.basis, np.array(TIMES))).astype(np.float64), 1e-12)


def slid_back(found: Found, source: Shape, target: Shape, led: Guide | None) -> Found:
    """What was found between unlike shapes, bent and matched in turn once more, ``led`` and with :func:`girth`.

    The same body is bent as before. What was not mended stays as it is, as does what falls apart.
    """
    a, b = (None, None) if found.bent is None else (copied(source, MORE), copied(target, MORE))
    if a is None or b is None:
        return found
    both = grounds(source, target, (a, b), found.landmarks)
    led = joined([(1.0, led), (WEIGHT, girth(source, target))])
    C = found.functional_map
    if found.backwards:
        C, both, led = C.T, turned_round(both), led and Guide(led.target, led.source)
    try:
        again = alternated(C, both, led)
    except NotConverged:
        return found
    size = min(FINE, len(again.functional_map))
    C = again.functional_map[:size, :size]
    return replace(found, functional_map=C.T if found.backwards else C, bent=again.bent)
