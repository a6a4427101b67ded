"""A map between two shapes, in files."""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from kfmaps._arrays import InvalidInput, check, refuse
from kfmaps._memory import in_words
from kfmaps.fmap.precise import PointMap
from kfmaps.io.atomic import atomic_output, check_output
from kfmaps.io.index_files import read_vertex_numbers, write_vertex_numbers
from kfmaps.io.mapcontent import checked_extra, json_text, real
from kfmaps.io.matfile import read_mat
from kfmaps.io.text import REPAIR, read_bytes

if TYPE_CHECKING:
    from kfmaps.matching.result import Match

FORMATS = (".npz", ".txt", ".vts", ".mat")

VERTEX_NUMBERS = ("target_to_source", "raw_target_to_source", "runners_up", "landmarks", "place_faces")
"""The arrays that hold numbers of vertices or faces, which a .mat file counts from 1."""

LARGEST = 1 << 28
"""Numbers that a map file may hold: 2 GiB of them, a map of 30 million vertices with all that is known of it."""

_FIELDS = ("target_to_source", "functional_map", "eigenvalues_s", "eigenvalues_t", "config")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}", re.ASCII)  # as long as MATLAB's files allow


@dataclass(frozen=True, eq=False)
class MapFile:
    """A map from a source to a target, with what is known of how it was made.

    Attributes
    ----------
    target_to_source : (n_t,) int64
        A source vertex for each target vertex, 0-based; −1 where it has no counterpart.
    functional_map : (k_t, k_s) float64 or None
        Carries coefficients of functions from source to target.
    eigenvalues_s, eigenvalues_t : (k_s,) and (k_t,) float64 or None
        Of the Laplacians, ascending.
    config : str
        The settings as JSON text; empty when unknown.
    extra : dict
        Further arrays of numbers and texts by name. Names that are in use: ``runners_up`` (c, n_t) int64,
        ``confidence`` (one number), ``local_confidence`` (n_t,) float64, ``landmarks`` (l, 2) int64,
        ``place_faces`` (n_t,) int64 and ``place_weights`` (n_t, 3) float64 (points inside the source's triangles),
        ``overlap_source`` (n_s,) and ``overlap_target`` (n_t,) float64 (probability to be in the part that both have),
        ``bent`` (n_s, 3) float64 (the source's vertices on the target at unit area), ``source_sha256`` and
        ``target_sha256`` (of the files), ``n_s`` (how
        many vertices the source has), ``source``, ``target`` (paths) and ``summary`` (JSON text).
    """

    target_to_source: np.ndarray
    functional_map: np.ndarray | None = None
    eigenvalues_s: np.ndarray | None = None
    eigenvalues_t: np.ndarray | None = None
    config: str = ""
    extra: Mapping[str, np.ndarray | str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "target_to_source", check_map(self.target_to_source, lost=True))
        for name in ("functional_map", "eigenvalues_s", "eigenvalues_t"):
            value = getattr(self, name)
            if value is not None:
                shape = (None, None) if name == "functional_map" else (None,)
                check(real(value, name), name, shape=shape, remedy=REPAIR)
                object.__setattr__(self, name, np.asarray(value, dtype=np.float64))
        if self.functional_map is not None:
            sides = (("eigenvalues_t", self.eigenvalues_t), ("eigenvalues_s", self.eigenvalues_s))
            for size, (name, values) in zip(self.functional_map.shape, sides, strict=True):
                if values is not None and len(values) != size:
                    got = f"{len(values)} beside a map of shape {self.functional_map.shape}"
                    raise refuse(name, f"{size} numbers", got, REPAIR)
        for name in self.extra:
            if not _NAME.fullmatch(name) or name in (*_FIELDS, "file", "allow_pickle"):  # savez has these
                wanted = "names of letters, digits and _, up to 31 of them and not in use"
                raise refuse("extra", wanted, repr(name), "rename it")
        object.__setattr__(self, "config", json_text(self.config, "config"))
        n_s, n_t = self.n_s, len(self.target_to_source)
        check_map(self.target_to_source, n_s, name="target_to_source", lost=True)
        object.__setattr__(self, "extra", checked_extra(self.extra, n_t, n_s))

    @property
    def n_s(self) -> int | None:
        """How many vertices the source has, when ``extra`` says so."""
        value = np.asarray(self.extra.get("n_s", 0))
        if "n_s" not in self.extra:
            return None
        if value.size != 1 or value.dtype.kind not in "iuf" or not 0 < value.item() < 2**53:
            raise refuse("extra n_s", "one whole number above 0", repr(self.extra["n_s"]), REPAIR)
        return int(value.item())

    @property
    def place(self) -> PointMap | None:
        """Points inside the source's triangles, where the file has them."""
        faces, weights = self.extra.get("place_faces"), self.extra.get("place_weights")
        if faces is None or weights is None:
            return None
        return PointMap(np.asarray(faces), np.asarray(weights))


