"""The best placing of a part against the best that leaves it, and placements of small parts."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import KDTree

from conftest import SMALL
from kfmaps import datasets
from kfmaps.config import Partial
from kfmaps.datasets import largest_piece
from kfmaps.descriptors.shot import shot
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area, vertex_areas
from kfmaps.matching.partial import candidates, place_part, two_parts
from kfmaps.matching.partial import candidates as candidates_module
from kfmaps.matching.partial.candidates import (
    _ROUNDS,
    _differ,
    _refine_candidate,
    compare_alternatives,
    make_candidate,
    margin,
)
from kfmaps.matching.partial.match_partial import _place_by_landmarks, match_partial
from kfmaps.matching.partial.registration import find_overlap, register_part
from kfmaps.matching.partial.relaxation_labeling import Assignment
from kfmaps.matching.partial.samples import PartPair, PartSamples, part_samples
from kfmaps.matching.partial.scale_search import TRIALS, Placement, place_all, shot_similarity
from kfmaps.matching.score import SCORE, PartEvidence
from kfmaps.shape import prepare
from test_parts import renumbered, task_of

GUARDS = ("kfmaps.matching.partial", "kfmaps.matching.score")

EMPTY: Any = SimpleNamespace(self_images=(), part=SimpleNamespace(n_landmarks=0))
COST = SCORE.part.landmark_cost


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
    coarse = Placement(scale, TRIALS[0], Assignment(match, np.ones(len(match)), 1.0), alike)
    return make_candidate(coarse, on)


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


def test_a_placement_that_starts_on_the_wrong_half_moves_to_the_right_one(half, true):
    found = compare_alternatives([placed_at(half, true[1].points)], half[0])
    assert error(half, found[0]) < 0.05
    assert error(half, found[1]) > 0.15


def test_near_symmetries_of_the_whole_place_the_part_elsewhere(half, true, monkeypatch):
    """A made-up one takes the samples to the rival's places, where nothing else has placed them."""
    on, places, _ = half
    monkeypatch.setattr(candidates_module, "_alternative_placements", lambda *_: [])
    best = placed_at(half, places[on.part.samples])
    assert len(compare_alternatives([best], on)) == 1
    images = np.arange(len(on.whole.samples))
    images[best.placement.placed.match] = true[1].placement.placed.match
    found = compare_alternatives([best], replace(on, find_self_images=lambda: images[None]))
    assert error(half, found[0]) < 0.04
    assert all(error(half, one) > 0.15 for one in found[1:])
    assert len(found) == 2
    marked = PartPair(replace(on.part, n_landmarks=3), on.whole, find_self_images=lambda: images[None])
    moved = candidates_module._place_symmetrically(best, marked)[0].placed.match
    assert (moved[:3] == best.placement.placed.match[:3]).all()  # landmarks stay
    assert (moved[3:] == images[best.placement.placed.match[3:]]).all()


def stub(score, x, gain=0.0) -> Any:
    """A candidate at the place ``x``, which gains so much whenever it is placed anew."""
    places = np.full((5, 3), float(x))
    bend = SimpleNamespace(scale=1.0, edge_ratio=1.0, inside=np.ones(3, dtype=bool))
    return SimpleNamespace(score=score, points=places, registration=bend, gain=gain, times=0)


def again(one, *_rest):
    return SimpleNamespace(**{**vars(one), "score": one.score + one.gain, "times": one.times + 1})


def test_rivals_are_polished_before_they_are_compared(monkeypatch):
    """The best at first, a copy of it, a rival that was hit by chance, and a third that is left behind."""
    monkeypatch.setattr(candidates_module, "_alternative_placements", lambda *_: [])
    monkeypatch.setattr(candidates_module, "_place_again", again)
    monkeypatch.setattr(candidates_module, "_place_nearby", lambda one, _pair: one)
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
    monkeypatch.setattr(candidates_module, "_place_again", again)
    monkeypatch.setattr(candidates_module, "_place_nearby", lambda one, _pair: one)
    for gain, times in (
        (0.99 * SCORE.part.min_gain, _ROUNDS[0]),
        (1.01 * SCORE.part.min_gain, _ROUNDS[1]),
        (-1.0, _ROUNDS[0]),
    ):
        last: Any = _refine_candidate(stub(1.0, 0.0, gain), EMPTY)
        assert last.times == times


