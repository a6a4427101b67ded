"""The options that set a configuration, for every command that has one."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import typer

from kfmaps._records import Setting, walk
from kfmaps.config import KINDS, Config
from kfmaps.settings.merge import preset, read_settings, with_assignments

OPTIONS: dict[str, tuple[str, Setting]] = {
    one.option: (path, one) for path, _, one in walk(Config, KINDS) if one.option
}
"""Paths and settings by the option that sets them."""


@dataclass(frozen=True)
class Chosen:
    """What the user chose on the command line."""

    preset: str | None = None
    file: Path | None = None  # a settings file
    options: Mapping[str, tuple[str, object]] = field(default_factory=dict)  # path and value by option
    assignments: tuple[str, ...] = ()  # what stood after ``--set``

    def config(self, base: Config) -> Config:
        """Return the preset, or else ``base``, changed by the file, the options and ``--set``.

        What a file does not name is as in the preset, or in ``Config()``, whatever the command's ``base``.
        """
        config = base if self.preset is None and self.file is None else preset(self.preset or "default")
        config = config if self.file is None else read_settings(self.file, config)
        return with_assignments(config, self.assignments, self.options)


def with_settings(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give ``command``, which takes ``settings: Chosen``, all options of a configuration in its place."""
    signature = inspect.signature(command, eval_str=True)
    keyword = inspect.Parameter.KEYWORD_ONLY
    parameters = [p.replace(kind=keyword) for p in signature.parameters.values() if p.name != "settings"]
    made = {option.strip("-"): _option(option) for option in OPTIONS} | _GENERAL
    parameters += [inspect.Parameter(name, keyword, annotation=kind, default=None) for name, kind in made.items()]

    @functools.wraps(command)
    def whole(**given: Any) -> Any:
        values = {option: (path, given.pop(option.strip("-"))) for option, (path, _) in OPTIONS.items()}
        options = {option: (path, value) for option, (path, value) in values.items() if value is not None}
        chosen = Chosen(given.pop("preset"), given.pop("config"), options, tuple(given.pop("assign") or ()))
        return command(settings=chosen, **given)

    # typing cannot express a signature that is made from a table; Typer reads these two attributes.
    whole.__signature__ = signature.replace(parameters=parameters)  # pyright: ignore[reportAttributeAccessIssue]
    whole.__annotations__ = {p.name: p.annotation for p in parameters}
    return whole


def _typer(*names: str, **more: Any) -> Any:
    return typer.Option(*names, rich_help_panel="Settings", show_default=False, **more)


def _option(name: str) -> Any:
    """The annotation of the command's option for one setting; ``None`` means that it was not given."""
    one = OPTIONS[name][1]
    number = next((kind for kind in (int, float) if kind in one.types), str)
    values = one.values(KINDS)
    text = f"{one.help[0].upper()}{one.help[1:]}{'' if values == 'text' else f': {values}'}."
    metavar = {int: "N", float: "X", str: "NAME"}[number]
    return Annotated[number | None, _typer(name, help=text, metavar=metavar)]


_GENERAL = {
    "preset": Annotated[
        str | None,
        _typer("--preset", metavar="NAME", help="default, single-fit, paper, no17, ...; see docs/settings.md."),
    ],
    "config": Annotated[Path | None, _typer("--config", help="Settings file, see `kfmaps config`.")],
    "assign": Annotated[
        list[str] | None,
        _typer("--set", metavar="NAME=VALUE", help="Any setting, such as weights.laplacian=0.5; repeatable."),
    ],
}
"""The options that stand for many settings."""
