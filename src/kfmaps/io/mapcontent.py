"""The content of a map file: the arrays of a match, each checked, and a summary of plain values for JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from types import NoneType
from typing import Any, Literal, TypeVar, get_args, get_origin

import numpy as np

import kfmaps
from kfmaps._arrays import Array, InvalidInput, check, refuse
from kfmaps._records import JsonObject, settings_of, types_of
from kfmaps.config import Config, as_dict, from_dict
from kfmaps.io.text import REPAIR
from kfmaps.matching.result import SHAPE_FIELDS, Match

_T = TypeVar("_T")

Size = int | str | None
"""Length of an axis: a number, the name of a length that arrays share ("s" and "t": vertices), or ``None`` for any."""

_NUMBERED = {"s": "source vertices", "t": "target vertices", "f": "faces"}


@dataclass(frozen=True)
class _MapArray:
    """One array of a map file."""

    field: str  # the field of :class:`kfmaps.Match` that it holds, with a dot before a field of a group
    shape: tuple[Size, ...]
    # What it numbers: a letter of ``_NUMBERED`` for each column; a .mat file counts from 1. Empty for real numbers.
    of: str = ""
    missing: bool = False  # whether −1 may stand for a vertex without counterpart, or NaN for an unknown number
    high: float = np.inf  # greatest value of numbers that are at least 0; infinite where they are not bounded

    def check(self, value: object, name: str, sizes: dict[str, int | None]) -> np.ndarray:
        """Return ``value`` as int64 or float64 where it fits the field, and add its lengths to ``sizes``."""
        shape = tuple(sizes.get(size) if isinstance(size, str) else size for size in self.shape)
        array = check(real(value, name), name, shape=shape, finite=bool(self.of) or not self.missing, remedy=REPAIR)
        sizes |= {size: n for size, n in zip(self.shape, array.shape, strict=True) if isinstance(size, str)}
        if self.of:
            columns = array.T if len(self.of) > 1 else [array]
            checked = zip(columns, self.of, strict=True)
            numbers = [
                _vertex_numbers(column, name, sizes.get(letter), self.missing, _NUMBERED[letter])
                for column, letter in checked
            ]
            return np.stack(numbers, axis=1) if len(numbers) > 1 else numbers[0]
        if np.isinf(array).any():
            raise refuse(name, "numbers, NaN where one is not known", "infinite ones", REPAIR)
        if self.high < np.inf and array.size and (array.min() < 0 or array.max() > self.high):
            raise refuse(name, f"numbers from 0 to {self.high:g}", f"{array.min():g} to {array.max():g}", REPAIR)
        return array.astype(np.float64)


ARRAYS = {
    "target_to_source": _MapArray("target_to_source", ("t",), "s", missing=True),
    "functional_map": _MapArray("functional_map", ("k_t", "k_s")),
    "eigenvalues_source": _MapArray("eigenvalues_source", ("k_s",)),
    "eigenvalues_target": _MapArray("eigenvalues_target", ("k_t",)),
    "local_confidence": _MapArray("local_confidence", ("t",), missing=True),
    "alternatives": _MapArray("alternatives", (None, "t"), "s"),
    "landmarks": _MapArray("landmarks", (None, 2), "st"),
    "precise_faces": _MapArray("precise_map.faces", ("t",), "f"),
    "precise_weights": _MapArray("precise_map.weights", ("t", 3), high=1 + 1e-6),
    "source_to_target": _MapArray("source_to_target", ("s",), "t"),
    "functional_map_back": _MapArray("functional_map_back", (None, None)),
    "registered_vertices": _MapArray("registration.registered_vertices", ("s", 3)),
    "overlap_source": _MapArray("partial.overlap_source", ("s",), high=1),
    "overlap_target": _MapArray("partial.overlap_target", ("t",), high=1),
    "raw_functional_map": _MapArray("fit.raw_functional_map", (None, None)),
    "raw_target_to_source": _MapArray("fit.raw_target_to_source", ("t",), "s"),
}
"""The arrays of a map file by name; all but the first may be left out."""

OLD_NAMES = {"config", "eigenvalues_s", "eigenvalues_t", "n_s", "runners_up", "place_faces", "bent", "map_back"}
"""Names that only files of older versions have; those files are refused."""

_NOT_IN_SUMMARY = {*(array.field for array in ARRAYS.values()), *SHAPE_FIELDS, "_reindexing"}
"""Fields of a match that are not in its summary."""


def real(value: object, name: str) -> np.ndarray:
    """Return ``value`` as an array where it holds real numbers or truth values."""
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise refuse(name, "an array of numbers", f"dtype {array.dtype}", REPAIR)
    return array


def check_map(
    target_to_source: object,
    n_s: int | None = None,
    n_t: int | None = None,
    name: str = "map",
    *,
    partial: bool = False,
) -> np.ndarray:
    """Return a map as (n_t,) int64 where it has a source vertex for every target vertex.

    ``target_to_source``: an array or a Match; ``n_s`` and ``n_t``: numbers of vertices of the source and target, when
    known; ``name``: of the map in messages; ``partial``: whether −1 may stand for a vertex without counterpart.

    Raises
    ------
    InvalidInput
        On another length or shape, fractions, and numbers out of range.
    """
    remedy = "check that the map belongs to these two meshes, in this order"
    numbers = real(getattr(target_to_source, "target_to_source", target_to_source), name)
    check(numbers, name, shape=(n_t,), remedy=remedy)
    if len(numbers) == 0:
        raise refuse(name, "a whole number for each target vertex", "none", REPAIR)
    if not partial and numbers.min() == -1:
        expected, got = "a counterpart of every target vertex", f"{np.count_nonzero(numbers == -1)} without one"
        raise refuse(name, expected, got, "this needs a map between whole shapes")
    return _vertex_numbers(numbers, name, n_s, partial, remedy=remedy)


def check_arrays(content: Mapping[str, Array], n_s: int | None, name: str) -> dict[str, Array]:
    """Return the arrays of a map file by the field of a match that each one holds.

    ``content``: of the file, by name; unknown names are left out; ``n_s``: number of vertices of the source, where it
    is known; ``name``: of the file in messages.
    """
    sizes: dict[str, int | None] = {"s": n_s}
    present = [(key, kind) for key, kind in ARRAYS.items() if key in content]
    arrays: dict[str, Array] = {kind.field: kind.check(content[key], f"{name}: {key}", sizes) for key, kind in present}
    if len(arrays["target_to_source"]) == 0:
        raise refuse(f"{name}: target_to_source", "a whole number for each target vertex", "none", REPAIR)
    if "alternatives" in arrays:
        arrays["alternatives"] = tuple(arrays["alternatives"])
    weights = arrays.get("precise_map.weights")
    if weights is not None and np.abs(weights.sum(axis=1) - 1).max() > 1e-6:
        raise refuse(f"{name}: precise_weights", "numbers with sum 1 in each row", "others", REPAIR)
    return arrays


def _vertex_numbers(
    numbers: np.ndarray, name: str, n: int | None, partial: bool, what: str = "source vertices", remedy: str = REPAIR
) -> np.ndarray:
    """Return ``numbers`` as int64 where they are from 0 (−1 where ``partial``) to ``n - 1``; ``None`` is no limit."""
    if numbers.dtype.kind == "f" and not (numbers == np.rint(numbers)).all():
        raise refuse(name, "a whole number for each vertex", "fractions", remedy)
    low, high = (numbers.min(), numbers.max()) if numbers.size else (0, 0)
    if low < -int(partial) or high >= (2**53 if n is None else n):
        expected = f"{what} from 0 on" if n is None else f"{what} from 0 to {n - 1}"
        raise refuse(name, expected, f"{int(low if low < -int(partial) else high)}", remedy)
    return numbers.astype(np.int64)


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
    """Return the mean of ``local_confidence`` over the target's vertices; ``None`` where there is none."""
    values = getattr(match, "local_confidence", np.zeros(0))
    values = values[np.isfinite(values)]
    return float(values.mean()) if len(values) else None


