"""Formulas of a fit and of the search that an answer barely shows when they are wrong: a law for each."""

from __future__ import annotations

from dataclasses import astuple, replace
from typing import Any

import numpy as np
import pytest

from kfmaps._arrays import inner
from kfmaps.config import BasisConfig, Config, DescriptorConfig, NystromConfig, Search
from kfmaps.descriptors.spectral import heat_map, heat_signature
from kfmaps.fmap.convert import to_points
from kfmaps.fmap.terms import operator_term, value
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.kernels.kernels import Gaussian, _squared_distances
from kfmaps.matching.assemble import assemble, orientation_pair, principal_features
from kfmaps.matching.features import Descriptors, Features, _joint_samples, pair_descriptors
from kfmaps.matching.landmark_evidence import _HEAT_TIMES, heat_features
from kfmaps.matching.quality import map_quality, sample_for_scoring
from kfmaps.matching.search import search_map
from kfmaps.shape import mirror_image

GUARDS = ("kfmaps.config", "kfmaps.descriptors.spectral", "kfmaps.fmap.terms", "kfmaps.matching")

K = 20
CONFIG = replace(
    Config.single_fit(),
    basis=BasisConfig(n_eigenfunctions=K),
    descriptors=DescriptorConfig(n_spectral=12, n_eigenfunctions=60, shot=True, shot_radius=0.15),
    refinement=None,
    threads=1,
)
BLOBS = CONFIG, 500, 420
NO_LANDMARKS = np.zeros((0, 2), dtype=np.int64)


# A fit.


@pytest.mark.parametrize(("basis", "descriptors", "stop"), [(20, 60, 40), (70, 60, 40), (20, 60, 80), (20, 60, None)])
def test_a_shape_has_as_many_functions_as_the_most_that_anything_asks_for(basis, descriptors, stop):
    asked = replace(
        CONFIG,
        basis=BasisConfig(n_eigenfunctions=basis),
        descriptors=replace(CONFIG.descriptors, n_eigenfunctions=descriptors),
        refinement=None if stop is None else ZoomOut(stop=stop),
    )
    assert asked.n_eigenfunctions == max(basis, descriptors, stop or 0)


@pytest.mark.parametrize("weight", [0.25, 1.0, 9.0])
def test_shot_counts_as_its_weight_says_in_squared_distances(shape, other, weight):
    """Of two random vertices they are 2 for the spectral descriptors and 2 × the weight for SHOT.

    Columns that are the same everywhere, such as bins that no normal falls into, count among the number of them.
    """
    config = replace(CONFIG.descriptors, shot_weight=weight)
    found = pair_descriptors(shape, other, (shape.basis, other.basis), config, NO_LANDMARKS, None)
    mass = [s.basis.mass / s.basis.mass.sum() / 2 for s in (shape, other)]
    both, area = np.concatenate([found.source, found.target]), np.concatenate(mass)
    output = np.mean(np.ptp(both[:, 12:], axis=0) > 0)
    assert output > 0.2
    for columns, expected in ((slice(None, 12), 2), (slice(12, None), 2 * weight * output)):
        assert area @ _squared_distances(both[:, columns], both[:, columns]) @ area == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("sampling", ["descriptor", "geodesic", "uniform"])
def test_half_of_the_samples_come_from_each_shape(shape, other, sampling):
    settings = NystromConfig(samples=60, sampling=sampling)
    rng = np.random.default_rng(0)
    of = [np.column_stack([np.full(len(s.basis.mass), i), s.mesh.vertices]) for i, s in enumerate((shape, other))]
    marked = Descriptors(of[0], of[1], np.full(4, -1))
    rows = _joint_samples(shape, other, marked, Gaussian(1.0), settings, rng)
    assert np.bincount(rows[:, 0].astype(int)).tolist() == [30, 30]
    few = replace(other, mesh=replace(other.mesh, vertices=other.mesh.vertices[:20], faces=np.zeros((0, 3), int)))
    scarce = replace(marked, target=marked.target[:20])
    rows = _joint_samples(shape, few, scarce, Gaussian(1.0), settings, rng)
    assert np.bincount(rows[:, 0].astype(int)).tolist() == [30, 20]