def test_samples_go_on_to_what_looks_like_them_near_by_while_that_gains(monkeypatch):
    monkeypatch.setattr(candidates_module, "_place_again", lambda one, _pair: one)
    for gain, times, score in (
        (0.99 * SCORE.part.min_gain, 0, 1.0),
        (1.01 * SCORE.part.min_gain, _ROUNDS[1], 1 + _ROUNDS[1] * 1.01 * SCORE.part.min_gain),
    ):
        monkeypatch.setattr(candidates_module, "_place_nearby", again)
        last: Any = _refine_candidate(stub(1.0, 0.0, gain), EMPTY)
        assert (last.times, last.score) == (times, pytest.approx(score))


def test_samples_are_placed_by_their_descriptors_near_where_they_lie(half, monkeypatch):
    """Places that look alike but lie farther away do not count, and the evidence is of where the samples lie then."""
    on, places, _ = half
    one = placed_at(half, places[on.part.samples])
    there = on.whole.mesh.vertices[on.whole.samples]
    away = np.linalg.norm(one.points[:, None] - there, axis=2)
    nearest, second = np.argsort(away, axis=1)[:, :2].T
    alike = np.full(away.shape, 0.1, dtype=np.float32)
    each = np.arange(len(away))
    is_near = away[each, second] < 0.05
    alike[is_near, second[is_near]] = 1.0  # each looks most like the second nearest
    alike[each, away.argmax(axis=1)] = 9.0
    asked, register_quickly = [], candidates_module._register_quickly

    def registered(placement, pair):
        asked.append(placement)
        return register_quickly(placement, pair)

    monkeypatch.setattr(candidates_module, "shot_similarity", lambda *_: alike)
    monkeypatch.setattr(candidates_module, "_register_quickly", registered)
    moved = candidates_module._place_nearby(one, on)
    assert is_near.sum() > 20
    np.testing.assert_array_equal(asked[0].placed.match[is_near], second[is_near])
    others = ~is_near & (away.min(axis=1) < 0.1)
    np.testing.assert_array_equal(asked[0].placed.match[others], nearest[others])
    lies = np.asarray(KDTree(there).query(moved.points)[1])
    np.testing.assert_array_equal(moved.placement.placed.match, lies)
    assert moved.evidence.similarity_rank == pytest.approx(moved.placement.evidence.similarity_rank)
    assert (
        moved.placement.scale == asked[0].scale == pytest.approx(one.registration.scale * one.registration.edge_ratio)
    )
    marked = PartPair(replace(on.part, n_landmarks=3), replace(on.whole, n_landmarks=3))
    candidates_module._place_nearby(one, marked)
    assert asked[1].placed.match[:3].tolist() == [0, 1, 2]


def test_a_limb_that_lies_elsewhere_is_placed_anew_from_the_rest(half, true):
    """A third of the samples, all on one side, begin at the places that the rival gives them."""
    on, places, scale = half
    far = np.argsort(on.part.distances[0])[-33:]
    ends = places[on.part.samples].copy()
    ends[far] = true[1].points[far]
    start = placed_at(half, ends)
    assert error(half, start) > 0.07
    found = candidates_module.regrow_best([start], on)
    assert error(half, found[0]) < 0.05 < error(half, found[1])
    assert found[1] is start
    kept = candidates_module._grow(start, 0, on)
    near = on.part.distances[0] * scale < 0.15
    off = np.linalg.norm(on.whole.mesh.vertices[on.whole.samples[kept.placed.match]] - places[on.part.samples], axis=1)
    assert off[near].mean() < 0.06


def test_what_regrowth_gains_too_little_or_loses_much_is_left(half, monkeypatch):
    best, limit = stub(20.0, 0.0), SCORE.part.hopeless_margin
    for score, refined, where, first in (
        (19.0, 20.0 + 1.01 * SCORE.part.min_gain, 0.0, True),
        (19.0, 20.0 + 0.99 * SCORE.part.min_gain, 0.0, False),  # the same place
        (19.0, 20.0 + 0.5 * SCORE.part.min_gain, 1.0, True),  # another place
        (19.99 - limit, 21.0, 0.0, False),
        (20.01 - limit, 21.0, 0.0, True),
    ):
        monkeypatch.setattr(candidates_module, "_grow", lambda *_: None)
        monkeypatch.setattr(candidates_module, "make_candidate", lambda *_, _score=score: stub(_score, 0.0))
        monkeypatch.setattr(candidates_module, "_refine_candidate", lambda *_, _to=(refined, where): stub(*_to))
        order: Any = candidates_module.regrow_best([best], half[0])
        assert (order[0] is best) != first
        assert len(order) == 1 + first


