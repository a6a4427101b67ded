"""Transfer a texture to a target: the source's coordinates where they describe it, else a new picture is baked."""

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
from kfmaps.io.record import MeshFile, Picture, to_bytes

_SMALLEST, _LARGEST = 1024, 4096
"""Bounds of the longer side of a baked picture, which is that of the source's unless a size is given."""
_TEXELS = 2_000_000  # texels worked on together, which bounds the memory
_MAX_SHARED = 0.02
"""Largest share of the covered texels that may lie in several faces: overlapping charts cannot be baked into."""
_SEAM_DISTANCE = 0.1
"""Distance of the coordinates in the middle of a face from the mean of its corners', in edge lengths, beyond which the
face lies over a seam of the texture."""
_INSET = 0.05  # share of the way to the middle of its face at which a corner is looked up, beside a seam
_MARGIN = 3  # texels around each face that is packed into the picture; they get the nearest colour


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
    Image.fromarray(pixels if pixels.dtype == np.uint8 else to_bytes(pixels)).save(buffer, "png")
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
    pixels = np.stack([corners[:, :, 0] * width, (1 - corners[:, :, 1]) * height], axis=2) - 0.5
    low, high = np.ceil(pixels.min(axis=1)).astype(np.int64), np.floor(pixels.max(axis=1)).astype(np.int64)
    span = np.maximum(high - low + 1, 0)
    u, v = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    # Faces that wrap around the whole picture, or have no area in it, have no texels of their own.
    count = np.where((np.abs(area) > 1e-9) & (span <= [width, height]).all(axis=1), span[:, 0] * span[:, 1], 0)
    blocks: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    block_of_face = np.cumsum(count) // _TEXELS
    for faces in np.split(np.arange(len(count)), np.flatnonzero(np.diff(block_of_face)) + 1):
        face = np.repeat(faces, count[faces])
        step = index_ranges(np.zeros_like(faces), count[faces])
        x = low[face, 0] + step % np.maximum(span[face, 0], 1)
        y = low[face, 1] + step // np.maximum(span[face, 0], 1)
        offset = np.stack([x, y], axis=1) - pixels[face, 0]
        s = (offset[:, 0] * v[face, 1] - offset[:, 1] * v[face, 0]) / area[face]
        t = (u[face, 0] * offset[:, 1] - u[face, 1] * offset[:, 0]) / area[face]
        inside = (s >= -1e-9) & (t >= -1e-9) & (s + t <= 1 + 1e-9)
        s, t = s[inside], t[inside]
        texel = (y[inside] % height) * width + x[inside] % width
        blocks.append((face[inside], texel, np.stack([1 - s - t, s, t], axis=1)))
    face, texel, weights = map(np.concatenate, zip(*blocks, strict=True))
    return face, texel, weights


def can_bake(target: MeshFile) -> bool:
    """Return whether the target has texture coordinates in which every face has room of its own."""
    if target.uv is None:
        return False
    corners = target.corner_uv
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    if np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2 > 1 + _MAX_SHARED:
        return False  # more than the whole picture
    _, texel, _ = _find_texels(corners, _SMALLEST, _SMALLEST)
    uses = np.bincount(texel)
    # Texels on an edge that two faces share count for both: those are few, and no more than one in each row of a face.
    return bool(len(texel) and np.count_nonzero(uses > 1) <= _MAX_SHARED * np.count_nonzero(uses))


@dataclass(frozen=True, eq=False)
class TransferredUv:
    """Texture coordinates of a target in the source's picture; made by :func:`transfer_uv`."""

    uv: np.ndarray  # (m, 2)
    uv_faces: np.ndarray  # (f, 3): row of ``uv`` for each corner of the target's faces
    torn: np.ndarray  # (f,): whether a face lies over a seam of the texture, where three corners do not describe it
    # Only of a source with faces: (f, 3): lengths of the edges in the picture, as parts of its width.
    edges: np.ndarray | None = None
    images: np.ndarray | None = None  # (f, 3, 3): where the corners lie on the source


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
    closest = closest_points(points, source.mesh.vertices, source.mesh.faces)
    return np.einsum("qi,qij->qj", closest.weights, source.corner_uv[closest.faces]), closest.faces


