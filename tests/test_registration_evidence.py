"""How shapes look once they are bent onto each other, and what it counts for."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import kfmaps
from conftest import NO_LANDMARKS, functional_map, inside_out, reordered
from kfmaps._arrays import NotConverged
from kfmaps.datasets import ExamplePair, posed_pair
from kfmaps.datasets.creature import SYMMETRIC, WAVE
from kfmaps.datasets.skeleton import Bend, Body
from kfmaps.fmap.convert import nearest
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.matching import landmark_conflicts, ranking, registration_refine, search, search_result
from kfmaps.matching.candidates import map_distance, score_maps
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.ranking import normalize_errors, reference_values, rerank_close
from kfmaps.matching.registration_refine import refine_by_registration, with_shot_errors
from kfmaps.matching.sample_pair import SamplePair
from kfmaps.matching.score import SCORE, max_landmark_error
from kfmaps.matching.search_result import build_result
from kfmaps.matching.search_state import SearchState
from kfmaps.registration import alternating_registration as alternating_module
from kfmaps.registration import evidence
from kfmaps.registration.alternating_registration import proxy_pair
from kfmaps.registration.evidence import (
    _shot_difference,
    _surface_samples,
    registered_shot_error,
    shape_proxy,
)

GUARDS = ("kfmaps.matching", "kfmaps.registration")


@pytest.fixture(scope="module")
def knees() -> ExamplePair:
    """A creature that is the same on both sides, its feet nearly touching, and at rest."""
    inwards = {
        f"{side} leg": Bend(((0, 0, turn), (0, 0, 0), (0, 0, 0))) for side, turn in (("left", -12), ("right", 12))
    }
    draw = np.random.default_rng(0)
    return posed_pair("knees", Body(SYMMETRIC), {**WAVE, **inwards}, {}, (1500, 1200), draw, mirror=True)


def test_differences_are_squared_and_from_what_lies_nearest(creature_pair, monkeypatch):
    mesh = creature_pair.source.mesh
    monkeypatch.setattr(
        evidence, "shot", lambda _mesh, _radius, at, **_how: np.stack([at, at % 3], axis=1).astype(float)
    )
    here = _surface_samples(mesh)
    at = np.arange(0, len(mesh.vertices), 6)
    np.testing.assert_array_equal(here.descriptors[:, 0], at)
    assert _shot_difference(here, mesh) == 0
    moved = replace(here, descriptors=here.descriptors + np.array([3.0, 4.0]))
    assert _shot_difference(moved, mesh) == pytest.approx(25.0)


def test_the_shot_error_of_a_surface_and_itself_does_not_depend_on_its_vertices(creature_pair):
    mesh = creature_pair.source.mesh
    order = np.random.default_rng(0).permutation(len(mesh.vertices))
    samples = _surface_samples(mesh)
    assert _shot_difference(samples, reordered(mesh, order)) == pytest.approx(0, abs=1e-6)
    assert _shot_difference(samples, Mesh(mesh.vertices * [1.0, 1.0, -1.0], mesh.faces[:, ::-1])) > 0.1


def test_the_sides_of_a_thin_part_are_not_taken_for_each_other(creature_pair):
    """Where two sheets lie close, it is the normals that tell which point lies on which."""
    here, there = (
        _surface_samples(mesh).position_normals
        for mesh in (creature_pair.source.mesh, inside_out(creature_pair.source.mesh))
    )
    np.testing.assert_allclose(np.linalg.norm(here - there, axis=1), 2 * alternating_module._NORMAL_WEIGHT, rtol=1e-6)


def test_a_registration_by_a_wrong_map_has_a_larger_shot_error(creature_pair):
    v = creature_pair.source.mesh.vertices - creature_pair.source.mesh.vertices.mean(axis=0)
    about = nearest(v, v * [-1.0, -1.0, 1.0])
    wrong = functional_map(about[creature_pair.truth], creature_pair.source, creature_pair.target)
    good, bad = (registered_shot_error(C, creature_pair.proxies.coarse) or 0 for C in (creature_pair.C, wrong))
    assert 0 < good < 0.8 * bad


def test_both_directions_count_unless_one_falls_apart(creature_pair, monkeypatch):
    pair = creature_pair.proxies.coarse
    for forth, back, wanted in ((0.1, 0.3, pytest.approx(0.2)), (0.1, None, pytest.approx(0.1)), (None, None, None)):
        output = {True: forth, False: back}
        monkeypatch.setattr(
            evidence, "_registered_shot_error", lambda way, *_rest, output=output: output[way is pair.forth]
        )
        assert registered_shot_error(creature_pair.C, pair) == wanted


def test_a_proxy_that_falls_apart_has_no_shot_error(creature_pair, monkeypatch):
    class Broken:
        def register_vertices(self, *_what):
            raise NotConverged("it fell apart")

    monkeypatch.setattr(evidence, "FIT", Broken())
    assert registered_shot_error(creature_pair.C, creature_pair.proxies.coarse) is None


def test_shot_error_and_strain_count_relative_to_reference_values(creature_pair):
    one = creature_pair.right
    some = [replace(one, strain=s, shot_error=m) for s, m in ((-1.0, 0.2), (-2.0, 0.26), (None, None))]
    usual = (-2.0, 0.2)
    assert reference_values(some, min) == usual
    assert reference_values(some, np.mean) == pytest.approx((-1.5, 0.23))
    assert reference_values(some[2:], min) == (0.0, 0.0)
    lost = [one.score - normalize_errors(c, usual).score for c in some]
    assert lost == pytest.approx([SCORE.w_strain, SCORE.w_shot * 0.06, 0.0])


def test_of_repaired_maps_the_one_with_the_least_shot_error_comes_first(creature_pair, monkeypatch):
    good = replace(creature_pair.right, deformation_energy=1.0)
    turned = np.roll(np.arange(len(good.points)), 50)
    quality = replace(good.quality, distortion=good.quality.distortion - 0.01)
    bad = replace(good, name="bad", points=turned, quality=quality, functional_map=-good.functional_map)

    def stays(*_what):
        raise NotConverged("it fell apart")

    monkeypatch.setattr(registration_refine, "registered_shot_error", lambda *_what: 0.2)
    monkeypatch.setattr(registration_refine, "alternating_registration", stays)
    start = [bad, good], creature_pair.fine, creature_pair.proxies, NO_LANDMARKS
    ranked = refine_by_registration(*start)[0]
    assert [c.name for c in ranked] == ["bad", "truth"]
    made = alternating_module.AlternatingResult(good.functional_map, creature_pair.source.mesh.vertices)
    monkeypatch.setattr(
        registration_refine, "alternating_registration", lambda C, *_what: iter([replace(made, functional_map=C)])
    )
    monkeypatch.setattr(
        registration_refine, "score_maps", lambda starts, *_w: [bad if starts[0].name == "bad" else good]
    )
    monkeypatch.setattr(registration_refine, "score_registered", lambda c, *_what: replace(c, strain=0.0))
    monkeypatch.setattr(
        registration_refine, "registered_shot_error", lambda C, *_what: 0.25 if C is bad.functional_map else 0.2
    )
    found = refine_by_registration(*start)[0]
    assert [c.name for c in found] == ["truth", "bad"]
    assert [c.shot_error for c in found] == pytest.approx([0.0, 0.05])


def test_repairs_that_were_given_up_count_as_the_worst(creature_pair, monkeypatch):
    one = creature_pair.right
    maps = [
        replace(one, name=str(i), points=np.roll(one.points, 50 * i), functional_map=i * np.eye(5)) for i in range(3)
    ]
    ended = {i: replace(c, shot_error=0.1 + 0.2 * i, strain=float(i)) for i, c in enumerate(maps[:2])}
    monkeypatch.setattr(registration_refine, "with_shot_errors", lambda found, *_what: found)
    monkeypatch.setattr(registration_refine, "_run_repairs", lambda *_what: (ended, {2: maps[2]}))
    found = refine_by_registration(maps, creature_pair.fine, creature_pair.proxies, NO_LANDMARKS)[0]
    assert {c.name: c.shot_error for c in found} == pytest.approx({"0": 0.0, "1": 0.2, "2": 0.2})
    assert {c.name: c.strain for c in found} == {"0": 0.0, "1": 1.0, "2": 1.0}


def exchanged(knees, height):
    """The true map, but left for right below a ``height``; the creature is two high."""
    assert knees.mirrored is not None
    return np.where(knees.target.vertices[:, 1] < height, knees.mirrored, knees.truth)


def test_feet_that_touch_are_exchanged_by_another_map(knees):
    """Their images hardly move in space, and yet such a map is neither the same nor one that differs."""
    on: Any = SimpleNamespace(positions=unit_area(knees.source).vertices)
    right: Any = SimpleNamespace(points=knees.truth)
    wrong: Any = SimpleNamespace(points=exchanged(knees, 0.1))
    assert SCORE.duplicate_distance < map_distance(right, wrong, on) < SCORE.distinct_distance


def test_maps_are_alike_that_are_off_by_an_edge_here_and_there(knees):
    """At every tenth point, as where the same map has been found twice: one of them is enough to bend."""
    on: Any = SimpleNamespace(positions=unit_area(knees.source).vertices)
    beside = np.arange(len(on.positions))
    beside[knees.source.faces] = np.roll(knees.source.faces, 1, axis=1)
    points = knees.truth.copy()
    points[::10] = beside[points[::10]]
    right: Any = SimpleNamespace(points=knees.truth)
    off: Any = SimpleNamespace(points=points)
    assert 0 < map_distance(right, off, on) < SCORE.duplicate_distance


def test_shot_errors_decide_where_they_are_computed_but_bring_nothing_back(knees):
    """What they say against a map that exchanges all below the waist is more than the margin below which they are asked
    for, and less than what is hopeless. Exchanged feet alone are worth asking for; and to wait for what is farther
    behind they would have to speak against a map that is wrong everywhere."""
    plain = replace(kfmaps.Config(), descriptors=replace(kfmaps.Config().descriptors, shot=False))
    source, target = (kfmaps.prepare(mesh, plain, name="a") for mesh in (knees.source, knees.target))
    copies: Any = shape_proxy(source), shape_proxy(target)
    on = proxy_pair(source, target, copies)
    maps = (functional_map(exchanged(knees, height), source, target, 60) for height in (0.0, 0.1, 0.7, 3.0))
    seen = [registered_shot_error(C, on) or 0 for C in maps]
    feet, legs, all_of_it = (SCORE.w_shot * (bad - seen[0]) for bad in seen[1:])
    assert feet < SCORE.shot_margin < legs < SCORE.hopeless_margin < all_of_it


@pytest.mark.parametrize(("margin", "again"), [(2.0, False), (0.5, True)])
def test_of_two_that_are_close_shot_errors_decide(creature_pair, monkeypatch, margin, again):
    """And where they are closer still, both are bent again; farther back nobody is looked at."""
    good = creature_pair.right
    quality = replace(good.quality, distortion=good.quality.distortion - margin / 6)
    good = replace(good, deformation_energy=0.15)
    bad = replace(good, name="bad", quality=quality, functional_map=-good.functional_map)
    rest = replace(good, name="rest", quality=replace(quality, distortion=quality.distortion + 9))
    registered = []
    monkeypatch.setattr(
        ranking, "score_registered", lambda c, *_what: registered.append(c.name) or replace(c, strain=0.0)
    )
    monkeypatch.setattr(ranking, "registered_shot_error", lambda C, *_what: 0.25 if C is bad.functional_map else 0.2)
    found = rerank_close([bad, good, rest], creature_pair.proxies)
    assert [c.name for c in found] == ["truth", "bad", "rest"]
    assert [c.shot_error for c in found[:2]] == pytest.approx([0.0, 0.05])
    assert found[0].score - found[1].score == pytest.approx(0.05 * SCORE.w_shot - margin)
    assert found[2] is rest
    assert registered == (["bad", "truth"] if again else [])


def test_shot_errors_are_asked_for_where_two_are_close(creature_pair, monkeypatch):
    one, asked = creature_pair.right, []
    monkeypatch.setattr(ranking, "rerank_close", lambda order, *_rest: asked.append(len(order)) or order)
    monkeypatch.setattr(
        ranking, "with_deformation_energy", lambda near, *_rest: [replace(c, deformation_energy=0.15) for c in near]
    )
    for margin, wanted in ((SCORE.shot_margin + 0.2, 0), (SCORE.shot_margin - 0.2, 1)):
        quality = replace(one.quality, distortion=one.quality.distortion + margin / 6)
        other = replace(one, name="other", quality=quality, points=np.roll(one.points, 50))
        arguments = [one, other], creature_pair.fine, creature_pair.proxies
        first = ranking.ranking(*arguments)[0].score
        assert len(asked) == wanted
        ranking.ranking(*arguments, least=first)
        assert len(asked) == wanted  # not where the first would have to be better
        ranking.ranking(*arguments, least=first - 0.1)
        assert len(asked) == 2 * wanted


@pytest.mark.parametrize(("factor", "registered"), [(1.0, 1), (SCORE.rotation_margin, 2)])
def test_where_margins_count_less_candidates_farther_behind_are_registered(
    creature_pair, monkeypatch, factor, registered
):
    best = score_maps([Start("best", creature_pair.C)], creature_pair.fine)[0]
    away = (best.points + len(best.points) // 2) % len(best.points)
    less = replace(best.quality, heat=best.quality.heat + 4.0 / SCORE.w_heat)
    found = [best, replace(best, name="4 behind", points=away, quality=less)]
    counts = []
    monkeypatch.setattr(ranking, "with_deformation_energy", lambda near, _proxies: counts.append(len(near)) or [])
    monkeypatch.setattr(SamplePair, "margin_factor", factor)
    ranking.ranking(found, creature_pair.fine, creature_pair.proxies)
    assert counts == [registered]


def test_shot_errors_of_candidates_far_behind_are_not_computed(creature_pair):
    one = replace(creature_pair.right, strain=0.0)
    behind = [
        replace(one, strain=s / SCORE.w_strain) for s in (0.0, SCORE.hopeless_margin - 1, SCORE.hopeless_margin + 1)
    ]
    asked = []

    def looked_at(c):
        asked.append(c.strain)
        return replace(c, shot_error=0.2 + 0.1 * c.strain)

    found = with_shot_errors(behind, looked_at)
    assert asked == [c.strain for c in behind[:2]]
    assert [c.strain for c in found] == [c.strain for c in behind]
    worst = 0.2 + 0.1 * (SCORE.hopeless_margin - 1) / SCORE.w_strain
    assert [c.shot_error for c in found] == pytest.approx([0.2, worst, worst])


@pytest.mark.parametrize(
    ("word", "errors", "quality", "orientation", "outcome"),
    [
        ("sure", [0.0, 0.05], -4.0, "preserving", "settled"),
        ("sure", [0.0, 0.051], -4.0, "preserving", "led"),
        ("sure", [0.0, 0.12], -9.0, "preserving", "settled"),
        ("sure", [0.0, 0.121], -9.0, "preserving", "led"),
        ("sure", [0.0, 0.0], -4.0, "reversing", "led"),
        ("likely", [0.0, 0.0], -4.0, "preserving", "led"),
        ("less", [0.0, 0.051], -4.0, "preserving", "as found"),
        ("less", [0.0, 0.121], -4.0, "preserving", "led"),
        ("less", [0.0, 0.3], -9.0, "preserving", "as found"),
        ("less", [0.0, 0.301], -9.0, "preserving", "led"),
    ],
)
def test_landmarks_only_refine_a_sure_map_that_keeps_to_them(
    monkeypatch, creatures, word, errors, quality, orientation, outcome
):
    """``word``: the verdict without landmarks; with "less" a map that landmarks have led to is less sure."""
    source, target, truth = creatures
    landmark_vertices = np.stack([truth[[5, 700]], [5, 700]], axis=1)
    asked, ranked, improved, compared = [], [], [], []

    def few(*what, **how):
        asked.append((what[3], how))
        return score_maps([Start("free" if len(asked) == 1 else "led", np.eye(40))], what[3].fine)

    def rank(state):
        ranked.append(state)
        return replace(state, ranked=state.candidates)

    def made(state, best, rest):
        verdict = word if word != "less" else "sure" if best.name == "free" else "likely"
        fields = {"verdict": verdict, "quality": quality, "orientation": orientation}
        return replace(build_result(state, best, rest), **fields)

    monkeypatch.setattr(search, "build_result", made)
    monkeypatch.setattr(search, "candidates", few)
    monkeypatch.setattr(search, "_rank", rank)
    monkeypatch.setattr(search, "_improve_best", lambda state, _report: improved.append(state) or (state, ()))
    monkeypatch.setattr(search, "SCORE", replace(SCORE, min_unrepaired_score=-np.inf))
    monkeypatch.setattr(
        search, "contradicted_landmarks", lambda state: (np.zeros(2, dtype=bool), ((state.ranked[0], 0.3),))
    )
    monkeypatch.setattr(search, "final_landmark_errors", lambda *_: np.array(errors))

    def contradicted(best, state):
        compared.append((best.name, state))
        return np.zeros(len(state.landmarks), dtype=bool)

    monkeypatch.setattr(search, "contradicted_by", contradicted)
    monkeypatch.setattr(search_result, "contradicted_by", lambda _best, state: np.zeros(len(state.landmarks), bool))
    result = search.search_map(source, target, kfmaps.Config(), landmarks=landmark_vertices)
    samples, how = asked[0]
    assert how.get("landmarks") is None
    for pair in (samples.coarse, samples.fine):
        assert pair.landmark_evidence is None
        assert pair.landmark_cost is None
    assert len(ranked[0].landmarks) == 0
    np.testing.assert_array_equal(result.landmarks, landmark_vertices)
    assert result._search is not None
    assert result._search.samples.fine.landmark_evidence is not None
    assert len(asked) == (1 if outcome == "settled" else 2)
    assert result.initialization == ("led" if outcome == "led" else "free")
    if outcome == "settled":
        return
    keeps = word != "likely" and orientation == "preserving" and max(errors) <= max_landmark_error(quality)
    assert [name for name, _given in compared] == ([] if keeps else ["free"])
    assert len(improved[-1].doubts) == (0 if keeps else 1), "a sure map that keeps to landmarks casts no doubt on them"
    np.testing.assert_array_equal(asked[1][1]["landmarks"], landmark_vertices)
    assert asked[1][0].fine.landmark_cost is not None
    assert [c.name for c in ranked[1].candidates] == ["led", "free"]
    assert [c.landmark_errors.shape for c in ranked[1].without_landmarks] == [(2,)]
    # What no repair could make sure is not repaired before it is searched with landmarks, but it is without any.
    monkeypatch.setattr(search, "SCORE", replace(SCORE, min_unrepaired_score=np.inf))
    for at, count in ((landmark_vertices, 1), (None, 1)):
        improved.clear()
        search.search_map(source, target, kfmaps.Config(), landmarks=at)
        assert len(improved) == count


@pytest.mark.parametrize(
    ("verdict", "gain", "errors", "outcome"),
    [
        ("sure", 1.5, [0.4, 0.4, 0.0], "rejected"),
        ("likely", 1.5, [0.4, 0.4, 0.0], "rejected"),
        ("sure", 1.5, [0.4, 0.4, 0.0], "rejected, nearly the same map"),
        ("sure", 1.5, [0.4, 0.0, 0.0], "followed"),
        ("ambiguous", 1.5, [0.4, 0.4, 0.0], "doubted"),
        ("sure", 0.5, [0.4, 0.4, 0.0], "doubted"),
        ("ambiguous", -0.9, [0.4, 0.4, 0.0], "doubted"),
        ("ambiguous", -1.1, [0.4, 0.4, 0.0], "followed"),
        ("ambiguous", 0.5, [0.4, 0.0, 0.0], "followed"),
        ("ambiguous", 0.5, [0.4, 0.0], "doubted"),
        ("sure", 1.5, [0.4, 0.0], "doubted"),
        ("unlikely", 0.5, [0.4, 0.4, 0.0], "a turn keeps the shapes"),
    ],
)
def test_a_map_without_landmarks_that_contradicts_most_rejects_or_doubts_them(
    monkeypatch, creature_pair, verdict, gain, errors, outcome
):
    """One that is clearly better and likely rejects all; one that is not clearly worse takes their support."""
    pair, right = creature_pair, creature_pair.right
    at = [5, 300, 700][: len(errors)]
    landmarks = np.stack([pair.truth[at], at], axis=1)
    config, nobody = replace(kfmaps.Config(), threads=1), np.zeros(len(at), dtype=bool)
    reflections = (None, None if outcome == "a turn keeps the shapes" else np.eye(5))
    sides = (
        replace(side, reflection_map=C)
        for side, C in zip((pair.fine.source, pair.fine.target), reflections, strict=True)
    )
    fine = replace(pair.fine, **dict(zip(("source", "target"), sides, strict=True)))
    samples = replace(pair.samples, fine=fine)
    quality = replace(right.quality, distortion=right.quality.distortion + gain / SCORE.w_distortion)
    is_same = outcome == "rejected, nearly the same map"
    other = replace(right, name="led", quality=quality, points=np.roll(right.points, 0 if is_same else 1))
    outcome = outcome.partition(",")[0]
    free: Any = SearchState(
        pair.source,
        pair.target,
        config,
        landmarks[:0],
        None,
        nobody[:0],
        samples,
        pair.proxies,
        [],
        [right],
        "preserving",
    )
    given = replace(free, landmarks=landmarks, rejected=nobody)
    found = replace(build_result(free, right, []), verdict=verdict, quality=-9.0)
    monkeypatch.setattr(search, "drop_landmarks", lambda samples, _rejected: samples)

    def landmark_errors(_best, state):
        return np.array(errors)[: len(state.landmarks)]

    for module in (search, landmark_conflicts):
        monkeypatch.setattr(module, "final_landmark_errors", landmark_errors)
    monkeypatch.setattr(search_result, "support_of_landmarks", lambda *_: 0.98)
    # Those that the best map itself contradicts have been rejected by then.
    led = replace(given, ranked=[other], rejected=np.arange(len(at)) == len(at) - 1)
    result: Any = search._compare_with_free(found, led, (right,), given)
    state = result._search
    assert result.initialization == ("truth" if outcome == "rejected" else "led")
    assert state.rejected.all() == (outcome == "rejected")
    assert result.retries == (() if outcome == "rejected" else (right,))
    assert len(result.rejected_landmarks) == (len(at) if outcome == "rejected" else np.greater(errors, 0.3).sum())
    doubts = {"rejected": [] if is_same else [("led", gain)], "doubted": [("truth", -gain)]}
    assert [(c.name, round(margin, 6)) for c, margin in state.doubts] == doubts.get(outcome, [])
    if outcome != "rejected":
        assert (result.verdict == "sure") == (outcome != "doubted")
    assert search._compare_with_free(None, led, (), given).verdict == "sure"


@pytest.mark.parametrize(
    ("shift", "orientation", "misses", "is_kept"),
    [
        (0, "preserving", False, True),
        (1, "preserving", False, False),
        (0, "reversing", False, False),
        (0, "preserving", True, True),
        (1, "preserving", True, False),
    ],
)
def test_a_map_that_landmarks_hardly_change_is_as_probable_as_without_them(
    monkeypatch, creature_pair, shift, orientation, misses, is_kept
):
    pair, right = creature_pair, creature_pair.right
    state: Any = SearchState(
        pair.source,
        pair.target,
        replace(kfmaps.Config(), threads=1),
        np.zeros((0, 2), dtype=int),
        None,
        np.zeros(0, dtype=bool),
        pair.samples,
        pair.proxies,
        [],
        [replace(right, name="led", points=np.roll(right.points, shift))],
        "preserving",
        doubts=((right, 0.1),),
    )
    free = replace(state, ranked=[right], doubts=(), orientation=orientation)
    found = build_result(free, right, [])
    monkeypatch.setattr(search, "contradicted_by", lambda *_: np.array([misses]))
    assert map_distance(right, state.ranked[0], pair.fine.source) > SCORE.twin_distance or shift == 0
    alone = build_result(state, state.ranked[0], [])
    assert alone.verdict == "ambiguous"
    assert found.verdict == "sure"
    result = search._compare_with_free(found, state, (), state)
    assert result.initialization == "led"
    assert result.confidence == (found.confidence if is_kept else pytest.approx(alone.confidence, rel=0.2))
    assert result.verdict == ("sure" if is_kept else "ambiguous")
    # Landmarks that make it more probable count.
    result = search._compare_with_free(replace(found, confidence=0.1, verdict="unlikely"), state, (), state)
    assert result.verdict == "ambiguous"


@pytest.mark.parametrize("rejects", [[True, True], [True, False]])
def test_a_likely_map_that_rejects_all_landmarks_is_not_sought_again(monkeypatch, creatures, rejects):
    source, target, truth = creatures
    landmark_vertices, ranked = np.stack([truth[[5, 700]], [5, 700]], axis=1), []

    def made(state, best, rest):
        return replace(build_result(state, best, rest), verdict="likely", quality=-4.0)

    def few(*what, **_how):
        return score_maps([Start("any", np.eye(40))], what[3].fine)

    monkeypatch.setattr(search, "build_result", made)
    monkeypatch.setattr(search, "candidates", few)
    monkeypatch.setattr(search, "_rank", lambda state: ranked.append(state) or replace(state, ranked=state.candidates))
    monkeypatch.setattr(search, "_improve_best", lambda state, _report: (state, ()))
    monkeypatch.setattr(search, "SCORE", replace(SCORE, min_unrepaired_score=-np.inf))
    monkeypatch.setattr(search, "contradicted_landmarks", lambda _state: (np.array(rejects), ()))
    result = search.search_map(source, target, kfmaps.Config(), landmarks=landmark_vertices)
    assert len(ranked) == (2 if all(rejects) else 3)
    assert result._search is not None
    np.testing.assert_array_equal(result._search.rejected, rejects)


@pytest.mark.parametrize(("word", "doubts"), [("sure", 0), ("likely", 1)])
def test_a_map_that_keeps_to_rejected_landmarks_casts_no_doubt_on_a_sure_one(monkeypatch, creatures, word, doubts):
    source, target, truth = creatures
    landmark_vertices, improved = np.stack([truth[[5, 700]], [5, 700]], axis=1), []
    monkeypatch.setattr(
        search, "build_result", lambda *a: replace(build_result(*a), verdict=word, quality=-4.0, orientation="other")
    )
    monkeypatch.setattr(search, "candidates", lambda *a, **_k: score_maps([Start("any", np.eye(40))], a[3].fine))
    monkeypatch.setattr(search, "_rank", lambda state: replace(state, ranked=state.candidates))
    monkeypatch.setattr(search, "_improve_best", lambda state, _report: improved.append(state) or (state, ()))
    monkeypatch.setattr(search, "SCORE", replace(SCORE, min_unrepaired_score=-np.inf))
    led = np.array([True, False])
    monkeypatch.setattr(search, "contradicted_landmarks", lambda state: (led, ((state.ranked[0], 0.3),)))
    search.search_map(source, target, kfmaps.Config(), landmarks=landmark_vertices)
    assert len(improved[-1].doubts) == doubts
