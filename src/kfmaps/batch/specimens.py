"""What a collection tells of its shapes: a common basis, hands, distances, principal components, where they differ."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kfmaps.batch.evidence import FOLDER
from kfmaps.batch.plan import Plan
from kfmaps.batch.tasks import PairTask, ShapeTask
from kfmaps.batch.work import loaded
from kfmaps.collection.differences import (
    Components,
    LimitShape,
    component_limit_shapes,
    components,
    operators,
    shape_distances,
    variation,
)
from kfmaps.collection.pair_graph import medoid
from kfmaps.collection.repair import RepairResult
from kfmaps.collection.synchronization import Edge
from kfmaps.geometry.basis import Basis
from kfmaps.io import atomic_output

SHAPES, DISTANCES, LATENT = "shapes.csv", "distances.csv", "latent.npz"
SIZE = 15
"""Latent functions whose operators are compared: the higher ones are truncation more than shape."""
COMPONENTS = 5
KINDS = ("area", "conformal")


def write_specimens(
    plan: Plan, names: list[str], links: Sequence[Edge], found: RepairResult, tasks: list[PairTask]
) -> list[str]:
    """Write the tables and the common basis of each part that pairs join; what could not be, in words.

    ``links`` hold the candidates as they were matched; those of which a composition or none is right take no part.
    """
    folder = plan.folder / FOLDER
    shapes: dict[str, ShapeTask] = {}
    for task in tasks:
        shapes |= {task.pair.source: task.source, task.pair.target: task.target}
    hand = ["" if (found.chirality == 1).all() else ("+" if h > 0 else "-") for h in found.chirality]
    parts, k = found.sync.component, found.sync.latent.shape[1]
    values = np.stack([loaded(shapes[name]).basis.eigenvalues[:k] for name in names])
    bases = component_limit_shapes(found.sync, links, values, SIZE)
    for path in folder.glob(f"{Path(LATENT).stem}*.npz"):
        path.unlink()
    scores: dict[int, dict[str, float]] = {i: {} for i in range(len(names))}
    apart: list[list] = []
    for number, common in enumerate(bases):
        own = [names[i] for i in common.members]
        matrices = {kind: operators(common.limit_shape, values[common.members], kind) for kind in KINDS}
        pca = {kind: components(matrices[kind], COMPONENTS) for kind in KINDS}
        for kind in KINDS:
            for i, row in zip(common.members.tolist(), pca[kind].scores, strict=True):
                scores[i] |= {f"{kind}_{c + 1}": float(x) for c, x in enumerate(row)}
        distances = {kind: shape_distances(matrices[kind]) for kind in KINDS}
        apart += [
            [own[i], own[j], *(f"{distances[kind][i, j]:.6g}" for kind in KINDS)]
            for i in range(len(own))
            for j in range(i + 1, len(own))
        ]
        middle = medoid(distances["area"])
        basis = loaded(shapes[own[middle]]).basis
        _latent(latent_path(folder, number), own, middle, common.limit_shape, pca, matrices, basis)
    titles = [f"{kind}_{i + 1}" for kind in KINDS for i in range(COMPONENTS)]
    titles = [title for title in titles if any(title in row for row in scores.values())]
    rows = [
        [name, hand[i], int(parts[i]), *(f"{scores[i][t]:.6g}" if t in scores[i] else "" for t in titles)]
        for i, name in enumerate(names)
    ]
    _table(folder / SHAPES, ["shape", "hand", "part", *titles], rows)
    if not bases:
        (folder / DISTANCES).unlink(missing_ok=True)
        return ["shapes that hang together, three or more, would have a common basis and principal components"]
    _table(folder / DISTANCES, ["shape", "other", *KINDS], apart)
    count, alone = len(np.unique(parts)), len(names) - sum(len(common.members) for common in bases)
    if count == 1:
        return []
    told = f"no pair joins the {count} parts of the collection: {len(bases)} of them have a common basis each"
    return [told + (f"; {alone} shapes are in parts of fewer than three" if alone else "")]


def latent_path(folder: Path, number: int) -> Path:
    """Where the common basis of a part lies: the largest has number 0."""
    return folder / (LATENT if number == 0 else f"{Path(LATENT).stem}-{number + 1}.npz")


def latent_paths(folder: Path) -> list[Path]:
    """Where common bases lie, of the largest part first."""
    found = []
    while (path := latent_path(folder, len(found))).exists():
        found.append(path)
    return found


def _latent(
    path: Path,
    names: list[str],
    middle: int,
    latent: LimitShape,
    pca: dict[str, Components],
    matrices: dict[str, np.ndarray],
    basis: Basis,
) -> None:
    """Write the common basis of a part; ``basis`` is that of the shape in its ``middle``."""
    varied = {f"variation_{kind}": variation(matrices[kind], latent, middle, basis) for kind in KINDS}
    explained = {f"explained_{kind}": pca[kind].parts for kind in KINDS}
    with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
        np.savez(
            file,
            allow_pickle=False,
            names=np.array(names),
            maps=latent.maps,
            values=latent.values,
            middle=np.array(names[middle]),
            **explained,
            **varied,
        )


def _table(path: Path, titles: list[str], rows: list[list]) -> None:
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\n").writerows([titles, *rows])
    path.parent.mkdir(parents=True, exist_ok=True)
    with atomic_output(path, force=True) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8", newline="")
