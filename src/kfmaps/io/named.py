"""The files of two shapes that a map names, and whether they are still the same."""

from __future__ import annotations

import hashlib
import warnings
from pathlib import Path

from kfmaps._arrays import KfmapsWarning
from kfmaps.io.mapfile import MapFile


def sha256(path: str | Path) -> str:
    """SHA-256 of a file, 64 hexadecimal digits; empty when it cannot be read."""
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""


def warn_of_change(found: MapFile, side: str, path: Path) -> None:
    """Warn (:class:`KfmapsWarning`) when the file of ``side`` is not the one that was matched."""
    known = found.extra.get(f"{side}_sha256")
    if isinstance(known, str) and known and sha256(path) not in ("", known):
        warnings.warn(f"{path} has changed since the map was made", KfmapsWarning, stacklevel=2)
