"""What a collection tells of its shapes: a common basis, hands, distances, principal components, where they differ."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from kfmaps.app.batch.evidence import FOLDER
from kfmaps.app.batch.plan import Plan
from kfmaps.app.batch.tasks import PairTask, ShapeTask
from kfmaps.app.batch.work import loaded
from kfmaps.app.files import atomic_output
from kfmaps.many.agree import Link
from kfmaps.many.differences import common_basis, components, operators, shape_distances, variation
from kfmaps.many.graph import medoid
from kfmaps.many.repair import Repaired

SHAPES, DISTANCES, LATENT = "shapes.csv", "distances.csv", "latent.npz"
SIZE = 15
"""Latent functions whose operators are compared: the higher ones are truncation more than shape."""
COMPONENTS = 5
KINDS = ("area", "conformal")


def write_specimens(
    plan: Plan, names: list[str], links: Sequence[Link], found: Repaired, tasks: list[PairTask]
) -> list[str]:
    """Write the tables and the latent basis; what could not be, in words.

    ``links`` hold the candidates as they were matched; those of which a composition or none is right take no part.
    """
    folder = plan.folder / FOLDER
    shapes: dict[str, ShapeTask] = {}
    for task in tasks:
        shapes |= {task.pair.source: task.source, task.pair.target: task.target}
    hand = ["" if (found.hands == 1).all() else ("+" if h > 0 else "-") for h in found.hands]
    parts, k = found.agreement.component, found.agreement.latent.shape[1]
    values = np.stack([loaded(shapes[name]).basis.eigenvalues[:k] for name in names])
    latent = common_basis(found.agreement, links, values, SIZE)
    if latent is None:
        rows = [[name, hand[i], int(parts[i])] for i, name in enumerate(names)]
        _table(folder / SHAPES, ["shape", "hand", "part"], rows)
        for name in (DISTANCES, LATENT):
            (folder / name).unlink(missing_ok=True)
        return ["shapes that hang together, three or more, would have a common basis and principal components"]
    matrices = {kind: operators(latent, values, kind) for kind in KINDS}
    pca = {kind: components(matrices[kind], COMPONENTS) for kind in KINDS}
    titles = [f"{kind}_{i + 1}" for kind in KINDS for i in range(pca[kind].scores.shape[1])]
    scores = np.hstack([pca[kind].scores for kind in KINDS])
    rows = [[name, hand[i], int(parts[i]), *(f"{x:.6g}" for x in scores[i])] for i, name in enumerate(names)]
    _table(folder / SHAPES, ["shape", "hand", "part", *titles], rows)
    distances = {kind: shape_distances(matrices[kind]) for kind in KINDS}
    pairs = [(i, j) for i in range(len(names)) for j in range(i + 1, len(names))]
    _table(
        folder / DISTANCES,
        ["shape", "other", *KINDS],
        [[names[i], names[j], *(f"{distances[kind][i, j]:.6g}" for kind in KINDS)] for i, j in pairs],
    )
    middle = medoid(distances["area"])
    basis = loaded(shapes[names[middle]]).basis
    varied = {f"variation_{kind}": variation(matrices[kind], latent, middle, basis) for kind in KINDS}
    explained = {f"explained_{kind}": pca[kind].parts for kind in KINDS}
    with atomic_output(folder / LATENT, force=True) as temporary, open(temporary, "wb") as file:
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
    return []


def _table(path: Path, titles: list[str], rows: list[list]) -> None:
    text = io.StringIO(newline="")
    csv.writer(text, lineterminator="\n").writerows([titles, *rows])
    path.parent.mkdir(parents=True, exist_ok=True)
    with atomic_output(path, force=True) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8", newline="")
