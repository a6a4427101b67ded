"""Cost and accuracy of a collection of generated specimens against their number.

    python benchmarks/collection.py [--shapes 25,50,100] [--vertices 1000] [--workers 2] [--out DIR] [--wrong 0.2]
    python benchmarks/collection.py --shapes 1000 --vertices 5000 --plan

Every specimen is one body bent, stretched and swollen at random, and triangulated for itself, so that the truth is
known. Pairs are chosen by likeness (``--graph near``), matched by ``kfmaps batch``'s own machinery, and made to agree
(``--consistent``). A part ``--wrong`` of the maps is replaced by random ones before that. ``--plan`` tells the pairs,
memory and time that a run needs, and runs nothing. ``--zoom`` then compares each map in use, cut to k functions, with
the map through the latent space after consistent ZoomOut to as many; ``--zoom --run DATA OUT`` does it for a run that
is there. ``--agree`` measures the agreement alone, on made-up maps of as many shapes. Errors are in per cent of √area.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from dataclasses import replace
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from kfmaps import datasets
from kfmaps.app.batch.collection import match_collection
from kfmaps.app.batch.exchange import map_in_use
from kfmaps.app.batch.graphing import graph_pairs
from kfmaps.app.batch.layout import Pair, find_collection
from kfmaps.app.batch.need import needed
from kfmaps.app.batch.plan import make_plan
from kfmaps.app.batch.results import read_result
from kfmaps.app.batch.settings import Settings
from kfmaps.app.batch.spread import crew
from kfmaps.app.batch.work import map_path
from kfmaps.app.files import load_map, read_mesh, read_vertex_numbers, save_map, write_mesh, write_vertex_numbers
from kfmaps.config import Config, Search
from kfmaps.fit.shape import prepare
from kfmaps.functional.points import to_functional, to_points
from kfmaps.many.agree import FUNCTIONS, Choice, Link, agree, orthogonal
from kfmaps.many.zoom import ConsistentZoomOut, through_latent
from kfmaps.surface.coarse import coarse
from kfmaps.surface.geodesics import geodesic_distances
from kfmaps.surface.mesh import Mesh
from kfmaps.surface.samples import stratified

FULL = Config.automatic()
QUICK = replace(FULL, search=Search(candidates=2, signs=3), finish=None)
"""A smaller search: what is measured is the collection, not the search."""
SPECTRAL = replace(FULL, descriptors=replace(FULL.descriptors, shot=False))
LINES = 500
"""Points of the body whose places are known on every specimen."""
JUDGED = 200
"""Of the true points of a collection, those at which consistent ZoomOut is judged."""


def specimen(body: Mesh, vertices: int, rng: np.random.Generator) -> tuple[Mesh, np.ndarray]:
    """A variant of ``body`` with ``vertices`` vertices, and where the first :data:`LINES` of its points are on it."""
    places = body.vertices - body.vertices.mean(axis=0)
    places = places / np.abs(places).max()
    x, y, z = (places * rng.uniform(0.85, 1.15, 3)).T
    bend, twist = rng.uniform(-0.2, 0.2), rng.uniform(-0.3, 0.3)
    x = x + bend * y**2
    x, z = np.cos(twist * y) * x - np.sin(twist * y) * z, np.sin(twist * y) * x + np.cos(twist * y) * z
    moved = np.stack([x, y, z], axis=1)
    centre = moved[rng.integers(len(moved))]
    swell = 0.3 * rng.uniform(-1, 1) * np.exp(-((moved - centre) ** 2).sum(axis=1) / 0.1)
    moved = centre + (moved - centre) * (1 + swell[:, None])
    kept = np.sort(stratified(places, np.ones(len(places)), vertices, rng))
    mesh = coarse(Mesh(moved, body.faces), kept)
    lines = np.linspace(0, len(places) - 1, LINES).astype(np.int64)
    return mesh, np.asarray(KDTree(moved[kept]).query(moved[lines])[1])


def write_specimens(folder: Path, count: int, vertices: int) -> None:
    """``count`` specimens with their truth, in the layout of the field."""
    (folder / "corres").mkdir(parents=True)
    body = datasets.two_poses(max(3 * vertices, 3000)).source
    for i in range(count):
        mesh, lines = specimen(body, vertices, np.random.default_rng(i))
        write_mesh(folder / f"s{i:04d}.ply", mesh)
        write_vertex_numbers(folder / "corres" / f"s{i:04d}.vts", lines)


def cpu() -> float:
    """CPU seconds of this process and of its workers that have ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in used)


