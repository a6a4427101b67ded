"""Near-symmetries of one shape: what turns a map into another that is easily mistaken for it.

A body is nearly its own mirror image, and what is left then becomes right; with SHOT, which knows orientation, a map
that is composed with that turns into the one that swaps front and back as well. Of two such maps only a close
comparison tells which is right, so a search compares them whether or not it has come upon both by itself.

An intrinsic symmetry takes each simple eigenfunction to itself or to its negative (Ovsjanikov, Sun and Guibas 2008).
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

from kfmaps.fmap.zoomout import batched_zoomout, nearest_samples
from kfmaps.matching.quality import ShapeSamples, map_distortion

_MAX_DISTORTION = 0.12
"""Distortion up to which a self-map counts as a near-symmetry: bodies in any pose have 0.04 to 0.08, the next 0.2."""
_MAX_CANDIDATES = 12
"""Self-maps of 14 functions, least distorted first, that are refined further: symmetries are among the best eight."""
_MIN_DISPLACEMENT = 0.1  # mean distance, in units of √area, by which it must move points; less is the identity


def self_maps(of: ShapeSamples, functions: int, threads: int | None = None) -> list[np.ndarray]:
    """Return the near-symmetries of one shape, those that it has kept or :func:`find_self_maps`.

    ``functions``: as many as the maps may have.
    """
    if of.turns is not None and of.turns.shape[1] == _size(of, functions):
        return list(of.turns)
    return find_self_maps(of, functions, threads)


def with_self_maps(of: ShapeSamples, few: ShapeSamples) -> ShapeSamples:
    """Return samples with the near-symmetries of their first ones, so that they are found once for many matches.

    ``of`` and ``few``: all samples, and the first of them.
    """
    functions = few.samples.basis.functions.shape[1]
    found, k = find_self_maps(few, functions, 1), _size(few, functions)
    return replace(of, turns=np.array(found, dtype=np.float64).reshape(len(found), k, k))


def _size(of: ShapeSamples, functions: int) -> int:
    """Functions of the self-maps."""
    return min(40, functions, len(of.samples.vertices))


def find_self_maps(of: ShapeSamples, functions: int, threads: int | None = None) -> list[np.ndarray]:
    """Return functional maps ``(k, k)`` of a shape onto itself, other than the identity, that nearly keep distances.

    There are at most two, the best first, whose images are 0.08 √area apart on average; none of a shape without
    near-symmetries. The parameters are those of :func:`self_maps`.
    """
    stop = _size(of, functions)
    count = min(5, stop - 1)
    if count < 1:
        return []
    maps = np.stack([np.diag([1.0, *signs]) for signs in product((1.0, -1.0), repeat=count)])
    basis = of.samples.basis
    soon = min(14, stop)
    begun, _ = batched_zoomout(maps, basis, basis, (*range(count + 1, soon, 4), soon), None, threads)
    likely = np.sort(np.argsort(_changed(begun, of), kind="stable")[:_MAX_CANDIDATES])
    found, points = batched_zoomout(begun[likely], basis, basis, (*range(soon, stop, 4), stop), None, threads)
    judged = [map_distortion(C, of, of, at) for C, at in zip(found, points, strict=True)]
    kept: list[int] = []
    for i in np.argsort(judged, kind="stable"):
        if judged[i] > _MAX_DISTORTION or len(kept) == 2:
            break
        images = of.positions[points[i]]
        others = [of.positions, *(of.positions[points[j]] for j in kept)]
        off = [float(np.linalg.norm(images - other, axis=1).mean()) for other in others]
        if off[0] > _MIN_DISPLACEMENT and all(one > 0.08 for one in off[1:]):
            kept.append(int(i))
    return [found[i] for i in kept]


def _changed(maps: np.ndarray, of: ShapeSamples) -> np.ndarray:
    """Mean change (m,) of the distances between the first points by each of the self-maps ``maps (m, k, k)``."""
    first = of.functions[: len(of.distances)]
    images = nearest_samples(np.asarray(maps, dtype=np.float32), first, first, None)
    return np.array([np.abs(of.distances[at[:, None], at] - of.distances).mean() for at in images])
