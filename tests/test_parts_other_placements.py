"""Placings by a beam search, and those that leave the one a part has: on a sheet that half a turn lays on itself."""

from dataclasses import replace

import numpy as np
import pytest

from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.partial import scale_search
from kfmaps.matching.partial.beam_search import _ANCHORS, _MIN_DISTANCE, _select_anchors, _select_different, beam_search
from kfmaps.matching.partial.candidates import _SCALE_RATIOS, _alternative_placements
from kfmaps.matching.partial.place_part import _places_differ
from kfmaps.matching.partial.relaxation_labeling import Assignment, consistency, distance_bounds
from kfmaps.matching.partial.samples import PartPair, PartSamples
from kfmaps.matching.partial.scale_search import (
    MAX_SCALE,
    MIN_MARKED_SCALE,
    MIN_SCALE,
    TRIALS,
    Placement,
    _shot_scale,
    refine_placement,
)
from kfmaps.matching.partial.two_parts import consistent_trust
from kfmaps.matching.score import SCORE

GUARDS = (
    "kfmaps.matching.partial",
    "kfmaps.matching.partial.beam_search",
    "kfmaps.matching.partial.relaxation_labeling",
)

HALF = 60
OTHER = np.roll(np.arange(2 * HALF), HALF)
"""Where half a turn takes each point."""
SCALE = 0.5


def sheet(landmarks=0, output=0.05):
    """Points of a sheet, as a part in another unit and as a whole; descriptors know a little which is which."""
    rng = np.random.default_rng(0)
    points = rng.uniform(-0.5, 0.5, size=(HALF, 3)) * [1.0, 0.6, 0.0]
    points = np.concatenate([points, -points])
    between = np.linalg.norm(points[:, None] - points[None], axis=2).astype(np.float32)
    each, endless = np.arange(2 * HALF), np.full(2 * HALF, np.inf, dtype=np.float32)
    own = np.eye(2 * HALF, dtype=np.float32)
    sides = []
    for scale in (SCALE, 1.0):
        mesh = Mesh(points / scale, np.zeros((0, 3), dtype=np.int64))
        known = {
            radius / (beside if scale == 1.0 else _shot_scale(SCALE * beside)): own
            * np.float32(output if scale == 1.0 else 1.0)
            for radius in TRIALS[0].radii
            for beside in _SCALE_RATIOS
        }
        sides.append(PartSamples(mesh, each, between / np.float32(scale), endless, landmarks, known))
    return points, *sides


def test_the_best_rival_is_the_other_way_that_distances_allow():
    points, part, whole = sheet()
    measure = distance_bounds(part.distances, part.boundary_distance, SCALE)
    first = beam_search(measure, part.boundary_distance, whole.distances, 0.05 * np.eye(2 * HALF, dtype=np.float32))[0]
    assert (first.match == np.arange(2 * HALF))[first.trust > 0].all()
    found = _alternative_placements(PartPair(part, whole), SCALE, points)
    assert np.median(np.linalg.norm(points[found[0].placed.match] - points[OTHER], axis=1)) < 0.02
    assert found[0].placed.support > 0.9
    assert {one.scale for one in found} == {SCALE * beside for beside in _SCALE_RATIOS}
    fixed = _alternative_placements(PartPair(part, whole, True), SCALE, points)
    assert {one.scale for one in fixed} == {SCALE}
    # And from there the rival is where it was before.
    back = _alternative_placements(PartPair(part, whole), SCALE, points[OTHER])
    assert np.median(np.linalg.norm(points[back[0].placed.match] - points, axis=1)) < 0.02


def test_rivals_lie_elsewhere_and_have_the_scale_of_the_placing():
    points, part, whole = sheet()
    for one in _alternative_placements(PartPair(part, whole), SCALE, points):
        assert one.scale in [SCALE * beside for beside in _SCALE_RATIOS]
        assert np.median(np.linalg.norm(points[one.placed.match] - points, axis=1)) > SCORE.part.distinct_distance


def test_a_landmark_allows_no_rival_that_moves_it():
    points, part, whole = sheet(landmarks=2)
    for one in _alternative_placements(PartPair(part, whole), SCALE, points):
        assert one.placed.match[:2].tolist() == [0, 1]
        assert one.placed.support < 0.9


