"""Landmarks carried from skull to skull, against those of an expert: millimetres and % of centroid size.

    python benchmarks/skulls.py --data SKULLS --output FOLDER [--half choice|report]

SKULLS holds meshes NAME.ply and landmarks NAME.mrk.json. The first four specimens by name are the templates, and the
half that thresholds are chosen on: each of them is a target of the three others. The others, the half to report, are
targets of all four templates one by one, and of all four triples of them. FOLDER keeps the maps; stopped and started
again the program goes on where it was. About a minute a pair.
"""

from __future__ import annotations

import argparse
import warnings
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np

from kfmaps._arrays import KfmapsWarning
from kfmaps.batch.layout import Pair, ShapeFolder, find_collection
from kfmaps.batch.plan import Plan, make_plan
from kfmaps.batch.progress import RunStatus
from kfmaps.batch.results import Result
from kfmaps.batch.run import run_batch
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.transfer_landmarks import Template, propagate_landmarks, read_templates
from kfmaps.config import Config
from kfmaps.io.landmark_files import read_landmark_sets

TEMPLATES = 4
"""Specimens of the half to choose on."""
FAR = 1.0
"""Millimetres from which a landmark counts as wrong."""


@dataclass(frozen=True, eq=False)
class Measured:
    """Landmarks of one target from some templates: distances (l,) in mm, flags (l,), and its centroid size in mm."""

    templates: tuple[str, ...]
    target: str
    errors: np.ndarray
    flagged: np.ndarray
    size: float
    misfit: str


def make_pairs(scans: ShapeFolder) -> list[Pair]:
    """The pairs from each template to all other specimens."""
    names = sorted(scans.shapes)
    return [Pair(a, b) for a in names[:TEMPLATES] for b in names if a != b]


def measure(
    scans: ShapeFolder, templates: list[Template], target: str, plan: Plan, results: dict[tuple[str, str], Result]
) -> Measured:
    """Carry the landmarks of some templates to a target and compare them with the expert's."""
    own = {one.specimen: results[one.specimen, target] for one in templates}
    found = propagate_landmarks(templates, target, scans.shapes[target], own, plan.folder)
    (truth,) = read_landmark_sets(scans.shapes[target].with_suffix(".mrk.json"))
    where = dict(zip(truth.names, truth.points, strict=True))
    points = np.array([where[name] for name in found.points.names])
    errors = np.linalg.norm(found.points.points - points, axis=1)
    size = float(np.sqrt(((truth.points - truth.points.mean(axis=0)) ** 2).sum()))
    flagged = np.array([bool(flag) for flag in found.flags])
    return Measured(tuple(one.specimen for one in templates), target, errors, flagged, size, found.misfit)


def line(name: str, some: list[Measured]) -> str:
    """A row of the table: means over targets and templates, flags, and what is far off without a flag."""
    errors, flagged = np.stack([one.errors for one in some]), np.stack([one.flagged for one in some])
    relative = 100 * np.mean([one.errors.mean() / one.size for one in some])
    each = [one.errors.mean() for one in some]
    spread = f"{min(each):.3f} to {max(each):.3f}"
    silent = int(((errors > FAR) & ~flagged).sum())
    cells = [f"{errors.mean():.3f}", spread, f"{relative:.2f}", f"{np.median(errors):.3f}", f"{errors.max():.2f}"]
    return f"| {name} | {' | '.join(cells)} | {int(flagged.sum())} of {flagged.size} | {silent} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--half", choices=("choice", "report"), default="report")
    options = parser.parse_args()
    warnings.simplefilter("ignore", KfmapsWarning)
    scans = find_collection(options.data)
    names = sorted(scans.shapes)
    plan = make_plan(scans, make_pairs(scans), RunSpec(Config(), landmark_files=False), options.output)

    def tell(status: RunStatus, result: Result | None) -> None:
        if result is not None:
            print(status, flush=True)

    outcome = run_batch(plan, workers=1, worst=0, callback=tell)
    results = {(r.source, r.target): r for r in outcome.results}
    templates = read_templates([options.data / f"{name}.mrk.json" for name in names[:TEMPLATES]], scans)
    targets = names[:TEMPLATES] if options.half == "choice" else names[TEMPLATES:]
    print("\n| templates | mean, mm | lowest to highest | % of size | median | largest | flagged | > 1 mm unflagged |")
    print("|---|---|---|---|---|---|---|---|")
    measured: dict[int, list[Measured]] = {}
    for count in (1, 3):
        measured[count] = [
            measure(scans, list(some), target, plan, results)
            for target in targets
            for some in combinations(templates, count)
            if target not in [one.specimen for one in some]
        ]
        print(line(str(count), measured[count]))
        for target in targets:
            print(line(f"{count}, to {target}", [one for one in measured[count] if one.target == target]))
    verdicts = [results[a.specimen, b].verdict for a in templates for b in targets if a.specimen != b]
    print(f"\nverdicts: {', '.join(f'{verdicts.count(word)} {word}' for word in sorted(set(verdicts)))}")
    print("\n| landmark | one template, mm | three, mm | three, largest |\n|---|---|---|---|")
    one, three = (np.stack([m.errors for m in measured[count]]) for count in (1, 3))
    for i, name in enumerate(templates[0].points.names):
        print(f"| {name} | {one[:, i].mean():.2f} | {three[:, i].mean():.2f} | {three[:, i].max():.2f} |")


if __name__ == "__main__":
    main()
