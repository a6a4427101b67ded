"""The best placing of a part against the best that leaves it: a half that was cut lengthwise has two."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import KDTree

from kfmaps import datasets
from kfmaps.datasets.pairs import largest_piece
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.mesh import surface_area, unit_area
from kfmaps.matching.partial import candidates as contest
from kfmaps.matching.partial.candidates import (
    _ROUNDS,
    _differ,
    _refine_candidate,
    compare_alternatives,
    make_candidate,
    margin,
)
from kfmaps.matching.partial.match_partial import _place_by_landmarks
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import PartPair, part_samples
from kfmaps.matching.partial.scale_search import TRIALS, Placement, shot_similarity
from kfmaps.matching.score import SCORE

GUARDS = ("kfmaps.matching.partial",)

EMPTY: Any = None


@pytest.fixture(scope="module")
def half():
    """Samples of a creature and of its left half in another pose, and where the half belongs."""
    pair = datasets.symmetric_creature(1500, rng=0)
    across = pair.source.vertices[pair.truth] - pair.source.vertices[pair.mirrored]
    part, own = largest_piece(pair.target, across @ np.linalg.svd(across, full_matrices=False)[2][0] > 0)
    whole = unit_area(pair.source)
    places = point_positions(PointMap(pair.truth_faces[own], pair.truth_weights[own]), whole)
    sides = PartPair(part_samples(unit_area(part), 100), part_samples(whole, 300))
    scale = float(np.sqrt(surface_area(part) / surface_area(pair.source)))
    return sides, places, scale


def placed_at(half, places):
    """The candidate whose samples begin at ``places (q, 3)``."""
    on, _, scale = half
    whole = on.whole
    match = np.asarray(KDTree(whole.mesh.vertices[whole.samples]).query(places)[1])
    alike = shot_similarity(on, scale, TRIALS[0])
    rough = Placement(scale, TRIALS[0], Assignment(match, np.ones(len(match)), 1.0), alike)
    return make_candidate(rough, on)


@pytest.fixture(scope="module")
def true(half):
    """The contest of the true placing alone."""
    on, places, _ = half
    return compare_alternatives([placed_at(half, places[on.part.samples])], on)


def error(half, one):
    return float(np.linalg.norm(one.registration.places.points - half[1], axis=1).mean())


def test_the_rival_of_a_lengthwise_half_is_looked_for(half, true):
    """Front to back on the other half: nobody proposed it, and the margin before it is the one that counts."""
    assert len(true) > 1
    assert error(half, true[0]) < 0.04
    assert all(error(half, one) > 0.15 for one in true[1:])
    assert all(_differ(true[0], one) for one in true[1:])
    assert margin(true) == pytest.approx(true[0].score - true[1].score)


def test_who_begins_on_the_wrong_half_comes_to_the_right_one(half, true):
    found = compare_alternatives([placed_at(half, true[1].points)], half[0])
    assert error(half, found[0]) < 0.05
    assert error(half, found[1]) > 0.15


def stub(score, x, gain=0.0) -> Any:
    """A candidate at the place ``x``, which gains so much whenever it is placed anew."""
    places = np.full((5, 3), float(x))
    bend = SimpleNamespace(scale=1.0, edge_ratio=1.0, inside=np.ones(3, dtype=bool))
    return SimpleNamespace(score=score, points=places, registration=bend, gain=gain, times=0)


def again(one, *_rest):
    return SimpleNamespace(**{**vars(one), "score": one.score + one.gain, "times": one.times + 1})


def test_rivals_are_polished_before_they_are_compared(monkeypatch):
    """The best at first, a copy of it, a rival that was hit by chance, and a third that is left behind."""
    monkeypatch.setattr(contest, "_alternative_placements", lambda *_: [])
    monkeypatch.setattr(contest, "_place_again", again)
    found: Any = [stub(9.9, 0.01), stub(10.0, 0.0, 0.05), stub(9.0, 1.0, 0.6), stub(8.0, 2.0), stub(7.0, 3.0, 9.0)]
    last: Any = compare_alternatives(found, EMPTY)
    assert [one.points[0, 0] for one in last] == [1.0, 0.0, 2.0, 3.0]
    assert [one.times for one in last] == [_ROUNDS[1], _ROUNDS[0], _ROUNDS[0], 0]
    assert last[0].score == pytest.approx(9.0 + 0.6 * _ROUNDS[1])
    last = compare_alternatives(
        [stub(10.0, 0.0), stub(10.01 - SCORE.part.hopeless_margin, 1.0), stub(9.99 - SCORE.part.hopeless_margin, 2.0)],
        EMPTY,
    )
    assert [one.times for one in last] == [_ROUNDS[0], _ROUNDS[0], 0]


def test_polishing_ends_where_nothing_is_gained(monkeypatch):
    monkeypatch.setattr(contest, "_place_again", again)
    for gain, times in (
        (0.99 * SCORE.part.min_gain, _ROUNDS[0]),
        (1.01 * SCORE.part.min_gain, _ROUNDS[1]),
        (-1.0, _ROUNDS[0]),
    ):
        last: Any = _refine_candidate(stub(1.0, 0.0, gain), EMPTY)
        assert last.times == times


def test_only_candidates_that_differ_are_rivals():
    apart, most = SCORE.part.distinct_distance / np.sqrt(3), SCORE.part.calibration.max_margin
    here, near, elsewhere = stub(7.0, 0.0), stub(6.9, 0.01), stub(6.6, 1.0)
    assert not _differ(here, stub(0.0, 0.99 * apart))
    assert _differ(here, stub(0.0, 1.01 * apart))
    assert margin([here]) == margin([here, near]) == margin([here, stub(2.0, 1.0)]) == most
    assert margin([here, near, elsewhere, stub(2.0, 1.0)]) == pytest.approx(0.4)


def test_a_small_part_needs_a_larger_margin():
    """A smooth patch fits everywhere: what a margin says goes with the area, and no rival at all says little."""
    full, most = np.sqrt(SCORE.part.full_area), SCORE.part.calibration.max_margin
    best, rival = stub(9.0, 0.0), stub(8.0, 1.0)
    for scale, share in ((1.0, 1.0), (full, 1.0), (full / 2, 1 / 4)):
        best.registration.scale = scale
        assert margin([best, rival]) == pytest.approx(share)
        assert margin([best]) == pytest.approx(share * most)
        assert margin([best, stub(-99.0, 1.0)]) == most
        assert margin([best, rival], 1) == pytest.approx(1.0)
        assert margin([best], 1) == most


@pytest.mark.parametrize(
    ("wrong", "first", "second", "others", "rejected"),
    [
        ([], 20.0, 99.0, None, []),  # all is well: no second placement
        ([1], 20.0, 21.0, [0, 2], [1]),  # one is wrong: the others place the part
        ([1], 20.0, 19.0, [0, 2], [1]),
        ([0, 2], 20.0, 21.0, [], [0, 2]),  # most are wrong: none does
        ([], 5.0, 20.0, [], [0, 1, 2]),  # it fits nowhere with them
        ([], 5.0, 4.0, [], []),
    ],
)
def test_landmarks_that_a_placement_contradicts_are_left_out(
    wrong: list[int], first: float, second: float, others: list[int] | None, rejected: list[int]
) -> None:
    whole: Any = SimpleNamespace(vertices=np.eye(3))
    pairs = np.stack([np.arange(3), np.arange(3)], axis=1)
    asked = []

    def place_with(*, landmarks: np.ndarray, **_: Any) -> Any:
        asked.append(landmarks[:, 0].tolist())
        off = np.zeros((3, 1))
        off[wrong if len(asked) == 1 or first > 10 else [0, 1, 2]] = 1.01 * SCORE.part.max_landmark_error
        moved = whole.vertices + off * [1.0, 0.0, 0.0]
        score = first if len(asked) == 1 else second
        return SimpleNamespace(registration=SimpleNamespace(vertices=moved), scores=(score,), margin=9.0)

    found, named = _place_by_landmarks(place_with, pairs, whole, SCORE.part.calibration)
    assert asked == [[0, 1, 2]] + ([] if others is None else [others])
    assert found.scores[0] == (first if others is None else max(first, second))
    assert np.flatnonzero(named).tolist() == rejected


def test_two_parts_are_judged_by_the_distances_in_their_overlap_alone(half, true, monkeypatch):
    pair, found = replace(half[0], both_partial=True), true[0].registration
    samples, whole = pair.part.samples, pair.whole
    overlap = np.zeros(len(found.vertices))
    overlap[samples[::2]] = 1.0
    monkeypatch.setattr(contest, "find_overlap", lambda *_: SimpleNamespace(part=overlap))
    places = whole.mesh.vertices[whole.samples]
    nearest = np.linalg.norm(found.vertices[samples][:, None] - places, axis=2).argmin(axis=1)
    fits, near = pair.pair_consistency(found.scale, nearest)
    wanted = fits[::2, ::2].sum() / near[::2, ::2].sum()
    judged = make_candidate(true[0].placement, pair).evidence
    assert contest._overlap_consistency(found, pair) == pytest.approx(wanted)
    assert judged.pair_consistency != true[0].evidence.pair_consistency == SCORE.part.usual_pair_consistency
