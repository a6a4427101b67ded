"""What landmarks do between shapes of different proportions, how far they back a map, and which are named as wrong."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.spatial import KDTree

import kfmaps
from conftest import SMALL, blob, functional_map
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.geometry.mesh import MIRROR, unit_area
from kfmaps.geometry.sampling import stratified_vertices
from kfmaps.matching import landmark_conflicts, match, registration_refine, search_result
from kfmaps.matching import search as search_module
from kfmaps.matching.candidates import rerefine, score_maps
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.landmark_conflicts import final_landmark_errors, ignore_landmarks, support_of_landmarks
from kfmaps.matching.landmark_evidence import (
    LANDMARK_WEIGHT,
    LANDMARK_WEIGHT_UNLIKE,
    build_guidance,
)
from kfmaps.matching.quality import sample_for_scoring
from kfmaps.matching.sample_pair import two_level_samples
from kfmaps.matching.score import SCORE, landmark_support, max_landmark_error, probability, rejected_landmarks, verdict
from kfmaps.matching.search import search_map
from kfmaps.matching.search_result import SearchResult
from kfmaps.registration import nonrigid_icp
from kfmaps.registration.alternating_registration import (
    AlternatingResult,
    alternating_registration,
    proxy_pair,
)
from kfmaps.registration.deformable import LANDMARK_PULL, deformable_mesh, landmark_pull
from kfmaps.registration.evidence import shape_proxy
from kfmaps.registration.nonrigid_icp import _SCALED_LANDMARK_PULL, NonRigid
from kfmaps.shape import mirror_image

GUARDS = ("kfmaps.matching", "kfmaps.matching.score", "kfmaps.matching.search", "kfmaps.registration")


def spread_out(creatures: Any, count: int) -> np.ndarray:
    """True landmarks all over the target."""
    rows = stratified_vertices(creatures[1].basis, count, 0)
    return np.stack([creatures[2][rows], rows], axis=1)


def coarse_proxies(creatures: Any, *counts: int) -> Any:
    """Coarse proxies of both, of so many vertices."""
    return [shape_proxy(shape, count) for shape, count in zip(creatures[:2], counts, strict=True)]


def only_the_truth(creatures: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A search finds the true map alone, and repairs nothing."""
    C = functional_map(creatures[2], *creatures[:2])
    monkeypatch.setattr(search_module, "candidates", lambda *a, **_m: score_maps([Start("a", C)], a[3].fine))
    monkeypatch.setattr(search_module, "SCORE", replace(SCORE, repair_score=-np.inf))


@pytest.fixture(scope="module")
def slid(creatures: Any) -> np.ndarray:
    """A map of few functions whose points are 0.11 off on average."""
    source, _, truth = creatures
    places = source.mesh.vertices[truth]
    moved = places + 0.15 * np.sin(4 * places[:, [1, 2, 0]])
    points = np.linalg.norm(moved[:, None] - source.mesh.vertices, axis=2).argmin(axis=1)
    return functional_map(points, *creatures[:2], k=20)


def given(creatures: Any, count: int) -> Any:
    """Samples on which maps between the creatures are scored with so many landmarks."""
    source, target, _ = creatures
    at = spread_out(creatures, count)
    samples = sample_for_scoring(source, 300), sample_for_scoring(target, 300)
    return two_level_samples(source, target, samples, at).fine


def test_a_map_is_supported_by_landmarks_that_did_not_guide_it(creatures, slid) -> None:
    on = given(creatures, 10)
    maps = functional_map(creatures[2], *creatures[:2]), slid
    right, wrong = (score_maps([Start("a", C)], on)[0] for C in maps)
    areas = np.asarray(on.source.samples.basis.mass)
    assert on.landmark_evidence is not None
    assert (
        support_of_landmarks(right, on)
        == landmark_support(ignore_landmarks(right, on).landmark_errors, on.landmark_evidence.distances, areas)
        > 0.3
    )
    # With landmarks in it the refinement would keep to them.
    guided = rerefine([wrong], on)[0]
    assert landmark_support(guided.landmark_errors, on.landmark_evidence.distances, areas) > 0.3
    assert support_of_landmarks(wrong, on) < 1e-3
    assert support_of_landmarks(right, replace(on, landmark_cost=None, landmark_evidence=None)) == 0.0


