"""Shapes that differ much, bent and matched in turn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import kfmaps
from kfmaps._arrays import NotConverged
from kfmaps._threads import limit_threads
from kfmaps.fmap.convert import nearest, to_functional
from kfmaps.fmap.descriptor_guidance import DescriptorGuidance
from kfmaps.geometry.mesh import MIRROR, Mesh, vertex_areas
from kfmaps.matching import finish, ranking, search_result
from kfmaps.matching import match as matching
from kfmaps.matching import registration_refine as mending
from kfmaps.matching import search as choose
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
from kfmaps.matching.initial_maps import Start, paired_map
from kfmaps.matching.quality import sample_for_scoring
from kfmaps.matching.ranking import ProxyCache, rerank_near_duplicates
from kfmaps.matching.registration_refine import refine_by_registration, repairable
from kfmaps.matching.result_groups import MatchRegistration
from kfmaps.matching.sample_pair import mirrored_pair, two_level_samples
from kfmaps.matching.score import SCORE, Candidate, Quality, deforms_too_much
from kfmaps.matching.search_result import SearchResult
from kfmaps.matching.search_state import SearchState
from kfmaps.registration import alternating_registration as alternate
from kfmaps.registration.alternating_registration import (
    ProxyPair,
    _project_positions,
    alternating_registration,
    position_normal_guidance,
    proxy_pair,
)
from kfmaps.registration.evidence import FINE_VERTICES, coarse_copy

GUARDS = ("kfmaps.matching", "kfmaps.registration.alternating_registration", "kfmaps.registration.evidence")

NO_LANDMARKS = np.zeros((0, 2), dtype=np.int64)


@pytest.fixture(autouse=True)
def one_thread() -> Iterator[None]:
    """Work on one thread, so that calls that a test records come in order."""
    with limit_threads(1):
        yield


@pytest.fixture(autouse=True)
def alike(monkeypatch):
    """How bent shapes look is tested in test_registration_evidence.py, and takes seconds."""
    for module in (ranking, mending):
        monkeypatch.setattr(module, "registered_shot_error", lambda *_what: 0.2)


def both(source, target) -> ProxyPair:
    a, b = coarse_copy(source, FINE_VERTICES), coarse_copy(target, FINE_VERTICES)
    assert a is not None
    assert b is not None
    return proxy_pair(source, target, (a, b))


def ended(C, on, led) -> alternate.AlternatingResult:
    *_, last = alternating_registration(C, on, led, NO_LANDMARKS)
    return last


def points_of(C, source, target):
    k_t, k_s = C.shape
    images = source.basis.functions[:, :k_s] @ C.T
    return nearest(np.ascontiguousarray(target.basis.functions[:, :k_t]), images)


def error(C, source, target, truth):
    return kfmaps.geodesic_errors(source.mesh, points_of(C, source, target), truth).mean()


def test_a_torn_map_is_mended(creatures):
    """A third of the target is sent elsewhere: what remains pulls it back, which functions alone do not."""
    source, target, truth = creatures
    torn = truth.copy()
    high = np.argsort(target.mesh.vertices[:, 0])[-len(torn) // 4 :]
    torn[high] = np.random.default_rng(0).permutation(torn[high])
    C = to_functional(torn, source.basis.truncate(40), target.basis.truncate(40))
    found = ended(C, both(source, target), None)
    assert error(found.functional_map, source, target, truth) < 0.7 * error(C, source, target, truth)
    assert found.registered_vertices.shape == source.mesh.vertices.shape


def test_bent_vertices_lie_where_the_truth_says(creatures):
    source, target, truth = creatures
    C = to_functional(truth, source.basis.truncate(60), target.basis.truncate(60))
    bent = ended(C, both(source, target), None).registered_vertices
    off = np.linalg.norm(bent[truth] - target.mesh.vertices, axis=1)
    assert off.mean() < 0.04


def test_each_fit_is_followed_by_a_refinement_that_it_takes_part_in(creatures, monkeypatch):
    source, target, truth = creatures
    C = to_functional(truth, source.basis.truncate(40), target.basis.truncate(40))
    rounds = [one.functional_map for one in alternating_registration(C, both(source, target), None, NO_LANDMARKS)]
    assert len(rounds) == alternate._ROUNDS
    assert not np.array_equal(rounds[0], rounds[-1])
    monkeypatch.setattr(alternate, "WEIGHT", 0.0)
    without = ended(C, both(source, target), None).functional_map
    assert error(rounds[-1], source, target, truth) < error(without, source, target, truth)


def test_positions_are_spread_smoothly(creatures):
    source = creatures[0]
    on = both(source, source)
    again = _project_positions(on.copies[0].mesh.vertices, on.bases[0], source.basis)
    off = np.linalg.norm(again - source.mesh.vertices, axis=1)
    assert off.mean() < 0.01


def test_what_lies_on_itself_differs_nowhere(creatures):
    mesh = creatures[0].mesh
    guide = position_normal_guidance(mesh, mesh)
    assert np.array_equal(guide.source, guide.target)
    a, b = np.random.default_rng(0).integers(len(mesh.vertices), size=(2, 4000))
    apart = ((guide.source[a] - guide.source[b]) ** 2)[:, :3].sum(axis=1)
    assert apart.mean() == pytest.approx(1.0, abs=0.1)


def test_point_clouds_are_not_bent(creatures):
    source = creatures[0]
    cloud = kfmaps.Mesh(source.mesh.vertices, np.zeros((0, 3), dtype=np.int64))
    on = two_level_samples(source, source, (sample_for_scoring(source, 200), sample_for_scoring(source, 200))).fine
    for shapes in ((replace(source, mesh=cloud), source), (source, replace(source, mesh=cloud))):
        assert ProxyCache.of(*shapes, on).fine is None
    for coarse in ((None, on.target.copy), (on.source.copy, None)):
        assert ProxyCache(source, source, coarse).coarse is None


def test_copies_are_made_once_and_of_the_image_that_is_meant(creatures):
    source, target, _ = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    kept, image = ProxyCache.of(source, target, on), ProxyCache.of(source, target, mirrored_pair(on))
    assert kept.coarse is not None
    assert kept.coarse is kept.coarse
    assert kept.fine is not None
    assert kept.fine is kept.fine
    assert kept.image is target
    assert image.coarse is not None
    assert image.fine is not None
    for one, other in ((kept.coarse, image.coarse), (kept.fine, image.fine)):
        (a, b), (c, d) = one.copies, other.copies
        np.testing.assert_array_equal(c.mesh.vertices, a.mesh.vertices)
        np.testing.assert_array_equal(d.mesh.vertices, b.mesh.vertices * MIRROR)
    np.testing.assert_array_equal(image.image.mesh.vertices, target.mesh.vertices * MIRROR)
    here, there = kept.shot_guidance, image.shot_guidance
    assert here is not None
    assert there is not None
    assert here is kept.shot_guidance
    assert not np.allclose(here.target, there.target)


def test_mending_tells_how_far_it_is(creatures, monkeypatch):
    """Five to ten seconds on real shapes, in which nobody should wonder."""
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    ranked = [replace(c, deformation_energy=1.0) for c in score_maps([Start("truth", C)], on)]
    monkeypatch.setattr(mending, "match_extremities", lambda *_: [])
    told = []
    refine_by_registration(
        ranked,
        on,
        ProxyCache.of(source, target, on),
        np.zeros((0, 2), dtype=np.int64),
        lambda *what: told.append(what),
    )
    assert {stage for stage, _ in told} == {"bent and matched in turn"}
    assert [done for _, done in told] == [0.0, 0.5, 1.0]


def test_the_target_is_bent_and_the_source_where_that_is_asked_for(creatures, monkeypatch):
    """Of the winner alone, and not where a copy falls apart."""
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    ranked = [replace(c, deformation_energy=1.0) for c in score_maps([Start("truth", C)], on)]
    calls, apart = [], []

    def made(C, on, led, _landmarks):
        calls.append((on.source is target, led.source.shape[0], np.array_equal(C, ranked[0].functional_map.T)))
        if (on.source is target) in apart:
            raise NotConverged("it fell apart")
        yield alternate.AlternatingResult(C, on.source.mesh.vertices)

    def end():
        found, retries = refine_by_registration(
            ranked, on, ProxyCache.of(source, target, on), np.zeros((0, 2), dtype=np.int64)
        )
        assert len(found) == 1
        return found[0], retries

    monkeypatch.setattr(mending, "alternating_registration", made)
    monkeypatch.setattr(mending, "match_extremities", lambda *_: [])
    first, retries = end()
    n_s, n_t = len(source.mesh.vertices), len(target.mesh.vertices)
    assert calls == [(True, n_t, True)]
    (way,) = retries  # nothing else was mended
    assert isinstance(way, mending.SwappedRepair)
    other = way.make()
    assert other is not None
    assert calls[1:] == [(False, n_s, False)]
    for one, backwards, count in ((first, True, n_t), (other, False, n_s)):
        assert one.swapped == backwards
        assert len(np.asarray(one.registered_vertices)) == count
        np.testing.assert_array_equal(one.functional_map, ranked[0].functional_map)
    apart.append(False)
    assert way.make() is None
    apart.append(True)
    assert end()[0].registered_vertices is None


def test_likely_pairings_are_begun_with_where_no_map_has_them(creatures, monkeypatch):
    """With their own tips, which what is mended keeps to, and only as long as the copies hold."""
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    ranked = [replace(c, deformation_energy=1.0) for c in score_maps([Start("truth", C)], on)]
    (best, *others) = match_extremities(on.source, on.target, on.descriptor_cost)
    mirror = next(one for one in others if one.contradicts(best))
    monkeypatch.setattr(mending, "match_extremities", lambda *_: [best, mirror])
    monkeypatch.setattr(mending, "complete_match", lambda one, _likely: one)
    calls, begun, asked = [], [], []

    def tips_of(pairing, *rest):
        asked.append(f"{pairing}")
        return vertices_of_match(pairing, *rest)

    def made(C, on, led, _landmarks):
        calls.append(led.source.shape[1])
        begun.append(C)
        if len(calls) == 5:
            raise NotConverged("it fell apart")
        yield alternate.AlternatingResult(C, on.source.mesh.vertices)

    monkeypatch.setattr(mending, "alternating_registration", made)
    monkeypatch.setattr(mending, "vertices_of_match", tips_of)
    landmarks = np.zeros((0, 2), dtype=np.int64)
    with kfmaps.limit_threads(1):
        found, (other, _) = refine_by_registration(ranked, on, ProxyCache.of(source, target, on), landmarks)
    names = {c.name for c in found}
    assert isinstance(other, Candidate)
    assert {found[0].name, other.name} == names
    assert len(calls) == 2  # the truth has the best pairing itself
    assert asked == [f"{match_of_map(ranked[0].points, on.source, on.target)}", f"{mirror}"]
    np.testing.assert_array_equal(begun[1].T, paired_map(mirror, on, len(begun[1])))
    assert names == {"truth", f"{mirror}"}
    monkeypatch.setattr(mending, "match_of_map", lambda *_: None)
    with kfmaps.limit_threads(1):
        found = refine_by_registration(ranked, on, ProxyCache.of(source, target, on), landmarks)[0]
    assert f"{mirror}" not in {c.name for c in found}
    assert len(calls) == 5


def test_what_falls_apart_in_the_second_round_counts_as_after_the_first(creatures, monkeypatch):
    """The best repair began with an extremity match, all others lag: what is left of it leads nevertheless."""
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    turned = np.linalg.qr(np.random.default_rng(0).normal(size=C.shape))[0]
    good, bad = score_maps([Start("matched", C), Start("before", turned)], on)

    def made(C, where, *_rest):
        yield alternate.AlternatingResult(C, where.source.mesh.vertices)
        if not np.array_equal(C, turned.T):
            raise NotConverged("it fell apart")
        yield alternate.AlternatingResult(C, where.source.mesh.vertices)

    def plan(setting, near):
        return [*(mending.Repair(setting, c, None) for c in near), mending.Repair(setting, good, None, False)]

    monkeypatch.setattr(mending, "SCORE", replace(SCORE, repair_lag=0.01))
    monkeypatch.setattr(mending, "alternating_registration", made)
    monkeypatch.setattr(mending, "_plan_repairs", plan)
    ranked = [replace(bad, deformation_energy=1.0)]
    none = np.zeros((0, 2), dtype=np.int64)
    found, _ = refine_by_registration(ranked, on, ProxyCache.of(source, target, on), none)
    assert [c.name for c in found] == ["matched", "before"]


def test_what_lags_after_one_round_is_given_up(creatures, monkeypatch):
    """It stays a rival that is bent as badly as the worst; what was good before its first round is not given up."""
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    turned = np.linalg.qr(np.random.default_rng(0).normal(size=C.shape))[0]
    good, bad = score_maps([Start("", C), Start("", turned)], on)
    gap, rounds = good.quality.score - bad.quality.score, []

    def made(C, where, *_rest):
        for i in range(2):
            rounds.append(
                (where.source is target, np.array_equal(C, turned.T if where.source is target else turned), i)
            )
            yield alternate.AlternatingResult(C, where.source.mesh.vertices)

    def repaired(*begun, lag):
        """What repairs that change nothing leave of some maps, when they lag by so much."""
        rounds.clear()
        monkeypatch.setattr(mending, "SCORE", replace(SCORE, repair_lag=lag, repairable_margin=np.inf))
        ranked = [replace(c, name=f"{i}", deformation_energy=1.0) for i, c in enumerate(begun)]
        return refine_by_registration(ranked, on, ProxyCache.of(source, target, on), np.zeros((0, 2), dtype=np.int64))[
            0
        ]

    monkeypatch.setattr(mending, "alternating_registration", made)
    monkeypatch.setattr(mending, "match_extremities", lambda *_: [])
    assert [c.name for c in repaired(good, bad, lag=gap + 0.01)] == ["0", "1"]
    assert rounds.count((True, True, 1)) == 1
    first, second = repaired(good, bad, lag=gap - 0.01)
    assert (first.name, second.name) == ("0", "1")
    assert (True, True, 0) in rounds
    assert (True, True, 1) not in rounds
    assert second.deformation_energy == first.deformation_energy  # the worst of one
    assert second.score < first.score - 1
    # What was as good before is not given up.
    repaired(good, replace(bad, quality=good.quality), lag=gap - 0.01)
    assert (True, True, 1) in rounds
    assert (False, True, 1) in rounds


def test_pairings_are_heard_once():
    def pairing(*pairs):
        return ExtremityMatch(*np.array(pairs).T)

    whole = pairing((0, 0), (1, 1), (2, 2), (3, 3))
    part, other = pairing((0, 0), (1, 1), (2, 2)), pairing((0, 0), (1, 2), (2, 1))
    third = pairing((0, 4), (1, 1), (2, 2))
    # Of the first the whole is begun with, though a part of it is likelier: there is less to differ.
    assert unused_matches([part, whole, other, third], [], 3) == [whole, other, third]
    assert unused_matches([part, whole, other, third], [], 2) == [whole, other]
    assert unused_matches([part, other], [], 2) == [part, other]
    assert complete_match(part, [other, third]) is part
    assert complete_match(whole, [part, whole]) is whole
    assert unused_matches([part, other, third], [whole], 3) == [other, third]
    assert unused_matches([whole], [part], 1) == [whole]
    assert part.contradicts(third)
    assert part.contradicts(pairing((5, 0)))  # by the target's tip alone
    assert not part.contradicts(pairing((5, 5)))
    assert not whole.contradicts(part)


def test_what_goes_astray_stays_as_it_was(creatures, monkeypatch):
    """As the right map of a body that touches itself."""
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    ranked = [replace(c, deformation_energy=1.0) for c in score_maps([Start("truth", C)], on)]
    astray = alternate.AlternatingResult(
        np.linalg.qr(np.random.default_rng(0).normal(size=C.shape))[0], target.mesh.vertices
    )
    monkeypatch.setattr(mending, "alternating_registration", lambda *_rest: iter([astray]))
    monkeypatch.setattr(mending, "match_extremities", lambda *_: [])
    nowhere = np.zeros((0, 2), dtype=np.int64)
    (found,), retries = refine_by_registration(ranked, on, ProxyCache.of(source, target, on), nowhere)
    assert found.functional_map is ranked[0].functional_map
    assert found.registered_vertices is None
    (way,) = retries
    assert isinstance(way, mending.SwappedRepair)
    made = way.make()
    assert made is not None
    assert not made.swapped
    # Looked at as closely as what it is compared with.
    assert found.deformation_energy is not None
    assert found.deformation_energy < 0.5
    assert found.strain is not None


def test_what_goes_astray_one_way_is_mended_the_other(creatures, monkeypatch):
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    rough = C + 0.02 * np.random.default_rng(1).normal(size=C.shape)
    ranked = [replace(c, deformation_energy=1.0) for c in score_maps([Start("rough", rough)], on)]
    astray = np.linalg.qr(np.random.default_rng(0).normal(size=C.shape))[0]

    def made(_C, where, *_rest):
        yield alternate.AlternatingResult(astray if where.source is target else C, where.source.mesh.vertices)

    monkeypatch.setattr(mending, "alternating_registration", made)
    monkeypatch.setattr(mending, "match_extremities", lambda *_: [])
    nowhere = np.zeros((0, 2), dtype=np.int64)
    (found,) = refine_by_registration(ranked, on, ProxyCache.of(source, target, on), nowhere)[0]
    np.testing.assert_array_equal(found.functional_map, C)
    assert not found.swapped
    assert found.registered_vertices is source.mesh.vertices


def on_a_line(*places: float) -> Any:
    """A probe of which only positions are asked for: sample i lies at the i-th place."""
    return SimpleNamespace(positions=np.array([[x, 0.0, 0.0] for x in places]))


def test_what_is_not_mended_stays_and_stays_once():
    """Also where a second look has put the second far behind the third."""
    judgement = Quality(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    one = Candidate("a", np.eye(2), np.zeros(3, dtype=int), judgement, deformation_energy=0.15)
    ranked = [
        replace(one, name=name, strain=-s / SCORE.w_strain, points=np.full(3, i))
        for i, (name, s) in enumerate(zip("abcd", (-1.0, -9.0, -4.0, -4.5), strict=True))
    ]
    near, rest = repairable(ranked, on_a_line(0.0, 1.0, 2.0, 3.0))
    assert [c.name for c in near] == ["a", "c"]
    assert [c.name for c in rest] == ["b", "d"]


def test_the_first_few_are_mended_and_those_that_differ():
    """However many hardly differ from the first, a rival is mended too."""
    judgement = Quality(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    ranked = [Candidate(n, np.eye(2), np.full(3, i), judgement) for i, n in enumerate("abcdefg")]
    near, rest = repairable(ranked, on_a_line(0.0, 0.05, -0.05, 0.06, 1.0, 1.5, 2.0))
    assert [c.name for c in near] == ["a", "b", "e", "f"]
    assert [c.name for c in rest] == ["c", "d", "g"]


def test_a_map_that_hardly_differs_comes_first_where_it_bends_less(creatures):
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200))).fine
    torn = truth.copy()
    high = np.argsort(target.mesh.vertices[:, 0])[-len(torn) // 6 :]
    torn[high] = np.random.default_rng(0).permutation(torn[high])
    bases = source.basis.truncate(40), target.basis.truncate(40)
    maps = [np.asarray(to_functional(points, *bases)) for points in (torn, truth)]
    bad, good = score_maps([Start("torn", maps[0]), Start("truth", maps[1])], on)
    # All else says as much for either, and a little more for the torn one.
    good = replace(good, quality=replace(bad.quality, distortion=bad.quality.distortion + 0.01))
    of = ProxyCache.of(source, target, on)
    ranked = ranking.ranking([bad], on, of)
    found = rerank_near_duplicates(ranked, [bad, good], on, of)
    assert [c.name for c in found] == ["truth", "torn"]
    assert found[1] is ranked[0]
    assert found[0].deformation_energy is not None
    assert ranked[0].deformation_energy is not None
    assert found[0].deformation_energy < ranked[0].deformation_energy
    assert rerank_near_duplicates(ranked, [bad], on, of) == ranked
    # Not where it is too far behind before that.
    far = replace(good, quality=replace(good.quality, distortion=good.quality.distortion + 0.2))
    assert {c.name for c in rerank_near_duplicates(ranked, [bad, far], on, of)} == {"truth", "torn"}
    assert rerank_near_duplicates(ranked, [bad, far], on, of, behind=1.0) == ranked


def test_a_map_deforms_too_much_or_not():
    one = Candidate("a", np.eye(2), np.zeros(3, dtype=int), Quality(0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    usual = np.exp(
        SCORE.calibration.usual_log_deformation + SCORE.calibration.log_deformation_per_score * one.quality.score
    )
    assert deforms_too_much(replace(one, deformation_energy=usual * np.exp(SCORE.excess_deformation + 0.01)))
    assert not deforms_too_much(replace(one, deformation_energy=usual * np.exp(SCORE.excess_deformation - 0.01)))
    assert not deforms_too_much(one)


def test_of_maps_that_are_alike_the_one_that_bends_less_is_found(creatures, monkeypatch):
    """And none of them is taken for a rival of the other."""
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source), sample_for_scoring(target)))
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    best = score_maps([Start("best", C)], on.fine)[0]
    few = np.where(np.arange(len(best.points)) < len(best.points) // 20, best.points[::-1], best.points)
    worse = replace(best.quality, distortion=best.quality.distortion + 0.05)
    alike = replace(best, name="alike", points=few, quality=worse, functional_map=C.copy())
    assert SCORE.duplicate_distance < map_distance(best, alike, on.fine.source) < SCORE.distinct_distance
    bends = {"best": 0.12, "alike": 0.06}
    monkeypatch.setattr(choose, "candidates", lambda *_what, **_how: [best, alike])
    monkeypatch.setattr(
        ranking,
        "with_deformation_energy",
        lambda some, *_: [replace(c, deformation_energy=bends[c.name]) for c in some],
    )
    config = replace(kfmaps.Config(), threads=1)
    assert config.search is not None
    preserving = replace(config, search=replace(config.search, orientation="preserving"))
    found = choose.search_map(source, target, preserving)
    assert found.initialization == "alike"
    assert len(found.scores) == 1


def test_the_match_that_is_worth_more_is_taken(creatures):
    """Of two that both have a fit, by score and torn area together; the one taken tells the seconds of the whole."""
    source, target, truth = creatures
    one = finish.match_from_map(source, target, finish.KnownMap(truth, "a", quality=-9.0))
    assert one.registration.report is not None

    def made(score, share):
        order = np.cumsum(vertex_areas(target.mesh)) <= share * vertex_areas(target.mesh).sum()
        trust = np.where(order, 0.4, 0.9)
        judged = replace(one.score, scores=(score,))
        return replace(one, score=judged, local_confidence=trust, seconds={}, verdict=f"{share}")

    known = replace(made(-9.0, 0.3), seconds=one.seconds)
    for lost, taken in ((0.1 * SCORE.w_torn, 0.1), (0.3 * SCORE.w_torn, 0.3), (-1.0, 0.1)):
        found = better_match(known, made(-9.0 - lost, 0.1))
        assert found.verdict == f"{taken}"
        assert found.seconds is one.seconds
    refused = replace(made(-9.0, 0.1), precise_map=None)
    assert better_match(known, refused).verdict == "0.1"
    assert better_match(known, replace(refused, registration=MatchRegistration())) is known


def test_a_match_finishes_all_ways_unless_it_is_hardly_torn(creatures, monkeypatch):
    source, target, truth = creatures
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    other = SearchResult(C, "other", None, "unlikely", quality=-9.0, scores=(-9.0,))
    asked = []
    ways: Any = (replace(other, registered_vertices=target.mesh.vertices, swapped=True), other, None)
    monkeypatch.setattr(matching, "retry", lambda found, i, least: asked.append(least) or found.retries[i])
    monkeypatch.setattr(matching, "search_map", lambda *_a, **_k: replace(other, initialization="one", retries=ways))
    monkeypatch.setattr(matching, "better_match", lambda a, b: replace(b, seconds=a.seconds))
    config = replace(kfmaps.Config(), registration=None)
    for share, ends in ((0.5, "other"), (SCORE.max_torn_area, "one"), (None, "one")):
        for module in (matching, finish):
            monkeypatch.setattr(module, "torn_area_fraction", lambda _match, share=share: share)
        found = kfmaps.match(source, target, config)
        assert found.score.initialization == ends
        assert [f"another way, {i}" in found.seconds for i in (1, 2)] == 2 * [ends == "other"]
    assert asked == 3 * [-9.0 - 0.5 * SCORE.w_torn]


def test_a_search_tells_what_else_may_turn_out_better(creatures, monkeypatch):
    """Each where its score is above what is known; the alternatives of each differ from it."""
    source, target, _ = creatures
    judgement = Quality(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    one = Candidate("0", np.eye(5), np.zeros(2000, dtype=int), judgement, deformation_energy=0.15)
    ranked = [replace(one, name=str(i), points=np.full(2000, i), strain=i / SCORE.w_strain) for i in range(5)]
    twin = replace(one, name="twin", strain=0.5 / SCORE.w_strain)
    setting: Any = None
    astray = mending.SwappedRepair(mending.Repair(setting, twin, None), (0.0, 0.0))
    monkeypatch.setattr(mending.SwappedRepair, "make", lambda _self: None)
    monkeypatch.setattr(choose, "SCORE", replace(SCORE, repair_score=np.inf))
    monkeypatch.setattr(choose, "refine_by_registration", lambda *_: (ranked, (ranked[2], twin, astray)))
    monkeypatch.setattr(choose, "rerank_near_duplicates", lambda *_: ranked)
    monkeypatch.setattr(search_result, "alternative_maps", lambda maps, *_: tuple(range(len(maps))))
    monkeypatch.setattr(choose, "map_distance", lambda a, b, _: float(a.points[0] != b.points[0]))
    found = choose.search_map(source, target, kfmaps.Config())
    made = [choose.retry(found, i, -np.inf) for i in range(3)]
    best = [c.score for c in ranked]
    assert [m and (m.initialization, m.scores[:2]) for m in (found, *made)] == [
        ("0", (best[0], best[1])),
        ("2", (best[2], best[0])),
        ("twin", (twin.score, best[1])),
        None,
    ]
    assert [choose.retry(found, i, best[1]) and "more" for i in range(3)] == [None, "more", None]


def test_where_the_target_lies_leads_as_well(creatures):
    """Of a map found backwards the target is bent: what lies on each other is the same."""
    source, target, _ = creatures
    found = SearchResult(np.eye(5), "a", None, "unlikely", registered_vertices=target.mesh.vertices + 1.0, swapped=True)
    led = matching._search_guidance(found, (source, target))
    alone = matching._search_guidance(replace(found, registered_vertices=None), (source, target))
    assert led is not None
    assert alone is not None
    lie = position_normal_guidance(source.mesh, Mesh(target.mesh.vertices + 1.0, target.mesh.faces))
    np.testing.assert_allclose(led.source, np.hstack([alone.source, np.sqrt(alternate.WEIGHT) * lie.source]))
    np.testing.assert_allclose(led.target, np.hstack([alone.target, np.sqrt(alternate.WEIGHT) * lie.target]))


def test_a_map_is_registered_on_proxies_either_way(creatures, monkeypatch):
    """The vertices are those of the side that is registered; descriptors stay on their side."""
    source, target, truth = creatures
    C = np.asarray(to_functional(truth, source.basis.truncate(40), target.basis.truncate(40)))
    pair = both(source, target)
    led = DescriptorGuidance(source.mesh.vertices, target.mesh.vertices)
    asked = []
    usual = mending.alternating_registration

    def told(C, pair, guidance, landmarks):
        asked.append((pair.source, guidance.source, guidance.target))
        return usual(C, pair, guidance, landmarks)

    monkeypatch.setattr(mending, "alternating_registration", told)
    for swapped, moved, other in ((True, target, source), (False, source, target)):
        *_, found = mending.register_map_on_proxies(C, pair, led, NO_LANDMARKS, swapped)
        assert found is not None
        assert error(found.functional_map, source, target, truth) < 0.05
        assert found.registered_vertices.shape == moved.mesh.vertices.shape
        shape, own, theirs = asked.pop()
        assert shape is moved
        assert own is moved.mesh.vertices
        assert theirs is other.mesh.vertices

    def falls_apart(*_what):
        yield alternate.AlternatingResult(C, source.mesh.vertices)
        raise NotConverged("it fell apart")

    monkeypatch.setattr(mending, "alternating_registration", falls_apart)
    assert [one is None for one in mending.register_map_on_proxies(C, pair, led, NO_LANDMARKS)] == [False, True]


def test_what_deforms_too_much_is_repaired_before_it_is_compared_with_mirror_images(creatures, monkeypatch):
    """The repaired map stays where it is better, and where no proxy can be registered all stays as it is."""
    source, target, truth = creatures
    on = two_level_samples(source, target, (sample_for_scoring(source, 200), sample_for_scoring(target, 200)))
    torn = truth.copy()
    high = np.argsort(target.mesh.vertices[:, 0])[-len(torn) // 4 :]
    torn[high] = np.random.default_rng(0).permutation(torn[high])
    maps = [
        np.asarray(to_functional(points, source.basis.truncate(40), target.basis.truncate(40)))
        for points in (torn, truth)
    ]
    copies = ProxyCache.of(source, target, on.fine)
    found = ranking.with_deformation_energy(
        score_maps([Start("torn", maps[0]), Start("right", maps[1])], on.fine), copies
    )
    marks, wrong = np.zeros((0, 2), dtype=np.int64), np.zeros(0, dtype=bool)
    config = replace(kfmaps.Config(), threads=1)
    torn_first = SearchState(source, target, config, marks, None, wrong, on, copies, found, found, "preserving")
    best, second = choose._repair_best(torn_first).ranked
    assert best.score > found[0].score
    before, after = found[0].deformation_energy, best.deformation_energy
    assert before is not None
    assert after is not None
    assert after < before
    assert second is found[1]
    compared = []
    monkeypatch.setattr(choose, "choose_orientation", lambda state, too_much: compared.append(too_much) or state)
    for too_much in (False, True):
        monkeypatch.setattr(choose, "deforms_too_much", lambda _best, too_much=too_much: too_much)
        ranked = choose._rank(replace(torn_first, candidates=found[:1])).ranked
        assert (ranked[0].score > found[0].score) == too_much
    assert compared == [False, True]
    monkeypatch.setattr(choose, "register_map_on_proxies", lambda *_what: iter([None]))
    assert choose._repair_best(torn_first) is torn_first
    flat = replace(torn_first, proxies=ProxyCache(source, target, (None, None)))
    assert choose._repair_best(flat) is flat