@pytest.fixture(scope="module")
def strongest(shape) -> Features:
    rng = np.random.default_rng(0)
    features = shape.basis.functions[:, 1:20] @ rng.normal(size=(19, 8))
    return principal_features((shape.basis, shape.basis), Features(features, features, Gaussian(1.0)), 5)


def test_orientation_is_kept_by_the_identity_and_lost_in_the_mirror(shape, strongest):
    """On a mirror image the identity turns each operator round: ½ Σ‖2 Ω‖², of which Σ‖Ω‖² on both is the size."""
    image = mirror_image(shape)
    bases = shape.basis.truncate(K), shape.basis.truncate(K)
    for size in (1.0, 70.0):
        pairs = [orientation_pair((shape, s), (shape, s), bases, strongest, K, size) for s in (shape, image)]
        same, turned = (operator_term(*pair, parity=-1) for pair in pairs)
        assert value(same, np.eye(K)) == pytest.approx(0, abs=1e-9 * size)
        assert value(turned, np.eye(K)) == pytest.approx(size)
        assert value(turned, -np.eye(K)) == pytest.approx(size)
        grams = turned.sides()
        assert sum(np.trace(S) for S in grams) == pytest.approx(size)
        # The value is never negative, whatever the map.
        C = np.random.default_rng(1).normal(size=(K, K))
        assert value(same, C) > 0
        assert inner(C, same.apply(C)) == pytest.approx(2 * value(same, C))


def test_orientation_and_commutativity_weigh_the_same(shape, other):
    bases = shape.basis, other.basis
    config = replace(CONFIG, weights=replace(CONFIG.weights, orientation=1.0))
    used = pair_descriptors(shape, other, bases, config.descriptors, NO_LANDMARKS, None)
    terms: Any = assemble(shape, other, bases, used, config, np.random.default_rng(0)).energy.terms
    sizes = [sum(np.trace(S) for S in terms[name].sides()) for name in ("orientation", "commutativity")]
    assert sizes[0] == pytest.approx(sizes[1])
    assert sizes[0] > 0
    # And the identity of a shape is what both want.
    used = pair_descriptors(shape, shape, (bases[0],) * 2, config.descriptors, NO_LANDMARKS, None)
    terms = assemble(shape, shape, (bases[0],) * 2, used, config, np.random.default_rng(0)).energy.terms
    for name in ("orientation", "commutativity"):
        assert value(terms[name], np.eye(K)) == pytest.approx(0, abs=1e-7 * sizes[1])  # in single precision
        assert terms[name].left.dtype == terms[name].right.dtype == np.float32
    config = replace(config, operator_rtol=0.0)
    terms = assemble(shape, shape, (bases[0],) * 2, used, config, np.random.default_rng(0)).energy.terms
    assert all(terms[name].left.dtype == np.float64 for name in ("orientation", "commutativity"))


def test_a_constant_more_in_the_features_changes_no_principal_direction(shape, other, rng):
    bases = shape.basis, other.basis
    F = [rng.normal(size=(len(b.mass), 6)) * [5, 4, 3, 2, 1, 1] for b in bases]
    found = principal_features(bases, Features(F[0], F[1], Gaussian(1.0)), 4)
    moved = principal_features(bases, Features(F[0] + 100, F[1] + 100, Gaussian(1.0)), 4)
    for a, b in ((found.source, moved.source), (found.target, moved.target)):
        np.testing.assert_allclose(a @ a.T, b @ b.T, atol=1e-6)
    # Left out is the mean by area, of both shapes alike: features that differ between them by a constant keep it.
    middle = [b.mass @ f / b.mass.sum() for b, f in zip(bases, (found.source, found.target), strict=True)]
    np.testing.assert_allclose(middle[0], -middle[1], atol=1e-12)
    # The strongest come first, and they are as strong as the sum of squares over both areas allows.
    gram = sum((f * b.mass[:, None]).T @ f for b, f in zip(bases, (found.source, found.target), strict=True))
    np.testing.assert_allclose(gram, np.diag(np.diag(gram)), atol=1e-9)
    assert (np.diff(np.diag(gram)) < 0).all()