def test_a_search_says_that_landmarks_back_its_map(creatures, monkeypatch) -> None:
    source, target, _ = creatures
    only_the_truth(creatures, monkeypatch)
    harder = replace(SCORE.calibration, middle=0.0, steep_middle=0.0)
    monkeypatch.setattr(search_result, "probability", partial(probability, numbers=harder))
    monkeypatch.setattr(search_result, "verdict", partial(verdict, numbers=harder))
    config = replace(kfmaps.Config(), threads=1)
    without, backed = (
        search_module.search_map(source, target, config, landmarks=at) for at in (None, spread_out(creatures, 40))
    )
    assert (without.verdict, backed.verdict) == ("unlikely", "sure")
    assert (without.confidence or 1) < 0.1 < SCORE.calibration.sure < (backed.confidence or 0)


def test_a_landmark_that_the_map_keeps_to_is_rejected_no_longer(creatures, monkeypatch) -> None:
    """A rough map has missed two; the map that comes of it keeps the first, and has the second elsewhere indeed."""
    source, target, _ = creatures
    only_the_truth(creatures, monkeypatch)
    monkeypatch.setattr(search_module, "contradicted_landmarks", lambda _state: (np.arange(10) < 2, ()))
    at = spread_out(creatures, 10)
    at[1, 0] = np.linalg.norm(source.mesh.vertices - source.mesh.vertices[at[1, 0]], axis=1).argmax()
    found = search_module.search_map(source, target, replace(kfmaps.Config(), threads=1), landmarks=at)
    assert found.rejected_landmarks.tolist() == [1]
    np.testing.assert_array_equal(found.landmarks, np.delete(at, 1, axis=0))


def test_a_landmark_that_the_final_map_contradicts_is_left_out(creatures, monkeypatch) -> None:
    """Also where too few are right for a rough map to reject it: it would tear the map on all vertices."""
    source, target, _ = creatures
    only_the_truth(creatures, monkeypatch)
    monkeypatch.setattr(search_module, "contradicted_landmarks", lambda _state: (np.zeros(2, dtype=bool), ()))
    at = spread_out(creatures, 2)
    at[1, 0] = np.linalg.norm(source.mesh.vertices - source.mesh.vertices[at[1, 0]], axis=1).argmax()
    found = search_module.search_map(source, target, replace(kfmaps.Config(), threads=1), landmarks=at)
    assert found._search is not None
    assert not found._search.rejected.any()
    assert found.rejected_landmarks.tolist() == [1]
    np.testing.assert_array_equal(found.landmarks, at[:1])


def test_final_landmark_errors_are_those_of_functions_or_of_the_registration(creatures) -> None:
    """Whichever are less; the registration may be of either shape onto the other."""
    source, target, truth = creatures
    at, fine = spread_out(creatures, 10), given(creatures, 10)
    state: Any = SimpleNamespace(
        source=source,
        landmarks=at,
        evidence=fine.landmark_evidence,
        samples=SimpleNamespace(fine=fine),
        proxies=SimpleNamespace(image=target),
    )
    onto_source = source.mesh.vertices[truth]
    onto_target = target.mesh.vertices[KDTree(onto_source).query(source.mesh.vertices)[1]]
    right = functional_map(truth, source, target)
    wrong = np.linalg.qr(np.random.default_rng(0).normal(size=right.shape))[0]
    far = np.roll(onto_source, 700, axis=0)

    def errors(C: np.ndarray, registered: np.ndarray | None, swapped: bool) -> np.ndarray:
        best: Any = SimpleNamespace(functional_map=C, registered_vertices=registered, swapped=swapped)
        return final_landmark_errors(best, state)

    assert errors(wrong, None, False).mean() > 0.3
    for C, registered, swapped in ((right, None, False), (right, far, True), (wrong, onto_source, True)):
        assert errors(C, registered, swapped).max() < 0.12
    assert errors(wrong, onto_target, False).max() < 0.12
    assert errors(wrong, far, True).mean() > 0.3
    state.evidence = None
    assert len(errors(right, None, False)) == 0


