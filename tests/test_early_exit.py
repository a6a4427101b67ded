"""Where diagonal maps have led to a good one, fits, tips and kicks are left out, but never what it is mistaken for."""

from dataclasses import replace

import numpy as np
import pytest

from kfmaps import datasets
from kfmaps.fmap.convert import to_points
from kfmaps.matching import candidates as found_by
from kfmaps.matching import search, search_result
from kfmaps.matching.candidates import candidates, has_clear_map
from kfmaps.matching.quality import sample_for_scoring
from kfmaps.matching.sample_pair import two_level_samples
from kfmaps.matching.score import SCORE, Candidate, Quality
from kfmaps.matching.search_result import alternative_maps
from kfmaps.shape import prepare
from test_search import SMALL

GUARDS = ("kfmaps.matching.candidates", "kfmaps.matching.sample_pair", "kfmaps.matching.search")

NONE = np.zeros((0, 2), dtype=np.int64)


@pytest.fixture(scope="module")
def pair():
    made = datasets.symmetric_creature(1500, rng=1)
    return prepare(made.source, SMALL, name="source"), prepare(made.target, SMALL, name="target"), made.truth


@pytest.fixture(scope="module")
def on(pair):
    return two_level_samples(pair[0], pair[1], (sample_for_scoring(pair[0]), sample_for_scoring(pair[1])))


def names(monkeypatch, pair, on, easy, landmarks=NONE, descriptors=None):
    """Kinds of rough maps that are tried, weights of the signs, and how many are refined further."""
    tried, finalists = [], []

    def rough(starts, *rest):
        tried.extend(start.name.split()[0] for start in starts)
        tried.extend(start.weights[0] for start in starts if start.name.startswith("signs"))
        return original(starts[::5], *rest)

    def fine(few, *_rest):
        finalists.append(len(few))
        return few

    original = found_by.refine_coarse
    with monkeypatch.context() as patch:
        patch.setattr(found_by, "SCORE", replace(SCORE, early_exit_score=easy))
        patch.setattr(found_by, "refine_coarse", rough)
        patch.setattr(found_by, "refine_fine", fine)
        candidates(pair[0], pair[1], SMALL, on, 0, landmarks=landmarks, descriptors=descriptors)
    return set(tried), finalists[0]


def test_a_clear_map_is_compared_with_near_symmetries_alone(monkeypatch, pair, on):
    tried, finalists = names(monkeypatch, pair, on, -np.inf)
    assert tried == {"signs", "self-map", 0.0, 12.0}
    assert finalists <= found_by._N_CLEAR_FINALISTS
    tried, finalists = names(monkeypatch, pair, on, np.inf)
    assert {"signs", "self-map", "perturbed", 0.0, 4.0, 12.0} < tried
    assert finalists > found_by._N_CLEAR_FINALISTS


def test_what_the_user_says_is_heard(monkeypatch, pair, on):
    given = np.random.default_rng(0).normal(size=(len(pair[0].mesh.vertices), 2))
    there = np.random.default_rng(1).normal(size=(len(pair[1].mesh.vertices), 2))
    assert "perturbed" in names(monkeypatch, pair, on, -np.inf, descriptors=(given, there))[0]
    marks = np.stack([pair[2][:2], np.arange(2)], axis=1)
    both = sample_for_scoring(pair[0], landmarks=marks[:, 0]), sample_for_scoring(pair[1], landmarks=marks[:, 1])
    led = two_level_samples(pair[0], pair[1], both, marks)
    assert "perturbed" in names(monkeypatch, pair, led, -np.inf, landmarks=marks)[0]


def test_rivals_make_nothing_clear():
    def of(distortion, guided):
        quality = Quality(1.0, distortion, 0.0, 0.0, 0.0, 1.0, 0.0)
        return Candidate("", np.eye(2), np.zeros(1, dtype=np.int64), quality, guided)

    assert not has_clear_map([])
    assert has_clear_map([of(1.0, True)])
    assert not has_clear_map([of(1.0, False), of(2.0, True)])  # 2 - 6 · 2 is below


@pytest.mark.parametrize(
    ("distortion", "guided", "errors", "settled"),
    [
        (1.0, True, [0.0, 0.12], True),
        (1.0, True, [], True),
        (2.0, True, [0.0, 0.0], False),  # 1 - 6 · 2 is below
        (1.0, False, [0.0, 0.0], False),
        (1.0, True, [0.0, 0.121], False),
    ],
)
def test_landmarks_that_a_clear_map_keeps_to_begin_no_other_maps(
    monkeypatch, pair, distortion, guided, errors, settled
):
    quality = Quality(1.0, distortion, 0.0, 0.0, 0.0, 1.0, 0.0)
    best = Candidate("", np.eye(2), np.zeros(1, dtype=np.int64), quality, guided, np.array(errors))
    asked = []

    class Ranked(Exception):
        pass

    def rank(_state):
        raise Ranked

    monkeypatch.setattr(search, "candidates_without_landmarks", lambda *_, **__: [best])
    monkeypatch.setattr(search, "score_maps", lambda found, _pair: found)
    monkeypatch.setattr(search, "rerefine", lambda found, _pair: found)
    monkeypatch.setattr(search, "candidates", lambda *_, **__: asked.append(True) or [])
    monkeypatch.setattr(search, "_rank", rank)
    with pytest.raises(Ranked):
        search.search_map(pair[0], pair[1], SMALL, landmarks=np.stack([pair[2][:2], np.arange(2)], axis=1))
    assert bool(asked) != settled


def test_maps_passed_over_of_large_shapes_name_few_vertices(monkeypatch, pair):
    source, target, truth = pair
    k = 30
    C = np.linalg.lstsq(target.basis.functions[:, :k], source.basis.functions[truth, :k], rcond=None)[0]
    whole = to_points(C, source.basis, target.basis)
    np.testing.assert_array_equal(alternative_maps([C], source.basis, target.basis)[0], whole)
    monkeypatch.setattr(search_result, "MAX_CANDIDATES", 500)
    few = alternative_maps([C], source.basis, target.basis)[0]
    assert len(np.unique(few)) <= 500
    off = np.linalg.norm(source.mesh.vertices[few] - source.mesh.vertices[whole], axis=1)
    assert 0 < off.mean() < 2 / np.sqrt(500)
