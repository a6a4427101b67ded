"""Placings of a part that leave the one it has: on a sheet that half a turn lays on itself there is exactly one."""

from dataclasses import replace

import numpy as np
import pytest

from kfmaps.geometry.mesh import Mesh
from kfmaps.matching.partial import scale_search
from kfmaps.matching.partial.beam_search import beam_search
from kfmaps.matching.partial.candidates import _SCALE_RATIOS, _alternative_placements
from kfmaps.matching.partial.relaxation_labeling import Assignment, consistency, distance_bounds
from kfmaps.matching.partial.samples import PartPair, PartSamples
from kfmaps.matching.partial.scale_search import (
    MAX_SCALE,
    MIN_MARKED_SCALE,
    MIN_SCALE,
    TRIALS,
    Placement,
    _consistent_trust,
    _shot_scale,
    refine_placement,
)
from kfmaps.matching.score import SCORE

GUARDS = ("kfmaps.matching.partial",)

HALF = 60
OTHER = np.roll(np.arange(2 * HALF), HALF)
"""Where half a turn takes each point."""
SCALE = 0.5


def sheet(marks=0, told=0.05):
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
            * np.float32(told if scale == 1.0 else 1.0)
            for radius in TRIALS[0].radii
            for beside in _SCALE_RATIOS
        }
        sides.append(PartSamples(mesh, each, between / np.float32(scale), endless, marks, known))
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
    points, part, whole = sheet(marks=2)
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
    trust = _consistent_trust(pair, SCALE, Assignment(match, np.full(2 * HALF, 0.5), 1.0))
    assert trust[~moved].min() > 0.6
    assert np.median(trust[moved]) == 0.0


def test_landmarks_are_trusted_wherever_they_are():
    _, part, whole = sheet(marks=2)
    match = np.arange(2 * HALF)
    match[:2] = OTHER[:2]
    placed = Assignment(match, np.full(2 * HALF, 0.5), 1.0)
    assert _consistent_trust(PartPair(part, whole, both_partial=True), SCALE, placed)[:2].tolist() == [1.0, 1.0]
    unmarked = PartPair(replace(part, n_landmarks=0), whole, both_partial=True)
    assert _consistent_trust(unmarked, SCALE, placed)[:2].max() < 0.5


@pytest.mark.parametrize(
    ("longer", "marks", "end"),
    [(0.01, 0, MIN_SCALE), (0.01, 2, MIN_MARKED_SCALE), (100.0, 0, MAX_SCALE), (1.0, 0, SCALE)],
)
def test_a_part_neither_vanishes_nor_outgrows_the_whole(monkeypatch, longer: float, marks: int, end: float) -> None:
    _, part, whole = sheet(marks)
    alike, placed = np.eye(2 * HALF), Assignment(np.arange(2 * HALF), np.ones(2 * HALF), 1.0)
    monkeypatch.setattr(scale_search, "scale_change", lambda *_: longer)
    monkeypatch.setattr(scale_search, "shot_similarity", lambda *_: alike)
    begun = Placement(SCALE, TRIALS[0], placed, alike)
    assert refine_placement(PartPair(part, whole), begun).scale == end
    assert refine_placement(PartPair(part, whole, fixed_scale=True), begun).scale == SCALE