def test_proxies_have_the_vertices_nearest_to_landmarks(creatures) -> None:
    source, target, _ = creatures
    at = spread_out(creatures, 30)
    a, b = coarse_proxies(creatures, 500, 400)
    on = proxy_pair(source, target, (a, b))
    landmark_vertices = on.nearest(at)
    for side, (shape, copy) in enumerate(((source, a), (target, b))):
        off = np.linalg.norm(copy.mesh.vertices - shape.mesh.vertices[at[:, side]][:, None], axis=2)
        chosen = off[np.arange(30), landmark_vertices[:, side]]
        np.testing.assert_array_equal(chosen, off.min(axis=1))
        assert 0 < chosen.max() < 0.1
    image = proxy_pair(source, mirror_image(target), (a, b.mirrored()))
    np.testing.assert_array_equal(image.nearest(at), landmark_vertices)
    there = image.proxies[1].mesh.vertices[landmark_vertices[:, 1]]
    assert np.linalg.norm(there - target.mesh.vertices[at[:, 1]] * MIRROR, axis=1).max() < 0.1
    np.testing.assert_array_equal(on.swapped().nearest(at[:, ::-1]), landmark_vertices[:, ::-1])
    assert on.nearest(at[:0]).shape == (0, 2)


def test_the_fits_between_refinements_keep_to_landmarks(creatures, slid) -> None:
    source, target, truth = creatures
    a, b = coarse_proxies(creatures, 500, 500)
    on = proxy_pair(source, target, (a, b))
    rows = stratified_vertices(target.basis, 1200, 0)
    rows = rows[np.isin(rows, b.vertices) & np.isin(truth[rows], a.vertices)][:12]
    at = np.stack([truth[rows], rows], axis=1)
    off = []
    for landmarks in (at[:0], at):
        *_, made = alternating_registration(slid, on, None, landmarks)
        registered = made.registered_vertices
        off.append(np.linalg.norm(registered[truth] - target.mesh.vertices, axis=1))
    assert off[1][rows].mean() < 0.6 * off[0][rows].mean()
    assert off[1].mean() < off[0].mean()


def followed(off: float, fit: NonRigid) -> float:
    """How far a body follows a single landmark that asks one of its vertices to move by ``off``, from 0 to 1."""
    body = unit_area(blob(250))
    from_there = np.linalg.norm(body.vertices - body.vertices[3], axis=1)
    to = np.abs(from_there - off).argmin()
    registered = fit(body, body, np.arange(250), landmarks=np.array([[3, to]])).vertices
    return 1 - float(np.linalg.norm(registered[3] - body.vertices[to]) / from_there[to])


def test_locally_scaled_limbs_follow_landmarks_that_are_far_off(monkeypatch) -> None:
    """Over an area as large as all of it nothing else is stretched: what differs is how landmarks hold."""
    plain = NonRigid(stiffness=5e-3, n_levels=1, steps=4)
    loose = replace(plain, local_scaling=100.0)
    near, far = 0.08, 0.15
    ways = {(fit.local_scaling, off): followed(off, fit) for fit in (plain, loose) for off in (near, far)}
    assert 1 - ways[100.0, near] < 0.7 * (1 - ways[0.0, near])
    assert ways[100.0, far] > 0.9
    assert ways[0.0, far] < 0.5
    monkeypatch.setattr(nonrigid_icp, "_SCALED_LANDMARK_PULL", (LANDMARK_PULL[0], _SCALED_LANDMARK_PULL[1]))
    assert 1 - followed(near, loose) > 1.3 * (1 - ways[100.0, near])
    monkeypatch.setattr(nonrigid_icp, "_SCALED_LANDMARK_PULL", LANDMARK_PULL)
    assert followed(far, loose) < 0.5