def measured(count: int, vertices: int, workers: int, wrong: float, full: bool, folder: Path) -> str:
    """One row of the table."""
    shapes, out = folder / f"shapes{count}", folder / f"out{count}"
    write_specimens(shapes, count, vertices)
    collection, settings = find_collection(shapes), Settings(FULL if full else QUICK)
    begin, used = time.perf_counter(), cpu()
    with crew(workers) as hands:
        pairs = graph_pairs(collection, settings, out, "near", hands)
    plan = make_plan(collection, pairs, settings, out)
    match_collection(plan, workers=workers, worst=0)
    matched, between = cpu() - used, cpu()
    rng = np.random.default_rng(0)
    planted = rng.permutation(len(pairs))[: round(wrong * len(pairs))]
    for i in planted:
        path = map_path(plan.folder, pairs[i].key)
        found = load_map(path)
        points = rng.permutation(found.target_to_source)
        extra = {k: v for k, v in found.extra.items() if k not in ("raw_functional_map", "runners_up")}
        save_map(path, replace(found, target_to_source=points, extra=extra), force=True)
    outcome = match_collection(make_plan(collection, pairs, settings, out), workers=workers, worst=0, consistent=True)
    agreed, seconds = cpu() - between, time.perf_counter() - begin
    assert outcome.agreed is not None
    bad = {(pairs[i].source, pairs[i].target) for i in planted}
    changed = {(r.source, r.target) for r in outcome.results if r.changed}
    errors = np.array([r.error_mean for r in outcome.results])
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e6
    disk = sum(p.stat().st_size for p in out.rglob("*") if p.is_file()) / 1e9
    return (
        f"{count:6d} {len(pairs):6d} {matched / count:10.2f} {agreed / count:10.2f} {seconds:8.0f} {peak:7.2f} "
        f"{disk:7.2f} "
        f"{100 * errors.mean():6.2f} {100 * errors.max():6.2f} {len(bad):6d} {len(bad & changed):6d} "
        f"{len(changed - bad):6d}"
    )


def agreement(count: int, wrong: float) -> str:
    """CPU seconds a shape of :func:`kfmaps.many.agree.agree` on noisy maps of which a part is random, and what it says.

    Each shape is joined with two successors and a shape anywhere: as many pairs as ``--graph near`` makes.
    """
    rng = np.random.default_rng(0)
    frames = [orthogonal(rng.normal(size=(FUNCTIONS, FUNCTIONS))) for _ in range(count)]
    ends = [(i, (i + step) % count) for i in range(count) for step in (1, 2, int(rng.integers(3, count - 2)))]
    bad = rng.permutation(len(ends))[: round(wrong * len(ends))]
    maps = [frames[b] @ frames[a].T + 0.05 * rng.normal(size=(FUNCTIONS, FUNCTIONS)) for a, b in ends]
    for i in bad:
        maps[i] = orthogonal(rng.normal(size=(FUNCTIONS, FUNCTIONS)))
    links = [Link(a, b, (Choice(C),)) for (a, b), C in zip(ends, maps, strict=True)]
    begin = time.process_time()
    found = agree(count, links)
    used = time.process_time() - begin
    believed = np.array([chances[0] > 0.5 for chances in found.chances])
    right = np.ones(len(ends), dtype=bool)
    right[bad] = False
    told = f"{(~believed & ~right).sum():6d} {(~believed & right).sum():6d}"
    return f"{count:6d} {len(ends):6d} {used / count:10.3f} {len(bad):6d} {told}"


