"""What learned kernels are worth: the tables of research/learning.md.

    python benchmarks/learning.py --data DIR default10=10 tuned=tune.toml learned=kernel.toml [--refined] [--pairs 12]
    python benchmarks/learning.py --data DIR --epoch
    python benchmarks/learning.py --data DIR --starts [NAMES]

DIR holds FAUST_r, TOSCA_r and SHREC19_r. Pairs are of people 4 to 7 (settings are learned and tuned on people 0 to 3),
of two poses of one animal, and of SHREC19_r, in an order drawn with a fixed seed. With settings by name (a file, or a
number: the default settings with so many descriptors) each makes one fit with six landmarks, judged raw and, with
``--refined``, after ZoomOut; each is compared with those before it. ``--epoch`` times one epoch of 30 pairs at k = 50.
``--starts`` compares what gradients may start from: metrics by discriminant analysis on pairs of people 0 and 1, judged
on pairs of people 2 and 3. Errors are mean geodesic distances in per cent of √area; intervals are of a bootstrap over
pairs. ``--rows FILE`` keeps each pair's numbers, so that a run that was cut short goes on; ``--cache DIR`` keeps
prepared shapes and distances.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import permutations
from pathlib import Path

import numpy as np
from scipy.stats import bootstrap

import kfmaps
from kfmaps.batch.cache import load_record, save_record
from kfmaps.fmap.convert import nearest
from kfmaps.geometry.geodesics import geodesic_distances
from kfmaps.io import read_vertex_numbers
from kfmaps.matching.finish import refine_map
from kfmaps.matching.fit import fit
from kfmaps.settings import read_settings

SETS = ("FAUST_r", "TOSCA_r", "SHREC19_r")
REPORTED = tuple(f"tr_reg_{i:03d}" for i in range(40, 80))
LEARNED_ON = tuple(f"tr_reg_{i:03d}" for i in range(40))
FAUST_LINES = np.array([201, 1121, 2041, 2961, 3881, 4801]) - 1
JUDGED = 300
"""True correspondences of a pair at which errors are measured."""
PLAIN = replace(kfmaps.Config.single_fit(), registration=None, threads=1)
SEARCH = replace(kfmaps.Config(), threads=1)


@dataclass(frozen=True, eq=False)
class Data:
    """One set: where it lies, and where prepared shapes are kept."""

    folder: Path
    cache: Path | None

    def truth(self, name: str) -> np.ndarray:
        return read_vertex_numbers(self.folder / "corres" / f"{name}.vts")

    def shape(self, name: str) -> kfmaps.Shape:
        kept = self.cache and self.cache / f"{self.folder.name}-{name}.npz"
        found = load_record(kept, kfmaps.Shape) if kept and kept.exists() else None
        if found is None:
            path = next(self.folder / f"{name}{e}" for e in (".ply", ".off") if (self.folder / f"{name}{e}").exists())
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
                found = kfmaps.prepare(kfmaps.read_mesh(path), SEARCH, name=name)
            if kept:
                save_record(kept, found)
        return found

    def distances(self, shape: kfmaps.Shape, sources: np.ndarray) -> np.ndarray:
        if self.cache is None:
            return geodesic_distances(shape.mesh, sources)
        content = np.ascontiguousarray(shape.mesh.vertices).tobytes() + np.ascontiguousarray(sources).tobytes()
        kept = self.cache / f"{hashlib.sha1(content, usedforsecurity=False).hexdigest()}.npy"
        if not kept.exists():
            np.save(kept, geodesic_distances(shape.mesh, sources).astype(np.float32))
        return np.load(kept)

    def pairs(self) -> list[tuple[str, str]]:
        """All pairs that are reported, in a fixed order."""
        if self.folder.name == "TOSCA_r":
            files = sorted(p.name for p in (self.folder / "corres").glob("*.vts"))
            names = [name.removesuffix(".vts") for name in files if not name.endswith(".sym.vts")]
            found = [(a, b) for a, b in permutations(names, 2) if kind_of(a) == kind_of(b)]
        else:
            text = (self.folder / "test_pairs.txt").read_text(encoding="utf-8").splitlines()
            found = [(a, b) for a, b in (line.split() for line in text if line.strip())]
        if self.folder.name == "FAUST_r":
            found = [pair for pair in found if set(pair) <= set(REPORTED)]
        return [found[i] for i in np.random.default_rng(5).permutation(len(found))]

    @lru_cache  # noqa: B019
    def lines(self, kind: str) -> np.ndarray:
        """Six lines of the truth that serve as landmarks; of a kind of animal, far apart on the first of it."""
        if self.folder.name == "FAUST_r":
            return FAUST_LINES
        first = next(a for a, _ in self.pairs() if self.kind(a) == kind)
        true, shape = self.truth(first), self.shape(first)
        tried = np.unique(true[np.linspace(0, len(true) - 1, 40).astype(int)])
        apart, chosen = self.distances(shape, tried), [0]
        while len(chosen) < 6:
            chosen.append(int(apart[chosen][:, tried].min(axis=0).argmax()))
        return np.array([int(np.flatnonzero(true == v)[0]) for v in tried[chosen]])

    def kind(self, name: str) -> str:
        return kind_of(name) if self.folder.name == "TOSCA_r" else ""


def kind_of(name: str) -> str:
    return name.rstrip("0123456789")


@dataclass(frozen=True, eq=False)
class Task:
    """A pair, ready, with what judges its maps."""

    source: kfmaps.Shape
    target: kfmaps.Shape
    landmarks: np.ndarray
    judged: np.ndarray
    distances: np.ndarray

    def error(self, images: np.ndarray) -> float:
        """Of the source vertices ``(j,)`` that the judged target vertices are sent to."""
        return 100 * float(self.distances[np.arange(len(images)), images].mean())

    def raw_error(self, C: np.ndarray) -> float:
        k_t, k_s = C.shape
        rows = self.target.basis.functions[self.judged, :k_t]
        return self.error(nearest(rows, self.source.basis.functions[:, :k_s] @ C.T))


def task_of(data: Data, a: str, b: str) -> Task | None:
    """``None`` where two landmarks are one vertex."""
    source, target, true = data.shape(a), data.shape(b), (data.truth(a), data.truth(b))
    marks = np.stack([side[data.lines(data.kind(a))] for side in true], axis=1)
    if min(len(np.unique(marks[:, i])) for i in (0, 1)) < len(marks):
        return None
    rows = np.sort(np.random.default_rng(0).choice(len(true[0]), JUDGED, replace=False))
    return Task(source, target, marks, true[1][rows], data.distances(source, true[0][rows]))


def one_fit(config: kfmaps.Config, refined: bool) -> Callable[[Task], dict]:
    def measured(task: Task) -> dict:
        C = fit(task.source, task.target, config, landmarks=task.landmarks).functional_map
        found: dict = {"raw": task.raw_error(C)}
        if refined:
            whole = replace(PLAIN, refinement=kfmaps.Config.single_fit().refinement)
            points = refine_map(C, task.source, task.target, whole, raw=False).target_to_source
            found["refined"] = task.error(points[task.judged])
        return found

    return measured


def settings_of(text: str) -> kfmaps.Config:
    if text.isdecimal():
        return replace(PLAIN, refinement=None, descriptors=kfmaps.DescriptorConfig(n_spectral=int(text)))
    return replace(read_settings(text, PLAIN), refinement=None, registration=None, search=None, threads=1)


def run(data: Data, methods: dict[str, Callable[[Task], dict]], count: int, keep: Path | None) -> dict[str, dict]:
    """Of each method and pair its numbers."""
    done: dict[str, dict] = {name: {} for name in methods}
    for line in keep.read_text(encoding="utf-8").splitlines() if keep and keep.exists() else ():
        row = json.loads(line)
        if row["set"] == data.folder.name and row["name"] in done:
            done[row["name"]][row["pair"]] = row
    pairs = data.pairs()
    used: list[str] = []
    for a, b in pairs:
        if len(used) == count:
            break
        missing = [name for name in methods if f"{a} {b}" not in done[name]]
        task = task_of(data, a, b) if missing else None
        if missing and task is None:
            continue
        used.append(f"{a} {b}")
        for name in missing:
            assert task is not None
            row = {"set": data.folder.name, "pair": used[-1], "name": name, **methods[name](task)}
            done[name][used[-1]] = row
            if keep:
                with keep.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row) + "\n")
            print("  ", used[-1], name, {k: round(v, 2) for k, v in row.items() if isinstance(v, float)}, flush=True)
    return {name: {pair: rows[pair] for pair in used if pair in rows} for name, rows in done.items()}


def told(kind: str, stage: str, rows: dict[str, dict]) -> None:
    """One row of the table: means, and each method against the first."""
    names = [name for name in rows if rows[name] and all(stage in row for row in rows[name].values())]
    if not names:
        return
    common = [pair for pair in rows[names[0]] if all(pair in rows[name] for name in names)]
    values = {name: np.array([rows[name][pair][stage] for pair in common]) for name in names}
    cells = [f"{name} {values[name].mean():.2f}" for name in names]
    for i, base in enumerate(names):
        for name in names[i + 1 :]:
            mean, gaps = values[base].mean(), values[name] - values[base]
            gap = bootstrap((gaps,), np.mean, n_resamples=10_000, method="percentile", rng=0).confidence_interval
            worst = (values[name] / values[base]).max()
            cells.append(
                f"{name}/{base} {100 * (values[name].mean() / mean - 1):+.0f} % "
                f"[{100 * gap.low / mean:+.0f}, {100 * gap.high / mean:+.0f}], worst pair x{worst:.2f}"
            )
    print(f"| {kind} | {stage} | {len(common)} | " + " | ".join(cells) + " |", flush=True)


def epoch(data: Data) -> None:
    """CPU seconds of one epoch, forward and backward."""
    from kfmaps import learn

    config = replace(
        PLAIN,
        basis=kfmaps.BasisConfig(n_eigenfunctions=50),
        descriptors=kfmaps.DescriptorConfig(n_spectral=10, shot=False, n_eigenfunctions=200),
    )
    names = [name for name in LEARNED_ON if data.cache is None or (data.cache / f"FAUST_r-{name}.npz").exists()][:12]
    pool = list(permutations(names, 2))
    pairs = [pool[i] for i in np.random.default_rng(0).permutation(len(pool))[:30]]
    lessons = []
    for a, b in pairs:
        true = data.truth(a), data.truth(b)
        marks = np.stack([side[FAUST_LINES] for side in true], axis=1)
        lessons.append(learn.training_pair(data.shape(a), data.shape(b), config, landmarks=marks, truth=true))
    model = learn.Model(config, lessons)
    clock = (time.process_time(), time.perf_counter())
    moments: list[tuple[float, float]] = []

    def keep(_state: object) -> None:
        moments.append((time.process_time() - clock[0], time.perf_counter() - clock[1]))

    learn.learn(model, lessons, [], learn.TrainingOptions(epochs=1), on_epoch=keep)
    cpu, wall = (after - before for after, before in zip(moments[1], moments[0], strict=True))
    points = len(lessons[0].descriptors_s)
    print(f"epoch of {len(lessons)} pairs, k = 50, {points} points: {cpu:.1f} CPU s on one thread, {wall:.1f} s")


STARTS = {
    "as kfmaps learn": {},
    "heat maps of landmarks": {"descriptors.landmark_descriptor": "heat"},
    "mask power 0.25": {"formulation.mask_power": 0.25},
    "mask power 1": {"formulation.mask_power": 1.0},
    "sharpness 2": {"bandwidth_scale": 2.0},
    "sharpness 10": {"bandwidth_scale": 10.0},
    "descriptors 3000": {"weights.descriptors": 3000.0},
    "Laplacian 1000": {"weights.laplacian": 1000.0},
    "commutativity 10": {"weights.commutativity": 10.0},
    "Laplacian kernel": {"kernel": kfmaps.Laplacian()},
    "34 rows": {"rank": {"signature": 8, "landmark": 3, "shot": 8}},
}
"""What is changed of the settings that learning with landmarks starts from, and of the metric's rows."""


