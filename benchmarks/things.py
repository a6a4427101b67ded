"""Maps of generated things with hard edges, holes and handles: ``python benchmarks/things.py [--landmarks 3]``.

Nothing was chosen on these kinds. Each pair is one thing, made as the zero set of a distance field by marching cubes on
two grids that are turned at random, simplified, stretched and bent smoothly; the target a little, usually or much by
the number of the pair (0, 1, 2, 0, ...). Errors are mean geodesic distances × 100. What a thing's own symmetry leaves
open no map can know, so the error up to that symmetry is printed too: a gear, a vase and a pipe should not be "sure".
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import igl
import numpy as np
from automatic import RIGHT
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

import kfmaps
from kfmaps.datasets import largest_piece
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh

Points = np.ndarray
"""(m, 3)."""
Field = np.ndarray
"""(m,): about the signed distance of each point from a surface, negative inside."""
Place = tuple[float, float, float]
AMOUNTS = (0.3, 1.0, 1.6)
"""How much a target is deformed; a source 0.3."""


def join(*fields: Field, blend: float = 0.04) -> Field:
    """All of some solids, with fillets of about ``blend``."""
    result = fields[0]
    for other in fields[1:]:
        share = np.clip(0.5 + 0.5 * (other - result) / blend, 0, 1)
        result = other * (1 - share) + result * share - blend * share * (1 - share)
    return result


def carve(one: Field, other: Field) -> Field:
    """The first solid without the other."""
    return -join(-one, other, blend=0.03)


def edged(outside: np.ndarray, edge: float) -> Field:
    """A solid from the distances to its sides, (m, d), with rounded edges."""
    return np.linalg.norm(np.maximum(outside + edge, 0), axis=1) + np.minimum((outside + edge).max(axis=1), 0) - edge


def box(x: Points, centre: Place, half: Place, edge: float = 0.03) -> Field:
    return edged(np.abs(x - centre) - half, edge)


def rod(x: Points, a: Place, b: Place, radius: float, other: float | None = None) -> Field:
    along = np.subtract(b, a)
    t = np.clip((x - a) @ along / (along @ along), 0, 1)
    radii = radius + ((radius if other is None else other) - radius) * t
    return np.linalg.norm(x - a - t[:, None] * along, axis=1) - radii


def ellipsoid(x: Points, centre: Place, radii: Place) -> Field:
    return (np.linalg.norm((x - centre) / np.array(radii), axis=1) - 1) * min(radii)


def split(x: Points, centre: Place, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Distance from a line along ``axis``, and place along it."""
    moved = x - np.array(centre)
    return np.linalg.norm(np.delete(moved, axis, axis=1), axis=1), moved[:, axis]


def disc(x: Points, centre: Place, radius: float, half: float, axis: int = 2) -> Field:
    away, along = split(x, centre, axis)
    return edged(np.stack([away - radius, np.abs(along) - half], axis=1), 0.02)


def ring(x: Points, centre: Place, radius: float, tube: float, axis: int = 2) -> Field:
    away, along = split(x, centre, axis)
    return np.hypot(away - radius, along) - tube


def folded(x: Points) -> Points:
    """Points on one side of the plane x = 0: what is made of them is its own mirror image."""
    return np.column_stack([np.abs(x[:, 0]), x[:, 1:]])


def mug(x: Points) -> Field:
    cup = carve(disc(x, (0, 0, 0), 0.5, 0.6), disc(x, (0, 0, 0.12), 0.42, 0.6))
    return join(cup, ring(x, (0.62, 0, 0), 0.28, 0.07, 1))


def jug(x: Points) -> Field:
    return join(mug(x), rod(x, (-0.45, 0, 0.5), (-0.68, 0, 0.66), 0.12, 0.06))


def glasses(x: Points) -> Field:
    x = folded(x)
    temple = rod(x, (0.68, 0, 0.05), (0.74, 0.1, 0.05), 0.06), rod(x, (0.74, 0.1, 0.05), (0.7, 1.1, -0.1), 0.055)
    return join(ring(x, (0.4, 0, 0), 0.3, 0.06, 1), rod(x, (-0.1, 0, 0.08), (0.12, 0, 0.08), 0.055), *temple)


