"""Save and load matches as map files, and find the files of their two shapes."""

from __future__ import annotations

import hashlib
import io
import json
import warnings
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from kfmaps._arrays import Array, KfmapsWarning, refuse
from kfmaps.geometry.mesh import Mesh
from kfmaps.io.atomic import atomic_output
from kfmaps.io.index_files import read_vertex_numbers, write_vertex_numbers
from kfmaps.io.mapcontent import ARRAYS, OLD_NAMES, check_arrays, read_record, real, summarize_match
from kfmaps.io.matfile import check_unpacked, read_mat
from kfmaps.io.meshes import read_mesh_file
from kfmaps.io.record import MeshFile
from kfmaps.io.text import REPAIR, check_suffix, complete_or_refuse, read_bytes
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ShapeFile

_FORMATS = (".npz", ".txt", ".vts", ".mat")

_MAX_UNPACKED = 1 << 31
"""Bytes that a map file may unpack to: enough for a whole match of 30 million vertices."""


def save_map(path: str | Path, match: Match, force: bool = False) -> None:
    """Write a map; the extension chooses the format.

    ``.npz`` and ``.mat`` hold a match without its meshes and bases: the arrays of
    :data:`kfmaps.io.mapcontent.ARRAYS` and, as the JSON text ``summary``, its other fields. In ``.mat`` vertex numbers
    count from 1, as MATLAB does, −1 stays, and lists are columns of doubles. ``.txt`` and ``.vts`` hold
    ``target_to_source`` alone, one number a line, counted from 0 and from 1; −1 where a vertex has no counterpart.

    Parameters
    ----------
    path : path
    match : Match
    force : bool
        Whether an existing file is replaced.

    Raises
    ------
    InvalidInput
        On an unknown extension, an existing file, and anything but a match.

    Examples
    --------
    >>> kfmaps.save_map("identity.txt", kfmaps.Match(np.arange(5)))
    """
    if not isinstance(match, Match):
        raise refuse("map", "a Match", type(match).__name__, "give what kfmaps.match returned")
    suffix = check_format(path)
    if suffix in (".txt", ".vts"):
        write_vertex_numbers(path, match.target_to_source, force=force)
        return
    content: dict[str, Array] = {"summary": json.dumps(summarize_match(match))}
    content |= {name: value for name in ARRAYS if (value := _array(match, name)) is not None}
    # last, so that a file cut anywhere lacks the one array that must be there
    content["target_to_source"] = content.pop("target_to_source")
    with atomic_output(path, force) as temporary, open(temporary, "wb") as file:
        if suffix == ".npz":
            np.savez_compressed(file, **content)
        else:
            numbered = {name for name, array in ARRAYS.items() if array.of}
            shifted = {k: np.where(v < 0, -1.0, v + 1.0) if k in numbered else v for k, v in content.items()}
            from scipy.io import savemat

            savemat(file, shifted, oned_as="column", do_compression=True)


def load_map(path: str | Path) -> Match:
    """Read a map that :func:`save_map` has written, or a list of vertices.

    Nothing in the file is ever executed: pickled objects are refused. :func:`kfmaps.io.check_map` checks whether the
    numbers fit two meshes.

    Parameters
    ----------
    path : path
        ``.npz``, ``.mat``, ``.txt`` or ``.vts``.

    Returns
    -------
    Match
        Without meshes and bases, which the file does not hold; their attributes raise an error that says so.

    Raises
    ------
    InvalidInput
        On an unknown extension, a file that is missing, cut short or not of its format, contents that are no map, and
        files of older versions.

    Examples
    --------
    >>> kfmaps.save_map("first.txt", kfmaps.Match(np.array([2, 0, 1])), force=True)
    >>> kfmaps.load_map("first.txt").target_to_source
    array([2, 0, 1])
    """
    name, suffix = str(path), check_format(path)
    if suffix in (".txt", ".vts"):
        return Match(read_vertex_numbers(path, partial=True))
    data = read_bytes(path)
    with complete_or_refuse(name, f"a complete {suffix} file"):
        content = (_npz_content if suffix == ".npz" else _mat_content)(data, name)
    if old_names := sorted(OLD_NAMES.intersection(content)):
        raise refuse(
            name, "a map of this version of kfmaps", f"an older one (with {old_names[0]})", "match the shapes again"
        )
    if "target_to_source" not in content:
        got = ", ".join(sorted(content)) or "an empty file"
        raise refuse(name, "an array target_to_source", got, "give a map file that kfmaps wrote")
    text = content.get("summary", "{}")
    try:
        summary = json.loads(text)
    except (TypeError, ValueError, RecursionError) as error:
        raise refuse(f"{name}: summary", "a summary as JSON", "something else", REPAIR) from error
    file_values = summary.get("source_file", {}) if isinstance(summary, dict) else {}
    source = read_record(ShapeFile, file_values, name, path="source_file.")
    return read_record(Match, summary, name, check_arrays(content, source.n_vertices, name))


def sha256(path: str | Path) -> str:
    """Return the SHA-256 of a file, 64 hexadecimal digits; empty when it cannot be read."""
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""


