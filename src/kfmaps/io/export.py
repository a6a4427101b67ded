"""A map made visible in other programs: the source's texture or colours on the target."""

from __future__ import annotations

import warnings
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import KfmapsWarning, check, refuse
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io.atomic import atomic_output
from kfmaps.io.bake import bake_texture, can_bake, decode_picture, encode_png
from kfmaps.io.glb import format_glb
from kfmaps.io.mapcontent import check_map
from kfmaps.io.meshes import write_mesh
from kfmaps.io.obj import format_obj
from kfmaps.io.partial_map import precise_points
from kfmaps.io.record import MeshFile, Picture
from kfmaps.io.transfer import transfer

_PICTURES = (".png", ".jpg", ".jpeg")
_LOST = 0.62
"""Grey of target vertices without a counterpart."""
_CHOICES = 8
"""Texture coordinates that are considered per vertex; a seam gives two, a corner of seams three or four."""


def projected_uv(vertices: np.ndarray) -> np.ndarray:
    """Return texture coordinates by looking along the shortest side of the bounding box.

    Parameters
    ----------
    vertices : (n, 3) float64

    Returns
    -------
    (n, 2) float64
        From 0 to 1; the longest side runs upwards and fills the height, lengths are alike in both directions.
    """
    span = np.ptp(vertices, axis=0)
    _, across, up = np.argsort(span, kind="stable")
    middle = vertices.min(axis=0) + span / 2
    scale = span[up] if span[up] > 0 else 1.0
    return 0.5 + (vertices[:, [across, up]] - middle[[across, up]]) / scale


def grid_picture(size: int = 1024, cells: int = 24) -> np.ndarray:
    """Draw a checkerboard whose colour tells where one is, with thin lines between the cells.

    Returns
    -------
    (size, size, 3) uint8
        Row 0 is the top.
    """
    across, down = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size])
    x, y = across * cells, (1 - down) * cells
    hue = np.stack([across, 1 - down, 1 - across], axis=-1)
    dark = (np.floor(x) + np.floor(y)) % 2 == 1
    line = (np.minimum(x % 1, y % 1) < 0.05) | (np.maximum(x % 1, y % 1) > 0.95)
    shade = np.where(line, 0.35, np.where(dark, 0.7, 1.0))
    return np.rint(255 * (0.25 + 0.7 * hue) * shade[..., None]).astype(np.uint8)


