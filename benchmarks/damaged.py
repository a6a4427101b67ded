"""Meshes damaged as scans and exports are, matched with clean ones: errors and verdicts.

    python benchmarks/damaged.py --data DIR [--sets FAUST_r,TOSCA_r] [--half report] [--pairs 2] [--damage floor,spikes]
        [--partial auto] [--random 2]

Each target is damaged in one way at a time, or in several as "10 holes+floor"; "clean" is without damage. With
``--random 2`` both shapes are damaged in two random ways, one after the other. Errors are mean geodesic distances on
the source × 100, of the vertices with a truth, each at the damaged mesh's nearest vertex. DIR is as for
benchmarks/automatic.py.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from dataclasses import replace

import igl
import numpy as np
from automatic import chosen_jobs, loaded, pair_options
from scipy.spatial import KDTree
from shapes import bumpy_sphere

import kfmaps
from kfmaps.geometry.connectivity import component_labels, half_edges_by_edge
from kfmaps.geometry.geodesics import farthest_geodesic
from kfmaps.geometry.mesh import Mesh, unit_area, unit_rows, vertex_normals
from kfmaps.geometry.subdivision import divide_faces
from kfmaps.geometry.topology import topology

#: A damaged mesh, and where each of its vertices was before (n, 3); NaN for vertices that are no part of the shape.
Damaged = tuple[Mesh, np.ndarray]


def _with_pieces(mesh: Mesh, pieces: list[Mesh]) -> Damaged:
    """The mesh with loose pieces after it."""
    starts = np.cumsum([len(mesh.vertices), *(len(piece.vertices) for piece in pieces)])[:-1]
    vertices = np.concatenate([mesh.vertices, *(piece.vertices for piece in pieces)])
    faces = np.concatenate([mesh.faces, *(p.faces + start for p, start in zip(pieces, starts, strict=True))])
    before = vertices.copy()
    before[len(mesh.vertices) :] = np.nan
    return Mesh(vertices, faces), before


def _noisy(amount: float) -> Callable[[Mesh, np.random.Generator], Damaged]:
    return lambda mesh, rng: (
        Mesh(mesh.vertices + amount * rng.normal(size=mesh.vertices.shape), mesh.faces),
        mesh.vertices,
    )


def _decimated(count: int, stretch: float = 1.0) -> Callable[[Mesh, np.random.Generator], Damaged]:
    """About ``count`` vertices; triangles are long along the second axis with a small ``stretch``."""

    def damage(mesh: Mesh, _rng: np.random.Generator) -> Damaged:
        axes = np.array([1.0, stretch, 1.0])
        counts = topology(mesh)
        if not counts.is_manifold or counts.inconsistent_edges:
            return mesh, mesh.vertices  # of these libigl makes nothing, or takes all memory
        given = np.asfortranarray(mesh.vertices * axes), np.asfortranarray(mesh.faces, dtype=np.int32)
        vertices, faces = (np.asarray(found) for found in igl.qslim(*given, 2 * count)[:2])
        return Mesh(vertices / axes, faces), vertices / axes

    return damage


def _soup(noise: float) -> Callable[[Mesh, np.random.Generator], Damaged]:
    """Each triangle with three vertices of its own, as flat shading leaves them, moved as by rounding."""

    def damage(mesh: Mesh, rng: np.random.Generator) -> Damaged:
        vertices = mesh.vertices[mesh.faces.ravel()]
        moved = vertices + noise * rng.normal(size=vertices.shape)
        return Mesh(moved, np.arange(len(vertices)).reshape(-1, 3)), vertices

    return damage


def _six_pieces(
    gap: float = 0.0, overlap: float = 0.0, moved: float = 0.0, depth: float | None = None
) -> Callable[[Mesh, np.random.Generator], Damaged]:
    """Six pieces around vertices that are far from each other.

    Each is drawn in on all sides by ``gap``, or reaches into its neighbours by ``overlap``, is ``moved`` at random, and
    is closed by cones that end by ``depth`` beyond its border.
    """

    def damage(mesh: Mesh, rng: np.random.Generator) -> Damaged:
        distances = kfmaps.geodesic_distances(mesh, farthest_geodesic(mesh, 6, rng))
        excess = distances - distances.min(axis=0)
        pieces, before = [], []
        for piece in range(6):
            faces = mesh.faces[
                (excess[piece, mesh.faces[:, 0]] == 0) | (excess[piece, mesh.faces] < overlap).all(axis=1)
            ]
            used, numbers = np.unique(faces, return_inverse=True)
            vertices, faces = mesh.vertices[used], numbers.reshape(-1, 3)
            middle = vertices.mean(axis=0)
            vertices = vertices - gap * unit_rows(vertices - middle) + moved * rng.normal(size=3)
            before += [mesh.vertices[used]]
            if depth is not None:
                border = half_edges_by_edge(faces, len(used))[0]
                tail, head = faces.ravel()[border], faces[:, [1, 2, 0]].ravel()[border]
                loop = component_labels(len(used), tail, head)[1][tail]
                for number in np.unique(loop):
                    centre = vertices[tail[loop == number]].mean(axis=0)
                    cone = np.stack([head, tail, np.full(len(tail), len(vertices))], axis=1)[loop == number]
                    tip = centre + depth * unit_rows((centre - middle)[None])
                    vertices, faces = np.concatenate([vertices, tip]), np.concatenate([faces, cone])
                    before += [np.full((1, 3), np.nan)]
            pieces.append(Mesh(vertices, faces))
        return _with_pieces(pieces[0], pieces[1:])[0], np.concatenate(before)

    return damage


def _half_refined(mesh: Mesh, _rng: np.random.Generator) -> Damaged:
    """Triangles above the middle of the longest axis divided into sixteen, with T-junctions at the border."""
    axis = np.argmax(np.ptp(mesh.vertices, axis=0))
    middle = np.median(mesh.vertices[:, axis])
    upper = mesh.vertices[mesh.faces][:, :, axis].mean(axis=1) > middle
    vertices, faces = mesh.vertices, mesh.faces[upper]
    for _ in range(2):
        ends, faces = divide_faces(faces, len(vertices))
        vertices = np.concatenate([vertices, vertices[ends].mean(axis=1)])
    return Mesh(vertices, np.concatenate([mesh.faces[~upper], faces])), vertices


def _turned_over(share: float) -> Callable[[Mesh, np.random.Generator], Damaged]:
    def damage(mesh: Mesh, rng: np.random.Generator) -> Damaged:
        faces = mesh.faces.copy()
        which = rng.random(len(faces)) < share
        faces[which] = faces[which][:, ::-1]
        return Mesh(mesh.vertices, faces), mesh.vertices

    return damage


def _two_sided(mesh: Mesh, _rng: np.random.Generator) -> Damaged:
    return Mesh(mesh.vertices, np.concatenate([mesh.faces, mesh.faces[:, ::-1]])), mesh.vertices


def _spikes(mesh: Mesh, rng: np.random.Generator) -> Damaged:
    vertices = mesh.vertices.copy()
    vertices[rng.choice(len(vertices), 20, replace=False)] += 0.1 * rng.normal(size=(20, 3))
    return Mesh(vertices, mesh.faces), mesh.vertices


def _holes(count: int, area: float) -> Callable[[Mesh, np.random.Generator], Damaged]:
    """Round holes, each of about the ``area``."""

    def damage(mesh: Mesh, rng: np.random.Generator) -> Damaged:
        away = kfmaps.geodesic_distances(mesh, rng.choice(len(mesh.vertices), count, replace=False)).min(axis=0)
        return Mesh(mesh.vertices, mesh.faces[(away[mesh.faces] > np.sqrt(area / np.pi)).all(axis=1)]), mesh.vertices

    return damage


def _missing_faces(share: float) -> Callable[[Mesh, np.random.Generator], Damaged]:
    return lambda mesh, rng: (Mesh(mesh.vertices, mesh.faces[rng.random(len(mesh.faces)) > share]), mesh.vertices)


def _bad_edges(mesh: Mesh, rng: np.random.Generator) -> Damaged:
    """A hundred triangles that stand on an edge of the surface."""
    which = rng.choice(len(mesh.faces), 100, replace=False)
    corners = mesh.vertices[mesh.faces[which]]
    tips = corners.mean(axis=1) + 0.02 * rng.normal(size=(100, 3))
    new = len(mesh.vertices) + np.arange(100)
    faces = np.concatenate([mesh.faces, np.column_stack([mesh.faces[which, :2], new])])
    return Mesh(np.concatenate([mesh.vertices, tips]), faces), np.concatenate(
        [mesh.vertices, np.full((100, 3), np.nan)]
    )


def _specks(mesh: Mesh, rng: np.random.Generator) -> Damaged:
    """Forty loose spheres around the shape, and two larger ones inside, as eyes are."""
    ball = bumpy_sphere(60)
    around = mesh.vertices[rng.choice(len(mesh.vertices), 42, replace=False)]
    sizes = np.r_[np.full(40, 0.01), 0.06, 0.06]
    offsets = np.r_[0.15 * rng.normal(size=(40, 3)), np.zeros((2, 3))]
    pieces = [Mesh(s * ball.vertices + a + o, ball.faces) for s, a, o in zip(sizes, around, offsets, strict=True)]
    return _with_pieces(mesh, pieces)


def _balls_inside(mesh: Mesh, rng: np.random.Generator) -> Damaged:
    """Six loose spheres where the shape is thickest, turned inward, as cavities in a scanned body are."""
    points = rng.uniform(mesh.vertices.min(axis=0), mesh.vertices.max(axis=0), (20_000, 3))
    points = points[np.abs(np.asarray(igl.fast_winding_number(mesh.vertices, mesh.faces, points))) > 0.5]
    depth = np.asarray(KDTree(mesh.vertices).query(points)[0])
    ball, balls = bumpy_sphere(400), []
    largest = np.linalg.norm(ball.vertices, axis=1).max()
    for _ in range(6):
        deepest = int(depth.argmax())
        vertices = 0.8 * depth[deepest] / largest * ball.vertices + points[deepest]
        balls.append(Mesh(vertices, ball.faces[:, ::-1]))
        depth = np.minimum(depth, np.linalg.norm(points - points[deepest], axis=1) - depth[deepest])
    return _with_pieces(mesh, balls)


def _hollow(mesh: Mesh, _rng: np.random.Generator) -> Damaged:
    """With an inner wall 3 % of √area below the surface, as shapes are printed."""
    return _with_pieces(mesh, [Mesh(mesh.vertices - 0.03 * vertex_normals(mesh), mesh.faces[:, ::-1])])


def _partitions(mesh: Mesh, _rng: np.random.Generator) -> Damaged:
    """With cones inside, across the longest axis at ten heights, as between the regions of a segmented image."""
    axis, faces = int(np.argmax(np.ptp(mesh.vertices, axis=0))), mesh.faces
    height = mesh.vertices[:, axis]
    one, two = half_edges_by_edge(faces, len(height))[1]
    ends = np.stack([faces.ravel()[one], faces[:, [1, 2, 0]].ravel()[one]], axis=1)
    walls, tips, n = [faces], [mesh.vertices], len(height)
    for level in np.linspace(height.min(), height.max(), 12)[1:-1]:
        is_above = height[faces].mean(axis=1) > level
        loops = ends[is_above[one // 3] != is_above[two // 3]]
        loop = component_labels(len(height), loops[:, 0], loops[:, 1])[1][loops[:, 0]]
        for number in np.unique(loop):
            border = loops[loop == number]
            walls.append(np.column_stack([border, np.full(len(border), n)]))
            tips.append(mesh.vertices[np.unique(border)].mean(axis=0, keepdims=True))
            n += 1
    before = np.concatenate(tips)
    before[len(height) :] = np.nan
    return Mesh(np.concatenate(tips), np.concatenate(walls)), before


def _floor(mesh: Mesh, _rng: np.random.Generator) -> Damaged:
    """A square of a third of the area below the shape, as the floor of a scan."""
    axis = int(np.argmax(np.ptp(mesh.vertices, axis=0)))
    steps = np.linspace(-0.29, 0.29, 21)
    u, v = (grid.ravel() for grid in np.meshgrid(steps, steps))
    vertices = np.insert(np.column_stack([u, v]), axis, mesh.vertices[:, axis].min() - 0.001, axis=1)
    vertices += mesh.vertices.mean(axis=0) * (np.arange(3) != axis)
    corner = (np.arange(20)[:, None] * 21 + np.arange(20)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + 22, corner + 21])
    return _with_pieces(mesh, [Mesh(vertices, np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]))])


def _far_away(mesh: Mesh, rng: np.random.Generator) -> Damaged:
    """In thousandths of a unit, a hundred shapes' lengths from the origin, turned."""
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    vertices = 0.001 * (mesh.vertices @ turn + 100)
    return Mesh(vertices, mesh.faces), mesh.vertices


