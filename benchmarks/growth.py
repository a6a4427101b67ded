"""Time and memory of a whole match as shapes grow: ``python benchmarks/growth.py [--large] [--huge] [--json PATH]``.

With ``--automatic`` the pairs are ``datasets.two_poses`` without landmarks, matched with ``Config()``.
``--against SRC`` measures each size in turns with the version of kfmaps in that folder, twice each, since CPU seconds
of a busy machine mean nothing alone.

Each size is a pair of generated shapes with six landmarks (``shapes.bumpy_pair``), matched with the recommended
configuration in a process of its own, whose peak memory is shown; "rise" is how far a stage raised it. The exponent
of a stage is the slope of log CPU seconds over log vertices from 20,000 up, by least squares. CPU seconds are of all
threads together. Errors are in per cent of √area, from a thousand vertices.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from shapes import bumpy_pair
from stages import subdivide

import kfmaps
from kfmaps import datasets
from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.geometry.geodesics import geodesic_distance_pairs
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.matching.finish import refine_map
from kfmaps.matching.fit import fit
from kfmaps.matching.match import match
from kfmaps.shape import prepare

SIZES, LARGE, HUGE = (5_000, 20_000, 80_000), 300_000, 1_000_000


def peak_gb() -> float:
    """The most memory this process has held so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


class Stages:
    """CPU seconds, seconds and rise of the peak memory of each stage that reports its beginning and end."""

    def __init__(self) -> None:
        self.spent: dict[str, dict[str, float]] = {}
        self.begun: dict[str, tuple[float, float, float]] = {}

    def report(self, stage: str, done: float) -> None:
        if stage not in self.begun:
            self.begun[stage] = (time.process_time(), time.perf_counter(), peak_gb())
        elif done == 1.0 and stage not in self.spent:
            work, wall, peak = self.begun[stage]
            spent = {"work": time.process_time() - work, "wall": time.perf_counter() - wall}
            self.spent[stage] = {**spent, "rise": peak_gb() - peak}

    @contextmanager
    def whole(self) -> Iterator[None]:
        self.report("whole", 0.0)
        yield
        self.report("whole", 1.0)


def measure(n: int, threads: int) -> dict[str, Any]:
    """All stages at one size."""
    pair = bumpy_pair(n)
    stages = Stages()
    config = replace(Config.single_fit(), threads=threads)
    with one_blas_thread(), stages.whole():
        source = prepare(pair.source, config, name="source", progress=stages.report)
        target = prepare(pair.target, config, name="target", progress=stages.report)
        found = fit(source, target, config, landmarks=pair.landmarks, progress=stages.report)
        end = refine_map(found.functional_map, source, target, config, progress=stages.report)
    ends = {"raw": end.raw_target_to_source, "refined": end.target_to_source}
    return row(n, threads, pair.source, pair.target_to_source, ends, stages)


