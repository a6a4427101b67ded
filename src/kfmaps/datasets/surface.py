"""Points spread evenly over an implicit surface, and the closed triangle mesh through them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial import Delaunay, KDTree

from kfmaps._arrays import NotConverged
from kfmaps.geometry.cloud_surface import boundary_of_cells, circumcentres
from kfmaps.geometry.mesh import Mesh, face_areas, unit_rows
from kfmaps.geometry.subdivision import divide_faces
from kfmaps.geometry.topology import topology

_Field = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""``field(points (n, 3)) -> (values (n,), gradients (n, 3))``: negative inside, zero on the surface."""

_Warp = Callable[[np.ndarray], np.ndarray]
"""``warp(points (n, 3)) -> (n, 3)``: a smooth one-to-one map of space near the surface."""

_RELAXATIONS = 30
_ATTEMPTS = 5
_SCATTERED = 50_000  # vertices up to which points are spread one by one; larger meshes are subdivided smaller ones


def _project(field: _Field, points: np.ndarray, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Move ``points`` onto the surface by Newton steps along the gradient; return them and the unit normals there."""
    for _ in range(steps):
        values, gradients = field(points)
        points = points - gradients * (values / (gradients**2).sum(axis=1))[:, None]
    return points, unit_rows(field(points)[1])


def _scatter(field: _Field, box: np.ndarray, count: int, rng: np.random.Generator) -> tuple[np.ndarray, float]:
    """Return random points near the surface, uniform in area, and an estimate of the area.

    They are drawn uniformly from the thin layer |value| / |gradient| < width, whose volume is twice the
    width times the area.
    """
    low, high = box
    width = 0.01 * float(np.linalg.norm(high - low))
    kept: list[np.ndarray] = []
    tried = found = 0
    while found < count:
        points = rng.uniform(low, high, (4 * count, 3))
        values, gradients = field(points)
        points = points[np.abs(values) < width * np.linalg.norm(gradients, axis=1)]
        kept.append(points)
        tried += 4 * count
        found += len(points)
    area = float(np.prod(high - low)) * found / tried / (2 * width)
    return np.concatenate(kept)[:count], area


def _tangents(normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors (n, 3) that make a right-handed frame with each unit normal."""
    helper = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first = unit_rows(np.cross(helper, normals))
    return first, np.cross(normals, first)


def _warped_normals(warp: _Warp, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Return normals (n, 3) of the warped surface, as long as the factor by which area grows there."""
    step = 1e-4 * float(np.ptp(points, axis=0).max())
    first, second = ((warp(points + step * t) - warp(points - step * t)) / (2 * step) for t in _tangents(normals))
    return np.cross(first, second)


def _spread(
    field: _Field, box: np.ndarray, count: int, rng: np.random.Generator, warp: _Warp | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Return ``count`` points spread evenly over the surface: random ones that then push each other apart.

    ``box (2, 3)``: lowest and highest corner of a box around the surface; ``warp``: when given, the points are even
    after this deformation. Returns ``points, normals (count, 3)``: on the surface before the deformation.
    """
    points, area = _scatter(field, box, count, rng)
    points, normals = _project(field, points, 3)
    scale = np.ones(count)
    for step in range(_RELAXATIONS):
        if warp is not None and step % 5 == 0:
            scale = np.linalg.norm(_warped_normals(warp, points, normals), axis=1) ** -0.5
        # The distance between neighbours in a hexagonal pattern with this many points to the area.
        spacing = scale * np.sqrt(2 / np.sqrt(3) * area / (scale**2).sum())
        found = KDTree(points).query(points, k=13)
        distance, near = np.asarray(found[0])[:, 1:], np.asarray(found[1])[:, 1:]
        reach = 0.8 * (spacing[:, None] + spacing[near])
        push = np.clip(1 - distance / reach, 0, None) / np.maximum(distance, 1e-12)
        shift = (push[:, :, None] * (points[:, None] - points[near])).sum(axis=1)
        shift -= (shift * normals).sum(axis=1, keepdims=True) * normals
        points, normals = _project(field, points + 0.35 * spacing[:, None] * shift, 1)
    return _project(field, points, 2)


def _triangulate(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Return the faces of the closed surface through ``points``, counter-clockwise seen from outside, (f, 3).

    They are the boundary of the union of the Delaunay tetrahedra whose circumcentre is inside; the
    circumcentre's nearest surface points are the corners, so their normals tell inside from outside. For
    points that are dense against the surface's thickness it is the restricted Delaunay triangulation
    (Amenta and Bern 1999).
    """
    delaunay = Delaunay(points)
    corners = points[delaunay.simplices]
    offsets, flat = circumcentres(corners, 1e-14)
    centres = corners[:, 0] + offsets
    height = ((centres[:, None] - corners) * normals[delaunay.simplices]).sum(axis=(1, 2))
    return boundary_of_cells(delaunay, (height < 0) & ~flat)


def _is_closed(mesh: Mesh, genus: int) -> bool:
    """Return whether a mesh is one closed oriented manifold of that genus that uses all of its vertices."""
    found = topology(mesh)
    odd = found.inconsistent_edges or found.unreferenced_vertices
    return found.is_closed and found.is_manifold and not odd and (found.components, found.genus) == (1, genus)


def _subdivide(field: _Field, points: np.ndarray, faces: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Cut every face in four, then the largest in three until there are ``count`` points.

    The new points lie on the surface itself, not on the faces.
    """
    edges, faces = divide_faces(faces, len(points))
    points = np.concatenate([points, 0.5 * (points[edges[:, 0]] + points[edges[:, 1]])])
    largest = np.argsort(-face_areas(Mesh(points, faces)), kind="stable")[: count - len(points)]
    cut, centres = faces[largest], len(points) + np.arange(len(largest))
    thirds = [np.stack([cut[:, i], cut[:, (i + 1) % 3], centres], axis=1) for i in range(3)]
    points = np.concatenate([points, points[cut].mean(axis=1)])
    return _project(field, points, 3)[0], np.concatenate([np.delete(faces, largest, axis=0), *thirds])


def closed_mesh(
    field: _Field,
    box: np.ndarray,
    count: int,
    rng: np.random.Generator,
    *,
    genus: int = 0,
    warp: _Warp | None = None,
    scattered: int | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return ``count`` points (count, 3) on the surface and the faces (f, 3) of a closed mesh through them.

    With a ``warp`` the points are given before that deformation, but spread and triangulated after it. More than
    ``scattered`` points (:data:`_SCATTERED`, and at most that) are those of a mesh of a quarter as many, subdivided,
    which takes a tenth of the time.
    """
    if count > min(_SCATTERED, scattered or _SCATTERED):
        fewer = (count + 3 * (2 - 2 * genus)) // 4
        points, faces = closed_mesh(field, box, fewer, rng, genus=genus, warp=warp, scattered=scattered)
        return _subdivide(field, points, faces, count)
    for _ in range(_ATTEMPTS):
        points, normals = _spread(field, box, count, rng, warp)
        if warp is None:
            faces = _triangulate(points, normals)
        else:
            faces = _triangulate(warp(points), unit_rows(_warped_normals(warp, points, normals)))
        if _is_closed(Mesh(points, faces), genus):
            return points, faces
    raise NotConverged(f"no closed mesh of genus {genus} through {count} points. Ask for more vertices.")
