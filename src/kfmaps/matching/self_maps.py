"""Self-maps: near-symmetries of one shape, by which one map becomes another that is easily mistaken for it.

A body is nearly its own mirror image, which exchanges left and right. With SHOT, which distinguishes orientations, a
map composed with that self-map turns into the one that swaps front and back as well. Only a close comparison tells
which of two such maps is right. So a search compares its best maps with their compositions with self-maps, whether or
not it has found these by itself.

An intrinsic symmetry maps each simple eigenfunction to itself or to its negative (Ovsjanikov, Sun and Guibas 2008). A
symmetry of order three or more, as that of a starfish, rotates pairs of functions with one eigenvalue. Where functions
with other symmetries happen to have one eigenvalue, as those of a table, it still takes extremities to each other.

The map of a body to its own mirror image is evidence, too: a right map of two bodies commutes with their reflections.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np

from kfmaps._arrays import Array, to_numpy
from kfmaps.fmap.convert import nearest
from kfmaps.fmap.zoomout import batched_zoomout, nearest_samples
from kfmaps.geometry.mesh import vertex_normals
from kfmaps.matching.extremity_matching import ExtremityMatch, match_extremities
from kfmaps.matching.quality import (
    ShapeSamples,
    map_distortion,
    map_quality,
    mirror_samples,
    sample_for_scoring,
    subsample,
)
from kfmaps.matching.sample_pair import (
    COARSE_SAMPLES,
    EXTREMITY_FUNCTIONS,
    STRONG,
    SamplePair,
    build_sample_pair,
    paired_map,
)
from kfmaps.matching.score import Quality, select_distinct
from kfmaps.shape import Shape

_MAX_DISTORTION = 0.12
"""Distortion up to which a self-map counts as a near-symmetry: bodies in any pose have 0.04 to 0.08, the next 0.2."""
_MAX_CANDIDATES = 12
"""Least distorted self-maps of few functions that are refined further; symmetries are among the best eight."""
_COARSE_FUNCTIONS, _FINE_FUNCTIONS = 14, 40
"""Functions of self-maps when they are chosen, and in the end."""
_MIN_DIFFERENCE = 0.08  # mean distance, in √area, between the images of two self-maps
_MIN_DISPLACEMENT = 0.1  # mean distance, in √area, by which a self-map must move points; less is the identity
_MIN_ROTATION = 0.2  # the same of a self-map that rotates the whole shape, and not a limb about its axis
_MAX_ROTATION_DISTORTION = 0.07  # of such a self-map
_MIN_ROTATION_SCORES = -3.0, -3.4  # of any such self-map, and of one that keeps SHOT; people have -3.3 and -3.5


def self_maps(shape: ShapeSamples, functions: int) -> list[np.ndarray]:
    """Return the self-maps of one shape: those that the samples have, or :func:`find_self_maps`.

    ``functions``: the most that the maps may have.
    """
    if shape.self_maps is not None and shape.self_maps.shape[1] == _size(shape, functions):
        return list(shape.self_maps)
    return find_self_maps(shape, functions)


def with_self_maps(shape: ShapeSamples) -> ShapeSamples:
    """Return samples with the self-maps and the reflection, which are found on the coarse ones among them.

    A shape that a rotation keeps, as half a turn does a table, has no single reflection.
    """
    coarse = subsample(shape, COARSE_SAMPLES)
    functions = coarse.samples.basis.functions.shape[1]
    maps, k = find_self_maps(coarse, functions), _size(coarse, functions)
    self_maps = np.array(maps, dtype=np.float64).reshape(len(maps), k, k)
    has_rotation = any(_is_rotation(C, coarse) for C in maps)
    reflection = None if has_rotation else find_reflection(coarse, maps)
    return replace(shape, self_maps=self_maps, reflection_map=reflection, has_rotation=has_rotation)


def _is_rotation(C: np.ndarray, shape: ShapeSamples) -> bool:
    """Return whether a self-map rotates the whole shape, and keeps distances, orientation and descriptors."""
    own = shape.functions[:, : len(C)]
    images = nearest(own, own @ C.T)
    quality, moved = map_quality(C, shape, shape, images), _distance(shape.positions[images], shape.positions)
    min_score = _MIN_ROTATION_SCORES[_keeps_shot(quality, shape)]
    is_near_isometric = quality.orientation > 0.5 and quality.distortion <= _MAX_ROTATION_DISTORTION
    return is_near_isometric and quality.score >= min_score and moved > _MIN_ROTATION


def self_images(shape: Shape, vertices: np.ndarray, rng: int = 0, turned: bool = False) -> np.ndarray:
    """Return the images of ``vertices (q,)`` by the self-maps that keep orientation, (m, q): numbers among them.

    ``turned``: also by the reflection and then through the body, which turns front to back. One camera's scan of a side
    fits there nearly as well.
    """
    samples = sample_for_scoring(shape, COARSE_SAMPLES, rng)
    functions = to_numpy(shape.basis.functions)[vertices]
    maps = find_self_maps(samples, functions.shape[1])

    def image(C: np.ndarray) -> np.ndarray:
        own = functions[:, : len(C)]
        return nearest(own, own @ C.T)

    images = [image(C) for C in maps if map_quality(C, samples, samples).orientation > 0.5]
    reflection = find_reflection(samples, maps) if turned else None
    if reflection is not None:
        behind = _opposite(shape.mesh.vertices[vertices], vertex_normals(shape.mesh)[vertices])
        images.append(behind[image(reflection)])
    return np.array(images, dtype=np.int64).reshape(len(images), len(vertices))


def _opposite(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Return the nearest of the points (q, 3) on the other side of a body, by their normals, for each: (q,)."""
    squares = ((points[:, None] - points) ** 2).sum(axis=2)
    return np.where(normals @ normals.T < -0.5, squares, np.inf).argmin(axis=1)


