"""Maps on the field's benchmarks, without landmarks or with some: errors, verdicts and times, one setting for all.

    python benchmarks/automatic.py --data DIR [--sets FAUST_r,SHREC19_r,...] [--pairs 60] [--workers 2] [--json FILE]
    python benchmarks/automatic.py --data DIR --landmarks 0,1,2,3,5,10,25 [--wrong 0.2] [--pyfm]
    python benchmarks/automatic.py --data DIR --cut [--half choice]
    python benchmarks/automatic.py --data DIR --time

DIR holds folders in the layouts of docs/collections.md, and ``cross/cat_dog.txt``; without it only the package's own
shapes are matched. What the settings were chosen on is left out: pairs of which both shapes are in the half named by
:data:`CHOSEN_ON`. At the end stand, over all sets, how many maps were called what, and how often that was right.
With ``--pyfm`` rows of pyFM with the same landmarks stand between, of which it needs one at least (by_pyfm.py). With
``--cut`` the target is what lies above a random plane, 35 to 70 % of its vertices; ``--half choice`` takes the others.
"""

from __future__ import annotations

import argparse
import json
import time
import warnings
import zlib
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from itertools import permutations, product
from pathlib import Path

import numpy as np

import kfmaps
from kfmaps import datasets
from kfmaps.geometry.connectivity import renumbering
from kfmaps.kernels.landmark_selection import farthest_descriptors

CHOSEN_ON = {
    "FAUST_r": {f"tr_reg_{i:03d}" for i in range(40)},
    "SHREC19_r": {"2", "9", "13", "19", "26", "32", "36", "39"},
    "TOSCA_r": {"cat0", "cat8", "cat10", "dog0", "dog3", "dog8", "horse0", "horse6", "horse17", "centaur0", "centaur3"},
    "catdog": {"cat0", "cat8", "cat10", "dog0", "dog3", "dog8"},
    "TOSCA_nonIsometric_r": {"8_gorilla_01", "8_woman_01", "8_woman_02"},
    "SMAL_r": {"dog_01", "dog_02", "cow_01", "cow_03", "lion_02", "lion_03", "fox_01", "wolf_01"},
    "SHREC07": {"381", "382", "383", "385"},
    "TOPKIDS": {f"kid{i:02d}" for i in range(7)},
}
OWN = (("two_poses", 5), ("symmetric_creature", 5), ("non_isometric", 5), ("non_isometric", 6))
RIGHT = 8.0
"""Mean error × 100 below which a map counts as right."""


@dataclass(frozen=True, eq=False)
class Job:
    """One pair: the set and the names of its shapes, how many landmarks are given and how many of them are wrong."""

    data: Path | None
    kind: str
    source: str
    target: str
    landmarks: int = 0
    wrong: float = 0.0
    threads: int = 1
    cut: bool = False

    def __str__(self) -> str:
        return f"{self.kind} {self.source} {self.target}"


def read(path: Path) -> kfmaps.Mesh:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
        return kfmaps.read_mesh(path)


def mesh_file(folder: Path, name: str) -> Path:
    return next(folder / f"{name}{e}" for e in (".ply", ".off") if (folder / f"{name}{e}").exists())


def lines(folder: Path, name: str) -> np.ndarray:
    return np.loadtxt(folder / "corres" / f"{name}.vts", dtype=np.int64) - 1


