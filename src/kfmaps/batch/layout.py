"""Find shapes, true correspondences, landmarks and pairs in a folder."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from kfmaps._arrays import refuse
from kfmaps.io.landmark_files import landmark_stem, landmark_suffix
from kfmaps.io.meshes import READERS
from kfmaps.io.text import read_text

_SHAPE_FOLDERS = ("shapes", "off", "meshes", "ply", "obj")
"""Folders of the shapes in data sets without shapes in the top folder; the first one with shapes counts."""
_PAIRS_FILE = "test_pairs.txt"
_MAX_KEY = 200  # bytes of a key; file systems take names of 255


@dataclass(frozen=True, order=True)
class Pair:
    """Names of a source and a target."""

    source: str
    target: str

    def __str__(self) -> str:
        return f"{self.source} → {self.target}"

    @property
    def key(self) -> str:
        """Name of the pair's files: ``A-B``, or ``A--B`` where a name itself has a hyphen.

        Names that are too long are cut, and a digest of both follows.
        """
        joint = "--" if "-" in self.source + self.target else "-"
        whole = f"{self.source}{joint}{self.target}"
        if len(os.fsencode(whole)) <= _MAX_KEY:
            return whole
        digest = hashlib.sha256(os.fsencode(f"{self.source}\0{self.target}")).hexdigest()[:16]
        start = _MAX_KEY // 2 - 10
        names = (os.fsencode(name)[:start].decode("utf-8", "ignore") for name in (self.source, self.target))
        return f"{joint.join(names)}{joint}{digest}"


@dataclass(frozen=True)
class ShapeFolder:
    """The content of a folder of shapes."""

    folder: Path
    shapes: Mapping[str, Path]  # in natural order: 2 before 10
    # Vertex lists, whose line k is the same point on all shapes.
    truth: Mapping[str, Path] = field(default_factory=dict)
    mirrored: Mapping[str, Path] = field(default_factory=dict)  # the lists with left and right swapped
    # Truth of one pair: line i is the target's vertex for the source's vertex i, counted from 1 (SHREC'19).
    maps: Mapping[Pair, Path] = field(default_factory=dict)
    # Vertex lists as for ``truth``, or landmarks with names.
    landmarks: Mapping[str, Path] = field(default_factory=dict)
    # Landmarks of source and target for one pair, instead of those of the shapes.
    pair_landmarks: Mapping[Pair, tuple[Path, Path]] = field(default_factory=dict)
    pairs: Path | None = None  # the folder's own list of pairs


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """Return a sorting key under which numbers inside names count as numbers."""
    parts = re.findall(r"\d+|\D+", name)
    return [(0, int(part), part) if part.isdecimal() else (1, 0, part) for part in parts]


def find_collection(folder: str | Path) -> ShapeFolder:
    """Return the content of a folder with the usual layout of data sets.

    Shapes lie in the folder itself or, when it has none, in ``shapes/``, ``off/``, ``meshes/``, ``ply/`` or ``obj/``.
    Truth lies in ``corres/`` (or ``groundtruth/``) as ``NAME.vts`` and ``NAME.sym.vts``, or per pair as ``A_B.map``;
    landmarks in ``landmarks/NAME.txt`` (counted from 0) or ``NAME.vts`` (counted from 1), or in other programs' formats
    (:mod:`kfmaps.io.landmark_files`); pairs in ``test_pairs.txt``.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise refuse(f"collection {folder}", "a folder of meshes", "no folder", "check the path")
    shapes = _shapes(folder)
    for name in _SHAPE_FOLDERS:
        shapes = shapes or _shapes(folder / name)
    if not shapes:
        places = ", ".join(f"{name}/" for name in _SHAPE_FOLDERS)
        expected = f"meshes ({' '.join(READERS)}) in it or in {places}"
        raise refuse(f"collection {folder}", expected, "none", "check the path")
    truth_files = [p for name in ("corres", "groundtruth") for p in _files(folder / name)]
    lists = {p.name[:-4]: p for p in truth_files if p.suffix == ".vts" and not p.name.endswith(".sym.vts")}
    mirrored = {p.name[:-8]: p for p in truth_files if p.name.endswith(".sym.vts")}
    landmarks = [p for p in _files(folder / "landmarks") if p.suffix in (".txt", ".vts") or landmark_suffix(p)]
    pairs = folder / _PAIRS_FILE
    return ShapeFolder(
        folder,
        shapes,
        truth={name: lists[name] for name in shapes if name in lists},
        mirrored={name: mirrored[name] for name in shapes if name in mirrored},
        maps=_pair_truth([p for p in truth_files if p.suffix == ".map"], shapes),
        landmarks={name: p for p in landmarks if (name := landmark_stem(p)) in shapes},
        pairs=pairs if pairs.is_file() else None,
    )


