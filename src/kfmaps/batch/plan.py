"""Plan a run: the tasks of a collection's pairs, and the results that exist already."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations, permutations
from pathlib import Path

import numpy as np

from kfmaps._arrays import InvalidInput, refuse
from kfmaps.batch.cache import file_digest, shape_key
from kfmaps.batch.jobs import WorkerPool
from kfmaps.batch.layout import Pair, ShapeFolder, shape_name
from kfmaps.batch.results import FOLDER, Result, read_result, result_path
from kfmaps.batch.run_spec import RunSpec, claim, digest_of
from kfmaps.batch.work import PairTask, ShapeTask, load_prepared, prepare_shape
from kfmaps.collection.pair_graph import medoid, signature, signature_distances, signature_graph
from kfmaps.io.atomic import write_text

_GRAPH = "graph.json"
GRAPHS = "near, star, star:SHAPE, all or both"


@dataclass(frozen=True)
class Plan:
    """The work of a run."""

    folder: Path  # the output folder
    spec: RunSpec
    tasks: tuple[PairTask, ...]  # of all pairs, in order
    todo: tuple[PairTask, ...]  # those without a valid result
    results: tuple[Result, ...]  # of the others
    changed: int  # number of ``todo`` whose result is invalid, because files have changed


def make_plan(
    collection: ShapeFolder, pairs: Sequence[Pair], spec: RunSpec, output: str | Path, *, retry_failed: bool = False
) -> Plan:
    """Return the plan of a run; the output folder is made, and earlier results are read from it.

    ``retry_failed``: whether failed pairs are done again.
    """
    if spec.identity and (collection.truth or collection.maps):
        remedy = "leave --identity out, or move the files away"
        raise refuse("--identity", "a collection without files of correspondences", "one with such files", remedy)
    factory = _TaskFactory(collection, spec, output)
    _make_folder(factory.folder / FOLDER)
    tasks = tuple(factory.pair(pair) for pair in pairs)
    todo, results, changed = [], [], 0
    keys: dict[str, Pair] = {}
    for task in tasks:
        same_key = keys.setdefault(task.key.casefold(), task.pair)  # some file systems do not tell a from A
        if same_key != task.pair:
            raise refuse(
                "pairs", "names that tell pairs apart", f"{same_key.key} for two of them", "rename one of the shapes"
            )
        result = read_result(result_path(factory.folder, task.key))
        if result is not None and result.pair != task.pair:
            got = f"{result.source} and {result.target}"
            raise refuse(f"result {task.key}", f"the result of {task.pair}", got, "rename one of the shapes")
        fits = result is not None and result.is_of(task.settings, task.inputs)
        if result is None or not fits or (retry_failed and result.status == "failed"):
            changed += result is not None and not fits
            todo.append(task)
        else:
            results.append(result)
    return Plan(factory.folder, spec, tasks, tuple(todo), tuple(results), changed)


def graph_pairs(collection: ShapeFolder, spec: RunSpec, output: str | Path, kind: str, pool: WorkerPool) -> list[Pair]:
    """Choose pairs over a graph of the whole collection.

    ``output``: output folder of the run. ``kind``: "near": each shape with the most similar ones, about three pairs a
    shape, on cycles (:func:`kfmaps.collection.pair_graph.nearest_neighbor_graph`). "star": the medoid with all others;
    "star:SHAPE": this shape with all others. "all": every pair, one way; "both": both ways. Pairs that depend on the
    shapes are stored in the output folder, so that they stay the same. A shape that cannot be prepared gets one pair,
    with the medoid, and that pair fails. ``pool``: prepares the shapes.
    """
    names = list(collection.shapes)
    if kind not in ("near", "star", "all", "both") and not kind.startswith("star:"):
        raise refuse("--graph", GRAPHS, repr(kind), "choose one of them")
    if len(names) < 2:
        raise refuse("pairs", "two shapes or more", f"{len(names)}", "add shapes")
    if kind.startswith("star:"):
        centre = shape_name(kind.removeprefix("star:"), collection, "--graph star:SHAPE")
        return [Pair(centre, name) for name in names if name != centre]
    if kind in ("all", "both"):
        return [Pair(a, b) for a, b in (combinations if kind == "all" else permutations)(names, 2)]
    factory = _TaskFactory(collection, spec, output)
    tasks = [factory.shape(name) for name in names]
    key = digest_of([kind, sorted((task.name, task.content) for task in tasks)], 32)
    path = factory.folder / _GRAPH
    stored = _read_graph(path, key)
    if stored is not None:
        return stored
    prepared = pool.map("shapes", prepare_shape, tasks)
    usable = [task for task, done in zip(tasks, prepared, strict=True) if not done.reason]
    failures = [done for done in prepared if done.reason]
    if len(usable) < 2:
        got = f"{len(usable)}: {failures[0].reason}"
        raise refuse("collection", "two shapes that can be prepared", got, "check the meshes")
    signatures = np.stack(pool.map("likeness of shapes", _signature, usable))
    edges = signature_graph(kind, signatures)
    centre = medoid(signature_distances(signatures)) if failures else 0
    pairs = [Pair(usable[a].name, usable[b].name) for a, b in edges]
    pairs += [Pair(usable[centre].name, done.name) for done in failures]
    content = {"kind": kind, "shapes": key, "pairs": [[p.source, p.target] for p in pairs]}
    write_text(path, json.dumps(content, indent=1) + "\n", force=True)
    return pairs


def _signature(task: ShapeTask) -> np.ndarray:
    return signature(load_prepared(task).basis)


def _read_graph(path: Path, key: str) -> list[Pair] | None:
    """Return the stored pairs; ``None`` if they are not those of these shapes."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return [Pair(str(a), str(b)) for a, b in content["pairs"]] if content["shapes"] == key else None
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


