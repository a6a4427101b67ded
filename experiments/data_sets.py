"""Shapes with known correspondences, and which of their pairs serve to choose settings and which are reported.

Settings are chosen on the first two people of a data set and results are reported on the others, so that no
reported number was tuned on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np

from kfmaps import datasets
from kfmaps._arrays import refuse
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import read_mesh, read_vertex_numbers

Pair = tuple[str, str]
"""Names of source and target."""

POSES = 10
"""Consecutive numbers in FAUST's names that are one person."""

TRAINING_PEOPLE = (0, 1)
TEMPLATE_LANDMARKS = np.arange(499, 6000, 1000)
"""FAUST: the six of NO17's demonstration, vertices 500, 1500, ..., 5500 of the template, counted from 1."""

TRUTH_LANDMARKS = np.array([201, 1121, 2041, 2961, 3881, 4801]) - 1
"""FAUST_r: lines of a remeshed shape's truth whose vertices serve as landmarks."""

GENERATORS = {"poses": datasets.two_poses, "relatives": datasets.non_isometric}
SIDES = ("source", "target")


@dataclass(frozen=True)
class DataSet:
    """A data set, small enough to hand to a worker process; files are read on demand.

    Attributes
    ----------
    name : "FAUST", "FAUST_r", "TOSCA_r" or "generated"
    folder : Path or None
        ``None`` for the generated shapes.
    vertices : int
        Number of vertices of a generated source.
    """

    name: str
    folder: Path | None = field(default=None, repr=False)
    vertices: int = 2500

    def shapes(self) -> list[str]:
        """Return the names of all shapes, sorted."""
        if self.folder is None:
            return [name for pair in _generated_pairs(range(10)) for name in pair]
        return sorted(path.stem for path in self.folder.glob("*.off" if self.name == "TOSCA_r" else "tr_reg_*.ply"))

    def mesh(self, name: str) -> Mesh:
        """Return the mesh of that name, in its own units."""
        if self.folder is None:
            kind, number, side = name.split("-")
            return getattr(_generated(kind, int(number), self.vertices), side)
        return read_mesh(self.folder / f"{name}.{'off' if self.name == 'TOSCA_r' else 'ply'}")

    def truth(self, pair: Pair) -> tuple[np.ndarray, np.ndarray]:
        """Return corresponding vertices of source and target, (q,) each."""
        if self.folder is None:
            kind, number, side = pair[0].split("-")
            truth = _generated(kind, int(number), self.vertices).truth
            everywhere = np.arange(len(truth))
            return (truth, everywhere) if side == "source" else (everywhere, truth)
        if self.name == "FAUST":
            same = np.arange(len(self.mesh(pair[0]).vertices))
            return same, same
        source, target = (_remeshed_truth(self.folder, name) for name in pair)
        return source, target

    def landmarks(self, pair: Pair) -> np.ndarray:
        """Return the six landmarks of a pair (source to target), (6, 2) "source, target"."""
        source, target = self.truth(pair)
        if self.folder is None:
            kind, number, _ = pair[0].split("-")
            lines = _generated_landmarks(kind, int(number), self.vertices)
        else:
            lines = TEMPLATE_LANDMARKS if self.name == "FAUST" else TRUTH_LANDMARKS
        return np.stack([source[lines], target[lines]], axis=1)

    def farthest_landmarks(self, pair: Pair, count: int) -> np.ndarray:
        """Return ``count`` true correspondences (l, 2) that are far from each other on the source.

        Their choice depends on nothing but the shape, so that no tuning can have chosen them.
        """
        source, target = self.truth(pair)
        points = self.mesh(pair[0]).vertices[source]
        chosen = [int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))]
        while len(chosen) < count:
            gaps = np.min([np.linalg.norm(points - points[i], axis=1) for i in chosen], axis=0)
            gaps[np.isin(target, target[chosen])] = 0.0  # two lines may share a target vertex
            chosen.append(int(np.argmax(gaps)))
        return np.stack([source[chosen], target[chosen]], axis=1)

    def training(self, count: int | None = None, seed: int = 0) -> list[Pair]:
        """Return ``count`` pairs of the first two people, alternately of one person and of two.

        Of generated shapes: pairs of the first two seeds, alternately of one creature and of two relatives.
        """
        if self.folder is None:
            pairs = _draw(_generated_pairs(range(2)), None, seed)
            one = [pair for pair in pairs if pair[0].startswith("poses")]
        else:
            names = [name for name in self.shapes() if person(name) in TRAINING_PEOPLE]
            pairs = _draw([(a, b) for a in names for b in names if a != b], None, seed)
            one = [pair for pair in pairs if person(pair[0]) == person(pair[1])]
        two = [pair for pair in pairs if pair not in one]
        both = min(len(one), len(two))
        mixed = [pair for turn in zip(one, two, strict=False) for pair in turn]
        return (mixed + one[both:] + two[both:])[:count]

    def reported(self, count: int | None = 100, seed: int = 0, people: Sequence[int] | None = None) -> list[Pair]:
        """Return ``count`` pairs drawn from the list of the data set, or from all ordered pairs if it has none.

        FAUST and FAUST_r: pairs of ``people``, by default of all but the training people. TOSCA_r: pairs of two poses
        of one animal.
        """
        if self.folder is None:
            return _draw(_generated_pairs(range(2, 10)), count, seed)
        names = self.shapes()
        if self.name == "TOSCA_r":
            kinds = {name: name.rstrip("0123456789") for name in names}
            return _draw([(a, b) for a in names for b in names if a != b and kinds[a] == kinds[b]], count, seed)
        people = people or sorted({person(name) for name in names}.difference(TRAINING_PEOPLE))
        names = [name for name in names if person(name) in people]
        every = [(a, b) for a in names for b in names if a != b]
        listed = self.folder / "test_pairs.txt"
        if listed.is_file():
            lines = [line.split() for line in listed.read_text(encoding="utf-8").splitlines() if line.strip()]
            every = [(a, b) for a, b in lines if (a, b) in set(every)]
        return _draw(every, count, seed)


