"""Cost and accuracy of a collection of generated specimens against their number.

    python benchmarks/collection.py [--shapes 25,50,100] [--vertices 1000] [--workers 2] [--out DIR] [--wrong 0.2]
    python benchmarks/collection.py --shapes 1000 --plain --workers 1 --out DIR

Every specimen is one body bent, stretched and swollen at random, and triangulated for itself, so that the truth is
known. Pairs are chosen by likeness (``--graph near``), matched by ``kfmaps batch``'s own machinery, and made to agree
(``--consistent``). A part ``--wrong`` of the maps is replaced by random ones before that. ``--plain`` makes one fit of
each pair and a short refinement instead of a search, which is cheap, and wrong more often than a search is. With
``--out`` the same call goes on where it was cut short. ``--agree`` measures the agreement alone, on made-up maps of as
many shapes. Errors are in per cent of √area.
"""

from __future__ import annotations

import argparse
import json
import resource
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from kfmaps import datasets
from kfmaps.batch.consistent import map_in_use
from kfmaps.batch.jobs import WorkerPool
from kfmaps.batch.layout import find_collection
from kfmaps.batch.plan import graph_pairs, make_plan
from kfmaps.batch.progress import RunStatus
from kfmaps.batch.results import BAD, Result
from kfmaps.batch.run import BatchResult, run_batch
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.work import PairTask, load_prepared, map_path, true_vertices
from kfmaps.collection.synchronization import N_FUNCTIONS, CandidateMap, Edge, synchronize
from kfmaps.config import BasisConfig, Config, DescriptorConfig, Search
from kfmaps.evaluation import assess
from kfmaps.fmap.constraints import nearest_orthogonal
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.coarsen import coarsen
from kfmaps.geometry.mesh import Mesh
from kfmaps.geometry.sampling import stratified
from kfmaps.io import load_map, save_map, write_mesh, write_vertex_numbers
from kfmaps.matching.result_groups import MatchFit

FULL = Config()
QUICK = replace(FULL, search=Search(candidates=2, n_sign_functions=3), registration=None)
"""A smaller search: what is measured is the collection, not the search."""
PLAIN = replace(
    Config.single_fit(),
    basis=BasisConfig(n_eigenfunctions=40),
    descriptors=DescriptorConfig(n_spectral=40, n_eigenfunctions=100, shot=True),
    refinement=ZoomOut(start=40, stop=100, step=20, descriptor_weight=36.0),
    registration=None,
)
"""One fit and no search: what is measured is what a collection costs whatever its pairs cost."""
EVERY = 200
"""Pairs after which a line is printed while they are matched."""
SPECTRAL = replace(FULL, descriptors=replace(FULL.descriptors, shot=False))
LINES = 200
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
    mesh = coarsen(Mesh(moved, body.faces), kept)
    lines = np.linspace(0, len(places) - 1, LINES).astype(np.int64)
    return mesh, np.asarray(KDTree(moved[kept]).query(moved[lines])[1])


def write_specimens(folder: Path, count: int, vertices: int) -> None:
    """``count`` specimens with their truth, in the layout of the field; those that are there are left."""
    (folder / "corres").mkdir(parents=True, exist_ok=True)
    body = datasets.two_poses(max(3 * vertices, 3000)).source
    for i in range(count):
        mesh_path, truth_path = folder / f"s{i:04d}.ply", folder / "corres" / f"s{i:04d}.vts"
        if not truth_path.exists():
            mesh, lines = specimen(body, vertices, np.random.default_rng(i))
            write_mesh(mesh_path, mesh, force=True)
            write_vertex_numbers(truth_path, lines)


