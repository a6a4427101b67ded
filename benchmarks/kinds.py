"""Maps of generated things of many kinds: ``benchmarks/kinds.py [--kinds later] [--pairs 4] [--faces 300]``.

Settings of rotational symmetries and of self-maps were chosen on octopuses, stars and tables, none on ``later`` kinds
(:mod:`later_kinds`). Each pair is one body in two random poses, meshed independently; of every second pair the
proportions differ, too: limbs are longer and thicker by 15 % on average, alike limbs alike. What a shape's own symmetry
leaves open no map can know: of an octopus, a star, a table and a comb none should be "sure". With ``--faces`` both
meshes are simplified to so many faces.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import igl
import numpy as np
from automatic import RIGHT
from later_kinds import LATER_KINDS
from limbs import around, sided
from scipy.spatial import KDTree

import kfmaps
from kfmaps.datasets import ExamplePair, posed_pair
from kfmaps.datasets.skeleton import Bend, Body, Limb
from kfmaps.geometry.mesh import Mesh

TURN = 12.0
"""Standard deviation of the turns of a limb at its points, in degrees; of the trunk a third."""
VARIATION = 0.15
"""Standard deviation of the logarithm of lengths and thicknesses."""


KINDS: dict[str, tuple[Limb, ...]] = {
    "octopus": (
        *sided(("trunk", None, ((0, 1.0, 0, 0.2), (0, 1.2, 0.02, 0.27), (0, 1.5, 0.04, 0.22)))),
        *around(8, ((0.15, 0.95, 0, 0.07), (0.4, 0.7, 0, 0.06), (0.7, 0.5, 0, 0.05), (1.0, 0.45, 0, 0.03))),
    ),
    "star": (
        *sided(("trunk", None, ((0, -0.05, 0, 0.2), (0, 0, 0, 0.22), (0, 0.05, 0, 0.2)))),
        *around(5, ((0.1, 0, 0, 0.14), (0.4, 0, 0, 0.11), (0.8, 0, 0, 0.05))),
    ),
    "table": sided(
        ("trunk", None, ((0, 0.7, -0.55, 0.1), (0, 0.7, 0, 0.12), (0, 0.7, 0.55, 0.1))),
        ("left side", "trunk", ((0.05, 0.7, 0, 0.1), (0.2, 0.7, 0, 0.1), (0.4, 0.7, 0, 0.1))),
        ("left front", "trunk", ((0.1, 0.68, 0.5, 0.08), (0.35, 0.5, 0.6, 0.06), (0.4, 0, 0.65, 0.055))),
        ("left back", "trunk", ((0.1, 0.68, -0.5, 0.08), (0.35, 0.5, -0.6, 0.06), (0.4, 0, -0.65, 0.055))),
    ),
    "chair": sided(
        ("trunk", None, ((0, 0.5, -0.4, 0.1), (0, 0.5, 0, 0.12), (0, 0.5, 0.4, 0.1))),
        ("left side", "trunk", ((0.05, 0.5, 0, 0.1), (0.2, 0.5, 0, 0.1), (0.36, 0.5, 0, 0.09))),
        ("left front", "left side", ((0.34, 0.48, 0.34, 0.07), (0.36, 0.25, 0.36, 0.06), (0.37, 0, 0.37, 0.055))),
        ("left back", "left side", ((0.34, 0.48, -0.34, 0.07), (0.36, 0.25, -0.36, 0.06), (0.37, 0, -0.38, 0.055))),
        ("left rail", "left side", ((0.34, 0.5, 0.3, 0.07), (0.34, 0.5, 0, 0.08), (0.34, 0.5, -0.3, 0.07))),
        ("left post", "left rail", ((0.34, 0.52, -0.34, 0.06), (0.34, 0.9, -0.38, 0.055), (0.34, 1.3, -0.42, 0.05))),
    ),
    "plane": sided(
        ("trunk", None, ((0, 0, -1, 0.08), (0, 0, -0.3, 0.14), (0, 0, 0.4, 0.15), (0, 0, 1, 0.08))),
        ("left wing", "trunk", ((0.1, 0, 0.1, 0.09), (0.5, 0.02, -0.05, 0.075), (1.0, 0.05, -0.25, 0.05))),
        ("left tail", "trunk", ((0.05, 0.02, -0.9, 0.05), (0.25, 0.03, -1.0, 0.045), (0.4, 0.04, -1.08, 0.04))),
        ("fin", "trunk", ((0, 0.05, -0.9, 0.05), (0, 0.25, -1.0, 0.045), (0, 0.42, -1.1, 0.04))),
        ("left engine", "left wing", ((0.45, -0.12, 0.12, 0.06), (0.45, -0.08, 0, 0.07), (0.45, -0.06, -0.08, 0.06))),
    ),
    "hand": sided(
        ("trunk", None, ((0, -0.5, 0, 0.16), (0, -0.2, 0, 0.17), (0, 0.1, 0, 0.2), (0, 0.3, 0, 0.2))),
        ("palm", "trunk", ((-0.22, 0.25, 0, 0.12), (0, 0.3, 0, 0.13), (0.22, 0.25, 0, 0.12))),
        ("thumb", "trunk", ((0.15, 0.0, 0.02, 0.09), (0.38, 0.15, 0.06, 0.075), (0.5, 0.36, 0.1, 0.06))),
        ("index", "palm", ((0.24, 0.3, 0, 0.08), (0.28, 0.6, 0, 0.07), (0.3, 0.9, 0.02, 0.055))),
        ("middle", "palm", ((0.08, 0.32, 0, 0.08), (0.1, 0.68, 0, 0.07), (0.1, 1.02, 0.02, 0.055))),
        ("ring", "palm", ((-0.08, 0.32, 0, 0.08), (-0.09, 0.64, 0, 0.068), (-0.1, 0.95, 0.02, 0.053))),
        ("little", "palm", ((-0.23, 0.28, 0, 0.07), (-0.28, 0.52, 0, 0.06), (-0.3, 0.74, 0.02, 0.05))),
    ),
    "bird": sided(
        ("trunk", None, ((0, 0.5, -0.4, 0.12), (0, 0.55, -0.1, 0.22), (0, 0.65, 0.2, 0.17))),
        ("head", "trunk", ((0, 0.7, 0.25, 0.12), (0, 0.9, 0.4, 0.13), (0, 0.95, 0.5, 0.12))),
        ("beak", "head", ((0, 0.93, 0.52, 0.07), (0, 0.9, 0.68, 0.05), (0, 0.87, 0.8, 0.03))),
        ("tail", "trunk", ((0, 0.5, -0.42, 0.1), (0, 0.48, -0.7, 0.09), (0, 0.46, -1.0, 0.07))),
        ("left wing", "trunk", ((0.12, 0.65, 0.05, 0.1), (0.5, 0.75, 0, 0.08), (1.0, 0.7, -0.15, 0.05))),
        ("left leg", "trunk", ((0.1, 0.4, -0.05, 0.06), (0.12, 0.2, -0.02, 0.045), (0.13, 0.02, 0.02, 0.045))),
    ),
    "fish": sided(
        ("trunk", None, ((0, 0, -0.8, 0.08), (0, 0, -0.3, 0.2), (0, 0.02, 0.2, 0.26), (0, 0, 0.6, 0.15))),
        ("top", "trunk", ((0, 0.15, 0.1, 0.08), (0, 0.36, 0, 0.06), (0, 0.45, -0.15, 0.04))),
        ("up", "trunk", ((0, 0.02, -0.78, 0.07), (0, 0.2, -0.95, 0.055), (0, 0.4, -1.1, 0.04))),
        ("down", "trunk", ((0, -0.02, -0.78, 0.07), (0, -0.2, -0.95, 0.055), (0, -0.34, -1.05, 0.04))),
        ("left fin", "trunk", ((0.18, -0.05, 0.25, 0.07), (0.35, -0.15, 0.15, 0.055), (0.5, -0.22, 0.0, 0.04))),
    ),
    "ant": sided(
        ("trunk", None, ((0, 0.5, -0.25, 0.1), (0, 0.5, 0, 0.13), (0, 0.52, 0.25, 0.1))),
        ("rear", "trunk", ((0, 0.5, -0.25, 0.1), (0, 0.55, -0.5, 0.2), (0, 0.5, -0.85, 0.15))),
        ("head", "trunk", ((0, 0.52, 0.28, 0.1), (0, 0.56, 0.45, 0.16), (0, 0.5, 0.6, 0.1))),
        ("left horn", "head", ((0.07, 0.62, 0.5, 0.05), (0.2, 0.85, 0.65, 0.035), (0.25, 0.9, 0.9, 0.03))),
        ("left front", "trunk", ((0.08, 0.47, 0.15, 0.055), (0.4, 0.6, 0.35, 0.045), (0.7, 0.05, 0.55, 0.035))),
        ("left middle", "trunk", ((0.08, 0.47, 0, 0.055), (0.45, 0.6, 0, 0.045), (0.8, 0.05, 0, 0.035))),
        ("left hind", "trunk", ((0.08, 0.47, -0.15, 0.055), (0.4, 0.6, -0.4, 0.045), (0.7, 0.05, -0.75, 0.035))),
    ),
    "spider": sided(
        ("trunk", None, ((0, 0.5, -0.1, 0.14), (0, 0.5, 0.1, 0.15), (0, 0.5, 0.25, 0.11))),
        ("rear", "trunk", ((0, 0.5, -0.12, 0.12), (0, 0.58, -0.4, 0.26), (0, 0.55, -0.65, 0.2))),
        *(
            (f"left leg {i}", "trunk", ((0.1, 0.5, z, 0.05), (0.45, 0.8, 2 * z, 0.045), (0.9, 0.1, 3.2 * z, 0.035)))
            for i, z in enumerate((0.19, 0.07, -0.05, -0.16))
        ),
    ),
    "giraffe": sided(
        ("trunk", None, ((0, 0.9, -0.4, 0.17), (0, 0.92, 0, 0.2), (0, 0.97, 0.35, 0.17))),
        ("neck", "trunk", ((0, 1.0, 0.35, 0.13), (0, 1.4, 0.5, 0.09), (0, 1.85, 0.62, 0.08))),
        ("head", "neck", ((0, 1.9, 0.6, 0.09), (0, 1.9, 0.75, 0.085), (0, 1.84, 0.9, 0.06))),
        ("left ear", "head", ((0.06, 1.97, 0.6, 0.04), (0.13, 2.05, 0.58, 0.035), (0.17, 2.1, 0.57, 0.03))),
        ("tail", "trunk", ((0, 0.9, -0.52, 0.06), (0, 0.7, -0.62, 0.045), (0, 0.45, -0.66, 0.04))),
        ("left front", "trunk", ((0.12, 0.85, 0.3, 0.1), (0.13, 0.45, 0.32, 0.065), (0.13, 0.04, 0.33, 0.06))),
        ("left hind", "trunk", ((0.12, 0.85, -0.35, 0.11), (0.13, 0.45, -0.37, 0.065), (0.13, 0.04, -0.36, 0.06))),
    ),
}


def pose(limbs: tuple[Limb, ...], variation: float, rng: np.random.Generator) -> dict[str, Bend]:
    """A random pose, in which alike limbs have alike proportions."""
    proportions: dict[str, tuple[float, float]] = {}
    found = {}
    for limb in limbs:
        alike = limb.name.replace("right", "left") if limb.parent != "trunk" or "arm" not in limb.name else "arm"
        longer, thicker = proportions.setdefault(alike, tuple(np.exp(rng.normal(0, variation, 2)).tolist()))
        turns = rng.normal(0, TURN if limb.parent else TURN / 3, (len(limb.balls) - 1, 3)).tolist()
        found[limb.name] = Bend(tuple((x, y, z) for x, y, z in turns), longer, thicker)
    return found


def made(kind: str, number: int, vertices: int = 3500) -> ExamplePair:
    """The pair of a kind with a ``number``; proportions differ where it is odd."""
    is_later = kind in LATER_KINDS
    seed = 100 + list(LATER_KINDS).index(kind) if is_later else sorted(KINDS).index(kind)
    rng = np.random.default_rng([seed, number])
    limbs, variation = (LATER_KINDS if is_later else KINDS)[kind], VARIATION * (number % 2)
    source, target = pose(limbs, variation, rng), pose(limbs, variation, rng)
    still = {name: replace(bend, turns=()) for name, bend in target.items()} if variation else None
    return posed_pair(kind, Body(limbs), source, target, (vertices, vertices), rng, unbent_t=still)


def simplified(pair: ExamplePair, n_faces: int) -> ExamplePair:
    """The pair with ``n_faces`` on both meshes, and the truth between the vertices that are left."""
    source, target = (
        Mesh(*map(np.asarray, igl.decimate(mesh.vertices, mesh.faces, n_faces)[:2]))
        for mesh in (pair.source, pair.target)
    )
    nearest = np.asarray(KDTree(pair.target.vertices).query(target.vertices)[1])
    truth = KDTree(source.vertices).query(pair.source.vertices[pair.truth[nearest]])[1]
    return replace(pair, source=source, target=target, truth=np.asarray(truth))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", default=",".join(KINDS), help="names, or later for those that nothing was chosen on")
    parser.add_argument("--pairs", type=int, default=4, help="of each kind")
    parser.add_argument("--first", type=int, default=0, help="number of the first pair of each kind")
    parser.add_argument("--faces", type=int, help="of each mesh")
    arguments = parser.parse_args()
    rows = []
    print(f"{'kind':10} pair   error  moved by 15 % or more   verdict       CPU s")
    for kind in LATER_KINDS if arguments.kinds == "later" else arguments.kinds.split(","):
        for number in range(arguments.first, arguments.first + arguments.pairs):
            try:
                pair = made(kind, number)
            except kfmaps.NotConverged:  # limbs that meet
                print(f"{kind:10} {number:4} no closed mesh", flush=True)
                continue
            pair = simplified(pair, arguments.faces) if arguments.faces else pair
            start = time.process_time()
            found = kfmaps.match(pair.source, pair.target, replace(kfmaps.Config(), threads=1))
            seconds = time.process_time() - start
            errors = kfmaps.geodesic_errors(pair.source, found.target_to_source, pair.truth)
            told = f"{found.verdict}, {found.confidence:.3f}"
            off = f"{(errors > 0.15).mean():.0%}"
            print(f"{kind:10} {number:4} {100 * errors.mean():7.2f}  {off:>21}   {told:18} {seconds:.1f}", flush=True)
            rows.append((errors.mean() < RIGHT / 100, found.verdict == "sure"))
    right, sure = np.array(rows).T
    print(f"{len(rows)} maps, {right.sum()} right; {sure.sum()} sure, {(sure & ~right).sum()} of them wrong")


if __name__ == "__main__":
    main()
