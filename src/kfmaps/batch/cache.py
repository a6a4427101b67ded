"""A cache of prepared shapes and their samples on disk, by the mesh file's content and the relevant settings."""

from __future__ import annotations

import hashlib
import json
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

import numpy as np

import kfmaps
from kfmaps._arrays import Array, InvalidInput
from kfmaps.batch.run_spec import digest_of
from kfmaps.config import Config
from kfmaps.io import atomic_output
from kfmaps.io.gltf import buffer_files
from kfmaps.io.mapcontent import plain_record, read_record
from kfmaps.io.text import read_bytes
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.search import scoring_samples
from kfmaps.shape import Shape

_LAYOUT = 11  # raised when the content of entries changes
_PLAIN = "plain"  # name of the JSON text in an entry: everything but the arrays

_Record = TypeVar("_Record")


def file_digest(path: str | Path) -> str:
    """Return a digest of a file, 32 hexadecimal digits; a .gltf includes its buffer files."""
    with open(path, "rb") as file:
        digest = hashlib.file_digest(file, "sha256")
    if Path(path).suffix.lower() == ".gltf":
        with suppress(InvalidInput):  # reported when the shape is prepared
            for buffer_file in buffer_files(read_bytes(path), str(path)):
                digest.update(hashlib.sha256(read_bytes(buffer_file)).digest())
    return digest.hexdigest()[:32]


def shape_key(content: str, suffix: str, config: Config) -> str:
    """Return the name of a cache entry: a digest of the file's digest ``content``, its extension, and the settings."""
    return digest_of(
        {
            "layout": _LAYOUT,
            "version": kfmaps.__version__,
            "content": content,
            "suffix": suffix.lower(),
            "laplacian": config.basis.laplacian,
            "eigenfunctions": config.n_eigenfunctions,
            "shot": config.descriptors.shot_radius if config.descriptors.shot else None,
        },
        digits=32,
    )


def _samples_path(entry: Path, seed: int) -> Path:
    """Return the file of the samples for this seed, beside the ``entry`` of their shape."""
    return entry.with_name(f"{entry.stem}.samples{seed}.npz")


def cached_samples(shape: Shape, entry: Path, seed: int) -> ShapeSamples:
    """Return the samples of ``shape`` for a search: read from the cache, or computed and stored there."""
    path = _samples_path(entry, seed)
    samples = load_record(path, ShapeSamples)
    if samples is None:
        samples = scoring_samples(shape, seed)
        save_record(path, samples)
    return samples


def save_record(path: Path, record: object) -> None:
    """Write a dataclass with its arrays and the dataclasses in it, whole or not at all."""
    arrays: dict[str, Array] = {}
    content = json.dumps(plain_record(record, arrays))
    with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
        np.savez(file, allow_pickle=False, **{_PLAIN: content}, **arrays)


def load_record(path: Path, kind: type[_Record]) -> _Record | None:
    """Read what :func:`save_record` wrote; ``None`` when there is none or the file is damaged."""
    try:
        with open(path, "rb") as file, np.load(file, allow_pickle=False) as archive:
            arrays = dict(archive)
        return read_record(kind, json.loads(str(arrays.pop(_PLAIN))), str(path), arrays)
    except Exception:  # NumPy reports a damaged file by whatever it runs into
        return None