def test_a_landmark_pulls_by_its_weight_and_less_from_afar() -> None:
    """Discs have area 1 each; at the distance from which a pull fades a quarter of it is left."""
    body = unit_area(blob(250))
    at, rest = np.array([3, 200]), deformable_mesh(body)
    np.testing.assert_allclose(landmark_pull(rest, at, body.vertices[at]).discs.sum(axis=0), 1.0)
    for weight, fading in (LANDMARK_PULL, _SCALED_LANDMARK_PULL):
        pull = landmark_pull(rest, at, body.vertices[at], (weight, fading))
        for off, left in ((0.0, 1.0), (fading, 0.25), (3 * fading, 0.01)):
            x = body.vertices + np.array([0.0, 0.0, off])
            (term,) = pull.terms(x, 0.7)
            np.testing.assert_allclose(term.weights.sum(), 2 * 0.7 * weight * left)
            np.testing.assert_allclose(term.places - x, np.broadcast_to((0, 0, -off), x.shape), atol=1e-9)
    assert landmark_pull(rest, at[:0], body.vertices[:0]).terms(body.vertices, 1.0) == []


@pytest.mark.parametrize("lead", [LANDMARK_WEIGHT, LANDMARK_WEIGHT_UNLIKE])
def test_landmarks_guide_by_their_weight(creatures, lead) -> None:
    source, target, _ = creatures
    at = spread_out(creatures, 3)
    guidances: Any = [build_guidance(source, target, some, None, None, lead) for some in (at[:0], at)]
    plain, guided, whole = *guidances, build_guidance(source, target, at)
    k = plain.source.shape[1]
    for side in ("source", "target"):
        own, most = getattr(guided, side), getattr(whole, side)
        np.testing.assert_allclose(own[:, :k], getattr(plain, side))
        np.testing.assert_allclose(own[:, k:], np.sqrt(lead / LANDMARK_WEIGHT) * most[:, k:])
        if lead == LANDMARK_WEIGHT:
            both = np.vstack([guided.source[:, k:], guided.target[:, k:]])
            assert 2 * ((both - both.mean(axis=0)) ** 2).sum(axis=1).mean() == pytest.approx(LANDMARK_WEIGHT)


def test_landmarks_guide_less_where_shapes_differ_much(creatures, monkeypatch) -> None:
    source, target, _ = creatures
    asked = []
    monkeypatch.setattr(match, "build_guidance", lambda *_a, lead, **_m: asked.append(lead))
    found = SearchResult(np.eye(3), "a", None, "unlikely")
    for quality in (None, SCORE.non_isometric_score, SCORE.non_isometric_score - 1):
        assert replace(found, quality=quality).is_near_isometric == (quality != SCORE.non_isometric_score - 1)
        assert match._search_guidance(replace(found, quality=quality), (source, target)) is None
    assert asked == [LANDMARK_WEIGHT, LANDMARK_WEIGHT, LANDMARK_WEIGHT_UNLIKE]


def test_a_repaired_map_keeps_to_landmarks(creatures, creature_pair, monkeypatch) -> None:
    monkeypatch.setattr(registration_refine, "registered_shot_error", lambda *_what: 0.2)
    monkeypatch.setattr(registration_refine, "match_extremities", lambda *_: [])
    ranked = [replace(creature_pair.right, deformation_energy=1.0)]
    at = spread_out(creatures, 4)
    start, leads, usual = [], [], registration_refine.build_guidance

    def lead(*what: Any) -> Any:
        leads.append((what[2], what[5]))
        return usual(*what)

    def made(C: np.ndarray, where: Any, _led: Any, landmarks: np.ndarray) -> Iterator[AlternatingResult]:
        start.append(landmarks.T)
        yield AlternatingResult(C, where.source.mesh.vertices)

    monkeypatch.setattr(registration_refine, "build_guidance", lead)
    monkeypatch.setattr(registration_refine, "alternating_registration", made)
    way: Any = registration_refine.refine_by_registration(ranked, creature_pair.fine, creature_pair.proxies, at)[1][0]
    way.make()
    (t, s), (s_again, t_again) = start
    for there, here in ((s, t), (s_again, t_again)):
        np.testing.assert_array_equal(np.stack([there, here], axis=1), at)
    assert [weight for _, weight in leads] == [LANDMARK_WEIGHT_UNLIKE, LANDMARK_WEIGHT_UNLIKE]
    assert all(np.array_equal(output, at) for output, _ in leads)


