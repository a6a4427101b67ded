"""Where the non-rigid fit ends on the two poses, and whether the truth is what it looks for.

    python benchmarks/drift.py [--seed 0]

The creature's truth is known at every point, so that both can be asked: does the fit stay when it begins with the
truth, and has the truth less of what the fit makes small? For each limb the mean error is printed (straight distances,
per cent of √area), and by how many degrees the limb is turned about its axis.
"""

from __future__ import annotations

import argparse

import numpy as np

from kfmaps import datasets
from kfmaps.datasets.creature import CREATURE, DANCE
from kfmaps.datasets.skeleton import Body
from kfmaps.datasets.surface import closed_mesh
from kfmaps.fmap.precise import PointMap, point_positions
from kfmaps.geometry.arap import arap_energy, build_arap
from kfmaps.geometry.mesh import Mesh, surface_area, unit_area, vertex_areas
from kfmaps.matching.match import match
from kfmaps.registration.nonrigid_icp import NonRigid, Registration

VERTICES = 4000
LIMBS = [limb.name for limb in CREATURE]


def axes(body: Body, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The limb that each point of the unbent skin is on, and place and direction of its axis there."""
    limb = np.stack([body._distances(points, i)[0].min(axis=1) for i in range(len(LIMBS))]).argmin(axis=0)
    middles = 0.5 * (body.nodes[:, :-1] + body.nodes[:, 1:])
    steps = np.diff(body.nodes, axis=1)
    steps /= np.linalg.norm(steps, axis=2, keepdims=True)
    piece = np.linalg.norm(points[:, None] - middles[limb], axis=2).argmin(axis=1)
    return limb, middles[limb, piece], steps[limb, piece]


def angles(points: np.ndarray, images: np.ndarray, middles: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """By how much ``images`` are turned from ``points`` about the axis, in degrees."""
    flat = []
    for x in (points, images):
        away = x - middles
        flat.append(away - (away * axis).sum(axis=1, keepdims=True) * axis)
    across = (np.cross(*flat) * axis).sum(axis=1)
    return np.degrees(np.arctan2(across, (flat[0] * flat[1]).sum(axis=1)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=0)
    seed = parser.parse_args().seed
    pair = datasets.two_poses(VERTICES, rng=seed)
    source, target = unit_area(pair.source), unit_area(pair.target)
    body, rng = Body(CREATURE), np.random.default_rng(seed)
    rest_s, rest_t = (closed_mesh(body, body.box(), len(mesh.vertices), rng)[0] for mesh in (pair.source, pair.target))
    limb, middles, axis = axes(body, rest_t)
    truth = point_positions(PointMap(pair.truth_faces, pair.truth_weights), source)
    bent = body.bend(rest_s, DANCE) / np.sqrt(surface_area(pair.target))
    energy, area = build_arap(source), float(vertex_areas(source).sum())
    print(f"bending of the truth {arap_energy(energy, bent) / area:.4f}")
    found = match(pair.source, pair.target).target_to_source
    fits: dict[str, Registration] = {
        "from the map": NonRigid()(source, target, found),
        "from the truth": NonRigid()(source, target, pair.truth),
        "from the truth, 60 steps": NonRigid(steps=20)(source, target, pair.truth),
    }
    for name, fit in fits.items():
        place = PointMap(fit.faces, fit.weights)
        errors = 100 * np.linalg.norm(point_positions(place, source) - truth, axis=1)
        turned = angles(rest_t, point_positions(place, Mesh(rest_s, source.faces)), middles, axis)
        arms = np.isin(limb, [i for i, part in enumerate(LIMBS) if part.endswith(" arm")])
        print(
            f"{name}: error {errors.mean():.2f}, without the arms {errors[~arms].mean():.2f}; bending {fit.bending:.4f}"
        )
        for i, part in enumerate(LIMBS):
            on = limb == i
            print(f"    {part:12} {errors[on].mean():5.2f}, turned by {turned[on].mean():4.0f} degrees")


if __name__ == "__main__":
    main()