def cpu() -> np.ndarray:
    """CPU seconds of this process, and of its workers that have ended: (2,)."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return np.array([u.ru_utime + u.ru_stime for u in used])


@contextmanager
def spending(path: Path, stage: str) -> Iterator[None]:
    """Add what the block costs to the ``stage`` in the file at ``path``: CPU seconds here and of workers, seconds."""
    before, begin = cpu(), time.perf_counter()
    try:
        yield
    finally:
        spent = read_costs(path)
        now = [*(cpu() - before).tolist(), time.perf_counter() - begin]
        spent[stage] = [a + b for a, b in zip(spent.get(stage, [0.0] * len(now)), now, strict=True)]
        path.write_text(json.dumps(spent), encoding="utf-8")


def read_costs(path: Path) -> dict[str, list[float]]:
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def watching(total: int):
    """A callback that prints how far a run is, now and then."""
    begin = time.perf_counter()

    def told(status: RunStatus, result: Result | None) -> None:
        if result is not None and status.pairs_done % EVERY == 0:
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
            seconds = time.perf_counter() - begin
            print(f"  {status.pairs_done}/{total} pairs, {seconds:.0f} s, {peak:.2f} GB here", file=sys.stderr)

    return told


def plant(tasks: tuple[PairTask, ...], wrong: float, note: Path) -> list[tuple[str, str]]:
    """Replace a part of the maps by random ones, unless the ``note`` says that it is done; which."""
    rng = np.random.default_rng(0)
    planted = rng.permutation(len(tasks))[: round(wrong * len(tasks))]
    if not note.exists():
        for i in planted:
            path = map_path(Path(tasks[i].folder), tasks[i].pair.key)
            found = load_map(path)
            points = rng.permutation(found.target_to_source)
            planted_map = replace(found, target_to_source=points, precise_map=None, alternatives=(), fit=MatchFit())
            save_map(path, planted_map, force=True)
        note.write_text("done\n", encoding="utf-8")
    return [(tasks[i].pair.source, tasks[i].pair.target) for i in planted]


def error_in_use(task: PairTask) -> float:
    """Mean error of the map of a pair that is in use, worked out anew."""
    points = load_map(map_in_use(Path(task.folder), task.pair.key)).target_to_source
    source, target = load_prepared(task.source).mesh, load_prepared(task.target).mesh
    truth = true_vertices(task, len(source.vertices), len(target.vertices))
    assert truth is not None
    return assess(source, points, truth).errors.mean


def going_on(outcome: BatchResult) -> BatchResult:
    """``outcome`` of a run that was not interrupted."""
    if outcome.interrupted:
        raise KeyboardInterrupt("interrupted: the same call goes on")
    return outcome


def measured(count: int, vertices: int, workers: int, wrong: float, config: Config, folder: Path) -> str:
    """One row of the table."""
    shapes, out = folder / f"shapes{count}", folder / f"out{count}"
    write_specimens(shapes, count, vertices)
    collection, settings = find_collection(shapes), RunSpec(config)
    costs = folder / f"costs{count}.json"
    with spending(costs, "match"):
        with WorkerPool(workers) as hands:
            pairs = graph_pairs(collection, settings, out, "near", hands)
        plan = make_plan(collection, pairs, settings, out)
        if plan.todo:
            going_on(run_batch(plan, workers=workers, worst=0, callback=watching(len(pairs))))
    planted = set(plant(plan.tasks, wrong, out / "planted"))
    with spending(costs, "agree"):
        plan = make_plan(collection, pairs, settings, out)
        outcome = going_on(run_batch(plan, workers=workers, worst=0, consistent=True))
    changed = {(r.source, r.target): float(r.error_mean or 0.0) for r in outcome.results if r.changed}
    keys = [(task.pair.source, task.pair.target) for task in plan.tasks]
    matched = {(r.source, r.target): float(r.error_mean or 0.0) for r in plan.results}
    before, now = np.array([matched[key] for key in keys]), []
    for task, key in zip(plan.tasks, keys, strict=True):
        left = key in planted and key not in changed
        now.append(error_in_use(task) if left else changed.get(key, matched[key]))
    after, random = np.array(now), np.array([key in planted for key in keys])
    exchanged, bad = np.array([key in changed for key in keys]), random | (before > BAD)
    spent = read_costs(costs)
    peaks = [resource.getrusage(w).ru_maxrss / 1e6 for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    disk = sum(p.stat().st_size for p in out.rglob("*") if p.is_file()) / 1e9
    each = " ".join(f"{spent[stage][who] / count:8.2f}" for stage in ("match", "agree") for who in (1, 0))
    return (
        f"{count:6d} {len(pairs):6d} {each} {sum(s[2] for s in spent.values()):8.0f} {peaks[1]:6.2f} {peaks[0]:6.2f} "
        f"{disk:6.2f} {100 * before.mean():6.2f} {(before > BAD).sum():5d} {random.sum():7d} {bad.sum():5d} "
        f"{(bad & (after <= BAD)).sum():6d} {100 * after.mean():6.2f} {(after > BAD).sum():6d} "
        f"{(~bad & (after > BAD)).sum():6d} {(random & exchanged).sum():6d} {(~bad & exchanged).sum():6d}"
    )


def agreement(count: int, wrong: float) -> str:
    """CPU seconds a shape of :func:`kfmaps.collection.synchronization.synchronize` on noisy maps of which a part is
    random, and what it says.

    Each shape is joined with two successors and a shape anywhere: as many pairs as ``--graph near`` makes.
    """
    rng = np.random.default_rng(0)
    frames = [nearest_orthogonal(rng.normal(size=(N_FUNCTIONS, N_FUNCTIONS))) for _ in range(count)]
    ends = [(i, (i + step) % count) for i in range(count) for step in (1, 2, int(rng.integers(3, count - 2)))]
    bad = rng.permutation(len(ends))[: round(wrong * len(ends))]
    maps = [frames[b] @ frames[a].T + 0.05 * rng.normal(size=(N_FUNCTIONS, N_FUNCTIONS)) for a, b in ends]
    for i in bad:
        maps[i] = nearest_orthogonal(rng.normal(size=(N_FUNCTIONS, N_FUNCTIONS)))
    links = [Edge(a, b, (CandidateMap(C),)) for (a, b), C in zip(ends, maps, strict=True)]
    begin = time.process_time()
    found = synchronize(count, links)
    used = time.process_time() - begin
    believed = np.array([chances[0] > 0.5 for chances in found.probabilities])
    right = np.ones(len(ends), dtype=bool)
    right[bad] = False
    told = f"{(~believed & ~right).sum():6d} {(~believed & right).sum():6d}"
    return f"{count:6d} {len(ends):6d} {used / count:10.3f} {len(bad):6d} {told}"


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
    parser.add_argument("--plain", action="store_true", help="one fit of each pair and a short refinement")
    parser.add_argument("--agree", action="store_true")
    chosen = parser.parse_args()
    counts = [int(word) for word in chosen.shapes.split(",")]
    if chosen.agree:
        print("CPU seconds a shape to agree alone\nshapes  pairs    seconds  wrong  found  other")
        for count in counts:
            print(agreement(count, chosen.wrong), flush=True)
        return
    config = FULL if chosen.full else PLAIN if chosen.plain else QUICK
    print(
        "CPU seconds a shape to match and to agree, by workers and by the process that hands out the work; seconds in"
        "\nall; GB of a worker, of that process, on disk; mean error and maps above 5 as they were matched; random ones"
        "\nput in; wrong ones in all, those of them mended; mean error and maps above 5 in the end; right ones harmed;"
        "\nrandom ones and right ones exchanged"
        "\nshapes  pairs    match     here    agree     here  seconds worker   here   disk  error above planted wrong "
        "mended  error  above harmed  found  other"
    )
    with tempfile.TemporaryDirectory() as temporary:
        for count in counts:
            folder = chosen.out or Path(temporary)
            print(measured(count, chosen.vertices, chosen.workers, chosen.wrong, config, folder), flush=True)


if __name__ == "__main__":
    main()
