"""Maps of real surfaces in a collection: judged, composed, and finished from their points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from collecting import CONFIG, registered
from kfmaps._arrays import InvalidInput
from kfmaps.collection.scored_map import ScoredMap, candidate_maps, score_pair_maps
from kfmaps.collection.synchronization import MAX_LOG_ODDS
from kfmaps.config import Search
from kfmaps.matching.finish import KnownMap, match_from_map
from kfmaps.matching.search import scoring_samples
from kfmaps.shape import Shape, mirror_image, prepare

GUARDS = ("kfmaps.collection.paths", "kfmaps.collection.scored_map", "kfmaps.matching.score")

N = 400
LOCAL = replace(CONFIG, search=Search(), descriptors=replace(CONFIG.descriptors, shot=True), threads=1)


@pytest.fixture(scope="module")
def shapes() -> list[Shape]:
    return [prepare(registered(i, N), LOCAL, name=str(i)) for i in range(3)]


def test_the_true_map_has_the_best_score(shapes: list[Shape]) -> None:
    a, b = shapes[:2]
    shape_samples = scoring_samples(a), scoring_samples(b)
    rng = np.random.default_rng(0)
    several = np.arange(N), rng.integers(0, N, N), np.roll(np.arange(N), 5)
    true, random, shifted = score_pair_maps([(points, False) for points in several], (a, b), shape_samples)
    assert true.orientation > 0.8
    assert true.score > max(random.score, shifted.score) + 1
    mirrored = mirror_image(b)
    shape_samples = shape_samples[0], scoring_samples(mirrored)
    turned, back = score_pair_maps([(np.arange(N), back) for back in (False, True)], (a, mirrored), shape_samples)
    assert turned.orientation < 0
    assert (turned.reversed, back.reversed) == (False, True)
    assert back.score == pytest.approx(true.score, abs=0.1)


def test_a_map_that_turns_the_surface_inside_out_has_little_for_it() -> None:
    one = ScoredMap(np.eye(20), 30.0, -0.1, False)
    kept, turned = candidate_maps([one, replace(one, orientation=-0.3)])
    assert (kept.log_odds, turned.log_odds) == (MAX_LOG_ODDS, -MAX_LOG_ODDS)


def test_a_known_map_is_finished(shapes: list[Shape]) -> None:
    a, b = shapes[:2]
    coarse = np.arange(N)
    coarse[:60] = np.roll(coarse[:60], 7)
    known = KnownMap(coarse, "composition", confidence=0.9, verdict="sure", alternatives=(coarse,))
    found = match_from_map(a, b, known, LOCAL)
    assert (found.target_to_source == np.arange(N)).mean() > max((coarse == np.arange(N)).mean(), 0.9)
    assert (found.score.initialization, found.verdict, found.confidence) == ("composition", "sure", 0.9)
    np.testing.assert_array_equal(found.alternatives[0], coarse)
    turned = match_from_map(a, mirror_image(b), KnownMap(np.arange(N), "known", "reversing"), LOCAL)
    assert (turned.target_to_source == np.arange(N)).mean() > 0.9
    with pytest.raises(InvalidInput, match="vertices 0 to 399"):
        match_from_map(a, b, KnownMap(coarse + 1, "known"), LOCAL)
