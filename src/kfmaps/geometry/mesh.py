"""Triangle meshes and point clouds, and plain functions of their vertices and faces."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field

import numpy as np

from kfmaps._arrays import KfmapsWarning, check, printable, refuse
from kfmaps._texts import plural
from kfmaps.geometry.connectivity import boundary_edges, component_labels
from kfmaps.geometry.point_cloud import cloud_areas


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh, or a point cloud when it has no faces.

    Attributes
    ----------
    vertices : (n, 3) float64
        Positions, in any unit.
    faces : (f, 3) int64
        0-based vertex numbers, counter-clockwise seen from outside; by default none, ``(0, 3)``: a point cloud.

    Examples
    --------
    >>> kfmaps.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    Mesh(3 vertices, 1 faces)
    """

    vertices: np.ndarray
    faces: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), dtype=np.int64))

    def __repr__(self) -> str:
        return f"Mesh({len(self.vertices):,} vertices, {len(self.faces):,} faces)"

    def __post_init__(self) -> None:
        vertices = np.ascontiguousarray(self.vertices, dtype=np.float64)
        faces = np.asarray(() if self.faces is None else self.faces)
        if faces.size == 0:
            faces = np.zeros((0, 3), dtype=np.int64)
        faces = np.ascontiguousarray(faces, dtype=np.int64)
        check(vertices, "vertices", shape=(None, 3), finite=False, remedy="give one row x, y, z per vertex")
        check(faces, "faces", shape=(None, 3), remedy="give three vertex numbers per face")
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)


def check_is_mesh(mesh: object, name: str = "mesh") -> None:
    """Raise :class:`InvalidInput` when ``mesh`` is no :class:`Mesh`, as a path or another library's object."""
    if not isinstance(mesh, Mesh):
        raise refuse(name, "a Mesh", type(mesh).__name__, "use kfmaps.read_mesh, or kfmaps.Mesh(vertices, faces)")


def _face_vectors(mesh: Mesh) -> np.ndarray:
    """Return the cross product of two edges of each face, its normal with twice its area for length, (f, 3)."""
    # Stored coordinate by coordinate, which takes a fifth of the time.
    x = np.ascontiguousarray(mesh.vertices.T)
    a, u, v = (x.take(corner, axis=1) for corner in mesh.faces.T)
    u -= a
    v -= a
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        np.multiply(u[j], v[k], out=a[i])
        a[i] -= u[k] * v[j]
    return a.T


def unit_rows(vectors: np.ndarray) -> np.ndarray:
    """Return ``vectors (m, d)`` scaled to unit length, zero where they are zero."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def spread_directions(count: int) -> np.ndarray:
    """Return unit vectors (count, 3) spread evenly: a spiral on the sphere with the golden angle between them."""
    z = 1 - (2 * np.arange(count) + 1) / count
    turn = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    return np.stack([*(np.sqrt(1 - z**2) * (np.cos(turn), np.sin(turn))), z], axis=1)


def face_areas(mesh: Mesh) -> np.ndarray:
    """Return the area of each face, (f,) float64, in squared units of the vertices."""
    return 0.5 * np.linalg.norm(_face_vectors(mesh), axis=1)


def face_normals(mesh: Mesh) -> np.ndarray:
    """Return the unit normal of each face, (f, 3) float64; zero for a face without area."""
    return unit_rows(_face_vectors(mesh))


def surface_area(mesh: Mesh) -> float:
    """Return the sum of the face areas, estimated for a point cloud (:func:`vertex_areas`)."""
    if len(mesh.faces) == 0 and len(mesh.vertices):
        return float(cloud_areas(mesh.vertices).sum())
    return float(face_areas(mesh).sum())


def vertex_areas(mesh: Mesh) -> np.ndarray:
    """Return a third of the area of the faces around each vertex, (n,) float64: the barycentric lumped mass.

    For a point cloud areas are estimated (:func:`kfmaps.geometry.point_cloud.cloud_areas`).
    """
    if len(mesh.faces) == 0 and len(mesh.vertices):
        return cloud_areas(mesh.vertices)
    thirds = np.repeat(face_areas(mesh) / 3, 3)
    return np.bincount(mesh.faces.ravel(), weights=thirds, minlength=len(mesh.vertices))


def vertex_normals(mesh: Mesh) -> np.ndarray:
    """Return the unit area-weighted normal of each vertex, (n, 3) float64; zero where no face meets the vertex."""
    vectors = _face_vectors(mesh)
    corners = mesh.faces.ravel()
    summed = [np.bincount(corners, np.repeat(v, 3), minlength=len(mesh.vertices)) for v in vectors.T]
    return unit_rows(np.stack(summed, axis=1))


def boundary_vertices(mesh: Mesh) -> np.ndarray:
    """Return which vertices (n,) lie on an edge that only one face has."""
    result = np.zeros(len(mesh.vertices), dtype=bool)
    result[boundary_edges(mesh.faces, len(result))] = True
    return result


def boundary_loops(vertices: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the number of the loop of each boundary edge, (b,), and the length of each loop, by its number.

    ``vertices (n, 3)``; ``edges (b, 2)``. Numbers that no loop has have a length of 0.
    """
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    loop = component_labels(len(vertices), *edges.T)[1][edges[:, 0]]
    return loop, np.bincount(loop, lengths)


