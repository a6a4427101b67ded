"""Confidence per vertex: one for isometries, low where distances are broken; on coarse copies nearly the same."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

from conftest import NO_FACES, blob, cloud_of, joined, reordered, rotation, shifted, two_poses
from kfmaps._arrays import InvalidInput
from kfmaps.fmap import confidence
from kfmaps.fmap.confidence import _RADIUS, approximate_geodesics, local_confidence
from kfmaps.geometry.geodesic_graph import geodesic_graph
from kfmaps.geometry.mesh import Mesh, unit_area

GUARDS = ("kfmaps.fmap.confidence",)


def moved(mesh: Mesh) -> Mesh:
    return Mesh(7 * mesh.vertices @ rotation(1) + 5, mesh.faces)


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
    place, shuffled = np.argsort(order), reordered(mesh, order)
    one = local_confidence(mesh, mesh, points, samples)
    other = local_confidence(shuffled, shuffled, place[points[order]], place[samples])
    np.testing.assert_allclose(other, one[order], atol=1e-9)


def test_an_isolated_vertex_has_no_local_confidence() -> None:
    loose = joined(blob(300), Mesh(np.array([[9.0, 9, 9]]), NO_FACES))
    found = local_confidence(loose, loose, np.arange(301))
    assert found[300] == 0
    assert found[:300] == pytest.approx(1)


def test_two_parts_that_are_torn_apart() -> None:
    two, every = joined(blob(200), shifted(blob(200), 5, 0, 0)), np.arange(400)
    assert local_confidence(two, two, every) == pytest.approx(1)
    assert np.median(local_confidence(two, two, np.where(every % 2, every, (every + 200) % 400))) < 0.2


def test_an_isometry_is_trusted_everywhere_and_clouds_are_too() -> None:
    mesh, cloud = blob(600), cloud_of(blob(300))
    assert local_confidence(mesh, moved(mesh), np.arange(600)) == pytest.approx(1, abs=1e-9)
    assert local_confidence(cloud, cloud, np.arange(300)) == pytest.approx(1)


def test_a_map_that_does_not_fit_is_refused() -> None:
    with pytest.raises(InvalidInput, match="target_to_source"):
        local_confidence(blob(100), blob(100), np.full(100, 100))


def coarser(monkeypatch: pytest.MonkeyPatch, points: int) -> None:
    monkeypatch.setattr(confidence, "_MAX_EXACT", 1000)
    monkeypatch.setattr(confidence, "_PROXY_VERTICES", points)


def test_distances_are_nearly_those_of_all_edges(monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = unit_area(blob(3000))
    sources, limit = np.array([5, 1700, 2999]), 0.3
    exact = approximate_geodesics(mesh)(indices=sources, limit=limit)
    coarser(monkeypatch, 900)
    found = approximate_geodesics(mesh)(indices=sources, limit=limit)
    assert found.shape == exact.shape
    near = exact <= 0.9 * limit
    assert np.abs(found - exact)[near].mean() < 0.01
    assert (found[near] < limit).mean() > 0.999
    assert not (found[exact == np.inf] < 0.8 * limit).any()
    assert found[np.arange(3), sources].max() < 0.036  # an edge of the copy


def test_a_component_that_is_not_reached_stays_far(monkeypatch: pytest.MonkeyPatch) -> None:
    coarser(monkeypatch, 900)
    one = unit_area(blob(1500))
    found = approximate_geodesics(joined(one, shifted(one, 3, 3, 3)))(indices=np.array([0, 1500]), limit=0.3)
    assert (found[0, 1500:] > 1).all()
    assert (found[1, :1500] > 1).all()
    assert (found[0, :1500] <= 0.3).any()


def test_a_part_sent_elsewhere_is_found_with_coarse_distances_too(monkeypatch: pytest.MonkeyPatch) -> None:
    pair = two_poses(3000)
    side = pair.target.vertices[:, 0]
    part, away = side > np.quantile(side, 0.93), side < np.quantile(side, 0.7)
    wrong = pair.truth.copy()
    wrong[part] = np.random.default_rng(0).permutation(wrong[part])
    maps = pair.truth, wrong
    exact = [local_confidence(pair.source, pair.target, points) for points in maps]
    assert np.median(exact[0]) > 0.85
    assert np.quantile(exact[1][part], 0.8) < 0.3
    assert np.median(exact[1][away]) > 0.85
    coarser(monkeypatch, 1500)
    for points, one in zip(maps, exact, strict=True):
        assert np.abs(local_confidence(pair.source, pair.target, points) - one).mean() < 0.03
