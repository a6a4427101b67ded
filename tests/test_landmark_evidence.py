"""What landmarks do between shapes of other proportions, and how far they back a map."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

import kfmaps
from conftest import blob
from kfmaps._threads import limit_threads
from kfmaps.fmap.convert import to_functional
from kfmaps.geometry.mesh import MIRROR, unit_area
from kfmaps.geometry.sampling import stratified_vertices
from kfmaps.matching import match as matching
from kfmaps.matching import registration_refine as mending
from kfmaps.matching import search as choose
from kfmaps.matching import search_result
from kfmaps.matching.candidates import rerefine, score_maps
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.landmark_conflicts import ignore_landmarks, support_of_landmarks
from kfmaps.matching.landmark_evidence import (
    LANDMARK_WEIGHT,
    LANDMARK_WEIGHT_UNLIKE,
    build_guidance,
)
from kfmaps.matching.quality import sample_for_scoring
from kfmaps.matching.ranking import ProxyCache
from kfmaps.matching.sample_pair import two_level_samples
from kfmaps.matching.score import SCORE, landmark_support, probability, verdict
from kfmaps.matching.search_result import SearchResult
from kfmaps.registration import nonrigid_icp as nonrigid
from kfmaps.registration.alternating_registration import (
    AlternatingResult,
    alternating_registration,
    proxy_pair,
)
from kfmaps.registration.deformable import LANDMARK_PULL, deformable_mesh, landmark_pull
from kfmaps.registration.evidence import coarse_copy
from kfmaps.registration.nonrigid_icp import _SCALED_LANDMARK_PULL, NonRigid
from kfmaps.shape import mirror_image

GUARDS = (
    "kfmaps.matching",
    "kfmaps.registration.alternating_registration",
    "kfmaps.registration.evidence",
    "kfmaps.registration.nonrigid_icp",
)

"""Of a single map, which SHOT has led."""


@pytest.fixture(autouse=True)
def one_thread() -> Iterator[None]:
    """Work on one thread, so that calls that a test records come in order."""
    with limit_threads(1):
        yield


def on_a_line(*places: float) -> tuple[np.ndarray, np.ndarray]:
    """Distances from landmarks at these places of a source of length 1 to a hundred samples, and the areas of these."""
    samples = (np.arange(100) + 0.5) / 100
    return np.abs(np.array(places)[:, None] - samples), np.where(samples < 0.5, 1, 2)


def spread_out(creatures: Any, count: int) -> np.ndarray:
    """True landmarks all over the target."""
    rows = stratified_vertices(creatures[1].basis, count, 0)
    return np.stack([creatures[2][rows], rows], axis=1)


def functional(points: np.ndarray, creatures: Any, k: int) -> np.ndarray:
    source, target, _ = creatures
    return np.asarray(to_functional(points, source.basis.truncate(k), target.basis.truncate(k)))


def only_the_truth(creatures: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A search finds the true map alone, and mends nothing."""
    C = functional(creatures[2], creatures, 40)
    monkeypatch.setattr(choose, "candidates", lambda *a, **_m: score_maps([Start("a", C)], a[3].fine))
    monkeypatch.setattr(choose, "candidates_without_landmarks", lambda *_a, **_m: [])
    monkeypatch.setattr(choose, "SCORE", replace(SCORE, repair_score=-np.inf))


@pytest.fixture(scope="module")
def slid(creatures: Any) -> np.ndarray:
    """A map of few functions whose points are 0.11 off on average."""
    source, _, truth = creatures
    places = source.mesh.vertices[truth]
    moved = places + 0.15 * np.sin(4 * places[:, [1, 2, 0]])
    points = np.linalg.norm(moved[:, None] - source.mesh.vertices, axis=2).argmin(axis=1)
    return functional(points, creatures, 20)


def given(creatures: Any, count: int) -> Any:
    """The ground on which maps between the creatures are judged with so many landmarks."""
    source, target, _ = creatures
    at = spread_out(creatures, count)
    judges = sample_for_scoring(source, 300, landmarks=at[:, 0]), sample_for_scoring(target, 300, landmarks=at[:, 1])
    return two_level_samples(source, target, judges, at).fine


