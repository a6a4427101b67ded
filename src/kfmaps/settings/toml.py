"""A configuration as a settings file."""

from __future__ import annotations

import json
from typing import Any

from kfmaps.config import Config, as_dict
from kfmaps.settings.catalogue import SETTINGS

_WORDS = {"kernel.gamma": "automatic", "refinement.samples": "all"}
"""What ``None`` is called where "none" would mislead."""


def settings_text(config: Config, comments: bool = True) -> str:
    """TOML from which :func:`~kfmaps.settings.merge.read_settings` makes ``config`` again, whatever the base.

    Parameters
    ----------
    config : Config
        Of kernels that have a name; a callable of the user's own cannot be written.
    comments : bool
        Whether each line says what it means.
    """
    values = as_dict(config)
    head = ["# Settings of kfmaps match; give them with --config FILE.", ""] if comments else []
    return "\n".join([*head, *_lines(values, "", comments)]) + "\n"


def _lines(values: dict[str, Any], section: str, comments: bool) -> list[str]:
    """The plain values of a table, then its sub-tables."""
    known = {setting.path: setting for setting in SETTINGS}
    lines, tables = [], []
    for name, value in values.items():
        path = f"{section}.{name}" if section else name
        if isinstance(value, dict):
            tables += ["", f"[{path}]", *_lines(value, path, comments)]
            continue
        line = f"{name} = {_text(value, path)}"
        setting = known.get(path if section.count(".") == 0 else f"kernel.{name}")
        if comments and setting is None and value is None:
            setting = known.get(f"{path}.kind")
        lines.append(f"{line:<30} # {setting.meaning}: {setting.values}" if comments and setting else line)
    return lines + tables


def _text(value: Any, path: str) -> str:
    if value is None:
        return json.dumps(_WORDS.get(path, "automatic" if path.endswith(".gamma") else "none"))
    if isinstance(value, tuple):
        return f"[{', '.join(_text(item, path) for item in value)}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)
