"""Checks, errors and the array namespace: the ground floor, importing nothing of the package."""

from __future__ import annotations

from typing import Any

import numpy as np
from array_api_compat import array_namespace, is_numpy_namespace, is_torch_namespace

Array = Any
"""An array of any library that follows the array-API standard (NumPy, PyTorch, array-api-strict)."""


class InvalidInput(ValueError):
    """The caller handed in something that cannot be used; the message says what to do."""


class NotConverged(RuntimeError):
    """A numerical method stopped before it reached the accuracy that was asked for."""


class MissingDependency(ImportError):
    """An optional package or system part is missing; the message says how to get it."""


class KfmapsWarning(UserWarning):
    """Something unusual that still gives a correct answer."""


def refuse(name: str, expected: str, got: str, remedy: str) -> InvalidInput:
    """Return the error "`name`: expected …, got …. Do ….", the one form of every refusal.

    Parameters
    ----------
    name : str
        The argument, option or file.
    expected, got : str
        Noun phrases.
    remedy : str
        One or more sentences about what to do; the first letter and the last full stop are put right.
    """
    problem = f"{name}: expected {expected}, got {got}"
    return InvalidInput(shown(f"{_sentence(problem, '')} {_sentence(remedy, remedy[:1].upper())}"))


def _sentence(text: str, first: str) -> str:
    """Return ``text`` with a full stop, unless it ends with a mark already, and with another first letter."""
    return (first or text[:1]) + text[1:] + ("" if text.endswith((".", "?", "!")) else ".")


def shown(text: str) -> str:
    """``text`` fit for a terminal: control characters, and all else that cannot be printed, by their codes.

    A file may be called anything; its name must not move the cursor, change colours or run together with the next.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def namespace(*arrays: Array) -> Any:
    """The array-API namespace that all ``arrays`` share."""
    return array_namespace(*arrays)


def is_numpy(*arrays: Array) -> bool:
    """Whether ``arrays`` are NumPy's."""
    return is_numpy_namespace(array_namespace(*arrays))


def is_torch(*arrays: Array) -> bool:
    """Whether ``arrays`` are PyTorch tensors."""
    return is_torch_namespace(array_namespace(*arrays))


def like(values: Array, reference: Array) -> Array:
    """``values`` as a floating array of ``reference``'s library, dtype and device."""
    xp = array_namespace(reference)
    return xp.asarray(values, dtype=reference.dtype, device=reference.device)


def to_numpy(array: Array) -> np.ndarray:
    """A NumPy copy or view of ``array``, wherever it lives."""
    if isinstance(array, np.ndarray):
        return array
    if is_torch(array):
        return array.detach().cpu().numpy()
    return np.from_dlpack(array)


def take(array: Array, indices: np.ndarray, axis: int = 0) -> Array:
    """Rows (or columns, ``axis=1``) of ``array`` by NumPy ``indices``, on whatever device it lives."""
    xp = array_namespace(array)
    where = xp.asarray(np.ascontiguousarray(indices, dtype=np.int64), device=array.device)
    return xp.take(array, where, axis=axis)


def seed_of(rng: int | np.random.Generator | None) -> int:
    """The seed that ``rng`` is, or one that is drawn from it; ``None`` draws one at random."""
    if rng is None or isinstance(rng, np.random.Generator):
        return int(np.random.default_rng(rng).integers(2**31))
    return int(rng)


def blocks(n: int, size: int) -> list[slice]:
    """Slices that cut ``n`` rows into runs of ``size``, the last one shorter."""
    return [slice(a, min(a + size, n)) for a in range(0, n, size)]


def inner(x: Array, y: Array) -> float:
    """Sum of elementwise products, as a Python number."""
    return number(array_namespace(x, y).sum(x * y))


def number(x: Array) -> float:
    """A Python number of an array with one value, without what PyTorch knows of its derivatives."""
    return float(x.detach() if is_torch(x) else x)


def check(
    array: Array,
    name: str,
    *,
    shape: tuple[int | None, ...] | None = None,
    finite: bool = True,
    remedy: str = "check how it was made",
) -> Array:
    """Return ``array`` when it has the ``shape`` (``None`` matches any length) and only finite numbers.

    Raises
    ------
    InvalidInput
        Naming the array, what was expected, what was got and ``remedy``.
    """
    if shape is not None:
        fits = len(array.shape) == len(shape) and all(
            want is None or want == have for want, have in zip(shape, array.shape, strict=True)
        )
        if not fits:
            wanted = "(" + ", ".join("any" if s is None else str(s) for s in shape) + ")"
            raise refuse(name, f"shape {wanted}", f"shape {tuple(array.shape)}", remedy)
    if finite:
        xp = array_namespace(array)
        if xp.isdtype(array.dtype, "real floating"):
            fine = xp.isfinite(array)
            if not bool(xp.all(fine)):
                bad = int(xp.sum(xp.astype(~fine, xp.int64)))
                raise refuse(name, "finite numbers", f"{bad} NaN or infinite values", remedy)
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
