"""Procrustes analysis, principal components, and medians of landmarks."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial import procrustes
from scipy.stats import special_ortho_group

from kfmaps._arrays import InvalidInput
from kfmaps.collection.differences import components
from kfmaps.collection.procrustes import (
    generalized_procrustes,
    geometric_median,
    is_mirror_image,
    thin_plate_warp,
)
from kfmaps.geometry.similarity import similarity

GUARDS = ("kfmaps.collection.procrustes", "kfmaps.geometry.similarity")


@pytest.fixture
def shapes() -> np.ndarray:
    """Twelve specimens of nine landmarks, each a little different, anywhere and of any size."""
    rng = np.random.default_rng(1)
    mean = rng.normal(size=(9, 3))
    points = mean + 0.05 * rng.normal(size=(12, 9, 3))
    turns = special_ortho_group.rvs(3, size=12, random_state=rng)
    return rng.uniform(1, 5, (12, 1, 1)) * points @ turns + rng.normal(size=(12, 1, 3))


def test_position_orientation_and_size_do_not_count(shapes: np.ndarray) -> None:
    found = generalized_procrustes(shapes)
    moved = shapes.copy()
    moved[3] = 7 * shapes[3] @ special_ortho_group.rvs(3, random_state=0) + 4
    again = generalized_procrustes(moved)
    np.testing.assert_allclose(again.aligned, found.aligned, atol=1e-6)
    np.testing.assert_allclose(again.centroid_sizes[3], 7 * found.centroid_sizes[3])
    np.testing.assert_allclose(found.aligned.mean(axis=1), 0, atol=1e-12)
    np.testing.assert_allclose((found.aligned**2).sum(axis=(1, 2)), 1)
    mean = found.aligned.mean(axis=0)
    np.testing.assert_allclose(found.consensus, mean / np.linalg.norm(mean), atol=1e-9)
    np.testing.assert_allclose(found.distances, np.linalg.norm(found.aligned - found.consensus, axis=(1, 2)))
    for one in found.aligned:
        np.testing.assert_allclose(similarity(one, found.consensus)[0], np.eye(3), atol=1e-9)


def test_a_similarity_reflects_only_where_it_may(shapes: np.ndarray) -> None:
    points = shapes[0]
    mirrored = points * [-1.0, 1.0, 1.0]
    assert np.linalg.det(similarity(points, mirrored)[0]) == pytest.approx(1)
    turn, scale, shift = similarity(points, mirrored, reflect=True)
    assert np.linalg.det(turn) == pytest.approx(-1)
    np.testing.assert_allclose(scale * points @ turn + shift, mirrored, atol=1e-12)


def test_two_specimens_agree_with_scipy(shapes: np.ndarray) -> None:
    a, b = shapes[:2]
    turn, scale, shift = similarity(a, b)
    fitted = scale * a @ turn + shift
    size = ((b - b.mean(axis=0)) ** 2).sum()
    assert ((fitted - b) ** 2).sum() / size == pytest.approx(procrustes(b, a)[2])
    assert np.linalg.det(turn) == pytest.approx(1)


def test_missing_landmarks_do_not_count(shapes: np.ndarray) -> None:
    holes = shapes.copy()
    holes[2, 4] = np.nan
    found = generalized_procrustes(holes)
    whole = generalized_procrustes(shapes)
    assert np.isfinite(found.aligned).all()
    rest = np.arange(9) != 4
    assert np.abs(found.aligned[2][rest] - whole.aligned[2][rest]).max() < 0.02
    np.testing.assert_allclose(found.centroid_sizes[2], whole.centroid_sizes[2], rtol=0.02)
    exact = np.stack([shapes[0], 2 * shapes[0] + 1, shapes[0]])
    exact[1, 4] = np.nan
    one = generalized_procrustes(exact)
    np.testing.assert_allclose(one.aligned[1], one.aligned[0], atol=1e-6)
    np.testing.assert_allclose(one.centroid_sizes[1], 2 * one.centroid_sizes[0], rtol=1e-6)
    with pytest.raises(InvalidInput, match="three landmarks"):
        generalized_procrustes(np.where(np.arange(9)[:, None] < 2, shapes, np.nan))


def test_components_are_those_of_the_covariance(shapes: np.ndarray) -> None:
    aligned = generalized_procrustes(shapes).aligned
    found = components(aligned)
    flat = aligned.reshape(12, -1)
    values = np.sort(np.linalg.eigvalsh(np.cov(flat.T)))[::-1]
    np.testing.assert_allclose(found.variances, values[: len(found.variances)], atol=1e-12)
    np.testing.assert_allclose(found.variances, found.scores.var(axis=0, ddof=1))
    loads = found.directions.reshape(len(found.variances), -1)
    np.testing.assert_allclose(loads @ loads.T, np.eye(len(loads)), atol=1e-9)
    np.testing.assert_allclose(flat.mean(axis=0) + found.scores @ loads, flat, atol=1e-9)
    assert (loads[np.arange(len(loads)), np.abs(loads).argmax(axis=1)] > 0).all()


def test_mirror_images_are_told(shapes: np.ndarray) -> None:
    for one in shapes[1:]:
        assert not is_mirror_image(one, shapes[0])
        assert is_mirror_image(one * [-1, 1, 1], shapes[0])
    both = np.concatenate([shapes[0], shapes[0] * [-1, 1, 1]])  # left and right of one animal
    swapped = np.concatenate([both[9:], both[:9]])
    assert is_mirror_image(swapped, both)
    flat = shapes[0] * [1, 1, 0]
    assert not is_mirror_image(flat * [-1, 1, 1], flat)


def test_the_spline_takes_landmarks_where_they_belong(shapes: np.ndarray) -> None:
    a, b = shapes[:2]
    np.testing.assert_allclose(thin_plate_warp(a, a, b), b, atol=1e-8)
    rng = np.random.default_rng(2)
    affine, points = rng.normal(size=(3, 3)), rng.normal(size=(30, 3))
    np.testing.assert_allclose(thin_plate_warp(points, a, a @ affine + 2), points @ affine + 2, atol=1e-7)


def test_the_median_has_the_least_sum_of_distances() -> None:
    rng = np.random.default_rng(3)
    points = rng.normal(size=(5, 4, 3))
    points[0, 1] = np.nan
    points[4, 2] = 50.0  # one that is far off hardly matters
    found = geometric_median(points)
    for i in range(4):
        own = points[:, i][np.isfinite(points[:, i, 0])]
        best = minimize(lambda x, own=own: np.linalg.norm(own - x, axis=1).sum(), own.mean(axis=0), tol=1e-12)
        np.testing.assert_allclose(found[i], best.x, atol=1e-3)
    np.testing.assert_allclose(geometric_median(points[1:3]), points[1:3].mean(axis=0))
    np.testing.assert_allclose(geometric_median(points[2:3]), points[2])
    assert np.isnan(geometric_median(np.full((2, 1, 3), np.nan))).all()
