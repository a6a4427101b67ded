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
"""Exponent of the weights of links. With the 4 of Kolluri et al. webs between limbs remain on noisy points."""


def surface_of_cloud(points: np.ndarray) -> Mesh | None:
    """Return a closed mesh whose vertices are ``points (n, 3)``, in their order and projected where they are noisy.

    All points are at different positions. A few may be unused. ``None`` where they do not seem to lie on one closed
    surface, or are too noisy.
    """
    try:
        points = project_noise(points)
        faces = crust_faces(points)
    except QhullError:  # all in a plane
        return None
    max_roughness = 0.14  # above it wrong maps were "sure"
    min_used = 0.95  # share of the points that must be corners of faces
    if len(np.unique(faces)) < min_used * len(points) or roughness(points, faces) > max_roughness:
        return None
    mesh = Mesh(points, faces)
    ratio = surface_area(mesh) / cloud_areas(points).sum()
    max_area_ratio = 1.2  # between the area of the surface and the estimated one of the cloud, either way
    return mesh if 1 / max_area_ratio < ratio < max_area_ratio else None


def project_noise(points: np.ndarray) -> np.ndarray:
    """Return noisy ``points (n, 3)`` projected to the surface near them; points without noise stay as they are.

    All points are at different positions. Each goes to the quadric fitted to its neighbours over the plane through
    them, by moving least squares (Alexa et al. 2003), with more neighbours the more noise there is. This is repeated
    while they are noisy.
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
    for rows in blocks(len(points), 4000):
        distances, neighbours = tree.query(points[rows], k=count)
        weights = np.exp(-((2 * distances / distances[:, -1:]) ** 2))
        weights /= weights.sum(axis=1, keepdims=True)
        mean = (weights[:, None] @ points[neighbours])[:, 0]
        offsets = points[neighbours] - mean[:, None]
        extent, axes = np.linalg.eigh((weights[:, :, None] * offsets).transpose(0, 2, 1) @ offsets)  # the normal first
        size = np.sqrt(extent[:, 2, None, None])
        local, own = offsets @ axes / size, (points[rows] - mean)[:, None] @ axes / size
        powers = _quadratic_powers(local)
        weighted = (weights[:, :, None] * powers).transpose(0, 2, 1)
        quadric = np.linalg.solve(weighted @ powers + 1e-6 * np.eye(6), weighted @ local[:, :, :1])
        height = (_quadratic_powers(own) @ quadric - own[:, :, :1])[:, 0] * size[:, 0]
        projected[rows] = points[rows] + height * axes[:, :, 0]
        residuals = (local[:, :, :1] - powers @ quadric)[:, :, 0]
        aspect = np.maximum(extent[:, 1] / extent[:, 2], 1e-12)
        noise[rows] = np.sqrt((weights * residuals**2).sum(axis=1) / aspect)
    return projected, float(np.median(noise))


def _quadratic_powers(points: np.ndarray) -> np.ndarray:
    """Return 1, u, v, u², uv, v² of points (n, k, 3) with heights and coordinates u and v in planes, (n, k, 6)."""
    u, v = points[:, :, 1], points[:, :, 2]
    return np.stack([np.ones_like(u), u, v, u * u, u * v, v * v], axis=2)


def crust_faces(points: np.ndarray) -> np.ndarray:
    """Return the faces between Delaunay tetrahedra inside and outside, counter-clockwise seen from outside, (f, 3).

    Neighbouring tetrahedra tend to the same side the more their circumspheres overlap. The two poles of a point, the
    largest tetrahedra on both of its sides, tend to different ones. This is the eigencrust (Kolluri, Shewchuk and
    O'Brien 2004) with everything beyond the convex hull fixed outside, which makes it one symmetric positive definite
    linear system.

    ``points (n, 3)``: all at different positions; in a plane they raise :class:`scipy.spatial.QhullError`.
    """
    delaunay = Delaunay(points)
    cells, neighbours = delaunay.simplices, delaunay.neighbors
    centres, radii = _circumspheres(points, cells)
    outside = len(cells)  # number of the node for everything beyond the hull
    a, side = np.nonzero(neighbours > np.arange(outside)[:, None])
    b = neighbours[a, side]
    overlap = radii[a] ** 2 + radii[b] ** 2 - ((centres[a] - centres[b]) ** 2).sum(axis=1)
    hull, opposite = np.nonzero(neighbours < 0)
    corners, normals = outward_faces(points, cells, hull, opposite)
    hull_overlap = ((centres[hull] - points[corners[:, 0]]) * normals).sum(axis=1) / radii[hull]
    first, second, cosine = _poles(points, cells, centres, radii, corners, normals)
    rows = np.concatenate([a, hull, first])
    columns = np.concatenate([b, np.full(len(hull), outside), second])
    overlap = np.concatenate([overlap / (2 * radii[a] * radii[b]), hull_overlap])
    weights = np.concatenate([np.exp(_SHARPNESS * np.clip(overlap, -1, 1)), -np.exp(-_SHARPNESS * cosine)])
    shape = outside + 1, outside + 1
    links = coo_array((weights, (rows, columns)), shape=shape).tocsr()
    links = links + links.T
    degrees = np.asarray(abs(links).sum(axis=1)).ravel()
    matrix = (diags_array(degrees) - links).tocsr()
    right = -matrix[:outside, [outside]].toarray().ravel()
    value = cg(matrix[:outside, :outside], right, rtol=1e-5, maxiter=2000, M=diags_array(1 / degrees[:outside]))[0]
    return boundary_of_cells(delaunay, value < 0)


def boundary_of_cells(delaunay: Delaunay, inside: np.ndarray) -> np.ndarray:
    """Return the faces around the tetrahedra that are ``inside (m,)`` bool, counter-clockwise from outside, (f, 3)."""
    neighbours = delaunay.neighbors
    cell, opposite = np.nonzero(inside[:, None] & ((neighbours < 0) | ~inside[neighbours]))
    return outward_faces(delaunay.points, delaunay.simplices, cell, opposite)[0].astype(np.int64)


def circumcentres(corners: np.ndarray, flatness: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the circumcentres of tetrahedra, relative to the first corner, (m, 3), and which are flat, (m,) bool.

    ``corners (m, 4, 3)``; ``flatness``: six times the volume over the product of three edges, below which a tetrahedron
    is flat and has another point for its circumcentre.
    """
    edges = corners[:, 1:] - corners[:, :1]
    flat = np.abs(np.linalg.det(edges)) < flatness * np.linalg.norm(edges, axis=2).prod(axis=1)
    edges[flat] = np.eye(3)
    return np.linalg.solve(edges, 0.5 * (edges**2).sum(axis=2, keepdims=True))[:, :, 0], flat


def _circumspheres(points: np.ndarray, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return centres (m, 3) and radii (m,) of the circumspheres of tetrahedra, the radii bounded."""
    corners = points[cells]
    offsets, _ = circumcentres(corners, 1e-9)
    radii = np.linalg.norm(offsets, axis=1)
    largest = 10.0  # largest circumradius, over the longest side of the box around the points
    bounded = np.minimum(radii, largest * float(np.ptp(points, axis=0).max()))
    return corners[:, 0] + offsets * (bounded / radii)[:, None], bounded


def outward_faces(
    points: np.ndarray, cells: np.ndarray, cell: np.ndarray, opposite: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return faces of tetrahedra, oriented outward, and their unit normals, both (f, 3).

    ``points (n, 3)``; ``cells (m, 4)``: corners of the tetrahedra; ``cell (f,)`` and ``opposite (f,)``: tetrahedron of
    each face and its opposite corner, 0 to 3.
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
    """Return the two poles of points and the cosine between the directions to their centres.

    The pole beyond the ``hull (h, 3)``, whose faces have the ``normals (h, 3)``, has the number of cells for its own.
    """
    n = len(points)
    point, cell = cells.ravel(), np.repeat(np.arange(len(cells)), 4)
    radius = radii[cell]
    directions = (centres[cell] - points[point]) / radius[:, None]

    def largest(size: np.ndarray) -> np.ndarray:
        """Return the entry of the largest ``size`` for each point."""
        order = np.lexsort((-size, point))
        return order[np.unique(point[order], return_index=True)[1]]

    entry = largest(radius)
    first, first_direction = np.full(n, len(cells)), np.zeros((n, 3))
    first[point[entry]], first_direction[point[entry]] = cell[entry], directions[entry]
    hull_normals = np.zeros((n, 3))
    np.add.at(hull_normals, hull.ravel(), np.repeat(normals, 3, axis=0))
    on_hull = np.unique(hull)
    first[on_hull], first_direction[on_hull] = len(cells), unit_rows(hull_normals[on_hull])
    cosine = (directions * first_direction[point]).sum(axis=1)
    entry = largest(np.where(cosine < 0, radius, -1.0))
    entry = entry[cosine[entry] < 0]
    return first[point[entry]], cell[entry], cosine[entry]


def roughness(points: np.ndarray, faces: np.ndarray) -> float:
    """Return the median height of vertices above the mean of their neighbours, over the mean length of edges.

    ``points (n, 3)``, ``faces (f, 3)``. Clean bodies have 0.03 to 0.12, with 500 vertices up to 0.13. With 5,000
    vertices noise of 0.003, 0.005 and 0.01 √area makes 0.11 to 0.17, 0.19 to 0.22 and 0.25 to 0.29.
    """
    links = coo_array((np.ones(faces.size), half_edges(faces).T), shape=(len(points), len(points))).tocsr()
    links = links + links.T
    mean = (links @ points) / np.maximum(links.sum(axis=1), 1)[:, None]
    height = ((mean - points) * vertex_normals(Mesh(points, faces))).sum(axis=1)
    edge = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=2).mean()
    return float(np.median(np.abs(height[np.unique(faces)])) / edge)
