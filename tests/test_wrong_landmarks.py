"""Landmarks that are wrong are named, whatever they agree with, and move nothing."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import kfmaps
from kfmaps.datasets import symmetric_creature
from kfmaps.fmap.convert import to_functional
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.sampling import stratified_vertices
from kfmaps.matching import landmark_conflicts
from kfmaps.matching import match as matching
from kfmaps.matching.score import SCORE, max_landmark_error, rejected_landmarks
from kfmaps.matching.search import search_map
from kfmaps.matching.search_result import SearchResult

GUARDS = ("kfmaps.matching.search", "kfmaps.matching.score")


@pytest.fixture(scope="module")
def creature() -> Any:
    """Two prepared poses of a symmetric body, its pair, and ten right landmarks."""
    pair = symmetric_creature(1500, rng=1)
    shapes = [kfmaps.prepare(mesh, name=name) for mesh, name in ((pair.source, "a"), (pair.target, "b"))]
    rows = stratified_vertices(shapes[1].basis, 10, 0)
    return *shapes, pair, np.stack([pair.truth[rows], rows], axis=1)


def searched(creature: Any, landmarks: np.ndarray) -> SearchResult:
    source, target = creature[:2]
    return search_map(source, target, replace(kfmaps.Config(), threads=1), landmarks=landmarks)


@pytest.mark.parametrize("count", [3, 10])
def test_all_landmarks_with_left_for_right_are_named(creature: Any, count: int) -> None:
    """A mirrored map keeps to all of them, of three even a better one; the map without landmarks is sure and stays."""
    pair, rows = creature[2], stratified_vertices(creature[1].basis, count, 0)
    right, swapped = (np.stack([places[rows], rows], axis=1) for places in (pair.truth, pair.mirrored))
    far = geodesic_distances(creature[0].mesh, right[:, 0])[np.arange(count), swapped[:, 0]] > 0.15
    found = searched(creature, swapped)
    assert (found.verdict, found.orientation) == ("sure", "preserving")
    assert far.sum() > 0.3 * count
    assert set(np.flatnonzero(far)) <= set(found.rejected_landmarks.tolist())


def test_a_single_wrong_landmark_is_named_and_moves_nothing(creature: Any) -> None:
    """Even where it is the only one, against a map that is sure without it."""
    right = creature[3]
    away = geodesic_distances(creature[0].mesh, right[:1, 0])[0]
    wrong = np.array([[np.abs(away - 0.2).argmin(), right[0, 1]]])
    found, alone = searched(creature, wrong), searched(creature, right[:0])
    assert found.rejected_landmarks.tolist() == [0]
    np.testing.assert_array_equal(found.functional_map, alone.functional_map)
    assert (found.verdict, found.confidence) == (alone.verdict, alone.confidence)


def test_of_many_landmarks_the_wrong_one_is_named_and_the_map_is_that_of_the_others(creature: Any) -> None:
    right = creature[3][:5]
    away = geodesic_distances(creature[0].mesh, right[2:3, 0])[0]
    spoiled = right.copy()
    spoiled[2, 0] = np.abs(away - 0.2).argmin()
    found, others = searched(creature, spoiled), searched(creature, np.delete(right, 2, axis=0))
    assert found.rejected_landmarks.tolist() == [2]
    np.testing.assert_allclose(found.functional_map, others.functional_map, atol=1e-9)


def test_landmarks_may_be_farther_off_between_shapes_that_differ_much() -> None:
    limits = [max_landmark_error(SCORE.non_isometric_score + more) for more in (0.0, -0.1)]
    assert limits == [SCORE.max_isometric_landmark_error, SCORE.max_landmark_error]
    errors = np.array([0.0, 0.2, 0.01])
    assert [rejected_landmarks(errors, limit).tolist() for limit in limits] == [[False, True, False], [False] * 3]


def test_a_landmark_that_the_finished_map_keeps_to_is_not_named(creature: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """The search has rejected a right and a wrong one."""
    source, target, pair, right = creature
    given = right[:2].copy()
    given[1, 0] = np.abs(geodesic_distances(source.mesh, right[1:2, 0])[0] - 0.3).argmin()
    C = np.asarray(to_functional(pair.truth, source.basis.truncate(60), target.basis.truncate(60)))
    found = SearchResult(C, "a", None, "sure", quality=-1.0, rejected_landmarks=np.arange(2))
    monkeypatch.setattr(matching, "search_map", lambda *_a, **_m: found)
    assert kfmaps.match(source, target, landmarks=given).score.rejected_landmarks.tolist() == [1]


@pytest.mark.parametrize(("ahead", "outcome"), [(1.1, "left out"), (0.9, "doubt"), (-0.9, "doubt"), (-1.1, "none")])
def test_a_sure_map_that_contradicts_landmarks_leaves_them_out_or_casts_a_doubt(
    monkeypatch: pytest.MonkeyPatch, ahead: float, outcome: str
) -> None:
    """It leads those that keep to them by more than 1, or neither leads; one that is far behind says nothing."""
    best, first, second = (
        SimpleNamespace(score=score, quality=SimpleNamespace(score=-1.0), deformation_energy=None, missed=missed)
        for score, missed in ((0.0, [0.0, 0.02]), (ahead, [0.5, 0.4]), (-20.0, [0.5, 0.4]))
    )
    for one in (best, first, second):
        one.unregistered, one.landmark_errors = one, np.array(one.missed)
    monkeypatch.setattr(landmark_conflicts, "ignore_landmarks", lambda one, *_: one)
    monkeypatch.setattr(landmark_conflicts, "without_landmark_errors", lambda one: one)
    monkeypatch.setattr(landmark_conflicts, "map_distance", lambda *_: 1.0)
    monkeypatch.setattr(landmark_conflicts, "rank_by_surface", lambda _: [first, second])
    fine = SimpleNamespace(source=None)
    state: Any = SimpleNamespace(
        ranked=[best], candidates=[best, first], samples=SimpleNamespace(fine=fine), config=kfmaps.Config()
    )
    wrong, doubts = landmark_conflicts.contradicted_landmarks(state)
    assert wrong.tolist() == 2 * [outcome == "left out"]
    assert [(one, margin) for one, margin in doubts if margin < SCORE.close_margin] == (
        [(first, -ahead)] if outcome == "doubt" else []
    )
