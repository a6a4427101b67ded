"""A search leaves out what was learned."""

from dataclasses import replace

import numpy as np
import pytest

from kfmaps import datasets
from kfmaps._arrays import InvalidInput
from kfmaps.config import BasisConfig, Config, DescriptorConfig, Formulation, Search, Weights
from kfmaps.kernels.kernels import Gaussian
from kfmaps.kernels.transformed import Metric, n_kernel_landmarks
from kfmaps.matching.fit import fit
from kfmaps.matching.initial_maps import drop_learned
from kfmaps.matching.match import match
from kfmaps.matching.search import search_map
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


@pytest.fixture(scope="module")
def creature():
    made = datasets.two_poses(vertices=1500, rng=3)
    return prepare(made.source, CONFIG), prepare(made.target, CONFIG), made.truth


def taught(matrix, landmark_vertices=0, **more):
    """``CONFIG`` with a metric, and with other weights than the usual ones, as if all had been learned."""
    kernel = Metric(Gaussian(1.0), matrix, landmark_vertices)
    weights, asked = Weights(1000.0, 1.0, 300.0), Formulation(mask="resolvent")
    return replace(CONFIG, kernel=kernel, weights=weights, bandwidth_scale=5.0, formulation=asked, **more)


def test_a_metric_that_knows_nothing_changes_no_digit(creature):
    source, target, _ = creature
    nonsense = np.random.default_rng(0).normal(size=(3, COUNT)).tolist()
    usual, found = (match(source, target, c) for c in (CONFIG, taught(nonsense)))
    np.testing.assert_array_equal(found.target_to_source, usual.target_to_source)
    np.testing.assert_array_equal(found.functional_map, usual.functional_map)
    assert found.score.initialization == usual.score.initialization


def test_fits_of_a_search_leave_the_learned_kernel_out():
    config = taught(np.eye(COUNT)[:2].tolist())
    own = drop_learned(config)
    assert own == replace(CONFIG, kernel=Config.single_fit().kernel)
    assert drop_learned(CONFIG) is CONFIG
    mine = replace(CONFIG, kernel=Gaussian(3.0), weights=Weights(5.0, 1.0, 1.0))
    assert drop_learned(mine) is mine  # a user's own settings, which nothing was learned for


def test_a_kernel_knows_its_landmarks(creature):
    source, target, truth = creature
    landmark_vertices = np.array([[truth[v], v] for v in (3, 200, 500)])
    with pytest.raises(InvalidInput, match="learned with 6"):
        search_map(source, target, taught([[1.0] * COUNT], 6), landmarks=landmark_vertices)
    one = replace(taught([[1.0] * COUNT], 3), search=None)
    assert n_kernel_landmarks(one.kernel) == 3
    assert fit(source, target, one, landmarks=landmark_vertices).functional_map.shape == (30, 30)
    with pytest.raises(InvalidInput, match="expected 3 of them, as the kernel was learned with, got 0"):
        fit(source, target, one)  # as many descriptors, of other things
    with pytest.raises(InvalidInput, match="Metric landmarks"):
        Metric(Gaussian(1.0), ((1.0,),), -1)
