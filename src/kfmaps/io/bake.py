"""A texture carried to a target: the source's coordinates where they describe it, else a picture baked anew."""

from __future__ import annotations

import io
import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kfmaps._arrays import KfmapsWarning, index_ranges, refuse
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.record import MeshFile, Picture, bytes_of

_SMALLEST, _LARGEST = 1024, 4096
"""Bounds of the longer side of a baked picture, which is that of the source's unless a size is given."""
_TEXELS = 2_000_000  # texels worked on together, which bounds the memory
_TWICE = 0.02
"""Share of the covered texels that may lie in several faces: an atlas whose charts share space cannot be baked into."""
_OFF = 0.1
"""How far the coordinates in the middle of a face may be from the mean of its corners', in edge lengths: beyond it,
the face lies over a seam of the texture."""
_INSET = 0.05  # how far a corner is moved towards the middle of its face to find on which side of a seam the face lies
_MARGIN = 3  # texels around each face that is packed into the picture, which get the nearest colour


def decode_picture(picture: Picture) -> np.ndarray:
    """Decode a PNG or JPEG file into (h, w, 3) float64 from 0 to 1; row 0 is the top."""
    from PIL import Image

    try:
        image = Image.open(io.BytesIO(picture.data))
        if image.mode.startswith("I"):  # grey of sixteen bits, which would be clipped
            return np.repeat(np.asarray(image)[:, :, None] / 65535.0, 3, axis=2)
        return np.asarray(image.convert("RGB")) / 255.0
    except (OSError, ValueError, SyntaxError) as error:
        raise refuse("the texture", "a PNG or JPEG file", str(error)[:80], "export it again") from error


def encode_png(pixels: np.ndarray) -> Picture:
    """Encode ``(h, w, 3)``, uint8 or from 0 to 1, as a PNG file."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(pixels if pixels.dtype == np.uint8 else bytes_of(pixels)).save(buffer, "png")
    return Picture(buffer.getvalue(), "image/png")


def _sample_picture(pixels: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """The colours (q, 3) of a picture at ``uv (q, 2)``, linear between the centres of texels; it is periodic."""
    height, width = pixels.shape[:2]
    x, y = uv[:, 0] * width - 0.5, (1 - uv[:, 1]) * height - 0.5
    left, top = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    s, t = (x - left)[:, None], (y - top)[:, None]
    i0, i1, j0, j1 = top % height, (top + 1) % height, left % width, (left + 1) % width
    above = (1 - s) * pixels[i0, j0] + s * pixels[i0, j1]
    below = (1 - s) * pixels[i1, j0] + s * pixels[i1, j1]
    return (1 - t) * above + t * below


def _find_texels(corners: np.ndarray, height: int, width: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The texels whose centres lie in triangles of a picture with these ``corners (f, 3, 2)``, texture coordinates.

    Returns ``face (q,)``; ``texel (q,)``: ``row · width + column``, wrapped where triangles leave the picture;
    ``weights (q, 3)``: barycentric coordinates of the centre.
    """
    at = np.stack([corners[:, :, 0] * width, (1 - corners[:, :, 1]) * height], axis=2) - 0.5
    low, high = np.ceil(at.min(axis=1)).astype(np.int64), np.floor(at.max(axis=1)).astype(np.int64)
    span = np.maximum(high - low + 1, 0)
    u, v = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    # Faces that wrap around the whole picture, or have no area in it, have no texels of their own.
    count = np.where((np.abs(area) > 1e-9) & (span <= [width, height]).all(axis=1), span[:, 0] * span[:, 1], 0)
    found: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    block = np.cumsum(count) // _TEXELS
    for faces in np.split(np.arange(len(count)), np.flatnonzero(np.diff(block)) + 1):
        face = np.repeat(faces, count[faces])
        step = index_ranges(np.zeros_like(faces), count[faces])
        x = low[face, 0] + step % np.maximum(span[face, 0], 1)
        y = low[face, 1] + step // np.maximum(span[face, 0], 1)
        gap = np.stack([x, y], axis=1) - at[face, 0]
        s = (gap[:, 0] * v[face, 1] - gap[:, 1] * v[face, 0]) / area[face]
        t = (u[face, 0] * gap[:, 1] - u[face, 1] * gap[:, 0]) / area[face]
        inside = (s >= -1e-9) & (t >= -1e-9) & (s + t <= 1 + 1e-9)
        s, t = s[inside], t[inside]
        texel = (y[inside] % height) * width + x[inside] % width
        found.append((face[inside], texel, np.stack([1 - s - t, s, t], axis=1)))
    face, texel, weights = map(np.concatenate, zip(*found, strict=True))
    return face, texel, weights


