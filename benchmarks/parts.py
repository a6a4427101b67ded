"""Parts matched to their wholes: errors, overlaps, verdicts and times, one setting for all.

    python benchmarks/parts.py --data DIR [--sets cuts,holes,PFAUST_M,PFAUST_H] [--half report] [--every 2]
    python benchmarks/parts.py --data DIR --landmarks 6
    python benchmarks/parts.py --data DIR --turned
    python benchmarks/parts.py --data DIR --both

DIR holds ``SHREC16``, ``PFAUST_M``, ``PFAUST_H`` and the wholes of the latter in ``FAUST_r``, each with
``test_pairs.txt`` of lines "whole part". Settings were chosen on the wholes of :data:`CHOSEN_ON`; ``--half report``
leaves these out. ``--turned`` turns each part at random and scales it by a factor from 0.1 to 10, ``--landmarks`` gives
farthest points of the part. Errors are distances on the whole between points inside triangles, in % of its √area, over
the vertices that the map gives a counterpart; the overlap is intersection over union of areas of the whole. At the end
stand the errors by the area that is missing. The last column is the most memory that the process has held so far.
``--json ROWS.json`` keeps one line for each pair, and spares what it has.

``--both`` matches each of the SHREC'16 cuts of an animal to the next but one, neither of which holds all of the other:
errors are over the target's vertices that both truly have and the map gives a counterpart, the overlap is of areas of
the target, and "missing" is the part of its area that the source lacks: pairs with more than three quarters of it
missing are left out.
"""

from __future__ import annotations

import argparse
import json
import resource
import tempfile
import time
import warnings
import zlib
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import kfmaps
from kfmaps.evaluation import PartTruth, part_accuracy, read_part_truth
from kfmaps.fmap.evaluate import precise_errors
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.closest_points import closest_points
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh, boundary_vertices, unit_area, vertex_areas
from kfmaps.io import load_map
from kfmaps.matching.partial.match_partial import COMMON
from kfmaps.matching.partial.registration import overlap_probability

CHOSEN_ON = {"cat", "horse", *(f"tr_reg_{i:03d}" for i in range(20))}
SETS = {"cuts": "SHREC16", "holes": "SHREC16", "PFAUST_M": "PFAUST_M", "PFAUST_H": "PFAUST_H"}
WIDTHS = (6, 8, 8, 8, 6, 9, 6, 12, 9, 9)
WRONG = 10.0
"""Mean error × 100 above which no map should be called sure."""
COMMON_AT_LEAST = 0.25
"""Of the target's area, for a pair of parts to be matched to each other."""


@dataclass(frozen=True)
class Job:
    """One pair: the set, the names of the whole and the part, and how it is made harder or easier."""

    data: Path
    kind: str
    whole: str
    part: str
    landmarks: int = 0
    turned: bool = False
    other: str = ""
    """A second part, matched instead of the whole."""


def jobs(data: Path, kind: str, half: str) -> list[Job]:
    lines = (data / SETS[kind] / "test_pairs.txt").read_text(encoding="utf-8").split("\n")
    names = [line.split() for line in lines if line.strip()]
    found = [Job(data, kind, whole, part) for whole, part in names]
    found = [job for job in found if kind not in ("cuts", "holes") or job.part.startswith(kind)]
    keep = {"all": (True, False), "choice": (True,), "report": (False,)}[half]
    return [job for job in found if (job.whole in CHOSEN_ON) in keep]


def mesh_of(folder: Path, name: str) -> kfmaps.Mesh:
    path = next(folder / f"{name}{end}" for end in (".ply", ".off") if (folder / f"{name}{end}").exists())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
        return kfmaps.read_mesh(path)


def moved(mesh: kfmaps.Mesh, seed: int) -> kfmaps.Mesh:
    """Turned at random and scaled by a factor from 0.1 to 10."""
    rng = np.random.default_rng(seed)
    rotation = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    rotation *= np.sign(np.linalg.det(rotation))
    return kfmaps.Mesh(10 ** rng.uniform(-1, 1) * mesh.vertices @ rotation.T, mesh.faces)


