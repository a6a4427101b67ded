"""Time and memory of a whole match as shapes grow: ``python benchmarks/growth.py [--large] [--huge] [--json PATH]``.

Each size is a pair of generated shapes with six landmarks (``shapes.bumpy_pair``), matched with the recommended
configuration in a process of its own, whose peak memory is shown; "rise" is how far a stage raised it. The exponent
of a stage is the slope of log CPU seconds over log vertices from 20,000 up, by least squares. CPU seconds are of all
threads together. Errors are in per cent of √area, from a thousand vertices.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import resource
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from shapes import bumpy_pair

from kfmaps._threads import one_blas_thread
from kfmaps.config import Config
from kfmaps.fit.finish import finished
from kfmaps.fit.fit import fit
from kfmaps.fit.shape import prepare
from kfmaps.surface.geodesics import distance_pairs
from kfmaps.surface.mesh import unit_area

SIZES, LARGE, HUGE = (5_000, 20_000, 80_000), 300_000, 1_000_000


def peak_gb() -> float:
    """The most memory this process has held so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def measure(n: int, threads: int) -> dict[str, Any]:
    """All stages at one size."""
    pair = bumpy_pair(n)
    stages: dict[str, dict[str, float]] = {}
    begun: dict[str, tuple[float, float, float]] = {}

    def report(stage: str, done: float) -> None:
        if done == 0.0 and stage not in begun:
            begun[stage] = (time.process_time(), time.perf_counter(), peak_gb())
        elif done == 1.0 and stage not in stages:
            work, wall, peak = begun[stage]
            spent = {"work": time.process_time() - work, "wall": time.perf_counter() - wall}
            stages[stage] = {**spent, "rise": peak_gb() - peak}

    @contextmanager
    def whole() -> Iterator[None]:
        report("whole", 0.0)
        yield
        report("whole", 1.0)

    config = Config(threads=threads)
    with one_blas_thread(), whole():
        source = prepare(pair.source, config, name="source", progress=report)
        target = prepare(pair.target, config, name="target", progress=report)
        found = fit(source, target, config, landmarks=pair.landmarks, progress=report)
        end = finished(found.functional_map, source, target, config, progress=report)
    peak = peak_gb()
    rows = np.random.default_rng(0).choice(len(pair.target_to_source), 1000, replace=False)
    mesh, truth = unit_area(pair.source), pair.target_to_source[rows]
    ends = {"raw": end.raw_target_to_source, "refined": end.target_to_source}
    errors = {
        name: 100 * float(distance_pairs(mesh, p[rows], truth).mean()) for name, p in ends.items() if p is not None
    }
    return {"n": n, "threads": threads, "peak_gb": peak, "errors": errors, "stages": stages}


def exponents(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Growth exponent of each stage from 20,000 vertices up."""
    big = [row for row in rows if row["n"] >= 20_000]
    if len(big) < 2:
        return {}
    sizes = np.log([row["n"] for row in big])
    return {
        stage: float(np.polyfit(sizes, np.log([row["stages"][stage]["work"] for row in big]), 1)[0])
        for stage in big[0]["stages"]
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help="300,000 vertices too (about 6 GB)")
    parser.add_argument("--huge", action="store_true", help="a million too (about 20 GB)")
    parser.add_argument("--sizes", type=int, nargs="+", help="these sizes instead")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--json", type=Path, help="write the rows there too")
    options = parser.parse_args()
    sizes = options.sizes or (*SIZES, *((LARGE,) if options.large else ()), *((HUGE,) if options.huge else ()))
    rows = []
    context = multiprocessing.get_context("spawn")
    for n in sizes:
        with context.Pool(1) as pool:  # a process of its own, for its peak memory
            row = pool.apply(measure, (n, options.threads))
        rows.append(row)
        errors = ", ".join(f"{name} {value:.2f}" for name, value in row["errors"].items())
        print(f"\n{n} vertices: peak {row['peak_gb']:.2f} GB, errors {errors}")
        for stage, spent in row["stages"].items():
            print(f"  {stage:26} {spent['work']:8.2f} CPU s {spent['wall']:8.2f} s {spent['rise']:7.2f} GB", flush=True)
        if options.json:
            options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    print("\nexponents of CPU seconds, from 20,000 vertices")
    for stage, exponent in exponents(rows).items():
        print(f"  {stage:26} {exponent:6.2f}")


if __name__ == "__main__":
    main()
