"""The options that set a configuration, for every command that has one.

Light on purpose: it names the settings and imports nothing that computes, so that ``--help`` is quick.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kfmaps._arrays import refuse
from kfmaps.settings.catalogue import CATALOGUE, FLAGS, PRESETS, Setting

if TYPE_CHECKING:
    from kfmaps.config import Config


@dataclass(frozen=True)
class Chosen:
    """What the user chose on the command line.

    Attributes
    ----------
    preset : str or None
    file : Path or None
        A settings file.
    flags : mapping
        Value by option, ``None`` where it was not given.
    assignments : tuple of str
        What stood after ``--set``.
    """

    preset: str | None = None
    file: Path | None = None
    flags: Mapping[str, Any] = field(default_factory=dict)
    assignments: tuple[str, ...] = ()

    def config(self, base: Config) -> Config:
        """The configuration: the preset, or else ``base``, then the file, the flags and ``--set``.

        What a file does not name is as in the preset, or in ``Config()``, whatever the command's ``base``.

        Raises
        ------
        InvalidInput
            Naming the option or the file that is at fault.
        """
        from kfmaps.settings.merge import preset, read_settings, with_assignments, with_flags

        config = base if self.preset is None and self.file is None else preset(self.preset or "default")
        config = config if self.file is None else read_settings(self.file, config)
        return with_assignments(with_flags(config, self.flags), self.assignments)


def _option(setting: Setting, panel: str) -> inspect.Parameter:
    """The command's option for one setting; ``None`` means that it was not given."""
    names = [f"{setting.flag}/--no-{setting.flag[2:]}"] if setting.type is bool else [setting.flag]
    text = f"{setting.meaning[0].upper()}{setting.meaning[1:]}: {setting.values}."
    # Where a word is allowed beside numbers, the text is looked at later.
    words = " or " in setting.values and setting.type is not bool
    kind = str if words else setting.type
    metavar = {int: "N", float: "X", str: "NAME"}.get(setting.type) if kind is not bool else None
    option = typer.Option(*names, help=text, rich_help_panel=panel, show_default=False, metavar=metavar)
    return _parameter(setting.argument, Annotated[kind | None, option], None)


def _parameter(name: str, annotation: Any, default: Any) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=annotation, default=default)


def _general() -> list[inspect.Parameter]:
    """The options that stand for many settings."""

    def option(*names: str, **more: Any) -> Any:
        return typer.Option(*names, rich_help_panel="Settings", show_default=False, **more)

    presets = "; ".join(f"{name}: {meaning}" for name, meaning in PRESETS.items())
    return [
        _parameter("preset", Annotated[str | None, option("--preset", metavar="NAME", help=f"{presets}.")], None),
        _parameter("paper", Annotated[bool, option("--paper", help="The same as --preset paper.")], False),
        _parameter(
            "config", Annotated[Path | None, option("--config", help="Settings file, see `kfmaps config`.")], None
        ),
        _parameter(
            "assign",
            Annotated[
                list[str] | None,
                option("--set", metavar="NAME=VALUE", help="Any setting, such as weights.laplacian=0.5; repeatable."),
            ],
            None,
        ),
    ]


def with_settings(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give ``command``, which takes ``settings: Chosen``, all options of a configuration in its place."""
    signature = inspect.signature(command, eval_str=True)
    own = [
        p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in signature.parameters.values() if p.name != "settings"
    ]
    options = [_option(s, panel) for panel, group in CATALOGUE.items() for s in group if s.flag]
    parameters = [*own, *_general(), *options]

    @functools.wraps(command)
    def whole(**given: Any) -> Any:
        preset, paper = given.pop("preset", None), given.pop("paper", False)
        if paper and preset not in (None, "paper"):
            raise refuse("--paper", "one preset", f"--preset {preset} beside it", "leave one out")
        file, assignments = given.pop("config", None), given.pop("assign", None)
        flags = {flag: typed(given.pop(s.argument, None), s) for flag, s in FLAGS.items()}
        chosen = Chosen("paper" if paper else preset, file, flags, tuple(assignments or ()))
        return command(settings=chosen, **given)

    # typing cannot express a signature that is made from a table; Typer reads these two attributes.
    whole.__signature__ = signature.replace(parameters=parameters)  # pyright: ignore[reportAttributeAccessIssue]
    whole.__annotations__ = {p.name: p.annotation for p in parameters}
    return whole


def typed(value: Any, setting: Setting) -> Any:
    """An option's text as the number that it is, or as it stands when it is a word."""
    if isinstance(value, str) and setting.type in (int, float):
        try:
            return setting.type(value)
        except ValueError:
            return value
    return value
