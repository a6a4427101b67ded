"""Semilandmarks slide along their curves to where the bending energy is least."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import RBFInterpolator

from kfmaps.collection import semilandmarks
from kfmaps.collection.procrustes import thin_plate_warp
from kfmaps.collection.semilandmarks import bending_energy_matrix, slide_semilandmarks

GUARDS = ("kfmaps.collection.semilandmarks",)

RNG = np.random.default_rng(3)
FIXED = RNG.normal(size=(8, 3))
AFFINE = np.eye(3) + 0.3 * RNG.normal(size=(3, 3))
LINE = np.array([[-1.0, 0.5, 0.2]]) + np.linspace(0, 1, 7)[:, None] * np.array([[2.0, -0.6, 0.9]])
ANGLES = np.linspace(0, 2 * np.pi, 12, endpoint=False)
CIRCLE = np.column_stack([np.cos(ANGLES), np.sin(ANGLES), 0.3 * np.sin(2 * ANGLES)])
OPEN = (np.arange(8, 15), False)


def energy(template: np.ndarray, points: np.ndarray) -> float:
    return float(np.einsum("ia,ij,ja->", points, bending_energy_matrix(template), points))


def test_affine_maps_do_not_bend_and_all_others_do() -> None:
    matrix = bending_energy_matrix(FIXED)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12)
    np.testing.assert_allclose(matrix @ np.column_stack([np.ones(8), FIXED]), 0, atol=1e-10)
    values = np.linalg.eigvalsh(matrix)
    assert (np.abs(values) > 1e-9).sum() == 4
    assert values.min() > -1e-12


def test_the_energy_is_that_of_the_spline() -> None:
    """The integral of squared second derivatives is 8π times the quadratic form, in three dimensions."""
    onto = FIXED[:, 0] + 0.3 * RNG.normal(size=8)
    spline = RBFInterpolator(FIXED, onto[:, None], kernel="linear", degree=1)
    weights = np.linalg.solve(
        np.block([
            [-np.linalg.norm(FIXED[:, None] - FIXED, axis=2), np.ones((8, 1)), FIXED],
            [np.ones((1, 8)), np.zeros((1, 4))],
            [FIXED.T, np.zeros((3, 4))],
        ]),
        np.append(onto, np.zeros(4)),
    )[:8]  # fmt: skip
    np.testing.assert_allclose(bending_energy_matrix(FIXED) @ onto, weights, rtol=1e-8)
    at = RNG.normal(size=(5, 3))
    kernel = -np.linalg.norm(at[:, None] - FIXED, axis=2)
    rest = spline(at)[:, 0] - kernel @ weights  # affine: second differences vanish
    design = np.column_stack([np.ones(5), at])
    np.testing.assert_allclose(design @ np.linalg.lstsq(design, rest, rcond=None)[0], rest, atol=1e-9)


def test_points_of_a_straight_curve_find_back_to_where_an_affine_map_puts_them() -> None:
    template = np.vstack([FIXED, LINE])
    right = template @ AFFINE + 2
    moved = right.copy()
    moved[9:14] += np.array([0.08, -0.06, 0.07, 0.05, -0.09])[:, None] * (right[14] - right[8])
    np.testing.assert_allclose(slide_semilandmarks(moved, template, [OPEN]), right, atol=1e-4)
    np.testing.assert_allclose(slide_semilandmarks(right, template, [OPEN]), right, atol=1e-6)


def test_fixed_landmarks_and_ends_stay_and_the_energy_falls_to_a_minimum() -> None:
    template = np.vstack([FIXED, LINE, CIRCLE])
    curves = [OPEN, (np.arange(15, 27), True)]
    points = thin_plate_warp(template, FIXED, FIXED + 0.2 * RNG.normal(size=(8, 3)))
    uneven = ANGLES + 0.15 * RNG.normal(size=12)
    circle = np.column_stack([np.cos(uneven), np.sin(uneven), 0.3 * np.sin(2 * uneven)])
    points[15:] = thin_plate_warp(circle, FIXED, points[:8])
    slid = slide_semilandmarks(points, template, curves)
    still = [*range(9), 14]
    np.testing.assert_array_equal(slid[still], points[still])
    least = energy(template, slid)
    assert least < 0.6 * energy(template, points)
    for row in (*range(9, 14), *range(15, 27)):  # along the tangent of its neighbours no point would save energy
        near = {15: (26, 16), 26: (25, 15)}.get(row, (row - 1, row + 1))
        for step in (-0.03, 0.03):
            tried = slid.copy()
            tried[row] += step * (slid[near[1]] - slid[near[0]])
            assert energy(template, tried) > least
    order = np.unwrap(np.arctan2(*(slid[15:, :2] - slid[15:, :2].mean(axis=0)).T[::-1]))
    assert (np.diff(order) > 0).all()


@pytest.mark.parametrize("unit", [100, 1e-6])
def test_scale_and_position_change_nothing(unit: float) -> None:
    template = np.vstack([FIXED, LINE])
    points = template + 0.1 * RNG.normal(size=template.shape)
    slid = slide_semilandmarks(points, template, [OPEN])
    again = slide_semilandmarks(unit * (points + 7), 0.01 * template - 3, [OPEN])
    np.testing.assert_allclose(again / unit - 7, slid, atol=1e-5)


def test_missing_points_take_no_part() -> None:
    template = np.vstack([FIXED, LINE])
    points = template + 0.1 * RNG.normal(size=template.shape)
    gone = points.copy()
    gone[[2, 11]] = np.nan
    slid = slide_semilandmarks(gone, template, [OPEN])
    keep = np.setdiff1d(np.arange(15), [2, 11])
    fewer = slide_semilandmarks(points[keep], template[keep], [(np.arange(7, 13), False)])
    np.testing.assert_allclose(slid[keep], fewer)
    assert np.isnan(slid[[2, 11]]).all()


def test_nothing_slides_where_there_is_no_curve_or_among_four_points() -> None:
    points = np.vstack([FIXED, LINE])
    for curves in ([], [(np.arange(8, 10), False)]):
        assert slide_semilandmarks(points, points[::-1], curves) is points
    points = np.vstack([LINE[[0, 2, 6]], LINE[[0, 6]], FIXED[:1]])  # a spline through four does not bend
    assert slide_semilandmarks(points, points, [(np.arange(3), False)]) is points


def test_a_landmark_at_the_end_of_a_curve_counts_once() -> None:
    """Otherwise the energy of two landmarks in one place has no bound, and pushes their neighbours about."""
    template = np.vstack([FIXED, LINE])
    points = template @ AFFINE + 0.05 * RNG.normal(size=template.shape)
    slid = slide_semilandmarks(points, template, [OPEN])
    twice = [np.vstack([one, one[8] + 1e-12]) for one in (points, template)]
    np.testing.assert_allclose(slide_semilandmarks(twice[0], twice[1], [OPEN])[:15], slid, atol=1e-6)


def crooked() -> tuple[np.ndarray, np.ndarray]:
    """A template with a closed curve, and a specimen in which it is bent and unevenly sampled."""
    template = np.vstack([FIXED, CIRCLE])
    angles = ANGLES + 0.1 * np.sin(3 * ANGLES + 1)
    uneven = np.column_stack([np.cos(angles), np.sin(angles), 0.3 * np.sin(2 * angles)])
    return thin_plate_warp(np.vstack([FIXED, uneven]), FIXED, FIXED + 0.1 * np.sin(7 * FIXED)), template


def test_a_closed_curve_begins_nowhere() -> None:
    points, template = crooked()
    rows = np.arange(8, 20)
    slid, again = (slide_semilandmarks(points, template, [(np.roll(rows, k), True)]) for k in (0, 5))
    assert np.abs(slid - points).max() > 0.02
    np.testing.assert_allclose(again, slid, atol=1e-4)


def test_few_rounds_are_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    points, template = crooked()
    curves = [(np.arange(8, 20), True)]
    slid = slide_semilandmarks(points, template, curves)
    monkeypatch.setattr(semilandmarks, "_MAX_ROUNDS", 2)
    np.testing.assert_allclose(slide_semilandmarks(points, template, curves), slid, atol=1e-4)


def test_points_keep_their_order() -> None:
    """Even where the energy is less if two of them change places."""
    template = np.vstack([FIXED, LINE])
    points = template.copy()
    template[[10, 11]] = template[[11, 10]]
    along = (slide_semilandmarks(points, template, [OPEN])[8:] - LINE[0]) @ (LINE[-1] - LINE[0])
    assert (np.diff(along) > 0).all()
