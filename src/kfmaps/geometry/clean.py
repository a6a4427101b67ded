"""Mesh cleaning: seams are welded (:mod:`kfmaps.geometry.weld`), unused vertices and specks left out, spikes flattened.

A :class:`CleanedMesh` has the numbers of the given vertices and of those that are left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.spatial import KDTree

from kfmaps.geometry.cloud_surface import roughness
from kfmaps.geometry.connectivity import (
    half_edges_by_edge,
    manifold_patches,
    mesh_edges,
    proper_faces,
    renumbering,
)
from kfmaps.geometry.face_orientation import doubled_faces, inward_faces, turn_faces
from kfmaps.geometry.mesh import Mesh, component_areas, face_areas
from kfmaps.geometry.subdivision import interpolating_subdivision, is_polyhedral, split_long_edges
from kfmaps.geometry.weld import weld_vertices

_MAX_SPECK_AREA = 0.005
"""Area of a component or fin, over that of the largest component, below which it is a speck: one of 200 samples."""

_MIN_SPIKE, _MIN_SHARPNESS = 4.0, 1.5
"""Least height of a spike over the mean length of the edges, and over the mean distance of its neighbours from their
mean."""

_MAX_ROUGHNESS = 0.145
"""Roughness (:func:`.cloud_surface.roughness`) above which a mesh is smoothed; clean bodies have at most 0.12."""
_STEPS_PER_VERTEX, _MAX_STEPS = 1 / 500, 100
"""Pairs of smoothing steps over the number of vertices, and the most of them."""

_LONGEST_EDGES, _MAX_VERTICES = 0.05 * 1.2 ** np.arange(8), 6_000
"""Longest edges in √area of a mesh whose long faces are divided: the first with which it has at most so many vertices,
or twice the given ones, else the last."""


@dataclass(frozen=True, eq=False)
class CleanedMesh:
    """A cleaned mesh of ``m`` vertices and the numbers of its ``n`` original ones; made by :func:`clean_mesh`."""

    mesh: Mesh  # Its faces have three different corners. The given mesh itself where there is nothing to clean.
    to_original: np.ndarray  # (m,): original number of each vertex, ascending; of welded vertices the one that stays
    to_clean: np.ndarray  # (n,): cleaned number of each original vertex
    unreferenced: np.ndarray  # (n,) bool: original vertices that no face uses; they have the number of the nearest
    faces_to_original: np.ndarray  # (g,): original number of each face, ascending
    n_welded: int = 0  # original vertices that are welded to another one
    specks: int = 0  # components and fins left out
    doubled: int = 0  # faces left out that coincide with another one
    turned: np.ndarray | None = None  # (g,) bool: faces with the orientation reversed; ``None`` where none is
    # (g, 3, 3): barycentric coordinates of each face's corners in the face that it is a piece of; ``None`` where faces
    # are not divided (:func:`divide_mesh`).
    corners: np.ndarray | None = None

    @property
    def whole(self) -> bool:
        """Whether no vertex is welded, left out or added."""
        return len(self.to_original) == len(self.to_clean)


def clean_mesh(mesh: Mesh, specks: bool = False) -> CleanedMesh:
    """Return a mesh with its vertices welded, without degenerate faces and vertices that no other face uses.

    ``mesh``: its face numbers within range; ``specks``: whether to leave out components, and fins that stand on an
    edge, whose area is less than 0.5 % of that of the largest component.
    """
    n = len(mesh.vertices)
    first = weld_vertices(mesh)
    numbers = np.arange(n)
    n_specks, faces, rows = 0, mesh.faces, numbers[:0]
    if len(mesh.faces) == 0:
        to_original, is_used = np.unique(first), np.ones(n, dtype=bool)
    else:
        faces = first[mesh.faces]
        rows = np.flatnonzero(proper_faces(faces))
        if specks:
            is_body, n_specks = _body_faces(Mesh(mesh.vertices, faces[rows]))
            rows = rows[is_body]
        faces = faces[rows]
        is_used = np.bincount(faces.ravel(), minlength=n) > 0
        to_original, is_used = np.flatnonzero(is_used), is_used[first]
    if len(to_original) == n:
        cleaned = mesh if len(faces) == len(mesh.faces) else Mesh(mesh.vertices, faces)
        return CleanedMesh(cleaned, numbers, numbers, np.zeros(n, dtype=bool), rows)
    number = renumbering(to_original, n)
    to_clean = number[first]
    if not is_used.all() and len(to_original):
        to_clean[~is_used] = KDTree(mesh.vertices[to_original]).query(mesh.vertices[~is_used])[1]
    cleaned, n_welded = Mesh(mesh.vertices[to_original], number[faces]), int((first != numbers).sum())
    return CleanedMesh(cleaned, to_original, to_clean, ~is_used, rows, n_welded, n_specks)


def face_outward(part: CleanedMesh) -> CleanedMesh:
    """Return a cleaned mesh without second sides of faces, oriented outward.

    A few doubled faces are folds of a closed surface; many are second sides and are left out. An open surface, whose
    outside is unknown, keeps the orientation of most of its area (:func:`~.face_orientation.inward_faces`).
    """
    faces, originals = part.mesh.faces, part.faces_to_original
    doubled = doubled_faces(faces)
    min_share = 0.05  # of doubled faces above which they are second sides, as every face of a two-sided export has one
    if doubled.sum() > min_share * len(faces):
        faces, originals = faces[~doubled], originals[~doubled]
        part = replace(part, mesh=Mesh(part.mesh.vertices, faces), faces_to_original=originals, doubled=doubled.sum())
    turned = inward_faces(part.mesh)
    if not turned.any():
        return part
    return replace(part, mesh=Mesh(part.mesh.vertices, turn_faces(faces, turned)), turned=turned)


def flatten_spikes(mesh: Mesh) -> tuple[Mesh, int]:
    """Return a cleaned mesh with the vertices that stick out of it moved to the mean of their neighbours, and how many.

    Such a vertex is farther from that mean than the neighbours are on average, and than edges are long. Vertices on
    boundaries stay, since slivers remain where a surface is cut.
    """
    n, v = len(mesh.vertices), mesh.vertices
    edges, n_faces = mesh_edges(mesh.faces, n)
    if len(edges) == 0:
        return mesh, 0
    links, degree = _links(edges, n)
    mean = links @ v / degree
    height = np.linalg.norm(v - mean, axis=1)
    a, b = np.concatenate([edges, edges[:, ::-1]]).T
    width = np.bincount(a, np.linalg.norm(v[b] - mean[a], axis=1), n) / degree[:, 0]
    length = np.linalg.norm(v[edges[:, 0]] - v[edges[:, 1]], axis=1)
    is_spike = (height > _MIN_SPIKE * length.mean()) & (height > _MIN_SHARPNESS * width)
    is_spike[edges[n_faces == 1]] = False
    return (Mesh(np.where(is_spike[:, None], mean, v), mesh.faces) if is_spike.any() else mesh), int(is_spike.sum())


def smooth_noise(mesh: Mesh) -> Mesh | None:
    """Return a cleaned mesh without much of the noise of its vertices, or ``None`` where it has little.

    Smoothing steps take turns with steps that undo the shrinking (Taubin, A signal processing approach to fair surface
    design, 1995), more of them the more vertices there are, since features are longer than the edges there.
    """
    n = len(mesh.vertices)
    if len(mesh.faces) == 0 or roughness(mesh.vertices, mesh.faces) <= _MAX_ROUGHNESS:
        return None
    links, degree = _links(mesh_edges(mesh.faces, n)[0], n)
    positions = mesh.vertices
    for _ in range(min(round(_STEPS_PER_VERTEX * n), _MAX_STEPS)):
        for step in (0.5, -0.53):
            positions = positions + step * (links @ positions / degree - positions)
    return Mesh(positions, mesh.faces)


def _links(edges: np.ndarray, n: int) -> tuple[csr_array, np.ndarray]:
    """Return the adjacency matrix of ``n`` vertices with ``edges (e, 2)``, and how many neighbours each has, (n, 1)."""
    links = coo_array((np.ones(edges.size), (edges.ravel(), edges[:, ::-1].ravel())), shape=(n, n)).tocsr()
    return links, np.maximum(links.sum(axis=1), 1)[:, None]


def divide_mesh(part: CleanedMesh, count: int) -> CleanedMesh:
    """Return a cleaned mesh with divided faces, if it is a solid with long ones or has fewer than ``count`` vertices.

    New vertices come last, and have the original number of the nearest corner. The long faces of a solid are cut where
    they lie. Otherwise all faces are cut in four, and new vertices lie on a smooth surface through the others, since
    two coarse meshes of one body have their edges elsewhere.
    """
    if is_polyhedral(part.mesh):
        mesh, piece_of, corners = _split_faces(part.mesh)
    elif len(part.mesh.vertices) < count:
        mesh, piece_of, corners = _subdivide_faces(part.mesh, count)
    else:
        return part
    at = np.zeros(len(mesh.vertices), dtype=np.int64)  # for each vertex a face and its corner there
    at[mesh.faces.ravel()] = np.arange(mesh.faces.size)
    nearest = part.mesh.faces[piece_of[at // 3], corners.reshape(-1, 3)[at].argmax(axis=1)]
    return replace(
        part,
        mesh=mesh,
        to_original=part.to_original[nearest],
        faces_to_original=part.faces_to_original[piece_of],
        turned=None if part.turned is None else part.turned[piece_of],
        corners=corners,
    )


def _subdivide_faces(mesh: Mesh, count: int) -> tuple[Mesh, np.ndarray, np.ndarray]:
    """Return the smooth surface with at least ``count`` vertices, and what :func:`.split_long_edges` does beside it."""
    piece_of = np.arange(len(mesh.faces))
    corners = np.tile(np.eye(3), (len(piece_of), 1, 1))
    middle = 0.5 * np.array([[1, 1, 0], [0, 1, 1], [1, 0, 1]])
    pieces = [*(np.stack([np.eye(3)[i], middle[i], middle[i - 1]]) for i in range(3)), middle]
    while len(mesh.vertices) < count:
        mesh = interpolating_subdivision(mesh)
        of_pieces = np.einsum("pij,fjk->fpik", pieces, corners)
        corners = np.concatenate([of_pieces[:, :3].reshape(-1, 3, 3), of_pieces[:, 3]])
        piece_of = np.concatenate([np.repeat(piece_of, 3), piece_of])
    return mesh, piece_of, corners


def _split_faces(mesh: Mesh) -> tuple[Mesh, np.ndarray, np.ndarray]:
    """Return what :func:`.split_long_edges` does, with edges so long that there are not too many vertices."""
    size, most = math.sqrt(face_areas(mesh).sum()), max(_MAX_VERTICES, 2 * len(mesh.vertices))
    for longest in _LONGEST_EDGES[:-1]:
        found = split_long_edges(mesh, longest * size)
        if len(found[0].vertices) <= most:
            return found
    return split_long_edges(mesh, _LONGEST_EDGES[-1] * size)


def _body_faces(mesh: Mesh) -> tuple[np.ndarray, int]:
    """Return which faces lie on no speck, (f,) bool, and the number of specks, fins included."""
    label, areas = component_areas(mesh)
    component = label[mesh.faces[:, 0]]
    max_area = _MAX_SPECK_AREA * areas.max(initial=0.0)
    is_body = (areas >= max_area)[component]
    patch, is_fin = _fins(mesh, max_area)
    return is_body & ~is_fin[patch], len(np.unique(component[~is_body])) + int(is_fin.sum())


def _fins(mesh: Mesh, max_area: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the patch of each face, (f,), and which patches are fins up to ``max_area``, (p,) bool.

    A fin has an open edge, stands on an edge of two other patches, and touches them nowhere else.
    """
    n, corners = len(mesh.vertices), mesh.faces.ravel()
    boundary, pairs, edge_counts = half_edges_by_edge(mesh.faces, n)
    if edge_counts.max(initial=0) <= 2:
        return np.zeros(len(mesh.faces), dtype=np.int64), np.zeros(1, dtype=bool)
    patch = manifold_patches(len(mesh.faces), pairs)
    shared = np.delete(np.arange(len(corners)), np.r_[boundary, pairs.ravel()])
    is_fin = np.bincount(patch, face_areas(mesh)) < max_area
    for edges in (boundary, shared):
        is_fin &= np.bincount(patch[edges // 3], minlength=len(is_fin)) > 0
    of_corner, at, touches = np.repeat(patch, 3), np.zeros(n, dtype=np.int64), np.zeros(n, dtype=bool)
    at[corners] = of_corner
    touches[corners[at[corners] != of_corner]] = True
    touches[corners[shared]] = touches[mesh.faces[:, [1, 2, 0]].ravel()[shared]] = False
    return patch, is_fin & (np.bincount(of_corner, touches[corners]) == 0)
