"""Arrays as JSON for the pages: base64 of little-endian integers, which a browser reads in one step."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

_UNSIGNED = (("uint8", "<u1"), ("uint16", "<u2"), ("uint32", "<u4"))


def _record(array: np.ndarray, name: str, code: str) -> dict[str, Any]:
    raw = np.ascontiguousarray(array, dtype=code).tobytes()
    return {"type": name, "shape": list(array.shape), "base64": base64.b64encode(raw).decode("ascii")}


def encode_integers(numbers: np.ndarray) -> dict[str, Any]:
    """Encode whole numbers from 0 up, in the smallest of one, two or four bytes each that holds them all."""
    numbers = np.asarray(numbers)
    largest = int(numbers.max(initial=0))
    name, code = next((n, c) for n, c in _UNSIGNED if largest <= np.iinfo(c).max)
    return _record(numbers, name, code)


def encode_floats(values: np.ndarray) -> dict[str, Any]:
    """Encode real numbers as two-byte steps between their least and greatest, off by 1/131068 of that range at most.

    NaN and infinities become one reserved code, which the page reads as "not known".
    """
    values = np.asarray(values, dtype=np.float64)
    known = np.isfinite(values)
    low = float(values[known].min(initial=np.inf)) if known.any() else 0.0
    high = float(values[known].max(initial=-np.inf)) if known.any() else 0.0
    step = (high - low) / 65534 or 1.0
    codes = np.full(values.shape, 65535, dtype=np.uint16)
    codes[known] = np.rint((values[known] - low) / step).astype(np.uint16)
    return {**_record(codes, "uint16", "<u2"), "low": low, "step": step}


def to_json(value: Any) -> Any:
    """Return ``value`` with NumPy's numbers and arrays, tuples and non-finite floats turned into what JSON has.

    NaN and infinities become the strings ``"nan"``, ``"inf"`` and ``"-inf"``; anything unknown, its ``str``.
    """
    if isinstance(value, Mapping):
        return {str(k): to_json(v) for k, v in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return to_json(value.tolist())
    if isinstance(value, list | tuple | set | frozenset):
        return [to_json(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)


def json_block(data: Any) -> str:
    """Return JSON that is safe between ``<script>`` tags: no ``<``, ``>`` or ``&`` is left in it.

    A mesh called ``</script><script>`` is then only a name: those characters stand inside JSON strings alone,
    where their escaped form means the same.
    """
    text = json.dumps(to_json(data), ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
