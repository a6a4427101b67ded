"""Distances on a coarse copy are those along the edges, nearly, and confidences made of them too."""

from __future__ import annotations

import numpy as np
import pytest

from conftest import blob
from kfmaps.datasets import two_poses
from kfmaps.fmap import confidence as module
from kfmaps.fmap.confidence import approximate_geodesics, local_confidence
from kfmaps.geometry.mesh import Mesh, unit_area

GUARDS = ("kfmaps.fmap.confidence",)


def coarser(monkeypatch: pytest.MonkeyPatch, points: int) -> None:
    monkeypatch.setattr(module, "_MAX_EXACT", 1000)
    monkeypatch.setattr(module, "_PROXY_VERTICES", points)


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
    two = Mesh(np.vstack([one.vertices, one.vertices + 3]), np.vstack([one.faces, one.faces + 1500]))
    found = approximate_geodesics(two)(indices=np.array([0, 1500]), limit=0.3)
    assert (found[0, 1500:] > 1).all()
    assert (found[1, :1500] > 1).all()
    assert (found[0, :1500] <= 0.3).any()


def test_confidence_is_nearly_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    pair = two_poses(3000)
    side = pair.target.vertices[:, 0]
    part = np.flatnonzero(side > np.quantile(side, 0.93))
    wrong = pair.truth.copy()
    wrong[part] = np.random.default_rng(0).permutation(wrong[part])
    maps = pair.truth, wrong
    exact = [local_confidence(pair.source, pair.target, points) for points in maps]
    coarser(monkeypatch, 1500)
    found = [local_confidence(pair.source, pair.target, points) for points in maps]
    for one, other in zip(exact, found, strict=True):
        assert np.abs(one - other).mean() < 0.03
    assert found[1][part].mean() < found[0][part].mean() - 0.3
