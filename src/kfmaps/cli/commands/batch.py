"""``kfmaps batch``: whole collections, in parallel, resumed where they stopped."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Annotated

import typer
from rich.text import Text

from kfmaps._arrays import InvalidInput, KfmapsWarning, check_count, refuse
from kfmaps._threads import available_cores
from kfmaps.batch.collection import BatchOutcome, match_collection
from kfmaps.batch.consistent import Agreed
from kfmaps.batch.graphing import graph_pairs
from kfmaps.batch.layout import Pair, choose_pairs, find_collection
from kfmaps.batch.need import needed
from kfmaps.batch.plan import Plan, make_plan, recommended
from kfmaps.batch.settings import Settings
from kfmaps.batch.spread import crew
from kfmaps.batch.summary import summarised
from kfmaps.batch.terminal import stage_lines, terminal_callback
from kfmaps.cli.terminal import Terminal
from kfmaps.cli.words import UNIT, percent
from kfmaps.io import atomic_output, read_mesh
from kfmaps.settings.options import Chosen, with_settings
from kfmaps.settings.toml import settings_text

TOML = "settings.toml"
"""In the output folder, for ``kfmaps match --config``."""
MANY = 20
"""Pairs from which it is told before what they need."""
FAILED, INTERRUPTED = 1, 130
"""Exit status when a pair failed, and after Ctrl-C."""


@with_settings
def batch(
    folder: Annotated[Path, typer.Argument(help="A folder of shapes.", metavar="DIR", show_default=False)],
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for everything.", show_default=False)],
    settings: Chosen,
    pairs: Annotated[
        Path | None,
        typer.Option(help="Two names a line; default: the folder's test_pairs.txt.", show_default=False),
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="Every shape to every other, both ways.")] = False,
    star: Annotated[
        str | None, typer.Option(help="This shape to all others.", metavar="SHAPE", show_default=False)
    ] = None,
    graph: Annotated[
        str | None,
        typer.Option(
            help="Choose pairs by the shapes: near (each with those most like it), star or all.",
            metavar="near|star|all",
            show_default=False,
        ),
    ] = None,
    consistent: Annotated[
        bool,
        typer.Option("--consistent", help="Make the maps agree over cycles: exchange those that others contradict."),
    ] = False,
    identity: Annotated[bool, typer.Option("--identity", help="Truth: vertex i is vertex i.")] = False,
    truth_landmarks: Annotated[
        str | None,
        typer.Option(
            help="Landmarks: these lines of the truth, counted from 1.", metavar="201,1121,...", show_default=False
        ),
    ] = None,
    landmarks: Annotated[bool, typer.Option(help="Whether to use landmarks that the folder has.")] = True,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes; default: one for each core.", show_default=False)
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(help="Use the workers of this Dask scheduler.", metavar="ADDRESS", show_default=False),
    ] = None,
    cache: Annotated[
        Path | None, typer.Option(help="Folder for prepared shapes; default: in the output.", show_default=False)
    ] = None,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Try failed pairs again.")] = False,
    worst: Annotated[int, typer.Option(min=0, help="Worst pairs shown as pictures in the summary.")] = 6,
    seed: Annotated[int, typer.Option(min=0, help="For everything that is drawn at random.")] = 0,
    quiet: Annotated[bool, typer.Option("-q", "--quiet", help="Say nothing.")] = False,
) -> None:
    """Match many pairs in parallel: a table, every map and a summary page.

    Stopped and started again with the same arguments it goes on where it was.
    """
    if scheduler is not None and workers is not None:
        raise refuse("--workers", "no --scheduler beside it", "both", "the scheduler has its own workers")
    lines = _lines(truth_landmarks)
    collection = find_collection(folder)
    console = Terminal(highlight=False)
    if graph is not None:
        if pairs is not None or every or star is not None:
            raise refuse("pairs", "one of --graph, --pairs, --all and --star", "several", "leave the others out")
        config = settings.config(
            recommended(collection, [Pair(n, n) for n in collection.shapes], bool(lines), landmarks)
        )
        made = Settings(config, seed, lines, landmarks, identity)
        with stage_lines(console, quiet) as told, crew(workers, scheduler, told) as hands:
            chosen = graph_pairs(collection, made, output, graph, hands, cache_folder=cache)
    else:
        chosen = choose_pairs(collection, file=pairs, every=every, star=star)
        config = settings.config(recommended(collection, chosen, bool(lines), landmarks))
        made = Settings(config, seed, lines, landmarks, identity)
    plan = make_plan(collection, chosen, made, output, cache_folder=cache, retry_failed=retry_failed)
    if not (plan.folder / TOML).exists():
        with atomic_output(plan.folder / TOML) as temporary:
            temporary.write_text(settings_text(config), encoding="utf-8")
    if not quiet:
        console.print(Text(_before(plan, workers, consistent)), soft_wrap=True)
    with terminal_callback(console, quiet) as callback, stage_lines(console, quiet) as told:
        outcome = match_collection(
            plan,
            workers=workers,
            scheduler=scheduler,
            name=folder.resolve().name,
            worst=worst,
            callback=callback,
            consistent=consistent,
            told=told,
        )
    if not quiet:
        for line in _after(plan, outcome):
            console.print(Text(line), soft_wrap=True)
    if outcome.interrupted:
        raise typer.Exit(INTERRUPTED)
    if any(result.status == "failed" for result in outcome.results):
        raise typer.Exit(FAILED)


def _lines(text: str | None) -> tuple[int, ...]:
    """The numbers of ``--truth-landmarks``."""
    words = [] if text is None else text.replace(",", " ").split()
    if text is not None and not words:
        raise refuse("--truth-landmarks", "line numbers", "none", "write them with commas between")
    try:
        return tuple(check_count(int(word), "--truth-landmarks") for word in words)
    except ValueError as error:
        wanted = "whole numbers from 1 on, with commas between"
        raise refuse("--truth-landmarks", wanted, repr(text), "count lines from 1") from error


def _before(plan: Plan, workers: int | None, consistent: bool) -> str:
    """What there is to do, and for many pairs what that needs."""
    shapes = len({name for task in plan.tasks for name in (task.pair.source, task.pair.target)})
    told = [f"{len(plan.tasks)} pairs of {shapes} shapes"]
    told += [f"{len(plan.results)} done already"] if plan.results else []
    told += [f"{plan.changed} to do again since their files have changed"] if plan.changed else []
    if len(plan.todo) >= MANY:
        vertices = _vertices(plan)
        if vertices:
            left = {name for task in plan.todo for name in (task.pair.source, task.pair.target)}
            count = available_cores() if workers is None else workers
            need = needed(len(left), len(plan.todo), vertices, plan.settings.config, count, consistent=consistent)
            return f"{', '.join(told)}; {need.told()}"
    return ", ".join(told)


def _vertices(plan: Plan) -> int:
    """Of the first shape that is to be matched; 0 where it cannot be read, which is told with its pairs."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", KfmapsWarning)
            return len(read_mesh(plan.todo[0].source.path).vertices)
    except (InvalidInput, OSError):
        return 0


