"""What a learned kernel adds to a search: maps beside all others, and no digit of a map that it cannot better."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from kfmaps import datasets
from kfmaps._arrays import InvalidInput
from kfmaps.config import BasisConfig, Config, DescriptorConfig, Formulation, Search, Weights
from kfmaps.kernels.kernels import Gaussian
from kfmaps.kernels.transformed import Metric, n_kernel_landmarks
from kfmaps.matching.features import pair_descriptors
from kfmaps.matching.fit import fit
from kfmaps.matching.learned_kernel import _in_metric, _transformed_descriptors, drop_learned, learned_candidates
from kfmaps.matching.match import match
from kfmaps.matching.ranking import ProxyCache, merge_alternatives
from kfmaps.matching.sample_pair import two_level_samples
from kfmaps.matching.score import SCORE, Candidate, Quality
from kfmaps.matching.search import scoring_samples, search_map
from kfmaps.shape import prepare

GUARDS = ("kfmaps.matching",)

COUNT = 12 + 352
CONFIG = replace(
    Config.single_fit(),
    basis=BasisConfig(n_eigenfunctions=30),
    descriptors=DescriptorConfig(n_spectral=12, n_eigenfunctions=40, shot=True, shot_radius=0.12),
    search=Search(candidates=1, n_sign_functions=2, match_extremities=False),
    refinement=None,
    registration=None,
    threads=1,
)
NONE = np.zeros((0, 2), dtype=np.int64)


@pytest.fixture(scope="module")
def creature():
    made = datasets.two_poses(vertices=1500, rng=3)
    return prepare(made.source, CONFIG), prepare(made.target, CONFIG), made.truth


def taught(matrix, marks=0, **more):
    """``CONFIG`` with a metric, and with other weights than the usual ones, as if all had been learned."""
    kernel = Metric(Gaussian(1.0), matrix, marks)
    weights, asked = Weights(1000.0, 1.0, 300.0), Formulation(mask="resolvent")
    return replace(CONFIG, kernel=kernel, weights=weights, bandwidth_scale=5.0, formulation=asked, **more)


def test_a_metric_that_knows_nothing_changes_no_digit(creature):
    source, target, _ = creature
    nonsense = np.random.default_rng(0).normal(size=(3, COUNT)).tolist()
    usual, found = (match(source, target, c) for c in (CONFIG, taught(nonsense)))
    np.testing.assert_array_equal(found.target_to_source, usual.target_to_source)
    np.testing.assert_array_equal(found.functional_map, usual.functional_map)
    assert found.score.initialization == usual.score.initialization


def test_what_was_learned_stays_out_of_the_searchs_own_fits():
    config = taught(np.eye(COUNT)[:2].tolist())
    own = drop_learned(config)
    assert own == replace(CONFIG, kernel=Config.single_fit().kernel)
    assert drop_learned(CONFIG) is CONFIG
    mine = replace(CONFIG, kernel=Gaussian(3.0), weights=Weights(5.0, 1.0, 1.0))
    assert drop_learned(mine) is mine  # a user's own settings, which nothing was learned for


def discriminant(creature):
    """Rows in which corresponding points agree and others do not (Fisher 1936)."""
    source, target, truth = creature
    used = pair_descriptors(source, target, (source.basis, target.basis), CONFIG.descriptors, NONE, None)
    moved = used.source[truth] - used.target
    spread = np.cov(used.source.T)
    noise = moved.T @ moved / len(moved) + 0.1 * np.trace(spread) / COUNT * np.eye(COUNT)
    return eigh(spread, noise)[1][:, ::-1][:, :12].T.tolist()


def test_candidates_of_the_metric(creature):
    """They are judged as all others are, and go where the metric says: compared in it, the truth is near."""
    source, target, truth = creature
    config = taught(discriminant(creature))
    on = two_level_samples(source, target, (scoring_samples(source), scoring_samples(target)), NONE)
    rows = _transformed_descriptors(source, target, config, on.whole.source, on.whole.target)
    assert rows is not None
    ground = _in_metric(on.whole, *rows)
    assert ground.descriptor_cost is not None
    assert on.whole.descriptor_cost is not None
    assert ground.descriptor_cost.shape == on.whole.descriptor_cost.shape
    found = learned_candidates(source, target, config, on, 0)
    assert found
    assert all(c.name.startswith("learned") and c.uses_descriptors for c in found)
    best = max(found, key=lambda c: c.score)
    own = search_map(source, target, drop_learned(config))
    assert best.quality.score > (own.quality or 0.0) - 3.0
    wanted = truth[on.whole.target.samples.vertices]
    images = source.mesh.vertices[on.whole.source.samples.vertices[best.points]]
    assert np.linalg.norm(images - source.mesh.vertices[wanted], axis=1).mean() < 0.15
    assert learned_candidates(source, target, taught([1.0, 2.0]), on, 0) == []  # of other descriptors


def candidate(name, score, place, on):
    """A map that sends all points to ``place``, of a given score."""
    points = np.full(len(on.target.positions), place)
    return Candidate(name, np.eye(3), points, Quality(score, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), deformation_energy=None)


def test_only_what_is_clearly_better_comes_first(creature):
    source, target, _ = creature
    on = two_level_samples(source, target, (scoring_samples(source), scoring_samples(target)), NONE).whole
    on = replace(on, source=replace(on.source, copy=None), target=replace(on.target, copy=None))
    far = int(np.linalg.norm(on.source.positions - on.source.positions[0], axis=1).argmax())
    usual, copies = [candidate("own", 1.0, 0, on)], ProxyCache.of(source, target, on)

    def first(score, place):
        return [c.name for c in merge_alternatives(usual, [candidate("new", score, place, on)], on, copies)]

    assert first(1.0 + 0.9 * SCORE.clear_margin, far) == ["own", "new"]
    assert first(1.0 + 1.1 * SCORE.clear_margin, far) == ["new", "own"]
    assert first(9.0, 0) == ["own"]  # the same map
    assert first(1.0 - 1.1 * SCORE.max_behind, far) == ["own"]
    assert merge_alternatives(usual, [], on, copies) is usual


def test_a_kernel_knows_its_landmarks(creature):
    source, target, truth = creature
    marks = np.array([[truth[v], v] for v in (3, 200, 500)])
    with pytest.raises(InvalidInput, match="learned with 6"):
        search_map(source, target, taught([1.0] * COUNT, 6), landmarks=marks)
    one = replace(taught([1.0] * COUNT, 3), search=None)
    assert n_kernel_landmarks(one.kernel) == 3
    assert fit(source, target, one, landmarks=marks).functional_map.shape == (30, 30)
    with pytest.raises(InvalidInput, match="expected 3 of them, as the kernel was learned with, got 0"):
        fit(source, target, one)  # as many descriptors, of other things
    with pytest.raises(InvalidInput, match="Metric landmarks"):
        Metric(Gaussian(1.0), (1.0,), -1)