def test_of_the_scan_of_one_camera_the_second_candidate_grows_too(half, monkeypatch):
    order, grown = [stub(20.0, 0.0), stub(19.9, 0.0), stub(19.0, 1.0), stub(18.0, 2.0)], []
    monkeypatch.setattr(candidates_module, "_grow", lambda one, *_: grown.append(one))
    monkeypatch.setattr(candidates_module, "make_candidate", lambda *_: stub(19.5, 0.0))
    monkeypatch.setattr(candidates_module, "_refine_candidate", lambda *_: stub(21.0, 1.0))
    monkeypatch.setattr(candidates_module, "_place_symmetrically", lambda *_: [])
    for is_one_view, starts in ((False, order[:1]), (True, [order[0], order[2]])):
        grown.clear()
        found: Any = candidates_module.regrow_best(order, replace(half[0], is_one_view=is_one_view))
        assert [one for i, one in enumerate(grown) if i % 8 == 0] == starts
        assert [one.score for one in found[: len(starts) + 1]] == [21.0] * len(starts) + [20.0]


@pytest.mark.parametrize(("is_one_view", "grown", "expected"), [(True, 21.0, 2), (True, 19.0, 0), (False, 21.0, 0)])
def test_a_scan_of_one_camera_that_has_grown_is_turned_once_more(is_one_view, grown, expected, half, monkeypatch):
    turned = []
    monkeypatch.setattr(candidates_module, "_grow", lambda *_: None)
    monkeypatch.setattr(candidates_module, "make_candidate", lambda placement, _: stub(18.5, 2.0 if placement else 0.0))
    monkeypatch.setattr(candidates_module, "refine_placement", lambda _, placement: placement)
    monkeypatch.setattr(
        candidates_module, "_refine_candidate", lambda one, _: stub(grown if one.points[0, 0] == 0 else 20.5, 0.0)
    )
    monkeypatch.setattr(candidates_module, "_place_symmetrically", lambda one, _: turned.append(one) or ["a", "b"])
    found: Any = candidates_module.regrow_best([stub(20.0, 0.0)], replace(half[0], is_one_view=is_one_view))
    assert [one.score for one in found].count(20.5) == expected
    assert [one.score for one in turned] == [21.0] * (expected > 0)


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


def test_a_candidate_pays_for_landmarks_that_it_contradicts(half, monkeypatch):
    on, places, scale = half
    off, limit = np.zeros_like(places), SCORE.part.max_landmark_error
    marked = PartPair(replace(on.part, n_landmarks=3), replace(on.whole, n_landmarks=3))
    assert marked.part.landmarks.tolist() == marked.part.samples[:3].tolist()
    places = places.copy()
    places[marked.part.landmarks] = on.whole.mesh.vertices[marked.whole.landmarks]
    off[marked.part.landmarks, 0] = [0.0, 0.99 * limit, 1.01 * limit]
    ends = places[on.part.samples]
    plain = register_part(on, scale, ends, ends, np.ones(len(ends)), True)
    monkeypatch.setattr(candidates_module, "register_part", lambda *_, **__: replace(plain, vertices=places + off))
    placed = Placement(scale, TRIALS[0], Assignment(np.arange(100), np.ones(100), 1.0), np.ones((100, 300)))
    found, free = make_candidate(placed, marked), make_candidate(placed, on)
    assert found.score == pytest.approx(free.score - COST)
    two = make_candidate(placed, replace(marked, both_partial=True)).evidence
    assert two.landmark_cost == SCORE.part.landmark_cost_of_two


def test_scores_are_those_without_landmarks_that_the_best_candidate_contradicts(monkeypatch):
    found = [
        SimpleNamespace(score=s, evidence=PartEvidence(0.8, -4.0, landmark_cost=n * COST)) for s, n in ((5, 2), (4, 0))
    ]
    for one in found:
        one.registration = None
    results = {
        "_search_placements": found,
        "_register_fully": SimpleNamespace(vertices=np.eye(3)),
        "find_overlap": None,
        "margin": 1.0,
    }
    for name, result in results.items():
        monkeypatch.setattr(place_part, name, lambda *_, _result=result: _result)
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    task = place_part.PartTask(triangle, triangle, Partial())
    assert place_part.place_part(task).scores == (5 + 2 * COST, 4 + 2 * COST)