def test_landmarks_back_a_map_as_far_as_they_reach() -> None:
    far = 1 - SCORE.landmark_radius - 1e-3
    there, areas = on_a_line(SCORE.landmark_radius, 0.5, far)
    kept = np.zeros(3)
    most = 1 / (1 + np.exp(-SCORE.landmark_error_middle / SCORE.landmark_error_width))
    assert landmark_support(kept, there, areas) == pytest.approx(most)
    # The squared share of the area, not of the samples nor of the landmarks.
    for place, samples in ((SCORE.landmark_radius, np.arange(0, 40)), (far, np.arange(60, 100))):
        share = areas[samples].sum() / areas.sum()
        assert landmark_support(kept[:1], *on_a_line(place)) == pytest.approx(most * share**2)
    many = landmark_support(np.zeros(50), *on_a_line(*[SCORE.landmark_radius] * 50))
    assert many == pytest.approx(landmark_support(kept[:1], *on_a_line(SCORE.landmark_radius)))
    shares = [landmark_support(kept[:i], *on_a_line(*(SCORE.landmark_radius, 0.5, far)[:i])) for i in range(4)]
    assert shares[0] == 0.0
    assert (np.diff(shares) > 0.05).all()


def test_what_landmarks_say_ends_where_they_are_missed() -> None:
    """Together, when the mean is no longer that of a right map; a single one has its say, but no more than that."""
    there, areas = on_a_line(0.2, 0.5, 0.8)
    assert landmark_support(np.full(3, SCORE.landmark_error_middle), there, areas) == pytest.approx(0.5)
    assert landmark_support(
        np.full(3, SCORE.landmark_error_middle + SCORE.landmark_error_width), there, areas
    ) == pytest.approx(1 / (1 + np.e))
    assert landmark_support(np.array([0.0, 0.0, 3 * SCORE.landmark_error_middle]), there, areas) == pytest.approx(0.5)
    offs = [landmark_support(np.full(3, off), there, areas) for off in np.linspace(0, SCORE.max_landmark_error, 20)]
    assert offs == sorted(offs, reverse=True)
    several = on_a_line(*np.linspace(0, 1, 6))
    said = [
        landmark_support(np.array([0.0, 0.0, 0.0, 0.0, 0.0, off]), *several)
        for off in (0.5 * SCORE.max_landmark_error, SCORE.max_landmark_error, 9.0)
    ]
    assert said[0] > 1.01 * said[1] == pytest.approx(1.01 * said[2])
    assert said[2] == pytest.approx(
        1 / (1 + np.exp((SCORE.max_landmark_error / 6 - SCORE.landmark_error_middle) / SCORE.landmark_error_width))
    )


def test_backing_takes_away_doubt() -> None:
    bad, good = SCORE.calibration.middle - 1, SCORE.calibration.middle + 6
    for score, margin, bending in ((bad, 0.5, None), (good, 0.0, 0.01), (good, np.inf, 10.0), (-1e5, 0.0, None)):
        before = probability(score, margin, bending)
        assert probability(score, margin, bending, 0.0) == before
        assert probability(score, margin, bending, 1.0) == pytest.approx(1.0)
        assert probability(score, margin, bending, 0.25) == pytest.approx(1 - 0.75 * (1 - before))
    assert verdict(bad, np.inf) == "unlikely"
    assert verdict(bad, 1.0, None, 0.5) == "likely"
    assert verdict(bad, 1.0, None, 0.95) == "sure"
    assert verdict(good, 0.0) == verdict(good, 0.0, None, 0.5) == "ambiguous"
    assert verdict(good, 0.0, None, 0.85) == "sure"
    # What would be sure without its rival is ambiguous, also where it is the landmarks that make it so.
    alone = probability(bad, np.inf)
    enough = 1 - 0.9 * (1 - SCORE.calibration.sure) / (1 - alone)
    assert probability(bad, 0.1 * SCORE.calibration.tie, None, enough) < SCORE.calibration.sure
    assert verdict(bad, 0.1 * SCORE.calibration.tie, None, enough) == "ambiguous"


def test_a_map_is_backed_by_landmarks_that_have_not_led_it(creatures, slid) -> None:
    on = given(creatures, 10)
    maps = (functional(creatures[2], creatures, 40), slid)
    right, wrong = (score_maps([Start("a", C)], on)[0] for C in maps)
    areas = np.asarray(on.source.samples.basis.mass)
    assert on.landmark_evidence is not None
    assert (
        support_of_landmarks(right, on)
        == landmark_support(ignore_landmarks(right, on).landmark_errors, on.landmark_evidence.distances, areas)
        > 0.3
    )
    # With landmarks in it the refinement would keep to them.
    led = rerefine([wrong], on)[0]
    assert landmark_support(led.landmark_errors, on.landmark_evidence.distances, areas) > 0.3
    assert support_of_landmarks(wrong, on) < 1e-3
    assert support_of_landmarks(right, replace(on, landmark_cost=None, landmark_evidence=None)) == 0.0