def zoomed(data: Path, out: Path, only: str = "*") -> None:
    """A table of consistent ZoomOut on the maps in use of a run: those of which both shapes are like ``only``."""
    collection = find_collection(data)
    done = [result for path in sorted((out / "pairs").glob("*.json")) if (result := read_result(path)) is not None]
    named = [Pair(r.source, r.target) for r in done if r.status == "done"]
    pairs = [p for p in named if all(any(fnmatch(n, o) for o in only.split(",")) for n in (p.source, p.target))]
    names = sorted({name for pair in pairs for name in (pair.source, pair.target)})
    shapes = {name: prepare(read_mesh(collection.shapes[name]), SPECTRAL, name=name) for name in names}
    whole = {name: read_vertex_numbers(collection.truth[name]) for name in names}
    truth = {name: true[np.linspace(0, len(true) - 1, JUDGED).astype(np.int64)] for name, true in whole.items()}
    away = {name: geodesic_distances(shapes[name].mesh, truth[name]) for name in {pair.source for pair in pairs}}
    ends = [(names.index(pair.source), names.index(pair.target)) for pair in pairs]
    points = [load_map(map_in_use(out, pair.key)).target_to_source for pair in pairs]
    bases = [shapes[name].basis for name in names]

    def mean(found: list[np.ndarray]) -> float:
        both = zip(pairs, found, strict=True)
        errors = [away[p.source][np.arange(JUDGED), images[truth[p.target]]].mean() for p, images in both]
        return 100 * float(np.mean(errors))

    print(f"{len(pairs)} maps in use: {mean(points):.2f}\n functions  cut  through the latent space  worse    CPU s")
    for k in (20, 40, 60):
        few = [basis.truncated(k) for basis in bases]
        cut = [np.asarray(to_functional(p, few[a], few[b])) for p, (a, b) in zip(points, ends, strict=True)]
        begin = time.process_time()
        latent = ConsistentZoomOut(min(20, k), k, 10)(bases, ends, points)[1]
        used = time.process_time() - begin
        through = [through_latent(latent, a, b) for a, b in ends]
        own, joint = (
            mean([to_points(C, few[a], few[b], threads=1) for C, (a, b) in zip(maps, ends, strict=True)])
            for maps in (cut, through)
        )
        print(f"{k:10d} {own:5.2f} {joint:8.2f} {100 * (joint / own - 1):+20.0f} % {used:8.1f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shapes", default="25,50,100")
    parser.add_argument("--vertices", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--wrong", type=float, default=0.2)
    parser.add_argument("--out", type=Path)
    parser.add_argument(
        "--full", action="store_true", help="the recommended search and finish, about three times as long"
    )
    parser.add_argument("--plan", action="store_true")
    parser.add_argument("--zoom", action="store_true")
    parser.add_argument("--agree", action="store_true")
    parser.add_argument("--run", nargs=2, type=Path, metavar=("DATA", "OUT"))
    parser.add_argument("--only", default="*", help="of such a run, shapes like these, with commas")
    chosen = parser.parse_args()
    counts = [int(word) for word in chosen.shapes.split(",")]
    if chosen.agree:
        print("CPU seconds a shape to agree alone\nshapes  pairs    seconds  wrong  found  other")
        for count in counts:
            print(agreement(count, chosen.wrong), flush=True)
        return
    if chosen.run:
        zoomed(chosen.run[0], chosen.run[1], chosen.only)
        return
    if chosen.plan:
        for count in counts:
            print(needed(count, 3 * count, chosen.vertices, Config.automatic(), chosen.workers).told())
        return
    print(
        "CPU seconds a shape to match and to agree, seconds in all, GB of memory and disk, errors, planted maps:\n"
        "shapes  pairs      match      agree  seconds  memory    disk   mean  worst  wrong  found  other"
    )
    with tempfile.TemporaryDirectory() as temporary:
        for count in counts:
            folder = chosen.out or Path(temporary)
            print(measured(count, chosen.vertices, chosen.workers, chosen.wrong, chosen.full, folder), flush=True)
            if chosen.zoom:
                zoomed(folder / f"shapes{count}", folder / f"out{count}")


if __name__ == "__main__":
    main()