def find_reflection(shape: ShapeSamples, maps: list[np.ndarray]) -> np.ndarray | None:
    """Return the functional map ``(k, k)`` of a shape to its own mirror image; ``None`` without a single one.

    It begins with the self-``maps`` and with matches of extremities, and is refined with SHOT of the mirror image. A
    shape with several that are nearly as good, as a starfish, has none: those of two shapes would not correspond.
    """
    stop = _size(shape, shape.samples.basis.functions.shape[1])
    min_functions = 30  # with fewer the images are too coarse
    if shape.orientation is None or stop < min_functions:
        return None
    pair, size = build_sample_pair(shape, mirror_samples(shape)), EXTREMITY_FUNCTIONS
    starts = np.concatenate([*(C[None, :size, :size] for C in maps), _from_extremities(pair, size)])
    if len(starts) == 0:
        return None
    found = []
    for C, at in zip(*_refined(starts, pair, stop, guided=True), strict=True):
        quality, images = map_quality(C, pair.source, pair.target, at), shape.positions[at]
        is_near_isometric = quality.orientation > 0.5 and quality.distortion <= _MAX_DISTORTION
        if is_near_isometric and _distance(images, shape.positions) > _MIN_DISPLACEMENT:
            found.append((quality.score, C, images))
    if not found:
        return None
    best, reflection, positions = max(found, key=lambda one: one[0])
    min_margin = 1.0  # in score, over another one
    rivals = (images for score, _, images in found if score > best - min_margin)
    return reflection if all(_distance(images, positions) <= _MIN_DIFFERENCE for images in rivals) else None


def _distance(a: np.ndarray, b: np.ndarray) -> float:
    """Return the mean distance of points (q, 3)."""
    return float(np.linalg.norm(a - b, axis=1).mean())


def _size(shape: ShapeSamples, functions: int) -> int:
    """Return the number of functions of the self-maps."""
    return min(_FINE_FUNCTIONS, functions, len(shape.samples.vertices))


def find_self_maps(shape: ShapeSamples, functions: int) -> list[np.ndarray]:
    """Return functional maps ``(k, k)`` of a shape onto itself, other than the identity, that nearly keep distances.

    At most two start from signs, two from rotated pairs and two from extremities, the best of each first. Their images
    differ, but on a thin shape a rotation from extremities may lie near a reflection. A shape without near-symmetries
    has none. The parameters are those of :func:`self_maps`.
    """
    stop, pair = _size(shape, functions), build_sample_pair(shape, shape)
    count = min(5, stop - 1)
    if count < 1:
        return []
    middle = min(_COARSE_FUNCTIONS, stop)
    signs = np.stack([np.diag([1.0, *signs]) for signs in product((1.0, -1.0), repeat=count)])
    starts = _refined(signs, pair, middle)[0]
    likely = np.sort(np.argsort(_changes(starts, shape)[0], kind="stable")[:_MAX_CANDIDATES])
    kept = _least_distorted(starts[likely], pair, [], stop)
    rotations = _rotated_pairs(pair.source.samples.basis.eigenvalues[:middle])
    max_change = 0.03  # mean change of distances, in √area, up to which a coarse map that rotates a pair goes on
    if rotations:
        starts = np.concatenate([_refined(maps, pair, middle)[0] for maps in rotations])
        changes, displacements = _changes(starts, shape)
        # Most return to the identity, which needs no more refinement.
        likely = np.flatnonzero((changes < max_change) & (displacements > _MIN_DISPLACEMENT))
        kept += _least_distorted(starts[likely], pair, kept, stop)
    starts = _from_extremities(pair, min(EXTREMITY_FUNCTIONS, stop), n_compared=100, n_tried=8)
    known = [(C, images) for C, images in kept if map_quality(C, shape, shape).orientation > 0.5]
    kept += _least_distorted(starts, pair, known, stop, guided=True)
    return [C for C, _ in kept]