@pytest.mark.parametrize(
    ("wrong", "first", "others", "second", "then", "again", "scale"),
    [
        ([], 20.0, None, 99.0, [], False, 0.7),  # all is well: no second placement
        ([1], 20.0, [0, 2], 20.0, [1], True, 0.7),  # one is wrong: the others place the part
        ([1], 20.0, [0, 2], 19.9, [1], False, 0.7),
        ([1], 20.0, [0, 2], 20.1 - COST, [], True, 0.7),
        ([0, 2], 20.0, [], 20.1, [0, 2], True, 0.7),  # most are wrong: none does
        ([0, 2], 20.0, [], 19.9 + COST, [0, 1, 2], False, 0.7),
        ([], 5.0, [], 5.1 + 3 * COST, [0, 1, 2], True, 0.7),  # it fits nowhere with them
        ([], 5.0, [], 4.9 + 3 * COST, [0, 1, 2], False, 0.7),  # a little better, against all of them
        ([], 5.0, [], 5.1 + COST, [1], True, 0.7),
        ([], 5.0, [], 99.0, [0, 1, 2], False, 0.99 * SCORE.part.shrunk_scale),  # it fits nearly everywhere
        ([1], 20.0, [0, 2], 20.5, [1], True, 0.99 * SCORE.part.shrunk_scale),  # but not with landmarks
    ],
)
def test_landmarks_that_a_placement_contradicts_are_left_out_where_the_others_score_much_better(
    wrong: list[int], first: float, others: list[int] | None, second: float, then: list[int], again: bool, scale: float
) -> None:
    whole: Any = SimpleNamespace(vertices=np.eye(3))
    pairs = np.stack([np.arange(3), np.arange(3)], axis=1)
    asked = []

    def place_with(*, landmarks: np.ndarray, **_: Any) -> Any:
        asked.append(landmarks[:, 0].tolist())
        off = np.zeros((3, 1))
        off[wrong if len(asked) == 1 else then] = 1.01 * SCORE.part.max_landmark_error
        moved = whole.vertices + off * [1.0, 0.0, 0.0]
        score = first if len(asked) == 1 else second
        return SimpleNamespace(
            unguided=moved,
            scores=(score,),
            margin=9.0,
            registration=SimpleNamespace(scale=scale),
            calibration=SCORE.part.calibration,
        )

    found, errors = _place_by_landmarks(place_with, pairs, whole, two=False)
    assert asked == [[0, 1, 2]] + ([] if others is None else [others])
    assert found.scores[0] == (second if again else first)
    assert np.flatnonzero(errors > SCORE.part.max_landmark_error).tolist() == (then if again else wrong)


def test_right_landmarks_are_kept_where_a_wrong_placement_scores_a_little_better(monkeypatch):
    """Two cuts of a creature: without landmarks they lie wrongly, with a better score."""
    for name in ("_PROXY_FROM", "_PROXY_VERTICES"):
        monkeypatch.setattr(f"kfmaps.matching.partial.place_part.{name}", 400)
    rng, pair = np.random.default_rng(106), datasets.symmetric_creature(1500, rng=6)
    pieces = []
    for mesh in (pair.source, pair.target):
        height, areas = mesh.vertices @ rng.normal(size=3), vertex_areas(mesh)
        order = np.argsort(height)
        below = np.cumsum(areas[order]) < rng.uniform(0.6, 0.85) * areas.sum()
        pieces.append(largest_piece(mesh, np.isin(np.arange(len(height)), order[below])))
    true = renumbered(pieces[0][1], len(pair.source.vertices))[pair.truth[pieces[1][1]]]
    rows = farthest_geodesic(pieces[1][0], 40, 0)
    rows = rows[true[rows] >= 0][:4]
    config = replace(SMALL, partial=Partial("both", samples=100, whole_samples=300))
    source, target = (prepare(mesh, config, name=name) for (mesh, _), name in zip(pieces, "ab", strict=True))
    calls: list[bool] = []

    def place_by_landmarks(*given: Any) -> Any:
        calls.append(given[-1])
        return _place_by_landmarks(*given)

    monkeypatch.setattr("kfmaps.matching.partial.match_partial._place_by_landmarks", place_by_landmarks)
    found = match_partial(task_of(source, target, np.stack([true[rows], rows], axis=1), config), "both", "because")[0]
    assert calls == [True]  # what a contradicted landmark costs is that of two parts
    assert len(found.score.rejected_landmarks) == 0
    on, places = (true >= 0) & (found.target_to_source >= 0), source.mesh.vertices
    assert np.linalg.norm(places[found.target_to_source[on]] - places[true[on]], axis=1).mean() < 0.08


