"""Shapes with known correspondences, and which pairs settings are chosen on and which are reported.

Settings are chosen on the first two people of a data set and results are reported on the others, so that no
reported number was tuned on.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Literal

import numpy as np

from kfmaps._arrays import refuse
from kfmaps.datasets import Pair, non_isometric, two_poses
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import read_mesh, read_vertex_numbers

Layout = Literal["FAUST", "FAUST_r", "generated"]
LAYOUTS: tuple[Layout, ...] = ("FAUST", "FAUST_r", "generated")

POSES = 10
"""Consecutive numbers in FAUST's names that are one person."""

TRAINING_PEOPLE = (0, 1)
TEMPLATE_LANDMARKS = np.arange(499, 6000, 1000)
"""The six of NO17's demonstration: vertices 500, 1500, ..., 5500 of the template, counted from 1."""

TRUTH_LANDMARKS = np.array([201, 1121, 2041, 2961, 3881, 4801]) - 1
"""Lines of a remeshed shape's truth whose vertices serve as landmarks."""


@dataclass(frozen=True)
class ShapePair:
    """Names of source and target."""

    source: str
    target: str


@dataclass(frozen=True, eq=False)
class Truth:
    """What is known of a pair: ``landmarks (l, 2)`` "source, target", and corresponding ``source``, ``target`` (q,)."""

    landmarks: np.ndarray
    source: np.ndarray
    target: np.ndarray


@dataclass(frozen=True)
class Collection:
    """A data set, small enough to hand to a worker process; what it names is read on demand.

    Attributes
    ----------
    layout : "FAUST", "FAUST_r" or "generated"
    folder : Path or None
        ``None`` for the generated shapes.
    vertices : int
        Of a generated source.
    """

    layout: Layout
    folder: Path | None = None
    vertices: int = 2500

    @property
    def name(self) -> str:
        return self.layout

    def shapes(self) -> list[str]:
        """Names of all shapes, sorted."""
        if self.folder is None:
            return [f"{kind}-{i}-{side}" for i in range(10) for kind in KINDS for side in SIDES]
        return sorted(path.stem for path in self.folder.glob("tr_reg_*.ply"))

    def mesh(self, shape: str) -> Mesh:
        """The mesh of that name, in its own units.

        Raises
        ------
        InvalidInput
            When there is none.
        """
        if self.folder is None:
            kind, number, side = _parts(shape)
            pair = _generated(kind, number, self.vertices)
            return pair.source if side == "source" else pair.target
        return read_mesh(self.folder / f"{shape}.ply")

    def truth(self, pair: ShapePair) -> Truth:
        """Landmarks and true correspondences of a pair."""
        if self.layout == "FAUST":
            same = np.arange(len(self.mesh(pair.source).vertices))
            return Truth(np.stack([TEMPLATE_LANDMARKS, TEMPLATE_LANDMARKS], axis=1), same, same)
        if self.layout == "FAUST_r":
            assert self.folder is not None
            sides = [_remeshed_truth(self.folder, name) for name in (pair.source, pair.target)]
            return Truth(np.stack([side[TRUTH_LANDMARKS] for side in sides], axis=1), *sides)
        kind, number, _ = _parts(pair.source)
        return _generated_truth(kind, number, self.vertices)

    def training(self, count: int | None = None, seed: int = 0) -> list[ShapePair]:
        """``count`` pairs of the first two people drawn with ``seed``, in turn of one person and of two.

        Of generated shapes: pairs of the first two seeds, in turn of one creature and of two relatives.
        """
        if self.folder is None:
            pairs = _drawn(_generated_pairs(range(2)), None, seed)
            alike = [_parts(pair.source)[0] == "poses" for pair in pairs]
        else:
            names = [name for name in self.shapes() if person(name) in TRAINING_PEOPLE]
            pairs = _drawn([ShapePair(a, b) for a in names for b in names if a != b], None, seed)
            alike = [person(pair.source) == person(pair.target) for pair in pairs]
        one = [pair for pair, same in zip(pairs, alike, strict=True) if same]
        two = [pair for pair, same in zip(pairs, alike, strict=True) if not same]
        both = min(len(one), len(two))
        mixed = [pair for turn in zip(one, two, strict=False) for pair in turn]
        return (mixed + one[both:] + two[both:])[:count]

    def reported(self, count: int | None = 100, seed: int = 0) -> list[ShapePair]:
        """Pairs without any of those people: of the data set's list when it has one, else of all ordered pairs."""
        if self.folder is None:
            return _drawn(_generated_pairs(range(2, 10)), count, seed)
        listed = self.folder / "test_pairs.txt"
        names = [name for name in self.shapes() if person(name) not in TRAINING_PEOPLE]
        if listed.is_file():
            lines = [line.split() for line in listed.read_text(encoding="utf-8").splitlines() if line.strip()]
            every = [ShapePair(a, b) for a, b in lines if a in names and b in names]
        else:
            every = [ShapePair(a, b) for a in names for b in names if a != b]
        return _drawn(every, count, seed)


KINDS = {"poses": two_poses, "relatives": non_isometric}
SIDES = ("source", "target")


def person(name: str) -> int:
    """The person of ``tr_reg_NNN``."""
    return int(name.rsplit("_", 1)[1]) // POSES


def collections(data: Path | None, vertices: int = 2500) -> list[Collection]:
    """The data sets found in ``data`` (or that ``data`` itself is); the generated one without ``data``.

    Raises
    ------
    InvalidInput
        When ``data`` holds neither FAUST nor FAUST_r.
    """
    if data is None:
        return [Collection("generated", vertices=vertices)]
    found = []
    for layout in ("FAUST", "FAUST_r"):
        for folder in (data / layout, data):
            if folder.name == layout and any(folder.glob("tr_reg_*.ply")):
                found.append(Collection(layout, folder))
                break
    if not found:
        remedy = "name the folder that holds them, or leave --data out to use generated shapes"
        raise refuse(f"data {data}", "a folder FAUST or FAUST_r with tr_reg_*.ply", "neither", remedy)
    return found


def _parts(shape: str) -> tuple[str, int, str]:
    kind, number, side = shape.split("-")
    return kind, int(number), side


def _generated_pairs(seeds: range) -> list[ShapePair]:
    return [ShapePair(*(f"{kind}-{i}-{side}" for side in SIDES)) for i in seeds for kind in KINDS]


def _drawn(pairs: list[ShapePair], count: int | None, seed: int) -> list[ShapePair]:
    """``count`` of ``pairs``, a longer draw beginning with a shorter one of the same seed; all when there are fewer."""
    order = np.random.default_rng(seed).permutation(len(pairs))
    return [pairs[i] for i in order[:count]]


@lru_cache(maxsize=8)
def _generated(kind: str, number: int, vertices: int) -> Pair:
    return KINDS[kind](vertices, rng=number)


@lru_cache(maxsize=8)
def _generated_truth(kind: str, number: int, vertices: int) -> Truth:
    from kfmaps.geometry.geodesics import farthest_geodesic

    pair = _generated(kind, number, vertices)
    everywhere = np.arange(len(pair.truth))
    # A few more than wanted: two targets may share their nearest source vertex.
    chosen = farthest_geodesic(pair.target, 12, rng=0)
    _, first = np.unique(pair.truth[chosen], return_index=True)
    chosen = chosen[np.sort(first)][:6]
    return Truth(np.stack([pair.truth[chosen], chosen], axis=1), pair.truth, everywhere)


@lru_cache(maxsize=256)
def _remeshed_truth(folder: Path, name: str) -> np.ndarray:
    return read_vertex_numbers(folder / "corres" / f"{name}.vts", one_based=True)
