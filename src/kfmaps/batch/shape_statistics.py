"""What consistent maps say of the shapes: limit shapes, chirality, distances and principal components."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from kfmaps.batch.results import write_rows
from kfmaps.collection.differences import LimitShape, components, density, shape_distances
from kfmaps.collection.pair_graph import medoid
from kfmaps.collection.repair import RepairResult
from kfmaps.geometry.basis import Basis
from kfmaps.io import atomic_output

SHAPES, _DISTANCES, _LATENT = "shapes.csv", "distances.csv", "latent.npz"
_N_COMPONENTS = 5
DIFFERENCE_KINDS = ("area", "conformal")


def write_shape_statistics(
    folder: Path,
    names: list[str],
    basis: Callable[[str], Basis],
    repaired: RepairResult,
    limit_shapes: tuple[LimitShape, ...],
) -> list[str]:
    """Write the tables and the limit shape of each component that pairs join; what could not be, in words."""
    hands, parts = repaired.chirality, repaired.sync.component
    hand = ["" if (hands == 1).all() else ("+" if h > 0 else "-") for h in hands]
    for path in folder.glob(f"{Path(_LATENT).stem}*.npz"):
        path.unlink()
    scores: list[dict[str, str]] = [{} for _ in names]
    apart: list[list[str]] = []
    for number, common in enumerate(limit_shapes):
        own = [names[i] for i in common.members.tolist()]
        matrices = {kind: common.operators(kind) for kind in DIFFERENCE_KINDS}
        pca = {kind: components(matrices[kind], _N_COMPONENTS) for kind in DIFFERENCE_KINDS}
        distances = {kind: shape_distances(matrices[kind]) for kind in DIFFERENCE_KINDS}
        for kind in DIFFERENCE_KINDS:
            for i, row in zip(common.members.tolist(), pca[kind].scores, strict=True):
                scores[i] |= {f"{kind}_{c + 1}": f"{x:.6g}" for c, x in enumerate(row)}
        for i, j in zip(*np.triu_indices(len(own), 1), strict=True):
            apart.append([own[i], own[j], *(f"{distances[kind][i, j]:.6g}" for kind in DIFFERENCE_KINDS)])
        middle = medoid(distances["area"])
        own_basis = basis(own[middle])
        arrays = {"names": np.array(own), "maps": common.maps, "values": common.values}
        arrays |= {f"explained_{kind}": pca[kind].parts for kind in DIFFERENCE_KINDS}
        for kind in DIFFERENCE_KINDS:
            arrays[f"variation_{kind}"] = density(matrices[kind], common, middle, own_basis).std(axis=0)
        path = _limit_shape_path(folder, number)
        with atomic_output(path, force=True) as temporary, open(temporary, "wb") as file:
            np.savez(file, allow_pickle=False, middle=np.array(own[middle]), **arrays)
    titles = [f"{kind}_{i + 1}" for kind in DIFFERENCE_KINDS for i in range(_N_COMPONENTS)]
    titles = [title for title in titles if any(title in row for row in scores)]
    rows = [[name, hand[i], int(parts[i]), *(scores[i].get(t, "") for t in titles)] for i, name in enumerate(names)]
    write_rows(folder / SHAPES, [["shape", "hand", "part", *titles], *rows])
    if not limit_shapes:
        (folder / _DISTANCES).unlink(missing_ok=True)
        return ["shapes that hang together, three or more, would have a common basis and principal components"]
    write_rows(folder / _DISTANCES, [["shape", "other", *DIFFERENCE_KINDS], *apart])
    count, alone = len(np.unique(parts)), len(names) - sum(len(common.members) for common in limit_shapes)
    if count == 1:
        return []
    line = f"no pair joins the {count} parts of the collection; {len(limit_shapes)} of them have a common basis"
    return [line + " of their own" + (f"; {alone} shapes are in parts of fewer than three" if alone else "")]


def _limit_shape_path(folder: Path, number: int) -> Path:
    """Return where the limit shape of a component lies: the largest has number 0."""
    return folder / (_LATENT if number == 0 else f"{Path(_LATENT).stem}-{number + 1}.npz")


def limit_shape_paths(folder: Path) -> list[Path]:
    """Return where limit shapes lie, of the largest component first."""
    found = []
    while (path := _limit_shape_path(folder, len(found))).exists():
        found.append(path)
    return found