def test_two_parts_are_scored_by_the_distances_in_their_overlap_alone(half, true, monkeypatch):
    pair, found = replace(half[0], both_partial=True), true[0].registration
    samples, whole = pair.part.samples, pair.whole
    overlap = find_overlap(found, whole)
    common = np.zeros(len(found.vertices))
    common[samples[::2]] = 1.0
    monkeypatch.setattr(two_parts, "find_overlap", lambda *_: replace(overlap, part=common))
    places = whole.mesh.vertices[whole.samples]
    nearest = np.linalg.norm(found.vertices[samples][:, None] - places, axis=2).argmin(axis=1)
    fits, near = pair.pair_consistency(found.scale, nearest)
    wanted = fits[::2, ::2].sum() / near[::2, ::2].sum()
    creature_pair = make_candidate(true[0].placement, pair).evidence
    assert two_parts.overlap_evidence(found, pair)[0] == pytest.approx(wanted)
    assert creature_pair.pair_consistency != true[0].evidence.pair_consistency == SCORE.part.usual_pair_consistency
    # What one of two parts has alone is folded onto the other, where the placement is right.
    folded = candidates_module._measure_candidate(true[0].placement, replace(found, doubled_area=0.2), pair)
    assert folded.evidence.doubled_area == 0.0


def test_shot_of_the_overlap_of_two_parts_ranks_the_right_place_first(half, true):
    pair, found = replace(half[0], both_partial=True), true[0].registration
    turned = replace(found, vertices=found.vertices[np.random.default_rng(0).permutation(len(found.vertices))])
    ranks = [two_parts.overlap_evidence(one, pair)[1] for one in (found, turned)]
    assert ranks[0] < -3.5 < -1.5 < ranks[1] <= 0.0


def test_shot_of_some_faces_is_that_of_a_mesh_of_these_faces_alone(half):
    whole = half[0].whole
    faces = whole.mesh.vertices[whole.mesh.faces].mean(axis=1)[:, 0] > 0
    kept, new = np.unique(whole.mesh.faces[faces], return_inverse=True)
    piece, has = Mesh(whole.mesh.vertices[kept], new.reshape(-1, 3)), np.isin(whole.samples, kept)
    area = surface_area(piece)
    at = np.searchsorted(kept, whole.samples[has])
    own, found = whole.shot_of_faces(faces, 0.1)
    assert own.tolist() == np.flatnonzero(has).tolist()
    wanted = shot(piece, 0.1 / np.sqrt(area), at=at, samples=round(10_000 * area))
    np.testing.assert_array_equal(found, wanted.astype(np.float32))


SCALE, RADIUS = 0.4, max(TRIALS[0].radii)
AWAY = np.array([0.0, 0.25, 0.5, 1.0, 9.0], dtype=np.float32)
"""Distances of five samples from the boundary, in radii of SHOT."""
WEIGHTS = np.array([0.05, 0.25, 0.5, 1.0, 1.0])


@pytest.fixture
def pair(monkeypatch: pytest.MonkeyPatch) -> PartPair:
    """Five samples on a line of a small part and of the whole, all of whose descriptors are alike."""
    line = np.arange(5)[:, None] * [0.1, 0.0, 0.0]
    away = AWAY * np.float32(RADIUS / SCALE)
    sides = []
    for scale, boundary in ((SCALE, away), (1.0, np.full(5, np.inf, dtype=np.float32))):
        mesh = Mesh(line / scale, np.zeros((0, 3), dtype=np.int64))
        between = np.abs(line[:, :1] - line[:, 0]).astype(np.float32) / np.float32(scale)
        sides.append(PartSamples(mesh, np.arange(5), between, boundary))
    monkeypatch.setattr(PartSamples, "shot", lambda *_: np.ones((5, 1), dtype=np.float32))
    return PartPair(*sides, file_scale=SCALE)


def test_shot_counts_as_far_as_its_ball_fits(pair: PartPair) -> None:
    np.testing.assert_allclose(pair.shot_weights(SCALE, RADIUS), WEIGHTS, rtol=1e-6)
    np.testing.assert_allclose(pair.shot_weights(SCALE, 2 * RADIUS), [0.05, 0.125, 0.25, 0.5, 1.0], rtol=1e-6)
    np.testing.assert_allclose(pair.shot_weights(SCALE / 2, RADIUS), [0.05, 0.125, 0.25, 0.5, 1.0], rtol=1e-6)
    narrow = replace(pair, part=replace(pair.part, boundary_distance=pair.part.boundary_distance[:3]))
    np.testing.assert_allclose(narrow.shot_weights(SCALE, RADIUS), [0.05, 0.5, 1.0], rtol=1e-6)


