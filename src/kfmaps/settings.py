"""Settings from presets, files, options of the command and ``NAME=VALUE`` texts; later ones override earlier ones."""

from __future__ import annotations

import difflib
import functools
import inspect
import json
import pickle
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, is_dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from kfmaps._arrays import InvalidInput, MissingDependency, refuse
from kfmaps._records import JsonObject, Setting, record_as_dict, settings_of, walk
from kfmaps.config import FORMULATIONS, KINDS, RECORDS, Config, from_dict
from kfmaps.kernels.kernels import describe_kernel

SUFFIX, FORMAT = ".pt", 1
"""Extension and version of files of ``kfmaps learn``."""
_EXPECTED, _REMEDY = "a file that kfmaps learn wrote", "check the path, or learn again"


def read_learned(path: str | Path) -> JsonObject:
    """Return the tensors and plain values of a file of ``kfmaps learn``. Nothing in it is ever executed."""
    try:
        import torch
    except ImportError as error:
        remedy = "Install it with: pip install 'kfmaps[learn]', or learn to a .toml file"
        raise MissingDependency(f"{path} needs PyTorch. {remedy}.") from error
    try:
        # With weights_only PyTorch refuses anything but tensors and plain values.
        content = torch.load(Path(path), map_location="cpu", weights_only=True)
    except OSError as error:
        raise refuse(f"{path}", _EXPECTED, _reason(error), _REMEDY) from error
    except (pickle.UnpicklingError, RuntimeError, EOFError, ValueError, KeyError) as error:
        raise refuse(f"{path}", _EXPECTED, "something else", _REMEDY) from error
    if not isinstance(content, dict) or content.get("format") != FORMAT or not isinstance(content.get("settings"), str):
        raise refuse(f"{path}", _EXPECTED, "another content or version", _REMEDY)
    return content


def _reason(error: OSError) -> str:
    """Return in words why a file cannot be read."""
    words = {FileNotFoundError: "nothing there", IsADirectoryError: "a folder"}
    return words.get(type(error)) or error.strerror or str(error)


PRESETS = ("default", "single-fit", "paper", "no17", "obcs12", *FORMULATIONS)
"""Names of configurations: ``Config()``, methods of :class:`~kfmaps.config.Config`, and published formulations."""


def preset(name: str) -> Config:
    """Return the configuration of that name among :data:`PRESETS`."""
    if name not in PRESETS:
        raise refuse("--preset", "one of " + ", ".join(PRESETS), repr(name), "choose one of them")
    if name in FORMULATIONS:
        return Config.published(name)
    return Config() if name == "default" else getattr(Config, name.replace("-", "_"))()


def read_settings(path: str | Path, base: Config | None = None) -> Config:
    """Return ``base``, by default ``Config()``, with settings of a TOML file or a ``.pt`` file of ``kfmaps learn``."""
    try:
        if Path(path).is_char_device():  # one like /dev/zero never ends
            raise refuse(f"--config {path}", "a settings file", "a device", "check the path")
        learned = Path(path).suffix == SUFFIX
        text = read_learned(path)["settings"] if learned else Path(path).read_bytes().decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        got = _reason(error) if isinstance(error, OSError) else "text that is not UTF-8"
        raise refuse(f"--config {path}", "a settings file", got, "check the path") from error
    try:
        values = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise refuse(f"--config {path}", "TOML", str(error), "compare with `kfmaps config`") from error
    try:
        return from_dict(values, base)
    except InvalidInput as error:
        raise InvalidInput(f"--config {path}: {error}") from error


def settings_text(config: Config, comments: bool = True) -> str:
    """Return TOML from which :func:`read_settings` restores ``config`` with any base.

    ``comments``: whether each line explains its setting.
    """
    head = ["# Settings of kfmaps match; give them with --config FILE.", ""] if comments else []
    return "\n".join([*head, *_lines(config, "", comments)]) + "\n"


def _lines(record: Any, section: str, comments: bool) -> list[str]:
    """Return lines of a record's plain values, then tables of the records in it."""
    kind = type(record).__name__
    lines, tables = [f'kind = "{kind}"'] if kind in RECORDS else [], []
    for one in settings_of(type(record)).values():
        value, path = getattr(record, one.name), f"{section}.{one.name}" if section else one.name
        if one.python_only and not value:
            continue
        if is_dataclass(value):
            tables += ["", f"[{path}]", *_lines(value, path, comments)]
            continue
        if one.python_only or callable(value):
            got = describe_kernel(value)
            raise refuse(path, "a record that a settings file can name", got, "write one of kfmaps' own")
        line = f"{one.name} = {toml_value(value, one)}"
        lines.append(f"{line:<30} # {one.help} ({one.values(KINDS)})" if comments and one.help else line)
    return lines + tables


def toml_value(value: object, setting: Setting) -> str:
    """Return a value as TOML."""
    if isinstance(value, tuple):
        return f"[{', '.join(toml_value(item, setting) for item in value)}]"
    return json.dumps(setting.none if value is None else record_as_dict(value, {}), ensure_ascii=False)


