"""Settings from files and the command line: their names and types checked before a ``Config`` is made of them."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass
from types import NoneType
from typing import Any, Literal, get_args, get_origin, get_type_hints

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.config import Config, as_dict, from_dict
from kfmaps.kernel.kernels import Gaussian, KernelLike, Laplacian, Linear, Polynomial, Product, Sum, Tanh

KERNELS = (Linear, Polynomial, Gaussian, Laplacian, Tanh, Sum, Product)

NOTHING = ("none", "all", "automatic")
"""Words for ``None``, which TOML cannot say."""

NAMES = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}


def configured(base: Config, values: dict[str, Any]) -> Config:
    """``base`` with the settings that ``values`` names, as :func:`kfmaps.config.from_dict` but strict on types.

    Kinds may be written in any case, a record may be named by its kind alone (``kernel = "laplacian"``), and
    ``"none"``, ``"all"`` and ``"automatic"`` stand for ``None`` where there can be none. A record of another kind
    than the one in ``base`` begins with the recommended numbers.

    Raises
    ------
    InvalidInput
        On names that do not exist and values of the wrong type or out of range.
    """
    return from_dict(_table(values, base, Config, ""), base)


def _table(values: dict[str, Any], current: Any, record: type, where: str) -> dict[str, Any]:
    """``values`` for the fields of ``record``, checked; ``current`` is the record they change, or ``None``."""
    hints = get_type_hints(record)
    names = [f.name for f in fields(record)]
    clean = {}
    for name, value in values.items():
        label = f"{where}.{name}" if where else name
        if name not in names:
            wanted = f"one of {', '.join(names)}" if names else "no setting"
            raise refuse(where or "settings", wanted, repr(name), "check the spelling")
        clean[name] = _value(value, getattr(current, name, None), hints[name], label)
    return clean


def _value(value: Any, current: Any, hint: Any, label: str) -> Any:
    if isinstance(hint, type) and is_dataclass(hint):
        if not isinstance(value, dict):
            raise refuse(label, "a table of settings", repr(value), f"write [{label}] and one setting a line")
        return _table(value, current, hint, label)
    options: tuple[Any, ...] = KERNELS if hint == KernelLike else get_args(hint) or (hint,)
    if value is None or (NoneType in options and isinstance(value, str) and value.lower() in NOTHING):
        if NoneType not in options:
            raise refuse(label, _wanted(hint), "none", "give one")
        return None
    if any(is_dataclass(option) for option in options):
        return _record(value, current, options, label)
    if get_origin(hint) is Literal:
        if value not in options:
            raise refuse(label, "one of " + ", ".join(options), repr(value), "choose one of them")
        return value
    plain = next(option for option in options if option is not NoneType)
    if plain is float and type(value) is int:
        value = float(value)
    if type(value) is not plain or (isinstance(value, float) and not math.isfinite(value)):
        raise refuse(label, _wanted(hint), repr(value), "compare with `kfmaps config`")
    return value


def _wanted(hint: Any) -> str:
    return " or ".join(NAMES.get(option, "none") for option in get_args(hint) or (hint,))


def _record(value: Any, current: Any, options: tuple[Any, ...], label: str) -> dict[str, Any] | None:
    """A table for one of several kinds of record, all its settings and its kind in it."""
    table = {"kind": value} if isinstance(value, str) else value
    if not isinstance(table, dict):
        raise refuse(label, "a table of settings", repr(value), f"write [{label}] and one setting a line")
    kinds = {option.__name__.lower(): option for option in options if option is not NoneType}
    present = type(current).__name__.lower()
    named = table.get("kind", present if present in kinds or len(kinds) > 1 else next(iter(kinds)))
    if NoneType in options and named == "none" and len(table) == 1:
        return None
    if not isinstance(named, str) or named.lower() not in kinds:
        got = "none" if named == "nonetype" else repr(named)
        raise refuse(f"{label}.kind", "one of " + ", ".join(kinds), got, "choose one of them")
    record = kinds[named.lower()]
    if type(current) is not record:
        current = getattr(Config(), label, None)  # the recommended numbers, when they are of this kind
    start = as_dict(current) if type(current) is record else {}
    clean = start | _table({k: v for k, v in table.items() if k != "kind"}, current, record, label)
    missing = next((name for name in ("a", "b") if record in (Sum, Product) and name not in clean), None)
    if missing:
        raise refuse(f"{label}.{missing}", "a kernel", "none", f"a {record.__name__.lower()} is made of two")
    return {**clean, "kind": record.__name__}


def nested(assignments: dict[str, Any]) -> dict[str, Any]:
    """``{"a.b": 1}`` as ``{"a": {"b": 1}}``."""
    tree: dict[str, Any] = {}
    for path, value in assignments.items():
        *above, last = path.split(".")
        branch: dict[str, Any] = tree
        for name in above:
            below: Any = branch.get(name)
            if isinstance(below, str):  # a kind
                below = {"kind": below}
            branch[name] = branch = below if isinstance(below, dict) else {}
        branch[last] = value
    return tree


def blamed(base: Config, given: dict[str, tuple[str, Any]]) -> Config:
    """``base`` with what is ``given``, by what the user calls it: ``{"--alpha": ("weights.laplacian", 2.0)}``.

    All of it is applied at once, since one value may only be right beside another. A complaint begins with the
    names of those that are at fault.
    """

    def applied(labels: list[str]) -> Config:
        return configured(base, nested(dict(given[label] for label in labels)))

    def works(labels: list[str]) -> bool:
        try:
            applied(labels)
        except InvalidInput:
            return False
        return True

    everything = list(given)
    try:
        return applied(everything)
    except InvalidInput as error:
        guilty = [label for label in everything if works([other for other in everything if other != label])]
        guilty = guilty or [label for label in everything if not works([label])]
        # A pair that contradicts each other is named whole; of several unrelated faults, the first.
        raise InvalidInput(f"{', '.join(guilty[:2])}: {error}" if guilty else str(error)) from error
