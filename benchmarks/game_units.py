"""Units of a game in two poses, artists' meshes of many kinds that no number was chosen on.

    python benchmarks/game_units.py --data DIR [--half choice|report] [--whole] [--names dragon,valkyrie]

DIR is a folder with models of MegaGlest (Debian's package megaglest-data 3.13.0, unpacked; files ``.g3d``): people,
monsters, animals, machines, buildings and plants. Of each unit the model with most poses counts, and of these the two
that are farthest from each other. Its largest piece is subdivided (Loop 1987), and simplified where it is an oriented
manifold; otherwise its vertices are shuffled. With ``--whole`` all pieces are matched as the artist left them, with
shuffled vertices, and errors are straight distances on the source, weighted by area. Every second unit by name is of
the choice half.
"""

from __future__ import annotations

import argparse
import struct
from pathlib import Path

import numpy as np
from automatic import RIGHT
from game_animals import (
    FACES,
    apart,
    found_by,
    is_oriented_manifold,
    judged,
    largest_manifold_piece,
    meshed_anew,
    print_summary,
)
from scipy.spatial import KDTree
from scipy.spatial.transform import Rotation

import kfmaps
from kfmaps.geometry.mesh import Mesh, surface_area, vertex_areas
from kfmaps.geometry.subdivision import loop_matrix

MOST_POSES = 24
"""Poses of a unit that are compared."""


def read_model(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Poses (p, n, 3) and faces (m, 3) of a model (G3D 4); none of other versions and of one pose alone."""
    content = path.read_bytes()
    n_meshes = struct.unpack_from("<H", content, 4)[0] if content[:4] == b"G3D\x04" else 0
    at, pieces = 7, []
    for _ in range(n_meshes):
        n_poses, n_vertices, n_indices = struct.unpack_from("<3I", content, at + 64)
        (textures,) = struct.unpack_from("<I", content, at + 112)
        at += 116 + 64 * textures.bit_count()
        poses = np.frombuffer(content, "<f4", 3 * n_poses * n_vertices, at).reshape(n_poses, n_vertices, 3)
        at += 24 * n_poses * n_vertices + (8 * n_vertices if textures else 0)  # positions, normals; texture coordinates
        pieces.append((poses.astype(float), np.frombuffer(content, "<u4", n_indices, at).reshape(-1, 3)))
        at += 4 * n_indices
    most = max((len(poses) for poses, _ in pieces), default=0)
    pieces = [(np.repeat(p, most // len(p), axis=0), f) for p, f in pieces if len(p) in (1, most)] if most > 1 else []
    if not pieces:
        return np.zeros((0, 0, 3)), np.zeros((0, 3), dtype=np.int64)
    begin = np.cumsum([0, *(p.shape[1] for p, _ in pieces)])
    faces = [f.astype(np.int64) + b for (_, f), b in zip(pieces, begin, strict=False)]
    return np.concatenate([p for p, _ in pieces], axis=1), np.concatenate(faces)


def read_units(data: Path) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Poses and faces of each unit, by its name."""
    found: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    for path in sorted(data.rglob("*.g3d")):
        parts = path.parts
        name = path.stem
        if "factions" in parts and "units" in parts:
            name = "/".join(parts[parts.index(folder) + 1] for folder in ("factions", "units"))
        poses, faces = read_model(path)
        if len(poses) > len(found.get(name, ((), ()))[0]):
            found[name] = poses, faces
    return found


def far_poses(poses: np.ndarray, faces: np.ndarray, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """The two poses (n, 3) that are farthest from each other, moved and turned to each other.

    Where a unit breaks, pieces may shrink to nothing: poses with half or twice the usual area are left out.
    """
    some = rng.choice(len(poses), min(len(poses), MOST_POSES), replace=False)
    areas = np.array([surface_area(Mesh(pose, faces)) for pose in poses[some]])
    some = some[np.abs(np.log(areas / np.median(areas))) < np.log(2)]
    far = {(i, j): apart(poses[i], poses[j]) for j in some for i in some if i < j}
    i, j = max(far, key=lambda pair: far[pair])
    return poses[i], poses[j]


def smooth_meshes(poses: tuple[np.ndarray, np.ndarray], faces: np.ndarray) -> tuple[Mesh, Mesh, np.ndarray] | None:
    """Both poses of the largest piece, each with a mesh of its own, and the true map (n_t,); ``None`` if it is tiny."""
    kept, faces = largest_manifold_piece(poses[0], faces)
    if len(kept) < 60:
        return None
    values = np.hstack([pose[kept] for pose in poses])
    while len(faces) < FACES:
        matrix, faces = loop_matrix(faces, len(values))
        values = matrix @ values
    can_simplify, rng = is_oriented_manifold(faces), np.random.default_rng(len(values))
    meshes = [
        meshed_anew(Mesh(pose, faces), n_faces, can_simplify, rng)
        for pose, n_faces in ((values[:, :3], FACES), (values[:, 3:], FACES - 1000))
    ]
    rows = KDTree(values[:, 3:]).query(meshes[1].vertices)[1]
    return meshes[0], meshes[1], np.asarray(KDTree(meshes[0].vertices).query(values[rows, :3])[1])


def judged_whole(name: str, source: Mesh, target: Mesh, truth: np.ndarray) -> tuple[bool, bool]:
    """Print how all pieces of a unit are matched; return whether that is right, and sure. ``truth (n_t,)``."""
    found, known, told = found_by(source, target)
    away = source.vertices[found.target_to_source[known]] - source.vertices[truth[known]]
    errors = 100 * np.linalg.norm(away, axis=1) / np.sqrt(surface_area(source))
    weights = vertex_areas(target)
    error, missing = np.average(errors, weights=weights[known]), 1 - weights[known].sum() / weights.sum()
    print(f"{name:28} {error:7.2f} {missing:8.0%}   {told}", flush=True)
    return bool(error < RIGHT and missing < 0.1), found.verdict == "sure"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--half", choices=("choice", "report"), default="report")
    parser.add_argument("--whole", action="store_true", help="all pieces, as they are")
    parser.add_argument("--names", default="", help="parts of names, instead of a half")
    arguments = parser.parse_args()
    units, some = read_units(arguments.data), arguments.names.split(",")
    names = sorted(units)[arguments.half == "report" :: 2]
    if arguments.names:
        names = [name for name in sorted(units) if any(part in name for part in some)]
    print(f"{'unit':28}   error  unmatched  verdict             CPU s")
    rows = []
    for name in names:
        rng, (poses, faces) = np.random.default_rng([*name.encode()]), units[name]
        pair = far_poses(poses, faces, rng)
        turn = Rotation.random(rng=rng).as_matrix()
        if arguments.whole:
            order = rng.permutation(len(pair[1]))
            source, target = Mesh(pair[0], faces), Mesh(pair[1][order] @ turn, np.argsort(order)[faces])
            try:
                rows.append(judged_whole(name, source, target, order))
            except kfmaps.InvalidInput:
                print(f"{name:28} has too few vertices", flush=True)
        elif (made := smooth_meshes(pair, faces)) is not None:
            target = Mesh(made[1].vertices @ turn, made[1].faces)
            rows.append(judged(f"{name:28}", made[0], target, made[2]))
    print_summary(rows)


if __name__ == "__main__":
    main()
