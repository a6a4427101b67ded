"""What one pair says in a collection, kept on disk: its candidates judged, and compositions along ways round it."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from kfmaps._threads import one_blas_thread
from kfmaps.batch.cache import file_digest
from kfmaps.batch.kept import kept_probe
from kfmaps.batch.settings import digest_of
from kfmaps.batch.tasks import PairTask
from kfmaps.batch.work import loaded, map_path
from kfmaps.collection.paths import compose_maps, invert_map
from kfmaps.collection.scored_map import ScoredMap, score_maps, with_better_score
from kfmaps.fmap.convert import to_points
from kfmaps.io import MapFile, atomic_output, check_map, load_map
from kfmaps.matching.reindexing import VertexReindexing, reindexing
from kfmaps.shape import Shape

FOLDER = "consistent"
EVIDENCE, WAYS = "evidence", "ways"
LAYOUT = 3
"""Raised when what evidence holds changes."""


@dataclass(frozen=True)
class StepTask:
    """One map on a way round: of which pair, which candidate, forth or back."""

    task: PairTask
    choice: int
    forth: bool


@dataclass(frozen=True)
class WayTask:
    """A way round a pair, to be composed and judged.

    Attributes
    ----------
    task : PairTask
        The pair.
    steps : tuple of StepTask
        From its source to its target.
    reversed : bool
        Whether the composition is a map to the target's mirror image.
    """

    task: PairTask
    steps: tuple[StepTask, ...]
    reversed: bool


def evidence_path(task: PairTask) -> Path:
    """Where the evidence of a pair lies."""
    return Path(task.folder) / FOLDER / EVIDENCE / f"{task.pair.key}.npz"


def way_path(way: WayTask) -> Path:
    """Where the composition of a way lies."""
    named = digest_of([[s.task.pair.key, s.choice, s.forth] for s in way.steps] + [way.reversed])
    return Path(way.task.folder) / FOLDER / WAYS / f"{way.task.pair.key}.{named}.npz"


def map_digest(task: PairTask) -> str:
    """What stands for a pair's own map and all that it was made from."""
    path = map_path(Path(task.folder), task.pair.key)
    return digest_of([LAYOUT, task.settings, task.inputs, file_digest(path)], 32)


PART = "the map of a part stays as it is and takes no part in this: {lost} of {count} vertices have no counterpart"


def evidence(task: PairTask) -> tuple[list[ScoredMap], str]:
    """The map of a pair and its runners-up, judged, unless that is kept; and why not, where it cannot be.

    Maps of parts take no part: neither cycles nor a common basis are defined where points have no counterpart.
    """
    try:
        inputs = map_digest(task)
        kept = _read(evidence_path(task), inputs)
        if kept is None:
            found = load_map(map_path(Path(task.folder), task.pair.key))
            lost = int((found.target_to_source < 0).sum())
            if lost:
                return [], PART.format(lost=lost, count=len(found.target_to_source))
            with one_blas_thread():
                kept = _evidence(task, found)
            _write(evidence_path(task), inputs, kept)
        return kept, ""
    except Exception as error:  # told of with the pair; one bad file must not end the run
        return [], f"{type(error).__name__}: {error}"


def candidates(found: MapFile) -> list[tuple[np.ndarray, bool]]:
    """The map in use and its runners-up, as they are in a file: points ``(n_t,)``, and whether they are reversed."""
    turned = was_reversed(found)
    others = np.asarray(found.extra.get("runners_up", np.zeros((0, 0), dtype=np.int64)))
    return [(found.target_to_source, turned), *((row, turned) for row in others)]


def was_reversed(found: MapFile) -> bool:
    """Whether a map's file says that it is one to a mirror image."""
    try:
        return json.loads(str(found.extra.get("summary", "{}"))).get("orientation") == "reversed"
    except (ValueError, AttributeError):
        return False


def _evidence(task: PairTask, found: MapFile) -> list[ScoredMap]:
    """The candidates of a file, judged; the one in use as it was before it was finished, too, where that is better.

    Runners-up are not finished, and finishing does not aim at the score.
    """
    shapes = loaded(task.source), loaded(task.target)
    n_s, n_t = (len(shape.mesh.vertices) for shape in shapes)
    check_map(found, n_s, n_t)
    maps = candidates(found)
    raw = found.extra.get("raw_functional_map")
    if raw is None:
        return _judged(task, shapes, maps)
    source, target = (shape.basis for shape in shapes)
    rough = to_points(np.asarray(raw)[: len(target.eigenvalues), : len(source.eigenvalues)], source, target, 1)
    first, before, *others = _judged(task, shapes, [maps[0], (rough, maps[0][1]), *maps[1:]])
    return [with_better_score(first, before), *others]


def composition(way: WayTask) -> tuple[np.ndarray | None, ScoredMap | None, str]:
    """The points of a way round and what speaks for them, unless that is kept; and why not, where it cannot be."""
    try:
        inputs = digest_of([map_digest(step.task) for step in way.steps], 32)
        path = way_path(way)
        kept = _read(path, inputs)
        if kept is not None:
            with open(path, "rb") as file, np.load(file, allow_pickle=False) as arrays:
                return arrays["points"], kept[0], ""
        with one_blas_thread():
            points = compose_maps([_step(step) for step in way.steps])
            shapes = loaded(way.task.source), loaded(way.task.target)
            kept = _judged(way.task, shapes, [(points, way.reversed)])
        _write(path, inputs, kept, points=points)
        return points, kept[0], ""
    except Exception as error:
        return None, None, f"{type(error).__name__}: {error}"


def _step(step: StepTask) -> np.ndarray:
    """For each vertex of the step's second shape one of its first."""
    found = load_map(map_path(Path(step.task.folder), step.task.pair.key))
    points = candidates(found)[step.choice][0]
    return points if step.forth else invert_map(points, loaded(step.task.source).basis, len(points))


def _judged(task: PairTask, shapes: tuple[Shape, Shape], maps: list[tuple[np.ndarray, bool]]) -> list[ScoredMap]:
    entries = Path(task.source.entry), Path(task.target.entry)
    probes = kept_probe(shapes[0], entries[0], task.seed), kept_probe(shapes[1], entries[1], task.seed)
    across = reindexing(*shapes)
    points = [_within(points, across) for points, _ in maps]
    return score_maps(points, across.source, across.target, probes, [turned for _, turned in maps])


def _within(points: np.ndarray, across: VertexReindexing) -> np.ndarray:
    return across.part_s.to_clean[points[across.part_t.to_original]]


def _write(path: Path, inputs: str, maps: list[ScoredMap], **more: np.ndarray) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
        np.savez(
            file,
            allow_pickle=False,
            inputs=np.array(inputs),
            maps=np.stack([one.map for one in maps]),
            scores=np.array([one.score for one in maps]),
            orientations=np.array([one.orientation for one in maps]),
            reversed=np.array([one.reversed for one in maps]),
            **more,
        )


def _read(path: Path, inputs: str) -> list[ScoredMap] | None:
    """What is kept, where it is of these inputs and whole."""
    try:
        with open(path, "rb") as file, np.load(file, allow_pickle=False) as arrays:
            if str(arrays["inputs"]) != inputs:
                return None
            rows = zip(arrays["maps"], arrays["scores"], arrays["orientations"], arrays["reversed"], strict=True)
            return [ScoredMap(C, float(score), float(turn), bool(back)) for C, score, turn, back in rows]
    except FileNotFoundError:
        return None
    except Exception:  # NumPy reports a damaged file by whatever it runs into
        return None
