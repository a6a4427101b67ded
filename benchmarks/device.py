"""A match on the CPU and on a device: ``python benchmarks/device.py [--device cuda] [--vertices N ...] [--json PATH]``.

Generated two poses, six landmarks: one fit with 200 functions and ZoomOut on all points, and the automatic way, of
which only the last refinement is done on the device. Preparing, which stays on the CPU, is left out. Wall seconds of
the best of ``--repeats``, after one match that warms the device up; the CPU has ``--threads``. The difference is that
of the raw functional maps, relative to the largest entry, and the share of points that are others in the end.
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from kfmaps import Config, Shape, datasets, match, prepare
from kfmaps.matching.result import Match

WAYS = {"one fit": Config.single_fit(), "automatic": Config()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="cuda")
    parser.add_argument("--vertices", type=int, nargs="+", default=[5_000, 20_000, 50_000])
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    rows = []
    print(f"{'vertices':>8} {'way':9} {'stage':24} {'cpu s':>8} {options.device + ' s':>8} {'ratio':>6}")
    for n in options.vertices:
        for way, config in WAYS.items():
            rows += compared(n, way, replace(config, threads=options.threads), options)
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


def compared(n: int, way: str, config: Config, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Rows of the stages of one size and one way, printed."""
    pair = datasets.two_poses(n)
    shapes = [prepare(mesh, config) for mesh in (pair.source, pair.target)]
    marks = spread(shapes[1], pair.truth)
    ours, theirs = (
        best(shapes, replace(config, device=device), marks, options.repeats) for device in ("cpu", options.device)
    )
    stages = {stage: (spent, theirs.seconds.get(stage, np.nan)) for stage, spent in ours.seconds.items()}
    stages["all"] = sum(ours.seconds.values()), sum(theirs.seconds.values())
    rows = []
    for stage, (cpu, other) in stages.items():
        if cpu >= 0.05 or stage == "all":
            rows.append({"vertices": n, "way": way, "stage": stage, "cpu": cpu, "device": other})
            print(f"{n:8} {way:9} {stage:24} {cpu:8.2f} {other:8.2f} {cpu / other:6.1f}")
    scale = float(np.abs(ours.fit.raw_functional_map).max())
    difference = float(np.abs(theirs.fit.raw_functional_map - ours.fit.raw_functional_map).max()) / scale
    others = float(np.mean(ours.target_to_source != theirs.target_to_source))
    rows.append({"vertices": n, "way": way, "difference": difference, "other_points": others})
    print(f"{n:8} {way:9} maps differ by {difference:.1e}, {100 * others:.2f} % of the points are others")
    return rows


def spread(target: Shape, truth: np.ndarray, count: int = 6) -> np.ndarray:
    """Landmarks far from each other, ``(count, 2)``."""
    positions = target.mesh.vertices
    marks = [0]
    for _ in range(count - 1):
        distances = np.linalg.norm(positions[:, None] - positions[marks], axis=2).min(axis=1)
        marks.append(int(distances.argmax()))
    return np.stack([truth[marks], marks], axis=1)


def best(shapes: list[Shape], config: Config, marks: np.ndarray, repeats: int) -> Match:
    """The quickest of some matches, after one that warms up."""
    found = []
    for _ in range(1 + repeats):
        begun = time.perf_counter()
        found.append((match(shapes[0], shapes[1], config, landmarks=marks), time.perf_counter() - begun))
    return min(found[1:], key=lambda one: one[1])[0]


if __name__ == "__main__":
    main()
