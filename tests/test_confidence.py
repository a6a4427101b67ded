"""Confidence per vertex: one for isometries, low where distances are broken, and the same in every unit and order."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.transform import Rotation

from conftest import blob
from kfmaps._arrays import InvalidInput
from kfmaps.datasets import two_poses
from kfmaps.fmap.confidence import _RADIUS, local_confidence
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, unit_area

GUARDS = ("kfmaps.fmap.confidence",)


def moved(mesh: Mesh) -> Mesh:
    return Mesh(7 * mesh.vertices @ Rotation.from_rotvec([1, 2, 3]).as_matrix() + 5, mesh.faces)


def test_an_isometry_is_trusted_everywhere() -> None:
    mesh = blob(600)
    assert local_confidence(mesh, moved(mesh), np.arange(600)) == pytest.approx(1, abs=1e-9)


def test_it_is_what_its_definition_says() -> None:
    source, target = blob(300), moved(blob(250))
    rng = np.random.default_rng(3)
    points, samples = rng.integers(0, 300, 250), rng.choice(250, 90, replace=False)
    d_s, d_t = (dijkstra(geodesic_graph(unit_area(m), 0)) for m in (source, target))
    expected = np.empty(250)
    for i in range(250):
        near = [j for j in samples if d_t[i, j] <= _RADIUS]
        change = sum(abs(min(d_s[points[i], points[j]], 2 * _RADIUS) - d_t[i, j]) for j in near)
        whole = sum(d_t[i, j] for j in near)
        expected[i] = max(0.0, 1 - change / whole) if whole > 0 else 0.0
    np.testing.assert_allclose(local_confidence(source, target, points, samples), expected, atol=1e-9)
    assert (expected > 0).any()
    assert (expected == 0).any()


def test_the_order_of_vertices_does_not_matter() -> None:
    mesh, rng = blob(300), np.random.default_rng(1)
    points, samples, order = rng.integers(0, 300, 300), np.arange(0, 300, 3), rng.permutation(300)
    place = np.argsort(order)
    shuffled = Mesh(mesh.vertices[order], place[mesh.faces])
    one = local_confidence(mesh, mesh, points, samples)
    other = local_confidence(shuffled, shuffled, place[points[order]], place[samples])
    np.testing.assert_allclose(other, one[order], atol=1e-9)


def test_a_part_sent_elsewhere_is_found() -> None:
    pair = two_poses(2000)
    assert np.median(local_confidence(pair.source, pair.target, pair.truth)) > 0.85
    side = pair.target.vertices[:, 0]
    part, away = side > np.quantile(side, 0.93), side < np.quantile(side, 0.7)
    wrong = pair.truth.copy()
    wrong[part] = np.random.default_rng(0).permutation(wrong[part])
    found = local_confidence(pair.source, pair.target, wrong)
    assert np.quantile(found[part], 0.8) < 0.3
    assert np.median(found[away]) > 0.85


def test_what_has_no_surroundings_is_not_trusted() -> None:
    mesh = blob(300)
    loose = Mesh(np.concatenate([mesh.vertices, [[9.0, 9, 9]]]), mesh.faces)
    found = local_confidence(loose, loose, np.arange(301))
    assert found[300] == 0
    assert found[:300] == pytest.approx(1)


def test_two_parts_that_are_torn_apart() -> None:
    one = blob(200)
    two = Mesh(
        np.concatenate([one.vertices, one.vertices + np.array([5, 0, 0])]), np.concatenate([one.faces, one.faces + 200])
    )
    torn = np.where(np.arange(400) % 2, np.arange(400), (np.arange(400) + 200) % 400)
    assert local_confidence(two, two, np.arange(400)) == pytest.approx(1)
    assert np.median(local_confidence(two, two, torn)) < 0.2


def test_point_clouds_have_it_too() -> None:
    cloud = Mesh(blob(300).vertices, np.zeros((0, 3), dtype=np.int64))
    assert local_confidence(cloud, cloud, np.arange(300)) == pytest.approx(1)


def test_a_map_that_does_not_fit_is_refused() -> None:
    with pytest.raises(InvalidInput, match="target_to_source"):
        local_confidence(blob(100), blob(100), np.full(100, 100))
