"""Outward orientation of faces: files often have all of them turned over, or some, or each of them twice."""

from __future__ import annotations

import igl
import numpy as np

from kfmaps.geometry.connectivity import half_edges_by_edge
from kfmaps.geometry.mesh import Mesh, boundary_loops, disc_area, face_areas


def doubled_faces(faces: np.ndarray) -> np.ndarray:
    """Return which of ``faces (f, 3)`` have the corners of an earlier one, in any order, (f,) bool."""
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
    """Return which faces must be turned over so that all look outward, (f,) bool.

    First neighbours are made to agree, by turning the smaller area of each orientable patch. Then all are turned if the
    enclosed volume, with boundaries closed by cones, is negative. A surface that is far from closed keeps its
    orientation.
    """
    f, n = len(mesh.faces), len(mesh.vertices)
    result = np.zeros(f, dtype=bool)
    if f == 0:
        return result
    boundary, agree = _boundary_and_agreement(mesh.faces, n)
    faces, areas = mesh.faces, face_areas(mesh)
    if not agree:
        oriented, patch = (np.asarray(array) for array in igl.bfs_orient(faces))
        first = np.argmax(oriented == faces[:, :1], axis=1)  # new index of the first corner
        following = oriented[np.arange(f), (first + 1) % 3]
        result = following != faces[:, 1]
        turned_most = np.bincount(patch, np.where(result, areas, -areas)) > 0
        result ^= turned_most[patch]
        faces = turn_faces(faces, result)
        boundary, _ = _boundary_and_agreement(faces, n)
    loop, lengths = boundary_loops(mesh.vertices, boundary)
    opening = disc_area(lengths) / areas.sum()  # area of flat discs in the boundaries, over that of the surface
    max_opening = 1.0  # above which the volume says nothing: a patch of the inside of a bend looks outward with less
    if opening > max_opening:
        return result
    volume = _enclosed_volume(mesh.vertices, faces, boundary, loop)
    # Over area^(3/2), of a surface with an inside; a sphere has 0.09. A sheet has less (research/damaged.md).
    min_volume = 1e-3 + 0.02 * opening
    return ~result if volume < -min_volume * areas.sum() ** 1.5 else result


def turn_faces(faces: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Return ``faces (f, 3)`` with the orientation of ``which (f,)`` reversed."""
    return np.where(which[:, None], faces[:, ::-1], faces)


def _boundary_and_agreement(faces: np.ndarray, n: int) -> tuple[np.ndarray, bool]:
    """Return the boundary half-edges, (b, 2), and whether all neighbours are oriented consistently."""
    tail, head = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    boundary, (one, two), _ = half_edges_by_edge(faces, n)
    return np.stack([tail[boundary], head[boundary]], axis=1), bool((tail[one] != tail[two]).all())


def _enclosed_volume(vertices: np.ndarray, faces: np.ndarray, boundary: np.ndarray, loop: np.ndarray) -> float:
    """Return the signed volume of a surface with its boundary loops closed by cones to their centres."""
    points = vertices - vertices.mean(axis=0)
    a, b, c = (points[faces[:, i]] for i in range(3))
    volume = np.einsum("fi,fi->", a, np.cross(b, c))
    if len(boundary):
        tails, heads = points[boundary[:, 0]], points[boundary[:, 1]]
        sums = np.stack([np.bincount(loop, x) for x in tails.T], axis=1)
        centres = sums / np.maximum(np.bincount(loop), 1)[:, None]
        volume += np.einsum("ei,ei->", heads, np.cross(tails, centres[loop]))
    return float(volume / 6)
