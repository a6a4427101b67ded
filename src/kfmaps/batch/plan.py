"""From a collection, its pairs and the settings to tasks: what there is to do, and what is done already."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from kfmaps._arrays import refuse
from kfmaps.batch.cache import file_digest, shape_key
from kfmaps.batch.layout import Pair, ShapeFolder
from kfmaps.batch.results import FOLDER, Result, read_result, result_path
from kfmaps.batch.settings import Settings, claim, digest_of
from kfmaps.batch.tasks import PairTask, ShapeTask
from kfmaps.config import Config


@dataclass(frozen=True)
class Plan:
    """What a run does.

    Attributes
    ----------
    folder : Path
        The output folder.
    settings : Settings
    tasks : tuple of PairTask
        Every pair asked for, in order.
    todo : tuple of PairTask
        Those without a result that counts.
    results : tuple of Result
        Of the others.
    changed : int
        How many of ``todo`` have a result that no longer counts, because their files have changed.
    """

    folder: Path
    settings: Settings
    tasks: tuple[PairTask, ...]
    todo: tuple[PairTask, ...]
    results: tuple[Result, ...]
    changed: int


def recommended(collection: ShapeFolder, pairs: Sequence[Pair], landmark_lines: bool, landmark_files: bool) -> Config:
    """``Config.single_fit()`` when every pair has landmarks, since a collection has many pairs; else ``Config()``."""
    named = {name for pair in pairs for name in (pair.source, pair.target)}
    known = landmark_lines or (landmark_files and named <= collection.landmarks.keys())
    return Config.single_fit() if known else Config()


def make_plan(
    collection: ShapeFolder,
    pairs: Sequence[Pair],
    settings: Settings,
    output: str | Path,
    *,
    cache_folder: str | Path | None = None,
    retry_failed: bool = False,
) -> Plan:
    """Work out the tasks, make the output folder and see what of them is done.

    Parameters
    ----------
    cache_folder : path, optional
        For prepared shapes; by default ``cache`` in ``output``.
    retry_failed : bool
        Whether pairs that failed are done again.

    Raises
    ------
    InvalidInput
        When the output folder holds results of other settings or cannot be made.
    """
    if settings.identity and (collection.truth or collection.maps):
        remedy = "leave --identity out, or move the files away"
        raise refuse("--identity", "a collection without files of correspondences", "one with such files", remedy)
    folder = _folder(output)
    digest = cache(file_digest)
    shape_task = cache(_shape_tasks(collection, settings, folder, cache_folder, digest))
    _folder(folder / FOLDER)
    used = settings.digest
    tasks = tuple(_pair_task(collection, pair, settings, used, folder, shape_task, digest) for pair in pairs)
    todo, results, changed = [], [], 0
    for task in tasks:
        there = read_result(result_path(folder, task.pair.key))
        fits = there is not None and (there.settings, there.inputs) == (task.settings, task.inputs)
        if there is not None and (there.source, there.target) != (task.pair.source, task.pair.target):
            got = f"{there.source} and {there.target}"
            raise refuse(f"result {task.pair.key}", f"of {task.pair}", got, "rename one of the shapes")
        if there is None or not fits or (retry_failed and there.status == "failed"):
            changed += there is not None and not fits
            todo.append(task)
        else:
            results.append(there)
    return Plan(folder, settings, tasks, tuple(todo), tuple(results), changed)


def shape_tasks(
    collection: ShapeFolder, settings: Settings, output: str | Path, cache_folder: str | Path | None = None
) -> dict[str, ShapeTask]:
    """The tasks of preparing every shape, by name; makes the output folder as :func:`make_plan` does."""
    task = _shape_tasks(collection, settings, _folder(output), cache_folder, file_digest)
    return {name: task(name) for name in collection.shapes}


def _shape_tasks(
    collection: ShapeFolder,
    settings: Settings,
    folder: Path,
    cache_folder: str | Path | None,
    digest: Callable[[Path], str],
) -> Callable[[str], ShapeTask]:
    claim(folder, settings)
    shelf = _folder(cache_folder or folder / "cache")

    def task(name: str) -> ShapeTask:
        path = collection.shapes[name].resolve()
        content = digest(path)
        entry = shelf / f"{shape_key(content, path.suffix, settings.config)}.npz"
        return ShapeTask(name, str(path), content, str(entry), str(folder), settings.config)

    return task


def _folder(path: str | Path) -> Path:
    path = Path(path).resolve()
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise refuse(f"output {path}", "a folder that can be made", str(error.strerror), "choose another") from error
    return path


def _pair_task(
    collection: ShapeFolder,
    pair: Pair,
    settings: Settings,
    used: str,
    folder: Path,
    shape_task: Callable[[str], ShapeTask],
    digest: Callable[[Path], str],
) -> PairTask:
    source, target = shape_task(pair.source), shape_task(pair.target)
    own = None if settings.identity else collection.maps.get(pair)
    lists = own is None and not settings.identity
    truth = _both(collection.truth, pair) if lists else None
    mirrored = collection.mirrored.get(pair.target) if truth else None
    marks = settings.landmark_files and not settings.landmark_lines
    landmarks = _both(collection.landmarks, pair) if marks else None
    files = [own, *(truth or ()), mirrored, *(landmarks or ())]
    content = [source.content, target.content, *(digest(Path(f)) if f else None for f in files)]
    return PairTask(
        *(pair, str(folder), source, target, used, digest_of(content), settings.config, settings.seed),
        truth=truth,
        mirrored=str(mirrored.resolve()) if mirrored else None,
        truth_map=str(own.resolve()) if own else None,
        identity=settings.identity,
        landmarks=landmarks,
        landmark_lines=settings.landmark_lines,
    )


def _both(files, pair: Pair) -> tuple[str, str] | None:
    """The files of both shapes, when there are both."""
    if pair.source in files and pair.target in files:
        return str(files[pair.source].resolve()), str(files[pair.target].resolve())
    return None
