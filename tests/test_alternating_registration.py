"""Shapes that differ much, registered and refined in turn."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import kfmaps
from conftest import NO_LANDMARKS, cloud_of, functional_map
from kfmaps._arrays import NotConverged
from kfmaps._threads import limit_threads
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.geometry.mesh import MIRROR, Mesh, vertex_areas
from kfmaps.matching import finish, ranking, registration_refine, search_result
from kfmaps.matching import match as match_module
from kfmaps.matching import search as search_module
from kfmaps.matching.candidates import map_distance, score_maps
from kfmaps.matching.extremity_matching import (
    ExtremityMatch,
    complete_match,
    match_extremities,
    match_of_map,
    unused_matches,
    vertices_of_match,
)
from kfmaps.matching.finish import better_match
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.quality import sample_for_scoring
from kfmaps.matching.ranking import ProxyCache, rerank_near_duplicates
from kfmaps.matching.registration_refine import refine_by_registration, repairable
from kfmaps.matching.result_groups import MatchRegistration
from kfmaps.matching.sample_pair import SamplePair, TwoLevelSamples, mirrored_pair, paired_map, two_level_samples
from kfmaps.matching.score import SCORE, Candidate, Quality, deforms_too_much, is_close_but_deformed
from kfmaps.matching.search_result import SearchResult
from kfmaps.matching.search_state import SearchState
from kfmaps.registration import alternating_registration as alternating_module
from kfmaps.registration.alternating_registration import (
    AlternatingResult,
    _project_positions,
    alternating_registration,
    position_normal_guidance,
)

GUARDS = ("kfmaps.matching", "kfmaps.registration.alternating_registration", "kfmaps.registration.evidence")

NOTHING = Quality(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@pytest.fixture(autouse=True)
def alike(monkeypatch):
    """How bent shapes look is tested in test_registration_evidence.py, and takes seconds."""
    for module in (ranking, registration_refine):
        monkeypatch.setattr(module, "registered_shot_error", lambda *_what: 0.2)


@pytest.fixture(scope="module")
def astray(creature_pair):
    """A map to nowhere."""
    return np.linalg.qr(np.random.default_rng(0).normal(size=creature_pair.C.shape))[0]


def error(C, creature_pair):
    k_t, k_s = C.shape
    images = creature_pair.source.basis.functions[:, :k_s] @ C.T
    points = nearest(np.ascontiguousarray(creature_pair.target.basis.functions[:, :k_t]), images)
    return kfmaps.geodesic_errors(creature_pair.source.mesh, points, creature_pair.truth).mean()


def torn(creature_pair, parts):
    """The true map, of which one of so many parts is sent elsewhere."""
    points = creature_pair.truth.copy()
    high = np.argsort(creature_pair.target.mesh.vertices[:, 0])[-len(points) // parts :]
    points[high] = np.random.default_rng(0).permutation(points[high])
    return functional_map(points, creature_pair.source, creature_pair.target)


def repaired(creature_pair, *begun, progress=None) -> Any:
    ranked = [replace(c, deformation_energy=1.0) for c in begun]
    more = () if progress is None else (progress,)
    with limit_threads(1):  # one repair after another
        return refine_by_registration(ranked, creature_pair.fine, creature_pair.proxies, NO_LANDMARKS, *more)


def test_rounds_repair_a_torn_map_and_register_vertices_where_the_truth_is(creature_pair, monkeypatch):
    """What remains of a torn map pulls the rest back, which functions alone do not; each fit is followed by a
    refinement that it takes part in."""
    pair, C = creature_pair.proxies.fine, torn(creature_pair, 4)
    *_, mended = alternating_registration(C, pair, None, NO_LANDMARKS)
    assert error(mended.functional_map, creature_pair) < 0.7 * error(C, creature_pair)
    rounds = list(alternating_registration(creature_pair.C, pair, None, NO_LANDMARKS))
    off = np.linalg.norm(
        rounds[-1].registered_vertices[creature_pair.truth] - creature_pair.target.mesh.vertices, axis=1
    )
    assert off.mean() < 0.04
    assert len(rounds) == alternating_module._ROUNDS
    assert not np.array_equal(rounds[0].functional_map, rounds[-1].functional_map)
    monkeypatch.setattr(alternating_module, "WEIGHT", 0.0)
    *_, without = alternating_registration(creature_pair.C, pair, None, NO_LANDMARKS)
    assert error(rounds[-1].functional_map, creature_pair) < error(without.functional_map, creature_pair)


def test_positions_are_spread_smoothly(creature_pair):
    pair, source = creature_pair.proxies.fine, creature_pair.source
    again = _project_positions(pair.proxies[0].mesh.vertices, pair.bases[0], source.basis)
    assert np.linalg.norm(again - source.mesh.vertices, axis=1).mean() < 0.01


def test_a_surface_has_no_difference_to_itself(creature_pair):
    mesh = creature_pair.source.mesh
    guide = position_normal_guidance(mesh, mesh)
    assert np.array_equal(guide.source, guide.target)
    a, b = np.random.default_rng(0).integers(len(mesh.vertices), size=(2, 4000))
    apart = ((guide.source[a] - guide.source[b]) ** 2)[:, :3].sum(axis=1)
    assert apart.mean() == pytest.approx(1.0, abs=0.1)


def test_point_clouds_are_not_registered(creature_pair):
    source, on = creature_pair.source, creature_pair.fine
    cloud = replace(source, mesh=cloud_of(source.mesh))
    for shapes in ((cloud, source), (source, cloud)):
        assert ProxyCache.of(*shapes, on).fine is None
    for coarse in ((None, on.target.proxy), (on.source.proxy, None)):
        assert ProxyCache(source, source, coarse).coarse is None


def test_proxies_are_made_once_and_of_the_image_that_is_meant(creature_pair):
    kept: Any = creature_pair.proxies
    image: Any = ProxyCache.of(creature_pair.source, creature_pair.target, mirrored_pair(creature_pair.fine))
    assert kept.image is creature_pair.target
    np.testing.assert_array_equal(image.image.mesh.vertices, creature_pair.target.mesh.vertices * MIRROR)
    for name in ("coarse", "fine"):
        assert getattr(kept, name) is getattr(kept, name)
        (a, b), (c, d) = (getattr(of, name).proxies for of in (kept, image))
        np.testing.assert_array_equal(c.mesh.vertices, a.mesh.vertices)
        np.testing.assert_array_equal(d.mesh.vertices, b.mesh.vertices * MIRROR)
    assert kept.shot_guidance is kept.shot_guidance
    assert not np.allclose(kept.shot_guidance.target, image.shot_guidance.target)


def test_repairs_report_their_progress(creature_pair, monkeypatch):
    monkeypatch.setattr(registration_refine, "match_extremities", lambda *_: [])
    calls = []
    repaired(creature_pair, creature_pair.right, progress=lambda *what: calls.append(what))
    assert calls == [("registered and refined in turn", done) for done in (0.0, 0.5, 1.0)]


def test_the_target_is_registered_and_the_source_where_that_is_asked_for(creature_pair, monkeypatch):
    """Of the winner alone, and not where a copy falls apart."""
    n_s, n_t = (len(shape.mesh.vertices) for shape in (creature_pair.source, creature_pair.target))
    calls, apart = [], []

    def made(C, on, guided, _landmarks):
        calls.append((on.source is creature_pair.target, guided.source.shape[0], np.array_equal(C, creature_pair.C.T)))
        if (on.source is creature_pair.target) in apart:
            raise NotConverged("it fell apart")
        yield AlternatingResult(C, on.source.mesh.vertices)

    monkeypatch.setattr(registration_refine, "alternating_registration", made)
    monkeypatch.setattr(registration_refine, "match_extremities", lambda *_: [])
    (first,), (way,) = repaired(creature_pair, creature_pair.right)  # nothing else was mended
    assert calls == [(True, n_t, True)]
    other = way.make()
    assert calls[1:] == [(False, n_s, False)]
    for one, backwards, count in ((first, True, n_t), (other, False, n_s)):
        assert one.swapped == backwards
        assert len(one.registered_vertices) == count
        np.testing.assert_array_equal(one.functional_map, creature_pair.C)
    apart.append(False)
    assert way.make() is None
    apart.append(True)
    assert repaired(creature_pair, creature_pair.right)[0][0].registered_vertices is None


def test_likely_extremity_matches_that_no_map_has_are_repaired_too(creature_pair, monkeypatch):
    """With their own tips, which what is mended keeps to, and only as long as the copies hold."""
    on = creature_pair.fine
    (best, *others) = match_extremities(on.source, on.target, on.descriptor_cost)
    mirror = next(one for one in others if one.contradicts(best))
    monkeypatch.setattr(registration_refine, "match_extremities", lambda *_: [best, mirror])
    monkeypatch.setattr(registration_refine, "complete_match", lambda one, _likely: one)
    begun, asked = [], []

    def tips_of(extremity_match, *rest):
        asked.append(f"{extremity_match}")
        return vertices_of_match(extremity_match, *rest)

    def made(C, on, _led, _landmarks):
        begun.append(C)
        if len(begun) == 5:
            raise NotConverged("it fell apart")
        yield AlternatingResult(C, on.source.mesh.vertices)

    monkeypatch.setattr(registration_refine, "alternating_registration", made)
    monkeypatch.setattr(registration_refine, "vertices_of_match", tips_of)
    found, (other, _) = repaired(creature_pair, creature_pair.right)
    names = {c.name for c in found}
    assert {found[0].name, other.name} == names == {"truth", f"{mirror}"}
    assert len(begun) == 2  # the truth has the best pairing itself
    assert asked == [f"{match_of_map(creature_pair.right.points, on.source, on.target)}", f"{mirror}"]
    np.testing.assert_array_equal(begun[1].T, paired_map(mirror, on, len(begun[1])))
    monkeypatch.setattr(registration_refine, "match_of_map", lambda *_: None)
    assert f"{mirror}" not in {c.name for c in repaired(creature_pair, creature_pair.right)[0]}
    assert len(begun) == 5


def test_a_repair_that_fails_in_its_second_round_counts_as_after_the_first(creature_pair, astray, monkeypatch):
    """The best repair began with an extremity match, all others lag: what is left of it leads nevertheless."""
    good, bad = score_maps([Start("matched", creature_pair.C), Start("before", astray)], creature_pair.fine)

    def made(C, where, *_rest):
        yield AlternatingResult(C, where.source.mesh.vertices)
        if not np.array_equal(C, astray.T):
            raise NotConverged("it fell apart")
        yield AlternatingResult(C, where.source.mesh.vertices)

    monkeypatch.setattr(registration_refine, "SCORE", replace(SCORE, repair_lag=0.01))
    monkeypatch.setattr(registration_refine, "alternating_registration", made)

    def plan(setting, near, _n_matches):
        return [
            *(registration_refine.Repair(setting, c, None) for c in near),
            registration_refine.Repair(setting, good, None, False),
        ]

    monkeypatch.setattr(registration_refine, "_plan_repairs", plan)
    assert [c.name for c in repaired(creature_pair, bad)[0]] == ["matched", "before"]


def test_a_repair_that_lags_after_one_round_is_given_up(creature_pair, astray, monkeypatch):
    """It stays a rival that is bent as badly as the worst; what was good before its first round is not given up."""
    good, bad = score_maps([Start("0", creature_pair.C), Start("1", astray)], creature_pair.fine)
    gap, rounds = good.quality.score - bad.quality.score, []

    def made(C, where, *_rest):
        back = where.source is creature_pair.target
        for i in range(2):
            rounds.append((back, np.array_equal(C, astray.T if back else astray), i))
            yield AlternatingResult(C, where.source.mesh.vertices)

    def after(*begun, lag):
        """What repairs that change nothing leave of some maps, when they lag by so much."""
        rounds.clear()
        monkeypatch.setattr(registration_refine, "SCORE", replace(SCORE, repair_lag=lag, repairable_margin=np.inf))
        return repaired(creature_pair, *begun)[0]

    monkeypatch.setattr(registration_refine, "alternating_registration", made)
    monkeypatch.setattr(registration_refine, "match_extremities", lambda *_: [])
    assert [c.name for c in after(good, bad, lag=gap + 0.01)] == ["0", "1"]
    assert rounds.count((True, True, 1)) == 1
    first, second = after(good, bad, lag=gap - 0.01)
    assert (first.name, second.name) == ("0", "1")
    assert (True, True, 0) in rounds
    assert (True, True, 1) not in rounds
    assert second.deformation_energy == first.deformation_energy  # the worst of one
    assert second.score < first.score - 1
    # What was as good before is not given up.
    after(good, replace(bad, quality=good.quality), lag=gap - 0.01)
    assert {(True, True, 1), (False, True, 1)} <= set(rounds)


def test_extremity_matches_are_used_once():
    def extremity_match(*pairs):
        return ExtremityMatch(*np.array(pairs).T)

    whole = extremity_match((0, 0), (1, 1), (2, 2), (3, 3))
    part, other = extremity_match((0, 0), (1, 1), (2, 2)), extremity_match((0, 0), (1, 2), (2, 1))
    third = extremity_match((0, 4), (1, 1), (2, 2))
    # Of the first the whole is begun with, though a part of it is likelier: there is less to differ.
    assert unused_matches([part, whole, other, third], [], 3) == [whole, other, third]
    assert unused_matches([part, whole, other, third], [], 2) == [whole, other]
    assert unused_matches([part, other], [], 2) == [part, other]
    assert complete_match(part, [other, third]) is part
    assert complete_match(whole, [part, whole]) is whole
    assert unused_matches([part, other, third], [whole], 3) == [other, third]
    assert unused_matches([whole], [part], 1) == [whole]
    assert part.contradicts(third)
    assert part.contradicts(extremity_match((5, 0)))  # by the target's tip alone
    assert not part.contradicts(extremity_match((5, 5)))
    assert not whole.contradicts(part)


def test_a_map_that_a_repair_makes_worse_stays_as_it_was(creature_pair, astray, monkeypatch):
    lost = AlternatingResult(astray, creature_pair.target.mesh.vertices)
    monkeypatch.setattr(registration_refine, "alternating_registration", lambda *_rest: iter([lost]))
    monkeypatch.setattr(registration_refine, "match_extremities", lambda *_: [])
    (found,), (way,) = repaired(creature_pair, creature_pair.right)
    assert found.functional_map is creature_pair.right.functional_map
    assert found.registered_vertices is None
    assert not way.make().swapped
    # Looked at as closely as what it is compared with.
    assert found.deformation_energy < 0.5
    assert found.strain is not None


def test_a_repair_that_fails_in_one_direction_is_made_in_the_other(creature_pair, astray, monkeypatch):
    coarse_map = creature_pair.C + 0.02 * np.random.default_rng(1).normal(size=creature_pair.C.shape)

    def made(_C, where, *_rest):
        found = astray if where.source is creature_pair.target else creature_pair.C
        yield AlternatingResult(found, where.source.mesh.vertices)

    monkeypatch.setattr(registration_refine, "alternating_registration", made)
    monkeypatch.setattr(registration_refine, "match_extremities", lambda *_: [])
    (found,) = repaired(creature_pair, *score_maps([Start("rough", coarse_map)], creature_pair.fine))[0]
    np.testing.assert_array_equal(found.functional_map, creature_pair.C)
    assert not found.swapped
    assert found.registered_vertices is creature_pair.source.mesh.vertices


@pytest.mark.parametrize(
    ("scores", "places", "mended"),
    [
        ((-1.0, -9.0, -4.0, -4.5), (0.0, 1.0, 2.0, 3.0), "ac"),  # as where a second look has put one far behind
        ((0.0,) * 7, (0.0, 0.05, -0.05, 0.06, 1.0, 1.5, 2.0), "abef"),  # however many hardly differ from the first
    ],
)
def test_the_first_few_are_repaired_and_those_that_differ_and_the_rest_stay_once(scores, places, mended):
    """Sample i lies at the i-th place, and the points of the i-th candidate all there."""
    ranked = [
        Candidate(name, np.eye(2), np.full(3, i), NOTHING, strain=-s / SCORE.w_strain)
        for i, (name, s) in enumerate(zip("abcdefg", scores, strict=False))
    ]
    on: Any = SimpleNamespace(positions=np.array([[x, 0.0, 0.0] for x in places]))
    near, rest = ("".join(c.name for c in some) for some in repairable(ranked, on))
    assert near == mended
    assert rest == "".join(c.name for c in ranked if c.name not in mended)


def test_a_map_that_hardly_differs_comes_first_where_it_deforms_less(creature_pair):
    starts = [Start("torn", torn(creature_pair, 6)), Start("truth", creature_pair.C)]
    bad, good = score_maps(starts, creature_pair.fine)
    # All else says as much for either, and a little more for the torn one.
    good = replace(good, quality=replace(bad.quality, distortion=bad.quality.distortion + 0.01))
    ranked: Any = ranking.ranking([bad], creature_pair.fine, creature_pair.proxies)

    def reranked(*found, **how):
        return rerank_near_duplicates(ranked, list(found), creature_pair.fine, creature_pair.proxies, **how)

    found: Any = reranked(bad, good)
    assert [c.name for c in found] == ["truth", "torn"]
    assert found[1] is ranked[0]
    assert found[0].deformation_energy < ranked[0].deformation_energy
    assert reranked(bad) == ranked
    # Not where it is too far behind before that.
    far = replace(good, quality=replace(good.quality, distortion=good.quality.distortion + 0.2))
    assert {c.name for c in reranked(bad, far)} == {"truth", "torn"}
    assert reranked(bad, far, behind=1.0) == ranked


def test_a_map_deforms_too_much_or_not():
    one = Candidate("a", np.eye(2), np.zeros(3, dtype=int), replace(NOTHING, distortion=1.0))
    numbers = SCORE.calibration
    usual = np.exp(numbers.usual_log_deformation + numbers.log_deformation_per_score * one.quality.score)
    energies = [None, *(usual * np.exp(SCORE.excess_deformation + more) for more in (-0.01, 0.01))]
    assert [deforms_too_much(replace(one, deformation_energy=e)) for e in energies] == [False, False, True]


def test_of_near_duplicates_the_one_that_deforms_less_is_found(creature_pair, monkeypatch):
    source, target = creature_pair.source, creature_pair.target
    on = two_level_samples(source, target, (sample_for_scoring(source), sample_for_scoring(target)))
    best = score_maps([Start("best", creature_pair.C)], on.fine)[0]
    few = np.where(np.arange(len(best.points)) < len(best.points) // 20, best.points[::-1], best.points)
    worse = replace(best.quality, distortion=best.quality.distortion + 0.05)
    alike = replace(best, name="alike", points=few, quality=worse, functional_map=creature_pair.C.copy())
    assert SCORE.duplicate_distance < map_distance(best, alike, on.fine.source) < SCORE.distinct_distance
    bends = {"best": 0.12, "alike": 0.06}
    monkeypatch.setattr(search_module, "candidates", lambda *_what, **_how: [best, alike])
    monkeypatch.setattr(
        ranking,
        "with_deformation_energy",
        lambda some, *_: [replace(c, deformation_energy=bends[c.name]) for c in some],
    )
    config = kfmaps.Config(threads=1, search=kfmaps.Search(orientation="preserving"))
    found = search_module.search_map(source, target, config)
    assert found.initialization == "alike"
    assert len(found.scores) == 1


def test_the_match_that_is_worth_more_is_taken(creature_pair):
    """Of two that both have a fit, by score and torn area together; the one taken tells the seconds of the whole."""
    one = finish.match_from_map(
        creature_pair.source, creature_pair.target, finish.KnownMap(creature_pair.truth, "a", quality=-9.0)
    )
    areas = vertex_areas(creature_pair.target.mesh)

    def made(score, share):
        trust = np.where(np.cumsum(areas) <= share * areas.sum(), 0.4, 0.9)
        marked = replace(one.score, scores=(score,))
        return replace(one, score=marked, local_confidence=trust, seconds={}, verdict=f"{share}")

    known = replace(made(-9.0, 0.3), seconds=one.seconds)
    for lost, taken in ((0.1 * SCORE.w_torn, 0.1), (0.3 * SCORE.w_torn, 0.3), (-1.0, 0.1)):
        found = better_match(known, made(-9.0 - lost, 0.1))
        assert found.verdict == f"{taken}"
        assert found.seconds is one.seconds
    refused = replace(made(-9.0, 0.1), precise_map=None)
    assert better_match(known, refused).verdict == "0.1"
    assert better_match(known, replace(refused, registration=MatchRegistration())) is known


def test_the_energy_of_the_registration_takes_the_place_of_that_of_the_proxies(creature_pair):
    one = finish.match_from_map(
        creature_pair.source, creature_pair.target, finish.KnownMap(creature_pair.truth, "a", quality=-9.0)
    )
    torn, own_report = (finish.torn_area_fraction(one) or 0.0) * SCORE.w_torn, one.registration.report
    assert own_report is not None

    def made(score, proxies, own):
        report = replace(own_report, deformation_energy=own)
        marked = replace(one.score, scores=(score,), deformation_energy=proxies)
        return replace(one, score=marked, registration=replace(one.registration, report=report))

    usual = made(-9.0, 0.4, 0.4)
    assert finish.registered_score(usual) == pytest.approx(-9.0 - torn)
    gain = SCORE.w_deformation * np.log(2.0)
    assert finish.registered_score(made(-9.0, 0.4, 0.2)) == pytest.approx(-9.0 - torn + gain)
    assert finish.registered_score(made(-9.0, 0.2, 0.4)) == pytest.approx(-9.0 - torn - gain)
    assert finish.registered_score(made(-9.0, 0.02, 0.0)) == pytest.approx(-9.0 - torn + gain)
    assert finish.registered_score(made(-9.0, None, 0.2)) == pytest.approx(-9.0 - torn)
    bends_less = made(-9.0 - 0.9 * gain, 0.4, 0.2)
    assert better_match(usual, bends_less) is not usual
    assert better_match(usual, made(-9.0 - 1.1 * gain, 0.4, 0.2)) is usual


def test_a_match_finishes_all_ways_unless_it_is_hardly_torn(creature_pair, monkeypatch):
    source, target = creature_pair.source, creature_pair.target
    other = SearchResult(creature_pair.C, "other", None, "unlikely", quality=-9.0, scores=(-9.0,))
    asked = []
    ways: Any = (replace(other, registered_vertices=target.mesh.vertices, swapped=True), other, None)
    monkeypatch.setattr(match_module, "retry", lambda found, i, least: asked.append(least) or found.retries[i])
    monkeypatch.setattr(
        match_module, "search_map", lambda *_a, **_k: replace(other, initialization="one", retries=ways)
    )
    monkeypatch.setattr(match_module, "better_match", lambda a, b: replace(b, seconds=a.seconds))
    config = replace(kfmaps.Config(), registration=None)
    for share, ends in ((0.5, "other"), (SCORE.max_torn_area, "one"), (None, "one")):
        for module in (match_module, finish):
            monkeypatch.setattr(module, "torn_area_fraction", lambda _match, share=share: share)
        found = kfmaps.match(source, target, config)
        assert found.score.initialization == ends
        assert [f"another way, {i}" in found.seconds for i in (1, 2)] == 2 * [ends == "other"]
    assert asked == 3 * [-9.0 - 0.5 * SCORE.w_torn]


def test_a_search_tells_what_else_may_turn_out_better(creature_pair, monkeypatch):
    """Each where its score is above what is known; the alternatives of each differ from it."""
    one = Candidate("0", np.eye(5), np.zeros(2000, dtype=int), NOTHING, deformation_energy=0.15)
    ranked = [replace(one, name=str(i), points=np.full(2000, i), strain=i / SCORE.w_strain) for i in range(5)]
    twin = replace(one, name="twin", strain=0.5 / SCORE.w_strain)
    setting: Any = None
    back = registration_refine.SwappedRepair(registration_refine.Repair(setting, twin, None), (0.0, 0.0))
    monkeypatch.setattr(registration_refine.SwappedRepair, "make", lambda _self: None)
    monkeypatch.setattr(search_module, "SCORE", replace(SCORE, repair_score=np.inf))
    monkeypatch.setattr(search_module, "refine_by_registration", lambda *_, **__: (ranked, (ranked[2], twin, back)))
    monkeypatch.setattr(search_module, "rerank_near_duplicates", lambda *_: ranked)
    monkeypatch.setattr(search_result, "alternative_maps", lambda maps, *_: tuple(range(len(maps))))
    monkeypatch.setattr(search_module, "map_distance", lambda a, b, _: float(a.points[0] != b.points[0]))
    found = search_module.search_map(creature_pair.source, creature_pair.target, kfmaps.Config())
    made = [search_module.retry(found, i, -np.inf) for i in range(3)]
    best = [c.score for c in ranked]
    assert [m and (m.initialization, m.scores[:2]) for m in (found, *made)] == [
        ("0", (best[0], best[1])),
        ("2", (best[2], best[0])),
        ("twin", (twin.score, best[1])),
        None,
    ]
    assert [search_module.retry(found, i, best[1]) and "more" for i in range(3)] == [None, "more", None]


@pytest.mark.parametrize("too_much", [False, True])
def test_a_good_map_that_deforms_the_shape_too_much_is_repaired_with_its_rivals(creature_pair, monkeypatch, too_much):
    """Another one, torn so far, may be the right one: a giraffe has been half a turn off."""
    found = score_maps([Start("0", creature_pair.C)], creature_pair.fine)
    assert found[0].quality.calibrated_score > SCORE.repair_score
    repaired: list[str] = []
    monkeypatch.setattr(search_module, "_compare_exchanged", lambda state: state)
    monkeypatch.setattr(search_module, "deforms_too_much", lambda _best: too_much)
    monkeypatch.setattr(
        search_module, "refine_by_registration", lambda ranked, *_, **__: repaired.extend(ranked) or (ranked, ())
    )
    search_module._improve_best(_ranked_state(creature_pair, found), lambda *_: None)
    assert bool(repaired) == too_much


@pytest.mark.parametrize(("output", "alone"), [("sure", True), ("likely", False)])
def test_of_a_sure_map_nothing_else_is_repaired(creature_pair, astray, monkeypatch, output, alone):
    found = score_maps([Start("0", creature_pair.C), Start("1", astray)], creature_pair.fine)
    ranked = [replace(c, deformation_energy=1.0) for c in found]
    state = SearchState(
        creature_pair.source,
        creature_pair.target,
        kfmaps.Config(),
        landmarks=NO_LANDMARKS,
        evidence=None,
        rejected=np.zeros(0, dtype=bool),
        samples=TwoLevelSamples(creature_pair.fine, creature_pair.fine),
        proxies=creature_pair.proxies,
        candidates=found,
        ranked=ranked,
        orientation="preserving",
    )
    planned = []

    def run(repairs, _progress):
        planned.extend(repair.start.name for repair in repairs)
        return dict(enumerate(ranked[: len(repairs)])), {}

    monkeypatch.setattr(search_module, "verdict", lambda *_: output)
    monkeypatch.setattr(search_module, "SCORE", replace(SCORE, repair_score=np.inf))
    monkeypatch.setattr(search_module, "_compare_exchanged", lambda state: state)
    monkeypatch.setattr(registration_refine, "SCORE", replace(SCORE, repairable_margin=np.inf))
    monkeypatch.setattr(registration_refine, "_run_repairs", run)
    search_module._improve_best(state, lambda *_: None)
    assert (planned == ["0"]) == alone
    assert {"0", "1"} <= set(planned) or alone


def test_registered_positions_of_the_target_guide_as_well(creature_pair):
    """Of a map found backwards the target is bent: what lies on each other is the same."""
    source, target = creature_pair.source, creature_pair.target
    registered = target.mesh.vertices + 1.0
    found = SearchResult(np.eye(5), "a", None, "unlikely", registered_vertices=registered, swapped=True)
    guided, alone = (
        match_module._search_guidance(one, (source, target))
        for one in (found, replace(found, registered_vertices=None))
    )
    lie = position_normal_guidance(source.mesh, Mesh(registered, target.mesh.faces))
    for side in ("source", "target"):
        both = np.hstack([getattr(alone, side), np.sqrt(alternating_module.WEIGHT) * getattr(lie, side)])
        np.testing.assert_allclose(getattr(guided, side), both)


def test_a_map_is_registered_on_proxies_either_way(creature_pair, monkeypatch):
    """The vertices are those of the side that is registered; descriptors stay on their side."""
    source, target = creature_pair.source, creature_pair.target
    pair, asked = creature_pair.proxies.fine, []
    guided = DescriptorGuidance(source.mesh.vertices, target.mesh.vertices)
    usual = registration_refine.alternating_registration

    def spy(C, pair, guidance, landmarks):
        asked.append((pair.source, guidance.source, guidance.target))
        return usual(C, pair, guidance, landmarks)

    monkeypatch.setattr(registration_refine, "alternating_registration", spy)
    for swapped, moved, other in ((True, target, source), (False, source, target)):
        found: Any = [
            *registration_refine.register_map_on_proxies(creature_pair.C, pair, guided, NO_LANDMARKS, swapped)
        ][-1]
        assert error(found.functional_map, creature_pair) < 0.05
        assert found.registered_vertices.shape == moved.mesh.vertices.shape
        shape, own, theirs = asked.pop()
        assert shape is moved
        assert own is moved.mesh.vertices
        assert theirs is other.mesh.vertices

    def falls_apart(*_what):
        yield AlternatingResult(creature_pair.C, source.mesh.vertices)
        raise NotConverged("it fell apart")

    monkeypatch.setattr(registration_refine, "alternating_registration", falls_apart)
    ended = registration_refine.register_map_on_proxies(creature_pair.C, pair, guided, NO_LANDMARKS)
    assert [one is None for one in ended] == [False, True]


def test_a_map_that_deforms_too_much_is_repaired_before_mirror_images_are_tried(creature_pair, monkeypatch):
    """The repaired map stays where it is better, and where no proxy can be registered all stays as it is."""
    source, target, copies = creature_pair.source, creature_pair.target, creature_pair.proxies
    starts = [Start("torn", torn(creature_pair, 4)), Start("right", creature_pair.C)]
    found: Any = ranking.with_deformation_energy(score_maps(starts, creature_pair.fine), copies)
    config, wrong = replace(kfmaps.Config(), threads=1), np.zeros(0, dtype=bool)
    torn_first = SearchState(
        source, target, config, NO_LANDMARKS, None, wrong, creature_pair.samples, copies, found, found, "preserving"
    )
    best: Any = search_module._repaired(found[0], torn_first)
    assert best.score > found[0].score
    assert best.deformation_energy < found[0].deformation_energy
    calls = []
    monkeypatch.setattr(search_module, "build_guidance", lambda *what, **_shot: calls.append(what[2]))
    pairs = np.array([[3, 5], [8, 2]])
    search_module._repaired(found[0], replace(torn_first, landmarks=pairs, rejected=np.array([True, False])))
    np.testing.assert_array_equal(calls[0], pairs[1:], err_msg="rejected landmarks take no part")
    monkeypatch.undo()
    compared = []
    monkeypatch.setattr(search_module, "choose_orientation", lambda state, too_much: compared.append(too_much) or state)
    for too_much in (False, True):
        monkeypatch.setattr(search_module, "deforms_too_much", lambda _best, too_much=too_much: too_much)
        state = search_module._rank(replace(torn_first, candidates=found[:1]))
        assert (state.ranked[0].score > found[0].score) == too_much
        # Otherwise it would be lost when the candidates are ranked again, with others composed from mirror images.
        assert len(state.candidates) == 1 + too_much
        assert state.candidates[-1].functional_map is state.ranked[0].functional_map
        assert state.candidates[-1].deformation_energy is None or not too_much
    assert compared == [False, True]
    rivals = []
    monkeypatch.setattr(search_module, "_repair_rivals", lambda one: rivals.append(one.ranked[0]) or one)
    search_module._rank(replace(torn_first, candidates=found[:1]))
    assert [one.score > found[0].score for one in rivals] == [True]
    monkeypatch.setattr(search_module, "register_map_on_proxies", lambda *_what: iter([None]))
    assert search_module._repaired(found[0], torn_first) is found[0]
    flat = replace(torn_first, proxies=ProxyCache(source, target, (None, None)))
    assert search_module._repaired(found[0], flat) is found[0]


def _ranked_state(pair, ranked):
    config, wrong = replace(kfmaps.Config(), threads=1), np.zeros(0, dtype=bool)
    shapes = pair.source, pair.target
    return SearchState(*shapes, config, NO_LANDMARKS, None, wrong, pair.samples, pair.proxies, [], ranked, "preserving")


def test_a_rival_whose_map_alone_is_better_is_refined_once_more(creature_pair, monkeypatch):
    """A bad registration of the right map has put a turtle's front on its back; another round of refinement helped."""
    found: Any = ranking.with_deformation_energy(
        score_maps([Start("wrong", creature_pair.C)], creature_pair.fine), creature_pair.proxies
    )
    best: Any = found[0]
    energy, away = best.deformation_energy, (best.points + len(best.points) // 2) % len(best.points)
    less = replace(best.quality, descriptors=best.quality.descriptors - 0.01, reflection_error=0.4)
    rival = replace(best, name="rival", points=away, quality=less, deformation_energy=2.5 * energy)
    state = _ranked_state(creature_pair, [best, rival])
    assert best.score - rival.score > 4
    refined = []

    def again(found, samples, again):
        assert samples is creature_pair.samples
        refined.append((found[0].name, again))
        return [replace(rival, name=name, quality=replace(less, heat=heat)) for name, heat in (("b", 0.5), ("a", 0.1))]

    energies = {"a": energy, "b": energy, "c": energy / 3}
    monkeypatch.setattr(search_module, "refine_fine", again)
    monkeypatch.setattr(
        search_module,
        "with_deformation_energy",
        lambda some, _proxies: [replace(c, deformation_energy=energies[c.name]) for c in some],
    )
    repaired, alike, refined_again = [], [], search_module._refined_again
    monkeypatch.setattr(
        search_module,
        "_refined_again",
        lambda one, state: alike.append(one.name) or one if one is best else refined_again(one, state),
    )
    monkeypatch.setattr(search_module, "_repaired", lambda one, _state: repaired.append(one.name) or one)
    assert [c.name for c in search_module._repair_rivals(state).ranked] == ["wrong", "a"]
    assert refined == [("rival", True)]
    assert alike == [], "a rival far behind asks for nothing"
    assert repaired == ["a"], "the best of what refinement has led to"
    mended = replace(rival, name="c", quality=replace(less, reflection_error=0.0), deformation_energy=energy / 3)
    monkeypatch.setattr(search_module, "_repaired", lambda _one, _state: mended)
    assert [c.name for c in search_module._repair_rivals(state).ranked] == ["c", "wrong"]
    assert alike == ["wrong"], "a close one is compared with the best refined alike"
    energies["a"] = energies["b"] = 9 * energy
    monkeypatch.setattr(search_module, "_repaired", lambda one, _state: one)
    assert search_module._repair_rivals(state) is state, "it stays as it is where that is better"
    usual = replace(rival, quality=replace(best.quality, reflection_error=0.4, heat=best.quality.heat + 0.5))
    unchanged = replace(state, ranked=[best, usual])
    refined.clear()
    assert search_module._repair_rivals(unchanged) is unchanged
    assert not refined


def test_a_rival_that_is_as_good_but_for_a_turned_limb_is_repaired(creature_pair, monkeypatch):
    """It is ranked again with its new score; a rival that is worse in more than its deformation stays as it is."""
    found: Any = ranking.with_deformation_energy(
        score_maps([Start("right", creature_pair.C)], creature_pair.fine), creature_pair.proxies
    )
    best: Any = found[0]
    energy, away = best.deformation_energy, (best.points + len(best.points) // 2) % len(best.points)
    deformed = replace(best, name="deformed", points=away, deformation_energy=2 * energy)
    worse = replace(deformed, name="worse", quality=replace(best.quality, descriptors=best.quality.descriptors + 0.1))
    mended = replace(deformed, name="mended", deformation_energy=1.5 * energy)
    assert is_close_but_deformed(deformed, best)
    assert not is_close_but_deformed(worse, best)
    assert is_close_but_deformed(worse, best, SCORE.rotation_margin)
    assert not is_close_but_deformed(replace(deformed, deformation_energy=1.5 * energy), best)
    assert not is_close_but_deformed(replace(deformed, deformation_energy=None), best)
    state = _ranked_state(creature_pair, [best, deformed])
    asked, alike, repair_rivals = [], [], search_module._repair_rivals
    monkeypatch.setattr(search_module, "rerank_close", lambda order, _proxies: asked.append(order) or order)
    monkeypatch.setattr(search_module, "_refined_again", lambda one, _state: alike.append(one.name) or one)
    monkeypatch.setattr(search_module, "_repaired", lambda _rival, _state: mended)
    assert [c.name for c in search_module._repair_rivals(state).ranked] == ["right", "mended"]
    assert alike == ["right"]
    assert [[c.name for c in order] for order in asked] == [["right", "mended"]]
    monkeypatch.setattr(search_module, "_compare_exchanged", lambda state: state)
    monkeypatch.setattr(search_module, "refine_by_registration", lambda ranked, *_rest, **_: (ranked, ()))
    improved = search_module._improve_best(state, lambda _stage, _done: None)[0]
    assert [c.name for c in improved.ranked] == ["right", "mended"]
    # A map with limbs exchanged that comes first is compared with the rivals anew.
    calls = []
    monkeypatch.setattr(search_module, "_repair_rivals", lambda one: calls.append(one.ranked[0].name) or one)
    monkeypatch.setattr(search_module, "_compare_exchanged", lambda one: replace(one, ranked=[mended, *one.ranked]))
    search_module._improve_best(state, lambda _stage, _done: None)
    assert calls == ["right", "mended"]
    monkeypatch.setattr(search_module, "_compare_exchanged", lambda one: one)
    search_module._improve_best(state, lambda _stage, _done: None)
    assert calls == ["right", "mended", "right"]
    monkeypatch.setattr(search_module, "_repair_rivals", repair_rivals)
    asked.clear()
    # A repair is repeated while it gains something.
    repairs = [replace(mended, name=str(i), deformation_energy=(1.9 - i / 10) * energy) for i in range(5)]
    for n_gains, last in ((1, "0"), (2, "1"), (5, "2")):
        gains = iter(repairs[:n_gains])
        monkeypatch.setattr(search_module, "_repaired", lambda rival, _state, gains=gains: next(gains, rival))
        assert [c.name for c in search_module._repair_rivals(state).ranked] == ["right", last]
    asked.clear()
    better = replace(mended, name="better", deformation_energy=energy / 2)
    monkeypatch.setattr(search_module, "_repaired", lambda _rival, _state: better)
    assert [c.name for c in search_module._repair_rivals(state).ranked] == ["better", "right"]
    assert not asked
    same = replace(mended, points=best.points)
    monkeypatch.setattr(search_module, "_repaired", lambda _rival, _state: same)
    assert [c.name for c in search_module._repair_rivals(state).ranked] == ["right"]
    unchanged = replace(state, ranked=[best, worse])
    assert search_module._repair_rivals(unchanged) is unchanged
    monkeypatch.setattr(SamplePair, "margin_factor", SCORE.rotation_margin)
    assert [c.name for c in search_module._repair_rivals(unchanged).ranked] == ["right"]
