"""What the generated shapes are made of: fields, bending, closed meshes through points."""

import numpy as np
import pytest

from kfmaps import datasets
from kfmaps._arrays import NotConverged
from kfmaps.datasets import skeleton, surface
from kfmaps.datasets.creature import CREATURE, WAVE
from kfmaps.datasets.skeleton import Bend, Body
from kfmaps.datasets.surface import closed_mesh
from kfmaps.geometry.mesh import face_normals, surface_area, vertex_normals


def test_field_is_negative_inside_and_its_gradient_is_its_derivative() -> None:
    body = Body(CREATURE)
    points = np.random.default_rng(0).uniform(body.box()[0], body.box()[1], (2000, 3))
    values, gradients = body(points)
    near = np.abs(values) < 0.1
    steps = 1e-6 * np.eye(3)
    numeric = np.stack([(body(points + s)[0] - body(points - s)[0]) / 2e-6 for s in steps], axis=1)
    difference = np.abs(numeric - gradients).max(axis=1)[near]
    assert np.percentile(difference, 98) < 1e-6, "all but points above a kink of the radius"
    middles = np.array([limb.balls[1][:3] for limb in CREATURE])
    assert (body(middles)[0] < 0).all()
    assert body(np.array([[0.5, 0.2, 0.3]]))[0][0] > 0


def test_bending_nothing_is_the_identity_and_growing_all_is_a_similarity() -> None:
    body = Body(CREATURE)
    points, _ = closed_mesh(body, body.box(), 1500, np.random.default_rng(0))
    np.testing.assert_allclose(body.bend(points, {}), points, atol=1e-12)
    grown = body.bend(points, {limb.name: Bend(longer=2, thicker=2) for limb in CREATURE})
    np.testing.assert_allclose(grown - grown[0], 2 * (points - points[0]), atol=1e-12)


def test_only_the_bent_limb_and_what_it_carries_moves() -> None:
    body = Body(CREATURE)
    points, _ = closed_mesh(body, body.box(), 1500, np.random.default_rng(0))
    moved = np.linalg.norm(body.bend(points, {"left arm": WAVE["left arm"]}) - points, axis=1)
    assert moved[points[:, 0] > 0.75].min() > 0.3
    away = (points[:, 0] < -0.3) | (points[:, 1] < 0.4)
    assert moved[away].max() < 0.01


def test_wrong_genus_is_reported() -> None:
    def ring(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        radius = np.hypot(points[:, 0], points[:, 1])
        away = points - points * [1, 1, 0] / radius[:, None]
        length = np.linalg.norm(away, axis=1)
        return length - 0.4, away / length[:, None]

    box = np.array([[-1.5, -1.5, -0.5], [1.5, 1.5, 0.5]])
    assert len(closed_mesh(ring, box, 400, np.random.default_rng(0), genus=1)[0]) == 400
    with pytest.raises(NotConverged, match="Ask for more vertices"):
        closed_mesh(ring, box, 400, np.random.default_rng(0), genus=0)


def test_sphere_has_its_radius_and_its_area() -> None:
    ball = datasets.sphere(800)
    np.testing.assert_allclose(np.linalg.norm(ball.vertices, axis=1), 1, rtol=1e-9)
    lack = [1 - surface_area(m) / (4 * np.pi) for m in (ball, datasets.sphere(3200))]
    assert lack[0] > 0
    assert lack[0] / lack[1] == pytest.approx(4, rel=0.15), "the lack of area falls as one over the number"


def test_torus_has_its_area() -> None:
    assert surface_area(datasets.torus(900)) == pytest.approx(4 * np.pi**2 * 0.4, rel=0.02)
    assert surface_area(datasets.torus(900, tube=0.6)) == pytest.approx(4 * np.pi**2 * 0.6, rel=0.02)


@pytest.mark.parametrize("count", [801, 802, 803, 804, 3500])
def test_subdivided_meshes_are_as_good(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(surface, "_SCATTERED", 400)
    for mesh, genus in ((datasets.sphere(count), 0), (datasets.torus(count), 1)):
        assert len(mesh.vertices) == count
        assert surface._is_closed(mesh, genus)
        edges = np.linalg.norm(mesh.vertices[mesh.faces] - mesh.vertices[np.roll(mesh.faces, 1, axis=1)], axis=2)
        assert (edges.max(axis=1) / edges.min(axis=1)).max() < 4
        outside = (face_normals(mesh) * vertex_normals(mesh)[mesh.faces[:, 0]]).sum(axis=1)
        assert outside.min() > 0.5
    np.testing.assert_allclose(np.linalg.norm(datasets.sphere(count).vertices, axis=1), 1, rtol=1e-12)


def test_large_pairs_have_their_exact_truth(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(surface, "_SCATTERED", 2000)
    monkeypatch.setattr(skeleton, "_BLOCK", 4000)
    pair = datasets.two_poses(6001)
    assert (len(pair.source.vertices), len(pair.target.vertices)) == (6001, 4801)
    for mesh in (pair.source, pair.target):
        assert surface._is_closed(mesh, 0)
    corners = pair.source.vertices[pair.source.faces[pair.truth_faces]]
    places = (corners * pair.truth_weights[:, :, None]).sum(axis=1)
    spacing = np.sqrt(surface_area(pair.source) / 6001)
    away = np.linalg.norm(pair.source.vertices[pair.truth] - places, axis=1)
    assert away.max() < 1.2 * spacing
    assert (away <= np.linalg.norm(corners - places[:, None], axis=2).min(axis=1) + 0.1 * spacing).mean() > 0.99


def test_working_in_blocks_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    body = Body(CREATURE)
    points = np.random.default_rng(0).uniform(body.box()[0], body.box()[1], (2500, 3))
    one = (*body(points), body.bend(points, WAVE))
    monkeypatch.setattr(skeleton, "_BLOCK", 999)
    monkeypatch.setattr(skeleton, "_MAX_POINTS", 999)
    for a, b in zip(one, (*body(points), body.bend(points, WAVE)), strict=True):
        np.testing.assert_allclose(a, b, atol=1e-12)
