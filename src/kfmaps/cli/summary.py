"""The summary of a match as a table for people."""

from __future__ import annotations

import re
from pathlib import Path
from shlex import quote

import numpy as np
from rich.table import Table
from rich.text import Text

from kfmaps._arrays import printable
from kfmaps._texts import UNIT, percent, probability_text, verdict_text
from kfmaps.evaluation import Accuracy
from kfmaps.geometry.mesh import Mesh
from kfmaps.kernels.transformed import descriptor_width
from kfmaps.matching.finish import low_confidence_area
from kfmaps.matching.orientation import orientation_text
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ONE_FIT
from kfmaps.matching.score import SCORE

_STYLES = {"likely": "bold yellow", "ambiguous": "bold red", "unlikely": "bold red"}
"""Styles of verdicts that must not be overlooked in a table."""

_SHAPE_OPTIONS = " --source {} --target {}"  # for formats that do not name their shapes


def table(match: Match, accuracy: Accuracy | None = None, written: Path | None = None) -> Table:
    """Return the summary: the shapes, the verdict, oddities, the time, and the next command."""
    grid = Table(show_header=False, box=None, pad_edge=False)
    grid.add_column(style="bold", no_wrap=True)
    grid.add_column(overflow="fold")
    for name, value in _rows(match, accuracy, written):
        grid.add_row(name, Text(value, style=_STYLES.get(match.verdict, "") if name == "verdict" else ""))
    return grid


def _rows(match: Match, accuracy: Accuracy | None, written: Path | None) -> list[tuple[str, str]]:
    """Return names and values of the table's rows."""
    n_landmarks, rejected, fit = len(match.landmarks), match.score.rejected_landmarks, match.fit
    probability = "" if match.confidence is None else f", {probability_text(match.confidence)}"
    sides = ((match.source, match.source_file), (match.target, match.target_file))
    rows = [
        ("matched", " → ".join(_shape(mesh, Path(file.path).name) for mesh, file in sides)),
        ("verdict", f"{match.verdict.capitalize()}{probability}. {verdict_text(match.verdict, n_landmarks)}"),
    ]
    if (share := _doubtful_area(match)) > SCORE.max_torn_area:
        rows.append(("doubtful", f"one region, {share:.0%} of the target's area: its local fit is below one half"))
    if match.partial.suspected:
        rows.append(("parts", match.partial.reason))
    if n_unmatched := int((match.target_to_source < 0).sum()):
        n_t = len(match.target_to_source)
        rows.append(("no counterpart", f"{n_unmatched:,} of the target's {n_t:,} vertices: they are -1 in the map"))
    if accuracy is not None:
        rows.append(("error", _errors_text(accuracy)))
    if orientation := orientation_text(match, match.source, match.target):
        rows.append(("orientation", orientation))
    if n_landmarks:
        numbers = ", ".join(str(number) for number in rejected)
        left_out = f"; left out, since the map contradicts them: number {numbers}, counted from 0" if numbers else ""
        is_held = match.registration.report is None or match.registration.report.landmarks_held
        warning = "" if is_held else "; most are 4 % of √area or more from the map, so they do not hold it"
        if 2 * len(rejected) > n_landmarks:
            warning += ". Are left and right exchanged in a list, or is a shape mirrored (--orientation reversing)?"
        rows.append(("landmarks", f"{n_landmarks}{left_out}{warning}"))
    if fit.weights is not None:
        group, least = match.config.formulation.loss_group, np.argsort(fit.weights)[:3]
        text = ", ".join(f"{group} {number} {fit.weights[number]:.2f}" for number in least)
        rows.append(("least weight", f"{text} (counted from 0; 1 is full weight)"))
    kernel = re.sub(r"\d+\.\d{5,}", lambda number: f"{float(number[0]):.4g}", fit.kernel)
    if match.score.initialization == ONE_FIT and fit.status is not None:
        steps = f" in {fit.steps} steps" if fit.steps else ""
        rows.append(("fit", f"{kernel}, {fit.rank} features; {fit.status}{steps}"))
    elif match.confidence is not None:
        part = f"{kernel}, in the initial map" if kernel else "had no part in this map"
        learned = "a search leaves the learned one out; --set search=none takes it"
        rows.append(("kernel", part if descriptor_width(match.config.kernel) is None else learned))
    stages = sorted(match.seconds.items(), key=lambda item: -item[1])
    longest = ", ".join(f"{name} {seconds:.1f}" for name, seconds in stages[:3])
    rows.append(("time", f"{sum(match.seconds.values()):.1f} s, most of it for: {longest}"))
    if written is not None:
        shapes = (
            ""
            if written.suffix.lower() in (".npz", ".mat")
            else _SHAPE_OPTIONS.format(*(quote(f.path) for _, f in sides))
        )
        rows.append(("written", printable(str(written))))
        rows.append(("next", printable(f"kfmaps view {quote(str(written))}{shapes}")))
    return rows


def _doubtful_area(match: Match) -> float:
    """Return the share of the target's area with a low local fit; 0 without a good verdict and for parts."""
    if len(match.target.faces) == 0 or match.verdict not in ("sure", "likely") or match.partial.which != "none":
        return 0.0
    left_out = match.local_confidence == 0  # cleaning has
    return low_confidence_area(match.target, np.where(left_out, 1.0, match.local_confidence))


def _shape(mesh: Mesh, name: str) -> str:
    kind = f"{len(mesh.vertices):,} vertices" if len(mesh.faces) else f"{len(mesh.vertices):,} points"
    return f"{printable(name)} ({kind})"


def _errors_text(accuracy: Accuracy) -> str:
    """Return the errors in one line."""
    e = accuracy.errors
    return (
        f"mean {percent(e.mean)}, median {percent(e.median)}, worst {percent(e.worst)} {UNIT}; "
        f"area under the curve to {100 * e.auc_limit:g} %: {e.auc:.4f}"
    )
