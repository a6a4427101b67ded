"""What the finish does for maps, against the truth.

    python benchmarks/precise.py --data DIR [--sets own,FAUST,FAUST_r,...] [--pairs N] [--json FILE]
    python benchmarks/precise.py --growth 5000,20000,80000,300000

DIR holds the folders FAUST, FAUST_r and SHREC19_r (see the layouts in docs/collections.md); ``own`` needs none. Of each
pair one map is made, then finished. Errors are mean geodesic distances between points inside triangles, in per cent of
√area: of the refined map of vertices, of the nearest points in the spectral embedding, and after the non-rigid fit.

The truth of ``FAUST_r`` (.vts) is rounded to vertices. That of ``FAUST_r exact`` lies in triangles: the original
registrations of the same people, laid onto the remeshed shapes. Pairs are of people that nothing was chosen on: 4 to 7
of FAUST_r; 2 and 3 of FAUST, and of ``FAUST_r exact``. ``unlike`` are cats with dogs and women with a gorilla, of
TOSCA_r and TOSCA_nonIsometric_r, with the rows of ``cross/cat_dog.txt``.

``--growth`` times the two pieces alone on generated shapes of so many vertices, in CPU seconds: the fit, from the true
map of vertices, and the nearest points among triangles in an embedding of 200 smooth functions (waves of places).
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
from automatic import mesh_file, read

import kfmaps
from kfmaps import datasets
from kfmaps._progress import StageTimer
from kfmaps._threads import limit_threads
from kfmaps.fmap.evaluate import precise_errors, smoothness
from kfmaps.fmap.precise import PointMap, nearest_surface_points, point_positions
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.mesh import Mesh, unit_area
from kfmaps.registration.accept import register_map
from kfmaps.registration.nonrigid_icp import NonRigid

NUMBERS = [(20 + i, 30 + (3 * i) % 10) for i in range(10)] + [(30 + i, 20 + (7 * i + 4) % 10) for i in range(10)]
"""Pairs of registrations of the people 2 and 3."""
UNLIKE = ("cat1 dog6", "dog1 cat2", "cat6 dog1", "dog6 cat6", "8_gorilla_02 8_woman_03", "8_woman_04 8_gorilla_02")
"""Pairs of bodies of different kinds, of TOSCA_r and TOSCA_nonIsometric_r."""
PEOPLE = 40
"""Shapes of FAUST_r from this number on: both of a pair, so that nothing was chosen on either."""


def faust_pairs(folder: Path, count: int = 60, seed: int = 0) -> list[tuple[str, ...]]:
    """Of ``count`` pairs across people, drawn at random, those of people that nothing was chosen on."""
    lines = (folder / "test_pairs.txt").read_text(encoding="utf-8").split("\n")
    pairs = [tuple(line.split()) for line in lines if line.strip()]
    number = {name: int(name[-3:]) for pair in pairs for name in pair}
    across = [p for p in pairs if number[p[0]] // 10 != number[p[1]] // 10 and max(number[n] for n in p) >= PEOPLE]
    chosen = np.sort(np.random.default_rng(seed).permutation(len(across))[:count])
    return [across[i] for i in chosen if min(number[n] for n in across[i]) >= PEOPLE]


def vertices_of_lines(folder: Path, name: str) -> np.ndarray:
    return np.loadtxt(folder / "corres" / f"{name}.vts", dtype=np.int64) - 1


def laid(folder: Path, name: str, mesh: Mesh) -> Mesh:
    """The original registration ``name`` in the unit and place of its remeshed ``mesh``, by closest places."""
    original = read(folder / "FAUST" / f"{name}.ply")
    fixed = mesh.vertices[vertices_of_lines(folder / "FAUST_r", name)]
    moved = free = original.vertices
    free = free[vertices_of_lines(folder / "FAUST_r", "sampleID")]
    for _ in range(5):
        middle, centre = free.mean(axis=0), fixed.mean(axis=0)
        u, sizes, vh = np.linalg.svd((free - middle).T @ (fixed - centre))
        moved = sizes.sum() / ((free - middle) ** 2).sum() * (moved - middle) @ (u @ vh) + centre
        free, fixed = closest_points(mesh.vertices, moved, original.faces).points, mesh.vertices
    return Mesh(moved, original.faces)


def exact(folder: Path, names: list[str], meshes: list[Mesh]) -> PointMap:
    """Where the target's vertices lie on the source, by the original registrations of both."""
    source, target = (laid(folder, name, mesh) for name, mesh in zip(names, meshes, strict=True))
    on = closest_points(meshes[1].vertices, target.vertices, target.faces)
    there = np.einsum("qi,qij->qj", on.weights, source.vertices[source.faces[on.faces]])
    found = closest_points(there, meshes[0].vertices, meshes[0].faces)
    return PointMap(found.faces, found.weights)


