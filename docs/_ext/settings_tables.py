"""The table of all settings in docs/settings.md: ``python docs/_ext/settings_tables.py``."""

from __future__ import annotations

from dataclasses import MISSING, is_dataclass
from inspect import getdoc
from pathlib import Path
from typing import Any

from kfmaps._records import Setting, walk
from kfmaps.config import FORMULATIONS, KINDS, Config
from kfmaps.settings import PRESETS, preset, toml_value

BEGIN, END = "<!-- begin: made by docs/_ext/settings_tables.py -->", "<!-- end -->"


def _value_in(config: Config, path: str, cls: type, one: Setting) -> str:
    """Return what ``config`` has at ``path``, the default of the record ``cls`` where it has another or none."""
    section = path.rpartition(".")[0]
    record: Any = getattr(config, section) if section else config
    value = getattr(record, one.name) if type(record) is cls else one.default
    value = value() if isinstance(value, type) else value
    if value is MISSING:
        return ""
    return type(value).__name__.lower() if is_dataclass(value) else toml_value(value, one).strip('"')


def tables() -> str:
    """Return the presets, and a table for each section with the values of three of them side by side."""
    configs = [preset(name) for name in PRESETS[:3]]
    found: dict[str, list[tuple[str, type, Setting]]] = {"": []}
    for row in walk(Config, KINDS):
        found.setdefault(row[0].rpartition(".")[0], []).append(row)
    lines = []
    for section, rows in found.items():
        lines += [
            "",
            f"### {section or 'At the top'}",
            "",
            f"| setting | meaning | values | {' | '.join(PRESETS[:3])} |",
        ]
        lines.append("|---|---|---|---|---|---|")
        several = len({cls for _, cls, _ in rows}) > 1
        for path, cls, one in rows:
            of = f" ({cls.__name__.lower()})" if several else ""
            option = f", `{one.option}`" if one.option else ""
            values = " | ".join(_value_in(config, path, cls, one) for config in configs)
            lines.append(f"| `{path}`{option} | {one.help}{of} | {one.values(KINDS)} | {values} |")
    names = ["* `default`: what `kfmaps match` and `kfmaps.match` use, that is `Config()`"]
    for name in [name for name in PRESETS[1:] if name not in FORMULATIONS]:
        first = (getdoc(getattr(Config, name.replace("-", "_"))) or "").partition("\n\n")[0]
        names.append(f"* `{name}`: {' '.join(first.split()).rstrip('.')}")
    published = ", ".join(f"`{name}`" for name in FORMULATIONS)
    names.append(f"* {published}: [published formulations](formulations.md#presets)")
    return "\n".join([BEGIN, "", "### Presets", "", *names, *lines, "", END])


def updated(text: str) -> str:
    """Return ``text`` with the tables between its two marks made anew."""
    before, _, rest = text.partition(BEGIN)
    return before + tables() + rest.partition(END)[2]


if __name__ == "__main__":
    path = Path(__file__).parents[1] / "settings.md"
    path.write_text(updated(path.read_text(encoding="utf-8")), encoding="utf-8")
