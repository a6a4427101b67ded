"""What a search needs to know of one shape, kept on disk beside the prepared shape for all pairs that it is in."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, get_args, get_type_hints

import numpy as np

from kfmaps.io import atomic_output
from kfmaps.matching.quality import ShapeSamples
from kfmaps.matching.search import scoring_samples
from kfmaps.shape import Shape


def probe_path(entry: Path, seed: int) -> Path:
    """Where the probe for this seed lies, beside the ``entry`` of its shape."""
    return entry.with_name(f"{entry.stem}.probe{seed}.npz")


def kept_probe(shape: Shape, entry: Path, seed: int) -> ShapeSamples:
    """The probe of ``shape``: read where it is kept, else worked out and kept. The same to the last bit."""
    path = probe_path(entry, seed)
    found = load_probe(path)
    if found is None:
        found = scoring_samples(shape, seed)
        save_probe(path, found)
    return found


def save_probe(path: Path, probe: ShapeSamples) -> None:
    """Write it whole or not at all."""
    with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
        np.savez(file, allow_pickle=False, **_flat(probe, ""))


def load_probe(path: Path) -> ShapeSamples | None:
    """Read it; ``None`` when there is none or it is damaged, so that it is worked out again."""
    try:
        with open(path, "rb") as file, np.load(file, allow_pickle=False) as arrays:
            return _record(ShapeSamples, dict(arrays), "")
    except FileNotFoundError:
        return None
    except Exception:  # NumPy reports a damaged file by whatever it runs into
        return None


def _flat(record: Any, before: str) -> dict[str, np.ndarray]:
    """The arrays of a record and of the records in it, with dotted names; what is ``None`` is left out."""
    found: dict[str, np.ndarray] = {}
    for field in fields(record):
        value, name = getattr(record, field.name), before + field.name
        if is_dataclass(value):
            found |= _flat(value, name + ".")
        elif value is not None:
            found[name] = np.asarray(value)
    return found


def _record(kind: Any, arrays: dict[str, np.ndarray], before: str) -> Any:
    """The record of which :func:`_flat` made ``arrays``.

    Raises
    ------
    KeyError
        When one is missing that is not optional.
    """
    values = {}
    for name, hint in get_type_hints(kind).items():
        within = next((part for part in (hint, *get_args(hint)) if is_dataclass(part)), None)
        if within is not None:
            there = within is hint or any(key.startswith(f"{before}{name}.") for key in arrays)
            values[name] = _record(within, arrays, f"{before}{name}.") if there else None
        elif before + name in arrays or "None" not in str(hint):
            array = arrays[before + name]
            values[name] = array if array.ndim else array.item()
        else:
            values[name] = None
    return kind(**values)
