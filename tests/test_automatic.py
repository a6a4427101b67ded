"""Matching without landmarks: the measures of a map, the choice, and when it says that it is unsure."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from conftest import SMALL, blob, cloud_of, fibonacci_sphere
from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps.config import Search
from kfmaps.descriptors.shot import shot
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.descriptor_guidance import FLAT, descriptor_variance
from kfmaps.geometry.mesh import Mesh
from kfmaps.matching import finish
from kfmaps.matching.candidates import candidates
from kfmaps.matching.initial_maps import plan_fits
from kfmaps.matching.match import match
from kfmaps.matching.quality import ShortDistances, map_quality, sample_for_scoring, subsample
from kfmaps.matching.ranking import distinct_candidates
from kfmaps.matching.sample_pair import two_level_samples
from kfmaps.matching.score import Candidate
from kfmaps.matching.search import search_map
from kfmaps.shape import mirror_image, prepare

GUARDS = ("kfmaps.descriptors.shot", "kfmaps.fmap.descriptor_guidance", "kfmaps.matching", "kfmaps.shape")

BLOBS = SMALL, 700, 650


def test_the_identity_is_a_perfect_map(shape):
    judge = sample_for_scoring(shape, 300)
    found = map_quality(np.eye(60), judge, judge)
    assert found.orientation == pytest.approx(1.0, abs=1e-2)
    assert found.coverage == pytest.approx(1.0)
    zeros = (found.distortion, found.local_distortion, found.descriptors, found.heat, found.laplacian)
    assert zeros == pytest.approx((0,) * 5)


def test_the_map_to_the_mirror_image_reverses_orientation_and_nothing_else(shape):
    here, there = sample_for_scoring(shape, 300), sample_for_scoring(mirror_image(shape), 300)
    found = map_quality(np.eye(60), here, there)
    assert found.orientation == pytest.approx(-1.0, abs=1e-2)
    assert found.distortion == pytest.approx(0)
    assert found.descriptors > 0.02
    assert found.score < map_quality(np.eye(60), here, here).score - 1.5


def test_a_torn_map_has_more_local_distortion_than_a_noisy_one(shape):
    """Half of the shape turned over: few pairs of neighbours change, those at the tear by much."""
    judge = sample_for_scoring(shape, 300)
    places = judge.positions
    torn = places * np.where(places[:, :1] > 0, 1.0, -1.0) ** np.array([0, 1, 1])
    C = shape.basis.truncate(60).project(shape.basis.functions[:, :60])
    whole = map_quality(C, judge, judge)
    flipped = nearest(places, torn)
    phi = judge.samples.basis.functions[:, :60]
    broken = map_quality(np.linalg.lstsq(phi, phi[flipped], rcond=None)[0], judge, judge)
    assert broken.local_distortion > whole.local_distortion + 0.1


def test_local_distortion_counts_short_distances_alone():
    distances = np.abs(np.subtract.outer(*[np.array([0.0, 0.1, 0.2, 1.0, 1.1])] * 2))
    short = distances <= 0.2
    near = ShortDistances.of(distances)
    assert near.relative_change(np.where(short, 0.0, 5.0)) == 0
    assert near.relative_change(np.where(short, distances / 2, 0.0)) == pytest.approx(0.5)


def test_quality_is_what_its_definition_says(shape, other):
    sides: Any = [subsample(sample_for_scoring(one, 300), 200) for one in (shape, other)]
    here, there = sides
    C = np.linalg.qr(np.eye(40) + 0.05 * np.random.default_rng(2).normal(size=(40, 40)))[0]
    found = map_quality(C, here, there)
    images, rows = here.samples.basis.functions[:, :40] @ C.T, there.samples.basis.functions[:, :40]
    back, forth = nearest(rows, images), nearest(images, rows)
    squares = [
        ((a[np.arange(200)] - b[at]) ** 2).sum(axis=1) @ mass
        for a, b, at, mass in (
            (there.descriptors, here.descriptors, back, there.samples.basis.mass),
            (here.descriptors, there.descriptors, forth, here.samples.basis.mass),
        )
    ]
    both = max(descriptor_variance(here.descriptors) + descriptor_variance(there.descriptors), 2 * FLAT)
    assert found.descriptors == pytest.approx(np.mean(squares) / both, rel=1e-4)
    at_ends = []
    for a, b, at, side in (
        (there.descriptors, here.descriptors, back, there),
        (here.descriptors, there.descriptors, forth, here),
    ):
        near = (side.extremities.distances * side.extremities.unit).min(axis=0) < 0.3
        assert 0 < near.sum() < 200
        apart = ((a - b[at]) ** 2).sum(axis=1)
        at_ends.append(np.average(apart[near], weights=side.samples.basis.mass[near]))
    assert found.extremity_descriptor_error == pytest.approx(np.mean(at_ends) / both, rel=1e-4)
    without = (
        replace(here, extremities=here.extremities.removed()),
        replace(there, extremities=there.extremities.removed()),
    )
    assert map_quality(C, *without).extremity_descriptor_error == 0.0
    first_back, first_forth = nearest(rows[:100], images[:100]), nearest(images[:100], rows[:100])
    change = np.abs(here.distances[np.ix_(first_back, first_back)] - there.distances).mean()
    change += np.abs(there.distances[np.ix_(first_forth, first_forth)] - here.distances).mean()
    assert found.distortion == pytest.approx(change / (here.distances.mean() + there.distances.mean()), rel=1e-6)


def test_a_subsample_is_a_sample(shape):
    judge = sample_for_scoring(shape, 300)
    few = subsample(judge, 120)
    np.testing.assert_array_equal(few.samples.vertices, judge.samples.vertices[:120])
    assert few.samples.basis.mass.sum() == pytest.approx(judge.samples.basis.mass.sum())
    assert few.samples.basis.mass.min() > 0
    assert few.distances.shape == (60, 60)
    assert subsample(judge, 300) is judge


def test_mirror_image_equals_preparing_the_mirrored_mesh(shape):
    image: Any = mirror_image(shape)
    np.testing.assert_allclose(image.shot, shot(image.mesh, 0.15), atol=1e-5)
    with pytest.raises(InvalidInput, match="mirrored"):
        mirror_image(replace(shape, mesh=cloud_of(shape.mesh)))


@pytest.fixture(scope="module")
def found(shape, other):
    return match(shape, other, SMALL)


def test_an_asymmetric_shape_is_matched_and_sure(shape, other, found):
    moved = shape.mesh.vertices[found.target_to_source] - other.mesh.vertices
    assert np.linalg.norm(moved, axis=1).mean() < 0.03
    assert (found.verdict, found.orientation) == ("sure", "preserving")
    assert found.confidence > 0.6
    assert list(found.score.scores[1:]) == sorted(found.score.scores[1:], reverse=True)
    assert len(found.alternatives) == len(found.score.scores) - 1
    assert found.config is SMALL
    assert (found.fit.raw_target_to_source, found.fit.status) == (None, None)  # a search has no fit of its own
    assert found.score.initialization.startswith(("signs", "SHOT", "extremities", "self-map"))


def test_a_match_is_the_same_again_and_with_an_empty_list_of_landmarks(shape, other, found):
    again = match(shape, other, SMALL, landmarks=[])
    np.testing.assert_array_equal(again.target_to_source, found.target_to_source)
    assert (again.score.initialization, again.score.scores) == (found.score.initialization, found.score.scores)
    assert again.verdict == found.verdict


def test_a_map_of_which_half_is_torn_is_half_as_likely(shape, other, found, monkeypatch):
    monkeypatch.setattr(finish, "low_confidence_area", lambda *_: 0.5)
    torn = match(shape, other, SMALL)
    assert torn.confidence == pytest.approx(0.5 * found.confidence, rel=1e-6)
    assert torn.verdict == "unlikely"
    assert match(shape, other, replace(SMALL, registration=None)).verdict == "sure"


@pytest.fixture(scope="module")
def sphere():
    return prepare(fibonacci_sphere(650, 0.4), SMALL)


def test_a_sphere_is_ambiguous(sphere):
    found = match(prepare(fibonacci_sphere(700), SMALL), sphere, SMALL)
    assert found.verdict == "ambiguous"
    assert found.alternatives


def test_no_map_between_unlike_shapes_is_called_sure(shape, sphere):
    """A body and a sphere: the best of all bad maps may be well ahead of the others."""
    found = match(shape, sphere, SMALL)
    assert found.verdict in ("likely", "ambiguous", "unlikely")
    assert (found.confidence or 1) < 0.6


def test_point_clouds_are_matched_without_orientation(shape):
    points = blob(1200, twist=0.4).vertices
    with pytest.warns(KfmapsWarning, match="no closed surface .* give three landmarks"):
        cloud = prepare(Mesh(points[points[:, 2] < 0.1]), SMALL)  # open
    assert len(cloud.mesh.faces) == 0
    found = search_map(shape, cloud, SMALL)
    assert found.functional_map.ndim == 2
    assert found.verdict in ("ambiguous", "unlikely")
    assert (found.confidence or 1) <= 0.5
    with pytest.raises(InvalidInput, match="point cloud"):
        match(shape, cloud, replace(SMALL, search=Search(orientation="reversing")))


def test_candidates_can_be_traded_for_time():
    assert len(plan_fits(replace(SMALL, search=Search(candidates=3)))) == 3
    assert plan_fits(SMALL, surfaces=False)[0].name.startswith("waves")
    assert plan_fits(replace(SMALL, search=Search(candidates=0))) == []
    names = [fit.name for fit in plan_fits(replace(SMALL, search=Search(candidates=99)))]
    assert len(set(names)) == len(names) > 8


def test_descriptors_of_the_user_take_nothing_away(shape, other):
    """Noise as descriptors: the match is the search all the same, and its map as good."""
    rng = np.random.default_rng(0)
    noise = rng.normal(size=(len(shape.mesh.vertices), 4)), rng.normal(size=(len(other.mesh.vertices), 4))
    small = replace(SMALL, refinement=None, registration=None)
    plain, found = match(shape, other, small), match(shape, other, small, descriptors=noise)
    assert found.verdict == plain.verdict
    assert found.score.quality == pytest.approx(plain.score.quality, abs=0.2)


def test_progress_never_falls_and_ends_at_one(shape, other):
    seen = []
    on = two_level_samples(shape, other, (sample_for_scoring(shape, 200), sample_for_scoring(other, 200)))
    candidates(shape, other, replace(SMALL, threads=1), on, 0, report=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1


def test_distinct_maps_are_told_from_variations(shape):
    judge = sample_for_scoring(shape, 300)
    quality = map_quality(np.eye(60), judge, judge)
    same = np.arange(300)
    shuffled = np.random.default_rng(0).permutation(300)
    found = [
        Candidate("best", np.eye(60), same, quality),
        Candidate("alike", np.eye(60), np.where(same < 5, 5, same), replace(quality, coverage=0.9)),
        Candidate("other", np.eye(60), shuffled, replace(quality, coverage=0.5)),
    ]
    assert [c.name for c in distinct_candidates(found[::-1], judge)] == ["best", "other"]


def test_a_rival_needs_a_clear_margin(shape):
    judge = sample_for_scoring(shape, 300)
    quality = map_quality(np.eye(60), judge, judge)
    shuffled = np.random.default_rng(0).permutation(300)
    rival = Candidate("rival", np.eye(60), np.arange(300), quality, uses_descriptors=False)
    for lag, first in ((0.2, "ours"), (0.5, "rival")):
        ours = Candidate("ours", np.eye(60), shuffled, replace(quality, coverage=quality.coverage - lag))
        assert distinct_candidates([rival, ours], judge)[0].name == first


def test_few_eigenfunctions_are_enough():
    few = replace(SMALL, descriptors=replace(SMALL.descriptors, n_eigenfunctions=40), refinement=None)
    a, b = (prepare(blob(n, twist), few) for n, twist in ((300, 0.0), (280, 0.4)))
    assert len(a.basis.eigenvalues) == 40
    assert match(a, b, few).functional_map.shape == (40, 40)


def test_no_search_without_settings(shape):
    with pytest.raises(InvalidInput, match=r"a search"):
        search_map(shape, shape, replace(SMALL, search=None))
