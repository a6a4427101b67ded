"""Nested frozen records as plain dictionaries and back: one walk, led by the records' own type hints.

A field may hold a plain value, one record, or one of several records (a union); the last is written with its ``kind``,
the record's name. New records therefore need no entry anywhere but in the union that they belong to.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass, replace
from types import NoneType
from typing import Any, Literal, get_args, get_origin, get_type_hints

from kfmaps._arrays import refuse

NOTHING = ("none", "all", "automatic")
"""Words for ``None``, which TOML cannot say."""

NAMES = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}


@dataclass(frozen=True)
class Place:
    """Where in the tree the walk is.

    Attributes
    ----------
    label : str
        With dots; "" at the top.
    current, fresh : Any
        What stands there now, and what is recommended there; ``None`` where nothing is.
    """

    label: str
    current: Any
    fresh: Any

    def inside(self, name: str) -> Place:
        label = f"{self.label}.{name}" if self.label else name
        return Place(label, getattr(self.current, name, None), getattr(self.fresh, name, None))


Unions = Mapping[Any, tuple[type, ...]]
"""The records behind hints that do not list them themselves, such as a protocol."""


def as_dict(value: Any, kinds: Mapping[str, type], name: Any = repr) -> Any:
    """``value`` with every record in it as a dictionary of plain values, fit for JSON and TOML.

    Records among ``kinds`` carry theirs under ``kind``. A callable becomes ``{"kind": "callable", "name": …}``, which
    :func:`updated` refuses.
    """
    if is_dataclass(value) and not isinstance(value, type):
        inside = {f.name: as_dict(getattr(value, f.name), kinds, name) for f in fields(value)}
        kind = type(value).__name__
        return {"kind": kind, **inside} if kind in kinds else inside
    if callable(value):
        return {"kind": "callable", "name": name(value)}
    return value


def updated(record: Any, values: Mapping[str, Any], fresh: Any, unions: Unions) -> Any:
    """``record`` with what ``values`` names replaced; strict on names and types.

    Kinds may be written in any case, a record may be named by its kind alone (``kernel = "laplacian"``), and
    ``"none"``, ``"all"`` and ``"automatic"`` stand for ``None`` where there can be none. A record of another kind than
    the one in ``record`` begins with what ``fresh`` has there when it is of that kind, and else with its own defaults.

    Raises
    ------
    InvalidInput
        On names that do not exist and values of the wrong type or out of range.
    """
    return _changed(type(record), values, Place("", record, fresh), unions)


def _changed(kind: type, values: Mapping[str, Any], place: Place, unions: Unions) -> Any:
    """A record of ``kind`` with ``values``, the rest as it is at ``place``."""
    hints, names = get_type_hints(kind), [f.name for f in fields(kind)]
    changes = {}
    for name, value in values.items():
        if name not in names:
            wanted = f"one of {', '.join(names)}" if names else "no setting"
            raise refuse(place.label or "settings", wanted, repr(name), "check the spelling")
        changes[name] = _value(value, hints[name], place.inside(name), unions)
    if place.current is not None:
        return replace(place.current, **changes)
    for f in fields(kind):
        if f.name not in changes and f.default is MISSING and f.default_factory is MISSING:
            wanted = "a kernel" if hints[f.name] in unions else _wanted(hints[f.name])
            raise refuse(f"{place.label}.{f.name}", wanted, "none", f"{kind.__name__.lower()} cannot do without")
    return kind(**changes)


def _value(value: Any, hint: Any, place: Place, unions: Unions) -> Any:
    if isinstance(hint, type) and is_dataclass(hint):
        return _changed(hint, _table(value, place.label), place, unions)
    if any(get_origin(option) is tuple for option in (hint, *get_args(hint))):
        return _tuple(value, place.label)
    options: tuple[Any, ...] = unions.get(hint) or get_args(hint) or (hint,)
    if value is None or (NoneType in options and isinstance(value, str) and value.lower() in NOTHING):
        if NoneType not in options:
            raise refuse(place.label, _wanted(hint), "none", "give one")
        return None
    if any(is_dataclass(option) for option in options):
        return _one_of(value, options, place, unions)
    if get_origin(hint) is Literal:
        if value not in options:
            raise refuse(place.label, "one of " + ", ".join(options), repr(value), "choose one of them")
        return value
    plain = next(option for option in options if option is not NoneType)
    if plain is float and type(value) is int:
        value = float(value)
    if type(value) is not plain or (isinstance(value, float) and not math.isfinite(value)):
        raise refuse(place.label, _wanted(hint), repr(value), "compare with `kfmaps config`")
    return value


def _tuple(value: Any, label: str, depth: int = 0) -> tuple[Any, ...]:
    """Nested lists of numbers as tuples; how many there must be is for their record to say."""
    if not isinstance(value, list | tuple) or depth > 3:
        raise refuse(label, "a list of numbers, or of lists of them", repr(value)[:60], "write [1.0, 2.0]")
    items = [_tuple(item, label, depth + 1) if isinstance(item, list | tuple) else item for item in value]
    if any(not isinstance(item, tuple) and type(item) not in (int, float) for item in items):
        raise refuse(label, "a list of numbers, or of lists of them", repr(value)[:60], "write [1.0, 2.0]")
    return tuple(items)


def _one_of(value: Any, options: tuple[Any, ...], place: Place, unions: Unions) -> Any:
    """A record of one of several kinds."""
    table = _table({"kind": value} if isinstance(value, str) else value, place.label)
    kinds = {option.__name__.lower(): option for option in options if option is not NoneType}
    present = type(place.current).__name__.lower()
    named = table.get("kind", present if present in kinds or len(kinds) > 1 else next(iter(kinds)))
    if NoneType in options and named == "none" and len(table) == 1:
        return None
    if not isinstance(named, str) or named.lower() not in kinds:
        got = "none" if named == "nonetype" else repr(named)
        raise refuse(f"{place.label}.kind", "one of " + ", ".join(kinds), got, "choose one of them")
    kind = kinds[named.lower()]
    begin = next((record for record in (place.current, place.fresh) if type(record) is kind), None)
    inside = {name: entry for name, entry in table.items() if name != "kind"}
    return _changed(kind, inside, replace(place, current=begin), unions)


def _table(value: Any, label: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise refuse(label, "a table of settings", repr(value), f"write [{label}] and one setting a line")
    return value


def _wanted(hint: Any) -> str:
    return " or ".join(NAMES.get(option, "none") for option in get_args(hint) or (hint,))