# The search.


def test_the_score_is_the_same_from_either_side(shape, other):
    """An orthogonal map and its inverse pair up the same samples, so that all that compares these must agree."""
    here, there = sample_for_scoring(shape, 300), sample_for_scoring(other, 300)
    C = np.linalg.qr(np.eye(40) + 0.05 * np.random.default_rng(0).normal(size=(40, 40)))[0]
    one, back = map_quality(C, here, there), map_quality(C.T, there, here)
    for measure in ("distortion", "local_distortion", "descriptors", "heat", "coverage"):
        assert getattr(one, measure) == pytest.approx(getattr(back, measure), rel=1e-9)
        assert getattr(one, measure) > 0


def test_points_are_those_of_the_functional_map(shape, other):
    """Told or not: a map that is far from symmetric tells C from its transpose."""
    here, there = sample_for_scoring(shape, 200), sample_for_scoring(other, 200)
    C = np.linalg.qr(np.random.default_rng(0).normal(size=(30, 30)))[0]
    points = to_points(C, here.samples.basis, there.samples.basis)
    assert astuple(map_quality(C, here, there)) == pytest.approx(astuple(map_quality(C, here, there, points)))


def test_coverage_is_that_of_the_direction_that_covers_less(shape):
    judge = sample_for_scoring(shape, 200)
    one_place = map_quality(np.eye(30), judge, judge, np.full(200, 3))
    assert one_place.coverage == pytest.approx(judge.samples.basis.mass[3])
    assert map_quality(np.eye(30), judge, judge).coverage == pytest.approx(1)


def test_heat_around_a_landmark_is_that_of_its_time(shape):
    """Between two landmarks: what is left after twice the time is the heat kernel's, normalised."""
    landmarks = np.array([3, 90])
    found = heat_features(shape.basis, shape.basis, landmarks)
    heat = heat_map(shape.basis, landmarks, np.array(_HEAT_TIMES)).reshape(500, 2, len(_HEAT_TIMES))
    for i, time in enumerate(_HEAT_TIMES):
        own = heat_signature(shape.basis, np.array([time]))[:, 0]
        np.testing.assert_allclose(found[0, :, i], heat[:, 0, i] / np.sqrt(own[3] * own), rtol=1e-8, atol=1e-12)


def test_probability_follows_from_score_deformation_and_margin(shape):
    """The probability of docs/mathematics.md, and the scores: bending counts against them by five times its logarithm.

    Without tips, at which descriptors would count too.
    """
    config = replace(CONFIG, search=Search(candidates=1, n_sign_functions=2, match_extremities=False))
    found: Any = search_map(shape, shape, config)
    assert found.scores[0] == pytest.approx(found.quality - 5 * np.log(found.deformation_energy / 0.15))
    margin = found.scores[0] - found.scores[1]
    excess = np.log(found.deformation_energy) + 3.6 + 0.233 * found.quality
    flat, steep = 1 / (1 + np.exp(-0.92 * (found.quality + 11.8))), 0.9 / (1 + np.exp(-4 * (found.quality + 12.0)))
    right = (1 - 0.5 * np.exp(-margin / 1.4)) * max(flat, steep)
    right /= 1 + np.exp(12.5 * (excess - 0.75))
    assert found.confidence == pytest.approx(right)
    assert (found.verdict == "sure") == (right >= 0.9)