def can_bake(target: MeshFile) -> bool:
    """Return whether the target has texture coordinates in which every face has room of its own."""
    if target.uv is None:
        return False
    corners = target.corner_uv
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    if np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2 > 1 + _TWICE:
        return False  # more than the whole picture
    _, texel, _ = _find_texels(corners, _SMALLEST, _SMALLEST)
    hits = np.bincount(texel)
    # Texels on an edge that two faces share count for both: those are few, and no more than one in each row of a face.
    return bool(len(texel) and np.count_nonzero(hits > 1) <= _TWICE * np.count_nonzero(hits))


@dataclass(frozen=True, eq=False)
class TransferredUv:
    """Texture coordinates of a target in the source's picture; made by :func:`transfer_uv`."""

    uv: np.ndarray  # (m, 2)
    uv_faces: np.ndarray  # (f, 3): row of ``uv`` for each corner of the target's faces
    torn: np.ndarray  # (f,): faces over a seam of the source's texture, which no coordinates of three corners describe
    # (f, 3): lengths of the edges in the picture, as parts of its width; of a source with faces.
    edges: np.ndarray | None = None
    images: np.ndarray | None = None  # (f, 3, 3): where the corners lie on the source; of one with faces


def projected_uv(vertices: np.ndarray) -> np.ndarray:
    """Return texture coordinates (n, 2) of ``vertices (n, 3)``, seen along the shortest side of the bounding box.

    They are from 0 to 1; the longest side runs upwards and fills the height, lengths are alike in both directions.
    """
    span = np.ptp(vertices, axis=0)
    _, across, up = np.argsort(span, kind="stable")
    middle = vertices.min(axis=0) + span / 2
    scale = span[up] if span[up] > 0 else 1.0
    return 0.5 + (vertices[:, [across, up]] - middle[[across, up]]) / scale


def with_uv(source: MeshFile) -> MeshFile:
    """Return ``source`` with texture coordinates, where it has none those of :func:`projected_uv`."""
    if source.uv is not None:
        return source
    return replace(source, uv=projected_uv(source.mesh.vertices), uv_faces=source.mesh.faces, picture=None)


