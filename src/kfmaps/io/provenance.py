"""The files of the two shapes that a map names: where they are, and whether they are still the same."""

from __future__ import annotations

import hashlib
import warnings
from dataclasses import replace
from pathlib import Path

from kfmaps._arrays import KfmapsWarning, refuse
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.meshes import read_mesh_file
from kfmaps.io.record import MeshFile
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ShapeFile


def sha256(path: str | Path) -> str:
    """Return the SHA-256 of a file, 64 hexadecimal digits; empty when it cannot be read."""
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""


def with_files(match: Match, paths: tuple[Path, Path], meshes: tuple[Mesh, Mesh]) -> Match:
    """Return the match with the files that its shapes, ``meshes``, were read from; paths become absolute."""
    source, target = (
        ShapeFile.of(mesh, str(path.absolute()), sha256(path)) for path, mesh in zip(paths, meshes, strict=True)
    )
    return replace(match, source=meshes[0], target=meshes[1], source_file=source, target_file=target)


def mesh_path(given: Path | None, found: Match, side: str, beside: Path, remedy: str = "") -> Path:
    """Return the file of the shape ``side``: as given, else as the map names it, there or beside the map."""
    if given is not None:
        return given
    named = getattr(found, f"{side}_file").path
    if not named:
        raise refuse(f"{side} mesh", "its file", "a map that does not name it", remedy or f"give --{side} FILE")
    for path in (Path(named), beside.parent / named, beside.parent / Path(named).name):
        if path.is_file():
            return path
    raise refuse(f"{side} mesh", "the file that the map names", f"nothing at {named}", remedy or f"give --{side} FILE")


def map_mesh(given: Path | None, found: Match, side: str, beside: Path, remedy: str = "") -> Mesh:
    """Return the mesh of :func:`map_mesh_file`."""
    return map_mesh_file(given, found, side, beside, remedy).mesh


def map_mesh_file(given: Path | None, found: Match, side: str, beside: Path, remedy: str = "") -> MeshFile:
    """Return the shape ``side`` of a map, read from :func:`mesh_path`, and warn where it has changed since.

    What is odd about it was told when it was matched, and is not told again.
    """
    path, known = mesh_path(given, found, side, beside, remedy), getattr(found, f"{side}_file").sha256
    if known and sha256(path) not in ("", known):
        warnings.warn(f"{path} has changed since the map was made", KfmapsWarning, stacklevel=2)
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
        return read_mesh_file(path)