def test_similarities_of_a_small_part_alone_are_weighted(pair: PartPair) -> None:
    for params in TRIALS[:2]:
        weights = pair.shot_weights(SCALE, max(params.radii))
        np.testing.assert_allclose(shot_similarity(pair, SCALE, params), np.tile(weights, (5, 1)).T)
        assert (shot_similarity(replace(pair, file_scale=None), SCALE, params) == 1.0).all()


def test_ranks_of_a_small_part_are_weighted_by_squares(pair: PartPair) -> None:
    similarity = np.tile(np.arange(5.0), (5, 1)).astype(np.float32)
    start = Placement(SCALE, TRIALS[0], Assignment(np.arange(5), np.ones(5), 1.0), similarity)
    ranks = np.log((5 - np.arange(5)) / 5)
    for one, wanted in (
        (place_all(replace(pair, file_scale=None), start), ranks.mean()),
        (place_all(pair, start), (WEIGHTS**2 * ranks).sum() / (WEIGHTS**2).sum()),
    ):
        output = replace(one, placed=replace(one.placed, match=np.arange(5))).evidence
        assert output.similarity_rank == pytest.approx(wanted)


def test_a_candidate_knows_its_scale_against_the_file(monkeypatch: pytest.MonkeyPatch, pair: PartPair) -> None:
    found = SimpleNamespace(
        vertices=np.eye(5),
        deformation_energy=0.01,
        gap=0.0,
        flipped_area=0.0,
        doubled_area=0.25,
        places=SimpleNamespace(points=np.eye(5)),
    )
    monkeypatch.setattr(candidates, "register_part", lambda *_, **__: found)
    surface = SimpleNamespace(normals=np.eye(5))
    whole: Any = SimpleNamespace(
        samples=np.arange(5), landmarks=np.arange(0), mesh=SimpleNamespace(vertices=np.eye(5)), surface=surface
    )
    pair = replace(pair, whole=whole)
    start = Placement(SCALE, TRIALS[0], Assignment(np.arange(5), np.ones(5), 1.0), np.eye(5))
    for scale in (SCALE, 0.8 * SCALE, 1.25 * SCALE):
        one = replace(start, scale=scale)
        changed = candidates.make_candidate(one, pair).evidence.scale_change
        assert changed == pytest.approx(abs(np.log(scale / SCALE)))
        evidence = candidates.make_candidate(one, replace(pair, file_scale=None)).evidence
        assert (evidence.scale_change, evidence.doubled_area) == (0.0, 0.25)


@pytest.mark.parametrize(
    ("of_file", "scale", "usual"), [(None, 0.3, 0.45), (None, 0.46, 0.46), (0.3, 0.35, 0.3), (0.3, 0.46, 0.46)]
)
def test_the_scan_of_one_camera_is_small_only_if_its_file_says_so(of_file, scale, usual, pair):
    registered: Any = SimpleNamespace(
        vertices=np.eye(5, 3),
        deformation_energy=0.01,
        gap=0.0,
        flipped_area=0.0,
        doubled_area=0.0,
        places=SimpleNamespace(points=np.eye(5)),
    )
    placement = Placement(scale, TRIALS[0], Assignment(np.arange(5), np.ones(5), 1.0), np.eye(5))
    view = replace(pair, is_one_view=True, file_scale=of_file)
    found = candidates._measure_candidate(placement, registered, view)
    assert found.evidence.scale_change == pytest.approx(abs(np.log(scale / usual)))


def test_all_placements_at_a_known_scale_are_registered_and_the_best_that_differ_kept(
    monkeypatch: pytest.MonkeyPatch, pair: PartPair
) -> None:
    """Each of two trials has three placements by beams and one by relaxation; two lie at one place."""
    scores = iter([5.0, 9.0, 7.0, 8.0, 6.0, 8.9, 4.0, 3.0])
    at = iter([0.0, 1.0, 2.0, 3.0, 4.0, 1.01, 5.0, 6.0])

    def registered(one: Placement, _pair: PartPair) -> Any:
        assert one.scale == SCALE
        return SimpleNamespace(score=next(scores), points=np.full((5, 3), next(at)), times=0)

    monkeypatch.setattr(
        candidates, "rough_placements", lambda _pair, scale, _params: [SimpleNamespace(scale=scale)] * 4
    )
    monkeypatch.setattr(candidates, "place_all", lambda _pair, one: one)
    monkeypatch.setattr(candidates, "make_candidate", registered)
    monkeypatch.setattr(candidates, "_place_again", lambda one, _pair: SimpleNamespace(**{**vars(one), "times": 1}))
    found: Any = candidates.candidates_at_scale(pair, SCALE)
    assert [(one.score, one.times) for one in found] == [(9.0, 1), (8.0, 1), (7.0, 1), (6.0, 1)]


