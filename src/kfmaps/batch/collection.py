"""A whole collection by one call: find, plan, match, and write what came of it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from kfmaps._arrays import MissingDependency, refuse
from kfmaps.batch.consistent import Agreed, make_consistent
from kfmaps.batch.evidence import EVIDENCE, WAYS
from kfmaps.batch.evidence import FOLDER as CONSISTENT
from kfmaps.batch.gallery import changed_pictures, worst_pictures
from kfmaps.batch.page import summary_page
from kfmaps.batch.pages import write_pages
from kfmaps.batch.plan import Plan
from kfmaps.batch.results import FOLDER, Result, all_results, write_csv, write_parquet
from kfmaps.batch.run import Callback, run_plan
from kfmaps.batch.settings import read_settings
from kfmaps.batch.specimen_page import specimen_sections
from kfmaps.batch.spread import Told, crew
from kfmaps.batch.summary import worst_first
from kfmaps.batch.work import MAPS
from kfmaps.io import atomic_output, remove_unfinished

A_DAY = 86400.0
TABLE, COLUMNS, PAGE = "results.csv", "results.parquet", "summary.html"


@dataclass(frozen=True)
class BatchOutcome:
    """What came of a run.

    Attributes
    ----------
    results : tuple of Result
        Of every pair that was asked for and has one, by source and target.
    matched : int
        Pairs that this run worked on.
    interrupted : bool
        Whether it was stopped by the user; the same call goes on.
    files : tuple of Path
        Tables and summary.
    agreed : Agreed or None
        What came of making the maps agree, where that was asked for.
    """

    results: tuple[Result, ...]
    matched: int
    interrupted: bool
    files: tuple[Path, ...]
    agreed: Agreed | None = None


def match_collection(
    plan: Plan,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    name: str = "collection",
    worst: int = 6,
    callback: Callback | None = None,
    consistent: bool = False,
    told: Told | None = None,
) -> BatchOutcome:
    """Do what the plan leaves to do, then write the tables and the summary.

    Parameters
    ----------
    plan : Plan
        From :func:`~kfmaps.batch.plan.make_plan`.
    workers : int, optional
        Worker processes on this machine; by default one for each core.
    scheduler : str, optional
        The address of a running Dask scheduler, to use its workers instead.
    name : str
        The summary's title.
    worst : int
        How many of the worst pairs the summary shows as pictures.
    callback : callable, optional
        See :func:`~kfmaps.batch.run.run_plan`.
    consistent : bool
        Whether the maps are made to agree in the end (:func:`~kfmaps.batch.consistent.make_consistent`).
    told : callable, optional
        Is told of that as of :meth:`~kfmaps.batch.spread.Crew.each`.

    Raises
    ------
    MissingDependency
        When Dask is not installed and there is something to do.
    InvalidInput
        When another run is using the output folder, or the workers cannot be used.
    """
    matched, interrupted, agreed = 0, False, None
    with _only_one(plan.folder), _tidied(plan), crew(workers, scheduler, told) as hands:
        if plan.todo:
            count = 0

            def counted(status, result) -> None:
                nonlocal count
                count += result is not None
                if callback is not None:
                    callback(status, result)

            try:
                run_plan(plan, hands.connected(), counted)
            except KeyboardInterrupt:
                interrupted = True
            finally:
                if interrupted or not consistent:
                    hands.dismiss()  # what they are still at is not to end behind the back of the tables
            matched = count
        asked = {(task.pair.source, task.pair.target) for task in plan.tasks}
        everything = all_results(plan.folder, plan.settings.digest)
        if consistent and not interrupted:
            try:
                agreed = make_consistent(plan, [r for r in everything if (r.source, r.target) in asked], hands)
                better = {(r.source, r.target): r for r in agreed.results}
                everything = [better.get((r.source, r.target), r) for r in everything]
            except KeyboardInterrupt:
                interrupted = True
            finally:
                hands.dismiss()
        files = write_outputs(plan, everything, name, 0 if interrupted else worst, agreed)
    results = tuple(r for r in everything if (r.source, r.target) in asked)
    return BatchOutcome(results, matched, interrupted, files, agreed)


def write_outputs(
    plan: Plan, results: list[Result], name: str, worst: int, agreed: Agreed | None = None
) -> tuple[Path, ...]:
    """Write the tables and the summary anew from the ``results``; their paths."""
    files = [plan.folder / TABLE]
    write_csv(files[0], results)
    try:
        write_parquet(plan.folder / COLUMNS, results)
        files.append(plan.folder / COLUMNS)
    except MissingDependency:
        (plan.folder / COLUMNS).unlink(missing_ok=True)  # one of an earlier run would be out of date
    pictures = {} if agreed is None else changed_pictures(plan.tasks, agreed, worst)
    shown = worst_first(results)[:worst] + [r for r in results if r.changed][: 2 * worst]
    pages = write_pages(plan.folder, plan.tasks, shown)
    worse = worst_pictures(plan.tasks, results, worst)
    pairs = len({(r.source, r.target) for r in results} | {(t.pair.source, t.pair.target) for t in plan.tasks})
    page = summary_page(
        name,
        results,
        read_settings(plan.folder),
        worse,
        pairs,
        pages=pages,
        changed=pictures,
        doubted=() if agreed is None else agreed.doubted,
        specimens=() if agreed is None else specimen_sections(plan),
    )
    with atomic_output(plan.folder / PAGE, force=True) as temporary:
        temporary.write_text(page, encoding="utf-8")
    return (*files, plan.folder / PAGE)


@contextmanager
def _tidied(plan: Plan) -> Iterator[None]:
    """Before and after the block, away with what workers that were killed have left half written.

    In a cache elsewhere, which other runs may be writing to, only what nobody can be working on any more.
    """
    shelves = {Path(task.source.entry).parent for task in plan.tasks}

    def tidy() -> None:
        beside = plan.folder / CONSISTENT
        parts = (plan.folder, beside, *(top / part for top in (plan.folder, beside) for part in (FOLDER, MAPS)))
        for folder in (*parts, beside / EVIDENCE, beside / WAYS):
            remove_unfinished(folder)
        for shelf in shelves:
            remove_unfinished(shelf, 0.0 if plan.folder in shelf.parents else A_DAY)

    tidy()
    try:
        yield
    finally:
        tidy()


@contextmanager
def _only_one(folder: Path) -> Iterator[None]:
    """Hold the output folder for this run; the system lets go of it however the run ends."""
    try:
        import fcntl
    except ImportError:  # Windows: two runs at once do some pairs twice, and record each once
        yield
        return
    handle = os.open(folder / ".lock", os.O_RDWR | os.O_CREAT, 0o644)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise refuse(f"output {folder}", "a folder of its own", "one in use by another run", "wait for it") from error
    except OSError:
        pass  # a file system without locks
    try:
        yield
    finally:
        os.close(handle)
