"""A texture baked: the source's picture resampled into the target's own atlas."""

from __future__ import annotations

import io

import numpy as np
from scipy.ndimage import distance_transform_edt

from kfmaps._arrays import refuse
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.connectivity import component_labels
from kfmaps.io.record import MeshFile, Picture

_SMALLEST, _LARGEST = 1024, 4096
"""Bounds of the side of a baked picture, which has the longer side of the source's."""
_TEXELS = 2_000_000
"""Texels worked on together, which bounds the memory."""
_TWICE = 0.02
"""Share of the covered texels that may lie in several faces: an atlas whose charts share space cannot be baked into."""


def decode_picture(picture: Picture) -> np.ndarray:
    """Decode a PNG or JPEG file into (h, w, 3) float64 from 0 to 1; row 0 is the top.

    Raises
    ------
    InvalidInput
        When it cannot be read.
    """
    from matplotlib.image import imread

    try:
        found = imread(io.BytesIO(picture.data), format=picture.suffix[1:])
    except (OSError, ValueError, SyntaxError) as error:
        raise refuse("the texture", "a PNG or JPEG file", str(error)[:80], "export it again") from error
    values = found / 255.0 if found.dtype.kind == "u" else found.astype(np.float64)
    if values.ndim == 2:
        values = values[:, :, None]
    return values[:, :, :3] if values.shape[2] >= 3 else np.repeat(values[:, :, :1], 3, axis=2)


def encode_png(pixels: np.ndarray) -> Picture:
    """Encode ``(h, w, 3)``, uint8 or from 0 to 1, as a PNG file."""
    from matplotlib.image import imsave

    buffer = io.BytesIO()
    imsave(buffer, pixels, format="png")
    return Picture(buffer.getvalue(), "image/png")


