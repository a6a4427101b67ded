"""What a match tells of itself: for machines, for people, and beside the map in its file."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.table import Table
from rich.text import Text

import kfmaps
from kfmaps._arrays import shown
from kfmaps.cli.evaluation import Accuracy
from kfmaps.cli.words import LOUD, UNIT, percent, verdict_line
from kfmaps.config import as_dict
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import MapFile, match_map
from kfmaps.io.provenance import sha256
from kfmaps.matching.result import Match
from kfmaps.matching.result_groups import ONE_FIT


@dataclass(frozen=True, eq=False)
class MatchRun:
    """A match with what it was made from.

    Attributes
    ----------
    match : Match
    meshes : (Mesh, Mesh)
        Source and target.
    paths : (Path, Path)
        Their files.
    landmarks : (l, 2) int64
    seed : int
    seconds : dict of str to float
        Of all stages, those of each shape too.
    accuracy : Accuracy or None
        Set beside the truth, where it is known.
    """

    match: Match
    meshes: tuple[Mesh, Mesh]
    paths: tuple[Path, Path]
    landmarks: np.ndarray
    seed: int
    seconds: dict[str, float] = field(default_factory=dict)
    accuracy: Accuracy | None = None


def summary(outcome: MatchRun) -> dict[str, Any]:
    """Plain values for JSON. Residuals are divided by the first; errors are in units of √area."""
    match = outcome.match
    fit, solution, residuals = match.fit, match.fit.solution, match.fit.relative_residuals.tolist()
    k_t, k_s = (None, None) if match.functional_map is None else match.functional_map.shape
    sides = {}
    for side, mesh, path in zip(("source", "target"), outcome.meshes, outcome.paths, strict=True):
        sides |= {side: str(path), f"{side}_vertices": len(mesh.vertices), f"{side}_faces": len(mesh.faces)}
    return {
        "version": kfmaps.__version__,
        **sides,
        "landmarks": len(outcome.landmarks),
        "orientation": match.orientation,
        "doubted": match.score.rejected_landmarks.tolist(),
        "seed": outcome.seed,
        "map_rows": k_t,
        "map_columns": k_s,
        "origin": match.score.initialization,
        "fit_size": None if solution is None else len(solution.value),
        "kernel": fit.kernel or None,
        "rank": fit.rank,
        "slices": fit.n_operators,
        "solver_status": None if solution is None else solution.status,
        "solver_steps": None if solution is None else solution.steps,
        "relative_residual": residuals[-1] if residuals else None,
        "verdict": match.verdict,
        "confidence": None if match.confidence is None else float(match.confidence),
        "local_confidence": mean_confidence(match),
        "scores": [float(score) for score in match.score.scores],
        "runners_up": len(match.alternatives),
        "partial": match.partial.which,
        "partial_reason": match.partial.reason,
        "part_scale": match.partial.scale,
        "without_counterpart": int((match.target_to_source < 0).sum()),
        "errors": None if outcome.accuracy is None else outcome.accuracy.as_dict(),
        "weights": None if fit.weights is None else fit.weights.tolist(),
        "energies": None if solution is None else {name: float(value) for name, value in fit.energies.items()},
        "times": {name: float(value) for name, value in outcome.seconds.items()},
        "residuals": None if solution is None else residuals,
        "settings": as_dict(match.config),
    }


def mean_confidence(match: Match) -> float | None:
    """Mean of ``local_confidence`` over the target's vertices; ``None`` where it is known at none."""
    known = match.local_confidence
    known = None if known is None else known[np.isfinite(known)]
    return None if known is None or len(known) == 0 else float(known.mean())