def person(name: str) -> int:
    """Return the number of the person of ``tr_reg_NNN``."""
    return int(name.rsplit("_", 1)[1]) // POSES


def find_data_sets(
    data: Path | None, vertices: int = 2500, names: Sequence[str] = ("FAUST", "FAUST_r")
) -> list[DataSet]:
    """Return the data sets of these ``names`` in the folder ``data`` (or ``data`` itself), or the generated one.

    Raises
    ------
    InvalidInput
        When ``data`` holds none of them.
    """
    if data is None:
        return [DataSet("generated", vertices=vertices)]
    found = []
    for name in names:
        folders = [folder for folder in (data / name, data) if folder.name == name and DataSet(name, folder).shapes()]
        found += [DataSet(name, folder) for folder in folders[:1]]
    if not found:
        remedy = "name the folder that holds them, or leave --data out to use generated shapes"
        raise refuse(f"data {data}", f"a folder {' or '.join(names)} with shapes", "neither", remedy)
    return found


def _generated_pairs(seeds: range) -> list[Pair]:
    return [(f"{kind}-{i}-source", f"{kind}-{i}-target") for i in seeds for kind in GENERATORS]


def _draw(pairs: list[Pair], count: int | None, seed: int) -> list[Pair]:
    """Return ``count`` of ``pairs`` in random order; a longer draw begins with a shorter one of the same seed."""
    order = np.random.default_rng(seed).permutation(len(pairs))
    return [pairs[i] for i in order[:count]]


@lru_cache(maxsize=8)
def _generated(kind: str, number: int, vertices: int) -> datasets.ExamplePair:
    return GENERATORS[kind](vertices, rng=number)


@lru_cache(maxsize=8)
def _generated_landmarks(kind: str, number: int, vertices: int) -> np.ndarray:
    pair = _generated(kind, number, vertices)
    # More than six: two target vertices may share their nearest source vertex.
    chosen = farthest_geodesic(pair.target, 12, rng=0)
    _, first = np.unique(pair.truth[chosen], return_index=True)
    return chosen[np.sort(first)][:6]


@lru_cache(maxsize=256)
def _remeshed_truth(folder: Path, name: str) -> np.ndarray:
    return read_vertex_numbers(folder / "corres" / f"{name}.vts", one_based=True)
