"""What a map file holds of a match: arrays, each checked for its field, and a summary, plain values for JSON."""

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
"""Length of an axis: a number, the name of a length that arrays share ("s" and "t": vertices), or any."""

_NUMBERED = {"s": "source vertices", "t": "target vertices", "f": "faces"}


@dataclass(frozen=True)
class _MapArray:
    """One array of a map file."""

    field: str  # the field of :class:`kfmaps.Match` that it holds; a dot leads into a group of fields
    shape: tuple[Size, ...]
    # Whose numbers it holds, one letter of ``_NUMBERED`` a column; a .mat file counts them from 1. Empty for others.
    of: str = ""
    missing: bool = False  # whether −1 may stand for a vertex without counterpart, or NaN for an unknown number
    high: float = np.inf  # greatest value of numbers that are at least 0; infinite where they are not bounded

    def check(self, value: object, name: str, sizes: dict[str, int | None]) -> np.ndarray:
        """Return ``value`` as int64 or float64 where it is what the field wants, and add its lengths to ``sizes``."""
        shape = tuple(sizes.get(size) if isinstance(size, str) else size for size in self.shape)
        array = check(real(value, name), name, shape=shape, finite=bool(self.of) or not self.missing, remedy=REPAIR)
        sizes |= {size: n for size, n in zip(self.shape, array.shape, strict=True) if isinstance(size, str)}
        if self.of:
            columns = array.T if len(self.of) > 1 else [array]
            checked = zip(columns, self.of, strict=True)
            numbers = [_vertex_numbers(one, name, sizes.get(of), self.missing, _NUMBERED[of]) for one, of in checked]
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

OLDER = {"config", "eigenvalues_s", "eigenvalues_t", "n_s", "runners_up", "place_faces", "bent", "map_back"}
"""Names in files of older versions, which are refused."""

_ELSEWHERE = {*(array.field for array in ARRAYS.values()), *SHAPE_FIELDS, "_reindexing"}
"""Fields of a match that its summary does not hold."""


def real(value: object, name: str) -> np.ndarray:
    """Return ``value`` as an array where it holds real numbers or truth values."""
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise refuse(name, "an array of numbers", f"dtype {array.dtype}", REPAIR)
    return array


def check_map(
    target_to_source: object, n_s: int | None = None, n_t: int | None = None, name: str = "map", *, lost: bool = False
) -> np.ndarray:
    """Return ``target_to_source`` as (n_t,) int64 where it names a source vertex for every target vertex.

    ``target_to_source``: an array or a Match; ``n_s`` and ``n_t``: numbers of vertices of the source and target, when
    known; ``name``: how messages call it; ``lost``: whether −1 may stand for a vertex without counterpart.

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
    if not lost and numbers.min() == -1:
        wanted, got = "a counterpart of every target vertex", f"{np.count_nonzero(numbers == -1)} without one"
        raise refuse(name, wanted, got, "this needs a map between whole shapes")
    return _vertex_numbers(numbers, name, n_s, lost, remedy=remedy)


def check_arrays(content: Mapping[str, Array], n_s: int | None, name: str) -> dict[str, Array]:
    """Return the arrays of a map file, ``content``, by the field of a match that each one holds.

    ``content``: names that no map file has are left out; ``n_s``: number of vertices of the source, where it is known;
    ``name``: the file, for messages.
    """
    sizes: dict[str, int | None] = {"s": n_s}
    known = [(key, kind) for key, kind in ARRAYS.items() if key in content]
    found: dict[str, Array] = {kind.field: kind.check(content[key], f"{name}: {key}", sizes) for key, kind in known}
    if len(found["target_to_source"]) == 0:
        raise refuse(f"{name}: target_to_source", "a whole number for each target vertex", "none", REPAIR)
    if "alternatives" in found:
        found["alternatives"] = tuple(found["alternatives"])
    weights = found.get("precise_map.weights")
    if weights is not None and np.abs(weights.sum(axis=1) - 1).max() > 1e-6:
        raise refuse(f"{name}: precise_weights", "numbers with sum 1 in each row", "others", REPAIR)
    return found


def _vertex_numbers(
    numbers: np.ndarray, name: str, n: int | None, lost: bool, what: str = "source vertices", remedy: str = REPAIR
) -> np.ndarray:
    """``numbers`` as int64 where they are from 0 to ``n - 1``, or any where ``n`` is ``None``; −1 where ``lost``."""
    if numbers.dtype.kind == "f" and not (numbers == np.rint(numbers)).all():
        raise refuse(name, "a whole number for each vertex", "fractions", remedy)
    low, high = (numbers.min(), numbers.max()) if numbers.size else (0, 0)
    if low < -int(lost) or high >= (2**53 if n is None else n):
        wanted = f"{what} from 0 on" if n is None else f"{what} from 0 to {n - 1}"
        raise refuse(name, wanted, f"{int(low if low < -int(lost) else high)}", remedy)
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
