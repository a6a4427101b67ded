"""What the pages show of a map, vertex by vertex: colours, a texture, distortion, links, an alignment."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from kfmaps.mesh import Mesh, face_areas


def _principal(mesh: Mesh) -> np.ndarray:
    """Vertices centred, in their principal axes of falling extent, divided by the longest extent, (n, 3).

    Each axis points to where the vertices' third moment is positive, so that the sign is not the
    eigensolver's whim.
    """
    centred = mesh.vertices - mesh.vertices.mean(axis=0)
    _, _, axes = np.linalg.svd(centred.T @ centred)
    turned = centred @ axes.T
    turned *= np.where((turned**3).sum(axis=0) < 0, -1.0, 1.0)
    extents = np.ptp(turned, axis=0)
    return (turned - turned.min(axis=0))[:, np.argsort(-extents, kind="stable")] / max(extents.max(), 1e-300)


def _oklch(lightness: np.ndarray, chroma: np.ndarray, hue: np.ndarray) -> np.ndarray:
    """sRGB in [0, 1], (n, 3), of colours in Ottosson's OKLCh (2020); hue in radians."""
    a, b = chroma * np.cos(hue), chroma * np.sin(hue)
    lms = np.stack(
        [
            lightness + 0.3963377774 * a + 0.2158037573 * b,
            lightness - 0.1055613458 * a - 0.0638541728 * b,
            lightness - 0.0894841775 * a - 1.2914855480 * b,
        ],
        axis=1,
    )
    to_rgb = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    linear = np.clip(lms**3 @ to_rgb.T, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def position_colours(mesh: Mesh) -> np.ndarray:
    """A smooth colour for each vertex from where it lies, (n, 3) sRGB in [0, 1].

    The hue runs along the longest extent, the lightness along the second, the strength along the third, so
    that left and right, or front and back, differ as well as head and foot.
    """
    along, across, through = _principal(mesh).T
    spread = [x / max(x.max(), 1e-300) for x in (along, across, through)]
    return _oklch(0.58 + 0.32 * spread[1], 0.10 + 0.07 * spread[2], np.deg2rad(20 + 290 * spread[0]))


def planar_coordinates(mesh: Mesh) -> np.ndarray:
    """Coordinates for a texture, (n, 2) in [0, 1]: the plane of the two longest extents, one scale for both."""
    return _principal(mesh)[:, :2]


def area_distortion(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Base-2 logarithm of how the map changes area around each target vertex, (n_t,), within [-4, 4].

    The area on the source of the images of the faces around a vertex over the area of those faces on the
    target, both shapes scaled to unit area. 0 keeps area, 1 doubles it, -1 halves it; faces collapsed to
    nothing are held at -4. NaN where no face with area meets the vertex, and everywhere on point clouds.
    """
    n = len(target.vertices)
    if len(target.faces) == 0 or len(source.faces) == 0:
        return np.full(n, np.nan)
    image = face_areas(Mesh(source.vertices[target_to_source], target.faces)) / face_areas(source).sum()
    own = face_areas(target) / face_areas(target).sum()
    corners = target.faces.ravel()
    here = np.bincount(corners, np.repeat(own, 3), minlength=n)
    there = np.bincount(corners, np.repeat(image, 3), minlength=n)
    ratio = np.divide(there, here, out=np.full(n, np.nan), where=here > 0)
    return np.log2(np.clip(ratio, 2.0**-4, 2.0**4))


def nearest_reached(source: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """For each source vertex the nearest one that some target vertex lands on, (n_s,); itself if one does.

    Nearest along the edges, so that a point of an arm is not linked to the leg beside it; straight through
    space for point clouds and for parts that no target vertex reaches.
    """
    n = len(source.vertices)
    reached = np.unique(target_to_source)
    nearest = np.full(n, -1, dtype=np.int64)
    if len(source.faces):
        ends = source.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        ends = np.unique(np.sort(ends, axis=1), axis=0)
        ends = ends[ends[:, 0] != ends[:, 1]]
        length = np.linalg.norm(source.vertices[ends[:, 0]] - source.vertices[ends[:, 1]], axis=1)
        # A sparse graph reads 0 as "no edge": coincident vertices get the least length instead.
        graph = coo_array((np.maximum(length, 1e-300), (ends[:, 0], ends[:, 1])), shape=(n, n)).tocsr()
        result = dijkstra(graph, directed=False, indices=reached, min_only=True, return_predecessors=True)
        found = np.isfinite(result[0])
        nearest[found] = result[2][found]
    nearest[reached] = reached
    lost = nearest < 0
    if lost.any():
        nearest[lost] = reached[KDTree(source.vertices[reached]).query(source.vertices[lost])[1]]
    return nearest


def alignment(source: Mesh, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """The rotation, (3, 3), that turns the target's vertices best onto their matches (Kabsch 1976)."""
    there = source.vertices[target_to_source]
    here = target.vertices - target.vertices.mean(axis=0)
    u, _, vt = np.linalg.svd(here.T @ (there - there.mean(axis=0)))
    flip = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt)) or 1.0])
    return (u @ flip @ vt).T
