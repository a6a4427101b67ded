"""Shapes in several pieces: what tells that these are where they belong."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull, KDTree

from conftest import blob, cloud_of, fibonacci_sphere, joined, shifted
from kfmaps.config import Config
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area
from kfmaps.matching.finish import torn_contact_share, turned_by_symmetries
from kfmaps.matching.landmark_evidence import landmark_distances
from kfmaps.matching.quality import sample_for_scoring
from kfmaps.shape import _prepare

GUARDS = ("kfmaps.matching.finish", "kfmaps.matching.quality", "kfmaps.matching.landmark_evidence")

N = 400


@pytest.fixture(scope="module")
def pieces() -> Mesh:
    """A long body between two small balls of one size, which it touches."""
    ball = fibonacci_sphere(N)
    body = Mesh(ball.vertices * [3.0, 1.2, 1.0], ball.faces)
    small = Mesh(ball.vertices * 0.9, ball.faces)
    return unit_area(joined(body, shifted(small, 3.9, 0.0, 0.0), shifted(small, -3.9, 0.0, 0.0)))


def turned(mesh: Mesh, piece: int) -> np.ndarray:
    """A map (n,) that turns one piece by half a turn about its vertical axis, and is the identity elsewhere."""
    rows = slice(N * piece, N * (piece + 1))
    own = mesh.vertices[rows]
    centre = own.mean(axis=0)
    points = np.arange(len(mesh.vertices))
    points[rows] = N * piece + KDTree(own).query(centre + (own - centre) * [-1.0, -1.0, 1.0])[1]
    return points


def test_contacts_are_torn_where_pieces_are_exchanged_or_turned(pieces) -> None:
    same = np.arange(3 * N)
    assert torn_contact_share(pieces, pieces, same) == 0.0
    one = torn_contact_share(pieces, pieces, turned(pieces, 1))
    both = torn_contact_share(pieces, pieces, np.where(same < 2 * N, turned(pieces, 1), turned(pieces, 2)))
    assert 0.3 < one < 0.7 < both  # one ball has half of the contacts
    exchanged = np.concatenate([same[:N], same[2 * N :], same[N : 2 * N]])
    assert torn_contact_share(pieces, pieces, exchanged) == 1.0


def test_contacts_of_one_pose_beside_a_joint_are_not_torn(pieces) -> None:
    """As where a hand touches a hip: the body and a ball still touch where they do in the other pose."""
    same, piece = np.arange(3 * N), np.repeat([0, 1, 2], N)
    middle, right, left = (pieces.vertices[piece == k] for k in range(3))
    body = middle.copy()  # its middle bends up, and touches the top of a ball
    nearest = np.argsort(np.abs(middle[:, 0]))[:40]
    body[nearest] = right[np.argsort(-right[:, 1])[:40]] + 0.001
    bent = Mesh(np.concatenate([body, right, left]), pieces.faces)
    assert torn_contact_share(pieces, bent, same) == 0.0


def test_one_piece_a_cloud_and_pieces_that_lie_apart_have_no_contacts(pieces) -> None:
    apart = unit_area(joined(blob(N), shifted(blob(N), 9.0, 0.0, 0.0)))
    for mesh in (unit_area(blob(N)), cloud_of(pieces), apart):
        assert torn_contact_share(mesh, mesh, np.random.default_rng(0).permutation(len(mesh.vertices))) == 0.0


def test_pieces_of_revolution_may_be_turned() -> None:
    """An egg of 15 sides beside a body: a third of a turn moves it by √3 of its radius. An egg alone has no pieces."""
    angle, height = np.meshgrid(np.arange(15) * 2 * np.pi / 15, np.linspace(-0.95, 0.95, 12))
    radius = np.sqrt(1.0 - height**2) * (1.0 + 0.2 * height)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 1.5 * height], axis=-1).reshape(-1, 3)
    egg, body = Mesh(points, ConvexHull(points).simplices.astype(np.int64)), blob(N)
    both = joined(body, shifted(egg, 9.0, 0.0, 0.0))
    scale, share = np.sqrt(surface_area(both)), surface_area(egg) / surface_area(both)
    assert turned_by_symmetries(unit_area(both)) == pytest.approx(
        share * np.sqrt(3.0) * radius.mean() / scale, rel=1e-6
    )
    assert turned_by_symmetries(unit_area(egg)) == 0.0
    assert turned_by_symmetries(unit_area(joined(body, shifted(body, 9.0, 0.0, 0.0)))) == 0.0


def test_distances_between_pieces_tell_which_touch(pieces) -> None:
    """Balls on both sides are as far from each other as the body is long, and each is near its end of the body."""
    shape = _prepare(pieces, Config(), "shape", None, ()).cleaned[0]  # in pieces as it is
    samples = sample_for_scoring(shape, 300)
    first = samples.samples.vertices[: len(samples.distances)]
    piece, x = first // N, shape.mesh.vertices[first, 0]
    right, left = (piece == 1), (piece == 2)
    assert samples.distances[np.ix_(right, left)].min() > 1.5 * samples.distances[np.ix_(right, right)].max()
    near_end = (piece == 0) & (x > 0.6 * x[piece == 0].max())
    far_end = (piece == 0) & (x < -0.6 * x[piece == 0].max())
    assert samples.distances[np.ix_(right, near_end)].max() < samples.distances[np.ix_(right, far_end)].min()
    marks = np.array([np.argmax(shape.mesh.vertices[:, 0]), np.argmin(shape.mesh.vertices[:, 0])])
    to_marks = landmark_distances(shape, samples, marks)[:, : len(first)]
    assert to_marks[0, right].max() < to_marks[0, left].min()
    assert to_marks[1, left].max() < to_marks[1, right].min()
