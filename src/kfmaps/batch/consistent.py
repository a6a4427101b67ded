"""The maps of a whole run made to agree over cycles: which are exchanged, for what and why; all written beside them.

Nothing of the run itself is touched, so that the same evidence leads to the same end however often it is cut short.
What each pair says, each way round and each exchanged map is a file of its own, with a digest of its inputs.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from kfmaps._arrays import refuse
from kfmaps.batch.evidence import FOLDER, StepTask, WayTask, composition, evidence
from kfmaps.batch.exchange import Exchange, exchange, exchanged_map, exchanged_result, kind_of, reason_of
from kfmaps.batch.plan import Plan
from kfmaps.batch.results import Result
from kfmaps.batch.specimens import write_specimens
from kfmaps.batch.spread import Crew
from kfmaps.batch.tasks import PairTask
from kfmaps.collection.repair import CyclePath, RepairResult, repair
from kfmaps.collection.scored_map import ScoredMap, candidate_maps
from kfmaps.collection.synchronization import Edge
from kfmaps.io import atomic_output

TABLE = "pairs.csv"


@dataclass(frozen=True, eq=False)
class Agreed:
    """A run whose maps were made to agree.

    Attributes
    ----------
    results : tuple of Result
        Those given, with their probabilities; of exchanged pairs the new.
    before : dict of (source, target) to Result
        Of exchanged pairs the old.
    doubted : tuple of str
        A line for each pair that others contradict and for which nothing better is known.
    exchanged : int
    notes : tuple of str
        What could not be taken into account.
    """

    results: tuple[Result, ...]
    before: dict[tuple[str, str], Result]
    doubted: tuple[str, ...]
    exchanged: int
    notes: tuple[str, ...] = ()


def make_consistent(plan: Plan, results: Sequence[Result], crew: Crew) -> Agreed:
    """Settle which maps of a finished run are right, exchange what is wrong, and write what came of it.

    Parameters
    ----------
    plan : Plan
    results : sequence of Result
        Of the plan's pairs; those that failed are left as they are.
    crew : Crew
        Workers.

    Raises
    ------
    InvalidInput
        When there is no pair to speak of.
    """
    known = {(r.source, r.target): r for r in results if r.status == "done"}
    tasks = [task for task in plan.tasks if (task.pair.source, task.pair.target) in known]
    said = crew.each("evidence of pairs", evidence, tasks)
    notes = [
        f"{t.pair.source} → {t.pair.target}: {reason}" for t, (_, reason) in zip(tasks, said, strict=True) if reason
    ]
    both = [(task, maps) for task, (maps, reason) in zip(tasks, said, strict=True) if not reason]
    if not tasks:
        raise refuse("--consistent", "pairs that are matched", "none", "see why the pairs failed")
    if not both:
        _forget(plan, set())
        return Agreed(tuple(results), {}, (), 0, tuple(notes))
    tasks, maps = [task for task, _ in both], [m for _, m in both]
    names = list(dict.fromkeys(name for task in tasks for name in (task.pair.source, task.pair.target)))
    number = {name: i for i, name in enumerate(names)}
    ends = [(number[task.pair.source], number[task.pair.target]) for task in tasks]
    made: dict[tuple[int, CyclePath], ScoredMap] = {}

    def compose(asked: list[tuple[int, CyclePath]]) -> list[ScoredMap]:
        jobs = [_way(tasks, maps, link, way) for link, way in asked]
        for one, (_, found, reason) in zip(asked, crew.each("ways round", composition, jobs), strict=True):
            if found is None:
                raise refuse("way round", "maps that can be read", reason, "run the command again")
            made[one] = found
        return [made[one] for one in asked]

    found = repair(len(names), ends, maps, compose)
    jobs = [
        Exchange(
            tasks[c.edge],
            c,
            None if c.path is None else _way(tasks, maps, c.edge, c.path),
            () if c.path is None else tuple(names[i] for i in c.path.through),
            known[tasks[c.edge].pair.source, tasks[c.edge].pair.target],
        )
        for c in found.replacements
        if c.kind != "none"
    ]
    _forget(plan, {job.task.pair.key for job in jobs})
    ended = crew.each("exchanged pairs", exchange, jobs)
    changed = {(r.source, r.target): r for r in ended if r.status == "done"}
    notes += [f"{r.source} → {r.target} stays as it was: {r.reason}" for r in ended if r.status == "failed"]
    use = found.probabilities
    chance = {(t.pair.source, t.pair.target): float(use[i]) for i, t in enumerate(tasks)}
    final = tuple(
        changed.get((r.source, r.target), replace(r, agreement=chance.get((r.source, r.target)))) for r in results
    )
    doubted = tuple(
        f"{tasks[c.edge].pair.source} → {tasks[c.edge].pair.target}: {reason_of(c)}"
        for c in found.replacements
        if c.kind == "none"
    )
    _write_pairs(plan.folder / FOLDER / TABLE, tasks, maps, found, names)
    links = [Edge(a, b, candidate_maps(several)) for (a, b), several in zip(ends, maps, strict=True)]
    notes += write_specimens(plan, names, links, found, tasks)
    return Agreed(final, {key: known[key] for key in changed}, doubted, len(changed), tuple(notes))


def _way(tasks: list[PairTask], maps: list[list[ScoredMap]], link: int, way: CyclePath) -> WayTask:
    steps = tuple(StepTask(tasks[step.edge], step.candidate, step.forward) for step in way.steps)
    turns = sum(maps[step.edge][step.candidate].reversed for step in way.steps)
    return WayTask(tasks[link], steps, turns % 2 == 1)


def _forget(plan: Plan, kept: set[str]) -> None:
    """Away with maps of pairs that are not exchanged any more, since others have been matched again."""
    for task in plan.tasks:
        if task.pair.key not in kept:
            exchanged_result(plan.folder, task.pair.key).unlink(missing_ok=True)
            exchanged_map(plan.folder, task.pair.key).unlink(missing_ok=True)


def _write_pairs(
    path: Path, tasks: list[PairTask], maps: list[list[ScoredMap]], found: RepairResult, names: list[str]
) -> None:
    """What the collection says of every pair."""
    text = io.StringIO(newline="")
    out = csv.writer(text, lineterminator="\n")
    out.writerow(["source", "target", "candidates", "probability", "misfit", "score", "changed", "why"])
    changes = {change.edge: change for change in found.replacements}
    for i, task in enumerate(tasks):
        change = changes.get(i)
        what = "" if change is None else kind_of(change, [names[k] for k in change.path.through] if change.path else ())
        row = [task.pair.source, task.pair.target, len(maps[i]), f"{found.sync.probabilities[i][0]:.6f}"]
        row += [f"{found.sync.residuals[i][0]:.6f}", f"{maps[i][0].score:.4f}", what]
        out.writerow([*row, "" if change is None else reason_of(change)])
    path.parent.mkdir(parents=True, exist_ok=True)
    with atomic_output(path, force=True) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8", newline="")