DAMAGES: dict[str, Callable[[Mesh, np.random.Generator], Damaged]] = {
    "clean": lambda mesh, _rng: (mesh, mesh.vertices),
    "noise 0.3 %": _noisy(0.003),
    "noise 0.5 %": _noisy(0.005),
    "noise 1 %": _noisy(0.01),
    "1000 vertices": _decimated(1000),
    "500 vertices": _decimated(500),
    "long triangles": _decimated(3000, 0.1),
    "spikes": _spikes,
    "10 holes": _holes(10, 0.005),
    "40 small holes": _holes(40, 0.001),
    "faces missing": _missing_faces(0.1),
    "more missing": _missing_faces(0.3),
    "hollow": _hollow,
    "balls inside": _balls_inside,
    "partitions": _partitions,
    "half refined": _half_refined,
    "bad edges": _bad_edges,
    "six pieces": _six_pieces(gap=1e-3),
    "overlapping": _six_pieces(overlap=0.1, moved=2e-3),
    "stuck together": _six_pieces(overlap=0.02, depth=0.08),
    "specks": _specks,
    "floor": _floor,
    "rounded soup": _soup(1e-5),
    "soup": _soup(0.0),
    "inside out": _turned_over(1.0),
    "tenth turned": _turned_over(0.1),
    "two-sided": _two_sided,
    "far away": _far_away,
}
"""In the order in which several are done to one mesh."""
UNLIKELY = {"clean", "noise 1 %", "500 vertices", "long triangles", "half refined", "more missing"}
"""What random damage does not have."""


