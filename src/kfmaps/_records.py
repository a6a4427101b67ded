"""Settings records: frozen dataclasses whose fields have documentation and bounds, and records as plain values.

A field may hold a plain value, one record, or one of several records. The last is written with its ``kind``, the name
of the record's class. Checks, settings files, the command's options and the manual use the same metadata.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sized
from dataclasses import MISSING, dataclass, field, fields, is_dataclass, replace
from functools import lru_cache
from inspect import cleandoc
from numbers import Integral, Real
from operator import ge, gt, le, lt
from textwrap import shorten
from types import NoneType, UnionType
from typing import Any, Literal, TypeVar, Union, cast, dataclass_transform, get_args, get_origin, get_type_hints

import numpy as np

from kfmaps._arrays import refuse

NONE_WORDS = ("none", "all", "automatic")
"""Words for ``None``, which TOML does not have."""

Kinds = Mapping[Any, tuple[type, ...]]
"""The record classes behind type hints that do not list them, such as a protocol."""

JsonObject = dict[str, Any]
"""An object of JSON or a table of TOML: plain values by name."""

_T = TypeVar("_T")


@dataclass(frozen=True)
class Setting:
    """One field of a settings record."""

    name: str
    hint: Any  # its type
    default: object  # its default value or a function that makes it; ``MISSING`` where there is none
    help: str = ""  # its meaning, without the full stop
    above: float | None = None  # exclusive and inclusive bounds of a number
    low: float | None = None
    high: float | None = None
    below: float | None = None
    none: str = "none"  # the word for ``None`` in settings files
    option: str = ""  # the command's option that sets it; empty where there is none
    python_only: bool = False  # whether it holds objects that a settings file cannot name

    @property
    def types(self) -> tuple[Any, ...]:
        """The types that a value may have, ``None`` left out."""
        return tuple(hint for hint in types_of(self.hint) if hint is not NoneType)

    @property
    def optional(self) -> bool:
        """Whether the value may be ``None``."""
        return NoneType in types_of(self.hint)

    @property
    def choices(self) -> tuple[str, ...]:
        """The allowed words, where it is a word."""
        return tuple(word for hint in self.types if get_origin(hint) is Literal for word in get_args(hint))

    def records(self, kinds: Kinds) -> tuple[type, ...]:
        """Return the record classes that a value may have."""
        registered = kinds.get(self.hint) or tuple(record for hint in self.types for record in kinds.get(hint, ()))
        return registered or tuple(hint for hint in self.types if isinstance(hint, type) and is_dataclass(hint))

    def values(self, kinds: Kinds) -> str:
        """Return its range or choices as text."""
        records = self.records(kinds)
        words = self.choices or tuple(record.__name__.lower() for record in records if len(records) + self.optional > 1)
        if bool in self.types:
            words = ("true", "false")
        text = ", ".join(words) or self._span() or ("text" if str in self.types else "numbers")
        return f"{text}, or {self.none}" if self.optional else text

    def _span(self) -> str:
        """Return the bounds as text."""
        if self.above is not None:
            return f"above {self.above:g}"
        if self.high is not None or self.below is not None:
            return f"{self.low:g} to {f'{self.high:g}' if self.high is not None else f'below {self.below:g}'}"
        return "" if self.low is None else f"at least {self.low:g}"

    def check(self, value: object, label: str, remedy: str = "") -> None:
        """Raise :class:`InvalidInput`, beginning with ``label``, when the field cannot have ``value``."""
        fits, expected, usual_remedy = self._expectation(value)
        remedy = remedy or usual_remedy
        if fits or (value is None and self.optional):
            return
        if not expected:
            default = self.default() if callable(self.default) else self.default
            example = f"{type(default).__name__}()" if is_dataclass(default) else ""
            expected = f"a record such as {example}" if example else "a record"
            remedy = f"write {self.name}={example}" if example else remedy
        raise refuse(label, expected + (f", or {self.none}" if self.optional else ""), repr(value)[:80], remedy)

    def _expectation(self, value: Any) -> tuple[bool, str, str]:
        """Return whether ``value`` fits, the expected value as text (empty for a record), and the remedy."""
        remedy, types = "compare with `kfmaps config`", self.types
        if self.choices:
            fits = isinstance(value, str) and value in self.choices
            return fits, "one of " + ", ".join(self.choices), "choose one of them"
        if bool in types:
            return isinstance(value, bool | np.bool_), "true or false", remedy
        for plain, number, words in ((int, Integral, "a whole number"), (float, Real, "a number")):
            if plain in types:
                is_number = isinstance(value, number) and not isinstance(value, bool) and math.isfinite(value)
                span = self._span()
                bounds = ((self.above, gt), (self.low, ge), (self.high, le), (self.below, lt))
                fits = is_number and all(bound is None or holds(value, bound) for bound, holds in bounds)
                return fits, f"{words}{span and f', {span}'}", remedy
        if str in types:
            return isinstance(value, str), "text", remedy
        if any(get_origin(hint) is tuple for hint in types):
            return isinstance(value, tuple), "a tuple", f"write {self.name}=(...,)"
        records = tuple(hint for hint in types if isinstance(hint, type) and is_dataclass(hint))
        is_custom = len(records) < len(types) and callable(value) and not isinstance(value, type)
        return is_custom or isinstance(value, records), "", remedy


def types_of(hint: object) -> tuple[Any, ...]:
    """Return the types of a union, or the one type."""
    return get_args(hint) if get_origin(hint) in (Union, UnionType) else (hint,)


def setting(default: Any, help: str = "", **bounds: Any) -> Any:
    """Return a dataclass field with documentation and bounds.

    ``default``: the default value, or a class or function that makes it for each record; ``help``: its meaning;
    ``bounds``: further attributes of :class:`Setting`.
    """
    metadata = {"help": help, **bounds}
    if callable(default):
        return field(default_factory=default, metadata=metadata)
    return field(default=default, metadata=metadata)


@dataclass_transform(frozen_default=True)
def settings_record(cls: type[_T]) -> type[_T]:
    """Make ``cls`` a frozen dataclass that checks its fields and lists them in its documentation.

    A class with its own ``__post_init__`` calls :func:`check_record` there.
    """
    for name, usual in (("__post_init__", check_record), ("__repr__", short_repr)):
        if name not in vars(cls):
            setattr(cls, name, usual)
    record: Any = dataclass(frozen=True)(cls)
    record.is_settings_record = True
    return document_fields(record)


def document_fields(record: type[_T]) -> type[_T]:
    """List the fields of a dataclass, with their help, in its documentation before its examples."""
    own: Any = record
    text, heading, examples = cleandoc(record.__doc__ or "").partition("\n\nExamples\n")
    lines = [f"{f.name} : {f.type}\n    {f.metadata.get('help', '')}" for f in fields(own)]
    record.__doc__ = "\n".join([f"{text}\n", "Attributes", "----------", *lines]) + heading + examples
    return record


@lru_cache(maxsize=64)
def settings_of(cls: type) -> Mapping[str, Setting]:
    """Return the fields of a record class, or of any dataclass, as settings by name."""
    hints, settings = get_type_hints(cls), {}
    for f in fields(cls):
        default = f.default if f.default is not MISSING else f.default_factory
        settings[f.name] = Setting(f.name, hints[f.name], default, **f.metadata)
    return settings


def check_record(record: object) -> None:
    """Raise :class:`InvalidInput` when a field of ``record`` has a wrong type or is out of bounds."""
    for one in settings_of(type(record)).values():
        one.check(getattr(record, one.name), f"{type(record).__name__}.{one.name}")


def walk(cls: type, kinds: Kinds, path: str = "") -> Iterator[tuple[str, type, Setting]]:
    """Yield ``(path, record class, setting)`` of everything below ``cls``; nested records of the same hint once."""
    for one in settings_of(cls).values():
        if one.python_only:
            continue
        label = f"{path}.{one.name}" if path else one.name
        records = one.records(kinds)
        if len(records) != 1 or one.optional:
            yield label, cls, one
        for record in () if path else records:
            yield from walk(record, kinds, label)


def record_as_dict(value: Any, kinds: Mapping[str, type], name: Callable[[Any], str] = repr) -> Any:
    """Return ``value`` with every record in it as a dictionary of plain values for JSON and TOML.

    Records among ``kinds`` have the key ``kind``. An object of the user becomes ``{"kind": "callable", "name": …}``,
    which :func:`update` refuses.
    """
    kind = type(value).__name__
    if type(value) is kinds.get(kind) or getattr(type(value), "is_settings_record", False):
        names = [f.name for f in fields(value) if getattr(value, f.name) or not f.metadata.get("python_only")]
        content = {key: record_as_dict(getattr(value, key), kinds, name) for key in names}
        return {"kind": kind, **content} if kind in kinds else content
    if isinstance(value, tuple):
        return tuple(record_as_dict(one, kinds, name) for one in value)
    if isinstance(value, np.generic):
        return value.item()
    plain = value is None or isinstance(value, str | int | float | list | dict)
    return value if plain else {"kind": "callable", "name": name(value)}


def update(record: _T, values: JsonObject, fresh: Any, kinds: Kinds) -> _T:
    """Return ``record`` with the fields in ``values`` replaced.

    Kinds may be written in any case. A kind alone names a record with its defaults (``kernel = "laplacian"``).
    ``"none"``, ``"all"`` and ``"automatic"`` stand for ``None`` where that is allowed. A record of a new kind starts
    from the one in ``fresh`` where that has the same kind, else from its defaults.
    """
    return _update(type(record), values, record, fresh, "", kinds)


def _update(cls: type, values: Any, current: Any, fresh: Any, path: str, kinds: Kinds) -> Any:
    """Return a record of class ``cls`` with ``values``; other fields are as in ``current`` or by default."""
    settings, changes = settings_of(cls), {}
    for name, value in _table(values, path).items():
        if name not in settings:
            expected = f"one of {', '.join(settings)}" if settings else "no setting"
            remedy = "check the spelling; files of another version of kfmaps must be made again"
            raise refuse(path or "settings", expected, repr(name), remedy)
        now, then = getattr(current, name, None), getattr(fresh, name, None)
        changes[name] = _value(settings[name], value, now, then, f"{path}.{name}" if path else name, kinds)
    if current is not None:
        return replace(current, **changes)
    for item in settings.values():
        if item.default is MISSING and item.name not in changes:
            expected = f"a value ({item.values(kinds)})"
            raise refuse(f"{path}.{item.name}", expected, "none", f"give one: {cls.__name__} needs it")
    return cls(**changes)


def _value(item: Setting, value: Any, current: Any, fresh: Any, label: str, kinds: Kinds) -> Any:
    records = item.records(kinds)
    if item.optional and (value is None or (isinstance(value, str) and value.lower() in NONE_WORDS)):
        return None
    if len(records) == 1 and not item.optional:
        return _update(records[0], value, current, fresh, label, kinds)
    if records and not (value is None and not item.optional):
        return _one_of(records, item, value, current, fresh, label, kinds)
    if any(get_origin(hint) is tuple for hint in item.types):
        return _tuple(value, label)
    value = float(value) if type(value) is int and float in item.types else value
    item.check(value, label)
    return value


def _one_of(
    records: tuple[type, ...], one: Setting, value: Any, current: Any, fresh: Any, label: str, kinds: Kinds
) -> Any:
    """Return a record of one of several kinds."""
    table = dict(_table({"kind": value} if isinstance(value, str) else value, label))
    by_name = {record.__name__.lower(): record for record in records}
    current_kind = type(current).__name__.lower()
    kind = table.pop("kind", current_kind if current_kind in by_name or len(records) > 1 else next(iter(by_name)))
    if one.optional and kind == "none" and not table:
        return None
    if not isinstance(kind, str) or kind.lower() not in by_name:
        got = "none" if kind == "nonetype" else repr(kind)
        raise refuse(f"{label}.kind", "one of " + ", ".join(by_name), got, "choose one of them")
    cls = by_name[kind.lower()]
    base = next((record for record in (current, fresh) if type(record) is cls), None)
    return _update(cls, table, base, None, label, kinds)


def _table(value: object, label: str) -> JsonObject:
    if not isinstance(value, dict):
        raise refuse(label, "a table of settings", repr(value), f"write [{label}] and one setting a line")
    return value


def _tuple(value: object, label: str, depth: int = 0) -> Any:
    """Return nested lists of numbers as tuples; their record checks the lengths."""
    if isinstance(value, list | tuple) and depth < 4:
        return tuple(_tuple(item, label, depth + 1) for item in value)
    if depth and type(value) in (int, float):
        return value
    raise refuse(label, "a list of numbers, or of lists of them", repr(value)[:60], "write [1.0, 2.0]")


def short_repr(self: object) -> str:
    """Return a record in one line: the fields that differ from their defaults, arrays by their shapes.

    :func:`settings_record` sets it as ``__repr__``; dataclasses with arrays do so themselves.
    """
    parts = []
    for f in fields(cast(Any, self)):
        value = getattr(self, f.name)
        default = f.default if f.default_factory is MISSING else f.default_factory()
        shape = getattr(value, "shape", None)
        is_default = type(value) is type(default) and (0 in shape if shape else value == default)
        if not (value is default or is_default):
            parts.append(f"{f.name}={_short_text(value)}")
    return f"{type(self).__name__}({', '.join(parts)})"


def _short_text(value: object) -> str:
    """Return a short text of a record's value."""
    shape = getattr(value, "shape", None)
    if shape:
        return f"<{' × '.join(f'{n:,}' for n in shape)}>"
    if isinstance(value, str | bytes) or not isinstance(value, Sized) or len(repr(value)) <= 60:
        return shorten(repr(value), 200)
    return f"<{len(value):,}>"
