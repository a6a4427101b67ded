"""What a match tells beside its large arrays: plain values for JSON, and the match that is made of them again."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import MISSING, fields, is_dataclass
from functools import lru_cache
from types import NoneType
from typing import Any, Literal, TypeVar, get_args, get_origin, get_type_hints

import numpy as np

import kfmaps
from kfmaps._arrays import Array, InvalidInput, refuse
from kfmaps._records import JsonObject
from kfmaps.config import Config, as_dict, from_dict
from kfmaps.io.mapcontent import ARRAYS
from kfmaps.io.text import REPAIR
from kfmaps.matching.result import SHAPE_FIELDS, Match

_T = TypeVar("_T")

DEEPEST = 50
"""Levels of a JSON text; a summary has five."""
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


def parse_summary(text: str, name: str) -> JsonObject:
    """Return the dictionary in the JSON ``text`` of a summary; empty for an empty text."""
    try:
        values = json.loads(text) if text else {}
        level, depth = [values], 0
        while level and depth <= DEEPEST:
            below = [v for v in level if isinstance(v, dict | list)]
            level = [x for v in below for x in (v.values() if isinstance(v, dict) else v)]
            depth += 1
    except (ValueError, RecursionError) as error:
        raise refuse(name, "a summary as JSON", f"{len(text)} letters of something else", REPAIR) from error
    if depth > DEEPEST:
        raise refuse(name, f"JSON of at most {DEEPEST} levels", "more", REPAIR)
    if not isinstance(values, dict):
        raise refuse(name, "the fields of a match as JSON", type(values).__name__, REPAIR)
    return values


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


@lru_cache(maxsize=16)
def _hints(cls: type) -> Mapping[str, Any]:
    return get_type_hints(cls)


def _options(hint: object) -> tuple[object, ...]:
    """The types of a union, or the one type."""
    return (hint,) if get_origin(hint) in (None, tuple, dict, Literal) else get_args(hint)


def read_record(
    cls: type[_T], values: object, name: str, arrays: Mapping[str, Array] | None = None, path: str = ""
) -> _T:
    """Return a record of plain ``values`` and of ``arrays`` by field; what neither has is as by default.

    ``name`` is the file's, ``path`` leads to the record in it, such as "fit.".
    """
    arrays = arrays or {}
    if not isinstance(values, Mapping):
        raise refuse(f"{name}: {path[:-1]}", "a dictionary", repr(values)[:60], REPAIR)
    found: JsonObject = {}
    for f in fields(cls):  # pyright: ignore[reportArgumentType]
        label, hint = path + f.name, _hints(cls)[f.name]
        record = next((one for one in _options(hint) if is_dataclass(one)), None)
        if label in arrays:
            found[f.name] = arrays[label]
        elif record is Config:
            found[f.name] = _config(values.get(f.name))
        elif isinstance(record, type) and label not in _ELSEWHERE:
            inside = values.get(f.name)
            if inside is not None or any(one.startswith(f"{label}.") for one in arrays):
                found[f.name] = read_record(record, inside or {}, name, arrays, f"{label}.")
            elif NoneType in _options(hint):
                found[f.name] = None
        elif f.name in values and label not in _ELSEWHERE:
            found[f.name] = _read_value(hint, values[f.name], f"{name}: {label}")
        elif f.default is MISSING and f.default_factory is MISSING:
            raise refuse(f"{name}: {label}", "a value", "none", REPAIR)
    return cls(**found)


def _read_value(hint: object, value: Any, label: str) -> Any:
    """``value`` as one of the types of ``hint``; a number that was not finite is NaN."""
    if value is None and NoneType in _options(hint):
        return None
    for kind in _options(hint):
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
    raise refuse(label, str(hint), repr(value)[:60], REPAIR)


def _config(values: JsonObject | None) -> Config | None:
    """The configuration of plain values; ``None`` where they name what only the user's own code has."""
    try:
        return None if values is None else from_dict(values)
    except InvalidInput:
        return None