def starts(data: Data, names: list[str]) -> None:
    """Mean raw error on the pairs of people 2 and 3, before any gradient."""
    from kfmaps import learn
    from kfmaps.fmap.solvers import CG

    def drawn(people: range, count: int, seed: int) -> list[tuple[str, str]]:
        every = list(permutations([f"tr_reg_{p:02d}{i}" for p in people for i in range(10)], 2))
        order = [every[i] for i in np.random.default_rng(seed).permutation(len(every))]
        kept = data.cache  # where only some shapes are kept, pairs of these
        there = [p for p in order if kept is None or all((kept / f"FAUST_r-{n}.npz").exists() for n in p)]
        return (there or order)[:count]

    for name in names or STARTS:
        changes = dict(STARTS[name])
        rank = changes.pop("rank", learn.model.RANK)
        config = replace(
            PLAIN,
            refinement=None,
            fit_samples=2500,
            bandwidth_scale=5.0,
            descriptors=kfmaps.DescriptorConfig(shot=True, n_eigenfunctions=200),
            weights=kfmaps.Weights(1000.0, 1.0, 300.0),
            formulation=kfmaps.Formulation(mask="resolvent"),
        )
        for path, value in changes.items():
            part, _, field = path.rpartition(".")
            config = replace(
                config, **{part: replace(getattr(config, part), **{field: value})} if part else {field: value}
            )

        def lesson(a: str, b: str, config: kfmaps.Config = config) -> learn.TrainingPair:
            true = data.truth(a), data.truth(b)
            marks = np.stack([side[FAUST_LINES] for side in true], axis=1)
            return learn.training_pair(data.shape(a), data.shape(b), config, landmarks=marks, truth=true)

        model = learn.Model(config, [lesson(*p) for p in drawn(range(2), 8, 1)], rank=rank)
        options = learn.TrainingOptions(solver=CG(3e-4, 300), operator_rtol=0.05)
        judged = [lesson(*p) for p in drawn(range(2, 4), 6, 2)]
        errors = [100 * learn.point_error(model, one, options) for one in judged]
        print(f"| {name} | {np.mean(errors):.2f} | {', '.join(f'{e:.2f}' for e in errors)} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("settings", nargs="*", help="NAME=FILE, or NAME=NUMBER of descriptors")
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--sets", default=",".join(SETS))
    parser.add_argument("--pairs", type=int, default=12)
    parser.add_argument("--refined", action="store_true")
    parser.add_argument("--epoch", action="store_true")
    parser.add_argument("--starts", nargs="*", metavar="NAME")
    parser.add_argument("--rows", type=Path)
    parser.add_argument("--cache", type=Path)
    chosen = parser.parse_args()
    if chosen.epoch:
        epoch(Data(chosen.data / "FAUST_r", chosen.cache))
        return
    if chosen.starts is not None:
        starts(Data(chosen.data / "FAUST_r", chosen.cache), chosen.starts)
        return
    methods: dict[str, Callable[[Task], dict]] = {}
    for text in chosen.settings:
        name, _, file = text.partition("=")
        methods[name] = one_fit(settings_of(file), chosen.refined)
    for kind in chosen.sets.split(","):
        rows = run(Data(chosen.data / kind, chosen.cache), methods, chosen.pairs, chosen.rows)
        for stage in ("raw", "refined"):
            told(kind, stage, rows)


if __name__ == "__main__":
    main()