def teddy(x: Points) -> Field:
    x = folded(x)
    head = ellipsoid(x, (0, 0.02, 0.72), (0.33, 0.33, 0.33)), ellipsoid(x, (0, 0.33, 0.65), (0.13, 0.14, 0.1))
    ear = ellipsoid(x, (0.25, 0, 1), (0.11, 0.11, 0.11))
    limbs = rod(x, (0.3, 0.05, 0.25), (0.7, 0.3, 0.1), 0.13, 0.11), rod(x, (0.2, 0.1, -0.4), (0.35, 0.6, -0.5), 0.15)
    return join(ellipsoid(x, (0, 0, 0), (0.42, 0.38, 0.5)), *head, ear, *limbs, blend=0.06)


def bust(x: Points) -> Field:
    x = folded(x)
    skull, nose = ellipsoid(x, (0, 0, 0.6), (0.34, 0.42, 0.48)), rod(x, (0, 0.38, 0.62), (0, 0.5, 0.5), 0.05, 0.08)
    ear, chin = ellipsoid(x, (0.35, -0.02, 0.58), (0.06, 0.1, 0.15)), ellipsoid(x, (0, 0.32, 0.3), (0.12, 0.12, 0.1))
    neck = rod(x, (0, -0.05, 0.3), (0, -0.1, -0.15), 0.22, 0.26)
    return join(skull, nose, ear, neck, box(x, (0, -0.1, -0.45), (0.75, 0.3, 0.22), 0.18), chin, blend=0.08)


def wrench(x: Points) -> Field:
    eye = carve(disc(x, (-0.85, 0, 0), 0.26, 0.08), disc(x, (-0.85, 0, 0), 0.14, 0.3))
    jaw = carve(disc(x, (0.9, 0, 0), 0.3, 0.09), box(x, (1.1, 0.07, 0), (0.25, 0.12, 0.3)))
    return join(box(x, (0, 0, 0), (0.75, 0.12, 0.06)), eye, jaw)


def car(x: Points) -> Field:
    x = folded(x)
    wheels = [disc(x, (0.42, y, -0.15), 0.22, 0.1, 0) for y in (0.6, -0.62)]
    return join(box(x, (0, 0, 0.05), (0.45, 1, 0.2), 0.1), box(x, (0, -0.12, 0.32), (0.38, 0.5, 0.2), 0.12), *wheels)


def gear(x: Points) -> Field:
    away, along = split(x, (0, 0, 0), 2)
    rim = 0.55 + 0.1 * np.tanh(4 * np.sin(8 * np.arctan2(x[:, 1], x[:, 0])))
    return carve(np.maximum((away - rim) * 0.6, np.abs(along) - 0.15), disc(x, (0, 0, 0), 0.2, 0.5))


def chair(x: Points) -> Field:
    x = folded(x)
    legs = [rod(x, (0.42, y, 0), (0.45, 1.1 * y, -0.7), 0.07) for y in (0.42, -0.44)]
    return join(box(x, (0, 0, 0), (0.5, 0.5, 0.07)), *legs, box(x, (0, -0.47, 0.5), (0.48, 0.07, 0.5)), blend=0.03)


def guitar(x: Points) -> Field:
    body = disc(x, (0, -0.5, 0), 0.42, 0.12), disc(x, (0, 0.05, 0), 0.3, 0.12)
    neck = box(x, (0, 0.75, 0.09), (0.06, 0.6, 0.05)), box(x, (0, 1.45, 0.07), (0.1, 0.15, 0.05))
    return carve(join(*body, *neck, blend=0.1), disc(x, (0, -0.15, 0.12), 0.14, 0.1))


def bracket(x: Points) -> Field:
    plates = box(x, (0, 0, 0), (0.8, 0.4, 0.09)), box(x, (-0.72, 0, 0.45), (0.09, 0.4, 0.5))
    solid = join(*plates, box(x, (-0.4, 0.33, 0.2), (0.35, 0.06, 0.22)), blend=0.03)
    for hole in (disc(x, (0.45, 0.1, 0), 0.16, 0.4), disc(x, (-0.1, -0.15, 0), 0.1, 0.4)):
        solid = carve(solid, hole)
    return carve(solid, disc(x, (-0.72, -0.1, 0.6), 0.14, 0.4, 0))


def femur(x: Points) -> Field:
    shaft, head = (
        rod(x, (0, 0, -0.8), (0.04, 0.03, 0.6), 0.12, 0.11),
        ellipsoid(x, (0.3, 0.05, 0.88), (0.17, 0.17, 0.17)),
    )
    neck, knob = rod(x, (0.05, 0.03, 0.6), (0.28, 0.05, 0.85), 0.11), ellipsoid(x, (-0.1, 0, 0.72), (0.13, 0.15, 0.2))
    condyles = [ellipsoid(x, (s * 0.15, 0.05, -0.9), (0.16, 0.23 + s * 0.01, 0.16)) for s in (1, -1)]
    return join(shaft, head, neck, knob, *condyles, blend=0.08)