def transfer_uv(source: MeshFile, target: Mesh, points: PointMap) -> TransferredUv:
    """Return texture coordinates of the target in the source's picture.

    Each corner has the coordinates of its point on the source. At a seam of the texture one point has several; a corner
    then takes those on its own face's side. A face that lies over a seam is named in ``torn``: the middle of such a
    face is not where the mean of its corners is.

    ``source``: a surface; one without texture coordinates gets those of :func:`projected_uv`; ``points``: where each
    target vertex lies on it.
    """
    source, mesh = with_uv(source), source.mesh
    source_uv = source.corner_uv
    uv = np.einsum("ti,tij->tj", points.weights, source_uv[points.faces])
    uv_faces = target.faces.copy()
    images = point_positions(points, mesh)[target.faces]
    middle, middle_faces = _uv_at(source, images.mean(axis=1))
    edge_vectors = [x[:, [1, 2, 0]] - x for x in (source_uv[middle_faces], mesh.vertices[mesh.faces[middle_faces]])]
    lengths = np.linalg.norm(edge_vectors[0], axis=2), np.linalg.norm(edge_vectors[1], axis=2)
    stretch = np.divide(*lengths, out=np.zeros_like(lengths[0]), where=lengths[1] > 0).max(axis=1)
    edges = np.linalg.norm(images[:, [1, 2, 0]] - images, axis=2) * stretch[:, None]
    tolerance = _SEAM_DISTANCE * edges.max(axis=1) + 1e-9

    def crosses_seam(corners: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return np.linalg.norm(corners.mean(axis=1) - middle[rows], axis=1) > tolerance[rows]

    rows = np.flatnonzero(crosses_seam(uv[uv_faces], np.arange(len(uv_faces))))
    inset = images[rows] + _INSET * (images[rows].mean(axis=1, keepdims=True) - images[rows])
    inset_uv, faces = _uv_at(source, inset.reshape(-1, 3))
    inset_uv = inset_uv.reshape(-1, 3, 2)
    corners = ((inset_uv - _INSET * inset_uv.mean(axis=1, keepdims=True)) / (1 - _INSET)).reshape(-1, 2)
    corner_uv = source_uv[faces]  # a corner that is a vertex of the source has exactly its coordinates
    gaps = np.abs(corner_uv - corners[:, None]).max(axis=2)
    nearest_uv = corner_uv[np.arange(len(gaps)), gaps.argmin(axis=1)]
    corners = np.where((gaps.min(axis=1) < 1e-7)[:, None], nearest_uv, corners)
    torn = np.zeros(len(uv_faces), dtype=bool)
    torn[rows] = crosses_seam(corners.reshape(-1, 3, 2), rows)
    corners, unique_rows = np.unique(corners, axis=0, return_inverse=True)
    uv_faces[rows] = len(uv) + unique_rows.reshape(-1, 3)
    return TransferredUv(np.concatenate([uv, corners]), uv_faces, torn, edges, images)


def _bake(
    source: MeshFile,
    uv_map: TransferredUv,
    pixels: np.ndarray,
    atlas: np.ndarray,
    picture: np.ndarray,
    kept_rows: int = 0,
) -> Picture:
    """Draw the target's faces into ``picture (h, w, 3)``, with the colours of the source's picture ``pixels``.

    ``uv_map``: where the faces lie in the source's picture; each texel of a torn face takes the closest place on the
    source's surface. ``atlas (f, 3, 2)``: where the faces lie in the new picture, NaN for those that are not drawn.
    The first ``kept_rows`` of the picture stay. Texels of no face get the colour of the nearest covered one, so that no
    other colour bleeds in where a viewer mixes neighbours.
    """
    height, width = picture.shape[:2]
    covered = np.repeat(np.arange(height) < kept_rows, width)
    drawn_faces = np.flatnonzero(np.isfinite(atlas).all(axis=(1, 2)))
    face, texel, weights = _find_texels(atlas[drawn_faces], height, width)
    if len(face) == 0:
        raise refuse("target", "texture coordinates with room for its faces", "none", "export without them")
    face = drawn_faces[face]
    uv = np.einsum("qi,qij->qj", weights, uv_map.uv[uv_map.uv_faces[face]])
    on_seam = np.flatnonzero(uv_map.torn[face])
    if len(on_seam) and uv_map.images is not None:
        places = np.einsum("qi,qij->qj", weights[on_seam], uv_map.images[face[on_seam]])
        uv[on_seam] = _uv_at(with_uv(source), places)[0]
    picture.reshape(-1, 3)[texel] = _sample_picture(pixels, uv)
    covered[texel] = True
    from scipy.ndimage import distance_transform_edt

    is_uncovered = ~covered.reshape(height, width)
    nearest: Any = distance_transform_edt(is_uncovered, return_distances=False, return_indices=True)
    return encode_png(to_bytes(picture[nearest[0], nearest[1]]))


def _pack(edges: np.ndarray, width: int) -> tuple[np.ndarray, int]:
    """Lay triangles side by side in rows of ``width``; return corners (t, 3, 2) from the upper left, and the height.

    ``edges (t, 3)``: lengths of the edges from corner i to the next. All are in texels. Where the rows together are
    higher than wide, all triangles are made smaller.
    """
    longest_edge = edges.argmax(axis=1)  # the longest edge lies at the top
    a, b, c = (np.take_along_axis(edges, ((longest_edge + i) % 3)[:, None], axis=1)[:, 0] for i in range(3))
    a = np.clip(a, 1e-9, None)
    x = np.clip((a**2 + c**2 - b**2) / (2 * a), 0, a)
    y = np.sqrt(np.maximum(c**2 - x**2, 0))
    scale = min(1.0, (width - 2 * _MARGIN - 1) / max(a.max(), 1e-9))
    while True:
        widths, heights = np.ceil(np.maximum(scale * a, 1)), np.ceil(np.maximum(scale * y, 1))
        place, left, top, row_height = np.zeros((len(a), 2)), 0, 0, 0
        for i in np.argsort(-heights, kind="stable"):
            if left + widths[i] + 2 * _MARGIN > width:
                left, top, row_height = 0, top + row_height, 0
            place[i] = left + _MARGIN, top + _MARGIN
            left, row_height = left + widths[i] + 2 * _MARGIN, max(row_height, heights[i] + 2 * _MARGIN)
        if top + row_height <= width or scale * a.max() < 1:
            break
        scale *= 0.8
    triangles = np.zeros((len(a), 3, 2))
    triangles[:, 1, 0], triangles[:, 2, 1] = widths, heights
    triangles[:, 2, 0] = scale * x * widths / np.maximum(scale * a, 1e-9)
    order = (np.arange(3) - longest_edge[:, None]) % 3
    return place[:, None] + np.take_along_axis(triangles, order[:, :, None], axis=1), int(top + row_height)


def _resize(pixels: np.ndarray, size: int) -> np.ndarray:
    """Return a picture scaled so that its longer side has ``size`` texels."""
    from PIL import Image

    height, width = pixels.shape[:2]
    h, w = (max(1, round(side * size / max(height, width))) for side in (height, width))
    image = Image.fromarray(to_bytes(pixels)).resize((w, h), Image.Resampling.BILINEAR)
    return np.asarray(image) / 255.0


def transfer_texture(
    source: MeshFile, target: MeshFile, uv_map: TransferredUv, picture: Picture, size: int | None = None
) -> MeshFile:
    """Return the target with texture coordinates and a picture.

    A target with room for each face in its own atlas keeps it, and the picture is resampled into that. Otherwise, with
    a warning where it has an atlas, it gets the source's coordinates and picture. Faces over a seam of the texture are
    then drawn again, each into a place of its own in rows that are added below the picture.

    ``picture``: the source's; ``size``: longer side of the picture in texels; by default the source's, within bounds.
    """
    own_atlas = can_bake(target)
    if target.uv is not None and not own_atlas:
        message = "several faces of the target share their place in its texture: it gets the source's coordinates"
        warnings.warn(message, KfmapsWarning, stacklevel=2)
    textured, edges = MeshFile(target.mesh, None, uv_map.uv, uv_map.uv_faces, picture), uv_map.edges
    if not (own_atlas or size or uv_map.torn.any()):
        return textured
    pixels = decode_picture(picture)
    size = size or int(np.clip(max(pixels.shape[:2]), _SMALLEST, _LARGEST))
    if own_atlas:
        return replace(target, picture=_bake(source, uv_map, pixels, target.corner_uv, np.zeros((size, size, 3))))
    pixels = _resize(pixels, size)
    if edges is None or not uv_map.torn.any():
        return replace(textured, picture=encode_png(pixels))
    height, width = pixels.shape[:2]
    corners = uv_map.uv[uv_map.uv_faces]
    # With rows below, the picture does not repeat. All faces move into its first copy, and those over its edge are
    # drawn again as well.
    tile = np.floor(corners.min(axis=1) + 1e-6)
    redrawn = uv_map.torn | ((corners.max(axis=1) - 1e-6 > tile + 1).any(axis=1))
    packed, rows = _pack(edges[redrawn] * width, width)
    total_height = height + rows
    atlas = np.full_like(corners, np.nan)
    atlas[redrawn] = packed / [width, total_height]
    atlas[redrawn, :, 1] = rows / total_height - atlas[redrawn, :, 1]
    canvas = np.concatenate([pixels, np.zeros((rows, width, 3))])
    baked = _bake(source, replace(uv_map, torn=redrawn), pixels, atlas, canvas, height)
    shifted = (corners - tile[:, None]) * [1, height / total_height] + [0, rows / total_height]
    corners = np.where(redrawn[:, None, None], atlas, shifted).reshape(-1, 2)
    uv, uv_faces = np.unique(corners, axis=0, return_inverse=True)
    return replace(textured, uv=uv, uv_faces=uv_faces.reshape(-1, 3), picture=baked)
