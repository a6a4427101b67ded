"""Welding: vertices on open edges that lie along each other become one.

Files cut surfaces along the seams of a texture, store every triangle by itself (flat shading, STL), or a body in
pieces. Rounding moves the ends of such edges a little, and pieces may have their vertices in other places
(T-junctions).
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import blocks, index_ranges
from kfmaps.geometry.connectivity import (
    component_labels,
    half_edges,
    half_edges_by_edge,
    proper_faces,
    unique_vertices,
)
from kfmaps.geometry.mesh import Mesh, surface_area, unit_rows

_MAX_ROUNDING = 0.1
"""Distance up to which two open edges coincide, over the length of the shortest one at their ends."""
_MAX_GAP, _MAX_GAP_OF_BODY = 0.5, 0.01
"""Widest gap between two pieces that counts as a seam, over the length of an open edge there, and over √area."""
_MIN_SEAM, _MAX_COSINE = 0.4, 0.3
"""Least share of the open ends of one of two pieces that lie along seams, and greatest cosine between the directions in
which the surfaces go on from a gap. Borders of pieces that overlap only cross, or both go on to the same side."""


def weld_vertices(mesh: Mesh) -> np.ndarray:
    """Return for each vertex the one that it is welded to, (n,) int64; its own number where there is none.

    1. The ends of open edges that coincide are welded to the first of them, and then those that coincide but for
       rounding.
    2. Where an open edge lies along a longer one, as at T-junctions, its ends are welded to the nearest end of that
       one. Between pieces that coincident edges do not connect there may be a narrow gap.

    Surfaces that only touch in a point stay apart. All coincident points of a cloud are welded.
    """
    n = len(mesh.vertices)
    if len(mesh.faces) == 0:
        return unique_vertices(mesh.vertices)
    proper = mesh.faces[proper_faces(mesh.faces)]
    edges, _ = _open_edges(proper, n)
    exact = _weld_ends(edges, _same_positions(mesh, edges))
    edges, _ = _open_edges(exact[proper], n)
    if len(edges) == 0:
        return exact
    welded = _weld_ends(edges, _rounded_positions(mesh, edges))[exact]
    edges, owner = _open_edges(welded[proper], n)
    if len(edges) == 0:
        return welded
    piece = component_labels(n, *half_edges(exact[proper]).T)[1]
    return _weld_along(mesh, edges, welded[proper[owner]], piece[proper[owner, 0]])[welded]


def _open_edges(faces: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the edges of only one of ``faces (f, 3)``, (b, 2), and that face, (b,); degenerate ones do not count."""
    rows = np.flatnonzero(proper_faces(faces))
    faces = faces[rows]
    border = half_edges_by_edge(faces, n)[0]
    return np.stack([faces.ravel()[border], faces[:, [1, 2, 0]].ravel()[border]], axis=1), rows[border // 3]


def _same_positions(mesh: Mesh, edges: np.ndarray) -> np.ndarray:
    """Return the first of the ends of ``edges`` at the position of each, (n,)."""
    position, ends = np.arange(len(mesh.vertices)), np.unique(edges)
    position[ends] = ends[unique_vertices(mesh.vertices[ends])]
    return position


def _rounded_positions(mesh: Mesh, edges: np.ndarray) -> np.ndarray:
    """Return the first of the ends of ``edges`` at the position of each, (n,), up to rounding."""
    n, position = len(mesh.vertices), _same_positions(mesh, edges)
    reach, ends = np.full(n, np.inf), np.unique(position[edges])
    np.minimum.at(reach, position[edges], _MAX_ROUNDING * _lengths(mesh, edges)[:, None])
    a, b = (ends[i] for i in _pairs_within(mesh.vertices[ends], reach[ends], mesh.vertices[ends]))
    is_close = np.linalg.norm(mesh.vertices[a] - mesh.vertices[b], axis=1) <= reach[b]
    return _firsts(component_labels(n, a[is_close], b[is_close])[1])[position]


def _weld_ends(edges: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Return the first vertex of those that each is welded with, (n,), as ends of ``edges`` between like positions."""
    ends = position[edges]
    is_descending = ends[:, 0] > ends[:, 1]
    edges, ends = (np.where(is_descending[:, None], pairs[:, ::-1], pairs) for pairs in (edges, ends))
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    order = order[ends[order, 0] != ends[order, 1]]
    edges, ends = edges[order], ends[order]
    coincide = (ends[1:] == ends[:-1]).all(axis=1)
    return _firsts(component_labels(len(position), edges[:-1][coincide].ravel(), edges[1:][coincide].ravel())[1])


def _weld_along(mesh: Mesh, edges: np.ndarray, corners: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Return the end of a longer open edge that each vertex of an edge along it is welded to, (n,).

    ``corners (b, 3)`` and ``piece (b,)``: of the face that each of ``edges (b, 2)`` belongs to.
    """
    vertices, n = mesh.vertices, len(mesh.vertices)
    length = _lengths(mesh, edges)
    ends, n_edges = np.unique(edges, return_counts=True)
    mean_length, shortest, piece_of = np.zeros(n), np.full(n, np.inf), np.zeros(n, dtype=np.int64)
    np.add.at(mean_length, edges, length[:, None])
    mean_length[ends] /= n_edges
    np.minimum.at(shortest, edges, length[:, None])
    piece_of[edges] = piece[:, None]
    # Vertices are welded to those of a higher rank only, so that no chain of them is closed.
    piece_length = np.bincount(piece, length) / np.bincount(piece).clip(1)
    rank = np.empty(n)
    rank[np.lexsort((mean_length, piece_length[piece_of]))] = np.arange(n)

    widest = np.minimum(_MAX_GAP * length, _MAX_GAP_OF_BODY * np.sqrt(surface_area(mesh)))
    # Long edges are divided, since the balls around them hold too many vertices.
    n_parts = np.ceil(length / max(length.mean(), 1e-300)).clip(1).astype(np.int64)
    edge = np.repeat(np.arange(len(edges)), n_parts)
    position = (index_ranges(np.zeros(len(edges), dtype=np.int64), n_parts) + 0.5) / n_parts[edge]
    start, along = vertices[edges[:, 0]], vertices[edges[:, 1]] - vertices[edges[:, 0]]
    centres = start[edge] + position[:, None] * along[edge]
    centre, vertex = _pairs_within(centres, (length / n_parts / 2 + widest)[edge], vertices[ends])
    edge, vertex = edge[centre], ends[vertex]
    start, along = start[edge], along[edge]
    part = np.einsum("ij,ij->i", vertices[vertex] - start, along) / np.maximum(length[edge] ** 2, 1e-300)
    distance = np.linalg.norm(start + part.clip(0, 1)[:, None] * along - vertices[vertex], axis=1)
    end = edges[edge, (part > 0.5).astype(np.int64)]
    inward, inward_of = _directions_inward(vertices, edges, corners), np.zeros((n, 3))
    np.add.at(inward_of, edges, inward[:, None])
    cosine = np.einsum("ij,ij->i", inward[edge], unit_rows(inward_of)[vertex])
    gap = np.minimum(widest[edge], _MAX_GAP * mean_length[vertex])
    may_gape = (piece_of[vertex] != piece[edge]) & (cosine < _MAX_COSINE)
    gap = np.where(may_gape, gap, _MAX_ROUNDING * shortest[vertex])
    is_along = (distance <= gap) & (rank[vertex] < rank[end])
    is_along &= (corners[edge] != vertex[:, None]).all(axis=1)  # the corners of its own face may be as close
    vertex, end, distance = vertex[is_along], end[is_along], distance[is_along]
    order = np.lexsort((distance, vertex))
    order = order[np.diff(vertex[order], prepend=-1) > 0]  # the nearest edge of each vertex
    vertex, end = vertex[order], end[order]
    onto, is_reached = np.arange(n), np.zeros(n, dtype=bool)
    is_reached[vertex] = is_reached[end] = True
    share = np.bincount(piece_of[ends], is_reached[ends]) / np.bincount(piece_of[ends]).clip(1)
    is_seam = (piece_of[vertex] == piece_of[end]) | (share[piece_of[[vertex, end]]].max(axis=0) >= _MIN_SEAM)
    onto[vertex[is_seam]] = end[is_seam]
    stays = np.setdiff1d(ends, edges[is_reached[edges].all(axis=1)])  # of these no edge lies along another as a whole
    onto[stays] = stays
    while (onto[onto] != onto).any():
        onto = onto[onto]
    return onto


def _directions_inward(vertices: np.ndarray, edges: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return unit vectors from ``edges (b, 2)``, perpendicular to them, into their faces with ``corners (b, 3)``."""
    start, along = vertices[edges[:, 0]], unit_rows(vertices[edges[:, 1]] - vertices[edges[:, 0]])
    into = vertices[corners].sum(axis=1) - vertices[edges].sum(axis=1) - start
    return unit_rows(into - np.einsum("ij,ij->i", into, along)[:, None] * along)


def _pairs_within(centres: np.ndarray, radii: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers of each centre and point that are within the radius of the centre: (p,), (p,).

    A centre with more than 200 points has none: an edge so much longer than those around is no border of a surface.
    """
    tree = KDTree(points)
    near = np.flatnonzero(tree.query_ball_point(centres, radii, return_length=True) <= 200)
    pairs = [(near[:0], near[:0])]
    for block in blocks(len(near), 50_000):  # lists take much more memory than arrays
        found = tree.query_ball_point(centres[near[block]], radii[near[block]])
        pairs.append((np.repeat(near[block], [len(one) for one in found]), np.concatenate(found).astype(np.int64)))
    return np.concatenate([pair[0] for pair in pairs]), np.concatenate([pair[1] for pair in pairs])


def _lengths(mesh: Mesh, edges: np.ndarray) -> np.ndarray:
    """Return the length of each of ``edges (b, 2)``."""
    return np.linalg.norm(mesh.vertices[edges[:, 0]] - mesh.vertices[edges[:, 1]], axis=1)


def _firsts(label: np.ndarray) -> np.ndarray:
    """Return the first item with the same ``label (n,)`` as each, (n,)."""
    return np.unique(label, return_index=True)[1][label].astype(np.int64)