def loaded(job: Job) -> tuple[kfmaps.Mesh, kfmaps.Mesh, np.ndarray, np.ndarray]:
    """Both meshes and true pairs of vertices."""
    if job.kind == "own":
        pair = getattr(datasets, job.source)(4000, rng=int(job.target))
        return pair.source, pair.target, pair.truth, np.arange(len(pair.truth))
    assert job.data is not None
    folder = job.data / ("TOSCA_r" if job.kind == "catdog" else job.kind)
    whole = job.data / "FAUST_r" if job.kind.startswith("PFAUST") else folder
    meshes = read(mesh_file(whole, job.source)), read(mesh_file(folder, job.target))
    if job.kind == "catdog":
        both = np.loadtxt(job.data / "cross" / "cat_dog.txt", dtype=np.int64) - 1
        side = 0 if job.source.startswith("cat") else 1
        return *meshes, lines(folder, job.source)[both[:, side]], lines(folder, job.target)[both[:, 1 - side]]
    if job.kind.startswith("PFAUST") or job.kind in ("TOPKIDS", "SMAL_r"):
        name = f"truth/{job.source}-{job.target}" if job.kind == "SMAL_r" else job.target
        true = np.loadtxt(folder / f"{name}.txt", dtype=np.int64)
        return *meshes, true[:, 0], true[:, 1]
    if job.kind == "SHREC07":
        true_s, true_t = (np.loadtxt(folder / f"{name}.txt", dtype=np.int64) for name in (job.source, job.target))
        return *meshes, true_s, true_t
    if job.kind == "SHREC16":
        places = np.loadtxt(folder / f"{job.target}.baryc_gt")
        corners = meshes[0].faces[places[:, 0].astype(np.int64) - 1]
        vertices = corners[np.arange(len(corners)), places[:, 1:4].argmax(axis=1)]
        return *meshes, vertices, np.arange(len(vertices))
    return *meshes, lines(folder, job.source), lines(folder, job.target)


