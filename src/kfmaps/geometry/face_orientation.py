"""Which faces look inward: files often have all of them turned over, or some, or each of them twice."""

from __future__ import annotations

import igl
import numpy as np

from kfmaps.geometry.connectivity import half_edges_by_edge
from kfmaps.geometry.mesh import Mesh, boundary_loops, face_areas

_MAX_OPENING = 0.2
"""Area of flat discs in the boundaries, over that of the surface, above which its volume says nothing of its sides."""
_MIN_VOLUME = 1e-3
"""Volume over area^(3/2) of a surface with an inside, a hundredth of a sphere's; two sides of a sheet have less."""


def doubled_faces(faces: np.ndarray) -> np.ndarray:
    """Return which of ``faces (f, 3)`` have the vertices of an earlier one, in any order: (f,) bool."""
    a, b, c = np.sort(faces, axis=1).T
    n = int(c.max(initial=0)) + 1
    if n**3 < 2**63:  # one number for each face is sorted in a quarter of the time
        first = np.unique((a * n + b) * n + c, return_index=True)[1]
    else:
        first = np.unique(np.stack([a, b, c]), axis=1, return_index=True)[1]
    result = np.ones(len(faces), dtype=bool)
    result[first] = False
    return result


def inward_faces(mesh: Mesh) -> np.ndarray:
    """Return which faces have to be turned over so that all look outward, (f,) bool.

    Neighbours are made to agree, the fewer in area of each orientable patch turned; then all are turned where the
    volume that they enclose, boundaries closed by cones, is negative. A surface that is far from closed keeps its side.
    """
    f, n = len(mesh.faces), len(mesh.vertices)
    result = np.zeros(f, dtype=bool)
    if f == 0:
        return result
    rim, agree = _rim_and_agreement(mesh.faces, n)
    faces, areas = mesh.faces, face_areas(mesh)
    if not agree:
        alike, patch = (np.asarray(found) for found in igl.bfs_orient(faces))
        first = np.argmax(alike == faces[:, :1], axis=1)  # where the first corner went: turning keeps or moves it
        following = alike[np.arange(f), (first + 1) % 3]
        result = following != faces[:, 1]
        outvoted = np.bincount(patch, np.where(result, areas, -areas)) > 0
        result ^= outvoted[patch]
        faces = turn_faces(faces, result)
        rim, _ = _rim_and_agreement(faces, n)
    loop, discs = boundary_loops(mesh.vertices, rim)
    if discs > _MAX_OPENING * areas.sum():
        return result
    volume = _enclosed_volume(mesh.vertices, faces, rim, loop)
    return ~result if volume < -_MIN_VOLUME * areas.sum() ** 1.5 else result


def turn_faces(faces: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Return ``faces (f, 3)``, ``which (f,)`` of them with their corners the other way round."""
    return np.where(which[:, None], faces[:, ::-1], faces)


def _rim_and_agreement(faces: np.ndarray, n: int) -> tuple[np.ndarray, bool]:
    """Boundary edges as their faces run along them, (b, 2), and whether all neighbours are oriented alike."""
    tail, head = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    rim, (one, two), _ = half_edges_by_edge(faces, n)
    return np.stack([tail[rim], head[rim]], axis=1), bool((tail[one] != tail[two]).all())


def _enclosed_volume(vertices: np.ndarray, faces: np.ndarray, rim: np.ndarray, loop: np.ndarray) -> float:
    """Signed volume within a surface whose boundary loops are closed by cones to their middles."""
    points = vertices - vertices.mean(axis=0)
    a, b, c = (points[faces[:, i]] for i in range(3))
    volume = np.einsum("fi,fi->", a, np.cross(b, c))
    if len(rim):
        ends = points[rim[:, 0]]
        sums = np.stack([np.bincount(loop, x) for x in ends.T], axis=1)
        middles = sums / np.maximum(np.bincount(loop), 1)[:, None]
        volume += np.einsum("ei,ei->", points[rim[:, 1]], np.cross(ends, middles[loop]))
    return float(volume / 6)
