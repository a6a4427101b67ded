"""``kfmaps tune``: a grid search over settings on training pairs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from kfmaps._arrays import refuse
from kfmaps.cli.commands.reproduce import progress
from kfmaps.cli.terminal import Terminal
from kfmaps.descriptors.spectral import NORMALISATIONS, Normalisation
from kfmaps.experiments.collections import Collection, ShapePair
from kfmaps.experiments.outputs import output_folder, write_table
from kfmaps.experiments.setting import Setting
from kfmaps.experiments.tune import Grid, Tuned, grid_search
from kfmaps.io import atomic_output, read_text
from kfmaps.settings.merge import preset, read_settings
from kfmaps.settings.toml import settings_text

SHOWN = 10
"""Candidates that the terminal shows."""

DEFAULT = Grid(sharpness=(0.1, 0.3, 1.0), alpha=(0.1, 1.0, 10.0))


def tune(
    data: Annotated[
        Path | None,
        typer.Option(help="Folder that holds FAUST, FAUST_r or both; default: generated shapes.", show_default=False),
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for tune.csv and tune.toml.")] = Path(
        "tune-output"
    ),
    base: Annotated[
        str, typer.Option(help="Settings to vary: a preset (default, paper, no17, obcs12), or a settings file.")
    ] = "default",
    gamma: Annotated[str, typer.Option(help="Widths γ to try, with commas.", metavar="NUMBERS")] = "",
    sharpness: Annotated[str, typer.Option(help="Widths without unit to try.", metavar="NUMBERS")] = "",
    normalisation: Annotated[str, typer.Option(help="Normalisations to try.", metavar="NAMES")] = "",
    alpha: Annotated[str, typer.Option(help="Weights of the Laplacian term to try.", metavar="NUMBERS")] = "",
    samples: Annotated[str, typer.Option(help="Numbers of Nyström samples to try.", metavar="NUMBERS")] = "",
    descriptors: Annotated[str, typer.Option(help="Numbers of descriptors to try.", metavar="NUMBERS")] = "",
    pairs: Annotated[
        int, typer.Option(min=1, help="Training pairs of each data set, drawn among its first two people.")
    ] = 4,
    pair_list: Annotated[
        Path | None,
        typer.Option(
            "--pairs-from", help="Training pairs instead: a file of lines “source target”.", show_default=False
        ),
    ] = None,
    refined: Annotated[bool, typer.Option("--refined/--raw", help="Judge the refined map, or the raw one.")] = False,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes; default: one for each core.", show_default=False)
    ] = None,
    vertices: Annotated[int, typer.Option(min=1500, max=50000, help="Of a generated shape.")] = 2500,
    seed: Annotated[int, typer.Option(help="For the draw of pairs.")] = 0,
) -> None:
    """Try settings on training pairs and write the best for ``kfmaps match --config``.

    Without any list it varies the kernel's width and the weight of the Laplacian term. Stopped and started again
    with the same output folder it goes on where it was.
    """
    given = Grid(
        numbers(gamma, "--gamma"),
        numbers(sharpness, "--sharpness"),
        names(normalisation),
        numbers(alpha, "--alpha"),
        counts(samples, "--samples", low=2),
        counts(descriptors, "--descriptors"),
    )
    grid = given if given != Grid() else DEFAULT
    start = read_settings(base, preset("default")) if Path(base).suffix == ".toml" else preset(base)
    grid.candidates(start)  # what no setting may be is said before any work
    setting = Setting(data, output_folder(output), workers=workers, vertices=vertices, seed=seed)
    chosen = [(c, training(c, pairs, seed, pair_list)) for c in setting.collections()]
    chosen = [(c, some) for c, some in chosen if some]
    if not chosen:
        raise refuse(f"pairs {pair_list}", "pairs of shapes in the data", "none", "check the names")
    console = Terminal()
    if data is None:
        console.print("No --data: using shapes that the package generates.")
    with progress("tune") as report:
        found = grid_search(
            Setting(data, output, 1, workers, vertices, seed=seed, report=report), start, grid, chosen, refined
        )
    table = write_table(output / "tune.csv", found.table)
    settings = output / "tune.toml"
    with atomic_output(settings, force=True) as temporary:
        temporary.write_text(settings_text(found.best), encoding="utf-8")
    show(console, found)
    console.print(f"best: {found.name}", f"table: {table}", f"settings: {settings}", sep="\n", soft_wrap=True)


def training(collection: Collection, count: int, seed: int, pair_list: Path | None) -> list[ShapePair]:
    """Training pairs of a data set: those of the list that it has, or drawn ones."""
    if pair_list is None:
        return collection.training(count, seed)
    known = set(collection.shapes())
    lines = [line.split() for line in read_text(pair_list).splitlines() if line.strip()]
    for number, words in enumerate(lines, start=1):
        if len(words) != 2:
            raise refuse(f"{pair_list}, line {number}", "source and target", " ".join(words), "write two names a line")
    return [ShapePair(a, b) for a, b in lines if a in known and b in known]


def numbers(text: str, flag: str) -> tuple[float, ...]:
    """The numbers of a list with commas, all of them finite.

    Raises
    ------
    InvalidInput
        On anything else.
    """
    try:
        found = tuple(float(part) for part in text.split(",") if part.strip())
    except ValueError as error:
        raise refuse(flag, "numbers with commas between them", repr(text), "for instance 0.1,0.3,1") from error
    for value in found:
        if not math.isfinite(value):
            raise refuse(flag, "finite numbers", f"{value}", "for instance 0.1,0.3,1")
    return found


def counts(text: str, flag: str, low: int = 1) -> tuple[int, ...]:
    """The whole numbers of a list with commas, none below ``low``.

    Raises
    ------
    InvalidInput
        On anything else.
    """
    for value in numbers(text, flag):
        if value != int(value) or value < low:
            raise refuse(flag, f"whole numbers from {low} on", f"{value:g}", "for instance 100,200")
    return tuple(int(value) for value in numbers(text, flag))


def names(text: str) -> tuple[Normalisation, ...]:
    """The normalisations of a list with commas."""
    known: dict[str, Normalisation] = {name: name for name in NORMALISATIONS}
    words = [part.strip() for part in text.split(",") if part.strip()]
    for word in words:
        if word not in known:
            raise refuse("--normalisation", "among " + ", ".join(NORMALISATIONS), repr(word), "choose from them")
    return tuple(known[word] for word in words)


def show(console: Console, found: Tuned) -> None:
    """The best candidates as a table."""
    table = Table()
    for column in found.table[0]:
        table.add_column(column, justify="left" if column == "settings" else "right")
    for row in found.table[:SHOWN]:
        table.add_row(*(f"{v:.3f}" if isinstance(v, float) else str(v) for v in row.values()))
    console.print(table)
