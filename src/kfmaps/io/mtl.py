"""The picture of an OBJ file: named by the materials of its faces, in an MTL file beside it."""

from __future__ import annotations

from pathlib import Path, PurePosixPath

import numpy as np

from kfmaps.io.record import Picture, picture_in
from kfmaps.io.text import read_bytes

_NUMBERS = {"-o": 3, "-s": 3, "-t": 3}
"""Options of a map that move, scale or disturb the picture, with up to so many numbers."""
_VALUES = {"-mm": 2}
"""Numbers after other options; one after those that are not named."""


def obj_picture(said: list[tuple[int, str, str]], faces: np.ndarray, name: str) -> Picture | None:
    """The one colour texture (``map_Kd``) of all faces of an OBJ file; ``None`` when there is no such one.

    Files that are missing, lie elsewhere than in the folder of the OBJ file or below it, or are no PNG or JPEG are
    none either, and so are pictures that are moved or scaled: who wants the shape alone need not have them.
    Specification: Alias/Wavefront, "MTL material format", 1995.

    Parameters
    ----------
    said : list of (line, word, rest)
        The file's lines ``mtllib`` and ``usemtl``, from line 1 on, ascending.
    faces : (p,) int64
        The line of each face.
    name : str
        The OBJ file.
    """
    used = [(line, rest) for line, word, rest in said if word == "usemtl"]
    if not used or len(faces) == 0:
        return None
    last = np.searchsorted([line for line, _ in used], faces) - 1
    if last.min() < 0:
        return None  # faces before any material
    pictures: dict[str, str | None] = {}
    for _, word, rest in said:
        if word == "mtllib":
            for path in _libraries(rest, name):
                pictures |= materials(read_bytes(path).decode("utf-8", "replace"))
    found = {pictures.get(used[i][1]) for i in np.unique(last)}
    path = found.pop() if len(found) == 1 else None
    here = None if path is None else _beside(path, name)
    return None if here is None else picture_in(read_bytes(here))


def materials(text: str) -> dict[str, str | None]:
    """The picture that each material of an MTL file names; ``None`` where it has none as it is."""
    found: dict[str, str | None] = {}
    current = None
    for line in text.splitlines():
        word, _, rest = line.strip().replace("\t", " ").partition(" ")
        rest = rest.strip()
        if word == "newmtl":
            current = rest
            found.setdefault(current, None)
        elif word.lower() == "map_kd" and current is not None:
            found[current] = _plain(rest)
    return found


def _plain(rest: str) -> str | None:
    """The file of a map, after its options; ``None`` where these move or scale the picture."""
    while rest.startswith("-"):
        option, _, rest = rest.partition(" ")
        rest = rest.lstrip()
        least, most = (1, _NUMBERS[option]) if option in _NUMBERS else (_VALUES.get(option, 1),) * 2
        values = []
        while len(values) < most and rest:
            value, _, after = rest.partition(" ")
            if len(values) >= least and not _is_number(value):
                break
            values.append(value)
            rest = after.lstrip()
        still = "1" if option == "-s" else "0"
        if option in _NUMBERS and not all(_is_number(v) and float(v) == float(still) for v in values):
            return None
    return rest or None


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _libraries(rest: str, name: str) -> list[Path]:
    """The files of a line ``mtllib``: one whose name may have spaces, or several."""
    whole = _beside(rest, name)
    if whole is not None:
        return [whole]
    return [path for word in rest.split() if (path := _beside(word, name)) is not None]


def _beside(said: str, name: str) -> Path | None:
    """The file that a relative name means, in the folder of ``name`` or below it; ``None`` when it is not there."""
    path = PurePosixPath(said.replace("\\", "/"))
    if not path.parts or path.is_absolute() or ".." in path.parts or ":" in path.parts[0] or "\0" in said:
        return None
    here = Path(name).parent / path
    return here if here.is_file() and here.stat().st_size else None
