"""Draw a surface or point cloud into matplotlib axes, as shaded polygons sorted by depth."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from kfmaps._arrays import check
from kfmaps.geometry.connectivity import half_edges
from kfmaps.geometry.mesh import Mesh, face_normals, vertex_normals
from kfmaps.viz.camera import View, automatic_view

_LIGHTS = (((-0.45, 0.65, 0.75), 0.40), ((0.8, 0.1, 0.55), 0.12))
"""Direction (right, up, towards the camera) and strength of the lamps."""
_AMBIENT = 0.58
_SKY = 0.06  # extra light of faces that look up, negative below
_MIN_TRIANGLES = 24000  # with fewer, each triangle of one colour is divided into four, so that none can be seen


def _is_watertight(faces: np.ndarray, count: int) -> bool:
    """Return whether faces run along each edge as often one way as the other; then no inside can be seen."""
    edges = half_edges(faces)
    return np.array_equal(np.sort(edges @ [count, 1]), np.sort(edges @ [1, count]))


def shade(normals: np.ndarray) -> np.ndarray:
    """Return the brightness (...,) of surfaces with unit normals (..., 3) in camera axes (Lambert's law)."""
    light = _AMBIENT + _SKY * normals[..., 1]
    for direction, strength in _LIGHTS:
        cosine = normals @ (np.array(direction) / np.linalg.norm(direction))
        light = light + strength * np.maximum(cosine, 0)
    return light


def _subdivide(corners: np.ndarray) -> np.ndarray:
    """Divide triangles with corner values (f, 3, d) into four each, cut at mid-edge."""
    a, b, c = corners.swapaxes(0, 1)
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def draw_surface(
    ax: Axes, mesh: Mesh, colors: np.ndarray, view: View | None = None, *, shading: bool = True
) -> PolyCollection | None:
    """Draw a mesh, or a point cloud as dots, and fit the axes around it.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Its frame is switched off and its limits are set.
    mesh : Mesh
    colors : (n, 3)
        sRGB in [0, 1] per vertex, blended over the faces.
    view : View, optional
        By default :func:`~kfmaps.viz.automatic_view`.
    shading : bool
        Whether the surface is shaded; else the colours are drawn as they are.

    Returns
    -------
    matplotlib.collections.PolyCollection or None
        None for a point cloud.

    Raises
    ------
    InvalidInput
        When there is not one colour per vertex.
    """
    colors = check(np.asarray(colors, dtype=np.float64), "colors", shape=(len(mesh.vertices), 3))
    axes = (view or automatic_view(mesh)).axes()
    points = mesh.vertices @ axes.T
    ax.set_axis_off()
    ax.set_aspect("equal")
    middle, half = (points.max(axis=0) + points.min(axis=0)) / 2, np.ptp(points, axis=0) / 2
    half_size = 1.03 * half + 1e-9 + 0.005 * half.max()
    ax.set_xlim(middle[0] - half_size[0], middle[0] + half_size[0])
    ax.set_ylim(middle[1] - half_size[1], middle[1] + half_size[1])
    if len(mesh.faces) == 0:
        order = np.argsort(points[:, 2])
        depth = (points[order, 2] - middle[2]) / max(half[2], 1e-300)
        dots = colors[order] * (0.85 + 0.15 * depth)[:, None] if shading else colors[order]
        size = 20000 / max(len(points), 500)
        ax.scatter(*points[order, :2].T, c=dots, s=size, linewidths=0, rasterized=True)
        return None

    flat_normals = face_normals(mesh) @ axes.T
    facing = flat_normals[:, 2]
    faces, normals = mesh.faces, vertex_normals(mesh) @ axes.T
    if _is_watertight(faces, len(points)):
        # Only the faces towards the camera can be seen on a closed surface; all faces may look inward.
        a, b, c = (points[faces[:, i]] for i in range(3))
        outward = np.sign(((a - points.mean(axis=0)) * np.cross(b - a, c - a)).sum()) or 1.0
        is_visible = outward * facing > 0
        faces, flat_normals, facing = faces[is_visible], flat_normals[is_visible], facing[is_visible]
    corners = normals[faces]
    corners = corners * np.where((corners * flat_normals[:, None]).sum(axis=2, keepdims=True) < 0, -1, 1)
    corners = corners * np.where(facing < 0, -1, 1)[:, None, None]
    parts = np.concatenate([points[faces], corners, colors[faces]], axis=2)
    while 0 < len(parts) < _MIN_TRIANGLES:
        parts = _subdivide(parts)
    places, corners, blend = parts[:, :, :3], parts[:, :, 3:6], parts[:, :, 6:].mean(axis=1)
    if shading:
        smooth = corners.mean(axis=1)
        smooth /= np.maximum(np.linalg.norm(smooth, axis=1, keepdims=True), 1e-12)
        blend = blend * shade(smooth)[:, None]
    blend = np.clip(blend, 0, 1)
    order = np.argsort(places[:, :, 2].mean(axis=1), kind="stable")
    # An edge in the face's own colour hides the seam that antialiasing leaves between neighbours.
    collection = PolyCollection(
        cast(Any, places[order, :, :2]),
        facecolors=blend[order],
        edgecolors=blend[order],
        linewidths=0.5,
        rasterized=True,
    )
    collection.set_joinstyle("round")
    ax.add_collection(collection, autolim=False)
    return collection
