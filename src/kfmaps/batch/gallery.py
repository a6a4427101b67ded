"""Pictures of single pairs of a collection."""

from __future__ import annotations

import io
import warnings
from collections.abc import Sequence
from pathlib import Path

from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps._threads import one_blas_thread
from kfmaps.batch.consistent import Agreed
from kfmaps.batch.exchange import map_in_use
from kfmaps.batch.layout import Pair
from kfmaps.batch.results import Result
from kfmaps.batch.summary import fitting_limit, worst_first
from kfmaps.batch.tasks import PairTask
from kfmaps.batch.truth import true_vertices
from kfmaps.batch.work import map_path
from kfmaps.cli.words import UNIT, percent
from kfmaps.io import check_map, load_map, read_mesh
from kfmaps.viz import match_figure, painted_errors, save_figure, true_views

TEXT = 18.0
"""Letters in points: the pictures are shown at half their size."""


def pair_picture(task: PairTask, limit: float = 0.1, path: Path | None = None) -> bytes:
    """The PNG of a matched pair: source, target in the source's colours, and the error when the truth is known.

    The error's colours end at ``limit``, in √area. ``path`` is another map than the one in use.

    Raises
    ------
    InvalidInput
        When the map or the meshes are gone or do not fit each other any more.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KfmapsWarning)  # the run has noted them
        source, target = read_mesh(task.source.path), read_mesh(task.target.path)
    sizes = len(source.vertices), len(target.vertices)
    points = check_map(load_map(path or map_in_use(Path(task.folder), task.pair.key)), *sizes, lost=True)
    truth = true_vertices(task, *sizes)
    errors, views = None, (None, None)
    with one_blas_thread():
        if truth is not None:
            errors = painted_errors(source, target, points, truth.source, truth.target)
            views = true_views(source, target, truth.source, truth.target)
    buffer = io.BytesIO()
    a, b = views
    figure = match_figure(source, target, points, errors=errors, limit=limit, text=TEXT, view=a, target_view=b)
    save_figure(figure, buffer, "png")
    return buffer.getvalue()


def caption(result: Result) -> str:
    """What stands under the picture of a pair."""
    told = [f"{result.source} → {result.target}"]
    told += [] if result.error_mean is None else [f"mean error {percent(result.error_mean)} {UNIT}"]
    told += [] if result.confidence is None else [f"confidence {result.confidence:.3g} ({result.verdict})"]
    return ", ".join(told)


def changed_pictures(tasks: Sequence[PairTask], agreed: Agreed, count: int) -> dict[str, bytes]:
    """Pictures of exchanged pairs by caption, before and after, of at most ``count`` of them."""
    known = {task.pair: task for task in tasks}
    pictures: dict[str, bytes] = {}
    limit = fitting_limit(agreed.results)
    for result in [r for r in agreed.results if r.changed][:count]:
        task = known.get(Pair(result.source, result.target))
        before = agreed.before.get((result.source, result.target))
        if task is None or before is None:
            continue
        own = map_path(Path(task.folder), task.pair.key)
        try:
            pictures[f"before: {caption(before)}"] = pair_picture(task, limit, own)
            pictures[f"now: {caption(result)}, {result.changed}"] = pair_picture(task, limit)
        except (InvalidInput, OSError):
            continue
    return pictures


def worst_pictures(tasks: Sequence[PairTask], results: Sequence[Result], count: int) -> dict[str, bytes]:
    """Pictures of the ``count`` worst of the ``tasks`` by caption; one that cannot be drawn is left out."""
    known = {task.pair: task for task in tasks}
    pictures: dict[str, bytes] = {}
    limit = fitting_limit(results)
    for result in worst_first(results):
        if len(pictures) == count:
            break
        task = known.get(Pair(result.source, result.target))
        if task is None:
            continue
        try:
            pictures[caption(result)] = pair_picture(task, limit)
        except (InvalidInput, OSError):
            continue
    return pictures
