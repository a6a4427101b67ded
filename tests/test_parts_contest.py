"""The best placing of a part against the best that leaves it: a half that was cut lengthwise has two."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import KDTree

from kfmaps import datasets
from kfmaps.app.datasets.pairs import largest_piece
from kfmaps.functional.precise import PointMap, points_of
from kfmaps.parts import contest
from kfmaps.parts.bend import ground
from kfmaps.parts.candidates import laid
from kfmaps.parts.contest import CLEAR, GAIN, POLISHED, contested, differ, margin, polished
from kfmaps.parts.labels import Placed
from kfmaps.parts.rivals import ELSEWHERE
from kfmaps.parts.side import side
from kfmaps.parts.units import TRIALS, Rough, likeness
from kfmaps.surface.mesh import surface_area, unit_area

NONE = np.zeros((0, 2), dtype=np.int64)


@pytest.fixture(scope="module")
def half():
    """Sides and ground of a creature and of its left half in another pose, and where the half belongs."""
    pair = datasets.symmetric_creature(1500, rng=0)
    across = pair.source.vertices[pair.truth] - pair.source.vertices[pair.mirrored]
    part, own = largest_piece(pair.target, across @ np.linalg.svd(across, full_matrices=False)[2][0] > 0)
    whole = unit_area(pair.source)
    places = points_of(PointMap(pair.truth_faces[own], pair.truth_weights[own]), whole)
    sides = side(unit_area(part), 100), side(whole, 300)
    scale = float(np.sqrt(surface_area(part) / surface_area(pair.source)))
    return *sides, ground(whole, sides[1].border), places, scale


def placed_at(half, places):
    """The candidate whose samples begin at ``places (q, 3)``."""
    part, whole, on, _, scale = half
    match = KDTree(whole.mesh.vertices[whole.samples]).query(places)[1]
    alike = likeness(part, whole, scale, TRIALS[0].radii, NONE, 1)
    rough = Rough(scale, TRIALS[0], Placed(match, np.ones(len(match)), 1.0), alike)
    return laid(rough, rough, part, whole, on)


def test_half(half):
    part, whole, on, places, _ = half
    true = placed_at(half, places[part.samples])
    found = contested([true], part, whole, on, NONE)
    for one in found: print(one.score, one.bend.scale, np.linalg.norm(one.bend.places.points-places,axis=1).mean(), one.seen)
    print(margin([(one.score, one.places) for one in found]))
