"""``kfmaps config``: the settings, as a file to edit."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kfmaps.settings.options import Chosen, with_settings


@with_settings
def config(
    settings: Chosen,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="Write this file; default: print.", show_default=False)
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Print the settings that match would use, as TOML that --config reads."""
    from kfmaps.config import Config
    from kfmaps.io import atomic_output, check_output
    from kfmaps.settings.toml import settings_text

    if output is not None:
        check_output(output, force)
    text = settings_text(settings.config(Config()))
    if output is None:
        typer.echo(text, nl=False)
        return
    with atomic_output(output, force) as temporary:
        temporary.write_text(text, encoding="utf-8")
