"""``kfmaps landmarks``: pick pairs on a local page, propagate landmarks to many scans, and review them."""

from __future__ import annotations

import shutil
import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer
from typer.core import TyperGroup

from kfmaps._arrays import KfmapsWarning, refuse
from kfmaps._texts import plural
from kfmaps.batch.landmark_tables import read_corrections, write_local_differences, write_study
from kfmaps.batch.layout import find_collection
from kfmaps.batch.plan import make_plan
from kfmaps.batch.progress import RunReport
from kfmaps.batch.run import run_batch
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.transfer_landmarks import (
    MATCHES,
    REVIEWED,
    SpecimenLandmarks,
    Template,
    correct_landmarks,
    correct_points,
    corrected_pairs,
    drop_unsure,
    propagate_landmarks,
    read_templates,
    template_errors,
    template_landmarks,
    template_pairs,
)
from kfmaps.cli.commands.batch import FAILED, INTERRUPTED, describe_plan, parse_workers
from kfmaps.cli.options import Json, Quiet, UpAxis, Workers
from kfmaps.cli.terminal import print_json
from kfmaps.config import Config
from kfmaps.io import check_output, read_mesh
from kfmaps.io.landmark_files import landmark_suffix
from kfmaps.io.mapfile import check_format
from kfmaps.io.named_points import read_given_landmarks
from kfmaps.settings import SettingsOptions, with_settings
from kfmaps.viz.document import forwarding_page
from kfmaps.viz.landmark_review import ReviewServer
from kfmaps.viz.page import check_up
from kfmaps.viz.picker import InteractiveMatcher, PickerServer, check_pairs
from kfmaps.viz.result_pages import open_page

_Port = Annotated[int, typer.Option(help="Port of this machine; 0 chooses a free one.", min=0, max=65535)]
_OpenPage = Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page.")]


class _PickByDefault(TyperGroup):
    """``kfmaps landmarks SOURCE TARGET`` is short for ``kfmaps landmarks pick SOURCE TARGET``."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        if args and args[0] not in (*self.commands, *ctx.help_option_names):
            args = ["pick", *args]
        return super().parse_args(ctx, args)


app = typer.Typer(
    cls=_PickByDefault,
    no_args_is_help=True,
    help="Pick landmarks on a local page, carry those of some specimens to a folder of scans, review them.",
)


@app.command("pick")
@with_settings
def pick(
    source: Annotated[Path, typer.Argument(help="The source mesh.")],
    target: Annotated[Path, typer.Argument(help="The target mesh.")],
    settings: SettingsOptions,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", help="Where the page saves them; default: landmarks.txt, or the file of --landmarks."
        ),
    ] = None,
    landmarks: Annotated[
        list[Path] | None,
        typer.Option("--landmarks", help="Pairs to begin with; given twice, the landmarks of SOURCE and of TARGET."),
    ] = None,
    map_output: Annotated[
        Path, typer.Option("--map", help="Where the page saves the map of a run: .npz, .mat, .txt or .vts.")
    ] = Path("map.npz"),
    up: UpAxis = None,
    port: _Port = 0,
    browser: _OpenPage = True,
    json: Json = False,
    force: Annotated[bool, typer.Option("--force", help="Save over an existing file without asking.")] = False,
) -> None:
    """Pick landmarks on a local page: click a point on one shape, then its match on the other.

    The settings are those of the matches that are run from the page.
    """
    check_up(up)
    landmark_files = landmarks or []
    output = output or (landmark_files[0] if len(landmark_files) == 1 else Path("landmarks.txt"))
    check_format(map_output)
    for path in (output, map_output):
        # The page asks before it replaces a file, the given landmarks too; it never replaces the shapes.
        check_output(path, True, (source, target) if path is output else (source, target, *landmark_files, output))
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):  # kfmaps match shows them
        shapes = read_mesh(source), read_mesh(target)
    initial, labels = np.zeros((0, 2), dtype=np.int64), []
    if landmark_files:
        initial, labels = read_given_landmarks(landmark_files, shapes, (source, target))
    pairs = check_pairs(initial.tolist(), *shapes)
    names = (source.stem, target.stem)
    matcher = InteractiveMatcher(shapes, names, (source, target), settings.config(Config()))
    serving = PickerServer(*shapes, names, output, force, pairs, labels, matcher, map_output, up, port)
    _serve(serving, {"output": [output, map_output]}, browser, json)


@app.command("transfer")
@with_settings
def transfer(
    scans: Annotated[Path, typer.Argument(help="A folder of meshes.", metavar="SCANS")],
    landmark_files: Annotated[
        list[Path],
        typer.Option(
            "--from",
            help="Landmarks of a scan, named like the scan: .mrk.json, .fcsv, .tps, .pts, .csv or .particles. "
            "With several, the median of their proposals is used.",
            metavar="FILE [FILE ...]",
        ),
    ],
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for everything.")],
    settings: SettingsOptions,
    more: Annotated[list[Path] | None, typer.Argument(hidden=True)] = None,
    min_confidence: Annotated[
        float | None, typer.Option(help="Landmarks below it become missing (NA).", min=0.0, max=1.0)
    ] = None,
    keep: Annotated[
        list[str] | None, typer.Option(help="Keep this specimen though it fits none of the others.", metavar="NAME")
    ] = None,
    workers: Workers = None,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Carry the landmarks of one or several specimens to all scans of a folder.

    A run that was stopped continues when the same command is given again.
    """
    processes = parse_workers(workers)
    collection = find_collection(scans)
    templates = read_templates([*landmark_files, *(more or ())], collection)
    for name in keep or ():
        if name not in collection.shapes:
            raise refuse("--keep", f"the name of a scan in {scans}", repr(name), "check the spelling")
    corrections = read_corrections(output)
    templates = [
        replace(one, points=correct_points(one.points, corrections.get(one.specimen, {}), one.mesh))
        for one in templates
    ]
    corrected = corrected_pairs(templates, collection, corrections, output / MATCHES / "corrected")
    collection = replace(collection, landmarks={}, pair_landmarks=corrected)
    spec = RunSpec(settings.config(Config()))
    plan = make_plan(collection, template_pairs(templates, collection), spec, output / MATCHES)
    with RunReport(quiet or json) as report:
        report.say(describe_plan(plan))
        batch_result = run_batch(
            plan, workers=processes, name=scans.resolve().name, worst=0, callback=report.status, progress=report.stage
        )
    if batch_result.interrupted:
        raise typer.Exit(INTERRUPTED)
    results = {r.pair: r for r in batch_result.results}
    own = {one.specimen: template_landmarks(one) for one in templates}
    study = []
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):  # the results have them
        for name in dict.fromkeys([*own, *collection.shapes]):  # templates first, in the order given
            maps = {pair.source: result for pair, result in results.items() if pair.target == name}
            path = collection.shapes[name]
            one = own.get(name) or propagate_landmarks(templates, name, path, maps, plan.folder)
            study.append(correct_landmarks(one, corrections.get(name, {})))
        errors = template_errors(templates, results, plan.folder)
        misfits = [one for one in study if one.misfit]
        study = [replace(one, misfit="") if one.specimen in (keep or ()) else one for one in study]
        if min_confidence is not None:
            study = [drop_unsure(one, min_confidence) for one in study]
        files = write_study(output, study, landmark_suffix(templates[0].file))
        files.append(output / "shape" / "local_differences.csv")
        write_local_differences(files[-1], study, templates[0], results, plan.folder)
    lines = _describe_study(study, templates, errors)
    for one in misfits:
        text = "kept" if one.specimen in (keep or ()) else f"left out (--keep {one.specimen} keeps it)"
        lines.append(f"{one.specimen} does not fit the others: {one.misfit}; {text}")
    lines += map(str, files)
    (output / "summary.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    for line in lines:
        report.say(line)
    if json:
        print_json({"summary": lines[: -len(files)], "output": files})
    if any(result.status == "failed" for result in batch_result.results):
        raise typer.Exit(FAILED)


@app.command("review")
def review(
    study: Annotated[Path, typer.Argument(help="A folder that landmarks transfer wrote.", metavar="STUDY")],
    up: UpAxis = None,
    port: _Port = 0,
    browser: _OpenPage = True,
    json: Json = False,
) -> None:
    """Look at the landmarks of each specimen on a local page, move those that are wrong, accept those that are right.

    Each save writes tables and statistics again. Running landmarks transfer again keeps the corrections and fits the
    maps of corrected specimens to them.
    """
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):  # kfmaps landmarks transfer has shown them
        _serve(ReviewServer(study, port, up), {"output": [study]}, browser, json)


