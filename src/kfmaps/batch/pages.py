"""A page for single maps of a collection, which its summary leads to."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import quote

from kfmaps._arrays import InvalidInput, KfmapsWarning
from kfmaps._threads import one_blas_thread
from kfmaps.batch.exchange import map_in_use
from kfmaps.batch.layout import Pair
from kfmaps.batch.results import Result
from kfmaps.batch.tasks import PairTask
from kfmaps.batch.truth import true_vertices
from kfmaps.io import atomic_output, load_map, read_mesh
from kfmaps.viz.result_pages import map_page

FOLDER = "pages"


def write_pages(folder: Path, tasks: Sequence[PairTask], results: Sequence[Result]) -> dict[tuple[str, str], str]:
    """Write the pages of ``results`` that are not there or older than their map; addresses of all there are.

    A map that cannot be shown has none.
    """
    known = {task.pair: task for task in tasks}
    for result in results:
        task = known.get(Pair(result.source, result.target))
        if task is not None and result.status == "done" and not _fresh(task):
            _write(task)
    return {
        (task.pair.source, task.pair.target): f"{FOLDER}/{quote(path.name)}"
        for task in tasks
        if (path := _path(task)).exists() and folder in path.parents
    }


def _path(task: PairTask) -> Path:
    return Path(task.folder) / FOLDER / f"{task.pair.key}.html"


def _fresh(task: PairTask) -> bool:
    try:
        made = _path(task).stat().st_mtime
        return made >= map_in_use(Path(task.folder), task.pair.key).stat().st_mtime
    except OSError:
        return False


def _write(task: PairTask) -> None:
    try:
        with warnings.catch_warnings(), one_blas_thread():
            warnings.simplefilter("ignore", KfmapsWarning)  # the run has noted them
            source, target = read_mesh(task.source.path), read_mesh(task.target.path)
            truth = true_vertices(task, len(source.vertices), len(target.vertices))
            html = map_page(
                load_map(map_in_use(Path(task.folder), task.pair.key)),
                source,
                target,
                (task.pair.source, task.pair.target),
                truth=None if truth is None else (truth.source, truth.target),
                descriptors=False,
            )
    except (InvalidInput, OSError):
        return
    _path(task).parent.mkdir(exist_ok=True)
    with atomic_output(_path(task), force=True) as temporary:
        temporary.write_text(html, encoding="utf-8")
