"""How thick two bodies are, as a guide."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import kfmaps
from kfmaps.fit.shape import Shape
from kfmaps.search.girth import FLAT, TIMES, _staying, girth
from kfmaps.surface.basis import laplace_basis
from kfmaps.surface.mesh import Mesh, unit_area


def of_unit_area(mesh: Mesh) -> Any:
    """All of a prepared shape that matters here."""
    return SimpleNamespace(basis=laplace_basis(unit_area(mesh), 150, threads=1))


@pytest.fixture(scope="module")
def ball() -> Shape:
    return of_unit_area(kfmaps.datasets.sphere(3000, rng=0))


@pytest.fixture(scope="module")
def club() -> tuple[Shape, np.ndarray]:
    """A rod that is three times as thick on one side, and where along it each vertex is, from -1 to 1."""
    mesh = kfmaps.datasets.sphere(1500, rng=0)
    along = np.arcsin(np.clip(mesh.vertices[:, 0], -1, 1)) / (np.pi / 2)
    across = mesh.vertices[:, 1:] / np.maximum(np.linalg.norm(mesh.vertices[:, 1:], axis=1, keepdims=True), 1e-9)
    radius = (0.2 + 0.1 * np.tanh(8 * along)) * np.sqrt(np.clip(1 - along**8, 0, 1))
    rod = np.column_stack([2 * along, radius[:, None] * across])
    return of_unit_area(Mesh(rod, mesh.faces)), along


def test_heat_on_a_sphere_stays_as_the_theory_says(ball: Shape) -> None:
    """Of unit area: Σ (2 l + 1) exp(−4π l (l + 1) t) over l; and evenly thick shapes say nothing."""
    order = np.arange(200)
    theory = [((2 * order + 1) * np.exp(-4 * np.pi * order * (order + 1) * t)).sum() for t in TIMES]
    np.testing.assert_allclose(_staying(ball), np.broadcast_to(theory, (3000, len(TIMES))), rtol=0.05)
    guide = girth(ball, ball)
    assert np.abs(guide.source).max() < 0.05 / FLAT


def test_thin_parts_keep_their_heat(club: tuple[Shape, np.ndarray]) -> None:
    shape, along = club
    stays = girth(shape, shape).source[:, -1]
    thin, thick = stays[(along > -0.6) & (along < -0.2)], stays[(along > 0.2) & (along < 0.6)]
    assert thin.min() > thick.max()
    assert thin.mean() - thick.mean() > 4 * (thin.std() + thick.std())


def test_random_points_differ_by_one_whatever_the_bodies(creatures: tuple[Shape, Shape, np.ndarray]) -> None:
    source, target, _ = creatures
    guide = girth(source, target)
    both = np.vstack([guide.source, guide.target])
    a, b = np.random.default_rng(0).integers(len(both), size=(2, 20_000))
    assert ((both[a] - both[b]) ** 2).sum(axis=1).mean() == pytest.approx(1.0, abs=0.05)
    np.testing.assert_allclose(both.mean(axis=0), 0, atol=1e-9)


def test_corresponding_points_are_alike_in_another_pose() -> None:
    pair = kfmaps.datasets.two_poses(1500, rng=1)
    a, b = (of_unit_area(mesh) for mesh in (pair.source, pair.target))
    guide = girth(a, b)
    assert ((guide.source[pair.truth] - guide.target) ** 2).sum(axis=1).mean() < 0.02
