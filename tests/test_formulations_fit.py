"""Every formulation in whole matches: alone, combined, with and without landmarks, in every form of the kernel."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from conftest import small_fit
from kfmaps._arrays import InvalidInput
from kfmaps.config import Config, Formulation, Search, Weights
from kfmaps.fmap.evaluate import geodesic_errors
from kfmaps.fmap.losses import RobustData
from kfmaps.fmap.refine import ICP
from kfmaps.fmap.solvers import CG, Direct
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.io import load_map, save_map
from kfmaps.kernels.kernels import Gaussian, Linear, Polynomial
from kfmaps.matching.assemble import assemble
from kfmaps.matching.fit import fit, fit_points
from kfmaps.matching.match import match
from kfmaps.matching.solve import objective

GUARDS = ("kfmaps.fmap.zoomout", "kfmaps.fmap.full_kernel", "kfmaps.matching")

SMALL = small_fit(12, 12, 30, 40, solver=CG(rtol=1e-6, max_iter=500))
BLOBS = SMALL, 300, 260
FORMULATIONS = {
    "orthogonal": Formulation(constraint="orthogonal"),
    "both": Formulation(bidirectional=True),
    "robust landmarks": Formulation(loss="geman"),
    "robust descriptors": Formulation(loss="huber", loss_group="descriptor"),
    "robust features": Formulation(loss="huber", loss_group="feature", max_outer_iter=5),
    "sparse": Formulation(sparsity=0.05),
    "resolvent": Formulation(mask="resolvent"),
    "coupled": Formulation(coupled_bases=True),
    "spatial": Formulation(transport_weight=0.1),
    "all": Formulation(
        "orthogonal",
        True,
        0.5,
        0.5,
        "huber",
        "feature",
        1.0,
        0.02,
        "resolvent",
        coupled_bases=True,
        max_outer_iter=3,
        transport_weight=0.1,
    ),
}


def pairs(truth, rows):
    return np.stack([truth[rows], rows], axis=1)


@pytest.fixture(scope="module")
def landmark_vertices(truth):
    return pairs(truth, np.array([5, 60, 120, 180, 230]))


def with_(name, **more):
    return replace(SMALL, formulation=FORMULATIONS[name], **more)


FORMS = {
    "linear": {"kernel": Linear()},
    "polynomial": {"kernel": Polynomial(2)},
    "torch": {"device": "torch"},
    "full": {"full_kernel": True},
    "direct": {"solver": Direct()},
    "orientation": {"weights": Weights(orientation=0.1)},
}


@pytest.mark.parametrize(
    ("name", "form"),
    [*((name, form) for name in FORMULATIONS for form in ("torch", "full")), *(("all", form) for form in FORMS)],
)
def test_every_formulation_with_every_form_of_the_kernel(shape, other, landmark_vertices, truth, name, form):
    if form == "torch":
        pytest.importorskip("torch")
    if form == "full" and FORMULATIONS[name].weighs_features:
        with pytest.raises(InvalidInput, match="loss per feature"):
            with_(name, **FORMS[form])
        return
    found = match(shape, other, with_(name, **FORMS[form]), landmarks=landmark_vertices)
    assert (found.functional_map_back is not None) == (FORMULATIONS[name].bidirectional)
    if FORMULATIONS[name].constraint == "orthogonal":
        np.testing.assert_allclose(found.functional_map.T @ found.functional_map, np.eye(12), atol=1e-8)
    assert geodesic_errors(shape.mesh, found.target_to_source, truth).mean() < 0.2


@pytest.mark.parametrize("name", FORMULATIONS)
def test_equal_shapes_give_the_identity(shape, landmark_vertices, name):
    same = np.stack([landmark_vertices[:, 0], landmark_vertices[:, 0]], axis=1)
    found = match(shape, shape, with_(name), landmarks=same)
    assert (found.target_to_source == np.arange(300)).mean() > 0.95
    if found.source_to_target is not None:
        assert (found.source_to_target == np.arange(300)).mean() > 0.95


def test_nothing_asked_is_what_was_before_to_the_last_digit(shape, other, landmark_vertices):
    plain = fit(shape, other, SMALL, landmarks=landmark_vertices).functional_map
    nothing = Formulation(
        loss="squared",
        loss_group="feature",
        sparsity=0.0,
        max_outer_iter=3,
        loss_scale=9.0,
        coupling_weight=7.0,
        transport_blur=3.0,
    )
    np.testing.assert_array_equal(
        fit(shape, other, replace(SMALL, formulation=nothing), landmarks=landmark_vertices).functional_map, plain
    )


def test_weak_formulations_come_close_to_least_squares(shape, other, landmark_vertices):
    config = replace(SMALL, solver=CG(rtol=1e-10, max_iter=2000), kernel=Gaussian(1.0))
    plain = fit(shape, other, config, landmarks=landmark_vertices).functional_map
    for weak in (
        Formulation(sparsity=1e-9),
        Formulation(transport_weight=1e-9),
        Formulation(bidirectional=True, inverse_weight=1e-9, adjoint_weight=1e-9),
        Formulation(loss="huber", loss_group="feature", loss_scale=1e9),
    ):
        found = fit(shape, other, replace(config, formulation=weak), landmarks=landmark_vertices).functional_map
        np.testing.assert_allclose(found, plain, atol=1e-5)


def test_swapping_the_shapes_swaps_both_maps(shape, other, landmark_vertices):
    config = with_("both", refinement=ZoomOut(8, 30, 4), kernel=Linear())
    forth: Any = match(shape, other, config, landmarks=landmark_vertices)
    back = match(other, shape, config, landmarks=landmark_vertices[:, ::-1])
    assert (forth.source_to_target == back.target_to_source).mean() > 0.9
    assert forth.source_to_target.shape == (300,)
    np.testing.assert_allclose(forth.functional_map_back, forth.functional_map.T, atol=1e-12)


def test_both_maps_are_saved(shape, other, landmark_vertices, tmp_path):
    found = match(shape, other, with_("both"), landmarks=landmark_vertices)
    for name in ("map.npz", "map.mat"):
        save_map(tmp_path / name, found)
        again = load_map(tmp_path / name)
        np.testing.assert_array_equal(again.source_to_target, found.source_to_target)
        np.testing.assert_array_equal(again.functional_map_back, found.functional_map_back)


def test_both_directions_agree_more_than_one_at_a_time(shape, other, landmark_vertices):
    def cycle(forth, back):
        there = geodesic_errors(shape.mesh, forth[back], np.arange(300)).mean()
        return there + geodesic_errors(other.mesh, back[forth], np.arange(260)).mean()

    for refinement in (None, ZoomOut(8, 30, 4), ICP(3)):
        config = replace(SMALL, refinement=refinement)
        apart = [
            match(*order, config, landmarks=m)
            for order, m in (((shape, other), landmark_vertices), ((other, shape), landmark_vertices[:, ::-1]))
        ]
        tied = match(shape, other, replace(config, formulation=FORMULATIONS["both"]), landmarks=landmark_vertices)
        free = cycle(apart[0].target_to_source, apart[1].target_to_source)
        assert cycle(tied.target_to_source, tied.source_to_target) <= 1.05 * free


@pytest.mark.parametrize("kernel", [Linear(), Gaussian()], ids=["linear", "gaussian"])
def test_wrong_landmarks_are_found_out(shape, other, truth, kernel):
    rows = np.unique(truth, return_index=True)[1][3::9][:20]
    landmark_vertices = pairs(truth, rows)
    wrong = landmark_vertices.copy()
    bad = np.array([2, 5, 8, 11, 14, 17])
    wrong[bad, 0] = landmark_vertices[np.roll(bad, 1), 0]
    config = replace(SMALL, kernel=kernel, descriptors=replace(SMALL.descriptors, n_spectral=60))
    robust = replace(config, formulation=Formulation(loss="geman"))
    weights: Any = fit(shape, other, robust, landmarks=wrong).weights
    assert weights.shape == (20,)
    assert weights[bad].max() < 0.5 * np.median(np.delete(weights, bad))

    def error(config, landmarks):
        points = match(shape, other, config, landmarks=landmarks).target_to_source
        return geodesic_errors(shape.mesh, points, truth).mean()

    assert error(robust, wrong) < 1.3 * error(robust, landmark_vertices)
    assert error(robust, wrong) < error(config, wrong)


def test_residuals_of_features_are_relative_to_both_shapes(shape, other):
    config = with_("robust features")
    points = fit_points(shape, other, config, np.zeros((0, 2), dtype=np.int64))
    rng = np.random.default_rng(0)
    task = assemble(*points.shapes, points.bases, points.descriptors, config, rng, (shape, other))
    relative = []
    for reverse in (False, True):
        _, data = objective(task, np.eye(12), None, reverse).penalties["descriptors"]
        assert isinstance(data, RobustData)
        relative.append(data.residuals(np.zeros((12, 12))))
    np.testing.assert_allclose(relative[0] + relative[1], 1.0)


def test_loss_per_landmark_needs_landmarks(shape, other):
    with pytest.raises(InvalidInput, match="loss per landmark: expected landmarks"):
        fit(shape, other, with_("robust landmarks"))


def test_every_layout_knows_its_landmarks(shape, other, landmark_vertices):
    for more in (
        {"energy_sampling": "every-nth"},
        {"signature": "none"},
        {"landmark_descriptor": "heat", "n_spectral": 31},
    ):
        config = with_("robust landmarks", descriptors=replace(SMALL.descriptors, **{"n_spectral": 60, **more}))
        found: Any = fit(shape, other, config, landmarks=landmark_vertices)
        assert found.weights.shape == (5,)


def test_a_search_fits_in_any_formulation(shape, other):
    config = replace(
        Config(),
        basis=SMALL.basis,
        descriptors=SMALL.descriptors,
        refinement=ZoomOut(10, 30, 10),
        search=Search(candidates=1, n_sign_functions=0),
        threads=1,
        formulation=Formulation("orthogonal", True),
    )
    found: Any = match(shape, other, config)
    assert found.source_to_target.shape == (300,)


def test_functions_are_carried_beyond_the_basis(shape, other, truth, landmark_vertices):
    found = match(shape, other, replace(SMALL, refinement=ZoomOut(8, 30, 4)), landmarks=landmark_vertices)
    f = shape.mesh.vertices
    better, alone = found.transfer(f, 12), found.transfer(f, 0)
    assert better.shape == (260, 3)
    assert np.linalg.norm(better - f[truth]) < np.linalg.norm(alone - f[truth])
    np.testing.assert_allclose(found.transfer(f[:, 0], 12), better[:, 0])
    with pytest.raises(InvalidInput, match="values"):
        found.transfer(f[:-1], 12)
    np.testing.assert_array_equal(found.transfer(f), f[found.target_to_source])


def test_settings_that_contradict_each_other_are_refused():
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"constraint": "unitary"}, "constraint"),
        ({"bidirectional": True, "inverse_weight": 0.0, "adjoint_weight": 0.0}, "ties the two"),
        ({"loss_scale": 0.0}, "loss_scale"),
        ({"sparsity": -1.0}, "sparsity"),
        ({"transport_weight": -1.0}, "transport_weight"),
        ({"transport_blur": 0.0}, "transport_blur"),
        ({"max_outer_iter": 0}, "max_outer_iter"),
    ]
    for more, wanted in wrong:
        with pytest.raises(InvalidInput, match=wanted):
            Formulation(**more)
    with pytest.raises(InvalidInput, match="loss per feature"):
        replace(Config.single_fit(), weights=Weights(descriptors=0.0), formulation=FORMULATIONS["robust features"])