def with_assignments(
    base: Config, assignments: Sequence[str], options: Mapping[str, tuple[str, object]] | None = None
) -> Config:
    """Return ``base`` changed by texts like ``"weights.laplacian=0.5"``; the later of two for one setting counts.

    ``assignments``: with values in TOML, where quotes around words may be left out; ``options``: paths and values by
    option, such as ``{"--kernel": ("kernel", "laplacian")}``, which are applied first.
    """
    values = dict(options or {})
    for text in assignments:
        path, sign, value = (part.strip() for part in text.partition("="))
        if not sign or not path or not value:
            raise refuse("--set", "NAME=VALUE, such as weights.laplacian=0.5", repr(text), "see `kfmaps config`")
        values[f"--set {path}"] = (path, _literal(value))

    def build(labels: Iterable[str]) -> Config | InvalidInput:
        try:
            return from_dict(_nested(dict(values[label] for label in labels)), base)
        except InvalidInput as error:
            return error

    # All at once, since a value may be valid only together with another.
    config = build(values)
    if isinstance(config, Config):
        return config
    culprits = [label for label in values if isinstance(build([other for other in values if other != label]), Config)]
    culprits = culprits or [label for label in values if isinstance(build([label]), InvalidInput)]
    # Both options of a contradiction are named, else the first fault.
    raise InvalidInput(f"{', '.join(culprits[:2])}: {config}" if culprits else str(config)) from config


def similar_settings(option: str) -> list[str]:
    """Return the paths of at most three settings that a misspelt or removed ``option`` may mean."""
    words = [word for word in option.strip("-").split("-") if word not in ("no", "")]
    scores = {}
    for path, _, one in walk(Config, KINDS):
        names = path.replace(".", "_").split("_")
        score = (path == "_".join(words)) - 0.01 * len(names)
        for word in words:
            close = bool(difflib.get_close_matches(word, names, 1, 0.75))
            score += 2 if any(name.startswith(word) for name in names) else max(1.5 * (word in one.help), close)
        scores[path] = max(scores.get(path, 0.0), score)
    best = max(scores.values())
    return sorted((path for path in scores if scores[path] > max(0.9, best - 1.2)), key=lambda path: -scores[path])[:3]


def _nested(assignments: Mapping[str, object]) -> dict[str, object]:
    """Return assignments such as ``{"a.b": 1}`` as nested tables, ``{"a": {"b": 1}}``."""
    tree: dict[str, object] = {}
    for path, value in assignments.items():
        *above, last = path.split(".")
        branch: dict[str, object] = tree
        for name in above:
            below = branch.get(name)
            kind: dict[str, object] = {"kind": below} if isinstance(below, str) else {}
            branch[name] = branch = below if isinstance(below, dict) else kind
        branch[last] = value
    return tree


def _literal(text: str) -> object:
    """Return a text as a TOML value, or the text itself when it is none."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (tomllib.TOMLDecodeError, RecursionError):
        return text


OPTIONS: dict[str, tuple[str, Setting]] = {
    one.option: (path, one) for path, _, one in walk(Config, KINDS) if one.option
}
"""Paths and settings by the option that sets them."""


@dataclass(frozen=True)
class SettingsOptions:
    """The options of a command that choose settings."""

    preset: str | None = None
    file: Path | None = None  # a settings file
    options: Mapping[str, tuple[str, object]] = field(default_factory=dict)  # path and value by option
    assignments: tuple[str, ...] = ()  # arguments of ``--set``

    def config(self, base: Config) -> Config:
        """Return the preset, or else ``base``, changed by the file, the options and ``--set``.

        A file changes the preset or ``Config()``, not the command's ``base``.
        """
        config = base if self.preset is None and self.file is None else preset(self.preset or "default")
        config = config if self.file is None else read_settings(self.file, config)
        return with_assignments(config, self.assignments, self.options)


def with_settings(command: Callable[..., Any]) -> Callable[..., Any]:
    """Return ``command`` with all options of a configuration in place of its argument ``settings: SettingsOptions``."""
    signature = inspect.signature(command, eval_str=True)
    keyword = inspect.Parameter.KEYWORD_ONLY
    parameters = [p.replace(kind=keyword) for p in signature.parameters.values() if p.name != "settings"]
    annotations = {option.strip("-"): _option(option) for option in OPTIONS} | _GENERAL
    parameters += [
        inspect.Parameter(name, keyword, annotation=kind, default=None) for name, kind in annotations.items()
    ]

    @functools.wraps(command)
    def wrapper(**arguments: Any) -> Any:
        values = {option: (path, arguments.pop(option.strip("-"))) for option, (path, _) in OPTIONS.items()}
        options = {option: (path, value) for option, (path, value) in values.items() if value is not None}
        choice = SettingsOptions(
            arguments.pop("preset"), arguments.pop("config"), options, tuple(arguments.pop("assign") or ())
        )
        return command(settings=choice, **arguments)

    # Typer reads these two attributes; typing cannot express a signature that is made from a table.
    wrapper.__signature__ = signature.replace(parameters=parameters)  # pyright: ignore[reportAttributeAccessIssue]
    wrapper.__annotations__ = {p.name: p.annotation for p in parameters}
    return wrapper


def _typer(*names: str, **more: Any) -> Any:
    return typer.Option(*names, rich_help_panel="Settings", show_default=False, **more)


def _option(name: str) -> Any:
    """Return the annotation of the command's option for one setting; its value is ``None`` where it is not given."""
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
"""Options that choose many settings or any setting."""
