"""Near-symmetries of one shape: what turns a map into another that is easily mistaken for it.

A body is nearly its own mirror image, and what is left then becomes right; with SHOT, which knows orientation, a map
that is composed with that turns into the one that swaps front and back as well. Of two such maps only a close
comparison tells which is right, so a search compares them whether or not it has come upon both by itself.

An intrinsic symmetry takes each simple eigenfunction to itself or to its negative (Ovsjanikov, Sun and Guibas 2008);
one of order three or more, as of a starfish, turns pairs of functions with one eigenvalue.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

from kfmaps._arrays import Array, to_numpy
from kfmaps.fmap.zoomout import batched_zoomout, nearest_samples
from kfmaps.matching.quality import ShapeSamples, map_distortion

_MAX_DISTORTION = 0.12
"""Distortion up to which a self-map counts as a near-symmetry: bodies in any pose have 0.04 to 0.08, the next 0.2."""
_MAX_CANDIDATES = 12
"""Self-maps of 14 functions, least distorted first, that are refined further: symmetries are among the best eight."""
_MAX_CHANGE = 0.03
"""Mean change of distances, in √area, up to which a self-map of 14 functions that turns a pair is refined further."""
_MAX_SPREAD = 1.15
"""Ratio of two eigenvalues up to which they may be one: arms in other poses make 1.03 of it. People have 1.28."""
_MIN_DISPLACEMENT = 0.1  # mean distance, in units of √area, by which it must move points; less is the identity


def self_maps(of: ShapeSamples, functions: int) -> list[np.ndarray]:
    """Return the near-symmetries of one shape, those that it has kept or :func:`find_self_maps`.

    ``functions``: as many as the maps may have.
    """
    if of.turns is not None and of.turns.shape[1] == _size(of, functions):
        return list(of.turns)
    return find_self_maps(of, functions)


def with_self_maps(of: ShapeSamples, few: ShapeSamples) -> ShapeSamples:
    """Return samples with the near-symmetries of their first ones, so that they are found once for many matches.

    ``of`` and ``few``: all samples, and the first of them.
    """
    functions = few.samples.basis.functions.shape[1]
    found, k = find_self_maps(few, functions), _size(few, functions)
    return replace(of, turns=np.array(found, dtype=np.float64).reshape(len(found), k, k))


def _size(of: ShapeSamples, functions: int) -> int:
    """Functions of the self-maps."""
    return min(40, functions, len(of.samples.vertices))


def find_self_maps(of: ShapeSamples, functions: int) -> list[np.ndarray]:
    """Return functional maps ``(k, k)`` of a shape onto itself, other than the identity, that nearly keep distances.

    There are at most two that begin with signs and two that begin with turned pairs, the best of each first, whose
    images are 0.08 √area apart on average; none of a shape without near-symmetries. The parameters are those of
    :func:`self_maps`.
    """
    stop, basis = _size(of, functions), of.samples.basis
    count = min(5, stop - 1)
    if count < 1:
        return []
    soon = min(14, stop)

    def coarse(maps: np.ndarray) -> np.ndarray:
        sizes = (*range(maps.shape[1], soon, 4), soon)
        return batched_zoomout(maps, basis, basis, sizes, None)[0]

    begun = coarse(np.stack([np.diag([1.0, *signs]) for signs in product((1.0, -1.0), repeat=count)]))
    likely = np.sort(np.argsort(_changed(begun, of)[0], kind="stable")[:_MAX_CANDIDATES])
    kept = _least_distorted(begun[likely], of, [], stop)
    pairs = _turned_pairs(basis.eigenvalues[:soon])
    if pairs:
        begun = np.concatenate([coarse(maps) for maps in pairs])
        changed, moved = _changed(begun, of)
        # Most come back to the identity, which needs no more refinement.
        likely = np.flatnonzero((changed < _MAX_CHANGE) & (moved > _MIN_DISPLACEMENT))
        kept += _least_distorted(begun[likely], of, kept, stop)
    return [C for C, _ in kept]


def _turned_pairs(eigenvalues: Array) -> list[np.ndarray]:
    """Return maps ``(11, i + 2, i + 2)`` that turn functions i and i + 1, where these have nearly one eigenvalue."""
    values = to_numpy(eigenvalues)
    # Whatever the order of the symmetry, one of these angles is near enough.
    angles = np.deg2rad(np.arange(30, 360, 30))
    turns = np.stack([[np.cos(angles), -np.sin(angles)], [np.sin(angles), np.cos(angles)]]).transpose(2, 0, 1)
    found = []
    for i in range(1, min(4, len(values) - 1)):
        if values[i + 1] < _MAX_SPREAD * values[i]:
            maps = np.tile(np.eye(i + 2), (len(turns), 1, 1))
            maps[:, i:, i:] = turns
            found.append(maps)
    return found


def _least_distorted(
    begun: np.ndarray, of: ShapeSamples, known: list[tuple[np.ndarray, np.ndarray]], stop: int
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the best of ``begun`` with ``stop`` functions, and the images of the samples by each, (q, 3).

    There are at most two. They differ from the identity, from each other and from those ``known``.
    """
    if len(begun) == 0:
        return []
    basis = of.samples.basis
    found, points = batched_zoomout(begun, basis, basis, (*range(begun.shape[1], stop, 4), stop), None)
    judged = [map_distortion(C, of, of, at) for C, at in zip(found, points, strict=True)]
    kept: list[tuple[np.ndarray, np.ndarray]] = []
    for i in np.argsort(judged, kind="stable"):
        if judged[i] > _MAX_DISTORTION or len(kept) == 2:
            break
        images = of.positions[points[i]]
        others = [of.positions, *(other for _, other in (*known, *kept))]
        off = [float(np.linalg.norm(images - other, axis=1).mean()) for other in others]
        if off[0] > _MIN_DISPLACEMENT and all(one > 0.08 for one in off[1:]):
            kept.append((found[i], images))
    return kept


def _changed(maps: np.ndarray, of: ShapeSamples) -> tuple[np.ndarray, np.ndarray]:
    """Mean change (m,) of the distances between the first points by each of the self-maps ``maps (m, k, k)``.

    Also the mean distance (m,) by which it moves these points.
    """
    first = of.functions[: len(of.distances)]
    images, own = nearest_samples(np.asarray(maps, dtype=np.float32), first, first, None), np.arange(len(first))
    changed = [np.abs(of.distances[at[:, None], at] - of.distances).mean() for at in images]
    return np.array(changed), np.array([of.distances[at, own].mean() for at in images])