def all_pairs(kind: str, data: Path) -> list[tuple[str, str]]:
    """All pairs of a set."""
    folder = data / ("TOSCA_r" if kind == "catdog" else kind)
    if kind in ("catdog", "TOSCA_r"):
        names = sorted(p.stem for p in folder.glob("*.off"))
        animal = {name: name.rstrip("0123456789") for name in names}
        wanted = [("cat", "dog"), ("dog", "cat")] if kind == "catdog" else [(a, a) for a in set(animal.values())]
        found = [(a, b) for a, b in permutations(names, 2) if (animal[a], animal[b]) in wanted]
        return [(a, b) for a, b in found if kind == "catdog" or a < b]
    text = (folder / "test_pairs.txt").read_text(encoding="utf-8").split("\n")
    found = [(a, b) for a, b in (line.split() for line in text if line.strip())]
    if kind == "FAUST_r":
        found = [(a, b) for a, b in found if int(a[-3:]) // 10 != int(b[-3:]) // 10]
    return found


def pairs_of(kind: str, data: Path | None, count: int) -> list[tuple[str, str]]:
    """At most ``count`` pairs of a set, drawn with a fixed seed, none of two shapes that settings were chosen on."""
    if kind == "own":
        return [(name, str(seed)) for name, seed in OWN]
    assert data is not None
    left_out = CHOSEN_ON.get(kind, set())
    found = [pair for pair in all_pairs(kind, data) if not left_out.issuperset(pair)]
    drawn = np.random.default_rng(0).permutation(len(found))[:count]
    return [found[i] for i in np.sort(drawn)]


def chosen_pairs(kind: str, data: Path | None, half: str, count: int, seed: int = 0) -> list[tuple[str, str]]:
    """At most ``count`` pairs of a half, those of the choice half drawn with a ``seed``."""
    if half == "report":
        return pairs_of(kind, data, count)
    assert data is not None
    found = [pair for pair in all_pairs(kind, data) if CHOSEN_ON[kind].issuperset(pair)]
    drawn = np.random.default_rng(seed).permutation(len(found))[:count]
    return [found[i] for i in np.sort(drawn)]


def pair_options(
    about: str | None, sets: str, pairs: int, half: str = "choice", only: bool = False
) -> argparse.ArgumentParser:
    """The options of benchmarks over pairs: the data, the sets, the half, the most pairs of each set, or ``only``."""
    parser = argparse.ArgumentParser(description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--sets", default=sets)
    parser.add_argument("--half", choices=("choice", "report"), default=half)
    parser.add_argument("--pairs", type=int, default=pairs, help="at most, of each set")
    if only:
        parser.add_argument("--only", nargs="+", metavar="SET,SOURCE,TARGET", help="these pairs alone")
    return parser


def chosen_jobs(options: argparse.Namespace, seed: int = 0) -> list[Job]:
    """The pairs that :func:`pair_options` ask for, set by set; ``seed`` as of :func:`chosen_pairs`."""
    data, half, count = options.data, options.half, options.pairs
    if getattr(options, "only", None):
        return [Job(data, *pair.split(",")) for pair in options.only]
    return [Job(data, s, *pair) for s in options.sets.split(",") for pair in chosen_pairs(s, data, half, count, seed)]


def piece(job: Job, mesh: kfmaps.Mesh, true: np.ndarray) -> tuple[kfmaps.Mesh, np.ndarray, np.ndarray]:
    """The largest piece of a target above a random plane, which of its ``true`` vertices it has, and their numbers.

    Landmarks of few vertices may all lie below; then another plane is drawn.
    """
    rng = np.random.default_rng(zlib.crc32(str(job).encode()))
    while True:
        height = mesh.vertices @ rng.normal(size=3)
        part, kept = datasets.largest_piece(mesh, height > np.quantile(height, rng.uniform(0.3, 0.65)))
        number = renumbering(kept, len(mesh.vertices))[true]
        if (number >= 0).any():
            return part, number >= 0, number[number >= 0]


def chosen_landmarks(source: kfmaps.Shape, true: tuple[np.ndarray, np.ndarray], count: int, wrong: float) -> np.ndarray:
    """``count`` true pairs spread over the source, a part ``wrong`` of them with another target."""
    _, rows = np.unique(true[0], return_index=True)
    rows = rows[np.unique(true[1][rows], return_index=True)[1]]
    places = source.basis.functions[true[0][rows], 1:40] / source.basis.eigenvalues[1:40]
    rng = np.random.default_rng(0)
    pairs = np.stack(true, axis=1)[rows[farthest_descriptors(places, count, rng)]]
    bad = rng.permutation(count)[: round(wrong * count)]
    pairs[bad, 1] = rng.permutation(np.setdiff1d(true[1], pairs[:, 1]))[: len(bad)]
    return pairs


def judged(job: Job) -> dict:
    source, target, true_s, true_t = loaded(job)
    if job.cut:
        target, has, true_t = piece(job, target, true_t)
        true_s = true_s[has]
    config = replace(kfmaps.Config(), threads=job.threads)
    start = time.process_time() if job.threads == 1 else time.perf_counter()
    shapes = [kfmaps.prepare(mesh, config, name=name) for mesh, name in ((source, "source"), (target, "target"))]
    pairs = chosen_landmarks(shapes[0], (true_s, true_t), job.landmarks, job.wrong) if job.landmarks else None
    found = kfmaps.match(shapes[0], shapes[1], config, landmarks=pairs)
    end = time.process_time() if job.threads == 1 else time.perf_counter()
    points = found.target_to_source[true_t]
    errors = kfmaps.geodesic_errors(source, points[points >= 0], true_s[points >= 0])
    return {
        "set": job.kind,
        "pair": f"{job.source} {job.target}",
        "landmarks": job.landmarks,
        "error": 100 * float(errors.mean()),
        "verdict": found.verdict,
        "confidence": found.confidence,
        "orientation": found.orientation,
        "doubted": found.score.rejected_landmarks.tolist(),
        "scores": list(found.score.scores),
        "quality": found.score.quality,
        "bending": found.score.deformation_energy,
        "seconds": end - start,
        "stages": {**{f"{k} of both": sum(s.seconds[k] for s in shapes) for k in shapes[0].seconds}, **found.seconds},
    }


def judged_by_pyfm(job: Job) -> dict:
    """The error of pyFM's map with the same landmarks."""
    import by_pyfm

    source, target, true_s, true_t = loaded(job)
    config = replace(kfmaps.Config(), threads=job.threads)
    pairs = chosen_landmarks(kfmaps.prepare(source, config), (true_s, true_t), job.landmarks, job.wrong)
    start = time.process_time()
    found = by_pyfm.points(source, target, pairs)
    seconds = time.process_time() - start
    errors = 100 * kfmaps.geodesic_errors(source, found[true_t], true_s)
    names = {"set": f"{job.kind}, pyFM", "pair": f"{job.source} {job.target}", "landmarks": job.landmarks}
    return {**names, "error": float(errors.mean()), "verdict": "", "confidence": None, "seconds": seconds}


def report(title: str, rows: list[dict]) -> None:
    errors = np.array([r["error"] for r in rows])
    called = [sum(r["verdict"] == name for r in rows) for name in ("sure", "likely", "ambiguous", "unlikely")]
    wrong = sum(r["verdict"] == "sure" and r["error"] >= RIGHT for r in rows)
    print(
        f"{title:34} {len(rows):4} {errors.mean():7.2f} {np.median(errors):7.2f} {errors.max():7.2f}"
        f" {int((errors > 10).sum()):6} {called[0]:6} {called[1]:6} {called[2]:6} {called[3]:6} {wrong:8}"
        f" {np.mean([r['seconds'] for r in rows]):7.1f}"
    )


def reliability(rows: list[dict]) -> None:
    """How often maps of about one confidence are right."""
    print("\nconfidence      maps   mean confidence   right")
    for low, high in ((0, 0.2), (0.2, 0.5), (0.5, 0.8), (0.8, 0.95), (0.95, 1.01)):
        here = [r for r in rows if r["confidence"] is not None and low <= r["confidence"] < high]
        if here:
            right = np.mean([r["error"] < RIGHT for r in here])
            mean = np.mean([r["confidence"] for r in here])
            print(f"{low:.2f} to {min(high, 1):.2f} {len(here):7} {mean:17.2f} {right:7.2f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--sets", default="FAUST_r,SHREC19_r,TOSCA_r,catdog,TOSCA_nonIsometric_r,SHREC16,PFAUST_M,own")
    parser.add_argument("--pairs", type=int, default=60, help="at most, of each set")
    parser.add_argument("--landmarks", default="0", help="how many, several numbers for a curve")
    parser.add_argument("--wrong", type=float, default=0.0, help="part of the landmarks that are wrong")
    parser.add_argument("--pyfm", action="store_true", help="pyFM with the same landmarks too")
    parser.add_argument("--cut", action="store_true", help="the targets are cut by planes")
    parser.add_argument("--half", choices=("choice", "report"), default="report")
    parser.add_argument("--workers", type=int, default=2, help="pairs at once, each with one thread")
    parser.add_argument("--time", action="store_true", help="only time five pairs of FAUST_r, one after the other")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if arguments.time:
        pairs = pairs_of("FAUST_r", arguments.data, 5)
        rows = [judged(Job(arguments.data, "FAUST_r", *pair)) for pair in pairs]
        for stage in rows[0]["stages"]:
            print(f"{stage:34}{np.mean([r['stages'][stage] for r in rows]):8.2f}")
        print(f"{'whole match, one thread, CPU':34}{np.mean([r['seconds'] for r in rows]):8.2f}")
        return
    counts = [int(word) for word in arguments.landmarks.split(",")]
    everything: list[dict] = []
    heads = ("pairs", "mean", "median", "worst", ">10", "sure", "likely", "ambig.", "unlik.", "sure, ≥8", "CPU s")
    print(f"{'mean error × 100':34} " + " ".join(heads))
    with ProcessPoolExecutor(arguments.workers) as pool:
        for kind, count in product(arguments.sets.split(","), counts):
            if kind != "own" and arguments.data is None:
                continue
            pairs = chosen_pairs(kind, arguments.data, arguments.half, arguments.pairs)
            jobs = [Job(arguments.data, kind, *pair, count, arguments.wrong, cut=arguments.cut) for pair in pairs]
            rows = list(pool.map(judged, jobs))
            report(kind + (f", {count} landmarks" if len(counts) > 1 or count else ""), rows)
            everything += rows
            if arguments.pyfm and count:
                rows = list(pool.map(judged_by_pyfm, jobs))
                report(f"{kind}, {count} landmarks, pyFM", rows)
                everything += rows
    reliability(everything)
    if arguments.json:
        arguments.json.write_text(json.dumps(everything, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
