"""How thick two bodies are, as a guide."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import kfmaps
from kfmaps._arrays import NotConverged
from kfmaps.fit.shape import Shape
from kfmaps.functional.guide import Guide
from kfmaps.search import girth as of
from kfmaps.search.alternate import Alternated, Grounds
from kfmaps.search.choose import Found
from kfmaps.search.girth import FLAT, TIMES, WEIGHT, _staying, girth, slid_back
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


@pytest.mark.parametrize("backwards", [False, True])
def test_what_was_mended_is_mended_once_more(
    creatures: tuple[Shape, Shape, np.ndarray], monkeypatch: pytest.MonkeyPatch, backwards: bool
) -> None:
    """The same body is bent; girth stands beside what leads."""
    source, target, _ = creatures
    rng = np.random.default_rng(0)
    C = rng.normal(size=(50, 50))
    led = Guide(*(np.ones((len(shape.mesh.vertices), 2)) for shape in (source, target)))
    found = Found(C, "a", None, "poor", bent=np.zeros((1, 3)), backwards=backwards, landmarks=np.array([[5, 7]]))
    thick, seen = girth(source, target), []

    def made(C: np.ndarray, on: Grounds, led: Guide) -> Alternated:
        seen.append((C, on.source is source, led))
        return Alternated(2 * C, on.source.mesh.vertices)

    monkeypatch.setattr(of, "alternated", made)
    again = slid_back(found, source, target, led)
    ((given, forwards, leads),) = seen
    assert forwards != backwards
    np.testing.assert_array_equal(given, C.T if backwards else C)
    np.testing.assert_array_equal(again.functional_map, 2 * C)
    assert again.bent is (target if backwards else source).mesh.vertices
    sides = (leads.target, leads.source) if backwards else (leads.source, leads.target)
    for side, mine, ones in zip(sides, (thick.source, thick.target), (led.source, led.target), strict=True):
        np.testing.assert_allclose(side, np.hstack([ones, np.sqrt(WEIGHT) * mine]))
    assert slid_back(replace(found, bent=None), source, target, led).functional_map is C


def test_what_falls_apart_stays(creatures: tuple[Shape, Shape, np.ndarray], monkeypatch: pytest.MonkeyPatch) -> None:
    def apart(*_what: Any) -> Alternated:
        raise NotConverged("it fell apart")

    monkeypatch.setattr(of, "alternated", apart)
    landmarks = np.zeros((0, 2), dtype=np.int64)
    found = Found(np.eye(9), "a", None, "poor", bent=np.zeros((1, 3)), landmarks=landmarks)
    assert slid_back(found, creatures[0], creatures[1], None) is found