def _uv_at(source: MeshFile, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return texture coordinates (q, 2) of the surface closest to ``points (q, 3)``, and its faces (q,)."""
    found = closest_points(points, source.mesh.vertices, source.mesh.faces)
    return np.einsum("qi,qij->qj", found.weights, source.corner_uv[found.faces]), found.faces


def transfer_uv(source: MeshFile, target: Mesh, place: PointMap) -> TransferredUv:
    """Return texture coordinates of the target in the source's picture.

    Each corner has the coordinates of its point on the source. At a seam of the texture one point has several; a corner
    then takes those on its own face's side. A face that lies over a seam is named in ``torn``: the middle of such a
    face is not where the mean of its corners is.

    ``source``: a surface; one without texture coordinates has those of :func:`projected_uv`; ``place``: for each target
    vertex.
    """
    source, mesh = with_uv(source), source.mesh
    drawn = source.corner_uv
    uv = np.einsum("ti,tij->tj", place.weights, drawn[place.faces])
    uv_faces = target.faces.copy()
    images = point_positions(place, mesh)[target.faces]
    middle, under = _uv_at(source, images.mean(axis=1))
    grown = [x[:, [1, 2, 0]] - x for x in (drawn[under], mesh.vertices[mesh.faces[under]])]
    sizes = np.linalg.norm(grown[0], axis=2), np.linalg.norm(grown[1], axis=2)
    stretch = np.divide(*sizes, out=np.zeros_like(sizes[0]), where=sizes[1] > 0).max(axis=1)
    edges = np.linalg.norm(images[:, [1, 2, 0]] - images, axis=2) * stretch[:, None]
    most = _OFF * edges.max(axis=1) + 1e-9

    def off(corners: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return np.linalg.norm(corners.mean(axis=1) - middle[rows], axis=1) > most[rows]

    rows = np.flatnonzero(off(uv[uv_faces], np.arange(len(uv_faces))))
    inset = images[rows] + _INSET * (images[rows].mean(axis=1, keepdims=True) - images[rows])
    at, faces = _uv_at(source, inset.reshape(-1, 3))
    at = at.reshape(-1, 3, 2)
    corners = ((at - _INSET * at.mean(axis=1, keepdims=True)) / (1 - _INSET)).reshape(-1, 2)
    options = drawn[faces]  # a corner that is a vertex of the source has exactly its coordinates
    gap = np.abs(options - corners[:, None]).max(axis=2)
    corners = np.where((gap.min(axis=1) < 1e-7)[:, None], options[np.arange(len(gap)), gap.argmin(axis=1)], corners)
    torn = np.zeros(len(uv_faces), dtype=bool)
    torn[rows] = off(corners.reshape(-1, 3, 2), rows)
    corners, again = np.unique(corners, axis=0, return_inverse=True)
    uv_faces[rows] = len(uv) + again.reshape(-1, 3)
    return TransferredUv(np.concatenate([uv, corners]), uv_faces, torn, edges, images)


def _bake(
    source: MeshFile, found: TransferredUv, pixels: np.ndarray, atlas: np.ndarray, picture: np.ndarray, rows: int = 0
) -> Picture:
    """A picture with the colours of the source's, ``pixels``, drawn into it.

    ``found``: where the faces lie in the source's picture; the texels of torn ones each take the closest place on the
    source's surface. ``atlas (f, 3, 2)``: where the faces lie in the new picture, NaN for those that are not drawn.
    ``picture (h, w, 3)``: its first ``rows`` are there already; it is changed. Texels of no face get the colour of the
    nearest covered one in the end, so that no other colour bleeds in where a viewer mixes neighbours.
    """
    height, width = picture.shape[:2]
    covered = np.repeat(np.arange(height) < rows, width)
    drawn = np.flatnonzero(np.isfinite(atlas).all(axis=(1, 2)))
    face, texel, weights = _find_texels(atlas[drawn], height, width)
    if len(face) == 0:
        raise refuse("target", "texture coordinates with room for its faces", "none", "export without them")
    face = drawn[face]
    where = np.einsum("qi,qij->qj", weights, found.uv[found.uv_faces[face]])
    seam = np.flatnonzero(found.torn[face])
    if len(seam) and found.images is not None:
        where[seam] = _uv_at(with_uv(source), np.einsum("qi,qij->qj", weights[seam], found.images[face[seam]]))[0]
    picture.reshape(-1, 3)[texel] = _sample_picture(pixels, where)
    covered[texel] = True
    from scipy.ndimage import distance_transform_edt

    bare = ~covered.reshape(height, width)
    nearest: Any = distance_transform_edt(bare, return_distances=False, return_indices=True)
    return encode_png(bytes_of(picture[nearest[0], nearest[1]]))


def _pack(edges: np.ndarray, width: int) -> tuple[np.ndarray, int]:
    """Triangles laid side by side into rows of ``width``: their corners (t, 3, 2) from the upper left, and the height.

    ``edges (t, 3)``: lengths of the edges from corner i to the next. All are in texels. Where the rows together are
    higher than wide, all triangles are made smaller.
    """
    first = edges.argmax(axis=1)  # the longest edge lies at the top
    a, b, c = (np.take_along_axis(edges, ((first + i) % 3)[:, None], axis=1)[:, 0] for i in range(3))
    a = np.clip(a, 1e-9, None)
    x = np.clip((a**2 + c**2 - b**2) / (2 * a), 0, a)
    y = np.sqrt(np.maximum(c**2 - x**2, 0))
    scale = min(1.0, (width - 2 * _MARGIN - 1) / max(a.max(), 1e-9))
    while True:
        wide, high = np.ceil(np.maximum(scale * a, 1)), np.ceil(np.maximum(scale * y, 1))
        place, left, top, row = np.zeros((len(a), 2)), 0, 0, 0
        for i in np.argsort(-high, kind="stable"):
            if left + wide[i] + 2 * _MARGIN > width:
                left, top, row = 0, top + row, 0
            place[i] = left + _MARGIN, top + _MARGIN
            left, row = left + wide[i] + 2 * _MARGIN, max(row, high[i] + 2 * _MARGIN)
        if top + row <= width or scale * a.max() < 1:
            break
        scale *= 0.8
    flat = np.zeros((len(a), 3, 2))
    flat[:, 1, 0], flat[:, 2, 0], flat[:, 2, 1] = wide, scale * x * wide / np.maximum(scale * a, 1e-9), high
    order = (np.arange(3) - first[:, None]) % 3
    return place[:, None] + np.take_along_axis(flat, order[:, :, None], axis=1), int(top + row)


def _resized(pixels: np.ndarray, size: int) -> np.ndarray:
    """A picture whose longer side has ``size`` texels."""
    from PIL import Image

    height, width = pixels.shape[:2]
    h, w = (max(1, round(side * size / max(height, width))) for side in (height, width))
    image = Image.fromarray(bytes_of(pixels)).resize((w, h), Image.Resampling.BILINEAR)
    return np.asarray(image) / 255.0


def transfer_texture(
    source: MeshFile, target: MeshFile, found: TransferredUv, picture: Picture, size: int | None = None
) -> MeshFile:
    """Return the target with texture coordinates and a picture.

    A target with room for each face in its own atlas keeps it, and the picture is resampled into that. Otherwise, with
    a warning where it has an atlas, it gets the source's coordinates and picture. Faces over a seam of the texture are
    then drawn anew, each into a place of its own in rows that are added below the picture.

    ``picture``: the source's; ``size``: longer side of the picture in texels; by default the source's, within bounds.
    """
    own_atlas = can_bake(target)
    if target.uv is not None and not own_atlas:
        told = "several faces of the target share their place in its texture: it gets the source's coordinates"
        warnings.warn(told, KfmapsWarning, stacklevel=2)
    plain, edges = MeshFile(target.mesh, None, found.uv, found.uv_faces, picture), found.edges
    if not (own_atlas or size or found.torn.any()):
        return plain
    pixels = decode_picture(picture)
    size = size or int(np.clip(max(pixels.shape[:2]), _SMALLEST, _LARGEST))
    if own_atlas:
        return replace(target, picture=_bake(source, found, pixels, target.corner_uv, np.zeros((size, size, 3))))
    pixels = _resized(pixels, size)
    if edges is None or not found.torn.any():
        return replace(plain, picture=encode_png(pixels))
    height, width = pixels.shape[:2]
    corners = found.uv[found.uv_faces]
    # Rows below end the repetition of the picture: all faces move into its first copy, and those over its edge are
    # drawn anew as well.
    copy = np.floor(corners.min(axis=1) + 1e-6)
    own = found.torn | ((corners.max(axis=1) - 1e-6 > copy + 1).any(axis=1))
    packed, rows = _pack(edges[own] * width, width)
    whole = height + rows
    atlas = np.full_like(corners, np.nan)
    atlas[own] = packed / [width, whole]
    atlas[own, :, 1] = rows / whole - atlas[own, :, 1]
    drawn = np.concatenate([pixels, np.zeros((rows, width, 3))])
    made = _bake(source, replace(found, torn=own), pixels, atlas, drawn, height)
    moved = (corners - copy[:, None]) * [1, height / whole] + [0, rows / whole]
    uv, uv_faces = np.unique(np.where(own[:, None, None], atlas, moved).reshape(-1, 2), axis=0, return_inverse=True)
    return replace(plain, uv=uv, uv_faces=uv_faces.reshape(-1, 3), picture=made)
