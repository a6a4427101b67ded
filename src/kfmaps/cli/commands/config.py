"""``kfmaps config``: the settings, as a file to edit."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kfmaps.cli.options import Force, Json
from kfmaps.cli.terminal import print_json
from kfmaps.config import Config, as_dict
from kfmaps.io.atomic import check_output, write_text
from kfmaps.settings import SettingsOptions, settings_text, with_settings


@with_settings
def config(
    settings: SettingsOptions,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="Write this file; default: print.")] = None,
    json: Json = False,
    force: Force = False,
) -> None:
    """Print the settings that match would use, as TOML that --config reads."""
    if output is not None:
        check_output(output, force)
    chosen = settings.config(Config())
    text = settings_text(chosen)
    if output is not None:
        write_text(output, text, force)
    if json:
        print_json(as_dict(chosen))
    elif output is None:
        typer.echo(text, nl=False)