def _transfer_uv_faces(source: MeshFile, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """Return a row of ``source.uv`` for each corner of the target's faces, (f_t, 3) int64.

    At a seam of the texture a source vertex has several coordinates. Each face takes those that lie
    closest together, so that no face stretches across the picture where one of the source would not.
    """
    if source.uv is None or source.uv_faces is None:
        raise refuse("source", "texture coordinates", "none", "project them first")
    corner_vertex, corner_uv = source.mesh.faces.ravel(), source.uv_faces.ravel()
    pairs = np.unique(np.stack([corner_vertex, corner_uv], axis=1), axis=0)
    n = len(source.mesh.vertices)
    count = np.bincount(pairs[:, 0], minlength=n)
    first = np.cumsum(count) - count
    which = np.minimum(np.arange(min(_CHOICES, count.max())), np.maximum(count, 1)[:, None] - 1)
    choices = pairs[np.minimum(first[:, None] + which, len(pairs) - 1), 1]
    bare = np.flatnonzero(count == 0)
    if len(bare):  # vertices of no face take the coordinates of the nearest that has some
        dressed = np.flatnonzero(count)
        nearest = KDTree(source.mesh.vertices[dressed]).query(source.mesh.vertices[bare])[1]
        choices[bare] = choices[dressed[nearest]]

    corners = target_to_source[target.faces]
    result = choices[corners, 0]
    seam = np.flatnonzero((count[corners] > 1).any(axis=1))
    for block in np.split(seam, range(4096, len(seam), 4096)) if len(seam) else []:
        options = choices[corners[block]]  # (b, 3, k)
        a, b, c = (source.uv[options[:, i]] for i in range(3))
        ab, bc, ca = (((p[:, :, None] - q[:, None]) ** 2).sum(axis=-1) for p, q in ((a, b), (b, c), (c, a)))
        total = ab[:, :, :, None] + bc[:, None, :, :] + ca.transpose(0, 2, 1)[:, :, None, :]
        best = np.unravel_index(total.reshape(len(block), -1).argmin(axis=1), total.shape[1:])
        result[block] = np.stack([options[np.arange(len(block)), i, best[i]] for i in range(3)], axis=1)
    return result


def transfer_uv(
    source: MeshFile, target: Mesh, target_to_source: np.ndarray, place: PointMap | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Return texture coordinates of the target, ``uv`` (m, 2) and ``uv_faces`` (f_t, 3), from those of the source.

    With points inside triangles (``place``) each corner has the coordinates of its point; a face over a seam of the
    texture keeps to one side of it. Without, they are those of the nearest vertices (:func:`_transfer_uv_faces`). A
    source without coordinates has those of :func:`projected_uv`.
    """
    bare = source.uv is None or source.uv_faces is None
    uv = projected_uv(source.mesh.vertices) if source.uv is None or bare else source.uv
    corners_uv = source.mesh.faces if source.uv_faces is None or bare else source.uv_faces
    snapped = target_to_source[target.faces] if bare else _transfer_uv_faces(source, target, target_to_source)
    if place is None:
        return uv, snapped
    exact = np.einsum("ti,tij->tj", place.weights, uv[corners_uv[place.faces]])

    def spread(corners: np.ndarray) -> np.ndarray:
        return ((corners - np.roll(corners, 1, axis=1)) ** 2).sum(axis=(1, 2))

    # A face over a seam would reach across the picture. There it lies in the picture as if the source's face under one
    # of its corners went on: of the three the one that spreads least, unless the nearest vertices' lie closer still.
    result = np.concatenate([exact, uv])
    uv_faces = target.faces.copy()
    usual = np.median(spread(uv[corners_uv]))
    seam = np.flatnonzero(spread(exact[target.faces]) > 4 * (np.minimum(spread(uv[snapped]), usual) + usual))
    if len(seam) == 0:
        return result, uv_faces
    images = point_positions(place, source.mesh)[target.faces[seam]]  # (b, 3, 3)
    options = [uv[snapped[seam]]]
    for i in range(3):
        under = place.faces[target.faces[seam, i]]
        triangle = source.mesh.vertices[source.mesh.faces[under]]
        u, v = triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0]
        gap = images - triangle[:, :1]
        inner = [(a * b).sum(axis=-1) for a, b in ((u, u), (u, v), (v, v))]
        on_u, on_v = ((gap * edge[:, None]).sum(axis=2) for edge in (u, v))
        flat = np.maximum(inner[0] * inner[2] - inner[1] ** 2, 1e-12 * inner[0] * inner[2])[:, None]
        s = (inner[2][:, None] * on_u - inner[1][:, None] * on_v) / flat
        t = (inner[0][:, None] * on_v - inner[1][:, None] * on_u) / flat
        corners = uv[corners_uv[under]]
        options.append(np.einsum("bij,bjk->bik", np.stack([1 - s - t, s, t], axis=2), corners))
    best = np.argmin([spread(option) for option in options], axis=0)
    chosen = np.stack(options)[best, np.arange(len(seam))]
    uv_faces[seam] = len(result) + np.arange(3 * len(seam)).reshape(-1, 3)
    return np.concatenate([result, chosen.reshape(-1, 2)]), uv_faces


def write_textured(
    path: str | Path,
    source: MeshFile,
    target: Mesh | MeshFile,
    target_to_source: Any,
    *,
    picture: str | Path | None = None,
    force: bool = False,
) -> list[Path]:
    """Write the target with the source's texture on it: OBJ with the MTL and picture beside it, or GLB with all in it.

    A target that comes with texture coordinates of its own keeps them, and the picture is resampled into its atlas
    (:mod:`kfmaps.io.bake`); unless several of its faces share their place there. Otherwise the target gets
    the source's coordinates and the picture as it is.

    Parameters
    ----------
    path : str or Path
        ``NAME.obj``, with ``NAME.mtl`` and ``NAME.png`` (or the suffix of ``picture``) beside it, or ``NAME.glb``.
    source : MeshFile
        With its texture coordinates; without any they come from :func:`projected_uv`.
    target : Mesh or MeshFile
    target_to_source : (n_t,) int64 or Match
    picture : str or Path, optional
        The source's texture, PNG or JPEG; by default its own, if its file holds one, or a coloured grid
        (:func:`grid_picture`).
    force : bool
        Whether existing files may be replaced.

    Returns
    -------
    list of Path
        The files written: all of them or none.

    Raises
    ------
    InvalidInput
        On a target without faces, a map that does not fit, a picture that is missing or of another
        format, and as :func:`atomic_output`.
    """
    path = Path(path)
    if path.suffix.lower() not in (".obj", ".glb"):
        raise refuse(f"output {path}", "the extension .obj or .glb", path.suffix or "none", "rename it")
    if any(ord(letter) < 32 for letter in path.name):
        raise refuse(f"output {path}", "a printable name", "a control character", "rename it")
    atlas = target if isinstance(target, MeshFile) else MeshFile(target)
    mesh = atlas.mesh
    if len(mesh.faces) == 0:
        raise refuse("target", "a surface with faces", "a point cloud", "export colours as .ply")
    points = check_map(target_to_source, len(source.mesh.vertices), len(mesh.vertices), lost=True)
    if picture is not None and not (Path(picture).is_file() and Path(picture).suffix.lower() in _PICTURES):
        raise refuse(f"picture {picture}", f"a file {' '.join(_PICTURES)}", "none", "check the name")
    place = precise_points(target_to_source, source.mesh)
    image = _picture(picture, source)
    lost = np.asarray(points < 0)
    uv, uv_faces = transfer_uv(source, mesh, np.where(lost, points.max(), points), place)
    if lost.any():
        # All three corners in one place: the face has one colour of the picture, and the picture does not spread.
        faces = lost[mesh.faces].max(axis=1)
        uv, uv_faces = np.concatenate([uv, np.zeros((1, 2))]), np.where(faces[:, None], len(uv), uv_faces)
    if atlas.uv is not None and atlas.uv_faces is not None:
        if can_bake(atlas):
            image = encode_png(bake_texture(source, atlas, decode_picture(image), uv, uv_faces, place))
            uv, uv_faces = atlas.uv, atlas.uv_faces
        else:
            told = "several faces of the target share their place in its texture: it gets the source's coordinates"
            warnings.warn(told, KfmapsWarning, stacklevel=2)
    if path.suffix.lower() == ".glb":
        with atomic_output(path, force) as temporary:
            content = format_glb(mesh, uv=uv, uv_faces=uv_faces, picture=(image.data, image.kind))
            temporary.write_bytes(content)
        return [path]

    suffix = image.suffix if picture is None or image.kind == "image/png" else Path(picture).suffix
    return _write_obj(path, mesh, uv, uv_faces, image, suffix, force)


def _write_obj(
    path: Path, mesh: Mesh, uv: np.ndarray, uv_faces: np.ndarray, image: Picture, suffix: str, force: bool
) -> list[Path]:
    """An OBJ file with its MTL and picture beside it; their names."""
    material, beside = path.with_suffix(".mtl"), path.with_suffix(suffix)
    content = format_obj(mesh, uv=uv, uv_faces=uv_faces, material=(material.name, "carried"))
    lines = ["newmtl carried", "Ka 1 1 1", "Kd 1 1 1", "Ks 0 0 0", f"map_Kd {beside.name}", ""]
    with ExitStack() as files:  # renamed in reverse order, the OBJ file that names the others last
        files.enter_context(atomic_output(path, force)).write_bytes(content)
        files.enter_context(atomic_output(material, force)).write_text("\n".join(lines), encoding="utf-8")
        files.enter_context(atomic_output(beside, force)).write_bytes(image.data)
    return [path, material, beside]


def _picture(picture: str | Path | None, source: MeshFile) -> Picture:
    """A picture file, by default the source's own or the grid."""
    if picture is not None:
        kind = "image/png" if Path(picture).suffix.lower() == ".png" else "image/jpeg"
        return Picture(Path(picture).read_bytes(), kind)
    return source.picture or encode_png(grid_picture())


def write_colored(
    path: str | Path,
    colors: np.ndarray,
    target: Mesh,
    target_to_source: Any,
    *,
    source: Mesh | None = None,
    force: bool = False,
) -> None:
    """Write the target (PLY, OFF, OBJ or GLB) with the colours (n_s, 3), sRGB from 0 to 1, of the source's vertices.

    With the ``source`` colours are mixed between the corners of the points inside triangles that a map file has.

    Raises
    ------
    InvalidInput
        On a map that does not fit, and as :func:`write_mesh`.
    """
    colors = np.asarray(colors, dtype=np.float64)
    check(colors, "colors", shape=(None, 3), remedy="give one colour per source vertex")
    check_map(target_to_source, len(colors), len(target.vertices), lost=True)
    if source is not None:
        precise_points(target_to_source, source)
    mixed = transfer(colors, target_to_source, None if source is None else source.faces, _LOST)
    write_mesh(path, target, colors=np.clip(mixed, 0, 1), force=force)


def _morph_mesh(source: Mesh, target: Mesh, bent: np.ndarray) -> Mesh:
    """Return the source's triangulation in the target's shape and place; ``bent`` (n_s, 3) as a map file has it."""
    scale = np.sqrt(surface_area(target))
    return Mesh(bent * scale + target.vertices.mean(axis=0), source.faces)


def write_morph(path: str | Path, source: MeshFile, target: Mesh, bent: np.ndarray, force: bool = False) -> None:
    """Write the source in the target's shape: as a morph target of the source (GLB), else the bent mesh alone.

    GLB and OBJ keep the source's texture.
    """
    check(np.asarray(bent), "bent", shape=(len(source.mesh.vertices), 3), remedy="check that the map is the source's")
    moved = _morph_mesh(source.mesh, target, bent)
    if Path(path).suffix.lower() == ".obj" and source.picture and source.uv is not None and source.uv_faces is not None:
        _write_obj(Path(path), moved, source.uv, source.uv_faces, source.picture, source.picture.suffix, force)
        return
    if Path(path).suffix.lower() != ".glb":
        write_mesh(path, moved, colors=source.colors, force=force)
        return
    with atomic_output(path, force) as temporary:
        # Both in one place and size, so that the morph bends and does not travel.
        scale = np.sqrt(surface_area(source.mesh) / surface_area(target))
        ends = scale * (moved.vertices - moved.vertices.mean(axis=0)) + source.mesh.vertices.mean(axis=0)
        temporary.write_bytes(
            format_glb(
                source.mesh,
                source.colors,
                uv=source.uv,
                uv_faces=source.uv_faces,
                picture=None if source.picture is None else (source.picture.data, source.picture.kind),
                morph=ends,
            )
        )