def damaged(mesh: Mesh, names: list[str], rng: np.random.Generator) -> Damaged:
    before = mesh.vertices
    for name in names:
        made, place = DAMAGES[name](mesh, rng)
        is_of_shape = np.isfinite(place[:, 0])
        nearest = np.asarray(KDTree(mesh.vertices).query(np.where(is_of_shape[:, None], place, 0.0))[1])
        before = np.where(is_of_shape[:, None], before[nearest], np.nan)
        mesh = made
    return mesh, before


def row_of(meshes: tuple[Mesh, Mesh], true: tuple[np.ndarray, np.ndarray], ways: list[list[str]], part: str) -> str:
    """Return the error, verdict, seconds and warnings of a pair of shapes damaged in two ``ways``."""
    rng = np.random.default_rng(0)
    (target, was_target), (source, was_source) = (damaged(meshes[i], ways[i], rng) for i in (1, 0))
    of_shape = np.flatnonzero(np.isfinite(was_target[:, 0]))
    places = of_shape[np.asarray(KDTree(was_target[of_shape]).query(meshes[1].vertices[true[1]])[1])]
    config = kfmaps.Config(threads=1)
    begun = time.process_time()
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        found = kfmaps.match(source, target, replace(config, partial=replace(config.partial, part=part)))
    seconds = time.process_time() - begun
    images = found.target_to_source[places]
    was = np.where(np.isfinite(was_source), was_source, source.vertices)[images]
    kept = images >= 0
    points = np.asarray(KDTree(meshes[0].vertices).query(was[kept])[1])
    error = 100 * float(kfmaps.geodesic_errors(meshes[0], points, true[0][kept]).mean())
    missing = "" if kept.all() else f"{100 * np.mean(~kept):.0f} % without a counterpart; "
    return (
        f"{len(target.vertices):9,}{error:7.2f}  {found.verdict:11}{found.confidence or 0.0:6.2f}{seconds:7.1f}  "
        f"{missing}" + "; ".join(str(one.message)[:60] for one in told)
    )


