"""What consistent maps say of the shapes: limit shapes, chirality, distances and principal components."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from kfmaps.batch.results import write_rows
from kfmaps.collection.differences import LimitShape, components, density, shape_distances
from kfmaps.collection.pair_graph import medoid
from kfmaps.collection.repair import RepairResult
from kfmaps.geometry.basis import Basis
from kfmaps.io import atomic_output

_LATENT = "latent"
_N_COMPONENTS = 5
DIFFERENCE_KINDS = ("area", "conformal")


@dataclass(frozen=True, eq=False)
class ShapeStatistics:
    """What maps that agree say of the shapes."""

    table: tuple[tuple[str, ...], ...] = ()  # titles, then a row for each shape
    # Of each component that pairs join, the largest first, by name: its shapes, the one in the middle, what the
    # principal components explain, and where on the middle one the shapes vary.
    parts: tuple[dict[str, np.ndarray], ...] = ()
    note: str = ""  # what could not be


def write_shape_statistics(
    folder: Path,
    names: list[str],
    basis: Callable[[str], Basis],
    repaired: RepairResult,
    limit_shapes: tuple[LimitShape, ...],
) -> ShapeStatistics:
    """Write the tables and the limit shape of each component that pairs join."""
    hands, component = repaired.chirality, repaired.sync.component
    hand = ["" if (hands == 1).all() else ("+" if h > 0 else "-") for h in hands]
    for path in folder.glob(f"{_LATENT}*.npz"):
        path.unlink()
    scores: list[dict[str, str]] = [{} for _ in names]
    apart: list[list[str]] = []
    parts = []
    for number, common in enumerate(limit_shapes, 1):
        own = [names[i] for i in common.members.tolist()]
        matrices = {kind: common.operators(kind) for kind in DIFFERENCE_KINDS}
        distances = {kind: shape_distances(matrices[kind]) for kind in DIFFERENCE_KINDS}
        for i, j in zip(*np.triu_indices(len(own), 1), strict=True):
            apart.append([own[i], own[j], *(f"{distances[kind][i, j]:.6g}" for kind in DIFFERENCE_KINDS)])
        middle = medoid(distances["area"])
        middle_basis = basis(own[middle])
        arrays = {"names": np.array(own), "middle": np.array(own[middle]), "maps": common.maps, "values": common.values}
        for kind in DIFFERENCE_KINDS:
            pca = components(matrices[kind], _N_COMPONENTS)
            for i, row in zip(common.members.tolist(), pca.scores, strict=True):
                scores[i] |= {f"{kind}_{c + 1}": f"{x:.6g}" for c, x in enumerate(row)}
            arrays[f"explained_{kind}"] = pca.parts
            arrays[f"variation_{kind}"] = density(matrices[kind], common, middle, middle_basis).std(axis=0)
        path = folder / (f"{_LATENT}.npz" if number == 1 else f"{_LATENT}-{number}.npz")
        with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
            np.savez(file, allow_pickle=False, **arrays)
        parts.append(arrays)
    titles = [f"{kind}_{i + 1}" for kind in DIFFERENCE_KINDS for i in range(_N_COMPONENTS)]
    titles = [title for title in titles if any(title in row for row in scores)]
    rows = [(name, hand[i], str(component[i]), *(scores[i].get(t, "") for t in titles)) for i, name in enumerate(names)]
    table = (("shape", "hand", "part", *titles), *rows)
    write_rows(folder / "shapes.csv", table)
    write_rows(folder / "distances.csv", [["shape", "other", *DIFFERENCE_KINDS], *apart])
    note, count = "", len(np.unique(component))
    if not limit_shapes:
        note = "shapes that hang together, three or more, would have a common basis and principal components"
    elif count > 1:
        note = (
            f"no pair joins the {count} parts of the collection; {len(parts)} of them have a common basis of their own"
        )
        alone = len(names) - sum(len(common.members) for common in limit_shapes)
        note += f"; {alone} shapes are in parts of fewer than three" if alone else ""
    return ShapeStatistics(table, tuple(parts), note)
