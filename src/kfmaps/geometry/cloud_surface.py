"""The closed surface through a point cloud, without normals."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import cg
from scipy.spatial import Delaunay, KDTree, QhullError

from kfmaps._arrays import blocks
from kfmaps.geometry.connectivity import half_edges
from kfmaps.geometry.mesh import Mesh, surface_area, unit_rows, vertex_normals
from kfmaps.geometry.point_cloud import cloud_areas

_SHARPNESS = 12.0
"""Exponent of the weights of links. With the 4 of Kolluri et al. noise leaves webs between limbs."""


def surface_of_cloud(points: np.ndarray) -> Mesh | None:
    """Return a closed mesh whose vertices are ``points (n, 3)``, in their order and projected where they are noisy.

    All points are at different positions; a few may be of no face. ``None`` where they do not seem to lie on one closed
    surface, or are too noisy.
    """
    try:
        points = project_noise(points)
        faces = crust_faces(points)
    except QhullError:  # all in a plane
        return None
    max_roughness = 0.14  # with more, maps were wrong and called "sure"
    min_used = 0.95  # share of the points that must be corners of faces
    if len(np.unique(faces)) < min_used * len(points) or roughness(points, faces) > max_roughness:
        return None
    mesh = Mesh(points, faces)
    ratio = surface_area(mesh) / cloud_areas(points).sum()
    max_area_ratio = 1.2  # how much larger or smaller than the cloud's estimated area the surface may be
    return mesh if 1 / max_area_ratio < ratio < max_area_ratio else None


def project_noise(points: np.ndarray) -> np.ndarray:
    """Return noisy ``points (n, 3)`` projected to the surface near which they lie; clean points as they are.

    All points are at different positions. Each goes to the quadric fitted to its neighbours in the plane through them,
    by moving least squares (Alexa et al. 2003). The more noise, the more neighbours. Projected points are projected
    again while they are noisy.
    """
    neighbours = 18  # nearest points that noise is estimated from
    # Estimated noise, see :func:`_fit_quadrics`, from which points are projected. Clean bodies have 0.02 to 0.12; noise
    # of 0.003 and 0.01 √area makes 0.3 and 0.67 on 5,000 points.
    max_noise = 0.15
    neighbours_per_noise = 450.0  # neighbours to project by, over the squared noise
    projected_by = 30, 75  # the fewest and the most of them: with more, limbs of 5,000 points are flattened
    for _ in range(3):  # the most projections
        noise = _fit_quadrics(points, neighbours)[1]
        if noise < max_noise:
            break
        count = int(np.clip(neighbours_per_noise * noise**2, *projected_by))
        points = _fit_quadrics(points, count)[0]
    return points


def _fit_quadrics(points: np.ndarray, count: int) -> tuple[np.ndarray, float]:
    """Return points projected to quadrics fitted to their ``count`` nearest, (n, 3), and the noise of the points.

    The noise is the median of root mean squared distances from the quadric, over the extent of the neighbours in it.
    """
    tree, count = KDTree(points), min(count, len(points))
    projected, noise = np.empty_like(points), np.empty(len(points))
    for some in blocks(len(points), 4000):  # points that are projected at once
        far, near = tree.query(points[some], k=count)
        weights = np.exp(-((2 * far / far[:, -1:]) ** 2))
        weights /= weights.sum(axis=1, keepdims=True)
        middle = (weights[:, None] @ points[near])[:, 0]
        offsets = points[near] - middle[:, None]
        extent, axes = np.linalg.eigh((weights[:, :, None] * offsets).transpose(0, 2, 1) @ offsets)  # the normal first
        size = np.sqrt(extent[:, 2, None, None])
        around, own = offsets @ axes / size, (points[some] - middle)[:, None] @ axes / size
        powers = _quadratic_powers(around)
        weighted = (weights[:, :, None] * powers).transpose(0, 2, 1)
        quadric = np.linalg.solve(weighted @ powers + 1e-6 * np.eye(6), weighted @ around[:, :, :1])
        height = (_quadratic_powers(own) @ quadric - own[:, :, :1])[:, 0] * size[:, 0]
        projected[some] = points[some] + height * axes[:, :, 0]
        missed = (around[:, :, :1] - powers @ quadric)[:, :, 0]
        narrow = np.maximum(extent[:, 1] / extent[:, 2], 1e-12)
        noise[some] = np.sqrt((weights * missed**2).sum(axis=1) / narrow)
    return projected, float(np.median(noise))


def _quadratic_powers(points: np.ndarray) -> np.ndarray:
    """Return 1, u, v, u², uv, v² of points (n, k, 3) with heights and coordinates u and v in planes, (n, k, 6)."""
    u, v = points[:, :, 1], points[:, :, 2]
    return np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=2)


def crust_faces(points: np.ndarray) -> np.ndarray:
    """Return the faces between Delaunay tetrahedra inside and outside, counter-clockwise seen from outside, (f, 3).

    Neighbours are on the same side the more their circumspheres overlap; the largest tetrahedra at a point on both of
    its sides, the poles, are on different ones. The eigencrust (Kolluri, Shewchuk and O'Brien 2004), with what lies
    beyond the convex hull held outside: one linear system with a symmetric positive definite matrix.

    ``points (n, 3)``: all at different positions; in a plane they raise :class:`scipy.spatial.QhullError`.
    """
    delaunay = Delaunay(points)
    cells, neighbours = delaunay.simplices, delaunay.neighbors
    centres, radii = _circumspheres(points, cells)
    outside = len(cells)
    # Neighbours, and the cells at the hull with all that lies beyond.
    a, side = np.nonzero(neighbours > np.arange(outside)[:, None])
    b = neighbours[a, side]
    overlap = radii[a] ** 2 + radii[b] ** 2 - ((centres[a] - centres[b]) ** 2).sum(axis=1)
    hull, opposite = np.nonzero(neighbours < 0)
    corners, normals = outward_faces(points, cells, hull, opposite)
    beyond = ((centres[hull] - points[corners[:, 0]]) * normals).sum(axis=1) / radii[hull]
    first, second, angle = _poles(points, cells, centres, radii, corners, normals)
    rows = np.concatenate([a, hull, first])
    columns = np.concatenate([b, np.full(len(hull), outside), second])
    alike = np.concatenate([overlap / (2 * radii[a] * radii[b]), beyond])
    weights = np.concatenate([np.exp(_SHARPNESS * np.clip(alike, -1, 1)), -np.exp(-_SHARPNESS * angle)])
    shape = outside + 1, outside + 1
    links = coo_array((weights, (rows, columns)), shape=shape).tocsr()
    links = links + links.T
    degrees = np.asarray(abs(links).sum(axis=1)).ravel()
    matrix = (diags_array(degrees) - links).tocsr()
    right = -matrix[:outside, [outside]].toarray().ravel()
    value = cg(matrix[:outside, :outside], right, rtol=1e-5, maxiter=2000, M=diags_array(1 / degrees[:outside]))[0]
    inside = value < 0
    cell, opposite = np.nonzero(inside[:, None] & ((neighbours < 0) | ~inside[neighbours]))
    return outward_faces(points, cells, cell, opposite)[0].astype(np.int64)


def _circumspheres(points: np.ndarray, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return centres (m, 3) and radii (m,) of spheres through the corners of tetrahedra; of flat ones some sphere."""
    corners = points[cells]
    edges = corners[:, 1:] - corners[:, :1]
    flat = np.abs(np.linalg.det(edges)) < 1e-9 * np.linalg.norm(edges, axis=2).prod(axis=1)
    edges[flat] = np.eye(3)
    middle = np.linalg.solve(edges, 0.5 * (edges**2).sum(axis=2, keepdims=True))[:, :, 0]
    radii = np.linalg.norm(middle, axis=1)
    largest = 10.0  # largest circumradius, over the longest side of the box around the points
    kept = np.minimum(radii, largest * float(np.ptp(points, axis=0).max()))
    return corners[:, 0] + middle * (kept / radii)[:, None], kept


def outward_faces(
    points: np.ndarray, cells: np.ndarray, cell: np.ndarray, opposite: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the faces of tetrahedra that lie opposite to a corner each, and their unit normals, both (f, 3).

    ``points (n, 3)``; ``cells (m, 4)``: corners of the tetrahedra; ``cell (f,)`` and ``opposite (f,)``: of each face
    its tetrahedron and, from 0 to 3, the corner that it does not have. It is turned away from that.
    """
    # Corners of the face opposite to each corner of a tetrahedron.
    others = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
    faces = np.take_along_axis(cells[cell], others[opposite], axis=1)
    a, b, c = (points[faces[:, i]] for i in range(3))
    normals = unit_rows(np.cross(b - a, c - a))
    inward = ((points[cells[cell, opposite]] - a) * normals).sum(axis=1) > 0
    faces[inward] = faces[inward][:, ::-1]
    return faces, np.where(inward[:, None], -normals, normals)


def _poles(
    points: np.ndarray,
    cells: np.ndarray,
    centres: np.ndarray,
    radii: np.ndarray,
    hull: np.ndarray,
    normals: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return pairs of cells on both sides of points and the cosine between the directions to their centres.

    The number of cells stands for what lies beyond the ``hull`` (h, 3), whose faces have the ``normals`` (h, 3).
    """
    n = len(points)
    at, cell = cells.ravel(), np.repeat(np.arange(len(cells)), 4)
    radius = radii[cell]
    towards = (centres[cell] - points[at]) / radius[:, None]

    def largest(size: np.ndarray) -> np.ndarray:
        order = np.lexsort((-size, at))
        return order[np.unique(at[order], return_index=True)[1]]

    one = largest(radius)
    first, direction = np.full(n, len(cells)), np.zeros((n, 3))
    first[at[one]], direction[at[one]] = cell[one], towards[one]
    out = np.zeros((n, 3))
    np.add.at(out, hull.ravel(), np.repeat(normals, 3, axis=0))
    on_hull = np.unique(hull)
    first[on_hull], direction[on_hull] = len(cells), unit_rows(out[on_hull])
    angle = (towards * direction[at]).sum(axis=1)
    other = largest(np.where(angle < 0, radius, -1.0))
    other = other[angle[other] < 0]
    return first[at[other]], cell[other], angle[other]


def roughness(points: np.ndarray, faces: np.ndarray) -> float:
    """Return the median height of corners over the mean of their neighbours, over the mean length of edges.

    ``points (n, 3)``, ``faces (f, 3)``. Clean bodies have 0.03 to 0.12, of 500 vertices up to 0.13; on 5,000 vertices
    noise of 0.003, 0.005 and 0.01 √area makes 0.11 to 0.17, 0.19 to 0.22 and 0.25 to 0.29.
    """
    links = coo_array((np.ones(faces.size), half_edges(faces).T), shape=(len(points), len(points))).tocsr()
    links = links + links.T
    mean = (links @ points) / np.maximum(links.sum(axis=1), 1)[:, None]
    height = ((mean - points) * vertex_normals(Mesh(points, faces))).sum(axis=1)
    edge = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=2).mean()
    return float(np.median(np.abs(height[np.unique(faces)])) / edge)