def vase(x: Points) -> Field:
    x = folded(x)
    away, along = split(x, (0, 0, 0), 2)
    side = (away - 0.3 - 0.15 * np.sin(2.6 * along + 0.4)) * 0.8
    hollow = carve(np.maximum(side, np.abs(along) - 0.8), np.maximum(side + 0.064, -(along + 0.7)))
    return join(hollow, ring(x, (0.45, 0, 0.3), 0.22, 0.05, 1))


def pipe(x: Points) -> Field:
    outside = join(disc(x, (0, 0, 0), 0.25, 0.9, 0), disc(x, (0, 0.5, 0), 0.25, 0.5, 1))
    return carve(outside, join(disc(x, (0, 0, 0), 0.18, 1.2, 0), disc(x, (0, 0.6, 0), 0.18, 0.6, 1)))


def tooth(x: Points) -> Field:
    places = (0.2, 0.15, 0.42), (-0.2, 0.16, 0.4), (0.18, -0.15, 0.38), (-0.22, -0.14, 0.36)
    cusps = [ellipsoid(x, place, (0.15, 0.15, 0.15)) for place in places]
    roots = (
        rod(x, (0.2, 0, -0.1), (0.3, 0.05, -0.85), 0.17, 0.06),
        rod(x, (-0.2, 0, -0.1), (-0.24, 0, -0.75), 0.18, 0.07),
    )
    return join(ellipsoid(x, (0, 0, 0.1), (0.42, 0.36, 0.36)), *cusps, *roots, blend=0.07)


def kidney(x: Points) -> Field:
    x = x + np.outer(0.5 * x[:, 2] ** 2 - 0.1, [1, 0, 0])
    return join(ellipsoid(x, (0, 0, 0), (0.3, 0.22, 0.55)), rod(x, (0.2, 0, 0), (0.5, 0.03, -0.1), 0.06), blend=0.08)


def lamp(x: Points) -> Field:
    shade = carve(disc(x, (0, 0.4, 0.45), 0.3, 0.2), disc(x, (0, 0.4, 0.35), 0.24, 0.2))
    arm = rod(x, (0, 0, -0.9), (0, -0.25, -0.1), 0.06), rod(x, (0, -0.25, -0.1), (0, 0.2, 0.5), 0.06)
    return join(disc(x, (0, 0, -0.9), 0.4, 0.07), *arm, shade)


def vertebra(x: Points) -> Field:
    x = folded(x)
    arch = carve(
        join(disc(x, (0, 0.3, 0), 0.38, 0.25), ring(x, (0, -0.28, 0), 0.24, 0.08), blend=0.06),
        disc(x, (0, -0.28, 0), 0.15, 0.6),
    )
    spine, side = rod(x, (0, -0.45, 0), (0, -1, -0.2), 0.08), rod(x, (0.25, -0.3, 0), (0.65, -0.45, 0.05), 0.07)
    joints = [rod(x, (0.22, -0.25, s * 0.1), (0.28, -0.32, s * 0.4), 0.07) for s in (1, -1)]
    return join(arch, spine, side, *joints, blend=0.05)


X, Y, Z = (np.diag(np.where(np.arange(3) == i, -1.0, 1.0)) for i in range(3))
"""Reflections."""
TURNS = [Rotation.from_rotvec([0, 0, i * np.pi / 8]).as_matrix() for i in range(16)]
"""A reflection of a gear takes teeth to gaps, unless it is turned by half a tooth."""
KINDS: dict[str, tuple[Callable[[Points], Field], list[np.ndarray]]] = {
    "mug": (mug, [Y]),
    "jug": (jug, [Y]),
    "glasses": (glasses, [X]),
    "teddy": (teddy, [X]),
    "bust": (bust, [X]),
    "wrench": (wrench, [Z]),
    "car": (car, [X]),
    "gear": (
        gear,
        [
            *(t @ one for t in TURNS[::2] for one in (np.eye(3), Z)),
            *(t @ X @ one for t in TURNS[1::2] for one in (np.eye(3), Z)),
        ],
    ),
    "chair": (chair, [X]),
    "guitar": (guitar, [X]),
    "bracket": (bracket, []),
    "femur": (femur, []),
    "vase": (vase, [X, Y, X @ Y]),
    "pipe": (pipe, [X, Z, X @ Z]),
    "tooth": (tooth, []),
    "kidney": (kidney, []),
    "lamp": (lamp, [X]),
    "vertebra": (vertebra, [X]),
}
"""Of each kind its distance field and its symmetries."""