def disc_area(perimeters: np.ndarray) -> float:
    """Return the total area of flat discs with the ``perimeters`` of boundary loops: the least that is missing."""
    return float((perimeters**2).sum() / (4 * np.pi))


def loop_lengths(mesh: Mesh) -> np.ndarray:
    """Return the lengths of the boundary loops, the longest first; and zeros."""
    lengths = boundary_loops(mesh.vertices, boundary_edges(mesh.faces, len(mesh.vertices)))[1]
    return np.sort(lengths)[::-1]


MIN_OPENING = 0.01
"""Area of flat discs in all boundaries, over that of the surface, below which a shape counts as closed."""


def opening_area(mesh: Mesh) -> float:
    """Return the total area of flat discs with the lengths of the boundary loops."""
    return disc_area(loop_lengths(mesh))


MIRROR = np.array([-1.0, 1.0, 1.0])
"""Factors of the coordinates that reflect positions in the plane x = 0."""


def component_areas(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the connected component of each vertex, (n,), and the area of each component, (c,)."""
    faces = mesh.faces
    count, label = component_labels(len(mesh.vertices), faces[:, :2].ravel(), faces[:, 1:].ravel())
    return label, np.bincount(label[faces[:, 0]], face_areas(mesh), minlength=count)


def mirror_mesh(mesh: Mesh) -> Mesh:
    """Return the mirror image in the plane x = 0, with the same vertices and faces that still look outward."""
    return Mesh(mesh.vertices * MIRROR, mesh.faces[:, ::-1])


def unit_area(mesh: Mesh) -> Mesh:
    """Return the mesh centred on its vertices' mean and scaled to area 1.

    Parameters
    ----------
    mesh : Mesh
        The area of a point cloud is estimated (:func:`surface_area`).

    Returns
    -------
    Mesh

    Raises
    ------
    InvalidInput
        If it has no area.
    """
    centred = mesh.vertices - mesh.vertices.mean(axis=0)
    area = surface_area(mesh)
    if not area > 0:
        raise refuse("mesh", "a surface with area", "zero area", "check that its faces are not collapsed")
    return Mesh(centred / np.sqrt(area), mesh.faces)


def check_mesh(mesh: Mesh, name: str = "mesh", *, cloud: bool = False) -> Mesh:
    """Return ``mesh`` when it is valid.

    Warns (:class:`KfmapsWarning`) about unreferenced vertices and faces without area, which do no harm.

    Parameters
    ----------
    mesh : Mesh
    name : str
        How messages call it; usually the file's name.
    cloud : bool
        Whether a mesh without faces is accepted as a point cloud.

    Raises
    ------
    InvalidInput
        On no vertices, NaN or infinite coordinates, no faces (unless ``cloud``), a vertex number out of range, or zero
        area.
    """
    n = len(mesh.vertices)
    if n == 0:
        raise refuse(name, "vertices", "none", "check that the file is complete")
    check(mesh.vertices, f"{name}: vertices", remedy="repair or re-export the file")
    if len(mesh.faces) == 0:
        if cloud:
            return mesh
        raise refuse(name, "a surface with faces", "no faces", "save a point cloud as .xyz, or triangulate it")
    low, high = int(mesh.faces.min()), int(mesh.faces.max())
    if low < 0 or high >= n:
        bad = low if low < 0 else high
        raise refuse(f"{name}: faces", f"vertex numbers from 0 to {n - 1}", str(bad), "repair the file")
    areas = face_areas(mesh)
    if not areas.sum() > 0:
        raise refuse(name, "a surface with area", "zero area", "check that its faces are not collapsed")
    flat = int((areas <= 1e-14 * areas.max()).sum())
    unreferenced = int((np.bincount(mesh.faces.ravel(), minlength=n) == 0).sum())
    found = (
        (flat, "face without area is", "faces without area are"),
        (unreferenced, "vertex that no face uses is", "vertices that no face uses are"),
    )
    for oddity in found:
        if oddity[0]:
            warnings.warn(f"{printable(name)}: {plural(*oddity)} kept", KfmapsWarning, stacklevel=2)
    return mesh
