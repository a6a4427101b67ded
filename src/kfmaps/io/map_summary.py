"""What a match tells beside its large arrays: plain values for JSON, and the match that is made of them again."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, fields, is_dataclass
from types import NoneType
from typing import Any, Literal, TypeVar, get_args, get_origin

import numpy as np

import kfmaps
from kfmaps._arrays import Array, InvalidInput, refuse
from kfmaps._records import JsonObject, settings_of, types_of
from kfmaps.config import Config, as_dict, from_dict
from kfmaps.io.mapcontent import ARRAYS
from kfmaps.io.text import REPAIR
from kfmaps.matching.result import SHAPE_FIELDS, Match

_T = TypeVar("_T")

_ELSEWHERE = {*(array.field for array in ARRAYS.values()), *SHAPE_FIELDS, "_reindexing"}
"""Fields of a match that its summary does not hold."""


def summarize_match(match: Match) -> JsonObject:
    """Return plain values of a match for JSON: its fields without the large arrays, and a few counts.

    The names are those of :class:`kfmaps.Match`; a group of fields is a dictionary. Numbers that are not finite are
    ``None``.
    """
    return {
        "version": kfmaps.__version__,
        **plain_record(match),
        "map_size": list(match.functional_map.shape) if hasattr(match, "functional_map") else None,
        "n_landmarks": len(match.landmarks),
        "n_alternatives": len(match.alternatives),
        "n_unmatched": int((match.target_to_source < 0).sum()),
        "mean_local_confidence": mean_confidence(match),
    }


def mean_confidence(match: Match) -> float | None:
    """Return the mean of ``local_confidence`` over the target's vertices; ``None`` where it is known at none."""
    values = getattr(match, "local_confidence", np.zeros(0))
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else None


def plain_record(record: Any, arrays: dict[str, np.ndarray] | None = None, path: str = "") -> JsonObject:
    """Return the fields of a record as plain values for JSON, without those that a map file keeps elsewhere.

    With ``arrays`` its arrays are put there, under dotted names, as :func:`read_record` takes them.
    """
    kept = [f for f in fields(type(record)) if path + f.name not in _ELSEWHERE and f.name != "precise_map"]
    return {f.name: _plain(getattr(record, f.name, None), f"{path}{f.name}", arrays) for f in kept}


def _plain(value: Any, path: str, arrays: dict[str, np.ndarray] | None) -> Any:
    if isinstance(value, Config):
        return as_dict(value)
    if is_dataclass(value):
        return plain_record(value, arrays, f"{path}.")
    if isinstance(value, np.ndarray) and arrays is not None:
        arrays[path] = value
        return None
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist(), path, arrays)
    if isinstance(value, Mapping):
        return {str(key): _plain(one, path, arrays) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one, path, arrays) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def read_record(
    cls: type[_T], values: object, name: str, arrays: Mapping[str, Array] | None = None, path: str = ""
) -> _T:
    """Return a record of plain ``values`` and of ``arrays`` by field; what neither has is as by default.

    ``name`` is the file's, ``path`` leads to the record in it, such as "fit.".
    """
    arrays = arrays or {}
    if not isinstance(values, Mapping):
        raise refuse(f"{name}: {path[:-1] or 'summary'}", "the fields of a record", repr(values)[:60], REPAIR)
    found: JsonObject = {}
    for one in settings_of(cls).values():
        label, value = path + one.name, values.get(one.name)
        record = next((kind for kind in one.types if is_dataclass(kind)), None)
        if label in arrays:
            found[one.name] = arrays[label]
        elif record is Config:
            found[one.name] = _config(value)
        elif isinstance(record, type) and label not in _ELSEWHERE:
            if value is not None or any(key.startswith(f"{label}.") for key in arrays):
                found[one.name] = read_record(record, value or {}, name, arrays, f"{label}.")
            elif one.optional:
                found[one.name] = None
        elif one.name in values and label not in _ELSEWHERE:
            found[one.name] = _read_value(one.hint, value, f"{name}: {label}")
        elif one.default is MISSING:
            raise refuse(f"{name}: {label}", "a value", "none", REPAIR)
    return cls(**found)


def _read_value(hint: object, value: Any, label: str) -> Any:
    """``value`` as one of the types of ``hint``; a number that was not finite is NaN."""
    kinds = types_of(hint)
    if value is None and NoneType in kinds:
        return None
    for kind in kinds:
        origin, inner = get_origin(kind), get_args(kind)
        if origin is Literal and value in inner:
            return value
        if origin is tuple and isinstance(value, list):
            return tuple(_read_value(inner[0], one, label) for one in value)
        if origin is dict and isinstance(value, dict):
            return {key: _read_value(inner[1], one, label) for key, one in value.items()}
        if kind is np.ndarray and isinstance(value, list):
            numbers = np.array([_read_value(float, one, label) for one in value], dtype=np.float64)
            return numbers.astype(np.int64) if all(type(one) is int for one in value) else numbers
        if kind is float and (value is None or (type(value) in (int, float) and abs(value) < 2**1023)):
            return math.nan if value is None else float(value)
        if kind in (int, str, bool) and type(value) is kind:
            return value
    raise refuse(label, hint.__name__ if isinstance(hint, type) else str(hint), repr(value)[:60], REPAIR)


def _config(values: JsonObject | None) -> Config | None:
    """The configuration of plain values; ``None`` where they name what only the user's own code has."""
    try:
        return None if values is None else from_dict(values)
    except InvalidInput:
        return None
