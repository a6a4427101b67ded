"""CPU seconds of the stages of matches, one row a stage.

    python benchmarks/stages.py SOURCE:TARGET ... [--scan N] [--profile]

Each pair is two files of meshes. With ``--scan N`` a target is made like a raw scan first: subdivided until it has
N vertices, with noise, holes and T-junctions. ``--profile`` prints the functions that take most of the time.
One thread; nothing prepared.
"""

from __future__ import annotations

import argparse
import cProfile
import pstats
import time
from pathlib import Path

import numpy as np

import kfmaps
from kfmaps.config import Config
from kfmaps.geometry.connectivity import half_edges
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.io.meshes import read_mesh


def raw_scan(mesh: Mesh, n: int, rng: int = 0) -> Mesh:
    """Subdivide a mesh to at least ``n`` vertices, move them by noise, cut holes, and leave T-junctions.

    Of every twentieth triangle one edge stays whole where its neighbour's is divided; ten round holes take 6 % of the
    vertices; noise has a tenth of the mean edge's length.
    """
    generator = np.random.default_rng(rng)
    mesh = unit_area(mesh)
    while len(mesh.vertices) < n:
        mesh = subdivide(mesh, generator if 4 * len(mesh.vertices) >= n else None)
    x, f = mesh.vertices, mesh.faces
    edge = float(np.linalg.norm(x[f[:, 0]] - x[f[:, 1]], axis=1).mean())
    keep = np.ones(len(x), dtype=bool)
    for centre in x[generator.choice(len(x), 10, replace=False)]:
        away = np.linalg.norm(x - centre, axis=1)
        keep &= away > np.sort(away)[int(0.006 * len(x))]
    f = f[keep[f].all(axis=1)]
    used, f = np.unique(f, return_inverse=True)
    return Mesh(x[used] + generator.normal(scale=0.1 * edge, size=(len(used), 3)), f.reshape(-1, 3))


def subdivide(mesh: Mesh, broken: np.random.Generator | None = None) -> Mesh:
    """Divide each triangle into four; with ``broken``, every twentieth stays as it is beside divided ones."""
    x, f = mesh.vertices, mesh.faces
    edges = np.sort(half_edges(f), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    a, b, c = number.reshape(3, -1) + len(x)
    middle = x[unique].mean(axis=1)
    whole = np.zeros(len(f), dtype=bool) if broken is None else broken.random(len(f)) < 0.05
    four = [(f[:, 0], a, c), (f[:, 1], b, a), (f[:, 2], c, b), (a, b, c)]
    divided = np.concatenate([np.stack(corners, axis=1)[~whole] for corners in four])
    return Mesh(np.concatenate([x, middle]), np.concatenate([f[whole], divided]))


def stages(source: Mesh, target: Mesh, threads: int = 1) -> dict[str, float]:
    """Match two meshes and return the CPU seconds of each stage, and of the whole."""
    begun: dict[str, float] = {}
    seconds: dict[str, float] = {}

    def progress(stage: str, done: float) -> None:
        now = time.process_time()
        if done <= 0 or stage not in begun:
            begun[stage] = now
        seconds[stage] = now - begun[stage]

    start = time.process_time()
    found = kfmaps.match(source, target, Config(threads=threads), progress=progress)
    seconds["whole"] = time.process_time() - start
    print(f"    {len(source.vertices)} and {len(target.vertices)} vertices: {found.verdict}, {found.confidence:.3f}")
    return seconds


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("pairs", nargs="+", metavar="SOURCE:TARGET")
    parser.add_argument("--scan", type=int, metavar="N", help="make a raw scan of N vertices of each target")
    parser.add_argument("--profile", action="store_true", help="print the functions that take most of the time")
    args = parser.parse_args()
    for pair in args.pairs:
        source, target = (read_mesh(Path(name)) for name in pair.split(":"))
        if args.scan:
            target = raw_scan(target, args.scan)
        print(pair)
        profile = cProfile.Profile(time.process_time) if args.profile else None
        if profile:
            profile.enable()
        for stage, seconds in stages(source, target).items():
            print(f"    {stage:34s}{seconds:8.2f}")
        if profile:
            profile.disable()
            pstats.Stats(profile).sort_stats("cumulative").print_stats(70).sort_stats("tottime").print_stats(40)


if __name__ == "__main__":
    main()
