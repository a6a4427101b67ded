"""``kfmaps landmarks transfer``: landmarks of one or several specimens on all scans of a folder."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from kfmaps._arrays import KfmapsWarning, refuse
from kfmaps.batch.landmark_tables import read_corrections, write_study
from kfmaps.batch.layout import find_collection
from kfmaps.batch.local_differences import write_local_differences
from kfmaps.batch.plan import make_plan
from kfmaps.batch.progress import RunReport
from kfmaps.batch.run import run_batch
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.transfer_landmarks import (
    MATCHES,
    REVIEWED,
    SpecimenLandmarks,
    Template,
    carry_templates,
    correct_landmarks,
    correct_points,
    corrected_pairs,
    drop_unsure,
    given_landmarks,
    read_templates,
    template_errors,
    template_pairs,
)
from kfmaps.cli.commands.batch import FAILED, INTERRUPTED, describe_plan, parse_workers
from kfmaps.cli.options import Json, Quiet, Workers
from kfmaps.cli.terminal import print_json
from kfmaps.cli.words import plural
from kfmaps.config import Config
from kfmaps.io.landmark_files import landmark_suffix
from kfmaps.settings.options import Chosen, with_settings

SHOWN = 8
"""Flagged landmarks that the summary names."""


@with_settings
def transfer(
    scans: Annotated[Path, typer.Argument(help="A folder of meshes.", metavar="SCANS")],
    given: Annotated[
        list[Path],
        typer.Option(
            "--from",
            help="Landmarks of a scan, called as the scan is: .mrk.json, .fcsv, .tps, .pts, .csv or .particles. "
            "Several give the median of what each of them proposes.",
            metavar="FILE [FILE ...]",
        ),
    ],
    output: Annotated[Path, typer.Option("-o", "--output", help="Folder for everything.")],
    settings: Chosen,
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

    Stopped and started again with the same arguments it goes on where it was.
    """
    count, scheduler = parse_workers(workers)
    collection = find_collection(scans)
    templates = read_templates([*given, *(more or ())], collection)
    for name in keep or ():
        if name not in collection.shapes:
            raise refuse("--keep", f"the name of a scan in {scans}", repr(name), "check the spelling")
    corrections = read_corrections(output)
    templates = [
        replace(one, points=correct_points(one.points, corrections.get(one.specimen, {}), one.mesh))
        for one in templates
    ]
    again = corrected_pairs(templates, collection, corrections, output / MATCHES / "corrected")
    collection = replace(collection, landmarks={}, pair_landmarks=again)
    spec = RunSpec(settings.config(Config()))
    plan = make_plan(collection, template_pairs(templates, collection), spec, output / MATCHES)
    with RunReport(quiet or json) as report:
        report.say(describe_plan(plan))
        outcome = run_batch(
            plan,
            workers=count,
            scheduler=scheduler,
            name=scans.resolve().name,
            worst=0,
            callback=report.status,
            progress=report.stage,
        )
    if outcome.interrupted:
        raise typer.Exit(INTERRUPTED)
    results = {r.pair: r for r in outcome.results}
    own = {one.specimen: given_landmarks(one) for one in templates}
    study = []
    with warnings.catch_warnings(action="ignore", category=KfmapsWarning):  # the results say what is odd
        for name in dict.fromkeys([*own, *collection.shapes]):  # templates first, in the order given
            maps = {pair.source: result for pair, result in results.items() if pair.target == name}
            one = own.get(name) or carry_templates(templates, name, collection.shapes[name], maps, plan.folder)
            study.append(correct_landmarks(one, corrections.get(name, {})))
        errors = template_errors(templates, results, plan.folder)
        said = [one for one in study if one.misfit]
        study = [replace(one, misfit="") if one.specimen in (keep or ()) else one for one in study]
        if min_confidence is not None:
            study = [drop_unsure(one, min_confidence) for one in study]
        files = write_study(output, study, landmark_suffix(templates[0].file))
        files.append(output / "shape" / "local_differences.csv")
        write_local_differences(files[-1], study, templates[0], results, plan.folder)
    lines = [*_describe_study(study, templates, errors), *_misfits(said, keep or ()), *(f"{file}" for file in files)]
    (output / "summary.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    for line in lines:
        report.say(line)
    if json:
        print_json({"summary": lines[: -len(files)], "output": files})
    if any(result.status == "failed" for result in outcome.results):
        raise typer.Exit(FAILED)


def _describe_study(study: Sequence[SpecimenLandmarks], templates: Sequence[Template], errors: np.ndarray) -> list[str]:
    """What came of a study, in a few lines."""
    carried = [one for one in study if one.verdict and not one.misfit]
    names = templates[0].points.names
    told = f"{len(names)} landmarks of {plural(len(templates), 'specimen')} carried to {plural(len(carried), 'other')}"
    if carried:
        sure = np.concatenate([one.points.confidence for one in carried])
        told += f", median confidence {np.nanmedian(sure):.2f}" if np.isfinite(sure).any() else ""
    lines = [told]
    flagged = Counter((name, flag) for one in carried for name, flag in zip(names, one.open_flags, strict=True) if flag)
    if flagged:
        told = [f"{name} in {plural(count, 'specimen')} ({flag})" for (name, flag), count in flagged.most_common(SHOWN)]
        told += [f"{len(flagged) - SHOWN} other landmarks"] if len(flagged) > SHOWN else []
        lines.append(f"{flagged.total()} of {len(names) * len(carried)} flagged: {'; '.join(told)}")
    elif carried:
        lines.append("none flagged")
    done = Counter(flag for one in study for flag in one.flags if flag in REVIEWED)
    if done:
        lines.append(", ".join(f"{done[word]} {word}" for word in REVIEWED) + " by hand")
    missing = sum(int((one.points.vertices < 0).sum()) for one in carried)
    if missing:
        lines.append(f"{missing} missing (NA)")
    if np.isfinite(errors).any():
        each = np.array([np.nanmean(column) if np.isfinite(column).any() else np.nan for column in errors.T])
        worst = int(np.nanargmax(each))
        text = f"the templates' landmarks, carried to each other, are off by {np.nanmean(errors):.3g} on average"
        lines.append(f"{text} in the scans' unit; most {names[worst]} ({each[worst]:.3g})")
    return lines


def _misfits(study: Sequence[SpecimenLandmarks], keep: Sequence[str]) -> list[str]:
    return [
        f"{one.specimen} does not fit the others: {one.misfit}; "
        + ("kept" if one.specimen in keep else f"left out (--keep {one.specimen} keeps it)")
        for one in study
    ]