def with_files(match: Match, paths: tuple[Path, Path], meshes: tuple[Mesh, Mesh]) -> Match:
    """Return the match with its ``meshes`` and the files that these were read from, as absolute paths."""
    source, target = (
        ShapeFile.of(mesh, str(path.absolute()), sha256(path)) for path, mesh in zip(paths, meshes, strict=True)
    )
    return replace(match, source=meshes[0], target=meshes[1], source_file=source, target_file=target)


def mesh_path(path: Path | None, match: Match, side: str, map_path: Path) -> Path:
    """Return the file of the shape ``side``: ``path``, else that of the match, where it says or beside ``map_path``."""
    if path is not None:
        return path
    name, remedy = getattr(match, f"{side}_file").path, f"give --{side} FILE, or {side}= in Python"
    if not name:
        raise refuse(f"{side} mesh", "its file", "a map that does not name it", remedy)
    for candidate in (Path(name), map_path.parent / name, map_path.parent / Path(name).name):
        if candidate.is_file():
            return candidate
    raise refuse(f"{side} mesh", "the file that the map names", f"nothing at {name}", remedy)


def map_mesh(path: Path | None, match: Match, side: str, map_path: Path) -> Mesh:
    """Return the mesh of :func:`map_mesh_file`."""
    return map_mesh_file(path, match, side, map_path).mesh


def map_mesh_file(path: Path | None, match: Match, side: str, map_path: Path) -> MeshFile:
    """Read the shape ``side`` of a map from :func:`mesh_path`, and warn where it has changed since.

    Oddities of the mesh were reported when it was matched, and are not reported again.
    """
    mesh_file, digest = mesh_path(path, match, side, map_path), getattr(match, f"{side}_file").sha256
    if digest and sha256(mesh_file) not in ("", digest):
        warnings.warn(f"{mesh_file} has changed since the map was made", KfmapsWarning, stacklevel=2)
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):
        return read_mesh_file(mesh_file)


def map_meshes(paths: tuple[Path | None, Path | None], match: Match, map_path: Path) -> tuple[Mesh, Mesh]:
    """Return source and target of a map as :func:`map_mesh` does; ``paths``: their files, ``None`` as the map names."""
    return map_mesh(paths[0], match, "source", map_path), map_mesh(paths[1], match, "target", map_path)


def check_format(path: str | Path) -> str:
    """Return the extension of ``path`` where it is that of a map."""
    return check_suffix(path, _FORMATS, "map")


def check_npy(file: IO[bytes], size: int, name: str) -> float:
    """Return how many numbers an .npy file of ``size`` bytes holds; refuse a header that declares more than fit."""
    is_version_1 = np.lib.format.read_magic(file) == (1, 0)
    read = np.lib.format.read_array_header_1_0 if is_version_1 else np.lib.format.read_array_header_2_0
    shape, _, dtype = read(file)
    count = float(np.prod(shape, dtype=float))
    if count * dtype.itemsize > size:
        raise refuse(name, f"data for shape {shape}", f"{size} bytes", REPAIR)
    return count * max(1.0, dtype.itemsize / 8)


def _array(match: Match, name: str) -> np.ndarray | None:
    """Return the array ``name`` of a map file; ``None`` where the match has none."""
    value: Any = match
    for part in ARRAYS[name].field.split("."):
        value = getattr(value, part, None)
    value = np.stack(value) if isinstance(value, tuple) and value else value
    return None if value is None or len(value) == 0 else value


def _npz_content(data: bytes, name: str) -> dict[str, Array]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        items = archive.infolist()
        # An archive may unpack to a thousand times its size, so the declared sizes are checked first.
        check_unpacked(sum(item.file_size for item in items), _MAX_UNPACKED, name)
        total, loaded = 0.0, {}
        for item in items:
            with archive.open(item) as file:
                total += check_npy(file, item.file_size, f"{name}: {item.filename}")
            check_unpacked(8 * total, _MAX_UNPACKED, name)
            with archive.open(item) as file:
                loaded[item.filename.removesuffix(".npy")] = np.lib.format.read_array(file, allow_pickle=False)
    return {k: str(v) if v.dtype.kind == "U" and v.ndim == 0 else v for k, v in loaded.items()}


def _mat_content(data: bytes, name: str) -> dict[str, Array]:
    content: dict[str, Array] = dict(read_mat(data, name, _MAX_UNPACKED))
    for key, array in ARRAYS.items():
        value = content.get(key)
        if not isinstance(value, np.ndarray):
            continue
        # A .mat file has no lists, only rows and columns.
        value = value.ravel() if len(array.shape) == 1 else value
        if array.of:
            # As float64, which MATLAB uses: an unsigned 0 must not wrap around.
            numbers = real(value, f"{name}: {key}").astype(np.float64)
            if (numbers == 0).any():
                raise refuse(f"{name}: {key}", "numbers from 1 on, -1 for none", "0", "a .mat file counts from 1")
            value = np.where((numbers == -1) & array.missing, -1, numbers - 1)
        content[key] = value
    return content
