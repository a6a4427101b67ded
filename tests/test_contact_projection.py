"""Places on a bent source where a body touches itself."""

import numpy as np
import pytest

from conftest import inside_out, joined, sheet, shifted
from kfmaps import datasets
from kfmaps.geometry.closest_points import closest_among, closest_points
from kfmaps.geometry.mesh import Mesh, unit_area, vertex_normals
from kfmaps.registration.contact_projection import _REST_WEIGHT, project_with_contact
from kfmaps.registration.deformable import deformable_mesh
from kfmaps.registration.nonrigid_icp import NonRigid

GUARDS = ("kfmaps.geometry.closest_points", "kfmaps.registration")


def square(height: float) -> Mesh:
    """One of side 1 whose normals are up."""
    return shifted(sheet(*2 * [np.linspace(0, 1, 9)]), 0, 0, height)


def test_the_normal_tells_sides_apart_that_nearly_touch() -> None:
    """Two sheets face each other 0.004 apart, and the target's has gone 0.003 too far: halfway through and beyond."""
    source = joined(square(0.0), inside_out(square(0.004)))
    target = square(0.003)
    n = len(target.vertices)
    nowhere = np.zeros(n, dtype=np.int64)
    found = project_with_contact(nowhere, deformable_mesh(source), source.vertices, target, vertex_normals(target))
    assert (closest_points(target.vertices, source.vertices, source.faces).faces >= len(target.faces)).all()
    assert (found.faces < len(target.faces)).all()
    np.testing.assert_allclose(found.distances, 0.003)
    np.testing.assert_allclose(found.points, target.vertices * (1, 1, 0), atol=1e-12)


@pytest.mark.parametrize("mine", [0, 1])
def test_the_map_tells_parts_apart_that_lie_on_each_other(mine: int) -> None:
    """Far apart at rest, 0.002 and of like normals when bent; the map may be off by half of the way at rest."""
    one = square(0.0)
    n = len(one.vertices)
    rest = joined(one, shifted(one, 3.0, 0, 0))
    x = joined(one, square(0.002)).vertices
    target = square(0.0005 if mine else 0.0015)  # nearer to the other one
    off = (np.arange(n) // 9 + 4) % 9 * 9 + np.arange(n) % 9  # along the sheet
    body, normals = deformable_mesh(rest), vertex_normals(target)
    found = project_with_contact(mine * n + off, body, x, target, normals)
    wrong = closest_points(target.vertices, x, rest.faces).faces // len(one.faces) != mine
    assert wrong.all()
    assert (found.faces // len(one.faces) == mine).all()
    np.testing.assert_allclose(found.distances, 0.0015)
    # A part that the map has elsewhere altogether is not fetched from afar: what the fit has found back stays so.
    far = x + np.repeat([[0, 0, 0], [0, 0, 3 * 1.1 * _REST_WEIGHT]], n, axis=0)
    there = project_with_contact(np.full(n, n), body, far, target, normals)
    assert (there.faces < len(one.faces)).all()


def test_long_thin_triangles_keep_the_closest_place() -> None:
    """Their nearest vertex is seldom one of the closest face: what is sought by vertices alone would be far off."""
    mesh = datasets.sphere(100, rng=0)
    source = Mesh(mesh.vertices * (1.0, 1.0, 12.0), mesh.faces)
    normals = vertex_normals(source)[source.faces].mean(axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    points = source.vertices[source.faces].mean(axis=1) + 1e-3 * normals
    target = Mesh(points, np.array([[0, 1, 2]]))
    body = deformable_mesh(source)
    near = np.linalg.norm(points[:, None] - source.vertices, axis=2).argmin(axis=1)
    ring = closest_among(points, source.vertices, source.faces, *body.around.around(near))
    closest = closest_points(points, source.vertices, source.faces)
    assert (ring.distances > 10 * closest.distances).mean() > 0.1
    found = project_with_contact(near, body, source.vertices, target, normals)
    assert (found.distances < closest.distances + 1e-2).all()
    corners = source.vertices[source.faces[found.faces]]
    np.testing.assert_allclose(np.einsum("ti,tij->tj", found.weights, corners), found.points, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(found.points - points, axis=1), found.distances, atol=1e-12)


def hairpin(gap: float) -> Mesh:
    """A rod bent round a half circle, its arms ``gap`` apart; below 0 they overlap."""
    ball = datasets.sphere(1500, rng=2)
    along = 2 * np.arcsin(np.clip(ball.vertices[:, 0], -1, 1)) / (np.pi / 2)
    across = ball.vertices[:, 1:] / np.maximum(np.linalg.norm(ball.vertices[:, 1:], axis=1, keepdims=True), 1e-9)
    y, z = (0.2 * np.sqrt(np.clip(1 - (along / 2) ** 8, 0, 1))[:, None] * across).T
    radius = gap / 2 + 0.2
    half = np.pi * radius / 2
    angle, arm = np.clip(along / half, -1, 1) * np.pi / 2, np.maximum(np.abs(along) - half, 0)
    vertices = np.stack([(radius + y) * np.sin(angle), (radius + y) * np.cos(angle) - arm, z], axis=1)
    return unit_area(Mesh(vertices, ball.faces))


def test_arms_that_sink_into_each_other_keep_their_points() -> None:
    rest, closed = hairpin(0.4), hairpin(-0.02)
    found = NonRigid(n_levels=2, steps=3)(rest, closed, np.arange(len(rest.vertices)))
    plain = closest_points(closed.vertices, found.vertices, rest.faces)
    away, before = (
        np.linalg.norm(np.einsum("ti,tij->tj", w, rest.vertices[rest.faces[f]]) - rest.vertices, axis=1)
        for f, w in ((found.faces, found.weights), (plain.faces, plain.weights))
    )
    assert (before > 0.12).sum() >= 3
    assert (away > 0.12).sum() == 0
