"""What the arrays and texts of a map file must be: one check, where a map comes in, so that none is needed after."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from kfmaps._arrays import check, refuse
from kfmaps.io.text import REPAIR

DEEPEST = 50
"""Levels of a JSON text; settings and summaries have five."""
LONGEST_PATH = 4096


def real(value: Any, name: str) -> np.ndarray:
    """``value`` as an array when it holds real numbers or truth values."""
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise refuse(name, "an array of numbers", f"dtype {array.dtype}", REPAIR)
    return array


def vertex_numbers(value: Any, name: str, n: int | None) -> np.ndarray:
    """``value`` as int64 when it holds numbers of vertices of a shape of ``n``, or of any where that is not known."""
    numbers = check(real(value, name), name, remedy=REPAIR)
    if numbers.dtype.kind == "f" and (numbers != np.rint(numbers)).any():
        raise refuse(name, "whole numbers of vertices", "fractions", REPAIR)
    low, high = (numbers.min(), numbers.max()) if numbers.size else (0, 0)
    if low < 0 or high >= (2**53 if n is None else n):
        wanted = "vertex numbers from 0 on" if n is None else f"vertex numbers from 0 to {n - 1}"
        raise refuse(name, wanted, f"{int(low if low < 0 else high)}", REPAIR)
    return numbers.astype(np.int64)


def checked_extra(extra: Mapping[str, Any], n_t: int, n_s: int | None) -> dict[str, Any]:
    """The further arrays and texts of a map, those with a known name in the kind and shape that their name says.

    Raises
    ------
    InvalidInput
        Naming the first that is another.
    """
    found: dict[str, Any] = {}
    for name, value in extra.items():
        title = f"extra {name}"
        match name:
            case "raw_target_to_source":
                found[name] = vertex_numbers(check(real(value, title), title, shape=(n_t,), remedy=REPAIR), title, n_s)
            case "source_to_target":
                found[name] = vertex_numbers(check(real(value, title), title, shape=(n_s,), remedy=REPAIR), title, n_t)
            case "runners_up":
                rows = real(value, title)
                rows = rows[None] if rows.ndim == 1 else rows  # a .mat file does not tell one row from a list
                found[name] = vertex_numbers(check(rows, title, shape=(None, n_t), remedy=REPAIR), title, n_s)
            case "landmarks":
                pairs = check(real(value, title), title, shape=(None, 2), remedy=REPAIR)
                sides = [vertex_numbers(pairs[:, i], title, n) for i, n in enumerate((n_s, n_t))]
                found[name] = np.stack(sides, axis=1)
            case "confidence":
                if real(value, title).size != 1 or not np.isfinite(np.asarray(value)).all():
                    raise refuse(title, "one number", f"shape {np.shape(value)}", REPAIR)
                found[name] = np.float64(np.asarray(value).item())
            case "overlap_source" | "overlap_target":
                n = n_s if name == "overlap_source" else n_t
                values = check(real(value, title), title, shape=(n,), remedy=REPAIR).astype(np.float64)
                if len(values) and (values.min() < 0 or values.max() > 1):
                    raise refuse(title, "probabilities", f"{values.min():g} to {values.max():g}", REPAIR)
                found[name] = values
            case "local_confidence":
                values = check(real(value, title), title, shape=(n_t,), finite=False, remedy=REPAIR).astype(np.float64)
                if np.isinf(values).any():
                    raise refuse(title, "numbers, NaN where it is not known", "infinite ones", REPAIR)
                found[name] = values
            case "raw_functional_map" | "map_back":
                found[name] = check(real(value, title), title, shape=(None, None), remedy=REPAIR).astype(np.float64)
            case "place_faces":
                found[name] = vertex_numbers(check(real(value, title), title, shape=(n_t,), remedy=REPAIR), title, None)
            case "place_weights":
                weights = check(real(value, title), title, shape=(n_t, 3), remedy=REPAIR).astype(np.float64)
                if len(weights) and (weights.min() < 0 or np.abs(weights.sum(axis=1) - 1).max() > 1e-6):
                    raise refuse(title, "numbers of at least 0 with sum 1 in each row", "others", REPAIR)
                found[name] = weights
            case "bent":
                rows = check(real(value, title), title, shape=(n_s, 3), remedy=REPAIR)
                found[name] = rows.astype(np.float64)
            case "source_sha256" | "target_sha256":
                if not isinstance(value, str) or not re.fullmatch("[0-9a-f]{64}", value):
                    raise refuse(title, "64 hexadecimal digits", _kind(value), REPAIR)
                found[name] = value
            case "source" | "target":
                found[name] = _path(value, title)
            case "summary":
                found[name] = json_text(value, title)
            case _:
                found[name] = value if isinstance(value, str) else real(value, title)
    return found


def _path(value: Any, name: str) -> str:
    if not isinstance(value, str) or "\0" in value or len(value) > LONGEST_PATH:
        raise refuse(name, f"a path of at most {LONGEST_PATH} letters", _kind(value), REPAIR)
    return value


def json_text(value: Any, name: str) -> str:
    """``value`` when it is a text, and not one of JSON that is nested without end; another text is a note."""
    if not isinstance(value, str):
        raise refuse(name, "text", _kind(value), REPAIR)
    try:
        level, depth = [json.loads(value)], 0
    except RecursionError as error:
        raise refuse(name, f"JSON of at most {DEEPEST} levels", "more", REPAIR) from error
    except ValueError:
        return value
    while level:
        below = [v for v in level if isinstance(v, dict | list)]
        level = [x for v in below for x in (v.values() if isinstance(v, dict) else v)]
        depth += 1
        if depth > DEEPEST:
            raise refuse(name, f"JSON of at most {DEEPEST} levels", "more", REPAIR)
    return value


def _kind(value: Any) -> str:
    if isinstance(value, str):
        return "a text with a NUL" if "\0" in value else f"{len(value)} letters"
    return f"an array of {np.asarray(value).dtype}"
