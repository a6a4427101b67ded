"""Cleaning: open edges at the same position are welded, unused vertices and specks are left out.

Files cut surfaces along the seams of a texture, or leave every triangle on its own (flat shading, STL); they keep
vertices that no face uses, and specks that float beside the surface. A :class:`CleanedMesh` knows both numberings.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import KDTree

from kfmaps.geometry.connectivity import boundary_edges, component_labels, proper_faces, unique_vertices
from kfmaps.geometry.face_orientation import doubled_faces, inward_faces, turn_faces
from kfmaps.geometry.mesh import Mesh, face_areas

_MAX_SPECK_AREA = 0.005
"""Area of a component, over that of the largest, below which it is a speck: what one of 200 samples stands for."""
_MANY_DOUBLED = 0.05
"""Share of doubled faces above which they are second sides: every face of a two-sided export has one."""


@dataclass(frozen=True, eq=False)
class CleanedMesh:
    """A cleaned mesh of ``m`` vertices and the numbers of its ``n`` original ones; made by :func:`clean_mesh`."""

    mesh: Mesh  # Its faces name three vertices each. The very mesh that was given when there is nothing to leave out.
    to_original: np.ndarray  # (m,): Original number of each vertex, ascending. Of welded vertices the first is kept.
    to_clean: np.ndarray  # (n,): the vertex that each original one counts as
    unreferenced: np.ndarray  # (n,): original vertices of no face: they count as the vertex nearest in space
    faces_to_original: np.ndarray  # (g,): original number of each face, ascending
    n_welded: int = 0  # how many original vertices count as one with an earlier one
    specks: int = 0  # components left out
    doubled: int = 0  # faces left out that lie on another one
    turned: np.ndarray | None = None  # (g,): faces whose corners run the other way than in the original; None: no face

    @property
    def whole(self) -> bool:
        """Whether every original vertex is there, each for itself."""
        return len(self.to_original) == len(self.to_clean)


def weld_vertices(mesh: Mesh) -> np.ndarray:
    """Return for each vertex the first of those that it is welded with, (n,) int64.

    Of a mesh the ends of open edges are welded that lie exactly on other open edges: surfaces that merely touch in a
    point stay apart. Of a point cloud all points at one position are welded.
    """
    n = len(mesh.vertices)
    if len(mesh.faces) == 0:
        return unique_vertices(mesh.vertices)
    ends = boundary_edges(mesh.faces[proper_faces(mesh.faces)], n)
    if len(ends) == 0:
        return np.arange(n)
    rim = np.unique(ends)
    place = np.arange(n)
    place[rim] = rim[unique_vertices(mesh.vertices[rim])]
    at = place[ends]
    flipped = at[:, 0] > at[:, 1]
    ends[flipped], at[flipped] = ends[flipped][:, ::-1], at[flipped][:, ::-1]
    long = at[:, 0] != at[:, 1]
    ends, at = ends[long], at[long]
    order = np.lexsort((at[:, 1], at[:, 0]))
    ends, at = ends[order], at[order]
    same = (at[1:] == at[:-1]).all(axis=1)
    result = np.arange(n)
    if not same.any():
        return result
    a, b = ends[:-1][same].ravel(), ends[1:][same].ravel()
    _, group = component_labels(n, a, b)
    first = np.unique(group, return_index=True)[1]
    return first[group].astype(np.int64)


def clean_mesh(mesh: Mesh, specks: bool = False) -> CleanedMesh:
    """Return a mesh without welded vertices, faces that name a vertex twice, and vertices that no other face uses.

    ``mesh``: its face numbers within range; ``specks``: whether to leave out components whose area is less than 0.5 %
    of the largest one's.
    """
    n = len(mesh.vertices)
    first = weld_vertices(mesh)
    numbers = np.arange(n)
    joined = int((first != numbers).sum())
    if len(mesh.faces) == 0:
        kept, gone, faces, left = np.unique(first), 0, mesh.faces, numbers[:0]
        used = np.ones(n, dtype=bool)
    else:
        faces = first[mesh.faces]
        left = np.flatnonzero(proper_faces(faces))
        gone = 0
        if specks:
            keep, gone = _no_speck(Mesh(mesh.vertices, faces[left]))
            left = left[keep]
        faces = faces[left]
        used = np.bincount(faces.ravel(), minlength=n) > 0
        kept = np.flatnonzero(used)
        used = used[first]
    if len(kept) == n:
        same = mesh if len(faces) == len(mesh.faces) else Mesh(mesh.vertices, faces)
        return CleanedMesh(same, numbers, numbers, np.zeros(n, dtype=bool), left)
    number = np.full(n, -1)
    number[kept] = np.arange(len(kept))
    faces = number[faces]
    number = number[first]
    if not used.all() and len(kept):
        number[~used] = KDTree(mesh.vertices[kept]).query(mesh.vertices[~used])[1]
    return CleanedMesh(Mesh(mesh.vertices[kept], faces), kept, number, ~used, left, joined, gone)


def face_outward(part: CleanedMesh) -> CleanedMesh:
    """Return a cleaned mesh without the second sides of two-sided faces, all of its faces looking outward.

    Doubled faces are left out where they are many; a few are folds of a closed surface. Where a surface is open, which
    side is outward is not known, and most of its area keeps its side (:func:`~.face_orientation.inward_faces`).
    """
    faces, originals = part.mesh.faces, part.faces_to_original
    doubled = doubled_faces(faces)
    if doubled.sum() > _MANY_DOUBLED * len(faces):
        faces, originals = faces[~doubled], originals[~doubled]
        part = replace(part, mesh=Mesh(part.mesh.vertices, faces), faces_to_original=originals, doubled=doubled.sum())
    turned = inward_faces(part.mesh)
    if not turned.any():
        return part
    return replace(part, mesh=Mesh(part.mesh.vertices, turn_faces(faces, turned)), turned=turned)


def _no_speck(mesh: Mesh) -> tuple[np.ndarray, int]:
    """Which faces lie on no speck, (f,) bool, and how many specks there are."""
    n, faces = len(mesh.vertices), mesh.faces
    count, label = component_labels(n, faces[:, :2].ravel(), faces[:, 1:].ravel())
    piece = label[faces[:, 0]]
    areas = np.bincount(piece, face_areas(mesh), minlength=count)
    speck = areas < _MAX_SPECK_AREA * areas.max(initial=0.0)
    return ~speck[piece], int(speck[np.bincount(piece, minlength=count) > 0].sum())