def _after(plan: Plan, outcome: BatchOutcome) -> list[str]:
    """What came of it."""
    numbers = summarised(outcome.results)
    lines = []
    if outcome.interrupted:
        left = len(plan.tasks) - len(outcome.results)
        lines.append(f"interrupted with {left} pairs left; the same command goes on")
    if numbers.failed:
        pairs = "1 pair" if numbers.failed == 1 else f"{numbers.failed} pairs"
        lines.append(f"{pairs} failed; the summary says why, and --retry-failed tries again")
    if numbers.error_mean is not None:
        lines.append(
            f"mean error {percent(numbers.error_mean)} {UNIT} over {numbers.evaluated} pairs"
            f" (median pair {percent(numbers.error_median)}, worst {percent(numbers.error_worst)})"
        )
    verdicts = ", ".join(f"{count} {verdict}" for verdict, count in numbers.verdicts.items() if verdict)
    lines += [f"verdicts: {verdicts}"] if verdicts else []
    lines += [] if outcome.agreed is None else _agreed(outcome.agreed)
    return lines + [str(path) for path in outcome.files]


def _agreed(found: Agreed) -> list[str]:
    """Which pairs were exchanged, for what and why."""
    pairs = "1 pair" if found.exchanged == 1 else f"{found.exchanged} pairs"
    lines = [
        f"{pairs} exchanged, since others contradict them" if found.exchanged else "all maps agree: none exchanged"
    ]
    lines = lines if found.exchanged or not found.doubted else ["no pair exchanged"]
    for r in found.results:
        if r.changed:
            errors = (
                "" if r.error_mean is None else f"; error {percent(r.error_before)}, now {percent(r.error_mean)} {UNIT}"
            )
            lines.append(f"  {r.source} → {r.target}: {r.changed}; {r.why}{errors}")
    lines += [f"  doubted, kept: {line}" for line in found.doubted]
    return lines + [f"  {note}" for note in found.notes]