def surface(field: Callable[[Points], Field], cells: int, faces: int, rng: np.random.Generator) -> Mesh:
    """The largest piece of the zero set, simplified to about so many ``faces``."""
    turn = Rotation.random(rng=rng).as_matrix()
    line = np.linspace(-1.75, 1.75, cells)
    grid = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)
    shift = rng.uniform(-0.5, 0.5, 3) * (line[1] - line[0])
    values = np.concatenate([field(x) for x in np.array_split((grid + shift) @ turn, 20)])
    vertices, triangles = map(np.asarray, igl.marching_cubes(values, grid, cells, cells, cells, 0.0)[:2])
    mesh = Mesh((vertices + shift) @ turn, triangles[:, ::-1].astype(np.int64))
    piece, _ = largest_piece(mesh, np.ones(len(vertices), dtype=bool))
    vertices, triangles = map(np.asarray, igl.decimate(piece.vertices, piece.faces, faces)[:2])
    return Mesh(vertices, triangles.astype(np.int64))


def deformed(x: Points, amount: float, rng: np.random.Generator) -> Points:
    """Points stretched along random axes, bent by three waves, turned and in another unit."""
    axes = Rotation.random(rng=rng).as_matrix()
    x = (x - x.mean(axis=0)) @ axes.T @ np.diag(np.exp(rng.normal(0, 0.12 * amount, 3))) @ axes
    for _ in range(3):
        wave = rng.normal(size=3)
        wave *= rng.uniform(1, 2.2) / np.linalg.norm(wave)
        x = x + amount * 0.06 * np.outer(np.sin(x @ wave + rng.uniform(0, 2 * np.pi)), rng.normal(size=3))
    return x @ Rotation.random(rng=rng).as_matrix() * np.exp(rng.normal(0, 0.5))


def made(kind: str, number: int) -> tuple[Mesh, Mesh, list[np.ndarray]]:
    """The pair of a kind with a ``number``, and its true maps (n_t,), the first without a symmetry."""
    field, symmetries = KINDS[kind]
    rng = np.random.default_rng([number, list(KINDS).index(kind)])
    source, target = surface(field, 64, 9000, rng), surface(field, 58, 8000, rng)
    tree = KDTree(source.vertices)
    truth = [np.asarray(tree.query(target.vertices @ one.T)[1]) for one in (np.eye(3), *symmetries)]
    s, t = (deformed(x, a, rng) for x, a in ((source.vertices, 0.3), (target.vertices, AMOUNTS[number % 3])))
    return Mesh(s, source.faces), Mesh(t, target.faces), truth


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--pairs", type=int, default=3, help="of each kind")
    parser.add_argument("--first", type=int, default=0, help="number of the first pair of each kind")
    parser.add_argument("--landmarks", type=int, default=0, help="right ones, spread over the target")
    arguments = parser.parse_args()
    print(f"{'kind':10} pair   error  by symmetry   verdict           CPU s")
    rows = []
    for kind in arguments.kinds.split(","):
        for number in range(arguments.first, arguments.first + arguments.pairs):
            source, target, truth = made(kind, number)
            at = farthest_geodesic(target, arguments.landmarks, rng=1) if arguments.landmarks else []
            landmarks = np.stack([truth[0][at], at], axis=1) if len(at) else None
            start = time.process_time()
            with kfmaps.limit_threads(1):
                found = kfmaps.match(source, target, landmarks=landmarks)
            seconds, points = time.process_time() - start, found.target_to_source
            known = points >= 0
            errors = [kfmaps.geodesic_errors(source, points[known], one[known]).mean() for one in truth]
            rows.append((errors[0], min(errors), found.verdict == "sure"))
            told = f"{found.verdict}, {found.confidence:.3f}"
            print(
                f"{kind:10} {number:4} {100 * errors[0]:7.2f} {100 * min(errors):8.2f}       {told:18} {seconds:.1f}",
                flush=True,
            )
    error, least, sure = np.array(rows).T
    is_right, counts_as_right = error < RIGHT / 100, least < RIGHT / 100
    print(
        f"{len(rows)} maps, {is_right.sum()} right, {counts_as_right.sum()} up to symmetry; {int(sure.sum())} sure,"
        f" {int((sure * ~is_right).sum())} of them wrong, {int((sure * ~counts_as_right).sum())} up to symmetry"
    )


if __name__ == "__main__":
    main()
