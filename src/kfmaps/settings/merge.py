"""Presets, a settings file, flags and ``--set`` laid over each other, the later over the earlier."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.config import Config, from_dict
from kfmaps.settings.catalogue import FLAGS, PRESETS, Setting
from kfmaps.settings.learned import SUFFIX, read_learned
from kfmaps.settings.values import blamed


def preset(name: str) -> Config:
    """The configuration of that name among ``PRESETS``."""
    if name not in PRESETS:
        raise refuse("--preset", "one of " + ", ".join(PRESETS), repr(name), "choose one of them")
    return Config() if name == "default" else getattr(Config, name.replace("-", "_"))()


def read_settings(path: str | Path, base: Config | None = None) -> Config:
    """``base``, by default ``Config()``, with the settings of a TOML file, or of a ``.pt`` file of ``kfmaps learn``.

    Raises
    ------
    InvalidInput
        When the file is missing or no TOML, and on names and values that are not settings.
    """
    try:
        if Path(path).is_char_device():  # one like /dev/zero never ends
            raise refuse(f"--config {path}", "a settings file", "a device", "check the path")
        learned = Path(path).suffix == SUFFIX
        text = read_learned(path)["settings"] if learned else Path(path).read_bytes().decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        got = getattr(error, "strerror", None) or "text that is not UTF-8"
        raise refuse(f"--config {path}", "a settings file", got, "check the path") from error
    try:
        values = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise refuse(f"--config {path}", "TOML", str(error), "compare with `kfmaps config`") from error
    try:
        return from_dict(values, base)
    except InvalidInput as error:
        raise InvalidInput(f"--config {path}: {error}") from error


def with_flags(base: Config, flags: Mapping[str, Any]) -> Config:
    """``base`` changed by options: ``{"--alpha": 0.5}``; those that are ``None`` were not given.

    An option of one kind of record (``--degree``) chooses that kind.
    """
    given = {flag: value for flag, value in flags.items() if value is not None}
    paths = {flag: (FLAGS[flag].path, value) for flag, value in given.items()}
    for section in ("kernel", "solver", "refinement", "finish", "search"):
        inside = [FLAGS[flag] for flag in given if FLAGS[flag].section == section and FLAGS[flag].kinds]
        if inside:
            kind_flag = next((f for f, s in FLAGS.items() if s.path == f"{section}.kind"), "")
            present = type(getattr(base, section)).__name__
            implied = _kind(inside, kind_flag, given.get(kind_flag), present)
            if implied:
                paths = {f"{inside[0].flag} ({implied})": (f"{section}.kind", implied), **paths}
    return blamed(base, paths) if paths else base


def _kind(inside: list[Setting], kind_flag: str, explicit: str | None, present: str) -> str | None:
    """The kind of record that options need; ``None`` when the present or explicitly chosen one is right."""
    common = set(inside[0].kinds).intersection(*(s.kinds for s in inside[1:]))
    if explicit is not None:
        for setting in inside:
            if explicit.lower() not in {kind.lower() for kind in setting.kinds}:
                wanted = f"{kind_flag} {' or '.join(kind.lower() for kind in setting.kinds)}"
                raise refuse(setting.flag, wanted, explicit, "leave one of the two out")
        return None
    if not common:
        both = f"{inside[0].flag} and {inside[-1].flag}"
        raise refuse(both, "options that go together", "options of different kinds", "leave one out")
    if present in common:
        return None
    if len(common) > 1:
        kinds = " or ".join(kind.lower() for kind in inside[0].kinds if kind in common)
        raise refuse(inside[0].flag, f"a kernel that has it ({kinds})", present.lower(), f"add {kind_flag}")
    return common.pop()


def with_assignments(base: Config, assignments: Sequence[str]) -> Config:
    """``base`` changed by texts like ``"weights.laplacian=0.5"``; of two for the same setting the later counts."""
    given = {}
    for text in assignments:
        path, sign, value = text.partition("=")
        path, value = path.strip(), value.strip()
        if not sign or not path or not value:
            raise refuse("--set", "NAME=VALUE, such as weights.laplacian=0.5", repr(text), "see `kfmaps config`")
        given[f"--set {path}"] = (path, _literal(value))
    return blamed(base, given) if given else base


def _literal(text: str) -> Any:
    """A TOML value, or the text itself when it is none: quotes around words may be left out."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (tomllib.TOMLDecodeError, RecursionError):
        return text
