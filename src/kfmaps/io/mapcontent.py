"""The arrays of a map file: which field of a match each one holds, and what it must be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from kfmaps._arrays import Array, check, refuse
from kfmaps.io.text import REPAIR

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
