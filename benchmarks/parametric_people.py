"""People drawn from a parametric body model, from infants to the old, in random poses: none was ever chosen on.

    python benchmarks/parametric_people.py [--first 0] [--pairs 40] [--same | --unlike] [--part cut | view]

The model is Anny (Brégier et al. 2026, Apache 2.0), made of MakeHuman's (CC0); its package ``anny`` must be importable.
Sex, age, muscles, weight, height and proportions are drawn uniformly, joints turn by angles that a body can take, and
both bodies are simplified, to 9,000 and 10,000 faces. The truth is known to an edge's length, mouths and eye sockets
included. ``--same``: one person in two poses. ``--unlike``: one is a child of at most seven years, the other grown up.
``--part cut``: the target is what lies above a random plane; ``--part view``: what one camera sees of it.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from bent_copies import Side, remeshed
from game_animals import judged, print_summary
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

from kfmaps.datasets import largest_piece
from kfmaps.geometry.mesh import Mesh

torch: Any = import_module("torch")
SHARES = ("gender", "muscle", "weight", "height", "proportions")
CHILD, GROWN = (0.0, 1 / 3), (0.5, 1.0)
"""Ages as the model counts them: 0 is one year, 1/3 a child, 2/3 a young adult, 1 old."""


@dataclass(frozen=True)
class Bodies:
    """A body model, which of its vertices are the skin's and their faces, and their places on the average body."""

    model: Any
    kept: np.ndarray  # (n,)
    average: Mesh  # of n vertices

    @classmethod
    def read(cls) -> Bodies:
        """The model without eyes and tongue."""
        model = import_module("anny").Anny().to(dtype=torch.float32)
        rest = torch.eye(4)[None, None].repeat(1, model.bone_count, 1, 1)
        x = model(pose_parameters=rest, phenotype_kwargs=dict.fromkeys(model.phenotype_labels, 0.5))["vertices"][0]
        whole = Mesh(x.numpy().astype(float), np.asarray(model.faces).astype(np.int64))
        average, kept = largest_piece(whole, np.ones(len(whole.vertices), dtype=bool))
        return cls(model, kept, average)

    def posed(self, person: dict[str, float], turns: dict[str, np.ndarray]) -> np.ndarray:
        """The vertices (n, 3) of a person whose bones are turned by rotation vectors, in the axes of the body."""
        pose = torch.eye(4)[None, None].repeat(1, self.model.bone_count, 1, 1)
        for name, turn in turns.items():
            matrix = Rotation.from_rotvec(turn).as_matrix()
            pose[0, self.model.bone_labels.index(name), :3, :3] = torch.as_tensor(matrix, dtype=torch.float32)
        moved = self.model(pose_parameters=pose, phenotype_kwargs=person)["vertices"][0]
        return moved.numpy().astype(float)[self.kept]


def drawn_person(rng: np.random.Generator, ages: tuple[float, float]) -> dict[str, float]:
    """The shares of all that makes a body."""
    return {"age": rng.uniform(*ages)} | {name: rng.uniform() for name in SHARES}


