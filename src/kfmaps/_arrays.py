"""The array namespace, conversions of arrays, and checks of arguments."""

from __future__ import annotations

from typing import Any

import numpy as np
from array_api_compat import array_namespace, is_numpy_namespace, is_torch_namespace

from kfmaps._errors import InvalidInput as InvalidInput
from kfmaps._errors import KfmapsWarning as KfmapsWarning
from kfmaps._errors import MissingDependency as MissingDependency
from kfmaps._errors import NotConverged as NotConverged
from kfmaps._errors import printable as printable
from kfmaps._errors import refuse as refuse

Array = Any
"""An array of any library that follows the array-API standard (NumPy, PyTorch, array-api-strict)."""


def namespace(*arrays: Array) -> Any:
    """Return the array-API namespace that all ``arrays`` share."""
    return array_namespace(*arrays)


def is_numpy(*arrays: Array) -> bool:
    """Return whether ``arrays`` are NumPy arrays."""
    return is_numpy_namespace(array_namespace(*arrays))


def _is_torch(*arrays: Array) -> bool:
    """Return whether ``arrays`` are PyTorch tensors."""
    return is_torch_namespace(array_namespace(*arrays))


def like(values: Array, reference: Array) -> Array:
    """Return ``values`` as a floating array of ``reference``'s library, dtype and device."""
    xp = array_namespace(reference)
    return xp.asarray(values, dtype=reference.dtype, device=reference.device)


def to_numpy(array: Array) -> np.ndarray:
    """Return a NumPy copy or view of ``array``, from any device."""
    if isinstance(array, np.ndarray):
        return array
    if _is_torch(array):
        return array.detach().cpu().numpy()
    return np.from_dlpack(array)


def take(array: Array, indices: np.ndarray, axis: int = 0) -> Array:
    """Return rows (or columns, ``axis=1``) of ``array`` by NumPy ``indices``, on any device."""
    if isinstance(array, np.ndarray) and axis == 0 and 3 * len(indices) < len(array):
        return array[indices]  # ndarray.take would first copy all of a column-major array
    xp = array_namespace(array)
    rows = xp.asarray(np.ascontiguousarray(indices, dtype=np.int64), device=array.device)
    return xp.take(array, rows, axis=axis)


def seed_of(rng: int | np.random.Generator | None) -> int:
    """Return ``rng`` itself where it is a seed, else a seed drawn from it; ``None`` draws one at random."""
    if rng is None or isinstance(rng, np.random.Generator):
        return int(np.random.default_rng(rng).integers(2**31))
    return int(rng)


def blocks(n: int, size: int) -> list[slice]:
    """Return slices that divide ``n`` rows into blocks of ``size``; the last may be shorter."""
    return [slice(a, min(a + size, n)) for a in range(0, n, size)]


def index_ranges(starts: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Return the numbers starts[i], ..., starts[i] + sizes[i] - 1 of every i, one range after another."""
    first = np.cumsum(sizes) - sizes
    return np.repeat(starts - first, sizes) + np.arange(int(sizes.sum()))


def inner(x: Array, y: Array) -> float:
    """Return the sum of elementwise products, as a Python number."""
    return number(array_namespace(x, y).sum(x * y))


def number(x: Array) -> float:
    """Return the one value of an array as a Python number, detached from PyTorch's graph."""
    return float(x.detach() if _is_torch(x) else x)


def check(
    array: Array,
    name: str,
    *,
    shape: tuple[int | None, ...] | None = None,
    finite: bool = True,
    remedy: str = "check how it was made",
) -> Array:
    """Return ``array`` where it has the ``shape`` (``None``: any length) and only finite numbers."""
    if shape is not None:
        has_shape = len(array.shape) == len(shape) and all(
            size is None or size == actual_size for size, actual_size in zip(shape, array.shape, strict=True)
        )
        if not has_shape:
            expected = "(" + ", ".join("any" if s is None else str(s) for s in shape) + ")"
            raise refuse(name, f"shape {expected}", f"shape {tuple(array.shape)}", remedy)
    if finite:
        xp = array_namespace(array)
        if xp.isdtype(array.dtype, "real floating"):
            is_finite = xp.isfinite(array)
            if not bool(xp.all(is_finite)):
                n_bad = int(xp.sum(xp.astype(~is_finite, xp.int64)))
                raise refuse(name, "finite numbers", f"{n_bad} NaN or infinite values", remedy)
    return array


def check_positive(value: float, name: str, remedy: str = "give a number above zero") -> float:
    """Return ``value`` when it is a finite number above zero, else raise :class:`InvalidInput`."""
    if not (np.isfinite(value) and value > 0):
        raise refuse(name, "a finite number above zero", repr(value), remedy)
    return value


def check_count(value: int, name: str, low: int = 1, high: int | None = None) -> int:
    """Return ``value`` when it is a whole number in [``low``, ``high``], else raise :class:`InvalidInput`."""
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or value < low or (high is not None and value > high):
        span = f"at least {low}" if high is None else f"from {low} to {high}"
        raise refuse(name, f"a whole number {span}", repr(value), "choose a number in that range")
    return int(value)
