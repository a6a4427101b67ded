"""Point clouds of closed bodies get the faces of their surface; others stay clouds."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import kfmaps
from conftest import SMALL, blob, fibonacci_sphere
from kfmaps import InvalidInput
from kfmaps.datasets import symmetric_creature, torus
from kfmaps.geometry.cloud_surface import _fit_quadrics, crust_faces, project_noise, surface_of_cloud
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area, vertex_normals

GUARDS = ("kfmaps.geometry.cloud_surface", "kfmaps.shape")


def noisy(mesh: Mesh, sigma: float) -> np.ndarray:
    return mesh.vertices + sigma * np.random.default_rng(0).normal(size=mesh.vertices.shape)


@pytest.mark.parametrize(("mesh", "euler"), [(blob(900), 2), (torus(1500, rng=0), 0)], ids=["blob", "torus"])
def test_the_faces_of_a_closed_surface_are_found(mesh: Mesh, euler: int) -> None:
    faces = crust_faces(mesh.vertices)
    n = len(mesh.vertices)
    there = faces.ravel() * n + np.roll(faces, -1, axis=1).ravel()
    back = np.roll(faces, -1, axis=1).ravel() * n + faces.ravel()
    assert len(np.unique(there)) == len(there)
    assert set(there) == set(back)
    assert len(np.unique(faces)) == n
    assert n - len(there) // 2 + len(faces) == euler
    found = Mesh(mesh.vertices, faces)
    assert surface_area(found) == pytest.approx(surface_area(mesh), rel=0.01)
    assert ((vertex_normals(found) * vertex_normals(mesh)).sum(axis=1) > 0.9).all()


def test_noisy_points_are_projected_and_too_much_noise_leaves_a_cloud() -> None:
    mesh = fibonacci_sphere(2000)
    spacing = np.sqrt(4 * np.pi / 2000)
    clean: Any = surface_of_cloud(mesh.vertices)
    np.testing.assert_array_equal(clean.vertices, mesh.vertices)
    for noise, left in (0.2, 0.5), (0.6, 0.35):
        points = noisy(mesh, noise * spacing)
        found: Any = surface_of_cloud(points)
        off = [np.abs(np.linalg.norm(x, axis=1) - 1).mean() for x in (points, found.vertices)]
        assert off[1] < left * off[0]
        assert surface_area(found) == pytest.approx(4 * np.pi, rel=0.02)
    assert surface_of_cloud(noisy(mesh, 6 * spacing)) is None


def test_noise_leaves_few_handles() -> None:
    """The Euler characteristic of a body like a sphere stays near 2; links with less sharp weights make it −11."""
    mesh = unit_area(symmetric_creature(3000, rng=1).source)
    faces = crust_faces(project_noise(noisy(mesh, 0.01)))
    assert len(np.unique(faces)) - len(faces) / 2 > -6


@pytest.mark.parametrize("curved", [0.0, 0.5])
def test_points_of_a_quadric_stay_where_they_are(curved: float) -> None:
    """Points go along the normal, to planes and paraboloids; the noise is that of the points over their extent."""
    rng = np.random.default_rng(0)
    flat = rng.uniform(-1, 1, size=(3000, 2))
    points = np.column_stack([flat, curved * flat[:, 0] * flat[:, 1]])
    inner = np.abs(flat).max(axis=1) < 0.7
    projected, noise = _fit_quadrics(points, 40)
    np.testing.assert_allclose(projected[inner], points[inner], atol=2e-5)
    assert noise < 1e-3
    moved = points + 0.01 * rng.normal(size=points.shape)
    projected, noise = _fit_quadrics(moved, 40)
    height = projected[:, 2] - curved * projected[:, 0] * projected[:, 1]
    assert height[inner].std() < 0.5 * (moved[:, 2] - curved * moved[:, 0] * moved[:, 1])[inner].std()
    # Weights fall to exp(-4) at the radius of 40 points of density 750: the extent is 0.33 of that.
    assert noise == pytest.approx(0.01 / (0.33 * np.sqrt(40 / 750 / np.pi)), rel=0.15)


def test_points_of_no_closed_surface_stay_a_cloud() -> None:
    rng = np.random.default_rng(0)
    flat = np.column_stack([rng.uniform(size=(800, 2)), np.zeros(800)])
    wavy = flat + np.column_stack([np.zeros((800, 2)), 0.1 * np.sin(5 * flat[:, 0])])
    cup = fibonacci_sphere(1500).vertices
    for points in (flat, wavy, cup[cup[:, 2] < 0.2], rng.normal(size=(800, 3))):
        assert surface_of_cloud(points) is None


def test_clouds_of_symmetric_bodies_are_matched_without_landmarks() -> None:
    pair = symmetric_creature(1500, rng=1)
    clouds = Mesh(pair.source.vertices), Mesh(pair.target.vertices)
    found = kfmaps.match(*clouds, SMALL)
    errors = kfmaps.geodesic_errors(pair.source, found.target_to_source, pair.truth)
    assert errors.mean() < 0.03
    assert found.verdict == "sure"
    assert found.source is clouds[0]
    assert found.precise_map is None
    with pytest.raises(InvalidInput, match="point cloud"):
        found.precise()
    shape = kfmaps.prepare(clouds[0], SMALL)
    assert shape.shot is not None
    assert len(shape.given_mesh.faces) == 0 < len(shape.mesh.faces)
    plain = replace(SMALL, descriptors=replace(SMALL.descriptors, shot=False))
    assert len(kfmaps.prepare(clouds[0], plain).mesh.faces) == 0
