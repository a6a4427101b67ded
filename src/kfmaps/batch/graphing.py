"""Pairs of a collection chosen by its shapes: prepared first, then compared by what each is alone."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.batch.layout import Pair, ShapeFolder
from kfmaps.batch.plan import shape_tasks
from kfmaps.batch.settings import Settings, digest_of
from kfmaps.batch.spread import Crew
from kfmaps.batch.tasks import ShapeTask
from kfmaps.batch.work import loaded, prepare_shape
from kfmaps.collection.pair_graph import (
    complete_graph,
    medoid,
    nearest_neighbor_graph,
    signature,
    signature_distances,
    star_graph,
)
from kfmaps.io import atomic_output

Kind = Literal["near", "star", "all"]
FILE = "graph.json"


def graph_pairs(
    collection: ShapeFolder,
    settings: Settings,
    output: str | Path,
    kind: str,
    crew: Crew,
    *,
    cache_folder: str | Path | None = None,
) -> list[Pair]:
    """Pairs over a graph of the whole collection, kept in the output folder so that they stay the same.

    Parameters
    ----------
    kind : "near", "star" or "all"
        Each shape with those that are most like it, about three pairs a shape, on cycles
        (:func:`kfmaps.collection.pair_graph.nearest_neighbor_graph`); the one in the middle with all others; every
        pair, one way. A shape that cannot be prepared has no likeness and is left out of the first two.

    Raises
    ------
    InvalidInput
        On another kind, and when fewer than two shapes can be prepared.
    """
    if kind not in get_args(Kind):
        raise refuse("--graph", "near, star or all", repr(kind), "choose one of them")
    names = list(collection.shapes)
    if len(names) < 2:
        raise refuse("pairs", "two shapes or more", f"{len(names)}", "add shapes")
    if kind == "all":
        return [Pair(names[a], names[b]) for a, b in complete_graph(len(names))]
    tasks = shape_tasks(collection, settings, output, cache_folder)
    key = digest_of([kind, sorted((task.name, task.content) for task in tasks.values())], 32)
    path = Path(output) / FILE
    kept = _read(path, key)
    if kept is not None:
        return kept
    ready = crew.each("shapes", prepare_shape, list(tasks.values()))
    good = [task for task, done in zip(tasks.values(), ready, strict=True) if not done.reason]
    if len(good) < 2:
        reason = next((done.reason for done in ready if done.reason), "")
        raise refuse("collection", "two shapes that can be prepared", f"{len(good)}: {reason}", "check the meshes")
    unlike = signature_distances(np.stack(crew.each("likeness of shapes", _signature, good)))
    chosen = nearest_neighbor_graph(unlike) if kind == "near" else star_graph(len(good), medoid(unlike))
    pairs = [Pair(good[a].name, good[b].name) for a, b in chosen]
    with atomic_output(path, force=True) as temporary:
        content = {"kind": kind, "shapes": key, "pairs": [[p.source, p.target] for p in pairs]}
        temporary.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    return pairs


def _signature(task: ShapeTask) -> np.ndarray:
    return signature(loaded(task).basis)


def _read(path: Path, key: str) -> list[Pair] | None:
    """The pairs that are kept, where they are of these shapes."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        return [Pair(str(a), str(b)) for a, b in content["pairs"]] if content["shapes"] == key else None
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
