"""A rest shape that is stretched evenly while it is bent."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kfmaps
from conftest import SMALL, rotation, two_poses
from kfmaps import datasets
from kfmaps._arrays import InvalidInput
from kfmaps.geometry.arap import build_arap, rotations
from kfmaps.geometry.mesh import Mesh, unit_area, vertex_areas
from kfmaps.matching import finish
from kfmaps.matching.finish import UNLIKE_LOCAL_SCALING, adapt_settings
from kfmaps.matching.score import SCORE
from kfmaps.matching.search_result import SearchResult
from kfmaps.registration.local_scaling import _MAX_FACTOR, _MIN_FACTOR, _clip_eigenvalues, local_scaling
from kfmaps.registration.nonrigid_icp import NonRigid

GUARDS = ("kfmaps.geometry.arap", "kfmaps.registration.local_scaling", "kfmaps.registration.nonrigid_icp")

EYE = np.eye(3)


@pytest.fixture(scope="module")
def ball():
    mesh = unit_area(datasets.sphere(400, rng=0))
    return mesh, build_arap(mesh), vertex_areas(mesh)


def test_a_change_of_size_is_found_exactly(ball) -> None:
    mesh, energy, areas = ball
    turn = rotation(0)
    x = 1.4 * mesh.vertices @ turn.T
    turns = rotations(energy, x)
    found = local_scaling(energy, areas, 0.05)(x, turns)
    np.testing.assert_allclose(found, np.broadcast_to(1.4 * turn, found.shape), atol=1e-8)
    assert local_scaling(energy, areas, 0.0)(x, turns) is turns  # no area leaves rotations


def test_longer_in_one_direction_is_found_nearly(ball) -> None:
    mesh, energy, areas = ball
    longer = np.diag([1.0, 1.0, 1.6])
    still = np.broadcast_to(EYE, (len(areas), 3, 3))
    wide, narrow = (local_scaling(energy, areas, area)(mesh.vertices @ longer, still) for area in (1.0, 0.01))
    assert np.abs(wide - longer).max() < 0.12
    assert np.abs(wide - longer).mean() < np.abs(narrow - longer).mean() < np.abs(EYE - longer).mean()


def test_eigenvalues_are_clipped_where_one_is_beyond_the_bounds() -> None:
    rng = np.random.default_rng(0)
    values = np.concatenate([rng.uniform(0.3, 3.0, (200, 3)), [[0.4, 2.5, 2.5], [0.4, 0.4, 2.5], [0.39, 1, 1]]])
    axes = np.linalg.qr(rng.normal(size=(len(values), 3, 3)))[0]
    found = _clip_eigenvalues(axes * values[:, None, :] @ axes.transpose(0, 2, 1), 0.4, 2.5)
    wanted = axes * np.clip(values, 0.4, 2.5)[:, None, :] @ axes.transpose(0, 2, 1)
    np.testing.assert_allclose(found, wanted, atol=1e-12)


def test_one_side_alone_is_hardly_scaled(ball) -> None:
    """A dent smaller than the area is averaged away, a part as large as that is not."""
    mesh, energy, areas = ball
    up = mesh.vertices[:, 2] / mesh.vertices[:, 2].max()
    still = np.broadcast_to(EYE, (len(areas), 3, 3))
    top = np.argmax(up)

    def size(where: np.ndarray) -> float:
        found = local_scaling(energy, areas, 0.05)(mesh.vertices * (1 + 0.5 * where[:, None]), still)
        return float(np.trace(found[top]) / 3)

    assert size((up > 0.98).astype(float)) < 1.15
    assert size((up > -2).astype(float)) == pytest.approx(1.5)


def test_it_turns_along_and_keeps_to_its_bounds(ball) -> None:
    mesh, energy, areas = ball
    rng = np.random.default_rng(1)
    x = mesh.vertices * (0.3, 1.0, 6.0) + 0.02 * rng.normal(size=mesh.vertices.shape)
    turn = rotation(2)
    stretched = local_scaling(energy, areas, 0.02)
    found, turned = (stretched(y, rotations(energy, y)) for y in (x, x @ turn.T))
    np.testing.assert_allclose(turned, turn @ found, atol=1e-6)
    assert np.linalg.svd(found, compute_uv=False).max() == pytest.approx(_MAX_FACTOR)
    for factor, bound in ((0.1, _MIN_FACTOR), (9.0, _MAX_FACTOR)):
        sized = stretched(factor * mesh.vertices, np.broadcast_to(EYE, found.shape))
        np.testing.assert_allclose(sized, np.broadcast_to(bound * EYE, found.shape), atol=1e-9)


def test_bodies_of_other_proportions_slide_less() -> None:
    """One half is longer and the other shorter; the fit is stiff, as between unlike shapes."""
    source = unit_area(two_poses(1500).source)
    x = source.vertices - source.vertices.mean(axis=0)
    axis = np.linalg.svd(x, full_matrices=False)[2][0]
    along = x @ axis
    other = x + np.where(along > 0, 0.35 * along, -0.25 * along)[:, None] * axis
    target = unit_area(Mesh(other, source.faces))
    every = np.arange(len(x))
    stiff = NonRigid(stiffness=5e-3, n_levels=2, steps=4)
    off = [
        float(np.linalg.norm(fit(source, target, every).vertices - target.vertices, axis=1).mean())
        for fit in (stiff, replace(stiff, local_scaling=0.05))
    ]
    assert off[1] < 0.7 * off[0]


def test_a_local_scale_is_an_area() -> None:
    with pytest.raises(InvalidInput, match=r"NonRigid\.local_scaling"):
        NonRigid(local_scaling=-0.01)


def test_only_unlike_shapes_are_scaled_locally_in_the_end(monkeypatch) -> None:
    def adapted(registration, quality):
        found = SearchResult(np.eye(3), "a", None, "unlikely", quality=quality)
        return adapt_settings(replace(SMALL, registration=registration), found, 0).registration

    unlike = SCORE.non_isometric_score - 1
    assert adapted(NonRigid(), unlike) == NonRigid(local_scaling=UNLIKE_LOCAL_SCALING)
    assert adapted(NonRigid(local_scaling=0.2), unlike) == NonRigid(local_scaling=0.2)
    assert adapted(None, unlike) is None
    for like in (SCORE.non_isometric_score, None):
        assert adapted(NonRigid(), like) == NonRigid()
    pair = two_poses(1500)
    source, target = (kfmaps.prepare(mesh, SMALL, name="a") for mesh in (pair.source, pair.target))
    seen, usual = [], finish.register_map
    monkeypatch.setattr(finish, "register_map", lambda *a: seen.append(a[3].registration.local_scaling) or usual(*a))
    for quality in (SCORE.non_isometric_score + 1, SCORE.non_isometric_score - 1):
        finish.match_from_map(source, target, finish.KnownMap(pair.truth, "a", quality=quality), SMALL)
    assert seen == [0.0, UNLIKE_LOCAL_SCALING]