def test_ten_landmarks_make_a_match_no_worse(creatures, slid, monkeypatch) -> None:
    source, target, truth = creatures
    at = spread_out(creatures, 10)
    errors = []
    for some in (at[:0], at):
        found = SearchResult(slid, "a", None, "unlikely", landmarks=some, quality=SCORE.non_isometric_score - 1)
        monkeypatch.setattr(match, "search_map", lambda *_a, found=found, **_m: found)
        points = kfmaps.match(source, target, landmarks=at).target_to_source
        errors.append(kfmaps.geodesic_errors(source.mesh, points, truth))
    assert errors[1].mean() <= errors[0].mean() < 0.03
    assert errors[1][at[:, 1]].mean() < 0.005


@pytest.fixture(scope="module")
def right(symmetric: Any) -> np.ndarray:
    """Ten right landmarks."""
    rows = stratified_vertices(symmetric.target.basis, 10, 0)
    return np.stack([symmetric.truth[rows], rows], axis=1)


def searched(symmetric: Any, landmarks: np.ndarray) -> SearchResult:
    return search_map(symmetric.source, symmetric.target, SMALL, landmarks=landmarks)


def away(symmetric: Any, vertex: int, distance: float) -> int:
    """A vertex of the source so far from another."""
    return int(np.abs(geodesic_distances(symmetric.source.mesh, [vertex])[0] - distance).argmin())


@pytest.mark.parametrize("count", [3, 10])
def test_all_landmarks_with_left_for_right_are_named(symmetric: Any, count: int) -> None:
    """A mirrored map keeps to all of them, of three even a better one; the map without landmarks is sure and stays."""
    rows = stratified_vertices(symmetric.target.basis, count, 0)
    right, swapped = (np.stack([places[rows], rows], axis=1) for places in (symmetric.truth, symmetric.mirrored))
    far = geodesic_distances(symmetric.source.mesh, right[:, 0])[np.arange(count), swapped[:, 0]] > 0.15
    found = searched(symmetric, swapped)
    assert (found.verdict, found.orientation) == ("sure", "preserving")
    assert far.sum() > 0.3 * count
    assert set(np.flatnonzero(far)) <= set(found.rejected_landmarks.tolist())


def test_a_single_wrong_landmark_is_named_and_moves_nothing(
    symmetric: Any, unmarked: SearchResult, right: np.ndarray
) -> None:
    wrong = np.array([[away(symmetric, right[0, 0], 0.2), right[0, 1]]])
    found = searched(symmetric, wrong)
    assert found.rejected_landmarks.tolist() == [0]
    np.testing.assert_array_equal(found.functional_map, unmarked.functional_map)
    assert (found.verdict, found.confidence) == (unmarked.verdict, unmarked.confidence)


def test_of_many_landmarks_the_wrong_one_is_named_and_the_map_is_that_of_the_others(
    symmetric: Any, right: np.ndarray
) -> None:
    spoiled = right[:5].copy()
    spoiled[2, 0] = away(symmetric, right[2, 0], 0.2)
    found, others = searched(symmetric, spoiled), searched(symmetric, np.delete(spoiled, 2, axis=0))
    assert found.rejected_landmarks.tolist() == [2]
    np.testing.assert_array_equal(found.landmarks, np.delete(spoiled, 2, axis=0))
    np.testing.assert_allclose(found.functional_map, others.functional_map, atol=1e-9)


def test_landmarks_may_be_farther_off_between_shapes_that_differ_much() -> None:
    limits = [max_landmark_error(SCORE.non_isometric_score + more) for more in (0.0, -0.1)]
    assert limits == [SCORE.max_isometric_landmark_error, SCORE.max_landmark_error]
    errors = np.array([0.0, 0.2, 0.01])
    assert [rejected_landmarks(errors, limit).tolist() for limit in limits] == [[False, True, False], [False] * 3]


