"""A small collection on disk, in the layout of the remeshed benchmarks, for the tests of collections.

As a program it matches one: ``python collecting.py FOLDER OUTPUT``, to be killed by a test.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import permutations
from pathlib import Path

import numpy as np

from conftest import blob
from kfmaps.batch.layout import Pair, find_collection
from kfmaps.batch.plan import Plan, make_plan
from kfmaps.batch.results import Result
from kfmaps.batch.run import run_batch
from kfmaps.batch.run_spec import RunSpec
from kfmaps.batch.work import match_pair, prepare_shape
from kfmaps.config import BasisConfig, Config, DescriptorConfig, NystromConfig
from kfmaps.fmap.zoomout import ZoomOut
from kfmaps.geometry.mesh import Mesh
from kfmaps.io import write_mesh, write_vertex_numbers

LANDMARKS = (1, 50, 120, 170)
"""Lines of the truth, counted from 1."""

CONFIG = replace(
    Config.single_fit(),
    basis=BasisConfig(n_eigenfunctions=20),
    descriptors=DescriptorConfig(n_spectral=20, n_eigenfunctions=40, shot=False),
    nystrom=NystromConfig(samples=60),
    refinement=ZoomOut(start=10, stop=40, step=5),
)
"""Of a size for shapes of a few hundred vertices."""


def registered(i: int, n: int) -> Mesh:
    """Poses of one shape: each bends it a little more, its vertices corresponding by number."""
    mesh = blob(n)
    x, y, z = mesh.vertices.T
    return Mesh(np.stack([x + 0.04 * i * y**2, y, z], axis=1), mesh.faces)


def write_collection(folder: Path, count: int = 3, *, sizes: Sequence[int] = (), n: int = 200) -> Path:
    """Write ``count`` poses ``b0.off``, ... with shuffled vertices, and their true correspondences.

    ``sizes`` gives numbers of vertices other than ``n`` to the first shapes; those have no truth.
    """
    (folder / "corres").mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(5)
    for i in range(count):
        size = sizes[i] if i < len(sizes) else n
        mesh, order = registered(i, size), rng.permutation(size)
        place = np.argsort(order)
        write_mesh(folder / f"b{i}.off", Mesh(mesh.vertices[order], place[mesh.faces]))
        if size == n:
            write_vertex_numbers(folder / "corres" / f"b{i}.vts", place)
    return folder


def plan_of(
    folder: Path,
    output: Path,
    config: Config = CONFIG,
    lines: tuple[int, ...] = LANDMARKS,
    seed: int = 0,
    retry_failed: bool = False,
) -> Plan:
    """The plan of all pairs of a folder."""
    collection = find_collection(folder)
    settings = RunSpec(config, seed=seed, landmark_lines=lines)
    pairs = [Pair(a, b) for a, b in permutations(collection.shapes, 2)]
    return make_plan(collection, pairs, settings, output, retry_failed=retry_failed)


def touch(path: Path, text: str = "") -> Path:
    """Write a small file where there may be no folder yet."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def done(plan: Plan) -> list[Result]:
    """The plan's work, in this process."""
    prepared = {t.entry: prepare_shape(t) for task in plan.todo for t in (task.source, task.target)}
    return [match_pair((t, prepared[t.source.entry], prepared[t.target.entry])) for t in plan.todo]


@dataclass(frozen=True)
class Deadly:
    """A linear kernel that kills its process when one of the shapes has ``size`` vertices."""

    size: int

    def __call__(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        if self.size in (len(x), len(y)):
            os.kill(os.getpid(), signal.SIGKILL)
        return x @ y.T


AGREED = replace(CONFIG, descriptors=replace(CONFIG.descriptors, shot=True))
"""For maps that are made to agree: they are judged by SHOT too."""


if __name__ == "__main__":
    run_batch(plan_of(Path(sys.argv[1]), Path(sys.argv[2])), workers=1)
