"""Transfer morph targets (shape keys), skinning weights and skeletons by a map."""

from __future__ import annotations

from dataclasses import replace
from graphlib import TopologicalSorter

import numpy as np

from kfmaps.fmap.convert import nearest_reached
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.arap import build_arap, edge_covariances, nearest_rotations, spread_matrices
from kfmaps.geometry.mesh import MIRROR, Mesh, vertex_areas
from kfmaps.geometry.similarity import similarity
from kfmaps.io.mapcontent import check_map
from kfmaps.io.record import MeshFile, Skin
from kfmaps.io.transfer import point_map
from kfmaps.matching.result import Match

_SURROUNDINGS = 1e-3  # share of the area over which the rotation and scale of the map are averaged
_MAX_FACTOR = 2.5  # largest ratio of the scale around a vertex to that of the whole surface, or its inverse
_OWN = 0.1
"""Weight, for the position of a joint, of a vertex that follows this joint alone. A vertex that also follows the parent
joint counts up to ten times as much, since the joint lies there."""


def transfer_character(source: MeshFile, target: MeshFile, target_to_source: np.ndarray | Match) -> MeshFile:
    """Return ``target`` with the source's morph targets and skin; unchanged where the source has none.

    ``source`` and ``target``: surfaces; ``target_to_source (n_t,)``: vertices without a counterpart (−1) do not move
    with morphs, and follow the joints of the nearest vertex that has one.
    """
    if not source.morphs and source.skin is None:
        return target
    mesh = target.mesh
    points = check_map(target_to_source, len(source.mesh.vertices), len(mesh.vertices), partial=True)
    places, matched = point_map(target_to_source, source.mesh, points), points >= 0
    mirrored = getattr(target_to_source, "orientation", "preserving") == "reversing"
    morphs, skin = {}, None
    if source.morphs:
        turns = local_similarities(source.mesh, mesh, places, mirrored) * matched[:, None, None]
        morphs = {name: turn_morph(offsets, source.mesh, places, turns) for name, offsets in source.morphs.items()}
    if source.skin is not None:
        nearest = nearest_reached(mesh, np.where(matched, np.arange(len(points)), -1))
        nearest_points = PointMap(places.faces[nearest], places.weights[nearest])
        skin = transfer_skin(source.skin, source.mesh, mesh, nearest_points, mirrored)
    return replace(target, morphs=morphs, skin=skin)


def local_similarities(source: Mesh, target: Mesh, places: PointMap, mirrored: bool = False) -> np.ndarray:
    """Return the rotation and scale from the source to the target around each target vertex, (n_t, 3, 3).

    Each is a rotation times a factor, fitted by least squares to the edges around the vertex and its neighbours, as in
    as-rigid-as-possible deformation (Sorkine and Alexa 2007).

    ``places``: for each target vertex; ``mirrored``: whether the map leads to the target's mirror image; then
    they are reflections.
    """
    rest = target.vertices * MIRROR if mirrored else target.vertices
    energy, areas = build_arap(Mesh(rest, target.faces)), vertex_areas(target)
    images = point_positions(places, source)
    area = areas.sum()
    spread = spread_matrices(energy, np.maximum(areas, 1e-9 * area), _SURROUNDINGS * area)
    image_covariances, rest_covariances = (spread(edge_covariances(energy, x)) for x in (images, rest))
    turns = nearest_rotations(image_covariances)  # from the target's edges to those of their images
    norms = np.trace(rest_covariances, axis1=1, axis2=2), np.einsum("tij,tij->t", turns, image_covariances)
    typical = norms[0].sum() / max(norms[1].sum(), 1e-300)
    factor = norms[0] / np.maximum(norms[1], 1e-300)
    factor = np.clip(factor, typical / _MAX_FACTOR, typical * _MAX_FACTOR)
    result = factor[:, None, None] * turns.transpose(0, 2, 1)
    return result * MIRROR[:, None] if mirrored else result


def turn_morph(offsets: np.ndarray, source: Mesh, places: PointMap, turns: np.ndarray) -> np.ndarray:
    """Return a morph target's displacements on the target, (n_t, 3), rotated and scaled with the surface.

    ``offsets (n_s, 3)``: those on the source; ``turns (n_t, 3, 3)``: from :func:`local_similarities`.
    """
    return np.einsum("tij,tj->ti", turns, point_positions(places, Mesh(offsets, source.faces)))


def transfer_skin(skin: Skin, source: Mesh, target: Mesh, places: PointMap, mirrored: bool = False) -> Skin:
    """Return the source's skin on the target.

    Weights are mixed inside triangles. Each joint moves by the similarity that fits the surface around it best: the
    vertices that follow it and, ten times as much, those that follow the joint above too. Its axes turn with it. A
    joint that nothing follows moves with the ones below it, or else with the one above.

    ``places``: for each target vertex; ``mirrored``: whether the map is one to the target's mirror image.
    """
    weights = np.einsum("ti,tij->tj", places.weights, skin.weights[source.faces[places.faces]])
    total = weights.sum(axis=1, keepdims=True)
    weights = np.divide(weights, total, out=np.zeros_like(weights), where=total > 0)
    images, areas = point_positions(places, source), vertex_areas(target)
    joints = len(skin.names)
    parent_of = np.where(skin.parents < 0, np.arange(joints), skin.parents)
    influence = areas[:, None] * weights * (_OWN + np.where(parent_of == np.arange(joints), 0, weights[:, parent_of]))
    tree = TopologicalSorter({j: [parent] for j, parent in enumerate(skin.parents.tolist())})
    order = [j for j in tree.static_order() if j >= 0]  # each joint after the one above it
    enough = 1e-6 * areas.sum()
    for j in reversed(order):  # a joint without weight has that of the ones below it
        if influence[:, j].sum() < enough:
            influence[:, j] = influence[:, skin.parents == j].sum(axis=1)
    matrices = np.array(skin.matrices)
    moves: dict[int, np.ndarray] = {-1: _weighted_similarity(images, target.vertices, areas, mirrored)}
    for j in order:
        is_free = influence[:, j].sum() < enough
        parent = int(skin.parents[j])
        moves[j] = (
            moves[parent] if is_free else _weighted_similarity(images, target.vertices, influence[:, j], mirrored)
        )
        linear = moves[j][:3, :3]
        scale = np.cbrt(abs(np.linalg.det(linear)))
        matrices[j, :3, :3] = linear / max(scale, 1e-300) @ skin.matrices[j, :3, :3]
        if mirrored:
            matrices[j, :3, 0] *= -1  # a joint's frame is right-handed
        matrices[j, :3, 3] = linear @ skin.matrices[j, :3, 3] + moves[j][:3, 3]
    return Skin(skin.names, skin.parents, matrices, weights)


def _weighted_similarity(points: np.ndarray, onto: np.ndarray, weights: np.ndarray, mirrored: bool) -> np.ndarray:
    """Return the similarity (4, 4) that best maps weighted points (n, 3) to others; a reflection if ``mirrored``."""
    ends = onto * MIRROR if mirrored else onto
    turn, scale, shift = similarity(points, ends, weights=weights)
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = scale * turn.T, shift
    return np.diag([*MIRROR, 1.0]) @ result if mirrored else result