def check_map(
    target_to_source: Any, n_s: int | None = None, n_t: int | None = None, name: str = "map", *, lost: bool = False
) -> np.ndarray:
    """``target_to_source`` as (n_t,) int64 when it names a source vertex for every target vertex.

    Parameters
    ----------
    target_to_source : array or MapFile
    n_s, n_t : int, optional
        How many vertices the source and target have, when known.
    name : str
        How messages call it.
    lost : bool
        Whether −1 may stand for a vertex without counterpart.

    Raises
    ------
    InvalidInput
        On another length or shape, fractions, and numbers out of range.
    """
    if isinstance(target_to_source, MapFile):
        target_to_source = target_to_source.target_to_source
    remedy = "check that the map belongs to these two meshes, in this order"
    numbers = real(target_to_source, name)
    check(numbers, name, shape=(n_t,), remedy=remedy)
    if len(numbers) == 0 or (numbers.dtype.kind == "f" and (numbers != np.rint(numbers)).any()):
        got = "none" if len(numbers) == 0 else "fractions"
        raise refuse(name, "a whole number for each target vertex", got, REPAIR)
    low, high = numbers.min(), numbers.max()
    if low == -1 and not lost:
        wanted, got = "a counterpart of every target vertex", f"{np.count_nonzero(numbers == -1)} without one"
        raise refuse(name, wanted, got, "give a map between whole shapes")
    if low < -int(lost) or high >= (2**53 if n_s is None else n_s):
        wanted = "source vertices from 0 on" if n_s is None else f"source vertices from 0 to {n_s - 1}"
        raise refuse(name, wanted, f"{int(low if low < -int(lost) else high)}", remedy)
    return numbers.astype(np.int64)


def match_map(match: Match) -> MapFile:
    """What a match knows of its map, ready to be saved; the paths of the meshes are not among it."""
    from kfmaps.config import as_dict  # only here: reading a map needs no settings

    extra: dict[str, Any] = {
        "raw_functional_map": match.fit.raw_functional_map,
        "raw_target_to_source": match.fit.raw_target_to_source,
        "runners_up": np.stack(match.alternatives) if match.alternatives else None,
        "confidence": None if match.confidence is None else np.float64(match.confidence),
        "source_to_target": match.source_to_target,
        "map_back": match.functional_map_back,
        "local_confidence": match.local_confidence,
        "place_faces": match.precise_map and match.precise_map.faces,
        "place_weights": match.precise_map and match.precise_map.weights,
        "bent": match.registration.registered_vertices,
        "overlap_source": match.partial.overlap_source,
        "overlap_target": match.partial.overlap_target,
        "n_s": None if match.n_source is None else np.int64(match.n_source),
    }
    extra = {name: value for name, value in extra.items() if value is not None}
    config = "" if match.config is None else json.dumps(as_dict(match.config))
    return MapFile(
        match.target_to_source,
        match.functional_map,
        match.eigenvalues_source,
        match.eigenvalues_target,
        config,
        extra,
    )


def save_map(path: str | Path, mapfile: MapFile | Match, force: bool = False) -> None:
    """Write a map, or that of a match; the extension chooses the format.

    ``.npz`` and ``.mat`` hold everything: arrays under the names of :class:`MapFile` and ``extra``, texts as
    0-d strings. In ``.mat`` vertex numbers count from 1, as MATLAB does, −1 stays, and lists are columns of doubles.
    ``.txt`` and ``.vts`` hold ``target_to_source`` alone, one number a line, counted from 0 and from 1; −1 where a
    vertex has no counterpart.

    Raises
    ------
    InvalidInput
        On an unknown extension, and as :func:`atomic_output`.
    """
    if not isinstance(mapfile, MapFile):
        from kfmaps.matching.result import Match  # only here, as above

        if not isinstance(mapfile, Match):
            raise refuse("map", "a Match or a MapFile", type(mapfile).__name__, "give what kfmaps.match returned")
        mapfile = match_map(mapfile)
    suffix = Path(path).suffix.lower()
    check_format(path)
    check_output(path, force)
    if suffix in (".txt", ".vts"):
        write_vertex_numbers(path, mapfile.target_to_source, force=force)
        return
    content = {k: v for k in _FIELDS[1:] if (v := getattr(mapfile, k)) is not None and not _empty_text(v)}
    content |= {k: v for k, v in mapfile.extra.items() if not _empty_text(v)}
    # last, so that a file cut anywhere lacks the one array that must be there
    content["target_to_source"] = mapfile.target_to_source
    with atomic_output(path, force) as temporary, open(temporary, "wb") as file:
        if suffix == ".npz":
            np.savez_compressed(file, **content)
        else:
            shifted = {k: np.where(v < 0, -1.0, v + 1.0) if k in VERTEX_NUMBERS else v for k, v in content.items()}
            from scipy.io import savemat

            savemat(file, shifted, oned_as="column", do_compression=True)


