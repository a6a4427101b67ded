"""A configuration as a settings file."""

from __future__ import annotations

import json
from dataclasses import is_dataclass
from typing import Any

from kfmaps._arrays import refuse
from kfmaps._records import Setting, record_as_dict, settings_of
from kfmaps.config import KINDS, RECORDS, Config
from kfmaps.kernels.kernels import describe_kernel


def settings_text(config: Config, comments: bool = True) -> str:
    """Return TOML from which :func:`~kfmaps.settings.merge.read_settings` makes ``config`` again, whatever the base.

    ``comments``: whether each line says what it means.
    """
    head = ["# Settings of kfmaps match; give them with --config FILE.", ""] if comments else []
    return "\n".join([*head, *_lines(config, "", comments)]) + "\n"


def _lines(record: Any, section: str, comments: bool) -> list[str]:
    """The plain values of a record, then the tables of the records in it."""
    kind = type(record).__name__
    lines, tables = [f'kind = "{kind}"'] if kind in RECORDS else [], []
    for one in settings_of(type(record)).values():
        value, path = getattr(record, one.name), f"{section}.{one.name}" if section else one.name
        if one.python and not value:
            continue
        if is_dataclass(value):
            tables += ["", f"[{path}]", *_lines(value, path, comments)]
            continue
        if one.python or callable(value):
            got = describe_kernel(value)
            raise refuse(path, "a record that a settings file can name", got, "write one of kfmaps' own")
        line = f"{one.name} = {text_of(value, one)}"
        lines.append(f"{line:<30} # {one.help} ({one.values(KINDS)})" if comments and one.help else line)
    return lines + tables


def text_of(value: object, one: Setting) -> str:
    """Return a value as TOML."""
    if isinstance(value, tuple):
        return f"[{', '.join(text_of(item, one) for item in value)}]"
    return json.dumps(one.none if value is None else record_as_dict(value, {}), ensure_ascii=False)
