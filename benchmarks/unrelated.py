"""What is said of shapes that have nothing in common: ``python benchmarks/unrelated.py [--data DIR] [--pairs 25]``.

Pairs of different kinds, drawn with a fixed seed: tori, vases, spheres, creatures, bodies without symmetry and, with
DIR as for benchmarks/automatic.py, people and animals. No map between them is right, so none may be "sure".
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from itertools import permutations
from pathlib import Path

import numpy as np
from automatic import mesh_file, read
from shapes import bumpy_sphere

import kfmaps
from kfmaps import datasets
from kfmaps.datasets.skeleton import Body, Limb
from kfmaps.datasets.surface import closed_mesh

FILES = {
    "person": ("FAUST_r", ("tr_reg_041", "tr_reg_066")),
    "child": ("TOPKIDS", ("kid00",)),
    "horse": ("TOSCA_r", ("horse5", "horse14")),
    "cat": ("TOSCA_r", ("cat1", "cat6")),
    "cow": ("SMAL_r", ("cow_02",)),
}
"""Of each kind the folder and some shapes, most of which settings were not chosen on."""


def vase(vertices: int, seed: int) -> kfmaps.Mesh:
    """A hollow vase, a surface of revolution about the y axis: turned about it it is the same."""
    profile = ((0, 0), (0.30, 0.02), (0.52, 0.30), (0.55, 0.58), (0.36, 0.95), (0.28, 1.2), (0.42, 1.45))
    body = Body((Limb("wall", None, tuple((x, y, 0, 0.07) for x, y in profile)),), segments=60)

    def field(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        radius = np.maximum(np.hypot(points[:, 0], points[:, 2]), 1e-12)
        values, flat = body(np.stack([radius, points[:, 1], np.zeros_like(radius)], axis=1))
        across = flat[:, 0] / radius
        return values, np.stack([across * points[:, 0], flat[:, 1], across * points[:, 2]], axis=1)

    low, high = body.box()
    box = np.array([[-high[0], low[1], -high[0]], [high[0], high[1], high[0]]])
    return kfmaps.Mesh(*closed_mesh(field, box, vertices, np.random.default_rng(seed)))


def made(kind: str, seed: int) -> kfmaps.Mesh:
    """A generated shape of a kind."""
    if kind == "body":
        return bumpy_sphere(3000, seed)
    if kind == "creature":
        return datasets.symmetric_creature(3000, rng=seed).target
    if kind == "torus":
        return datasets.torus(3000, rng=seed)
    return vase(3000, seed) if kind == "vase" else datasets.sphere(3000, rng=seed)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path)
    parser.add_argument("--pairs", type=int, default=25)
    parser.add_argument("--from", dest="first", type=int, default=0, help="number of the first pair that is matched")
    arguments = parser.parse_args()
    kinds = ["torus", "vase", "sphere", "creature", "body", *(FILES if arguments.data else ())]
    # A person and a child, and two four-legged animals, do correspond.
    alike = [{"person", "child"}, *({a, b} for a, b in permutations(("horse", "cat", "cow"), 2))]
    pairs = [pair for pair in permutations(kinds, 2) if set(pair) not in alike]
    rng = np.random.default_rng(0)
    config, told = replace(kfmaps.Config(), threads=1), []
    for i, number in enumerate(rng.permutation(len(pairs))[: arguments.pairs]):
        shapes = []
        for kind in pairs[number]:
            if kind in FILES:
                folder, names = FILES[kind]
                shapes.append(read(mesh_file(arguments.data / folder, str(rng.choice(names)))))
            else:
                shapes.append(made(kind, int(rng.integers(100))))
        if i < arguments.first:
            continue
        found = kfmaps.match(shapes[0], shapes[1], config)
        told.append(found.verdict)
        print(f"{' to '.join(pairs[number]):24} {found.verdict:10} {found.confidence:5.2f}", flush=True)
    print(", ".join(f"{told.count(word)} {word}" for word in ("sure", "likely", "ambiguous", "unlikely")))


if __name__ == "__main__":
    main()
