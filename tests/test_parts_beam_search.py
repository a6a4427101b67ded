"""Samples of a part placed by a beam search: what is spread, what differs, and that the best placing is found."""

import numpy as np
import pytest

from kfmaps.matching.partial.beam_search import _ANCHORS, _MIN_DISTANCE, _select_anchors, _select_different, beam_search
from kfmaps.matching.partial.place_part import _places_differ
from kfmaps.matching.partial.relaxation_labeling import Assignment, distance_bounds
from kfmaps.matching.partial.scale_search import TRIALS, Placement

GUARDS = ("kfmaps.matching.partial.beam_search", "kfmaps.matching.partial.relaxation_labeling")


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
        told = alike.copy()
        told[np.arange(81), np.arange(81)[::way]] = 1.0
        first = beam_search(part, np.full(81, np.inf, dtype=np.float32), between, told)[0]
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