def _from_extremities(pair: SamplePair, size: int, n_compared: int = 50, n_tried: int = 5) -> np.ndarray:
    """Return maps ``(m, size, size)`` of a shape that take extremities to others like them.

    ``pair``: the shape with itself, or with its mirror image; ``n_tried``: matches that contradict each other, first of
    all the identity.
    """
    likely = match_extremities(pair.source, pair.target, pair.descriptor_cost, n_compared)
    tried = select_distinct(likely, ExtremityMatch.contradicts, n_tried)
    return np.array([paired_map(match, pair, size) for match in tried]).reshape(len(tried), size, size)


def _refined(maps: np.ndarray, pair: SamplePair, stop: int, guided: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Refine self-maps up to ``stop`` functions in steps of 4, ``guided`` by SHOT (:func:`batched_zoomout`)."""
    basis, sizes = pair.source.samples.basis, (*range(maps.shape[1], stop, 4), stop)
    cost = pair.matching_cost(STRONG[0]) if guided else None
    return batched_zoomout(maps, basis, basis, sizes, cost, pair.solver)


def _rotated_pairs(eigenvalues: Array) -> list[np.ndarray]:
    """Return maps ``(11, i + 2, i + 2)`` that rotate functions i and i + 1, where these have nearly one eigenvalue."""
    values = to_numpy(eigenvalues)
    # Whatever the order of the symmetry, one of these angles is near enough.
    angles = np.deg2rad(np.arange(30, 360, 30))
    rotations = np.stack([[np.cos(angles), -np.sin(angles)], [np.sin(angles), np.cos(angles)]]).transpose(2, 0, 1)
    pairs = []
    max_ratio = 1.15  # of two eigenvalues that may be one: arms in other poses make 1.03 of it. People have 1.28.
    max_high_ratio = 1.02  # the same of higher ones, which lie closer together: those of a tube turned about its axis
    for i in range(1, len(values) - 1):
        if values[i + 1] < (max_ratio if i < 4 else max_high_ratio) * values[i]:
            maps = np.tile(np.eye(i + 2), (len(rotations), 1, 1))
            maps[:, i:, i:] = rotations
            pairs.append(maps)
    return pairs


def _least_distorted(
    starts: np.ndarray,
    pair: SamplePair,
    known: list[tuple[np.ndarray, np.ndarray]],
    stop: int,
    guided: bool = False,
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return the best self-maps with ``stop`` functions, and the images of the samples by each, (q, 3).

    They differ from the identity, from each other and from those ``known``. With ``guided`` SHOT takes part in the
    refinement, and only maps are returned that nearly keep it and the orientation: without it every leg of a table may
    be turned by itself.
    """
    if len(starts) == 0:
        return []
    shape = pair.source
    maps, points = _refined(starts, pair, stop, guided)
    distortions = [map_distortion(C, shape, shape, at) for C, at in zip(maps, points, strict=True)]
    kept: list[tuple[np.ndarray, np.ndarray]] = []
    most = 2  # self-maps of each kind: from signs, from rotated pairs and from extremities
    for i in np.argsort(distortions, kind="stable"):
        if distortions[i] > _MAX_DISTORTION or len(kept) == most:
            break
        if guided and not _keeps_shot(map_quality(maps[i], shape, shape, points[i]), shape):
            continue
        images = shape.positions[points[i]]
        others = [shape.positions, *(other for _, other in (*known, *kept))]
        off = [_distance(images, other) for other in others]
        if off[0] > _MIN_DISPLACEMENT and all(one > _MIN_DIFFERENCE for one in off[1:]):
            kept.append((maps[i], images))
    return kept


def _keeps_shot(quality: Quality, shape: ShapeSamples) -> bool:
    """Return whether a self-map keeps the orientation, and SHOT as far as samples so far apart can tell.

    In units of the difference between neighbors a map onto an identical copy has 0.6, one that turns a person around
    0.95.
    """
    return quality.orientation > 0.5 and quality.descriptors < 0.85 * shape.neighbor_difference


def _changes(maps: np.ndarray, shape: ShapeSamples) -> tuple[np.ndarray, np.ndarray]:
    """Return the mean change (m,) of the distances between the first samples by each self-map of ``maps (m, k, k)``.

    Also return the mean distance (m,) by which it moves these samples.
    """
    first = shape.functions[: len(shape.distances)]
    images, own = nearest_samples(np.asarray(maps, dtype=np.float32), first, first, None), np.arange(len(first))
    changes = [np.abs(shape.distances[at[:, None], at] - shape.distances).mean() for at in images]
    return np.array(changes), np.array([shape.distances[at, own].mean() for at in images])