def measure_automatic(n: int, threads: int) -> dict[str, Any]:
    """The same of two poses without landmarks; more than 300,000 vertices are those of a quarter, and their edges'."""
    pair = datasets.two_poses(n // 4 if n > LARGE else n, rng=0)
    meshes = [subdivide(mesh) if n > LARGE else mesh for mesh in (pair.source, pair.target)]
    stages = Stages()
    config = replace(Config(), threads=threads)
    with one_blas_thread(), stages.whole():
        source = prepare(meshes[0], config, name="source", progress=stages.report)
        target = prepare(meshes[1], config, name="target", progress=stages.report)
        found = match(source, target, config, progress=stages.report)
    return row(n, threads, meshes[0], pair.truth, {found.verdict: found.target_to_source}, stages)


def row(
    n: int, threads: int, source: Mesh, truth: np.ndarray, ends: dict[str, np.ndarray | None], stages: Stages
) -> dict[str, Any]:
    """What is printed of one size."""
    peak = peak_gb()
    rows = np.random.default_rng(0).choice(len(truth), 1000, replace=False)
    mesh = unit_area(source)
    errors = {
        name: 100 * float(geodesic_distance_pairs(mesh, p[rows], truth[rows]).mean())
        for name, p in ends.items()
        if p is not None
    }
    return {"n": n, "threads": threads, "peak_gb": peak, "errors": errors, "stages": stages.spent}


def exponents(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Growth exponent of each stage from 20,000 vertices up."""
    big = [row for row in rows if row["n"] >= 20_000]
    if len(big) < 2:
        return {}
    sizes = np.log([row["n"] for row in big])
    return {
        stage: float(np.polyfit(sizes, np.log([row["stages"][stage]["work"] for row in big]), 1)[0])
        for stage in big[0]["stages"]
        if all(stage in row["stages"] for row in big)
    }


def in_turns(n: int, threads: int, automatic: bool, against: Path, turns: int = 2) -> dict[str, list[dict[str, Any]]]:
    """Rows of one size by the version in the folder ``against`` and by this one, one after the other, and again."""
    rows: dict[str, list[dict[str, Any]]] = {"before": [], "now": []}
    here = str(Path(kfmaps.__file__).resolve().parents[1])
    for _ in range(turns):
        for name, folder in (("before", str(against)), ("now", here)):
            with tempfile.TemporaryDirectory() as kept:
                path = Path(kept) / "rows.json"
                more = ["--automatic"] if automatic else []
                task = [sys.executable, __file__, "--sizes", str(n), "--threads", str(threads), "--json", str(path)]
                subprocess.run([*task, *more], env=os.environ | {"PYTHONPATH": folder}, check=True, capture_output=True)
                rows[name] += json.loads(path.read_text(encoding="utf-8"))
    return rows


def tell_turns(n: int, rows: dict[str, list[dict[str, Any]]]) -> None:
    """CPU seconds of each stage in each turn."""
    print(f"\n{n} vertices, CPU s in turns")
    for stage in rows["now"][0]["stages"]:
        spent = {
            name: "  ".join(f"{row['stages'][stage]['work']:.2f}" if stage in row["stages"] else "-" for row in found)
            for name, found in rows.items()
        }
        print(f"  {stage:26} before {spent['before']}   now {spent['now']}")
    for name, found in rows.items():
        errors = "  ".join(str({k: round(v, 3) for k, v in row["errors"].items()}) for row in found)
        print(f"  {name}: errors {errors}, peak {max(row['peak_gb'] for row in found):.2f} GB", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help="300,000 vertices too (about 3 GB)")
    parser.add_argument("--huge", action="store_true", help="a million too (about 10 GB)")
    parser.add_argument("--automatic", action="store_true", help="two poses without landmarks instead")
    parser.add_argument("--sizes", type=int, nargs="+", help="these sizes instead")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--against", type=Path, metavar="SRC", help="folder of another version, measured in turns")
    parser.add_argument("--json", type=Path, help="write the rows there too")
    options = parser.parse_args()
    sizes = options.sizes or (*SIZES, *((LARGE,) if options.large else ()), *((HUGE,) if options.huge else ()))
    if options.against:
        for n in sizes:
            tell_turns(n, in_turns(n, options.threads, options.automatic, options.against))
        return
    rows = []
    context = multiprocessing.get_context("spawn")
    for n in sizes:
        with context.Pool(1) as pool:  # a process of its own, for its peak memory
            found = pool.apply(measure_automatic if options.automatic else measure, (n, options.threads))
        rows.append(found)
        errors = ", ".join(f"{name} {value:.2f}" for name, value in found["errors"].items())
        print(f"\n{n} vertices: peak {found['peak_gb']:.2f} GB, errors {errors}")
        for stage, spent in found["stages"].items():
            print(f"  {stage:26} {spent['work']:8.2f} CPU s {spent['wall']:8.2f} s {spent['rise']:7.2f} GB", flush=True)
        if options.json:
            options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    print("\nexponents of CPU seconds, from 20,000 vertices")
    for stage, exponent in exponents(rows).items():
        print(f"  {stage:26} {exponent:6.2f}")


if __name__ == "__main__":
    main()