def main() -> None:
    parser = pair_options(__doc__, "FAUST_r,SHREC19_r,TOSCA_r,SMAL_r", 1, "report", only=True)
    parser.add_argument("--damage", default=",".join(DAMAGES))
    parser.add_argument("--partial", default="auto", help="which shape is stated to be a part")
    parser.add_argument("--random", type=int, help="so many kinds of damage at random, to both shapes")
    parser.add_argument("--seed", type=int, default=1, help="of the pairs and of random damage")
    arguments = parser.parse_args()
    print(f"{'pair':34}{'damage':16}{'vertices':>9}{'error':>7}  {'verdict':11}{'told':>6}{'CPU s':>7}  warnings")
    rng = np.random.default_rng(arguments.seed)
    for job in chosen_jobs(arguments, seed=arguments.seed):
        source, target, *true = loaded(job)
        ways: list[list[list[str]]] = [[[], name.split("+")] for name in arguments.damage.split(",")]
        if arguments.random:
            names = [name for name in DAMAGES if name not in UNLIKELY]
            drawn = [np.sort(rng.choice(len(names), arguments.random, replace=False)) for _ in range(2)]
            ways = [[[names[i] for i in numbers] for numbers in drawn]]
        for way in ways:
            name = " | ".join(", ".join(names) for names in way if names)
            row = row_of((unit_area(source), unit_area(target)), (true[0], true[1]), way, arguments.partial)
            print(f"{job!s:34}{name:16}{row}", flush=True)


if __name__ == "__main__":
    main()
