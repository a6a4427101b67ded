"""``kfmaps batch``: whole collections, in parallel, resumed where they stopped."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from kfmaps._arrays import check_count, refuse
from kfmaps._texts import UNIT, percent, plural
from kfmaps.batch.consistent import ConsistentResult
from kfmaps.batch.jobs import WorkerPool
from kfmaps.batch.layout import find_collection, read_pairs
from kfmaps.batch.plan import GRAPHS, Plan, graph_pairs, make_plan
from kfmaps.batch.progress import RunReport, log_to
from kfmaps.batch.results import summarize
from kfmaps.batch.run import BatchResult, run_batch
from kfmaps.batch.run_spec import RunSpec
from kfmaps.cli.options import UNSURE, Identity, Json, Quiet, Require, Workers, check_required, line_numbers, meets
from kfmaps.cli.terminal import print_json
from kfmaps.config import Config
from kfmaps.io.atomic import write_text
from kfmaps.settings import SettingsOptions, settings_text, with_settings

_TOML = "settings.toml"  # in the output folder, for ``kfmaps match --config``
FAILED, INTERRUPTED = 1, 130
"""Exit status when a pair failed, and after Ctrl-C."""


@with_settings
def batch(
    folder: Annotated[Path, typer.Argument(help="A folder of shapes.", metavar="DIR")],
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for everything.")],
    settings: SettingsOptions,
    pairs: Annotated[Path | None, typer.Option(help="Two names per line; default: the folder's test_pairs.txt")] = None,
    graph: Annotated[
        str | None,
        typer.Option(
            help="Choose pairs: near (each shape with those most like it), star (one with all others; star:SHAPE: "
            "this one), all (every pair one way), both (every pair both ways).",
            metavar=GRAPHS.replace(", ", "|").replace(" or ", "|"),
        ),
    ] = None,
    consistent: Annotated[
        bool,
        typer.Option("--consistent", help="Make the maps agree over cycles: exchange those that others contradict."),
    ] = False,
    identity: Identity = False,
    landmarks: Annotated[
        str | None,
        typer.Option(
            help="Landmarks: these lines of the truth, counted from 1; or none. Default: those that the folder has.",
            metavar="201,1121,...|none",
        ),
    ] = None,
    workers: Workers = None,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Try failed pairs again.")] = False,
    seed: Annotated[int, typer.Option(min=0, help="For everything that is drawn at random.")] = 0,
    require: Require = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Match many pairs in parallel: a table, every map and a summary page.

    A run that was stopped continues when the same command is given again.
    """
    check_required(require)
    processes = parse_workers(workers)
    landmark_files = landmarks is None
    lines = () if landmarks in (None, "none") else line_numbers(landmarks, "--landmarks")
    if graph is not None and pairs is not None:
        raise refuse("pairs", "one of --graph and --pairs", "both", "leave one out")
    collection = find_collection(folder)
    listed = [] if graph is not None else read_pairs(collection, pairs)
    config = settings.config(Config())
    spec = RunSpec(config, seed, lines, landmark_files, identity)
    with RunReport(quiet or json) as report:
        if graph is not None:
            with WorkerPool(processes, report.stage, log_to(output)) as pool:
                listed = graph_pairs(collection, spec, output, graph, pool)
        plan = make_plan(collection, listed, spec, output, retry_failed=retry_failed)
        if not (plan.folder / _TOML).exists():
            write_text(plan.folder / _TOML, settings_text(config))
        report.say(describe_plan(plan))
        outcome = run_batch(
            plan,
            workers=processes,
            name=folder.resolve().name,
            callback=report.status,
            consistent=consistent,
            progress=report.stage,
        )
    for line in _describe_outcome(plan, outcome):
        report.say(line)
    if json:
        n_left = len(plan.tasks) - len(outcome.results)
        print_json({**summarize(outcome.results), "left": n_left, "output": outcome.files})
    if outcome.interrupted:
        raise typer.Exit(INTERRUPTED)
    if any(result.status == "failed" for result in outcome.results):
        raise typer.Exit(FAILED)
    if not all(meets(result.verdict, require) for result in outcome.results):
        raise typer.Exit(UNSURE)


def parse_workers(text: str | None) -> int | str | None:
    """Return the number of ``--workers``, or the address of a scheduler."""
    return check_count(int(text), "--workers") if text and text.lstrip("-").isdecimal() else text


def describe_plan(plan: Plan) -> str:
    """Return the amount of work in words."""
    count = len(plan.tasks)
    shapes = len({name for task in plan.tasks for name in (task.pair.source, task.pair.target)})
    parts = [f"{plural(count, 'pair')} of {shapes} shapes"]
    parts += [f"{len(plan.results)} done already"] if plan.results else []
    parts += [f"{plan.changed} to do again since their files have changed"] if plan.changed else []
    return ", ".join(parts)


def _describe_outcome(plan: Plan, batch_result: BatchResult) -> list[str]:
    """Return the result of a run as lines of text."""
    numbers = summarize(batch_result.results)
    lines = []
    if batch_result.interrupted:
        n_left = len(plan.tasks) - len(batch_result.results)
        lines.append(f"interrupted with {plural(n_left, 'pair')} left; the same command goes on")
    if failed := numbers["failed"]:
        lines.append(f"{plural(failed, 'pair')} failed; the summary says why, and --retry-failed tries again")
    if numbers["error_mean"] is not None:
        mean, median, worst = (percent(numbers[f"error_{name}"]) for name in ("mean", "median", "worst"))
        pairs = plural(numbers["evaluated"], "pair")
        lines.append(f"mean error {mean} {UNIT} over {pairs} (median pair {median}, worst {worst})")
    verdicts = ", ".join(f"{count} {verdict}" for verdict, count in numbers["verdicts"].items() if verdict)
    lines += [f"verdicts: {verdicts}"] if verdicts else []
    lines += [] if batch_result.consistent is None else _describe_consistent(batch_result.consistent)
    return lines + [str(path) for path in batch_result.files]


def _describe_consistent(consistent: ConsistentResult) -> list[str]:
    """Return lines of text: which maps were replaced, by what and why."""
    lines = ["no map replaced" if consistent.doubted else "all maps agree: none replaced"]
    if consistent.before:
        lines = [f"{plural(len(consistent.before), 'map')} replaced that others contradict"]
    for r in consistent.results:
        if r.changed:
            errors = (
                "" if r.error_mean is None else f"; error {percent(r.error_before)}, now {percent(r.error_mean)} {UNIT}"
            )
            lines.append(f"  {r.pair}: {r.changed}; {r.why}{errors}")
    lines += [f"  doubted, kept: {line}" for line in consistent.doubted]
    return lines + [f"  {note}" for note in consistent.notes]
