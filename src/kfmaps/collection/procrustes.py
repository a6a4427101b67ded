"""Generalised Procrustes analysis of landmarks, warps, and robust means of points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RBFInterpolator

from kfmaps._arrays import check, refuse
from kfmaps.geometry.similarity import similarity

MAX_ROUNDS = 100


@dataclass(frozen=True, eq=False)
class Procrustes:
    """Landmarks of specimens at one position, orientation and size."""

    # (s, l, 3): centred, of centroid size 1, rotated to the consensus, which replaces missing landmarks.
    aligned: np.ndarray
    consensus: np.ndarray  # (l, 3): the mean of the aligned specimens, of centroid size 1
    centroid_sizes: np.ndarray  # (s,): root of the sum of squared distances of the landmarks from their mean
    distances: np.ndarray  # (s,): Procrustes distance of each specimen from the consensus


def generalized_procrustes(points: np.ndarray) -> Procrustes:
    """Return the generalised Procrustes analysis of landmarks (Gower 1975; Rohlf and Slice 1990), without reflections.

    ``points (s, l, 3)``: NaN for a missing landmark, which does not count in the alignment.
    """
    check(points, "landmarks", shape=(None, None, 3), finite=False)
    is_present = np.asarray(np.isfinite(points).all(axis=2))
    if (is_present.sum(axis=1) < 3).any() or not is_present.any(axis=0).all():
        got = "a specimen with fewer" if (is_present.sum(axis=1) < 3).any() else "one that all specimens lack"
        raise refuse("landmarks", "three landmarks in each specimen, each in one at least", got, "leave it out")
    first = int(np.argmax(is_present.sum(axis=1)))
    consensus = _unit(np.where(is_present[first][:, None], points[first], np.nanmean(points[first], axis=0)))
    filled, aligned = points.copy(), points
    tolerance = 1e-12  # relative change of the consensus at which the rounds end
    for _ in range(MAX_ROUNDS):
        aligned = np.stack([_align(one, present, consensus) for one, present in zip(points, is_present, strict=True)])
        new = _unit(aligned.mean(axis=0))
        change = np.abs(new - consensus).max()
        consensus = new
        if change < tolerance:
            break
    for i, present in enumerate(is_present):  # missing landmarks in the specimen's own frame, for its size
        if not present.all():
            turn, scale, shift = similarity(consensus[present], points[i][present])
            filled[i][~present] = (scale * consensus @ turn + shift)[~present]
    sizes = np.sqrt(((filled - filled.mean(axis=1, keepdims=True)) ** 2).sum(axis=(1, 2)))
    distances = np.sqrt(((aligned - consensus) ** 2).sum(axis=(1, 2)))
    return Procrustes(aligned, consensus, sizes, distances)


def is_mirror_image(points: np.ndarray, reference: np.ndarray) -> bool:
    """Return whether landmarks (l, 3) fit a mirror image of the ``reference`` much better than the reference itself.

    That happens where left and right labels are swapped, or where one of two scans is a mirror image. Landmarks that
    lie nearly in a plane fit both.
    """
    both = np.isfinite(points).all(axis=1) & np.isfinite(reference).all(axis=1)
    if both.sum() < 4:
        return False
    a, b = points[both], reference[both]
    residuals = []
    for reflect in (False, True):
        turn, scale, shift = similarity(a, b, reflect)
        residuals.append(float(((scale * a @ turn + shift - b) ** 2).sum()))
    return residuals[1] < 0.5 * residuals[0]


def _unit(points: np.ndarray) -> np.ndarray:
    centred = points - points.mean(axis=0)
    return centred / np.sqrt((centred**2).sum())


def _align(points: np.ndarray, present: np.ndarray, consensus: np.ndarray) -> np.ndarray:
    """Return one specimen rotated to the consensus, of centroid size 1, with missing landmarks of the consensus."""
    turn, scale, shift = similarity(points[present], consensus[present])
    if present.all():
        return _unit(points) @ turn
    aligned = scale * points @ turn + shift
    return _unit(np.where(present[:, None], aligned, consensus))


def thin_plate_warp(points: np.ndarray, landmarks: np.ndarray, onto: np.ndarray) -> np.ndarray:
    """Return ``points (n, 3)`` moved by the thin-plate spline that takes ``landmarks`` to ``onto`` (Bookstein 1989)."""
    return RBFInterpolator(landmarks, onto, kernel="linear", degree=1)(points)


def geometric_median(points: np.ndarray) -> np.ndarray:
    """Return the point with the least sum of distances to ``points (t, l, 3)``, (l, 3), by Weiszfeld's iteration.

    ``t`` proposals for each of ``l`` points have their mean where there are two; NaN proposals do not count.
    """
    is_present = np.asarray(np.isfinite(points).all(axis=2))
    values = np.where(is_present[..., None], points, 0.0)

    def mean(weight: np.ndarray) -> np.ndarray:
        with np.errstate(invalid="ignore"):
            return (weight[..., None] * values).sum(axis=0) / np.asarray(weight.sum(axis=0))[:, None]

    median, floor = mean(is_present.astype(np.float64)), 1e-9 * (np.abs(values).max(initial=0.0) + 1e-300)
    for _ in range(MAX_ROUNDS):
        median = mean(np.where(is_present, 1.0 / np.maximum(np.linalg.norm(values - median, axis=2), floor), 0.0))
    return median
