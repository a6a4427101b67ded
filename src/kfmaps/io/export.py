"""Export a map for other programs: the target with the source's texture or colours."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import numpy as np

from kfmaps._arrays import check, refuse
from kfmaps.geometry.mesh import Mesh, surface_area
from kfmaps.io.atomic import atomic_output, write_bytes
from kfmaps.io.bake import TransferredUv, encode_png, projected_uv, transfer_texture, transfer_uv
from kfmaps.io.character import transfer_character
from kfmaps.io.glb import format_glb
from kfmaps.io.mapcontent import check_map
from kfmaps.io.meshes import write_mesh
from kfmaps.io.obj import MATERIAL, format_obj
from kfmaps.io.record import MeshFile, Picture, picture_in
from kfmaps.io.text import check_suffix, read_bytes
from kfmaps.io.transfer import LOST_GREY, point_map, precise_points, transfer
from kfmaps.matching.result import Match


def grid_picture(size: int = 1024, cells: int = 24) -> np.ndarray:
    """Return a checkerboard with a colour gradient and thin lines between the cells, (size, size, 3) uint8."""
    across, down = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size])
    x, y = across * cells, (1 - down) * cells
    hue = np.stack([across, 1 - down, 1 - across], axis=-1)
    dark = (np.floor(x) + np.floor(y)) % 2 == 1
    line = (np.minimum(x % 1, y % 1) < 0.05) | (np.maximum(x % 1, y % 1) > 0.95)
    shade = np.where(line, 0.35, np.where(dark, 0.7, 1.0))
    return np.rint(255 * (0.25 + 0.7 * hue) * shade[..., None]).astype(np.uint8)


def write_textured(
    path: str | Path,
    source: MeshFile,
    target: Mesh | MeshFile,
    target_to_source: np.ndarray | Match,
    *,
    picture: str | Path | None = None,
    size: int | None = None,
    force: bool = False,
) -> list[Path]:
    """Write the target with the source's texture: an OBJ with MTL and picture beside it, or a GLB that holds all.

    A target with texture coordinates in which no faces overlap keeps them, and the picture is resampled into its atlas
    (:mod:`kfmaps.io.bake`). Any other target gets the source's coordinates and picture, and faces over a seam of the
    texture get places of their own below it. A GLB has the
    source's morph targets, skeleton and skinning weights too (:mod:`kfmaps.io.character`).

    Parameters
    ----------
    path : str or Path
        ``NAME.obj``, with ``NAME.mtl`` and ``NAME.png`` (or ``NAME.jpg``) beside it, or ``NAME.glb``.
    source : MeshFile
        With its texture coordinates; without any they come from :func:`projected_uv`.
    target : Mesh or MeshFile
    target_to_source : (n_t,) int64 or Match
    picture : str or Path, optional
        PNG or JPEG; by default the source's own, or a coloured grid where it has none (:func:`grid_picture`).
    size : int, optional
        Longer side of the written picture in texels; by default that of the source's.
    force : bool
        Whether existing files may be replaced.

    Returns
    -------
    list of Path
        The files written: all of them or none.

    Raises
    ------
    InvalidInput
        On a target without faces, a map or picture that does not fit, and as :func:`atomic_output`.
    """
    path, suffix = Path(path), check_suffix(path, (".obj", ".glb"), "output")
    if any(ord(letter) < 32 for letter in path.name):
        raise refuse(f"output {path}", "a printable name", "a control character", "rename it")
    target = target if isinstance(target, MeshFile) else MeshFile(target)
    image = None if picture is None else picture_in(read_bytes(picture))
    if picture is not None and image is None:
        raise refuse(f"picture {picture}", "a PNG or JPEG file", "another", "convert it")
    result = with_source_texture(source, target, target_to_source, image, size)
    if suffix == ".glb":
        write_bytes(path, format_glb(transfer_character(source, result, target_to_source)), force)
        return [path]
    return _write_obj(path, result, force)


def with_source_texture(
    source: MeshFile,
    target: MeshFile,
    target_to_source: np.ndarray | Match,
    picture: Picture | None = None,
    size: int | None = None,
) -> MeshFile:
    """Return the target with the source's texture, as :func:`write_textured` writes it.

    ``target_to_source (n_t,)``; ``picture``: by default the source's own, or a coloured grid; ``size``: longer side of
    the picture in texels; see :func:`kfmaps.io.bake.transfer_texture`.
    """
    mesh, picture = target.mesh, picture or source.picture or encode_png(grid_picture())
    if len(mesh.faces) == 0:
        raise refuse("target", "a surface with faces", "a point cloud", "export colours as .ply")
    points = check_map(target_to_source, len(source.mesh.vertices), len(mesh.vertices), partial=True)
    unmatched = np.asarray(points < 0)
    if len(source.mesh.faces):
        transferred = transfer_uv(source, mesh, point_map(target_to_source, source.mesh, points))
    else:  # a point cloud has no seams
        corners = np.where(unmatched, points.max(), points)[mesh.faces]
        transferred = TransferredUv(projected_uv(source.mesh.vertices), corners, corners[:, 0] < 0)
    if unmatched.any():
        # All three corners lie in one place, so that the face has one colour of the picture.
        unmatched_faces = np.asarray(unmatched[mesh.faces].any(axis=1))
        uv = np.concatenate([transferred.uv, np.zeros((1, 2))])
        uv_faces = np.where(unmatched_faces[:, None], len(transferred.uv), transferred.uv_faces)
        transferred = replace(transferred, uv=uv, uv_faces=uv_faces, torn=transferred.torn & ~unmatched_faces)
    return transfer_texture(source, target, transferred, picture, size)


def _write_obj(path: Path, shape: MeshFile, force: bool) -> list[Path]:
    """Write an OBJ file with its MTL and picture beside it; return their names."""
    assert shape.picture is not None
    material_path, picture_path = path.with_suffix(".mtl"), path.with_suffix(shape.picture.suffix)
    content = format_obj(replace(shape, colors=None), material_path.name)
    lines = [f"newmtl {MATERIAL}", "Ka 1 1 1", "Kd 1 1 1", "Ks 0 0 0", f"map_Kd {picture_path.name}", ""]
    with ExitStack() as files:  # renamed in reverse order, the OBJ file that names the others last
        files.enter_context(atomic_output(path, force)).write_bytes(content)
        files.enter_context(atomic_output(material_path, force)).write_text("\n".join(lines), encoding="utf-8")
        files.enter_context(atomic_output(picture_path, force)).write_bytes(shape.picture.data)
    return [path, material_path, picture_path]


def write_colored(
    path: str | Path,
    colors: np.ndarray,
    target: Mesh,
    target_to_source: np.ndarray | Match,
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
    check_map(target_to_source, len(colors), len(target.vertices), partial=True)
    if source is not None:
        precise_points(target_to_source, source)
    transferred = transfer(colors, target_to_source, None if source is None else source.faces, LOST_GREY)
    write_mesh(path, target, colors=np.clip(transferred, 0, 1), force=force)


def write_morph(path: str | Path, source: MeshFile, target: Mesh, registered: np.ndarray, force: bool = False) -> None:
    """Write the source deformed to the target: as a morph target of the source (GLB), else the mesh alone.

    GLB and OBJ keep the source's texture. ``registered (n_s, 3)``: ``registered_vertices`` of a map file.
    """
    check(
        np.asarray(registered),
        "registered_vertices",
        shape=(len(source.mesh.vertices), 3),
        remedy="check that the map is the source's",
    )
    vertices = registered * np.sqrt(surface_area(target)) + target.vertices.mean(axis=0)
    deformed, suffix = replace(source, mesh=Mesh(vertices, source.mesh.faces)), Path(path).suffix.lower()
    if suffix == ".obj" and source.picture and source.uv is not None:
        _write_obj(Path(path), deformed, force)
    elif suffix == ".glb":
        write_bytes(path, format_glb(replace(source, morphs={"target": vertices - source.mesh.vertices})), force)
    else:
        write_mesh(path, deformed.mesh, colors=source.colors, force=force)