def drawn_pose(rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Rotation vectors of bones: a body that faces -y, stands along z, and has its left at +x."""
    turns = {f"spine0{i}": rng.normal(0, 0.1, 3) for i in range(1, 6)} | {"head": rng.normal(0, 0.2, 3)}
    for side, sign in (("L", 1), ("R", -1)):
        lift, forward, spread = rng.uniform(-0.5, 0.9), rng.uniform(-0.4, 1.2), rng.uniform(-0.1, 0.5)
        turns[f"upperarm01.{side}"] = np.array([rng.normal(0, 0.2), -sign * lift, -sign * forward])
        turns[f"lowerarm01.{side}"] = np.array([0, 0, -sign * rng.uniform(0, 1.8)])
        swing = rng.uniform(-0.4, 1.3)
        turns[f"upperleg01.{side}"] = np.array([-swing, -sign * spread, rng.normal(0, 0.15)])
        turns[f"lowerleg01.{side}"] = np.array([rng.uniform(0, 1.0) + 0.5 * max(swing, 0), 0, 0])
        turns[f"wrist.{side}"] = rng.normal(0, 0.2, 3)
        turns[f"foot.{side}"] = rng.normal(0, 0.15, 3)
    return turns


def seen(side: Side, direction: np.ndarray) -> Side:
    """The largest piece of what a distant camera sees that looks along ``direction``."""
    mesh = side.mesh
    turn = Rotation.align_vectors([[0, 0, 1]], [direction])[0]
    corners = turn.apply(mesh.vertices)[mesh.faces]  # (m, 3, 3)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    pixel = np.sqrt(np.linalg.norm(normals, axis=1).mean() / 2)
    # Points of a lattice on each face, some to a pixel, hide what lies behind them.
    u, v = (part.ravel() / 8 for part in np.meshgrid(range(9), range(9)))
    shares = np.stack([u, v, 1 - u - v], axis=1)[u + v <= 1]
    points = np.einsum("sc,mcd->msd", shares, corners)
    cells = np.floor(points[..., :2] / pixel).astype(np.int64)
    cells -= cells.min(axis=(0, 1))
    flat = cells @ np.array([cells[..., 1].max() + 1, 1])
    nearest = np.full(flat.max() + 1, np.inf)
    np.minimum.at(nearest, flat, points[..., 2])
    is_near = (points[..., 2] < nearest[flat] + 2 * pixel).mean(axis=1) > 0.5
    slope = normals[:, 2] / np.linalg.norm(normals, axis=1)
    keep = np.zeros(len(mesh.vertices), dtype=bool)
    keep[mesh.faces[is_near & (slope < -0.1)]] = True
    part, kept = largest_piece(mesh, keep)
    return Side(part, side.places[kept])


def part_of(side: Side, how: str, rng: np.random.Generator) -> Side:
    """What a camera sees of a body, or what lies above a random plane."""
    direction = rng.normal(size=3) * (1, 1, 0.3 if how == "view" else 1)
    direction /= np.linalg.norm(direction)
    if how == "view":
        upright = Rotation.align_vectors(side.places, side.mesh.vertices)[0]
        return seen(side, upright.inv().apply(direction))
    heights = side.places @ direction
    return side.cut(direction, np.quantile(heights, rng.uniform(0.3, 0.65)))


def pair(bodies: Bodies, number: int, arguments: argparse.Namespace) -> tuple[Side, Side, str]:
    """Two remeshed people, and their ages as text."""
    rng = np.random.default_rng([number, arguments.same, arguments.unlike])
    first = drawn_person(rng, CHILD if arguments.unlike else (CHILD[0], GROWN[1]))
    second = first if arguments.same else drawn_person(rng, GROWN if arguments.unlike else (CHILD[0], GROWN[1]))
    if rng.uniform() < 0.5:
        first, second = second, first
    sides = [
        remeshed(bodies.average, bodies.posed(one, drawn_pose(rng)), n_faces, rng)
        for one, n_faces in ((first, 9000), (second, 10000))
    ]
    if arguments.part:
        sides[1] = part_of(sides[1], arguments.part, rng)
    return sides[0], sides[1], f"{first['age']:.2f}, {second['age']:.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--first", type=int, default=0, help="number of the first pair")
    parser.add_argument("--pairs", type=int, default=40)
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--same", action="store_true", help="one person in two poses")
    kind.add_argument("--unlike", action="store_true", help="children and the grown up")
    parser.add_argument("--part", choices=("cut", "view"), help="what is left of the target")
    arguments = parser.parse_args()
    bodies, rows = Bodies.read(), []
    print(f"{'ages':12} pair   error  unmatched  verdict             CPU s")
    for number in range(arguments.first, arguments.first + arguments.pairs):
        source, target, ages = pair(bodies, number, arguments)
        truth = np.asarray(KDTree(source.places).query(target.places)[1])
        rows.append(judged(f"{ages:12} {number:4}", source.mesh, target.mesh, truth))
    print_summary(rows)


if __name__ == "__main__":
    main()
