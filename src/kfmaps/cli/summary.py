"""What a match tells of itself: for machines, for people, and beside the map in its file."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from rich.table import Table
from rich.text import Text

from kfmaps._arrays import shown
from kfmaps.cli.evaluation import Accuracy
from kfmaps.cli.words import LOUD, UNIT, percent, verdict_line
from kfmaps.io.map_summary import summarize
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ONE_FIT


def summary(match: Match, accuracy: Accuracy | None = None) -> dict[str, Any]:
    """Return the plain values of ``kfmaps match --json``; errors are in units of √area."""
    return {**summarize(match), "errors": None if accuracy is None else accuracy.as_dict()}


def table(match: Match, accuracy: Accuracy | None = None, written: Path | None = None) -> Table:
    """Return the summary for people."""
    grid = Table(show_header=False, box=None, pad_edge=False)
    grid.add_column(style="bold", no_wrap=True)
    grid.add_column(overflow="fold")
    for name, value in _rows(match, accuracy):
        loud = value.startswith(tuple(f"{kind.upper()}:" for kind in LOUD))
        grid.add_row(name, Text(value, style="bold red" if loud else ""))
    if written is not None:
        grid.add_row("written", Text(shown(str(written))))
    return grid


def _rows(match: Match, accuracy: Accuracy | None) -> list[tuple[str, str]]:
    """Names and values of the table."""
    rows = [("verdict", _verdict(match))]
    if match.partial.which != "none" or match.partial.reason.startswith("taken for whole"):
        rows.append(("parts", match.partial.reason))
    if lost := int((match.target_to_source < 0).sum()):
        n_t = len(match.target_to_source)
        rows.append(("no counterpart", f"{lost:,} of the target's {n_t:,} vertices: they are -1 in the map"))
    if accuracy is not None:
        rows.append(("error", errors_text(accuracy)))
    for side, mesh, file in (("source", match.source, match.source_file), ("target", match.target, match.target_file)):
        what = f"{len(mesh.faces):,} faces" if len(mesh.faces) else "a point cloud"
        rows.append((side, f"{shown(Path(file.path).name)}: {len(mesh.vertices):,} vertices, {what}"))
    rows.append(("landmarks", str(len(match.landmarks)) if len(match.landmarks) else "none"))
    if match.orientation == "reversing":
        rows.append(("orientation", "reversed: the target is matched as the mirror image of the source"))
    if len(match.score.rejected_landmarks):
        numbers = ", ".join(str(number) for number in match.score.rejected_landmarks)
        rows.append(
            ("doubted", f"landmark {numbers}, counted from 0: the map keeps to the others, and they had no say")
        )
    fit, size = match.fit, "{} × {}".format(*match.functional_map.shape)
    if fit.weights is not None:
        per, least = match.config.formulation.loss_group, np.argsort(fit.weights)[:3]
        told = ", ".join(f"{per} {number} {fit.weights[number]:.2f}" for number in least)
        rows.append(("believed least", f"{told} (counted from 0; 1 is fully)"))
    started = "" if match.score.initialization == ONE_FIT else f", started from {match.score.initialization}"
    if fit.status is None or fit.raw_functional_map is None:
        rows.append(("map", f"{size}{started}"))
    else:
        kernel = re.sub(r"\d+\.\d{5,}", lambda number: f"{float(number[0]):.4g}", fit.kernel)
        operators = f", {fit.n_operators} operators" if fit.n_operators else ""
        fitted = "{} × {}".format(*fit.raw_functional_map.shape)
        residual = f", residual {fit.residuals[-1]:.1e}" if len(fit.residuals) else ""
        rows += [
            ("kernel", f"{kernel}: {fit.rank} features{operators}"),
            ("map", f"{size}{started or f', fitted at {fitted}'}"),
            ("solver", fit.status + (f" in {fit.steps} steps" if fit.steps else "") + residual),
            ("energy", ", ".join(f"{name} {value:.4g}" for name, value in fit.energies.items())),
        ]
    spent = sorted(match.seconds.items(), key=lambda item: -item[1])
    rows.append(("time", f"{sum(match.seconds.values()):.1f} s: " + ", ".join(f"{name} {t:.2f}" for name, t in spent)))
    return rows


def _verdict(match: Match) -> str:
    text = verdict_line(match.verdict)
    return text if match.confidence is None else f"{text} (confidence {match.confidence:.2f})"


def errors_text(accuracy: Accuracy) -> str:
    """Errors in one line."""
    e = accuracy.errors
    return (
        f"mean {percent(e.mean)}, median {percent(e.median)}, worst {percent(e.worst)} {UNIT}; "
        f"area under the curve to {100 * e.auc_limit:g} %: {e.auc:.4f}"
    )