def read_job(job: Job) -> tuple[kfmaps.Mesh, kfmaps.Mesh, Path]:
    """The whole, the part, and the file of the truth."""
    folder = job.data / SETS[job.kind]
    whole = mesh_of(folder if SETS[job.kind] == "SHREC16" else job.data / "FAUST_r", job.whole)
    ends = (folder / f"{job.part}{end}" for end in (".baryc_gt", ".txt"))
    return whole, mesh_of(folder, job.part), next(path for path in ends if path.exists())


def name_of(job: Job) -> str:
    """What tells one row from another."""
    more = f" landmarks {job.landmarks}" * (job.landmarks > 0) + " turned" * job.turned
    return f"{job.kind} {job.other or job.whole} {job.part}{more}"


def run(job: Job) -> dict[str, object]:
    whole, part, truth_file = read_job(job)
    truth = read_part_truth(truth_file, whole, part)
    marks = None
    if job.landmarks:
        known = np.isin(np.arange(len(part.vertices)), truth.vertices)
        far = farthest_geodesic(part, 4 * job.landmarks, 0)
        far = far[known[far]][: job.landmarks]
        row = (
            np.searchsorted(truth.vertices, far)
            if truth.dense
            else [int(np.flatnonzero(truth.vertices == v)[0]) for v in far]
        )
        at = truth.places.faces[row], truth.places.weights[row]
        marks = np.stack([whole.faces[at[0], at[1].argmax(axis=1)], far], axis=1)
        marks = marks[np.unique(marks[:, 0], return_index=True)[1]]
    given = moved(part, zlib.crc32(job.part.encode())) if job.turned else part
    begun = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
        found = kfmaps.match(whole, given, replace(kfmaps.Config(), threads=1), landmarks=marks)
    seconds = time.process_time() - begun
    with tempfile.TemporaryDirectory() as where:
        path = Path(where) / "map.npz"
        found.save(path)
        scored = part_accuracy(whole, part, load_map(path), truth, "target")
    return {
        "name": name_of(job), "set": job.kind, "whole": job.whole, "part": job.part, "error": 100 * scored.errors.mean,
        "matched": scored.matched, "overlap": scored.overlap, "missing": scored.missing,
        "verdict": found.verdict, "confidence": found.confidence, "seconds": seconds,
        "taken_for_part": found.partial.overlap_target is not None, "score": found.score.scores[0], "gib": peak(),
    }  # fmt: skip


