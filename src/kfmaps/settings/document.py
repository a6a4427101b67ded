"""The table of all settings in docs/settings.md: ``python -m kfmaps.settings.document docs/settings.md``."""

from __future__ import annotations

import sys
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from typing import Any

from kfmaps.config import RECORDS, Config
from kfmaps.settings.catalogue import CATALOGUE, PRESETS, Setting
from kfmaps.settings.merge import preset

BEGIN, END = "<!-- begin: made by kfmaps.settings.document -->", "<!-- end -->"


def default_of(setting: Setting, config: Config) -> str:
    """What ``config`` has for a setting; for a record that it does not use, what that record begins with."""
    section, name = setting.section, setting.field
    current: Any = getattr(config, section) if section else config
    if name == "kind":
        return type(current).__name__.lower() if is_dataclass(current) else "none"
    if setting.kinds and type(current).__name__ not in setting.kinds:
        current = getattr(Config(), section)
    if setting.kinds and type(current).__name__ not in setting.kinds:
        begins = {kind: {f.name: f.default for f in fields(RECORDS[kind])}[name] for kind in setting.kinds}
        told = {kind.lower(): _text(value, setting) for kind, value in begins.items() if value is not MISSING}
        alike = len(set(told.values())) == 1
        return next(iter(told.values())) if alike else ", ".join(f"{kind} {value}" for kind, value in told.items())
    return _text(getattr(current, name), setting)


def _text(value: Any, setting: Setting) -> str:
    if value is None:
        return "automatic" if setting.field == "gamma" else "all" if setting.field == "samples" else "none"
    return str(value).lower() if isinstance(value, bool) else str(value)


def tables() -> str:
    """One table for each group of settings, the recommended and the paper's values side by side."""
    lines = []
    for group, settings in CATALOGUE.items():
        lines += ["", f"### {group}", "", "| setting | option | meaning | values | recommended | paper |"]
        lines.append("|---|---|---|---|---|---|")
        for s in settings:
            recommended, paper = default_of(s, Config()), default_of(s, preset("paper"))
            single = default_of(s, Config.single_fit())
            if single != recommended:
                recommended += f"; single fit {single}"
            flag = f"`{s.flag}`" if s.flag else ""
            of = f" ({', '.join(kind.lower() for kind in s.kinds)})" if s.kinds else ""
            lines.append(f"| `{s.path}` | {flag} | {s.meaning}{of} | {s.values} | {recommended} | {paper} |")
    names = "\n".join(f"* `{name}`: {meaning}" for name, meaning in PRESETS.items())
    return "\n".join([BEGIN, "", "### Presets", "", names, *lines, "", END])


def updated(text: str) -> str:
    """``text`` with the tables between its two marks made anew."""
    before, _, rest = text.partition(BEGIN)
    return before + tables() + rest.partition(END)[2]


if __name__ == "__main__":
    path = Path(sys.argv[1])
    path.write_text(updated(path.read_text(encoding="utf-8")), encoding="utf-8")
