"""Semilandmarks: points of curves, which slide along the curve to become comparable."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import null_space, solve
from scipy.spatial.distance import cdist

_MAX_ROUNDS = 50


def bending_energy_matrix(points: np.ndarray) -> np.ndarray:
    """Return the matrix ``B`` (l, l) of the bending energy of thin-plate splines from landmarks ``points (l, 3)``.

    For one coordinate ``y`` of other landmarks, ``yᵀ B y`` is, up to a constant factor, the integral of the squared
    second derivatives of the spline that maps the landmarks to them. It is 0 for an affine map (Bookstein, Principal
    warps, 1989, with the kernel −|r| of three dimensions).
    """
    free = null_space(np.column_stack([np.ones(len(points)), points]).T)
    return free @ solve(free.T @ -cdist(points, points) @ free, free.T, assume_a="sym")


def slide_semilandmarks(
    points: np.ndarray, template: np.ndarray, curves: Sequence[tuple[np.ndarray, bool]]
) -> np.ndarray:
    """Return landmarks (l, 3) with points of curves slid along them to the least bending energy from the template.

    A curve is the cubic spline through its points. Each round is a Gauss-Newton step: the least energy along the
    tangents (Bookstein, Landmark methods for forms without landmarks, 1997; Gunz, Mitteroecker and Bookstein,
    Semilandmarks in three dimensions, 2005), followed by a step along the curve itself. Landmarks of no curve and the
    ends of open curves do not move.

    ``points`` and ``template (l, 3)``: landmarks of a specimen and of its reference; missing ones are NaN and do not
    count. ``curves``: the landmarks of each curve in order, and whether it is closed.
    """
    is_present = np.asarray(np.isfinite(points).all(axis=1) & np.isfinite(template).all(axis=1))
    paths = [_Path(points, rows[is_present[rows]], closed) for rows, closed in curves if is_present[rows].sum() > 2]
    rows = np.concatenate([np.zeros(0, dtype=np.int64), *(path.rows for path in paths)])
    used = _distinct(template, [*rows, *np.setdiff1d(np.flatnonzero(is_present), rows)])
    if not len(rows) or len(used) < 5:
        return points
    energy = np.zeros((len(points), len(points)))
    energy[np.ix_(used, used)] = bending_energy_matrix(template[used])
    ends = np.cumsum([len(path.rows) for path in paths])[:-1]
    slid = np.where(is_present[:, None], points, 0.0)
    least = float(np.einsum("ia,ij,ja->", slid, energy, slid))
    tolerance = 1e-6  # largest step, in the length of the longest curve, at which the rounds end
    longest = 0.4  # largest step in one round, in the distance to the next point of the curve: points keep their order
    for _ in range(_MAX_ROUNDS):
        tangents = np.concatenate([path.spline(path.at, 1) for path in paths])
        matrix = energy[np.ix_(rows, rows)] * (tangents @ tangents.T)
        matrix += 1e-10 * np.trace(matrix) / len(rows) * np.eye(len(rows))  # what does not bend does not slide
        steps = -solve(matrix, (tangents * (energy @ slid)[rows]).sum(axis=1), assume_a="pos")
        steps *= min(1.0, longest / max(np.abs(steps / np.concatenate([path.gaps() for path in paths])).max(), 1e-300))
        if np.abs(steps).max() <= tolerance * max(path.length for path in paths):
            break
        new = slid.copy()
        for path, step in zip(paths, np.split(steps, ends), strict=True):
            path.at = path.at + step
            new[path.rows] = path.spline(path.at)
        value = float(np.einsum("ia,ij,ja->", new, energy, new))
        if not value < least:
            break
        slid, least = new, value
    return np.where(is_present[:, None], slid, points)


class _Path:
    """A curve of a specimen, and the positions of the sliding points on it."""

    def __init__(self, points: np.ndarray, rows: np.ndarray, closed: bool) -> None:
        corners = points[np.append(rows, rows[0]) if closed else rows]
        lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
        knots = np.append(0.0, np.cumsum(np.maximum(lengths, 1e-9 * lengths.sum())))
        self.spline = CubicSpline(knots, corners, bc_type="periodic" if closed else "not-a-knot")
        self.closed, self.length = closed, float(knots[-1])
        self.rows, self.at = (rows, knots[:-1]) if closed else (rows[1:-1], knots[1:-1])

    def gaps(self) -> np.ndarray:
        """Return the distance of each point to the nearer of its neighbours, along the curve."""
        ends = (self.at[-1] - self.length, self.at[0] + self.length) if self.closed else (0.0, self.length)
        gaps = np.diff(np.concatenate([ends[:1], self.at, ends[1:]]))
        return np.minimum(gaps[:-1], gaps[1:])


def _distinct(points: np.ndarray, rows: Sequence[int]) -> np.ndarray:
    """Return those of ``rows`` that do not coincide with earlier ones, where a spline could bend without limit."""
    coincident = 1e-3  # distance, in centroid sizes, of landmarks that count as one, such as at the end of a curve
    min_distance = coincident * np.linalg.norm(points[rows] - points[rows].mean(axis=0)) if rows else 0.0
    distinct: list[int] = []
    for row in rows:
        if not distinct or np.linalg.norm(points[distinct] - points[row], axis=1).min() > min_distance:
            distinct.append(row)
    return np.array(distinct)