class _TaskFactory:
    """The maker of tasks in an output folder, which is created and claimed for the specification."""

    def __init__(self, collection: ShapeFolder, spec: RunSpec, output: str | Path) -> None:
        self.collection, self.spec, self.folder = collection, spec, _make_folder(output)
        claim(self.folder, spec)
        self.cache_folder = _make_folder(self.folder / "cache")
        self.shape, self.digest = cache(self._shape), cache(_digest)

    def _shape(self, name: str) -> ShapeTask:
        path = self.collection.shapes[name].resolve()
        content = self.digest(path)
        entry = self.cache_folder / f"{shape_key(content, path.suffix, self.spec.config)}.npz"
        return ShapeTask(name, path, content, entry, self.folder, self.spec.config)

    def pair(self, pair: Pair) -> PairTask:
        collection, spec = self.collection, self.spec
        source, target = self.shape(pair.source), self.shape(pair.target)
        pair_truth = None if spec.identity else collection.maps.get(pair)
        truth = _both(collection.truth, pair) if pair_truth is None and not spec.identity else None
        mirrored = collection.mirrored.get(pair.target) if truth else None
        use_files = spec.landmark_files and not spec.landmark_lines
        landmarks = collection.pair_landmarks.get(pair) or _both(collection.landmarks, pair)
        landmarks = landmarks if use_files else None
        files = [pair_truth, *(truth or ()), mirrored, *(landmarks or ())]
        inputs = digest_of([source.content, target.content, *(self.digest(f) if f else None for f in files)])
        mirrored, pair_truth = (path and path.resolve() for path in (mirrored, pair_truth))
        return PairTask(pair, self.folder, source, target, spec, inputs, truth, mirrored, pair_truth, landmarks)


def _digest(path: Path) -> str:
    """Return the digest of a file, or of the error of reading it, which its pairs will report."""
    try:
        return file_digest(path)
    except (OSError, InvalidInput) as error:
        return digest_of(str(error), 32)


def _make_folder(path: str | Path) -> Path:
    path = Path(path).resolve()
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise refuse(f"output {path}", "a folder that can be made", str(error.strerror), "choose another") from error
    return path


def _both(files: Mapping[str, Path], pair: Pair) -> tuple[Path, Path] | None:
    """Return the files of both shapes, where both exist."""
    if pair.source in files and pair.target in files:
        return files[pair.source].resolve(), files[pair.target].resolve()
    return None