def test_a_search_says_that_landmarks_back_its_map(creatures, monkeypatch) -> None:
    """As if its score were low."""
    source, target, _ = creatures
    only_the_truth(creatures, monkeypatch)
    harder = replace(SCORE.calibration, middle=0.0)
    monkeypatch.setattr(search_result, "probability", partial(probability, numbers=harder))
    monkeypatch.setattr(search_result, "verdict", partial(verdict, numbers=harder))
    config = replace(kfmaps.Config(), threads=1)
    without, backed = (
        choose.search_map(source, target, config, landmarks=at) for at in (None, spread_out(creatures, 40))
    )
    assert (without.verdict, backed.verdict) == ("unlikely", "sure")
    assert without.confidence is not None
    assert without.confidence < 0.1
    assert backed.confidence is not None
    assert backed.confidence > SCORE.calibration.sure


def test_a_landmark_that_the_map_keeps_is_doubted_no_longer(creatures, monkeypatch) -> None:
    """A rough map has missed two; the map that comes of it keeps the first, and has the second elsewhere indeed."""
    source, target, _ = creatures
    only_the_truth(creatures, monkeypatch)
    monkeypatch.setattr(choose, "contradicted_landmarks", lambda _state: (np.arange(10) < 2, ()))
    at = spread_out(creatures, 10)
    at[1, 0] = np.linalg.norm(source.mesh.vertices - source.mesh.vertices[at[1, 0]], axis=1).argmax()
    found = choose.search_map(source, target, replace(kfmaps.Config(), threads=1), landmarks=at)
    assert found.rejected_landmarks.tolist() == [1]
    np.testing.assert_array_equal(found.landmarks, np.delete(at, 1, axis=0))


def test_copies_know_the_landmarks_nearest_to_them(creatures) -> None:
    """Also those of a mirror image, and the other way round."""
    source, target, _ = creatures
    at = spread_out(creatures, 30)
    a, b = coarse_copy(source, 500), coarse_copy(target, 400)
    assert a is not None
    assert b is not None
    on = proxy_pair(source, target, (a, b))
    marks = on.nearest(at)
    for side, (shape, copy) in enumerate(((source, a), (target, b))):
        off = np.linalg.norm(copy.mesh.vertices - shape.mesh.vertices[at[:, side]][:, None], axis=2)
        chosen = off[np.arange(30), marks[:, side]]
        np.testing.assert_array_equal(chosen, off.min(axis=1))
        assert 0 < chosen.max() < 0.1
    image = proxy_pair(source, mirror_image(target), (a, b.mirrored()))
    np.testing.assert_array_equal(image.nearest(at), marks)
    there = image.copies[1].mesh.vertices[marks[:, 1]]
    assert np.linalg.norm(there - target.mesh.vertices[at[:, 1]] * MIRROR, axis=1).max() < 0.1
    np.testing.assert_array_equal(on.swapped().nearest(at[:, ::-1]), marks[:, ::-1])
    assert on.nearest(at[:0]).shape == (0, 2)


def test_the_fits_between_refinements_keep_to_landmarks(creatures, slid) -> None:
    source, target, truth = creatures
    a, b = coarse_copy(source, 500), coarse_copy(target, 500)
    assert a is not None
    assert b is not None
    on = proxy_pair(source, target, (a, b))
    rows = stratified_vertices(target.basis, 1200, 0)
    rows = rows[np.isin(rows, b.vertices) & np.isin(truth[rows], a.vertices)][:12]
    at = np.stack([truth[rows], rows], axis=1)
    off = []
    for landmarks in (at[:0], at):
        *_, made = alternating_registration(slid, on, None, landmarks)
        bent = made.registered_vertices
        off.append(np.linalg.norm(bent[truth] - target.mesh.vertices, axis=1))
    assert off[1][rows].mean() < 0.6 * off[0][rows].mean()
    assert off[1].mean() < off[0].mean()


def followed(off: float, fit: NonRigid) -> float:
    """How far a body follows a single landmark that asks one of its vertices to move by ``off``, from 0 to 1."""
    body = unit_area(blob(250))
    from_there = np.linalg.norm(body.vertices - body.vertices[3], axis=1)
    to = np.abs(from_there - off).argmin()
    bent = fit(body, body, np.arange(250), landmarks=np.array([[3, to]])).vertices
    return 1 - float(np.linalg.norm(bent[3] - body.vertices[to]) / from_there[to])