def map_file(outcome: MatchRun) -> MapFile:
    """The map with all that is known of it, ready to be saved; paths are made absolute."""
    found = match_map(outcome.match)
    extra: dict[str, Any] = {
        "source": str(outcome.paths[0].absolute()),
        "target": str(outcome.paths[1].absolute()),
        "n_s": np.int64(len(outcome.meshes[0].vertices)),
        "summary": json.dumps(summary(outcome)),
    }
    for side, path in zip(("source", "target"), outcome.paths, strict=True):
        if digest := sha256(path):
            extra[f"{side}_sha256"] = digest
    if len(outcome.landmarks):
        extra["landmarks"] = outcome.landmarks
    return replace(found, extra={**found.extra, **extra})


def table(outcome: MatchRun, written: Path | None = None) -> Table:
    """The summary for people."""
    match, found = outcome.match, summary(outcome)
    grid = Table(show_header=False, box=None, pad_edge=False)
    grid.add_column(style="bold", no_wrap=True)
    grid.add_column(overflow="fold")
    for name, value in _rows(match, found, outcome.accuracy):
        loud = value.startswith(tuple(f"{kind.upper()}:" for kind in LOUD))
        grid.add_row(name, Text(value, style="bold red" if loud else ""))
    if written is not None:
        grid.add_row("written", Text(shown(str(written))))
    return grid


def _rows(match: Match, found: dict[str, Any], accuracy: Accuracy | None) -> list[tuple[str, str]]:
    """Names and values of the table."""
    rows = [("verdict", _verdict(match))]
    if match.partial.which != "none" or match.partial.reason.startswith("taken for whole"):
        rows.append(("parts", match.partial.reason))
    if found["without_counterpart"]:
        lost, n_t = found["without_counterpart"], len(match.target_to_source)
        rows.append(("no counterpart", f"{lost:,} of the target's {n_t:,} vertices: they are -1 in the map"))
    if accuracy is not None:
        rows.append(("error", errors_text(accuracy)))
    for side in ("source", "target"):
        faces = found[f"{side}_faces"]
        what = f"{faces:,} faces" if faces else "a point cloud"
        rows.append((side, f"{shown(found[side])}: {found[f'{side}_vertices']:,} vertices, {what}"))
    spent = sorted(found["times"].items(), key=lambda item: -item[1])
    size = f"{found['map_rows']} × {found['map_columns']}"
    rows.append(("landmarks", str(found["landmarks"]) if found["landmarks"] else "none"))
    if found["orientation"] == "reversing":
        rows.append(("orientation", "reversed: the target is matched as the mirror image of the source"))
    if found["doubted"]:
        numbers = ", ".join(str(number) for number in found["doubted"])
        rows.append(
            ("doubted", f"landmark {numbers}, counted from 0: the map keeps to the others, and they had no say")
        )
    if found["weights"] is not None and match.config is not None:
        per, least = (
            match.config.formulation.loss_group,
            sorted(enumerate(found["weights"]), key=lambda item: item[1])[:3],
        )
        told = ", ".join(f"{per} {number} {weight:.2f}" for number, weight in least)
        rows.append(("believed least", f"{told} (counted from 0; 1 is fully)"))
    if match.score.initialization == ONE_FIT and match.fit.solution is not None:
        kernel = re.sub(r"\d+\.\d{5,}", lambda number: f"{float(number[0]):.4g}", found["kernel"])
        slices = f", {found['slices']} slices" if found["slices"] else ""
        status = found["solver_status"] + (f" in {found['solver_steps']} steps" if found["solver_steps"] else "")
        energies = [f"{name} {value:.4g}" for name, value in found["energies"].items()]
        rows += [
            ("kernel", f"{kernel}: {found['rank']} features{slices}"),
            ("map", f"{size}, fitted at {found['fit_size']} × {found['fit_size']}"),
            ("solver", f"{status}, residual {found['relative_residual']:.1e}"),
            ("energy", ", ".join(energies)),
        ]
    else:
        rows.append(("map", f"{size}, started from {match.score.initialization}"))
    rows += [
        ("time", f"{sum(found['times'].values()):.1f} s: " + ", ".join(f"{name} {t:.2f}" for name, t in spent)),
    ]
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
