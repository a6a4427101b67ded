"""The best map with two alike limbs exchanged: what is found by mistake is mended, and what is not is compared."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from kfmaps import datasets
from kfmaps.fmap.convert import to_functional
from kfmaps.matching import search
from kfmaps.matching.candidates import score_maps
from kfmaps.matching.extremity_matching import extremity_difference, match_of_map
from kfmaps.matching.finish import _doubt_exchanged
from kfmaps.matching.initial_maps import Start
from kfmaps.matching.limb_exchange import _MAX_DIFFERENCE, compare_exchanged, exchange_limbs, exchanged_matches
from kfmaps.matching.quality import sample_for_scoring
from kfmaps.matching.ranking import ProxyCache
from kfmaps.matching.sample_pair import two_level_samples
from kfmaps.matching.score import SCORE
from kfmaps.matching.search import search_map
from kfmaps.shape import prepare
from test_search import SMALL

GUARDS = ("kfmaps.matching",)


@pytest.fixture(scope="module")
def made():
    """Two poses of a symmetric creature, their samples, and the true map as a candidate."""
    pair = datasets.symmetric_creature(1500, rng=1)
    source, target = prepare(pair.source, SMALL, name="source"), prepare(pair.target, SMALL, name="target")
    on = two_level_samples(source, target, (sample_for_scoring(source), sample_for_scoring(target))).fine
    bases = source.basis.truncate(40), target.basis.truncate(40)
    C = np.asarray(to_functional(pair.truth, *bases))
    return SimpleNamespace(
        source=source,
        target=target,
        on=on,
        truth=pair.truth,
        right=score_maps([Start("true", C)], on)[0],
        copies=ProxyCache.of(source, target, on),
    )


def wrong_area(one, made):
    """Share of the target's samples that go far from where they should."""
    true = made.source.mesh.vertices[made.truth[made.on.target.samples.vertices]]
    off = np.linalg.norm(made.on.source.positions[one.points] - true, axis=1)
    return float(made.on.target.areas[off > SCORE.moved_distance].sum())


@pytest.fixture(scope="module")
def exchanged(made):
    """The worst of the maps with two limbs exchanged."""
    return max(exchange_limbs(made.right, made.on), key=lambda one: wrong_area(one, made))


def test_alike_extremities_are_exchanged_two_at_a_time(made):
    match = match_of_map(made.right.points, made.on.source, made.on.target)
    assert match is not None
    unlike = extremity_difference(made.on.source, made.on.source)
    assert np.diag(unlike) == pytest.approx(0.0)
    some = exchanged_matches(match, made.on.source)
    assert some
    for one in some:
        i, j = np.flatnonzero(one.source != match.source)
        assert (one.source[i], one.source[j]) == (match.source[j], match.source[i])
        assert np.array_equal(one.target, match.target)
        assert unlike[one.source[i], one.source[j]] <= _MAX_DIFFERENCE


def test_only_the_limbs_are_exchanged(made, exchanged):
    assert wrong_area(made.right, made) < 0.02
    assert 0.05 < wrong_area(exchanged, made) < 0.5
    assert exchanged.score < made.right.score


def test_exchanged_limbs_are_found_out(made, exchanged, monkeypatch):
    """A map with two limbs exchanged is compared with the right one, and loses; the right one keeps its place."""
    monkeypatch.setattr("kfmaps.matching.limb_exchange.SCORE", replace(SCORE, max_behind=99.0))
    for begun in (made.right, exchanged):
        order = compare_exchanged(begun, made.on, made.copies)
        assert len(order) == 2
        assert wrong_area(order[0], made) < 0.03 < wrong_area(order[1], made)
        assert order[0].score > order[1].score + SCORE.close_margin


def test_an_exchange_that_comes_near_casts_doubt(made, exchanged, monkeypatch):
    """On the verdict, and on the local confidence of the limbs alone."""
    plain = search_map(made.source, made.target, SMALL)
    assert plain.doubts == ()

    def searched(margin):
        def near(best):
            worse = replace(best.quality, descriptors=best.quality.descriptors + margin / SCORE.w_descriptors)
            same = {name: getattr(best, name) for name in ("deformation_energy", "strain", "shot_error")}
            return [best, replace(exchanged, quality=worse, **same)]

        monkeypatch.setattr(search, "compare_exchanged", lambda best, *_: near(best))
        return search_map(made.source, made.target, SMALL)

    assert searched(2.6).doubts == ()
    assert searched(1.7).doubts == pytest.approx((1.7,))
    found = searched(0.12)
    assert found.doubts == pytest.approx((0.12,))
    assert (plain.verdict, found.verdict) == ("sure", "ambiguous")
    assert found.scores[0] - found.scores[1] == pytest.approx(0.12)
    trust = np.full(len(made.truth), 0.9)
    doubted = _doubt_exchanged(trust, made.truth, found, made.source.mesh)
    moved = doubted < 0.5
    assert 0.05 < moved.mean() < 0.5
    assert doubted[~moved] == pytest.approx(0.9)
    assert _doubt_exchanged(trust, made.truth, plain, made.source.mesh) == pytest.approx(0.9)
