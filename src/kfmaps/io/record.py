"""Records of a mesh file's content, and the triangles of polygons."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field

import numpy as np

from kfmaps._arrays import KfmapsWarning, check, index_ranges, refuse
from kfmaps._records import short_repr
from kfmaps._texts import plural
from kfmaps.geometry.mesh import Mesh


@dataclass(frozen=True)
class Picture:
    """The content of a picture file."""

    data: bytes
    kind: str  # "image/png" or "image/jpeg"

    @property
    def suffix(self) -> str:
        """The extension of a file of this kind."""
        return ".png" if self.kind == "image/png" else ".jpg"


_SIGNATURES = {b"\x89PNG\r\n\x1a\n": "image/png", b"\xff\xd8\xff": "image/jpeg"}  # first bytes of each kind


def picture_in(data: bytes) -> Picture | None:
    """Return ``data`` as a picture, by its first bytes; ``None`` when it is neither PNG nor JPEG."""
    return next((Picture(data, kind) for first, kind in _SIGNATURES.items() if data.startswith(first)), None)


@dataclass(frozen=True, eq=False)
class Skin:
    """A skeleton, and the weight of each joint at each vertex."""

    names: tuple[str, ...]  # of the joints
    parents: np.ndarray  # (j,): the joint above each, -1 of roots
    matrices: np.ndarray  # (j, 4, 4): from each joint's frame to the mesh's, at rest; the last column is its position
    weights: np.ndarray  # (n, j): each row adds up to 1, or is 0 throughout for a vertex that follows no joint

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class MeshFile:
    """A mesh with colours, texture, morph targets and skin of its file.

    Attributes
    ----------
    mesh : Mesh
        Vertices in the order and number of the file; polygons cut into triangles.
    colors : (n, 3) float64 or None
        Red, green and blue from 0 to 1, one per vertex.
    uv : (m, 2) float64 or None
        Texture coordinates; (0, 0) is the lower left corner of the picture.
    uv_faces : (f, 3) int64 or None
        For each corner of each face the row of ``uv``. At a seam one vertex has several.
    picture : Picture or None
        The one texture of the whole shape, where the file holds it (GLB, glTF) or names it (OBJ).
    morphs : dict of str to (n, 3) float64
        Morph targets (shape keys) by name: displacements of the vertices.
    skin : Skin or None
    """

    mesh: Mesh
    colors: np.ndarray | None = None
    uv: np.ndarray | None = None
    uv_faces: np.ndarray | None = None
    picture: Picture | None = None
    morphs: dict[str, np.ndarray] = field(default_factory=dict)
    skin: Skin | None = None

    __repr__ = short_repr

    @property
    def corner_uv(self) -> np.ndarray:
        """Texture coordinates of the corners of each face, (f, 3, 2), for a mesh that has any."""
        assert self.uv is not None
        assert self.uv_faces is not None
        return self.uv[self.uv_faces]


def fan(sizes: np.ndarray) -> np.ndarray:
    """Return the triangles of polygons, each polygon as a fan around its first corner, in order.

    ``sizes (p,)``: how many corners each polygon has; with 2 it is an edge and has no triangle. Returns (t, 3):
    positions in the list of all corners, one polygon after another.
    """
    start = np.cumsum(sizes) - sizes
    second = index_ranges(start + 1, sizes - 2)
    return np.stack([np.repeat(start, sizes - 2), second, second + 1], axis=1)


def has_too_few_corners(sizes: np.ndarray, name: str) -> np.ndarray:
    """Return which of the faces of a file have too few corners, (p,) bool; ``sizes (p,)``: how many they have.

    Some programs write edges as faces of two corners: among other faces they are left out, and a warning says so.
    """
    is_edge = sizes == 2
    if is_edge.any() and (sizes > 2).any():
        text = plural(int(is_edge.sum()), "face of two corners is left out", "faces of two corners are left out")
        warnings.warn(f"{name}: {text}", KfmapsWarning, stacklevel=6)
        return sizes < 2
    return sizes < 3


def split_polygons(flat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of polygons and how many each has, of a flat list "count, corner, corner, ..." per polygon."""
    starts, at = [], 0
    while at < len(flat):
        starts.append(at)
        at += 1 + max(int(flat[at]), 0)
    if at != len(flat):
        raise refuse("faces", "a list of counts and corners", "one that is cut short", "check how it was made")
    corners = np.ones(len(flat), dtype=bool)
    corners[starts] = False
    return flat[corners].astype(np.int64), flat[starts].astype(np.int64)


def unit_colors(colors: np.ndarray) -> np.ndarray:
    """Return the colours of a file as fractions: divided by 255 when any number is above 1, without alpha."""
    return np.clip(colors[:, :3] / (255.0 if colors.max(initial=0.0) > 1 else 1.0), 0.0, 1.0)


def check_colors(colors: np.ndarray, n: int) -> np.ndarray:
    """Return colours as :func:`kfmaps.write_mesh` accepts them as (n, 3) float64 from 0 to 1."""
    colors = np.asarray(colors)
    colors = colors[:, :3] if colors.shape[1:] == (4,) else colors
    check(colors, "colors", shape=(n, 3), remedy="give red, green and blue for each vertex")
    high = 255 if np.issubdtype(colors.dtype, np.integer) else 1
    if n and not (colors.min() >= 0 and colors.max() <= high):
        raise refuse("colors", f"numbers from 0 to {high}", f"{colors.min()} to {colors.max()}", "scale them")
    return colors.astype(np.float64) / high


def to_bytes(colors: np.ndarray) -> np.ndarray:
    """Return fractions from 0 to 1 as the nearest whole numbers from 0 to 255."""
    return np.rint(colors * 255).astype(np.uint8)
