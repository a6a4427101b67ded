"""Maps without landmarks on the field's benchmarks: errors, verdicts and times, one setting for all sets.

    python benchmarks/automatic.py --data DIR [--sets FAUST_r,TOSCA_r,catlion,own] [--workers 2] [--json FILE]
    python benchmarks/automatic.py --data DIR --time

DIR holds the folders FAUST_r, TOSCA_r and catlion (see the layouts in docs/collections.md); without it only the
package's own shapes are matched. What the settings were chosen on is left out: pairs of FAUST_r in which both are of
the first four people, and seeds 0 to 4 of the package's own non-isometric shapes.
"""

from __future__ import annotations

import argparse
import json
import os
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np

import kfmaps
from kfmaps import datasets

TUNED = 40
"""Shapes of FAUST_r below this number are of the people that the settings were chosen on."""


def read(path: Path) -> kfmaps.Mesh:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
        return kfmaps.read_mesh(path)


def mesh_file(folder: Path, name: str) -> Path:
    return next(folder / f"{name}{e}" for e in (".ply", ".off") if (folder / f"{name}{e}").exists())


def faust_pairs(folder: Path, count: int = 60, seed: int = 0) -> list[tuple[str, str]]:
    """``count`` pairs across people, none of them of two people that the settings were chosen on."""
    lines = (folder / "test_pairs.txt").read_text(encoding="utf-8").split("\n")
    pairs = [(a, b) for a, b in (line.split() for line in lines if line.strip())]
    number = {name: int(name[-3:]) for pair in pairs for name in pair}
    across = [(a, b) for a, b in pairs if number[a] // 10 != number[b] // 10 and max(number[a], number[b]) >= TUNED]
    chosen = np.random.default_rng(seed).permutation(len(across))[:count]
    return [across[i] for i in np.sort(chosen)]


def tosca_pairs(folder: Path) -> list[tuple[str, str]]:
    """All pairs within an animal."""
    names = sorted(p.stem for p in folder.glob("*.off"))
    return [p for p in combinations(names, 2) if p[0].rstrip("0123456789") == p[1].rstrip("0123456789")]


def judged(name: str, source: kfmaps.Mesh, target: kfmaps.Mesh, true_s, true_t, mirrored_t=None) -> dict:
    start = time.perf_counter()
    found = kfmaps.match(source, target, replace(kfmaps.Config.automatic(), threads=THREADS))
    row = {"pair": name, "seconds": time.perf_counter() - start, "verdict": found.verdict}
    row |= {"confidence": found.confidence, "score": found.scores[0], "stages": found.seconds}

    def error(points, where) -> float:
        return 100 * float(kfmaps.geodesic_errors(source, points[where], true_s).mean())

    row["error"] = error(found.target_to_source, true_t)
    if mirrored_t is not None:
        row["mirrored"] = error(found.target_to_source, mirrored_t)
    row["runners_up"] = [error(other, true_t) for other in found.runners_up]
    return row


def collection(job: tuple[Path, str, str]) -> dict:
    folder, a, b = job
    lines = [np.loadtxt(folder / "corres" / f"{n}.vts", dtype=np.int64) - 1 for n in (a, b, f"{b}.sym")]
    return judged(f"{a} {b}", read(mesh_file(folder, a)), read(mesh_file(folder, b)), *lines)


def cat_and_lion(folder: Path) -> dict:
    pairs = np.loadtxt(folder / "cat_lion_landmarks.txt", dtype=np.int64)
    return judged("cat lion", read(folder / "cat-00.off"), read(folder / "lion-00.off"), pairs[:, 0], pairs[:, 1])


def own(job: tuple[str, int]) -> dict:
    kind, seed = job
    if kind in ("sphere", "vase"):
        make = getattr(datasets, kind)
        meshes = make(3000, rng=seed), make(3000, rng=seed + 1000)
        found = kfmaps.match(*meshes, replace(kfmaps.Config.automatic(), threads=THREADS))
        return {"pair": f"{kind} {seed}", "verdict": found.verdict, "confidence": found.confidence}
    pair = getattr(datasets, kind)(4000, rng=seed)
    return judged(f"{kind} {seed}", pair.source, pair.target, pair.truth, np.arange(len(pair.truth)))


THREADS = 1
"""Of one match, when several pairs are matched at once."""


def time_pairs(folder: Path, count: int = 5) -> None:
    """Wall-clock seconds of a match from two meshes, with every core and with one thread."""
    pairs = faust_pairs(folder)[::12][:count]
    meshes = [(read(mesh_file(folder, a)), read(mesh_file(folder, b))) for a, b in pairs]
    found: dict[str, list[dict[str, float]]] = {}
    for threads in (None, 1):
        for a, b in meshes:
            config = replace(kfmaps.Config.automatic(), threads=threads)
            start = time.perf_counter()
            shapes = [kfmaps.prepare(mesh, config) for mesh in (a, b)]
            match = kfmaps.match(shapes[0], shapes[1], config)
            seconds = {k: sum(shape.seconds[k] for shape in shapes) for k in shapes[0].seconds}
            seconds |= {**match.seconds, "whole match": time.perf_counter() - start}
            found.setdefault("one thread" if threads else f"{os.cpu_count()} cores", []).append(seconds)
    columns = list(found)
    print(f"seconds, mean of {len(pairs)} pairs of 5,000 vertices" + "".join(f"{c:>14}" for c in columns))
    for stage in found[columns[0]][0]:
        print(f"{stage:46}" + "".join(f"{np.mean([s[stage] for s in found[c]]):14.2f}" for c in columns))


def report(title: str, rows: list[dict]) -> None:
    errors = np.array([r["error"] for r in rows if "error" in r])
    print(f"\n{title}: {len(rows)} pairs")
    if len(errors):
        print(
            f"  mean error x 100  {errors.mean():.2f}   median {np.median(errors):.2f}   worst {errors.max():.2f}"
            f"   above 5: {int((errors > 5).sum())}"
        )
    unsure = [r["pair"] for r in rows if r["verdict"] != "sure"]
    print(f"  ambiguous: {len(unsure)} {', '.join(unsure)}")
    for r in rows:
        if r.get("error", 0) > 5:
            print(f"  {r['pair']}: {r['error']:.1f}, verdict {r['verdict']}, runners-up {np.round(r['runners_up'], 1)}")
    if any("seconds" in r for r in rows):
        timed = [r for r in rows if "seconds" in r]
        print(f"  seconds a pair, eigenproblems included: {np.mean([r['seconds'] for r in timed]):.1f}")
        for stage in sorted({stage for r in timed for stage in r["stages"]}):
            print(f"    {stage:28} {np.mean([r['stages'].get(stage, 0.0) for r in timed]):6.2f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--sets", default="FAUST_r,TOSCA_r,catlion,own")
    parser.add_argument("--workers", type=int, default=2, help="pairs at once, each with one thread")
    parser.add_argument("--time", action="store_true", help="only time five pairs of FAUST_r, one after the other")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if arguments.time:
        time_pairs(arguments.data / "FAUST_r")
        return
    results: dict[str, list[dict]] = {}
    with ProcessPoolExecutor(arguments.workers) as pool:
        for name in arguments.sets.split(","):
            if name == "own":
                kinds = [("non_isometric", 5), ("non_isometric", 6), ("two_poses", 5), ("symmetric_creature", 5)]
                rows = list(pool.map(own, [*kinds, ("sphere", 5), ("vase", 5)]))
            elif arguments.data is None or not (arguments.data / name).is_dir():
                print(f"{name}: no such folder in --data; left out")
                continue
            elif name == "catlion":
                rows = [cat_and_lion(arguments.data / name)]
            else:
                pairs = (faust_pairs if name == "FAUST_r" else tosca_pairs)(arguments.data / name)
                rows = list(pool.map(collection, [(arguments.data / name, *p) for p in pairs]))
            results[name] = rows
            report(name, rows)
            if name == "FAUST_r":
                apart = [r for r in rows if min(int(n[-3:]) for n in r["pair"].split()) >= TUNED]
                report("FAUST_r, of these only people that nothing was chosen on", apart)
            if arguments.json:
                arguments.json.write_text(json.dumps(results, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