def jobs(data: Path | None, kind: str, count: int):
    """Name, source, target, and the truth: where target vertices ``(q,)`` lie on the source."""
    if kind == "own":
        for seed in range(10, 10 + min(count, 3)):
            pair = datasets.two_poses(4000, rng=seed)
            truth = PointMap(pair.truth_faces, pair.truth_weights)
            yield f"two poses {seed}", pair.source, pair.target, truth, np.arange(len(pair.truth)), None
        return
    assert data is not None
    folder = data / kind
    if kind == "FAUST_r exact":
        for a, b in NUMBERS[:: max(1, len(NUMBERS) // count)][:count]:
            names = [f"tr_reg_{i:03d}" for i in (a, b)]
            meshes = [read(mesh_file(data / "FAUST_r", name)) for name in names]
            truth = exact(data, names, meshes)
            yield f"{a:03d} {b:03d}", *meshes, truth, np.arange(len(truth.faces)), None
        return
    if kind == "unlike":
        lines = np.loadtxt(data / "cross" / "cat_dog.txt", dtype=np.int64) - 1
        for a, b in [pair.split() for pair in UNLIKE[:count]]:
            folder = data / ("TOSCA_nonIsometric_r" if "_" in a else "TOSCA_r")
            true = [vertices_of_lines(folder, n) for n in (a, b)]
            if "_" not in a:
                true = [t[lines[:, int(n.startswith("dog"))]] for t, n in zip(true, (a, b), strict=True)]
            told = (true[0] >= 0) & (true[1] >= 0)
            yield f"{a} {b}", *(read(mesh_file(folder, n)) for n in (a, b)), true[0][told], true[1][told], None
        return
    if kind == "FAUST":
        for a, b in NUMBERS[:count]:
            meshes = [read(folder / f"tr_reg_{i:03d}.ply") for i in (a, b)]
            every = np.arange(len(meshes[0].vertices))
            yield f"{a:03d} {b:03d}", *meshes, every, every, None
        return
    if kind == "FAUST_r" or kind == "FAUST_r landmarks":
        folder = data / "FAUST_r"
        pairs = faust_pairs(folder)
    else:
        lines = (folder / "test_pairs.txt").read_text(encoding="utf-8").split("\n")
        pairs = [tuple(line.split()) for line in lines if line.strip()]
    for a, b in pairs[:: max(1, len(pairs) // count)][:count]:
        true = [vertices_of_lines(folder, n) for n in (a, b)]
        rows = np.linspace(0, len(true[0]) - 1, 8).astype(int)[1:-1]
        marks = np.stack([t[rows] for t in true], axis=1) if kind.endswith("landmarks") else None
        yield f"{a} {b}", read(mesh_file(folder, a)), read(mesh_file(folder, b)), true[0], true[1], marks


def row(name, source, target, truth, where, marks) -> dict:
    config = replace(kfmaps.Config(), threads=1)
    found = kfmaps.match(source, target, replace(config, registration=None), landmarks=marks)
    assert found._reindexing is not None
    across, clock = found._reindexing, StageTimer()
    start = time.process_time()
    inner_points = across.clean_points(found.target_to_source)
    doubted = (
        np.zeros((0, 2), dtype=np.int64) if marks is None else np.delete(marks, found.score.rejected_landmarks, axis=0)
    )
    last = register_map(inner_points, across.source, across.target, config, clock, across.clean_landmarks(doubted))
    spent = time.process_time() - start
    spectral = found.precise()
    fitted = spectral if last.precise_map is None else across.given_precise_map(last.precise_map)

    def error(places: PointMap | np.ndarray) -> float:
        some = PointMap(places.faces[where], places.weights[where]) if isinstance(places, PointMap) else places[where]
        return 100 * float(precise_errors(source, some, truth).mean())

    smooth = [smoothness(source, target, p) for p in (found.target_to_source, fitted)]
    return {
        "pair": name,
        "verdict": found.verdict,
        "kept": last.precise_map is not None,
        "bend": None if last.fit is None else asdict(last.fit),
        "vertices": error(found.target_to_source),
        "spectral": error(spectral),
        "finish": error(fitted),
        "coverage": [s.coverage for s in smooth],
        "flipped": [s.flipped_area for s in smooth],
        "stretched": [s.stretched_area for s in smooth],
        "seconds": spent,
    }


def growth(sizes: list[int]) -> None:
    """CPU seconds of the pieces, and their growth from one size to the next as an exponent."""
    before: list[float] = []
    last = 0
    for size in sizes:
        pair = datasets.two_poses(size, rng=0)
        source, target = unit_area(pair.source), unit_area(pair.target)
        true = point_positions(PointMap(pair.truth_faces, pair.truth_weights), source)
        waves = np.random.default_rng(0).normal(size=(3, 100), scale=4.0)
        seconds = []
        for piece in ("fit", "points"):
            start = time.process_time()
            if piece == "fit":
                found = NonRigid()(source, target, pair.truth)
            else:
                angles = (true @ waves, source.vertices @ waves)
                queries, points = (np.hstack([np.cos(a), np.sin(a)]) for a in angles)
                with limit_threads(1):
                    found = nearest_surface_points(queries, points, source.faces)
            seconds.append(time.process_time() - start)
            error = np.linalg.norm(point_positions(PointMap(found.faces, found.weights), source) - true, axis=1)
            print(
                f"  {piece} {len(source.vertices):8,} {seconds[-1]:8.2f} s, off {error.mean():.5f}", end="", flush=True
            )
        if before:
            grown = np.log(np.array(seconds) / before) / np.log(size / last)
            print(f"; exponents {grown[0]:.2f} {grown[1]:.2f}", end="")
        print(flush=True)
        before, last = seconds, size


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--sets", default="own,FAUST,FAUST_r exact,FAUST_r,FAUST_r landmarks")
    parser.add_argument("--pairs", type=int, default=20, help="of each set, spread over its list")
    parser.add_argument("--json", type=Path)
    parser.add_argument("--growth", help="numbers of vertices: time the pieces alone")
    options = parser.parse_args()
    if options.growth:
        growth([int(size) for size in options.growth.split(",")])
        return
    warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
    results: dict[str, list[dict]] = {}
    for kind in options.sets.split(","):
        if kind != "own" and options.data is None:
            print(f"{kind}: needs --data; left out")
            continue
        rows = results[kind] = []
        for job in jobs(options.data, kind, options.pairs):
            rows.append(row(*job))
            r = rows[-1]
            print(
                f"{kind:20} {r['pair']:24} {r['verdict']:10} {'kept' if r['kept'] else 'left':5}"
                + "".join(f"{r[n]:8.2f}" for n in ("vertices", "spectral", "finish")),
                flush=True,
            )
            if options.json:
                options.json.write_text(json.dumps(results, indent=1), encoding="utf-8")
        means = {n: np.mean([r[n] for r in rows]) for n in ("vertices", "spectral", "finish", "seconds")}
        pairs = {n: np.mean([r[n] for r in rows], axis=0) for n in ("coverage", "flipped", "stretched")}
        print(f"{kind}: {len(rows)} pairs, " + ", ".join(f"{n} {v:.2f}" for n, v in means.items()), end="; ")
        print(", ".join(f"{n} {v[0]:.3f} to {v[1]:.3f}" for n, v in pairs.items()))


if __name__ == "__main__":
    main()