def _sample_picture(pixels: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Return the colours ``(q, 3)`` of a picture at ``uv (q, 2)``, linear between texels. It repeats beyond its
    borders.

    (0, 0) is the lower left corner of the picture, and the centres of texels lie half a texel inside.
    """
    height, width = pixels.shape[:2]
    x, y = uv[:, 0] * width - 0.5, (1 - uv[:, 1]) * height - 0.5
    left, top = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    s, t = (x - left)[:, None], (y - top)[:, None]
    i0, i1, j0, j1 = top % height, (top + 1) % height, left % width, (left + 1) % width
    above = (1 - s) * pixels[i0, j0] + s * pixels[i0, j1]
    below = (1 - s) * pixels[i1, j0] + s * pixels[i1, j1]
    return (1 - t) * above + t * below


def _find_texels(corners: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find the texels whose centres lie in the triangles ``corners (f, 3, 2)`` of the unit square's picture.

    Returns
    -------
    face : (q,) int64
    texel : (q,) int64
        ``row · size + column``, wrapped where triangles leave the square.
    weights : (q, 3) float64
        Barycentric coordinates of the centre.
    """
    at = np.stack([corners[:, :, 0] * size, (1 - corners[:, :, 1]) * size], axis=2) - 0.5
    low, high = np.ceil(at.min(axis=1)).astype(np.int64), np.floor(at.max(axis=1)).astype(np.int64)
    span = np.maximum(high - low + 1, 0)
    u, v = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    # Faces that wrap around the whole picture, or have no area in it, have no texels of their own.
    count = np.where((np.abs(area) > 1e-9) & (span.max(axis=1) <= size), span[:, 0] * span[:, 1], 0)
    found: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    block = np.cumsum(count) // _TEXELS
    for faces in np.split(np.arange(len(count)), np.flatnonzero(np.diff(block)) + 1):
        face = np.repeat(faces, count[faces])
        step = np.arange(len(face)) - np.repeat(np.cumsum(count[faces]) - count[faces], count[faces])
        x = low[face, 0] + step % np.maximum(span[face, 0], 1)
        y = low[face, 1] + step // np.maximum(span[face, 0], 1)
        gap = np.stack([x, y], axis=1) - at[face, 0]
        s = (gap[:, 0] * v[face, 1] - gap[:, 1] * v[face, 0]) / area[face]
        t = (u[face, 0] * gap[:, 1] - u[face, 1] * gap[:, 0]) / area[face]
        inside = (s >= -1e-9) & (t >= -1e-9) & (s + t <= 1 + 1e-9)
        s, t = s[inside], t[inside]
        found.append((face[inside], (y[inside] % size) * size + x[inside] % size, np.stack([1 - s - t, s, t], axis=1)))
    face, texel, weights = (np.concatenate(part) for part in zip(*found, strict=True))
    return face, texel, weights


def can_bake(target: MeshFile, size: int = _SMALLEST) -> bool:
    """Return whether the target has texture coordinates in which every face has room of its own."""
    if target.uv is None or target.uv_faces is None:
        return False
    corners = target.uv[target.uv_faces]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    if np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2 > 1 + _TWICE:
        return False  # more than the whole picture
    _, texel, _ = _find_texels(corners, size)
    hits = np.bincount(texel)
    # Texels on an edge that two faces share count for both: those are few, and no more than one in each row of a face.
    return bool(len(texel) and np.count_nonzero(hits > 1) <= _TWICE * np.count_nonzero(hits))


def bake_texture(
    source: MeshFile,
    target: MeshFile,
    pixels: np.ndarray,
    uv: np.ndarray,
    uv_faces: np.ndarray,
    place: PointMap | None = None,
    size: int | None = None,
) -> np.ndarray:
    """Return the source's picture resampled into the target's atlas, (size, size, 3) uint8.

    Parameters
    ----------
    source, target : MeshFile
        The target with its own texture coordinates.
    pixels : (h, w, 3) float64
        The source's picture, :func:`decode_picture`.
    uv, uv_faces : (m, 2) float64, (f_t, 3) int64
        Coordinates in the source's picture for the corners of the target's faces
        (:func:`kfmaps.io.export.transfer_uv`), in which lies what is inside a face.
    place : PointMap, optional
        Points inside triangles. Faces over a seam of the source's texture, which no coordinates of three corners
        describe, are then worked out texel by texel: each takes the closest place on the source's surface.
    size : int, optional
        By default as large as the source's picture, within bounds.

    Returns
    -------
    (size, size, 3) uint8
        Beyond the borders of charts each texel has the colour of the nearest covered one, so that no other colour
        bleeds in where a viewer mixes neighbours.
    """
    assert target.uv is not None
    assert target.uv_faces is not None
    size = size or int(np.clip(max(pixels.shape[:2]), _SMALLEST, _LARGEST))
    face, texel, weights = _find_texels(target.uv[target.uv_faces], size)
    if len(face) == 0:
        raise refuse("target", "texture coordinates with room for its faces", "none", "export without them")
    where = np.einsum("qi,qij->qj", weights, uv[uv_faces[face]])
    if place is not None and source.uv is not None and source.uv_faces is not None:
        corners, n = source.uv_faces, len(source.uv)
        charts = component_labels(n, corners[:, :2].ravel(), corners[:, 1:].ravel())[1][corners[:, 0]]  # of its faces
        chart = charts[place.faces][target.mesh.faces]
        torn = (chart != chart[:, :1]).any(axis=1) | (uv_faces != target.mesh.faces).any(axis=1)
        single = (uv_faces == uv_faces[:, :1]).all(axis=1)  # faces outside a part have one colour
        seam = np.flatnonzero((torn & ~single)[face])
        corners = point_positions(place, source.mesh)[target.mesh.faces[face[seam]]]
        points = np.einsum("qi,qij->qj", weights[seam], corners)
        found = closest_points(points, source.mesh.vertices, source.mesh.faces)
        where[seam] = np.einsum("qi,qij->qj", found.weights, source.uv[source.uv_faces[found.faces]])
    picture = np.zeros((size * size, 3))
    picture[texel] = _sample_picture(pixels, where)
    covered = np.zeros(size * size, dtype=bool)
    covered[texel] = True
    bare = ~covered.reshape(size, size)
    nearest = distance_transform_edt(bare, return_distances=False, return_indices=True)
    assert nearest is not None
    return np.rint(255 * picture.reshape(size, size, 3)[nearest[0], nearest[1]]).astype(np.uint8)
