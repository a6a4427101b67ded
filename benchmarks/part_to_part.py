"""Two parts of two shapes, neither of which holds all of the other: errors, overlaps and verdicts.

    python benchmarks/part_to_part.py --data DIR [--sets TOSCA_r,SMAL_r,FAUST_r] [--pairs 12] [--half report]
    python benchmarks/part_to_part.py --data DIR --part auto

Each shape of a pair is cut by a plane at random and keeps 55 to 80 % of its area; drawn anew until 35 to 75 % of what
the target keeps is on the source too; ``--cuts 1,2`` has two other cuts of each. Truth is that of the whole shapes,
where they have one. Errors are mean geodesic distances on the whole source × 100, over the target's vertices that both
truly have and the map gives a counterpart. The overlap is intersection over union of areas of the target. A map is
right with an error below 8 and an overlap above a half. DIR as for benchmarks/automatic.py.
"""

from __future__ import annotations

import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from automatic import RIGHT, Job, chosen_pairs, loaded, pair_options

import kfmaps
from kfmaps.datasets import largest_piece
from kfmaps.geometry.mesh import Mesh, unit_area, vertex_areas

KEPT, COMMON = (0.55, 0.8), (0.35, 0.75)
HALF = 0.5
"""Overlap that a right map has at least."""
WRONG = 10.0
"""Mean error × 100 above which no map should be called sure."""


def cut(mesh: Mesh, rng: np.random.Generator) -> tuple[Mesh, np.ndarray]:
    """What lies on one side of a random plane, and the vertices of the whole that it keeps."""
    height = mesh.vertices @ rng.normal(size=3)
    order, areas = np.argsort(height), vertex_areas(mesh)
    below = order[: np.searchsorted(np.cumsum(areas[order]), rng.uniform(*KEPT) * areas.sum())]
    keep = np.zeros(len(mesh.vertices), dtype=bool)
    keep[below] = True
    return largest_piece(mesh, keep)


def cuts(job: Job, seed: int) -> tuple[Mesh, Mesh, np.ndarray, np.ndarray, Mesh, np.ndarray]:
    """Both parts; vertices of the target's part with a truth, (m,), and the source part's, −1 where it lacks them; the
    whole source, and which of its vertices the part has."""
    source, target, true_s, true_t = loaded(job)
    source, target = unit_area(source), unit_area(target)
    rng = np.random.default_rng(seed)
    for _ in range(1000):
        (a, kept_s), (b, kept_t) = cut(source, rng), cut(target, rng)
        new_s, new_t = (np.full(len(mesh.vertices), -1) for mesh in (source, target))
        new_s[kept_s], new_t[kept_t] = np.arange(len(kept_s)), np.arange(len(kept_t))
        some = new_t[true_t] >= 0
        if some.any() and COMMON[0] <= (new_s[true_s[some]] >= 0).mean() <= COMMON[1]:
            return a, b, new_t[true_t[some]], new_s[true_s[some]], source, kept_s
    raise SystemExit(f"{job}: no cuts with enough in common")


def run(job: Job, seed: int, which: str) -> dict[str, object]:
    source, target, rows, part, whole, kept = cuts(job, seed)
    config = replace(kfmaps.Config(), threads=1)
    begun = time.process_time()
    found = kfmaps.match(source, target, replace(config, partial=replace(config.partial, part=which)))
    seconds = time.process_time() - begun
    areas, true = vertex_areas(target)[rows], part >= 0
    ours = found.target_to_source[rows] >= 0
    both = true & ours
    error = None
    if both.any():
        images = kept[found.target_to_source[rows[both]]]
        error = 100 * float(kfmaps.geodesic_errors(whole, images, kept[part[both]]).mean())
    return {
        "set": job.kind,
        "pair": f"{job.source} {job.target} {seed}",
        "error": error,
        "overlap": float(areas[both].sum() / areas[true | ours].sum()),
        "matched": float(areas[both].sum() / areas[true].sum()),
        "common": float(areas[true].sum() / areas.sum()),
        "verdict": found.verdict,
        "confidence": found.confidence,
        "score": found.score.scores[0],
        "seconds": seconds,
    }


def is_right(row: dict) -> bool:
    """Whether the map of a row is right."""
    return row["error"] is not None and row["error"] < RIGHT and row["overlap"] > HALF


def main() -> None:
    parser = pair_options(__doc__, "TOSCA_r,SMAL_r,FAUST_r", 12, "report")
    parser.add_argument("--cuts", default="0", help="numbers of the cuts of each pair")
    parser.add_argument("--part", choices=("both", "auto", "none"), default="both", help="what the settings state")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    rows: list[dict] = []
    numbers = [100 * int(word) for word in arguments.cuts.split(",")]
    for kind in arguments.sets.split(","):
        drawn = chosen_pairs(kind, arguments.data, arguments.half, arguments.pairs, seed=1)
        for number, pair in enumerate(drawn):
            for first in numbers:
                rows.append(run(Job(arguments.data, kind, *pair), number + first, arguments.part))
                print(json.dumps(rows[-1]), flush=True)
    print(
        f"\n{'set':10}{'pairs':>6}{'error':>8}{'median':>8}{'IoU %':>7}{'right':>6}{'sure':>6}{'sure, >10':>11}"
        f"{'CPU s':>8}"
    )
    for kind in dict.fromkeys(r["set"] for r in rows):
        here = [r for r in rows if r["set"] == kind]
        errors = np.array([100.0 if r["error"] is None else r["error"] for r in here])
        sure = np.array([r["verdict"] == "sure" for r in here])
        overlap, seconds = (np.mean([r[name] for r in here]) for name in ("overlap", "seconds"))
        print(
            f"{kind:10}{len(here):6}{errors.mean():8.2f}{np.median(errors):8.2f}{100 * overlap:7.1f}"
            f"{sum(map(is_right, here)):6}{sure.sum():6}{(sure & (errors > WRONG)).sum():11}{seconds:8.1f}"
        )
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