def test_distances_of_two_parts_agree_as_far_as_ways_around_both_boundaries_explain():
    _, part, whole = sheet()
    rng = np.random.default_rng(1)
    away = [rng.uniform(0, 0.3, 2 * HALF).astype(np.float32) for _ in range(2)]
    part, whole = replace(part, boundary_distance=away[0] / SCALE), replace(whole, boundary_distance=away[1])
    match = rng.permutation(2 * HALF)
    fits, near = PartPair(part, whole, both_partial=True).pair_consistency(SCALE, match)
    for i, j in ((0, 1), (5, 50), (60, 61), (7, 90)):
        one, other = part.distances[i, j] * SCALE, whole.distances[match[i], match[j]]
        shortest = min(one, away[0][i] + away[0][j]), min(other, away[1][match[i]] + away[1][match[j]])
        change = max(shortest[0] - other, shortest[1] - one, 0.0)
        assert near[i, j] == (one < 0.6)
        wanted = consistency(np.array([one]), np.array([one]), np.array([one + change])) if near[i, j] else 0.0
        np.testing.assert_allclose(fits[i, j], wanted, atol=1e-5)
    assert not near.diagonal().any()


def test_samples_without_a_place_are_not_trusted():
    _, part, whole = sheet()
    pair = PartPair(part, whole, both_partial=True)
    match = np.arange(2 * HALF)
    match[80:] = np.random.default_rng(0).permutation(40) + 80
    moved = match != np.arange(2 * HALF)
    trust = consistent_trust(*pair.pair_consistency(SCALE, match), np.full(2 * HALF, 0.5), 0)
    assert trust[~moved].min() > 0.6
    assert np.median(trust[moved]) == 0.0


def test_landmarks_are_trusted_wherever_they_are():
    _, part, whole = sheet(landmarks=2)
    match = np.arange(2 * HALF)
    match[:2] = OTHER[:2]
    agreement = PartPair(part, whole, both_partial=True).pair_consistency(SCALE, match)
    trust = [consistent_trust(*agreement, np.full(2 * HALF, 0.5), count)[:2] for count in (2, 0)]
    assert trust[0].tolist() == [1.0, 1.0]
    assert trust[1].max() < 0.5


@pytest.mark.parametrize(
    ("longer", "landmarks", "end"),
    [(0.01, 0, MIN_SCALE), (0.01, 2, MIN_MARKED_SCALE), (100.0, 0, MAX_SCALE), (1.0, 0, SCALE)],
)
def test_a_part_neither_vanishes_nor_outgrows_the_whole(monkeypatch, longer: float, landmarks: int, end: float) -> None:
    _, part, whole = sheet(landmarks)
    alike, placed = np.eye(2 * HALF), Assignment(np.arange(2 * HALF), np.ones(2 * HALF), 1.0)
    monkeypatch.setattr(scale_search, "scale_change", lambda *_: longer)
    monkeypatch.setattr(scale_search, "shot_similarity", lambda *_: alike)
    start = Placement(SCALE, TRIALS[0], placed, alike)
    assert refine_placement(PartPair(part, whole), start).scale == end
    assert refine_placement(PartPair(part, whole, fixed_scale=True), start).scale == SCALE


@pytest.fixture(scope="module")
def plane():
    """A whole of random points with a middle part of them; distances are straight, and only the part has an edge."""
    rng = np.random.default_rng(0)
    points = rng.uniform(-0.5, 0.5, size=(200, 3)) * [1.0, 0.6, 0.3]
    own = np.flatnonzero(points[:, 0] < 0.2)
    between = np.linalg.norm(points[:, None] - points[None], axis=2).astype(np.float32)
    edge = (0.2 - points[own, 0]).astype(np.float32)
    return points, own, between, edge


def test_anchors_are_far_from_each_other_and_from_the_edge(plane):
    _, own, between, edge = plane
    part = distance_bounds(between[np.ix_(own, own)], edge, 1.0)
    chosen = _select_anchors(part, edge, _ANCHORS)
    assert len(set(chosen.tolist())) == _ANCHORS
    rng = np.random.default_rng(1)
    least = [
        float((part.upper[np.ix_(some, some)] + 9 * np.eye(_ANCHORS)).min())
        for some in (rng.permutation(len(own))[:_ANCHORS] for _ in range(50))
    ]
    assert float((part.upper[np.ix_(chosen, chosen)] + 9 * np.eye(_ANCHORS)).min()) > max(least)
    plain = _select_anchors(part, np.full(len(own), np.inf), _ANCHORS)
    assert edge[chosen].mean() > edge[plain].mean()
    assert edge[chosen].min() > 2 * edge[plain].min()
    assert chosen[0] == edge.argmax()
    assert _select_anchors(part, edge, _ANCHORS, 3)[:3].tolist() == [0, 1, 2]


