"""A map made visible in other programs: the source's texture or colours on the target."""

from __future__ import annotations

import shutil
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from kfmaps._arrays import check, refuse
from kfmaps.app.files.atomic import atomic_output
from kfmaps.app.files.mapfile import check_map
from kfmaps.app.files.meshes import write_mesh
from kfmaps.app.files.obj import format_obj
from kfmaps.app.files.record import MeshFile
from kfmaps.surface.mesh import Mesh

PICTURES = (".png", ".jpg", ".jpeg")
_CHOICES = 8
"""Texture coordinates that are considered per vertex; a seam gives two, a corner of seams three or four."""


def projected_uv(vertices: np.ndarray) -> np.ndarray:
    """Texture coordinates by looking along the shortest side of the bounding box.

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
    """A checkerboard whose colour tells where one is, with thin lines between the cells.

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


def carried_uv_faces(source: MeshFile, target: Mesh, target_to_source: np.ndarray) -> np.ndarray:
    """For each corner of the target's faces a row of ``source.uv``, (f_t, 3) int64.

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
        ab, bc, ca = (_squared(p, q) for p, q in ((a, b), (b, c), (c, a)))
        total = ab[:, :, :, None] + bc[:, None, :, :] + ca.transpose(0, 2, 1)[:, :, None, :]
        best = np.unravel_index(total.reshape(len(block), -1).argmin(axis=1), total.shape[1:])
        result[block] = np.stack([options[np.arange(len(block)), i, best[i]] for i in range(3)], axis=1)
    return result


def _squared(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Squared distances of the points of p (b, k, 2) and q (b, k, 2), (b, k, k)."""
    return ((p[:, :, None] - q[:, None, :]) ** 2).sum(axis=-1)


def write_textured(
    path: str | Path,
    source: MeshFile,
    target: Mesh,
    target_to_source: Any,
    *,
    picture: str | Path | None = None,
    force: bool = False,
) -> list[Path]:
    """Write the target as OBJ with the source's texture on it, and the MTL and picture beside it.

    Parameters
    ----------
    path : str or Path
        ``NAME.obj``; ``NAME.mtl`` and ``NAME.png`` (or the suffix of ``picture``) lie beside it.
    source : MeshFile
        With its texture coordinates; without any they come from :func:`projected_uv`.
    target : Mesh
    target_to_source : (n_t,) int64 or MapFile
    picture : str or Path, optional
        The source's texture, PNG or JPEG, copied; by default a coloured grid (:func:`grid_picture`).
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
    if path.suffix.lower() != ".obj":
        raise refuse(f"output {path}", "the extension .obj", path.suffix or "none", "rename it")
    if any(ord(letter) < 32 for letter in path.name):
        raise refuse(f"output {path}", "a printable name", "a control character", "rename it")
    if len(target.faces) == 0:
        raise refuse("target", "a surface with faces", "a point cloud", "export colours as .ply")
    points = check_map(target_to_source, len(source.mesh.vertices), len(target.vertices))
    if picture is not None and not (Path(picture).is_file() and Path(picture).suffix.lower() in PICTURES):
        raise refuse(f"picture {picture}", f"a file {' '.join(PICTURES)}", "none", "check the name")
    if source.uv is None:
        uv, uv_faces = projected_uv(source.mesh.vertices), points[target.faces]
    else:
        uv, uv_faces = source.uv, carried_uv_faces(source, target, points)

    material = path.with_suffix(".mtl")
    image = path.with_suffix(".png" if picture is None else Path(picture).suffix)
    content = format_obj(target, uv=uv, uv_faces=uv_faces, material=(material.name, "carried"))
    lines = ["newmtl carried", "Ka 1 1 1", "Kd 1 1 1", "Ks 0 0 0", f"map_Kd {image.name}", ""]
    with ExitStack() as files:  # renamed in reverse order, the OBJ file that names the others last
        files.enter_context(atomic_output(path, force)).write_bytes(content)
        files.enter_context(atomic_output(material, force)).write_text("\n".join(lines), encoding="utf-8")
        temporary = files.enter_context(atomic_output(image, force))
        if picture is None:
            from matplotlib.image import imsave

            imsave(temporary, grid_picture())
        else:
            shutil.copyfile(picture, temporary)
    return [path, material, image]


def write_colored(
    path: str | Path, colors: np.ndarray, target: Mesh, target_to_source: Any, *, force: bool = False
) -> None:
    """Write the target (PLY, OFF or OBJ) with the colours (n_s, 3), sRGB from 0 to 1, of the source's vertices.

    Raises
    ------
    InvalidInput
        On a map that does not fit, and as :func:`write_mesh`.
    """
    colors = np.asarray(colors)
    check(colors, "colors", shape=(None, 3), remedy="give one colour per source vertex")
    points = check_map(target_to_source, len(colors), len(target.vertices))
    write_mesh(path, target, colors=colors[points], force=force)
