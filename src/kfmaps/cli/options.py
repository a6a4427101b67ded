"""Options that several commands share, each written once."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from kfmaps._errors import refuse

_PANEL = "Output"  # panel of the common options in the help

_VERDICTS = ("sure", "likely")  # verdicts that can be required, best first
UNSURE = 3
"""Exit status when a verdict is worse than the required one."""


def _output_option(*names: str, help: str) -> Any:
    return typer.Option(*names, help=help, rich_help_panel=_PANEL)


Force = Annotated[bool, _output_option("--force", help="Replace existing files.")]
Json = Annotated[bool, _output_option("--json", help="Print the outcome as JSON, and nothing else.")]
Quiet = Annotated[bool, _output_option("-q", "--quiet", help="Print no progress, summary or warnings.")]

MapFile = Annotated[Path, typer.Argument(help="A map (.npz, .txt, .vts, .mat).", metavar="MAP")]
SourceMesh = Annotated[Path | None, typer.Option("--source", help="The source mesh; default: the one the map names.")]
TargetMesh = Annotated[Path | None, typer.Option("--target", help="The target mesh; default: the one the map names.")]
TruthLists = Annotated[
    tuple[Path, Path] | None,
    typer.Option(
        help="True vertices of both, line k of one file to line k of the other (.vts counts from 1): shows the errors.",
        metavar="SOURCE TARGET",
    ),
]
Identity = Annotated[bool, typer.Option("--identity", help="Truth: vertex i is vertex i.")]
UpAxis = Annotated[str | None, typer.Option(help="The axis that points upwards: x, y or z; default: detected.")]
Workers = Annotated[
    str | None,
    typer.Option(
        help="Worker processes, or the address of a Dask scheduler; default: one for each core.", metavar="N|ADDRESS"
    ),
]
Require = Annotated[
    str | None,
    typer.Option(
        help=f"Exit with status {UNSURE} if a verdict is worse; the map is still written.",
        metavar="|".join(_VERDICTS),
    ),
]


def check_required(verdict: str | None) -> None:
    """Check the value of ``--require``."""
    if verdict is not None and verdict not in _VERDICTS:
        raise refuse("--require", " or ".join(_VERDICTS), repr(verdict), "choose one of them")


def meets(verdict: str, required: str | None) -> bool:
    """Return whether a verdict is at least the ``required`` one; that of a single fit never is."""
    return required is None or verdict in _VERDICTS[: _VERDICTS.index(required) + 1]


def line_numbers(text: str, option: str) -> tuple[int, ...]:
    """Return the line numbers, from 1, of a text like "201,1121"; ``option``: its name in messages."""
    words = text.replace(",", " ").split()
    if not words or not all(word.isdecimal() and int(word) for word in words):
        raise refuse(option, "whole numbers from 1 on, with commas between", repr(text), "count lines from 1")
    return tuple(map(int, words))
