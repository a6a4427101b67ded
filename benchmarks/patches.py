"""What is said of patches that fit many places: ``python benchmarks/patches.py [--data DIR]``.

Discs, planes, tubes and caps of spheres, of several shares of the whole's area, and pieces cut out of the whole itself
by a distance: tips of limbs and pieces of skin. None can be told from other places, so none may be "sure". The wholes
are generated bodies and, with DIR as for benchmarks/automatic.py, a person and a cat. Half a minute a patch.
"""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from automatic import mesh_file, read
from scipy.spatial import Delaunay

import kfmaps
from kfmaps import datasets
from kfmaps.datasets import largest_piece
from kfmaps.geometry.geodesics import farthest_geodesic, geodesic_distances
from kfmaps.geometry.mesh import Mesh, surface_area


def flat(points: np.ndarray) -> Mesh:
    """Points ``(n, 2)`` of a convex piece of the plane, triangulated."""
    return Mesh(np.column_stack([points, np.zeros(len(points))]), Delaunay(points).simplices.astype(np.int64))


def disc(n: int = 600) -> Mesh:
    k = np.arange(n) + 0.5
    angle = k * np.pi * (3 - np.sqrt(5))
    return flat(np.sqrt(k / n)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))


def plane(n: int = 24) -> Mesh:
    return flat(np.stack(np.meshgrid(np.linspace(0, 1.4, n), np.linspace(0, 1, n)), axis=-1).reshape(-1, 2))


def tube(around: int = 24, along: int = 36) -> Mesh:
    """An open cylinder, five times as long as its radius."""
    rows = np.arange(around * along).reshape(along, around)
    height, turn = np.divmod(rows.ravel(), around)
    angle = 2 * np.pi * turn / around
    vertices = np.column_stack([np.cos(angle), np.sin(angle), height * 5 / 36])
    a, b = rows[:-1], np.roll(rows, -1, axis=1)[:-1]
    c, d = np.roll(rows, -1, axis=1)[1:], rows[1:]
    return Mesh(vertices, np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))]))


def cap(share: float) -> Mesh:
    """The share of a sphere that lies above a plane."""
    sphere = datasets.sphere(1500)
    height = sphere.vertices[:, 2]
    return largest_piece(sphere, height >= np.quantile(height, 1 - share))[0]


def patches(whole: Mesh) -> Iterator[tuple[str, Mesh]]:
    made = [(disc(), 0.01), (plane(), 0.05), (tube(), 0.05), (tube(), 0.15), (cap(0.3), 0.05), (cap(0.8), 0.1)]
    names = "disc", "plane", "tube", "tube", "cap", "most of a sphere"
    for name, (mesh, share) in zip(names, made, strict=True):
        size = np.sqrt(share * surface_area(whole) / surface_area(mesh))
        yield f"{name}, {share:.0%}", Mesh(size * mesh.vertices, mesh.faces)
    tip = int(farthest_geodesic(whole, 2, 0)[1])
    for name, centre, share in (("tip of a limb", tip, 0.04), ("piece of skin", len(whole.vertices) // 2, 0.08)):
        away = geodesic_distances(whole, np.array([centre]))[0]
        yield f"{name}, {share:.0%}", largest_piece(whole, away <= np.quantile(away, share))[0]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path)
    data = parser.parse_args().data
    warnings.simplefilter("ignore", kfmaps.KfmapsWarning)
    wholes = {"creature": datasets.symmetric_creature(6000, rng=1).source, "body": datasets.two_poses(6000).source}
    for folder, name in (("FAUST_r", "tr_reg_000"), ("TOSCA_r", "cat0")) if data else ():
        wholes[name] = read(mesh_file(data / folder, name))
    print(f"{'whole':12} {'patch':22} {'verdict':10} chance  best and next score")
    for name, whole in wholes.items():
        for patch, mesh in patches(whole):
            found = kfmaps.match(whole, mesh, replace(kfmaps.Config(), threads=1))
            scores = ", ".join(f"{score:.1f}" for score in found.score.scores[:2])
            print(f"{name:12} {patch:22} {found.verdict:10} {found.confidence:6.2f}  {scores}", flush=True)


if __name__ == "__main__":
    main()
