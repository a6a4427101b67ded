"""``kfmaps transfer``: carry per-vertex values over a map."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kfmaps.app.files import Values, check_output, load_map, read_values, write_values
from kfmaps.app.files import transfer as carried


def transfer(
    map: Annotated[Path, typer.Argument(help="A map (.npz, .txt, .vts, .mat).", metavar="MAP", show_default=False)],
    values: Annotated[
        Path,
        typer.Argument(help="A row for each source vertex (.npy, .csv, .txt).", metavar="VALUES", show_default=False),
    ],
    output: Annotated[
        Path,
        typer.Option("-o", "--output", help="A row for each target vertex (.npy, .csv, .txt).", show_default=False),
    ],
    force: Annotated[bool, typer.Option("--force", help="Replace an existing file.")] = False,
) -> None:
    """Carry a function or labels from the source's vertices to the target's."""
    check_output(output, force, (map, values))
    found = read_values(values)
    write_values(output, Values(carried(found.array, load_map(map)), found.columns), force)