def _serve(page_server: PickerServer | ReviewServer, fields: dict[str, object], browser: bool, json: bool) -> None:
    """Print the address of the page, open it, and serve it until the user interrupts."""
    if json:
        print_json({"address": page_server.address, **fields})
    else:
        typer.echo(page_server.address)
        typer.echo("Only this machine can reach it, and only with that address. Ctrl-C ends.")
    page_file = None
    try:
        if browser:  # by a file: the browser's command line, with a name in it, is there for all users to see
            page_file, has_browser = open_page(forwarding_page(page_server.address))
            if not has_browser and not json:
                typer.echo("No browser was found; open the address by hand.")
        page_server.serve_forever()
    except KeyboardInterrupt:
        if not json:
            typer.echo("Ended.")
    finally:
        page_server.close()
        if page_file is not None:
            shutil.rmtree(page_file.parent, ignore_errors=True)


def _describe_study(study: Sequence[SpecimenLandmarks], templates: Sequence[Template], errors: np.ndarray) -> list[str]:
    """Describe the result of a study in a few lines."""
    transferred = [one for one in study if one.verdict and not one.misfit]
    names = templates[0].points.names
    counts = plural(len(templates), "specimen"), plural(len(transferred), "other")
    line = f"{len(names)} landmarks of {counts[0]} carried to {counts[1]}"
    if transferred:
        confidence = np.concatenate([one.points.confidence for one in transferred])
        line += f", median confidence {np.nanmedian(confidence):.2f}" if np.isfinite(confidence).any() else ""
    lines = [line]
    flags = [(name, flag) for one in transferred for name, flag in zip(names, one.open_flags, strict=True) if flag]
    flagged = Counter(flags)
    if flagged:
        n_named = 8
        named = [f"{name} in {plural(n, 'specimen')} ({flag})" for (name, flag), n in flagged.most_common(n_named)]
        named += [f"{len(flagged) - n_named} other landmarks"] if len(flagged) > n_named else []
        lines.append(f"{flagged.total()} of {len(names) * len(transferred)} flagged: {'; '.join(named)}")
    elif transferred:
        lines.append("none flagged")
    done = Counter(flag for one in study for flag in one.flags if flag in REVIEWED)
    if done:
        lines.append(", ".join(f"{done[word]} {word}" for word in REVIEWED) + " by hand")
    missing = sum(int((one.points.vertices < 0).sum()) for one in transferred)
    if missing:
        lines.append(f"{missing} missing (NA)")
    if np.isfinite(errors).any():
        each = np.array([np.nanmean(column) if np.isfinite(column).any() else np.nan for column in errors.T])
        worst = int(np.nanargmax(each))
        text = f"the templates' landmarks, carried to each other, are off by {np.nanmean(errors):.3g} on average"
        lines.append(f"{text} in the scans' unit; most {names[worst]} ({each[worst]:.3g})")
    return lines
