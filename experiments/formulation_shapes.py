"""The shapes of the comparison of formulations: remeshed humans and animals, or the package's own without data.

People 0 to 3 of FAUST_r serve to choose settings, people 4 to 7 and the animals of TOSCA_r are reported.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np

from data_sets import Collection, ShapePair, person
from kfmaps.config import Config, DescriptorConfig
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import read_mesh, read_vertex_numbers
from kfmaps.shape import Shape, prepare

EVERY = 12
"""Of the lines of a truth of 5,000, each which one is asked for."""
LANDMARKS = 6
REPORTED = (4, 5, 6, 7)
CHOSEN_ON = (0, 1, 2, 3)


@dataclass(frozen=True, eq=False)
class Known:
    """``landmarks (6, 2)`` "source, target", and corresponding vertices ``source``, ``target`` (q,)."""

    landmarks: np.ndarray
    source: np.ndarray
    target: np.ndarray


@dataclass(frozen=True)
class Shapes:
    """``collection`` "FAUST_r", "TOSCA_r" or "generated", and its folder."""

    collection: str
    folder: Path | None = None
    vertices: int = 1500

    def prepared(self, name: str, size: int) -> Shape:
        """The shape of that name with ``size`` eigenfunctions, kept in memory."""
        return _prepared(self, name, size)

    def pairs(self, count: int | None, seed: int = 0, people: tuple[int, ...] = REPORTED) -> list[tuple[str, str]]:
        """``count`` pairs, drawn with ``seed``: of those ``people``, or of two poses of one animal."""
        if self.folder is None:
            every = [(p.source, p.target) for p in Collection("generated", vertices=self.vertices).reported(None, 0)]
        elif self.collection == "FAUST_r":
            lines = (self.folder / "test_pairs.txt").read_text(encoding="utf-8").split("\n")
            listed = [(line.split()[0], line.split()[1]) for line in lines if line.strip()]
            every = [pair for pair in listed if all(person(name) in people for name in pair)]
        else:
            names = sorted(path.stem for path in self.folder.glob("*.off"))
            kind = {name: name.rstrip("0123456789") for name in names}
            every = [(a, b) for a in names for b in names if a != b and kind[a] == kind[b]]
        order = np.random.default_rng(seed).permutation(len(every))
        return [every[i] for i in order[:count]]

    def truth(self, name_s: str, name_t: str) -> tuple[np.ndarray, np.ndarray]:
        """All corresponding vertices of a pair, (m,) each."""
        if self.folder is None:
            turned = name_s.endswith("target")
            names = (name_t, name_s) if turned else (name_s, name_t)
            found = Collection("generated", vertices=self.vertices).truth(ShapePair(*names))
            return (found.target, found.source) if turned else (found.source, found.target)
        s, t = (_truth(self.folder, name) for name in (name_s, name_t))
        return s, t

    def landmarks(self, name_s: str, name_t: str, count: int) -> np.ndarray:
        """``count`` corresponding pairs (l, 2), far from each other on the source: no tuning can have chosen them."""
        s, t = self.truth(name_s, name_t)
        places = self.mesh(name_s).vertices
        taken = [int(np.argmax(np.linalg.norm(places[s] - places[s].mean(axis=0), axis=1)))]
        while len(taken) < count:
            gaps = np.min([np.linalg.norm(places[s] - places[s[i]], axis=1) for i in taken], axis=0)
            gaps[np.isin(t, t[taken])] = 0.0  # two lines may share a target vertex
            taken.append(int(np.argmax(gaps)))
        return np.stack([s[taken], t[taken]], axis=1)

    def known(self, name_s: str, name_t: str) -> Known:
        """Landmarks and some corresponding vertices of a pair."""
        s, t = self.truth(name_s, name_t)
        step = max(1, len(s) * EVERY // 5000)
        return Known(self.landmarks(name_s, name_t, LANDMARKS), s[::step], t[::step])

    def mesh(self, name: str) -> Mesh:
        """The mesh of that name, in its own units."""
        if self.folder is None:
            return Collection("generated", vertices=self.vertices).mesh(name)
        file = self.folder / (f"{name}.ply" if self.collection == "FAUST_r" else f"{name}.off")
        return read_mesh(file)


@lru_cache(maxsize=128)
def _prepared(shapes: Shapes, name: str, size: int) -> Shape:
    config = replace(
        Config.single_fit(), descriptors=DescriptorConfig(eigenfunctions=size, shot=False), refinement=None, threads=1
    )
    return prepare(shapes.mesh(name), config, name=name)


@lru_cache(maxsize=256)
def _truth(folder: Path, name: str) -> np.ndarray:
    return read_vertex_numbers(folder / "corres" / f"{name}.vts", one_based=True)
