"""Scans of one camera: how they are known, and that the views of a whole are what they are compared with."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import KDTree

from kfmaps import datasets
from kfmaps.config import Partial
from kfmaps.datasets import largest_piece
from kfmaps.geometry.mesh import Mesh, face_normals, spread_directions, surface_area, unit_area, vertex_normals
from kfmaps.matching.partial.detect import detect_part
from kfmaps.matching.partial.one_view import is_view_of, views
from kfmaps.matching.partial.place_part import PartTask, place_part
from kfmaps.matching.partial.samples import PartPair, part_samples
from kfmaps.matching.partial.scale_search import TRIALS, shot_similarity
from kfmaps.matching.score import SCORE

GUARDS = ("kfmaps.matching.partial.one_view", "kfmaps.matching.partial.samples")

DIRECTION = np.array([0.2, -0.3, 0.93])


def seen(mesh, direction):
    """The largest piece that is turned to a camera, and its vertices' old numbers."""
    return largest_piece(mesh, vertex_normals(mesh) @ direction > 0.15)


@pytest.fixture(scope="module")
def scan():
    """A creature at unit area, what a camera sees of another pose, and the true vertex of each of its vertices."""
    pair = datasets.two_poses(3000, rng=0)
    part, own = seen(pair.target, DIRECTION)
    return unit_area(pair.source), unit_area(part), np.asarray(pair.truth)[own]


def test_a_scan_of_one_camera_is_known_by_its_normals(scan):
    whole, part, _ = scan
    assert is_view_of(part, whole)
    assert not is_view_of(whole, part)
    assert not is_view_of(part, part)  # the other is no whole
    cut, _ = largest_piece(whole, whole.vertices[:, 0] > np.median(whole.vertices[:, 0]))
    assert not is_view_of(cut, whole)
    assert detect_part(whole, part).is_one_view
    assert detect_part(part, whole).is_one_view
    assert not detect_part(whole, cut).is_one_view


@pytest.mark.parametrize(("turned_away", "is_view"), [(0.1, True), (0.2, False)])
def test_a_few_normals_may_be_turned_away(turned_away, is_view):
    """Two flat squares, the second turned round, of a share of the area."""
    square, faces = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    side = np.sqrt(turned_away / (1 - turned_away))
    mesh = Mesh(np.concatenate([square, 5 + side * square]), np.concatenate([faces, 4 + faces[:, ::-1]]))
    assert is_view_of(mesh, datasets.sphere(200)) == is_view


def test_views_are_what_is_turned_to_directions_all_around():
    directions = spread_directions(24)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0)
    apart = np.sort(np.degrees(np.arccos(np.clip(directions @ directions.T, -1, 1))), axis=1)[:, 1]
    assert apart.min() > 30 > 0.5 * apart.max()
    sphere = datasets.sphere(2000)
    found = views(sphere)
    assert len(found) == 24
    for faces, direction in zip(found, directions, strict=True):
        np.testing.assert_array_equal(faces, face_normals(sphere) @ direction > 0.1)
        assert surface_area(Mesh(sphere.vertices, sphere.faces[faces])) == pytest.approx(2 * np.pi * 0.9, rel=0.02)


def test_descriptors_of_views_are_those_of_the_whole_where_no_ball_is_cut(scan):
    """In balls of the same size, whatever the area of the view."""
    samples, radius = part_samples(scan[0], 300), 0.06
    whole, near = (
        samples.shot(radius),
        KDTree(samples.mesh.vertices).query_ball_point(samples.mesh.vertices[samples.samples], 1.3 * radius),
    )
    alike = []
    for faces, (at, found) in zip(views(samples.mesh), samples.shot_of_views(radius), strict=True):
        is_seen = np.isin(np.arange(len(samples.mesh.vertices)), samples.mesh.faces[faces])
        np.testing.assert_array_equal(at, np.flatnonzero(is_seen[samples.samples]))
        is_uncut = [bool(is_seen[near[i]].all()) for i in at]
        alike.append((found * whole[at]).sum(axis=1)[is_uncut])
    assert len(np.concatenate(alike)) > 300
    assert np.quantile(np.concatenate(alike), 0.05) > 0.99
    assert samples.shot_of_views(radius) is samples.shot_of_views(radius)


def test_the_right_place_looks_alike_from_one_side(scan):
    """The share of the whole's samples that look more like a sample than its place falls by more than half."""
    whole, part, truth = scan
    pair = PartPair(part_samples(part, 150), part_samples(whole, 500), is_one_view=True)
    scale = float(np.sqrt(surface_area(Mesh(whole.vertices, truth[part.faces]))))
    place = np.asarray(KDTree(whole.vertices[pair.whole.samples]).query(whole.vertices[truth[pair.part.samples]])[1])
    better = []
    for one in (pair, replace(pair, is_one_view=False)):
        similarity = shot_similarity(one, scale, TRIALS[1])
        own = similarity[np.arange(len(place)), place]
        better.append(np.median((similarity > own[:, None]).mean(axis=1)))
    assert better[0] < 0.5 * better[1]
    small = replace(pair, file_scale=0.3)  # the weights of samples near the boundary are for other small parts
    both = [shot_similarity(one, scale, TRIALS[1]) for one in (pair, small)]
    np.testing.assert_array_equal(both[0], both[1])


def test_what_one_camera_sees_is_placed(scan):
    whole, part, truth = scan
    task = PartTask(part, whole, Partial())
    assert task.is_one_view
    found = place_part(task)
    assert found.calibration is SCORE.part.calibration_of_view
    assert np.linalg.norm(found.registration.vertices - whole.vertices[truth], axis=1).mean() < 0.05