@pytest.mark.parametrize(
    ("ratio", "both", "known"),
    [(0.4, False, True), (0.49, False, True), (0.26, False, True), (0.51, False, False), (0.24, False, False),
     (None, False, False), (0.4, True, False), (0.6, True, True), (1.9, True, True), (2.1, True, False)],
)  # fmt: skip
def test_all_placements_of_small_parts_and_of_two_parts_in_one_unit_are_registered(
    monkeypatch: pytest.MonkeyPatch, ratio: float | None, both: bool, known: bool
) -> None:
    """A part is small below a quarter of the area; two parts of like size are taken to be in one unit."""
    seen: list[Any] = []

    def candidates_at_scale(pair: PartPair, scale: float) -> Any:
        assert pair.small_scale == (None if both else scale)
        return [scale]

    def compared(found: Any, _pair: PartPair) -> Any:
        seen.append(found)
        raise StopIteration

    likely = SimpleNamespace(scale=1.0, placed=SimpleNamespace(support=1.0))
    monkeypatch.setattr(place_part, "try_scales", lambda *_: [likely])
    monkeypatch.setattr(place_part, "_clear_placements", lambda *_: [])
    monkeypatch.setattr(place_part, "_likely_placements", lambda *_: [likely])
    monkeypatch.setattr(place_part, "make_candidate", lambda one, _pair: one)
    monkeypatch.setattr(place_part, "candidates_at_scale", candidates_at_scale)
    monkeypatch.setattr(place_part, "compare_alternatives", compared)
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    with pytest.raises(StopIteration):
        place_part.place_part(place_part.PartTask(triangle, triangle, Partial(), ratio, both))
    assert seen == [[likely] + [ratio] * known]


@pytest.mark.parametrize(
    ("supports", "likely", "registered"),
    [
        ((0.30, 0.10), 0.6, False),  # the large placement is supported little
        ((0.30, 0.26), 0.6, False),
        ((0.30, 0.28), 0.6, True),
        ((0.30, 0.28), 0.4, False),  # it becomes small once it is refined
    ],
)
def test_a_search_for_a_large_part_is_given_up_where_all_likely_placements_are_small(
    monkeypatch: pytest.MonkeyPatch, supports: tuple[float, ...], likely: float, registered: bool
) -> None:
    def placed(scale: float, support: float) -> Any:
        return SimpleNamespace(scale=scale, placed=SimpleNamespace(support=support))

    def compared(found: Any, _pair: PartPair) -> Any:
        assert [one.scale for one in found] == [0.3, likely]
        raise StopIteration

    supported = [placed(scale, support) for scale, support in zip((0.3, 0.6), supports, strict=True)]
    refined = [supported[0], placed(likely, 0.3)]
    monkeypatch.setattr(place_part, "try_scales", lambda *_: supported)
    monkeypatch.setattr(place_part, "_clear_placements", lambda *_: [])
    monkeypatch.setattr(place_part, "_likely_placements", lambda *_: refined)
    monkeypatch.setattr(place_part, "make_candidate", lambda one, _pair: one)
    monkeypatch.setattr(place_part, "compare_alternatives", compared)
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    with pytest.raises(StopIteration if registered else place_part.GivenUp):
        place_part.place_part(place_part.PartTask(triangle, triangle, Partial(), least_scale=0.5))


@pytest.mark.parametrize(("best", "tried"), [(0.9, [0.9]), (0.4, [0.9, 0.4])])
def test_the_placement_at_the_scale_of_the_files_is_not_tried_again(
    monkeypatch: pytest.MonkeyPatch, best: float, tried: list[float]
) -> None:
    """Where it is the best supported one of all scales, too."""

    def placed(scale: float) -> Any:
        return SimpleNamespace(scale=scale, placed=SimpleNamespace(support=1.0 + (scale == best)))

    seen: list[float] = []
    monkeypatch.setattr(
        place_part, "try_scales", lambda _, scales: [placed(best if best in scales or len(scales) > 1 else scales[0])]
    )
    monkeypatch.setattr(place_part, "_clear_placements", lambda _, one: seen.append(one.scale) or [])
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    with pytest.raises(place_part.GivenUp):
        place_part.place_part(place_part.PartTask(triangle, triangle, Partial(), 0.9, clear_area=0.0))
    assert seen == tried