def peak() -> float:
    """The most memory held so far, in GiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20


def both_jobs(data: Path, half: str) -> list[Job]:
    """Pairs of cuts of one animal; ``other`` is the source."""
    cuts = jobs(data, "cuts", half)
    pairs = zip(cuts, cuts[2:], strict=False)
    return [replace(second, kind="both", other=first.part) for first, second in pairs if first.whole == second.whole]


def run_both(job: Job) -> dict[str, object] | None:
    """Two parts of one whole; ``None`` where they hardly have anything in common."""
    folder = job.data / "SHREC16"
    names = job.other, job.part
    whole = unit_area(mesh_of(folder, job.whole))
    parts = [mesh_of(folder, name) for name in names]
    truths: list[PartTruth] = [
        read_part_truth(folder / f"{name}.baryc_gt", whole, part) for name, part in zip(names, parts, strict=True)
    ]
    source, target = (
        Mesh(point_positions(truth.places, whole), part.faces) for truth, part in zip(truths, parts, strict=True)
    )
    true, areas = overlap_probability(source, boundary_vertices(source), target)[0] > COMMON, vertex_areas(target)
    if areas[true].sum() < COMMON_AT_LEAST * areas.sum():
        return None
    config = kfmaps.Config()
    begun = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
        found = kfmaps.match(
            parts[0], parts[1], replace(config, threads=1, partial=replace(config.partial, part="both"))
        )
    seconds = time.process_time() - begun
    rows = np.flatnonzero(true & (found.target_to_source >= 0))
    ours = np.asarray(found.partial.overlap_target) > COMMON
    error = float("nan")
    if len(rows):
        place = found.precise()
        ends = point_positions(PointMap(place.faces[rows], place.weights[rows]), source)
        on, places = closest_points(ends, whole.vertices, whole.faces), truths[1].places
        errors = precise_errors(
            whole, PointMap(on.faces, on.weights), PointMap(places.faces[rows], places.weights[rows])
        )
        error = 100 * float(errors.mean())
    return {
        "name": name_of(job), "set": "both", "whole": job.other, "part": job.part, "error": error,
        "matched": float(areas[rows].sum() / areas[true].sum()),
        "overlap": float(areas[true & ours].sum() / areas[true | ours].sum()),
        "missing": 1 - float(areas[true].sum() / areas.sum()),
        "verdict": found.verdict, "confidence": found.confidence, "seconds": seconds,
        "taken_for_part": True, "score": found.score.scores[0], "gib": peak(),
    }  # fmt: skip


def line(name: str, rows: list[dict[str, object]]) -> str:
    error = np.array([row["error"] for row in rows], dtype=float)
    overlap = np.array([np.nan if row["overlap"] is None else row["overlap"] for row in rows], dtype=float)
    sure = np.array([row["verdict"] == "sure" for row in rows])
    seconds = np.mean([float(str(row["seconds"])) for row in rows])
    share = "" if np.isnan(overlap).all() else f"{100 * np.nanmean(overlap):.1f}"
    return (
        f"{name:24s}{len(rows):6d}{error.mean():8.2f}{np.median(error):8.2f}{error.max():8.2f}"
        f"{(error > WRONG).sum():6d}"
        f"{share:>9s}{sure.sum():6d}{(sure & (error > WRONG)).sum():12d}{seconds:9.1f}"
        f"{max(float(str(row['gib'])) for row in rows):9.2f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--sets", default=",".join(SETS))
    parser.add_argument("--half", choices=("choice", "report", "all"), default="report")
    parser.add_argument("--every", type=int, default=1, help="only every n-th pair of each set")
    parser.add_argument("--first", type=int, default=0, help="the number of the first of these")
    parser.add_argument("--both", action="store_true", help="cuts against other cuts")
    parser.add_argument("--landmarks", type=int, default=0)
    parser.add_argument("--turned", action="store_true")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    heads = zip(
        ("pairs", "mean", "median", "worst", ">10", "IoU %", "sure", "sure, >10", "CPU s", "GiB"), WIDTHS, strict=True
    )
    print(f"{'mean error × 100':24s}" + "".join(f"{word:>{width}s}" for word, width in heads))
    known: dict[str, dict[str, object]] = {}
    if arguments.json is not None and arguments.json.exists():
        lines = arguments.json.read_text(encoding="utf-8").splitlines()
        known = {row["name"]: row for row in map(json.loads, lines)}
    everything: list[dict[str, object]] = []
    for kind in ["both"] if arguments.both else arguments.sets.split(","):
        rows = []
        every = (
            both_jobs(arguments.data, arguments.half) if arguments.both else jobs(arguments.data, kind, arguments.half)
        )
        for job in every[arguments.first :: arguments.every]:
            more = replace(job, landmarks=arguments.landmarks, turned=arguments.turned)
            row = known.get(name_of(more)) or (run_both(job) if arguments.both else run(more))
            if row is None:
                continue
            rows.append(row)
            if arguments.json is not None and row["name"] not in known:
                with arguments.json.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
        if rows:
            print(line(kind, rows), flush=True)
        everything += rows
    for low, high in ((0.0, 0.2), (0.2, 0.4), (0.4, 0.6), (0.6, 1.0)):
        some = [row for row in everything if low <= float(str(row["missing"])) < high]
        if some:
            print(line(f"missing {100 * low:.0f} to {100 * high:.0f} %", some))


if __name__ == "__main__":
    main()
