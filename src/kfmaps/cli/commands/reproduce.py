"""``kfmaps reproduce``: the paper's experiments."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from kfmaps.cli.terminal import Terminal
from kfmaps.experiments.outputs import output_folder
from kfmaps.experiments.reproduce import FIGURES, named
from kfmaps.experiments.setting import Setting
from kfmaps.experiments.store import Report


def reproduce(
    figure: Annotated[
        str, typer.Argument(help="One of " + ", ".join(FIGURES) + "; or all.", metavar="FIGURE", show_default=False)
    ],
    data: Annotated[
        Path | None,
        typer.Option(help="Folder that holds FAUST, FAUST_r or both; default: generated shapes.", show_default=False),
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for tables, pictures and conclusions.")] = Path(
        "experiments-output"
    ),
    pairs: Annotated[int, typer.Option(min=1, help="Pairs of each data set that are reported.")] = 100,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes; default: one for each core.", show_default=False)
    ] = None,
    vertices: Annotated[int, typer.Option(min=1500, max=50000, help="Of a generated shape.")] = 2500,
    seed: Annotated[int, typer.Option(help="For the draw of pairs and samples.")] = 0,
) -> None:
    """Repeat experiments of the paper: a table, a picture and conclusions for each.

    Stopped and started again with the same output folder it goes on where it was.
    """
    names = named(figure)
    setting = Setting(data, output_folder(output), pairs, workers, vertices, seed=seed)
    found = setting.collections()
    console = Terminal()
    if data is None:
        console.print("No --data: using shapes that the package generates.")
    else:
        console.print("Data: " + ", ".join(str(c.folder) for c in found), highlight=False, soft_wrap=True)
    for name in names:
        with progress(name) as report:
            outcome = FIGURES[name](replace(setting, report=report))
        console.print(name, style="bold")
        for line in outcome.lines:
            console.print(f"  • {line}", highlight=False, soft_wrap=True)
        for path in (*outcome.tables, *outcome.pictures, outcome.conclusions):
            console.print(f"  {path}", highlight=False, soft_wrap=True)


@contextmanager
def progress(name: str) -> Iterator[Report]:
    """Finished jobs on standard error: a bar on a terminal, elsewhere a line for every tenth of them."""
    console = Terminal(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(name, total=None)

        def report(done: int, total: int) -> None:
            bar.update(task, completed=done, total=total)
            if not console.is_terminal and done and done % max(1, total // 10) == 0:
                print(f"{name}: {done} of {total}", file=sys.stderr, flush=True)

        yield report