def plain_record(record: Any, arrays: dict[str, np.ndarray] | None = None, path: str = "") -> JsonObject:
    """Return the fields of a record as plain values for JSON, without those that are arrays of a map file.

    Where ``arrays`` is given, arrays are put into it, under dotted names, as :func:`read_record` takes them.
    """
    names = [f for f in fields(type(record)) if path + f.name not in _NOT_IN_SUMMARY and f.name != "precise_map"]
    return {f.name: _plain(getattr(record, f.name, None), f"{path}{f.name}", arrays) for f in names}


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
    """Return a record made of plain ``values`` and of ``arrays`` by field; fields in neither have their defaults.

    ``name``: of the file; ``path``: of the record in the file, such as "fit.".
    """
    arrays = arrays or {}
    if not isinstance(values, Mapping):
        raise refuse(f"{name}: {path[:-1] or 'summary'}", "the fields of a record", repr(values)[:60], REPAIR)
    arguments: JsonObject = {}
    for setting in settings_of(cls).values():
        label, value = path + setting.name, values.get(setting.name)
        record = next((kind for kind in setting.types if is_dataclass(kind)), None)
        if label in arrays:
            arguments[setting.name] = arrays[label]
        elif record is Config:
            arguments[setting.name] = _config(value)
        elif isinstance(record, type) and label not in _NOT_IN_SUMMARY:
            if value is not None or any(key.startswith(f"{label}.") for key in arrays):
                arguments[setting.name] = read_record(record, value or {}, name, arrays, f"{label}.")
            elif setting.optional:
                arguments[setting.name] = None
        elif setting.name in values and label not in _NOT_IN_SUMMARY:
            arguments[setting.name] = _read_value(setting.hint, value, f"{name}: {label}")
        elif setting.default is MISSING:
            raise refuse(f"{name}: {label}", "a value", "none", REPAIR)
    return cls(**arguments)


def _read_value(hint: object, value: Any, label: str) -> Any:
    """Return ``value`` as one of the types of ``hint``; a number that was not finite is NaN."""
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
    """Return the configuration of plain values; ``None`` where they name objects of the user's own code."""
    try:
        return None if values is None else from_dict(values)
    except InvalidInput:
        return None