def test_what_may_be_stretched_follows_landmarks_that_are_far_off(monkeypatch) -> None:
    """Over an area as large as all of it nothing else is stretched: what differs is how landmarks hold."""
    plain = NonRigid(stiffness=5e-3, n_levels=1, steps=4)
    loose = replace(plain, local_scaling=100.0)
    near, far = 0.08, 0.15
    ways = {(fit.local_scaling, off): followed(off, fit) for fit in (plain, loose) for off in (near, far)}
    assert 1 - ways[100.0, near] < 0.7 * (1 - ways[0.0, near])
    assert ways[100.0, far] > 0.9
    assert ways[0.0, far] < 0.5
    monkeypatch.setattr(nonrigid, "_SCALED_LANDMARK_PULL", (LANDMARK_PULL[0], _SCALED_LANDMARK_PULL[1]))
    assert 1 - followed(near, loose) > 1.3 * (1 - ways[100.0, near])
    monkeypatch.setattr(nonrigid, "_SCALED_LANDMARK_PULL", LANDMARK_PULL)
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
def test_landmarks_lead_by_their_weight(creatures, lead) -> None:
    source, target, _ = creatures
    at = spread_out(creatures, 3)
    plain, led = (build_guidance(source, target, some, None, None, lead) for some in (at[:0], at))
    whole = build_guidance(source, target, at)
    assert plain is not None
    assert led is not None
    assert whole is not None
    k = plain.source.shape[1]
    for side in ("source", "target"):
        own, most = getattr(led, side), getattr(whole, side)
        np.testing.assert_allclose(own[:, :k], getattr(plain, side))
        np.testing.assert_allclose(own[:, k:], np.sqrt(lead / LANDMARK_WEIGHT) * most[:, k:])
        if lead == LANDMARK_WEIGHT:
            both = np.vstack([led.source[:, k:], led.target[:, k:]])
            assert 2 * ((both - both.mean(axis=0)) ** 2).sum(axis=1).mean() == pytest.approx(LANDMARK_WEIGHT)


def test_landmarks_lead_less_where_shapes_differ_much(creatures, monkeypatch) -> None:
    source, target, _ = creatures
    asked = []
    monkeypatch.setattr(matching, "build_guidance", lambda *_a, lead, **_m: asked.append(lead))
    found = SearchResult(np.eye(3), "a", None, "unlikely")
    for quality in (None, SCORE.non_isometric_score, SCORE.non_isometric_score - 1):
        assert replace(found, quality=quality).is_near_isometric == (quality != SCORE.non_isometric_score - 1)
        assert matching._search_guidance(replace(found, quality=quality), (source, target)) is None
    assert asked == [LANDMARK_WEIGHT, LANDMARK_WEIGHT, LANDMARK_WEIGHT_UNLIKE]


def test_what_is_mended_keeps_to_landmarks(creatures, monkeypatch) -> None:
    """Each way round, with those that are not doubted."""
    source, target, truth = creatures
    monkeypatch.setattr(mending, "registered_shot_error", lambda *_what: 0.2)
    monkeypatch.setattr(mending, "match_extremities", lambda *_: [])
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    C = functional(truth, creatures, 40)
    ranked = [replace(c, deformation_energy=1.0) for c in score_maps([Start("a", C)], on)]
    at = spread_out(creatures, 4)
    begun, leads, usual = [], [], mending.build_guidance

    def lead(*what: Any) -> Any:
        leads.append((what[2], what[5]))
        return usual(*what)

    def made(C: np.ndarray, where: Any, _led: Any, landmarks: np.ndarray) -> Iterator[AlternatingResult]:
        begun.append(landmarks.T)
        yield AlternatingResult(C, where.source.mesh.vertices)

    monkeypatch.setattr(mending, "build_guidance", lead)
    monkeypatch.setattr(mending, "alternating_registration", made)
    (way,) = mending.refine_by_registration(ranked, on, ProxyCache.of(source, target, on), at)[1]
    assert isinstance(way, mending.SwappedRepair)
    way.make()
    (t, s), (s_again, t_again) = begun
    for there, here in ((s, t), (s_again, t_again)):
        np.testing.assert_array_equal(np.stack([there, here], axis=1), at)
    assert [weight for _, weight in leads] == [LANDMARK_WEIGHT_UNLIKE, LANDMARK_WEIGHT_UNLIKE]
    assert all(np.array_equal(told, at) for told, _ in leads)


def test_ten_landmarks_make_a_match_no_worse(creatures, slid, monkeypatch) -> None:
    """Between bodies of other proportions, from the map of a search that is far off."""
    source, target, truth = creatures
    at = spread_out(creatures, 10)
    errors = []
    for some in (at[:0], at):
        found = SearchResult(slid, "a", None, "unlikely", landmarks=some, quality=SCORE.non_isometric_score - 1)
        monkeypatch.setattr(matching, "search_map", lambda *_a, found=found, **_m: found)
        points = kfmaps.match(source, target, landmarks=at).target_to_source
        errors.append(kfmaps.geodesic_errors(source.mesh, points, truth))
    assert errors[1].mean() <= errors[0].mean() < 0.03
    assert errors[1][at[:, 1]].mean() < 0.005
