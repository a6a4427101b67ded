"""The best placing of a part against the best that leaves it: a half that was cut lengthwise has two."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import KDTree

from kfmaps import datasets
from kfmaps.datasets.pairs import largest_piece
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.mesh import surface_area, unit_area
from kfmaps.matching.partial import compare_alternatives as contest
from kfmaps.matching.partial.alternatives import ELSEWHERE
from kfmaps.matching.partial.candidates import make_candidate
from kfmaps.matching.partial.compare_alternatives import (
    CLEAR,
    GAIN,
    HOPELESS,
    POLISHED,
    compare_alternatives,
    differ,
    margin,
    refine_candidate,
)
from kfmaps.matching.partial.registration import registration_target
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import part_samples
from kfmaps.matching.partial.scale_search import TRIALS, Placement, shot_similarity

GUARDS = ("kfmaps.matching.partial",)

NONE = np.zeros((0, 2), dtype=np.int64)
EMPTY: Any = None


@pytest.fixture(scope="module")
def half():
    """Sides and ground of a creature and of its left half in another pose, and where the half belongs."""
    pair = datasets.symmetric_creature(1500, rng=0)
    across = pair.source.vertices[pair.truth] - pair.source.vertices[pair.mirrored]
    part, own = largest_piece(pair.target, across @ np.linalg.svd(across, full_matrices=False)[2][0] > 0)
    whole = unit_area(pair.source)
    places = point_positions(PointMap(pair.truth_faces[own], pair.truth_weights[own]), whole)
    sides = part_samples(unit_area(part), 100), part_samples(whole, 300)
    scale = float(np.sqrt(surface_area(part) / surface_area(pair.source)))
    return *sides, registration_target(whole, sides[1].on_boundary), places, scale


def placed_at(half, places):
    """The candidate whose samples begin at ``places (q, 3)``."""
    part, whole, on, _, scale = half
    match = np.asarray(KDTree(whole.mesh.vertices[whole.samples]).query(places)[1])
    alike = shot_similarity(part, whole, scale, TRIALS[0].radii, NONE, 1)
    rough = Placement(scale, TRIALS[0], Assignment(match, np.ones(len(match)), 1.0), alike)
    return make_candidate(rough, rough, part, whole, on)


@pytest.fixture(scope="module")
def true(half):
    """The contest of the true placing alone."""
    part, whole, on, places, _ = half
    return compare_alternatives([placed_at(half, places[part.samples])], part, whole, on, NONE)


def error(half, one):
    return float(np.linalg.norm(one.bend.places.points - half[3], axis=1).mean())


def test_the_rival_of_a_lengthwise_half_is_looked_for(half, true):
    """Front to back on the other half: nobody proposed it, and the margin before it is the one that counts."""
    assert len(true) > 1
    assert error(half, true[0]) < 0.04
    assert all(error(half, one) > 0.15 for one in true[1:])
    assert all(differ(true[0].places, one.places) for one in true[1:])
    assert margin([(one.score, one.places) for one in true]) == pytest.approx(true[0].score - true[1].score)


def test_who_begins_on_the_wrong_half_comes_to_the_right_one(half, true):
    part, whole, on, _, _ = half
    found = compare_alternatives([placed_at(half, true[1].places)], part, whole, on, NONE)
    assert error(half, found[0]) < 0.05
    assert error(half, found[1]) > 0.15


def stub(score, x, gain=0.0) -> Any:
    """A candidate at the place ``x``, which gains so much whenever it is placed anew."""
    places = np.full((5, 3), float(x))
    bend = SimpleNamespace(scale=1.0, edge_ratio=1.0, inside=np.ones(3, dtype=bool))
    return SimpleNamespace(score=score, places=places, bend=bend, gain=gain, times=0)


def again(one, *_rest):
    return SimpleNamespace(**{**vars(one), "score": one.score + one.gain, "times": one.times + 1})


def test_rivals_are_polished_before_they_are_compared(monkeypatch):
    """The best at first, a copy of it, a rival that was hit by chance, and a third that is left behind."""
    monkeypatch.setattr(contest, "alternative_placements", lambda *_: [])
    monkeypatch.setattr(contest, "settled_in", again)
    found: Any = [stub(9.9, 0.01), stub(10.0, 0.0, 0.05), stub(9.0, 1.0, 0.6), stub(8.0, 2.0), stub(7.0, 3.0, 9.0)]
    last: Any = compare_alternatives(found, EMPTY, EMPTY, EMPTY, NONE)
    assert [one.places[0, 0] for one in last] == [1.0, 0.0, 2.0, 3.0]
    assert [one.times for one in last] == [POLISHED[1], POLISHED[0], POLISHED[0], 0]
    assert last[0].score == pytest.approx(9.0 + 0.6 * POLISHED[1])
    last = compare_alternatives(
        [stub(10.0, 0.0), stub(10.01 - HOPELESS, 1.0), stub(9.99 - HOPELESS, 2.0)], EMPTY, EMPTY, EMPTY, NONE
    )
    assert [one.times for one in last] == [POLISHED[0], POLISHED[0], 0]


def test_polishing_ends_where_nothing_is_gained(monkeypatch):
    monkeypatch.setattr(contest, "settled_in", again)
    for gain, times in ((0.99 * GAIN, POLISHED[0]), (1.01 * GAIN, POLISHED[1]), (-1.0, POLISHED[0])):
        last: Any = refine_candidate(stub(1.0, 0.0, gain), EMPTY, EMPTY, EMPTY, NONE)
        assert last.times == times


def test_only_candidates_that_differ_are_rivals():
    rng = np.random.default_rng(0)
    here = rng.normal(size=(50, 3))
    near, elsewhere = here + 0.01, here + 1.0
    assert not differ(here, here + 0.99 * ELSEWHERE / np.sqrt(3))
    assert differ(here, here + 1.01 * ELSEWHERE / np.sqrt(3))
    assert margin([(7.0, here)]) == CLEAR
    assert margin([(7.0, here), (6.9, near)]) == CLEAR
    assert margin([(7.0, here), (6.9, near), (6.6, elsewhere), (2.0, elsewhere)]) == pytest.approx(0.4)
    assert margin([(7.0, here), (2.0, elsewhere)]) == CLEAR