@pytest.mark.parametrize(
    ("score", "scale", "both", "agree", "ahead", "clear", "grows"),
    [
        (0.0, 0.5, False, 97, 9.0, True, False),
        (9.0, 0.9, False, 96, 9.0, False, False),
        (-0.1, 0.9, False, 100, 9.0, False, False),
        (9.0, 0.49, False, 100, 9.0, False, False),
        (9.0, 0.9, True, 100, 9.0, False, True),  # two parts are never "sure"
        (9.0, 0.9, False, 100, 0.5, True, True),  # an alternative is nearly as good
        (9.0, 0.9, False, 96, 0.5, False, True),
    ],
)
def test_the_search_ends_where_the_best_supported_placement_of_a_large_part_is_clear(
    monkeypatch: pytest.MonkeyPatch,
    score: float,
    scale: float,
    both: bool,
    agree: int,
    ahead: float,
    clear: bool,
    grows: bool,
) -> None:
    """Its alternatives are looked for all the same, and it grows anew unless it is "sure"."""
    each = np.arange(100)
    one, again = (
        SimpleNamespace(
            score=SCORE.part.early_exit_score + score,
            scale=scale,
            registration=SimpleNamespace(scale=scale),
            evidence=PartEvidence(0.8, -4.0),
            placed=SimpleNamespace(match=match, support=1.0),
        )
        for match in (each, np.where(each < agree, each, (each + 50) % 100))
    )
    likely = SimpleNamespace(scale=1.0, score=SCORE.part.early_exit_score, evidence=PartEvidence(0.8, -4.0))
    scales_tried: list[list[float]] = []
    grown: list[Any] = []

    def try_scales(_pair: Any, scales: list[float], params: Any = TRIALS[0]) -> list[Any]:
        if params is TRIALS[1]:
            assert scales == [one.scale]
            return [again]
        scales_tried.append(scales)
        return [one]

    monkeypatch.setattr(place_part, "try_scales", try_scales)
    monkeypatch.setattr(place_part, "refine_placement", lambda _pair, placement: placement)
    monkeypatch.setattr(place_part, "fit_scale", lambda _pair, placement: placement)
    monkeypatch.setattr(place_part, "make_candidate", lambda placement, _pair: placement)
    monkeypatch.setattr(place_part, "_likely_placements", lambda *_: [likely])
    monkeypatch.setattr(place_part, "compare_alternatives", lambda found, _pair: found)
    monkeypatch.setattr(place_part, "regrow_best", lambda found, _pair: grown.append(found) or found)
    monkeypatch.setattr(place_part, "margin", lambda *_: ahead)
    line = np.abs(each[:, None] - each) * 0.05
    pair: Any = SimpleNamespace(
        fixed_scale=False,
        both_partial=both,
        small_scale=None,
        file_scale=None,
        is_one_view=False,
        whole=SimpleNamespace(distances=line),
        part=SimpleNamespace(n_landmarks=0),
    )
    triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    task = place_part.PartTask(triangle, triangle, Partial(candidates=3), 0.9)
    found = place_part._search_placements(pair, task, lambda _done: None)
    assert found == ([one] if clear else [likely])
    assert scales_tried[0] == [0.9]  # the scale of the files comes first
    assert len(scales_tried) == (1 if clear else 2)
    assert grown == ([found] if grows else [])
    if not clear:
        one.scale = 0.836  # of less than 70 % of the area: a part rather than a whole with holes
        task = replace(task, clear_area=SCORE.part.min_whole_area)
        assert place_part._search_placements(pair, task, lambda _done: None) == [likely]
        one.scale = 0.837
        with pytest.raises(place_part.GivenUp):
            place_part._search_placements(pair, task, lambda _done: None)
        scales_tried.clear()
        with pytest.raises(place_part.GivenUp):
            place_part._search_placements(pair, replace(task, least_scale=0.8), lambda _done: None)
        assert min(scales_tried[-1]) == pytest.approx(0.28 * 1.15**8)  # none below the least