def _files(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    return sorted(p for p in folder.iterdir() if p.is_file() and not p.name.startswith("."))


def _shapes(folder: Path) -> dict[str, Path]:
    shapes: dict[str, Path] = {}
    for path in _files(folder):
        if path.suffix.lower() not in READERS:
            continue
        if path.stem in shapes:
            got = f"{shapes[path.stem].name} and {path.name}"
            raise refuse(f"shape {path.stem}", "one file for each name", got, "keep one of them")
        shapes[path.stem] = path
    return {name: shapes[name] for name in sorted(shapes, key=natural_key)}


def _pair_truth(paths: Iterable[Path], shapes: Mapping[str, Path]) -> dict[Pair, Path]:
    """Return the files ``A_B.map`` by pair; the names may have underscores."""
    maps = {}
    for path in paths:
        parts = path.stem.split("_")
        for cut in range(1, len(parts)):
            pair = Pair("_".join(parts[:cut]), "_".join(parts[cut:]))
            if pair.source in shapes and pair.target in shapes:
                maps[pair] = path
    return {pair: maps[pair] for pair in sorted(maps, key=lambda p: (natural_key(p.source), natural_key(p.target)))}


def read_pairs(collection: ShapeFolder, file: str | Path | None = None) -> list[Pair]:
    """Return the pairs of a list, each once and in order.

    ``file``: two names a line, "source target", with or without the mesh's extension; ``#`` starts a comment. By
    default the folder's own list, else the pairs for which the folder has a truth.
    """
    pairs_file = file or collection.pairs
    if pairs_file is None and not collection.maps:
        got = f"no {_PAIRS_FILE} in {collection.folder}"
        raise refuse("pairs", "a list of pairs", got, "give --pairs FILE, or let --graph near choose them")
    return list(dict.fromkeys(collection.maps if pairs_file is None else _read_pairs(pairs_file, collection)))


def shape_name(name: str, collection: ShapeFolder, where: str) -> str:
    """Return the name of a shape, which may have an extension; ``where``: its place in messages."""
    for candidate in (name, Path(name).stem):
        if candidate in collection.shapes:
            return candidate
    examples = ", ".join(list(collection.shapes)[:5])
    raise refuse(where, f"a shape of {collection.folder} ({examples}, ...)", repr(name), "check the spelling")


def _read_pairs(path: str | Path, collection: ShapeFolder) -> list[Pair]:
    """Read a list of pairs; see :func:`read_pairs`."""
    pairs = []
    for number, line in enumerate(read_text(path).splitlines(), 1):
        words = line.split("#", 1)[0].replace(",", " ").split()
        if not words:
            continue
        where = f"{path}, line {number}"
        if len(words) != 2:
            raise refuse(where, "two names, source and target", f"{len(words)}", "write one pair a line")
        pairs.append(Pair(*(shape_name(word, collection, where) for word in words)))
    if not pairs:
        raise refuse(f"pairs {path}", "two names a line", "no pairs", "check the file")
    return pairs