def _empty_text(value: Any) -> bool:
    return isinstance(value, str) and not value


def check_format(path: str | Path) -> None:
    """Raise :class:`InvalidInput` when ``path`` has no extension of a map."""
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS:
        raise refuse(f"map {path}", f"one of {' '.join(FORMATS)}", suffix or "no extension", "rename it")


def load_map(path: str | Path) -> MapFile:
    """Read what :func:`save_map` writes.

    Nothing in the file is ever executed: pickled objects are refused. Whether the numbers fit two meshes
    is for :func:`check_map` to say.

    Raises
    ------
    InvalidInput
        On an unknown extension, a file that is missing, cut short or not of its format, and contents that
        are no map.
    """
    path, name = Path(path), str(path)
    check_format(path)
    suffix = path.suffix.lower()
    if suffix in (".txt", ".vts"):
        return MapFile(read_vertex_numbers(path, lost=True))
    data = read_bytes(path)
    try:
        content = (_npz_content if suffix == ".npz" else _mat_content)(data, name)
    except InvalidInput:
        raise
    except Exception as error:  # the readers report broken files by whatever they run into
        got = " ".join(f"{type(error).__name__}: {error}".split())[:100]
        raise refuse(name, f"a complete {suffix} file", got, REPAIR) from error
    if "target_to_source" not in content:
        got = ", ".join(sorted(content)) or "an empty file"
        raise refuse(name, "an array target_to_source", got, "give a map that kfmaps wrote")
    fields = {k: content.pop(k) for k in _FIELDS if k in content}
    try:
        return MapFile(**fields, extra=content)
    except InvalidInput as error:
        raise InvalidInput(f"{name}: {error}") from error


def check_npy(file: IO[bytes], size: int, name: str) -> float:
    """How many numbers an .npy file of ``size`` bytes holds; refused when its header says more than fit into it."""
    first = np.lib.format.read_magic(file) == (1, 0)
    read = np.lib.format.read_array_header_1_0 if first else np.lib.format.read_array_header_2_0
    shape, _, dtype = read(file)
    count = float(np.prod(shape, dtype=float))
    if count * dtype.itemsize > size:
        raise refuse(name, f"data for shape {shape}", f"{size} bytes", REPAIR)
    return count * max(1.0, dtype.itemsize / 8)


def _npz_content(data: bytes, name: str) -> dict[str, Any]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        items = archive.infolist()
        # What an archive unpacks to may be a thousand times its size: what it declares is looked at first.
        check_size(sum(item.file_size for item in items) / 8, name)
        total = 0.0
        for item in items:
            with archive.open(item) as file:
                total += check_npy(file, item.file_size, f"{name}: {item.filename}")
        check_size(total, name)
    with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
        loaded = {k: arrays[k] for k in arrays.files}
    return {k: str(v) if v.dtype.kind == "U" and v.ndim == 0 else v for k, v in loaded.items()}


def check_size(count: float, name: str) -> None:
    """Refuse a map file that unpacks to more than :data:`LARGEST` numbers."""
    if count > LARGEST:
        wanted = f"a map of at most {in_words(8 * LARGEST)} unpacked"
        raise refuse(name, wanted, in_words(8 * count), "a map takes a few numbers for each vertex: check the file")


def _mat_content(data: bytes, name: str) -> dict[str, Any]:
    content: dict[str, Any] = {}
    for key, value in read_mat(data, name, 8 * LARGEST).items():
        if isinstance(value, str):
            content[key] = value
        elif key in ("target_to_source", "eigenvalues_s", "eigenvalues_t"):
            content[key] = value.ravel()
        else:
            content[key] = value[:, 0] if value.ndim == 2 and value.shape[1] == 1 else value
        if key in VERTEX_NUMBERS:
            # through float64, in which MATLAB keeps them: an unsigned 0 must not wrap around
            numbers = real(content[key], f"{name}: {key}").astype(np.float64)
            if key == "target_to_source" and (numbers == 0).any():
                raise refuse(f"{name}: {key}", "numbers from 1 on, -1 for none", "0", "a .mat file counts from 1")
            content[key] = np.where((numbers == -1) & (key == "target_to_source"), -1, numbers - 1)
    return content
