"""Prepared shapes and their samples on disk, found again by the content of the mesh and the settings that matter."""

from __future__ import annotations

import hashlib
from contextlib import suppress
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np

import kfmaps
from kfmaps._arrays import InvalidInput
from kfmaps.batch.run_spec import digest_of
from kfmaps.config import Config
from kfmaps.io import atomic_output
from kfmaps.io.gltf import buffer_files
from kfmaps.io.text import read_bytes
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.search import scoring_samples
from kfmaps.shape import Shape

_LAYOUT = 3  # raised when what an entry holds changes


def file_digest(path: str | Path) -> str:
    """Return 32 hexadecimal digits for the content of a file, and of those that a .gltf keeps its numbers in."""
    with open(path, "rb") as file:
        digest = hashlib.file_digest(file, "sha256")
    if Path(path).suffix.lower() == ".gltf":
        with suppress(InvalidInput):  # what cannot be read is told when its shape is prepared
            for beside in buffer_files(read_bytes(path), str(path)):
                digest.update(hashlib.sha256(read_bytes(beside)).digest())
    return digest.hexdigest()[:32]


def shape_key(content: str, suffix: str, config: Config) -> str:
    """Return the name of an entry: ``content`` (digest of the mesh's file) with all settings of its preparation.

    ``suffix`` is the file's extension, which decides how its content is read.
    """
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


def load_shape(path: Path, name: str) -> Shape | None:
    """Read a prepared shape; ``None`` when there is none or the entry is damaged, so that it is made again."""
    shape = load_record(path, Shape)
    return None if shape is None else replace(shape, name=name)


def _samples_path(entry: Path, seed: int) -> Path:
    """Return where the samples for this seed lie, beside the ``entry`` of their shape."""
    return entry.with_name(f"{entry.stem}.samples{seed}.npz")


def cached_samples(shape: Shape, entry: Path, seed: int) -> ShapeSamples:
    """Return what a search needs to know of ``shape``: read where it is kept, else worked out and kept."""
    path = _samples_path(entry, seed)
    samples = load_record(path, ShapeSamples)
    if samples is None:
        samples = scoring_samples(shape, seed)
        save_record(path, samples)
    return samples


def save_record(path: Path, record: Any) -> None:
    """Write the arrays of a dataclass and of those in it, whole or not at all."""
    with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
        np.savez(file, allow_pickle=False, **_flatten(record, ""))


def load_record(path: Path, kind: type) -> Any:
    """Read what :func:`save_record` wrote; ``None`` when there is none or the file is damaged."""
    try:
        with open(path, "rb") as file, np.load(file, allow_pickle=False) as arrays:
            return _restore(kind, dict(arrays), "")
    except FileNotFoundError:
        return None
    except Exception:  # NumPy reports a damaged file by whatever it runs into
        return None


def _flatten(record: Any, before: str) -> dict[str, np.ndarray]:
    """Arrays by dotted names; what is ``None`` is left out, a dictionary of numbers is two arrays."""
    arrays: dict[str, np.ndarray] = {}
    for field in fields(record):
        value, name = getattr(record, field.name), before + field.name
        if is_dataclass(value):
            arrays |= _flatten(value, name + ".")
        elif isinstance(value, dict):
            arrays |= {f"{name}.keys": np.array(list(value)), f"{name}.values": np.array(list(value.values()))}
        elif isinstance(value, tuple) and all(map(is_dataclass, value)):
            arrays[f"{name}.count"] = np.array(len(value))
            for i, one in enumerate(value):
                arrays |= _flatten(one, f"{name}.{i}.")
        elif value is not None:
            arrays[name] = np.asarray(value)
    return arrays


def _restore(kind: Any, arrays: dict[str, np.ndarray], before: str) -> Any:
    """The record of which :func:`_flatten` made ``arrays``; ``KeyError`` when one is missing that is not optional."""
    values = {}
    for name, hint in get_type_hints(kind).items():
        path = before + name
        inner = next((part for part in (hint, *get_args(hint)) if is_dataclass(part)), None)
        if inner is not None and get_origin(hint) is tuple:
            numbers = range(int(arrays[f"{path}.count"]))
            values[name] = tuple(_restore(inner, arrays, f"{path}.{i}.") for i in numbers)
        elif inner is not None:
            there = inner is hint or any(key.startswith(f"{path}.") for key in arrays)
            values[name] = _restore(inner, arrays, f"{path}.") if there else None
        elif get_origin(hint) is dict:
            values[name] = dict(zip(arrays[f"{path}.keys"].tolist(), arrays[f"{path}.values"].tolist(), strict=True))
        elif path in arrays or "None" not in str(hint):
            array = arrays[path]
            values[name] = array if array.ndim else array.item()
        else:
            values[name] = None
    return kind(**values)