def test_distances_alone_place_a_part(plane):
    """Descriptors that say nothing: the placing is the true one, up to what distances cannot tell."""
    _, own, between, edge = plane
    part = distance_bounds(between[np.ix_(own, own)], edge, 1.0)
    alike = np.zeros((len(own), len(between)), dtype=np.float32)
    found = beam_search(part, edge, between, alike)
    first = found[0]
    anchors = np.flatnonzero(first.trust)
    assert len(anchors) == _ANCHORS
    assert between[first.match[anchors], own[anchors]].max() < 0.1
    assert first.support > 0.9
    assert [one.support for one in found] == sorted((one.support for one in found), reverse=True)
    half = beam_search(distance_bounds(part.upper, edge, 0.5), 0.5 * edge, between, alike)
    assert half[0].support < first.support


def test_a_descriptor_that_knows_decides_between_mirror_images():
    """Of points on a line the distances fit both ways round; one descriptor tells which."""
    line = np.linspace(-0.5, 0.5, 81)
    between = np.abs(line[:, None] - line[None]).astype(np.float32)
    part = distance_bounds(between, np.full(81, np.inf, dtype=np.float32), 1.0)
    alike = np.zeros((81, 81), dtype=np.float32)
    for way in (1, -1):
        output = alike.copy()
        output[np.arange(81), np.arange(81)[::way]] = 1.0
        first = beam_search(part, np.full(81, np.inf, dtype=np.float32), between, output)[0]
        anchors = np.flatnonzero(first.trust)
        np.testing.assert_array_equal(first.match[anchors], np.arange(81)[::way][anchors])


def test_descriptors_count_while_placings_are_weeded_out():
    """All distances are alike, so that descriptors alone can keep the few that are right among too many to keep."""
    count = 200
    between = (0.3 * (1 - np.eye(count))).astype(np.float32)
    alike = np.zeros((count, count), dtype=np.float32)
    alike[np.arange(count), np.arange(count)[::-1]] = 1.0
    edge = np.full(count, np.inf, dtype=np.float32)
    first = beam_search(distance_bounds(between, edge, 1.0), edge, between, alike)[0]
    anchors = np.flatnonzero(first.trust)
    np.testing.assert_array_equal(first.match[anchors], count - 1 - anchors)


def test_a_landmark_stays_where_it_is(plane):
    _, own, between, edge = plane
    part = distance_bounds(between[np.ix_(own, own)], edge, 1.0)
    alike = np.zeros((len(own), len(between)), dtype=np.float32)
    alike[0] = -1.0
    alike[0, 5] = 2.0
    assert all(one.match[0] == 5 for one in beam_search(part, edge, between, alike, 1)[:1])


def test_placements_of_mostly_the_same_points_are_registered_once():
    def placed(*match):
        return Placement(1.0, TRIALS[0], Assignment(np.array(match), np.ones(6), 1.0), np.zeros((6, 9)))

    one, near, other = placed(0, 1, 2, 3, 4, 5), placed(0, 1, 2, 3, 7, 8), placed(0, 1, 2, 6, 7, 8)
    assert not _places_differ(one, near)
    assert _places_differ(one, other)
    assert not _places_differ(near, other)


def test_placings_that_hardly_differ_are_left_out():
    between = np.abs(np.linspace(0, 1, 11)[:, None] - np.linspace(0, 1, 11)[None])
    states = np.array([[0, 5, 9], [0, 5, 10], [3, 5, 9], [3, 8, 9]])
    assert _MIN_DISTANCE > 0.1
    assert _select_different(states, between, 9).tolist() == [0, 2, 3]
    assert _select_different(states, between, 2).tolist() == [0, 2]
    assert _select_different(states, between, 9, half=True).tolist() == [0, 3]