def test_a_landmark_that_the_finished_map_keeps_to_is_not_named(
    symmetric: Any, right: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The search has rejected a right and a wrong one."""
    given = right[:2].copy()
    given[1, 0] = away(symmetric, right[1, 0], 0.3)
    found = SearchResult(symmetric.C, "a", None, "sure", quality=-1.0, rejected_landmarks=np.arange(2))
    monkeypatch.setattr(match, "search_map", lambda *_a, **_m: found)
    last = match.match(symmetric.source, symmetric.target, SMALL, landmarks=given)
    assert last.score.rejected_landmarks.tolist() == [1]


def conflicting(
    monkeypatch: pytest.MonkeyPatch, ahead: float, quality: float, missed: list[float]
) -> tuple[Any, Any, Any]:
    """A state, its best map, which keeps to its landmarks, and a free one with errors ``missed``."""
    best, first, second = (
        SimpleNamespace(
            score=score, quality=SimpleNamespace(calibrated_score=quality), deformation_energy=None, missed=missed
        )
        for score, missed in ((0.0, [0.0, *[0.02] * (len(missed) - 1)]), (ahead, missed), (-20.0, missed))
    )
    for one in (best, first, second):
        one.unregistered, one.landmark_errors = one, np.array(one.missed)
    monkeypatch.setattr(landmark_conflicts, "ignore_landmarks", lambda one, *_: one)
    monkeypatch.setattr(landmark_conflicts, "without_landmark_errors", lambda one: one)
    apart = SCORE.distinct_distance * 1.01
    monkeypatch.setattr(landmark_conflicts, "map_distance", lambda one, *_: apart if one is best else 1.0)
    monkeypatch.setattr(landmark_conflicts, "rank_by_surface", lambda _: [first, second])
    fine = SimpleNamespace(source=None, margin_factor=1.0)
    state: Any = SimpleNamespace(
        ranked=[best], candidates=[best, first], samples=SimpleNamespace(fine=fine), config=kfmaps.Config()
    )
    return state, best, first


@pytest.mark.parametrize(
    ("ahead", "quality", "outcome"),
    [
        (1.1, -1.0, "left out"),
        (1.1, -10.0, "left out"),
        (1.1, -13.0, "none"),
        (0.9, -1.0, "doubt"),
        (-0.9, -1.0, "doubt"),
        (-1.1, -1.0, "none"),
    ],
)
def test_a_likely_map_that_contradicts_landmarks_rejects_them_or_casts_a_doubt(
    monkeypatch: pytest.MonkeyPatch, ahead: float, quality: float, outcome: str
) -> None:
    """It leads those that keep to them by more than 1, or neither leads; one that is far behind says nothing.

    Where it rejects all, another map that keeps to them casts a doubt: they may be right.
    """
    state, best, first = conflicting(monkeypatch, ahead, quality, [0.5, 0.4])
    wrong, doubts = landmark_conflicts.contradicted_landmarks(state)
    assert wrong.tolist() == 2 * [outcome == "left out"]
    counted = [(one, margin) for one, margin in doubts if one is best or margin < SCORE.close_margin]
    assert counted == {"doubt": [(first, -ahead)], "left out": [(best, ahead)], "none": []}[outcome]
    monkeypatch.setattr(landmark_conflicts, "map_distance", lambda *_: SCORE.distinct_distance * 0.99)
    assert all(one is first for one, _ in landmark_conflicts.contradicted_landmarks(state)[1])


def test_where_a_rotation_may_keep_both_shapes_no_map_rejects_landmarks(monkeypatch: pytest.MonkeyPatch) -> None:
    state, _, _ = conflicting(monkeypatch, 1.1, -1.0, [0.5, 0.4])
    state.samples.fine.margin_factor = SCORE.rotation_margin
    wrong, doubts = landmark_conflicts.contradicted_landmarks(state)
    assert (wrong.tolist(), doubts) == ([False, False], ())


def test_landmarks_that_a_likely_map_rejects_in_part_count_in_its_margin(monkeypatch: pytest.MonkeyPatch) -> None:
    state, best, _ = conflicting(monkeypatch, 3.1, -1.0, [0.5, 0.0, 0.02])
    wrong, doubts = landmark_conflicts.contradicted_landmarks(state)
    assert wrong.tolist() == [True, False, False]
    assert doubts == ((best, pytest.approx(3.1 - SCORE.w_landmark)),)
